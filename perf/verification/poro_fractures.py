"""Cases of fractures opened by fluid: scenes, meshes, measured errors and bounds."""
from dataclasses import replace

import numpy as np

from perf.verification import cases, exact, flow_measure, measure, meshes, poro_exact
from perf.verification.cases import Bound, Case, Order, Series, gmsh, graded, uniform
from perf.verification.measure import face_points
from perf.verification.poro_cases import SHAPES, mean_pressures, numbers


def rock(entries):
    return tuple(f"Materials.rock.{name}={value}" for name, value in entries.items())


def undrained(lam):
    """Entries of undrained rock with the undrained first Lame parameter lam."""
    return rock({"Biot coefficient": 1, "Lame's first parameter": repr(0.4 * lam), "compressibility of pores": repr(1 / (0.6 * lam))})


# Manufactured solution

def opened_errors(run, known):
    points, weights = face_points(run.corners())
    flow, right = run.data("fluid flux")[:, None, :run.dimension], flow_measure.known_at(known.flow_in, points)
    inside = flow_measure.mean_error(run.data("fracture pressure")[:, None], known.pressure_in, points, weights)
    return {"pressure": mean_pressures(run, known.pressure), "u": measure.displacement_error(run, known), "in fracture": inside,
            "flow": measure.relative(flow - right, right, weights),
            "jump": measure.jump_error(run, measure.face_means(known.jump, run.corners()))}


def opened(d, counts):
    """Case; `counts` = {order of cells: numbers of cells along each edge}."""
    series = []
    for cell, (order, ns) in ((cell, of) for cell in SHAPES[d] for of in counts.items()):
        grids = [(f"n={n}", (f"Mesh.cells={numbers([n] * d)}",)) for n in ns]
        sets, quick = (f"Mesh.cell={cell}", f"Mesh.order={order}"), (cell, order) in (("triangle", 1), ("hexahedron", 1))
        series.append(Series(f"{cell} {order}", grids, f"verification/manufactured_opening_{d}d.xml", sets, poro_exact.Opened(d), 2 * quick))
    fine = 2 if d == 2 else 1.9  # observed on meshes of this size
    minimum = {"pressure": 2, "u": 2, "in fracture": fine, "flow": 1, "jump": fine}
    bounds = [Order(one.name, *bound) for one in series for bound in minimum.items()]
    return Case(f"mms_opening{d}d", f"manufactured solution of a fracture opened by fluid pressure in {d}D", "", series, opened_errors, None,
                (f"{SHAPES[d][0]} 1", f"n={counts[1][-1]}", "pressure"), None, ("pressure", "u"), None, bounds, called=("pressure", "u"))


def mms_opening2d():
    return opened(2, {1: (8, 16, 32), 2: (8, 16, 32)})


def mms_opening3d():
    return opened(3, {1: (4, 8, 12), 2: (4, 8)})


# Fracture that slides and opens by fluid pressure

QUICK = (("dry", "triangle"), ("undrained", "quadrilateral"), ("drained", "tetrahedron"))


def mean_state(step):
    """Returns ("stick", "slip", "open" or "mixed", normal and shear traction, normal and tangential jump) of the
    fracture."""
    of = step["fractures"]["fracture"]
    name = next((name for name in ("stick", "slip", "open") if of[f"fraction_{name}"] > 1 - 1e-9), "mixed")
    (N, *T), (opening, *sliding) = (of[f"mean_{what}"]["local"] for what in ("traction", "jump"))
    return name, -N, np.linalg.norm(T), opening, np.linalg.norm(sliding)


def onset_error(path, states, before, after, known):
    """Largest relative distance from the exact pressure at which state `before` changes to `after`; 1 without this
    change."""
    low, high = ([p for p, state in zip(path, states) if state == name] for name in (before, after))
    return max(abs(p / known - 1) for p in (max(low), min(high))) if low and high and max(low) < min(high) else 1.0


def joined_errors(run, known):
    """Errors of the onset pressures, and of tractions and jumps: the largest of all steps, relative to the largest
    value."""
    path = known.path()[1:]
    found, states = [mean_state(step) for step in run.results["steps"]], [known.state(p) for p in path]
    names = [one[0] for one in found]
    slides, opens = (onset_error(path, names, *pair, p) for pair, p in zip((("stick", "slip"), ("slip", "open")), known.onset))
    values, right = (np.array([one[1:] for one in of]) for of in (found, states))
    traction, jump = (max(np.abs(values - right)[:, of].max() / np.abs(right[:, of]).max(), 1e-17) for of in (slice(0, 2), slice(2, 4)))
    return {"slides": slides, "opens": opens, "traction": traction, "jump": jump}


