"""Draws discs in a cube with one disc per 1e6 m^3: uniform centres and directions, radii by a power law."""
import numpy as np

SHORTEST, LONGEST, EXPONENT = 30.0, 200.0, 2.5  # radii, m


def table(n, seed):
    """Returns the length of the cube, m, and a CSV file of n discs."""
    random, length = np.random.default_rng(seed), 100.0 * n ** (1 / 3)
    centre = random.uniform(0, length, (n, 3))
    a, b = SHORTEST ** (1 - EXPONENT), LONGEST ** (1 - EXPONENT)
    radius = np.minimum((a + random.random(n) * (b - a)) ** (1 / (1 - EXPONENT)), 0.4 * length)
    dip, direction = np.degrees(np.arccos(random.random(n))), random.uniform(0, 360, n)
    rows = [",".join(f"{value:.2f}" for value in (*x, *others)) for x, *others in zip(centre, dip, direction, radius)]
    return length, "\n".join(["x,y,z,dip,dip direction,radius", *rows, ""])
