"""Replaces fractures that are too close to others for a mesh, as the mesh generator does for random fractures."""
import subprocess
import tempfile
from pathlib import Path

import checks
import files
from description import Network
from plan import Plan
from progress import doing
from shapes import NetworkError

MAX_REPLACED = 0.2  # of the fractures; a larger share would change the statistics


def conflicts(program, statistics, sets):
    """Returns the rows, from 0, of the later fracture of each pair too close for a mesh, in the table of `sets`."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "network.xml"
        (Path(folder) / "network.csv").write_text(files.table(sets, statistics.dim))
        scene.write_text(files.scene(statistics, "network.csv"))
        done = subprocess.run([program, "network", scene], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode:
            raise NetworkError(done.stderr.strip().removeprefix("sprekk: "))
        network = Network(done.stdout)
    row_of = {fracture.name: k for k, fracture in enumerate(network.fractures)}
    try:
        checks.check(Plan(network))
    except NetworkError as error:
        if not all(error.features):
            raise
        return {max(row_of[name] for name in names if name in row_of) for names in error.features}
    return set()


def replace_conflicts(program, statistics, streams):
    """Excludes fractures from the streams until all others can be meshed. Returns the number of excluded fractures."""
    replaced = 0
    while True:
        sets = [(stream.one, stream.fractures()) for stream in streams]
        place = [(stream, k) for stream, (_, fractures) in zip(streams, sets) for k in range(len(fractures))]
        with doing(f"checking the distances of {len(place)} fractures"):
            rows = conflicts(program, statistics, sets)
        replaced += len(rows)
        if not rows:
            return replaced
        if replaced > max(1, MAX_REPLACED * len(place)):
            raise NetworkError(f"{statistics.path}: is too dense: more than a fifth of the fractures would be too "
                               "close to others for a mesh; reduce the intensities, or add --unchecked",
                               [statistics.path])
        for row in rows:
            stream, k = place[row]
            stream.exclude(k)
