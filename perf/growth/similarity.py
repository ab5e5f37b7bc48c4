"""Computes the reference values of perf growth: exact.VALUES, the lag of the broken length behind a sharp tip, and the
opening at the end of the process zone.

    python3 -B -m perf.growth.similarity

**Similarity solution in plane strain** (Adachi and Detournay 2002, solved again). With x = distance/length and lubrication
g = -dP/dx = F/W^3, the opening is W(x) = int_0^1 M(x, s) g(s) ds + c sqrt(1 - x^2): the kernel M has no stress intensity, and
the second term is that of the toughness. F follows from the balance of the fluid. Panels of Gauss points halve towards the
well and the tip; near panels are integrated by product rules. Newton's method solves for W.

**Lag.** A semi-infinite crack with linear softening s(w) = T (1 - w/w_c), w_c = 2 G/T, far from all boundaries. At the
distance d behind the tip of the zone, w(d) = 8 K sqrt(d/2 pi)/E' - 4/(pi E') int s ln|(sqrt d + sqrt y)/(sqrt d - sqrt y)| dy
without stress intensity, K = sqrt(2/pi) int s/sqrt(y) dy. Far away this is the opening of a sharp crack whose tip is
2 sqrt(2 pi)/(pi K) int s sqrt(y) dy behind that of the zone; the broken length ends int s/T dy behind it."""
import sys

import numpy as np
from scipy.optimize import brentq

POINTS = 10
NODES, WEIGHTS = np.polynomial.legendre.leggauss(POINTS)
LEGENDRE = np.polynomial.legendre.legvander
TO_COEFFICIENTS = np.linalg.inv(LEGENDRE(NODES, POINTS - 1))


def integrals_to_end(x):
    """Integrals of the Legendre polynomials from x to 1."""
    v = LEGENDRE(x, POINTS)
    orders = np.arange(1, POINTS)
    return np.column_stack([1 - x, (v[:, orders - 1] - v[:, orders + 1]) / (2 * orders + 1)])


def kernel(x, dx, s, ds, apart):
    """M(x, s) with the distances dx, ds from the tip and apart = s - x."""
    a, b = np.sqrt(dx * (1 + x)), np.sqrt(ds * (1 + s))
    difference = np.maximum(np.abs(apart) * (x + s) / (a + b), 1e-300)  # |a - b|
    return 4 / np.pi * (apart * np.log1p(2 * np.minimum(a, b) / difference) - 2 * x * np.log1p(-(dx * b + ds * a) / (a + b)))


class Grid:
    """Panels in s near the well and in d = 1 - s near the tip, in the order of s. Beyond the last panel, functions continue
    as powers of d."""
    kernel = staticmethod(kernel)

    def __init__(self, at_well=14, at_tip=44):
        edges = [0.0, *(0.5 * 2.0**-k for k in range(at_well, -1, -1))]
        self.panels = [(a, b, False) for a, b in zip(edges[:-1], edges[1:])]
        self.panels += [(0.5 * 2.0**-k, 0.5 * 2.0 ** -(k + 1), True) for k in range(at_tip)]
        self.end = self.panels[-1][1]
        s, d = zip(*(self.points(p, NODES) for p in range(len(self.panels))))
        self.s, self.d = np.concatenate(s), np.concatenate(d)
        self.w = np.concatenate([0.5 * abs(b - a) * WEIGHTS for a, b, _ in self.panels])

    def points(self, p, y):
        a, b, at_tip = self.panels[p]
        z = 0.5 * (a + b) + 0.5 * (b - a) * y
        return (1 - z, z) if at_tip else (z, 1 - z)

    @staticmethod
    def slice(p):
        return slice(p * POINTS, (p + 1) * POINTS)

    def integral_to_tip(self):
        """Matrix of f -> int_s^1 f at the nodes, up to the last panel."""
        A = np.zeros((len(self.s), len(self.s)))
        local = integrals_to_end(NODES) @ TO_COEFFICIENTS
        for p, (a, b, _) in enumerate(self.panels):
            A[self.slice(p), self.slice(p)] = 0.5 * abs(b - a) * local
            A[self.slice(p), (p + 1) * POINTS:] = self.w[(p + 1) * POINTS:]
        return A

    def operator(self, power):
        """Matrix of g -> int_0^1 M(x, s) g(s) ds at the nodes; g ~ d^-power beyond the last panel."""
        x, dx = self.s[:, None], self.d[:, None]

        def of(s, d):
            return self.kernel(x, dx, s, d, np.where((dx < 0.5) & (d < 0.5), dx - d, s - x))
        A = of(self.s[None, :], self.d[None, :]) * self.w
        for p in range(len(self.panels)):
            for q in range(max(0, p - 2), min(len(self.panels), p + 3)):
                for i in range(p * POINTS, (p + 1) * POINTS):
                    A[i, self.slice(q)] = self.near(i, q, p)
        m, (v, weights) = round(1 / (1.5 - power)), np.polynomial.legendre.leggauss(20)
        v, weights = 0.5 * (v + 1), 0.5 * weights
        z = self.end * v**m
        A[:, -1] += self.d[-1] ** power * (of(1 - z[None, :], z[None, :]) * z**-power * self.end * m * v ** (m - 1)) @ weights
        return A

    def near(self, i, q, p):
        """Row of node i of panel p for the near panel q: parts that halve towards the node."""
        a, b, at_tip = self.panels[q]
        y0 = min(max(((self.d[i] if at_tip else self.s[i]) - 0.5 * (a + b)) / (0.5 * (b - a)), -1.0), 1.0)
        cuts = [*(2.0**-k for k in range(0, 40, 2)), 0.0]
        parts = [(y0 + (1 - y0) * low, y0 + (1 - y0) * high) for high, low in zip(cuts[:-1], cuts[1:]) if y0 < 1]
        parts += [(y0 - (1 + y0) * high, y0 - (1 + y0) * low) for high, low in zip(cuts[:-1], cuts[1:]) if y0 > -1]
        low, high = np.array(parts).T
        y = (0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * NODES).ravel()
        weights = (0.5 * (high - low)[:, None] * WEIGHTS).ravel() * 0.5 * abs(b - a)
        s, d = self.points(q, y)
        if q == p:  # without cancellation
            apart = 0.5 * (b - a) * (NODES[i - p * POINTS] - y) * (1 if at_tip else -1)
        else:
            apart = np.where((self.d[i] < 0.5) & (d < 0.5), self.d[i] - d, s - self.s[i])
        return (weights * self.kernel(self.s[i], self.d[i], s, d, apart)) @ (LEGENDRE(y, POINTS - 1) @ TO_COEFFICIENTS)


