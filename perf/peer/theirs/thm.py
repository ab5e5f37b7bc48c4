"""PorePy on a hot block with a tilted fracture through which cold water flows: thm.py SIZE SIZE_ON_FRACTURE
MESH_FILE

The model is PorePy's thermo-poromechanics with the cubic law in the fracture. The scene is described below and
in ../thm.xml. The rock is closed at x = 0 and x = 100 m, where the fracture ends. Two steps."""
import sys
from pathlib import Path

import measured
import numpy as np
import porepy as pp
from tilted import DIP, FRICTION, Block, functionals

HOT, COLD, INJECTED = 420.0, 360.0, 2e6
SOLID = {"shear_modulus": 16e9, "lame_lambda": 16e9, "biot_coefficient": 0.7, "porosity": 0.01, "permeability": 1e-16,
         "normal_permeability": 1e-12, "residual_aperture": 1e-4, "friction_coefficient": FRICTION, "dilation_angle": np.radians(1),
         "density": 2700, "specific_heat_capacity": 800, "thermal_conductivity": 2.8, "thermal_expansion": 8e-6}
WATER = {"name": "water", "density": 1000, "viscosity": 1e-3, "compressibility": 4.5e-10, "thermal_expansion": 5e-4,
         "specific_heat_capacity": 4200, "thermal_conductivity": 0.6, "normal_thermal_conductivity": 0.6}
STEP, STEPS = 2e7, 2  # s
UNITS = {"kg": 1e9, "K": 100}  # units for unknowns of similar size


class Model(Block, pp.constitutive_laws.CubicLawPermeability, pp.Thermoporomechanics):
    side, half_length, half_width, moved = 100.0, 50 / np.cos(DIP), 25, (0.015, 0, -0.03)

    def solid_thermal_expansion_coefficient(self, subdomains):
        """Volumetric coefficient of the solid, from the linear one."""
        return pp.ad.Scalar(3) * super().solid_thermal_expansion_coefficient(subdomains)

    def bc_type_of_flows(self, sd):
        sides = self.domain_boundary_sides(sd)
        return pp.BoundaryCondition(sd, sides.all_bf if sd.dim == 2 else sides.south + sides.north + sides.bottom + sides.top, "dir")

    bc_type_darcy_flux = bc_type_fluid_flux = bc_type_fourier_flux = bc_type_enthalpy_flux = bc_type_of_flows

    def inlet(self, bg):
        return self.domain_boundary_sides(bg).west if bg.dim == 1 else np.zeros(bg.num_cells, bool)

    def bc_values_pressure(self, bg):
        return self.units.convert_units(np.where(self.inlet(bg), INJECTED, 0.0), "Pa")

    def bc_values_temperature(self, bg):
        return self.units.convert_units(np.where(self.inlet(bg), COLD, HOT), "K")

    def ic_values_temperature(self, sd):
        return np.full(sd.num_cells, self.units.convert_units(HOT, "K"))


def in_fracture(model):
    """Functionals in mm, MPa, K, GN; heat in kW: outflow from the fracture in excess of the inflow."""
    crack = model.mdg.subdomains(dim=2)
    area = crack[0].cell_volumes / crack[0].cell_volumes.sum()

    def si(values, unit, factor):
        return np.asarray(model.units.convert_units(np.asarray(values, float), unit, to_si=True)) * factor

    def mean(values, unit, factor=1):
        return float(si(area @ values, unit, factor))
    found = functionals(model)
    pressure, temperature = (measured.evaluate(model, of(crack)) for of in (model.pressure, model.temperature))
    outward = np.asarray(crack[0].cell_faces.sum(axis=1)).ravel() * model.domain_boundary_sides(crack[0]).east
    water, heat = (outward @ measured.evaluate(model, of(crack)) for of in (model.fluid_flux, model.energy_flux))
    injected = model.fluid.reference_component.specific_heat_capacity * model.units.convert_units(COLD - HOT, "K") * water
    reaction = si(found["reaction"], "N", 1e-9)
    return {"slip max": float(si(found["slip max"], "m", 1e3)), "slip mean": float(si(found["slip mean"], "m", 1e3)),
            "opening": mean(measured.vectors(model, model.displacement_jump(crack))[:, 2], "m", 1e3),
            "t_n mean": float(si(found["t_n mean"], "Pa", 1e-6)), "p mean": mean(pressure, "Pa", 1e-6), "T mean": mean(temperature, "K"),
            "heat": float(si(heat - injected, "W", 1e-3)), "reaction x": float(reaction[0]), "reaction z": float(reaction[2])}


def make(size, file):
    time = pp.TimeManager([0, STEP * STEPS], STEP, True)
    return Model(measured.parameters(measured.sizes(*size), SOLID, WATER, meshing_kwargs={"file_name": file}, units=pp.Units(**UNITS),
                                     time_manager=time, reference_variable_values=pp.ReferenceVariableValues(temperature=HOT)))


if __name__ == "__main__":
    h, on_crack, file = float(sys.argv[1]), float(sys.argv[2]), Path(sys.argv[3])
    found = measured.run(lambda size: make(size, file), (50.0, 40.0), (h, on_crack))
    measured.tell(found, functionals=in_fracture(found))
