"""Pictures, posters, maps, book spines and boxes: what is printed. Its words are no language's."""
import math

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from noise import font, noise, rng_of, word


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
