"""Cases of heat: scenes, meshes, measured errors and bounds."""
import math

import numpy as np

from perf.verification import flow_measure, heat_exact, measure
from perf.verification.cases import Bound, Case, Order, Series
from perf.verification.poro_cases import SCHEMES, SHAPES, numbers
from perf.verification.poro_fractures import opened_errors

CALLED = ("temperature", "")
VELOCITY, DIFFUSIVITY, DAY = 8e-6, 3e-6, 1e6  # of the front: m/s, m^2/s, s
erfc = np.vectorize(math.erfc)


def case(name, title, series, errors, headline, bounds):
    return Case(name, title, "", series, errors, None, headline, None, ("temperature", ""), None, bounds, called=CALLED)


def mean_temperatures(run, exact):
    """Relative L2 error of the mean temperatures of cells."""
    T = flow_measure.array(run, "temperature")[:, None]
    return flow_measure.mean_error(T, lambda x: exact(x)[:, None], *flow_measure.cell_points(run))


def temperature_error(run, exact):
    return {"temperature": mean_temperatures(run, lambda x: exact(x[:, 0]))}


def heat_half_space():
    """Cooling of a half-space: 300 + 50 erf(x/sqrt(4 kappa t)) after 1e7 s (Carslaw and Jaeger 1959, section 2.4)."""
    def errors(run, _):
        return temperature_error(run, lambda x: 50 - 50 * erfc(x / math.sqrt(4e-6 * 1e7)) + 300)
    series = [Series(f"{cell}", [(f"n={n}", (f"Mesh.cells={numbers([n] + [n // 30] * (d - 1))}", f"Time.steps={n}")) for n in (30, 60, 120)],
                     f"heat/cooling_{d}d.xml", (f"Mesh.cell={cell}",), None, 2)
              for d, cells in ((2, ("triangle", "quadrilateral")), (3, ("tetrahedron", "hexahedron"))) for cell in cells]
    bounds = [Order(one.name, "temperature", 1.8) for one in series] + [Bound(one.name, "n=120", "temperature", 3e-5) for one in series]
    return case("heat-half-space", "cooling of a half space", series, errors, ("quadrilateral", "n=120", "temperature"), bounds)


def heat_front():
    """Front of fluid at 1 K that enters at x = 0, with advection and conduction (Ogata and Banks 1961).

    With cells of 0.75 m (n = 40) spatial and temporal errors happen to cancel; therefore the series begins at
    n = 80."""
    def exact(x):
        width = 2 * math.sqrt(DIFFUSIVITY * DAY)
        return 0.5 * (erfc((x - VELOCITY * DAY) / width) + np.exp(np.minimum(VELOCITY * x / DIFFUSIVITY, 600)) * erfc((x + VELOCITY * DAY) / width))

    def errors(run, _):
        return temperature_error(run, exact)
    series = [Series(f"{cell} {scheme}", [(f"n={n}", (f"Mesh.cells={numbers([n] + [1] * (d - 1))}", f"Time.steps={n * n // 20}")) for n in (80, 160, 240)],
                     f"verification/front_{d}d.xml", (f"Mesh.cell={cell}", f"Heat.advection={scheme}"), None, 2, None, 1)
              for d, cell in ((2, "quadrilateral"), (3, "hexahedron")) for scheme in ("upwind", "second order")]
    bounds = [Order("upwind", "temperature", 0.8), Order("second order", "temperature", 1.5)]
    bounds += [Bound(one.name, "n=160", "temperature", 5e-4 if "second" in one.name else 0.02) for one in series]
    return case("heat-front", "advection of a front", series, errors, ("quadrilateral second order", "n=160", "temperature"), bounds)


# Sliding and opening fracture

def sliding_errors(run, known):
    points, weights = measure.face_points(run.corners())
    warm = flow_measure.mean_error(run.data("fracture temperature")[:, None], lambda x: known.temperature_in(x)[:, None], points, weights)
    traction, centre = measure.traction_errors(run, known, np.eye(run.dimension)[:-1])
    return {**opened_errors(run, known), "temperature": mean_temperatures(run, known.temperature), "T in": warm, "traction": traction, "centre": centre}


