"""Runs the program in a temporary folder, on one rank or several."""
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

# Command-line arguments: the program, the folder with xml/, mpiexec.
PROGRAM, ROOT, MPIEXEC = (Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3]) if len(sys.argv) > 3 else (None, None, None)
if ROOT:
    sys.path[1:1] = [str(ROOT / folder) for folder in (".", "apps/plot", "apps/report")]
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_create_session_dirs": "0"}  # without a daemon of Open MPI
TIME_LIMIT = 600  # seconds, for calls that hang; their status is then 124


class ProgramTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def scene(self, name):
        return ROOT / "xml" / name

    def call(self, *arguments, ranks=1, expect=0):
        """Returns standard output and error. Fails after a timeout or for another status."""
        command = [str(PROGRAM), *map(str, arguments)]
        if ranks > 1:
            command = [MPIEXEC, "--quiet", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)] + command
        done = subprocess.run(["timeout", str(TIME_LIMIT), *command], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, env={**os.environ, **(ALONE if ranks == 1 else {})})
        self.assertEqual(done.returncode, expect, f"{command}\n{done.stdout}{done.stderr}")
        return done.stdout, done.stderr

    def run_scene(self, name, *overrides, ranks=1, expect=0, output="out"):
        """Runs a scene and returns its results."""
        sets = [word for override in overrides for word in ("--set", override)]
        scene = name if os.path.isabs(name) else self.scene(name)
        self.call("run", scene, "--output", output, *sets, ranks=ranks, expect=expect)
        return self.results(output)

    def results(self, output="out"):
        return json.loads((self.folder / output / "results.json").read_text())


def main():
    unittest.main(argv=sys.argv[:1])
