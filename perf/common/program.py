"""Starts programs under time limits and reads the results of runs."""
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_create_session_dirs": "0"}  # no Open MPI daemon
STOPPED = (124, 137, -9)  # exit statuses after a time limit
STATES = ("stick", "slip", "open")
TIMERS = {"set-up": ("set-up_of_the_solver", "set-up_of_linear_solver"),
          "assembly": ("assembly_of_the_linear_part", "loads", "residual", "Jacobian", "local_elimination"),
          "solve": ("linear_solve",)}


class Failed(RuntimeError):
    """Failure of a program whose results are required; the message contains the reason."""


@dataclass
class Run:
    """Result of a run. `status` is None after a time limit."""
    directory: Path = None
    status: int = 0
    words: str = ""        # standard output and error
    seconds: float = 0     # of the clock
    results: dict = field(default_factory=dict)  # content of results.json
    failure: str = ""      # reason of a failure

    @property
    def last_line(self):
        return last_line(self.words)

    @property
    def reason(self):
        return self.results.get("reason") or self.last_line

    @property
    def steps(self):
        return self.results.get("steps", [])

    @property
    def newton(self):
        """Newton iterations of each step."""
        return [step["newton_iterations"] for step in self.steps]

    @property
    def mean_newton(self):
        """Mean number of iterations over the steps without bisection; over all steps if all were bisected."""
        uncut = [step for step in self.steps if step["cuts"] == 0] or self.steps
        return sum(step["newton_iterations"] for step in uncut) / max(1, len(uncut))

    @property
    def cuts(self):
        return sum(step["cuts"] for step in self.steps)

    @property
    def unknowns(self):
        """Number of displacement unknowns."""
        return self.unknowns_of("displacement")

    def unknowns_of(self, name):
        return sum(f["unknowns"] for f in self.results.get("blocks", {}).get("fields", []) if f["name"] == name)

    @property
    def system(self):
        """Number of unknowns of the linear system, without eliminated blocks."""
        blocks = self.results["blocks"]
        eliminated = {name for group in blocks.get("local_groups", []) for name in group["blocks"]}
        return sum(f["unknowns"] for f in blocks["fields"] if f["name"] not in eliminated)

    @property
    def solves(self):
        return [solve for step in self.steps for solve in step.get("linear_solves", [])]

    @property
    def krylov(self):
        """Iterations of each linear solve; the mean of the step if it does not list its solves."""
        counts = []
        for step in self.steps:
            solves = step["newton_iterations"]
            counts += [solve["iterations"] for solve in step["linear_solves"]] if "linear_solves" in step \
                else [step["linear_iterations"] / max(1, solves)] * solves
        return counts

    @property
    def mean(self):
        return sum(self.krylov) / max(1, len(self.krylov))

    @property
    def maximum(self):
        return max(self.krylov, default=0)

    @property
    def residual(self):
        """Largest true relative residual of the linear solves used by Newton's method; None if it is not recorded."""
        return max((solve["residual"] for solve in self.solves if solve["used"]), default=None)

    @property
    def max_used(self):
        """Largest number of iterations of a linear solve used by Newton's method."""
        return max((solve["iterations"] for solve in self.solves if solve["used"]), default=0)

    @property
    def max_given_up(self):
        """Largest number of iterations of a linear solve in a failed attempt of Newton's method."""
        return max((solve["iterations"] for solve in self.solves if not solve["used"]), default=0)

    def fraction(self, state):
        """Fraction of the area of all fractures in this contact state at the end."""
        fractures = self.steps[-1].get("fractures", {}).values() if self.steps else []
        area = sum(f["area"] for f in fractures)
        return sum(f["area"] * f[f"fraction_{state}"] for f in fractures) / max(1e-300, area)

    @property
    def fractions(self):
        return [self.fraction(state) for state in STATES]

    def time(self, *phases, clock="seconds"):
        """Seconds of phases of the program; `clock` is "seconds" or "cpu_seconds"."""
        timing = self.results.get("timing", {})
        return sum(timing[name][clock] for name in phases if name in timing)

    @property
    def times(self):
        """Seconds of set-up, assembly and solution, see TIMERS."""
        return [self.time(*phases) for phases in TIMERS.values()]

    @property
    def total_time(self):
        return sum(self.times)

    @property
    def cells(self):
        return self.results.get("mesh", {}).get("cells", 0)

    @property
    def bytes(self):
        """Peak resident memory: (all ranks, largest rank)."""
        memory = self.results.get("memory", {})
        return memory.get("peak_bytes_all_ranks", 0), memory.get("peak_bytes_largest_rank", 0)


def cpu_seconds():
    """CPU seconds of all completed child processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def last_line(words):
    """Last line that contains letters."""
    return next((line for line in reversed(words.splitlines()) if re.search("[A-Za-z]", line)), "no word").strip()


def sets(entries):
    return [word for entry in entries for word in ("--set", entry)]


def command(binary, scene, directory, entries=()):
    """Command of a run; the path of the scene is absolute or relative to xml/."""
    return [str(binary), "run", str(ROOT / "xml" / scene), "--output", str(directory), *sets(entries)]


def on_ranks(ranks, command):
    if ranks == 1:
        return command
    return ["mpirun", "--quiet", "--oversubscribe", "--bind-to", "none", "-np", str(ranks), *command]


def started(command, ranks=1, limits=(), **environment):
    """Runs a command without a shell; returns the completed process with the text of its output."""
    words = [str(word) for word in (*limits, *on_ranks(ranks, command))]
    return subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env={**os.environ, "OMP_NUM_THREADS": "1", **(ALONE if ranks == 1 else {}), **environment})


def checked(command, ranks=1, **environment):
    """Standard output of a command. Raises Failed if its status is not 0."""
    done = started(command, ranks, **environment)
    if done.returncode:
        raise Failed(done.stderr.strip() or f"{Path(command[0]).name}: status {done.returncode}")
    return done.stdout


def measured(options, scene, entries, ranks):
    """Returns the JSON output of options.program for a scene with these entries, then those of the command line."""
    return json.loads(checked([options.program, ROOT / "xml" / scene, *entries, *options.set], ranks))


def run(binary, scene, directory, entries=(), ranks=1, cpu=None, clock=3600, words=(), clear=True, kind=Run):
    """Runs a scene into a directory, which is emptied first (`clear`); limits in CPU seconds per rank and in seconds.

    A failed program is recorded in the result, which is of the class `kind`."""
    if clear:
        shutil.rmtree(directory, ignore_errors=True)
    limited = ["prlimit", f"--cpu={cpu}"] if cpu else []
    begin = time.monotonic()
    limits = ("timeout", "--kill-after=5", clock)
    done = started([*limited, *command(binary, scene, directory, entries), *words], ranks, limits)
    status = None if done.returncode in STOPPED else done.returncode
    found = kind(directory, status, done.stdout + done.stderr, time.monotonic() - begin)
    if (directory / "results.json").is_file():
        found.results = json.loads((directory / "results.json").read_text())
    return found


def succeeded(*arguments, **options):
    """Runs a scene as run(). Raises Failed if it fails."""
    found = run(*arguments, **options)
    if found.status != 0:
        raise Failed(f"status {found.status}: {found.reason}" if found.status else "no end within the time limit")
    return found


def mesh(binary, scene, file, entries=()):
    """Generates the mesh of a scene with a fracture network; returns the file. Raises Failed if it fails."""
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    program = [sys.executable, "-B", ROOT / "apps/mesh", "--program", binary]
    checked([*program, ROOT / "xml" / scene, "-o", file, "--quiet", *sets(entries)])
    return file
