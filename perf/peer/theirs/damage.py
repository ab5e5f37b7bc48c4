"""PorePy's fracture damage on a path of jumps: damage.py DIM isotropic|anisotropic STEPS

The model contains contact only, with the jumps of path(). The material is that of PorePy's example, with three
changes: damage of both friction and dilation; stiffnesses a million times larger, because the convergence test
otherwise ignores tractions; and more friction, because slip would otherwise produce energy."""
import sys

import measured
import numpy as np
import porepy as pp
from porepy.applications.md_grids.model_geometries import CubeDomainOrthogonalFractures, SquareDomainOrthogonalFractures
from porepy.compositional.materials import FractureDamageSolidConstants
from porepy.examples import fracture_damage as example

SOLID = {**example.solid_params, "fracture_normal_stiffness": 1e3, "fracture_tangential_stiffness": 1e9, "friction_coefficient": 0.4,
         "initial_friction_damage": 1.5, "initial_dilation_damage": 2.0}


def path(dim, steps):
    """[component, step] Displacement of the upper side from rest: cyclic in one direction, in 3D loops in one
    quadrant.

    For these paths the history of a step in the direction of the present jump is the same in PorePy and Sprekk."""
    t = np.arange(steps + 1) / 16
    # never back at 0, where the direction is undefined
    sway = np.where(t > 0, 0.02, 0) + 0.1 * (1 - np.cos(np.pi * np.outer([2, 3], t)))
    return np.array([sway[0], np.full_like(t, 0.1), sway[1]][:dim])


class Saved(measured.Counted):
    """Model that records the state after every step."""

    def collect_data(self):
        fracture = self.mdg.subdomains(dim=self.nd - 1)
        scale = float(measured.evaluate(self, self.characteristic_contact_traction(fracture)))
        traction, jump = (measured.vectors(self, of(fracture))[0] for of in (self.contact_traction, self.plastic_displacement_jump))
        step = {"time": int(self.time_manager.time_index), "seconds": sum(self.seconds.get(part, 0) for part in ("assembly", "solution")), "solves": self.solves,
                "history": float(measured.evaluate(self, self.damage_history(fracture))[0]), "normal": scale * float(traction[-1]),
                "shear": scale * float(np.linalg.norm(traction[:-1])), "slip": float(np.linalg.norm(jump[:-1]))}
        self.__dict__.setdefault("reported", []).append(step)
        return super().collect_data()


def make(steps):
    geometry = SquareDomainOrthogonalFractures if dim == 2 else CubeDomainOrthogonalFractures
    base = {"isotropic": example.IsotropicFractureDamage, "anisotropic": example.AnisotropicFractureDamage}[kind]
    exact = {"isotropic": example.ExactSolutionIsotropic, "anisotropic": example.ExactSolutionAnisotropic}[kind]
    jumps = path(dim, steps)
    space = path(3, steps)
    return type("Model", (Saved, geometry, base), {})(
        {**example.model_params, "exact_solution": exact, "material_constants": {"solid": FractureDamageSolidConstants(**SOLID)},
         "time_manager": pp.TimeManager(np.arange(steps + 1), 1, True), "interface_displacement_parameter_values": jumps,
         "north_displacements": space, "max_iterations": 60})


if __name__ == "__main__":
    dim, kind, count = int(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    model = measured.run(make, 1, count)
    measured.tell(model, steps=model.reported, path=path(dim, count).tolist())
