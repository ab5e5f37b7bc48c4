"""Arrays in the memory of a model."""
import numpy as np


class StaleField(RuntimeError):
    """Access to a field after its model was changed or closed."""


class Epoch:
    """Period between two changes of the equations of a model; `over` after its end."""
    over = False


class Field(np.ndarray):
    """Array [entity, component] in the memory of a model. Written values take effect in the next step.

    Results of computations are ordinary arrays. np.asarray() returns a read-only view, so that no assignment is lost. A
    Field raises StaleField after a change of the equations. The memory of views remains valid, with the last values."""

    def __new__(cls, values, epoch):
        values = np.asarray(values)
        field = values.view(cls)
        field._epoch, field._memory = epoch, values
        field.flags.writeable = False
        return field

    def __array_finalize__(self, source):
        self._epoch, self._memory = getattr(source, "_epoch", None), getattr(source, "_memory", None)

    def _check(self):
        if self._epoch is not None and self._epoch.over:
            raise StaleField("the model has been changed or closed since this array was requested; request it again")

    def _writable(self):
        """Returns the same values as an ordinary, writable array."""
        self._check()
        if self.flags.writeable or self._memory is None:
            return self.view(np.ndarray)
        offset = self.ctypes.data - self._memory.ctypes.data
        return np.ndarray(self.shape, self.dtype, self._memory, offset, self.strides)

    def __getitem__(self, key):
        self._check()
        return super().__getitem__(key)

    def __setitem__(self, key, value):
        self._writable()[key] = ordinary(value)

    def __iter__(self):
        self._check()
        return super().__iter__()

    def __array_ufunc__(self, ufunc, method, *inputs, out=None, **options):
        if out is not None:
            options["out"] = tuple(array._writable() if isinstance(array, Field) else array for array in out)
        result = getattr(ufunc, method)(*(ordinary(array) for array in inputs), **options)
        return out[0] if out is not None and len(out) == 1 else result

    def __array_function__(self, function, types, arguments, options):
        return function(*ordinary_all(arguments), **{name: ordinary_all(value) for name, value in options.items()})

    def fill(self, value):
        self._writable().fill(value)

    def __repr__(self):
        return repr(ordinary(self))

    def __reduce__(self):
        return ordinary(self).copy().__reduce__()

    def copy(self, order="C"):
        return np.array(ordinary(self), order=order)


def ordinary(array):
    if not isinstance(array, Field):
        return array
    array._check()
    return array.view(np.ndarray)


def ordinary_all(value):
    if isinstance(value, (list, tuple)):
        return type(value)(ordinary_all(inner) for inner in value)
    return ordinary(value)
