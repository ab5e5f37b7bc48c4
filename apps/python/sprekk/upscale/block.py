"""Blocks of fractured rock: scenes with the boundary conditions of load cases, geometry, and linear responses."""
import time

import numpy as np

from .. import _sprekk
from ..scene import Scene
OWN_CONDITIONS = ("Boundary conditions", "Time", "Stages", "Probes", "Accuracy", "Heat", "Tracer", "Output")
MOST_SIDES = 12  # of a boundary
LONG = 1e30  # step length without effect of storage, s


def base_entries(entries):
    """Returns entries without conditions, time, and processes other than deformation and flow."""
    found = {name: section for name, section in entries.items() if name not in OWN_CONDITIONS}
    for mesh in ("Mesh", "Mesh file"):
        if mesh in found:
            found[mesh] = {name: value for name, value in found[mesh].items() if name != "periodic"}
    if "Solver" in found:  # blocks of other equations
        found["Solver"] = {name: value for name, value in found["Solver"].items() if name not in ("Blocks", "Sweep")}
    return found


def scene_of(scene, entries, comm):
    """Returns a scene of changed entries with the name and folder of another one. It retains files of its mesh."""
    made = Scene(entries, comm=comm, folder=scene._handle.folder, name=scene.name)
    made._origin = scene
    return made


def outline_of(scene, comm):
    """Returns (dimension, names of the boundaries) of the mesh, which rank 0 reads once for each scene. Collective."""
    if not hasattr(scene, "_outline"):
        found = error = None
        if comm.rank == 0:
            try:
                found = scene._handle.outline()
            except _sprekk.Error as raised:
                error = str(raised)
        found, error = comm.bcast((found, error))
        if error:
            raise _sprekk.Error(error)
        scene._outline = found
    return scene._outline


class Linear:
    """Linear responses of a model at its present state. Unknowns are lists of arrays, one for each block.

    tolerance  of the residuals of linear solves, relative. The errors of energies() are of the order of its square"""

    def __init__(self, model, tolerance):
        self.tolerance = tolerance
        self.model, self.handle, self.comm = model, model._handle, model.comm
        self.blocks = self.handle.blocks()
        self.sizes = [np.asarray(model.field(name)).size for name in self.blocks]
        self.prescribed = [flags.astype(bool) for flags in self.handle.prescribed()]
        self.jacobian_seconds = 0.0  # CPU time of the last linearise()
        self.solves = []  # since then: iterations and CPU seconds of each solve, the first with its preconditioner

    def linearise(self, sparse=False):
        """Computes the Jacobian at the present state, for the following responses.

        sparse: `jacobian` is set to the entries without conditions, see _sprekk.Model.jacobian_at."""
        begin = time.process_time()
        self.handle.linearise(LONG)
        self.jacobian_seconds, self.solves = time.process_time() - begin, []
        if sparse:
            x = [np.array(self.model.field(name)) for name in self.blocks]
            self.jacobian = self.handle.jacobian_at(x, self.model.time, LONG, raw=True)

    def zeros(self):
        return [np.zeros(size) for size in self.sizes]

    def block(self, name):
        return self.blocks.index(name)

    def response(self, right):
        """Returns A^-1 b. Rows of prescribed unknowns are their values."""
        begin = time.process_time()
        found, iterations = self.handle.response_to(right, self.tolerance)
        self.solves.append((iterations, time.process_time() - begin))
        return found

    def free(self, right):
        """Returns b with zeros in the rows of prescribed unknowns."""
        return [np.where(constrained, 0, values) for constrained, values in zip(self.prescribed, right)]

    def product(self, x):
        """Returns A x, also in the rows of prescribed unknowns."""
        return self.handle.product_with(x)

    def energies(self, responses, forces=None):
        """Returns the matrix F_k . x_l + x_k . F_l - x_k . A x_l of responses x_k to forces F_k or prescribed values.

        The sum is over the balances, not over the rows of joint laws, which have no residual. If A is symmetric,
        residuals of the linear solves enter only by their products. forces: absent: zero. Collective."""
        def joined(vectors):
            return np.stack([np.concatenate([one[b] for b in balances]) for one in vectors])

        balances = [b for b, name in enumerate(self.blocks) if name != "traction"]
        x, products = joined(responses), joined([self.product(response) for response in responses])
        found = -x @ products.T
        if forces is not None:
            work = joined(forces) @ x.T
            found += work + work.T
        return self.comm.allreduce(found)

    def residual(self, x, t):
        """Returns the residual at x and time t; rows of prescribed unknowns are reactions."""
        return self.handle.residual_at(x, t, 1.0, raw=True)

    def errors(self, responses, volume):
        """Returns bounds of the errors of a(x_k, x_l) / V for the energy product a, or None without an estimator.

        The bound of the errors e is the sum over the cells of (a(e_k, e_k) a(e_l, e_l))^(1/2)."""
        try:
            found = self.handle.error_energies(responses)
        except _sprekk.Error:  # other cells or flux schemes
            found = {}
        if not found:
            return None
        root = np.sqrt(np.maximum(np.array(next(iter(found.values()))), 0))
        return self.comm.allreduce(root @ root.T) / volume

    def dot(self, a, b):
        """Returns the sum of products over all ranks."""
        return self.comm.allreduce(float(sum(one @ other for one, other in zip(a, b))))


