"""Growth of bonded fractures: errors against linear fracture mechanics, energy balance, and Newton iterations.

The process zone of the bond has five faces in every row and shrinks with them: strength ~ 1/sqrt(face). Errors of length
and pressure are means over the last third of the steps; `spread` is the largest deviation of a length from this mean.
The last line gives the number of failed runs, the largest error of length and of the energy balance in the finest rows,
and the median of the Newton iterations of all steps."""
import math
from functools import partial

import numpy as np

from perf.cohesive import exact, meshes
from perf.common import options as common
from perf.common import program, scene_file, table

BOUNDS = {"failures": 0, "worst_length": 0.01, "worst_energy": 0.01, "newton_median": 8}
QUICK_BOUNDS = {**BOUNDS, "worst_length": 0.03}
FORMATS = {"worst_length": ".4f", "worst_energy": ".4f", "newton_median": ".3g"}
COLUMNS = {"row": "", "cells": "d", "face": ".4g", "zone": ".4g", "length": ".2%", "spread": ".2%", "pressure": ".2%",
           "opening": ".2%", "elastic": ".4f", "energy": ".2%", "Newton": ".3g", "most": "d", "cuts": "d", "seconds": ".1f"}
FACES = 5  # of the process zone
MODULUS, POISSON = 30e9, 0.25
PLANE = MODULUS / (1 - POISSON**2)


def zone_of(strength, energy):
    return 0.8 * PLANE * energy / strength**2


class Row:
    def __init__(self, name, run, face, zone, lengths, errors=None, elastic=None):
        """`lengths`: relative errors of the steps compared."""
        self.errors = {"length": float(np.mean(lengths)), **(errors or {})}
        spread = float(np.max(np.abs(lengths - self.errors["length"])))
        self.name, self.newton = name, run.newton
        of = self.errors.get
        self.cells = [name, run.cells, face, zone, of("length"), spread, of("pressure"), of("opening"), elastic, of("energy"),
                      float(np.median(run.newton)), max(run.newton), run.cuts, run.seconds]


def rock(strength, energy, **joint):
    return {"granite": {"type": "elastic", "Young's modulus": MODULUS, "Poisson's ratio": POISSON, "permeability": [0.0]},
            "bonded joint": {"type": "joint", "friction coefficient": 0.6, "bond": "linear softening", "cohesion": 5 * strength,
                             "tensile strength": strength, "fracture energy": energy, "shear fracture energy": 25 * energy, **joint}}


