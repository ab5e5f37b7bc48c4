"""Exact displacements, jumps and tractions of the cases, as functions of arrays of points, independent of the
program.

Signs as in docs/model/model.md: the normal n points from side - to side +, the jump is u+ - u-, tension is
positive. G = shear modulus, nu = Poisson's ratio, plane strain in 2D."""
import math

import numpy as np

STEP = 1e-20  # complex step for derivatives without cancellation


def lame(G, nu):
    """Lame's first parameter."""
    return 2 * G * nu / (1 - 2 * nu)


class Crack:
    """Straight crack of half-length 1 at the origin of the plane, rotated by `angle` (degrees).

    `drop` is the released normal (mode 1: pressure) or shear (mode 2) stress s. Westergaard functions:
    Z = s (z/r - 1), its integral s (r - z), r = sqrt(z^2 - 1), z = x + iy; mode 1 after Sneddon (1946)."""

    def __init__(self, mode, drop, G, nu, angle=0, uniform=(0, 0, 0), traction=(0, 0)):
        """`uniform`: stress XX, YY, XY whose displacement is added. `traction`: (normal, tangential) traction on
        the crack."""
        self.mode, self.drop, self.G, self.nu, self.uniform = mode, drop, G, nu, uniform
        self.lam = lame(G, nu)
        self.exact_traction = np.array(traction, dtype=float)
        a = math.radians(angle)
        self.tangent, self.normal = np.array([math.cos(a), math.sin(a)]), np.array([-math.sin(a), math.cos(a)])

    def strain(self):
        xx, yy, xy = self.uniform
        mean = self.lam / (2 * (self.lam + self.G)) * (xx + yy)
        return np.array([[xx - mean, xy], [xy, yy - mean]]) / (2 * self.G)

    def displacement(self, points):
        x, y, kappa = points[:, :2] @ self.tangent, points[:, :2] @ self.normal, 3 - 4 * self.nu
        z = x + 1j * y
        r = np.sqrt(z - 1) * np.sqrt(z + 1)
        Z, integral = z / np.where(r == 0, 1, r) - 1, r - z  # u is continuous at the tips, where y Z = 0
        if self.mode == 1:
            u, v = (kappa - 1) / 2 * integral.real - y * Z.imag, (kappa + 1) / 2 * integral.imag - y * Z.real
        else:
            u, v = (kappa + 1) / 2 * integral.imag + y * Z.real, -(kappa - 1) / 2 * integral.real - y * Z.imag
        local = self.drop / (2 * self.G) * (np.outer(u, self.tangent) + np.outer(v, self.normal))
        return local + points[:, :2] @ self.strain()

    def jump_mean(self, corners):
        """Mean of 2 (1 - nu) s/G sqrt(1 - x^2) over each face [face, 2, 2], from its integral; global components."""
        x = np.clip(corners @ self.tangent, -1, 1)
        integral = (x * np.sqrt(1 - x * x) + np.arcsin(x)) / 2
        mean = (integral[:, 1] - integral[:, 0]) / (x[:, 1] - x[:, 0]) * 2 * (1 - self.nu) * self.drop / self.G
        return np.outer(mean, self.normal if self.mode == 1 else self.tangent)

    def traction(self, points):
        """Normal and tangential traction, the latter along `tangent`."""
        return np.tile(self.exact_traction, (len(points), 1))


class Penny:
    """Disc-shaped crack of radius 1 in z = 0 under the pressure p (Sneddon 1946).

    The closed form uses Fabrikant's lengths l1, l2 = (sqrt((r + 1)^2 + z^2) -+ sqrt((r - 1)^2 + z^2))/2."""

    def __init__(self, p, G, nu):
        self.p, self.G, self.nu, self.lam = p, G, nu, lame(G, nu)

    def displacement(self, points):
        x, y, z = points.T
        r, side, z = np.hypot(x, y), np.where(z < 0, -1, 1), np.abs(z)
        far, near = np.hypot(r + 1, z), np.hypot(r - 1, z)
        l1, l2 = (far - near) / 2, (far + near) / 2
        # s q = z: the larger one gives the other
        s, q = np.sqrt(np.maximum(1 - l1**2, 0)), np.sqrt(np.maximum(l2**2 - 1, 0))
        s, q = np.where(s < q, z / np.maximum(q, 1e-300), s), np.where(q < s, z / np.maximum(s, 1e-300), q)
        angle, product = np.arcsin(np.minimum(1 / l2, 1)), np.maximum(far * near, 1e-300)
        radial = -(1 - 2 * self.nu) / 2 * (angle - q / l2**2) + z * s / (l2**2 * product)
        axial = 2 * (1 - self.nu) * (s - z * angle) + z * (angle - q / product)
        return self.p / (math.pi * self.G) * np.stack([radial * x, radial * y, side * axial], axis=1)

    def jump(self, points):
        opening = 4 * (1 - self.nu) * self.p / (math.pi * self.G) * np.sqrt(np.maximum(1 - points[:, 0]**2 - points[:, 1]**2, 0))
        return np.stack([0 * opening, 0 * opening, opening], axis=1)


