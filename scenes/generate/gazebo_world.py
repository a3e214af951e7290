#!/usr/bin/env python3
"""A world as Gazebo's users have them: models in folders with meshes/ and materials/textures, of Debian's
assimp-testmodels and openarena-data and of this project's pictures. Usage: gazebo_world.py FOLDER"""
import pathlib
import shutil
import sys
import zipfile

SCENES = pathlib.Path(__file__).resolve().parents[1]
ASSIMP = pathlib.Path("/usr/share/assimp/models")
ARENA = pathlib.Path("/usr/share/games/openarena/baseoa")

# name: (mesh, pictures, scale, rotation about x, y, z)
FROM_ASSIMP = {
    "duck": ("Collada/duck.dae", ["Collada/duckCM.tga"], 0.6, "1.5708 0 0"),
    "spider": ("OBJ/spider.obj", ["OBJ/*.jpg"], 0.008, "1.5708 0 0"),
    "wuson": ("OBJ/WusonOBJ.obj", [], 0.5, "1.5708 0 0"),
    "wuson_ply": ("PLY/Wuson.ply", [], 0.5, "1.5708 0 0"),
    "fels": ("3DS/fels.3ds", ["3DS/*.jpg", "3DS/*.tga"], 0.01, "0 0 0"),
    "cubes": ("3DS/cube_with_diffuse_texture.3DS", ["3DS/*.jpg", "3DS/*.png"], 0.01, "0 0 0"),
    "teapot": ("Collada/teapot_instancenodes.DAE", [], 0.02, "0 0 0"),
    "cinema": ("Collada/Cinema4D.dae", [], 0.002, "0 0 0"),
}
FROM_ARENA = ["mapobjects/cosmoflash/menhir1", "mapobjects/cosmoflash/menhir2", "mapobjects/cosmoflash/fountain1",
              "mapobjects/gargoyle/gargoyle", "map/forklift"]
PICTURES = ["brick", "oak_floor", "concrete", "plaster", "painting_0", "painting_1", "paving", "panel_0", "notices"]

HEAD = '<?xml version="1.0"?>\n<sdf version="1.6">\n'


def model(folder, name, visual, pictures=(), scripts=()):
    here = folder / "models" / name
    (here / "materials/textures").mkdir(parents=True)
    (here / "meshes").mkdir()
    for picture, data in pictures:
        (here / "materials/textures" / picture).write_bytes(data)
    for script, text in scripts:
        (here / "materials/scripts").mkdir(exist_ok=True)
        (here / "materials/scripts" / script).write_text(text)
    (here / "model.config").write_text(f'<?xml version="1.0"?>\n<model><name>{name}</name><version>1</version>'
                                       f'<sdf version="1.6">model.sdf</sdf></model>\n')
    (here / "model.sdf").write_text(f'{HEAD}<model name="{name}"><static>true</static><link name="link">\n{visual}\n'
                                    '</link></model></sdf>\n')
    return here


def mesh_visual(name, file, scale, turn):
    return (f'<visual name="visual"><pose>0 0 0 {turn}</pose><geometry><mesh><uri>model://{name}/meshes/{file}</uri>'
            f'<scale>{scale} {scale} {scale}</scale></mesh></geometry></visual>')


def from_assimp(folder):
    for name, (mesh, pictures, scale, turn) in FROM_ASSIMP.items():
        source = ASSIMP / mesh
        found = [(p.name, p.read_bytes()) for each in pictures for p in sorted(ASSIMP.glob(each))]
        here = model(folder, name, mesh_visual(name, source.name, scale, turn), found)
        for beside in [source, source.with_suffix(".mtl")]:
            if beside.exists():
                shutil.copy(beside, here / "meshes")
    return list(FROM_ASSIMP)


