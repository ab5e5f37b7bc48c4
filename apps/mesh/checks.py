"""Checks a network for distances and angles that are too small for a mesh, or small. Messages name both fractures."""
import numpy as np
from arrange import closest, near_pairs, on_segment
from domain import in_polygon
from journal import REASONS
from shapes import Errors, at

NEAR = 10  # in minimum distances: closer fractures that do not meet give a warning
MAX_LISTED = 5  # fractures left out
MAX_NEAR = 5  # warnings about such pairs


def names(plan, one, other):
    """Returns the names of two features, at least one a fracture, or None if there is no such pair."""
    one, other = set(one), set(other)
    one, other = one - other or one, other - one or other
    pairs = [(plan.owners[a], plan.owners[b]) for a in sorted(one) for b in sorted(other)]
    for a, b in pairs:
        if a.name != b.name and "fracture" in (a.kind, b.kind):
            return (a.name, b.name) if a.kind == "fracture" else (b.name, a.name)
    return None


def both(pair):
    """Returns the names of two fractures, or of parts of one, for messages."""
    return f"{pair[0]} and {pair[1]}" if pair[0] != pair[1] else f"parts of {pair[0]}"


def at_point(plan, where):
    return at(where[:plan.dim], plan.network.domain.size)


def too_close(plan, pair, gap, where):
    allowed, tolerance = plan.network.minimum_distance, plan.network.tolerance
    advice = f"move one, or join them by a larger \"tolerance\" (now {tolerance:.3g} m)" if gap > tolerance else "move one"
    return (f"{both(pair)} are {gap:.3g} m apart at {at_point(plan, where)} without meeting; "
            f"the \"minimum distance\" is {allowed:.3g} m; {advice}")


def edges_within(plan, reach):
    """Yields (owners of the one, of the other, distance, point) of close edges without a common point."""
    segments, ends, owners = plan.graph.segments(), np.array(list(plan.edges)), list(plan.edges.values())
    i, j = near_pairs(segments.min(axis=1), segments.max(axis=1), reach)
    apart = ~(ends[i][:, :, None] == ends[j][:, None, :]).any(axis=(1, 2))
    i, j = i[apart], j[apart]
    s, _, gap = closest(segments[i], segments[j])
    for k in np.flatnonzero(gap < reach):
        yield owners[i[k]], owners[j[k]], gap[k], segments[i[k], 0] + s[k] * (segments[i[k], 1] - segments[i[k], 0])


def close_edges(plan):
    """Yields errors (names, message) of close edges without a common point, and of close end points of one edge."""
    reach, segments, ends = plan.network.minimum_distance, plan.graph.segments(), np.array(list(plan.edges))
    for one, other, gap, where in edges_within(plan, reach):
        pair = names(plan, one, other)
        if pair:
            yield pair, too_close(plan, pair, gap, where)
    at, length = plan.graph.parents_at(), np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    for k in np.flatnonzero(length < reach):
        a, b = ends[k]
        pair = names(plan, at[a] - at[b] or at[a], at[b] - at[a] or at[b])
        if pair:
            yield pair, too_close(plan, pair, length[k], segments[k, 0])


def points_within(plan, reach):
    """Yields (surface, owners, distance, point) of points close to a surface that they do not belong to, in 3D."""
    at, points = plan.graph.parents_at(), plan.points
    for k, surface in enumerate(plan.surfaces):
        near = np.flatnonzero(np.all((points > surface.low - reach) & (points < surface.high + reach), axis=1))
        height = abs(surface.plane.height(points[near]))
        near = near[height < reach]
        flat = surface.plane.inside(points[near])
        over = in_polygon(flat, np.array(surface.shape.exterior.coords[:-1]))
        for hole in surface.shape.interiors:
            over &= ~in_polygon(flat, np.array(hole.coords[:-1]))
        for p in near[over]:
            if k not in at[p] | plan.touching.get(int(p), set()):
                yield {k}, at[p], abs(surface.plane.height(points[p])), points[p]


def close_surfaces(plan):
    """Yields errors (names, message) of points close to a surface that they do not belong to."""
    for one, other, gap, where in points_within(plan, plan.network.minimum_distance):
        pair = names(plan, one, other)
        if pair:
            yield pair, too_close(plan, pair, gap, where)


def left_out(plan):
    """Returns a warning about fractures left out of the mesh, in a list; an empty list without them."""
    journal = plan.network.journal
    reasons = [f"{name}, {REASONS[entry.reason]}" for name, entry in journal.entries.items() if entry.reason]
    reasons += [f"a feature of {path}, {text}" for path, text in journal.empty]
    more = len(reasons) - MAX_LISTED
    listed = "; ".join(reasons[:MAX_LISTED]) + (f"; and {more} more, see the table of the mesh" if more > 0 else "")
    total = len(journal.entries) + len(journal.empty)
    return [f"{len(reasons)} of {total} fractures are left out of the mesh: {listed}"] if reasons else []


def shortened(plan):
    """Returns a warning about mapped fractures with less than half of their length or area in the mesh, in a list.

    Random fractures cross the boundary by chance, without a warning."""
    entries, drawn = plan.network.journal.entries, set(plan.network.at_random)
    found = [name for name, e in entries.items() if name not in drawn and not e.reason and (e.meshed or 0) < 0.5 * e.given]
    more, size = len(found) - MAX_LISTED, "length" if plan.dim == 2 else "area"
    listed = ", ".join(found[:MAX_LISTED]) + (f" and {more} more, see the table of the mesh" if more > 0 else "")
    return [f"{len(found)} of {len(entries)} fractures have less than half of their {size} in the mesh, the rest is outside of the "
            f"domain or left out: {listed}"] if found else []


