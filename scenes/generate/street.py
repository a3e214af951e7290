#!/usr/bin/env python3
"""Makes scenes/street.obj: a street of 76 m between houses of three to six floors, with pavements, cars, trees and lamp posts.
x runs along the street, its middle is z = 0."""
import math
from pathlib import Path

import numpy as np

from furniture import cell
from interior import new_mesh, wall
from mesh import sphere_profile
from noise import rng_of

SCENES = Path(__file__).resolve().parent.parent
LONG, ROAD, HALF = 76.0, 3.4, 6.6  # length; half the width of the road; of the canyon [m]
FLOOR = 3.1


def house(o, rng, width, floors, material, tint):
    """Its front is in the plane z = 0 and looks to +z; from x = 0 to width."""
    high, ground = 3.6 + FLOOR * (floors - 1), 3.6
    columns = max(2, int(width / rng.uniform(2.0, 2.6)))
    pitch, w, h = width / columns, 1.15, 1.75
    front, deep = "front_%s_%02.0f_%02.0f_%02.0f" % (material, *(10 * np.array(tint))), 0.16
    o.material(front, f"textures/{material}.jpg", tint)
    metres = 2.028 if material == "brick" else 2.56
    for k in range(1, floors):
        holes = [((j + 0.5) * pitch - w / 2, 0.65, (j + 0.5) * pitch + w / 2, 0.65 + h) for j in range(columns)]
        top = ground + FLOOR * k
        with o.at((0, top, 0)):
            wall(o, "house front", front, (0, 0, 0), (width, 0, 0), (0, -FLOOR, 0), holes, metres)
            for x0, y0, x1, y1 in holes:
                o.quad("window", "windows", (x0, -y0, -deep), (w, 0, 0), (0, -h, 0), cell(int(rng.integers(18)), 6, 3, 0.01))
                for start, side in (((x0, -y0, -deep), (0, -h, 0)), ((x1, -y0, -deep), (0, -h, 0)), ((x0, -y0, -deep), (w, 0, 0))):
                    o.quad("reveal", "stone", start, side, (0, 0, deep))
                o.quad("sill", "stone", (x0 - 0.08, -y1, -deep), (w + 0.16, 0, 0), (0, -0.02, deep + 0.09), (0, 0, 1, 0.2))
                o.quad("sill", "stone", (x0 - 0.08, -y1 - 0.02, 0.09), (w + 0.16, 0, 0), (0, -0.08, 0), (0, 0.2, 1, 0.26))
                o.quad("sill", "stone", (x0 - 0.08, -y1 - 0.1, 0.09), (w + 0.16, 0, 0), (0, 0, -0.09), (0, 0.3, 1, 0.37))
                if tint[0] > 0.85:
                    o.quad("lintel", "stone", (x0 - 0.1, -y0 + 0.16, 0.03), (w + 0.2, 0, 0), (0, -0.16, 0), (0, 0.5, 1, 0.62))
        if k % 2 == 1:
            o.box("string course", "stone", (0, ground + FLOOR * (k - 1) - 0.1, 0), (width, ground + FLOOR * (k - 1) + 0.1, 0.1))
        if rng.random() < 0.35:
            j = int(rng.integers(columns))
            x = (j + 0.5) * pitch
            o.box("balcony", "stone", (x - 0.9, ground + FLOOR * (k - 1) + 0.28, 0), (x + 0.9, ground + FLOOR * (k - 1) + 0.4, 0.8))
            for t in np.linspace(-0.85, 0.85, 15):
                o.quad("railing", "black", (x + t - 0.015, ground + FLOOR * (k - 1) + 1.35, 0.77), (0.03, 0, 0), (0, -0.95, 0))
            o.box("railing", "black", (x - 0.88, ground + FLOOR * (k - 1) + 1.33, 0.75), (x + 0.88, ground + FLOOR * (k - 1) + 1.38, 0.8))
    # Ground floor: shops, each with its piers.
    shops = max(1, round(width / 4.6))
    wide = width / shops
    for k in range(shops):
        o.quad("shop", "shops", (k * wide + 0.3, ground - 0.25, -0.05), (wide - 0.6, 0, 0), (0, -(ground - 0.25), 0), cell(int(rng.integers(6)), 3, 2, 0.004))
        if rng.random() < 0.4:
            color = ("red", "green", "blue", "yellow")[int(rng.integers(4))]
            o.surface("awning", color, [[(k * wide + 0.4 + t * (wide - 0.8), ground - 0.55 - 0.45 * s - (0.04 if j % 2 else 0) * s, 0.05 + 1.1 * s) for j, t in enumerate(np.linspace(0, 1, 13))] for s in (0, 0.5, 1)],
                      [[(0, 0)] * 13] * 3)
    for k in range(shops + 1):
        x0, x1 = max(0, k * wide - 0.32), min(width, k * wide + 0.32)
        o.box("pier", front, (x0, 0, -0.1), (x1, ground, 0.02), metres, rng)
    o.box("fascia", front, (0, ground - 0.26, -0.1), (width, ground, 0.06), metres, rng)
    o.box("cornice", "stone", (-0.02, high - 0.1, -0.2), (width + 0.02, high + 0.25, 0.35))
    o.quad("roof", "roof", (0, high + 0.2, -9.0), (width, 0, 0), (0, 0, 9.0))
    for side in (0.0, width):  # gables, seen over lower neighbours
        o.sheet("gable", front, (side, high + 0.2, -9.0), (0, 0, 9.0), (0, -high - 0.2, 0), metres, rng)
    for x in rng.uniform(0.1, 0.9, 2) * width:
        o.box("chimney", "brick", (x - 0.4, high + 0.2, -3.2), (x + 0.4, high + 1.9, -2.4), 2.0, rng)
    return high


