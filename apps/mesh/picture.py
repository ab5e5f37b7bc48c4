"""Picture of a mesh with the orientations of the fractures, one colour for each set.

In 2D it shows cells and fractures, in 3D the faces of the fractures."""
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from shapes import NetworkError

sys.path.insert(1, str(Path(__file__).parents[1] / "plot"))
import orientations  # noqa: E402
from style import FAINT, INK, LINES, plt, save  # noqa: E402

OPACITY = 0.8  # of fractures in 3D


def sets_of(mesh, plan):
    """Yields (name, colour, faces) of each set of fractures."""
    names = list(dict.fromkeys(owner.group for owner in plan.owners if owner.kind == "fracture"))
    for k, name in enumerate(names):
        owners = [i for i, owner in enumerate(plan.owners) if owner.kind == "fracture" and owner.group == name]
        yield name, LINES[k % len(LINES)], mesh.faces[np.isin(mesh.face_owner, owners)]


def of_plane(ax, mesh, plan):
    x = mesh.points[:, :2]
    ax.add_collection(PolyCollection(x[mesh.cells], facecolors="none", edgecolors=FAINT, linewidths=0.2))
    for name, colour, faces in sets_of(mesh, plan):
        ax.add_collection(LineCollection(x[faces], colors=colour, linewidths=1.3, label=name))
    ax.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
    ax.autoscale_view()
    ax.grid(False)


def sides_of(faces):
    """Returns the sides of triangles, an array (sides, 2), each once."""
    return np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)), axis=0)


def of_body(ax, mesh, plan):
    import space  # requires VTK
    parts = []
    for name, colour, faces in sets_of(mesh, plan):
        parts.append(space.Part(mesh.points, list(faces), colour, OPACITY))
        parts.append(space.Part(mesh.points, list(sides_of(faces)), INK))
        ax.plot([], [], color=colour, label=name)
    try:
        space.draw(ax, parts, np.array([plan.network.domain.low, plan.network.domain.high]))
    except space.PlotError as error:
        raise NetworkError(str(error)) from None


def draw(mesh, plan, path, dpi=110):
    figure = plt.figure(figsize=(9, 6))
    left, right = figure.add_gridspec(1, 2, width_ratios=(3, 1.3))
    ax = figure.add_subplot(left)
    (of_plane if plan.dim == 2 else of_body)(ax, mesh, plan)
    ax.legend(fontsize=8, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=4)
    given = [(colour, [f.points for f in plan.network.fractures if f.group == name]) for name, colour, _ in sets_of(mesh, plan)]
    orientations.draw(figure.add_subplot(right, projection="polar"), plan.dim, given)
    save(figure, path, dpi)
    plt.close(figure)
