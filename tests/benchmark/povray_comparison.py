#!/usr/bin/env python3
"""The same room, view and number of rays by POV-Ray (Debian's `povray`) and by `vobench render`: CPU seconds per frame.

Usage: tests/benchmark/povray_comparison.py VOBENCH [--scene scenes/room.yaml] [--frame 40] [--keep FOLDER]

POV-Ray is given the scene's OBJ file as meshes with their textures, the scene's point lamps and, for its rectangular ones, a point
lamp in the middle (one shadow ray per lamp in both programs), and the frame's camera from groundtruth.txt. It says itself how
long it parsed and traced; of vobench the whole of more frames less the whole of one is counted, writing the files included, so
that its start is not, as POV-Ray's is not. Both write PNG files. Several rounds, medians. The pictures are kept for the eye.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

WIDTH, HEIGHT = 640, 480


def read_obj(path):
    """Positions, texture coordinates, normals, and triangles of (v, vt, vn) by material."""
    positions, uvs, normals, triangles, material = [], [], [], {}, ""
    for line in open(path):
        words = line.split()
        if not words:
            continue
        if words[0] in ("v", "vt", "vn"):
            {"v": positions, "vt": uvs, "vn": normals}[words[0]].append(tuple(map(float, words[1:])))
        elif words[0] == "usemtl":
            material = words[1]
        elif words[0] == "f":
            corners = [tuple(int(n) - 1 for n in word.split("/")) for word in words[1:]]
            for i in range(1, len(corners) - 1):
                triangles.setdefault(material, []).append((corners[0], corners[i], corners[i + 1]))
    return positions, uvs, normals, triangles


def read_mtl(path):
    materials, name = {}, ""
    for line in open(path):
        words = line.split()
        if words and words[0] == "newmtl":
            name = words[1]
            materials[name] = {"Kd": (1, 1, 1), "Ke": (0, 0, 0), "map_Kd": None}
        elif words and words[0] in ("Kd", "Ke"):
            materials[name][words[0]] = tuple(map(float, words[1:4]))
        elif words and words[0] == "map_Kd":
            materials[name]["map_Kd"] = words[1]
    return materials


def vector(v):
    return "<" + ", ".join(f"{x:.7g}" for x in v) + ">"


def pov_mesh(positions, uvs, normals, triangles, material, folder):
    """One mesh2; every corner is a vertex of its own, so that one index serves all three lists."""
    corners = [corner for triangle in triangles for corner in triangle]
    out = ["mesh2 {"]
    for name, index, values in (("vertex_vectors", 0, positions), ("normal_vectors", 2, normals), ("uv_vectors", 1, uvs)):
        out.append(f"{name} {{ {len(corners)}, " + ", ".join(vector(values[c[index]][:3 if index != 1 else 2]) for c in corners) + " }")
    out.append(f"face_indices {{ {len(triangles)}, " + ", ".join(f"<{3 * i}, {3 * i + 1}, {3 * i + 2}>" for i in range(len(triangles))) + " }")
    pigment = f"color rgb {vector(material['Kd'])}"
    if material["map_Kd"]:
        kind = pathlib.Path(material["map_Kd"]).suffix[1:].replace("jpg", "jpeg")
        pigment = f'uv_mapping image_map {{ {kind} "{folder / material["map_Kd"]}" interpolate 2 }}'
    out.append(f"texture {{ {'uv_mapping ' if material['map_Kd'] else ''}pigment {{ {pigment.replace('uv_mapping ', '')} }} "
               f"finish {{ ambient 1 diffuse 1 emission rgb {vector(material['Ke'])} }} }} }}")
    return "\n".join(out)


def axes(q):
    """Columns of R(q), q = x y z w: the camera's axes in the world."""
    x, y, z, w = q
    return ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))


