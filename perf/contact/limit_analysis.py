"""Limit analysis: do tractions on the fractures exist that balance the loads on every block?

Blocks are taken as rigid. Tractions are constant on each face of a fracture, compressive, and within the
friction cone. Prescribed displacements can transmit any force. Let m be a rigid motion of one block that the
supports permit, [[m]] its jump and A the area of a face. By virtual work, for every m,

    sum over faces  A lambda . [[m]]  =  work of body forces, boundary tractions and fluid pressures on m.

With a cone of finitely many edges this is a linear programme. It is exact in 2D. In 3D the cone has EDGES edges
inside the friction cone, so that tractions found this way are admissible. The check uses nothing of the solver
and depends neither on elasticity nor on the load path: without such tractions there is no equilibrium."""
import math
import re
from pathlib import Path

import numpy as np
from scipy.optimize import linprog

from perf.contact import rigid_pieces
import violation

EDGES = 32
FUNCTIONS = {name: getattr(math, name) for name in ("sin", "cos", "exp", "sqrt", "pi")} | {"min": min, "max": max}


class Loads:
    """Expressions of a scene for its loads."""

    def __init__(self, input_):
        self.input = input_
        self.tables = {name: self._table(name) for name in input_.names("Tables")}

    def _table(self, name):
        points, values = (self.input.numbers("Tables", name, entry) for entry in ("arguments", "values"))
        return lambda t: float(np.interp(t, points, values))

    def texts(self, *path):
        """Returns the expressions of an entry, one per direction; an empty list if the entry is missing."""
        text = (self.input.text(*path) or "").strip().strip("{}")
        return [word.strip() for word in re.split(r",(?![^(]*\))", text)] if text else []

    def values(self, texts, place, time):
        names = {**FUNCTIONS, **self.tables, **dict(zip("xyz", place)), "t": time}
        return np.array([float(eval(text.replace("^", "**"), {"__builtins__": {}}, names)) for text in texts])


