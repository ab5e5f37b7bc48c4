"""Passes a plan to gmsh and returns the mesh."""
import ctypes
import os
import pickle
import re
import signal
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field

import gmsh
import numpy as np
from improve import improve
from intersecting import intersecting
from progress import doing
from report import gamma, measure
from shapes import NetworkError
from surface_mesh import SIDES, SurfaceMesh

FAR = 20  # in diagonals of the domain
POOR = 0.02  # quality of cells that repairs avoid
# Precision of the number of edges of a line, relative: for a grid of sizes, and for fields of points. The default of gmsh,
# 1e-9, requires more time than the cells.
PRECISION, PRECISION_OF_FIELDS = 1e-3, 1e-6
ROUNDS, BISECTIONS = 6, 2  # repeated generations of cells; the first ones only bisect triangles at poor cells


@dataclass
class Mesh:
    """Cells and faces by the indices of their nodes.

    The faces of dimension d - 1 have the index of their owner in the plan. The intersections of fractures have
    dimension d - 2. `fixed` are the nodes of constraints and of the sides of regions, `tags` the tags of nodes in gmsh.
    `joined` {(owner without triangles, owner with them): area of triangles that both would have}. `removed` {(owner, other
    owner): area of triangles of the first removed at poor cells between both}. `omitted` {owner: length or area of faces
    without cells}."""
    points: np.ndarray
    cells: np.ndarray
    faces: np.ndarray
    face_owner: np.ndarray
    intersections: np.ndarray
    fixed: np.ndarray
    tags: np.ndarray = None
    joined: dict = field(default_factory=dict)
    removed: dict = field(default_factory=dict)
    omitted: dict = field(default_factory=dict)
    generations: int = 1  # of cells


