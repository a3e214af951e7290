#!/usr/bin/env python3
"""Makes scenes/twins/*.yaml; with a folder of recordings the paths that these fly. Standard library alone.

    python3 scenes/generate/twins.py DATA [PATHS]     # by default to scenes/twins/paths

DATA has TUM's layout: DATA/tum_fr1_xyz/groundtruth.txt, ... and DATA/trajectories/tum_freiburg1_desk2.txt, ... A path is cut out of the
recording and moved rigidly (the vertical stays vertical, nothing is scaled): turned by `yaw` about the vertical, its mean position to
`place`. Smoothing is the scenario's: poses within one frame's time count as their mean, with a spline through these (averaging_time).
"""
import bisect
import math
import sys
from pathlib import Path

from scenario import section

SCENES = Path(__file__).resolve().parent.parent
UP = {"z": lambda v: (v[0], v[2], -v[1]), "y": lambda v: v, "-y": lambda v: (v[0], -v[1], -v[2])}  # of the recording's world, to y up
TURN = {"z": (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)), "y": (0.0, 0.0, 0.0, 1.0), "-y": (1.0, 0.0, 0.0, 0.0)}  # the same: x, y, z, w
QUICKEST = 20.0  # s

# The image pipelines are `vobench fit-camera`'s of the recordings: of tum_fr1_xyz, whose frames are not compressed, with its noise; of the
# others what it determines. What a recording does not determine is that of tum_fr1_xyz, or is assumed: docs/scenes.md#twins-of-recordings.
NOISE = "full_well: 13034 e, read_noise: 3.73 e"
PIPELINE = "processing: {%s, denoise_sigma: 0.523 px, denoise_range: 0.1, %s, sharpen_sigma: 1.5 px}"


def kinect(exposure, psf, shutter="26 ms", sharpen="sharpen_bright: 0.641, sharpen_dark: 1.641", white=1.25,
           tone="black_clip: 0.06, contrast: 1.2"):
    return (f"{{color: true, mosaic: demosaiced, exposure: {exposure} ms, time_samples: 12, rolling_shutter: {shutter}, white: {white}, {NOISE},\n"
            f"         response: srgb, optics: {{psf_sigma: {psf} px}},\n         {PIPELINE % (tone, sharpen)}}}")


FREIBURG1 = (30, "{width: 640, height: 480, fx: 517.306408, fy: 516.469215, cx: 318.643040, cy: 255.313989,\n"
             "         distortion: {k1: 0.262383, k2: -0.953104, p1: -0.005358, p2: 0.002628, k3: 1.163314}} # TUM's freiburg1",
             kinect(15.4, 0.805))
FREIBURG3 = (30, "{width: 640, height: 480, fx: 535.4, fy: 539.2, cx: 320.1, cy: 247.6} # TUM's freiburg3, rectified", kinect(20, 0.805))
KITCHEN = (30, "{width: 640, height: 480, fx: 525, fy: 525, cx: 319.5, cy: 239.5}", kinect(14.7, 0.82, white=0.4, tone="black_clip: 0.02"))  # a bright, soft picture
EUROC = (20, "{width: 752, height: 480, fx: 458.654, fy: 457.296, cx: 367.215, cy: 248.375,\n"
         "         distortion: {k1: -0.28340811, k2: 0.07395907, p1: 0.00019359, p2: 1.76187114e-05}} # EuRoC's left camera",
         "{exposure: %s, time_samples: 12, white: %s, full_well: 10000 e, read_noise: 20 e, color: false} # its shutter is global")
HEADSET = (10, "{width: 540, height: 360, fx: 495.567757, fy: 495.4819626, cx: 269.5028972, cy: 169.1941121}",
           kinect(10, 0.96, "20 ms", "sharpen_bright: 1.3, sharpen_dark: 2.1", 1))

# Colours in place of a world's own. Of desk: a white desk before plain grey walls, dark screens, a light pullover, as in tum_fr1_xyz.
MATERIALS = {"desk": {"wood_light": (0.80, 0.79, 0.77), "plaster": (0.50, 0.49, 0.46), "knitted": (0.75,) * 3, "screens": (0.006,) * 3}}


