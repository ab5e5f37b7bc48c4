"""Error control: target, estimated and true errors, compared with uniform meshes of order 1 and 2."""
import csv
import math
import re
from dataclasses import dataclass
from xml.etree import ElementTree

import style

from perf.common import options as common
from perf.common import program, table
from perf.networks.scale import ROCK
from perf.verification import exact, meshes, scenes

ROOT = program.ROOT

REQUESTS = (0.1, 0.01, 0.001)
OVERSHOOT = 1.5  # allowed ratio of the true error to the request
SPEEDUP = {2: 5, 3: 3}  # at 1 %
REFERENCE = 5e-5  # request of the reference run, if no exact value is known
TIME_LIMIT = 1800
# steady injection into the network of a stressed rock: half of the area of the steep fractures slips
INJECTION = ("Bulk.initial stress={-9e6, -9e6, -25e6, 0, 0, 0}", "Boundary conditions.lid.displacement={0, 0, 0}", "Boundary conditions.floor.pressure=0",
             "Tables.confinement.values={9e6, 9e6, 9e6}", "Tables.confinement.arguments={0, 1e9, 1e10}", "Time.end=1e9", "Time.steps=1",
             "Flow.Wells.well.points={5, 5, 1, 5, 5, 9}", "Flow.Wells.well.radius=0.002", "Flow.Wells.well.pressure=9e6")


@dataclass
class Case:
    name: str
    scene: str
    quantity: str
    # fracture names, separated by commas ("": all); reaction: boundary and component; flow: "well" or "boundary" and
    # its name
    fractures: str
    coarse: object        # first mesh of adaptive runs: entries, or a function of a folder that makes a mesh
    uniform: list         # meshes of order 1 from coarse to fine, in the same form
    exact: float = None   # None: value of a run of order 2 with the request `reference`
    sets: tuple = ()
    dimension: int = 2
    requests: tuple = REQUESTS
    orders: tuple = (1, 2)  # of adaptive runs
    reference: float = REFERENCE
    finest: object = None   # entries of the mesh of a reference run of order 2
    uniform_2: list = None  # uniform meshes of order 2; None: those of order 1 except the finest
    seconds: float = None   # time limit of an adaptive run; default: --seconds
    during: bool = False    # also measures refinement during the run


@dataclass
class Row:
    kind: str             # uniform, adaptive (repeated runs), during run or reference
    order: int
    requested: float          # relative request of adaptive runs
    cells: int
    seconds: float
    value: float
    estimate: float = math.nan
    reached: bool = True
    error: float = math.nan  # true relative error


def crack(scene, quantity, value, angle=0):
    """Arguments of a case of a crack in an infinite body, with the exact displacement on a box."""
    mesh = lambda h: lambda folder: meshes.uniform_crack(folder, h, angle)  # noqa: E731
    return dict(scene=f"verification/{scene}.xml", quantity=quantity, fractures="crack", coarse=mesh(1.6),
                uniform=[mesh(h) for h in (0.8, 0.4, 0.2, 0.1, 0.05, 0.025)], exact=value)


def free_sides_shear():
    """Shear force of the reference."""
    rows = csv.reader(open(ROOT / "perf/verification/references/free_sides.csv"))
    return next(float(row[0]) for row in rows if row[0][0].isdigit())


def box(*counts, dimension=2):
    return [(f"Mesh.cells={{{', '.join([str(n)] * dimension)}}}",) for n in counts]


