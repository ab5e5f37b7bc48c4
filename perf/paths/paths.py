"""Growth along free paths: wings of a sliding flaw, injection into a straight crack between rollers, crossing of fractures.

The rows of the wings compare tip, load and direction with a boundary integral method, with K_II = 0 along the path. The
rows of injection compare pressure and length with the exact crack that contains the fluid. Those of crossing
compare the margin of crossing with the criterion at given far stresses. The last line gives the number of failures and
of wrong outcomes, the largest errors of tips (relative to the half-length of the flaw), loads and pressures, the median
of Newton iterations per step, and the share of time for changes of the mesh."""
import math
import statistics

from perf.common import options as common
from perf.common import program, table
from perf.paths import crossing

COLUMNS = {"row": "", "length": ".4f", "error of the tip": ".2%", "load": ".4g", "exact load": ".4g", "error": ".2%", "newton": "d", "seconds": ".1f"}
BOUNDS = {"failures": 0, "wrong": 0, "worst_tip": 0.005, "worst_load": 0.01, "worst_pressure": 0.01, "newton_median": 6, "remeshing": 0.3}
FORMATS = {"worst_tip": ".4f", "worst_load": ".4f", "worst_pressure": ".4f", "newton_median": ".0f", "remeshing": ".2f"}
REMESHING = ("growth", "refinement")  # timers

# Tip of the right wing at its length, and s1 (pi c)^(1/2)/K_c at which it grows further: steps of 0.1 c, 45 degrees,
# friction 0.3; boundary elements with exact contact, K_II = 0 at each tip.
WINGS = {0.1: ((1.0290, 0.0957), 3.246), 0.2: ((1.0662, 0.1885), 3.869), 0.4: ((1.1578, 0.3662), 5.026), 0.6: ((1.2647, 0.5352), 6.138)}

RATE, RESIDUAL, MODULUS, WIDTH, TOUGHNESS, SEGMENT = 1e-6, 1e-6, 32e9, 2, 1e6, 0.05
INJECTION = ["Mesh.order=2", "Mesh.lower corner={0, -4}", f"Mesh.upper corner={{{WIDTH}, 4}}", "Mesh.cells={10, 40}", f"Growth.segment={SEGMENT}",
             f"Fractures.crack.toughness={TOUGHNESS}", "Time.schedule={2, 10, 20, 25, 30, 35, 40, 45, 50, 55, 60}",
             *(f"Boundary conditions.{side}.{entry}" for side in ("west", "east") for entry in (f"boundary={side}", "displacement={0, free}")),
             *(f"Boundary conditions.{side}.traction={{0, 0}}" for side in ("top", "bottom")),
             "Materials.rock.permeability={0}", f"Materials.joint.residual aperture={RESIDUAL}", "Flow.viscosity=1e-6", "Flow.compressibility=4.5e-10",
             "Flow.initial pressure=0", f"Fractures.crack.source=x < 0.4 ? {RATE}/0.4 : 0"]


def tips(step):
    """x, y and intensity of the hoop stress of each tip, from left to right."""
    found = step["stress_intensity"]
    return sorted(zip(found["x"], found["y"], found["K_hoop"]))


def wings(run, shown):
    """Adds the rows of the first state at each length. The intensity is proportional to the load."""
    errors, known = [], set()
    for step in run.steps:
        x, y, K = tips(step)[-1]
        length = round(math.hypot(x - 1, y), 1)
        if length not in WINGS or length in known:
            continue
        known.add(length)
        exact, exact_load = WINGS[length]
        load = step["time"] * 1e6 / K
        errors.append((math.dist((x, y), exact), abs(load / exact_load - 1)))
        shown.add([f"wing, L = {length} c", length, errors[-1][0], load, exact_load, errors[-1][1], step["newton_iterations"], run.seconds])
    if known != set(WINGS):
        raise program.Failed("a wing does not reach its length")
    return [max(one) for one in zip(*errors)]


