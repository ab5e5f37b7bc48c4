"""Mock of the members of paraview.simple in paraview.py, with readers and filters of VTK.

It fails for names that ParaView's proxies or the data do not have. Views record their displays."""
import read
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPlane
from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet, vtkWarpVector
from vtkmodules.vtkRenderingCore import vtkCamera

__all__ = ["PVDReader", "WarpByVector", "Clip", "Show", "ColorBy", "Render", "GetActiveViewOrCreate", "GetActiveCamera",
           "GetAnimationScene", "GetColorTransferFunction", "GetScalarBar"]


class Proxy:
    """Proxy with the properties listed by its class. Others cannot be set."""
    properties = ()

    def __init__(self, registrationName="", **values):
        for name, value in values.items():
            setattr(self, name, value)

    def __setattr__(self, name, value):
        if name not in self.properties:
            raise AttributeError(f"{type(self).__name__} has no {name}")
        super().__setattr__(name, value)


class PVDReader(Proxy):
    properties = ("FileName",)

    def output(self):
        """Returns the grid of the last step."""
        directory, _, file = self.FileName.rpartition("/")
        return read.grid(read.written_steps(directory, file[:-len(".pvd")])[-1][1])


class WarpByVector(Proxy):
    properties = ("Input", "Vectors", "ScaleFactor")

    def output(self):
        values(self.Input, self.Vectors)
        warp = vtkWarpVector()
        warp.SetInputData(self.Input.output())
        warp.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, self.Vectors[1])
        warp.SetScaleFactor(self.ScaleFactor)
        warp.Update()
        return warp.GetOutput()


class Plane(Proxy):
    properties = ("Origin", "Normal")


class Clip(Proxy):
    properties = ("Input", "ClipType")

    def __init__(self, **values):
        super().__init__(ClipType=Plane(), **values)

    def output(self):
        """Returns the part behind the plane, ParaView's default."""
        plane, clip = vtkPlane(), vtkTableBasedClipDataSet()
        plane.SetOrigin(self.ClipType.Origin)
        plane.SetNormal(self.ClipType.Normal)
        clip.SetInputData(self.Input.output())
        clip.SetClipFunction(plane)
        clip.InsideOutOn()
        clip.Update()
        return clip.GetOutput()


class Display(Proxy):
    properties = ("source", "array", "bar", "LineWidth")

    def SetScalarBarVisibility(self, view, visible):
        self.bar = visible

    def RescaleTransferFunctionToDataRange(self, extend):
        pass


class View(Proxy):
    properties = ("UseColorPaletteForBackground", "Background", "OrientationAxesLabelColor", "shown", "camera", "rendered")

    def ResetCamera(self):
        pass


class ColorTable(Proxy):
    def ApplyPreset(self, name, rescale):
        if name not in ("Cool to Warm", "Viridis (matplotlib)"):
            raise ValueError(name)

    def RescaleTransferFunction(self, low, high):
        pass


class ScalarBar(Proxy):
    properties = ("Title", "ComponentTitle", "TitleColor", "LabelColor")


class AnimationScene(Proxy):
    def UpdateAnimationUsingDataTimeSteps(self):
        pass

    def GoToLast(self):
        pass


def values(source, array):
    """Returns the values of an array, (POINTS or CELLS, name), of a source."""
    data = source.output()
    return read.arrays({"POINTS": data.GetPointData, "CELLS": data.GetCellData}[array[0]]())[array[1]]


view = View(shown=[], camera=vtkCamera(), rendered=0)


def GetActiveViewOrCreate(kind):
    return {"RenderView": view}[kind]


def GetActiveCamera():
    return view.camera


def GetAnimationScene():
    return AnimationScene()


def GetColorTransferFunction(array):
    return ColorTable()


def GetScalarBar(table, view):
    return ScalarBar()


def Show(source, view):
    view.shown.append(Display(source=source))
    return view.shown[-1]


def ColorBy(display, array):
    values(display.source, array)
    display.array = array


def Render(view):
    view.rendered += 1
