"""Meshes of files as geologists have them, each with one entry `repair`: time, number of cells and their quality."""
import json
import subprocess
import sys
import time
from pathlib import Path

from perf.common import table
from perf.meshing import maps

ROOT = Path(__file__).resolve().parents[2]
MAPS = {"map of 50": (50, 40.0, 1), "map of 300": (300, 100.0, 2), "map of 1000": (1000, 220.0, 3), "map of 5140": (5140, 500.0, 4)}
QUICK = ("map of 50", "map of 300")
DISCS = ROOT / "xml/networks/discs_3d.xml"
COLUMNS = {"file": "", "fractures": "", "left out": "", "cells": "", "cells/estimate": ".2f", "gamma min": ".3f", "edge/request": ".2f", "s": ".1f"}
LIMIT = 600  # seconds


def scene(folder, name, size):
    """Writes the scene of a map and returns its path."""
    low, high = maps.ORIGIN, maps.ORIGIN + size
    path = folder / f"{Path(name).stem}.xml"
    path.write_text(f"""<ParameterList name="Sprekk"><ParameterList name="Mesh file"><ParameterList name="network">
<ParameterList name="domain">
<Parameter name="lower corner" type="Array(double)" value="{{{low[0]}, {low[1]}}}"/>
<Parameter name="upper corner" type="Array(double)" value="{{{high[0]}, {high[1]}}}"/>
</ParameterList>
<ParameterList name="fractures"><ParameterList name="map"><Parameter name="file" type="string" value="{name}"/></ParameterList></ParameterList>
<Parameter name="repair" type="string" value="join"/>
</ParameterList></ParameterList></ParameterList>
""")
    return path


def scenes(folder, quick):
    """Yields (name, scene)."""
    yield "60 discs", DISCS
    for k, (name, (n, size, seed)) in enumerate(MAPS.items()):
        if quick and name not in QUICK:
            continue
        lines, file = maps.traces(n, size, seed), f"map_{n}." + ("csv" if k % 2 else "geojson")
        (folder / file).write_text((maps.points if k % 2 else maps.geojson)(lines))
        yield name, scene(folder, file, size)


def row(name, path, options):
    """Returns the row of a file, or None after a failure."""
    mesh = options.output / f"{path.stem}.msh"
    mesh.unlink(missing_ok=True)
    command = [sys.executable, "-B", ROOT / "apps/mesh", path, "-o", mesh, "--program", options.binary]
    begin = time.monotonic()
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
            report["gamma"]["min"], one["median edge"] / one["median target size"], seconds]


def main(options):
    """Prints the table and a last line. The status is 1 after a failure."""
    printed, rows, failures = table.Table(COLUMNS, 14), [], 0
    for name, path in scenes(options.output, options.quick):
        found = row(name, path, options)
        failures += found is None
        if found:
            rows.append(found)
            printed.add(found)
    printed.write(options.output / "files.csv")
    worst = [max((one[k] for one in rows), default=0) for k in (7, 4)]
    print(f"failures={failures} mesh_s_max={worst[0]:.1f} cells_over_estimate_max={worst[1]:.2f} "
          f"gamma_min={min((one[5] for one in rows), default=0):.3f}")
    return int(failures > 0)
