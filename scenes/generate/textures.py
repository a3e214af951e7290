#!/usr/bin/env python3
"""Makes scenes/textures/: the pictures that the scenes share. Debian: python3-numpy python3-pil fonts-dejavu-core."""
from pathlib import Path

from facades import shops, windows
from noise import save
from stationery import collage, keyboard, notices, pages, picture_of, screens, signs
from surfaces import bricks, fabric, planks
from tiles import asphalt, ceiling_tiles, concrete, creased, denim, foliage, hair, knitted, leaves, mottled, paving, roller_plaster, tartan, tufted

FOLDER = Path(__file__).resolve().parent.parent / "textures"


def main():
    FOLDER.mkdir(exist_ok=True)

    def keep(name, picture, quality=80):
        save(FOLDER / f"{name}.jpg", picture, quality)

    keep("plaster", roller_plaster("plaster", 1024, (222, 219, 212)), 75)
    keep("concrete", concrete("concrete", 1024), 58)
    keep("carpet_tile", tufted("tufted", 1024, (74, 80, 96)), 45)
    keep("oak_floor", planks("oak floor", (2.0, 2.0), (168, 122, 80), 0.00125, 0.125, 0.5, (0.6, 1.2)), 48)
    keep("ceiling_tiles", ceiling_tiles("mineral fibre", 1024, 4), 70)
    keep("asphalt", asphalt("asphalt", 1024), 45)
    keep("paving", paving("paving", 1024, 8, 4, (148, 144, 136)), 58)
    keep("brick", bricks("street brick", (2.028, 2.028), 0.002, shade=False), 58)
    keep("foil", creased("foil", 1024, (222, 222, 220)), 80)
    keep("leaf", leaves("leaf", 256))
    keep("foliage", foliage("foliage", 512), 65)
    keep("cloth_grey", mottled("office cloth", 512, (72, 76, 84), 4, 8, 1.5), 70)
    keep("cloth_red", fabric("red sofa", 640, (128, 52, 46), [(118, 44, 40), (140, 62, 52), (150, 80, 60), (104, 38, 40)]), 70)
    keep("curtain", fabric("curtain", 512, (188, 178, 150), [(176, 164, 136), (150, 160, 140), (200, 192, 170), (120, 132, 120)]), 70)
    keep("tartan", tartan("tartan", 512, [(122, 36, 40), (30, 44, 70), (220, 200, 150), (40, 70, 50)]), 70)
    keep("knitted", knitted("knitted", 512, (70, 98, 92)), 65)
    keep("denim", denim("denim", 512), 60)
    keep("hair", hair("hair", 256, (70, 50, 36)), 70)
    keep("skin", mottled("skin", 256, (198, 150, 124), 5, 3, 2.0), 80)
    keep("print", pages("pages", 504, 713, 4, 2), 38)
    keep("notices", notices("notices", 1200, 4, 2), 58)
    keep("signs", signs("signs", 180, 120, 4, 4), 75)
    keep("screens", screens("screens", 520, 310), 70)
    keep("keyboard", keyboard("keys", 900, 300), 70)
    keep("windows", windows("windows", 240, 360, 6, 3), 55)
    keep("shops", shops("shops", 640, 480, 3, 2), 55)
    for k in range(6):  # 0.9 m x 1.5 m each
        keep(f"panel_{k}", collage(f"panel {k}", 900, 1500, 2, 3), 60)
    keep("target", collage("target", 1900, 1344, 4, 3), 64)
    for k, (w, h, kind) in enumerate(((900, 640, 0), (640, 900, 1), (1000, 680, 3))):
        keep(f"painting_{k}", picture_of(f"painting {k}", w, h, kind), 62)


if __name__ == "__main__":
    main()
