"""Pictures of flow: pressure in rock and fractures, its change, and the velocity; also temperature and heat flux."""
import re
from collections import namedtuple

import numpy as np
import read
import space
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LogNorm
from style import INK, NOISE, Quantity, colour_bar, limits, panels_of_plane, plt, without_noise


# Arrays of the potential and the flux in rock and fractures, with labels and the unit of the potential.
Kind = namedtuple("Kind", "drive unit flux flux_label drive_inside flux_inside flux_inside_label")
FLUID = Kind("pressure", "Pa", "Darcy velocity", "Darcy velocity (m/s)", "fracture pressure", "fluid flux",
             "flux along fractures (m²/s)")
HEAT = Kind("temperature", "K", "heat flux", "heat flux (W/m²)", None, None, None)


def decades(values):
    """Returns a logarithmic norm over at most eight decades below the largest value, or a linear one for zero flow."""
    largest = np.max(values, initial=0)
    minimum = np.min(values[values > 0], initial=largest)
    return LogNorm(max(minimum, 1e-8 * largest), max(largest, 1.001 * minimum)) if largest > 0 else limits(values)


def at_start(expression, surface):
    """Returns the initial pressure at the centres of polygons, or None if the expression is not supported.

    Supported are numbers, and formulas of numbers and x, y, z."""
    if not re.fullmatch(r"(?:[xyz\s+\-*/^().\d]|(?<=[\d.])[eE][+-]?(?=\d))+", expression):
        return None
    centres = np.array([surface.points[p].mean(axis=0) for p in surface.polygons]).reshape(-1, 3)
    try:
        value = eval(expression.replace("^", "**"), {"__builtins__": {}}, dict(zip("xyz", centres.T)))  # checked above
    except (SyntaxError, NameError, TypeError, ArithmeticError):
        return None
    return np.broadcast_to(np.asarray(value, dtype=float), len(centres))


def change(rock, joints, kind, initial):
    """Yields the panel of p - p0, if p0 is known."""
    before = [at_start(initial, surface) for surface in (rock, joints) if surface]
    if any(values is None for values in before):
        return
    inside = joints.cell_data.get(kind.drive_inside) if joints and kind.drive_inside else None
    scale = np.max(np.abs(rock.cell_data[kind.drive]), initial=0)
    changes = [without_noise(now - then, scale) for now, then in zip((rock.cell_data[kind.drive], inside), before) if now is not None]
    drive = Quantity("p − p₀", kind.unit, *changes)
    values = drive(np.concatenate(changes))
    signed = np.min(values) < -NOISE * np.max(values) and np.max(values) > 0
    bar = (limits(values, signed, clip=True), plt.get_cmap("coolwarm" if signed else "viridis"), drive.label)
    yield "change", (drive(changes[0]), *bar), (drive(changes[1]), *bar) if len(changes) > 1 else None


def panels(rock, joints, kind=FLUID, initial=None):
    """Yields (name, (values, norm, colours, label) of the rock, the same of the fractures or None) of each panel."""
    data = rock.cell_data
    faces = joints.cell_data if joints and kind.drive_inside else {}
    inside = faces.get(kind.drive_inside, np.zeros(0))
    drive = Quantity(kind.drive, kind.unit, data[kind.drive], inside)
    norm = limits(drive(without_noise(np.concatenate([data[kind.drive], inside]), 0)), clip=True)
    bar = (norm, plt.get_cmap("viridis"), drive.label)
    yield kind.drive, (drive(data[kind.drive]), *bar), (drive(inside), *bar) if faces else None
    if initial is not None:
        yield from change(rock, joints, kind, initial)
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


def of_plane(rock, joints, title, kind, initial):
    content = list(panels(rock, joints, kind, initial))
    figure, axes, where = panels_of_plane(len(content), rock.points)
    figure.suptitle(title, fontsize=10)
    for ax, (name, of_rock, of_fractures) in zip(axes, content):
        values, norm, colours, _ = of_rock
        ax.add_collection(PolyCollection(rock.corners(rock.points[:, :2]), array=values, cmap=colours, norm=norm,
                                         edgecolors="face", linewidths=0.2))
        if of_fractures:
            lines = [joints.points[p[:2], :2] for p in joints.polygons]
            ax.add_collection(LineCollection(lines, colors=INK, linewidths=3))
            ax.add_collection(LineCollection(lines, array=of_fractures[0], cmap=of_fractures[2], norm=of_fractures[1],
                                             linewidths=1.8))
        ax.margins(0.03)
        ax.autoscale_view()
        bars(figure, ax, of_rock, of_fractures, **where)
    return figure


def of_body(rock, joints, bounds, title, whole, kind, initial, wells):
    content = list(panels(rock, joints, kind, initial))
    figure, axes = plt.subplots(1, len(content), figsize=(4 * len(content) + 1, 5.2))
    figure.suptitle(title + ("" if whole else ", front half of the rock cut away"), fontsize=10)
    edges = space.edges(rock)
    for ax, (name, of_rock, of_fractures) in zip(axes, content):
        drawn = [(rock, of_rock)] + ([(joints, of_fractures)] if of_fractures and not whole else [])
        parts = [space.Part(surface.points, surface.polygons, colour(norm(values)))
                 for surface, (values, norm, colour, _) in drawn]
        space.draw(ax, [*parts, edges], bounds)
        space.draw_wells(ax, wells)
        bars(figure, ax, of_rock, of_fractures, location="bottom", shrink=0.7, pad=0.02)
    return figure


def of_step(grid, fractures, title, whole=False, kind=FLUID, initial=None, wells=()):
    """Returns the figure of a grid of the rock. The grid of the fractures and the text `initial` may be None."""
    if read.is_plane(grid):
        return of_plane(read.surface(grid), read.segments(fractures) if fractures else None, title, kind, initial)
    rock = space.outer(read.surface(grid if whole else read.behind(grid)))
    bounds = np.reshape(grid.GetBounds(), (3, 2)).T
    return of_body(rock, read.surface(fractures) if fractures else None, bounds, title, whole, kind, initial, dict(wells))
