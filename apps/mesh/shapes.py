"""Fractures, and what else cells keep to, as points in space; the frame of a plane."""
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from shapely.geometry import LineString, Polygon
from shapely.validation import explain_validity


MOST = 1e12  # m; the largest coordinate


class NetworkError(Exception):
    """What is wrong with a network: a line for each thing; `files` open lines about themselves. `features` has the names of those
    that stand in each other's way, a tuple for each line; empty where the fault is not theirs."""

    def __init__(self, what, files=(), features=()):
        super().__init__(what)
        self.files, self.features = files, list(features)


class Unusable(NetworkError):
    """A fracture that a larger map may well have, and a network cannot: outside of the domain, too short, without geometry."""


HINT = ("\"unusable fractures\" = \"left out\" in the section network leaves fractures out that are outside of the domain, "
        "too short or without geometry, and lists them; \"layers\" of a set chooses those of a drawing")


class Errors:
    """Collects what is wrong with several things, to tell it all at once: a line each."""

    MOST = 20

    def __init__(self, lines=(), features=()):
        self.lines, self.features = list(lines), list(features)
        self.has_unusable = False

    @contextmanager
    def of_one(self):
        try:
            yield
        except NetworkError as error:
            self.lines.append(f"{error}; {HINT}" if isinstance(error, Unusable) and not self.has_unusable else str(error))
            self.features += error.features or [()]  # which no other drawing mends
            self.has_unusable |= isinstance(error, Unusable)

    def throw(self, files=()):
        if self.lines:
            more = [f"and {len(self.lines) - self.MOST} more"] if len(self.lines) > self.MOST else []
            raise NetworkError("\n".join(self.lines[:self.MOST] + more), [*files, "and "], self.features)


@dataclass
class Feature:
    """A polyline in 2D, a plane polygon in 3D."""
    kind: str  # "fracture", "constraint", "boundary" or "region"
    group: str  # of the mesh: name of the set, the boundary or the region
    name: str  # in messages
    points: np.ndarray = field(repr=False)  # (n, 2) or (n, 3), m
    single: str = ""  # of a fracture: how results call it; several of one name are one
    source: str = ""  # of a fracture: the file or the section that it is from
    properties: dict = field(default_factory=dict)  # entries of its joint that it has of its own, as texts


def at(point, extent):
    """A place in words, to a hundredth of a metre and to 1e-4 of the extent or better."""
    finest, largest = min(0.01, 1e-4 * extent), np.abs(point).max()
    digits = max(6, int(np.floor(np.log10(max(largest, finest) / finest))) + 1)
    return f"({', '.join(f'{x:.{digits}g}' for x in point)})"


def refuse(feature, what):
    raise NetworkError(f"{feature.name}: {what}", features=[(feature.name,)])


def unusable(feature, what):
    raise Unusable(f"{feature.name}: {what}", features=[(feature.name,)])


def thinned(points, tolerance):
    """A polyline without the points that are within the tolerance of the one before; its ends stay."""
    kept = [0]
    for k in range(1, len(points)):
        if np.linalg.norm(points[k] - points[kept[-1]]) > tolerance:
            kept.append(k)
    last = len(points) - 1
    if kept[-1] != last:
        kept[-1 if len(kept) > 1 else len(kept):] = [last]
    return points[kept]


class Plane:
    """The plane through the points of a polygon, with coordinates in it."""

    def __init__(self, points):
        self.centre = points.mean(axis=0)
        area = 0.5 * np.cross(points - self.centre, np.roll(points, -1, axis=0) - self.centre).sum(axis=0)
        self.area = np.linalg.norm(area)  # of a polygon that does not cross itself
        if self.area > 0:
            self.normal = area / self.area
            longest = np.argmax(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1))
            along = np.roll(points, -1, axis=0)[longest] - points[longest]
            along = along - self.normal * (self.normal @ along)
            self.axes = np.array([along, np.cross(self.normal, along)]) / np.linalg.norm(along)

    def height(self, points):
        return (points - self.centre) @ self.normal

    def inside(self, points):
        """Coordinates in the plane."""
        return (points - self.centre) @ self.axes.T

    def outside(self, coordinates):
        """The points of coordinates in the plane."""
        return self.centre + np.asarray(coordinates) @ self.axes


def diameter(points):
    """The largest distance between two of the points."""
    return max(np.linalg.norm(points - point, axis=1).max() for point in points)


def frame(strike, dip, rake=0.0):
    """Two axes in a plane and its upward normal; x points east, y north. Strike is clockwise from north, the plane dips
    to the right of it; the first axis is the strike turned upwards by the rake. Degrees."""
    s, d, r = np.radians([strike, dip, rake])
    along = np.array([np.sin(s), np.cos(s), 0])
    normal = np.array([np.sin(d) * np.cos(s), -np.sin(d) * np.sin(s), np.cos(d)])
    up = np.cross(normal, along)
    return np.cos(r) * along + np.sin(r) * up, np.cos(r) * up - np.sin(r) * along, normal


def regular(centre, first, second, n):
    """n points of the ellipse with these half axes."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.asarray(centre) + np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second)


def ellipse(centre, radii, strike, dip, rake, n=32):
    """A polygon of n corners with the area of the ellipse."""
    first, second, _ = frame(strike, dip, rake)
    scale = np.sqrt(2 * np.pi / n / np.sin(2 * np.pi / n))
    return regular(centre, scale * radii[0] * first, scale * radii[1] * second, n)


def check_line(line, tolerance):
    """Refuses a polyline that has no length or crosses itself."""
    if not np.isfinite(line.points).all():
        refuse(line, "has a coordinate that is no finite number")
    length = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    if length.min() <= tolerance:
        unusable(line, f"has no length: its ends are {length.min():.3g} m apart, the \"tolerance\" is {tolerance:.3g} m; make "
                       "it smaller, or leave the line out")
    if not LineString(line.points).is_simple:
        refuse(line, "crosses itself; make it two fractures")


def check_polygon(polygon, tolerance):
    """Refuses a polygon in 3D without area, not plane, or crossing itself."""
    points = polygon.points
    if not np.isfinite(points).all():
        refuse(polygon, "has a coordinate that is no finite number")
    if len(points) < 3:
        refuse(polygon, f"has {len(points)} corners, needs at least 3")
    edge = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    if edge.min() <= tolerance:
        k = int(np.argmin(edge))
        refuse(polygon, f"corners {k + 1} and {(k + 1) % len(points) + 1} are {edge.min():.3g} m apart, the tolerance is {tolerance:.3g} m")
    _, _, axes = np.linalg.svd(points - points.mean(axis=0))  # of best fit, also where the polygon crosses itself
    height = abs((points - points.mean(axis=0)) @ axes[2]).max()
    if height > tolerance:
        refuse(polygon, f"is not plane: a corner is {height:.3g} m from the plane of best fit, the tolerance is {tolerance:.3g} m")
    flat = Polygon((points - points.mean(axis=0)) @ axes[:2].T)
    if not flat.is_valid and flat.convex_hull.area > tolerance * edge.sum():
        refuse(polygon, f"crosses or touches itself ({explain_validity(flat).split('[')[0].lower()})")
    if flat.area <= tolerance * edge.sum():
        refuse(polygon, f"has no area: {flat.area:.3g} m^2")
