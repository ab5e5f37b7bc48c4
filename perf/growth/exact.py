"""Fractures of plane strain with a constant rate of injection, without lag: similarity solutions without leak-off, and the
balance of the fluid with leak-off.

    half-length gamma L, opening at the well omega eps L, pressure at the well pi eps E',
    eps = (mu'/(E' t))^(1/3),  L = (E' Q^3 t^4/mu')^(1/6),  mu' = 12 mu,  Kd = K' (E'^3 mu' Q)^(-1/4),
    K' = 4 sqrt(2/pi) K_c,  Q: rate per depth into both wings

similarity.py computes the values."""
import math

import numpy as np
from scipy.optimize import brentq

VALUES = {0.25: (0.6151778, 1.126029, 0.544950), 0.5: (0.6133710, 1.127585, 0.546018), 1: (0.5992533, 1.141554, 0.555835),
          1.5: (0.5677577, 1.181425, 0.585840), 2: (0.5239670, 1.255265, 0.647751), 3: (0.4342653, 1.481781, 0.876781),
          4: (0.3660036, 1.746118, 1.204789), 6: (0.2817473, 2.261364, 2.010820)}  # Kd: gamma, omega, pi
CIRCLES = {0.5: (0.695668, 1.195444), 1: (0.681399, 1.213226), 2: (0.614224, 1.363649), 5: (0.447788, 2.392769)}  # Kd: gamma, omega
VISCOUS_TIP = 2 ** (1 / 3) * 3 ** (5 / 6)  # of w = VISCOUS_TIP (mu' V/E')^(1/3) d^(2/3)


class Fracture:
    """Fracture that has the half-length `length` at the time `end`."""

    def __init__(self, toughness, modulus, energy, length, end):
        """`toughness`: Kd; modulus: E', Pa; energy: G, J/m^2; length in m, end in s."""
        self.gamma, self.omega, self.pi = VALUES[toughness]
        self.modulus, self.end = modulus, end
        self.K = 4 * math.sqrt(2 / math.pi) * math.sqrt(energy * modulus)  # K', Pa m^(1/2)
        product = (self.K / toughness) ** 4 / modulus**3  # mu' Q
        self.rate = ((length / self.gamma) ** 6 * product / modulus) ** 0.25 / end  # m^2/s
        self.viscosity = product / self.rate  # mu', Pa s
        self.speed = 2 * length / (3 * end)

    def scales(self, t):
        return (self.viscosity / (self.modulus * t)) ** (1 / 3), (self.modulus * self.rate**3 * t**4 / self.viscosity) ** (1 / 6)

    def at(self, t):
        """Half-length, m, opening, m, and pressure, Pa, at the well."""
        eps, L = self.scales(t)
        return self.gamma * L, self.omega * eps * L, self.pi * eps * self.modulus

    leak_off = 0.0  # C_L, m/s^0.5

    def time(self, length):
        """Time at which the fracture has this half-length, s."""
        return self.end * (length / (self.gamma * self.scales(self.end)[1])) ** 1.5

    def tip_opening(self, d):
        """Opening at the small distance d from the tip at the end, m: cubes of the asymptotes of toughness and of
        viscosity, added."""
        viscous = VISCOUS_TIP**3 * self.viscosity * self.speed / self.modulus * d**2
        return ((self.K / self.modulus) ** 3 * d**1.5 + viscous) ** (1 / 3)


class Circle:
    """Circular fracture that has the radius `radius` at the time `end`: radius gamma L, opening at the well omega eps L,
    eps = (mu'/(E' t))^(1/3),  L = (E' Q^3 t^4/mu')^(1/9),  Kd = K' (t^2/(mu'^5 Q^3 E'^13))^(1/18) at the end."""

    def __init__(self, toughness, modulus, energy, radius, end):
        """Arguments as of Fracture."""
        self.gamma, self.omega = CIRCLES[toughness]
        self.modulus, self.end, self.radius = modulus, end, radius
        self.K = 4 * math.sqrt(2 / math.pi) * math.sqrt(energy * modulus)
        ratio = (radius / self.gamma) ** 9 / (modulus * end**4)                     # Q^3/mu'
        product = end**2 * (self.K / toughness / modulus) ** 18 * modulus**5        # mu'^5 Q^3
        self.viscosity = (product / ratio) ** (1 / 6)
        self.rate = (ratio * self.viscosity) ** (1 / 3)
        self.power = 9 / 4 if toughness < 2 else 5 / 2  # of t ~ R^power
        self.speed = radius / end / self.power

    def at(self, t):
        """Radius and opening at the well, m, near the end."""
        eps, L = (self.viscosity / (self.modulus * t)) ** (1 / 3), (self.modulus * self.rate**3 * t**4 / self.viscosity) ** (1 / 9)
        return self.gamma * L, self.omega * eps * L

    def time(self, radius):
        return self.end * (radius / self.radius) ** self.power

    tip_opening = Fracture.tip_opening


class Leaking:
    """Fracture under uniform pressure with the leak-off of Carter (1957) and the half-length `length` at the time `end`.

    The balance of the fluid, Q t = V(l) + 4 C_L int sqrt(t - t_0(x)) dx over both wings, is
    s = x^1.5 + 2 int_0^x sqrt(s - s_0(x')) dx' with x = l/l*, s = t/t*, l* = (sqrt(pi) K_c Q/(2 E' C'^2))^2,
    t* = (2 C' l*/Q)^2 and C' = 2 C_L. `reach` is x at the end: leak-off dominates from about 1 on."""

    def __init__(self, reach, modulus, energy, length, end, viscosity=1e-6, n=400):
        self.modulus, self.end, self.viscosity = modulus, end, 12 * viscosity
        self.x, self.s = march(n, reach)
        self.toughness, self.unit, self.time_unit = math.sqrt(energy * modulus), length / reach, end / self.s[-1]
        per_rate = math.sqrt(self.time_unit) / (2 * self.unit)  # C'/Q
        self.rate = math.sqrt(math.pi) * self.toughness / (2 * modulus * per_rate**2 * math.sqrt(self.unit))
        self.leak_off = per_rate * self.rate / 2

    def time(self, length):
        return self.time_unit * float(np.interp(length / self.unit, self.x, self.s))

    def at(self, t):
        """Half-length, m, opening, m, and pressure, Pa, at the well."""
        length = self.unit * float(np.interp(t / self.time_unit, self.s, self.x))
        return length, 4 * self.toughness * math.sqrt(length / math.pi) / self.modulus, self.toughness / math.sqrt(math.pi * length)

    def tip_opening(self, d):
        """Opening at the small distance d from the tip, m."""
        return 4 * math.sqrt(2 / math.pi) * self.toughness / self.modulus * math.sqrt(d)


def march(n, reach):
    """x and s of the balance with leak-off, up to x = `reach`: s_0 linear in each of n panels, roots integrated exactly."""
    x, s = reach * (np.arange(n + 1) / n) ** 2, np.zeros(n + 1)
    for i in range(1, n + 1):
        def surplus(now):
            ages = np.append(now - s[:i], 0.0)
            early, late = np.sqrt(ages[:-1]), np.sqrt(ages[1:])
            return now - x[i] ** 1.5 - 4 / 3 * ((ages[:-1] + early * late + ages[1:]) / (early + late + 1e-300) @ np.diff(x[:i + 1]))
        high = s[i - 1] + 1
        while surplus(high) < 0:
            high *= 2
        s[i] = brentq(surplus, s[i - 1], high, xtol=1e-15, rtol=1e-14)
    return x, s
