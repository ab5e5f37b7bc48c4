#!/usr/bin/env python3
"""Measurement perf/growth: perf_growth_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy or SciPy.

Limits of the similarity solutions, the rule for the strength, and the errors of a coarse run."""
import math
import statistics
import sys
import unittest.mock

import program
from program import ProgramTest, main

try:
    import scipy  # noqa: F401
    from perf.common import options as common
    from perf.growth import exact, growth, radial, similarity
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


class Growth(ProgramTest):
    def fracture(self, toughness):
        return exact.Fracture(toughness, growth.PLANE, growth.ENERGY, growth.LENGTH, growth.END)

    def test_similarity_solutions_have_the_limits_of_toughness_and_viscosity(self):
        for toughness, tolerance in ((4, 0.02), (6, 4e-3)):  # deviations of the asymptotic expansion
            known, K = self.fracture(toughness), math.sqrt(growth.ENERGY * growth.PLANE)
            length, opening, pressure = known.at(growth.END)
            self.assertAlmostEqual(length, growth.LENGTH, places=5)
            sharp = (growth.PLANE * known.rate * growth.END / (2 * math.sqrt(math.pi) * K)) ** (2 / 3)
            self.assertAlmostEqual(length / sharp, 1, delta=tolerance)
            self.assertAlmostEqual(opening / (4 * K * math.sqrt(length / math.pi) / growth.PLANE), 1, delta=5 * tolerance)
            self.assertAlmostEqual(pressure / (K / math.sqrt(math.pi * length)), 1, delta=15 * tolerance)
        nearly_viscous = exact.VALUES[0.25]
        for value, zero in zip(nearly_viscous, (0.6154113, 1.1258346, 0.544817)):  # Kd = 0
            self.assertAlmostEqual(value / zero, 1, delta=5e-4)

    def test_reference_values_follow_from_their_integral_equations(self):
        for value, known in zip(similarity.similarity(1, at_tip=36), exact.VALUES[1]):
            self.assertAlmostEqual(value / known, 1, delta=5e-6)
        behind, zone, opening, K = similarity.lag(100)
        self.assertAlmostEqual(behind, growth.LAG, delta=6e-4)
        self.assertAlmostEqual(opening, growth.SOFTENED, delta=1e-3)
        self.assertAlmostEqual(2 * K**2, 1, delta=1e-3)  # K^2 = E' G

    def test_circular_fractures_have_the_values_of_their_integral_equations_and_the_limit_of_toughness(self):
        for value, known in zip(radial.circles((0.5,), at_tip=30, step=1)[0], exact.CIRCLES[0.5]):
            self.assertAlmostEqual(value / known, 1, delta=2e-5)
        known, K = exact.Circle(5, growth.PLANE, growth.ENERGY, 10.0, 100.0), math.sqrt(growth.ENERGY * growth.PLANE)
        radius, opening = known.at(100.0)
        self.assertAlmostEqual(radius, 10)
        sharp = (3 * growth.PLANE * known.rate * 100 / (8 * math.sqrt(math.pi) * K)) ** 0.4
        self.assertAlmostEqual(radius / sharp, 1, delta=4e-3)
        self.assertAlmostEqual(opening / (4 * K * math.sqrt(radius / math.pi) / growth.PLANE), 1, delta=0.02)
        self.assertAlmostEqual(growth.ENERGY * growth.PLANE * 32 / math.pi / known.K**2, 1)

    def test_the_balance_with_leak_off_has_the_limits_of_toughness_and_leak_off(self):
        x, s = exact.march(200, 1e-4)
        self.assertAlmostEqual(s[-1] / x[-1] ** 1.5, 1, delta=0.2)
        x, s = exact.march(200, 1e4)
        self.assertAlmostEqual(s[-1] / (math.pi * x[-1] / 2) ** 2, 1, delta=0.01)
        known = exact.Leaking(1, growth.PLANE, growth.ENERGY, growth.LENGTH, growth.END)
        length, opening, pressure = known.at(growth.END)
        self.assertAlmostEqual(length, growth.LENGTH)
        volume = math.pi / 2 * length * opening  # of the ellipse
        self.assertAlmostEqual(volume / (known.rate * growth.END), 0.24265, delta=1e-4)  # independent solution

    def test_viscosity_reduces_the_strength_and_toughness_alone_has_a_zone_of_three_faces(self):
        for toughness in exact.VALUES:
            known, size = self.fracture(toughness), 1e-5 if toughness > 2 else 1
            strength = 2 * growth.ENERGY / (growth.SOFTENED * known.tip_opening(growth.ZONE * size))
            zone = 0.914 * 0.8 * growth.PLANE * growth.ENERGY / strength**2  # of a bond under toughness alone
            if toughness > 2:
                self.assertAlmostEqual(zone / (growth.ZONE * size), 1, delta=0.02)
            else:
                self.assertGreater(zone, 1.1 * growth.ZONE * size)

    def test_a_coarse_mesh_grows_as_the_exact_fracture(self):
        self.assertEqual(growth.main(["--quick", "--output", str(self.folder), "--binary", str(program.PROGRAM)]), 0)

    def test_a_sector_grows_as_the_circular_fracture(self):
        options = common.parser("growth", "").parse_args(["--output", str(self.folder), "--binary", str(program.PROGRAM)])
        row = growth.circle(options, 0.5, 20)
        for error, bound in zip(row.errors, (0.025, 0.03)):
            self.assertLess(abs(error), bound)
        self.assertLessEqual(statistics.median(row.newton), 6)

    def test_steps_in_which_a_face_opens_take_few_iterations(self):
        options = common.parser("growth", "").parse_args(["--output", str(self.folder), "--binary", str(program.PROGRAM)])
        with unittest.mock.patch.object(growth, "STEPS", {1: 0.0}):
            row = growth.plane(options, 1, 20)
        self.assertLessEqual(statistics.median(row.newton), 7)
        self.assertLess(abs(row.errors[0]), 0.03)


if __name__ == "__main__":
    main()
