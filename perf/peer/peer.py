"""Sprekk compared with PorePy and OpenGeoSys: seconds, memory and Newton iterations on the same meshes, and seconds for
the same error.

The environment variables POREPY and OGS name a checkout of PorePy and the program of OpenGeoSys. Parts that require a
missing one are left out."""
import glob
import json
import os
import re
import sys
from pathlib import Path

from perf.common import options as common
from perf.common import table
from perf.common.program import ROOT, Failed, checked
from perf.peer import damage, ours, runs
from perf.peer.ogs import ogs
from perf.peer.ours import meshes
from perf.peer.runs import FUNCTIONALS, THERMAL, Run

TILTED = ((0.25, 0.15), (0.22, 0.14), (0.125, 0.08), (0.09, 0.058))  # sizes of cells, and of those on the fracture
HEAT = ((23.0, 14.5), (13.5, 8.7), (9.4, 6.0))  # sizes for thm.xml
# Sprekk alone: arguments of ours.tilted_mesh
FINE = ((0.5, 0.1, 0.5), (0.4, 0.06, 0.5), (0.3, 0.04, 0.5), (0.25, 0.025, 0.5), (0.2, 0.015, 0.4))
CRACK = (0.1, 0.05, 0.025, 0.0125, 0.00625)      # PorePy: sizes on the crack
# relative errors requested from adaptive runs, beginning with the coarsest mesh
REQUESTS = {"tilted": (0.3, 0.1, 0.03), "crack": (0.03, 0.01, 0.003, 0.0005)}
# as `graded` of perf/verification, order 2
GRADED = ((1.2, 0.04), (0.9, 0.02), (0.6, 0.01), (0.39, 0.01), (0.18, 0.01))
FLOW = {"PorePy": (0.1, 0.05, 0.025, 0.0125), "Sprekk": (16, 32, 64, 128)}  # sizes of cells; cells along an edge
SIDES = (("west", "east"), ("south", "north"), ("bottom", "top"))
# manufactured poroelasticity: series of perf/verification, dimension and grid of PorePy, sizes of cells
PORO = (("quadrilateral", 2, "cartesian", {f"n={n}": 1 / n for n in (4, 8, 16, 32)}),
        ("triangle gmsh", 2, "simplex", {f"h={h}": h for h in (0.25, 0.125, 0.0625, 0.03125)}),
        ("hexahedron", 3, "cartesian", {f"n={n}": 1 / n for n in (4, 8, 12)}))
PARTS = ("contact", "heat", "flow", "damage", "poro", "ogs")
RATIOS = {"tilted": "ratio", "heat": "ratio_thm"}
QUICK = 2  # number of meshes of each
# 4, 11 thousand tetrahedra: the number made by gmsh depends on the machine
ASKED = {"ratio_4k": 100, "ratio_11k": 300, "ratio_thm_4k": 50, "ratio_equal_error": 50, **ogs.ASKED}
SLIP = "slip mean"
COSTS = {"cells": "d", "unknowns": "d", "Newton": "d", "CPU seconds": ".3f", "MB": ".0f"}
COLUMNS = {"mesh, code": "", **COSTS, **{name: ".4f" for name in FUNCTIONALS}}
OF_HEAT = {"mesh, code": "", **COSTS, **{name: ".4g" for name in THERMAL}}
ERRORS = {"error, code": "", **COSTS, "rel. error": ".2e"}
EQUAL = {"at equal error": "", "PorePy error": ".2e", "Sprekk error": ".2e", "PorePy CPU s": ".3f", "Sprekk CPU s": ".3f", "ratio": ".0f"}
OF_PORO = ("pressure", "flow", "u", "force")
WHY = """peer: no measurement: set POREPY to the folder of a checkout of PorePy, of November 2025 if possible:
  git clone https://github.com/pmgbergen/porepy && git -C porepy checkout 614c076c && POREPY=$PWD/porepy ./sprekk perf peer"""


