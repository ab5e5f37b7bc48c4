"""Exact and independent solutions of cracks at their toughness, in plane strain. Lengths in m, forces per depth."""
import math

from scipy.optimize import brentq

SHIFT = 0.673112  # of the length of a double cantilever beam over the height of an arm: Wiener-Hopf solution of the strip


def beam_length(delta, arm, modulus, energy):
    """Length of a double cantilever beam whose ends are apart by delta."""
    return (3 * modulus * arm**3 * delta**2 / (16 * energy)) ** 0.25 - SHIFT * arm


def pressure(a, half, toughness):
    """Pressure of a crack of half-length a at its toughness, in the middle of a tall body between rollers at +-half."""
    return toughness / math.sqrt(2 * half * math.tan(math.pi * a / (2 * half)))


def area(a, half, modulus, toughness):
    """Area of this crack: dv/da = 4 K^2/(E' p^2) at given p, integrated."""
    return -16 * half**2 / (math.pi * modulus) * pressure(a, half, toughness) * math.log(math.cos(math.pi * a / (2 * half)))


def width(a, half, modulus, toughness):
    """Opening of this crack in its middle."""
    return 8 * half / (math.pi * modulus) * pressure(a, half, toughness) * math.acosh(1 / math.cos(math.pi * a / (2 * half)))


def length(volume, half, modulus, toughness):
    """Half-length of the crack of this area at its toughness."""
    return brentq(lambda a: area(a, half, modulus, toughness) - volume, 1e-6 * half, 0.9 * half)
