"""Fractures driven by a fluid: errors against similarity solutions between viscosity and toughness.

Rows in plane strain are the growth of half of a fracture at one dimensionless toughness Kd, on a mesh with a number of
faces along the wing at the end. Strength and residual aperture follow from the opening near the tip, see README.md. Rows
of leak-off lose most of a nearly inviscid fluid. The last rows are a thin sector of a circular fracture in 3D. Errors
compare with the solution for the same volume at the end; with leak-off, at the same time.
The last line gives the number of failed runs, the largest error of length or radius on the finest meshes, the median of the
Newton iterations of all steps, and the number of meshes after the first. Bonds without viscosity: perf cohesive. Free paths,
with the share of time for remeshing: perf paths."""
import math
from functools import partial

import numpy as np

from perf.cohesive import meshes
from perf.cohesive.cohesive import PLANE, broken, rock, volume, zone_of
from perf.common import options as common
from perf.common import program, scene_file, table
from perf.growth import exact, penny

BOUNDS = {"failures": 0, "worst_radius": 0.01, "newton_median": 6, "remeshing": 0}
QUICK_BOUNDS = {**BOUNDS, "worst_radius": 0.03, "newton_median": 7}
FORMATS = {"worst_radius": ".4f", "newton_median": ".3g"}
COLUMNS = {"row": "", "cells": "d", "faces": "d", "strength": ".3g", "length": ".2%", "opening": ".2%", "pressure": ".2%", "order": ".2f",
           "energy": ".2%", "Newton": ".3g", "most": "d", "cuts": "d", "seconds": ".1f"}
FACES = (20, 40)  # along a wing at the end
ENERGY, LENGTH, END, NOTCH = 125.0, 10.0, 100.0, 0.1  # J/m^2, m, s, of the length
ZONE = 3       # faces of the process zone
SOFTENED = 0.733  # opening at the end of the zone over that of the sharp tip at this distance, linear softening
OPENED = 0.5   # residual aperture over the opening at one face behind the tip
STEPS = {1: 0.0, 4: 0.6}  # per face: from this part of the final length
FAR = 12       # half-width of the body over the length
REACH = 10     # of exact.Leaking
LAG = 0.135    # of the broken length behind a sharp tip over 0.8 E' G/T^2, without viscosity
RADIUS, CIRCULAR_NOTCH = 10.0, 0.2  # of circular fractures, m, and of this radius


def is_step(faces, part):
    """Whether a step ends where the front of the exact solution has passed `faces` faces, at this part of its way."""
    per_face = max(n for n, begin in STEPS.items() if part > begin - 1e-9)
    return abs(faces * per_face - round(faces * per_face)) < 1e-6


def scene_of(fracture, faces, file):
    """Writes the scene of a fracture with `faces` along its wing at the end; returns strength, Pa, and notch, m."""
    size, notch = LENGTH / faces, round(NOTCH * faces) * LENGTH / faces
    strength = 2 * ENERGY / (SOFTENED * fracture.tip_opening(ZONE * size))
    meshes.write(file.with_suffix(".msh"), meshes.graded(size, 1.1 * LENGTH, FAR * LENGTH, 1.4), meshes.graded(size, 2 * size, FAR * LENGTH, 1.4))
    fronts = [x for x in np.arange(notch, LENGTH + size / 8, size / max(STEPS)) if is_step((x - notch) / size, x / LENGTH)]
    times = [fracture.time(front) for front in fronts]
    scene_file.save({
        "Mesh file": {"path": file.with_suffix(".msh").name, "fractures": {"growing": {}}}, "Bulk": {"material": "granite"},
        "Materials": rock(strength, ENERGY, **{"residual aperture": OPENED * fracture.tip_opening(size)}),
        "Flow": {"viscosity": fracture.viscosity / 12, "compressibility": 1e-11,
                 "Wells": {"injector": {"points": [size / 2, 0.0], "radius": size / 5, "rate": fracture.rate / 2}}},
        "Fractures": {"growing": {"material": "bonded joint", "unbroken": f"x > {notch}", "leak-off coefficient": fracture.leak_off}},
        "Boundary conditions": {
            **{name: {"boundary": name, "displacement": [0.0, "free"]} for name in ("west upper", "west lower", "east")},
            "south": {"boundary": "south", "displacement": ["free", 0.0]}},
        "Time": {"schedule": [*(float(part * times[0]) for part in (0.25, 0.5, 0.75)), *(float(t) for t in times)]}, "Output": {"vtu": False, "energy": True}}, file, "Growth by a viscous fluid.")
    return strength, notch


