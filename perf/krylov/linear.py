"""Runs a scene with the iterative solver and reads the counts and times of linear solves from results.json."""
import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "apps/plot"))

SCENE = "performance/blocks_3d.xml"
SOLVER = "Solver.Linear solver"
RESIDUAL = 1e-8  # relative tolerance of every linear solve
ROUNDING = 10    # allowed ratio of the true residual to the residual updated by the Krylov method
ALWAYS = (f"{SOLVER}.type=iterative", f"{SOLVER}.tolerance={RESIDUAL:g}", f"{SOLVER}.forcing=false")
STATES = ("stick", "slip", "open")
LISTED = 12  # number of names in a message
TIMERS = {"set-up": ("set-up_of_the_solver", "set-up_of_linear_solver"),
          "assembly": ("assembly_of_the_linear_part", "loads", "residual", "Jacobian", "local_elimination"),
          "solve": ("linear_solve",)}


@dataclass
class Run:
    """Results of a run; `failure` contains the reason if it failed."""
    results: dict
    failure: str = ""

    @property
    def steps(self):
        return self.results.get("steps", [])

    @property
    def unknowns(self):
        """Number of displacement unknowns."""
        fields = self.results.get("blocks", {}).get("fields", [])
        return next((f["unknowns"] for f in fields if f["name"] == "displacement"), 0)

    @property
    def newton(self):
        """Mean number of iterations over the steps without bisection; over all steps if all were bisected."""
        uncut = [step for step in self.steps if step["cuts"] == 0] or self.steps
        return sum(step["newton_iterations"] for step in uncut) / max(1, len(uncut))

    @property
    def cuts(self):
        return sum(step["cuts"] for step in self.steps)

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
    def most(self):
        return max(self.krylov, default=0)

    @property
    def residual(self):
        """Largest true relative residual of the linear solves used by Newton's method; None if it is not recorded."""
        return max((solve["residual"] for solve in self.solves if solve["used"]), default=None)

    @property
    def most_used(self):
        """Largest number of iterations of a linear solve used by Newton's method."""
        return max((solve["iterations"] for solve in self.solves if solve["used"]), default=0)

    @property
    def most_given_up(self):
        """Largest number of iterations of a linear solve in a failed attempt of Newton's method."""
        return max((solve["iterations"] for solve in self.solves if not solve["used"]), default=0)

    @property
    def lost(self):
        """Number of failed linear solves in abandoned attempts of Newton's method."""
        return sum(not solve["used"] and solve["residual"] > ROUNDING * RESIDUAL for solve in self.solves)

    def fraction(self, state):
        """Fraction of the area of all fractures in this contact state at the end."""
        fractures = self.steps[-1].get("fractures", {}).values() if self.steps else []
        return sum(f["area"] * f[f"fraction_{state}"] for f in fractures) / max(1e-300, sum(f["area"] for f in fractures))

    def seconds(self, what):
        timing = self.results.get("timing", {})
        return sum(timing[name]["seconds"] for name in TIMERS[what] if name in timing)

    @property
    def bytes(self):
        """Peak resident memory: (all ranks, largest rank)."""
        memory = self.results.get("memory", {})
        return memory.get("peak_bytes_all_ranks", 0), memory.get("peak_bytes_largest_rank", 0)


def run(options, sets, directory, ranks=1, time_limit=3600, scene=SCENE, residual=lambda run: run.residual):
    """Runs the scene with these entries, then those of the command line. A failed program is recorded in
    `failure`, without exception.

    residual(run) must be below the tolerance times ROUNDING."""
    directory = options.output / directory
    shutil.rmtree(directory, ignore_errors=True)
    done = started(["timeout", "--kill-after=5", str(time_limit), *on_ranks(ranks, command(options, sets, directory, scene))])
    file = directory / "results.json"
    found = Run(json.loads(file.read_text()) if file.is_file() else {})
    if done.returncode in (124, 137, -9):  # timeout exits like the program it stopped
        found.failure = f"no end within {time_limit} s"
    elif done.returncode:
        words = [line for line in done.stderr.splitlines() if line.strip("- ")]
        found.failure = found.results.get("reason") or (words or ["no word"])[-1]
    elif (residual(found) or 0) > ROUNDING * RESIDUAL:
        found.failure = f"true residual {residual(found):.1e} after a linear solve"
    return found


def command(options, sets, directory, scene=SCENE):
    words = [str(options.binary), "run", str(ROOT / "xml" / scene), "--output", str(directory)]
    return words + [word for entry in (*ALWAYS, *sets, *options.set) for word in ("--set", entry)]


