"""Fault slip: errors against exact solutions and explicit references, steps, Newton and Krylov iterations.

Slip driven by fluid is compared with similarity solutions, faults with rate-and-state friction with explicit solutions of
Runge and Kutta. The last line gives the number of failed runs, the largest error, the median of the Newton iterations of
all steps, and the largest ratio of our steps to those of the explicit method at equal error."""
import math
from dataclasses import dataclass

import numpy as np

from perf.common import options as common
from perf.common import program, table
from perf.earthquakes import fluid_driven, rate_state, rupture, sequence, slab, strike_slip

BOUNDS = {"failures": 0, "worst_error": 0.03, "newton_median": 4, "steps_ratio": 2}
QUICK_BOUNDS = {**BOUNDS, "steps_ratio": 3}  # a guard: spring sliders miss the target
FORMATS = {"worst_error": ".4f", "newton_median": ".3g", "steps_ratio": ".2f"}
COLUMNS = {"row": "", "faces": "d", "front": ".2%", "slip": ".2%", "first event": ".2%", "onset": ".2%", "period": ".2%", "error": ".2%", "steps": "d", "rejected": "d", "Newton": ".3g",
           "most": "d", "Krylov": ".1f", "set-ups": ".2f", "cost": ".1f", "reference": "d", "ratio": ".2f", "seconds": ".1f", "onsets": "", "places": ""}


@dataclass
class Row:
    """Errors and counts of a run. `reference` is the number of steps of the explicit method at equal error."""
    name: str
    errors: dict            # by column, or of other quantities
    steps: int
    rejected: int
    seconds: float
    faces: int = None
    newton: list = ()       # iterations of each step
    krylov: float = None    # iterations per step
    reference: int = None
    setups: float = None    # factorisations or hierarchies per step
    cost: float = None      # of a step, over that of a linear solve and a residual
    onsets: str = None      # years, with errors
    places: str = None      # stations and times of large errors

    @classmethod
    def of_run(cls, name, run, errors, reference=None, onsets=None, places=None):
        steps = run.steps
        timing = run.results["timing"]
        unit = sum(timing[phase]["cpu_seconds"] / timing[phase]["count"] for phase in ("linear_solve", "residual"))
        return cls(name, errors, len(steps), sum(step.get("rejected", 0) for step in steps), run.seconds, run.results["mesh"]["fracture_faces"],
                   run.newton, sum(step["linear_iterations"] for step in steps) / len(steps), reference,
                   timing["set-up_of_linear_solver"]["count"] / len(steps), timing["time_steps"]["cpu_seconds"] / len(steps) / unit, onsets, places)

    @property
    def error(self):
        return max(map(abs, self.errors.values()))

    @property
    def ratio(self):
        return (self.steps + self.rejected) / self.reference if self.reference else None

    def values(self):
        median, most = (float(np.median(self.newton)), max(self.newton)) if self.newton else (None, None)
        errors = [self.errors.get(column) for column in ("front", "slip", "first event", "onset", "period")]
        return [self.name, self.faces, *errors, self.error, self.steps, self.rejected, median, most, self.krylov, self.setups, self.cost,
                self.reference, self.ratio, self.seconds, self.onsets, self.places]


def cases(options):
    """Yields (name, function that returns a Row)."""
    yield from rate_state.cases(options, Row)
    yield from sequence.cases(options, Row)
    yield from slab.cases(options, Row)
    yield from strike_slip.cases(options, Row)
    yield from fluid_driven.cases(options, Row.of_run)
    yield from rupture.cases(options, Row.of_run)


def summary(rows, failures):
    iterations = [count for row in rows for count in row.newton]
    return {"failures": failures, "worst_error": max((row.error for row in rows), default=math.nan),
            "newton_median": float(np.median(iterations)) if iterations else math.nan,
            "steps_ratio": max((row.ratio for row in rows if row.ratio), default=math.nan)}


def main(words):
    options = common.parser("earthquakes", __doc__).parse_args(words)
    shown, rows, failed = table.Table(COLUMNS, 36), [], []
    for name, measure in common.matching(options, list(cases(options)), lambda case: case[0]):
        try:
            rows.append(measure())
            shown.add(rows[-1].values())
        except program.Failed as reason:
            failed.append(f"failed: {name}: {reason}")
            print(failed[-1], flush=True)
    return table.finish(options, shown, summary(rows, len(failed)), FORMATS, QUICK_BOUNDS if options.quick else BOUNDS, failed)
