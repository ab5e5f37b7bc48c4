"""Networks for tests, and checks that a mesh conforms to one, with geometry that the mesher does not use."""
import sys
from collections import Counter
from pathlib import Path

import numpy as np

ROOT = Path(sys.argv[2] if len(sys.argv) > 2 else Path(__file__).parents[2]).resolve()
sys.path[:0] = [str(ROOT / "apps" / "mesh"), str(ROOT / "apps" / "plot")]

import checks  # noqa: E402
import mesher  # noqa: E402
from description import Network  # noqa: E402
from plan import Plan  # noqa: E402
from sizes import Sizes  # noqa: E402

DEFAULTS = {"relative size": 0.3, "growth": 0.5, "minimum angle": 2.0, "size at tips": 0.1, "maximum cells": 10**6, "regions": {}, "constraints": {}}
SQUARE = {"lower corner": [0.0, 0.0], "upper corner": [1.0, 1.0], "corners": [], "faces": {}, "sides": []}
CUBE = {**SQUARE, "lower corner": [0.0, 0.0, 0.0], "upper corner": [1.0, 1.0, 1.0]}


def as_xml(name, entries):
    """Returns a description in the format of `sprekk network`."""
    text = f'<ParameterList name="{name}">'
    for key, value in entries.items():
        if isinstance(value, dict):
            text += as_xml(key, value)
        elif isinstance(value, list):
            kind = "string" if value and isinstance(value[0], str) else "double"
            text += f'<Parameter name="{key}" type="Array({kind})" value="{{{", ".join(map(str, value))}}}"/>'
        else:
            kind = {float: "double", int: "int", str: "string"}[type(value)]
            text += f'<Parameter name="{key}" type="{kind}" value="{value}"/>'
    return text + "</ParameterList>"


def numbers(points):
    return {"points": [float(x) for x in np.ravel(points)]}


def network(fractures, domain=None, **entries):
    """Returns a Network of {name: points or (centre, radii, strike, dip, rake)}, each fracture in its own set."""
    sets = {}
    for name, points in fractures.items():
        if isinstance(points, tuple):
            ellipse = dict(zip(("centre", "radii", "strike", "dip", "rake"), (list(map(float, p)) if np.ndim(p) else float(p) for p in points)))
            sets[name] = {"ellipses": {name: ellipse}}
        else:
            sets[name] = {"lines" if np.shape(points)[1] == 2 else "polygons": {name: numbers(points)}}
    dim = 2 if any("lines" in s for s in sets.values()) else 3
    described = {**DEFAULTS, "domain": domain or (SQUARE if dim == 2 else CUBE), "fractures": sets}
    return Network(as_xml("network", {**described, **{key.replace("_", " "): value for key, value in entries.items()}}))


def planned(net):
    plan = Plan(net)
    checks.check(plan)
    return plan, Sizes(plan)


def meshed(net):
    plan, sizes = planned(net)
    return plan, mesher.make_mesh(plan, sizes)


def sizes_of(points, elements):
    """Returns the length, area or volume of each element."""
    x = points[elements]
    edges = x[:, 1:] - x[:, :1]
    gram = np.einsum("nij,nkj->nik", edges, edges)
    return np.sqrt(np.maximum(np.linalg.det(gram), 0)) / [1, 1, 2, 6][elements.shape[1] - 1]


def measure_of(plan, mesh, group):
    """Returns the length or area of the faces of a set or a side."""
    owners = [k for k, owner in enumerate(plan.owners) if owner.group == group]
    return sizes_of(mesh.points, mesh.faces[np.isin(mesh.face_owner, owners)]).sum()


