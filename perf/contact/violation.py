"""How far a state of the fractures is from the laws of contact and friction, computed from what a run wrote.

The conditions are (10)-(14) of Wollmann (2024); see docs/theory.md, section 2. Nothing of the solver is used: jumps,
tractions, plastic jumps and states come from fractures.pvd, the laws of the joints from effective_input.xml."""
import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field

import numpy as np

import read  # of apps/plot

OPEN, STICK, SLIP = 0, 1, 2
PARTS = ("penetration", "tension", "gap under load", "beyond friction", "direction")
BULK_STEPS = 20  # of the steps written, as many are looked at for the largest displacement


@dataclass
class Joint:
    stiffness: float
    friction: float
    dilation: float  # tan(theta)
    gap: float
    closure: float
    normal_stiffness: float

    def closed_gap(self, slip, normal):
        """g of (14) for a plastic jump of this size and a normal traction."""
        load = np.maximum(-normal, 0)
        closing = self.closure * load / (self.closure * self.normal_stiffness + load) if self.closure > 0 else 0
        return self.gap + self.dilation * slip - closing


class Input:
    """What effective_input.xml says."""

    def __init__(self, path):
        self.root = xml.parse(path).getroot()
        self.joints = [self._joint(self.text("Fractures", name, "material")) for name in self.names("Fractures")]
        rocks = [self.rock(name) for name in self.names("Materials") if self.text("Materials", name, "type") == "elastic"]
        self.modulus = min(rock["E"] for rock in rocks)

    def _list(self, *path):
        node = self.root
        for name in path:
            node = next((child for child in node if child.tag == "ParameterList" and child.get("name") == name), None)
            if node is None:
                return []
        return node

    def names(self, *path):
        return sorted(child.get("name") for child in self._list(*path) if child.tag == "ParameterList")

    def text(self, *path):
        for child in self._list(*path[:-1]):
            if child.get("name") == path[-1]:
                return child.get("value")
        return None

    def number(self, *path, default=None):
        value = self.text(*path)
        return default if value is None else math.inf if value == "infinite" else float(value)

    def numbers(self, *path):
        return [float(word) for word in self.text(*path).strip("{} ").split(",")]

    def rock(self, name):
        """E, nu, G and lambda of a material that is given by two of these."""
        given = {key: self.number("Materials", name, long) for key, long in (
            ("E", "Young's modulus"), ("nu", "Poisson's ratio"), ("G", "shear modulus"), ("lam", "Lame's first parameter"))}
        if given["E"] is not None:
            given["G"] = given["E"] / (2 * (1 + given["nu"]))
            given["lam"] = 2 * given["G"] * given["nu"] / (1 - 2 * given["nu"])
        elif given["lam"] is None:
            given["lam"] = 2 * given["G"] * given["nu"] / (1 - 2 * given["nu"])
        given["E"] = given["G"] * (3 * given["lam"] + 2 * given["G"]) / (given["lam"] + given["G"])
        return given

    def _joint(self, name):
        def number(entry, default):
            return self.number("Materials", name, entry, default=default)
        for role, kind in (("friction", "Coulomb"), ("closure", "Barton-Bandis"), ("dilation", "constant angle"),
                           ("tangential elasticity", "linear"), ("bond", "none"), ("damage", "none")):
            if self.text("Materials", name, role) not in (None, kind):
                raise ValueError(f"joint {name}: only {role} {kind} is known here")
        angle = number("friction angle", None)
        friction = number("friction coefficient", None) if angle is None else math.tan(math.radians(angle))
        return Joint(number("tangential stiffness", math.inf), friction, math.tan(math.radians(number("dilation angle", 0))),
                     number("initial gap", 0), number("maximum closure", 0), number("normal stiffness", 1))


@dataclass
class Faces:
    """The fracture faces of one step, sorted by fracture and place. Vectors have the normal component first."""
    time: float
    centre: np.ndarray
    fracture: np.ndarray
    state: np.ndarray
    jump: np.ndarray
    plastic: np.ndarray
    traction: np.ndarray
    pressure: np.ndarray = field(default=None)  # of the fluid, where there is some
    bound: np.ndarray = field(default=None)  # mu N
    distance: np.ndarray = field(default=None)  # w_n - g


def sorted_by_place(centre, fracture, extent):
    """The order of faces in Faces, which does not depend on the number of ranks."""
    place = np.round(centre / extent * 1e8).astype(np.int64)
    return np.lexsort((place[:, 2], place[:, 1], place[:, 0], fracture))


def faces(time, file, joints, extent):
    grid = read.grid(file)
    data = read.arrays(grid.GetCellData())
    points = read.vtk_to_numpy(grid.GetPoints().GetData())
    centre = np.array([points[cell].mean(axis=0) for cell in read.cells(grid.GetCells())])
    order = sorted_by_place(centre, data["fracture"], extent)
    f = Faces(time, centre[order], data["fracture"].astype(int)[order], data["state"].astype(int)[order],
              *(data[name][order] for name in ("jump local", "plastic jump local", "traction local")),
              data["fluid pressure"][order] if "fluid pressure" in data else np.zeros(len(order)))
    slip, normal = np.linalg.norm(f.plastic[:, 1:], axis=1), f.traction[:, 0]
    f.bound, f.distance = np.empty(len(slip)), np.empty(len(slip))
    for k, joint in enumerate(joints):
        on = f.fracture == k
        f.bound[on] = joint.friction * np.maximum(-normal[on], 0)
        f.distance[on] = f.jump[on, 0] - joint.closed_gap(slip[on], normal[on])
    return f


