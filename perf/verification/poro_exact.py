"""Exact solutions of poroelasticity: consolidation, undrained states, fractures opened by fluid, manufactured
solutions.

SI units; lam and G are Lame's constants, alpha is the Biot coefficient, S the storage at constant strain."""
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from perf.verification import exact, flow_exact


@dataclass
class Rock:
    lam: float
    G: float
    S: float
    mobility: float
    alpha: float = 1.0

    @property
    def M(self):
        """Oedometric modulus (uniaxial strain)."""
        return self.lam + 2 * self.G

    @property
    def c(self):
        """Pressure diffusivity."""
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
    """Column of height H with a drained top, loaded there by sigma from time zero on (Terzaghi 1923)."""
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
        """Settlement of the top."""
        k = (2 * np.arange(2000) + 1) * np.pi / 2
        mean = self.undrained * (2 / k**2 * np.exp(-k**2 * self.rock.c * t / self.H**2)).sum()
        return (self.sigma - self.rock.alpha * mean) * self.H / self.rock.M


@dataclass
class Mandel:
    """Quarter 0 < x < a, 0 < y < b of a plate between two rigid, frictionless plates, drained at x = a.

    A force of 2 F per length compresses it from time zero on. Mandel (1953); displacements of Cheng and
    Detournay (1988)."""
    rock: Rock
    a: float
    b: float
    F: float

    @cached_property
    def roots(self):
        """Roots of tan x = x (1 - nu)/(nu_u - nu), one in each interval (n pi, n pi + pi/2), by bisection."""
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
        """Times and displacements of the plate, beginning with 0."""
        return [0.0, *times], [0.0, *(self.approach(t) for t in times)]


@dataclass
class Joined:
    """Block of height 1 with a through-going fracture at fluid pressure p, fixed at its bottom and displaced by
    `way` at its top.

    `way` = (tangential, normal). The equations are N + share p = N0 + k_n ([[u]]_n - d_n) and shear
    traction = T0 + k_s (d_t - [[u]]_t). `share` is 1 for undrained rock or a Biot coefficient of 0, and
    1 - alpha if the rock has the fracture's pressure. Joint as in docs/model/model.md, (11)-(14); the jump
    includes the elastic shear displacement due to T0."""
    lam: float  # undrained value for undrained rock
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
        """Shear stiffness of rock and fracture in series."""
        return 1 / (1 / self.G + 1 / self.shear_stiffness)

    def closed_by(self, N):
        return self.closure * N / (self.closure * self.normal_stiffness + N) if self.closure else 0.0

    def load(self, p, slip):
        return (self.N0 - self.share * p) / self.k_n + self.gap + self.dilation * slip - self.way[1]

    def sheared(self, T):
        """Tangential jump under the shear traction T."""
        return self.way[0] + (self.T0 - T) / self.G + self.T0 / self.shear_stiffness

    def compression(self, softness, load):
        """Solves softness N + closed_by(N) = load > 0 for N."""
        K = self.closure * self.normal_stiffness
        b = softness * K + self.closure - load
        root = np.sqrt(b * b + 4 * softness * load * K)
        return 2 * load * K / (b + root) if b > 0 else (root - b) / (2 * softness)

    @property
    def held(self):
        """Shear traction of the sticking fracture, and slip of the fracture without shear traction."""
        T = self.T0 + self.K_s * self.way[0]
        return T, T / self.K_s

    @property
    def onset(self):
        """Pressures at the onset of sliding and of opening."""
        T, slip = self.held
        N = T / self.friction
        return (self.k_n * (self.load(0, 0) - self.closed_by(N)) - N) / self.share, self.k_n * self.load(0, slip) / self.share

    def state(self, p):
        """Returns (state, N, shear traction, normal jump, tangential jump) with the state "stick", "slip" or "open"."""
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
        """Pressures of the steps: zero, below the onset of sliding, around both onsets, between them, and above."""
        slides, opens = self.onset
        around = [onset * factor for onset in (slides, opens) for factor in (1 - near, 1 + near)]
        between = [slides + (opens - slides) * part for part in (0.1, 0.5, 0.9)]
        return [0.0, 0.0, slides / 2, *around[:2], *between, *around[2:], opens * 1.1]


