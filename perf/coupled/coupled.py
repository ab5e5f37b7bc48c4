"""Robustness of coupled flow, heat and deformation: runs scenes drawn at random, and checks their results."""
import re
import shutil
from dataclasses import dataclass, field
import xml.etree.ElementTree as xml

from perf.common import options as common
from perf.common import program, table
from perf.common.scene_file import save
from perf.contact import drawn_runs
from perf.coupled import checks, coupled_scenes, differences
from perf.coupled.written import Written

LIMITS = {"cpu": 60, "clock": 600}
COLUMNS = {**dict.fromkeys(("scene", "cells", "steps", "median", "max", "cuts"), "g"),
           **dict.fromkeys(("fluid", "energy", "overshoot", "contact", "difference"), ".0e"), "also": "", "seconds": ".1f"}
MEASURED = list(COLUMNS)[6:11]
AGAIN = ("2 ranks", "renamed", "restart", "3 ranks", "renumbered", "repeated")  # scene k is run in way k of these, too
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


def again(options, way, scene, directory, run):
    """Runs the scene in another way. Returns (largest difference, messages)."""
    other = directory.with_name(re.sub(r"\W", "_", way))
    ranks, entries, rename = 1, (), str
    if way.endswith("ranks"):
        ranks = int(way[0])
    elif way == "renumbered":
        entries = ("Mesh.renumbering seed=7",)
    elif way == "renamed":
        scene, rename = renamed(scene)
    elif way == "restart":
        return restarted(options, scene, directory, run)
    ended = program.run(options.binary, scene, other, entries, ranks, **LIMITS)
    if ended.status != run.ended.status:
        return None, [f"{way}: status {ended.status} instead of {run.ended.status}: {ended.reason}"]
    return compared(way, run, Written(other, ended.results), 0.0 if way == "repeated" else checks.DIFFERENCE, rename)


def restarted(options, scene, directory, run):
    """Repeats the last step from the checkpoint before it. The results must be bitwise identical."""
    other = directory.with_name("restart")
    shutil.copytree(directory, other)
    checkpoints = sorted((folder for folder in (other / "checkpoints").iterdir() if folder.is_dir() and folder.name.isdigit()),
                         key=lambda folder: int(folder.name))
    if len(checkpoints) < 2:
        return None, [f"restart: {len(checkpoints)} checkpoints after {len(run.ended.results['steps'])} steps"]
    shutil.rmtree(checkpoints[-1])
    ended = program.run(options.binary, scene, other, CHECKPOINTS, **LIMITS, words=("--restart",), clear=False)
    if ended.status != 0 or not ended.results.get("restarts"):
        return None, [f"restart: status {ended.status}: {ended.last_line}"]
    return compared("restart", run, Written(other, ended.results), 0.0)


def compared(way, run, other, allowed, rename=str):
    size, what = differences.largest(run.written, other, rename)
    wrong = [] if size <= allowed else [f"{way}: {what} differs by {size:.1e} of the largest"]
    return size, wrong


def renamed(scene):
    """Writes a copy of the scene with fractures renamed in the opposite order. Returns (file, map to the old names)."""
    tree = xml.parse(scene)
    names = [node.get("name") for node in tree.getroot().find("ParameterList[@name='Fractures']")]
    new = {name: f"g{len(names) - k:02}" for k, name in enumerate(names)}
    for path in ("ParameterList[@name='Fractures']", "ParameterList[@name='Mesh']/ParameterList[@name='fractures']"):
        for node in tree.getroot().findall(f"{path}/ParameterList"):
            node.set("name", new[node.get("name")])
    for node in tree.getroot().iter("Parameter"):
        if node.get("name") == "fracture":
            node.set("value", new[node.get("value")])
        elif node.get("name") == "cuts":
            node.set("value", "{" + ", ".join(new[name.strip()] for name in node.get("value").strip("{}").split(",")) + "}")
    copy = scene.with_suffix(".renamed.xml")
    tree.write(copy)
    back = {value: key for key, value in new.items()}
    return copy, lambda name: back.get(name, name)


CHECKPOINTS = ("Output.checkpoints.steps=1",)


def ways(options, k, run):
    """Returns the other ways in which scene k is run."""
    chosen = AGAIN if options.all_ways else AGAIN[k % len(AGAIN):][:1]
    no_fractures, one_step = run.written.states[0].fractures is None, len(run.ended.results["steps"]) < 2
    return [way for way in chosen if not (way == "renamed" and no_fractures or way == "restart" and one_step)]


def draw_and_run(options, k):
    """Draws and runs scene k of the seed; returns (drawn, scene file, directory, ended run)."""
    for attempt in range(ATTEMPTS):
        drawn = coupled_scenes.draw_scene(options.seed, k, attempt)
        scene = options.output / "drawn" / f"{drawn.name}.xml"
        save(drawn.tree, scene, drawn.comment)
        directory = options.output / "runs" / drawn.name / "first"
        entries = CHECKPOINTS if options.all_ways or AGAIN[k % len(AGAIN)] == "restart" else ()
        ended = program.run(options.binary, scene, directory, entries, **LIMITS)
        if ended.status != 1 or not any(words in ended.words for words in NO_SCENE):
            break
    return drawn, scene, directory, ended


def run_one(options, k):
    """Draws, runs and judges scene k; saves its file if a check failed."""
    drawn, scene, directory, ended = draw_and_run(options, k)
    try:
        run = judge(ended, directory)
        run.numbers["also"] = []
        if not run.wrong and run.written:
            for way in ways(options, k, run):
                size, lines = again(options, way, scene, directory, run)
                run.numbers["also"].append(way)
                run.numbers["difference"] = max(size or 0.0, run.numbers.get("difference") or 0.0)
                (run.ranks if way.endswith("ranks") else run.violations).extend(lines)
    except Exception as error:  # e.g. unreadable files; the other scenes continue
        if options.jobs == 1 and options.trace:
            raise
        run = Judged(ended, wrong=[f"could not be judged: {type(error).__name__}: {error}"])
    row = values(drawn.name, run)
    verdict = "hang" if ended.status is None else "failed" if run.wrong else "violation" if run.violations else "ok"
    outcome = drawn_runs.Outcome(drawn.name, line(row), row, verdict, run.wrong + run.violations, run.ranks, ended.newton)
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
    parser.add_argument("--all-ways", action="store_true", help="also run each scene in all other ways: on several ranks, from a checkpoint, renamed, ...")
    parser.add_argument("--trace", action="store_true", help="with --jobs 1: stop at an internal error of the checks")
    options = parser.parse_args(words)
    names = {k: coupled_scenes.draw_scene(options.seed, k).name for k in range(options.random)}
    command = f"./sprekk perf coupled --random {options.random} --seed {options.seed}"
    return drawn_runs.run_all(options, names, run_one, line(COLUMNS) + "  verdict", COLUMNS, command)
