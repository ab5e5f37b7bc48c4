"""Similarity solutions of a fracture of plane strain with a constant rate of injection, without leak-off and lag.

    half-length gamma L, opening at the well omega eps L, pressure at the well pi eps E',
    eps = (mu'/(E' t))^(1/3),  L = (E' Q^3 t^4/mu')^(1/6),  mu' = 12 mu,  Kd = K' (E'^3 mu' Q)^(-1/4),
    K' = 4 sqrt(2/pi) K_c,  Q: rate per depth into both wings

The values were computed by collocation of the elasticity integral with the lubrication equation on graded panels; two
grids differ by less than 1e-6 (formulation: Adachi and Detournay 2002)."""
import math

VALUES = {0.25: (0.6151778, 1.126029, 0.544950), 0.5: (0.6133710, 1.127585, 0.546018), 1: (0.5992533, 1.141554, 0.555835),
          1.5: (0.5677577, 1.181425, 0.585840), 2: (0.5239670, 1.255265, 0.647751), 3: (0.4342653, 1.481781, 0.876781),
          4: (0.3660036, 1.746118, 1.204789), 6: (0.2817473, 2.261364, 2.010820)}  # Kd: gamma, omega, pi
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

    def at(self, t):
        """Half-length, m, opening, m, and pressure, Pa, at the well."""
        eps, L = (self.viscosity / (self.modulus * t)) ** (1 / 3), (self.modulus * self.rate**3 * t**4 / self.viscosity) ** (1 / 6)
        return self.gamma * L, self.omega * eps * L, self.pi * eps * self.modulus

    def tip_opening(self, d):
        """Opening at the small distance d from the tip at the end, m: cubes of the asymptotes of toughness and of
        viscosity, added."""
        viscous = VISCOUS_TIP**3 * self.viscosity * self.speed / self.modulus * d**2
        return ((self.K / self.modulus) ** 3 * d**1.5 + viscous) ** (1 / 3)
