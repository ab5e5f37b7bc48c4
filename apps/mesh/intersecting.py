"""Triangles of a surface mesh that intersect others, to name the surfaces for which gmsh fails."""
import numpy as np
from arrange import near_pairs


def pierces(a, b, triangle, margin=1e-9):
    """Returns whether the segments a-b (n, 3) intersect the triangles (n, 3, 3)."""
    origin, u, v = triangle[:, 0], triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]
    normal, along = np.cross(u, v), b - a
    slope = np.einsum("ij,ij->i", normal, along)
    safe = np.where(slope == 0, 1, slope)
    t = np.einsum("ij,ij->i", normal, origin - a) / safe
    w = a + t[:, None] * along - origin
    square = np.einsum("ij,ij->i", normal, normal)
    r = np.einsum("ij,ij->i", np.cross(w, v), normal) / square
    s = np.einsum("ij,ij->i", np.cross(u, w), normal) / square
    return (slope != 0) & (t > -margin) & (t < 1 + margin) & (r > -margin) & (s > -margin) & (r + s < 1 + margin)


def intersecting(points, triangles):
    """Returns pairs (i, j) of triangles (n, 3) without a common node, or with one, that intersect, once each."""
    x = points[triangles]
    i, j = near_pairs(x.min(axis=1), x.max(axis=1), 0.0)
    hits = np.zeros(len(i), bool)
    for one, other in ((i, j), (j, i)):
        for k in range(3):
            ends = triangles[one][:, [k, (k + 1) % 3]]
            apart = (ends[:, :, None] != triangles[other][:, None, :]).all(axis=(1, 2))
            found = np.flatnonzero(apart)
            hits[found] |= pierces(points[ends[found, 0]], points[ends[found, 1]], x[other[found]])
    return i[hits], j[hits]
