"""Tables, files and last lines of measurements."""
import csv
import math
import sys

import numpy as np


def line(values, columns, width, minimum=7):
    """Line of a table with right-aligned numbers; `columns` are {name: format}, the first is `width` wide."""
    words = ["-" if value is None else value if isinstance(value, str) else format(value, how)
             for value, how in zip(values, columns.values())]
    numbers = (f"  {word:>{max(minimum, len(name) + 2) - 2}}" for name, word in zip(list(columns)[1:], words[1:]))
    return f"{words[0]:{width}}" + "".join(numbers)


def write(file, columns, rows):
    with open(file, "w", newline="") as opened:
        writer = csv.writer(opened)
        writer.writerow(columns)
        writer.writerows(rows)


class Table:
    """Rows printed as they are added, and written to a CSV file."""

    def __init__(self, columns, width=34):
        self.columns, self.width, self.rows = columns, width, []  # columns: {name: format}
        print(line(["", *list(columns)[1:]], columns, width), flush=True)

    def add(self, values, notes=()):
        self.rows.append(list(values))
        print("\n".join([line(values, self.columns, self.width), *(f"  {note}" for note in notes)]), flush=True)

    def write(self, file):
        write(file, self.columns, self.rows)


class Series(Table):
    """Table of runs, with their rows and messages of failures."""

    def __init__(self, columns, width):
        super().__init__(columns, width)
        self.of, self.failed = [], []

    def run(self, name, run, row):
        """Adds a row, which has values(), and the failure of its run. Runs without steps have no row."""
        if run.failure:
            self.failed.append(f"failed: {name}: {run.failure}")
        if run.steps:
            self.of.append(row)
            self.add(row.values(), self.failed[-1:] if run.failure else ())

    def finish(self, options, summary, formats, draw, bounds):
        """Writes table and figure; prints failures, missed bounds and the summary of the rows; returns the status.

        With --quick, a missed bound is a failure as well."""
        if not self.of:
            sys.exit("\n".join(self.failed))
        draw(self.of, options.output / f"{options.name}.png")
        return finish(options, self, summary(self.of), formats, bounds, self.failed)


def finish(options, table, values, formats, bounds, failed=()):
    """Writes the table as NAME.csv; prints failures, missed bounds, the names of the files and the last line.

    Returns the exit status: 1 after failures, or with --quick if a bound is missed."""
    files = [options.output / f"{options.name}.{kind}" for kind in ("csv", "png")]
    table.write(files[0])
    wrong, written = missed(values, bounds), " and ".join(file.name for file in files if file.is_file())
    print("\n".join(["", *failed, *wrong, f"{written} in {options.output}", results(values, formats)]))
    return 1 if failed or (options.quick and wrong) else 0


def results(values, formats):
    """Last line of a measurement, "NAME=VALUE ..."."""
    return " ".join(f"{name}={format(value, formats.get(name, ''))}" for name, value in values.items())


def missed(values, bounds):
    """Returns a message for each value above its bound, or below the bound of (+1, bound). NaN is not measured."""
    signed = {name: bound if isinstance(bound, tuple) else (-1, bound) for name, bound in bounds.items()}
    return [f"missed: {name} = {values[name]:.3g}, required: {'at minimum' if sign > 0 else 'at maximum'} {bound:g}"
            for name, (sign, bound) in signed.items() if sign * values[name] < sign * bound]


def growth(points, first=None, last=None):
    """Relative growth of values from the first to the last size, summed over the series with both; points are
    (series, size, value)."""
    sizes = sorted({size for _, size, _ in points})
    ends = (sizes[0] if first is None else first, sizes[-1] if last is None else last) if sizes else (0, 0)
    before, after = ({series: value for series, size, value in points if size == end} for end in ends)
    both = before.keys() & after.keys()
    return sum(after[s] for s in both) / sum(before[s] for s in both) - 1 if both and ends[0] != ends[1] else math.nan


def exponent(points):
    """Exponent p of values ~ size^p, fitted to all series, each with its own factor; points as in growth()."""
    logs = {}
    for series, size, value in points:
        logs.setdefault(series, []).append((math.log(size), math.log(value)))
    centred = [np.array(of) - np.mean(of, axis=0) for of in logs.values() if len(of) > 1]
    if not centred:
        return math.nan
    x, y = np.concatenate(centred).T
    return float(x @ y / (x @ x))
