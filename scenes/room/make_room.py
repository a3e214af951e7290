#!/usr/bin/env python3
"""Makes the room: room.obj, room.mtl and its textures, beside this file. Debian: python3-numpy python3-pil fonts-dejavu-core.

The room is 5 x 2.8 x 4 m: x to the east, y up, z to the south. Nothing in its pictures repeats, so that a corner can be
told from the next: every brick, plank, leaf and book is drawn once, over noise with the 1/f spectrum of natural images.
"""
import math
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

HERE = Path(__file__).resolve().parent
FONTS = Path("/usr/share/fonts/truetype/dejavu")
WIDTH, HEIGHT, DEPTH = 5.0, 2.8, 4.0  # metres
QUALITY = 80  # of the JPEG files
BOOK_ROWS = 3  # of spines in books.jpg

SYLLABLES = "ka lo mi ra te vo sen dor bel un is tra pho ner gal or min ast cu ve lin quo zar fel hu".split()


def rng_of(name):
    return np.random.default_rng(list(name.encode()))


def noise(rng, height, width, beta=1.0, stretch=(1.0, 1.0)):
    """Random field of mean 0, standard deviation 1, amplitude spectrum 1/f^beta; stretch > 1 makes it longer in (y, x)."""
    fy = np.fft.fftfreq(height)[:, None] * height * stretch[0]
    fx = np.fft.rfftfreq(width)[None, :] * width * stretch[1] * height / width
    amplitude = 1.0 / np.maximum(np.hypot(fy, fx), 1.0) ** beta
    amplitude[0, 0] = 0.0
    field = np.fft.irfft2(np.fft.rfft2(rng.standard_normal((height, width))) * amplitude, s=(height, width))
    return field / field.std()


def canvas(height, width, color):
    return np.ones((height, width, 3)) * np.array(color, float)


def save(name, picture):
    Image.fromarray(np.clip(picture + 0.5, 0, 255).astype(np.uint8)).save(HERE / name, quality=QUALITY, optimize=True)


def font(size, style="Sans-Bold"):
    return ImageFont.truetype(str(FONTS / f"DejaVu{style}.ttf"), size)


def word(rng, low=2, high=4):
    return "".join(rng.choice(SYLLABLES, rng.integers(low, high))).capitalize()


def shade_corners(picture, metres, left=True, right=True, top=True, bottom=True, depth=0.3):
    """Darkens towards the edges where another wall takes half of the light away."""
    h, w, _ = picture.shape
    x, y = (np.arange(w) + 0.5) / w * metres[0], (np.arange(h) + 0.5) / h * metres[1]
    factor = np.ones((h, w))
    for on, d in ((left, x[None, :]), (right, metres[0] - x[None, :]), (top, y[:, None]), (bottom, metres[1] - y[:, None])):
        if on:
            factor = factor * (1.0 - depth * np.exp(-d / 0.18))
    return picture * factor[:, :, None]


# ---------------------------------------------------------------------------------------------------------- surfaces


def bricks(name, metres, texel=0.0025):
    rng = rng_of(name)
    w, h = round(metres[0] / texel), round(metres[1] / texel)
    mortar = canvas(h, w, (186, 178, 166)) + 9 * noise(rng, h, w, 0.8)[:, :, None]
    image = Image.fromarray(np.zeros((h, w), np.uint8))
    faces = Image.new("RGB", (w, h))
    draw_mask, draw_face = ImageDraw.Draw(image), ImageDraw.Draw(faces)
    row_height = 0.078 / texel
    for row in range(int(h / row_height) + 2):
        x = -rng.uniform(0, 0.2) / texel
        while x < w:
            length = rng.uniform(0.17, 0.25) / texel
            y = row * row_height
            gap = 0.005 / texel
            jitter = rng.uniform(-1.2, 1.2, 8)
            corners = [(x + gap + jitter[0], y + gap + jitter[1]), (x + length - gap + jitter[2], y + gap + jitter[3]),
                       (x + length - gap + jitter[4], y + row_height - gap + jitter[5]),
                       (x + gap + jitter[6], y + row_height - gap + jitter[7])]
            tone = rng.normal(0, 1, 2)
            base = np.array((168, 108, 84)) * (1 + 0.16 * tone[0]) + np.array((10, -4, -8)) * tone[1]
            if rng.random() < 0.10:
                base = np.array((116, 88, 80)) * (1 + 0.1 * tone[1])
            if rng.random() < 0.07:
                base = np.array((196, 150, 112)) * (1 + 0.08 * tone[1])
            draw_mask.polygon(corners, fill=255)
            draw_face.polygon(corners, fill=tuple(int(v) for v in np.clip(base, 20, 240)))
            x += length
    edge = np.asarray(image.filter(ImageFilter.GaussianBlur(1.0)), float) / 255
    edge = np.clip((edge + 0.16 * noise(rng, h, w, 0.7) - 0.5) * 2.2 + 0.5, 0, 1)[:, :, None]
    grain = (noise(rng, h, w, 1.0) * 12 + noise(rng, h, w, 0.4) * 7)[:, :, None]
    pits = (noise(rng, h, w, 0.6) > 2.2)[:, :, None] * -35.0
    face = np.asarray(faces, float) + grain + pits
    inner = np.asarray(image.filter(ImageFilter.GaussianBlur(3)), float)
    relief = (np.roll(inner, 1, 0) - np.roll(inner, -1, 0))[:, :, None] * -0.45  # lit from above
    picture = edge * face + (1 - edge) * mortar + relief
    picture += 8 * noise(rng, h, w, 1.6)[:, :, None]
    return shade_corners(picture, metres)


def leaf(draw, rng, x, y, size, angle, color):
    points = []
    bend = rng.uniform(-0.3, 0.3)
    for t in np.linspace(0, 1, 12):
        points.append((t - 0.5, 0.22 * math.sin(math.pi * t ** 0.8) + bend * t * (1 - t)))
    for t in np.linspace(1, 0, 12):
        points.append((t - 0.5, -0.22 * math.sin(math.pi * t ** 0.8) + bend * t * (1 - t)))
    c, s = math.cos(angle), math.sin(angle)
    at = [(x + size * (c * px - s * py), y + size * (s * px + c * py)) for px, py in points]
    draw.polygon(at, fill=color)
    dark = tuple(int(v * 0.72) for v in color)
    draw.line([at[0], at[12]], fill=dark, width=max(1, int(size / 40)))
    for k in range(2, 10, 2):
        draw.line([at[k], at[23 - k]], fill=dark, width=1)


