"""Writes a Python state of ParaView for a run: deformed rock, cut in half in 3D, and the states of fractures."""
from pathlib import Path

from read import PlotError, grid, is_plane, results, written_steps

STATE = '''# Opens {name} in ParaView: File > Load State. Written by "sprekk plot --paraview".
from pathlib import Path

from paraview.simple import *

RUN = Path({run!r})  # where the results lie

view = GetActiveViewOrCreate("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesLabelColor = [0, 0, 0]


def show(source, place, array, title):
    """Shows the source in the view, coloured by an array of its POINTS or CELLS, with a colour bar."""
    display = Show(source, view)
    ColorBy(display, (place, array))
    table = GetColorTransferFunction(array)
    table.ApplyPreset("Cool to Warm" if array == "state" else "Viridis (matplotlib)", True)
    bar = GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    display.SetScalarBarVisibility(view, True)
    display.RescaleTransferFunctionToDataRange(False)
    if array == "state":
        table.RescaleTransferFunction(0, 2)
    return display


rock = PVDReader(registrationName="rock", FileName=str(RUN / "bulk.pvd"))
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
warped = WarpByVector(registrationName="deformed rock", Input=rock)
warped.Vectors = ["POINTS", "displacement"]
warped.ScaleFactor = {warp:g}
shown = warped
{cut}show(shown, "POINTS", "displacement", "displacement (m)")
{fractures}
view.ResetCamera()
{camera}Render(view)
'''

CUT = '''shown = Clip(registrationName="rear half", Input=warped)
shown.ClipType.Origin = {centre}
shown.ClipType.Normal = [0, -1, 0]
'''

FRACTURES = '''
fractures = PVDReader(registrationName="fractures", FileName=str(RUN / "fractures.pvd"))
faces = show(fractures, "CELLS", "state", "state: 0 open, 1 stick, 2 slip")  # or "slip", "opening", "traction", ...
faces.LineWidth = 4
'''

CAMERA = '''camera = GetActiveCamera()
camera.SetPosition(*[f + d for f, d in zip(camera.GetFocalPoint(), (0.55, -0.75, 0.42))])
camera.SetViewUp(0, 0, 1)
view.ResetCamera()
'''


def state_of(directory):
    """Returns the text of the state for the run in a directory."""
    from bulk import warp_factor
    from read import arrays
    from vtkmodules.util.numpy_support import vtk_to_numpy
    results(directory)
    steps = written_steps(directory, "bulk")
    if not steps:
        raise PlotError(f'{directory}: contains no bulk.pvd; the scene\'s Output has "vtu" false')
    rock = grid(steps[-1][1])
    if not rock.GetPointData().HasArray("displacement"):
        raise PlotError(f"{directory}: a ParaView state requires a run with mechanics; open bulk.pvd and fractures.pvd instead")
    warp = warp_factor(vtk_to_numpy(rock.GetPoints().GetData()), arrays(rock.GetPointData())["displacement"])
    solid, run = not is_plane(rock), Path(directory).resolve()
    return STATE.format(
        name=run.name, run=str(run), warp=warp,
        cut=CUT.format(centre=list(rock.GetCenter())) if solid else "",
        fractures=FRACTURES if written_steps(directory, "fractures") else "",
        camera=CAMERA if solid else "")
