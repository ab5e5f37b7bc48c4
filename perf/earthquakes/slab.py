"""Earthquakes on a vertical fault in antiplane strain, in a slab that is one cell thick: problem BP1-QD of the code
comparison of SCEC with a longer state evolution distance, which permits larger cells."""
import time
from functools import cache, partial

import numpy as np

from perf.common import program, scene_file
from perf.earthquakes import half_plane, reference
from perf.earthquakes.rate_state import crossings
from perf.earthquakes.sequence import LIMIT, YEAR
from perf.earthquakes.tensor_mesh import both_ways, fitted, growing, numbers, write

FAR, THICKNESS = 200e3, 100.0  # m, to the sides and the bottom; thickness of the slab
DOWN, ASIDE = 1.1, 1.6         # ratios of the sizes of neighbouring cells, below 18 km and away from the fault, at COARSE
L = 0.032                      # m, four times that of the problem
END = 500                      # years: two events
COARSE, *_ = SIZES = (800.0, 562.5, 400.0)  # m, of the cells on the fault
EXPLICIT = {"BP1-QD, 4 L, explicit method": (200.0,),  # size of the cells, half-width and depth of a box
            "BP1-QD, 4 L, explicit method, box": (100.0, FAR)}


def cases(options, row):
    """Yields (name, function that returns a row)."""
    for size in () if options.quick else SIZES:
        name = f"BP1-QD, 4 L, slab, {size:g} m"
        yield name, partial(sequence, options, row.of_run, name, size)
    for name in () if options.quick else EXPLICIT:
        yield name, partial(explicit_row, row, name)


def sequence(options, row, name, size):
    """Onsets compared with the explicit method with cells of 100 m."""
    file = options.output / f"slab_{size:g}.xml"
    write_scene(file, size)
    run = program.succeeded(options.binary, file, options.output / f"slab_{size:g}", options.set, clock=LIMIT)
    times = np.array([step["time"] for step in run.steps])
    rates = np.array([max(of["max_slip_rate"] for of in step["fractures"].values()) for step in run.steps])
    return row(name, run, **compared(crossings(times, rates), explicit(100.0)))


def explicit_row(row, name):
    """The explicit method with larger cells or in the box of the slab, compared with 100 m in the half-space."""
    begin, found = time.monotonic(), explicit(*EXPLICIT[name])
    return row(name, steps=found.steps, rejected=found.rejected, seconds=time.monotonic() - begin,
               **compared(found.onsets, explicit(100.0)))


def compared(onsets, exact):
    """Errors of the onsets and of the first interval relative to a solution of the explicit method, and the onsets."""
    onsets, exact = np.array(onsets) / YEAR, np.array(exact.onsets) / YEAR
    if len(onsets) != len(exact):
        return {"errors": {"onset": np.inf}}
    errors = onsets / exact - 1
    return {"errors": {"first event": errors[0], "onset": max(errors, key=abs), "period": np.diff(onsets)[0] / np.diff(exact)[0] - 1},
            "onsets": ", ".join(f"{onset:.2f} ({error:+.2%})" for onset, error in zip(onsets, errors))}


@cache
def explicit(size, far=None):
    return reference.solve(half_plane.bp1(size, L=L, far=far), [END * YEAR], 1e-6, first_step=1e4)


def write_scene(file, size):
    """Writes the scene and its mesh. The fault x = 0 reaches from the surface z = 0 to the bottom. All displacements
    are along y, so the compression of the fault is constant. Below 40 km the fault slips at the plate rate. The
    logarithms of the ratios are proportional to the size, so that all cells become smaller by about the same factor."""
    down = fitted(growing(size, DOWN**(size / COARSE), FAR, half_plane.STRENGTHENING), FAR)
    aside = fitted(growing(size, ASIDE**(size / COARSE), FAR), FAR)
    axes = [both_ways(aside), np.array([0, THICKNESS]), -down[::-1]]
    number = numbers(axes)
    write(file.with_suffix(".msh"), axes, {"fault": number[len(axes[0]) // 2], "west": number[0], "east": number[-1],
                                           "front": number[:, 0], "back": number[:, -1]})
    fault = half_plane.bp1(L=L)
    half, deep = half_plane.PLATE_RATE / 2, -half_plane.LOCKED
    scene = {
        "Mesh file": {"path": file.with_suffix(".msh").name, "tips": "plain",
                      "fractures": {"fault": {"reference normal": [1.0, 0.0, 0.0]}}},
        "Materials": {
            "rock": {"type": "elastic", "shear modulus": half_plane.SHEAR_MODULUS, "Poisson's ratio": half_plane.POISSON},
            "gouge": {"type": "joint", "friction": "rate and state",
                      "direct effect": "0.01 + 0.005*min(max(-z/1000 - 15, 0), 3)", "evolution effect": fault.friction.b,
                      "state evolution distance": fault.friction.L, "initial slip rate": half_plane.PLATE_RATE,
                      "initial friction coefficient": float(fault.shear / fault.N),
                      "radiation damping": fault.friction.damping}},
        "Bulk": {"material": "rock", "initial stress": [-float(fault.N), 0.0, 0.0, float(fault.shear), 0.0, 0.0]},
        "Fractures": {"fault": {"material": "gouge", "prescribed slip": {
            "slip": [f"{half_plane.PLATE_RATE:g}*t"], "direction": [0.0, 1.0, 0.0], "moving side": [1.0, 0.0, 0.0],
            "lower corner": [-1e6, -1e6, -1e6], "upper corner": [1e6, 1e6, deep]}}},
        "Boundary conditions": {
            **{side: {"boundary": side, "displacement": ["0", "free", "0"]} for side in ("front", "back")},
            "west": {"boundary": "west", "displacement": ["0", f"-{half:g}*t", "0"]},
            "east": {"boundary": "east", "displacement": ["0", f"{half:g}*t", "0"]}},
        "Time": {"end": END * YEAR, "tolerance": 1e-2, "first step": 1e5},
        "Solver": {"Linear solver": {"type": "direct"}},
        "Output": {"vtu": False, "every": 100000}}
    scene_file.save(scene, file, "Earthquakes on a vertical fault in antiplane strain (perf/earthquakes).")
