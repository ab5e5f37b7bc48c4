"""Cases of poroelasticity: scenes, meshes, measured errors and bounds."""
import csv

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from perf.verification import flow_measure, measure, meshes, poro_exact, poro_measure
from perf.verification.cases import REFERENCES, Bound, Case, Order, Series, gmsh

CALLED = ("pressure", "settlement")
SHAPES = {2: ("triangle", "quadrilateral"), 3: ("tetrahedron", "hexahedron")}


def case(name, title, series, errors, headline, bounds, orders=("", "")):
    return Case(name, title, "", series, errors, None, headline, None, orders, None, bounds, called=CALLED)


def numbers(values):
    return "{" + ", ".join(f"{value:.17g}" for value in values) + "}"


def column(d, n, steps):
    return (f"n={n}", (f"Mesh.cells={numbers([n // 5] * (d - 1) + [n])}", f"Time.steps={steps}"))


def mean_pressures(run, function):
    """Relative L2 error of the mean pressures of cells."""
    p = flow_measure.array(run, "pressure")[:, None]
    return flow_measure.mean_error(p, lambda x: function(x)[:, None], *flow_measure.cell_points(run))


def pressures(run, exact_at, axis):
    """Relative L2 error of mean pressures, for exact pressures that depend on one coordinate; equal coordinates
    are evaluated once."""
    def at(x):
        places, which = np.unique(x[:, axis].round(12), return_inverse=True)
        return exact_at(places)[which]
    return mean_pressures(run, at)


