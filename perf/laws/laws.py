"""Laws of joints on fracture networks: convergence of Newton's method with every law, agreement of the state with the law, and
cost of the law compared with Coulomb friction. For anisotropic damage also: cost of a step after ten thousand steps."""
import shutil
import xml.etree.ElementTree as xml
from dataclasses import dataclass, replace

import numpy as np
import violation

from perf.common import options as common
from perf.common import table
from perf.common.program import measured as measured_by
from perf.common.program import ROOT, TIMERS
from perf.networks import networks

BOUNDS = {"newton_median": 6, "newton_max": 15, "worst_violation": 1e-8}  # limits of --quick when it serves as a test
ASKED = {**BOUNDS, "cost": 1.3, "growth": 0.02}
HISTORY = "elastic-plastic jump: history of laws"
COLUMNS = {"law, network": "s", "faces": "d", "steps": "d", "median": ".1f", "max": "d", "cuts": "d", "violation": ".0e", "cost": ".2f",
           "bytes/face": "d", "history +-": ".1e"}
TURNS, TURN = "point/damage_turns.xml", 64  # steps
LATE = 10_000
TIME_LIMIT = 300  # CPU seconds per run; longer runs count as failed

STIFF = {"tangential stiffness": "50 GPa/m"}
CLOSES = {**STIFF, "maximum closure": "0.2 mm", "normal stiffness": "50 GPa/m"}
COULOMB = {**CLOSES, "friction coefficient": 0.6, "dilation angle": 5}
ROUGH = {"joint roughness coefficient": 8, "joint wall strength": "100 MPa", "joint length": 1}
WEARS = {"residual part of friction": 0.8, "damage length of friction": "5 mm", "residual part of dilation": 0.3,
         "damage length of dilation": "5 mm"}
LAWS = {
    "Coulomb": COULOMB,
    "Coulomb with cohesion": {**COULOMB, "bond": "linear softening", "cohesion": "1 MPa", "shear fracture energy": 1000,
                              "tensile strength": "0.5 MPa", "fracture energy": 100},
    "mobilised Barton-Choubey": {**STIFF, **ROUGH, "friction": "mobilised Barton-Choubey", "residual friction angle": 28,
                                 "dilation": "mobilised", "closure": "Bandis", "joint aperture": "0.2 mm"},
    "composed": {**CLOSES, "friction": "composed", "basic friction coefficient": 0.5, "asperity angle": 6,
                 "asperity friction coefficient": 0.2, "transition stress": "100 MPa", "dilation angle": 5},
    "slip weakening": {**COULOMB, "friction": "slip weakening", "residual friction coefficient": 0.5, "weakening distance": "5 mm"},
    "isotropic damage": {**COULOMB, **WEARS, "damage": "isotropic"},
    "anisotropic damage": {**COULOMB, **WEARS, "damage": "anisotropic"},
}


@dataclass
class Measured:
    run: object
    seconds: float = 0  # CPU seconds per step

    @property
    def history(self):
        """(bytes of history per face, error bound of a history)."""
        blocks, mesh = self.run.results.get("blocks", {}), self.run.results.get("mesh", {})
        saved = sum(h["bytes"] for h in blocks.get("histories", []) if h["name"] == HISTORY)
        return saved // max(1, mesh.get("fracture_faces", 1)), max(self.run.results.get("error_bounds", {}).values(), default=None)


def scene_with(network, law, directory):
    """Writes a copy of the network's scene with the joint of this law; returns its path."""
    source = networks.scene_of(network)
    tree = xml.parse(source)
    joint = tree.getroot().find("./ParameterList[@name='Materials']/ParameterList[@name='joint']")
    for entry in list(joint):
        joint.remove(entry)
    for name, value in {"type": "joint", **LAWS[law]}.items():
        xml.SubElement(joint, "Parameter", name=name, type="string" if isinstance(value, str) else "double", value=str(value))
    path = directory / f"{law.replace(' ', '_')}.xml"
    tree.write(path)
    for table in source.parent.glob("*.csv"):
        shutil.copy(table, directory)
    return path


