"""Random networks compared with blocks of equal size: cost per unknown with crack tips throughout the domain."""
import math
from dataclasses import dataclass

import numpy as np

from perf.common import options as common
from perf.common import table
from perf.common.program import STATES, Run
from perf.krylov import krylov, linear

STEPS = 4     # of the scene: one of compression, the others of shear
DRAINED = 1e5  # step with flow, s: in shorter steps the undrained pressure dominates
AS_DRAWN = {3: (300, 20), 2: (100, 10)}  # number of fractures and domain size of the scenes
SCENES = {3: "random_3d_300.xml", 2: "random_2d_100.xml"}
SETS = {3: ("steep", "flat"), 2: ("main", "cross")}
ROCK = ("Materials.granite.type=elastic", "Materials.granite.Young's modulus=50 GPa", "Materials.granite.Poisson's ratio=0.25",
        "Materials.granite.permeability={1e-17}", "Materials.granite.porosity=0.01", "Materials.granite.Biot coefficient=0.7",
        "Materials.joint.initial aperture=0.2 mm", "Flow.compressibility=4.5e-10", "Flow.initial pressure=0")
FLOW = (*ROCK, "Boundary conditions.inlet.boundary=north", "Boundary conditions.inlet.pressure=1e6", "Boundary conditions.outlet.boundary=south",
        "Boundary conditions.outlet.pressure=0")
BOUNDS = {"krylov_max": 30, "newton_median": 6, "newton_max": 12, "seconds_over_blocks": 1.5, "bytes_over_blocks": 1.4, "exponent": 1.1}
QUICK_BOUNDS = {name: BOUNDS[name] for name in ("krylov_max", "newton_median", "newton_max")}
COLUMNS = {"scene": "", "fractures": "d", "unknowns": "d", "of tips": "d", **{state: ".2f" for state in STATES}, "Newton": ".3g", "most": "d",
           "cuts": "d", "solves": "d", "mean": ".1f", "max": ".4g", "residual": ".0e", "set-up s": ".1f", "assembly s": ".1f", "solve s": ".1f",
           "us": ".1f", "kB": ".1f"}


@dataclass
class Scale:
    """Network with a given number of fractures and the fracture density of its scene."""
    fractures: int
    dim: int
    flow: bool = False
    quick: bool = False
    hours: int = 1  # time limit; runs of more than an hour need `--only`

    @property
    def name(self):
        return f"{self.fractures} fractures {self.dim}D{', flow' if self.flow else ''}"

    @property
    def file(self):
        return SCENES[self.dim]

    def sets(self, seed):
        n, side = AS_DRAWN[self.dim]
        wider = (self.fractures / n) ** (1 / self.dim)
        corner = ", ".join([f"{side * wider:.6g}"] * self.dim)
        first = round(0.6 * self.fractures)
        numbers = [f"Mesh file.network.fractures.{name}.random.{entry}={value}" for name, number, own in
                   zip(SETS[self.dim], (first, self.fractures - first), (seed, seed + 1)) for entry, value in (("number", number), ("seed", own))]
        moved = [f"Tables.{table}.values={{{values}}}" for table, values in
                 (("settlement", ", ".join(f"{x * wider:.6g}" for x in (0, 4e-4 * side, 4e-4 * side))),
                  ("shear", ", ".join(f"{x * wider:.6g}" for x in (0, 0, 8e-4 * side))))]
        return (f"Mesh file.network.domain.upper corner={{{corner}}}", *numbers, *moved)

    def entries(self):
        """Entries of the run."""
        step = DRAINED if self.flow else 1
        times = [f"Tables.{table}.arguments={{0, {step}, {11 * step}}}" for table in ("settlement", "confinement", "shear")]
        return (f"Time.end={STEPS * step}", f"Time.steps={STEPS}", *times, *(FLOW if self.flow else ()))