def terzaghi():
    """Case with a number of steps proportional to the square of the number of cells along the column (implicit
    Euler)."""
    known, t = poro_exact.COLUMN, 0.1 / poro_exact.COLUMN.rock.c

    def errors(run, _):
        up = run.dimension - 1
        u, points = (vtk_to_numpy(values)[:, up] for values in (run.rock.GetPointData().GetArray("displacement"), run.rock.GetPoints().GetData()))
        top = -u[np.isclose(points, known.H)].mean()
        return {"pressure": pressures(run, lambda z: known.pressure(known.H - z, t), up), "settlement": abs(top / known.settlement(t) - 1)}
    series = [Series(f"{cell} order 1", [column(d, n, n * n // 4) for n in ((10, 20, 40) if d == 2 else (5, 10, 20))], f"verification/terzaghi_{d}d.xml",
                     (f"Mesh.cell={cell}",), known, 2) for d in (2, 3) for cell in SHAPES[d]]
    bounds = [Order(one.name, name, minimum) for one in series for name, minimum in (("pressure", 2), ("settlement", 2))]
    bounds += [Bound(one.name, one.meshes[-1][0], "pressure", 5e-3) for one in series]
    return case("terzaghi", "consolidation of a column", series, errors, ("triangle order 1", "n=40", "pressure"), bounds, ("pressure", "settlement"))


def undrained():
    """Case of rapid loading of a homogeneous and a layered column: the pressure must reach, but not exceed, its
    undrained value.

    Slightly drained homogeneous columns must follow the exact profile."""
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
    """Case of pressure errors at 50 s with steps of 5 s, at 48 s with decreasing steps, and at 5000 s."""
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
              Series("BDF2 5 s", [steps(50, 4, 5.0), steps(100, 4, 5.0), steps(200, 4, 5.0), steps(400, 4, 5.0)], "verification/mandel.xml",
                     ("Mesh.cell=quadrilateral", "Time.scheme=BDF2"), known, 1, dimension=1),
              Series("triangle 5 s", [steps(50, 4, 5.0), steps(100, 8, 5.0), steps(150, 8, 5.0)], "verification/mandel.xml", (), known, 1),
              Series("quadrilateral step 1", [steps(50, 4, 4.0, 48.0), steps(100, 4, 1.0, 48.0), steps(200, 4, 0.25, 48.0)], "verification/mandel.xml",
                     ("Mesh.cell=quadrilateral",), known, 2, dimension=1),
              Series("quadrilateral 5000 s", [steps(50, 4, 250.0, 5000.0), steps(100, 4, 62.5, 5000.0)], "verification/mandel.xml",
                     ("Mesh.cell=quadrilateral",), known, 1, dimension=1)]
    bounds = [Bound("quadrilateral 5 s", "400 x 4, 5 s", "pressure", 3.5e-3), Bound("BDF2 5 s", "400 x 4, 5 s", "pressure", 1e-3), Bound("triangle 5 s", "150 x 8, 5 s", "pressure", 4e-3),
              Order("quadrilateral step 1", "pressure", 2), Order("quadrilateral 5000 s", "pressure", 2)]
    return case("mandel", "a plate between rigid plates", series, errors, ("quadrilateral 5 s", "400 x 4, 5 s", "pressure"), bounds)


# Manufactured solutions

EVERY = ("pressure", "flow", "u", "force")
IRREGULAR = {"triangle gmsh": 1.5, "tetrahedron": 1.25}  # orders of flows, where errors of neighbours do not cancel
# errors above those of the peer; README.md explains the reason
WORSE = {"force": ("triangle gmsh 2",), "flow": ("hexahedron 2",)}


def peer():
    """Errors of the peer on meshes with the same number of cells, {(series, mesh): row}."""
    with open(REFERENCES.parents[2] / "docs/results/porepy_poro.csv") as file:
        return {(row["series"], row["mesh"]): row for row in csv.DictReader(line for line in file if not line.startswith("#"))}


def comparison(series):
    """Bounds and points from the peer, on meshes with the same number of cells; the peer has linear cells."""
    rows, shapes = peer(), {one.name[:-2] for one in series}
    bounds = [Bound(f"{shape} 2", mesh, name, float(row[name])) for (shape, mesh), row in rows.items() if shape in shapes
              for name in EVERY if f"{shape} 2" not in WORSE.get(name, ())]
    points = []
    for shape in sorted(shapes & {shape for shape, _ in rows}):
        of = [row for (name, _), row in rows.items() if name == shape]
        points.append((f"PorePy, {shape}", [int(row["unknowns"]) for row in of], [float(row["u"]) for row in of]))
    return bounds, points


def manufactured(d, series, minimum, headline):
    """Case; `minimum` = {series: orders of u and force}. The order of pressures is 2."""
    bounds, points = comparison(series)
    bounds += [Order(one.name, "pressure", 2) for one in series]
    bounds += [Order(one.name, name, IRREGULAR.get(one.name[:-2], 2)) for one in series for name in ("flow", "through")]
    bounds += [Order(name, *bound) for name, both in minimum.items() for bound in zip(("u", "force"), both)]
    return Case(f"mms_poro{d}d", f"manufactured solution of poroelasticity in {d}D", "", series, poro_measure.centre_errors, None,
                (*headline, "u"), None, ("pressure", "u"), None, bounds, points, called=("pressure", "u"))


def made(d, shape, order, counts, quick=0):
    """Series on boxes with these numbers of cells along each edge."""
    grids = [(f"n={n}", (f"Mesh.cells={numbers([n] * d)}",)) for n in counts]
    sets = (f"Mesh.cell={shape}", f"Mesh.order={order}")
    return Series(f"{shape} {order}", grids, f"verification/manufactured_poro_{d}d.xml", sets, poro_exact.Manufactured(d), quick)


def mms_poro2d():
    """Case in 2D. With cells of order 2, u has order 3 until the error of the pressure, of order 2, dominates."""
    series = [made(2, shape, order, counts, 2 * (shape[0] == "q" or order == 2))
              for shape, counts in (("quadrilateral", (4, 8, 16, 32, 64)), ("triangle", (8, 16, 32))) for order in (1, 2)]
    makers = [(f"h={h:g}", lambda folder, h=h: meshes.square(folder, h)) for h in (1 / 4, 1 / 8, 1 / 16, 1 / 32)]
    scene, known = "verification/manufactured_poro_gmsh.xml", poro_exact.Manufactured(2)
    series += [Series(f"triangle gmsh {order}", gmsh(order, *makers), scene, (), known) for order in (1, 2)]
    minimum = {"quadrilateral 1": (2, 2), "quadrilateral 2": (2, 2), "triangle 1": (2, 1), "triangle 2": (2.5, 2), "triangle gmsh 1": (2, 1),
             "triangle gmsh 2": (2.5, 1.5)}
    return manufactured(2, series, minimum, ("quadrilateral 2", "n=64"))


def mms_poro3d():
    quick = {("hexahedron", 1): 2, ("tetrahedron", 2): 1}
    every = [(shape, order) for shape in SHAPES[3] for order in (1, 2)]
    series = [made(3, *of, (4, 8, 12, 24) if of == ("hexahedron", 1) else (4, 8, 12), quick.get(of, 0)) for of in every]
    minimum = {"hexahedron 1": (2, 1.9), "hexahedron 2": (3, 1.9), "tetrahedron 1": (1.6, 1), "tetrahedron 2": (2.5, 1.5)}
    return manufactured(3, series, minimum, ("hexahedron 2", "n=12"))


# Time steps

SCHEMES = {"Euler": (1, ()), "BDF2": (2, ("Time.scheme=BDF2",))}  # order; entries of the scene


def time_errors(run, known):
    """Errors. With a fracture, `pressure` is the largest error in fracture and rock, and `u` the error of the
    opening."""
    if run.faces is None:
        return {"pressure": mean_pressures(run, known.pressure), "u": measure.displacement_error(run, known)}
    p = np.concatenate([flow_measure.array(run, "pressure"), run.data("fracture pressure")])
    return {"pressure": np.abs(p / known.pressure - 1).max(), "u": np.abs(run.data("opening") / known.opening - 1).max()}


def poro_time():
    """Case of solutions that the cells represent exactly, with errors of the time steps only."""
    steps = [(f"{n} steps", (f"Time.steps={n}",)) for n in (10, 20, 40, 80, 160)]
    series, bounds = [], []
    for scheme, (order, entries) in SCHEMES.items():
        for what, known in (("rock quadrilateral", poro_exact.InTime()), ("fracture tetrahedron", poro_exact.OpenInTime())):
            scene = f"verification/poro_time_{what.split()[0]}.xml"
            series.append(Series(f"{what} {scheme}", steps, scene, (f"Mesh.cell={what.split()[1]}", *entries), known, 2))
        bounds += [Order(scheme, name, order) for name in ("pressure", "u")]
    return Case("poro_time", "error and length of time steps", "", series, time_errors, None,
                ("rock quadrilateral Euler", "160 steps", "pressure"), None, ("pressure", "u"), None, bounds, called=("pressure", "u"))


CASES = (terzaghi, undrained, mandel, mms_poro2d, mms_poro3d, poro_time)
