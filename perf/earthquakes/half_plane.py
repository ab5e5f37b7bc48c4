"""Explicit quasi-dynamic solution of a plane fault in an elastic half-plane y < 0 in plane strain or antiplane strain, by
the boundary integral method with constant slip in each cell. Cells and loading are those of problems BP1-QD and BP3-QD.

An edge dislocation at w in the whole plane has the complex potentials (Muskhelishvili 1953)
    phi_0 = A ln(z - w),  psi_0 = conj(A) ln(z - w) - A conj(w)/(z - w),  A = G b/(i pi (kappa + 1)),  kappa = 3 - 4 nu
The free surface adds, with f*(z) = conj(f(conj z)),
    phi_1 = -z phi_0*' - psi_0*,  psi_1 = -phi_0* - z phi_1'
Stresses: sigma_xx + sigma_yy = 4 Re phi', sigma_yy - sigma_xx + 2 i sigma_xy = 2 (conj(z) phi'' + psi')."""
import numpy as np

from perf.earthquakes.reference import Friction

DENSITY, SHEAR_SPEED, POISSON = 2670.0, 3464.0, 0.25
SHEAR_MODULUS = DENSITY * SHEAR_SPEED**2
COMPRESSION, PLATE_RATE = 50e6, 1e-9  # Pa, m/s
WEAK, STRONG = 0.010, 0.025           # a above 15 km and below 18 km
TURN, STRENGTHENING, LOCKED = 15e3, 18e3, 40e3  # m, down the fault


def stress(z, w, b, modulus, nu, surface=True):
    """Stresses (xx, yy, xy) at z of a dislocation at w with the Burgers vector b, a complex number. With b = 1 and in
    the whole plane, sigma_xy = G/(2 pi (1 - nu) x) on the x-axis."""
    A = modulus * b / (1j * np.pi * 4 * (1 - nu))
    B, wc = np.conj(A), np.conj(w)
    r = z - w
    d_phi, dd_phi = A / r, -A / r**2
    d_psi = B / r + A * wc / r**2
    if surface:
        q = z - wc  # phi_0*' = B/q, psi_0* = A ln q - B w/q
        d_phi1 = -B / q + z * B / q**2 - A / q - B * w / q**2
        dd_phi1 = B / q**2 + B / q**2 - 2 * z * B / q**3 + A / q**2 + 2 * B * w / q**3
        d_phi, dd_phi, d_psi = d_phi + d_phi1, dd_phi + dd_phi1, d_psi - B / q - d_phi1 - z * dd_phi1
    total, difference = 4 * d_phi.real, 2 * (np.conj(z) * dd_phi + d_psi)
    return (total - difference.real) / 2, (total + difference.real) / 2, difference.imag / 2


def tractions(points, places, dip, modulus, nu):
    """Shear traction along the dip and normal traction, tension positive, at the distances `places` from the surface, of
    reverse slip by 1 in each cell between the distances `points`. [place, cell]"""
    up = np.exp(1j * dip)
    ends = np.where(points == 0, -1e-9j, -points * up)  # a dislocation at the surface has no stress
    z, w = np.meshgrid(-places * up, ends, indexing="ij")
    xx, yy, xy = stress(z, w, up, modulus, nu)
    normal = 1j * up
    ux, uy, nx, ny = up.real, up.imag, normal.real, normal.imag
    tau = xx * ux * nx + yy * uy * ny + xy * (ux * ny + uy * nx)
    sigma = xx * nx * nx + yy * ny * ny + 2 * xy * nx * ny
    return tuple(of[:, :-1] - of[:, 1:] for of in (tau, sigma))


def antiplane(points, places, modulus, far=None):
    """The same for slip along the strike of a vertical fault. A screw dislocation at w has the stress G/(2 pi (z - w)),
    and a mirror image above the surface. `far`: in a box with this depth and this distance of the sides. The sides have
    no displacement and the bottom no traction. Images aside add up to G coth(pi (z - w)/(2 far))/(4 far); those below
    and above follow at multiples of 2 far and decrease like exp(-2 pi m)."""
    z, w = np.meshgrid(places, points, indexing="ij")
    if far is None:
        of = modulus / (2 * np.pi) * (1 / (z - w) - 1 / (z + w))
    else:
        scale, away = np.pi / (2 * far), np.arange(-4, 5)[:, None, None] * np.pi
        of = modulus / (4 * far) * (1 / np.tanh(scale * (z - w) + away) - 1 / np.tanh(scale * (z + w) + away)).sum(axis=0)
    return of[:, 1:] - of[:, :-1], np.zeros((1, len(points) - 1))


class Fault:
    """Fault that reaches the surface and slips at the plate rate below its cells. `of_shear` and `of_normal` are the
    tractions of slip by 1 in each cell. Unknowns: slip and psi of the cells."""

    def __init__(self, friction, of_shear, of_normal, shear, N, rate):
        self.friction, self.shear, self.N, self.rate = friction, shear, N, rate
        self.of_shear, self.of_normal = of_shear, of_normal
        self.n = n = of_shear.shape[1]
        self.start = np.concatenate([np.zeros(n), friction.state(shear, N, rate) + np.zeros(n)])
        self.scale = np.concatenate([np.full(n, friction.L), np.full(n, friction.b)])

    def slip_rate(self, t, y):
        lag = y[:self.n] - self.rate * t
        return self.friction.rate(self.shear + self.of_shear @ lag, self.N - self.of_normal @ lag, y[self.n:])

    def __call__(self, t, y):
        V = self.slip_rate(t, y)
        return np.concatenate([V, self.friction.state_rate(V, y[self.n:])])


def cells_to(depth, size, growth):
    """Ends of cells of this size down to 18 km, which grow below and end at `depth`. Creep below 18 km loads the locked
    part: with cells that grow by 1.1, all events are too early."""
    steps = size * growth ** np.arange(1, 1 + round(np.log(1 + (depth - STRENGTHENING) / size * (growth - 1)) / np.log(growth)))
    deep = STRENGTHENING + np.cumsum(steps) * (depth - STRENGTHENING) / np.sum(steps)
    return np.concatenate([np.linspace(0, STRENGTHENING, round(STRENGTHENING / size) + 1), deep])


def locked(points, of_shear, of_normal, L=0.008):
    """The fault of problems BP1-QD and BP3-QD."""
    a = np.interp((points[1:] + points[:-1]) / 2, [TURN, STRENGTHENING], [WEAK, STRONG])
    friction = Friction(a, b=0.015, L=L, damping=SHEAR_MODULUS / (2 * SHEAR_SPEED))
    steady = Friction(STRONG, friction.b, friction.L, friction.damping)
    shear = steady.strength(COMPRESSION, PLATE_RATE, steady.steady_state(PLATE_RATE))
    return Fault(friction, of_shear, of_normal, shear, COMPRESSION, PLATE_RATE)


def bp1(size=100.0, growth=1.01, L=0.008, far=None):
    """Problem BP1-QD, a vertical fault in antiplane strain, with this state evolution distance, in a box with `far`."""
    points = cells_to(LOCKED, size, growth)
    return locked(points, *antiplane(points, (points[1:] + points[:-1]) / 2, SHEAR_MODULUS, far), L=L)


def bp3(size=100.0, dip=np.pi / 3, growth=1.01):
    """Problem BP3-QD, thrust."""
    points = cells_to(LOCKED, size, growth)
    return locked(points, *tractions(points, (points[1:] + points[:-1]) / 2, dip, SHEAR_MODULUS, POISSON))
