"""Violation of the contact and friction laws by a state of the fractures, computed from the output of a run.

The conditions are (10)-(14) of Wollmann (2024); see docs/model/model.md. The check uses nothing of the solver.
Jumps, tractions, plastic jumps, states and histories are read from fractures.pvd, the joint laws
(joint_laws.py) from effective_input.xml. Laws with a history are evaluated with its value at the end of the
step; the change of the history in the step is checked, too."""
import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np

import read
from joint_laws import JointLaw

OPEN, STICK, SLIP = 0, 1, 2
PARTS = ("penetration", "tension", "gap under load", "beyond friction", "direction", "history")
HISTORIES = ("accumulated slip", "opening by slip", "largest compression", "damage of bond", "damage history",
             "error of damage history", "damage of friction", "damage of dilation")
FIRST_KINDS = {"friction": "Coulomb", "closure": "Barton-Bandis", "dilation": "constant angle", "tangential elasticity": "linear",
               "bond": "none", "damage": "none", "damage driver": "slip"}
TINY = 1e-300  # scale of a run without displacements
BULK_STEPS = 20  # number of written steps that are searched for the largest displacement


@dataclass
class Joint:
    """Joint with the laws that have exact solutions and known energies."""
    stiffness: float
    friction: float
    dilation: float  # tan(theta)
    gap: float
    closure: float
    normal_stiffness: float

    def closed_gap(self, slip, normal):
        """Gap g of (14) for a slip (size of the plastic jump) and a normal traction."""
        load = np.maximum(-normal, 0)
        closing = self.closure * load / (self.closure * self.normal_stiffness + load) if self.closure > 0 else 0
        return self.gap + self.dilation * slip - closing


def parsed(value, default=None):
    return default if value is None else math.inf if value == "infinite" else float(value)


class Input:
    """Content of effective_input.xml."""

    def __init__(self, path):
        self.root = xml.parse(path).getroot()
        self.laws = [self._law(self.text("Fractures", name, "material")) for name in self.names("Fractures")]
        rocks = [self.rock(name) for name in self.names("Materials") if self.text("Materials", name, "type") == "elastic"]
        self.modulus = min(rock["E"] for rock in rocks)

    @cached_property
    def joints(self):
        """[fracture] Joints; raises ValueError for laws that `Joint` does not have."""
        return [self._joint(self.text("Fractures", name, "material")) for name in self.names("Fractures")]

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
        return parsed(self.text(*path), default)

    def numbers(self, *path):
        return [float(word) for word in self.text(*path).strip("{} ").split(",")]

    def rock(self, name):
        """E, nu, G and lambda of a material, computed from the two given constants."""
        given = {key: self.number("Materials", name, long) for key, long in (
            ("E", "Young's modulus"), ("nu", "Poisson's ratio"), ("G", "shear modulus"), ("lam", "Lame's first parameter"))}
        if given["E"] is not None:
            given["G"] = given["E"] / (2 * (1 + given["nu"]))
            given["lam"] = 2 * given["G"] * given["nu"] / (1 - 2 * given["nu"])
        elif given["lam"] is None:
            given["lam"] = 2 * given["G"] * given["nu"] / (1 - 2 * given["nu"])
        given["E"] = given["G"] * (3 * given["lam"] + 2 * given["G"]) / (given["lam"] + given["G"])
        return given

    def of_singles(self, singles):
        """Joint laws of single fractures as listed in results.json, with their individual entries."""
        shared = {name: self._law(self.text("Fractures", name, "material")) for name in self.names("Fractures")}
        own = [one.get("own_joint", {}) for one in singles]
        return [self._law(entries["material"], entries) if entries else shared[one["set"]] for one, entries in zip(singles, own)]

    def _law(self, name, own={}):
        return JointLaw(lambda entry, default: parsed(own.get(entry, self.text("Materials", name, entry)), default),
                        lambda role: own.get(role) or self.text("Materials", name, role) or FIRST_KINDS[role])

    def _joint(self, name):
        def number(entry, default):
            return self.number("Materials", name, entry, default=default)
        for role, kind in FIRST_KINDS.items():
            if role != "damage driver" and self.text("Materials", name, role) not in (None, kind):
                raise ValueError(f"joint {name}: only {role} {kind} is known here")
        angle = number("friction angle", None)
        friction = number("friction coefficient", None) if angle is None else math.tan(math.radians(angle))
        return Joint(number("tangential stiffness", math.inf), friction, math.tan(math.radians(number("dilation angle", 0))),
                     number("initial gap", 0), number("maximum closure", 0), number("normal stiffness", 1))


