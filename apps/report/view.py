"""Data of the 3D view: rock, fractures and wells at several steps, for viewer.js.

Arrays are texts in base64, each one once; the data refer to them by number. Values are 16-bit numbers: fractions of the
range of a field, and displacements relative to the largest component."""

import base64
from dataclasses import dataclass, field

import bulk
import fractures
import maps
import numpy as np
import read
import shapes
import single_fractures
import space
from style import FACE_COLOURS, FACE_STATES, Quantity, limits, plt, when, without_noise

MAX_FRAMES = 25  # steps in the view
MAX_BYTES = 9e6  # of all frames, before the encoding in base64
RIBBON = 0.006  # width of a trace in 2D / size of the body
THROUGH = 0.12  # opacity of rock with fractures inside
PALETTES = {"slip": "YlOrRd", "tangential jump": "YlOrRd", "opening": "RdBu_r"}
SAMPLES = 12  # colours of a map
LARGEST = 65535  # of 16 bits


class Arrays(list):
    """Texts of arrays."""

    def __init__(self):
        super().__init__()
        self.numbers = {}

    def number(self, values, kind):
        """Returns the number of an array, which is added if it is new."""
        text = base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()
        if text not in self.numbers:
            self.numbers[text] = len(self)
            self.append(text)
        return self.numbers[text]


@dataclass
class Field:
    """Values of polygons, or of points, with a unit, a colour map and a sign."""

    values: np.ndarray
    unit: str
    colours: str
    on: str = "cells"
    signed: bool = False


@dataclass
class Frame:
    """A surface at one step: shape, displacement at its points, number of the fracture of each polygon, fields."""

    shape: shapes.Shape
    displacement: np.ndarray
    numbers: np.ndarray
    fields: dict = field(default_factory=dict)


def rock_fields(surface):
    """Returns {name: Field} of the surface of the rock."""
    data, found = surface.cell_data, {}
    if "displacement" in surface.point_data:
        size, scale = np.linalg.norm(surface.point_data["displacement"], axis=1), np.max(abs(data["stress"]), initial=0)
        found["displacement"] = Field(size, "m", "viridis", "points")
        found["von Mises stress"] = Field(without_noise(bulk.von_mises(data["stress"]), scale), "Pa", "inferno")
        compression = without_noise(bulk.largest_compression(data["stress"]), scale)
        found["largest compressive stress"] = Field(compression, "Pa", "cividis")
    for name, unit in (("pressure", "Pa"), ("temperature", "K")):
        if name in data:
            found[name] = Field(without_noise(data[name], 0), unit, "viridis")
    return found


def fracture_fields(data, sizes):
    """Returns {name: Field} of fractures; `sizes` as in fractures.scales."""
    found = {}
    if "state" in data:
        values = fractures.quantities(data, *sizes)
        for name in sorted(values, key=lambda name: name != "slip"):
            found[name] = Field(*values[name], PALETTES.get(name, "cividis"), signed=name == "opening")
        tendency = np.minimum(maps.slip_tendency(data, sizes[1]), maps.LARGEST_TENDENCY)
        found["shear traction / normal compression"] = Field(tendency, "", "plasma")
        found["contact state"] = Field(fractures.face_states(data).astype(float), "state", "")
    for name, unit in (("fracture pressure", "Pa"), ("hydraulic aperture", "m")):
        if name in data:
            found[name] = Field(data[name], unit, "viridis")
    return found


