"""Picture of a mesh with the orientations of the fractures, one colour for each set.

In 2D it shows cells and fractures, in 3D the faces of the fractures."""
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

sys.path.append(str(Path(__file__).parents[1] / "plot"))
import orientations  # noqa: E402
from style import FAINT, INK, LINES, plt, save  # noqa: E402


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
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.grid(False)


def of_body(ax, mesh, plan):
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    for name, colour, faces in sets_of(mesh, plan):
        ax.add_collection3d(Poly3DCollection(mesh.points[faces], facecolors=colour, edgecolors=INK, linewidths=0.1, alpha=0.7))
        ax.plot([], [], color=colour, label=name)
    domain = plan.network.domain
    for axis, low, high in zip("xyz", domain.low, domain.high):
        getattr(ax, f"set_{axis}lim")(low, high)
    ax.set_zlabel("z (m)")
    ax.set_box_aspect(domain.high - domain.low)
    ax.set_proj_type("ortho")
    ax.view_init(elev=22, azim=-58)


def draw(mesh, plan, path, dpi=110):
    plane = plan.dim == 2
    figure = plt.figure(figsize=(9, 6))
    left, right = figure.add_gridspec(1, 2, width_ratios=(3, 1.3))
    ax = figure.add_subplot(left, projection=None if plane else "3d")
    (of_plane if plane else of_body)(ax, mesh, plan)
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    ax.legend(fontsize=8, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=4)
    given = [(colour, [f.points for f in plan.network.fractures if f.group == name]) for name, colour, _ in sets_of(mesh, plan)]
    orientations.draw(figure.add_subplot(right, projection="polar"), plan.dim, given)
    save(figure, path, dpi)
    plt.close(figure)
