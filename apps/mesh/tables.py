"""Tables of fractures: CSV files of points, lines, polygons and ellipses."""
import csv
import difflib
import math
import re
from dataclasses import dataclass, field, replace

import numpy as np
from shapes import MAXIMUM, Errors, NetworkError, ellipse
from text_file import read_lines
from titles import DEGREES, NUMBER, plain, standard

DECIMAL_COMMA = re.compile(r"^(\s*[-+]?\d*),(\d+(?:[eE][-+]?\d+)?\s*)$")
MISSING = ("", "-", "na", "n/a", "null", "none")  # words for missing numbers, also nan
SEPARATORS = {";": "semicolons", "\t": "tabs", None: "blanks between numbers"}  # other than commas


@dataclass
class Row:
    """Fracture of a table."""
    title: str  # for messages
    points: np.ndarray
    number: str  # number or text; rows of the same number are one fracture, unless they have a name
    name: str = ""  # name in results
    properties: dict = field(default_factory=dict)  # {title of a further column: text}


@dataclass
class Table:
    fractures: list = field(default_factory=list)  # of type Row
    box: tuple = None  # lowest and highest corner of the domain, if given
    errors: list = field(default_factory=list)
    empty: list = field(default_factory=list)  # errors of rows without geometry, also in `errors`
    corners: int = 32  # of the polygon of an ellipse

    def add(self, place, points, number=""):
        number = number or str(len(self.fractures) + 1)
        self.fractures.append(Row(f"{number} ({place})", points, number))

    def lack(self, error):
        """Records the error of a row without geometry, which repairs leave out."""
        self.errors.append(error)
        self.empty.append(error)


def numbers(words, place, table, columns):
    """Returns the words as finite numbers, or None. Appends an error with the column of the file."""
    found = []
    for k, word in zip(columns, words):
        try:
            found.append(number(word))
        except ValueError:
            add = table.lack if word.strip().lower() in MISSING else table.errors.append
            add(f"{place}: \"{word.strip()}\" in column {k} is not a number")
            return None
        if not math.isfinite(found[-1]):
            table.lack(f"{place}: \"{word.strip()}\" in column {k} is not a finite number")
            return None
        if abs(found[-1]) > MAXIMUM:
            table.errors.append(f"{place}: \"{word.strip()}\" in column {k} exceeds {MAXIMUM:g}, the largest allowed value")
            return None
    return np.array(found)


def number(word):
    """Converts a word as float(), but rejects underscores such as 1_000."""
    return float(word.replace("_", "no number"))


def is_number(word):
    try:
        number(word)
    except ValueError:
        return False
    return True


def columns(line, separator=","):
    """Returns the words of a line without comment, possibly in quotes; None for an empty line.

    With another separator than a comma, numbers may have decimal commas."""
    line = line.partition("#")[0].strip(" \r\n" if separator == "\t" else None)
    if not line.strip():
        return None
    words = next(csv.reader([line], delimiter=separator, skipinitialspace=separator != "\t"))
    return words if separator == "," else [DECIMAL_COMMA.sub(r"\1.\2", word) for word in words]


def separator_of(line):
    """Returns the separator of the columns, from the first line: a semicolon, a tab or a comma."""
    line = re.sub('"[^"]*"', "", line.partition("#")[0])
    return next((one for one in (";", "\t") if one in line and (one == ";" or "," not in re.sub(r"\d,\d", "", line))), ",")


def other_separator(line, words):
    """Returns the name of an unsupported separator of columns, or None. A name may precede the numbers."""
    line = line.partition("#")[0].strip()
    if ";" in line:
        return SEPARATORS[";"]
    if len(words) > 1 and all(map(is_number, words[1:])):
        return None
    if len(words) == 1 and "\t" in line:
        return SEPARATORS["\t"]
    for separator, name in SEPARATORS.items():
        parts = [part.strip().replace(",", ".") for part in line.split(separator)]  # possibly decimal commas
        if len(parts) > 2 and all(map(is_number, parts[1:])):
            return name
    return None


SHAPE = {"points": ["x", "y"], "lines": ["x0", "y0", "x1", "y1"], "polygons": ["x0", "y0", "z0", "x1", "y1", "z1", "x2", "y2", "z2"],
         "ellipses": ["cx", "cy", "cz", "r1", "r2", "rake", "strike", "dip"]}  # titles of columns
