"""What all scenes are made of: the materials by name, and the shells of rooms."""
import numpy as np

from mesh import Obj

SHARED = """plaster concrete carpet_tile oak_floor ceiling_tiles asphalt paving brick foil leaf foliage cloth_grey cloth_red curtain tartan
knitted denim hair skin print notices signs screens keyboard windows shops target painting_0 painting_1 painting_2""".split() + [f"panel_{k}" for k in range(6)]
ROOM = "wood_dark wood_light sofa cushion globe parcels books carpet poster_leaves poster_hills poster_dusk poster_type poster_type2 poster_map poster_shards".split()
PLAIN = {"white": (0.75, 0.74, 0.70), "pages": (0.72, 0.66, 0.52), "black": (0.03, 0.03, 0.035), "steel": (0.42, 0.43, 0.45), "brass": (0.55, 0.40, 0.16),
         "clay": (0.52, 0.22, 0.12), "red": (0.55, 0.06, 0.05), "yellow": (0.80, 0.60, 0.08), "blue": (0.07, 0.16, 0.42), "green": (0.10, 0.32, 0.13),
         "grey": (0.28, 0.29, 0.30), "dark": (0.08, 0.085, 0.09)}
# A repeat of the picture in metres.
METRES = {"plaster": 1.28, "concrete": 1.28, "carpet_tile": 1.0, "oak_floor": 2.0, "ceiling_tiles": 2.4, "asphalt": 2.56, "paving": 2.4, "brick": 2.028,
          "foil": 1.0, "wood_light": 1.25, "wood_dark": 1.25}


def new_mesh():
    o = Obj()
    for name in SHARED:
        o.material(name, f"textures/{name}.jpg")
    for name in ROOM:
        o.material(name, f"room/{name}.jpg")
    for name, color in PLAIN.items():
        o.material(name, None, color)
    o.material("lamp", None, (0.85, 0.83, 0.78))  # what shines is the scenario's business: a visible rectangle
    o.material("outdoors", "room/poster_hills.jpg", (0, 0, 0), (1.1, 1.1, 1.1))  # seen through a window
    return o


def wall(o, group, material, corner, right, down, holes=(), metres=None):
    """A wall with rectangular holes side by side: (x0, y0, x1, y1) [m] from its upper left. The picture runs on around them.
    Long walls are cut into pieces: baked light is kept on lattices of equal sides (docs/light.md)."""
    metres = metres or METRES[material]
    corner, right, down = (np.array(v, float) for v in (corner, right, down))
    width, height = np.linalg.norm(right), np.linalg.norm(down)
    ru, du = right / width, down / height

    def piece(x0, y0, x1, y1):
        if x1 - x0 < 1e-6 or y1 - y0 < 1e-6:
            return
        count = max(1, round((x1 - x0) / 4.0))
        for a, b in zip(np.linspace(x0, x1, count + 1), np.linspace(x0, x1, count + 1)[1:]):
            o.quad(group, material, corner + a * ru + y0 * du, (b - a) * ru, (y1 - y0) * du, (a / metres, y0 / metres, b / metres, y1 / metres))

    x = 0.0
    for x0, y0, x1, y1 in sorted(holes):
        piece(x, 0, x0, height)
        piece(x0, 0, x1, y0)
        piece(x0, y1, x1, height)
        x = x1
    piece(x, 0, width, height)


def shell(o, width, height, depth, walls, floor, ceiling, holes=None):
    """A room with the corner of north, west and floor at the origin: x to the east, z to the south. walls: one material, or
    those of north, east, south, west; holes: {side: [...]} for `wall`."""
    W, H, D = width, height, depth
    walls, holes = (walls,) * 4 if isinstance(walls, str) else walls, holes or {}
    sides = {"north": ((0, H, 0), (W, 0, 0)), "east": ((W, H, 0), (0, 0, D)), "south": ((W, H, D), (-W, 0, 0)), "west": ((0, H, D), (0, 0, -D))}
    for (side, (corner, right)), material in zip(sides.items(), walls):
        wall(o, side, material, corner, right, (0, -H, 0), holes.get(side, ()))
    wall(o, "floor", floor, (0, 0, 0), (W, 0, 0), (0, 0, D))
    wall(o, "ceiling", ceiling, (0, H, D), (W, 0, 0), (0, 0, -D))


def long_box(o, group, material, low, high, texture_metres=None, rng=None, piece=1.5):
    """A box that is cut into pieces along x: see `wall`."""
    count = max(1, round((high[0] - low[0]) / piece))
    for a, b in zip(np.linspace(low[0], high[0], count + 1), np.linspace(low[0], high[0], count + 1)[1:]):
        o.box(group, material, (a, low[1], low[2]), (b, high[1], high[2]), texture_metres, rng)


def skirting(o, width, depth, material="white", high=0.08, thick=0.015):
    for z in (0, depth - thick):
        long_box(o, "skirting", material, (0, 0, z), (width, high, z + thick))
    for x in (0, width - thick):
        o.box("skirting", material, (x, 0, thick), (x + thick, high, depth - thick))


def window_frame(o, corner, right, down, out, bars=1, material="white"):
    """Jambs and bars in a hole of a wall; `out` points outdoors, as long as the wall is thick."""
    corner, right, down, out = (np.array(v, float) for v in (corner, right, down, out))
    ru, du = right / np.linalg.norm(right), down / np.linalg.norm(down)
    for start, side in ((corner, right), (corner + down, right), (corner, down), (corner + right, down)):
        o.quad("window reveal", "plaster", start, side, out)
    outer, wide = corner + out * 0.8, 0.05
    for p, r, d in ((outer, right, wide * du), (outer + down - wide * du, right, wide * du), (outer, wide * ru, down), (outer + right - wide * ru, wide * ru, down)):
        o.quad("window frame", material, p, r, d)
    for k in range(bars):
        o.quad("window frame", material, outer + right * (k + 1) / (bars + 1) - 0.02 * ru, 0.04 * ru, down)
