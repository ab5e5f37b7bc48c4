"""The cases of heat: scenes, meshes, what is measured on them, and the bounds."""
import math

import numpy as np

import flow_measure
from cases import Bound, Case, Order, Series
from poro_cases import numbers

CALLED = ("temperature", "")
VELOCITY, DIFFUSIVITY, DAY = 8e-6, 3e-6, 1e6  # m/s, m^2/s, s: of the front
erfc = np.vectorize(math.erfc)


def case(name, title, series, errors, headline, bounds):
    return Case(name, title, "", series, errors, None, headline, None, ("temperature", ""), None, bounds, called=CALLED)


def temperature_error(run, exact):
    """Relative L2 error of the mean temperatures of cells, over that of a scale."""
    T = flow_measure.array(run, "temperature")[:, None]
    return {"temperature": flow_measure.mean_error(T, lambda x: exact(x[:, 0])[:, None], *flow_measure.cell_points(run))}


def heat_half_space():
    """300 + 50 erf(x/sqrt(4 kappa t)) after 1e7 s (Carslaw and Jaeger 1959, section 2.4)."""
    def errors(run, _):
        return temperature_error(run, lambda x: 50 - 50 * erfc(x / math.sqrt(4e-6 * 1e7)) + 300)
    series = [Series(f"{cell}", [(f"n={n}", (f"Mesh.cells={numbers([n] + [n // 30] * (d - 1))}", f"Time.steps={n}")) for n in (30, 60, 120)],
                     f"heat/cooling_{d}d.xml", (f"Mesh.cell={cell}",), None, 2)
              for d, cells in ((2, ("triangle", "quadrilateral")), (3, ("tetrahedron", "hexahedron"))) for cell in cells]
    bounds = [Order(one.name, "temperature", 1.8) for one in series] + [Bound(one.name, "n=120", "temperature", 3e-5) for one in series]
    return case("heat-half-space", "rock that cools", series, errors, ("quadrilateral", "n=120", "temperature"), bounds)


def heat_front():
    """What enters at x = 0 at 1 K, by flow and conduction (Ogata and Banks 1961). With cells of 0.75 m, n = 40, errors of space and
    time happen to cancel."""
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
    return case("heat-front", "a front that is carried", series, errors, ("quadrilateral second order", "n=160", "temperature"), bounds)


CASES = (heat_half_space, heat_front)