def theirs(options, script, *words):
    """Runs a script with PorePy; returns its JSON output and a function values -> Run."""
    theirs = ROOT / "perf/peer/theirs"
    paths = [theirs / "compat", ROOT, f"{options.porepy}/src", options.porepy, *glob.glob("/usr/lib/petscdir/*/*-real/lib/python3/dist-packages")]
    one = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "PYTHONDONTWRITEBYTECODE")}
    environment = {**one, "PYTHONPATH": ":".join(map(str, paths)), "MPLBACKEND": "Agg", "PYTHONWARNINGS": "ignore",
                   "NUMBA_CACHE_DIR": str(options.output / "numba")}
    reported = json.loads(checked(["env", "-C", options.output, sys.executable, theirs / script, *words], **environment).strip().splitlines()[-1])
    return reported, lambda values: Run("PorePy", reported["cells"], reported["unknowns"], reported["solves"], reported["cpu_seconds"], reported["peak_bytes"], values)


def flat(functionals):
    """Components x and z of vectors; the mesh is almost symmetric in y."""
    found = {}
    for name, value in functionals.items():
        short = {"integral of traction": "traction", "mean jump": "jump"}.get(name, name)
        found |= {f"{short} {axis}": value[i] for i, axis in ((0, "x"), (2, "z"))} if isinstance(value, list) else {name: value}
    return {name: found[name] for name in FUNCTIONALS}


def named(source, target):
    """Writes PorePy's mesh with Sprekk's names for the fracture and the sides of the block, which has a corner at 0."""
    text = source.read_text()
    entities = text[text.index("$Entities"):text.index("$EndEntities")].splitlines()[1:]
    points, curves, surfaces, _ = map(int, entities[0].split())
    names = {"FRACTURE_0": "crack"}
    tags = dict((int(tag), name) for dim, tag, name in re.findall(r'^(\d) (\d+) "(.*)"$', text, re.M) if dim == "2")
    for line in entities[1 + points + curves:1 + points + curves + surfaces]:
        words = line.split()
        group = int(words[8]) if int(words[7]) else 0
        for low, high, sides in zip(map(float, words[1:4]), map(float, words[4:7]), SIDES):
            if low == high:
                names[tags[group]] = sides[low > 0]
    for old, new in names.items():
        text = text.replace(f'"{old}"', f'"{new}"')
    target.write_text(text)
    return target


def cells(run):
    return [run.cells, run.unknowns, run.newton, run.seconds, run.bytes / 1e6]


def compare_tilted(options, count):
    """Runs both programs on the meshes of PorePy; returns {series: [run]}."""
    printed, found = table.Table(COLUMNS, 26), {"PorePy": [], "Sprekk": [], "Sprekk, plain tips": []}
    for h, on_crack in TILTED[:count]:
        made = options.output / f"porepy_{h:g}.msh"
        reported, run = theirs(options, "tilted.py", h, on_crack, made.resolve())
        file = named(made, options.output / f"tilted_{h:g}.msh")
        found["PorePy"].append(run(flat(reported["functionals"])))
        found["Sprekk"].append(ours.tilted(options, file, f"tilted_{h:g}"))
        found["Sprekk, plain tips"].append(ours.tilted(options, file, f"plain_{h:g}", "Mesh file.tips=plain"))
        for code, of in found.items():
            printed.add([f"{of[-1].cells}, {code}", *cells(of[-1]), *(1e3 * of[-1].values[name] for name in FUNCTIONALS)])
    return found