class Motions:
    """Rigid motions of each block that the supports permit, numbered block after block."""

    def __init__(self, rock, parts, loads):
        dim = rock.points.shape[1]
        weights = np.bincount(parts.of_cell, rock.volumes)
        self.centres = np.stack([np.bincount(parts.of_cell, rock.volumes * rock.centres[:, i]) / weights for i in range(dim)], -1)
        self.length = np.ptp(rock.points, axis=0).max()
        self.free = [null_space(rows, dim * (dim + 1) // 2) for rows in self._held(rock, parts, loads)]
        self.start = np.cumsum([0] + [basis.shape[1] for basis in self.free])

    def _held(self, rock, parts, loads):
        """For each block, the rows of rigid motions at the prescribed displacement components of its nodes."""
        held, components = [[] for _ in range(parts.count)], {}
        for name in loads.input.names("Boundary conditions"):
            fixed = [i for i, text in enumerate(loads.texts("Boundary conditions", name, "displacement")) if text != "free"]
            fixed += [i for i, text in enumerate(loads.texts("Boundary conditions", name, "foundation stiffness")) if float(text) > 0]
            components.setdefault(loads.input.text("Boundary conditions", name, "boundary"), []).extend(fixed)
        for face in parts.boundaries:
            for i in components.get(face.name, ()):
                held[face.pieces[0]] += [self.rigid(face.pieces[0], rock.points[node])[i] for node in face.nodes]
        return held

    @property
    def count(self):
        return self.start[-1]

    def rigid(self, piece, place):
        """Displacements [dim, motions] of a point under translations and rotations about the centre of the block."""
        x = (place - self.centres[piece]) / self.length
        turns = [[-x[1]], [x[0]]] if len(x) == 2 else [[0, x[2], -x[1]], [-x[2], 0, x[0]], [x[1], -x[0], 0]]
        return np.hstack([np.eye(len(x)), turns])

    def work(self, piece, place, forces):
        """Work [all motions, n] of forces [dim, n] on a block."""
        rows = np.zeros((self.count, forces.shape[1]))
        rows[self.start[piece]:self.start[piece + 1]] = (self.rigid(piece, place) @ self.free[piece]).T @ forces
        return rows


def null_space(rows, size):
    if not rows:
        return np.eye(size)
    _, values, directions = np.linalg.svd(rows)
    return directions[(values > 1e-9 * values.max()).sum():].T


def cone(normal, friction):
    """Edges [dim, edges] of the cone of tractions on side -, with the normal from side - to side +."""
    dim = len(normal)
    if dim == 2:
        tangent = np.array([normal[1], -normal[0]])
        return np.stack([-normal + s * friction * tangent for s in (-1, 1)], -1)
    first = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    first /= np.linalg.norm(first)
    angles = 2 * np.pi * np.arange(EDGES) / EDGES
    return -normal[:, None] + friction * (np.outer(first, np.cos(angles)) + np.outer(np.cross(normal, first), np.sin(angles)))


def given_forces(rock, parts, loads, time):
    """Yields (block, place, force) of body forces, boundary tractions and fluid pressures."""
    input_ = loads.input
    body = loads.texts("Bulk", "body force")
    for piece, volume, place in zip(parts.of_cell, rock.volumes, rock.centres) if body else ():
        yield piece, place, volume * loads.values(body, place, time)
    for name in input_.names("Boundary conditions"):
        traction = loads.texts("Boundary conditions", name, "traction")
        for face in parts.boundaries if traction else ():
            if face.name == input_.text("Boundary conditions", name, "boundary"):
                yield face.pieces[0], face.centre, face.area * loads.values(traction, face.centre, time)
    for face in parts.fractures:
        pressure, = loads.values([input_.text("Fractures", face.name, "fluid pressure") or "0"], face.centre, time)
        for sign, piece in zip((-1, 1), face.pieces):
            yield piece, face.centre, sign * pressure * face.area * face.normal


def admissible(input_, rock, time):
    """True if tractions in balance with the loads of the scene at `time` exist."""
    names, loads = input_.names("Fractures"), Loads(input_)
    parts = rigid_pieces.pieces(rock, names)
    motions = Motions(rock, parts, loads)
    forces = [force for force in given_forces(rock, parts, loads, time) if force[2].any()]
    if not motions.count or not forces:
        return True
    given = sum(motions.work(piece, place, force[:, None]) for piece, place, force in forces)
    given /= max(np.linalg.norm(force) for *_, force in forces)
    friction = dict(zip(names, (law.min_friction for law in input_.laws)))
    columns = [np.zeros((motions.count, 1))]
    for face in parts.fractures:
        if face.pieces[0] != face.pieces[1]:
            edges = cone(face.normal, friction[face.name])
            columns.append(motions.work(face.pieces[0], face.centre, edges) + motions.work(face.pieces[1], face.centre, -edges))
    matrix = np.hstack(columns)
    # Least sum of loads that remain without balance. In contrast to the question of feasibility, HiGHS also solves this
    # programme with nearly dependent rows.
    rest = np.eye(motions.count)
    costs = np.concatenate([np.zeros(matrix.shape[1]), np.ones(2 * motions.count)])
    found = linprog(costs, A_eq=np.hstack([matrix, rest, -rest]), b_eq=-given[:, 0], method="highs")
    if found.status == 0:
        return bool(found.fun <= 1e-7 * np.abs(given).sum())
    raise RuntimeError(f"the linear programme could not be solved: {found.message}")


def of_scene(path, time):
    """Calls admissible() for a scene file with a box, or with a mesh from apps/mesh."""
    input_ = violation.Input(path)
    mesh = input_.text("Mesh file", "path")
    return admissible(input_, rigid_pieces.simplices(Path(path).parent / mesh) if mesh else rigid_pieces.box(input_), time)
