"""Seconds and memory for meshes that one rank generates and distributes, and for the same meshes refined by all ranks.

meshing.cpp only generates the mesh of a scene."""
from perf.common import options as common
from perf.common import table
from perf.common.program import measured
from perf.krylov import linear
from perf.meshing import files

SCENE = "seed/immersed_3d.xml"
EDGE, QUICK = 72, 12  # cubes along an edge of the box: 2.2 million and 10 thousand tetrahedra
COLUMNS = {"mesh": "", "million cells": ".3f", "million nodes": ".3f", "of a rank": ".3f", "s": ".2f", "MB of rank 0": ",.0f", "MB of others": ",.0f", "byte/cell": ",.0f"}


def run(options, edge, refinements, ranks):
    coarse = edge >> refinements
    return measured(options, SCENE, (*linear.cells(coarse), f"Mesh.refinements={refinements}"), ranks)


def row(name, found):
    """Table row. Memory is the peak of a process minus its memory before the mesh; the cells of a rank include
    ghosts."""
    extra = [1e-6 * (peak - before) for peak, before in zip(found["peak_bytes"], found["peak_bytes_before"])]
    maximum = int(max(found["local_cells"]))
    seconds = found["seconds_to_distribute"] + found["seconds_to_refine"]
    return [name, 1e-6 * found["cells"], 1e-6 * found["nodes"], 1e-6 * maximum, seconds, extra[0], max(extra[1:], default=None), 1e6 * max(extra) / maximum]


def main(words):
    parser = common.parser("meshing", __doc__, program=True)
    parser.add_argument("--edge", type=common.count, metavar="N", help=f"cubes along an edge of the refined box, a multiple of 24 ({EDGE}; {QUICK}, refined once and twice, with --quick)")
    parser.add_argument("--ranks", type=common.count, default=2, metavar="N", help="ranks of the rows on several ranks (2)")
    parser.add_argument("--files", action="store_true", help="mesh files of discs and traces instead, with repairs")
    parser.add_argument("--binary", type=common.absolute, default=common.ROOT / "build/apps/sprekk/sprekk",
                        help="the program that reads the scenes of --files")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="number added to the seeds of --files (0)")
    options = parser.parse_args(words)
    if options.files:
        return files.main(options)
    edge = options.edge or (QUICK if options.quick else EDGE)
    rows = {f"{counted(ranks, 'rank')}, " + (f"{edge >> refinements}^3 refined {refinements} times" if refinements else "made at once"): (refinements, ranks)
            for ranks in sorted({1, options.ranks}) for refinements in ((0, 1, 2) if options.quick else (0, 2, 3))}
    chosen = common.matching(options, rows)
    printed, cells = table.Table(COLUMNS, 32), set()
    for name in chosen:
        found = run(options, edge, *rows[name])
        cells.add((found["cells"], found["nodes"], found["fracture_faces"]))
        printed.add(row(name, found))
    printed.write(options.output / "meshing.csv")
    print(f"\nmeshing.csv in {options.output}")
    if len(cells) > 1:
        print(f"missed: the meshes differ in size: {sorted(cells)}")
    return int(len(cells) > 1)


def counted(n, what):
    return f"{n} {what}" + ("s" if n > 1 else "")
