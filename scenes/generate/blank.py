#!/usr/bin/env python3
"""Makes scenes/blank.obj: a room of 5 x 2.7 x 4 m that is white all over, without a picture: there is nothing but faint shading."""
from pathlib import Path

from interior import new_mesh

SCENES = Path(__file__).resolve().parent.parent


def main():
    o = new_mesh()
    W, H, D = 5.0, 2.7, 4.0
    for group, corner, right, down in (("north", (0, H, 0), (W, 0, 0), (0, -H, 0)), ("east", (W, H, 0), (0, 0, D), (0, -H, 0)), ("south", (W, H, D), (-W, 0, 0), (0, -H, 0)),
                                       ("west", (0, H, D), (0, 0, -D), (0, -H, 0)), ("floor", (0, 0, 0), (W, 0, 0), (0, 0, D)), ("ceiling", (0, H, D), (W, 0, 0), (0, 0, -D))):
        o.quad(group, "white", corner, right, down)
    o.write(SCENES / "blank", "A blank room", "blank.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
