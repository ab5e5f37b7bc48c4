"""Random scenes of flow, heat and deformation. Scene k of a seed depends only on these two numbers."""
import math
import random

from perf.contact import random_scenes
from perf.contact.random_joints import any_joint
from perf.contact.random_scenes import SIDES, Drawn, box, rectangle, shape, turned

PHYSICS = {"flow": 12, "heat": 8, "flow-heat": 15, "thermoelastic": 8, "poro": 27, "thm": 30}  # with their shares
WATER = {"viscosity": 1e-3, "density": 1000.0}


class Draw(random_scenes.Draw):
    """Random generator and common properties of one scene. Stresses in Pa, lengths in m, times in s."""

    def __init__(self, rng, dim, physics):
        super().__init__(rng, dim)
        self.physics = physics
        self.deforms = physics in ("thermoelastic", "poro", "thm")
        self.flows = physics not in ("heat", "thermoelastic")
        self.heats = physics not in ("flow", "poro")
        self.size = float(rng.choice((1, 10, 100, 100, 500)))
        self.modulus = 10 ** rng.uniform(9.7, 10.8)
        self.stress = 10 ** rng.uniform(6.5, 7.6)           # typical compression
        self.pressure = self.stress * rng.uniform(0.1, 0.45)  # initial pressure
        self.temperature = rng.uniform(295, 420)
        self.steps = rng.randint(2, 5)
        self.permeability = self.power(-19.5, -13)
        self.porosity = rng.choice((0.0, 0.01, 0.1, 0.2))
        self.pores = rng.choice((0.0, 1e-11, 1e-10))
        self.fluid = rng.choice((0.0, 4.5e-10, 4.5e-10))
        self.biot = rng.choice((0.0, 0.5, 0.8, 1.0)) if physics == "thm" else rng.choice((0.3, 0.7, 1.0))
        self.closed = self.chance(0.35)
        if self.flows and self.closed and self.pores + self.porosity * self.fluid == 0:
            self.pores, self.fluid = 1e-11, 4.5e-10
        self.end = 1.0
        self.ends = [1.0]

    @property
    def storage(self):
        softness = self.biot**2 / self.modulus if self.deforms else 0
        return max(self.pores + self.porosity * self.fluid + softness, 1e-13)

    def set_times(self):
        """Sets the end time between a small part and a few times the diffusion time."""
        times = []
        if self.flows:
            times.append(self.size**2 * WATER["viscosity"] * self.storage / self.permeability * self.power(-4, 0.3))
        if self.heats:
            times.append(self.size**2 * 1e6 * self.power(-4, 0))
        self.end = min(max(self.rng.choice(times), 1.0), 3e9)
        even = [self.end * (k + 1) / self.steps for k in range(self.steps)]
        if self.chance(0.3):
            ratio = self.rng.choice((1.3, 2.0, 4.0))
            lengths = [ratio**k for k in range(self.steps)]
            even = [self.end * sum(lengths[:k + 1]) / sum(lengths) for k in range(self.steps)]
        self.ends = even

    def over_time(self, name, values):
        """Adds a table of values at the start and at the step ends; returns the expression of its call."""
        self.tables[name] = {"arguments": [0.0, *self.ends], "values": [float(v) for v in values]}
        return f"{name}(t)"

    def changing(self, name, value, start=None, p=0.4):
        """Returns a number or, with probability p, an expression of time that begins at `start`."""
        if not self.chance(p):
            return value
        first = value if start is None else start
        return self.over_time(name, [first] + [first + (value - first) * self.rng.uniform(0, 1) for _ in self.ends])


# Rock and joints

