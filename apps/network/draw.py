"""Draws the fractures of a set that meet the domain, also those with centres outside of it."""
from dataclasses import dataclass

import centres
import clip
import numpy as np
from generator import fisher, von_mises
from shapes import NetworkError

MAXIMUM = 10**5  # fractures of a set
MAX_CANDIDATES = 10**8
BATCH = 4096  # candidates at once


@dataclass
class Fractures:
    centres: np.ndarray  # (n, dim), m
    normals: np.ndarray  # (n, dim): poles in 3D, directions in 2D
    sizes: np.ndarray  # (n): radii in 3D, lengths in 2D, m
    apertures: np.ndarray  # (n), m, or None
    inside: np.ndarray  # (n): area or length in the domain

    def __len__(self):
        return len(self.sizes)

    def only(self, rows):
        return Fractures(*(None if x is None else x[rows] for x in vars(self).values()))

    def and_more(self, others):
        pairs = zip(vars(self).values(), vars(others).values())
        return Fractures(*(None if x is None else np.concatenate([x, y]) for x, y in pairs))


def count_for(parts, target):
    """Returns the number of first parts, at least one, whose sum is nearest to the target."""
    sums = np.concatenate([[0], np.cumsum(parts)])
    k = int(np.searchsorted(sums, target))
    return max(1, k if sums[k] - target < target - sums[k - 1] else k - 1)


class Stream:
    """Fractures of a set, in the order of drawing, until the number or the intensity is reached.

    The intensity is as near to the requested one as whole fractures allow. Excluded fractures are replaced by later
    ones."""

    def __init__(self, one, statistics, index):
        self.one, self.path = one, statistics.path
        random = np.random.Generator(np.random.PCG64([statistics.seed, index]))
        dim = statistics.dim
        spread = centres.fractal(one.dimension, dim, random) if one.dimension else centres.poisson(dim)
        self.candidates = Candidates(one, statistics.box, spread, random)
        self.target = one.intensity and one.intensity * statistics.measure
        self.drawn, self.tried, self.excluded = self.candidates.batch(BATCH), BATCH, set()

    def fractures(self):
        while True:
            self.rows = np.setdiff1d(np.arange(len(self.drawn)), list(self.excluded))
            parts = self.drawn.inside[self.rows]
            if (len(parts) >= self.one.number) if self.one.number else parts.sum() >= self.target:
                self.rows = self.rows[:self.one.number or count_for(parts, self.target)]
                return self.drawn.only(self.rows)
            expected = 0 if self.one.number or not len(parts) else self.target / parts.mean()
            if expected > MAXIMUM or self.tried > MAX_CANDIDATES:
                raise NetworkError(f"{self.path}: sets > {self.one.name}: has more than {MAXIMUM} fractures; reduce the "
                                   "intensity, or increase the sizes", [self.path])
            self.drawn, self.tried = self.drawn.and_more(self.candidates.batch(BATCH)), self.tried + BATCH

    def exclude(self, k):
        """Excludes a fracture with this index in the last result of `fractures`."""
        self.excluded.add(int(self.rows[k]))


class Candidates:
    """Source of fractures that may meet the domain.

    The pattern of centres fills the domain and is repeated around it. A fracture may meet the domain if its centre is
    in the domain enlarged by its radius or half-length. Sizes are drawn with the weight of the number of repetitions
    within reach, and centres out of reach are rejected. The network is therefore homogeneous up to the boundary."""

    def __init__(self, one, box, spread, random):
        self.one, self.box, self.spread, self.random = one, box, spread, random
        self.extent, self.dim = box[1] - box[0], box.shape[1]
        self.reach = 1.0 if self.dim == 3 else 0.5  # relative to the size
        self.weighted = one.size.weighted(lambda size: np.prod(2 * self.repetitions(size) + 1, axis=1))

    def repetitions(self, size):
        """Returns the repetitions (n, dim) of the domain within reach, on each side."""
        return np.ceil(self.reach * size[:, None] / self.extent)

    def batch(self, n):
        """Returns those of n candidates that meet the domain."""
        one, random = self.one, self.random
        size = self.weighted.draw(random.random(n))
        k = self.repetitions(size)
        shift = np.floor(random.random((n, self.dim)) * (2 * k + 1)) - k
        centre = self.box[0] + self.extent * (self.spread(random, n) + shift)
        normal, noise = self.normals(random.random((n, 2))), random.standard_normal(n)
        aperture = None
        if one.aperture:
            alpha, beta, sigma = one.aperture
            aperture = alpha * size**beta * np.exp(sigma * noise)
        reach = self.reach * size[:, None]
        near = ((centre >= self.box[0] - reach) & (centre <= self.box[1] + reach)).all(axis=1)
        found = Fractures(centre, normal, size, aperture, np.zeros(n)).only(near)
        measure = clip.areas if self.dim == 3 else clip.lengths
        found.inside = measure(found.centres, found.normals, found.sizes, self.box)
        return found.only(found.inside > 1e-9 * found.sizes ** (self.dim - 1))

    def normals(self, uniform):
        """Returns poles by a Fisher distribution, or directions by a von Mises distribution of the doubled angle."""
        if self.dim == 3:
            return fisher(uniform, self.one.mean, self.one.kappa)
        angle = np.arctan2(*self.one.mean) + 0.5 * von_mises(uniform[:, 0], self.one.kappa)
        return np.stack([np.sin(angle), np.cos(angle)], axis=1)
