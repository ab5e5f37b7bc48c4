"""Exact solutions of rock and fractures with heat, independent of the program."""
import numpy as np

from perf.verification import exact, flow_exact


class Sliding(flow_exact.Manufactured, exact.Manufactured):
    """Manufactured solution at t = 1 in the unit square or cube; the fracture x_d = 1/2 slides and opens.

    The normal traction is N = t N_1, the slip s = t s_1 along m, the dilation tan theta s. Pressures are those
    of flow_exact.Manufactured without resistance, times t. Fluid with the volumetric heat capacity
    c = `carried` enters the fracture from below and leaves it above.

    The fracture temperature is 3 + t (2 + sin(2x - y)); the adjacent rock is warmer by e. H = 2 k_f/a_0 is the
    conductance of half of the fracture, c g the heat capacity flux through its side. From a side with inflow
    the fracture receives (H + c g) e, else H e. The rock of an outflow side loses (H - c g) e. Below, e is
    given; above, it follows from the heat balance of the fracture:

        sum = c_f a dT/dt + c q.grad T - div(a_0 k_f grad T) - (friction - tan theta) N ds/dt

    In the rock, temperatures vary like the pressures."""
    alpha, porosity, expansion, start = 0.5, 0.1, 0.05, 3
    conductivity, filling, in_fracture, tangent = 3, 1, 2, 0.2

    def __init__(self, dimension, carried):
        super().__init__(dimension, False)
        self.carried = carried

    def on(self, s):
        x, y = s[0], s[1] if len(s) > 1 else 0
        f, _, _, _, C = super().on(s)
        return f, 1.5 + np.cos(x + 2 * y), np.sin(3 * x - y) - 2, self.aperture(s)**3 / 6, C

    def aperture(self, s):
        return 1 + self.tangent * self.slip(s)

    def slip(self, s):
        return 0.8 + np.cos(2 * s[0] + (s[1] if len(s) > 1 else 0)) / 5

    def contact(self, s):
        """Normal compression N and the direction of sliding."""
        x, y = s[0], s[1] if len(s) > 1 else 0
        angle = 0.5 + x - y / 2
        return 0.6 + 0.2 * np.sin(2 * x + y), np.array([np.cos(angle), np.sin(angle)]) if len(s) > 1 else np.array([1 + 0 * x])

    def warm(self, s):
        return 2 + np.sin(2 * s[0] - (s[1] if len(s) > 1 else 0))

    def excess(self, s):
        """Excess temperature of the rock below and above over the fracture."""
        f, below, _, T, _ = self.on(s)
        through, y = 2 * self.in_fracture, s[1] if len(s) > 1 else 0
        first, waves = (1 + s[0]) / 2, np.sin(2 * s[0] - y)
        along = 2 * np.cos(2 * s[0] + y) * 2 * np.cos(2 * s[0] - y) - (np.cos(2 * s[0] + y) * np.cos(2 * s[0] - y) if len(s) > 1 else 0)
        power = (self.friction - self.tangent) * self.contact(s)[0] * self.slip(s)
        needs = self.filling * self.aperture(s) * self.warm(s) - self.carried * T * along + self.in_fracture * (len(s) + 3) * waves
        return first, (needs - power - (through + self.carried * below) * first) / through

    def temperature(self, points):
        s, h = points.T[:-1], points[:, -1] - 0.5
        (below, above), entering, through = self.excess(s), self.on(s)[2], 2 * self.in_fracture
        excess, leaves = np.where(h > 0, above, below), np.where(h > 0, (through - self.carried * entering) * above, -through * below)
        return self.start + (self.warm(s) + excess) * np.cos(2 * h) + leaves / (2 * self.conductivity) * np.sin(2 * h)

    def temperature_in(self, points):
        return self.start + self.warm(points.T[:-1])

    def stress_by(self, T):
        return (3 * self.lam + 2 * self.G) * self.expansion * T

    def law(self, s):
        """Terms of exact.Manufactured; N is reduced by the pressure and the thermal stress of the rock below."""
        N, along = self.contact(s)
        shear, slip = self.friction * N * along, self.slip(s)
        push = N + (1 - self.alpha) * self.on(s)[0] - self.stress_by(self.warm(s) + self.excess(s)[0])
        return push, shear, slip * along, np.concatenate([slip * along + shear / self.stiffness, [self.tangent * slip]])

    def more(self, s):
        below, above = self.excess(s)
        return self.stress_by(below - above)

    def traction(self, points):
        """Contact traction."""
        s = points[:, :-1].T
        N, along = self.contact(s)
        return np.concatenate([[-N], self.friction * N * along]).T


class SlidingInTime:
    """Uniform solution at t = 1/2 in a block of height 1 with a sliding fracture.

    Under the compression N the slip is s = (1 - cos 2t)/4, the opening `tangent` s, the pressure sin 3t.
    Friction heats the fracture, c a dT/dt = (friction - tangent) N ds/dt with a = a_0 + tangent s; a source
    heats the rock at the same rate. The top moves by s tangentially and, in normal direction, such that N stays
    constant."""
    friction, N, tangent, a_0, c, start = 0.6, 2.0, 0.2, 0.5, 1.0, 3.0
    alpha, expansion, fluid_expansion, stored, porosity = 0.5, 0.05, 0.1, 0.5, 0.1
    slip, pressure = (1 - np.cos(1)) / 4, np.sin(1.5)

    @property
    def rise(self):
        """Temperature rise divided by ln(a/a_0)."""
        return (self.friction - self.tangent) * self.N / (self.c * self.tangent)

    @property
    def opening(self):
        return self.tangent * self.slip

    @property
    def warmth(self):
        return self.rise * np.log(1 + self.opening / self.a_0)
