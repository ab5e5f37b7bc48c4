"""Pictures of polygons in space, rendered by VTK without a screen, in a box with coordinates, north and names."""

import os
import shutil
import subprocess
from collections import namedtuple
from functools import cache

import numpy as np
import read
from matplotlib import patheffects
from matplotlib.colors import to_rgb
from places import beside, place_of_name
from read import PlotError
from style import FAINT, INK, LINES, NOISE, plt
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

# Polygons, or lines as polygons of two corners. Colours: an array (polygons, at least 3), or one colour.
Part = namedtuple("Part", "points polygons colours opacity", defaults=(1.0,))

PIXELS = 1000  # of the longer side of an image
WIDTH = 2.0  # of lines, in pixels
LIGHT = 0.25  # part of the brightness that depends on the direction of a face
ANGLES = np.radians([-58, 22])  # of the viewer: from x towards y, and above the horizontal plane
SHARP = 30  # degrees; edges of the rock with larger angles are drawn
WELL = LINES[0]
SEEN = 0.05  # smallest visible fraction of a fracture that is not hidden
MAX_PLACES = 25  # tried for a name
ROOM = 0.05  # margin around the box / its size


def directions():
    """Returns the unit vectors to the right and up in the picture, and towards the viewer."""
    (cos_a, cos_e), (sin_a, sin_e) = np.cos(ANGLES), np.sin(ANGLES)
    return (
        np.array([-sin_a, cos_a, 0]),
        np.array([-sin_e * cos_a, -sin_e * sin_a, cos_e]),
        np.array([cos_e * cos_a, cos_e * sin_a, sin_e]),
    )


def flat(points):
    """Returns the places of points in the picture, m."""
    return points @ np.array(directions()[:2]).T


def outer(surface):
    """Returns the outer faces of the rock, with holes, without the sides of fractures and the boundaries of ranks.

    These faces occur twice at the same place."""
    centres = np.array([surface.points[polygon].mean(axis=0) for polygon in surface.polygons])
    tolerance = 1e-6 * np.max(np.ptp(surface.points, axis=0))
    _, number, counts = np.unique(np.round(centres / tolerance), axis=0, return_inverse=True, return_counts=True)
    return surface.part(np.flatnonzero(counts[number.reshape(-1)] == 1))


def edges(surface, points=None):
    """Returns the sharp edges of a surface, with other points if given: sides of the body and of excavations."""
    from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges

    clean, sharp = vtkCleanPolyData(), vtkFeatureEdges()
    clean.SetInputData(polygons_of(surface.points if points is None else points, surface.polygons))
    clean.SetTolerance(1e-7)
    sharp.SetInputConnection(clean.GetOutputPort())
    sharp.SetFeatureAngle(SHARP)
    sharp.BoundaryEdgesOff()
    sharp.NonManifoldEdgesOff()
    sharp.ColoringOff()
    sharp.Update()
    found = sharp.GetOutput()
    if not found.GetNumberOfLines():
        return Part(np.zeros((0, 3)), [], FAINT)
    return Part(vtk_to_numpy(found.GetPoints().GetData()), read.cells(found.GetLines()), FAINT)