def euroc(exposure, white=1):
    return EUROC[0], EUROC[1], EUROC[2] % (exposure, white)


# name: recording, its up, whether its quaternions map W to C, first second or the quickest, seconds; world, yaw [deg], place; camera.
TWINS = {
    "tum_fr1_xyz": ("tum_fr1_xyz/groundtruth.txt", "z", False, 3.509, 5.3, "desk", 285, (3.3, 1.4, 3.1), FREIBURG1),
    "tum_fr1_rpy": ("tum_fr1_rpy/groundtruth.txt", "z", False, 0.096, 7.3, "desk", 270, (3.0, 1.4, 3.1), FREIBURG1),
    "seven_scenes": ("seven_scenes/groundtruth.txt", "-y", False, 0.0, 13.3, "desk", 0, (3.0, 1.4, 4.0), KITCHEN),
    "euroc_mh05": ("euroc_mh05/groundtruth.txt", "z", False, 0.1, 12.0, "hall", 15, (7.7, 1.9, 5.5), euroc("13.7 ms", 2)),
    "hololens": ("hololens/groundtruth.txt", "y", False, 0.0, 9.9, "office", 105, (3.1, 1.6, 2.9), HEADSET),
    "fr1_desk2": ("trajectories/tum_freiburg1_desk2.txt", "z", False, None, QUICKEST, "desk", 330, (2.8, 1.5, 3.1), FREIBURG1),
    "fr1_room": ("trajectories/tum_freiburg1_room.txt", "z", False, None, QUICKEST, "desk", 0, (3.0, 1.5, 3.4), FREIBURG1),
    "fr3_long_office": ("trajectories/tum_freiburg3_long_office_household.txt", "z", False, None, QUICKEST, "desk", 345, (2.8, 1.6, 3.4),
                        FREIBURG3),
    "fr3_structure_notexture_near": ("trajectories/tum_freiburg3_structure_notexture_near.txt", "z", False, None, QUICKEST,
                                     "structure_notexture", -79, (5.5, 0.8, 5.1), FREIBURG3),
    "fr3_structure_texture_far": ("trajectories/tum_freiburg3_structure_texture_far.txt", "z", False, None, QUICKEST, "structure_texture", -92,
                                  (5.6, 1.05, 6.15), FREIBURG3),
    "fr3_structure_texture_near": ("trajectories/tum_freiburg3_structure_texture_near.txt", "z", False, None, QUICKEST, "structure_texture",
                                   -100, (5.9, 0.9, 5.3), FREIBURG3),
    "euroc_mh03": ("trajectories/euroc_MH03_left_camera.txt", "z", True, None, QUICKEST, "hall", 15, (8.5, 2.2, 6.2), euroc("8 ms")),
    "euroc_v103": ("trajectories/euroc_V103_left_camera.txt", "z", True, None, QUICKEST, "hall", 60, (5.7, 2.0, 3.6), euroc("5 ms")),
    "euroc_v203": ("trajectories/euroc_V203_left_camera.txt", "z", True, None, QUICKEST, "hall", 105, (3.5, 2.0, 9.2), euroc("5 ms")),
}


