#!/usr/bin/env python3
"""Curves and grids measured by others, each within 1e-2, 1e-3 and 1e-4 of its extent: gimfit beside
SciPy.

usage: real_data.py FOLDER [--program GIMFIT] [--write] [--only TEXT] [--limit SECONDS]

FOLDER holds curves/ and grids/. gimfit is asked once for each distance, by --tolerance. SciPy
has no largest distance: its smoothing factor is narrowed down until the largest distance keeps within,
which takes about sixteen calls; times are those of all of them. Curves: splprep, distances by dense
sampling. Heights over a grid: RectBivariateSpline.
The same sampling measures what gimfit wrote. A case of SciPy that takes longer than the limit is ended.
"""
import argparse
import json
import multiprocessing
import os
import re
import subprocess
import sys
import tempfile
import time
import warnings
import xml.etree.ElementTree as tree

import numpy as np
from scipy.interpolate import BSpline, RectBivariateSpline, splev, splprep, splrep
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import machine  # noqa: E402
from table import seconds, table  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
PAGE = os.path.join(ROOT, "docs", "benchmarks", "real-data.md")
SHARES = (1e-2, 1e-3, 1e-4)
# Files that need a word to be read, by what their names contain.
OPTIONS = [
    ("curves/mocap/", ["--skip-missing"]),
    ("curves/signals/ecg", []),
    ("curves/signals/", ["--abscissa", "x", "--sort"]),
    ("cerknicko-jezero.gpx", ["--part", "all"]),
    ("korita-zbevnica.gpx", ["--part", "all"]),
    ("grids/rotor37", ["--index-columns", "surface,j", "--columns", "z_cm,r_cm,theta1"]),
    ("grids/rotor67", ["--index-columns", "surface,j", "--columns", "axial_ft,rtheta_upper_ft,r_ft"]),
]
# The same points as another file, only parameters or only places.
LEFT_OUT = [r"gpx/.*\.csv$", r"ship_hull_params"]


def options(name):
    return next((words for part, words in OPTIONS if part in name), [])


def dense(curve, breaks, points):
    """Places and samples on a curve: many in every piece."""
    breaks = np.unique(breaks)
    rough = curve(breaks[:-1, None] + np.arange(25) / 24 * np.diff(breaks)[:, None])
    lengths = np.linalg.norm(np.diff(rough, axis=1), axis=2).sum(1)
    most = 8000 + 8 * points
    counts = np.maximum(24, np.ceil(most * lengths / max(lengths.sum(), 1e-300))).astype(int)
    places = np.concatenate([np.linspace(a, b, n, endpoint=False)
                             for a, b, n in zip(breaks[:-1], breaks[1:], counts)] + [breaks[-1:]])
    return places, curve(places)


def from_curve(curve, breaks, points, feet=None):
    """Largest distance of points from a curve: nearest samples, then golden sections; `feet` are places
    that are close, where some are known."""
    places, samples = dense(curve, breaks, len(points))
    distances, near = cKDTree(samples).query(points, k=3)
    best = distances.min(1)
    if feet is not None and len(feet) == len(points):
        best = np.minimum(best, np.linalg.norm(curve(feet) - points, axis=1))
    golden = (5 ** 0.5 - 1) / 2
    for index in near.T:
        low, high = places[np.maximum(index - 1, 0)], places[np.minimum(index + 1, len(places) - 1)]
        for _ in range(30):
            a, b = high - golden * (high - low), low + golden * (high - low)
            left = ((curve(a) - points) ** 2).sum(1) < ((curve(b) - points) ** 2).sum(1)
            high, low = np.where(left, b, high), np.where(left, low, a)
        best = np.minimum(best, np.linalg.norm(curve((low + high) / 2) - points, axis=1))
    return best.max()


def spline(geometry):
    """The curve of a document, and its breaks."""
    knots, degree = np.array(geometry["knots"], float), geometry["degree"]
    curve = BSpline(knots, np.array(geometry["control_points"], float), degree)
    start, end = knots[degree], knots[-degree - 1]
    return curve, knots[(knots >= start) & (knots <= end)]


def narrowed(attempt, tolerance, first):
    """The fewest control points by a smoothing factor, whose largest distance keeps the tolerance:
    attempt(s) gives control points and distance."""
    best, low, high, s = None, None, None, first
    for _ in range(16):
        count, distance = attempt(s)
        if distance <= tolerance:
            low = s
            if best is None or count < best[0]:
                best = (count, distance)
        else:
            high = s
        if low is None:
            s /= 16.0
        elif high is None:
            s *= 16.0
        else:
            s = (low * high) ** 0.5
            if high / low < 1.05:
                break
    return best


def scipy_curve(points, tolerance):
    same = np.r_[False, (np.diff(points, axis=0) == 0).all(1)]
    distinct = points[~same]

    def attempt(s):
        (knots, control, degree), _ = splprep(distinct.T, s=s, k=3)
        curve = BSpline(knots, np.array(control).T, degree)
        return len(control[0]), from_curve(curve, knots[degree:-degree], distinct)

    return narrowed(attempt, tolerance, len(distinct) * tolerance ** 2 / 4)


