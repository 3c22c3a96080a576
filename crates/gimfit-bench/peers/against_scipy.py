#!/usr/bin/env python3
"""Times gimfit and SciPy's make_interp_spline on the same data, in turns, on one thread.

Needs NumPy and SciPy, and cargo:

    python3 -m venv peers && peers/bin/pip install numpy scipy
    peers/bin/python crates/gimfit-bench/peers/against_scipy.py --write

Without --write the tables are only printed. Takes about four minutes. With --surface the grids of W3
take the place of the curves.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
SIZES = [100, 10_000, 100_000, 1_000_000]
# Rows, and columns, of grids.
GRID_SIZES = [100, 300, 1000, 3000]
# One thread for everybody; set before NumPy is loaded here or in a child.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"


def build():
    """Builds our program and returns its path."""
    command = ["cargo", "build", "--release", "-p", "gimfit-bench", "--message-format=json"]
    output = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
    messages = map(json.loads, output.splitlines())
    return [m["executable"] for m in messages if m.get("executable")][-1]


def run(command, workload, peer, count, seconds, control_points):
    """The result of one process."""
    command = [*command, workload, peer, str(count), "--seconds", str(seconds)]
    if control_points:
        command += ["--control-points", control_points]
    output = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    line = next(line for line in output.splitlines() if line.startswith("RESULT "))
    return json.loads(line.removeprefix("RESULT "))


def verify(workload, count, files):
    """Judges both curves by one evaluator, and compares their control points."""
    import numpy as np
    import workloads
    from scipy.interpolate import BSpline
    points = workloads.load(f"{workload}_{count}.p", count, 3)
    parameters = workloads.load(f"{workload}_{count}.u")[:count]
    knots = workloads.full_knots(workload, count)
    extent = np.linalg.norm(points.max(0) - points.min(0))
    control = {peer: np.fromfile(file, dtype="<f8").reshape(-1, 3) for peer, file in files.items()}
    verdict = {}
    for peer, c in control.items():
        gaps = BSpline(knots, c, workloads.DEGREE)(parameters) - points
        verdict[peer] = float(np.sqrt((gaps * gaps).sum(1)).max() / extent)
    verdict["difference"] = float(np.abs(control["gimfit"] - control["scipy"]).max() / extent)
    verdict["input_mb"] = 8 * (points.size + parameters.size + knots.size) / 2**20
    return verdict


def verify_grid(count, files):
    """As verify, for surfaces: both evaluated by SciPy's BSpline, in u, then in v."""
    import numpy as np
    import workloads
    from scipy.interpolate import BSpline
    u, v, s, t = (workloads.load(f"W3_{count}.{kind}") for kind in "uvst")
    points = workloads.load(f"W3_{count}.p", count, count, 3)
    extent = np.linalg.norm(points.max((0, 1)) - points.min((0, 1)))
    ours = np.fromfile(files["gimfit"], dtype="<f8").reshape(points.shape)
    verdict = {"input_mb": 8 * (points.size + 4 * count) / 2**20}
    for peer, file in files.items():
        net = np.fromfile(file, dtype="<f8").reshape(points.shape)
        verdict[peer + " difference"] = float(np.abs(net - ours).max() / extent)
        across = BSpline(s, net, workloads.DEGREE)(u)
        gaps = BSpline(t, np.moveaxis(across, 1, 0), workloads.DEGREE)(v) - np.moveaxis(points, 1, 0)
        verdict[peer] = float(np.sqrt((gaps * gaps).sum(2)).max() / extent)
    return verdict


def compare(program, workload, count, arguments, folder):
    """All rounds of one case."""
    python = [sys.executable, os.path.join(HERE, "python_peers.py")]
    peers = {"gimfit": ([program], "gimfit.interpolate"), "scipy": (python, "scipy")}
    if workload == "W3":
        peers["fitpack"] = (python, "fitpack")
    files = {peer: os.path.join(folder, peer + ".control") for peer in peers}
    peers["copy"] = (python, "copy")
    rounds = []
    for k in range(arguments.rounds):
        # Whoever comes first has the caches to himself: take turns at that, too.
        order = list(peers) if k % 2 == 0 else list(reversed(peers))
        results = {}
        for peer in order:
            command, name = peers[peer]
            file = files.get(peer) if k == 0 else None
            seconds = arguments.seconds * (0.2 if peer == "copy" else 1.0)
            results[peer] = run(command, workload, name, count, seconds, file)
        rounds.append(results)
    verified = verify_grid(count, files) if workload == "W3" else verify(workload, count, files)
    case = {"rounds": rounds, "verified": verified}
    if not all(r["gimfit"]["converged"] for r in rounds):
        raise SystemExit(f"{workload} {count}: gimfit did not reach its residual")
    return case


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write docs/benchmarks/curve.md")
    parser.add_argument("--large", action="store_true", help="also ten million points (needs 6 GiB)")
    parser.add_argument("--surface", action="store_true",
                        help="surfaces: write docs/benchmarks/surface.md")
    parser.add_argument("--sizes", help="other numbers of points, with commas between them")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1.5, help="of each peer in each round")
    parser.add_argument("--processor-time", action="store_true",
                        help="compare processor time: a quick look on a busy machine")
    parser.add_argument("--program", help="our program, if it is built already")
    arguments = parser.parse_args()
    sizes = [int(n) for n in arguments.sizes.split(",")] if arguments.sizes else \
        list(GRID_SIZES if arguments.surface else SIZES)
    sizes += [10_000_000] if arguments.large else []
    try:
        import machine
        import table
        description = machine.describe()
    except ImportError as error:
        raise SystemExit(f"{error}; install NumPy and SciPy: pip install numpy scipy")
    program = arguments.program or build()

    cases = {}
    with tempfile.TemporaryDirectory() as folder:
        os.environ["BENCH_DATA"] = folder
        import workloads
        workloads.FOLDER = folder
        for workload in ("W3",) if arguments.surface else ("W1", "W2"):
            for count in sizes:
                workloads.make(workload, count)
                cases[workload, count] = compare(program, workload, count, arguments, folder)
                workloads.remove(workload, count)
                print(f"{workload} {count}: done", file=sys.stderr)
    document, name = ((table.surface_document, "surface.md") if arguments.surface
                      else (table.document, "curve.md"))
    text = document(cases, description, vars(arguments))
    print(text)
    if arguments.write:
        with open(os.path.join(ROOT, "docs", "benchmarks", name), "w") as file:
            file.write(text)


if __name__ == "__main__":
    main()
