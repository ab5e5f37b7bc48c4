"""Measured curve: a CSV file whose first line contains titles with units, e.g. `shear displacement (mm)`."""
import csv
import re

import numpy as np
import units


class FitError(Exception):
    """Invalid input. The message names the file and the place."""


def read_lines(path):
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            return [(k, row) for k, row in enumerate(csv.reader(file), 1) if any(word.strip() for word in row) and
                    not row[0].lstrip().startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise FitError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or 'is not UTF-8 text'}") from None


def read(path):
    """Returns {name: (values in SI units, powers of the unit)}. Empty cells are NaN and are not compared."""
    lines = read_lines(path)
    if len(lines) < 3:
        raise FitError(f"{path}: has {max(len(lines) - 1, 0)} rows of numbers, needs at least 2 below a line of titles")
    heads = titles(path, lines)
    names = [head[0] for head in heads]
    if len(set(names)) < len(names):
        raise FitError(f"{path}: line {lines[0][0]}: two columns have the same name")
    table = np.array([row_of(path, k, row, names) for k, row in lines[1:]])
    return {name: (factor * table[:, k], powers) for k, (name, factor, powers) in enumerate(heads)}


def factor(path, name):
    """Returns the factor of a column's unit to SI."""
    return next(own for title, own, _ in titles(path, read_lines(path)) if title == name)


def titles(path, lines):
    """Returns (name, factor to SI, powers of the unit) of each column."""
    heads = []
    for title in lines[0][1]:
        found = re.fullmatch(r"\s*(.+?)\s*\(([^()]*)\)\s*", title)
        if not found:
            raise FitError(f'{path}: line {lines[0][0]}: column "{title.strip()}" has no unit; write e.g. "shear stress (MPa)", and '
                           '"(-)" for a dimensionless column')
        try:
            heads.append((found[1], *units.of_unit(found[2])))
        except units.UnitError as error:
            raise FitError(f'{path}: line {lines[0][0]}: column "{title.strip()}": {error}') from None
    return heads


def row_of(path, line, row, names):
    if len(row) != len(names):
        raise FitError(f"{path}: line {line}: has {len(row)} columns, the titles have {len(names)}")
    values = []
    for name, word in zip(names, row):
        try:
            values.append(float(word) if word.strip() else np.nan)
        except ValueError:
            raise FitError(f'{path}: line {line}: "{word.strip()}" in column "{name}" is not a number') from None
    if np.isinf(values).any():
        raise FitError(f"{path}: line {line}: has an infinite number")
    return values


def column(path, columns, name):
    if name not in columns:
        raise FitError(f'{path}: has no column "{name}", its columns are: ' + ", ".join(f'"{c}"' for c in columns))
    return columns[name]