UNITS = {"rake": "deg", "strike": "deg", "dip": "deg"}  # other columns: m
SPELLINGS = {"m": ("", "m", "meter", "meters", "metre", "metres"), "deg": ("", "deg", "degree", "degrees", "°")}
GOES_ON = "..."  # last title of polygons with any number of corners


class Columns:
    """Columns of a table, from 0.

    shape  columns of the geometry, in the order of SHAPE
    number column of the number
    signs  factors of the numbers of the geometry
    named  other columns (column, title, unit)
    count  number of columns; None for any number, with further corners"""

    def __init__(self, kind, dim=2):
        """Columns of a table without titles. Points have `dim` coordinates."""
        self.kind, self.dim, self.titles, self.named, self.signs = kind, dim, [], [], 1.0
        self.number = 0 if kind in ("lines", "points") else None
        self.shape = {"points": range(1, 1 + dim), "lines": range(1, 5), "polygons": range(0), "ellipses": range(8)}[kind]
        self.count = {"points": 1 + dim, "lines": 5, "polygons": None, "ellipses": 8}[kind]

    def of(self, words):
        """Returns the columns of the geometry in a row of this length."""
        return [*self.shape, *(range(len(self.titles), len(words)) if self.count is None else ())]

    def text(self, words, k):
        return words[k].strip() if k is not None and k < len(words) else ""

    def properties(self, words):
        texts = {title: (self.text(words, k), unit) for k, title, unit in self.named}
        return {title: f"{text} {unit}".strip() for title, (text, unit) in texts.items() if text}


class TitledColumns(Columns):
    """Columns with titles in the first line: geometry, `id`, `fid` or `number`, `name`, and entries of a joint.

    A title may contain a unit, such as `initial aperture [mm]`."""

    def __init__(self, kind, words, path, line, dim=2, entries=()):
        super().__init__(kind, dim)
        self.path, self.line = path, line
        parted = [parted_title(word) for word in words]
        self.titles, units = standard(kind, [title.lower() for title, _ in parted]), [unit for _, unit in parted]
        self.refuse_doubled()
        self.refuse_degrees()
        self.count, self.read = len(words), ",".join(words)
        if kind == "polygons" and self.titles[-1:] == [GOES_ON]:
            self.count = None
            self.titles.pop()
        if kind == "points" and dim == 3 and "z" not in self.titles and "depth" in self.titles:
            self.titles[self.titles.index("depth")], self.signs = "z", np.array([1.0, 1.0, -1.0])
        shape = self.shape_titles()
        self.shape = [self.titles.index(title) for title in shape]
        for title, k in zip(shape, self.shape):
            self.check_unit(title, units[k])
        self.number = next((self.titles.index(title) for title in NUMBER if title in self.titles), None)
        written = {one.lower(): one for one in entries}
        self.named = [(k, "name" if title == "name" else written.get(parted[k][0].lower(), parted[k][0]), units[k])
                      for k, title in enumerate(self.titles) if title and title not in (*shape, *NUMBER)]
        if kind == "points":
            self.named = [one for one in self.named if self.titles[one[0]] not in ("z", "depth")]
            if self.number is None and "name" in self.titles:
                self.number = self.titles.index("name")
            if self.number is None:
                self.refuse(f"the titles of points lack one of {', '.join(NUMBER)}: points with the same number form a line")
        self.refuse_misspelt(entries)

    def refuse(self, why):
        raise NetworkError(f"{self.path}: line {self.line}: {why}", [self.path])

    def refuse_misspelt(self, entries):
        """Rejects titles close to the name of an entry of a joint. Other titles are ignored, with a warning of the program."""
        for k, title, _ in self.named:
            meant = difflib.get_close_matches(title, entries, 1, 0.85)
            if meant and title not in entries:
                self.refuse(f"column {k + 1} has the title \"{title}\", which is no entry of a joint; did you mean \"{meant[0]}\"?")

    def refuse_degrees(self):
        """Rejects longitudes and latitudes."""
        k = next((k for k, title in enumerate(self.titles) if plain(title) in DEGREES), None)
        if k is not None and not {"x", "x0", "x1", "cx"} & set(self.titles):
            self.refuse(f"column {k + 1} has the title \"{self.titles[k]}\", which means degrees, and Sprekk needs metres; export the "
                        "coordinates in a projected system such as UTM")

    def refuse_doubled(self):
        for k, title in enumerate(self.titles):
            if title and title in self.titles[:k]:
                self.refuse(f"columns {self.titles.index(title) + 1} and {k + 1} have the same title, \"{title}\"")

    def shape_titles(self):
        """Returns the titles of the geometry.

        The largest index in the titles gives the number of corners of polygons."""
        needed = SHAPE[self.kind] if self.kind != "points" else list("xyz"[:self.dim])
        if self.kind == "polygons":
            of_corners = (re.fullmatch(r"[xyz](\d{1,6})", title) for title in self.titles)
            last = max((int(found[1]) for found in of_corners if found), default=0)
            needed = [f"{axis}{k}" for k in range(max(last + 1, 1 if self.count is None else 3)) for axis in "xyz"]
        missing = [f'"{title}"' for title in needed if title not in self.titles]
        if missing:
            listed = ", ".join(missing[:9]) + (" and others" if len(missing) > 9 else "")
            order = ["id", *needed] if self.kind in ("lines", "points") else SHAPE[self.kind]
            meant = next((f"; these are titles of {kind}, which \"format\" must name" for kind, titles in SHAPE.items()
                          if kind != "points" and set(titles) <= set(self.titles)), "")
            self.refuse(f"the titles of {self.kind} lack {listed}{meant}; columns may have any order if titles name "
                        f"all of them; without titles they are {','.join(order)}"
                        f"{',...' if self.kind == 'polygons' else ''}; further columns may be name, material and entries of a "
                        f"joint; read: {self.read}")
        return needed

    def check_unit(self, title, unit):
        expected = UNITS.get(title, "m")
        if unit.lower() not in SPELLINGS[expected]:
            self.refuse(f"the column \"{title}\" is in {unit}, expected {expected}")

    def missing(self, words):
        """Returns the first empty column of the geometry in a row of lines or ellipses, from 0, or None."""
        return next((k for k in self.shape if not self.text(words, k)), None)


