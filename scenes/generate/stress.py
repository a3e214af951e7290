#!/usr/bin/env python3
"""Makes scenes/stress/*.yaml: hand-held paths through the hall in which something happens. Debian: python3-numpy."""
import math
from pathlib import Path

import numpy as np

from hand import STEP, quaternions, rotations, through, tremor
from noise import rng_of
from scenario import section

SCENES = Path(__file__).resolve().parent.parent
DEG = math.pi / 180
FAST = 720 * DEG  # rad/s
DESK = (20.0, 0.0, 4.0)  # where the other room stands: the hall ends at x = 16 m

CAMERA = """camera: {width: 640, height: 480, fx: 525, fy: 525, cx: 319.5, cy: 239.5}

sensor: {exposure: 2 ms, time_samples: 6, full_well: 10000 e, read_noise: 8 e%s}
"""
ODOMETRY = """prior: {start: origin, velocity_sigma: 0.5 m/s, angular_rate_sigma: 0.5 rad/s} # as of `vobench track`
"""


def ramped(t, first, last, ramp=0.05):
    """The integral of a rate that rises from 0 to 1 up to `first`, stays, and falls after `last`, each within `ramp` [s]."""
    s = np.arange(first - ramp, last + ramp + STEP / 8, STEP / 8)
    rate = np.clip(np.minimum(s - first + ramp, last + ramp - s) / ramp, 0, 1)
    return np.interp(t, s, np.concatenate(([0], np.cumsum((rate[1:] + rate[:-1]) / 2))) * STEP / 8)


def stations(rows):
    """Through rows of (time, x, y, z, yaw, pitch in degrees)."""
    rows = np.array(rows, float)
    return through(rows[:, 0], np.concatenate((rows[:, 1:4], rows[:, 4:6] * DEG, 0 * rows[:, :1]), 1))


def walk(end, turned=0.0):
    """Past the racks and back, 0.3 m/s; from 3 s on turned by so much."""
    path = stations([(0, 5.2, 1.5, 6.2, -6, -8), (2, 5.8, 1.45, 6.1, 4, -10), (4, 6.4, 1.5, 6.3, 2, -9), (6, 7.0, 1.45, 6.1, 8, -11), (8, 7.6, 1.5, 6.3, 0, -8)])
    return path if not turned else lambda t: path(t) + np.array((0, 0, 0, turned, 0, 0)) * end(t)[:, None]


# To another part of the hall and back to the first view; in between nothing of it is seen.
TOUR = [(0, 5.4, 1.5, 7.2, 0, -8), (2.5, 5.9, 1.45, 7.0, 3, -10), (5, 6.3, 1.5, 7.2, 0, -9), (8, 6.9, 1.5, 7.6, 85, -10), (12, 8.6, 1.5, 8.4, 120, -12), (16, 9.6, 1.45, 9.0, 170, -10),
        (20, 9.0, 1.5, 9.4, 215, -12), (24, 7.6, 1.5, 9.0, 190, -10), (28, 6.6, 1.45, 8.4, 245, -10), (32, 5.8, 1.5, 7.6, 280, -9), (35, 5.4, 1.5, 7.2, 358, -9), (37.5, 5.9, 1.45, 7.0, 363, -10),
        (40, 6.3, 1.5, 7.2, 360, -9)]
# The first five seconds of it, then before the desk in the other room; from 5 to 6 s the lens is covered, and the camera is carried there.
BEFORE_DESK = [(t, DESK[0] + x, y, DESK[2] + z, yaw, pitch) for t, x, y, z, yaw, pitch in
               ((0, 1.6, 1.4, 3.5, 24, -18), (6, 2.0, 1.4, 3.7, 20, -18), (11, 2.6, 1.35, 3.8, 12, -20), (16, 3.3, 1.4, 3.9, -4, -18), (21, 4.0, 1.35, 3.7, -22, -20),
                (26, 3.6, 1.4, 4.1, -10, -14), (31, 2.8, 1.35, 4.0, 4, -16), (36, 2.2, 1.4, 3.6, 18, -20), (40, 2.6, 1.4, 3.4, 10, -22))]


def carried(t):
    """From the one to the other while the lens is covered."""
    s = np.clip(t - 5.0, 0, 1)
    share = (s ** 3 * (10 - 15 * s + 6 * s * s))[:, None]
    return (1 - share) * stations(TOUR)(t) + share * stations(BEFORE_DESK)(t)


