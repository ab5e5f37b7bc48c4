"""Measured and computed joints: laws are fitted to a part of an experiment and predict the remaining part.

Injection-shear tests of Ye and Ghassemi (2018), specimens SW-S4 (saw cut) and SW-T2 (tensile fracture): the pressure rises
in six stages and falls in five. One set of parameters per specimen is fitted to the rising stages with the point driver: a
column of specimen and machine shears the joint under the measured effective compression. The falling stages are predicted.
All stages are then computed with the same parameters for a specimen of poroelastic rock with injection into its fracture.

The GREAT cell: strains in a sample under the loads of 16 pads, compared with those computed by another team."""
import apps.fit.__main__ as fit
import numpy as np
from compare import Comparison, pair
from measured import read
from point import Point, Specification

from perf.common import options as common
from perf.common import table
from perf.common.program import ROOT
from perf.experiments import great_cell, specimen

SCENE = ROOT / "xml" / "point" / "injection_shear.xml"
OUTLET = 5e6  # Pa; effective stresses of the table: 30 MPa + tau tan(30 deg) - (injection pressure + 5 MPa)/2
LAST_RISING = 5
WORST_FIT = 0.1  # allowed rms relative to the range
RISING = slice(0, LAST_RISING + 1)
# m: length of the specimen; hydraulic aperture in the first stage
LENGTHS = {"sw_s4": (0.1187, 0.74e-6), "sw_t2": (0.1327, 2.11e-6)}
# in the scene
FRICTION = {"friction coefficient": 0.5, "residual friction coefficient": 0.1, "weakening distance": 1e-4}
SPECIMENS = {
    "sw_s4": ({}, ["friction coefficient", "weakening distance", "Point.column tangential stiffness=1e10..1e12"]),
    "sw_t2": ({"Materials.saw cut.friction coefficient": 1.3, "Materials.saw cut.residual friction coefficient": 0.9},
              ["friction coefficient=1.13..2", "residual friction coefficient=0.2..1.1",
               "Point.column tangential stiffness=1e10..1e12"])}


def overrides_of(columns, more):
    """Overrides of the scene: the stages of a table as a path of the point, beginning at the first stage."""
    normal, shear = -columns["effective normal stress"][0], columns["shear stress"][0]
    return [f"Tables.normal.values={{{', '.join(f'{v:.17g}' for v in normal)}}}",
            f"Point.initial traction={{{normal[0]:.17g}, {shear[0]:.17g}}}",
            *(f"{path}={value}" for path, value in more.items())]


def flow_of(columns, slip):
    """Flow rate by the cube of an aperture that increases with slip and decreases with effective compression, both
    linearly.

    The three coefficients are fitted to Q/(p_in - p_out) of the rising stages."""
    drop = columns["injection pressure"][0] - OUTLET
    measured = columns["flow rate"][0]
    stress = columns["effective normal stress"][0]
    A = np.array([np.ones_like(slip), slip / np.max(slip), stress / stress[0]]).T
    root = np.cbrt(measured / drop)
    coefficients = np.linalg.lstsq(A[RISING], root[RISING], rcond=None)[0]
    return drop * (A @ coefficients)**3


def in_units(columns, computed):
    """Returns (quantity, unit, measured, computed) for computed SI values by column name. Columns without
    measurements are skipped."""
    units = {"shear stress": ("MPa", 1e-6), "effective normal stress": ("MPa", 1e-6), "slip": ("um", 1e6),
             "normal displacement": ("um", 1e6), "flow rate": ("uL/min", 60e9)}
    return [(name, units[name][0], columns[name][0] * units[name][1], values * units[name][1]) for name, values in computed.items()
            if np.isfinite(columns[name][0]).any()]


def of_rock(name, columns, fitted, slip, options):
    """Runs the specimen of rock with the fitted parameters; returns its results and texts."""
    length, hydraulic = LENGTHS[name]
    own = {**FRICTION, **{p.split(".")[-1]: value for p, value in SPECIMENS[name][0].items()}}
    one = specimen.Specimen(length, hydraulic, {entry: fitted.get(entry, value) for entry, value in own.items()},
                            fitted["Point.column tangential stiffness"])
    wide, dilation, closes = specimen.aperture(columns, slip, hydraulic, RISING, OUTLET)
    shear = columns["shear stress"][0][0]
    found = specimen.run(options.binary, options.output / name, specimen.entries(one, shear, wide, dilation, closes))
    width = columns["flow rate"][0][0] / found["flow rate"][0]
    found["flow rate"] = found["flow rate"] * width
    reported = [f"across the plane of the specimen in 2D {1e3 * width:.1f} mm", f"dilation by the flow tan {dilation:.2e}"]
    opened, slipped = -columns["normal displacement"][0][RISING], columns["slip"][0][RISING]
    known = np.isfinite(opened) & np.isfinite(slipped)
    if known.sum() > 1:
        reported.append(f"by the normal displacement tan {slipped[known] @ opened[known] / (slipped[known] @ slipped[known]):.2f}")
    return found, reported


