"""Maps of slip tendency, slip and opening on fractures, with the slip tendency of orientations."""
import numpy as np
import orientations
import read
from bulk import rim
from fractures import effective, scales, traces_of
from matplotlib import patheffects
from matplotlib.collections import LineCollection
from network import Network
from places import place_of_name, region
from style import FAINT, INK, NOISE, Quantity, STATE_COLOURS, colour_bar, limits, plt, without_noise

LARGEST_TENDENCY = 1.5  # upper limit of the colours


def slip_tendency(data, stress):
    """Returns shear traction over normal compression, NaN on open faces. Round-off of the stress counts as zero."""
    normal, shear = data["traction local"][:, 0], without_noise(np.linalg.norm(data["traction local"][:, 1:], axis=1), stress)
    loaded = (data["state"] > 0) & (normal < -NOISE * stress)
    return without_noise(np.where(loaded, shear / np.where(loaded, -normal, 1), np.nan), 1)


def panels(data, length, stress):
    """Yields (values, norm, colours, label) of each map. Length and stress are reference values of round-off."""
    tendency = np.minimum(slip_tendency(data, stress), LARGEST_TENDENCY)
    ratio = "shear traction / " + effective(data) + "normal compression (-)"
    colours = plt.get_cmap("plasma").with_extremes(bad=STATE_COLOURS(0))
    yield tendency, limits(tendency[~np.isnan(tendency)]), colours, ratio
    for name, title, palette in (("slip", "slip", "YlOrRd"), ("opening", "opening, normal jump", "YlGnBu")):
        values = without_noise(data[name], length)
        quantity, signed = Quantity(title, "m", values), np.min(values) < 0
        yield quantity(values), limits(quantity(values), signed, clip=True), plt.get_cmap("coolwarm" if signed else palette), quantity.label


def planes(surface, values):
    """Returns a polygon for each plane of a fracture, and the mean value over its area without NaN."""
    corners = surface.corners()
    normals = np.array([orientations.area_vector(x) for x in corners])
    areas = np.linalg.norm(normals, axis=1)
    normals /= areas[:, None]
    heights = np.einsum("ij,ij->i", normals, [x[0] for x in corners]) / np.max(np.ptp(surface.points, axis=0))
    keys = np.column_stack([surface.cell_data["fracture"], np.round(np.column_stack([normals, heights]), 5)])
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    loaded = np.where(np.isnan(values), 0, areas)
    total, loaded = (np.bincount(number.reshape(-1), weights) for weights in (loaded * np.nan_to_num(values), loaded))
    return [corners[k] for k in first], np.where(loaded > 0, total / np.where(loaded > 0, loaded, 1), np.nan)


def draw_directions(ax, shapes, values, norm, colours):
    """Draws a rose diagram of lines or a stereonet of polygons, with colours in ten classes of the values.

    A value at the limit of two classes, up to round-off, is in the upper class."""
    classes = np.where(np.isnan(values), -1, np.clip(np.floor(10 * np.ma.filled(norm(values), 0) + 1e-6), 0, 9))
    parts = [(colours(np.nan if k < 0 else (k + 0.5) / 10), [shapes[i] for i in np.flatnonzero(classes == k)])
             for k in range(-1, 10)]
    orientations.draw(ax, 2 if shapes[0].shape[1] == 2 else 3, [(colour, part) for colour, part in parts if part])


