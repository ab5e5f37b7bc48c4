"""Balances of forces, moments and energy, and dissipation on faces, from the output of a run of a box of
simplices.

The work of the loads over a step, by the trapezoid rule, is exact for a linear body. It equals the change of
strain energy and of the energy stored in joints (elastic shear, closure), plus heat. Friction contributes
positively to the heat, dilation against the load negatively. The strain energy is half of the work of the
present loads and fracture tractions on the present displacements (Clapeyron).

The check uses nothing of the solver. Displacement, jumps and tractions come from the grids, reactions from
results.json, laws and loads from effective_input.xml. The remaining defect vanishes with the step size. It has
a first-order part, because heat uses the traction at the end of a step, and a second-order part from the
nonlinear closure. Displacements of loaded sides are nodal: tips must be plain."""
from dataclasses import dataclass

import numpy as np

import read
import violation

AXES = {"west": (0, 0), "east": (0, 1), "south": (1, 0), "north": (1, 1), "bottom": (2, 0), "top": (2, 1)}  # (axis, upper end)
NEAR = 1e-9  # relative to the domain size: nodes within this distance lie on a side


@dataclass
class Budget:
    """Energies since the start, one value per step, J (2D: J/m), and balances.

    Forces are relative to the largest reaction, moments to the largest reaction times the size."""
    work: np.ndarray
    strain: np.ndarray
    stored: np.ndarray
    heat: np.ndarray
    late: np.ndarray   # heat by tractions at step ends minus heat by mean tractions
    balance: float    # largest sum of forces or moments
    min_heat: float  # smallest lambda_t . du^p of a face in a step, relative to the largest

    @property
    def defect(self):
        """Energy defect at the end, relative to the work."""
        return (self.work - self.strain - self.stored - self.heat)[-1] / self.work[-1]


class Box:
    """Geometry and loads of a run. Arrays over all steps begin with the state at rest."""

    def __init__(self, directory, results):
        self.input = violation.Input(directory / "effective_input.xml")
        self.steps, self.dim = results["steps"], results["mesh"]["dimension"]
        self.files = read.written_steps(directory, "bulk")
        if len(self.files) != len(self.steps):
            raise ValueError(f"{directory}: {len(self.files)} of {len(self.steps)} steps are written; all are needed")
        self.times = np.array([0.0] + [step["time"] for step in self.steps])
        grid = read.grid(self.files[0][1])
        self.points = read.vtk_to_numpy(grid.GetPoints().GetData())
        self.cells = np.array(read.cells(grid.GetCells()))
        self.bounds = np.array(grid.GetBounds()).reshape(3, 2)
        self.size = np.ptp(self.bounds, axis=1).max()

    def side(self, boundary):
        """Corners [face, corner] and areas of the facets on a side."""
        axis, upper = AXES[boundary]
        on = np.abs(self.points[:, axis] - self.bounds[axis, upper]) < NEAR * self.size
        faces = np.concatenate([np.delete(self.cells, k, axis=1) for k in range(self.dim + 1)])
        faces = faces[on[faces].all(axis=1)]
        edges = self.points[faces[:, 1:]] - self.points[faces[:, :1]]
        normal = edges[:, 0] if self.dim == 2 else np.cross(edges[:, 0], edges[:, 1]) / 2
        return faces, np.linalg.norm(normal, axis=1)

    def prescribed(self, kind):
        """Conditions that give all components, {boundary: vectors [time, 3]}; each component is a multiple of a
        table, or constant."""
        found = {}
        for name in self.input.names("Boundary conditions"):
            words = (self.input.text("Boundary conditions", name, kind) or "").strip("{} ").split(",")
            if any(words) and "free" not in words:
                found[self.input.text("Boundary conditions", name, "boundary")] = np.stack(
                    [self.values(word.strip()) for word in words] + [0 * self.times] * (3 - len(words)), axis=1)
        return found

    def values(self, word):
        sign, name = (-1, word[1:]) if word.startswith("-") else (1, word)
        table = ("Tables", name.removesuffix("(t)"))
        values = np.interp(self.times, self.input.numbers(*table, "arguments"), self.input.numbers(*table, "values")) \
            if name.endswith("(t)") else np.full(len(self.times), float(name))
        return sign * values * (self.times > 0)  # no loads before the first step


def vectors(rows):
    """Returns rows extended to three components, after a row of zeros for the state at rest."""
    return np.array([[0, 0, 0]] + [[*row, 0, 0][:3] for row in rows], dtype=float)


