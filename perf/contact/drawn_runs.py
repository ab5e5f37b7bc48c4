"""Runs all scenes of a seed, several at a time, and saves the failed scenes with their messages."""
import csv
import shutil
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from perf.common import options as common
from perf.common.table import results as last_line

VERDICTS = ("ok", "refused", "failed", "hang", "violation")


@dataclass
class Outcome:
    """Result of one scene after its run and its checks."""
    name: str
    line: str                 # of the printed table
    row: list                 # of the CSV file
    verdict: str = "ok"       # one of VERDICTS
    what: list = field(default_factory=list)   # messages of failures
    ranks: list = field(default_factory=list)  # differences between numbers of ranks
    newton: list = field(default_factory=list)  # iterations of each step
    difference: float = None  # largest between the runs of the scene, relative; None: one run

    @property
    def is_wrong(self):
        return bool(self.what or self.ranks)


def add_options(parser):
    parser.add_argument("--random", type=common.count, metavar="N", help="N scenes drawn at random; scene k depends on the seed and on k alone")
    parser.add_argument("--seed", type=int, default=1, help="seed of these scenes")
    parser.add_argument("--jobs", type=common.count, default=2, metavar="J", help="number of these scenes that run at the same time")


def keep_or_remove(output, scene, results, wrong):
    """Moves a failed scene to `failures` and writes the messages into its first line; removes a correct one.

    The output of the run is always removed."""
    files = sorted(scene.parent.glob(f"{scene.stem}.*"))
    if wrong:
        words = "; ".join(wrong).replace("--", "- -")
        scene.write_text(scene.read_text().replace(" -->\n", f"; {words} -->\n", 1))
    for file in files:
        if wrong and file.suffixes in ([".xml"], [".msh"]):
            file.replace(output / "failures" / file.name)
        else:
            file.unlink()
    shutil.rmtree(results, ignore_errors=True)


def summary(outcomes):
    """Returns the numbers of the last line, and whether any scene failed."""
    counted = [o.newton for o in outcomes if o.newton and o.verdict != "refused"] or [[np.nan]]
    verdicts = [o.verdict for o in outcomes]
    total = {"failures": verdicts.count("failed"), "hangs": verdicts.count("hang"), "violations": verdicts.count("violation"),
             "rank_differences": sum(bool(o.ranks) for o in outcomes),
             "newton_median": np.median([np.median(n) for n in counted]),
             "newton_p90": np.percentile([max(n) for n in counted], 90, method="higher")}
    differences = [o.difference for o in outcomes if o.difference is not None]
    if differences:
        total["largest_difference"] = max(differences)
    return total, any(total[key] for key in ("failures", "hangs", "violations", "rank_differences"))


def run_all(options, names, run_one, title, columns, again):
    """Runs the scenes of `names` (number: name) in parallel processes; returns the exit status.

    run_one(options, k) returns an Outcome. `again` is the command that repeats a run, without the name of the
    scene."""
    chosen = common.matching(options, list(names), names.get)
    del options.refuse  # method of the parser, which cannot be pickled for another process
    for folder in ("drawn", "failures"):
        (options.output / folder).mkdir(exist_ok=True)
    print(title)
    outcomes = []
    with ProcessPoolExecutor(options.jobs) as pool, open(options.output / "random.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow([*columns, "verdict", "what failed", "on several ranks"])
        for outcome in pool.map(partial(run_one, options), chosen):
            outcomes.append(outcome)
            table.writerow([*outcome.row, outcome.verdict, "; ".join(outcome.what), "; ".join(outcome.ranks)])
            file.flush()
            lines = [f"{outcome.line}  {outcome.verdict}"] + [f"  {what}" for what in outcome.what + outcome.ranks]
            if outcome.is_wrong:
                lines.append(f'  again: {again} --only "{outcome.name}"')
            print("\n".join(lines), flush=True)
    total, wrong = summary(outcomes)
    refused = sum(outcome.verdict == "refused" for outcome in outcomes)
    print(f"\n{len(outcomes)} scenes{f', {refused} of them refused rightly' * bool(refused)}; random.csv, and the scenes that failed, in {options.output}")
    print(last_line(total, dict.fromkeys(total, "g") | {"largest_difference": ".1e"}))
    return 1 if wrong else 0
