"""Picture of convergence: iterations of each step, and the residuals at its end."""
import numpy as np
from style import FAINT, INK, LINES, look, plt


def of_run(steps, title, tolerance=None):
    """Returns the figure. `tolerance` of the residuals, a line."""
    number = np.arange(1, len(steps) + 1)
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.2))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")

    newton = np.array([step["newton_iterations"] for step in steps])
    linear = np.array([step["linear_iterations"] for step in steps])
    left.bar(number, newton, color=LINES[0], width=0.75)
    left.set(xlabel="step", ylabel="Newton iterations (-)", title="iterations")
    left.yaxis.set_major_locator(plt.MaxNLocator(integer=True))
    left.grid(axis="x", visible=False)
    if np.any(linear != newton):  # a direct solver needs one linear iteration for each Newton iteration
        per_solve = left.twinx()
        per_solve.plot(number, linear / np.maximum(newton, 1), "o-", color=LINES[1], markersize=3)
        per_solve.set_ylabel("linear iterations per Newton iteration (-)", color=LINES[1])
        per_solve.spines["right"].set_visible(True)
        per_solve.set_ylim(bottom=0)
        per_solve.grid(False)
    cut = [n for n, step in zip(number, steps) if step["cuts"] > 0]
    left.plot(cut, [0.3] * len(cut), "v", color=LINES[3], markersize=4, label="step was bisected")
    if cut:
        left.legend()

    measures = {name: np.array([step["measures"].get(name) for step in steps], dtype=float)  # NaN for a missing measure
                for name in sorted(steps[-1]["measures"])}
    drawn = {name: values for name, values in measures.items() if np.any(values > 0)}
    right.set(xlabel="step", ylabel="relative residual (-)", title="residual at the end of each step", yscale="log")
    if drawn:
        positive = np.concatenate([values[values > 0] for values in drawn.values()])
        low, high = np.floor(np.log10(np.min(positive))), np.ceil(np.log10(max(np.max(positive), tolerance or 0)))
        right.set_ylim(10.0**low, 10.0 ** max(high, low + 1))
        for i, (name, values) in enumerate(drawn.items()):
            right.plot(number, np.where(values == 0, 10.0**low, values), markersize=3, label=name.replace("_", " "), clip_on=False,
                       **look(i))
        if any(np.any(values == 0) for values in drawn.values()):
            right.plot([], [], " ", label="zero: at the lower end")
        if tolerance:
            right.axhline(tolerance, color=INK, linestyle="--", linewidth=0.9, label="tolerance", zorder=1)
        right.yaxis.set_major_locator(plt.LogLocator(numticks=8))
        right.legend(loc="upper left", bbox_to_anchor=(1, 1), handlelength=3)
    else:
        right.text(0.5, 0.5, "nothing but rounding", transform=right.transAxes, ha="center", color=FAINT)
        right.set_yticks([])
    for ax in (left, right):
        ax.set_xlim(0.4, len(steps) + 0.6)
        ax.xaxis.set_major_locator(plt.MaxNLocator(integer=True))
        ax.tick_params(which="both", color=FAINT)
    return figure
