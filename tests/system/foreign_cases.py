#!/usr/bin/env python3
"""Table of a folder of foreign inputs, one case in each subfolder: what the program makes of them, and what is right.

    foreign_cases.py PROGRAM FOLDER [CASE ...]

Each case is copied, run and compared; the exit status is the number of cases that fail. A case without an entry below
is listed as unknown, and counts.
"""

import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

QUADRANTS = {"TL": (200, 40, 40), "TR": (40, 200, 40), "BL": (40, 40, 200), "BR": (200, 200, 40)}


class Wrong(Exception):
    pass


def expect(condition, what):
    if not condition:
        raise Wrong(what)


def read_png(path):
    """Rows of 8-bit RGB tuples, of a PNG file with filters but without interlace, of colour type 0 or 2."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += length + 12
    channels = {0: 1, 2: 3}[colour]
    expect(depth == 8, "picture of %d bits" % depth)
    raw, stride = zlib.decompress(packed), width * channels
    rows, before = [], bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a = line[i - channels] if i >= channels else 0
            b, c = before[i], before[i - channels] if i >= channels else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        rows.append([tuple(line[x * channels:(x + 1) * channels]) * (3 // channels) for x in range(width)])
        before = line
    return rows


class Run:
    """The case's folder, copied, and the program."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def __call__(self, *arguments):
        done = subprocess.run([self.program, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.rc, self.out, self.err = done.returncode, done.stdout, done.stderr
        return self

    def good(self):
        expect(self.rc == 0, "exit %d: %s" % (self.rc, self.err.strip()[:200]))
        return self

    def refused(self, *words, lines=3):
        expect(self.rc == 2, "exit %d, not 2" % self.rc)
        for word in words:
            expect(re.search(word, self.err), "no '%s' in: %s" % (word, self.err.strip()[:200]))
        expect(len(self.err.splitlines()) <= lines, "%d lines of messages" % len(self.err.splitlines()))
        return self

    def render(self, *more, scene="scene.yaml"):
        self("render", scene, "-o", "out", "--frames", "0:1", *more).good()
        folder = os.path.join(self.folder, "out", "rgb")
        self.rows = read_png(os.path.join(folder, sorted(os.listdir(folder))[0]))
        return self

    def pixel(self, column, row, colour, within=6):
        seen = self.rows[row][column]
        expect(all(abs(a - b) <= within for a, b in zip(seen, colour)),
               "pixel (%d, %d) is %s, not %s" % (column, row, seen, colour))
        return self

    def quadrants(self, **colours):
        """The centres of the quadrants of the square of 2 m seen from 2 m, in 64 x 64 pixels."""
        for name, colour in (colours or QUADRANTS).items():
            self.pixel(19 if name[1] == "L" else 43, 19 if name[0] == "T" else 43, colour)
        return self

    def silent(self):
        expect("warning" not in self.err, "warns: " + self.err.strip()[:200])
        return self

    def warns(self, word):
        expect(re.search("warning: .*" + word, self.err), "no warning of " + word + ": " + self.err.strip()[:200])
        return self

    def ate(self, centimetres, *arguments):
        self("evaluate", *arguments).good()
        found = re.search(r"ATE position +rmse +([\d.]+)", self.out)
        expect(found and abs(float(found[1]) - centimetres) <= 2e-4, "ATE " + (found[1] if found else "not printed"))
        return self

    def camera(self, file, *numbers):
        """The calibration that the tracker keeps: fx fy cx cy k1 k2 p1 p2 [k3]."""
        self("track", ".", "-o", "t", "--camera", file).good()
        with open(os.path.join(self.folder, "t", "run.json"), encoding="utf-8") as stream:
            camera = json.loads(json.load(stream)["settings"])["camera"]
        seen = {**camera, **camera["distortion"]}
        for name, value in zip("fx fy cx cy k1 k2 p1 p2 k3".split(), numbers):
            expect(abs(seen[name] - value) < 1e-9, "%s is %s, not %s" % (name, seen[name], value))
        return self

    def poses(self, count):
        self("track", ".", "-o", "t").good()
        with open(os.path.join(self.folder, "t", "estimate.txt"), encoding="utf-8") as stream:
            seen = sum(not line.startswith("#") for line in stream)
        expect(seen == count, "%d poses, not %d" % (seen, count))
        return self

    def matches(self, least):
        with open(os.path.join(self.folder, "t", "frames.csv"), encoding="utf-8") as stream:
            names, *rows = [line.strip().split(",") for line in stream if not line.startswith("#")]
        seen = [float(row[names.index("matched")]) for row in rows][1:]
        expect(min(seen) >= least, "matched %s" % seen)
        return self


def wrap_clamp(run):
    run.render()
    for at, colour in {(37, 13): "TR", (49, 13): "TR", (13, 37): "BL", (13, 49): "BL", (43, 43): "BR"}.items():
        run.pixel(*at, QUADRANTS[colour])


def materials_row(run, scene="scene.yaml"):
    run.render(scene=scene)
    background = (0, 0, 149)
    columns = [50 + 100 * i for i in range(8)]
    for i in (0, 1):
        run.pixel(columns[i] - 42, 18, background)
    expect(run.rows[59][columns[0]] != background and run.rows[59][columns[1]] != background, "no leaf")
    run.pixel(columns[2], 59, (128, 128, 128))
    run.pixel(columns[3], 59, (188, 188, 188))
    run.pixel(columns[4], 59, (92, 92, 92))
    left, right = [[run.rows[33][x] for x in range(a, a + 36)] for a in (504, 549)]
    apart = [abs(p - q) for a, b in zip(left, right) for p, q in zip(a, b)]
    expect(sum(apart) < 15 * len(apart) and max(left) > (240, 100, 100), "ud is not repeated")
    run.pixel(columns[7], 59, (188, 124, 124))
    run.warns(r"dhalf|\bd\b")


def picture_formats(run):
    materials_row(run, "u_tga.yaml")
    for name in ("u_dds.yaml", None):
        if name is None:
            with open(os.path.join(run.folder, "u_tga.mtl"), encoding="utf-8") as stream:
                text = stream.read()
            with open(os.path.join(run.folder, "u_tga.mtl"), "w", encoding="utf-8") as stream:
                stream.write(text.replace("grey.png", "greysgi.rgb"))
            name = "u_tga.yaml"
        run("render", name, "-o", "o2", "--frames", "0:1")
        if run.rc != 0:
            run.refused(r"SGI|DDS|\.rgb", "[Cc]onvert.*PNG", lines=9)


def opencv_yaml10(run):
    for file in ("camera.yaml_", "with_bom.yaml"):
        run.camera(file, 131.25, 130.5, 79.5, 59.5, -0.02, 0.01, 0.001, -0.002, 0.003)


def windows_texture(run):
    run.render().quadrants().warns("tex.png")


def utm(run):
    run("check", "scene.yaml").good()
    run.render().quadrants()


def one_pair(run):
    run("evaluate", "estimate.txt", "--truth", "truth.txt", "--compat", "tum ate")
    expect(run.rc != 0, "tum ate: exit 0")
    run("evaluate", "estimate.txt", "--truth", "truth.txt", "--align", "se3")
    expect(run.rc != 0 or "warning" in run.err + run.out, "0.0000 without a word")


def still_truth(run):
    run("evaluate", "estimate.txt", "--truth", "truth.txt", "--align", "sim3")
    expect(run.rc != 0 or "warning" in run.err + run.out, "0.0000 without a word")
    run("evaluate", "estimate.txt", "--truth", "truth.txt", "--compat", "evo ape -as")
    expect(run.rc != 0, "evo ape -as: exit 0")


def openvins_estimate(run):
    run("evaluate", "estimate.txt", "--truth", "truth.txt", "--compat", "ov se3").good()
    expect(re.search(r"pos_rmse = 0\.0158[78]", run.out), run.out[:100])
    run.ate(1.5877, "estimate.txt", "--truth", "truth.txt", "--align", "se3")


def tum_commas(run):
    run("evaluate", "estimate.txt", "--truth", "truth.txt", "--compat", "tum ate").good()
    expect(abs(float(run.out.split()[-1]) - 0.015877) < 2e-6, run.out[:100])


def exponent_stamp(run):
    path = os.path.join(run.folder, "scene.yaml")
    with open(path, encoding="utf-8") as stream:
        text = stream.read()
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(re.sub(r"\baverage:", "averaging_time:", text))  # the setting's name
    run("check", "scene.yaml").good()
    run.ate(0, "path.txt", "--truth", "path.txt")


def wedge_seam(run):
    run.render().quadrants().pixel(28, 19, QUADRANTS["TL"]).pixel(35, 19, QUADRANTS["TR"])


def unlike_depth(run):
    """The colour pictures tracked, or the list refused."""
    run("track", ".", "-o", "t")
    if run.rc != 0:
        return run.refused("depth|16")
    return run.matches(1)


LENS = (131.25, 130.5, 79.5, 59.5, -0.02, 0.01, 0.001, -0.002)
SPECULAR = {"TL": (200, 0, 0), "TR": (40, 0, 0), "BL": (40, 0, 0), "BR": (200, 0, 0)}

CASES = {
    "assoc_rgb_first": unlike_depth,
    "camera_colmap": lambda r: r.camera("cameras.txt", *LENS),
    "camera_kalibr_none": lambda r: r.camera("camchain.yaml", *LENS[:4], 0, 0, 0, 0),
    "camera_opencv_yaml10": opencv_yaml10,
    "camera_openvins_chain": lambda r: r.camera("kalibr_imucam_chain.yaml", *LENS),
    "camera_orbslam_settings": lambda r: r.camera("TUM.yaml", *LENS),
    "camera_vins_camodocal": lambda r: r.camera("cam0_pinhole.yaml", *LENS),
    "dae_identity_transform_warning": lambda r: r.render().quadrants().silent(),
    "euroc_csv_as_truth_file": lambda r: r.ate(1.5877, "estimate.txt", "--truth", "data.csv", "--align", "se3"),
    "euroc_truth_blank_after_comma": lambda r: r.ate(0, "estimate.txt", "--truth", ".", "--align", "none"),
    "fbx_centimetres": lambda r: r.render().quadrants(),
    "frames_jpeg_padded": lambda r: r.poses(3),
    "frames_rgba": lambda r: r.poses(3).matches(50),
    "frames_size_changes": lambda r: r("track", ".", "-o", "t").refused("rgb/1.png"),
    "gltf_buffer_uri_percent": lambda r: r.render().quadrants(),
    "gltf_mesh_quantization_positions": lambda r: r.render().quadrants(),
    "gltf_specgloss_factor": lambda r: r.render().quadrants(**SPECULAR),
    "gltf_transform_texcoord": lambda r: r.render().quadrants(),
    "gltf_unknown_required_extension": lambda r: r("render", "scene.yaml", "-o", "out").refused("ACME_secret_geometry"),
    "gltf_uv_normalized_bytes": lambda r: r.render().quadrants(),
    "gltf_uv_normalized_shorts": lambda r: r.render().quadrants(),
    "gltf_webp_required": lambda r: r.render().quadrants(),
    "gltf_wrap_clamp": wrap_clamp,
    "metal_open_scene": lambda r: r.render(),
    "missing_texture_message": lambda r: r("check", "scene.yaml").refused(r"gone\.png", "no such file"),
    "obj_byte_order_mark": lambda r: r.render().quadrants(),
    "obj_materials_row": materials_row,
    "obj_mtl_in_subfolder": lambda r: r.render().quadrants(),
    "obj_number_without_zero": lambda r: r.render().quadrants(),
    "obj_texture_scale_option": lambda r: r.render().quadrants(**dict.fromkeys(QUADRANTS, QUADRANTS["BL"])),
    "obj_trailing_blank_map_Kd": lambda r: r.render().quadrants(),
    "obj_utm_coordinates": utm,
    "obj_vertex_colours_no_mtl": lambda r: r.render().quadrants(**dict.fromkeys(QUADRANTS, (128, 128, 128))),
    "obj_windows_absolute_texture": windows_texture,
    "one_pair_is_no_result": one_pair,
    "openvins_estimate_with_covariance": openvins_estimate,
    "picture_formats": picture_formats,
    "ply_wedge_texcoord_seam": wedge_seam,
    "rasteriser_normal_map_silent": lambda r: r.render("--engine", "rasteriser").warns("normal map"),
    "recorded_duplicate_stamp": lambda r: r("check", "scene.yaml").good(),
    "recorded_exponent_stamp": exponent_stamp,
    "still_truth_sim3": still_truth,
    "texture_in_sister_folder": lambda r: r.render().pixel(79, 59, (128, 128, 128)),
    "three_thousand_lines": lambda r: r("track", ".", "-o", "t").refused(r"\d+ more", lines=52),
    "trajectory_with_bom": lambda r: r.ate(1.5877, "estimate.txt", "--truth", "truth.txt", "--align", "se3"),
    "tum_commas": tum_commas,
    "tum_vi_mocap0": lambda r: r.ate(0, "estimate.txt", "--truth", ".", "--align", "none"),
}


def result_of(program, folder, name):
    if name not in CASES:
        return "unknown case"
    with tempfile.TemporaryDirectory() as top:
        copy = os.path.join(top, name)
        shutil.copytree(folder, copy)
        try:
            CASES[name](Run(program, copy))
        except (Wrong, OSError, StopIteration, subprocess.TimeoutExpired) as problem:
            return str(problem).replace(top, "").replace("\n", " ") or "no result"
    return ""


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, top = os.path.abspath(sys.argv[1]), sys.argv[2]
    names = sys.argv[3:] or sorted(n for n in os.listdir(top) if os.path.isdir(os.path.join(top, n)))
    failed = 0
    for name in names:
        problem = result_of(program, os.path.join(top, name), name)
        failed += problem != ""
        print("%-34s %s" % (name, "FAIL: " + problem[:220] if problem else "pass"), flush=True)
    print("%d of %d pass" % (len(names) - failed, len(names)))
    sys.exit(min(failed, 100))


if __name__ == "__main__":
    main()
