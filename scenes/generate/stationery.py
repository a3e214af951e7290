"""What lies and hangs in an office: printed pages, notices, door signs, screens, a keyboard; and collages of posters."""
import numpy as np
from PIL import Image, ImageDraw

from noise import font, noise, rng_of, sheet, word
from prints import city_map, dead_leaves, landscape, type_poster


def words(rng, count):
    return " ".join(word(rng).lower() for _ in range(count))


def text_block(draw, rng, x, y, width, height, size, ink=(30, 30, 34)):
    """Justified paragraphs."""
    face, bottom, left_in_paragraph = font(size, "Serif"), y + height, int(rng.integers(3, 9))
    while y + size * 1.3 < bottom:
        line = words(rng, 16)
        limit = width if left_in_paragraph else width * rng.uniform(0.3, 0.8)
        while draw.textlength(line, font=face) > limit:
            line = line.rsplit(" ", 1)[0]
        draw.text((x, y), line, font=face, fill=ink)
        y += size * (1.32 if left_in_paragraph else 1.9)
        left_in_paragraph = left_in_paragraph - 1 if left_in_paragraph else int(rng.integers(3, 9))


def plot(draw, rng, x, y, width, height):
    draw.rectangle((x, y, x + width, y + height), outline=(40, 40, 40))
    for _ in range(int(rng.integers(2, 5))):
        color = tuple(int(v) for v in rng.integers(20, 200, 3))
        steps = np.cumsum(rng.normal(0, 1, 24))
        steps = (steps - steps.min()) / (np.ptp(steps) + 1e-9)
        draw.line([(x + width * (k + 0.5) / 24, y + height * (0.9 - 0.8 * s)) for k, s in enumerate(steps)], fill=color, width=2)
    for k in range(5):
        draw.text((x + width * (k + 0.1) / 5, y + height + 2), str(int(rng.integers(1, 99))), font=font(max(8, int(height * 0.07)), "Sans"), fill=(60, 60, 60))


