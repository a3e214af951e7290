"""What faces a street: windows with what is seen in them, shop fronts, doors."""
from PIL import Image, ImageDraw

from noise import font, noise, rng_of, sheet, word


def window(rng, w, h):
    """Two sashes; behind the glass a curtain, a blind, a plant or a dark room, and the sky's reflection."""
    image = Image.new("RGB", (w, h), (36, 40, 46))
    draw = ImageDraw.Draw(image)
    for y in range(h):  # the sky, reflected above
        t = max(0.0, 1 - y / (h * 0.6)) * rng.uniform(0.95, 1.05)
        draw.line((0, y, w, y), fill=tuple(int(a + (b - a) * 0.6 * t) for a, b in zip((36, 40, 46), (150, 170, 196))))
    kind = int(rng.integers(4))
    if kind == 0:
        tone = rng.uniform(150, 225)
        for side in (0, 1):
            for k in range(9):
                x = k * w * 0.035 if side == 0 else w - (k + 1) * w * 0.035
                shade = int(tone * (0.78 + 0.22 * (k % 3) / 2))
                draw.rectangle((x, 0, x + w * 0.035, h), fill=(shade, shade, int(shade * 0.93)))
    elif kind == 1:
        stop = h * rng.uniform(0.3, 0.95)
        for y in range(0, int(stop), 9):
            draw.rectangle((0, y, w, y + 5), fill=(196, 194, 184))
    elif kind == 2:
        for _ in range(160):
            x, y, r = rng.normal(w * 0.5, w * 0.2), rng.uniform(h * 0.55, h), rng.uniform(4, 16)
            draw.ellipse((x - r, y - r * 0.4, x + r, y + r * 0.4), fill=(40 + int(rng.integers(40)), 80 + int(rng.integers(60)), 44))
    bar, frame = int(w * 0.05), (226, 222, 212) if rng.random() < 0.7 else (92, 66, 48)
    for box in ((0, 0, bar, h), (w - bar, 0, w, h), (0, 0, w, bar), (0, h - bar, w, h), (w / 2 - bar * 0.6, 0, w / 2 + bar * 0.6, h), (0, h * 0.32, w, h * 0.32 + bar * 0.8)):
        draw.rectangle(box, fill=frame)
    return image


def windows(name, w, h, columns, rows):
    rng = rng_of(name)
    return sheet(lambda k: window(rng, w, h), w, h, columns, rows) + 3 * noise(rng, h * rows, w * columns, 0.8)[:, :, None]


def shop(rng, w, h):
    color = tuple(int(v) for v in ((30, 60, 90), (120, 30, 34), (34, 84, 60), (190, 140, 50), (60, 50, 60), (200, 196, 186))[int(rng.integers(6))])
    image = Image.new("RGB", (w, h), color)
    draw = ImageDraw.Draw(image)
    ink = (236, 230, 214) if sum(color) < 380 else (40, 34, 40)
    draw.text((w * 0.08, h * 0.035), (word(rng) + " & " + word(rng)).upper(), font=font(int(h * 0.11), "Serif-Bold"), fill=ink)
    door = rng.uniform(0.05, 0.7)
    for k, (x0, x1) in enumerate(((door, door + 0.24), (0.04, door - 0.03), (door + 0.27, 0.96))):
        if x1 - x0 < 0.1:
            continue
        bottom = 0.98 if k == 0 else 0.82
        draw.rectangle((w * x0, h * 0.2, w * x1, h * bottom), fill=(44, 46, 50), outline=ink, width=5)
        for _ in range(60 if k else 6):
            x, y, s = rng.uniform(x0 + 0.01, x1 - 0.03) * w, rng.uniform(0.35, bottom - 0.05) * h, rng.uniform(6, 40)
            draw.rectangle((x, y, min(x + s, x1 * w - 6), min(y + s * rng.uniform(0.5, 1.6), bottom * h - 6)), fill=tuple(int(v) for v in rng.integers(40, 230, 3)))
        draw.text((w * (x0 + 0.015), h * 0.24), word(rng), font=font(int(h * 0.05), "Sans"), fill=(230, 226, 214))
    return image


def shops(name, w, h, columns, rows):
    rng = rng_of(name)
    return sheet(lambda k: shop(rng, w, h), w, h, columns, rows) * (1 + 0.03 * noise(rng, h * rows, w * columns, 1.0))[:, :, None]
