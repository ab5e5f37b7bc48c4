"""Explicit quasi-dynamic solutions of faults with rate-and-state friction: a spring slider and a line fault in a whole
space by the boundary integral method. The adaptive Runge-Kutta method of order 5(4) of SciPy (Dormand and Prince 1980)
integrates slip and state; the slip rate solves

    tau = N a asinh(V/(2 V0) exp(psi/a)) + eta V,   psi = f0 + b ln(V0 theta/L)

at each point (Rice, Lapusta and Ranjith 2001). The state follows the ageing law or the slip law of Ruina (1983)."""
from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.integrate import RK45
from scipy.special import erfc

SEISMIC = 1e-3  # m/s, slip rate of an event


@dataclass
class Friction:
    """Rate-and-state friction with radiation damping. `damping` is eta = G/(2 c_s), Pa s/m."""
    a: float
    b: float
    L: float
    damping: float
    f0: float = 0.6
    V0: float = 1e-6
    law: str = "ageing"

    def rate(self, shear, N, psi):
        """Slip rate for the shear traction `shear` >= 0. With q = asinh(V/(2 V0) exp(psi/a)), the equation
        a N q + eta 2 V0 exp(-psi/a) sinh(q) = shear is convex: Newton's method converges from above."""
        shear, N, psi = np.broadcast_arrays(shear, N, psi)
        scale = 2 * self.V0 * np.exp(-psi / self.a)
        direct, damped = self.a * N, self.damping * scale
        q = np.minimum(shear / direct, np.arcsinh(shear / damped))
        for _ in range(50):
            change = (direct * q + damped * np.sinh(q) - shear) / (direct + damped * np.cosh(q))
            q = q - change
            if np.all(np.abs(change) <= 1e-13 * (1 + np.abs(q))):
                break
        return scale * np.sinh(q)

    def state_rate(self, V, psi):
        """Rate of psi."""
        if self.law == "ageing":
            return self.b * self.V0 / self.L * (np.exp((self.f0 - psi) / self.b) - V / self.V0)
        return -self.b * V / self.L * (np.log(V / self.V0) + (psi - self.f0) / self.b)

    def state(self, shear, N, V):
        """State psi at which the slip rate under these tractions is V."""
        q = (shear - self.damping * V) / (self.a * N)
        return self.a * (q + np.log1p(-np.exp(-2 * q)) - np.log(V / self.V0))

    def steady_state(self, V):
        return self.f0 - self.b * np.log(V / self.V0)

    def strength(self, N, V, psi):
        """Shear traction at the slip rate V."""
        return self.a * N * np.arcsinh(V / (2 * self.V0) * np.exp(psi / self.a)) + self.damping * V


class SpringSlider:
    """A block on a spring of the stiffness `stiffness` (Pa/m), loaded at the rate `loading` (m/s) under the constant
    compression N. It starts with the state of steady slip at the loading rate, sliding 1.1 times as fast."""

    def __init__(self, friction, N, stiffness, loading):
        self.friction, self.N, self.stiffness, self.loading = friction, N, stiffness, loading
        psi = friction.steady_state(loading)
        self.shear = friction.strength(N, 1.1 * loading, psi)
        self.start = np.array([0.0, psi])
        self.scale = np.array([friction.L, friction.b])  # of slip and state

    def slip_rate(self, t, y):
        return self.friction.rate(self.shear + self.stiffness * (self.loading * t - y[0]), self.N, y[1])

    def __call__(self, t, y):
        V = self.slip_rate(t, y)
        return np.array([float(V), float(self.friction.state_rate(V, y[1]))])


class Line:
    """A plane fault of `n` points with the spacing h in an elastic whole space, antiplane with the shear modulus G or
    in plane strain with G/(1 - nu). Beside the fault there is no slip.

    The traction -(G/2) |k| of the slip is a convolution with the weights of the band-limited operator. With zeros
    beside the fault, the circular convolution has no periodic images."""

    def __init__(self, friction, n, h, modulus, shear, N, rate, pressure=lambda z, t: 0):
        self.friction, self.shear, self.N, self.pressure, self.n = friction, shear, N, pressure, n
        self.z = (np.arange(n) - (n - 1) / 2) * h
        size = next_fast_len(2 * n, real=True)
        offset = np.arange(size)
        offset = np.minimum(offset, size - offset)
        weights = np.where(offset == 0, np.pi / 2, ((-1.0) ** offset - 1) / (np.pi * np.maximum(offset, 1) ** 2))
        self.kernel = rfft(-modulus / (2 * h) * weights)
        self.size = size
        psi = friction.state(shear, N, rate) + np.zeros(n)
        self.start = np.concatenate([np.zeros(n), psi])
        self.scale = np.repeat([friction.L, friction.b], n)

    def traction(self, slip):
        """Shear traction of the fault."""
        return self.shear + irfft(self.kernel * rfft(slip, self.size), self.size)[:self.n]

    def slip_rate(self, t, y):
        return self.friction.rate(self.traction(y[:self.n]), self.N - self.pressure(self.z, t), y[self.n:])

    def __call__(self, t, y):
        V = self.slip_rate(t, y)
        return np.concatenate([V, self.friction.state_rate(V, y[self.n:])])


