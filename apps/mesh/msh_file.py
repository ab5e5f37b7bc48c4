"""Writes meshes as files of gmsh, version 2.2, binary."""
import numpy as np
from shapes import Errors

TYPES = {1: 15, 2: 1, 3: 2, 4: 4}  # gmsh's number of a point, line, triangle, tetrahedron by its nodes


def write(path, points, groups):
    """`groups`: (dimension, name, elements by their nodes from 0)."""
    with open(path, "wb") as file:
        file.write(b"$MeshFormat\n2.2 1 8\n" + np.int32(1).tobytes() + b"\n$EndMeshFormat\n$PhysicalNames\n")
        file.write(f"{len(groups)}\n".encode())
        for k, (dim, name, _) in enumerate(groups):
            file.write(f'{dim} {k + 1} "{name}"\n'.encode())
        file.write(f"$EndPhysicalNames\n$Nodes\n{len(points)}\n".encode())
        nodes = np.empty(len(points), [("tag", "<i4"), ("x", "<f8", 3)])
        nodes["tag"], nodes["x"] = np.arange(1, len(points) + 1), points
        file.write(nodes.tobytes() + f"\n$EndNodes\n$Elements\n{sum(len(e) for _, _, e in groups)}\n".encode())
        tag = 1
        for k, (_, _, elements) in enumerate(groups):
            n = elements.shape[1]
            rows = np.empty((len(elements), 3 + n), "<i4")
            rows[:, 0], rows[:, 1:3], rows[:, 3:] = np.arange(tag, tag + len(elements)), k + 1, elements + 1
            tag += len(elements)
            if len(elements):
                file.write(np.array([TYPES[n], len(elements), 2], "<i4").tobytes() + rows.tobytes())
        file.write(b"\n$EndElements\n")


def groups_of(mesh, plan):
    """The physical groups of a mesh: sides, sets of fractures, regions, intersections."""
    dim, found = plan.dim, []
    groups = {}
    for k, owner in enumerate(plan.owners):
        groups.setdefault((owner.kind, owner.group), []).append(k)
    for (kind, name), owners in groups.items():
        if kind in ("boundary", "fracture"):
            found.append((dim - 1, name, mesh.faces[np.isin(mesh.face_owner, owners)]))
    centres, region = mesh.points[mesh.cells].mean(axis=1)[:, :dim], np.zeros(len(mesh.cells), int)
    bodies = plan.network.regions
    for k, body in enumerate(bodies):
        region[body.holds(centres)] = k + 1
    names = ["bulk"] + [body.place.split(" > ")[-1] for body in bodies]
    Errors(f"{body.place}: has no cell; it lies outside of the domain, or in regions that come after it"
           for k, body in enumerate(bodies, 1) if not (region == k).any()).throw()
    found += [(dim, name, mesh.cells[region == k]) for k, name in enumerate(names) if (region == k).any()]
    if len(mesh.intersections):
        found.append((dim - 2, "intersections", mesh.intersections))
    return found
