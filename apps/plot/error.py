"""Picture of the estimated error: of stress or flow in the rock, and of the jump on fractures."""
import numpy as np
import read
import space
from bulk import rim
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LogNorm
from style import FAINT, INK, Quantity, colour_bar, limits, plt

DECADES = 4  # range of colours of the density


def density_of(surface):
    """Returns the density of the stress error, or of the flow error, with its label."""
    data = surface.cell_data
    return (data["error density"], "error density (J/m³)") if "error density" in data else (data["flux error density"], "error density (W/m³)")


def density_colours(density):
    """Returns the values, the norm and the colour map of a density. The scale is logarithmic for nonzero values."""
    largest = np.max(density, initial=0)
    norm = LogNorm(largest * 10.0**-DECADES, largest) if largest > 0 else limits(density)
    return np.maximum(density, norm.vmin), norm, plt.get_cmap("inferno")


def jump_colours(faces):
    size = np.linalg.norm(faces.cell_data["jump error"], axis=1)
    quantity = Quantity("error of the jump", "m", size)
    return quantity(size), limits(quantity(size)), plt.get_cmap("viridis"), quantity.label


def headline(title, estimate):
    """Returns the title with the estimates of the step."""
    parts = [f"{name} {estimate[name]['relative']:.2g}" for name in ("stress", "jump", "flux")
             if "relative" in estimate.get(name, {})]
    return f"{title}, relative error estimated: {', '.join(parts)}"


def of_plane(grid, joints, fractures):
    surface = read.surface(grid)
    points = surface.points[:, :2]
    edges = rim(surface, fractures)
    figure, axes = plt.subplots(1, 2 if joints else 1, squeeze=False, sharex=True, sharey=True,
                                figsize=(10 if joints else 5.5, 4.3 * np.clip(np.ptp(points[:, 1]) / np.ptp(points[:, 0]), 0.4, 2) + 0.9))
    density, density_label = density_of(surface)
    density, norm, colours = density_colours(density)
    axes[0, 0].add_collection(PolyCollection(surface.corners(points), array=density, cmap=colours, norm=norm,
                                             edgecolors="face", linewidths=0.2))
    bar = colour_bar(figure, axes[0, 0], norm, colours, density_label)
    bar.locator = plt.LogLocator() if isinstance(norm, LogNorm) else bar.locator
    if joints:
        faces = read.segments(joints)
        values, norm, colours, label = jump_colours(faces)
        ends = [corners[:2, :2] for corners in faces.corners()]
        axes[0, 1].add_collection(LineCollection(ends, array=values, cmap=colours, norm=norm, linewidths=4, zorder=3))
        colour_bar(figure, axes[0, 1], norm, colours, label)
    for ax in axes.flat:
        ax.add_collection(LineCollection(points[edges], colors=INK if ax is axes[0, 0] else FAINT, linewidths=0.7))
        ax.set_aspect("equal")
        ax.margins(0.03)
        ax.autoscale_view()
        ax.grid(False)
        ax.set_xlabel("x (m)")
    axes[0, 0].set_ylabel("y (m)")
    return figure


def of_body(grid, joints, whole):
    surface = space.outer(read.surface(grid if whole else read.behind(grid)))
    figure, axes = plt.subplots(1, 2 if joints else 1, squeeze=False, figsize=(8.5 if joints else 4.5, 5))
    density, density_label = density_of(surface)
    density, norm, colours = density_colours(density)
    pictures = [(surface, density, norm, colours, density_label)]
    edges, bounds = space.edges(surface), np.reshape(grid.GetBounds(), (3, 2)).T
    if joints:
        faces = read.surface(joints)
        pictures.append((faces, *jump_colours(faces)))
    for ax, (polygons, values, norm, colours, label) in zip(axes.flat, pictures):
        space.draw(ax, [space.Part(polygons.points, polygons.polygons, colours(norm(values))), edges], bounds)
        bar = colour_bar(figure, ax, norm, colours, label, location="bottom", shrink=0.7, pad=0.02)
        bar.locator = plt.LogLocator() if isinstance(norm, LogNorm) else bar.locator
    return figure


def of_step(grid, joints, estimate, title, whole=False):
    """Returns the figure of the grids of rock and fractures (or None), with the error estimate of the step."""
    fractures, joints = joints, joints if joints and "jump error" in read.arrays(joints.GetCellData()) else None
    figure = of_plane(grid, joints, fractures) if read.is_plane(grid) else of_body(grid, joints, whole)
    figure.suptitle(headline(title, estimate), fontsize=10)
    return figure
