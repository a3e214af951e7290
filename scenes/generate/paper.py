#!/usr/bin/env python3
"""Makes scenes/paper/*.yaml: the paper's eight sequences, mirrored in our own scenes. Debian: python3-numpy."""
import math
from pathlib import Path

import numpy as np

from hand import held, through
from noise import rng_of
from scenario import section

SCENES = Path(__file__).resolve().parent.parent
DEG, PI = math.pi / 180, math.pi

KINECT = """camera: {width: 640, height: 480, fx: 535.4, fy: 539.2, cx: 320.1, cy: 247.6} # TUM's freiburg3, rectified

sensor: # docs/scenes.md says where these are from
  exposure: 20 ms
  time_samples: 12
  rolling_shutter: 26 ms
  full_well: 6000 e
  read_noise: 12 e
  mosaic: demosaiced
"""
ICL = """camera: {width: 640, height: 480, fx: 481.2, fy: 480, cx: 319.5, cy: 239.5} # ICL-NUIM's

sensor: {exposure: 0 ms, time_samples: 8, full_well: 4000 e, read_noise: 10 e} # no blur; docs/scenes.md
"""
ODOMETRY = """prior: {velocity_sigma: 0.1 m/s, angular_rate_sigma: 0.1 rad/s}

"""


def half_sphere(t):
    """About a point over the desk, 0.54 m from it: there and back, and up and down."""
    azimuth, elevation = 68 * DEG * np.sin(2 * PI * t / 12.6), (32 - 20 * np.cos(2 * PI * t / 17.5)) * DEG
    arm = np.stack((np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth) * np.cos(elevation)), -1)
    return np.array((3.0, 0.86, 2.8)) + 0.54 * arm, np.stack((-azimuth, -elevation + 6 * DEG, 0 * t), -1)


def roll_pitch_yaw(t):
    """On the spot: ten seconds of each, one fading into the next."""
    share = [np.clip(1.2 - np.abs(t - 5 - 10 * k) / 5, 0, 1) for k in range(3)]
    roll, pitch, yaw = (np.sin(2 * PI * t / period) * (s * s * (3 - 2 * s)) for period, s in zip((3.2, 2.8, 3.5), share))
    return np.zeros((len(t), 3)) + (3.0, 1.28, 3.75), np.stack((32 * DEG * yaw, -10 * DEG + 16 * DEG * pitch, 26 * DEG * roll), -1)


def near(t):
    """Along the panels, 0.5 to 1.1 m before them."""
    x = 6.0 - 1.85 * np.cos(PI * np.clip(t / 30, 0, 1))
    return (np.stack((x, 0.76 + 0.1 * np.sin(2 * PI * t / 11), 5.12 + 0.08 * np.sin(2 * PI * t / 8)), -1),
            np.stack((16 * DEG * np.sin(2 * PI * t / 10.5), 5 * DEG * np.sin(2 * PI * t / 8), 2 * DEG * np.sin(2 * PI * t / 7)), -1))


def far(t):
    """Along the panels and back part of the way, in an arc about 2 m before them."""
    x = 6.0 - 1.9 * np.cos(2 * PI * t / 38)
    return (np.stack((x, 0.82 + 0.06 * np.sin(2 * PI * t / 13), 6.35 - 0.25 * ((x - 6) / 1.9) ** 2), -1),
            np.stack((-18 * DEG * (x - 6) / 1.9, (-2 + 3 * np.sin(2 * PI * t / 9)) * DEG, 2 * DEG * np.sin(2 * PI * t / 7)), -1))


def stations(rows):
    """Through rows of (time, x, y, z, yaw, pitch in degrees)."""
    rows = np.array(rows, float)
    place, turn = through(rows[:, 0], rows[:, 1:4]), through(rows[:, 0], np.concatenate((rows[:, 4:6] * DEG, 0 * rows[:, :1]), 1))
    return lambda t: (place(t), turn(t))


# From the books over the television to the bare walls of the north-east, where it stays for a while, and back.
LR_KT0 = [(0, 2.2, 1.35, 3.0, -40, -12), (4, 2.4, 1.3, 2.8, -5, -16), (8, 2.9, 1.32, 2.7, 35, -14), (12, 3.3, 1.38, 2.5, 72, 2), (16, 3.5, 1.42, 2.3, 60, 12),
          (20, 3.45, 1.36, 2.5, 95, -4), (24, 3.1, 1.3, 2.9, 150, -16), (27, 2.8, 1.32, 3.0, 110, -12), (30, 2.5, 1.36, 3.0, 60, -14)]