class Manufactured:
    """Manufactured solution at t = 1, proportional to t, in the unit square or cube with fixed and drained sides.

    2D: p = x (1 - x) sin 2 pi y, u = (p, sin 2 pi x sin 2 pi y) (Nordbotten 2016); 3D in analogy. Lame's
    constants and the mobility are 1."""
    lam = G = mobility = 1.0
    alpha = 0.5

    def __init__(self, dimension):
        self.dimension = dimension

    def fields(self, points):
        """Pressure and displacement with derivatives, [point, 1 + d, 1 + d]; [:, 0] belongs to the pressure."""
        x = points[:, :self.dimension]
        waves = np.stack([np.sin(2 * np.pi * x), 2 * np.pi * np.cos(2 * np.pi * x)])  # [derivative, point, k]
        humps = np.stack([x * (1 - x), 1 - 2 * x])
        found = []
        for hump in [0, 0, *range(1, self.dimension - 1), None]:  # coordinate with the factor x (1 - x)
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
        """Total stress, [point, i, j]."""
        fields, identity = self.fields(points), np.eye(self.dimension)
        slopes = fields[:, 1:, 1:]
        mean = self.lam * np.trace(slopes, axis1=1, axis2=2) - self.alpha * fields[:, 0, 0]
        return self.G * (slopes + slopes.transpose(0, 2, 1)) + mean[:, None, None] * identity


class Opened(flow_exact.Manufactured, exact.Manufactured):
    """Manufactured solution at t = 1, proportional to t, of a fracture opened by fluid.

    Pressures are those of flow_exact.Manufactured without resistance, displacements those of exact.Manufactured
    for an open fracture, where the fluid pressure acts: sigma n = -f n. The aperture is 1 plus the normal jump;
    the transmissivity follows the cubic law."""
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
    """Solution at t = 1/2 of rock with Lame's constants 1 on the unit square.

    p = sin 3t (1 + x - y/2), u = sin 2t (x, y/2), which rectangular cells represent exactly."""

    def pressure(self, points):
        return np.sin(1.5) * (1 + points[:, 0] - points[:, 1] / 2)

    def displacement(self, points):
        return np.sin(1) * points[:, :2] * (1, 0.5)


class OpenInTime:
    """Uniform solution at t = 1/2 of a closed cube of the same rock with an open fracture normal to z.

    The pressure is sin 3t, the opening (1 - cos 2t)/10."""
    pressure, opening = np.sin(1.5), (1 - np.cos(1)) / 10


def mandel_times(step, end=50.0):
    """End times of steps; the first step is so short that no drainage occurs."""
    return [1e-6, *(step * k for k in range(1, round(end / step) + 1))]


FILLED = 1e-3  # pressure of a crack of radius 1, shear modulus 1, at t = 1


def filling(d, nu):
    """Injection rate: crack volume per unit of time. In 3D the crack is a disc (Sneddon 1946)."""
    return float(FILLED * (1 - nu) * (np.pi if d == 2 else 8 / 3))


COLUMN = Terzaghi(Rock(1.65e9, 1.475e9, 0.0, 9.86e-11), 1.0, 1e4)
CONFINED = Joined(1.0, 1.0, (0.15, -0.1), 0.6, 2.0, dilation=np.tan(np.radians(10.0)), gap=0.01, closure=0.1, normal_stiffness=5.0)
STRESSED = Joined(10e9, 15e9, (0.0, 0.0), 0.6, 20e9, 60e6, 20e6)
PLATE = Mandel(Rock(1.65e9, 2.475e9, 6.0606e-11, 9.869e-11), 100.0, 10.0, 6e8)
