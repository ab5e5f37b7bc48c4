"""Balances of fluid and energy of a run, from its output files and docs/model/flow.md and heat.md.

All fluid volumes are at reference conditions. The rate of the fluid stored in rock and fractures equals the
inflow:

    sum_K R_K + sum_F R_F + alpha dV/dt = inflows + rates of wells + sources

with R of a cell d(V (phi + c (p - p_i)) e d)/dt - V beta dT/dt and of a face d(A a e d)/dt - beta_f A m dT/dt.
Here V is the volume change due to the displacement of the rock surfaces; e and d are the density factors for
pressure and temperature. Rates are those of implicit Euler or BDF2. For energy:

    sum_K (C V dT/dt + c T_K R_K) + sum_F (C_F A (d(m T)/dt - T dm/dt) + c T_F R_F)
        = heat_inflows + c sum_b Q_b T_b + heat of wells + c sum (sources) T

with the heat capacity c of the fluid. Temperatures are relative to a temperature of the scene, so that the
fluid balance times a temperature cannot hide an error. The files do not state which of its two cells receives
the fluid that a fracture face displaces by its bubble deformation. With a Biot coefficient above 0, the
difference in heat is bounded, and this bound is subtracted."""
from dataclasses import dataclass, field

import numpy as np

from joint_laws import JointLaw
from violation import FIRST_KINDS, HISTORIES
from perf.coupled.written import number, numbers

ROUNDING = 1e-8  # relative to stored fluid and heat per step; 1e-6 of it is their rounding over all cells
LONGER = 2.4  # a step longer than LONGER times the previous one uses implicit Euler


@dataclass
class Balance:
    """Balance of one step: surplus (stored minus inflow), scale of the run, and bound of the unknown part."""
    time: float
    surplus: float
    scale: float
    unknown: float = 0.0


@dataclass
class Stored:
    """Stored fluid and heat at the end of a step. Arrays by cell or by face."""
    pores: np.ndarray        # V (phi + c (p - p_i)) e d, m^3
    faces: np.ndarray        # A m, m = a e d, m^3
    rock: np.ndarray         # alpha times the volume gain of the rock by its nodes, m^3, by cell
    bubbles: np.ndarray      # remaining volume: opening of faces beyond their nodes
    T: np.ndarray = None
    T_faces: np.ndarray = None


@dataclass
class Constants:
    """Constants of the scene, by cell and by face."""
    volume: np.ndarray
    area: np.ndarray
    porosity: np.ndarray
    growth: np.ndarray
    alpha: float
    start_aperture: np.ndarray
    start_opening: np.ndarray
    minimum: np.ndarray
    capacity: np.ndarray
    face_capacity: np.ndarray
    beta: np.ndarray
    p_start: np.ndarray = field(default=None)
    p_start_faces: np.ndarray = field(default=None)


