"""Least squares in scaled parameters, with confidence intervals."""
from dataclasses import dataclass

import numpy as np
from scipy import optimize, stats

STEP = 1e-6  # increment of differences, in scaled parameters
LEVEL = 0.95  # confidence level of the intervals
RANGE = 1e4
AT_BOUND = 1e-8  # relative distance to a bound at which a parameter is at the bound


@dataclass
class Parameter:
    """Fitted parameter.

    A positive parameter without an upper bound, or with a positive lower bound, is fitted by its logarithm, as suits
    stiffnesses and strengths. In this case start / RANGE and start * RANGE replace bounds that are 0 or infinite."""
    name: str
    start: float
    low: float = -np.inf
    high: float = np.inf
    unit: str = ""

    def __post_init__(self):
        self.logarithmic = self.low >= 0 and self.start > 0 and (self.low > 0 or not np.isfinite(self.high))
        if self.logarithmic:
            self.low = self.low or self.start / RANGE
            self.high = self.high if np.isfinite(self.high) else self.start * RANGE
        finite = np.isfinite(self.low) and np.isfinite(self.high)
        self.size = 1.0 if self.logarithmic else self.high - self.low if finite else abs(self.start) or 1.0

    def scaled(self, value):
        with np.errstate(divide="ignore"):
            return np.log(value) if self.logarithmic else value / self.size

    def value(self, scaled):
        return float(np.exp(min(scaled, 700)) if self.logarithmic else scaled * self.size)


@dataclass
class Estimate:
    """Result of a fit. The interval is None for a parameter at a bound, or not determined by the data."""
    values: list
    intervals: list
    why: list  # reason for a missing interval, or None
    correlation: np.ndarray  # of scaled parameters
    residuals: np.ndarray
    evaluations: int


class Residuals:
    """Residuals r(x) in scaled parameters, with a Jacobian by differences. NaN where the model has no state."""

    def __init__(self, model, parameters):
        self.model, self.parameters, self.count, self.last = model, parameters, 0, None

    def __call__(self, x):
        if self.last is None or not np.array_equal(self.last[0], x):
            self.count += 1
            self.last = x.copy(), np.asarray(self.model([p.value(s) for p, s in zip(self.parameters, x)]), dtype=float)
        return self.last[1]

    def jacobian(self, x):
        r, columns = self(x), []
        for k, p in enumerate(self.parameters):
            for sign in (1, -1):
                moved = x.copy()
                moved[k] += sign * STEP
                if not p.scaled(p.low) <= moved[k] <= p.scaled(p.high):
                    continue
                change = (self(moved) - r) / (sign * STEP)
                if np.all(np.isfinite(change)):
                    break
            else:
                raise ArithmeticError(f'"{p.name}": no solution of the model on either side of {p.value(x[k]):.6g}')
            columns.append(change)
        return np.array(columns).T


def covariance(J, residuals):
    """Returns the covariance of scaled parameters, and a mask of parameters that the data do not determine."""
    n, m = J.shape
    norms = np.linalg.norm(J, axis=0)
    blind = norms <= 1e-10 * max(np.max(norms), 1e-300)
    scaled = J / np.where(blind, 1, norms)
    _, s, V = np.linalg.svd(scaled[:, ~blind], full_matrices=False)
    lost = s <= 1e-7 * s[0] if s.size else s
    undetermined = blind.copy()
    if np.any(lost):  # parameters that are part of a combination without effect
        undetermined[~blind] |= np.max(np.abs(V[lost]), axis=0) > 1e-3
    inverse = (V.T / np.where(lost, np.inf, s)**2) @ V
    C = np.zeros((m, m))
    keep = np.ix_(~blind, ~blind)
    C[keep] = inverse / np.outer(norms[~blind], norms[~blind])
    variance = float(residuals @ residuals) / max(n - m, 1)
    return C * variance, undetermined


def fit(model, parameters, maximum=60):
    """Returns the Estimate with the least sum of squares of the residuals model([values]).

    The confidence intervals are those of the linearised model, s^2 (J^T J)^-1 with Student's t, transformed back from
    logarithms."""
    r = Residuals(model, parameters)
    x0 = np.array([p.scaled(p.start) for p in parameters])
    bounds = [[p.scaled(p.low) for p in parameters], [p.scaled(p.high) for p in parameters]]
    room = [1e-9 * max(1.0, abs(s)) for s in x0]
    x0 = np.clip(x0, np.add(bounds[0], room), np.subtract(bounds[1], room))
    found = optimize.least_squares(r, x0, jac=r.jacobian, bounds=bounds, x_scale="jac", xtol=1e-12, ftol=1e-12,
                                   gtol=1e-14, max_nfev=maximum)
    at_bound = np.array([min(abs(s - low), abs(high - s)) <= AT_BOUND * max(1, abs(s))
                         for s, low, high in zip(found.x, *bounds)])
    free = ~at_bound
    C, undetermined = np.zeros((len(parameters),) * 2), np.zeros(len(parameters), bool)
    if np.any(free):
        C[np.ix_(free, free)], undetermined[free] = covariance(found.jac[:, free], found.fun)
    error = np.sqrt(np.diag(C))
    with np.errstate(invalid="ignore", divide="ignore"):
        correlation = C / np.where(np.outer(error, error) > 0, np.outer(error, error), np.nan)
    reach = stats.t.ppf((1 + LEVEL) / 2, max(len(found.fun) - int(np.sum(free)), 1)) * error
    intervals, why = [], []
    for k, p in enumerate(parameters):
        why.append("at its bound" if at_bound[k] else "not determined by the data" if undetermined[k] else None)
        intervals.append(None if why[k] else (p.value(found.x[k] - reach[k]), p.value(found.x[k] + reach[k])))
    return Estimate([p.value(s) for p, s in zip(parameters, found.x)], intervals, why, correlation, found.fun, r.count)
