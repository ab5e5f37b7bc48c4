"""PorePy on the regular network of Flemisch et al. (2018): flow.py conductive|blocking tpfa|mpfa SIZE MESH_FILE"""
import os
import sys
from pathlib import Path

import measured
import porepy as pp
from porepy.examples import flow_benchmark_2d_case_1 as benchmark


class Model(measured.Counted, benchmark.FlowBenchmark2dCase1Model):
    """PorePy's model with counters."""


def make(kind, scheme, size, file):
    return Model({"times_to_export": [], "grid_type": "simplex", "meshing_arguments": {"cell_size": size}, "folder_name": os.devnull,
                  "meshing_kwargs": {"file_name": file}, "darcy_flux_discretization": scheme,
                  "material_constants": {"solid": getattr(benchmark, f"solid_constants_{kind}_fractures")}})


if __name__ == "__main__":
    kind, scheme, h, file = sys.argv[1], sys.argv[2], float(sys.argv[3]), Path(sys.argv[4])
    found = measured.run(lambda size: make(kind, scheme, size, file), 0.25, h)
    rock = found.mdg.subdomains(dim=2)
    pressure, volume = measured.evaluate(found, found.pressure(rock)), rock[0].cell_volumes
    measured.tell(found, mean=float(pressure @ volume / volume.sum()))
