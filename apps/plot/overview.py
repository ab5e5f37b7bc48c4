"""Two maps of a plane run with flow in deformable rock: slip of the fractures, and change of the fluid pressure."""
import flow
import numpy as np
import read
from bulk import rim
from fractures import scales
from matplotlib import patheffects
from matplotlib.collections import LineCollection, PolyCollection
from style import FAINT, INK, Quantity, Range, colour_bar, limits, panels_of_plane, plt, without_noise

WIDTHS = 0.8, 5.0  # of lines, in points: where the value that sets the width is zero, where it is largest


def draw_lines(ax, lines, sizes, values, norm, colours):
    """Fractures whose widths show the sizes, between 0 and 1, and whose colours show the values; the widest on top."""
    order = np.argsort(sizes, kind="stable")
    lines, widths = [lines[k] for k in order], WIDTHS[0] + (WIDTHS[1] - WIDTHS[0]) * sizes[order]
    ax.add_collection(LineCollection(lines, colors=INK, linewidths=widths + 0.8, capstyle="round"))
    ax.add_collection(LineCollection(lines, array=values[order], cmap=colours, norm=norm, linewidths=widths, capstyle="round"))


def draw_wells(ax, scene):
    for name, (place,) in read.wells(scene, 2).items():
        ax.plot(*place, "o", ms=6, mfc="white", mec=INK, mew=1.5, zorder=5)
        text = ax.annotate(name, place, (7, -3), textcoords="offset points", zorder=6)
        text.set_path_effects([patheffects.withStroke(linewidth=2.5, foreground="white")])


def range_of_change(values):
    """(norm, colours): from zero on where the pressure rises at least twice as much as it falls, else around zero."""
    low, high = np.min(values), np.max(values)
    if high < -2 * low or high <= 0:
        return limits(values, signed=True), plt.get_cmap("coolwarm")
    return Range(0, high, extend="min" if low < 0 else "neither"), plt.get_cmap("GnBu")


def of_step(rock, joints, scene, title):
    """Of the grids of the rock and of the fractures; None without flow in rock and fractures, or if the change of pressure
    is not known."""
    surface, faces = read.surface(rock), read.segments(joints)
    initial = scene.get("Flow", {}).get("initial pressure")
    if initial is None or "hydraulic aperture" not in faces.cell_data or flow.FLUID.drive not in surface.cell_data:
        return None
    for _, (in_rock, _, _, label), (inside, *_) in flow.change(surface, faces, flow.FLUID, initial):
        lines = [corners[:2, :2] for corners in faces.corners()]
        slip = without_noise(faces.cell_data["slip"], scales(rock, faces.cell_data)[0])
        quantity = Quantity("slip", "m", slip)
        slip, aperture = quantity(slip), faces.cell_data["hydraulic aperture"]
        figure, (left, right), where = panels_of_plane(2, surface.points)
        figure.suptitle(title, fontsize=10)
        for ax in (left, right):
            ax.add_collection(LineCollection(surface.points[rim(surface, joints)][:, :, :2], colors=FAINT, linewidths=0.7))
            draw_wells(ax, scene)
        norm, colours = limits(slip), plt.get_cmap("YlOrRd")
        draw_lines(left, lines, np.sqrt(slip / max(np.max(slip), 1e-300)), slip, norm, colours)
        colour_bar(figure, left, norm, colours, quantity.label, **where)
        norm, colours = range_of_change(np.concatenate([in_rock, inside]))
        right.add_collection(PolyCollection(surface.corners(surface.points[:, :2]), array=in_rock, cmap=colours, norm=norm,
                                            antialiaseds=False))
        draw_lines(right, lines, aperture / max(np.max(aperture), 1e-300), inside, norm, colours)
        colour_bar(figure, right, norm, colours, label + ", width: aperture", **where)
        for ax in (left, right):
            ax.margins(0.02)
            ax.autoscale_view()
        return figure
    return None
