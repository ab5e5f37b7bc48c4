"""Robustness of the contact solver: runs scenes one after the other and prints a table.

Steps are those of the scene. The Newton iterations of a step include those of all substeps, also of rejected ones."""
import re
from dataclasses import dataclass, field

import numpy as np
import violation

from perf.common import options as common
from perf.common import program, table
from perf.contact import drawn_runs, other_ways
from perf.contact.scenes import scenes

LIMITS = {"cpu": 120, "clock": 900}  # seconds of the processor per rank; seconds, which depend on the load of the machine
BOUNDS = {"median": 5, "p90": 12, "worst_violation": 1e-8}  # limits of --quick when it serves as a test
FORMATS = {"median": "g", "p90": "g", "max": "g", "worst_violation": ".1e"}
COLUMNS = {**dict.fromkeys(("scene", "dim", "unknowns", "steps", "median", "max", "cuts", "failures"), "g"),
           **dict.fromkeys(("residual", "violation", "error"), ".0e"), "undirected": "g", "seconds": ".1f"}


@dataclass
class Run(program.Run):
    """Measured values of one scene. `failures` contains the messages of failed checks."""
    scene: object = None
    input: object = None
    faces: list = field(default_factory=list)
    scales: object = None
    worst: object = None
    undirected: int = 0
    error: float = None
    failures: list = field(default_factory=list)

    @property
    def dim(self):
        return self.results["mesh"]["dimension"]

    @property
    def measured(self):
        """True if the run counts in the statistics."""
        return bool(self.steps) and not self.scene.refused


def start(options, scene, ranks):
    """Runs the scene."""
    directory = options.output / re.sub(r"[^\w.+-]+", "_", scene.name) / f"{ranks}"
    run = program.run(options.binary, scene.file, directory, scene.sets, ranks, **LIMITS, kind=Run)
    run.scene = scene
    return run


def judge(run):
    """Computes violations and errors from the results and adds messages to run.failures."""
    scene = run.scene
    if scene.refused:
        said = re.search(scene.refused, run.results.get("reason", ""), re.IGNORECASE)
        if run.status in (0, None) or not said:
            run.failures.append(f"not refused as it should be: status {run.status}, {run.last_line}")
        return run
    if run.status != 0:
        run.failures.append(f"no end within {LIMITS['cpu']} s of a processor" if run.status is None
                            else f"status {run.status}: {run.last_line}")
    if not run.steps:
        return run
    if (run.directory / "fractures.pvd").is_file():
        run.input = violation.Input(run.directory / "effective_input.xml")
        run.faces, run.scales, run.worst, run.undirected = violation.largest(run.directory, run.results, run.input)
    if run.status != 0:
        return run
    if scene.exact:
        run.error = scene.exact(run)
        if not run.error <= scene.tolerance:
            run.failures.append(f"error {run.error:.1e}, allowed is {scene.tolerance:.0e}")
    if scene.newton and max(run.newton) > scene.newton:
        run.failures.append(f"{max(run.newton)} Newton iterations in a step, allowed are {scene.newton}")
    return run


def compare(run, other):
    """Compares the states on one rank and on several, face by face. Returns lines that name the differing faces.

    If a scene may have several equilibria, two different states are accepted when both satisfy the laws."""
    if len(run.faces) != len(other.faces):
        run.failures.append(f"{len(run.faces)} steps written on one rank, {len(other.faces)} on several")
        return []
    if not run.faces:
        return []
    found, notes = violation.differing(run.faces, other.faces, run.scales), []
    worst = max(run.worst.max(), other.worst.max())
    if found and run.scene.several and worst <= BOUNDS["worst_violation"]:
        notes.append(f"  two equilibria: both states obey the laws to {worst:.0e}")
    elif not all(near for *_, near in found):
        floating = [step["time"] for step in run.steps if step.get("floating") and step["time"] <= found[0][0]]
        run.failures.append("states depend on the number of ranks" + (f", from t = {floating[0]:g} on, when a piece was floating" if floating else ""))
    return notes + [f"  t = {t:g}, face at ({', '.join(f'{x:g}' for x in place)}): state {states[0]} on one rank, {states[1]} on "
                    f"several, {away:.0e} from the limit" for t, place, states, away, _ in found]