def compare_heat(options, count):
    """Runs both programs on PorePy's meshes of the block with heat and flow; returns {series: [run]}."""
    printed, found = table.Table(OF_HEAT, 26), {"PorePy": [], "Sprekk": []}
    for h, on_crack in HEAT[:count]:
        made = options.output / f"porepy_thm_{h:g}.msh"
        reported, run = theirs(options, "thm.py", h, on_crack, made.resolve())
        found["PorePy"].append(run(reported["functionals"]))
        found["Sprekk"].append(ours.thm(options, named(made, options.output / f"thm_{h:g}.msh"), f"thm_{h:g}"))
        for code, of in found.items():
            printed.add([f"{of[-1].cells}, {code}", *cells(of[-1]), *(of[-1].values[name] for name in THERMAL)])
    return found


def compare_errors(options, same, count):
    """Runs for the errors of the mean slip and of the crack's jump.

    Returns {quantity: ([PorePy run], [Sprekk run], error)}, the same with adaptive runs of Sprekk, and the
    extrapolated mean slip."""
    printed, found = table.Table(ERRORS, 46), {}
    fine = [ours.tilted(options, ours.tilted_mesh(options.output / "meshes", *sizes), f"fine_{k}", "Mesh file.order=2")
            for k, sizes in enumerate(FINE[:count + 1])]
    exact = runs.limit(*fine[-2:], SLIP)
    found[SLIP] = (same["PorePy"], fine, lambda run: abs(run.values[SLIP] / exact - 1))
    coarse = ours.tilted_mesh(options.output / "meshes", 0.5, 0.25, 0.5)
    adaptive = {SLIP: [ours.tilted(options, coarse, f"adaptive_{asked:g}", *ours.to("slip", asked)) for asked in REQUESTS["tilted"][:count]]}
    for mode in ours.MODES:
        both = {"PorePy": [], "Sprekk": []}
        for h in CRACK[:count + 1]:
            reported, run = theirs(options, "crack.py", mode, h, (options.output / "porepy_crack.msh").resolve())
            both["PorePy"].append(run({mode: reported["error"], f"{mode}, tips left out": reported["error_away"]}))
        for k, (h, ratio) in enumerate(GRADED[:count + 1]):
            file = meshes.graded_crack(options.output / "meshes", h, ratio)
            both["Sprekk"].append(ours.crack(options, mode, file, f"{mode}_{k}", "Mesh file.order=2"))
        coarse = meshes.graded_crack(options.output / "meshes", *GRADED[0])
        goal = "slip" if mode == "sliding" else mode
        asked_for = [ours.crack(options, mode, coarse, f"{mode}_{asked:g}", *ours.to(goal, asked)) for asked in REQUESTS["crack"][:count + 1]]
        for what in both["PorePy"][0].values:
            adaptive[what] = asked_for
            found[what] = (both["PorePy"], both["Sprekk"], lambda run, what=what: run.values[what])
    for what, (their, our, error) in found.items():
        for run in their + our + adaptive[what]:
            printed.add([f"{what}, {run.code}", *cells(run), error(run)])
    return found, {what: (found[what][0], our, found[what][2]) for what, our in adaptive.items()}, exact


def compare_flow(options, count):
    """Runs for the error of the mean pressure in the regular network: each scheme of PorePy compared with one of
    Sprekk.

    Returns a dictionary as compare_errors(). The reference value is extrapolated from the last two meshes of
    Sprekk."""
    printed, found = table.Table(ERRORS, 46), {}
    for kind in ("conductive", "blocking"):
        for scheme, cell in (("mpfa", "triangle"), ("tpfa", "quadrilateral")):
            their, our = [], [ours.flow(options, kind, cell, n) for n in FLOW["Sprekk"][:count + 1]]
            for h in FLOW["PorePy"][:count + 1]:
                reported, run = theirs(options, "flow.py", kind, scheme, h, (options.output / "porepy_flow.msh").resolve())
                their.append(run({ours.MEAN: reported["mean"]}))
            coarse, fine = (run.values[ours.MEAN] for run in our[-2:])
            exact = fine + (fine - coarse) / 3
            what = f"{kind}, {scheme} and {'rt0' if cell == 'triangle' else 'tpfa'}"
            found[what] = (their, our, lambda run, exact=exact: abs(run.values[ours.MEAN] / exact - 1))
            for run in their + our:
                printed.add([f"{what}, {run.code}", *cells(run), found[what][2](run)])
    return found


