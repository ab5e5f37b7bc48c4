"""Checks of a coupled run from its output files. Each check returns lines that describe the violations."""
import re

import numpy as np

import violation
from perf.coupled.balances import Balances

BALANCE = 1e-6      # relative to the largest flow of the run
OVERSHOOT = 1e-3    # relative to the range of the given temperatures
CONTACT = 1e-8      # relative to displacement or traction, as in perf/contact
ROUNDING = 1e-12    # of an aperture, relative to the displacement
SAYS_OVERSHOOT = re.compile(r"warning: .*temperatures are more than .* K beyond the given ones")


def balances(written):
    """Returns (lines, largest surplus of fluid and of energy beyond the unknown part, relative to the scale)."""
    lines, worst, own = [], [], Balances(written)
    for what, steps in (("fluid", own.of_fluid()), ("energy", own.of_energy())):
        scale = max((step.scale for step in steps), default=0)
        off = [(max(abs(step.surplus) - step.unknown, 0) / scale, step) for step in steps] if scale > 0 else []
        maximum, step = max(off, key=lambda pair: pair[0], default=(0.0, None))
        worst.append(maximum if steps else None)
        if not maximum <= BALANCE:
            lines.append(f"balance of {what}: {step.surplus:.3e} per s more is stored at t = {step.time:g} than comes in, {maximum:.1e} of "
                         f"the largest flow, {scale:.3e}")
    return lines, worst


def given_temperatures(written):
    """Range of the temperatures given in the scene; None with heat sources, heat fluxes or heat of friction."""
    entries = written.entries
    heat = entries["Heat"]
    conditions = entries.get("Boundary conditions", {}).values()
    if heat.get("source", "0") not in ("0", "0.0") or heat.get("heat of friction") == "true" or any(c.get("heat flux") for c in conditions):
        return None
    texts = [c["temperature"] for c in conditions if c.get("temperature")]
    texts += [c["temperature"] for c in entries.get("Regions", {}).values() if isinstance(c, dict) and c.get("temperature")]
    texts += [c["temperature"] for c in heat.get("Wells", {}).values()]
    times = [0.0] + [step["time"] for step in written.results["steps"]]
    values = [written.value(heat["initial temperature"])] + [written.value(text, t) for text in texts for t in times]
    return min(values), max(values)


def temperatures(written, log):
    """Checks that temperatures stay in the given range, unless the run warns about the overshoot. Returns (lines,
    overshoot)."""
    given = given_temperatures(written) if "Heat" in written.entries else None
    if given is None:
        return [], None
    low, high = given
    worst, where = 0.0, ""
    for state in written.states:
        for grid, name in ((state.bulk, "temperature"), (state.fractures, "fracture temperature")):
            if grid:
                T = grid.cell_data[name]
                for beyond in (T.max() - high, low - T.min()):
                    if beyond > worst:
                        worst, where = beyond, f'"{name}" at t = {state.time:g}'
    share = worst / max(high - low, 1e-6 * high)
    if share <= OVERSHOOT or SAYS_OVERSHOOT.search(log):
        return [], share
    return [f"{where} is {worst:.3g} K beyond the given temperatures, {low:.6g} to {high:.6g} K, {share:.1%} of their span"], share


def apertures(written):
    lines = []
    for state in written.states:
        if not state.fractures:
            continue
        data = state.fractures.cell_data
        size = np.abs(data["jump"]).max(initial=0) if "jump" in data else 0
        for name in ("aperture", "hydraulic aperture"):
            minimum = data[name].min(initial=0) if name in data else 0
            if not minimum >= -ROUNDING * max(size, 1e-3):
                lines.append(f'"{name}" is {minimum:.3e} m at t = {state.time:g}')
    return lines[:1]


def finite(written):
    for state in written.states:
        for grid in (state.bulk, state.fractures):
            for name, values in {**grid.cell_data, **grid.point_data}.items() if grid else ():
                if not np.isfinite(values).all():
                    return [f'"{name}" at t = {state.time:g} has values that are no numbers']
    return []


def rounding_of_stress(written):
    """Thermal stress due to round-off of the temperature, Pa."""
    level = written.value(written.entries["Heat"]["initial temperature"]) if "Heat" in written.entries else 0
    stiffness = max((float(m.get("Young's modulus", 0)) * abs(float(m.get("thermal expansion", 0)))
                     for m in written.entries["Materials"].values()), default=0)
    return 1e-13 * stiffness * level


def contact(written):
    """Returns (lines, violation) of the contact and friction laws."""
    first = written.states[0].fractures if written.states else None
    if first is None or "traction local" not in first.cell_data:
        return [], None
    if max(np.abs(state.fractures.cell_data["traction local"]).max() for state in written.states) <= rounding_of_stress(written):
        return [], 0.0
    input_ = violation.Input(written.directory / "effective_input.xml")
    *_, worst, _ = violation.largest(written.directory, written.results, input_)
    k = int(worst.argmax())
    if worst.max() <= CONTACT:
        return [], float(worst.max())
    return [f"laws of contact: {violation.PARTS[k]} {worst[k]:.1e}"], float(worst.max())
