#!/usr/bin/env python3
"""Makes scenes/living_room.obj: 6 x 2.6 x 5 m, sofas round a low table, a dining table, books, a window, and walls that are bare in part."""
from pathlib import Path

from furniture import Books, bookcase, cabinet, cell, chair, curtain, floor_lamp, framed, mug, paper, plant, sofa, table
from interior import new_mesh, shell, skirting, window_frame
from mesh import sphere_profile
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
W, H, D = 6.0, 2.6, 5.0
PI = 3.14159265


def main():
    o, rng, books = new_mesh(), rng_of("living room"), Books()
    shell(o, W, H, D, "plaster", "oak_floor", "plaster", {"east": [(2.9, 0.45, 4.3, 1.75)]})
    skirting(o, W, D)
    window_frame(o, (W, H - 0.45, 2.9), (0, 0, 1.4), (0, -1.3, 0), (0.18, 0, 0))
    o.quad("view", "outdoors", (W + 1.6, 3.3, 0.6), (0, 0, 6.0), (0, -3.6, 0))
    for z in (2.68, 4.52):
        with o.at((W - 0.08, 0.05, z), -PI / 2):
            curtain(o, rng, "curtain", 0.5, 2.35, 6)
    o.tube("curtain rod", "brass", [(W - 0.08, 2.42, 2.3), (W - 0.08, 2.42, 4.9)], (0.012, 0.012), segments=8)

    # The group of seats: rug, low table, sofa before the south wall, armchair, television on the north wall.
    o.box("rug", "carpet", (1.7, 0.0, 1.45), (4.1, 0.012, 3.1), cells=[(0, 0, 0.02, 0.02)] * 4 + [(0, 0, 1, 1)])
    with o.at((2.9, 0, 4.5), PI):
        sofa(o, 2.2, "sofa", ("cushion", "cloth_red", "curtain"))
    with o.at((0.95, 0, 3.75), 2.3):
        sofa(o, 0.95, "cloth_red", ("cushion",))
    with o.at((2.9, 0.012, 2.5)):
        table(o, rng, 1.15, 0.6, 0.42, "wood_dark", "wood_dark")
        with o.at((-0.3, 0.42, 0.02), 0.3):
            o.box("atlas", "poster_map", (-0.15, 0, -0.11), (0.15, 0.03, 0.11), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)])
        with o.at((-0.27, 0.45, 0.0), 0.05):
            o.box("atlas", "poster_shards", (-0.11, 0, -0.09), (0.11, 0.022, 0.09), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)])
        with o.at((0.1, 0.42, 0.13), 2.0):
            mug(o, "blue")
        with o.at((0.12, 0.42, -0.12), 0.7):
            paper(o, 0)
        o.lathe("bowl", "clay", (0.38, 0.42, 0.05), [(0.13, 0.08), (0.135, 0.08), (0.07, 0.01), (0.05, 0.0)], 28)
        for k, (x, z, material) in enumerate(((0.35, 0.03, "red"), (0.42, 0.07, "yellow"), (0.4, 0.0, "green"))):
            o.lathe("fruit", material, (x, 0.48 + 0.01 * k, z), sphere_profile(0.037, 10), 16)
    with o.at((2.9, 0, 0.02)):
        cabinet(o, rng, 1.8, 0.5, 0.42, doors=3)
        o.box("television", "black", (-0.6, 0.62, 0.06), (0.6, 1.32, 0.1))
        o.box("television", "black", (-0.2, 0.5, 0.08), (0.2, 0.63, 0.26))
        o.quad("television picture", "painting_1", (-0.57, 1.29, 0.101), (1.14, 0, 0), (0, -0.64, 0), (0, 0.3, 1, 0.7))
        books.row(o, rng, -0.86, -0.64, 0.5, 0.34)
        o.lathe("vase", "clay", (0.76, 0.5, 0.22), [(0.045, 0.30), (0.04, 0.27), (0.05, 0.22), (0.085, 0.14), (0.09, 0.09), (0.06, 0.01), (0.055, 0.0)], 30)

    # West: books, a globe on a chest. North-east: the dining table.
    with o.at((0.32, 0, 1.3), PI / 2):
        bookcase(o, rng, books, 1.6, 2.0, "wood_light", 2, 6, 0.9)
    with o.at((0.02, 0, 2.6), PI / 2):
        cabinet(o, rng, 0.7, 0.8, 0.4, "wood_light", "wood_dark", drawers=4)
        o.lathe("globe", "globe", (0.1, 0.99, 0.2), sphere_profile(0.15, 20), 32)
        o.lathe("globe foot", "brass", (0.1, 0.8, 0.2), [(0.02, 0.05), (0.10, 0.012), (0.10, 0.0)], 24)
    with o.at((4.85, 0, 1.15)):
        table(o, rng, 0.9, 1.4, 0.75, "wood_light", "wood_light")
        for k, (x, z, turn) in enumerate(((-0.62, -0.35, PI / 2), (-0.66, 0.36, PI / 2 + 0.2), (0.62, -0.33, -PI / 2), (0.64, 0.37, -PI / 2 - 0.15))):
            with o.at((x, 0, z), turn):
                chair(o, rng, ("cushion", "cloth_red")[k % 2])
        with o.at((0.05, 0.75, 0.0), 0.4):
            o.box("tin", "parcels", (-0.1, 0, -0.09), (0.1, 0.19, 0.09), cells=[cell(k, 4, 2) for k in (3, 7, 4, 5, 3, 3)])
        with o.at((-0.2, 0.75, -0.38), -0.5):
            paper(o, 3)
        with o.at((0.24, 0.75, 0.4), 1.0):
            mug(o, "white")
    with o.at((5.62, 0, 0.4)):
        plant(o, rng, 1.15, 42, 0.17)
    with o.at((0.4, 0, 4.6)):
        floor_lamp(o)
    with o.at((4.75, 0, D - 0.02), PI):
        cabinet(o, rng, 1.0, 0.85, 0.4, "wood_dark", "wood_light", drawers=3)
        with o.at((0.2, 0.85, 0.2), 0.3):
            o.box("parcel", "parcels", (-0.14, 0, -0.13), (0.14, 0.21, 0.13), cells=[cell(k, 4, 2) for k in (5, 3, 2, 7, 4, 4)])
        books.row(o, rng, -0.42, -0.1, 0.85, 0.3)
    # Pictures: over the sofa, beside the books. The north-east and east walls stay bare.
    framed(o, rng, "painting", "painting_0", (3.55, 2.0, D), (-0.95, 0, 0), (0, -0.675, 0), "wood_light")
    framed(o, rng, "painting", "painting_2", (2.4, 1.95, D), (-0.85, 0, 0), (0, -0.578, 0), "wood_dark")
    framed(o, rng, "painting", "poster_dusk", (0, 2.1, 3.75), (0, 0, -0.56), (0, -0.76, 0), "black", 0.015)
    framed(o, rng, "painting", "poster_type", (0.9, 2.1, 0), (0.5, 0, 0), (0, -0.714, 0), "black", 0.015)
    o.lathe("pendant", "lamp", (2.9, H - 0.5, 2.5), [(0.05, 0.16), (0.2, 0.06), (0.24, 0.0)], 32)
    o.tube("pendant", "black", [(2.9, H - 0.36, 2.5), (2.9, H, 2.5)], (0.006, 0.006), segments=6, steps=1)
    o.write(SCENES / "living_room", "A living room", "living_room.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
