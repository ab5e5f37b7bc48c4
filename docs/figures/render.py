#!/usr/bin/env python3
"""Renders the last step of a run to a picture, off-screen.

    xvfb-run -a python3 docs/figures/render.py RUN_DIRECTORY picture.png [--title "..."] [--fracture-array slip]

Needs Debian's python3-vtk9 (libvtk9-dev brings it) and xvfb. The bulk is warped by its displacement and coloured by
the displacement's magnitude, inside the outline of the undeformed box; in 3D the half towards the viewer is cut away
unless --whole is given.
Fractures lie in the middle of their two deformed sides, coloured by one of their cell arrays.
"""
import argparse
import xml.etree.ElementTree as xml
from pathlib import Path

import vtkmodules.vtkRenderingFreeType  # noqa: F401  text
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  the factory of what is drawn
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIdList
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPointLocator
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkTubeFilter
from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet, vtkWarpVector
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersModeling import vtkOutlineFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkDataSetMapper, vtkRenderer,
                                         vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter)

BULK_COLOURS = ["#f7fbff", "#c6dbef", "#6baed6", "#2171b5", "#08306b"]
FRACTURE_COLOURS = ["#2d1160", "#721f81", "#b63679", "#f1605d", "#feae76", "#fcfdbf"]
UNITS = {"slip": " [m]", "opening": " [m]", "jump": " [m]", "elastic jump": " [m]", "plastic jump": " [m]",
         "state": "\n0 open, 1 stick, 2 slip", "traction": " [Pa]"}
INK = (0.15, 0.16, 0.2)


def last_step(pvd):
    """Time and grid of the last step that a .pvd lists."""
    if not pvd.is_file():
        raise SystemExit(f"{pvd}: no such file")
    step = xml.parse(pvd).getroot().findall(".//DataSet")[-1]
    reader = vtkXMLPUnstructuredGridReader()
    reader.SetFileName(str(pvd.parent / step.get("file")))
    reader.Update()
    return float(step.get("timestep")), reader.GetOutput()


def filtered(kind, data, **settings):
    """The output of a VTK filter with these settings."""
    algorithm = kind()
    algorithm.SetInputData(data)
    for name, value in settings.items():
        getattr(algorithm, "Set" + name)(value)
    algorithm.Update()
    return algorithm.GetOutput()


def warped(grid, scale):
    warp = vtkWarpVector()
    warp.SetInputData(grid)
    warp.SetInputArrayToProcess(0, 0, 0, 0, "displacement")  # 0: point data
    warp.SetScaleFactor(scale)
    warp.Update()
    return warp.GetOutput()


def add_mid_displacement(fractures, bulk):
    """Gives the fracture points the mean displacement of the bulk points at their place, of all sides that meet."""
    locator, found, mean = vtkPointLocator(), vtkIdList(), vtkDoubleArray()
    locator.SetDataSet(bulk)
    locator.BuildLocator()
    mean.SetName("displacement")
    mean.SetNumberOfComponents(3)
    displacement = bulk.GetPointData().GetArray("displacement")
    for i in range(fractures.GetNumberOfPoints()):
        locator.FindPointsWithinRadius(1e-9 * bulk.GetLength(), fractures.GetPoint(i), found)
        tuples = [displacement.GetTuple(found.GetId(k)) for k in range(found.GetNumberOfIds())] or [(0, 0, 0)]
        mean.InsertNextTuple([sum(c) / len(tuples) for c in zip(*tuples)])
    fractures.GetPointData().AddArray(mean)


def rgb(colour):
    return [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]


def drawn(data, array_range, colours, name, on_cells):
    """An actor coloured by the magnitude of an array, and its colours."""
    low, high = array_range if array_range[1] > array_range[0] else (array_range[0], array_range[0] + 1)
    table = vtkColorTransferFunction()
    table.SetVectorModeToMagnitude()
    for i, colour in enumerate(colours):
        table.AddRGBPoint(low + (high - low) * i / (len(colours) - 1), *rgb(colour))
    mapper = vtkDataSetMapper()
    mapper.SetInputData(data)
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    if on_cells:
        mapper.SetScalarModeToUseCellFieldData()
    else:
        mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(name)
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor, table


def text(content, x, y, size, bold=False):
    actor = vtkTextActor()
    actor.SetInput(content)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    style = actor.GetTextProperty()
    style.SetFontSize(size)
    style.SetColor(INK)
    style.SetBold(bold)
    return actor


