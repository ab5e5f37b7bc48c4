#!/usr/bin/env python3
"""Log of a run on standard output and in log.txt: log_test.py PROGRAM ROOT MPIEXEC"""
import re
import subprocess

import program
from program import ProgramTest, main

CYCLIC = "verification/cyclic_2d.xml"  # 8 steps
PUSH = "seed/push_2d.xml"
STEP = re.compile(r"^ +(\d+) +1( +\d+){6} +\S+ +\d+\.\ds +\d+\.\ds$", re.MULTILINE)  # time, length, counts, slip, seconds
QUIET = ["--set", "Output.vtu=false"]


class Log(ProgramTest):
    def log(self):
        return (self.folder / "out/log.txt").read_text()

    def test_parts(self):
        for ranks in (1, 2):
            out, err = self.call("run", self.scene(CYCLIC), "--output", "out", *QUIET, ranks=ranks)
            self.assertEqual(err, "")
            self.assertEqual(self.log(), out)
            lines = out.splitlines()
            self.assertRegex(lines[0], rf"^sprekk \d+\.\d+\.\d+: {self.scene(CYCLIC)} on {ranks} rank{'s' * (ranks > 1)}$")
            self.assertEqual(lines[1], "mesh: 4 cells, 12 nodes, 2 fracture faces")
            self.assertEqual(sum("24 unknowns" in line for line in lines), 1, out)
            self.assertNotIn("ICNTL", out)
            self.assertEqual([step[1] for step in STEP.finditer(out)], list("12345678"))
            self.assertEqual(lines[-5:], ["open on 0 of 1 fractures", 'stick on 1 of 1 fractures: "fracture" (100 % of its area)',
                                          "slip on 0 of 1 fractures", 'has slipped on 1 of 1 fractures: "fracture" (100 % of its area)',
                                          "results in out"])
            self.assertEqual(len(lines), len(set(lines)), out)

    def test_slip_and_pressure_of_wells(self):
        """The table of steps contains the largest slip and the pressure of the well, as results.json."""
        out, _ = self.call("run", self.scene("poro/injection_days_2d.xml"), "--output", "out", *QUIET, "--set", "Time.end=1728000", "--set", "Time.steps=4")
        lines = [line.split() for line in out.splitlines()]
        titles = next(k for k, line in enumerate(lines) if line and line[0] == "time")
        self.assertEqual(lines[titles][8:12], ["slip", "[m]", "well", "[Pa]"])
        for line, step in zip(lines[titles + 1:], self.results()["steps"]):
            values = step["fractures"]["fault"]["max_slip"], step["wells"]["injector"]["pressure"]
            self.assertEqual(line[8:10], [f"{value:.3g}" for value in values])
        self.assertGreater(values[0], 1e-4)

    def test_quiet(self):
        """With --quiet standard output is empty. Warnings are on standard error and in the file."""
        for ranks in (1, 2):
            out, err = self.call("run", self.scene(PUSH), "--output", "out", "--quiet", "--set",
                                 "Materials.joint.friction coefficient=3", *QUIET, ranks=ranks)
            self.assertEqual(out, "")
            warnings = err.splitlines()
            self.assertTrue(warnings)
            self.assertEqual([line for line in self.log().splitlines() if line.startswith("warning: ")], warnings)
            self.assertEqual(len(STEP.findall(self.log())), 1)
            self.assertIn("\nresults in out\n", self.log())

    def test_quiet_safety_prints_the_factor(self):
        words = ["safety", self.scene("slopes/plane_2d.xml"), "--tolerance", "0.5"]
        out, quiet = (self.call(*words, *more)[0] for more in ([], ["--quiet"]))
        self.assertGreater(out.count("\n"), 1)
        self.assertEqual(quiet, out.splitlines()[-1] + "\n")
        self.assertRegex(quiet, r"^factor of safety: \d")

    def test_standard_output_on_a_full_disk(self):
        """The results are complete, and a message reports incomplete standard output."""
        for words in (["run", self.scene(PUSH), "--output", "out", *QUIET], ["reference"], ["safety", self.scene("slopes/plane_2d.xml"), "--tolerance", "0.5"],
                      ["point", self.scene("point/cyclic_shear.xml")]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([program.PROGRAM, *words], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual((done.returncode, done.stderr), (1, "sprekk: standard output cannot be written, what was printed is incomplete; is the disk full?\n"), words)
        self.assertEqual(self.results()["status"], "completed")

    def test_a_restart_appends_and_a_fresh_run_replaces(self):
        words = ["run", self.scene(CYCLIC), "--output", "out", *QUIET, "--set", "Output.checkpoints.steps=1", "--set"]
        (self.folder / "out").mkdir()
        (self.folder / "out/log.txt").write_text("of an earlier run\n")
        for ranks in (1, 2):
            first, _ = self.call(*words, "Time.schedule={1, 2}", ranks=ranks)
            self.assertEqual(self.log(), first)
            second, _ = self.call(*words, "Time.schedule={1, 2, 3}", "--restart", ranks=ranks)
            self.assertIn("going on from t = 2\n", second)
            self.assertEqual(self.log(), first + second)

    def test_file_that_cannot_be_written(self):
        path = self.folder / "out/log.txt"
        path.mkdir(parents=True)
        for ranks in (1, 2):
            _, err = self.call("run", self.scene(PUSH), "--output", "out", *QUIET, ranks=ranks, expect=1)
            self.assertEqual(err, "sprekk: out/log.txt: cannot be written: Is a directory\n")
        path.rmdir()
        path.symlink_to("/dev/full")
        for words in ([], ["--quiet"]):
            _, err = self.call("run", self.scene(PUSH), "--output", "out", *QUIET, *words, expect=1)
            self.assertEqual(err, "sprekk: out/log.txt: cannot be written: No space left on device\n")

    def test_errors_are_in_the_file(self):
        """log.txt contains errors if its directory exists."""
        for ranks in (1, 2):
            _, err = self.call("run", self.scene(PUSH), "--output", "out", "--set", "Boundary conditions.moved.displacement={0, -sqrt(2.5-t)}",
                               "--set", "Time.end=4", "--set", "Time.steps=4", *QUIET, ranks=ranks, expect=1)
            self.assertTrue(self.log().endswith(err.replace("sprekk: ", "\nerror: ", 1)), self.log())
            self.assertEqual(len(STEP.findall(self.log())), 2)
            out, err = self.call("run", "absent.xml", "--output", "out", ranks=ranks, expect=1)
            self.assertEqual(self.log(), out + err.replace("sprekk: ", "error: "))
            self.call("run", "absent.xml", "--output", "new", ranks=ranks, expect=1)
            self.assertFalse((self.folder / "new").exists())

    def test_run_goes_on_when_its_reader_ends(self):
        words = [program.PROGRAM, "run", self.scene(PUSH), "--output", "out", *QUIET, "--set", "Time.end=50", "--set", "Time.steps=50"]
        with subprocess.Popen(words, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True) as run:
            run.stdout.readline()
            run.stdout.close()
            self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 0)
        self.assertEqual(len(STEP.findall(self.log())), 50)
        self.assertIn("results in out", self.log())

    def test_lines_arrive_while_the_run_goes_on(self):
        """Lines appear after each step, without a buffer, which would hold about 40 steps."""
        words = [program.PROGRAM, "run", self.scene(PUSH), "--output", "out", *QUIET, "--set", "Mesh.cells={60, 60}", "--set",
                 "Time.end=1000", "--set", "Time.steps=1000"]
        for launcher in ([], [program.MPIEXEC, "--quiet", "--oversubscribe", "--bind-to", "none", "-np", "2"]):
            with subprocess.Popen([*launcher, *words], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, text=True) as run:
                self.addCleanup(run.kill)
                line = next(line for line in run.stdout if STEP.match(line))
                log = self.log()
                self.assertIn("\n" + line, log)
                self.assertLess(len(STEP.findall(log)), 20)
                self.assertIsNone(run.poll())
                run.terminate()


if __name__ == "__main__":
    main()
