"""Picture of the measured and the fitted curve."""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "plot"))
from style import FAINT, LINES, Quantity, plt, save  # noqa: E402


def of_fit(comparison, curve, title):
    along, matched = comparison.along, comparison.matched
    figure, axes = plt.subplots(1, len(matched), figsize=(3.8 * len(matched), 3.1), squeeze=False)
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    known = along.values[np.isfinite(along.values)]
    for ax, p, rows, later in zip(axes[0], matched, comparison.rows, comparison.later):
        x, y = along.computed(curve), p.computed(curve)
        shown = (x >= known[0] - 1e-9 * np.ptp(known)) & (x <= known[-1] + 1e-9 * np.ptp(known))
        across = (lambda values: values) if along.output == "t" else Quantity(along.name, "m" if "jump" in along.output else "Pa", known)
        up = Quantity(p.name, "m" if "jump" in p.output else "Pa", p.values[rows | later])
        for which, face, label in (rows, FAINT, "measured, fitted"), (later, "white", "measured, predicted"):
            if np.any(which):
                ax.plot(across(along.sign * along.values[which]), up(p.sign * p.values[which]), "o", markersize=4,
                        color=FAINT, markerfacecolor=face, label=label)
        ax.plot(across(along.sign * x[shown]), up(p.sign * y[shown]), color=LINES[0], label="computed")
        ax.set(xlabel=getattr(across, "label", along.name), ylabel=up.label)
    axes[0][0].legend()
    return figure


def draw(comparison, curve, options):
    folder = options.output or options.csv.parent
    folder.mkdir(parents=True, exist_ok=True)
    picture = folder / f"{options.csv.stem}_fit.png"
    save(of_fit(comparison, curve, options.csv.stem), picture, options.dpi)
    return picture
