#!/usr/bin/env python3
"""Holds the motions `handheld` and `drone` against the recordings that they were fitted to:
  check_motion.py DATA VOBENCH [SEEDS]
For each recording the program flies as long, with the keys that fit_motion.py prints for it, in office.yaml or hall.yaml;
nothing is rendered. Third-octave bands: mean power of 20 seeds against the recording's less its noise floor [dB]. Percentiles:
whether the recorded one lies within the 5 to 95 % range of all seeds (50), and that range's ratio; white noise as the recording's
floor is added to the paths. Debian: python3-numpy, python3-scipy."""
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from fit_motion import keys_of
from motion_spectra import RECORDINGS, acceleration, centres, in_bands, percentiles, read, recordings, steps

SCENES = Path(__file__).resolve().parent.parent
WORLD = {"handheld": "office.yaml", "drone": "hall.yaml"}


def fly(vobench, kind, name, keys, duration, seed, folder):
    file = Path(folder) / f"{seed}.txt"
    motion = "{type: %s, speed: %.4f, turn_rate: %.4f, vehemence: %.3f, tremor: %.3f}" % (kind, *keys)
    mesh = "world.meshes.0.scale=%d" % (2 if "MH" in name else 1)  # their hall is larger than ours
    sets = [mesh, f"trajectory={motion}", f"time.duration={duration:.2f}", f"seed={seed}", "render.light=direct"]
    subprocess.run([vobench, "check", str(SCENES / WORLD[kind]), "--path", str(file)] + [x for s in sets for x in ("--set", s)],
                   check=True, stdout=subprocess.DEVNULL)
    return read(file)


def main(data, vobench, seeds):
    good = bands = inside = narrow = numbers = 0
    for kind, (_, highest) in RECORDINGS.items():
        c, values = centres(highest), keys_of(data, kind)
        for file in recordings(data, kind):
            t, p, q = read(file)
            dt, *recorded = steps(t, p, q)
            spectra = [acceleration(x, dt) for x in recorded]
            levels = np.array([10 * np.log10(in_bands(f, s, c).sum(1)) for f, s, _ in spectra])
            with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
                paths = list(pool.map(lambda seed: fly(vobench, kind, file.name, values[file.name], t[-1], seed, folder), range(1, seeds + 1)))
            power, rows = 0, []
            for seed, path in enumerate(paths):
                _, *flown = steps(*path, dt)
                if seed < 20:
                    power = power + np.array([in_bands(*acceleration(x, dt, False)[:2], c).sum(1) for x in flown]) / min(20, seeds)
                noise = [np.random.default_rng(seed).normal(0, np.sqrt(s[2] / (2 * dt)), (len(x) + 1, 3)) for s, x in zip(spectra, flown)]
                rows.append(percentiles(dt, *(x + np.diff(n, axis=0) for x, n in zip(flown, noise))))
            difference = 10 * np.log10(power) - levels
            wanted, low, high = percentiles(dt, *recorded), *np.percentile(rows, (5, 95), axis=0)
            good, bands = good + (np.abs(difference) < 3).sum(), bands + difference.size
            inside, narrow, numbers = inside + ((wanted > low) & (wanted < high)).sum(), narrow + (high < 2 * low).sum(), numbers + 9
            print(file.name, "speed %.3f turn_rate %.3f vehemence %.2f tremor %.2f, %.0f s" % (*values[file.name], t[-1]))
            for name, row in zip(("linear", "angular"), difference):
                print("  %-8s" % name + " ".join("%5.1f" % x for x in row))
            for name, w, l, h in zip(("speed", "turn", "acc"), wanted, low, high):
                print("  %-8s" % name + "  ".join("%.3f in %.3f..%.3f (%.2f)%s" % (a, b, d, d / b, "" if b < a < d else " OUT") for a, b, d in zip(w, l, h)), flush=True)
    print("bands within 3 dB: %d of %d (%.1f %%); percentiles inside: %d of %d; ranges below a factor of two: %d" %
          (good, bands, 100 * good / bands, inside, numbers, narrow))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 50)
