"""Circular fracture in 3D, filled with a nearly inviscid fluid: mesh, scene and exact solution of a quarter."""
import math

import numpy as np

from perf.cohesive import meshes
from perf.common import scene_file


def exact(volume, modulus, toughness):
    """Radius, opening in the middle and pressure of a circular crack of this volume at its toughness."""
    radius = (3 * modulus * volume / (8 * math.sqrt(math.pi) * toughness)) ** 0.4
    return radius, 4 * toughness * math.sqrt(radius / math.pi) / modulus, toughness * math.sqrt(math.pi / radius) / 2


def area(notch, size):
    """Area of the faces of a quarter with centres within the radius `notch`, for equal faces of `size`."""
    x = size * (np.arange(round(1.2 * notch / size) + 1) + 0.5)
    return size**2 * int(np.sum(x[:, None] ** 2 + x**2 <= notch**2))


def write(file, x, up):
    """Writes hexahedra with the coordinates x, x and +-up, and the fracture "growing" in the plane z = 0."""
    z = np.concatenate([-up[:0:-1], up])
    number = np.arange(len(x) ** 2 * len(z)).reshape(len(x), len(x), len(z)) + 1

    def quads(plane):
        return np.stack([plane[:-1, :-1], plane[1:, :-1], plane[1:, 1:], plane[:-1, 1:]], axis=-1).reshape(-1, 4)
    cells = np.concatenate([np.hstack([quads(number[:, :, k]), quads(number[:, :, k + 1])]) for k in range(len(z) - 1)])
    planes = {"growing": number[:, :, len(up) - 1], "west": number[0], "east": number[-1], "south": number[:, 0], "north": number[:, -1],
              "bottom": number[:, :, 0], "top": number[:, :, -1]}
    parts = [(3, "bulk", 5, cells), *((2, name, 3, quads(plane)) for name, plane in planes.items())]
    with open(file, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(parts)}\n")
        out.writelines(f'{dim} {k} "{name}"\n' for k, (dim, name, *_) in enumerate(parts, 1))
        out.write(f"$EndPhysicalNames\n$Nodes\n{number.size}\n")
        out.writelines(f"{number[i, j, k]} {x[i]:.17g} {x[j]:.17g} {z[k]:.17g}\n" for i, j, k in np.ndindex(number.shape))
        out.write(f"$EndNodes\n$Elements\n{sum(len(part) for *_, part in parts)}\n")
        tag = 0
        for group, (_, _, kind, part) in enumerate(parts, 1):
            for nodes in part:
                tag += 1
                out.write(f"{tag} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


def scene(file, rock, radius, faces, rate, end, far):
    """Writes the scene of a quarter that reaches `radius` at `end`, with `faces` along the radius and a notch of 0.4
    radii. `rate`: of the quarter, m^3/s. `rock`: section of materials. Returns the radius of the notch."""
    size, notch = radius / faces, 0.4 * radius
    write(file.with_suffix(".msh"), meshes.graded(size, size * math.ceil(1.2 * faces), far * radius, 1.8), meshes.graded(size, 2 * size, far * radius, 1.8))
    times = [end * (r / radius) ** 2.5 for r in np.arange(notch, radius + size / 2, size)]
    free = {"west": 0, "east": 0, "south": 1, "north": 1, "bottom": 2}
    scene_file.save({
        "Mesh file": {"path": file.with_suffix(".msh").name, "fractures": {"growing": {}}}, "Bulk": {"material": "granite"}, "Materials": rock,
        "Flow": {"viscosity": 1e-6, "compressibility": 1e-11},
        "Fractures": {"growing": {"material": "bonded joint", "unbroken": f"x^2 + y^2 > {notch**2}",
                                  "source": f"x < {size} ? (y < {size} ? {rate / size**2!r} : 0) : 0"}},
        "Boundary conditions": {name: {"boundary": name, "displacement": [0.0 if k == axis else "free" for k in range(3)]}
                                for name, axis in free.items()},
        "Time": {"schedule": [times[0] / 2, *times]}, "Output": {"vtu": False}}, file, "Growth of a circular fracture.")
    return notch
