"""Fractures: slip, opening, traction and contact state, along them in 2D, on them in 3D."""
import numpy as np
import read
from style import (FAINT, LINES, Quantity, STATE_COLOURS, STATES, colour_bar, draw_polygons_3d, limits, plt, state_bar,
                   without_noise)


def chains(segments):
    """Faces of a fracture one after the other: lists of faces with the arc length at their ends, (n + 1)."""
    points, faces = segments.points, [tuple(s[:2]) for s in segments.polygons]
    tolerance = 1e-9 * np.max(np.ptp(points, axis=0))
    place = {}  # one number for all points of a place
    key = [place.setdefault(tuple(np.round(points[p] / tolerance)), len(place)) for p in range(len(points))]
    around = {}
    for i, face in enumerate(faces):
        for p in face:
            around.setdefault(key[p], []).append(i)
    left, found = set(range(len(faces))), []
    while left:
        ends = [i for i in left if any(len(left.intersection(around[key[p]])) == 1 for p in faces[i])]
        face = min(ends or left, key=lambda i: tuple(np.min(points[list(faces[i])], axis=0)))
        at = next((key[p] for p in faces[face] if len(left.intersection(around[key[p]])) == 1), key[faces[face][0]])
        chain, arc = [], [0.0]
        while face is not None:
            left.remove(face)
            a, b = faces[face]
            chain.append(face)
            arc.append(arc[-1] + np.linalg.norm(points[b] - points[a]))
            at = key[b] if key[a] == at else key[a]
            face = next((i for i in around[at] if i in left), None)
        found.append((chain, np.array(arc)))
    return found


def part(surface, number):
    """The faces of one fracture."""
    chosen = np.flatnonzero(surface.cell_data["fracture"] == number)
    return read.Surface(surface.points, [surface.polygons[i] for i in chosen],
                        {name: values[chosen] for name, values in surface.cell_data.items()}, {})


def scales(data):
    """Sizes that round-off is measured by: of jumps, of tractions."""
    return np.max(np.linalg.norm(data["jump"], axis=1)), np.max(np.linalg.norm(data["traction"], axis=1))


def quantities(data):
    """(values, in m or Pa) by name; without round-off."""
    length, stress = scales(data)
    jump, traction = data["jump local"], data["traction local"]
    return {"tangential jump": (without_noise(np.linalg.norm(jump[:, 1:], axis=1), length), "m"),
            "slip": (without_noise(data["slip"], length), "m"),
            "opening": (without_noise(data["opening"], length), "m"),
            "normal traction": (without_noise(traction[:, 0], stress), "Pa"),
            "shear traction": (without_noise(np.linalg.norm(traction[:, 1:], axis=1), stress), "Pa")}


ROWS = {"tangential jump": ("tangential jump", "slip"), "opening": ("opening",),
        "traction": ("normal traction", "shear traction")}  # of the picture in 2D


def along(surface, names, title):
    """2D: a column for each fracture, values over the arc length."""
    numbers = sorted(set(surface.cell_data["fracture"].astype(int)))
    figure, axes = plt.subplots(len(ROWS) + 1, len(numbers), sharex="col", sharey="row", squeeze=False,
                                figsize=(max(5.2, 3.6 * len(numbers)), 6),
                                gridspec_kw={"height_ratios": [1] * len(ROWS) + [0.2]})
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    drawn = quantities(surface.cell_data)
    units = [Quantity(label, drawn[row[0]][1], *(drawn[name][0] for name in row)) for label, row in ROWS.items()]
    for column, number in zip(axes.T, numbers):
        chosen = np.flatnonzero(surface.cell_data["fracture"] == number)
        column[0].set_title(names[number] if number < len(names) else f"fracture {number}", loc="left")
        for k, (chain, arc) in enumerate(chains(part(surface, number))):
            for ax, row, quantity in zip(column, ROWS.values(), units):
                for i, name in enumerate(row):
                    ax.stairs(quantity(drawn[name][0][chosen][chain]), arc, baseline=None, color=LINES[i],
                              linewidth=1.6, linestyle="--" if name == "slip" else "-",
                              label=name if k == 0 and len(row) > 1 else None)
            state = surface.cell_data["state"][chosen][chain]
            column[-1].pcolormesh(arc, [0, 1], state[None, :], cmap=STATE_COLOURS, vmin=-0.5, vmax=2.5)
        column[-1].set(xlabel="arc length (m)", yticks=[])
        column[-1].grid(False)
        for ax in column[:-1]:
            ax.axhline(0, color=FAINT, linewidth=0.6, zorder=1)
    for ax, quantity in zip(axes[:, 0], units):
        ax.set_ylabel(quantity.label)
    axes[-1, 0].set_ylabel("state", rotation=0, ha="right", va="center")
    for row, ax in zip(ROWS.values(), axes[:, -1]):
        if len(row) > 1:
            ax.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncol=2, columnspacing=1, borderaxespad=0)
    patches = [plt.Rectangle((0, 0), 1, 1, color=STATE_COLOURS(i)) for i in range(3)]
    figure.legend(patches, STATES, loc="upper right", ncol=3, columnspacing=1, handlelength=1.2)
    return figure


def on_faces(surface, title):
    """3D: the faces coloured."""
    figure, axes = plt.subplots(2, 3, figsize=(9, 6.2), subplot_kw={"projection": "3d"})
    figure.suptitle(title, fontsize=10)
    bar = {"location": "bottom", "shrink": 0.7, "pad": 0.12}
    edges = [(0.5, 0.5, 0.5, 0.6)]
    colours = {"opening": "RdBu_r", "normal traction": "cividis", "shear traction": "cividis"}
    for ax, (name, (values, base)) in zip(axes.flat, quantities(surface.cell_data).items()):
        quantity, palette = Quantity(name, base, values), plt.get_cmap(colours.get(name, "inferno"))
        norm = limits(quantity(values), signed=name == "opening")
        draw_polygons_3d(ax, surface.corners(), palette(norm(quantity(values))), edges, zoom=0.95)
        colour_bar(figure, ax, norm, palette, quantity.label, zero=not np.any(values), **bar)
    norm = state_bar(figure, axes[-1, -1], **bar)
    draw_polygons_3d(axes[-1, -1], surface.corners(), STATE_COLOURS(norm(surface.cell_data["state"])), edges, zoom=0.95)
    return figure


def of_step(grid, names, title):
    """Of the fractures' grid, at least one face."""
    if grid.GetCell(0).GetCellDimension() == 1:
        return along(read.segments(grid), names, title)
    return on_faces(read.surface(grid), title)
