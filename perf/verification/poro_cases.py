"""The cases of poroelasticity: scenes, meshes, what is measured on them, and the bounds."""
import csv
from dataclasses import replace

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

import cases
import exact
import flow_measure
import measure
import meshes
import poro_exact
import poro_measure
from cases import REFERENCES, Bound, Case, Order, Series, gmsh, graded, uniform

CALLED = ("pressure", "settlement")
SHAPES = {2: ("triangle", "quadrilateral"), 3: ("tetrahedron", "hexahedron")}


def case(name, title, series, errors, headline, bounds, orders=("", "")):
    return Case(name, title, "", series, errors, None, headline, None, orders, None, bounds, called=CALLED)


def numbers(values):
    return "{" + ", ".join(f"{value:.17g}" for value in values) + "}"


def column(d, n, steps):
    return (f"n={n}", (f"Mesh.cells={numbers([n // 5] * (d - 1) + [n])}", f"Time.steps={steps}"))


def pressures(run, exact_at, axis):
    """Relative L2 error of the mean pressures of cells, against those at their centres' coordinate."""
    points, weights = flow_measure.cell_points(run)
    return flow_measure.mean_error(flow_measure.array(run, "pressure")[:, None], lambda x: exact_at(x[:, axis])[:, None], points, weights)