class Balances:
    """Balances of the steps of a run. `notes` contains the reasons for skipped checks."""

    def __init__(self, written):
        self.run, self.notes = written, []
        self.steps = written.results["steps"]
        self.flows, self.heats = "Flow" in written.entries, "Heat" in written.entries
        self.rigid = written.text("Bulk", "rigid") == "true" or written.text("Flow", "rigid rock") == "true"
        self.fluid_kind = written.text("Heat", "fluid", default="constant")
        number = written.number
        self.c_f, self.p_0 = number("Flow", "compressibility", default=0), number("Flow", "reference pressure", default=0)
        self.c = number("Heat", "fluid heat capacity", default=0) if self.flows else 0
        self.beta_f = number("Heat", "fluid thermal expansion", default=0)
        self.T_ref = number("Heat", "reference temperature", default=293.15)
        self.T_i = written.value(written.text("Heat", "initial temperature", default="0")) if self.heats else 0.0
        self.k = self._constants()

    # ---- constants of the scene ------------------------------------------------------------------------------------

    def _of_cells(self, name, default=0.0):
        """[cell] Entry of the rock material."""
        run, bulk = self.run, self.run.states[0].bulk
        names = self._rock_names()
        values = {}
        for k, material in enumerate(names):
            entry = run.entries["Materials"][material].get(name)
            values[k] = default if entry in (None, "", "{}") else number(entry)
        return np.array([values[int(k)] for k in bulk.cell_data["material"]])

    def _rock_names(self):
        """Material names by region number: the material of `Bulk` first, then those of the regions."""
        run = self.run
        regions = sorted(run.entries.get("Mesh", {}).get("regions", {}))
        given = {name: run.entries.get("Regions", {}).get(name, {}).get("material") for name in regions}
        main = run.text("Bulk", "material")
        return [main] + [given[name] or main for name in regions]

    def _joints(self):
        run = self.run
        laws = []
        for name in run.fracture_names:
            entries = run.entries["Materials"][run.entries["Fractures"][name]["material"]]
            laws.append(JointLaw(lambda entry, default, e=entries: number(e.get(entry), default),
                                 lambda role, e=entries: e.get(role) or FIRST_KINDS[role]))
        return laws

    def _constants(self):
        run, first = self.run, self.run.states[0]
        bulk, fractures = first.bulk, first.fractures
        rock = {name: self._of_cells(long) for name, long in (
            ("porosity", "porosity"), ("pores", "compressibility of pores"), ("capacity", "volumetric heat capacity"),
            ("expansion", "thermal expansion"))}
        modulus, biot = self._of_cells("Biot modulus", np.nan), self._of_cells("Biot coefficient", 1.0)
        growth = np.where(np.isnan(modulus), rock["pores"], 1 / modulus - rock["porosity"] * self.c_f)
        of_fluid = self.beta_f if self.fluid_kind == "constant" else 0
        beta = rock["porosity"] * of_fluid + (biot - rock["porosity"]) * 3 * rock["expansion"]
        self.uniform_biot = np.ptp(biot) == 0
        alpha = 0.0 if self.rigid or not self.flows else float(biot[0])
        none = np.zeros(0)
        k = Constants(bulk.sizes, none, rock["porosity"], growth, alpha, none, none, none, rock["capacity"], none, beta)
        k.p_start = self._start_pressures(bulk.centres)
        if fractures is None:
            k.p_start_faces = none
            return k
        k.area, k.p_start_faces = fractures.sizes, self._start_pressures(fractures.centres)
        n = len(k.area)
        k.start_aperture, k.start_opening, k.minimum, k.face_capacity = (np.zeros(n) for _ in range(4))
        for j, law in enumerate(self._joints()):
            on = fractures.cell_data["fracture"].astype(int) == j
            k.start_opening[on] = self._start_opening(law, fractures, on, k.p_start_faces[on])
            k.minimum[on] = law.entry("residual aperture", 0) if self.flows else 0
            k.start_aperture[on] = law.entry("initial aperture", 0) + k.start_opening[on]
            k.face_capacity[on] = law.entry("volumetric heat capacity", self.c)
        return k

    def _start_pressures(self, centres):
        if not self.flows:
            return np.zeros(len(centres))
        text = self.run.text("Flow", "initial pressure", default="0")
        return np.array([self.run.value(text, 0.0, x) for x in centres])

    def _start_opening(self, law, fractures, on, pressure):
        """[face] Contact gap of faces under the initial stress; 0 without initial stress."""
        stress = self.run.text("Bulk", "initial stress")
        if self.rigid or stress in ("", "{}"):
            return np.zeros(on.sum())
        values, dim = numbers(stress), self.run.results["mesh"]["dimension"]
        tensor = np.diag(values[:3])
        tensor[0, 1] = tensor[1, 0] = values[3]
        if dim == 3:
            tensor[1, 2] = tensor[2, 1] = values[4]
            tensor[0, 2] = tensor[2, 0] = values[5]
        normal = normals(fractures)[on]
        faces = SomeFaces.at_start(np.minimum(np.einsum("fi,ij,fj->f", normal, tensor, normal) + pressure, 0))
        return law.closed_gap(faces)

    # ---- states and rates -----------------------------------------------------------------------------------------------

    def density(self, p, T):
        e = np.exp(self.c_f * (p - self.p_0)) if self.c_f else np.ones_like(p)
        if self.fluid_kind == "constant" or T is None:
            return e
        if self.fluid_kind == "exponential":
            return e * np.exp(-self.beta_f * (T - self.T_ref))
        return e * water_density(T) / water_density(self.T_ref)

    def stored(self, state):
        """Stored quantities at the end of a step; `state` None: at the start of the run."""
        k = self.k
        rock, bubbles = np.zeros_like(k.volume), np.zeros_like(k.area)
        if state is None:
            T, T_faces = ((np.full_like(x, self.T_i) for x in (k.volume, k.area)) if self.heats else (None, None))
            p, p_faces, opening = k.p_start, k.p_start_faces, k.start_opening
        else:
            bulk = state.bulk.cell_data
            faces = state.fractures.cell_data if state.fractures else {}
            zero = np.zeros_like(k.area)
            T, T_faces = (bulk["temperature"], faces.get("fracture temperature", zero)) if self.heats else (None, None)
            p, p_faces = bulk.get("pressure", k.p_start), faces.get("fracture pressure", k.p_start_faces)
            opening = faces["opening"] if "opening" in faces and self.flows and not self.rigid else k.start_opening
            if k.alpha:
                rock, bubbles = self.made_room(state.bulk.point_data["displacement"], k.area * (opening - k.start_opening))
        aperture = self.aperture(opening)
        pores = k.volume * (k.porosity + k.growth * (p - k.p_start)) * self.density(p, T) if self.flows else 0 * k.volume
        m = aperture * (self.density(p_faces, T_faces) if self.flows else 1)
        return Stored(pores, k.area * m, rock, bubbles, T, T_faces)

    def made_room(self, displacement, opened):
        """[cell], [face] alpha times the volume gain of cells, m^3: by their nodes, and by the opening of faces
        beyond the nodes."""
        faces, alpha = self.run.faces, self.k.alpha
        swept = faces.swept(displacement)
        by_nodes = np.bincount(faces.cell, swept, len(self.k.volume))
        on = faces.fracture >= 0
        return alpha * by_nodes, -alpha * (opened + np.bincount(faces.fracture[on], swept[on], len(opened)))

    def aperture(self, opening):
        """[face] Aperture that stores fluid."""
        k = self.k
        minimum = k.minimum if self.flows else 1e-9 * np.ptp(self.run.states[0].bulk.points, axis=0).max()
        return np.maximum(k.start_aperture + opening - k.start_opening, minimum)

    def rates(self, factor, now, old, older):
        nu, beta = factor
        rate = nu * (now - old)
        return rate if older is None or beta == 0 else rate - beta * (old - older)

    def factors(self, number, times):
        """Factors (nu, beta) of the rate in this step; None if they are unknown because a step was bisected."""
        bdf = self.run.text("Time", "scheme") == "BDF2"
        dt = times[number + 1] - times[number]
        if self.steps[number]["substeps"] != 1:
            return None
        changed = self.steps[number].get("stage") != self.steps[number - 1].get("stage") if number else True
        if not bdf or number == 0 or changed:
            return 1 / dt, 0.0
        if self.steps[number - 1]["substeps"] != 1:
            return None
        w = dt / (times[number] - times[number - 1])
        return (1 / dt, 0.0) if w >= LONGER else ((1 + 2 * w) / (1 + w) / dt, w * w / (1 + w) / dt)

    def fluid_rates(self, factor, now, old, older):
        """[cell], [face] fluid rates R, and [face] the rate by bubble deformation of the rock."""
        cells = self.rates(factor, now.pores, old.pores, older and older.pores)
        faces = self.rates(factor, now.faces, old.faces, older and older.faces)
        cells = cells + self.rates(factor, now.rock, old.rock, older and older.rock)
        rock = self.rates(factor, now.bubbles, old.bubbles, older and older.bubbles)
        if self.heats:
            cells = cells - self.k.volume * self.k.beta * self.rates(factor, now.T, old.T, older and older.T)
            if self.fluid_kind == "constant" and self.beta_f:
                faces = faces - self.beta_f * self.carried(factor, now, old, older)
        return cells, faces, rock

    def carried(self, factor, now, old, older):
        """[face] A (d(m T)/dt - T dm/dt)"""
        nu, beta = factor
        rate = nu * old.faces * (now.T_faces - old.T_faces)
        if older is None or beta == 0:
            return rate
        return rate + beta * ((old.faces - older.faces) * (now.T_faces - old.T_faces) - older.faces * (old.T_faces - older.T_faces))

    # ---- balances -------------------------------------------------------------------------------------------------------

    def steps_with_states(self):
        """Yields (number, factors, state, stored now, before, and before that) of the steps with known rates."""
        times = [self.run.number("Time", "start", default=0)] + [step["time"] for step in self.steps]
        if len(self.run.states) != len(self.steps):
            self.notes.append("not all steps are written: no balances")
            return
        stored = [self.stored(None)] + [self.stored(state) for state in self.run.states]
        for number, state in enumerate(self.run.states):
            factor = self.factors(number, times)
            if factor is None:
                self.notes.append(f"t = {state.time:g}: a step was cut")
                continue
            older = stored[number - 1] if number > 0 else None
            yield number, factor, state, stored[number + 1], stored[number], older

    def sources(self, t):
        """Fluid sources of [cell] and [face], m^3/s."""
        run, first = self.run, self.run.states[0]
        of_rock = np.full_like(self.k.volume, run.value(run.text("Flow", "source", default="0"), t)) * self.k.volume
        of_faces = np.zeros_like(self.k.area)
        for j, name in enumerate(run.fracture_names):
            text = run.entries["Fractures"][name].get("source") or "0"
            of_faces[first.fractures.cell_data["fracture"].astype(int) == j] = run.value(text, t)
        return of_rock, of_faces * self.k.area

    def of_fluid(self):
        """[step] Balance of fluid."""
        all_ = []
        if not self.flows:
            return all_
        if not self.uniform_biot and self.k.alpha:
            self.notes.append("Biot's coefficient is not uniform: no balance of fluid")
            return all_
        if self.k.alpha and any(self.run.faces.beyond_nodes(state.bulk.point_data.get("tip displacement")) for state in self.run.states):
            self.notes.append("a crack tip is next to the boundary: no balance of fluid")
            return all_
        for number, factor, state, now, old, older in self.steps_with_states():
            step = self.steps[number]
            cells, faces, rock = self.fluid_rates(factor, now, old, older)
            incoming = [*step.get("inflows", {}).values(), *step.get("region_inflows", {}).values(),
                        *(well["rate"] for well in step.get("wells", {}).values())]
            of_rock, of_faces = self.sources(state.time)
            given = sum(incoming) + of_rock.sum() + of_faces.sum()
            in_pores = (self.k.volume * self.k.growth * (abs(self.k.p_start) + abs(state.bulk.cell_data["pressure"]))).sum()
            minimum = ROUNDING * factor[0] * (abs(now.pores).sum() + in_pores + abs(now.faces).sum() + self.in_rock(now))
            scale = max(sum(map(abs, incoming)) + abs(of_rock).sum() + abs(of_faces).sum(),
                        abs(cells).sum() + abs(faces).sum() + abs(rock).sum(), minimum)
            all_.append(Balance(state.time, cells.sum() + faces.sum() + rock.sum() - given, scale))
        return all_

    def in_rock(self, now):
        """alpha V u/L, m^3, for the largest volume change of a cell."""
        return len(now.rock) * abs(now.rock).max(initial=0) + abs(now.bubbles).sum()

    def of_energy(self):
        """[step] Balance of energy; empty if the temperature of fluid that crosses a boundary is unknown."""
        all_ = []
        if not self.heats:
            return all_
        reference = self.T_i
        for number, factor, state, now, old, older in self.steps_with_states():
            step, k = self.steps[number], self.k
            carried_in = self.carried_through_boundaries(step, state.time, reference)
            if carried_in is None:
                self.notes.append("fluid passes a boundary without a temperature: no balance of energy")
                return all_
            conducted = sum(step.get("heat_inflows", {}).values()) + sum(step.get("region_heat_inflows", {}).values())
            source = self.run.value(self.run.text("Heat", "source", default="0"), state.time) * k.volume.sum()
            parts = [k.capacity * k.volume * self.rates(factor, now.T, old.T, older and older.T),
                     k.face_capacity * self.carried(factor, now, old, older)]
            wells = [w["heat"] - self.c * w["rate"] * reference for w in step.get("wells", {}).values()] if self.flows else []
            unknown, friction = 0.0, self.friction(number, factor)
            if self.flows:
                cells, faces, rock = self.fluid_rates(factor, now, old, older)
                of_rock, of_faces = self.sources(state.time)
                parts += [self.c * (now.T - reference) * (cells - of_rock), self.c * (now.T_faces - reference) * (faces - of_faces),
                          self.c * (self.beside(now.T) - reference) * rock]
                unknown = self.unknown(now, rock)
            given = conducted + source + sum(carried_in) + sum(wells) + friction
            scale = max(sum(abs(part).sum() for part in parts),
                        abs(source) + abs(friction) + sum(map(abs, wells)) + sum(map(abs, carried_in))
                        + sum(map(abs, step.get("heat_inflows", {}).values())),
                        ROUNDING * factor[0] * ((k.capacity * k.volume * now.T).sum() + (k.face_capacity * now.faces * now.T_faces).sum()))
            all_.append(Balance(state.time, sum(part.sum() for part in parts) - given, scale, unknown))
        return all_

    def carried_through_boundaries(self, step, t, reference):
        """[boundary] c Q (T - reference), W; None if the temperature of a boundary is unknown."""
        parts = []
        for boundary, flow in step.get("inflows", {}).items() if self.flows else ():
            held = {self.run.value(c["temperature"], t) for c in self.run.entries["Boundary conditions"].values()
                    if c.get("boundary") == boundary and c.get("temperature") and not c.get("heat transfer coefficient")
                    and not c.get("fracture") and not c.get("region")}
            if len(held) != 1 and self.c * abs(flow) > 0:
                return None
            parts.append(self.c * flow * (held.pop() - reference) if held else 0.0)
        return parts

    def friction(self, number, factor):
        """Rate of the work of friction minus that of dilation against the normal traction, W. As in the rows of the
        program, the work is differentiated as the stored energy, so that BDF2 conserves their difference."""
        if self.run.text("Heat", "heat of friction") != "true" or self.run.states[number].fractures is None or self.rigid:
            return 0.0
        nu, beta = factor
        return nu * self.friction_work(number) - (beta * self.friction_work(number - 1) if beta else 0.0)

    def friction_work(self, number):
        """Work of friction minus that of dilation during a step, J."""
        now, before = (self.plastic(self.run.states[k] if k >= 0 else None) for k in (number, number - 1))
        traction = self.run.states[number].fractures.cell_data["traction local"]
        return float((self.k.area * (traction * (now - before)).sum(axis=1)).sum())

    def plastic(self, state):
        """[face, 3] Plastic jump; its normal component is the dilation."""
        data = state and state.fractures.cell_data
        if data is None:  # at the start
            return np.zeros((len(self.k.area), 3))
        p = data["plastic jump local"].copy()
        for j, law in enumerate(self._joints()):
            on = data["fracture"].astype(int) == j
            p[on, 0] = law.lifted(SomeFaces(data["traction local"][on, 0], np.linalg.norm(p[on, 1:], axis=1),
                                            {name: data[name][on] for name in HISTORIES if name in data}))
        return p

    def beside(self, T):
        """[fracture face] Mean of the cells on both sides."""
        faces = self.run.faces
        on = faces.fracture >= 0
        return np.bincount(faces.fracture[on], T[faces.cell[on]], len(self.k.area)) / 2

    def unknown(self, now, bubbles):
        """Bound, W, on the heat of the fluid displaced by bubble deformation, whose cell is unknown."""
        temperatures = np.concatenate([now.T, now.T_faces, [self.T_i]])
        return float(self.c * np.ptp(temperatures) * abs(bubbles).sum())


def water_density(T):
    """Density of saturated liquid water, kg/m^3 (IAPWS SR1-86)."""
    x = np.cbrt(1 - T / 647.096)
    return 322 * (1 + 1.99274064 * x + 1.09965342 * x**2 - 0.510839303 * x**5 - 1.75493479 * x**16 - 45.5170352 * x**43
                  - 6.74694450e5 * x**110)


def normals(fractures):
    """[face, 3] Unit normals of either sign."""
    x = fractures.corners
    along = x[:, 1] - x[:, 0]
    if x.shape[1] == 2:
        normal = np.stack([-along[:, 1], along[:, 0], 0 * along[:, 0]], axis=1)
    else:
        normal = np.cross(along, x[:, -1] - x[:, 0])
    return normal / np.linalg.norm(normal, axis=1)[:, None]


@dataclass
class SomeFaces:
    """Argument `faces` of JointLaw."""
    normal: np.ndarray
    slip: np.ndarray
    history: dict

    @classmethod
    def at_start(cls, normal):
        return cls(normal, 0 * normal, {name: 0 * normal for name in HISTORIES})
