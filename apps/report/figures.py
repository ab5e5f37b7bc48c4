"""Key figures: tables of the last step, and of the cost of the run."""

from collections import namedtuple

import numpy as np
from numbers_in_words import RATES, in_unit, number, quantity, unit_of

Table = namedtuple("Table", "title columns rows note")
MAX_ROWS = 30
NOISE = 1e-9  # round-off relative to the largest value of a column

OF_FRACTURES = [
    ("area", "area", "m²"),
    ("area_at_start", "area at the start", "m²"),
    ("first_slip", "first slip after", "s"),
    ("fraction_slip", "slipping at the end", "%"),
    ("fraction_has_slipped", "slipped in contact", "%"),
    ("fraction_open", "open at the end", "%"),
    ("mean_slip", "mean slip", "m"),
    ("max_slip", "largest slip", "m"),
    ("max_opening", "largest opening", "m"),
    ("slip_tendency", "slip tendency", ""),
    ("max_fracture_pressure", "largest pressure", "Pa"),
    ("area_broken", "broken area", "m²"),
    ("fracture_energy", "fracture energy", "J"),
    ("lost_energy", "energy lost in growth", "J"),
    ("friction_energy", "energy dissipated by slip", "J"),
    ("fluid_volume", "fluid volume", "m³"),
    ("leaked_volume", "leaked volume", "m³"),
    ("moment", "moment", "N m"),
    ("moment_magnitude", "moment magnitude", ""),
]
CHANGES = ("max_slip", "first_slip", "fraction_has_slipped", "fraction_open", "fracture_energy")  # fractures without them have no row
OF_PLANE = {  # titles and units in 2D
    "area": ("length", "m"),
    "area_at_start": ("length at the start", "m"),
    "area_broken": ("broken length", "m"),
    "fracture_energy": ("fracture energy per depth", "J/m"),
    "lost_energy": ("energy lost in growth, per depth", "J/m"),
    "friction_energy": ("energy dissipated by slip, per depth", "J/m"),
    "fluid_volume": ("fluid volume per depth", "m²"),
    "leaked_volume": ("leaked volume per depth", "m²"),
    "moment": ("moment per depth", "N"),
}


def column(title, values, base, end=None):
    """Returns the title with a unit, and the values as texts. Shares are given in percent. `end`: time of the last step, which
    determines the unit of times."""
    largest = max((abs(value) for value in values if value is not None), default=0)
    if base == "%":
        factor, unit = 0.01, base
    else:
        factor, unit = unit_of(end if base == "s" and end else largest, base) if base else (1, "")
    values = [0 if value is not None and abs(value) <= NOISE * largest else value for value in values]
    return f"{title} ({unit})" if unit else title, [
        number(None if value is None else value / factor) for value in values
    ]


def singles(content, step, found):
    """Returns {name: numbers} of single fractures, in the form of `fractures` of a step; empty without this data.

    `found` are the slip events of the run."""
    first = {event.fracture: event.start for event in reversed(found)}
    columns = step.get("single_fractures", {})
    grows = any("growth" in one for one in content["steps"])
    return {
        one["name"]: {
            "area": one["area"],
            "first_slip": first.get(one["name"]),
            **({"area_at_start": one["area"]} if grows else {}),
            **{key: values[k] for key, values in columns.items()},
        }
        for k, one in enumerate(content.get("single_fractures", []))
        if columns
    }


def without_noise(fractures):
    """Returns the fractures with zero slip, without its round-off, where no face has slipped or opened."""
    return {
        name: {**one, **{key: 0.0 for key in ("max_slip", "mean_slip") if key in one}}
        if one.get("fraction_has_slipped") == 0 and not (one.get("fraction_open") or (one.get("max_opening") or 0) > 0)
        else one
        for name, one in fractures.items()
    }


