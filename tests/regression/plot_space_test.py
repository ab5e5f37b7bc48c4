#!/usr/bin/env python3
"""Slip events, tables, and pictures in space: plot_space_test.py PROGRAM ROOT MPIEXEC"""

import csv
import io

from plotting import PlotTest  # before other modules: it skips the test without them
from program import ROOT, main
import events
import magnitudes
import network
import numpy as np
import orientations
import places
import read
import space
import style
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
CUBE = np.concatenate([SQUARE, SQUARE + [0, 0, 1]])


def event(start, end, moment):
    """Returns an event of fracture a with a slip of 1e-9 m per N m."""
    return events.Event("a", start, end, 1e-9 * moment, moment, (np.log10(moment) - 9.1) / 1.5, moment)


class Events(PlotTest):
    def test_table_of_events(self):
        """Times are in the unit of the results. A run without this table has no events."""
        content = {"time_unit": {"name": "h", "seconds": 3600}}
        self.assertEqual(events.of_run(self.folder, content), [])
        table = self.folder / "events.csv"
        table.write_text('fracture,start,end,slip,moment,magnitude,cumulated\n"a, b",1,1.5,2e-3,3,4,5\n')
        self.assertEqual(events.of_run(self.folder, content), [("a, b", 3600, 5400, 2e-3, 3, 4, 5, None, None)])
        table.write_text("fracture,start\na,b\n")
        with self.assertRaisesRegex(read.PlotError, "events.csv: is not a table of events; run the scene again"):
            events.of_run(self.folder, content)

    def test_tables_are_those_of_the_results(self):
        content = self.run_scene(ROOT / "docs/shear_test.xml", "Time.steps=8", "Output.vtu=false", "Output.time unit=h")
        self.draw(self.folder / "out", "--dpi", 30)
        long, wide, rows = (
            list(csv.DictReader((self.folder / "out" / name).read_text().splitlines()))
            for name in ("fractures_long.csv", "fractures_wide.csv", "events.csv")
        )
        moments = [step["single_fractures"]["moment"][0] for step in content["steps"]]
        total = float(rows[-1]["cumulated_moment [N]"])
        self.assertAlmostEqual(total / np.sum(abs(np.diff(moments, prepend=0))), 1, 2)
        self.assertTrue(
            all(float(row["end [h]"]) * 3600 in [step["time"] for step in content["steps"]] for row in rows)
        )
        for row, all_of_step, moment in zip(long, wide, moments, strict=True):
            self.assertEqual((row["fracture"], float(row["moment [N]"])), ("shear plane", moment))
            self.assertEqual(all_of_step["shear plane: moment [N]"], row["moment [N]"])
        self.assertEqual(float(row["fraction_has_slipped [-]"]), 1)
        self.assertIn("mean_traction_local t [Pa]", row)

    def test_magnitudes_over_time(self):
        """Dots are at the ends of events, hollow at the end of the run, over the injection rate."""
        wells = {"in": {"rate": 0.5}, "out": {"rate": -0.2}}
        steps = [{"time": t, "single_fractures": {"moment": [moment]}, "wells": wells}
                 for t, moment in ((3600, 1e9), (7200, 1e9), (10800, 2e9))]
        found = [event(0, 3600, 1e9), event(7200, 10800, 1e9)]
        figure = magnitudes.over_time(found, steps, "run")
        ax, below, behind = figure.axes
        dots = {line.get_label(): line.get_xdata().tolist() for line in ax.lines}
        self.assertEqual(dots, {"event": [1], "event that goes on at the end of the run": [3]})
        self.assertEqual(below.lines[0].get_ydata().tolist(), [0, 1e9, 1e9, 2e9])
        self.assertEqual((below.get_xlabel(), behind.get_ylabel()), ("time (h)", "injection rate (m³/s)"))
        self.assertEqual(magnitudes.injection(steps).tolist(), [0.5] * 3)
        self.assertIsNone(magnitudes.over_time([], steps, "run"))
        self.assertEqual(
            list(csv.reader(io.StringIO(events.as_csv(["a"], [[None], [np.nan], [1]])))), [["a"], [""], [""], ["1"]]
        )


