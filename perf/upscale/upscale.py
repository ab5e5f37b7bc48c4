"""Equivalent tensors: errors against closed forms, order of bounds, and cost of load cases.

The rows compare blocks with exact solutions, or check a random network. The last row computes six load cases and three
flow cases of a 3D network. The last line gives the number of missed bounds, the largest error of the exact rows, the
CPU minutes of these cases with the mesh, and the CPU time of a further load case over that of one linear solve."""
import math
import os
import resource
import sys
import time

import numpy as np

from perf.common import options as common
from perf.common import table

COLUMNS = {"row": "", "cells": "d", "largest error": ".1e", "bound": ".0e", "Krylov": "d", "of flow": "d", "CPU min": ".2f",
           "case/solve": ".2f", "MB": ".0f"}
BOUNDS = {"minutes": 15, "case_over_solve": 1.3}
FORMATS = {"worst_error": ".1e", "minutes": ".2f", "case_over_solve": ".2f"}
SYMMETRY = 1e-8
HALF_LENGTH = 0.25  # of cracks, m
BOX = 10.0  # edge of the box of cracks, m
BOUNDED = 300  # largest number of polygons with both kinds of conditions, which double time and memory


def relative(value, exact):
    return float(np.max(np.abs(np.asarray(value) - exact)) / np.max(np.abs(exact)))


def error_of_sets(found, exact, flow="linear", solid="uniform"):
    """Returns the largest relative error of all tensors, under conditions where they are exact."""
    tangent = found.solid[solid]
    return max(relative(found.permeability[flow], exact.K), relative(tangent.compliance, exact.S),
               relative(tangent.biot, exact.alpha), relative(tangent.storage_at_stress + found.fluid, exact.storage))


def sets(axes, cell, conditions=("linear", "uniform")):
    from sprekk.upscale import run
    from perf.upscale.exact import COMPRESSED, Exact, block, sets_of
    dim = 3 if cell in ("hexahedron", "tetrahedron") else 2
    stress = COMPRESSED if dim == 3 else [-2e6, -1e6, 0]
    found = run(block(axes, cell), [stress], conditions=conditions).results[0]
    exact = Exact(dim, sets_of(axes, dim, stress))
    return error_of_sets(found, exact, *(conditions * 2 if len(conditions) == 1 else conditions))


def closure():
    """Barton-Bandis closure at five compressions."""
    from sprekk.upscale import run
    from perf.upscale.exact import SIZE, Exact, block, joint
    stiffness, maximum, aperture, shear, errors = 20e9, 2e-4, 3e-4, 40e9, []
    compressions = [0, 1e6, 5e6, 10e6, 20e6]
    rough = joint(stiffness, shear, aperture, **{"maximum closure": maximum})
    found = run(block("z", z=rough), [[0, 0, -N, 0, 0, 0] for N in compressions])
    for N, result in zip(compressions, found.results):
        tangent, closed = (stiffness + N / maximum) ** 2 / stiffness, N / (stiffness + N / maximum)
        exact = Exact(3, [(np.array([0, 0, 1.0]), SIZE["z"], tangent, shear, aperture - closed)])
        errors.append(error_of_sets(result, exact))
    return max(errors)


def layers():
    """Two layers: means over the blocks of the layers against the whole block."""
    from mpi4py import MPI
    import sprekk
    from sprekk.upscale import run
    from sprekk.upscale.blocks import blocks_of
    rock = {"type": "elastic", "Poisson's ratio": 0, "Biot coefficient": 0.5}
    scene = sprekk.Scene({
        "Mesh": {"cell": "hexahedron", "lower corner": [0, 0, 0], "upper corner": [1, 1, 1], "cells": [2, 2, 4],
                 "regions": {"upper": {"lower corner": [0, 0, 0.5], "upper corner": [1, 1, 1]}}},
        "Materials": {"tight": {**rock, "Young's modulus": 60e9, "permeability": [1e-18]},
                      "open": {**rock, "Young's modulus": 20e9, "permeability": [3e-16]}},
        "Bulk": {"material": "tight"}, "Regions": {"upper": {"material": "open"}}, "Flow": {}, "Time": {"end": 1}})
    whole = run(scene).results[0]
    parts = [run(part).results[0] for *_, part in blocks_of(scene, (1, 1, 2), MPI.COMM_WORLD)]
    along = np.mean([part.permeability["linear"][0, 0] for part in parts])
    across = np.mean([1 / part.permeability["uniform"][2, 2] for part in parts])
    S = np.mean([part.solid["uniform"].compliance[2, 2] for part in parts])
    return max(relative(whole.permeability["linear"][0, 0], along),
               relative(1 / whole.permeability["uniform"][2, 2], across),
               relative(whole.solid["uniform"].compliance[2, 2], S))


