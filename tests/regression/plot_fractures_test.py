#!/usr/bin/env python3
"""Pictures of fractures: plot_fractures_test.py PROGRAM ROOT MPIEXEC"""
from unittest import mock

from plotting import PlotTest  # before other modules: it skips the test without them
from program import ROOT, main
import fractures
import loops
import maps
import mohr
import numpy as np
import places
import read
import style


class Fractures(PlotTest):
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
        means = lambda t: {"mean_jump_local": [[1e-6, 1e-3 * t * (k + 1)] for k in range(n)], "mean_traction_local": [[-1e6, 1e5 * t]] * n}
        return [{"single_fractures": means(t)} for t in (1, 2)], [f"f {k + 1}" for k in range(n)]

    def test_loops_of_many_fractures(self):
        """Named curves differ in colour or line style. The legend is sorted by number and beside the axes."""
        for n, named in ((8, 8), (40, loops.MAX_SHOWN)):
            figure = loops.of_fractures(*self.means(n), "many")
            legend = figure.axes[2].get_legend()
            labels = [text.get_text() for text in legend.get_texts()]
            self.assertEqual(labels[:named], [f"f {k + 1}" for k in range(n - named, n)])
            self.assertEqual(labels[named:], [f"{n - named} others"] if n > named else [])
            lines = legend.get_lines()
            self.assertEqual(len({(line.get_color(), line._dash_pattern[1] and tuple(line._dash_pattern[1])) for line in lines}), len(labels))
            figure.canvas.draw()
            self.assertGreaterEqual(legend.get_window_extent().x0, figure.axes[2].get_window_extent().x1)

    def crossing_traces(self, n):
        """Returns a fracture with n parallel traces of two faces. The last but one slips, the others stick."""
        points = np.array([[x, k, 0.0] for k in range(n) for x in (0, 1, 3)])
        faces = [np.array([3 * k + i, 3 * k + i + 1]) for k in range(n) for i in (0, 1)]
        state = np.ones(2 * n)
        state[-4:-2] = 2
        jump = np.repeat(np.arange(n), 2)[:, None] * [0.0, 1e-3]
        data = {"fracture": np.zeros(2 * n), "state": state, "has slipped": np.arange(2 * n) > 1, "jump": jump, "jump local": jump, "slip": jump[:, 1], "opening": jump[:, 0],
                "traction": jump - [1e6, 0], "traction local": jump - [1e6, 0]}
        return read.Surface(points, faces, data, {})

    def test_every_trace_of_a_fracture_shows(self):
        """Each trace has a strip of states, which show past slip. The largest jumps have colours and labels."""
        for n in (5, 30):
            axes = fractures.along(self.crossing_traces(n), ["set"], "run", 1e-3, 1e6).axes
            strips = axes[-1].collections
            self.assertEqual([strip.get_array().ravel().tolist() for strip in strips], [[1, 1], *[[2, 2]] * (n - 3), [3, 3], [2, 2]])
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
                maps.write_names(ax, surface, ["set"], singles, 1e-3, np.array([[-1, -1], [4, 4]]))
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

    def test_names_do_not_overlap(self):
        """The second name moves along its trace, a third without room is left out; dense traces are thinner lines."""
        at, extent = [np.array([x, 0.5]) for x in (0.5, 0.1, 0.9)], np.ones(2)
        first = places.place_of_name("a fault", at, extent, [])
        self.assertEqual(tuple(first[0]), (0.5, 0.5))
        second = places.place_of_name("another", at, extent, [first])
        self.assertIn(second[0][0], (0.1, 0.9))
        self.assertIsNone(places.place_of_name("a third", [first[0], second[0]], extent, [first, second]))
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
        minimum, maximum = mohr.mean_stress(rock)
        self.assertAlmostEqual((x.max() - x.min()) / x.mean(), (maximum - minimum) / (0.5 * (maximum + minimum)), 2)
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

    def test_strength_far_above_the_stress_is_visible(self):
        """Half of the line of strength is inside of the diagram."""
        self.run_scene("verification/crossing_2d.xml", "Time.end=1", "Time.steps=1", "Tables.tangential.values={0, 1e-4, 0, 0, 0}",
                       "Materials.joint.friction coefficient=40")
        ax = self.figures("out")["mohr"].axes[0]
        (line,) = [line for line in ax.lines if line.get_label().startswith("strength of")]
        x, y = line.get_data()
        self.assertGreaterEqual(ax.get_ylim()[1], (1 - 1e-9) * np.interp(0.5 * x[-1], x, y))

    def test_growth_on_a_path(self):
        """The fracture of each step in the colour of its time, the first one on top; the region is that of the fracture."""
        from growth_test import Growth
        sets = [one for one in Growth.STRAIGHT if "vtu" not in one and "schedule" not in one]
        steps = self.run_scene("growth/edge_crack_2d.xml", *sets, "Time.schedule={1.4, 2, 2.6}")["steps"]
        made = self.figures("out")
        self.expect_labels(made["growth"], "time (s)", "x (m)")
        self.expect_labels(made["series"], "length (m)", "fracture energy (J/m)")
        lines = made["growth"].axes[0].collections[-3:]
        ends = [max(path.vertices[:, 0].max() for path in one.get_paths()) for one in lines]
        for end, step in zip(ends, reversed(steps)):
            self.assertAlmostEqual(end, step["fractures"]["crack"]["area"], delta=1e-5)
        self.assertEqual(len({tuple(one.get_color()[0]) for one in lines}), 3)
        self.assertIn("region of the fractures", made["bulk"]._suptitle.get_text())
        limits = made["bulk"].axes[0].get_ylim()
        self.assertTrue(-2 < limits[0] < 0 < limits[1] < 2, limits)
        self.assertNotIn("region", self.figures("out", "--whole")["bulk"]._suptitle.get_text())

    def test_growth_of_bonded_faces_in_3d(self):
        """Faces have the time of the first step in which their bond is lost; others are grey."""
        from energy_test import beam
        from perf.common import scene_file
        scene_file.save(beam([20, 4], 3e6, 1, (0.1,)), self.folder / "beam.xml", "Double cantilever beam.")
        content = self.run_scene(str(self.folder / "beam.xml"), "Time.steps=4")
        import growth
        times = {}
        with mock.patch.object(growth.Network, "draw", lambda view, ax, colours: times.update(times=view.data.get(growth.TIME))):
            self.expect_labels(self.figures("out")["growth"], "time (s)")
        found = times["times"]
        lost = found[np.isfinite(found)]
        self.assertTrue(0 < len(lost) < 20)
        self.assertEqual(max(lost), 1)
        self.assertGreater(len(set(lost.tolist())), 2)
        self.assertLess(abs(0.02 * 0.1 * len(lost) - content["steps"][-1]["fractures"]["growing"]["area_broken"] - 0.1 * 0.1), 0.004)

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
        figure = self.figures("out")["maps"]
        data = read.arrays(read.grid(read.written_steps(self.folder / "out", "fractures")[-1][1]).GetCellData())
        shown = [np.ma.filled(lines.get_array(), np.nan) for ax in figure.axes for lines in ax.collections if lines.get_array() is not None]
        shown = [values for values in shown if len(values) == len(data["slip"])]
        self.assertEqual(len(shown), 3)
        self.assertTrue(np.allclose(shown[0], np.minimum(maps.slip_tendency(data, 0), maps.LARGEST_TENDENCY), equal_nan=True))
        for values, name in zip(shown[1:], ("slip", "opening")):
            self.assertTrue(np.allclose(values / np.max(abs(values)), data[name] / np.max(abs(data[name]))), name)
        self.assertEqual(bool(figure.axes[0].get_legend()), bool(np.isnan(shown[0]).any()))

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

    def test_strength(self):
        normal = np.array([0.0, 1e6])
        joint = {"friction": "Coulomb", "friction angle": "30", "bond": "constant cohesion", "cohesion": "2e5"}
        self.assertTrue(np.allclose(mohr.strength(joint, normal), [2e5, 2e5 + 1e6 / 3**0.5]))
        self.assertTrue(np.allclose(mohr.strength({**joint, "bond": "none"}, normal), [0, 1e6 / 3**0.5]))
        self.assertIsNone(mohr.strength({"friction": "Coulomb", "friction coefficient": "0.5 + x"}, normal))
        rough = {"friction": "Barton-Choubey", "joint roughness coefficient": "10", "joint wall strength": "1e8", "residual friction angle": "25"}
        self.assertAlmostEqual(mohr.strength(rough, normal)[1] / 1e6, np.tan(np.radians(45)))
        self.assertIsNone(mohr.strength({"friction": "slip weakening"}, normal))

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


if __name__ == "__main__":
    main()