def difference(a, b, scale=1.0):
    return [(one - other) * scale for one, other in zip(a, b)]


class Boundary:
    """Outer faces of a model on this rank, and the volume of the whole block.

    boundary  [face] number of the boundary in mesh.boundaries
    area      [face, dim] area times outward normal, m^2 (2D: m)
    centre    [face, dim]"""

    def __init__(self, model):
        self.model, self.mesh = model, model.mesh
        given = model._handle.boundary()
        self.all_faces = given  # a face may belong to several boundaries
        dim = self.mesh.dim
        _, first = np.unique(np.sort(given["nodes"], axis=1), axis=0, return_index=True)
        self.boundary, self.cell, self.nodes = (given[name][first] for name in ("boundary", "cell", "nodes"))
        self.centre, self.area = given["centre"][first], given["area"][first]
        self.facet = given["facet"][first] if len(given.get("facet", ())) else None
        self.cell_volume = given["cell_volume"]
        self.facet_centre = given.get("facet_centre")
        sums = model.comm.allreduce(np.concatenate([self.area.sum(axis=0), [np.linalg.norm(self.area, axis=1).sum()],
                                                    [np.sum(self.area * self.centre) / dim]]))
        self.volume = float(sums[-1])
        if np.linalg.norm(sums[:dim]) > 1e-9 * sums[dim]:
            raise _sprekk.Error(f"{model.scene.name}: the boundaries {self.mesh.boundaries} do not enclose the rock: "
                                "name all sides of the block")

    def sides(self):
        """Returns the plane sides of each boundary, {name: [(outward normal n, n . x)]}."""
        mesh, faces = self.mesh, self.all_faces
        normal = faces["area"] / np.linalg.norm(faces["area"], axis=1, keepdims=True)
        offset = np.sum(normal * faces["centre"], axis=1)
        gathered = self.model.comm.allgather((faces["boundary"], normal, offset))
        boundary, normal, offset = (np.concatenate(part) for part in zip(*gathered))
        found = {}
        for k, name in enumerate(mesh.boundaries):
            left = boundary == k
            while left.any():
                first = int(np.argmax(left))
                sides = found.setdefault(name, [])
                sides.append((normal[first], float(offset[first])))
                left &= (np.linalg.norm(normal - normal[first], axis=1) > 1e-9) | (
                    np.abs(offset - offset[first]) > self.near())
                if len(sides) > MOST_SIDES:
                    raise _sprekk.Error(f'{self.model.scene.name}: boundary "{name}" has more than {MOST_SIDES} plane '
                                        "sides; uniform stress needs a block with plane sides")
        return found

    def corners(self):
        """Returns the lower and the upper corner of the bounding box of the block, m. Collective."""
        x, comm = self.mesh.coordinates, self.model.comm
        return np.min(comm.allgather(x.min(axis=0)), axis=0), np.max(comm.allgather(x.max(axis=0)), axis=0)

    def near(self):
        """Distance of points that coincide, m."""
        return 1e-7 * self.volume ** (1 / self.mesh.dim)

    def supports(self):
        """Returns points that prevent rigid motions, [(boundary, point, constrained components)], on nodes without copies.

        The points are near corners of the bounding box: one constrained in all directions, one on the axis x constrained in the
        others, in 3D one on the axis y constrained in z."""
        mesh, comm, dim = self.mesh, self.model.comm, self.mesh.dim
        nodes = np.unique(self.nodes[:, :dim])
        boundary_of = {}
        for k, of_face in zip(self.boundary, self.nodes):
            for node in of_face:
                boundary_of.setdefault(int(node), mesh.boundaries[k])
        points = [(tuple(mesh.coordinates[node]), int(mesh.node_id[node]), boundary_of[int(node)]) for node in nodes]
        gathered = {entry[1]: entry for part in comm.allgather(points) for entry in part}.values()
        copies = {}
        for point, number, name in gathered:
            copies.setdefault(point, []).append(name)
        single = {point: names[0] for point, names in copies.items() if len(names) == 1}
        at = np.array(sorted(single))
        low, high = at.min(axis=0), at.max(axis=0)
        found = []
        for k in range(dim):
            target = low.copy()
            if k:
                target[k - 1] = high[k - 1]
            nearest = tuple(at[np.argmin(np.linalg.norm(at - target, axis=1))])
            found.append((single[nearest], nearest, [component for component in range(dim) if component >= k]))
        return found
