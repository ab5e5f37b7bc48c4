"""Sequences of earthquakes on a thrust that reaches the surface: problem BP3-QD of the code comparison of SCEC."""
import time
from functools import partial

import numpy as np

from perf.common import program
from perf.earthquakes import half_plane, reference
from perf.earthquakes.rate_state import crossings

SCENE = "earthquakes/thrust_2d.xml"
YEAR = 31557600.0  # s
# of the code FDRA (Cattania), from its files for the benchmark: onsets of the first events, then a cycle of four events
ONSETS = np.array([177.10, 277.34, 334.30, 421.26, 513.70, 611.10])  # years
CYCLE = 63.3 + 87.1 + 91.1 + 97.4                                    # years
LIMIT = 6 * 3600                                                     # s, of a run


def cases(options, row):
    """Yields (name, function that returns a row)."""
    if not options.quick:
        yield "BP3-QD, thrust, 60 degrees", partial(thrust, options, row.of_run, "BP3-QD, thrust, 60 degrees")
        yield "BP3-QD, explicit method", partial(explicit, row, "BP3-QD, explicit method")


def thrust(options, row, name):
    file = options.output / "meshes/thrust.msh"
    program.mesh(options.binary, SCENE, file, ())
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
