#!/usr/bin/env python3
"""Fits of joints to curves: fit_test.py PROGRAM ROOT MPIEXEC

Requires SciPy and matplotlib. If one is missing, the status is 77, for ctest's "skipped"."""
import contextlib
import csv
import importlib.util
import io
import sys
import unittest
from types import SimpleNamespace

import program
from program import ROOT, ProgramTest, main

MISSING = [name for name in ("matplotlib", "numpy", "scipy") if importlib.util.find_spec(name) is None]
if MISSING:
    print(f"skipped: {sys.executable} has no {', '.join(MISSING)}")
    sys.exit(77)

sys.path.insert(0, str(ROOT / "apps" / "fit"))
spec = importlib.util.spec_from_file_location("sprekk_fit", ROOT / "apps" / "fit" / "__main__.py")
fit = importlib.util.module_from_spec(spec)
spec.loader.exec_module(fit)

import numpy as np  # noqa: E402
import picture  # noqa: E402
import point  # noqa: E402
import units  # noqa: E402
from estimate import Parameter, fit as least_squares  # noqa: E402

SHEAR = "point/direct_shear.xml"
TRUE = {"joint roughness coefficient": 8.9, "residual friction angle": 27.5}
ALONG, STRESS = ["--along", "slip=jump_t"], ["--match", "shear stress=traction_t"]
BOTH = [word for name in TRUE for word in ("--parameter", name)]


class Estimates(unittest.TestCase):
    """Least squares without the program, for y = a exp(-b x) + c."""
    x = np.linspace(0, 4, 30)

    def estimate(self, seed, noise):
        y = 2e9 * np.exp(-0.7 * self.x) + 1e9 + noise * np.random.default_rng(seed).normal(size=30)
        return least_squares(lambda v: (v[0] * np.exp(-v[1] * self.x) + v[2] - y) / 1e9,
                             [Parameter("a", 1e9, 0), Parameter("b", 1, 0.01, 10), Parameter("c", 5e8)])

    def test_known_parameters_without_noise(self):
        for value, true in zip(self.estimate(0, 0).values, (2e9, 0.7, 1e9)):
            self.assertAlmostEqual(value / true, 1, delta=1e-9)

    def test_intervals_hold_the_truth_in_95_of_100(self):
        hits, n = np.zeros(3), 400
        for seed in range(n):
            intervals = self.estimate(seed, 5e7).intervals
            hits += [low <= true <= high for (low, high), true in zip(intervals, (2e9, 0.7, 1e9))]
        for share in hits / n:  # 0.95 with a standard deviation of 0.011
            self.assertTrue(0.915 <= share <= 0.985, hits / n)

    def test_what_the_data_do_not_determine_has_no_interval(self):
        y = 6 * self.x + 0.1 * np.random.default_rng(1).normal(size=30)
        found = least_squares(lambda v: v[0] * v[1] * self.x + 0 * v[2] - y,
                              [Parameter("a", 1, 0), Parameter("b", 1, 0), Parameter("unused", 1)])
        self.assertEqual(found.intervals, [None] * 3)
        self.assertAlmostEqual(found.values[0] * found.values[1], 6, delta=0.1)

    def test_a_parameter_at_its_bound_has_no_interval(self):
        y = 6 * self.x + 0.1 * np.random.default_rng(1).normal(size=30)
        found = least_squares(lambda v: v[0] * self.x - y, [Parameter("a", 1, 0, 5)])
        self.assertAlmostEqual(found.values[0], 5, delta=1e-6)
        self.assertEqual(found.why, ["at its bound"])

    def test_where_the_model_has_no_state_steps_are_shorter(self):
        found = least_squares(lambda v: (np.sqrt(v[0]) if v[0] < 3 else np.nan) * self.x - 1.7 * self.x,
                              [Parameter("a", 0.01, -5, 50)])
        self.assertAlmostEqual(found.values[0], 1.7**2, delta=1e-6)

    def test_units_and_bounds(self):
        self.assertAlmostEqual(units.number("30 deg", "rad"), np.pi / 6)
        self.assertAlmostEqual(units.number("120 GPa/m", "Pa/m"), 1.2e11, delta=1)
        self.assertAlmostEqual(units.number("50 J/m^2", "J/m^2"), 50)
        self.assertAlmostEqual(units.number("1 MPa/mm", "Pa/m"), 1e9, delta=1e-3)
        for text in ("2*x", "30 deg of it", "3 kPa"):
            self.assertIsNone(units.number(text, "m"))
        self.assertEqual(point.bounds("between 0 and 1"), (0, 1))
        low, high = point.bounds("at least 0 and less than 90")
        self.assertTrue(low == 0 and 89.99 < high < 90)
        self.assertEqual(point.bounds("positive"), (0, np.inf))


