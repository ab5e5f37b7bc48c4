"""User-defined terms and equations, as functions of numpy arrays."""
from dataclasses import dataclass, field

import numpy as np


@dataclass
class State:
    """State of a residual evaluation, valid during the call only.

    t          time, s
    rate       factor, 1/s, of the increments of stored quantities since the start of the step
    histories  history variables {name: [owned entity, component]}, updated by Module.commit()"""
    t: float
    rate: float
    histories: dict


@dataclass
class Unknown:
    """Field of a module, with one row for each unknown.

    entity          node, cell, fracture face or facet (facet: of cells, fracture faces, and ridges of these)
    scale           name of the scale of its values
    row             typical size of its rows: {scale: factor}
    local_group     "fracture face": eliminated with contact, face by face
    condensed_into  field from which preconditioners eliminate this one; requires weak coupling among its unknowns
    balance         True: rows are balances of rates, which may differ by orders of magnitude
    smooth          True: suitable for multigrid; the matrix maps constants to almost zero"""
    name: str
    entity: str
    components: int = 1
    unit: str = "-"
    scale: str = "stress"
    row: dict = field(default_factory=dict)
    local_group: str = ""
    condensed_into: str = ""
    balance: bool = False
    smooth: bool = False


@dataclass
class Block:
    """Residual over all entities of a loop.

    The loops are cells, fracture faces, fracture sides, fracture cells, boundary faces and neighbours. The fracture
    faces are owned. The other loops include ghosts, and each rank adds to its owned rows.

    rows, columns  fields of the rows, and fields that the residual depends on
    residual       residual(x, state) -> {row: [entity, unknown of the entity]}, with x {column: array of this kind}
    jacobian       jacobian(x, state) -> {(row, column): [entity, unknown of the row, of the column]}; default: central
                   differences, for all entities at once"""
    loop: str
    rows: list
    columns: list
    residual: object
    jacobian: object = None

    def derivative(self, x, state):
        return self.jacobian(x, state) if self.jacobian else self.differences(x, state)

    def differences(self, x, state, step=6e-6):
        """Computes central differences with the increment step * max(max |column|, 1e-9)."""
        found = {}
        for column in self.columns:
            size = step * max(float(np.max(np.abs(x[column]), initial=0)), 1e-9)
            for k in range(x[column].shape[1]):
                ends = []
                for sign in (1, -1):
                    moved = x[column].copy()
                    moved[:, k] += sign * size
                    ends.append(self.residual({**x, column: moved}, state))
                for row in ends[0]:
                    change = (np.asarray(ends[0][row]) - np.asarray(ends[1][row])) / (2 * size)
                    found.setdefault((row, column), np.zeros((*change.shape, x[column].shape[1])))[:, :, k] = change
        return found


class Module:
    """Base class of user-defined terms or equations, for the argument `modules` of a Model.

    Override blocks() to add residuals. For the terms see docs/develop/embedding.md."""
    name = "own module"
    fingerprint = ""  # must be the same at the restart from a checkpoint
    unknowns = ()
    scales = {}  # {scale: magnitude without loads}, positive
    histories = {}  # {name: (entity, components)}
    stores = False  # True: rows contain State.rate * increments of stored quantities
    symmetric = False  # True: symmetric Jacobian
    merit = {}  # {own unknown: weight} of its squared rows in the merit, J; default 1/diagonal

    def blocks(self, mesh):
        """Returns the Blocks for the local Mesh, with ghosts."""
        return []

    def loads(self, t):
        """Returns the magnitudes of prescribed values at time t, {scale: magnitude}."""
        return {}

    def commit(self, state, x):
        """Updates the histories after a step, with x {column: [entity, unknown of the entity]} of each block."""


