"""Compliance, Biot tensor and storage of a block at the stresses of a path."""
from dataclasses import dataclass

import numpy as np

from .. import _sprekk
from ..model import Model
from .block import Boundary, Linear, base_entries, difference, outline_of, scene_of
from .flow import is_impermeable
from .periodic import Periodic
from .components import n_components, names, of_inverse, unit_strains, unit_stresses

INSIDE = 1e-6  # relative change of the compression of sliding faces, for the Jacobian of sticking or slipping faces
TOUCHING = 1e-12  # largest opening of touching faces, relative to the size of the block
BARELY = 1e-9  # compression of touching faces without load, relative to the largest stress, for the Jacobian
SLIP = 2  # contact state
TOLERANCE = 1e-8  # of linear solves
UNSYMMETRIC = 1e-12  # with slipping faces
SLIDING = {"stick": 1 + INSIDE, "slip": 1 - INSIDE}  # factors of the compression of sliding faces


@dataclass
class State:
    """Mean values of a block at one stress of the path.

    strain         [component] mean strain since the start, from the displacement of the boundary
    of_fractures   [component] part of the strain due to opening and slip
    opening, slip  area means over the fractures, m
    aperture       area mean, m
    sliding        area fraction of faces that slip in the step to this state"""
    strain: np.ndarray
    of_fractures: np.ndarray
    opening: float
    slip: float
    aperture: float
    sliding: float


@dataclass
class Tangent:
    """Drained compliance S, Biot tensor alpha and storage, for small increments from a state.

        strain = S : (stress + alpha p),   fluid content = beta : strain + storage p,

    stress positive in tension. S [component, component] in 1/Pa. The content and the storage, 1/Pa, contain the pore
    volume of the rock and the opening of fractures, and no compressibility of fluid or grains. S is symmetric and beta =
    alpha, unless faces slip in the tangent."""
    compliance: np.ndarray
    biot: np.ndarray
    biot_of_content: np.ndarray
    storage_at_strain: float
    error: np.ndarray = None  # bound of the discretisation error of the compliance; None: unknown

    @property
    def storage_at_stress(self):
        return float(self.storage_at_strain + self.biot_of_content @ self.compliance @ self.biot)


