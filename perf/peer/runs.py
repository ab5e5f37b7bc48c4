"""A run of either program, and the judgement of both."""
import math
from dataclasses import dataclass, field

FUNCTIONALS = ("slip max", "slip mean", "t_n mean", "traction x", "traction z", "jump x", "jump z", "reaction x", "reaction z")
THERMAL = ("slip max", "slip mean", "opening", "t_n mean", "p mean", "T mean", "heat", "reaction x", "reaction z")  # mm, MPa, K, kW, GN
WITHIN = 3  # times the distance of a value from its limit, by which the two programs may differ


@dataclass
class Run:
    code: str
    cells: int
    unknowns: int
    newton: int
    seconds: float  # of the processor
    bytes: float    # most memory of the process
    values: dict = field(default_factory=dict)


def limit(coarse, fine, name):
    """By Richardson's extrapolation from the last two meshes, with an error ~ cells^(-1/3): the singular front leaves order 1."""
    ratio = (fine.cells / coarse.cells)**(1 / 3)
    return fine.values[name] + (fine.values[name] - coarse.values[name]) / (ratio - 1)


def apart(ours, theirs):
    """[mesh]{functional: difference of the programs on a mesh over the larger distance of their values from their own limits}."""
    def distance(runs, k, name):
        return abs(runs[k].values[name] - limit(*runs[-2:], name))
    return [{name: abs(ours[k].values[name] - theirs[k].values[name]) / max(distance(ours, k, name), distance(theirs, k, name))
             for name in ours[k].values} for k in range(len(ours))]


def cheapest(runs, error, most):
    """Of runs on ever finer meshes the first from which on no error is above `most`; None if the last one's is."""
    good = None
    for run in reversed(runs):
        if error(run) > most:
            break
        good = run
    return good


def at_equal_error(ours, theirs, error):
    """(their most accurate run, our cheapest that is not worse)."""
    best = min(theirs, key=error)
    return best, cheapest(ours, error, error(best))


def ratio(theirs, ours):
    return theirs.seconds / ours.seconds if ours and theirs else math.nan
