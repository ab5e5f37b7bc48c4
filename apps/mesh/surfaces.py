"""Plane polygons in space and the segments in which they meet."""
import numpy as np
from shapely.geometry import Point, Polygon
from shapely.ops import unary_union
from shapes import NetworkError, Plane


class Surface:
    """Plane polygon of a feature, possibly with holes.

    rings  corners, within the tolerance of the plane
    shape  polygon in coordinates of the plane"""

    def __init__(self, feature, plane, rings):
        self.feature, self.plane, self.rings = feature, plane, rings
        flat = [plane.inside(ring) for ring in rings]
        self.shape = Polygon(flat[0], flat[1:])
        points = np.concatenate(rings)
        self.low, self.high = points.min(axis=0), points.max(axis=0)

    @classmethod
    def whole(cls, feature):
        return cls(feature, Plane(feature.points), [feature.points])

    @classmethod
    def of_shape(cls, feature, plane, shape):
        return cls(feature, plane, [plane.outside(np.array(ring.coords[:-1])) for ring in (shape.exterior, *shape.interiors)])

    def sides(self):
        """Returns the segments (n, 2, 3) of all rings."""
        return np.concatenate([np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in self.rings])

    def contains(self, point, tolerance):
        return self.shape.distance(Point(self.plane.inside(point))) <= tolerance


def moved_onto(surface, others, tolerance):
    """Moves corners onto other surfaces closer than the tolerance, within the plane of the surface.

    Returns the new surface, and [(distance in m, other surface)] of the movements. Corners that would move by more
    than 4 tolerances stay."""
    rings, reported = [ring.copy() for ring in surface.rings], []
    close = [o for o in others if o is not surface and np.all(o.low <= surface.high + tolerance) and np.all(o.high >= surface.low - tolerance)]
    slopes = [surface.plane.axes @ o.plane.normal for o in close]  # gradients of the heights
    for ring in rings:
        for k, corner in enumerate(ring):
            near = [(o.plane.height(corner), slope, o) for o, slope in zip(close, slopes)
                    if abs(o.plane.height(corner)) <= tolerance < 4 * tolerance * np.linalg.norm(slope) and o.contains(corner, tolerance)]
            near = near[:2]  # two planes determine a corner
            height = np.array([h for h, _, _ in near])
            if not near or abs(height).max() < 1e-12 * np.linalg.norm(surface.high - surface.low):
                continue
            step = -np.linalg.lstsq(np.array([s for _, s, _ in near]), height, rcond=1e-3)[0]
            if np.linalg.norm(step) <= 4 * tolerance:
                ring[k] = corner + step @ surface.plane.axes
                reported += [(abs(h), o) for h, _, o in near]
    return Surface(surface.feature, surface.plane, rings), reported


def heights(surface, plane, tolerance):
    """Returns the heights of the corners of each ring above a plane. Heights within the tolerance are 0."""
    all_heights = [plane.height(ring) for ring in surface.rings]
    return [np.where(abs(height) <= tolerance, 0, height) for height in all_heights]


def chords(surface, height, along, tolerance):
    """Returns the intersections of a line with a surface in the same plane: [((s0, point), (s1, point)), ...].

    s is the coordinate along the line, with s0 = s1 for a single point. The signs of `height` give the side of the line
    for each corner."""
    hits = []
    for ring, h in zip(surface.rings, height):
        for k in range(len(ring)):
            a, b = h[k - 1], h[k]
            if b == 0:
                hits.append(ring[k])
            elif a * b < 0:
                hits.append(ring[k - 1] + a / (a - b) * (ring[k] - ring[k - 1]))
    hits = sorted(((float(along @ x), x) for x in hits), key=lambda hit: hit[0])
    found = []
    for here, after in zip(hits, hits[1:]):
        if surface.contains(0.5 * (here[1] + after[1]), tolerance):
            found.append((here, after))
        elif not found or found[-1][1] is not here:
            found.append((here, here))
    if hits and (not found or found[-1][1] is not hits[-1]):
        found.append((hits[-1], hits[-1]))
    return found


def traces(one, other, tolerance):
    """Returns the segments [(begin, end), ...] in which two nonparallel surfaces meet, with begin = end for a point."""
    on_other, on_one = heights(one, other.plane, tolerance), heights(other, one.plane, tolerance)
    for height in (on_other, on_one):
        if all((h > 0).all() for h in height) or all((h < 0).all() for h in height):
            return []
    along = np.cross(one.plane.normal, other.plane.normal)
    along /= np.linalg.norm(along)
    found = []
    for a0, a1 in chords(one, on_other, along, tolerance):
        for b0, b1 in chords(other, on_one, along, tolerance):
            begin, end = max(a0, b0, key=lambda hit: hit[0]), min(a1, b1, key=lambda hit: hit[0])
            if end[0] >= begin[0]:
                found.append((begin[1], end[1]))
            elif begin[0] - end[0] <= tolerance:
                found.append((begin[1], begin[1]))
    return found


