#!/usr/bin/env python3
"""Measurement perf/contact: perf_contact_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy or VTK.

Correct runs have no violations. States with known errors have the corresponding violations."""
import copy
import subprocess
import sys
from pathlib import Path

import program
from program import ROOT, ProgramTest, main

try:
    import numpy as np
    import violation
    from perf.contact import exact
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


class Violation(ProgramTest):
    def steps(self, name, *overrides):
        """Returns pairs of consecutive steps; also sets the scales."""
        results = self.run_scene(name, *overrides)
        self.input = violation.Input(self.folder / "out/effective_input.xml")
        steps, self.scales, worst, skipped = violation.largest(self.folder / "out", results, self.input)
        self.assertLess(worst.max(), 1e-10)
        self.assertEqual(skipped, sum(step["substeps"] > 1 for step in results["steps"]))
        return steps

    def parts(self, step, before, **changes):
        """Returns the violations after replacement of some arrays."""
        step = copy.deepcopy(step)
        for name, value in changes.items():
            getattr(step, name)[:] = value
        return dict(zip(violation.PARTS, violation.violation(step, before, self.scales)))

    def test_a_wrong_state_is_seen_by_the_part_that_it_violates(self):
        stick, slip, opened, _ = self.steps("contact/all_change_3d.xml")
        length, traction = self.scales.length, self.scales.traction
        self.assertAlmostEqual(length, np.hypot(0.5, 0.1), places=12)  # of the top, in the step with slip
        deeper = self.parts(slip, stick, distance=slip.distance - 0.01)
        self.assertAlmostEqual(deeper["penetration"], 0.01 / length)
        gap = self.parts(slip, stick, distance=slip.distance + 0.01)
        self.assertAlmostEqual(gap["gap under load"], 0.01 / length)
        pulled = self.parts(opened, slip, traction=opened.traction + [0.01, 0, 0])
        self.assertAlmostEqual(pulled["tension"], 0.01 / traction)
        steep = self.parts(slip, stick, bound=slip.bound - 0.01)
        self.assertAlmostEqual(steep["beyond friction"], 0.01 / traction)
        self.assertAlmostEqual(self.parts(slip, stick, bound=slip.bound + 0.01)["direction"], 0.01 / traction)
        sideways = self.parts(slip, stick, plastic=slip.plastic + [0, 0.01, 0])
        self.assertAlmostEqual(sideways["direction"], 0.01 / length)
        backward = self.parts(slip, stick, plastic=2 * stick.plastic - slip.plastic)
        self.assertGreater(backward["direction"], 0.1)
        crept = self.parts(stick, stick, plastic=stick.plastic + [0, 0, 0.01])
        self.assertAlmostEqual(crept["direction"], 0.01 / length)

    def test_faces_that_touch_without_load_may_come_from_anywhere(self):
        stick, slip, *_ = self.steps("contact/all_change_3d.xml")
        for state in (violation.STICK, violation.SLIP):
            for share, expected in ((0, 0), (1e-3, 1e-3)):
                traction = share * self.scales.traction * np.array([[-1, 1, 0]])
                light = self.parts(slip, stick, state=state, traction=traction, bound=traction[0, 1], plastic=stick.plastic + [0, 0, 0.1])
                self.assertAlmostEqual(light["direction"], expected)

    def test_the_law_is_that_of_the_input(self):
        steps = self.steps("contact/all_change_2d.xml")
        joint, slip = self.input.joints[0], steps[1]
        p, N = abs(slip.plastic[0, 1]), -slip.traction[0, 0]
        self.assertAlmostEqual(joint.closed_gap(p, -N), 0.01 + np.tan(np.radians(10)) * p - 0.1 * N / (0.5 + N), places=14)
        self.assertTrue(np.allclose(slip.bound, 0.6 * N, rtol=1e-14))

    def law(self, entries, **kinds):
        return violation.JointLaw(lambda name, default: entries.get(name, default), lambda role: kinds.get(role) or violation.FIRST_KINDS[role])

    def faces(self, load, slip=0.0, **reported):
        """Returns one face under compression with slip."""
        row = np.array([[-load, 0.0]])
        return violation.Faces(1, row, np.zeros(1), np.array([2]), row, np.array([[0.0, slip]]), row, np.zeros(1),
                               {name.replace("_", " "): np.array([value]) for name, value in reported.items()})

    def test_laws_at_known_values(self):
        rough = {"joint roughness coefficient": 10, "joint wall strength": 100e6, "residual friction angle": 30, "joint length": 0.1,
                 "sample length": 0.1}
        mobilised = self.law(rough, friction="mobilised Barton-Choubey")
        self.assertAlmostEqual(mobilised.peak_slip, 0.9141763792e-3, places=12)
        for over, tau in ((0.15, .2679491924), (0.45, .7673269880), (0.8, 1.0913085011), (1.5, 1.1302943864), (50, .7147570420)):
            faces = self.faces(1e6, accumulated_slip=over * mobilised.peak_slip)
            self.assertAlmostEqual(mobilised.bound(faces)[0] / 1e6, tau, places=9)
        composed = self.law({"basic friction coefficient": 0.5, "asperity angle": np.degrees(0.05),
                             "asperity friction coefficient": 0.3, "transition stress": 40e6, "transition exponent": 1.5,
                             "residual part of friction": 0.3, "residual part of dilation": 0.6, "damage length of friction": 1,
                             "damage length of dilation": 1}, friction="composed", damage="isotropic")
        for over, worn, mu in ((.15, 0, .6149016982), (.15, .7, .5818025154), (.4, 2.5, .5759320923), (.8, .7, .6813819466)):
            self.assertAlmostEqual(composed.bound(self.faces(over * 40e6, damage_history=worn))[0] / (over * 40e6), mu, places=9)
        bandis = self.law({"joint roughness coefficient": 10, "joint wall strength": 100e6, "joint aperture": 0.2e-3}, closure="Bandis")
        for load, closed in ((1e6, .036158318), (5e6, .087903172), (20e6, .120139547)):
            self.assertAlmostEqual(-1e3 * bandis.closed_gap(self.faces(load))[0], closed, places=8)
        weak = self.law({"friction coefficient": 0.6, "residual friction coefficient": 0.4, "weakening distance": 0.2},
                        friction="slip weakening")
        self.assertAlmostEqual(weak.bound(self.faces(0.3, accumulated_slip=0.1))[0], 0.15, places=14)

    def test_a_wrong_history_is_seen(self):
        steps = self.steps("contact/damage_turns_3d.xml", "Time.end=20", "Time.steps=20")
        worn, before = steps[-1], steps[-2]
        path = []
        for step, start in zip(steps, [violation.Faces.at_rest(steps[0]), *steps]):
            path.append(violation._segment(step, start, self.input.laws, path))

        def history(step):
            return dict(zip(violation.PARTS, violation.violation(step, before, self.scales, self.input.laws, path)))["history"]
        self.assertGreater(worn.history["damage history"].min(), 0.1)
        self.assertLess(history(worn), 1e-10)
        worn.history["damage history"] += 0.01
        self.assertAlmostEqual(history(worn), 0.01 / self.scales.length, places=4)
        worn.history["damage history"] -= 0.01
        worn.plastic[:, 1:] += 0.001  # a slip increment without a history
        self.assertGreater(history(worn), 1e-4 / self.scales.length)

    def test_open_faces_wear_only_where_they_touch(self):
        law = self.law({"friction coefficient": 0.6, "dilation angle": 10, "residual part of dilation": 0.3,
                        "damage length of dilation": 5e-3}, damage="isotropic")
        before = self.faces(0, 1e-3, damage_history=1e-3)

        def wrong(worn, apart):
            face = self.faces(0, 4e-3, damage_history=worn)
            face.state, face.traction = np.array([violation.OPEN]), np.zeros((1, 2))
            face.jump = np.array([[law.closed_gap(face)[0] + apart, 4e-3]])
            return law.wrong_histories(face, before, None)[0]
        for worn, apart, expected in ((2e-3, 0, 0), (4e-3, 0, 0), (5e-3, 0, 1e-3), (2e-3, 1e-5, 1e-3), (1e-3, 1e-5, 0)):
            self.assertAlmostEqual(wrong(worn, apart), expected, places=14, msg=(worn, apart))

    def test_states_that_differ(self):
        one = self.steps("contact/all_change_2d.xml")
        other = copy.deepcopy(one)
        self.assertEqual(violation.differing(one, other, self.scales), [])
        other[1].state[0] = violation.STICK  # at a sliding face: near the limit
        (found,) = violation.differing(one, other, self.scales)
        self.assertEqual((found[0], found[2], found[4]), (2.0, (violation.SLIP, violation.STICK), True))
        other[0].state[1] = violation.SLIP  # at a sticking face: far from it
        self.assertEqual([near for *_, near in violation.differing(one, other, self.scales)], [False, True])

    def test_exact_column(self):
        """Solution for a block with closure and dilation, H = G = lambda = 1, compared with results of 60 digits."""
        class R1:
            stiffness, friction, dilation, gap, closure, normal_stiffness = 2, 0.6, np.tan(np.radians(10)), 0.01, 0.1, 5
            closed_gap = violation.Joint.closed_gap
        rock = {"G": 1, "lam": 1}
        for d, slipped, row in (((0.2, 0.2), 0, (0, 0, 0, 0.2, 0.2)),
                                ((0.05, -0.1), 0, (1, 0.033333333333, -0.234281365494, 0, -0.021906211502)),
                                ((0.5, -0.1), 0, (2, 0.193791423668, -0.322985706114, 0.209312864497, 0.007661902038)),
                                ((0.3, 0.05), 0, (2, 0.011301447522, -0.018835745870, 0.283047828717, 0.056278581957)),
                                ((0.35, -0.1), 0.209312864497, (1, 0.093791423668, -0.322985706114, 0.209312864497, 0.007661902038))):
            self.assertTrue(np.allclose(exact.column(R1(), rock, 1, *d, slipped), row, rtol=0, atol=2e-12), (d, row))
        # a fluid pressure p with k_n = 3 has the same effect as a top displacement larger by p/k_n
        for p, row in ((0.05, (1, 0.1, -0.195631429996, 0, -0.018122856668)),
                       (0.2, (2, 0.063729626370, -0.106216043949, 0.054405560446, 0.002072014650)),
                       (0.45, (0, 0, 0, 0.15, 0.05))):
            self.assertTrue(np.allclose(exact.column(R1(), rock, 1, 0.15, -0.1 + p / 3, 0), row, rtol=0, atol=2e-12), (p, row))

    def test_fluid_pressure_is_in_the_scale(self):
        """An open fracture has no contact traction. The scale includes the fluid pressure."""
        open_faces, = self.steps("contact/block_2d.xml", "Fractures.fracture.fluid pressure=2*y")
        self.assertEqual(set(open_faces.state), {violation.OPEN})
        self.assertTrue(np.allclose(open_faces.pressure, 1))
        self.assertAlmostEqual(self.scales.traction, 1)


class Table(ProgramTest):
    def contact(self, *words, expect):
        done = subprocess.run([sys.executable, "-B", ROOT / "perf", "contact", "--binary", program.PROGRAM, "--output",
                               self.folder / "out", *words], cwd=self.folder, capture_output=True, text=True,
                              timeout=program.TIME_LIMIT)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout.splitlines()

    def test_lines_and_files(self):
        lines = self.contact("--only", "^(block 2D (injection|K_t=1e12)|seed pull 2D)$", "--ranks", "2", expect=0)
        self.assertEqual([line.split()[:3] for line in lines[:4]],
                         [["scene", "dim", "unknowns"], ["seed", "pull", "2D"], ["block", "2D", "injection"], ["block", "2D", "K_t=1e12"]])
        self.assertRegex(lines[-1], r"^failures=0 median=\S+ p90=\d+ max=\d+ worst_violation=\S+e-\d+$")
        self.assertEqual(len((self.folder / "out/contact.csv").read_text().splitlines()), 4)
        self.assertTrue((self.folder / "out/contact.png").is_file())
        self.assertTrue(Path(self.folder / "out/block_2D_K_t_1e12/2/results.json").is_file())


if __name__ == "__main__":
    main()
