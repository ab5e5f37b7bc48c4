#!/usr/bin/env python3
"""Restarts from checkpoints: restart_test.py PROGRAM ROOT MPIEXEC [NUMBER OF KILLS]"""
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
import zlib

import program
from program import ProgramTest, main

N_KILLS = int(sys.argv[4]) if len(sys.argv) > 4 else 12
CYCLIC, CROSSING = "verification/cyclic_2d.xml", "verification/crossing_3d.xml"  # faces open, stick and slip
MASONRY, FLOATING = "contact/masonry_cross_2d.xml", "contact/floating_3d.xml"  # calibrated constants; a floating block
TURNS = "contact/damage_turns_3d.xml"  # directional histories, more than fit in the table
INJECTION = "poro/injection_2d.xml"  # fractures slide, widen and open
SHUT_IN = "poro/shut_in_2d.xml"  # adaptive steps
DOUBLET = "thm/doublet_2d.xml"  # adaptive steps with heat
TRACER = "tracer/doublet_2d.xml"
HISTORY = ["Materials.joint.damage=isotropic", "Materials.joint.damage length of friction=0.02",  # of two laws
           "Materials.joint.residual part of friction=0.5", "Materials.joint.closure=Barton-Bandis with memory",
           "Materials.joint.irrecoverable part of closure=0.3"]
QUIET = "Output.vtu=false"
EVERY_STEP = "Output.checkpoints.steps=1"


