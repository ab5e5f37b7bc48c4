"""Runs with the iterative solver, and entries of the scene with blocks and all contact states."""
from perf.common import program

SCENE = "performance/blocks_3d.xml"
SOLVER = "Solver.Linear solver"
RESIDUAL = 1e-8  # relative tolerance of every linear solve
ROUNDING = 10    # allowed ratio of the true residual to the residual updated by the Krylov method
ALWAYS = (f"{SOLVER}.type=iterative", f"{SOLVER}.tolerance={RESIDUAL:g}", f"{SOLVER}.forcing=false")


def run(options, sets, directory, ranks=1, time_limit=3600, scene=SCENE, residual=lambda run: run.residual):
    """Runs the scene with these entries, then those of the command line. A failed program is recorded in
    `failure`, without exception.

    residual(run) must be below the tolerance times ROUNDING."""
    found = program.run(options.binary, scene, options.output / directory, entries(options, sets), ranks, clock=time_limit)
    if found.status is None:
        found.failure = f"no end within {time_limit} s"
    elif found.status:
        found.failure = found.reason
    elif (residual(found) or 0) > ROUNDING * RESIDUAL:
        found.failure = f"true residual {residual(found):.1e} after a linear solve"
    return found


def entries(options, sets):
    return (*ALWAYS, *sets, *options.set)


def table(shear, **values):
    """Entries for the displacements of the sides; xy, xz, yz are `shear` unless given."""
    return tuple(f"Tables.{name}.values={{0, {value}}}" for name, value in {"xy": shear, "xz": shear, "yz": shear, **values}.items())


def cells(x, y=None, z=None):
    return (f"Mesh.cells={{{x}, {y or x}, {z or x}}}",)


def joint(**entries):
    names = dict(stiffness="tangential stiffness", friction="friction coefficient", dilation="dilation angle",
                 closure="maximum closure", normal="normal stiffness")
    return tuple(f"Materials.joint.{names[key]}={value}" for key, value in entries.items())
