"""Pictures that may be laid side by side without a seam: plaster, concrete, carpet, asphalt, paving, ceiling, roof, leaf."""
import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from noise import canvas, noise, rng_of


def mottled(name, size, color, broad=5.0, fine=4.0, tint=2.0):
    """A plain surface: 1/f shading, and a grain; `broad` and `fine` are standard deviations in grey levels."""
    rng = rng_of(name)
    field = broad * noise(rng, size, size, 1.2) + fine * noise(rng, size, size, 0.5)
    return canvas(size, size, color) + field[:, :, None] + tint * np.stack([noise(rng, size, size, 1.4) for _ in range(3)], -1)


def roller_plaster(name, size, color):
    """Painted with a roller: small bumps, lit from above."""
    rng = rng_of(name)
    bumps = noise(rng, size, size, 0.9)
    relief = (np.roll(bumps, 1, 0) - np.roll(bumps, -1, 0)) * 5.0
    return mottled(name + " ground", size, color, 3.5, 2.0, 1.0) + np.clip(relief, -14, 14)[:, :, None]


def creased(name, size, color, depth=10.0):
    """Foil stretched over a board: mottled, with faint creases of which one side is light and the other dark."""
    rng = rng_of(name)
    relief = sum(np.exp(-np.abs(noise(rng, size, size, beta)) / wide) for beta, wide in ((1.9, 0.02), (1.6, 0.03)))
    slope = np.roll(relief, 2, 0) - np.roll(relief, -2, 0) + np.roll(relief, 2, 1) - np.roll(relief, -2, 1)
    return mottled(name + " ground", size, color, 3.0, 1.2, 0.6) + np.clip(depth * slope, -16, 16)[:, :, None]


def concrete(name, size):
    rng = rng_of(name)
    picture = mottled(name + " ground", size, (150, 148, 143), 11, 6, 1.5)
    pits = noise(rng, size, size, 0.5)
    picture -= (np.clip(pits - 2.3, 0, 1) * 70)[:, :, None]
    stains = noise(rng, size, size, 1.6)
    return picture * (1 - 0.09 * np.clip(stains, 0, 2))[:, :, None]


def tufted(name, size, color):
    """Office carpet: tufts of a few texels in three yarns."""
    rng = rng_of(name)
    yarn = noise(rng, size, size, 0.35)
    picture = canvas(size, size, color) * (1 + 0.16 * yarn + 0.06 * noise(rng, size, size, 1.3))[:, :, None]
    for threshold, tone in ((1.75, (150, 152, 160)), (1.9, (34, 38, 52)), (2.15, (150, 104, 70))):
        spots = noise(rng, size, size, 0.7) > threshold
        picture[spots] = 0.45 * picture[spots] + 0.55 * np.array(tone)
    return picture


def asphalt(name, size):
    rng = rng_of(name)
    picture = mottled(name + " ground", size, (92, 92, 94), 8, 12, 1.0)
    stones = noise(rng, size, size, 0.25)
    picture += (np.clip(stones - 1.4, 0, 2) * 34 - np.clip(-stones - 1.6, 0, 2) * 26)[:, :, None]
    crack = np.abs(noise(rng, size, size, 1.5))
    return picture * (1 - 0.45 * (crack < 0.012))[:, :, None] * (1 - 0.08 * np.clip(noise(rng, size, size, 1.7), -1, 2))[:, :, None]


def paving(name, size, rows, columns, color, gap=0.02, spread=0.09):
    """Slabs in courses, each second course shifted by half; each slab its own."""
    rng = rng_of(name)
    picture = mottled(name + " ground", size, color, 6, 9, 1.5)
    y, x = np.mgrid[0:size, 0:size] / size
    row = np.floor(y * rows).astype(int)
    shifted = (x * columns + 0.5 * (row % 2)) % columns
    tone = 1 + spread * rng.standard_normal((rows, columns, 1)) + 0.02 * rng.standard_normal((rows, columns, 3))
    picture *= tone[row, np.floor(shifted).astype(int)]
    edge = np.minimum(np.minimum(shifted % 1, 1 - shifted % 1) / columns, np.minimum(y * rows % 1, 1 - y * rows % 1) / rows)
    return picture * (1 - 0.55 * np.exp(-(edge / (gap / rows)) ** 2))[:, :, None]