class Reader:
    """Reads frames. Steps with the same geometry share their shapes."""

    def __init__(self, directory):
        self.steps = {kind: dict(read.written_steps(directory, kind)) for kind in ("bulk", "fractures")}
        self.known = {}

    def shape(self, surface, make):
        """Returns the shape of a surface, made by a function if the geometry is new."""
        key = surface.points.tobytes() + np.concatenate(surface.polygons).tobytes()
        if key not in self.known:
            self.known[key] = make(surface)
        return self.known[key]

    def frames(self, time):
        """Returns {name of surface: Frame} of a step, its body and the edges of the rock."""
        grid = read.grid(self.steps["bulk"][time])
        joints = read.grid(self.steps["fractures"][time]) if time in self.steps["fractures"] else None
        plane, rock = read.is_plane(grid), read.surface(grid)
        skin = rock if plane else space.outer(rock)
        moves = "displacement" in rock.point_data
        shape = self.shape(skin, shapes.of_surface)
        moved = shape.at_points(rock.point_data["displacement"] if moves else np.zeros_like(rock.points))
        found = {"rock": Frame(shape, moved, None, rock_fields(skin))}
        if joints and joints.GetNumberOfCells():
            sizes = fractures.scales(grid, read.arrays(joints.GetCellData())) if moves else (0, 0)
            lines = read.segments(joints) if plane else shapes.merged(read.surface(joints))
            width = RIBBON * np.max(np.ptp(rock.points, axis=0))
            shape = self.shape(lines, (lambda x: shapes.of_traces(x, width)) if plane else shapes.of_surface)
            moved = np.zeros_like(lines.points)
            if moves:
                everywhere = grid.GetPoints().GetData(), grid.GetPointData().GetArray("displacement")
                moved = shapes.at_places(*map(space.vtk_to_numpy, everywhere), lines.points)
            numbers = lines.cell_data.get("single fracture", lines.cell_data["fracture"])
            found["fractures"] = Frame(shape, shape.at_points(moved), numbers, fracture_fields(lines.cell_data, sizes))
        return found, rock, np.zeros((0, 3)) if plane else ends(space.edges(skin))


def ends(part):
    """Returns the ends of lines, two points for each."""
    return part.points[np.array(part.polygons, dtype=int).reshape(-1, 2)].reshape(-1, 3)


def range_of(parts, signed):
    """Returns the common range of values, without the outliers of each part, and its ends as texts."""
    norms = [limits(part, signed, clip=True) for part in parts]
    low, high = min(norm.vmin for norm in norms), max(norm.vmax for norm in norms)
    below, above = any(np.any(part < low) for part in parts), any(np.any(part > high) for part in parts)
    return [low, high], f"{'≤ ' if below else ''}{low:.4g}", f"{'≥ ' if above else ''}{high:.4g}"


def description(name, fields):
    """Returns the description of a field with a common range, and its values in 16 bits for each frame."""
    unit, colours, shown = fields[0].unit, fields[0].colours, {"name": name, "on": fields[0].on}
    factor = 1
    if unit == "state":
        samples = FACE_COLOURS(range(len(FACE_STATES)))
        shown |= {"range": [0, len(FACE_STATES) - 1], "states": FACE_STATES}
    else:
        known = [one.values[np.isfinite(one.values)] for one in fields]
        if unit:
            in_unit = Quantity(name, unit, *known)
            factor, shown["name"] = in_unit.factor, in_unit.label
        shown["range"], shown["low"], shown["high"] = range_of([part / factor for part in known], fields[0].signed)
        samples = plt.get_cmap(colours)(np.linspace(0, 1, SAMPLES))
    low, high = shown["range"]
    parts = [np.clip((np.nan_to_num(one.values / factor, nan=low) - low) / ((high - low) or 1), 0, 1) for one in fields]
    return {**shown, "colours": np.round(samples[:, :3], 3).tolist()}, [np.round(LARGEST * part) for part in parts]


