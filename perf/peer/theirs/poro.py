"""PorePy on the manufactured solution of Nordbotten (2016) in the unit square or cube: poro.py DIMENSION GRID SIZE

The model is that of PorePy's functional tests, with a Biot coefficient of 0.5 and a fluid compressibility of 0.02, in
two steps of 0.5. The errors are those that PorePy computes."""
import importlib
import os
import sys

import measured
import porepy as pp


def make(dimension, grid, size):
    module = importlib.import_module(f"tests.functional.setups.manu_poromech_nofrac_{dimension}d")

    class Model(measured.Counted, getattr(module, f"ManuPoroMechModel{dimension}d")):
        """PorePy's model with counters."""
    material = {"solid": pp.SolidConstants(biot_coefficient=0.5), "fluid": pp.FluidComponent(compressibility=0.02)}
    return Model({"times_to_export": [], "grid_type": grid, "meshing_arguments": {"cell_size": size}, "folder_name": os.devnull,
                  "manufactured_solution": "nordbotten_2016", "material_constants": material,
                  "time_manager": pp.TimeManager([0, 0.5, 1], 0.5, True)})


if __name__ == "__main__":
    dimension, grid, h = int(sys.argv[1]), sys.argv[2], float(sys.argv[3])
    found = measured.run(lambda size: make(dimension, grid, size), 0.5, h)
    last = found.results[-1]
    errors = {"pressure": last.error_pressure, "flow": last.error_flux, "u": last.error_displacement, "force": last.error_force}
    measured.tell(found, errors={name: float(error) for name, error in errors.items()})
