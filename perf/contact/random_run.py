"""Runs scenes that are drawn at random, and judges each: ok, refused rightly, failed, or without an end."""
import csv
import shutil
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial

import numpy as np

import contact
import limit_analysis
import linear
import random_scenes
import violation
from scenes import Scene

EVERY = 10  # of so many scenes one is run on two ranks, too


@dataclass
class Outcome:
    """What is kept of a scene once it has been run."""
    values: list              # of contact.COLUMNS
    parts: list               # of violation.PARTS
    loads: str
    verdict: str = "ok"
    newton: list = field(default_factory=list)
    what: list = field(default_factory=list)  # is wrong
    ranks: list = field(default_factory=list)  # differences between numbers of ranks
    notes: list = field(default_factory=list)


def judge(run, status, scene):
    """The verdict on one rank, with words where it is no good one."""
    run = contact.judge(run, status)
    worst = 0 if run.worst is None else run.worst.max()
    wrong = [f"wrong state: violation {worst:.1e}"] if worst > contact.BOUNDS["worst_violation"] else []
    if status is None:
        return "hang", run.failures + wrong
    if status == 3 and not wrong:
        time = end_of_failed_step(run, scene)
        if not limit_analysis.of_scene(scene, time):
            return "refused", []
        return "failed", [f"status 3, although tractions that balance the loads at t = {time:g} exist: "
                          + run.results.get("reason", "")]
    wrong = run.failures + wrong
    return "failed" if wrong else "ok", wrong


def end_of_failed_step(run, scene):
    input_ = violation.Input(scene)
    steps, end = input_.number("Time", "steps"), input_.number("Time", "end")
    reached = run.steps[-1]["time"] if run.steps else 0
    return next(t for t in end * np.arange(1, steps + 1) / steps if t > reached + 1e-9 * end)


def rank_differences(run, status, options):
    """What is not the same on two ranks, and notes on faces."""
    other, other_status = contact.start(options, run.scene, 2)
    other = contact.judge(other, other_status)
    if other_status != status:
        return [f"status {status} on one rank, {other_status} on two: {contact.last_line(other.words)}"], []
    run.failures.clear()
    notes = contact.compare(run, other)
    return list(run.failures), notes


def run_one(options, k):
    """Draws, runs and judges scene k; keeps its files if it failed."""
    folder = options.output / "drawn"
    drawn, refusal = random_scenes.write(options.seed, k, folder, options.binary)
    scene = folder / f"{drawn.name}.xml"
    if refusal:
        nothing = [drawn.name] + [None] * (len(contact.COLUMNS) - 1), [""] * len(violation.PARTS)
        return Outcome(*nothing, drawn.loads, "failed", what=[refusal])
    run, status = contact.start(options, Scene(drawn.name, str(scene.resolve())), 1)
    try:
        verdict, what = judge(run, status, scene)
    except Exception as error:  # files that cannot be read, say; the other scenes go on
        verdict, what = "failed", [f"could not be judged: {type(error).__name__}: {error}"]
    ranks, notes = rank_differences(run, status, options) if k % EVERY == 0 and status is not None else ([], [])
    run.failures = what + ranks
    parts = [""] * len(violation.PARTS) if run.worst is None else run.worst.tolist()
    outcome = Outcome(contact.row(run), parts, drawn.loads, verdict, run.newton, what, ranks, notes)
    keep_or_remove(options, scene, run.directory.parent, what + ranks)
    return outcome


def keep_or_remove(options, scene, results, wrong):
    """The scene moves to failures, with what is wrong in its first line, or goes with what the run wrote."""
    files = sorted(scene.parent.glob(f"{scene.stem}.*"))
    if wrong:
        words = "; ".join(wrong).replace("--", "- -")
        scene.write_text(scene.read_text().replace(" -->\n", f"; {words} -->\n", 1))
    for file in files:
        if wrong and file.suffixes in ([".xml"], [".msh"]):
            file.replace(options.output / "failures" / file.name)
        else:
            file.unlink()
    shutil.rmtree(results, ignore_errors=True)


def summary(outcomes):
    counted = [o.newton for o in outcomes if o.newton and o.verdict != "refused"] or [[np.nan]]
    verdicts = [o.verdict for o in outcomes]
    return {"scenes": len(outcomes), "failures": verdicts.count("failed"), "refused": verdicts.count("refused"),
            "hangs": verdicts.count("hang"), "newton_median": np.median([np.median(n) for n in counted]),
            "newton_p90": np.percentile([max(n) for n in counted], 90, method="higher"),
            "rank_differences": sum(bool(o.ranks) for o in outcomes)}


def main(options):
    names = {k: random_scenes.draw_scene(options.seed, k).name for k in range(options.random)}
    chosen = linear.matching(options, list(names), names.get)
    del options.refuse  # a method of the parser, which cannot be sent to another process
    for folder in ("drawn", "failures"):
        (options.output / folder).mkdir(parents=True, exist_ok=True)
    print(contact.line(contact.COLUMNS) + "  verdict")
    outcomes = []
    with ProcessPoolExecutor(options.jobs) as pool, open(options.output / "random.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(contact.COLUMNS + violation.PARTS + ("loads", "verdict", "what failed", "on two ranks"))
        for outcome in pool.map(partial(run_one, options), chosen):
            outcomes.append(outcome)
            table.writerow(outcome.values + outcome.parts
                           + [outcome.loads, outcome.verdict, "; ".join(outcome.what), "; ".join(outcome.ranks)])
            file.flush()
            lines = [f"{contact.line(outcome.values)}  {outcome.verdict}"] + [f"  {what}" for what in outcome.what + outcome.ranks]
            print("\n".join(lines + outcome.notes), flush=True)
    total = summary(outcomes)
    print(f"\nrandom.csv, and the scenes that failed, in {options.output}")
    print("scenes={scenes} failures={failures} refused={refused} hangs={hangs} newton_median={newton_median:g} "
          "newton_p90={newton_p90:g} rank_differences={rank_differences}".format(**total))
    return 1 if total["failures"] or total["hangs"] or total["rank_differences"] else 0
