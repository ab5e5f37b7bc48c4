#!/usr/bin/env python3
"""Sprekk beside PorePy: seconds, memory and Newton iterations on the same meshes, and seconds for the same error.

The environment variable POREPY names a checkout of PorePy; without it nothing is measured."""
import csv
import glob
import json
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "krylov"))

import damage  # noqa: E402
import linear  # noqa: E402
import ours  # noqa: E402
import runs  # noqa: E402
from ours import meshes  # noqa: E402
from runs import FUNCTIONALS, Run  # noqa: E402

TILTED = ((0.25, 0.15), (0.22, 0.14), (0.125, 0.08), (0.09, 0.058))  # sizes of cells, those on the fracture
FINE = ((0.5, 0.1, 0.5), (0.4, 0.06, 0.5), (0.3, 0.04, 0.5), (0.25, 0.025, 0.5), (0.2, 0.015, 0.4))  # ours alone: meshes of ours.tilted_mesh
CRACK = (0.1, 0.05, 0.025, 0.0125, 0.00625)      # sizes on the crack, theirs
GRADED = ((1.2, 0.04), (0.9, 0.02), (0.6, 0.01), (0.39, 0.01), (0.18, 0.01))  # as `graded` of perf/verification, order 2
FLOW = {"PorePy": (0.1, 0.05, 0.025, 0.0125), "Sprekk": (16, 32, 64, 128)}  # sizes of cells; cells along an edge
QUICK = 2  # meshes of each
ASKED = {"ratio_4k": 100, "ratio_11k": 300, "ratio_equal_error": 50}  # 4, 11 thousand tetrahedra: how many gmsh makes depends on the machine
SLIP = "slip mean"
COLUMNS = {"mesh, code": "", "cells": "d", "unknowns": "d", "Newton": "d", "CPU seconds": ".3f", "MB": ".0f", **{name: ".4f" for name in FUNCTIONALS}}
ERRORS = {"error, code": "", "cells": "d", "unknowns": "d", "Newton": "d", "CPU seconds": ".3f", "MB": ".0f", "rel. error": ".2e"}
WHY = """peer: nothing to compare with: POREPY is to name a checkout of PorePy, of November 2025 if possible:
  git clone https://github.com/pmgbergen/porepy && git -C porepy checkout 614c076c && POREPY=$PWD/porepy ./sprekk perf peer"""


def theirs(options, script, *words):
    """What a run of PorePy tells."""
    paths = [HERE / "theirs/compat", f"{options.porepy}/src", *glob.glob("/usr/lib/petscdir/*/*-real/lib/python3/dist-packages")]
    one = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "PYTHONDONTWRITEBYTECODE")}
    environment = {**os.environ, **one, "PYTHONPATH": ":".join(map(str, paths)), "MPLBACKEND": "Agg", "PYTHONWARNINGS": "ignore",
                   "NUMBA_CACHE_DIR": str((options.output / "numba").resolve())}
    done = subprocess.run([sys.executable, HERE / "theirs" / script, *map(str, words)], capture_output=True, text=True, env=environment,
                          stdin=subprocess.DEVNULL, cwd=options.output)
    if done.returncode:
        sys.exit(f"peer: {script}: {(done.stderr.strip().splitlines() or ['no word'])[-1]}")
    told = json.loads(done.stdout.strip().splitlines()[-1])
    return told, lambda values: Run("PorePy", told["cells"], told["unknowns"], told["solves"], told["cpu_seconds"], told["peak_bytes"], values)


def flat(functionals):
    """Components x and z of vectors: the mesh is as good as symmetric in y."""
    found = {}
    for name, value in functionals.items():
        short = {"integral of traction": "traction", "mean jump": "jump"}.get(name, name)
        found |= {f"{short} {axis}": value[i] for i, axis in ((0, "x"), (2, "z"))} if isinstance(value, list) else {name: value}
    return {name: found[name] for name in FUNCTIONALS}