def cases():
    mean = math.pi / 4  # mean of sqrt(1 - x^2)
    psi, G, K, load = math.radians(20), 10e9, 16.67e9, 100e6
    drop = load * math.sin(psi) * (math.cos(psi) - math.tan(math.radians(30)) * math.sin(psi))
    nu = (K - 2 * G / 3) / (2 * (K + G / 3))
    simplices = ("Mesh.cell=triangle",)
    penny = lambda h, growth=0: lambda folder: meshes.polygon(folder, max(h, 1) if growth else h, h, growth)  # noqa: E731
    slab = lambda n: (f"Mesh.cells={{{4 * n}, {n}, {4 * n}}}",)  # noqa: E731
    junction = lambda h, ratio: lambda folder: meshes.t_junction(folder, h, ratio, 32000)  # noqa: E731
    strip = lambda h: lambda folder: meshes.wavy(folder, h)  # noqa: E731
    wavy = exact.Wavy(0.4, 1, 0.25)
    fractures = lambda *sizes: lambda folder: network(folder, *sizes)  # noqa: E731
    rectangles = [lambda folder, sizes=sizes: network(folder, *sizes, corners=4) for sizes in ((1, 3, 5), (0.5, 1, 4), (0.25, 0.5, 2), (0.08, 0.16, 2), (0.07, 0.14, 1.7))]
    halved = [(fractures(1, 2, 4), f"Mesh file.refinements={n}") for n in (0, 1)]
    flow = dict(scene="flow/network_2d.xml", quantity="flow", coarse=box(10)[0], uniform=box(10, 20, 40, 80, 160, 320), uniform_2=[], orders=(1,))
    steady = ("Flow.compressibility=0", "Time.steps=1")
    well = ("Flow.Wells.well.points={60, 70}", "Flow.Wells.well.radius=0.1", "Flow.Wells.well.pressure=0.5e6")
    plate = lambda *rows: [(f"Mesh.cells={{{10 * n}, {n}}}",) for n in rows]  # noqa: E731
    return [
        Case("crack opening", **crack("sneddon", "opening", 1.5e-3 * mean)),
        Case("sliding", **crack("sneddon_shear", "slip", 1.5e-3 * mean)),
        Case("inclined with friction", **crack("inclined_crack", "slip", 2 * (1 - nu) * drop / G * mean, 20)),
        Case("penny", "verification/penny.xml", "opening", "crack", penny(0.55, 0.5), [penny(0.5), penny(0.25), penny(0.17), penny(0.125)],
             dimension=3, requests=REQUESTS[:2], reference=3e-3),
        Case("tearing", "verification/tearing_3d.xml", "slip", "crack", slab(2), [slab(2), slab(4), slab(8), slab(12)], 2e-3 * mean,
             dimension=3),
        Case("network", "networks/random_3d_50.xml", "slip", "", fractures(1, 2, 4), halved, uniform_2=halved, dimension=3, requests=REQUESTS[:1],
             orders=(2,), finest=fractures(0.1, 0.15, 2), seconds=900, sets=("Time.schedule={1, 11}",)),
        Case("injection", "networks/random_3d_50.xml", "slip", "", rectangles[0], rectangles[:3], uniform_2=rectangles[:4], dimension=3,
             requests=REQUESTS[:1], orders=(2,), finest=rectangles[4], sets=(*ROCK, *INJECTION)),
        Case("wavy contact", "verification/wavy.xml", "opening", "", strip(0.1), [strip(h) for h in (0.1, 0.05, 0.025, 0.0125, 0.00625)],
             float(wavy.opening_mean(0.0, 0.5))),
        Case("T junction", "verification/t_junction.xml", "slip", "horizontal", junction(1, 0.5),
             [junction(h, r) for h, r in ((1, 0.5), (0.5, 0.25), (0.25, 0.25), (0.125, 0.25))]),
        Case("X crossing", "verification/crossing_2d.xml", "slip", "flat", box(8)[0], box(8, 16, 32, 64, 128), sets=simplices),
        Case("reaction", "verification/free_sides_2d.xml", "reaction", "north x", box(8)[0], box(8, 16, 32, 64, 128), free_sides_shear(), sets=simplices),
        Case("compliant joint", "verification/free_sides_2d.xml", "shear force", "", box(8)[0], box(8, 16, 32, 64, 128), sets=simplices),
        Case("well in a network", **flow, fractures="well well", sets=(*steady, *well)),
        Case("flow through a network", **flow, fractures="boundary west", sets=steady),
        Case("plate", "accuracy/plate_2d.xml", "flow", "boundary east", plate(2)[0], plate(2, 4, 8, 16, 32), requests=REQUESTS[:2],
             reference=1e-3, sets=("Time.scheme=BDF2", "Time.steps=10"), during=True),
        Case("fault", "accuracy/fault_2d.xml", "slip", "fault", box(10)[0], box(10, 20, 40, 80, 160), requests=REQUESTS[:2], reference=1e-3,
             sets=("Time.steps=10",), during=True),
        Case("cooling", "thm/cooling_2d.xml", "slip", "fault", box(16)[0], box(16, 32, 64, 128), requests=REQUESTS[:2], reference=1e-3),
        Case("doublet", "accuracy/doublet_2d.xml", "temperature", "well producer", box(10)[0], box(10, 20, 40, 80), uniform_2=[], orders=(1,),
             requests=(0.01, 0.003), reference=1.5e-3, seconds=300),
    ]


