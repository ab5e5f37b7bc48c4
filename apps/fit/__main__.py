"""Fits entries of a joint to a measured curve.

The point driver runs SCENE with different values of the given entries, to minimise the sum of squared differences from
CSV. The first line of CSV contains titles with units, such as `shear displacement (mm),shear stress (MPa)`. The
arguments --along and --match assign columns of CSV to outputs of `sprekk point`. A minus in front of an output changes
its sign. The words "change of" in front of an output subtract its initial value:

  ./sprekk fit test.csv scene.xml --along "shear displacement=jump_t" --match "shear stress=traction_t"
      --match "normal stress=-traction_n" --parameter "residual friction angle"
      --parameter "joint wall strength=50e6..200e6" --parameter "Point.column normal stiffness=1e9..1e11"

The output contains the values with 95 % confidence intervals, strongly correlated entries, and the differences of the
curves. The picture with the name of CSV and the ending _fit.png shows both curves."""
import argparse
import sys
from pathlib import Path

import numpy as np
from compare import Comparison, pair
from estimate import LEVEL, Parameter, fit
from measured import FitError, factor, read
from point import Point, Specification, bounds, start_of

LARGEST_CORRELATION = 0.95  # larger correlations are reported


def arguments(words):
    parser = argparse.ArgumentParser(prog="sprekk fit", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=Path, metavar="CSV", help="the measured curve")
    parser.add_argument("scene", metavar="SCENE", help="XML file of the point driver")
    parser.add_argument("--parameter", action="append", required=True, metavar="NAME[=LOW..HIGH]",
                        help="an entry of the point's joint, or its path in the scene; starts from the scene's value, "
                        "within the bounds that the reference allows or those given, in the unit of the reference")
    parser.add_argument("--along", required=True, metavar="COLUMN=OUTPUT",
                        help="increasing column, the common abscissa")
    parser.add_argument("--match", action="append", required=True, metavar="COLUMN=OUTPUT",
                        help="compared column; may be repeated")
    parser.add_argument("--until", type=float, metavar="X",
                        help="fit rows up to this value of the column --along, in its unit, and predict the others")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="override an entry of the scene")
    parser.add_argument("--output", type=Path, metavar="DIR", help="write the picture there")
    parser.add_argument("--dpi", type=int, default=150, help="dots per inch (default: 150)")
    parser.add_argument("--program", required=True, help=argparse.SUPPRESS)  # path of the program, set by the launcher
    return parser.parse_args(words)


def parameter(text, point, specification):
    """Returns (path, Parameter) of `NAME` or `NAME=LOW..HIGH`."""
    name, given, limits = (word.strip() for word in text.partition("="))
    path = point.path_of(name)
    unit, default, allowed = specification.entry(path)
    low, high = bounds(allowed)
    if given:
        try:
            own = [float(word) for word in limits.split("..")]
            if len(own) != 2 or not own[0] < own[1]:
                raise ValueError
        except ValueError:
            raise FitError(f'--parameter {text}: must be "NAME" or "NAME=LOW..HIGH" with LOW below HIGH') from None
        if own[0] < low or own[1] > high:
            raise FitError(f'--parameter {text}: "{name}" must be {allowed}')
        low, high = own
    start = start_of(point, path, unit, default, low, high)
    if start is None:
        raise FitError(f'{point.scene}: "{path}" has no number to start from; give one, or bounds: --parameter "{name}=LOW..HIGH"')
    return path, Parameter(name, float(np.clip(start, low, high)), low, high, unit)


def fitted(point, comparison, named):
    """Returns the estimate and its curve. Several columns are weighted by their scatter about a first fit."""
    paths, parameters = [path for path, _ in named], [p for _, p in named]

    def model(values):
        curve, whole = point.curve(dict(zip(paths, values)))
        known = curve and (whole or np.all(np.isfinite(comparison.residuals(curve))))
        return comparison.residuals(curve) if known else np.full(n, np.nan)

    n = sum(int(np.sum(rows)) for rows in comparison.rows)
    curve, _ = point.curve({path: p.start for path, p in named})
    if not curve:
        raise FitError(point.reason.removeprefix("sprekk: "))
    if not np.all(np.isfinite(comparison.residuals(curve))):
        raise FitError(f"{point.scene}: {point.reason.removeprefix('sprekk: ') or comparison.why_not(curve)}")
    if n <= len(parameters):
        raise FitError(f"{comparison.path}: has {n} numbers to compare, needs more than the {len(parameters)} parameters")
    estimate = fit(model, parameters)
    for _ in range(2 if len(comparison.matched) > 1 else 0):
        comparison.weigh_by_scatter(point.curve(dict(zip(paths, estimate.values)))[0])
        estimate = fit(model, [Parameter(p.name, v, p.low, p.high, p.unit) for p, v in zip(parameters, estimate.values)])
    return estimate, point.curve(dict(zip(paths, estimate.values)))[0]


def lines_of(estimate, parameters, comparison, curve):
    """Yields the lines of the output."""
    width = max(len(p.name) for p in parameters)
    for p, value, interval, why in zip(parameters, estimate.values, estimate.intervals, estimate.why):
        what = f"{interval[0]:.6g} .. {interval[1]:.6g}" if interval else why
        unit = "" if p.unit == "-" else f" {p.unit}"
        yield f"{p.name:{width}}  {value:.8g}{unit}  {LEVEL * 100:.0f} %: {what}"
    for i in range(len(parameters)):
        for j in range(i):
            if abs(estimate.correlation[i, j]) > LARGEST_CORRELATION:
                yield (f'"{parameters[j].name}" and "{parameters[i].name}" are strongly correlated: the correlation of '
                       f"their errors is {estimate.correlation[i, j]:.3f}")
    for kind, rows in ("fitted", comparison.rows), ("predicted", comparison.later):
        for p, d in zip(comparison.matched, comparison.differences(curve, rows)):
            if len(d):
                yield f"{p.name}, {len(d)} rows {kind}: {difference(p, d)}"
    yield f"{estimate.evaluations} runs of the point driver in the last fit"


def difference(p, d):
    """Returns the root mean square of the difference, absolute and relative, as text."""
    size, spread = float(np.sqrt(np.mean(d**2))), np.ptp(p.values[np.isfinite(p.values)])
    of_range = f", {100 * size / spread:.3g} % of its range" if spread else ""
    return f"root mean square difference {size:.4g} {'Pa' if 'traction' in p.output else 'm'}{of_range}"


def main(words=None):
    options = arguments(words)
    try:
        point = Point(options.program, options.scene, options.set)
        specification = Specification(point)
        columns = read(options.csv)
        named = [parameter(text, point, specification) for text in options.parameter]
        outputs = point.curve({path: p.start for path, p in named})[0]
        if not outputs:
            raise FitError(point.reason.removeprefix("sprekk: "))
        along = pair(options.csv, columns, options.along, "along", outputs)
        matched = [pair(options.csv, columns, text, "match", outputs) for text in options.match]
        name = options.along.rpartition("=")[0].strip()
        until = np.inf if options.until is None else options.until * factor(options.csv, name)
        comparison = Comparison(options.csv, along, matched, until)
        estimate, curve = fitted(point, comparison, named)
        print("\n".join(lines_of(estimate, [p for _, p in named], comparison, curve)))
        from picture import draw
        print(draw(comparison, curve, options))
    except (FitError, ArithmeticError, OSError) as error:
        print(f"sprekk fit: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