class Manufactured:
    """Manufactured solution in the unit square or cube with the fracture x_d = 1/2 and normal e_d.

    u = w0 + h c on side -, plus J = j + h (a, b) on side +, with h = x_d - 1/2. c is chosen such that
    sigma(w) n = (lambda_t, -N) on the fracture; a = -grad j_n and b = -lam/(lam + 2G) div j_t give equal
    tractions on both sides. Derivatives use complex steps. In the regime "uniform" all faces slide under a
    uniform traction, which face-wise constant tractions represent exactly."""
    G, lam, friction, stiffness, dilation, gap, closure, normal_stiffness = 1, 1, 0.5, 2, math.tan(0.1), 0.02, 0.1, 5

    def __init__(self, dimension, regime):
        self.dimension, self.regime = dimension, regime

    def law(self, s):
        """N, lambda_t, u^p and the jump (tangential components, normal) at points s [d - 1, n] of the fracture."""
        x, y = s[0], s[1] if len(s) > 1 else 0
        varies = self.regime != "uniform"
        N = 0.6 + 0.2 * np.sin(2 * x + y) * varies
        angle = 0.5 + (x - y / 2) * varies
        direction = np.array([np.cos(angle), np.sin(angle)]) if len(s) > 1 else np.array([1 + 0 * x])
        if self.regime == "mixed":
            behind, beyond = ((np.where(e.real > 0, e, 0)**2)**2 for e in (0.5 - x, x - 0.5))
            ratio, slip = 1 - 8 * behind, 6 * beyond
        elif self.regime == "stick":
            ratio, slip = 0.5 + np.cos(3 * x) / 4, 0 * x
        else:
            ratio, slip = 1 + 0 * x, 0.3 + np.cos(2 * x + y) / 10
        shear, plastic = self.friction * N * ratio * direction, slip * direction
        closing = self.closure * N / (self.closure * self.normal_stiffness + N)
        normal = self.gap + self.dilation * slip - closing
        return N, shear, plastic, np.concatenate([plastic + shear / self.stiffness, [normal]])

    def smooth(self, x):
        """w0 at points x [d, n]."""
        first, y, last = x[0], x[1] if len(x) > 2 else 0, x[-1]
        return 0.1 * np.array([np.sin(2 * first + last + y), np.cos(first - 2 * last + y), np.sin(first + y - last)][:len(x)])

    def displacement(self, points):
        x, d = points[:, :self.dimension].T.astype(complex), self.dimension
        h, s, on = x[-1].real - 0.5, x[:-1], np.concatenate([x[:-1], [0 * x[-1] + 0.5]])
        # [k][i] = du_i/dx_k
        gradient = [self.smooth(on + STEP * 1j * np.eye(d)[k][:, None]).imag / STEP for k in range(d)]
        jumps = [self.law(s + STEP * 1j * np.eye(d - 1)[k][:, None])[3].imag / STEP for k in range(d - 1)]
        N, shear, _, jump = (np.asarray(value).real for value in self.law(s))
        bulk = self.lam * sum(gradient[k][k] for k in range(d)) + 2 * self.G * gradient[-1][-1]
        c = [(shear[i] - self.G * (gradient[-1][i] + gradient[i][-1])) / self.G for i in range(d - 1)]
        c.append((-N - bulk) / (self.lam + 2 * self.G))
        slope = [-jumps[i][-1] for i in range(d - 1)]
        slope.append(-(self.lam * sum(jumps[i][i] for i in range(d - 1)) + self.more(s).real) / (self.lam + 2 * self.G))
        return (self.smooth(x).real + h * np.array(c) + np.where(h > 0, jump + h * np.array(slope), 0)).T

    def more(self, s):
        """Additional compression on side + by fields other than the displacement."""
        return np.zeros(())

    def jump(self, points):
        return np.asarray(self.law(points[:, :self.dimension - 1].T.astype(complex))[3]).real.T

    def traction(self, points):
        """Normal traction, then global tangential components x (and y)."""
        N, shear = (np.asarray(value).real for value in self.law(points[:, :self.dimension - 1].T.astype(complex))[:2])
        return np.concatenate([[-N], shear]).T


class Wavy:
    """Two half planes with the gap 0.01 (1 - cos(2 pi x)), pressed together by the mean pressure pb < p*.

    p* = pi G/(1 - nu) 0.01. They are in contact for |x| < a with sin^2(pi a) = pb/p*. Westergaard (1939);
    Johnson, Contact Mechanics, ch. 13."""
    amplitude = 0.01

    def __init__(self, load, G, nu):
        """`load` = pb/p*."""
        self.load, self.modulus = load, G / (1 - nu)
        self.full = math.pi * self.modulus * self.amplitude
        self.half_width = math.asin(math.sqrt(load)) / math.pi

    def pressure(self, x):
        inside = np.sqrt(np.maximum(self.load - np.sin(math.pi * x)**2, 0))
        return 2 * self.full * np.cos(math.pi * x) * inside

    def pressure_mean(self, a, b):
        """Mean pressure over [a, b] in [0, 1/2], from the integral of the pressure."""
        root = math.sqrt(self.load)
        t = np.clip(np.sin(math.pi * np.stack([a, b])) / root, -1, 1)
        integral = self.full * self.load / math.pi * (t * np.sqrt(1 - t * t) + np.arcsin(t))
        return (integral[1] - integral[0]) / (b - a)

    def opening_mean(self, a, b):
        """Mean normal jump over [a, b] in [0, 1/2]; it is -0.01 (1 - cos(2 pi x)) in the contact zone.

        The Fourier modes of the pressure open the surfaces by 2 p/(k modulus) each."""
        n = 2**15
        x = np.arange(n) / n
        waves = np.fft.rfft(self.pressure(np.minimum(x, 1 - x)))
        k = 2 * math.pi * np.arange(len(waves))
        opening = np.fft.irfft(2 * waves / (self.modulus * np.maximum(k, 1)) * (k > 0), n)
        opening -= opening[0]  # contact at x = 0
        ends = np.append(x, 1)
        primitive = np.append(0, np.cumsum((opening + np.roll(opening, -1)) / 2)) / n
        return (np.interp(b, ends, primitive) - np.interp(a, ends, primitive)) / (b - a)

    def traction(self, points):
        return np.stack([-self.pressure(points[:, 0]), 0 * points[:, 0]], axis=1)
