"""Geometry for gmsh: points, edges and plane faces that meet only in edges and points, with their owners."""
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
from arrange import Graph, arrange, near_pairs, on_segment
from join_lines import joined
from journal import distance
from joined_graph import JoinedGraph
from shapely.geometry import LineString, Point
from shapely.ops import polygonize
from shapes import Errors, NetworkError, Plane, Unusable, check_line, check_polygon, refuse, thinned, unusable
from surfaces import Surface, angle_of_planes, are_close, are_level, check_angles, moved_onto, overlap, traces, without

MAX_MOVED = {"join": 2.0, "drop": 1.0}  # largest movement of points of fractures by repairs, in tolerances


class Face:
    """Plane face: rings of points, first the outer ring, with the edges and points embedded in the face."""

    def __init__(self, owner, rings, shape):
        self.owner, self.rings, self.shape = owner, rings, shape
        self.edges, self.points = [], []


class Plan:
    """Geometry of a network.

    points  (n, 3)
    edges   {(a, b): indices of owners}
    owners  features; a feature in several parts occurs more than once
    repairs lines of the report"""

    def __init__(self, network):
        self.network, self.dim = network, network.dim
        self.repairs, self.surfaces, self.found_faces = list(network.joined), None, None
        self.attempts = 1
        # In 3D a larger tolerance for edges would bend surfaces. Only corners move, within their planes.
        self.tolerance = network.tolerance if self.dim == 2 else min(network.tolerance, 1e-6 * network.domain.size)
        self.touching, joins = {}, network.repair == "join"  # {point where features touch: indices of owners}
        if joins and self.dim == 2:
            self.owners, graph = joined(network)
            self.check_sets()
        else:
            self.owners, segments, parents, touches = (self.lines if self.dim == 2 else self.polygons)()
            graph = self.joined_surfaces(segments, parents, touches) if joins else arrange(segments, parents, self.tolerance)
        self.points, self.edges = graph.points, graph.edges
        self.graph = graph
        self.report_joined(graph)
        if self.dim == 2 and not joins:
            self.straighten_sides()
            self.part_overlaps()
        for point, of in touches if not joins else ():
            self.touching.setdefault(int(np.argmin(np.linalg.norm(self.points - point, axis=1))), set()).update(of)

    def joined_surfaces(self, segments, parents, touches):
        """Returns the graph of surfaces in 3D joined within the tolerance. Points may leave the planes of fractures."""
        network = self.network
        graph = JoinedGraph(segments, parents, range(len(network.domain.surfaces)), network.tolerance, self.surfaces, touches)
        graph.repair(np.radians(network.minimum_angle))
        self.touching, self.tolerance = dict(graph.touches), network.tolerance
        return Graph(graph.points, {edge: frozenset(of) for edge, of in graph.edges.items()})

    def is_fracture(self, owner):
        return self.owners[owner].kind == "fracture"

    def fractures_of(self, owners):
        """Returns the fractures among owners, each once, in their order."""
        return list({id(self.owners[k]): self.owners[k] for k in sorted(owners) if self.is_fracture(k)}.values())

    def report_joined(self, graph):
        reported = set()
        for gap, one, other in sorted(graph.joined, key=lambda join: -join[0]):
            names = {self.owners[k].name for k in one} ^ {self.owners[k].name for k in other}
            names = tuple(sorted(names or {self.owners[k].name for k in one}))
            if names not in reported:
                reported.add(names)
                self.repairs.append(f"closed a gap of {gap:.3g} m: " + " and ".join(names))

    def straighten_sides(self):
        """Moves points joined to one side of the domain onto this side, in 2D. Corners are on two sides and stay."""
        sides = {}
        for edge, of in self.edges.items():
            for k in of:
                if self.owners[k].kind == "boundary":
                    for point in edge:
                        sides.setdefault(point, set()).add(k)
        for point, of in sides.items():
            if len(of) == 1:
                begin, end = self.owners[min(of)].points
                along = (end - begin) / np.linalg.norm(end - begin)
                self.points[point, :2] = begin + (self.points[point, :2] - begin) @ along * along

    def check_movements(self):
        """Raises an error for each fracture with a point that joining moved by more than MAX_MOVED tolerances."""
        points, journal, errors = {}, self.network.journal, Errors()
        for point, of in self.graph.parents_at().items():
            for k in of:
                if self.is_fracture(k):
                    points.setdefault(self.owners[k].name, []).append(point)
        limit = MAX_MOVED[self.network.repair] * self.network.tolerance
        for name, of in points.items():
            moved = distance(self.points[of, :self.dim], journal.entries[name].points).max()
            if moved > limit + journal.noise:
                errors.lines.append(f"{name}: joining moves it by {moved:.3g} m, the limit is {limit:.3g} m")
                errors.features.append((name,))
        errors.throw()

    def part_overlaps(self):
        """Assigns an edge of several features to the first, if joining points at an angle made them overlap."""
        minimum = max(self.network.minimum_angle, 0.01)
        for edge, of in self.edges.items():
            owners = [k for k in sorted(of) if self.owners[k].kind in ("fracture", "boundary")]
            middle = 0.5 * (self.points[edge[0]] + self.points[edge[1]])[:2]
            along = [direction(self.owners[k].points, middle) for k in owners] if len(owners) > 1 else []
            for k, other in zip(owners[1:], along[1:]):
                angle = np.degrees(np.arcsin(min(1, abs(along[0][0] * other[1] - along[0][1] * other[0]))))
                if angle >= minimum and self.is_fracture(k):
                    self.edges[edge] = self.edges[edge] - {k}
                    length = np.linalg.norm(self.points[edge[0]] - self.points[edge[1]])
                    self.repairs.append(f"joined along {length:.3g} m: {self.owners[owners[0]].name} and {self.owners[k].name}")

    def lines(self):
        """Returns owners, segments and the owners of the segments of a network in 2D."""
        network, domain = self.network, self.network.domain
        owners, errors = list(domain.sides), Errors()
        for line in network.fractures + network.constraints + [s for body in network.regions for s in body.sides]:
            with errors.of_one(), self.leaving_out(line):
                self.thin(line)
                check_line(line, network.tolerance)
                parts = self.worth(line, domain.clip_line(line, network.tolerance))
                owners += [replace(line, points=x) for x in parts]
        errors.throw()
        self.check_sets()
        check_same(network.fractures, network.tolerance)
        segments, parents = [], []
        for k, owner in enumerate(owners):
            flat = np.column_stack([owner.points, np.zeros(len(owner.points))])
            segments += list(np.stack([flat[:-1], flat[1:]], axis=1))
            parents += [frozenset([k])] * (len(flat) - 1)
        return owners, np.array(segments), parents, []

    @contextmanager
    def leaving_out(self, feature):
        """Context that omits an unusable fracture or constraint if the network allows it."""
        try:
            yield
        except Unusable as error:
            if not self.network.leaves_out or feature.kind not in ("fracture", "constraint"):
                raise
            self.repairs.append(f"left out: {error}")
            why = str(error).removeprefix(f"{feature.name}: ")
            self.network.journal.leave_out(feature, why, "outside" if "outside" in why else "short")
            self.network.fractures = [one for one in self.network.fractures if one is not feature]

    def check_sets(self):
        """Checks that each set has a fracture in the domain."""
        out = self.network.journal.why
        left, errors = {one.group for one in self.network.fractures if one.name not in out}, Errors()
        for name in self.network.entries["fractures"]:
            if name not in left:
                errors.lines.append(f"{self.network.place('fractures > ' + name)}: has no usable fracture in the domain")
        errors.throw()

    def thin(self, line):
        """Removes points of a polyline closer than the tolerance. Sides of bodies do not change."""
        if line.kind not in ("fracture", "constraint") or not np.isfinite(line.points).all():
            return
        points = thinned(line.points, self.network.tolerance)
        dropped = len(line.points) - len(points)
        line.points = points
        if dropped:
            self.repairs.append(f"left out {dropped} point{'s' if dropped > 1 else ''} closer to others than the tolerance: {line.name}")

    def worth(self, line, parts):
        """Returns the parts of a line that are longer than the minimum distance; reports others.

        Error for a fracture or constraint without such a part."""
        length = [np.linalg.norm(np.diff(x, axis=0), axis=1).sum() for x in parts]
        minimum = {"fracture": self.network.minimum_distance, "constraint": self.tolerance}.get(line.kind, 0)
        whole = np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum()
        if whole < minimum:
            unusable(line, f"is {whole:.3g} m long, shorter than the \"minimum distance\", {minimum:.3g} m; reduce it, or "
                           "remove the line")
        if max(length, default=0) < minimum:
            unusable(line, "lies outside of the domain")
        for x in length:
            if x < self.network.minimum_distance:
                self.repairs.append(f"left out a part of {x:.3g} m in the domain: {line.name}")
        return [part for part, x in zip(parts, length) if x >= self.network.minimum_distance]

    def polygons(self):
        """Returns owners, segments, their owners, and points of contact of surfaces, of a network in 3D."""
        network, domain, tolerance, joins = self.network, self.network.domain, self.tolerance, self.network.repair == "join"
        surfaces, errors = list(domain.surfaces), Errors()
        for feature in network.fractures:
            with errors.of_one(), self.leaving_out(feature):
                check_polygon(feature, network.tolerance)
                self.flatten(feature)
                whole = [Surface.whole(feature)]
                parts = domain.clip_polygon((whole if joins else self.joined_corners(whole, domain.surfaces))[0], tolerance)
                if joins:
                    parts = [part for part in parts if part.shape.area > network.tolerance * part.shape.length]
                if not parts:
                    unusable(feature, "lies outside of the domain")
                surfaces += parts
        errors.throw()
        self.check_sets()
        check_same(network.fractures, tolerance)
        if not joins:
            surfaces[len(domain.surfaces):] = self.joined_corners(surfaces[len(domain.surfaces):], surfaces)
        for feature in network.constraints + [side for body in network.regions for side in body.sides]:
            with errors.of_one(), self.leaving_out(feature):
                check_polygon(feature, network.tolerance)
                self.flatten(feature)
                parts = domain.clip_polygon(Surface.whole(feature), tolerance)
                if not parts and feature.kind == "constraint":
                    unusable(feature, "lies outside of the domain")
                for part in parts:
                    level = [s for s in surfaces if are_level(part, s, tolerance) and overlap(part, s, tolerance)]
                    surfaces += without(part, level, tolerance) if level else [part]
        errors.throw()
        segments, parents, touches = [], [], []
        for k, surface in enumerate(surfaces):
            sides = surface.sides()
            segments += list(sides)
            parents += [frozenset([k])] * len(sides)
        low, high = (np.array([getattr(s, which) for s in surfaces]) for which in ("low", "high"))
        for i, j in zip(*near_pairs(low, high, 2 * (network.tolerance if joins else tolerance))):
            with errors.of_one():
                for begin, end in self.meet(surfaces[i], surfaces[j]):
                    if np.linalg.norm(end - begin) > tolerance:
                        segments.append(np.array([begin, end]))
                        parents.append(frozenset([i, j]))
                    else:
                        touches.append((begin, {i, j}))
        errors.throw()
        self.surfaces = surfaces
        return [s.feature for s in surfaces], np.array(segments), parents, touches

    def flatten(self, feature):
        """Moves the corners of a polygon into its plane."""
        plane = Plane(feature.points)
        height = plane.height(feature.points)
        if abs(height).max() > 1e-9 * self.network.domain.size:
            self.repairs.append(f"moved corners by up to {abs(height).max():.3g} m into a plane: {feature.name}")
        feature.points = feature.points - height[:, None] * plane.normal

    def joined_corners(self, surfaces, others):
        """Returns surfaces with corners moved onto other surfaces within the tolerance."""
        found = []
        for surface in surfaces:
            moved, reported = moved_onto(surface, others, self.network.tolerance)
            for gap, other in reported:
                if gap > 1e-9 * self.network.domain.size:
                    self.repairs.append(f"closed a gap of {gap:.3g} m: {surface.feature.name} and {other.feature.name}")
            found.append(moved if reported else surface)
        return found

    def meet(self, one, other):
        """Returns the segments in which two surfaces meet, except common sides of level surfaces.

        Error for fractures on each other, and for angles below the minimum angle."""
        tolerance = self.tolerance
        are_fractures = one.feature.kind == other.feature.kind == "fracture"
        if are_level(one, other, tolerance):
            if are_fractures and overlap(one, other, tolerance):
                raise NetworkError(f"{one.feature.name} and {other.feature.name} overlap; remove one, or merge them",
                                   features=[(one.feature.name, other.feature.name)])
            return []
        if self.network.repair == "join" and are_fractures and angle_of_planes(one.plane, other.plane) < self.network.minimum_angle:
            if are_close(one, other, self.network.tolerance):
                raise NetworkError(f"{one.feature.name} and {other.feature.name} are nearly parallel and too close",
                                   features=[(one.feature.name, other.feature.name)])
        if np.linalg.norm(np.cross(one.plane.normal, other.plane.normal)) < 1e-8:
            return []
        found = traces(one, other, tolerance)
        if "fracture" in (one.feature.kind, other.feature.kind):
            check_angles(one, other, found, self.network.minimum_angle)
        moved = [h for a, b in ((one, other), (other, one)) for x in found for h in abs(b.plane.height(np.array(x)))]
        if max(moved, default=0) > 1e-9 * self.network.domain.size:
            self.repairs.append(f"closed a gap of {max(moved):.3g} m: {one.feature.name} and {other.feature.name}")
        return found

    def faces(self):
        """Returns all faces, cut along edges. Raises an error for each surface that its faces do not cover."""
        if self.found_faces is None:
            self.found_faces = self.cut_faces()
        return self.found_faces

    def cut_faces(self):
        if self.dim == 2:
            return faces_of(0, self.points[:, :2], list(self.edges), self.touching, self.network.domain.shape, self.tolerance)
        edges = [[] for _ in self.surfaces]
        for edge, of in self.edges.items():
            for k in of:
                edges[k].append(edge)
        found, errors = [], Errors()
        for k, surface in enumerate(self.surfaces):
            touching = [p for p, of in self.touching.items() if k in of]
            faces = faces_of(k, surface.plane.inside(self.points), edges[k], touching, surface.shape, self.tolerance)
            area = sum(face.shape.area for face in faces)
            if abs(area - surface.shape.area) > 4 * self.tolerance * surface.shape.length:
                with errors.of_one():
                    refuse(surface.feature, f"its faces have {area:.9g} m^2 of {surface.shape.area:.9g} m^2: its intersections could not be "
                                            f"resolved; try another \"tolerance\"")
            found += faces
        errors.throw()
        found = list({frozenset(face.rings[0]): face for face in reversed(found)}.values())[::-1]  # without duplicates
        return self.without_overlaps(found) if self.network.repair == "join" else found

    def without_overlaps(self, faces):
        """Returns the faces, except those of fractures with all corners on another surface, which joining made overlap."""
        at, found = self.graph.parents_at(), []
        for face in faces:
            others = set.intersection(*(at[p] | self.touching.get(p, set()) for p in face.rings[0])) - {face.owner}
            if others and self.is_fracture(face.owner):
                self.network.journal.note(self.owners[face.owner], f"{face.shape.area:.3g} m^2 are joined with "
                                          f"{self.owners[min(others)].name}")
            else:
                found.append(face)
        return found


