"""How many fractures slipped with at least a magnitude (Gutenberg and Richter 1944)."""
import numpy as np
from style import LINES, STYLES, plt

FEWEST = 20  # fractures with a magnitude; fewer say nothing about a distribution
FEWEST_OF_SLOPE = 50  # above the magnitude from which on the sample is complete


def b_value(magnitudes, least):
    """The slope of log10 N(>= M), by maximum likelihood above the least magnitude that is complete (Aki 1965), and its
    standard error."""
    above = magnitudes[magnitudes >= least]
    b = np.log10(np.e) / (np.mean(above) - least)
    return b, b / np.sqrt(len(above))


def complete(magnitudes):
    """The magnitude from which on the sample is taken as complete: where a histogram of tenths is highest (Wiemer and
    Wyss 2000)."""
    counts, sides = np.histogram(
        magnitudes, np.arange(np.floor(10 * magnitudes.min()) / 10, magnitudes.max() + 0.1, 0.1)
    )
    return sides[np.argmax(counts)]


def of_step(step, title):
    """Of the single fractures of a step; None where too few have a magnitude."""
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
            label=f"b = {b:.2f} ± {error:.2f} from {least:.1f} on",
        )
    ax.set(xlabel="moment magnitude (-)", ylabel="fractures of at least this magnitude (-)")
    ax.legend()
    return figure
