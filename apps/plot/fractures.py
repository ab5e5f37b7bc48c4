"""Pictures of fractures: slip, opening, traction and contact state, along traces in 2D, on faces in 3D."""
import numpy as np
import read
from network import Network
from style import (FACE_COLOURS, FACE_STATES, FAINT, INK, LINES, Quantity, colour_bar, foremost, limits, natural, plt,
                   state_bar, without_noise)


STRAIGHT = np.cos(np.radians(30))
MAX_NAMES = 15  # of traces of one fracture


def onward(face, at, others, n_there, faces, key, points):
    """Returns the next face at the end `at` of a face, or None.

    At an intersection only a straight continuation counts."""
    def leaving(i):
        a, b = faces[i] if key[faces[i][0]] == at else faces[i][::-1]
        return (points[b] - points[a]) / np.linalg.norm(points[b] - points[a])
    if n_there <= 2:
        return next(iter(others), None)
    straight = [-leaving(face) @ leaving(i) for i in others]
    return others[int(np.argmax(straight))] if max(straight, default=-1) > STRAIGHT else None


def chains(segments):
    """Returns consecutive faces of a fracture: lists of faces, with the arc length at their ends (n + 1).

    Each trace gives one list, also if traces cross."""
    points, faces = segments.points, [tuple(s[:2]) for s in segments.polygons]
    used = sorted({p for face in faces for p in face})
    tolerance = 1e-9 * np.max(np.ptp(points[used], axis=0))
    place = {}  # one number for all points at the same place
    key = {p: place.setdefault(tuple(np.round((points[p] - points[used[0]]) / tolerance)), len(place)) for p in used}
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
            face = onward(face, at, [i for i in around[at] if i in left], len(around[at]), faces, key, points)
        found.append((chain, np.array(arc)))
    return found


def scales(rock, data):
    """Returns reference values for round-off: of displacements and jumps, m, and of stresses and tractions, Pa."""
    displacement, stress = (read.arrays(of)[name] for of, name in ((rock.GetPointData(), "displacement"), (rock.GetCellData(), "stress")))
    largest = lambda vectors: np.max(np.linalg.norm(vectors, axis=1), initial=0)
    return max(largest(displacement), largest(data["jump"])), max(np.max(abs(stress), initial=0), largest(data["traction"]))


def effective(data):
    """Returns the prefix of tractions: effective, i.e. total traction plus pressure, if there is a fluid."""
    wet = "fracture pressure" in data or np.any(data.get("fluid pressure", 0))
    return "effective " if wet else ""


def quantities(data, length, stress):
    """Returns {name: (values, unit)} in m or Pa, without the round-off of the given length and stress."""
    jump, traction = data["jump local"], data["traction local"]
    return {"tangential jump": (without_noise(np.linalg.norm(jump[:, 1:], axis=1), length), "m"),
            "slip": (without_noise(data["slip"], length), "m"),
            "opening": (without_noise(data["opening"], length), "m"),
            "normal traction": (without_noise(traction[:, 0], stress), "Pa"),
            "shear traction": (without_noise(np.linalg.norm(traction[:, 1:], axis=1), stress), "Pa")}


def face_states(data):
    """Returns the index of FACE_STATES of each face. Error for results of earlier versions."""
    if "has slipped" not in data:
        raise read.PlotError('fractures.pvd: has no array "has slipped"; run the scene again')
    state = data["state"].astype(int)
    return np.select([state == 0, state == 2, data["has slipped"] > 0], [0, 3, 2], 1)


ROWS = {"tangential jump": ("tangential jump", "slip"), "opening": ("opening",),
        "traction": ("normal traction", "shear traction")}  # in the 2D picture


class Trace:
    """Trace in 2D: name, short name within its set, faces, arc length at their ends (m), colour."""

    def __init__(self, name, label, faces, arc, colour):
        self.name, self.label, self.faces, self.arc, self.colour = name, label, faces, arc, colour


def chains_of(surface, chosen):
    """Returns (faces, arc length) of each chain among the chosen faces, in the order of x."""
    found = [(chosen[chain], arc) for chain, arc in chains(surface.part(chosen))]
    return sorted(found, key=lambda chain: tuple(np.min(surface.points[surface.polygons[chain[0][0]][:2]], axis=0)))


