"""Cases of contact and friction: scenes, meshes, measured errors and bounds."""
import csv
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

import numpy as np

from perf.verification import exact, measure, meshes

REFERENCES = Path(__file__).resolve().parent / "references"


@dataclass
class Series:
    """Runs that differ in the mesh.

    `meshes` contains pairs of a label and either entries of the scene or a function folder -> entries that
    makes a gmsh mesh there. The first `quick` meshes belong to --quick."""
    name: str
    meshes: list
    scene: str = ""       # under xml/; default: the scene of the case
    sets: tuple = ()
    exact: object = None  # default: the solution of the case
    quick: int = 0
    prescribed: Callable = None  # default: the function of the case
    dimension: int = 0    # number of refined directions; 0: all


@dataclass
class Bound:
    """Bound error <= most on the mesh with this label and at most `unknowns` unknowns."""
    series: str
    mesh: str
    error: str
    maximum: float
    unknowns: float = math.inf


@dataclass
class Order:
    """Lower bound `minimum` on the observed order between the last two meshes of each series whose name contains
    `series`."""
    series: str
    error: str
    minimum: float


@dataclass
class Case:
    name: str
    title: str
    scene: str
    series: list
    errors: Callable      # function (run, exact solution) -> {name: error}
    # function (points of all nodes) -> number of prescribed displacement components; None without displacements
    prescribed: Callable
    headline: tuple       # series, mesh, error of the last line
    jumps: Callable       # function (run, exact solution) -> global face means [face, d]; None: without error estimate
    orders: tuple         # errors whose orders are in the last line; "": none
    exact: object = None
    bounds: list = field(default_factory=list)
    points: list = field(default_factory=list)  # published values: (label, unknowns, error)
    unsure: tuple = ()    # (series, mesh, "jump" or "stress") with an estimate off by more than a factor of 2
    called: tuple = ("u", "traction")  # names of the orders in the last line
    picture: Callable = None           # draws an additional picture into a file


def on_box(low, high):
    """Returns a function that counts the displacement components on the boundary of a box, which are all prescribed."""
    def count(points):
        outside = (np.abs(points - low) < 1e-9 * (high - low)) | (np.abs(points - high) < 1e-9 * (high - low))
        return points.shape[1] * int(outside.any(axis=1).sum())
    return count


