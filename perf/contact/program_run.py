"""Runs scenes with the program on one or several ranks, under time limits."""
import json
import os
import shutil
import subprocess
import time
from dataclasses import dataclass, field

ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_create_session_dirs": "0"}  # no Open MPI daemon
STOPPED = (124, 137, -9)  # exit statuses after a time limit


@dataclass
class Limits:
    processor: int = 120  # CPU seconds of each rank
    clock: int = 900      # wall-clock seconds, which depend on the load of the machine


@dataclass
class Ended:
    """Result of a run. `status` is None after a time limit; `results` is the content of results.json."""
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
    """Runs a scene into a directory. With `anew` the directory is emptied first."""
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
