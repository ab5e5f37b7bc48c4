"""Picture of convergence: iterations of each step, and the residuals at its end."""
import numpy as np
from style import FAINT, LINES, look, plt


def of_run(steps, title):
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
    drawn = {name: np.where(values > 0, values, np.nan) for name, values in measures.items() if np.any(values > 0)}
    for i, (name, values) in enumerate(drawn.items()):
        right.semilogy(number, values, markersize=3, label=name.replace("_", " "), **look(i))
    right.set(xlabel="step", ylabel="relative residual (-)", title="residual at the end of each step")
    if drawn:
        low, high = (limit(np.log10(limit_of(list(drawn.values())))) for limit, limit_of in ((np.floor, np.nanmin), (np.ceil, np.nanmax)))
        right.set_ylim(10.0**low, 10.0 ** max(high, low + 1))
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