def wallpaper(name, metres, ground, palette, texel=0.0025):
    """Climbing leaves and blossoms, every one its own."""
    rng = rng_of(name)
    w, h = round(metres[0] / texel), round(metres[1] / texel)
    image = Image.new("RGB", (w * 2, h * 2), ground)
    draw = ImageDraw.Draw(image)
    for _ in range(26):  # stems
        x, y = rng.uniform(0, 2 * w), 2 * h
        heading = -math.pi / 2 + rng.uniform(-0.4, 0.4)
        path = [(x, y)]
        while y > -50 and len(path) < 500:
            heading += rng.normal(0, 0.16) - 0.05 * (heading + math.pi / 2)
            x, y = x + 24 * math.cos(heading), y + 24 * math.sin(heading)
            path.append((x, y))
            if rng.random() < 0.62:
                side = rng.choice((-1, 1))
                size = rng.uniform(50, 190)
                a = heading + side * rng.uniform(0.5, 1.3)
                color = tuple(int(v) for v in np.clip(np.array(palette[rng.integers(len(palette) - 2)]) * rng.uniform(0.7, 1.2), 0, 255))
                leaf(draw, rng, x + 0.5 * size * math.cos(a), y + 0.5 * size * math.sin(a), size, a, color)
            if rng.random() < 0.07:
                color = palette[-1 - int(rng.integers(2))]
                petals, r = rng.integers(5, 8), rng.uniform(20, 52)
                turn = rng.uniform(0, 6)
                for p in range(petals):
                    a = turn + p * 2 * math.pi / petals
                    cx, cy = x + r * math.cos(a), y + r * math.sin(a)
                    tint = tuple(int(v * rng.uniform(0.82, 1.0)) for v in color)
                    draw.ellipse((cx - 0.62 * r, cy - 0.62 * r, cx + 0.62 * r, cy + 0.62 * r), fill=tint)
                draw.ellipse((x - 0.5 * r, y - 0.5 * r, x + 0.5 * r, y + 0.5 * r), fill=(214, 168, 70))
        draw.line(path, fill=tuple(int(v * 0.6) for v in palette[0]), width=5, joint="curve")
    picture = np.asarray(image.resize((w, h), Image.BOX), float)
    picture += (6 * noise(rng, h, w, 1.2) + 4 * noise(rng, h, w, 0.3))[:, :, None]
    return shade_corners(picture, metres)


def plank_grain(rng, h, w, tone):
    """One plank, the grain along x."""
    rings = noise(rng, h, w, 1.5, (1.0, 9.0))
    fine = noise(rng, h, w, 0.7, (1.0, 25.0))
    wave = np.sin(rings * 4.2 + np.linspace(0, rng.uniform(2, 9), h)[:, None])
    value = 1 + 0.09 * wave + 0.07 * fine + 0.05 * rings
    picture = np.array(tone)[None, None, :] * value[:, :, None]
    for _ in range(rng.poisson(0.5)):  # knots
        cx, cy, r = rng.uniform(0, w), rng.uniform(0.2, 0.8) * h, rng.uniform(3, 9)
        yy, xx = np.mgrid[0:h, 0:w]
        d = np.hypot((xx - cx) / 1.7, yy - cy) / r
        picture *= (1 - 0.55 * np.exp(-d ** 2) - 0.16 * np.exp(-(d - 2) ** 2 * 3))[:, :, None]
    return picture


def planks(name, metres, tone, texel=0.0025, plank_width=0.11, dark_gap=0.35, lengths=(0.5, 1.4)):
    rng = rng_of(name)
    w, h = round(metres[0] / texel), round(metres[1] / texel)
    picture = np.zeros((h, w, 3))
    row = plank_width / texel
    y = 0.0
    while y < h:
        y0, y1 = round(y), min(h, round(y + row))
        x = -rng.uniform(0, lengths[0]) / texel
        while x < w:
            length = rng.uniform(*lengths) / texel
            x0, x1 = max(0, round(x)), min(w, round(x + length))
            if x1 - x0 > 4 and y1 - y0 > 2:
                shade = np.array(tone) * (1 + 0.17 * rng.normal()) + np.array((6, 0, -6)) * rng.normal()
                plank = plank_grain(rng, y1 - y0, x1 - x0, shade)
                plank[0, :] *= dark_gap
                plank[-1, :] *= 0.85
                plank[:, :1] *= dark_gap
                picture[y0:y1, x0:x1] = plank
            x += length
        y += row
    for _ in range(int(metres[0] * metres[1] * 3)):  # scratches and stains
        x, yy = rng.uniform(0, w), rng.uniform(0, h)
        r = rng.uniform(2, 12)
        ys, xs = np.ogrid[0:h, 0:w]
        x0, x1, y0, y1 = int(max(0, x - 40)), int(min(w, x + 40)), int(max(0, yy - 40)), int(min(h, yy + 40))
        d = ((xs[:, x0:x1] - x) / r) ** 2 + ((ys[y0:y1] - yy) / r) ** 2
        picture[y0:y1, x0:x1] *= (1 - 0.25 * rng.random() * np.exp(-d))[:, :, None]
    return picture + 5 * noise(rng, h, w, 0.4)[:, :, None]


