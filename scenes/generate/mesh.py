"""A mesh with texture coordinates, written as OBJ: quads, boxes, bodies of revolution, tubes, cushions. Metres, y up."""
import contextlib
import math
from pathlib import Path

import numpy as np


class Obj:
    """share: equal entries are written once, and all of a material is one object; the room's file has one entry for each corner, in
    the order in which things were made."""

    def __init__(self, share=True):
        self.lines, self.materials, self.current = [], {}, None
        self.count, self.seen, self.share = {"v": 0, "vt": 0, "vn": 0}, {}, share
        self.faces = {}  # of each material, where entries are shared
        self.origin, self.rotation, self.triangles = None, None, 0

    def material(self, name, texture=None, color=(1, 1, 1), emission=(0, 0, 0)):
        self.materials[name] = (texture, color, emission)

    def use(self, group, material):
        if material not in self.materials:
            raise KeyError(f"no material '{material}' ({group})")
        if not self.share and (group, material) != self.current:
            self.lines += [f"o {group}", f"usemtl {material}"]
        self.current = (group, material)

    @contextlib.contextmanager
    def at(self, position, turn=0.0, tilt=0.0):
        """What is added within stands at `position`, tilted about x, then turned about y [rad]; may be nested."""
        c, s, ct, st = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
        rotation = np.array(((c, 0, s), (0, 1, 0), (-s, 0, c))) @ np.array(((1, 0, 0), (0, ct, -st), (0, st, ct)))
        before = self.origin, self.rotation
        if before[0] is None:
            self.origin, self.rotation = np.array(position, float), rotation
        else:
            self.origin, self.rotation = before[0] + before[1] @ np.array(position, float), before[1] @ rotation
        yield
        self.origin, self.rotation = before

    def entry(self, kind, text):
        line = f"{kind} {text}"
        index = self.seen.get(line) if self.share else None
        if index is None:
            self.lines.append(line)
            self.count[kind] += 1
            index = self.seen[line] = self.count[kind]
        return index

    def corner(self, p, uv, n):
        if self.origin is not None:
            p, n = self.origin + self.rotation @ np.array(p, float), self.rotation @ np.array(n, float)
        place, direction = ("%.5f %.5f %.5f", "%.5f %.5f %.5f") if not self.share else ("%.4f %.4f %.4f", "%.2f %.2f %.2f")
        texture = "%.6f %.6f" if not self.share else "%.4f %.4f"
        return "%d/%d/%d" % (self.entry("v", place % tuple(p)),
                             self.entry("vt", texture % (uv[0], 1 - uv[1])),  # our v runs down, OBJ's up
                             self.entry("vn", direction % tuple(n)))

    def face(self, corners):
        if self.share:  # at a pole some corners are one
            places = [corner.split("/")[0] for corner in corners]
            corners = [c for k, c in enumerate(corners) if places[k] != places[k - 1]]
            if len(corners) < 3:
                return
        lines = self.faces.setdefault(self.current[1], []) if self.share else self.lines
        lines.append("f " + " ".join(corners))
        self.triangles += len(corners) - 2

    def quad(self, group, material, upper_left, right, down, uv=(0, 0, 1, 1)):
        """uv = (u0, v0, u1, v1): the part of the picture, from its upper left."""
        self.use(group, material)
        p, r, d = (np.array(a, float) for a in (upper_left, right, down))
        n = np.cross(d, r)
        n /= np.linalg.norm(n)
        u0, v0, u1, v1 = uv
        self.face([self.corner(p, (u0, v0), n), self.corner(p + d, (u0, v1), n), self.corner(p + d + r, (u1, v1), n),
                   self.corner(p + r, (u1, v0), n)])

    def sheet(self, group, material, upper_left, right, down, metres, rng=None):
        """A quad that takes its picture to scale: `metres` (one number or two) a repeat, from a random place with rng."""
        metres = np.broadcast_to(metres, 2)
        u, v = rng.uniform(0, 1, 2) if rng is not None else (0.0, 0.0)
        self.quad(group, material, upper_left, right, down,
                  (u, v, u + np.linalg.norm(right) / metres[0], v + np.linalg.norm(down) / metres[1]))

    def box(self, group, material, low, high, texture_metres=None, rng=None, cells=None, turn=0.0):
        """Faces take pieces of the texture to scale (texture_metres a side), from random places; or one of the cells."""
        low, high = np.array(low, float), np.array(high, float)
        middle, s = (low + high) / 2, high - low
        c, sn = math.cos(turn), math.sin(turn)
        rot = np.array(((c, 0, sn), (0, 1, 0), (-sn, 0, c)))
        sides = [((-1, 1, 1), (s[0], 0, 0), (0, -s[1], 0)), ((1, 1, -1), (-s[0], 0, 0), (0, -s[1], 0)),
                 ((-1, 1, -1), (0, 0, s[2]), (0, -s[1], 0)), ((1, 1, 1), (0, 0, -s[2]), (0, -s[1], 0)),
                 ((-1, 1, -1), (s[0], 0, 0), (0, 0, s[2])), ((-1, -1, 1), (s[0], 0, 0), (0, 0, -s[2]))]
        for k, (corner, right, down) in enumerate(sides):
            p = middle + rot @ (np.array(corner) * s / 2)
            right, down = rot @ np.array(right), rot @ np.array(down)
            if cells is not None:
                uv = cells[k % len(cells)]
            elif texture_metres is not None:
                w, h = np.linalg.norm(right) / texture_metres, np.linalg.norm(down) / texture_metres
                u, v = rng.uniform(0, 1, 2)
                uv = (u, v, u + w, v + h)
                if h > w:  # grain along the longer side
                    self.quad(group, material, p + down, -down, right, (u, v, u + h, v + w))
                    continue
            else:
                uv = (0, 0, 1, 1)
            self.quad(group, material, p, right, down, uv)

    def lathe(self, group, material, center, profile, segments=40, uv=(0, 0, 1, 1)):
        """profile: (radius, height) from top to bottom."""
        self.use(group, material)
        profile = np.array(profile, float)
        rings = []
        for i, (r, y) in enumerate(profile):
            a, b = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
            slope = b - a
            normal = np.array((-slope[1], slope[0]))
            normal /= max(np.linalg.norm(normal), 1e-9)
            ring = []
            for k in range(segments + 1):
                t = 2 * math.pi * k / segments
                cs, sn = math.cos(t), math.sin(t)
                ring.append(self.corner(np.array(center) + (r * cs, y, r * sn), (uv[0] + (uv[2] - uv[0]) * k / segments,
                                        uv[1] + (uv[3] - uv[1]) * i / (len(profile) - 1)), (normal[0] * cs, normal[1], normal[0] * sn)))
            rings.append(ring)
        for i in range(len(rings) - 1):
            for k in range(segments):
                self.face([rings[i][k], rings[i][k + 1], rings[i + 1][k + 1], rings[i + 1][k]])

    def surface(self, group, material, points, uv, closed=False):
        """A grid of points [rows, columns, 3] with smooth normals; closed: the last column is the first again. Seen from
        outside, rows run down and columns to the right. Rows that are one point are poles."""
        self.use(group, material)
        points = np.array(points, float)
        wide = np.concatenate((points[:, -2:-1], points, points[:, 1:2]), 1) if closed else points
        across = np.gradient(wide, axis=1)
        across = across[:, 1:-1] if closed else across
        normal = np.cross(np.gradient(points, axis=0), across)
        for row in (0, -1):  # a pole's normal is that of its neighbours
            if np.ptp(points[row], axis=0).max() < 1e-9:
                normal[row] = normal[1 if row == 0 else -2].sum(0)
        normal /= np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-12)
        names = [[self.corner(points[i, k], uv[i][k], normal[i, k]) for k in range(points.shape[1])] for i in range(points.shape[0])]
        for i in range(points.shape[0] - 1):
            for k in range(points.shape[1] - 1):
                self.face([names[i][k], names[i + 1][k], names[i + 1][k + 1], names[i][k + 1]])

    def cushion(self, group, material, center, half, metres, round_=0.35, steps=(8, 16), turn=0.0, tilt=0.0):
        """A box with round edges (superellipsoid): round_ 1 is an ellipsoid, small is a box."""
        bend = lambda c: np.sign(c) * np.abs(c) ** round_
        rows, columns = np.linspace(math.pi / 2, -math.pi / 2, steps[0] + 1), np.linspace(0, 2 * math.pi, steps[1] + 1)
        e, a = np.meshgrid(rows, -columns, indexing="ij")
        points = np.stack((half[0] * bend(np.cos(e)) * bend(np.cos(a)), half[1] * bend(np.sin(e)), half[2] * bend(np.cos(e)) * bend(np.sin(a))), -1)
        points[0, :] = (0, half[1], 0)
        points[-1, :] = (0, -half[1], 0)
        # A slanting projection: no seam and no pole, and no side that is stretched to more than 1.7 times.
        uv = np.stack((points[..., 0] + 0.6 * points[..., 2], 0.6 * points[..., 2] - points[..., 1]), -1) / metres
        with self.at(center, turn, tilt):
            self.surface(group, material, points, uv, closed=True)

    def tube(self, group, material, points, radii, metres=0.5, segments=16, steps=4, flat=1.0, caps=True):
        """A smooth tube through points with radii at them (Catmull-Rom), round at its ends; flat < 1: narrower in one way."""
        points, radii = np.array(points, float), np.array(radii, float)
        line = np.concatenate((points, radii[:, None]), 1)
        padded = np.concatenate((2 * line[:1] - line[1:2], line, 2 * line[-1:] - line[-2:-1]))
        rings = []
        for i in range(len(line) - 1):
            a, b, c, d = padded[i:i + 4]
            for t in np.arange(steps) / steps:
                rings.append(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))))
        rings.append(line[-1])
        rings = np.array(rings)
        along = np.gradient(rings[:, :3], axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        if caps:
            bends = np.linspace(0, math.pi / 2, 4)[1:]
            start = [np.append(rings[0, :3] - along[0] * rings[0, 3] * math.sin(b), max(rings[0, 3] * math.cos(b), 0)) for b in bends]
            end = [np.append(rings[-1, :3] + along[-1] * rings[-1, 3] * math.sin(b), max(rings[-1, 3] * math.cos(b), 0)) for b in bends]
            rings = np.concatenate((start[::-1], rings, end))
            along = np.concatenate(([along[0]] * 3, along, [along[-1]] * 3))
        side = np.cross(along[0], (0, 0, 1) if abs(along[0][2]) < 0.9 else (1, 0, 0))
        grid, uv, length = [], [], 0.0
        for i, ring in enumerate(rings):
            side = side - along[i] * (side @ along[i])  # carried along without twist
            side /= np.linalg.norm(side)
            other = np.cross(along[i], side)
            length += np.linalg.norm(ring[:3] - rings[i - 1, :3]) if i else 0.0
            angles = -np.arange(segments + 1) / segments * 2 * math.pi
            radius = ring[3] if ring[3] > 1e-6 else 0.0
            grid.append(ring[:3] + radius * (np.cos(angles)[:, None] * side + flat * np.sin(angles)[:, None] * other))
            around = 2 * math.pi * max(radii.mean(), 1e-3)
            uv.append([(k / segments * around / metres, length / metres) for k in range(segments + 1)])
        self.surface(group, material, grid, uv, closed=True)

    def write(self, file, title, maker):
        file = Path(file)
        header = [f"# {title}, made by {maker}. CC0 1.0: no rights reserved.", f"mtllib {file.stem}.mtl"]
        objects = [line for material, faces in self.faces.items() for line in [f"o {material.replace(' ', '_')}", f"usemtl {material}"] + faces]
        file.with_suffix(".obj").write_text("\n".join(header + self.lines + objects) + "\n")
        text = [f"# Made by {maker}. CC0 1.0."]
        for material, (texture, color, emission) in self.materials.items():
            if self.share and material not in self.faces:
                continue
            text += [f"newmtl {material}", "Kd %g %g %g" % color, "Ke %g %g %g" % emission]
            if texture:
                text.append(f"map_{'Ke' if any(emission) else 'Kd'} {texture}")
        file.with_suffix(".mtl").write_text("\n".join(text) + "\n")


def sphere_profile(radius, rings=24):
    return [(max(radius * math.sin(math.pi * i / rings), 1e-4), radius * math.cos(math.pi * i / rings)) for i in range(rings + 1)]
