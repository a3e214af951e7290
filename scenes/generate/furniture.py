"""Pieces of furniture and what lies on them. Each takes the mesh and stands in the frame of Obj.at: floor at y = 0, its
back towards -z."""
import math

import numpy as np

from mesh import sphere_profile
from prints import spines

WOOD = 1.25  # metres that a repeat of room/wood_*.jpg shows
BOOK_ROWS = 3  # of spines in books.jpg
SHEET = (4, 2)  # pages in print.jpg, posters in notices.jpg


def cell(k, columns, rows, inset=0.004):
    """The k-th cell of a sheet of pictures."""
    x, y = k % columns, k // columns % rows
    return ((x + inset) / columns, (y + inset) / rows, (x + 1 - inset) / columns, (y + 1 - inset) / rows)


def framed(o, rng, group, picture, corner, right, down, frame="wood_dark", wide=0.03, uv=(0, 0, 1, 1)):
    """A picture hung on a wall: corner is its upper left, seen from the front."""
    p, r, d = (np.array(v, float) for v in (corner, right, down))
    ru, du = r / np.linalg.norm(r), d / np.linalg.norm(d)
    out = np.cross(du, ru) * 0.025
    o.quad(group, picture, p + out * 0.6, r, d, uv)
    for q, along, across in ((p - wide * (ru + du), r + 2 * wide * ru, wide * du), (p + d - wide * ru, r + 2 * wide * ru, wide * du),
                             (p - wide * ru, wide * ru, d), (p + r, wide * ru, d)):
        u, v = rng.uniform(0, 1, 2)
        o.quad(group, frame, q + out, along, across, (u, v, u + np.linalg.norm(along), v + np.linalg.norm(across)))
        for edge, side in ((q, along), (q + across, along), (q, across), (q + along, across)):
            o.quad(group, frame, edge + out, side, -out, (u, v, u + 0.1, v + 0.02))


class Books:
    """The books of books.jpg, each of which is taken once and then once more."""

    def __init__(self, columns=None):
        self.columns = list(columns if columns is not None else spines("spines", (2000, 300), BOOK_ROWS)[1])
        self.stack = list(self.columns)

    def thickness(self):
        return (self.stack[-1][1] - self.stack[-1][0]) * 0.001

    def stand(self, o, x, y, z_front, height, depth):
        """One book from x on; returns how thick it is."""
        c0, c1, row = self.stack.pop()
        if not self.stack:
            self.stack = list(self.columns)
        thick = (c1 - c0) * 0.001
        top, bottom = row / BOOK_ROWS, (row + 1) / BOOK_ROWS
        cover = ((c0 + 2) / 2000, top + 0.02, (c0 + 4) / 2000, top + 0.03)
        front = (c0 / 2000, top, c1 / 2000, bottom)
        o.box("books", "books", (x, y, z_front - depth), (x + thick, y + height, z_front), cells=[front, cover, cover, cover, cover, cover])
        o.quad("pages", "pages", (x + 0.002, y + height + 0.0005, z_front - depth), (thick - 0.004, 0, 0), (0, 0, depth - 0.006))
        return thick

    def row(self, o, rng, x, end, y, z_front, room=0.30):
        while x + self.thickness() <= end:
            x += self.stand(o, x, y, z_front - rng.uniform(0.01, 0.05), min(room, rng.uniform(0.19, 0.29)), 0.17) + 0.001


def legs(o, group, material, width, depth, height, thick=0.025, inset=0.04, rng=None):
    for x in (-width / 2 + inset, width / 2 - inset):
        for z in (-depth / 2 + inset, depth / 2 - inset):
            o.box(group, material, (x - thick, 0, z - thick), (x + thick, height, z + thick), WOOD if rng is not None else None, rng)


def table(o, rng, width, depth, height=0.74, top="wood_light", leg="wood_dark"):
    o.box("table", top, (-width / 2, height - 0.03, -depth / 2), (width / 2, height, depth / 2), WOOD, rng)
    legs(o, "table legs", leg, width, depth, height - 0.03, 0.025, 0.06, rng)