def carpet(name, size):
    rng = rng_of(name)
    h, w = size
    image = Image.new("RGB", (w, h), (128, 36, 40))
    draw = ImageDraw.Draw(image)
    inks = [(24, 40, 82), (206, 182, 132), (150, 60, 40), (66, 92, 84), (226, 206, 170), (92, 22, 30), (190, 130, 60)]
    for inset, color in ((0, 1), (14, 0), (70, 1), (76, 5)):
        draw.rectangle((inset, inset, w - 1 - inset, h - 1 - inset), fill=inks[color])
    for k in range(150):  # border
        side = k % 4
        s = rng.uniform(10, 22)
        x, y = ((rng.uniform(20, w - 20), 42), (rng.uniform(20, w - 20), h - 42), (42, rng.uniform(20, h - 20)), (w - 42, rng.uniform(20, h - 20)))[side]
        n = rng.integers(3, 7)
        turn = rng.uniform(0, 6)
        draw.polygon([(x + s * math.cos(turn + 6.2832 * i / n), y + s * math.sin(turn + 6.2832 * i / n)) for i in range(n)],
                     fill=inks[rng.integers(1, 7)], outline=inks[rng.integers(7)])
    for k in range(520):  # field: large first
        s = 95 * (1 - k / 520) ** 1.6 + 9
        x, y = rng.uniform(90, w - 90), rng.uniform(90, h - 90)
        n = int(rng.choice((3, 4, 4, 6, 8)))
        turn = rng.uniform(0, 6)
        for scale in (1.0, 0.62, 0.3):
            r = s * scale
            draw.polygon([(x + r * math.cos(turn + 6.2832 * i / n), y + r * math.sin(turn + 6.2832 * i / n)) for i in range(n)],
                         fill=inks[rng.integers(7)])
    picture = np.asarray(image.filter(ImageFilter.GaussianBlur(0.7)), float)
    return picture * (1 + 0.10 * noise(rng, h, w, 0.2) + 0.05 * noise(rng, h, w, 1.2))[:, :, None]


def fabric(name, size, ground, inks):
    """Woven cloth with patches of unlike size."""
    rng = rng_of(name)
    image = Image.new("RGB", (size, size), ground)
    draw = ImageDraw.Draw(image)
    for _ in range(900):
        s = 6 / (rng.random() + 0.08)
        x, y = rng.uniform(0, size, 2)
        color = tuple(int(v) for v in np.clip(np.array(inks[rng.integers(len(inks))]) * rng.uniform(0.75, 1.2), 0, 255))
        turn = rng.uniform(0, 6)
        n = rng.integers(3, 6)
        for dx in (-size, 0, size):  # the cloth is laid on in whole repeats larger than a face
            draw.polygon([(x + dx + s * math.cos(turn + 6.2832 * i / n), y + s * math.sin(turn + 6.2832 * i / n)) for i in range(n)], fill=color)
    picture = np.asarray(image.filter(ImageFilter.GaussianBlur(0.6)), float)
    weave = noise(rng, size, size, 0.2, (1, 6)) + noise(rng, size, size, 0.2, (6, 1))
    return picture * (1 + 0.06 * weave + 0.06 * noise(rng, size, size, 1.2))[:, :, None]


def plaster(name, metres, texel=0.005):
    rng = rng_of(name)
    w, h = round(metres[0] / texel), round(metres[1] / texel)
    field = 5 * noise(rng, h, w, 1.3) + 5 * noise(rng, h, w, 0.5)
    relief = noise(rng, h, w, 0.9)
    picture = canvas(h, w, (226, 222, 212)) + field[:, :, None] + (np.maximum(relief - 1.6, 0) * -16)[:, :, None]
    return shade_corners(picture, metres)


# ---------------------------------------------------------------------------------------------------------- pictures


def dead_leaves(name, size, palette, count=2600, largest=150):
    """Overlapping discs and shards with radii of density r^-3: the occlusion statistics of natural images."""
    rng = rng_of(name)
    w, h = size
    image = Image.new("RGB", (w * 2, h * 2), palette[0])
    draw = ImageDraw.Draw(image)
    smallest = 5.0
    for _ in range(count):
        r = min(largest * 2, smallest / math.sqrt(rng.random() + (smallest / (2 * largest)) ** 2))
        x, y = rng.uniform(0, 2 * w), rng.uniform(0, 2 * h)
        color = tuple(int(v) for v in np.clip(np.array(palette[rng.integers(len(palette))]) * rng.uniform(0.65, 1.25) + rng.normal(0, 6, 3), 0, 255))
        if rng.random() < 0.5:
            draw.ellipse((x - r, y - r * 0.8, x + r, y + r * 0.8), fill=color)
        else:
            n, turn = rng.integers(3, 6), rng.uniform(0, 6)
            draw.polygon([(x + r * math.cos(turn + 6.2832 * i / n), y + r * math.sin(turn + 6.2832 * i / n)) for i in range(n)], fill=color)
    picture = np.asarray(image.resize((w, h), Image.BOX), float)
    return picture * (1 + 0.05 * noise(rng, h, w, 1.0))[:, :, None]


def landscape(name, size, sky, far, near):
    rng = rng_of(name)
    w, h = size
    picture = np.linspace(0, 1, h)[:, None, None] * np.array((40, 20, -40)) + np.array(sky)
    picture = np.broadcast_to(picture, (h, w, 3)).copy() + 14 * noise(rng, h, w, 1.7, (1, 2.5))[:, :, None]
    yy = np.arange(h)[:, None]
    sun = np.hypot(np.arange(w)[None, :] - 0.68 * w, yy - 0.24 * h)
    picture += np.array((70, 60, 30)) * np.clip(1.6 - sun / (0.055 * w), 0, 1)[:, :, None]
    layers = 7
    for k in range(layers):
        t = k / (layers - 1)
        ridge = np.interp(np.arange(w), np.linspace(0, w, 4096), np.cumsum(rng.normal(0, 1, 4096)))
        ridge = (ridge - np.linspace(ridge[0], ridge[-1], w))
        ridge = ridge / (np.abs(ridge).max() + 1e-9) * h * (0.16 - 0.06 * t)
        line = h * (0.36 + 0.52 * t) - ridge
        color = np.array(far) * (1 - t) + np.array(near) * t
        texture = 1 + (0.05 + 0.12 * t) * noise(rng, h, w, 1.1) + 0.05 * t * noise(rng, h, w, 0.3)
        picture = np.where((yy > line[None, :])[:, :, None], color[None, None, :] * texture[:, :, None], picture)
    image = Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8))
    draw = ImageDraw.Draw(image)
    for _ in range(120):  # firs
        x, y = rng.uniform(0, w), h * rng.uniform(0.80, 1.05)
        s = h * rng.uniform(0.03, 0.11)
        color = tuple(int(v * rng.uniform(0.4, 0.8)) for v in near)
        for k in range(3):
            draw.polygon([(x, y - s * (1 - 0.22 * k)), (x - s * (0.14 + 0.08 * k), y - s * (0.45 - 0.22 * k)),
                          (x + s * (0.14 + 0.08 * k), y - s * (0.45 - 0.22 * k))], fill=color)
    return np.asarray(image, float)


