"""Costs of the parts of a Newton step, in products of the displacement matrix with a vector, and their share of the memory bandwidth.

The scenes are a grid of fractures, open, sticking and sliding, and a network of 300 random fractures with crack tips.
bandwidth.cpp measures the times."""
import json

from perf.bandwidth import factors
from perf.common import options as common
from perf.common import table
from perf.common.program import measured, mesh
from perf.krylov import linear
from perf.krylov.krylov import STATES

STATE = "mixed"
EDGE, QUICK = 30, 18  # cells along an edge: 111 and 29 thousand unknowns
CELLS = {"tetrahedra": "tetrahedron", "hexahedra": "hexahedron"}
NETWORK = "networks/random_3d_300.xml"
PROGRAM = common.ROOT / "build/apps/sprekk/sprekk"  # for its mesh
COLUMNS = {"part": "", "count": "d", "ms": ".4g", "SpMV": ".1f", "of triad": ".2f", "of time": ".3f", "required": ""}
ASKED = {  # targets of the last line: at least (+), at most (-)
    "spmv_share": (+1, 0.6), "assembly_spmv": (-1, 20), "assemblies": (-1, 1), "solve_reused_spmv": (-1, 300), "solve_first_spmv": (-1, 450),
    "newton_spmv": (-1, 350), "contact_share": (-1, 0.05)}
CONTACT = "elastic-plastic jump"
FORMATS = {"triad": ".1f", "spmv_share": ".2f", "contact_share": ".3f"}


class Measured:
    """Results of one run of bandwidth.cpp."""

    def __init__(self, found):
        self.found, self.spmv = found, found["medians"]["SpMV"]
        self.triad = found["triad_bytes"] / found["medians"]["triad"]  # byte/s
        self.first, self.phases = found["first"], found["phases"]
        self.newton = self.phases["time steps"]["seconds"] / found["newton_iterations"]
        self.first_setup = self.first["set-up of linear solver"]["seconds"]

    def share(self, bytes_moved, seconds):
        return bytes_moved / seconds / self.triad

    def parts(self):
        """Rows (name, count, seconds, share of the triad's bandwidth, share of the step's time, key of the last
        line)."""
        found, phases = self.found, self.phases
        assembly, cycle, contact = phases["assembly of the linear part"], found["parts"][-1], phases[CONTACT]
        touch = found["first touch"]
        return [("2 GiB touched for the first time", None, touch["first"], None, None, None),
                ("2 GiB touched again", None, touch["again"], None, None, None),
                ("triad", None, found["medians"]["triad"], 1, None, None),
                ("SpMV", None, self.spmv, self.share(found["spmv_bytes"], self.spmv), None, "spmv_share"),
                ("assembly of the bulk", assembly["count"], assembly["seconds"], None, None, "assembly_spmv"),
                ("structure of the matrices", None, phases["structure of the matrices"]["seconds"], None, None, None),
                ("V-cycle", None, cycle["seconds"], self.share(cycle["bytes"], cycle["seconds"]), None, None),
                ("preconditioner", None, found["preconditioner"], None, None, None),
                ("elimination", None, self.first["local elimination"]["seconds"], None, None, None),
                ("first set-up", None, self.first_setup, None, None, None),
                ("elimination and set-up, kept", None, found["elimination and set-up"], None, None, None),
                ("solve", found["iterations"], found["solve"], None, None, "solve_reused_spmv"),
                ("solve and first set-up", found["iterations"], found["solve"] + self.first_setup, None, None, "solve_first_spmv"),
                ("Newton step", found["newton_iterations"], self.newton, None, None, "newton_spmv"),
                ("contact kernels", None, contact["seconds"] / found["newton_iterations"], None, contact["seconds"] / phases["time steps"]["seconds"],
                 "contact_share")]

    def summary(self):
        spmv = {key: seconds / self.spmv for *_, seconds, _, _, key in self.parts() if key and key.endswith("_spmv")}
        shares = {key: of_triad or of_time for *_, of_triad, of_time, key in self.parts() if key and key.endswith("_share")}
        return {"triad": self.triad / 1e9, "assemblies": self.phases["assembly of the linear part"]["count"], **spmv, **shares}


