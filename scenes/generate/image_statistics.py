#!/usr/bin/env python3
"""Statistics of pictures by which rendered and recorded ones are compared: a table of docs/sensor.md. Debian: python3-opencv.

    python3 scenes/generate/image_statistics.py SEQ [EVERY] ...    # sequence folders with rgb.txt; every EVERYth frame, by default 8

Means over frames, 8 bits. noise: of the filter (1, -2, 1) x (1, -2, 1) / 6 in green, in the quietest tenth of the 16 x 16 blocks of 15 ... 70,
70 ... 150 and 150 ... 235; correlation: of neighbours in a row in the flattest tenth of the blocks, beside a Gaussian of 2 px; edges: steps of 60
and more between flat sides in rows and columns: overshoot after and before the step, 10-90 % width in the quartile.
"""
import sys
from pathlib import Path

import cv2
import numpy as np

SECOND = np.array([[1, -2, 1], [-2, 4, -2], [1, -2, 1]]) / 6
BLOCK = 16


def frames(folder, every):
    lines = [line.split() for line in (Path(folder) / "rgb.txt").read_text().splitlines() if line and line[0] != "#"]
    return [cv2.imread(str(Path(folder) / line[1])) for line in lines[::every]]


def blocks(picture):
    h, w = (n // BLOCK for n in picture.shape[:2])
    return picture[:h * BLOCK, :w * BLOCK].reshape(h, BLOCK, w, BLOCK)


def noise(image):
    green = image[..., 1].astype(float)
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(float)
    sigma, mean = blocks(cv2.filter2D(green, -1, SECOND)).std((1, 3)), blocks(green).mean((1, 3))
    white = blocks((image.max(2) >= 254).astype(float)).max((1, 3)) > 0
    levels = []
    for low, high in ((15, 70), (70, 150), (150, 235)):
        inside = (mean >= low) & (mean < high) & ~white
        levels.append(np.percentile(sigma[inside], 10) if inside.sum() > 20 else np.nan)
    slope = blocks(np.hypot(*(cv2.Sobel(grey, cv2.CV_64F, dx, 1 - dx, ksize=1) / 2 for dx in (0, 1)))).mean((1, 3))
    residual = green - cv2.GaussianBlur(green, (0, 0), 2)
    correlations = []
    for y, x in np.argwhere((slope < np.percentile(slope, 10)) & (mean > 40) & ~white)[:60]:
        r = residual[y * BLOCK:(y + 1) * BLOCK, x * BLOCK:(x + 1) * BLOCK]
        r = r - r.mean()
        if r.var() > 0.05:
            correlations.append((r[:, 1:] * r[:, :-1]).mean() / r.var())
    return levels, correlations, [grey.mean(), grey.std(), (image.max(2) >= 254).mean() * 100, (grey <= 4).mean() * 100, (slope < 1).mean() * 100]


def edges(image):
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(float)
    found = []
    for picture in (grey, grey.T):
        step = np.abs(picture[:, 2:] - picture[:, :-2])
        for y in range(5, picture.shape[0] - 5, 3):
            row = picture[y]
            for x in np.where(step[y] > 45)[0] + 1:
                if x < 14 or x > len(row) - 15 or step[y, x - 1] < max(step[y, x - 2], step[y, x]):
                    continue
                left, right = row[x - 12:x - 6], row[x + 7:x + 13]
                low, high = sorted((left.mean(), right.mean()))
                if left.std() > 2.5 or right.std() > 2.5 or low < 15 or high > 235 or high - low < 60:
                    continue
                p = (row[x - 8:x + 9] - left.mean()) / (right.mean() - left.mean())
                if p.max() <= 1.6 and p.min() >= -0.6:
                    rising = np.maximum.accumulate(p)
                    found.append((p[8:].max() - 1, -p[:9].min(), np.interp(0.9, rising, range(17)) - np.interp(0.1, rising, range(17))))
    return found


def main(arguments):
    print(f"{'':24} mean  std white% black% flat% | noise dark  mid bright  corr. | edges after before width")
    while arguments:
        folder = arguments.pop(0)
        every = int(arguments.pop(0)) if arguments and arguments[0].isdigit() else 8
        images = frames(folder, every)
        levels, correlations, rest = zip(*map(noise, images))
        dark, mid, bright = np.nanmean(levels, 0)
        mean, std, white, black, flat = np.mean(rest, 0)
        found = np.array([edge for image in images for edge in edges(image)])
        after, before = np.median(found[:, :2], 0)
        print(f"{Path(folder).name:24} {mean:4.0f} {std:4.0f} {white:6.1f} {black:6.1f} {flat:5.0f} | {dark:10.2f} {mid:4.2f} {bright:6.2f} "
              f"{np.mean(np.concatenate(correlations)):6.2f} | {len(found):5} {after:5.3f} {before:6.3f} {np.percentile(found[:, 2], 25):5.2f}")


if __name__ == "__main__":
    main(sys.argv[1:])