def colour_bar(table, title, y, height):
    """A bar at the right edge with its title above."""
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.2g")
    bar.SetTextPad(8)
    bar.SetUnconstrainedFontSize(True)
    bar.GetLabelTextProperty().SetFontSize(height // 50)
    for style in (bar.GetLabelTextProperty(), bar.GetTitleTextProperty()):
        style.SetColor(INK)
        style.ShadowOff()
        style.ItalicOff()
        style.BoldOff()
    bar.SetPosition(0.82, y)
    bar.SetWidth(0.1)
    bar.SetHeight(0.3)
    return [bar, text(title, 0.82, y + 0.32, height // 45)]


def place_camera(renderer, scene, planar, aspect):
    """Looks at the whole scene, from the front in 2D, from a corner in 3D, with room for the colour bars."""
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    centre = scene.GetCenter()
    direction = (0, 0, 1) if planar else (0.55, -0.75, 0.42)
    camera.SetFocalPoint(centre)
    camera.SetPosition([c + scene.GetLength() * d for c, d in zip(centre, direction)])
    camera.SetViewUp((0, 1, 0) if planar else (0, 0, 1))
    renderer.ResetCamera(scene.GetBounds())
    b = scene.GetBounds()
    half_height = 0.5 * max(b[3] - b[2], (b[1] - b[0]) / (0.74 * aspect)) if planar else 0.43 * scene.GetLength()
    camera.SetParallelScale(1.25 * half_height)
    camera.SetWindowCenter(0.13, 0.08)
    renderer.ResetCameraClippingRange()
    return direction


def scene_renderer(options):
    """Everything drawn, ready for a window."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    width, height = options.size
    time, bulk = last_step(options.run / "bulk.pvd")
    bounds = bulk.GetBounds()
    planar = bounds[5] - bounds[4] == 0
    largest = bulk.GetPointData().GetArray("displacement").GetMaxNorm()
    scale = options.warp if options.warp is not None else 0.03 * bulk.GetLength() / largest if largest > 0 else 0
    direction = place_camera(renderer, bulk, planar, width / height)

    outline = vtkActor()
    outline.SetMapper(vtkDataSetMapper())
    outline.GetMapper().SetInputData(filtered(vtkOutlineFilter, bulk))
    outline.GetProperty().SetColor(INK)
    outline.GetProperty().SetLineWidth(2)
    renderer.AddActor(outline)

    visible = bulk
    if not planar and not options.whole:
        plane, centre = vtkPlane(), bulk.GetCenter()
        plane.SetOrigin(centre[0], centre[1] + 1e-6 * bulk.GetLength(), centre[2])  # off the faces of the mesh
        plane.SetNormal(0, -direction[1], 0)  # what is behind the plane stays
        visible = filtered(vtkTableBasedClipDataSet, bulk, ClipFunction=plane)
    surface = filtered(vtkDataSetSurfaceFilter, warped(visible, scale))
    actor, table = drawn(surface, (0, largest), BULK_COLOURS, "displacement", False)
    if bulk.GetNumberOfCells() < 20000:
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.62, 0.68, 0.76)
    actor.GetProperty().SetLighting(not planar)
    actor.GetProperty().SetAmbient(0.5)
    actor.GetProperty().SetDiffuse(0.5)
    renderer.AddActor(actor)
    bars = [(table, "displacement [m]")]

    fracture_pvd = options.run / "fractures.pvd"
    fractures = last_step(fracture_pvd)[1] if fracture_pvd.is_file() else None
    if fractures and fractures.GetNumberOfCells() > 0:
        array = fractures.GetCellData().GetArray(options.fracture_array)
        if not array:
            data = fractures.GetCellData()
            names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
            raise SystemExit(f'{fracture_pvd}: no cell array "{options.fracture_array}"; there are {", ".join(names)}')
        add_mid_displacement(fractures, bulk)
        surface = filtered(vtkDataSetSurfaceFilter, warped(fractures, scale))
        if planar:
            surface = filtered(vtkTubeFilter, filtered(vtkCleanPolyData, surface), Radius=0.004 * bulk.GetLength(),
                               NumberOfSides=12, Capping=True)
        low, high = array.GetRange(0) if array.GetNumberOfComponents() == 1 else (0, array.GetMaxNorm())
        shown = (0, 2) if options.fracture_array == "state" else (min(low, 0), max(high, 0))
        actor, table = drawn(surface, shown, FRACTURE_COLOURS, options.fracture_array, True)
        actor.GetProperty().LightingOff()
        actor.SetPosition([2e-3 * bulk.GetLength() * d for d in direction])  # in front of a side at the same place
        renderer.AddActor(actor)
        bars.append((table, options.fracture_array + UNITS.get(options.fracture_array, "")))

    for (table, title), y in zip(bars, (0.5, 0.08)):
        for bar in colour_bar(table, title, y, height):
            renderer.AddActor2D(bar)
    if options.title:
        renderer.AddActor2D(text(options.title, 0.03, 0.935, height // 28, bold=True))
    renderer.AddActor2D(text(f"t = {time:g} s, deformation x {scale:.3g}", 0.03, 0.895, height // 45))
    return renderer


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("run", type=Path, help="a run's directory, with bulk.pvd and fractures.pvd")
    parser.add_argument("picture", type=Path, help="the PNG to write")
    parser.add_argument("--title", default="")
    parser.add_argument("--fracture-array", default="slip", help="cell array of the fractures (default: slip)")
    parser.add_argument("--warp", type=float, help="factor on the displacement (default: a visible one)")
    parser.add_argument("--whole", action="store_true", help="cut nothing away in 3D")
    parser.add_argument("--size", type=int, nargs=2, default=(1600, 1000), metavar=("WIDTH", "HEIGHT"))
    return parser.parse_args()


def main():
    options = arguments()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8)
    window.SetSize(*options.size)
    window.AddRenderer(scene_renderer(options))
    window.Render()
    grabber = vtkWindowToImageFilter()
    grabber.SetInput(window)
    grabber.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetFileName(str(options.picture))
    writer.SetInputConnection(grabber.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