def of_fractures(fractures, dim, end=None):
    """Yields the table of fractures, sorted by slip. `end`: time of the last step."""
    fractures = without_noise(fractures)
    names = sorted(fractures, key=lambda name: -(fractures[name].get("max_slip") or 0))
    changed = [name for name in names if any(fractures[name].get(key) for key in CHANGES)]
    shown = (changed or names)[:MAX_ROWS]
    columns = [("fracture", shown)]
    for key, title, base in OF_FRACTURES:
        if any(fractures[name].get(key) is not None for name in shown):
            title, base = OF_PLANE.get(key, (title, base)) if dim == 2 else (title, base)
            columns.append(column(title, [fractures[name].get(key) for name in shown], base, end))
    if not shown or len(columns) == 1:
        return
    closes = any((fractures[name].get("max_opening") or 0) < 0 for name in shown)
    others = len(names) - len(shown)
    notes = ["negative openings are closures"] * closes
    if others:
        notes.append(f"{others} others {'with less slip' if len(changed) != len(shown) else 'without slip or opening'}")
    yield Table("Fractures", [title for title, _ in columns], list(zip(*(values for _, values in columns))), "; ".join(notes))


def of_joints(content, reference):
    """Yields the table of joint entries that single fractures have of their own, from columns of their file."""
    own = {one["name"]: one["own_joint"] for one in content.get("single_fractures", []) if "own_joint" in one}
    shown = list(own)[:MAX_ROWS]
    entries = sorted({entry for name in shown for entry in own[name]}, key=lambda entry: (entry != "material", entry))
    rows = [
        (
            name,
            *(
                (
                    in_unit(own[name][entry], reference.entry(("Materials", "NAME"), entry)[0])
                    if entry in own[name]
                    else "–"
                )
                for entry in entries
            ),
        )
        for name in shown
    ]
    if rows:
        others = f"; {len(own) - len(shown)} others are not listed" if len(own) > len(shown) else ""
        yield Table("Joints of single fractures", ["fracture", *entries], rows, f"–: as in the material{others}")


def of_growth(steps, singles, dim, end):
    """Yields the table of extensions along free paths: sums over the extensions of a fracture in a step."""
    rows = {}
    for step in steps:
        growth = step.get("growth", {"fracture": []})
        for k, fracture in enumerate(growth["fracture"]):
            row = rows.setdefault((step["time"], fracture), {"length": 0.0, "fracture_energy": 0.0, "released": 0.0, "tips": [], "met": []})
            for key in ("length", "fracture_energy", "released"):
                row[key] += growth[key][k]
            row["tips"].append((growth["x"][k], growth["y"][k]))
            name = singles[fracture]["name"]
            row["met"] = [f"{one['state']} {one['met']}" for one in step.get("tips", []) if one["fracture"] == name and "met" in one]
            row["size"] = step.get("single_fractures", {}).get("area", {fracture: None})[fracture]
    if not rows:
        return
    shown = list(rows)[-MAX_ROWS:]
    columns = [column("time", [time for time, _ in shown], "s", end), ("fracture", [singles[k]["name"] for _, k in shown])]
    columns += [column(title, [rows[key][name] for key in shown], base) for name, title, base in (
        ("length", "extension", "m"), ("size", "length after it", "m"), ("fracture_energy", "fracture energy per depth", "J/m"),
        ("released", "released energy per depth", "J/m"))]
    last = [" ".join(f"({number(x)}, {number(y)})" for x, y in rows[key]["tips"][-2:]) for key in shown]
    met = [", ".join(rows[key]["met"]) for key in shown]
    others = len(rows) - len(shown)
    yield Table("Growth", [title for title, _ in columns] + ["last new tips (m)", "other fractures"], list(zip(*(texts for _, texts in columns), last, met)),
                f"{others} earlier ones are in growth.csv" if others else "")


def of_boundaries(step):
    reactions = step.get("reactions", {})
    if reactions:
        axes = ["x", "y", "z"][: len(next(iter(reactions.values())))]
        unit = "N/m" if len(axes) == 2 else "N"
        columns = [column("", values, "")[1] for values in zip(*reactions.values())]
        yield Table(
            "Reactions of boundaries",
            ["boundary", *(f"{axis} ({unit})" for axis in axes)],
            list(zip(reactions, *columns)),
            "forces on the rock",
        )