class Row:
    """Result of a run. `errors`: of length or radius, of opening and pressure in the middle."""

    def __init__(self, name, faces, strength, run, errors):
        self.name, self.faces, self.strength, self.newton, self.errors = name, faces, strength, run.newton, errors
        self.remeshings = max(len(run.results.get("accuracy", {}).get("meshes", [])) - 1, 0)
        self.run = [self.balance(run.steps[-1]), float(np.median(run.newton)), max(run.newton), run.cuts, run.seconds]
        self.cells = run.cells

    @staticmethod
    def balance(last):
        """Relative error of the balance: work of the fluid on the rock = elastic energy of the rock + fracture energy."""
        energy = last["energy"]
        return (energy["elastic"] + last["fractures"]["growing"]["fracture_energy"]) / energy["work"]["face pressure"] - 1

    def values(self, coarser):
        """Columns; the order is that of the opening."""
        order = math.log(abs(coarser.errors[1] / self.errors[1])) / math.log(self.faces / coarser.faces) if coarser else None
        return [self.name, self.cells, self.faces, self.strength, *self.errors, order, *self.run]


def errors(computed, known):
    return [one / other - 1 for one, other in zip(computed, known)]


def plane(options, toughness, faces):
    fracture = exact.Fracture(toughness, PLANE, ENERGY, LENGTH, END)
    file = options.output / f"plane_{toughness}_{faces}.xml"
    strength, notch = scene_of(fracture, faces, file)
    run = program.succeeded(options.binary, file, file.with_suffix(""), options.set)
    last, fields = run.steps[-1], run.steps[-1]["fractures"]["growing"]
    computed = notch + broken(last), fields["max_opening"], fields["max_fracture_pressure"]
    return Row(f"plane strain, Kd = {toughness}", faces, strength, run, errors(computed, fracture.at(2 * volume(last) / fracture.rate)))


def leaking(options, faces):
    """A tenth of the fluid is in the fracture at the end. The errors include those of the start from the notch."""
    fracture = exact.Leaking(REACH, PLANE, ENERGY, LENGTH, END)
    file = options.output / f"leak_off_{faces}.xml"
    strength, notch = scene_of(fracture, faces, file)
    run = program.succeeded(options.binary, file, file.with_suffix(""), options.set)
    fields = run.steps[-1]["fractures"]["growing"]
    return Row("plane strain, leak-off", faces, strength, run,
               errors((notch + fields["area_broken"] + LAG * zone_of(strength, ENERGY), fields["max_opening"], fields["max_fracture_pressure"]), fracture.at(END)))


def circle(options, toughness, faces):
    """Sector of a circular fracture. The radius is that of the broken area."""
    fracture, size, notch = exact.Circle(toughness, PLANE, ENERGY, RADIUS, END), RADIUS / faces, RADIUS * CIRCULAR_NOTCH
    file, strength = options.output / f"circle_{toughness}_{faces}.xml", 2 * ENERGY / (SOFTENED * fracture.tip_opening(ZONE * size))
    fronts = [r for r in np.arange(notch, RADIUS + size / 8, size / max(STEPS)) if is_step((r - notch) / size, r / RADIUS)]
    penny.scene(file, rock(strength, ENERGY, **{"residual aperture": OPENED * fracture.tip_opening(size)}), fracture, size, notch, fronts)
    run = program.succeeded(options.binary, file, file.with_suffix(""), options.set)
    last, fields = run.steps[-1], run.steps[-1]["fractures"]["growing"]
    share = penny.ANGLE / (2 * math.pi)
    radius = math.sqrt(notch**2 + broken(last) / share / math.pi)
    return Row(f"circle, Kd = {toughness}", faces, strength, run,
               [*errors((radius, fields["max_opening"]), fracture.at(volume(last) / share / fracture.rate)), None])


def cases(options):
    """Yields (name, function that returns a Row)."""
    for toughness in (1,) if options.quick else exact.VALUES:
        for faces in (20,) if options.quick else FACES:
            yield f"plane strain, Kd = {toughness}, {faces} faces", partial(plane, options, toughness, faces)
    for faces in () if options.quick else (*FACES, 80):
        yield f"plane strain, leak-off, {faces} faces", partial(leaking, options, faces)
    for toughness in () if options.quick else (0.5, 5):
        for faces in FACES:
            yield f"circle, Kd = {toughness}, {faces} faces", partial(circle, options, toughness, faces)


def summary(rows, failures):
    finest = {row.name: row for row in rows}.values()
    iterations = [count for row in rows for count in row.newton]
    return {"failures": failures, "worst_radius": max((abs(row.errors[0]) for row in finest), default=math.nan),
            "newton_median": float(np.median(iterations)) if iterations else math.nan, "remeshing": sum(row.remeshings for row in rows)}


def main(words):
    options = common.parser("growth", __doc__).parse_args(words)
    shown, rows, failed = table.Table(COLUMNS, 26), [], []
    for name, measured in common.matching(options, list(cases(options)), lambda case: case[0]):
        try:
            row = measured()
        except program.Failed as reason:
            failed.append(f"failed: {name}: {reason}")
            print(failed[-1], flush=True)
            continue
        shown.add(row.values(next((one for one in reversed(rows) if one.name == row.name), None)))
        rows.append(row)
    return table.finish(options, shown, summary(rows, len(failed)), FORMATS, QUICK_BOUNDS if options.quick else BOUNDS, failed)
