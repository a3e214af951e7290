#!/usr/bin/env python3
"""Makes the room: room.obj, room.mtl and its textures, beside this file. Debian: python3-numpy python3-pil fonts-dejavu-core.

The room is 5 x 2.8 x 4 m: x to the east, y up, z to the south. Nothing in its pictures repeats, so that a corner can be
told from the next: every brick, plank, leaf and book is drawn once, over noise with the 1/f spectrum of natural images.
"""
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "generate"))

from furniture import BOOK_ROWS, Books, framed  # noqa: E402
from mesh import Obj, sphere_profile  # noqa: E402
from noise import rng_of, save, shade_corners  # noqa: E402
from prints import city_map, dead_leaves, landscape, parcels, spines, type_poster  # noqa: E402
from surfaces import bricks, carpet, fabric, planks, plaster, wallpaper  # noqa: E402

WIDTH, HEIGHT, DEPTH = 5.0, 2.8, 4.0  # metres


def textures():
    save(HERE / "wall_north.jpg", bricks("north", (WIDTH, HEIGHT)))
    save(HERE / "wall_east.jpg", wallpaper("east", (DEPTH, HEIGHT), (206, 200, 178), [(74, 104, 72), (106, 130, 84), (58, 84, 92), (136, 142, 96), (184, 84, 82), (222, 170, 160)]))
    save(HERE / "wall_west.jpg", wallpaper("west", (DEPTH, HEIGHT), (150, 170, 178), [(52, 80, 96), (84, 112, 104), (120, 96, 84), (60, 96, 76), (216, 200, 170), (204, 132, 92)]))
    save(HERE / "wall_south.jpg", planks("south", (WIDTH, HEIGHT), (176, 160, 136), plank_width=0.16))
    save(HERE / "floor.jpg", shade_corners(planks("floor", (WIDTH, DEPTH), (152, 104, 66)), (WIDTH, DEPTH)))
    save(HERE / "ceiling.jpg", plaster("ceiling", (WIDTH, DEPTH)))
    save(HERE / "carpet.jpg", carpet("carpet", (1000, 1440)))
    save(HERE / "wood_dark.jpg", planks("dark", (1.25, 1.25), (98, 64, 42), 0.00125, 0.25, 0.9, (3, 4)))
    save(HERE / "wood_light.jpg", planks("light", (1.25, 1.25), (196, 158, 112), 0.00125, 0.625, 0.9, (3, 4)))
    save(HERE / "sofa.jpg", fabric("sofa", 900, (70, 96, 112), [(58, 82, 98), (92, 122, 136), (150, 160, 150), (40, 60, 80)]))
    save(HERE / "cushion.jpg", fabric("cushion", 500, (196, 120, 60), [(226, 200, 140), (150, 60, 46), (70, 50, 60), (210, 150, 70)]))
    save(HERE / "poster_leaves.jpg", dead_leaves("leaves", (820, 600), [(40, 70, 60), (120, 140, 80), (200, 170, 90), (150, 60, 50), (60, 90, 130), (220, 210, 190)]))
    save(HERE / "poster_hills.jpg", landscape("hills", (1000, 640), (176, 190, 214), (140, 156, 176), (46, 66, 44)))
    save(HERE / "poster_dusk.jpg", landscape("dusk", (560, 760), (206, 150, 120), (170, 120, 130), (52, 40, 62)))
    save(HERE / "poster_type.jpg", type_poster("type", (560, 800), (236, 228, 208), (30, 36, 50), (192, 66, 44)))
    save(HERE / "poster_type2.jpg", type_poster("type2", (560, 800), (46, 62, 74), (232, 224, 200), (222, 160, 60)))
    save(HERE / "poster_map.jpg", city_map("map", (1000, 740)))
    save(HERE / "poster_shards.jpg", dead_leaves("shards", (600, 760), [(206, 190, 160), (60, 60, 70), (170, 84, 60), (90, 130, 140), (220, 180, 90)], 1800, 120))
    save(HERE / "globe.jpg", city_map("globe", (900, 450)))
    save(HERE / "parcels.jpg", parcels("parcels", 1024))
    picture, books = spines("spines", (2000, 300), BOOK_ROWS)
    save(HERE / "books.jpg", picture)
    return books