def network(folder, relative, at_tips, size, corners=8):
    """Mesh of the scene random_3d_50 with other cell sizes and corners of fractures. Raises NoGmsh if it fails."""
    file = folder / f"network_50_{relative:g}_{at_tips:g}_{size:g}_{corners}.msh"
    if not file.is_file():
        sizes = (f"relative size={relative:g}", f"size at tips={at_tips:g} m", f"size={size:g}",
                 *(f"fractures.{name}.random.corners={corners}" for name in ("steep", "flat")))
        try:
            program.mesh(ROOT / "build/apps/sprekk/sprekk", "networks/random_3d_50.xml", file, [f"Mesh file.network.{size}" for size in sizes])
        except program.Failed as error:
            raise meshes.NoGmsh("no mesh of a network could be made") from error
    return file


def entries(source, folder):
    if isinstance(source, tuple) and callable(source[0]):
        return entries(source[0], folder) + source[1:]
    return (f"Mesh file.path={source(folder)}",) if callable(source) else tuple(source)


def without_request(scene, folder):
    """Returns the scene, or a copy without its section Accuracy."""
    tree = ElementTree.parse(scene)
    requested = tree.getroot().find("ParameterList[@name='Accuracy']")
    if requested is None:
        return scene
    tree.getroot().remove(requested)
    folder.mkdir(parents=True, exist_ok=True)
    tree.write(folder / scene.name)
    return folder / scene.name


def start(options, case, order, source, requested, label, others=()):
    """Runs a case and returns its results; without `requested` on the given mesh. Raises Failed if the run fails."""
    directory = options.output / re.sub(r"\W+", "_", case.name) / label
    mesh = entries(source, options.output / "meshes")
    section = "Mesh file" if mesh[0].startswith("Mesh file") else "Mesh"
    sets = ["Output.vtu=false", *case.sets, *mesh, f"{section}.order={order}", *others]
    if requested:
        goal = "Accuracy.quantities.goal"
        sets += [f"{goal}.quantity={case.quantity}", f"{goal}.relative={requested:g}", f"Accuracy.seconds={case.seconds or options.seconds:g}"]
        if case.quantity == "reaction":
            sets += [f"{goal}.{entry}={word}" for entry, word in zip(("boundary", "component"), case.fractures.split())]
        elif case.quantity in ("flow", "temperature"):
            sets.append("{}.{}={}".format(goal, *case.fractures.split()))
        elif case.fractures:
            sets.append(f"{goal}.fractures={{{case.fractures}}}")
    scene = without_request(scenes.path(case.scene, options.output / "scenes"), options.output / "meshes")
    return program.succeeded(options.binary, scene, directory, sets, options.ranks, clock=TIME_LIMIT).results


def value_of(case, results):
    """Quantity of a run without accuracy request, from results.json."""
    if case.quantity == "reaction":
        boundary, component = case.fractures.split()
        return results["steps"][-1]["reactions"][boundary]["xyz".index(component)]
    if case.quantity == "flow":
        kind, name = case.fractures.split()
        return results["steps"][-1]["wells"][name]["rate"] if kind == "well" else results["steps"][-1]["inflows"][name]
    if case.quantity == "temperature":
        return results["steps"][-1]["wells"][case.fractures.split()[1]]["temperature"]
    fractures = results["steps"][-1]["fractures"]
    chosen = [fractures[name] for name in (case.fractures.split(",") if case.fractures else fractures)]
    area = sum(one["area"] for one in chosen)
    if case.quantity in ("slip", "opening"):
        return sum(one["area"] * one[f"mean_{case.quantity}"] for one in chosen) / area
    return sum(one["area"] * math.hypot(*one["mean_traction"]["local"][1:]) for one in chosen)  # shear of one sign


