"""The Python side, in a process of its own: SciPy, and a plain copy of memory.

usage: python_peers.py <workload> scipy|fitpack|copy <size> [--seconds S] [--control-points FILE]
"""
import argparse
import json
import statistics
import time

import numpy as np
import workloads


def memory(field):
    """VmRSS (now) or VmHWM (the peak) of this process, in MiB."""
    with open("/proc/self/status") as status:
        for line in status:
            if line.startswith(field + ":"):
                return int(line.split()[1]) / 1024.0
    return None


def grid_case(count):
    """The rows by make_interp_spline, then the columns of the coefficients."""
    from scipy.interpolate import make_interp_spline
    u, v, s, t = (workloads.load(f"W3_{count}.{kind}") for kind in "uvst")
    points = workloads.load(f"W3_{count}.p", count, count, 3)

    def solve():
        across = make_interp_spline(u, points, k=3, t=s).c
        return make_interp_spline(v, np.moveaxis(across, 1, 0), k=3, t=t).c

    return solve, lambda control: np.moveaxis(control, 0, 1)


def fitpack_case(_, count):
    """One RectBivariateSpline for each coordinate."""
    from scipy.interpolate import RectBivariateSpline
    u, v = (workloads.load(f"W3_{count}.{kind}") for kind in "uv")
    points = workloads.load(f"W3_{count}.p", count, count, 3)

    def solve():
        return [RectBivariateSpline(u, v, points[:, :, k], kx=3, ky=3, s=0) for k in range(3)]

    return solve, lambda splines: np.stack(
        [spline.get_coeffs().reshape(count, count) for spline in splines], axis=2)


def scipy_case(workload, count):
    """What is timed, and how to find the control points in what it returns."""
    if workload == "W3":
        return grid_case(count)
    from scipy.interpolate import make_interp_spline
    points = workloads.load(f"{workload}_{count}.p", count, 3)
    u = workloads.load(f"{workload}_{count}.u")
    if workload == "W1":
        knots = workloads.load(f"W1_{count}.t")
        return lambda: make_interp_spline(u, points, k=3, t=knots), lambda spline: spline.c
    closed = np.vstack([points, points[:1]])
    return lambda: make_interp_spline(u, closed, k=3, bc_type="periodic"), lambda spline: spline.c


def copy_case(workload, count):
    """Parameters and points in, control points out: 56 bytes a point, half of them read; of a grid
    points and control points, 48 bytes a point."""
    source = np.ones(count * count * 24 if workload == "W3" else count * 28, dtype=np.uint8)
    target = np.zeros_like(source)
    return lambda: np.copyto(target, source), None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("workload")
    parser.add_argument("peer", choices=["scipy", "fitpack", "copy"])
    parser.add_argument("size", type=int)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--control-points", default=None)
    a = parser.parse_args()
    cases = {"scipy": scipy_case, "fitpack": fitpack_case, "copy": copy_case}
    solve, control_points = cases[a.peer](a.workload, a.size)

    before = memory("VmRSS")
    start = time.perf_counter()
    result = solve()
    first = time.perf_counter() - start
    peak = memory("VmHWM")
    if a.control_points:
        np.ascontiguousarray(control_points(result), dtype="<f8").tofile(a.control_points)

    wall, processor, begun = [], [], time.perf_counter()
    while len(wall) < 10_000 and (len(wall) < 5 or time.perf_counter() - begun < a.seconds):
        result = None
        c, t = time.process_time(), time.perf_counter()
        result = solve()
        wall.append(time.perf_counter() - t)
        processor.append(time.process_time() - c)
    print("RESULT " + json.dumps({
        "workload": a.workload, "peer": a.peer, "size": str(a.size),
        "median": statistics.median(wall), "min": min(wall), "reps": len(wall),
        "cpu_median": statistics.median(processor), "cpu_per_wall": sum(processor) / sum(wall),
        "first_call": first, "rss_mb": peak, "work_mb": peak - before,
    }))


if __name__ == "__main__":
    main()
