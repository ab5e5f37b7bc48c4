"""OpenGeoSys and Sprekk on the same meshes: values, errors, CPU seconds and memory; CPU seconds at equal error.

The environment variable OGS names the program of OpenGeoSys 6.5.9."""
import json
import math
import os
import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from perf.common import program, table
from perf.common.program import Failed
from perf.peer import runs
from perf.peer.ogs import cases, exact, meshes, project

WHY = """peer: no comparison with OpenGeoSys: set OGS to its program, of version 6.5.9 if possible:
  python3 -m venv build/ogs && build/ogs/bin/pip install ogs==6.5.9
  OGS=build/ogs/bin/ogs ./sprekk perf peer --only ogs"""
CODES = ("OpenGeoSys", "Sprekk")
LIMIT = 180      # CPU seconds of a run
CORE = min(os.sched_getaffinity(0))  # of both programs
GRADED = 24, 2.5e-4  # rows of the strip, height of those at the fracture in m
# {case: arguments of the function in cases.py}: both programs, further meshes of Sprekk
MESHES = {
    "cross": ([(1,), (2,), (4,), (8,)], []),
    "strip": ([(25, 46), (12, *GRADED), (25, *GRADED), (50, *GRADED)], [(100, *GRADED), (200, *GRADED)]),
    "strip, impermeable rock": ([(12, 10), (25, 10), (50, 10)], [(100, 10), (200, 10), (400, 10)]),
    "fault_ramp": ([(16,), (32,), (64,)], [(128,)]),
}
QUICK = {"cross": 3, "strip": 1, "strip, impermeable rock": 2, "fault_ramp": 2}  # meshes of both
RESULT = {"cross": "ratio_cross", "strip": "ratio_strip", "strip, impermeable rock": "ratio_strip_impermeable",
          "fault_ramp": "ratio_fault_ramp"}
ASKED = dict.fromkeys(RESULT.values(), 3)
COLUMNS = {"case, mesh, code": "", "unknowns": "d", "Newton": "d", "volume (m2)": ".4e", "rel. error": ".5f",
           "slip (m2)": ".4e", "slip error": ".5f", "CPU s": ".2f", "MB": ".0f"}
EQUAL = {"at equal error": "", "reference": ".4e", "uncertainty": ".1e", "rel. error": ".5f",
         "their mesh": "", "our mesh": "", "their CPU s": ".2f", "our CPU s": ".2f", "ratio": ".2f"}


@dataclass
class Run(runs.Run):
    mesh: str = ""


def costs(words, log):
    """Runs a command on one core; returns (CPU seconds, peak bytes). Raises Failed for a status other than 0."""
    pinned = ["taskset", "-c", CORE, "prlimit", f"--cpu={LIMIT}", *words]
    said = program.checked([sys.executable, "-S", "-B", Path(__file__).with_name("cost.py"), log, *pinned])
    status, seconds, peak = map(float, said.split())
    if status:
        raise Failed(f"{program.last_line(log.read_text())} (status {status:.0f}, {log})")
    return seconds, peak


def integrals(grid, edges):
    """Integrals (m^2) of the normal and tangential jump of OpenGeoSys along the first fracture, which has `edges`."""
    import read
    jump = read.vtk_to_numpy(grid.GetPointData().GetArray("displacement_jump1"))
    points, kinds = (read.vtk_to_numpy(array) for array in (grid.GetPoints().GetData(), grid.GetCellTypesArray()))
    found = np.zeros(2)
    for cell in np.flatnonzero(np.isin(kinds, [meshes.VTK["line", order] for order in (1, 2)]))[:edges]:
        nodes = grid.GetCell(int(cell)).GetPointIds()
        nodes = [nodes.GetId(k) for k in range(nodes.GetNumberOfIds())]  # ends, middle
        x, y = points[nodes[1], :2] - points[nodes[0], :2]
        weights = (1 / 2, 1 / 2) if len(nodes) == 2 else (1 / 6, 1 / 6, 4 / 6)
        found += np.array([[-y, x], [x, y]]) @ (weights @ jump[nodes, :2])
    return {"volume": abs(found[0]), "slip": abs(found[1])}


def theirs(options, name, made, mesh):
    """Run of OpenGeoSys."""
    import read
    folder = options.output / f"ogs_{name}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    made.mesh.vtu(folder / "mesh.vtu", made.order)
    project.save(folder / "sides.gml", "OpenGeoSysGLI", made.geometry)
    file = project.save(folder / "case.prj", "OpenGeoSysProject", made.project)
    log = options.output / f"ogs_{name}.txt"
    seconds, peak = costs([options.ogs, "-o", folder, file], log)
    newton = len(re.findall(r"Iteration #\d+ took", log.read_text()))
    last = max(folder.glob("result_*.vtu"), key=lambda one: int(one.stem.split("_")[1]))
    grid = read.output(read.vtkXMLUnstructuredGridReader(), last)
    values = integrals(grid, len(made.mesh.lines[made.mesh.fractures[0]]))
    return Run(CODES[0], len(made.mesh.cells), made.unknowns, newton, seconds, peak, values, mesh)


