"""Faults with rate-and-state friction: runs, and their errors and steps compared with explicit solutions."""
import csv
import io
import time
from functools import cache, partial

import numpy as np
import read

from perf.common import program
from perf.earthquakes import reference

SLIDERS = (("ageing", 0.5), ("ageing", 0.8), ("slip", 0.5))  # law, stiffness over the critical stiffness
LAWS = {"ageing": "rate and state", "slip": "rate and state, slip law"}
SLIDER_SCENE, STRIP_SCENE, INJECTION_SCENE = "point/spring_slider.xml", "earthquakes/spring_slider_2d.xml", "earthquakes/injection_2d.xml"
SLIDER_END, TOLERANCE = 1.1e6, 1e-3  # s, tolerance of the time steps
LADDER = 10.0 ** -np.arange(1, 9)  # tolerances of the explicit method
TIMES = (8.64e6, 1.2e7, 3.15e7, 6.3e7)  # s, end of injection, and later
STATIONS = np.array([0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 8, 10]) * 1e3  # m, from the centre
# at the centre, by CYCLAPS (Dublanchet), from the platform of the code comparison of SCEC
PUBLISHED = {"time": 63066887.0, "slip": 0.209265, "rate": 10**-10.27701, "traction": 28.07028e6}


def cases(options, row):
    """Yields (name, function that returns a row)."""
    for law, stiffness in SLIDERS:
        name = f"point, {law} law, k/k_c = {stiffness:g}"
        yield name, partial(slider, options, row, name, law, stiffness)
    yield "BP6-QD-A", partial(injection, options, row, "BP6-QD-A")
    if not options.quick:
        yield "strip, ageing law, k/k_c = 0.5", partial(strip, options, row, "strip, ageing law, k/k_c = 0.5")
        yield "BP6-QD-A, explicit method", partial(published, row, "BP6-QD-A, explicit method")


def steps_at(wanted, error_of):
    """Steps of the explicit method with the fewest steps among the tolerances LADDER with at most this error; None if
    there is none. error_of(tolerance) returns (error, steps)."""
    return min((steps for error, steps in map(error_of, LADDER) if error <= wanted), default=None)


def slider(options, row, name, law, stiffness):
    """A block on a spring, with the point driver."""
    entries = (f"Materials.joint.friction={LAWS[law]}", f"Point.column tangential stiffness={stiffness * reference.STIFFNESS:.17g}",
               f"Time.end={SLIDER_END:g}", f"Time.tolerance={TOLERANCE:g}", *options.set)
    begin = time.monotonic()
    text = program.checked([options.binary, "point", program.ROOT / "xml" / SLIDER_SCENE, *program.sets(entries)])
    seconds = time.monotonic() - begin
    rows = list(csv.DictReader(io.StringIO(text)))
    times, rates = (np.array([float(one[column]) for one in rows]) for column in ("t", "slip_rate"))
    errors, steps = compared(times, rates, law, stiffness, rejected=False)  # unknown in the output of the driver
    return row(name, errors, len(rows) - 1, 0, seconds, reference=steps)


def strip(options, row, name):
    """The same in a strip of finite elements."""
    entries = (f"Time.end={SLIDER_END:g}", f"Time.tolerance={TOLERANCE:g}", "Output.vtu=false", *options.set)
    run = program.succeeded(options.binary, STRIP_SCENE, options.output / "strip", entries)
    times = np.array([step["time"] for step in run.steps])
    rates = np.array([step["fractures"]["fault"]["max_slip_rate"] for step in run.steps])
    return row.of_run(name, run, *compared(times, rates, "ageing", 0.5))


def compared(times, rates, law, stiffness, rejected=True):
    """Returns the errors of the slip rates of a spring slider, and the steps of the explicit method at equal error, with
    or without rejected ones."""
    exact = explicit_slider(law, stiffness, 1e-10)
    errors = slider_errors(crossings(times, rates), rates.max(), exact)

    def error_of(tolerance):
        found = explicit_slider(law, stiffness, tolerance)
        steps = found.steps + found.rejected if rejected else found.steps
        return max(slider_errors(found.onsets, found.largest, exact).values()), steps
    return errors, steps_at(max(errors.values()), error_of)


@cache
def explicit_slider(law, stiffness, tolerance):
    return reference.solve(reference.spring_slider(law, stiffness), [SLIDER_END], tolerance)


