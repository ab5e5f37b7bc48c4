"""Point driver: one point of a joint on a path, without a mesh, and fits of its entries to measured curves."""
import os

import numpy as np
from mpi4py import MPI

from . import _sprekk
from .scene import merge, override_texts, plain


class PointFailed(_sprekk.Error):
    """Failure of a step of the point driver. `curve` contains the earlier steps."""

    def __init__(self, reason, curve):
        super().__init__(reason)
        self.curve = curve


def point_entries(scene):
    """Returns the entries of a point scene (file or dict), and its name in messages."""
    if isinstance(scene, (str, os.PathLike)):
        return _sprekk.read_entries(os.fspath(scene), MPI.COMM_SELF), os.fspath(scene)
    entries = {}
    merge(entries, [], plain(scene))
    return entries, "scene"


def drive(scene, overrides=()):
    """Computes the path of a point scene: a file or entries with the sections Point and Materials.

    Returns a pandas.DataFrame with the columns of `./sprekk point`, in SI units. Scenes with Specimens return a dict
    {specimen: DataFrame}. Raises PointFailed."""
    import pandas
    entries, name = point_entries(scene)
    curves = {}
    for specimen, columns, failure in _sprekk.drive(entries, name, override_texts(overrides)):
        curves[specimen] = pandas.DataFrame(columns)
        if failure:
            raise PointFailed(failure, curves[specimen])
    return curves[""] if list(curves) == [""] else curves


def fit(scene, measured, along, match, parameters):
    """Fits entries of a joint to a measured curve by least squares.

    scene       point scene, as in drive()
    measured    columns in SI units, a dict or a pandas.DataFrame
    along       increasing column, the common abscissa; named as in drive()
    match       names of the compared columns
    parameters  {path of an entry: (start, low, high)}, in the unit of the reference

    Returns an Estimate: values, 95 % confidence intervals and correlation, in the order of `parameters`. It has two more
    attributes: `parameters` {path: fitted value}, and the fitted `curve`."""
    from . import estimate
    entries, _ = point_entries(scene)
    match = [match] if isinstance(match, str) else list(match)
    check_measured(measured, [along, *match])
    check_parameters(parameters)
    x = np.asarray(measured[along], float)
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
    curve = drive(entries, start)  # raises errors of the input here
    if isinstance(curve, dict):
        raise _sprekk.Error("the scene has several specimens, must have one Point")
    for name in (along, *match):
        if name not in curve:
            raise _sprekk.Error(f'the point has no column "{name}", but ' + ", ".join(curve.columns))
    found = estimate.fit(residuals, [estimate.Parameter(path, *limits) for path, limits in parameters.items()])
    found.parameters = dict(zip(parameters, found.values))
    found.curve = drive(entries, found.parameters)
    return found


def check_measured(measured, names):
    """Checks that the named columns exist and contain finite numbers of equal length."""
    length = None
    for name in names:
        try:
            values = np.asarray(measured[name], float)
        except (KeyError, IndexError, TypeError):
            known = ", ".join(map(str, measured))
            raise _sprekk.Error(f'measured: has no column "{name}", but {known or "none"}') from None
        except ValueError as error:
            raise _sprekk.Error(f'measured: the column "{name}" must have numbers: {error}') from None
        if values.ndim != 1 or len(values) == 0:
            raise _sprekk.Error(f'measured: the column "{name}" has the shape {values.shape}, must be a list of numbers')
        if not np.all(np.isfinite(values)):
            row = int(np.argmin(np.isfinite(values)))
            raise _sprekk.Error(f'measured: the column "{name}" is {values[row]} in row {row}, must be finite')
        length = length or len(values)
        if len(values) != length:
            raise _sprekk.Error(f'measured: the column "{name}" has {len(values)} rows, others have {length}')
    if len(names) < 2:
        raise _sprekk.Error("match: names no column, must name one or more")


def check_parameters(parameters):
    """Checks that each parameter is (start, low, high) with low < high and low <= start <= high."""
    if not parameters:
        raise _sprekk.Error("parameters: has none, must have one or more: {path of an entry: (start, low, high)}")
    for path, limits in parameters.items():
        try:
            start, low, high = (float(limit) for limit in limits)
        except (TypeError, ValueError):
            raise _sprekk.Error(f'parameters: "{path}" has {limits!r}, must have numbers (start, low, high)') from None
        if not (np.isfinite(start) and low < high and low <= start <= high):
            raise _sprekk.Error(f'parameters: "{path}" has start {start:g}, low {low:g}, high {high:g}; must be numbers with '
                                'low < high and the start between them')
