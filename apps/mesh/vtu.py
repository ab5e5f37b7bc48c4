"""Converts meshes in the format VTU to that of gmsh, by meshio."""
from pathlib import Path

import msh_file
import numpy as np
from shapes import NetworkError

ENDINGS = (".vtu", ".vtk")
GROUPS = ("group", "physical", "gmsh:physical", "region", "material", "set")  # titles of cell data with numbers of groups
DIMENSION = {"line": 1, "triangle": 2, "tetra": 3}
SIDES = (("west", "east"), ("south", "north"), ("bottom", "top"))


def is_vtu(path):
    return Path(path).suffix.lower() in ENDINGS


def read(path):
    """Returns points (n, 3), and [(elements, numbers of their groups)] of each block."""
    try:
        import meshio
    except ImportError:
        raise NetworkError("meshes in this format require meshio: apt-get install python3-meshio") from None
    try:
        mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio raises untyped exceptions
        raise NetworkError(f"{path}: cannot be read: {error}", [path]) from None
    other = sorted({block.type for block in mesh.cells} - {*DIMENSION, "vertex"})
    if other:
        raise NetworkError(f"{path}: has cells of the type {other[0]}; allowed are {', '.join(DIMENSION)}", [path])
    title = next((one for one in GROUPS if one in mesh.cell_data), None)
    points = np.zeros((len(mesh.points), 3))
    points[:, :mesh.points.shape[1]] = mesh.points
    blocks = [(block.data, np.asarray(mesh.cell_data[title][k], int).ravel() if title else np.zeros(len(block.data), int))
              for k, block in enumerate(mesh.cells) if block.type in DIMENSION]
    if not any(len(elements) for elements, _ in blocks):
        raise NetworkError(f"{path}: has no cell", [path])
    return points, blocks


def sides(points, cells):
    """Yields (name, faces) of the boundary: faces on the bounding box by its sides, and the others."""
    n = cells.shape[1]
    faces = np.concatenate([np.delete(cells, k, axis=1) for k in range(n)])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = faces[first[count == 1]]
    low, high = points.min(axis=0), points.max(axis=0)
    left, noise = np.ones(len(outer), bool), 1e-9 * np.linalg.norm(high - low)
    for axis in range(n - 1):
        for name, place in zip(SIDES[axis], (low[axis], high[axis])):
            on_side = left & (abs(points[outer][:, :, axis] - place) <= noise).all(axis=1)
            left &= ~on_side
            yield name, outer[on_side]
    yield "other sides", outer[left]


def convert(path, output):
    """Writes the mesh in gmsh's format and returns a line about it.

    Numbers of cells become regions `region N`, and numbers of faces groups `faces N`. Without faces on the boundary its
    sides are named as those of a box."""
    points, blocks = read(path)
    dim = max(elements.shape[1] for elements, _ in blocks) - 1
    groups = []
    for of_dim, name in ((dim, "region"), (dim - 1, "faces")):
        found = [block for block in blocks if block[0].shape[1] == of_dim + 1]
        elements = np.concatenate([block[0] for block in found] or [np.zeros((0, of_dim + 1), int)])
        numbers = np.concatenate([block[1] for block in found] or [np.zeros(0, int)])
        groups += [(of_dim, f"{name} {k}", elements[numbers == k], None) for k in np.unique(numbers)]
    cells = np.concatenate([elements for of_dim, _, elements, _ in groups if of_dim == dim])
    known = {tuple(row) for of_dim, _, elements, _ in groups if of_dim < dim for row in np.sort(elements, axis=1).tolist()}
    for name, faces in sides(points, cells):
        free = np.array([tuple(row) not in known for row in np.sort(faces, axis=1).tolist()], bool)
        if free.any():
            groups.append((dim - 1, name, faces[free], None))
    msh_file.write(output, points, groups, [])
    return f"{len(cells)} cells, {len(points)} nodes; groups: {', '.join(name for _, name, _, _ in groups)}"
