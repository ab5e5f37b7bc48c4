"""Reads files of Sprekk: CSV files of a point, numbers and grids of a run."""
import csv
import json
import xml.etree.ElementTree as xml
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkIOXML import (vtkXMLMultiBlockDataReader, vtkXMLPUnstructuredGridReader,
                                 vtkXMLUnstructuredGridReader)


class PlotError(Exception):
    """Invalid input, described in one line with the name of the file."""


def csv_rows(path):
    """Returns the rows of a CSV file with titles. Error for equal titles and for rows of different length."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = [(k, row) for k, row in enumerate(csv.reader(file), 1) if row]
    except (UnicodeDecodeError, csv.Error):
        raise PlotError(f"{path}: is not a CSV file in UTF-8") from None
    titles = rows[0][1] if rows else []
    for k, title in enumerate(titles):
        if title in titles[:k]:
            raise PlotError(f'{path}: line {rows[0][0]}: two columns have the title "{title}"')
    for k, row in rows[1:]:
        if len(row) != len(titles):
            raise PlotError(f"{path}: line {k}: is not complete: has {len(row)} columns, the titles are {len(titles)}")
    return [row for _, row in rows]


def point_csv(path):
    """Returns {column: values} of a CSV file of `sprekk point`, and the tangential axes ["t"] or ["t1", "t2"]."""
    rows = csv_rows(path)
    if len(rows) < 2 or not {"t", "state", "jump_n"} <= set(rows[0]):
        raise PlotError(f'{path}: is not a CSV file of "sprekk point", which starts with "t,state,jump_n"')
    try:
        columns = dict(zip(rows[0], np.array(rows[1:], dtype=float).T))
    except ValueError as error:
        raise PlotError(f"{path}: a line contains no numbers ({error})") from None
    return columns, [name[len("jump_"):] for name in columns if name.startswith("jump_t")]


def results(directory):
    """Returns the content of results.json. Error for a run without steps."""
    path = Path(directory) / "results.json"
    if not path.is_file():
        raise PlotError(f'{directory}: contains no results.json; "sprekk run" writes one into its output directory')
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:  # invalid JSON or UTF-8
        raise PlotError(f"{path}: is not valid JSON ({error})") from None
    check_results(path, content)
    if not content.get("steps"):
        raise PlotError(f"{path}: no step of the run has been completed")
    return content


NUMBER = int, float
KINDS = {dict: "an object", list: "a list", NUMBER: "a number", bool: "true or false", str: "a text"}
WHOLE = {"status": str, "steps": list, "mesh": dict, "time_unit": dict, "single_fractures": list, "timing": dict}
STEP = {"time": NUMBER, "converged": bool, "cuts": NUMBER, "newton_iterations": NUMBER, "linear_iterations": NUMBER,
        "measures": dict}  # required in each step
OF_STEP = {"fractures": dict, "wells": dict, "reactions": dict, "single_fractures": dict, "inflows": dict}  # optional
MEMBERS = {"fractures": dict, "wells": dict, "reactions": list}  # types of their members


def check_results(path, content):
    """Checks the types of results.json. Error for files that `sprekk run` does not write."""
    def check(place, value, kind):
        if not isinstance(value, kind):
            text = json.dumps(value)[:40]
            raise PlotError(f"{path}: {place} is {text}, expected {KINDS[kind]}; run the scene again")

    def check_members(place, value, kinds):
        for name, kind in kinds.items():
            if name in value:
                check(f'"{name}"{place}', value[name], kind)
                for one in value[name].values() if kind is dict and name in MEMBERS else ():
                    check(f'a member of "{name}"{place}', one, MEMBERS[name])

    check("the content", content, dict)
    check_members("", content, WHOLE)
    for k, step in enumerate(content.get("steps", []), 1):
        check(f"step {k}", step, dict)
        missing = [name for name in STEP if name not in step]
        if missing:
            raise PlotError(f'{path}: step {k} has no "{missing[0]}"; run the scene again')
        check_members(f" of step {k}", step, {**STEP, **OF_STEP})


def scene(directory):
    """Returns sections and entries (texts) of effective_input.xml as nested dicts; empty without this file."""
    def section(node):
        return {child.get("name"): section(child) if child.tag == "ParameterList" else child.get("value") for child in node}
    path = Path(directory) / "effective_input.xml"
    try:
        return section(xml.parse(path).getroot()) if path.is_file() else {}
    except xml.ParseError as error:
        raise PlotError(f"{path}: is not valid XML ({error})") from None


def wells(scene, dim):
    """Returns {name: points (n, dim)} of the wells; `scene` as in scene()."""
    return {name: np.array([float(x) for x in well["points"].strip("{}").split(",")]).reshape(-1, dim)
            for name, well in scene.get("Flow", {}).get("Wells", {}).items()}


def entries(section, name):
    """Yields the nonempty values of all entries of a name in a section and its subsections."""
    for key, value in section.items():
        if isinstance(value, dict):
            yield from entries(value, name)
        elif key == name and value not in ("", "{}"):
            yield value


def written_steps(directory, kind):
    """Returns (time, file) of each step listed in DIRECTORY/KIND.pvd; empty without this file."""
    path = Path(directory) / f"{kind}.pvd"
    try:
        return [(float(entry.get("timestep")), file) for entry, file in listed(path)]
    except (TypeError, ValueError):
        raise PlotError(f'{path}: a file has no "timestep" that is a number') from None


def listed(path, tag="DataSet", attribute="file"):
    """Returns (entry, file) of each file listed in a .pvd, .vtm or .pvtu file; empty without this file."""
    if not path.is_file():
        return []
    try:
        entries = xml.parse(path).getroot().findall(f".//{tag}")
    except xml.ParseError as error:
        raise PlotError(f"{path}: is not valid XML ({error})") from None
    if any(entry.get(attribute) is None for entry in entries):
        raise PlotError(f'{path}: a {tag} has no "{attribute}"')
    return [(entry, path.parent / entry.get(attribute)) for entry in entries]


@contextmanager
def messages():
    """Collects messages of VTK. By default VTK prints them and omits unreadable parts."""
    window, shown, level = vtkStringOutputWindow(), vtkOutputWindow.GetInstance(), vtkLogger.GetCurrentVerbosityCutoff()
    vtkOutputWindow.SetInstance(window)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield window
    finally:
        vtkOutputWindow.SetInstance(shown)
        vtkLogger.SetStderrVerbosity(level)


def output(reader, file):
    """Returns the output of a VTK reader. Error for a missing, empty or damaged file."""
    if not Path(file).is_file():
        raise PlotError(f"{file}: no such file")
    with messages() as said:
        reader.SetFileName(str(file))
        reader.Update()
        content = reader.GetOutput()
    if "ERROR" in said.GetOutput():
        raise PlotError(f"{file}: is damaged or not complete; run the scene again")
    return content


def whole(reader, file, pieces):
    """Returns the content of a file that lists others. An error names the damaged file."""
    for piece in pieces:
        if not piece.is_file():
            raise PlotError(f"{piece}: no such file")
    try:
        return output(reader, file)
    except PlotError:
        for piece in pieces:
            output(vtkXMLUnstructuredGridReader(), piece)
        raise


def joined(grids):
    append = vtkAppendFilter()
    for data in grids:
        append.AddInputData(data)
    append.Update()
    return append.GetOutput()


def blocks(file):
    """Returns {name: grid} of a .vtm file, joined from the pieces of all ranks: fractures and intersections."""
    tree, found = whole(vtkXMLMultiBlockDataReader(), file, [piece for _, piece in listed(Path(file))]), {}
    for k in range(tree.GetNumberOfBlocks()):
        found[tree.GetMetaData(k).Get(tree.NAME())] = joined(parts(tree.GetBlock(k)))
    return found


def parts(block):
    """Returns the grids in a block: a single grid, the members of a nested block, or the pieces of earlier versions."""
    if hasattr(block, "GetBlock"):
        return [block.GetBlock(k) for k in range(block.GetNumberOfBlocks())]
    if hasattr(block, "GetPartition"):
        return [block.GetPartition(k) for k in range(block.GetNumberOfPartitions())]
    return [block]


def grid(file):
    """Returns the pieces of a .pvtu file, or all fractures of a .vtm file, as one VTK grid."""
    if Path(file).suffix == ".vtm":
        return joined(block for block in blocks(file).values() if block.GetCellData().HasArray("fracture"))
    return whole(vtkXMLPUnstructuredGridReader(), file, [piece for _, piece in listed(Path(file), "Piece", "Source")])


@dataclass
class Surface:
    """Polygons: points (n, 3), point indices of each polygon, {name: values} of polygons and of points."""
    points: np.ndarray
    polygons: list
    cell_data: dict
    point_data: dict

    def corners(self, points=None):
        """Returns the coordinates of the points of each polygon."""
        points = self.points if points is None else points
        return [points[polygon] for polygon in self.polygons]

    def part(self, chosen):
        """Returns the surface of the chosen polygons."""
        return Surface(self.points, [self.polygons[k] for k in chosen],
                       {name: values[chosen] for name, values in self.cell_data.items()}, self.point_data)


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def cells(connectivity):
    """Returns the point indices of each cell of a vtkCellArray."""
    offsets = vtk_to_numpy(connectivity.GetOffsetsArray())
    return np.split(vtk_to_numpy(connectivity.GetConnectivityArray()), offsets[1:-1]) if len(offsets) > 1 else []


def segments(data):
    """Returns the fracture faces of a plane problem. The first two points of a face are its ends."""
    return Surface(vtk_to_numpy(data.GetPoints().GetData()), cells(data.GetCells()), arrays(data.GetCellData()), {})


def surface(data):
    """Returns the cells of a plane grid, or the boundary faces of a body, as polygons."""
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
    skin = vtkDataSetSurfaceFilter()
    skin.SetInputData(data)
    skin.SetNonlinearSubdivisionLevel(0)
    skin.Update()
    skin = skin.GetOutput()
    return Surface(vtk_to_numpy(skin.GetPoints().GetData()), cells(skin.GetPolys()), arrays(skin.GetCellData()),
                   arrays(skin.GetPointData()))


def behind(data):
    """Returns the rear half of a body (y above the centre)."""
    from vtkmodules.vtkCommonDataModel import vtkPlane
    from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet
    plane, centre = vtkPlane(), data.GetCenter()
    plane.SetOrigin(centre[0], centre[1] + 1e-6 * data.GetLength(), centre[2])  # away from faces of the mesh
    plane.SetNormal(0, 1, 0)
    clip = vtkTableBasedClipDataSet()
    clip.SetInputData(data)
    clip.SetClipFunction(plane)
    clip.Update()
    return clip.GetOutput()


def is_plane(data):
    bounds = data.GetBounds()
    return bounds[5] == bounds[4]
