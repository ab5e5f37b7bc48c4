"""Cases of flow: scenes, meshes, measured errors and bounds."""
import csv
import math
from collections import namedtuple

import numpy as np

from perf.verification import flow_exact, flow_measure, meshes
import style
from perf.verification.cases import REFERENCES, Bound, Case, Order, Series, gmsh, graded, uniform

CALLED = ("pressure", "velocity")
DIRECT = ("Solver.Linear solver.type=direct",)  # for errors close to round-off


def boxes(d, counts):
    return [(f"n={n}", (f"Mesh.cells={{{', '.join([str(n)] * d)}}}",)) for n in counts]


def shapes(d):
    """Entries by scheme and cell shape: one scheme for each shape, and a second one for quadrilaterals and
    hexahedra."""
    simplex, cube = (("triangle", "quadrilateral"), ("tetrahedron", "hexahedron"))[d - 2]
    return {f"rt0 {simplex}": (f"Mesh.cell={simplex}",), f"tpfa {cube}": (f"Mesh.cell={cube}",), f"mimetic {cube}": (f"Mesh.cell={cube}", "Flow.scheme=mimetic")}


def case(name, title, series, errors, headline, bounds, orders=("", ""), **more):
    return Case(name, title, "", series, errors, None, headline, None, orders, None, bounds, called=CALLED, **more)


def all_errors(run, exact):
    return {**flow_measure.rock_errors(run, exact), **flow_measure.fracture_errors(run, exact)}


# Manufactured solutions

def manufactured(d, counts, quick):
    series = [Series(f"{kind} {name}", boxes(d, counts), f"verification/flow_{kind}_{d}d.xml", sets, flow_exact.Manufactured(d, kind == "resistance"), quick)
              for kind in ("resistance", "continuous") for name, sets in shapes(d).items()]
    bounds = [Order(one.name, name, minimum) for one in series for name, minimum in (("pressure", 2), ("in fracture", 2), ("velocity", 1), ("flow", 1))]
    return case(f"mms_flow{d}d", f"manufactured solution of flow in {d}D, across and along a fracture", series, all_errors,
                (series[0].name, f"n={counts[-1]}", "pressure"), bounds, CALLED)


def mms_flow2d():
    return manufactured(2, (8, 16, 32, 64), 3)


def mms_flow3d():
    return manufactured(3, (4, 8, 16), 2)


# One fracture in an infinite plane

GRADED = ((0.4, 0.02), (0.2, 0.02), (0.1, 0.02), (0.05, 0.02))
FINEST = graded(1, *GRADED)[-1][0]


def around(name, parameter, values, known, scene):
    """Series on uniform and graded meshes for moderate values, on graded meshes for extreme values."""
    series = []
    for value in values:
        sets = (*DIRECT, f"Tables.{parameter}.values={{{value:g}, {value:g}}}")
        grids = {"U": uniform(1, (0.4, 0.2, 0.1, 0.05)), "graded": graded(1, *GRADED)}
        series += [Series(f"{parameter}={value:g} {grid} mesh", grids[grid], scene, sets, known(value), 2) for grid in (grids if 1e-3 < value < 1e3 else ["graded"])]
    return series


def flow_conductor():
    def errors(run, known):
        """`centre`: error of the flow through the two faces in the middle."""
        places, along = run.corners().mean(axis=1), run.data("fluid flux")[:, 0]
        middle = np.argsort(np.abs(places[:, 0]))[:2]
        return {**all_errors(run, known), "centre": abs(np.mean(along[middle] / known.flow_in(places[middle])[:, 0]) - 1)}
    series = around("conductor", "T0", (1, 10, 1e6, 1e10), flow_exact.Conductor, "verification/flow_conductor.xml")
    bounds = [Order(one.name, name, minimum) for one in series for name, minimum in (("pressure", 1), ("velocity", 0.5), ("flow", 1), ("centre", 1))]
    bounds += [Bound(one.name, FINEST, "centre", 2e-3) for one in series]
    return case("flow_conductor", "flow along a fracture in an infinite plane", series, errors, ("T0=1 graded mesh", FINEST, "pressure"), bounds, CALLED)


