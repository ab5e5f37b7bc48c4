"""Errors against exact solutions, unknowns and seconds: runs cases on several meshes each, prints a table and draws the errors.

The last line of each case summarises it. README.md in this folder describes the columns."""
import math
import re
from collections import Counter
from dataclasses import dataclass, field

import style

from perf.common import options as common
from perf.common import table
from perf.common.program import Failed
from perf.verification import cases, flow_cases, heat_cases, measure, meshes, poro_cases, poro_fractures, scenes

CASES = cases.CASES + flow_cases.CASES + poro_cases.CASES + poro_fractures.CASES + heat_cases.CASES
ESTIMATES = ("jump", "stress")
ESTIMATE = ("Output.error estimate=true",)
WITHIN = 2  # allowed factor between estimated and true error
SLACK = 0.15  # allowed shortfall of an observed order, because meshes are not in the asymptotic range


@dataclass
class Row:
    """Results of one run."""
    series: str
    mesh: str
    cells: int
    unknowns: int
    errors: dict
    effectivity: dict  # estimated over true error
    newton: int
    krylov: int
    seconds: float
    # from the previous mesh, with h ~ cells^(-1/d); for equal meshes from the number of steps
    orders: dict = field(default_factory=dict)
    steps: int = 1


def run(options, case, series, label, source):
    folder = options.output / case.name
    entries = source(options.output / "meshes") if callable(source) else source
    directory = folder / re.sub(r"[^\w.+-]+", "_", f"{series.name} {label}")
    done = measure.start(options.binary, scenes.path(series.scene or case.scene, options.output / "scenes"), (*(ESTIMATE if case.jumps else ()), *series.sets, *entries), directory, options.ranks)
    steps = done.results["steps"]
    exact = series.exact or case.exact
    errors, effectivity = case.errors(done, exact), measure.effectivity(done, case.jumps(done, exact), exact) if case.jumps else {}
    newton, krylov = (sum(step[f"{name}_iterations"] for step in steps) for name in ("newton", "linear"))
    return Row(series.name, label, done.results["mesh"]["cells"], done.unknowns(series.prescribed or case.prescribed), errors, effectivity,
               newton, krylov, done.seconds, steps=len(steps)), done.dimension


def add_orders(row, before, dimension):
    finer = math.log(row.cells / before.cells) / dimension if row.cells != before.cells else math.log(row.steps / before.steps)
    if finer == 0:
        return
    row.orders = {name: math.log(before.errors[name] / error) / finer for name, error in row.errors.items() if error > 0 and before.errors[name] > 0}


def header(names, estimates):
    return f"{'series, mesh':34}{'cells':>8}{'unknowns':>10}" + "".join(f"{name:>13}{'order':>7}" for name in names) + "".join(f"{f'{name} est.':>12}" for name in estimates) + f"{'Newton':>8}{'Krylov':>8}{'seconds':>9}"


def line(row, names, estimates):
    words = f"{row.series + ', ' + row.mesh:34}{row.cells:>8}{row.unknowns:>10}"
    for name in names:
        order = row.orders.get(name)
        words += f"{row.errors[name]:>13.2e}{'' if order is None else format(order, '.2f'):>7}" if name in row.errors else f"{'':20}"
    words += "".join(f"{row.effectivity[name]:>12.2f}" if name in row.effectivity else f"{'-':>12}" for name in estimates)
    return words + f"{row.newton:>8}{row.krylov:>8}{row.seconds:>9.2f}"


def missed(case, rows, quick):
    """Returns messages of violated bounds and the number of checked bounds. Bounds on meshes without a run are
    skipped."""
    wrong, judged = [], 0
    for bound in case.bounds:
        if isinstance(bound, cases.Bound):
            of = [row for row in rows if (row.series, row.mesh) == (bound.series, bound.mesh)]
            wrong += [f"{row.series}, {row.mesh}: {bound.error} {row.errors[bound.error]:.2e}, the bound is {bound.maximum:g}"
                      for row in of if not row.errors[bound.error] <= bound.maximum]
            wrong += [f"{row.series}, {row.mesh}: {row.unknowns} unknowns, the bound is {bound.unknowns:g}"
                      for row in of if row.unknowns > bound.unknowns]
        else:
            last = {row.series: row for row in rows if bound.series in row.series and bound.error in row.orders}
            of = [row for row in last.values()]
            wrong += [f"{row.series}, {row.mesh}: order of {bound.error} {row.orders[bound.error]:.2f}, the bound is {bound.minimum:g}"
                      for row in of if not row.orders[bound.error] >= bound.minimum - SLACK * (2 if quick else 1)]
        judged += len(of)
    for row in rows:
        sure = [name for name in row.effectivity if (row.series, row.mesh, name) not in case.unsure]
        wrong += [f"{row.series}, {row.mesh}: the estimate of the {name} is {row.effectivity[name]:.2f} of its error"
                  for name in sure if not 1 / WITHIN <= row.effectivity[name] <= WITHIN]
        judged += len(sure)
    return wrong, judged


def last_line(case, rows):
    """Summary "CASE order_u=.. order_traction=.. error=.. unknowns=.." of the mesh in `headline`, or of the last
    run of its series.

    For flow, the orders are those of pressure and velocity."""
    series, mesh, error = case.headline
    of = [row for row in rows if row.series == series]
    row = next((row for row in of if row.mesh == mesh), of[-1] if of else None)
    orders = [format(row.orders[name], ".2f") if row and name in row.orders else "-" for name in case.orders]
    words = " ".join(f"order_{name}={order}" for name, order in zip(case.called, orders))
    return f"{case.name} {words} " + (f"error={row.errors[error]:.2e} unknowns={row.unknowns}" if row else "error=- unknowns=-")


