"""Statistics of the drawn fractures, as lines of text, with the requested values."""
import numpy as np
import size_law

KAPPA = np.geomspace(1e-3, 1e6, 1000)
FEWEST = 3  # fractures for a fit


def mean_cosine(kappa, dim):
    """Returns the mean cosine of a Fisher (3D) or von Mises (2D) distribution."""
    angle = np.linspace(0, min(np.pi, 12 / np.sqrt(kappa)), 2001)  # the density is negligible beyond
    density = np.exp(kappa * (np.cos(angle) - 1)) * (np.sin(angle) if dim == 3 else 1)
    density[[0, -1]] *= 0.5
    return np.average(np.cos(angle), weights=density)


def doubled(directions):
    """Returns directions with twice the angle from y, so that both ends of a trace agree."""
    x, y = directions.T
    return np.stack([2 * x * y, y**2 - x**2], axis=1)


def fitted_direction(normals):
    """Returns the mean direction, the maximum-likelihood estimate of kappa (Fisher 1953) and its standard error."""
    n, dim = normals.shape
    mean = (normals if dim == 3 else doubled(normals)).mean(axis=0)
    length = np.linalg.norm(mean)
    cosines = np.array([mean_cosine(kappa, dim) for kappa in KAPPA])
    kappa = np.interp(length, cosines, KAPPA)
    error = 1 / np.sqrt(n * np.interp(kappa, KAPPA, np.gradient(cosines, KAPPA)))
    if dim == 2:
        half = 0.5 * np.arctan2(*mean)
        return np.array([np.sin(half), np.cos(half)]), kappa, error
    return mean / length, kappa, error


def angles(normals):
    """Returns dip and dip direction of poles in 3D, in degrees."""
    up = normals * np.where(normals[:, 2:] < 0, -1, 1)
    return np.degrees(np.arccos(np.clip(up[:, 2], -1, 1))), np.degrees(np.arctan2(up[:, 0], up[:, 1])) % 360


def strikes(directions):
    """Returns the strikes of directions in 2D, from 0 to 180 degrees."""
    return np.degrees(np.arctan2(directions[:, 0], directions[:, 1])) % 180


def in_words(direction):
    if len(direction) == 2:
        return f"strike {strikes(direction[None])[0]:.1f}"
    dip, dip_direction = (x[0] for x in angles(direction[None]))
    return f"dip {dip:.1f}, dip direction {dip_direction:.1f}"


def of_set(one, fractures, statistics):
    """Yields the lines of a set.

    Means and fits refer to fractures with centres in the domain. Among all that meet the domain, large ones are more
    frequent than in the set."""
    dim, box = statistics.dim, statistics.box
    own = fractures.only(((fractures.centres >= box[0]) & (fractures.centres <= box[1])).all(axis=1))
    yield f"{one.name}: {len(fractures)} fractures, {len(own)} with centres in the domain"
    requested = f"; requested: {one.intensity:g}" if one.intensity else ""
    unit = "m^2/m^3" if dim == 3 else "m/m^2"
    yield f"  P{dim}{dim - 1} in the domain [{unit}]: {fractures.inside.sum() / statistics.measure:.4g}{requested}"
    if len(own) >= FEWEST:
        requested = one.size.mean()
        error = np.sqrt(one.size.mean(lambda size: (size - requested) ** 2) / len(own))
        name = "radius" if dim == 3 else "length"
        yield f"  mean {name} [m]: {own.sizes.mean():.4g}, standard error {error:.2g}; requested: {requested:.4g}"
        if one.alpha is not None:
            alpha, error = size_law.fitted_alpha(own.sizes, *one.size.sizes[[0, -1]])
            yield f"  alpha: {alpha:.3g}, standard error {error:.2g}; requested: {one.alpha:g}"
        mean, kappa, error = fitted_direction(own.normals)
        yield f"  kappa: {kappa:.3g}, standard error {error:.2g}; requested: {one.kappa:g}"
        yield f"  mean direction: {in_words(mean)}; requested: {in_words(one.mean)}"
    if one.aperture:
        yield f"  mean aperture [mm]: {1e3 * fractures.apertures.mean():.4g}"