def type_poster(name, size, paper, ink, accent):
    rng = rng_of(name)
    w, h = size
    image = Image.new("RGB", (w, h), paper)
    draw = ImageDraw.Draw(image)
    draw.rectangle((0, 0, w, h * 0.23), fill=accent)
    draw.text((w * 0.06, h * 0.045), word(rng).upper(), font=font(int(h * 0.095)), fill=paper)
    draw.text((w * 0.06, h * 0.155), "%s & %s" % (word(rng), word(rng)), font=font(int(h * 0.042), "Serif-Bold"), fill=ink)
    y = h * 0.27
    draw.ellipse((w * 0.52, h * 0.27, w * 0.95, h * 0.27 + w * 0.43), fill=ink)
    draw.polygon([(w * 0.60, h * 0.50), (w * 0.86, h * 0.30), (w * 0.90, h * 0.52)], fill=accent)
    draw.rectangle((w * 0.64, h * 0.36, w * 0.72, h * 0.47), fill=paper)
    while y < h * 0.94:
        size_now = int(h * rng.choice((0.018, 0.022, 0.03, 0.045), p=(0.4, 0.3, 0.2, 0.1)))
        text = " ".join(word(rng) for _ in range(9))
        limit = w * (0.44 if y < h * 0.58 else 0.88)
        face = font(size_now, str(rng.choice(("Sans", "Serif", "Sans-Bold", "SansMono"))))
        while draw.textlength(text, font=face) > limit and " " in text:
            text = text.rsplit(" ", 1)[0]
        draw.text((w * 0.06, y), text, font=face, fill=ink if rng.random() < 0.8 else accent)
        y += size_now * 1.45
    picture = np.asarray(image.filter(ImageFilter.GaussianBlur(0.5)), float)
    return picture + 5 * noise(rng, h, w, 1.0)[:, :, None]


def city_map(name, size):
    rng = rng_of(name)
    w, h = size
    seeds = rng.uniform(0, 1, (90, 2)) * (w, h)
    yy, xx = np.mgrid[0:h, 0:w]
    warp_x, warp_y = 18 * noise(rng, h, w, 1.6), 18 * noise(rng, h, w, 1.6)
    nearest, second, owner = np.full((h, w), 1e9), np.full((h, w), 1e9), np.zeros((h, w), int)
    for k, (sx, sy) in enumerate(seeds):
        d = np.hypot(xx + warp_x - sx, yy + warp_y - sy)
        closer = d < nearest
        second = np.where(closer, nearest, np.minimum(second, d))
        owner = np.where(closer, k, owner)
        nearest = np.where(closer, d, nearest)
    tones = np.array([(224, 214, 190), (204, 220, 184), (232, 224, 208), (178, 204, 160), (214, 196, 176), (236, 214, 170)], float)
    picture = tones[rng.integers(0, len(tones), 90)][owner]
    sea = noise(rng, h, w, 1.9) > 0.9
    picture = np.where(sea[:, :, None], np.array((132, 172, 204.0)), picture)
    picture = np.where(((second - nearest) < 5)[:, :, None], np.array((250, 246, 236.0)), picture)
    picture = np.where(((second - nearest) < 1.6)[:, :, None], np.array((196, 120, 70.0)), picture)
    image = Image.fromarray(picture.astype(np.uint8))
    draw = ImageDraw.Draw(image)
    for sx, sy in seeds:
        for _ in range(rng.integers(3, 12)):
            x, y, s = sx + rng.normal(0, 22), sy + rng.normal(0, 22), rng.uniform(2, 7)
            draw.rectangle((x, y, x + s * rng.uniform(0.6, 2), y + s), fill=(150, 130, 118))
        if rng.random() < 0.7:
            draw.text((sx - 30, sy), word(rng), font=font(int(rng.integers(10, 20)), "Serif"), fill=(60, 44, 40))
    for _ in range(7):
        a, b = rng.uniform(0, 1, 2) * (w, h), rng.uniform(0, 1, 2) * (w, h)
        draw.line([tuple(a), tuple((a + b) / 2 + rng.normal(0, 40, 2)), tuple(b)], fill=(214, 88, 60), width=4)
    draw.rectangle((0, 0, w - 1, h - 1), outline=(90, 60, 40), width=10)
    return np.asarray(image, float) + 4 * noise(rng, h, w, 1.0)[:, :, None]


def spines(name, size, rows):
    """Book spines side by side in rows; returns the picture and the books as (x0, x1, row)."""
    rng = rng_of(name)
    w, h = size
    image = Image.new("RGB", (w, h * rows), (40, 30, 26))
    books = []
    covers = [(136, 34, 36), (30, 56, 104), (34, 88, 66), (208, 190, 150), (54, 44, 52), (190, 120, 44), (96, 40, 92),
              (222, 216, 204), (70, 112, 138), (160, 70, 60), (120, 128, 62)]
    for row in range(rows):
        x = 0
        while x < w - 60:
            bw = int(rng.integers(20, 56))
            base = np.array(covers[rng.integers(len(covers))], float) * rng.uniform(0.75, 1.15)
            spine = Image.new("RGB", (h, bw), tuple(int(v) for v in np.clip(base, 0, 255)))
            draw = ImageDraw.Draw(spine)
            ink = (238, 222, 170) if base.mean() < 130 else (40, 26, 24)
            for band in rng.uniform(0.03, 0.97, rng.integers(1, 5)):
                width = int(rng.integers(2, 9))
                tone = np.clip(base * rng.choice((0.5, 1.6)), 0, 255)
                draw.rectangle((band * h, 0, band * h + width, bw), fill=tuple(int(v) for v in tone))
            face = font(int(bw * rng.uniform(0.4, 0.62)), str(rng.choice(("Serif-Bold", "Sans-Bold", "Serif"))))
            draw.text((h * rng.uniform(0.06, 0.16), bw * 0.14), word(rng) + " " + word(rng), font=face, fill=ink)
            draw.text((h * rng.uniform(0.66, 0.74), bw * 0.24), word(rng), font=font(max(9, int(bw * 0.32)), "Sans"), fill=ink)
            if rng.random() < 0.4:
                c = h * rng.uniform(0.55, 0.62)
                draw.ellipse((c, bw * 0.3, c + bw * 0.4, bw * 0.7), fill=ink)
            image.paste(spine.rotate(-90, expand=True), (x, row * h))
            books.append((x, x + bw, row))
            x += bw
    order = rng.permutation(len(books))
    picture = np.asarray(image, float)
    picture += (6 * noise(rng, h * rows, w, 0.8) + 3 * noise(rng, h * rows, w, 0.2))[:, :, None]
    return picture, [books[i] for i in order]


