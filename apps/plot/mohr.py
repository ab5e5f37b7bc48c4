"""Stress on fracture faces in Mohr's diagram: shear against normal compression, beside the strength of the joints and
the circles of the mean stress in the rock."""
import math

import numpy as np
import read
from bulk import tensors
from fractures import effective, scales
from style import FAINT, INK, LINES, Quantity, STATE_COLOURS, STATES, STYLES, plt, without_noise

MOST_ENVELOPES = 4


def number(joint, name, default=None):
    """An entry that is a number; None of one that is an expression."""
    try:
        return float(joint.get(name, "nan" if default is None else default))
    except ValueError:
        return math.nan


def strength(joint, normal):
    """The largest shear traction of intact asperities under normal compressions, or None for laws that are not known
    here: c + mu N of Coulomb's, N tan(phi_r + JRC log10(JCS / N)) of Barton and Choubey's, whose angle is at most 70
    degrees."""
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
    """The principal stresses of the mean over the volume, smallest compression first, compression positive; in 2D of
    the plane."""
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
    """Half a circle between each two principal stresses."""
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


def draw_envelopes(ax, scene, traction, largest):
    """Of the joints that fractures name, up to the largest compression; those of laws that are not known are named."""
    used = list(
        dict.fromkeys(
            fracture.get("material") for fracture in scene.get("Fractures", {}).values() if isinstance(fracture, dict)
        )
    )
    normal, unknown, drawn = np.linspace(0, largest, 200), [], 0
    for name in used:
        bound = strength(scene.get("Materials", {}).get(name, {}), normal)
        if bound is None or drawn == MOST_ENVELOPES:
            unknown.append(str(name))
        else:
            ax.plot(
                traction(normal), traction(bound), color=LINES[3], linestyle=STYLES[drawn], label=f"strength of {name}"
            )
            drawn += 1
    if unknown:
        ax.plot([], [], linestyle="", label=f"no strength drawn of {', '.join(unknown)}")


def of_step(rock, joints, scene, title):
    """Of the grids of the rock and of the fractures, and the scene as read.scene has it. Circles only where no fluid
    makes a difference between the stress of the rock and that of the fractures."""
    data = read.arrays(joints.GetCellData())
    size = scales(rock, data)[1]
    local = data["traction local"]
    normal, shear = without_noise(-local[:, 0], size), without_noise(np.linalg.norm(local[:, 1:], axis=1), size)
    wet = effective(data)
    principal = np.zeros(0) if wet else mean_stress(rock)
    traction = Quantity(wet + "normal compression", "Pa", normal, shear, principal)
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
    draw_envelopes(ax, scene, traction, 1.05 * max(np.max(normal, initial=0), np.max(principal, initial=0)))
    ax.axvline(0, color=FAINT, linewidth=0.6, zorder=1)
    top = traction(max(np.max(shear, initial=0), 0.5 * np.ptp(principal) if len(principal) else 0))
    ax.set_ylim(-0.02 * (top or 1), 1.25 * (top or 1))
    ax.set(xlabel=traction.label, ylabel=f"shear traction ({traction.unit})")
    ax.legend(loc="upper left", bbox_to_anchor=(1, 1))
    return figure