def tell_apart(found):
    """Prints the differences between the programs; returns messages of too large differences."""
    apart, wrong = runs.apart(found["Sprekk"], found["PorePy"]), []
    printed = table.Table({"apart (distances from the limit)": "", **{name: ".2f" for name in apart[0]}}, 36)
    for run, of in zip(found["Sprekk"], apart):
        printed.add([f"{run.cells} cells", *of.values()])
        wrong += [f"apart: {name} on {run.cells} cells, {value:.2f} distances, {runs.WITHIN} are allowed" for name, value in of.items()
                  if not value <= runs.WITHIN]
    return wrong


def compare_poro(options, count):
    """Runs PorePy's manufactured poroelasticity and writes its errors, which bound those of perf/verification."""
    columns = {"cells": "d", "unknowns": "d", **{f"error of {name}": ".2e" for name in OF_PORO}, "seconds": ".2f"}
    printed = table.Table({"series, mesh": "", **columns}, 26)
    for series, dimension, grid, sizes in PORO:
        for mesh, size in list(sizes.items())[:count]:
            reported, run = theirs(options, "poro.py", dimension, grid, size)
            run = run(reported["errors"])
            printed.add([f"{series}, {mesh}", run.cells, run.unknowns, *(run.values[name] for name in OF_PORO), run.seconds])
    table.write(options.output / "porepy_poro.csv", ["series", "mesh", "cells", "unknowns", *OF_PORO, "seconds"],
                [[*row[0].split(", "), *row[1:]] for row in printed.rows])


def tell_equal(found):
    """Prints the times at equal error; returns the rows of the table, which end with the ratio, NaN if not reached."""
    printed = table.Table(EQUAL, 28)
    for what, (their, our, error) in found.items():
        best, good = runs.at_equal_error(our, their, error)
        printed.add([what, error(best), good and error(good), best.seconds, good and good.seconds, runs.ratio(best, good)])
    return printed.rows


def least_ratio(rows):
    return min((row[-1] for row in rows), key=lambda ratio: ratio if ratio == ratio else -1)


