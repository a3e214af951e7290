#!/usr/bin/env python3
"""Makes scenes/desk.obj: a desk with two seated figures behind it, screens, paper, books, in a room of 6 x 2.8 x 6 m."""
from pathlib import Path

from figures import seated
from furniture import Books, bookcase, cabinet, cell, framed, keyboard, monitor, mug, office_chair, paper, paper_stack, pencils, plant, table
from interior import new_mesh, shell, skirting
from mesh import sphere_profile
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
PI = 3.14159265


def main():
    o, rng, books = new_mesh(), rng_of("desk"), Books()
    shell(o, 6.0, 2.8, 6.0, "plaster", "carpet_tile", "ceiling_tiles")
    skirting(o, 6.0, 6.0, "grey")
    for z in (1.6, 3.4):
        o.box("ceiling lamp", "lamp", (2.2, 2.77, z), (3.8, 2.792, z + 0.5))
    with o.at((3.0, 0, 2.5)):  # they sit to the north of it and look to the south
        table(o, rng, 2.2, 0.9, 0.74, "wood_light", "steel")
        for k, x in enumerate((-0.55, 0.55)):
            with o.at((x, 0, -0.72), 0.12 - 0.3 * k):
                office_chair(o, "cloth_red" if k else "cloth_grey")
        with o.at((-0.55, 0, -0.72), 0.15):
            seated(o, "tartan", "denim", lean=0.1, look=0.35, nod=0.12, reach=(0.36, 0.33), lift=(0.0, 0.14))
        with o.at((0.55, 0, -0.72), -0.18):
            seated(o, "knitted", "cloth_grey", lean=0.14, look=-0.3, nod=0.2, reach=(0.33, 0.37))
        with o.at((0, 0.74, 0)):
            with o.at((-0.86, 0, -0.05), 2.4):
                monitor(o, 0)
            with o.at((0.82, 0, 0.05), -0.55):
                monitor(o, 1, 0.46, 0.28)
            with o.at((0.55, 0, -0.3), PI - 0.2):
                keyboard(o)
            for j, (x, z, turn) in enumerate(((-0.45, -0.1, 0.3), (-0.2, 0.05, -0.5), (0.05, -0.2, 1.2), (0.22, 0.12, 0.1), (-0.4, 0.24, -0.2), (0.42, 0.28, 0.6))):
                with o.at((x, 0.0006 * j, z), turn):
                    paper(o, j)
            with o.at((0.08, 0, 0.28), -0.3):
                paper_stack(o, 6, 0.045)
            with o.at((0.1, 0.046, 0.27), 0.2):
                o.box("atlas", "poster_leaves", (-0.11, 0, -0.08), (0.11, 0.03, 0.08), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)])
            with o.at((-0.62, 0, 0.3), 0.5):
                o.box("atlas", "poster_map", (-0.15, 0, -0.11), (0.15, 0.035, 0.11), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)])
            books.row(o, rng, -0.62, -0.46, 0.035, 0.4)
            with o.at((-0.1, 0, -0.32), 2.6):
                mug(o, "red")
            with o.at((0.62, 0, 0.2), 0.4):
                mug(o, "blue")
            with o.at((-0.22, 0, 0.33)):
                pencils(o, rng)
            with o.at((0.35, 0, -0.02), 0.5):
                o.box("tin", "parcels", (-0.05, 0, -0.035), (0.05, 0.16, 0.035), cells=[cell(k, 4, 2) for k in (3, 7, 4, 5, 3, 3)])
            with o.at((-0.05, 0, 0.16), 0.9):
                o.box("carton", "parcels", (-0.04, 0, -0.04), (0.04, 0.12, 0.04), cells=[cell(k, 4, 2) for k in (2, 5, 7, 3, 4, 4)])
            o.lathe("ball", "globe", (0.22, 0.045, -0.28), sphere_profile(0.045, 14), 24)
    # Behind them: shelves, posters, a plant; to the sides: cabinets and pictures.
    with o.at((1.3, 0, 0.32)):
        bookcase(o, rng, books, 1.6, 2.0, "wood_light", 2, 6, 0.95)
    framed(o, rng, "poster", "painting_0", (2.45, 2.1, 0), (0.9, 0, 0), (0, -0.64, 0), "black", 0.015)
    framed(o, rng, "poster", "poster_type", (3.55, 2.15, 0), (0.5, 0, 0), (0, -0.714, 0), "wood_light", 0.02)
    framed(o, rng, "poster", "poster_map", (4.25, 2.2, 0), (1.2, 0, 0), (0, -0.89, 0), "wood_dark")
    with o.at((4.6, 0, 0.02)):
        cabinet(o, rng, 1.4, 0.8, 0.42, doors=3)
        books.row(o, rng, -0.6, -0.1, 0.8, 0.3)
        with o.at((0.35, 0.8, 0.2), 0.3):
            o.box("parcel", "parcels", (-0.14, 0, -0.13), (0.14, 0.21, 0.13), cells=[cell(k, 4, 2) for k in (5, 3, 2, 7, 4, 4)])
    with o.at((2.75, 0, 0.4)):
        plant(o, rng, 1.1, 26, 0.15)
    framed(o, rng, "notice board", "notices", (0, 2.1, 3.6), (0, 0, -1.7), (0, -1.05, 0), "wood_light")
    framed(o, rng, "poster", "painting_1", (6.0, 2.2, 1.5), (0, 0, 0.7), (0, -0.98, 0), "black", 0.015)
    framed(o, rng, "poster", "poster_shards", (6.0, 2.1, 2.7), (0, 0, 0.6), (0, -0.76, 0), "wood_light")
    with o.at((5.98, 0, 3.0), -PI / 2):
        cabinet(o, rng, 1.6, 1.1, 0.45, "wood_light", "wood_dark", doors=4)
        books.row(o, rng, -0.7, 0.3, 1.1, 0.3)
    with o.at((0.02, 0, 2.8), PI / 2):
        cabinet(o, rng, 1.5, 0.75, 0.45, "wood_dark", "wood_light", drawers=3)
        for k in range(3):
            with o.at((-0.5 + 0.45 * k, 0.75, 0.22), 0.2 * k):
                paper_stack(o, k, 0.06 + 0.05 * k)
    framed(o, rng, "poster", "poster_dusk", (4.0, 2.1, 6.0), (-0.7, 0, 0), (0, -0.95, 0), "black", 0.015)
    framed(o, rng, "poster", "painting_2", (2.6, 2.1, 6.0), (-1.0, 0, 0), (0, -0.68, 0), "wood_light")
    o.write(SCENES / "desk", "A desk with two figures", "desk.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
