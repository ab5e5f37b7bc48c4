"""Pictures of the rock: displacement, von Mises stress and largest compression on the deformed body."""
import numpy as np
import read
import space
from matplotlib.collections import LineCollection, PolyCollection
from style import FAINT, INK, PAPER, Quantity, colour_bar, limits, nice, panels_of_plane, plt, without_noise

LESS_PRESSURE = ", less α (p − p₀)"  # definition of the array `stress` with a fluid in the rock


def tensors(stress):
    """Returns tensors (n, 3, 3) from components (n, 6): XX, YY, ZZ, XY, YZ, XZ."""
    return stress[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)


def von_mises(stress):
    """Returns the von Mises stress sqrt(3/2 s:s) with the deviator s."""
    sigma = tensors(stress)
    deviator = sigma - np.trace(sigma, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * np.sum(deviator**2, axis=(1, 2)))


def largest_compression(stress):
    """Returns the negative of the smallest principal stress, positive in compression."""
    return -np.linalg.eigvalsh(tensors(stress))[:, 0]


def warp_factor(points, displacement, factor=None):
    """Returns the given factor, or a round factor that makes the largest displacement visible."""
    if factor is not None:
        return factor
    largest = np.max(np.linalg.norm(displacement, axis=1), initial=0)
    return nice(0.05 * np.max(np.ptp(points, axis=0)) / largest) if largest > 0 else 0


def rim(surface, joints):
    """Returns pairs of points: edges of the outer boundary and of the sides of fractures `joints` (or None).

    The pieces of ranks have separate points. Edges between two pieces therefore occur twice at the same place."""
    edges = np.concatenate([np.stack([p, np.roll(p, -1)], 1) for p in surface.polygons])
    faces = read.segments(joints) if joints else None
    points = np.concatenate([surface.points, faces.points]) if faces else surface.points
    place = np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)
    number = lambda ends: np.sort(place[ends], axis=1) @ (len(points), 1)  # one number for each pair of places
    here, counts = np.unique(number(edges), return_counts=True)
    sides = number(np.array([ends[:2] for ends in faces.polygons]) + len(surface.points)) if faces else []
    return edges[np.isin(number(edges), np.concatenate([here[counts == 1], sides]))]


def triangles(polygons):
    return np.concatenate([np.stack([np.full(len(p) - 2, p[0]), p[1:-1], p[2:]], 1) for p in polygons])


def panels(surface):
    """Yields (values, colours, label, True for point data) of each panel, in the unit of the label."""
    size, stress = np.linalg.norm(surface.point_data["displacement"], axis=1), surface.cell_data["stress"]
    scale = np.max(abs(stress), initial=0)
    less = LESS_PRESSURE if "pressure" in surface.cell_data else ""
    for values, scale, colours, name, base, on_points in (
            (size, 0, "viridis", "displacement", "m", True),
            (von_mises(stress), scale, "inferno", "von Mises stress", "Pa", False),
            (largest_compression(stress), scale, "cividis", "largest compressive stress" + less, "Pa", False)):
        values = without_noise(values, scale)
        quantity = Quantity(name, base, values)
        yield quantity(values), plt.get_cmap(colours), quantity.label, on_points


def of_plane(grid, fractures, title, factor=None, box=None):
    """Returns the figure of the rock, or of its part in a box (low, high), without the mean displacement of this part."""
    surface = read.surface(grid)
    displacement = surface.point_data["displacement"]
    if box is not None:
        room = 0.2 * (box[1] - box[0])  # for the displacement
        is_in = np.all((surface.points[:, :2] > box[0] - room) & (surface.points[:, :2] < box[1] + room), axis=1)
        surface = surface.part([k for k, polygon in enumerate(surface.polygons) if is_in[polygon].any()])
        displacement = np.where(is_in[:, None], displacement - displacement[is_in].mean(axis=0), 0)
        title += ", region of the fractures"
    factor = warp_factor(surface.points if box is None else box, displacement, factor)
    rest, moved = surface.points[:, :2], (surface.points + factor * displacement)[:, :2]
    edges = rim(surface, fractures)
    figure, axes, where = panels_of_plane(3, moved if box is None else box)
    figure.suptitle(f"{title}, deformation × {factor:g}", fontsize=10)
    for ax, (values, colours, label, on_points) in zip(axes, panels(surface)):
        norm = limits(values[np.concatenate(surface.polygons)] if on_points else values, clip=not on_points)
        if on_points:
            ax.tripcolor(*moved.T, triangles(surface.polygons), values, cmap=colours, norm=norm, shading="gouraud")
        else:
            ax.add_collection(PolyCollection(surface.corners(moved), array=values, cmap=colours, norm=norm,
                                             edgecolors="face", linewidths=0.2))
        ax.add_collection(LineCollection(rest[edges], colors=FAINT, linewidths=0.7, linestyles=(0, (4, 3))))
        ax.add_collection(LineCollection(moved[edges], colors=INK, linewidths=0.9))
        ax.margins(0.03)
        ax.autoscale_view()
        if box is not None:
            ax.set(xlim=box[:, 0], ylim=box[:, 1])
        colour_bar(figure, ax, norm, colours, label, **where)
    return figure


def moved_points(grid, points, factor):
    """Returns points of fractures, moved by the mean displacement of the rock there."""
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import vtkPointLocator
    displacement = read.arrays(grid.GetPointData())["displacement"]
    locator, found = vtkPointLocator(), vtkIdList()
    locator.SetDataSet(grid)
    locator.BuildLocator()
    moved = points.copy()
    for point in moved:
        locator.FindPointsWithinRadius(1e-9 * grid.GetLength(), point, found)
        sides = [found.GetId(k) for k in range(found.GetNumberOfIds())]
        point += factor * np.mean(displacement[sides], axis=0) if sides else 0
    return moved


def of_body(grid, fractures, title, factor=None, whole=False):
    surface = space.outer(read.surface(grid if whole else read.behind(grid)))
    displacement = surface.point_data["displacement"]
    factor = warp_factor(surface.points, displacement, factor)
    points = surface.points + factor * displacement
    parts = [space.edges(surface, points)]
    if fractures and not whole:
        joints = read.surface(fractures)
        corners = moved_points(grid, joints.points, factor)
        parts += [space.Part(corners, joints.polygons, PAPER), space.Part(corners, list(rim(joints, None)), INK)]
    everywhere = read.surface(grid)
    bounds = space.bounds_of(everywhere.points + factor * everywhere.point_data["displacement"])
    figure, axes = plt.subplots(1, 3, figsize=(10, 4.2))
    half = "" if whole else ", front half of the rock cut away"
    figure.suptitle(f"{title}, deformation × {factor:g}{half}", fontsize=10)
    for ax, (values, colours, label, on_points) in zip(axes, panels(surface)):
        faces = np.array([np.mean(values[p]) for p in surface.polygons]) if on_points else values
        norm = limits(faces, clip=not on_points)
        space.draw(ax, [space.Part(points, surface.polygons, colours(norm(faces))), *parts], bounds)
        colour_bar(figure, ax, norm, colours, label, location="bottom", shrink=0.7, pad=0.02)
    return figure


def of_step(grid, fractures, title, factor=None, whole=False, box=None):
    """Returns the figure of a grid of the rock. The grid of the fractures may be None. `box`: part of the rock in 2D."""
    if read.is_plane(grid):
        return of_plane(grid, fractures, title, factor, box)
    return of_body(grid, fractures, title, factor, whole)