def scipy_values(x, y, tolerance):
    def attempt(s):
        knots, control, degree = splrep(x, y, s=s, k=3)
        return len(knots) - degree - 1, np.abs(splev(x, (knots, control, degree)) - y).max()

    return narrowed(attempt, tolerance, len(x) * tolerance ** 2 / 4)


def scipy_heights(heights, tolerance):
    u, v = np.arange(heights.shape[0]), np.arange(heights.shape[1])

    def attempt(s):
        fit = RectBivariateSpline(u, v, heights, s=s)
        return fit.get_coeffs().size, np.abs(fit(u, v) - heights).max()

    return narrowed(attempt, tolerance, heights.size * tolerance ** 2 / 4)


def within(limit, work, *arguments):
    """What a function returns and how long it takes, in a process that is ended after the limit."""
    def run(send):
        warnings.simplefilter("ignore")
        clock = time.perf_counter()
        try:
            send.send((work(*arguments), time.perf_counter() - clock))
        except Exception as error:  # whatever a peer raises is its answer
            send.send((str(error).split("\n")[0][:60], time.perf_counter() - clock))

    receive, send = multiprocessing.Pipe(False)
    process = multiprocessing.Process(target=run, args=(send,))
    process.start()
    found = receive.recv() if receive.poll(limit) else None
    process.kill()
    process.join()
    return found


def load(path, name, document):
    """The points that gimfit fitted, by the names of their columns."""
    names = document["coordinate_names"]
    if name.endswith(".gpx"):
        spot = [(float(e.get("lon")), float(e.get("lat"))) for e in tree.parse(path).iter()
                if e.tag.endswith("trkpt")]
        return np.array(spot)
    with open(path) as file:
        lines = [line for line in file.read().splitlines() if not line.startswith("#")]
    if name.endswith(".dat"):
        rows = [line.split() for line in lines[1:]]
        return np.array([[float(x) for x in row] for row in rows if len(row) == 2])
    if name.endswith(".asc"):
        return None
    head = lines[0].split(",")
    rows = [line.split(",") for line in lines[1:]]
    if not set(names) <= set(head):
        return None
    wanted = [head.index(column) for column in names]
    values = [[row[k] for k in wanted] for row in rows if all(row[k] != "" for k in wanted)]
    return np.array(values, float)


def heights(path, name):
    """The matrix of an ESRI grid or of a table of heights without gaps, or None."""
    with open(path) as file:
        lines = file.read().splitlines()
    if name.endswith(".asc"):
        head = {line.split()[0].lower(): float(line.split()[1]) for line in lines[:6]}
        matrix = np.array([[float(x) for x in line.split()] for line in lines[6:] if line.strip()])
        return None if (matrix == head.get("nodata_value")).any() else matrix
    if "mt_bruno" in name:
        return np.array([[float(x) for x in line.split(",")[1:]] for line in lines[1:]])
    if "jacksboro" in name:
        return np.array([[float(x) for x in line.split(",")] for line in lines])
    return None


class Case:
    """A file, how gimfit is asked, and how SciPy is."""

    def __init__(self, program, folder, name):
        self.program, self.path, self.name = program, os.path.join(folder, name), name
        self.kind = name.split("/")[0]
        command = {"curves": "curve", "grids": "surface"}[self.kind]
        self.line = [command, self.path, *options(name)]

    def gimfit(self, tolerance):
        with tempfile.TemporaryDirectory() as at:
            out = os.path.join(at, "fit.json")
            clock = time.perf_counter()
            run = subprocess.run([self.program, *self.line, "--tolerance", repr(tolerance), "-o", out, "-q"],
                                 capture_output=True, text=True)
            took = time.perf_counter() - clock
            if run.returncode == 2:
                return run.stderr.removeprefix("error: ").replace(self.path, "").strip(" :\n,"), took
            with open(out) as file:
                return json.load(file), took

    def measured(self, document):
        """The largest distance of what gimfit wrote, by sampling; None where nothing here can tell."""
        if self.kind != "curves":
            return None
        curve, breaks = spline(document["geometry"])
        if document["geometry"]["dimension"] == 1:
            return None
        points = load(self.path, self.name, document)
        feet = np.array(document["parameters"])
        return None if points is None else from_curve(curve, breaks, points, feet)

    def peer(self, document, tolerance, limit):
        if self.kind == "curves":
            points = load(self.path, self.name, document)
            if points is None:
                return None
            if document["geometry"]["dimension"] == 1:
                x = np.array(document["parameters"])
                order = np.argsort(self.abscissae(points), kind="stable")
                return within(limit, scipy_values, x, points[order, 0], tolerance)
            return within(limit, scipy_curve, points, tolerance)
        matrix = heights(self.path, self.name)
        return "no surface" if matrix is None else within(limit, scipy_heights, matrix, tolerance)

    def abscissae(self, points):
        """What a signal is sorted by."""
        if "--abscissa" not in self.line:
            return np.arange(len(points))
        with open(self.path) as file:
            head = file.readline().strip().split(",")
            return np.array([float(line.split(",")[head.index("x")]) for line in file if line.strip()])


