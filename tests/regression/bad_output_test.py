#!/usr/bin/env python3
"""Error messages for bad output folders and command lines, see bad_input.py."""
import os
import resource
import shutil
import signal
import subprocess

from bad_input import BadInput, PUSH, setUpModule  # noqa: F401
import program
from program import ALONE, TIME_LIMIT, main


class Outputs(BadInput):
    def test_directory(self):
        (self.folder / "file").write_text("")
        for path in ("file", "file/below", "/dev/null/below"):
            self.refuse([f"{path}: cannot be created as a directory: "], "run", self.scene(PUSH), "--output", path)
        for path in ("/proc/self/fd", "/proc/self/fd/below"):
            err = self.refuse([f"sprekk: {path}: cannot be "], "run", self.scene(PUSH), "--output", path)
            self.assertNotIn("filesystem error", err)

    def test_directory_of_another_user(self):
        """Without permissions it is unknown whether the directory exists."""
        prefix = ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"] if os.geteuid() == 0 else []
        if prefix and not shutil.which(prefix[0]):
            self.skipTest("root reads everything")
        closed = self.folder / "closed"
        closed.mkdir()
        (closed / "out").mkdir()
        self.folder.chmod(0o755)
        closed.chmod(0)
        for output in ("closed/out", "closed/new"):
            done = subprocess.run([*prefix, "timeout", str(TIME_LIMIT), program.PROGRAM, "run", self.scene(PUSH), "--output", output],
                                  cwd=self.folder, capture_output=True, text=True, stdin=subprocess.DEVNULL, env={**os.environ, **ALONE})
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr, f"sprekk: {output}: cannot be created as a directory: Permission denied\n")
        closed.chmod(0o755)

    def test_full_disk_at_the_end(self):
        """There is no space for a new file. The old results.json is overwritten with the error."""
        self.run_scene(PUSH, "Time.steps=400", "Output.vtu=false", output="whole")
        whole = (self.folder / "whole/results.json").stat().st_size
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (whole // 4, whole // 4))
        done = subprocess.run(["timeout", str(TIME_LIMIT), program.PROGRAM, "run", self.scene(PUSH), "--output", "out", "--set",
                               "Time.steps=400", "--set", "Output.vtu=false"], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, preexec_fn=limit, env={**os.environ, **ALONE, "PMIX_MCA_gds": "hash"})
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, "sprekk: out/results.json: cannot be written: File too large\n")
        results = self.results()
        self.assertEqual(results["status"], "failed")
        self.assertIn("File too large", results["reason"])

    def full(self, name, *options, ranks):
        """Runs a scene with the named file on a full disk."""
        (self.folder / "out" / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / "out" / (name + ".part")).symlink_to("/dev/full")
        _, err = self.call("run", self.scene(PUSH), "--output", "out", "--set", "Time.steps=3", *options, ranks=ranks, expect=1)
        self.assertEqual(err, f"sprekk: out/{name}: cannot be written: No space left on device\n")

    def test_full_disk(self):
        for ranks in (1, 3):
            self.full("results.json", ranks=ranks)
            self.full("effective_input.xml", ranks=ranks)
            self.full(f"bulk/bulk_0001_{ranks - 1}.vtu", ranks=ranks)  # in the second step
            results = self.results()
            self.assertEqual(results["status"], "failed")
            self.assertIn("No space left", results["reason"])
            self.assertEqual(len(results["steps"]), 2)
            self.assertEqual((self.folder / "out" / "bulk.pvd").read_text().count("<DataSet"), 1)
            self.assertEqual(list(self.folder.glob("out/**/*.part")), [])

    def test_earlier_results_do_not_pass_for_those_of_a_failed_run(self):
        for ranks in (1, 3):
            for wrong, words in (("Bulk.material=rok", '"rok"'), ("Bulk.body force={0, sqrt(-1-t)}", "sqrt(-1-t)")):
                self.assertEqual(self.run_scene(PUSH, ranks=ranks)["status"], "completed")
                results = self.run_scene(PUSH, wrong, ranks=ranks, expect=1)
                self.assertEqual((results["status"], results["steps"]), ("failed", []))
                self.assertIn(words, results["reason"])
            self.call("run", self.scene(PUSH), "--output", "new", "--set", "Bulk.material=rok", ranks=ranks, expect=1)
            self.assertFalse((self.folder / "new").exists())
        self.run_scene("gmsh/crossing.xml", "Mesh file.path=absent.msh", output="new", expect=1)
        self.assertIn("absent.msh: there is no such file", self.results("new")["reason"])

    def test_failed_step_is_reported_on_standard_error(self):
        limits = ["--set", "Solver.maximum iterations=1", "--set", "Time.maximum halvings=0", "--set", "Time.proximal continuation=false"]
        for ranks in (1, 3):
            out, err = self.call("run", self.scene("verification/cyclic_2d.xml"), "--output", "out", *limits, ranks=ranks, expect=3)
            self.assertNotIn("no convergence", out)
            self.assertEqual(err.count("no convergence in 1 iterations"), 1, err)



class CommandLine(BadInput):
    def test_status_2(self):
        scene = self.scene(PUSH)
        self.refuse(["--sett"], "run", scene, "--sett", "a=1", status=2)
        self.refuse(["scene"], "run", status=2)
        self.refuse(["--output: is empty, must name a directory"], "run", scene, "--output", "", status=2)
        self.refuse(["not expected: 4}; blanks and braces need quotes: --set "], "check", scene, "--set", "a={4,", "4}", status=2)

    def test_overrides_are_input(self):
        scene = self.scene(PUSH)
        self.refuse(['override "foo": has no "="'], "check", scene, "--set", "foo")
        self.refuse(['override "=3": has an empty name'], "check", scene, "--set", "=3")

    def test_missing_files_are_wrong_input(self):
        for command in ("run", "check", "point", "mesh-info"):
            self.refuse(["absent: there is no such file"], command, "absent")


if __name__ == "__main__":
    main()