class Space(PlotTest):
    def surface(self, *squares):
        data = {"slip": np.arange(len(squares), dtype=float), "fracture": np.arange(len(squares))}
        return read.Surface(np.concatenate(squares), list(np.arange(4 * len(squares)).reshape(-1, 4)), data, {})

    def test_nearer_faces_hide_others(self):
        """The hidden square is behind the large one as seen from above and the south; half-hidden ones are named."""
        towards = space.directions()[2]
        surface = self.surface(SQUARE * 4, SQUARE + [1.5, 1.5, 0] - 2 * towards, SQUARE * [4, 4, 1] - [2, 0, 1])
        bounds, numbers = space.bounds_of(surface.points), surface.cell_data["fracture"]
        seen = space.visible(surface, numbers, bounds)
        self.assertEqual(space.hidden(surface, numbers, seen, bounds), [1])
        low, high = space.flat(4 * SQUARE).min(axis=0), space.flat(4 * SQUARE).max(axis=0)
        self.assertTrue(np.all((seen[0] > low - 0.01) & (seen[0] < high + 0.01)))
        pixel = np.ptp(space.frame(bounds), axis=1).max() / space.PIXELS
        self.assertAlmostEqual(len(seen[0]) * pixel**2 / (16 * towards[2]), 1, 2)

    def test_transparent_faces_show_others(self):
        parts = [
            space.Part(SQUARE, [np.arange(4)], "#ff0000"),
            space.Part(SQUARE + [0, 0, 0.2], [np.arange(4)], "#0000ff", 0.3),
        ]
        picture = space.image(parts, space.bounds_of(np.concatenate([SQUARE, SQUARE + [0, 0, 0.2]])))
        red, _, blue = picture[picture.shape[0] // 2, picture.shape[1] // 2].astype(int)
        self.assertGreater(red, blue)
        self.assertGreater(blue, 30)

    def test_outer_faces(self):
        """Faces between ranks and sides of fractures occur twice and are left out; sharp edges are those of the body."""
        self.run_scene("verification/crossing_3d.xml", "Mesh.cells={4, 4, 4}", ranks=2)
        skin = space.outer(read.surface(read.grid(read.written_steps(self.folder / "out", "bulk")[-1][1])))
        low, high = space.bounds_of(skin.points)
        area = sum(np.linalg.norm(orientations.area_vector(x)) for x in skin.corners())
        a, b, c = high - low
        self.assertAlmostEqual(area, 2 * (a * b + b * c + c * a), 9)
        edges = space.edges(skin)
        length = sum(np.linalg.norm(np.diff(edges.points[line], axis=0)) for line in edges.polygons)
        self.assertAlmostEqual(length, 4 * (a + b + c), 5)

    def test_coordinates_and_north_do_not_overlap(self):
        for size in ((1, 1, 1), (10, 2, 1), (1, 8, 3)):
            figure, ax = style.plt.subplots(figsize=(4, 4))
            points = SQUARE * size + [0, 0, size[2]]
            space.draw(ax, [space.Part(points, [np.arange(4)], "#ff0000")], np.array([[0, 0, 0], size], dtype=float))
            figure.draw_without_rendering()
            boxes = [text.get_window_extent() for text in ax.texts if text.get_text()]
            self.assertTrue({"x (m)", "y (m)", "z (m)", "N"} <= {text.get_text() for text in ax.texts})
            overlaps = [(i, j) for i in range(len(boxes)) for j in range(i) if boxes[i].overlaps(boxes[j])]
            self.assertEqual(overlaps, [], [text.get_text() for text in ax.texts])

    def test_region_with_slip(self):
        """The region is around the changed places, inside of the whole; a change everywhere or nowhere has no region."""
        whole, centres = np.array([[0.0, 0, 0], [10, 10, 10]]), np.array([[1.0, 1, 1], [2, 1, 1], [9, 9, 9]])
        low, high = places.region(centres, np.array([1, 0.5, 0]), whole)
        self.assertTrue(
            np.all(low <= centres[0]) and np.all(high >= centres[1]) and np.all(low >= 0) and np.all(high < 5)
        )
        self.assertIsNone(places.region(centres, np.array([1, 0.5, 1]), whole))
        self.assertIsNone(places.region(centres, np.zeros(3), whole))

    def test_faces_are_cut_at_the_region(self):
        """The area of a square across a corner of the box is the part inside; values follow their faces."""
        points = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [5, 5, 5], [6, 5, 5], [6, 6, 5]])
        surface = read.Surface(points, [np.array([4, 5, 6]), np.array([0, 1, 2, 3])], {"slip": np.array([1.0, 2])}, {})
        part = space.clipped(surface, np.array([[1.0, 0.5, -1], [3, 3, 1]]))
        area = sum(np.linalg.norm(np.cross(x[1:-1] - x[0], x[2:] - x[0]).sum(axis=0)) / 2 for x in part.corners())
        self.assertAlmostEqual(area, 1.5)
        self.assertEqual(set(part.cell_data["slip"]), {2.0})

    def test_network(self):
        """The box is that of the rock; every fracture is named or listed as hidden, and a well is a line with a name."""
        content = self.run_scene("verification/crossing_3d.xml")
        rock, joints = (
            read.grid(read.written_steps(self.folder / "out", kind)[-1][1]) for kind in ("bulk", "fractures")
        )
        singles, wells = content["single_fractures"], {"well": np.array([[0.2, 0.3, 0.9], [0.2, 0.3, 0.5]])}
        view = network.Network(
            rock, joints, sorted(content["steps"][-1]["fractures"]), singles, whole=True, wells=wells
        )
        self.assertTrue(np.allclose(view.bounds.T.ravel(), rock.GetBounds()))
        figure, ax = style.plt.subplots()
        view.draw(ax, np.tile([1.0, 0, 0], (len(view.surface.polygons), 1)))
        self.assertTrue(np.allclose(ax.lines[-2].get_xydata(), space.flat(wells["well"])))
        drawn = len(ax.texts)
        view.write_names(ax)
        names = {text.get_text() for text in ax.texts[drawn:]} | set(view.hidden)
        self.assertEqual(names, {"well", *(one["name"] for one in singles)})

    def test_names_do_not_cover_wells(self):
        """A well through the middle of a fracture: neither its name nor that of the fracture is on it."""
        bounds = np.array([[0.0, 0, 0], [10, 10, 10]])
        well = np.array([[5.0, 5, 4], [5, 5, 6]])
        on = np.array([[x, 5.0, z] for x in np.linspace(2, 8, 9) for z in np.linspace(2, 8, 9)])
        figure, ax = style.plt.subplots()
        space.write_names(ax, [("fracture", space.flat(on))], bounds, {"well": well})
        texts = {text.get_text(): np.array(text.get_position()) for text in ax.texts}
        self.assertEqual(set(texts), {"well", "fracture"})
        extent = np.full(2, 1.5 * np.ptp(space.frame(bounds), axis=1).max())
        for name, place in texts.items():
            apart = np.abs(space.along(space.flat(well)) - place) > places.half_size(name, extent)
            self.assertTrue(np.all(np.any(apart, axis=1)), name)

    def test_walls_of_an_excavation(self):
        """A tunnel through a body of 5 x 5 x 5 cells has walls, drawn with the fracture, and edges at its ends."""
        cells = [(i, j, k) for i in range(5) for j in range(5) for k in range(5) if (i, k) != (2, 2)]
        rock = grid_of([np.array([i, j, k]) + CUBE for i, j, k in cells], 12)
        joints = grid_of([SQUARE * [5, 5, 0] + [0, 0, 1]], 9)
        for name, values in (("slip", [1.0]), ("fracture", [0.0]), ("jump local", [[0.0, 1.0, 0.0]])):
            array = numpy_to_vtk(np.array(values), deep=True)
            array.SetName(name)
            joints.GetCellData().AddArray(array)
        view = network.Network(rock, joints, ["fault"], whole=True)
        edges, _, walls = view.others
        self.assertEqual(len(walls.polygons), 4 * 5)
        self.assertTrue(np.all(abs(walls.points[np.concatenate(walls.polygons)][:, [0, 2]] - 2.5) < 0.6))
        length = sum(np.linalg.norm(np.diff(edges.points[line], axis=0)) for line in edges.polygons)
        self.assertAlmostEqual(length, 12 * 5 + 4 * 5 + 2 * 4)


def grid_of(cells, kind):
    """Returns a grid of cells of one type from their corners. Neighbours do not share points."""
    grid, points = vtkUnstructuredGrid(), vtkPoints()
    points.SetData(numpy_to_vtk(np.concatenate(cells).astype(float), deep=True))
    grid.SetPoints(points)
    n = len(cells[0])
    for k in range(len(cells)):
        grid.InsertNextCell(kind, n, range(n * k, n * (k + 1)))
    return grid


if __name__ == "__main__":
    main()
