"""Common style of pictures: fonts, units, colours, colour bars."""
import re

import matplotlib

matplotlib.use("Agg")  # no display
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize

INK, FAINT, PAPER = "#262933", "#8a8f99", "#f4f1ea"
LINES = ["#0077bb", "#ee7733", "#009988", "#cc3311", "#33bbee", "#ee3377"]  # suits colour blindness (Tol)
STYLES = ["-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5))]
MARKERS = ["o", "s", "^", "D"]
MAX_CURVES = len(LINES) * len(STYLES)  # with different styles
NOISE = 1e-9  # relative round-off: smaller values are zero, smaller differences are equal
STATES = ["open", "stick", "slip"]
STATE_COLOURS = ListedColormap(["#66ccee", "#bbbbbb", "#cc3311"])
FACE_STATES = ["open", "stick", "stick, has slipped", "slip"]
FACE_COLOURS = ListedColormap(["#66ccee", "#bbbbbb", "#eebb66", "#cc3311"])

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9.5, "axes.labelsize": 9, "xtick.labelsize": 8, "ytick.labelsize": 8,
    "legend.fontsize": 8, "legend.frameon": False, "lines.linewidth": 1.4, "axes.edgecolor": INK, "text.color": INK,
    "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "axes.grid": True, "grid.color": "#e3e5e9",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False,
    "savefig.bbox": "tight", "savefig.pad_inches": 0.22, "figure.facecolor": "white", "figure.constrained_layout.use": True,
    "figure.constrained_layout.w_pad": 0.1,
    "axes.formatter.limits": (-3, 4), "axes.formatter.useoffset": False, "image.cmap": "viridis",
})

PREFIXES = {"m": [(1, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")],
            "Pa": [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1, "Pa")],
            "K": [(1, "K")],
            "m³": [(1, "m³"), (1e-3, "l")],
            "m²": [(1, "m²")],
            "s": [(86400, "d"), (3600, "h"), (60, "min"), (1, "s")]}
MIN_TIMES = 2  # smallest value in a unit of time


def unit(largest, base):
    """Returns (factor, name) of a readable unit for numbers up to `largest`, given in the SI unit `base`."""
    minimum = MIN_TIMES if base == "s" else 0.5
    for factor, name in PREFIXES[base]:
        if largest >= minimum * factor:
            return factor, name
    return 1, base


class Quantity:
    """Converter of arrays to one readable unit."""

    def __init__(self, name, base, *values):
        largest = max((float(np.max(np.abs(v))) for v in values if np.size(v)), default=0)
        self.factor, self.unit = unit(largest, base)
        self.label = f"{name} ({self.unit})"

    def __call__(self, values):
        return np.asarray(values) / self.factor


def when(time, wanted=None):
    """Returns a time as text, in the unit `wanted`, (factor, name), or a readable one."""
    factor, name = wanted or unit(abs(time), "s")
    return f"t = {time / factor:.5g} {name}"


def panels_of_plane(n, points, width=10.5):
    """Returns a figure with n panels, their axes, and arguments for colour bars.

    The panels have the aspect ratio of the points. They are in a row or a column, whichever gives larger panels."""
    extent = np.ptp(points[:, :2], axis=0)
    form = max(extent[1], 1e-9) / max(extent[0], 1e-9)
    beside = min(width / n - 1.2, 8.4 / form) > min(width - 3, (9 / n - 1) / form)
    columns, rows = (n, 1) if beside else (1, n)
    across = width / columns if beside else min(width - 3, (9 / n - 1) / form) + 2
    thin = not beside and form < 0.4
    height = max((across - 1.2) * form, 0.3) + (1.3 if thin else 0.6)
    figure, axes = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True, figsize=(across * columns, rows * height + 0.4))
    for ax in axes.flat:
        ax.set_aspect("equal")
        ax.grid(False)
        ax.set(xlabel="x (m)", ylabel="y (m)")
        ax.label_outer()
        if form < 0.2:
            ax.yaxis.set_major_locator(plt.MaxNLocator(2))
    return figure, list(axes.flat), {"location": "bottom", "shrink": 0.5, "pad": 0.08, "aspect": 40} if thin else {}


def look(k):
    """Returns colour, line and marker of the k-th curve."""
    row = k // len(LINES) % len(STYLES)
    return {"color": LINES[k % len(LINES)], "linestyle": STYLES[row], "marker": MARKERS[row]}


def natural(name):
    """Returns a key for sorting names with numbers: 2 comes before 10."""
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in re.split(r"(\d+)", name) if part]


def foremost(sizes, maximum):
    """Returns the indices of the `maximum` largest sizes, in ascending order, for curves in colour."""
    return sorted(np.argsort(-np.asarray(sizes), kind="stable")[:maximum].tolist())