def pov_scene(scenario, folder, pose):
    world, camera = scenario["world"], scenario["camera"]
    ambient = [sum(light["radiance"][c] for light in world["lights"] if light["type"] == "ambient") for c in range(3)]
    x, y, z = axes(pose[3:])
    scale = lambda v, s: tuple(s * n for n in v)
    out = ['#version 3.7;', f"global_settings {{ assumed_gamma 1.0 ambient_light rgb {vector(ambient)} }}",
           f"camera {{ perspective location {vector(pose[:3])} right {vector(scale(x, WIDTH / camera['fx']))} "
           f"up {vector(scale(y, -HEIGHT / camera['fy']))} direction {vector(z)} }}"]
    for light in world["lights"]:
        if light["type"] == "point":
            at, power = light["position"], light["intensity"]
        elif light["type"] == "rectangle":
            u, v = light["side_u"], light["side_v"]
            at = [light["corner"][c] + 0.5 * (u[c] + v[c]) for c in range(3)]
            area = sum((u[a] * v[b] - u[b] * v[a]) ** 2 for a, b in ((1, 2), (2, 0), (0, 1))) ** 0.5
            power = [area * r for r in light["radiance"]]
        else:
            continue
        # POV-Ray's diffuse light is colour * cos * 2 / (1 + (d / fade)^2): with a tiny fade distance, cos / d^2.
        fade = 0.01
        out.append(f"light_source {{ {vector(at)} rgb {vector([p / 3.14159265 / fade ** 2 / 2 for p in power])} fade_distance {fade} fade_power 2 }}")
    for mesh in world["meshes"]:
        obj = folder / mesh["file"]
        positions, uvs, normals, triangles = read_obj(obj)
        materials = read_mtl(obj.with_suffix(".mtl"))
        for name, faces in triangles.items():
            out.append(pov_mesh(positions, uvs, normals, faces, materials[name], obj.parent))
    return "\n".join(out) + "\n"


def cpu_of(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def povray(scene, picture, rays_a_side):
    command = ["povray", f"+I{scene}", f"+O{picture}", f"+W{WIDTH}", f"+H{HEIGHT}", "-D", "+FN"]
    command += [f"+A0.0", "+AM1", f"+R{rays_a_side}", "-J"] if rays_a_side > 1 else ["-A"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    seconds = {}
    for name in ("Parse", "Trace"):
        match = re.search(rf"{name} Time:.*?\n?.*?using \d+ thread\(s\) with ([\d.]+) CPU-seconds", text)
        if not match:
            sys.exit(f"POV-Ray did not say how long its {name.lower()} took:\n{text[-2000:]}")
        seconds[name] = float(match.group(1))
    return seconds["Parse"], seconds["Trace"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vobench")
    parser.add_argument("--scene", default="scenes/room.yaml")
    parser.add_argument("--frame", type=int, default=40)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--keep", help="folder for the pictures")
    options = parser.parse_args()
    if not shutil.which("povray"):
        sys.exit("povray is not installed (Debian: apt-get install povray)")
    more = 40
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(options.keep or name)
        work.mkdir(parents=True, exist_ok=True)

        def render(frames, samples, tag):
            out = work / tag
            shutil.rmtree(out, ignore_errors=True)
            return cpu_of([options.vobench, "render", options.scene, "-o", str(out), "--frames",
                           f"{options.frame}:{options.frame + frames}", "--set", f"sensor.time_samples={samples}"])

        render(1, 1, "one")
        scenario = json.load(open(work / "one" / "manifest.json"))["scenario"]
        pose = [float(n) for n in open(work / "one" / "groundtruth.txt").read().splitlines()[1].split()[1:]]
        scene = work / "scene.pov"
        scene.write_text(pov_scene(scenario, pathlib.Path(options.scene).resolve().parent, pose))
        print("CPU seconds per frame, medians of", options.rounds)
        print("rays a pixel   vobench   POV-Ray   + parsing   ratio   with parsing")
        for side in (1, 4):
            ours, traced, parsed = [], [], []
            for _ in range(options.rounds):
                single = render(1, side * side, "single")
                ours.append((render(1 + more, side * side, "more") - single) / more)
                parse, trace = povray(scene, work / f"povray_{side * side}.png", side)
                traced.append(trace)
                parsed.append(parse)
            a, b, c = map(statistics.median, (ours, traced, parsed))
            print(f"{side * side:12d}   {a:7.4f}   {b:7.3f}   {c:9.3f}   {b / a:5.0f}   {(b + c) / a:12.0f}")


if __name__ == "__main__":
    main()