class Fits(ProgramTest):
    def measured(self, noise):
        """Writes the curve for known parameters with normal errors, in parts of 1 MPa and 1 mm."""
        sets = [word for name, value in TRUE.items() for word in ("--set", f"Materials.joint.{name}={value}")]
        out, _ = self.call("point", self.scene(SHEAR), *sets)
        random = np.random.default_rng(7)
        lines = ["slip (mm),shear stress (MPa),normal stress (kPa),normal displacement (um)"]
        for row in list(csv.DictReader(out.splitlines()))[1::3]:
            e = noise * random.normal(size=3)
            lines.append(f"{1e3 * float(row['jump_t']):.12g},{float(row['traction_t']) / 1e6 + e[0]:.12g},"
                         f"{-float(row['traction_n']) / 1e3 + 1e3 * e[1]:.12g},{1e6 * float(row['jump_n']) + 20 + 1e3 * e[2]:.12g}")
        path = self.folder / "curve.csv"
        path.write_text("\n".join(lines) + "\n")
        return path

    def fit(self, *words, expect=0, scene=SHEAR):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = fit.main([str(words[0]), str(self.scene(scene)), *words[1:], "--program", str(program.PROGRAM)])
        self.assertEqual(status, expect, out.getvalue() + err.getvalue())
        return out.getvalue() if expect == 0 else err.getvalue()

    def reported(self, text):
        """Returns {name: (value, low, high)} of the output."""
        lines = [line for line in text.splitlines() if "95 %:" in line]
        found = {}
        for name in TRUE:
            words = next(line for line in lines if line.startswith(name))[len(name):].split()
            found[name] = float(words[0]), float(words[-3]), float(words[-1])
        return found

    def test_the_curve_of_known_parameters_gives_them_back(self):
        path = self.measured(0)
        for name, (value, _, _) in self.reported(self.fit(path, *ALONG, *STRESS, *BOTH)).items():
            self.assertAlmostEqual(value / TRUE[name], 1, delta=1e-6)
        self.assertTrue((self.folder / "curve_fit.png").is_file())

    def test_with_noise_intervals_of_twice_the_width_hold_them(self):
        """Intervals of twice the width contain the parameters.

        A random sample violates this with a probability of 1/15000.

        A 95 % interval fails in one of twenty samples, as tested by the class Estimates."""
        path = self.measured(0.02)
        widths = []
        more = ["--match", "normal stress=-traction_n", "--match", "normal displacement=change of jump_n"]
        for matched in (STRESS, STRESS + more):
            reported = self.reported(self.fit(path, *ALONG, *matched, *BOTH))
            for name, (value, low, high) in reported.items():
                self.assertTrue(low < value < high)
                self.assertTrue(2 * low - value <= TRUE[name] <= 2 * high - value, reported)
            widths.append(reported["joint roughness coefficient"][2] - reported["joint roughness coefficient"][1])
        self.assertLess(widths[1], widths[0])  # more columns reduce the interval
        self.assertLess(widths[0], 2)

    def test_rows_beyond_until_are_predicted(self):
        text = self.fit(self.measured(0), *ALONG, *STRESS, *BOTH, "--until", "5")
        self.assertIn("rows fitted", text)
        predicted = next(line for line in text.splitlines() if "rows predicted" in line)
        self.assertEqual(predicted.split(",")[1].split()[0], "13")  # rows from 5.2 to 8.8 mm
        self.assertLess(float(predicted.partition("difference ")[2].split()[0]), 10)  # Pa

    def test_the_picture_has_both_curves(self):
        columns = {"t": np.array([0., 1, 2]), "traction_t": np.array([0., 1e6, 2e6])}
        pair = SimpleNamespace(name="shear stress", output="traction_t", sign=1, values=np.array([0.1e6, 1.1e6, 2.1e6]),
                               computed=lambda curve: curve["traction_t"])
        along = SimpleNamespace(name="stage", output="t", sign=1, values=np.array([0., 1, 2]), computed=lambda curve: curve["t"])
        rows, later = np.array([True, True, False]), np.array([False, False, True])
        figure = picture.of_fit(SimpleNamespace(along=along, matched=[pair], rows=[rows], later=[later]), columns, "test")
        drawn = {line.get_label(): line.get_ydata().tolist() for line in figure.axes[0].lines}
        self.assertEqual(drawn, {"measured, fitted": [0.1, 1.1], "measured, predicted": [2.1], "computed": [0, 1, 2]})
        self.assertEqual(figure.axes[0].get_ylabel(), "shear stress (MPa)")

    def test_what_is_wrong_is_named(self):
        path = self.measured(0)
        bare, short = self.folder / "bare.csv", self.folder / "short.csv"
        bare.write_text("slip,shear stress (MPa)\n0,1\n1,2\n")
        short.write_text("slip (mm),shear stress (MPa)\n0,1\n1,x\n")
        one = BOTH[:2]
        for words, expected in (
                ((path, *ALONG, *STRESS, "--parameter", "residual friction angel"), 'Did you mean "residual friction angle"?'),
                ((path, *ALONG, *STRESS, "--parameter", "residual friction angle=10..95"), "must be at least 0 and less than 90"),
                ((path, *ALONG, *STRESS, "--parameter", "residual friction angle=30..20"), "LOW below HIGH"),
                ((path, *ALONG, *STRESS, "--parameter", "peak slip"), "no number to start from"),
                ((path, "--along", "slop=jump_t", *STRESS, *one), 'has no column "slop", its columns are: "slip"'),
                ((path, "--along", "slip=traction_t", *STRESS, *one), "its unit does not match traction_t"),
                ((path, "--along", "slip=jump_x", *STRESS, *one), 'no output "jump_x"'),
                ((path, *ALONG, *STRESS, *one, "--set", "Time.end=20"), '"slip" spans 0.0001 to'),
                ((path, *ALONG, *STRESS, *one, "--set", "Materials.joint.dilation=none"), 'Materials > joint > "dilation"'),
                ((bare, *ALONG, *STRESS, *one), 'bare.csv: line 1: column "slip" has no unit'),
                ((short, *ALONG, *STRESS, *one), 'short.csv: line 3: "x" in column "shear stress" is not a number'),
                ((self.folder / "none.csv", *ALONG, *STRESS, *one), "none.csv: cannot be read")):
            with self.subTest(expected=expected):
                self.assertIn(expected, self.fit(*words, expect=1))
        self.assertIn("is not a scene of the point driver", self.fit(path, *ALONG, *STRESS, *one, expect=1, scene="seed/push_2d.xml"))


if __name__ == "__main__":
    main()
