"""Injection into a fault with dilation, flow and heat, where aseismic slip turns into a rupture: the changes of onset and
moment when cells and tolerance are halved."""
import csv
from functools import partial

from perf.common import program

SCENE = "earthquakes/rupture_2d.xml"
TOLERANCE = 2e-2  # of the first run
NAME = "2D, rupture by injection"


def cases(options, row):
    """Yields (name, function that returns a row)."""
    if not options.quick:
        yield NAME, partial(halved, options, row)


def halved(options, row):
    """Runs the scene twice, the second time with cells of half the size and half the tolerance. The row has the counts of
    the second run."""
    file = program.mesh(options.binary, SCENE, options.output / "meshes/rupture.msh")
    runs = [run(options, file, refinements) for refinements in (0, 1)]
    (onset, moment), (fine_onset, fine_moment) = (rupture(one.directory) for one in runs)
    return row(NAME, runs[1], {"first event": onset / fine_onset - 1, "slip": moment / fine_moment - 1})


def run(options, file, refinements):
    entries = (f"Mesh file.path={file}", f"Mesh file.refinements={refinements}", f"Time.tolerance={TOLERANCE / 2**refinements:g}",
               "Output.every=100000", *options.set)
    return program.succeeded(options.binary, SCENE, options.output / f"rupture_{refinements}", entries)


def rupture(directory):
    """Returns start and moment of the only event of a run."""
    with open(directory / "events.csv") as file:
        events = list(csv.DictReader(file))
    if len(events) != 1:
        raise program.Failed(f"{len(events)} events in {directory}, 1 expected")
    values = {title.partition(" [")[0]: text for title, text in events[0].items()}
    return float(values["start"]), float(values["moment"])
