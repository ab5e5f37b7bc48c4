"""Pictures of probes with the slip rate: profiles of slip along a line, and friction over the slip rate of a face."""
import numpy as np
from series import probe
from style import LINES, Quantity, plt

FAST = 1e-3  # m/s, slip rate of an event
PROFILES = 30  # number of profiles, at equal increments of the largest slip


def of_probe(path):
    """Yields (name, figure) for the CSV file of a probe."""
    columns = {name: values for name, _, values in probe(path)}
    times = next(iter(columns.values()))
    if not len(times) or "slip rate" not in columns:
        return
    if "distance" in columns:
        if "slip" in columns and np.max(columns["slip"]) > 0:
            yield f"profiles_{path.stem}", profiles(path.stem, columns)
    elif "traction local n" in columns:
        yield f"phase_{path.stem}", phase(path.stem, columns)


def profiles(title, columns):
    """Slip along a line: one curve whenever the largest slip has grown by an increment; of events in another colour."""
    n = int(np.argmax(np.diff(columns["time"]) > 0)) + 1 if np.ptp(columns["time"]) > 0 else len(columns["time"])
    distance, slip, rate = (columns[name].reshape(-1, n) for name in ("distance", "slip", "slip rate"))
    quantity = Quantity("slip", "m", slip)
    figure, ax = plt.subplots(figsize=(7.4, 4))
    largest, drawn, names = slip.max(axis=1), -np.inf, set()
    for k in range(len(slip)):
        if largest[k] - drawn < largest[-1] / PROFILES and k != len(slip) - 1:
            continue
        drawn, fast = largest[k], rate[k].max() > FAST
        name = f"slip rate {'above' if fast else 'up to'} {FAST * 1e3:g} mm/s"
        ax.plot(distance[k], quantity(slip[k]), color=LINES[3 if fast else 0], linewidth=0.8, label=None if name in names else name)
        names.add(name)
    ax.set(xlabel="distance (m)", ylabel=quantity.label, title=title)
    ax.legend()
    return figure


def phase(title, columns):
    """Ratio of shear traction to compression over the slip rate, closed steps only."""
    shear = np.linalg.norm([values for name, values in columns.items() if name.startswith("traction local t")], axis=0)
    compression, rate = -columns["traction local n"], columns["slip rate"]
    closed = (compression > 0) & (rate > 0)
    figure, ax = plt.subplots(figsize=(5.2, 4))
    ax.semilogx(rate[closed], shear[closed] / compression[closed], color=LINES[0], linewidth=0.8)
    ax.set(xlabel="slip rate (m/s)", ylabel="shear traction / compression", title=title)
    return figure
