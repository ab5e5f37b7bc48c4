"""Differences between the results of two runs of one scene, relative to the largest values of the first.

Cells and faces are matched by place, fractures by name, nodes by their cell and their place in it."""
import numpy as np

LENGTHS = ("displacement", "jump", "opening", "slip", "widening")
STRESSES = ("stress", "traction", "largest compression")
LEFT_OUT = ("rank", "material", "fracture", "single fracture", "state", "has slipped", "mobilised strength", "error of damage history")
ROUNDING, ALLOWED = 1e-14, 1e-8  # round-off relative to the level of pressure and temperature; allowed difference
OF_APERTURE = 1e-12  # round-off of an aperture, relative to the displacement
NEAR = 1e-9  # distance from the limit between two contact states, within which either state is accepted


class Scales:
    """Largest values of a run by kind of array."""

    def __init__(self, written):
        self.start = {"pressure": _start(written, "Flow", "initial pressure"), "temperature": _start(written, "Heat", "initial temperature")}
        self.largest = {}
        for state in written.states:
            for grid in (state.bulk, state.fractures):
                for name, values in {**grid.cell_data, **grid.point_data}.items() if grid else ():
                    kind = kind_of(name)
                    size = np.abs(values - self.start.get(kind, 0)).max(initial=0)
                    self.largest[kind] = max(self.largest.get(kind, 0), size, 1e-5 * abs(self.start.get(kind, 0)))
        self._min_fluxes(written)
        if self.start["pressure"]:  # stress caused by the initial pressure
            self.largest["stress"] = max(self.largest.get("stress", 0), abs(self.start["pressure"]))
        self._min_stresses(written)
        for kind in self.largest:
            if "aperture" in kind:
                self.largest[kind] = max(self.largest[kind], OF_APERTURE / ALLOWED * self.largest.get("length", 0))

    def _min_fluxes(self, written):
        """Raises the scales of fluxes to their round-off.

        The round-off of driving pressures and temperatures is 1e-14 of their level; it is multiplied by the
        conductance of a cell, and that of temperature also by the heat capacity of the flow."""
        first = written.states[0]
        edge = (first.bulk.sizes.min()) ** (1 / first.bulk.dim)
        level = abs(self.start["pressure"]) + self.largest.get("pressure", 0)
        mobility = max((float(word) for m in written.entries["Materials"].values()
                        for word in m.get("permeability", "{}").strip("{}").split(",") if word.strip()), default=0)
        mu = written.number("Flow", "viscosity", default=1e-3)
        apertures = [state.fractures.cell_data.get("hydraulic aperture", np.zeros(1)).max() for state in written.states if state.fractures]
        open_ = max(apertures, default=0) ** 3 / 12
        for kind, conducts in (("Darcy velocity", mobility), ("fluid flux", open_)):
            if kind in self.largest:
                self.largest[kind] = max(self.largest[kind], ROUNDING / ALLOWED * level * conducts / mu / edge)
        if "heat flux" in self.largest:
            level = self.start["temperature"] + self.largest["temperature"]
            conducts = max((float(word) for m in written.entries["Materials"].values()
                            for word in m.get("thermal conductivity", "{}").strip("{}").split(",") if word.strip()), default=0)
            carries = written.number("Heat", "fluid heat capacity", default=0) * self.largest.get("Darcy velocity", 0)
            self.largest["heat flux"] = max(self.largest["heat flux"], ROUNDING / ALLOWED * level * (conducts / edge + carries))

    def _min_stresses(self, written):
        """Thermal stress and expansion are known to the rounding of temperature, strains to that of stress: 1e-14 of its level."""
        rocks = [m for m in written.entries["Materials"].values() if "Young's modulus" in m]
        level = ROUNDING / ALLOWED * (abs(self.start["temperature"]) + self.largest.get("temperature", 0))
        expansion = level * max((float(m.get("thermal expansion", 0)) for m in rocks), default=0)
        stiffness = max((float(m["Young's modulus"]) for m in rocks), default=0)
        softest = min((float(m["Young's modulus"]) for m in rocks), default=np.inf)
        strain = expansion + ROUNDING / ALLOWED * self.largest.get("stress", 0) / softest
        extent = np.ptp(written.states[0].bulk.points, axis=0).max()
        for kind, minimum in (("stress", stiffness * expansion), ("length", extent * strain)):
            if kind in self.largest:
                self.largest[kind] = max(self.largest[kind], minimum)

    def of(self, name):
        return self.largest.get(kind_of(name), 0) or 1.0


