"""Circular fracture in 3D: mesh and scene of a thin sector, one cell wide."""
import math

import numpy as np

from perf.cohesive import meshes
from perf.common import scene_file

ANGLE = math.radians(10)  # of the sector
HOLE = 0.1   # radius of the hole around the axis, over the length of a face
FAR = 8      # radius and half-height of the body over the radius of the fracture


def write(file, r, up):
    """Writes hexahedra with the radii r and heights +-up between the planes y = 0 and y = x tan(ANGLE), and the fracture
    "growing" in the plane z = 0. Nodes lie outside of these radii, so that areas are those of the circles."""
    z = np.concatenate([-up[:0:-1], up])
    number = np.arange(2 * len(r) * len(z)).reshape(2, len(r), len(z)) + 1
    outer = r * math.sqrt(ANGLE / math.sin(ANGLE))

    def quads(plane):
        return np.stack([plane[:-1, :-1], plane[1:, :-1], plane[1:, 1:], plane[:-1, 1:]], axis=-1).reshape(-1, 4)
    across = number.transpose(1, 0, 2)  # [radius, side, height]
    cells = np.concatenate([np.hstack([quads(across[:, :, k]), quads(across[:, :, k + 1])]) for k in range(len(z) - 1)])
    planes = {"growing": across[:, :, len(up) - 1], "axis": across[0], "outside": across[-1], "south": number[0], "inclined": number[1],
              "bottom": across[:, :, 0], "top": across[:, :, -1]}
    parts = [(3, "bulk", 5, cells), *((2, name, 3, quads(plane)) for name, plane in planes.items())]
    with open(file, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(parts)}\n")
        out.writelines(f'{dim} {k} "{name}"\n' for k, (dim, name, *_) in enumerate(parts, 1))
        out.write(f"$EndPhysicalNames\n$Nodes\n{number.size}\n")
        out.writelines(f"{number[s, i, k]} {outer[i] * math.cos(s * ANGLE):.17g} {outer[i] * math.sin(s * ANGLE):.17g} {z[k]:.17g}\n"
                       for s, i, k in np.ndindex(number.shape))
        out.write(f"$EndNodes\n$Elements\n{sum(len(part) for *_, part in parts)}\n")
        tag = 0
        for group, (_, _, kind, part) in enumerate(parts, 1):
            for nodes in part:
                tag += 1
                out.write(f"{tag} {kind} 2 {group} {group} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


def scene(file, rock, fracture, size, notch, fronts):
    """Writes the scene of a sector with faces of `size` up to 1.1 times the radius at the end. Steps end at the `fronts` of
    the exact fracture; the first ones fill the notch. `rock`: section of materials."""
    radius = fracture.radius
    r = meshes.graded(size, 1.1 * radius, FAR * radius, 1.4)
    r[0] = HOLE * size
    write(file.with_suffix(".msh"), r, meshes.graded(size, 2 * size, FAR * radius, 1.4))
    share, first = ANGLE / (2 * math.pi), ANGLE / 2 * (r[1] ** 2 - r[0] ** 2)
    times = [fracture.time(front) for front in fronts]
    scene_file.save({
        "Mesh file": {"path": file.with_suffix(".msh").name, "fractures": {"growing": {}}}, "Bulk": {"material": "granite"}, "Materials": rock,
        "Flow": {"viscosity": fracture.viscosity / 12, "compressibility": 1e-11},
        "Fractures": {"growing": {"material": "bonded joint", "unbroken": f"x^2 + y^2 > {notch**2}",
                                  "source": f"x^2 + y^2 < {size**2} ? {fracture.rate * share / first!r} : 0"}},
        "Boundary conditions": {"axis": {"boundary": "axis", "displacement": [0.0, 0.0, "free"]}, "south": {"boundary": "south", "displacement": ["free", 0.0, "free"]},
                                "inclined": {"boundary": "inclined", "foundation stiffness": [1e15]},
                                "outside": {"boundary": "outside", "displacement": [0.0, 0.0, "free"]},
                                "bottom": {"boundary": "bottom", "displacement": ["free", "free", 0.0]}},
        "Time": {"schedule": [*(float(part * times[0]) for part in (0.25, 0.5, 0.75)), *map(float, times)]},
        "Solver": {"Linear solver": {"type": "direct"}}, "Output": {"vtu": False, "energy": True}}, file, "Growth of a circular fracture.")
