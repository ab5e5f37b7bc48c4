"""Exact solutions of poroelasticity: consolidation, undrained states, fractures that a fluid opens, manufactured ones.

SI units; the rock's constants are Lame's, alpha is Biot's coefficient, S the storage at constant strain."""
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import exact
import flow_exact


@dataclass
class Rock:
    lam: float
    G: float
    S: float
    mobility: float
    alpha: float = 1.0

    @property
    def M(self):
        """Of uniaxial strain."""
        return self.lam + 2 * self.G

    @property
    def c(self):
        """Diffusivity of the pressure."""
        return self.mobility / (self.S + self.alpha**2 / self.M)

    @property
    def nu(self):
        return self.lam / (2 * (self.lam + self.G))

    @property
    def undrained_nu(self):
        lam = self.lam + self.alpha**2 / self.S
        return lam / (2 * (lam + self.G))

    @property
    def skempton(self):
        K = self.lam + 2 * self.G / 3
        return self.alpha / self.S / (K + self.alpha**2 / self.S)


@dataclass
class Terzaghi:
    """Column of height H, drained and loaded by sigma at its top from time zero on (Terzaghi 1923)."""
    rock: Rock
    H: float
    sigma: float

    @property
    def undrained(self):
        return self.rock.alpha * self.sigma / (self.rock.M * self.rock.S + self.rock.alpha**2)

    def pressure(self, depth, t):
        k = (2 * np.arange(2000) + 1) * np.pi / 2
        waves = 2 / k * np.sin(np.outer(depth / self.H, k))
        return self.undrained * (waves * np.exp(-k**2 * self.rock.c * t / self.H**2)).sum(axis=1)

    def settlement(self, t):
        """Of the top."""
        k = (2 * np.arange(2000) + 1) * np.pi / 2
        mean = self.undrained * (2 / k**2 * np.exp(-k**2 * self.rock.c * t / self.H**2)).sum()
        return (self.sigma - self.rock.alpha * mean) * self.H / self.rock.M


@dataclass
class Mandel:
    """The quarter 0 < x < a, 0 < y < b of a plate between two rigid ones without friction, which a force of 2 F per length presses
    together from time zero on; drained at x = a (Mandel 1953; displacements of Cheng and Detournay 1988)."""
    rock: Rock
    a: float
    b: float
    F: float

    @cached_property
    def roots(self):
        """Of tan x = x (1 - nu)/(nu_u - nu), one in each interval (n pi, n pi + pi/2), by bisection."""
        ratio = (1 - self.rock.nu) / (self.rock.undrained_nu - self.rock.nu)
        n = np.arange(400)
        low, high = n * np.pi + np.where(n == 0, 1e-6, 0), n * np.pi + np.pi / 2
        for _ in range(100):
            middle = (low + high) / 2
            below = (-1.0)**n * (np.sin(middle) - ratio * middle * np.cos(middle)) < 0
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return (low + high) / 2

    @property
    def undrained(self):
        return self.F * self.rock.skempton * (1 + self.rock.undrained_nu) / (3 * self.a)

    def modes(self, t):
        x = self.roots
        return np.exp(-x**2 * self.rock.c * t / self.a**2) / (x - np.sin(x) * np.cos(x))

    def pressure(self, x, t):
        r = self.roots
        return 2 * self.undrained * (np.sin(r) * self.modes(t) * (np.cos(np.outer(x / self.a, r)) - np.cos(r))).sum(axis=1)

    def approach(self, t):
        """Displacement of the plate at y = b, along y."""
        r, nu, undrained_nu = self.roots, self.rock.nu, self.rock.undrained_nu
        sum_of = (np.sin(r) * np.cos(r) * self.modes(t)).sum()
        return (-self.F * (1 - nu) / (2 * self.rock.G * self.a) + self.F * (1 - undrained_nu) / (self.rock.G * self.a) * sum_of) * self.b


    def way(self, times):
        """Times and displacements of the plate, from rest on."""
        return [0.0, *times], [0.0, *(self.approach(t) for t in times)]


