"""Sizes of cells: required lengths of edges at points.

Between points the length grows in proportion to the distance."""
from collections import Counter

import numpy as np
from arrange import closest, near_pairs, on_segment
from domain import in_polygon
from shapely.geometry import Point
from shapes import NetworkError, diameter
from size_grid import CELL, SizeGrid

TIP_RATIO = {2: 1 / 20, 3: 1 / 2}  # default size at tips / size at the fracture
REPAIRED_TIP_RATIO = {2: 1 / 2, 3: 1}  # of repaired networks
# In gaps: size / width of the gap, and smallest size / size at the fractures.
GAP = {2: (1, 1 / 20), 3: (1, 1 / 8)}
REPAIRED_GAP = {2: (1, 1 / 20), 3: (3, 1 / 2)}  # of repaired networks; their mesh is refined further where cells are poor


class Sizes:
    """Required `sizes` (n,), m, at `points` (n, 3). `at_edge` contains the size of each edge of the plan."""

    def __init__(self, plan):
        self.plan, self.network = plan, plan.network
        self.grid = None  # of repaired networks
        self.of_owner = [self.fracture_size(owner) if owner.kind == "fracture" else np.inf for owner in plan.owners]
        self.tips, self.intersections = special(plan)
        self.edges = np.array(list(plan.edges))
        self.segments = plan.graph.segments()
        self.at_edge = np.array([self.edge_size(edge, of) for edge, of in plan.edges.items()])
        repaired = self.network.repair != "report"
        if not repaired:
            self.check_number()
        self.found = [np.empty((0, 3))], [np.empty(0)]
        self.take_edges()
        if plan.dim == 2:
            self.take_points()
        else:
            self.take_surfaces()
        self.take_gaps()
        self.points, self.sizes = np.concatenate(self.found[0]), np.concatenate(self.found[1])
        if repaired:
            self.grid = SizeGrid(self)
            self.check_number()

    def fracture_size(self, fracture):
        x = fracture.points
        length = diameter(x) if self.plan.dim == 3 else np.linalg.norm(np.diff(x, axis=0), axis=1).sum()
        return min(self.network.size, self.network.relative_size * length)

    def expected_cells(self):
        """Returns the expected number of cells caused by each entry, {entry: number}.

        The number is the integral of 1 / (volume of a regular cell) around each edge, point and surface. The
        integral extends over the region in which the length of edges grows from the given size to the largest."""
        network, dim, largest, found = self.network, self.plan.dim, self.network.size, Counter()
        found["size"] = network.domain.volume / largest**dim

        def add(entry, size, measure, of_dim):
            s, g = min(size, largest), network.growth
            found[entry] += measure * {
                (2, 1): 2 / g * (1 / s - 1 / largest), (3, 2): 1 / g * (1 / s**2 - 1 / largest**2),
                (2, 0): 2 * np.pi / g**2 * (np.log(largest / s) + s / largest - 1), (3, 1): np.pi / (g**2 * s) * (1 - s / largest)**2}[dim, of_dim]

        tips = "size at tips" if network.size_at["tips"] else "relative size"
        length = np.linalg.norm(self.segments[:, 1] - self.segments[:, 0], axis=1)
        for (edge, of), size, measure in zip(self.plan.edges.items(), self.at_edge, length):
            around = min(self.of_owner[k] for k in of)
            entry = tips if edge in self.tips else "size at intersections" if edge in self.intersections else "size at boundary"
            if dim == 2:
                add("size at boundary" if size < around else "relative size", size, measure, 1)
            elif size < around:
                add(entry, size, measure, 1)
        if dim == 2:
            at = self.plan.graph.parents_at()
            for p in self.tips:
                add(tips, self.tip_size([k for k in at[p] if self.plan.is_fracture(k)]), 1, 0)
            if network.size_at["intersections"]:
                add("size at intersections", network.size_at["intersections"], len(self.intersections), 0)
        for k, surface in enumerate(self.plan.surfaces or ()):
            if surface.feature.kind == "boundary" and network.size_at["boundary"]:
                add("size at boundary", network.size_at["boundary"], 0.5 * surface.shape.area, 2)
            elif surface.feature.kind == "fracture":
                add("relative size", self.of_owner[k], surface.shape.area, 2)
        return {entry: n / CELL[dim] for entry, n in found.items()}

    def expected_number(self):
        return self.grid.expected_cells() if self.grid else sum(self.expected_cells().values())

    def check_number(self):
        """Raises an error if the expected number of cells exceeds the limit."""
        cells, maximum = self.expected_cells(), self.network.maximum_cells
        n, entry = self.expected_number(), max(cells, key=cells.get)
        share = cells[entry] / sum(cells.values())
        if n > maximum:
            raise NetworkError(f"Sprekk > Mesh file > network: sizes require about {n:.2g} cells, {share:.0%} of them due to "
                               f"\"{entry}\"; \"maximum cells\" is {maximum:g}")

    def add(self, points, sizes):
        self.found[0].append(np.atleast_2d(points))
        self.found[1].append(np.minimum(np.broadcast_to(sizes, len(np.atleast_2d(points))), self.network.size))

    def tip_size(self, owners):
        size = self.network.size_at["tips"]
        ratio = (TIP_RATIO if self.network.repair == "report" else REPAIRED_TIP_RATIO)[self.plan.dim]
        return size if size is not None else ratio * min(self.of_owner[k] for k in owners)

    def edge_size(self, edge, of):
        size = min([self.network.size] + [self.of_owner[k] for k in of])
        if self.plan.dim == 3 and edge in self.tips:
            size = min(size, self.tip_size(of))
        if self.plan.dim == 3 and edge in self.intersections and self.network.size_at["intersections"]:
            size = min(size, self.network.size_at["intersections"])
        if self.network.size_at["boundary"] and any(self.plan.owners[k].kind == "boundary" for k in of):
            size = min(size, self.network.size_at["boundary"])
        return size

    def take_edges(self):
        for (begin, end), size in zip(self.segments, self.at_edge):
            if size < self.network.size:
                n = int(np.ceil(np.linalg.norm(end - begin) / size))
                self.add(begin + np.linspace(0, 1, n + 1)[:, None] * (end - begin), size)

    def take_points(self):
        at = self.plan.graph.parents_at()
        for p in self.tips:
            self.add(self.plan.points[p], self.tip_size([k for k in at[p] if self.plan.is_fracture(k)]))
        if self.network.size_at["intersections"]:
            for p in self.intersections:
                self.add(self.plan.points[p], self.network.size_at["intersections"])

    def take_surfaces(self):
        """Adds points inside of surfaces, far from their edges."""
        for k, surface in enumerate(self.plan.surfaces):
            size = self.of_owner[k]
            if surface.feature.kind == "boundary":
                size = self.network.size_at["boundary"] or np.inf
            if size >= self.network.size:
                continue
            ring = np.array(surface.shape.exterior.coords)
            axes = [np.arange(low, high, 1.5 * size) for low, high in zip(ring.min(axis=0), ring.max(axis=0))]
            grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
            grid = grid[in_polygon(grid, ring[:-1])]
            if len(grid):
                self.add(surface.plane.outside(grid), size)

    def take_gaps(self):
        """Adds sizes where edges that do not meet are closer than their size; in 3D also for points and surfaces."""
        i, j = near_pairs(self.segments.min(axis=1), self.segments.max(axis=1), self.at_edge)
        apart = ~(self.edges[i][:, :, None] == self.edges[j][:, None, :]).any(axis=(1, 2))
        i, j = i[apart], j[apart]
        wanted = np.minimum(self.at_edge[i], self.at_edge[j])
        _, _, gap = closest(self.segments[i], self.segments[j])
        factor, minimum = self.in_gaps()
        for k in np.flatnonzero(factor * gap < wanted):
            for one, other in ((i[k], j[k]), (j[k], i[k])):
                begin, end = self.segments[one]
                n = min(int(np.ceil(np.linalg.norm(end - begin) / gap[k])), 64)
                x = begin + np.linspace(0, 1, n + 1)[:, None] * (end - begin)
                _, distance = on_segment(x, *(np.broadcast_to(y, x.shape) for y in self.segments[other]))
                near = factor * distance < wanted[k]
                if near.any():
                    self.add(x[near], np.maximum(factor * distance[near], minimum * wanted[k]))
        if self.plan.dim == 3:
            self.take_gaps_of_surfaces()

    def in_gaps(self):
        """Returns size / width of a gap, and the smallest size in a gap / size at the fractures."""
        return (GAP if self.network.repair == "report" else REPAIRED_GAP)[self.plan.dim]

    def take_gaps_of_surfaces(self):
        at, points, (factor, minimum) = self.plan.graph.parents_at(), self.plan.points, self.in_gaps()
        for k, surface in enumerate(self.plan.surfaces):
            size = min(self.of_owner[k], self.network.size)
            near = np.flatnonzero(np.all((points > surface.low - size) & (points < surface.high + size), axis=1))
            near = near[factor * abs(surface.plane.height(points[near])) < size]
            near = near[in_polygon(surface.plane.inside(points[near]), np.array(surface.shape.exterior.coords[:-1]))]
            near = np.array([p for p in near.tolist() if k not in at[p] | self.plan.touching.get(p, set())], int)
            if len(near):
                wanted = np.maximum(factor * abs(surface.plane.height(points[near])), minimum * size)
                for x in (points[near], surface.plane.outside(surface.plane.inside(points[near]))):
                    self.add(x, wanted)