def box(bounds):
    """Returns the twelve edges of a box, an array (low, high)."""
    corners = np.array([[bounds[i, 0], bounds[j, 1], bounds[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    pairs = [np.array([a, a | bit]) for a in range(8) for bit in (1, 2, 4) if not a & bit]
    return Part(corners, pairs, FAINT)


def polygons_of(points, polygons):
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    data, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    offsets = np.cumsum([0, *map(len, polygons)])
    cells.SetData(
        *(
            numpy_to_vtkIdTypeArray(np.ascontiguousarray(x, dtype=np.int64), deep=True)
            for x in (offsets, np.concatenate(polygons))
        )
    )
    data.SetPoints(places)
    (data.SetLines if len(polygons[0]) == 2 else data.SetPolys)(cells)
    return data


def actor(part, lit=True):
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    data, mapper, made = polygons_of(part.points, part.polygons), vtkPolyDataMapper(), vtkActor()
    colours = to_rgb(part.colours) if isinstance(part.colours, str) else np.asarray(part.colours)[:, :3]
    colours = np.broadcast_to(np.round(255 * np.asarray(colours)), (len(part.polygons), 3))
    data.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(colours, dtype=np.uint8), deep=True))
    mapper.SetInputData(data)
    made.SetMapper(mapper)
    lines, look = len(part.polygons[0]) == 2, made.GetProperty()
    shade = LIGHT if lit and not lines else 0
    look.SetAmbient(1 - shade)
    look.SetDiffuse(shade)
    look.SetLineWidth(WIDTH)
    look.SetOpacity(part.opacity)
    look.SetInterpolationToFlat()
    return made


@cache
def window():
    """Returns the window of VTK. Starts an X server in memory, which ends with this process."""
    if not shutil.which("Xvfb"):
        raise PlotError("pictures of bodies require Xvfb; install it with apt-get install xvfb")
    (ready, write), (alive, _) = os.pipe(), os.pipe()  # the system closes the second pipe when this process ends
    server = f"Xvfb -displayfd {write} -screen 0 64x64x24 -nolisten tcp -noreset & read -r _; kill $!; wait"
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
    process = subprocess.Popen(["sh", "-c", server], pass_fds=[write], stdin=alive, **silent)
    process.returncode = 0  # it outlives this object
    os.close(write)
    os.close(alive)
    with os.fdopen(ready) as number:
        found = number.readline().strip()
    if not found:
        raise PlotError("pictures of bodies require Xvfb, which did not start")
    os.environ["DISPLAY"] = f":{found}"
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (backend)
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    made = vtkRenderWindow()
    made.SetOffScreenRendering(1)
    made.SetAlphaBitPlanes(1)
    made.SetMultiSamples(0)
    return made


def frame(bounds):
    """Returns (left, right), (bottom, top) of the box with a margin in the picture, m."""
    places = flat(box(bounds).points)
    low, high = places.min(axis=0), places.max(axis=0)
    room = ROOM * np.max(high - low)
    return np.column_stack([low - room, high + room])


def image(parts, bounds, lit=True):
    """Returns the image of parts, an array (height, width, 3) of bytes. Parallel lines remain parallel."""
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkWindowToImageFilter

    right, up, towards = directions()
    size, shown, renderer = np.ptp(frame(bounds), axis=1), window(), vtkRenderer()
    pixels = np.maximum(np.round(PIXELS * size / np.max(size)).astype(int), 2)
    middle = np.mean(frame(bounds), axis=1)
    centre = middle[0] * right + middle[1] * up
    renderer.SetBackground(1, 1, 1)
    renderer.SetUseDepthPeeling(any(part.opacity < 1 for part in parts))
    renderer.SetMaximumNumberOfPeels(30)
    for part in parts:
        if len(part.polygons):
            renderer.AddActor(actor(part, lit))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 10 * np.max(size) * towards))
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(0.5 * size[1])
    renderer.ResetCameraClippingRange()
    with read.messages():
        shown.SetSize(*map(int, pixels))
        shown.AddRenderer(renderer)
        shown.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(shown)
        grab.ReadFrontBufferOff()
        grab.Update()
        shown.RemoveRenderer(renderer)
    found = grab.GetOutput()
    width, height, _ = found.GetDimensions()
    return vtk_to_numpy(found.GetPointData().GetScalars()).reshape(height, width, 3)[::-1].copy()


def visible(surface, numbers, bounds):
    """Returns {number: places in the picture where faces with this number are visible (pixels, 2), m}.

    Colours of the image are the numbers, in the order of their values, plus one; the background is white."""
    found, code = np.unique(numbers, return_inverse=True)
    base = np.array([65536, 256, 1])
    colours = (code[:, None] + 1) // base % 256 / 255
    seen = image([Part(surface.points, surface.polygons, colours)], bounds, lit=False).astype(int) @ base
    (left, _), (_, top) = frame(bounds)
    step = np.ptp(frame(bounds)[0]) / seen.shape[1]
    rows, columns = np.nonzero((seen > 0) & (seen <= len(found)))
    places = np.column_stack([left + (columns + 0.5) * step, top - (rows + 0.5) * step])
    order = np.argsort(seen[rows, columns], kind="stable")
    counts = np.bincount(seen[rows, columns], minlength=len(found) + 1)[1 : len(found) + 1]
    return dict(zip(found.astype(int).tolist(), np.split(places[order], np.cumsum(counts)[:-1])))


def hidden(surface, numbers, places, bounds):
    """Returns the numbers of fractures of which less than the fraction SEEN of their own view is visible."""
    pixel = (np.ptp(frame(bounds), axis=1).max() / PIXELS) ** 2

    def area(polygon):
        x, y = flat(surface.points[polygon]).T
        return 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))

    whole = np.bincount(numbers.astype(int), [area(polygon) for polygon in surface.polygons])
    return [number for number, seen in places.items() if len(seen) * pixel < SEEN * whole[number]]


def inside(points, bounds):
    """Returns which points are in a box."""
    return np.all((points >= bounds[0]) & (points <= bounds[1]), axis=1)


def clipped(surface, bounds):
    """Returns the part of a surface inside of a box. Polygons across its sides are cut; values of points are left out."""
    from vtkmodules.vtkCommonDataModel import vtkPlane
    from vtkmodules.vtkFiltersCore import vtkClipPolyData

    data = polygons_of(surface.points, surface.polygons)
    number = numpy_to_vtk(np.arange(len(surface.polygons), dtype=np.int64), deep=True)
    number.SetName("number")
    data.GetCellData().AddArray(number)
    for k in range(3):
        for origin, sign in ((bounds[0], 1), (bounds[1], -1)):
            plane, clip = vtkPlane(), vtkClipPolyData()
            plane.SetOrigin(*origin)
            plane.SetNormal(*(sign * np.eye(3)[k]))
            clip.SetInputData(data)
            clip.SetClipFunction(plane)
            clip.Update()
            data = clip.GetOutput()
    of = read.arrays(data.GetCellData())["number"]
    values = {name: values[of] for name, values in surface.cell_data.items()}
    return read.Surface(vtk_to_numpy(data.GetPoints().GetData()), read.cells(data.GetPolys()), values, {})


