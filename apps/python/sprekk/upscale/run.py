"""Equivalent tensors of a block at the stresses of a path."""
from dataclasses import dataclass, field

import numpy as np
from mpi4py import MPI

from .. import _sprekk
from ..network import needs_mesh, with_mesh
from ..scene import Scene
from .block import outline_of
from .components import excess, largest_ratio, n_components, names
from .flow import Flow, is_impermeable
from .inner import Inner
from .solid import SLIDING, Solid, State, initial_pressure, uniform_stress

CONDITIONS = ("linear", "uniform")
ALL_CONDITIONS = ("linear", "uniform", "periodic")
ELASTIC = ("Young's modulus", "Poisson's ratio", "shear modulus", "Lame's first parameter", "bulk modulus")
ORDER = 1e-6  # relative excess of a lower bound that is reported
BOUNDS = {"permeability": ("uniform", "linear"), "compliance": ("linear", "uniform")}  # lower, upper


@dataclass
class Result:
    """Tensors of a block at one stress.

    stress        [component], Pa, tension positive; pressure, Pa
    permeability  {conditions: [dim, dim]}, m^2; "inner": of the inner region
    flow_errors   {conditions: bounds of the discretisation errors [dim, dim], m^2}, where an estimate exists
    solid         {conditions: Tangent}; empty for rigid rock
    inner         compliance of the inner region, 1/Pa, or None
    state         mean values, or None for rigid rock
    fluid         part of the storage due to the compressibility of fluid and grains, 1/Pa; None if unknown"""
    stress: np.ndarray
    pressure: float
    permeability: dict = field(default_factory=dict)
    solid: dict = field(default_factory=dict)
    state: State = None
    fluid: float = None
    inner: np.ndarray = None
    flow_errors: dict = field(default_factory=dict)

    def tensors(self):
        """Yields (name, unit, conditions, component, value, bound of the error or None) of all components."""
        dim = 2 if len(self.stress) == 3 else 3
        pairs = names(dim)
        for conditions, K in self.permeability.items():
            error = self.flow_errors.get(conditions)
            yield from (("permeability", "m^2", conditions, a + b, K[i, j], None if error is None else error[i, j])
                        for i, a in enumerate("xyz"[:dim]) for j, b in enumerate("xyz"[:dim]))
        compliances = {conditions: (tangent.compliance, tangent.error) for conditions, tangent in self.solid.items()}
        if self.inner is not None:
            compliances["inner"] = self.inner, None
        for conditions, (S, error) in compliances.items():
            yield from (("compliance", "1/Pa", conditions, f"{a},{b}", S[i, j], None if error is None else error[i, j])
                        for i, a in enumerate(pairs) for j, b in enumerate(pairs))
        for conditions, tangent in self.solid.items():
            yield from (("Biot tensor", "-", conditions, a, tangent.biot[i], None) for i, a in enumerate(pairs))
            if self.fluid is not None:
                yield "storage", "1/Pa", conditions, "constant strain", tangent.storage_at_strain + self.fluid, None
                yield "storage", "1/Pa", conditions, "constant stress", tangent.storage_at_stress + self.fluid, None


@dataclass
class Upscaled:
    """Results [state] of a block, its volume in m^3 (2D: m^2), warnings, and corners of its bounding box, m."""
    dim: int
    volume: float
    results: list
    warnings: list
    corners: tuple

    def table(self):
        """Returns a pandas.DataFrame of all components: state, tensor, conditions, component, value, unit, change, error.

        The change is relative to the first state, the error is an estimate of the absolute discretisation error."""
        import pandas
        rows, first = [], {}
        for number, result in enumerate(self.results):
            for name, unit, conditions, component, value, error in result.tensors():
                before = first.setdefault((name, conditions, component), value)
                rows.append((number, name, conditions, component, value, unit, value / before - 1 if before else 0.0,
                             error))
        return pandas.DataFrame(rows, columns=["state", "tensor", "conditions", "component", "value", "unit", "change",
                                               "error"])

    def states(self):
        """Returns a pandas.DataFrame with a row for each state: stress, pressure and mean values."""
        import pandas
        rows = []
        for number, result in enumerate(self.results):
            row = {"state": number, **dict(zip([f"stress_{name}" for name in names(self.dim)], result.stress)),
                   "pressure": result.pressure}
            if result.state:
                vectors = {"strain": result.state.strain, "strain_of_fractures": result.state.of_fractures}
                for title, vector in vectors.items():
                    row.update({f"{title}_{name}": value for name, value in zip(names(self.dim), vector)})
                row.update({name: getattr(result.state, name) for name in ("opening", "slip", "aperture", "sliding")})
            rows.append(row)
        return pandas.DataFrame(rows)


