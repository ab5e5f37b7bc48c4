"""Statistics of a mesh: counts, quality of cells, lengths of edges compared with the required sizes."""
from collections import defaultdict

import numpy as np


def gamma(points, cells):
    """Returns the quality of cells and their volumes (areas in 2D).

    The quality is the radius of the inscribed over that of the circumscribed sphere, 1 for a regular cell."""
    x = points[cells]
    if cells.shape[1] == 3:
        side = [np.linalg.norm(x[:, i] - x[:, j], axis=1) for i, j in ((1, 2), (2, 0), (0, 1))]
        area = 0.5 * abs(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])[:, 2])
        return 16 * area**2 / (sum(side) * np.prod(side, axis=0)), area
    volume = abs(np.linalg.det(x[:, 1:] - x[:, :1])) / 6
    area = sum(0.5 * np.linalg.norm(np.cross(x[:, j] - x[:, i], x[:, k] - x[:, i]), axis=1)
               for i, j, k in ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)))
    p, q, r = (np.linalg.norm(x[:, a] - x[:, b], axis=1) * np.linalg.norm(x[:, c] - x[:, d], axis=1)
               for a, b, c, d in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2)))
    heron = (p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r)
    return 216 * volume**2 / (area * np.sqrt(np.maximum(heron, 1e-300))), volume


def measure(points, faces):
    """Returns the lengths of lines or the areas of triangles."""
    x = points[faces]
    if faces.shape[1] == 2:
        return np.linalg.norm(x[:, 1] - x[:, 0], axis=1)
    return 0.5 * np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1)


def edges_of(faces):
    """Returns the edges of lines or triangles, each once."""
    pairs = faces if faces.shape[1] == 2 else np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def of_sets(mesh, plan, sizes):
    """Returns for each set of fractures: number, length or area, faces, median edge and median required size."""
    sets = {}
    for k, owner in enumerate(plan.owners):
        if owner.kind == "fracture":
            sets.setdefault(owner.group, []).append(k)
    found = {}
    for name, owners in sets.items():
        faces = mesh.faces[np.isin(mesh.face_owner, owners)]
        edges = measure(mesh.points, edges_of(faces))
        found[name] = {"fractures": len({plan.owners[k].single for k in owners}),
                       "length" if plan.dim == 2 else "area": float(measure(mesh.points, faces).sum()), "faces": len(faces),
                       "median edge": float(np.median(edges)), "shortest edge": float(edges.min()),
                       "median target size": float(np.median([sizes.of_owner[k] for k in owners]))}
    return found


def n_intersections(mesh, plan):
    """Returns the number of intersections, as in mesh-info: points (3D: edges) of several sets or over two faces."""
    at, n = defaultdict(list), plan.dim
    for face, owner in zip(mesh.faces, mesh.face_owner):
        if plan.is_fracture(owner):
            for k in range(n):
                at[tuple(sorted({face[k], face[(k + 1) % n]})) if n == 3 else face[k]].append(plan.owners[owner].group)
    return sum(len(groups) > 2 or len(set(groups)) > 1 for groups in at.values())


def of_mesh(mesh, plan, sizes):
    quality, volume = gamma(mesh.points, mesh.cells)
    worst = mesh.points[mesh.cells[np.argmin(quality)]].mean(axis=0)[:plan.dim]
    return {"dimension": plan.dim, "nodes": len(mesh.points), "cells": len(mesh.cells), "fracture faces": int(sum(
                plan.is_fracture(k) for k in mesh.face_owner)),
            "expected cells": float(sizes.expected_number()), "intersections": n_intersections(mesh, plan), "volume": float(volume.sum()),
            "gamma": {"min": float(quality.min()), "percentile 1": float(np.percentile(quality, 1)), "median": float(np.median(quality)),
                      "worst at": [float(x) for x in worst]},
            "attempts": plan.attempts, "generations of cells": mesh.generations, "tolerance": plan.network.tolerance, "files": plan.network.journal.lines(plan.dim), "sets": of_sets(mesh, plan, sizes), "repairs": plan.repairs}


def as_text(report):
    what = "length" if report["dimension"] == 2 else "area"
    g = report["gamma"]
    lines = [f"{report['cells']} cells, {report['nodes']} nodes, {report['fracture faces']} fracture faces; "
             f"gamma of cells: min {g['min']:.3g}, median {g['median']:.3g}"]
    for name, s in report["sets"].items():
        lines.append(f"  {name}: {s['fractures']} fractures, {what} {s[what]:.6g}, {s['faces']} faces; edges on the fractures: "
                     f"shortest {s['shortest edge']:.3g} m, median {s['median edge']:.3g} m; \"relative size\" gives "
                     f"{s['median target size']:.3g} m, less near tips, intersections and other fractures")
    lines += [f"  {line}" for line in report["files"]]
    shown = report["repairs"][:10]
    lines += [f"  {line}" for line in shown]
    if len(shown) < len(report["repairs"]):
        lines.append(f"  and {len(report['repairs']) - len(shown)} more repairs")
    return "\n".join(lines)
