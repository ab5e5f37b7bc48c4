"""Blocks of rock between fractures, from the description of a box or from the mesh of a network.

Independent of the program: only the scene and the .msh file are read."""
import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

SIDES = ("west", "east", "south", "north", "bottom", "top")


@dataclass
class Rock:
    """Cells with their facets. `groups` contains the facets [n, corners] of each boundary and fracture by name."""
    points: np.ndarray   # [n, dim]
    facets: np.ndarray   # [cells, facets of a cell, corners]
    volumes: np.ndarray  # [cells]
    centres: np.ndarray  # [cells, dim]
    groups: dict


@dataclass
class Face:
    """A facet of a boundary or fracture."""
    name: str
    nodes: np.ndarray
    centre: np.ndarray
    area: float          # length in 2D
    normal: np.ndarray   # from cells[0] to cells[1], outward on a boundary
    pieces: tuple        # blocks of the adjacent cells: one or two


@dataclass
class Pieces:
    count: int
    of_cell: np.ndarray  # [cells]
    boundaries: list     # of Face
    fractures: list      # of Face


def box(input_):
    """Returns the mesh of the section `Mesh` with rectangular cells; facets are triangles if the scene has
    tetrahedra."""
    low, high, cells = (np.array(input_.numbers("Mesh", name)) for name in ("lower corner", "upper corner", "cells"))
    dim, size = len(low), (high - low) / cells
    shape = cells.astype(int) + 1
    numbers = np.arange(shape.prod()).reshape(shape)
    lattice = low + size * np.stack(np.unravel_index(numbers.ravel(), shape), -1)
    halves = slice(-1), slice(1, None)
    corners = np.stack([numbers[tuple(halves[k >> i & 1] for i in range(dim))].ravel() for k in range(2**dim)], -1)
    facets = corners[:, _facets_of_block(dim, input_.text("Mesh", "cell") == "tetrahedron")]
    inside = 1e-6 * size

    def between(lower, upper):
        at = lattice[facets]
        return np.unique(facets[((at > lower - inside) & (at < upper + inside)).all(axis=(2, 3))], axis=0)

    groups = {}
    for i in range(dim):
        for k, end in enumerate((low, high)):
            lower, upper = low.copy(), high.copy()
            lower[i] = upper[i] = end[i]
            groups[SIDES[2 * i + k]] = between(lower, upper)
    for name in input_.names("Mesh", "fractures"):
        ends = (input_.numbers("Mesh", "fractures", name, f"{end} corner") for end in ("lower", "upper"))
        groups[name] = between(*map(np.array, ends))
    points = lattice @ rotation(input_, dim).T
    return Rock(points, facets, np.full(len(corners), size.prod()), points[corners].mean(axis=1), groups)


def _facets_of_block(dim, halved):
    """Facets of a rectangle or cuboid by corner numbers; bit i is set at the upper end of direction i."""
    if dim == 2:
        return np.array([[0, 2], [1, 3], [0, 1], [2, 3]])
    squares = [[side << i, side << i | 1 << j, side << i | 1 << j | 1 << k, side << i | 1 << k]
               for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) for side in (0, 1)]
    if halved:
        squares = [half for a, b, c, d in squares for half in ([a, b, c], [a, c, d])]
    return np.array(squares)


def rotation(input_, dim):
    """Matrix of `rotation` about `rotation axis`, counter-clockwise."""
    angle = math.radians(input_.number("Mesh", "rotation", default=0))
    axis = [0, 0, 1] if input_.text("Mesh", "rotation axis") is None else input_.numbers("Mesh", "rotation axis")
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return (np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross)[:dim, :dim]


def simplices(path):
    """Reads a mesh written by apps/mesh: binary gmsh 2.2 with triangles or tetrahedra."""
    data = path.read_bytes()

    def section(name):
        begin = data.index(f"${name}\n".encode()) + len(name) + 2
        end = data.index(b"\n", begin)
        return int(data[begin:end]), end + 1

    count, start = section("PhysicalNames")
    names = {}
    for line in data[start:].split(b"\n", count)[:count]:
        dim, number, name = line.decode().split(" ", 2)
        names[int(number)] = (int(dim), name.strip('"'))
    count, start = section("Nodes")
    nodes = np.frombuffer(data, [("tag", "<i4"), ("x", "<f8", 3)], count, start)
    count, start = section("Elements")
    elements = {}
    while count > 0:
        kind, number, tags = np.frombuffer(data, "<i4", 3, start)
        corners = {15: 1, 1: 2, 2: 3, 4: 4}[int(kind)]
        rows = np.frombuffer(data, "<i4", number * (1 + tags + corners), start + 12).reshape(number, -1)
        for group in np.unique(rows[:, 1]):
            elements.setdefault(names[group], []).append(rows[rows[:, 1] == group, 1 + tags:] - 1)
        count, start = count - number, start + 12 + 4 * rows.size
    dim = max(dim for dim, _ in elements)
    points = nodes["x"][:, :dim]
    cells = np.concatenate([part for (d, _), parts in elements.items() if d == dim for part in parts])
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    facets = np.stack([np.delete(cells, i, axis=1) for i in range(dim + 1)], axis=1)
    groups = {name: np.concatenate(parts) for (d, name), parts in elements.items() if d == dim - 1}
    return Rock(points, facets, np.abs(np.linalg.det(edges)) / math.factorial(dim), points[cells].mean(axis=1), groups)


def pieces(rock, fractures):
    """Returns the blocks: sets of cells connected through facets on none of these fractures."""
    cells, per_cell, corners = rock.facets.shape
    keys, facet = np.unique(np.sort(rock.facets.reshape(-1, corners), axis=1), axis=0, return_inverse=True)
    number = {tuple(key): k for k, key in enumerate(keys)}
    beside = [[] for _ in keys]
    for k, cell in zip(facet, np.repeat(np.arange(cells), per_cell)):
        beside[k].append(cell)
    cut = {number[tuple(nodes)] for name in fractures for nodes in np.sort(rock.groups[name], axis=1)}
    pairs = np.array([pair for k, pair in enumerate(beside) if len(pair) == 2 and k not in cut] or np.empty((0, 2), int))
    count, of_cell = connected_components(coo_matrix((np.ones(len(pairs)), pairs.T), (cells, cells)), directed=False)

    def faces(name):
        for nodes in rock.groups[name]:
            around = beside[number[tuple(np.sort(nodes))]]
            area, normal = _area_and_normal(rock.points[nodes])
            centre = rock.points[nodes].mean(axis=0)
            sign = np.sign(normal @ (centre - rock.centres[around[0]]))
            yield Face(name, nodes, centre, area, sign * normal, tuple(of_cell[around]))

    return Pieces(count, of_cell, [face for name in rock.groups if name not in fractures for face in faces(name)],
                  [face for name in fractures for face in faces(name)])


def _area_and_normal(corners):
    if corners.shape[1] == 2:
        x, y = corners[1] - corners[0]
        vector = np.array([y, -x])
    elif len(corners) == 3:
        vector = np.cross(corners[1] - corners[0], corners[2] - corners[0]) / 2
    else:
        vector = np.cross(corners[2] - corners[0], corners[3] - corners[1]) / 2
    area = np.linalg.norm(vector)
    return area, vector / area
