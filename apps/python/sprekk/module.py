"""Terms and equations of your own, as functions of numpy arrays."""
from dataclasses import dataclass, field

import numpy as np


@dataclass
class State:
    """Where a residual is asked for: the time t (s); rate (1/s), which is what rates are times what is stored more than
    at the start of the step; and histories of the module, [entity that this rank owns, component], which commit() moves
    on. Not to be kept."""
    t: float
    rate: float
    histories: dict


@dataclass
class Unknown:
    """A field that a module adds, with one row for each unknown.

    entity          node, cell, fracture face or facet (what cells and fracture faces end in)
    scale           the name of the typical size of its values
    row             the size of its rows: {scale: factor}
    local_group     "fracture face": eliminated with contact, face by face
    condensed_into  the field that preconditioners eliminate it from, whose unknowns hardly couple among themselves
    balance         its rows are balances of rates, which may differ by orders of magnitude
    smooth          multigrid may coarsen it: its matrix takes constants to almost nothing"""
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
    """A residual over all entities of a loop: cells, fracture faces (owned), fracture sides, fracture cells, boundary
    faces or neighbours; those but fracture faces with ghosts, and each rank adds to the rows that it owns.

    rows, columns  fields whose rows it adds to, and that these depend on
    residual       residual(x, state) -> {row: [entity, unknown of the entity]}; x has {column: the same}
    jacobian       jacobian(x, state) -> {(row, column): [entity, unknown of the row, of the column]}; absent: central
                   differences, all entities at once"""
    loop: str
    rows: list
    columns: list
    residual: object
    jacobian: object = None

    def derivative(self, x, state):
        return self.jacobian(x, state) if self.jacobian else self.differences(x, state)

    def differences(self, x, state, step=6e-6):
        """Central differences; a step is relative to the largest value of the column, at least 1e-12 of it."""
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
    """Terms or equations that are solved for together with Sprekk's: a list of them is the argument `modules` of a Model.
    Derive from it; what a module adds is in blocks(). docs/develop/embedding.md tells what the words mean."""
    name = "own module"
    fingerprint = ""  # what must be the same where a checkpoint is restored
    unknowns = ()
    scales = {}  # without loads, above zero
    histories = {}  # {name: (entity, components)}
    stores = False  # State.rate times what is stored
    symmetric = False  # its Jacobian
    merit = {}  # {own unknown: weight} of the squares of its rows in an energy, J; else 1/diagonal

    def blocks(self, mesh):
        """Of a rank's part of the mesh, a Mesh with ghosts."""
        return []

    def loads(self, t):
        """The sizes of what it prescribes at time t, by the scales that they count for."""
        return {}

    def commit(self, state, x):
        """Moves the histories on to what a step ended with: x has {column: [entity, unknown of it]} for each block."""


class FaceLaw(Module):
    """What fractures bear along themselves by a law of your own, T(w, lambda), Pa, beside what the scene's friction bears:
    closed faces of a joint with "friction coefficient" 0 bear T alone. It is the unknown "own shear" tau of each face,

        tau - T(w, lambda) = 0,    |f| tau . d(w_t)/du in the rows of the displacement.

    Derive from it and write shear(); with n = dim - 1 tangential components. A prototype: Sprekk's own laws
    (docs/develop/add_a_law.md) are known to the solver, which does more for them where faces slide and part."""
    name = "face law"
    stiffness = 1e10  # of the rock about a face, Pa/m: the order of magnitude steers Newton's method

    def shear(self, w, traction, state):
        """T [face, n] at the jump w [face, dim], m, and the contact traction [face, dim], Pa, normal components first;
        state.histories["jump"] is the jump at the start of the step, state.rate 1/dt."""
        raise NotImplementedError

    def shear_derivative(self, w, traction, state):
        """dT/dw [face, n, dim] and dT/dlambda [face, n, dim]; as it is here, by central differences."""
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

    # The law: on faces that this rank owns

    def operators(self, n):
        """dw/d(displacement, side bubble) of the first n faces: [face, dim, unknown]"""
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

    # What it does to the rock: on sides whose cell is on this rank

    def pushes(self):
        """|f| d(w_t)/d(displacement of the side's cell, its bubble): [side, unknown, n]"""
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
