"""Injection that opens joints: Newton iterations and step reductions of injection into a network, at rates below and above the opening of joints.

Steps are those of the scene. The Newton iterations of a step include those of all substeps, also of rejected ones."""
from dataclasses import dataclass

import numpy as np

from perf.common import options as common
from perf.common import table
from perf.contact import contact
from perf.contact.scenes import Scene

END = 20 * 3600.0  # s
MAXIMUM = 25          # target: Newton iterations per step
ASKED = {"failures": 0, "newton_max": MAXIMUM}
CUTS = 0.1         # target: bisections per step of a run
QUICK = {"failures": 0, "newton_median": 10, "newton_max": 64, "cuts": 2}  # --quick printed 0, 8.5, 32, 0
PERMEABILITIES = (1e-20, 1e-17, 1e-15)  # m^2
JOINT = "Materials.rough joint."
JOINTS = {"mated": (),                                # 0.4 mm wide without load
          "closed": (JOINT + "initial aperture=0",),  # except for the residual aperture
          "hard": (JOINT + "initial aperture=0", JOINT + "maximum closure=0")}
RUNS = tuple((solver, steps) for solver in ("direct", "iterative") for steps in (10, 40))
COLUMNS = {"scene": "", "solver": "", "steps": "d", "done": "d", "median": "g", "max": "d", "above": "d", "cuts": "d", "open": ".2f", "violation": ".0e", "seconds": ".1f"}


@dataclass
class Case:
    """One scene."""
    network: str
    joint: str
    permeability: float
    rate: float

    @property
    def name(self):
        return f"{self.network}, {self.joint}, k {self.permeability:g}, rate {self.rate:g}"

    def scene(self, solver, steps):
        file, mesh = NETWORKS[self.network]
        sets = (f"Mesh.cells={mesh}", f"Materials.granite.permeability={{{self.permeability:g}}}", f"Flow.Wells.injector.rate={self.rate:g}*min(t/7200, 1)",
                f"Time.end={END:g}", f"Time.steps={steps}", f"Solver.Linear solver.type={solver}")
        return Scene(f"{self.name}, {solver}, {steps}", f"poro/{file}.xml", sets + JOINTS[self.joint])


NETWORKS = {"three": ("injection_cross_2d", "{20, 20}"), "eleven": ("injection_2d", "{20, 20}"), "3D": ("injection_3d", "{10, 10, 10}")}


def cases():
    """Yields the cases. The smallest rate barely opens a joint, the largest opens all by centimetres. m^2/s; 3D:
    m^3/s."""
    for joint in JOINTS:
        for permeability in PERMEABILITIES:
            for rate in (6e-5, 2e-4, 5e-4):
                yield Case("three", joint, permeability, rate)
    for joint in ("mated", "closed"):
        for rate in (6e-5, 2e-4, 3e-4):
            yield Case("eleven", joint, 1e-17, rate)
        for permeability, rate in zip(PERMEABILITIES, (5e-3, 2e-2, 2e-2)):
            yield Case("3D", joint, permeability, rate)


def asked(run, steps):
    """Yields messages of missed targets other than failures."""
    if run.cuts > CUTS * steps:
        yield f"{run.cuts} cuts in {steps} steps, required: at most one in ten"
    if max(run.newton, default=0) > MAXIMUM:
        yield f"{max(run.newton)} Newton iterations in a step, at most {MAXIMUM} required"


def row(case, solver, steps, run):
    if not run.steps or not run.steps[-1].get("fractures"):
        return [case.name, solver, steps, 0, 0, 0, 0, 0, 0, 0, run.seconds]
    worst = 0 if run.worst is None else float(run.worst.max())
    return [case.name, solver, steps, len(run.steps), float(np.median(run.newton)), max(run.newton), sum(n > MAXIMUM for n in run.newton), run.cuts,
            run.fraction("open"), worst, run.seconds]


def main(words):
    options = common.parser("injection", __doc__, "four runs of ten steps; the status is also 1 above a stated bound", "scenes", sets=False).parse_args(words)
    chosen = [(case, *how) for case in cases() for how in RUNS]
    if options.quick:
        chosen = [(case, solver, steps) for case, solver, steps in chosen if case.network == "three" and case.permeability == 1e-17 and steps == 10
                  and case.rate in (2e-4, 5e-4) and case.joint != "hard" and solver == ("iterative" if case.joint == "mated" else "direct")]
    chosen = common.matching(options, chosen, lambda run: run[0].scene(*run[1:]).name)
    printed, runs, beyond = table.Table(COLUMNS, 38), [], []
    for case, solver, steps in chosen:
        run = contact.judge(contact.start(options, case.scene(solver, steps), 1))
        if run.worst is not None and run.worst.max() > contact.BOUNDS["worst_violation"]:
            run.failures.append(f"a law is violated by {run.worst.max():.0e}")
        printed.add(row(case, solver, steps, run), run.failures)
        runs.append(run)
        beyond += [f"requirement not met: {run.scene.name}: {what}" for what in asked(run, steps)]
    newton = [n for run in runs for n in run.newton]
    total = {"failures": sum(bool(run.failures) for run in runs), "newton_median": np.median(newton or [np.nan]), "newton_max": max(newton, default=0),
             "cuts": sum(run.cuts for run in runs)}
    print("\n".join(["", f"{len({case.name for case, *_ in chosen})} scenes, {len(runs)} runs, {len(newton)} steps in {sum(run.seconds for run in runs):.0f} s", *beyond]))
    bounds = QUICK if options.quick and not options.only else {}
    return table.finish(options, printed, total, {"newton_median": "g"}, bounds) or int(total["failures"] > 0)
