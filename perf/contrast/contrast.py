"""Krylov iterations at extreme values: stiffness of rock and joints, friction, Poisson's ratio, shape of cells.

Every linear solve goes from zero to a relative residual of 1e-8."""
import re
from dataclasses import dataclass
from xml.etree import ElementTree

from perf.common import options as common
from perf.common import table
from perf.common.program import ROOT, STATES
from perf.krylov import linear

EDGE = 12         # cells along an edge of the box
TIME_LIMIT = 300  # seconds per run
BOUNDS = {"max_krylov": 40, "failures": 0}
FORMATS = {"max_krylov": ".4g", "max_used": ".4g"}
CELLS = {"hexahedra": "hexahedron", "tetrahedra": "tetrahedron"}
COLUMNS = {"cells, case": "", "unknowns": "d", **{state: ".2f" for state in STATES}, "Newton": ".4g", "cuts": "d", "solves": "d", "mean": ".1f",
           "max": ".4g", "used": ".4g", "lost": "d", "residual": ".0e", "seconds": ".1f"}
SOFT = linear.joint(stiffness=1) + ("Materials.crack.tangential stiffness=1",)
CLOSED = dict(xx=-0.01, yy=-0.01, zz=-0.01)
STICK = linear.table(**CLOSED, shear=0.002)
MIXED = linear.table(xx=-0.006, yy=-0.009, zz=-0.012, shear=0.03) + SOFT
SLIP = linear.table(**CLOSED, shear=0.06, xy=-0.06)  # box shortest along the diagonal: no block is pulled out
WEDGED = linear.table(**CLOSED, shear=0.06), linear.table(**CLOSED, shear=0.2)  # box longest along the diagonal
SIDES = ("west", "east", "south", "north", "bottom", "top")
UPRIGHT = {"bed1": ("1, 0, 0", "1, 6, 6"), "bed2": ("0, 5, 0", "6, 5, 6"), "inner z": ("5, 1, 1", "5, 5, 5")}


@dataclass
class Case:
    name: str
    sets: tuple
    beyond: bool = False  # outside the targets: counted in separate rows
    wedged: bool = False  # perhaps without a solution: counted separately
    quick: bool = False
    quick_cells: str = "tetrahedra"


def rocks(entry, value):
    return tuple(f"Materials.{rock}.{entry}={value}" for rock in ("rock", "other rock"))


def stretched(factor):
    """Entries that multiply all z by `factor`, the aspect ratio of cells or its inverse; strains are unchanged."""
    entries = []

    def visit(element, path):
        for child in element:
            here = (*path, child.get("name"))
            if child.tag == "ParameterList":
                visit(child, here)
            elif child.get("name") in ("lower corner", "upper corner"):
                x, y, z = (float(word) for word in child.get("value").strip("{}").split(","))
                entries.append(f"{'.'.join(here)}={{{x:g}, {y:g}, {z * factor:.15g}}}")
    visit(ElementTree.parse(ROOT / "xml" / linear.SCENE).getroot(), ())
    return tuple(entries)


def columns():
    """Entries that make all fractures vertical, and displacements of the sides that slide the columns between them
    past each other."""
    corners = [f"Mesh.fractures.{name}.{corner} corner={{{at}}}" for name, ends in UPRIGHT.items() for corner, at in zip(("lower", "upper"), ends)]
    slide = "{xx(t)*(x - 3), yy(t)*(y - 3), zz(t)*(z - 3) + xz(t)*(x - 3) + yz(t)*(y - 3)}"
    return (*linear.table(**CLOSED, shear=0.11, xy=0), *corners, *(f"Boundary conditions.{side}.displacement={slide}" for side in SIDES))


def found_no_state(run):
    """True if no state was found within the time limit, or at all. Other failures are not due to the scene."""
    return run.failure.startswith("no end within") or (bool(run.failure) and run.failure == run.results.get("reason"))


def lost(run):
    """Number of failed linear solves in abandoned attempts of Newton's method."""
    return sum(not solve["used"] and solve["residual"] > linear.ROUNDING * linear.RESIDUAL for solve in run.solves)


def contrast(ratio):
    return (f"Materials.other rock.Young's modulus={ratio}",)


def stiff(ratio):
    """Tangential stiffness of the joints, relative to E = 1 of the rock."""
    return linear.joint(stiffness=ratio)


def springs(ratio):
    """Normal and tangential stiffness. The closure limit is so large that the law is almost linear."""
    return linear.joint(normal=ratio, stiffness=ratio, closure=1)


def friction(ratio):
    return tuple(f"Materials.{joint}.friction coefficient={ratio}" for joint in ("joint", "crack"))


