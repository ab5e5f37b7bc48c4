"""Meshes of files as geologists have them, each with one entry `repair`: time, number of cells and their quality."""
import json
import re
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from perf.common import table
from perf.meshing import discs, maps

ROOT = Path(__file__).resolve().parents[2]
MAPS = {"map of 50": (50, 40.0, 1), "map of 300": (300, 100.0, 2), "map of 1000": (1000, 220.0, 3), "map of 5140": (5140, 500.0, 4)}
CUBES = {"300 discs": (300, 1), "1000 discs": (1000, 2)}
QUICK = ("60 discs", "map of 50", "map of 300")
DISCS = ROOT / "xml/networks/discs_3d.xml"
COLUMNS = {"file": "", "fractures": "", "left out": "", "cells": "", "cells/estimate": ".2f", "gamma min": ".3f", "edge/request": ".2f", "attempts": "", "meshes": "",
           "s": ".1f", "CPU s": ".1f"}
RELATIVE_SIZE = '<Parameter name="relative size" type="double" value="0.25"/>'
LIMIT = 3600  # seconds, for hanging programs


def scene(folder, name, low, size, more=""):
    """Writes the scene of a file and returns its path."""
    path = folder / f"{Path(name).stem}.xml"
    path.write_text(f"""<ParameterList name="Sprekk"><ParameterList name="Mesh file"><ParameterList name="network">
<ParameterList name="domain">
<Parameter name="lower corner" type="Array(double)" value="{numbers(low)}"/>
<Parameter name="upper corner" type="Array(double)" value="{numbers(low + size)}"/>
</ParameterList>
<ParameterList name="fractures"><ParameterList name="map"><Parameter name="file" type="string" value="{name}"/></ParameterList></ParameterList>
<Parameter name="repair" type="string" value="join"/>{more}
</ParameterList></ParameterList></ParameterList>
""")
    return path


def numbers(x):
    return f"{{{', '.join(f'{value:.9g}' for value in x)}}}"


def scenes(folder, chosen, more_seed):
    """Yields (name, scene) of the chosen names. `more_seed` is added to all seeds."""
    if "60 discs" in chosen:
        yield "60 discs", DISCS
    for name, (n, seed) in CUBES.items():
        if name in chosen:
            size, text = discs.table(n, seed + more_seed)
            (folder / f"discs_{n}.csv").write_text(text)
            yield name, scene(folder, f"discs_{n}.csv", np.zeros(3), size, RELATIVE_SIZE)
    for k, (name, (n, size, seed)) in enumerate(MAPS.items()):
        if name in chosen:
            lines, file = maps.traces(n, size, seed + more_seed), f"map_{n}." + ("csv" if k % 2 else "geojson")
            (folder / file).write_text((maps.points if k % 2 else maps.geojson)(lines))
            yield name, scene(folder, file, maps.ORIGIN, size)


def row(name, path, folder, options):
    """Returns the row of a file, or None after a failure."""
    mesh = folder / f"{path.stem}.msh"
    mesh.unlink(missing_ok=True)
    command = [sys.executable, "-B", ROOT / "apps/mesh", path, "-o", mesh, "--program", options.binary]
    begin, before = time.monotonic(), cpu_seconds()
    try:
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        print(f"{name}: no mesh after {LIMIT} s")
        return None
    seconds = time.monotonic() - begin
    if done.returncode:
        print(f"{name}: {done.stderr.strip()}")
        return None
    print("\n".join(line for line in done.stdout.splitlines() if " left out" in line))
    report = json.loads(Path(f"{mesh}.json").read_text())
    states = [line.split(",") for line in Path(f"{mesh}.csv").read_text().splitlines()[1:]]
    one = next(iter(report["sets"].values()))
    return [name, len(states), len(states) - one["fractures"], report["cells"], report["cells"] / report["expected cells"],
            report["gamma"]["min"], one["median edge"] / one["median target size"], report["attempts"],
            report["generations of cells"], seconds, cpu_seconds() - before]


def cpu_seconds():
    """Returns the processor time of all ended child processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(options):
    """Prints the table and a last line. The status is 1 after a failure."""
    printed, rows, failures, folder = table.Table(COLUMNS, 14), [], 0, options.output / "meshes"
    folder.mkdir(parents=True, exist_ok=True)
    chosen = [name for name in ("60 discs", *CUBES, *MAPS) if re.search(options.only, name) and (not options.quick or name in QUICK)]
    for name, path in scenes(folder, chosen, options.seed):
        found = row(name, path, folder, options)
        failures += found is None
        if found:
            rows.append(found)
            printed.add(found)
    printed.write(options.output / "files.csv")
    worst = [max((one[k] for one in rows), default=0) for k in (9, 4)]
    print(f"failures={failures} mesh_s_max={worst[0]:.1f} cells_over_estimate_max={worst[1]:.2f} "
          f"gamma_min={min((one[5] for one in rows), default=0):.3f}")
    return int(failures > 0)