def effectivities(case, rows):
    """Summary "CASE jump_estimate=MINIMUM..MAXIMUM stress_estimate=..": ratios of estimated to true errors over all runs."""
    words = case.name
    for name in ESTIMATES:
        all_of = [row.effectivity[name] for row in rows if name in row.effectivity]
        words += f" {name}_estimate=" + (f"{min(all_of):.2f}..{max(all_of):.2f}" if all_of else "-")
    return words


def looks(series):
    """Line styles by series: colour by the first word, dashed for order 1, marker by the words between."""
    parts = [name.split() for name in series]
    first, middle = (list(dict.fromkeys(of)) for of in ([p[0] for p in parts], [" ".join(p[1:-1]) for p in parts]))
    return {name: dict(color=style.LINES[first.index(p[0]) % len(style.LINES)], linestyle="--" if p[-1] == "1" else "-",
                       marker="osD^vP"[middle.index(" ".join(p[1:-1])) % 6]) for name, p in zip(series, parts)}


def draw(case, rows, file):
    """Draws the error of the last line against unknowns and seconds, with a line for each series."""
    error, look = case.headline[2], looks(list(dict.fromkeys(row.series for row in rows)))
    figure, both = style.plt.subplots(1, 2, figsize=(8.6, 3.6), sharey=True)
    for axes, quantity in zip(both, ("unknowns", "seconds")):
        for name, how in look.items():
            of = [row for row in rows if row.series == name]
            axes.loglog([getattr(row, quantity) for row in of], [row.errors[error] for row in of], label=name, markersize=4, **how)
        for label, unknowns, errors in case.points if quantity == "unknowns" else []:
            axes.loglog(unknowns, errors, "*:", color=style.FAINT, label=label, markersize=7)
        axes.set_xlabel({"unknowns": "unknowns (-)", "seconds": "assembly and solution (s)"}[quantity])
        axes.grid(True, which="minor", linewidth=0.3)
    both[0].set_ylabel(f"relative error: {error} (-)")
    both[1].legend(*both[0].get_legend_handles_labels(), loc="center left", bbox_to_anchor=(1.02, 0.5))
    figure.suptitle(case.title)
    figure.savefig(file, dpi=130)
    style.plt.close(figure)


def measured(options, case):
    """Runs and prints a case; returns its rows and messages of failed runs."""
    rows, wrong, estimates = [], [], ESTIMATES if case.jumps else ()
    chosen = [(one, one.meshes[:one.quick] if options.quick else one.meshes) for one in case.series]
    names = None
    for series, grids in chosen:
        before = None
        for label, source in grids:
            try:
                row, dimension = run(options, case, series, label, source)
            except Failed as error:
                wrong.append(f"{series.name}, {label}: {error}")
                continue
            if before:
                add_orders(row, before, series.dimension or dimension)
            if names is None:
                names = list(row.errors)
                print(header(names, estimates))
            rows.append(row)
            before = row
            print(line(row, names, estimates), flush=True)
    return rows, wrong


def write(rows, file):
    names = list(dict.fromkeys(name for row in rows for name in row.errors))
    table.write(file, ["series", "mesh", "cells", "unknowns", *names, *[f"order of {name}" for name in names], *[f"{name} estimate" for name in ESTIMATES], "newton", "krylov", "seconds"],
                [[row.series, row.mesh, row.cells, row.unknowns, *[row.errors.get(n) for n in names],
                  *[row.orders.get(n) for n in names],
                  *[row.effectivity.get(n) for n in ESTIMATES], row.newton, row.krylov, row.seconds] for row in rows])


def arguments(words):
    names = [make.__name__ for make in CASES]
    groups = [word for word, n in Counter(name.split("_")[0] for name in names).items() if n > 1 and word not in names]
    parser = common.parser("verification", __doc__, "coarse meshes only, for a test", only=None, sets=False)
    parser.add_argument("--only", metavar="CASE", action="append", choices=names + groups,
                        help=f"one of {', '.join(names)}, or the common beginning of several ({', '.join(groups)}); may be repeated")
    parser.add_argument("--no-pictures", dest="pictures", action="store_false", help="tables only")
    parser.add_argument("--ranks", type=int, default=1, metavar="N", help="run on N ranks")
    return parser.parse_args(words)


def main(words):
    options = arguments(words)
    above, lines = [], []
    for make in CASES:
        if options.only and not {make.__name__, make.__name__.split("_")[0]} & set(options.only):
            continue
        case = make()
        print(f"{case.name}: {case.title}")
        try:
            rows, wrong = measured(options, case)
        except meshes.NoGmsh as reason:
            print(f"skipped: {reason}\n")
            continue
        more, judged = missed(case, rows, options.quick)
        wrong += more
        if rows:
            write(rows, options.output / f"{case.name}.csv")
            if options.pictures:
                draw(case, rows, options.output / f"{case.name}.png")
            if options.pictures and case.picture:
                case.picture(options.output / f"{case.name}_lines.png")
        print("\n".join([f"  missed: {what}" for what in wrong] + [f"  {judged} bounds checked"]))
        if case.jumps:
            print(effectivities(case, rows))
        print(last_line(case, rows) + "\n", flush=True)
        above += wrong
    return 1 if above else 0
