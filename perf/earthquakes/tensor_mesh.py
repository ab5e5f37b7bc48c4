"""Meshes of boxes from a coordinate list for each direction, in the format 2.2 of gmsh."""
import itertools

import numpy as np

CELLS, SIDES = {2: 3, 3: 5}, {2: 1, 3: 3}  # types of gmsh by the dimension: quadrilaterals, hexahedra; lines, quadrilaterals


def growing(size, growth, end, fine=0.0, largest=np.inf):
    """Coordinates from 0: equal cells up to `fine`, then cells whose size grows by `growth` up to `largest`, until one
    ends at or beyond `end`."""
    points = list(np.linspace(0, fine, round(fine / size) + 1))
    while points[-1] < end:
        size = min(size * growth, largest)
        points.append(points[-1] + size)
    return np.array(points)


def fitted(points, end):
    """Points stretched so that the last one is at `end`."""
    return points * (end / points[-1])


def both_ways(points):
    """Coordinates on both sides of 0."""
    return np.concatenate([-points[:0:-1], points])


def numbers(axes):
    """Numbers of the nodes, from 1. [position in each direction]"""
    return np.arange(np.prod([len(axis) for axis in axes])).reshape([len(axis) for axis in axes]) + 1


def write(file, axes, sides, place=lambda *at: at):
    """Writes a mesh. `sides` are the nodes of each named boundary or fracture. place(x, y[, z]) are the coordinates of
    the node with these values in the axes."""
    number, dim = numbers(axes), len(axes)
    names = [(dim, "rock"), *((dim - 1, name) for name in sides)]
    groups = [(CELLS[dim], number), *((SIDES[dim], side) for side in sides.values())]
    with open(file, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n")
        out.writelines(f'{of} {k} "{name}"\n' for k, (of, name) in enumerate(names, 1))
        out.write(f"$EndPhysicalNames\n$Nodes\n{number.size}\n")
        for k, at in enumerate(itertools.product(*axes), 1):
            out.write(" ".join([str(k), *(f"{value:.12g}" for value in (*place(*at), 0)[:3])]) + "\n")
        out.write(f"$EndNodes\n$Elements\n{sum(len(cells_of(part)) for _, part in groups)}\n")
        tag = 0
        for group, (kind, part) in enumerate(groups, 1):
            for nodes in cells_of(part):
                tag += 1
                out.write(f"{tag} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


def cells_of(number):
    """Nodes of the cells of a tensor grid of nodes, in the order of gmsh."""
    corners = {1: [(0,), (1,)], 2: [(0, 0), (1, 0), (1, 1), (0, 1)]}
    corners[3] = [(*corner, up) for up in (0, 1) for corner in corners[2]]
    return np.stack([number[tuple(slice(k, k - 1 or None) for k in corner)] for corner in corners[number.ndim]],
                    axis=-1).reshape(-1, 2**number.ndim)