def traces_of(surface, number, name, singles=()):
    """Returns the traces of a fracture, with colours for the largest tangential jumps.

    The traces are single fractures with the names of results.json, or else numbered in the order of x."""
    chosen = np.flatnonzero(surface.cell_data["fracture"] == number)
    if singles and "single fracture" in surface.cell_data:
        of = surface.cell_data["single fracture"][chosen].astype(int)
        order = np.argsort(of, kind="stable")
        groups = np.split(chosen[order], np.flatnonzero(np.diff(of[order])) + 1)
        named = [(singles[int(surface.cell_data["single fracture"][faces[0]])]["name"], faces) for faces in groups]
        found = [(single, *chain) for single, faces in named for chain in chains_of(surface, faces)]
    else:
        found = chains_of(surface, chosen)
        found = [(f"{name} {k + 1}" if len(found) > 1 else name, *chain) for k, chain in enumerate(found)]
    jump = np.linalg.norm(surface.cell_data["jump local"][:, 1:], axis=1)
    shown = foremost([np.max(jump[faces]) for _, faces, _ in found], len(LINES))
    return [Trace(one, one.removeprefix(name + " "), faces, arc, LINES[shown.index(k)] if k in shown else FAINT)
            for k, (one, faces, arc) in enumerate(found)]


def draw_curves(ax, traces, row, drawn, quantity):
    """Draws the first quantity of a row with solid lines, the second with dashes. One trace has a colour for each."""
    ax.use_sticky_edges = False  # keeps a distance between a line at zero and the frame
    for trace in sorted(traces, key=lambda trace: trace.colour != FAINT):
        for i, name in enumerate(row):
            ax.stairs(quantity(drawn[name][0][trace.faces]), trace.arc, baseline=None, linestyle="--" if i else "-",
                      color=LINES[i] if len(traces) == 1 else trace.colour, linewidth=0.6 if trace.colour == FAINT else 1.6)
    ax.axhline(0, color=FAINT, linewidth=0.6, zorder=1)


def draw_states(ax, traces, state, first):
    """Draws a strip for each trace, from top to bottom, with labels in the first column."""
    for k, trace in enumerate(traces):
        strip = state[trace.faces][None, :]
        ax.pcolormesh(trace.arc, [k + 0.54, k + 1.46], strip, cmap=FACE_COLOURS, vmin=-0.5, vmax=3.5)
    ax.set(xlabel="arc length (m)", ylim=(len(traces) + 0.5, 0.5))
    ax.yaxis.set_major_locator(plt.MaxNLocator(6, integer=True, min_n_ticks=1) if len(traces) > 1 else plt.NullLocator())
    named = 1 < len(traces) <= MAX_NAMES
    if named:
        ax.set_yticks(range(1, len(traces) + 1), [trace.label for trace in traces], fontsize=5)
    if first:
        ax.set_ylabel("state", rotation=0 if not named else 90, ha="right" if not named else "center", va="center", labelpad=4 if len(traces) == 1 else 8)
    ax.grid(False)


def legend_of_traces(ax, traces):
    """Draws the legend of the colours of traces above a column."""
    handles = [plt.Line2D([], [], color=t.colour, label=t.label) for t in traces if t.colour != FAINT]
    if len(handles) < len(traces):
        handles.append(plt.Line2D([], [], color=FAINT, linewidth=0.6, label="others"))
    ax.add_artist(ax.legend(handles=handles, loc="lower right", bbox_to_anchor=(1, 0.98), ncol=len(handles), columnspacing=0.7,
                            handlelength=1, handletextpad=0.3, borderaxespad=0))
    ax.legend_ = None  # allows a further legend


def legend_of_lines(ax, row, n_traces):
    """Draws the legend of the two quantities of a row beside its axes; with colours if there is one trace."""
    one = n_traces == 1
    handles = [plt.Line2D([], [], color=LINES[i] if one else INK, linestyle="--" if i else "-", label=name) for i, name in enumerate(row)]
    ax.legend(handles=handles, loc="upper left", bbox_to_anchor=(1, 1), fontsize=7, handlelength=1.6)


MAX_COLUMNS = 4


