"""States written by a run, as arrays: cells, fracture faces, and the volumes swept by the faces of cells."""
import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

import read

SIMPLEX = {5: 2, 22: 2, 10: 3, 24: 3}  # VTK type: dimension; all others are parallelepipeds
DIMENSION = {5: 2, 22: 2, 9: 2, 28: 2, 10: 3, 24: 3, 12: 3, 29: 3}
# VTK type: for each face, its corners by their numbers in the cell, then its other nodes.
EDGES = {5: ((0, 1), (1, 2), (2, 0)), 9: ((0, 1), (1, 2), (2, 3), (3, 0)),
         22: ((0, 1, 3), (1, 2, 4), (2, 0, 5)), 28: ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))}
FACES = {10: ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)),
         24: ((0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (2, 0, 3, 6, 7, 9), (0, 2, 1, 6, 5, 4)),
         12: ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)),
         29: ((0, 4, 7, 3, 16, 15, 19, 11, 20), (1, 2, 6, 5, 9, 18, 13, 17, 21), (0, 1, 5, 4, 8, 17, 12, 16, 22),
              (3, 7, 6, 2, 19, 14, 18, 10, 23), (0, 3, 2, 1, 11, 10, 9, 8, 24), (4, 5, 6, 7, 12, 13, 14, 15, 25))}
# (nodes of a face, dimension): integrals of the shape functions over a face of area 1.
WEIGHTS = {(2, 2): (1 / 2, 1 / 2), (3, 2): (1 / 6, 1 / 6, 2 / 3), (3, 3): (1 / 3,) * 3, (6, 3): (0,) * 3 + (1 / 3,) * 3,
           (4, 3): (1 / 4,) * 4, (9, 3): (1 / 36,) * 4 + (1 / 9,) * 4 + (4 / 9,)}


@dataclass
class Grid:
    """Mesh with data. points: [n, 3]; cells: [k] arrays of point numbers; type: VTK type; data of cells and points
    by name."""
    points: np.ndarray
    cells: np.ndarray
    type: int
    cell_data: dict
    point_data: dict

    @classmethod
    def of(cls, file):
        grid = read.grid(file)
        return cls(read.vtk_to_numpy(grid.GetPoints().GetData()), np.array(read.cells(grid.GetCells())),
                   grid.GetCellType(0) if grid.GetNumberOfCells() else 0, read.arrays(grid.GetCellData()),
                   read.arrays(grid.GetPointData()))

    @property
    def dim(self):
        return DIMENSION[self.type]

    @cached_property
    def corners(self):
        """[cell, corner, 3]"""
        n = {5: 3, 22: 3, 10: 4, 24: 4, 9: 4, 28: 4, 12: 8, 29: 8, 3: 2, 21: 2}[self.type]
        return self.points[self.cells[:, :n]]

    @property
    def centres(self):
        return self.corners.mean(axis=1)

    @cached_property
    def sizes(self):
        """Volumes of cells, areas or lengths of faces, with straight edges; quadrilaterals and hexahedra as
        parallelepipeds."""
        x = self.corners
        if self.type in (3, 21):
            return np.linalg.norm(x[:, 1] - x[:, 0], axis=1)
        if self.type in (10, 24, 12, 29):
            third = x[:, 3] if self.type in (10, 24) else x[:, 4]
            last = x[:, 2] if self.type in (10, 24) else x[:, 3]
            edges = np.stack([x[:, 1] - x[:, 0], last - x[:, 0], third - x[:, 0]], axis=1)
            return np.abs(np.linalg.det(edges)) / (6 if self.type in (10, 24) else 1)
        if self.type in (5, 22):
            return np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1) / 2
        return np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 3] - x[:, 0]), axis=1)


