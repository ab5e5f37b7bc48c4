"""The same scenes on more ranks, and scenes that grow with the number of ranks: iterations, messages and memory on 1 to 64 ranks, seconds on 1 and 2.

The scenes are blocks and a network of random fractures. With more ranks than cores, times are meaningless, but the counts equal those of a cluster.
--model predicts from them the time of an iteration on a cluster. --commands generates the meshes and prints the command of each run, for a machine
with more cores."""
import math
import shlex
from argparse import Namespace
from dataclasses import dataclass

from perf.common import options as common
from perf.common import table
from perf.common.program import Run, command, on_ranks
from perf.krylov import linear
from perf.krylov.krylov import STATES
from perf.networks import networks, scale

STATE = "mixed"
STEPS = 2   # steps of a network: one of compression, one of shear
TIMES = 3   # repetitions of each timed run, in turns: other load slows single runs, mostly the first
KINDS = ("blocks", "network")
BOUNDS = {"speedup2": (+1, 1.8), "growth16": 0.2, "growth64": 0.2}
COLUMNS = {"scene, ranks": "", "size": "d", "unknowns": "d", "per rank": "d", "Newton": ".4g", "mean": ".1f", "max": ".4g", "residual": ".0e", "halo kB": ".1f", "messages": "d",
           "exchanges": "d", "cut edges": "d", "levels": "d", "last": "d", "its ranks": "d",
           "of a cycle": ".0f", "kB of a cycle": ".0f", "MB": ".0f", "MB of a rank": ".0f", "set-up s": ".1f", "assembly s": ".1f", "solve s": ".1f"}


@dataclass
class Case:
    """Run of blocks with `size` cells along an edge of the box, or of a network with `size` fractures."""
    series: str  # timed | strong | weak
    kind: str    # one of KINDS
    size: int
    ranks: int

    @property
    def name(self):
        return f"{self.series} {self.kind}, {self.ranks}"

    @property
    def directory(self):
        return f"{self.series}_{self.kind}_{self.size}_{self.ranks}"

    def scene(self, options):
        """Returns the scene of a run and its entries; makes the mesh of a network if it does not exist."""
        if self.kind == "blocks":
            return linear.SCENE, (*linear.cells(self.size), "Mesh.cell=tetrahedron", *STATES[STATE])
        network = scale.Scale(self.size, 3)
        mesh = mesh_of(options, network)
        return f"networks/{network.file}", (*network.sets(1), f"Mesh file.path={mesh}", f"Time.end={STEPS}", f"Time.steps={STEPS}")


def mesh_of(options, network):
    directory = options.output / "meshes"
    made = directory / str(network.fractures)
    if not (made / "network.msh.json").is_file():  # written last
        networks.made(Namespace(**{**vars(options), "output": directory}), networks.Network(str(network.fractures), network.file, network.sets(1)))
    return made / "network.msh"


def cases(options):
    if options.quick:
        return [Case("strong", "blocks", 12, ranks) for ranks in (1, 2)] + [Case("strong", "network", 12, ranks) for ranks in (1, 2)]
    timed = [Case("timed", kind, size, ranks) for _ in range(TIMES) for kind, size in (("blocks", options.edge), ("network", options.fractures)) for ranks in (1, 2)]
    strong = [Case("strong", kind, size, ranks) for kind, size in (("blocks", 18), ("network", 50)) for ranks in (1, 2, 4, 8, 16)]
    # 2700 displacement unknowns per rank
    weak = [("blocks", ((12, 4), (18, 11), (24, 23), (36, 64))), ("network", ((16, 4), (64, 16), (256, 64)))]
    return timed + strong + [Case("weak", kind, size, ranks) for kind, of in weak for size, ranks in of]


