"""Krylov and Newton iterations of poromechanics: water is injected into a network of ten fractures with closure and dilation.

Every linear solve goes from zero to a relative residual of 1e-8."""
import math
import re
from dataclasses import dataclass

from perf.common import options as common
from perf.common import table
from perf.common.program import Run
from perf.krylov import linear

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
BOUNDS = {"krylov_max": 32, "krylov_growth": 0.3, "newton_max": 8, "newton_growth": 0.3, "exponent": 1.15, "failures": 0}
FORMATS = {"krylov_max": ".4g", "krylov_given_up": ".4g", "krylov_growth": ".2f", "newton_max": ".3g", "newton_growth": ".2f", "exponent": ".2f"}
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
    run: Run

    @property
    def newton(self):
        """Largest number of Newton iterations of a step; of a bisected step, per substep."""
        return max((step["newton_iterations"] / max(1, step["substeps"] if step["cuts"] else 1) for step in self.run.steps), default=0)

    @property
    def seconds(self):
        """Seconds per Newton iteration."""
        return self.run.total_time / len(self.run.krylov)

    def values(self):
        run = self.run
        return [f"{self.mesh}, {self.case}", run.cells, run.system, run.fraction("slip"), run.fraction("open"), run.cuts, round(self.newton), int(run.max_used), run.mean,
                int(run.max_given_up), run.residual, *run.times, run.bytes[0] / 1e3 / run.system]


def summary(rows):
    series = [row for row in rows if row.case == "alike"]

    def growth(what):
        return table.growth([(row.mesh, row.level, what(row)) for row in series])
    return {"krylov_max": max(row.run.max_used for row in rows), "krylov_given_up": max(row.run.max_given_up for row in rows),
            "krylov_growth": growth(lambda row: row.run.mean), "newton_max": max((row.newton for row in series), default=math.nan),
            "newton_growth": growth(lambda row: row.newton), "exponent": table.exponent([(row.mesh, row.run.system, row.seconds) for row in series]),
            "failures": sum(bool(row.run.failure) for row in rows)}


def draw(study, rows, file):
    """Draws iterations and seconds of the mesh series against unknowns."""
    import style
    rows = [row for row in rows if row.case == "alike"]
    if not rows:
        return
    figure, three = style.plt.subplots(1, 3, figsize=(10, 3.2))
    for axes, (label, what) in zip(three, (("Krylov iterations, most (-)", lambda row: row.run.max_used), ("Newton iterations, most of a step (-)", lambda row: row.newton),
                                           ("seconds per Newton iteration (s)", lambda row: row.seconds))):
        for colour, mesh in zip(style.LINES, study.levels):
            of = [row for row in rows if row.mesh == mesh]
            axes.plot([row.run.system for row in of], [what(row) for row in of], color=colour, marker="o", markersize=4, label=mesh)
        axes.set(xscale="log", xlabel="unknowns (-)", title=label)
        axes.set_ylim(0, None)
    three[2].set(yscale="log")
    three[0].legend()
    figure.savefig(file, dpi=150)


def measure(study, words):
    """Runs all cases on the coarsest meshes and the series of meshes, and prints the results; returns the exit
    status."""
    parser = common.parser(study.name, study.text)
    parser.add_argument("--meshes", type=int, choices=(1, 2, 3), default=3, help="meshes in the series of each type of cells (3)")
    options = parser.parse_args(words)
    runs = [(mesh, case, 0) for mesh in study.levels for case in (study.quick if options.quick else study.cases)]
    if not options.quick:
        runs += [(mesh, "alike", level) for level in range(1, options.meshes) for mesh in study.levels]
    rows = table.Series(COLUMNS, 36)
    for mesh, case, level in common.matching(options, runs, lambda run: f"{run[0]}, {run[1]}"):
        shape, counts = study.levels[mesh]
        sets = (f"Mesh.cell={shape}", f"Mesh.cells={{{', '.join([str(counts[level])] * 3)}}}", *study.entries(case))
        run = linear.run(options, sets, re.sub(r"[^\w.+-]+", "_", f"{mesh} {case} {counts[level]}"), scene=SCENE)
        rows.run(f"{mesh}, {case}, {counts[level]}", run, Row(mesh, case, level, run))
    return rows.finish(options, summary, FORMATS, lambda of, file: draw(study, of, file), study.bounds)


def main(words):
    return measure(Study("poro", __doc__, list(CASES), QUICK, entries, BOUNDS, LEVELS), words)
