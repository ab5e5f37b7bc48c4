"""Pictures of time series: slip and opening of fractures, pressures and rates of wells, injected volume, probes."""
import re

import numpy as np
from read import PlotError, csv_rows
from style import FAINT, NOISE, PREFIXES, Quantity, foremost, look, natural, plt, unit, when

MAX_LINES = 6  # with colours in one panel


def clock(times, wanted):
    """Returns the times in a unit, and its name. The unit is `wanted`, (factor, name), or a readable one."""
    factor, name = wanted or unit(np.max(np.abs(times), initial=0), "s")
    return np.asarray(times) / factor, name


def injected(times, rates, start=0.0):
    """Returns the injected volume since the start. The rate is constant in each step, as in the computation."""
    return np.cumsum(np.diff(np.concatenate([[start], times])) * rates)


def panels(steps, singles, start=0.0, dim=3):
    """Yields (label, unit, {name: values over the steps}) of a run; `singles`: names of single fractures."""
    times = np.array([step["time"] for step in steps])
    base_of_volume = "m²" if dim == 2 else "m³"  # volume per depth in 2D
    lengths = {tuple(round(area, 9) for area in step.get("single_fractures", {}).get("area", ())) for step in steps}
    growth = [("area", "length", "m")] if dim == 2 and len(lengths) > 1 else []
    growth.append(("fracture_energy", "fracture energy (J/m)" if dim == 2 else "fracture energy (J)", ""))
    for key, label, base in (
        ("max_slip", "largest slip", "m"),
        ("mean_opening", "mean opening", "m"),
        ("mean_fracture_pressure", "mean pressure in fractures", "Pa"),
        ("mean_fracture_temperature", "mean temperature of fractures", "K"),
        *growth,
        ("area_broken", *(("broken length", "m") if dim == 2 else ("broken area", "m²"))),
        ("leaked_volume", "leaked volume", base_of_volume),
    ):
        if singles and all(key in step.get("single_fractures", {}) for step in steps):
            values = np.array([step["single_fractures"][key] for step in steps], dtype=float)
            order = sorted(range(len(singles)), key=lambda k: natural(singles[k]))
            yield label, base, {singles[k]: values[:, k] for k in order}
    wells = [name for name in steps[-1].get("wells", {}) if all(name in step.get("wells", {}) for step in steps)]
    def of_wells(key):
        return {
            name: np.array(
                [np.nan if step["wells"][name].get(key) is None else step["wells"][name][key] for step in steps],
                dtype=float,
            )
            for name in wells
        }

    if wells:
        yield "pressure in wells", "Pa", of_wells("pressure")
        yield "injected volume", base_of_volume, {n: injected(times, v, start) for n, v in of_wells("rate").items()}
        if any("temperature" in well for well in steps[-1]["wells"].values()):
            yield "temperature in wells", "K", of_wells("temperature")


def change(values):
    return np.nanmax(values) - np.nanmin(values)


def leave_out_start(ax, curves):
    """Limits the axis to the values after the first one, if these would use less than a third of it. Curves from zero to
    a nearly constant value have such a range. A note in the panel contains the first values."""
    later = np.concatenate([values[1:] for values in curves])
    later, first = later[np.isfinite(later)], np.array([values[0] for values in curves])
    first = first[np.isfinite(first)]
    if not first.size or later.size <= len(curves):
        return
    low, high = later.min(), later.max()
    whole = max(high, first.max()) - min(low, first.min())
    if 3 * (high - low) >= whole or high - low <= NOISE * max(abs(low), abs(high)):
        return
    room = 0.08 * (high - low)
    ax.set_ylim(low - room, high + room)
    ends = f"{first.min():.3g}" if np.ptp(first) <= NOISE * whole else f"{first.min():.3g} to {first.max():.3g}"
    ax.annotate(f"starts at {ends}, outside", (0.01, 0.03), xycoords="axes fraction", fontsize=7, color=FAINT)


