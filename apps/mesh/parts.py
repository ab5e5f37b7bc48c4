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


def connected(parts, dim, tolerance):
    """Returns for each part the first part of its component. Parts of one row or feature are connected."""
    pieces, first = Pieces(len(parts)), {}
    for k, part in enumerate(parts):
        pieces.join(k, first.setdefault(part.name, k))
    for i, j in ends_meet(parts, tolerance) if dim == 2 else sides_meet(parts, tolerance, pieces):
        pieces.join(int(i), int(j))
    return [pieces.of(k) for k in range(len(parts))]


def separate_parts(fractures, dim, tolerance):
    """Gives parts of one name that do not meet their own names. Returns a line of the report for each such name."""
    of_name, taken, found = {}, {fracture.single for fracture in fractures}, []
    for fracture in fractures:
        of_name.setdefault(fracture.single, []).append(fracture)
    for name, parts in of_name.items():
        if len({part.name for part in parts}) < 2:
            continue
        component, new = connected(parts, dim, tolerance), {}
        for part, first in zip(parts, component):
            if first and first not in new:
                k = 2 + len(new)
                while f"{name} ({k})" in taken:
                    k += 1
                new[first] = f"{name} ({k})"
                taken.add(new[first])
            part.single = new.get(first, name)
        if new:
            found.append(f"{len(new) + 1} fractures instead of one, \"{name}\", since its parts do not meet")
    return found


def joined_parts(fractures, dim, tolerance):
    """Returns a line of the report for each fracture of several rows or features. Error if its parts do not meet."""
    of_name, found, errors = {}, [], Errors()
    for fracture in fractures:
        of_name.setdefault(fracture.single, []).append(fracture)
    for name, parts in of_name.items():
        places = list(dict.fromkeys(part.name for part in parts))
        if len(places) < 2:
            continue
        apart = next((part for part, first in zip(parts, connected(parts, dim, tolerance)) if first), None)
        if apart is None:
            more = f" and {len(places) - 2} more" if len(places) > 2 else ""
            found.append(f"one fracture, \"{name}\", of {len(places)} parts: {places[0]}, {places[1]}{more}")
            continue
        errors.lines.append(f"{apart.name}: has the name \"{name}\", as {parts[0].name}, and does not meet it; parts "
                            f"of one fracture meet {HOW[dim]}; choose another name or number, or join them")
        errors.features.append((apart.name, parts[0].name))
    errors.throw()
    return found
