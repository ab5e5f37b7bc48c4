"""Permeability of a block."""
import numpy as np

from ..model import Model
from ..module import Block, Module, Unknown
from .block import Boundary, Linear, base_entries, outline_of, scene_of
from .components import of_inverse
from .periodic import Periodic

TOLERANCE = 1e-9  # of linear solves


class Widening(Module):
    """Widening of fractures as an unknown, so that apertures of another model can be set on each face."""
    name = "widening of a state"
    unknowns = [Unknown("widening", "fracture face", 1, "m", "displacement", {"displacement": 1}, "fracture face")]
    scales = {"displacement": 1e-6}
    symmetric = True

    def blocks(self, mesh):
        one = np.ones((1, 1, 1))
        return [Block("fracture faces", ["widening"], ["widening"], lambda x, state: {"widening": x["widening"]},
                      lambda x, state: {("widening", "widening"): np.tile(one, (len(x["widening"]), 1, 1))})]


class Flow:
    """Steady flow of a fluid of viscosity 1 through a block.

    With the mean flux q and the mean gradient g of the pressure, over the volume V, from values on the boundary,

        q = 1/V sum q_f x_f,   g = 1/V sum p_f n_f A_f,   q = -K g.

    linear   p = g . x on the boundary, also at the ends of fractures: the upper bound of K
    uniform  q . n = Q . n on the boundary of the rock, and no flux through the ends of fractures: the lower bound
    periodic p = g . x plus equal values on opposite sides: between the bounds

    estimates  False: without estimates of discretisation errors"""
    estimates = True

    def __init__(self, scene, comm):
        self.scene, self.comm = scene, comm
        self.entries = flow_entries(scene.entries)
        self.impermeable = is_impermeable(scene)
        constrained = {name: {"boundary": name, "pressure": 0} for name in outline_of(scene, comm)[1]}
        self.constrained = self._linear_model({}, constrained)
        self.boundary = Boundary(self.constrained.model)
        self.volume = self.boundary.volume
        self.centre = np.mean(self.boundary.corners(), axis=0)
        self._open = None
        self.error = None  # bound of the discretisation error of the last permeability, m^2; None: unknown

    def _linear_model(self, wells, conditions):
        entries = {**self.entries, "Flow": {**self.entries["Flow"], **({"Wells": wells} if wells else {})},
                   "Boundary conditions": conditions, "Time": {"end": 1, "steps": 1}}
        scene = scene_of(self.scene, entries, self.comm)
        return Linear(Model(scene, self.comm, modules=[Widening()] if self._has_fractures() else ()), TOLERANCE)

    def _has_fractures(self):
        return bool(self.entries.get("Fractures"))

    @property
    def open(self):
        """Model without conditions. A well without flow sets the level of the pressure."""
        if self._open is None:
            self._open = self._linear_model({"level": self._well()}, {})
        return self._open

    def _well(self):
        """Returns a well inside the cell nearest to the centre. Pressures near zero have the least round-off."""
        mesh, dim = self.constrained.model.mesh, self.constrained.model.mesh.dim
        cells = mesh.coordinates[mesh.corners[:mesh.n_owned_cells]]
        distances = np.linalg.norm(cells.mean(axis=1) - self.centre, axis=1)
        nearest = self.comm.allgather(float(np.min(distances, initial=np.inf)))
        owner = int(np.argmin(nearest))
        corners = self.comm.bcast(cells[np.argmin(distances)] if self.comm.rank == owner else None, owner)
        centre, size = corners.mean(axis=0), np.min(np.ptp(corners, axis=0))
        points = [centre] if dim == 2 else [centre - [0, 0, size / 100], centre + [0, 0, size / 100]]
        return {"points": np.concatenate(points).tolist(), "radius": float(size / 1000), "pressure": 0}

    def inner(self, region):
        """Returns K of an Inner region under the linear conditions of the last call of permeability()."""
        return region.permeability(self.constrained.model, self._responses)

    def permeability(self, conditions, widening=None):
        """Returns K [dim, dim], m^2, for one of the conditions. widening [owned face]: opening, m."""
        solver = self.open if conditions == "uniform" else self.constrained
        if widening is not None and len(solver.model.mesh.fractures):
            solver.model.field("widening")[:, 0] = widening
        solver.linearise(sparse=conditions == "periodic")
        self.error = None
        return {"linear": self._linear, "uniform": self._uniform, "periodic": self._periodic}[conditions]()

    def _linear_fields(self):
        """Returns the pressures x_i on the boundary, for each direction i, with zero in the centre of the block."""
        solver, b = self.constrained, self.constrained.block("face pressure")
        fields = []
        for x in (self.boundary.facet_centre - self.centre).T:
            field = solver.zeros()
            field[b][:] = np.where(solver.prescribed[b], x, 0)
            fields.append(field)
        return fields

    def _linear(self):
        solver = self.constrained
        self._responses = [solver.response(field) for field in self._linear_fields()]
        self.error = solver.errors(self._responses, self.volume) if self.estimates else None
        return -solver.energies(self._responses) / self.volume

    def _uniform(self):
        solver, b = self.open, self.open.block("face pressure")
        boundary = Boundary(solver.model)
        loads = []
        for area in boundary.area.T:
            load = solver.zeros()
            np.add.at(load[b], boundary.facet, area)
            loads.append(load)
        pressures = [solver.response(load) for load in loads]
        K = np.linalg.inv(solver.energies(pressures, loads) / self.volume)
        self.error = of_inverse(K, solver.errors(pressures, self.volume) if self.estimates else None)
        return K

    def _periodic(self):
        periodic, fields = Periodic(self.constrained, self.boundary), self._linear_fields()
        ties, fixed = periodic.tied_facets(self.constrained.block("face pressure"))
        return periodic.means(fields, [self.constrained.zeros() for _ in fields], ties, fixed)[0]


def is_impermeable(scene):
    """Returns whether rock has the permeability 0, so that fluid flows in fractures only."""
    entries = scene.all_entries
    if "Flow" not in scene.entries:
        return False
    rocks = [entries["Bulk"]["material"], *(region.get("material") for region in entries.get("Regions", {}).values())]
    given = [entries["Materials"][rock].get("permeability") or ["0"] for rock in rocks if rock]
    return any(all(map(is_zero, values)) for values in given)


def is_zero(value):
    """Returns whether an entry is the number 0; an expression is not."""
    try:
        return float(value) == 0
    except ValueError:
        return False


def flow_entries(entries):
    """Returns the entries of flow in rigid rock, of viscosity 1 and without conditions."""
    def only(section, names):
        return {name: {key: value for key, value in inner.items() if key in names} if isinstance(inner, dict) else inner
                for name, inner in section.items()}

    flow = {key: value for key, value in entries.get("Flow", {}).items() if key == "scheme"}
    found = {name: section for name, section in base_entries(entries).items() if name != "Flow"}
    found["Bulk"] = {"material": entries["Bulk"]["material"]}
    found["Flow"] = {**flow, "rigid rock": True, "viscosity": 1}
    for name, keys in (("Regions", ("material",)), ("Fractures", ("material", "cuts"))):
        if name in found:
            found[name] = only(found[name], keys)
    return found
