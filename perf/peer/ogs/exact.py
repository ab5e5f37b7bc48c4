"""References of the cases `cross` and `strip`, independent of both programs."""
from math import comb, pi

import numpy as np


def crack_area(E, nu, load, half_length, half_width, half_height, normal_stiffness=np.inf, terms=24):
    """Area of the opening (m) of a horizontal crack in the centre of a plate, plane strain.

    The top has the traction `load` (Pa), the bottom is on rollers, the sides are free. With Muskhelishvili's potentials
    Phi = P/X + Q, Omega = P/X - Q, X = sqrt(z^2 - half_length^2), the crack is free of traction for all polynomials P
    and Q; least squares on the boundary determine their coefficients. A closed vertical fracture of half_length through
    the centre, with this normal stiffness (Pa/m), adds the integral of sigma_xx^2 / (load * stiffness), to first
    order."""
    a, size = half_length, np.hypot(half_width, half_height)
    powers = np.arange(terms)
    # even in x: coefficients are real or imaginary
    unit_p = np.where(powers % 2, 1, 1j)
    unit_q = np.where(powers % 2, 1j, 1)
    mu, kappa = E / (2 * (1 + nu)), 3 - 4 * nu

    def potentials(z):
        """Phi, its derivative, and Omega at conj(z), per coefficient."""
        def p(z):
            return unit_p * (z[:, None] / size)**powers

        def q(z):
            return unit_q * (z[:, None] / size)**powers

        def derivative(values, z):
            return values * powers / z[:, None]

        def root(z):
            return (np.sqrt(z - a) * np.sqrt(z + a))[:, None]
        X, bar = root(z), np.conj(z)
        slope = derivative(p(z), z) / X - p(z) * z[:, None] / X**3
        return (np.hstack([p(z) / X, q(z)]), np.hstack([slope, derivative(q(z), z)]),
                np.hstack([p(bar) / root(bar), -q(bar)]))

    def stresses(z):
        """sigma_yy - i tau, and sigma_xx, per coefficient."""
        phi, slope, omega = potentials(z)
        vertical = phi + omega + (z - np.conj(z))[:, None] * np.conj(slope)
        return vertical, 4 * phi.real - vertical.real

    at = np.cos(pi * (np.arange(8 * terms) + 0.5) / (8 * terms))
    across, up = half_width * at, half_height * at
    top, sideways = stresses(across + 1j * half_height)[0], stresses(half_width + 1j * up)
    foot = across - 1j * half_height
    bottom = stresses(foot)[0]
    phi, slope, omega = potentials(foot)
    settles = (kappa * phi - omega - (foot - np.conj(foot))[:, None] * np.conj(slope)).imag
    closed = np.where(powers % 2, 0, [comb(int(k), int(k) // 2) * (a / 2 / size)**k for k in powers])
    rows = [top.real, top.imag, sideways[1], sideways[0].imag, bottom.imag, settles,
            len(at) * np.hstack([closed, 0 * closed])[None]]
    right = np.concatenate([np.full(len(at), float(load)), np.zeros(sum(map(len, rows)) - len(at))])
    c = np.linalg.lstsq(np.vstack(rows), right, rcond=1e-15)[0]
    area = (kappa + 1) / mu * pi * sum(c[k] * a * comb(k + 1, (k + 1) // 2) * (a / 2 / size)**k / 2
                                       for k in range(1, terms, 2))
    x, weights = np.polynomial.legendre.leggauss(60)
    vertical = np.minimum(stresses(1j * a * (x + 1) / 2)[1] @ c, 0)
    return area + a * weights @ vertical**2 / (load * normal_stiffness)


def layer(poisson):
    """Matrix of d/d(ky) for the amplitudes (mu k u_x, mu k u_y, sigma_yy, tau) of sin, cos, cos, sin(kx)."""
    r, s = poisson / (1 - poisson), (1 - 2 * poisson) / (2 - 2 * poisson)  # lambda/(lambda + 2 mu), mu/(lambda + 2 mu)
    return np.array([[0, 1, 0, 1], [-r, 0, s, 0], [0, 0, 0, -1], [4 * (1 - s), 0, r, 0]])


def opening(k, mu, poisson, height, Kn, Ks):
    """Opening (m) per Pa of the fluid pressure cos(kx) in a fracture between two layers of this height: the lower one
    on rollers, the upper one with constant traction."""
    from scipy.linalg import expm
    if k == 0:
        return 1 / Kn
    if k * height > 12:  # two half-spaces
        return 1 / (Kn + mu * k / (2 * (1 - poisson)))
    below, above = expm(layer(poisson) * k * height)[:, [0, 2]], expm(-layer(poisson) * k * height)[:, :2]
    jump = np.hstack([-below, above])  # of all amplitudes; columns: unknowns at the bottom, then at the top
    zero = np.zeros(2)
    system = np.array([jump[2], jump[3], np.hstack([below[2], zero]) - Kn / (mu * k) * jump[1],
                       np.hstack([below[3], zero]) - Ks / (mu * k) * jump[0]])
    return jump[1] @ np.linalg.solve(system, [0, 0, -1, 0]) / (mu * k)


def strip_volume(n, E, undrained, Kn, Ks, length, height, aperture, before, inlet, dt, steps, viscosity, permeability,
                 storage):
    """Injected volume (m^2) in a fracture of this length (m) after implicit Euler steps, with n finite volumes.

    Elasticity is exact for each cosine of the pressure (Poisson's ratio 0, `undrained` for changes along the fracture).
    The cubic law has the aperture in m. The rock takes water up by diffusion normal to the fracture, with its
    permeability (m^2) and uniaxial storage (1/Pa). Pressures in Pa: `before`, also at the outlet, and `inlet`."""
    h, place = length / n, (np.arange(n) + 0.5) / n
    mode = np.cos(pi * np.outer(place, np.arange(n)))
    elastic = np.array([opening(pi * m / length, E / 2, undrained, height / 2, Kn, Ks) for m in range(n)])
    C = (mode * elastic * np.where(np.arange(n) > 0, 2, 1) / n) @ mode.T
    half = np.cumprod([1, *((j - 1.5) / j for j in range(1, steps + 1))])  # coefficients of (1 - z)^(1/2)
    uptake = 2 * np.sqrt(permeability * storage * dt / viscosity) * half   # both sides
    excess, opened, history = np.zeros(n), np.zeros(n), []
    for _ in range(steps):
        earlier = sum((b * p for b, p in zip(uptake[1:], history[::-1])), np.zeros(n))
        old = opened.copy()
        for iteration in range(40):
            w = aperture + opened
            # apertures at faces, with linear extrapolation to the ends
            mean = np.concatenate([[1.5 * w[0] - 0.5 * w[1]], (w[1:] + w[:-1]) / 2, [1.5 * w[-1] - 0.5 * w[-2]]])
            gap = np.concatenate([[h / 2], np.full(n - 1, h), [h / 2]])
            p = np.concatenate([[inlet - before], excess, [0]])
            conductance = mean**3 / (12 * viscosity * gap)
            flux = conductance * (p[:-1] - p[1:])
            residual = h * (opened - old + uptake[0] * excess + earlier) - dt * (flux[:-1] - flux[1:])
            by_w = np.zeros((n + 1, n))  # derivative of the flux by apertures
            slope = 3 * flux / mean
            inner = np.arange(n - 1)
            by_w[inner + 1, inner] = by_w[inner + 1, inner + 1] = slope[1:-1] / 2
            by_w[0, :2], by_w[n, [n - 1, n - 2]] = slope[0] * np.array([1.5, -0.5]), slope[-1] * np.array([1.5, -0.5])
            by_p = np.zeros((n + 1, n))
            by_p[np.arange(n) + 1, np.arange(n)], by_p[np.arange(n), np.arange(n)] = conductance[1:], -conductance[:-1]
            flows = by_p if iteration < 5 else by_w @ C + by_p  # Newton's method after fixed-point iterations
            matrix = h * (C + uptake[0] * np.eye(n)) - dt * (flows[:-1] - flows[1:])
            change = np.linalg.solve(matrix, -residual)
            excess = np.clip(excess + change, 0, inlet - before)
            opened = C @ excess
            if abs(change).max() < 1e-10 * abs(excess).max():
                break
        history.append(excess)
    return h * opened.sum()
