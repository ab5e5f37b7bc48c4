"""Errors of poroelastic results at the centres of cells and faces, where finite volume methods have their
unknowns.

The norm is discrete: values at centres are weighted by the volumes of cells, or of the pyramids from a face to
the centres of its cells."""
from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from perf.verification import flow_measure
from perf.verification.measure import CELLS, SIMPLICES, face_means, relative

FACES = {3: [(0, 1), (1, 2), (2, 0)], (2, 4): [(0, 1), (1, 2), (2, 3), (3, 0)], (3, 4): [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)],
         8: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}
LOCAL = {9: [(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)],
         12: [(0.5, 0.5, 0), (0.5, 0.5, 1), (0.5, 0, 0.5), (1, 0.5, 0.5), (0.5, 1, 0.5), (0, 0.5, 0.5)]}


@dataclass
class Sides:
    """Pairs of a cell and one of its faces."""
    cell: np.ndarray
    face: np.ndarray    # number of the face, equal on both sides
    area: np.ndarray    # outward area vectors [side, d]
    centre: np.ndarray  # [side, d]
    away: np.ndarray    # distance of the face from the cell centre
    copies: np.ndarray  # number of cells at the face
    corners: np.ndarray  # [side, corner, d]

    def mean(self, values):
        """Mean over the sides of the face, at each side."""
        shape = (self.face.max() + 1, *values.shape[1:])
        sums = np.zeros(shape)
        np.add.at(sums, self.face, values)
        return sums[self.face] / self.copies.reshape(-1, *[1] * (values.ndim - 1))


def corner_numbers(run):
    """Corner nodes of cells, [cell, corner]."""
    return vtk_to_numpy(run.rock.GetCells().GetConnectivityArray()).reshape(run.rock.GetNumberOfCells(), -1)[:, :n_corners(run)]


def n_corners(run):
    kind = run.rock.GetCellType(0)
    return run.dimension + 1 if kind in SIMPLICES else 2**run.dimension


def sides_of(run):
    """Returns the sides of all cells. Nodes shared by pieces of the mesh occur in every piece and are merged."""
    points, place = np.unique(vtk_to_numpy(run.rock.GetPoints().GetData())[:, :run.dimension], axis=0, return_inverse=True)
    nodes, d = place.ravel()[corner_numbers(run)], run.dimension
    n = nodes.shape[1]
    lists = FACES.get(n) or FACES[d, n]
    faces = np.stack([nodes[:, list(local)] for local in lists], axis=1)  # [cell, face, corner]
    number, copies = np.unique(np.sort(faces.reshape(-1, faces.shape[2]), axis=1), axis=0, return_inverse=True, return_counts=True)[1:]
    at = points[faces].reshape(len(number), faces.shape[2], d)
    cell = np.repeat(np.arange(len(nodes)), len(lists))
    centre, middle = at.mean(axis=1), points[nodes].mean(axis=1)[cell]
    a, b = at[:, 1] - at[:, 0], at[:, -1] - at[:, 0]
    area = np.stack([a[:, 1], -a[:, 0]], axis=1) if d == 2 else np.cross(a, b) / (2 if faces.shape[2] == 3 else 1)
    area *= np.sign((area * (centre - middle)).sum(axis=1))[:, None]
    number = number.ravel()
    return Sides(cell, number, area, centre, ((centre - middle) * area).sum(axis=1) / np.linalg.norm(area, axis=1), copies[number], at)


def moments(run):
    """Mean of |x - centre|^2 over simplices."""
    at = flow_measure.corners(run)[:, :run.dimension + 1]
    d = run.dimension
    return ((at - at.mean(axis=1)[:, None])**2).sum(axis=(1, 2)) / ((d + 1) * (d + 2))


def outflows(run, known, sides):
    """Returns (outflow of the cell through each side, pressure on it), for the schemes rt0 and tpfa.

    Both follow from pressures and mean velocities of cells: the pressure on a face is equal on both sides, and
    known on the boundary."""
    p, size = flow_measure.array(run, "pressure")[sides.cell], np.linalg.norm(sides.area, axis=1)
    m, d = known.mobility, run.dimension
    inside = sides.copies == 2
    if run.rock.GetCellType(0) not in SIMPLICES:
        trace = np.where(inside, sides.mean(p), known.pressure(sides.centre))
        return m * size * (p - trace) / sides.away, trace
    v = flow_measure.array(run, "Darcy velocity")[:, :d][sides.cell]
    middle = flow_measure.corners(run)[:, :d + 1].mean(axis=1)[sides.cell]
    weight = (moments(run) / (d * m))[sides.cell]  # coefficient of div q/d in the pressure drop towards a face
    falls, passes = p - (v * (sides.centre - middle)).sum(axis=1) / m, (v * sides.area).sum(axis=1) / size
    gap, sum_of = 2 * (falls - sides.mean(falls)), 2 * sides.mean(passes)  # difference and sum over both sides
    other_weight, other_away = 2 * sides.mean(weight) - weight, 2 * sides.mean(sides.away) - sides.away
    within = (gap * other_away - sum_of * other_weight) / (weight * other_away + sides.away * other_weight)
    growth = np.where(inside, within, (falls - known.pressure(sides.centre)) / weight)  # div q/d
    return size * (passes + growth * sides.away), falls - weight * growth


