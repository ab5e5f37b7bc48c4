"""Stress intensity factors: errors against exact solutions, and orders of convergence.

Each row is a run of a crack on a mesh. The error is that of K_I, K_II and K_III together, relative to their norm, the
largest of all tips. The order is that to the coarser mesh before. The last line gives the number of failures, the
largest errors of the finest meshes of order 2 and 1, and the smallest order of convergence of the plane cases with order
1."""
import math

from perf.common import options as common
from perf.common import program, scene_file, table
from perf.intensity import scenes
from perf.verification import meshes

COLUMNS = {"row": "", "cells": "d", "tips": "d", "computed K": ".4e", "exact value": ".4e", "error": ".2%", "of jump": ".2%", "order": ".2f", "seconds": ".1f"}
BOUNDS = {"failures": 0, "worst_intensity": 0.005, "worst_of_order_1": 0.02, "smallest_order": (1, 0.8)}
FORMATS = {"worst_intensity": ".4f", "worst_of_order_1": ".4f", "smallest_order": ".2f"}
PLATES = {"between rollers": (scenes.between_rollers, {1: (8, 16, 32), 2: (4, 8)}),
          "double cantilever beam": (scenes.double_cantilever, {1: (80, 160), 2: (40, 80)}),
          "edge crack": (scenes.edge_crack, {1: (16, 32), 2: (8, 16)}),
          "Williams' field": (scenes.williams, {1: (8, 16, 32), 2: (4, 8)})}

# Edges of the circular crack: largest, at the front, growth per length.
CIRCLE = {1: ((0.8, 0.1, 0.35), (0.6, 0.05, 0.25)), 2: ((1, 0.1, 0.5), (1, 0.05, 0.5))}


def intensities(run):
    """K of each tip from the integral and from the jump, [tip][mode]. A tip without is a failure of the run."""
    found = run.steps[-1]["stress_intensity"]
    modes = [name for name in ("K_I", "K_II", "K_III") if name in found]
    if any(K is None for name in modes for kind in ("", "_of_jump") for K in found[name + kind]):
        raise program.Failed("a tip has no stress intensity factor")
    return [list(zip(*(found[name + kind] for name in modes))) for kind in ("", "_of_jump")]


def error(tips, exact):
    """Largest error of |K_I|, |K_II| and |K_III| of tips, relative to the norm of the exact values."""
    exact = [*exact, 0, 0][:len(tips[0])]
    return max(math.dist(map(abs, tip), exact) for tip in tips) / math.hypot(*exact)


def plate_runs(options):
    """Yields (case, name, scene, entries, exact) of plates."""
    for case, (scene_of, levels) in PLATES.items():
        for order, densities in levels.items():
            for density in densities[:2] if options.quick else densities:
                scene, exact = scene_of(density, order)
                name = f"{case}, order {order}"
                file = options.output / f"{name} {density}.xml".replace(" ", "_").replace(",", "").replace("'", "")
                scene_file.save(scene, file, case)
                yield name, file, [], exact


def crack_runs(options):
    """Yields the runs of scenes in xml/verification: mode II with friction, a circular crack, mode III with friction."""
    K = 1e-3 * math.sqrt(math.pi)
    requested = "Fractures.crack.stress intensity=true"
    for order in (1, 2):
        for refinements in (0, 1):
            entries = [requested, f"Mesh file.order={order}", f"Mesh file.refinements={refinements}"]
            yield f"sliding with friction, order {order}", "verification/sneddon_shear.xml", entries, (0, K)
        for size in CIRCLE[order][:1 if options.quick else None]:
            try:
                mesh = meshes.penny(options.output, *size)
            except meshes.NoGmsh as reason:
                print(f"no circular crack: {reason}")
                break
            entries = [requested, f"Mesh file.order={order}", f"Mesh file.path={mesh}"]
            yield f"circular crack, order {order}", "verification/penny.xml", entries, (2e-3 / math.sqrt(math.pi),)
    for n in (16,) if options.quick else (16, 32):
        yield "tearing with friction, order 1", "verification/tearing_3d.xml", [requested, f"Mesh.cells={{{n}, 4, {n}}}"], (0, 0, K)


def main(words):
    options = common.parser("intensity", __doc__).parse_args(words)
    shown, failed, last = table.Table(COLUMNS, 36), [], {}
    for name, scene, entries, exact in common.matching(options, [*plate_runs(options), *crack_runs(options)], lambda run: run[0]):
        try:
            run = program.succeeded(options.binary, scene, options.output / "run", [*entries, "Output.vtu=false", *options.set])
            tips, of_jump = intensities(run)
        except program.Failed as reason:
            failed.append(f"failed: {name}: {reason}")
            print(failed[-1], flush=True)
            continue
        size, here = run.cells ** (-1 / run.results["mesh"]["dimension"]), error(tips, exact)
        coarser = last.get(name)
        order = math.log(coarser[1] / here) / math.log(coarser[0] / size) if coarser else None
        last[name] = (size, here, order)
        main_mode = max(range(len(exact)), key=lambda mode: abs(exact[mode]))
        shown.add([name, run.cells, len(tips), max((abs(tip[main_mode]) for tip in tips)), exact[main_mode], here, error(of_jump, exact), order, run.seconds])
    def worst(order):
        return max((one[1] for name, one in last.items() if name.endswith(order)), default=math.nan)
    values = {"failures": len(failed), "worst_intensity": worst("order 2"), "worst_of_order_1": worst("order 1"),
              "smallest_order": min((one[2] for name, one in last.items() if one[2] and name.endswith("order 1") and name.split(",")[0] in PLATES), default=math.nan)}
    bounds = {"failures": 0, "worst_intensity": 0.02, "worst_of_order_1": 0.08} if options.quick else BOUNDS
    return table.finish(options, shown, values, FORMATS, bounds, failed)
