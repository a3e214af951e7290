#!/usr/bin/env python3
"""Makes scenes/corridor.obj: 26 x 2.5 x 2.2 m, doors on both sides, notices, radiators, benches; no two stretches are alike."""
from pathlib import Path

from furniture import Books, bookcase, cabinet, cell, door, framed, paper_stack, plant, radiator
from interior import long_box, new_mesh, shell, skirting, wall
from mesh import sphere_profile
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
LONG, HIGH, WIDE = 26.0, 2.5, 2.2
PI = 3.14159265


def extinguisher(o):
    o.lathe("extinguisher", "red", (0, 0.95, 0.09), [(0.012, 0.5), (0.02, 0.46), (0.075, 0.42), (0.08, 0.38), (0.08, 0.02), (0.07, 0.0)], 20)
    o.tube("extinguisher", "black", [(0, 1.45, 0.09), (0.09, 1.4, 0.1), (0.1, 1.15, 0.1)], (0.011, 0.011, 0.014), segments=8)
    o.quad("extinguisher sign", "red", (-0.1, 1.9, 0.003), (0.2, 0, 0), (0, -0.2, 0))


def bench(o, rng):
    o.box("bench", "wood_light", (-0.6, 0.42, 0.03), (0.6, 0.46, 0.4), 1.25, rng)
    for x in (-0.5, 0.5):
        o.box("bench", "steel", (x - 0.02, 0, 0.06), (x + 0.02, 0.42, 0.37))


def main():
    o, rng, books = new_mesh(), rng_of("corridor"), Books()
    shell(o, LONG, HIGH, WIDE, "plaster", "paving", "ceiling_tiles")
    skirting(o, LONG, WIDE, "grey", 0.1)
    for z, right in ((0.004, (LONG, 0, 0)), (WIDE - 0.004, (-LONG, 0, 0))):  # painted to the height of a hand
        wall(o, "dado", "concrete", (0 if right[0] > 0 else LONG, 1.0, z), right, (0, -0.9, 0))
        long_box(o, "rail", "wood_dark", (0, 1.0, z - 0.012), (LONG, 1.05, z + 0.012), 1.25, rng)
    for k in range(8):
        o.box("ceiling lamp", "lamp", (1.4 + 3.2 * k, HIGH - 0.04, 0.95), (2.6 + 3.2 * k, HIGH - 0.008, 1.25))
    north = lambda x: o.at((x, 0, 0.005))
    south = lambda x: o.at((x, 0, WIDE - 0.005), PI)
    sign = 0
    for side, places in ((north, (1.6, 5.3, 8.1, 12.6, 15.2, 19.4, 23.6)), (south, (3.2, 6.7, 10.4, 13.9, 17.8, 21.7))):
        for x in places:
            with side(x + rng.uniform(-0.2, 0.2)):
                door(o, rng, wood=("wood_light", "wood_dark", "blue", "grey")[int(rng.integers(4))], number=sign)
            sign += 1
    # Between the doors, one thing after the other.
    pictures = ["painting_0", "painting_1", "painting_2", "poster_leaves", "poster_map", "poster_type", "poster_dusk", "poster_shards", "poster_type2"]
    sizes = {"painting_0": (0.9, 0.64), "painting_1": (0.64, 0.9), "painting_2": (1.0, 0.68), "poster_leaves": (0.82, 0.6), "poster_map": (1.0, 0.74),
             "poster_type": (0.5, 0.714), "poster_dusk": (0.56, 0.76), "poster_shards": (0.6, 0.76), "poster_type2": (0.5, 0.714)}
    for k, x in enumerate((3.4, 6.7, 10.3, 13.9, 17.2, 21.4, 25.0)):
        with north(x):
            if k % 3 == 0:
                framed(o, rng, "notice board", "notices", (-0.75, 2.05, 0), (1.5, 0, 0), (0, -0.93, 0), "wood_light", 0.025, ((0, 0, 1, 0.9), (0, 0.1, 1, 1), (1, 0, 0, 0.9))[k // 3])
            else:
                w, h = sizes[pictures[k]]
                framed(o, rng, "picture", pictures[k], (-w / 2, 2.05, 0), (w, 0, 0), (0, -h, 0), ("black", "wood_light")[k % 2], 0.02)
            (lambda: radiator(o, 1.1), lambda: bench(o, rng), lambda: None, lambda: radiator(o, 0.8))[k % 4]()
    for k, x in enumerate((1.4, 5.0, 8.5, 12.2, 15.9, 19.8, 24.0)):
        with south(x):
            picture = pictures[(k + 4) % 9]
            w, h = sizes[picture]
            if k in (2, 5):
                for j in range(5):
                    o.quad("notes", "print", (-0.6 + 0.25 * j, 1.95 - 0.06 * (j % 3), 0.004), (0.21, 0, 0), (0, -0.297, 0), cell(j + k, 4, 2))
                with o.at((0.0, 0, 0)):
                    cabinet(o, rng, 0.9, 0.85, 0.32, "grey", "wood_light", doors=2)
                    with o.at((0.2, 0.85, 0.16), 0.2):
                        paper_stack(o, k, 0.12)
            elif k == 3:
                with o.at((0, 0, 0.3)):
                    bookcase(o, rng, books, 1.3, 1.9, "wood_light", 2, 5, 0.9, 0.28)
            else:
                framed(o, rng, "picture", picture, (-w / 2, 2.0, 0), (w, 0, 0), (0, -h, 0), ("wood_dark", "black")[k % 2], 0.02)
                if k % 2 == 0:
                    bench(o, rng)
    for x in (7.4, 18.6):
        with south(x):
            extinguisher(o)
    for x, z in ((11.2, 0.25), (20.6, 1.95), (25.6, 0.35)):
        with o.at((x, 0, z)):
            plant(o, rng, 1.0, 16, 0.14)
    # The ends: a double door with a picture over it, and a glass case.
    with o.at((LONG - 0.005, 0, 0.75), -PI / 2):
        door(o, rng, wood="wood_dark")
    with o.at((LONG - 0.005, 0, 1.62), -PI / 2):
        framed(o, rng, "picture", "poster_leaves", (-0.4, 1.9, 0), (0.8, 0, 0), (0, -0.58, 0), "black", 0.02)
    with o.at((0.005, 0, 1.1), PI / 2):
        framed(o, rng, "picture", "painting_2", (-0.6, 2.1, 0), (1.2, 0, 0), (0, -0.82, 0), "wood_light")
        cabinet(o, rng, 1.0, 0.8, 0.3, doors=2)
        o.lathe("globe", "globe", (0.1, 0.95, 0.16), sphere_profile(0.14, 16), 24)
    o.write(SCENES / "corridor", "A corridor", "corridor.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
