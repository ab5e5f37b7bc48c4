#!/usr/bin/env python3
"""Krylov and Newton iterations of poromechanics: water is injected into a network of ten fractures with closure and dilation.

Every linear solve goes from zero to a relative residual of 1e-8."""
import re
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "perf/krylov"))

import linear  # noqa: E402
import numpy as np  # noqa: E402

SCENE = "poro/injection_3d.xml"
@dataclass
class Study:
    """Definition of a measurement: cases with their entries, meshes (`levels`) and bounds."""
    name: str
    text: str
    cases: list
    quick: tuple       # cases of --quick
    entries: callable  # function of a case
    bounds: dict
    levels: dict


RATE, VOLUME = 5e-3 / 6, 9.0  # m^3/s; m^3, the largest volume injected in all steps
TIGHT = 1e-19  # m^2: leak-off within a step, underestimated by coarse meshes, hardly affects fractures
# cells along an edge; multiples of 10 fit the fractures
LEVELS = {"tetrahedra": ("tetrahedron", (10, 20, 30)), "hexahedra": ("hexahedron", (10, 20, 40))}
CASES = {"alike": ()}
CASES.update({f"permeability {k:g}": (f"Materials.granite.permeability={{{k:g}}}",) for k in (1e-20, 1e-17, 1e-15, 1e-10)})
CASES.update({f"step {dt:g} s": dt for dt in (1.0, 60.0, 1e6, 1e9)})
CASES.update({f"friction {mu:g}": (f"Materials.rough joint.friction coefficient={mu:g}",) for mu in (0.1, 0.3, 0.9)})
CASES["twice the rate"] = (f"Flow.Wells.injector.rate={2 * RATE:.17g}",)
QUICK = ("alike", "permeability 1e-10", "step 1 s", "step 1e+09 s")
BOUNDS = {"krylov_max": 29, "krylov_growth": 0.3, "newton_max": 8, "newton_growth": 0.3, "exponent": 1.15, "failures": 0}
COLUMNS = {"cells, case": "", "cells": "d", "unknowns": "d", "slip": ".2f", "open": ".2f", "cuts": "d", "Newton": "d", "Krylov": "d", "mean": ".1f", "given up": "d", "residual": ".0e",
           "set-up s": ".2f", "assembly s": ".2f", "solve s": ".2f", "kB/unknown": ".1f"}


def entries(case):
    """Entries of three steps of equal length; long steps have a smaller rate."""
    given = CASES[case]
    step = given if isinstance(given, float) else 3600.0
    steps = (f"Time.end={3 * step:.17g}", "Time.steps=3", f"Flow.Wells.injector.rate={min(RATE, VOLUME / (3 * step)):.17g}", "Output.vtu=false",
             f"Materials.granite.permeability={{{TIGHT:g}}}")
    return steps if isinstance(given, float) else (*steps, *given)


@dataclass
class Row:
    mesh: str
    case: str
    level: int
    run: linear.Run

    @property
    def unknowns(self):
        """Number of unknowns of the linear system."""
        blocks = self.run.results["blocks"]
        eliminated = {name for group in blocks.get("local_groups", []) for name in group["blocks"]}
        return sum(field["unknowns"] for field in blocks["fields"] if field["name"] not in eliminated)

    @property
    def newton(self):
        """Largest number of Newton iterations of a step; of a bisected step, per substep."""
        return max((step["newton_iterations"] / (step["substeps"] if step["cuts"] else 1) for step in self.run.steps), default=0)

    @property
    def seconds(self):
        return sum(self.run.seconds(what) for what in linear.TIMERS)

    def values(self):
        run = self.run
        return [f"{self.mesh}, {self.case}", run.results["mesh"]["cells"], self.unknowns, run.fraction("slip"), run.fraction("open"), run.cuts, round(self.newton), int(run.most_used), run.mean,
                int(run.most_given_up), run.residual, *(run.seconds(what) for what in linear.TIMERS), run.bytes[0] / 1e3 / self.unknowns]


def growth(rows, what):
    """Relative growth of the mean from the coarsest to the finest level, over the meshes that ran on both."""
    levels = sorted({row.level for row in rows})
    if len(levels) < 2:
        return float("nan")
    first, last = ({row.mesh: what(row) for row in rows if row.level == level} for level in (levels[0], levels[-1]))
    both = first.keys() & last.keys()
    return sum(last[mesh] for mesh in both) / sum(first[mesh] for mesh in both) - 1


