#!/usr/bin/env python3
"""Rank correlation between recordings and their twins over the systems of a campaign (scenes/transfer.yaml).

    python3 transfer.py OUT [METRIC]
    python3 transfer.py OUT --frames DATA

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
import csv
import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from scipy.stats import rankdata, spearmanr

LOST = 0.1


def errors_of(results, metric):
    runs = defaultdict(list)
    for row in csv.DictReader(results.open()):
        if row["system"].endswith("(images alone)"):
            continue  # of campaigns with external systems: the same settings
        value = float(row[metric]) if row["status"] == "ok" and row[metric] else np.inf
        runs[row["scenario"], row["system"]].append(value if value < LOST else np.inf)
    return {key: np.median(values) for key, values in runs.items()}


def spearman(x, y):
    return spearmanr(x, y).statistic if np.ptp(x) > 0 and np.ptp(y) > 0 else np.nan


def main(out, metric="ate_share_of_path"):
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


def displacement_errors(estimate, truth, begin, times):
    """Errors over the 0.2 s from begin + times on, of positions aligned by Sim(3) (Umeyama)."""
    at = lambda t, path: np.stack([np.interp(t, path[:, 0], path[:, k]) for k in (1, 2, 3)], 1)
    x, y = estimate[:, 1:4], at(estimate[:, 0], truth)
    X, Y = x - x.mean(0), y - y.mean(0)
    U, D, Vt = np.linalg.svd(Y.T @ X)
    mirror = np.array([1, 1, np.sign(np.linalg.det(U @ Vt))])
    error = np.column_stack([estimate[:, 0], (D @ mirror) / (X**2).sum() * X @ (U * mirror @ Vt).T - Y])
    return np.linalg.norm(at(begin + times + 0.2, error) - at(begin + times, error), axis=1)


def frames(out, data):
    runs = defaultdict(dict)  # of the first seed: path of the answers
    for file in sorted(Path(out).glob("tasks/*/*/task.json")):
        task = json.loads(file.read_text())
        live = file.with_name("live.txt")
        lost = task["status"] != "ok" or not task["metrics"]["ate_share_of_path"] < LOST
        if not lost and not task["system"].endswith("(images alone)"):
            answers = live if live.exists() else file.with_name("estimate.txt")
            runs[task["scenario"]].setdefault(task["system"], answers)
    print(f"{'':14} systems frames   rho   interval        tenth  halves")
    for name in sorted(name for name in runs if "twin of " + name in runs):
        twins = runs["twin of " + name]
        truth = np.loadtxt(Path(data) / name / "groundtruth.txt", usecols=range(4))
        curves = []
        for system in sorted(runs[name].keys() & twins.keys()):
            pair = [np.loadtxt(path, usecols=range(4)) for path in (runs[name][system], twins[system])]
            pair[1][:, 0] += pair[0][0, 0] - pair[1][0, 0]  # both begin with the recording's first frame
            step = np.median(np.diff(pair[0][:, 0]))
            times = np.arange(0.3, min(np.ptp(p[:, 0]) for p in pair) - 0.2, step)
            errors = [displacement_errors(p, truth, pair[0][0, 0], times) for p in pair]
            curves.append([e / np.median(e) for e in errors])
        count = min(len(c[0]) for c in curves)
        curves = np.array([[c[0][:count], c[1][:count]] for c in curves])
        recorded, twin = np.median(curves, 0)
        draw, block = np.random.default_rng(1), round(1 / step)
        starts = draw.integers(count - block + 1, size=(2000, -(-count // block)))
        blocks = (starts[:, :, None] + np.arange(block)).reshape(2000, -1)[:, :count]
        low, high = np.quantile([spearman(recorded[b], twin[b]) for b in blocks], [0.05, 0.95])
        hardest = [c >= np.quantile(c, 0.9) for c in (recorded, twin)]
        mixed = [draw.permutation(curves[:, 0]) for _ in range(200)]
        halves = np.mean([spearman(np.median(m[::2], 0), np.median(m[1::2], 0)) for m in mixed])
        print(f"{name:14} {len(curves):7} {count:6} {spearman(recorded, twin):6.2f}  ({low:5.2f} ... {high:5.2f})"
              f"  {(hardest[0] & hardest[1]).sum() / hardest[0].sum():6.2f} {halves:7.2f}")


if __name__ == "__main__":
    frames(sys.argv[1], sys.argv[3]) if "--frames" in sys.argv else main(*sys.argv[1:])
