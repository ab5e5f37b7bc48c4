"""Pictures of traction against jump: of a point, and of means over the fractures of a run."""
import numpy as np
from read import PlotError, entries
from style import (FAINT, LINES, Quantity, STATES, STATE_COLOURS, foremost, give_room, look, natural, plt,
                   without_noise)

MAX_SHOWN = 8  # fractures with colours
SHOW_STATES = 400  # largest number of steps with marked states


def curve(ax, x, y, colour, label=None, states=None, line="-"):
    """Draws a path with marks of its first and last step. Dots show the contact state."""
    ax.plot(x, y, color=colour, label=label, linestyle=line, zorder=2)
    ax.plot(x[:1], y[:1], "o", color="white", markeredgecolor=colour, markersize=5, zorder=4)
    if states is not None and len(x) <= SHOW_STATES:
        ax.scatter(x, y, c=STATE_COLOURS(states.astype(int)), s=14, zorder=3, linewidths=0.4, edgecolors="white")
    ax.plot(x[-1:], y[-1:], "s", color=colour, markersize=4.5, zorder=5)


def mark_legend(figure, states, first="first step"):
    """Draws the legend of contact states and of the first and last step in the upper right corner."""
    marks = [plt.Line2D([], [], linestyle="", marker="o", markersize=4, color=STATE_COLOURS(i), label=name)
             for i, name in enumerate(STATES) if states]
    marks += [plt.Line2D([], [], linestyle="", marker="o", markersize=5, color="white", markeredgecolor=LINES[0],
                         label=first),
              plt.Line2D([], [], linestyle="", marker="s", markersize=4.5, color=LINES[0], label="last step")]
    figure.legend(handles=marks, loc="upper right", ncol=len(marks), columnspacing=0.8, handletextpad=0)


def of_point(columns, tangential, title):
    """Returns the figure of a point: shear traction and tangential jump, normal traction and normal jump, dilation.

    In 3D the path of the tangential jump replaces the dilation."""
    def named(kind, axes):
        return [columns[f"{kind}_{axis}"] for axis in axes]

    jumps, tractions = named("jump", ["n", *tangential]), named("traction", ["n", *tangential])
    length, stress = (max(np.max(np.abs(v)) for v in vs) for vs in (jumps, tractions))
    normal_jump, normal_traction = without_noise(jumps[0], length), without_noise(tractions[0], stress)
    shear_jump = Quantity("tangential jump", "m", *jumps[1:])
    shear = Quantity("shear traction", "Pa", *tractions[1:])
    opening, normal = Quantity("normal jump", "m", normal_jump), Quantity("normal traction", "Pa", normal_traction)

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(9, 3.1))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    mark_legend(figure, states=len(columns["t"]) <= SHOW_STATES)
    for i, axis in enumerate(tangential):
        curve(left, shear_jump(jumps[i + 1]), shear(tractions[i + 1]), LINES[i], label=axis,
              states=columns["state"] if len(tangential) == 1 else None)
    left.set(xlabel=shear_jump.label, ylabel=shear.label, title="shear")
    if len(tangential) > 1:
        left.legend()
    curve(middle, opening(normal_jump), normal(normal_traction), LINES[0], states=columns["state"])
    middle.set(xlabel=opening.label, ylabel=normal.label, title="normal, compression negative")

    if len(tangential) == 1:
        curve(right, shear_jump(jumps[1]), opening(normal_jump), LINES[0], states=columns["state"])
        right.set(xlabel=shear_jump.label, ylabel=opening.label, title="dilation and closure")
    else:
        for kind, colour in (("jump", LINES[0]), ("plastic_jump", LINES[3])):
            first, second = named(kind, tangential)
            right.plot(shear_jump(first), shear_jump(second), color=colour, label=kind.replace("_", " "))
        right.set(xlabel=f"t1 ({shear_jump.unit})", ylabel=f"t2 ({shear_jump.unit})", title="path of the tangential jump")
        right.set_aspect("equal", adjustable="datalim")
        right.legend(loc="best")
    for ax in (left, middle, right):
        give_room(ax)
    return figure


