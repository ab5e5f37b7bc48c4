"""Explicit quasi-dynamic solution of a vertical strike-slip fault in an elastic half-space, by the boundary integral
method with constant slip in each cell: problem BP5-QD of the code comparison of SCEC, with slip along the strike only.

Cells are squares of a grid. The shear traction of slip consists of three parts, z and w are depths of traction and slip:
  1. slip in the whole space: the operator -(G/2) (k_x^2/(1 - nu) + k_z^2)/|k|, in closed form for a rectangle
  2. the mirror image above the surface, which removes the shear traction of the surface and doubles its normal traction
  3. the response to the opposite of this normal traction, with k^2 = k_x^2 + k_y^2
         G/(1 - nu) k_x^2 int k_y^2/k^3 (1 - 2 nu - k w) (1 - 2 nu - k z) exp(-k (z + w)) dk_y/(2 pi)"""
import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from perf.earthquakes.half_plane import POISSON, SHEAR_MODULUS, SHEAR_SPEED
from perf.earthquakes.reference import Friction

COMPRESSION, PLATE_RATE = 25e6, 1e-9        # Pa, m/s
LENGTH, DEPTH = 100e3, 40e3                 # m, of the fault with friction
WEAK, STRONG, EVOLUTION = 0.004, 0.04, 0.03  # a in and outside of the part that weakens; b
TOP, BOTTOM, HALF, TURN = 4e3, 16e3, 30e3, 2e3  # m, part that weakens, and width of the transition around it
NUCLEUS = 12e3                              # m, length of the part with the initial event, at the end x < 0
DISTANCE, OF_NUCLEUS = 0.14, 0.13           # L, m
FIRST_RATE = 0.01                           # m/s, in the nucleus


def corners(x, low, high):
    """Traction over G/(4 pi) at the distances x along the strike, [x, place, cell], of unit slip in the whole space in
    a rectangle. `low`, `high`: distances to its ends, [end, ...]."""
    total = 0
    for sign, X in zip((1, -1), x):
        for of, Z in zip((sign, -sign), (low, high)):
            X_, Z_ = X[:, None, None], Z[None]
            R = np.hypot(X_, Z_)
            total = total - of * (Z_ / (X_ * R * (1 - POISSON)) + X_ / (Z_ * R))
    return total


def surface(x, depths, ends, size):
    """Third part over G: [x, place, cell]. The integral over k_y = k_x sinh(s) by the trapezoidal rule."""
    fine = 8  # spacing of x in the transform: size/8
    n = next_fast_len(16 * len(x) * fine, real=True)
    k_x = 2 * np.pi * np.arange(1, n // 2 + 1) * fine / (n * size)
    spectrum = np.zeros((n // 2 + 1, len(depths), len(ends) - 1))
    for index, k in enumerate(k_x, 1):
        if k * depths[0] > 40:
            break
        s = np.arange(0.05, np.arccosh(max(40 / (k * depths[0]), 1.1)) + 0.05, 0.1)
        K = k * np.cosh(s)[:, None]
        of_place = (1 - 2 * POISSON - K * depths) * np.exp(-K * depths) * np.tanh(s)[:, None] ** 2
        of_cell = np.diff((ends + 2 * POISSON / K) * np.exp(-K * ends))
        spectrum[index] = 2 * k * np.sin(k * size / 2) / np.pi * 0.1 * (of_place.T @ of_cell)
    return irfft(spectrum, n, axis=0)[: fine * len(x) : fine] * fine / size / (1 - POISSON)


def kernel(size, n_x, n_z):
    """Shear traction, Pa/m, [distance along the strike, place, cell], at distances 0 to (n_x - 1) size."""
    ends = np.arange(n_z + 1) * size
    depths = (ends[1:] + ends[:-1]) / 2
    x = np.arange(n_x) * size
    to_ends = x + size / 2, x - size / 2
    whole = corners(to_ends, depths[:, None] - ends[:-1], depths[:, None] - ends[1:])
    mirror = corners(to_ends, depths[:, None] + ends[1:], depths[:, None] + ends[:-1])
    return SHEAR_MODULUS * ((whole + mirror) / (4 * np.pi) + surface(x, depths, ends, size))


def direct_effect(x, z):
    outside = np.maximum(np.abs(z - (TOP + BOTTOM) / 2) - (BOTTOM - TOP) / 2, np.abs(x) - HALF)
    return WEAK + (STRONG - WEAK) * np.clip(outside / TURN, 0, 1)


class Plane:
    """The fault of problem BP5-QD with square cells. Around it, the fault slips at the plate rate. Unknowns: slip and
    psi of the cells, [place along the strike, depth]."""

    def __init__(self, size=1000.0):
        n_x, n_z = self.shape = round(LENGTH / size), round(DEPTH / size)
        self.x, self.z = (np.arange(n_x) + 0.5) * size - LENGTH / 2, (np.arange(n_z) + 0.5) * size
        x, z = np.meshgrid(self.x, self.z, indexing="ij")
        in_nucleus = (x < NUCLEUS - HALF) & (x > -HALF) & (z > TOP) & (z < BOTTOM)
        L, first = np.where(in_nucleus, OF_NUCLEUS, DISTANCE).ravel(), np.where(in_nucleus, FIRST_RATE, PLATE_RATE).ravel()
        self.friction = Friction(direct_effect(x, z).ravel(), EVOLUTION, L, SHEAR_MODULUS / (2 * SHEAR_SPEED))
        psi = self.friction.steady_state(PLATE_RATE)
        self.shear, self.n = self.friction.strength(COMPRESSION, first, psi), x.size
        self.start = np.concatenate([np.zeros(self.n), np.full(self.n, psi)])
        self.scale = np.concatenate([L, np.full(self.n, EVOLUTION)])
        of = kernel(size, n_x, n_z)
        self.size = next_fast_len(2 * n_x, real=True)
        whole = np.zeros((self.size, n_z, n_z))
        whole[:n_x], whole[-n_x + 1 :] = of, of[:0:-1]
        self.kernel = rfft(whole, axis=0).real.copy()  # even

    def traction(self, slip):
        """Change of the shear traction by slip relative to the surroundings."""
        return irfft((self.kernel @ rfft(slip.reshape(self.shape), self.size, axis=0)[..., None])[..., 0], self.size, axis=0)[: self.shape[0]].ravel()

    def slip_rate(self, t, y):
        shear = self.shear + self.traction(y[: self.n] - PLATE_RATE * t)
        return self.friction.rate(np.maximum(shear, 0), COMPRESSION, y[self.n :])

    def __call__(self, t, y):
        V = self.slip_rate(t, y)
        return np.concatenate([V, self.friction.state_rate(V, y[self.n :])])
