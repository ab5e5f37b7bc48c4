"""Triangles of all faces of a network in 3D as one mesh in gmsh, changed where faces are in conflict.

Repairs move points of intersections by up to some tolerances off the planes of fractures. Two faces may then share a
triangle, or meet at a small angle next to such a point. Shared triangles remain in one face. Bisection of the longest
edge adds nodes in the planes, so that faces deviate from them only next to these points."""
import gmsh
import numpy as np
from intersecting import intersecting

SIDES = np.array([[1, 2], [2, 0], [0, 1]])  # side k of a triangle is opposite of its corner k
FOLDED = 1.0  # degrees between triangles of two faces at a common edge, below which both are bisected
MAX_REMOVED = 0.05  # share of the area of a fracture that may be removed at poor cells


def edges_of(triangles, n):
    """Returns the edges (m, 2) of triangles among n points, each once, and the edge of each side [triangle, side]."""
    ends = np.sort(triangles[:, SIDES], axis=2)
    code, of = np.unique(ends[..., 0] * n + ends[..., 1], return_inverse=True)
    return np.stack([code // n, code % n], axis=1), of.reshape(-1, 3)


def edges_to_split(points, triangles, marked):
    """Returns edges, edges of sides, longest side of each triangle, and which edges to bisect.

    All marked triangles lose their longest edge. A triangle that loses another edge loses its longest, too, so that the
    parts remain well shaped (Rivara 1984)."""
    edges, of = edges_of(triangles, len(points))
    length = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
    longest = np.argmax(length[of] * (1 + 1e-9 * of / len(edges)), axis=1)
    first, chosen = of[np.arange(len(of)), longest], np.zeros(len(edges), bool)
    chosen[first[marked]] = True
    while True:
        lacking = chosen[of].any(axis=1) & ~chosen[first]
        if not lacking.any():
            return edges, of, longest, chosen
        chosen[first[lacking]] = True


def bisected(triangles, of, longest, middle):
    """Returns the parts of all triangles, and the triangle of each part. `middle` [edge] is its new point, or -1."""
    turn, rows = (longest[:, None] + np.arange(3)) % 3, np.arange(len(triangles))[:, None]
    t, new = triangles[rows, turn], middle[of[rows, turn]]  # the longest side is opposite of the first corner
    split = np.flatnonzero(new[:, 0] >= 0)
    parts, parents = [t[new[:, 0] < 0]], [np.flatnonzero(new[:, 0] < 0)]
    a, b, c = t[split].T
    for one, other, half in ((a, b, new[split, 2]), (c, a, new[split, 1])):
        apex, whole = new[split, 0], half < 0
        parts += [np.stack([apex, one, np.where(whole, other, half)], axis=1), np.stack([apex, half, other], axis=1)[~whole]]
        parents += [split, split[~whole]]
    return np.concatenate(parts), np.concatenate(parents)


def shared(triangles):
    """Returns groups of indices of triangles with the same corners."""
    _, of, count = np.unique(np.sort(triangles, axis=1), axis=0, return_inverse=True, return_counts=True)
    of, groups = of.ravel(), {}
    for k in np.flatnonzero(count[of] > 1).tolist():
        groups.setdefault(of[k], []).append(k)
    return list(groups.values())


def folded(points, triangles, face):
    """Returns the triangles that meet one of another face at a common edge under an angle below FOLDED."""
    edges, of = edges_of(triangles, len(points))
    order = np.argsort(of.ravel(), kind="stable")
    edge, found = of.ravel()[order], np.zeros(len(triangles), bool)
    triangle, side = np.divmod(order, 3)
    begin, end = points[edges[edge, 0]], points[edges[edge, 1]]
    along = (end - begin) / np.linalg.norm(end - begin, axis=1)[:, None]
    away = points[triangles[triangle, side]] - begin
    away -= np.einsum("ij,ij->i", away, along)[:, None] * along
    away /= np.linalg.norm(away, axis=1)[:, None]
    for step in range(1, np.bincount(edge).max()):
        i = np.flatnonzero((edge[step:] == edge[:-step]) & (face[triangle[step:]] != face[triangle[:-step]]))
        i = i[np.linalg.norm(away[i] - away[i + step], axis=1) < np.radians(FOLDED)]
        found[triangle[i]] = found[triangle[i + step]] = True
    return found


class SurfaceMesh:
    """Mesh of all curves and faces in gmsh.

    points    (n, 3), relative to the origin of gmsh
    tag       (n,) tags of nodes in gmsh
    home      (n, 2) dimension and tag of the entity of each node
    lines     (l, 2) with curve (l,), tags of curves
    triangles (m, 3) with face (m,), indices of model.faces"""

    def __init__(self, model):
        self.model, mesh = model, gmsh.model.mesh
        number, points, self.tag = model.nodes()
        self.points = points - model.origin
        self.home = np.zeros((len(self.tag), 2), int)
        for dim in (0, 1, 2):
            for _, entity in gmsh.model.getEntities(dim):
                own = mesh.getNodes(dim, entity)[0]
                self.home[number[own.astype(int)]] = dim, entity
        self.lines, self.curve = together([(tag, model.elements(1, tag, number)) for tag in model.line.values()], 2)
        self.triangles, self.face = together([(k, model.elements(2, face.tag, number)) for k, face in enumerate(model.faces)], 3)

    def owners(self):
        """Returns the owner in the plan of each triangle."""
        return np.array([face.owner for face in self.model.faces])[self.face]

    def areas(self):
        x = self.points[self.triangles]
        return 0.5 * np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1)

    def without_shared(self):
        """Removes triangles with the same corners except one, of a side or of the largest fracture.

        Returns {(owner that loses triangles, owner that has them): area}."""
        owner, area, plan, lost, found = self.owners(), self.areas(), self.model.plan, [], {}
        total = np.bincount(owner, area, len(plan.owners))
        for group in shared(self.triangles):
            first, *others = sorted(group, key=lambda k: (plan.is_fracture(owner[k]), -total[owner[k]], owner[k]))
            for k in others:
                lost.append(k)
                pair = int(owner[k]), int(owner[first])
                found[pair] = found.get(pair, 0.0) + area[k]
        self.remove(lost)
        return found

    def remove(self, lost):
        """Removes triangles, given by their indices."""
        if len(lost):
            changed = np.unique(self.face[lost])
            self.triangles, self.face = np.delete(self.triangles, lost, axis=0), np.delete(self.face, lost)
            self.write(changed, [])

    def without_narrow(self, cells, before):
        """Removes triangles of the smallest fracture at each of the cells, given by the tags of their nodes (n, 4).

        These are the triangles at nodes of the cell that belong to this fracture alone, and otherwise those with two nodes
        of the cell. A fracture loses at most the share MAX_REMOVED of its area, that of earlier calls, `before`, included.
        Returns {(owner that loses triangles, another owner at the cell or the same): area}."""
        owner, area, plan, lost, found = self.owners(), self.areas(), self.model.plan, set(), {}
        total, corners = np.bincount(owner, area, len(plan.owners)), self.tag[self.triangles]
        removed = np.zeros(len(total))
        for (k, _), lost_before in before.items():
            removed[k] += lost_before
        for cell in cells:
            at = np.isin(corners, cell)
            beside = np.flatnonzero(at.sum(axis=1) > 1)
            by_size = sorted(set(owner[beside].tolist()), key=lambda k: (not plan.is_fracture(k), total[k]))
            if not by_size or not plan.is_fracture(by_size[0]):
                continue
            smallest, other = by_size[0], by_size[1 % len(by_size)]
            alone = np.setdiff1d(cell, corners[owner != smallest])
            chosen = np.flatnonzero((owner == smallest) & np.isin(corners, alone).any(axis=1)) if len(alone) else beside[owner[beside] == smallest]
            chosen = [k for k in chosen.tolist() if k not in lost]
            if removed[smallest] + area[chosen].sum() <= MAX_REMOVED * total[smallest]:
                removed[smallest] += area[chosen].sum()
                lost.update(chosen)
                found[smallest, other] = found.get((smallest, other), 0.0) + area[chosen].sum()
        self.remove(sorted(lost))
        return found

    def folded(self):
        return folded(self.points, self.triangles, self.face)

    def intersecting(self):
        """Returns the triangles that intersect others."""
        found = np.zeros(len(self.triangles), bool)
        for k in intersecting(self.points, self.triangles):
            found[k] = True
        return found

    def beside(self, cells):
        """Returns the triangles with two corners of one of the cells, given by the tags of their nodes (n, 4)."""
        found, chosen = np.zeros(len(self.triangles), bool), np.isin(self.tag[self.triangles], cells)
        near = np.flatnonzero(chosen.sum(axis=1) > 1)
        for cell in cells:
            found[near] |= np.isin(self.tag[self.triangles[near]], cell).sum(axis=1) > 1
        return found

    def bisect(self, marked):
        """Bisects the longest edges of the marked triangles. Returns the new points and the lengths of edges there."""
        edges, of, longest, chosen = edges_to_split(self.points, self.triangles, marked)
        n, split = len(self.points), edges[chosen]
        middle = np.full(len(edges), -1)
        middle[chosen] = n + np.arange(len(split))
        on_curve = {tuple(sorted(ends)): tag for ends, tag in zip(self.lines.tolist(), self.curve.tolist())}
        faces_at = np.full((len(edges), 2), -1)  # a face at each edge, and another one or -1
        for side in range(3):
            faces_at[of[:, side], 0] = self.face
        for side in range(3):
            other = faces_at[of[:, side], 0] != self.face
            faces_at[of[other, side], 1] = self.face[other]
        x, home = self.points[split].mean(axis=1), np.zeros((len(split), 2), int)
        for k, (ends, edge) in enumerate(zip(split.tolist(), np.flatnonzero(chosen))):
            tag = on_curve.get(tuple(ends))
            face = self.model.faces[faces_at[edge, 0]]
            home[k] = (1, tag) if tag else (2, face.tag)
            if not tag and faces_at[edge, 1] < 0:
                plane = self.model.plan.surfaces[face.owner].plane
                x[k] -= plane.height(x[k] + self.model.origin) * plane.normal
        self.points, self.home = np.concatenate([self.points, x]), np.concatenate([self.home, home])
        self.tag = np.concatenate([self.tag, self.tag.max() + 1 + np.arange(len(x))])
        changed = np.unique(self.face[chosen[of].any(axis=1)])
        self.triangles, parents = bisected(self.triangles, of, longest, middle)
        self.face = self.face[parents]
        number = {tuple(ends): m for ends, m in zip(split.tolist(), middle[chosen].tolist())}
        cut = np.array([number.get(tuple(sorted(ends)), -1) for ends in self.lines.tolist()])
        k = np.flatnonzero(cut >= 0)
        self.lines = np.concatenate([self.lines[cut < 0], np.stack([self.lines[k, 0], cut[k]], axis=1), np.stack([cut[k], self.lines[k, 1]], axis=1)])
        curves = np.unique(self.curve[k])
        self.curve = np.concatenate([self.curve[cut < 0], self.curve[k], self.curve[k]])
        self.write(changed, curves)
        return x + self.model.origin, 0.5 * np.linalg.norm(self.points[split[:, 1]] - self.points[split[:, 0]], axis=1)

    def write(self, faces, curves):
        """Replaces the meshes of faces (indices), curves (tags) and their faces in gmsh, and removes the mesh of the volume."""
        mesh, changed = gmsh.model.mesh, set(map(int, curves))
        faces = {*map(int, faces), *(k for k, face in enumerate(self.model.faces) if changed & set(self.model.curves(face)))}
        while True:  # faces with nodes of changed faces, too
            tags = [self.model.faces[k].tag for k in faces]
            own = (self.home[:, 0] == 2) & np.isin(self.home[:, 1], tags)
            using = set(self.face[own[self.triangles].any(axis=1)].tolist())
            if using <= faces:
                break
            faces |= using
        faces = sorted(faces)
        mesh.clear([(3, 1)])
        mesh.clear([(2, self.model.faces[k].tag) for k in faces])
        if len(curves):
            mesh.clear([(1, int(tag)) for tag in curves])
        parts = [*((1, int(tag), self.lines[self.curve == tag]) for tag in curves),
                 *((2, self.model.faces[k].tag, self.triangles[self.face == k]) for k in faces)]
        for dim, tag, _ in parts:
            own = np.flatnonzero((self.home == (dim, tag)).all(axis=1))
            if len(own):
                mesh.addNodes(dim, tag, self.tag[own], self.points[own].ravel())
        for dim, tag, elements in parts:  # types 1 and 2 of gmsh are lines and triangles
            if len(elements):
                mesh.addElementsByType(tag, dim, [], self.tag[elements].ravel())


def together(parts, n):
    """Returns the elements (m, n) of all (number, elements), and the number of each element."""
    elements = np.concatenate([of for _, of in parts] or [np.zeros((0, n), int)])
    return elements, np.concatenate([np.full(len(of), k) for k, of in parts] or [np.zeros(0, int)])
