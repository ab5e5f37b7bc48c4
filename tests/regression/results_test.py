#!/usr/bin/env python3
"""Output files of a run: results_test.py PROGRAM ROOT MPIEXEC"""
import re
import struct
import subprocess
import sys
import xml.etree.ElementTree
import zlib

from program import ROOT, ProgramTest, main

CROSSING = "verification/crossing_2d.xml"
QUIET = "Output.vtu=false"


def numbers(value):
    """Returns all numbers in JSON data, in order."""
    if isinstance(value, dict):
        return [x for key in sorted(value) for x in numbers(value[key])]
    if isinstance(value, list):
        return [x for entry in value for x in numbers(entry)]
    return [value] if isinstance(value, (int, float)) and not isinstance(value, bool) else []


def cell_data(path, name):
    """Returns the values of a scalar array in a .vtu file, with compressed, appended binary data."""
    content = path.read_bytes()
    offset = re.search(rf'Name="{name}"[^>]*offset="(\d+)'.encode(), content)[1]
    start = content.index(b"_", content.index(b"<AppendedData")) + 1 + int(offset)
    n_blocks, = struct.unpack_from("<I", content, start)
    sizes = struct.unpack_from(f"<{n_blocks}I", content, start + 12)
    data, at = b"", start + 12 + 4 * n_blocks
    for size in sizes:
        data += zlib.decompress(content[at:at + size])
        at += size
    return list(struct.unpack(f"<{len(data) // 8}d", data))