def ours(options, name, made, mesh, before):
    """Run of Sprekk; `before`: size of closure and tangential jump by the initial stress, m."""
    directory, log = options.output / f"sprekk_{name}", options.output / f"sprekk_{name}.txt"
    shutil.rmtree(directory, ignore_errors=True)
    file = made.mesh.gmsh(options.output / f"{name}.msh")
    entries = (f"Mesh file.path={file}", *made.sets, *options.set)
    seconds, peak = costs(program.command(options.binary, made.scene, directory, entries), log)
    found = program.Run(results=json.loads((directory / "results.json").read_text()))
    of = found.steps[-1]["fractures"][made.mesh.fractures[0]]
    normal, tangential = of["mean_jump"]["local"]
    values = {"volume": of["area"] * (normal + before[0]), "slip": of["area"] * (abs(tangential) - before[1])}
    return Run(CODES[1], found.cells, found.system, sum(found.newton), seconds, peak, values, mesh)


def made(case, words):
    """Case on the mesh of these arguments, its name, and the jump before injection in m."""
    if case == "cross":
        return cases.cross(*words), f"{5 / words[0]:g} mm", (0, 0)
    if case == "fault_ramp":
        return cases.fault_ramp(*words), f"{words[0]} edges", [-x / cases.JOINT for x in cases.INITIAL]
    name = f"{words[0]} x {words[1]}" + ", graded" * (len(words) > 2)
    return cases.strip(*words, tight=case != "strip"), name, (-cases.CLOSING / cases.BAR["Kn"], 0)


def limit(values):
    """Limit of values on meshes with halved cells, of the observed order; the order is at least 1 and at most 2."""
    *_, middle, last = values
    change = last - middle
    earlier = middle - values[-3] if len(values) > 2 and middle != values[-3] else 4 * change
    ratio = min(max(change / earlier if earlier else 0, 0.25), 0.5)
    return last + change * ratio / (1 - ratio)


def reference(case, found):
    """{quantity: (reference, its relative uncertainty)}; found {code: [run]}.

    For fault_ramp: mean of the limits of both programs; the uncertainty is half their difference, and at least the
    smaller distance of a finest mesh from its limit. Else: solutions of exact.py."""
    if case == "cross":
        plate = cases.PLATE
        values = [exact.crack_area(plate["E"], plate["nu"], plate["load"], 0.01, 0.025, 0.05, plate["Kn"], terms)
                  for terms in (32, 40)]
    elif case == "fault_ramp":
        known = {}
        for name in ("volume", "slip"):
            values = [[run.values[name] for run in of] for of in found.values()]
            ends = [limit(of) for of in values]
            mean = sum(ends) / 2
            last = min(abs(end - of[-1]) for end, of in zip(ends, values))
            known[name] = mean, max(abs(ends[0] - ends[1]) / 2, last) / abs(mean)
        return known
    else:
        rock = cases.ROCK if case == "strip" else cases.TIGHT
        coarse, fine = (exact.strip_volume(n, **cases.BAR, **rock) for n in (400, 800))
        values = [fine, (4 * fine - coarse) / 3]
    return {"volume": (values[1], abs(values[0] / values[1] - 1))}


def at_equal_error(found, exact, name):
    """Smallest error of the quantity that both programs reach, at least the uncertainty of the reference, and the
    least expensive run of each with at most this error on this and all finer meshes."""
    value, uncertainty = exact[name]

    def error(run):
        return abs(run.values[name] / value - 1)
    level = max(uncertainty, *(min(map(error, of)) for of in found.values()))
    # a rounded quotient must not exclude the run that defines the level
    return level, [runs.cheapest(of, error, level * (1 + 1e-9)) for of in found.values()]


def row(run, exact):
    values = [entry for name in ("volume", "slip") for entry in
              ((run.values[name], abs(run.values[name] / exact[name][0] - 1)) if name in exact else (None, None))]
    return [run.unknowns, run.newton, *values, run.seconds, run.bytes / 1e6]


def compare(options):
    """Runs all cases. Prints and writes peer_ogs.csv and peer_ogs_equal.csv; returns {name: ratio of CPU seconds}."""
    rows, equal, ratios = [], [], {}
    for case, (both, further) in MESHES.items():
        if options.quick:
            both, further = both[:QUICK[case]], []
        found = {code: [] for code in CODES}
        for words in both + further:
            of, mesh, before = made(case, words)
            name = re.sub(r"\W+", "_", f"{case} {mesh}")
            if words in both:
                found["OpenGeoSys"].append(theirs(options, name, of, mesh))
            found["Sprekk"].append(ours(options, name, of, mesh, before))
        known = reference(case, found)
        printed = table.Table(COLUMNS, 50)
        for run in sorted((run for of in found.values() for run in of), key=lambda run: (run.cells, run.mesh)):
            printed.add([f"{case}, {run.mesh}, {run.code}", *row(run, known)])
            rows.append([case, run.mesh, run.code, *row(run, known)])
        printed = table.Table(EQUAL, 50)
        for name, (value, uncertainty) in known.items():
            level, (their, our) = at_equal_error(found, known, name)
            meshes_seconds = [each and getattr(each, what) for what in ("mesh", "seconds") for each in (their, our)]
            printed.add([f"{case}, {name}", value, uncertainty, level, *meshes_seconds, runs.ratio(their, our)])
            equal.append([case, name, *printed.rows[-1][1:]])
            key = RESULT[case]
            ratios[key] = min(ratios.get(key, math.inf), runs.ratio(their, our))
        print()
    table.write(options.output / "peer_ogs.csv", ["case", "mesh", "code", *list(COLUMNS)[1:]], rows)
    table.write(options.output / "peer_ogs_equal.csv", ["case", "quantity", *list(EQUAL)[1:]], equal)
    return ratios
