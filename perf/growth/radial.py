"""Computes the reference values of circular fractures, exact.CIRCLES.

    python3 -B -m perf.growth.radial

**Circular fracture with a constant rate** (Savitski and Detournay 2002, solved again). With x = distance/radius, radius
gamma L, opening eps L Om and T = ln t, the dimensionless toughness grows as Kd ~ t^(1/9). The balance of the fluid outside
of x, with I = int_x^1 s Om ds, is
    F = gamma^2 I + d(gamma^2 I)/dT + gamma (4/9 gamma + dgamma/dT) x^2 Om,    2 pi gamma^2 I(0) = 1,
lubrication g = F/(x Om^3), and elasticity Om = gamma int M g ds + Kd sqrt(gamma/2) sqrt(1 - x^2) with the kernel M without
stress intensity. Grid as in similarity.py; backward Euler, then BDF2 in T, from a state without rates at Kd = 0.2; Newton's
method. The results of two step lengths are extrapolated."""
import sys

import numpy as np
from scipy.special import elliprd, elliprf

from perf.growth import similarity


class Grid(similarity.Grid):
    @staticmethod
    def kernel(x, dx, s, ds, apart):
        """(8/pi) s^2 M(x, s) by elliptic integrals of Carlson; arguments as in similarity.kernel."""
        x, dx, s, ds, apart = np.broadcast_arrays(x, dx, s, ds, apart)
        large = np.maximum(x, s)
        U, k2 = np.where(x > s, dx * (1 + x), ds * (1 + s)), (np.minimum(x, s) / large) ** 2
        rest = np.maximum(np.abs(apart) * (x + s) / large**2, 1e-290)  # 1 - k2
        arguments = 1 / U - 1, 1 / U + k2 / rest, 1 / U
        rd = elliprd(*arguments) / (3 * np.sqrt(rest))
        return 8 / np.pi * s**2 * np.where(x > s, rd / x, (np.sqrt(rest) * elliprf(*arguments) + k2 * rd) / np.where(s > 0, s, 1))


class Growth:
    def __init__(self, at_tip=44):
        grid = Grid(at_tip=at_tip)
        tail = 2 / 3 * grid.end * (grid.end / grid.d[-1]) ** 0.5
        self.grid, self.M, self.root = grid, grid.operator(1.0), np.sqrt(grid.d * (1 + grid.s))
        self.D, self.volume = grid.integral_to_tip() * grid.s, grid.w * grid.s
        self.D[:, -1] += tail
        self.volume[-1] += tail

    def state(self, om, gamma, Kd, rate, of_volume, of_radius):
        """Om and gamma at which d/dT of gamma^2 I and gamma are `rate` times the value plus the last two arguments."""
        grid, M, D, volume, n = self.grid, self.M, self.D, self.volume, len(om)
        for _ in range(80):
            I, speed = D @ om, 4 / 9 * gamma + rate * gamma + of_radius
            F = gamma**2 * (1 + rate) * I + of_volume + gamma * speed * grid.s**2 * om
            g, cube = F / (grid.s * om**3), grid.s * om**3
            r = np.append(gamma * (M @ g) + Kd * np.sqrt(gamma / 2) * self.root - om, 2 * np.pi * gamma**2 * (volume @ om) - 1)
            if max(np.max(np.abs(r[:-1] / om)), abs(r[-1])) < 1e-10:
                return om, gamma
            J = np.zeros((n + 1, n + 1))
            J[:n, :n] = gamma * M @ ((gamma**2 * (1 + rate) * D + np.diag(gamma * speed * grid.s**2)) / cube[:, None] - np.diag(3 * g / om)) - np.eye(n)
            slope = 2 * gamma * (1 + rate) * I + (speed + gamma * (4 / 9 + rate)) * grid.s**2 * om  # dF/dgamma
            J[:n, n] = M @ g + gamma * (M @ (slope / cube)) + Kd / 4 * np.sqrt(2 / gamma) * self.root
            J[n, :n], J[n, n] = 2 * np.pi * gamma**2 * volume, 4 * np.pi * gamma * (volume @ om)
            step = np.linalg.solve(J, -r)
            part = min(1.0, 0.3 / max(np.max(np.abs(step[:-1] / om)), abs(step[-1] / gamma)))
            om, gamma = om + part * step[:-1], gamma + part * step[-1]
        raise RuntimeError(f"no solution at Kd = {Kd}")

    def march(self, step, values):
        """gamma and omega at increasing values of Kd, by steps of about this length in T."""
        grid = self.grid
        om, gamma, T = 1.2 * (grid.d * (1 + grid.s)) ** (2 / 3), 0.7, 9 * np.log(0.2)
        om, gamma = self.state(om, gamma, 0.2, 0.0, 0.0, 0.0)
        past, found, last = [(gamma**2 * (self.D @ om), gamma)], [], None
        for value in values:
            n = max(1, int(np.ceil((9 * np.log(value) - T) / step - 1e-9)))
            h = (9 * np.log(value) - T) / n
            for _ in range(n):
                a, b, c = 1.0, -1.0, 0.0
                if len(past) > 1:
                    q = h / last
                    a, b, c = (1 + 2 * q) / (1 + q), -(1 + q), q**2 / (1 + q)
                T, last = T + h, h
                rates = [(b * one + c * other) / h for one, other in zip(past[0], past[-1])]
                om, gamma = self.state(om, gamma, np.exp(T / 9), a / h, *rates)
                past = [(gamma**2 * (self.D @ om), gamma), past[0]]
            polynomial = similarity.TO_COEFFICIENTS @ om[:similarity.POINTS]
            found.append((gamma, float(similarity.LEGENDRE(np.array([-1.0]), similarity.POINTS - 1)[0] @ polynomial)))
        return np.array(found)


def circles(values, at_tip=44, step=0.4):
    """gamma and omega of exact.Circle at increasing values of Kd above 0.2."""
    growth = Growth(at_tip)
    coarse, fine = (growth.march(h, values) for h in (2 * step, step))
    return fine + (fine - coarse) / 3


def main():
    values = (0.5, 1, 2, 5)
    for toughness, (gamma, omega) in zip(values, circles(values)):
        print(f"Kd {toughness}: gamma, omega {gamma:.6f} {omega:.6f}")


if __name__ == "__main__":
    sys.exit(main())
