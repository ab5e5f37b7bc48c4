"""Common parts of the runs of PorePy: counters, and the line of JSON that they print."""
import json
import os
import resource
import time

import numpy as np
import porepy as pp


class Counted:
    """Counter of CPU seconds by part, linear solves and matrix size; must be the first base class of a model."""

    def __init__(self, params):
        super().__init__(params)
        self.seconds, self.solves, self.size = {}, 0, (0, 0)

    def count(self, part, call):
        begin = time.process_time()
        result = call()
        self.seconds[part] = self.seconds.get(part, 0) + time.process_time() - begin
        return result

    def set_geometry(self):
        self.count("mesh", super().set_geometry)

    def discretize(self):
        self.count("discretisation", super().discretize)

    def assemble_linear_system(self):
        self.count("assembly", super().assemble_linear_system)

    def solve_linear_system(self):
        matrix = self.linear_system[0]
        self.solves, self.size = self.solves + 1, (matrix.shape[0], matrix.nnz)
        return self.count("solution", super().solve_linear_system)


def run(make, coarse, size):
    """Runs make(coarse), which loads and compiles all code, then make(size); returns the second model."""
    for model in (make(coarse), make(size)):
        model.count("all", lambda model=model: pp.run_time_dependent_model(model, model.params))
    return model


def evaluate(model, operator):
    return np.asarray(model.equation_system.evaluate(operator))


def vectors(model, operator):
    """Values of an operator, [cell, component]."""
    return evaluate(model, operator).reshape(-1, model.nd)


def sizes(size, on_fracture):
    return {"cell_size": size, "cell_size_fracture": on_fracture, "cell_size_boundary": size, "cell_size_min": on_fracture}


def parameters(meshing, solid, fluid=None, **more):
    material = {"solid": pp.SolidConstants(**solid), "numerical": pp.NumericalConstants(characteristic_displacement=1e-2)}
    if fluid:
        material["fluid"] = pp.FluidComponent(**fluid)
    return {"times_to_export": [], "grid_type": "simplex", "meshing_arguments": meshing, "folder_name": os.devnull,
            "max_iterations": 40, "nl_convergence_tol": 1e-10, "material_constants": material, **more}


def tell(model, **values):
    """Prints the measured values. The mesh does not count: both programs use the same one, or it was made before."""
    seconds = model.seconds
    print(json.dumps({"cpu_seconds": seconds["all"] - seconds["mesh"], "parts": seconds, "solves": model.solves,
                      "unknowns": model.size[0], "entries": model.size[1], "cells": model.mdg.subdomains(dim=model.nd)[0].num_cells,
                      "peak_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, **values}))
