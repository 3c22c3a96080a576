#!/usr/bin/env python3
"""Nearest points of a cubic curve (W7): gimfit beside a k-d tree of samples with Newton's iteration.

The peer is what a user of SciPy writes by hand: `cKDTree` on samples of the curve, 16 to a span, the
nearest one for each query, then Newton's iteration on (C(t) - Q) . C'(t) for all queries at once. It
finds a global minimum where the samples are dense enough. Both sides prepare anew in every run.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import workloads  # noqa: E402


def nearest(curve, queries, steps=6):
    """Distances of the queries from the curve."""
    start, end = curve.t[curve.k], curve.t[-curve.k - 1]
    spans = np.unique(curve.t)
    t = np.unique((spans[:-1, None] + np.diff(spans)[:, None] * np.arange(16) / 16).ravel())
    t = np.append(t, end)
    parameters = t[cKDTree(curve(t)).query(queries, workers=-1)[1]]
    first, second = curve.derivative(1), curve.derivative(2)
    for _ in range(steps):
        gap, slope, bend = curve(parameters) - queries, first(parameters), second(parameters)
        speed = (slope * slope).sum(1)
        curvature = speed + (gap * bend).sum(1)
        curvature = np.where(curvature > 0, curvature, speed)
        parameters = np.clip(parameters - (gap * slope).sum(1) / curvature, start, end)
    return np.sqrt(((curve(parameters) - queries) ** 2).sum(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--queries", type=int, default=10_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--program", required=True, help="gimfit-bench, built with --release")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["BENCH_DATA"] = folder
        workloads.FOLDER = folder
        points = workloads.open_points(1000)
        curve = make_interp_spline(workloads.chord_lengths(points), points, k=3)
        random = np.random.default_rng(7)
        low, high = points.min(0), points.max(0)
        queries = low + (high - low) * (1.2 * random.random((arguments.queries, 3)) - 0.1)
        workloads.save("W7.t", curve.t)
        workloads.save("W7.c", curve.c)
        workloads.save(f"W7_{arguments.queries}.q", queries)
        found = os.path.join(folder, "distances")
        rounds = []
        for _ in range(arguments.rounds):
            line = [arguments.program, "W7", "gimfit.nearest", str(arguments.queries),
                    "--seconds", str(arguments.seconds), "--control-points", found]
            output = subprocess.run(line, check=True, capture_output=True, text=True).stdout
            ours = json.loads(output.split("RESULT ")[1])
            times, processor = [], []
            begin = time.perf_counter()
            while len(times) < 5 or time.perf_counter() - begin < arguments.seconds:
                clock, used = time.perf_counter(), time.process_time()
                theirs = nearest(BSpline(curve.t, curve.c, 3), queries)
                times.append(time.perf_counter() - clock)
                processor.append(time.process_time() - used)
            rounds.append((ours["median"], float(np.median(times)),
                           ours["cpu_median"], float(np.median(processor))))
        gap = np.fromfile(found, dtype="<f8") - theirs
    a, b, c, d = np.array(rounds).T
    print(f"SciPy {scipy.__version__}, {arguments.queries} queries, {arguments.rounds} rounds")
    print(f"wall time:      gimfit {np.median(a):.3g} s, SciPy {np.median(b):.3g} s, "
          f"ratio {np.median(b / a):.3g} ({(b / a).min():.3g} to {(b / a).max():.3g})")
    print(f"processor time: gimfit {np.median(c):.3g} s, SciPy {np.median(d):.3g} s, "
          f"ratio {np.median(d / c):.3g} ({(d / c).min():.3g} to {(d / c).max():.3g})")
    print(f"gimfit is farther by at most {gap.max():.1e}, nearer by at most {-gap.min():.1e}; "
          f"nearer by more than 1e-9 for {(gap < -1e-9).sum()} queries")


if __name__ == "__main__":
    main()
