"""Krylov and Newton iterations from ten thousand to a million unknowns: a network with open, sticking and sliding fractures, of hexahedra and of tetrahedra.

Every linear solve goes from zero to a relative residual of 1e-8. --against MueLu also runs each scene with MueLu in place of Sprekk's own multigrid,
and prints the ratios of the costs."""
import math
import re
from dataclasses import dataclass

import numpy as np

from perf.common import options as common
from perf.common import table
from perf.common.program import STATES as CONTACT_STATES
from perf.common.program import Run
from perf.krylov import linear

EDGES = (12, 18, 30, 42, 66)  # cells along a box edge: 11, 29, 111, 280 and 1001 thousand unknowns
QUICK = {12: r"tetrahedra|stick", 18: r"stick"}  # edge: pattern of the series
REFERENCE = 30                # first mesh for growth and exponent
BOUNDS = {"max_krylov": 25, "growth": 0.3, "newton_growth": 0.3, "exponent": 1.1}
FORMATS = {"max_krylov": ".4g", "growth": ".2f", "newton_growth": ".2f", "exponent": ".2f",
           **{f"MueLu_{what}": ".2f" for what in ("iterations", "set_up", "solve", "memory")}}
QUICK_BOUNDS = {"max_krylov": 25, "growth": 0.3, "newton_growth": 0.3}  # for all meshes
STATES = {  # displacements of the sides, and the joint
    "stick": linear.table(xx=-0.01, yy=-0.01, zz=-0.01, shear=0.002),
    "slip": linear.table(xx=-0.01, yy=-0.01, zz=-0.01, shear=0.06),
    "mixed": linear.table(xx=0.007, yy=-0.006, zz=-0.012, shear=0.012) + linear.joint(stiffness=1, dilation=2),
    "open": linear.table(xx=0.01, yy=0.012, zz=-0.01, shear=0.002) + linear.joint(stiffness=1),
}
OTHERS = {"MueLu": ("Solver.Blocks.displacement.type=MueLu",)}
COMPARED = {"iterations": lambda run: run.mean, "set_up": lambda run: run.times[0], "solve": lambda run: run.times[2],
            "memory": lambda run: run.bytes[0]}
COLUMNS = {"cells, state": "", "edge": "d", "unknowns": "d", **{state: ".2f" for state in CONTACT_STATES}, "Newton": ".4g", "cuts": "d", "solves": "d",
           "mean": ".1f", "max": ".4g", "residual": ".0e", "set-up s": ".1f", "assembly s": ".1f", "solve s": ".1f", "kB/unknown": ".1f"}


@dataclass
class Row:
    """One state on one mesh, with Sprekk's multigrid or another one."""
    series: str
    edge: int
    other: str
    run: Run

    @property
    def name(self):
        return f"{self.series}, {self.other}" if self.other else self.series

    def values(self):
        run = self.run
        return [self.name, self.edge, run.unknowns, *run.fractions, run.mean_newton, run.cuts, len(run.krylov), run.mean,
                run.maximum, run.residual, *run.times, run.bytes[0] / 1e3 / max(1, run.unknowns)]


def summary(rows, quick):
    edges = sorted({row.edge for row in rows})
    first = edges[0] if quick else max((e for e in edges if e <= REFERENCE), default=edges[0])
    last = edges[-1]

    def growth(what):
        return table.growth([(row.series, row.edge, what(row.run)) for row in rows], first, last)
    return {"max_krylov": max(row.run.maximum for row in rows if quick or row.edge == last), "growth": growth(lambda run: run.mean),
            "newton_growth": growth(lambda run: run.mean_newton),
            "exponent": table.exponent([(row.series, row.run.unknowns, row.run.total_time) for row in rows if row.edge >= first])}


def ratios(rows, other):
    """Ratios of the other multigrid to Sprekk's own for COMPARED: geometric means over the scenes that ran with
    both."""
    own = {(row.series, row.edge): row.run for row in rows if not row.other}
    pairs = [(own[row.series, row.edge], row.run) for row in rows if row.other and (row.series, row.edge) in own]
    return {f"{other}_{what}": math.exp(np.mean([math.log(of(theirs) / of(ours)) for ours, theirs in pairs])) if pairs else math.nan
            for what, of in COMPARED.items()}


def draw(rows, file):
    """Draws iterations and seconds against unknowns: a colour for each state, dashed for tetrahedra, dotted for
    another multigrid."""
    import style
    figure, axes = style.plt.subplots(1, 3, figsize=(10.5, 3.4))
    names, states = sorted({row.name for row in rows}), list(STATES)
    whats = (("Krylov iterations of a solve: mean, largest (-)", lambda row: row.run.mean), ("Newton iterations of a step (-)", lambda row: row.run.mean_newton),
             ("set-up, assembly and solution (s)", lambda row: row.run.total_time))
    for ax, (label, what) in zip(axes, whats):
        for name in names:
            of = [row for row in rows if row.name == name]
            cell, state, *other = name.split(", ")
            look = dict(color=style.LINES[states.index(state)], linestyle=":" if other else "-" if cell == "hexahedra" else "--")
            x = [row.run.unknowns for row in of]
            ax.plot(x, [what(row) for row in of], label=name, marker="o", markersize=3.5, **look)
            if ax is axes[0]:
                ax.vlines(x, [row.run.mean for row in of], [row.run.maximum for row in of], color=look["color"], linewidth=0.8)
        ax.set(xscale="log", xlabel="displacement unknowns (-)", title=label)
    for ax in axes[:2]:
        ax.set_ylim(0, 1.05 * ax.get_ylim()[1])
    axes[2].set_yscale("log")
    slowest = max(rows, key=lambda row: row.run.total_time)
    x = np.array(axes[2].get_xlim())
    axes[2].plot(x, slowest.run.total_time * x / slowest.run.unknowns, ":", color=style.FAINT, label="proportional to unknowns", scalex=False, scaley=False)
    axes[2].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    figure.savefig(file, dpi=150)


def main(words):
    parser = common.parser("krylov", __doc__)
    parser.add_argument("--largest", type=float, default=1.2e6, metavar="N", help="no mesh with more unknowns than this (1.2e6)")
    parser.add_argument("--against", choices=OTHERS, help="run each scene with this multigrid as well")
    options = parser.parse_args(words)
    series = {f"{cell}, {state}": (f"Mesh.cell={shape}", *sets) for cell, shape in (("hexahedra", "hexahedron"), ("tetrahedra", "tetrahedron"))
              for state, sets in STATES.items()}
    runs = [(edge, name) for edge in (QUICK if options.quick else EDGES) for name in series
            if (re.search(QUICK[edge], name) if options.quick else 3 * (edge + 1)**3 <= options.largest)]
    chosen = common.matching(options, runs, lambda run: run[1])
    rows = table.Series(COLUMNS, 27 if options.against else 20)
    for edge, name, other in [(*run, other) for run in chosen for other in ("", options.against) if other is not None]:
        run = linear.run(options, (*linear.cells(edge), *series[name], *OTHERS.get(other, ())), f"{name.replace(', ', '_')}_{edge}{other}")
        rows.run(f"{name}, {edge}{other and ' with ' + other}", run, Row(name, edge, other, run))

    def total(of):
        return {**summary([row for row in of if not row.other], options.quick), **(ratios(of, options.against) if options.against else {})}
    return rows.finish(options, total, FORMATS, draw, QUICK_BOUNDS if options.quick else BOUNDS)
