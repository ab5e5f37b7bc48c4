"""Fractures and bodies of a network as features, from the output of `sprekk network`."""
import csv
import os
import xml.etree.ElementTree as xml
from collections import Counter
from dataclasses import replace
from itertools import count
from pathlib import Path

import exchange
import numpy as np
from discs import corners_for, has_discs, read_discs
from domain import Body, rows
from fab import read_fab
from generator import at_random
from journal import Journal, measure_of
from parts import joined_parts, separate_parts
from shapes import MAXIMUM, Errors, Feature, NetworkError, Plane, at, diameter, ellipse, refuse
from surface_files import read_dfnworks, read_gocad
from surfaces import Surface, angle_of_planes, trimmed
from tables import Table, complete, has_ellipses, has_points, is_number, read_table

MAX_FRACTURES = 10**5
TRIMMED, TRIMMED_ANGLE, MIN_PART = 2.0, 10.0, 0.4  # distance in tolerances, degrees, share of the area: parts cut off
MAX_DIAGONALS = 1e6  # largest distance of a point from the centre of the domain, in diagonals

READ = {"int": int, "double": float, "bool": lambda text: text == "true", "string": str}


def value(kind, text):
    if kind.startswith("Array("):
        inner = text.strip()[1:-1].strip()  # strings with commas are quoted
        return [READ[kind[6:-1]](part.strip()) for part in next(csv.reader([inner], skipinitialspace=True))] if inner else []
    return READ[kind](text)


def as_dictionary(element):
    """Returns a parameter list as a nested dict."""
    return {child.get("name"): as_dictionary(child) if child.tag == "ParameterList" else value(child.get("type"), child.get("value"))
            for child in element}


def as_known(path):
    """Returns the path relative to the current folder if it is inside, for messages."""
    relative = os.path.relpath(path)
    return path if relative.startswith("..") else relative


def opened(ring):
    """Returns the corners of a polygon without a repeated first corner."""
    return ring[:-1] if len(ring) > 3 and (ring[0] == ring[-1]).all() else ring


def box_of(domain):
    """Returns the lowest and the highest corner of a domain, or None for a polyhedron."""
    if not domain or domain["faces"]:
        return None
    points = np.reshape(domain["corners"] or domain["lower corner"] + domain["upper corner"], (-1, 2 if domain["corners"] else len(domain["lower corner"])))
    return points.min(axis=0), points.max(axis=0)


def printable(properties):
    """Replaces quotation marks and unprintable characters, as required by files of gmsh.

    The program checks the entries."""
    def clean(text):
        return "".join(c if c.isprintable() else " " for c in text.replace('"', "'"))
    return {clean(title): clean(text) for title, text in properties.items()}


def free_names(name, features):
    """Yields `name 1`, `name 2`, ... except names of existing features."""
    taken = {feature.single for feature in features}
    return (one for one in (f"{name} {k}" for k in count(1)) if one not in taken)