def pressure_of(a, volume):
    """Pressure that opens the half of a crack of half-length a between rollers to a volume, from dv/da = 4 K^2/(E' p^2)."""
    return volume * math.pi * MODULUS / (-8 * WIDTH**2 * math.log(math.cos(math.pi * a / (2 * WIDTH))))


def longest(volume):
    """Length at which the toughness is reached with this volume."""
    a = 0.6
    while pressure_of(a, volume) * math.sqrt(2 * WIDTH * math.tan(math.pi * a / (2 * WIDTH))) > TOUGHNESS:
        a += 1e-4
    return a


def injection(run, shown):
    """Adds rows of injection; the error of the tip is the part outside of the segment that the exact length begins."""
    errors = []
    for step in run.steps[1:]:  # the residual aperture matters in the first one
        (x, _, _), = tips(step)
        crack = step["fractures"]["crack"]
        exact, a = pressure_of(x, crack["fluid_volume"]), longest(crack["fluid_volume"])
        errors.append((max(a - x, x - a - SEGMENT, 0) / a, abs(crack["mean_fracture_pressure"] / exact - 1)))
        shown.add([f"injection, {step['time']:.0f} s", x, errors[-1][0], crack["mean_fracture_pressure"], exact, errors[-1][1], step["newton_iterations"], run.seconds])
    return [max(one) for one in zip(*errors)]


def crossings(options, shown, failed):
    """Runs all cases and adds their rows, with margins as loads. Returns the runs and the number of wrong outcomes."""
    runs, wrong = [], 0
    for case, (*stresses, crosses) in crossing.CASES.items():
        scene = crossing.write_scene(options.output / case, case)
        try:
            run = program.succeeded(options.binary, scene, options.output / case / "out", ["Output.vtu=false", *options.set])
        except program.Failed as reason:
            failed.append(f"failed: crossing {case}: {reason}")
            print(failed[-1], flush=True)
            continue
        met, exact = crossing.meeting(run.steps), crossing.exact_margin(*stresses)
        margin = met and met.get("margin")
        wrong += margin is None or (met["state"] == "crosses") != crosses
        runs.append(run)
        shown.add([f"crossing {case}: {met['state'] if met else 'none'}", met and met["x"], None, margin, exact,
                   None if margin is None else margin - exact, run.newton[-1], run.seconds])
    return runs, wrong


NONE = (math.nan, math.nan)
RUNS = (("wings", "growth/wing_cracks_2d.xml", [], wings), ("injection", "growth/edge_crack_2d.xml", INJECTION, injection))


def main(words):
    options = common.parser("paths", __doc__, only=None).parse_args(words)
    shown, failed, found, runs = table.Table(COLUMNS, 24), [], {}, []
    for name, scene, entries, rows in RUNS[1:] if options.quick else RUNS:
        try:
            run = program.succeeded(options.binary, scene, options.output / name, [*entries, "Output.vtu=false", *options.set])
            found[name] = rows(run, shown)
        except program.Failed as reason:
            failed.append(f"failed: {name}: {reason}")
            print(failed[-1], flush=True)
            continue
        runs.append(run)
    wrong = 0
    if not options.quick:
        crossed, wrong = crossings(options, shown, failed)
        runs += crossed
    newton = [iterations for run in runs for iterations in run.newton]
    spent = sum(run.results["timing"].get(one, {}).get("seconds", 0) for run in runs for one in REMESHING)
    whole = sum(run.seconds for run in runs)
    values = {"failures": len(failed), "wrong": wrong, "worst_tip": max((one[0] for one in found.values()), default=math.nan), "worst_load": found.get("wings", NONE)[1],
              "worst_pressure": found.get("injection", NONE)[1], "newton_median": statistics.median(newton) if newton else math.nan, "remeshing": spent / whole if whole else math.nan}
    bounds = {"failures": 0, "worst_pressure": 0.01} if options.quick else BOUNDS
    return table.finish(options, shown, values, FORMATS, bounds, failed)
