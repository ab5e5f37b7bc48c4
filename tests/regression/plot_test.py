#!/usr/bin/env python3
"""Pictures of runs and of points: plot_test.py PROGRAM ROOT MPIEXEC

Requires matplotlib, numpy and VTK's Python. If one is missing, the status is 77, for ctest's "skipped"."""
import contextlib
import csv
import importlib.util
import io
import json
import runpy
import subprocess
import sys
import types
from pathlib import Path
from unittest import mock

from program import ROOT, ProgramTest, main

MISSING = [name for name in ("matplotlib", "numpy", "vtkmodules") if importlib.util.find_spec(name) is None]
if MISSING:
    print(f"skipped: {sys.executable} has no {', '.join(MISSING)}")
    sys.exit(77)

spec = importlib.util.spec_from_file_location("sprekk_plot", ROOT / "apps" / "plot" / "__main__.py")
plot = importlib.util.module_from_spec(spec)
spec.loader.exec_module(plot)

import bulk  # noqa: E402
import convergence  # noqa: E402
import flow  # noqa: E402
import fractures  # noqa: E402
import laboratory  # noqa: E402
import loops  # noqa: E402
import magnitudes  # noqa: E402
import maps  # noqa: E402
import mohr  # noqa: E402
import numpy as np  # noqa: E402
import overview  # noqa: E402
import read  # noqa: E402
import series  # noqa: E402
import style  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402


def points_at(grid, axis, place):
    """Returns the indices of the points in a plane normal to an axis."""
    return np.flatnonzero(abs(vtk_to_numpy(grid.GetPoints().GetData())[:, axis] - place) < 1e-12)


