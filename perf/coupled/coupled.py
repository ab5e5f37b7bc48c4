"""Robustness of coupled flow, heat and deformation: runs scenes drawn at random, and checks their results."""
from dataclasses import dataclass, field

from perf.common import options as common
from perf.common import program, table
from perf.common.scene_file import save
from perf.contact import drawn_runs, other_ways
from perf.coupled import checks, coupled_scenes
from perf.coupled.written import Written

LIMITS = {"cpu": 60, "clock": 600}
COLUMNS = {**dict.fromkeys(("scene", "cells", "steps", "median", "max", "cuts"), "g"),
           **dict.fromkeys(("fluid", "energy", "overshoot", "contact", "difference"), ".0e"), "also": "", "seconds": ".1f"}
MEASURED = list(COLUMNS)[6:11]
ATTEMPTS = 10
# scenes with these messages are drawn again
NO_SCENE = ("slip would produce energy", "too large for the cell at", "the hydraulic aperture is")


@dataclass
class Judged:
    """Results of a scene. `numbers` contains the values of COLUMNS from "fluid" on."""
    ended: object
    written: object = None
    wrong: list = field(default_factory=list)      # failures
    violations: list = field(default_factory=list)
    ranks: list = field(default_factory=list)
    numbers: dict = field(default_factory=dict)


def judge(ended, directory):
    """Checks exit status, balances, bounds and laws of one run."""
    run = Judged(ended)
    if ended.status is None:
        run.wrong.append(f"no end within {LIMITS['cpu']} s of a processor")
    elif ended.status != 0:
        run.wrong.append(f"status {ended.status}: {ended.reason}")
    if not ended.results.get("steps") or not (directory / "bulk.pvd").is_file():
        return run
    run.written = Written(directory, ended.results)
    if not run.written.states or ended.status is None:
        return run
    log = (directory / "log.txt").read_text()
    run.violations += checks.finite(run.written) + checks.apertures(run.written)
    if ended.status == 0:
        lines, (run.numbers["fluid"], run.numbers["energy"]) = checks.balances(run.written)
        run.violations += lines
    lines, run.numbers["overshoot"] = checks.temperatures(run.written, log)
    run.violations += lines
    lines, run.numbers["contact"] = checks.contact(run.written)
    run.violations += lines
    return run


def ways(options, k):
    """Returns the other ways in which scene k is run."""
    return other_ways.WAYS if options.all_ways else other_ways.WAYS[k % len(other_ways.WAYS):][:1]


def draw_and_run(options, k):
    """Draws and runs scene k of the seed; returns (drawn, scene file, directory, ended run)."""
    for attempt in range(ATTEMPTS):
        drawn = coupled_scenes.draw_scene(options.seed, k, attempt)
        scene = options.output / "drawn" / f"{drawn.name}.xml"
        save(drawn.tree, scene, drawn.comment)
        directory = options.output / "runs" / drawn.name / "first"
        ended = program.run(options.binary, scene, directory, other_ways.entries(ways(options, k)), **LIMITS)
        if ended.status != 1 or not any(words in ended.words for words in NO_SCENE):
            break
    return drawn, scene, directory, ended


def run_one(options, k):
    """Draws, runs and judges scene k; saves its file if a check failed."""
    drawn, scene, directory, ended = draw_and_run(options, k)
    try:
        run = judge(ended, directory)
        if not run.wrong and run.written:
            compared = other_ways.compare(ways(options, k), scene, ended, options.binary, LIMITS)
            run.numbers |= {"also": compared.ways, "difference": compared.largest}
            run.ranks += compared.of_ranks
            run.violations += compared.of_others
    except Exception as error:  # e.g. unreadable files; the other scenes continue
        if options.jobs == 1 and options.trace:
            raise
        run = Judged(ended, wrong=[f"could not be judged: {type(error).__name__}: {error}"])
    row = values(drawn.name, run)
    verdict = "hang" if ended.status is None else "failed" if run.wrong else "violation" if run.violations else "ok"
    outcome = drawn_runs.Outcome(drawn.name, line(row), row, verdict, run.wrong + run.violations, run.ranks, ended.newton, run.numbers.get("difference"))
    drawn_runs.keep_or_remove(options.output, scene, directory.parent, outcome.what + outcome.ranks)
    return outcome


def values(name, run):
    """Returns the values of COLUMNS."""
    newton = run.ended.newton or [0]
    counts = [run.ended.results.get("mesh", {}).get("cells"), len(run.ended.steps), sorted(newton)[len(newton) // 2], max(newton), run.ended.cuts]
    also = ", ".join(run.numbers.get("also", []))
    return [name, *counts, *(run.numbers.get(key) for key in MEASURED), also, run.ended.seconds]


def line(row):
    *first, also, seconds = row
    words = seconds if isinstance(seconds, str) else f"{seconds:.1f}"
    return table.line(first, dict(list(COLUMNS.items())[:11]), width=24) + f"  {also:12}{words:>6}"


def main(words):
    parser = common.parser("coupled", __doc__, None, "scenes", sets=False)
    drawn_runs.add_options(parser)
    parser.set_defaults(random=100)
    other_ways.add_option(parser)
    parser.add_argument("--trace", action="store_true", help="with --jobs 1: stop at an internal error of the checks")
    options = parser.parse_args(words)
    names = {k: coupled_scenes.draw_scene(options.seed, k).name for k in range(options.random)}
    command = f"./sprekk perf coupled --random {options.random} --seed {options.seed}"
    return drawn_runs.run_all(options, names, run_one, line(COLUMNS) + "  verdict", COLUMNS, command)