def scales():
    yield Scale(50, 3, quick=True)
    yield Scale(300, 3)
    yield Scale(1000, 3)
    yield Scale(3000, 3, hours=2)
    yield Scale(50, 3, flow=True)
    yield Scale(2000, 2)
    yield Scale(2000, 2, flow=True)


@dataclass
class Row:
    name: str
    fractures: int
    run: Run

    @property
    def tips(self):
        return self.run.unknowns_of("tip displacement")

    @property
    def seconds(self):
        """Seconds per Newton iteration."""
        return self.run.total_time / max(1, sum(self.run.newton))

    @property
    def cost(self):
        """Seconds of a Newton iteration and bytes per displacement unknown; seconds per displacement and tip
        unknown."""
        n = max(1, self.run.unknowns)
        return self.seconds / n, self.run.bytes[0] / n, self.seconds / (n + self.tips)

    def values(self):
        run, (seconds, size, _) = self.run, self.cost
        return [self.name, self.fractures, run.unknowns, self.tips, *run.fractions, float(np.median(run.newton)),
                max(run.newton), run.cuts, len(run.krylov), run.mean, run.max_used, run.residual,
                *run.times, 1e6 * seconds, size / 1e3]


def blocks(options, unknowns):
    """Runs the tetrahedral mesh of perf krylov with all contact states and a similar number of unknowns."""
    edge = round((unknowns / 3) ** (1 / 3)) - 1
    edge = 6 * max(2, round(edge / 6))  # cell boundaries match the fractures
    run = linear.run(options, (*linear.cells(edge), "Mesh.cell=tetrahedron", *krylov.STATES["mixed"]), f"blocks_{edge}")
    return Row(f"blocks, {edge} cells", 9, run)


def measure(options, made, seed):
    """Prints the table and the last line; returns the exit status. made(scale, sets) generates the mesh of a
    network."""
    chosen = common.matching(options, [s for s in scales() if (s.quick or not options.quick) and (s.hours == 1 or options.only)], lambda scale: scale.name)
    rows, networks, beside = table.Series(COLUMNS, 26), [], {}
    for scale in chosen:
        mesh, fractures = made(scale, scale.sets(seed))
        entries = (*scale.sets(seed), f"Mesh file.path={mesh}", *scale.entries())
        directory = "run_" + scale.name.replace(" ", "_").replace(",", "")
        row = Row(scale.name, fractures, linear.run(options, entries, directory, time_limit=3600 * scale.hours, scene=f"networks/{scale.file}"))
        rows.run(row.name, row.run, row)
        networks.append((scale, row))
        if scale.dim == 3 and not scale.flow and row.run.unknowns:
            other = beside[scale.name] = blocks(options, row.run.unknowns)
            rows.run(other.name, other.run, other)
    options.name = "scale"
    values = {**summary([(scale, row) for scale, row in networks if not row.run.failure], beside), "failures": len(rows.failed)}
    return table.finish(options, rows, values, {name: ".3g" for name in values if name != "failures"}, QUICK_BOUNDS if options.quick else BOUNDS, rows.failed)


def summary(networks, beside):
    newton = [n for _, row in networks for n in row.run.newton]
    both = [(row, beside[scale.name]) for scale, row in networks if scale.name in beside and not beside[scale.name].run.failure]
    ratio = [max((row.cost[k] / other.cost[k] for row, other in both), default=math.nan) for k in range(3)]
    of_size = [(math.log(row.fractures), math.log(row.seconds)) for scale, row in networks if scale.dim == 3 and not scale.flow]
    return {"krylov_max": max((row.run.max_used for _, row in networks), default=math.nan), "newton_median": float(np.median(newton or [math.nan])),
            "newton_max": max(newton, default=math.nan), "seconds_over_blocks": ratio[0], "bytes_over_blocks": ratio[1],
            "with_tips": ratio[2],
            "exponent": float(np.polyfit(*zip(*of_size), 1)[0]) if len(of_size) > 1 else math.nan}