def slider_errors(onsets, largest, exact):
    """Relative errors of the time of the first event, of the period and of the largest slip rate; infinite for a wrong
    number of events."""
    if len(onsets) != len(exact.onsets):
        return {"first event": np.inf}
    period, of_exact = (np.diff(found)[-1] for found in (onsets, exact.onsets))
    return {"first event": abs(onsets[0] / exact.onsets[0] - 1), "period": abs(period / of_exact - 1),
            "largest rate": abs(largest / exact.largest - 1)}


def crossings(times, rates, seismic=reference.SEISMIC):
    """Times at which the rate passes `seismic`, linear in the logarithm of the rate, after it fell below a tenth."""
    found, fast = [], False
    for k, rate in enumerate(rates):
        if rate > seismic and not fast and k:
            low, high = np.log(rates[k - 1 : k + 1])
            found.append(times[k - 1] + (np.log(seismic) - low) / (high - low) * (times[k] - times[k - 1]))
        fast = rate > (seismic / 10 if fast else seismic)
    return found


def injection(options, row, name):
    """Slow slip by injection: slip of the fault at some times."""
    size, times = (100, TIMES[:2]) if options.quick else (50, TIMES)
    entries = (f"Mesh file.refinements={0 if options.quick else 1}", f"Time.schedule={{{', '.join(f'{t:g}' for t in times)}}}", "Output.vtu=true", *options.set)
    run = program.succeeded(options.binary, INJECTION_SCENE, options.output / "injection", entries)
    fine, exact = explicit_injection(size / 4, 1e-6, times)
    errors, places = [], []
    for k, t in enumerate(times):
        x, slip, length = slip_at(run, t)
        exact_slip = exact.states[k][:fine.n]
        errors.append(deviation(slip, np.interp(x, fine.z, exact_slip), length))
        places += at_stations(t, np.interp(STATIONS, x, slip), fine.z, exact_slip)
    line, converged = explicit_injection(size, LADDER[-1], times)

    def error_of(tolerance):
        found = explicit_injection(size, tolerance, times)[1]
        return max(deviation(one[:line.n], two[:line.n]) for one, two in zip(found.states, converged.states)), found.steps + found.rejected
    return row.of_run(name, run, {"slip": max(errors)}, steps_at(max(errors), error_of), places="; ".join(places))


@cache
def explicit_injection(h, tolerance, times):
    """Returns the problem with the spacing h and its solution at these times."""
    line = reference.bp6(h)
    return line, reference.solve(line, list(times), tolerance)


def published(row, name):
    """The explicit method against the published values of the centre."""
    begin, line = time.monotonic(), reference.bp6(12.5)
    found = reference.solve(line, [PUBLISHED["time"]], 1e-6)
    state, centre = found.states[0], line.n // 2
    errors = {"slip": state[centre] / PUBLISHED["slip"] - 1, "traction": line.traction(state[:line.n])[centre] / PUBLISHED["traction"] - 1,
              "rate": line.slip_rate(PUBLISHED["time"], state)[centre] / PUBLISHED["rate"] - 1}
    return row(name, errors, found.steps, found.rejected, time.monotonic() - begin)


def slip_at(run, t):
    """Distances from the centre in increasing order, slip and lengths of the faces at a time."""
    file = next(file for at, file in read.written_steps(run.directory, "fractures") if abs(at / t - 1) < 1e-9)
    faces = read.segments(read.grid(file))
    ends = np.array([corners[:2, 0] for corners in faces.corners()])
    order = np.argsort(ends.mean(axis=1))
    return ends.mean(axis=1)[order], faces.cell_data["slip"][order], np.abs(np.diff(ends)[order, 0])


def at_stations(t, slip, z, exact):
    """Stations whose slip differs by more than 1 %, with the distance, outwards, to the place where the exact slip is the
    same. It decreases with the distance z from the centre."""
    relative, right = slip / np.interp(STATIONS, z, exact) - 1, z >= 0
    distances = np.interp(-slip, -exact[right], z[right]) - STATIONS
    return [f"{station / 1000:g} km, {t:g} s: {error:+.1%}, {distance:+.0f} m"
            for station, error, distance in zip(STATIONS, relative, distances) if abs(error) > 0.01]


def deviation(slip, exact, length=1):
    """Root mean square of the difference over that of the exact slip."""
    return float(np.sqrt(np.sum(length * (slip - exact) ** 2) / np.sum(length * exact**2)))
