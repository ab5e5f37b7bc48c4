#!/usr/bin/env python3
"""Contact on fracture networks: compressed, then sheared in ten steps with friction, tangential stiffness, dilation and
closure. Checks the convergence of Newton's method, equal results on any number of ranks, and the balances of forces,
moments and energy."""
import argparse
import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("apps/plot", "perf/krylov", "perf/contact")]

import numpy as np  # noqa: E402

import balance  # noqa: E402
import contact  # noqa: E402
import linear  # noqa: E402
import scale  # noqa: E402

TIME_LIMIT = 3600  # CPU seconds per run
STEPS = 11           # steps of the scenes: one of compression, ten of shear
REFINED = (1, 2, 4, 8)  # refinement factors of the steps for the energy defect
BOUNDS = {"newton_median": 6, "newton_max": 12, "balance": 1e-8}
LEAST_HEAT = -1e-10  # of a face in a step, relative to the largest
ORDER = 0.8          # lower bound on the order of the energy defect in the step size; 1 is expected
COLUMNS = {"network": "s", "dim": "d", "fractures": "d", "faces": "d", "unknowns": "d", "steps": "d", "median": ".1f", "max": "d",
           "cuts": "d", "slip": ".0%", "open": ".1%", "balance": ".0e", "violation": ".0e", "heat": ".0e", "seconds": ".0f"}
NETWORK = "Mesh file.network"


@dataclass
class Network:
    name: str
    file: str          # in xml/networks
    sets: tuple = ()   # entries of the network
    quick: bool = False
    several: bool = False  # several equilibria, as in perf/contact


@dataclass
class Run(contact.Run):
    """Measured values of a network on some ranks."""
    budget: object = None


def networks():
    def seeds(*numbers, sets):
        return tuple(f"{NETWORK}.fractures.{name}.random.seed={number}" for name, number in zip(sets, numbers))
    yield Network("outcrop 2D", "outcrop_2d.xml", quick=True)
    for seed in (1, 3, 5, 7, 9, 13):
        yield Network(f"random 2D, seed {seed}", "random_2d_100.xml", seeds(seed, seed + 1, sets=("main", "cross")), quick=seed == 1)
    yield Network("shapes 3D", "shapes_3d.xml", quick=True)
    for seed in (1, 11):
        yield Network(f"random 3D, seed {seed}", "random_3d_50.xml", seeds(seed, seed + 1, sets=("steep", "flat")))


def made(options, network):
    """Generates the mesh of the network; returns the file and the number of fractures."""
    mesh = options.output / network.name.replace(" ", "_").replace(",", "") / "network.msh"
    mesh.parent.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-B", str(ROOT / "apps/mesh"), "--program", str(options.binary), str(scene_of(network)), "-o", str(mesh), "--quiet"]
    done = linear.started(command + words(network.sets + tuple(options.set)))
    if done.returncode:
        sys.exit(done.stderr.strip())
    return mesh, sum(s["fractures"] for s in json.loads(Path(f"{mesh}.json").read_text())["sets"].values())


def scene_of(network):
    return ROOT / "xml/networks" / network.file  # or `file` itself, if its path is absolute


def words(entries):
    return [word for entry in entries for word in ("--set", entry)]


def start(options, network, mesh, ranks, *sets, directory=None):
    """Runs the network and adds messages of failures."""
    run = Run(network, mesh.parent / (directory or "_".join(str(value).replace("=", "_") for value in (ranks, *sets)).replace(" ", "_")))
    entries = network.sets + tuple(options.set) + (f"Mesh file.path={mesh}", *sets)
    command = [str(options.binary), "run", str(scene_of(network)), "--output", str(run.directory)] + words(entries)
    begin = time.monotonic()
    done = linear.started(["prlimit", f"--cpu={TIME_LIMIT}", *linear.on_ranks(ranks, command)])
    run.seconds = time.monotonic() - begin
    file = run.directory / "results.json"
    run.results = json.loads(file.read_text()) if file.is_file() else {}
    if done.returncode:
        run.failures.append(f"on {ranks} ranks: {contact.last_line(done.stdout + done.stderr)}")
    elif not all(step["converged"] for step in run.steps):
        run.failures.append(f"on {ranks} ranks: a step did not converge")
    return run


def judge(run):
    """Checks balances and contact laws of a successful run."""
    run.budget = balance.budget(run.directory, run.results)
    run.faces, run.scales, run.worst, _ = contact.violation.largest(
        run.directory, run.results, contact.violation.Input(run.directory / "effective_input.xml"))
    if run.budget.balance > BOUNDS["balance"]:
        run.failures.append(f"forces or moments are out of balance by {run.budget.balance:.1e} of the largest reaction")
    if run.budget.least_heat < LEAST_HEAT:
        run.failures.append(f"lambda_t . du^p is negative: {run.budget.least_heat:.1e} of the largest")
    if run.worst.max() > contact.BOUNDS["worst_violation"]:
        run.failures.append(f"the laws are violated by {run.worst.max():.1e}")


