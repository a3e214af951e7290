#!/usr/bin/env python3
"""Medians of a benchmark's JSON as a table, and per family the exponent b of time = a n^b, by least squares on the logarithms.

Usage: filter_benchmark --benchmark_out=out.json --benchmark_out_format=json && exponents.py out.json
"""
import json
import math
import sys
from collections import defaultdict


def slope(points):
    x = [math.log(n) for n, _ in points]
    y = [math.log(t) for _, t in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def main(path):
    families = defaultdict(list)
    for run in json.load(open(path))["benchmarks"]:
        if run.get("aggregate_name") != "median":
            continue
        family, argument = run["run_name"].split("/")[:2]
        families[family].append((int(argument.split(":")[1]), run["cpu_time"]))
    for family, points in families.items():
        points.sort()
        print(f"{family}")
        for n, milliseconds in points:
            print(f"  {n:6d}  {milliseconds:10.3f} ms")
        fitted = [p for p in points if p[0] > 0]
        print(f"  exponent {slope(fitted):.2f}; of the upper half {slope(fitted[len(fitted) // 2 - 1:]):.2f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
