"""Fractures in files of dfnWorks (polygons.dat) and GOCAD (TSurf)."""
import re

import numpy as np
from shapes import NetworkError
from tables import Row, Table, numbers
from text_file import read_lines


def read_dfnworks(path):
    """Returns the polygons of a file `polygons.dat`: `nPolygons: n`, then `corners {x, y, z} {x, y, z} ...`."""
    table, said = Table(), None
    for k, line in enumerate(read_lines(path), 1):
        place, text = f"{path}: line {k}", line.partition("#")[0].strip()
        head = re.fullmatch(r"nPolygons:?\s*(\d+)", text)
        if head:
            said = int(head[1]), k
        elif text:
            count, points = text.split(None, 1)[0], re.findall(r"\{([^}]*)\}", text)
            if not count.isdigit() or not points:
                table.errors.append(f"{place}: is \"{text[:40]}\", expected the number of corners and {{x, y, z}} for each")
                continue
            if int(count) != len(points) or len(points) < 3:
                table.errors.append(f"{place}: has {len(points)} corners {{x, y, z}}, the first column is {count}; allowed are 3 or more")
                continue
            words = [point.split(",") for point in points]
            wrong = next((row for row in words if len(row) != 3), None)
            if wrong:
                table.errors.append(f"{place}: \"{{{','.join(wrong)}}}\" has {len(wrong)} coordinates, expected 3")
                continue
            rows = [numbers(row, place, table, range(3 * n + 2, 3 * n + 5)) for n, row in enumerate(words)]
            if all(row is not None for row in rows):
                table.add(place, np.array(rows))
    if said and not table.errors and said[0] != len(table.fractures):
        table.errors.append(f"{path}: line {said[1]}: nPolygons is {said[0]}, the file has {len(table.fractures)} polygons")
    return table


class Surf:
    """Object of a TSurf file: name, vertices {id: point} and triangles, each with its line."""

    def __init__(self, number):
        self.number, self.name, self.points, self.triangles, self.sign = number, "", {}, [], 1.0


def read_gocad(path):
    """Returns the triangles of GOCAD TSurf objects. The triangles of one object are one fracture."""
    table, one, n = Table(), None, 0
    for k, line in enumerate(read_lines(path), 1):
        place, words = f"{path}: line {k}", line.split()
        key = words[0].upper() if words else ""
        if key == "GOCAD":
            if len(words) < 2 or words[1].upper() != "TSURF":
                raise NetworkError(f"{place}: the object is \"{' '.join(words[1:2])}\", expected TSurf", [path])
            n += 1
            one = Surf(n)
        elif one is None and words:
            raise NetworkError(f"{place}: is \"{line.strip()[:40]}\", expected GOCAD TSurf", [path])
        elif "name:" in line.lower():
            one.name = one.name or re.split("name:", line, flags=re.IGNORECASE)[1].strip().strip("{}").strip()
        elif key == "ZPOSITIVE":
            one.sign = -1.0 if words[1:2] and words[1].lower() == "depth" else 1.0
        elif key in ("VRTX", "PVRTX"):
            x = numbers(words[2:5], place, table, range(3, 6)) if len(words) > 4 else None
            if len(words) < 5:
                table.errors.append(f"{place}: has {len(words)} columns, expected {key} id x y z")
            if x is not None:
                one.points[words[1]] = x
        elif key in ("ATOM", "PATOM") and len(words) > 2 and words[2] in one.points:
            one.points[words[1]] = one.points[words[2]]
        elif key == "TRGL":
            missing = [word for word in words[1:4] if word not in one.points]
            if len(words) < 4 or missing:
                table.errors.append(f"{place}: refers to the vertex {(missing or ['-'])[0]}, which is not defined above; expected TRGL a b c")
            else:
                one.triangles.append((k, words[1:4]))
        elif key == "END":
            take(one, path, table)
            one = None
    if one is not None:
        table.errors.append(f"{path}: has no line END for the object {one.name or one.number}")
    return table


def take(one, path, table):
    """Adds the triangles of an object to the table."""
    if not one.triangles and not table.errors:
        table.errors.append(f"{path}: the object {one.name or one.number} has no triangle (TRGL)")
    for line, corners in one.triangles:
        points = np.array([one.points[corner] for corner in corners]) * [1, 1, one.sign]
        name = one.name or str(one.number)
        table.fractures.append(Row(f"{name} ({path}: line {line})", points, str(one.number), one.name))