def terzaghi():
    """Steps are as the square of the size of cells, for implicit Euler."""
    known, t = poro_exact.COLUMN, 0.1 / poro_exact.COLUMN.rock.c

    def errors(run, _):
        up = run.dimension - 1
        u, points = (vtk_to_numpy(values)[:, up] for values in (run.rock.GetPointData().GetArray("displacement"), run.rock.GetPoints().GetData()))
        top = -u[np.isclose(points, known.H)].mean()
        return {"pressure": pressures(run, lambda z: known.pressure(known.H - z, t), up), "settlement": abs(top / known.settlement(t) - 1)}
    series = [Series(f"{cell} order 1", [column(d, n, n * n // 4) for n in ((10, 20, 40) if d == 2 else (5, 10, 20))], f"verification/terzaghi_{d}d.xml",
                     (f"Mesh.cell={cell}",), known, 2) for d in (2, 3) for cell in SHAPES[d]]
    bounds = [Order(one.name, name, least) for one in series for name, least in (("pressure", 2), ("settlement", 2))]
    bounds += [Bound(one.name, one.meshes[-1][0], "pressure", 5e-3) for one in series]
    return case("terzaghi", "consolidation of a column", series, errors, ("triangle order 1", "n=40", "pressure"), bounds, ("pressure", "settlement"))


def undrained():
    """The pressure of a column that is loaded quickly rises to its undrained value and no higher, of one kind of rock and of layers;
    one that drains a little follows the exact profile."""
    known = poro_exact.COLUMN

    def errors(run, exact):
        p, t = flow_measure.array(run, "pressure"), run.results["steps"][-1]["time"]
        found = {"above": max(p.max() / known.undrained - 1, 1e-17), "below": max(-p.min() / known.undrained, 1e-17)}
        return {**found, "pressure": pressures(run, lambda z: exact.pressure(exact.H - z, t), run.dimension - 1)} if exact else found
    times = [(f"t={t:g}", (f"Time.end={t:g}", "Time.steps=1", f"Mesh.cells={{cells}}")) for t in (1e-12, 1e-6, 1e-4, 1e-3, 1e-2)]
    series = []
    for d in (2, 3):
        cells = numbers([4] * (d - 1) + [20])
        steps = [(label, tuple(entry.replace("{cells}", cells) for entry in entries)) for label, entries in times]
        series += [Series(f"{cell} {kind}", steps, f"verification/{scene}_{d}d.xml", (f"Mesh.cell={cell}",), known if kind == "alike" else None, 2)
                   for cell in SHAPES[d] for kind, scene in (("alike", "terzaghi"), ("layers", "layers"))]
    bounds = [Bound(one.name, label, name, 1e-2) for one in series for label, _ in one.meshes for name in ("above", "below")]
    return case("undrained", "steps too short for drainage", series, errors, ("triangle alike", "t=1e-12", "above"), bounds)


def mandel():
    """The error at 50 s, of steps of 5 s and less, and the rise of the pressure in the middle after the load (Mandel and Cryer)."""
    known = poro_exact.PLATE

    def errors(run, _):
        t = run.results["steps"][-1]["time"]
        return {"pressure": pressures(run, lambda x: known.pressure(x, t), 0)}

    def steps(n, m, step, end=50.0):
        times = poro_exact.mandel_times(step, end)
        way = known.way(times)
        return (f"{n} x {m}, {step:g} s", (f"Mesh.cells={numbers([n, m])}", f"Time.schedule={numbers(times)}", f"Tables.plate.arguments={numbers(way[0])}",
                                          f"Tables.plate.values={numbers(way[1])}"))
    series = [Series("quadrilateral 5 s", [steps(50, 4, 5.0), steps(100, 4, 5.0), steps(200, 4, 5.0), steps(400, 4, 5.0)], "verification/mandel.xml",
                     ("Mesh.cell=quadrilateral",), known, 2, dimension=1),
              Series("triangle 5 s", [steps(50, 4, 5.0), steps(100, 8, 5.0), steps(150, 8, 5.0)], "verification/mandel.xml", (), known, 1),
              Series("quadrilateral step 1", [steps(50, 4, 4.0, 48.0), steps(100, 4, 1.0, 48.0), steps(200, 4, 0.25, 48.0)], "verification/mandel.xml",
                     ("Mesh.cell=quadrilateral",), known, 2, dimension=1),
              Series("quadrilateral 5000 s", [steps(50, 4, 250.0, 5000.0), steps(100, 4, 62.5, 5000.0)], "verification/mandel.xml",
                     ("Mesh.cell=quadrilateral",), known, 1, dimension=1)]
    bounds = [Bound("quadrilateral 5 s", "400 x 4, 5 s", "pressure", 3.5e-3), Bound("triangle 5 s", "150 x 8, 5 s", "pressure", 4e-3),
              Order("quadrilateral step 1", "pressure", 2), Order("quadrilateral 5000 s", "pressure", 2)]
    return case("mandel", "a plate pressed together", series, errors, ("quadrilateral 5 s", "400 x 4, 5 s", "pressure"), bounds)


# A fracture that a fluid makes slide and open

def mean_state(step):
    """"stick", "slip", "open" or "mixed", normal and shear traction, normal and tangential jump of the fracture."""
    of = step["fractures"]["fracture"]
    name = next((name for name in ("stick", "slip", "open") if of[f"fraction_{name}"] > 1 - 1e-9), "mixed")
    (N, *T), (opening, *sliding) = (of[f"mean_{what}"]["local"] for what in ("traction", "jump"))
    return name, -N, np.linalg.norm(T), opening, np.linalg.norm(sliding)


def onset_error(path, states, before, after, exact):
    """How far from the exact pressure the one may be at which `before` becomes `after`; 1 if it never does so."""
    low, high = ([p for p, state in zip(path, states) if state == name] for name in (before, after))
    return max(abs(p / exact - 1) for p in (max(low), min(high))) if low and high and max(low) < min(high) else 1.0


def joined(name, known, title):
    """The rock is `dry`, without Biot's coupling; keeps its fluid (`undrained`); or has the pressure of the fracture (`drained`)."""
    lam = known.lam * 0.4
    kinds = {"dry": (known, ()), "drained": (replace(known, share=0.5), ("Materials.rock.Biot coefficient=0.5", "Materials.rock.permeability={1.0}")),
             "undrained": (known, ("Materials.rock.Biot coefficient=1", f"Materials.rock.Lame's first parameter={lam!r}",
                                   f"Materials.rock.compressibility of pores={1 / (known.lam - lam)!r}"))}

    def errors(run, exact):
        path = exact.path()[1:]
        found, states = [mean_state(step) for step in run.results["steps"]], [exact.state(p) for p in path]
        pairs = zip(exact.onset, (("stick", "slip"), ("slip", "open")))
        slides, opens = (onset_error(path, [one[0] for one in found], *names, p) for p, names in pairs)
        off, size = (np.array([one[1:] for one in of]) for of in (found, states))
        worst = [float(np.max(np.abs(off - size)[:, of]) / np.max(np.abs(size[:, of]))) for of in (slice(0, 2), slice(2, 4))]
        return {"slides": slides, "opens": opens, "traction": max(worst[0], 1e-17), "jump": max(worst[1], 1e-17)}
    series = [Series(f"{kind} {cell}", [("n=4", (f"Mesh.cells={numbers([4] * d)}",))], f"verification/fluid_{name}_{d}d.xml",
                     (f"Mesh.cell={cell}", f"Tables.p.values={numbers(exact.path())}", *sets), exact, int((kind, cell) in QUICK))
              for kind, (exact, sets) in kinds.items() for d in (2, 3) for cell in SHAPES[d]]
    bounds = [Bound(one.name, label, what, most) for one in series for label, _ in one.meshes
              for what, most in (("slides", 1.1e-6), ("opens", 1.1e-6), ("traction", 1e-11), ("jump", 1e-11))]
    return Case(f"fluid_{name}", title, "", series, errors, None, ("dry triangle", "n=4", "traction"), None, ("", ""), None, bounds, called=("pressure", "traction"))


QUICK = (("dry", "triangle"), ("undrained", "quadrilateral"), ("drained", "tetrahedron"))


def fluid_block():
    return joined("block", poro_exact.CONFINED, "a sheared block with closure and dilation, whose fracture slides and opens by fluid")


def fluid_onset():
    return joined("onset", poro_exact.STRESSED, "a fracture under stress that slides and opens by fluid")


# A crack that a given volume of fluid fills

UNDRAINED = ("Materials.rock.Biot coefficient=1", "Materials.rock.Lame's first parameter=0.4", "Materials.rock.compressibility of pores=1.6666666666666667")


def crack_volume():
    """Nothing but the opening takes up fluid. `pressure` is that in the crack, which is the same everywhere once nothing flows any more; undrained rock has the
    stiffness that dry rock has without its fluid."""
    def errors(run, known):
        means = cases.crack_jumps(run, known) if run.dimension == 2 else measure.face_means(known.jump, run.corners(), 12)
        size, opening, p = measure.area(run.corners()), run.data("opening"), run.data("fracture pressure")
        volume = abs((size * opening).sum() / poro_exact.filling(run.dimension, 0.25) - 1)
        return {"pressure": measure.relative((p - poro_exact.FILLED)[:, None], np.full((len(p), 1), poro_exact.FILLED), size), "jump": measure.jump_error(run, means),
                "volume": max(volume, 1e-17)}

    def disc(smallest, growth, h):
        return f"front {smallest:g}", lambda folder: meshes.penny(folder, h, smallest, growth)
    discs = [disc(0.2, 0.5, 1), disc(0.1, 0.35, 0.8), disc(0.05, 0.25, 0.6)]
    crack, flat = exact.Crack(1, poro_exact.FILLED, 1, 0.25), "verification/crack_volume_2d.xml"
    series = [Series("dry order 1", uniform(1, (0.4, 0.2, 0.1)), flat, (), crack, 2), Series("dry order 2", uniform(2, (0.4, 0.2, 0.1)), flat, (), crack),
              Series("dry graded order 2", graded(2, *cases.GRADED), flat, (), crack), Series("undrained order 1", uniform(1, (0.4, 0.2, 0.1)), flat, UNDRAINED, crack, 2),
              Series("undrained graded order 2", graded(2, *cases.GRADED), flat, UNDRAINED, crack),
              Series("dry disc order 1", gmsh(1, *discs), "verification/crack_volume_3d.xml", (), exact.Penny(poro_exact.FILLED, 1, 0.25), 1),
              Series("dry disc order 2", gmsh(2, *discs[:2]), "verification/crack_volume_3d.xml", (), exact.Penny(poro_exact.FILLED, 1, 0.25))]
    bounds = [Order(one.name, "pressure", 1) for one in series if one.name != "dry order 2"]
    bounds += [Bound(one.name, label, "volume", 1e-6) for one in series for label, _ in one.meshes]
    finest = series[2].meshes[-1][0]
    bounds += [Bound(name, mesh, what, most) for name, mesh, most_p, most_jump in (
        ("dry order 1", "h=0.2", 4e-2, 2e-2), ("undrained order 1", "h=0.2", 3e-2, 1.2e-2), ("dry order 2", "h=0.1", 2.5e-3, 2.5e-3), ("dry graded order 2", finest, 1e-4, 1e-4),
        ("undrained graded order 2", finest, 6e-4, 1.5e-4), ("dry disc order 2", discs[1][0], 2e-2, 2e-2)) for what, most in (("pressure", most_p), ("jump", most_jump))]
    return Case("crack_volume", "a crack filled with a given volume of fluid", "", series, errors, None, ("dry graded order 2", series[2].meshes[-1][0], "pressure"), None,
                ("pressure", "jump"), None, bounds, called=("pressure", "jump"))


# Manufactured solutions

EVERY = ("pressure", "flow", "u", "force")
IRREGULAR = {"triangle gmsh": 1.5, "tetrahedron": 1.25}  # orders of flows, where errors of neighbours do not cancel
WORSE = {"force": ("triangle gmsh 2",), "flow": ("hexahedron 2",)}  # than the peer, README.md says why


def peer():
    """{(series, mesh): row} of errors of the peer on meshes of as many cells."""
    with open(REFERENCES / "poro_peer.csv") as file:
        return {(row["series"], row["mesh"]): row for row in csv.DictReader(file)}


def manufactured(d, counts, least, quick):
    """`counts` and `least` orders of u and force by shape and order of cells; pressures and flows have order 2."""
    known, scene = poro_exact.Manufactured(d), f"verification/manufactured_poro_{d}d.xml"
    series = [Series(f"{shape} {order}", [(f"n={n}", (f"Mesh.cells={numbers([n] * d)}",)) for n in ns], scene, (f"Mesh.cell={shape}", f"Mesh.order={order}"), known,
                     quick.get((shape, order), 0)) for (shape, order), ns in counts.items()]
    if d == 2:
        series += [Series(f"triangle gmsh {order}", gmsh(order, *[(f"h={h:g}", lambda folder, h=h: meshes.square(folder, h)) for h in (1 / 4, 1 / 8, 1 / 16, 1 / 32)]),
                          "verification/manufactured_poro_gmsh.xml", (), known) for order in (1, 2)]
    bounds = [Order(one.name, "pressure", 2) for one in series]
    bounds += [Order(one.name, name, IRREGULAR.get(one.name[:-2], 2)) for one in series for name in ("flow", "through")]
    bounds += [Order(f"{shape} {order}", name, value) for (shape, order), both in least.items() for name, value in zip(("u", "force"), both)]
    bounds += [Bound(f"{shape} 2", mesh, name, float(row[name])) for (shape, mesh), row in peer().items() for name in EVERY if f"{shape} 2" not in WORSE.get(name, ())]
    others = {shape for shape, _ in peer()} & {one.name[:-2] for one in series}
    points = [(f"PorePy, {shape}", *zip(*[(int(row["unknowns"]), float(row["u"])) for (of, _), row in peer().items() if of == shape])) for shape in sorted(others)]
    return Case(f"mms_poro{d}d", f"manufactured solution of poroelasticity in {d}D", "", series, lambda run, exact: poro_measure.centre_errors(run, exact), None,
                (f"{('quadrilateral', 'hexahedron')[d - 2]} 2", f"n={(32, 12)[d - 2]}", "u"), None, ("pressure", "u"), None, bounds, points, called=("pressure", "u"))


def mms_poro2d():
    """Order 2 of cells: u has order 3 until the error of the pressure, of order 2, is larger."""
    return manufactured(2, {("quadrilateral", 1): (4, 8, 16, 32), ("quadrilateral", 2): (4, 8, 16, 32), ("triangle", 1): (8, 16, 32), ("triangle", 2): (8, 16, 32)},
                        {("quadrilateral", 1): (2, 2), ("quadrilateral", 2): (2, 2), ("triangle", 1): (2, 1), ("triangle", 2): (2.5, 2), ("triangle gmsh", 1): (2, 1),
                         ("triangle gmsh", 2): (2.5, 1.5)}, {("quadrilateral", 1): 2, ("triangle", 2): 2})


def mms_poro3d():
    return manufactured(3, {("hexahedron", 1): (4, 8, 12), ("hexahedron", 2): (4, 8, 12), ("tetrahedron", 1): (4, 8, 12), ("tetrahedron", 2): (4, 8, 12)},
                        {("hexahedron", 1): (2, 1.9), ("hexahedron", 2): (3, 1.9), ("tetrahedron", 1): (1.6, 1), ("tetrahedron", 2): (2.5, 1.5)},
                        {("hexahedron", 1): 2, ("tetrahedron", 2): 1})


CASES = (terzaghi, undrained, mandel, fluid_block, fluid_onset, crack_volume, mms_poro2d, mms_poro3d)