class Faces:
    """Faces of all cells; faces between two cells occur twice. nodes [face, k], outward area vectors [face, 3]."""

    def __init__(self, bulk, fracture_centres):
        table = np.array((EDGES | FACES)[bulk.type])
        dim = bulk.dim
        n_corners = 2 if dim == 2 else 3 if bulk.type in SIMPLEX else 4
        self.nodes = bulk.cells[:, table].reshape(-1, table.shape[1])
        self.cell = np.repeat(np.arange(len(bulk.cells)), len(table))
        self.weights = np.array(WEIGHTS[table.shape[1], dim])
        x = bulk.points[self.nodes[:, :n_corners]]
        centres, extent = x.mean(axis=1), np.ptp(bulk.points, axis=0).max()
        if dim == 2:
            along = x[:, 1] - x[:, 0]
            area = np.stack([along[:, 1], -along[:, 0], 0 * along[:, 0]], axis=1)
        else:
            area = np.cross(x[:, 1] - x[:, 0], x[:, -1] - x[:, 0]) / (2 if n_corners == 3 else 1)
        self.area = area * np.sign(((centres - bulk.centres[self.cell]) * area).sum(axis=1))[:, None]
        _, inverse, count = np.unique(np.sort(self.nodes[:, :n_corners], axis=1), axis=0, return_inverse=True, return_counts=True)
        of_fracture = {key: f for f, key in enumerate(rounded(fracture_centres, extent))}
        # fracture face; -1: none
        self.fracture = np.array([of_fracture.get(key, -1) for key in rounded(centres, extent)])
        self.outer = (count[inverse.reshape(-1)] == 1) & (self.fracture < 0)

        regular = x.mean(axis=1) if self.nodes.shape[1] == n_corners else None
        middle = regular if regular is not None else bulk.points[self.nodes[:, n_corners:]].mean(axis=1)
        self.bent = self.outer & (np.linalg.norm(middle - centres, axis=1) > 1e-9 * extent)  # quarter-point nodes

    def beyond_nodes(self, tips):
        """True if the outer boundary has displacements beyond its nodes, at crack tips.

        `tips` contains the coefficients of the tip enrichment at the points, or is None."""
        return bool(self.bent.any()) or tips is not None and bool(np.abs(tips[self.nodes[self.outer]]).any())

    def swept(self, displacement):
        """[face] Volume between a face and its initial place, m^3, to first order."""
        return (np.einsum("k,fki->fi", self.weights, displacement[self.nodes]) * self.area).sum(axis=1)


def rounded(points, extent):
    """Returns integer keys that are equal for points at the same place."""
    return [tuple(key) for key in np.round(np.reshape(points, (-1, 3)) / extent * 1e7).astype(np.int64)]


@dataclass
class State:
    """One written step."""
    time: float
    bulk: Grid
    fractures: Grid


class Written:
    """Output of a run. `entries` contains effective_input.xml as nested dictionaries of texts."""

    def __init__(self, directory, results):
        self.directory, self.results = Path(directory), results
        self.entries = read.scene(directory)
        bulk, fractures = (read.written_steps(directory, kind) for kind in ("bulk", "fractures"))
        files = dict(fractures)
        self.states = [State(t, Grid.of(file), Grid.of(files[t]) if t in files else None) for t, file in bulk]

    @cached_property
    def faces(self):
        first = self.states[0]
        return Faces(first.bulk, first.fractures.centres if first.fractures else [])

    @cached_property
    def fracture_names(self):
        """Fracture names by the number in the array "fracture"."""
        return sorted(name for name, entry in self.entries.get("Fractures", {}).items() if isinstance(entry, dict))

    @cached_property
    def material_names(self):
        """Names of the elastic materials in alphabetical order."""
        return material_names(self.entries)

    def number(self, *path, default=None):
        value = self.entries
        for name in path:
            value = value.get(name, {}) if isinstance(value, dict) else {}
        return number(value, default) if isinstance(value, str) else default

    def text(self, *path, default=""):
        value = self.entries
        for name in path:
            value = value.get(name, {}) if isinstance(value, dict) else {}
        return value if isinstance(value, str) else default

    def value(self, text, t=0.0, x=(0.0, 0.0, 0.0)):
        """Value of an expression of place and time, with the tables of the scene."""
        tables = {name: (lambda a, _t=table: float(np.interp(a, numbers(_t["arguments"]), numbers(_t["values"]))))
                  for name, table in self.entries.get("Tables", {}).items()}
        names = {"x": x[0], "y": x[1], "z": x[2], "t": t, "pi": math.pi, "sin": math.sin, "cos": math.cos, "exp": math.exp}
        return float(eval(text.replace("^", "**"), {"__builtins__": {}}, names | tables))


def number(text, default=None):
    return default if text is None else math.inf if text == "infinite" else float(text)


def numbers(text):
    return [float(word) for word in text.strip("{} ").split(",") if word.strip()]


def material_names(entries):
    return [name for name, entry in sorted(entries.get("Materials", {}).items()) if entry.get("type") == "elastic"]


def parsed(path):
    return xml.parse(path).getroot()
