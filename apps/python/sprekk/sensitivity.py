"""Derivatives of a quantity with respect to entries of a scene, by an adjoint solve."""
import numpy as np

from . import _sprekk
from .model import Model

STEP = 1e-6  # relative increment of central differences of the residual


def sensitivities(model, t, quantity, parameters):
    """Computes the step to t, s. Returns q = quantity(x) and {parameter: dq/dparameter} for the unknowns x at its end.

    The state at the beginning of the step is fixed. With the equations R(x, m) = 0 of the step and A = dR/dx:
        A^T y = (dq/dx)^T,   dq/dm = - y . dR/dm.
    A is the Jacobian of Newton's method. One sparse solve on rank 0 gives y for all parameters. dR/dm is a central
    difference of R at fixed x, without further solves. Collective.

    quantity    function of {unknown: values [entity, component] of the whole mesh, in the order of the unknowns};
                returns q and {unknown: dq/dvalues}. Called on rank 0 only
    parameters  paths of numerical entries, "Materials.rock.Young's modulus"; for lists (path, index)"""
    if model._made_with["given_pressure"] is not None:
        raise _sprekk.Error("a pressure imposed from outside is not an entry of the scene: its contribution to derivatives is unknown")
    begin, before = model.time, {name: np.array(model.field(name)) for name in model.fields}
    model.step(t)
    names = model._handle.blocks()
    x = [np.array(model.field(name)) for name in names]

    def twin(scene):
        """Returns a model of another scene in the state at the beginning of the step."""
        other = Model(scene, model.comm, **model._made_with)
        for name, values in before.items():
            other.field(name)[:] = values
        return other

    rows, columns, entries, n, owned = twin(model.scene)._handle.jacobian_at(x, t, t - begin)
    value, right = _quantity(model, names, x, owned, n, quantity)
    y = _adjoint(model.comm, rows, columns, entries, n, right)
    found = {}
    for parameter in parameters:
        path, index = parameter if isinstance(parameter, tuple) else (parameter, None)
        present = _entry(model.scene, path)
        number = present if index is None else present[index]
        h = STEP * (abs(number) or 1)
        residuals = []
        for sign in (1, -1):
            changed = number + sign * h
            if index is not None:
                changed = [*present[:index], changed, *present[index + 1:]]
            residuals.append(twin(model.scene.changed({path: changed}, model.comm))._handle.residual_at(x, t, t - begin))
        here = -sum(y[ids] @ (plus - minus) for ids, plus, minus in zip(owned, *residuals)) / (2 * h)
        found[parameter] = model.comm.allreduce(here)
    return value, found


def _entry(scene, path):
    """Returns the number, or the list of numbers, of an entry."""
    entries, rest = scene.all_entries, path
    while isinstance(entries, dict):
        name = max((name for name in entries if rest == name or rest.startswith(name + ".")), key=len, default=None)
        if name is None:
            raise _sprekk.Error(f'the scene has no entry "{path}"')
        entries, rest = entries[name], rest[len(name) + 1:]
    numbers = entries if isinstance(entries, list) else [entries]
    try:
        return [float(number) for number in numbers] if isinstance(entries, list) else float(entries)
    except (TypeError, ValueError):
        raise _sprekk.Error(f'the entry "{path}" is {entries!r}, derivatives are with respect to numbers') from None


def _quantity(model, names, x, owned, n, quantity):
    """Returns q on all ranks, and dq/dx on rank 0."""
    comm, fields = model.comm, model.fields
    parts = comm.gather((x, owned))
    value = right = None
    error = None
    if parts is not None:
        whole, place = np.zeros(n), {}
        for values, ids in parts:
            for block, block_ids in zip(values, ids):
                whole[block_ids] = block.ravel()
        for b, name in enumerate(names):
            ids = np.sort(np.concatenate([ids[b] for _, ids in parts]))
            place[name] = ids.reshape(-1, fields[name][1])
        try:
            value, gradient = quantity({name: whole[ids] for name, ids in place.items()})
            right = np.zeros(n)
            for name, derivative in gradient.items():
                right[place[name]] += derivative
        except Exception as raised:  # caught, since the other ranks wait in bcast
            error = f"{type(raised).__name__}: {raised}"
    error, value = comm.bcast((error, value))
    if error:
        raise _sprekk.Error(f"the quantity: {error}")
    return value, right


def _adjoint(comm, rows, columns, entries, n, right):
    """Returns the solution y of A^T y = right, on all ranks."""
    parts = comm.gather((rows, columns, entries))
    y = None
    if parts is not None:
        from scipy.sparse import coo_matrix, diags
        from scipy.sparse.linalg import splu
        rows, columns, entries = (np.concatenate(part) for part in zip(*parts))
        A = coo_matrix((entries, (rows, columns)), (n, n)).tocsc()
        # scale rows and columns, since their units differ
        by_row = 1 / np.maximum(abs(A).max(axis=1).toarray().ravel(), 1e-300)
        A = diags(by_row) @ A
        by_column = 1 / np.maximum(abs(A).max(axis=0).toarray().ravel(), 1e-300)
        A = (A @ diags(by_column)).tocsc()
        y = by_row * splu(A).solve(by_column * right, trans="T")
    return comm.bcast(y)
