"""Estimated and measured costs of factors and of multigrid for the pressure of faces, from which the solver selects one of them."""
from perf.common import options as common
from perf.common import table
from perf.common.program import measured

SYSTEMS = {  # scene, refinements of its mesh
    "discs 3D, 3018": ("discs", 0), "discs 3D, 22388": ("discs", 1), "traces 2D, 27092": ("traces", 2), "traces 2D, 106704": ("traces", 3)}
STORAGE = ("Flow.compressibility=4.5e-10", "Materials.rock.porosity=0.01")  # the Jacobian then depends on the step
COUNTS = ("operations", "entries")
COLUMNS = {"system: quantity": "", "estimated": ".3g", "measured": ".3g", "ratio": ".2f"}
BOUNDS = {"ratio_of_counts": 2}


def rows(found):
    """Returns (quantity, estimated, measured) of one system."""
    both = found["estimated"], found["measured"]
    yield from ((name, *(values[name] for values in both)) for name in COUNTS)
    for inverse in ("factors", "multigrid"):
        for part in ("set-up", "application"):
            yield f"{part} of {inverse}, ms", *(1e3 * values[inverse][part] for values in both)


def measure(options):
    options.program, options.name = options.program.with_name("factors"), "factors"
    printed, ratios = table.Table(COLUMNS, 50), {True: [], False: []}
    for system in common.matching(options, list(SYSTEMS)[:1 if options.quick else None]):
        scene, refinements = SYSTEMS[system]
        found = measured(options, f"performance/flow_{scene}.xml", (f"Mesh file.refinements={refinements}", *STORAGE), options.ranks)
        for quantity, estimated, value in rows(found):
            printed.add([f"{system}: {quantity}", estimated, value, estimated / value])
            ratios[quantity in COUNTS].append(estimated / value)
    worst = {f"ratio_of_{kind}": max(max(of), 1 / min(of)) for kind, of in zip(("counts", "times"), ratios.values())}
    return table.finish(options, printed, worst, {name: ".2f" for name in worst}, BOUNDS)