@dataclass
class Faces:
    """Fracture faces of one step, sorted by fracture and place. Vectors have the normal component first."""
    time: float
    centre: np.ndarray
    fracture: np.ndarray
    state: np.ndarray
    jump: np.ndarray
    plastic: np.ndarray
    traction: np.ndarray
    pressure: np.ndarray = field(default=None)  # of the fluid; 0 without fluid
    history: dict = field(default_factory=dict)  # history fields; 0 for joints without history
    bound: np.ndarray = field(default=None)  # of the shear traction, by friction and bond
    distance: np.ndarray = field(default=None)  # w_n - g
    strength: np.ndarray = field(default=None)  # tensile strength of a bond

    @property
    def normal(self):
        return self.traction[:, 0]

    @property
    def slip(self):
        return np.linalg.norm(self.plastic[:, 1:], axis=1)

    def on(self, which):
        """Returns a subset of the faces, without the bounds."""
        return Faces(self.time, **{f.name: getattr(self, f.name)[which] for f in fields(Faces)[1:8]},
                     history={name: values[which] for name, values in self.history.items()})

    @classmethod
    def at_rest(cls, like):
        zeros = {f.name: np.zeros_like(getattr(like, f.name)) for f in fields(cls)[1:8]}
        return cls(0, **zeros, history={name: np.zeros_like(values) for name, values in like.history.items()})


def sorted_by_place(centre, fracture, extent):
    """Returns the order of faces in `Faces`, which does not depend on the number of ranks."""
    place = np.round(centre / extent * 1e8).astype(np.int64)
    return np.lexsort((place[:, 2], place[:, 1], place[:, 0], fracture))


def faces(time, file, laws, extent, group="fracture"):
    """Reads the faces of one step. `group` names the array with the law numbers, stored as `fracture`."""
    grid = read.grid(file)
    data = read.arrays(grid.GetCellData())
    points = read.vtk_to_numpy(grid.GetPoints().GetData())
    centre = np.array([points[cell].mean(axis=0) for cell in read.cells(grid.GetCells())])
    order = sorted_by_place(centre, data[group], extent)
    f = Faces(time, centre[order], data[group].astype(int)[order], data["state"].astype(int)[order],
              *(data[name][order] for name in ("jump local", "plastic jump local", "traction local")),
              data["fluid pressure"][order] if "fluid pressure" in data else np.zeros(len(order)),
              {name: data[name][order] for name in HISTORIES if name in data})
    f.bound, f.distance, f.strength = np.empty((3, len(order)))
    for k in np.unique(f.fracture):
        law, on = laws[k], f.fracture == k
        some = f.on(on)
        f.bound[on], f.distance[on], f.strength[on] = law.bound(some), some.jump[:, 0] - law.closed_gap(some), law.tension(some)
    return f


@dataclass
class Scales:
    length: float    # largest displacement of a node or jump of a face in the run
    traction: float  # largest traction or fluid pressure on a face in the run, at least 1e-9 E u/L
    extent: float


