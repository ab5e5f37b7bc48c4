"""Picture of laboratory tests of several specimens: shear, dilation, stress paths with strength."""
import numpy as np
from read import PlotError, csv_rows
from style import FAINT, MAX_CURVES, Quantity, give_room, look, plt

REACHED = 1e-3  # relative distance to the strength at which it counts as reached
ABOVE = 1.15    # of the largest shear traction: upper limit of drawn strengths


def specimens(path):
    """Returns {name: {column: values}} of a CSV file of `sprekk point` with several specimens, else None."""
    rows = csv_rows(path)
    if not rows or not {"specimen", "t", "state"} <= set(rows[0]):
        return None
    if len(rows) < 2:
        raise PlotError(f"{path}: has no rows")
    at, curves = rows[0].index("specimen"), {}
    try:
        for row in rows[1:]:
            curves.setdefault(row[at], []).append([float(word) for word in row[:at] + row[at + 1:]])
    except ValueError as error:
        raise PlotError(f"{path}: a line contains no numbers ({error})") from None
    titles = rows[0][:at] + rows[0][at + 1:]
    return {name: dict(zip(titles, np.array(values).T)) for name, values in curves.items()}


def size(curve, kind):
    """Returns the tangential component, signed in 2D, or its norm in 3D."""
    parts = [values for column, values in curve.items() if column.startswith(f"{kind}_t")]
    return parts[0] if len(parts) == 1 else np.linalg.norm(parts, axis=0)


def bounds(ax, curves, compression, shear):
    """Draws the largest strength of specimens that reach it, and the strength along the path of others.

    Paths with constant compression have no strength curve."""
    largest, peaks = max(np.max(np.abs(size(c, "traction"))) for c in curves.values()), []
    for k, curve in enumerate(curves.values()):
        stress, strength = -curve["traction_n"], curve["strength"]
        peak = np.argmax(strength)
        if abs(size(curve, "traction")[peak]) >= (1 - REACHED) * strength[peak]:
            peaks.append((stress[peak], strength[peak]))
        elif np.ptp(stress) > 0:
            shown = np.where(strength <= ABOVE * largest, strength, np.nan)
            ax.plot(compression(stress), shear(shown), color=look(k % MAX_CURVES)["color"], linestyle=":", linewidth=0.8)
    if peaks:
        ax.plot(*(quantity(values) for quantity, values in zip((compression, shear), np.array(sorted(peaks)).T)), "o", color=FAINT,
                markersize=4, markerfacecolor="none", label="largest strength")


def of_specimens(curves, title):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.4))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    slip = Quantity("tangential jump", "m", *(size(c, "jump") for c in curves.values()))
    shear = Quantity("shear traction", "Pa", *(size(c, "traction") for c in curves.values()))
    opening = Quantity("normal jump", "m", *(c["jump_n"] for c in curves.values()))
    compression = Quantity("compression", "Pa", *(c["traction_n"] for c in curves.values()))
    for k, (name, curve) in enumerate(curves.items()):
        line = {key: look(k % MAX_CURVES)[key] for key in ("color", "linestyle")}
        left.plot(slip(size(curve, "jump")), shear(size(curve, "traction")), label=name, **line)
        middle.plot(slip(size(curve, "jump")), opening(curve["jump_n"]), **line)
        right.plot(compression(-curve["traction_n"]), shear(size(curve, "traction")), **line)
    bounds(right, curves, compression, shear)
    left.set(xlabel=slip.label, ylabel=shear.label, title="shear")
    middle.set(xlabel=slip.label, ylabel=opening.label, title="dilation and closure")
    right.set(xlabel=compression.label, ylabel=shear.label, title="stress path")
    right.legend(*(a + b for a, b in zip(left.get_legend_handles_labels(), right.get_legend_handles_labels())),
                 loc="upper left", bbox_to_anchor=(1, 1))
    for ax in (left, middle, right):
        give_room(ax)
    return figure
