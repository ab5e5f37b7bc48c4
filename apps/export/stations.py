"""Writes a probe on a fracture as a station file of the SEAS benchmarks (Erickson et al. 2020)."""
import csv
import io
import math
from datetime import date

from read import PlotError, csv_rows

SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0, "year": 365.25 * 86400.0}
SLOWEST = 1e-30  # m/s, rate of a fracture at rest: files contain logarithms
PRESSURES = ("fracture pressure [Pa]", "fluid pressure [Pa]")
STATE = "friction state [s]"


class Table:
    """Columns of a probe by their titles, and the times in s."""

    def __init__(self, path):
        if not path.is_file():
            raise PlotError(f"{path}: no such file; the scene has no probe of this name")
        titles, *rows = csv_rows(path)
        self.path, name, end = path, *titles[0].rstrip("]").partition(" [")[::2]
        if name != "time" or end not in SECONDS or not rows:
            raise PlotError(f"{path}: is not a table of a probe with rows")
        if any(title.startswith("distance [") for title in titles):
            raise PlotError(f"{path}: is a line; a station is a point")
        self.columns = {title: [float(row[k]) for row in rows] for k, title in enumerate(titles)}
        self.times = [SECONDS[end] * t for t in self.columns[titles[0]]]

    def along_face(self, name, unit):
        """Returns the components of a local vector along the face, without the normal one."""
        titles = [f"{name} {axis} [{unit}]" for axis in ("t", "t1", "t2")]
        found = [self.columns[title] for title in titles if title in self.columns]
        if not found:
            raise PlotError(f'{self.path}: has no column "{name} t [{unit}]"; add "{name}" to the outputs of the probe')
        return found

    def first_of(self, titles):
        return next((self.columns[title] for title in titles if title in self.columns), None)


def rates(times, values):
    """Returns log10 |change|/(length of the step) of all rows except the first."""
    pairs = zip(zip(times, values), zip(times[1:], values[1:]))
    return [math.log10(max(abs(b - a) / (t - s), SLOWEST)) if t > s else math.nan for (s, a), (t, b) in pairs]


def columns_of(table):
    """Yields (name, meaning, values) of the columns after the time, without the first row, which has no rate."""
    slips, tractions = table.along_face("plastic jump local", "m"), table.along_face("traction local", "Pa")
    ends = [""] if len(slips) == 1 else [f"_{k}" for k in range(2, 2 + len(slips))]
    for end, slip in zip(ends, slips):
        yield f"slip{end}", "Slip (m)", slip[1:]
    for end, slip in zip(ends, slips):
        yield f"slip_rate{end}", "Slip rate (log10 m/s)", rates(table.times, slip)
    for end, traction in zip(ends, tractions):
        yield f"shear_stress{end}", "Shear stress (MPa)", [value / 1e6 for value in traction[1:]]
    if (pressure := table.first_of(PRESSURES)) is not None:
        yield "pore_pressure", "Pore pressure (MPa)", [value / 1e6 for value in pressure[1:]]
    if (state := table.first_of([STATE])) is not None:
        yield "state", "State (log10 s)", [math.log10(max(value, SLOWEST)) for value in state[1:]]


def as_station(table, header):
    """Returns the text of a station file: header lines, names of the columns, and a row for each step. `header`: texts
    KEY=VALUE that replace or extend the standard lines."""
    columns = list(columns_of(table))
    steps = [b - a for a, b in zip(table.times, table.times[1:])]
    if not steps:
        raise PlotError(f"{table.path}: has one row; a slip rate requires two")
    lines = {"problem": table.path.stem, "code": "Sprekk", "date": date.today().isoformat(),
             "minimum_time_step": f"{min(steps):g}", "maximum_time_step": f"{max(steps):g}",
             "num_time_steps": str(len(steps)), "location": table.path.stem}
    for text in header:
        key, equals, value = text.partition("=")
        if not key or not equals or "\n" in text:
            raise PlotError(f'--header "{text}": is not KEY=VALUE in one line')
        lines[key] = value
    text = io.StringIO()
    text.writelines(f"# {key}={value}\n" for key, value in lines.items())
    names = [("t", "Time (s)"), *((name, meaning) for name, meaning, _ in columns)]
    text.writelines(f"# Column #{k} = {meaning}\n" for k, (_, meaning) in enumerate(names, 1))
    text.write("# The line below lists the names of the data fields\n")
    writer = csv.writer(text, delimiter=" ", lineterminator="\n")
    writer.writerow([name for name, _ in names])
    for k, t in enumerate(table.times[1:]):
        writer.writerow([f"{t:.14e}", *(f"{values[k]:.14e}" for _, _, values in columns)])
    return text.getvalue()


def of_probe(directory, name, header):
    return as_station(Table(directory / "probes" / f"{name}.csv"), header)