class PlotTest(ProgramTest):
    def tearDown(self):
        style.plt.close("all")

    def draw(self, *words, expect=0):
        """Returns standard output and error of the command."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.assertEqual(plot.main(list(map(str, words))), expect, err.getvalue())
        return out.getvalue(), err.getvalue()

    def csv(self, scene, *overrides):
        path = self.folder / "point.csv"
        path.write_text(self.call("point", self.scene(scene), *(w for o in overrides for w in ("--set", o)))[0])
        return path


class Pictures(PlotTest):
    def test_specimens_of_a_laboratory(self):
        path = self.csv("point/shear_tests.xml")
        self.draw(path)
        self.expect_pictures(["point.png"])
        (name, figure), = plot.of_csv(path)
        shear, dilation, stress = figure.axes
        names = ["0.5 MPa", "1 MPa", "1 MPa, 5 GPa/m", "1 MPa, constant volume", "2 MPa"]
        self.assertEqual([line.get_label() for line in shear.lines], names)
        load = dict(zip(names, zip(shear.lines, dilation.lines, stress.lines)))["1 MPa"]
        for line, initial in zip(load, (0, -0.02, 0)):  # MPa, mm under the initial load, MPa
            self.assertAlmostEqual(line.get_ydata()[0], initial, 12)
        self.assertAlmostEqual(max(load[0].get_ydata()), 1.19175, delta=0.003)  # peak strength by Barton's formula
        self.assertTrue(np.allclose(load[2].get_xdata(), 1))
        volume = dict(zip(names, dilation.lines))["1 MPa, constant volume"]
        self.assertTrue(np.allclose(volume.get_ydata(), -0.02))

    def figures(self, directory, *words):
        """Returns {name: figure} of a run."""
        with contextlib.redirect_stderr(io.StringIO()):
            return dict(plot.of_run(self.folder / directory, plot.arguments(["-", *words])))

    def expect_pictures(self, names):
        for name in names:
            picture = self.folder / name
            self.assertTrue(picture.is_file(), name)
            image = style.plt.imread(picture)[:, :, :3]
            pixels = image.reshape(-1, 3)
            self.assertGreater(len(np.unique(np.round(pixels * 255).astype(int) @ (1, 256, 256**2))), 50, name)
            ink = np.mean(np.any(pixels < 0.99, axis=1))
            self.assertTrue(0.005 < ink < 0.95, f"{name}: {ink}")
            for edge in (image[:8], image[-8:], image[:, :8], image[:, -8:]):  # nothing is cut off
                self.assertGreater(np.min(edge), 0.99, name)

    def expect_labels(self, figure, *wanted):
        axes = figure.axes
        labels = [label for ax in axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label]
        for words in wanted:
            self.assertTrue(any(words in label for label in labels), f"{words} is not in {labels}")

    def test_point(self):
        path = self.csv("point/cyclic_shear.xml", "Time.steps=80")
        out, _ = self.draw(path)
        self.assertEqual(out.strip(), str(path.with_suffix(".png")))
        self.expect_pictures(["point.png"])
        (name, figure), = plot.of_csv(path)
        self.assertEqual(name, "point")
        self.expect_labels(figure, "tangential jump (mm)", "shear traction (Pa)", "normal traction (Pa)")
        x, y = figure.axes[0].lines[0].get_data()
        self.assertEqual(len(x), 81)  # initial state and 80 steps
        self.assertEqual((x[0], y[0]), (0, 0))
        self.assertAlmostEqual(max(y), 0.18, 12)
        self.assertAlmostEqual(x[-1], 320, 9)  # mm

    def test_point_in_3d_of_many_steps(self):
        (_, figure), = plot.of_csv(self.csv("point/turning_shear.xml"))
        self.expect_labels(figure, "t1 (mm)", "t2 (mm)")
        self.assertEqual(figure.axes[2].get_aspect(), 1)

    def test_plane_run(self):
        self.run_scene("verification/crossing_2d.xml")
        out, _ = self.draw(self.folder / "out")
        names = ["bulk.png", "fractures.png", "maps.png", "mohr.png", "loops.png", "series.png", "convergence.png"]
        self.assertEqual([Path(line).name for line in out.splitlines()], names)
        self.expect_pictures("out/" + name for name in names)
        made = self.figures("out")
        self.expect_labels(made["bulk"], "x (m)", "y (m)", "displacement (", "von Mises stress (", "largest compressive")
        self.expect_labels(made["fractures"], "arc length (m)", "tangential jump (mm)", "opening (mm)", "traction (Pa)")
        self.expect_labels(made["maps"], "shear traction / normal compression (-)", "slip (mm)", "opening, normal jump (mm)", "x (m)")
        self.expect_labels(made["loops"], "mean tangential jump (", "mean normal traction (Pa)")
        self.expect_labels(made["convergence"], "Newton iterations (-)", "relative residual (-)")
        titles = [ax.get_title(loc="left") for ax in made["fractures"].axes]
        self.assertEqual([t for t in titles if t], ["flat", "steep"])

    def test_flow(self):
        """Flow only: pressure and velocity, in 2D on one rank and in 3D on two. Fractures show their own values."""
        for dim, cells in ((2, "{20, 20}"), (3, "{10, 10, 5}")):
            self.run_scene(f"flow/network_{dim}d.xml", f"Mesh.cells={cells}", "Time.steps=1", ranks=dim - 1)
            out, _ = self.draw(self.folder / "out")
            names = ["flow.png", "convergence.png"]
            self.assertEqual([Path(line).name for line in out.splitlines()], names)
            self.expect_pictures(["out/flow.png"])
            made = self.figures("out")
            self.expect_labels(made["flow"], "pressure (MPa)", "Darcy velocity (m/s)", "flux along fractures (m²/s)")
        joints = read.grid(self.folder / "out" / "fractures_0000.vtm")
        panels = dict((panel[0], panel[2]) for panel in flow.panels(read.surface(read.grid(self.folder / "out/bulk_0000.pvtu")), read.surface(joints)))
        pressure = read.arrays(joints.GetCellData())["fracture pressure"]
        np.testing.assert_allclose(np.sort(panels["pressure"][0]), np.sort(pressure) / 1e6, rtol=1e-6)
        _, err = self.draw(self.folder / "out", "--paraview", expect=1)
        self.assertIn("requires a run with mechanics", err)

    def test_heat(self):
        """Temperature and heat flux are those of the run, in 2D on one rank and in 3D on two."""
        for dim, cells in ((2, "{8, 6}"), (3, "{4, 3, 3}")):
            self.run_scene(f"heat/cooling_{dim}d.xml", f"Mesh.cells={cells}", "Time.steps=1", ranks=dim - 1)
            out, _ = self.draw(self.folder / "out")
            self.assertEqual([Path(line).name for line in out.splitlines()], ["temperature.png", "convergence.png"])
            self.expect_pictures(["out/temperature.png"])
            self.expect_labels(self.figures("out")["temperature"], "temperature (K)", "heat flux (W/m²)")
            if dim == 2:
                rock = read.grid(self.folder / "out/bulk_0000.pvtu")
                panels = dict((panel[0], panel[1]) for panel in flow.panels(read.surface(rock), None, flow.HEAT))
                np.testing.assert_allclose(np.sort(panels["temperature"][0]), np.sort(read.arrays(rock.GetCellData())["temperature"]))

    def test_rim_of_a_plane_run_is_that_of_the_body(self):
        """The rim contains each side of a fracture once, and no edges between the pieces of ranks."""
        def rim(ranks, *overrides):
            self.run_scene("verification/crossing_2d.xml", *overrides, ranks=ranks)
            rock, joints = (read.grid(self.folder / "out" / f"{kind}_0000.{end}") for kind, end in (("bulk", "pvtu"), ("fractures", "vtm")))
            surface = read.surface(rock)
            ends = surface.points[bulk.rim(surface, joints)]
            return np.sum(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)), joints
        length, joints = rim(1)
        faces = read.segments(joints)
        sides = 2 * sum(np.linalg.norm(np.diff(corners[:2], axis=0)) for corners in faces.corners())
        self.assertAlmostEqual(length, 4 + sides, 9)
        self.assertAlmostEqual(rim(2)[0], length, 9)
        self.assertAlmostEqual(rim(2, "Mesh.order=2")[0], length, 9)

    def test_run_in_3d_on_two_ranks(self):
        self.run_scene("verification/crossing_3d.xml", ranks=2)
        made = self.figures("out")
        self.expect_labels(made["bulk"], "displacement (", "von Mises stress (")
        self.expect_labels(made["fractures"], "slip (", "opening (", "normal traction (", "contact state (-)")
        self.expect_labels(made["maps"], "shear traction / normal compression (-)", "slip (", "opening, normal jump (")
        for words in ([], ["--whole"]):
            self.draw(self.folder / "out", *words, "--dpi", "60", "--output", self.folder / "pictures")
            self.expect_pictures(["pictures/bulk.png", "pictures/fractures.png", "pictures/maps.png"])

    def test_where_the_error_sits(self):
        self.run_scene("verification/crossing_3d.xml", "Output.error estimate=true")
        self.expect_labels(self.figures("out")["error"], "error density (J/m³)", "error of the jump (")
        self.run_scene("verification/uniaxial_2d.xml", "Output.error estimate=true")
        made = self.figures("out")["error"]
        self.expect_labels(made, "error density (J/m³)", "x (m)", "y (m)")
        self.run_scene("verification/free_sides_2d.xml", "Output.error estimate=true")
        made = self.figures("out")["error"]
        self.expect_labels(made, "error density (J/m³)", "error of the jump (")
        self.assertIn("relative error estimated: stress 0.", made._suptitle.get_text())
        self.run_scene("flow/network_2d.xml", "Output.error estimate=true")
        made = self.figures("out")["error"]
        self.expect_labels(made, "error density (W/m³)")
        self.assertIn("relative error estimated: flux 0.", made._suptitle.get_text())

    def test_loops_are_the_means_of_the_results(self):
        content = self.run_scene("verification/cyclic_2d.xml")
        last = content["steps"][-1]["fractures"]["fracture"]
        x, y = self.figures("out")["loops"].axes[0].lines[0].get_data()
        self.assertEqual(len(y), 1 + len(content["steps"]))
        self.assertEqual((x[0], y[0]), (0, 0))  # initial state
        self.assertAlmostEqual(abs(x[-1]) * 1e-3, abs(last["mean_jump"]["local"][1]), 12)
        self.assertAlmostEqual(abs(y[-1]), abs(last["mean_traction"]["local"][1]), 12)

    def test_loops_have_the_sign_of_the_results(self):
        """The sign of loops is that of the results, also if the largest value is negative or depends on round-off."""
        for ramp in ("{0, 1, -1.2}", "{0, 1, -1}", "{0, -1, 1}"):
            content = self.run_scene(ROOT / "docs/shear_test.xml", f"Tables.ramp.values={ramp}", "Time.steps=6", "Mesh.cells={8, 4}", "Output.vtu=false")
            wanted = [step["fractures"]["shear plane"]["mean_traction"]["local"][1] for step in content["steps"]]
            y = self.figures("out")["loops"].axes[0].lines[0].get_ydata()
            self.assertTrue(np.allclose(1e6 * y, [0, *wanted], rtol=1e-9, atol=1), (ramp, y, wanted))

    def test_loops_under_stress_start_with_the_first_step(self):
        """The results do not contain the initial stress on fractures, so loops begin with the first step."""
        content = self.run_scene(ROOT / "docs/shear_test.xml", "Time.steps=4", "Output.vtu=false", "Bulk.body force={0, 0}", "Bulk.initial stress={0, -5e6, 0, 0}")
        figure = self.figures("out")["loops"]
        dilation = figure.axes[2].lines[0].get_data()
        means = np.array([step["fractures"]["shear plane"]["mean_jump"]["local"] for step in content["steps"]])
        for values, wanted in zip(dilation, (means[:, 1], means[:, 0])):
            self.assertEqual(len(values), 4)
            self.assertTrue(np.allclose(values * np.max(abs(wanted)), wanted * np.max(abs(values)), rtol=1e-9))
        self.assertIn("first step", [text.get_text() for text in figure.legends[0].get_texts()])

    def means(self, n):
        """Returns the steps of a run with n fractures, and their names."""
        def mean(*local):
            return {"local": list(map(float, local))}
        names = [f"f {k + 1}" for k in range(n)]
        return [{"fractures": {name: {"mean_jump": mean(1e-6, 1e-3 * t * (k + 1)), "mean_traction": mean(-1e6, 1e5 * t)} for k, name in enumerate(names)}}
                for t in (1, 2)], sorted(names)

    def test_loops_of_many_fractures(self):
        """Named curves differ in colour or line style. The legend is sorted by number and beside the axes."""
        for n, named in ((12, 12), (40, style.MOST_CURVES)):
            figure = loops.of_fractures(*self.means(n), "many")
            legend = figure.axes[2].get_legend()
            labels = [text.get_text() for text in legend.get_texts()]
            self.assertEqual(labels[:named], [f"f {k + 1}" for k in range(n - named, n)])
            self.assertEqual(labels[named:], [f"{n - named} others"] if n > named else [])
            lines = legend.get_lines()
            self.assertEqual(len({(line.get_color(), line._dash_pattern[1] and tuple(line._dash_pattern[1])) for line in lines}), len(labels))
            figure.canvas.draw()
            self.assertGreaterEqual(legend.get_window_extent().x0, figure.axes[2].get_window_extent().x1)

    def test_convergence_shows_what_its_legend_lists(self):
        measures = {f"m{k}": 10.0**-k for k in range(12, 20)}
        steps = [{"newton_iterations": 2, "linear_iterations": 2, "cuts": 0, "measures": {**measures, "zero": 0.0, "none": None}}] * 3
        ax = convergence.of_run(steps, "run").axes[1]
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], sorted(measures))
        self.assertEqual(len({(line.get_color(), str(line.get_linestyle())) for line in ax.lines}), len(measures))
        for value in (3e-11, 1e-11):  # within a decade
            ax = convergence.of_run([{**steps[0], "measures": {"m": value}}] * 3, "run").axes[1]
            low, high = ax.get_ylim()
            self.assertGreaterEqual(sum(low <= tick <= high for tick in ax.get_yticks()), 2)

    def crossing_traces(self, n):
        """Returns a fracture with n parallel traces of two faces. The last but one slips, the others stick."""
        points = np.array([[x, k, 0.0] for k in range(n) for x in (0, 1, 3)])
        faces = [np.array([3 * k + i, 3 * k + i + 1]) for k in range(n) for i in (0, 1)]
        state = np.ones(2 * n)
        state[-4:-2] = 2
        jump = np.repeat(np.arange(n), 2)[:, None] * [0.0, 1e-3]
        data = {"fracture": np.zeros(2 * n), "state": state, "jump": jump, "jump local": jump, "slip": jump[:, 1], "opening": jump[:, 0],
                "traction": jump - [1e6, 0], "traction local": jump - [1e6, 0]}
        return read.Surface(points, faces, data, {})

    def test_every_trace_of_a_fracture_shows(self):
        """Each trace has a strip of states. The largest jumps have colours and labels."""
        for n in (5, 30):
            axes = fractures.along(self.crossing_traces(n), ["set"], "run", 1e-3, 1e6).axes
            strips = axes[-1].collections
            self.assertEqual([strip.get_array().ravel().tolist() for strip in strips], [[1, 1]] * (n - 2) + [[2, 2], [1, 1]])
            self.assertEqual(len({strip.get_datalim(axes[-1].transData).y0 for strip in strips}), n)
            legend = next(child for child in axes[0].get_children() if isinstance(child, style.matplotlib.legend.Legend))
            labels = [text.get_text() for text in legend.get_texts()]
            self.assertEqual(labels, ["1", "2", "3", "4", "5"] if n == 5 else ["25", "26", "27", "28", "29", "30", "others"])
            self.assertEqual(len({line.get_color() for line in legend.get_lines()}), len(labels))

    def test_traces_have_the_names_of_the_results(self):
        """Traces are in the order of results.json, with names without that of their set."""
        surface = self.crossing_traces(4)
        surface.cell_data["single fracture"] = np.array([3, 3, 1, 1, 0, 0, 2, 2])
        singles = [{"name": name} for name in ("A", "set 7", "C 1", "D")]
        traces = fractures.traces_of(surface, 0, "set", singles)
        self.assertEqual([(t.name, t.label, t.faces.tolist()) for t in traces],
                         [("A", "A", [4, 5]), ("set 7", "7", [2, 3]), ("C 1", "C 1", [6, 7]), ("D", "D", [0, 1])])
        axes = fractures.along(surface, ["set"], "run", 1e-3, 1e6, singles).axes
        self.assertEqual([text.get_text() for text in axes[-1].get_yticklabels()], ["A", "7", "C 1", "D"])
        figure = axes[0].figure
        figure.canvas.draw()
        for ax in axes[0], axes[2]:  # legends of lines do not cover curves
            self.assertGreaterEqual(ax.get_legend().get_window_extent().x0, ax.get_window_extent().x1)
        surface.cell_data["slip"][2:4] = 0
        for few, names_slip_only in ((4, False), (3, True)):
            with mock.patch.object(maps, "FEW", few):
                ax = figure.add_subplot()
                maps.write_names(ax, surface, ["set"], singles, 1e-3)
            names = [text.get_text() for text in ax.texts]
            self.assertEqual("set 7" not in names, names_slip_only)
            self.assertIn("A", names)

    def test_many_fractures_fit_a_page(self):
        """Many fractures are in the order of their numbers, four in a row."""
        surface = self.crossing_traces(11)
        surface.cell_data["fracture"] = np.repeat(np.arange(11), 2)
        names = sorted(str(k + 1) for k in range(11))
        figure = fractures.along(surface, names, "run", 1e-3, 1e6)
        self.assertEqual([t for t in (ax.get_title(loc="left") for ax in figure.axes) if t], [str(k + 1) for k in range(11)])
        self.assertLess(figure.get_size_inches()[0], 16)

    def test_step_of_a_time(self):
        self.run_scene("verification/crossing_2d.xml")
        self.assertIn("t = 2 s", self.figures("out", "--time", "2.2")["bulk"]._suptitle.get_text())
        self.assertIn("t = 4 s", self.figures("out")["bulk"]._suptitle.get_text())
        self.assertIn("× 3", self.figures("out", "--warp", "3")["bulk"]._suptitle.get_text())

    def test_run_without_fractures_and_without_grids(self):
        self.run_scene("verification/uniaxial_2d.xml")
        self.assertEqual(sorted(self.figures("out")), ["bulk", "convergence"])
        self.run_scene("seed/push_2d.xml", "Output.vtu=false", output="numbers")
        out, err = self.draw(self.folder / "numbers", "--dpi", "30")
        self.assertEqual([Path(line).name for line in out.splitlines()], ["convergence.png"])
        self.assertIn(f'no bulk.png or other picture of one step of {self.folder / "numbers"}: it contains no bulk.pvd; the scene\'s Output has "vtu" false', err)
        self.run_scene(ROOT / "docs/shear_test.xml", "Solver.maximum iterations=1", "Tables.ramp.values={0, 1000, 0}", output="failed", expect=3)
        self.assertIn("of one step of", self.draw(self.folder / "failed", "--dpi", "30")[1])

    def test_quadratic_cells(self):
        self.run_scene("seed/push_2d.xml", "Mesh.order=2")
        self.assertEqual(sorted(self.figures("out")), ["bulk", "convergence", "fractures", "maps", "mohr"])

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

    def test_one_step_has_no_loop(self):
        self.run_scene("seed/push_2d.xml")
        out, err = self.draw(self.folder / "out", "--dpi", "30")
        self.assertEqual([Path(line).name for line in out.splitlines()], ["bulk.png", "fractures.png", "maps.png", "mohr.png", "convergence.png"])
        self.assertIn("no loops.png", err)
        self.assertIn("one step", err)


    def test_injection(self):
        """Pressure change, volume, effective tractions and time in hours are those of the run."""
        content = self.run_scene("poro/injection_2d.xml", "Time.steps=3", "Time.end=10800")
        made = self.figures("out")
        change = made["flow"].axes[1]
        self.expect_labels(made["flow"], "p − p₀ (MPa)")
        rock = read.grid(read.written_steps(self.folder / "out", "bulk")[-1][1])
        shown = change.collections[0].get_array()
        self.assertTrue(np.allclose(np.sort(shown), np.sort(read.arrays(rock.GetCellData())["pressure"] / 1e6 - 10), atol=1e-6))
        self.expect_overview(made["overview"], rock)
        self.assertIn("t = 3 h", made["flow"]._suptitle.get_text())
        self.expect_labels(made["bulk"], "largest compressive stress, less α (p − p₀) (MPa)")
        self.expect_labels(made["fractures"], "effective traction (MPa)")
        self.expect_labels(made["mohr"], "effective normal compression (MPa)")
        self.expect_labels(made["series"], "time (h)", "largest slip (", "pressure in wells (MPa)", "injected volume (")
        panels = {ax.get_ylabel().split(" (")[0]: ax for ax in made["series"].axes}
        times, volume = panels["injected volume"].lines[0].get_data()
        self.assertEqual(panels["injected volume"].get_ylabel(), "injected volume (m²)")
        self.assertTrue(np.allclose(times, [1, 2, 3]))
        self.assertTrue(np.allclose(volume, 6e-5 * 3600 * np.cumsum([0.5, 1, 1])))
        lines = {line.get_label(): line.get_ydata() for line in panels["largest slip"].lines}
        wanted = [step["fractures"]["west"]["max_slip"] for step in content["steps"]]
        self.assertTrue(np.allclose(lines["west"] / lines["west"][-1], np.array(wanted) / wanted[-1]))
        names = {text.get_text() for ax in made["maps"].axes for text in ax.texts}
        self.assertEqual(names, set(content["steps"][-1]["fractures"]))

    def expect_overview(self, figure, rock):
        """Slip, and changes of pressure in rock and in fractures, as the run wrote them; a mark at the well."""
        left, right = figure.axes[:2]
        self.expect_labels(figure, "slip (", "p − p₀ (MPa), width: aperture")
        joints = read.arrays(read.grid(read.written_steps(self.folder / "out", "fractures")[-1][1]).GetCellData())
        shown = [c.get_array() for ax in (left, right) for c in ax.collections if c.get_array() is not None]
        wanted = joints["slip"], read.arrays(rock.GetCellData())["pressure"] - 10e6, joints["fracture pressure"] - 10e6
        for values, one in zip(shown, wanted, strict=True):
            self.assertTrue(np.allclose(np.sort(values) / np.max(values), np.sort(one) / np.max(one), atol=1e-6))
        self.assertEqual([tuple(line.get_xydata()[0]) for line in right.lines], [(97.5, 100)])
        self.assertEqual([text.get_text() for text in right.texts], ["injector"])

    def test_range_of_changes_of_pressure(self):
        """From zero on for a rise, with an arrow for smaller falls; around zero where both are alike, or for a fall."""
        for values, low, high, extend in ([0, 4], 0, 4, "neither"), ([-1, 4], 0, 4, "min"), ([-3, 4], -4, 4, "neither"), ([-4, 0], -4, 4, "neither"):
            norm, _ = overview.range_of_change(np.array(values, dtype=float))
            self.assertEqual((norm.vmin, norm.vmax, norm.extend), (low, high, extend))

    def test_names_do_not_overlap(self):
        """The second name moves along its trace, a third without room is left out; dense traces are thinner lines."""
        places, extent = [np.array([x, 0.5]) for x in (0.1, 0.5, 0.9)], np.ones(2)
        first = maps.place_of_name("a fault", places, extent, [])
        self.assertEqual(tuple(first[0]), (0.5, 0.5))
        second = maps.place_of_name("another", places, extent, [first])
        self.assertIn(second[0][0], (0.1, 0.9))
        self.assertIsNone(maps.place_of_name("a third", [first[0], second[0]], extent, [first, second]))
        outline = np.array([[0.0, 0], [100, 100]])
        traces = lambda n: np.tile([[0.0, 0], [50, 0]], (n, 1, 1))
        self.assertEqual([maps.line_width(traces(n), outline) for n in (1, 25, 1000)], [3, 2, 1.8])

    def test_mohr(self):
        """Face tractions and mean paths are those of the run.

        The diagram contains the circle of mean stress and the strength."""
        content = self.run_scene("verification/crossing_2d.xml")
        ax = self.figures("out")["mohr"].axes[0]
        lines = {line.get_label(): line.get_data() for line in ax.lines}
        joints = read.arrays(read.grid(read.written_steps(self.folder / "out", "fractures")[-1][1]).GetCellData())
        rock = read.grid(read.written_steps(self.folder / "out", "bulk")[-1][1])
        for state, label in enumerate(("open faces", "faces that stick", "faces that slip")):
            on = joints["state"] == state
            self.assertEqual(label in lines, bool(on.any()))
            if on.any():
                for values, wanted in zip(lines[label], (-joints["traction local"][on, 0], abs(joints["traction local"][on, 1]))):
                    scale = np.max(abs(wanted))
                    self.assertTrue(np.allclose(values / (np.max(abs(values)) or 1), wanted / (scale or 1), atol=1e-7))
        x, y = lines["mean stress of the rock"]
        least, most = mohr.mean_stress(rock)
        self.assertAlmostEqual((x.max() - x.min()) / x.mean(), (most - least) / (0.5 * (most + least)), 2)
        envelope = next(data for label, data in lines.items() if label.startswith("strength of"))
        materials = read.scene(self.folder / "out")
        friction = float(next(read.entries(materials["Materials"], "friction coefficient")))
        self.assertAlmostEqual(envelope[1][-1] / envelope[0][-1], friction, 9)
        for k, one in enumerate(content["single_fractures"]):
            means = np.array([step["single_fractures"]["mean_traction_local"][k] for step in content["steps"]])
            size = lines[f"path of {one['name']}"][0] @ means[:, 0] / (means[:, 0] @ means[:, 0])
            self.assertTrue(np.allclose(lines[f"path of {one['name']}"], [size * means[:, 0], -size * abs(means[:, 1])]))
        own = {"single_fractures": [{"name": "a", "own_joint": {"material": "joint", "friction coefficient": "0.1"}}, {"name": "b"}]}
        joints = mohr.joints_of({"Materials": {"joint": {"friction": "Coulomb"}}}, own)
        self.assertEqual(joints, {"a": {"friction": "Coulomb", **own["single_fractures"][0]["own_joint"]}})

    def test_strengths_are_drawn_once(self):
        """Joints with the same strength share a line. The legend names the first three; others without a line are named."""
        joints = {name: {"friction": "Coulomb", "friction coefficient": f"{0.1 * k:g}"} for k, name in enumerate("abcdefghij", 1)}
        joints |= {name: joints["a"] for name in "klm"} | {"n": {"friction": "slip weakening"}}
        ax = style.plt.figure().add_subplot()
        mohr.draw_envelopes(ax, joints, style.Quantity("", "Pa", 1e6), 1e6)
        labels = [line.get_label() for line in ax.lines]
        self.assertEqual(labels, ["strength of a, k, l and 1 more", *(f"strength of {name}" for name in "bcdefgh"), "strength not drawn: n, i, j"])
        self.assertEqual(len({(line.get_color(), str(line._dash_pattern)) for line in ax.lines[:-1]}), 8)

    def test_thin_bodies_are_drawn_wide(self):
        """Panels of thin bodies are in a column without empty space, those of square bodies in a row."""
        strip, square = np.array([[0.0, 0], [30, 1]]), np.array([[0.0, 0], [1, 1]])
        for points, rows in ((strip, 3), (square, 1)):
            figure, axes, where = style.panels_of_plane(3, points)
            self.assertEqual(len(figure.axes), 3)
            self.assertEqual(figure.axes[0].get_gridspec().nrows, rows)
            self.assertEqual(bool(where), rows == 3)
            self.assertLess(150 * figure.get_size_inches()[0], 2000)  # dots at the default resolution


class Maps(PlotTest):
    def test_slip_tendency(self):
        """Shear over compression; NaN on open faces, in tension and for round-off; zero if the shear is round-off."""
        traction = np.array([[-2.0, 1, 0], [-2, 0, -3], [0, 0, 0], [1, 1, 0], [-1e-14, 1, 0], [-5, 1e-10, 0]])
        data = {"traction local": traction, "traction": traction, "jump": traction, "state": np.array([1, 2, 0, 0, 1, 1])}
        self.assertTrue(np.array_equal(maps.slip_tendency(data, 5), [0.5, 1.5, np.nan, np.nan, np.nan, 0], equal_nan=True))

    def test_planes(self):
        """Faces in one plane form one pole with the area mean. Another fracture or height gives another pole."""
        square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
        corners = [square, square * [3, 1, 1] + [1, 0, 0], square, square + [0, 0, 1], square + [2, 0, 1]]
        surface = read.Surface(np.concatenate(corners), list(np.arange(20).reshape(5, 4)), {"fracture": np.array([0, 0, 1, 0, 0])}, {})
        found = sorted(maps.planes(surface, np.array([0.1, 0.5, 0.7, np.nan, 0.9]))[1])
        self.assertTrue(np.allclose(found, [0.4, 0.7, 0.9]), found)

    def test_colours_are_those_of_the_results(self):
        """In 2D each face has a line with the colour of its value. A legend explains open faces."""
        self.run_scene("verification/crossing_2d.xml")
        figure = self.figure("out", "maps")
        data = read.arrays(read.grid(read.written_steps(self.folder / "out", "fractures")[-1][1]).GetCellData())
        shown = [np.ma.filled(lines.get_array(), np.nan) for ax in figure.axes for lines in ax.collections if lines.get_array() is not None]
        shown = [values for values in shown if len(values) == len(data["slip"])]
        self.assertEqual(len(shown), 3)
        self.assertTrue(np.allclose(shown[0], np.minimum(maps.slip_tendency(data, 0), maps.LARGEST_TENDENCY), equal_nan=True))
        for values, name in zip(shown[1:], ("slip", "opening")):
            self.assertTrue(np.allclose(values / np.max(abs(values)), data[name] / np.max(abs(data[name]))), name)
        self.assertEqual(bool(figure.axes[0].get_legend()), bool(np.isnan(shown[0]).any()))

    def figure(self, directory, name):
        with contextlib.redirect_stderr(io.StringIO()):
            return dict(plot.of_run(self.folder / directory, plot.arguments(["-"])))[name]


class Errors(PlotTest):
    def expect_error(self, path, words, *options):
        out, err = self.draw(path, *options, expect=1)
        self.assertEqual(out, "")
        self.assertEqual(len(err.splitlines()), 1, err)
        for word in (str(path), *words):
            self.assertIn(word, err)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return path

    def test_wrong_paths(self):
        self.expect_error(self.folder / "absent", ["no such file"])
        self.expect_error(self.folder, ["contains no results.json"])
        self.expect_error(self.folder, ["contains no results.json"], "--paraview")

    def test_wrong_content(self):
        self.expect_error(self.write("notes.csv", "a,b\n1,2\n"), ["is not a CSV file", "t,state"])
        self.expect_error(self.write("cut.csv", "t,state,jump_n\n1,2\n3,4,x\n"), ["not complete"])
        self.expect_error(self.write("picture.csv", "\x89PNG"), ["is not a CSV file"])
        self.expect_error(self.write("run/results.json", "{").parent, ["is not valid JSON"])
        self.expect_error(self.write("run/results.json", '{"steps": []}').parent, ["no step"])

    def test_lost_pieces(self):
        self.run_scene("seed/push_2d.xml")
        (self.folder / "out" / "bulk_0000.pvtu").unlink()
        self.expect_error(self.folder / "out", ["bulk_0000.pvtu", "no such file"])
        self.run_scene("seed/push_2d.xml")
        (self.folder / "out" / "fractures" / "fractures_0000_0_0.vtu").unlink()
        self.expect_error(self.folder / "out", ["fractures_0000_0_0.vtu", "no such file"])
        (self.folder / "out" / "fractures.pvd").unlink()
        self.expect_error(self.folder / "out", ["fractures.pvd: has no step at t = "])

    def test_damaged_pieces(self):
        """An empty or truncated file gives one error with its name, without messages of VTK and without pictures."""
        self.run_scene("seed/push_2d.xml")
        command = [sys.executable, "-B", ROOT / "apps/plot", self.folder / "out", "--output", self.folder / "pictures"]
        for name in ("fractures/fractures_0000_0_0.vtu", "bulk/bulk_0000_0.vtu"):
            piece = self.folder / "out" / name
            whole = piece.read_bytes()
            for length in (0, 100, len(whole) // 2, len(whole) - 200):
                piece.write_bytes(whole[:length])
                done = subprocess.run(command, capture_output=True, text=True)
                self.assertEqual(done.returncode, 1, length)
                said = f"sprekk plot: {piece}: is damaged or not complete; run the scene again\n"
                self.assertEqual((done.stdout, done.stderr), ("", said))
                self.assertFalse((self.folder / "pictures").exists())
            piece.write_bytes(whole)
        self.draw(self.folder / "out", "--dpi", 20)

    def test_results_of_another_kind(self):
        for content in ("[]", "null", '{"steps": 3}', '{"steps": [1]}', '{"mesh": 2, "steps": []}'):
            self.expect_error(self.write("run/results.json", content).parent, ["results.json: ", "expected "])
        self.expect_error(self.write("run/results.json", '{"steps": [{}]}').parent, ['step 1 has no "time"'])
        self.run_scene("seed/push_2d.xml")
        known = self.results()
        for name, value in (("fractures", []), ("fractures", {"fracture": 1}), ("time", "0"), ("cuts", None)):
            step = {**known["steps"][-1], name: value}
            self.write("run/results.json", json.dumps({**known, "steps": [step]}))
            self.expect_error(self.folder / "run", [f'"{name}" of step 1 is ', "expected "])
        (self.folder / "run/results.json").write_bytes(b'{"reason": "\xff"}')
        self.expect_error(self.folder / "run", ["results.json: is not valid JSON"])

    def test_columns_by_their_titles(self):
        """Columns may have any order. Repeated or additional columns are errors."""
        path = self.csv("point/cyclic_shear.xml", "Time.steps=4")
        rows = [line.split(",") for line in path.read_text().splitlines()]
        turned = self.write("turned.csv", "".join(",".join(row[::-1]) + "\n" for row in rows))
        for name, values in read.point_csv(path)[0].items():
            self.assertEqual(read.point_csv(turned)[0][name].tolist(), values.tolist())
        specimens = self.csv("point/shear_tests.xml", "Time.steps=4")
        with specimens.open(newline="") as file:
            rows = list(csv.reader(file))
        turned = self.folder / "turned.csv"
        with turned.open("w", newline="") as file:
            csv.writer(file).writerows(row[::-1] for row in rows)
        known, found = laboratory.specimens(specimens), laboratory.specimens(turned)
        self.assertEqual(list(found), list(known))
        for name, curve in known.items():
            self.assertTrue(all(np.array_equal(found[name][title], values) for title, values in curve.items()))
        for titles, why in (("t,state,jump_n,t", 'line 1: two columns have the title "t"'),
                            ("t,state,jump_n", "line 2: is not complete: has 4 columns")):
            self.expect_error(self.write("a.csv", titles + "\n1,1,1,1\n"), [why])


class Numbers(ProgramTest):
    def test_stress_measures(self):
        stress = np.array([[-3.0, 0, 0, 0, 0, 0], [1, 1, 1, 0, 0, 0], [0, 0, 0, 2, 0, 0], [0, 0, 0, 0, 0, 2]])
        self.assertTrue(np.allclose(bulk.von_mises(stress), [3, 0, 2 * 3**0.5, 2 * 3**0.5]))
        self.assertTrue(np.allclose(bulk.largest_compression(stress), [3, -1, 2, 2]))

    def test_stress_measures_do_not_depend_on_the_axes(self):
        turn = np.linalg.qr(np.array([[1.0, 2, 3], [-2, 1, 5], [4, 0, 1]]))[0]
        sigma = turn @ np.diag([-3.0, 1, 2]) @ turn.T
        stress = np.array([[sigma[0, 0], sigma[1, 1], sigma[2, 2], sigma[0, 1], sigma[1, 2], sigma[0, 2]]])
        self.assertTrue(np.allclose(bulk.largest_compression(stress), 3))
        self.assertTrue(np.allclose(bulk.von_mises(stress), 21**0.5))

    def test_units(self):
        self.assertEqual([style.unit(v, "m")[1] for v in (2.0, 0.02, 2e-5, 2e-9, 0)], ["m", "mm", "µm", "nm", "m"])
        self.assertEqual([style.unit(v, "Pa")[1] for v in (5e9, 5e6, 700.0, 7.0, 0)], ["GPa", "MPa", "kPa", "Pa", "Pa"])

    def test_chains_order_the_faces_of_a_fracture(self):
        points = np.array([[3.0, 0, 0], [0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 2, 0], [3, 2, 0]])
        faces = [np.array(f) for f in ([4, 5], [1, 2], [3, 4])]  # points 2 and 3 have the same place
        (chain, arc), = fractures.chains(read.Surface(points, faces, {}, {}))
        self.assertEqual(chain, [1, 2, 0])
        self.assertTrue(np.allclose(arc, [0, 1, 3, 5]))

    def test_main_direction(self):
        """The sign is that of the first vector with an extent, not of the largest. In 2D it is that of the results."""
        along = loops.main_direction(np.array([[1e-15, -1e-15], [0.1, 0.1], [-2.0, -2.0], [1.0, 1.0]]))
        self.assertTrue(np.allclose(along, [0.5**0.5, 0.5**0.5]))
        self.assertEqual(loops.main_direction(np.array([[0.1], [-2.0]])).tolist(), [1])
        self.assertEqual(abs(loops.main_direction(np.zeros((3, 2)))).tolist(), [1, 0])

    def test_traces_that_cross(self):
        """Each crossing trace is one chain between its ends.

        An abutting trace ends there; a bend does not end a chain."""
        points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, -1, 0], [1, 1, 0], [2, 1, 0], [0, 2, 0], [3, 2, 0]])
        faces = [np.array(f) for f in ([0, 1], [3, 1], [1, 2], [1, 4], [4, 5], [6, 4], [4, 7])]
        found = {tuple(sorted(chain)) for chain, _ in fractures.chains(read.Surface(points, faces, {}, {}))}
        self.assertIn((0, 2), found)
        self.assertIn((1, 3), found)

    def test_round_off_is_one_colour(self):
        noise = 1e-12 * np.array([1.0, -2, 3])
        self.assertTrue((style.without_noise(noise, 1) == 0).all())
        self.assertEqual(np.ptp(style.without_noise(0.5 + noise, 1)), 0)
        self.assertEqual(style.limits(0.5 + noise).single, 0.5 + np.mean(noise[1:]))
        self.assertIsNone(style.limits(np.array([1.0, 2])).single)
        kept = np.array([1.0, np.nan, 1e-3])
        self.assertTrue(np.array_equal(style.without_noise(kept, 1), kept, equal_nan=True))
        figure, ax = style.plt.subplots()
        bar = style.colour_bar(figure, ax, style.limits(np.full(3, 2.5e-11)), style.plt.get_cmap(), "slip (m)")
        figure.canvas.draw()
        self.assertEqual([label.get_text() for label in bar.ax.get_yticklabels()], ["2.5e-11"])
        self.assertEqual(bar.ax.yaxis.get_offset_text().get_text(), "")

    def test_outliers_are_clipped_with_arrows(self):
        values = np.concatenate([np.linspace(0, 1, 1000), [100]])
        norm = style.limits(values, clip=True)
        self.assertAlmostEqual(norm.vmax, np.percentile(values, 99))
        self.assertEqual((norm.vmin, norm.extend), (0, "max"))
        figure, ax = style.plt.subplots()
        self.assertEqual(style.colour_bar(figure, ax, norm, style.plt.get_cmap(), "").extend, "max")
        for kept in (np.linspace(0, 1, 1000), np.array([0.0, 1]), np.zeros(5)):
            self.assertEqual(style.limits(kept, clip=True).extend, "neither")
        self.assertEqual(style.limits(values).extend, "neither")
        both = style.limits(np.concatenate([values, [-100]]), clip=True)
        self.assertEqual(both.extend, "both")

    def test_pressure_at_the_start(self):
        surface = read.Surface(np.array([[0.0, 0, 0], [0, -2, 0], [1, -4, 0]]), [np.array([0, 1]), np.array([1, 2])], {}, {})
        self.assertTrue(np.allclose(flow.at_start("1e5 - 9.81e3*y", surface), [1e5 + 9.81e3, 1e5 + 3 * 9.81e3]))
        self.assertTrue(np.allclose(flow.at_start("2.5E7", surface), 2.5e7))
        for unknown in ("table(t)", "p0", "__import__('os')", "1/0", "xy"):
            self.assertIsNone(flow.at_start(unknown, surface))

    def test_strength(self):
        normal = np.array([0.0, 1e6])
        joint = {"friction": "Coulomb", "friction angle": "30", "bond": "constant cohesion", "cohesion": "2e5"}
        self.assertTrue(np.allclose(mohr.strength(joint, normal), [2e5, 2e5 + 1e6 / 3**0.5]))
        self.assertTrue(np.allclose(mohr.strength({**joint, "bond": "none"}, normal), [0, 1e6 / 3**0.5]))
        self.assertIsNone(mohr.strength({"friction": "Coulomb", "friction coefficient": "0.5 + x"}, normal))
        rough = {"friction": "Barton-Choubey", "joint roughness coefficient": "10", "joint wall strength": "1e8", "residual friction angle": "25"}
        self.assertAlmostEqual(mohr.strength(rough, normal)[1] / 1e6, np.tan(np.radians(45)))
        self.assertIsNone(mohr.strength({"friction": "slip weakening"}, normal))

    def test_times(self):
        self.assertEqual([style.when(t) for t in (2.0, 600.0, 7200.0, 30 * 86400.0)], ["t = 2 s", "t = 10 min", "t = 2 h", "t = 30 d"])
        self.assertEqual(style.when(43200.0, (86400.0, "d")), "t = 0.5 d")
        self.assertTrue(np.allclose(series.injected(np.array([2.0, 3]), np.array([5.0, 7]), 1.0), [5, 12]))

    def test_probes(self):
        path = self.folder / "gauge.csv"
        path.write_text("time [d],pressure [Pa],mean slip [m],maximum slip [m]\n1,2e6,1e-3,2e-3\n2,3e6,2e-3,5e-3\n")
        axes = series.of_probe(path).axes
        self.assertEqual([ax.get_ylabel() for ax in axes], ["pressure (MPa)", "values (mm)"])
        self.assertEqual(axes[-1].get_xlabel(), "time (d)")
        self.assertEqual([line.get_ydata().tolist() for line in axes[1].lines], [[1, 2], [2, 5]])
        path.write_text("time [s],slip [m]\n0,0\n36000,1\n")
        (ax,) = series.of_probe(path).axes
        self.assertEqual([ax.get_xlabel(), *ax.lines[0].get_xdata()], ["time (h)", 0, 10])
        path.write_text("time [s],distance [m],x [m],y [m],slip [m]\n1,0,0,0,1\n1,1,1,0,2\n7200,0,0,0,3\n7200,1,1,0,4\n")
        figure = series.of_probe(path)
        self.assertEqual(figure._suptitle.get_text(), "gauge, t = 2 h")
        (ax,) = figure.axes
        self.assertEqual([ax.lines[0].get_xdata().tolist(), ax.lines[0].get_ydata().tolist()], [[0, 1], [3, 4]])
        path.write_text("a,b\n")
        self.assertRaises(read.PlotError, series.of_probe, path)

    def test_magnitudes(self):
        """The b-value of a known sample is correct within three standard errors, and absent for few fractures."""
        sample = 2 + np.random.default_rng(1).exponential(np.log10(np.e) / 1.2, 3000)
        b, error = magnitudes.b_value(sample, 2.0)
        self.assertLess(abs(b - 1.2), 3 * error)
        self.assertLess(error, 0.05)
        for n in (40, 400):
            step = {"single_fractures": {"moment_magnitude": [*sample[:n], None, None]}}
            points, *line = magnitudes.of_step(step, "run").axes[0].lines
            self.assertTrue(np.allclose(points.get_xdata(), np.sort(sample[:n])))
            self.assertEqual(points.get_ydata().tolist(), list(range(n, 0, -1)))
            self.assertEqual(len(line), n > 50)
        self.assertIsNone(magnitudes.of_step({"single_fractures": {"moment_magnitude": [1.0] * 5}}, "run"))
        self.assertIsNone(magnitudes.of_step({}, "run"))

    def test_rose_is_centred_on_axes(self):
        """A line along y gives a bar centred at y. Bars are shares in percent, in both directions."""
        ax = style.plt.figure().add_subplot(projection="polar")
        maps.orientations.draw_rose(ax, [("red", [np.array([[0.0, 0], [0, 2]]), np.array([[0.0, 0], [1, 0]])])])
        bars = {round(np.degrees(bar.get_x() + bar.get_width() / 2)): bar.get_height() for bar in ax.patches if bar.get_height() > 0}
        self.assertEqual(sorted(bars), [0, 90, 180, 270])
        self.assertTrue(np.allclose([bars[0], bars[90]], [200 / 3, 100 / 3]))

    def test_directions_of_one_value_have_one_colour(self):
        lines = [np.array([[0.0, 0], [np.cos(a), np.sin(a)]]) for a in (0.1, 0.9, 2.0)]
        values = 0.5773 + np.array([0, 1e-16, -1e-16])
        ax = style.plt.figure().add_subplot(projection="polar")
        maps.draw_directions(ax, lines, values, style.limits(values), style.plt.get_cmap())
        self.assertEqual(len({bar.get_facecolor() for bar in ax.patches if bar.get_height() > 0}), 1)

    def test_names_are_in_the_order_of_their_numbers(self):
        self.assertEqual(sorted(["10", "2", "1", "b 3", "b 12", "a"], key=style.natural), ["1", "2", "10", "a", "b 3", "b 12"])


if __name__ == "__main__":
    main()