def ceiling_tiles(name, size, tiles):
    """Mineral fibre tiles in a white grid."""
    rng = rng_of(name)
    picture = mottled(name + " ground", size, (214, 212, 205), 2, 2, 0.8)
    worms = noise(rng, size, size, 0.55)
    picture -= (np.clip(worms - 1.7, 0, 1) * 70)[:, :, None]
    y, x = np.mgrid[0:size, 0:size] / size * tiles
    edge = np.minimum(np.minimum(x % 1, 1 - x % 1), np.minimum(y % 1, 1 - y % 1))
    tone = 1 + 0.02 * rng.standard_normal((tiles, tiles))
    picture *= tone[np.floor(y).astype(int), np.floor(x).astype(int)][:, :, None]
    picture[edge < 0.02] = (228, 227, 222)
    picture[(edge >= 0.02) & (edge < 0.027)] *= 0.72
    return picture


def leaves(name, size):
    """Ten strips of leaf side by side, veins in each."""
    rng = rng_of(name)
    x = (np.arange(size) * 10 / size) % 1
    picture = canvas(size, size, (58, 104, 46)) * (1 + 0.12 * noise(rng, size, size, 1.0) + 0.08 * noise(rng, size, size, 0.3, (1, 6)))[:, :, None]
    y = np.arange(size)[:, None] / size
    veins = np.abs(((y * 14 - np.abs(x - 0.5)[None, :] * 3) % 1) - 0.5) < 0.05
    picture[veins] *= 1.25
    picture[:, np.abs(x - 0.5) < 0.05] *= 1.4
    return picture * (1 + 0.2 * rng.standard_normal(10))[np.floor(np.arange(size) * 10 / size).astype(int)][None, :, None]


def tartan(name, size, colors, repeat=8):
    rng = rng_of(name)
    ground, bands = colors[0], np.zeros((size, 3)) + np.array(colors[0])
    period = size // repeat
    for k, color in enumerate(colors[1:]):
        at, wide = (k * 0.31 + 0.08) * period, period * (0.26, 0.1, 0.05)[k % 3]
        bands[((np.arange(size) - at) % period) < wide] = color
    weave = (np.add.outer(np.arange(size), np.arange(size)) // 2 % 2)[:, :, None]
    picture = np.where(weave, bands[:, None, :], bands[None, :, :])
    picture = np.asarray(Image.fromarray(picture.astype(np.uint8)).filter(ImageFilter.GaussianBlur(0.8)), float)
    return picture * (1 + 0.06 * noise(rng, size, size, 1.2) + 0.07 * noise(rng, size, size, 0.2))[:, :, None] + 0 * np.array(ground)


def knitted(name, size, color, stitch=8):
    rng = rng_of(name)
    y, x = np.mgrid[0:size, 0:size]
    v = np.cos(2 * np.pi * (y + 0.6 * np.abs((x % stitch) - stitch / 2)) / stitch) * 0.5 + np.cos(2 * np.pi * x / stitch) * 0.4
    folds = noise(rng, size, size, 1.5)
    return canvas(size, size, color) * (1 + 0.12 * v + 0.10 * folds + 0.10 * noise(rng, size, size, 0.3))[:, :, None]


def denim(name, size, color=(58, 74, 108)):
    rng = rng_of(name)
    twill = np.sin(2 * np.pi * np.add.outer(np.arange(size), np.arange(size)) / 4.0)
    worn = noise(rng, size, size, 1.4)
    slubs = noise(rng, size, size, 0.4, (12, 1))
    return canvas(size, size, color) * (1 + 0.07 * twill + 0.16 * worn + 0.10 * slubs)[:, :, None]


def hair(name, size, color):
    rng = rng_of(name)
    return canvas(size, size, color) * (1 + 0.35 * noise(rng, size, size, 0.6, (14, 1)) + 0.1 * noise(rng, size, size, 1.2))[:, :, None]


def foliage(name, size):
    """A tree's crown: many leaves, over shade."""
    rng = rng_of(name)
    image = Image.new("RGB", (size, size), (24, 38, 18))
    draw = ImageDraw.Draw(image)
    for k in range(9000):
        x, y, r = rng.uniform(0, size), rng.uniform(0, size), rng.uniform(3, 9)
        light = 0.35 + 0.65 * k / 9000 * rng.uniform(0.6, 1.2)
        color = tuple(int(min(255, v * light)) for v in (96 + rng.integers(-14, 24), 140 + rng.integers(-20, 20), 60))
        turn = rng.uniform(0, np.pi)
        dx, dy = r * np.cos(turn), r * np.sin(turn)
        for ox in (0, -size, size):  # without a seam
            for oy in (0, -size, size):
                if -10 < x + ox < size + 10 and -10 < y + oy < size + 10:
                    draw.polygon([(x + ox - dx, y + oy - dy), (x + ox - dy * 0.5, y + oy + dx * 0.5), (x + ox + dx, y + oy + dy), (x + ox + dy * 0.5, y + oy - dx * 0.5)], fill=color)
    return np.asarray(image, float)
