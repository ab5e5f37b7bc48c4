"""Required cell sizes on a regular grid, as a background field of gmsh that is fast for many fractures."""
import numpy as np
from scipy.ndimage import distance_transform_edt

CELL = {2: np.sqrt(3) / 4, 3: 1 / (6 * np.sqrt(2))}  # area or volume of a regular cell with edges of length 1
EXCESS = {2: 1.0, 3: 1.35}  # measured number of cells / number of regular cells, with narrow places at intersections
MAX_NODES = 3 * 10**6
NODES = {2: 4, 3: 12}  # per expected cell
EDGE = {2: 1.0, 3: 1.15}  # size for gmsh / required edge, since gmsh divides lines into edges of this length or shorter
LEVELS = 2  # per factor of two in size


class SizeGrid:
    """Sizes (nx, ny[, nz]) at the nodes of a grid over the bounding box of the domain.

    The size at a node is EDGE times the minimum over all points of their size plus `growth` times the distance."""

    def __init__(self, sizes):
        self.network = network = sizes.network
        self.domain, dim = network.domain, network.dim
        low, extent = self.domain.low, self.domain.high - self.domain.low
        nodes = np.clip(NODES[dim] * sum(sizes.expected_cells().values()), 3 * 10**5, MAX_NODES)
        self.spacing = (np.prod(extent) / nodes) ** (1 / dim)
        counts = np.maximum(np.ceil(extent / self.spacing).astype(int), 1) + 1
        self.low, self.values = low, np.full(counts, float(network.size))
        self.take(sizes.points, sizes.sizes)

    def take(self, points, sizes):
        """Reduces the sizes around points (n, 3) with required sizes (n,)."""
        network, dim, counts = self.network, self.values.ndim, self.values.shape
        index = np.round((points[:, :dim] - self.low) / self.spacing).astype(int)
        inside = np.all((index >= 0) & (index < counts), axis=1)
        index, sizes = index[inside], np.minimum(sizes[inside], network.size)
        level = np.floor(LEVELS * np.log2(sizes / network.size)).astype(int)
        for one in np.unique(level):
            of = level == one
            if sizes[of].min() >= network.size:
                continue
            away = np.ones(counts, bool)
            away[tuple(index[of].T)] = False
            size = np.exp(np.log(sizes[of]).mean())
            distance = distance_transform_edt(away, sampling=self.spacing).astype(np.float32)
            np.minimum(self.values, EDGE[dim] * (size + network.growth * distance), out=self.values)

    def expected_cells(self):
        """Returns the expected number of cells: the integral of 1 / (volume of a regular cell)."""
        dim = self.values.ndim
        axes = [self.low[k] + self.spacing * np.arange(n) for k, n in enumerate(self.values.shape)]
        share = self.domain.volume / np.prod(self.domain.high - self.domain.low)
        weight = np.ones(self.values.shape, np.float32)
        for k, x in enumerate(axes):
            width = np.clip(x + 0.5 * self.spacing, self.domain.low[k], self.domain.high[k])
            width = width - np.clip(x - 0.5 * self.spacing, self.domain.low[k], self.domain.high[k])
            weight *= width.reshape([-1 if axis == k else 1 for axis in range(dim)])
        return float((weight / self.values**dim).sum() * EXCESS[dim] / CELL[dim] * share)

    def write(self, path, origin):
        """Writes the file of gmsh's field `Structured`, in coordinates relative to `origin`.

        The grid in the file has a further node on each side, since gmsh reads invalid sizes outside of it, even at a
        distance of round-off."""
        dim = self.values.ndim
        values = np.pad(self.values if dim == 3 else self.values[:, :, None], 1, mode="edge")
        low = np.zeros(3)
        low[:dim] = self.low
        low -= origin + self.spacing
        with open(path, "wb") as file:
            for numbers in (low, np.full(3, self.spacing), np.array(values.shape, np.int32), values):
                np.ascontiguousarray(numbers).tofile(file)