# Nearly on one place before the window, looking over the sofas.
LR_KT1 = [(0, 3.75, 1.4, 2.0, 150, -18), (5, 3.6, 1.36, 2.15, 190, -22), (10, 3.35, 1.34, 2.2, 235, -20), (15, 3.25, 1.4, 2.0, 275, -12), (20, 3.45, 1.42, 1.8, 235, -20),
          (25, 3.65, 1.38, 1.9, 180, -18), (30, 3.75, 1.4, 2.05, 140, -16)]
# Round the low table.
LR_KT2 = [(0, 1.6, 1.3, 3.2, 60, -18), (4, 1.7, 1.35, 1.9, 100, -22), (8, 2.8, 1.4, 1.5, 165, -24), (12, 4.0, 1.36, 1.9, 215, -22), (16, 4.3, 1.3, 2.9, 262, -16),
          (20, 3.7, 1.34, 3.6, 315, -14), (24, 2.6, 1.38, 3.65, 350, -14), (29.4, 1.7, 1.34, 3.3, 405, -18)]

# name: scenario whose world it has, course, duration [s], mean speeds [cm/s, deg/s], sensor, what it is.
SEQUENCES = {
    "sit_halfsphere": ("desk", half_sphere, 30.0, (18.0, 19.1), KINECT, "On a half sphere of about one metre in diameter before a desk with two figures"),
    "str_tex_near": ("structure_texture", near, 30.0, (14.1, 7.7), KINECT, "Along folded panels with posters, 0.5 to 1.1 m away"),
    "str_tex_far": ("structure_texture", far, 30.0, (19.3, 4.3), KINECT, "Along folded panels with posters, about 2 m away"),
    "str_notex_far": ("structure_notexture", far, 30.0, (16.6, 4.0), KINECT, "Along folded panels of white foil, about 2 m away"),
    "sit_rpy": ("desk", roll_pitch_yaw, 30.0, (4.2, 23.8), KINECT, "Roll, pitch, yaw on the spot before a desk with two figures"),
    "lr_kt0": ("living_room", stations(LR_KT0), 30.0, (12.6, 12.0), ICL, "Through the living room; for some seconds there is little but a bare wall"),
    "lr_kt1": ("living_room", stations(LR_KT1), 30.0, (6.3, 10.0), ICL, "Nearly on one place in the living room"),
    "lr_kt2": ("living_room", stations(LR_KT2), 29.4, (28.2, 12.5), ICL, "Round the table of the living room"),
}


def main():
    folder = SCENES / "paper"
    folder.mkdir(exist_ok=True)
    for name, (world, course, duration, (speed, turn), sensor, what) in SEQUENCES.items():
        shake, sway = (0.0055 if name == "sit_rpy" else 0.004, (0.010, 0.010, 0.008)) if turn > 10 else (0.003, (0.006, 0.006, 0.005))
        keys, places, orientations, factors = held(course, rng_of(name), duration, speed / 100, turn * DEG, shake, sway)
        scenario = (SCENES / f"{world}.yaml").read_text()
        parts = [f"# {what}: mean speeds {speed} cm/s and {turn} deg/s. Made by generate/paper.py.\nname: {name}\nseed: 1\n",
                 section(scenario, "world").replace("file: ", "file: ../"), sensor, section(scenario, "render"),
                 f"time: {{rate: 30 Hz, duration: {duration:g} s}}\n", ODOMETRY, "trajectory:\n  type: scripted\n  keys:"]
        lines = ["    - {time: %.1f s, position: [%.4f, %.4f, %.4f], orientation: [%.5f, %.5f, %.5f, %.5f]}" % (t, *p, *q)
                 for t, p, q in zip(keys, places, orientations)]
        (folder / f"{name}.yaml").write_text("\n".join(parts) + "\n" + "\n".join(lines) + "\n")
        print("%-15s positions x %.3f, angles x %.3f, x %.2f..%.2f y %.2f..%.2f z %.2f..%.2f" %
              (name, *factors, *np.stack((places.min(0), places.max(0)), 1).ravel()))


if __name__ == "__main__":
    main()