def flow_barrier():
    def errors(run, known):
        """Errors of leakage, from the velocity in the cells below, and of the pressure jump, from the cells on
        both sides."""
        at, faces = run.corners(), np.arange(len(run.corners()))
        middle, size = at.mean(axis=1), np.linalg.norm(at[:, 1] - at[:, 0], axis=1)
        centres, velocity = flow_measure.corners(run).mean(axis=1), flow_measure.array(run, "Darcy velocity")[:, :2]
        up = np.array([0.0, 1.0])
        above, below = (flow_measure.at_faces(run, faces, side) for side in (up, -up))
        p = flow_measure.array(run, "pressure")
        high, low = (p[cells] - ((middle - centres[cells]) * velocity[cells]).sum(axis=1) for cells in (above, below))
        jump, leaks = known.jump(middle), velocity[below, 1]
        return {**flow_measure.rock_errors(run, known), "jump": flow_measure.relative((high - low - jump)[:, None], jump[:, None], size),
                "leakage": abs((size * leaks).sum() / size.sum() / known.leakage - 1), "at faces": float(np.max(np.abs(leaks / known.leakage - 1)))}
    series = around("barrier", "c0", (1, 1e-6, 1e-10), flow_exact.Barrier, "verification/flow_barrier.xml")
    bounds = [Order(one.name, name, minimum) for one in series for name, minimum in (("pressure", 1), ("velocity", 0.5))]
    bounds += [Order("graded", name, 1) for name in ("jump", "leakage")] + [Order("U", name, 0.75) for name in ("jump", "leakage")]
    bounds += [Bound(one.name, FINEST, "leakage", 2e-3) for one in series]
    # positive everywhere
    bounds += [Bound(one.name, label, "at faces", 0.4) for one in series for label, _ in one.meshes]
    return case("flow_barrier", "flow around and across a fracture of low permeability", series, errors, ("c0=1 graded mesh", FINEST, "pressure"), bounds, CALLED)


# Wells

def flow_well(d, counts):
    """Drawdown at the well, between its radius and the middles of the sides; 4:1 is the anisotropy across the well."""
    def errors(run, _):
        return {"in well": max(abs(run.results["steps"][-1]["wells"]["well"]["pressure"]) / math.log(0.5 / 0.001), 1e-17)}
    rock = {1: (), 4: (f"Materials.rock.permeability={{4, 1{', 1' * (d - 2)}}}", f"Tables.a.values={{{2**0.5!r}, {2**0.5!r}}}")}
    series = [Series(f"{name} {ratio}:1", boxes(d, counts), f"verification/flow_well_{d}d.xml", (*sets, *rock[ratio]), None, 2)
              for ratio in rock for name, sets in shapes(d).items()]
    maximum = {"rt0 triangle": 0.02, "rt0 tetrahedron": 0.03, "mimetic": 0.02}
    bounds = [Bound(one.name, label, "in well", value) for one in series for label, _ in one.meshes for start, value in maximum.items() if one.name.startswith(start)]
    bounds += [Order(one.name, "in well", 1.5) for one in series if "tpfa" in one.name]
    return case(f"flow_well{d}d", f"a well in {d}D", series, errors, (series[0].name, f"n={counts[-1]}", "in well"), bounds)


def flow_well2d():
    return flow_well(2, (11, 21, 41, 81))


def flow_well3d():
    return flow_well(3, (5, 9, 17))


# Networks

def flow_patch():
    transmissivity = {2: dict(zip(meshes.NETWORK, (2 / 3, 3, 1e-5))), 3: dict(zip("xyz", (2 / 3, 3, 1e-5)))}

    def errors(run, known):
        """Errors of pressures relative to the largest, of velocities and flows relative to the gradient; exact up
        to round-off."""
        d, T = run.dimension, np.empty(len(run.faces.polygons))
        for name, value in transmissivity[d].items():
            T[run.on(name)] = value
        p, inside = flow_measure.array(run, "pressure"), run.data("fracture pressure")
        centres, middles, n = flow_measure.corners(run).mean(axis=1), run.corners().mean(axis=1), flow_measure.normals(run)
        away = {"pressure": p - known.pressure(centres), "velocity": flow_measure.array(run, "Darcy velocity")[:, :d] - known.velocity(centres),
                "in fracture": inside - known.pressure_in(middles), "flow": (run.data("fluid flux")[:, :d] - known.flow_in(n, T)) / T[:, None]}
        return {name: max(float(np.abs(value).max()), 1e-17) for name, value in away.items()}
    G = (0.7, -0.4, 0.3)
    meshed = gmsh(1, *[(f"h={h:g}", lambda folder, h=h: meshes.network(folder, h)) for h in (0.3, 0.1, 0.05)])
    series = [Series("rt0 triangle", meshed, "verification/flow_patch_2d.xml", DIRECT, flow_exact.Linear(G[:2]), 2)]
    series += [Series(name, boxes(3, (4, 8, 12)), "verification/flow_patch_3d.xml", (*DIRECT, *sets), flow_exact.Linear(G), 1) for name, sets in shapes(3).items()]
    bounds = [Bound(one.name, label, name, 1e-10) for one in series for label, _ in one.meshes for name in ("pressure", "velocity", "in fracture", "flow")]
    return case("flow_patch", "a constant pressure gradient with intersecting fractures", series, errors, (series[0].name, "h=0.05", "flow"), bounds)