def of_wells(steps, dim):
    wells = steps[-1].get("wells", {})
    if wells:
        warm = any("temperature" in well for well in wells.values())
        largest = {
            name: max((step["wells"].get(name, {}).get("pressure") or 0 for step in steps), default=None)
            for name in wells
        }
        rows = [
            (name, number(well.get("rate")), quantity(well.get("pressure"), "Pa"), quantity(largest[name], "Pa"))
            + ((f"{well.get('temperature', np.nan):.2f} K",) if warm else ())
            for name, well in wells.items()
        ]
        titles = ["well", f"rate at the end ({RATES['fluid'][dim == 2]})", "pressure at the end", "largest pressure"]
        titles += ["temperature of the fluid"] * warm
        yield Table("Wells", titles, rows, "")


def of_energy(step, dim):
    """Yields the table of the energy balance since the start."""
    energy = step.get("energy")
    if not energy:
        return
    work, balance = energy.get("work", {}), energy.get("balance", {})
    on_rock = sum(work.get(name, 0) for name in ("pressure", "face pressure"))
    fractures = step.get("fractures", {}).values()
    rows = [
        ("work of loads and of the initial stress", work.get("loads")),
        ("work of prescribed displacements", work.get("supports")),
        ("work of temperatures, from 0 K", work.get("temperature")),
        ("work of the fluid on the rock", on_rock if "face pressure" in work or "pressure" in work else None),
        ("elastic energy of the rock", energy.get("elastic")),
        ("work on fractures", -work["traction"] if "traction" in work else None),
        ("released by extension or excavation", energy.get("released")),
    ]
    for key, title in (("friction_energy", "dissipated by slip"), ("fracture_energy", "fracture energy"),
                       ("lost_energy", "lost in growth")):
        values = [one[key] for one in fractures if key in one]
        rows.append((f"– {title}", sum(values) if values else None))
    rows += [(f"fluid: {name}", value) for name, value in balance.items()]
    rows.append(("unassigned", energy.get("unassigned")))
    largest = max(abs(value) for _, value in rows if value is not None)
    rows = [(title, value) for title, value in rows if value is not None and abs(value) > NOISE * largest]
    title, texts = column("energy", [value for _, value in rows], "J")
    note = "negative values of modules of the fluid: dissipated or stored"
    yield Table("Energy since the start", ["", title.replace("J)", "J/m)") if dim == 2 else title],
                list(zip((name for name, _ in rows), texts)), note if balance else "")


def of_costs(content):
    mesh = content.get("mesh", {})
    fields = content.get("blocks", {}).get("fields", [])
    rows = [
        ("cells", f"{mesh.get('cells', 0)}"),
        ("nodes", f"{mesh.get('nodes', 0)}"),
        ("fracture faces", f"{mesh.get('fracture_faces', 0)}"),
        *((f"unknowns, {field['name']}", str(field["unknowns"])) for field in fields),
        ("ranks", str(content.get("ranks", 1))),
        ("largest memory of a rank", f"{content.get('memory', {}).get('peak_bytes_largest_rank', 0) / 2**20:.0f} MiB"),
        ("solver", content.get("solver", {}).get("choice", "")),
    ]
    yield Table("Size", ["", ""], rows, "")
    timing = sorted(content.get("timing", {}).items(), key=lambda item: -item[1]["seconds"])[:12]
    rows = [
        (name.replace("_", " "), str(part["count"]), f"{part['seconds']:.2f}", f"{part['cpu_seconds']:.2f}")
        for name, part in timing
    ]
    yield Table("Time", ["part", "calls", "seconds", "CPU seconds"], rows, "parts may include others")


def of_events(found, dim, end=None):
    """Yields the table of slip events, the largest first. `end`: time of the last step."""
    shown = sorted(found, key=lambda event: -event.moment)[:MAX_ROWS]
    if not shown:
        return
    moment = OF_PLANE["moment"] if dim == 2 else ("moment", "N m")
    columns = [("fracture", [event.fracture for event in shown])] + [
        column(title, [getattr(event, key) for event in shown], base, end)
        for key, title, base in (
            ("magnitude", "magnitude" + (" per metre of depth" if dim == 2 else ""), ""),
            ("start", "start", "s"),
            ("end", "end", "s"),
            ("slip", "mean slip", "m"),
            ("moment", *moment),
            ("drop", "stress drop", "Pa"),
        )
        if getattr(shown[0], key) is not None
    ]
    others = f"{len(found) - len(shown)} smaller ones are in events.csv" if len(found) > len(shown) else ""
    yield Table("Slip events", [title for title, _ in columns], list(zip(*(values for _, values in columns))), others)