@dataclass
class Joined:
    """A block of height 1 with a fracture through it, fixed at its bottom and displaced by `way` (along the fracture, along the normal) at
    its top, in which the fluid has the pressure p: N + share p = N0 + k_n ([[u]]_n - d_n), shear traction = T0 + k_s (d_t - [[u]]_t).
    `share` is 1 where the rock keeps its fluid, or Biot's coefficient is 0, and 1 - Biot's coefficient where the pressure in the rock is
    that of the fracture. Joint as in docs/model/model.md, (11)-(14); the jump has what T0 stretches the joint by."""
    lam: float  # undrained where the rock keeps its fluid
    G: float
    way: tuple
    friction: float
    shear_stiffness: float
    N0: float = 0.0
    T0: float = 0.0
    dilation: float = 0.0  # tan theta
    gap: float = 0.0
    closure: float = 0.0
    normal_stiffness: float = 1.0
    share: float = 1.0

    @property
    def k_n(self):
        return self.lam + 2 * self.G

    @property
    def K_s(self):
        """Of rock and fracture."""
        return 1 / (1 / self.G + 1 / self.shear_stiffness)

    def closed_by(self, N):
        return self.closure * N / (self.closure * self.normal_stiffness + N) if self.closure else 0.0

    def load(self, p, slip):
        return (self.N0 - self.share * p) / self.k_n + self.gap + self.dilation * slip - self.way[1]

    def sheared(self, T):
        """Tangential jump under the traction T."""
        return self.way[0] + (self.T0 - T) / self.G + self.T0 / self.shear_stiffness

    def compression(self, softness, load):
        """N of softness N + closed_by(N) = load > 0."""
        K = self.closure * self.normal_stiffness
        b = softness * K + self.closure - load
        root = np.sqrt(b * b + 4 * softness * load * K)
        return 2 * load * K / (b + root) if b > 0 else (root - b) / (2 * softness)

    @property
    def held(self):
        """The shear traction of a fracture that sticks, and the slip of one without traction."""
        T = self.T0 + self.K_s * self.way[0]
        return T, T / self.K_s

    @property
    def onset(self):
        """Pressures at which it begins to slide, and to open."""
        T, slip = self.held
        N = T / self.friction
        return (self.k_n * (self.load(0, 0) - self.closed_by(N)) - N) / self.share, self.k_n * self.load(0, slip) / self.share

    def state(self, p):
        """"stick", "slip" or "open", N, shear traction, normal and tangential jump."""
        T, free = self.held
        if self.load(p, free) <= 0:
            return "open", 0.0, 0.0, self.way[1] - (self.N0 - self.share * p) / self.k_n, self.sheared(0)
        N = self.compression(1 / self.k_n, self.load(p, 0)) if self.load(p, 0) > 0 else 0.0
        if T <= self.friction * N:
            return "stick", N, T, self.gap - self.closed_by(N), self.sheared(T)
        N = self.compression(1 / self.k_n + self.dilation * self.friction / self.K_s, self.load(p, free))
        T, slip = self.friction * N, free - self.friction * N / self.K_s
        return "slip", N, T, self.gap + self.dilation * slip - self.closed_by(N), self.sheared(T)

    def path(self, near=1e-6):
        """Pressures, first at the start, around both onsets and between them."""
        slides, opens = self.onset
        around = [onset * factor for onset in (slides, opens) for factor in (1 - near, 1 + near)]
        between = [slides + (opens - slides) * part for part in (0.1, 0.5, 0.9)]
        return [0.0, 0.0, slides / 2, *around[:2], *between, *around[2:], opens * 1.1]


