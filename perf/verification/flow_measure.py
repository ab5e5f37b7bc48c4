"""Errors of flow results relative to exact functions, and pressures along lines, from the output files of a run."""
import math

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from perf.verification.measure import CELLS, SIMPLICES, cube_rule, face_points, relative, simplex_rule

INSIDE = 1e-9  # relative to the cell size: a point on a face belongs to both cells


def array(run, name):
    """Array of the rock cells."""
    return vtk_to_numpy(run.rock.GetCellData().GetArray(name))


def corners(run):
    """Corners of cells, [cell, corner, coordinates]."""
    nodes = vtk_to_numpy(run.rock.GetCells().GetConnectivityArray()).reshape(run.rock.GetNumberOfCells(), -1)
    return vtk_to_numpy(run.rock.GetPoints().GetData())[:, :run.dimension][nodes]


def cell_points(run):
    """Quadrature points [cell, q, d] and weights [cell, q]; the weights of a cell sum to its volume."""
    kind, d = run.rock.GetCellType(0), run.dimension
    cell, at = CELLS[kind](), corners(run)
    placed, volumes = [], []
    for x, w in zip(*(simplex_rule(d) if kind in SIMPLICES else cube_rule(d))):
        shape, slopes = [0.0] * at.shape[1], [0.0] * (at.shape[1] * d)
        cell.InterpolateFunctions([*x, *[0.0] * (3 - d)], shape)
        cell.InterpolateDerivs([*x, *[0.0] * (3 - d)], slopes)
        placed.append(np.einsum("a,cai->ci", shape, at))
        volumes.append(w * np.abs(np.linalg.det(np.einsum("ka,cai->cki", np.reshape(slopes, (d, -1)), at))))
    return np.stack(placed, axis=1), np.stack(volumes, axis=1)


def known_at(function, points):
    """Values of a function at quadrature points, [entity, q, components]."""
    values = function(points.reshape(-1, points.shape[-1]))
    return values.reshape(*points.shape[:-1], -1)


def mean_error(values, function, points, weights, scale=None):
    """Relative L2 error of means over cells or faces; with `scale`, their absolute error divided by the scale."""
    volume = weights.sum(axis=1)
    means = (weights[:, :, None] * known_at(function, points)).sum(axis=1) / volume[:, None]
    return relative(values - means, means if scale is None else np.full_like(means, scale), volume)


def rock_errors(run, exact):
    """Relative L2 errors of mean pressures of cells, and of cell-wise constant velocities."""
    points, weights = cell_points(run)
    velocity = array(run, "Darcy velocity")[:, None, :run.dimension]
    known = known_at(exact.velocity, points)
    return {"pressure": mean_error(array(run, "pressure")[:, None], exact.pressure, points, weights), "velocity": relative(velocity - known, known, weights)}


def fracture_errors(run, exact):
    points, weights = face_points(run.corners())
    flow = run.data("fluid flux")[:, None, :run.dimension]
    known = known_at(exact.flow_in, points)
    inside = mean_error(run.data("fracture pressure")[:, None], exact.pressure_in, points, weights, getattr(exact, "scale", None))
    return {"in fracture": inside, "flow": relative(flow - known, known, weights)}


def normals(run):
    """Unit normals of fracture faces, of either sign."""
    at = run.corners()
    if run.dimension == 2:
        along = at[:, 1] - at[:, 0]
        n = np.stack([-along[:, 1], along[:, 0]], axis=1)
    else:
        n = np.cross(at[:, 1] - at[:, 0], at[:, -1] - at[:, 0])
    return n / np.linalg.norm(n, axis=1)[:, None]


def holding(run):
    """Returns a function of a point that finds the cells containing it; for simplices and parallelepipeds."""
    at, d = corners(run), run.dimension
    ends = {3: (1, 2), 4: (1, 3) if d == 2 else (1, 2, 3), 8: (1, 3, 4)}[at.shape[1]]
    inverse = np.linalg.inv(np.stack([at[:, k] - at[:, 0] for k in ends], axis=2))
    simplex = at.shape[1] == d + 1

    def cells(point):
        local = np.einsum("cki,ci->ck", inverse, point - at[:, 0])
        below = local.min(axis=1) > -INSIDE
        return np.flatnonzero(below & ((local.sum(axis=1) if simplex else local.max(axis=1)) < 1 + INSIDE))
    return cells


def pressure_along(run, places, mobility):
    """Pressures at points [n, d], linear in each cell by its Darcy velocity; the mean at common faces.

    `mobility` is a function that returns permeability/viscosity at cell centres."""
    find, centres = holding(run), corners(run).mean(axis=1)
    slopes = -array(run, "Darcy velocity")[:, :run.dimension] / mobility(centres)[:, None]
    p, values = array(run, "pressure"), []
    for place in places:
        cells = find(place)
        values.append(np.mean(p[cells] + ((place - centres[cells]) * slopes[cells]).sum(axis=1)) if len(cells) else math.nan)
    return np.array(values)


def at_faces(run, faces, side):
    """Cells adjacent to these fracture faces (2D) on the side of the direction `side`, matched by edge midpoints."""
    at, middles = corners(run), run.corners()[faces].mean(axis=1)
    n = at.shape[1]
    edges = np.concatenate([(at[:, k] + at[:, (k + 1) % n]) / 2 for k in range(n)])
    cells = np.tile(np.arange(len(at)), n)
    above = ((at.mean(axis=1)[cells] - edges) @ side) > 0
    edges, cells = edges[above], cells[above]
    return np.array([cells[np.argmin(((edges - middle)**2).sum(axis=1))] for middle in middles])
