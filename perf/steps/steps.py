"""Errors and costs of automatic time steps, compared with equal steps."""
import re
import shutil
import sys
from dataclasses import dataclass, field

import numpy as np
import read
from vtkmodules.util.numpy_support import vtk_to_numpy

from perf.common import options as common
from perf.common import program, table

SHARES = (1, 2, 4, 8, 16)  # times of comparison, in 16ths of the end time
TOLERANCES = (3e-2, 1e-2, 3e-3)
COUNTS = (16, 32, 64, 128, 256, 512, 1024)  # numbers of equal steps
BOUNDS = {"worst_miss": 3, "cost": 0.7}
QUICK_COST = 1  # in Newton iterations, at the largest tolerance
TIME_LIMIT = 3600


@dataclass
class Case:
    name: str
    scene: str
    fields: tuple
    end: float
    sets: tuple = ()
    edits: tuple = ()       # (pattern, text) replaced in the scene
    start: dict = field(default_factory=dict)  # reference values subtracted from fields
    reference: int = 4096   # number of equal steps
    counts: tuple = COUNTS
    quick: tuple = ()       # additional entries of coarse meshes


CIRCLE = "{0.3*min(t, 1)*cos(pi*max(t - 1, 0)), 0.3*min(t, 1)*sin(pi*max(t - 1, 0)), -0.1}"
PATH = """<ParameterList name="Tables">
    <ParameterList name="path">
      <Parameter name="arguments" type="Array(double)" value="{0, 7, 17, 31, 40, 57, 70, 84, 96}"/>
      <Parameter name="values" type="Array(double)" value="{0, 0.5, -0.5, 0.5, -0.3, 0.5, -0.5, 0.4, 0}"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">"""
FRICTION = ("traction local", "plastic jump local")
CASES = [
    Case("consolidation, Euler", "verification/terzaghi_2d.xml", ("pressure",), 0.22047799629596967, ("Mesh.cells={4, 40}",)),
    Case("consolidation, BDF2", "verification/terzaghi_2d.xml", ("pressure",), 0.22047799629596967, ("Mesh.cells={4, 40}", "Time.scheme=BDF2")),
    Case("cooling, BDF2", "heat/cooling_2d.xml", ("temperature",), 1e7, start={"temperature": 350}),
    Case("cooling of a fracture, Euler", "thm/cooling_2d.xml", ("temperature", "slip"), 630720000.0, ("Mesh.cells={16, 16}",), start={"temperature": 420}, reference=2048, counts=COUNTS[:5]),
    Case("cooling of a fracture, BDF2", "thm/cooling_2d.xml", ("temperature", "slip"), 630720000.0, ("Mesh.cells={16, 16}", "Time.scheme=BDF2"), start={"temperature": 420}, reference=2048, counts=COUNTS[:5]),
    Case("injection and shut-in, Euler", "poro/shut_in_2d.xml", ("pressure", "slip"), 144000.0, start={"pressure": 1e7}, reference=2560, counts=COUNTS[:6]),
    Case("injection and shut-in, BDF2", "poro/shut_in_2d.xml", ("pressure", "slip"), 144000.0, ("Time.scheme=BDF2",), start={"pressure": 1e7}, reference=2560, counts=COUNTS[:6]),
    Case("shear around a corner", "verification/turning_shear_3d.xml", FRICTION, 2.0, reference=16384),
    Case("shear in a circle", "verification/turning_shear_3d.xml", FRICTION, 3.0, (f"Boundary conditions.moved.displacement={CIRCLE}", "Time.end=3"), reference=16384),
    Case("uneven cycles with damage", "contact/damage_cycles_2d.xml", ("traction local", "slip"), 96.0,
         edits=((r'<ParameterList name="Time">', PATH), (r"0\.5\*sin\(pi\*t/16\)", "path(t)")), reference=7680),
]
QUICK = {"consolidation, Euler", "consolidation, BDF2", "cooling, BDF2", "shear around a corner", "shear in a circle", "uneven cycles with damage", "injection and shut-in, Euler"}


