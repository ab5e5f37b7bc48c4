#!/usr/bin/env python3
"""The same scene on more ranks, and scenes that grow with the number of ranks: iterations, halo and memory on 1 to 16 ranks, seconds on 1 and 2.

More ranks than cores say nothing about time, but the counts are those of a cluster."""
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
WEAK = [("weak", edge, ranks) for edge, ranks in ((12, 1), (18, 3), (24, 8), (30, 16))]  # about 8000 unknowns per rank
QUICK = [("strong", 12, ranks) for ranks in (1, 2)]
BOUNDS = {"speedup2": 1.7, "growth16": 0.2}
COLUMNS = {"kind, ranks": "", "edge": "d", "unknowns": "d", "per rank": "d", "Newton": ".4g", "mean": ".1f", "max": ".4g", "residual": ".0e", "halo kB": ".1f", "messages": "d",
           "exchanges": "d", "cut edges": "d", "MB": ".0f", "MB of a rank": ".0f", "set-up s": ".1f", "assembly s": ".1f", "solve s": ".1f"}


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

    def of_fields(self, what):
        return sum(field[what] for field in self.run.results["blocks"]["fields"])

    def values(self):
        run, results = self.run, self.run.results
        return [f"{self.kind}, {self.ranks}", self.edge, run.unknowns, run.unknowns // self.ranks, run.newton, run.mean, run.most, run.residual,
                self.halo / 1e3, self.of_fields("halo_messages"), results.get("timing", {}).get("ghost_exchange", {}).get("count", 0), results["partition"]["cut_edges"],
                run.bytes[0] / 1e6, run.bytes[1] / 1e6, *(run.seconds(what) for what in linear.TIMERS)]


def summary(rows, most):
    """What is missing is not a number."""
    by = {(row.kind, row.ranks): row for row in rows}
    one, many = by.get(("strong", 1)), by.get(("strong", most))
    least = [min((row.seconds for row in rows if (row.kind, row.ranks) == ("timed", ranks)), default=float("nan")) for ranks in (1, 2)]
    return {"speedup2": least[0] / least[1],
            f"growth{most}": many.run.mean / one.run.mean - 1 if one and many else float("nan")}


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
    wrong = [] if not total[growth] > BOUNDS["growth16"] else [f"missed: {growth} = {total[growth]:.2f}, the bound is {BOUNDS['growth16']}"]
    slow = [f"missed: speedup2 = {total['speedup2']:.2f}, asked are {BOUNDS['speedup2']}"] if total["speedup2"] < BOUNDS["speedup2"] else []
    print("\n".join(["", *failed, *wrong, *slow, f"ranks.csv and ranks.png in {options.output}"]))
    print(" ".join(f"{name}={value:.2f}" for name, value in total.items()))
    return 1 if failed or (options.quick and wrong) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
