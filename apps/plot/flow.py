"""What drives a flow and how fast it is: pressure of a fluid in rock and fractures, temperature of rock."""
from collections import namedtuple

import numpy as np
import read
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LogNorm
from style import INK, Quantity, colour_bar, draw_polygons_3d, limits, plt, without_noise


# Arrays of rock and fractures with what drives and what flows; how figures call them, and the unit of what drives.
Kind = namedtuple("Kind", "drive unit flux flux_label drive_inside flux_inside flux_inside_label")
FLUID = Kind("pressure", "Pa", "Darcy velocity", "Darcy velocity (m/s)", "fracture pressure", "fluid flux",
             "flux along fractures (m²/s)")
HEAT = Kind("temperature", "K", "heat flux", "heat flux (W/m²)", None, None, None)


def decades(values):
    """A logarithmic colour bar over at most eight decades below the largest; a plain one where nothing flows."""
    largest = np.max(values, initial=0)
    least = np.min(values[values > 0], initial=largest)
    return LogNorm(max(least, 1e-8 * largest), max(largest, 1.001 * least)) if largest > 0 else limits(values)


def panels(rock, joints, kind=FLUID):
    """(name of the panel, of the rock: (values, norm, colours, label), of the fractures the same or None)."""
    data = rock.cell_data
    faces = joints.cell_data if joints and kind.drive_inside else {}
    inside = faces.get(kind.drive_inside, np.zeros(0))
    drive = Quantity(kind.drive, kind.unit, data[kind.drive], inside)
    norm = limits(drive(without_noise(np.concatenate([data[kind.drive], inside]), 0)))
    bar = (norm, plt.get_cmap("viridis"), drive.label)
    yield kind.drive, (drive(data[kind.drive]), *bar), (drive(inside), *bar) if faces else None
    speed = np.linalg.norm(data[kind.flux], axis=1)
    flux = np.linalg.norm(faces[kind.flux_inside], axis=1) if faces else np.zeros(0)
    yield ("flow", (speed, decades(speed), plt.get_cmap("Blues"), kind.flux_label),
           (flux, decades(flux), plt.get_cmap("autumn_r"), kind.flux_inside_label) if faces else None)


def bars(figure, ax, of_rock, of_fractures, **where):
    for one in [of_rock] + [one for one in [of_fractures] if one and one[3] != of_rock[3]]:
        _, norm, colours, label = one
        bar = colour_bar(figure, ax, norm, colours, label, **where)
        if isinstance(norm, LogNorm):
            bar.locator = plt.LogLocator(numticks=6)
            bar.update_ticks()


def of_plane(rock, joints, title, kind):
    figure, axes = plt.subplots(1, 2, sharex=True, sharey=True, figsize=(10.5, 4.2))
    figure.suptitle(title, fontsize=10)
    for ax, (name, of_rock, of_fractures) in zip(axes, panels(rock, joints, kind)):
        values, norm, colours, _ = of_rock
        ax.add_collection(PolyCollection(rock.corners(rock.points[:, :2]), array=values, cmap=colours, norm=norm,
                                         edgecolors="face", linewidths=0.2))
        if of_fractures:
            lines = [joints.points[p[:2], :2] for p in joints.polygons]
            ax.add_collection(LineCollection(lines, colors=INK, linewidths=3))
            ax.add_collection(LineCollection(lines, array=of_fractures[0], cmap=of_fractures[2], norm=of_fractures[1],
                                             linewidths=1.8))
        ax.set_aspect("equal")
        ax.margins(0.03)
        ax.autoscale_view()
        ax.grid(False)
        ax.set_xlabel("x (m)")
        bars(figure, ax, of_rock, of_fractures)
    axes[0].set_ylabel("y (m)")
    return figure


def of_body(rock, joints, title, whole, kind):
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.8), subplot_kw={"projection": "3d"})
    figure.suptitle(title + ("" if whole else ", front half of the rock cut away"), fontsize=10)
    for ax, (name, of_rock, of_fractures) in zip(axes, panels(rock, joints, kind)):
        drawn = [(rock, of_rock)] + ([(joints, of_fractures)] if of_fractures and not whole else [])
        corners = sum((list(surface.corners()) for surface, _ in drawn), [])
        colours = np.concatenate([colour(norm(values)) for _, (values, norm, colour, _) in drawn])
        draw_polygons_3d(ax, corners, colours, colours * (0.85, 0.85, 0.85, 1), zoom=0.98)
        bars(figure, ax, of_rock, of_fractures, location="bottom", shrink=0.7, pad=0.1)
    return figure


def of_step(grid, fractures, title, whole=False, kind=FLUID):
    """Of the rock's grid; the fractures' may be None."""
    flat = read.is_plane(grid)
    rock = read.surface(grid if flat or whole else read.behind(grid))
    if flat:
        return of_plane(rock, read.segments(fractures) if fractures else None, title, kind)
    return of_body(rock, read.surface(fractures) if fractures else None, title, whole, kind)