def times(a, b):
    """Product of quaternions x, y, z, w."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by + ay * bw + az * bx - ax * bz, aw * bz + az * bw + ax * by - ay * bx,
            aw * bw - ax * bx - ay * by - az * bz)


def read(file, inverse):
    """(time, position, quaternion of C to W) of each line."""
    poses = []
    for line in file.read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            t, *v = map(float, line.split())
            poses.append((t, tuple(v[:3]), (-v[3], -v[4], -v[5], v[6]) if inverse else tuple(v[3:])))
    return poses


def quickest(poses, seconds, step=0.1):
    """When the stretch begins in which speed and angular rate, each over its mean, are largest together."""
    stamps = [t for t, _, _ in poses]
    at = [poses[bisect.bisect_left(stamps, stamps[0] + step * k)] for k in range(int((stamps[-1] - stamps[0]) / step))]
    speed = [math.dist(a[1], b[1]) for a, b in zip(at, at[1:])]
    turn = [2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(a[2], b[2]))))) for a, b in zip(at, at[1:])]
    rate = [s / sum(speed) + w / sum(turn) for s, w in zip(speed, turn)]
    count = round(seconds / step)
    best = max(range(len(rate) - count + 1), key=lambda k: sum(rate[k:k + count]))
    return step * best


def path(poses, up, yaw, place):
    """Moved into the scene."""
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    half = math.radians(yaw) / 2
    turn = times((0.0, math.sin(half), 0.0, math.cos(half)), TURN[up])
    about_y = lambda v: (c * v[0] + s * v[2], v[1], -s * v[0] + c * v[2])
    turned = [about_y(UP[up](p)) for _, p, _ in poses]
    shift = [m - sum(p[i] for p in turned) / len(turned) for i, m in enumerate(place)]
    return [(t, [p + d for p, d in zip(position, shift)], times(turn, q)) for (t, _, q), position in zip(poses, turned)]


def write_path(name, data, folder):
    file, up, inverse, start, seconds, _, yaw, place, (rate, _, _) = TWINS[name]
    poses = read(data / file, inverse)
    first = poses[0][0] + (quickest(poses, seconds) if start is None else start)
    cut = [pose for pose in poses if first - 1e-6 <= pose[0] <= first + seconds + 1.5 / rate]
    lines = ["%.9f %.6f %.6f %.6f %.7f %.7f %.7f %.7f" % (t, *p, *q) for t, p, q in path(cut, up, yaw, place)]
    folder.mkdir(exist_ok=True)
    out = folder / f"{name}.txt"
    out.write_text(f"# {file} from {cut[0][0]:.6f} s on, moved into a scene by generate/twins.py\n" + "\n".join(lines) + "\n")
    print(f"{out}: {len(lines)} poses from {cut[0][0] - poses[0][0]:.2f} s of the recording on")


def world_of(name):
    """Its section of scenes/NAME.yaml, with MATERIALS."""
    text = section((SCENES / f"{name}.yaml").read_text(), "world").replace("file: ", "file: ../")
    if name not in MATERIALS:
        return text
    colours = ", ".join(f"{{name: {material}, color: [{', '.join(map(str, rgb))}]}}" for material, rgb in MATERIALS[name].items())
    mesh = f"- {{file: ../{name}.obj}}"
    assert mesh in text, f"scenes/{name}.yaml has no line {mesh}"
    return text.replace(mesh, f"- {{file: ../{name}.obj, materials: [{colours}]}}")


def write_scenario(name):
    file, _, _, start, seconds, world, _, _, (rate, camera, sensor) = TWINS[name]
    scenario = (SCENES / f"{world}.yaml").read_text()
    what = f"the quickest {seconds:g} s" if start is None else f"{seconds:g} s"
    frames = round(seconds * rate) + (start is not None)
    (SCENES / "twins" / f"{name}.yaml").write_text(f"""# {what[0].upper() + what[1:]} of {file}, flown in {world}.yaml: docs/scenes.md#twins-of-recordings. Made by generate/twins.py.
name: {name}
seed: 1

{world_of(world)}
camera: {camera}

sensor: {sensor}

{section(scenario, "render")}
time: {{rate: {rate} Hz, duration: {frames / rate:.9g} s}}

trajectory: {{type: recorded, file: paths/{name}.txt, averaging_time: {1000 / rate:.9g} ms}} # generate/twins.py DATA makes it

truth: [depth]

prior: {{start: origin, velocity_sigma: 0.5 m/s, angular_rate_sigma: 0.5 rad/s}} # as of `vobench track`
""")


def main():
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else SCENES / "twins/paths"
    (SCENES / "twins").mkdir(exist_ok=True)
    for name in TWINS:
        if len(sys.argv) > 1:
            write_path(name, Path(sys.argv[1]), folder)
        else:
            write_scenario(name)


if __name__ == "__main__":
    main()