def named(source, target):
    """The mesh that PorePy made, with names of ours for the fracture and for the sides z = 0 and z = 1."""
    text = source.read_text()
    entities = text[text.index("$Entities"):text.index("$EndEntities")].splitlines()[1:]
    points, curves, surfaces, _ = map(int, entities[0].split())
    names = {"FRACTURE_0": "crack"}
    tags = dict((int(tag), name) for dim, tag, name in re.findall(r'^(\d) (\d+) "(.*)"$', text, re.M) if dim == "2")
    for line in entities[1 + points + curves:1 + points + curves + surfaces]:
        words = line.split()
        low, high, group = float(words[3]), float(words[6]), int(words[8]) if int(words[7]) else 0
        if low == high and low in (0, 1):
            names[tags[group]] = "top" if low else "bottom"
    for old, new in names.items():
        text = text.replace(f'"{old}"', f'"{new}"')
    target.write_text(text)
    return target


def cells(run):
    return [run.cells, run.unknowns, run.newton, run.seconds, run.bytes / 1e6]


def compare_tilted(options, count):
    """{series: [run]} on the meshes of PorePy."""
    table, found = linear.Table(COLUMNS, 26), {"PorePy": [], "Sprekk": [], "Sprekk, plain tips": []}
    for h, on_crack in TILTED[:count]:
        made = options.output / f"porepy_{h:g}.msh"
        told, run = theirs(options, "tilted.py", h, on_crack, made.resolve())
        file = named(made, options.output / f"tilted_{h:g}.msh")
        found["PorePy"].append(run(flat(told["functionals"])))
        found["Sprekk"].append(ours.tilted(options, file, f"tilted_{h:g}"))
        found["Sprekk, plain tips"].append(ours.tilted(options, file, f"plain_{h:g}", "Mesh file.tips=plain"))
        for code, of in found.items():
            table.add([f"{of[-1].cells}, {code}", *cells(of[-1]), *(1e3 * of[-1].values[name] for name in FUNCTIONALS)])
    return table, found


def compare_errors(options, same, count):
    """{what: ([their run], [our run], error)}: of the mean slip, and of the jump of the crack."""
    table, found = linear.Table(ERRORS, 46), {}
    fine = [ours.tilted(options, ours.tilted_mesh(options.output / "meshes", *sizes), f"fine_{k}", "Mesh file.order=2")
            for k, sizes in enumerate(FINE[:count + 1])]
    exact = runs.limit(*fine[-2:], SLIP)
    found[SLIP] = (same["PorePy"], fine, lambda run: abs(run.values[SLIP] / exact - 1))
    for mode in ours.MODES:
        both = {"PorePy": [], "Sprekk": []}
        for h in CRACK[:count + 1]:
            told, run = theirs(options, "crack.py", mode, h, (options.output / "porepy_crack.msh").resolve())
            both["PorePy"].append(run({mode: told["error"], f"{mode}, tips left out": told["error_away"]}))
        for k, (h, ratio) in enumerate(GRADED[:count + 1]):
            file = meshes.graded_crack(options.output / "meshes", h, ratio)
            both["Sprekk"].append(ours.crack(options, mode, file, f"{mode}_{k}", "Mesh file.order=2"))
        for what in both["PorePy"][0].values:
            found[what] = (both["PorePy"], both["Sprekk"], lambda run, what=what: run.values[what])
    for what, (their, our, error) in found.items():
        for run in their + our:
            table.add([f"{what}, {run.code}", *cells(run), error(run)])
    return table, found, exact


def compare_flow(options, count):
    """As compare_errors(): of the mean pressure of the regular network, each scheme of theirs beside one of ours. The value without
    error is extrapolated from the last two meshes of Sprekk."""
    table, found = linear.Table(ERRORS, 46), {}
    for kind in ("conductive", "blocking"):
        for scheme, cell in (("mpfa", "triangle"), ("tpfa", "quadrilateral")):
            their, our = [], [ours.flow(options, kind, cell, n) for n in FLOW["Sprekk"][:count + 1]]
            for h in FLOW["PorePy"][:count + 1]:
                told, run = theirs(options, "flow.py", kind, scheme, h, (options.output / "porepy_flow.msh").resolve())
                their.append(run({ours.MEAN: told["mean"]}))
            coarse, fine = (run.values[ours.MEAN] for run in our[-2:])
            exact = fine + (fine - coarse) / 3
            what = f"{kind}, {scheme} beside {'rt0' if cell == 'triangle' else 'tpfa'}"
            found[what] = (their, our, lambda run, exact=exact: abs(run.values[ours.MEAN] / exact - 1))
            for run in their + our:
                table.add([f"{what}, {run.code}", *cells(run), found[what][2](run)])
    return found


