"""Positions of fracture centres in the unit square or cube: a Poisson process or a fractal."""
import numpy as np

LEVELS = {2: 8, 3: 6}  # of a cascade; its smallest cells are 1/256 (2D) or 1/64 (3D) of the domain


def poisson(dim):
    """Returns a function (random, n) -> n uniformly distributed points."""
    return lambda random, n: random.random((n, dim))


def fractal(dimension, dim, random):
    """Returns a function (random, n) -> n points with a correlation dimension, by a multiplicative cascade.

    Darcel et al. (2003): each cell is divided into 2^dim cells with the same set of probabilities p, in random order,
    and the sum of p^2 is 2^-dimension. Points are uniformly distributed in the smallest cells."""
    shares = probabilities(dimension, 2**dim)
    density = np.ones((1,) * dim)
    for _ in range(LEVELS[dim]):
        parts = random.permuted(np.tile(shares, (density.size, 1)), axis=1).reshape(*density.shape, *(2,) * dim)
        product = density.reshape(*density.shape, *(1,) * dim) * parts
        side_by_side = [axis for k in range(dim) for axis in (k, dim + k)]
        density = product.transpose(side_by_side).reshape([2 * n for n in density.shape])
    share = np.cumsum(density)

    def draw(random, n):
        cell = np.searchsorted(share, share[-1] * random.random(n), side="right")
        return (np.stack(np.unravel_index(cell, density.shape), axis=1) + random.random((n, dim))) / density.shape[0]
    return draw


def probabilities(dimension, n):
    """Returns n numbers proportional to exp(-s k) with the sum 1 and the sum of squares 2^-dimension."""
    low, high = 0.0, 100.0
    for _ in range(100):
        s = 0.5 * (low + high)
        p = np.exp(-s * np.arange(n))
        p /= p.sum()
        low, high = (low, s) if (p**2).sum() > 2**-dimension else (s, high)
    return p