def rock(draw, softer=1.0):
    rng = draw.rng
    entries = {"type": "elastic"}
    if draw.deforms:
        entries |= {"Young's modulus": draw.modulus * softer, "Poisson's ratio": rng.uniform(0.05, 0.35), "density": 2600.0}
    if draw.flows:
        k = draw.permeability
        tensor = [k] if draw.chance(0.8) else [k * draw.power(-1, 0) for _ in range(draw.dim)]
        entries |= {"permeability": tensor, "porosity": draw.porosity, "compressibility of pores": draw.pores}
        if draw.deforms:
            entries["Biot coefficient"] = draw.biot
            if draw.porosity > draw.biot:
                entries["porosity"] = draw.porosity = draw.biot
    if draw.heats:
        entries |= {"thermal conductivity": [rng.uniform(1, 4)], "volumetric heat capacity": rng.uniform(1.5e6, 3e6)}
        if draw.deforms:
            entries["thermal expansion"] = rng.choice((0.0, 5e-6, 1e-5))
    return entries


def joint(draw):
    law = any_joint(draw, draw.stress - draw.pressure) if draw.deforms else {"type": "joint"}
    if draw.flows or draw.heats:
        open_ = draw.power(-5, -3.3)
        law["initial aperture"] = open_ + (closed_at_most(law, 2 * draw.stress) if draw.chance(0.9) else 0.0)
    if draw.flows:
        if draw.deforms or draw.chance(0.3):
            law["residual aperture"] = min(law["initial aperture"], open_) * draw.power(-1.5, 0)
        if draw.chance(0.2):
            law["tangential permeability"] = draw.permeability * draw.power(0, 5)
        if draw.chance(0.25):
            law["normal permeability"] = draw.permeability * draw.power(-4, 4)
        if draw.chance(0.1):
            law |= {"hydraulic aperture": "Barton"} | ({} if "joint roughness coefficient" in law else {"joint roughness coefficient": 8.0})
    if draw.heats and draw.chance(0.3):
        law["thermal conductivity"] = draw.rng.uniform(0.3, 3)
    if draw.heats and draw.chance(0.2):
        law["volumetric heat capacity"] = draw.rng.uniform(1e6, 4e6)
    return law


def closed_at_most(law, load):
    """Upper bound of the closure of a joint under a load, m."""
    if "maximum closure" in law:
        return law["maximum closure"]
    if "joint aperture" in law:
        return law["joint aperture"]
    return load / law["normal stiffness"] if "normal stiffness" in law else 0.0


# Fluid and heat

def fluid(draw):
    section = dict(WATER)
    if not draw.deforms:
        section["rigid rock"] = True
    if draw.fluid:
        section |= {"compressibility": draw.fluid, "reference pressure": draw.pressure if draw.chance(0.5) else 0.0}
    section["initial pressure"] = draw.pressure
    if draw.chance(0.1):
        section["source"] = draw.changing("source", draw.storage * 0.2 * draw.pressure / draw.end * draw.rng.uniform(-1, 1))
    if draw.chance(0.2):
        section["scheme"] = draw.rng.choice(("mimetic", "tpfa"))
    return section


def heat(draw):
    rng = draw.rng
    section = {"initial temperature": draw.temperature}
    if draw.chance(0.1):
        section["source"] = draw.changing("heating", 2e6 * 10 / draw.end * rng.uniform(-1, 1))
    if draw.chance(0.2):
        section["scheme"] = rng.choice(("mimetic", "tpfa"))
    if not draw.flows:
        return section
    section["fluid heat capacity"] = 4.2e6
    kind = rng.choice(("constant", "constant", "exponential", "water"))
    if kind != "constant":
        section |= {"fluid": kind, "reference temperature": draw.temperature}
    if kind == "exponential":
        section["viscosity decay"] = rng.uniform(0, 0.02)
    if kind != "water" and draw.chance(0.7):
        section["fluid thermal expansion"] = rng.uniform(1e-4, 8e-4)
    if not draw.bdf and draw.chance(0.3):
        section["advection"] = "second order"
    if draw.deforms and draw.fractured and draw.chance(0.3):
        section["heat of friction"] = True
    return section


def other_temperature(draw):
    return max(280.0, draw.temperature + draw.rng.choice((-20, -60, 30, -5)) * draw.rng.uniform(0.3, 1))


