"""Fracture networks: sets from tables of traces, and meshes."""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from mpi4py import MPI

from . import _sprekk


def traces(table, geometry="geometry", name=None):
    """Returns a set of fractures for `network > fractures`, with one trace for each row of a table.

    table     a GeoDataFrame, a pandas.DataFrame or a dict of columns
    geometry  column with LineStrings of shapely or lists of points [x, y]
    name      column with the names of the traces; default: the index"""
    lines = list(table[geometry])
    names = list(map(str, table[name] if name else getattr(table, "index", range(1, len(lines) + 1))))
    rows = {}
    for k, key in enumerate(names):
        if key in rows:
            raise _sprekk.Error(f'traces: rows {rows[key]} and {k}, counted from 0 on, have the same name, "{key}"; '
                                "each trace needs its own name")
        rows[key] = k
    return {"lines": {key: {"points": [float(x) for point in getattr(line, "coords", line) for x in point]}
                      for key, line in zip(names, lines)}}


def needs_mesh(entries):
    file = entries.get("Mesh file", {})
    return "network" in file and not file.get("path")


def with_mesh(scene, comm=MPI.COMM_WORLD):
    """Returns the scene with the mesh of its network. Rank 0 generates the mesh with gmsh. Collective."""
    folder = error = None
    if comm.rank == 0:
        folder = tempfile.TemporaryDirectory()
        try:
            make_mesh(scene, Path(folder.name))
        except _sprekk.Error as raised:
            error = str(raised)
    path, error = comm.bcast((folder and folder.name, error))
    if error:
        raise _sprekk.Error(error)
    meshed = scene.changed({"Mesh file.path": f"{path}/network.msh"}, comm)
    meshed._mesh_folder = folder  # removed with the scene
    return meshed


def mesh_command():
    """The command that generates meshes: of the source tree around this package, else of the installed `sprekk`."""
    program = Path(_sprekk.__file__).resolve().parents[2] / "apps/sprekk/sprekk"
    maker = Path(__file__).resolve().parents[2] / "mesh"
    if program.exists() and maker.exists():
        return [sys.executable, "-B", str(maker), "--program", str(program)]
    installed = shutil.which("sprekk")
    return [installed, "mesh"] if installed else None


def make_mesh(scene, folder):
    command = mesh_command()
    if not command:
        raise _sprekk.Error(f'{scene.name}: the mesh of a network requires the command `sprekk`, which is not on the '
                            'path; generate the mesh with `sprekk mesh`, and set "path" of "Mesh file" to it')
    file = folder / "scene.xml"
    file.write_text(scene.to_xml(defaults=True))
    done = subprocess.run([*command, str(file), "-o", str(folder / "network.msh"), "--quiet"], capture_output=True,
                          text=True, stdin=subprocess.DEVNULL)
    if done.returncode:
        raise _sprekk.Error(done.stderr.strip().removeprefix("sprekk: ").replace(str(file), scene.name))