def parcels(name, size):
    """Sides of cardboard boxes and tins: 4 x 2 of them, each with its label."""
    rng = rng_of(name)
    image = Image.new("RGB", (size, size // 2), (176, 136, 92))
    draw = ImageDraw.Draw(image)
    cell = size // 4
    grounds = [(182, 140, 94), (170, 128, 84), (44, 92, 128), (196, 60, 48), (228, 222, 206), (52, 110, 74), (190, 150, 104), (232, 186, 60)]
    for k, ground in enumerate(grounds):
        x, y = (k % 4) * cell, (k // 4) * cell
        draw.rectangle((x, y, x + cell, y + cell), fill=ground)
        draw.rectangle((x, y + cell * 0.44, x + cell, y + cell * 0.54), fill=tuple(int(v * 0.82) for v in ground))
        lx, ly = x + rng.uniform(0.06, 0.3) * cell, y + rng.uniform(0.08, 0.3) * cell
        draw.rectangle((lx, ly, lx + cell * 0.56, ly + cell * 0.4), fill=(240, 238, 230), outline=(30, 30, 30), width=2)
        draw.text((lx + 8, ly + 6), word(rng).upper(), font=font(int(cell * 0.1)), fill=(20, 20, 24))
        for row in range(4):
            draw.text((lx + 8, ly + cell * (0.14 + 0.055 * row)), " ".join(word(rng) for _ in range(3)), font=font(int(cell * 0.042), "Sans"), fill=(40, 40, 46))
        bar = lx + 8
        for _ in range(22):
            bw = rng.uniform(1, 4)
            draw.rectangle((bar, ly + cell * 0.345, bar + bw, ly + cell * 0.39), fill=(16, 16, 16))
            bar += bw + rng.uniform(1.5, 5)
        for _ in range(7):
            a, b, s = x + rng.uniform(0.05, 0.9) * cell, y + rng.uniform(0.6, 0.92) * cell, rng.uniform(5, 20)
            draw.polygon([(a, b - s), (a + s, b + s * 0.4), (a - s * 0.8, b + s * 0.6)], fill=tuple(int(v * rng.uniform(0.3, 1.25)) % 256 for v in ground))
    h, w = size // 2, size
    return np.asarray(image, float) * (1 + 0.04 * noise(rng, h, w, 1.0) + 0.03 * noise(rng, h, w, 0.3, (1, 6)))[:, :, None]


# ------------------------------------------------------------------------------------------------------------- mesh


class Obj:
    def __init__(self):
        self.lines, self.materials, self.current = [], {}, None
        self.v = self.vt = self.vn = 0

    def material(self, name, texture=None, color=(1, 1, 1), emission=(0, 0, 0)):
        self.materials[name] = (texture, color, emission)

    def use(self, group, material):
        if (group, material) != self.current:
            self.lines += [f"o {group}", f"usemtl {material}"]
            self.current = (group, material)

    def corner(self, p, uv, n):
        self.lines.append("v %.5f %.5f %.5f" % tuple(p))
        self.lines.append("vt %.6f %.6f" % (uv[0], 1 - uv[1]))  # our v runs down, OBJ's up
        self.lines.append("vn %.5f %.5f %.5f" % tuple(n))
        self.v += 1
        return self.v

    def face(self, corners):
        self.lines.append("f " + " ".join(f"{c}/{c}/{c}" for c in corners))

    def quad(self, group, material, upper_left, right, down, uv=(0, 0, 1, 1)):
        """uv = (u0, v0, u1, v1): the part of the picture, from its upper left."""
        self.use(group, material)
        p, r, d = (np.array(a, float) for a in (upper_left, right, down))
        n = np.cross(d, r)
        n /= np.linalg.norm(n)
        u0, v0, u1, v1 = uv
        self.face([self.corner(p, (u0, v0), n), self.corner(p + d, (u0, v1), n), self.corner(p + d + r, (u1, v1), n),
                   self.corner(p + r, (u1, v0), n)])

    def box(self, group, material, low, high, texture_metres=None, rng=None, cells=None, turn=0.0):
        """Faces take pieces of the texture to scale (texture_metres a side), from random places; or one of the cells."""
        low, high = np.array(low, float), np.array(high, float)
        middle, s = (low + high) / 2, high - low
        c, sn = math.cos(turn), math.sin(turn)
        rot = np.array(((c, 0, sn), (0, 1, 0), (-sn, 0, c)))
        sides = [((-1, 1, 1), (s[0], 0, 0), (0, -s[1], 0)), ((1, 1, -1), (-s[0], 0, 0), (0, -s[1], 0)),
                 ((-1, 1, -1), (0, 0, s[2]), (0, -s[1], 0)), ((1, 1, 1), (0, 0, -s[2]), (0, -s[1], 0)),
                 ((-1, 1, -1), (s[0], 0, 0), (0, 0, s[2])), ((-1, -1, 1), (s[0], 0, 0), (0, 0, -s[2]))]
        for k, (corner, right, down) in enumerate(sides):
            p = middle + rot @ (np.array(corner) * s / 2)
            right, down = rot @ np.array(right), rot @ np.array(down)
            if cells is not None:
                uv = cells[k % len(cells)]
            elif texture_metres is not None:
                w, h = np.linalg.norm(right) / texture_metres, np.linalg.norm(down) / texture_metres
                u, v = rng.uniform(0, 1, 2)
                uv = (u, v, u + w, v + h)
                if h > w:  # grain along the longer side
                    self.quad(group, material, p + down, -down, right, (u, v, u + h, v + w))
                    continue
            else:
                uv = (0, 0, 1, 1)
            self.quad(group, material, p, right, down, uv)

    def lathe(self, group, material, center, profile, segments=40, uv=(0, 0, 1, 1)):
        """profile: (radius, height) from top to bottom."""
        self.use(group, material)
        profile = np.array(profile, float)
        rings = []
        for i, (r, y) in enumerate(profile):
            a, b = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
            slope = b - a
            normal = np.array((-slope[1], slope[0]))
            normal /= max(np.linalg.norm(normal), 1e-9)
            ring = []
            for k in range(segments + 1):
                t = 2 * math.pi * k / segments
                cs, sn = math.cos(t), math.sin(t)
                ring.append(self.corner(np.array(center) + (r * cs, y, r * sn), (uv[0] + (uv[2] - uv[0]) * k / segments,
                                        uv[1] + (uv[3] - uv[1]) * i / (len(profile) - 1)), (normal[0] * cs, normal[1], normal[0] * sn)))
            rings.append(ring)
        for i in range(len(rings) - 1):
            for k in range(segments):
                self.face([rings[i][k], rings[i][k + 1], rings[i + 1][k + 1], rings[i + 1][k]])

    def write(self, name):
        header = ["# The room of vobench, made by make_room.py. CC0 1.0: no rights reserved.", f"mtllib {name}.mtl"]
        (HERE / f"{name}.obj").write_text("\n".join(header + self.lines) + "\n")
        text = ["# Made by make_room.py. CC0 1.0."]
        for material, (texture, color, emission) in self.materials.items():
            text += [f"newmtl {material}", "Kd %g %g %g" % color, "Ke %g %g %g" % emission]
            if texture:
                text.append(f"map_Kd {texture}")
        (HERE / f"{name}.mtl").write_text("\n".join(text) + "\n")


def sphere_profile(radius, rings=24):
    return [(max(radius * math.sin(math.pi * i / rings), 1e-4), radius * math.cos(math.pi * i / rings)) for i in range(rings + 1)]


def textures():
    save("wall_north.jpg", bricks("north", (WIDTH, HEIGHT)))
    save("wall_east.jpg", wallpaper("east", (DEPTH, HEIGHT), (206, 200, 178), [(74, 104, 72), (106, 130, 84), (58, 84, 92), (136, 142, 96), (184, 84, 82), (222, 170, 160)]))
    save("wall_west.jpg", wallpaper("west", (DEPTH, HEIGHT), (150, 170, 178), [(52, 80, 96), (84, 112, 104), (120, 96, 84), (60, 96, 76), (216, 200, 170), (204, 132, 92)]))
    save("wall_south.jpg", planks("south", (WIDTH, HEIGHT), (176, 160, 136), plank_width=0.16))
    save("floor.jpg", shade_corners(planks("floor", (WIDTH, DEPTH), (152, 104, 66)), (WIDTH, DEPTH)))
    save("ceiling.jpg", plaster("ceiling", (WIDTH, DEPTH)))
    save("carpet.jpg", carpet("carpet", (1000, 1440)))
    save("wood_dark.jpg", planks("dark", (1.25, 1.25), (98, 64, 42), 0.00125, 0.25, 0.9, (3, 4)))
    save("wood_light.jpg", planks("light", (1.25, 1.25), (196, 158, 112), 0.00125, 0.625, 0.9, (3, 4)))
    save("sofa.jpg", fabric("sofa", 900, (70, 96, 112), [(58, 82, 98), (92, 122, 136), (150, 160, 150), (40, 60, 80)]))
    save("cushion.jpg", fabric("cushion", 500, (196, 120, 60), [(226, 200, 140), (150, 60, 46), (70, 50, 60), (210, 150, 70)]))
    save("poster_leaves.jpg", dead_leaves("leaves", (820, 600), [(40, 70, 60), (120, 140, 80), (200, 170, 90), (150, 60, 50), (60, 90, 130), (220, 210, 190)]))
    save("poster_hills.jpg", landscape("hills", (1000, 640), (176, 190, 214), (140, 156, 176), (46, 66, 44)))
    save("poster_dusk.jpg", landscape("dusk", (560, 760), (206, 150, 120), (170, 120, 130), (52, 40, 62)))
    save("poster_type.jpg", type_poster("type", (560, 800), (236, 228, 208), (30, 36, 50), (192, 66, 44)))
    save("poster_type2.jpg", type_poster("type2", (560, 800), (46, 62, 74), (232, 224, 200), (222, 160, 60)))
    save("poster_map.jpg", city_map("map", (1000, 740)))
    save("poster_shards.jpg", dead_leaves("shards", (600, 760), [(206, 190, 160), (60, 60, 70), (170, 84, 60), (90, 130, 140), (220, 180, 90)], 1800, 120))
    save("globe.jpg", city_map("globe", (900, 450)))
    save("parcels.jpg", parcels("parcels", 1024))
    picture, books = spines("spines", (2000, 300), BOOK_ROWS)
    save("books.jpg", picture)
    return books


def cell(k):
    """The k-th picture of parcels.jpg, as a part of it."""
    return (k % 4) / 4 + 0.002, (k // 4) / 2 + 0.004, (k % 4 + 1) / 4 - 0.002, (k // 4 + 1) / 2 - 0.004


def things():
    """What moving.yaml moves, each about its own middle."""
    o = Obj()
    o.material("parcels", "parcels.jpg")
    o.box("parcel", "parcels", (-0.16, -0.11, -0.13), (0.16, 0.11, 0.13), cells=[cell(k) for k in (0, 1, 2, 6, 5, 3)])
    o.write("parcel")
    o = Obj()
    o.material("globe", "globe.jpg")
    o.lathe("ball", "globe", (0, 0, 0), sphere_profile(0.13, 16), 32)
    o.write("ball")


def furnish(spine_columns):
    rng = rng_of("furniture")
    o = Obj()
    for name in ("wall_north", "wall_east", "wall_west", "wall_south", "floor", "ceiling", "carpet", "wood_dark", "wood_light", "sofa", "cushion",
                 "poster_leaves", "poster_hills", "poster_dusk", "poster_type", "poster_type2", "poster_map", "poster_shards", "globe",
                 "parcels", "books"):
        o.material(name, name + ".jpg")
    o.material("white", None, (0.75, 0.74, 0.70))
    o.material("pages", None, (0.72, 0.66, 0.52))
    o.material("black", None, (0.03, 0.03, 0.035))
    o.material("brass", None, (0.55, 0.40, 0.16))
    o.material("clay", None, (0.52, 0.22, 0.12))
    o.material("lamp", None, (0.8, 0.8, 0.8), (0.95, 0.88, 0.72))

    W, H, D = WIDTH, HEIGHT, DEPTH
    o.quad("north", "wall_north", (0, H, 0), (W, 0, 0), (0, -H, 0))
    o.quad("east", "wall_east", (W, H, 0), (0, 0, D), (0, -H, 0))
    o.quad("south", "wall_south", (W, H, D), (-W, 0, 0), (0, -H, 0))
    o.quad("west", "wall_west", (0, H, D), (0, 0, -D), (0, -H, 0))
    o.quad("floor", "floor", (0, 0, 0), (W, 0, 0), (0, 0, D))
    o.quad("ceiling", "ceiling", (0, H, D), (W, 0, 0), (0, 0, -D))
    o.box("carpet", "carpet", (1.35, 0.0, 0.95), (3.75, 0.012, 2.6), cells=[(0, 0, 0.02, 0.02)] * 4 + [(0, 0, 1, 1)])
    for a, b in (((0, 0, 0), (W, 0.09, 0.018)), ((0, 0, D - 0.018), (W, 0.09, D)), ((0, 0, 0), (0.018, 0.09, D)), ((W - 0.018, 0, 0), (W, 0.09, D))):
        o.box("skirting", "white", a, b)
    o.box("ceiling lamp", "lamp", (2.0, H - 0.05, 1.7), (3.2, H - 0.02, 2.3))

    def framed(group, picture, corner, right, down, frame="wood_dark", wide=0.03):
        """A picture hung on a wall: corner is its upper left, seen from the front."""
        p, r, d = (np.array(v, float) for v in (corner, right, down))
        ru, du = r / np.linalg.norm(r), d / np.linalg.norm(d)
        out = np.cross(du, ru) * 0.025
        o.quad(group, picture, p + out * 0.6, r, d)
        for q, along, across in ((p - wide * (ru + du), r + 2 * wide * ru, wide * du), (p + d - wide * ru, r + 2 * wide * ru, wide * du),
                                 (p - wide * ru, wide * ru, d), (p + r, wide * ru, d)):
            u, v = rng.uniform(0, 1, 2)
            o.quad(group, frame, q + out, along, across, (u, v, u + np.linalg.norm(along), v + np.linalg.norm(across)))
            for edge, side in ((q, along), (q + across, along), (q, across), (q + along, across)):
                o.quad(group, frame, edge + out, side, -out, (u, v, u + 0.1, v + 0.02))

    framed("hills", "poster_hills", (1.42, 2.15, 0), (1.0, 0, 0), (0, -0.64, 0))
    framed("type", "poster_type", (2.68, 2.25, 0), (0.50, 0, 0), (0, -0.714, 0), "black", 0.015)
    framed("leaves", "poster_leaves", (3.45, 2.1, 0), (0.82, 0, 0), (0, -0.6, 0), "wood_light")
    framed("shards", "poster_shards", (4.45, 2.0, 0), (0.42, 0, 0), (0, -0.532, 0), "black", 0.015)
    framed("map", "poster_map", (W, 2.1, 0.75), (0, 0, 1.0), (0, -0.74, 0), "wood_dark")
    framed("dusk", "poster_dusk", (W, 2.05, 2.2), (0, 0, 0.56), (0, -0.76, 0), "wood_light")
    framed("type2", "poster_type2", (0, 2.1, 1.6), (0, 0, -0.5), (0, -0.714, 0), "black", 0.015)
    framed("hills2", "poster_leaves", (3.6, 2.0, D), (-1.2, 0, 0), (0, -0.88, 0), "wood_dark")

    # Bookshelf in the north-west corner: uprights, shelves, books.
    x0, x1, deep = 0.12, 1.22, 0.30
    for x in (x0, (x0 + x1) / 2, x1):
        o.box("shelf", "wood_light", (x - 0.012, 0.0, 0.01), (x + 0.012, 2.02, deep), 1.25, rng)
    levels = (0.06, 0.42, 0.76, 1.10, 1.42, 1.72, 2.02)
    for y in levels:
        o.box("shelf", "wood_light", (x0, y - 0.012, 0.01), (x1, y + 0.012, deep), 1.25, rng)
    o.box("shelf back", "wood_dark", (x0, 0.05, 0.004), (x1, 2.02, 0.012), 1.25, rng)
    stack = list(spine_columns)  # every book stands in the room once

    def thickness():
        return (stack[-1][1] - stack[-1][0]) * 0.001

    def book(x, y, z_front, height, depth):
        c0, c1, row = stack.pop()
        thick = (c1 - c0) * 0.001
        top, bottom = row / BOOK_ROWS, (row + 1) / BOOK_ROWS
        cover = ((c0 + 2) / 2000, top + 0.02, (c0 + 4) / 2000, top + 0.03)
        front = (c0 / 2000, top, c1 / 2000, bottom)
        o.box("books", "books", (x, y, z_front - depth), (x + thick, y + height, z_front), cells=[front, cover, cover, cover, cover, cover])
        o.quad("pages", "pages", (x + 0.002, y + height + 0.0005, z_front - depth), (thick - 0.004, 0, 0), (0, 0, depth - 0.006))
        return thick

    for k, y in enumerate(levels[:-1]):
        room = levels[k + 1] - y - 0.05
        for bay in (0, 1):
            x = x0 + 0.014 + bay * (x1 - x0) / 2
            end = x + (x1 - x0) / 2 - 0.03
            stop = end - rng.uniform(0.0, 0.24)
            while x + thickness() <= stop:
                x += book(x, y + 0.012, deep - rng.uniform(0.01, 0.06), min(room, rng.uniform(0.19, 0.29)), 0.17) + 0.001

    # Sideboard under the pictures, with things on it.
    o.box("sideboard", "wood_dark", (1.55, 0.12, 0.02), (3.35, 0.78, 0.46), 1.25, rng)
    for k in range(3):
        a = 1.57 + 0.59 * k
        o.box("sideboard doors", "wood_light", (a, 0.15, 0.46), (a + 0.58, 0.75, 0.475), 1.25, rng)
        o.lathe("knobs", "brass", (a + 0.52, 0.5, 0.492), sphere_profile(0.018, 10), 14)
    for x in (1.62, 3.28):
        for z in (0.08, 0.40):
            o.box("sideboard legs", "black", (x - 0.02, 0, z - 0.02), (x + 0.02, 0.12, z + 0.02))
    top = 0.78
    o.lathe("globe", "globe", (1.85, top + 0.21, 0.24), sphere_profile(0.16), 48)
    o.lathe("globe foot", "brass", (1.85, top, 0.24), [(0.02, 0.06), (0.03, 0.03), (0.10, 0.012), (0.10, 0.0)], 32)
    x = 2.25
    for _ in range(9):
        x += book(x, top, 0.34, rng.uniform(0.2, 0.28), 0.17) + 0.001
    o.box("tin", "parcels", (2.75, top, 0.14), (2.93, top + 0.2, 0.32), cells=[cell(3), cell(7), cell(4), cell(5), cell(3), cell(3)], turn=0.35)
    o.lathe("vase", "clay", (3.16, top, 0.25), [(0.045, 0.30), (0.04, 0.27), (0.05, 0.22), (0.085, 0.14), (0.09, 0.09), (0.06, 0.01), (0.055, 0.0)], 36)

    # Table in the middle with things on it; sofa on the east; parcels and a lamp in the corner.
    high = 0.76
    o.box("table", "wood_light", (1.95, high - 0.035, 1.15), (3.15, high, 1.80), 1.25, rng)
    for x in (2.0, 3.1):
        for z in (1.20, 1.75):
            o.box("table legs", "wood_dark", (x - 0.025, 0.012, z - 0.025), (x + 0.025, high - 0.035, z + 0.025), 1.25, rng)
    o.box("cloth", "cushion", (2.25, high, 1.20), (2.60, high + 0.003, 1.798), 0.5, rng)
    o.box("parcel", "parcels", (2.02, high, 1.36), (2.26, high + 0.17, 1.58), cells=[cell(k) for k in (0, 1, 2, 6, 1, 0)], turn=-0.3)
    o.box("atlas", "poster_shards", (2.62, high, 1.30), (2.94, high + 0.035, 1.54), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)], turn=0.5)
    o.box("atlas", "poster_map", (2.66, high + 0.035, 1.33), (2.90, high + 0.06, 1.51), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)], turn=0.1)
    o.lathe("ball", "globe", (2.45, high + 0.083, 1.42), sphere_profile(0.08), 36)
    o.lathe("tin", "books", (3.02, high, 1.58), [(1e-4, 0.15), (0.05, 0.15), (0.05, 0.149), (0.05, 0.001), (0.05, 0.0)], 36, (0.1, 0.02, 0.26, 0.3))
    x = 2.68
    for _ in range(4):
        x += book(x, high, 1.74, rng.uniform(0.2, 0.26), 0.16) + 0.001
    o.lathe("ball", "cushion", (3.06, high + 0.07, 1.30), sphere_profile(0.07), 36)
    o.box("sofa", "sofa", (4.15, 0.12, 0.75), (4.95, 0.42, 2.55), 0.9, rng)
    o.box("sofa back", "sofa", (4.78, 0.42, 0.75), (4.97, 0.86, 2.55), 0.9, rng)
    for z in (0.62, 2.55):
        o.box("sofa arm", "sofa", (4.15, 0.12, z), (4.95, 0.62, z + 0.14), 0.9, rng)
    for z, turn in ((0.98, 0.2), (1.6, -0.15), (2.25, 0.3)):
        o.box("cushion", "cushion", (4.60, 0.42, z - 0.2), (4.74, 0.80, z + 0.2), 0.5, rng, turn=turn)
    o.box("crate", "parcels", (3.62, 0.0, 0.12), (4.12, 0.42, 0.52), cells=[cell(k) for k in (1, 6, 0, 1, 6, 6)], turn=0.12)
    o.box("crate", "parcels", (3.68, 0.42, 0.16), (4.02, 0.72, 0.46), cells=[cell(k) for k in (4, 2, 5, 3, 7, 7)], turn=-0.25)
    o.box("crate", "parcels", (4.25, 0.0, 0.14), (4.60, 0.30, 0.48), cells=[cell(k) for k in (2, 5, 7, 4, 0, 0)], turn=0.4)
    o.lathe("floor lamp foot", "black", (4.72, 0, 0.30), [(0.012, 1.45), (0.012, 0.03), (0.15, 0.02), (0.15, 0.0)], 28)
    o.lathe("floor lamp shade", "lamp", (4.72, 1.40, 0.30), [(0.10, 0.28), (0.18, 0.0)], 36)
    # West: a chest with drawers; south: a long bench.
    o.box("chest", "wood_light", (0.02, 0.0, 1.2), (0.48, 0.9, 2.3), 1.25, rng)
    for k in range(3):
        o.box("drawers", "wood_dark", (0.48, 0.06 + 0.28 * k, 1.24), (0.495, 0.32 + 0.28 * k, 2.26), 1.25, rng)
    o.box("parcel", "parcels", (0.1, 0.9, 1.35), (0.38, 1.12, 1.65), cells=[cell(k) for k in (5, 3, 2, 7, 4, 4)], turn=0.3)
    o.lathe("ball", "globe", (0.25, 1.03, 1.98), sphere_profile(0.13), 40)
    o.box("bench", "wood_dark", (1.2, 0.40, 3.5), (3.8, 0.46, 3.92), 1.25, rng)
    for x in (1.3, 3.7):
        o.box("bench legs", "wood_dark", (x - 0.03, 0, 3.55), (x + 0.03, 0.40, 3.87), 1.25, rng)
    o.write("room")


if __name__ == "__main__":
    things()
    furnish(textures())
