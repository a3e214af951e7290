"""Walls, floors and cloth, drawn to scale: no brick, plank or leaf occurs twice in a picture."""
import math

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from noise import canvas, noise, rng_of, shade_corners


def bricks(name, metres, texel=0.0025, shade=True):
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
    return shade_corners(picture, metres) if shade else picture


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