def beam(options, strength):
    """Double cantilever beam, opened at its ends."""
    arm, notch, energy, end = 0.1, 0.1, 30.0, 4e-4
    zone = zone_of(strength, energy)
    size, name = zone / FACES, f"beam, {strength / 1e6:g} MPa"
    file = options.output / f"beam_{strength / 1e6:g}.xml"
    meshes.write(file.with_suffix(".msh"), meshes.graded(size, 0.4, 0.6, 1.2), meshes.graded(min(size, 0.004), 2 * size, arm, 1.15))
    scene_file.save({
        "Mesh file": {"path": file.with_suffix(".msh").name, "fractures": {"growing": {}}}, "Materials": rock(strength, energy), "Bulk": {"material": "granite"},
        "Fractures": {"growing": {"material": "bonded joint", "unbroken": f"x > {notch}"}},
        "Boundary conditions": {
            "upper": {"boundary": "west upper", "displacement": ["free", f"{end / 2}*t"]},
            "lower": {"boundary": "west lower", "displacement": ["free", f"-{end / 2}*t"]},
            "east": {"boundary": "east", "displacement": [0.0, 0.0]}},
        "Time": {"end": 1.0, "steps": round(40 * (strength / 4e6) ** 2)}, "Output": {"every": 100000}}, file, "Double cantilever beam with a bond.")
    run = program.succeeded(options.binary, file, options.output / f"beam_{strength / 1e6:g}", options.set)
    steps = run.steps[-len(run.steps) // 3:]
    exact_length = np.array([exact.beam_length(end * step["time"], arm, PLANE, energy) for step in steps])
    lengths = np.array([notch + broken(step) for step in steps])
    return Row(name, run, size, zone, lengths / exact_length - 1)


def broken(step):
    """Integral of the damage of the bond; times the fracture energy: the dissipated energy."""
    return step["fractures"]["growing"]["mean_damage_of_bond"] * step["fractures"]["growing"]["area"]


def volume(step):
    return step["fractures"]["growing"]["mean_opening"] * step["fractures"]["growing"]["area"]


def injection(options, strength):
    """Half of a fracture of plane strain, filled at a constant rate."""
    half, notch, energy, rate, end = 50.0, 2.0, 125.0, 3.5e-5, 100.0
    zone = zone_of(strength, energy)
    size, name = zone / FACES, f"injection, {strength / 1e6:g} MPa"
    file = options.output / f"injection_{strength / 1e6:g}.xml"
    meshes.write(file.with_suffix(".msh"), meshes.graded(size, 11.5, half, 1.3), meshes.graded(size, 2 * size, half, 1.3))
    scene_file.save({
        "Mesh file": {"path": file.with_suffix(".msh").name, "fractures": {"growing": {}}}, "Bulk": {"material": "granite"},
        "Materials": rock(strength, energy, **{"residual aperture": 2e-6}),
        "Flow": {"viscosity": 1e-6, "compressibility": 4.5e-10,
                 "Wells": {"injector": {"points": [size / 2, 0.0], "radius": 0.01, "rate": rate}}},
        "Fractures": {"growing": {"material": "bonded joint", "unbroken": f"x > {notch}"}},
        "Boundary conditions": {
            **{name: {"boundary": name, "displacement": [0.0, "free"]} for name in ("west upper", "west lower", "east")},
            "south": {"boundary": "south", "displacement": ["free", 0.0]}},
        "Time": {"end": end, "steps": round(60 * strength / 1.41e6)}, "Output": {"every": 100000}}, file, "Growth by injection.")
    run = program.succeeded(options.binary, file, options.output / f"injection_{strength / 1e6:g}", options.set)
    toughness, last = math.sqrt(energy * PLANE), run.steps[-1]
    volumes = np.array([0.0, *map(volume, run.steps)])
    pressures = np.array([0.0] + [step["fractures"]["growing"]["max_fracture_pressure"] for step in run.steps])
    a = np.array([exact.length(2 * v, half, PLANE, toughness) for v in volumes[-len(run.steps) // 3:]])
    p = np.array([exact.pressure(one, half, toughness) for one in a])
    lengths = np.array([notch + broken(step) for step in run.steps[-len(a):]])
    work = float(np.sum(np.diff(volumes) * (pressures[1:] + pressures[:-1]))) / 2
    elastic = float(pressures[-1] * volumes[-1]) / 2  # of rock and bond
    width = exact.width(a[-1], half, PLANE, toughness)
    errors = {"pressure": float(np.mean(pressures[-len(a):] / p - 1)), "opening": last["fractures"]["growing"]["max_opening"] / width - 1,
              "energy": (elastic + energy * broken(last)) / work - 1}
    return Row(name, run, size, zone, lengths / a - 1, errors, elastic / (work + energy * notch))


def cases(options):
    """Yields (name, function that returns a Row)."""
    for strength in (4e6,) if options.quick else (4e6, 5.66e6, 8e6):
        yield f"beam, {strength / 1e6:g} MPa", partial(beam, options, strength)
    for strength in (1.41e6,) if options.quick else (1.41e6, 2e6, 2.83e6):
        yield f"injection, {strength / 1e6:g} MPa", partial(injection, options, strength)


def summary(rows, failures):
    finest = {row.name.split(",")[0]: row for row in rows}.values()

    def worst(name):
        return max((abs(row.errors[name]) for row in finest if name in row.errors), default=math.nan)
    iterations = [count for row in rows for count in row.newton]
    return {"failures": failures, "worst_length": worst("length"), "worst_energy": worst("energy"),
            "newton_median": float(np.median(iterations)) if iterations else math.nan}


def main(words):
    options = common.parser("cohesive", __doc__).parse_args(words)
    shown, rows, failed = table.Table(COLUMNS, 22), [], []
    for name, measure in common.matching(options, list(cases(options)), lambda case: case[0]):
        try:
            rows.append(measure())
            shown.add(rows[-1].cells)
        except program.Failed as reason:
            failed.append(f"failed: {name}: {reason}")
            print(failed[-1], flush=True)
    return table.finish(options, shown, summary(rows, len(failed)), FORMATS, QUICK_BOUNDS if options.quick else BOUNDS, failed)