def chair(o, rng, seat="sofa", wood="wood_dark"):
    """A wooden chair; who sits on it looks to +z."""
    legs(o, "chair legs", wood, 0.42, 0.42, 0.44, 0.018, 0.02, rng)
    o.cushion("chair seat", seat, (0, 0.455, 0), (0.22, 0.025, 0.22), 0.5, 0.3)
    for x in (-0.19, 0.19):
        o.tube("chair back", wood, [(x, 0.44, -0.2), (x, 0.7, -0.22), (x, 0.94, -0.27)], (0.018, 0.017, 0.015), WOOD, 10)
    for y, z in ((0.62, -0.213), (0.76, -0.23), (0.90, -0.258)):
        o.box("chair back", wood, (-0.19, y - 0.03, z - 0.008), (0.19, y + 0.03, z + 0.008), WOOD, rng)


def office_chair(o, cloth="cloth_grey"):
    o.cushion("office chair", cloth, (0, 0.47, 0), (0.25, 0.045, 0.24), 0.5, 0.4)
    o.cushion("office chair", cloth, (0, 0.80, -0.24), (0.23, 0.25, 0.04), 0.5, 0.45, tilt=-0.12)
    o.tube("office chair", "black", [(0, 0.45, -0.2), (0, 0.5, -0.29), (0, 0.7, -0.27)], (0.02, 0.02, 0.02), segments=8)
    o.lathe("office chair", "steel", (0, 0.1, 0), [(0.025, 0.34), (0.025, 0.0)], 14)
    for k in range(5):
        a = 2 * math.pi * k / 5 + 0.3
        x, z = math.cos(a), math.sin(a)
        o.tube("office chair", "black", [(0.02 * x, 0.13, 0.02 * z), (0.28 * x, 0.08, 0.28 * z)], (0.03, 0.018), segments=8)
        o.lathe("office chair", "black", (0.29 * x, 0.03, 0.29 * z), sphere_profile(0.03, 6), 10)
    for side in (-1, 1):
        o.tube("office chair", "black", [(0.25 * side, 0.45, 0.0), (0.3 * side, 0.5, 0), (0.3 * side, 0.66, 0)], (0.015, 0.015, 0.015), segments=8)
        o.cushion("office chair", "black", (0.3 * side, 0.68, 0.02), (0.03, 0.015, 0.13), 0.5, 0.5, (6, 12))


