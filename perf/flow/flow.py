"""Krylov iterations of the pressure from ten thousand to a million cells: rock with fractures that cross, and extremes of permeability.

Every linear solve goes from zero to a relative residual of 1e-8."""
import re
from dataclasses import dataclass

import numpy as np

from perf.common import options as common
from perf.common import table
from perf.common.program import Run
from perf.krylov import linear

MESHES = {  # shape: scene, cells along an edge for about 1e4, 1e5 and 1e6 cells
    "triangles": ("flow_2d", "triangle", (72, 222, 708)), "quadrilaterals": ("flow_2d", "quadrilateral", (102, 318, 1002)),
    "tetrahedra": ("flow_3d", "tetrahedron", (12, 24, 54)), "hexahedra": ("flow_3d", "hexahedron", (24, 48, 102))}
NETWORKS = {"traces": "flow_traces", "discs": "flow_discs"}  # meshes of gmsh with flat cells
STEADY = ("Time.maximum halvings=0",)  # shorter steps have no effect
BOUNDS = {"krylov_max": 30, "krylov_growth": 0.3, "failures": 0, "exponent": 1.1}
FORMATS = {"krylov_max": ".4g", "krylov_growth": ".2f", "exponent": ".2f"}
COLUMNS = {"cells, case": "", "cells": "d", "unknowns": "d", "solves": "d", "first": "d", "iterations": "d", "residual": ".0e",
           "set-up s": ".2f", "assembly s": ".2f", "solve s": ".2f", "kB/cell": ".1f"}


def joints(tangential, normal=None, which=("joint", "other joint")):
    """Permeability of fractures relative to the rock; without a normal one they do not resist flow across them."""
    given = {"tangential": tangential, **({} if normal is None else {"normal": normal})}
    return tuple(f"Materials.{joint}.{name} permeability={value:g}" for joint in which for name, value in given.items())


def anisotropic(d):
    """Permeability 100 along the first axis, rotated by 30 degrees in the x-y plane, and 1 in the other directions."""
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    xx, yy, xy = 99 * c * c + 1, 99 * s * s + 1, 99 * c * s
    value = ", ".join(f"{k:.17g}" for k in ((xx, yy, xy) if d == 2 else (xx, yy, 1, xy, 0, 0)))
    return tuple(f"Materials.{rock}.permeability={{{value}}}" for rock in ("rock", "other rock"))


def rocks(contrast):
    return (f"Materials.other rock.permeability={{{contrast:g}}}",)


CASES = {  # functions of the dimension that return entries
    "alike": lambda d: joints(1),
    "open 1e5": lambda d: joints(1e5),
    "open 1e10": lambda d: joints(1e10),
    "tight 1e-5": lambda d: joints(1e-5, 1e-5),
    "tight 1e-10": lambda d: joints(1e-10, 1e-10),
    "open 1e10, tight 1e-10": lambda d: (*joints(1e10, 1e10, ("joint",)), *joints(1e-10, 1e-10, ("other joint",))),
    "rocks 1e-5": lambda d: rocks(1e-5),
    "rocks 1e-10": lambda d: rocks(1e-10),
    "rocks 1e10": lambda d: rocks(1e10),
    "anisotropy 100": anisotropic,
    "all": lambda d: (*anisotropic(d)[:1], *rocks(1e-5), *joints(1e10, 1e10, ("joint",)), *joints(1e-10, 1e-10, ("other joint",))),
}

NETWORK_CASES = {"cubic law": (), "tight across": ("Materials.joint.normal permeability=1e-26",)}


@dataclass
class Row:
    mesh: str
    case: str
    level: int
    run: Run

    @property
    def series(self):
        return f"{self.mesh}, {self.case}"

    def values(self):
        run = self.run
        return [self.series, run.cells, run.system, len(run.krylov), int(run.krylov[0]), int(run.maximum), first_residual(run), *run.times,
                run.bytes[0] / 1e3 / max(1, run.cells)]


def first_residual(run):
    """Residual of the pressure solve; the later solves correct round-off."""
    return next((solve["residual"] for step in run.steps for solve in step["linear_solves"]), None)


def summary(rows):
    return {"krylov_max": max(row.run.maximum for row in rows), "krylov_growth": table.growth([(row.series, row.level, row.run.maximum) for row in rows]),
            "failures": sum(bool(row.run.failure) for row in rows),
            "exponent": table.exponent([(row.series, row.run.cells, row.run.total_time) for row in rows])}


def draw(rows, file):
    """Draws iterations and seconds against cells: a colour for each cell shape, a line for each case."""
    import style
    figure, both = style.plt.subplots(1, 2, figsize=(8, 3.4))
    for axes, (label, what) in zip(both, (("Krylov iterations (-)", lambda row: row.run.maximum), ("set-up, assembly and solution (s)", lambda row: row.run.total_time))):
        for colour, mesh in zip(style.LINES, MESHES):
            of_mesh = [row for row in rows if row.mesh == mesh]
            for k, case in enumerate(dict.fromkeys(row.case for row in of_mesh)):
                of = [row for row in of_mesh if row.case == case]
                axes.plot([row.run.cells for row in of], [what(row) for row in of], color=colour, marker=".", linewidth=0.8, label=None if k else mesh)
        axes.set(xscale="log", xlabel="cells (-)", title=label)
    both[0].set_ylim(0, None)
    both[1].set_yscale("log")
    both[0].legend()
    figure.savefig(file, dpi=150)


def network(mesh, case):
    """Scene, entries and size."""
    return NETWORKS[mesh], NETWORK_CASES[case], "gmsh"


def box(mesh, case, level):
    """Scene, entries and size: cells along an edge."""
    scene, shape, counts = MESHES[mesh]
    d = 2 if scene == "flow_2d" else 3
    return scene, (f"Mesh.cell={shape}", f"Mesh.cells={{{', '.join([str(counts[level])] * d)}}}", *CASES[case](d)), counts[level]


def main(words):
    parser = common.parser("flow", __doc__)
    parser.add_argument("--largest", type=float, default=1.1e6, metavar="N", help="no mesh with more cells than this (1.1e6)")
    options = parser.parse_args(words)
    per_cell = {"triangles": (2, 2), "quadrilaterals": (1, 2), "tetrahedra": (6, 3), "hexahedra": (1, 3)}
    runs = [(network, case, 0) for network in NETWORKS for case in NETWORK_CASES]
    runs += [(mesh, case, level) for level in range(1 if options.quick else 3) for mesh in MESHES for case in CASES
             if per_cell[mesh][0] * MESHES[mesh][2][level]**per_cell[mesh][1] <= options.largest]
    rows = table.Series(COLUMNS, 40)
    for mesh, case, level in common.matching(options, runs, lambda run: f"{run[0]}, {run[1]}"):
        scene, sets, size = network(mesh, case) if mesh in NETWORKS else box(mesh, case, level)
        run = linear.run(options, (*STEADY, *sets), re.sub(r"[^\w.+-]+", "_", f"{mesh} {case} {size}"), scene=f"performance/{scene}.xml",
                         residual=first_residual)
        rows.run(f"{mesh}, {case}, {size}", run, Row(mesh, case, level, run))
    rows.finish(options, summary, FORMATS, draw, BOUNDS)
    return int(bool(rows.failed))