class Results(ProgramTest):
    def test_every_key(self):
        for ranks in (1, 2):
            r = self.run_scene(CROSSING, ranks=ranks)
            self.assertEqual(r["status"], "completed")
            self.assertNotIn("reason", r)
            self.assertEqual(r["ranks"], ranks)
            self.assertEqual(r["mesh"]["cells"], 128)
            self.assertEqual(r["mesh"]["fracture_faces"], 12)
            cells, faces = r["partition"]["cells"], r["partition"]["fracture_faces"]
            self.assertEqual((cells["min"] + cells["max"], faces["min"] + faces["max"]), (256, 24) if ranks == 1 else (128, 12))
            self.assertAlmostEqual(cells["imbalance"], cells["max"] / (128 / ranks))
            self.assertAlmostEqual(faces["imbalance"], faces["max"] / (12 / ranks))
            self.assertEqual(r["partition"]["cut_edges"] > 0, ranks > 1)
            self.assertLessEqual(r["partition"]["separated_fracture_faces"], r["partition"]["cut_edges"])
            self.assertEqual([step["time"] for step in r["steps"]], [1, 2, 3, 4])
            for step in r["steps"]:
                self.expect_step(step)
            for key in ("fields", "matrices", "modules", "local_groups"):
                self.assertTrue(r["blocks"][key], key)
            entities = {"displacement": "node", "tip displacement": "enriched node", "traction": "fracture face"}
            reported = {field["name"]: field["entity"] for field in r["blocks"]["fields"]}
            self.assertEqual({name: reported.get(name) for name in entities}, entities)
            for phase in ("mesh", "time_steps", "output", "linear_solve"):
                self.assertGreater(r["timing"][phase]["seconds"], 0)
                self.assertGreater(r["timing"][phase]["count"], 0)
            memory = r["memory"]
            self.assertGreater(memory["peak_bytes_largest_rank"], 1e6)
            self.assertLessEqual(memory["peak_bytes_largest_rank"], memory["peak_bytes_all_ranks"])
            self.assertIn("direct", r["solver"]["choice"])

    def test_initial_state(self):
        """Values at the start, on each number of ranks and after a restart. Steady flow has no initial state."""
        sets = [QUIET, "Output.checkpoints.steps=1", "Time.steps=2"]
        for ranks in (1, 2):
            start = self.run_scene("poro/injection_days_2d.xml", *sets, "Time.end=172800", ranks=ranks)["initial"]
            self.assertEqual((start["time"], start["single_fractures"]["max_slip"]), (0, [0]))
            self.assertAlmostEqual(start["fractures"]["fault"]["mean_traction"]["local"][1], 7e6, delta=1)  # initial shear stress
            self.assertAlmostEqual(start["wells"]["injector"]["pressure"], 10e6, delta=1)
            words = [word for entry in (*sets, "Time.end=345600") for word in ("--set", entry)]
            self.call("run", self.scene("poro/injection_days_2d.xml"), "--output", "out", "--restart", *words, ranks=ranks)
            self.assertEqual(self.results()["initial"], start)
        self.assertNotIn("initial", self.run_scene("flow/source_2d.xml", QUIET))

    def test_steps_do_not_write_all_results(self):
        """results.json is rewritten every few seconds and not after each step, which would take quadratic time."""
        timing = self.run_scene("verification/uniaxial_2d.xml", "Output.vtu=false", "Time.steps=100")["timing"]
        self.assertEqual(timing["time_steps"]["count"], 100)
        self.assertLessEqual(timing["results"]["count"], 1 + timing["time_steps"]["seconds"] / 4)

    def test_error_estimate(self):
        """The error estimate is computed on request only.

        It does not depend on the number of ranks, and agrees with the fields."""
        self.assertNotIn("error_estimate", self.run_scene("verification/free_sides_2d.xml")["steps"][-1])
        self.assertNotIn(b"error density", (self.folder / "out/bulk/bulk_0001_0.vtu").read_bytes())
        relative = []
        for ranks in (1, 2):
            r = self.run_scene("verification/free_sides_2d.xml", "Output.error estimate=true", ranks=ranks)
            self.assertEqual(r["timing"]["error_estimate"]["count"], 2)
            stress, jump = (r["steps"][-1]["error_estimate"][name] for name in ("stress", "jump"))
            relative.append([stress["relative"], jump["relative"]])
            self.assertLess(0.02, stress["relative"])
            self.assertLess(stress["relative"], 0.2)
            densities = [x for k in range(ranks) for x in cell_data(self.folder / f"out/bulk/bulk_0001_{k}.vtu", "error density")]
            self.assertAlmostEqual(sum(densities) / 64, stress["energy_norm"]**2, delta=1e-12)  # 64 cells of equal size
        for one, two in zip(*relative):
            self.assertAlmostEqual(one, two, delta=1e-10 * one)

    def expect_step(self, step):
        for key in ("newton_iterations", "linear_iterations", "cuts", "substeps"):
            self.assertIsInstance(step[key], int)
        self.assertTrue(step["converged"])
        self.assertEqual(sorted(step["fractures"]), ["flat", "steep"])
        for f in step["fractures"].values():
            self.assertAlmostEqual(f["area"], 0.75, places=12)
            self.assertAlmostEqual(f["fraction_open"] + f["fraction_stick"] + f["fraction_slip"], 1, places=12)
            for key in ("opening", "slip"):
                self.assertLessEqual(f["mean_" + key], f["max_" + key] + 1e-15)
            for key in ("mean_jump", "mean_elastic_jump", "mean_plastic_jump", "mean_traction"):
                self.assertEqual(len(f[key]["global"]), 2)
                self.assertEqual(len(f[key]["local"]), 2)
                self.assertAlmostEqual(sum(x * x for x in f[key]["global"]), sum(x * x for x in f[key]["local"]), places=12)
            for a, b, c in zip(f["mean_jump"]["global"], f["mean_elastic_jump"]["global"], f["mean_plastic_jump"]["global"]):
                self.assertAlmostEqual(a, b + c, places=14)
            self.assertAlmostEqual(f["mean_jump"]["local"][0], f["mean_opening"], places=14)
        # with free sides, the reactions of top and bottom are in equilibrium
        top, bottom = step["reactions"]["north"], step["reactions"]["south"]
        for a, b in zip(top, bottom):
            self.assertAlmostEqual(a, -b, places=12)

    def test_reactions_are_the_force_through_the_fracture(self):
        r = self.run_scene("verification/cyclic_3d.xml", QUIET)
        shear = [0.2 / 3, 0.18, 0.18, 0.14 / 3, -0.18, 0.02, 0.18, 0.18]
        for step, l_t in zip(r["steps"], shear):
            for i, force in enumerate((l_t, 0, -0.3)):
                self.assertAlmostEqual(step["reactions"]["top"][i], force, places=9)
                self.assertAlmostEqual(step["reactions"]["bottom"][i], -force, places=9)
            for i, moment in enumerate((-0.15, l_t + 0.15, -0.5 * l_t)):  # of a uniform stress on the square around (0.5, 0.5, 1)
                self.assertAlmostEqual(step["reaction_moments"]["top"][i], moment, places=9)

    def test_state_fractions(self):
        r = self.run_scene("verification/cyclic_2d.xml", QUIET)
        sliding = [0, 1, None, 0, 1, 0, 1, None]  # None: at the friction limit, with either state
        for step, slip in zip(r["steps"], sliding):
            f = step["fractures"]["fracture"]
            self.assertEqual(f["fraction_open"], 0)
            if slip is not None:
                self.assertEqual(f["fraction_slip"], slip)
                self.assertEqual(f["fraction_stick"], 1 - slip)

    def test_ranks_do_not_change_the_summary(self):
        one = self.run_scene(CROSSING, QUIET)
        two = self.run_scene(CROSSING, QUIET, ranks=2)
        for a, b in zip(one["steps"], two["steps"]):
            for x, y in zip(numbers(a["fractures"]), numbers(b["fractures"])):
                self.assertAlmostEqual(x, y, delta=1e-9)

    def test_effective_input_runs_again(self):
        first = self.run_scene("verification/regimes_2d.xml", "Mesh.cells={4, 4}", "Solver.tolerance=1e-11", QUIET)
        again = self.run_scene(str(self.folder / "out" / "effective_input.xml"), output="again")
        self.assertEqual(numbers([s["fractures"] for s in first["steps"]]), numbers([s["fractures"] for s in again["steps"]]))
        self.assertEqual(first["mesh"], again["mesh"])
        text = [(self.folder / name / "effective_input.xml").read_text() for name in ("out", "again")]
        self.assertEqual(*text)
        self.assertRegex(text[0], r'name="tolerance" type="double" value="1e-11"')

    def test_collections_list_all_steps(self):
        for ranks in (1, 2):
            self.run_scene("seed/immersed_2d.xml", "Mesh.cells={6, 6}", ranks=ranks)
            for name in ("bulk", "fractures"):
                root = xml.etree.ElementTree.parse(self.folder / "out" / f"{name}.pvd").getroot()
                sets = root.findall("./Collection/DataSet")
                self.assertEqual([float(s.get("timestep")) for s in sets], list(range(1, 11)))
                for s in sets:
                    piece = self.folder / "out" / s.get("file")
                    parts = re.findall(r' (?:Source|file)="([^"]+)"', piece.read_text())
                    self.assertTrue(len(parts) == ranks or name == "fractures" and 1 <= len(parts) <= ranks)
                    for part in parts:
                        self.assertTrue((piece.parent / part).exists(), part)

    def test_steps_that_choose_themselves(self):
        """Adaptive steps report length and estimated errors. Pictures are at scheduled times, tables at all steps."""
        results = self.run_scene("poro/shut_in_2d.xml", "Time.tolerance=0.1", "Time.schedule={18000, 36000, 72000, 144000}", "Output.every=2")
        steps, begin = results["steps"], 0
        for step in steps:
            self.assertAlmostEqual(step["length"], step["time"] - begin, delta=1e-9 * step["time"])
            begin = step["time"]
            self.assertTrue(all(value <= 0.1 for value in step.get("estimated_errors", {}).values()), step)
        self.assertEqual(set(steps[0]["estimated_errors"]), {"loads"})  # the first step has no other estimate
        self.assertIn("pressure", steps[-1]["estimated_errors"])
        times = [step["time"] for step in steps]
        for t in (3600, 18000, 19800, 36000, 72000, 144000):  # knots of the table, and the schedule
            self.assertIn(t, times)
        written = [float(t) for t in re.findall(r'timestep="([^"]*)"', (self.folder / "out/bulk.pvd").read_text())]
        self.assertEqual(written, [36000, 144000])
        on_three = self.run_scene("poro/shut_in_2d.xml", "Time.tolerance=0.1", "Time.schedule={18000, 36000, 72000, 144000}", "Output.vtu=false", ranks=3)["steps"]
        self.assertEqual(len(on_three), len(steps))
        for one, three in zip(steps, on_three):
            self.assertAlmostEqual(one["time"], three["time"], delta=1e-5 * one["time"])
            self.assertEqual(one["rejected"], three["rejected"])

    def test_every_so_many_steps(self):
        self.run_scene("seed/immersed_2d.xml", "Mesh.cells={6, 6}", "Output.every=4")
        text = (self.folder / "out" / "bulk.pvd").read_text()
        self.assertEqual([float(t) for t in re.findall(r'timestep="([^"]+)"', text)], [4, 8, 10])

    def test_intact_rock_writes_no_fractures(self):
        r = self.run_scene("verification/uniaxial_3d.xml")
        self.assertEqual(r["steps"][0]["fractures"], {})
        self.assertFalse((self.folder / "out" / "fractures.pvd").exists())

    def test_failure_keeps_what_was_computed(self):
        for ranks in (1, 2):
            r = self.run_scene("verification/cyclic_2d.xml", "Solver.maximum iterations=1", "Time.maximum halvings=0", "Time.proximal continuation=false",
                               ranks=ranks, expect=3)
            self.assertEqual(r["status"], "failed")
            self.assertIn("no convergence in 1 iterations", r["reason"])
            self.assertTrue(r["steps"][0]["converged"])
            self.assertFalse(r["steps"][-1]["converged"])
            self.assertEqual(r["steps"][0]["time"], 1)
            self.assertAlmostEqual(r["steps"][0]["fractures"]["fracture"]["mean_traction"]["local"][1], 0.2 / 3, places=9)
            self.assertTrue((self.folder / "out" / "bulk.pvd").exists())

    def test_failure_is_reported(self):
        out, err = self.call("run", self.scene("verification/cyclic_2d.xml"), "--output", "out", "--set",
                             "Solver.maximum iterations=1", "--set", "Time.maximum halvings=0", "--set", "Time.proximal continuation=false", ranks=2, expect=3)
        self.assertEqual((out + err).count("failed"), 1)
        self.assertIn("no convergence in 1 iterations", out + err)

    def test_doubts_are_reported_once(self):
        def warnings(*overrides, ranks=1):
            sets = [word for override in ("Mesh.cell=quadrilateral", "Time.steps=3", QUIET, *overrides) for word in ("--set", override)]
            return self.call("run", self.scene("flow/source_2d.xml"), "--output", "out", *sets, ranks=ranks)[1].splitlines()
        turned = "Materials.rock.permeability={1, 1, 0.5}"
        self.assertEqual(warnings(), [])
        self.assertEqual(warnings(turned), [])  # mimetic
        for ranks in (1, 2):
            reported = warnings(turned, "Flow.scheme=tpfa", ranks=ranks)
            self.assertEqual(len(reported), 1, reported)
            self.assertIn('Sprekk > Flow > "scheme": in 256 of 256 cells permeability and faces are not orthogonal', reported[0])
            core = ["Mesh.regions.core.lower corner={0.25, 0.25}", "Mesh.regions.core.upper corner={0.75, 0.75}"]
            reported = warnings(*core, "Boundary conditions.west.region=core", ranks=ranks)
            self.assertEqual(len(reported), 1, reported)
            self.assertIn('west > "region": "core" does not touch the boundary "west": the condition applies nowhere', reported[0])
            self.assertEqual(warnings(*core, "Boundary conditions.west.region=bulk", ranks=ranks), [])
            reported = warnings("Boundary conditions.west.pressure=-5", ranks=ranks)
            self.assertEqual(len(reported), 1, reported)
            self.assertRegex(reported[0], "^warning: t = 0.333333: .*source_2d.xml: the pressure of the fluid is below 0 in places")

    def test_rock_that_nothing_holds_is_reported_once(self):
        # the frame contracts, releases the block in it (ax, ay < 0), and grips it again
        scene, times = self.scene("contact/floating_2d.xml"), "Time.schedule={3, 3.75, 3.9, 4, 5}"
        words = "a piece of rock around (0.5, 0.5) (128 cells) can move along"
        for ranks in (1, 2):
            out, err = self.call("run", scene, "--output", "out", "--set", times, "--set", QUIET, ranks=ranks)
            self.assertEqual(re.findall("^warning: .*", err, re.MULTILINE), err.splitlines())
            lines = [line for line in err.splitlines() if "over knots" not in line]  # the first step passes some knots
            self.assertEqual(len(lines), 1, err)
            self.assertIn("t = 3.75: " + words, lines[0])
            self.assertEqual(re.findall("^.*constrained again", out, re.MULTILINE), ["t = 5: all rock is constrained again"])
            floating = {step["time"]: step["floating"] for step in self.results()["steps"] if "floating" in step}
            self.assertEqual(list(floating), [3.75, 3.9, 4])
            for text in floating.values():
                self.assertIn(words, text)
            for step in self.results()["steps"]:
                self.assertNotIn("oscillating_faces", step)

    def test_faces_that_found_no_state(self):
        for ranks in (1, 2):
            r = self.run_scene("contact/network_x.xml", "Solver.maximum iterations=3", "Time.maximum halvings=0", "Time.proximal continuation=false",
                               ranks=ranks, expect=3)
            reported = {name: int(n) for n, name in re.findall(r'(\d+) of "(\w+)"', r["reason"])}
            self.assertGreater(sum(reported.values()), 0)
            self.assertEqual(r["steps"][-1]["oscillating_faces"], sum(reported.values()))
            names, counts, n_faces = sorted(r["steps"][0]["fractures"]), {}, 0
            root = xml.etree.ElementTree.parse(self.folder / "out/oscillating.pvd").getroot()
            step, = root.findall("./Collection/DataSet")
            self.assertEqual(float(step.get("timestep")), r["steps"][-2]["time"])
            parts = re.findall(r'Source="([^"]+)"', (self.folder / "out" / step.get("file")).read_text())
            self.assertEqual(len(parts), ranks)
            for part in parts:
                path = self.folder / "out" / part
                flags, fractures = cell_data(path, "oscillating"), cell_data(path, "fracture")
                n_faces += len(flags)
                self.assertLessEqual(set(flags), {0, 1})
                for flag, fracture in zip(flags, fractures, strict=True):
                    if flag:
                        counts[names[int(fracture)]] = counts.get(names[int(fracture)], 0) + 1
                self.assertLessEqual(set(cell_data(path, "state")), {0, 1, 2})  # including the previous state
            self.assertEqual(n_faces, r["mesh"]["fracture_faces"])
            self.assertEqual(counts, reported)
        self.run_scene("contact/network_x.xml", "Time.schedule={1}", QUIET)
        self.assertEqual(list((self.folder / "out").glob("oscillating*")), [])  # from the other run

    def test_much_friction_is_named_with_a_failure(self):
        slope = ("contact/incline_2d.xml", "Mesh.rotation=80", QUIET)
        note = "; the friction coefficient of"
        for mu, reported in ((1, False), ("1.5+x", False), (1.5, True)):
            r = self.run_scene(*slope, f"Materials.joint.friction coefficient={mu}", ranks=1 + (mu == 1.5), expect=3)
            self.assertEqual(note in r["reason"], reported, r["reason"])
        self.assertTrue(r["reason"].endswith(note + ' "joint" is 1.5: above about 1 equilibrium need not exist, nor be unique'))
        shear = (str(ROOT / "docs/shear_test.xml"), "Solver.maximum iterations=2", "Time.maximum halvings=0", "Time.proximal continuation=false", QUIET)
        for angle, reported in ((45, False), (60, True)):
            r = self.run_scene(*shear, f"Materials.rough joint.friction angle={angle}", expect=3)
            self.assertEqual(note + ' "rough joint" is 1.732: ' in r["reason"], reported, r["reason"])

    def test_cuts_are_counted(self):
        # the sides follow the shear traction min(2/3 d_t, 0.18), so substeps are exact
        path = ["Time.schedule={1}", "Tables.tangential.arguments={0, 1}", "Tables.tangential.values={0, 0.5}",
                "Tables.shear.arguments={0, 0.54, 1}", "Tables.shear.values={0, 0.18, 0.18}", "Solver.tolerance=1e-10"]
        r = self.run_scene("verification/cyclic_3d.xml", "Solver.maximum iterations=3", "Time.maximum halvings=8", "Time.proximal continuation=false", *path, QUIET)
        self.assertEqual(r["status"], "completed")
        self.assertGreater(r["steps"][0]["cuts"], 0)
        self.assertGreater(r["steps"][0]["substeps"], 1)
        last = r["steps"][-1]["fractures"]["fracture"]
        self.assertAlmostEqual(last["mean_plastic_jump"]["global"][0], 0.23, places=9)

    def test_iterative_solver_on_three_ranks(self):
        overrides = ["Mesh.cells={8, 8, 8}", "Time.schedule={1}", "Solver.Linear solver.type=iterative", QUIET]
        one = self.run_scene("verification/crossing_3d.xml", *overrides)
        three = self.run_scene("verification/crossing_3d.xml", *overrides, ranks=3)
        for x, y in zip(numbers(one["steps"][0]["fractures"]), numbers(three["steps"][0]["fractures"])):
            self.assertAlmostEqual(x, y, delta=1e-8)

    def test_solver_entries_reach_the_libraries(self):
        iterative = ["Solver.Linear solver.type=iterative", "Time.schedule={1}", QUIET]
        usual = self.run_scene("seed/immersed_3d.xml", *iterative)
        other = self.run_scene("seed/immersed_3d.xml", *iterative, "Solver.Blocks.displacement.type=MueLu", "Solver.Blocks.displacement.MueLu.multigrid algorithm=unsmoothed",
                               "Solver.Linear solver.Belos.Num Blocks=7")
        self.assertGreater(other["steps"][0]["linear_iterations"], usual["steps"][0]["linear_iterations"])
        for word in ("unsmoothed", "Num Blocks = 7"):
            self.assertIn(word, other["solver"]["parameters"])
            self.assertNotIn(word, usual["solver"]["parameters"])

    def test_inflows_are_numbers(self):
        """Inflows are numbers for boundaries with given pressure and with a conductance."""
        for overrides in ([], ["Boundary conditions.west.conductance=1e-9"]):
            inflows = self.run_scene("flow/network_2d.xml", *overrides, QUIET)["steps"][-1]["inflows"]
            self.assertEqual(set(inflows), {"west", "east"})
            for value in inflows.values():
                self.assertIsInstance(value, float)

    def test_script_that_reads_them(self):
        def read(*words):
            return subprocess.run([sys.executable, str(ROOT / "docs/read_results.py"), *words], cwd=self.folder,
                                  capture_output=True, text=True)
        for boundary, force in self.run_scene(CROSSING, QUIET)["steps"][-1]["reactions"].items():
            line = re.search(f"^reaction at {boundary}: (.*)$", read("out").stdout, re.MULTILINE)[1]
            for word, value in zip(line.split(), force, strict=True):
                self.assertAlmostEqual(float(word), value, delta=1e-4 * abs(value) + 1e-9)
        for words, message in ((["nowhere"], "nowhere/results.json: No such file or directory; it takes the directory of a run\n"),
                               (["out", "flatt"], 'out: there is no fracture "flatt", but flat, steep\n')):
            done = read(*words)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (1, "", message))


if __name__ == "__main__":
    main()