def run(scene, stresses=None, pressures=None, conditions=CONDITIONS, *, inner=None, errors=True, sliding="stick",
        comm=MPI.COMM_WORLD, largest=10.0):
    """Computes the tensors of the block of a scene. Returns an Upscaled. Collective.

    scene       a Scene or an argument of its constructor. Its boundary conditions, wells and times are not used. Without
                the section Flow there is no permeability, with rigid rock there are no other tensors
    stresses    [state, component] total stress on the boundary, Pa, tension positive, in the order xx, yy, zz, yz, xz,
                xy (2D: xx, yy, xy); default: the uniform initial stress of the scene, or zero
    pressures   [state] pressure of the fluid, Pa; default: the initial pressure of the scene
    conditions  "linear" and "uniform" are bounds; "periodic" needs equal meshes on opposite sides
    inner       edge lengths of an inner region relative to those of the block; absent: none. Its permeability and
                compliance are those of means under linear conditions
    errors      False: without estimates of discretisation errors, whose cost is about twice that of the solves
    sliding     tangent of faces that slip in the step to a state: they "stick", as in unloading, or "slip" further in the
                same direction. Slipping faces make the compliance unsymmetric
    largest     ratio of the tensors of both conditions above which a warning is given"""
    scene = scene if isinstance(scene, Scene) else Scene(scene, comm=comm)
    scene = with_mesh(scene, comm) if needs_mesh(scene.entries) else scene
    stresses, pressures = path_of(scene, stresses, pressures, comm)
    unknown = [name for name in conditions if name not in ALL_CONDITIONS]
    if unknown:
        raise _sprekk.Error(f'conditions: "{unknown[0]}" is unknown, must be one of: {", ".join(ALL_CONDITIONS)}')
    if inner is not None and not ("linear" in conditions and 0 < inner <= 1):
        raise _sprekk.Error(f"inner: is {inner:g}, must be above 0 and at most 1, with linear conditions")
    if not largest >= 1:
        raise _sprekk.Error(f"largest ratio: is {largest:g}, must be at least 1")
    if sliding not in SLIDING:
        raise _sprekk.Error(f'sliding: is "{sliding}", must be one of: {", ".join(SLIDING)}')
    flow = Flow(scene, comm) if "Flow" in scene.entries else None
    solid = Solid(scene, comm, stresses, pressures, sliding, conditions) if deforms(scene) else None
    if not flow and not solid:
        raise _sprekk.Error(f"{scene.name}: has neither elastic constants nor the section Flow")
    for part in (flow, solid):
        if part:
            part.estimates = errors
    results, warnings = [], []
    for stress, pressure in zip(stresses, pressures):
        result = Result(np.array(stress), float(pressure))
        if solid:
            result.state = solid.step()
            result.solid = solid.tangents(conditions)
            if solid.floating:
                warnings.append(f"state {len(results)}: {solid.floating}; the compliance is not reliable")
            result.fluid = fluid_storage(scene, solid, result.state)
            if inner:
                result.inner = solid.inner(Inner(scene, solid.boundary, inner))
        if flow:
            openings = solid.widenings() if solid and solid.free.model.mesh.fractures else None
            for name in conditions:
                if name != "uniform" or not flow.impermeable:
                    result.permeability[name] = flow.permeability(name, openings)
                    result.flow_errors[name] = flow.error
            if inner and not flow.impermeable:
                result.permeability["inner"] = flow.inner(Inner(scene, flow.boundary, inner))
        results.append(result)
    block = solid or flow
    return Upscaled(2 if stresses.shape[1] == 3 else 3, block.volume, results,
                    warnings + warnings_of(results, largest, sliding), block.boundary.corners())


