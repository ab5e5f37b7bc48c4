"""Equivalent tensors of a fractured block under stress: ./sprekk upscale SCENE [options], see docs/use/upscaling.md."""
import argparse
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from mpi4py import MPI

from .. import _sprekk
from ..model import NotConverged
from ..network import mesh_command, needs_mesh, with_mesh
from ..scene import Scene
from .blocks import blocks_of
from .components import asymmetry, names, principal
from .run import ALL_CONDITIONS, CONDITIONS, dimension_of, run
from .solid import SLIDING

UNITS = {"Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}


def arguments(words):
    parser = argparse.ArgumentParser(prog="sprekk upscale", description="Computes equivalent tensors of a fractured block: "
                                     "permeability, compliance, Biot tensor and storage. See docs/use/upscaling.md.")
    parser.add_argument("scene", metavar="SCENE", help="its boundary conditions and times are not used")
    parser.add_argument("--stress", action="append", default=[], metavar="XX,YY,...",
                        help="total stress on the boundary, Pa, tension positive, in the order xx,yy,zz,yz,xz,xy (2D: "
                             "xx,yy,xy); may be repeated: a path; default: the initial stress of the scene")
    parser.add_argument("--path", metavar="CSV", help="path with columns xx, yy, ... and pressure; titles may contain a "
                                                      "unit, \"xx [MPa]\"; missing stresses are 0, a missing pressure is the "
                                                      "initial one")
    parser.add_argument("--conditions", default=",".join(CONDITIONS), metavar="NAMES",
                        help=f"conditions on the boundary, of {', '.join(ALL_CONDITIONS)}; default %(default)s")
    parser.add_argument("--inner", type=float, metavar="SHARE", help="also an inner region: its edge lengths relative to "
                                                                     "those of the block, with linear conditions")
    parser.add_argument("--blocks", metavar="NX,NY,...", help="divide the domain into a grid of blocks")
    parser.add_argument("--statistics", metavar="TOML", help="draw the network of the scene from statistics, see ./sprekk "
                                                             "network")
    parser.add_argument("--seeds", default="", metavar="A-B", help="seeds of the networks, with --statistics")
    parser.add_argument("--sliding", choices=list(SLIDING), default="stick",
                        help="tangent of faces that slip in the step to a state: they stick, as in unloading, or slip "
                             "further; default %(default)s")
    parser.add_argument("--largest-ratio", type=float, default=10, metavar="R",
                        help="ratio of the tensors of linear and uniform conditions above which a warning is printed; "
                             "default %(default)g")
    parser.add_argument("--set", action="append", default=[], metavar="Path.To.Entry=VALUE", help="override an entry")
    parser.add_argument("--output", default="", metavar="DIR", help="default: output/SCENE_upscaled")
    parser.add_argument("--no-errors", action="store_true", help="do not estimate discretisation errors")
    parser.add_argument("--no-pictures", action="store_true", help="write tables only")
    options = parser.parse_args(words)
    if options.stress and options.path:
        parser.error("give either --stress or --path")
    if bool(options.statistics) != bool(options.seeds):
        parser.error("--statistics and --seeds need each other")
    if options.blocks and options.seeds:
        parser.error("give either --blocks or --seeds")
    return options


def path_from(options, dim):
    """Returns stresses and pressures, or None for the default."""
    columns = names(dim)
    if options.path:
        return read_path(options.path, columns)
    if not options.stress:
        return None, None
    stresses = []
    for text in options.stress:
        try:
            stresses.append([float(value) for value in text.split(",")])
        except ValueError:
            raise _sprekk.Error(f"--stress: is {text}, must be numbers, {','.join(columns)}") from None
        if len(stresses[-1]) != len(columns):
            raise _sprekk.Error(f"--stress: has {len(stresses[-1])} components, must have {len(columns)}: {','.join(columns)}")
    return stresses, None


def read_path(name, columns):
    """Reads a table with the columns xx, yy, ... and pressure."""
    try:
        with open(name, newline="") as file:
            rows = list(csv.reader(file, skipinitialspace=True))
    except OSError as error:
        raise _sprekk.Error(f"{name}: cannot be read: {error.strerror}") from None
    if len(rows) < 2:
        raise _sprekk.Error(f"{name}: must have a line of titles and a line for each stress")
    place, factor = {}, {}
    for k, title in enumerate(rows[0]):
        quantity, _, unit = title.strip().removesuffix("]").partition("[")
        quantity, unit = quantity.strip(), unit.strip() or "Pa"
        if quantity not in (*columns, "pressure"):
            raise _sprekk.Error(f'{name}: column "{title}" is unknown, must be one of: {", ".join(columns)}, pressure')
        if unit not in UNITS:
            raise _sprekk.Error(f'{name}: column "{title}": the unit is {unit}, must be one of: {", ".join(UNITS)}')
        place[quantity], factor[quantity] = k, UNITS[unit]

    def value(number, row, quantity):
        if quantity not in place:
            return 0.0
        try:
            return float(row[place[quantity]]) * factor[quantity]
        except (ValueError, IndexError):
            raise _sprekk.Error(f"{name}:{number}: {quantity} is missing or not a number") from None

    path = [[value(number, row, quantity) for quantity in (*columns, "pressure")]
            for number, row in enumerate(rows[1:], 2) if row]
    return [row[:-1] for row in path], [row[-1] for row in path] if "pressure" in place else None


def counts_of(text):
    try:
        return np.array([int(value) for value in text.split(",")])
    except ValueError:
        raise _sprekk.Error(f"--blocks: is {text}, must be numbers of at least 1 for each direction") from None


def seeds_of(text):
    first, _, last = text.partition("-")
    try:
        seeds = range(int(first), int(last or first) + 1)
    except ValueError:
        seeds = ()
    if not seeds:
        raise _sprekk.Error(f"--seeds: is {text}, must be a number or an increasing range such as 1-8")
    return seeds


def scenes_of(options, scene, comm, folder):
    """Yields (label, corners, Scene) of all blocks."""
    if options.blocks:
        for index, low, high, part in blocks_of(scene, counts_of(options.blocks), comm):
            yield ",".join(map(str, index)), (low, high), part
    elif options.seeds:
        fractures = scene.entries.get("Mesh file", {}).get("network", {}).get("fractures", {})
        if len(fractures) != 1:
            raise _sprekk.Error(f"{options.scene}: --seeds needs a network with one set of fractures, read from a file")
        for seed in seeds_of(options.seeds):
            table = drawn(options.statistics, seed, folder, comm)
            yield f"seed {seed}", None, scene.changed({f"Mesh file.network.fractures.{next(iter(fractures))}.file": table}, comm)
    else:
        yield "whole", None, scene


def drawn(statistics, seed, folder, comm):
    """Returns the path of a table of fractures drawn from statistics. Rank 0 runs the generator."""
    error, name = None, f"{folder}/seed_{seed}"
    if comm.rank == 0:
        command = network_command()
        done = subprocess.run([*command, statistics, "--seed", str(seed), "-o", name], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        error = done.stderr.strip().removeprefix("sprekk: ") if done.returncode else None
    error = comm.bcast(error)
    if error:
        raise _sprekk.Error(error)
    return f"{name}.csv"


def network_command():
    """Returns the command that draws networks, next to the one that makes meshes."""
    command = mesh_command()
    if not command:
        raise _sprekk.Error("networks are drawn by the command `sprekk`, which is not on the path")
    return [word.replace("apps/mesh", "apps/network") if word.endswith("apps/mesh") else word for word in command] \
        if len(command) > 2 else [command[0], "network"]


def summary(label, found):
    """Returns lines with the principal permeabilities and the moduli of the last state."""
    result, lines = found.results[-1], []
    for conditions, K in result.permeability.items():
        values = " ".join(f"{value:.6g}" for value in principal(K)[0])
        lines.append(f"{label}: permeability, {conditions}: {values} m^2, asymmetry {asymmetry(K):.1e}")
    for conditions, tangent in result.solid.items():
        values = " ".join(f"{1e-9 / value:.6g}" for value in np.diag(tangent.compliance))
        lines.append(f"{label}: 1/compliance, {conditions}: {values} GPa, asymmetry {asymmetry(tangent.compliance):.1e}")
    return lines


def compute(options, comm):
    from .output import Case, write
    shared = comm.bcast(tempfile.mkdtemp() if comm.rank == 0 else None)
    try:
        scene = Scene(options.scene, options.set, comm=comm)
        cases = []
        for label, corners, part in scenes_of(options, scene, comm, shared):
            part = with_mesh(part, comm) if needs_mesh(part.entries) else part
            stresses, pressures = path_from(options, dimension_of(part, comm))
            found = run(part, stresses, pressures, options.conditions.split(","), inner=options.inner, comm=comm,
                        errors=not options.no_errors, sliding=options.sliding, largest=options.largest_ratio)
            cases.append(Case(label, found, corners))
            if comm.rank == 0:
                print("\n".join(summary(label, found)), flush=True)
                for warning in found.warnings:
                    print(f"sprekk: warning: {label}: {warning}", file=sys.stderr)
        folder = options.output or f"output/{Path(options.scene).stem}_upscaled"
        error = None
        if comm.rank == 0:
            try:
                write(folder, cases, not options.no_pictures)
                print(f"wrote {folder}")
            except OSError as failure:
                error = f"{folder}: cannot be written: {failure.strerror}"
        if error := comm.bcast(error):
            raise _sprekk.Error(error)
    finally:
        if comm.rank == 0:
            import shutil
            shutil.rmtree(shared, ignore_errors=True)


def main(words=None, comm=MPI.COMM_WORLD):
    options = arguments(words)
    try:
        compute(options, comm)
    except (_sprekk.Error, NotConverged) as error:
        if comm.rank == 0:
            print(f"sprekk: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
