"""Features, i.e. fractures and other constraints of a mesh, as points in space; frames of planes."""
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from shapely.geometry import LineString, Polygon
from shapely.validation import explain_validity


MAXIMUM = 1e12  # largest coordinate, m


class NetworkError(Exception):
    """Errors of a network, a line each. `files` are names that may start a line.

    `features` contains the names of the conflicting features of each line. It is empty for other errors."""

    def __init__(self, what, files=(), features=()):
        super().__init__(what)
        self.files, self.features = files, list(features)


class Unusable(NetworkError):
    """Error of a fracture that a large map may contain: outside of the domain, too short, without geometry."""


HINT = ("\"unusable fractures\" = \"left out\" in the section network omits and lists fractures that are outside of the "
        "domain, too short or without geometry; \"layers\" of a set selects layers of a drawing")


class Errors:
    """Collects errors, one line each, and raises them together."""

    MAXIMUM = 20

    def __init__(self, lines=(), features=()):
        self.lines, self.features = list(lines), list(features)
        self.has_unusable = False

    @contextmanager
    def of_one(self):
        try:
            yield
        except NetworkError as error:
            self.lines.append(f"{error}; {HINT}" if isinstance(error, Unusable) and not self.has_unusable else str(error))
            self.features += error.features or [()]  # other random fractures would not help
            self.has_unusable |= isinstance(error, Unusable)

    def throw(self, files=()):
        if self.lines:
            more = [f"and {len(self.lines) - self.MAXIMUM} more"] if len(self.lines) > self.MAXIMUM else []
            raise NetworkError("\n".join(self.lines[:self.MAXIMUM] + more), [*files, "and "], self.features)


@dataclass
class Feature:
    """Polyline in 2D, plane polygon in 3D."""
    kind: str  # "fracture", "constraint", "boundary" or "region"
    group: str  # in the mesh: name of the set, the boundary or the region
    name: str  # for messages
    points: np.ndarray = field(repr=False)  # (n, 2) or (n, 3), m
    single: str = ""  # fractures: name in results, common to all parts of a fracture
    source: str = ""  # fractures: file or section of origin
    properties: dict = field(default_factory=dict)  # fractures: own entries of the joint, as texts


def at(point, extent):
    """Returns a point as text, with a resolution of 0.01 m and 1e-4 of the extent, or better."""
    finest, largest = min(0.01, 1e-4 * extent), np.abs(point).max()
    digits = max(6, int(np.floor(np.log10(max(largest, finest) / finest))) + 1)
    return f"({', '.join(f'{x:.{digits}g}' for x in point)})"


def refuse(feature, what):
    raise NetworkError(f"{feature.name}: {what}", features=[(feature.name,)])


def unusable(feature, what):
    raise Unusable(f"{feature.name}: {what}", features=[(feature.name,)])


def thinned(points, tolerance):
    """Returns a polyline without points within the tolerance of the previous one. The ends stay."""
    selected = [0]
    for k in range(1, len(points)):
        if np.linalg.norm(points[k] - points[selected[-1]]) > tolerance:
            selected.append(k)
    last = len(points) - 1
    if selected[-1] != last:
        selected[-1 if len(selected) > 1 else len(selected):] = [last]
    return points[selected]


class Plane:
    """Plane through the points of a polygon, with coordinates in the plane."""

    def __init__(self, points):
        self.centre = points.mean(axis=0)
        area = 0.5 * np.cross(points - self.centre, np.roll(points, -1, axis=0) - self.centre).sum(axis=0)
        self.area = np.linalg.norm(area)  # of a polygon without self-intersection
        if self.area > 0:
            self.normal = area / self.area
            longest = np.argmax(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1))
            along = np.roll(points, -1, axis=0)[longest] - points[longest]
            along = along - self.normal * (self.normal @ along)
            self.axes = np.array([along, np.cross(self.normal, along)]) / np.linalg.norm(along)

    def height(self, points):
        return (points - self.centre) @ self.normal

    def inside(self, points):
        """Returns the coordinates [point, 2] in the plane."""
        return (points - self.centre) @ self.axes.T

    def outside(self, coordinates):
        """Returns the points [point, 3] of coordinates in the plane."""
        return self.centre + np.asarray(coordinates) @ self.axes


def diameter(points):
    """Returns the largest distance between two of the points."""
    return max(np.linalg.norm(points - point, axis=1).max() for point in points)


def frame(strike, dip, rake=0.0):
    """Returns two axes in a plane and its upward normal. x points to the east, y to the north; angles are in degrees.

    The strike is clockwise from north, and the plane dips to its right. The first axis is the strike direction, turned
    upwards by the rake."""
    s, d, r = np.radians([strike, dip, rake])
    along = np.array([np.sin(s), np.cos(s), 0])
    normal = np.array([np.sin(d) * np.cos(s), -np.sin(d) * np.sin(s), np.cos(d)])
    up = np.cross(normal, along)
    return np.cos(r) * along + np.sin(r) * up, np.cos(r) * up - np.sin(r) * along, normal


def regular(centre, first, second, n):
    """Returns n points of the ellipse with the half axes `first` and `second`."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.asarray(centre) + np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second)


def ellipse(centre, radii, strike, dip, rake, n=32):
    """Returns a polygon with n corners and the area of the ellipse."""
    first, second, _ = frame(strike, dip, rake)
    scale = np.sqrt(2 * np.pi / n / np.sin(2 * np.pi / n))
    return regular(centre, scale * radii[0] * first, scale * radii[1] * second, n)


def check_line(line, tolerance):
    """Raises an error for a polyline without length or with a self-intersection."""
    if not np.isfinite(line.points).all():
        refuse(line, "has a coordinate that is not a finite number")
    length = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    if length.min() <= tolerance:
        unusable(line, f"has no length: its ends are {length.min():.3g} m apart, the \"tolerance\" is {tolerance:.3g} m; reduce "
                       "it, or remove the line")
    if not LineString(line.points).is_simple:
        refuse(line, "crosses itself; divide it into two fractures")


def check_polygon(polygon, tolerance):
    """Raises an error for a polygon without area, not plane, or with a self-intersection, in 3D."""
    points = polygon.points
    if not np.isfinite(points).all():
        refuse(polygon, "has a coordinate that is not a finite number")
    if len(points) < 3:
        refuse(polygon, f"has {len(points)} corners, needs at least 3")
    edge = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    if edge.min() <= tolerance:
        k = int(np.argmin(edge))
        refuse(polygon, f"corners {k + 1} and {(k + 1) % len(points) + 1} are {edge.min():.3g} m apart, the tolerance is {tolerance:.3g} m")
    _, _, axes = np.linalg.svd(points - points.mean(axis=0))  # best fit, valid with self-intersections
    height = abs((points - points.mean(axis=0)) @ axes[2]).max()
    if height > tolerance:
        refuse(polygon, f"is not plane: a corner is {height:.3g} m from the plane of best fit, the tolerance is {tolerance:.3g} m")
    flat = Polygon((points - points.mean(axis=0)) @ axes[:2].T)
    if not flat.is_valid and flat.convex_hull.area > tolerance * edge.sum():
        refuse(polygon, f"crosses or touches itself ({explain_validity(flat).split('[')[0].lower()})")
    if flat.area <= tolerance * edge.sum():
        refuse(polygon, f"has no area: {flat.area:.3g} m^2")
