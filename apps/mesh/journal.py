"""Changes of fractures by repairs: a line for each file, and a table of all fractures."""
import csv
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from arrange import on_segment
from domain import in_polygon
from report import measure
from shapes import Plane

NOISE = 1e-9  # in diagonals of the domain: smaller changes are round-off
COLUMNS = ("file", "set", "fracture", "place", "state")
REASONS = {"short": "too short", "outside": "outside of the domain", "empty": "without geometry", "duplicate": "duplicate",
           "conflict": "in conflict with others"}  # of fractures left out


@dataclass
class Entry:
    """State of a fracture: points as given, measure in the mesh (length, area in 3D), largest movement in m, notes."""
    feature: object
    points: np.ndarray
    meshed: float = None
    moved: float = 0.0
    notes: list = field(default_factory=list)
    reason: str = ""  # of REASONS, if left out

    @property
    def given(self):
        return measure_of(self.points)


def measure_of(points):
    """Returns the length of a polyline or the area of a polygon."""
    if points.shape[1] == 2:
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    return float(Plane(points).area) if len(points) > 2 else 0.0


def distance(x, points):
    """Returns the distances of points x (n, dim) from a polyline or a plane polygon."""
    flat = points.shape[1] == 2
    ring = points if flat else np.concatenate([points, points[:1]])
    i, k = np.divmod(np.arange(len(x) * (len(ring) - 1)), len(ring) - 1)
    near = on_segment(x[i], ring[k], ring[k + 1])[1].reshape(len(x), -1).min(axis=1)
    if not flat:
        plane = Plane(points)
        over = in_polygon(plane.inside(x), plane.inside(points))
        near[over] = np.minimum(near[over], abs(plane.height(x[over])))
    return near


class Journal:
    """Entries of all fractures by their names for messages, in the order of the files."""

    def __init__(self, size):
        self.noise, self.entries, self.empty = NOISE * size, {}, []

    def start(self, fractures, empty):
        """Takes all fractures, and (file, reason) of features without geometry."""
        self.empty = empty
        for one in fractures:
            self.entries[one.name] = Entry(one, one.points)

    def of(self, feature):
        return self.entries.setdefault(feature.name, Entry(feature, feature.points))

    def leave_out(self, feature, why, reason):
        if feature.kind == "fracture":
            entry = self.of(feature)
            entry.meshed, entry.reason = 0.0, entry.reason or reason
            entry.notes.append(why)

    def state(self):
        """Returns the notes and reasons of all fractures by their names."""
        return {name: (list(entry.notes), entry.reason, entry.meshed) for name, entry in self.entries.items()}

    def restore(self, state, fractures):
        """Restores the state of these fractures after an attempt without a mesh."""
        for name in {one.name for one in fractures} & set(state):
            notes, self.entries[name].reason, self.entries[name].meshed = state[name]
            self.entries[name].notes = list(notes)

    def note(self, feature, why):
        if feature.kind == "fracture":
            notes = self.of(feature).notes
            notes += [] if why in notes else [why]

    def compare(self, mesh, plan):
        """Records the measure of each fracture in a mesh, and the largest distance of its nodes from its points."""
        size, faces = measure(mesh.points, mesh.faces), {}
        order = np.argsort(mesh.face_owner, kind="stable")
        first = np.searchsorted(mesh.face_owner[order], np.arange(len(plan.owners) + 1))
        for k, owner in enumerate(plan.owners):
            if owner.kind == "fracture":
                faces.setdefault(owner.name, []).append(order[first[k]:first[k + 1]])
        for name, found in faces.items():
            of, entry = np.concatenate(found), self.entries[name]
            entry.meshed = float(size[of].sum())
            nodes = mesh.points[np.unique(mesh.faces[of])][:, :plan.dim]
            entry.moved = float(distance(nodes, entry.points).max(initial=0))

    @property
    def why(self):
        return {name for name, entry in self.entries.items() if entry.reason}

    def state_of(self, entry):
        if entry.reason:
            return "left out"
        return "joined" if entry.moved > self.noise or entry.notes else "kept"

    def lines(self, dim):
        """Returns a line for each file."""
        what, unit, found, files = ("length", "m", [], {}) if dim == 2 else ("area", "m^2", [], {})
        for entry in self.entries.values():
            files.setdefault(entry.feature.source, []).append(entry)
        for path, _ in self.empty:
            files.setdefault(path, [])
        for path, entries in files.items():
            state, why = Counter(map(self.state_of, entries)), Counter(REASONS[e.reason] for e in entries if e.reason)
            unread = [REASONS["outside" if "outside of" in text else "empty"] for one, text in self.empty if one == path]
            why.update(unread)
            moved = max((e.moved for e in entries if not e.reason), default=0)
            total, meshed = sum(e.given for e in entries), sum(e.given if e.meshed is None else e.meshed for e in entries)
            n = len(entries) + len(unread)
            joined = f"{state['joined']} joined" + (f", moved by at most {moved:.3g} m" if moved > self.noise else "")
            left = ", ".join(f"{k} {text}" for text, k in why.items())
            found.append(f"{Path(path).name}: {n} fractures, {what} {total:.6g} {unit}, in the mesh {meshed:.6g} {unit}; {joined}; "
                         f"{sum(why.values())} left out" + (f" ({left})" if left else ""))
        return found

    def write(self, path, dim):
        unit = "length [m]" if dim == 2 else "area [m^2]"
        with open(path, "w", newline="", encoding="utf-8") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow([*COLUMNS, unit, f"{unit.replace(' [', ' in the mesh [')}", "largest movement [m]", "reason"])
            for entry in self.entries.values():
                f = entry.feature
                meshed = entry.given if entry.meshed is None else entry.meshed
                rows.writerow([f.source, f.group, f.single, f.name, self.state_of(entry), f"{entry.given:.9g}", f"{meshed:.9g}",
                               f"{entry.moved:.3g}" if entry.moved > self.noise else "0", "; ".join(entry.notes)])
            for path_of, why in self.empty:
                rows.writerow([path_of, "", "", "", "left out", "0", "0", "0", why])