def bounds_of(points):
    """Returns the box of points, (low, high). A plane body has a thin box."""
    low, high = points.min(axis=0), points.max(axis=0)
    room = np.where(high - low < NOISE * np.max(high - low), 0.02 * np.max(high - low), 0)
    return np.array([low - room, high + room])


def draw(ax, parts, bounds):
    """Draws parts in a box, with coordinates along three edges and an arrow to the north (y)."""
    window = frame(bounds)
    ax.imshow(image([*parts, box(bounds)], bounds), extent=window.ravel(), aspect="equal", zorder=0)
    ax.set_axis_off()
    corner = np.array([bounds[1, 0], bounds[0, 1], bounds[0, 2]])  # the lower corner in front
    size, middle = np.ptp(window, axis=1).max(), flat(np.mean(bounds, axis=0))
    for k, at in enumerate((corner, corner, bounds[0])):
        ends = np.tile(at, (2, 1))
        ends[:, k] = bounds[:, k]
        write_coordinates(ax, k, ends, size, middle)
    north, place = flat(np.array([0.0, 1, 0])), window[:, [0, 1]].diagonal() + size * np.array([0.02, -0.06])
    north *= 0.09 * size / np.linalg.norm(north)
    ax.text(*(place + 1.1 * north), "N", ha="center", va="center", fontsize=8)
    ax.annotate(
        "", place + 0.85 * north, place, arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1}, annotation_clip=False
    )


def write_coordinates(ax, k, ends, size, middle):
    """Writes coordinates along an edge, outside of the box, with as many numbers as have room."""
    along = np.diff(flat(ends), axis=0)[0]
    out = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    out *= np.sign(out @ (flat(ends).mean(axis=0) - middle))
    room = np.linalg.norm(along) / size
    low, high = ends[:, k]
    ticks = plt.MaxNLocator(4 if room > 0.45 else 2).tick_values(low, high) if room > 0.12 else [0.5 * (low + high)]
    first = 0.05 if k == 1 else -1e-9  # the first number on y would meet the last one on x
    ticks = [t for t in ticks if first <= (t - low) / (high - low) <= 1 + 1e-9] or [0.5 * (low + high)]
    aligned = {"ha": "right" if k == 2 else "center", "va": "center"}
    for t in ticks:
        at = ends[0].copy()
        at[k] = t
        ax.plot(*np.column_stack([flat(at), flat(at) + 0.012 * size * out]), color=INK, linewidth=0.7, clip_on=False)
        ax.text(*(flat(at) + (0.02 if k == 2 else 0.045) * size * out), f"{t:.4g}", fontsize=7, **aligned)
    ax.text(
        *(flat(ends).mean(axis=0) + (0.15 if k == 2 else 0.11) * size * out), f"{'xyz'[k]} (m)", fontsize=8, **aligned
    )


def along(line, n=20):
    """Returns n points on each segment of a line, and its end."""
    parts = np.arange(n)[:, None] / n
    return np.concatenate([a + parts * (b - a) for a, b in zip(line[:-1], line[1:])] + [line[-1:]])


def draw_wells(ax, wells):
    """Draws wells, {name: points}, in front of all faces, with a dot at the first point."""
    white = [patheffects.withStroke(linewidth=3, foreground="white")]
    for points in wells.values():
        ax.plot(*flat(points).T, color=WELL, linewidth=1.4, path_effects=white)
        ax.plot(*flat(points[:1]).T, "o", color=WELL, markersize=3.5, path_effects=white)


def write_names(ax, named, bounds, wells):
    """Writes names of wells, {name: points}, and of fractures, [(name, visible places)], the first ones first. Names
    cover neither each other nor wells."""
    extent = np.full(2, 1.5 * np.ptp(frame(bounds), axis=1).max())
    lines = {name: flat(points) for name, points in wells.items()}
    taken = [(part, np.full(2, 0.004 * extent[0])) for line in lines.values() for part in along(line)]
    tried = [(name, beside(line, name, extent)) for name, line in lines.items()]
    for name, places in named:
        order = np.argsort(np.linalg.norm(places - np.mean(places, axis=0), axis=1), kind="stable")
        tried.append((name, places[order[:: max(1, len(order) // MAX_PLACES)]]))
    for name, places in tried:
        found = place_of_name(name, places, extent, taken)
        if found:
            taken.append(found)
            text = ax.text(*found[0], name, fontsize=7, ha="center", va="center")
            text.set_path_effects([patheffects.withStroke(linewidth=1.5, foreground="white")])
