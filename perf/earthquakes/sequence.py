"""Sequences of earthquakes on a thrust that reaches the surface: problem BP3-QD of the code comparison of SCEC."""
import time
from functools import partial

import numpy as np
import read

from perf.common import program
from perf.earthquakes import half_plane, reference
from perf.earthquakes.rate_state import crossings

SCENE = "earthquakes/thrust_2d.xml"
YEAR = 31557600.0  # s
# of the code FDRA (Cattania), from its files for the benchmark: onsets of the first events, then a cycle of four events
ONSETS = np.array([177.10, 277.34, 334.30, 421.26, 513.70, 611.10])  # years
CYCLE = 63.3 + 87.1 + 91.1 + 97.4                                    # years
GIVEN = "BP3-QD, traction of a given slip"
LIMIT = 6 * 3600                                                     # s, of a run
DEPTH = 18e3                                                         # m, of the given slip


def cases(options, row):
    """Yields (name, function that returns a row)."""
    if not options.quick:
        yield GIVEN, partial(given_slip, options, row.of_run, GIVEN)
        yield "BP3-QD, thrust, 60 degrees", partial(thrust, options, row.of_run, "BP3-QD, thrust, 60 degrees")
        yield "BP3-QD, explicit method", partial(explicit, row, "BP3-QD, explicit method")


def given_slip(options, row, name):
    """Tractions of the fault of the scene for a slip like that of an earthquake, and those of dislocations in the
    half-plane with nine cells in each face. Errors are relative to the root mean square, over the depth of the slip."""
    file = program.mesh(options.binary, SCENE, options.output / "meshes/thrust.msh", options.set)
    slip = "Fractures.fault.prescribed slip."
    entries = (f"Mesh file.path={file}", "Expressions.down=-y/sin(pi/3)",
               f"{slip}slip={{down < {DEPTH:g} ? 3*cos(pi*down/{2 * DEPTH:g})^2 : 0}}",
               f"{slip}upper corner={{1e6, 1e6}}", "Time.end=1", "Output.vtu=true", *options.set)
    run = program.succeeded(options.binary, SCENE, options.output / "given", entries)
    faces = read.segments(read.grid(read.written_steps(run.directory, "fractures")[-1][1]))
    ends = np.sort([np.hypot(*np.array(corners)[:2, :2].T) for corners in faces.corners()], axis=1)
    order = np.argsort(ends[:, 0])
    points = np.append((ends[order, :1] + np.diff(ends[order]) * np.arange(9) / 9).ravel(), ends[order[-1], 1])
    places, middles = ends[order].mean(axis=1), (points[1:] + points[:-1]) / 2
    given = np.where(middles < DEPTH, 3 * np.cos(np.pi * middles / (2 * DEPTH)) ** 2, 0)
    problem = half_plane.bp3()
    found = faces.cell_data["traction local"][order][:, :2][:, ::-1] - [problem.shear, -problem.N]
    errors = []
    for of, own in zip(half_plane.tractions(points, places, np.pi / 3, half_plane.SHEAR_MODULUS, half_plane.POISSON), found.T):
        exact, inside = of @ given, places < DEPTH
        errors.append(np.sqrt(np.sum((own - exact)[inside] ** 2) / np.sum(exact[inside] ** 2)))
    return row(name, run, {"shear traction": errors[0], "normal traction": errors[1]})


def thrust(options, row, name):
    file = options.output / "meshes/thrust.msh"
    program.mesh(options.binary, SCENE, file, options.set)
    entries = (f"Mesh file.path={file}", *options.set)
    run = program.succeeded(options.binary, SCENE, options.output / "thrust", entries, clock=LIMIT)
    times = np.array([step["time"] for step in run.steps])
    rates = np.array([max(of["max_slip_rate"] for of in step["fractures"].values()) for step in run.steps])
    onsets = np.array(crossings(times, rates)) / YEAR
    return row(name, run, deviations(onsets), onsets=listed(onsets))


def explicit(row, name):
    """The explicit method with half the size of the cells."""
    begin = time.monotonic()
    found = reference.solve(half_plane.bp3(50.0), [1000 * YEAR], 1e-6, first_step=1e4)
    onsets = np.array(found.onsets) / YEAR
    return row(name, deviations(onsets), found.steps, found.rejected, time.monotonic() - begin, onsets=listed(onsets))


def listed(onsets):
    """Onsets in years, each with its relative error, as text; as many as are published."""
    return ", ".join(f"{onset:.2f} ({onset / published - 1:+.2%})" for onset, published in zip(onsets, ONSETS))


def deviations(onsets):
    """Relative errors of the first onset, of the published onsets (the largest) and of the duration of the last four
    cycles, from the onsets in years. Without four cycles, the error of the mean interval of the events so far."""
    n = min(len(onsets), len(ONSETS))
    errors = onsets[:n] / ONSETS[:n] - 1
    if len(onsets) >= 9:
        period = (onsets[-1] - onsets[-5]) / CYCLE - 1
    else:
        period = (onsets[n - 1] - onsets[0]) / (ONSETS[n - 1] - ONSETS[0]) - 1 if n > 1 else np.inf
    return {"first event": errors[0] if n else np.inf, "onset": max(errors, key=abs, default=np.inf), "period": period}
