#!/usr/bin/env python3
"""Fracture files read by VTK: blocks_test.py PROGRAM ROOT MPIEXEC

Requires numpy and VTK's Python. If one is missing, the status is 77, for ctest's "skipped"."""
import importlib.util
import sys

from program import ProgramTest, main

MISSING = [name for name in ("numpy", "vtkmodules") if importlib.util.find_spec(name) is None]
if MISSING:
    print(f"skipped: {sys.executable} has no {', '.join(MISSING)}")
    sys.exit(77)

import numpy as np  # noqa: E402
import read  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402


class Blocks(ProgramTest):
    """Blocks of fractures and of intersections."""

    def blocks(self, output="out"):
        """Returns the blocks of the first step and the number of steps.

        Other steps have the same faces and intersections."""
        steps = [read.blocks(file) for _, file in read.written_steps(self.folder / output, "fractures")]
        for step in steps[1:]:
            self.assertEqual([(name, self.places(grid)) for name, grid in step.items()],
                             [(name, self.places(grid)) for name, grid in steps[0].items()])
        return steps[0], len(steps)

    def places(self, grid):
        """Returns the sorted centres of the cells."""
        points = vtk_to_numpy(grid.GetPoints().GetData())
        return sorted(tuple(np.round(points[cell].mean(axis=0), 9) + 0) for cell in read.cells(grid.GetCells()))

    def expect_same_on_two_ranks(self, scene, *overrides):
        found = []
        for ranks in (1, 2):
            results = self.run_scene(scene, *overrides, ranks=ranks, output=f"out{ranks}")
            blocks, n_steps = self.blocks(f"out{ranks}")
            self.assertEqual(n_steps, len(results["steps"]))
            *fractures, last = blocks
            self.assertEqual((fractures, last), (sorted(results["steps"][0]["fractures"]), "intersections"))
            self.assertEqual(sum(blocks[name].GetNumberOfCells() for name in fractures), results["mesh"]["fracture_faces"])
            for k, name in enumerate(fractures):
                self.assertEqual(set(read.arrays(blocks[name].GetCellData())["fracture"]), {k})
            found.append({name: self.places(grid) for name, grid in blocks.items()})
        self.assertEqual(*found)
        self.assertEqual(*((self.folder / f"out{ranks}/fractures/intersections.vtu").read_bytes() for ranks in (1, 2)))
        return blocks["intersections"]

    def test_in_2d(self):
        for order in (1, 2):
            points = self.expect_same_on_two_ranks("contact/network_t.xml", f"Mesh file.order={order}", "Time.end=1", "Time.steps=1")
            names = ",".join(f"f{k:02}" for k in range(1, 21))
            self.assertIn(f"intersections {points.GetNumberOfCells()} points", self.call("mesh-info", self.scene("contact/network_t.msh"), "--fractures", names)[0])
            data = read.arrays(points.GetCellData())
            self.assertTrue((data["fractures"] >= 2).all() and (data["first fracture"] < data["last fracture"]).all())
            self.assertEqual(set(data["faces"]), {3, 4})  # a T and an X

    def test_in_3d(self):
        for order, refinements, per_edge in ((1, 0, 1), (2, 0, 1), (1, 1, 2)):
            lines = self.expect_same_on_two_ranks("verification/crossing_3d.xml", f"Mesh.order={order}", f"Mesh.refinements={refinements}", "Time.steps=1", "Time.end=1")
            points = vtk_to_numpy(lines.GetPoints().GetData())
            cells = read.cells(lines.GetCells())
            if order == 1 and refinements == 0:
                coarse = len(cells)
            self.assertEqual(len(cells), coarse * per_edge)
            self.assertEqual({len(cell) for cell in cells}, {order + 1})
            self.assertAlmostEqual(sum(np.linalg.norm(points[cell[1]] - points[cell[0]]) for cell in cells), 1 + 0.75 + 0.5, 9)
            self.assertEqual(set(read.arrays(lines.GetCellData())["faces"]), {4})

    def test_of_channels(self):
        """Flow along the channels; there is none in the intersection of the east joint and the bedding."""
        found = []
        for ranks in (1, 2):
            self.run_scene("flow/channels_3d.xml", ranks=ranks, output=f"out{ranks}")
            blocks, _ = self.blocks(f"out{ranks}")
            channels = blocks["channels"]
            flow = read.arrays(channels.GetCellData())["channel flow"]
            points = vtk_to_numpy(channels.GetPoints().GetData())
            centres = np.array([points[cell].mean(axis=0) for cell in read.cells(channels.GetCells())])
            order = np.lexsort(np.round(centres, 6).T)
            found.append((centres[order], flow[order]))
            self.assertEqual(len(flow), blocks["intersections"].GetNumberOfCells())
        (centres, flow), (other_centres, other_flow) = found
        largest = np.abs(flow).max()
        self.assertLess(np.abs(centres - other_centres).max(), 1e-9)
        self.assertLess(np.abs(flow - other_flow).max(), 1e-6 * largest)
        without = (np.abs(centres[:, 0] - 70) < 1e-6) & (np.abs(centres[:, 1] - 50) > 1)
        shaft = (np.abs(centres[:, 0] - 70) < 1e-6) & (np.abs(centres[:, 1] - 50) < 1e-6)
        self.assertEqual(np.abs(flow[without]).max(), 0)
        self.assertTrue((flow[shaft][:, 2] < 0).all())  # down
        self.assertEqual(np.abs(flow[shaft][:, :2]).max(), 0)

    def test_of_one_fracture(self):
        self.run_scene("seed/push_3d.xml")
        self.assertEqual(list(self.blocks()[0]), ["fracture"])

    def test_after_a_restart_on_fewer_ranks(self):
        scene = ["contact/network_t.xml", "Output.checkpoints.steps=1"]
        self.run_scene(*scene, "Time.end=1", "Time.steps=1", ranks=2)
        self.call("run", self.scene(scene[0]), "--output", "out", "--restart", *(word for o in (*scene[1:], "Time.end=2", "Time.steps=2") for word in ("--set", o)))
        self.assertEqual(self.blocks()[1], 2)  # same places in both steps


if __name__ == "__main__":
    main()
