"""Damage of a joint at a point: tractions of both programs on the same path of jumps, and the cost of late steps."""
import csv
import io
from pathlib import Path

import numpy as np

from perf.common import program, table

SCENE = Path(__file__).resolve().parent / "damage.xml"
STEPS = 16
SOME = 4          # steps at the beginning and at the end whose costs are compared
COLUMNS = {"apart": "", "normal": ".0e", "shear": ".0e", "slip": ".0e", "first steps": ".3f", "last steps": ".3f"}
WITHIN = 1e-9     # allowed difference of tractions and slips, relative to the largest


def entries(reported, dim):
    """Scene entries for the jumps of PorePy's run, with the normal component first."""
    jumps = np.array(reported["path"])[[1, 0, 2][:dim]]
    times = ", ".join(map(str, range(jumps.shape[1])))
    sets = [f"Tables.jump{i}.{what}={{{values}}}" for i, row in enumerate(jumps)
            for what, values in (("arguments", times), ("values", ", ".join(map(repr, row.tolist()))))]
    return [*sets, "Point.control={" + ", ".join(["jump"] * dim) + "}", "Point.path={" + ", ".join(f"jump{i}(t)" for i in range(dim)) + "}"]


def ours(options, dim, kind, reported):
    """Runs Sprekk; returns {quantity: values of all steps}."""
    sets = [f"Materials.joint.damage={kind}", f"Time.end={STEPS}", f"Time.steps={STEPS}", *entries(reported, dim)]
    rows = list(csv.DictReader(io.StringIO(program.checked([options.binary, "point", SCENE, *program.sets(sets)]))))[1:]
    shear = ["t"] if dim == 2 else ["t1", "t2"]

    def size(what):
        return np.hypot.reduce([[float(row[f"{what}_{t}"]) for row in rows] for t in shear])
    return {"normal": np.array([float(row["traction_n"]) for row in rows]), "shear": size("traction"), "slip": size("plastic_jump")}


def compare(options, theirs):
    """Prints a row for each kind of damage; returns messages of too large differences."""
    printed, wrong = table.Table(COLUMNS, 24), []
    for dim in (2, 3):
        for kind in ("isotropic", "anisotropic"):
            reported, _ = theirs(options, "damage.py", dim, kind, STEPS)
            their, our = reported["steps"], ours(options, dim, kind, reported)
            apart = {name: np.max(abs(values - [step[name] for step in their])) / np.max(abs(values)) for name, values in our.items()}
            seconds = np.diff([0, *(step["seconds"] for step in their)])
            solves = np.diff([0, *(step["solves"] for step in their)])
            early, late = (np.sum(seconds[part]) / np.sum(solves[part]) for part in (slice(SOME), slice(-SOME, None)))
            printed.add([f"{dim}D, {kind}", *apart.values(), early, late])
            wrong += [f"apart: damage, {dim}D, {kind}: {name} by {value:.1e}, {WITHIN} is allowed" for name, value in apart.items() if not value <= WITHIN]
    return wrong
