#!/usr/bin/env python3
"""Pictures of runs and of points: plot_test.py PROGRAM ROOT MPIEXEC"""
import io
from pathlib import Path

from plotting import PlotTest, plot  # before other modules: it skips the test without them
from program import ROOT, main
import bulk
import flow
import numpy as np
import read
import style


TABLES = ["fractures_long.csv", "fractures_wide.csv"]


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
        names = ["bulk.png", "fractures.png", "maps.png", "mohr.png", "loops.png", "series.png", "events.png", "convergence.png"]
        self.assertEqual([Path(line).name for line in out.splitlines()], names + TABLES)
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
            names = ["flow.png", "convergence.png", *TABLES]
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
        self.assertEqual([Path(line).name for line in out.splitlines()], ["convergence.png", *TABLES])
        self.assertIn(f'no bulk.png or other picture of one step of {self.folder / "numbers"}: it contains no bulk.pvd; the scene\'s Output has "vtu" false', err)
        self.run_scene(ROOT / "docs/shear_test.xml", "Solver.maximum iterations=1", "Tables.ramp.values={0, 1000, 0}", output="failed", expect=3)
        self.assertIn("of one step of", self.draw(self.folder / "failed", "--dpi", "30")[1])

    def test_quadratic_cells(self):
        self.run_scene("seed/push_2d.xml", "Mesh.order=2")
        self.assertEqual(sorted(self.figures("out")), ["bulk", "convergence", "fractures", "maps", "mohr"])

    def test_one_step_has_no_loop(self):
        self.run_scene("seed/push_2d.xml")
        out, err = self.draw(self.folder / "out", "--dpi", "30")
        self.assertEqual([Path(line).name for line in out.splitlines()], ["bulk.png", "fractures.png", "maps.png", "mohr.png", "convergence.png", *TABLES])
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
        self.assertTrue(np.allclose(times, [0, 1, 2, 3]))
        self.assertTrue(np.allclose(volume, 6e-5 * 3600 * np.cumsum([0, 0.5, 1, 1])))
        self.assertAlmostEqual(panels["pressure in wells"].lines[0].get_ydata()[0], 10)  # MPa, the initial pressure
        self.expect_residuals(made["convergence"], content, 1e-11)
        lines = {line.get_label(): line.get_ydata() for line in panels["largest slip"].lines}
        wanted = [0, *(step["fractures"]["west"]["max_slip"] for step in content["steps"])]
        self.assertTrue(np.allclose(lines["west"] / lines["west"][-1], np.array(wanted) / wanted[-1]))
        names = {text.get_text() for ax in made["maps"].axes for text in ax.texts}
        self.assertEqual(names, set(content["steps"][-1]["fractures"]))

    def expect_residuals(self, figure, content, tolerance):
        """Measures of all steps without gaps, zeros at the lower end, and a line at the tolerance."""
        ax = figure.axes[-1]
        lines = {line.get_label(): line.get_ydata() for line in ax.lines}
        self.assertEqual(list(lines["tolerance"]), [tolerance, tolerance])
        low = ax.get_ylim()[0]
        for name in content["steps"][-1]["measures"]:
            measures = np.array([step["measures"][name] for step in content["steps"]])
            if np.any(measures > 0):
                np.testing.assert_allclose(lines[name.replace("_", " ")], np.where(measures > 0, measures, low))

    def test_long_labels(self):
        """A label longer than its axes has two lines, others have one."""
        figure, axes = style.plt.subplots(1, 2, figsize=(6, 2))
        axes[0].set_ylabel("shear traction / effective normal compression (-)")
        axes[1].set_ylabel("slip (mm)")
        style.save(figure, io.BytesIO(), 75)
        self.assertEqual([ax.get_ylabel() for ax in axes], ["shear traction / effective\nnormal compression (-)", "slip (mm)"])
        self.assertLess(axes[0].yaxis.label.get_window_extent().height, 150)

    def test_impermeable_rock(self):
        """The rock has no pressure, the fractures have one."""
        self.run_scene("poro/injection_2d.xml", "Materials.granite.permeability={0}", "Time.steps=1", "Time.end=3600")
        made = self.figures("out")
        self.assertNotIn("overview", made)
        self.expect_labels(made["fractures"], "effective traction (MPa)")

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


if __name__ == "__main__":
    main()
