"""Earthquakes on a vertical strike-slip fault in 3D: problem BP5-QD of the code comparison of SCEC, first two events."""
import time
from functools import cache, partial

import numpy as np
import read

from perf.common import program
from perf.earthquakes import half_space, reference, strike_slip_scene
from perf.earthquakes.rate_state import crossings
from perf.earthquakes.sequence import LIMIT, YEAR

COARSE, FINE = 2000.0, 1000.0  # m, of the cells
END = 237                      # years: two events, the first one from the start
SEISMIC = 0.1                  # m/s, of an event; the slip rate at the start is a tenth of it
CENTRE, RADII = (-24e3, 10e3), (12e3, 10e3)  # m, of a given slip: along the strike, depth


def cases(options, row):
    """Yields (name, function that returns a row). Runs of the scene take minutes and need `--only`."""
    if not options.quick:
        yield "BP5-QD, explicit method", partial(explicit_row, row, "BP5-QD, explicit method")
    if options.only:
        yield "BP5-QD, traction of a given slip", partial(given_slip, options, row.of_run, "BP5-QD, traction of a given slip")
        yield "BP5-QD, 2 km", partial(run_row, options, row.of_run, "BP5-QD, 2 km")


def run_row(options, row, name):
    """Compared with the explicit method with cells of the same size."""
    file, exact = options.output / "strike_slip.xml", explicit(COARSE)
    strike_slip_scene.write_scene(file, COARSE, END * YEAR)
    run = program.succeeded(options.binary, file, options.output / "strike_slip", options.set, clock=LIMIT)
    times = np.array([step["time"] for step in run.steps])
    rates, slip = (np.array([step["fractures"]["fault"][name] for step in run.steps]) for name in ("max_slip_rate", "mean_slip"))
    return row(name, run, **compared(crossings(times, rates, SEISMIC), np.interp(YEAR, times, slip), exact))


def given_slip(options, row, name):
    """Shear traction of the fault of the scene for a slip of 1 m at the centre of the nucleus, and means of that of the
    explicit method with the smaller cells. Root mean square of the error along the length of the slip over that of the
    traction; in `places` the factor between the tractions."""
    file = options.output / "given_slip.xml"
    strike_slip_scene.write_scene(file, COARSE, 1.0)
    inside = f"abs(y - {CENTRE[0]:g}) < {RADII[0]:g} && abs(z + {CENTRE[1]:g}) < {RADII[1]:g}"
    shape = f"cos(pi*(y - {CENTRE[0]:g})/{2 * RADII[0]:g})^2*cos(pi*(z + {CENTRE[1]:g})/{2 * RADII[1]:g})^2"
    slip = "Fractures.fault.prescribed slip."
    entries = (f"{slip}slip={{{inside} ? {shape} : 0}}", f"{slip}direction={{0, 1, 0}}", f"{slip}moving side={{1, 0, 0}}",
               "Time.first step=1", "Output.vtu=true", *options.set)
    run = program.succeeded(options.binary, file, options.output / "given", entries)
    faces = read.surface(read.grid(read.written_steps(run.directory, "fractures")[-1][1]))
    places = np.array([np.mean(corners, axis=0)[1:] for corners in faces.corners()])
    chosen = (abs(places[:, 0] - CENTRE[0]) < RADII[0]) & (places[:, 1] > -strike_slip_scene.FINE_DOWN)
    fine = half_space.Plane(FINE)
    y, depth = np.meshgrid(fine.x - CENTRE[0], fine.z - CENTRE[1], indexing="ij")
    given = np.where((abs(y) < RADII[0]) & (abs(depth) < RADII[1]), np.cos(np.pi * y / 2 / RADII[0]) ** 2 * np.cos(np.pi * depth / 2 / RADII[1]) ** 2, 0)
    exact = fine.traction(given.ravel()).reshape(fine.shape[0] // 2, 2, fine.shape[1] // 2, 2).mean(axis=(1, 3))
    at = np.floor((places[chosen] * [1, -1] + [half_space.LENGTH / 2, 0]) / COARSE).astype(int)
    exact = exact[at[:, 0], at[:, 1]]
    found = faces.cell_data["traction local"][chosen][:, 1]
    found = np.abs(found) - strike_slip_scene.shear_stress()
    factor = found @ exact / (exact @ exact)
    return row(name, run, {"shear traction": np.sqrt(np.mean((found - exact) ** 2) / np.mean(exact**2))}, places=f"{factor:.3f}")


def explicit_row(row, name):
    """The larger cells compared with the smaller ones."""
    begin, found = time.monotonic(), explicit(COARSE)
    seconds = time.monotonic() - begin
    return row(name, steps=found.steps, rejected=found.rejected, seconds=seconds, **compared(found.onsets, mean_slip(found), explicit(FINE)))


def compared(onsets, slip, exact):
    """Errors of the onset of the first event, of the interval of the events, and of the mean slip after one year."""
    if len(onsets) != len(exact.onsets):
        return {"errors": {"onset": np.inf}}
    interval, exact_interval = np.diff(onsets)[0], np.diff(exact.onsets)[0]
    errors = {"first event": onsets[0] / exact.onsets[0] - 1, "period": interval / exact_interval - 1, "slip": slip / mean_slip(exact) - 1}
    return {"errors": errors, "onsets": f"{onsets[0]:.1f} s, {onsets[1] / YEAR:.2f} years"}


def mean_slip(solution):
    """Mean slip of the fault one year after the start."""
    slip = solution.states[0]
    return np.mean(slip[: len(slip) // 2])


@cache
def explicit(size):
    return reference.solve(half_space.Plane(size), [YEAR, END * YEAR], 1e-5, first_step=1e-2, seismic=SEISMIC)