def draw(same, found, file):
    import style
    figure, axes = style.plt.subplots(1, 2, figsize=(9, 3.6))
    for (code, of), colour in zip(same.items(), style.LINES):
        axes[0].loglog([run.unknowns for run in of], [run.seconds for run in of], "o-", color=colour, markersize=4, label=code)
    axes[0].set(xlabel="unknowns (-)", title="the same meshes: time of the processor (s)")
    axes[0].legend()
    for colour, (what, (their, our, error)) in zip(style.LINES, found.items()):
        for of, line in ((their, "--"), (our, "-")):
            axes[1].loglog([run.seconds for run in of], [error(run) for run in of], f"o{line}", color=colour, markersize=4,
                           label=f"{what}, {of[0].code}")
    axes[1].set(xlabel="time of the processor (s)", title="relative error (-)")
    axes[1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    figure.savefig(file, dpi=150)


def write(options, both, found, equal):
    rows = [[case, code, *cells(run), name, value] for case, same in both.items() for code, of in same.items() for run in of
            for name, value in run.values.items()]
    rows += [[what, run.code, *cells(run), "relative error", error(run)] for what, (their, our, error) in found.items() for run in their + our]
    table.write(options.output / "peer.csv", ["case", "code", "cells", "unknowns", "Newton", "CPU seconds", "MB", "quantity", "value"], rows)
    if equal:
        table.write(options.output / "peer_equal.csv", ["quantity", *list(EQUAL)[1:]], equal)


def warm_up(options):
    """Runs two small cases so that numba compiles into its cache."""
    theirs(options, "crack.py", "opening", 0.5, (options.output / "porepy_crack.msh").resolve())
    theirs(options, "tilted.py", 0.5, 0.3, (options.output / "porepy_first.msh").resolve())


def meshes_of(options, all_of_them):
    return QUICK if options.quick else len(all_of_them)


def ratios(options, name, of):
    """Returns {name_4k: time of PorePy over time of Sprekk} for all meshes."""
    return {f"{name}_{their.cells}" if options.quick else f"{name}_{their.cells / 1e3:.0f}k": runs.ratio(their, our)
            for their, our in zip(of["PorePy"], of["Sprekk"])}


def available(options):
    """Selected parts whose programs are there; prints how to get missing ones."""
    parts = common.matching(options, PARTS)
    options.porepy, options.ogs = (os.environ.get(name) and Path(os.environ[name]).absolute() for name in ("POREPY", "OGS"))
    if options.porepy and not Path(options.porepy, "src/porepy").is_dir():
        raise Failed(f"POREPY = {options.porepy} holds no src/porepy")
    if options.ogs and not os.access(options.ogs, os.X_OK):
        raise Failed(f"OGS = {options.ogs} is no program")
    with_ogs = [part for part in parts if part == "ogs"]
    with_porepy = [part for part in parts if part != "ogs"]
    for needs, there, why in ((with_porepy, options.porepy, WHY), (with_ogs, options.ogs, ogs.WHY)):
        if needs and not there:
            print(why)
    return with_porepy * bool(options.porepy) + with_ogs * bool(options.ogs)


def main(words):
    options = common.parser("peer", __doc__).parse_args(words)
    parts = available(options)
    if not parts:
        return 0
    same, found, equal, total, wrong = {}, {}, [], {}, []
    if "ogs" in parts:
        total |= ogs.compare(options)
    if parts != ["ogs"]:
        warm_up(options)
    if "contact" in parts:
        print("values times 1000")
        same["tilted"] = compare_tilted(options, meshes_of(options, TILTED))
    if "heat" in parts:
        print("\nwith flow and heat")
        same["heat"] = compare_heat(options, meshes_of(options, HEAT))
    for case, of in same.items():
        total |= ratios(options, RATIOS[case], of)
        if not options.quick:
            print()
            wrong += tell_apart(of)
    if "contact" in parts:
        print()
        found, adaptive, exact = compare_errors(options, same["tilted"], meshes_of(options, FINE))
        print(f"\nmean slip without error: {exact:.4e}\n")
        equal = tell_equal(found)
        total["ratio_equal_error"] = least_ratio(equal)
        print("\nwith adaptive meshes")
        total["ratio_adaptive"] = least_ratio(tell_equal(adaptive))
        draw(same["tilted"], found, options.output / "peer.png")
    if "flow" in parts:
        print("\nmean pressure of the regular network")
        flow = compare_flow(options, meshes_of(options, FLOW["Sprekk"]))
        print()
        equal = [*equal, *tell_equal(flow)]
        found |= flow
    if "damage" in parts:
        print("\ndamage at a point: the largest differences over the largest values, and seconds of an iteration of PorePy")
        wrong += damage.compare(options, theirs)
    if "poro" in parts:
        print("\nmanufactured poroelasticity: errors of PorePy")
        compare_poro(options, meshes_of(options, PORO[0][-1]))
    if same or found:
        write(options, same, found, equal)
    missed = [f"missed: {name} = {total.get(name, float('nan')):.3g}, required: {asked}" for name, asked in ASKED.items()
              if not total.get(name, 0) >= asked and (name in total or not (options.only or name in ogs.ASKED))]
    print("\n".join(["", *wrong, *([] if options.quick else missed), f"tables and pictures in {options.output}"]))
    print(" ".join(f"{name}={value:{'.2f' if name in ogs.ASKED else '.0f'}}" for name, value in total.items() if options.quick or name in ASKED or name == "ratio_adaptive"))
    return 1 if wrong else 0
