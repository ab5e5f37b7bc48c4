#!/usr/bin/env python3
"""The same scene on more ranks, and scenes that grow with the number of ranks: iterations, messages and memory on 1 to 64 ranks, seconds on 1 and 2.

More ranks than cores say nothing about time, but the counts are those of a cluster. --model predicts from them what an iteration takes there."""
import math
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "perf/krylov"))

import linear  # noqa: E402
from krylov import STATES  # noqa: E402

STATE = "mixed"
TIMED = 42  # cells along an edge of the box
TIMES = 3   # each timed run, by turns: what else a machine does makes single ones slower, the first ones most of all
STRONG = [("strong", 18, ranks) for ranks in (1, 2, 4, 8, 16)]
WEAK = [("weak", edge, ranks) for edge, ranks in ((12, 4), (18, 11), (24, 23), (36, 64))]  # about 2700 unknowns per rank
QUICK = [("strong", 12, ranks) for ranks in (1, 2)]
BOUNDS = {"speedup2": 1.8, "growth16": 0.2, "growth64": 0.2}
COLUMNS = {"kind, ranks": "", "edge": "d", "unknowns": "d", "per rank": "d", "Newton": ".4g", "mean": ".1f", "max": ".4g", "residual": ".0e", "halo kB": ".1f", "messages": "d",
           "exchanges": "d", "cut edges": "d", "levels": "d", "last": "d",
           "of a cycle": ".0f", "kB of a cycle": ".0f", "MB": ".0f", "MB of a rank": ".0f", "set-up s": ".1f", "assembly s": ".1f", "solve s": ".1f"}


@dataclass
class Row:
    kind: str
    edge: int
    ranks: int
    run: linear.Run

    @property
    def seconds(self):
        return sum(self.run.seconds(what) for what in linear.TIMERS)

    @property
    def halo(self):
        """Bytes that all ranks receive when every field is exchanged once."""
        return self.of_fields("halo_bytes")

    @property
    def cycle(self):
        """Of the V-cycle of displacements: levels, unknowns of the last one, and of the rank that has most matrices, messages and their bytes."""
        return next((part for part in self.run.results["solver"].get("parts", []) if "levels" in part), {})

    def of_fields(self, what):
        return sum(field[what] for field in self.run.results["blocks"]["fields"])

    def values(self):
        run, results = self.run, self.run.results
        return [f"{self.kind}, {self.ranks}", self.edge, run.unknowns, run.unknowns // self.ranks, run.newton, run.mean, run.most, run.residual,
                self.halo / 1e3, self.of_fields("halo_messages"), results.get("timing", {}).get("ghost_exchange", {}).get("count", 0), results["partition"]["cut_edges"],
                *(self.cycle.get(what) for what in ("levels", "unknowns_of_last_level", "messages_largest_rank")),
                self.cycle.get("message_bytes_largest_rank", 0) / 1e3, run.bytes[0] / 1e6, run.bytes[1] / 1e6, *(run.seconds(what) for what in linear.TIMERS)]


@dataclass
class Machine:
    """Of a cluster with many cores a node, what one core has of it."""
    memory: float = 4e9    # byte/s
    latency: float = 2e-6  # s, of a message, and of each of the log2(P) steps of a sum over ranks
    network: float = 5e8   # byte/s
    direct: float = 2e9    # flop/s with factors


UNKNOWNS = 5e4  # of a rank


def model(rows, unknowns=UNKNOWNS, machine=Machine()):
    """Seconds of a Krylov iteration by what they are for, on 10^2 to 10^5 ranks with so many unknowns each: counts of the largest run of the weak
    series, per unknown or, of halos, per unknown^(2/3); the last level grows with the ranks, of which each keeps a node, and one rank solves it
    with factors of a space-filling graph, 30 n^(4/3) numbers."""
    row = max((row for row in rows if row.kind == "weak" and row.cycle), key=lambda row: row.ranks)
    cycle, own = row.cycle, row.run.unknowns / row.ranks
    more, levels = unknowns / own, cycle["levels"]
    matrix = 8 * 45  # bytes per unknown: a product with the matrix
    for ranks in (100, 1000, 10000, 100000):
        deeper = levels + math.log(more * ranks / row.ranks, 20)
        last = cycle["unknowns_of_last_level"] / row.ranks * ranks
        yield ranks, {"memory": unknowns * (cycle["cycle_bytes_largest_rank"] / own + matrix) / machine.memory,
                      "messages": cycle["messages_largest_rank"] * deeper / levels * machine.latency,
                      "their bytes": cycle["message_bytes_largest_rank"] * more ** (2 / 3) / machine.network,
                      "sums": 3 * math.log2(ranks) * machine.latency,
                      "last level": 4 * 30 * last ** (4 / 3) / machine.direct + 2 * 8 * last / machine.network + math.log2(ranks) * machine.latency}