@dataclass
class Solution:
    states: np.ndarray  # at the requested times
    onsets: list        # times at which the largest slip rate exceeds that of an event
    largest: float      # slip rate
    steps: int
    rejected: int


def solve(system, times, tolerance, first_step=None, seismic=SEISMIC):
    """Integrates to the last of the times, with the local error `tolerance` relative to the system's scales of slip and
    state. The largest slip rate is that of the ends of the steps; `seismic` is that of an event."""
    method = RK45(system, 0.0, system.start, times[-1], rtol=tolerance, atol=tolerance * system.scale,
                  first_step=first_step)
    states, onsets, steps, fast, largest = [], [], 0, False, 0.0
    while method.status == "running":
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):  # in rejected stages
            message = method.step()
        if method.status == "failed":
            raise ArithmeticError(f"the reference fails at t = {method.t:g}: {message}")
        steps += 1
        between = method.dense_output()
        while len(states) < len(times) and times[len(states)] <= method.t:
            states.append(between(times[len(states)]))
        rate = np.max(system.slip_rate(method.t, method.y))
        largest = max(largest, rate)
        if rate > seismic and not fast:
            onsets.append(crossing(system, between, method.t_old, method.t, seismic))
        fast = rate > (seismic / 10 if fast else seismic)
    return Solution(np.array(states), onsets, float(largest), steps, (method.nfev - 2) // 6 - steps)


def crossing(system, between, low, high, seismic):
    """Time in the step at which the largest slip rate passes `seismic`, by bisection."""
    while high - low > 1e-14 * high:
        middle = (low + high) / 2
        if middle in (low, high):
            break
        below = np.max(system.slip_rate(middle, between(middle))) < seismic
        low, high = (middle, high) if below else (low, middle)
    return high


# Problems

STIFFNESS = 0.005 * 50e6 / 1e-5  # Pa/m, critical stiffness (b - a) N/L of the spring slider
PLATE_RATE = 1e-9                # m/s


def spring_slider(law, ratio):
    """Spring slider of the examples of GEOS, with the stiffness `ratio` times the critical one."""
    friction = Friction(a=0.01, b=0.015, L=1e-5, damping=4.41e6, law=law)
    return SpringSlider(friction, 50e6, ratio * STIFFNESS, PLATE_RATE)


@dataclass
class Injection:
    """Fluid that enters a fault at its centre at a constant rate until `stop`, and diffuses along it."""
    rate: float = 1.25e-6     # m/s
    stop: float = 100 * 86400.0
    diffusivity: float = 0.1  # m^2/s
    compressibility: float = 1e-8  # 1/Pa
    porosity: float = 0.1

    def pressure(self, z, t):
        """Superposition of rate/(beta phi sqrt(alpha)) G, G = sqrt(t) (exp(-x^2)/sqrt(pi) - |x| erfc|x|),
        x = z/sqrt(4 alpha t)."""
        factor = self.rate / (self.compressibility * self.porosity * np.sqrt(self.diffusivity))
        return factor * (self.since(z, t) - self.since(z, t - self.stop))

    def since(self, z, t):
        if t <= 0:
            return np.zeros_like(z)
        x = np.abs(z) / np.sqrt(4 * self.diffusivity * t)
        return np.sqrt(t) * (np.exp(-x**2) / np.sqrt(np.pi) - x * erfc(x))


SHEAR_MODULUS = 2670 * 3464.0**2  # Pa, of density and speed of shear waves


def bp6(h=50.0, half_length=20e3):
    """Problem BP6-QD-A of the code comparison of SCEC: aseismic slip by injection into a velocity-strengthening fault,
    with points at the multiples of h."""
    n = 2 * round(half_length / h) + 1
    friction = Friction(a=0.007, b=0.005, L=4e-3, damping=SHEAR_MODULUS / (2 * 3464))
    return Line(friction, n, h, SHEAR_MODULUS, 29.2e6, 50e6, 1e-12, Injection().pressure)
