"""Results as Markdown."""
from statistics import median

NAMES = {"W1": "open", "W2": "closed"}


def seconds(x):
    for unit, scale in (("s", 1.0), ("ms", 1e3), ("µs", 1e6)):
        if x * scale >= 1.0 or unit == "µs":
            return f"{x * scale:.3g} {unit}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def ratio(over, under, rounds, clock):
    """The median of the ratios of each round, with the smallest and the largest."""
    all_rounds = [r[over][clock] / r[under][clock] for r in rounds]
    return f"**{median(all_rounds):.3g}** ({min(all_rounds):.3g} to {max(all_rounds):.3g})"


def middle(peer, field, rounds):
    return median(r[peer][field] for r in rounds)


def times(cases, clock):
    head = ["curve", "points", "gimfit", "SciPy", "SciPy / gimfit", "copy", "gimfit / copy",
            "first call: gimfit", "SciPy"]
    rows = []
    for (workload, count), case in cases.items():
        r = case["rounds"]
        rows.append([
            NAMES[workload], f"{count:,}".replace(",", " "),
            seconds(middle("gimfit", clock, r)), seconds(middle("scipy", clock, r)),
            ratio("scipy", "gimfit", r, clock), seconds(middle("copy", clock, r)),
            ratio("gimfit", "copy", r, clock),
            seconds(middle("gimfit", "first_call", r)), seconds(middle("scipy", "first_call", r)),
        ])
    return table(head, rows)


def results(cases):
    head = ["curve", "points", "iterations", "residual: gimfit", "SciPy", "control points differ by",
            "memory: input", "gimfit", "SciPy"]
    rows = []
    for (workload, count), case in cases.items():
        r, same = case["rounds"], case["verified"]
        rows.append([
            NAMES[workload], f"{count:,}".replace(",", " "), r[0]["gimfit"]["iterations"],
            f"{same['gimfit']:.1e}", f"{same['scipy']:.1e}", f"{same['difference']:.1e}",
            f"{same['input_mb']:.3g}", f"+ {middle('gimfit', 'work_mb', r):.3g}",
            f"+ {middle('scipy', 'work_mb', r):.3g}",
        ])
    return table(head, rows)


def document(cases, machine, settings):
    calm = min(r[peer]["cpu_per_wall"]
               for case in cases.values() for r in case["rounds"] for peer in ("gimfit", "scipy"))
    clock, kind = ("cpu_median", "processor") if settings["processor_time"] else ("median", "wall")
    return f"""# Interpolating curves: gimfit and SciPy

Written by `crates/gimfit-bench/peers/against_scipy.py`; [README.md](README.md) says how to run it and
what is compared. Cubic curves through points of three coordinates, the same points, parameters and
knots for both.

{table(["machine", ""], machine)}

{settings["rounds"]} rounds; in each, gimfit, SciPy and the copy ran one after another, each in a process of its own
({settings["seconds"]:g} s; the copy a fifth of that). Times are medians of {kind} time; a ratio is the median of
the ratios of each round, with the smallest and the largest. The least share of a processor that any
run had was {calm:.0%}; far below 100 % means that the machine was busy with other work.

{times(cases, clock)}

Copy: the time to copy as many bytes as an ideal program would touch, reading parameters and points
once and writing control points once (56 bytes a point), between arrays already in use. First call: the
first fit of a fresh process.

{results(cases)}

Residual: the largest distance between a data point and the curve at its parameter, over the diagonal
of the bounding box; control points differ by: the largest difference of a coordinate, over the same.
Both curves were evaluated by the same program (SciPy's `BSpline`). Memory: MiB; the input, and how much
the process grew beyond what it held before its first fit.
"""


def surface_document(cases, machine, settings):
    calm = min(r[peer]["cpu_per_wall"] for case in cases.values() for r in case["rounds"]
               for peer in ("gimfit", "scipy", "fitpack"))
    clock, kind = ("cpu_median", "processor") if settings["processor_time"] else ("median", "wall")
    timed, found = [], []
    for (_, count), case in cases.items():
        r, same = case["rounds"], case["verified"]
        timed.append([
            f"{count} x {count}", seconds(middle("gimfit", clock, r)),
            seconds(middle("scipy", clock, r)), ratio("scipy", "gimfit", r, clock),
            seconds(middle("fitpack", clock, r)), ratio("fitpack", "gimfit", r, clock),
            seconds(middle("copy", clock, r)), ratio("gimfit", "copy", r, clock),
        ])
        found.append([
            f"{count} x {count}", r[0]["gimfit"]["iterations"], f"{same['gimfit']:.1e}",
            f"{same['scipy']:.1e}", f"{same['fitpack']:.1e}", f"{same['scipy difference']:.1e}",
            f"{same['fitpack difference']:.1e}", f"{same['input_mb']:.3g}",
            *(f"+ {middle(peer, 'work_mb', r):.3g}" for peer in ("gimfit", "scipy", "fitpack")),
        ])
    times_head = ["points", "gimfit", "make_interp_spline", "over gimfit", "RectBivariateSpline",
                  "over gimfit", "copy", "gimfit / copy"]
    found_head = ["points", "iterations", "residual: gimfit", "make_interp_spline",
                  "RectBivariateSpline", "control points differ by: first", "second",
                  "memory: input", "gimfit", "first", "second"]
    return f"""# Interpolating grids: gimfit and SciPy

Written by `crates/gimfit-bench/peers/against_scipy.py --surface`; [README.md](README.md) says how to run
it and what is compared. Bicubic surfaces through m x m points of three coordinates at uneven parameters,
over not-a-knot knots, the same for all: gimfit's `fit_surface`, SciPy's `make_interp_spline` in one
direction and then in the other, and one `RectBivariateSpline` for each coordinate.

{table(["machine", ""], machine)}

{settings["rounds"]} rounds; in each, all ran one after another, each in a process of its own
({settings["seconds"]:g} s; the copy a fifth of that), on one thread. Times are medians of {kind} time; a ratio is
the median of the ratios of each round, with the smallest and the largest. The least share of a processor
that any run had was {calm:.0%}; far below 100 % means that the machine was busy with other work.

{table(times_head, timed)}

Copy: the time to copy the points once between arrays already in use (48 bytes a point, half of them read).

{table(found_head, found)}

Residual: the largest distance between a data point and the surface at its parameters, over the diagonal
of the bounding box; control points differ by: the largest difference of a coordinate from gimfit's, over
the same. All surfaces were evaluated by the same program (SciPy's `BSpline`). Memory: MiB; the input, and
how much the process grew beyond what it held before its first fit.
"""