def size_of(document):
    geometry, report = document["geometry"], document["report"]
    if geometry["type"] == "curve":
        return report["control_points"], str(report["control_points"])
    rows, columns = report["control_points"]
    return rows * columns, f"{rows} x {columns}"


def rows_of(case, limit):
    """A row of the table for each distance."""
    first, _ = case.gimfit(1e300)
    if isinstance(first, str):
        return [[case.name, "", "", "refused: " + first[:140], "", "", "", ""]]
    extent, points = first["report"]["extent"], first["report"]["points"]
    if case.kind == "grids" and (matrix := heights(case.path, case.name)) is not None:
        extent = float(matrix.max() - matrix.min())
    many = " x ".join(map(str, points)) if isinstance(points, list) else str(points)
    rows = []
    for share in SHARES:
        tolerance = share * extent
        document, took = case.gimfit(tolerance)
        if isinstance(document, str):
            rows.append([case.name, many, f"{share:g}", "refused: " + document[:140], "", "", "", ""])
            continue
        account = document["report"]["approximation"]
        measured = case.measured(document)
        count, size = size_of(document)
        largest = max(account["max_distance"], measured or 0.0) / extent
        note = "" if account["met"] else " **not kept**"
        note += "" if account.get("calm", account["overshoot"] <= account["calm_limit"]) else " not calm"
        if measured is not None and measured > tolerance * (1 + 1e-9) and account["met"]:
            note += f" **measured {measured / extent:.3g}**"
        peer = case.peer(document, tolerance, limit)
        if peer is None:
            theirs = [f"> {limit:g} s", ""]
        elif isinstance(peer, str):
            theirs = [peer, ""]
        elif isinstance(peer[0], str) or peer[0] is None:
            theirs = [peer[0] or "not kept", seconds(peer[1])]
        else:
            theirs = [str(peer[0][0]), seconds(peer[1])]
            if account["met"]:
                RATIOS.setdefault(case.kind, []).append((count / peer[0][0], peer[1] / took))
        rows.append([case.name, many, f"{share:g}", size, f"{largest:.3g}{note}", seconds(took), *theirs])
        TALLY[0] += 1
        TALLY[1] += account["met"]
    return rows


RATIOS, TALLY = {}, [0, 0]


def files(folder, only):
    for kind in ("curves", "grids"):
        for at, _, names in sorted(os.walk(os.path.join(folder, kind))):
            for name in sorted(names):
                name = os.path.relpath(os.path.join(at, name), folder)
                if not any(re.search(part, name) for part in LEFT_OUT) and only in name:
                    yield name


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--program", default=os.path.join(ROOT, "target", "release", "gimfit"))
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--limit", type=float, default=20.0)
    arguments = parser.parse_args()
    found = {}
    for name in files(arguments.folder, arguments.only):
        print(name, file=sys.stderr)
        kind = name.split("/")[0]
        case = Case(arguments.program, arguments.folder, name)
        rows = rows_of(case, arguments.limit)
        found.setdefault(kind, []).extend([row[0].removeprefix(kind + "/"), *row[1:]] for row in rows)
    text = page(found, arguments.limit)
    if arguments.write:
        with open(PAGE, "w") as file:
            file.write(text)
    else:
        print(text)


def page(found, limit):
    facts = dict(machine.describe())
    lines = [
        "# Points measured by others, within 1e-2, 1e-3 and 1e-4 of their extent",
        "",
        "Printed by `crates/gimfit-bench/peers/real_data.py`; [README.md](README.md) says how to run it, and",
        "where the files come from. gimfit is asked once, by `--tolerance`, with default options; files that",
        "need a word to be read get it (`OPTIONS` in the program). SciPy's smoothing factor is narrowed down",
        f"until the largest distance keeps within, at most sixteen calls and {limit:g} seconds: a patient user.",
        "Distances are parts of the extent (of heights over a grid: of the range of the heights): the larger",
        "one of gimfit's own and, for curves, that of dense sampling by the program that prints this page.",
        "",
        f"Taken on {facts['date']} on {facts['processor']}, {facts['cores'].split(',')[0]} cores; Rust {facts['Rust']}, "
        f"Python {facts['Python']}.",
        "",
        f"{TALLY[1]} of {TALLY[0]} cases keep their distance.",
    ]
    for kind, pairs in RATIOS.items():
        ratios = np.array(pairs)
        middle = np.exp(np.log(ratios).mean(0))
        lines.append(f"{kind.capitalize()}: where both do ({len(pairs)} cases), gimfit takes {middle[0]:.2f} "
                     f"times the control points of SciPy, and SciPy {middle[1]:.2g} times the time of gimfit "
                     f"(geometric means; gimfit's time is that of the whole program).")
    head = ["file", "points", "within", "control points", "largest distance", "time", "SciPy", "time"]
    for kind, rows in found.items():
        lines += ["", f"## {kind.capitalize()}", "", table(head, rows)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
