"""Passes a plan to gmsh and returns the mesh."""
import ctypes
import os
import pickle
import re
import signal
import sys
import tempfile
from dataclasses import dataclass

import gmsh
import numpy as np
from intersecting import intersecting
from shapes import NetworkError

FAR = 20  # in diagonals of the domain


@dataclass
class Mesh:
    """Cells and faces by the indices of their nodes.

    The faces of dimension d - 1 have the index of their owner in the plan. The intersections of fractures have
    dimension d - 2."""
    points: np.ndarray
    cells: np.ndarray
    faces: np.ndarray
    face_owner: np.ndarray
    intersections: np.ndarray


def make_mesh(plan, sizes):
    """Returns the Mesh of a plan. Raises a NetworkError with the message of gmsh if gmsh fails."""
    gmsh.initialize(readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        origin = origin_of(plan.network.domain)
        model = Model(plan, origin)
        with tempfile.TemporaryDirectory() as folder:
            set_sizes(sizes, origin, folder)
            try:
                gmsh.model.mesh.generate(plan.dim)
            except Exception as error:  # gmsh raises untyped exceptions
                said = [line[6:].strip(" :") for line in gmsh.logger.get() if line.startswith("Error")]
                raise model.failure(said or [str(error)]) from None
        return model.mesh(sizes)
    finally:
        gmsh.finalize()


def make_mesh_apart(plan, sizes):
    """As make_mesh(), in a process of its own, since some errors of gmsh end the process."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mesh")
        sys.stdout.flush()
        child = os.fork()
        if child == 0:
            try:
                ctypes.CDLL(None).prctl(1, signal.SIGTERM)  # end with the parent
                try:
                    found = make_mesh(plan, sizes)
                except NetworkError as error:
                    found = str(error), error.features
                with open(path, "wb") as file:
                    pickle.dump(found, file)
            finally:
                os._exit(0)
        _, status = os.waitpid(child, 0)
        if not os.path.exists(path) or os.path.getsize(path) == 0:
            raise NetworkError(f"gmsh could not generate the mesh: it ended with status {status}; increase \"tolerance\" to join close "
                               "fractures, or choose smaller sizes")
        with open(path, "rb") as file:
            found = pickle.load(file)
    if isinstance(found, tuple):
        raise NetworkError(found[0], features=found[1])
    return found


def origin_of(domain):
    """Returns the origin of coordinates in gmsh, close to the domain to limit round-off in products of coordinates.

    The origin of the network is used unless it is far away, so that meshes do not change."""
    middle = np.zeros(3)
    middle[:domain.dim] = 0.5 * (domain.low + domain.high)
    return middle if np.linalg.norm(middle) > FAR * domain.size else np.zeros(3)


class Model:
    """Points, edges and faces of the plan in gmsh, with tags from 1."""

    def __init__(self, plan, origin):
        self.plan, self.origin, geo = plan, origin, gmsh.model.geo
        for k, x in enumerate(plan.points - origin):
            geo.addPoint(*x, 0, k + 1)
        self.line = {edge: geo.addLine(edge[0] + 1, edge[1] + 1) for edge in plan.edges}
        self.faces = plan.faces()
        for face in self.faces:
            rings = [self.turned(face), *face.rings[1:]] if plan.dim == 3 and plan.network.repair == "join" else face.rings
            face.tag = geo.addPlaneSurface([geo.addCurveLoop(self.loop(ring)) for ring in rings])
        if plan.dim == 3:
            outer = [face.tag for face in self.faces if plan.owners[face.owner].kind == "boundary"]
            geo.addVolume([geo.addSurfaceLoop(outer)], 1)
        geo.synchronize()
        for face in self.faces:
            gmsh.model.mesh.embed(1, [self.line[edge] for edge in face.edges], 2, face.tag)
            gmsh.model.mesh.embed(0, [point + 1 for point in face.points], 2, face.tag)
        if plan.dim == 3:
            gmsh.model.mesh.embed(2, [face.tag for face in self.faces if face.tag not in outer], 3, 1)

    def turned(self, face):
        """Returns the outer ring, beginning with the three consecutive points that determine the plane best, as gmsh requires."""
        ring, plane = face.rings[0], self.plan.surfaces[face.owner].plane
        x, height = self.plan.points[ring], abs(plane.height(self.plan.points[ring]))
        one, other = np.roll(x, -1, axis=0), np.roll(x, -2, axis=0)
        along, across = one - x, other - one
        area = np.linalg.norm(np.cross(along, across), axis=1) / (np.linalg.norm(along, axis=1) + np.linalg.norm(across, axis=1))
        error = np.maximum(height, np.maximum(np.roll(height, -1), np.roll(height, -2)))
        first = int(np.argmin((error + 1e-9 * area.max()) / np.maximum(area, 1e-300)))
        return ring[first:] + ring[:first]

    def loop(self, ring):
        return [self.line[a, b] if a < b else -self.line[b, a] for a, b in zip(ring, ring[1:] + ring[:1])]

    def failure(self, said):
        """Returns an error with the message of gmsh and the names of the features with the tags in this message.

        For other messages in 3D these are the features with intersecting triangles."""
        owners = {face.tag: self.plan.owners[face.owner] for face in self.faces}
        pairs = [[int(tag) for tag in re.findall(r"surface (\d+)", line) if int(tag) in owners] for line in said]
        pairs = [pair for pair in pairs if pair] or (self.intersecting() if self.plan.dim == 3 else [])
        named = {tuple(sorted({owners[tag].name for tag in pair if owners[tag].kind == "fracture"})) for pair in pairs} - {()}
        names = list(dict.fromkeys(owners[tag].name for pair in pairs for tag in pair))
        where = f", at {' and '.join(names[:4])}" if names else ""
        return NetworkError(f"gmsh could not generate the mesh{where}: {said[0]}; increase \"tolerance\" to join close fractures, or "
                            "choose smaller sizes", features=sorted(named))

    def intersecting(self):
        """Returns the pairs of tags of faces whose triangles intersect."""
        number, points = self.nodes()
        of_face = [(face.tag, self.elements(2, face.tag, number)) for face in self.faces]
        tag = np.concatenate([np.full(len(nodes), one) for one, nodes in of_face])
        i, j = intersecting(points, np.concatenate([nodes for _, nodes in of_face]))
        return sorted(set(zip(tag[i].tolist(), tag[j].tolist())))

    def nodes(self):
        """Returns the index of each node by its tag, and the points."""
        tags, x, _ = gmsh.model.mesh.getNodes()
        number = np.zeros(int(tags.max()) + 1, int)
        number[tags.astype(int)] = np.arange(len(tags))
        return number, x.reshape(-1, 3) + self.origin

    def elements(self, of, tag, number):
        """Returns the elements [element, node] of an entity of dimension `of`."""
        types, _, nodes = gmsh.model.mesh.getElements(of, tag)
        return number[np.concatenate(nodes).astype(int)].reshape(-1, of + 1) if len(types) else np.zeros((0, of + 1), int)

    def mesh(self, sizes):
        dim = self.plan.dim
        number, points = self.nodes()

        def elements(of, tag=-1):
            return self.elements(of, tag, number)

        cells = elements(dim)
        if not len(cells):
            raise NetworkError("gmsh generated no cells; increase \"tolerance\" to join close fractures")
        owned = []
        if dim == 2:
            owned = [(foremost(self.plan, of), elements(1, self.line[edge])) for edge, of in self.plan.edges.items()]
            owned = [(owner, nodes) for owner, nodes in owned if owner is not None]
            meeting = number[[int(gmsh.model.mesh.getNodes(0, p + 1)[0][0]) for p in sorted(sizes.intersections)]].reshape(-1, 1)
        else:
            kinds = [self.plan.owners[face.owner].kind for face in self.faces]
            owned = [(face.owner, elements(2, face.tag)) for face, kind in zip(self.faces, kinds) if kind in ("fracture", "boundary")]
            meeting = np.concatenate([elements(1, self.line[edge]) for edge in sorted(sizes.intersections)] or [np.zeros((0, 2), int)])
        faces = np.concatenate([nodes for _, nodes in owned])
        owner = np.concatenate([np.full(len(nodes), k) for k, nodes in owned])
        used = np.unique(cells)
        new = np.full(len(points), -1)
        new[used] = np.arange(len(used))
        return Mesh(points[used], new[cells], new[faces], owner, new[meeting])


def foremost(plan, owners):
    """Returns the side or the fracture among the owners of an edge, or None."""
    for kind in ("boundary", "fracture"):
        for k in sorted(owners):
            if plan.owners[k].kind == kind:
                return k
    return None


def set_sizes(sizes, origin, folder):
    """Defines the size field of gmsh. A file in `folder` contains the grid of sizes of repaired networks."""
    if sizes.grid is None:
        set_fields(sizes, origin)
    else:
        path, field = os.path.join(folder, "sizes"), gmsh.model.mesh.field
        sizes.grid.write(path, origin)
        structured = field.add("Structured")
        field.setString(structured, "FileName", path)
        field.setNumber(structured, "TextFormat", 1)
        field.setAsBackgroundMesh(structured)
    for option, value in (("MeshSizeMax", sizes.network.size), ("MeshSizeExtendFromBoundary", 0), ("MeshSizeFromPoints", 0)):
        gmsh.option.setNumber(f"Mesh.{option}", value)


def set_fields(sizes, origin):
    """Defines the size field of gmsh: the minimum over all sizes of a function of the distance to their points."""
    network, field = sizes.network, gmsh.model.mesh.field
    level = np.round(2 * np.log2(sizes.sizes / network.size)).astype(int)
    fields = []
    for value in np.unique(level):
        points = sizes.points[level == value] - origin
        size = min(network.size, network.size * 2.0 ** (value / 2))
        if size >= network.size:
            continue
        points = np.unique(np.round(points / (0.2 * size)).astype(np.int64), axis=0) * 0.2 * size
        distance, threshold = field.add("Distance"), field.add("Threshold")
        field.setNumbers(distance, "NodesList", [gmsh.model.geo.addPoint(*x) for x in points])
        for name, number in (("IField", distance), ("LcMin", size), ("LcMax", network.size), ("DistMin", 0),
                             ("DistMax", (network.size - size) / network.growth)):
            field.setNumber(threshold, name, number)
        fields.append(threshold)
    gmsh.model.geo.synchronize()
    if fields:
        minimum = field.add("Min")
        field.setNumbers(minimum, "FieldsList", fields)
        field.setAsBackgroundMesh(minimum)