def parted_title(word):
    """Returns the title and the unit in brackets."""
    return re.fullmatch(r"\s*(.*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*", word, re.DOTALL).groups("")


def lines_row(x, place, table, number):
    table.add(place, x.reshape(2, 2), number)


def ellipses_row(x, place, table, number):
    if min(x[3:5]) <= 0:
        table.errors.append(f"{place}: has the radii {x[3]:g} and {x[4]:g}, they must be positive")
    else:
        table.add(place, ellipse(x[:3], x[3:5], x[6], x[7], x[5], table.corners), number)


def polygons_row(x, place, table, number):
    if len(x) != 6:
        table.add(place, x.reshape(-1, 3), number)
    elif (x[3:] > x[:3]).all():
        table.box = x[:3], x[3:]
    else:
        table.errors.append(f"{place}: the domain xmin,ymin,zmin,xmax,ymax,zmax has a maximum that is not above its "
                            "minimum")


def points_row(x, place, table, number):
    if number:
        table.add(place, x[None], number)
    else:
        table.errors.append(f"{place}: lacks the number of the line to which this point belongs")


ROWS = {"points": points_row, "lines": lines_row, "polygons": polygons_row, "ellipses": ellipses_row}


def wrong_columns(words, columns, of, table, place):
    """Returns whether the number of columns of a row is wrong, and records the error."""
    error = error_of_columns(words, columns, of, table)
    k = columns.missing(words) if columns.titles and columns.kind != "polygons" and not error else None
    if error:
        table.errors.append(f"{place}: {error}")
    elif k is not None:
        table.lack(f"{place}: has no number in column {k + 1}, \"{columns.titles[k]}\"")
    return bool(error) or k is not None


def error_of_columns(words, columns, of, table):
    """Returns the error in the number of columns of a row, or None."""
    kind, n = columns.kind, len(words)
    if columns.titles and columns.count is not None and n > columns.count:
        return f"has {n} columns, the titles are {columns.count}"
    if kind == "polygons":
        is_box = len(of) == 6 and not table.fractures and table.box is None
        if not is_box and (len(of) % 3 or len(of) < 9):
            return f"has {len(of)} columns, needs 3 for each of at least 3 corners: x0,y0,z0,x1,y1,z1,..."
    elif not columns.titles and n != columns.count:
        of_kind = list("xyz"[:columns.dim]) if kind == "points" else SHAPE[kind]
        needed = ",".join((["id"] if kind in ("lines", "points") else []) + of_kind)
        return f"has {n} columns, needs {columns.count}: {needed}"
    return None


