"""Responses under periodic conditions, with sparse factors on rank 0."""
import numpy as np

from .. import _sprekk

NEAR = 1e-7  # distance of matching points, relative to the size of the block


class Periodic:
    """Periodic conditions of a Linear: unknowns on opposite plane sides differ by the values of a linear field.

    With the Jacobian A of the model without conditions, linear fields X, forces F and the map T of independent unknowns,

        x = X + T v,   T^t (A x - F) = 0."""

    def __init__(self, linear, boundary):
        self.linear, self.boundary, self.comm = linear, boundary, linear.comm
        self.dim, self.volume = boundary.mesh.dim, boundary.volume
        self.size = self.volume ** (1 / self.dim)

    def means(self, fields, forces, ties, fixed):
        """Returns the matrices X_k . (A x_l - F_l) / V and F_k . x_l / V. Collective.

        fields, forces  X and F, as lists of arrays by block
        ties            pairs of global numbers of unknowns with equal periodic parts, [pair, 2], on rank 0
        fixed           numbers of unknowns whose periodic part is zero, on rank 0"""
        rows, columns, values, n, owned = self.linear.jacobian
        parts = self.comm.gather((rows, columns, values, owned, fields, forces))
        found = error = None
        if parts is not None:
            try:
                found = self._solve(parts, n, ties, fixed)
            except (RuntimeError, MemoryError) as raised:
                error = f"periodic conditions: {raised}"
        found, error = self.comm.bcast((found, error))
        if error:
            raise _sprekk.Error(error)
        return found / self.volume

    def _solve(self, parts, n, ties, fixed):
        from scipy.sparse import coo_matrix, diags
        from scipy.sparse.csgraph import connected_components
        from scipy.sparse.linalg import splu
        rows, columns, values = (np.concatenate([part[k] for part in parts]) for k in range(3))
        A = coo_matrix((values, (rows, columns)), (n, n)).tocsr()
        X, F = (np.zeros((n, len(parts[0][4]))) for _ in range(2))
        for *_, owned, fields, forces in parts:
            for l, pair in enumerate(zip(fields, forces)):
                for ids, of_X, of_F in zip(owned, *pair):
                    X[ids, l], F[ids, l] = of_X, of_F
        graph = coo_matrix((np.ones(len(ties)), (ties[:, 0], ties[:, 1])), (n, n))
        n_free, number = connected_components(graph, directed=False)
        T = coo_matrix((np.ones(n), (np.arange(n), number)), (n, n_free)).tocsr()
        free = np.setdiff1d(np.arange(n_free), number[fixed])
        T = T[:, free]
        M = (T.T @ A @ T).tocsc()
        by_row = 1 / np.maximum(abs(M).max(axis=1).toarray().ravel(), 1e-300)
        M = diags(by_row) @ M
        by_column = 1 / np.maximum(abs(M).max(axis=0).toarray().ravel(), 1e-300)
        factors = splu((M @ diags(by_column)).tocsc())
        right = by_row[:, None] * (T.T @ (F - A @ X))
        v = factors.solve(right)
        v += factors.solve(right - M @ (by_column[:, None] * v))
        x = X + T @ (by_column[:, None] * v)
        return np.stack([X.T @ (A @ x - F), F.T @ x])

    def translations(self):
        """Returns (normal, point, translation) of one side of each pair of opposite sides. Collective."""
        of_face = self.boundary
        gathered = self.comm.allgather((of_face.area, of_face.centre))
        area, centre = (np.concatenate(part) for part in zip(*gathered))
        size = np.linalg.norm(area, axis=1)
        normal = area / size[:, None]
        sides, left = [], np.ones(len(area), bool)
        while left.any():
            k = int(np.argmax(left))
            same = left & (np.linalg.norm(normal - normal[k], axis=1) < NEAR) & (
                np.abs((centre - centre[k]) @ normal[k]) < NEAR * self.size)
            sides.append((normal[k], np.average(centre[same], axis=0, weights=size[same]), size[same].sum()))
            left &= ~same
        found = []
        for k, (n, at, extent) in enumerate(sides):
            opposite = [j for j, other in enumerate(sides) if np.linalg.norm(n + other[0]) < NEAR]
            if len(opposite) != 1 or abs(sides[opposite[0]][2] - extent) > NEAR * extent:
                raise _sprekk.Error(f"{self.boundary.model.scene.name}: periodic conditions need pairs of equal opposite "
                                    f"sides; the side with the normal {np.round(n, 6).tolist()} has none")
            if k < opposite[0]:
                found.append((n, at, sides[opposite[0]][1] - at))
        return found

    def matches(self, points):
        """Returns pairs (i, j) of points [point, dim] on opposite sides. Only on rank 0."""
        from scipy.spatial import cKDTree
        tree, pairs = cKDTree(points), []
        for normal, at, translation in self._translations:
            on_side = np.flatnonzero(np.abs((points - at) @ normal) < NEAR * self.size)
            distance, other = tree.query(points[on_side] + translation)
            far = distance > NEAR * self.size
            if far.any():
                raise _sprekk.Error(
                    f"{self.boundary.model.scene.name}: periodic conditions need equal meshes on opposite sides; "
                    f"{np.round(points[on_side[far][0]], 9).tolist()} has no counterpart")
            pairs.append(np.stack([on_side, other], axis=1))
        return np.concatenate(pairs)

    def tied_facets(self, block):
        """Returns the ties of the prescribed facets of a block, and one of these facets. Collective."""
        self._translations = self.translations()
        constrained = self.linear.prescribed[block]
        ids = self.linear.jacobian[4][block]
        return self._on_root((ids[constrained], self.boundary.facet_centre[constrained]), self._ties_of_points)

    def tied_nodes(self, block):
        """Returns the ties of the displacements of nodes on the boundary, and those of one node. Collective."""
        self._translations = self.translations()
        mesh, faces = self.boundary.mesh, self.boundary
        arrays = (mesh.node_id[faces.nodes], mesh.coordinates[faces.nodes], faces.centre)
        ties, fixed = self._on_root(arrays, self._ties_of_faces)
        owned = self.linear.jacobian[4][block]
        first = min(self.comm.allgather(int(np.min(owned, initial=2**62))))
        return (ties, fixed) if ties is None else (ties + first, fixed + first)

    def _on_root(self, arrays, work):
        parts = self.comm.gather(arrays)
        found = error = None
        if parts is not None:
            try:
                found = work(*(np.concatenate(part) for part in zip(*parts)))
            except _sprekk.Error as raised:
                error = str(raised)
        error = self.comm.bcast(error)
        if error:
            raise _sprekk.Error(error)
        return found or (None, None)

    def _ties_of_points(self, ids, points):
        pairs = self.matches(points)
        return np.stack([ids[pairs[:, 0]], ids[pairs[:, 1]]], axis=1), ids[:1]

    def _ties_of_faces(self, nodes, coordinates, centres):
        """Matches faces, then their nodes, since fractures have a node on each side at the same place."""
        found = []
        for i, j in self.matches(centres):
            shifted = coordinates[i] + centres[j] - centres[i]
            distance = np.linalg.norm(shifted[:, None] - coordinates[j][None], axis=2)
            found.append(np.stack([nodes[i], nodes[j][np.argmin(distance, axis=1)]], axis=1))
        ties = np.unique(np.concatenate(found), axis=0)
        expand = np.arange(self.dim)
        return (ties[:, :, None] * self.dim + expand).transpose(0, 2, 1).reshape(-1, 2), ties[0, 0] * self.dim + expand
