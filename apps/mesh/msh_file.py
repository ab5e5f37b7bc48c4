"""Writes meshes in the binary format of gmsh, version 2.2."""
import numpy as np
from shapes import Errors

TYPES = {1: 15, 2: 1, 3: 2, 4: 4}  # {number of nodes: type in gmsh} of points, lines, triangles, tetrahedra


def write(path, points, groups, singles):
    """Writes a mesh file.

    groups   (dimension, name, elements [element, node] from 0, index in `singles` of each element or None)
    singles  single fractures, in a section that gmsh ignores"""
    with open(path, "wb") as file:
        file.write(b"$MeshFormat\n2.2 1 8\n" + np.int32(1).tobytes() + b"\n$EndMeshFormat\n$PhysicalNames\n")
        file.write(f"{len(groups)}\n".encode())
        for k, (dim, name, *_) in enumerate(groups):
            file.write(f'{dim} {k + 1} "{name}"\n'.encode())
        file.write(b"$EndPhysicalNames\n")
        if singles:
            file.write(f"$Fractures\n{len(singles)}\n".encode())
            group = {name: k + 1 for k, (_, name, _, single) in enumerate(groups) if single is not None}
            for k, one in enumerate(singles):
                texts = [one.single, *(text for pair in one.properties.items() for text in pair)]
                file.write(f"{group[one.group]} {len(groups) + 1 + k} {' '.join(f'{chr(34)}{text}{chr(34)}' for text in texts)}\n".encode())
            file.write(b"$EndFractures\n")
        file.write(f"$Nodes\n{len(points)}\n".encode())
        nodes = np.empty(len(points), [("tag", "<i4"), ("x", "<f8", 3)])
        nodes["tag"], nodes["x"] = np.arange(1, len(points) + 1), points
        file.write(nodes.tobytes() + f"\n$EndNodes\n$Elements\n{sum(len(e) for _, _, e, _ in groups)}\n".encode())
        tag = 1
        for k, (_, _, elements, single) in enumerate(groups):
            n = elements.shape[1]
            rows = np.empty((len(elements), 3 + n), "<i4")
            rows[:, 0], rows[:, 1:3], rows[:, 3:] = np.arange(tag, tag + len(elements)), k + 1, elements + 1
            if single is not None:
                rows[:, 2] = len(groups) + 1 + single
            tag += len(elements)
            if len(elements):
                file.write(np.array([TYPES[n], len(elements), 2], "<i4").tobytes() + rows.tobytes())
        file.write(b"\n$EndElements\n")


def singles_of(plan):
    """Returns the single fractures of all sets, one feature for each name."""
    return list({owner.single: owner for owner in plan.owners if owner.kind == "fracture"}.values())


def single_of_owners(plan):
    number = {one.single: k for k, one in enumerate(singles_of(plan))}
    return np.array([number.get(owner.single, -1) for owner in plan.owners])


def groups_of(mesh, plan):
    """Returns the physical groups of a mesh: sides, sets of fractures, regions, intersections."""
    dim, found = plan.dim, []
    number = single_of_owners(plan)
    groups = {}
    for k, owner in enumerate(plan.owners):
        groups.setdefault((owner.kind, owner.group), []).append(k)
    for (kind, name), owners in groups.items():
        if kind in ("boundary", "fracture"):
            of_group = np.isin(mesh.face_owner, owners)
            single = number[mesh.face_owner[of_group]] if kind == "fracture" else None
            found.append((dim - 1, name, mesh.faces[of_group], single))
    centres, region = mesh.points[mesh.cells].mean(axis=1)[:, :dim], np.zeros(len(mesh.cells), int)
    bodies = plan.network.regions
    for k, body in enumerate(bodies):
        region[body.contains(centres)] = k + 1
    names = ["bulk"] + [body.place.split(" > ")[-1] for body in bodies]
    Errors(f"{body.place}: has no cell; it lies outside of the domain, or in regions that come after it"
           for k, body in enumerate(bodies, 1) if not (region == k).any()).throw()
    found += [(dim, name, mesh.cells[region == k], None) for k, name in enumerate(names) if (region == k).any()]
    if len(mesh.intersections):
        found.append((dim - 2, "intersections", mesh.intersections, None))
    return found
