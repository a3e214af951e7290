#!/usr/bin/env python3
"""Sheet of a recording's frames (left) beside those of its twin (right), at the same share of both. Debian: python3-opencv.

    python3 scenes/generate/side_by_side.py RECORDING TWIN SHEET.png [ROWS]     # sequence folders with rgb.txt; 4 rows by default

Example: python3 scenes/generate/side_by_side.py $VOBENCH_DATA/tum_fr1_xyz out/fr1_xyz sheet.png, of
vobench render scenes/twins/tum_fr1_xyz.yaml -o out/fr1_xyz
"""
import sys
from pathlib import Path

import cv2
import numpy as np

WIDTH, GAP = 640, 4


def pictures(folder, rows):
    lines = [line.split() for line in (Path(folder) / "rgb.txt").read_text().splitlines() if line and line[0] != "#"]
    for share in (np.arange(rows) + 0.5) / rows:
        file = Path(folder) / lines[int(share * len(lines))][1]
        picture = cv2.imread(str(file))
        if picture is None:
            sys.exit(f"side_by_side: cannot read {file}")
        yield cv2.resize(picture, (WIDTH, round(WIDTH * picture.shape[0] / picture.shape[1])), interpolation=cv2.INTER_AREA)


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    recording, twin, sheet = sys.argv[1:4]
    rows = []
    for pair in zip(*(pictures(folder, int((sys.argv + ["4"])[4])) for folder in (recording, twin))):
        height = min(picture.shape[0] for picture in pair)
        gap = np.full((height, GAP, 3), 255, np.uint8)
        rows += [np.hstack([pair[0][:height], gap, pair[1][:height]]), np.full((GAP, 2 * WIDTH + GAP, 3), 255, np.uint8)]
    if not cv2.imwrite(sheet, np.vstack(rows[:-1])):
        sys.exit(f"side_by_side: cannot write {sheet}")


main()
