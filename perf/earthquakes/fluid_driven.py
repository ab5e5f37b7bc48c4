"""Slip driven by fluid: runs, and their errors against similarity solutions."""
from functools import partial

import numpy as np
import read

from perf.common import program
from perf.earthquakes import exact, scenes

SCENE = "earthquakes/fluid_driven_2d.xml"
TRACTION, MODULUS = 0.6 * 20e6, 30e9 / (1 - 0.25**2)  # Pa, of the scene
END = {0.1: 120.0, 0.3: 220.0}                        # s
OUTER = (0.7, 0.95)  # distances over the front of the faces that determine it
DISC_STEPS = 8


def cases(options, row):
    """Yields (name, function that returns a row)."""
    for T in (0.1, 0.3):
        yield f"2D, constant pressure, T = {T:g}", partial(plane, options, row, T)
    for T in (0.5,) if options.quick else (0.1, 0.5, 1.0):
        yield f"3D, constant rate, T = {T:g}", partial(disc, options, row, T)


def plane(options, row, T):
    """Constant pressure in the middle of a fault in plane strain."""
    name, file = f"2D, constant pressure, T = {T:g}", options.output / "meshes/plane.msh"
    coarse = ("Mesh file.network.relative size=0.016", "Mesh file.network.size at tips=1.6", "Mesh file.network.growth=0.2")
    program.mesh(options.binary, SCENE, file, coarse if options.quick else ())
    end, front = END[T], exact.front_coefficient(2, T) * 2  # alpha = 1 m^2/s
    entries = (f"Mesh file.path={file}", f"Time.end={end:g}", f"Expressions.potency={exact.potency(2, T, TRACTION, MODULUS, front):.17g}*t",
               f"Bulk.initial stress={{-50e6, -50e6, -50e6, {30e6 - T * TRACTION:.17g}}}", "Output.every=100000", *options.set)
    run = program.succeeded(options.binary, SCENE, options.output / f"plane_{T:g}", entries)
    front *= np.sqrt(end)
    return row(name, run, errors(run, 2, T, TRACTION, MODULUS, front, exact.potency(2, T, TRACTION, MODULUS, front) / 2))


def disc(options, row, T):
    """Constant rate at the centre of a fault in 3D."""
    name, file = f"3D, constant rate, T = {T:g}", options.output / f"disc_{T:g}.xml"
    scenes.write_disc(file, T, 8 if options.quick else 16, 6 if options.quick else DISC_STEPS)
    run = program.succeeded(options.binary, file, options.output / f"disc_{T:g}", options.set)
    traction = scenes.FRICTION * scenes.PRESSURE
    potency = exact.potency(3, T, traction, scenes.YOUNG, scenes.RADIUS) / 4
    return row(name, run, errors(run, 3, T, traction, scenes.YOUNG, scenes.RADIUS, potency))


def errors(run, dim, T, traction, modulus, front, potency):
    """Relative errors at the end: front of the slip, integral of the slip over the fault."""
    faces = read.segments(read.grid(read.written_steps(run.directory, "fractures")[-1][1]))
    centres = np.array([corners.mean(axis=0) for corners in faces.corners()])
    distance, slip = np.linalg.norm(centres, axis=1), faces.cell_data["slip"]
    outer = (distance > OUTER[0] * front) & (distance < OUTER[1] * front)
    solution = exact.slip(dim, T, traction, modulus, front, distance[outer])
    fracture = run.steps[-1]["fractures"]["fault"]
    return {"front": zero(distance[outer], slip[outer]) / zero(distance[outer], solution) - 1,
            "slip": fracture["mean_slip"] * fracture["area"] / potency - 1}


def zero(distance, slip):
    """Zero of the straight line through slip^(2/3): near its front, slip is proportional to (distance to it)^(3/2)."""
    slope, value = np.polyfit(distance, slip ** (2 / 3), 1)
    return -value / slope
