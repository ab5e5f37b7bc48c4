"""Picture of the number of fractures above each magnitude (Gutenberg and Richter 1944)."""
import numpy as np
from style import LINES, STYLES, plt

FEWEST = 20  # smallest number of fractures with a magnitude
FEWEST_OF_SLOPE = 50  # smallest number above the magnitude of completeness, for a b-value


def b_value(magnitudes, least):
    """Returns the slope of log10 N(>= M) and its standard error, by maximum likelihood above `least` (Aki 1965)."""
    above = magnitudes[magnitudes >= least]
    b = np.log10(np.e) / (np.mean(above) - least)
    return b, b / np.sqrt(len(above))


def complete(magnitudes):
    """Returns the magnitude of completeness: the maximum of a histogram with bins of 0.1 (Wiemer and Wyss 2000)."""
    counts, sides = np.histogram(
        magnitudes, np.arange(np.floor(10 * magnitudes.min()) / 10, magnitudes.max() + 0.1, 0.1)
    )
    return sides[np.argmax(counts)]


def of_step(step, title):
    """Returns the figure of the single fractures of a step, or None for too few magnitudes."""
    found = step.get("single_fractures", {}).get("moment_magnitude", [])
    magnitudes = np.sort([value for value in found if value is not None])
    if len(magnitudes) < FEWEST:
        return None
    figure, ax = plt.subplots(figsize=(5.2, 3.6))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    count = np.arange(len(magnitudes), 0, -1)
    ax.semilogy(magnitudes, count, "o", markersize=3, color=LINES[0], label=f"{len(magnitudes)} fractures")
    least = complete(magnitudes)
    above = magnitudes >= least
    if above.sum() >= FEWEST_OF_SLOPE and magnitudes[-1] > least:
        b, error = b_value(magnitudes, least)
        ax.semilogy(
            magnitudes[above],
            above.sum() * 10 ** (-b * (magnitudes[above] - least)),
            color=LINES[3],
            linestyle=STYLES[1],
            label=f"b = {b:.2f} ± {error:.2f} for magnitudes of at least {least:.1f}",
        )
    ax.set(xlabel="moment magnitude (-)", ylabel="fractures with at least this magnitude (-)")
    ax.legend()
    return figure
