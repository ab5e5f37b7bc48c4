"""Distributions of fracture sizes: radii of discs in 3D, lengths of traces in 2D."""
import numpy as np

POINTS = 20001  # of a table


class SizeLaw:
    """Distribution between two limits, as a table of its density per logarithm of the size."""

    def __init__(self, logs, density):
        self.logs, self.density = logs, density
        share = np.concatenate([[0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
        self.share = share / share[-1]

    @property
    def sizes(self):
        return np.exp(self.logs)

    def draw(self, uniform):
        """Returns the sizes at uniform numbers in [0, 1)."""
        return np.exp(np.interp(uniform, self.share, self.logs))

    def weighted(self, weight):
        """Returns the distribution with a density proportional to the density times `weight` of the sizes."""
        return SizeLaw(self.logs, self.density * weight(self.sizes))

    def mean(self, function=lambda size: size):
        """Returns the mean of a function of the size; by default of the size."""
        weights = self.density.copy()
        weights[[0, -1]] *= 0.5
        return np.average(function(self.sizes), weights=weights)


def table(minimum, maximum, log_density):
    """Returns the law with a density per size, given by its logarithm up to a constant."""
    logs = np.linspace(np.log(minimum), np.log(maximum), POINTS)
    found = logs + log_density(np.exp(logs))
    return SizeLaw(logs, np.exp(found - found.max()))


def constant(size):
    return table(size, size, np.zeros_like)


def power_law(alpha, minimum, maximum):
    """Density proportional to R^-(1 + alpha) between two limits."""
    return table(minimum, maximum, lambda r: -(1 + alpha) * np.log(r))


def log_normal(mu, sigma, minimum=None, maximum=None):
    """ln R has the mean mu and the standard deviation sigma, before truncation."""
    far = 8 * sigma
    return table(minimum or np.exp(mu - far), maximum or np.exp(mu + far),
                 lambda r: -0.5 * ((np.log(r) - mu) / sigma) ** 2 - np.log(r))


def exponential(mean, minimum=None, maximum=None):
    """Density proportional to exp(-R / mean), before truncation."""
    return table(minimum or 1e-6 * mean, maximum or 40 * mean, lambda r: -r / mean)


def fitted_alpha(sizes, minimum, maximum):
    """Returns the maximum-likelihood estimate of alpha and its standard error, for a power law with these limits.

    The mean of ln R increases with decreasing alpha. The error is 1 / sqrt(n variance of ln R)."""
    low, high, target = -20.0, 20.0, np.mean(np.log(sizes))
    for _ in range(60):
        alpha = 0.5 * (low + high)
        law = power_law(alpha, minimum, maximum)
        low, high = (alpha, high) if law.mean(np.log) > target else (low, alpha)
    return alpha, 1 / np.sqrt(len(sizes) * law.mean(lambda r: (np.log(r) - target) ** 2))
