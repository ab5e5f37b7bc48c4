"""Estimate of cells, time and memory for many fractures in 3D, before they are intersected.

Model: cells = INTERSECTIONS times the cells without intersections, seconds of an attempt = n FRACTURE_SECONDS
(n / 1000)^0.17 + GENERATIONS cells / CELLS_PER_SECOND, bytes = BYTES + n FRACTURE_BYTES + cells CELL_BYTES, from random
networks of 100, 300 and 1000 discs at constant density (`./sprekk perf meshing --files`). Cells are generated again at
conflicts, 1 to 3 times for 1000 discs."""
import os
import sys

import numpy as np
from domain import in_polygon
from shapes import NetworkError, Plane, diameter
from size_grid import NODES, SizeGrid

INTERSECTIONS = 1.6
FRACTURE_SECONDS, GENERATIONS, CELLS_PER_SECOND = 0.018, 3, 1.8e4
BYTES, FRACTURE_BYTES, CELL_BYTES = 1e8, 2.3e5, 1e3
MANY = 1000  # fractures, from which the estimate is made
NODES_PER_FRACTURE = 300  # of the grid of sizes
STEP = 1.5  # distance of points of a fracture, in sizes


class Points:
    """Required sizes at points of the fractures, for a SizeGrid."""

    def __init__(self, network):
        self.network, points, sizes = network, [], []
        for fracture in network.fractures:
            size = min(network.size, network.relative_size * diameter(fracture.points))
            plane = Plane(fracture.points)
            ring = plane.inside(fracture.points)
            axes = [np.arange(low, high, STEP * size) for low, high in zip(ring.min(axis=0), ring.max(axis=0))]
            grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
            points += [fracture.points, plane.outside(grid[in_polygon(grid, ring)])]
            sizes.append(np.full(len(points[-1]) + len(fracture.points), size))
        self.points, self.sizes = np.concatenate(points), np.concatenate(sizes)

    def expected_cells(self):
        return {"size": NODES_PER_FRACTURE * len(self.network.fractures) / NODES[3]}


def words(fractures, cells):
    """Returns seconds, bytes and a text of the estimate."""
    seconds = fractures * FRACTURE_SECONDS * (fractures / 1000) ** 0.17 + GENERATIONS * cells / CELLS_PER_SECOND
    memory = BYTES + fractures * FRACTURE_BYTES + cells * CELL_BYTES
    extrapolated = f", extrapolated from networks of {MANY}" if fractures > 2 * MANY else ""
    return seconds, memory, (f"{fractures} fractures require about {cells:.2g} cells, {memory / 1e9:.2g} GB of memory and {seconds:.2g} s for each "
                             f"attempt{extrapolated}")


def check(network):
    """Prints the estimate for many fractures in 3D. Raises an error if cells or memory exceed their limits."""
    n = len(network.fractures)
    if network.dim == 2 or n < MANY:
        return
    cells = INTERSECTIONS * SizeGrid(Points(network)).expected_cells()
    _, memory, text = words(n, cells)
    available = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    limit = f"\"maximum cells\" is {network.maximum_cells:g}" if cells > network.maximum_cells else \
        f"this machine has {available / 1e9:.2g} GB" if memory > available else None
    if limit:
        raise NetworkError(f"{network.place('fractures')}: {text}; {limit}; choose larger cells (\"relative size\", now {network.relative_size:g}, "
                           f"or \"size\", now {network.size:.3g} m), or fewer fractures")
    print(f"sprekk: {text}; conflicts between fractures may require further attempts", file=sys.stderr, flush=True)