class FaceLaw(Module):
    """Shear traction T(w, lambda) of fractures, Pa, added to the friction of the scene.

    With the friction coefficient 0, closed faces transmit T only. T is the unknown "own shear" tau of each face:

        tau - T(w, lambda) = 0,    |f| tau . d(w_t)/du in the rows of the displacement.

    Derive from this class and override shear(). The number of tangential components is n = dim - 1. The class serves
    prototypes: Newton's method does not use its contact state. Built-in laws: docs/develop/add_a_law.md."""
    name = "face law"
    stiffness = 1e10  # order of the stiffness of the rock around a face, Pa/m, for the merit of Newton's method

    def shear(self, w, traction, state):
        """Returns T [face, n], Pa, at the jump w [face, dim], m, and the contact traction [face, dim], Pa.

        The normal component comes first. state.histories["jump"] is the jump at the start of the
        step, state.rate is 1/dt."""
        raise NotImplementedError

    def shear_derivative(self, w, traction, state):
        """Returns dT/dw [face, n, dim] and dT/dlambda [face, n, dim]; here by central differences."""
        found = []
        for k, values in enumerate((w, traction)):
            step = 6e-6 * max(float(np.max(np.abs(values), initial=0)), 1e-9)
            columns = []
            for unit in np.eye(values.shape[1]):
                moved = [values + sign * step * unit for sign in (1, -1)]
                ends = [self.shear(*((m, traction) if k == 0 else (w, m)), state) for m in moved]
                columns.append((ends[0] - ends[1]) / (2 * step))
            found.append(np.stack(columns, axis=2))
        return found

    def blocks(self, mesh):
        self.mesh, dim = mesh, mesh.dim
        self.unknowns = [Unknown("own shear", "fracture face", dim - 1, "Pa", "stress", {"stress": 1}, "fracture face")]
        self.histories = {"jump": ("fracture face", dim)}
        self.merit = {"own shear": float(np.mean(mesh.face_area)) / self.stiffness if len(mesh.face_area) else 0.0}
        self.push = self.pushes()
        return [Block("fracture faces", ["own shear"], ["displacement", "side bubble", "traction", "own shear"], self.law,
                      self.law_by),
                Block("fracture sides", ["displacement", "side bubble"], ["own shear"], self.forces, self.forces_by)]

    # Law: on owned faces

    def operators(self, n):
        """Returns dw/d(displacement, side bubble) of the first n faces, [face, dim, unknown] each."""
        frame, share = self.mesh.face_frame[:n], self.mesh.face_share[:n]
        sides = np.concatenate([-share, share], axis=1)  # [face, nodes of side - and +]
        bubbles = self.mesh.face_bubble[:n, None] * np.array([-1.0, 1.0])
        dim = self.mesh.dim
        return [np.einsum("fki,fa->fkai", frame, shares).reshape(n, dim, shares.shape[1] * dim) for shares in (sides, bubbles)]

    def jump(self, x):
        by_u, by_bubble = self.operators(len(x["traction"]))
        return (by_u @ x["displacement"][:, :, None] + by_bubble @ x["side bubble"][:, :, None])[:, :, 0]

    def law(self, x, state):
        return {"own shear": x["own shear"] - self.shear(self.jump(x), x["traction"], state)}

    def law_by(self, x, state):
        by_w, by_traction = self.shear_derivative(self.jump(x), x["traction"], state)
        by_u, by_bubble = self.operators(len(by_w))
        n = self.mesh.dim - 1
        return {("own shear", "displacement"): -by_w @ by_u, ("own shear", "side bubble"): -by_w @ by_bubble,
                ("own shear", "traction"): -by_traction, ("own shear", "own shear"): np.tile(np.eye(n), (len(by_w), 1, 1))}

    def commit(self, state, x):
        state.histories["jump"][:] = self.jump(x[0])

    # Forces on the rock: on sides with their cell on this rank

    def pushes(self):
        """Returns |f| d(w_t)/d(displacement of the side's cell, its bubble), [side, unknown, n] each."""
        mesh = self.mesh
        face, side = mesh.sides.T
        sign = np.where(side == 1, 1.0, -1.0) * mesh.face_area[face]
        nodes = mesh.cells[mesh.face_cells[face, side]]
        is_node = nodes[:, :, None] == mesh.faces[face, side][:, None, :]  # [side, node of the cell, node of the face]
        share = np.einsum("sab,sb->sa", is_node, mesh.side_share)
        along = mesh.face_frame[face, 1:]  # [side, n, dim]
        by_u = np.einsum("s,sa,ski->saik", sign, share, along)
        by_bubble = np.einsum("s,ski->sik", sign * mesh.side_bubble, along)
        return {"displacement": by_u.reshape(len(face), nodes.shape[1] * mesh.dim, mesh.dim - 1), "side bubble": by_bubble}

    def forces(self, x, state):
        return {row: (push @ x["own shear"][:, :, None])[:, :, 0] for row, push in self.push.items()}

    def forces_by(self, x, state):
        return {(row, "own shear"): push for row, push in self.push.items()}