def measured(options, network, table):
    """Measures a network and adds its row to the table; returns the run on one rank."""
    mesh, fractures = made(options, network)
    run, notes = start(options, network, mesh, 1), []
    if not run.failures:
        judge(run)
    if not run.failures and options.ranks > 1:
        other = start(options, network, mesh, options.ranks)
        run.failures += other.failures
        if not other.failures:
            judge(other)
            run.failures += [f"on {options.ranks} ranks: {what}" for what in other.failures]
            notes = contact.compare(run, other)
            if run.newton != other.newton:
                notes.append(f"  Newton iterations on {options.ranks} ranks: {other.newton}, on one: {run.newton}")
    told = linear.Run(run.results)
    table.add([network.name, run.results.get("mesh", {}).get("dimension"), fractures, run.results.get("mesh", {}).get("fracture_faces"), told.unknowns,
               len(run.steps), float(np.median(run.newton)) if run.newton else None, max(run.newton, default=None), told.cuts,
               told.fraction("slip"), told.fraction("open"), *([run.budget.balance, float(run.worst.max()), run.budget.least_heat]
                                                              if run.budget else [None] * 3), run.seconds], [*run.failures, *notes])
    return run


def energies(options, network):
    """Prints the energies for decreasing steps; returns messages of failures. Tips are plain, see balance.py."""
    mesh, _ = made(options, network)
    print(f"\n{network.name}, plain tips: work of the loads and where it goes, J{'/m' if '2d' in network.file else ''}")
    print(f"{'steps':>6}{'work':>14}{'strain':>14}{'joints':>14}{'heat':>14}{'defect':>11}{'order':>7}{'late heat':>12}{'order':>7}")
    found = []
    for factor in REFINED[:3 if options.quick else None]:
        run = start(options, network, mesh, 1, f"Time.steps={STEPS * factor}", "Mesh file.tips=plain")
        if run.failures:
            return [f"{network.name}, {STEPS * factor} steps: {what}" for what in run.failures]
        b = balance.budget(run.directory, run.results)
        found.append(np.abs([b.defect, b.late[-1] / b.heat[-1]]))
        orders = np.log2(found[-2] / found[-1]) if len(found) > 1 else []
        words = [f"{value:{width}.2e}" + (f"{orders[k]:7.2f}" if len(orders) else " " * 7)
                 for k, (value, width) in enumerate(((b.defect, 11), (b.late[-1] / b.heat[-1], 12)))]
        print(f"{STEPS * factor:6}" + "".join(f"{e[-1]:14.5e}" for e in (b.work, b.strain, b.stored, b.heat)) + "".join(words), flush=True)
    return [f"{network.name}: the {what} is of order {order:.2f} in the step, expected is {ORDER} or more"
            for what, order in zip(("defect of the energy", "late heat"), orders) if not order > ORDER]


def main(arguments):
    parser = linear.parser("networks", __doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--ranks", type=linear.count, default=2, metavar="N", help="also run on N ranks, and compare (2)")
    parser.add_argument("--scale", action="store_true", help="instead: cost per unknown of networks of 50 to 2000 fractures, compared with blocks")
    parser.add_argument("--seed", type=int, default=1, help="seed of --scale")
    options = parser.parse_args(arguments)
    options.output = options.output.resolve()
    if options.scale:
        options.output.mkdir(parents=True, exist_ok=True)
        return scale.measure(options, lambda of, sets: made(options, Network(of.name, of.file, sets)), options.seed)
    chosen = linear.matching(options, [n for n in networks() if n.quick or not options.quick], lambda network: network.name)
    options.output.mkdir(parents=True, exist_ok=True)
    table = linear.Table(COLUMNS, width=24)
    runs = [measured(options, network, table) for network in chosen]
    table.write(options.output / "networks.csv")
    failed = [f"{run.scene.name}: {what}" for run in runs for what in run.failures]
    for name in ("outcrop 2D",) if options.quick else ("outcrop 2D", "shapes 3D"):
        failed += [what for run in runs if run.scene.name == name for what in energies(options, run.scene)]
    newton = [count for run in runs for count in run.newton]
    values = {"newton_median": np.median(newton), "newton_max": max(newton, default=0),
              "balance": max((run.budget.balance for run in runs if run.budget), default=np.inf)}
    missed = linear.missed(values, BOUNDS)
    print()
    for what in [f"failed: {what}" for what in failed] + missed:
        print(what)
    print(f"networks={len(runs)} failures={len(failed)} newton_median={values['newton_median']:g} newton_max={values['newton_max']} "
          f"balance={values['balance']:.0e}")
    return 1 if failed or (options.quick and missed) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