def cracked(number):
    """Returns a box with open cracks of equally distributed directions, in random order on a disturbed grid."""
    rng = np.random.default_rng(number)
    side = math.ceil(math.sqrt(number))
    places = rng.permutation(side * side)[:number]
    margin, lines = 4 * HALF_LENGTH, {}
    step = (BOX - 2 * margin) / side
    for k, place in enumerate(places):
        centre = margin + step * (np.array(divmod(place, side)) + 0.5 + rng.uniform(-0.1, 0.1, 2))
        along = HALF_LENGTH * np.array([math.cos(math.pi * k / number), math.sin(math.pi * k / number)])
        lines[f"crack {k}"] = {"points": [*map(float, centre - along), *map(float, centre + along)]}
    return {"Mesh file": {"network": {"domain": {"lower corner": [0, 0], "upper corner": [BOX, BOX]},
                                      "fractures": {"cracks": {"lines": lines}}, "relative size": 0.2},
                          "order": 2},
            "Materials": {"rock": {"type": "elastic", "Young's modulus": 60e9, "Poisson's ratio": 0.25},
                          "crack": {"type": "joint", "friction": "no slip"}},
            "Bulk": {"material": "rock"}, "Fractures": {"cracks": {"material": "crack"}}, "Time": {"end": 1}}


def dilute():
    """Slope of the compliance of open cracks at zero density, without interaction: E0'/E' = 1 + pi rho in 2D."""
    from sprekk.upscale import run
    slopes, modulus = [], 60e9 / (1 - 0.25**2)
    for number in (32, 64):
        S = run(cracked(number), [[1e6, 1e6, 0]], conditions=("uniform",)).results[0].solid["uniform"].compliance
        density = number * HALF_LENGTH**2 / BOX**2
        slopes.append((modulus * (S[0, 0] + S[1, 1]) / 2 - 1) / density)
    return abs(2 * slopes[0] - slopes[1] - math.pi) / math.pi


def discs(number):
    """Returns a cube with random polygons, open to flow. The cube of 50 polygons has edges of 10 m."""
    def part(share, seed, strike, dip):
        return {"random": {"number": round(share * number), "seed": seed, "shortest": 2, "longest": 8, "exponent": 3,
                           "strike": strike, "dip": dip, "concentration": 15, "corners": 5}}
    edge = 10 * (number / 50) ** (1 / 3)
    return {"Mesh file": {"network": {"domain": {"lower corner": [0, 0, 0], "upper corner": [edge] * 3},
                                      "fractures": {"steep": part(0.6, 1, 30, 70), "flat": part(0.4, 2, 120, 15)},
                                      "relative size": 0.6, "size at tips": 1, "size": 4, "tolerance": 0.05}},
            "Materials": {"rock": {"type": "elastic", "Young's modulus": 60e9, "Poisson's ratio": 0.25,
                                   "permeability": [1e-17], "Biot coefficient": 0.6, "Biot modulus": 40e9},
                          "joint": {"type": "joint", "friction coefficient": 0.6, "tangential stiffness": 40e9,
                                    "normal stiffness": 100e9, "maximum closure": 2e-4, "initial aperture": 3e-4}},
            "Bulk": {"material": "rock"}, "Fractures": {"material": "joint"}, "Flow": {}, "Time": {"end": 1}}


def with_cost(solver, work):
    """Returns the tensors of work(), and the CPU time of a further load case over that of its solve.

    A case consists of load, solve, product and evaluation. Jacobian and preconditioner belong to the first case."""
    begin = time.process_time()
    found = work()
    seconds = time.process_time() - begin
    first, *further = [of_solve for _, of_solve in solver.solves]
    return found, (seconds - solver.jacobian_seconds - first) / sum(further)


