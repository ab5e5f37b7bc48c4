"""Adapts PorePy of November 2025 to the older numba 0.56, NumPy 1.24 and SciPy 1.10 of Debian 12."""
import inspect

import numba
import numpy as np
import scipy.sparse as sps
import scipy.sparse._arrays
import scipy.sparse._data


def indexed(function):
    """Replaces array[:, None], which numba 0.56 does not support. Returns (function, whether it was changed)."""
    if getattr(function, "__name__", "") != "_unique_points_in_cluster":
        return function, False
    source = inspect.getsource(function)
    made = {}
    exec(source[source.index("def "):].replace("col[:, None]", "np.expand_dims(col, 1)"), function.__globals__, made)
    return made[function.__name__], True


def serial(compiler):
    """Removes parallel=True, which fails with NumPy 1.24."""
    def wrapped(*arguments, **options):
        options.pop("parallel", None)
        if arguments and callable(arguments[0]):
            return compiler(indexed(arguments[0])[0], *arguments[1:], **options)

        def decorate(function):
            function, changed = indexed(function)
            left = {name: value for name, value in options.items() if not (changed and name == "cache")}
            return compiler(*arguments, **left)(function)
        return decorate
    return wrapped


def by_axis(matrix):
    """Adds count_nonzero with an axis to a sparse matrix class."""
    plain = matrix.count_nonzero

    def count_nonzero(self, axis=None):
        if axis is None:
            return plain(self)
        entries = self.tocsc().tocoo()
        entries.sum_duplicates()
        index, size = (entries.col, self.shape[1]) if axis in (0, -2) else (entries.row, self.shape[0])
        return np.bincount(index[entries.data != 0], minlength=size)
    matrix.count_nonzero = count_nonzero


numba.njit, numba.jit = serial(numba.njit), serial(numba.jit)
by_axis(scipy.sparse._data._data_matrix)
for kind in (sps.csr_matrix, sps.csc_matrix, sps.coo_matrix, sps.csr_array, sps.csc_array, sps.coo_array):
    if "count_nonzero" in vars(kind):
        by_axis(kind)
for kind in (sps.coo_matrix, sps.coo_array):
    if not hasattr(kind, "coords"):
        kind.coords = property(lambda self: (self.row, self.col))
if not hasattr(sps, "sparray"):
    sps.sparray = getattr(scipy.sparse._arrays, "_sparray", sps.csr_array)
