#!/usr/bin/env python3
"""Rank correlation between recordings and their twins over the systems of a campaign (scenes/transfer.yaml).

    python3 transfer.py OUT [METRIC]

A system's error on a sequence is the median over seeds of METRIC (ate_share_of_path); a run without an answer, or with
an error above the lost limit of 10 % of the path, ranks last. Spearman's rho of each pair is over systems; `all` is that
of the systems' mean ranks. Intervals: 90 %, bootstrap over systems (10 000 draws, seed 1).
"""
import csv
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


if __name__ == "__main__":
    main(*sys.argv[1:])