def stress_at(run, known, sides):
    """Effective stress of the rock at the centres of sides, from the displacement in the cell."""
    kind, d = run.rock.GetCellType(0), run.dimension
    cell, n = CELLS[kind](), run.rock.GetCell(0).GetNumberOfPoints()
    nodes = vtk_to_numpy(run.rock.GetCells().GetConnectivityArray()).reshape(-1, n)
    points, u = (vtk_to_numpy(a)[:, :d] for a in (run.rock.GetPoints().GetData(), run.rock.GetPointData().GetArray("displacement")))
    slopes, n_faces = np.empty((len(sides.cell), d, d)), len(sides.cell) // len(nodes)
    for k in range(n_faces):
        here, derivatives = slice(k, None, n_faces), [0.0] * (n * d)
        cell.InterpolateDerivs([*local_centre(kind, d, k), *[0.0] * (3 - d)], derivatives)
        table = np.reshape(derivatives, (d, n))
        jacobian = np.einsum("ka,cai->cki", table, points[nodes])
        slopes[here] = np.einsum("cai,cjk,ka->cij", u[nodes], np.linalg.inv(jacobian), table)
    return known.G * (slopes + slopes.transpose(0, 2, 1)) + known.lam * np.trace(slopes, axis1=1, axis2=2)[:, None, None] * np.eye(d)


def local_centre(kind, d, k):
    if kind not in SIMPLICES:
        return LOCAL[9 if d == 2 else 12][k]
    corners = np.vstack([np.zeros(d), np.eye(d)])
    return corners[list(FACES[3 if d == 2 else (3, 4)][k])].mean(axis=0)


def centre_errors(run, known):
    """Relative errors: pressure and displacement at cell centres, flow and force at face centres, flow through
    faces (`through`).

    The force is the mean of the values from both cells."""
    sides, d = sides_of(run), run.dimension
    _, volumes = flow_measure.cell_points(run)
    volume, middle = volumes.sum(axis=1), flow_measure.corners(run)[:, :n_corners(run)].mean(axis=1)
    p, exact_p = flow_measure.array(run, "pressure"), known.pressure(middle)
    u, exact_u = np.stack([centre_value(run, k) for k in range(d)], axis=1), known.displacement(middle)
    weights = np.linalg.norm(sides.area, axis=1) * sides.away / d  # both sides of a face count, with the same value
    flow, trace = outflows(run, known, sides)
    flow = flow[:, None]
    velocities = known.velocity(sides.centre), face_means(known.velocity, sides.corners)
    exact_flow, mean_flow = ((velocity * sides.area).sum(axis=1)[:, None] for velocity in velocities)
    total = sides.mean(stress_at(run, known, sides) - known.alpha * trace[:, None, None] * np.eye(d))
    force, exact_force = (np.einsum("sij,sj->si", of, sides.area) for of in (total, known.stress(sides.centre)))
    return {"pressure": relative((p - exact_p)[:, None], exact_p[:, None], volume),
            "flow": relative(flow - exact_flow, exact_flow, weights),
            "u": relative(u - exact_u, exact_u, volume), "force": relative(force - exact_force, exact_force, weights),
            "through": relative(flow - mean_flow, mean_flow, weights)}


def centre_value(run, component):
    """Displacement component at the cell centres."""
    kind, d, n = run.rock.GetCellType(0), run.dimension, run.rock.GetCell(0).GetNumberOfPoints()
    shape = [0.0] * n
    CELLS[kind]().InterpolateFunctions([*([1 / (d + 1)] * d if kind in SIMPLICES else [0.5] * d), *[0.0] * (3 - d)], shape)
    nodes = vtk_to_numpy(run.rock.GetCells().GetConnectivityArray()).reshape(-1, n)
    return vtk_to_numpy(run.rock.GetPointData().GetArray("displacement"))[:, component][nodes] @ np.array(shape)