def rows_of(name, options):
    """Returns {model: (quantity, unit, measured, computed)} of a specimen, and texts on the fitted parameters."""
    path = ROOT / "perf/experiments" / f"{name}.csv"
    columns = read(path)
    more, texts = SPECIMENS[name]
    point = Point(str(options.binary), str(SCENE), overrides_of(columns, more))
    named = [fit.parameter(text, point, Specification(point)) for text in texts]
    outputs = point.curve({})[0]
    along = pair(path, columns, "stage=t", "along", outputs)
    matched = [pair(path, columns, text, "match", outputs)
               for text in ("shear stress=traction_t", "slip=change of plastic_jump_t")]
    comparison = Comparison(path, along, matched, LAST_RISING)
    estimate, curve = fit.fitted(point, comparison, named)
    stages = columns["stage"][0]
    stress, slip = (np.interp(stages, curve["t"], p.computed(curve)) for p in matched)
    flow = flow_of(columns, slip)
    reported = list(fit.lines_of(estimate, [p for _, p in named], comparison, curve))[:len(named)]
    fitted = {p.name: value for (_, p), value in zip(named, estimate.values)}
    rock, more = of_rock(name, columns, fitted, slip, options)
    return {"point": in_units(columns, {"shear stress": stress, "slip": slip, "flow rate": flow}), "rock": in_units(columns, rock)}, reported + more


def relative(measured, computed, rows):
    """Root mean square and largest difference, relative to the range of the measured values; rows without a
    measurement are skipped."""
    known = rows & np.isfinite(measured)
    if not known.any():
        return np.nan, np.nan
    difference = (computed - measured)[known] / np.ptp(measured[np.isfinite(measured)])
    return np.sqrt(np.mean(difference**2)), np.max(abs(difference))


def main(words):
    parser = common.parser("experiments", __doc__, None, None, sets=False)
    parser.add_argument("--only", choices=["great_cell", *sorted(SPECIMENS)], help="one specimen")
    options = parser.parse_args(words)
    names = [options.only] if options.only else ["great_cell", *sorted(SPECIMENS)]
    near = "great_cell" not in names or great_cell.run(options)
    injected = [name for name in names if name in SPECIMENS]
    return 0 if near and (not injected or injection_tests(options, injected)) else 1


def injection_tests(options, names):
    """Prints fitted parameters and errors. Returns True if the point model fits all rising stages."""
    summary = []
    for name in names:
        models, reported = rows_of(name, options)
        print(name, *reported, sep="\n  ")
        rows = [(model, *row) for model, quantities in models.items() for row in quantities]
        titles = [f"{model}: {q} {kind} ({u})" for model, q, u, _, _ in rows for kind in ("measured", "computed")]
        table.write(options.output / f"{name}.csv", ["stage (-)", *titles],
                    np.column_stack([np.arange(11)] + [v for row in rows for v in row[3:]]).tolist())
        rising = np.arange(11) <= LAST_RISING
        for model, quantity, _, measured, computed in rows:
            fitted, predicted = (relative(measured, computed, which) for which in (rising, ~rising))
            summary.append((name, model, quantity, *fitted, *predicted))
    titles = ["specimen", "model", "quantity", "rising rms", "rising largest", "falling rms", "falling largest"]
    table.write(options.output / "experiments.csv", titles, summary)
    print(f"{'specimen':10}{'model':8}{'quantity':25}{'rising rms':>12}{'largest':>10}{'falling rms':>13}{'largest':>10}   (% of the range)")
    for name, model, quantity, *values in summary:
        a, b, c, d = (f"{100 * v:.1f}" if np.isfinite(v) else "-" for v in values)
        print(f"{name:10}{model:8}{quantity:25}{a:>12}{b:>10}{c:>13}{d:>10}")
    return all(fitted < WORST_FIT for _, model, _, fitted, *_ in summary if model == "point")
