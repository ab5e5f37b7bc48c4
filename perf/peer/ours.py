"""Runs of Sprekk with costs and errors: tilted fracture, THM block, flow, and the cracks of perf/verification."""
import math
from pathlib import Path

import numpy as np
import read

from perf.common import program
from perf.peer.runs import FUNCTIONALS, THERMAL, Run
from perf.verification import exact, flow_cases, flow_measure, measure, meshes, scenes

COUNTED = ("mesh", "set-up", "set-up_of_the_solver", "time_steps")  # consecutive phases
MEAN = "mean pressure"
REPEATED = 3  # short runs: the median counts
TILTED, THM = (Path(__file__).resolve().parent / scene for scene in ("tilted.xml", "thm.xml"))
HEAT_OF_WATER, HOT, COLD = 4.2e6, 420, 360  # of the THM case: J/(m^3 K), K
MODES = {"opening": ("sneddon", exact.Crack(1, 1e-3, 1, 0.25)), "sliding": ("sneddon_shear", exact.Crack(2, 1e-3, 1, 0.25))}


def run(options, scene, sets, name):
    """Returns (directory, results.json, median CPU seconds): of the COUNTED phases, for adaptive runs of the whole
    process."""
    directory, seconds = options.output / name, []
    for _ in range(REPEATED):
        before = program.cpu_seconds()
        found = program.succeeded(options.binary, scene, directory, (*sets, *options.set), clock=900)
        whole = program.cpu_seconds() - before
        seconds.append(whole if "accuracy" in found.results else found.time(*COUNTED, clock="cpu_seconds"))
    return directory, found.results, sorted(seconds)[REPEATED // 2]


def to(quantity, error):
    """Entries of an adaptive run to this relative error of the crack's quantity, with cells of order 2."""
    goal = "Accuracy.quantities.crack"
    return (f"{goal}.quantity={quantity}", f"{goal}.fractures={{crack}}", f"{goal}.relative={error:g}", "Mesh file.order=2")


def made(results, seconds, **more):
    found = program.Run(results=results)
    return Run("Sprekk, adaptive" if "accuracy" in results else "Sprekk", found.cells, found.system, sum(found.newton), seconds, found.bytes[1], **more)


def tilted(options, file, name, *sets):
    _, results, seconds = run(options, TILTED, (f"Mesh file.path={file}", *sets), name)
    step = results["steps"][-1]
    crack = step["fractures"]["crack"]
    traction, jump, force = crack["mean_traction"], crack["mean_jump"]["global"], step["reactions"]["top"]
    values = (crack["max_slip"], crack["mean_slip"], traction["local"][0], *(crack["area"] * traction["global"][i] for i in (0, 2)),
              jump[0], jump[2], force[0], force[2])
    return made(results, seconds, values=dict(zip(FUNCTIONALS, values)))


def thm(options, file, name):
    _, results, seconds = run(options, THM, (f"Mesh file.path={file}",), name)
    step = results["steps"][-1]
    crack, force, leaves = step["fractures"]["crack"], step["reactions"]["top"], -step["inflows"]["east"]
    # heat_inflows does not include heat carried at HOT
    heat = HEAT_OF_WATER * (HOT - COLD) * leaves - step["heat_inflows"]["east"]
    values = (1e3 * crack["max_slip"], 1e3 * crack["mean_slip"], 1e3 * crack["mean_opening"], 1e-6 * crack["mean_traction"]["local"][0],
              1e-6 * crack["mean_fracture_pressure"], crack["mean_fracture_temperature"], 1e-3 * heat, 1e-9 * force[0], 1e-9 * force[2])
    return made(results, seconds, values=dict(zip(THERMAL, values)))


def crack(options, mode, file, name, *sets):
    """Run with the relative errors of the jump: over all faces, and over faces at least a tenth of the half-length
    away from tips."""
    scene, known = MODES[mode]
    directory, results, seconds = run(options, f"verification/{scene}.xml", (f"Mesh file.path={file}", *sets), name)
    faces = read.segments(read.grid(read.written_steps(directory, "fractures")[-1][1]))
    corners = faces.points[np.array([line[:2] for line in faces.polygons])][:, :, :2]
    size, away = measure.area(corners), np.abs(corners[:, :, 0]).max(axis=1) < 0.9
    means, jump = known.jump_mean(corners), faces.cell_data["jump"][:, :2]
    return made(results, seconds, values={f"{mode}{where}": measure.relative(jump - means, means, weights)
                                          for where, weights in (("", size), (", tips left out", size * away))})


def flow(options, kind, cell, n):
    """Run with the mean pressure in the rock of the regular network, with n equal cells along an edge."""
    sets = (f"Mesh.cell={cell}", f"Mesh.cells={{{n}, {n}}}", *flow_cases.JOINTS[kind])
    directory, results, seconds = run(options, scenes.path("verification/flow_regular_2d.xml", options.output / "scenes"), sets, f"flow_{kind}_{cell}_{n}")
    rock = read.grid(read.written_steps(directory, "bulk")[-1][1])
    return made(results, seconds, values={MEAN: float(flow_measure.array(measure.Run(results, rock, None, 2), "pressure").mean())})


def tilted_mesh(folder, h, smallest, growth):
    """Tetrahedral mesh of the block. Edges grow from `smallest` at the fracture front by `growth` per length to h."""
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    along, normal = f"({c:.9g}*(x-0.5)-{s:g}*(z-0.5))", f"({s:g}*(x-0.5)+{c:.9g}*(z-0.5))"
    script = f"""SetFactory("OpenCASCADE");
Box(1) = {{0, 0, 0, 1, 1, 1}};
Rectangle(7) = {{-0.25, -0.25, 0, 0.5, 0.5}};
Rotate{{ {{0, 1, 0}}, {{0, 0, 0}}, Pi/6 }}{{ Surface{{7}}; }}
Translate{{ 0.5, 0.5, 0.5 }}{{ Surface{{7}}; }}
BooleanFragments{{ Volume{{1}}; Delete; }}{{ Surface{{7}}; Delete; }}
Physical Surface("crack") = {{ Surface In BoundingBox{{0.1, 0.1, 0.1, 0.9, 0.9, 0.9}} }};
Physical Surface("bottom") = {{ Surface In BoundingBox{{-0.1, -0.1, -0.1, 1.1, 1.1, 0.1}} }};
Physical Surface("top") = {{ Surface In BoundingBox{{-0.1, -0.1, 0.9, 1.1, 1.1, 1.1}} }};
Physical Volume("rock") = {{Volume{{:}}}};
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
{meshes.QUIET}Field[1].F = "{smallest:g}+{growth:g}*Sqrt({normal}^2+(Max(Abs({along}),Abs(y-0.5))-0.25)^2)";
Mesh.MeshSizeMax = {h:g};
"""
    return meshes.with_gmsh(script, folder / f"tilted_{h:g}_{smallest:g}.msh", 3)