def of_points(content, step):
    """Yields the tables of quantities at points of fractures."""
    names = [one["name"] for one in content.get("single_fractures", [])]
    for name, units in content.get("tables", {}).items():
        if name == "growth":
            continue
        values = step.get(name, {})
        shown = range(min(MAX_ROWS, len(values.get("fracture", []))))
        if not shown:
            continue
        columns = [("fracture", [names[values["fracture"][k]] for k in shown])]
        for key, unit in units.items():
            base = "" if unit == "-" else unit.replace("Pa*m^0.5", "Pa √m")
            columns.append(column(key.replace("_of_", " of "), [values[key][k] for k in shown], base))
        n_others = len(values["fracture"]) - len(shown)
        title, note = name.replace("_", " ").capitalize(), f"{n_others} others are in {name}.csv" if n_others else ""
        yield Table(title, [head for head, _ in columns], list(zip(*(texts for _, texts in columns))), note)


def of_run(content, reference, found):
    """Returns the tables of results, and the tables of joints and costs. `reference`: units of entries, scene.Reference. `found` are
    the slip events of the run."""
    last = next((step for step in reversed(content["steps"]) if "fractures" in step), content["steps"][-1])
    dim = content.get("mesh", {}).get("dimension", 3)
    fractures = singles(content, last, found) or last.get("fractures", {})
    end = last["time"]
    tables = [
        *of_fractures(fractures, dim, end),
        *of_growth(content["steps"], content.get("single_fractures", []), dim, end),
        *of_events(found, dim, end),
        *of_points(content, last),
        *of_wells([step for step in content["steps"] if "wells" in step] or [last], dim),
        *of_boundaries(last),
        *of_energy(last, dim),
    ]
    return tables, [*of_joints(content, reference), *of_costs(content)]


def headline(content):
    """Returns sentences with the convergence of the run and the fracture with the largest slip."""
    steps = content["steps"]
    done = content["status"] == "completed" and all(step["converged"] for step in steps)
    found = ["All steps converged." if done else f"Status of the run: {content['status']}."]
    last = next((step for step in reversed(steps) if "fractures" in step), steps[-1])
    fractures = without_noise(singles(content, last, []) or last.get("fractures", {}))
    slip = {name: one.get("max_slip") or 0 for name, one in fractures.items()}
    if slip:
        name = max(slip, key=slip.get)
        found.append(f"The largest slip is {quantity(slip[name], 'm')}, on {name}." if slip[name] > 0 else "No fracture slips.")
    opening = {name: one.get("max_opening") or 0 for name, one in fractures.items()}
    if opening and slip and not max(slip.values()) > 0 and max(opening.values()) > 0:
        name = max(opening, key=opening.get)
        found.append(f"The largest opening is {quantity(opening[name], 'm')}, on {name}.")
    sizes = [(one["area"] - one["area_at_start"], name) for name, one in fractures.items() if "area_at_start" in one]
    if sizes and max(sizes)[0] > 0:
        found.append(f"{max(sizes)[1]} grows most, by {quantity(max(sizes)[0], 'm')}.")
    return " ".join(found)


def time_of_pictures(content, written):
    """Returns the time of the last step with pictures, or of the one with the largest slipping area if no face slips there
    and no fracture grows along a free path.

    `written`: times of the steps with files; without them the last step."""
    shown = [step for step in content["steps"] if step["time"] in written] or content["steps"][-1:]
    areas = [one["area"] for one in content.get("single_fractures", [])]
    slipping = [
        sum(area * (share or 0) for area, share in zip(areas, step.get("single_fractures", {}).get("fraction_slip", ())))
        for step in shown
    ]
    is_last = slipping[-1] > 0 or not any(slipping) or any("growth" in step for step in content["steps"])
    k = len(slipping) - 1 if is_last else int(np.argmax(slipping))
    return shown[k]["time"]
