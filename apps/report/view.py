"""Data of the 3D view: surface of the rock and fractures, with fields, as arrays in base64 for viewer.js."""
import base64

import bulk
import fractures
import maps
import numpy as np
import read
from style import STATE_COLOURS, STATES, Quantity, limits, plt, without_noise

MAX_TRIANGLES = 60000  # of each surface; larger surfaces are decimated
RIBBON = 0.006  # width of a trace in 2D / size of the body
THROUGH = 0.12  # opacity of rock with fractures inside
PALETTES = {"slip": "YlOrRd", "tangential jump": "YlOrRd", "opening": "RdBu_r"}
SAMPLES = 12  # colours of a map
SHARPEST = 30  # degrees; edges with larger angles are preserved


def encoded(values, kind):
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()


def field(name, values, base, colours, on, signed=False):
    """Returns a field in a readable unit, with the same colour range as in the pictures."""
    quantity = Quantity(name, base, values) if base else None
    values, label = (quantity(values), quantity.label) if base else (np.asarray(values), name)
    known = values[np.isfinite(values)]
    norm = limits(known, signed, clip=True)
    ends = [
        f"{'≤ ' if norm.extend in ('min', 'both') else ''}{norm.vmin:.4g}",
        f"{'≥ ' if norm.extend in ('max', 'both') else ''}{norm.vmax:.4g}",
    ]
    samples = plt.get_cmap(colours)(np.linspace(0, 1, SAMPLES))[:, :3]
    return {
        "name": label,
        "on": on,
        "values": np.nan_to_num(values, nan=norm.vmin),
        "range": [norm.vmin, norm.vmax],
        "low": ends[0],
        "high": ends[1],
        "colours": np.round(samples, 3).tolist(),
    }


def states(values):
    colours = [list(np.round(STATE_COLOURS(k)[:3], 3)) for k in range(len(STATES))]
    return {
        "name": "contact state",
        "on": "cells",
        "values": values,
        "range": [0, len(STATES) - 1],
        "states": STATES,
        "colours": colours,
    }


def triangulated(surface):
    """Returns triangles (n, 3) and the index of the polygon of each."""
    owner = np.repeat(np.arange(len(surface.polygons)), [len(p) - 2 for p in surface.polygons])
    return bulk.triangles(surface.polygons), owner


