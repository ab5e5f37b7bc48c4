#!/usr/bin/env python3
"""Launcher ./sprekk: launcher_test.py PROGRAM ROOT MPIEXEC

Tests a copy with mock builds: arguments reach the program, exit statuses return, invalid arguments are rejected."""
import fcntl
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import program
from program import ROOT, TIME_LIMIT, ProgramTest, main

PUSH = "xml/seed/push_2d.xml"
STUBS = {"dpkg-query": 'for package in "${@:4}"; do printf "installed:%s " "$package"; done',
         "cmake": 'touch "$4/build.ninja"',
         "ninja": 'echo "[1/1] $*"; [[ ! -e broken ]] || { echo "FAILED: model.o"; exit 1; }'}


class Launcher(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(ROOT / "sprekk", self.folder)
        shutil.copy(ROOT / "CMakeLists.txt", self.folder)
        shutil.copytree(ROOT / "apps/launcher", self.folder / "apps/launcher")
        shutil.copytree(ROOT / "xml" / "seed", self.folder / "xml" / "seed")
        binary = self.folder / "build/apps/sprekk/sprekk"
        binary.parent.mkdir(parents=True)
        binary.symlink_to(program.PROGRAM)
        for name, content in STUBS.items():
            stub = self.folder / "stubs" / name
            stub.parent.mkdir(exist_ok=True)
            stub.write_text("#!/usr/bin/env bash\n" + content + "\n")
            stub.chmod(0o755)

        path = os.pathsep.join([str(self.folder / "stubs"), str(Path(program.MPIEXEC).parent), os.environ["PATH"]])
        self.surroundings = {"cwd": self.folder, "env": {**os.environ, "PATH": path}, "text": True,
                             "stdin": subprocess.DEVNULL}

    def launch(self, *words, expect=0, launcher="./sprekk"):
        done = subprocess.run(["timeout", str(TIME_LIMIT), launcher, *words], capture_output=True,
                              **self.surroundings)
        self.assertEqual(done.returncode, expect, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout, done.stderr

    def test_run_on_one_rank_and_on_several(self):
        for words, ranks in ((["--output", "out", "--set", "Time.steps=2"], 1),
                             (["--ranks", "2", "--output=out", "--set=Time.steps=2"], 2),
                             (["--ranks=3", "--output", "out", "--set", "Time.steps=2"], 3)):
            self.launch("run", PUSH, *words)
            results = self.results()
            self.assertEqual((results["status"], results["ranks"], len(results["steps"])), ("completed", ranks, 2))

    def test_statuses_of_the_program_come_back(self):
        for ranks in ("1", "3"):
            _, err = self.launch("run", PUSH, "--ranks", ranks, "--set", "Bulk.material=rok", expect=1)
            self.assertIn('"rok"', err)
            self.launch("run", PUSH, "--ranks", ranks, "--set=Time", expect=1)
            self.launch("run", PUSH, "--ranks", ranks, "--steps", "3", expect=2)
            self.launch("run", ROOT / "xml/verification/cyclic_2d.xml", "--ranks", ranks,
                        "--set", "Solver.maximum iterations=1", "--set", "Time.maximum halvings=0", expect=3)

    def test_interrupted(self):
        """Ctrl-C goes to the process group of the terminal. A second one stops a long step."""
        for ranks, cells, times, status in (("1", "{2, 2}", 1, 4), ("2", "{2, 2}", 1, 4), ("2", "{400, 400}", 2, 1)):
            with self.subTest(ranks=ranks, cells=cells):
                run = subprocess.Popen(["./sprekk", "run", PUSH, "--ranks", ranks, "--output", "out", "--set",
                                        "Time.steps=2000", "--set", "Output.vtu=false", "--set", "Mesh.cells=" + cells],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True, **self.surroundings)
                while not (self.folder / "out/results.json").exists():
                    self.assertIsNone(run.poll())
                    time.sleep(0.01)
                os.killpg(run.pid, signal.SIGINT)
                while "sprekk: stopping" not in (line := run.stderr.readline()):
                    self.assertTrue(line)
                if times == 2:
                    os.killpg(run.pid, signal.SIGINT)
                self.assertEqual(run.wait(timeout=program.TIME_LIMIT), status)
                if times == 1:
                    self.assertEqual(self.results()["status"], "interrupted")
                run.communicate()
                shutil.rmtree(self.folder / "out")

    def test_interrupted_while_the_mesh_is_made(self):
        mesher = self.folder / "apps/mesh/__main__.py"
        mesher.parent.mkdir(parents=True)
        mesher.write_text("import time\ntime.sleep(60)\n")
        run = subprocess.Popen(["./sprekk", "run", str(ROOT / "xml/networks/random_2d_100.xml"), "--output", "out"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, **self.surroundings)
        while not (self.folder / "out/.lock").exists():
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        time.sleep(0.3)
        run.send_signal(signal.SIGTERM)
        _, words = run.communicate(timeout=program.TIME_LIMIT)
        self.assertEqual(run.returncode, 4, words)
        self.assertIn("stopped before the first step", words)

    def test_words_that_are_refused(self):
        for words in ([], ["walk"], ["run"], ["run", PUSH, PUSH], ["run", PUSH, "--ranks"], ["run", PUSH, "--ranks", "0"],
                      ["run", PUSH, "--ranks", "two"], ["run", PUSH, "--rank", "2"], ["check", PUSH, "--ranks", "2"],
                      ["fuzz", "many"], ["fuzz", "1", "2"]):
            with self.subTest(words=words):
                out, err = self.launch(*words, expect=2)
                self.assertEqual(out, "")
                self.assertTrue(err)
        self.assertIn("absent.xml: there is no such file", self.launch("run", "absent.xml", expect=1)[1])
        self.assertFalse((self.folder / "build/build.log").exists())  # no builds

    def test_help_names_every_command(self):
        out, _ = self.launch("--help")
        commands = re.findall(r"^  ([a-z| -]+)\)", (ROOT / "sprekk").read_text().split("\ncase ")[-1], re.MULTILINE)
        for command in (word.strip() for line in commands for word in line.split("|")):
            if command not in ("-h", "help"):
                self.assertIn(command, out)
        self.assertEqual(self.launch("run", "--help")[0], out)

    def test_installed(self):
        """Without CMakeLists.txt the launcher neither builds nor installs; it is called through a link, anywhere."""
        home = self.folder / "prefix/lib/sprekk"
        for link, to in ((home / "apps/sprekk/sprekk", program.PROGRAM), (self.folder / "prefix/bin/sprekk", "../lib/sprekk/sprekk")):
            link.parent.mkdir(parents=True)
            link.symlink_to(to)
        shutil.copy(ROOT / "sprekk", home)
        (self.folder / "stubs/ninja").write_text("exit 1")
        (self.folder / "stubs/dpkg-query").write_text("exit 1")
        self.launch("check", PUSH, launcher="prefix/bin/sprekk")
        self.launch("run", PUSH, "--ranks", "2", "--output", "out", launcher="prefix/bin/sprekk")
        self.assertEqual(self.results()["ranks"], 2)
        self.assertEqual(self.launch("--version", launcher="prefix/bin/sprekk")[0], self.call("--version")[0])
        self.assertNotRegex(self.launch("--help", launcher="prefix/bin/sprekk")[0], "[.]/sprekk|sprekk test")
        self.assertRegex(self.launch("plot", "out", expect=1, launcher="prefix/bin/sprekk")[1],
                         "^sprekk: plot requires further packages; install them with: sudo apt-get install .*python3-vtk9\n$")
        for option in ("--help", "-h"):
            out, err = self.launch("plot", option, launcher="prefix/bin/sprekk")
            self.assertRegex(out, r"^  sprekk plot PATH[.]{3} .*\n$")
            self.assertIn("the options of plot are printed when its packages are installed: python3 ", err)
        shutil.copytree(ROOT / "xml/new", home / "xml/new")
        out, _ = self.launch("new", "slope", "a.xml", launcher="prefix/bin/sprekk")
        self.assertEqual(out, "wrote a.xml; next: sprekk run a.xml\n")
        for command in ("build", "test", "perf", "fuzz", "package", "docs"):
            self.assertEqual(self.launch(command, expect=1, launcher="prefix/bin/sprekk"),
                             ("", f"sprekk: {command} requires the source tree of Sprekk\n"))

    def test_perf_runs_a_measurement(self):
        measurement = self.folder / "perf/greet/greet.py"
        measurement.parent.mkdir(parents=True)
        measurement.write_text("def main(words):\n    print(words)\n    return 3\n")
        for name in ("__init__.py", "__main__.py", "save.py", "common"):
            (shutil.copytree if name == "common" else shutil.copy)(ROOT / "perf" / name, self.folder / "perf" / name)
        out, _ = self.launch("perf", "greet", "--quick", "--only", "a b", expect=3)
        self.assertEqual(out, "['--quick', '--only', 'a b']\n")
        for words in (["perf"], ["perf", "walk"], ["perf", "--help"]):
            self.assertIn("greet", self.launch(*words, expect=2)[1])

    def test_version_is_that_of_the_program(self):
        self.assertEqual(self.launch("--version")[0], self.call("--version")[0])

    def test_build_of_another_user(self):
        (self.folder / "build/.lock").mkdir()  # cannot be opened, even by root
        _, err = self.launch("check", PUSH, expect=1)
        self.assertRegex(err, "build cannot be written; it belongs to .*\n.*build/apps/sprekk/sprekk, or copy the tree")

    def test_network_beside_another_run(self):
        """The mesh is generated in the output directory, which must not be in use."""
        shutil.copy(ROOT / "xml/networks/outcrop_2d.xml", self.folder)
        maker = self.folder / "apps/mesh/__main__.py"
        maker.parent.mkdir(parents=True)
        maker.write_text("raise SystemExit('made')")
        for words in ([], ["--restart"], ["--ranks", "2"], ["--output", "output/outcrop_2d"]):
            self.assertIn("made", self.launch("run", "outcrop_2d.xml", *words, expect=1)[1])
        self.assertFalse((self.folder / "output/outcrop_2d").exists())
        (self.folder / "output/outcrop_2d").mkdir()
        with open(self.folder / "output/outcrop_2d/.lock", "w") as lock:
            lock.write("process 7 on node3\n")
            lock.flush()
            fcntl.flock(lock, fcntl.LOCK_EX)
            for words in ([], ["--restart"], ["--ranks", "2"], ["--output", "output/outcrop_2d"]):
                err = self.launch("run", "outcrop_2d.xml", *words, expect=1)[1]
                self.assertEqual(err.split("sprekk: ")[-1], "output/outcrop_2d: another run (process 7 on node3) is writing its results here; "
                                                            "wait until it has ended, or name another directory by --output\n")
            self.assertIn("made", self.launch("run", "outcrop_2d.xml", "--set", "Time.steps=2", expect=1)[1])

    def test_build_beside_another(self):
        with open(self.folder / "build/.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            run = subprocess.Popen(["./sprekk", "check", PUSH], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   **self.surroundings)
            self.assertIn("waiting for another build", run.stderr.readline())
        with run:
            self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 0)

    def test_two_first_reports(self):
        """Both calls bundle the view, one after the other; the second finds the file of the first."""
        folder = self.folder / "apps/report"
        folder.mkdir()
        for name in ("package.json", "package-lock.json", "viewer.js"):
            shutil.copy(ROOT / "apps/report" / name, folder)
        (folder / "__main__.py").write_text("import pathlib, sys\nprint(pathlib.Path(sys.argv[2]).read_text())\n")
        npm = self.folder / "stubs/npm"
        npm.write_text("#!/usr/bin/env bash\nmkdir node_modules && sleep 1 && mkdir node_modules/.bin && echo called >>calls\n"
                       "printf '#!/bin/sh\\necho bundle >${6#*=}\\n' >node_modules/.bin/esbuild && chmod +x node_modules/.bin/esbuild\n")
        npm.chmod(0o755)
        calls = [subprocess.Popen(["./sprekk", "report", "out"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, **self.surroundings)
                 for _ in range(2)]
        for call in calls:
            out, err = call.communicate(timeout=program.TIME_LIMIT)
            self.assertEqual((call.returncode, out), (0, "bundle\n\n"), err)
        self.assertEqual((self.folder / "build/report/calls").read_text(), "called\n")

    def test_log_and_quiet(self):
        for ranks in ("1", "2"):
            for words, n in (([], 1), (["--quiet"], 0)):
                out, _ = self.launch("run", PUSH, "--ranks", ranks, "--output", "out", *words)
                self.assertEqual(out.count("results in out"), n)
        for command in ("check", "point"):
            self.assertIn(f'{command} has no option "--quiet"', self.launch(command, PUSH, "--quiet", expect=2)[1])

    def test_run_goes_on_when_its_reader_ends(self):
        """mpirun would end the run when its output is closed."""
        for ranks in ("1", "2"):
            words = ["./sprekk", "run", PUSH, "--ranks", ranks, "--output", "out", "--set", "Output.vtu=false", "--set", "Time.steps=40"]
            with subprocess.Popen(words, stdout=subprocess.PIPE, **self.surroundings) as run:
                run.stdout.readline()
                run.stdout.close()
                self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 0)
            self.assertEqual((self.results()["status"], len(self.results()["steps"])), ("completed", 40))

    def test_standard_output_on_a_full_disk(self):
        for ranks in ("1", "2"):
            with open("/dev/full", "w") as full:
                done = subprocess.run(["./sprekk", "run", PUSH, "--ranks", ranks, "--output", "out"], stdout=full, stderr=subprocess.PIPE, **self.surroundings)
            reported = [line for line in done.stderr.splitlines() if "building" not in line and "configuring" not in line]
            self.assertEqual((done.returncode, len(reported)), (1, 1), done.stderr)
            self.assertRegex(reported[0], "standard output.*(cannot be written|No space left)")
            self.assertEqual(self.results()["status"], "completed")

    def test_progress_of_the_build_in_a_pipe(self):
        (self.folder / "stubs/ninja").write_text('#!/usr/bin/env bash\nfor i in {0..40}; do echo "[$i/40] Building"; done\n')
        _, err = self.launch("check", PUSH)
        self.assertEqual(re.findall("building (.*)", err), [f"{n} of 40" for n in (1, *range(4, 41, 4))])

    def test_build_that_fails(self):
        (self.folder / "broken").touch()
        out, err = self.launch("check", PUSH, expect=1)
        self.assertEqual(out, "")
        self.assertIn("FAILED: model.o", err)
        self.assertIn("the build failed", err)


if __name__ == "__main__":
    main()