def cases():
    yield Case("as it is", MIXED, quick=True)
    for ratio in ("1e-6", "1e-3", "1e3", "1e6"):
        yield Case(f"E ratio {ratio}", MIXED + contrast(ratio), quick=ratio == "1e6")
    for ratio in ("1e-9", "1e-6", "1e-3", "1e3", "1e6", "1e9"):
        yield Case(f"K_t/E {ratio}", MIXED + stiff(ratio), quick=ratio == "1e-9")
        yield Case(f"K_n/E, K_t/E {ratio}", STICK + SOFT + springs(ratio), quick=ratio == "1e-6")
    for mu in (0, 0.3, 1):
        yield Case(f"friction {mu}", MIXED + friction(mu), quick=mu == 0)
    for mu in (0.1, 0.6, 1):
        yield Case(f"friction {mu}, all slips", SLIP + friction(mu))
    for nu in (0, 0.4, 0.45, 0.49, 0.499, 0.4999):
        yield Case(f"Poisson's ratio {nu}", MIXED + rocks("Poisson's ratio", nu), quick=nu in (0.45, 0.4999))
    for factor, text in ((3, "3"), (10, "10"), (30, "30"), (100, "100"), (1 / 3, "1/3"), (0.1, "1/10"), (1 / 30, "1/30"), (0.01, "1/100")):
        yield Case(f"aspect ratio {text}", STICK + SOFT + stretched(factor), quick=text in ("10", "1/10"),
                   quick_cells="hexahedra" if text == "1/10" else "tetrahedra")
    yield Case("aspect ratio 1/10, plain tips", STICK + SOFT + stretched(0.1) + ("Mesh.tips=plain",), quick=True, quick_cells="hexahedra")
    yield Case("E 1e6, K_t 1e-9", MIXED + contrast("1e6") + stiff("1e-9"))
    yield Case("E 1e-6, K_n and K_t 1e-9", STICK + SOFT + contrast("1e-6") + springs("1e-9"))
    yield Case("E 1e6, K_n and K_t 1e9", MIXED + contrast("1e6") + springs("1e9"))
    for factor, text in ((1000, "1000"), (0.001, "1/1000")):
        yield Case(f"aspect ratio {text}", STICK + SOFT + stretched(factor), beyond=True)
    yield Case("friction 2, columns slide", columns() + friction(2), beyond=True)
    for mu, table in zip((1, 2), WEDGED):
        yield Case(f"friction {mu}, wedged", table + friction(mu), beyond=True, wedged=True)


def draw(rows, file):
    """Draws mean to largest number of iterations of each case, with a mark for each cell shape."""
    import style
    names = list(dict.fromkeys((case.beyond, case.name) for case, *_ in rows))
    figure, ax = style.plt.subplots(figsize=(7, 0.8 + 0.165 * len(names)))
    for k, cell in enumerate(CELLS):
        of = [(names.index((case.beyond, case.name)), run) for case, kind, run in rows if kind == cell and run.krylov]
        height = [len(names) - at + 0.18 * (1 - 2 * k) for at, _ in of]
        ax.hlines(height, [run.mean for _, run in of], [run.maximum for _, run in of], color=style.LINES[k], linewidth=1)
        ax.plot([run.mean for _, run in of], height, "o", color=style.LINES[k], markersize=3.5, label=f"{cell}: mean, line to the largest")
        failed = [(run.maximum, h) for (_, run), h in zip(of, height) if run.failure]
        if failed:
            ax.plot(*zip(*failed), "x", color=style.INK, markersize=6, label=f"{cell}: failed")
    ax.axvline(BOUNDS["max_krylov"], color=style.FAINT, linestyle=":", label="required above the line")
    n_asked = sum(not beyond for beyond, _ in names)
    if 0 < n_asked < len(names):
        ax.axhline(len(names) - n_asked + 0.5, color=style.INK, linewidth=0.8)
    ax.set_yticks(range(len(names), 0, -1), [name for _, name in names], fontsize=7)
    ax.set(xscale="log", xlabel="Krylov iterations of a linear solve (-)", ylim=(0.3, len(names) + 0.7))
    ax.set_xticks([10, 20, 40, 100, 200, 500], ["10", "20", "40", "100", "200", "500"])
    ax.minorticks_off()
    ax.legend(loc="upper center", bbox_to_anchor=(0.4, -0.5 / (0.165 * len(names) + 0.8)), ncols=2)
    figure.savefig(file, dpi=150)


def main(words):
    options = common.parser("contrast", __doc__).parse_args(words)
    runs = [(case, cell) for case in cases() for cell in CELLS if not options.quick or (case.quick and cell == case.quick_cells)]
    chosen = common.matching(options, runs, lambda run: f"{run[1]}, {run[0].name}")
    printed, rows = table.Table(COLUMNS, 46), []
    for case, cell in chosen:
        sets = (*linear.cells(EDGE), f"Mesh.cell={CELLS[cell]}", *case.sets)
        run = linear.run(options, sets, re.sub(r"[^\w.+-]+", "_", f"{cell} {case.name}"), time_limit=TIME_LIMIT)
        rows.append((case, cell, run))
        name = f"{'beyond: ' if case.beyond else ''}{cell}, {case.name}"
        printed.add([name, run.unknowns, *run.fractions, run.mean_newton, run.cuts, len(run.krylov), run.mean, run.maximum,
                     run.max_used, lost(run), run.residual, run.total_time], [f"failed: {run.failure}"] if run.failure else ())
    draw(rows, options.output / "contrast.png")
    within = [run for case, _, run in rows if not case.beyond]
    unsolved = sum(case.wedged and found_no_state(run) for case, _, run in rows)
    total = {"max_krylov": max((run.maximum for run in within), default=0), "failures": sum(bool(run.failure) for *_, run in rows) - unsolved,
             "max_used": max((run.max_used for run in within), default=0), "lost": sum(lost(run) for *_, run in rows), "unsolved": unsolved}
    return table.finish(options, printed, total, FORMATS, BOUNDS) or int(total["failures"] > 0)
