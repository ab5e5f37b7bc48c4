"""Random fractures: uniform centres in the domain, lengths by a power law, orientations around a mean."""
import numpy as np
from shapes import frame, regular


def power_law(uniform, shortest, longest, exponent):
    """Returns lengths with a density proportional to L^-exponent between two limits, from uniform numbers in [0, 1)."""
    if abs(exponent - 1) < 1e-12:
        return shortest * (longest / shortest) ** uniform
    a, b = shortest ** (1 - exponent), longest ** (1 - exponent)
    return (a + uniform * (b - a)) ** (1 / (1 - exponent))


def fisher(uniform, mean, concentration):
    """Returns unit vectors around `mean` with a density proportional to exp(concentration * cosine).

    The input `uniform` (n, 2) contains uniform numbers in [0, 1)."""
    k = concentration
    cosine = 1 + np.log1p((uniform[:, 0] - 1) * -np.expm1(-2 * k)) / k if k > 0 else 2 * uniform[:, 0] - 1
    sine, angle = np.sqrt(np.clip(1 - cosine**2, 0, None)), 2 * np.pi * uniform[:, 1]
    first = np.cross(mean, np.eye(3)[np.argmin(abs(mean))])
    first /= np.linalg.norm(first)
    across = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), np.cross(mean, first))
    return cosine[:, None] * mean + sine[:, None] * across


def von_mises(uniform, concentration):
    """Returns angles, in radians, with a density proportional to exp(concentration * cosine)."""
    angle = np.linspace(-np.pi, np.pi, 8193)
    density = np.exp(concentration * (np.cos(angle) - 1))
    share = np.concatenate([[0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    return np.interp(uniform, share / share[-1], angle)


def centres(random, domain, n):
    """Returns n uniformly distributed points in the domain."""
    found = np.empty((0, domain.dim))
    while len(found) < n:
        points = domain.low + random.random((n, domain.dim)) * (domain.high - domain.low)
        found = np.concatenate([found, points[domain.contains(points)]])
    return found[:n]


def at_random(entries, domain, again=None):
    """Returns random fractures as arrays of points: lines in 2D, regular polygons in 3D.

    The corners of a polygon lie on a circle with the random diameter. `again` {index of a fracture: number of repeated
    draws} changes only these fractures."""
    def drawn(seed, n):
        return draw(np.random.Generator(np.random.PCG64(seed)), n, entries, domain)

    found = drawn(entries["seed"], entries["number"])
    for k, times in (again or {}).items():
        found[k] = drawn([entries["seed"], k, times], 1)[0]
    return found


def draw(random, n, entries, domain):
    centre = centres(random, domain, n)
    length = power_law(random.random(n), entries["shortest"], entries["longest"], entries["exponent"])
    uniform = random.random((n, 3))
    if domain.dim == 2:
        angle = np.radians(entries["strike"]) + 0.5 * von_mises(uniform[:, 0], entries["concentration"])
        half = 0.5 * length[:, None] * np.stack([np.sin(angle), np.cos(angle)], axis=1)
        return list(np.stack([centre - half, centre + half], axis=1))
    poles = fisher(uniform[:, :2], frame(entries["strike"], entries["dip"])[2], entries["concentration"])
    found = []
    for x, pole, diameter, turn in zip(centre, poles, length, 2 * np.pi * uniform[:, 2]):
        first = np.cross(pole, np.eye(3)[np.argmin(abs(pole))])
        first /= np.linalg.norm(first)
        first = np.cos(turn) * first + np.sin(turn) * np.cross(pole, first)
        found.append(regular(x, 0.5 * diameter * first, 0.5 * diameter * np.cross(pole, first), entries["corners"]))
    return found