def joined(name, known, title):
    """Case with three kinds of rock: `dry` (no Biot coupling), `undrained`, and `drained` (pressure of the
    fracture)."""
    drained = rock({"Biot coefficient": 0.5, "permeability": "{1.0}"})
    kinds = {"dry": (known, ()), "drained": (replace(known, share=0.5), drained), "undrained": (known, undrained(known.lam))}
    series = []
    for kind, (state, sets) in kinds.items():
        for d, cell in ((d, cell) for d in (2, 3) for cell in SHAPES[d]):
            entries = (f"Mesh.cell={cell}", f"Tables.p.values={numbers(state.path())}", *sets)
            grid = [("n=4", (f"Mesh.cells={numbers([4] * d)}",))]
            series.append(Series(f"{kind} {cell}", grid, f"verification/fluid_{name}_{d}d.xml", entries, state, int((kind, cell) in QUICK)))
    maximum = {"slides": 1.1e-6, "opens": 1.1e-6, "traction": 1e-11, "jump": 1e-11}
    bounds = [Bound(one.name, "n=4", *bound) for one in series for bound in maximum.items()]
    return Case(f"fluid_{name}", title, "", series, joined_errors, None, ("dry triangle", "n=4", "traction"), None, ("", ""), None, bounds,
                called=("pressure", "traction"))


def fluid_block():
    return joined("block", poro_exact.CONFINED, "a sheared block with closure and dilation, whose fracture slides and opens by fluid")


def fluid_onset():
    return joined("onset", poro_exact.STRESSED, "a fracture under stress that slides and opens by fluid")


# Crack filled with a given volume of fluid

def volume_errors(run, known):
    """Errors of pressure, jump and volume. After the injection, the pressure in the crack is uniform."""
    means = cases.crack_jumps(run, known) if run.dimension == 2 else measure.face_means(known.jump, run.corners(), 12)
    size, p = measure.area(run.corners()), run.data("fracture pressure")[:, None]
    volume = (size * run.data("opening")).sum() / poro_exact.filling(run.dimension, 0.25)
    return {"pressure": measure.relative(p - poro_exact.FILLED, np.full_like(p, poro_exact.FILLED), size),
            "jump": measure.jump_error(run, means), "volume": max(abs(volume - 1), 1e-17)}


def volume_series():
    def disc(smallest, growth, h):
        return f"front {smallest:g}", lambda folder: meshes.penny(folder, h, smallest, growth)
    discs = [disc(0.2, 0.5, 1), disc(0.1, 0.35, 0.8), disc(0.05, 0.25, 0.6)]
    flat, round_ = exact.Crack(1, poro_exact.FILLED, 1, 0.25), exact.Penny(poro_exact.FILLED, 1, 0.25)
    sizes = (0.4, 0.2, 0.1)
    planes = {"order 1": (uniform(1, sizes), 2), "order 2": (uniform(2, sizes), 0), "graded order 2": (graded(2, *cases.GRADED), 0)}
    series = [Series(f"{kind} {name}", grids, "verification/crack_volume_2d.xml", sets, flat, quick)
              for kind, sets in (("dry", ()), ("undrained", undrained(1))) for name, (grids, quick) in planes.items()]
    scene = "verification/crack_volume_3d.xml"
    return series + [Series(f"dry disc order {k}", gmsh(k, *discs[:4 - k]), scene, (), round_, 2 - k) for k in (1, 2)]


def crack_volume():
    """Case of a crack whose opening is the only storage. Undrained rock has the same stiffness as the dry rock."""
    series = volume_series()
    finest = series[2].meshes[-1][0]
    bounds = [Order(one.name, "pressure", 1) for one in series if one.name[-1] == "1"]
    bounds += [Bound(one.name, label, "volume", 1e-6) for one in series for label, _ in one.meshes]
    maximum = {("dry order 1", "h=0.2"): (4e-2, 2e-2), ("undrained order 1", "h=0.2"): (3e-2, 1.2e-2),
            ("dry order 2", "h=0.1"): (2.5e-3, 2.5e-3), ("dry disc order 2", "front 0.1"): (2e-2, 2e-2),
            ("dry graded order 2", finest): (1e-4, 1e-4), ("undrained graded order 2", finest): (6e-4, 1.5e-4)}
    bounds += [Bound(*of, *bound) for of, both in maximum.items() for bound in zip(("pressure", "jump"), both)]
    return Case("crack_volume", "a crack filled with a given volume of fluid", "", series, volume_errors, None,
                ("dry graded order 2", finest, "pressure"), None, ("pressure", "jump"), None, bounds, called=("pressure", "jump"))


CASES = (mms_opening2d, mms_opening3d, fluid_block, fluid_onset, crack_volume)
