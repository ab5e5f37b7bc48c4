"""Checks of a result: convergence, contact laws, balances, estimated errors."""
from collections import namedtuple

import numpy as np
from numbers_in_words import RATES, number, quantity

Check = namedtuple("Check", "name verdict words")  # verdict: "passed", "failed", or "noted" without a bound
MAX_UNBALANCED = 1e-6  # relative to the largest reaction or force on a fracture
WORST_VIOLATION = 1e-6  # relative to the largest displacement or traction
WELL_ESTIMATED = 0.05  # relative error
LOADS = "traction", "confining pressure", "foundation stiffness", "body force", "gravity", "periodic"
JUDGED_STEPS = 200  # limit of written steps, for the time to read them


def of_run(directory, content, scene):
    steps = content["steps"]
    yield completion(content)
    yield convergence(steps)
    yield halvings(steps)
    if any("fractures" in step for step in steps) and scene.entries.get("Materials"):
        yield contact(directory, content, scene)
    yield from forces(steps, scene)
    yield from fluid(steps, content.get("mesh", {}).get("dimension", 3))
    yield from estimates(steps[-1])
    yield from accuracy(content)


def completion(content):
    reason = f": {content['reason']}" if content.get("reason") else ""
    done = content["status"] == "completed"
    return Check("run", "passed" if done else "failed", f"{content['status']}, {len(content['steps'])} steps{reason}")


def convergence(steps):
    failed = [str(k) for k, step in enumerate(steps, 1) if not step["converged"]]
    if failed:
        return Check("convergence", "failed", f"step {', '.join(failed[:5])} did not converge")
    left = max((value for step in steps for value in step["measures"].values() if value is not None), default=0)
    maximum = max(step["newton_iterations"] for step in steps)
    return Check(
        "convergence",
        "passed",
        f"all steps; at most {maximum} Newton iterations in one; largest relative residual "
        f"at the end of a step {number(left)}",
    )


def halvings(steps):
    cut = sum(step["cuts"] > 0 for step in steps)
    words = f"{cut} of {len(steps)} steps were bisected" if cut else "no step was bisected"
    return Check("time steps", "noted" if cut else "passed", words)


def contact(directory, content, scene):
    """Checks the contact laws with the files of the run, independently of the solver."""
    import read
    import violation

    name = "laws of contact and friction"
    if scene.entries.get("Stages"):  # laws change, faces may be excavated
        return Check(name, "noted", "not judged: the scene has stages")
    written = read.written_steps(directory, "fractures")
    if not written or not all("mean_slip" in f for f in content["steps"][-1].get("fractures", {}).values()):
        return Check(name, "noted", "not judged: the run wrote no states of fractures")
    if len(written) > JUDGED_STEPS:
        return Check(name, "noted", f"not judged: more than {JUDGED_STEPS} written steps")
    try:
        _, _, worst, _ = violation.largest(directory, content, violation.Input(directory / "effective_input.xml"))
    except (ValueError, KeyError, TypeError) as error:  # unknown law, or expressions
        return Check(name, "noted", f"not judged: {error}")
    k = int(np.argmax(worst))
    verdict = "passed" if worst[k] <= WORST_VIOLATION else "failed"
    return Check(
        name,
        verdict,
        f"largest violation {number(float(worst[k]))} ({violation.PARTS[k]}), relative to the "
        "largest displacement or traction",
    )


def forces(steps, scene):
    """Checks the sum of reactions, which vanishes if there are no loads except prescribed displacements."""
    reactions = steps[-1].get("reactions", {})
    if not reactions:
        return
    total = np.sum(list(reactions.values()), axis=0)
    fractures = steps[-1].get("fractures", {}).values()
    on_fractures = [f["area"] * np.abs(f["mean_traction"]["global"]) for f in fractures if "mean_traction" in f]
    on_fractures += [f["area"] * np.abs(f["mean_fracture_pressure"]) for f in fractures if "mean_fracture_pressure" in f]
    largest = max(np.max(np.abs(force), initial=0) for force in (*reactions.values(), *on_fractures))
    relative = np.max(np.abs(total)) / largest if largest > 0 else 0
    loads = [entry for entry in LOADS if scene.has(entry)]
    if loads and relative > MAX_UNBALANCED:
        yield Check(
            "balance of forces",
            "noted",
            f"the sum of the reactions is ({', '.join(map(number, total))}), balanced by the "
            f"other loads ({', '.join(loads)})",
        )
    else:
        yield Check(
            "balance of forces",
            "passed" if relative <= MAX_UNBALANCED else "failed",
            f"the sum of the reactions is {number(relative)} of the largest force",
        )


def fluid(steps, dim):
    last = steps[-1]
    wells = last.get("wells", {}).values()
    for key, kind, of_wells in (("inflows", "fluid", "rate"), ("heat_inflows", "heat", "heat")):
        through_wells = [well[of_wells] for well in wells if of_wells in well]
        if key not in last and not through_wells:
            continue
        unit = RATES[kind][dim == 2]
        through = sum(np.sum(value) for value in last.get(key, {}).values())
        by_wells = sum(through_wells)
        leak_off = " and leak-off" if "leak-off" in last.get(key, {}) else ""
        total = through + by_wells
        carried = kind == "heat" and ("inflows" in last or through_wells)  # flux at boundaries is unknown here
        yield Check(
            f"balance of {kind}",
            "noted",
            f"inflow at the end: {quantity(through)} {unit} through boundaries{leak_off}"
            + (" in addition to the heat of the fluid at their temperatures" if carried else "")
            + f" and {quantity(by_wells)} {unit} through wells"
            + ("" if carried else f"; the sum, {quantity(total)} {unit}, is {'stored' if total >= 0 else 'released from storage'}"),
        )


def estimates(step):
    for name, estimate in step.get("error_estimate", {}).items():
        if isinstance(estimate, dict) and "relative" in estimate:
            good = estimate["relative"] <= WELL_ESTIMATED
            yield Check(
                f"estimated error of the {name}",
                "passed" if good else "noted",
                f"{number(100 * estimate['relative'])} %" + ("" if good else ": a finer mesh is advisable"),
            )


def accuracy(content):
    """Yields the final lines of error control."""
    requested = content.get("accuracy", {"quantities": {}})
    for one in requested["quantities"].values():
        words = one["line"] + ("" if one["reached"] else f": not reached, for {requested['ended']}")
        yield Check("accuracy", "passed" if one["reached"] else "failed", words)