# Published benchmarks

# `axis`: coordinate axis used by the reference; None: along the line. `jumps`: indices of values at fractures
# with a pressure jump.
Line = namedtuple("Line", "name start end axis jumps", defaults=[()])


class Lines:
    """Pressures along lines with their references. `mean`: mean rock pressure of another program, if known.

    `profiles` stores measured pressures for the figures."""

    def __init__(self, mobility, *lines, mean=None):
        self.mobility, self.lines, self.mean, self.profiles = mobility, lines, mean, []

    @staticmethod
    def reference(line):
        """Returns fractions of the line, values, and the limits of the band (nan without a band)."""
        with open(REFERENCES / "flow_benchmarks.csv", newline="") as file:
            rows = [row for row in csv.reader(file) if row[0] == line.name]
        at, value, low, high = np.array([[float(word or "nan") for word in row[2:6]] for row in rows]).T
        start, end = np.array(line.start), np.array(line.end)
        length = np.linalg.norm(end - start) if line.axis is None else (end - start)[line.axis]
        return (at if line.axis is None else at - start[line.axis]) / length, value, low, high

    def errors(self, run):
        """Errors: root mean square of the difference relative to the range, on the worst line; number of points
        outside the band."""
        worst, outside, banded, profile = 0.0, 0, False, []
        for line in self.lines:
            start, end = np.array(line.start, dtype=float), np.array(line.end, dtype=float)
            at, value, low, high = self.reference(line)
            fine = np.linspace(0, 1, 201)[1:-1]
            found, drawn = (flow_measure.pressure_along(run, start + of[:, None] * (end - start), self.mobility) for of in (at, fine))
            away = np.delete(found - value, line.jumps)
            worst = max(worst, float(np.sqrt(np.mean(away**2)) / np.ptp(value)))
            banded |= not np.isnan(low).any()
            outside += int(((found < low) | (found > high)).sum())
            profile.append((fine, drawn))
        self.profiles.append((run.results["mesh"]["cells"], profile))
        return {"line": worst, **({"outside": outside} if banded else {}), **({"mean": self.mean_error(run)} if self.mean else {})}

    def mean_error(self, run):
        volume = flow_measure.cell_points(run)[1].sum(axis=1)
        return abs((volume * flow_measure.array(run, "pressure")).sum() / volume.sum() / self.mean - 1)


def draw_lines(series, file):
    """Draws the pressures along each line, for all series that contain it; finer meshes are darker."""
    every = {line.name: line for one in series for line in one.exact.lines}
    figure, all_axes = style.plt.subplots(1, len(every), figsize=(4.3 * len(every), 3.4), squeeze=False)
    for axes, line in zip(all_axes[0], every.values()):
        at, value, low, high = Lines.reference(line)
        if not np.isnan(low).any():
            axes.fill_between(at, low, high, color=style.FAINT, alpha=0.4, linewidth=0, label="10-90 % of participants")
        axes.plot(at, value, "k.", label="reference", zorder=3)
        of = [one for one in series if line in one.exact.lines]
        for k, one in enumerate(of):
            for i, (cells, profile) in enumerate(one.exact.profiles):
                fine, drawn = profile[one.exact.lines.index(line)]
                axes.plot(fine, drawn, color=style.LINES[k % len(style.LINES)], linewidth=1, alpha=(i + 1) / len(one.exact.profiles),
                          label=f"{one.name}, {cells} cells" if i == len(one.exact.profiles) - 1 else None)
        axes.set(title=line.name, xlabel="part of the line (-)", ylabel="pressure")
        axes.legend(fontsize=6)
    figure.savefig(file, dpi=130)
    style.plt.close(figure)


