"""Random fields with the spectra of natural images, and what every picture starts from."""
from pathlib import Path

import numpy as np
from PIL import Image, ImageFont

FONTS = Path("/usr/share/fonts/truetype/dejavu")  # Debian: fonts-dejavu-core

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


def save(file, picture, quality=80):
    Image.fromarray(np.clip(picture + 0.5, 0, 255).astype(np.uint8)).save(file, quality=quality, optimize=True)


def sheet(cell, width, height, columns, rows):
    """Pictures side by side: cell(k) is the k-th, of width x height."""
    image = Image.new("RGB", (width * columns, height * rows))
    for k in range(columns * rows):
        image.paste(cell(k), ((k % columns) * width, (k // columns) * height))
    return np.asarray(image, float)


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