def sliding(d, kind, cell, *grids, advection="upwind", quick=0):
    """Series; `grids` contains pairs (cells along each edge, time steps)."""
    meshes = [(f"n={n}", (f"Mesh.cells={numbers([n] * d)}", f"Time.steps={steps}")) for n, steps in grids]
    name = f"{cell} {kind}" if advection == "upwind" else f"{cell} {advection}"
    return Series(name, meshes, f"verification/manufactured_heat_{kind}_{d}d.xml", (f"Mesh.cell={cell}", f"Heat.advection={advection}"),
                  heat_exact.Sliding(d, int(kind == "carried")), quick)


def heat_sliding(d, series, fine):
    """Case of the manufactured solution; `fine` = {series: bounds on the errors of temperature and jump on the
    last mesh}.

    With advection, upwind flow eventually determines the order of all errors. For these series, only the
    temperature is required to reach the order of the scheme."""
    # 2 on finer meshes
    bounds = [Order("conducted", name, 1.75) for name in ("temperature", "T in", "in fracture", "jump", "centre")]
    bounds += [Order(one.name, name, 1) for one in series for name in ("flow", "traction")]
    bounds += [Order(one.name, name, 2) for one in series for name in ("pressure", "u")]
    bounds += [Order("carried", "temperature", 1), Order("second order", "temperature", 1.5)]
    bounds += [Bound(one.name, one.meshes[-1][0], *bound) for one in series for bound in zip(("temperature", "jump"), fine[one.name])]
    headline = next(one for one in series if one.quick)
    return Case(f"heat-mms{d}d", f"manufactured solution of heat in a fracture that slides and opens in {d}D", "", series, sliding_errors, None,
                (headline.name, headline.meshes[-1][0], "temperature"), None, ("temperature", "u"), None, bounds, called=("temperature", "u"))


def heat_mms2d():
    """Case with a number of steps proportional to the square of the number of cells along an edge.

    For second-order advection the steps are shorter, so that the Courant number is below 1."""
    grids = ((8, 1), (16, 4), (32, 16))
    series = [sliding(2, kind, cell, *grids, quick=2 * (cell == "triangle")) for kind in ("conducted", "carried") for cell in SHAPES[2]]
    series.append(sliding(2, "carried", "quadrilateral", (6, 24), (12, 48), (24, 96), advection="second order"))
    return heat_sliding(2, series, {one.name: (2e-3, 5e-4) for one in series})


def heat_mms3d():
    grids = {"hexahedron": ((4, 1), (8, 4), (12, 9)), "tetrahedron": ((4, 1), (8, 4))}
    series = [sliding(3, kind, cell, *grids[cell], quick=2 * (cell == "hexahedron" and kind == "conducted")) for kind in ("conducted", "carried") for cell in SHAPES[3]]
    return heat_sliding(3, series, {one.name: (5e-3, 5e-3) for one in series})


def sliding_time_errors(run, known):
    """Largest relative error over all cells and faces."""
    def worst(name, values, exact):
        return {name: np.abs(values / exact - 1).max()}
    return {**worst("pressure", flow_measure.array(run, "pressure"), known.pressure), **worst("in fracture", run.data("fracture pressure"), known.pressure),
            **worst("temperature", flow_measure.array(run, "temperature") - known.start, known.warmth),
            **worst("T in", run.data("fracture temperature") - known.start, known.warmth), **worst("opening", run.data("opening"), known.opening)}


def heat_time():
    """Spatially uniform solution, with errors of the time steps only."""
    steps = [(f"{n} steps", (f"Time.steps={n}",)) for n in (20, 40, 80)]
    series = [Series(f"{cell} {scheme}", steps, f"verification/heat_time_{d}d.xml", (f"Mesh.cell={cell}", *entries), heat_exact.SlidingInTime(), 2 * (d == 2))
              for scheme, (_, entries) in SCHEMES.items() for d, cell in ((2, "quadrilateral"), (3, "tetrahedron"))]
    bounds = [Order(scheme, name, order) for scheme, (order, _) in SCHEMES.items() for name in ("pressure", "in fracture", "temperature", "T in", "opening")]
    return Case("heat-time", "heat and length of time steps", "", series, sliding_time_errors, None, ("quadrilateral Euler", "80 steps", "temperature"), None,
                ("temperature", "pressure"), None, bounds, called=("temperature", "pressure"))


CASES = (heat_half_space, heat_front, heat_mms2d, heat_mms3d, heat_time)