def direction(line, point):
    """Returns the unit direction of the segment of a polyline that is nearest to a point."""
    begin, end = line[:-1], line[1:]
    _, gap = on_segment(np.broadcast_to(point, begin.shape), begin, end)
    along = (end - begin)[np.argmin(gap)]
    return along / np.linalg.norm(along)


def check_same(fractures, tolerance):
    """Raises an error for fractures with the same points."""
    seen, errors = {}, Errors()
    for fracture in fractures:
        grid = np.round(fracture.points / (10 * tolerance)) + 0.0
        key = tuple(sorted(map(tuple, grid)))
        if key in seen:
            errors.lines.append(f"{seen[key].name} and {fracture.name} are the same")
            errors.features.append((seen[key].name, fracture.name))
        seen[key] = fracture
    errors.throw()


def faces_of(owner, flat, edges, touching, shape, tolerance):
    """Returns the faces of a polygon `shape`, cut along edges.

    `flat` contains all points in coordinates of its plane."""
    number = {tuple(flat[k]): k for edge in edges for k in edge}
    used, faces = set(), []
    room = shape.buffer(10 * tolerance)
    for polygon in polygonize([LineString(flat[list(edge)]) for edge in edges]):
        rings = [[number[x] for x in ring.coords[:-1]] for ring in (polygon.exterior, *polygon.interiors)]
        if not room.contains(polygon.representative_point()) or not shape.buffer(tolerance).contains(polygon.representative_point()):
            continue
        faces.append(Face(owner, rings, polygon))
        used.update((min(a, b), max(a, b)) for ring in rings for a, b in zip(ring, ring[1:] + ring[:1]))
    inside = [(edge, 0.5 * (flat[edge[0]] + flat[edge[1]])) for edge in edges if edge not in used]
    on_edges = {k for edge in edges for k in edge}
    for what, x in inside + [(k, flat[k]) for k in touching if k not in on_edges]:
        home = next((face for face in faces if face.shape.contains(Point(x))), None)
        if home:
            (home.edges if isinstance(what, tuple) else home.points).append(what)
    return faces
