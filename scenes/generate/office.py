#!/usr/bin/env python3
"""Makes scenes/office.obj: 7 x 2.7 x 6 m, three desks with screens, cabinets, shelves, a white board, windows with blinds."""
from pathlib import Path

from furniture import (Books, bookcase, cabinet, cell, door, framed, keyboard, monitor, mug, office_chair, paper, paper_stack, pencils, plant,
                       radiator, table)
from interior import new_mesh, shell, skirting, window_frame
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
W, H, D = 7.0, 2.7, 6.0
PI = 3.14159265


def desk(o, rng, books, k, width=1.6):
    """A place to work at; who sits there looks to -z. k tells one from the next."""
    table(o, rng, width, 0.8, 0.74, ("wood_light", "wood_dark", "wood_light")[k % 3], "steel")
    with o.at((0, 0.74, 0)):
        for j, x in enumerate((-0.28, 0.3) if k != 1 else (0.05,)):
            with o.at((x, 0, -0.22), -0.2 * x):
                monitor(o, (k + j) % 4)
        with o.at((-0.05, 0, 0.15), 0.05 * k):
            keyboard(o)
        for j in range(4):
            with o.at((rng.uniform(0.35, 0.65), 0.0006 * j, rng.uniform(0.0, 0.25)), rng.uniform(-0.7, 0.7)):
                paper(o, 3 * k + j)
        with o.at((-0.62, 0, 0.2), rng.uniform(-0.3, 0.3)):
            paper_stack(o, k + 2, 0.05 + 0.03 * k)
        with o.at((-0.45, 0, 0.28), 2.5):
            mug(o, ("blue", "red", "white")[k % 3])
        with o.at((0.68, 0, -0.25)):
            pencils(o, rng)
        if k == 2:
            books.row(o, rng, -0.78, -0.5, 0, -0.15)
    with o.at((width / 2 - 0.25, 0, -0.35)):
        cabinet(o, rng, 0.42, 0.6, 0.55, "grey", "steel", drawers=3)
    with o.at((-0.05 + 0.1 * k, 0, 0.62), PI + 0.3 * (k - 1)):
        office_chair(o)


def main():
    o, rng, books = new_mesh(), rng_of("office"), Books()
    openings = [(0.7, 0.6, 2.5, 1.85), (2.9, 0.6, 4.7, 1.85), (5.0, 0.6, 6.6, 1.85)]
    shell(o, W, H, D, "plaster", "carpet_tile", "ceiling_tiles", {"north": openings})
    skirting(o, W, D, "grey")
    o.quad("view", "outdoors", (-2.0, 4.6, -3.0), (11.0, 0, 0), (0, -6.0, 0))
    for x0, y0, x1, y1 in openings:
        window_frame(o, (x0, H - y0, 0), (x1 - x0, 0, 0), (0, y0 - y1, 0), (0, 0, -0.15), 2)
        o.box("sill", "white", (x0 - 0.05, H - y1 - 0.03, -0.02), (x1 + 0.05, H - y1, 0.14))
        for k in range(12):  # a blind, half down
            o.box("blind", "white", (x0 + 0.02, H - y0 - 0.04 - 0.045 * k, -0.06), (x1 - 0.02, H - y0 - 0.037 - 0.045 * k, -0.03))
    for x in (1.6, 3.8, 5.8):
        with o.at((x, 0, 0.02)):
            radiator(o, 1.3, 0.5)
    for x in (1.6, 4.2):  # panels of light, where the scenario has its lamps
        for z in (1.2, 3.6):
            o.box("ceiling lamp", "lamp", (x, H - 0.03, z), (x + 1.2, H - 0.008, z + 0.6))

    with o.at((1.75, 0, 1.35), 0.0):
        desk(o, rng, books, 0)
    with o.at((5.0, 0, 1.5), -0.1):
        desk(o, rng, books, 1)
    with o.at((0.75, 0, 3.9), PI / 2):
        desk(o, rng, books, 2)
    # East: white board and shelves. South: cabinets, the door, a table with papers. West: notices.
    framed(o, rng, "white board", "foil", (W, 2.0, 2.3), (0, 0, 1.8), (0, -1.05, 0), "steel", 0.03)
    for k, (z, y) in enumerate(((2.5, 1.9), (2.78, 1.8), (3.5, 1.88))):
        o.quad("notes", "print", (W - 0.018, y, z), (0, 0, 0.21), (0, -0.297, 0), cell(k + 4, 4, 2))
    with o.at((W - 0.02, 0, 4.9), -PI / 2):
        with o.at((0, 0, 0.3)):
            bookcase(o, rng, books, 1.7, 2.0, "wood_light", 2, 6, 0.9)
    with o.at((5.2, 0, D - 0.01), PI):
        door(o, rng, number=3)
    for k, x in enumerate((3.9, 3.4, 2.9)):
        with o.at((x, 0, D - 0.02), PI):
            cabinet(o, rng, 0.46, 1.32, 0.55, "cloth_grey" if k == 1 else "wood_light", "wood_light" if k != 1 else "steel", drawers=4)
            if k != 1:
                with o.at((0, 1.32, 0.27), 0.3 * k):
                    o.box("box file", "parcels", (-0.16, 0, -0.14), (0.16, 0.24, 0.14), cells=[cell(j + k, 4, 2) for j in (0, 6, 2, 5, 1, 1)])
    framed(o, rng, "notice board", "notices", (2.3, 2.05, D), (-1.7, 0, 0), (0, -1.05, 0), "wood_light", 0.03)
    framed(o, rng, "painting", "painting_1", (0, 2.1, 2.9), (0, 0, -0.64), (0, -0.9, 0), "black", 0.015)
    framed(o, rng, "map", "painting_2", (0, 2.05, 5.5), (0, 0, -1.0), (0, -0.68, 0), "wood_light")
    with o.at((1.3, 0, 5.45)):
        table(o, rng, 1.5, 0.7, 0.72, "wood_light", "black")
        for j in range(5):
            with o.at((-0.6 + 0.28 * j, 0.72, rng.uniform(-0.12, 0.12)), rng.uniform(-0.4, 0.4)):
                paper_stack(o, j, rng.uniform(0.01, 0.12))
    with o.at((6.55, 0, 0.5)):
        plant(o, rng, 1.2, 30, 0.16)
    with o.at((3.3, 0, 1.2)):
        o.lathe("bin", "dark", (0, 0, 0), [(0.13, 0.32), (0.14, 0.33), (0.11, 0.0)], 20)
    for y, z in ((1.7, 0.12), (1.55, 0.05)):
        o.tube("coat stand", "steel", [(6.6 - z, y, 5.5), (6.6, y - 0.06, 5.5), (6.6 + z, y, 5.5)], [0.01] * 3, segments=8)
    o.lathe("coat stand", "steel", (6.6, 0, 5.5), [(0.014, 1.75), (0.014, 0.03), (0.2, 0.02), (0.2, 0.0)], 18)
    o.tube("coat", "denim", [(6.52, 1.62, 5.44), (6.5, 1.3, 5.42), (6.5, 0.85, 5.4)], (0.06, 0.14, 0.17), 0.5, 16, 4, 0.55)
    o.write(SCENES / "office", "An office", "office.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