def near_fractures(plan):
    """Returns warnings about fractures that come close without meeting there, the nearest first.

    Random fractures do so by chance, without a warning."""
    reach, at, first = NEAR * plan.network.minimum_distance, plan.graph.parents_at(), {}
    found = list(edges_within(plan, reach)) + (list(points_within(plan, reach)) if plan.dim == 3 else [])
    for one, other, gap, where in sorted(found, key=lambda near: near[2]):
        pair, near = names(plan, one, other), np.flatnonzero(np.linalg.norm(plan.points - where, axis=1) < 2 * reach)
        meet = any(at[p] & set(one) and at[p] & set(other) for p in near)
        if pair and not meet and not set(pair) <= set(plan.network.at_random):
            first.setdefault(frozenset(pair), f"{both(pair)} are {gap:.3g} m apart at {at_point(plan, where)} without meeting; "
                             "if they should meet, join them by a larger \"tolerance\"")
    lines = list(first.values())
    return lines[:MAX_NEAR] + ([f"{len(lines) - MAX_NEAR} more pairs of fractures are close"] if len(lines) > MAX_NEAR else [])


def folds(plan):
    """Yields errors (names, message) of fractures that come close to themselves.

    These are small angles between consecutive segments, and close segments that are far apart along the line."""
    for fracture in plan.network.fractures:
        ring, pair = plan.dim == 3 or (fracture.points[0] == fracture.points[-1]).all(), (fracture.name, fracture.name)
        x = np.concatenate([fracture.points, fracture.points[:1]]) if plan.dim == 3 else fracture.points
        angle = corner_angles(x, ring)
        if len(angle) and angle.min() < plan.network.minimum_angle:
            yield pair, small_angle(plan, pair, angle.min())
        close = list(self_approaches(x, ring, plan.network.tolerance, plan.network.minimum_distance)) if len(x) > 3 else []
        if close:
            yield pair, too_close(plan, pair, *min(close, key=lambda found: found[0]))


def corner_angles(x, ring):
    """Returns the angles, in degrees, between consecutive segments; 180 for a straight line."""
    back = x[:-1] - x[1:]
    back /= np.linalg.norm(back, axis=1)[:, None]
    one, other = (back, -np.roll(back, -1, axis=0)) if ring else (back[:-1], -back[1:])
    return 2 * np.degrees(np.arctan2(np.linalg.norm(one - other, axis=1), np.linalg.norm(one + other, axis=1)))


def self_approaches(x, ring, tolerance, reach):
    """Yields (distance, point) where the polyline x comes closer to itself than `reach`.

    The path between both points must be longer than twice `reach`. Distances within the tolerance are not reported."""
    begin, end = x[:-1], x[1:]
    length = np.linalg.norm(end - begin, axis=1)
    at = np.concatenate([[0], np.cumsum(length)])
    i, j = near_pairs(np.minimum(begin, end), np.maximum(begin, end), reach)
    apart = (j > i + 1) & ~(ring & (i == 0) & (j == len(length) - 1))
    i, j = i[apart], j[apart]
    for one, other in ((i, j), (j, i)):
        near = np.minimum(2 * reach / length[one], 1)  # positions at and near both ends
        for s in (0 * near, near, 1 - near, 0 * near + 1):
            point = begin[one] + s[:, None] * (end - begin)[one]
            t, gap = on_segment(point, begin[other], end[other])
            detour = abs(at[one] + s * length[one] - at[other] - t * length[other])
            detour = np.minimum(detour, at[-1] - detour) if ring else detour
            for k in np.flatnonzero((tolerance < gap) & (gap < reach) & (detour > 2 * reach)):
                yield gap[k], point[k]


def small_angle(plan, pair, angle):
    return f"{both(pair)} meet at {angle:.3g} degrees; the \"minimum angle\" is {plan.network.minimum_angle:g}"


def small_angles(plan):
    """Yields errors (names, message) of small angles between edges of different fractures at a point, in 2D."""
    at, minimum = {}, plan.network.minimum_angle
    for (a, b), of in plan.edges.items():
        along = plan.points[b] - plan.points[a]
        at.setdefault(a, []).append((np.arctan2(along[1], along[0]), of))
        at.setdefault(b, []).append((np.arctan2(-along[1], -along[0]), of))
    for point, star in at.items():
        star.sort(key=lambda ray: ray[0])
        for (one, of), (other, others) in zip(star, star[1:] + star[:1]):
            angle = np.degrees(other - one) % 360
            pair = names(plan, of, others) if len(star) > 1 and angle < minimum else None
            if pair:
                yield pair, small_angle(plan, pair, angle)


def lying_on(plan):
    """Yields errors (names, message) of edges shared by two fractures, or a fracture and the boundary, in 2D."""
    for of in plan.edges.values():
        fractures = plan.fractures_of(of)
        side = next((plan.owners[k] for k in of if plan.owners[k].kind == "boundary"), None)
        if len(fractures) > 1:
            pair = fractures[0].name, fractures[1].name
            yield pair, f"{pair[0]} and {pair[1]} overlap; remove one, or merge them"
        elif fractures and side:
            advice = "; \"layers\" of its set selects other layers" if " of the layer " in fractures[0].name else ""
            yield ((fractures[0].name, side.name),
                   f"{fractures[0].name}: lies on {side.name}; a fracture needs rock on both sides{advice}")


def check(plan):
    """Raises the errors of all checks, one line for each pair of features."""
    found = list(folds(plan)) + (list(lying_on(plan)) + list(small_angles(plan)) if plan.dim == 2 else [])
    found = found or list(close_edges(plan)) + (list(close_surfaces(plan)) if plan.dim == 3 else [])
    first = {}
    for pair, line in found:
        first.setdefault(frozenset(pair), line)
    Errors(first.values(), [tuple(sorted(pair)) for pair in first]).throw()
