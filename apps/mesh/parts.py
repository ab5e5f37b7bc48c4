"""Fractures of several lines or polygons with the same name or number. The parts must meet."""
from itertools import product

import numpy as np
from arrange import closest, near_pairs
from shapes import Errors

HOW = {2: "at their ends", 3: "along their sides"}


class Pieces:
    """Connected components of n objects (union-find). The first object represents its component."""

    def __init__(self, n):
        self.first = list(range(n))

    def of(self, k):
        while self.first[k] != k:
            self.first[k] = k = self.first[self.first[k]]
        return k

    def join(self, a, b):
        a, b = self.of(a), self.of(b)
        self.first[max(a, b)] = min(a, b)


def ends_meet(parts, tolerance):
    """Yields pairs of lines with a common end."""
    ends = np.concatenate([part.points[[0, -1]] for part in parts])
    for i, j in zip(*near_pairs(ends, ends, 2 * tolerance)):
        if np.linalg.norm(ends[i] - ends[j]) <= tolerance:
            yield i // 2, j // 2


def sides(polygon):
    return np.stack([polygon.points, np.roll(polygon.points, -1, axis=0)], axis=1)


def sides_meet(parts, tolerance, pieces):
    """Yields pairs of polygons whose rims meet, except pairs in the same component."""
    low, high = (np.array([of(part.points, axis=0) for part in parts]) for of in (np.min, np.max))
    for i, j in zip(*near_pairs(low, high, 2 * tolerance)):
        if pieces.of(i) != pieces.of(j):
            pairs = list(product(sides(parts[i]), sides(parts[j])))
            one, other = (np.array(segments) for segments in zip(*pairs))
            if closest(one, other)[2].min() <= tolerance:
                yield i, j


def lone(parts, dim, tolerance):
    """Returns the first part not connected to part 0, or None. Parts of one row or feature are connected."""
    pieces, first = Pieces(len(parts)), {}
    for k, part in enumerate(parts):
        pieces.join(k, first.setdefault(part.name, k))
    for i, j in ends_meet(parts, tolerance) if dim == 2 else sides_meet(parts, tolerance, pieces):
        pieces.join(int(i), int(j))
    return next((part for k, part in enumerate(parts) if pieces.of(k) != 0), None)


def joined_parts(fractures, dim, tolerance):
    """Returns a line of the report for each fracture of several rows or features. Error if its parts do not meet."""
    of_name, found, errors = {}, [], Errors()
    for fracture in fractures:
        of_name.setdefault(fracture.single, []).append(fracture)
    for name, parts in of_name.items():
        places = list(dict.fromkeys(part.name for part in parts))
        if len(places) < 2:
            continue
        apart = lone(parts, dim, tolerance)
        if apart is None:
            more = f" and {len(places) - 2} more" if len(places) > 2 else ""
            found.append(f"one fracture, \"{name}\", of {len(places)} parts: {places[0]}, {places[1]}{more}")
            continue
        errors.lines.append(f"{apart.name}: has the name \"{name}\", as {parts[0].name}, and does not meet it; parts "
                            f"of one fracture meet {HOW[dim]}; choose another name or number, or join them")
        errors.features.append((apart.name, parts[0].name))
    errors.throw()
    return found
