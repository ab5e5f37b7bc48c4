#!/usr/bin/env python3
"""Krylov and Newton iterations from ten thousand to a million unknowns: a network with open, sticking and sliding fractures, of hexahedra and of tetrahedra.

Every linear solve goes from zero to a relative residual of 1e-8. --against MueLu also runs each scene with MueLu in place of Sprekk's own multigrid,
and prints the ratios of the costs."""
import math
import re
import sys
from dataclasses import dataclass

import linear
import numpy as np

EDGES = (12, 18, 30, 42, 66)  # cells along a box edge: 11, 29, 111, 280 and 1001 thousand unknowns
QUICK = {12: r"tetrahedra|stick", 18: r"stick"}  # edge: pattern of the series
REFERENCE = 30                # first mesh for growth and exponent
BOUNDS = {"max_krylov": 25, "growth": 0.3, "newton_growth": 0.3, "exponent": 1.1}
QUICK_BOUNDS = {"max_krylov": 25, "growth": 0.3, "newton_growth": 0.3}  # for all meshes
STATES = {  # displacements of the sides, and the joint
    "stick": linear.table(xx=-0.01, yy=-0.01, zz=-0.01, shear=0.002),
    "slip": linear.table(xx=-0.01, yy=-0.01, zz=-0.01, shear=0.06),
    "mixed": linear.table(xx=0.007, yy=-0.006, zz=-0.012, shear=0.012) + linear.joint(stiffness=1, dilation=2),
    "open": linear.table(xx=0.01, yy=0.012, zz=-0.01, shear=0.002) + linear.joint(stiffness=1),
}
OTHERS = {"MueLu": ("Solver.Blocks.displacement.type=MueLu",)}
COMPARED = {"iterations": lambda run: run.mean, "set_up": lambda run: run.seconds("set-up"), "solve": lambda run: run.seconds("solve"),
            "memory": lambda run: run.bytes[0]}
COLUMNS = {"cells, state": "", "edge": "d", "unknowns": "d", **{state: ".2f" for state in linear.STATES}, "Newton": ".4g", "cuts": "d", "solves": "d",
           "mean": ".1f", "max": ".4g", "residual": ".0e", "set-up s": ".1f", "assembly s": ".1f", "solve s": ".1f", "kB/unknown": ".1f"}


@dataclass
class Row:
    """One state on one mesh, with Sprekk's multigrid or another one."""
    series: str
    edge: int
    other: str
    run: linear.Run

    @property
    def name(self):
        return f"{self.series}, {self.other}" if self.other else self.series

    @property
    def seconds(self):
        return sum(self.run.seconds(what) for what in linear.TIMERS)

    def values(self):
        run = self.run
        return [self.name, self.edge, run.unknowns, *(run.fraction(state) for state in linear.STATES), run.newton, run.cuts, len(run.krylov), run.mean,
                run.most, run.residual, *(run.seconds(what) for what in linear.TIMERS), run.bytes[0] / 1e3 / max(1, run.unknowns)]


def growth(rows, first, last, what):
    """Relative growth of `what` from the first to the last mesh, averaged over the series that ran on both."""
    at = {edge: {row.series: what(row.run) for row in rows if row.edge == edge} for edge in (first, last)}
    both = at[first].keys() & at[last].keys()
    return sum(at[last][s] for s in both) / sum(at[first][s] for s in both) - 1 if both else math.nan


def exponent(rows, first):
    """Exponent p of seconds ~ unknowns^p, fitted to all series, each with its own factor."""
    points = {}
    for row in rows:
        if row.edge >= first and row.seconds > 0:
            points.setdefault(row.series, []).append((math.log(row.run.unknowns), math.log(row.seconds)))
    centred = [np.array(of) - np.mean(of, axis=0) for of in points.values() if len(of) > 1]
    if not centred:
        return math.nan
    x, y = np.concatenate(centred).T
    return float(x @ y / (x @ x))


