"""The points, parameters and knots of the workloads, from fixed seeds, as files of raw doubles."""
import os

import numpy as np

FOLDER = os.environ.get("BENCH_DATA", "")
DEGREE = 3


def path(name):
    return os.path.join(FOLDER, name + ".f64")


def save(name, values):
    np.ascontiguousarray(values, dtype="<f8").tofile(path(name))


def load(name, *shape):
    values = np.fromfile(path(name), dtype="<f8")
    return values.reshape(shape) if shape else values


def open_points(count):
    """A noisy helix, about 200 points a turn, with jittered steps."""
    random = np.random.default_rng(1)
    turns = max(2.0, count / 200.0)
    angle = 2 * np.pi * turns / count * (np.arange(count) + 0.3 * (random.random(count) - 0.5))
    radius = 1 + 0.2 * np.cos(0.37 * angle)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.05 * angle], axis=1)
    return points + random.standard_normal((count, 3)) * (0.02 * 2 * np.pi * turns / count)


def closed_points(count):
    """A noisy curve winding round a torus, about 200 points a winding, with jittered steps."""
    random = np.random.default_rng(2)
    windings = max(2, round(count / 200.0))
    angle = 2 * np.pi / count * (np.arange(count) + 0.3 * (random.random(count) - 0.5))
    radius = 2 + np.cos(windings * angle)
    points = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.sin(windings * angle)], axis=1)
    return points + random.standard_normal((count, 3)) * (0.02 * 2 * np.pi * windings / count)


def chord_lengths(points):
    parameters = np.zeros(len(points))
    np.cumsum(np.sqrt(((points[1:] - points[:-1]) ** 2).sum(1)), out=parameters[1:])
    return parameters


def grid_points(count):
    """A wavy sheet with a little noise over uneven steps: parameters of rows and columns, points."""
    random = np.random.default_rng(3)
    steps = 0.4 + 1.2 * random.random((2, count - 1))
    u, v = np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)
    u, v = u / u[-1], v / v[-1]
    waves = max(2.0, count / 40.0)
    points = np.empty((count, count, 3))
    points[:, :, 0] = u[:, None] + 0.01 * np.sin(9 * v)[None, :]
    points[:, :, 1] = v[None, :] + 0.01 * np.cos(7 * u)[:, None]
    points[:, :, 2] = 0.2 * np.sin(waves * u)[:, None] * np.cos(waves * v)[None, :]
    return u, v, points + 0.02 / count * random.standard_normal(points.shape)


def not_a_knot(parameters):
    return np.concatenate([[parameters[0]] * 4, parameters[2:-2], [parameters[-1]] * 4])


def least_squares(parameters, control_points):
    """Every span holds about as many points (The NURBS Book, eq. 9.69)."""
    place = np.arange(1, control_points - DEGREE) * (len(parameters) / (control_points - DEGREE))
    i = place.astype(np.int64)
    share = place - i
    inner = (1 - share) * parameters[i - 1] + share * parameters[i]
    return np.concatenate([[parameters[0]] * 4, inner, [parameters[-1]] * 4])


def make(workload, count):
    """Writes points (.p), parameters (.u) and not-a-knot knots (.t) where they are given; for a
    surface parameters of rows (.u) and columns (.v), and their knots (.s and .t)."""
    name = f"{workload}_{count}"
    if workload == "W3":
        u, v, points = grid_points(count)
        for kind, values in zip("uvstp", (u, v, not_a_knot(u), not_a_knot(v), points)):
            save(f"{name}.{kind}", values)
        return
    if workload == "W4":
        points = open_points(count)
        parameters = chord_lengths(points)
        save(name + ".t", least_squares(parameters, count // 10))
        save(name + ".u", parameters)
        save(name + ".p", points)
        return
    if workload == "W10":
        points = open_points(count)
        save(name + ".u", chord_lengths(points))
        save(name + ".p", points)
        return
    if workload == "W1":
        points = open_points(count)
        parameters = chord_lengths(points)
        save(name + ".t", not_a_knot(parameters))
    else:
        points = closed_points(count)
        parameters = chord_lengths(np.vstack([points, points[:1]]))
    save(name + ".p", points)
    save(name + ".u", parameters)


def full_knots(workload, count):
    """The knot vector both sides use: as given, or the parameters repeated with their period."""
    if workload == "W1":
        return load(f"W1_{count}.t")
    u = load(f"W2_{count}.u")
    period = u[-1] - u[0]
    return np.concatenate([u[-DEGREE - 1:-1] - period, u, u[1:DEGREE + 1] + period])


def remove(workload, count):
    for kind in "puvst":
        if os.path.exists(path(f"{workload}_{count}.{kind}")):
            os.remove(path(f"{workload}_{count}.{kind}"))