def read_row(words, columns, place, table):
    """Adds the fracture of a row, or an error."""
    of = columns.of(words)
    if columns.kind == "polygons":
        while of and not columns.text(words, of[-1]):  # polygon with fewer corners
            of.pop()
    if wrong_columns(words, columns, of, table, place):
        return
    x, before = numbers([words[k] for k in of], place, table, [k + 1 for k in of]), len(table.fractures)
    if x is None:
        return
    ROWS[columns.kind](x * columns.signs if columns.kind == "points" else x, place, table, columns.text(words, columns.number))
    for fracture in table.fractures[before:]:
        has = columns.properties(words)
        fracture.name = has.pop("name", "")
        fracture.properties = has
        if fracture.name:
            fracture.title = f"{fracture.name} ({place})"


def are_titles(words):
    return not any(is_number(word) for word in words)


def rows_of(path):
    """Yields (line number, words) of the rows of a CSV file. Skips empty rows and comments after #.

    The first row determines the separator: commas, semicolons or tabs."""
    separator = None
    for k, line in enumerate(read_lines(path), 1):
        if separator is None and line.partition("#")[0].strip():
            separator = separator_of(line)
        words = columns(line, separator or ",")
        if words is None or not any(word.strip() for word in words):
            continue
        other = other_separator(line, words) if separator == "," else None
        if other:
            raise NetworkError(f"{path}: line {k}: has {other}; columns are separated by commas, or by semicolons or tabs in "
                               "all rows; with commas numbers have decimal points", [path])
        yield k, words


def read_csv(path, kind, dim=2, entries=(), corners=32):
    """Returns the table of a CSV file. A first line without numbers contains the titles of the columns.

    Rows of points with the same number form one fracture. Points have `dim` coordinates. `entries` are names of entries
    of joints, for misspelt titles."""
    table, known = Table(corners=corners), None
    for k, words in rows_of(path):
        place = f"{path}: line {k}"
        if known is None and are_titles(words):
            known = TitledColumns(kind, words, path, k, dim, entries)
            continue
        known = known or Columns(kind, dim)
        if known.titles and kind != "polygons" and len(words) < known.count:
            table.errors.append(f"{place}: has {len(words)} columns, the titles are {known.count}; an empty cell needs its separator")
            continue
        while len(words) > 1 and not words[-1].strip():  # trailing commas
            words.pop()
        read_row(words, known, place, table)
    return joined_points(table, dim) if kind == "points" else table


def joined_points(table, dim):
    """Joins the points of each number to one fracture, in their order.

    The first row gives the name and other columns."""
    of_number = {}
    for row in table.fractures:
        of_number.setdefault(row.number, []).append(row)
    table.fractures = []
    for number, rows in of_number.items():
        points = np.concatenate([row.points for row in rows])
        if len(points) < dim:
            table.lack(f"fracture {rows[0].title}: has {len(points)} points, needs at least {dim}")
        else:
            table.fractures.append(replace(rows[0], points=points))
    return table


def has_points(path, dim):
    """Returns whether each row is a point, from the titles, or from the number of columns without titles."""
    _, words = next(rows_of(path), (0, []))
    if not are_titles(words):
        return len(words) == 1 + dim
    titles = set(standard("points", [parted_title(word)[0].lower() for word in words]))
    others = {"dip", "strike", "radius", "r1"}  # titles of discs
    return {"x", "y"} <= titles and not titles & others


def has_ellipses(path):
    """Returns whether the titles are those of ellipses."""
    _, words = next(rows_of(path), (0, []))
    return set(SHAPE["ellipses"]) <= {parted_title(word)[0].lower() for word in words}


def kind_of(path):
    """Returns the kind of the rows, from the titles, or from the number of columns without titles."""
    _, words = next(rows_of(path), (0, []))
    titles = {parted_title(word)[0].lower() for word in words} if are_titles(words) else set()
    if "cx" in titles:
        return "ellipses"
    return "lines" if (titles & {"x0", "z0"} == {"x0"} if titles else len(words) == 5) else "polygons"


def complete(table, path, leaves_out=False):
    """Returns the table. Raises the errors, or an error for a table without fractures.

    With `leaves_out` rows without geometry are no errors."""
    ignored = set(table.empty if leaves_out else ())
    errors = [one for one in table.errors if one not in ignored]
    if not errors and not table.fractures:
        errors.append(f"{path}: has no fracture")
    Errors(errors).throw([path])
    return table


def read_table(path, kind, dim=2, entries=(), corners=32, leaves_out=False):
    """Returns the fractures in a file. `entries` as for read_csv(), `leaves_out` as for complete().

    All errors are raised together. With kind = None the columns determine the kind."""
    return complete(read_csv(path, kind or kind_of(path), dim, entries, corners), path, leaves_out)