def benchmark(name, title, series, maximum, headline, banded=False):
    """Case of a published benchmark.

    `maximum` = {beginning of a series name: bounds on the difference for the last mesh of --quick and the last
    mesh}. With `banded`, all points of the last mesh must lie in the band."""
    bounds = [Bound(one.name, label, "line", value) for one in series for start, values in maximum.items() if one.name.startswith(start)
              for label, value in zip((one.meshes[one.quick - 1][0], one.meshes[-1][0]), values)]
    if banded:
        bounds += [Bound(one.name, one.meshes[-1][0], "outside", 0) for one in series]
    return case(name, title, series, lambda run, lines: lines.errors(run), headline, bounds, picture=lambda file: draw_lines(series, file))


def one(points):
    return np.ones(len(points))


JOINTS = {"conductive": (), "blocking": tuple(f"Materials.joint.{which} permeability=1e-4" for which in ("tangential", "normal"))}


def flow_regular2d():
    lines = {"conductive": (Line("regular 2D conductive x=0.5", (0.5, 0), (0.5, 1), 1), Line("regular 2D conductive y=0.7", (0, 0.7), (1, 0.7), 0)),
             "blocking": (Line("regular 2D blocking", (0, 0.1), (0.9, 1), 0),)}
    peer = {"conductive": 1.19931, "blocking": 2.32257}  # PorePy, MPFA on 3822 triangles and 140 faces of fractures
    series = [Series(f"{kind} {name}", boxes(2, (16, 32, 64, 128)), "verification/flow_regular_2d.xml", (*sets, *JOINTS[kind]), Lines(one, *of, mean=peer[kind]), 2)
              for kind, of in lines.items() for name, sets in shapes(2).items() if "mimetic" not in name]
    found = benchmark("flow_regular2d", "regular network in 2D, conductive and blocking", series,
                      {"conductive": (1e-2, 2e-3), "blocking": (5e-4, 5e-4)}, ("conductive rt0 triangle", "n=128", "line"))
    found.bounds += [Bound(one.name, "n=128", "mean", 1e-3) for one in series]
    return found


def flow_hydrocoin():
    grids = gmsh(1, *[(f"h={h:g}", lambda folder, h=h: meshes.hydrocoin(folder, h)) for h in (200, 100, 50, 25)])
    line = Line("hydrocoin", (0, -200), (1600, -200), 0)
    series = [Series("rt0 triangle", grids, "verification/flow_hydrocoin.xml", (), Lines(lambda points: 1e-8 * one(points), line), 2)]
    return benchmark("flow_hydrocoin", "Hydrocoin", series, {"rt0": (3e-2, 2e-2)}, ("rt0 triangle", "h=25", "line"))


def flow_single():
    grids = gmsh(1, *[(f"h={h:g}", lambda folder, h=h: meshes.single(folder, h)) for h in (24, 12, 6, 4)])
    line = Line("single", (0, 100, 100), (100, 0, 0), None)
    series = [Series("rt0 tetrahedron", grids, "verification/flow_single.xml", (), Lines(lambda points: np.where(points[:, 2] < 10, 1e-5, 1e-6), line), 2)]
    return benchmark("flow_single", "single fracture in 3D", series, {"rt0": (3e-2, 1e-2)}, ("rt0 tetrahedron", "h=4", "line"), True)


def tight(points):
    """Mobility of the 3D regular network."""
    x, y, z = points.T
    parts = ((x > 0.5) & (y < 0.5)) | ((x > 0.75) & (y > 0.5) & (y < 0.75) & (z > 0.5)) \
        | ((x > 0.625) & (x < 0.75) & (y > 0.5) & (y < 0.625) & (z > 0.5) & (z < 0.75))
    return np.where(parts, 0.1, 1.0)


def flow_regular3d():
    series = []
    for kind, entries in JOINTS.items():
        line = Line(f"regular 3D {kind}", (0, 0, 0), (1, 1, 1), None, (7,) if entries else ())
        series += [Series(f"{kind} {name}", boxes(3, (8, 16, 32)), "verification/flow_regular_3d.xml", (*sets, *entries), Lines(tight, line), quick)
                   for (name, sets), quick in zip(shapes(3).items(), (1, 2, 0)) if quick]
    maximum = {"conductive rt0": (0.3, 2e-2), "conductive tpfa": (0.1, 2e-2), "blocking rt0": (0.1, 1e-2), "blocking tpfa": (0.04, 1e-2)}
    return benchmark("flow_regular3d", "regular network in 3D, conductive and blocking", series, maximum, ("conductive tpfa hexahedron", "n=32", "line"), True)


CASES = (mms_flow2d, mms_flow3d, flow_conductor, flow_barrier, flow_patch, flow_well2d, flow_well3d, flow_regular2d, flow_hydrocoin, flow_single, flow_regular3d)