def _start(written, section, entry):
    text = written.text(section, entry, default="0")
    try:
        return written.value(text)
    except Exception:
        return 0.0


def kind_of(name):
    for kind in ("pressure", "temperature"):
        if kind in name:
            return kind
    if any(word in name for word in STRESSES):
        return "stress"
    if name.startswith("damage history") or any(word in name for word in LENGTHS):
        return "length"
    return name


def order(grid, names=()):
    """Order of cells by place and by name of their fracture."""
    extent = max(np.ptp(grid.points, axis=0).max(), 1e-300)
    place = np.round(grid.centres / extent * 1e6 + 0.3123).astype(np.int64)
    keys = [place[:, 2], place[:, 1], place[:, 0]]
    if names:
        numbers = grid.cell_data["fracture"].astype(int)
        keys.append(np.argsort(np.argsort(names))[numbers])
    return np.lexsort(keys)


def at_nodes(grid, cells, name):
    """Values of point data at the nodes of these cells: [cell, node, ...], with nodes ordered by place."""
    nodes = grid.cells[cells]
    extent = max(np.ptp(grid.points, axis=0).max(), 1e-300)
    place = np.round(grid.points[nodes] / extent * 1e7 + 0.3123).astype(np.int64)
    nodes = np.take_along_axis(nodes, np.lexsort((place[..., 2], place[..., 1], place[..., 0])), axis=1)
    return grid.point_data[name][nodes]


def largest(one, other, rename=lambda name: name, scales=None):
    """Returns (relative difference, array and time) of two runs. `rename` maps fracture names of the other run to
    the first."""
    if len(one.states) != len(other.states):
        return np.inf, f"{len(one.states)} states are written, and {len(other.states)}"
    scales, worst = scales or Scales(one), (0.0, "")
    for a, b in zip(one.states, other.states):
        pairs = [(a.bulk, b.bulk, (), ())]
        if a.fractures:
            pairs.append((a.fractures, b.fractures, one.fracture_names, [rename(name) for name in other.fracture_names]))
        for left, right, names, others in pairs:
            i, j = order(left, names), order(right, others)
            for name, values in left.cell_data.items():
                if name not in LEFT_OUT:
                    size = np.abs(values[i] - right.cell_data[name][j]).max(initial=0) / scales.of(name)
                    worst = max(worst, (size, f'"{name}" at t = {a.time:g}'))
            for name in left.point_data:
                if name not in LEFT_OUT:
                    difference = at_nodes(left, i, name) - at_nodes(right, j, name)
                    worst = max(worst, (np.abs(difference).max(initial=0) / scales.of(name), f'"{name}" at t = {a.time:g}'))
    return max(worst, of_numbers(one, other, rename, scales))


def of_numbers(one, other, rename, scales):
    """Returns the largest difference of wells and boundary inflows."""
    worst = 0.0, ""
    steps = list(zip(one.results["steps"], other.results["steps"]))
    for key in ("inflows", "heat_inflows"):
        size = max((abs(v) for a, _ in steps for v in a.get(key, {}).values()), default=0)
        worst = max([worst] + [(abs(v - b[key][name]) / max(size, _minimum(one, scales, key)), f"{key} of {name} at t = {a['time']:g}")
                               for a, b in steps for name, v in a.get(key, {}).items()])
    largest_of = {key: max((abs(well.get(key, 0)) for a, _ in steps for well in a.get("wells", {}).values()), default=0)
                  for key in ("rate", "heat")}
    for a, b in steps:
        for name, well in a.get("wells", {}).items():
            there = {_own(key, rename): v for key, v in b["wells"][name].items()}
            for key, value in well.items():
                size = scales.of(key) if key in ("pressure", "temperature") else max(largest_of.get(key, largest_of["rate"]), 1e-300)
                worst = max(worst, (abs(value - there[key]) / size, f"{key} of well {name} at t = {a['time']:g}"))
    return worst


def _own(key, rename):
    return "in " + rename(key[3:]) if key.startswith("in ") and key != "in rock" else key


def _minimum(written, scales, key):
    """Smallest scale of a boundary flow: scale of the flux density times the area of a side."""
    bulk = written.states[0].bulk
    area = bulk.sizes.sum() ** (1 - 1 / bulk.dim)
    return scales.of("Darcy velocity" if key == "inflows" else "heat flux") * area
