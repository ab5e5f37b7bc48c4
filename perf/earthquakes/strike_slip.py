"""Earthquakes on a vertical strike-slip fault in 3D: problem BP5-QD of the code comparison of SCEC, first two events, by
the explicit method with two cell sizes."""
import time
from functools import cache, partial

import numpy as np

from perf.earthquakes import half_space, reference
from perf.earthquakes.sequence import YEAR

COARSE, FINE = 2000.0, 1000.0  # m, of the cells
END = 237                      # years: two events, the first one at the start


def cases(options, row):
    """Yields (name, function that returns a row)."""
    if not options.quick:
        yield "BP5-QD, explicit method", partial(explicit_row, row, "BP5-QD, explicit method")


def explicit_row(row, name):
    """Interval of the events and mean slip of the fault at the end with the larger cells, relative to the smaller ones."""
    begin, found = time.monotonic(), explicit(COARSE)
    seconds, exact = time.monotonic() - begin, explicit(FINE)
    if len(found.onsets) != len(exact.onsets):
        return row(name, {"onset": np.inf}, found.steps, found.rejected, seconds)
    onset, period = found.onsets[-1] / YEAR, found.onsets[-1] / exact.onsets[-1] - 1
    errors = {"period": period, "slip": mean_slip(found) / mean_slip(exact) - 1}
    return row(name, errors, found.steps, found.rejected, seconds, onsets=f"{onset:.2f} ({period:+.2%})")


def mean_slip(solution):
    slip = solution.states[-1]
    return np.mean(slip[: len(slip) // 2])


@cache
def explicit(size):
    return reference.solve(half_space.Plane(size), [END * YEAR], 1e-5, first_step=1e-2)