def both_worlds():
    hall, desk = ((SCENES / f"{name}.yaml").read_text() for name in ("hall", "desk"))
    mesh = f"    - {{file: ../hall.obj}}\n    - {{file: ../desk.obj, position: [{DESK[0]:g}, {DESK[1]:g}, {DESK[2]:g}]}}"
    lamps = [line.replace("corner: [2.2, 2.76, ", f"corner: [{2.2 + DESK[0]:g}, 2.76, ") for line in section(desk, "world").splitlines() if "rectangle" in line]
    for z in (1.6, 3.4):
        lamps = [line.replace(f"2.76, {z}]", f"2.76, {z + DESK[2]:g}]") for line in lamps]
    return section(hall, "world").replace("    - {file: hall.obj}", mesh).replace("  background", "\n".join(lamps) + "\n  background")


# name: course, seconds, when keys are closer than 0.2 s and how close [s], keys of the sensor besides, what happens.
PATHS = {
    "walk": (walk(None), 8.0, None, "", "Past the racks of the hall, 0.3 m/s: nothing happens"),
    "whip": (walk(lambda t: ramped(t, 3.0, 3.1, 0.025) - ramped(t, 3.15, 3.25, 0.025), FAST), 8.0, (2.6, 3.7, 0.02), "", "Turned away by 90 deg and back at 720 deg/s at 3 s"),
    "half_turn": (walk(lambda t: ramped(t, 3.0, 3.2), FAST), 8.0, (2.6, 3.7, 0.02), "", "Turned round by 180 deg at 720 deg/s at 3 s, for 0.2 s and two ramps of 0.05 s"),
    "half_turn_slowly": (walk(lambda t: ramped(t, 2.5, 4.3, 0.2), FAST / 8), 8.0, (2.0, 5.0, 0.1), "", "Turned round by 180 deg at 90 deg/s from 2.5 s on"),
    "return": (stations(TOUR), 40.0, None, "", "Five seconds of one view, thirty elsewhere in the hall, and the first view again"),
    "another_room": (carried, 40.0, (4.5, 6.5, 0.05), ", covered: [{from: 5 s, until: 6 s}]", "Five seconds of the hall, a second covered, and then in another room"),
}


def main():
    folder = SCENES / "stress"
    folder.mkdir(exist_ok=True)
    for name, (course, duration, close, sensor, what) in PATHS.items():
        rng = rng_of("walk" if "turn" in name or name == "whip" else name)
        wobble, swing = tremor(rng, 0.004), tremor(rng, (0.010, 0.010, 0.008))
        keys = np.arange(0, duration + 0.1, 0.2)
        if close:
            keys = np.unique(np.concatenate((keys, np.arange(close[0], close[1] + close[2] / 2, close[2]))).round(3))
        six = course(keys)
        places, orientations = six[:, :3] + wobble(keys), quaternions(rotations(six[:, 3:] + swing(keys)))
        hall = (SCENES / "hall.yaml").read_text()
        world = both_worlds() if name == "another_room" else section(hall, "world").replace("file: ", "file: ../")
        parts = [f"# {what}. Made by generate/stress.py.\nname: {name}\nseed: 1\n", world, CAMERA % sensor, section(hall, "render"),
                 f"time: {{rate: 30 Hz, duration: {duration:g} s}}\n", ODOMETRY, "trajectory:\n  type: scripted\n  keys:"]
        lines = ["    - {time: %.2f s, position: [%.4f, %.4f, %.4f], orientation: [%.5f, %.5f, %.5f, %.5f]}" % (t, *p, *q)
                 for t, p, q in zip(keys, places, orientations)]
        (folder / f"{name}.yaml").write_text("\n".join(parts) + "\n" + "\n".join(lines) + "\n")
        rate = (np.linalg.norm(np.diff(six[:, 3:], axis=0), axis=1) / np.diff(keys)).max() / DEG
        print("%-17s at most %.0f deg/s between keys, x %.1f..%.1f z %.1f..%.1f" % (name, rate, *np.stack((places.min(0), places.max(0)), 1)[[0, 2]].ravel()))


if __name__ == "__main__":
    main()
