"""Run of either program, and functions that compare runs."""
import math
from dataclasses import dataclass, field

FUNCTIONALS = ("slip max", "slip mean", "t_n mean", "traction x", "traction z", "jump x", "jump z", "reaction x", "reaction z")
# mm, MPa, K, kW, GN
THERMAL = ("slip max", "slip mean", "opening", "t_n mean", "p mean", "T mean", "heat", "reaction x", "reaction z")
WITHIN = 3  # allowed difference of the programs, in distances of a value from its limit


@dataclass
class Run:
    code: str
    cells: int
    unknowns: int
    newton: int
    seconds: float  # CPU seconds
    bytes: float    # peak memory of the process
    values: dict = field(default_factory=dict)


def limit(coarse, fine, name):
    """Richardson extrapolation from two meshes with an error ~ cells^(-1/3): the singular front reduces the order
    to 1."""
    ratio = (fine.cells / coarse.cells)**(1 / 3)
    return fine.values[name] + (fine.values[name] - coarse.values[name]) / (ratio - 1)


def apart(ours, theirs):
    """[mesh]{functional: difference of the programs on a mesh, over the larger distance of their values from their
    own limits}."""
    def distance(runs, k, name):
        return abs(runs[k].values[name] - limit(*runs[-2:], name))
    return [{name: abs(ours[k].values[name] - theirs[k].values[name]) / max(distance(ours, k, name), distance(theirs, k, name))
             for name in ours[k].values} for k in range(len(ours))]


def cheapest(runs, error, maximum):
    """Returns the first run, from coarse to fine, such that its error and all later errors are at most `maximum`;
    None if the last error is larger."""
    good = None
    for run in reversed(runs):
        if error(run) > maximum:
            break
        good = run
    return good


def at_equal_error(ours, theirs, error):
    """Returns (most accurate run of PorePy, least expensive run of Sprekk with at most this error)."""
    best = min(theirs, key=error)
    return best, cheapest(ours, error, error(best))


def ratio(theirs, ours):
    return theirs.seconds / ours.seconds if ours and theirs else math.nan