def cell(k):
    """The k-th picture of parcels.jpg, as a part of it."""
    return (k % 4) / 4 + 0.002, (k // 4) / 2 + 0.004, (k % 4 + 1) / 4 - 0.002, (k // 4 + 1) / 2 - 0.004


def things():
    """What moving.yaml moves, each about its own middle."""
    o = Obj(share=False)
    o.material("parcels", "parcels.jpg")
    o.box("parcel", "parcels", (-0.16, -0.11, -0.13), (0.16, 0.11, 0.13), cells=[cell(k) for k in (0, 1, 2, 6, 5, 3)])
    o.write(HERE / "parcel", "A parcel of vobench's room", "make_room.py")
    o = Obj(share=False)
    o.material("globe", "globe.jpg")
    o.lathe("ball", "globe", (0, 0, 0), sphere_profile(0.13, 16), 32)
    o.write(HERE / "ball", "A globe of vobench's room", "make_room.py")


def furnish(spine_columns):
    rng = rng_of("furniture")
    o = Obj(share=False)
    for name in ("wall_north", "wall_east", "wall_west", "wall_south", "floor", "ceiling", "carpet", "wood_dark", "wood_light", "sofa", "cushion",
                 "poster_leaves", "poster_hills", "poster_dusk", "poster_type", "poster_type2", "poster_map", "poster_shards", "globe",
                 "parcels", "books"):
        o.material(name, name + ".jpg")
    o.material("white", None, (0.75, 0.74, 0.70))
    o.material("pages", None, (0.72, 0.66, 0.52))
    o.material("black", None, (0.03, 0.03, 0.035))
    o.material("brass", None, (0.55, 0.40, 0.16))
    o.material("clay", None, (0.52, 0.22, 0.12))
    o.material("lamp", None, (0.8, 0.8, 0.8), (0.95, 0.88, 0.72))

    W, H, D = WIDTH, HEIGHT, DEPTH
    o.quad("north", "wall_north", (0, H, 0), (W, 0, 0), (0, -H, 0))
    o.quad("east", "wall_east", (W, H, 0), (0, 0, D), (0, -H, 0))
    o.quad("south", "wall_south", (W, H, D), (-W, 0, 0), (0, -H, 0))
    o.quad("west", "wall_west", (0, H, D), (0, 0, -D), (0, -H, 0))
    o.quad("floor", "floor", (0, 0, 0), (W, 0, 0), (0, 0, D))
    o.quad("ceiling", "ceiling", (0, H, D), (W, 0, 0), (0, 0, -D))
    o.box("carpet", "carpet", (1.35, 0.0, 0.95), (3.75, 0.012, 2.6), cells=[(0, 0, 0.02, 0.02)] * 4 + [(0, 0, 1, 1)])
    for a, b in (((0, 0, 0), (W, 0.09, 0.018)), ((0, 0, D - 0.018), (W, 0.09, D)), ((0, 0, 0), (0.018, 0.09, D)), ((W - 0.018, 0, 0), (W, 0.09, D))):
        o.box("skirting", "white", a, b)
    o.box("ceiling lamp", "lamp", (2.0, H - 0.05, 1.7), (3.2, H - 0.02, 2.3))

    framed(o, rng, "hills", "poster_hills", (1.42, 2.15, 0), (1.0, 0, 0), (0, -0.64, 0))
    framed(o, rng, "type", "poster_type", (2.68, 2.25, 0), (0.50, 0, 0), (0, -0.714, 0), "black", 0.015)
    framed(o, rng, "leaves", "poster_leaves", (3.45, 2.1, 0), (0.82, 0, 0), (0, -0.6, 0), "wood_light")
    framed(o, rng, "shards", "poster_shards", (4.45, 2.0, 0), (0.42, 0, 0), (0, -0.532, 0), "black", 0.015)
    framed(o, rng, "map", "poster_map", (W, 2.1, 0.75), (0, 0, 1.0), (0, -0.74, 0), "wood_dark")
    framed(o, rng, "dusk", "poster_dusk", (W, 2.05, 2.2), (0, 0, 0.56), (0, -0.76, 0), "wood_light")
    framed(o, rng, "type2", "poster_type2", (0, 2.1, 1.6), (0, 0, -0.5), (0, -0.714, 0), "black", 0.015)
    framed(o, rng, "hills2", "poster_leaves", (3.6, 2.0, D), (-1.2, 0, 0), (0, -0.88, 0), "wood_dark")

    # Bookshelf in the north-west corner: uprights, shelves, books.
    x0, x1, deep = 0.12, 1.22, 0.30
    for x in (x0, (x0 + x1) / 2, x1):
        o.box("shelf", "wood_light", (x - 0.012, 0.0, 0.01), (x + 0.012, 2.02, deep), 1.25, rng)
    levels = (0.06, 0.42, 0.76, 1.10, 1.42, 1.72, 2.02)
    for y in levels:
        o.box("shelf", "wood_light", (x0, y - 0.012, 0.01), (x1, y + 0.012, deep), 1.25, rng)
    o.box("shelf back", "wood_dark", (x0, 0.05, 0.004), (x1, 2.02, 0.012), 1.25, rng)
    books = Books(spine_columns)  # every book stands in the room once

    for k, y in enumerate(levels[:-1]):
        room = levels[k + 1] - y - 0.05
        for bay in (0, 1):
            x = x0 + 0.014 + bay * (x1 - x0) / 2
            end = x + (x1 - x0) / 2 - 0.03
            stop = end - rng.uniform(0.0, 0.24)
            while x + books.thickness() <= stop:
                x += books.stand(o, x, y + 0.012, deep - rng.uniform(0.01, 0.06), min(room, rng.uniform(0.19, 0.29)), 0.17) + 0.001

    # Sideboard under the pictures, with things on it.
    o.box("sideboard", "wood_dark", (1.55, 0.12, 0.02), (3.35, 0.78, 0.46), 1.25, rng)
    for k in range(3):
        a = 1.57 + 0.59 * k
        o.box("sideboard doors", "wood_light", (a, 0.15, 0.46), (a + 0.58, 0.75, 0.475), 1.25, rng)
        o.lathe("knobs", "brass", (a + 0.52, 0.5, 0.492), sphere_profile(0.018, 10), 14)
    for x in (1.62, 3.28):
        for z in (0.08, 0.40):
            o.box("sideboard legs", "black", (x - 0.02, 0, z - 0.02), (x + 0.02, 0.12, z + 0.02))
    top = 0.78
    o.lathe("globe", "globe", (1.85, top + 0.21, 0.24), sphere_profile(0.16), 48)
    o.lathe("globe foot", "brass", (1.85, top, 0.24), [(0.02, 0.06), (0.03, 0.03), (0.10, 0.012), (0.10, 0.0)], 32)
    x = 2.25
    for _ in range(9):
        x += books.stand(o, x, top, 0.34, rng.uniform(0.2, 0.28), 0.17) + 0.001
    o.box("tin", "parcels", (2.75, top, 0.14), (2.93, top + 0.2, 0.32), cells=[cell(3), cell(7), cell(4), cell(5), cell(3), cell(3)], turn=0.35)
    o.lathe("vase", "clay", (3.16, top, 0.25), [(0.045, 0.30), (0.04, 0.27), (0.05, 0.22), (0.085, 0.14), (0.09, 0.09), (0.06, 0.01), (0.055, 0.0)], 36)

    # Table in the middle with things on it; sofa on the east; parcels and a lamp in the corner.
    high = 0.76
    o.box("table", "wood_light", (1.95, high - 0.035, 1.15), (3.15, high, 1.80), 1.25, rng)
    for x in (2.0, 3.1):
        for z in (1.20, 1.75):
            o.box("table legs", "wood_dark", (x - 0.025, 0.012, z - 0.025), (x + 0.025, high - 0.035, z + 0.025), 1.25, rng)
    o.box("cloth", "cushion", (2.25, high, 1.20), (2.60, high + 0.003, 1.798), 0.5, rng)
    o.box("parcel", "parcels", (2.02, high, 1.36), (2.26, high + 0.17, 1.58), cells=[cell(k) for k in (0, 1, 2, 6, 1, 0)], turn=-0.3)
    o.box("atlas", "poster_shards", (2.62, high, 1.30), (2.94, high + 0.035, 1.54), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)], turn=0.5)
    o.box("atlas", "poster_map", (2.66, high + 0.035, 1.33), (2.90, high + 0.06, 1.51), cells=[(0, 0, 0.3, 0.03)] * 4 + [(0, 0, 1, 1)], turn=0.1)
    o.lathe("ball", "globe", (2.45, high + 0.083, 1.42), sphere_profile(0.08), 36)
    o.lathe("tin", "books", (3.02, high, 1.58), [(1e-4, 0.15), (0.05, 0.15), (0.05, 0.149), (0.05, 0.001), (0.05, 0.0)], 36, (0.1, 0.02, 0.26, 0.3))
    x = 2.68
    for _ in range(4):
        x += books.stand(o, x, high, 1.74, rng.uniform(0.2, 0.26), 0.16) + 0.001
    o.lathe("ball", "cushion", (3.06, high + 0.07, 1.30), sphere_profile(0.07), 36)
    o.box("sofa", "sofa", (4.15, 0.12, 0.75), (4.95, 0.42, 2.55), 0.9, rng)
    o.box("sofa back", "sofa", (4.78, 0.42, 0.75), (4.97, 0.86, 2.55), 0.9, rng)
    for z in (0.62, 2.55):
        o.box("sofa arm", "sofa", (4.15, 0.12, z), (4.95, 0.62, z + 0.14), 0.9, rng)
    for z, turn in ((0.98, 0.2), (1.6, -0.15), (2.25, 0.3)):
        o.box("cushion", "cushion", (4.60, 0.42, z - 0.2), (4.74, 0.80, z + 0.2), 0.5, rng, turn=turn)
    o.box("crate", "parcels", (3.62, 0.0, 0.12), (4.12, 0.42, 0.52), cells=[cell(k) for k in (1, 6, 0, 1, 6, 6)], turn=0.12)
    o.box("crate", "parcels", (3.68, 0.42, 0.16), (4.02, 0.72, 0.46), cells=[cell(k) for k in (4, 2, 5, 3, 7, 7)], turn=-0.25)
    o.box("crate", "parcels", (4.25, 0.0, 0.14), (4.60, 0.30, 0.48), cells=[cell(k) for k in (2, 5, 7, 4, 0, 0)], turn=0.4)
    o.lathe("floor lamp foot", "black", (4.72, 0, 0.30), [(0.012, 1.45), (0.012, 0.03), (0.15, 0.02), (0.15, 0.0)], 28)
    o.lathe("floor lamp shade", "lamp", (4.72, 1.40, 0.30), [(0.10, 0.28), (0.18, 0.0)], 36)
    # West: a chest with drawers; south: a long bench.
    o.box("chest", "wood_light", (0.02, 0.0, 1.2), (0.48, 0.9, 2.3), 1.25, rng)
    for k in range(3):
        o.box("drawers", "wood_dark", (0.48, 0.06 + 0.28 * k, 1.24), (0.495, 0.32 + 0.28 * k, 2.26), 1.25, rng)
    o.box("parcel", "parcels", (0.1, 0.9, 1.35), (0.38, 1.12, 1.65), cells=[cell(k) for k in (5, 3, 2, 7, 4, 4)], turn=0.3)
    o.lathe("ball", "globe", (0.25, 1.03, 1.98), sphere_profile(0.13), 40)
    o.box("bench", "wood_dark", (1.2, 0.40, 3.5), (3.8, 0.46, 3.92), 1.25, rng)
    for x in (1.3, 3.7):
        o.box("bench legs", "wood_dark", (x - 0.03, 0, 3.55), (x + 0.03, 0.40, 3.87), 1.25, rng)
    o.write(HERE / "room", "The room of vobench", "make_room.py")


if __name__ == "__main__":
    things()
    furnish(textures())
