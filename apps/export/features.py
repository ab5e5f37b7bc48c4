"""Fractures of a step as shapes with attributes."""
import json
from collections import namedtuple

import fractures
import numpy as np
import read
from bulk import rim
from orientations import area_vector
from read import PlotError

# Lines or rings of points (n, 3), and {name: value} with names of at most ten letters, the limit of shapefiles.
Feature = namedtuple("Feature", "shapes attributes")
STRAIGHT = 1e-9  # sine of an angle that counts as zero


def corners_of(points, closed):
    """Returns the points of a line or ring with a change of direction, and the ends of a line."""
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    sizes = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    turns = np.linalg.norm(np.cross(before, after), axis=1) > STRAIGHT * sizes
    if not closed:
        turns[[0, -1]] = True
    return points[turns]


def line(surface, faces):
    """Returns the points of a trace from end to end; the faces are consecutive."""
    ends = [surface.points[surface.polygons[face][:2]] for face in faces]
    tolerance = 1e-9 * np.max(np.ptp(surface.points, axis=0))
    if len(ends) > 1 and np.min(np.linalg.norm(ends[1] - ends[0][0], axis=1)) < tolerance:
        ends[0] = ends[0][::-1]
    points = list(ends[0])
    for a, b in ends[1:]:
        points.append(b if np.linalg.norm(a - points[-1]) < tolerance else a)
    return corners_of(np.array(points), closed=False)


def ring(surface):
    """Returns the outline of a plane fracture, or None if it is not plane or has several outlines."""
    normals = np.array([area_vector(x) for x in surface.corners()])
    mean = normals.sum(axis=0)
    across = np.linalg.norm(np.cross(normals, mean), axis=1)
    if np.any(across >= 1e-6 * np.linalg.norm(normals, axis=1) * np.linalg.norm(mean)):  # >= also for a zero mean
        return None
    edges = surface.points[rim(surface, None)]
    place = np.unique(
        np.round(edges.reshape(-1, 3) / (1e-9 * np.max(np.ptp(surface.points, axis=0)))), axis=0, return_inverse=True
    )[1].reshape(-1, 2)
    onward = {a: (b, edges[k, 0]) for k, (a, b) in enumerate(place)}
    at, points = place[0, 0], []
    while at in onward:
        at, point = onward.pop(at)
        points.append(point)
    return None if onward or at != place[0, 0] else corners_of(np.array(points), closed=True)


def attributes(data, faces, sizes, name, group, plane):
    """Returns means over length or area, maxima, and shares of the contact states."""

    def mean(values):
        return float(np.average(values, weights=sizes))

    local = data["traction local"][faces]
    normal, shear = mean(local[:, 0]), mean(np.linalg.norm(local[:, 1:], axis=1))
    state = data["state"][faces]
    found = {
        "name": name,
        "set": group,
        "length" if plane else "area": float(sizes.sum()),
        "slip_mean": mean(data["slip"][faces]),
        "slip_max": float(np.max(data["slip"][faces])),
        "open_mean": mean(data["opening"][faces]),
        "open_max": float(np.max(data["opening"][faces])),
        "normal_tr": normal,
        "shear_tr": shear,
        "tendency": shear / -normal if normal < 0 else None,
        "part_slip": mean(state == 2),
        "part_open": mean(state == 0),
    }
    if "fracture pressure" in data:
        found["pressure"] = mean(data["fracture pressure"][faces])
    return found


def groups(surface, sets, singles, plane):
    """Yields (name, set, faces) of each single fracture if the run has them, else of each trace (3D: set)."""
    data = surface.cell_data
    if singles and "single fracture" in data:
        for k, one in enumerate(singles):
            faces = np.flatnonzero(data["single fracture"] == k)
            if len(faces):
                yield one["name"], one["set"], faces
        return
    for number in np.unique(data["fracture"].astype(int)):
        name = sets[number] if number < len(sets) else f"fracture {number}"
        for trace in fractures.traces_of(surface, number, name) if plane else ():
            yield trace.name, name, np.array(trace.faces)
        if not plane:
            yield name, name, np.flatnonzero(data["fracture"] == number)


def shapes(part, plane):
    """Returns the shapes of the faces of one fracture."""
    if plane:
        return [line(part, chain) for chain, _ in fractures.chains(part)]
    outline = ring(part)
    return [outline] if outline is not None else part.corners()


def of_run(directory, time=None):
    """Returns the features of the last written step, or the one nearest to `time`, and whether the problem is 2D."""
    content = read.results(directory)
    written = read.written_steps(directory, "fractures")
    if not written:
        raise PlotError(
            f"{directory}: contains no fractures.pvd: the run has no fractures, or its Output has \"vtu\" false"
        )
    at, file = written[-1] if time is None else min(written, key=lambda step: abs(step[0] - time))
    grid = read.grid(file)
    data = read.arrays(grid.GetCellData())
    if not grid.GetNumberOfCells() or "state" not in data:
        raise PlotError(f"{directory}: fractures.pvd contains no results of mechanics")
    plane = grid.GetCell(0).GetCellDimension() == 1
    surface = read.segments(grid) if plane else read.surface(grid)
    sizes = np.array(
        [np.linalg.norm(x[1] - x[0]) if plane else np.linalg.norm(area_vector(x)) for x in surface.corners()]
    )
    sets = next((sorted(step["fractures"]) for step in reversed(content["steps"]) if "fractures" in step), [])
    found = []
    for name, group, faces in groups(surface, sets, content.get("single_fractures"), plane):
        part = read.Surface(surface.points, [surface.polygons[face] for face in faces], {}, {})
        values = attributes(surface.cell_data, faces, sizes[faces], name, group, plane)
        found.append(Feature(shapes(part, plane), {**values, "time": at}))
    return found, plane


def as_geojson(found, plane, crs):
    """Returns the text of a GeoJSON file. Without a coordinate system, "crs" is null for a local one."""

    def coordinates(shape):
        points = shape[:, : 2 if plane else 3].tolist()
        return points if plane else [points + points[:1]]

    content = {
        "type": "FeatureCollection",
        "crs": crs and {"type": "name", "properties": {"name": crs}},
        "features": [],
    }
    for feature in found:
        kind, inner = "LineString" if plane else "Polygon", [coordinates(shape) for shape in feature.shapes]
        geometry = (
            {"type": kind, "coordinates": inner[0]}
            if len(inner) == 1
            else {"type": f"Multi{kind}", "coordinates": inner}
        )
        content["features"].append({"type": "Feature", "properties": feature.attributes, "geometry": geometry})
    return json.dumps(content, indent=1) + "\n"