@dataclass
class Row:
    case: Case
    run: Run

    @property
    def halo(self):
        """Bytes received by all ranks when every field is exchanged once."""
        return self.of_fields("halo_bytes")

    @property
    def cycle(self):
        """Properties of the displacement V-cycle: levels and their unknowns and ranks, messages and bytes of the
        largest rank."""
        return next((part for part in self.run.results["solver"].get("parts", []) if "levels" in part), {})

    def of_fields(self, what):
        return sum(field[what] for field in self.run.results["blocks"]["fields"])

    def values(self):
        run, results = self.run, self.run.results
        return [self.case.name, self.case.size, run.unknowns, run.unknowns // self.case.ranks, run.mean_newton, run.mean, run.maximum, run.residual,
                self.halo / 1e3, self.of_fields("halo_messages"), results.get("timing", {}).get("ghost_exchange", {}).get("count", 0), results["partition"]["cut_edges"],
                self.cycle.get("levels"), *(self.cycle.get(what, [None])[-1] for what in ("unknowns_of_levels", "ranks_of_levels")), self.cycle.get("messages_largest_rank"),
                self.cycle.get("message_bytes_largest_rank", 0) / 1e3, run.bytes[0] / 1e6, run.bytes[1] / 1e6, *run.times]


@dataclass
class Machine:
    """Resources of one core in a cluster node with many cores."""
    memory: float = 4e9    # byte/s
    latency: float = 2e-6  # s, per message, and per each of the log2(P) steps of a reduction
    network: float = 5e8   # byte/s
    direct: float = 2e9    # flop/s with factors


UNKNOWNS = 5e4  # per rank


def model(rows, unknowns=UNKNOWNS, machine=Machine()):
    """Yields (ranks, {part: seconds of a Krylov iteration}) for 10^2 to 10^5 ranks with `unknowns` unknowns each.

    Counts are those of the largest run of the weak series, per unknown, or for halos per unknown^(2/3). The
    last level grows with the number of ranks: each contributes one node. One rank solves it with factors of a
    space-filling graph, 30 n^(4/3) numbers."""
    row = max((row for row in rows if row.case.series == "weak" and row.cycle), key=lambda row: row.case.ranks)
    cycle, own, maximum = row.cycle, row.run.unknowns / row.case.ranks, row.case.ranks
    more, levels = unknowns / own, cycle["levels"]
    matrix = 8 * 45  # bytes per unknown of a matrix-vector product
    for ranks in (100, 1000, 10000, 100000):
        deeper = levels + math.log(more * ranks / maximum, 20)
        last = cycle["unknowns_of_levels"][-1] / maximum * ranks
        yield ranks, {"memory": unknowns * (cycle["cycle_bytes_largest_rank"] / own + matrix) / machine.memory,
                      "messages": cycle["messages_largest_rank"] * deeper / levels * machine.latency,
                      "their bytes": cycle["message_bytes_largest_rank"] * more ** (2 / 3) / machine.network,
                      "sums": 3 * math.log2(ranks) * machine.latency,
                      "last level": 4 * 30 * last ** (4 / 3) / machine.direct + 2 * 8 * last / machine.network + math.log2(ranks) * machine.latency}


def predict(kind, rows):
    print(f"\n{kind}\n{'ranks':>9}{'unknowns':>12}" + "".join(f"{name + ' ms':>16}" for name in ("memory", "messages", "their bytes", "sums", "last level", "all"))
          + f"{'efficiency':>12}")
    for ranks, parts in model(rows):
        total = sum(parts.values())
        print(f"{ranks:>9}{UNKNOWNS * ranks:>12.0e}" + "".join(f"{1e3 * value:>16.3g}" for value in (*parts.values(), total)) + f"{parts['memory'] / total:>12.2f}")


def summary(rows, maximum):
    """Summary of blocks or networks; missing values are NaN."""
    by = {(row.case.series, row.case.ranks): row for row in rows}
    one, many = by.get(("strong", 1)), by.get(("strong", maximum))
    weak = sorted((row for row in rows if row.case.series == "weak"), key=lambda row: row.case.ranks)
    minimum = [min((row.run.total_time for row in rows if (row.case.series, row.case.ranks) == ("timed", ranks)), default=float("nan")) for ranks in (1, 2)]
    return {"speedup2": minimum[0] / minimum[1],
            f"growth{maximum}": many.run.mean / one.run.mean - 1 if one and many else float("nan"),
            "growth64": weak[-1].run.mean / weak[0].run.mean - 1 if len(weak) > 1 and weak[-1].case.ranks == 64 else float("nan")}