def special(plan):
    """Returns the tips of fractures in the rock and the intersections: points in 2D, edges in 3D."""
    if plan.dim == 3:
        tips, intersections = set(), set()
        for edge, of in plan.edges.items():
            n = sum(plan.is_fracture(k) for k in of)
            on_side = any(plan.owners[k].kind == "boundary" for k in of)
            if n == 1 and not on_side and is_side(plan, edge, next(k for k in of if plan.is_fracture(k))):
                tips.add(edge)
            elif n > 1:
                intersections.add(edge)
        return tips, intersections
    count, at = Counter(), plan.graph.parents_at()
    for edge, of in plan.edges.items():
        if plan.fractures_of(of):
            count.update(edge)
    sides = {p for edge, of in plan.edges.items() if any(plan.owners[k].kind == "boundary" for k in of) for p in edge}
    tips = {p for p, n in count.items() if n == 1 and p not in sides}
    return tips, {p for p in count if len(plan.fractures_of(at[p])) > 1}


def is_side(plan, edge, owner):
    """Returns whether an edge lies on the rim of its surface."""
    surface = plan.surfaces[owner]
    middle = surface.plane.inside(0.5 * (plan.points[edge[0]] + plan.points[edge[1]]))
    return surface.shape.boundary.distance(Point(middle)) <= 10 * plan.tolerance