def of_fluid(draw, side):
    """Entries of a boundary condition for the fluid; empty for a closed boundary. A third of the scenes are closed
    everywhere."""
    rng, start = draw.rng, draw.pressure
    if draw.closed or draw.chance(0.35):
        return {}
    kind = rng.choice(("pressure", "pressure", "pressure", "flux", "conductance"))
    if kind == "flux":
        return {"flux": draw.changing(f"flux_{side}", draw.permeability / WATER["viscosity"] * 0.1 * start / draw.size * rng.uniform(-1, 1), 0.0)}
    level = start * (1.0 if draw.chance(0.4) else rng.uniform(0.7, 1.3))
    entries = {"pressure": draw.changing(f"p_{side}", level, start)}
    if kind == "conductance":
        entries["conductance"] = draw.permeability / WATER["viscosity"] / draw.size * draw.power(-1, 2)
    return entries


def of_heat(draw, side, passed):
    """Entries of a boundary condition for heat. If fluid crosses the boundary (`passed`), a temperature is likely."""
    rng = draw.rng
    if not draw.chance(0.8 if passed else 0.6):
        return {}
    T = draw.temperature if draw.chance(0.5) else other_temperature(draw)
    kind = "temperature" if passed else rng.choice(("temperature", "temperature", "temperature", "transfer", "flux"))
    if kind == "flux":
        return {"heat flux": rng.uniform(-1, 1) * 3.0 * 20 / draw.size}
    entries = {"temperature": draw.changing(f"T_{side}", T, draw.temperature)}
    return entries | ({"heat transfer coefficient": 3.0 / draw.size * draw.power(-1, 2)} if kind == "transfer" else {})


def wells(draw, high, cells, fractures):
    """Returns wells and the temperatures of the injected fluid."""
    rng, dim = draw.rng, draw.dim
    lines, temperatures = {}, {}
    size = min(h / n for h, n in zip(high, cells))
    for k in range(rng.choice((0, 1, 1, 2))):
        place = [h * (rng.randrange(n) + rng.choice((0.37, 0.61))) / n for h, n in zip(high, cells)]
        in_fracture = fractures and draw.chance(0.5)
        if in_fracture:
            lower, upper = rng.choice(list(fractures.values()))
            place = [a + rng.uniform(0.1, 0.9) * (b - a) for a, b in zip(lower, upper)]
        points = place
        if dim == 3:  # along z, or across the fracture
            axis = next(i for i in range(3) if lower[i] == upper[i]) if in_fracture else 2
            ends = sorted(rng.uniform(0.05, 0.95) for _ in range(2)) if not in_fracture else [0.0, 0.0]
            first, last = list(place), list(place)
            first[axis], last[axis] = high[axis] * ends[0], high[axis] * ends[1]
            if in_fracture:
                first[axis], last[axis] = (max(place[axis] + s * 0.4 * size, 0.0) for s in (-1, 1))
            others = [i for i in range(3) if i != axis]
            for i in others:  # not in a mesh plane, which may contain a fracture
                cell = min(int(place[i] / high[i] * cells[i]), cells[i] - 1)
                first[i] = last[i] = high[i] * (cell + rng.choice((0.37, 0.61))) / cells[i]
            if math.dist(first, last) < 0.05 * size:
                last[axis] = first[axis] + 0.05 * size
            points = first + last
        well = {"points": [float(v) for v in points], "radius": min(0.1, 0.02 * size)}
        rise = (draw.stress - draw.pressure) * rng.choice((0.1, 0.3, 0.6)) * rng.choice((1, 1, -0.5))
        if draw.chance(0.5):
            well["pressure"] = draw.changing(f"p_{k}", draw.pressure + rise, draw.pressure)
        else:
            length = 1.0 if dim == 2 else math.dist(points[:3], points[3:])
            rate = rise * draw.permeability / WATER["viscosity"] * length * draw.power(-0.5, 0.7)
            if draw.closed:
                room = draw.storage * math.prod(high) * abs(rise) / draw.end
                rate = math.copysign(min(abs(rate), room), rate)
            well["rate"] = draw.changing(f"q_{k}", rate)
        lines[f"w{k}"] = well
        if draw.heats and draw.chance(0.8):
            temperatures[f"w{k}"] = {"temperature": draw.changing(f"T_{k}", other_temperature(draw), p=0.2)}
    return lines, temperatures