def uniform(options, case, order, k, source, steps):
    chosen = () if any("schedule" in entry for entry in case.sets) else (f"Time.steps={steps}",)
    results = start(options, case, order, source, None, f"uniform_{order}_{k}", chosen)
    timing = {name: phase["seconds"] for name, phase in results["timing"].items()}
    seconds = sum(timing[name] for name in ("mesh", "set-up_of_the_solver", "time_steps"))
    return Row("uniform", order, math.nan, results["mesh"]["cells"], seconds, value_of(case, results))


def adaptive(options, case, order, requested, label=None, kind="adaptive", others=()):
    label = label or f"{kind.replace(' ', '_')}_{order}_{requested:g}"
    results = start(options, case, order, case.coarse, requested, label, others)
    accuracy = results["accuracy"]
    goal, last = accuracy["quantities"]["goal"], accuracy["meshes"][-1]
    estimate = math.inf if goal["error"] is None else goal["error"] / abs(goal["value"])
    return Row(kind, order, requested, last["cells"], last["seconds"], goal["value"], estimate, goal["reached"]), len(results["steps"])


def seconds_at(rows, error):
    """Seconds that uniform meshes need for an error: the least over all orders.

    Values are interpolated between runs, log-log, and extrapolated from the two nearest runs. Runs whose error
    does not decrease are skipped."""
    best = math.inf
    for order in {row.order for row in rows}:
        of = []
        for row in (row for row in rows if row.order == order):
            if not of or row.error < of[-1].error:
                of.append(row)
        if len(of) < 2:
            continue
        k = next((k for k in range(1, len(of)) if of[k].error <= error), len(of) - 1)
        a, b = of[k - 1], of[k]
        slope = max(math.log(b.seconds / a.seconds), 0) / math.log(a.error / b.error)
        best = min(best, b.seconds * (b.error / error)**slope)
    return best


def measure(options, case):
    """Runs a case; uniform runs have the time steps of the most accurate adaptive run."""
    requests = case.requests[:2] if options.quick else case.requests
    runs = [adaptive(options, case, order, requested) for order in case.orders for requested in requests]
    reference, steps, finest = reference_of(options, case, runs[-1][1])
    plain = {1: case.uniform, 2: case.uniform[:-1] if case.uniform_2 is None else case.uniform_2}
    rows = [uniform(options, case, order, k, source, steps) for order, sources in plain.items()
            for k, source in enumerate(sources[:2 if options.quick else None])]
    rows += [*finest, *(row for row, _ in runs)]
    if case.during:  # with the time steps of uniform runs
        others = ("Accuracy.refinement=during the run", f"Time.steps={steps}")
        rows += [adaptive(options, case, order, requested, None, "during run", others)[0] for order in case.orders for requested in requests]
    for row in rows:
        row.error = abs(row.value / reference - 1)
    return rows


def reference_of(options, case, steps):
    """Returns the reference value, the number of time steps, and the row of the reference on a uniform mesh."""
    if case.exact:
        return case.exact, steps, []
    if case.finest:
        row = uniform(options, case, 2, "reference", case.finest, steps)
        row.kind = "reference"
        return row.value, steps, [row]
    row, steps = adaptive(options, case, 2, 1e-3 if options.quick else case.reference, "reference")
    if not row.reached:
        raise program.Failed(f"its reference is known to {100 * row.estimate:.2g} % only; take more --seconds")
    return row.value, steps, []


