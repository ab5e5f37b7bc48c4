"""Runs a scene and measures its results against exact functions, from the output files of the run."""
import math
from dataclasses import dataclass

import numpy as np
import vtkmodules.vtkCommonDataModel as vtk
from vtkmodules.util.numpy_support import vtk_to_numpy

import read

from perf.common import program

TIME_LIMIT = 900  # seconds per run
CELLS = {5: vtk.vtkTriangle, 9: vtk.vtkQuad, 10: vtk.vtkTetra, 12: vtk.vtkHexahedron, 22: vtk.vtkQuadraticTriangle,
         28: vtk.vtkBiQuadraticQuad, 24: vtk.vtkQuadraticTetra, 29: vtk.vtkTriQuadraticHexahedron}
SIMPLICES = {5: 2, 22: 2, 10: 3, 24: 3}
GAUSS = 5  # points per direction


def cube_rule(dimension, points=GAUSS):
    """Gauss points [q, dimension] and weights [q] of [0, 1]^dimension."""
    if dimension == 0:
        return np.zeros((1, 0)), np.ones(1)
    x, w = np.polynomial.legendre.leggauss(points)
    grid = np.meshgrid(*[(x + 1) / 2] * dimension, indexing="ij")
    weights = np.meshgrid(*[w / 2] * dimension, indexing="ij")
    return np.stack([g.ravel() for g in grid], axis=1), np.prod([g.ravel() for g in weights], axis=0)


def simplex_rule(dimension, points=GAUSS):
    """Points and weights of the simplex x1 + x2 (+ x3) <= 1, from the rule of the cube by collapsed coordinates."""
    x, w = cube_rule(dimension, points)
    placed, left = np.empty_like(x), np.ones(len(x))
    for k in range(dimension):
        placed[:, k] = x[:, k] * left
        w = w * left
        left = left - placed[:, k]
    return placed, w


@dataclass
class Run:
    results: dict
    rock: object        # VTK grid
    faces: object       # read.Surface: points, polygons, cell_data; None without fractures
    dimension: int

    def corners(self):
        """Corners of fracture faces, [face, corner, coordinates], without the nodes of order 2."""
        sizes = {2: 2, 3: 2} if self.dimension == 2 else {3: 3, 6: 3, 4: 4, 9: 4}
        polygons = [cell[:sizes[len(cell)]] for cell in self.faces.polygons]
        return self.faces.points[np.array(polygons)][:, :, :self.dimension]

    def on(self, name):
        """Mask of the faces of a fracture; the array "fracture" numbers fractures in the order of names."""
        names = sorted(self.results["steps"][-1]["fractures"])
        return self.faces.cell_data["fracture"] == names.index(name)

    def data(self, name):
        return self.faces.cell_data[name]

    def unknowns(self, prescribed):
        """Number of unknowns of the linear system, without eliminated blocks and prescribed displacements."""
        system = program.Run(results=self.results).system
        if prescribed is None:
            return system
        points, values = vtk_to_numpy(self.rock.GetPoints().GetData()), self.rock.GetPointData().GetArray("displacement")
        if self.results["ranks"] > 1:  # shared nodes occur in every piece; the two sides of a fracture differ
            points = np.unique(np.hstack([points, vtk_to_numpy(values)]), axis=0)
        return system - prescribed(points[:, :self.dimension])

    @property
    def seconds(self):
        """Time for assembly and solution: time steps and solver set-up, without the evaluation of loads (here long
        expressions)."""
        timing = {name: phase["seconds"] for name, phase in self.results["timing"].items()}
        return timing["time_steps"] + timing["set-up_of_the_solver"] - timing["loads"]


def start(binary, scene, sets, directory, ranks=1):
    """Runs a scene with the entries `sets`; returns the last step. Raises Failed if the run fails."""
    results = program.succeeded(binary, scene, directory, sets, ranks, clock=TIME_LIMIT).results
    rock = read.grid(read.written_steps(directory, "bulk")[-1][1])
    written = read.written_steps(directory, "fractures")
    faces = read.segments(read.grid(written[-1][1])) if written else None
    return Run(results, rock, faces, results["mesh"]["dimension"])


def relative(error, reference, weights):
    """Returns |error|/|reference| in L2; values [..., components] at points with weights [...]."""
    return float(np.sqrt((weights * (error**2).sum(-1)).sum() / (weights * (reference**2).sum(-1)).sum()))


