"""Slip events of single fractures, and their time series, from results.json; as CSV tables."""

import csv
import io
from collections import namedtuple

import numpy as np
from style import NOISE

# Times in s, slip in m (change of the mean slip), moments in N m; in 2D moments per depth, in N.
Event = namedtuple("Event", "fracture start end slip moment magnitude cumulated")
RATE = 1e-2  # smallest moment rate of an event / mean moment rate of the fracture


def magnitude(moment):
    """Returns the moment magnitude (Hanks and Kanamori 1979) of a moment in N m."""
    return (np.log10(moment) - 9.1) / 1.5


def states(steps, key="moment"):
    """Returns the steps with this list of results of single fractures."""
    return [step for step in steps if key in step.get("single_fractures", {})]


def column(steps, key):
    """Returns the values of a list of single fractures, an array (steps, fractures); NaN for null."""
    return np.array([step["single_fractures"][key] for step in steps], dtype=float)


def increments(values):
    """Returns the change in each step, from zero before the first step."""
    return np.diff(values, axis=0, prepend=0 * values[:1])


def active(steps, start):
    """Returns whether each fracture slips in each step, (steps, fractures).

    It slips if its moment changes faster than RATE x (its largest moment / duration of the run). Fractures with
    moments of round-off, relative to the largest one, do not slip."""
    moment = np.abs(column(steps, "moment"))
    times = np.array([step["time"] for step in steps])
    largest = np.max(moment, axis=0)
    length = np.diff(times, prepend=start)[:, None] / (times[-1] - start)
    return (np.abs(increments(moment)) > RATE * largest * length) & (largest > NOISE * np.max(largest, initial=0))


def of_run(content, start=0.0):
    """Returns the events of a run in the order of their ends; `content` as in results.json.

    An event is a sequence of steps in which a fracture slips. Its slip and its moment are sums of absolute changes, so
    that slip in the opposite direction counts as well."""
    steps = states(content["steps"])
    if not steps:
        return []
    times = [start, *(step["time"] for step in steps)]
    slips, moments = (np.abs(increments(column(steps, key))) for key in ("mean_slip", "moment"))
    found = []
    for k, (one, flags) in enumerate(zip(content.get("single_fractures", []), active(steps, start).T)):
        changes = np.flatnonzero(np.diff(flags, prepend=False, append=False))
        for first, end in changes.reshape(-1, 2):
            moment = np.sum(moments[first:end, k])
            found.append(
                (one["name"], times[first], times[end], np.sum(slips[first:end, k]), moment, magnitude(moment))
            )
    found.sort(key=lambda event: (event[2], event[1]))
    return [Event(*event, total) for event, total in zip(found, np.cumsum([event[4] for event in found]))]


def as_csv(titles, rows):
    """Returns the text of a CSV file. None and NaN give empty cells."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(titles)
    writer.writerows([["" if value is None or value != value else value for value in row] for row in rows])
    return text.getvalue()


def flat(columns, units):
    """Yields (title, values of the fractures) of the lists of a step; a column for each component of vectors."""
    for key, values in columns.items():
        unit = units.get(key, "-")
        if isinstance(values[0], list):
            axes = ("n", "t1", "t2") if len(values[0]) == 3 else ("n", "t")
            for k, axis in enumerate(axes):
                yield f"{key} {axis} [{unit}]", [vector[k] for vector in values]
        else:
            yield f"{key} [{unit}]", values


def tables(content, start=0.0):
    """Returns {file name: text} of the tables of events and of time series; empty without single fractures.

    The long table has a row for each step and fracture, the wide table a row for each step."""
    steps, names = content["steps"], [one["name"] for one in content.get("single_fractures", [])]
    steps, slips = [step for step in steps if names and step.get("single_fractures")], states(steps)
    if not steps:
        return {}
    clock, units = content.get("time_unit", {"name": "s", "seconds": 1}), content.get("units", {})
    columns = [list(flat(step["single_fractures"], units)) for step in steps]
    if len(slips) == len(steps):
        for step, flags in zip(columns, np.logical_or.accumulate(active(steps, start)).astype(int).tolist()):
            step.append(("has_slipped [-]", flags))
    time, times = f"[{clock['name']}]", [step["time"] / clock["seconds"] for step in steps]
    titles = [title for title, _ in columns[0]]
    long = [
        (t, name, *(values[k] for _, values in step)) for t, step in zip(times, columns) for k, name in enumerate(names)
    ]
    wide = [(t, *(value for _, values in step for value in values)) for t, step in zip(times, columns)]
    found = {
        "fractures_long.csv": as_csv([f"time {time}", "fracture", *titles], long),
        "fractures_wide.csv": as_csv(
            [f"time {time}", *(f"{name}: {title}" for title in titles for name in names)], wide
        ),
    }
    if not slips:
        return found
    moment = f"moment [{units.get('moment', 'N*m')}]"
    titles = ["fracture", f"start {time}", f"end {time}", "slip [m]", moment, "magnitude [-]", f"cumulated_{moment}"]
    rows = [
        event._replace(start=event.start / clock["seconds"], end=event.end / clock["seconds"])
        for event in of_run(content, start)
    ]
    return {"events.csv": as_csv(titles, rows), **found}
