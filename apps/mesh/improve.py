"""Moves nodes of a mesh near bad cells, for a better worst quality. Fractures and sides keep their shape.

In 3D a node moves freely in the rock, in the plane of one face plane, along a line of two. In 2D a node moves freely in
the rock, and along a straight fracture or side. Nodes of constraints and of the sides of regions stay."""
import numpy as np
from report import gamma

TARGET = 0.08  # quality below which cells are improved
LEAST = 0.03  # quality below which cells are improved further
SWEEPS, MORE_SWEEPS, STEPS = 8, 20, (0.3, 0.1, 0.03, 0.01)
DIRECTIONS = 24
PARALLEL = 1e-6  # smaller singular values of normals belong to one plane


def directions(normals, random):
    """Returns unit vectors in all given planes, (n, 3)."""
    free = np.eye(3)
    if len(normals):
        _, size, right = np.linalg.svd(normals)
        free = right[int((size > PARALLEL).sum()):]
    if not len(free):
        return free
    found = random.normal(size=(DIRECTIONS, len(free))) @ free if len(free) > 1 else np.concatenate([free, -free])
    return found / np.linalg.norm(found, axis=1)[:, None]


def improve(mesh):
    """Moves nodes until no bad cell improves. Returns the number of moved nodes."""
    quality, _ = gamma(mesh.points, mesh.cells)
    random, moved = np.random.default_rng(1), set()
    for k in range(SWEEPS + MORE_SWEEPS):
        bad = np.flatnonzero(quality < (TARGET if k < SWEEPS else LEAST))
        if not len(bad):
            break
        nodes = np.setdiff1d(mesh.cells[bad], mesh.fixed)
        cells_of, faces_of = incident(mesh.cells, nodes), incident(mesh.faces, nodes)
        changed = 0
        for node in nodes.tolist():
            if move(mesh, node, cells_of[node], faces_of[node], quality, random):
                moved.add(node)
                changed += 1
        if not changed:
            break
    return len(moved)


def incident(elements, nodes):
    """Returns {node: elements at this node}."""
    chosen = np.isin(elements, nodes)
    rows, columns = np.nonzero(chosen)
    found = {node: [] for node in nodes.tolist()}
    for row, node in zip(rows.tolist(), elements[rows, columns].tolist()):
        found[node].append(row)
    return found


def signed(x):
    """Returns the volumes of tetrahedra (n, 4, 3) times 6, or the areas of triangles (n, 3, 3) times 2, with their orientation."""
    dim = x.shape[1] - 1
    return np.linalg.det(x[:, 1:, :dim] - x[:, :1, :dim])


def move(mesh, node, cells, faces, quality, random):
    """Moves a node to the best of some places. Returns whether the worst quality of its cells increases."""
    star = mesh.cells[cells]
    x, worst = mesh.points[star], quality[cells].min()
    if worst >= TARGET:
        return False
    orientation = np.sign(signed(x))
    size = np.median(np.linalg.norm(x - mesh.points[node], axis=2).max(axis=1))
    along = free_directions(mesh, node, faces, random)
    if not len(along):
        return False
    places = mesh.points[node] + size * np.concatenate([step * along for step in STEPS])
    at = np.argwhere(star == node)[:, 1]
    trial = np.repeat(x[None], len(places), axis=0)
    trial[:, np.arange(len(star)), at] = places[:, None]
    flat = trial.reshape(-1, *x.shape[1:])
    valid = (np.sign(signed(flat)).reshape(len(places), -1) == orientation).all(axis=1)
    found = gamma(flat.reshape(-1, 3), np.arange(flat[..., 0].size).reshape(flat.shape[:2]))[0].reshape(len(places), -1)
    least = np.where(valid, found.min(axis=1), -1)
    best = int(np.argmax(least))
    if least[best] <= 1.001 * worst:
        return False
    mesh.points[node] = places[best]
    quality[cells] = found[best]
    return True


def free_directions(mesh, node, faces, random):
    """Returns unit vectors (n, 3) in which a node may move; none for a corner."""
    of, owners = mesh.faces[faces], mesh.face_owner[faces]
    rim = on_rim(of, owners, node) if of.shape[1] == 3 else on_line(of, owners, node)
    if rim is None or (len(rim) and not straight(mesh.points, node, rim)):
        return np.empty((0, 3))
    if len(rim):
        line = mesh.points[rim[0]] - mesh.points[node]
        return np.stack([line, -line]) / np.linalg.norm(line)
    return directions(normals_of(mesh.points[of]) if of.shape[1] == 3 else np.eye(3)[2:], random)


def normals_of(triangles):
    """Returns the different unit normals of triangles (n, 3, 3), regardless of their sign."""
    if not len(triangles):
        return np.empty((0, 3))
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    largest = normals[np.arange(len(normals)), abs(normals).argmax(axis=1)]
    return np.unique(np.round(normals * np.sign(largest)[:, None], 9), axis=0)


def on_line(lines, owners, node):
    """Returns the neighbours of a node on a fracture or side in 2D, none in the rock; None for tips and intersections."""
    ends = lines[lines != node].tolist()
    return ends if not ends or (len(ends) == 2 and owners[0] == owners[1]) else None


def on_rim(faces, owners, node):
    """Returns the ends of the edges at a node that do not belong to exactly two faces of one owner; None for a corner.

    These are rims and intersections. A node on such a line has two of these edges."""
    count = {}
    for face, owner in zip(faces.tolist(), owners.tolist()):
        for other in face:
            if other != node:
                count.setdefault(other, []).append(owner)
    ends = [other for other, of in count.items() if len(of) != 2 or of[0] != of[1]]
    return ends if len(ends) in (0, 2) else None


def straight(points, node, ends):
    a, b = (points[end] - points[node] for end in ends)
    return np.linalg.norm(np.cross(a, b)) <= 1e-9 * np.linalg.norm(a) * np.linalg.norm(b) and a @ b < 0
