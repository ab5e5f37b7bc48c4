"""Bodies, i.e. the domain and its regions: their sides, and intersections with fractures."""
import numpy as np
from shapely.geometry import LineString, Polygon
from shapely.ops import polygonize, unary_union
from shapes import MAXIMUM, Feature, NetworkError, check_polygon, refuse
from surfaces import Surface, are_level, chords, heights, lines_of, overlap, polygons_of

BOX_SIDES = ["west", "east", "south", "north", "bottom", "top"]


def box_sides(low, high):
    """Returns the names and the corners of the sides of a rectangle or a box."""
    if len(low) == 2:
        x = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
        return ["south", "east", "north", "west"], x
    x = np.array([[(low, high)[k >> i & 1][i] for i in range(3)] for k in range(8)])
    faces = (0, 2, 6, 4), (1, 3, 7, 5), (0, 1, 5, 4), (2, 3, 7, 6), (0, 1, 3, 2), (4, 5, 7, 6)
    return BOX_SIDES, [x[list(face)] for face in faces]


def rows(numbers, n, place, minimum):
    """Returns numbers as an array of points with n coordinates. Error for fewer than `minimum` points."""
    if len(numbers) % n or len(numbers) < minimum * n:
        raise NetworkError(f"{place}: has {len(numbers)} numbers, needs {n} for each of at least {minimum} points")
    return np.array(numbers, float).reshape(-1, n)


def in_polygon(points, ring):
    """Returns whether points (n, 2) are inside a polygon, by the parity of crossings."""
    inside = np.zeros(len(points), bool)
    for a, b in zip(ring, np.roll(ring, -1, axis=0)):
        crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        rise = b[1] - a[1] if b[1] != a[1] else 1.0
        inside ^= crosses & (points[:, 0] < a[0] + (points[:, 1] - a[1]) / rise * (b[0] - a[0]))
    return inside


class Body:
    """Polygon in 2D or polyhedron in 3D. Its sides are features of one kind, in one group or each in its own group."""

    def __init__(self, place, description, kind, group=None):
        self.place = place
        low, high = (np.array(description[f"{which} corner"]) for which in ("lower", "upper"))
        if len(low):
            self.dim = len(low)
            if self.dim not in (2, 3) or not (high > low).all():
                raise NetworkError(f"{place}: \"upper corner\" must be above \"lower corner\" in each of 2 or 3 directions")
            names, sides = box_sides(low, high)
        elif description["corners"]:
            self.dim, sides = 2, rows(description["corners"], 2, f"{place} > \"corners\"", 3)
            names = description.get("sides") or [f"side {k + 1}" for k in range(len(sides))]
        else:
            self.dim, names = 3, list(description["faces"])
            sides = [rows(face["points"], 3, f"{place} > faces > {name}", 3) for name, face in description["faces"].items()]
        points = np.concatenate(list(sides)) if self.dim == 3 else sides
        self.low, self.high = points.min(axis=0), points.max(axis=0)
        largest = points.ravel()[np.abs(points).argmax()]
        if abs(largest) > MAXIMUM:
            raise NetworkError(f"{place}: has the coordinate {largest:g} m; at most {MAXIMUM:g} m are allowed")
        self.size = np.linalg.norm(self.high - self.low)
        if self.dim == 2:
            self.corners, self.shape = sides, Polygon(sides)
            if not self.shape.is_valid or self.shape.area == 0:
                raise NetworkError(f"{place}: the polygon crosses itself or has no area")
            sides = np.stack([sides, np.roll(sides, -1, axis=0)], axis=1)
            self.volume = self.shape.area
        self.sides = [Feature(kind, group or name, f'side "{name}" of {place}', np.array(x)) for name, x in zip(names, sides)]
        if self.dim == 3:
            self.close()

    def close(self):
        """Creates the surfaces and the volume of a polyhedron. Error if it is not closed."""
        count = {}
        for side in self.sides:
            check_polygon(side, 1e-9 * self.size)
            for a, b in Surface.whole(side).sides():
                edge = tuple(sorted(tuple(np.round(x / self.size, 8) + 0.0) for x in (a, b)))
                count[edge] = count.get(edge, 0) + 1
        if any(n != 2 for n in count.values()):
            raise NetworkError(f"{self.place}: the faces are not closed: each edge must belong to two faces, from corner to corner")
        self.surfaces = [Surface.whole(side) for side in self.sides]
        self.volume = 0.0
        for s in self.surfaces:
            x = s.plane.outside(s.shape.representative_point().coords[0])
            is_out = not self.contains((x + 1e-6 * self.size * s.plane.normal)[None])[0]
            self.volume += (1 if is_out else -1) * s.shape.area * ((x - self.low) @ s.plane.normal) / 3

    def contains(self, points):
        """Returns whether points (n, dim) are inside."""
        if self.dim == 2:
            return in_polygon(points, self.corners)
        inside = np.zeros(len(points), bool)
        ray = np.array([0.5372, 0.6231, 0.5688])  # unlikely to be parallel to a side
        for s in self.surfaces:
            t = -s.plane.height(points) / (ray @ s.plane.normal)
            inside ^= (t > 0) & in_polygon(s.plane.inside(points + t[:, None] * ray), s.shape.exterior.coords[:-1])
        return inside

    def clip_line(self, line, tolerance):
        """Returns the parts of a polyline inside the body, as arrays of points."""
        shape = LineString(line.points)
        if self.shape.buffer(tolerance).contains(shape):
            return [line.points]
        parts = lines_of(shape.intersection(self.shape))
        return [np.array(part.coords) for part in parts if part.length > tolerance]

    def section(self, plane, tolerance):
        """Returns the intersection of the body with a plane, as a shape in coordinates of the plane."""
        lines = []
        for s in self.surfaces:
            along = np.cross(s.plane.normal, plane.normal)
            if np.linalg.norm(along) < 1e-9:
                continue
            for (_, a), (_, b) in chords(s, heights(s, plane, tolerance), along / np.linalg.norm(along), tolerance):
                if np.linalg.norm(b - a) > tolerance:
                    lines.append(LineString(np.round(plane.inside(np.array([a, b])), 12 - int(np.log10(self.size)))))
        pieces = [p for p in polygonize(lines_of(unary_union(lines))) if self.contains(plane.outside([p.representative_point().coords[0]]))[0]]
        return unary_union(pieces)

    def clip_polygon(self, whole, tolerance):
        """Returns the parts of a surface inside the body, as surfaces. Error for a fracture on a side."""
        polygon = whole.feature
        for s in self.surfaces:
            if are_level(whole, s, tolerance) and overlap(s, whole, tolerance):
                if polygon.kind == "fracture":
                    refuse(polygon, f"lies on {s.feature.name}; a fracture needs rock on both sides")
                return [whole]
        section = self.section(whole.plane, tolerance)
        if section.buffer(tolerance).contains(whole.shape):
            return [whole]
        parts = polygons_of(whole.shape.buffer(0).intersection(section))
        return [Surface.of_shape(polygon, whole.plane, part) for part in parts if part.area > tolerance * part.length]