def on_ranks(ranks, command):
    return ["mpirun", "--quiet", "--oversubscribe", "--bind-to", "none", "-np", str(ranks), *command] if ranks > 1 else command


def started(command):
    return subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"})


def measured(options, scene, sets, ranks):
    """Returns the JSON output of a measurement program for a scene with these entries, then those of the command
    line."""
    done = started(on_ranks(ranks, [str(options.program), str(ROOT / "xml" / scene), *sets, *options.set]))
    if done.returncode:
        sys.exit(done.stderr.strip())
    return json.loads(done.stdout)


def table(shear, **values):
    """Entries for the displacements of the sides; xy, xz, yz are `shear` unless given."""
    return tuple(f"Tables.{name}.values={{0, {value}}}" for name, value in {"xy": shear, "xz": shear, "yz": shear, **values}.items())


def cells(x, y=None, z=None):
    return (f"Mesh.cells={{{x}, {y or x}, {z or x}}}",)


def joint(**entries):
    names = dict(stiffness="tangential stiffness", friction="friction coefficient", dilation="dilation angle",
                 closure="maximum closure", normal="normal stiffness")
    return tuple(f"Materials.joint.{names[key]}={value}" for key, value in entries.items())


def pattern(words):
    """Parses a regular expression of an option."""
    try:
        return re.compile(words).pattern
    except re.error as error:
        raise argparse.ArgumentTypeError(f'"{words}" is no regular expression: {error}') from None


def count(words):
    """Parses a number of ranks or cells of an option."""
    if not words.isdecimal() or int(words) < 1:
        raise argparse.ArgumentTypeError(f'"{words}" is no whole number from 1 on')
    return int(words)


def matching(options, rows, name=str):
    """Returns the rows whose name matches --only. Without a match the program exits with a usage error."""
    found = [row for row in rows if re.search(options.only, name(row))]
    if not found:
        names = [f'"{each}"' for each in dict.fromkeys(map(name, rows))]
        options.refuse(f'argument --only: "{options.only}" matches none of {", ".join(names[:LISTED])}{" ..." if len(names) > LISTED else ""}')
    return found


def add_only(parser, what="rows"):
    parser.add_argument("--only", type=pattern, metavar="PATTERN", default="", help=f"{what} whose name matches this regular expression")
    parser.set_defaults(refuse=parser.error)


def parser(name, text, program=False, only=True):
    """Returns the common options of all measurements; --program replaces --binary if the measurement has a program
    of its own."""
    made = argparse.ArgumentParser(prog=f"sprekk perf {name}", description=text)
    made.add_argument("--quick", action="store_true", help="a small version, for a test; the status is 1 if a bound on counts is missed")
    if only:
        add_only(made)
    made.add_argument("--set", metavar="PATH=VALUE", action="append", default=[], help="an entry of every scene, as for `sprekk run`; may be repeated")
    made.add_argument("--output", type=Path, default=Path(f"output/perf/{name}"), metavar="DIR")
    if program:
        made.add_argument("--program", type=Path, default=ROOT / f"build/perf/{name}/{name}", help=f"the compiled {name}.cpp")
    else:
        made.add_argument("--binary", type=Path, default=ROOT / "build/apps/sprekk/sprekk", help="the program")
    return made


class Table:
    """Rows printed as they are added, and written to a CSV file."""

    def __init__(self, columns, width=34):
        self.columns, self.width, self.rows = columns, width, []  # columns: {name: format}
        print(self.line(["", *list(columns)[1:]], {name: "" for name in columns}), flush=True)

    def line(self, values, formats):
        words = ["-" if value is None else format(value, how) for value, how in zip(values, formats.values())]
        return f"{words[0]:{self.width}}" + "".join(f"{word:>{max(7, len(name) + 2)}}" for name, word in zip(list(formats)[1:], words[1:]))

    def add(self, values, notes=()):
        self.rows.append(list(values))
        print("\n".join([self.line(values, self.columns), *(f"  {note}" for note in notes)]), flush=True)

    def write(self, file):
        with open(file, "w", newline="") as opened:
            writer = csv.writer(opened)
            writer.writerow(self.columns)
            writer.writerows(self.rows)


def missed(values, bounds):
    """Returns a message for each value above its bound."""
    return [f"missed: {name} = {values[name]:.3g}, the bound is {bound:g}" for name, bound in bounds.items() if not values[name] <= bound]
