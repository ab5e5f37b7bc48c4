"""Memory allocations in a step, at the beginning of a run and after a thousand steps.

The difference between runs of N and N - 2 steps gives the allocations of two steps, one load cycle. counter.cpp counts
them."""
import json

from perf.common import options as common
from perf.common import program, table

SCENE = "contact/cycles_2d.xml"
# and the late step
SERIES = {"direct": ((), 1000), "iterative": (("Mesh.cells={24, 24}", "Solver.Linear solver.type=iterative"), 200)}
EARLY, QUICK_LATE = 20, 100  # the input check before a run looks at up to 12 steps
REPEATED = 5  # time-dependent parts, e.g. MPI messages, only add: the smallest run counts
MORE = 0.01  # allowed relative increase of a late step: names with more digits, longer texts
COLUMNS = {"solver": "", "step": "d", "calls": ".0f", "kB": ".0f"}


def total(options, sets, steps):
    """Returns (calls, bytes) of a whole run that writes only its last step: the smallest of REPEATED runs."""
    return [min(each) for each in zip(*(run(options, sets, steps) for _ in range(REPEATED)))]


def run(options, sets, steps):
    file, directory = options.output / "total.json", options.output / "run"
    entries = (*sets, *options.set, f"Time.end={steps}", f"Time.steps={steps}", f"Output.every={steps}")
    file.unlink(missing_ok=True)
    program.checked(program.command(options.binary, SCENE, directory, entries), LD_PRELOAD=str(options.counter), SPREKK_ALLOCATIONS=str(file))
    reported = [json.loads(line) for line in file.read_text().splitlines()]
    return max((process["calls"], process["bytes"]) for process in reported)  # MPI's own processes allocate less


def of_step(options, sets, step):
    """Returns (calls, bytes) of a step, the mean of two steps.

    The text buffer of results.json doubles whenever it is full. This may happen at one of the two places; the
    smaller value counts."""
    places = [[(after - before) / 2 for after, before in zip(total(options, sets, at), total(options, sets, at - 2))] for at in (step, step + 4)]
    return [min(each) for each in zip(*places)]


def main(words):
    parser = common.parser("allocations", __doc__)
    counter = program.ROOT / "build/perf/allocations/liballocations.so"
    parser.add_argument("--counter", type=common.absolute, default=counter, help="the compiled counter.cpp")
    options = parser.parse_args(words)
    chosen = common.matching(options, SERIES)
    printed, maximum = table.Table(COLUMNS, 22), 0
    for name in chosen:
        sets, last = SERIES[name]
        found = {step: of_step(options, sets, step) for step in (EARLY, QUICK_LATE if options.quick else last)}
        for step, (calls, size) in found.items():
            printed.add([name, step, calls, size / 1e3])
        early, late = found.values()
        maximum = max([maximum, *(b / max(a, 1) - 1 for a, b in zip(early, late))])
    return table.finish(options, printed, {"growth": maximum}, {"growth": ".4f"}, {"growth": MORE}) or int(maximum > MORE)