# Mechanics

def initial_stress(draw):
    """Components of the total initial stress, as in the entry."""
    rng, dim = draw.rng, draw.dim
    normal = [-draw.stress * rng.uniform(0.8, 1.3) for _ in range(3)]
    shear = [draw.stress * rng.uniform(-0.15, 0.15)] + [0.0] * (0 if dim == 2 else 2)
    return normal + shear


def held(draw, sides, stress):
    """Displacement u = G(t) x on all sides, or supports on the lower sides and the initial stress on the others."""
    dim, rng = draw.dim, draw.rng
    strain = 0.15 * draw.stress / draw.modulus
    if stress is None or draw.chance(0.6):
        moves = {}
        still = draw.chance(0.5)
        rows = random_scenes.path(draw, dim * dim)
        texts = []
        for i in range(dim):
            if still:
                texts.append("0")
                continue
            terms = []
            for j in range(dim):
                values = [strain * 0.4 * v for v in rows[i * dim + j]]
                terms.append(draw.over_time(f"g{'xyz'[i]}{'xyz'[j]}", values) + "*" + "xyz"[j])
            texts.append(" + ".join(terms))
        for side in sides:
            moves[side] = {"displacement": texts}
        return moves
    loads = {}
    for k, side in enumerate(sides):
        axis, sign = divmod(k, 2)
        loads[side] = {}
        traction = [normal_component(stress, dim, i, axis) * (1 if sign else -1) for i in range(dim)]
        if sign == 0:
            loads[side]["displacement"] = ["0" if i == axis else "free" for i in range(dim)]
            traction[axis] = 0.0
        loads[side]["traction"] = traction
    return loads


def normal_component(stress, dim, i, j):
    if i == j:
        return stress[i]
    return stress[3 + {(0, 1): 0, (1, 2): 1, (0, 2): 2}[min(i, j), max(i, j)]]


# Complete scene

def tip_beside_boundary(ends, high, cells):
    """True if a fracture that ends inside the box has an end in a boundary cell."""
    spans = [[round(v / h * n) for v in pair] for *pair, h, n in zip(*ends, high, cells)]
    inside = any(a != b and (a > 0 or b < n) for (a, b), n in zip(spans, cells))
    return inside and any(a <= 1 or b >= n - 1 for (a, b), n in zip(spans, cells))


