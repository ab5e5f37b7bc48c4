"""Runs scenes by the program, on one rank or several, under limits of time."""
import json
import os
import shutil
import subprocess
import time
from dataclasses import dataclass, field

ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_create_session_dirs": "0"}  # without a daemon of Open MPI
STOPPED = (124, 137, -9)  # statuses after these limits


@dataclass
class Limits:
    processor: int = 120  # s, of each rank
    clock: int = 900      # s; those on the clock depend on what else runs


@dataclass
class Ended:
    """`status` is None after a limit. `results`: of results.json."""
    status: int
    words: str
    seconds: float
    results: dict = field(default_factory=dict)

    @property
    def last_line(self):
        return last_line(self.words)

    @property
    def newton(self):
        return [step["newton_iterations"] for step in self.results.get("steps", [])]


def last_line(words):
    return (words.strip().splitlines() or ["no word"])[-1]


def run(binary, scene, directory, ranks=1, words=(), limits=Limits(), anew=True):
    """Runs a scene into a directory, which is emptied before if `anew`."""
    if anew:
        shutil.rmtree(directory, ignore_errors=True)
    command = ["prlimit", f"--cpu={limits.processor}", str(binary), "run", str(scene), "--output", str(directory), *words]
    if ranks > 1:
        command = ["mpirun", "--quiet", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)] + command
    begin = time.monotonic()
    done = subprocess.run(["timeout", "--kill-after=5", str(limits.clock), *command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1", **(ALONE if ranks == 1 else {})})
    ended = Ended(None if done.returncode in STOPPED else done.returncode, done.stdout + done.stderr, time.monotonic() - begin)
    if (directory / "results.json").is_file():
        ended.results = json.loads((directory / "results.json").read_text())
    return ended
