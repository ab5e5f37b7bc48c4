"""Facts and numbers of single fractures in the 3D view, as texts."""

import figures
import numpy as np
from numbers_in_words import quantity
from style import when


def facts(content, found, clock, plane):
    """Returns {"name", "facts": [[title, text], ...]} of each single fracture.

    `found` are the events of the run, and `clock` is the unit of time as in style.when."""
    first = {event.fracture: event.start for event in reversed(found)}
    size = figures.OF_PLANE["area"] if plane else ("area", "m²")
    listed = []
    for one in content.get("single_fractures", []):
        known = [["set", one["set"]], [size[0], quantity(one["area"], size[1])]]
        known += [[key, quantity(one[key], "°")] for key in ("strike", "dip") if key in one]
        known += [["first slip", when(first[one["name"]], clock)]] if one["name"] in first else []
        listed.append({"name": one["name"], "facts": known})
    return listed


def tables(content, times, plane):
    """Returns {"name", "values": texts at each time of each single fracture} of the results in the key figures."""
    n = len(content.get("single_fractures", []))
    steps = {step["time"]: step.get("single_fractures", {}) for step in content["steps"]}
    found = []
    for key, title, base in figures.OF_FRACTURES:
        lists = [steps.get(time, {}).get(key) for time in times]
        if any(lists):
            title, base = figures.OF_PLANE.get(key, (title, base)) if plane else (title, base)
            every = [value for values in lists for value in (values or [None] * n)]
            title, texts = figures.column(title.removesuffix(" at the end"), every, base)
            found.append({"name": title, "values": np.reshape(texts, (len(times), n)).tolist()})
    return found
