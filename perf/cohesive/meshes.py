"""Graded meshes of rectangles with a fracture along y = 0, in the format 2.2 of gmsh."""
import numpy as np


def graded(size, fine, end, growth):
    """Coordinates from 0 to about `end`: equal cells of `size` up to `fine`, then cells that grow by the factor
    `growth`."""
    points = list(np.linspace(0, fine, round(fine / size) + 1))
    while points[-1] < end * (1 - 1e-9):
        size *= growth
        points.append(points[-1] + size)
    scale = (end - fine) / (points[-1] - fine) if points[-1] > fine else 1
    return np.array([x if x <= fine * (1 + 1e-12) else fine + (x - fine) * scale for x in points])


def write(file, x, up, fracture="growing"):
    """Writes quadrilaterals with the coordinates x and +-up. `up` starts with 0. Regions: "bulk" below, "upper"
    above."""
    y = np.concatenate([-up[:0:-1], up])
    number = np.arange(len(x) * len(y)).reshape(len(x), len(y)) + 1
    middle = len(up) - 1
    cells = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    lines = {fracture: number[:, middle], "west lower": number[0, :middle + 1], "west upper": number[0, middle:],
             "east": number[-1], "south": number[:, 0], "north": number[:, -1]}
    groups = [(3, cells[:, :middle].reshape(-1, 4)), (3, cells[:, middle:].reshape(-1, 4))]
    groups += [(1, np.stack([line[:-1], line[1:]], axis=-1)) for line in lines.values()]
    names = [(2, "bulk"), (2, "upper"), *((1, name) for name in lines)]
    with open(file, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n")
        out.writelines(f'{dim} {k} "{name}"\n' for k, (dim, name) in enumerate(names, 1))
        out.write(f"$EndPhysicalNames\n$Nodes\n{number.size}\n")
        out.writelines(f"{number[i, j]} {x[i]:.17g} {y[j]:.17g} 0\n" for i in range(len(x)) for j in range(len(y)))
        out.write(f"$EndNodes\n$Elements\n{sum(len(part) for _, part in groups)}\n")
        tag = 0
        for group, (kind, part) in enumerate(groups, 1):
            for nodes in part:
                tag += 1
                out.write(f"{tag} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")
