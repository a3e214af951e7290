#!/usr/bin/env python3
"""Makes scenes/hall.obj: a machine hall, 16 x 6 x 14 m, its middle free above 0.9 m: brick and concrete, columns, pipes, machines, racks
with parcels, a gallery of notices, crates on the floor."""
from pathlib import Path

from furniture import Books, bookcase, cabinet, cell, door, framed, paper_stack, table
from interior import long_box, new_mesh, shell, window_frame
from mesh import sphere_profile
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
W, H, D = 16.0, 6.0, 14.0
PI = 3.14159265


def crate(o, k, size, turn=0.0):
    """A parcel of six different faces."""
    w, h, d = size
    with o.at((0, 0, 0), turn):
        o.box("crate", "parcels", (-w / 2, 0, -d / 2), (w / 2, h, d / 2), cells=[cell(3 * k + j, 4, 2) for j in (0, 2, 5, 7, 1, 1)])


def pallet(o, rng, k, layers=1):
    """Crates on a pallet, 1.2 x 0.8 m."""
    o.box("pallet", "wood_light", (-0.6, 0, -0.4), (0.6, 0.12, 0.4), 1.25, rng)
    for j in range(4 * layers):
        with o.at((-0.3 + 0.6 * (j % 2), 0.12 + 0.36 * (j // 4), -0.2 + 0.4 * (j // 2 % 2))):
            crate(o, k + j, (0.54, 0.36, 0.36), rng.uniform(-0.08, 0.08))


def rack(o, rng, k, width=2.6, levels=3):
    """Shelves of steel with crates, its back towards -z."""
    for x in (-width / 2, 0, width / 2):
        for z in (-0.75, -0.02):
            o.box("rack", "blue", (x - 0.04, 0, z - 0.02), (x + 0.04, 0.9 * levels + 0.5, z + 0.02))
    for level in range(levels + 1):
        y = 0.1 + 0.9 * level
        o.box("rack", "yellow", (-width / 2, y - 0.05, -0.75), (width / 2, y, -0.70))
        o.box("rack", "yellow", (-width / 2, y - 0.05, -0.05), (width / 2, y, 0.0))
        o.box("rack", "wood_light", (-width / 2, y, -0.75), (width / 2, y + 0.02, 0), 1.25, rng)
        x = -width / 2 + 0.1
        while level < levels + 1 and x < width / 2 - 0.5:
            w = rng.uniform(0.3, 0.6)
            with o.at((x + w / 2, y + 0.021, -0.38)):
                crate(o, int(rng.integers(8)), (w, rng.uniform(0.25, 0.7), 0.5), rng.uniform(-0.1, 0.1))
            x += w + rng.uniform(0.05, 0.3)


def machine(o, rng, k, color):
    """A press of two and a half metres, its front to +z."""
    o.box("machine", color, (-0.9, 0, -0.6), (0.9, 0.8, 0.6))
    o.box("machine", color, (-0.9, 0.8, -0.6), (-0.5, 2.0, 0.2))
    o.box("machine", color, (0.5, 0.8, -0.6), (0.9, 2.0, 0.2))
    o.box("machine", color, (-0.9, 2.0, -0.6), (0.9, 2.5, 0.3))
    o.quad("machine plate", "screens", (-0.45, 2.4, 0.302), (0.5, 0, 0), (0, -0.3, 0), cell(k, 2, 2, 0.001))
    o.quad("machine plate", "signs", (0.2, 2.38, 0.302), (0.4, 0, 0), (0, -0.27, 0), cell(k + 3, 4, 4, 0.01))
    o.quad("machine plate", "notices", (-0.85, 0.75, 0.602), (0.9, 0, 0), (0, -0.6, 0), (0.5 * (k % 2), 0, 0.5 + 0.5 * (k % 2), 1))
    o.quad("machine plate", "keyboard", (0.3, 0.6, 0.602), (0.45, 0, 0), (0, -0.15, 0))
    o.lathe("machine", "steel", (0, 0.8, -0.1), [(0.01, 1.2), (0.16, 1.2), (0.16, 0.5), (0.3, 0.45), (0.3, 0.3), (0.01, 0.3)], 24)
    o.tube("machine", "black", [(0.7, 2.5, -0.3), (0.7, 2.9, -0.3), (0.3, 3.2, -0.45), (0.3, 4.2, -0.55)], [0.05] * 4, segments=10)
    for j in range(3):
        o.lathe("machine", ("red", "green", "yellow")[j], (-0.35 + 0.12 * j, 0.805, 0.5), sphere_profile(0.03, 8), 12)


def tank(o, high, radius, material):
    o.lathe("tank", material, (0, 0, 0), [(0.02, high + 0.25), (radius * 0.7, high + 0.18), (radius, high), (radius, 0.3), (radius * 0.8, 0.2), (radius * 0.8, 0)], 32,
            (0, 0, 3, 2))
    o.tube("tank", "steel", [(radius, high * 0.6, 0), (radius + 0.25, high * 0.6, 0), (radius + 0.25, 0.1, 0)], [0.04] * 3, segments=10)


def main():
    o, rng, books = new_mesh(), rng_of("hall"), Books()
    windows = [(1.2 + 3.6 * k, 0.7, 3.2 + 3.6 * k, 2.1) for k in range(4)]
    shell(o, W, H, D, ("brick", "concrete", "brick", "concrete"), "concrete", "plaster", {"north": windows})
    o.quad("view", "outdoors", (-4.0, 9.0, -4.0), (24.0, 0, 0), (0, -12.0, 0))
    for x0, y0, x1, y1 in windows:
        window_frame(o, (x0, H - y0, 0), (x1 - x0, 0, 0), (0, y0 - y1, 0), (0, 0, -0.3), 3, "steel")
    for x in (3.2, 8.0, 12.8):  # beams and lamps under the roof
        long_box(o, "beam", "blue", (x - 3.1, H - 0.5, 4.4), (x + 3.1, H - 0.25, 4.6))
        long_box(o, "beam", "blue", (x - 3.1, H - 0.5, 9.4), (x + 3.1, H - 0.25, 9.6))
    for x in (2.6, 7.0, 11.4):
        for z in (2.7, 6.7, 10.7):
            o.box("lamp", "lamp", (x, H - 0.03, z), (x + 2.0, H - 0.008, z + 0.6))
    for k, (x, z) in enumerate(((0.25, 4.5), (0.25, 9.5), (W - 0.25, 4.5), (W - 0.25, 9.5))):
        o.box("column", "yellow" if k % 2 else "grey", (x - 0.2, 0, z - 0.2), (x + 0.2, H - 0.25, z + 0.2))
        side = 1 if x < 1 else -1
        for j in range(3):
            o.quad("column sign", "signs", (x + side * 0.202, 2.6 - 0.5 * j, z + side * 0.14), (0, 0, -side * 0.28), (0, -0.19, 0), cell(4 * k + j, 4, 4, 0.01))
    for y, r, material in ((3.3, 0.09, "steel"), (3.65, 0.06, "red"), (4.0, 0.12, "grey"), (4.5, 0.05, "brass")):
        for x in range(4):  # pipes along the south wall and down it
            o.tube("pipe", material, [(0.3 + 3.85 * x, y, D - 0.25), (4.15 + 3.85 * x, y, D - 0.25)], [r, r], segments=12)
        o.tube("pipe", material, [(0.3, y, D - 0.25), (0.22, y, D - 0.5), (0.22, y, 10.2)], [r] * 3, segments=12)
        o.tube("pipe", material, [(W - 0.3, y, D - 0.25), (W - 0.25, y - 0.4, D - 0.25), (W - 0.25, 0.0, D - 0.25 - r)], [r] * 3, segments=12)
    # North: racks and machines below the windows.
    for k, x in enumerate((2.2, 5.2)):
        with o.at((x, 0, 0.8)):
            rack(o, rng, k)
    for k, (x, color) in enumerate(((8.6, "green"), (11.2, "blue"), (13.8, "green"))):
        with o.at((x, 0, 0.75)):
            machine(o, rng, k, color)
    # East: a rack, tanks, notices.
    with o.at((W - 0.05, 0, 7.0), -PI / 2):
        with o.at((0, 0, 0.8)):
            rack(o, rng, 5)
    for k, z in enumerate((2.6, 3.7)):
        with o.at((W - 0.8, 0, z), PI / 2):
            tank(o, 2.2 - 0.5 * k, 0.45, "foil" if k else "concrete")
    framed(o, rng, "notice board", "notices", (W, 2.6, 10.4), (0, 0, 2.6), (0, -1.6, 0), "steel", 0.04)
    framed(o, rng, "poster", "poster_map", (W, 4.6, 10.5), (0, 0, 2.2), (0, -1.6, 0), "black", 0.03)
    framed(o, rng, "poster", "poster_shards", (W, 5.2, 5.4), (0, 0, 1.3), (0, -1.6, 0), "black", 0.03)
    # South: doors, benches, boards.
    for k, x in enumerate((13.6, 4.2)):
        with o.at((x, 0, D - 0.005), PI):
            door(o, rng, wood=("grey", "wood_dark")[k], number=7 + k, width=1.4, high=2.4)
    for k, x in enumerate((11.2, 8.6, 6.2)):
        with o.at((x, 0, D - 0.5), PI):
            table(o, rng, 2.0, 0.8, 0.9, "wood_dark", "steel")
            for j in range(4):
                with o.at((-0.75 + 0.5 * j, 0.9, rng.uniform(-0.1, 0.15)), rng.uniform(-0.5, 0.5)):
                    (lambda: crate(o, k + j, (0.3, 0.22, 0.25)), lambda: paper_stack(o, j, 0.1))[(j + k) % 2]()
        framed(o, rng, "board", ("notices", "painting_0", "poster_type")[k], (x + 0.9, 2.7, D), (-1.8, 0, 0), (0, -1.3, 0), "wood_light", 0.03)
    with o.at((1.6, 0, D - 0.05), PI):
        cabinet(o, rng, 1.6, 1.9, 0.5, "grey", "steel", doors=3)
    # West: shelves, a big poster, cabinets.
    with o.at((0.02, 0, 7.0), PI / 2):
        with o.at((0, 0, 0.35)):
            bookcase(o, rng, books, 2.4, 2.3, "wood_dark", 3, 6, 0.9)
    with o.at((0.02, 0, 2.6), PI / 2):
        cabinet(o, rng, 2.0, 1.4, 0.5, "blue", "grey", drawers=4)
        with o.at((-0.4, 1.4, 0.25)):
            crate(o, 4, (0.5, 0.4, 0.35), 0.2)
    framed(o, rng, "poster", "poster_leaves", (0, 3.6, 3.8), (0, 0, -2.4), (0, -1.7, 0), "black", 0.03)
    framed(o, rng, "poster", "poster_hills", (0, 4.4, 8.4), (0, 0, -2.6), (0, -1.7, 0), "black", 0.03)
    with o.at((0.9, 0, 11.6), PI / 2):
        machine(o, rng, 3, "red")
    # On the floor: pallets, crates, tables, marks; nothing higher than 0.9 m.
    for k, (x, z, turn) in enumerate(((4.0, 4.2, 0.3), (7.2, 3.4, -0.2), (11.6, 4.4, 0.9), (12.4, 8.2, 0.1), (9.8, 10.9, -0.5), (5.4, 10.6, 0.2), (3.4, 7.4, 1.4))):
        with o.at((x, 0, z), turn):
            pallet(o, rng, k, 1 + k % 2)
    for k, (x, z, turn) in enumerate(((8.2, 6.8, 0.4), (6.0, 7.4, -0.6))):
        with o.at((x, 0, z), turn):
            table(o, rng, 1.6, 0.8, 0.72, "wood_light", "steel")
            with o.at((-0.4, 0.72, 0), 0.3):
                crate(o, 2 + k, (0.22, 0.16, 0.2))
            with o.at((0.35, 0.72, 0.1), -0.4):
                paper_stack(o, k + 1, 0.08)
            with o.at((0.1, 0.72, -0.2), 0.6):
                paper_stack(o, k + 4, 0.03)
    for k in range(10):
        with o.at((rng.uniform(2.5, 13.5), 0, rng.uniform(2.8, 12.0)), rng.uniform(-1.5, 1.5)):
            crate(o, int(rng.integers(8)), (rng.uniform(0.25, 0.5), rng.uniform(0.2, 0.45), rng.uniform(0.25, 0.4)))
    for z in (2.2, 12.4):
        for x in range(4):
            o.quad("mark", "yellow", (0.8 + 3.6 * x, 0.002, z), (3.0, 0, 0), (0, 0, 0.12))
    for x in (1.9, 14.0):
        for z in range(3):
            o.quad("mark", "yellow", (x, 0.002, 2.4 + 3.3 * z), (0.12, 0, 0), (0, 0, 2.8))
    o.write(SCENES / "hall", "A machine hall", "hall.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
