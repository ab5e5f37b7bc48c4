"""Cuts segments in space where they meet. The result is a graph of points and edges that meet only at their ends."""
from collections import defaultdict

import numpy as np
from shapes import NetworkError

MAX_PAIRS = 5 * 10**6  # of edges that may be close; some gigabytes
MAX_CROSSINGS = 2 * 10**5  # some minutes


def near_pairs(low, high, reach):
    """Returns the pairs i < j, as two arrays, of boxes closer than `reach` in every direction.

    With an array the reach of a pair is the mean of both. Error beyond MAX_PAIRS."""
    half = 0.5 * np.broadcast_to(reach, len(low))[:, None]
    order = np.argsort(low[:, 0] - half[:, 0], kind="stable")
    low, high = (low - half)[order], (high + half)[order]
    last = np.searchsorted(low[:, 0], high[:, 0], side="right")
    first, second, n = [], [], 0
    for i in range(len(low)):
        j = np.arange(i + 1, last[i])
        j = j[np.all((low[j] <= high[i]) & (high[j] >= low[i]), axis=1)]
        first.append(np.full(len(j), i))
        second.append(j)
        n += len(j)
        if n > MAX_PAIRS:
            raise NetworkError(f"the network is too dense: more than {MAX_PAIRS:g} pairs of its {len(low)} edges may be closer than "
                               f"{np.max(reach):.3g} m; remove fractures, or choose smaller cells (\"relative size\", \"size\")")
    first, second = (order[np.concatenate(k).astype(int)] if k else np.array([], int) for k in (first, second))
    return np.minimum(first, second), np.maximum(first, second)


def on_segment(points, begin, end):
    """Returns the nearest position t in [0, 1] on each segment to its point, and the distance."""
    along = end - begin
    square = np.einsum("ij,ij->i", along, along)
    t = np.clip(np.einsum("ij,ij->i", points - begin, along) / np.where(square > 0, square, 1), 0, 1)
    return t, np.linalg.norm(begin + t[:, None] * along - points, axis=1)


def closest(a, b):
    """Returns the nearest positions s, t in [0, 1] on pairs of segments (n, 2, 3), and the distance."""
    u, v, w = a[:, 1] - a[:, 0], b[:, 1] - b[:, 0], a[:, 0] - b[:, 0]
    uu, uv, vv, uw, vw = (np.einsum("ij,ij->i", p, q) for p, q in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    det = uu * vv - uv * uv
    oblique = det > 1e-14 * uu * vv
    safe = np.where(oblique, det, 1)
    s, t = (uv * vw - vv * uw) / safe, (uu * vw - uv * uw) / safe
    within = oblique & (s > 0) & (s < 1) & (t > 0) & (t < 1)
    gap = np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1)
    best = [np.where(within, s, 0), np.where(within, t, 0), np.where(within, gap, np.inf)]
    for k in (0, 1):
        for places in (lambda: (np.full(len(a), float(k)), *on_segment(a[:, k], b[:, 0], b[:, 1])),
                       lambda: (lambda x, d: (x, np.full(len(a), float(k)), d))(*on_segment(b[:, k], a[:, 0], a[:, 1]))):
            new = places()
            better = new[2] < best[2] - 1e-300
            best = [np.where(better, n, old) for n, old in zip(new, best)]
    return best


def merged(points, tolerance):
    """Returns for each point the first point of its cluster.

    Points closer than the tolerance are in the same cluster."""
    owner = np.arange(len(points))

    def find(k):
        while owner[k] != k:
            owner[k] = k = owner[owner[k]]
        return k
    for i, j in zip(*near_pairs(points, points, 2 * tolerance)):
        if np.linalg.norm(points[i] - points[j]) <= tolerance:
            a, b = find(i), find(j)
            owner[max(a, b)] = min(a, b)
    return np.array([find(k) for k in range(len(points))], int)


class Graph:
    """Points (n, 3), and edges {(a, b): indices of their features} with a < b. `joined` lists the joined features."""

    def __init__(self, points, edges, joined=()):
        self.points, self.edges = points, edges
        self.joined = list(joined)  # (gap in m, indices of features, indices of features)

    def segments(self):
        return self.points[np.array(list(self.edges), int).reshape(-1, 2)]

    def parents_at(self):
        """Returns for each point the indices of all features with an edge at this point."""
        parents = defaultdict(set)
        for (a, b), of in self.edges.items():
            parents[a] |= of
            parents[b] |= of
        return parents


def cut(segments, parents, tolerance):
    """Returns the graph of one round: cuts segments where they meet, joins points, merges duplicate edges."""
    i, j = near_pairs(segments.min(axis=1), segments.max(axis=1), 2 * tolerance)
    points, joined, noise = [segments.reshape(-1, 3)], [], 1e-10 * np.ptp(segments.reshape(-1, 3), axis=0).max()
    chains = [[(0.0, 2 * k), (1.0, 2 * k + 1)] for k in range(len(segments))]
    for one, other in ((i, j), (j, i)):  # end points of one segment on the other
        for end in (0, 1):
            t, gap = on_segment(segments[one, end], segments[other, 0], segments[other, 1])
            for k in np.flatnonzero(gap <= tolerance):
                chains[other[k]].append((t[k], 2 * one[k] + end))
                if gap[k] > noise:
                    joined.append((gap[k], parents[one[k]], parents[other[k]]))
    s, t, gap = closest(segments[i], segments[j])
    cross = np.flatnonzero((gap <= tolerance) & (s > 0) & (s < 1) & (t > 0) & (t < 1))
    if len(cross) > MAX_CROSSINGS:
        raise NetworkError(f"the network is too dense: fractures cross in {len(cross)} points, at most {MAX_CROSSINGS} are allowed")
    n = len(points[0])
    for k in cross:
        a, b = segments[i[k]], segments[j[k]]
        points.append([0.5 * ((1 - s[k]) * a[0] + s[k] * a[1] + (1 - t[k]) * b[0] + t[k] * b[1])])
        chains[i[k]].append((s[k], n))
        chains[j[k]].append((t[k], n))
        n += 1
        if gap[k] > noise:
            joined.append((gap[k], parents[i[k]], parents[j[k]]))
    points = np.concatenate(points)
    owner = merged(points, tolerance)
    edges = defaultdict(set)
    for chain, of in zip(chains, parents):
        ids = [owner[k] for _, k in sorted(chain)]
        for a, b in zip(ids, ids[1:]):
            if a != b:
                edges[min(a, b), max(a, b)] |= of
    used = np.unique(np.array(list(edges), int))
    number = {k: n for n, k in enumerate(used)}
    return Graph(points[used], {(number[a], number[b]): frozenset(of) for (a, b), of in edges.items()}, joined)


def arrange(segments, parents, tolerance, rounds=10):
    """Returns the graph of segments (n, 2, 3), each with a set of feature indices.

    Joined points may move an edge onto another one. Further rounds merge these edges."""
    graph = cut(segments, parents, tolerance)
    for _ in range(rounds):
        again = cut(graph.segments(), list(graph.edges.values()), tolerance)
        again.joined += graph.joined
        if len(again.edges) == len(graph.edges) and len(again.points) == len(graph.points):
            return again
        graph = again
    return graph
