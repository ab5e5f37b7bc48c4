"""Mohr diagram of the stress on fracture faces, with strengths of joints.

It also shows the paths of the fractures with the largest slip, and the circles of the mean stress in the rock."""
import math

import numpy as np
import read
from bulk import tensors
from fractures import effective, scales
from style import FAINT, INK, LINES, Quantity, STATE_COLOURS, STATES, STYLES, foremost, look, plt, without_noise

MAX_ENVELOPES = 2 * len(STYLES)
MAX_NAMES = 3  # of joints with the same strength
MAX_PATHS = 3  # of single fractures


def number(joint, name, default=None):
    """Returns a numerical entry, or NaN for an expression."""
    try:
        return float(joint.get(name, "nan" if default is None else default))
    except ValueError:
        return math.nan


def strength(joint, normal):
    """Returns the largest shear traction of intact asperities under normal compressions, or None for other laws.

    The laws are c + mu N (Coulomb) and N tan(phi_r + JRC log10(JCS / N)) (Barton and Choubey), with an angle of at
    most 70 degrees."""
    if joint.get("friction") == "Coulomb":
        angle = number(joint, "friction angle")
        friction = number(joint, "friction coefficient") if math.isnan(angle) else math.tan(math.radians(angle))
        cohesion = number(joint, "cohesion", 0) if joint.get("bond", "none") != "none" else 0
        return cohesion + friction * normal if math.isfinite(friction + cohesion) else None
    if joint.get("friction") == "Barton-Choubey":
        jrc, jcs, phi = (
            number(joint, name)
            for name in ("joint roughness coefficient", "joint wall strength", "residual friction angle")
        )
        if not math.isfinite(jrc + jcs + phi):
            return None
        angle = phi + jrc * np.log10(np.maximum(jcs / np.maximum(normal, 1e-9 * jcs), 1))
        return normal * np.tan(np.radians(np.minimum(angle, 70)))
    return None


def mean_stress(rock):
    """Returns the principal stresses of the volume mean, positive and ascending in compression; in 2D of the plane."""
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

    sizes = vtkCellSizeFilter()
    sizes.SetInputData(rock)
    sizes.Update()
    data = read.arrays(sizes.GetOutput().GetCellData())
    weights = abs(data["Area"] if read.is_plane(rock) else data["Volume"])
    mean = np.average(tensors(data["stress"]), axis=0, weights=weights)
    dim = 2 if read.is_plane(rock) else 3
    return -np.linalg.eigvalsh(mean[:dim, :dim])[::-1]


def draw_circles(ax, principal, traction):
    """Draws half a circle for each pair of principal stresses."""
    for i in range(len(principal)):
        for j in range(i):
            centre, radius = 0.5 * (principal[i] + principal[j]), 0.5 * (principal[i] - principal[j])
            angle = np.linspace(0, np.pi, 181)
            ax.plot(
                traction(centre + radius * np.cos(angle)),
                traction(radius * np.sin(angle)),
                color=INK,
                linewidth=0.8,
                label="mean stress of the rock" if (i, j) == (1, 0) else None,
            )