def car(o, rng, color, long=4.2):
    """Along x, its middle at the origin."""
    stations = np.array([(-0.5, 0.46, 0.62), (-0.49, 0.5, 0.76), (-0.36, 0.78, 0.84), (-0.30, 0.86, 0.86), (-0.12, 1.38, 0.70), (0.12, 1.42, 0.70), (0.28, 0.98, 0.82),
                         (0.33, 0.90, 0.85), (0.47, 0.76, 0.80), (0.5, 0.55, 0.66)])
    section = [(-1.0, 0.26), (-1.02, 0.5), (-1.0, 0.62), (-0.94, 0.72), (-0.80, 0.96), (-0.5, 1.0), (0.5, 1.0), (0.80, 0.96), (0.94, 0.72), (1.0, 0.62), (1.02, 0.5), (1.0, 0.26)]
    grid = []
    for s, top, half in stations:
        ring = []
        for a, b in section:
            y = 0.26 + (top - 0.26) * max(0.0, (b - 0.26) / 0.74)
            narrow = half if b < 0.7 else half * (1 - 0.16 * max(0, (top - 0.9)) / 0.5)
            ring.append((s * long, y, a * min(narrow, half) * 1.0 + 0.0))
        grid.append(ring)
    o.surface("car", color, grid, [[(0, 0)] * len(section)] * len(stations))
    for end in (0, -1):
        s, top, half = stations[end]
        sign = -1 if end == 0 else 1
        o.quad("car end", color, (s * long, top, -half * sign), (0, 0, 2 * half * sign), (0, 0.26 - top, 0))
        for z in (-0.55, 0.55):
            o.box("lights", "yellow" if end else "red", (s * long - 0.015, 0.56, z - 0.12), (s * long + 0.015, 0.66, z + 0.12))
    for side in (-1, 1):  # windows lie just before the body
        for x0, x1 in ((-0.20, -0.01), (0.02, 0.18)):
            o.quad("car window", "dark", (x0 * long, 1.28, side * 0.655), ((x1 - x0) * long, 0, 0), (0, -0.34, side * 0.16))
        for x in (-0.31 * long, 0.31 * long):
            o.tube("wheel", "black", [(x, 0.31, side * 0.62), (x, 0.31, side * 0.80)], (0.31, 0.31), segments=14, steps=1, caps=False)
            with o.at((x, 0.31, side * 0.805), 0.0, side * math.pi / 2):
                o.lathe("wheel", "steel", (0, 0, 0), [(0.01, 0.01), (0.19, -0.005)], 14)
                o.lathe("wheel", "black", (0, 0, 0), [(0.19, -0.004), (0.31, -0.006)], 14)
    o.quad("windscreen", "dark", (0.125 * long, 1.395, -0.55), (0, 0, 1.1), (0.15 * long, -0.38, 0))
    o.quad("rear window", "dark", (-0.125 * long, 1.36, 0.55), (0, 0, -1.1), (-0.165 * long, -0.44, 0))


def tree(o, rng):
    o.tube("trunk", "bark", [(0, 0, 0), (0.03, 1.6, 0.02), (-0.02, 3.2, 0.0), (0.0, 4.6, 0.03)], (0.17, 0.14, 0.11, 0.05), 0.5, 12)
    for k in range(5):
        a = 2.4 * k
        place = (rng.uniform(0.2, 0.9) * math.cos(a), 3.4 + 0.5 * k + rng.uniform(-0.2, 0.2), rng.uniform(0.2, 0.9) * math.sin(a))
        size = rng.uniform(0.8, 1.15)
        rows, columns = 6, 10
        grid, uv = [], []
        bumps = 1 + 0.16 * rng.standard_normal((rows + 1, columns))
        for i in range(rows + 1):
            e = math.pi * (0.5 - i / rows)
            ring = []
            for j in range(columns + 1):
                b = bumps[i, j % columns] if 0 < i < rows else 1.0
                t = -2 * math.pi * j / columns
                ring.append((place[0] + size * b * math.cos(e) * math.cos(t), place[1] + 0.8 * size * b * math.sin(e), place[2] + size * b * math.cos(e) * math.sin(t)))
            grid.append(ring)
            uv.append([(4 * size * j / columns, 2.0 * size * i / rows) for j in range(columns + 1)])
        o.surface("crown", "foliage", grid, uv, closed=True)


