#!/usr/bin/env python3
"""Makes scenes/target.obj: a poster of exactly 1.189 x 0.841 m (A0) and, beside it, a calibration board of 10 x 7 squares of 50 mm,
in the plane z = 0, on a plain wall of 5 x 3 m. The poster's middle is (0, 1.4, 0)."""
from pathlib import Path

from interior import new_mesh, wall

SCENES = Path(__file__).resolve().parent.parent
POSTER = (1.189, 0.841)  # metres
SQUARE, COLUMNS, ROWS = 0.05, 10, 7


def main():
    o = new_mesh()
    o.material("ink", None, (0.02, 0.02, 0.02))
    o.material("paper", None, (0.82, 0.82, 0.82))
    wall(o, "wall", "concrete", (-2.5, 3.0, -0.03), (5.0, 0, 0), (0, -3.0, 0))
    wall(o, "floor", "oak_floor", (-2.5, 0, -0.03), (5.0, 0, 0), (0, 0, 4.0))
    o.quad("target", "target", (-POSTER[0] / 2, 1.4 + POSTER[1] / 2, 0), (POSTER[0], 0, 0), (0, -POSTER[1], 0))
    # The board: squares are geometry, so that their corners are exact. A white margin of one square all round.
    left, top = 0.9, 1.4 + SQUARE * ROWS / 2
    for j in range(-1, ROWS + 1):
        for i in range(-1, COLUMNS + 1):
            inside = 0 <= i < COLUMNS and 0 <= j < ROWS
            o.quad("board", "ink" if inside and (i + j) % 2 == 0 else "paper", (left + i * SQUARE, top - j * SQUARE, 0), (SQUARE, 0, 0), (0, -SQUARE, 0))
    o.write(SCENES / "target", "A planar target", "target.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
