"""A block of rock without fractures, solved here and by DOLFINx with PETSc on the same mesh: CPU seconds of assembly, set-up and solution on one rank."""
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from perf.common import options as common
from perf.common import table
from perf.common.program import Failed, checked
from perf.krylov import linear

SCENE = "performance/elastic_3d.xml"
EDGES, QUICK = (15, 29, 45), (15,)  # cubes along an edge: 12, 81 and 292 thousand unknowns
PEERS = {"gamg": "PETSc GAMG", "hypre": "PETSc hypre"}
OURS = "Sprekk"
YOUNG, POISSON, TRACTION = 1, 0.25, (0.1, 0, -1)  # as in the scene
AGREE = 1e-6    # allowed difference of displacements, relative to the largest displacement
ASKED = {"ratio": (+1, 1)}
COLUMNS = {"program": "", "unknowns": "d", "iterations": "d", "residual": ".0e", "assembly s": ".2f", "set-up s": ".2f", "solve s": ".2f", "total s": ".2f",
           "over ours": ".2f", "difference": ".0e"}
PARTS = {"assembly": ("set-up", "loads", "residual", "Jacobian", "local_elimination"), "set-up": ("set-up_of_the_solver", "set-up_of_linear_solver"),
         "solve": ("linear_solve",)}
TOTAL = ("set-up", "set-up_of_the_solver", "time_steps")  # these phases contain all parts and the time between them


@dataclass
class Row:
    """Results of one program on one mesh, from its fastest run."""
    name: str
    unknowns: int
    iterations: int
    residual: float
    seconds: dict  # assembly, set-up, solve, total
    displacement: np.ndarray = field(repr=False)  # [point of the lattice, component]

    def values(self, ours):
        size = np.abs(ours.displacement).max()
        return [self.name, self.unknowns, self.iterations, self.residual, *self.seconds.values(), self.seconds["total"] / ours.seconds["total"],
                np.abs(self.displacement - ours.displacement).max() / size]


def on_lattice(points, values, edge):
    """Values in the order of the lattice, x fastest."""
    place = np.rint(points * edge).astype(int) @ (1, edge + 1, (edge + 1)**2)
    sorted_values = np.empty_like(values)
    sorted_values[place] = values
    return sorted_values


def run_ours(options, edge):
    import read
    run = linear.run(options, (*linear.cells(edge), "Solver.tolerance=1e-6"), f"sprekk_{edge}", scene=SCENE)
    if run.failure:
        raise Failed(run.failure)
    (solve,) = run.steps[-1]["linear_solves"]
    seconds = {what: run.time(*names, clock="cpu_seconds") for what, names in {**PARTS, "total": TOTAL}.items()}
    grid = read.grid(read.written_steps(options.output / f"sprekk_{edge}", "bulk")[-1][1])
    displacement = read.vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    return [Row(OURS, run.unknowns, solve["iterations"], solve["residual"], seconds,
                on_lattice(read.vtk_to_numpy(grid.GetPoints().GetData()), displacement, edge))]


def run_peers(options, edge, names):
    directory = options.output / f"peer_{edge}"
    directory.mkdir(exist_ok=True)
    words = [sys.executable, "-B", Path(__file__).with_name("peer.py"), directory, edge, YOUNG, POISSON, ",".join(map(str, TRACTION)), linear.RESIDUAL, *names]
    checked(words)
    found = json.loads((directory / "peer.json").read_text())
    return [Row(PEERS[name], run["unknowns"], run["iterations"], run["residual"], {**run["seconds"], "total": sum(run["seconds"].values())},
                np.load(directory / f"{name}.npy")) for name, run in found.items()]


def fastest(rows):
    """Returns the fastest run of each program."""
    best = {}
    for row in rows:
        if row.name not in best or row.seconds["total"] < best[row.name].seconds["total"]:
            best[row.name] = row
    return list(best.values())


def draw(rows, file):
    """Draws the CPU seconds per unknown by part, side by side for all programs."""
    import style
    sizes, names = sorted({row.unknowns for row in rows}), list(dict.fromkeys(row.name for row in rows))
    figure, ax = style.plt.subplots(figsize=(8.5, 3.4))
    width = 0.8 / len(names)
    parts = [*PARTS, "rest"]
    for row in rows:
        x, bottom = sizes.index(row.unknowns) + width * (names.index(row.name) - (len(names) - 1) / 2), 0
        per = 1e6 / row.unknowns
        seconds = {**row.seconds, "rest": row.seconds["total"] - sum(row.seconds[part] for part in PARTS)}
        for k, part in enumerate(parts):
            ax.bar(x, per * seconds[part], 0.92 * width, bottom=bottom, color=(style.LINES[:3] + [style.FAINT])[k], label=part if row is rows[0] else None)
            bottom += per * seconds[part]
        ax.annotate(f"{row.name.split()[-1]}\n{row.iterations} it.", (x, bottom), xytext=(0, 3), textcoords="offset points", ha="center", fontsize=7)
    ax.set_xticks(range(len(sizes)), [f"{size:,} unknowns" for size in sizes])
    ax.set(ylabel="CPU time per unknown (µs)", title="elastic block, Sprekk and DOLFINx with PETSc: conjugate gradients to a residual of 1e-8, one rank")
    ax.set_ylim(0, 1.15 * ax.get_ylim()[1])
    ax.grid(False, axis="x")
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.savefig(file, dpi=150)


def main(words):
    parser = common.parser("bulk", __doc__)
    parser.add_argument("--repeat", type=int, default=3, metavar="N", help="runs of each, of which the fastest counts (3)")
    options = parser.parse_args(words)
    names = common.matching(options, PEERS)
    printed, all_rows, ratios, wrong = table.Table(COLUMNS, 14), [], [], []
    for edge in QUICK if options.quick else EDGES:
        rows = fastest([row for _ in range(options.repeat) for row in run_ours(options, edge) + run_peers(options, edge, names)])
        ours = rows[0]
        for row in rows:
            printed.add(row.values(ours))
            if row.values(ours)[-1] > AGREE or row.residual > linear.RESIDUAL or row.unknowns != ours.unknowns:
                wrong.append(f"wrong: {row.name} with {row.unknowns} unknowns: another answer, or not to a residual of {linear.RESIDUAL:g}")
        ratios.append(min(row.seconds["total"] for row in rows[1:]) / ours.seconds["total"])
        all_rows += rows
    draw(all_rows, options.output / "bulk.png")
    table.finish(options, printed, {"ratio": min(ratios)}, {"ratio": ".2f"}, ASKED, wrong)
    return int(bool(wrong))
