"""The Python side, in a process of its own: SciPy, and a plain copy of memory.

usage: python_peers.py <workload> scipy|copy <size> [--seconds S] [--control-points FILE]
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


def scipy_case(workload, count):
    from scipy.interpolate import make_interp_spline
    points = workloads.load(f"{workload}_{count}.p", count, 3)
    u = workloads.load(f"{workload}_{count}.u")
    if workload == "W1":
        knots = workloads.load(f"W1_{count}.t")
        return lambda: make_interp_spline(u, points, k=3, t=knots)
    closed = np.vstack([points, points[:1]])
    return lambda: make_interp_spline(u, closed, k=3, bc_type="periodic")


def copy_case(_, count):
    """Parameters and points in, control points out: 56 bytes a point, half of them read."""
    source = np.ones(count * 28, dtype=np.uint8)
    target = np.zeros_like(source)
    return lambda: np.copyto(target, source)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("workload")
    parser.add_argument("peer", choices=["scipy", "copy"])
    parser.add_argument("size", type=int)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--control-points", default=None)
    a = parser.parse_args()
    solve = {"scipy": scipy_case, "copy": copy_case}[a.peer](a.workload, a.size)

    before = memory("VmRSS")
    start = time.perf_counter()
    result = solve()
    first = time.perf_counter() - start
    peak = memory("VmHWM")
    if a.control_points:
        np.ascontiguousarray(result.c, dtype="<f8").tofile(a.control_points)

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