class Manufactured:
    """Unit square or cube, fixed and drained on its sides, at t = 1; everything is proportional to t: in 2D p = x (1 - x) sin 2 pi y,
    u = (p, sin 2 pi x sin 2 pi y) (Nordbotten 2016), in 3D likewise. Both Lame's constants and the mobility are 1."""
    lam = G = mobility = 1.0
    alpha = 0.5

    def __init__(self, dimension):
        self.dimension = dimension

    def fields(self, points):
        """Pressure and displacement, each with derivatives: values [point, 1 + d, 1 + d]; [:, 0] are those of the pressure."""
        x = points[:, :self.dimension]
        waves = np.stack([np.sin(2 * np.pi * x), 2 * np.pi * np.cos(2 * np.pi * x)])  # [derivative, point, k]
        humps = np.stack([x * (1 - x), 1 - 2 * x])
        found = []
        for hump in [0, 0, *range(1, self.dimension - 1), None]:  # the coordinate whose factor is x (1 - x)
            factors = [(humps if k == hump else waves)[:, :, k] for k in range(self.dimension)]
            slopes = [[factors[k][int(k == j)] for k in range(self.dimension)] for j in range(-1, self.dimension)]
            found.append(np.stack([np.prod(each, axis=0) for each in slopes], axis=1))
        return np.stack(found, axis=1)

    def pressure(self, points):
        return self.fields(points)[:, 0, 0]

    def velocity(self, points):
        return -self.mobility * self.fields(points)[:, 0, 1:]

    def displacement(self, points):
        return self.fields(points)[:, 1:, 0]

    def stress(self, points):
        """Total, [point, i, j]."""
        fields, identity = self.fields(points), np.eye(self.dimension)
        slopes = fields[:, 1:, 1:]
        mean = self.lam * np.trace(slopes, axis1=1, axis2=2) - self.alpha * fields[:, 0, 0]
        return self.G * (slopes + slopes.transpose(0, 2, 1)) + mean[:, None, None] * identity


class Opened(flow_exact.Manufactured, exact.Manufactured):
    """At t = 1; everything is proportional to t. The pressures of flow_exact.Manufactured without resistance, and the displacements of
    exact.Manufactured for a fracture that is open: in it the fluid pushes, sigma n = -f n. Its aperture is 1 plus the normal jump, and its
    transmissivity follows the cubic law."""
    alpha = 0.5

    def __init__(self, dimension):
        super().__init__(dimension, False)

    def on(self, s):
        f, below, above, _, C = super().on(s)
        return f, below, above, (1 + self.law(s)[3][-1])**3 / 6, C

    def law(self, s):
        x, y = s[0], s[1] if len(s) > 1 else 0
        tangential = [np.cos(x + y) / 5, np.sin(x - y) / 5][:len(s)]
        f, zero = super().on(s)[0], np.zeros((len(s), np.size(x)))
        return (1 - self.alpha) * f, zero, zero, np.stack([*tangential, 0.5 + np.sin(2 * x + y) / 5])


class InTime:
    """At t = 1/2, of rock of Lame's constants 1 on a square of edge 1: p = sin 3t (1 + x - y/2), u = sin 2t (x, y/2), which rectangular
    cells represent exactly."""

    def pressure(self, points):
        return np.sin(1.5) * (1 + points[:, 0] - points[:, 1] / 2)

    def displacement(self, points):
        return np.sin(1) * points[:, :2] * (1, 0.5)


class OpenInTime:
    """At t = 1/2, of a closed cube of such rock with an open fracture across z: the pressure sin 3t and the opening (1 - cos 2t)/10,
    everywhere the same."""
    pressure, opening = np.sin(1.5), (1 - np.cos(1)) / 10


def mandel_times(step, end=50.0):
    """Of steps; the first is over before anything drains."""
    return [1e-6, *(step * k for k in range(1, round(end / step) + 1))]


FILLED = 1e-3  # pressure of a crack of radius 1, shear modulus 1, at t = 1


def filling(d, nu):
    """What has to flow into it per time, 3D into a disc (Sneddon 1946)."""
    return float(FILLED * (1 - nu) * (np.pi if d == 2 else 8 / 3))


COLUMN = Terzaghi(Rock(1.65e9, 1.475e9, 0.0, 9.86e-11), 1.0, 1e4)
CONFINED = Joined(1.0, 1.0, (0.15, -0.1), 0.6, 2.0, dilation=np.tan(np.radians(10.0)), gap=0.01, closure=0.1, normal_stiffness=5.0)
STRESSED = Joined(10e9, 15e9, (0.0, 0.0), 0.6, 20e9, 60e6, 20e6)
PLATE = Mandel(Rock(1.65e9, 2.475e9, 6.0606e-11, 9.869e-11), 100.0, 10.0, 6e8)
