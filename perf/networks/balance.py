"""Balance of forces and moments, energy, and dissipation on faces, computed from what a run of a box of simplices wrote.

Work of the loads over a step, by the trapezoid rule, is exact for a linear body. It goes into strain of the rock, energy
stored in joints (elastic shear, closure) and heat, of which sliding against friction gains some and lifting against the load
by dilation loses some. Strain energy is half of what the loads and the tractions on fractures do on the displacement at the time
(Clapeyron). Nothing of the solver is used: displacement, jumps and tractions come from the grids, reactions from
results.json, laws and loads from effective_input.xml. What is left over, the defect, vanishes with the step. It has a part of
first order, heat being that of the traction at the end of a step, and one of second order, from closure, which is not linear.
Displacements of loaded sides are those of nodes: tips must be plain."""
from dataclasses import dataclass

import numpy as np

import read       # of apps/plot
import violation  # of perf/contact

AXES = {"west": (0, 0), "east": (0, 1), "south": (1, 0), "north": (1, 1), "bottom": (2, 0), "top": (2, 1)}  # (axis, upper end)
NEAR = 1e-9  # of the domain's size: nodes this close to a side are on it


@dataclass
class Budget:
    """One value per step, J (2D: J/m), since the start; forces relative to the largest reaction (moments: times the size)."""
    work: np.ndarray
    strain: np.ndarray
    stored: np.ndarray
    heat: np.ndarray
    late: np.ndarray   # heat of the traction at the end of steps, less that of the mean over them
    balance: float    # largest sum of forces or moments
    least_heat: float  # least lambda_t . du^p of a face in a step, relative to the largest

    @property
    def defect(self):
        """Of the energy at the end, relative to the work."""
        return (self.work - self.strain - self.stored - self.heat)[-1] / self.work[-1]


class Box:
    """Geometry and loads of a run; arrays over all steps, the state at rest first."""

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
        """Corners [face, corner] of the simplices on a side, and their areas."""
        axis, upper = AXES[boundary]
        on = np.abs(self.points[:, axis] - self.bounds[axis, upper]) < NEAR * self.size
        faces = np.concatenate([np.delete(self.cells, k, axis=1) for k in range(self.dim + 1)])
        faces = faces[on[faces].all(axis=1)]
        edges = self.points[faces[:, 1:]] - self.points[faces[:, :1]]
        normal = edges[:, 0] if self.dim == 2 else np.cross(edges[:, 0], edges[:, 1]) / 2
        return faces, np.linalg.norm(normal, axis=1)

    def prescribed(self, kind):
        """{boundary: vectors [time, 3]} of conditions that give all components, each a multiple of a table or zero."""
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
        return sign * values * (self.times > 0)  # nothing acts before the first step


def vectors(rows):
    """With zeros for components that a plane problem lacks, and a row of them for the state at rest."""
    return np.array([[0, 0, 0]] + [[*row, 0, 0][:3] for row in rows], dtype=float)


def works(force, displacement):
    """Work since the start by the trapezoid rule, and of the forces of each time on its displacements, [time]."""
    steps = ((force[1:] + force[:-1]) / 2 * np.diff(displacement, axis=0)).sum(axis=1)
    return np.array([np.concatenate([[0], np.cumsum(steps)]), (force * displacement).sum(axis=1)])


def loads(box):
    """Works [2, time], sums of forces and of moments [time, 3] with all that acts on the sides, and the largest reaction."""
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
    """Work of tractions on jumps, energy stored, heat, its late part [time]; the least heat of a face in a step over the largest."""
    steps, _ = violation.history(directory, box.input)
    areas = face_areas(directory, box)
    taken, stored, heat, late, shares = [0], [0], [0], [0], []
    slip, shear_before = np.zeros_like(steps[0].plastic), 0
    for step, told in zip(steps, results["steps"]):
        shear, normal = step.traction[:, 1:], step.traction[:, 0]
        increment = step.plastic[:, 1:] - slip[:, 1:]
        share = areas * (shear * increment).sum(axis=1)
        shares.append(share if told["substeps"] == 1 else np.zeros(1))  # the increment of several is not along one traction
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
    least, most = min(s.min() for s in shares), max(s.max() for s in shares)
    return *map(np.array, (taken, stored, heat, late)), least / most if most > 0 else 0


def closure_energy(joint, load):
    """Integral of N over the closure d, where N = K V d / (V - d) (Barton and Bandis), per area."""
    if joint.closure == 0:
        return 0
    load = np.maximum(load, 0)
    d = joint.closure * load / (joint.closure * joint.normal_stiffness + load)
    return joint.normal_stiffness * joint.closure * (-d - joint.closure * np.log1p(-d / joint.closure))


def face_areas(directory, box):
    """In the order of violation.faces."""
    grid = read.grid(read.written_steps(directory, "fractures")[0][1])
    points, cells = read.vtk_to_numpy(grid.GetPoints().GetData()), np.array(read.cells(grid.GetCells()))
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    area = np.linalg.norm(edges[:, 0] if box.dim == 2 else np.cross(edges[:, 0], edges[:, 1]) / 2, axis=1)
    return area[violation.sorted_by_place(points[cells].mean(axis=1), read.arrays(grid.GetCellData())["fracture"], box.size)]


def budget(directory, results):
    box = Box(directory, results)
    (work, on_displacement), forces, moments, largest = loads(box)
    taken, stored, heat, late, least = joints(directory, results, box)
    balance = max(np.abs(forces).max() / largest, np.abs(moments).max() / (largest * box.size))
    return Budget(work, (on_displacement - taken) / 2, stored, heat, late, balance, least)