def surface_of(name, frames, centre, arrays, opacity):
    """Returns a surface for viewer.js; frames without it are None."""
    given = [frame for frame in frames if frame]
    names = [one for one in given[-1].fields if all(one in frame.fields for frame in given)]
    scale = max(np.max(np.abs(frame.displacement), initial=0) for frame in given) or 1
    thin = any(frame.shape.saved is not None for frame in given)
    described = []
    for one in names:
        fields = [frame.fields[one] for frame in given]
        on_points = fields[0].on == "points"
        values = [
            f.shape.at_points(x.values) if on_points else f.shape.of_polygons(x.values) for f, x in zip(given, fields)
        ]
        on = "points" if on_points or thin else "cells"
        whole = [
            Field(np.round(v) if x.unit == "state" else v, x.unit, x.colours, on, x.signed)
            for v, x in zip(values, fields)
        ]
        described.append(description(one, whole))
    written = iter(
        {
            "points": arrays.number(frame.shape.points - centre, np.float32),
            "triangles": arrays.number(frame.shape.triangles, np.uint32),
            "owner": arrays.number(frame.shape.owner, np.uint32),
            "displacement": arrays.number(np.round(frame.displacement / scale * (LARGEST // 2)), np.int16),
            "numbers": None if frame.numbers is None else arrays.number(frame.numbers, np.uint16),
            "values": [arrays.number(values[k], np.uint16) for _, values in described],
        }
        for k, frame in enumerate(given)
    )
    return {
        "name": name,
        "opacity": opacity,
        "scale": scale / (LARGEST // 2),
        "fields": [shown for shown, _ in described],
        "frames": [next(written) if frame else None for frame in frames],
    }


def wells(scene, plane, centre):
    """Returns the names and the points of wells with numbers as coordinates."""
    found = []
    for name, points in read.wells(scene, 2 if plane else 3).items():
        points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
        found.append({"name": name, "points": np.round(points - centre, 6).tolist()})
    return found


def labels(low, high, centre, plane):
    """Returns texts at corners of the box of the rock, with its coordinates; x points east and y north."""
    low, high = (np.where(abs(x) < 1e-9 * np.max(high - low), 0, x) for x in (low, high))
    places = [(0, " (E)", [high[0], low[1], low[2]]), (1, " (N)", [high[0], high[1], low[2]])]
    places += [] if plane else [(2, "", [low[0], low[1], high[2]])]
    found = [
        {"text": f"{'xyz'[k]} = {high[k]:.4g} m{'' if plane else way}", "at": (at - centre).tolist()}
        for k, way, at in places
    ]
    origin = ", ".join(f"{x:.4g}" for x in low[: 2 if plane else 3])
    return [*found, {"text": f"({origin}) m", "at": (low - centre).tolist()}]


def of_run(directory, content, scene, found=(), progress=lambda words: None):
    """Returns the data of written steps, evenly chosen, or None without a step; `scene` as in read.scene."""
    reader = Reader(directory)
    times = sorted(reader.steps["bulk"])
    if not times:
        return None
    last, rock, edges = reader.frames(times[-1])
    plane = read.is_plane(read.grid(reader.steps["bulk"][times[-1]]))
    size = sum(2 * sum(one.values.size for one in f.fields.values()) + 6 * len(f.displacement) for f in last.values())
    n_frames = int(np.clip(MAX_BYTES // size, 1, min(MAX_FRAMES, len(times))))
    times = [times[k] for k in np.unique(np.round(np.linspace(len(times) - 1, 0, n_frames)).astype(int))]
    frames = []
    for k, time in enumerate(times, 1):
        progress(f"view, step {k} of {len(times)}")
        frames.append(last if time == times[-1] else reader.frames(time)[0])
    low, high = rock.points.min(axis=0), rock.points.max(axis=0)
    centre, arrays = 0.5 * (low + high), Arrays()
    inside = "fractures" in last and not plane
    surfaces = [
        surface_of(
            name, [frame.get(name) for frame in frames], centre, arrays, THROUGH if inside and name == "rock" else 1.0
        )
        for name in last
    ]
    clock = content.get("time_unit", {"name": "s"})
    clock = None if clock["name"] == "s" else (clock["seconds"], clock["name"])
    moves = "displacement" in rock.point_data
    return {
        "time": times[-1],
        "times": [when(time, clock) for time in times],
        "surfaces": [surface for surface in surfaces if surface["fields"]],
        "edges": arrays.number(edges - centre if len(edges) else edges, np.float32),
        "wells": wells(scene, plane, centre),
        "labels": labels(low, high, centre, plane),
        "fractures": single_fractures.facts(content, found, clock, plane),
        "tables": single_fractures.tables(content, times, plane),
        "warp": bulk.warp_factor(rock.points, rock.point_data["displacement"]) if moves else 0,
        "camera": {"position": [0, 0, 1], "up": [0, 1, 0]} if plane else {"position": [0.6, -1, 0.45], "up": [0, 0, 1]},
        "arrays": arrays,
    }