def draw(ax, times, label, base, curves, looks, over_time):
    """Draws the curves with the largest changes in colour, the others thin. `looks` {name: look} of former panels."""
    quantity = Quantity(label, base, *curves.values()) if base else None
    names = list(curves)
    changes = [change(values) for values in curves.values()]
    shown = foremost(changes, MAX_LINES)
    if len(names) > MAX_LINES:
        shown = [k for k in shown if changes[k] > NOISE * max(changes)]
    for k in shown:
        looks.setdefault(names[k], len(looks))
    for k, name in enumerate(names):
        values = quantity(curves[name]) if quantity else curves[name]
        if k in shown:
            ax.plot(times, values, markersize=3 if len(times) <= 60 else 0, label=name, **look(looks[name]))
        else:
            ax.plot(times, values, color=FAINT, linewidth=0.5, zorder=1)
    if len(names) > len(shown):
        ax.plot([], [], color=FAINT, linewidth=0.5, label=f"{len(names) - len(shown)} others")
    if over_time and base in ("Pa", "K"):  # without a natural zero
        leave_out_start(ax, [line.get_ydata() for line in ax.lines if len(line.get_ydata()) > 1])
    ax.set_ylabel(quantity.label if quantity else label)
    if len(names) > 1:
        ax.legend(loc="upper left", bbox_to_anchor=(1, 1), fontsize=7)


def figure_of(title, times, name, content, over_time=True):
    """Returns the figure with a panel for each entry of the content and a common axis of times, or of other values."""
    figure, axes = plt.subplots(len(content), 1, sharex=True, squeeze=False, figsize=(7.4, 0.6 + 2.1 * len(content)))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    looks = {}  # a name has one look in all panels
    for ax, (label, base, curves) in zip(axes.flat, content):
        draw(ax, times, label, base, curves, looks, over_time)
    axes[-1, 0].set_xlabel(f"time ({name})")
    figure.align_ylabels()
    return figure


def of_run(steps, singles, title, wanted=None, start=0.0, dim=3, initial=None):
    """Returns the figure of at least two steps, or None without data. It begins with the initial state, if there is one."""
    if initial and len(steps) > 1:
        steps = [initial, *steps]
    content = list(panels(steps, singles, start, dim)) if len(steps) > 1 else []
    def largest(curves):
        return max((np.nanmax(abs(v), initial=0) for v in curves.values()), default=0)

    length = max((largest(curves) for _, base, curves in content if base == "m"), default=0)
    content = [one for one in content if largest(one[2]) > (NOISE * length if one[1] == "m" else 0)]
    if not content:
        return None
    times, name = clock([step["time"] for step in steps], wanted)
    return figure_of(title, times, name, content)


TITLE = re.compile(r"(?P<name>.*?)\s*\[(?P<unit>[^\]]*)\]\s*$")


def probe(path):
    """Returns the columns of a probe's CSV file, [(name, unit, values)]. The first column is the time."""
    rows = csv_rows(path)
    titles = [TITLE.match(title) for title in rows[0]] if rows else []
    if not titles or None in titles or titles[0]["name"] != "time":
        raise PlotError(f'{path}: is not a CSV file of a probe, which starts with "time [s],"')
    try:
        values = np.array([[float(word) if word else np.nan for word in row] for row in rows[1:]]).reshape(
            -1, len(titles)
        )
    except ValueError as error:
        raise PlotError(f"{path}: a line contains no numbers ({error})") from None
    return [(title["name"], title["unit"], column) for title, column in zip(titles, values.T)]


def panel(symbol, curves):
    """Returns a panel for figure_of(). Its label is the name of a single curve, the words that all names have in
    common, or the names. Units without prefixes are part of the label."""
    symbol = symbol.replace("^2", "²").replace("^3", "³").replace("*", " ")
    names = [name.split() for name in curves]
    common = " ".join(word for word in names[0] if all(word in other for other in names))
    name = common or (", ".join(curves) if len(curves) <= 3 else f"{', '.join(list(curves)[:3])}, ...")
    return (name, symbol, curves) if symbol in PREFIXES else (f"{name} ({symbol})", "", curves)


def of_probe(path):
    """Returns a panel for each unit, with profiles of the last time for lines. None for an empty file."""
    columns = probe(path)
    clock_name, times = columns[0][1:]
    if not len(times):
        return None
    wanted = None if clock_name == "s" else (1, clock_name)
    if len(columns) > 1 and columns[1][0] == "distance":
        last = times == times[-1]
        content = [panel(symbol, {name: values[last]}) for name, symbol, values in columns[2:] if name not in "xyz"]
        figure = figure_of(f"{path.stem}, {when(times[-1], wanted)}", columns[1][2][last], "", content, over_time=False)
        figure.axes[-1].set_xlabel("distance (m)")
        return figure
    groups = {}
    for name, symbol, values in columns[1:]:
        groups.setdefault(symbol, {})[name] = values
    content = [panel(symbol, curves) for symbol, curves in groups.items()]
    return figure_of(path.stem, *clock(times, wanted), content)