def summary(rows, quick):
    edges = sorted({row.edge for row in rows})
    first = edges[0] if quick else max((e for e in edges if e <= REFERENCE), default=edges[0])
    last = edges[-1]
    return {"max_krylov": max(row.run.most for row in rows if quick or row.edge == last), "growth": growth(rows, first, last, lambda run: run.mean),
            "newton_growth": growth(rows, first, last, lambda run: run.newton), "exponent": exponent(rows, first)}


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
    whats = (("Krylov iterations of a solve: mean, largest (-)", lambda row: row.run.mean), ("Newton iterations of a step (-)", lambda row: row.run.newton),
             ("set-up, assembly and solution (s)", lambda row: row.seconds))
    for ax, (label, what) in zip(axes, whats):
        for name in names:
            of = [row for row in rows if row.name == name]
            cell, state, *other = name.split(", ")
            look = dict(color=style.LINES[states.index(state)], linestyle=":" if other else "-" if cell == "hexahedra" else "--")
            x = [row.run.unknowns for row in of]
            ax.plot(x, [what(row) for row in of], label=name, marker="o", markersize=3.5, **look)
            if ax is axes[0]:
                ax.vlines(x, [row.run.mean for row in of], [row.run.most for row in of], color=look["color"], linewidth=0.8)
        ax.set(xscale="log", xlabel="displacement unknowns (-)", title=label)
    for ax in axes[:2]:
        ax.set_ylim(0, 1.05 * ax.get_ylim()[1])
    axes[2].set_yscale("log")
    slowest = max(rows, key=lambda row: row.seconds)
    x = np.array(axes[2].get_xlim())
    axes[2].plot(x, slowest.seconds * x / slowest.run.unknowns, ":", color=style.FAINT, label="proportional to unknowns", scalex=False, scaley=False)
    axes[2].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    figure.savefig(file, dpi=150)


def main(words):
    parser = linear.parser("krylov", __doc__)
    parser.add_argument("--largest", type=float, default=1.2e6, metavar="N", help="no mesh with more unknowns than this (1.2e6)")
    parser.add_argument("--against", choices=OTHERS, help="run each scene with this multigrid as well")
    options = parser.parse_args(words)
    series = {f"{cell}, {state}": (f"Mesh.cell={shape}", *sets) for cell, shape in (("hexahedra", "hexahedron"), ("tetrahedra", "tetrahedron"))
              for state, sets in STATES.items()}
    runs = [(edge, name) for edge in (QUICK if options.quick else EDGES) for name in series
            if (re.search(QUICK[edge], name) if options.quick else 3 * (edge + 1)**3 <= options.largest)]
    chosen = linear.matching(options, runs, lambda run: run[1])
    options.output.mkdir(parents=True, exist_ok=True)
    print_table, rows, failed = linear.Table(COLUMNS, 27 if options.against else 20), [], []
    for edge, name, other in [(*run, other) for run in chosen for other in ("", options.against) if other is not None]:
        run = linear.run(options, (*linear.cells(edge), *series[name], *OTHERS.get(other, ())), f"{name.replace(', ', '_')}_{edge}{other}")
        if run.failure:
            failed.append(f"failed: {name}, {edge}{other and ' with ' + other}: {run.failure}")
        if run.steps:
            rows.append(Row(name, edge, other, run))
            print_table.add(rows[-1].values(), failed[-1:] if run.failure else ())
    own = [row for row in rows if not row.other]
    if not own:
        sys.exit("\n".join(failed))
    print_table.write(options.output / "krylov.csv")
    draw(rows, options.output / "krylov.png")
    total = summary(own, options.quick)
    wrong = failed + (linear.missed(total, QUICK_BOUNDS) if options.quick else [])
    print("\n".join(["", *wrong, f"krylov.csv and krylov.png in {options.output}"]))
    if not options.quick:
        print("\n".join(linear.missed(total, BOUNDS)))
    print("max_krylov={max_krylov:.4g} growth={growth:.2f} newton_growth={newton_growth:.2f} exponent={exponent:.2f}".format(**total),
          *(f"{what}={ratio:.2f}" for what, ratio in (ratios(rows, options.against) if options.against else {}).items()))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