def thinned(points, triangles, arrays):
    """Returns a decimated surface, and the arrays at its points."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkDecimatePro

    data, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells.SetCells(
        len(triangles), numpy_to_vtkIdTypeArray(np.insert(triangles, 0, 3, axis=1).ravel().astype(np.int64), deep=True)
    )
    data.SetPoints(places)
    data.SetPolys(cells)
    number = numpy_to_vtk(np.arange(len(points), dtype=float), deep=True)
    number.SetName("number")
    data.GetPointData().AddArray(number)
    decimate = vtkDecimatePro()
    decimate.SetInputData(data)
    decimate.SetTargetReduction(1 - MAX_TRIANGLES / len(triangles))
    decimate.SetFeatureAngle(SHARPEST)
    decimate.PreserveTopologyOff()
    decimate.Update()
    out = decimate.GetOutput()
    selected = vtk_to_numpy(out.GetPointData().GetArray("number")).astype(int)
    return points[selected], vtk_to_numpy(out.GetPolys().GetConnectivityArray()).reshape(-1, 3), [a[selected] for a in arrays]


def means_at_points(n_points, triangles, values):
    """Returns at each point the mean of the values of the adjacent triangles."""
    corners, total = triangles.ravel(), np.repeat(values, 3)
    count = np.bincount(corners, minlength=n_points)
    return np.bincount(corners, total, minlength=n_points) / np.maximum(count, 1)


def content(name, points, triangles, fields, displacement, opacity=1.0):
    """Returns a surface for viewer.js. A decimated surface has all fields on points, with rounded states."""
    if len(triangles) > MAX_TRIANGLES:
        on_points = [
            f["values"] if f["on"] == "points" else means_at_points(len(points), triangles, f["values"]) for f in fields
        ]
        points, triangles, (displacement, *on_points) = thinned(points, triangles, [displacement, *on_points])
        fields = [
            {**f, "on": "points", "values": np.round(v) if "states" in f else v} for f, v in zip(fields, on_points)
        ]
    return {
        "name": name,
        "points": encoded(points, np.float32),
        "triangles": encoded(triangles, np.uint32),
        "opacity": opacity,
        "displacement": encoded(displacement, np.float32),
        "fields": [{**f, "values": encoded(f["values"], np.float32)} for f in fields],
    }


def of_rock(surface, centre, through):
    """Returns the surface of the rock; `through` makes it transparent to show fractures."""
    triangles, owner = triangulated(surface)
    fields = []
    if "displacement" in surface.point_data:
        size, stress = np.linalg.norm(surface.point_data["displacement"], axis=1), surface.cell_data["stress"]
        scale = np.max(abs(stress), initial=0)
        fields += [
            field("displacement", size, "m", "viridis", "points"),
            field("von Mises stress", without_noise(bulk.von_mises(stress), scale)[owner], "Pa", "inferno", "cells"),
            field(
                "largest compressive stress",
                without_noise(bulk.largest_compression(stress), scale)[owner],
                "Pa",
                "cividis",
                "cells",
            ),
        ]
    for name, base in (("pressure", "Pa"), ("temperature", "K")):
        if name in surface.cell_data:
            fields.append(field(name, without_noise(surface.cell_data[name], 0)[owner], base, "viridis", "cells"))
    displacement = surface.point_data.get("displacement", np.zeros_like(surface.points))
    return content("rock", surface.points - centre, triangles, fields, displacement, THROUGH if through else 1.0)


def at_places(points, values, places):
    """Returns at each place the mean of the values at the points there."""
    everywhere = np.concatenate([points, places])
    tolerance = 1e-9 * np.max(np.ptp(everywhere, axis=0))
    number = np.unique(np.round(everywhere / tolerance), axis=0, return_inverse=True)[1].reshape(-1)
    count = np.bincount(number[: len(points)], minlength=number.max() + 1)
    total = np.column_stack(
        [np.bincount(number[: len(points)], values[:, k], minlength=number.max() + 1) for k in range(3)]
    )
    return (total / np.maximum(count, 1)[:, None])[number[len(points) :]]


def ribbons(lines, width):
    """Returns bands for traces, two triangles for each face, slightly above the rock.

    Returns points, triangles, the face of each triangle, and the original point of each point."""
    first, second = (np.array([p[k] for p in lines.polygons]) for k in (0, 1))
    along = lines.points[second] - lines.points[first]
    across = (
        0.5
        * width
        * np.column_stack([-along[:, 1], along[:, 0], 0 * along[:, 0]])
        / np.linalg.norm(along, axis=1)[:, None]
    )
    across[:, 2] = 0
    above = [0, 0, 0.5 * width]
    ends = np.stack(
        [
            lines.points[first] - across,
            lines.points[second] - across,
            lines.points[second] + across,
            lines.points[first] + across,
        ],
        1,
    )
    corner = 4 * np.arange(len(first))[:, None]
    triangles = np.concatenate([corner + [0, 1, 2], corner + [0, 2, 3]], 1).reshape(-1, 3)
    return (
        ends.reshape(-1, 3) + above,
        triangles,
        np.repeat(np.arange(len(first)), 2),
        np.stack([first, second, second, first], 1).ravel(),
    )


def of_fractures(joints, rock, plane, centre, sizes):
    surface = read.segments(joints) if plane else read.surface(joints)
    data = surface.cell_data
    moved = np.zeros_like(surface.points)
    if "displacement" in rock.point_data:
        moved = at_places(rock.points, rock.point_data["displacement"], surface.points)
    points = surface.points
    if plane:
        points, triangles, owner, of_point = ribbons(surface, RIBBON * np.max(np.ptp(rock.points, axis=0)))
        moved = moved[of_point]
    else:
        triangles, owner = triangulated(surface)
    fields = []
    if "state" in data:
        for name, (values, base) in fractures.quantities(data, *sizes).items():
            fields.append(field(name, values[owner], base, PALETTES.get(name, "cividis"), "cells", name == "opening"))
        fields.sort(key=lambda f: not f["name"].startswith("slip"))
        fields += [
            field(
                "shear traction / normal compression",
                np.minimum(maps.slip_tendency(data, sizes[1]), maps.LARGEST_TENDENCY)[owner],
                "",
                "plasma",
                "cells",
            ),
            states(data["state"][owner].astype(float)),
        ]
    if "fracture pressure" in data:
        fields.append(field("pressure", data["fracture pressure"][owner], "Pa", "viridis", "cells"))
    return content("fractures", points - centre, triangles, fields, moved)


def of_run(directory):
    """Returns the data of the last written step, or None without one."""
    steps = {kind: dict(read.written_steps(directory, kind)) for kind in ("bulk", "fractures")}
    if not steps["bulk"]:
        return None
    time = max(steps["bulk"])
    grid = read.grid(steps["bulk"][time])
    joints = read.grid(steps["fractures"][time]) if time in steps["fractures"] else None
    joints = joints if joints and joints.GetNumberOfCells() else None
    plane, rock = read.is_plane(grid), read.surface(grid)
    centre = 0.5 * (rock.points.min(axis=0) + rock.points.max(axis=0))
    surfaces = [of_rock(rock, centre, joints and not plane)]
    if joints:
        sizes = (
            fractures.scales(grid, read.arrays(joints.GetCellData())) if "displacement" in rock.point_data else (0, 0)
        )
        inside = read.Surface(*points_of(grid)) if not plane else rock
        surfaces.append(of_fractures(joints, inside, plane, centre, sizes))
    surfaces = [surface for surface in surfaces if surface["fields"]]
    warp = bulk.warp_factor(rock.points, rock.point_data["displacement"]) if "displacement" in rock.point_data else 0
    camera = {"position": [0, 0, 1], "up": [0, 1, 0]} if plane else {"position": [0.6, -1, 0.45], "up": [0, 0, 1]}
    return {"time": time, "surfaces": surfaces, "warp": warp, "camera": camera}


def points_of(grid):
    """Returns all points of a grid with their data, as arguments of a surface without polygons."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return vtk_to_numpy(grid.GetPoints().GetData()), [], {}, read.arrays(grid.GetPointData())
