#!/usr/bin/env python3
"""Growing fractures that meet other fractures: crossing_test.py PROGRAM ROOT MPIEXEC"""

import math
from unittest import mock

from program import ProgramTest, main
from growth_test import Growth
from perf.paths import crossing

INJECTION = Growth.INJECTION
del Growth


class Crossing(ProgramTest):
    def case(self, name, *entries, ranks=1):
        """Runs a case of `perf paths`; checks its outcome, and the margin at the given far stresses."""
        *stresses, crosses = crossing.CASES[name]
        scene = crossing.write_scene(self.folder / name, name)
        step, = self.run_scene(scene, "Output.vtu=false", *entries, ranks=ranks)["steps"]
        met = crossing.meeting([step])
        self.assertEqual(met["state"], "crosses" if crosses else "ends at")
        self.assertEqual((met["fracture"], met["met"]), ("crack", "fault"))
        self.assertAlmostEqual(met["margin"], crossing.exact_margin(*stresses), delta=0.03)
        return step, met

    def test_a_crack_that_crosses(self):
        """The crack continues beyond; the fracture is complete."""
        step, _ = self.case("a3")
        x = max(step["stress_intensity"]["x"])
        self.assertGreater(x, crossing.MEETING + 0.9 * crossing.SEGMENT)
        self.assertAlmostEqual(step["fractures"]["crack"]["area"], x + crossing.HALF, delta=0.02)
        self.assertAlmostEqual(step["fractures"]["fault"]["area"], 2, delta=1e-9)
        self.assertAlmostEqual(step["stress_intensity"]["y"][step["stress_intensity"]["x"].index(x)], 0, delta=0.02)

    def test_a_crack_that_ends(self):
        step, _ = self.case("a2")
        self.assertLess(max(step["stress_intensity"]["x"]), 0)  # no tip at the right
        self.assertAlmostEqual(step["fractures"]["crack"]["area"], crossing.MEETING + crossing.HALF, delta=0.02)

    def test_all_angles(self):
        """The outcomes that both readings of the criterion share."""
        for name in crossing.CASES:
            with self.subTest(name):
                self.case(name)

    def test_large_deviatoric_stress(self):
        """A small kink loads an extension in shear by far more than the net pressure opens it. The path remains straight, also beyond the fracture."""
        with mock.patch.dict(crossing.CASES, {"high": (90, -30, -5, 4, 0.6, 0, True)}):
            scene = crossing.write_scene(self.folder / "high", "high")
        sets = ["Output.vtu=false", "Fractures.crack.toughness=abs(x - 1) > 1.85 ? 1e9 : 1e6*(1 + 0.15*(x - 2))"]
        errors = self.call("run", scene, "--output", "out", *(word for one in sets for word in ("--set", one)))[1]
        step, = self.results()["steps"]
        self.assertEqual(crossing.meeting([step])["state"], "crosses")
        self.assertGreater(max(step["growth"]["x"]), crossing.MEETING + 3.9 * crossing.SEGMENT)
        self.assertLess(max(map(abs, step["growth"]["y"])), 1e-3)
        self.assertNotIn("differs by", errors)

    def test_ranks(self):
        """The same path across on three ranks."""
        found = [self.case("a4", "Growth.segment=0.2", ranks=ranks) for ranks in (1, 3)]
        tips = [max(zip(step["stress_intensity"]["x"], step["stress_intensity"]["y"])) for step, _ in found]
        self.assertLess(math.dist(*tips), 1e-6)
        self.assertAlmostEqual(found[0][1]["margin"], found[1][1]["margin"], delta=1e-6)

    def test_restart(self):
        """A restart after the crossing repeats the changes of the mesh."""
        scene = crossing.write_scene(self.folder / "scene", "a4")
        scene.write_text(scene.read_text().replace('<Parameter name="steps" type="int" value="1"/>', ""))
        sets = ["Output.vtu=false", "Output.checkpoints.steps=1"]
        whole = self.run_scene(scene, *sets, "Time.schedule={1, 1.1}")["steps"]
        self.assertEqual(crossing.meeting(whole[:1])["state"], "crosses")
        self.run_scene(scene, *sets, "Time.schedule={1}", output="part")
        words = [word for one in (*sets, "Time.schedule={1, 1.1}") for word in ("--set", one)]
        self.call("run", scene, "--output", "part", *words, "--restart")
        tables = [steps[-1]["stress_intensity"] for steps in (whole, self.results("part")["steps"])]
        for column in ("x", "y", "K_I"):
            for a, b in zip(*(table[column] for table in tables), strict=True):
                self.assertAlmostEqual(a, b, delta=1e-9 * abs(a) + 1e-12)
        whole, part = whole[-1], self.results("part")["steps"][-1]
        self.assertAlmostEqual(whole["fractures"]["crack"]["fracture_energy"], part["fractures"]["crack"]["fracture_energy"], delta=1e-9)
        self.assertEqual(whole.get("tips"), part.get("tips"))

    def test_strength_out_of_bounds(self):
        """A strength that is not positive beyond the fracture ends the run with an error on all ranks."""
        scene = crossing.write_scene(self.folder / "scene", "a4")
        for ranks in (1, 2):
            errors = self.call("run", scene, "--output", "out", "--set", "Growth.segment=0.2", "--set", f"Fractures.crack.strength=x > {crossing.MEETING} ? -1 : 1e6",
                               ranks=ranks, expect=1)[1]
            self.assertIn('Fractures > crack: "strength"', errors)

    def test_without_strength(self):
        """Without a strength beyond, every fracture is an end."""
        scene = crossing.write_scene(self.folder / "scene", "a3")
        scene.write_text("\n".join(line for line in scene.read_text().split("\n") if 'name="strength"' not in line))
        met = crossing.meeting(self.run_scene(scene, "Output.vtu=false")["steps"])
        self.assertEqual(met["state"], "ends at")
        self.assertNotIn("margin", met)

    def test_refused(self):
        errors = self.call("check", self.scene("growth/edge_crack_2d.xml"), "--set", "Fractures.crack.strength=1e6", expect=1)[1]
        self.assertIn('Fractures > crack > "strength": requires a "toughness"', errors)

    def test_fluid_enters_a_fracture_that_is_met(self):
        """The fluid of a crack that ends at a fracture fills both, at the same pressure; its volume is that injected."""
        wall = ["Mesh.fractures.wall.lower corner={0.8, -0.4}", "Mesh.fractures.wall.upper corner={0.8, 0.4}", "Fractures.wall.material=joint"]
        steps = self.run_scene("growth/edge_crack_2d.xml", *INJECTION, "Fractures.crack.toughness=1e6", "Time.schedule={2, 20, 40, 60}", *wall)["steps"]
        self.assertEqual(crossing.meeting(steps)["state"], "ends at")
        crack, other = (steps[-1]["fractures"][name] for name in ("crack", "wall"))
        self.assertAlmostEqual(crack["area"], 0.8, delta=0.02)
        self.assertAlmostEqual(crack["fluid_volume"] + other["fluid_volume"], 60e-6 + 1e-6 * (crack["area"] + other["area"]), delta=6e-8)
        self.assertGreater(other["fluid_volume"], 2e-6 * other["area"])
        self.assertAlmostEqual(other["mean_fracture_pressure"], crack["mean_fracture_pressure"], delta=0.01 * crack["mean_fracture_pressure"])


if __name__ == "__main__":
    main()