def predict(rows):
    print(f"\n{'ranks':>9}{'unknowns':>12}" + "".join(f"{name + ' ms':>16}" for name in ("memory", "messages", "their bytes", "sums", "last level", "all"))
          + f"{'efficiency':>12}")
    for ranks, parts in model(rows):
        total = sum(parts.values())
        print(f"{ranks:>9}{UNKNOWNS * ranks:>12.0e}" + "".join(f"{1e3 * value:>16.3g}" for value in (*parts.values(), total)) + f"{parts['memory'] / total:>12.2f}")


def summary(rows, most):
    """What is missing is not a number."""
    by = {(row.kind, row.ranks): row for row in rows}
    one, many = by.get(("strong", 1)), by.get(("strong", most))
    weak = sorted((row for row in rows if row.kind == "weak"), key=lambda row: row.ranks)
    least = [min((row.seconds for row in rows if (row.kind, row.ranks) == ("timed", ranks)), default=float("nan")) for ranks in (1, 2)]
    return {"speedup2": least[0] / least[1],
            f"growth{most}": many.run.mean / one.run.mean - 1 if one and many else float("nan"),
            "growth64": weak[-1].run.mean / weak[0].run.mean - 1 if len(weak) > 1 and weak[-1].ranks == 64 else float("nan")}


def draw(rows, file):
    import style
    figure, axes = style.plt.subplots(1, 3, figsize=(10, 3.3))
    whats = (("Krylov iterations of a solve: mean, largest (-)", lambda row: row.run.mean), ("halo of a rank, all fields (kB)", lambda row: row.halo / 1e3 / row.ranks),
             ("largest memory of a rank (MB)", lambda row: row.run.bytes[1] / 1e6))
    for ax, (label, what) in zip(axes, whats):
        for k, (kind, text) in enumerate((("strong", "the same scene"), ("weak", "grows with the ranks"))):
            of = [row for row in rows if row.kind == kind]
            if not of:
                continue
            x = [row.ranks for row in of]
            ax.plot(x, [what(row) for row in of], "o-", color=style.LINES[k], markersize=4, label=f"{text}, {of[0].run.unknowns:,} to {of[-1].run.unknowns:,} unknowns"
                    if kind == "weak" else f"{text}, {of[0].run.unknowns:,} unknowns")
            if ax is axes[0]:
                ax.vlines(x, [row.run.mean for row in of], [row.run.most for row in of], color=style.LINES[k], linewidth=0.8)
        ticks = sorted({row.ranks for row in rows})
        ax.set(xscale="log", xlabel="ranks (-)", title=label)
        ax.set_xticks(ticks, ticks)
        ax.minorticks_off()
        ax.set_ylim(0, 1.05 * ax.get_ylim()[1])
    if axes[0].lines:
        axes[0].legend(loc="lower left")
    figure.savefig(file, dpi=150)


def main(words):
    parser = linear.parser("ranks", __doc__)
    parser.add_argument("--edge", type=linear.count, default=TIMED, metavar="N", help=f"cells along an edge of the box of the timed scene ({TIMED}, 280 thousand unknowns)")
    parser.add_argument("--model", action="store_true", help="predict the seconds of an iteration on 10^2 to 10^5 ranks from the weak series")
    options = parser.parse_args(words)
    runs = QUICK if options.quick else [("timed", options.edge, ranks) for ranks in (1, 2)] * TIMES + STRONG + WEAK
    chosen = linear.matching(options, runs, lambda run: f"{run[0]}, {run[2]}")
    options.output.mkdir(parents=True, exist_ok=True)
    table, rows, failed = linear.Table(COLUMNS, 12), [], []
    for kind, edge, ranks in chosen:
        run = linear.run(options, (*linear.cells(edge), "Mesh.cell=tetrahedron", *STATES[STATE]), f"{kind}_{edge}_{ranks}", ranks)
        if run.failure:
            failed.append(f"failed: {kind}, {ranks}: {run.failure}")
        if run.steps:
            rows.append(Row(kind, edge, ranks, run))
            table.add(rows[-1].values(), failed[-1:] if run.failure else ())
    if not rows:
        sys.exit("\n".join(failed))
    table.write(options.output / "ranks.csv")
    draw(rows, options.output / "ranks.png")
    most = max(ranks for *_, ranks in (QUICK if options.quick else STRONG))
    total, growth = summary(rows, most), f"growth{most}"
    wrong = [f"missed: {name} = {total[name]:.2f}, the bound is {bound}" for name, bound in ((growth, BOUNDS["growth16"]), ("growth64", BOUNDS["growth64"]))
             if total[name] > bound]
    if options.model and any(row.kind == "weak" and row.cycle for row in rows):
        predict(rows)
    slow = [f"missed: speedup2 = {total['speedup2']:.2f}, asked are {BOUNDS['speedup2']}"] if total["speedup2"] < BOUNDS["speedup2"] else []
    print("\n".join(["", *failed, *wrong, *slow, f"ranks.csv and ranks.png in {options.output}"]))
    print(" ".join(f"{name}={value:.2f}" for name, value in total.items()))
    return 1 if failed or (options.quick and wrong) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