def are_level(one, other, tolerance):
    """Returns whether the smaller surface lies in the plane of the larger, within the tolerance."""
    small, large = sorted((one, other), key=lambda surface: surface.shape.area)
    return all((h == 0).all() for h in heights(small, large.plane, tolerance))


def polygons_of(shape):
    """Returns the polygons in a shape of any type."""
    if shape.geom_type == "Polygon":
        return [shape] if shape.area > 0 else []
    return [part for piece in getattr(shape, "geoms", []) for part in polygons_of(piece)]


def lines_of(shape):
    if shape.geom_type in ("LineString", "LinearRing"):
        return [shape] if shape.length > 0 else []
    return [part for piece in getattr(shape, "geoms", []) for part in lines_of(piece)]


def overlap(one, other, tolerance):
    """Returns whether two surfaces in one plane overlap by more than the tolerance.

    Both are reduced by half of the tolerance, since GEOS can fail for polygons with sides that differ by round-off."""
    rings = [one.plane.inside(ring) for ring in other.rings]
    return one.shape.buffer(-0.5 * tolerance).intersects(Polygon(rings[0], rings[1:]).buffer(-0.5 * tolerance))


def without(surface, others, tolerance):
    """Returns the parts of a surface outside of others in the same plane. The gaps are smaller than the tolerance."""
    left = surface.shape.buffer(0)
    taken = [Polygon(surface.plane.inside(o.rings[0]), [surface.plane.inside(r) for r in o.rings[1:]]).buffer(0.5 * tolerance) for o in others]
    left = left.difference(unary_union(taken))
    return [Surface.of_shape(surface.feature, surface.plane, part) for part in polygons_of(left) if part.area > tolerance * part.length]


def angle_between(one, other, point, along):
    """Returns the smallest angle, in degrees, between two surfaces at a point of their common line."""
    step = 1e-3 * min(np.linalg.norm(s.high - s.low) for s in (one, other))
    directions = []
    for surface in (one, other):
        across = np.cross(surface.plane.normal, along)
        across /= np.linalg.norm(across)
        directions.append([d for d in (across, -across) if surface.shape.contains(Point(surface.plane.inside(point + step * d)))])
    return min((np.degrees(np.arccos(np.clip(d @ e, -1, 1))) for d in directions[0] for e in directions[1]), default=90.0)


def check_angles(one, other, found, minimum):
    for begin, end in found:
        if np.linalg.norm(end - begin) == 0:
            continue
        angle = angle_between(one, other, 0.5 * (begin + end), (end - begin) / np.linalg.norm(end - begin))
        if angle < minimum:
            raise NetworkError(f"{one.feature.name} and {other.feature.name} meet at {angle:.3g} degrees; the \"minimum angle\" is {minimum:g}",
                               features=[(one.feature.name, other.feature.name)])


def angle_of_planes(one, other):
    """Returns the angle between two planes, from 0 to 90 degrees."""
    sine, cosine = np.linalg.norm(np.cross(one.normal, other.normal)), abs(one.normal @ other.normal)
    return float(np.degrees(np.arctan2(sine, cosine)))


def heights_over(one, other):
    """Returns the lowest and highest height above `other` of the part of `one` whose projection lies on `other`, or None."""
    ring = one.plane.inside(other.rings[0])
    common = one.shape.buffer(0).intersection(Polygon(ring).buffer(0))
    if common.is_empty:
        return None
    flat = np.concatenate([np.array(part.exterior.coords) for part in polygons_of(common)] or [np.zeros((0, 2))])
    height = other.plane.height(one.plane.outside(flat))
    return (height.min(), height.max()) if len(height) else None


def are_close(one, other, distance):
    """Returns whether two nearly parallel surfaces come closer than a distance."""
    found = heights_over(one, other)
    return found is not None and found[0] < distance and found[1] > -distance


def trimmed(points, other, distance):
    """Returns the largest part of a polygon on one side of the plane of another polygon, at the distance or farther."""
    plane, limit = Plane(points), Plane(other)
    height, flat = limit.height(points), plane.inside(points)
    best = None
    for side in (1.0, -1.0):
        h, ring = side * height - distance, []
        for k in range(len(flat)):
            a, b = h[k - 1], h[k]
            if a * b < 0:
                ring.append(flat[k - 1] + a / (a - b) * (flat[k] - flat[k - 1]))
            if b >= 0:
                ring.append(flat[k])
        if len(ring) > 2:
            parts = polygons_of(Polygon(ring).buffer(0))
            for part in parts:
                if best is None or part.area > best.area:
                    best = part
    return None if best is None else plane.outside(np.array(best.exterior.coords[:-1]))
