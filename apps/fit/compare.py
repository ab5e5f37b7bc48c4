"""Comparison of measured columns with computed outputs, and their residuals."""
from dataclasses import dataclass

import numpy as np
import units
from measured import FitError, column

UNITS = {"t": "s", "strength": "Pa", "jump": "m", "elastic_jump": "m", "plastic_jump": "m", "traction": "Pa"}


@dataclass
class Pair:
    """Column of the CSV file and the output compared with it, or the change of the output since the start."""
    name: str
    output: str
    sign: int
    values: np.ndarray  # measured, in SI units, with the sign of the output
    is_change: bool = False

    def computed(self, curve):
        values = curve[self.output]
        return values - values[0] if self.is_change else values


def pair(path, columns, text, option, outputs):
    """Returns the Pair of `COLUMN=OUTPUT`. A minus or `change of`, or both, may precede the output."""
    name, equals, output = (word.strip() for word in text.rpartition("="))
    if not equals:
        raise FitError(f'--{option} {text}: must be "COLUMN=OUTPUT", e.g. "shear stress=traction_t"')
    sign = -1 if output.startswith("-") else 1
    output = output.removeprefix("-").strip()
    is_change = output.startswith("change of ")
    output = output.removeprefix("change of ").strip()
    if output not in outputs or output == "state":
        raise FitError(f'--{option} {text}: the point driver has no output "{output}"; it has '
                       + ", ".join(o for o in outputs if o != "state"))
    values, powers = column(path, columns, name)
    unit = UNITS[output if output in UNITS else output.rpartition("_")[0]]
    is_load_step = output == "t" and powers == units.of_unit("-")[1]
    if units.of_unit(unit)[1] != powers and not is_load_step:
        raise FitError(f'{path}: column "{name}": its unit does not match {output}, expected {unit} or a multiple')
    return Pair(name, output, sign, sign * values, is_change)


class Comparison:
    """Measured columns along `along`, for comparison with curves of the point driver.

    Rows beyond `until`, in SI units, are predicted and not fitted."""

    def __init__(self, path, along, matched, until=np.inf):
        self.path, self.along, self.matched = path, along, matched
        x = along.values
        known = [np.isfinite(x) & np.isfinite(p.values) for p in matched]
        self.rows = [rows & (abs(x) <= abs(until)) for rows in known]
        self.later = [rows & (abs(x) > abs(until)) for rows in known]
        for p, rows in zip(matched, self.rows):
            if np.sum(rows) < 2:
                raise FitError(f'{path}: column "{p.name}" has {np.sum(rows)} numbers in rows '
                               f'with "{along.name}", needs at least 2')
        known = x[np.isfinite(x)]
        if np.any(np.diff(known) <= 0):
            k = int(np.argmax(np.diff(known) <= 0))
            raise FitError(f'{path}: column "{along.name}" does not increase from {known[k]:.6g} to {known[k + 1]:.6g} (SI units, '
                           f'as {along.output} is signed); choose an increasing column for --along, e.g. the time')
        self.weights = [1 / (np.ptp(p.values[rows]) or np.max(np.abs(p.values[rows])) or 1)
                        for p, rows in zip(matched, self.rows)]

    def beside(self, curve, p, rows):
        """Returns the computed values at the measured rows, NaN beyond the end of the computed path."""
        x = self.along.computed(curve)
        selected = np.concatenate([[True], np.diff(np.maximum.accumulate(x)) > 0]) if len(x) else []
        if len(x) == 0 or np.any(np.diff(x) < -1e-12 * np.max(np.abs(x))):
            return np.full(np.sum(rows), np.nan)
        slack = 1e-9 * np.max(np.abs(x))
        wanted = self.along.values[rows]
        values = np.interp(wanted, x[selected], p.computed(curve)[selected])
        return np.where((wanted < x[0] - slack) | (wanted > x[-1] + slack), np.nan, values)

    def differences(self, curve, rows=None):
        """Returns computed minus measured values of each matched column, SI units, in the fitted rows or in `rows`."""
        return [self.beside(curve, p, which) - p.values[which] for p, which in zip(self.matched, rows or self.rows)]

    def residuals(self, curve):
        return np.concatenate([w * d for w, d in zip(self.weights, self.differences(curve))])

    def weigh_by_scatter(self, curve):
        """Weights each column by its scatter about the curve, with a minimum of 0.001 of its range."""
        for k, (p, d) in enumerate(zip(self.matched, self.differences(curve))):
            minimum = 1e-3 * (np.ptp(p.values[self.rows[k]]) or 1)
            self.weights[k] = 1 / max(float(np.sqrt(np.mean(d**2))), minimum)

    def why_not(self, curve):
        """Returns the reason why a curve cannot be compared."""
        x = self.along.computed(curve)
        known = self.along.values[np.isfinite(self.along.values)]
        if np.any(np.diff(x) < -1e-12 * np.max(np.abs(x))):
            return f"{self.along.output} does not increase along the computed path"
        return (f'{self.along.output} spans {x[0]:.6g} to {x[-1]:.6g} on the computed path, "{self.along.name}" '
                f"spans {known[0]:.6g} to {known[-1]:.6g} (SI units); extend the path of the scene")