def required(key):
    if key not in ASKED:
        return ""
    sign, bound = ASKED[key]
    return f"{'>=' if sign > 0 else '<='}{bound:g}"


def run(options, cells, edge):
    if cells == "network":
        scene, sets = NETWORK, (f"Mesh file.path={mesh(PROGRAM, NETWORK, options.output / 'mesh/network.msh')}", *linear.ALWAYS)
    else:
        scene, sets = linear.SCENE, (*linear.ALWAYS, *linear.cells(edge), f"Mesh.cell={CELLS[cells]}", *STATES[STATE])
    found = measured(options, scene, sets, options.ranks)
    (options.output / f"{cells}.json").write_text(json.dumps(found, indent=2))
    return Measured(found)


def draw(measured, file):
    """Draws the times of the parts in matrix-vector products, with their targets."""
    import style
    names = [name for name, *_ in next(iter(measured.values())).parts()][4:]
    figure, ax = style.plt.subplots(figsize=(7.5, 4.2))
    height = 0.8 / len(measured)
    for k, (cells, one) in enumerate(measured.items()):
        for i, (name, _, seconds, _, _, key) in enumerate(one.parts()[4:]):
            y = i + height * (k - (len(measured) - 1) / 2)
            ax.barh(y, seconds / one.spmv, 0.9 * height, color=style.LINES[k], label=cells if i == 0 else None)
            times = seconds / one.spmv
            ax.annotate(f"{times:.1f}" if times < 100 else f"{times:,.0f}", (times, y), xytext=(3, 0), textcoords="offset points", va="center", fontsize=7)
            if key in ASKED and key.endswith("_spmv"):
                ax.plot(2 * [ASKED[key][1]], [i - 0.45, i + 0.45], color=style.INK, linewidth=1.2, label="required" if k == 0 and key == "assembly_spmv" else None)
    ax.set_yticks(range(len(names)), names)
    ax.invert_yaxis()
    ax.set(xscale="log", xlabel="products of the displacement matrix with a vector (-)")
    ax.set_xlim(right=2 * ax.get_xlim()[1])
    ax.grid(False, axis="y")
    unknowns = next(iter(measured.values())).found["unknowns"]
    ax.set_title(", ".join(f"{cells}: SpMV at {one.summary()['spmv_share']:.0%} of {one.triad / 1e9:.1f} GB/s" for cells, one in measured.items()) + f"; {unknowns:,} unknowns")
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.savefig(file, dpi=150)


def main(words):
    parser = common.parser("bandwidth", __doc__, program=True)
    parser.add_argument("--edge", type=common.count, metavar="N", help=f"cells along an edge of the box ({EDGE}, 111 thousand unknowns; {QUICK} with --quick)")
    parser.add_argument("--ranks", type=common.count, default=1, metavar="N", help="ranks (1)")
    parser.add_argument("--factors", action="store_true", help="instead: estimated and measured costs of factors and of multigrid")
    options = parser.parse_args(words)
    if options.factors:
        return factors.measure(options)
    chosen = common.matching(options, CELLS if options.quick else (*CELLS, "network"))
    edge = options.edge or (QUICK if options.quick else EDGE)
    printed, measured = table.Table(COLUMNS, 42), {}
    for cells in chosen:
        measured[cells] = one = run(options, cells, edge)
        for name, count, seconds, of_triad, of_time, key in one.parts():
            printed.add([f"{cells}: {name}", count, 1e3 * seconds, seconds / one.spmv, of_triad, of_time, required(key)])
    draw(measured, options.output / "bandwidth.png")
    worst = {key: (min if key == "triad" or ASKED[key][0] > 0 else max)(one.summary()[key] for one in measured.values()) for key in ("triad", *ASKED)}
    table.finish(options, printed, worst, {key: FORMATS.get(key, ".0f") for key in worst}, ASKED)
    return int(worst["assemblies"] > ASKED["assemblies"][1])
