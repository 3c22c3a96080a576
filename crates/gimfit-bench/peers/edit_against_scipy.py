#!/usr/bin/env python3
"""Single points of a cubic curve, and of a bicubic surface, edited (W10): gimfit beside refits by gimfit
and by SciPy.

gimfit-bench moves, inserts and removes points of a curve in turns, times each edit, and then times its
own refit of what the edits left. SciPy interpolates the same points, at the same parameters and over the
same averaged knots, by make_interp_spline, in this process; the control points of all are compared. Of a
grid points are moved only, and SciPy interpolates its columns, then its rows.
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
from scipy.interpolate import make_interp_spline

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import workloads  # noqa: E402


def averaged(t, degree=3):
    sums = sum(t[k:len(t) - degree - 1 + k] for k in range(1, degree + 1))
    return np.concatenate([[t[0]] * (degree + 1), sums / degree, [t[-1]] * (degree + 1)])


def refit(name, seconds):
    """Median time of SciPy's fit, and its control points."""
    t = workloads.load(name + ".eu")
    points = workloads.load(name + ".ep", -1, 3)
    knots = averaged(t)
    times, begin = [], time.perf_counter()
    while len(times) < 3 or time.perf_counter() - begin < seconds:
        clock = time.perf_counter()
        spline = make_interp_spline(t, points, k=3, t=knots)
        times.append(time.perf_counter() - clock)
    return float(np.median(times)), spline.c


def refit_grid(size, seconds):
    """The same of a grid."""
    u, v = workloads.load(f"W3_{size}.u"), workloads.load(f"W3_{size}.v")
    points = workloads.load(f"W10-grid_{size}.ep", len(u), len(v), 3)
    times, begin = [], time.perf_counter()
    while len(times) < 3 or time.perf_counter() - begin < seconds:
        clock = time.perf_counter()
        across = make_interp_spline(u, points, k=3, t=averaged(u))
        along = make_interp_spline(v, across.c, k=3, t=averaged(v), axis=1)
        times.append(time.perf_counter() - clock)
    # Its coefficients come with their own axis first.
    return float(np.median(times)), along.c.transpose(1, 0, 2)


def grids(arguments, folder):
    """The table of grids."""
    print("\n| points | move | gimfit refits | SciPy refits | slowest move | most control points touched "
          "| moves | bound | gimfit's refit differs by | SciPy's by | residual |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for size in arguments.grids.split(","):
        workloads.make("W3", int(size))
        found = os.path.join(folder, "control")
        rounds, slowest = [], 0.0
        for _ in range(arguments.rounds):
            line = [arguments.program, "W10-grid", "gimfit.edit", size,
                    "--seconds", str(arguments.seconds), "--control-points", found]
            output = subprocess.run(line, check=True, capture_output=True, text=True).stdout
            ours = json.loads(output.split("RESULT ")[1])
            theirs, control = refit_grid(size, arguments.seconds)
            gap = np.abs(np.fromfile(found, dtype="<f8").reshape(control.shape) - control).max()
            rounds.append([ours["move"]["median"], ours["refit"], theirs])
            slowest = max(slowest, ours["move"]["slowest"])
        middle = [in_unit(x) for x in np.median(np.array(rounds), axis=0)]
        moves, extent = ours["move"], ours["extent"]
        lengths = [ours["bound"], ours["difference"], gap, ours["max_res"]]
        print(f"| {size} x {size} | " + " | ".join(middle)
              + f" | {in_unit(slowest)} | {moves['most_touched']} | {moves['count']} | "
              + " | ".join(f"{length / extent:.1e}" for length in lengths) + " |", flush=True)
        workloads.remove("W3", size)


def in_unit(seconds):
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--sizes", default="1000,10000,100000,1000000")
    parser.add_argument("--grids", default="100,300,1000", help="rows, and columns, of grids")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--program", required=True, help="gimfit-bench, built with --release")
    arguments = parser.parse_args()
    lengths = []
    print("| points | move | insert | remove | gimfit refits | SciPy refits | slowest edit | most control points touched |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["BENCH_DATA"] = folder
        workloads.FOLDER = folder
        for size in arguments.sizes.split(","):
            workloads.make("W10", int(size))
            found = os.path.join(folder, "control")
            rounds, slowest = [], 0.0
            for _ in range(arguments.rounds):
                line = [arguments.program, "W10", "gimfit.edit", size,
                        "--seconds", str(arguments.seconds), "--control-points", found]
                output = subprocess.run(line, check=True, capture_output=True, text=True).stdout
                ours = json.loads(output.split("RESULT ")[1])
                theirs, control = refit(f"W10_{size}", arguments.seconds)
                gap = np.abs(np.fromfile(found, dtype="<f8").reshape(control.shape) - control).max()
                kinds = [ours[kind] for kind in ("move", "insert", "remove")]
                rounds.append([kind["median"] for kind in kinds] + [ours["refit"], theirs])
                slowest = max(slowest, *(kind["slowest"] for kind in kinds))
            middle = [in_unit(x) for x in np.median(np.array(rounds), axis=0)]
            most = max(kind["most_touched"] for kind in kinds)
            print(f"| {size} | " + " | ".join(middle) + f" | {in_unit(slowest)} | {most} |", flush=True)
            extent = ours["extent"]
            lengths.append(f"| {size} | {sum(kind['count'] for kind in kinds)} | {ours['bound'] / extent:.1e} "
                           f"| {ours['difference'] / extent:.1e} | {gap / extent:.1e} "
                           f"| {ours['max_res'] / extent:.1e} | {in_unit(ours['prepare'])} |")
        show(lengths)
        grids(arguments, folder)
    print(f"\nSciPy {scipy.__version__}, NumPy {np.__version__}, {arguments.rounds} rounds")


def show(lengths):
    """The second table of curves."""
    print("\n| points | edits | bound | gimfit's refit differs by | SciPy's by | residual | preparing |")
    print("|---|---|---|---|---|---|---|")
    print("\n".join(lengths), flush=True)


if __name__ == "__main__":
    main()
