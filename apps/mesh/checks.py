"""What is too close in a network to be meshed: refused with the names of both fractures."""
import numpy as np
from arrange import closest, near_pairs
from domain import in_polygon
from shapes import Errors


def names(plan, one, other):
    """Names of two features of which at least one is a fracture, or None where that is not so."""
    one, other = set(one), set(other)
    one, other = one - other or one, other - one or other
    pairs = [(plan.owners[a], plan.owners[b]) for a in sorted(one) for b in sorted(other)]
    for a, b in pairs:
        if a.name != b.name and "fracture" in (a.kind, b.kind):
            return (a.name, b.name) if a.kind == "fracture" else (b.name, a.name)
    return None


def too_close(plan, pair, gap, where):
    allowed, tolerance = plan.network.minimum_distance, plan.network.tolerance
    advice = f"move one, or join them by a larger \"tolerance\" (now {tolerance:.3g} m)" if gap > tolerance else "move one"
    place = ", ".join(f"{x:.6g}" for x in where[:plan.dim])
    return (f"{pair[0]} and {pair[1]} are {gap:.3g} m apart at ({place}) without meeting; the \"minimum distance\" is {allowed:.3g} m; {advice}")


def close_edges(plan):
    """Of edges that share no point, and of points that are the ends of one edge."""
    reach, segments, ends = plan.network.minimum_distance, plan.graph.segments(), np.array(list(plan.edges))
    owners = list(plan.edges.values())
    i, j = near_pairs(segments.min(axis=1), segments.max(axis=1), reach)
    apart = ~(ends[i][:, :, None] == ends[j][:, None, :]).any(axis=(1, 2))
    i, j = i[apart], j[apart]
    s, _, gap = closest(segments[i], segments[j])
    for k in np.flatnonzero(gap < reach):
        pair = names(plan, owners[i[k]], owners[j[k]])
        if pair:
            yield pair, too_close(plan, pair, gap[k], segments[i[k], 0] + s[k] * (segments[i[k], 1] - segments[i[k], 0]))
    at, length = plan.graph.parents_at(), np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    for k in np.flatnonzero(length < reach):
        a, b = ends[k]
        pair = names(plan, at[a] - at[b] or at[a], at[b] - at[a] or at[b])
        if pair:
            yield pair, too_close(plan, pair, length[k], segments[k, 0])


def close_surfaces(plan):
    """Of points over surfaces that they are not on."""
    at = plan.graph.parents_at()
    reach, points = plan.network.minimum_distance, plan.points
    for k, surface in enumerate(plan.surfaces):
        near = np.flatnonzero(np.all((points > surface.low - reach) & (points < surface.high + reach), axis=1))
        height = abs(surface.plane.height(points[near]))
        near = near[height < reach]
        flat = surface.plane.inside(points[near])
        over = in_polygon(flat, np.array(surface.shape.exterior.coords[:-1]))
        for hole in surface.shape.interiors:
            over &= ~in_polygon(flat, np.array(hole.coords[:-1]))
        for p in near[over]:
            pair = None if k in at[p] | plan.loose.get(int(p), set()) else names(plan, [k], at[p])
            if pair:
                yield pair, too_close(plan, pair, abs(surface.plane.height(points[p])), points[p])


def small_angles(plan):
    """Of edges of different fractures at a point, 2D."""
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
                yield pair, f"{pair[0]} and {pair[1]} meet at {angle:.3g} degrees; the \"minimum angle\" is {minimum:g}"


def lying_on(plan):
    """Of edges of two fractures, 2D, or of one and the boundary."""
    for of in plan.edges.values():
        fractures = plan.fractures_of(of)
        side = next((plan.owners[k] for k in of if plan.owners[k].kind == "boundary"), None)
        if len(fractures) > 1:
            pair = fractures[0].name, fractures[1].name
            yield pair, f"{pair[0]} and {pair[1]} lie on each other; leave one out or make them one"
        elif fractures and side:
            yield (fractures[0].name, side.name), f"{fractures[0].name}: lies on {side.name}; a fracture needs rock on both sides"


def check(plan):
    """Refuses what is wrong, once for each two features."""
    found = list(lying_on(plan)) + list(small_angles(plan)) if plan.dim == 2 else []
    found = found or list(close_edges(plan)) + (list(close_surfaces(plan)) if plan.dim == 3 else [])
    first = {}
    for pair, line in found:
        first.setdefault(frozenset(pair), line)
    Errors(first.values()).throw()