def line_width(ends, outline):
    """In points: less the denser the traces are, by their mean spacing, the area of the map over their length."""
    size = np.ptp(outline, axis=0)
    spacing = np.prod(size) / np.sum(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    return float(np.clip(25 * spacing / np.max(size), 1.8, 3))


def draw_lines(ax, surface, outline, values, norm, colours):
    ax.add_collection(LineCollection(outline, colors=FAINT, linewidths=0.7))
    ends = [x[:2, :2] for x in surface.corners()]
    width = line_width(np.array(ends), outline.reshape(-1, 2))
    ax.add_collection(LineCollection(ends, colors=INK, linewidths=width + min(1, 0.5 * width), capstyle="round"))
    ax.add_collection(LineCollection(ends, array=np.ma.masked_invalid(values), cmap=colours, norm=norm, linewidths=width, capstyle="round"))
    ax.set_aspect("equal")
    ax.margins(0.03)
    ax.autoscale_view()
    ax.grid(False)
    ax.set(xlabel="x (m)", ylabel="y (m)")


FEW = 12


def write_names(ax, surface, names, singles, length, shown):
    """At traces that fractures.png shows in colour, the largest jump first, without names that would overlap. Of more than
    FEW traces only those with slip, if there are any. `length` is the reference value of round-off, `shown` the box of
    the map."""
    slips = without_noise(surface.cell_data["slip"], length) > 0
    jump = np.linalg.norm(surface.cell_data["jump local"][:, 1:], axis=1)
    ends = np.array([surface.points[face[:2], :2].mean(axis=0) for face in surface.polygons])
    traces = [trace for number in sorted(set(surface.cell_data["fracture"].astype(int)))
              for trace in traces_of(surface, number, names[number] if number < len(names) else f"fracture {number}", singles)
              if trace.colour != FAINT]
    if len(traces) > FEW:
        traces = [trace for trace in traces if np.any(slips[trace.faces])] or traces
    taken = []
    for trace in sorted(traces, key=lambda trace: -np.max(jump[trace.faces])):
        places = ends[trace.faces]
        places = places[np.all((places > shown[0]) & (places < shown[1]), axis=1)]
        places = places[np.unique(np.linspace(0, max(len(places) - 1, 0), 9).round().astype(int))] if len(places) else places
        places = sorted(places, key=lambda place: np.linalg.norm(place - places[len(places) // 2]))
        found = place_of_name(trace.name, places, np.ptp(shown, axis=0), taken)
        if found:
            taken.append(found)
            text = ax.text(*found[0], trace.name, fontsize=6, ha="center", va="center", zorder=6)
            text.set_path_effects([patheffects.withStroke(linewidth=1.5, foreground="white")])


def of_plane(rock, joints, names, title, singles, whole):
    """Returns the figure of traces. It shows the region with slip if it is much smaller than the rock."""
    surface, skin = read.segments(joints), read.surface(rock)
    outline = skin.points[rim(skin, joints)][:, :, :2]
    body = np.array([outline.min(axis=(0, 1)), outline.max(axis=(0, 1))])
    centres = np.array([surface.points[face[:2], :2].mean(axis=0) for face in surface.polygons])
    shown = None if whole else region(centres, surface.cell_data["slip"], body)
    size = np.ptp(body if shown is None else shown, axis=0)
    sizes = scales(rock, surface.cell_data)
    figure = plt.figure(figsize=(9, 7.6 * np.clip(size[1] / size[0], 0.4, 2) + 0.8))
    figure.suptitle(title + ("" if shown is None else ", region with slip"), fontsize=10)
    for k, (values, norm, colours, label) in zip((1, 3, 4), panels(surface.cell_data, *sizes)):
        ax = figure.add_subplot(2, 2, k)
        draw_lines(ax, surface, outline, values, norm, colours)
        if shown is not None:
            ax.set(xlim=shown[:, 0], ylim=shown[:, 1])
        if k == 3:
            write_names(ax, surface, names, singles, sizes[0], body if shown is None else shown)
        colour_bar(figure, ax, norm, colours, label)
        if k == 1:
            draw_tendency(figure, ax, ([x[:2, :2] for x in surface.corners()], values), norm, colours)
    return figure


def of_body(view, rock, title):
    figure = plt.figure(figsize=(9, 8.6))
    figure.suptitle(title, fontsize=10)
    figure.supxlabel(view.note(), fontsize=8)
    for k, (values, norm, colours, label) in zip((1, 3, 4), panels(view.data, *scales(rock, view.data))):
        ax = figure.add_subplot(2, 2, k)
        view.draw(ax, colours(norm(np.ma.masked_invalid(values))))
        if k == 3:
            view.write_names(ax)
        colour_bar(figure, ax, norm, colours, label, location="bottom", shrink=0.7, pad=0.02)
        if k == 1:
            draw_tendency(figure, ax, planes(view.surface, values), norm, colours)
    return figure


def draw_tendency(figure, ax, shapes, norm, colours):
    """Draws the directions of shapes and their slip tendency, and explains the colour of open faces."""
    draw_directions(figure.add_subplot(2, 2, 2, projection="polar"), *shapes, norm, colours)
    if np.isnan(shapes[1]).any():
        ax.legend([plt.Rectangle((0, 0), 1, 1, color=colours(np.nan))], ["open"], loc="lower left", bbox_to_anchor=(0, 1))


def of_step(rock, joints, names, title, singles=(), whole=False, wells=()):
    """Returns the figure of the grids of rock and fractures with these names.

    `singles` as in results.json, `wells` as in read.wells; they are drawn in 3D."""
    if read.is_plane(rock):
        return of_plane(rock, joints, names, title, singles, whole)
    return of_body(Network(rock, joints, names, singles, whole, wells), rock, title)
