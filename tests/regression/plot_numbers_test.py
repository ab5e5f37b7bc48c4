#!/usr/bin/env python3
"""Numbers, units and scales of pictures: plot_numbers_test.py PROGRAM ROOT MPIEXEC"""
from plotting import PlotTest  # before other modules: it skips the test without them
from program import ROOT, main
import importlib.util
import bulk
import convergence
import flow
import magnitudes
import numpy as np
import overview
import rates
import read
import series
import style


specification = importlib.util.spec_from_file_location("plot_main", ROOT / "apps/plot/__main__.py")
plot_main = importlib.util.module_from_spec(specification)
specification.loader.exec_module(plot_main)
plot_seconds = plot_main.seconds


class Numbers(PlotTest):
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

    def test_round_off_is_one_colour(self):
        noise = 1e-12 * np.array([1.0, -2, 3])
        self.assertTrue((style.without_noise(noise, 1) == 0).all())
        self.assertEqual(np.ptp(style.without_noise(0.5 + noise, 1)), 0)
        self.assertEqual(style.limits(0.5 + noise).single, 0.5 + np.mean(noise[1:]))
        self.assertIsNone(style.limits(np.array([1.0, 2])).single)
        saved = np.array([1.0, np.nan, 1e-3])
        self.assertTrue(np.array_equal(style.without_noise(saved, 1), saved, equal_nan=True))
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
        for saved in (np.linspace(0, 1, 1000), np.array([0.0, 1]), np.zeros(5)):
            self.assertEqual(style.limits(saved, clip=True).extend, "neither")
        self.assertEqual(style.limits(values).extend, "neither")
        both = style.limits(np.concatenate([values, [-100]]), clip=True)
        self.assertEqual(both.extend, "both")

    def test_pressure_at_the_start(self):
        surface = read.Surface(np.array([[0.0, 0, 0], [0, -2, 0], [1, -4, 0]]), [np.array([0, 1]), np.array([1, 2])], {}, {})
        self.assertTrue(np.allclose(flow.at_start("1e5 - 9.81e3*y", surface), [1e5 + 9.81e3, 1e5 + 3 * 9.81e3]))
        self.assertTrue(np.allclose(flow.at_start("2.5E7", surface), 2.5e7))
        for unknown in ("table(t)", "p0", "__import__('os')", "1/0", "xy"):
            self.assertIsNone(flow.at_start(unknown, surface))

    def test_times(self):
        self.assertEqual([style.when(t) for t in (2.0, 600.0, 7200.0, 30 * 86400.0)], ["t = 2 s", "t = 10 min", "t = 2 h", "t = 30 d"])
        self.assertEqual(style.when(43200.0, (86400.0, "d")), "t = 0.5 d")
        self.assertTrue(np.allclose(series.injected(np.array([2.0, 3]), np.array([5.0, 7]), 1.0), [5, 12]))

    def test_time_of_a_picture(self):
        """A time without unit has the unit of the scene."""
        for text, clock, exact in (("5 h", None, 18000), ("5h", (60.0, "min"), 18000), ("2.5e1", None, 25), ("1e-3", (3600.0, "h"), 3.6), ("1 year", None, 31557600)):
            self.assertAlmostEqual(plot_seconds(text, clock), exact)
        for text in ("", "h", "5 weeks", "nan", "1 2", "inf s"):
            with self.assertRaisesRegex(read.PlotError, "--time: is"):
                plot_seconds(text, None)

    def test_colours_of_fractures(self):
        """A fracture has one colour in all panels, another fracture a different one. Round-off has no panel."""
        def step(time, slip, opening, pressure):
            return {"time": time, "single_fractures": {"max_slip": slip, "mean_opening": opening, "mean_fracture_pressure": pressure}}

        zero, up = [0.0] * 8, [1e-3 * k for k in range(8)]  # the first six change least in slip and most in pressure
        steps = [step(1.0, zero, zero, zero), step(2.0, up, [1e-20 * k for k in range(8)], [1e9 * (1e-2 - x) for x in up])]
        axes = series.of_run(steps, list("abcdefgh"), "run").axes
        self.assertEqual([ax.get_ylabel() for ax in axes], ["largest slip (mm)", "mean pressure in fractures (MPa)"])
        slip, pressure = ({line.get_label(): (line.get_color(), line.get_marker()) for line in ax.lines if len(line.get_label()) == 1} for ax in axes)
        self.assertEqual((set(slip), set(pressure)), (set("cdefgh"), set("abcdef")))
        both = set(slip) & set(pressure)
        self.assertEqual({name: slip[name] for name in both}, {name: pressure[name] for name in both})
        self.assertEqual(len(set((slip | pressure).values())), 8)

    def test_slip_rates(self):
        """Profiles at increments of the largest slip, in the colour of events by the rate; friction of closed steps."""
        path = self.folder / "line.csv"
        slips, speeds = (0, 0.2, 0.201, 1), (1e-9, 1e-9, 1e-9, 1e-2)
        path.write_text("time [s],distance [m],x [m],slip [m],slip rate [m/s]\n" + "".join(
            f"{t},{x},{x},{slip * (2 - x) / 2},{speed}\n" for t, (slip, speed) in enumerate(zip(slips, speeds)) for x in (0, 1, 2)))
        ((name, figure),) = rates.of_probe(path)
        lines = figure.axes[0].lines
        self.assertEqual((name, [line.get_color() for line in lines]), ("profiles_line", [style.LINES[0]] * 2 + [style.LINES[3]]))
        self.assertTrue(np.allclose([line.get_ydata() for line in lines], [[0, 0, 0], [0.2, 0.1, 0], [1, 0.5, 0]]))
        path.write_text("time [s],slip rate [m/s],traction local n [Pa],traction local t1 [Pa],traction local t2 [Pa]\n"
                        "0,1e-9,-10,3,4\n1,1e-8,0,0,0\n2,1e-7,-10,0,6\n")
        ((name, figure),) = rates.of_probe(path)
        (line,) = figure.axes[0].lines
        self.assertEqual(name, "phase_line")
        self.assertTrue(np.allclose(line.get_xydata(), [[1e-9, 0.5], [1e-7, 0.6]]))
        path.write_text("time [s],slip rate [m/s],traction local n [Pa],traction local t [Pa]\n0,1e-9,-10,-4\n")
        ((_, figure),) = rates.of_probe(path)
        self.assertTrue(np.allclose(figure.axes[0].lines[0].get_xydata(), [[1e-9, 0.4]]))
        path.write_text("time [s],pressure [Pa]\n0,1\n")
        self.assertEqual(list(rates.of_probe(path)), [])

    def test_probes(self):
        path = self.folder / "gauge.csv"
        path.write_text("time [d],pressure [Pa],mean slip [m],maximum slip [m]\n1,2e6,1e-3,2e-3\n2,3e6,2e-3,5e-3\n")
        axes = series.of_probe(path).axes
        self.assertEqual([ax.get_ylabel() for ax in axes], ["pressure (MPa)", "slip (mm)"])
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

    def test_labels_of_probes(self):
        """The label has the words that all names have in common, or the names, and the unit as in other pictures."""
        path = self.folder / "gauge.csv"
        for titles, label in (("rate [m^2/s],rate in rock [m^2/s]", "rate (m²/s)"), ("rate [m^3/s],loss [m^3/s]", "rate, loss (m³/s)"),
                              ("a [N*m],b [N*m],c [N*m],d [N*m]", "a, b, c, ... (N m)"), ("leaked volume [m^3]", "leaked volume (m³)")):
            n = titles.count(",") + 1
            path.write_text(f"time [s],{titles}\n0{n * ',1'}\n1{n * ',2'}\n")
            self.assertEqual([ax.get_ylabel() for ax in series.of_probe(path).axes], [label])

    def test_level_after_the_first_step(self):
        """The axis of a pressure that rises at once shows the later values; that of a ramp starts at the first value."""
        path = self.folder / "gauge.csv"
        for values, low in (((0, 12, 10.4, 10.2), 10), ((0, 4, 8, 12), None)):
            path.write_text("time [s],pressure [Pa]\n" + "".join(f"{t},{p}e6\n" for t, p in enumerate(values)))
            (ax,) = series.of_probe(path).axes
            notes = [text.get_text() for text in ax.texts]
            self.assertEqual((ax.get_ylim()[0] > 10, notes), (low is not None, ["starts at 0, outside"] if low else []))
        path.write_text("time [s],distance [m],pressure [Pa]\n" + "".join(f"1,{x},{p}e6\n" for x, p in enumerate((0, 12, 10.4, 10.2))))
        self.assertLess(series.of_probe(path).axes[0].get_ylim()[0], 0)

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

    def test_names_are_in_the_order_of_their_numbers(self):
        self.assertEqual(sorted(["10", "2", "1", "b 3", "b 12", "a"], key=style.natural), ["1", "2", "10", "a", "b 3", "b 12"])

    def test_range_of_changes_of_pressure(self):
        """From zero on for a rise, with an arrow for smaller falls; around zero where both are alike, or for a fall."""
        for values, low, high, extend in ([0, 4], 0, 4, "neither"), ([-1, 4], 0, 4, "min"), ([-3, 4], -4, 4, "neither"), ([-4, 0], -4, 4, "neither"):
            norm, _ = overview.range_of_change(np.array(values, dtype=float))
            self.assertEqual((norm.vmin, norm.vmax, norm.extend), (low, high, extend))

    def test_thin_bodies_are_drawn_wide(self):
        """Panels of thin bodies are in a column without empty space, those of square bodies in a row."""
        strip, square = np.array([[0.0, 0], [30, 1]]), np.array([[0.0, 0], [1, 1]])
        for points, rows in ((strip, 3), (square, 1)):
            figure, axes, where = style.panels_of_plane(3, points)
            self.assertEqual(len(figure.axes), 3)
            self.assertEqual(figure.axes[0].get_gridspec().nrows, rows)
            self.assertEqual(bool(where), rows == 3)
            self.assertLess(150 * figure.get_size_inches()[0], 2000)  # dots at the default resolution

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


if __name__ == "__main__":
    main()
