"""Exact pressures and flows of the flow cases, as functions of arrays of points, independent of the program.

Solutions have `pressure` and Darcy `velocity` [point, d] in the rock; in fractures `pressure_in` and `flow_in`
[point, d], the flow through the whole aperture: transmissivity times negative pressure gradient.
kappa = permeability/viscosity."""
import numpy as np

STEP = 1e-20  # complex step for derivatives without cancellation


def root(z):
    """sqrt(z^2 - 1) with the branch cut [-1, 1]."""
    return np.sqrt(z - 1) * np.sqrt(z + 1)


class Potential:
    """Pressure Re w(z), z = x + iy, kappa = 1; its gradient is the conjugate of w'."""

    def pressure(self, points):
        return self.potential(points @ (1, 1j))[0].real

    def velocity(self, points):
        slope = self.potential(points @ (1, 1j))[1]
        return np.stack([-slope.real, slope.imag], axis=1)


class Conductor(Potential):
    """Fracture |x| < 1, y = 0 of transmissivity T0 sqrt(1 - x^2), with the pressure -x far away.

    The pressure along the fracture is -(1 - B) x with B = T0/(T0 + 2), which balances the inflow from both
    sides."""
    scale = 1  # scale of pressures in the fracture, which may almost vanish

    def __init__(self, T0):
        self.T0, self.share = T0, 2 / (T0 + 2)  # 1 - B without cancellation

    @property
    def flow_at_centre(self):
        return self.T0 * self.share

    def potential(self, z):
        r, B = root(z), 1 - self.share
        return -self.share * z - B * r, -self.share - B * z / r

    def pressure_in(self, points):
        return -self.share * points[:, 0]

    def flow_in(self, points):
        along = self.flow_at_centre * np.sqrt(np.maximum(1 - points[:, 0]**2, 0))
        return np.stack([along, 0 * along], axis=1)


class Barrier(Potential):
    """Fracture |x| < 1, y = 0 of normal conductance c0/sqrt(1 - x^2), with the pressure -y far away.

    The part beta = 1/(1 + 2 c0) of the flow passes around the fracture; the rest is a uniform leakage."""

    def __init__(self, c0):
        self.leakage = 2 * c0 / (1 + 2 * c0)

    def potential(self, z):
        r, beta = root(z), 1 - self.leakage
        return 1j * (self.leakage * z + beta * r), 1j * (self.leakage + beta * z / r)

    def jump(self, points):
        """Pressure jump p+ - p-."""
        return -2 * (1 - self.leakage) * np.sqrt(np.maximum(1 - points[:, 0]**2, 0))


class Linear:
    """Pressure 1 + G.x with fractures of transmissivity T, kappa = 1; `normals` has a fracture normal per point."""

    def __init__(self, G):
        self.G = np.array(G, dtype=float)

    def pressure(self, points):
        return 1 + points @ self.G

    pressure_in = pressure

    def velocity(self, points):
        return np.tile(-self.G, (len(points), 1))

    def flow_in(self, normals, T):
        return -T[:, None] * (self.G - (normals @ self.G)[:, None] * normals)


class Manufactured:
    """Manufactured solution in the unit square or cube with the fracture x_d = 1/2 and the pressure f in the
    fracture.

    The inflow g from each side requires a pressure difference g/C with a normal resistance, else none. With
    h = x_d - 1/2, the pressure in the rock is (f + g/C) cos 2h +- g/(2 kappa) sin 2h, + on side +. Derivatives
    use complex steps."""
    kappa = 2

    def __init__(self, dimension, resists):
        self.dimension, self.resists = dimension, resists

    def on(self, s):
        """f, g-, g+, T and C at points s [d - 1, n]."""
        x, y = s[0], s[1] if len(s) > 1 else 0
        return 1 + np.sin(2 * x + y), 0.5 + np.cos(x + 2 * y), np.sin(3 * x - y) - 0.3, 2 + x, 4 + 2 * x

    def at(self, x):
        """Pressure at points x [d, n], complex."""
        f, below, above, _, C = self.on(x[:-1])
        h = x[-1] - 0.5
        g = np.where(h.real > 0, above, below)
        return (f + g / C * self.resists) * np.cos(2 * h) + np.where(h.real > 0, 1, -1) * g / (2 * self.kappa) * np.sin(2 * h)

    def pressure(self, points):
        return self.at(points.T.astype(complex)).real

    def slopes(self, function, points, directions):
        x = points.T.astype(complex)
        return np.stack([function(x + STEP * 1j * np.eye(self.dimension)[k][:, None]).imag / STEP for k in directions], axis=1)

    def velocity(self, points):
        return -self.kappa * self.slopes(self.at, points, range(self.dimension))

    def pressure_in(self, points):
        return self.on(points.T[:-1])[0]

    def flow_in(self, points):
        along = -self.on(points.T[:-1])[3][:, None] * self.slopes(lambda x: self.on(x[:-1])[0], points, range(self.dimension - 1))
        return np.pad(along, ((0, 0), (0, 1)))