def tell_apart(found):
    """Prints how far the programs are apart; what is further than it may be, in words."""
    apart, wrong = runs.apart(found["Sprekk"], found["PorePy"]), []
    table = linear.Table({"apart (distances from the limit)": "", **{name: ".2f" for name in FUNCTIONALS}}, 36)
    for run, of in zip(found["Sprekk"], apart):
        table.add([f"{run.cells} cells", *of.values()])
        wrong += [f"apart: {name} on {run.cells} cells, {value:.2f} distances, {runs.WITHIN} are allowed" for name, value in of.items()
                  if not value <= runs.WITHIN]
    return wrong


def tell_equal(found):
    """Prints seconds at equal error; the smallest ratio."""
    table, ratios = linear.Table({"at equal error": "", "their error": ".2e", "our error": ".2e", "their CPU seconds": ".3f", "our CPU seconds": ".3f", "ratio": ".0f"}, 28), []
    for what, (their, our, error) in found.items():
        best, good = runs.at_equal_error(our, their, error)
        ratios.append(runs.ratio(best, good))
        table.add([what, error(best), good and error(good), best.seconds, good and good.seconds, ratios[-1] if good else None])
    return min(ratios, key=lambda ratio: ratio if ratio == ratio else -1)


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


def write(file, same, found):
    with open(file, "w", newline="") as opened:
        writer = csv.writer(opened)
        writer.writerow(["case", "code", "cells", "unknowns", "Newton", "CPU seconds", "MB", "quantity", "value"])
        for code, of in same.items():
            writer.writerows(["tilted", code, *cells(run), name, value] for run in of for name, value in run.values.items())
        for what, (their, our, error) in found.items():
            writer.writerows([what, run.code, *cells(run), "relative error", error(run)] for run in their + our)


def main(words):
    parser = linear.parser("peer", __doc__, only=False)
    options = parser.parse_args(words)
    options.porepy = os.environ.get("POREPY") and Path(os.environ["POREPY"]).resolve()
    if not options.porepy:
        print(WHY)
        return 0
    if not Path(options.porepy, "src/porepy").is_dir():
        sys.exit(f"peer: POREPY = {options.porepy} holds no src/porepy")
    options.output.mkdir(parents=True, exist_ok=True)
    theirs(options, "crack.py", "opening", 0.5, (options.output / "porepy_crack.msh").resolve())  # numba compiles into its cache
    theirs(options, "tilted.py", 0.5, 0.3, (options.output / "porepy_first.msh").resolve())
    print("values times 1000")
    _, same = compare_tilted(options, QUICK if options.quick else len(TILTED))
    print()
    wrong = []
    if not options.quick:
        wrong = tell_apart(same)
        print()
    _, found, exact = compare_errors(options, same, QUICK if options.quick else len(FINE))
    print(f"\nmean slip without error: {exact:.4e}\n")
    total = {f"ratio_{their.cells}" if options.quick else f"ratio_{their.cells / 1e3:.0f}k": runs.ratio(their, our) for their, our in zip(same["PorePy"], same["Sprekk"])}
    total["ratio_equal_error"] = tell_equal(found)
    print("\nmean pressure of the regular network")
    flow = compare_flow(options, QUICK if options.quick else len(FLOW["Sprekk"]))
    print()
    tell_equal(flow)
    print("\ndamage at a point: the largest differences over the largest values, and seconds of an iteration of PorePy")
    wrong += damage.compare(options, theirs)
    write(options.output / "peer.csv", same, {**found, **flow})
    draw(same, found, options.output / "peer.png")
    missed = [f"missed: {name} = {total.get(name, float('nan')):.0f}, asked are {asked}" for name, asked in ASKED.items()
              if not total.get(name, 0) >= asked]
    print("\n".join(["", *wrong, *([] if options.quick else missed), f"peer.csv and peer.png in {options.output}"]))
    last = {name: value for name, value in total.items() if options.quick or name in ASKED}
    print(" ".join(f"{name}={value:.0f}" for name, value in last.items()))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
