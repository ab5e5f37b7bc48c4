"""PorePy on a straight crack that opens or slides in an infinite plane: crack.py opening|sliding SIZE_ON_CRACK
MESH_FILE

The box [-2, 2]^2 and the exact solutions are those of `sneddon` and `sneddon_shear` of perf/verification. The
exact displacement is prescribed on the box, plus the displacement of the uniform stress, which replaces the
initial stress or the pressure in the crack. One step."""
import sys
from pathlib import Path

import measured
import numpy as np
import porepy as pp

from perf.verification.exact import Crack

G, NU, FRICTION, COARSER = 1, 0.25, 0.5, 8  # COARSER: ratio of cell sizes on the box and on the crack
KNOWN = {"opening": Crack(1, 1e-3, G, NU, uniform=(0, 1e-3, 0)),
         "sliding": Crack(2, 1e-3, G, NU, uniform=(0, -1e-3, 1.5e-3))}


class Model(measured.Counted, pp.MomentumBalance):
    def set_domain(self):
        self._domain = pp.Domain({"xmin": -2, "xmax": 2, "ymin": -2, "ymax": 2})

    def set_fractures(self):
        self._fractures = [pp.LineFracture(np.array([[-1, 1], [0, 0]]))]

    def bc_type_mechanics(self, sd):
        bc = pp.BoundaryConditionVectorial(sd, self.domain_boundary_sides(sd).all_bf, "dir")
        bc.internal_to_dirichlet(sd)
        return bc

    def bc_values_displacement(self, bg):
        if bg.dim < 1:
            return np.zeros(2 * bg.num_cells)
        return self.params["known"].displacement(bg.cell_centers[:2].T).ravel()


def errors(model, mode):
    """Relative L2 errors of the jump against exact means of cells.

    They are computed over all cells, and over cells at least a tenth of the half-length away from tips."""
    crack = model.mdg.subdomains(dim=1)[0]
    jump = measured.vectors(model, model.displacement_jump([crack]))
    ends = np.sort(crack.nodes[0][crack.cell_nodes().indices.reshape(-1, 2)], axis=1)
    exact = np.linalg.norm(KNOWN[mode].jump_mean(np.stack([ends, 0 * ends], axis=2)), axis=1)
    known = np.outer(exact, (0, 1)) if mode == "opening" else np.outer(exact, (np.sign(jump[:, 0].sum()), 0))
    away = np.abs(ends).max(axis=1) < 0.9
    return [float(np.sqrt((size * ((jump - known)**2).sum(axis=1)).sum() / (size * (known**2).sum(axis=1)).sum()))
            for size in (crack.cell_volumes, crack.cell_volumes * away)]


def make(mode, h, file):
    solid = {"shear_modulus": G, "lame_lambda": 2 * G * NU / (1 - 2 * NU), "friction_coefficient": FRICTION}
    return Model(measured.parameters(measured.sizes(COARSER * h, h), solid, known=KNOWN[mode], meshing_kwargs={"file_name": file}))


if __name__ == "__main__":
    mode, h, file = sys.argv[1], float(sys.argv[2]), Path(sys.argv[3])
    found = measured.run(lambda size: make(mode, size, file), 0.5, h)
    every, away = errors(found, mode)
    measured.tell(found, error=every, error_away=away)