def show(case, rows):
    print(f"\n{case.name}: {case.quantity}{' of ' + case.fractures if case.fractures else ''}")
    print(f"{'':10}{'order':>6}{'requested':>9}{'cells':>9}{'seconds':>9}{'true':>11}{'estimate':>11}{'est./true':>11}{'speed-up':>10}")
    plain = [row for row in rows if row.kind == "uniform"]
    for row in rows:
        words = f"{row.kind:10}{row.order:>6}{'' if math.isnan(row.requested) else format(row.requested, 'g'):>9}{row.cells:>9}{row.seconds:>9.2f}{row.error:>11.2e}"
        if not math.isnan(row.requested):
            words += f"{row.estimate:>11.2e}{row.estimate / row.error:>11.2f}{seconds_at(plain, row.error) / row.seconds:>10.1f}"
            words += "" if row.reached else "   not reached"
        print(words, flush=True)


def draw(measured, file):
    figure, all_axes = style.plt.subplots(-(-len(measured) // 3), 3, figsize=(10, 3 * -(-len(measured) // 3)), squeeze=False)
    for axes, (case, rows) in zip(all_axes.flat, measured):
        for kind, order in dict.fromkeys((row.kind, row.order) for row in rows if row.kind != "reference"):
            of = [row for row in rows if (row.kind, row.order) == (kind, order)]
            colour = style.LINES[order - 1 + 2 * ("uniform", "adaptive", "during run").index(kind)]
            axes.loglog([row.seconds for row in of], [row.error for row in of], "o-", color=colour, markersize=4, label=f"{kind}, order {order}")
            if kind != "uniform":
                axes.loglog([row.seconds for row in of], [row.estimate for row in of], "x:", color=colour, markersize=4)
        axes.set_title(case.name)
        axes.set_xlabel("seconds")
    for axes in all_axes.flat[len(measured):]:
        axes.set_visible(False)
    all_axes[0][0].set_ylabel("relative error; dotted: estimate")
    all_axes[0][0].legend()
    figure.tight_layout()
    figure.savefig(file, dpi=130)
    style.plt.close(figure)


def main(words):
    parser = common.parser("accuracy", __doc__, "two coarse meshes, 10 %% and 1 %%, of three cases", only=None, sets=False)
    parser.add_argument("--only", action="append", help="cases whose names begin with this text; may be repeated")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=300, help="limit of an adaptive run")
    options = parser.parse_args(words)
    chosen = [case for case in cases() if not options.only or any(case.name.startswith(name) for name in options.only)]
    if options.quick and not options.only:
        chosen = [case for case in chosen if case.name in ("sliding", "wavy contact", "X crossing")]
    if not chosen:
        parser.error(f"no case begins so; there are: {', '.join(case.name for case in cases())}")
    measured, failures = [], 0
    for case in chosen:
        try:
            measured.append((case, measure(options, case)))
            show(*measured[-1])
        except (program.Failed, meshes.NoGmsh) as error:
            failures += not isinstance(error, meshes.NoGmsh)
            print(f"\n{case.name}: {'skipped' if isinstance(error, meshes.NoGmsh) else 'failed'}: {error}", flush=True)
    if not measured:
        return 1 if failures else 0
    table.write(options.output / "accuracy.csv", ["case", *vars(measured[0][1][0])],
                [[case.name, *vars(row).values()] for case, rows in measured for row in rows])
    draw(measured, options.output / "accuracy.png")
    requested = [(case, row, rows) for case, rows in measured for row in rows if row.kind == "adaptive"]
    reached = [row for _, row, _ in requested if row.reached and row.error <= OVERSHOOT * row.requested]
    ratios = [row.estimate / row.error for _, row, _ in requested if row.error > 0]
    speed = [max((seconds_at([r for r in rows if r.kind == "uniform"], row.error) / row.seconds for row in rows if row.requested == 0.01), default=math.nan)
             for _, rows in measured]
    speed = [one for one in speed if not math.isnan(one)] or [math.nan]
    print(f"\nrequested={len(requested)} reached={len(reached)} worst_overshoot={max(row.error / row.requested for _, row, _ in requested):.2f} "
          f"effectivity={min(ratios):.2f}..{max(ratios):.2f} speedup_1pc={min(speed):.1f}")
    return 1 if failures or (options.quick and len(reached) < len(requested)) else 0
