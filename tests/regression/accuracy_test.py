#!/usr/bin/env python3
"""Error control by the section Accuracy: accuracy_test.py PROGRAM ROOT MPIEXEC"""
import math
import re
import shutil

from program import ProgramTest, main

SHEAR, CRACK, CROSSING = "verification/sneddon_shear.xml", "verification/sneddon.xml", "verification/crossing_2d.xml"
DOUBLET = "accuracy/doublet_2d.xml"
NETWORK = "flow/network_2d.xml"
EXACT = 1.5e-3 * math.pi / 4  # mean slip, or opening, of the crack
QUIET = "Output.vtu=false"
FAULT, PLATE, TEARING = "accuracy/fault_2d.xml", "accuracy/plate_2d.xml", "verification/tearing_3d.xml"
DURING = "Accuracy.refinement=during the run"
RELATIVE_SLIP = ("Accuracy.quantities.fault slips.relative=0.03", "Accuracy.quantities.branch slips.absolute=1 mm")


def goal(quantity, name="goal", **entries):
    return [f"Accuracy.quantities.{name}.{key}={value}" for key, value in {"quantity": quantity, **entries}.items()]


class Accuracy(ProgramTest):
    def refuse(self, words, scene, *sets):
        arguments = [word for entry in sets for word in ("--set", entry)]
        _, said = self.call("check", self.scene(scene), *arguments, expect=1)
        self.assertIn(str(self.scene(scene)), said)
        for word in words:
            self.assertIn(word, said)

    def test_reaches_what_is_asked(self):
        for scene, quantity in ((CRACK, "opening"), (SHEAR, "slip")):
            for order in (1, 2):
                results = self.run_scene(scene, *goal(quantity, fractures="{crack}", relative=0.01), f"Mesh file.order={order}", QUIET)
                accuracy = results["accuracy"]
                one = accuracy["quantities"]["goal"]
                self.assertTrue(accuracy["reached"] and one["reached"])
                self.assertEqual((one["unit"], one["title"]), ("m", f'{quantity} of "crack"'))
                self.assertAlmostEqual(one["requested"], 0.01 * one["value"])
                self.assertLessEqual(one["error"], one["requested"])
                self.assertLess(abs(one["value"] - EXACT), 1.5 * one["requested"], (scene, order))
                self.assertRegex(one["line"], rf'^{quantity} of "crack": [0-9.e-]+ m \+- ')
                self.assertAlmostEqual(float(one["line"].split(": ")[1].split(" ")[0]) / one["value"], 1, delta=1e-3)
                self.assertIn("requested 1 %)", one["line"])
                cells = [mesh["cells"] for mesh in accuracy["meshes"]]
                self.assertGreaterEqual(len(cells), 2)  # one mesh does not test the refinement
                self.assertEqual(cells, sorted(set(cells)))
                self.assertEqual(results["mesh"]["cells"], cells[-1])
                mean = results["steps"][-1]["fractures"]["crack"][f"mean_{quantity}"]
                self.assertAlmostEqual(mean, one["value"], delta=1e-12)

    def test_any_number_of_ranks_makes_the_same_meshes(self):
        sets = [*goal("slip", fractures="{flat}", relative=0.02), *goal("stress", "all", relative=0.1),
                *goal("normal force", "force", fractures="{flat, steep}", absolute=3e-4), "Accuracy.cells=3000", QUIET]
        runs = [self.run_scene(CROSSING, *sets, ranks=ranks)["accuracy"] for ranks in (1, 3)]
        for first, other in zip(*(run["meshes"] for run in runs)):
            self.assertEqual(first["cells"], other["cells"])
            for name, quantity in first["quantities"].items():
                for key in ("value", "error"):
                    self.assertAlmostEqual(quantity[key] / other["quantities"][name][key], 1, delta=1e-5)
        self.assertGreaterEqual(len(runs[0]["meshes"]), 3)
        self.assertEqual(*(len(run["meshes"]) for run in runs))

    def test_tells_how_far_it_came(self):
        sets = [*goal("opening", relative=1e-5), "Accuracy.cells=900", QUIET]
        results = self.run_scene(CRACK, *sets)
        accuracy = results["accuracy"]
        self.assertEqual(results["status"], "completed")
        self.assertFalse(accuracy["reached"])
        self.assertIn("900 cells", accuracy["ended"])
        self.assertTrue(all(mesh["cells"] <= 900 for mesh in accuracy["meshes"]))
        arguments = [word for entry in sets for word in ("--set", entry)]
        for strict, status in (((), 0), (("--strict",), 3)):
            _, said = self.call("run", self.scene(CRACK), "--output", "out", *strict, *arguments, expect=status)
            self.assertIn("warning: opening of all fractures: ", said)
            self.assertIn('not reached, for the next mesh would have more than 900 cells ("cells")', said)

    def test_limits_in_seconds_and_memory(self):
        for entry, words in (("seconds=1e-3 s", '("seconds")'), ("memory=1", '("memory")')):
            accuracy = self.run_scene(CRACK, *goal("opening", relative=1e-5), f"Accuracy.{entry}", QUIET)["accuracy"]
            self.assertEqual(len(accuracy["meshes"]), 1)
            self.assertIn(words, accuracy["ended"])

    def test_flow_in_rock_and_fractures(self):
        """Steady flow in xml/flow/network_2d.xml: flow through the boundary and into a well, and pressure."""
        steady = ["Flow.compressibility=0", "Time.steps=1", "Mesh.cells={10, 10}", QUIET]
        well = ["Flow.Wells.well.points={60, 70}", "Flow.Wells.well.radius=0.1 m", "Flow.Wells.well.pressure=0.5e6"]
        sets = [*goal("flow", "through", boundary="west", relative=0.02), *goal("flow", "out", well="well", relative=0.02),
                *goal("pressure", "in", fractures="{short, branch}", relative=0.005)]
        runs = [self.run_scene(NETWORK, *steady, *well, *sets, ranks=ranks) for ranks in (1, 3)]
        fine = self.run_scene(NETWORK, *steady, *well, *goal("flow", "through", boundary="west", relative=0.2), "Mesh.cells={160, 160}", "Accuracy.cells=60000")
        for results in runs:
            accuracy = results["accuracy"]
            self.assertTrue(accuracy["reached"], accuracy["ended"])
            self.assertEqual([accuracy["quantities"][name]["unit"] for name in ("through", "out", "in")], ["m^2/s", "m^2/s", "Pa"])
            self.assertEqual(accuracy["quantities"]["out"]["title"], 'flow of "well"')
            totals = results["steps"][-1]
            self.assertAlmostEqual(totals["wells"]["well"]["rate"] / accuracy["quantities"]["out"]["value"], 1)
            self.assertAlmostEqual(totals["inflows"]["west"] / accuracy["quantities"]["through"]["value"], 1)
        for first, other in zip(*(run["accuracy"]["meshes"] for run in runs)):
            self.assertEqual(first["cells"], other["cells"])
            for name, quantity in first["quantities"].items():
                for key in ("value", "error"):
                    self.assertAlmostEqual(quantity[key] / other["quantities"][name][key], 1, delta=1e-4)
        through = runs[0]["accuracy"]["quantities"]["through"]
        self.assertLess(abs(through["value"] - fine["accuracy"]["quantities"]["through"]["value"]), 1.5 * through["requested"])

    def test_errors_of_earlier_steps_last(self):
        """The error of almost steady flow after many steps is equal to that of steady flow."""
        goals = [*goal("flow", "through", boundary="west", relative=0.5), *goal("pressure", "in", fractures="{short, branch}", relative=0.5)]
        single = ["Mesh.cells={20, 20}", "Accuracy.cells=10", QUIET]  # the first mesh is the last
        errors = []
        for sets in (["Flow.compressibility=0", "Time.steps=1"], ["Time.end=1e5", "Time.steps=40"]):
            results = self.run_scene(NETWORK, *goals, *single, *sets)
            errors.append({name: one["error"] for name, one in results["accuracy"]["meshes"][0]["quantities"].items()})
        for name, steady in errors[0].items():
            self.assertAlmostEqual(errors[1][name] / steady, 1, delta=0.03)

    def test_refines_during_the_run(self):
        """A fault under a growing load. A later step needs a finer mesh than the first one."""
        during = ["Time.steps=4", QUIET, DURING, *RELATIVE_SLIP]
        runs = [self.run_scene(FAULT, *during, ranks=ranks) for ranks in (1, 3)]
        fine = self.run_scene(FAULT, "Time.steps=4", QUIET, *RELATIVE_SLIP, "Mesh.cells={160, 160}", "Accuracy.cells=10")
        value = fine["accuracy"]["quantities"]["fault slips"]["value"]
        for results in runs:
            accuracy = results["accuracy"]
            one = accuracy["quantities"]["fault slips"]
            self.assertTrue(accuracy["reached"], accuracy["ended"])
            self.assertLess(abs(one["value"] / value - 1), 1.5 * 0.03)
            self.assertIsNone(one["time"])
            self.assertEqual(len(results["steps"]), 4)
            self.assertEqual(results["mesh"]["cells"], accuracy["meshes"][-1]["cells"])
            self.assertGreater(accuracy["meshes"][-1]["cells"], 1.5 * accuracy["meshes"][0]["cells"])
        for first, other in zip(*(run["accuracy"]["meshes"] for run in runs)):
            self.assertEqual(first["cells"], other["cells"])
        for first, other in zip(*(run["steps"] for run in runs)):
            slips = [step["fractures"]["fault"]["mean_slip"] for step in (first, other)]
            self.assertAlmostEqual(slips[0] / slips[1], 1, delta=1e-6)

    def test_refined_meshes_are_part_of_checkpoints(self):
        sets = [QUIET, DURING, *RELATIVE_SLIP, "Output.checkpoints.steps=1"]
        whole = self.run_scene(FAULT, *sets, "Time.steps=4")
        self.run_scene(FAULT, *sets, "Time.end=0.5", "Time.steps=2", output="parts")
        for ranks in (1, 2):
            shutil.copytree(self.folder / "parts", self.folder / f"parts_{ranks}")
            arguments = [word for entry in (*sets, "Time.steps=4") for word in ("--set", entry)]
            self.call("run", self.scene(FAULT), "--output", f"parts_{ranks}", "--restart", *arguments, ranks=ranks)
            results = self.results(f"parts_{ranks}")
            self.assertEqual(results["mesh"], whole["mesh"])
            seconds = [mesh.pop("seconds") for mesh in results["accuracy"]["meshes"]]
            self.assertEqual(seconds, sorted(seconds))
            self.assertEqual(len(seconds), len(whole["accuracy"]["meshes"]))
            for first, other in zip(whole["accuracy"]["meshes"][:-1], results["accuracy"]["meshes"]):  # the last error is since the restart
                self.assertEqual(first["cells"], other["cells"])
                for key in ("value", "error"):
                    self.assertAlmostEqual(first["quantities"]["fault slips"][key] / other["quantities"]["fault slips"][key], 1, delta=1e-6)
            for first, other in zip(whole["steps"], results["steps"]):
                slips = [step["fractures"]["fault"]["mean_slip"] for step in (first, other)]
                self.assertAlmostEqual(slips[0] / slips[1], 1, delta=1e-8)
        self.call("run", self.scene(FAULT), "--output", "parts_1", "--restart", *arguments)  # takes no step
        self.assertEqual(len(self.results("parts_1")["steps"]), 4)

    def test_refines_a_draining_plate_during_the_run(self):
        """The pressure gradient begins at the drained side and moves inwards."""
        sets = ["Time.scheme=BDF2", "Time.steps=10", QUIET, "Accuracy.quantities.outflow.relative=0.03", "Accuracy.quantities.force.relative=0.03"]
        results = self.run_scene(PLATE, *sets, DURING, "Mesh.cells={10, 1}")
        fine = self.run_scene(PLATE, *sets, "Mesh.cells={160, 16}", "Accuracy.cells=10")
        self.assertGreater(len(results["accuracy"]["meshes"]), 1)
        for name in ("outflow", "force"):
            values = [run["accuracy"]["quantities"][name]["value"] for run in (results, fine)]
            self.assertLess(abs(values[0] / values[1] - 1), 1.5 * 0.03, name)

    def test_refines_during_adaptive_steps_and_stages(self):
        """At 40 s another pressure is prescribed at the drained side."""
        scene = self.folder / "plate.xml"
        scene.write_text(re.sub(r'.*name="steps".*', "", self.scene(PLATE).read_text()))
        sets = [QUIET, "Accuracy.quantities.outflow.relative=0.05", "Accuracy.quantities.force.relative=0.05", "Time.tolerance=0.05",
                "Stages.refill.time=40", "Stages.refill.Boundary conditions.drained.pressure=1e6", DURING, "Mesh.cells={10, 1}"]
        results = self.run_scene(scene, *sets)
        self.assertEqual(results["status"], "completed")
        self.assertGreater(len(results["accuracy"]["meshes"]), 2)
        self.assertEqual([stage["name"] for stage in results["stages"]], ["refill"])
        self.assertEqual(results["steps"][-1]["time"], 50)
        whole = self.run_scene(scene, *sets, "Accuracy.cells=10", output="coarse")
        self.assertEqual(whole["mesh"]["cells"], 20)
        self.assertIn("cells", whole["accuracy"]["ended"])

    def test_refines_in_3d_during_the_run(self):
        runs = [self.run_scene(TEARING, *goal("slip", relative=0.04), DURING, QUIET, "Time.steps=2", "Mesh.cells={8, 2, 8}", ranks=ranks) for ranks in (1, 2)]
        for results in runs:
            one = results["accuracy"]["quantities"]["goal"]
            self.assertTrue(one["reached"])
            self.assertGreater(results["mesh"]["cells"], 768)
            self.assertLess(abs(one["value"] / (2e-3 * math.pi / 4) - 1), 1.5 * 0.04)
        self.assertEqual(runs[0]["mesh"], runs[1]["mesh"])

    def test_refuses_in_words(self):
        good = goal("slip", relative=0.01)
        self.refuse(['Sprekk > Mesh > "cell": is quadrilateral, must be triangle with "Accuracy"'], CROSSING, *good, "Mesh.cell=quadrilateral")
        self.refuse(['Mesh > "refinements": is 1, must be 0 with "Accuracy"'], CROSSING, *good, "Mesh.refinements=1")
        self.refuse(['Output > "checkpoints": must be absent with "Accuracy"'], CROSSING, *good, "Output.checkpoints.steps=1")
        self.refuse(['"quantity": is "slipp", must be one of', 'Did you mean "slip"?'], CROSSING, *goal("slipp", relative=0.01))
        self.refuse(['goal: needs "relative", "absolute", or both'], CROSSING, *goal("slip"))
        self.refuse(['Accuracy > quantities > goal > "fractures": is "flatt", must be one of "flat", "steep"'], CROSSING, *goal("slip", fractures="{flatt}", relative=0.01))
        self.refuse(['"fractures": must be absent: "stress" takes none'], CROSSING, *goal("stress", fractures="{flat}", relative=0.01))
        self.refuse(['"component": is z, must be x or y in 2D'], CROSSING, *goal("reaction", relative=0.01, boundary="north", component="z"))
        self.refuse(['"boundary": missing; it is required of a reaction'], CROSSING, *goal("reaction", relative=0.01))
        self.refuse(['goal > "boundary": is "east", where no displacement is prescribed'], "accuracy/fault_2d.xml", "Accuracy.quantities.goal.quantity=reaction",
                    "Accuracy.quantities.goal.boundary=east", "Accuracy.quantities.goal.relative=0.01")
        self.refuse(['"boundary": is "nort", must be one of', 'Did you mean "north"?'], CROSSING, *goal("reaction", relative=0.01, boundary="nort"))
        self.refuse(['Accuracy: is of upwind flow; not available with "Heat > advection" second order'], DOUBLET, "Heat.advection=second order")
        self.refuse(['heat > "well": "injector" puts in fluid whose temperature is given'], DOUBLET, "Accuracy.quantities.heat.quantity=temperature",
                    "Accuracy.quantities.heat.well=injector", "Accuracy.quantities.heat.relative=0.01")
        self.refuse(['goal > "quantity": is "slip", which the scene does not contain'], NETWORK, *good)
        self.refuse(['goal: needs "boundary" or "well"'], NETWORK, *goal("flow", relative=0.01))
        self.refuse(['goal > "boundary": is "north", where no pressure is prescribed; its flow is known'], NETWORK, *goal("flow", boundary="north", relative=0.01))
        self.refuse(['goal > "well": is "one", which is no section of Flow > Wells'], NETWORK, *goal("pressure", well="one", relative=0.01))
        self.refuse(['Accuracy: is of the scheme rt0; not available with "Flow > scheme" tpfa'], NETWORK, *goal("pressure", relative=0.01), "Flow.scheme=tpfa")
        through_rock = ["Flow.Wells.well.points={61, 71, 11, 61, 71, 21}", "Flow.Wells.well.radius=0.1 m", "Flow.Wells.well.rate=1e-6"]
        self.refuse(["goal: is not available with wells through rock"], "flow/network_3d.xml", *goal("flow", boundary="west", relative=0.01), *through_rock)
        in_rock = ["Flow.Wells.well.points={61, 72}", *through_rock[1:]]
        self.refuse(["goal: is not available with wells, whose power"], NETWORK, *goal("flux", relative=0.01), *in_rock)
        _, said = self.call("run", self.scene(NETWORK), "--output", "out",
                            *(word for entry in (*goal("pressure", well="well", relative=0.01), *in_rock) for word in ("--set", entry)), expect=1)
        self.assertIn(f'{NETWORK}: Sprekk > Flow > Wells > well > "points": in rock, must be on a fracture with "Accuracy"', said)
        self.refuse(['Output > "events": must be absent with "Accuracy"'], FAULT, DURING, "Output.events.rate=1e-3")
        self.refuse(['stage "later": Sprekk > Accuracy > "refinement": is "during the run", not available with release'], FAULT, DURING,
                    "Stages.later.time=0.5", "Stages.later.release=0.2")
        _, said = self.call("run", self.scene(CRACK), "--restart", "--output", "out",
                            *(word for entry in good for word in ("--set", entry)), expect=1)
        self.assertIn('--restart: not available with "repeated runs" of the section "Accuracy"', said)


if __name__ == "__main__":
    main()