def main_direction(vectors):
    """Returns the direction in the tangent plane with the largest extent of the vectors (n, 1 or 2).

    In 2D it is t. In 3D its sign is that of the first vector with at least a thousandth of the largest extent."""
    if vectors.shape[1] == 1:
        return np.ones(1)
    direction = np.linalg.svd(vectors)[2][0]
    along = vectors @ direction
    return direction * np.sign(along[np.argmax(abs(along) >= 1e-3 * np.max(abs(along)))] or 1)


def starts_unloaded(scene):
    """Returns whether jumps and tractions vanish in the initial state; `scene` as in read.scene."""
    pressure = scene.get("Flow", {}).get("initial pressure", "0")
    given = (value for name in ("initial stress", "plastic jump") for value in entries(scene, name))
    stressed = {"lithostatic stress", "in-situ stress"} & set(scene.get("Bulk", {}))
    return not stressed and pressure == "0" and not any(given)


def of_fractures(steps, names, title, length=0, stress=0, unloaded=False):
    """Returns the figure of means over each single fracture: shear along the main direction of its jump, normal, dilation.

    Length and stress are reference values of round-off, at least the largest means. Curves start at zero for an
    unloaded initial state, otherwise at the first step."""
    if not names:
        raise PlotError(f"{title}: the run has no fractures")

    def local(k, key):
        means = np.array([step["single_fractures"][key][k] for step in steps])
        return np.concatenate([0 * means[:1], means]) if unloaded else means

    means = {name: (local(k, "mean_jump_local"), local(k, "mean_traction_local")) for k, name in enumerate(names)}
    length = max(length, *(np.max(np.abs(jump)) for jump, _ in means.values()))
    stress = max(stress, *(np.max(np.abs(traction)) for _, traction in means.values()))
    shears, normals, dilations = {}, {}, {}
    for name, (jump, traction) in means.items():
        along = main_direction(jump[:, 1:])
        shears[name] = without_noise(jump[:, 1:] @ along, length), without_noise(traction[:, 1:] @ along, stress)
        normals[name] = without_noise(jump[:, 0], length), without_noise(traction[:, 0], stress)
        dilations[name] = shears[name][0], normals[name][0]

    names = sorted(names, key=natural)
    shown = [names[k] for k in foremost([np.max(np.abs(shears[name][0])) for name in names], MAX_SHOWN)]
    figure, axes = plt.subplots(1, 3, figsize=(9.6 if len(names) == 1 else 11, max(3.3, 0.17 * len(shown) + 0.8)))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    kinds = (("tangential jump", "shear traction", "Pa"), ("normal jump", "normal traction", "Pa"), ("tangential jump", "normal jump", "m"))
    for ax, kind, curves in zip(axes, kinds, (shears, normals, dilations)):
        jump = Quantity("mean " + kind[0], "m", *(c[0] for c in curves.values()))
        traction = Quantity("mean " + kind[1], kind[2], *(c[1] for c in curves.values()))
        for name, (x, y) in curves.items():
            if name not in shown:
                ax.plot(jump(x), traction(y), color=FAINT, linewidth=0.5, zorder=1)
        for k, name in enumerate(shown):
            curve(ax, *(quantity(values) for quantity, values in zip((jump, traction), curves[name])), look(k)["color"], name, line=look(k)["linestyle"])
        ax.set(xlabel=jump.label, ylabel=traction.label)
        give_room(ax)
    mark_legend(figure, states=False, first="initial state" if unloaded else "first step")
    axes[0].set_title("shear")
    axes[2].set_title("dilation and closure")
    axes[1].set_title("normal, compression negative")
    if len(names) > 1:
        others = [plt.Line2D([], [], color=FAINT, linewidth=0.5, label=f"{len(names) - len(shown)} others")] if len(shown) < len(names) else []
        axes[2].legend(handles=[*axes[2].get_legend_handles_labels()[0], *others], loc="upper left", bbox_to_anchor=(1, 1), handlelength=3)
    return figure
