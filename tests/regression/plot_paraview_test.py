#!/usr/bin/env python3
"""State files for ParaView: plot_paraview_test.py PROGRAM ROOT MPIEXEC"""
import runpy
import sys
import types
from pathlib import Path
from unittest import mock

from plotting import PlotTest  # before other modules: it skips the test without them
from program import main
import numpy as np
import read
from vtkmodules.util.numpy_support import vtk_to_numpy


def points_at(grid, axis, place):
    """Returns the indices of the points in a plane normal to an axis."""
    return np.flatnonzero(abs(vtk_to_numpy(grid.GetPoints().GetData())[:, axis] - place) < 1e-12)


class ParaView(PlotTest):
    def shown_by_paraview(self, output):
        """Returns the displays of the state in the mock of ParaView."""
        out, _ = self.draw("--paraview", self.folder / output)
        state = self.folder / output / "paraview.py"
        self.assertEqual(Path(out.strip()), state)
        sys.modules.pop("paraview_stub", None)  # for a new view
        import paraview_stub
        with mock.patch.dict(sys.modules, {"paraview": types.ModuleType("paraview"), "paraview.simple": paraview_stub}):
            view = runpy.run_path(str(state))["view"]
        self.assertEqual(view.rendered, 1)
        self.assertTrue(all(display.bar for display in view.shown))
        self.assertEqual([display.array for display in view.shown],
                         [("POINTS", "displacement"), ("CELLS", "state")][:len(view.shown)])
        return view.shown

    def test_paraview_of_a_body(self):
        self.run_scene("seed/push_3d.xml", ranks=2)
        rock, faces = self.shown_by_paraview("out")
        body = read.grid(self.folder / "out" / "bulk_0000.pvtu")
        factor = rock.source.Input.ScaleFactor
        moved = factor * read.arrays(body.GetPointData())["displacement"]
        largest = np.max(np.linalg.norm(moved, axis=1))
        self.assertTrue(0.01 < largest <= 0.0501, largest)  # of a cube of 1 m
        low, high = rock.source.output().GetBounds()[2:4]
        self.assertAlmostEqual(low, 0.5, 9)  # the front half, y < 0.5, is cut away
        self.assertAlmostEqual(high, 1 + np.max(moved[:, 1][points_at(body, 1, 1.0)]), 9)
        self.assertEqual(faces.source.output().GetNumberOfCells(), 4)

    def test_paraview_of_a_plane(self):
        self.run_scene("verification/crossing_2d.xml")
        rock, faces = self.shown_by_paraview("out")
        self.assertEqual(rock.source.output().GetNumberOfCells(), read.grid(self.folder / "out" / "bulk_0003.pvtu").GetNumberOfCells())
        self.assertEqual(faces.LineWidth, 4)
        self.run_scene("verification/uniaxial_2d.xml", output="whole")
        self.assertEqual(len(self.shown_by_paraview("whole")), 1)


if __name__ == "__main__":
    main()