@dataclass
class Run:
    steps: int
    rejected: int
    newton: int
    cpu: float
    states: dict   # [field][number of the time]


def states(directory, case):
    """Reads the fields at the times of comparison."""
    found = {name: {} for name in case.fields}
    for kind in ("bulk", "fractures"):
        for t, file in read.written_steps(directory, kind):
            number = next((k for k, share in enumerate(SHARES) if abs(t - case.end * share / 16) < 1e-9 * case.end), None)
            if number is None:
                continue
            data = read.grid(file).GetCellData()
            for name in case.fields:
                if data.GetArray(name):
                    values = vtk_to_numpy(data.GetArray(name)).astype(float)
                    found[name][number] = values.reshape(len(values), -1) - case.start.get(name, 0)
    return found


def run(options, case, time, sets, name):
    """Runs a case with other time steps; `time` contains XML entries of the section Time."""
    text = (program.ROOT / "xml" / case.scene).read_text()
    for pattern, replacement in case.edits:
        text = re.sub(pattern, replacement, text)
    text = re.sub(r'\s*<Parameter name="(?:steps|tolerance|schedule)"[^>]*/>', "", text)
    text = text.replace('<ParameterList name="Time">', '<ParameterList name="Time">' + time)
    folder = options.output / re.sub(r"[^\w.+-]+", "_", f"{case.name} {name}")
    scene = folder.with_name(f"{folder.name}.xml")
    scene.write_text(text)
    found = program.succeeded(options.binary, scene, folder, (*case.sets, *sets, *(case.quick if options.quick else ())), clock=TIME_LIMIT)
    steps = found.steps
    newton = sum(step["newton_iterations"] + step.get("rejected_newton_iterations", 0) for step in steps)
    result = Run(len(steps), sum(step.get("rejected", 0) for step in steps), newton, found.time("time_steps", "choice_of_steps", clock="cpu_seconds"),
                 states(folder, case))
    shutil.rmtree(folder)
    scene.unlink()
    return result


def equal(options, case, n, sets=()):
    return run(options, case, f'<Parameter name="steps" type="int" value="{n}"/>', (f"Output.every={n // 16}", *sets), f"{n} steps")


def chosen(options, case, tolerance):
    times = ", ".join(repr(case.end * share / 16) for share in SHARES)
    return run(options, case, f'<Parameter name="tolerance" type="double" value="{tolerance!r}"/><Parameter name="schedule" type="Array(double)" value="{{{times}}}"/>',
               ("Output.every=1",), f"tolerance {tolerance:g}")


def error(found, reference):
    """Largest error over fields and times: the root mean square over cells or faces, relative to the largest value
    of the reference."""
    worst = 0.0
    for name, exact in reference.states.items():
        size = max(np.sqrt((values**2).sum(axis=1)).max() for values in exact.values())
        for number, values in exact.items():
            difference = found.states[name][number] - values
            worst = max(worst, float(np.sqrt((difference**2).sum(axis=1).mean()) / size))
    return worst


def at_error(wanted, runs):
    """(steps, Newton iterations, CPU seconds) of equal steps with the error `wanted`, by log-log interpolation
    between runs.

    Beyond the finest run the last two are extrapolated, with at least first order."""
    below = [k for k, (e, _) in enumerate(runs) if e <= wanted]
    k = below[0] if below else len(runs) - 1
    numbers = [np.array([run.steps, run.newton, run.cpu]) for _, run in runs]
    if k == 0:
        return numbers[0]
    (coarse, _), (fine, _) = runs[k - 1], runs[k]
    if not below:
        fine = min(fine, coarse / 2)  # corners of tables can prevent a decrease between two runs
    s = np.log(coarse / wanted) / np.log(coarse / max(fine, 1e-300))
    return numbers[k - 1] ** (1 - s) * numbers[k] ** s


