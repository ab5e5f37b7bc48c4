"""Runs random scenes and classifies each: ok, refused (correctly), failed, violation, or hang."""
import numpy as np
import violation

from perf.contact import contact, drawn_runs, limit_analysis, other_ways, random_families, random_scenes
from perf.contact.scenes import Scene

EVERY = 10  # one scene in EVERY also runs in one other way


def judge(run, scene):
    """Returns the verdict of a run on one rank and its messages."""
    run, status = contact.judge(run), run.status
    worst = 0 if run.worst is None else run.worst.max()
    wrong = [f"wrong state: violation {worst:.1e}"] if worst > contact.BOUNDS["worst_violation"] else []
    if status is None:
        return "hang", run.failures + wrong
    if status == 3 and not wrong:
        time = end_of_failed_step(run, scene)
        if not stands(scene, time):
            return "refused", []
        return "failed", [f"status 3, although tractions that balance the loads at t = {time:g} exist: "
                          + run.results.get("reason", "")]
    return "failed" if run.failures else "violation" if wrong else "ok", run.failures + wrong


def stands(scene, time):
    """True if tractions exist that balance the loads: by construction in `random_families`, else by limit analysis."""
    return scene.stem.rsplit("-", 1)[0] in random_families.FAMILIES or limit_analysis.of_scene(scene, time)


def end_of_failed_step(run, scene):
    input_ = violation.Input(scene)
    steps, end = input_.number("Time", "steps"), input_.number("Time", "end")
    reached = run.steps[-1]["time"] if run.steps else 0
    return next(t for t in end * np.arange(1, steps + 1) / steps if t > reached + 1e-9 * end)


def ways(options, k):
    """Returns the other ways in which scene k is run."""
    if options.all_ways:
        return other_ways.WAYS
    return other_ways.WAYS[k // EVERY % len(other_ways.WAYS):][:1] if k % EVERY == 0 else ()


def run_one(options, k):
    """Draws, runs and judges scene k; saves its files if it failed."""
    folder = options.output / "drawn"
    drawn, refusal = random_scenes.write(options.seed, k, folder, options.binary)
    scene = folder / f"{drawn.name}.xml"
    if refusal:
        nothing = [drawn.name] + [None] * (len(contact.COLUMNS) - 1)
        return drawn_runs.Outcome(drawn.name, contact.line(nothing), nothing + [""] * len(violation.PARTS) + [drawn.loads, "", None], "failed", [refusal])
    sets = list(other_ways.entries(ways(options, k)))
    run, compared = contact.start(options, Scene(drawn.name, str(scene.resolve()), sets), 1), other_ways.Compared()
    try:
        verdict, what = judge(run, scene)
        if run.status in (0, 3):
            compared = other_ways.compare(ways(options, k), scene, run, options.binary, contact.LIMITS)
    except Exception as error:  # e.g. unreadable files; the other scenes continue
        verdict, what = "failed", [f"could not be judged: {type(error).__name__}: {error}"]
    what, verdict = what + compared.of_others, "violation" if compared.of_others and verdict == "ok" else verdict
    run.failures = what + compared.of_ranks
    parts = [""] * len(violation.PARTS) if run.worst is None else run.worst.tolist()
    row = contact.row(run)
    outcome = drawn_runs.Outcome(drawn.name, contact.line(row), row + parts + [drawn.loads, ", ".join(compared.ways), compared.largest], verdict, what,
                                 compared.of_ranks, run.newton, compared.largest)
    drawn_runs.keep_or_remove(options.output, scene, run.directory.parent, what + compared.of_ranks)
    return outcome


def main(options):
    names = {k: random_scenes.draw_scene(options.seed, k).name for k in range(options.random)}
    again = f"./sprekk perf contact --random {options.random} --seed {options.seed}{' --all-ways' if options.all_ways else ''}"
    return drawn_runs.run_all(options, names, run_one, contact.line(contact.COLUMNS) + "  verdict",
                              [*contact.COLUMNS, *violation.PARTS, "loads", "also", "difference"], again)
