#!/usr/bin/env python3
"""Least squares curves (W4): gimfit beside three ways of SciPy, in turns, on one thread.

A cubic curve of N/10 control points through N points of three coordinates at their cumulated chord
lengths, over the same knots for all (The NURBS Book, eq. 9.69). gimfit runs in a process of its own,
SciPy in this one.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"
sys.path.insert(0, HERE)

import numpy as np  # noqa: E402
import scipy  # noqa: E402
from scipy.interpolate import BSpline, make_lsq_spline, splprep  # noqa: E402
from scipy.sparse.linalg import spsolve  # noqa: E402

import workloads  # noqa: E402

# The default of make_lsq_spline takes minutes beyond this.
MOST_QR = 100_000


def peers(count):
    """Names, and functions that give control points."""
    u = workloads.load(f"W4_{count}.u")
    points = workloads.load(f"W4_{count}.p", count, 3)
    t = workloads.load(f"W4_{count}.t")
    columns = [np.ascontiguousarray(points[:, k]) for k in range(3)]

    def sparse():
        a = BSpline.design_matrix(u, t, 3).tocsc()
        return spsolve((a.T @ a).tocsc(), a.T @ points)

    found = {
        "splprep": lambda: np.stack(splprep(columns, u=u, task=-1, t=t, k=3)[0][1], axis=1),
        "sparse normal equations": sparse,
    }
    if count <= MOST_QR:
        found["make_lsq_spline"] = lambda: make_lsq_spline(u, points, t, k=3).c
    return found, (u, points, t)


def timed(function, seconds, clock):
    times, begin = [], time.perf_counter()
    while len(times) < 3 or time.perf_counter() - begin < seconds:
        start = clock()
        result = function()
        times.append(clock() - start)
        if times[-1] > 5 * seconds:
            break
    return float(np.median(times)), result


def in_unit(seconds):
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def rms(curve, case):
    u, points, t = case
    gaps = BSpline(t, curve, 3)(u) - points
    return float(np.sqrt((gaps * gaps).sum() / len(points)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--sizes", default="1000,10000,100000,1000000")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--program", required=True, help="gimfit-bench, built with --release")
    parser.add_argument("--processor-time", action="store_true",
                        help="compare processor time: a quick look on a busy machine")
    arguments = parser.parse_args()
    clock = time.process_time if arguments.processor_time else time.perf_counter
    field = "cpu_median" if arguments.processor_time else "median"
    lines = []
    print("| points | gimfit | splprep | over gimfit | sparse normal equations | over gimfit "
          "| make_lsq_spline | over gimfit |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["BENCH_DATA"] = folder
        workloads.FOLDER = folder
        for size in map(int, arguments.sizes.split(",")):
            workloads.make("W4", size)
            functions, case = peers(size)
            control = os.path.join(folder, "control")
            ours, theirs, curves, once = [], {name: [] for name in functions}, {}, {}
            for _ in range(arguments.rounds):
                line = [arguments.program, "W4", "gimfit.least_squares", str(size),
                        "--seconds", str(arguments.seconds), "--control-points", control]
                output = subprocess.run(line, check=True, capture_output=True, text=True).stdout
                result = json.loads(output.split("RESULT ")[1])
                ours.append(result[field])
                for name, function in functions.items():
                    if once.get(name, 0.0) > 2.0:
                        continue  # As slow as that, one round will do.
                    seconds, curves[name] = timed(function, arguments.seconds, clock)
                    once[name] = seconds
                    theirs[name].append(seconds / ours[-1])
            cells = []
            for name in ("splprep", "sparse normal equations", "make_lsq_spline"):
                if name not in functions:
                    cells += ["", ""]
                    continue
                r = theirs[name]
                cells += [in_unit(once[name]),
                          f"**{np.median(r):.3g}** ({min(r):.3g} to {max(r):.3g})"]
            print(f"| {size} | {in_unit(float(np.median(ours)))} | " + " | ".join(cells) + " |", flush=True)
            own = np.fromfile(control, dtype="<f8").reshape(-1, 3)
            extent = float(np.linalg.norm(case[1].max(0) - case[1].min(0)))
            gap = max(float(np.abs(c - own).max()) for c in curves.values()) / extent
            lines.append(f"| {size} | {result['iterations']} | {rms(own, case):.9e} "
                         f"| {min(rms(c, case) for c in curves.values()):.9e} | {gap:.1e} "
                         f"| {result['work_mb']:.3g} |")
    print("\n| points | iterations | rms: gimfit | the least of SciPy's | control points differ by "
          "| memory |")
    print("|---|---|---|---|---|---|")
    print("\n".join(lines))
    print(f"\nSciPy {scipy.__version__}, NumPy {np.__version__}, {arguments.rounds} rounds")


if __name__ == "__main__":
    main()