def draw(rows, file):
    import style
    names = list(dict.fromkeys(row["case"] for row in rows))
    figure, axes = style.plt.subplots(2, (len(names) + 1) // 2, figsize=(3 * ((len(names) + 1) // 2), 6), squeeze=False)
    for axis, name in zip(axes.flat, names):
        for kind, colour, marker in (("equal", style.LINES[0], "o"), ("chosen", style.LINES[1], "s")):
            of = [row for row in rows if row["case"] == name and row["kind"] == kind and row["error"] > 0]
            axis.plot([row["cpu"] for row in of], [row["error"] for row in of], color=colour, marker=marker, markersize=4, label=kind)
        axis.set(xscale="log", yscale="log", title=name, xlabel="CPU seconds (s)", ylabel="error (-)")
        axis.title.set_fontsize(8)
    axes.flat[0].legend()
    figure.tight_layout()
    figure.savefig(file, dpi=150)


def main(words):
    quick = "fewer cases, one tolerance; with bounds on Newton iterations instead of seconds"
    options = common.parser("steps", __doc__, quick, "cases", sets=False).parse_args(words)
    chosen_cases = [case for case in common.matching(options, CASES, lambda case: case.name) if not options.quick or options.only or case.name in QUICK]
    rows, failed, misses, costs = [], [], {}, {}
    print(f"{'case':32} {'kind':>16} {'steps':>6} {'rejected':>8} {'Newton':>7} {'CPU s':>8} {'error':>9} {'miss':>6} {'cost':>6}")

    def add(case, kind, label, run, e, miss="", cost=""):
        rows.append({"case": case.name, "kind": kind, "steps": run.steps, "rejected": run.rejected, "newton": run.newton, "cpu": run.cpu, "error": e, "miss": miss, "cost": cost})
        numbers = [f"{value:6.2f}" if value != "" else " " * 6 for value in (miss, cost)]
        print(f"{case.name:32} {label:>16} {run.steps:6d} {run.rejected:8d} {run.newton:7d} {run.cpu:8.3f} {e:9.2e} {numbers[0]} {numbers[1]}", flush=True)

    for case in chosen_cases:
        try:
            counts = case.counts[:4] if options.quick else case.counts
            second_order = ("Time.scheme=BDF2",) if case.start or "pressure" in case.fields else ()
            reference = equal(options, case, case.reference // (8 if options.quick else 1), second_order)
            runs = []
            for n in counts:
                result = equal(options, case, n)
                runs.append((error(result, reference), result))
                add(case, "equal", f"{n} equal", result, runs[-1][0])
            for tolerance in TOLERANCES[:1] if options.quick else TOLERANCES:
                result = chosen(options, case, tolerance)
                e = error(result, reference)
                _, newton, cpu = at_error(e, runs)
                cost = result.newton / newton if options.quick else result.cpu / cpu
                misses.setdefault(case.name, []).append(e / tolerance)
                costs.setdefault(case.name, []).append(cost)
                add(case, "chosen", f"tolerance {tolerance:g}", result, e, e / tolerance, cost)
        except (program.Failed, KeyError, read.PlotError) as reason:
            failed.append(f"failed: {case.name}: {reason}")
            print(failed[-1])
    if not costs:
        sys.exit("\n".join(failed))
    table.write(options.output / "steps.csv", rows[0], [row.values() for row in rows])
    draw(rows, options.output / "steps.png")
    worst = max(max(of) for of in misses.values())
    means = {name: float(np.exp(np.mean(np.log(of)))) for name, of in costs.items()}
    cost = max(means.values())
    wrong = [f"missed: {name}: error {max(of):.2f} times the tolerance" for name, of in misses.items() if max(of) > BOUNDS["worst_miss"]]
    maximum = QUICK_COST if options.quick else BOUNDS["cost"]
    wrong += [f"missed: {name}: cost {mean:.2f} of equal steps" for name, mean in means.items() if mean > maximum]
    print("\n".join(["", f"steps.csv and steps.png in {options.output}", *failed, *wrong]))
    print(f"failures={len(failed)} worst_miss={worst:.2f} cost={cost:.2f}")
    return 1 if failed or (options.quick and wrong) else 0
