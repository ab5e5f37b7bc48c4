"""Files of fractures as they are exchanged: CSV of lines, polygons and ellipses, and .fab of FracMan."""
import csv
import math
import os
import re
import stat
from dataclasses import dataclass, field

import numpy as np
from shapes import Errors, NetworkError, ellipse

MOST_CHARACTERS = 2 * 10**8  # of a file; some million fractures
SEPARATORS = {";": "semicolons", "\t": "tabs", None: "blanks between numbers"}  # that are none


@dataclass
class Row:
    """A fracture of a table."""
    title: str  # in messages
    points: np.ndarray
    number: str  # or a text; those of one number are one fracture, unless they have a name
    name: str = ""  # how results call it
    properties: dict = field(default_factory=dict)  # texts by the titles of further columns; see named_columns()


@dataclass
class Table:
    fractures: list = field(default_factory=list)  # rows
    n_columns: int = 5  # of lines, those of the shape; 4 without a number
    box: tuple = None  # lowest and highest corner of the domain, if the file tells
    errors: list = field(default_factory=list)

    def add(self, place, points):
        number = str(len(self.fractures) + 1)
        self.fractures.append(Row(f"{number} ({place})", points, number))


def numbers(words, place, table, first=1):
    """The words, from column `first` on, as finite numbers, or None and an error."""
    found = []
    for k, word in enumerate(words, first):
        try:
            found.append(number(word))
        except ValueError:
            table.errors.append(f"{place}: \"{word.strip()}\" in column {k} is no number")
            return None
        if not math.isfinite(found[-1]):
            table.errors.append(f"{place}: \"{word.strip()}\" in column {k} is no finite number")
            return None
    return np.array(found)


def number(word):
    """As float() reads it, but for 1_000."""
    return float(word.replace("_", "no number"))


def is_number(word):
    try:
        number(word)
    except ValueError:
        return False
    return True


def read_lines(path):
    """The lines of a file; refuses what may have no end, such as a pipe or a device."""
    def refuse(why):
        raise NetworkError(f"{path}: cannot be read: {why}", [path]) from None
    try:
        mode = os.stat(path).st_mode
        if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):  # open() tells of a folder
            refuse("is no regular file, but a pipe, a socket or a device")
        with open(path, encoding="utf-8-sig") as file:
            text = file.read(MOST_CHARACTERS + 1)
    except (OSError, UnicodeDecodeError) as error:
        refuse(getattr(error, "strerror", None) or "is no text in UTF-8")
    if len(text) > MOST_CHARACTERS:
        refuse(f"has more than {MOST_CHARACTERS:g} characters; divide it into several sets, or leave fractures out")
    return text.splitlines()


def columns(line):
    """The words of a line, which may be in quotes, without a comment; None where there are none."""
    line = line.partition("#")[0].strip()
    return next(csv.reader([line], skipinitialspace=True)) if line else None


def other_separator(line, words):
    """What separates the numbers of a row where commas do not, in words, or None. A name may come before the numbers."""
    line = line.partition("#")[0].strip()
    if ";" in line:
        return SEPARATORS[";"]
    if len(words) > 1 and all(map(is_number, words[1:])):
        return None
    for separator, name in SEPARATORS.items():
        parts = [part.strip().replace(",", ".") for part in line.split(separator)]  # decimal commas, perhaps
        if len(parts) > 2 and all(map(is_number, parts[1:])):
            return name
    return None


def lines_row(words, place, table):
    if len(words) != table.n_columns:
        needed = "5: id,x0,y0,x1,y1" if table.n_columns == 5 else "4: x0,y0,x1,y1"
        table.errors.append(f"{place}: has {len(words)} columns, needs {needed}")
        return
    x = numbers(words[-4:], place, table, len(words) - 3)
    if x is not None:
        number = words[0].strip() if len(words) == 5 else str(len(table.fractures) + 1)
        table.fractures.append(Row(f"{number} ({place})", x.reshape(2, 2), number))


def polygons_row(words, place, table):
    if len(words) == 6 and not table.fractures and table.box is None:
        x = numbers(words, place, table)
        if x is not None and not (x[3:] > x[:3]).all():
            table.errors.append(f"{place}: the domain xmin,ymin,zmin,xmax,ymax,zmax has a maximum that is not above its minimum")
        elif x is not None:
            table.box = x[:3], x[3:]
        return
    if len(words) % 3 or len(words) < 9:
        table.errors.append(f"{place}: has {len(words)} columns, needs 3 for each of at least 3 corners: x0,y0,z0,x1,y1,z1,...")
        return
    x = numbers(words, place, table)
    if x is not None:
        table.add(place, x.reshape(-1, 3))


def ellipses_row(words, place, table):
    if len(words) != 8:
        table.errors.append(f"{place}: has {len(words)} columns, needs 8: cx,cy,cz,r1,r2,rake,strike,dip")
        return
    x = numbers(words, place, table)
    if x is None:
        return
    if min(x[3:5]) <= 0:
        table.errors.append(f"{place}: has the radii {x[3]:g} and {x[4]:g}, they must be positive")
        return
    table.add(place, ellipse(x[:3], x[3:5], x[6], x[7], x[5]))


