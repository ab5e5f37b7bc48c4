"""Reads what sprekk writes: the CSV of a point, the numbers and the grids of a run."""
import csv
import json
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader, vtkXMLPUnstructuredGridReader


class PlotError(Exception):
    """What is wrong with the input, in one line that names the file."""


def point_csv(path):
    """Columns of a CSV of `sprekk point` by name, and the tangential axes: ["t"] or ["t1", "t2"]."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2 or rows[0][:2] != ["t", "state"]:
        raise PlotError(f'{path}: is no CSV of "sprekk point"; such a file starts with "t,state,jump_n"')
    try:
        columns = dict(zip(rows[0], np.array(rows[1:], dtype=float).T))
    except ValueError as error:
        raise PlotError(f"{path}: a line is not complete or holds no numbers ({error})") from None
    return columns, [name[len("jump_"):] for name in columns if name.startswith("jump_t")]


def results(directory):
    """results.json of a run, with at least one step."""
    path = Path(directory) / "results.json"
    if not path.is_file():
        raise PlotError(f'{directory}: holds no results.json; "sprekk run" writes one into its output directory')
    try:
        content = json.loads(path.read_text())
    except json.JSONDecodeError as error:
        raise PlotError(f"{path}: is no JSON ({error})") from None
    if not content.get("steps"):
        raise PlotError(f"{path}: no step of the run has been completed")
    return content


def scene(directory):
    """The sections and entries (texts) of a run's effective_input.xml, as dictionaries; none if there is no such file."""
    def section(node):
        return {child.get("name"): section(child) if child.tag == "ParameterList" else child.get("value") for child in node}
    path = Path(directory) / "effective_input.xml"
    try:
        return section(xml.parse(path).getroot()) if path.is_file() else {}
    except xml.ParseError as error:
        raise PlotError(f"{path}: is no XML ({error})") from None


def entries(section, name):
    """The values of all entries of a name that are not empty, in a section and those in it."""
    for key, value in section.items():
        if isinstance(value, dict):
            yield from entries(value, name)
        elif key == name and value not in ("", "{}"):
            yield value


def written_steps(directory, kind):
    """(time, file) of each step that DIRECTORY/KIND.pvd lists; none if there is no such file."""
    return [(float(entry.get("timestep")), file) for entry, file in listed(Path(directory) / f"{kind}.pvd")]


def listed(path):
    """(entry, file) of each file that a .pvd or .vtm lists; none if there is no such list."""
    if not path.is_file():
        return []
    try:
        entries = xml.parse(path).getroot().findall(".//DataSet")
    except xml.ParseError as error:
        raise PlotError(f"{path}: is no XML ({error})") from None
    return [(entry, path.parent / entry.get("file")) for entry in entries]


def output(reader, file):
    if not Path(file).is_file():
        raise PlotError(f"{file}: no such file")
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def joined(grids):
    append = vtkAppendFilter()
    for data in grids:
        append.AddInputData(data)
    append.Update()
    return append.GetOutput()


def blocks(file):
    """The grids in a .vtm by their names, each with the pieces of all ranks: fractures, and where they meet."""
    for _, piece in listed(Path(file)):
        if not piece.is_file():  # VTK would go on
            raise PlotError(f"{piece}: no such file")
    tree, found = output(vtkXMLMultiBlockDataReader(), file), {}
    for k in range(tree.GetNumberOfBlocks()):
        block = tree.GetBlock(k)
        parts = [block.GetBlock(i) for i in range(block.GetNumberOfBlocks())] if hasattr(block, "GetBlock") else [block]
        found[tree.GetMetaData(k).Get(tree.NAME())] = joined(parts)
    return found


def grid(file):
    """The pieces of a .pvtu, or those of all fractures in a .vtm, as one grid of VTK."""
    if Path(file).suffix == ".vtm":
        return joined(block for block in blocks(file).values() if block.GetCellData().HasArray("fracture"))
    return output(vtkXMLPUnstructuredGridReader(), file)


@dataclass
class Surface:
    """Polygons: points (n, 3), for each polygon its points, values by name."""
    points: np.ndarray
    polygons: list
    cell_data: dict
    point_data: dict

    def corners(self, points=None):
        """Coordinates of each polygon's points."""
        points = self.points if points is None else points
        return [points[polygon] for polygon in self.polygons]


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def cells(connectivity):
    """The points of each cell of a vtkCellArray."""
    offsets = vtk_to_numpy(connectivity.GetOffsetsArray())
    return np.split(vtk_to_numpy(connectivity.GetConnectivityArray()), offsets[1:-1]) if len(offsets) > 1 else []


def segments(data):
    """The fractures of a plane problem, each face with its two end points first."""
    return Surface(vtk_to_numpy(data.GetPoints().GetData()), cells(data.GetCells()), arrays(data.GetCellData()), {})


def surface(data):
    """The cells of a plane grid, or the faces around a body, as polygons."""
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
    skin = vtkDataSetSurfaceFilter()
    skin.SetInputData(data)
    skin.SetNonlinearSubdivisionLevel(0)
    skin.Update()
    skin = skin.GetOutput()
    return Surface(vtk_to_numpy(skin.GetPoints().GetData()), cells(skin.GetPolys()), arrays(skin.GetCellData()),
                   arrays(skin.GetPointData()))


def behind(data):
    """The half of a body behind its middle, as seen from the front (-y)."""
    from vtkmodules.vtkCommonDataModel import vtkPlane
    from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet
    plane, centre = vtkPlane(), data.GetCenter()
    plane.SetOrigin(centre[0], centre[1] + 1e-6 * data.GetLength(), centre[2])  # off the faces of the mesh
    plane.SetNormal(0, 1, 0)
    clip = vtkTableBasedClipDataSet()
    clip.SetInputData(data)
    clip.SetClipFunction(plane)
    clip.Update()
    return clip.GetOutput()


def is_plane(data):
    bounds = data.GetBounds()
    return bounds[5] == bounds[4]