def works(force, displacement):
    """[2, time] Work since the start by the trapezoid rule, and force times displacement at each time."""
    steps = ((force[1:] + force[:-1]) / 2 * np.diff(displacement, axis=0)).sum(axis=1)
    return np.array([np.concatenate([[0], np.cumsum(steps)]), (force * displacement).sum(axis=1)])


def loads(box):
    """Returns works [2, time], sums of forces and moments [time, 3] of all loads on the sides, and the largest
    reaction."""
    work, forces, moments, largest = 0, 0, 0, 0
    for boundary, displacement in box.prescribed("displacement").items():
        force = vectors(step["reactions"][boundary] for step in box.steps)
        moment = [step["reaction_moments"][boundary] for step in box.steps]
        work = work + works(force, displacement)
        forces = forces + force
        moments = moments + vectors([0, 0, *m] if box.dim == 2 else m for m in moment)
        largest = max(largest, np.linalg.norm(force, axis=1).max())
    shown = [read.arrays(read.grid(file).GetPointData())["displacement"] for _, file in box.files]
    for boundary, traction in box.prescribed("traction").items():
        faces, area = box.side(boundary)
        weights = np.zeros(len(box.points))
        np.add.at(weights, faces, area[:, None] / box.dim)
        moved = np.array([weights @ u for u in [np.zeros_like(shown[0]), *shown]])
        work = work + works(traction, moved)
        forces = forces + area.sum() * traction
        moments = moments + np.cross(weights @ box.points, traction)
    return work, forces, moments, largest


def joints(directory, results, box):
    """Returns work of tractions on jumps, stored energy, heat and its late part [time]; smallest heat of a face in
    a step over the largest."""
    steps, _ = violation.history(directory, box.input)
    areas = face_areas(directory, box)
    taken, stored, heat, late, shares = [0], [0], [0], [0], []
    slip, shear_before = np.zeros_like(steps[0].plastic), 0
    for step, reported in zip(steps, results["steps"]):
        shear, normal = step.traction[:, 1:], step.traction[:, 0]
        increment = step.plastic[:, 1:] - slip[:, 1:]
        share = areas * (shear * increment).sum(axis=1)
        # with several substeps, no single traction belongs to the increment
        shares.append(share if reported["substeps"] == 1 else np.zeros(1))
        lift, of = np.zeros(len(areas)), np.zeros(len(areas))
        for k, joint in enumerate(box.input.joints):
            on = step.fracture == k
            lift[on] = joint.dilation * (np.linalg.norm(step.plastic[on, 1:], axis=1) - np.linalg.norm(slip[on, 1:], axis=1))
            of[on] = (shear[on] ** 2).sum(axis=1) / (2 * joint.stiffness) + closure_energy(joint, -normal[on])
        heat.append(heat[-1] + (share + areas * normal * lift).sum())
        stored.append((areas * of).sum())
        taken.append((areas[:, None] * step.traction * step.jump).sum())
        late.append(late[-1] + (areas * ((shear - shear_before) * increment).sum(axis=1)).sum() / 2)
        slip, shear_before = step.plastic, shear
    minimum, maximum = min(s.min() for s in shares), max(s.max() for s in shares)
    return *map(np.array, (taken, stored, heat, late)), minimum / maximum if maximum > 0 else 0


def closure_energy(joint, load):
    """Integral of N over the closure d per area, for N = K V d / (V - d) (Barton and Bandis)."""
    if joint.closure == 0:
        return 0
    load = np.maximum(load, 0)
    d = joint.closure * load / (joint.closure * joint.normal_stiffness + load)
    return joint.normal_stiffness * joint.closure * (-d - joint.closure * np.log1p(-d / joint.closure))


def face_areas(directory, box):
    """Areas in the order of violation.faces."""
    grid = read.grid(read.written_steps(directory, "fractures")[0][1])
    points, cells = read.vtk_to_numpy(grid.GetPoints().GetData()), np.array(read.cells(grid.GetCells()))
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    area = np.linalg.norm(edges[:, 0] if box.dim == 2 else np.cross(edges[:, 0], edges[:, 1]) / 2, axis=1)
    return area[violation.sorted_by_place(points[cells].mean(axis=1), read.arrays(grid.GetCellData())["fracture"], box.size)]


def budget(directory, results):
    box = Box(directory, results)
    (work, on_displacement), forces, moments, largest = loads(box)
    taken, stored, heat, late, minimum = joints(directory, results, box)
    balance = max(np.abs(forces).max() / largest, np.abs(moments).max() / (largest * box.size))
    return Budget(work, (on_displacement - taken) / 2, stored, heat, late, balance, minimum)