def displacement_error(run, exact):
    """Relative L2 error of the displacement in bulk.vtu, without face bubbles and tip functions."""
    kind, d = run.rock.GetCellType(0), run.dimension
    cell = CELLS[kind]()
    nodes = vtk_to_numpy(run.rock.GetCells().GetConnectivityArray()).reshape(run.rock.GetNumberOfCells(), -1)
    points = vtk_to_numpy(run.rock.GetPoints().GetData())[:, :d]
    values = vtk_to_numpy(run.rock.GetPointData().GetArray("displacement"))[:, :d]
    rule, weights = simplex_rule(d) if kind in SIMPLICES else cube_rule(d)
    n, error, size = nodes.shape[1], 0.0, 0.0
    for x, w in zip(rule, weights):
        shape, slopes = [0.0] * n, [0.0] * (n * d)
        place = [*x, *[0.0] * (3 - d)]
        cell.InterpolateFunctions(place, shape)
        cell.InterpolateDerivs(place, slopes)
        jacobian = np.einsum("ka,cai->cki", np.reshape(slopes, (d, n)), points[nodes])
        volume = w * np.abs(np.linalg.det(jacobian))
        known = exact.displacement(np.einsum("a,cai->ci", shape, points[nodes]))[:, :d]
        away = np.einsum("a,cai->ci", shape, values[nodes]) - known
        error, size = error + (volume * (away**2).sum(1)).sum(), size + (volume * (known**2).sum(1)).sum()
    return float(np.sqrt(error / size))


def tip_rule(dimension, tips, points=GAUSS):
    """Points and weights on the reference simplex for functions of the square root of the distance from its first
    `tips` corners."""
    corners = np.vstack([np.zeros(dimension), np.eye(dimension)])
    s, w = cube_rule(1, points)
    (a, wa), (b, wb) = simplex_rule(tips - 1, points), simplex_rule(dimension - tips, points)
    first, second = (np.column_stack([1 - x.sum(axis=1), x]) for x in (a, b))
    rho = s[:, 0]**2
    placed = (1 - rho)[:, None, None, None] * (first @ corners[:tips])[None, :, None] + rho[:, None, None, None] * (second @ corners[tips:])[None, None]
    weights = (2 * s[:, 0] * w * rho**(dimension - tips) * (1 - rho)**(tips - 1))[:, None, None] * wa[None, :, None] * wb[None, None]
    return placed.reshape(-1, dimension), weights.ravel()


def tips_of(run):
    """Mask of the rock nodes that are tips with enrichment functions around them (order 1).

    These nodes belong to fractures, are shared by both sides and have no enrichment coefficients of their own."""
    points, u, q = (vtk_to_numpy(run.rock.GetPoints().GetData() if name == "points" else run.rock.GetPointData().GetArray(name))
                    for name in ("points", "displacement", "tip displacement"))
    values, last = np.unique(np.hstack([points, u]), axis=0), run.faces.points[np.unique(np.concatenate(run.faces.polygons))]
    places, copies = np.unique(values[:, :3], axis=0, return_counts=True)
    whole = {place.tobytes() for place in places[copies == 1]} & {place.tobytes() for place in last}
    return np.array([place.tobytes() in whole for place in points]) & ~q.any(axis=1)


def gradient(exact, points, step=1e-9):
    """Gradient of an exact displacement by central differences, [point, i, j]."""
    d = points.shape[1]
    return np.stack([(exact.displacement(points + step * e)[:, :d] - exact.displacement(points - step * e)[:, :d]) / (2 * step)
                     for e in np.eye(d)], axis=2)


def energy(error, exact):
    """Twice the strain energy density of a displacement gradient [..., i, j]."""
    strain = (error + np.swapaxes(error, -1, -2)) / 2
    return 2 * exact.G * (strain**2).sum((-1, -2)) + exact.lam * np.trace(strain, axis1=-2, axis2=-1)**2


