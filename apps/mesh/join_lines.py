"""Joins the traces of a network in 2D to a graph that can be meshed, for `repair` = `join`."""
from collections import defaultdict
from dataclasses import replace

import numpy as np
from arrange import Graph
from joined_graph import JoinedGraph
from shapely.geometry import LineString
from shapes import Errors, refuse, thinned


SIMPLIFIED = 0.25  # in tolerances: vertices closer to the straight line are removed
OPENED = 1.5  # wedges open to this multiple of the minimum angle


def length_of(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


def parts_of(line, network):
    """Returns the simplified parts of a feature in the domain, without short ones. Records the removed ones."""
    tolerance, journal = network.tolerance, network.journal
    if not np.isfinite(line.points).all():
        refuse(line, "has a coordinate that is not a finite number")
    whole = length_of(line.points)
    if whole <= tolerance:
        journal.leave_out(line, f"{whole:.3g} m long, shorter than the tolerance", "short")
        return []
    inside = network.domain.clip_line(line, tolerance)
    parts = [part for part in inside if length_of(part) > tolerance]
    if not parts:
        journal.leave_out(line, "outside of the domain", "outside")
    for part in inside:
        if parts and length_of(part) <= tolerance:
            journal.note(line, f"a part of {length_of(part):.3g} m in the domain is left out")
    found = []
    for part in parts:
        simple = np.array(LineString(part).simplify(SIMPLIFIED * tolerance).coords)
        found.append(thinned(simple, tolerance))
    return found


def joined(network):
    """Returns owners and the Graph of a network, and records the changes in its journal."""
    owners, errors = list(network.domain.sides), Errors()
    n_sides = len(owners)
    for line in network.fractures + network.constraints + [side for body in network.regions for side in body.sides]:
        with errors.of_one():
            owners += [replace(line, points=part) for part in parts_of(line, network)]
    errors.throw(network.files)
    flat = [np.column_stack([owner.points, np.zeros(len(owner.points))]) for owner in owners]
    segments = np.concatenate([np.stack([x[:-1], x[1:]], axis=1) for x in flat])
    parents = [frozenset([k]) for k, x in enumerate(flat) for _ in x[1:]]
    graph = JoinedGraph(segments, parents, range(n_sides), network.tolerance)
    graph.repair(np.radians(OPENED * network.minimum_angle))
    for length, of in graph.cut:
        for k in of:
            network.journal.note(owners[k], f"{length:.3g} m at a small angle are left out")
    edges = one_fracture_each(graph, owners, network.journal)
    left = {owners[k].name for of in edges.values() for k in of}
    for line in network.fractures:
        if line.name not in left and line.name not in network.journal.why:
            network.journal.leave_out(line, "merged with other fractures", "duplicate")
    network.journal.noise = max(network.journal.noise, 1.001 * SIMPLIFIED * network.tolerance)
    return owners, Graph(graph.points, edges)


def one_fracture_each(graph, owners, journal):
    """Returns the edges with at most one fracture each, the longest one. Sides have no fracture."""
    total, shared = defaultdict(float), defaultdict(float)
    for owner in owners:
        total[owner.single] += length_of(owner.points)
    edges = {}
    for (a, b), of in graph.edges.items():
        fractures = sorted((k for k in of if owners[k].kind == "fracture"), key=lambda k: (-total[owners[k].single], k))
        sides = [k for k in of if owners[k].kind == "boundary"]
        first = owners[(sides or fractures)[0]] if sides or fractures else None
        lost = fractures if sides else fractures[1:]
        for k in lost:
            if owners[k].single != first.single or sides:
                shared[owners[k].name, first.name] += np.linalg.norm(graph.points[a] - graph.points[b])
        edges[a, b] = frozenset(of - set(lost))
    by_name = {owner.name: owner for owner in owners}
    for (name, other), length in shared.items():
        journal.note(by_name[name], f"{length:.3g} m are joined with {other}")
    return edges
