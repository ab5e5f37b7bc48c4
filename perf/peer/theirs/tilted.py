"""PorePy on a block with a tilted fracture that slips: tilted.py SIZE SIZE_ON_FRACTURE MESH_FILE

Unit cube with E = 1 and Poisson's ratio 0.25. The fracture is a square of side 0.5 at the centre, inclined by
30 degrees, with friction 0.5. The bottom is fixed, the top moves by (0.005, 0, -0.01), the sides are free. One
step."""
import sys
from pathlib import Path

import measured
import numpy as np
import porepy as pp

FRICTION, DIP = 0.5, np.radians(-30)


class Block(measured.Counted):
    """Cube with an inclined rectangular fracture at its centre, fixed at its bottom; the top moves after the start."""
    side, half_length, half_width, moved = 1.0, 0.25, 0.25, (0.005, 0, -0.01)

    def set_domain(self):
        self._domain = pp.domains.nd_cube_domain(3, self.side)

    def set_fractures(self):
        along = self.half_length * np.array([np.cos(DIP), 0, np.sin(DIP)])
        across, centre = np.array([0, self.half_width, 0]), np.full(3, self.side / 2)
        corners = [centre + a * along + b * across for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        self._fractures = [pp.PlaneFracture(np.array(corners).T)]

    def bc_type_mechanics(self, sd):
        sides = self.domain_boundary_sides(sd)
        bc = pp.BoundaryConditionVectorial(sd, sides.top + sides.bottom, "dir")
        bc.internal_to_dirichlet(sd)
        return bc

    def bc_values_displacement(self, bg):
        values = np.zeros((3, bg.num_cells))
        if self.time_manager.time > 0:
            values[:, self.domain_boundary_sides(bg).top] = np.array(self.moved)[:, None]
        return values.ravel("F")


class Model(Block, pp.MomentumBalance):
    """Model of rock with contact and friction."""


def functionals(model):
    """Slip and normal traction; in the axes of the block, integral of traction, mean jump and force on the top."""
    rock, crack = model.mdg.subdomains(dim=3)[0], model.mdg.subdomains(dim=2)[0]
    scale = float(measured.evaluate(model, model.characteristic_contact_traction([crack])))
    traction, jump = scale * measured.vectors(model, model.contact_traction([crack])), measured.vectors(model, model.displacement_jump([crack]))
    projection = model.mdg.subdomain_data(crack)["tangential_normal_projection"]
    turn = projection.project_tangential_normal(crack.num_cells)
    upward = np.sign(projection.normals[2])[:, None]
    in_space = [upward * (turn.T @ values.ravel()).reshape(-1, 3) for values in (traction, jump)]
    area, slip = crack.cell_volumes, np.linalg.norm(jump[:, :2], axis=1)
    outward = np.asarray(rock.cell_faces.sum(axis=1))
    forces = (outward * measured.vectors(model, model.stress([rock])))[model.domain_boundary_sides(rock).top]
    return {"slip max": slip.max(), "slip mean": slip @ area / area.sum(), "t_n mean": traction[:, 2] @ area / area.sum(),
            "integral of traction": (area @ in_space[0]).tolist(), "mean jump": (area @ in_space[1] / area.sum()).tolist(),
            "reaction": forces.sum(axis=0).tolist()}


def make(size, file):
    solid = {"shear_modulus": 0.4, "lame_lambda": 0.4, "friction_coefficient": FRICTION}
    return Model(measured.parameters(measured.sizes(*size), solid, meshing_kwargs={"file_name": file}))


if __name__ == "__main__":
    h, on_crack, file = float(sys.argv[1]), float(sys.argv[2]), Path(sys.argv[3])
    found = measured.run(lambda size: make(size, file), (0.5, 0.3), (h, on_crack))
    measured.tell(found, functionals=functionals(found))
