#!/usr/bin/env python3
"""Measured joints beside Sprekk's: laws are fitted to a part of an experiment and predict the rest.

Injection-shear tests of Ye and Ghassemi (2018), specimens SW-S4 (saw cut) and SW-T2 (tensile fracture): the pressure rises
in six stages and falls in five. One set of parameters per specimen is fitted to the rising stages, at a point that a
column, specimen and machine, shears under the effective compression of the table; the falling ones are predicted."""
import argparse
import csv
import importlib.util
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "apps" / "fit"))
spec = importlib.util.spec_from_file_location("sprekk_fit", ROOT / "apps" / "fit" / "__main__.py")
fit = importlib.util.module_from_spec(spec)
spec.loader.exec_module(fit)

from compare import Comparison, pair  # noqa: E402
from measured import read  # noqa: E402
from point import Point, Specification  # noqa: E402

SCENE = ROOT / "xml" / "point" / "injection_shear.xml"
OUTLET = 5e6  # Pa; the table's effective stresses are 30 MPa + tau tan(30 deg) - (injection pressure + 5 MPa)/2
LAST_RISING = 5
WORST_FIT = 0.1  # rms over the range
SPECIMENS = {
    "sw_s4": ({}, ["friction coefficient", "weakening distance", "Point.column tangential stiffness=1e10..1e12"]),
    "sw_t2": ({"Materials.saw cut.friction coefficient": 1.3, "Materials.saw cut.residual friction coefficient": 0.9},
              ["friction coefficient=1.13..2", "residual friction coefficient=0.2..1.1",
               "Point.column tangential stiffness=1e10..1e12"])}


def overrides_of(columns, more):
    """The stages of a table as a path of the point, from its first stage on."""
    normal, shear = -columns["effective normal stress"][0], columns["shear stress"][0]
    return [f"Tables.normal.values={{{', '.join(f'{v:.17g}' for v in normal)}}}",
            f"Point.initial traction={{{normal[0]:.17g}, {shear[0]:.17g}}}",
            *(f"{path}={value}" for path, value in more.items())]


def flow_of(columns, slip):
    """Q/(p_in - p_out) as the cube of an aperture that slip opens and the effective compression closes, both linearly,
    with three coefficients fitted to the rising stages."""
    drop = columns["injection pressure"][0] - OUTLET
    measured = columns["flow rate"][0]
    stress = columns["effective normal stress"][0]
    A = np.array([np.ones_like(slip), slip / np.max(slip), stress / stress[0]]).T
    rising = slice(0, LAST_RISING + 1)
    root = np.cbrt(measured / drop)
    coefficients = np.linalg.lstsq(A[rising], root[rising], rcond=None)[0]
    return measured, drop * (A @ coefficients)**3


def rows_of(name, options):
    """(quantity, unit, measured, computed) of a specimen, and what was fitted."""
    path = HERE / f"{name}.csv"
    columns = read(path)
    more, texts = SPECIMENS[name]
    point = Point(options.binary, str(SCENE), overrides_of(columns, more))
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
    told = list(fit.told(estimate, [p for _, p in named], comparison, curve))[:len(named)]
    return [("shear stress", "MPa", 1e-6 * columns["shear stress"][0], 1e-6 * stress),
            ("slip", "um", 1e6 * columns["slip"][0], 1e6 * slip),
            ("flow rate", "uL/min", 60e9 * flow[0], 60e9 * flow[1])], told


def relative(measured, computed, rows):
    """The largest and the root mean square difference over the range of what was measured, where it was."""
    known = rows & np.isfinite(measured)
    difference = (computed - measured)[known] / np.ptp(measured[np.isfinite(measured)])
    return (np.sqrt(np.mean(difference**2)), np.max(abs(difference))) if known.any() else (np.nan, np.nan)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=str(ROOT / "build/apps/sprekk/sprekk"), help="the program")
    parser.add_argument("--output", type=Path, default=Path("output/perf/experiments"), help="folder of the table")
    parser.add_argument("--only", choices=sorted(SPECIMENS), help="one specimen")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    summary = []
    for name in [options.only] if options.only else sorted(SPECIMENS):
        quantities, told = rows_of(name, options)
        print(name, *told, sep="\n  ")
        with open(options.output / f"{name}.csv", "w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["stage (-)"] + [f"{q} {kind} ({u})" for q, u, _, _ in quantities for kind in ("measured", "computed")])
            table.writerows(np.column_stack([np.arange(11)] + [v for q in quantities for v in q[2:]]).tolist())
        rising = np.arange(11) <= LAST_RISING
        for quantity, _, measured, computed in quantities:
            fitted, predicted = (relative(measured, computed, rows) for rows in (rising, ~rising))
            summary.append((name, quantity, *fitted, *predicted))
    print(f"{'specimen':10}{'quantity':14}{'fitted rms':>12}{'largest':>10}{'predicted rms':>15}{'largest':>10}   (% of the range)")
    for name, quantity, *values in summary:
        a, b, c, d = (f"{100 * v:.1f}" if np.isfinite(v) else "-" for v in values)
        print(f"{name:10}{quantity:14}{a:>12}{b:>10}{c:>15}{d:>10}")
    return 0 if all(fitted < WORST_FIT for _, _, fitted, *_ in summary) else 1


if __name__ == "__main__":
    sys.exit(main())
