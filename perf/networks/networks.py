"""Contact on fracture networks: compressed, then sheared in ten steps with friction, tangential stiffness, dilation and
closure. Checks the convergence of Newton's method, equal results on any number of ranks, and the balances of forces,
moments and energy."""
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import violation

from perf.common import options as common
from perf.common import program, table
from perf.contact import contact
from perf.networks import balance, scale

TIME_LIMIT = 3600  # CPU seconds per run
STEPS = 11           # steps of the scenes: one of compression, ten of shear
REFINED = (1, 2, 4, 8)  # refinement factors of the steps for the energy defect
BOUNDS = {"newton_median": 6, "newton_max": 12, "balance": 1e-8}
MIN_HEAT = -1e-10  # of a face in a step, relative to the largest
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
    program.mesh(options.binary, scene_of(network), mesh, network.sets + tuple(options.set))
    return mesh, sum(s["fractures"] for s in json.loads(Path(f"{mesh}.json").read_text())["sets"].values())


def scene_of(network):
    return program.ROOT / "xml/networks" / network.file  # or `file` itself, if its path is absolute


def start(options, network, mesh, ranks, *sets, directory=None, limit=TIME_LIMIT):
    """Runs the network and adds messages of failures."""
    folder = mesh.parent / (directory or "_".join(str(value).replace("=", "_") for value in (ranks, *sets)).replace(" ", "_"))
    entries = network.sets + tuple(options.set) + (f"Mesh file.path={mesh}", *sets)
    run = program.run(options.binary, scene_of(network), folder, entries, ranks, cpu=limit, clock=10 * limit, kind=Run)
    run.scene = network
    if run.status != 0:
        run.failures.append(f"on {ranks} ranks: {run.last_line}")
    elif not all(step["converged"] for step in run.steps):
        run.failures.append(f"on {ranks} ranks: a step did not converge")
    return run


def judge(run):
    """Checks balances and contact laws of a successful run."""
    run.budget = balance.budget(run.directory, run.results)
    run.faces, run.scales, run.worst, _ = violation.largest(
        run.directory, run.results, violation.Input(run.directory / "effective_input.xml"))
    if run.budget.balance > BOUNDS["balance"]:
        run.failures.append(f"forces or moments are out of balance by {run.budget.balance:.1e} of the largest reaction")
    if run.budget.min_heat < MIN_HEAT:
        run.failures.append(f"lambda_t . du^p is negative: {run.budget.min_heat:.1e} of the largest")
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
    mesh = run.results.get("mesh", {})
    table.add([network.name, mesh.get("dimension"), fractures, mesh.get("fracture_faces"), run.unknowns,
               len(run.steps), float(np.median(run.newton)) if run.newton else None, max(run.newton, default=None), run.cuts,
               run.fraction("slip"), run.fraction("open"), *([run.budget.balance, float(run.worst.max()), run.budget.min_heat]
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
    parser = common.parser("networks", __doc__)
    parser.add_argument("--ranks", type=common.count, default=2, metavar="N", help="also run on N ranks, and compare (2)")
    parser.add_argument("--scale", action="store_true", help="instead: cost per unknown of networks of 50 to 2000 fractures, compared with blocks")
    parser.add_argument("--seed", type=int, default=1, help="seed of --scale")
    options = parser.parse_args(arguments)
    if options.scale:
        return scale.measure(options, lambda of, sets: made(options, Network(of.name, of.file, sets)), options.seed)
    chosen = common.matching(options, [n for n in networks() if n.quick or not options.quick], lambda network: network.name)
    printed = table.Table(COLUMNS, width=24)
    runs = [measured(options, network, printed) for network in chosen]
    failed = [f"failed: {run.scene.name}: {what}" for run in runs for what in run.failures]
    for name in ("outcrop 2D",) if options.quick else ("outcrop 2D", "shapes 3D"):
        failed += [f"failed: {what}" for run in runs if run.scene.name == name for what in energies(options, run.scene)]
    newton = [count for run in runs for count in run.newton]
    values = {"networks": len(runs), "failures": len(failed), "newton_median": np.median(newton), "newton_max": max(newton, default=0),
              "balance": max((run.budget.balance for run in runs if run.budget), default=np.inf)}
    return table.finish(options, printed, values, {"newton_median": "g", "balance": ".0e"}, BOUNDS, failed)
