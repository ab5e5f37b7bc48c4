"""Triangles of the surfaces in the 3D view: of the rock, of fractures, and of traces as bands."""

from dataclasses import dataclass

import bulk
import numpy as np
from read import Surface

MAX_TRIANGLES = 60000  # of each surface; larger surfaces are decimated
SHARPEST = 30  # degrees; edges with larger angles are preserved


@dataclass
class Shape:
    """Triangles of a surface: points (n, 3), corners of triangles (m, 3), and the polygon of each triangle.

    `of_point` are the points of the surface at the points of the shape. A decimated shape has values at the points
    `saved` only, and `full` are the triangles before."""

    points: np.ndarray
    triangles: np.ndarray
    owner: np.ndarray
    of_point: np.ndarray
    saved: np.ndarray = None
    full: np.ndarray = None

    def thinned(self):
        """Returns the shape with at most about MAX_TRIANGLES triangles."""
        if len(self.triangles) <= MAX_TRIANGLES:
            return self
        saved, triangles = decimated(self.points, self.triangles)
        return Shape(self.points[saved], triangles, self.owner, self.of_point, saved, self.triangles)

    def at_points(self, values):
        """Returns values at points of the surface as values at points of the shape."""
        values = values[self.of_point]
        return values if self.saved is None else values[self.saved]

    def of_polygons(self, values):
        """Returns values of polygons: the same values, or means at the points of a decimated shape."""
        if self.saved is None:
            return values
        return means_at_points(len(self.of_point), self.full, values[self.owner])[self.saved]


def of_surface(surface):
    """Returns the shape of a surface of polygons."""
    owner = np.repeat(np.arange(len(surface.polygons)), [len(p) - 2 for p in surface.polygons])
    return Shape(surface.points, bulk.triangles(surface.polygons), owner, np.arange(len(surface.points))).thinned()


def merged(surface):
    """Returns the polygons of a surface with one point at each place; the pieces of ranks have separate points."""
    tolerance = 1e-9 * np.max(np.ptp(surface.points, axis=0))
    places = np.round(surface.points / tolerance)
    _, first, number = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return Surface(surface.points[first], [number.reshape(-1)[p] for p in surface.polygons], surface.cell_data, {})


def of_traces(lines, width):
    """Returns bands for traces, two triangles for each face, slightly above the rock."""
    first, second = (np.array([p[k] for p in lines.polygons]) for k in (0, 1))
    along = lines.points[second] - lines.points[first]
    across = (
        0.5
        * width
        * np.column_stack([-along[:, 1], along[:, 0], 0 * along[:, 0]])
        / np.linalg.norm(along, axis=1)[:, None]
    )
    across[:, 2] = 0
    above = [0, 0, 0.5 * width]
    ends = np.stack(
        [
            lines.points[first] - across,
            lines.points[second] - across,
            lines.points[second] + across,
            lines.points[first] + across,
        ],
        1,
    )
    corner = 4 * np.arange(len(first))[:, None]
    triangles = np.concatenate([corner + [0, 1, 2], corner + [0, 2, 3]], 1).reshape(-1, 3)
    of_point = np.stack([first, second, second, first], 1).ravel()
    return Shape(ends.reshape(-1, 3) + above, triangles, np.repeat(np.arange(len(first)), 2), of_point)


def decimated(points, triangles):
    """Returns the indices of the points of a decimated surface, and its triangles."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkDecimatePro

    data, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells.SetCells(
        len(triangles), numpy_to_vtkIdTypeArray(np.insert(triangles, 0, 3, axis=1).ravel().astype(np.int64), deep=True)
    )
    data.SetPoints(places)
    data.SetPolys(cells)
    number = numpy_to_vtk(np.arange(len(points), dtype=float), deep=True)
    number.SetName("number")
    data.GetPointData().AddArray(number)
    decimate = vtkDecimatePro()
    decimate.SetInputData(data)
    decimate.SetTargetReduction(1 - MAX_TRIANGLES / len(triangles))
    decimate.SetFeatureAngle(SHARPEST)
    decimate.PreserveTopologyOff()
    decimate.Update()
    out = decimate.GetOutput()
    saved = vtk_to_numpy(out.GetPointData().GetArray("number")).astype(int)
    return saved, vtk_to_numpy(out.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def means_at_points(n_points, triangles, values):
    """Returns at each point the mean of the values of the adjacent triangles."""
    corners, total = triangles.ravel(), np.repeat(values, 3)
    count = np.bincount(corners, minlength=n_points)
    return np.bincount(corners, total, minlength=n_points) / np.maximum(count, 1)


def at_places(points, values, places):
    """Returns at each place the mean of the values at the points there."""
    everywhere = np.concatenate([points, places])
    tolerance = 1e-9 * np.max(np.ptp(everywhere, axis=0))
    number = np.unique(np.round(everywhere / tolerance), axis=0, return_inverse=True)[1].reshape(-1)
    count = np.bincount(number[: len(points)], minlength=number.max() + 1)
    total = np.column_stack(
        [np.bincount(number[: len(points)], values[:, k], minlength=number.max() + 1) for k in range(3)]
    )
    return (total / np.maximum(count, 1)[:, None])[number[len(points) :]]
