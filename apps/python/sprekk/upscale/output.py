"""Files of tensors: tables, fields for ParaView, and pictures."""
from pathlib import Path

import numpy as np

from .components import matrix_of, principal

QUANTITIES = {"permeability": "principal permeability, m$^2$", "stiffness": "Young's modulus along the axes, GPa",
              "anisotropy": "largest / smallest"}
STYLES = {"linear": "-", "uniform": "--", "periodic": ":"}


class Case:
    """Results of one block. index: position in a grid of blocks, or a seed; corners: of the block, m."""

    def __init__(self, label, found, corners=None):
        self.label, self.found, self.corners = label, found, corners


def write(folder, cases, pictures=True):
    """Writes states.csv, tensors.csv, principal.csv, for several blocks scatter.csv, fields of blocks, and pictures.

    Several networks in one place have no fields."""
    import pandas
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    tensors = labelled(cases, lambda case: case.found.table())
    tables = {"states": labelled(cases, lambda case: case.found.states()), "tensors": tensors,
              "principal": pandas.DataFrame(principal_rows(cases), columns=[
                  "block", "state", "tensor", "conditions", "number", "value", *"xyz"[:cases[0].found.dim]])}
    if len(cases) > 1:
        keys = ["state", "tensor", "conditions", "component", "unit"]
        by = tensors.groupby(keys, sort=False)["value"]
        tables["scatter"] = by.agg(["count", "mean", "std", "min", "max"]).reset_index()
    for name, table in tables.items():
        table.to_csv(folder / f"{name}.csv", index=False, float_format="%.12g")
    written = [f"{name}.csv" for name in tables]
    if len(cases) == 1 or all(case.corners is not None for case in cases):
        written += write_fields(folder, cases)
    if pictures:
        written += draw(folder, cases)
    return [folder / name for name in written]


def labelled(cases, table_of):
    import pandas
    tables = []
    for case in cases:
        table = table_of(case)
        table.insert(0, "block", case.label)
        tables.append(table)
    return pandas.concat(tables)


def principal_rows(cases):
    """Yields rows of the principal values of the symmetric parts of permeability and Biot tensor."""
    for case in cases:
        for number, result in enumerate(case.found.results):
            matrices = [("permeability", conditions, K) for conditions, K in result.permeability.items()]
            matrices += [("Biot tensor", conditions, matrix_of(tangent.biot)) for conditions, tangent in result.solid.items()]
            for name, conditions, matrix in matrices:
                for k, (value, direction) in enumerate(zip(*principal(matrix))):
                    yield (case.label, number, name, conditions, k + 1, value, *direction)


def write_fields(folder, cases):
    """Writes the blocks as cells with tensors of nine components: blocks.pvd, with a file for each state as time."""
    import meshio
    names = []
    for number in range(len(cases[0].found.results)):
        names.append(f"blocks_{number:04d}.vtu")
        mesh_of(cases, number, meshio).write(folder / names[-1])
    steps = "".join(f'    <DataSet timestep="{number}" file="{name}"/>\n' for number, name in enumerate(names))
    (folder / "blocks.pvd").write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n'
                                       f"  <Collection>\n{steps}  </Collection>\n</VTKFile>\n")
    return ["blocks.pvd", *names]


def mesh_of(cases, number, meshio):
    """Returns the blocks with their stress and tensors at one state."""
    dim = cases[0].found.dim
    unit = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    if dim == 3:
        unit = np.concatenate([unit, unit + [0, 0, 1]])
    points, data = [], {}
    for case in cases:
        corners = case.corners if case.corners is not None else case.found.corners
        low, high = (np.concatenate([corner, [0] * (3 - dim)]) for corner in corners)
        points.append(low + unit * (high - low))
        result = case.found.results[number]
        data.setdefault("stress", []).append(nine(matrix_of(result.stress)))
        data.setdefault("pressure", []).append(result.pressure)
        for conditions, K in result.permeability.items():
            data.setdefault(f"permeability {conditions}", []).append(nine(K))
        for conditions, tangent in result.solid.items():
            data.setdefault(f"Biot tensor {conditions}", []).append(nine(matrix_of(tangent.biot)))
            data.setdefault(f"compliance {conditions}", []).append(tangent.compliance.ravel())
    cells = np.arange(len(cases) * len(unit)).reshape(len(cases), -1)
    complete = {name: [np.array(values)] for name, values in data.items() if len(values) == len(cases)}
    return meshio.Mesh(np.concatenate(points), [("quad" if dim == 2 else "hexahedron", cells)], cell_data=complete)


