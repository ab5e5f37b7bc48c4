"""Required cell sizes on a regular grid, as a background field of gmsh that is fast for many fractures."""
import numpy as np
from scipy.ndimage import distance_transform_edt

CELL = {2: np.sqrt(3) / 4, 3: 1 / (6 * np.sqrt(2))}  # area or volume of a regular cell with edges of length 1
MAX_NODES = 3 * 10**6
NODES = {2: 4, 3: 12}  # per expected cell
LEVELS = 2  # per factor of two in size
TEXTS = 512  # different sizes in the file


class SizeGrid:
    """Sizes (nx, ny[, nz]) at the nodes of a grid over the bounding box of the domain.

    The size at a node is the minimum over all points of their size plus `growth` times the distance."""

    def __init__(self, sizes):
        network = sizes.network
        self.domain, dim = network.domain, network.dim
        low, extent = self.domain.low, self.domain.high - self.domain.low
        nodes = np.clip(NODES[dim] * sum(sizes.expected_cells().values()), 3 * 10**5, MAX_NODES)
        self.spacing = (np.prod(extent) / nodes) ** (1 / dim)
        counts = np.maximum(np.ceil(extent / self.spacing).astype(int), 1) + 1
        self.low, self.values = low, np.full(counts, float(network.size))
        index = np.round((sizes.points[:, :dim] - low) / self.spacing).astype(int)
        inside = np.all((index >= 0) & (index < counts), axis=1)
        index, values = index[inside], np.minimum(sizes.sizes[inside], network.size)
        level = np.floor(LEVELS * np.log2(values / network.size)).astype(int)
        for one in np.unique(level):
            of = level == one
            if values[of].min() >= network.size:
                continue
            away = np.ones(counts, bool)
            away[tuple(index[of].T)] = False
            size = np.exp(np.log(values[of]).mean())
            distance = distance_transform_edt(away, sampling=self.spacing).astype(np.float32)
            np.minimum(self.values, size + network.growth * distance, out=self.values)

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
        return float((weight / self.values**dim).sum() / CELL[dim] * share)

    def write(self, path, origin):
        """Writes the file of gmsh's field `Structured`, in coordinates relative to `origin`."""
        dim = self.values.ndim
        values = self.values if dim == 3 else np.repeat(self.values[:, :, None], 2, axis=2)
        low = np.zeros(3)
        low[:dim] = self.low
        low -= origin
        if dim == 2:
            low[2] = -0.5 * self.spacing
        bins = np.geomspace(values.min(), values.max(), TEXTS)
        text = np.array([f"{size:.5g}" for size in bins], object)
        words = text[np.searchsorted(bins, values.ravel() * (1 - 1e-12)).clip(0, TEXTS - 1)]
        header = [" ".join(f"{x:.17g}" for x in row) for row in (low, np.full(3, self.spacing))]
        with open(path, "w", encoding="ascii") as file:
            file.write("\n".join([*header, " ".join(map(str, values.shape)), "\n".join(words), ""]))
