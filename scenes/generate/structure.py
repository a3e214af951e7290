#!/usr/bin/env python3
"""Makes scenes/structure_texture.obj, structure_notexture.obj, nostructure_texture.obj and nostructure_notexture.obj: eight
panels of 0.9 x 1.5 m in a hall, in a zig-zag or in one plane, with posters or in white foil, as in TUM's family. Near and far are
trajectories."""
import math
from pathlib import Path

from interior import new_mesh, shell
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
PANELS, WIDE, HIGH, FOLD = 8, 0.9, 1.5, math.radians(38)


def main(structure, texture):
    o, rng = new_mesh(), rng_of("structure")
    shell(o, 12.0, 4.0, 9.0, "concrete", "oak_floor" if texture else "concrete", "plaster")
    advance = WIDE * math.cos(FOLD) if structure else WIDE
    x, z = 6.0 - advance * PANELS / 2, 4.0
    for k in range(PANELS):
        turn = (FOLD if k % 2 else -FOLD) if structure else 0.0
        right = (WIDE * math.cos(turn), 0, -WIDE * math.sin(turn))
        u = (1, 0) if k >= 6 else (0, 1)  # the last two are the first two in a mirror
        front = (x, HIGH, z)
        if texture:
            o.quad("panel", f"panel_{k % 6}", front, right, (0, -HIGH, 0), (u[0], 0, u[1], 1))
        else:
            o.sheet("panel", "foil", front, right, (0, -HIGH, 0), 1.0, rng)
        back = (x + right[0] - 0.02 * right[2] / WIDE, HIGH, z + right[2] - 0.02 * right[0] / WIDE)
        o.sheet("panel", "wood_light", back, (-right[0], 0, -right[2]), (0, -HIGH, 0), 1.25, rng)
        o.quad("panel top", "wood_light", (x - 0.02 * right[2] / WIDE, HIGH, z - 0.02 * right[0] / WIDE), right, (0.02 * right[2] / WIDE, 0, 0.02 * right[0] / WIDE), (0, 0, 0.7, 0.02))
        x, z = x + right[0], z + right[2]
    name = ("structure" if structure else "nostructure") + ("_texture" if texture else "_notexture")
    o.write(SCENES / name, "Panels in a hall", "structure.py")
    return o.triangles


if __name__ == "__main__":
    for structure in (True, False):
        for texture in (True, False):
            print(main(structure, texture), "triangles")