class Solid:
    """Deformation of a block, with two models of the same mesh.

    free  uniform stress on the boundary, with supports against rigid motions: takes the steps of the path
    constrained  prescribed displacement of the boundary: follows the states of `free`, for responses only; closed unless
                 `conditions` require it

    estimates  False: without estimates of discretisation errors, whose cost is about twice that of the solves
    sliding    tangent of faces that slip in the last step: they "stick", or "slip" further in the same direction

    stresses [state, component], Pa, tension positive, total stress on the boundary; pressures [state], Pa. The initial
    state of the scene is that at its initial pressure."""

    estimates = True

    def __init__(self, scene, comm, stresses, pressures, sliding="stick", conditions=("linear", "uniform")):
        self.scene, self.comm, self.sliding = scene, comm, sliding
        check_laws(scene)
        self.first_pressure = initial_pressure(scene)
        self.stresses, self.pressures = np.asarray(stresses, float), np.asarray(pressures, float)
        self.entries = solid_entries(scene.entries)
        fixed = {name: {"boundary": name, "displacement": [0] * self._dim()} for name in outline_of(scene, comm)[1]}
        self.constrained = self._linear_model(fixed, {})
        self.boundary = Boundary(self.constrained.model)
        self.volume, self.dim = self.boundary.volume, self.constrained.model.mesh.dim
        if not {"linear", "periodic"} & {*conditions}:
            self.constrained.model.close()  # before the second model is made
        self.unit = max(1e6, np.max(np.abs(self.stresses), initial=0))
        self.free = self._linear_model(*self._uniform())
        self.moves_pores = not is_impermeable(scene)
        self._loads = self._unit_loads()
        self._first_jump = self.free.model.output("jump") if self.free.model.mesh.fractures else None
        self._first_opening = self.openings() if self.free.model.mesh.fractures else None
        self.number = -1  # state
        self.floating = ""  # pieces of rock that may move freely in the state, as text

    def _dim(self):
        return 2 if self.stresses.shape[1] == 3 else 3

    def _linear_model(self, conditions, tables):
        entries = {**self.entries, "Tables": {**self.entries.get("Tables", {}), **tables},
                   "Boundary conditions": conditions, "Time": {"end": self._end(), "steps": int(self._end())}}
        if not entries["Tables"]:
            del entries["Tables"]
        return Linear(Model(scene_of(self.scene, entries, self.comm), self.comm,
                            given_pressure=self.first_pressure), UNSYMMETRIC if self.sliding == "slip" else TOLERANCE)

    # Time of the model: 0 start, 1 ... n states, then no stress, then unit stresses

    def _end(self):
        return float(len(self.stresses) + 1 + self.stresses.shape[1])

    def _uniform(self):
        """Returns the conditions of uniform stress, and the tables of its components."""
        n, components = self.stresses.shape
        values = np.zeros((n + 2 + components, components))
        values[0] = self._start()
        values[1:n + 1] = self.stresses
        values[n + 2:] = self.unit * np.eye(components)
        functions = [f"stress_{name}_of_path" for name in names(self.dim)]
        tables = {function: {"arguments": [float(t) for t in range(len(values))], "values": column.tolist()}
                  for function, column in zip(functions, values.T)}
        number = {pair: k for k, pair in enumerate(names(self.dim))}
        conditions = {}
        for name, sides in self.boundary.sides().items():
            on = [on_side(normal, offset, self.boundary.near()) if len(sides) > 1 else "1" for normal, offset in sides]
            traction = []
            for i in "xyz"[:self.dim]:
                terms = [f"{place}*({float(n)!r})*{functions[number[min(i + j, j + i)]]}(t)"
                         for place, (normal, _) in zip(on, sides) for j, n in zip("xyz", normal) if abs(n) > 1e-14]
                traction.append(" + ".join(terms) or "0")
            conditions["stress on " + name] = {"boundary": name, "traction": traction}
        for k, (name, point, components) in enumerate(self.boundary.supports()):
            conditions[f"support {k + 1}"] = {
                "boundary": name, "lower corner": list(map(float, point)),
                "displacement": [0 if i in components else "free" for i in range(self.dim)]}
        return conditions, tables

    def _start(self):
        """Returns the stress at the start: the initial stress, if it is uniform, or zero."""
        return uniform_stress(self.scene, self.dim)

    def _unit_loads(self):
        """Returns the forces of unit stresses on the boundary, and of a unit pressure, as right sides."""
        free, n = self.free, len(self.stresses)
        x = free.zeros()
        without = free.residual(x, n + 1)
        loads = [difference(without, free.residual(x, n + 2 + k), 1 / self.unit) for k in range(n_components(self.dim))]
        self.set_pressure(self.first_pressure + self.unit)
        loads.append(difference(without, free.residual(x, n + 1), 1 / self.unit))
        self.set_pressure(self.first_pressure)
        return loads

    def set_pressure(self, pressure):
        mesh = self.free.model.mesh
        in_rock = np.full(mesh.n_owned_cells, float(pressure if self.moves_pores else self.first_pressure))
        self.free.model.set_fluid_pressure(in_rock, np.full(len(mesh.faces), float(pressure)))

    # States

    def step(self):
        """Computes the next state of the path and returns its State. Raises NotConverged."""
        self.number += 1
        self.set_pressure(self.pressures[self.number])
        self.floating = self.free.model.step(self.number + 1.0).floating
        return self.state()

    def state(self):
        model, mesh = self.free.model, self.free.model.mesh
        x = [np.array(model.field(name)).ravel() for name in self.free.blocks]
        strain = np.array([self.free.dot(load, x) for load in self._loads[:-1]]) / self.volume
        if not mesh.fractures:
            return State(strain, np.zeros_like(strain), 0.0, 0.0, 0.0, 0.0)
        jump = model.output("jump") - self._first_jump
        sums = np.einsum("f,fi,fj->ij", mesh.face_area, mesh.face_frame[:, 0], jump)
        sums = self.comm.allreduce(sums + sums.T) / 2 / self.volume
        by_face = np.stack([self.openings(), model.output("slip"), model.output("aperture"), self._sliding(),
                            np.ones(len(jump))])
        *means, area = self.comm.allreduce(by_face @ mesh.face_area)
        return State(strain, strain_vector(sums), *(float(mean / area) for mean in means))

    def openings(self):
        """Returns the openings since the unloaded joint, [owned face], m."""
        return self.free.model.output("opening")

    def widenings(self):
        """Returns the openings since the state that has the initial aperture, [owned face], m."""
        mesh, entries = self.free.model.mesh, self.scene.all_entries
        given = entries["Fractures"]
        joints = [given.get(name, {}).get("material") or given["material"] for name in mesh.fractures]
        in_situ = np.array([entries["Materials"][name].get("reference state", "unloaded") != "unloaded" for name in joints])
        opening = self.openings()
        return opening - np.where(in_situ[mesh.face_fracture[:len(opening)]], self._first_opening, 0)

    def region_volumes(self):
        """Returns the volume of each region, m^3 (2D: m^2)."""
        mesh, volumes = self.free.model.mesh, self.boundary.cell_volume
        own = np.bincount(mesh.cell_region[:mesh.n_owned_cells], volumes[:mesh.n_owned_cells], len(mesh.regions))
        return self.comm.allreduce(own)

    def _sliding(self):
        return self.free.model.output("state") == SLIP

    # Tangents

    def tangents(self, conditions):
        """Returns {condition: Tangent} at the present state, for "linear", "uniform" and "periodic"."""
        found = {}
        if "uniform" in conditions:
            self._linearise(self.free)
            found["uniform"] = self._uniform_tangent()
        if "linear" in conditions or "periodic" in conditions:
            for name in self.free.model.fields:
                self.constrained.model.field(name)[:] = np.asarray(self.free.model.field(name))
            self._linearise(self.constrained, "periodic" in conditions)
        if "linear" in conditions:
            found["linear"] = self._linear_tangent()
        if "periodic" in conditions:
            found["periodic"] = self._periodic_tangent()
        return found

    def inner(self, region):
        """Returns the compliance of an Inner region under the linear conditions of the last call of tangents()."""
        return region.compliance(self.constrained.model, self._responses)

    def _linearise(self, solver, sparse=False):
        """Computes the Jacobian. Sliding faces stick or slip, and touching faces without load are closed."""
        model = solver.model
        if not model.mesh.fractures:
            return solver.linearise(sparse)
        traction = model.field("traction")
        before = np.array(traction)
        sliding = self._sliding()
        traction[sliding, 0] = before[sliding, 0] * SLIDING[self.sliding]
        touching = (before[:, 0] > -BARELY * self.unit) & (self.openings() <= TOUCHING * self.volume ** (1 / self.dim))
        traction[touching, 0] = -BARELY * self.unit
        solver.linearise(sparse)
        traction[:] = before

    def _errors(self, solver, responses):
        """Returns bounds of the errors of energies, or None. The estimate requires a symmetric tangent."""
        return solver.errors(responses, self.volume) if self.estimates and self.sliding == "stick" else None

    def _uniform_tangent(self):
        solver, n = self.free, n_components(self.dim)
        loads = [solver.free(load) for load in self._loads]
        responses = [solver.response(load) for load in loads]
        M = solver.energies(responses, loads) / self.volume
        biot = np.linalg.solve(M[:n, :n], M[:n, n])
        of_content = np.linalg.solve(M[:n, :n].T, M[n, :n])
        return Tangent(M[:n, :n], biot, of_content, float(M[n, n] - M[n, :n] @ biot), self._errors(solver, responses[:n]))

    def _linear_fields(self):
        """Returns the displacements of unit strains on the boundary."""
        solver, u = self.constrained, self.constrained.block("displacement")
        mesh = solver.model.mesh
        x = mesh.coordinates[:len(solver.prescribed[u]) // self.dim]
        strains = []
        for unit in unit_strains(self.dim):
            strain = solver.zeros()
            strain[u][:] = np.where(solver.prescribed[u], (x @ unit).ravel(), 0)
            strains.append(strain)
        return strains

    def _linear_tangent(self):
        solver, n, pressure = self.constrained, n_components(self.dim), self._loads[-1]
        self._responses = [solver.response(strain) for strain in self._linear_fields()]
        of_pressure = solver.response(solver.free(pressure))
        M = solver.energies([*self._responses, of_pressure], [solver.zeros()] * n + [pressure]) / self.volume
        compliance = np.linalg.inv(-M[:n, :n])
        error = of_inverse(compliance, self._errors(solver, self._responses))
        return Tangent(compliance, M[:n, n], M[n, :n], float(M[n, n]), error)

    def _periodic_tangent(self):
        solver, strains, n = self.constrained, self._linear_fields(), n_components(self.dim)
        periodic = Periodic(solver, self.boundary)
        ties, fixed = periodic.tied_nodes(solver.block("displacement"))
        zeros = solver.zeros()
        forces, products = periodic.means([*strains, zeros], [zeros] * n + [self._loads[-1]], ties, fixed)
        return Tangent(np.linalg.inv(forces[:n, :n]), -forces[:n, n], products[n, :n], float(products[n, n]))


def check_laws(scene):
    """Raises an Error for slip that depends on time: a block has none."""
    for name, material in scene.all_entries.get("Materials", {}).items():
        friction = material.get("friction", "") if isinstance(material, dict) else ""
        if friction.startswith("rate and state") or (friction == "slip weakening" and float(material.get("radiation damping", 0)) > 0):
            raise _sprekk.Error(f'{scene.name}: Sprekk > Materials > {name} > "friction": "{friction}" depends on the slip '
                                "rate; tensors of a block have no time")
    for name, fracture in scene.entries.get("Fractures", {}).items():
        if isinstance(fracture, dict) and "prescribed slip" in fracture:
            raise _sprekk.Error(f"{scene.name}: Sprekk > Fractures > {name} > prescribed slip: must be absent: slip of a "
                                "block follows from its stress")


def uniform_stress(scene, dim):
    """Returns the initial stress of a scene as a vector, zero if absent. It must be uniform."""
    bulk = scene.all_entries["Bulk"]
    for name in ("lithostatic stress", "in-situ stress"):
        if name in scene.entries["Bulk"]:
            raise _sprekk.Error(f'{scene.name}: Sprekk > Bulk > {name}: must be absent: a block has a uniform "initial stress"')
    for name, region in scene.all_entries.get("Regions", {}).items():
        if isinstance(region, dict) and region.get("initial stress"):
            raise _sprekk.Error(f'{scene.name}: Sprekk > Regions > {name} > "initial stress": must be absent: a block '
                                "has a uniform one")
    try:
        given = np.array([float(value) for value in bulk.get("initial stress") or [0] * 6])
    except ValueError:
        raise _sprekk.Error(f'{scene.name}: Sprekk > Bulk > "initial stress": must be uniform') from None
    return given[[0, 1, 3] if dim == 2 else [0, 1, 2, 4, 5, 3]]


def initial_pressure(scene):
    """Returns the initial pressure of the fluid, Pa. It must be uniform."""
    try:
        return float(scene.all_entries.get("Flow", {}).get("initial pressure", 0))
    except ValueError:
        raise _sprekk.Error(f'{scene.name}: Sprekk > Flow > "initial pressure": must be uniform for a block') from None


def on_side(normal, offset, near):
    """Returns the expression of a factor: 1 on a plane n . x = offset, 0 elsewhere."""
    along = " + ".join(f"({float(n)!r})*{axis}" for axis, n in zip("xyz", normal))
    return f"(abs({along} - ({offset!r})) < {near!r} ? 1 : 0)"


def strain_vector(matrix):
    """Returns the vector of a strain matrix, with shear strains 2 e_ij."""
    dim = len(matrix)
    return np.array([np.sum(matrix * unit) for unit in unit_stresses(dim)])


def solid_entries(entries):
    """Returns the entries of deformation without flow."""
    found = {name: section for name, section in base_entries(entries).items() if name != "Flow"}
    if "Bulk" in found:
        found["Bulk"] = {name: value for name, value in found["Bulk"].items() if name not in ("gravity", "body force")}
    for name, inner in (("Regions", ("pressure",)), ("Fractures", ("source", "cuts", "fluid pressure", "Held pressures"))):
        if name in found:
            found[name] = {key: {k: v for k, v in value.items() if k not in inner} if isinstance(value, dict) else value
                           for key, value in found[name].items()}
    return found