def sofa(o, width, cloth="sofa", cushions=("cushion",)):
    o.cushion("sofa", cloth, (0, 0.22, 0), (width / 2, 0.16, 0.42), 0.9, 0.15)
    seats = max(1, round(width / 0.75))
    for k in range(seats):
        x = (k - (seats - 1) / 2) * (width - 0.36) / seats
        o.cushion("sofa", cloth, (x, 0.43, 0.05), ((width - 0.36) / seats / 2 - 0.005, 0.08, 0.36), 0.9, 0.3)
        o.cushion("sofa", cloth, (x, 0.68, -0.28), ((width - 0.36) / seats / 2 - 0.005, 0.24, 0.11), 0.9, 0.35, tilt=-0.2)
    for side in (-1, 1):
        o.cushion("sofa", cloth, (side * (width / 2 - 0.08), 0.36, 0), (0.09, 0.27, 0.43), 0.9, 0.3)
    for k, cushion in enumerate(cushions):
        x = (-1) ** k * (width / 2 - 0.38 - 0.42 * (k // 2))
        o.cushion("cushions", cushion, (x, 0.66, -0.08), (0.2, 0.19, 0.06), 0.5, 0.55, turn=0.25 * (-1) ** k, tilt=-0.35)


def bookcase(o, rng, books, width, height, wood="wood_light", bays=1, levels=6, full=0.95, deep=0.3):
    for k in range(bays + 1):
        x = width * (k / bays - 0.5)
        o.box("shelf", wood, (x - 0.012, 0, -deep), (x + 0.012, height, 0), WOOD, rng)
    o.box("shelf back", wood, (-width / 2, 0.04, -deep - 0.006), (width / 2, height, -deep), WOOD, rng)
    for k in range(levels + 1):
        y = 0.06 + (height - 0.072) * k / levels
        o.box("shelf", wood, (-width / 2, y - 0.011, -deep), (width / 2, y + 0.011, -0.002), WOOD, rng)
        if k == levels:
            break
        for bay in range(bays):
            x0, x1 = width * (bay / bays - 0.5) + 0.015, width * ((bay + 1) / bays - 0.5) - 0.02
            if rng.random() < full:
                books.row(o, rng, x0 + rng.uniform(0, 0.05), x1 - rng.uniform(0, 0.35) * (x1 - x0), y + 0.0115, -0.01, (height - 0.072) / levels - 0.05)


def cabinet(o, rng, width, height, depth, body="wood_dark", front="wood_light", doors=2, drawers=0):
    """Its back is at z = 0, its front at `depth`."""
    o.box("cabinet", body, (-width / 2, 0, 0), (width / 2, height, depth), WOOD, rng)
    columns, rows = (1, drawers) if drawers else (doors, 1)
    for i in range(columns):
        for j in range(rows):
            x0, x1 = width * (i / columns - 0.5) + 0.008, width * ((i + 1) / columns - 0.5) - 0.008
            y0, y1 = height * j / rows + 0.012, height * (j + 1) / rows - 0.012
            o.box("cabinet front", front, (x0, y0, depth), (x1, y1, depth + 0.016), WOOD, rng)
            o.lathe("knobs", "brass", ((x0 + x1) / 2 if drawers else x1 - 0.05, (y0 + y1) / 2, depth + 0.03), sphere_profile(0.014, 6), 10)


def monitor(o, screen, width=0.52, height=0.31, stand=0.14):
    """The screen looks to +z; screen: which one of screens.jpg."""
    with o.at((0, stand, 0), 0, -0.05):
        o.box("monitor", "black", (-width / 2 - 0.015, 0, -0.03), (width / 2 + 0.015, height + 0.03, 0.0))
        o.quad("screen", "screens", (-width / 2, height + 0.015, 0.001), (width, 0, 0), (0, -height, 0), cell(screen, 2, 2, 0.001))
    o.box("monitor", "black", (-0.03, 0.01, -0.05), (0.03, stand + 0.1, -0.03))
    o.cushion("monitor", "black", (0, 0.008, -0.02), (0.13, 0.008, 0.09), 0.5, 0.6, (4, 16))


def keyboard(o):
    o.box("keyboard", "black", (-0.225, 0, -0.075), (0.225, 0.018, 0.075))
    o.quad("keyboard", "keyboard", (-0.225, 0.0185, -0.075), (0.45, 0, 0), (0, 0, 0.15))
    o.cushion("mouse", "black", (0.31, 0.015, 0.0), (0.03, 0.015, 0.055), 0.5, 0.7, (6, 12))


def paper(o, k, turn=0.0, lift=0.001, size=(0.21, 0.297)):
    """A sheet of A4; k: which one of print.jpg."""
    with o.at((0, 0, 0), turn):
        o.quad("sheet of paper", "print", (-size[0] / 2, lift, -size[1] / 2), (size[0], 0, 0), (0, 0, size[1]), cell(k, *SHEET))


def paper_stack(o, k, high, turn=0.0):
    with o.at((0, 0, 0), turn):
        o.box("papers", "pages", (-0.105, 0, -0.1485), (0.105, high, 0.1485))
    paper(o, k, turn, high + 0.0008)


def mug(o, material="clay", radius=0.041, high=0.095):
    o.lathe("mug", material, (0, 0, 0), [(radius - 0.005, 0.01), (radius - 0.005, high), (radius, high), (radius, 0.008), (radius - 0.01, 0.0)], 24)
    o.tube("mug", material, [(radius - 0.004, 0.075, 0), (radius + 0.028, 0.068, 0), (radius + 0.028, 0.035, 0), (radius - 0.006, 0.025, 0)], [0.006] * 4, 0.5, 8, 3)


def pencils(o, rng):
    o.lathe("pencil pot", "steel", (0, 0, 0), [(0.032, 0.005), (0.032, 0.1), (0.036, 0.1), (0.036, 0.0)], 20)
    for k in range(7):
        a, lean = rng.uniform(0, 6.28), rng.uniform(0.01, 0.03)
        foot, top = np.array((0.012 * math.cos(a), 0.01, 0.012 * math.sin(a))), np.array((lean * math.cos(a), rng.uniform(0.14, 0.18), lean * math.sin(a)))
        o.tube("pencils", ("red", "yellow", "blue", "green", "black")[k % 5], [foot, top], (0.0035, 0.0035), 0.5, 6, 1)


def plant(o, rng, high=0.8, leaves=40, pot=0.16):
    o.lathe("pot", "clay", (0, 0, 0), [(0.01, pot * 1.45), (pot * 0.9, pot * 1.5), (pot, pot * 1.6), (pot, pot * 1.4), (pot * 0.72, 0.0)], 28)
    for k in range(leaves):
        a, out, lift = k * 2.399 + rng.normal(0, 0.2), rng.uniform(0.45, 1.0) * high * 0.5, rng.uniform(0.35, 1.0) * high
        side, along = np.array((-math.sin(a), 0, math.cos(a))), np.array((math.cos(a), 0, math.sin(a)))
        base = np.array((0, pot * 1.45, 0)) + 0.03 * along
        tip = base + along * out + np.array((0, lift, 0))
        bend = base + along * out * 0.25 + np.array((0, lift * 0.85, 0))
        wide = rng.uniform(0.03, 0.05) * high / 0.8
        grid, uv = [], []
        for t in np.linspace(0, 1, 7):
            middle = (1 - t) ** 2 * base + 2 * t * (1 - t) * bend + t * t * tip
            w = wide * math.sin(math.pi * min(1.0, 0.06 + 0.94 * t) ** 1.5) + 0.003
            grid.append([middle - side * w, middle - np.array((0, 0.15 * w, 0)), middle + side * w])
            uv.append([(0.0 + 0.1 * (k % 10), t), (0.05 + 0.1 * (k % 10), t), (0.1 + 0.1 * (k % 10), t)])
        o.surface("leaves", "leaf", grid, uv)


def floor_lamp(o, high=1.55):
    o.lathe("floor lamp foot", "black", (0, 0, 0), [(0.012, high), (0.012, 0.03), (0.15, 0.02), (0.15, 0.0)], 24)
    o.lathe("floor lamp shade", "lamp", (0, high - 0.05, 0), [(0.12, 0.28), (0.2, 0.0)], 32)


def curtain(o, rng, material, width, high, folds=9, deep=0.05):
    """Hangs in folds from y = high, in the plane z = 0."""
    columns = folds * 6
    x = np.linspace(-width / 2, width / 2, columns + 1)
    phase = np.linspace(0, 2 * math.pi * folds, columns + 1) + np.cumsum(rng.normal(0, 0.12, columns + 1))
    grid, uv = [], []
    for t in np.linspace(0, 1, 7):
        grid.append(np.stack((x, np.full_like(x, high * (1 - t)), deep * (0.5 + 0.5 * t) * np.sin(phase + 0.3 * t)), -1))
        uv.append([(1.5 * a / 0.5, high * t / 0.5) for a in x])
    o.surface("curtain", material, grid, uv)


def radiator(o, width, high=0.55):
    for k in range(int(width / 0.06)):
        x = -width / 2 + 0.03 + 0.06 * k
        o.cushion("radiator", "white", (x, 0.12 + high / 2, 0.06), (0.026, high / 2, 0.05), 0.5, 0.4, (4, 8))


def door(o, rng, group="door", wood="wood_light", number=None, width=0.9, high=2.05):
    """In the plane z = 0, looking to +z, its frame 12 mm before the wall."""
    o.box(group, wood, (-width / 2, 0.005, 0), (width / 2, high, 0.012), WOOD, rng)
    for a, b in (((-width / 2 - 0.08, 0, 0), (-width / 2, high + 0.08, 0.03)), ((width / 2, 0, 0), (width / 2 + 0.08, high + 0.08, 0.03)),
                 ((-width / 2, high, 0), (width / 2, high + 0.08, 0.03))):
        o.box(group, "wood_dark", a, b, WOOD, rng)
    o.tube(group, "steel", [(width / 2 - 0.09, 1.03, 0.012), (width / 2 - 0.09, 1.03, 0.06), (width / 2 - 0.2, 1.03, 0.06)], [0.009] * 3, 0.5, 8, 3)
    if number is not None:
        o.quad(group, "signs", (width / 2 + 0.12, 1.72, 0.003), (0.18, 0, 0), (0, -0.12, 0), cell(number, 4, 4, 0.01))