def make_mesh(plan, sizes):
    """Returns the Mesh of a plan. Raises a NetworkError with the message of gmsh if gmsh fails."""
    gmsh.initialize(readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        model = Model(plan, origin_of(plan.network.domain))
        with tempfile.TemporaryDirectory() as folder:
            set_sizes(sizes, model.origin, folder)
            if plan.network.repair == "report" or plan.dim == 2:
                model.generate(plan.dim)
                mesh = model.mesh(sizes)
                if plan.network.repair != "report":
                    improve(mesh)
                return mesh
            return repaired_mesh(model, sizes, folder)
    finally:
        gmsh.finalize()


def repaired_mesh(model, sizes, folder):
    """Returns the mesh of a repaired network in 3D.

    Triangles at failures of gmsh and at poor cells are bisected, and the cells generated again. Poor cells that remain
    are in narrow wedges between fractures. The smaller fracture loses its triangles there."""
    with doing(f"generating triangles of {len(model.faces)} faces"):
        model.generate(2)
    surfaces = SurfaceMesh(model)
    joined, removed, best, worst = surfaces.without_shared(), Counter(), None, None
    for _ in range(ROUNDS):
        marked = surfaces.folded()
        if not marked.any():
            break
        bisect(surfaces, marked, sizes, folder)
    for k in range(ROUNDS + 1):
        try:
            with doing("generating cells" + (f" again (attempt {k + 1} of at most {ROUNDS + 1})" if k else "")):
                model.generate(3)
            mesh = model.mesh(sizes)
            improve(mesh)
            quality, _ = gamma(mesh.points, mesh.cells)
            poor = mesh.cells[quality < POOR]
            if best is None or len(poor) < worst:
                best, worst = mesh, len(poor)
                mesh.joined, mesh.removed = joined, dict(removed)
            if not len(poor) or k == ROUNDS:
                break
            surfaces = SurfaceMesh(model)
            if k >= BISECTIONS:
                found = surfaces.without_narrow(mesh.tags[poor], removed)
                if not found:
                    break
                removed.update(found)
                continue
            marked = surfaces.beside(mesh.tags[poor])
        except NetworkError as error:
            surfaces = SurfaceMesh(model)
            marked = surfaces.intersecting()
            if k == ROUNDS or not marked.any():
                if best is None:
                    raise error
                break
        bisect(surfaces, marked, sizes, folder)
    best.generations = k + 1
    return best


def bisect(surfaces, marked, sizes, folder):
    sizes.grid.take(*surfaces.bisect(marked))
    set_sizes(sizes, surfaces.model.origin, folder)


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
                except Exception as error:  # includes exceptions of gmsh
                    found = str(error) if isinstance(error, NetworkError) else f"mesh generation failed: {error!r}", getattr(error, "features", ())
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

    def generate(self, dim):
        """Generates the mesh up to a dimension. Raises a NetworkError with the message of gmsh if gmsh fails."""
        gmsh.logger.start()
        try:
            gmsh.model.mesh.generate(dim)
        except Exception as error:  # gmsh raises untyped exceptions
            said = [line[6:].strip(" :") for line in gmsh.logger.get() if line.startswith("Error")]
            raise self.failure(said or [str(error)]) from None
        finally:
            gmsh.logger.stop()

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

    def curves(self, face):
        """Returns the tags of all lines of a face."""
        return [*(abs(line) for ring in face.rings for line in self.loop(ring)), *(self.line[edge] for edge in face.edges)]

    def loop(self, ring):
        return [self.line[a, b] if a < b else -self.line[b, a] for a, b in zip(ring, ring[1:] + ring[:1])]

    def failure(self, said):
        """Returns an error with the message of gmsh and the names of the features with the tags in this message.

        In 3D these are also all features with intersecting triangles, since gmsh names one pair."""
        owners = {face.tag: self.plan.owners[face.owner] for face in self.faces}
        pairs = [[int(tag) for tag in re.findall(r"surface (\d+)", line) if int(tag) in owners] for line in said]
        pairs = [pair for pair in pairs if pair] + (self.intersecting() if self.plan.dim == 3 else [])
        named = {tuple(sorted({owners[tag].name for tag in pair if owners[tag].kind == "fracture"})) for pair in pairs} - {()}
        names = list(dict.fromkeys(owners[tag].name for pair in pairs for tag in pair))
        where = f", at {' and '.join(names[:4])}" if names else ""
        return NetworkError(f"gmsh could not generate the mesh{where}: {said[0]}; increase \"tolerance\" to join close fractures, or "
                            "choose smaller sizes", features=sorted(named))

    def intersecting(self):
        """Returns the pairs of tags of faces whose triangles intersect."""
        number, points, _ = self.nodes()
        of_face = [(face.tag, self.elements(2, face.tag, number)) for face in self.faces]
        tag = np.concatenate([np.full(len(nodes), one) for one, nodes in of_face])
        i, j = intersecting(points, np.concatenate([nodes for _, nodes in of_face]))
        return sorted(set(zip(tag[i].tolist(), tag[j].tolist())))

    def nodes(self):
        """Returns the index of each node by its tag, the points, and the tags."""
        tags, x, _ = gmsh.model.mesh.getNodes()
        tags = tags.astype(int)
        number = np.zeros(int(tags.max()) + 1, int)
        number[tags] = np.arange(len(tags))
        return number, x.reshape(-1, 3) + self.origin, tags

    def elements(self, of, tag, number):
        """Returns the elements [element, node] of an entity of dimension `of`."""
        types, _, nodes = gmsh.model.mesh.getElements(of, tag)
        return number[np.concatenate(nodes).astype(int)].reshape(-1, of + 1) if len(types) else np.zeros((0, of + 1), int)

    def mesh(self, sizes):
        dim = self.plan.dim
        number, points, tags = self.nodes()

        def elements(of, tag=-1):
            return self.elements(of, tag, number)

        cells = elements(dim)
        if not len(cells):
            raise NetworkError("gmsh generated no cells; increase \"tolerance\" to join close fractures")
        if dim == 2:
            owned = [(foremost(self.plan, of), elements(1, self.line[edge])) for edge, of in self.plan.edges.items()]
            meeting = number[[int(gmsh.model.mesh.getNodes(0, p + 1)[0][0]) for p in sorted(sizes.intersections)]].reshape(-1, 1)
        else:
            owned = [(foremost(self.plan, {face.owner}), elements(2, face.tag)) for face in self.faces]
            meeting = np.concatenate([elements(1, self.line[edge]) for edge in sorted(sizes.intersections)] or [np.zeros((0, 2), int)])
            meeting = meeting[self.are_shared(meeting, [(owner, nodes) for owner, nodes in owned if owner is not None], len(points))]
        fixed = np.concatenate([nodes.ravel() for owner, nodes in owned if owner is None] or [np.zeros(0, int)])
        owned = [(owner, nodes) for owner, nodes in owned if owner is not None]
        faces = np.concatenate([nodes for _, nodes in owned])
        owner = np.concatenate([np.full(len(nodes), k) for k, nodes in owned])
        used = np.unique(cells)
        new = np.full(len(points), -1)
        new[used] = np.arange(len(used))
        inside = (new[faces] >= 0).all(axis=1)  # gmsh leaves a few embedded lines without cells
        omitted = Counter()
        for k, size in zip(owner[~inside].tolist(), measure(points, faces[~inside]).tolist()):
            omitted[k] += size
        faces, owner, meeting = faces[inside], owner[inside], meeting[(new[meeting] >= 0).all(axis=1)]
        fixed = fixed[new[fixed] >= 0]
        return Mesh(points[used], new[cells], new[faces], owner, new[meeting], np.unique(new[fixed]), tags[used],
                    omitted=dict(omitted))

    def are_shared(self, lines, owned, n):
        """Returns whether lines (l, 2) among n nodes are edges of triangles of two fractures. `owned` is [(owner, triangles)]."""
        first, other = {}, set()
        wanted = set((np.sort(lines, axis=1) @ [n, 1]).tolist())
        for owner, triangles in owned:
            if self.plan.is_fracture(owner):
                for code in wanted.intersection(np.unique(np.sort(triangles[:, SIDES], axis=2) @ [n, 1]).tolist()):
                    if first.setdefault(code, owner) != owner:
                        other.add(code)
        return np.array([code in other for code in (np.sort(lines, axis=1) @ [n, 1]).tolist()], bool)


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
        gmsh.option.setNumber("Mesh.LcIntegrationPrecision", PRECISION_OF_FIELDS)
    else:
        path, field = os.path.join(folder, "sizes"), gmsh.model.mesh.field
        sizes.grid.write(path, origin)
        structured = field.add("Structured")
        field.setString(structured, "FileName", path)
        field.setNumber(structured, "TextFormat", 0)
        field.setAsBackgroundMesh(structured)
        gmsh.option.setNumber("Mesh.LcIntegrationPrecision", PRECISION)
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