def path_of(scene, stresses, pressures, comm):
    """Returns the arrays of stresses and pressures of a path, checked."""
    dim = dimension_of(scene, comm)
    n = n_components(dim)
    if stresses is None:
        stresses = [uniform_stress(scene, dim)]
    stresses = np.atleast_2d(np.asarray(stresses, float))
    if stresses.ndim != 2 or stresses.shape[1] != n:
        raise _sprekk.Error(f"stresses: have {stresses.shape[-1]} components, must have {n}: "
                            + ", ".join(names(dim)))
    if pressures is None:
        pressures = np.full(len(stresses), initial_pressure(scene))
    pressures = np.atleast_1d(np.asarray(pressures, float))
    if len(pressures) != len(stresses):
        raise _sprekk.Error(f"pressures: are {len(pressures)}, must be as many as the stresses, {len(stresses)}")
    for name, values in (("stresses", stresses), ("pressures", pressures)):
        if not np.all(np.isfinite(values)):
            number = int(np.argwhere(~np.isfinite(values))[0, 0])
            raise _sprekk.Error(f"{name}: state {number} has a value that is not finite")
    return stresses, pressures


def dimension_of(scene, comm=MPI.COMM_WORLD):
    return outline_of(scene, comm)[0]


def deforms(scene):
    """Returns whether the rock is elastic."""
    rigid = scene.all_entries.get("Flow", {}).get("rigid rock", False)
    return not rigid and any(name in material for material in scene.all_entries["Materials"].values()
                             for name in ELASTIC)


def fluid_storage(scene, solid, state):
    """Returns the storage due to the compressibility of fluid and grains, 1/Pa, or None if entries are not uniform."""
    entries = scene.all_entries
    of_fluid = float(entries.get("Flow", {}).get("compressibility", 0))
    mesh, comm = solid.free.model.mesh, solid.comm
    of_region = []
    for region in mesh.regions:
        own = entries.get("Regions", {}).get(region, {}).get("material")
        rock = entries["Materials"][own or entries["Bulk"]["material"]]
        try:
            modulus, porosity = rock.get("Biot modulus"), float(rock.get("porosity", 0))
            of_region.append(1 / float(modulus) if modulus else
                             float(rock.get("compressibility of pores", 0)) + porosity * of_fluid)
        except (TypeError, ValueError):
            return None
    if is_impermeable(scene):
        of_region = [0.0] * len(of_region)
    volumes = solid.region_volumes()
    rock = float(np.dot(of_region, volumes)) / solid.volume
    area = comm.allreduce(float(np.sum(mesh.face_area))) if mesh.fractures else 0.0
    return rock + state.aperture * area * of_fluid / solid.volume


def warnings_of(results, largest, sliding):
    """Returns warnings about the two conditions: too different, or in the wrong order."""
    found = []
    for number, result in enumerate(results):
        pairs = {"permeability": result.permeability,
                 "compliance": {name: tangent.compliance for name, tangent in result.solid.items()}}
        for name, of in pairs.items():
            if not {*CONDITIONS} <= {*of}:
                continue
            lower, upper = (of[conditions] for conditions in BOUNDS[name])
            ratio = largest_ratio(lower, upper)
            if ratio > largest:
                found.append(f"state {number}: {name}: the tensors of linear and uniform conditions differ by a factor "
                             f"of {ratio:.3g}, more than {largest:g}; the block is too small for an equivalent medium")
            slips = name == "compliance" and sliding == "slip" and results[number].state.sliding > 0
            if excess(lower, upper) > ORDER and not slips:
                found.append(f"state {number}: {name}: the bounds are not ordered")
    return found