def stress_error(run, exact):
    """Squared energy norm of the stress error, [cell], by quadrature of the displacement in bulk.vtu with tip
    functions."""
    kind, d = run.rock.GetCellType(0), run.dimension
    cell, n = CELLS[kind](), run.rock.GetCell(0).GetNumberOfPoints()
    nodes = vtk_to_numpy(run.rock.GetCells().GetConnectivityArray()).reshape(-1, n)
    points, u = (vtk_to_numpy(a)[:, :d] for a in (run.rock.GetPoints().GetData(), run.rock.GetPointData().GetArray("displacement")))
    tip = np.zeros(nodes.shape, dtype=bool)
    if run.rock.GetPointData().HasArray("tip displacement"):
        q, tip = vtk_to_numpy(run.rock.GetPointData().GetArray("tip displacement"))[:, :d], tips_of(run)[nodes]
        order = np.argsort(~tip, axis=1, kind="stable")  # tips first: the order of corners in a simplex is arbitrary
        nodes, tip = np.take_along_axis(nodes, order, 1), np.take_along_axis(tip, order, 1)
    square = np.zeros(len(nodes))
    for tips in np.unique(tip.sum(axis=1)):
        here = tip.sum(axis=1) == tips
        of = nodes[here]
        rule, weights = tip_rule(d, tips) if tips else simplex_rule(d) if kind in SIMPLICES else cube_rule(d)
        for x, w in zip(rule, weights):
            shape, slopes = [0.0] * n, [0.0] * (n * d)
            cell.InterpolateFunctions([*x, *[0.0] * (3 - d)], shape)
            cell.InterpolateDerivs([*x, *[0.0] * (3 - d)], slopes)
            jacobian = np.einsum("ka,cai->cki", np.reshape(slopes, (d, n)), points[of])
            slope = np.einsum("cik,ka->cai", np.linalg.inv(jacobian), np.reshape(slopes, (d, n)))  # dN_a/dx_i
            computed = np.einsum("cai,caj->cij", u[of], slope)
            if tips:
                rho, fall = sum(shape[tips:]), slope[:, tips:].sum(axis=1)
                psi = slope[:, tips:] * (rho**-0.5 - 1) - 0.5 * rho**-1.5 * np.array(shape[tips:])[:, None] * fall[:, None, :]
                computed += np.einsum("cai,caj->cij", q[of[:, tips:]], psi)
            known = gradient(exact, np.einsum("a,cai->ci", shape, points[of]))
            square[here] += w * np.abs(np.linalg.det(jacobian)) * energy(computed - known, exact)
    return square


def effectivity(run, means, exact):
    """Estimated error divided by the true error: of jumps, and of stress if its exact value is known."""
    estimate, size = run.results["steps"][-1]["error_estimate"], area(run.corners())
    error = float(np.sqrt((size * ((run.data("jump")[:, :run.dimension] - means)**2).sum(axis=1)).sum()))
    found = {"jump": estimate["jump"].get("norm", math.nan) / error}
    if hasattr(exact, "displacement"):
        found["stress"] = estimate["stress"]["energy_norm"] / float(np.sqrt(stress_error(run, exact).sum()))
    return found


def face_points(corners, points=GAUSS):
    """Quadrature points [face, q, d] and weights [face, q] of segments, triangles and parallelograms.

    The weights of a face sum to its area."""
    n, d = corners.shape[1:]
    x, w = simplex_rule(2, points) if n == 3 else cube_rule(n // 2, points)
    if n == 4:
        shape = np.stack([(1 - x[:, 0]) * (1 - x[:, 1]), x[:, 0] * (1 - x[:, 1]), x[:, 0] * x[:, 1], (1 - x[:, 0]) * x[:, 1]], axis=1)
    else:
        shape = np.column_stack([1 - x.sum(axis=1), x])
    placed = np.einsum("qa,fai->fqi", shape, corners)
    if n == 2:
        area = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    else:  # parallelograms and triangles
        a, b = corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0]
        area = np.linalg.norm(np.cross(a, b), axis=1)
    return placed, area[:, None] * w


def area(corners):
    return face_points(corners)[1].sum(axis=1)


def face_means(function, corners, points=GAUSS):
    x, w = face_points(corners, points)
    values = function(x.reshape(-1, x.shape[2])).reshape(*x.shape[:2], -1)
    return (w[:, :, None] * values).sum(axis=1) / w.sum(axis=1)[:, None]


def jump_error(run, means):
    """Relative L2 error of the face-mean jump; `means` [face, d] are exact, in global components."""
    return relative(run.data("jump")[:, :run.dimension] - means, means, area(run.corners()))


def traction_errors(run, exact, tangents, points=8):
    """Relative errors (in L2, at face centres) of the traction, with normal and tangential components.

    `tangents` [d - 1, d] are the directions of the tangential components of exact.traction."""
    corners = run.corners()
    local, world = run.data("traction local"), run.data("traction")[:, :run.dimension]
    computed = np.column_stack([local[:, 0], world @ np.transpose(tangents)])
    x, w = face_points(corners, points)
    known = exact.traction(x.reshape(-1, x.shape[2])).reshape(*x.shape[:2], -1)
    centre = exact.traction(corners.mean(axis=1))
    return relative(computed[:, None, :] - known, known, w), relative(computed - centre, centre, w.sum(axis=1))