def small_files(size):
    """Returns a function for a process that limits the size of its files, as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


class Restart(ProgramTest):
    def command(self, name, *overrides, ranks=1, output="out", restart=False):
        sets = [word for override in overrides for word in ("--set", override)]
        command = [str(program.PROGRAM), "run", str(self.scene(name)), "--output", output, *sets]
        if restart:
            command.append("--restart")
        if ranks > 1:
            command = [program.MPIEXEC, "--quiet", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)] + command
        return command

    def go(self, *arguments, expect=0, limit=None, **options):
        """Returns standard output and error of a run."""
        command = self.command(*arguments, **options)
        environment = {**os.environ, "PMIX_MCA_gds": "hash"}  # MPI works without large files
        done = subprocess.run(["timeout", str(program.TIME_LIMIT), *command], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, preexec_fn=limit, env=environment)
        self.assertEqual(done.returncode, expect, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def checkpoints(self, output="out"):
        """Returns the folders of complete checkpoints in their order."""
        folder = self.folder / output / "checkpoints"
        return sorted((f for f in folder.glob("*") if f.name.isdigit()), key=lambda f: int(f.name))

    def reached(self, output):
        """Returns the number of the last checkpoint, or 0."""
        return max((int(folder.name) for folder in self.checkpoints(output)), default=0)

    def last(self, output="out"):
        """Returns the last checkpoint: its numbers, its journal and the bytes of all values."""
        folder = self.checkpoints(output)[-1]
        sealed = json.loads((folder / "manifest.json").read_text())["sealed"]
        sealed["content"].pop("restarts")
        journal = (folder.parent / "journal").read_bytes()[:sealed["journal"][0]]
        return sealed["content"], journal, [piece.read_bytes() for piece in sorted(folder.glob("piece_*.h5"))]

    def expect_same_bits(self, a, b):
        self.assertEqual(self.results(a)["status"], "completed")
        self.assertEqual(self.results(a)["steps"], self.results(b)["steps"])
        self.assertEqual(self.last(a), self.last(b))

    def test_same_bits_on_the_same_ranks(self):
        multigrid = ["Solver.Linear solver.type=iterative", "Solver.Blocks.displacement.type=MueLu",
                     "Solver.Blocks.displacement.MueLu.coarse: max size=200"]
        past_the_largest_load = "1, 2, 4", "4.5"
        for scene, ranks, (first, then), options in (
                (CYCLIC, 1, past_the_largest_load, []), (CYCLIC, 2, ("1, 2, 3", "4, 5"), []),
                (CROSSING, 2, ("1, 2", "3"), HISTORY), (CROSSING, 3, ("1, 2", "3"), []),
                (MASONRY, 2, ("1, 2", "3, 4"), ["Materials.other.Young's modulus=1e-6"]),
                (FLOATING, 1, ("1, 2, 3", "4, 5"), []),
                (TURNS, 1, (", ".join(map(str, range(1, 81))), "81, 82"), []),
                (TURNS, 3, ("1, 2, 3, 4, 5, 6", "7, 8"), []),
                (INJECTION, 1, ("4000, 8000", "12000"), ["Mesh.cells={20, 20}"]),
                (INJECTION, 2, ("4000, 8000", "12000"),
                 ["Mesh.cells={20, 20}", "Solver.Linear solver.type=iterative", "Time.scheme=BDF2"]),
                (DOUBLET, 2, ("2e6, 4e6", "6e6"),
                 ["Mesh.cells={20, 20}", "Heat.fluid=exponential", "Heat.viscosity decay=0.015",
                  "Heat.heat of friction=true", "Heat.advection=second order"]),
                (TRACER, 2, ("2e4, 4e4", "6e4"), ["Mesh.cells={20, 12}", "Time.scheme=BDF2"]),
                (CROSSING, 1, ("2", "3"), multigrid), (CROSSING, 2, ("2", "3"), multigrid),
                (CROSSING, 3, ("2", "3"), multigrid)):
            with self.subTest(scene=scene, ranks=ranks, options=options):
                times = first.split(",")
                self.run_and_go_on(scene, *options, f"Time.schedule={{{first}, {then}}}",
                                   f"Output.checkpoints.steps={len(times)}", ranks=ranks)
                if scene == MASONRY:
                    self.assertTrue(any(factor not in (0, 1) for factor in self.last("whole")[0]["calibration"]))
                self.assertEqual(self.results("parts")["restarts"], [float(times[-1])])

    def run_and_go_on(self, *scene, ranks):
        """Repeats the second part of a run from the first of two checkpoints. Both results are bitwise identical."""
        for folder in ("whole", "parts"):
            shutil.rmtree(self.folder / folder, ignore_errors=True)
        self.go(*scene, QUIET, ranks=ranks, output="whole")
        shutil.copytree(self.folder / "whole", self.folder / "parts")
        shutil.rmtree(self.checkpoints("parts")[-1])
        self.assertEqual(len(self.checkpoints("parts")), 1)
        self.go(*scene, QUIET, ranks=ranks, output="parts", restart=True)
        self.expect_same_bits("whole", "parts")

    def test_same_bits_with_a_longer_schedule(self):
        """A run completed by its schedule continues with further times."""
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                scene, whole = [CYCLIC, EVERY_STEP, QUIET], "Time.schedule={1, 2, 4, 4.5}"
                self.go(*scene, whole, ranks=ranks, output="whole")
                self.go(*scene, "Time.schedule={1, 2, 4}", ranks=ranks, output="parts")
                self.go(*scene, whole, ranks=ranks, output="parts", restart=True)
                self.expect_same_bits("whole", "parts")
                for folder in ("whole", "parts"):
                    shutil.rmtree(self.folder / folder)

    def test_same_steps_where_they_choose_themselves(self):
        """Adaptive steps continue with the data of the step control."""
        n_rejected = 0
        for scheme, ranks in (("implicit Euler", 1), ("BDF2", 1), ("implicit Euler", 2)):
            with self.subTest(scheme=scheme, ranks=ranks):
                self.run_and_go_on(SHUT_IN, f"Time.scheme={scheme}", "Output.checkpoints.steps=9", ranks=ranks)
                steps, restart = self.results("parts")["steps"], self.results("parts")["restarts"][0]
                self.assertGreater(sum(step["time"] > restart for step in steps), 0)
                n_rejected += sum(step["rejected"] for step in steps)
                self.assertGreater(len({round(step["length"], 6) for step in steps}), 10)
        self.assertGreater(n_rejected, 0)

    def test_killed_at_any_moment(self):
        """Kills a run at random times in a step, also during the writing of a checkpoint."""
        scene = [CYCLIC, "Time.steps=32", "Mesh.cells={4, 4}", EVERY_STEP, QUIET]
        begin = time.monotonic()
        self.go(*scene, output="whole")
        two_steps = (time.monotonic() - begin) / 16
        rng = random.Random(1)
        kills = 0
        while kills < N_KILLS:
            before = self.reached("parts")
            command = self.command(*scene, output="parts", restart=before > 0)
            run = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            last = before + rng.randint(1, 4)
            while run.poll() is None and self.reached("parts") < last:
                time.sleep(0.001)
            time.sleep(rng.uniform(0, two_steps))
            run.send_signal(signal.SIGKILL)
            words = run.communicate()[1].decode()
            self.assertIn(run.returncode, (0, -signal.SIGKILL), words)
            self.assertNotIn("checkpoint", words)  # no damaged checkpoint
            self.assertTrue(self.reached("parts") > before or run.returncode == 0)
            kills += run.returncode != 0
            if run.returncode == 0:
                self.expect_same_bits("whole", "parts")
                shutil.rmtree(self.folder / "parts")
        self.go(*scene, output="parts", restart=bool(self.checkpoints("parts")))
        self.expect_same_bits("whole", "parts")

    def start(self, *arguments, **options):
        """Starts a run and waits for its first steps."""
        run = subprocess.Popen(self.command(*arguments, **options), cwd=self.folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        results = self.folder / "out/results.json"
        while not (results.exists() and self.results()["status"] == "running"):
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        time.sleep(0.1)  # some steps
        return run

    def expect_interrupted(self, run, n_steps):
        """Checks the status of an interrupted run, and that the last checkpoint is that of the last complete step."""
        words = run.stderr.read()
        self.assertEqual(run.wait(), 4, words)
        self.assertRegex(words, "sprekk: stopping; a second signal stops at once\n"
                                "warning: interrupted after the step to t = .*; --restart continues from the last checkpoint")
        results = self.results()
        self.assertEqual(results["status"], "interrupted")
        self.assertIn(len(results["steps"]), range(1, n_steps))
        self.assertEqual(self.last()[0]["time"], results["steps"][-1]["time"])

    def test_interrupted(self):
        self.go(CYCLIC, "Time.steps=100", QUIET, EVERY_STEP, output="whole")
        for number, ranks, n_steps, every in ((signal.SIGINT, 1, 100, EVERY_STEP),
                                              (signal.SIGUSR1, 3, 100, EVERY_STEP),  # mpirun forwards it
                                              (signal.SIGTERM, 1, 300, "Output.checkpoints.minutes=1000")):
            with self.subTest(ranks=ranks, every=every):
                scene = [CYCLIC, f"Time.steps={n_steps}", QUIET, every]
                run = self.start(*scene, ranks=ranks)
                run.send_signal(number)
                self.expect_interrupted(run, n_steps)
                if ranks == 1:
                    self.go(*scene, restart=True)
                    self.assertEqual(len(self.results()["steps"]), n_steps)
                if number == signal.SIGINT:
                    self.expect_same_bits("whole", "out")
                shutil.rmtree(self.folder / "out")

    def test_interrupted_in_a_long_step(self):
        """With too few allowed iterations a step has many substeps and proximal continuations."""
        scene = [CYCLIC, "Mesh.cells={150, 150}", "Time.maximum halvings=20", EVERY_STEP, QUIET]
        self.go(*scene, "Time.end=1", "Time.steps=1")
        before = self.last()
        for ranks, restart in ((1, True), (2, True), (1, False)):
            with self.subTest(ranks=ranks, restart=restart):
                if not restart:
                    shutil.rmtree(self.folder / "out")
                slides = () if restart else ("Materials.joint.friction coefficient=0.2",)  # in the first step
                run = self.start(*scene, *slides, "Solver.maximum iterations=1", ranks=ranks, restart=restart)
                run.send_signal(signal.SIGTERM if ranks == 1 else signal.SIGUSR1)
                words = run.stderr.read()
                self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 4, words)
                self.assertEqual(self.results()["status"], "interrupted")
                if restart:
                    self.assertIn("interrupted after the step to t = 1;", words)
                    self.assertEqual(self.last(), before)
                else:
                    self.assertIn("interrupted in the first step; there is no checkpoint to continue from", words)
                    self.assertEqual(self.results()["steps"], [])

    def test_interrupted_in_a_linear_solve(self):
        """A linear solve with an unreachable tolerance is interrupted."""
        solver = [f"Solver.Linear solver.{entry}" for entry in (
            "type=iterative", "forcing=false", "Belos.Solver Type=Pseudo Block CG", "Belos.Convergence Tolerance=1e-300",
            "Belos.Maximum Iterations=1000000000")]
        slow = ["Solver.Blocks.displacement.type=Ifpack2", "Solver.Blocks.displacement.Ifpack2.type=RELAXATION"]
        scene = [CYCLIC, "Mesh.cells={120, 120}", *solver, *slow, EVERY_STEP, QUIET]
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                run = self.start(*scene, ranks=ranks)
                time.sleep(0.5)
                run.send_signal(signal.SIGTERM if ranks == 1 else signal.SIGUSR1)
                words = run.stderr.read()
                self.assertEqual(run.wait(timeout=20), 4, words)
                self.assertIn("interrupted in the first step; there is no checkpoint to continue from", words)
                self.assertEqual(self.results()["status"], "interrupted")
                shutil.rmtree(self.folder / "out")

    def test_interrupted_before_the_first_step(self):
        """A signal may arrive at any time after the start of the program: during MPI start, input or meshing."""
        for delay in (0, 0.02, 0.05, 0.1, 0.2, 0.3):
            with self.subTest(delay=delay):
                run = subprocess.Popen(self.command(CYCLIC, "Mesh.cells={100, 100}", QUIET), cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
                self.addCleanup(run.kill)
                while not self.catches(run.pid, signal.SIGTERM):
                    self.assertIsNone(run.poll())
                time.sleep(delay)
                run.send_signal(signal.SIGTERM)
                self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 4)

    def catches(self, pid, number):
        """Returns whether a process has a handler for a signal."""
        with open(f"/proc/{pid}/status") as status:
            return any(line.startswith("SigCgt:") and int(line.split()[1], 16) >> (number - 1) & 1 for line in status)

    def test_two_runs_into_one_directory(self):
        """A second run in the same directory is rejected without effect on the first."""
        scene = [CYCLIC, "Time.steps=100000", EVERY_STEP, QUIET]
        run = self.start(*scene)
        for ranks in (1, 3):
            for restart in (False, True):
                words = self.go(CYCLIC, "Materials.joint.friction coefficient=0.1", ranks=ranks, restart=restart, expect=1)
                self.assertRegex(words, f"(?m)^sprekk: out: another run \\(process {run.pid} on .*\\) is writing its results here; wait until it "
                                        "has ended, or name another directory by --output\n$")
        self.go(CYCLIC, "Time.steps=1", "Materials.joint.friction coefficient=-1", expect=1)
        self.assertNotIn("0.1", [word for word in (self.folder / "out/effective_input.xml").read_text().split('"')])
        run.send_signal(signal.SIGKILL)
        run.wait()
        self.assertEqual(self.results()["status"], "running")
        self.go(CYCLIC, "Time.steps=1", QUIET)  # a lock ends with its process
        self.assertEqual(self.results()["status"], "completed")
        self.assertFalse((self.folder / "out/.lock").exists())

    def test_interrupted_twice(self):
        run = self.start(CYCLIC, "Mesh.cells={200, 200}", EVERY_STEP, QUIET)
        run.send_signal(signal.SIGINT)
        self.assertIn("a second signal stops at once", run.stderr.readline())
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(timeout=program.TIME_LIMIT), -signal.SIGINT)
        self.assertEqual(self.results()["status"], "running")

    def test_cost_of_a_checkpoint(self):
        size = {}
        for n in (4, 40):
            self.go(CYCLIC, f"Time.steps={n}", EVERY_STEP, QUIET)
            size[n] = sum(file.stat().st_size for file in self.checkpoints()[-1].iterdir())
            self.assertEqual((self.folder / "out/checkpoints/journal").read_text().count("\n"), n)
        self.assertLess(abs(size[40] - size[4]), 100)  # differences in digits

    def test_one_of_three_ranks_is_killed(self):
        scene = [CYCLIC, "Time.steps=200", EVERY_STEP, QUIET]
        run = subprocess.Popen(self.command(*scene, ranks=3), cwd=self.folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        while len(self.checkpoints()) < 2:
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        children = subprocess.run(["pgrep", "-P", str(run.pid)], capture_output=True, text=True).stdout.split()
        subprocess.run(["kill", "-9", children[-1]], check=True)
        self.assertNotEqual(run.wait(timeout=program.TIME_LIMIT), 0)
        reached = self.last()[0]["time"]
        short = f"Time.schedule={{{reached}, {reached + 0.04}}}"
        self.go(CYCLIC, short, EVERY_STEP, QUIET, ranks=3, restart=True)
        steps = self.results()["steps"]
        self.assertEqual(steps[-1]["time"], reached + 0.04)
        self.assertEqual(len(steps), round(reached / 0.04) + 1)

    def test_full_disk(self):
        scene = [CYCLIC, "Mesh.cells={40, 40}", EVERY_STEP, QUIET]
        self.go(*scene, output="whole")
        self.go(*scene, "Time.end=3", "Time.steps=3")
        results, before = self.results(), self.last()
        size = (self.folder / "whole" / "results.json").stat().st_size
        self.assertLess(2 * size, (self.checkpoints()[-1] / "piece_0.h5").stat().st_size)

        log = self.folder / "out/log.txt"
        log.unlink()
        log.symlink_to("/dev/null")  # otherwise it would exceed the limit
        words = self.go(*scene, restart=True, limit=small_files(1000), expect=1)  # nothing can be written
        self.assertRegex(words, "out/(?!log)\\S+: cannot be written: File too large")
        log.unlink()
        self.assertEqual(self.results(), results)
        self.assertEqual(self.last(), before)

        words = self.go(*scene, restart=True, limit=small_files(2 * size))  # everything except checkpoints
        self.assertRegex(words, "warning: no checkpoint at t = 4: .*piece_0.h5: cannot be written: File too large")
        self.assertEqual(self.results()["steps"], self.results("whole")["steps"])
        self.assertEqual(self.last(), before)
        self.assertEqual(sorted(f.name for f in (self.folder / "out/checkpoints").iterdir() if not f.name.isdigit()), ["journal", "journal_copy"])

        self.go(*scene, restart=True)
        self.expect_same_bits("whole", "out")

    def test_what_may_change(self):
        first = ["Time.end=2", "Time.steps=2", EVERY_STEP, QUIET]
        self.go(CYCLIC, *first)
        results = self.results()
        for part, override in (("mesh", "Mesh.cells={4, 4}"), ("mesh", "Mesh.rotation=5"),
                               ("Materials", "Materials.joint.friction coefficient=0.1"),
                               ("Bulk", "Bulk.body force={0, -1}"), ("Time > start", "Time.start=-1"),
                               ("Boundary conditions", "Boundary conditions.extra.boundary=west"),
                               ("Tables", "Tables.extra.arguments={0, 1}")):
            more = ["Tables.extra.values={0, 1}"] if part == "Tables" else \
                ["Boundary conditions.extra.traction={0, 0}"] if part == "Boundary conditions" else []
            words = self.go(CYCLIC, *first, override, *more, restart=True, expect=1)
            self.assertRegex(words, f"another scene, they differ in: (.*, )?{part}")
            self.assertEqual(self.results(), results)
        self.go(CYCLIC, "Time.schedule={1, 2, 2.5}", "Solver.tolerance=1e-9", "Output.every=3", restart=True)
        self.assertEqual([s["time"] for s in self.results()["steps"]], [1, 2, 2.5])
        self.assertEqual(self.results()["steps"][:2], results["steps"])

    def test_tables_may_grow(self):
        table = "Tables.lateral.arguments={{0, 8{}}}", "Tables.lateral.values={{-0.1, -0.1{}}}"
        short, long = ([entry.format(more) for entry in table] for more in ("", ", 9"))
        first = ["Time.end=2", "Time.steps=2", EVERY_STEP, QUIET]
        self.go(CYCLIC, *first, *short)
        self.go(CYCLIC, *first, *long, restart=True)
        self.assertEqual(self.last()[0]["scene"]["Tables"]["lateral"], [[0, -0.1], [8, -0.1]])
        self.go(CYCLIC, "Time.end=3", "Time.steps=3", EVERY_STEP, QUIET, *long, restart=True)
        words = self.go(CYCLIC, *first, *short, restart=True, expect=1)
        self.assertRegex(words, "another scene, they differ in: Tables;")

    def test_damaged_checkpoints(self):
        scene = [CYCLIC, EVERY_STEP, QUIET]
        self.go(*scene, output="whole")
        for damage in (lambda f: (f / "piece_0.h5").write_bytes((f / "piece_0.h5").read_bytes()[:-1]),
                       lambda f: (f / "piece_0.h5").unlink(),
                       lambda f: (f / "manifest.json").write_text((f / "manifest.json").read_text().replace("4", "5", 1)),
                       lambda f: (f / "manifest.json").write_text(""),
                       lambda f: [os.truncate(journal, journal.stat().st_size - 1) for journal in f.parent.glob("journal*")]):
            self.go(*scene, "Time.end=3", "Time.steps=3")
            self.assertEqual(len(self.checkpoints()), 2)
            damage(self.checkpoints()[-1])
            words = self.go(*scene, restart=True)
            self.assertRegex(words, "warning: out/checkpoints/([0-9]+/[a-z0-9_.]+|journal): (is damaged|cannot be read); "
                                    "the run continues from the checkpoint before")
            self.expect_same_bits("whole", "out")
            shutil.rmtree(self.folder / "out")

    def test_other_versions(self):
        """A checkpoint in another format gives an error about the version, without comparison of its content."""
        self.go(CYCLIC, "Time.end=1", "Time.steps=1", EVERY_STEP, QUIET)
        manifest = self.checkpoints()[0] / "manifest.json"
        sealed = json.loads(manifest.read_text())["sealed"]
        text = manifest.read_text()
        written = f'"format":{sealed["format"]}'
        for replacement, reported in (("", "an earlier version of Sprekk \\(format 1, "), ('"format":99', "a later version of Sprekk \\(format 99, ")):
            changed = text.replace(written + ",", replacement + "," if replacement else "")
            begin = changed.index('"sealed":') + len('"sealed":')
            body = changed[begin:changed.rindex("}")]
            manifest.write_text(f'{{"seal":[{len(body.encode())},{zlib.crc32(body.encode())}],"sealed":{body}}}')
            words = self.go(CYCLIC, EVERY_STEP, QUIET, restart=True, expect=1)
            self.assertRegex(words, reported)
            self.assertNotIn("damaged", words)

    def test_damaged_journal(self):
        """The journal of earlier results has two copies, one of which may be damaged."""
        scene = [CYCLIC, EVERY_STEP, QUIET]
        self.go(*scene, output="whole")
        for name in ("journal", "journal_copy"):
            for damage in (lambda path, content: path.write_bytes(content[:200] + bytes([content[200] ^ 1]) + content[201:]),
                           lambda path, content: path.unlink()):
                self.go(*scene, "Time.end=3", "Time.steps=3")
                path = self.folder / "out/checkpoints" / name
                damage(path, path.read_bytes())
                words = self.go(*scene, restart=True)
                self.assertRegex(words, f"(?m)^warning: out/checkpoints/{name}: (is damaged|cannot be read); its intact copy is used\n$")
                self.expect_same_bits("whole", "out")
                for copy in ("journal", "journal_copy"):
                    self.assertEqual((self.folder / "out/checkpoints" / copy).read_bytes(), (self.folder / "whole/checkpoints/journal").read_bytes())
                shutil.rmtree(self.folder / "out")

    def test_no_checkpoint(self):
        self.assertIn("out/checkpoints: there is no complete checkpoint", self.go(CYCLIC, restart=True, expect=1))
        self.go(CYCLIC, "Time.end=1", "Time.steps=1", EVERY_STEP, QUIET)
        piece = self.checkpoints()[0] / "piece_0.h5"
        content = bytearray(piece.read_bytes())
        content[len(content) // 2] ^= 1
        piece.write_bytes(content)
        results = self.results()
        words = self.go(CYCLIC, restart=True, expect=1)
        self.assertRegex(words, "there is no complete checkpoint to continue from; .*piece_0.h5: is damaged")
        self.assertEqual(self.results(), results)

    def test_no_checkpoint_of_another_run(self):
        self.go(CYCLIC, "Time.end=1", "Time.steps=1", EVERY_STEP, QUIET)
        self.go(CYCLIC, "Time.end=1", "Time.steps=2", QUIET)
        self.assertIn("there is no complete checkpoint", self.go(CYCLIC, restart=True, expect=1))

    def test_pictures_go_on(self):
        scene = [CYCLIC, "Output.checkpoints.steps=2", "Output.every=1"]
        self.go(*scene, output="whole", ranks=2)
        self.go(*scene, "Time.end=5", "Time.steps=5", ranks=2)
        shutil.rmtree(self.checkpoints()[-1])  # as after a kill in step 5
        self.go(*scene, "Time.end=4", "Time.steps=4", ranks=2, restart=True)
        self.assertEqual(len(self.results()["steps"]), 4)
        self.assertEqual((self.folder / "out/bulk.pvd").read_text().count("<DataSet"), 4)
        self.go(*scene, ranks=2, restart=True)
        for name in ("bulk.pvd", "fractures.pvd"):
            self.assertEqual((self.folder / "out" / name).read_text(), (self.folder / "whole" / name).read_text())
        self.assertEqual(self.results()["restarts"], [4])

    def test_by_the_clock(self):
        self.go(CYCLIC, "Output.checkpoints.minutes=1000", QUIET)
        self.assertEqual(len(self.checkpoints()), 1)  # after the last step
        self.go(CYCLIC, "Output.checkpoints.minutes=1e-9", QUIET, output="often")
        self.assertEqual([f.name for f in self.checkpoints("often")], ["6", "7"])


if __name__ == "__main__":
    main()