def draw_envelopes(ax, joints, traction, largest):
    """Draws one line for each distinct strength of the joints {name: entries} up to the largest compression.

    Names joints with other laws. Returns the strengths at half of this compression."""
    normal, names, unknown = np.linspace(0, largest, 200), {}, []
    for name, joint in joints.items():
        bound = strength(joint, normal)
        (unknown if bound is None else names.setdefault(tuple(bound), [])).append(name)
    for k, bound in enumerate(names):
        if k == MAX_ENVELOPES:
            unknown += [name for some in list(names.values())[k:] for name in some]
            break
        ax.plot(
            traction(normal),
            traction(bound),
            color=LINES[(3, 5)[k // len(STYLES)]],
            linestyle=STYLES[k % len(STYLES)],
            label=f"strength of {listed(names[bound])}",
        )
    if unknown:
        ax.plot([], [], linestyle="", label=f"strength not drawn: {listed(unknown)}")
    return [float(np.interp(0.5 * largest, normal, bound)) for bound in list(names)[:MAX_ENVELOPES]]


def listed(names):
    """Returns the first names and the number of the others."""
    others = len(names) - MAX_NAMES
    return ", ".join(map(str, names[:MAX_NAMES])) + (f" and {others} more" if others > 0 else "")


def stress_paths(content, time):
    """Returns {name: (compressions, shear tractions)} over the steps up to a time.

    These are means over the single fractures with the largest slip. The result is empty for one step."""
    steps = [step for step in content["steps"] if step.get("single_fractures") and step["time"] <= time]
    if len(steps) < 2 or "max_slip" not in steps[-1]["single_fractures"]:
        return {}
    last = steps[-1]["single_fractures"]
    slipped = last.get("fraction_has_slipped") or [1] * len(last["max_slip"])  # without: round-off of slip
    slip = [(value or 0) * ((share or 0) > 0) for value, share in zip(last["max_slip"], slipped)]
    shown = [k for k in foremost(slip, MAX_PATHS) if slip[k] > 0]
    means = np.array(
        [[step["single_fractures"]["mean_traction_local"][k] for k in shown] for step in steps], dtype=float
    )
    names = [content["single_fractures"][k]["name"] for k in shown]
    return {name: (-means[:, k, 0], np.linalg.norm(means[:, k, 1:], axis=1)) for k, name in enumerate(names)}


def joints_of(scene, content):
    """Returns {name: entries} of the joints of fractures, and of the single fractures with own entries."""
    materials = scene.get("Materials", {})
    used = [f.get("material") for f in scene.get("Fractures", {}).values() if isinstance(f, dict)]
    joints = {name: materials.get(name, {}) for name in used}
    for one in content.get("single_fractures", []):
        if one.get("own_joint"):
            joints[one["name"]] = {**materials.get(one["own_joint"]["material"], {}), **one["own_joint"]}
    return joints


def of_step(rock, joints, scene, title, content, time):
    """Returns the figure of the grids of rock and fractures, with scene as in read.scene and `content` of results.json.

    The paths end at `time`. Circles are drawn only without a fluid, when effective and total stress are equal."""
    data = read.arrays(joints.GetCellData())
    size = scales(rock, data)[1]
    local = data["traction local"]
    normal, shear = without_noise(-local[:, 0], size), without_noise(np.linalg.norm(local[:, 1:], axis=1), size)
    wet = effective(data)
    principal = np.zeros(0) if wet else mean_stress(rock)
    paths = stress_paths(content, time)
    traction = Quantity(wet + "normal compression", "Pa", normal, shear, principal, *(v for path in paths.values() for v in path))
    figure, ax = plt.subplots(figsize=(6.4, 4.4))
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    for k, name in enumerate(STATES):
        on = data["state"] == k
        if on.any():
            ax.plot(
                traction(normal[on]),
                traction(shear[on]),
                "o",
                markersize=3,
                markeredgewidth=0,
                alpha=0.7,
                color=STATE_COLOURS(k),
                label=f"faces that {name}" if k else "open faces",
            )
    draw_circles(ax, principal, traction)
    highest = [np.max(shear, initial=0), 0.5 * np.ptp(principal) if len(principal) else 0]
    for k, (name, path) in enumerate(paths.items()):
        line = {key: look(k)[key] for key in ("color", "linestyle")}
        ax.plot(*map(traction, path), linewidth=0.9, label=f"path of {name}", **line)
        ax.plot(*(traction(values[-1:]) for values in path), "s", markersize=4, color=line["color"])
        highest.append(np.max(path[1]))
    largest = max([np.max(normal, initial=0), np.max(principal, initial=0), *(np.max(path[0]) for path in paths.values())])
    strengths = draw_envelopes(ax, joints_of(scene, content), traction, 1.05 * largest)
    ax.axvline(0, color=FAINT, linewidth=0.6, zorder=1)
    top = traction(max(1.25 * max(highest), *strengths)) if strengths else 1.25 * traction(max(highest))
    ax.set_ylim(-0.016 * (top or 1), top or 1)  # half of each line of strength, or more, is visible
    ax.set(xlabel=traction.label, ylabel=f"shear traction ({traction.unit})")
    ax.legend(loc="upper left", bbox_to_anchor=(1, 1))
    return figure
