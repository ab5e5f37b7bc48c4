"""Meshes of quadrilaterals for both programs: Gmsh 2.2 for Sprekk, VTU with lines and MaterialIDs for OpenGeoSys.

A grid has points [row, column, (x, y)]. A fracture is a path ((row, column), (row, column)) of edges along one row or
column."""
import numpy as np

SIDES = ("south", "north", "west", "east")
VTK = {("quad", 1): 9, ("line", 1): 3, ("quad", 2): 23, ("line", 2): 21}


def rectangle(width, height, columns, rows):
    """Grid of equal rectangles."""
    return np.stack(np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1)), axis=-1)


def ratio(n, first):
    """Ratio of a geometric sequence of n lengths, the first `first`, of sum 1."""
    low, high = 1.0, 100.0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if first * sum(middle**k for k in range(n)) < 1 else (low, middle)
    return low


def layered(width, height, columns, rows, first=None):
    """Grid with equal columns. The height (m) of rows grows from `first` at the middle; without it, rows are equal."""
    points = rectangle(width, height, columns, rows)
    if first:
        half = rows // 2
        q = ratio(half, 2 * first / height)
        away = np.concatenate([[0], np.cumsum(2 * first / height * q**np.arange(half))])
        points[:, :, 1] = (height / 2 * (1 + np.concatenate([-away[:0:-1], away])))[:, None]
    return points


def inclined(half, top, rows, columns, last):
    """Grid of a square |x|, |y| <= half along the line from (-top, -half) to (top, half), its middle column.

    Columns on each side become wider with the distance from the line, the last about `last` times the first."""
    s = np.expm1(np.log(last) * np.linspace(0, 1, columns + 1)) / (last - 1)
    y = np.linspace(-half, half, rows + 1)[:, None]
    line = y * top / half
    x = np.hstack([line - (line + half) * s[:0:-1], line + (half - line) * s])
    return np.stack([x, y + 0 * x], axis=-1)


def edges(path):
    """Pairs of grid positions along a path."""
    (r0, c0), (r1, c1) = path
    n = max(abs(r1 - r0), abs(c1 - c0))
    places = [(r0 + (r1 - r0) * k // n, c0 + (c1 - c0) * k // n) for k in range(n + 1)]
    return list(zip(places, places[1:]))


class Mesh:
    """Nodes, cells [cell, corner] and lines {name: [edge, end]} of a grid with fractures {name: path}."""

    def __init__(self, points, fractures):
        rows, columns = points.shape[0] - 1, points.shape[1] - 1
        number = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
        self.points = points.reshape(-1, 2)
        quads = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
        self.cells = np.stack(quads, axis=-1).reshape(-1, 4)
        around = {"south": ((0, 0), (0, columns)), "north": ((rows, 0), (rows, columns)), "west": ((0, 0), (rows, 0)),
                  "east": ((0, columns), (rows, columns))}
        self.fractures = list(fractures)
        self.lines = {name: np.array([[number[a], number[b]] for a, b in edges(path)])
                      for name, path in {**around, **fractures}.items()}

    def gmsh(self, file):
        """Writes cells, sides and fractures as named groups, format 2.2."""
        names = [*self.lines, "rock"]
        groups = [(1, 1, lines) for lines in self.lines.values()] + [(2, 3, self.cells)]
        elements = [f"{kind} 2 {k} {k} " + " ".join(str(1 + node) for node in nodes)
                    for k, (_, kind, of) in enumerate(groups, 1) for nodes in of]
        physical = [f'{dim} {k} "{name}"' for k, (name, (dim, _, _)) in enumerate(zip(names, groups), 1)]
        nodes = [f"{k} {float(x)!r} {float(y)!r} 0" for k, (x, y) in enumerate(self.points, 1)]
        numbered = [f"{k} {words}" for k, words in enumerate(elements, 1)]
        parts = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
        for title, lines in (("PhysicalNames", physical), ("Nodes", nodes), ("Elements", numbered)):
            parts += [f"${title}", str(len(lines)), *lines, f"$End{title}"]
        file.write_text("\n".join(parts) + "\n")
        return file

    def vtu(self, file, order):
        """Writes cells (MaterialID 0) and lines of fractures (MaterialIDs from 1), with mid-edge nodes at order 2."""
        blocks = [("quad", self.cells, 0)] + [("line", self.lines[name], k) for k, name in enumerate(self.fractures, 1)]
        points, middle, connectivity, types, ids = [tuple(p) for p in self.points], {}, [], [], []

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple((self.points[a] + self.points[b]) / 2))
            return middle[key]
        for kind, cells, material in blocks:
            for nodes in cells.tolist():
                ends = zip(nodes, nodes[1:] + nodes[:1]) if kind == "quad" else [nodes]
                connectivity.append(nodes + ([between(a, b) for a, b in ends] if order == 2 else []))
                types.append(VTK[kind, order])
                ids.append(material)
        offsets = np.cumsum([len(nodes) for nodes in connectivity])

        def array(kind, name, values, more=""):
            return f'<DataArray type="{kind}" Name="{name}" format="ascii"{more}>\n{values}\n</DataArray>'

        def spaced(values):
            return " ".join(map(str, values))
        coordinates = "\n".join(f"{float(x)!r} {float(y)!r} 0" for x, y in points)
        file.write_text("\n".join([
            '<?xml version="1.0"?>', '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">',
            f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(types)}">',
            "<Points>", array("Float64", "Points", coordinates, ' NumberOfComponents="3"'), "</Points>", "<Cells>",
            array("Int64", "connectivity", "\n".join(map(spaced, connectivity))),
            array("Int64", "offsets", spaced(offsets)), array("UInt8", "types", spaced(types)), "</Cells>",
            "<CellData>", array("Int32", "MaterialIDs", spaced(ids)), "</CellData>",
            "</Piece></UnstructuredGrid></VTKFile>", ""]))
        return file