def lamp_post(o):
    o.lathe("lamp post", "dark", (0, 0, 0), [(0.035, 5.0), (0.045, 2.5), (0.06, 1.0), (0.09, 0.8), (0.1, 0.0)], 14)
    o.tube("lamp post", "dark", [(0, 4.95, 0), (0, 5.25, 0.25), (0, 5.3, 0.8)], (0.03, 0.028, 0.025), segments=8)
    o.cushion("lamp post", "steel", (0, 5.28, 1.0), (0.1, 0.05, 0.26), 0.5, 0.6, (6, 12))


def main():
    o, rng = new_mesh(), rng_of("street")
    o.material("stone", "textures/concrete.jpg", (1.15, 1.1, 0.98))
    o.material("roof", None, (0.24, 0.12, 0.09))
    o.material("bark", "textures/hair.jpg", (0.9, 0.9, 0.85))
    o.material("silver", None, (0.55, 0.56, 0.58))
    wall(o, "road", "asphalt", (0, 0, -ROAD), (LONG, 0, 0), (0, 0, 2 * ROAD))
    for x in np.arange(1.0, LONG - 2, 6.0):
        o.box("mark", "white", (x, -0.01, -0.06), (x + 3.0, 0.004, 0.06))
    for side in (-1, 1):
        with o.at((0 if side < 0 else LONG, 0.14, side * ROAD), 0 if side < 0 else math.pi):  # pavement and kerb
            wall(o, "pavement", "paving", (0, 0, ROAD - HALF), (LONG, 0, 0), (0, 0, HALF - ROAD))
            for x in np.arange(0, LONG, 2.0):
                o.quad("kerb", "stone", (x, 0, 0), (2.0, 0, 0), (0, -0.15, 0), (x / 1.3, 0, x / 1.3 + 1.54, 0.12))
        with o.at((0 if side < 0 else LONG, 0.14, side * HALF), 0 if side < 0 else math.pi):
            x = 0.0
            while x < LONG - 1:
                width = rng.uniform(8.5, 14.0)
                if LONG - x - width < 8.5:
                    width = LONG - x
                material = ("brick", "plaster", "brick", "concrete")[int(rng.integers(4))]
                tints = {"brick": ((1.0, 1.0, 1.0), (0.8, 0.76, 0.8), (1.0, 0.93, 0.78)), "plaster": ((0.95, 0.86, 0.66), (0.8, 0.9, 0.92), (0.93, 0.72, 0.62), (0.97, 0.95, 0.9)),
                         "concrete": ((1.2, 1.16, 1.05), (1.0, 0.98, 0.92))}[material]
                with o.at((x, 0, 0)):
                    house(o, rng, width, int(rng.integers(3, 6)), material, tints[int(rng.integers(len(tints)))])
                x += width
    for x, turn in ((0.0, math.pi / 2), (LONG, -math.pi / 2)):  # the street ends at houses
        with o.at((x, 0.0, HALF + 3 if x == 0 else -HALF - 3), turn):
            house(o, rng, 2 * HALF + 6, 5, "brick" if x else "plaster", (1.0, 0.95, 0.85))
    taken = []
    for k, x in enumerate(np.arange(7, LONG - 6, 6.2)):
        for side in (-1, 1):
            if rng.random() < 0.72:
                with o.at((x + rng.uniform(-0.5, 0.5), 0.0, side * (ROAD - 1.0)), 0 if side < 0 else math.pi):
                    car(o, rng, ("red", "blue", "silver", "dark", "white", "green")[int(rng.integers(6))], rng.uniform(3.8, 4.5))
                taken.append(x)
    for k, x in enumerate(np.arange(9.5, LONG - 4, 12.4)):
        with o.at((x, 0.14, -HALF + 2.4)):
            tree(o, rng)
        with o.at((x + 6.0, 0.14, HALF - 2.4)):
            tree(o, rng)
        with o.at((x + 5.4, 0.14, -HALF + 2.6)):
            lamp_post(o)
        with o.at((x + 0.5, 0.14, HALF - 2.6), math.pi):
            lamp_post(o)
        with o.at((x + 2.8, 0.14, -HALF + 2.2)):
            o.lathe("bin", "green", (0, 0, 0), [(0.01, 0.95), (0.22, 0.9), (0.24, 0.85), (0.2, 0.0)], 16)
        with o.at((x + 3.0, 0.14, HALF - 2.2), 0.3):
            o.box("box", "yellow", (-0.25, 0.5, -0.18), (0.25, 1.25, 0.18))
            o.box("box", "dark", (-0.04, 0.0, -0.04), (0.04, 0.5, 0.04))
    o.write(SCENES / "street", "A street", "street.py")
    return o.triangles


if __name__ == "__main__":
    print(main(), "triangles")