SHAPE = {"lines": ["x0", "y0", "x1", "y1"], "polygons": ["x0", "y0", "z0"], "ellipses": ["cx", "cy", "cz", "r1", "r2", "rake", "strike", "dip"]}
OF_SHAPE = re.compile(r"f?id|[xyz]\d+|c[xyz]|r[12]|rake|strike|dip")  # titles of columns
N_COLUMNS = {"lines": 5, "ellipses": 8}  # without titles


def named_columns(titles, kind):
    """The columns beside those of the shape: (column, title, unit). Titles are `name`, or an entry of a joint with its
    unit or without: `initial aperture [mm]`. Where titles do not tell the columns of the shape, those come first."""
    words = [re.fullmatch(r"\s*(.*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*", title).groups("") for title in titles]
    known = [title.lower() for title, _ in words]
    if set(SHAPE[kind]) <= set(known):
        other = [k for k, title in enumerate(known) if title and not OF_SHAPE.fullmatch(title)]
    else:
        other = range(N_COLUMNS.get(kind, len(words)), len(words))
    return [(k, "name" if known[k] == "name" else words[k][0], words[k][1]) for k in other]


def take_named(words, columns):
    """The texts of named columns, which are removed from the words."""
    found = {}
    for k, title, unit in columns:
        text = words[k].strip() if k < len(words) else ""
        if text:
            found[title] = f"{text} {unit}".strip()
    taken = {k for k, _, _ in columns}
    words[:] = [word for k, word in enumerate(words) if k not in taken]
    return found


def read_csv(path, kind):
    """A table of lines with commas; empty lines and what follows a # are passed over. A first line without numbers has
    titles."""
    row = {"lines": lines_row, "polygons": polygons_row, "ellipses": ellipses_row}[kind]
    table, is_first, named = Table(), True, []
    for k, line in enumerate(read_lines(path), 1):
        words = columns(line)
        if words is None:
            continue
        separator = other_separator(line, words)
        if separator:
            raise NetworkError(f"{path}: line {k}: has {separator}; columns are separated by commas, and numbers have decimal points", [path])
        while len(words) > 1 and not words[-1].strip():  # commas at the end
            words.pop()
        is_title = is_first and not any(is_number(word) for word in words)
        is_first = False
        if is_title:
            named = named_columns(words, kind)
            table.n_columns = 4 if len(words) - len(named) == 4 else 5
            continue
        has, before = take_named(words, named), len(table.fractures)
        row(words, f"{path}: line {k}", table)
        for fracture in table.fractures[before:]:
            fracture.name = has.pop("name", "")
            fracture.properties = has
            if fracture.name:
                fracture.title = f"{fracture.name} ({path}: line {k})"
    return table


def read_fab(path):
    """The fractures of a file in FracMan's format: after BEGIN FRACTURE for each a line `id corners set ...`, a line
    `number x y z` for each corner and a last one with the normal; x east, y north, z up."""
    table, lines = Table(), read_lines(path)
    begin = next((k for k, line in enumerate(lines) if line.split()[:2] == ["BEGIN", "FRACTURE"]), None)
    if begin is None:
        raise NetworkError(f"{path}: has no line BEGIN FRACTURE", [path])
    for k, line in enumerate(lines[:begin], 1):
        entry, _, unit = (word.strip().lower() for word in line.partition("="))
        if entry == "length_unit" and unit not in ("m", "meter", "meters", "metre", "metres"):
            raise NetworkError(f"{path}: line {k}: lengths are in {unit}, expected metres", [path])
    k = begin + 1
    while k < len(lines) and lines[k].split()[:2] != ["END", "FRACTURE"]:
        words, place = lines[k].split(), f"{path}: line {k + 1}"
        k += 1
        if not words:
            continue
        head = words[:2]
        if len(head) < 2 or not all(word.isdigit() for word in head):
            raise NetworkError(f"{place}: is \"{lines[k - 1].strip()[:40]}\", expected the number of a fracture and that of its corners", [path])
        n = int(head[1])
        corners = [line.split() for line in lines[k:k + n]]
        if [c[:1] for c in corners] != [[str(row + 1)] for row in range(n)] or any(len(c) < 4 for c in corners):
            raise NetworkError(f"{place}: fracture {head[0]} has {n} corners; their lines, number x y z, do not follow", [path])
        x = [numbers(c[1:4], f"{path}: line {k + row + 1}", table, 2) for row, c in enumerate(corners)]
        if all(p is not None for p in x):
            table.fractures.append(Row(f"{head[0]} ({place})", np.array(x), head[0]))
        k += n + 1
    if k >= len(lines):
        raise NetworkError(f"{path}: has no line END FRACTURE", [path])
    return table


def read_table(path, kind):
    """The fractures in a file; refuses it with a line for each thing that is wrong. A kind None is that of the columns."""
    if kind is None:
        rows = (words for words in map(columns, read_lines(path)) if words)
        first = next(rows, [])
        words = first if any(is_number(word) for word in first) else next(rows, [])
        titles = [title.strip().lower() for title in first]
        kind = "lines" if len(words) == 5 or {"x0", "z0"} & set(titles) == {"x0"} else "polygons"
    table = read_fab(path) if kind == "fab" else read_csv(path, kind)
    if not table.errors and not table.fractures:
        table.errors.append(f"{path}: has no fracture")
    Errors(table.errors).throw([path])
    return table