def draw(rows, file):
    import style
    figure, axes = style.plt.subplots(1, 3, figsize=(10, 3.3))
    whats = (("Krylov iterations of a solve: mean, largest (-)", lambda row: row.run.mean), ("messages of a V-cycle, largest rank (-)",
                                                                                             lambda row: row.cycle.get("messages_largest_rank", math.nan)),
             ("largest memory of a rank (MB)", lambda row: row.run.bytes[1] / 1e6))
    lines = [(series, kind) for kind in KINDS for series in ("strong", "weak")]
    for ax, (label, what) in zip(axes, whats):
        for k, (series, kind) in enumerate(lines):
            of = [row for row in rows if (row.case.series, row.case.kind) == (series, kind)]
            if not of:
                continue
            x = [row.case.ranks for row in of]
            ax.plot(x, [what(row) for row in of], "o-", color=style.LINES[k], markersize=4,
                    label=f"{kind}, " + " to ".join(f"{n:,}" for n in sorted({of[0].run.unknowns, of[-1].run.unknowns})) + " unknowns")
            if ax is axes[0]:
                ax.vlines(x, [row.run.mean for row in of], [row.run.maximum for row in of], color=style.LINES[k], linewidth=0.8)
        ticks = sorted({row.case.ranks for row in rows})
        ax.set(xscale="log", xlabel="ranks (-)", title=label)
        ax.set_xticks(ticks, ticks)
        ax.minorticks_off()
        ax.set_ylim(0, 1.05 * ax.get_ylim()[1])
    if axes[0].lines:
        axes[0].legend(loc="lower left")
    figure.savefig(file, dpi=150)


def print_commands(options, chosen):
    """Makes missing meshes and prints the command of each run."""
    for case in {case.directory: case for case in chosen}.values():
        scene, sets = case.scene(options)
        print(f"# {case.name}\n{shlex.join(on_ranks(case.ranks, command(options.binary, scene, options.output / case.directory, linear.entries(options, sets))))}")


def main(words):
    parser = common.parser("ranks", __doc__)
    parser.add_argument("--edge", type=common.count, default=42, metavar="N", help="cells along an edge of the box of the timed blocks (42, 280 thousand unknowns)")
    parser.add_argument("--fractures", type=common.count, default=150, metavar="N", help="fractures of the timed network (150, 100 thousand unknowns and half as many of tips)")
    parser.add_argument("--model", action="store_true", help="predict the seconds of an iteration on 10^2 to 10^5 ranks from the weak series")
    parser.add_argument("--commands", action="store_true", help="generate the meshes, and print the command line of each run instead of running it")
    options = parser.parse_args(words)
    chosen = common.matching(options, cases(options), lambda case: case.name)
    if options.commands:
        return print_commands(options, chosen)
    rows = table.Series(COLUMNS, 19)
    for case in chosen:
        scene, sets = case.scene(options)
        run = linear.run(options, sets, case.directory, case.ranks, scene=scene)
        rows.run(case.name, run, Row(case, run))
    maximum = max(case.ranks for case in cases(options) if case.series == "strong")
    bounds = {f"{name}_{kind}": bound for kind in KINDS for name, bound in {**BOUNDS, f"growth{maximum}": BOUNDS["growth16"]}.items()
              if name in ("speedup2", f"growth{maximum}", "growth64")}

    def total(rows):
        values = {}
        for kind in KINDS:
            of_kind = [row for row in rows if row.case.kind == kind]
            if options.model and any(row.case.series == "weak" and row.cycle for row in of_kind):
                predict(kind, of_kind)
            values |= {f"{name}_{kind}": value for name, value in summary(of_kind, maximum).items()}
        return values
    return rows.finish(options, total, {name: ".2f" for name in bounds}, draw, bounds)
