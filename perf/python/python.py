"""Cost of steps from Python, compared with `sprekk run`: python.py [--steps N]

Each run is a separate process that writes the same results. Its processor time minus the processor time of a run of one
step is the cost of the other steps. The smallest of several costs counts. A run without results, with a callback that
reads a field and an output, is timed as well."""
import sys

from perf.common import options as common
from perf.common import program

SCENE = program.ROOT / "xml/contact/cycles_2d.xml"
RUN = """
import sys, sprekk
scene = sprekk.Scene(sys.argv[1], sys.argv[3:])
model = sprekk.Model(scene)
"""
WAYS = {"sprekk run": None, "model.run(output)": RUN + "model.run(output=sys.argv[2])\n",
        "model.run(callback)": RUN + "model.run(lambda model, step: {'slip': model.output('slip').max()})\n",
        "own loop": RUN + "for t in scene.times:\n    model.step(t)\n"}


def seconds(options, way, steps):
    """CPU seconds of a run."""
    script, folder = WAYS[way], options.output / "run"
    entries = [f"Time.end={steps}", f"Time.steps={steps}", "Output.vtu=false"]
    if script:
        command = [sys.executable, "-c", script, str(SCENE), str(folder), *entries]
    else:
        command = program.command(options.binary, SCENE, folder, entries)
    before = program.cpu_seconds()
    program.checked(command)
    return program.cpu_seconds() - before


def main(words):
    parser = common.parser("python", __doc__, None, None, sets=False)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args(words)
    costs = {way: [[], []] for way in WAYS}
    for _ in range(options.repeat):
        for way in WAYS:  # in turns: other load of the machine affects all
            for times, steps in zip(costs[way], (1, options.steps)):
                times.append(seconds(options, way, steps))
    own = {way: min(many) - min(one) for way, (one, many) in costs.items()}
    for way, cost in own.items():
        print(f"{way:20} {1e3 * cost / (options.steps - 1):.4f} ms per step, {100 * (cost / own['sprekk run'] - 1):+.1f} %")