def measured(options, network, mesh, law):
    """Runs one law on one network and checks the state against the law."""
    scene = scene_with(network, law, mesh.parent)
    run = networks.start(options, replace(network, name=f"{law}, {network.name}", file=str(scene)), mesh, 1, directory=law.replace(" ", "_"), limit=TIME_LIMIT)
    phases = [name for names in TIMERS.values() for name in names]
    found = Measured(run, run.time(*phases, clock="cpu_seconds") / max(1, len(run.steps)))
    if not run.failures:
        *_, run.worst, _ = violation.largest(run.directory, run.results, violation.Input(run.directory / "effective_input.xml"))
        if run.worst.max() > ASKED["worst_violation"]:
            part = violation.PARTS[int(run.worst.argmax())]
            run.failures.append(f"the law is violated by {run.worst.max():.1e} ({part})")
    return found


def add_row(table, name, found, cost):
    run = found.run
    size, bound = found.history
    table.add([name, run.results.get("mesh", {}).get("fracture_faces"), len(run.steps), float(np.median(run.newton)) if run.newton else None,
               max(run.newton, default=None), run.cuts, None if run.worst is None else float(run.worst.max()), cost, size, bound], run.failures)


def growth(options):
    """Relative increase of the cost per step with anisotropic damage at a point, from the second turn to LATE
    steps.

    The first turn is no reference: its few stored directions make steps less expensive."""
    reported = measured_by(options, TURNS, (f"Time.end={LATE / TURN}", f"Time.steps={LATE}"), 1)
    print("\nanisotropic damage at a point, a path that turns; microseconds of the processor and evaluations of a step:\n" +
          "\n".join(f"  {words:<28}{1e6 * reported[turn]['seconds']:6.2f}{reported[turn]['evaluations']:7.2f}" for turn, words in (
              ("first", "the turn after step 10"), ("second", f"the turn after step {10 + TURN}"), ("late", f"turns after step {LATE}"))), flush=True)
    return reported["late"]["seconds"] / reported["second"]["seconds"] - 1


def main(arguments):
    parser = common.parser("laws", __doc__)
    parser.add_argument("--program", type=common.absolute, default=ROOT / "build/perf/laws/laws", help="the compiled laws.cpp")
    options = parser.parse_args(arguments)
    chosen = common.matching(options, list(LAWS))
    printed, found = table.Table(COLUMNS, width=46), {}
    for network in networks.networks():
        if options.quick and not network.quick:
            continue
        mesh, _ = networks.made(options, network)
        for law in dict.fromkeys(["Coulomb", *chosen]):
            one = found.setdefault(law, {})[network.name] = measured(options, network, mesh, law)
            add_row(printed, f"{law}, {network.name}", one, one.seconds / found["Coulomb"][network.name].seconds)
    costs = {law: float(np.median([one.seconds / found["Coulomb"][name].seconds for name, one in runs.items()])) for law, runs in found.items()}
    runs = [one.run for each in found.values() for one in each.values()]
    failed = [f"failed: {run.scene.name}: {what}" for run in runs for what in run.failures]
    newton = [count for run in runs for count in run.newton]
    print("\nmedian over the networks of the seconds of a step, of Coulomb's:\n" +
          "\n".join(f"  {law:<28}{cost:6.2f}  newton_median={np.median([n for one in found[law].values() for n in one.run.newton]):g}"
                    for law, cost in costs.items()))
    values = {"failures": len(failed), "newton_median": float(np.median(newton)), "newton_max": max(newton, default=0),
              "worst_violation": max((float(run.worst.max()) for run in runs if run.worst is not None), default=np.inf),
              "cost": max(costs.values()), "growth": growth(options)}
    formats = {"newton_median": "g", "worst_violation": ".1e", "cost": ".2f", "growth": ".3f"}
    table.finish(options, printed, values, formats, ASKED, failed)
    return int(bool(failed or (options.quick and table.missed(values, BOUNDS))))