def exponent(rows):
    """Exponent p of seconds per Newton iteration ~ unknowns^p, fitted to all cell shapes, each with its own factor."""
    points = {}
    for row in rows:
        points.setdefault(row.mesh, []).append((np.log(row.unknowns), np.log(row.seconds / len(row.run.krylov))))
    centred = [np.array(of) - np.mean(of, axis=0) for of in points.values() if len(of) > 1]
    if not centred:
        return float("nan")
    x, y = np.concatenate(centred).T
    return float(x @ y / (x @ x))


def draw(study, rows, file):
    """Draws iterations and seconds of the mesh series against unknowns."""
    import style
    figure, three = style.plt.subplots(1, 3, figsize=(10, 3.2))
    for axes, (label, what) in zip(three, (("Krylov iterations, most (-)", lambda row: row.run.most_used), ("Newton iterations, most of a step (-)", lambda row: row.newton),
                                           ("seconds per Newton iteration (s)", lambda row: row.seconds / len(row.run.krylov)))):
        for colour, mesh in zip(style.LINES, study.levels):
            of = [row for row in rows if row.mesh == mesh]
            axes.plot([row.unknowns for row in of], [what(row) for row in of], color=colour, marker="o", markersize=4, label=mesh)
        axes.set(xscale="log", xlabel="unknowns (-)", title=label)
        axes.set_ylim(0, None)
    three[2].set(yscale="log")
    three[0].legend()
    figure.savefig(file, dpi=150)


def measure(study, words):
    """Runs all cases on the coarsest meshes and the series of meshes, and prints the results; returns the exit
    status."""
    parser = linear.parser(study.name, study.text)
    parser.add_argument("--meshes", type=int, choices=(1, 2, 3), default=3, help="meshes in the series of each type of cells (3)")
    options = parser.parse_args(words)
    runs = [(mesh, case, 0) for mesh in study.levels for case in (study.quick if options.quick else study.cases)]
    if not options.quick:
        runs += [(mesh, "alike", level) for level in range(1, options.meshes) for mesh in study.levels]
    chosen = linear.matching(options, runs, lambda run: f"{run[0]}, {run[1]}")
    options.output.mkdir(parents=True, exist_ok=True)
    table, rows, failed = linear.Table(COLUMNS, 36), [], []
    for mesh, case, level in chosen:
        shape, counts = study.levels[mesh]
        sets = (f"Mesh.cell={shape}", f"Mesh.cells={{{', '.join([str(counts[level])] * 3)}}}", *study.entries(case))
        run = linear.run(options, sets, re.sub(r"[^\w.+-]+", "_", f"{mesh} {case} {counts[level]}"), scene=SCENE)
        if run.failure:
            failed.append(f"failed: {mesh}, {case}, {counts[level]}: {run.failure}")
        if run.steps:
            rows.append(Row(mesh, case, level, run))
            table.add(rows[-1].values(), failed[-1:] if run.failure else ())
    if not rows:
        sys.exit("\n".join(failed))
    table.write(options.output / f"{study.name}.csv")
    series = [row for row in rows if row.case == "alike"]
    if series:
        draw(study, series, options.output / f"{study.name}.png")
    total = {"krylov_max": max(row.run.most_used for row in rows), "krylov_given_up": max(row.run.most_given_up for row in rows), "krylov_growth": growth(series, lambda row: row.run.mean), "newton_max": max((row.newton for row in series), default=np.nan),
             "newton_growth": growth(series, lambda row: row.newton), "exponent": exponent(series), "failures": len(failed)}
    wrong = linear.missed(total, {name: bound for name, bound in study.bounds.items() if not np.isnan(total[name])})
    print("\n".join(["", *failed, f"{study.name}.csv, and {study.name}.png of the series of meshes, in {options.output}", *wrong]))
    print("krylov_max={krylov_max:.4g} krylov_given_up={krylov_given_up:.4g} krylov_growth={krylov_growth:.2f} newton_max={newton_max:.3g} newton_growth={newton_growth:.2f} exponent={exponent:.2f} failures={failures}".format(**total))
    return 1 if failed or (options.quick and wrong) else 0


def main(words):
    return measure(Study("poro", __doc__, list(CASES), QUICK, entries, BOUNDS, LEVELS), words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
