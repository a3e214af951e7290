#!/usr/bin/env python3
"""Writes box.obj, plane.obj, cylinder.obj and sphere.obj, which `vobench import` stretches, beside this file: of side,
radius and length 1, about the origin; the cylinder's axis and the plane's normal are z."""
import math
import pathlib

HERE = pathlib.Path(__file__).parent
AROUND, BANDS = 32, 16


def turned(rings, apart=False):
    """Surface of revolution about z through rings (radius, z, normal's radius, normal's z); apart: bands of two each."""
    lines = []
    faces = []
    for k, (r, z, nr, nz) in enumerate(rings):
        for i in range(AROUND + 1):
            c, s = math.cos(2 * math.pi * i / AROUND), math.sin(2 * math.pi * i / AROUND)
            lines.append(f"v {r * c:.7g} {r * s:.7g} {z:.7g}")
            lines.append(f"vt {i / AROUND:.7g} {((k + 1) // 2 / (len(rings) // 2) if apart else k / (len(rings) - 1)):.7g}")
            lines.append(f"vn {nr * c:.7g} {nr * s:.7g} {nz:.7g}")
            if k == 0 or i == 0 or (apart and k % 2 == 0):
                continue
            b = k * (AROUND + 1) + i + 1
            a = b - AROUND - 1
            corners = [a - 1, a, b, b - 1]
            if rings[k - 1][0] == 0:
                corners = [a - 1, b, b - 1]
            elif r == 0:
                corners = [a - 1, a, b]
            faces.append("f " + " ".join(f"{n}/{n}/{n}" for n in corners))
    return "\n".join(lines + faces) + "\n"


def squares(*corners):
    lines = ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    for n, square in enumerate(corners):
        lines += [f"v {x} {y} {z}" for x, y, z in square]
        lines.append("f " + " ".join(f"{4 * n + i}/{i}" for i in (1, 2, 3, 4)))
    return "\n".join(lines) + "\n"


def main():
    h = 0.5
    top = [(-h, -h, h), (h, -h, h), (h, h, h), (-h, h, h)]
    side = [(h, -h, -h), (h, h, -h), (h, h, h), (h, -h, h)]
    quarter = lambda square: [(-y, x, z) for x, y, z in square]
    sides = [side, quarter(side), quarter(quarter(side)), quarter(quarter(quarter(side)))]
    (HERE / "plane.obj").write_text(squares([(x, y, 0) for x, y, _ in top]))
    (HERE / "box.obj").write_text(squares(top, [(x, -y, -z) for x, y, z in top], *sides))
    (HERE / "cylinder.obj").write_text(turned([(0, -h, 0, -1), (1, -h, 0, -1), (1, -h, 1, 0), (1, h, 1, 0), (1, h, 0, 1),
                                               (0, h, 0, 1)], apart=True))
    latitudes = [math.pi * (k / BANDS - 0.5) for k in range(BANDS + 1)]
    circles = [(round(math.cos(a), 12), math.sin(a)) for a in latitudes]
    (HERE / "sphere.obj").write_text(turned([(r, z, r, z) for r, z in circles]))


if __name__ == "__main__":
    main()