def history(directory, input_, laws=None):
    """Returns the faces of every written step, and the scales of the run. `laws`: laws of single fractures instead
    of sets."""
    bulk = read.written_steps(directory, "bulk")
    grid = read.grid(bulk[0][1])
    bounds = np.reshape(grid.GetBounds(), (3, 2))
    extent = (bounds[:, 1] - bounds[:, 0]).max()
    length = 0
    for _, file in bulk[::-(len(bulk) // -BULK_STEPS)] + bulk[-1:]:
        displacement = read.arrays(read.grid(file).GetPointData())["displacement"]
        length = max(length, np.linalg.norm(displacement, axis=1).max())
    of = (input_.laws, extent) if laws is None else (laws, extent, "single fracture")
    steps = [faces(time, file, *of) for time, file in read.written_steps(directory, "fractures")]
    length = max(length, max(np.linalg.norm(step.jump, axis=1).max() for step in steps))
    traction = max(max(np.linalg.norm(step.traction, axis=1).max(), np.abs(step.pressure).max()) for step in steps)
    return steps, Scales(max(length, TINY), max(traction, 1e-9 * input_.modulus * length / extent, TINY), extent)


def violation(step, before, scales, laws=(), path=None):
    """Returns the largest violation over the faces for each of PARTS, relative to the scales.

    `before`: the faces at the start of the step; None if the increment of the plastic jump is unknown. `laws`
    [fracture] and `path`, the plastic jumps up to this step, are used for histories."""
    shear = np.linalg.norm(step.traction[:, 1:], axis=1)
    load = np.maximum(-step.traction[:, 0], 0) / scales.traction
    worst = [(-step.distance).max() / scales.length, (step.normal - step.strength).max() / scales.traction,
             np.minimum(load, np.maximum(step.distance, 0) / scales.length).max(),
             (shear - step.bound).max() / scales.traction, 0, 0]
    if before is not None:
        worst[4] = _wrong_increment(step, before, shear, scales)
        for k, law in enumerate(laws):
            on = step.fracture == k
            along = _path_of(path, on)
            worst[5] = max(worst[5], law.wrong_histories(step.on(on), before.on(on), along).max(initial=0) / scales.length)
    return np.maximum(worst, 0)


def _wrong_increment(step, before, shear, scales):
    """Returns the largest part of the plastic increment that (11) forbids.

    On sticking faces this is the whole increment. On slipping faces it is the component that is not along the
    traction, or the increment if the shear is below the bound. Open faces may move freely, as may frictionless
    faces and touching faces without load: an increment counts at most as much as the load that forbids it."""
    increment = step.plastic[:, 1:] - before.plastic[:, 1:]
    size = np.linalg.norm(increment, axis=1) / scales.length
    along = step.traction[:, 1:] / np.where(shear > 0, shear, 1)[:, None]
    forward = np.maximum((increment * along).sum(axis=1), 0)
    across = np.linalg.norm(increment - forward[:, None] * along, axis=1) / scales.length
    wrong = np.maximum(np.minimum(across, shear / scales.traction), np.minimum(size, (step.bound - shear) / scales.traction))
    load = np.maximum(-step.traction[:, 0], 0) / scales.traction
    return max(np.where(step.state == SLIP, wrong, 0).max(), np.where(step.state == STICK, np.minimum(size, load), 0).max())


def largest(directory, results, input_):
    """Returns the faces of each step, the scales, the violation of the run by PARTS, and the number of steps
    without checks of direction."""
    singles = results.get("single_fractures", [])
    own = input_.of_singles(singles) if any(one.get("own_joint") for one in singles) else None
    laws = input_.laws if own is None else own
    steps, scales = history(directory, input_, own)
    numbered = list(enumerate(results["steps"]))
    # an immediate failure has the time of the previous step
    at = {round(step["time"], 9): k for k, step in reversed(numbered)}
    worst, skipped, last, path = np.zeros(len(PARTS)), 0, -1, []
    for k, step in enumerate(steps):
        if round(step.time, 9) not in at:  # the run ended before results.json contained the step
            break
        number = at[round(step.time, 9)]
        before = steps[k - 1] if k else None
        if number == 0:
            before = Faces.at_rest(step)
        excavated = before is not None and len(before.state) != len(step.state)
        known = number == last + 1 and results["steps"][number]["substeps"] == 1 and not excavated
        path = [*path, _segment(step, before, laws, path)] if known and path is not None else None
        worst = np.maximum(worst, violation(step, before if known else None, scales, laws, path))
        skipped, last = skipped + (not known), number
    return steps, scales, worst, skipped


def _segment(step, before, laws, path):
    """Returns (plastic jump from, to, weight k) of one step of the path; the weight is 0 on open faces."""
    weight = np.zeros(len(step.state))
    for k, law in enumerate(laws):
        on = step.fracture == k
        faces = step.on(on)
        weight[on] = law.weight(faces) * law.rubbed_share(faces, before.on(on), _path_of(path, on))
    return before.plastic[:, 1:], step.plastic[:, 1:], weight


def _path_of(path, on):
    """Restricts the path to some faces; None if the path is unknown."""
    return None if path is None else [tuple(part[on] for part in segment) for segment in path]


def differing(one, other, scales, tolerance=1e-9):
    """Returns the faces with different states in two runs of a scene: (time, place, states, distance from the
    limit, whether the distance is within the tolerance)."""
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