def page(rng, width, height):
    """One printed page of a paper, a letter, a listing or a sheet of figures."""
    image = Image.new("RGB", (width, height), (244, 242, 236))
    draw = ImageDraw.Draw(image)
    m, kind = int(width * 0.1), int(rng.integers(4))
    draw.text((m, m), f"{word(rng)} {word(rng).lower()} {word(rng).lower()}", font=font(int(width * 0.055), "Serif-Bold"), fill=(16, 16, 20))
    top = int(m + width * 0.1)
    if kind == 0:  # two columns and a figure
        column = (width - 2 * m) * 0.47
        text_block(draw, rng, m, top, column, height - top - m, int(width * 0.026))
        plot(draw, rng, width - m - column, top, column, height * 0.22)
        text_block(draw, rng, width - m - column, top + height * 0.27, column, height * 0.73 - top - m, int(width * 0.026))
    elif kind == 1:
        text_block(draw, rng, m, top, width - 2 * m, height - top - m, int(width * 0.034))
    elif kind == 2:
        for k in range(int((height - top - m) / (width * 0.036))):
            indent = m + width * 0.05 * rng.integers(0, 4)
            draw.text((indent, top + k * width * 0.036), words(rng, int(rng.integers(1, 5))), font=font(int(width * 0.027), "SansMono"), fill=(30, 40, 70))
    else:
        for k in range(6):
            plot(draw, rng, m + (k % 2) * width * 0.43, top + (k // 2) * height * 0.28, width * 0.36, height * 0.2)
    return image


def pages(name, width, height, columns, rows):
    rng = rng_of(name)
    return sheet(lambda k: page(rng, width, height), width, height, columns, rows) + 2 * noise(rng, height * rows, width * columns, 0.8)[:, :, None]


def picture_of(name, width, height, kind):
    inks = [(40, 70, 60), (206, 150, 60), (200, 60, 50), (60, 90, 160), (232, 220, 196), (90, 40, 90), (60, 150, 150)]
    rng = rng_of(name + " inks")
    palette = [inks[i] for i in rng.permutation(len(inks))]
    if kind == 0:
        return dead_leaves(name, (width, height), palette, int(width * height / 160), int(min(width, height) * 0.22))
    if kind == 1:
        return landscape(name, (width, height), palette[0], palette[1], (46, 66, 44))
    if kind == 2:
        return type_poster(name, (width, height), (236, 228, 208), (30, 36, 50), palette[2])
    return city_map(name, (width, height))


def collage(name, width, height, columns, rows):
    """Posters pasted edge to edge on a board, a little askew, some over others."""
    rng = rng_of(name)
    board = Image.new("RGB", (width, height), (222, 214, 196))
    w, h = width // columns, height // rows
    for k in range(columns * rows):
        ww, hh = int(w * rng.uniform(0.96, 1.06)), int(h * rng.uniform(0.96, 1.06))
        picture = picture_of(f"{name} {k}", ww, hh, int((k + rng.integers(3)) % 4))
        poster = Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8)).convert("RGBA").rotate(rng.uniform(-2.5, 2.5), Image.BICUBIC, expand=True)
        board.paste(poster, ((k % columns) * w + int(rng.integers(-8, 8)), (k // columns) * h + int(rng.integers(-8, 8))), poster)
    return np.asarray(board, float)


def notices(name, size, columns, rows):
    rng = rng_of(name)
    w, h = size // columns, size // rows

    def cell(k):
        return page(rng, w, h) if k % 2 else Image.fromarray(np.clip(picture_of(f"{name} {k}", w, h, k // 2 % 4), 0, 255).astype(np.uint8))

    return sheet(cell, w, h, columns, rows)


def signs(name, width, height, columns, rows):
    """Door signs with numbers and names."""
    rng = rng_of(name)
    whole = Image.new("RGB", (width * columns, height * rows))
    for k in range(columns * rows):
        image = Image.new("RGB", (width, height), (232, 232, 228))
        draw = ImageDraw.Draw(image)
        draw.rectangle((0, 0, width, height * 0.3), fill=((30, 60, 110), (120, 30, 40), (40, 90, 60))[k % 3])
        draw.text((width * 0.06, height * 0.02), "%d.%02d" % (rng.integers(1, 4), k + 1), font=font(int(height * 0.24)), fill=(240, 240, 240))
        for j in range(3):
            draw.text((width * 0.06, height * (0.36 + 0.2 * j)), f"{word(rng)} {word(rng)}", font=font(int(height * 0.13), "Sans"), fill=(30, 30, 30))
        whole.paste(image, ((k % columns) * width, (k // columns) * height))
    return np.asarray(whole, float)


def screens(name, width, height):
    """Four screens: an editor, a document, a drawing, a table."""
    rng = rng_of(name)
    whole = Image.new("RGB", (width * 2, height * 2))
    for k in range(4):
        dark = k % 2 == 0
        image = Image.new("RGB", (width, height), (30, 32, 40) if dark else (236, 236, 238))
        draw = ImageDraw.Draw(image)
        draw.rectangle((0, 0, width, height * 0.06), fill=(70, 74, 90) if dark else (200, 206, 216))
        draw.text((6, 2), words(rng, 4), font=font(int(height * 0.04), "Sans"), fill=(230, 230, 230) if dark else (30, 30, 30))
        if k == 0:
            for row in range(24):
                x = width * (0.04 + 0.04 * rng.integers(0, 4))
                for _ in range(int(rng.integers(1, 6))):
                    token = word(rng).lower()
                    draw.text((x, height * (0.09 + 0.037 * row)), token, font=font(int(height * 0.03), "SansMono"),
                              fill=((200, 200, 210), (130, 190, 120), (220, 150, 90), (120, 170, 230))[int(rng.integers(4))])
                    x += draw.textlength(token + "  ", font=font(int(height * 0.03), "SansMono"))
        elif k == 1:
            sheet_page = page(rng, int(width * 0.5), int(height * 0.86))
            image.paste(sheet_page, (int(width * 0.25), int(height * 0.1)))
        elif k == 2:
            image.paste(Image.fromarray(np.clip(picture_of(name, int(width * 0.7), int(height * 0.8), 1), 0, 255).astype(np.uint8)), (int(width * 0.05), int(height * 0.1)))
            for row in range(9):
                draw.text((width * 0.78, height * (0.12 + 0.08 * row)), words(rng, 2), font=font(int(height * 0.035), "Sans"), fill=(210, 210, 210))
        else:
            for row in range(20):
                for column in range(8):
                    draw.rectangle((width * column / 8, height * (0.08 + 0.046 * row), width * (column + 1) / 8, height * (0.126 + 0.046 * row)), outline=(170, 170, 176))
                    draw.text((width * column / 8 + 4, height * (0.084 + 0.046 * row)), str(int(rng.integers(1, 99999))), font=font(int(height * 0.03), "Sans"), fill=(40, 40, 40))
        whole.paste(image, ((k % 2) * width, (k // 2) * height))
    return np.asarray(whole, float)


def keyboard(name, width, height):
    rng = rng_of(name)
    image = Image.new("RGB", (width, height), (34, 34, 38))
    draw = ImageDraw.Draw(image)
    pitch, letters = width / 23.0, "QWERTYUIOPASDFGHJKLZXCVBNM1234567890"
    for row in range(6):
        y = height * 0.05 + row * height * 0.155
        x = pitch * 0.4
        while x < width - pitch:
            wide = pitch * (6 if row == 5 and abs(x - 4 * pitch) < pitch * 0.6 else rng.choice((1.0, 1.0, 1.0, 1.25 if x < pitch or x > 13 * pitch else 1.0)))
            if not 15 * pitch < x < 15.4 * pitch and not 18.6 * pitch < x < 19 * pitch:
                draw.rounded_rectangle((x, y, x + wide - 3, y + height * 0.14), 4, fill=(58, 58, 64), outline=(22, 22, 24))
                draw.text((x + 6, y + 3), letters[int(rng.integers(len(letters)))], font=font(int(height * 0.05), "Sans"), fill=(225, 225, 225))
            x += wide
    return np.asarray(image, float) + 2 * noise(rng, height, width, 0.8)[:, :, None]