def without_noise(values, scale):
    """Returns values without round-off relative to `scale`.

    Small values become zero; nearly equal values their mean."""
    values = np.asarray(values, dtype=float)
    scale = max(scale, np.nanmax(np.abs(values), initial=0))
    values = np.where(np.abs(values) <= NOISE * scale, 0 * values, values)
    known = values[~np.isnan(values)]
    return np.where(np.isnan(values), values, np.mean(known)) if known.size and np.ptp(known) <= NOISE * scale else values


class Range(Normalize):
    """Range of a colour bar.

    `single` is the value of a constant field, else None. `extend` is the argument of matplotlib for values outside."""

    def __init__(self, low, high, single=None, extend="neither"):
        super().__init__(low, high)
        self.single, self.extend = single, extend


def clipped(values):
    """Returns the ends of a colour bar, and its argument `extend`.

    The ends are the percentiles 1 and 99 if the outliers would use half of the colours. Tips and wells have such
    values."""
    low, high = float(np.min(values)), float(np.max(values))
    inner = np.percentile(values, [1, 99])
    if np.ptp(inner) > 0.5 * (high - low) or np.ptp(inner) <= NOISE * max(abs(low), abs(high)):
        return low, high, "neither"
    room = 0.05 * np.ptp(inner)
    below, above = low < inner[0] - room, high > inner[1] + room
    return (float(inner[0]) if below else low, float(inner[1]) if above else high,
            {(True, True): "both", (True, False): "min", (False, True): "max"}[below, above])


def limits(values, signed=False, clip=False):
    """Returns the Range of values: symmetric if signed, wider for a constant, without outliers if clip."""
    low, high, extend = (float(np.min(values)), float(np.max(values)), "neither") if np.size(values) else (0, 0, "neither")
    if clip and np.size(values):
        low, high, extend = clipped(values)
    largest = max(abs(low), abs(high))
    single = 0.5 * (low + high) if high - low <= NOISE * largest else None
    if signed:
        return Range(-(largest or 1), largest or 1, single, extend)
    if high - low <= 1e-6 * largest:
        room = 0.05 * largest
        low, high = (0, 1) if largest == 0 else (low - room, high + room)
    return Range(low, high, single, extend)


def give_room(ax):
    """Widens axes with constant values, up to round-off."""
    for line in ax.lines:
        for values, get, put in ((line.get_xdata(), ax.get_xlim, ax.set_xlim), (line.get_ydata(), ax.get_ylim, ax.set_ylim)):
            size = np.max(np.abs(values), initial=0)
            if get()[1] - get()[0] < 1e-6 * size:
                put(np.mean(values) - 0.1 * size, np.mean(values) + 0.1 * size)


def colour_bar(figure, ax, norm, colours, label, **where):
    """Draws a colour bar. For a constant field it shows only this value. `location` may give the position."""
    bar = figure.colorbar(ScalarMappable(norm, colours), ax=ax, extend=getattr(norm, "extend", "neither"),
                          **{"shrink": 0.85, "aspect": 25, "pad": 0.02, **where})
    bar.set_label(label)
    single = getattr(norm, "single", None)
    bar.locator = plt.MaxNLocator(4 if "location" in where else 7) if single is None else plt.FixedLocator([single])
    if single is not None:
        bar.formatter = plt.FuncFormatter(lambda value, _: f"{value:.4g}")
    bar.update_ticks()
    bar.outline.set_visible(False)
    return bar


def state_bar(figure, ax, **where):
    """Draws the contact states of faces as a colour bar; returns its norm."""
    norm = BoundaryNorm([-0.5, 0.5, 1.5, 2.5, 3.5], 4)
    bar = colour_bar(figure, ax, norm, FACE_COLOURS, "contact state (-)", **where)
    bar.set_ticks(range(4), labels=[name.replace(", ", ",\n") for name in FACE_STATES])
    bar.ax.tick_params(length=0)
    return norm


def nice(number):
    """Returns the largest of 1, 2, 5 times a power of ten up to `number`."""
    power = 10.0 ** np.floor(np.log10(number))
    return float(max(k * power for k in (1, 2, 5) if k * power <= number * (1 + 1e-9)))


def break_long_labels(figure):
    """Breaks labels that are longer than their axes into two lines. Returns whether there are any."""
    found = False
    for ax in figure.axes:
        box = ax.get_window_extent()
        for label, k in ((ax.xaxis.label, 0), (ax.yaxis.label, 1)):
            text = label.get_text()
            length = label.get_window_extent().size[k] if text and label.get_visible() else 0
            blanks = [i for i, letter in enumerate(text) if letter == " "]
            if length > 1.1 * box.size[k] and blanks and "\n" not in text:
                middle = min(blanks, key=lambda i: abs(i - len(text) / 2))
                label.set_text(text[:middle] + "\n" + text[middle + 1:])
                found = True
    return found


def save(figure, picture, dpi):
    """Writes a PNG file. The layout is that of the first drawing, except if labels are longer than their axes: a second
    layout takes time."""
    figure.set_dpi(dpi)
    figure.draw_without_rendering()
    if break_long_labels(figure):
        figure.draw_without_rendering()
    figure.set_layout_engine("none")
    figure.savefig(picture, dpi=dpi)