class Network:
    """Domain, regions, fractures, constraints and sizes of a network."""

    def __init__(self, text, again=None):
        """`again` {name of a random fracture: number of repeated draws}."""
        self.again, self.at_random = again or {}, []
        self.entries = as_dictionary(xml.fromstring(text))
        self.files = []  # input files
        self.repair = self.entries.get("repair", "report")  # or join, drop
        self.leaves_out = self.entries.get("unusable fractures") == "left out" or self.repair != "report"
        self.resolved, self.trimmed = set(), set()  # names of fractures changed by repairs
        self.left_out, self.empty = [], []  # lines of the report; (file, line) of features without geometry
        self.tables = {(kind, name): self.table(content) for kind in ("fractures", "constraints")
                       for name, content in self.entries.get(kind, {}).items() if "file" in content}
        self.domain = self.body("domain", self.domain_entries(), "boundary")
        self.dim = self.domain.dim
        self.regions = [self.body(f"regions > {name}", content, "region", name)
                        for name, content in self.entries.get("regions", {}).items()]
        self.journal = Journal(self.domain.size)
        self.fractures = self.features("fractures", "fracture")
        self.journal.start(self.fractures, self.empty)
        self.constraints = self.features("constraints", "constraint")
        self.check_names()
        (self.check_singles if self.repair == "report" else self.rename_singles)()
        self.check_boxes()
        self.check_dimensions()
        self.check_reach()
        self.set_sizes()
        parts = separate_parts if self.repair != "report" else joined_parts
        self.joined = self.left_out + parts(self.fractures, self.dim, self.tolerance)  # lines of the report

    def place(self, path):
        return f"Sprekk > Mesh file > network > {path}"

    def body(self, path, entries, kind, group=None):
        return Body(path, entries, kind, group)

    def table(self, content):
        path = as_known(content["file"])
        self.files += exchange.files_of(path)
        domain = self.entries.get("domain")
        of_domain = ("lines" if len(domain["lower corner"]) == 2 or domain["corners"] else "polygons") if domain else None
        dim, layers = 2 if of_domain == "lines" else 3, content.get("layers", [])
        if exchange.is_exchange(path) and "format" not in content:
            unused = [] if self.leaves_out else None
            table = Table(exchange.read(path, dim, layers, unused, "unit" in content, box_of(domain)))
            self.left_out += unused or []
            self.empty += [(content["file"], line.removeprefix("left out: ")) for line in unused or [] if line.startswith("left out: ")]
        else:
            if layers:
                raise NetworkError(f"{path}: has no layers, but its set has \"layers\"; only formats of GDAL have layers", [path])
            table = self.read(path, content, of_domain, dim)
            self.left_out += [f"left out: {line}" for line in table.empty]
            self.empty += [(content["file"], line) for line in table.empty]
        for row in table.fractures:
            row.points = row.points * content.get("unit", 1.0)
        if content.get("window"):
            table.fractures = [part for row in table.fractures for part in self.cropped(row, content)]
        if table.box is not None:
            table.box = [[x * content.get("unit", 1.0) for x in corner] for corner in table.box]
        return table

    def read(self, path, content, of_domain, dim):
        """Returns the table of a file without GDAL. Its format is given, or by the ending, the titles and the domain."""
        kind, ending = content.get("format"), Path(path).suffix.lower()
        corners, names = self.corners(content), self.entries.get("entries of joints", ())
        if kind is None:
            kind = {".fab": "fab", ".dat": "dfnworks", ".ts": "gocad"}.get(ending)
        if of_domain != "lines" and kind in (None, "ellipses"):
            kind = "discs" if has_discs(path) else "ellipses" if has_ellipses(path) else kind
        if kind is None:
            kind = "points" if of_domain and has_points(path, dim) else of_domain
        readers = {"fab": read_fab, "dfnworks": lambda path: complete(read_dfnworks(path), path),
                   "gocad": lambda path: complete(read_gocad(path), path),
                   "discs": lambda path: complete(read_discs(path, content.get("corners") or self.whole_edges()), path, self.leaves_out)}
        return readers[kind](path) if kind in readers else read_table(path, kind, dim, names, corners, self.leaves_out)

    def whole_edges(self):
        return corners_for(self.entries["relative size"])

    def corners(self, content):
        """Returns the number of corners of the ellipses of a set."""
        return content.get("corners") or (32 if self.repair == "report" else self.whole_edges())

    def cropped(self, row, content):
        """Returns the parts of a row in the window of its set."""
        window = np.array(content["window"]).reshape(2, -1)
        if window.shape[1] != row.points.shape[1] or not (window[1] > window[0]).all():
            raise NetworkError(f"{self.place('fractures')}: \"window\" is {content['window']}, must be the lowest and then the highest "
                               f"{row.points.shape[1]} coordinates")
        box = Body("window", {"lower corner": list(window[0]), "upper corner": list(window[1]), "corners": [], "faces": {}}, "region")
        if box.dim == 2:
            parts = box.clip_line(row, 1e-9 * box.size)
        else:
            whole = Surface.whole(Feature("constraint", "", row.title, opened(row.points)))
            parts = [part.rings[0] for part in box.clip_polygon(whole, 1e-9 * box.size)]
        if not parts:
            self.left_out.append(f"left out: {row.title}: outside of the window")
            self.empty.append((content["file"], f"{row.title}: outside of the window"))
        return [replace(row, points=part) for part in parts]

    def domain_entries(self):
        if "domain" in self.entries:
            return self.entries["domain"]
        for table in self.tables.values():
            if table.box is not None:
                return {"lower corner": list(table.box[0]), "upper corner": list(table.box[1]), "corners": [], "faces": {}}
        raise NetworkError(f"{self.place('domain')}: missing; give it here, or in the first line of a CSV of polygons")

    def check_choices(self, rows_read):
        """Raises errors for entries of joints that have a text other than the allowed ones, for instance numbers in a column
        `friction`. Each entry has one error, with its first row."""
        entries, found = self.entries.get("entries of joints", ()), {}
        for title, allowed in self.entries.get("choices of joints", {}).items():
            wrong = [row for row in rows_read if row.properties.get(title, allowed[0]) not in allowed]
            if wrong:
                text = wrong[0].properties[title]
                longer = [one for one in entries if one.startswith(title + " ")] if is_number(text) else []
                found[title] = (f'fracture {wrong[0].title}: "{title}" is "{text}", must be one of '
                                + ", ".join(f'"{one}"' for one in allowed)
                                + (f"; {len(wrong) - 1} more with such an error" if len(wrong) > 1 else "")
                                + (f'; did you mean the title "{longer[0]}"?' if longer else ""))
        Errors(found.values()).throw(self.files)

    def features(self, section, kind):
        found = []
        for name, content in self.entries.get(section, {}).items():
            path, n = self.place(f"{section} > {name}"), 2 if self.dim == 2 else 3
            if (section, name) in self.tables:
                rows_read = self.tables[section, name].fractures
                self.check_choices(rows_read)
                found += [Feature(kind, name, f"{kind} {row.title}", row.points, row.name or f"{name} {row.number}",
                                  content["file"], printable(row.properties)) for row in rows_read]
            for of, minimum in (("lines", 2), ("polygons", 3)):
                for one, points in content.get(of, {}).items():
                    if (of == "lines") != (self.dim == 2):
                        raise NetworkError(f"{path} > {of} > {one}: the domain has dimension {self.dim}; give {'lines' if n == 2 else 'polygons'}")
                    found.append(Feature(kind, name, f'{kind} "{one}" of "{name}"', rows(points["points"], n, f"{path} > {of} > {one}", minimum),
                                         f"{name} {one}", of))
            for one, e in content.get("ellipses", {}).items():
                found.append(Feature(kind, name, f'{kind} "{one}" of "{name}"',
                                     ellipse(e["centre"], e["radii"], e["strike"], e["dip"], e["rake"], self.corners(content)),
                                     f"{name} {one}", "ellipses"))
            number = len(found) + content.get("random", {}).get("number", 0)
            if number > MAX_FRACTURES:
                raise NetworkError(f"{path}: increases the network to {number} {kind}s, at most {MAX_FRACTURES} are allowed")
            if "random" in content:
                names = [f'{kind} {k + 1} at random of "{name}"' for k in range(content["random"]["number"])]
                again = {k: self.again[one] for k, one in enumerate(names) if one in self.again}
                drawn = zip(names, free_names(name, found), at_random(content["random"], self.domain, again))
                found += [Feature(kind, name, one, x, single, "random") for one, single, x in drawn]
                self.at_random += names
        for feature in found if self.dim == 3 else ():
            feature.points = opened(feature.points)
        return found

    def check_boxes(self):
        """Checks that domains given by files are equal to that of the scene."""
        for (section, name), table in self.tables.items():
            other = table.box and abs(np.array(table.box) - (self.domain.low, self.domain.high)).max() > 1e-9 * self.domain.size
            if other:
                path = self.entries[section][name]["file"]
                said, known = (" to ".join(at(corner, self.domain.size) for corner in box)
                               for box in (table.box, (self.domain.low, self.domain.high)))
                raise NetworkError(f"{as_known(path)}: has a domain from {said}, the scene has {known}; remove one", [as_known(path)])

    def check_names(self):
        """Checks that the groups of the mesh have different names, valid in files of gmsh."""
        sides = {side.group for side in self.domain.sides}
        for name in (*sides, *self.entries["fractures"], *self.entries["regions"]):
            if '"' in name or not name.isprintable():
                raise NetworkError(f"{self.place('...')}: the name {name!r} contains a quotation mark or an unprintable character; choose another")
        for name in self.entries["fractures"]:
            if name in sides:
                raise NetworkError(f"{self.place('fractures > ' + name)}: has the name of a side of the domain; choose another")
        if "bulk" in self.entries["regions"]:
            raise NetworkError(f"{self.place('regions > bulk')}: is the name of the remaining rock; choose another")

    def check_singles(self):
        """Checks the names of single fractures.

        Parts of one fracture are of the same set and source, with the same properties."""
        first, errors = {}, Errors()
        for feature in self.fractures:
            one, name = first.setdefault(feature.single, feature), feature.single
            if '"' in name or not name.isprintable():
                errors.lines.append(f"{feature.name}: the name {name!r} contains a quotation mark or an unprintable character; choose another")
            elif one.group != feature.group:
                errors.lines.append(f"{feature.name}: has the name \"{name}\", as {one.name} of another set; choose another")
            elif one.source != feature.source:
                errors.lines.append(f"{feature.name}: has the name \"{name}\", as {one.name} of another file or "
                                    "section; choose another")
            elif one.properties != feature.properties:
                errors.lines.append(f"{feature.name}: has the name \"{name}\", as {one.name}, but different values in additional columns")
        errors.throw(self.files)

    def rename_singles(self):
        """Makes the names of single fractures valid and unique, except for parts of one fracture."""
        first, n = {}, Counter()
        for feature in self.fractures:
            feature.single = name = "".join(c if c.isprintable() else " " for c in feature.single.replace('"', "'"))
            one = first.setdefault(name, feature)
            if (one.group, one.source, one.properties) == (feature.group, feature.source, feature.properties):
                continue
            while feature.single in first:
                n[name] += 1
                feature.single = f"{name} ({n[name] + 1})"
            first[feature.single] = feature
            self.journal.note(feature, f"renamed, since another fracture has the name \"{name}\"")

    def conflicting(self, names):
        """Returns the fractures with these names in messages, the smallest first."""
        found = [one for one in self.fractures if one.name in names]
        return sorted(found, key=lambda one: (self.journal.of(one).given, one.name))

    def resolve(self, names):
        """Cuts off a part of the smallest fracture of a conflict, or leaves it out, unless one of them is changed already."""
        if any(name in self.resolved for name in names):
            return
        smallest, *larger = self.conflicting(names)
        others = " and ".join(name for name in names if name != smallest.name)
        self.resolved.update(names)
        if self.repair == "join" and self.dim == 3 and len(larger) == 1 and len(names) == 2:
            part = self.part_clear_of(smallest, larger[0])
            if part is not None:
                lost = measure_of(smallest.points) - measure_of(part)
                self.journal.note(smallest, f"{lost:.3g} m^2 are cut off at a small angle to {others}")
                smallest.points = part
                return
        self.journal.leave_out(smallest, f"in conflict with {others}" if others else "cannot be joined with others within the limits", "conflict")
        self.fractures = [one for one in self.fractures if one is not smallest]

    def part_clear_of(self, smallest, other):
        """Returns the larger part of a fracture, without that near another at a small angle, or None."""
        if angle_of_planes(Plane(smallest.points), Plane(other.points)) > TRIMMED_ANGLE or smallest.name in self.trimmed:
            return None
        part = trimmed(smallest.points, other.points, TRIMMED * self.tolerance)
        self.trimmed.add(smallest.name)
        if part is None or not MIN_PART < measure_of(part) / measure_of(smallest.points) < 1 - 1e-9:
            return None
        part = part[np.linalg.norm(part - np.roll(part, 1, axis=0), axis=1) > self.tolerance]
        return part if len(part) > 2 else None

    def tolerance_of_repairs(self):
        """Returns the smaller of 1e-3 of the diagonal and 1/20 of the median length (3D: diameter) in the domain."""
        sizes = [measure_of(one.points) if self.dim == 2 else diameter(one.points) for one in self.fractures]
        return min(1e-3 * self.domain.size, 0.05 * float(np.median(sizes)) if sizes else np.inf)

    def check_dimensions(self):
        for body in self.regions:
            if body.dim != self.dim:
                raise NetworkError(f"{body.place}: has dimension {body.dim}, the domain {self.dim}")
        for feature in self.fractures + self.constraints:
            if feature.points.shape[1] != self.dim:
                raise NetworkError(f"{feature.name}: has dimension {feature.points.shape[1]}, the domain {self.dim}")

    def check_reach(self):
        """Rejects coordinates far from the domain, which would suffer from round-off."""
        centre, maximum, errors = 0.5 * (self.domain.low + self.domain.high), MAX_DIAGONALS * self.domain.size, Errors()
        for feature in self.fractures + self.constraints:
            x = feature.points.ravel()[abs(feature.points).argmax()]
            with errors.of_one():
                if abs(x) > MAXIMUM or abs(feature.points - centre).max() > maximum:
                    refuse(feature, f"has the coordinate {x:g} m, more than {MAX_DIAGONALS:g} diagonals of the domain "
                                    "away")
        errors.throw(self.files)

    def set_sizes(self):
        e, diagonal = self.entries, self.domain.size
        self.tolerance = e.get("tolerance", 1e-6 * diagonal if self.repair == "report" else self.tolerance_of_repairs())
        if self.tolerance > 0.01 * diagonal:
            raise NetworkError(f"{self.place('tolerance')}: is {self.tolerance:g} m, must be at most a hundredth of the domain's "
                               f"diagonal, {0.01 * diagonal:g} m")
        self.minimum_distance = e.get("minimum distance", 1e-4 * diagonal)
        self.minimum_angle = e["minimum angle"]
        self.size = e.get("size", diagonal / 10)
        self.relative_size, self.growth = e["relative size"], e["growth"]
        self.maximum_cells = e["maximum cells"]
        for entry in ("size", *(f"size at {where}" for where in ("tips", "intersections", "boundary"))):
            if e.get(entry, np.inf) < 1e-7 * diagonal:
                raise NetworkError(f"{self.place(entry)}: is {e[entry]:g} m, must be at least 1e-7 of the domain's diagonal, {1e-7 * diagonal:.3g} m")
        self.size_at = {where: e.get(f"size at {where}") for where in ("tips", "intersections", "boundary")}
