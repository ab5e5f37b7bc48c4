"""One point of a joint, driven along a path without a mesh, and fits of its entries to measured curves."""
import os

import numpy as np
from mpi4py import MPI

from . import _sprekk
from .scene import merge, override_texts, plain


class PointFailed(_sprekk.Error):
    """A step has no state. `curve` holds those before."""

    def __init__(self, reason, curve):
        super().__init__(reason)
        self.curve = curve


def point_entries(scene):
    """Entries of a scene for points, from a file or a dict, and what opens messages."""
    if isinstance(scene, (str, os.PathLike)):
        return _sprekk.read_entries(os.fspath(scene), MPI.COMM_SELF), os.fspath(scene)
    entries = {}
    merge(entries, [], plain(scene))
    return entries, "scene"


def drive(scene, overrides=()):
    """The states of the point of a scene (a file or entries with the sections Point and Materials): a pandas.DataFrame
    with the columns of `./sprekk point`, in SI; of a scene with Specimens a dict of them. Raises PointFailed."""
    import pandas
    entries, name = point_entries(scene)
    curves = {}
    for specimen, columns, failure in _sprekk.drive(entries, name, override_texts(overrides)):
        curves[specimen] = pandas.DataFrame(columns)
        if failure:
            raise PointFailed(failure, curves[specimen])
    return curves[""] if list(curves) == [""] else curves


def fit(scene, measured, along, match, parameters):
    """Entries of a joint for which the point follows a measured curve best, by least squares.

    scene       of a point, as for drive()
    measured    columns of numbers in SI, a dict or a pandas.DataFrame
    along       the column that both are compared along, which increases, by the name of drive()
    match       columns that are compared
    parameters  {path of an entry: (start, low, high)}, the unit being that of the reference

    Returns an Estimate: values, intervals of 95 % confidence, correlation; its `curve` is the fitted one."""
    from . import estimate
    entries, _ = point_entries(scene)
    x = np.asarray(measured[along], float)
    match = [match] if isinstance(match, str) else list(match)
    scale = {name: np.ptp(np.asarray(measured[name], float)) or 1 for name in match}

    def residuals(values):
        try:
            curve = drive(entries, dict(zip(parameters, values)))
        except _sprekk.Error:
            return np.full(len(match) * len(x), np.nan)
        rows = np.concatenate([[True], np.diff(np.maximum.accumulate(curve[along])) > 0])
        return np.concatenate([(np.interp(x, curve[along][rows], curve[name][rows]) - measured[name]) / scale[name]
                               for name in match])

    start = {path: value[0] for path, value in parameters.items()}
    drive(entries, start)  # what is wrong is told here
    found = estimate.fit(residuals, [estimate.Parameter(path, *limits) for path, limits in parameters.items()])
    found.parameters = dict(zip(parameters, found.values))
    found.curve = drive(entries, found.parameters)
    return found
