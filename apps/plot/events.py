"""Slip events of single fractures from events.csv, and their time series from results.json as CSV tables."""

import csv
import io
from collections import namedtuple
from pathlib import Path

import numpy as np
import read

# Times in s, slip in m (change of the mean slip), moments in N m; in 2D moments per depth, in N. Of a catalogue by slip
# rates also the number of the event and the stress drop in Pa; otherwise None.
Event = namedtuple("Event", "fracture start end slip moment magnitude cumulated number drop", defaults=(None, None))


def states(steps, key="moment"):
    """Returns the steps with this list of results of single fractures."""
    return [step for step in steps if key in step.get("single_fractures", {})]


def column(steps, key):
    """Returns the values of a list of single fractures, an array (steps, fractures); NaN for null."""
    return np.array([step["single_fractures"][key] for step in steps], dtype=float)


def increments(values):
    """Returns the change in each step, from zero before the first step."""
    return np.diff(values, axis=0, prepend=0 * values[:1])


def of_run(directory, content):
    """Returns the events in events.csv in the order of their ends; none without this file. `content` is that of
    results.json."""
    path = Path(directory) / "events.csv"
    rows = read.csv_rows(path)[1:] if path.is_file() else []
    try:
        titles = read.csv_rows(path)[0] if rows else []
        more = [titles.index(title) for title in ("event [-]", "stress_drop [Pa]") if title in titles]
        events = [Event(row[0], *map(float, row[1:7]), *(float(row[k]) for k in more)) for row in rows]
    except (TypeError, ValueError):
        raise read.PlotError(f"{path}: is not a table of events; run the scene again") from None
    second = content.get("time_unit", {"seconds": 1})["seconds"]
    return [event._replace(start=event.start * second, end=event.end * second) for event in events]


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


def tables(content):
    """Returns {file name: text} of the tables of time series; empty without single fractures.

    The long table has a row for each step and fracture, the wide table a row for each step."""
    names = [one["name"] for one in content.get("single_fractures", [])]
    steps = [step for step in content["steps"] if names and step.get("single_fractures")]
    if not steps:
        return {}
    clock, units = content.get("time_unit", {"name": "s", "seconds": 1}), content.get("units", {})
    columns = [list(flat(step["single_fractures"], units)) for step in steps]
    time, times = f"[{clock['name']}]", [step["time"] / clock["seconds"] for step in steps]
    titles = [title for title, _ in columns[0]]
    long = [
        (t, name, *(values[k] for _, values in step)) for t, step in zip(times, columns) for k, name in enumerate(names)
    ]
    wide = [(t, *(value for _, values in step for value in values)) for t, step in zip(times, columns)]
    return {
        "fractures_long.csv": as_csv([f"time {time}", "fracture", *titles], long),
        "fractures_wide.csv": as_csv(
            [f"time {time}", *(f"{name}: {title}" for title in titles for name in names)], wide
        ),
    }