def defects(plan, mesh, tolerance=1e-9):
    """Returns the defects of a mesh as a list of texts."""
    found, dim = [], plan.dim
    volume = sizes_of(mesh.points, mesh.cells)
    if abs(volume.sum() - plan.network.domain.volume) > 1e-9 * plan.network.domain.volume:
        found.append(f"volume {volume.sum()} of {plan.network.domain.volume}")
    if volume.min() <= 0:
        found.append("a flat cell")
    of_cells = Counter(tuple(sorted(np.delete(cell, k))) for cell in mesh.cells for k in range(dim + 1))
    if max(of_cells.values()) > 2:
        found.append("a face of three cells")
    seen = Counter(tuple(sorted(face)) for face in mesh.faces)
    if max(seen.values()) > 1:
        found.append("a face of two owners")
    for face, owner in zip(mesh.faces, mesh.face_owner):
        if of_cells[tuple(sorted(face))] != (1 if plan.owners[owner].kind == "boundary" else 2):
            found.append(f"a face of {plan.owners[owner].name} belongs to {of_cells[tuple(sorted(face))]} cells")
            break
    on_sides = {tuple(sorted(face)) for face, owner in zip(mesh.faces, mesh.face_owner) if plan.owners[owner].kind == "boundary"}
    if on_sides != {face for face, n in of_cells.items() if n == 1}:
        found.append("the sides are not the boundary")
    return found + off_plane(plan, mesh, tolerance) + crossing(plan, mesh, tolerance)


def frame_of(owner, dim):
    """Yields (points, normal) of a fracture; of each segment of a polyline."""
    x = owner.points
    if dim == 2:
        for a, b in zip(x, x[1:]):
            along = (b - a) / np.linalg.norm(b - a)
            yield np.array([a, b]), np.array([-along[1], along[0]])
    else:
        normal = np.cross(x[1] - x[0], x[2] - x[1])
        yield x, normal / np.linalg.norm(normal)


def off_plane(plan, mesh, tolerance):
    found = []
    for k, owner in enumerate(plan.owners):
        if owner.kind == "fracture" and (plan.dim == 3 or len(owner.points) == 2):
            (x, normal), = frame_of(owner, plan.dim)
            height = abs((mesh.points[np.unique(mesh.faces[mesh.face_owner == k])][:, :plan.dim] - x[0]) @ normal)
            if height.max(initial=0) > tolerance:
                found.append(f"{owner.name}: a node is {height.max()} m off its plane")
    return found


def crossing(plan, mesh, tolerance):
    """Returns defects: edges of cells that cross the interior of a fracture."""
    dim, found = plan.dim, []
    edges = np.unique(np.concatenate([np.sort(mesh.cells[:, [i, j]], axis=1) for i in range(dim + 1) for j in range(i)]), axis=0)
    begin, end = (mesh.points[edges[:, k]][:, :dim] for k in (0, 1))
    for owner in plan.network.fractures:
        for x, normal in frame_of(owner, dim):
            a, b = (begin - x[0]) @ normal, (end - x[0]) @ normal
            cuts = (a * b < 0) & (np.minimum(abs(a), abs(b)) > 10 * tolerance)
            through = begin[cuts] + (a[cuts] / (a[cuts] - b[cuts]))[:, None] * (end[cuts] - begin[cuts])
            if len(through) and is_inside(through, x, normal, 1e-6).any():
                found.append(f"a cell crosses {owner.name}")
    return found


def is_inside(points, x, normal, margin):
    """Returns whether points are inside a polygon by a margin, from the sum of the angles of its edges.

    The points are in the plane of the polygon. In 2D they are on the line of a segment."""
    if len(x[0]) == 2:
        length = np.linalg.norm(x[1] - x[0])
        s = (points - x[0]) @ (x[1] - x[0]) / length
        return (s > margin) & (s < length - margin)
    turn, near = np.zeros(len(points)), np.full(len(points), np.inf)
    for a, b in zip(x, np.roll(x, -1, axis=0)):
        u, v = a - points, b - points
        turn += np.arctan2(np.cross(u, v) @ normal, np.einsum("ij,ij->i", u, v))
        s = np.clip(np.einsum("ij,j->i", -u, b - a) / ((b - a) @ (b - a)), 0, 1)
        near = np.minimum(near, np.linalg.norm(u + s[:, None] * (b - a), axis=1))
    return (abs(turn) > np.pi) & (near > margin)
