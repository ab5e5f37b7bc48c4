#!/usr/bin/env python3
"""Stages that change laws, conditions and springs, and restarts: stages_test.py PROGRAM ROOT MPIEXEC"""
import math
import signal
import subprocess
import time

import program
from program import main
from stages import CYCLIC, G, NU, QUIET, Stages


class Changes(Stages):
    def test_nothing_changes_no_bit(self):
        """Stages without changes, or with equal values, leave the results bitwise identical."""
        options = [QUIET, "Output.checkpoints.steps=100"]
        plain = self.run_scene(CYCLIC, *options, output="plain")
        staged = self.run_scene(CYCLIC, *options, "Stages.none.time=3", "Stages.same.time=5",
                                "Stages.same.Materials.joint.friction coefficient=0.6", output="staged")
        self.assertEqual([step.pop("stage", "") for step in staged["steps"]], [""] * 3 + ["none"] * 2 + ["same"] * 3)
        self.assertEqual(plain["steps"], staged["steps"])
        self.assertEqual(self.last("plain")[1], self.last("staged")[1])
        other = self.run_scene(CYCLIC, *options, "Stages.same.time=5", "Stages.same.Materials.joint.friction coefficient=0.5")
        self.assertNotEqual(plain["steps"][5]["fractures"], other["steps"][5]["fractures"])

    def test_weaker_joint(self):
        """A sliding block loses friction.

        By hand, the new friction gives its shear stress, and the remaining displacement is slip."""
        weak = ["Stages.weak.time=2", "Stages.weak.Materials.joint.friction coefficient=0.3",
                "Stages.weak.Tables.shear.values={0, 0.066666666666666667, 0.09, 0.09, 0.09, 0.09, 0.09, 0.09, 0.09}"]
        for ranks in (1, 3):
            steps = self.run_scene(CYCLIC, *weak, QUIET, "Time.schedule={1, 2, 3}", "Mesh.cells={4, 4}", ranks=ranks)["steps"]
            before, after = (step["fractures"]["fracture"] for step in steps[1:])
            self.assertAlmostEqual(before["mean_traction"]["local"][1], 0.18, delta=1e-9)
            self.assertAlmostEqual(after["mean_traction"]["local"][0], -0.3, delta=1e-9)
            self.assertAlmostEqual(after["mean_traction"]["local"][1], 0.09, delta=1e-9)
            self.assertAlmostEqual(after["mean_slip"], 0.5 - 0.09 / 1 - 0.09 / 2, delta=1e-9)

    def test_conditions_end_and_begin(self):
        """A traction replaces a displacement condition."""
        scene = self.scene(CYCLIC)
        values = ["Stages.pull.time=1", "Stages.pull.without={Boundary conditions > moved}",
                  "Stages.pull.Boundary conditions.pulled.boundary=north",
                  "Stages.pull.Boundary conditions.pulled.traction={0.15, -0.3}",
                  "Stages.pull.Tables.shear.values={0, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15}"]
        steps = self.run_scene(scene, *values, QUIET, "Time.schedule={1, 2}")["steps"]
        self.assertIn("north", steps[0]["reactions"])
        self.assertNotIn("north", steps[1]["reactions"])
        self.assertAlmostEqual(steps[1]["fractures"]["fracture"]["mean_traction"]["local"][1], 0.15, delta=1e-9)

    def test_restart_within_and_across_stages(self):
        scene = self.write(self.gallery(n=4, steps=4))
        options = ["Output.checkpoints.steps=1", "Stages.support.time=2",
                   "Stages.support.Boundary conditions.shotcrete.boundary=gallery",
                   "Stages.support.Boundary conditions.shotcrete.confining pressure=1e6"]
        whole = "1, 1.25, 1.5, 1.75, 2, 3"
        for ranks in (1, 3):
            self.run_scene(scene, *options, f"Time.schedule={{{whole}}}", ranks=ranks, output="whole")
            for until in ("1", "1, 1.25", "1, 1.25, 1.5, 1.75, 2"):
                with self.subTest(ranks=ranks, until=until):
                    self.run_scene(scene, *options, f"Time.schedule={{{until}}}", ranks=ranks, output="parts")
                    sets = [word for option in [*options, f"Time.schedule={{{whole}}}"] for word in ("--set", option)]
                    self.call("run", scene, "--output", "parts", "--restart", *sets, ranks=ranks)
                    self.expect_same_bits("whole", "parts")

    def test_stopped_in_the_first_step_of_a_stage(self):
        """A signal stops the run in a long first step of a stage, with too few allowed iterations.

        The restart allows more."""
        scene = ["Mesh.cells={150, 150}", "Time.maximum halvings=20", "Output.checkpoints.steps=10", "Stages.s.time=3",
                 "Stages.s.Materials.joint.friction coefficient=0.2", "Time.schedule={1, 2, 3, 4}"]
        def words(options, *more):
            sets = [word for option in (*scene, *options) for word in ("--set", option)]
            return ["run", self.scene(CYCLIC), *sets, *more]
        slow = ["Stages.s.Solver.maximum iterations=1"]
        run = subprocess.Popen([str(program.PROGRAM), *map(str, words(slow, "--output", "parts"))], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        while not (self.folder / "parts/bulk_0002.pvtu").exists():  # last step of the previous stage
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        time.sleep(0.3)
        run.send_signal(signal.SIGTERM)
        self.assertIn("interrupted after the step to t = 3;", run.stderr.read())
        self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 4)
        self.call(*words([], "--output", "parts", "--restart"))
        self.call(*words([], "--output", "whole"))
        self.assertEqual(self.results("parts")["steps"], self.results("whole")["steps"])
        self.assertEqual(self.results("parts")["stages"], self.results("whole")["stages"])
        self.assertEqual((self.folder / "parts/effective_input.xml").read_text(), (self.folder / "whole/effective_input.xml").read_text())

    def test_restart_into_changed_stages(self):
        """A restart may change later stages but not earlier ones. The message explains how to change them."""
        first = ["Output.checkpoints.steps=1", QUIET, "Stages.a.time=2", "Stages.a.Materials.joint.friction coefficient=0.5"]
        self.run_scene(CYCLIC, *first, "Time.schedule={1, 2, 3, 4}")
        b = ["Stages.b.time=4", "Stages.b.Materials.joint.friction coefficient=0.4"]
        def go(*options, expect=0):
            sets = [word for option in options for word in ("--set", option)]
            return self.call("run", self.scene(CYCLIC), "--output", "out", "--restart", *sets, expect=expect)[1]
        whole = self.run_scene(CYCLIC, *first, *b, "Time.schedule={1, 2, 3, 4, 5}", output="whole")
        go(*first, *b, "Time.schedule={1, 2, 3, 4, 5}")
        self.assertEqual(self.results()["steps"], whole["steps"])
        self.assertEqual([step.get("stage") for step in whole["steps"]], [None, None, "a", "a", "b"])
        error = go(*first, "Materials.joint.tangential stiffness=3", expect=1)
        self.assertIn("they differ in: Materials", error)
        self.assertIn("use a stage for changes at its time or later", error)
        error = go(*first[:-1], "Stages.a.Materials.joint.friction coefficient=0.55", expect=1)
        self.assertIn("they differ in: Materials", error)

    def test_errors_come_first(self):
        """Errors name the stage, the place, the value and the allowed values, before any computation."""
        for options, message in (
                (["Stages.s.time=-1"], 'Sprekk > Stages > s > "time": is -1 s: must be after the "start" of "Time", 0 s'),
                (["Stages.s.without={}"], 'Sprekk > Stages > s > "time" (s): missing; it is required'),
                (["Stages.s.time=2", "Stages.r.time=2"], 'is 2 s: the stage "r" begins then'),
                (["Stages.s.time=2", "Stages.s.Materials.joint.friction coeficient=0.3"],
                 'stage "s": Sprekk > Materials > joint > "friction coeficient": unknown. Did you mean "friction coefficient"?'),
                (["Stages.s.time=2", "Stages.s.Materials.joint.friction coefficient=-1"],
                 'stage "s": Sprekk > Materials > joint > "friction coefficient": is -1'),
                (["Stages.s.time=2", "Stages.s.Mesh.cells={4, 4}"], "Sprekk > Stages > s > Mesh: a stage cannot change it"),
                (["Stages.s.time=2", "Stages.s.without={Boundary conditions > mooved}"],
                 'stage "s": "without": names "Boundary conditions > mooved", which the scene does not have at this time. Did you mean "moved"?'),
                (["Stages.s.time=2", "Stages.s.Fractures.material=other"],
                 'Sprekk > Stages > s > Fractures > "material": a stage changes the materials of fractures by their names'),
                (["Stages.s.time=2", "Stages.s.Materials.rock.shear modulus=2"],
                 'stage "s": the rock of "bulk" gets other elastic constants, and the fracture "fracture" meets it; that can only happen'),
                (["Stages.s.time=2", "Stages.s.backfill={bulk}"],
                 'stage "s": "backfill": names "bulk", which is not excavated at this time'),
                (["Stages.s.time=2", "Stages.s.Boundary conditions.other.boundary=north",
                  "Stages.s.Boundary conditions.other.displacement={1, 1}"],
                 'stage "s": boundary conditions "moved" and "other" prescribe'),
                (["Stages.s.time=2", "Stages.s.excavate={galery}"], 'stage "s": Sprekk > Regions > "galery": is "galery", must be one of'),
                (["Stages.s.time=2", "Stages.s.Flow.viscosity=1e-3"], 'stage "s": Sprekk > Materials > rock > "permeability": missing'),
                (["Stages.s.time=2", "Stages.s.excavate={bulk}"], "all cells of the mesh would be excavated"),
                (["Materials.joint.damage=isotropic", "Materials.joint.damage length of friction=0.02",
                  "Materials.joint.residual part of friction=0.5", "Stages.s.time=2", "Stages.s.Materials.plain.type=joint",
                  "Stages.s.Materials.plain.friction coefficient=0.6", "Stages.s.Fractures.fracture.material=plain"],
                 "its laws with history variables become")):
            with self.subTest(options=options):
                sets = [word for option in options for word in ("--set", option)]
                error = self.call("run", self.scene(CYCLIC), "--output", "out", *sets, expect=1)[1]
                self.assertIn(message, error)
                self.assertEqual(self.results()["steps"] if (self.folder / "out/results.json").exists() else [], [])
        warning = self.call("check", self.scene(CYCLIC), "--set", "Stages.s.time=9")[1]
        self.assertIn("is 9 s, and the last step ends at 8 s: the stage never begins", warning)

    def test_springs_that_change(self):
        """A column on springs that become stiffer: u = -p/k, then -(p' - p)/k' more.

        After excavation of a part, the other springs have the same forces, independently of earlier changes."""
        k, stiffer, E = 2e9, 5e9, 1e15
        for cell, ranks in (("triangle", 1), ("quadrilateral", 3), ("tetrahedron", 2)):
            with self.subTest(cell=cell, ranks=ranks):
                values = self.column(cell, 1)
                up = len(values["Mesh"]["cells"]) - 1
                values["Materials"]["lower"]["Young's modulus"] = E
                values["Boundary conditions"]["ground"] = {"boundary": ("south", "bottom")[up - 1],
                                                           "foundation stiffness": [0.0] * up + [k]}
                values["Boundary conditions"]["load"]["confining pressure"] = "t < 2.5 ? 2e6 : 7e6"
                values["Stages"] = {"stiffer": {"time": 2.0, "Boundary conditions":
                                                {"ground": {"foundation stiffness": [0.0] * up + [stiffer]}}}}
                values["Time"] = {"schedule": [1.0, 2.0, 2.25, 3.0]}
                self.run_scene(self.write(values), ranks=ranks)
                exact = [-2e6 / k] * 3 + [-2e6 / k - 5e6 / stiffer]
                for row, u in zip(self.probe("face")[-4:], exact):
                    self.assertAlmostEqual(float(row[1 + up]), u, delta=1e-5 * 2e6 / k)
        ends = []
        for early in (False, True):  # changes of constants before any strain
            values = self.column("quadrilateral", 1)
            values["Mesh"]["cells"], values["Mesh"]["upper corner"] = [6, 6], [3.0, 3.0]
            values["Mesh"]["regions"] = {"upper": {"lower corner": [0.0, 2.0], "upper corner": [3.0, 3.0]},
                                         "corner": {"lower corner": [2.0, 0.0], "upper corner": [3.0, 1.0]}}
            del values["Regions"]
            values["Boundary conditions"] = {"west": values["Boundary conditions"]["west"],
                                             "ground": {"boundary": "south", "foundation stiffness": [0.0, 1e9]},
                                             "load": {"boundary": "north", "confining pressure": "t < 0.75 ? 0 : 2e6"}}
            values["Probes"] = {"at": {"point": [1.0, 0.0], "outputs": ["displacement"]}}
            stage = {"excavation": {"time": 2.0, "excavate": ["corner"]}}
            if early:
                stage["early"] = {"time": 0.5, "Materials": {"lower": {"Young's modulus": 12e9}}}
                values["Materials"]["lower"]["Young's modulus"] = 5e9
            else:
                values["Materials"]["lower"]["Young's modulus"] = 12e9
            values["Stages"] = stage
            values["Time"] = {"schedule": [0.5, 1.0, 2.0, 3.0]}
            self.run_scene(self.write(values))
            ends.append([float(v) for v in self.probe("at")[-1][1:]])
        for a, b in zip(*ends):
            self.assertAlmostEqual(a, b, delta=1e-9 * abs(ends[0][1]))

    def test_springs_count_from_their_stage(self):
        """A gallery under isotropic stress gets a lining of springs after half of the release.

        The springs share the other half, p = k (u(end) - u(half)), with u = (P - p)/(2 G) at a wall of radius 1.
        Later changes of the springs have no effect."""
        P, k = 10e6, 8e9
        values = self.gallery(8)
        held = P * k / (2 * G) / 2 / (1 + k / (2 * G))  # spring traction at the end
        values["Bulk"]["initial stress"] = [-P, -P, 2 * NU * -P, 0.0]
        values["Expressions"] = {"r2": "x^2 + y^2", **{f"u{a}": f"-(t <= 1 ? 0 : t <= 2 ? {P}*(t - 1)/2 : {P - held})/(2*{G})*{a}/r2" for a in "xy"}}
        del values["Stages"]["excavation"]["release"]
        values["Stages"]["excavation"]["release"] = 2.0
        values["Stages"]["lining"] = {"time": 2.0, "Boundary conditions": {"lining": {"boundary": "gallery", "foundation stiffness": [k, k]}}}
        values["Stages"]["softer"] = {"time": 4.0, "Boundary conditions": {"lining": {"foundation stiffness": [k / 3, k / 2]}}}
        values["Time"] = {"schedule": [1.0, 2.0, 3.0, 5.0]}
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                self.run_scene(self.write(values), ranks=ranks)
                for name in ("wall 0", "wall 2"):
                    half, end, _, softer = ([float(v) for v in row[1:]] for row in self.probe(name)[-4:])
                    x = [math.cos(math.pi / 8 * int(name[-1])), math.sin(math.pi / 8 * int(name[-1]))]
                    for i in range(2):
                        self.assertAlmostEqual(half[i], -P / 2 / (2 * G) * x[i], delta=1e-3 * P / (2 * G))
                        self.assertAlmostEqual(end[i], -(P - held) / (2 * G) * x[i], delta=1e-3 * P / (2 * G))
                        self.assertAlmostEqual(softer[i], end[i], delta=1e-9 * P / (2 * G))

    def test_end_does_not_depend_on_steps(self):
        """Without slip the end state does not depend on the steps: without release, in one step, in five."""
        ends = []
        for steps, release in ((1, False), (1, True), (5, True)):
            self.run_scene(self.write(self.gallery(4, steps=steps, release=release)))
            ends.append([float(v) for k in range(5) for v in self.probe(f"wall {k}")[-1][1:]])
        self.run_scene(self.write(self.gallery(4, steps=4)), "Time.schedule={1, 1.5}")
        half = [float(v) for k in range(5) for v in self.probe(f"wall {k}")[-1][1:3]]
        for end in ends[1:]:
            for a, b in zip(ends[0], end):
                self.assertAlmostEqual(a, b, delta=1e-10 * max(1, abs(a)))
        whole = [v for k in range(5) for v in ends[0][6 + 2 - 8 + k * (len(ends[0]) // 5):][:2]]
        for a, b in zip(half, whole):
            self.assertAlmostEqual(a, b / 2, delta=1e-12)


if __name__ == "__main__":
    main()