@dataclass
class Scales:
    length: float    # largest displacement of a node in the run
    traction: float  # largest traction or fluid pressure on a face in the run, at least 1e-9 E u/L
    extent: float


def history(directory, input_):
    """The faces of every written step, and the scales of the run."""
    bulk = read.written_steps(directory, "bulk")
    grid = read.grid(bulk[0][1])
    bounds = np.reshape(grid.GetBounds(), (3, 2))
    extent = (bounds[:, 1] - bounds[:, 0]).max()
    length = 0
    for _, file in bulk[::-(len(bulk) // -BULK_STEPS)] + bulk[-1:]:
        displacement = read.arrays(read.grid(file).GetPointData())["displacement"]
        length = max(length, np.linalg.norm(displacement, axis=1).max())
    steps = [faces(time, file, input_.joints, extent) for time, file in read.written_steps(directory, "fractures")]
    traction = max(max(np.linalg.norm(step.traction, axis=1).max(), np.abs(step.pressure).max()) for step in steps)
    return steps, Scales(length, max(traction, 1e-9 * input_.modulus * length / extent), extent)


def violation(step, before, scales):
    """The largest violation over the faces, one number for each of PARTS, relative to the scales. `before` are the faces
    at the start of the step, None where the increment of the plastic jump is not known."""
    shear = np.linalg.norm(step.traction[:, 1:], axis=1)
    load = np.maximum(-step.traction[:, 0], 0) / scales.traction
    worst = [(-step.distance).max() / scales.length, step.traction[:, 0].max() / scales.traction,
             np.minimum(load, np.maximum(step.distance, 0) / scales.length).max(),
             (shear - step.bound).max() / scales.traction, 0]
    if before is not None:
        worst[4] = _wrong_increment(step, before, shear, scales)
    return np.maximum(worst, 0)


def _wrong_increment(step, before, shear, scales):
    """The part of the plastic increment that (11) forbids: all of it on faces that stick, on those that slip what is not along
    the traction; also the increment where the shear is below the bound. Open faces move freely, and so do faces without
    friction and those that touch without load: an increment counts no more than the load that forbids it."""
    increment = step.plastic[:, 1:] - before.plastic[:, 1:]
    size = np.linalg.norm(increment, axis=1) / scales.length
    along = step.traction[:, 1:] / np.where(shear > 0, shear, 1)[:, None]
    forward = np.maximum((increment * along).sum(axis=1), 0)
    across = np.linalg.norm(increment - forward[:, None] * along, axis=1) / scales.length
    wrong = np.maximum(np.minimum(across, shear / scales.traction), np.minimum(size, (step.bound - shear) / scales.traction))
    load = np.maximum(-step.traction[:, 0], 0) / scales.traction
    return max(np.where(step.state == SLIP, wrong, 0).max(), np.where(step.state == STICK, np.minimum(size, load), 0).max())


def largest(directory, results, input_):
    """The faces of each step, the violation of the run by parts, and how many steps were not judged by direction."""
    steps, scales = history(directory, input_)
    numbered = list(enumerate(results["steps"]))
    at = {round(step["time"], 9): k for k, step in reversed(numbered)}  # one that failed at once has the time of the one before
    worst, skipped, last = np.zeros(len(PARTS)), 0, -1
    for k, step in enumerate(steps):
        if round(step.time, 9) not in at:  # the run was ended before results.json told of it
            break
        number = at[round(step.time, 9)]
        before = steps[k - 1] if k else None
        if number == 0:  # from rest
            before = Faces(0, *(np.zeros_like(getattr(step, name)) for name in (
                "centre", "fracture", "state", "jump", "plastic", "traction")))
        known = number == last + 1 and results["steps"][number]["substeps"] == 1
        worst = np.maximum(worst, violation(step, before if known else None, scales))
        skipped, last = skipped + (not known), number
    return steps, scales, worst, skipped


def differing(one, other, scales, tolerance=1e-9):
    """Faces whose states differ between two runs of the same scene: (time, place, states, distance from the limit),
    and whether that distance is within the tolerance."""
    found = []
    for a, b in zip(one, other):
        for f in np.flatnonzero(a.state != b.state):
            away = 0
            for run in (a, b):
                normal = max(abs(run.traction[f, 0]) / scales.traction, abs(run.distance[f]) / scales.length)
                friction = abs(np.linalg.norm(run.traction[f, 1:]) - run.bound[f]) / scales.traction
                away = max(away, normal if OPEN in (a.state[f], b.state[f]) else friction)
            found.append((a.time, a.centre[f], (a.state[f], b.state[f]), away, away <= tolerance))
    return found
