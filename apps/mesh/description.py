"""A network as `sprekk network` prints it: fractures and bodies as features."""
import os
import xml.etree.ElementTree as xml

from domain import Body, rows
from generator import at_random
from shapes import Feature, NetworkError, ellipse
from tables import read_table

READ = {"int": int, "double": float, "bool": lambda text: text == "true", "string": str}


def value(kind, text):
    if kind.startswith("Array("):
        inner = text.strip()[1:-1].strip()
        return [READ[kind[6:-1]](part.strip()) for part in inner.split(",")] if inner else []
    return READ[kind](text)


def as_dictionary(element):
    """A parameter list with its sections."""
    return {child.get("name"): as_dictionary(child) if child.tag == "ParameterList" else value(child.get("type"), child.get("value"))
            for child in element}


class Network:
    """What a mesh is to be made of."""

    def __init__(self, text):
        self.entries = as_dictionary(xml.fromstring(text))
        self.files = []  # that it was read from
        self.tables = {(kind, name): self.table(content) for kind in ("fractures", "constraints")
                       for name, content in self.entries.get(kind, {}).items() if "file" in content}
        self.domain = self.body("domain", self.domain_entries(), "boundary")
        self.dim = self.domain.dim
        self.regions = [self.body(f"regions > {name}", content, "region", name)
                        for name, content in self.entries.get("regions", {}).items()]
        self.fractures = self.features("fractures", "fracture")
        self.constraints = self.features("constraints", "constraint")
        self.check_names()
        self.check_dimensions()
        self.set_sizes()

    def place(self, path):
        return f"Sprekk > Mesh file > network > {path}"

    def body(self, path, entries, kind, group=None):
        return Body(path, entries, kind, group)

    def table(self, content):
        path = os.path.relpath(content["file"])
        path = content["file"] if path.startswith("..") else path  # as people know it
        self.files.append(path)
        domain = self.entries.get("domain")
        of_domain = ("lines" if len(domain["lower corner"]) == 2 or domain["corners"] else "polygons") if domain else None
        kind = content.get("format") or ("fab" if content["file"].lower().endswith(".fab") else of_domain)
        return read_table(path, kind)

    def domain_entries(self):
        if "domain" in self.entries:
            return self.entries["domain"]
        for table in self.tables.values():
            if table.box is not None:
                return {"lower corner": list(table.box[0]), "upper corner": list(table.box[1]), "corners": [], "faces": {}}
        raise NetworkError(f"{self.place('domain')}: missing; give it here, or in the first line of a CSV of polygons")

    def features(self, section, kind):
        found = []
        for name, content in self.entries.get(section, {}).items():
            path, n = self.place(f"{section} > {name}"), 2 if self.dim == 2 else 3
            if (section, name) in self.tables:
                found += [Feature(kind, name, f"{kind} {title}", x) for title, x in self.tables[section, name].fractures]
            for of, least in (("lines", 2), ("polygons", 3)):
                for one, points in content.get(of, {}).items():
                    if (of == "lines") != (self.dim == 2):
                        raise NetworkError(f"{path} > {of} > {one}: the domain has dimension {self.dim}; give {'lines' if n == 2 else 'polygons'}")
                    found.append(Feature(kind, name, f'{kind} "{one}" of "{name}"', rows(points["points"], n, f"{path} > {of} > {one}", least)))
            for one, e in content.get("ellipses", {}).items():
                found.append(Feature(kind, name, f'{kind} "{one}" of "{name}"',
                                     ellipse(e["centre"], e["radii"], e["strike"], e["dip"], e["rake"])))
            if "random" in content:
                found += [Feature(kind, name, f'{kind} {k + 1} at random of "{name}"', x)
                          for k, x in enumerate(at_random(content["random"], self.domain))]
        return found

    def check_names(self):
        """Groups of the mesh must be told apart."""
        sides = {side.group for side in self.domain.sides}
        for name in self.entries["fractures"]:
            if name in sides:
                raise NetworkError(f"{self.place('fractures > ' + name)}: has the name of a side of the domain; choose another")
        if "bulk" in self.entries["regions"]:
            raise NetworkError(f"{self.place('regions > bulk')}: is the name of the rest of the rock; choose another")

    def check_dimensions(self):
        for body in self.regions:
            if body.dim != self.dim:
                raise NetworkError(f"{body.place}: has dimension {body.dim}, the domain {self.dim}")
        for feature in self.fractures + self.constraints:
            if feature.points.shape[1] != self.dim:
                raise NetworkError(f"{feature.name}: has dimension {feature.points.shape[1]}, the domain {self.dim}")

    def set_sizes(self):
        e, diagonal = self.entries, self.domain.size
        self.tolerance = e.get("tolerance", 1e-6 * diagonal)
        self.minimum_distance = e.get("minimum distance", 1e-4 * diagonal)
        self.minimum_angle = e["minimum angle"]
        self.size = e.get("size", diagonal / 10)
        self.relative_size, self.growth = e["relative size"], e["growth"]
        self.size_at = {where: e.get(f"size at {where}") for where in ("tips", "intersections", "boundary")}