def cpu_minutes():
    """CPU time of this process and of its mesh generator."""
    return sum(os.times()[:4]) / 60


def network(number):
    """Returns the columns of a network after its name.

    The error is the largest asymmetry or excess of a lower bound. The minutes contain mesh, models, the step to the state,
    six load cases and the pressure under uniform stress, and three flow cases under linear pressure. Up to BOUNDED polygons
    the other conditions follow, for the order of bounds. Iterations are the largest numbers of a solve."""
    from mpi4py import MPI
    import sprekk
    from sprekk.network import with_mesh
    from sprekk.upscale import asymmetry, components
    from sprekk.upscale.flow import Flow
    from sprekk.upscale.solid import Solid
    begin, comm = cpu_minutes(), MPI.COMM_WORLD
    scene = with_mesh(sprekk.Scene(discs(number)), comm)
    pairs = [("uniform", "linear"), ("linear", "uniform")][:2 if number <= BOUNDED else 1]
    solid = Solid(scene, comm, [[-5e6, -8e6, -10e6, 0, 0, 0]], [0], conditions=[of_solid for of_solid, _ in pairs])
    flow = Flow(scene, comm)
    solid.estimates = flow.estimates = False
    solid.step()
    opening, tangents, K, ratios, minutes, iterations = solid.openings(), {}, {}, [], None, []
    for of_solid, of_flow in pairs:
        solvers = (solid.free if of_solid == "uniform" else solid.constrained, flow.constrained if of_flow == "linear" else flow.open)
        found, ratio = with_cost(solvers[0], lambda: solid.tangents((of_solid,)))
        tangents.update(found)
        K[of_flow], of_case = with_cost(solvers[1], lambda: flow.permeability(of_flow, opening))
        ratios += [ratio, of_case]
        iterations.append([max(n for n, _ in solver.solves) for solver in solvers])
        minutes = minutes or cpu_minutes() - begin
    tensors = [*K.values(), *(tangent.compliance for tangent in tangents.values())]
    error = max(map(asymmetry, tensors))
    if len(pairs) > 1:
        error = max(error, components.excess(K["uniform"], K["linear"]),
                    components.excess(tangents["linear"].compliance, tangents["uniform"].compliance))
    return [len(solid.free.model.mesh.cells), error, *map(int, np.max(iterations, axis=0)), minutes, max(ratios),
            resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3]


def rows(options):
    """Yields (name, work, bound, exact) of the rows with exact solutions."""
    from functools import partial
    yield "one set", partial(sets, "z", "hexahedron"), 1e-6
    yield "three sets", partial(sets, "xyz", "hexahedron"), 1e-6
    yield "three sets, tetrahedra", partial(sets, "xyz", "tetrahedron"), 1e-6
    yield "two sets, triangles", partial(sets, "xy", "triangle"), 1e-6
    yield "two sets, periodic", partial(sets, "xy", "quadrilateral", ("periodic",)), 1e-6
    yield "closure at five stresses", closure, 1e-6
    yield "layers and their blocks", layers, 1e-8
    if not options.quick:
        yield "dilute open cracks", dilute, 0.03


def main(words):
    parser = common.parser("upscale", __doc__, sets=False)
    parser.add_argument("--fractures", type=common.count, default=None, help="of the 3D network; default 1000, quick 10")
    options = parser.parse_args(words)
    number = options.fractures or (10 if options.quick else 1000)
    every = [*rows(options), (f"network of {number} polygons", None, SYMMETRY)]
    shown, failed, total = table.Table(COLUMNS), [], {"failures": 0, "worst_error": 0.0}
    for name, work, bound in common.matching(options, every, lambda row: row[0]):
        of_network = [None] * 5
        if work:
            cells, error = None, work()
            total["worst_error"] = max(total["worst_error"], error) if bound <= 1e-6 else total["worst_error"]
        else:
            cells, error, *of_network = network(number)
            total |= {"minutes": of_network[2], "case_over_solve": of_network[3]}
        if not error <= bound:
            failed.append(f"{name}: error {error:.1e}, at most {bound:g} required")
        shown.add([name, cells, error, bound, *of_network])
    total["failures"] = len(failed)
    bounds = {name: bound for name, bound in BOUNDS.items() if name in total} if not options.quick else {}
    return table.finish(options, shown, total, FORMATS, bounds, failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
