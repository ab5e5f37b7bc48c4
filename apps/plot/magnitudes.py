"""Pictures of magnitudes: slip events over time, and the number of fractures above a magnitude."""

import numpy as np
import series
from events import column, increments, states
from matplotlib import patheffects
from style import FAINT, LINES, NOISE, STYLES, foremost, plt

FEWEST = 20  # smallest number of fractures with a magnitude
FEWEST_OF_SLOPE = 50  # smallest number above the magnitude of completeness, for a b-value
MAX_NAMES = 8  # of events in the picture over time


def b_value(magnitudes, minimum):
    """Returns the slope of log10 N(>= M) and its standard error, by maximum likelihood above `minimum` (Aki 1965)."""
    above = magnitudes[magnitudes >= minimum]
    b = np.log10(np.e) / (np.mean(above) - minimum)
    return b, b / np.sqrt(len(above))


def complete(magnitudes):
    """Returns the magnitude of completeness: the maximum of a histogram with bins of 0.1 (Wiemer and Wyss 2000)."""
    counts, sides = np.histogram(
        magnitudes, np.arange(np.floor(10 * magnitudes.min()) / 10, magnitudes.max() + 0.1, 0.1)
    )
    return sides[np.argmax(counts)]


def of_step(step, title):
    """Returns the figure of the single fractures of a step, or None for too few magnitudes."""
    return of_magnitudes(step.get("single_fractures", {}).get("moment_magnitude", []), title, "fractures")


def of_events(events, title):
    """Returns the figure of the events of a catalogue by slip rates, or None for too few magnitudes."""
    return of_magnitudes([event.magnitude for event in events if event.number is not None], title, "events")


def of_magnitudes(found, title, what):
    """Returns the figure of the number of fractures or events above a magnitude, or None for too few magnitudes."""
    magnitudes = np.sort([value for value in found if value is not None and np.isfinite(value)])
    if len(magnitudes) < FEWEST:
        return None
    figure, ax = plt.subplots(figsize=(5.2, 3.6))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    count = np.arange(len(magnitudes), 0, -1)
    ax.semilogy(magnitudes, count, "o", markersize=3, color=LINES[0], label=f"{len(magnitudes)} {what}")
    minimum = complete(magnitudes)
    above = magnitudes >= minimum
    if above.sum() >= FEWEST_OF_SLOPE and magnitudes[-1] > minimum:
        b, error = b_value(magnitudes, minimum)
        ax.semilogy(
            magnitudes[above],
            above.sum() * 10 ** (-b * (magnitudes[above] - minimum)),
            color=LINES[3],
            linestyle=STYLES[1],
            label=f"b = {b:.2f} ± {error:.2f} for magnitudes of at least {minimum:.1f}",
        )
    ax.set(xlabel="moment magnitude (-)", ylabel=f"{what} with at least this magnitude (-)")
    ax.legend()
    return figure


def injection(steps):
    """Returns the sum of the positive rates of wells in each step; None without wells."""
    rates = [[well.get("rate") or 0 for well in step.get("wells", {}).values()] for step in steps]
    return np.array([sum(max(rate, 0) for rate in step) for step in rates]) if any(map(len, rates)) else None


def draw_curve(ax, times, values, label):
    """Draws a quantity that is constant in each step behind the axes, with a scale on the right."""
    behind = ax.twinx()
    behind.stairs(values, times, color=LINES[4], fill=True, alpha=0.25, baseline=0)
    behind.set_ylabel(label, color=LINES[0])
    behind.set_ylim(0, 1.15 * np.max(values))
    behind.ticklabel_format(axis="y", useMathText=True)
    behind.grid(False)
    behind.spines["right"].set_visible(True)
    ax.set_zorder(behind.get_zorder() + 1)
    ax.patch.set_visible(False)


def write_names(ax, events, ends):
    """Writes the fractures of the largest events above their marks; a name that overlaps another is omitted."""
    shown, taken = foremost([event.magnitude for event in events], MAX_NAMES), []
    ax.figure.draw_without_rendering()
    for k in sorted(shown, key=lambda k: -events[k].magnitude):
        late = ends[k] > 0.5 * sum(ax.get_xlim())
        text = ax.annotate(
            events[k].fracture,
            (ends[k], events[k].magnitude),
            (-3 if late else 3, 4),
            fontsize=7,
            textcoords="offset points",
            ha="right" if late else "left",
            annotation_clip=False,
        )
        text.set_path_effects([patheffects.withStroke(linewidth=2, foreground="white", alpha=0.8)])
        box = text.get_window_extent().expanded(1.02, 1.05)
        if any(box.overlaps(other) for other in taken):
            text.remove()
        else:
            taken.append(box)


def over_time(events, steps, title, wanted=None, start=0.0, dim=3):
    """Returns the figure of magnitudes over time and the cumulated moment; None without events.

    The injection rate, if any, is behind the magnitudes. A line is the duration of an event, a dot its end. `wanted` is the unit of time as in series.clock."""
    if not events:
        return None
    steps = states(steps)
    times, name = series.clock([start, *(step["time"] for step in steps)], wanted)
    factor = times[-1] / steps[-1]["time"]
    starts, ends = (factor * np.array([getattr(event, key) for event in events]) for key in ("start", "end"))
    magnitudes, rates = np.array([event.magnitude for event in events]), injection(steps)
    figure, (ax, below) = plt.subplots(2, 1, sharex=True, figsize=(7.4, 4.6), height_ratios=[2, 1])
    figure.suptitle(f"{title}, {len(events)} slip events", fontsize=10, x=0.01, ha="left")
    low = np.floor(2 * np.min(magnitudes) - 0.5) / 2
    ax.hlines(magnitudes, starts, ends, color=FAINT, linewidth=0.8)
    goes_on = times[-1] - ends <= NOISE * np.ptp(times)
    for chosen, face, label in (
        (~goes_on, LINES[3], "event"),
        (goes_on, "white", "event that goes on at the end of the run"),
    ):
        if chosen.any():
            ax.plot(
                ends[chosen],
                magnitudes[chosen],
                "o",
                color=LINES[3],
                markerfacecolor=face,
                markersize=4,
                clip_on=False,
                label=label,
            )
    figure.legend(loc="upper right", ncol=2)
    ax.set(
        xlim=(times[0], times[-1]),
        ylim=(low, np.ceil(2 * np.max(magnitudes) + 0.5) / 2),
        ylabel="moment magnitude (-)" if dim == 3 else "moment magnitude\nof a section 1 m thick (-)",
    )
    changes = np.abs(increments(column(steps, "moment")))
    below.plot(times, [0, *np.cumsum(np.sum(changes, axis=1))], color=LINES[3])
    below.set(xlabel=f"time ({name})", ylabel="cumulated moment\n" + ("(N m)" if dim == 3 else "per depth (N)"))
    below.set_ylim(bottom=0)
    below.ticklabel_format(axis="y", useMathText=True)
    if rates is not None and np.max(rates) > 0:
        draw_curve(ax, times, rates, "injection rate " + ("(m³/s)" if dim == 3 else "per depth (m²/s)"))
    figure.align_ylabels()
    write_names(ax, events, ends)
    return figure