def turned_box(half, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return lambda points: on_box(-half, half)(points @ np.array([[c, -s], [s, c]]))


def gmsh(order, *makers):
    """Returns [(label, function)] for gmsh meshes with cells of this order."""
    def entries(make):
        return lambda folder: (f"Mesh file.path={make(folder)}", f"Mesh file.order={order}")
    return [(label, entries(make)) for label, make in makers]


# Cracks in infinite bodies

def uniform(order, sizes, angle=0):
    return gmsh(order, *[(f"h={h:g}", lambda folder, h=h: meshes.uniform_crack(folder, h, angle)) for h in sizes])


def graded(order, *sizes):
    return gmsh(order, *[(f"h={h:g} tip h/{round(1 / ratio)}", lambda folder, h=h, ratio=ratio: meshes.graded_crack(folder, h, ratio))
                         for h, ratio in sizes])


def crack_jumps(run, known):
    return known.jump_mean(run.corners())


def crack_errors(run, known):
    found = {"jump": measure.jump_error(run, crack_jumps(run, known)), "u": measure.displacement_error(run, known)}
    if np.any(known.exact_traction):
        found["traction"], found["centre"] = measure.traction_errors(run, known, [known.tangent])
    return found


GRADED = ((0.6, 0.01), (0.39, 0.01), (0.18, 0.01))  # h, relative size at the tip


def crack_series():
    return [Series("U order 1", uniform(1, (0.4, 0.2, 0.1, 0.05)), quick=3), Series("U order 2", uniform(2, (0.4, 0.2, 0.1)), quick=2),
            Series("graded order 2", graded(2, *GRADED), quick=2)]


def sneddon():
    fine, finer = (label for label, _ in graded(2, *GRADED)[1:])
    bounds = [Bound("U order 1", "h=0.1", "jump", 1.4e-2), Bound("U order 2", "h=0.2", "jump", 3e-3),
              Bound("graded order 2", fine, "jump", 5e-4, 4500), Bound("graded order 2", finer, "jump", 1e-4, 20000)]
    return Case("sneddon", "crack under pressure", "verification/sneddon.xml", crack_series(), crack_errors, on_box(-2, 2),
                ("U order 2", "h=0.2", "jump"), crack_jumps, ("u", ""), exact.Crack(1, 1e-3, 1, 0.25), bounds,
                [("MPSA, mesh U", (2844, 11028, 43412), (6.8e-3, 4.6e-3, 2.2e-3))])


def sneddon_shear():
    return Case("sneddon_shear", "crack that slides", "verification/sneddon_shear.xml", crack_series(), crack_errors, on_box(-2, 2),
                ("U order 2", "h=0.2", "jump"), crack_jumps, ("u", "traction"), exact.Crack(2, 1e-3, 1, 0.25, traction=(-1e-3, 0.5e-3)),
                [Bound("U order 1", "h=0.1", "jump", 2e-2), Bound("U order 2", "h=0.2", "jump", 4e-3)],
                [("MPSA, mesh U", (2844, 11028), (7.2e-2, 3.6e-2))])


def inclined():
    psi, G, K = math.radians(20), 10e9, 16.67e9
    lam, mu, load = K - 2 * G / 3, math.tan(math.radians(30)), 100e6
    N, shear = load * math.sin(psi)**2, load * math.sin(psi) * math.cos(psi)
    known = exact.Crack(2, shear - mu * N, G, lam / (2 * (lam + G)), 20, (-load, 0, 0), (-N, mu * N))
    series = [Series("U order 1", uniform(1, (0.4, 0.2, 0.1), 20), quick=2), Series("U order 2", uniform(2, (0.4, 0.2, 0.1), 20), quick=2)]
    return Case("inclined", "crack at 20 degrees to compression", "verification/inclined_crack.xml", series, crack_errors,
                turned_box(2, 20), ("U order 2", "h=0.2", "jump"), crack_jumps, ("u", "traction"), known, [Bound("U order 2", "h=0.2", "jump", 4e-3)])


def penny():
    def mesh(h, smallest, growth):
        return f"front {smallest:g}", lambda folder: meshes.penny(folder, h, smallest, growth)

    def jumps(run, known):
        return measure.face_means(known.jump, run.corners(), 12)

    def errors(run, known):
        return {"jump": measure.jump_error(run, jumps(run, known)), "u": measure.displacement_error(run, known)}
    series = [Series("order 1", gmsh(1, mesh(1, 0.2, 0.5), mesh(0.8, 0.1, 0.35), mesh(0.6, 0.05, 0.25), mesh(0.5, 0.025, 0.2)), quick=2),
              Series("order 2", gmsh(2, mesh(1, 0.2, 0.5), mesh(1, 0.1, 0.5), mesh(1, 0.05, 0.5), mesh(1, 0.035, 0.5)), quick=1)]
    return Case("penny", "disc under pressure", "verification/penny.xml", series, errors, on_box(-2, 2),
                ("order 2", "front 0.035", "jump"), jumps, ("u", ""), exact.Penny(1e-3, 1, 0.25),
                [Bound("order 2", "front 0.035", "jump", 3e-2, 60000), Order("order", "jump", 1)])


# Manufactured solutions

# coarse meshes with estimates off by more than a factor of 2
COARSE = {2: (("mixed quadrilateral 1", "n=8", "jump"),),
          3: (("uniform tetrahedron 1", "n=4", "jump"), ("uniform hexahedron 2", "n=4", "jump"))}


def manufactured(dimension, cells):
    """Case of all regimes; `cells` = {(shape, order): numbers of cells per edge}."""
    def jumps(run, known):
        return measure.face_means(known.jump, run.corners())

    def errors(run, known):
        u = measure.displacement_error(run, known)
        traction, centre = measure.traction_errors(run, known, np.eye(dimension)[:-1])
        return {"u": u, "jump": measure.jump_error(run, jumps(run, known)), "traction": traction, "centre": centre}
    series = []
    for regime in ("mixed", "stick", "slip", "uniform"):
        for (shape, order), counts in cells.items():
            sets = (f"Mesh.cell={shape}", f"Mesh.order={order}")
            grids = [(f"n={n}", (f"Mesh.cells={{{', '.join([str(n)] * dimension)}}}",)) for n in counts[:None if regime == "mixed" else 3]]
            quick = {"mixed": 3 if dimension == 2 else 2, "uniform": 2}.get(regime, 0) if shape in ("triangle", "tetrahedron") else 0
            series.append(Series(f"{regime} {shape} {order}", grids, f"verification/manufactured_{regime}_{dimension}d.xml", sets,
                                 exact.Manufactured(dimension, regime), quick))
    shape = "triangle" if dimension == 2 else "tetrahedron"
    bounds = [Order(one.name, name, minimum) for one in series for name, minimum in (("jump", 1.5), ("traction", 1))]
    bounds += [Order(one.name, "u", 3 if one.name.startswith("uniform") and one.name.endswith("2") else 2) for one in series]
    bounds += [Order(one.name, "centre", 2) for one in series if one.name.endswith("2")]
    bounds.append(Bound(f"mixed {shape} 2", f"n={cells[shape, 2][-1]}", "u", 1e-4 if dimension == 2 else 5e-4))
    return Case(f"mms{dimension}d", f"manufactured solution in {dimension}D: stick, slip, mixed", "", series, errors, on_box(0, 1),
                (f"mixed {shape} 2", f"n={cells[shape, 2][-1]}", "u"), jumps, ("u", "centre"), None, bounds, unsure=COARSE[dimension])


def mms2d():
    return manufactured(2, {("triangle", 1): (8, 16, 32, 64), ("quadrilateral", 1): (8, 16, 32, 64),
                            ("triangle", 2): (4, 8, 16, 32), ("quadrilateral", 2): (4, 8, 16, 32)})


def mms3d():
    return manufactured(3, {("tetrahedron", 1): (4, 8, 12), ("hexahedron", 1): (4, 8, 12),
                            ("tetrahedron", 2): (4, 6, 8, 12), ("hexahedron", 2): (4, 6, 8, 12)})


# Independent references

def t_junction():
    """Case with reference values of references/t_junction.py."""
    integrals = np.loadtxt(REFERENCES / "t_junction.csv", delimiter=",")
    volume, slip = 22.823, 1.0722
    apertures, slips, loads = (0.24187, 0.28184, 0.25141), (3.513e-3, 16.20e-3, 39.51e-3), (118.67e6, 116.20e6, 98.46e6)

    def jumps(run, _):
        means = np.zeros((len(run.faces.polygons), 2))
        for k, (name, axis) in enumerate((("horizontal", 0), ("vertical", 1))):
            on, known = run.on(name), integrals[integrals[:, 0] == k]
            a, b = np.sort(run.corners()[on][:, :, axis], axis=1).T
            opened, slid = ((np.interp(b, known[:, 1], total) - np.interp(a, known[:, 1], total)) / (b - a) for total in known[:, 2:].T)
            side = np.sign(run.data("jump")[on][:, 1 - axis] * run.data("jump local")[on][:, 0])  # sign of the normal
            means[on, axis], means[on, 1 - axis] = slid, opened * (side if axis else 1)
        return means

    def along(run, name, axis, values):
        """Returns a function of the coordinate along a fracture, linear between the face centres."""
        on = run.on(name)
        x = run.corners()[on].mean(axis=1)[:, axis]
        order = np.argsort(x)
        return lambda places: np.interp(places, x[order], values[on][order])

    def errors(run, _):
        size, local = measure.area(run.corners()), run.data("jump local")
        sliding = np.abs(local[:, 1])
        opened, slid = (size * local[:, 0])[run.on("vertical")].sum(), (size * sliding)[run.on("horizontal")].sum()
        at = np.array([-20, -12.5, -5])
        found = {"jump": measure.jump_error(run, jumps(run, None)), "volume": opened / volume - 1, "slip": slid / slip - 1,
                 "aperture": along(run, "vertical", 1, local[:, 0])(np.array([25, 50, 75]) - 50) / apertures - 1,
                 "slip at x": along(run, "horizontal", 0, sliding)(at) / slips - 1,
                 "traction": -along(run, "horizontal", 0, run.data("traction local")[:, 0])(at) / loads - 1}
        return {name: float(np.max(np.abs(value))) for name, value in found.items()}

    def mesh(h, ratio, half_width=32000):
        return f"growth {h:g}", lambda folder: meshes.t_junction(folder, h, ratio, half_width)
    series = [Series("order 1", gmsh(1, mesh(0.5, 0.02), mesh(0.25, 0.02), mesh(0.125, 0.02)), quick=2),
              Series("order 2", gmsh(2, mesh(0.5, 0.02), mesh(0.25, 0.02), mesh(0.125, 0.02)), quick=1),
              Series("order 2, box of half the width", gmsh(2, mesh(0.25, 0.02, 16000)), prescribed=on_box(-16000, 16000))]
    return Case("t_junction", "pressurised fracture that ends on a frictional one", "verification/t_junction.xml", series, errors,
                on_box(-32000, 32000), ("order 2", "growth 0.125", "volume"), jumps, ("volume", "traction"), None,
                [Bound("order 2", "growth 0.125", name, 2e-2) for name in ("volume", "slip", "aperture", "slip at x", "traction")]
                + [Bound("order 2", "growth 0.5", "volume", 2e-2), Order("order 1", "volume", 1)])


def wavy():
    known = exact.Wavy(0.4, 1, 0.25)

    def ends(run):
        return np.sort(run.corners()[:, :, 0], axis=1).T

    def jumps(run, known):
        opening = known.opening_mean(*ends(run))
        return np.stack([0 * opening, opening], axis=1)

    def errors(run, known):
        a, b = ends(run)
        means, pressure, opening = known.pressure_mean(a, b), -run.data("traction local")[:, 0], jumps(run, known)[:, 1]
        return {"jump": measure.relative((run.data("opening") - opening)[:, None], opening[:, None], b - a),
                "traction": measure.traction_errors(run, known, [[1, 0]], 40)[0],
                "mean": measure.relative((pressure - means)[:, None], means[:, None], b - a),
                "contact": abs((b - a)[pressure > 0].sum() / known.half_width - 1)}

    def prescribed(points):
        """Counts x components at the nodes of the lateral sides and y components at the nodes of the lower end."""
        x, y = points.T
        return int((np.abs(x) < 1e-9).sum() + (np.abs(x - 0.5) < 1e-9).sum() + (np.abs(y + 2) < 1e-9).sum())
    sizes = [(f"h={h:g}", lambda folder, h=h: meshes.wavy(folder, h)) for h in (0.05, 0.025, 0.0125, 0.00625)]
    return Case("wavy", "wavy fracture under compression", "verification/wavy.xml",
                [Series(f"order {k}", gmsh(k, *sizes), quick=3) for k in (1, 2)], errors, prescribed,
                ("order 2", "h=0.00625", "mean"), jumps, ("jump", "mean"), known,
                [Order("order", "traction", 0.8), Bound("order 2", "h=0.0125", "mean", 2e-2)])


def free_sides():
    """Case with the reference of references/free_sides.py: quadratic elements graded towards the corners."""
    rows = np.array([[float(word) for word in row] for row in csv.reader(open(REFERENCES / "free_sides.csv")) if row[0][0].isdigit()])
    (shear, load), profile = rows[0], rows[1:].T

    def jumps(run, _):
        slid = measure.face_means(lambda points: np.interp(points[:, 0], *profile), run.corners(), 10)
        return np.pad(slid, ((0, 0), (0, run.dimension - 1)))

    def errors(run, _):
        width = 1 if run.dimension == 2 else 0.125
        forces = run.results["steps"][-1]["reactions"][{2: "north", 3: "top"}[run.dimension]]
        return {"jump": measure.jump_error(run, jumps(run, None)), "shear force": abs(forces[0] / width / shear - 1), "load": abs(-forces[-1] / width / load - 1)}

    def prescribed(points):
        """Counts all components of the lowest and highest nodes; in 3D without the tied nodes at the far end in y."""
        held = (np.abs(points[:, -1]) < 1e-9) | (np.abs(points[:, -1] - 1) < 1e-9)
        if points.shape[1] == 3:
            held &= points[:, 1] < 0.125 - 1e-9
        return points.shape[1] * int(held.sum())

    def series(shape, order, counts):
        scene, cells = ("3d", "{{{n}, 1, {n}}}") if shape in ("tetrahedron", "hexahedron") else ("2d", "{{{n}, {n}}}")
        grids = [(f"n={n}", (f"Mesh.cells={cells.format(n=n)}",)) for n in counts]
        return Series(f"{shape} {order}", grids, f"verification/free_sides_{scene}.xml", (f"Mesh.cell={shape}", f"Mesh.order={order}"),
                      quick=3 if scene == "2d" else 2, dimension=2)
    every = [series(shape, order, counts) for shape in ("triangle", "quadrilateral", "tetrahedron", "hexahedron")
             for order, counts in ((1, (8, 16, 32, 64) if shape[-1] != "n" else (8, 16, 32)), (2, (8, 16, 32)))]
    return Case("free_sides", "block with free sides and a compliant fracture", "", every, errors, prescribed,
                ("quadrilateral 2", "n=32", "jump"), jumps, ("jump", "shear force"), None,
                [Bound(one.name, one.meshes[-1][0], name, 1e-3) for one in every if one.name[-1] == "2" for name in ("shear force", "load")])


CASES = (sneddon, sneddon_shear, inclined, penny, t_junction, wavy, free_sides, mms2d, mms3d)