def along(surface, names, title, length, stress, singles=()):
    """Returns the 2D figure, a column for each fracture, with values over the arc length."""
    named = {number: names[number] if number < len(names) else f"fracture {number}" for number in set(surface.cell_data["fracture"].astype(int))}
    numbers = sorted(named, key=lambda number: natural(named[number]))
    traces = {number: traces_of(surface, number, named[number], singles) for number in numbers}
    columns = min(len(numbers), MAX_COLUMNS)
    blocks, strips = -(-len(numbers) // columns), min(0.2 + 0.06 * max(map(len, traces.values())), 1.5)
    width, height = max(5.2, 3.6 * columns), blocks * (5.4 + 1.6 * strips)
    figure = plt.figure(figsize=(width, height))
    figure.set_layout_engine("none")  # the constrained layout takes minutes for many axes
    grid = figure.add_gridspec(blocks, columns, left=0.7 / width, right=1, bottom=0.5 / height, top=1 - 0.7 / height, wspace=0.1,
                               hspace=0.8 * blocks / height)
    figure.suptitle(title, fontsize=10, x=0, y=1, ha="left", va="top")
    drawn = quantities(surface.cell_data, length, stress)
    prefix = effective(surface.cell_data)
    units = [Quantity((prefix if label == "traction" else "") + label, drawn[row[0]][1], *(drawn[name][0] for name in row))
             for label, row in ROWS.items()]
    first = None
    for k, number in enumerate(numbers):
        column, cells = [], grid[k // columns, k % columns].subgridspec(len(ROWS) + 1, 1, height_ratios=[1] * len(ROWS) + [strips], hspace=0.12)
        for r in range(len(ROWS) + 1):
            column.append(figure.add_subplot(cells[r], sharex=column[0] if r else None, sharey=first[r] if first and r < len(ROWS) else None))
        first = first or column
        column[0].set_title(named[number], loc="left", pad=6 if len(traces[number]) == 1 else 18)
        for ax, row, quantity in zip(column, ROWS.values(), units):
            draw_curves(ax, traces[number], row, drawn, quantity)
            ax.tick_params(labelbottom=False, labelleft=k % columns == 0)
            ax.set_ylabel(quantity.label if k % columns == 0 else "")
            ax.yaxis.set_label_coords(-0.5 / 3.6, 0.5)
        draw_states(column[-1], traces[number], face_states(surface.cell_data), k % columns == 0)
        if len(traces[number]) > 1:
            legend_of_traces(column[0], traces[number])
        for ax, row in zip(column, ROWS.values()):
            if k % columns == columns - 1 and len(row) > 1:
                legend_of_lines(ax, row, max(map(len, traces.values())))
    patches = [plt.Rectangle((0, 0), 1, 1, color=FACE_COLOURS(i)) for i in range(len(FACE_STATES))]
    figure.legend(patches, FACE_STATES, loc="upper right", bbox_to_anchor=(1, 1), ncol=4, columnspacing=1, handlelength=1.2,
                  borderaxespad=0)
    return figure


def on_faces(view, title, length, stress):
    """Returns the 3D figure with coloured faces, and names in the panel of contact states."""
    figure, axes = plt.subplots(2, 3, figsize=(10, 7.6))
    figure.suptitle(title, fontsize=10)
    figure.supxlabel(view.note(), fontsize=8)
    bar = {"location": "bottom", "shrink": 0.7, "pad": 0.02}
    colours = {"opening": "RdBu_r", "normal traction": "cividis", "shear traction": "cividis"}
    for ax, (name, (values, base)) in zip(axes.flat, quantities(view.data, length, stress).items()):
        prefix = effective(view.data) if name == "normal traction" else ""
        quantity, palette = Quantity(prefix + name, base, values), plt.get_cmap(colours.get(name, "YlOrRd"))
        norm = limits(quantity(values), signed=name == "opening", clip=True)
        view.draw(ax, palette(norm(quantity(values))))
        colour_bar(figure, ax, norm, palette, quantity.label, **bar)
    norm = state_bar(figure, axes[-1, -1], **bar)
    view.draw(axes[-1, -1], FACE_COLOURS(norm(face_states(view.data))))
    view.write_names(axes[-1, -1])
    return figure


def of_step(rock, grid, names, title, singles=(), whole=False, wells=()):
    """Returns the figure of the grids of rock and fractures (at least one face).

    `singles` as in results.json, `wells` as in read.wells."""
    if grid.GetCell(0).GetCellDimension() == 1:
        surface = read.segments(grid)
        return along(surface, names, title, *scales(rock, surface.cell_data), singles)
    view = Network(rock, grid, names, singles, whole, wells)
    return on_faces(view, title, *scales(rock, view.data))
