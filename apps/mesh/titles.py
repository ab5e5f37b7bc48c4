"""Other titles of columns in tables of points and lines, and their replacement by those of `tables.SHAPE`."""
import re

CENTRE = ("{0}", "c{0}", "{0}c", "center {0}", "centre {0}", "{0} center", "{0} centre")
POINT = ("{0}", "{0} coord", "{0} coordinate", "{0}coord", "coord {0}", "pt {0}", "point {0}", "utm {0}")
AXES = {"x": ("easting", "east", "utm e", "utm easting"), "y": ("northing", "north", "utm n", "utm northing"),
        "z": ("elevation", "altitude", "height")}
DEPTH = ("depth", "tvd")
NUMBER = ("id", "fid", "number")  # titles of the number of a fracture, by priority
LINE = ("fracture", "trace", "line", "feature", "polyline", "segment", "joint", "fault")  # points of one line, also with "id" or "number"
DEGREES = {"lon", "long", "longitude", "lat", "latitude"}
BEGIN, END = "start|begin|from|first", "end|to|last"


def plain(title):
    """Returns a title in lower case, with blanks instead of underscores and dots."""
    return " ".join(re.sub("[_.]", " ", title.lower()).split())


def centre(axis):
    return tuple(one.format(axis) for one in CENTRE) + AXES[axis]


def of_points(titles):
    """Returns the titles with `x`, `y`, `z` or `depth` and `id` instead of others with these meanings."""
    found = [plain(title) for title in titles]
    for axis, others in (*((axis, (*(one.format(axis) for one in POINT), *AXES[axis])) for axis in "xyz"), ("depth", DEPTH)):
        replace_first(found, titles, axis, others)
    if not set(NUMBER) & set(titles):
        replace_first(found, titles, "id", [f"{one}{more}" for more in (" id", " number", " no", " nr", "id", "") for one in LINE] + ["object id", "objectid"])
    return titles


def replace_first(found, titles, title, others):
    k = next((found.index(other) for other in others if other in found), None)
    if title not in titles and k is not None:
        titles[k] = title


def of_lines(titles):
    """Returns the titles with `x0`, `y0`, `x1`, `y1` instead of, for instance, `x1`, `y1`, `x2`, `y2` or `x start`."""
    found = list(titles)
    for k, title in enumerate(titles):
        text = re.sub(" (?:point|node)", "", plain(title)).replace(" ", "").replace("easting", "x").replace("northing", "y")
        parted = re.fullmatch(rf"(?:({BEGIN})|{END})([xy])", text) or re.fullmatch(rf"([xy])(?:({BEGIN})|{END})", text)
        if parted:
            axis = next(one for one in parted.groups() if one in ("x", "y"))
            found[k] = f"{axis}{0 if set(parted.groups()) - {axis, None} else 1}"
    if "x0" not in found and {"x1", "y1", "x2", "y2"} <= set(found):
        found = [{"x1": "x0", "y1": "y0", "x2": "x1", "y2": "y1"}.get(title, title) for title in found]
    return found


def standard(kind, titles):
    """Returns lower-case titles with those of `tables.SHAPE` where others have the same meaning."""
    return {"points": of_points, "lines": of_lines}.get(kind, list)(list(titles))