def scene(draw):
    rng, dim = draw.rng, draw.dim
    order = 2 if draw.deforms and draw.chance(0.15) else 1
    maximum = 9 // order if dim == 2 else 3 if order == 1 else 2
    cells = [rng.randint(maximum // 2 + 1, maximum) for _ in range(dim)]
    high = [draw.size * rng.choice((1, 1, rng.uniform(0.5, 2))) for _ in range(dim)]
    planes = [(axis, plane) for axis in range(dim) for plane in range(1, cells[axis])]
    chosen = rng.sample(planes, min(len(planes), rng.choice((0, 1, 2, 3, 4) if dim == 2 else (0, 1, 2))))
    fractures = {}
    for k, (axis, plane) in enumerate(chosen):
        extents = [(0, n) if draw.chance(0.4) else sorted(rng.sample(range(n + 1), 2)) for n in cells]
        fractures[f"f{k}"] = rectangle(high, cells, axis, plane, extents)
    draw.fractured = bool(fractures)
    draw.bdf = draw.chance(0.4)
    draw.set_times()
    beside = any(tip_beside_boundary(ends, high, cells) for ends in fractures.values())  # fluid balance unknown there
    more = {"order": order} | ({"tips": "plain"} if draw.chance(0.75 if beside else 0.3) else {})
    stress = initial_stress(draw) if draw.deforms and draw.chance(0.75) else None
    if not draw.deforms:
        more |= turned(draw)
    tree = box(high, cells, shape(draw), fractures, **more)
    tree["Materials"] = {"rock": rock(draw)}
    if draw.chance(0.2):
        across = high[0] * (cells[0] // 2) / cells[0]
        tree["Mesh"]["regions"] = {"other": {"lower corner": [0.0] * dim, "upper corner": [across, *high[1:]]}}
        draw.permeability *= draw.power(-2, 2)
        tree["Materials"]["softer"] = rock(draw, draw.power(-1, 0.5))
        tree["Regions"] = {"other": {"material": "softer"}}
    names = {"joint": joint(draw)} | ({"second joint": joint(draw)} if draw.chance(0.4) else {})
    tree["Fractures"] = {name: {"material": rng.choice(list(names))} for name in fractures}
    tree["Materials"] |= {name: law for name, law in names.items() if any(f["material"] == name for f in tree["Fractures"].values())}
    tree["Bulk"] = {"material": "rock"} | ({} if draw.deforms else {"rigid": True}) | ({"initial stress": stress} if stress else {})
    sides = SIDES[:2 * dim]
    conditions = {side: {"boundary": side} for side in sides}
    for side, entries in (held(draw, sides, stress) if draw.deforms else {}).items():
        conditions[side] |= {key: entries[key] for key in entries if key != "traction"}
        if "traction" in entries:
            conditions[side + " load"] = {"boundary": side, "traction": entries["traction"]}
    if draw.flows:
        add_flow(draw, tree, conditions, high, cells, {} if "rotation" in more else fractures)
    if draw.heats:
        add_heat(draw, tree, conditions)
    tree["Boundary conditions"] = {name: entries for name, entries in conditions.items() if len(entries) > 1}
    tree["Tables"] = draw.tables
    tree["Time"] = {"schedule": draw.ends} | ({"scheme": "BDF2"} if draw.bdf else {})
    if draw.chance(0.15):
        tree["Solver"] = {"Linear solver": {"type": "iterative"}}
    return tree


def add_flow(draw, tree, conditions, high, cells, fractures):
    rng = draw.rng
    tree["Flow"] = fluid(draw)
    if not draw.deforms:
        tree["Bulk"].pop("rigid")
    if draw.chance(0.25):
        tree["Bulk"]["gravity"] = [0.0] * (draw.dim - 1) + [-9.81]
        for material in tree["Materials"].values():
            if material["type"] == "elastic":
                material["density"] = 2600.0
    if "rotation" not in tree["Mesh"]:
        lines, draw.well_temperatures = wells(draw, high, cells, fractures)
        if lines:
            tree["Flow"]["Wells"] = lines
    for side in SIDES[:2 * draw.dim]:
        conditions[side] |= of_fluid(draw, side)
    for entries in tree["Fractures"].values():
        if draw.chance(0.1):
            entries["source"] = draw.permeability / WATER["viscosity"] * 0.1 * draw.pressure / draw.size * rng.uniform(-0.3, 1)
    stored = draw.pores + draw.porosity * draw.fluid > 0
    level = any("pressure" in c for c in (*conditions.values(), *tree["Flow"].get("Wells", {}).values()))
    if not level and not stored:
        conditions["west"] |= {"pressure": draw.pressure}
        conditions["west"].pop("flux", None)


def add_heat(draw, tree, conditions):
    tree["Heat"] = heat(draw)
    if draw.flows and getattr(draw, "well_temperatures", {}):
        tree["Heat"]["Wells"] = draw.well_temperatures
    for side in SIDES[:2 * draw.dim]:
        conditions[side] |= of_heat(draw, side, "pressure" in conditions[side] or "flux" in conditions[side])


def draw_scene(seed, k, attempt=0):
    """Draws scene k of a seed. Further attempts replace scenes that the program refuses as input."""
    rng = random.Random(f"coupled/{seed}/{k}")
    physics, = rng.choices(list(PHYSICS), list(PHYSICS.values()))
    dim = 2 if rng.random() < 0.65 else 3
    if attempt:
        rng = random.Random(f"coupled/{seed}/{k}/{attempt}")
    return Drawn(f"{physics}-{dim}d-{k:04}", physics, f"Scene {k} of seed {seed}, written by perf/coupled", scene(Draw(rng, dim, physics)), None)