def similarity(toughness, at_tip=44):
    """gamma, omega and pi of exact.py for Kd = `toughness` > 0."""
    grid = Grid(at_tip=at_tip)
    n, tail = len(grid.s), 0.6 * grid.end * (grid.end / grid.d[-1]) ** (2 / 3)  # volume beyond the last panel
    M, D, volume = grid.operator(1.0), grid.integral_to_tip() + np.diag(2 / 3 * grid.s), grid.w.copy()
    D[:, -1] += tail
    volume[-1] += tail
    root, W = np.sqrt(grid.d * (1 + grid.s)), 2 * (grid.d * (1 + grid.s)) ** (2 / 3)
    for _ in range(200):
        c = toughness * (2 * (volume @ W)) ** 0.25 / np.sqrt(2)
        g = D @ W / W**3
        opening = M @ g + c * root
        error = np.max(np.abs(opening / W - 1))
        if error < 1e-11:
            break
        if error > 0.3:  # damped fixed-point iteration
            W = W**0.75 * opening**0.25
            continue
        J = np.eye(n) - M @ (D / (W**3)[:, None] - np.diag(3 * g / W)) - np.outer(root, c / 4 * volume / (volume @ W))
        W = W * np.exp(np.clip(np.linalg.solve(J, opening - W) / W, -0.5, 0.5))
    gamma = (2 * (volume @ W)) ** -0.5
    moments = grid.w * np.arctan2(root, grid.s)  # acos(s), for the pressure at the well
    v, weights = np.polynomial.legendre.leggauss(20)
    z = grid.end * (0.5 * (v + 1)) ** 2
    angle = np.arctan2(np.sqrt(z * (2 - z)), 1 - z)
    moments[-1] += grid.d[-1] * ((angle / z * grid.end * (v + 1)) @ (0.5 * weights))
    return gamma, gamma * W[0], 2 / np.pi * (moments @ g) + c / 4


def lag(n=400):
    """Lag of the broken length and length of the zone, both over 0.8 E' G/T^2, opening at the zone's end over that of a
    sharp crack there, and K. E' = T = w_c = 1 and G = 1/2; piecewise linear tractions."""
    def of_zone(length):
        y = length * (np.arange(n + 1) / n) ** 2
        v, weights = np.polynomial.legendre.leggauss(8)
        root = np.sqrt(length) * (np.arange(n)[:, None] + 0.5 * (v + 1)) / n  # panels are equal in sqrt(y)
        measure = 2 * root * 0.5 * weights * np.sqrt(length) / n
        share = (root**2 - y[:-1, None]) / np.diff(y)[:, None]

        def integrate(f):
            """Row of the integral of f(sqrt(y)) s(y) in the nodal tractions s."""
            row, values = np.zeros(n + 1), f(root) * measure
            row[:-1] += np.sum(values * (1 - share), axis=1)
            row[1:] += np.sum(values * share, axis=1)
            return row
        K = np.sqrt(2 / np.pi) * integrate(lambda r: 1 / r)
        d = np.sqrt(y)
        A = np.array([8 / np.sqrt(2 * np.pi) * at * K - 4 / np.pi * integrate(lambda r, at=at: np.log(np.abs((at + r) / (at - r)))) for at in d])
        s = np.linalg.solve(np.eye(n + 1) + A, np.ones(n + 1))  # s = 1 - w
        return s, K, integrate
    zone = brentq(lambda length: of_zone(length)[0][-1], 0.3, 0.6)  # no traction at its end
    s, K, integrate = of_zone(zone)
    opening = 8 * K @ s * np.sqrt(zone / (2 * np.pi))  # of a sharp crack at the distance of the zone's length
    sharp = 2 * np.sqrt(2 * np.pi) / (np.pi * (K @ s)) * (integrate(lambda r: r) @ s)
    return (integrate(lambda r: np.ones_like(r)) @ s - sharp) / 0.4, zone / 0.4, 1 / opening, K @ s


def main():
    for toughness in (0.25, 0.5, 1, 1.5, 2, 3, 4, 6):
        print(f"Kd {toughness}: gamma, omega, pi", *(f"{value:.7g}" for value in similarity(toughness)))
    for n in (100, 200):
        behind, zone, opening, K = lag(n)
        print(f"{n} panels: lag {behind:.4f} and zone {zone:.4f} over 0.8 E' G/T^2, opening at its end {opening:.4f} of that of a "
              f"sharp crack, K^2/(E' G) = {2 * K**2:.5f}, exact 1")


if __name__ == "__main__":
    sys.exit(main())
