"""Tables of discs in space: columns in any order by their titles, with units."""
import math

from shapes import NetworkError, ellipse
from tables import Row, Table, numbers, parted_title, rows_of
from titles import DEPTH, NUMBER, centre, plain

LENGTHS = {"": 1.0, "m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3, "ft": 0.3048}  # in m
ANGLES = {"": 1.0, "deg": 1.0, "degree": 1.0, "degrees": 1.0, "°": 1.0, "rad": math.degrees(1)}  # in degrees
QUANTITIES = {  # {quantity: (titles, units)}
    **{axis: (centre(axis), LENGTHS) for axis in "xyz"},
    "depth": (DEPTH, LENGTHS),
    "dip": (("dip", "dip angle"), ANGLES),
    "dip direction": (("dip direction", "dip dir", "dipdir", "dipdirection", "dip azimuth"), ANGLES),
    "strike": (("strike",), ANGLES),
    "trend": (("trend", "pole trend"), ANGLES),
    "plunge": (("plunge", "pole plunge"), ANGLES),
    "radius": (("radius", "r"), LENGTHS),
    "diameter": (("diameter",), LENGTHS),
}
ONE_OF = ((("z",), ("depth",)), (("dip", "dip direction"), ("dip", "strike"), ("trend", "plunge")), (("radius",), ("diameter",)))
LIMITS = {"dip": (0, 90), "plunge": (0, 90), "dip direction": (-360, 360), "strike": (-360, 360), "trend": (-360, 360)}
MAX_CORNERS = 16  # chosen without the entry `corners`


def quantity_of(title):
    return next((name for name, (titles, _) in QUANTITIES.items() if plain(title) in titles), None)


def has_discs(path):
    """Returns whether the titles of a CSV file describe discs."""
    _, words = next(rows_of(path), (0, []))
    found = {quantity_of(parted_title(word)[0]) for word in words}
    return bool(found & {"radius", "diameter"}) and {"x", "y"} <= found


class DiscColumns:
    """Columns of the quantities of discs, {quantity: (column from 0, factor)}, and of other entries."""

    def __init__(self, path, line, words):
        self.place, self.path, self.count = f"{path}: line {line}", path, len(words)
        self.of, self.named, self.number = {}, [], None
        for k, word in enumerate(words):
            title, unit = parted_title(word)
            name = quantity_of(title)
            if name in self.of:
                self.refuse(f"columns {self.of[name][0] + 1} and {k + 1} both give the {name}; remove one")
            if name:
                units = QUANTITIES[name][1]
                if unit.lower() not in units:
                    self.refuse(f"column {k + 1}, \"{title}\", has the unit \"{unit}\"; allowed are {', '.join(filter(None, units))}")
                self.of[name] = k, units[unit.lower()]
            elif title.lower() in NUMBER:
                self.number = k if self.number is None else self.number
            elif title.lower() == "aperture":
                self.named.append((k, "initial aperture", unit or "m"))
            elif title:
                self.named.append((k, "name" if title.lower() == "name" else title, unit))
        self.check()

    def refuse(self, why):
        raise NetworkError(f"{self.place}: {why}", [self.path])

    def check(self):
        missing = [name for name in ("x", "y") if name not in self.of]
        missing += [" or ".join(" and ".join(group) for group in groups) for groups in ONE_OF
                    if not any(set(group) <= set(self.of) for group in groups)]
        if missing:
            self.refuse(f"the titles of discs lack {', '.join(missing)}; required are x, y, z (or depth), dip with dip direction or "
                        "strike (or trend and plunge of the pole), and radius (or diameter)")

    def read(self, words, place, table):
        """Returns {quantity: number} of a row in m and degrees, or None after an error."""
        if len(words) > self.count:
            table.errors.append(f"{place}: has {len(words)} columns, the titles are {self.count}")
            return None
        found = {}
        for name, (k, factor) in self.of.items():
            word = words[k].strip() if k < len(words) else ""
            if not word:
                table.lack(f"{place}: has no number in column {k + 1}, \"{name}\"")
                return None
            x = numbers([word], place, table, [k + 1])
            if x is None:
                return None
            found[name] = x[0] * factor
            low, high = LIMITS.get(name, (-math.inf, math.inf))
            if not low <= found[name] <= high or (name in ("radius", "diameter") and x[0] <= 0):
                allowed = f"from {low} to {high} degrees" if name in LIMITS else "above 0"
                table.errors.append(f"{place}: column {k + 1}: the {name} is {word}; allowed are values {allowed}")
                return None
        return found


def plane_of(row):
    """Returns strike and dip, in degrees."""
    if "dip" not in row:
        return row["trend"] + 90, 90 - row["plunge"]
    return row["strike"] if "strike" in row else row["dip direction"] - 90, row["dip"]


def corners_for(relative_size):
    """Returns the number of corners of a disc, such that a side has one or several edges of `relative_size` diameters."""
    edges = math.ceil(math.pi / math.asin(min(relative_size, 0.5)))
    return math.ceil(edges / math.ceil(edges / MAX_CORNERS))


def read_discs(path, corners):
    """Returns the table of discs, each a polygon with `corners` corners and the same area. All errors are collected."""
    table, columns = Table(), None
    for k, words in rows_of(path):
        place = f"{path}: line {k}"
        if columns is None:
            columns = DiscColumns(path, k, words)
            continue
        while len(words) > 1 and not words[-1].strip():
            words.pop()
        row = columns.read(words, place, table)
        if row is None:
            continue
        strike, dip = plane_of(row)
        radius = row.get("radius", 0.5 * row.get("diameter", 0))
        centre = [row["x"], row["y"], row["z"] if "z" in row else -row["depth"]]

        def text(column):
            return words[column].strip() if column is not None and column < len(words) else ""

        number = text(columns.number) or str(len(table.fractures) + 1)
        properties = {title: f"{text(column)} {unit}".strip() for column, title, unit in columns.named if text(column)}
        name = properties.pop("name", "")
        title = f"{name} ({place})" if name else f"{number} ({place})"
        table.fractures.append(Row(title, ellipse(centre, (radius, radius), strike, dip, 0, corners), number, name, properties))
    return table