def row(run):
    """Returns the values of COLUMNS."""
    values = [run.scene.name] + [None] * (len(COLUMNS) - 1)
    if run.results.get("mesh") and run.results.get("blocks"):
        values[1:3] = run.dim, run.unknowns
    if run.steps:
        values[3:7] = len(run.steps), float(np.median(run.newton)), max(run.newton), run.cuts
        values[8] = max(max(step["measures"].values(), default=0) for step in run.steps)
        values[9] = None if run.worst is None else float(run.worst.max())
    values[7], values[10:] = len(run.failures), [run.error, run.undirected, run.seconds]
    return values


def line(values):
    return table.line(values, COLUMNS, width=28, minimum=8)


def same_counts(runs):
    """Adds a failure where scenes of one group need different numbers of iterations."""
    groups = {}
    for run in runs:
        if run.scene.group and run.steps:
            groups.setdefault(run.scene.group, run)
            if run.newton != groups[run.scene.group].newton:
                run.failures.append(f"{run.newton} Newton iterations, {groups[run.scene.group].newton} in \"{groups[run.scene.group].scene.name}\"")


def summary(runs):
    counted = [run.newton for run in runs if run.measured]
    violations = [run.worst.max() for run in runs if run.worst is not None and run.measured]
    if not counted:
        counted = [[np.nan]]
    largest = [max(newton) for newton in counted]
    return {"failures": sum(bool(run.failures) for run in runs), "median": np.median([np.median(n) for n in counted]),
            "p90": np.percentile(largest, 90, method="higher"), "max": max(largest), "worst_violation": max(violations, default=0)}


def bar_chart(runs, file, maximum=40):
    """Draws the median and largest number of iterations of each scene. Bars end at `maximum` and are labelled with
    the largest."""
    import style
    counted = [run for run in runs if run.measured]
    figure, axes = style.plt.subplots(figsize=(7, 0.6 + 0.14 * len(counted)))
    heights = range(len(counted), 0, -1)
    for run, height in zip(counted, heights):
        axes.barh(height, min(max(run.newton), maximum), color=style.LINES[0])
        axes.barh(height, min(np.median(run.newton), maximum), color=style.LINES[4])
        axes.text(min(max(run.newton), maximum) + 0.3, height, max(run.newton), va="center", fontsize=5)
    axes.set_yticks(heights, [run.scene.name for run in counted], fontsize=6)
    for run, label in zip(counted, axes.get_yticklabels()):
        label.set_color(style.LINES[3] if run.failures else style.INK)
    axes.set_xlabel("Newton iterations in a step: median (light), largest (dark); names of scenes that failed are red")
    axes.set(xlim=(0, maximum + 3), ylim=(0, len(counted) + 1))
    figure.savefig(file, dpi=150)


def main(words):
    parser = common.parser("contact", __doc__, "a third of the scenes; without --only the status is also 1 above a stated bound", "scenes", sets=False)
    parser.add_argument("--ranks", type=common.count, default=1, metavar="N", help="also run on N ranks, and compare the states")
    drawn_runs.add_options(parser)
    other_ways.add_option(parser)
    options = parser.parse_args(words)
    if options.random:
        from perf.contact import random_run
        return random_run.main(options)
    chosen = common.matching(options, [s for s in scenes() if s.quick or not options.quick], lambda scene: scene.name)
    print(line(COLUMNS))
    runs = []
    for scene in chosen:
        run, notes = judge(start(options, scene, 1)), []
        if options.ranks > 1:
            other = judge(start(options, scene, options.ranks))
            run.failures += [f"on {options.ranks} ranks: {what}" for what in other.failures]
            notes = compare(run, other) if not run.failures else []
        runs.append(run)
        print("\n".join([line(row(run))] + [f"  {what}" for what in run.failures] + notes), flush=True)
    same_counts(runs)
    table.write(options.output / "contact.csv", [*COLUMNS, *violation.PARTS, "what failed"],
                [row(run) + ([""] * len(violation.PARTS) if run.worst is None else run.worst.tolist()) + ["; ".join(run.failures)] for run in runs])
    bar_chart(runs, options.output / "contact.png")
    total = summary(runs)
    print(f"\n{len(runs)} scenes in {sum(run.seconds for run in runs):.0f} s, {sum(len(run.faces) for run in runs)} steps written, "
          f"{sum(run.undirected for run in runs)} of them not judged by direction; "
          f"{sum(bool(run.scene.refused) for run in runs)} scenes that must be refused are not in the counts; contact.csv and contact.png in {options.output}")
    above = [] if options.only else table.missed(total, BOUNDS)
    print("\n".join([*(f"failed: {run.scene.name}: {what}" for run in runs for what in run.failures), *above, table.results(total, FORMATS)]))
    return 1 if total["failures"] or (options.quick and above) else 0
