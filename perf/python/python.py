#!/usr/bin/env python3
"""Cost of steps from Python, compared with `sprekk run`: python.py [--steps N]

Each run is a separate process that writes the same results. Its processor time minus the processor time of a run of one
step is the cost of the other steps. The smallest of several costs counts. A run without results, with a callback that
reads a field and an output, is timed as well."""
import argparse
import os
import resource
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "xml/contact/cycles_2d.xml"
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
        command = [str(options.binary), "run", str(SCENE), "--output", str(folder),
                   *(word for entry in entries for word in ("--set", entry))]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                   env={**os.environ, "OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--binary", type=Path, default=ROOT / "build/apps/sprekk/sprekk")
    parser.add_argument("--output", type=Path, default=Path("output/perf/python"))
    options = parser.parse_args(words)
    options.output.mkdir(parents=True, exist_ok=True)
    costs = {way: [[], []] for way in WAYS}
    for _ in range(options.repeat):
        for way in WAYS:  # in turns: other load of the machine affects all
            for times, steps in zip(costs[way], (1, options.steps)):
                times.append(seconds(options, way, steps))
    own = {way: min(many) - min(one) for way, (one, many) in costs.items()}
    for way, cost in own.items():
        print(f"{way:20} {1e3 * cost / (options.steps - 1):.4f} ms per step, {100 * (cost / own['sprekk run'] - 1):+.1f} %")


if __name__ == "__main__":
    main()
