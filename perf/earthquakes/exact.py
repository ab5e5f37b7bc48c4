"""Exact solutions of slip driven by fluid, on a plane fault of constant friction in an elastic whole space.

The fault has the effective normal stress s0', the shear stress tau0 and the friction coefficient f. Fluid enters at its
centre; its pressure diffuses along the fault only, with the diffusivity alpha. The slipping region has the half-length
or radius a = lambda sqrt(4 alpha t), where lambda depends on T = (f s0' - tau0)/(f dp) only: the shear traction has no
singularity at its front. With the drop of shear traction f dp (g - T), g = p/dp:

    2D, constant pressure dp at the centre:         int_0^1 (erfc(lambda s) - T)/sqrt(1 - s^2) ds = 0
    3D, constant rate Q, dp = Q mu/(4 pi k w), nu = 0: int_0^1 (E1(lambda^2 s^2) - T) s/sqrt(1 - s^2) ds = 0

Sources: Viesca (2021), Journal of Fluid Mechanics 928, A29 (2D); Saez, Lecampion, Bhattacharya and Viesca (2022),
Journal of the Mechanics and Physics of Solids 160, 104698 (3D)."""
from functools import cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import erfc, exp1

X, W = np.polynomial.legendre.leggauss(64)
ANGLE, WEIGHT = np.pi / 4 * (X + 1), np.pi / 4 * W  # s = sin(angle) removes the root at the front


def drop(dim, s, front):
    """Pressure over dp at the distance s a from the centre."""
    return erfc(front * s) if dim == 2 else exp1((front * s) ** 2)


@cache
def front_coefficient(dim, T):
    """Returns lambda."""
    s = np.sin(ANGLE)
    weight = WEIGHT * (1 if dim == 2 else s)
    return brentq(lambda front: weight @ (drop(dim, s, front) - T), 1e-3, 1e3, xtol=1e-14, rtol=1e-14)


def potency_factor(dim, T):
    """Returns the integral of slip over the fault, divided by f dp (1 - nu^2)/E times a^2 (2D) or a^3 (3D, nu = 0).

    By reciprocity with a uniform drop of traction: in 2D 4 int (g - T) sqrt(1 - s^2) ds over -1 < s < 1, in 3D
    16 int_0^1 (g - T) s sqrt(1 - s^2) ds."""
    s, front = np.sin(ANGLE), front_coefficient(dim, T)
    weight = WEIGHT * np.cos(ANGLE) ** 2 * (8 if dim == 2 else 16 * s)
    return weight @ (drop(dim, s, front) - T)


def slip(dim, T, traction, modulus, front, r):
    """Slip at the distances r from the centre, m: C sqrt(a^2 - r^2) int_0^1 m(s(u)) du, s^2 = r^2 + (a^2 - r^2) u^2.

    C = 4/modulus in 2D and 8/(pi E) in 3D (nu = 0) is the slip of a uniform drop over sqrt(a^2 - r^2). m(s) is a mean
    of the drop of traction over distances below s: 2/pi int drop(s sin w) dw in 2D, int drop(s sin w) sin w dw in 3D,
    0 < w < pi/2."""
    inside = np.clip(np.asarray(r, dtype=float) / front, 0, 1)
    u, weight = (X + 1) / 2, W / 2
    s = np.sqrt(inside[:, None] ** 2 + (1 - inside[:, None] ** 2) * u**2)
    means = WEIGHT * (2 / np.pi if dim == 2 else np.sin(ANGLE))
    values = drop(dim, s[..., None] * np.sin(ANGLE), front_coefficient(dim, T)) - T
    factor = 4 if dim == 2 else 8 / np.pi
    return factor * traction / modulus * front * np.sqrt(1 - inside**2) * (values @ means @ weight)


def potency(dim, T, traction, modulus, front):
    """Integral of slip over the fault, m^2 or m^3; `traction` is f dp, `modulus` E/(1 - nu^2), `front` is a."""
    return potency_factor(dim, T) * traction / modulus * front**dim