def from_arena(folder):
    packs = [zipfile.ZipFile(p) for p in sorted(ARENA.glob("*.pk3"))]
    names = []
    for path in FROM_ARENA:
        name = "arena_" + path.split("/")[-1]
        pack = [p for p in packs if f"models/{path}.md3" in p.namelist()][-1]
        data = pack.read(f"models/{path}.md3")
        wanted = {w.split(b"/")[-1].split(b".")[0].decode("latin1").lower()
                  for w in data.split(b"\0") if w.startswith((b"models/", b"textures/"))}
        pictures = {}
        for p in packs:
            for entry in p.namelist():
                leaf = pathlib.PurePath(entry)
                if leaf.stem.lower() in wanted and leaf.suffix in (".tga", ".jpg"):
                    pictures[leaf.name] = p.read(entry)
        here = model(folder, name, mesh_visual(name, "model.md3", 0.025, "1.5708 0 0"), sorted(pictures.items()))
        (here / "meshes/model.md3").write_bytes(data)
        names.append(name)
    return names


def boards(folder):
    """Boxes with a material of a script, and with an albedo map."""
    names = []
    for i, picture in enumerate(PICTURES):
        name = f"board_{picture}"
        if i % 2 == 0:
            material = (f'<script><uri>model://{name}/materials/scripts</uri><uri>model://{name}/materials/textures</uri>'
                        f'<name>Board/{picture}</name></script>')
        else:
            material = (f'<pbr><metal><albedo_map>model://{name}/materials/textures/{picture}.jpg</albedo_map></metal>'
                        '</pbr>')
        script = (f"material Board/{picture}\n{{\n  technique\n  {{\n    pass\n    {{\n      texture_unit\n      {{\n"
                  f"        texture {picture}.jpg // its picture\n      }}\n    }}\n  }}\n}}\n")
        model(folder, name, f'<visual name="board"><pose relative_to="link">0 0 1 0 0 0</pose><geometry><box><size>2 0.2 2'
              f'</size></box></geometry><material>{material}</material></visual>',
              [(f"{picture}.jpg", (SCENES / f"textures/{picture}.jpg").read_bytes())], [("board.material", script)])
        names.append(name)
    return names


def main():
    folder = pathlib.Path(sys.argv[1])
    names = from_assimp(folder) + from_arena(folder) + boards(folder)
    items = []
    for i, name in enumerate(names):
        row, column = divmod(i, 6)
        items.append(f'<include><uri>model://{name}</uri><pose>{2.6 * column} {3 * row} 0 0 0 {0.3 * (i % 5)}</pose></include>')
    (folder / "world.sdf").write_text(f'''{HEAD}<world name="models">
<scene><ambient>0.5 0.5 0.5 1</ambient><background>0.6 0.75 0.9 1</background></scene>
<light type="directional" name="sun"><pose>0 0 10 0 0 0</pose><diffuse>0.8 0.8 0.8 1</diffuse>
<direction>-0.5 0.3 -0.9</direction></light>
<light type="point" name="lamp"><pose>6 4 4 0 0 0</pose><diffuse>0.5 0.5 0.4 1</diffuse><attenuation><range>20</range>
<constant>0.5</constant><linear>0.1</linear><quadratic>0.01</quadratic></attenuation></light>
<model name="ground"><static>true</static><link name="link"><visual name="visual"><geometry><plane><normal>0 0 1</normal>
<size>60 60</size></plane></geometry><material><diffuse>0.5 0.5 0.45 1</diffuse></material></visual></link></model>
<model name="post"><frame name="top"><pose>0 0 1.5 0 0 0</pose></frame><link name="pole"><pose>-2 3 1 0 0 0</pose>
<visual name="pole"><geometry><cylinder><radius>0.1</radius><length>2</length></cylinder></geometry><material><script>
<uri>file://media/materials/scripts/gazebo.material</uri><name>Gazebo/Orange</name></script></material></visual></link>
<model name="head"><pose relative_to="pole">0 0 1.3 0 0 0</pose><link name="link"><visual name="ball"><geometry><sphere>
<radius>0.3</radius></sphere></geometry><material><diffuse>0.8 0.1 0.1 1</diffuse></material></visual></link></model>
</model>
{chr(10).join(items)}
</world></sdf>
''')
    print(f"{folder}/world.sdf: {len(names) + 2} models")


if __name__ == "__main__":
    main()