def nine(matrix):
    whole = np.zeros((3, 3))
    whole[:len(matrix), :len(matrix)] = matrix
    return whole.ravel()


# Pictures

def draw(folder, cases):
    """Draws principal permeabilities and moduli against the state, and ellipses or ellipsoids of the permeability."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    written = []
    if len(cases[0].found.results) > 1:
        figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
        for one, quantity in zip(axes, QUANTITIES):
            paths(one, cases, quantity)
        figure.savefig(folder / "path.png", dpi=120)
        written.append("path.png")
    if all(case.found.results[-1].permeability for case in cases):
        figure = plt.figure(figsize=(5, 4.5), layout="constrained")
        (ellipses if cases[0].found.dim == 2 else ellipsoids)(figure, cases)
        figure.savefig(folder / "permeability.png", dpi=120)
        written.append("permeability.png")
    plt.close("all")
    return written


def curves(result, quantity, conditions):
    """Returns {label: value} of a quantity at one state; empty if it is not available."""
    K, tangent = result.permeability.get(conditions), result.solid.get(conditions)
    permeabilities = [] if K is None else list(principal(K)[0])
    moduli = [] if tangent is None else list(1e-9 / np.diag(tangent.compliance)[:2 if len(result.stress) == 3 else 3])
    if quantity == "permeability":
        return {str(k + 1): value for k, value in enumerate(permeabilities)}
    if quantity == "stiffness":
        return {"xyz"[k]: value for k, value in enumerate(moduli)}
    found = {"permeability": permeabilities, "Young's modulus": moduli}
    return {name: max(values) / min(values) for name, values in found.items() if values}


def paths(axes, cases, quantity):
    """Draws values against the mean compressive stress of the path."""
    dim = cases[0].found.dim
    for case in cases:
        pressure = [-np.mean(result.stress[:dim]) / 1e6 for result in case.found.results]
        for conditions, style in STYLES.items():
            states = [curves(result, quantity, conditions) for result in case.found.results]
            for k, name in enumerate(states[0]):
                label = f"{name}, {conditions}" if case is cases[0] else None
                axes.plot(pressure, [state[name] for state in states], style, color=f"C{k}", marker=".", label=label)
    axes.set_xlabel("mean compressive stress, MPa")
    axes.set_ylabel(QUANTITIES[quantity])
    if quantity != "stiffness":
        axes.set_yscale("log")
    if axes.lines:
        axes.legend(fontsize=7)


def ellipses(figure, cases):
    """Draws an ellipse with half axes sqrt(K_i) for each block: first state thin, last state thick."""
    axes = figure.subplots()
    largest = max(principal(case.found.results[0].permeability[c])[0][0] for case in cases
                  for c in case.found.results[0].permeability)
    angle = np.linspace(0, 2 * np.pi, 100)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    for k, case in enumerate(cases):
        low, high = case.corners if case.corners is not None else (np.array([k, 0.0]), np.array([k + 1, 1.0]))
        scale = 0.45 * min(high - low) / np.sqrt(largest)
        for number, width in ((0, 0.7), (-1, 1.8)):
            for color, (conditions, K) in enumerate(case.found.results[number].permeability.items()):
                values, directions = principal(K)
                curve = directions.T @ (np.sqrt(np.maximum(values, 0))[:, None] * circle)
                axes.plot(*((low + high)[:, None] / 2 + scale * curve), color=f"C{color}", linewidth=width,
                          label=f"{conditions}, {'first' if number == 0 else 'last'} state" if k == 0 else None)
        box = np.array([low, [high[0], low[1]], high, [low[0], high[1]], low])
        axes.plot(*box.T, color="0.7", linewidth=0.7)
    axes.set_aspect("equal")
    axes.set_title("half axes: square roots of principal permeabilities", fontsize=8)
    axes.legend(fontsize=7)


def ellipsoids(figure, cases):
    """Draws the ellipsoid with half axes sqrt(K_i) of the first block, in the last state."""
    axes = figure.add_subplot(projection="3d")
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0, np.pi, 20))
    sphere = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    for color, (conditions, K) in enumerate(cases[0].found.results[-1].permeability.items()):
        values, directions = principal(K)
        axes.plot_wireframe(*np.einsum("ki,kab->iab", directions, np.sqrt(np.maximum(values, 0))[:, None, None] * sphere),
                            color=f"C{color}", linewidth=0.5, label=conditions)
    axes.set_title("half axes: square roots of principal permeabilities, m", fontsize=8)
    axes.legend(fontsize=7)
