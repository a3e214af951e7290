#!/usr/bin/env python3
"""Rank correlation between recordings and their twins over the systems of a campaign (scenes/transfer.yaml).

    python3 transfer.py OUT [METRIC]
    PYTHONPATH=build/release/tools/python python3 transfer.py OUT --frames DATA

A system's error on a sequence is the median over seeds of METRIC (ate_share_of_path); a run without an answer, or with
an error above the lost limit of 10 % of the path, ranks last. Spearman's rho of each pair is over systems; `all` is that
of the systems' mean ranks. Intervals: 90 %, bootstrap over systems (10 000 draws, seed 1).

--frames: whether a twin is hard where its recording is. DATA has the recordings. A system's difficulty of a frame is
the error of its displacement over the next 0.2 s, live and after Sim(3) alignment of the run, over its median over the
frames; that of all is the median over the systems that are lost on neither side. Spearman's rho is over frames; its
interval, 90 %, a bootstrap over blocks of 1 s (2 000 draws, seed 1); `tenth`: share of the hardest tenth of the
recording's frames that is among the twin's (0.1 by chance); `halves`: rho of two halves of the systems on the
recording, which bounds what a twin can reach.
"""
import argparse
import csv
import json
from collections import defaultdict
from pathlib import Path

import numpy as np
from scipy.stats import rankdata, spearmanr

LOST = 0.1


def is_repeated(system):
    return system.endswith("(images alone)")  # of campaigns with external systems: the same settings


def errors_of(results, metric):
    runs = defaultdict(list)
    for row in csv.DictReader(results.open()):
        if is_repeated(row["system"]):
            continue
        value = float(row[metric]) if row["status"] == "ok" and row[metric] else np.inf
        runs[row["scenario"], row["system"]].append(value if value < LOST else np.inf)
    return {key: np.median(values) for key, values in runs.items()}


def spearman(x, y):
    return spearmanr(x, y).statistic if np.ptp(x) > 0 and np.ptp(y) > 0 else np.nan


def ranks(out, metric):
    errors = errors_of(Path(out) / "results.csv", metric)
    systems = sorted({system for _, system in errors})
    names = sorted(name[len("twin of "):] for name in {s for s, _ in errors} if name.startswith("twin of "))
    rank = lambda sequence: rankdata([errors[sequence, system] for system in systems])
    recorded = np.array([rank(name) for name in names])
    twins = np.array([rank("twin of " + name) for name in names])

    draws = np.random.default_rng(1).integers(len(systems), size=(10_000, len(systems)))

    def row(label, x, y):
        sample = [spearman(x[d], y[d]) for d in draws]
        low, high = np.nanquantile(sample, [0.05, 0.95])
        print(f"{label:20} {spearman(x, y):6.2f}   {low:5.2f} ... {high:4.2f}")

    print(f"Spearman's rho of {metric}, {len(systems)} systems and settings; 90 % intervals")
    for i, name in enumerate(names):
        row(name, recorded[i], twins[i])
    row("all: mean ranks", recorded.mean(0), twins.mean(0))
    print(f"\n{'error in % of the path':28}" + "".join(f"{name[:14]:>24}" for name in names))
    for system in systems:
        cells = [f"{100 * errors[name, system]:.2f} : {100 * errors['twin of ' + name, system]:.2f}" for name in names]
        print(f"{system:28}" + "".join(f"{cell.replace('inf', 'lost'):>24}" for cell in cells))


def answers_of(out):
    """Live answers of the first seed, by sequence and system; not of runs that are lost."""
    answers = defaultdict(dict)
    for file in sorted(Path(out).glob("tasks/*/*/task.json")):
        task = json.loads(file.read_text())
        if task["status"] != "ok" or not task["metrics"]["ate_share_of_path"] < LOST or is_repeated(task["system"]):
            continue
        live = file.with_name("live.txt")
        answers[task["scenario"]].setdefault(task["system"], live if live.exists() else file.with_name("estimate.txt"))
    return answers


def interpolated(times, stamps_ns, values):
    return np.stack([np.interp(times, 1e-9 * stamps_ns, x) for x in values.T], 1)


def difficulty(estimate, truth, times):
    """Errors of the displacements over the 0.2 s from the times on [s], over their median; positions after Sim(3)."""
    aligned = vobench.ate(estimate, truth)
    stamps = estimate.stamps_ns
    true = interpolated(1e-9 * stamps, truth.stamps_ns, truth.positions)
    error = aligned.scale * estimate.positions @ aligned.R.T + aligned.t - true
    moved = interpolated(times + 0.2, stamps, error) - interpolated(times, stamps, error)
    length = np.linalg.norm(moved, axis=1)
    return length / np.median(length)


def difficulties(recorded, twin, truth):
    """Both of a system; the twin begins with the recording's first frame."""
    shift = recorded.stamps_ns[0] - twin.stamps_ns[0]
    twin = vobench.Trajectory(twin.stamps_ns + shift, twin.positions, twin.orientations)
    end = 1e-9 * min(recorded.stamps_ns[-1], twin.stamps_ns[-1]) - 0.2
    times = np.arange(1e-9 * recorded.stamps_ns[0] + 0.3, end, 1e-9 * np.median(np.diff(recorded.stamps_ns)))
    return [difficulty(path, truth, times) for path in (recorded, twin)], times


def frames(out, data):
    answers = answers_of(out)
    read = vobench.Trajectory.read
    print(f"{'':14} systems frames   rho   interval        tenth  halves")
    for name in sorted(name for name in answers if "twin of " + name in answers):
        recorded, twins, truth = answers[name], answers["twin of " + name], read(Path(data) / name / "groundtruth.txt")
        systems = sorted(recorded.keys() & twins.keys())
        pairs, times = zip(*(difficulties(read(recorded[s]), read(twins[s]), truth) for s in systems))
        count = min(map(len, times))
        curves = np.array([[curve[:count] for curve in pair] for pair in pairs])
        of_recording, of_twin = np.median(curves, 0)
        draw, block = np.random.default_rng(1), round(1 / (times[0][1] - times[0][0]))
        starts = draw.integers(count - block + 1, size=(2000, -(-count // block)))
        blocks = (starts[:, :, None] + np.arange(block)).reshape(2000, -1)[:, :count]
        low, high = np.quantile([spearman(of_recording[b], of_twin[b]) for b in blocks], [0.05, 0.95])
        hardest = [c >= np.quantile(c, 0.9) for c in (of_recording, of_twin)]
        mixed = [draw.permutation(curves[:, 0]) for _ in range(200)]
        halves = np.mean([spearman(np.median(m[::2], 0), np.median(m[1::2], 0)) for m in mixed])
        print(f"{name:14} {len(systems):7} {count:6} {spearman(of_recording, of_twin):6.2f}  ({low:5.2f} ... {high:5.2f})"
              f"  {(hardest[0] & hardest[1]).sum() / hardest[0].sum():6.2f} {halves:7.2f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", help="folder of the campaign")
    parser.add_argument("metric", nargs="?", default="ate_share_of_path")
    parser.add_argument("--frames", metavar="DATA", help="folder of the recordings")
    options = parser.parse_args()
    if options.frames:
        import vobench

        frames(options.out, options.frames)
    else:
        ranks(options.out, options.metric)
