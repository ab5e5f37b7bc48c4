"""Picture of growing fractures: faces by the time of the first written step in which they exist, or their bond is lost."""
import numpy as np
import read
from bulk import rim
from matplotlib.collections import LineCollection
from network import Network
from places import region
from style import FAINT, INK, Range, colour_bar, plt, unit
from vtkmodules.util.numpy_support import numpy_to_vtk

MAX_STEPS = 40  # read for the picture
LOST = 0.5  # damage of a lost bond
NOTCH = 1e-6  # smallest opening of a notch / largest opening
TIME = "time of growth"


def on_paths(content):
    """Returns whether fractures of the run have grown along free paths."""
    return any("growth" in step for step in content["steps"])


def grows(content):
    """Returns whether fractures of the run have grown, along free paths or by the loss of bonds."""
    broken = (step.get("single_fractures", {}).get("area_broken", ()) for step in content["steps"])
    return on_paths(content) or any(value for values in broken for value in values)


def is_part(data, paths):
    """Returns a mask of the faces that belong to the fracture at a step, with their data. Faces of a notch open without
    damage, bonded faces do not."""
    if paths:
        return np.ones(len(data["fracture"]), bool)
    damage, opening = data["damage of bond"], data["opening"]
    return (damage > LOST) | ((damage == 0) & (opening > NOTCH * np.max(opening)))


def chosen(steps):
    """Returns evenly chosen steps with the last one."""
    return [steps[k] for k in np.unique(np.round(np.linspace(len(steps) - 1, 0, min(len(steps), MAX_STEPS))).astype(int))]


def box_of(rock, joints, content, whole=False):
    """Returns the box (low, high) of the fracture in 2D if it is much smaller than the rock, or None."""
    if whole or not joints or not read.is_plane(rock) or not grows(content):
        return None
    faces, points = read.segments(joints), read.surface(rock).points[:, :2]
    centres = np.array([faces.points[face[:2], :2].mean(axis=0) for face in faces.polygons])
    return region(centres, is_part(faces.cell_data, on_paths(content)).astype(float), np.array([points.min(axis=0), points.max(axis=0)]))


def of_plane(steps, rock, joints, title, norm, factor, content, whole):
    """Draws the fracture of each step in the colour of its time, earlier steps on top."""
    figure, ax = plt.subplots(figsize=(7.4, 6))
    skin, colours, paths = read.surface(rock), plt.get_cmap("viridis"), on_paths(content)
    lines = [(time, read.segments(read.grid(file))) for time, file in steps]
    ax.add_collection(LineCollection(skin.points[rim(skin, joints)][:, :, :2], colors=FAINT, linewidths=0.7))
    for width, under in ((4.0, True), (2.6, False)):
        for time, faces in reversed(lines):
            part = np.flatnonzero(is_part(faces.cell_data, paths))
            ends = [faces.points[faces.polygons[k][:2], :2] for k in part]
            ax.add_collection(LineCollection(ends, colors=INK if under else [colours(norm(time / factor))], linewidths=width, capstyle="round"))
    box = box_of(rock, joints, content, whole)
    ax.set_aspect("equal")
    ax.margins(0.03)
    ax.autoscale_view()
    if box is not None:
        ax.set(xlim=box[:, 0], ylim=box[:, 1])
    ax.grid(False)
    ax.set(xlabel="x (m)", ylabel="y (m)")
    figure.suptitle(title + ("" if box is None else ", region of the fractures"), fontsize=10)
    return figure, ax, colours


def of_body(steps, rock, joints, names, title, norm, factor, singles, whole, wells):
    """Draws the faces in the colour of the first step without bond. Steps with another mesh are omitted."""
    first = np.full(joints.GetNumberOfCells(), np.nan)
    for time, file in reversed(steps):
        grid = read.grid(file)
        if grid.GetNumberOfCells() == len(first):
            first[is_part(read.arrays(grid.GetCellData()), False)] = time / factor
    array = numpy_to_vtk(first, deep=True)
    array.SetName(TIME)
    joints.GetCellData().AddArray(array)
    view = Network(rock, joints, names, singles, whole, wells)
    figure, ax = plt.subplots(figsize=(7.4, 6))
    figure.suptitle(title, fontsize=10)
    figure.supxlabel("; ".join(filter(None, [view.note(), "grey: bonded"])), fontsize=8)
    colours = plt.get_cmap("viridis").with_extremes(bad="#d9dbe0")
    view.draw(ax, colours(norm(np.ma.masked_invalid(view.data[TIME]))))
    return figure, ax, colours


def of_run(steps, rock, joints, names, title, clock, content, whole=False, wells=()):
    """Returns the figure of the written steps [(time, file of fractures)], the last one with the grids `rock` and `joints`.
    None if nothing has grown. `clock`: unit of times as in style.when."""
    if not grows(content):
        return None
    steps = chosen(steps)
    factor, name = clock or unit(steps[-1][0], "s")
    norm = Range(steps[0][0] / factor, max(steps[-1][0], steps[0][0] + 1e-9) / factor)
    if read.is_plane(rock):
        figure, ax, colours = of_plane(steps, rock, joints, title, norm, factor, content, whole)
    else:
        figure, ax, colours = of_body(steps, rock, joints, names, title, norm, factor, content.get("single_fractures", ()), whole, wells)
    colour_bar(figure, ax, norm, colours, f"time ({name})")
    return figure
