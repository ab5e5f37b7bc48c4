"""Graph of points and edges that keep a minimum distance and a minimum angle, for traces in 2D and surfaces in 3D.

The steps repeat until nothing changes:
  1. merge points closer than the tolerance,
  2. insert points in edges closer than the tolerance; the end of a trace moves onto the edge, other points bend it,
  3. insert the crossings of edges,
  4. in 3D, attach points to surfaces closer than the tolerance, and edges to the surfaces of both ends,
  5. replace wedges of small angles: the shorter edge leaves the longer one farther from their common point.
No step moves a point by more than 1.3 tolerances. Sides of the domain stay plane."""
from collections import defaultdict

import numpy as np
from arrange import closest, near_pairs, on_segment
from domain import in_polygon
from scipy.spatial import cKDTree

ROUNDS, ANGLE_ROUNDS, CLEAN_ROUNDS = 40, 12, 50
WEDGE = 2.0  # separation at the end of a wedge, in tolerances, below which its edges are merged
OPENING = 1.2  # angle of an opened wedge / minimum angle
SINGULAR, FLAT = (0.1, 0.3, 0.6), 2.0  # least singular values of planes of a point; largest movement, in tolerances
REACH = 1.3  # in tolerances: separation where the shorter edge of a wedge returns to its line


class JoinedGraph:
    """Points (n, 3), edges {(a, b): set of owners} with a < b, and touches {point: owners without an edge there}.

    `fixed` are the owners that stay straight or plane, the sides of the domain. `cut` lists (length, owners) of
    removed edges."""

    def __init__(self, segments, parents, fixed, tolerance, surfaces=(), touches=()):
        """`segments` (m, 2, 3) with a set of owners each. In 3D `surfaces` are the owners; `touches` are (point, owners)."""
        self.tolerance, self.fixed, self.cut, self.surfaces = tolerance, frozenset(fixed), [], surfaces
        self.points = np.concatenate([segments.reshape(-1, 3), *(np.reshape(x, (1, 3)) for x, _ in touches)])
        self.home = self.points.copy()  # first places, which limit movements into planes
        self.noise = 1e-10 * np.ptp(self.points, axis=0).max()  # distance of equal points
        self.edges, self.touches = defaultdict(set), defaultdict(set)
        for k, of in enumerate(parents):
            self.edges[2 * k, 2 * k + 1] |= of
        for k, (_, of) in enumerate(touches):
            self.touches[2 * len(segments) + k] |= of

    def arrays(self):
        """Returns the ends (m, 2) and segments (m, 2, 3) of all edges."""
        ends = np.array(list(self.edges), int).reshape(-1, 2)
        return ends, self.points[ends]

    def belongs(self):
        """Returns {point: owners}."""
        found = defaultdict(set)
        for (a, b), of in self.edges.items():
            found[a] |= of
            found[b] |= of
        for point, of in self.touches.items():
            found[point] |= of
        return found

    def extend(self, points):
        if len(points):
            self.points, self.home = (np.concatenate([x, points]) for x in (self.points, self.home))

    def put(self, chain, of):
        for a, b in zip(chain, chain[1:]):
            if a != b:
                self.edges[min(a, b), max(a, b)] |= of

    def renumber(self, owner):
        """Replaces points by those of `owner`, and removes unused points and edges without length."""
        edges, touches = self.edges, self.touches
        self.edges, self.touches = defaultdict(set), defaultdict(set)
        for (a, b), of in edges.items():
            if owner[a] != owner[b]:
                self.put([int(owner[a]), int(owner[b])], of)
            elif self.surfaces:
                touches[a] |= of
        for point, of in touches.items():
            self.touches[int(owner[point])] |= of
        used = np.unique(np.array([*self.edges, *((p, p) for p in self.touches)], int))
        number = np.full(len(self.points), -1)
        number[used] = np.arange(len(used))
        self.points, self.home = self.points[used], self.home[used]
        self.edges = defaultdict(set, {tuple(sorted((int(number[a]), int(number[b])))): of for (a, b), of in self.edges.items()})
        self.touches = defaultdict(set, {int(number[p]): of for p, of in self.touches.items()})

    def merge(self):
        """Merges points closer than the tolerance with a point that stays. Returns the number of merged points."""
        pairs = cKDTree(self.points).query_pairs(self.tolerance, output_type="ndarray")
        if not len(pairs):
            return 0
        sides, degree = {p: of & self.fixed for p, of in self.belongs().items()}, defaultdict(int)
        for edge in self.edges:
            for point in edge:
                degree[point] += 1
        near = defaultdict(list)
        for a, b in pairs.tolist():
            near[a].append(b)
            near[b].append(a)
        owner, free, n = np.arange(len(self.points)), np.ones(len(self.points), bool), 0
        for point in sorted(near, key=lambda k: (-len(sides.get(k, ())), -degree[k], k)):
            if not free[point]:
                continue
            free[point] = False
            for other in near[point]:
                same = np.linalg.norm(self.points[point] - self.points[other]) <= self.noise
                if free[other] and (same or sides.get(other, frozenset()) <= sides.get(point, frozenset())):
                    owner[other], free[other], n = point, False, n + 1
        if n:
            self.renumber(owner)
        return n

    def insert(self):
        """Inserts points in near edges, and crossings. Returns the number of changes."""
        tolerance, (ends, x) = self.tolerance, self.arrays()
        i, j = near_pairs(x.min(axis=1), x.max(axis=1), 2 * tolerance)
        belongs, degree = self.belongs(), np.bincount(ends.ravel(), minlength=len(self.points))
        sides = [of & self.fixed for of in self.edges.values()]
        chains, moves, new = defaultdict(list), {}, []
        for one, other in ((i, j), (j, i)):
            for end in (0, 1):
                point = ends[one, end]
                t, gap = on_segment(self.points[point], x[other, 0], x[other, 1])
                away = (ends[other] != point[:, None]).all(axis=1) & (gap < tolerance) & (t > 0) & (t < 1)
                for k in np.flatnonzero(away):
                    edge, p = int(other[k]), int(point[k])
                    if any((min(p, q), max(p, q)) in self.edges for q in ends[edge].tolist()):
                        continue  # a wedge
                    of_point = belongs[p] & self.fixed
                    if of_point < sides[edge] or (not self.surfaces and degree[p] == 1 and not of_point):
                        if len(sides[edge]) < moves.get(p, (0,))[0]:
                            continue
                        moves[p] = len(sides[edge]), x[edge, 0] + t[k] * (x[edge, 1] - x[edge, 0])
                    elif not of_point >= sides[edge]:
                        continue  # a point of another side
                    chains[edge].append((t[k], p))
        apart = (ends[i][:, :, None] != ends[j][:, None, :]).all(axis=(1, 2))
        i, j = i[apart], j[apart]
        s, t, gap = closest(x[i], x[j])
        n = len(self.points)
        for k in np.flatnonzero((gap < tolerance) & (s > 0) & (s < 1) & (t > 0) & (t < 1)):
            a, b = x[i[k]], x[j[k]]
            on_one, on_other = (1 - s[k]) * a[0] + s[k] * a[1], (1 - t[k]) * b[0] + t[k] * b[1]
            one, other = sides[i[k]], sides[j[k]]
            point = on_one if one > other else on_other if other > one else 0.5 * (on_one + on_other)
            if np.linalg.norm(np.concatenate([a, b]) - point, axis=1).min() < tolerance or not (one <= other or other <= one):
                continue  # the end is inserted instead
            chains[int(i[k])].append((s[k], n))
            chains[int(j[k])].append((t[k], n))
            new.append(point)
            n += 1
        for p, (_, place) in moves.items():
            self.points[p] = place
        self.extend(new)
        edges = list(self.edges)
        for k, between in chains.items():
            a, b = edges[k]
            of = self.edges.pop((a, b))
            self.put([a, *dict.fromkeys(p for _, p in sorted(between) if p not in (a, b)), b], of)
        return len(chains) + len(moves)

    def attach(self):
        """Attaches points and edges to near surfaces, in 3D. Returns the number of changes."""
        n, belongs = 0, self.belongs()
        for k, surface in enumerate(self.surfaces):
            reach = self.tolerance
            near = np.flatnonzero(np.all((self.points > surface.low - reach) & (self.points < surface.high + reach), axis=1))
            height = surface.plane.height(self.points[near])
            near, height = near[abs(height) < reach], height[abs(height) < reach]
            over = in_polygon(surface.plane.inside(self.points[near]), surface.plane.inside(surface.rings[0]))
            for p, h in zip(near[over].tolist(), height[over]):
                sides = belongs[p] & self.fixed
                if k in belongs[p] or (k in self.fixed and any(
                        abs(self.surfaces[s].plane.normal @ surface.plane.normal) > 1e-9 for s in sides)):
                    continue
                if k in self.fixed:
                    self.points[p] -= h * surface.plane.normal
                self.touches[p].add(k)
                belongs[p].add(k)
                n += 1
        for (a, b), of in self.edges.items():
            for k in (belongs[a] & belongs[b]) - of:
                middle = 0.5 * (self.points[a] + self.points[b])
                plane, ring = self.surfaces[k].plane, self.surfaces[k].rings[0]
                level = abs(plane.height(middle)) < (1e-9 * np.ptp(ring, axis=0).max() if k in self.fixed else 2 * self.tolerance)
                if level and in_polygon(plane.inside(middle[None]), plane.inside(ring))[0]:
                    of.add(k)
                    n += 1
        return n

    def flatten(self):
        """Moves points into the planes of all their surfaces, as far as the angles between the planes allow it."""
        for p, of in self.belongs().items():
            planes = [self.surfaces[k].plane for k in sorted(of)]
            height = np.array([plane.height(self.points[p]) for plane in planes])
            if abs(height).max() < self.noise:
                continue
            left, size, right = np.linalg.svd(np.array([plane.normal for plane in planes]), full_matrices=False)
            for smallest in SINGULAR:
                use = size > smallest
                step = -right[use].T @ ((left.T @ height)[use] / size[use])
                if np.linalg.norm(self.points[p] + step - self.home[p]) <= FLAT * self.tolerance:
                    self.points[p] += step
                    break
            for _ in range(3):
                for k in of & self.fixed:
                    self.points[p] -= self.surfaces[k].plane.height(self.points[p]) * self.surfaces[k].plane.normal

    def settle(self):
        """Merges, inserts and attaches until nothing changes. Returns whether it came to an end."""
        for _ in range(ROUNDS):
            changes = self.merge()
            changes += self.insert()
            if self.surfaces:
                changes += self.attach()
                self.flatten()
            if not changes:
                return True
        return False

    def wedges(self, minimum):
        """Returns [(point, end of the shorter edge, end of the longer edge, angle)] of angles below `minimum`, in rad.

        In 3D both edges belong to one surface."""
        ends, x = self.arrays()
        along = x[:, 1] - x[:, 0]
        length = np.linalg.norm(along, axis=1)
        star, of = defaultdict(list), list(self.edges.values())
        for k, (a, b) in enumerate(ends.tolist()):
            star[a].append((b, k, along[k] / length[k]))
            star[b].append((a, k, -along[k] / length[k]))
        found = []
        for point, rays in star.items():
            if len(rays) < 2:
                continue
            unit = np.array([ray[2] for ray in rays])
            cosine = unit @ unit.T
            for i, j in zip(*np.nonzero(np.triu(cosine > np.cos(minimum), 1))):
                (p, one, u), (q, other, v) = rays[i], rays[j]
                fixed = [bool(of[k] & self.fixed) for k in (one, other)]
                if all(fixed) and not self.surfaces or self.surfaces and not of[one] & of[other]:
                    continue
                if (fixed[0], length[one]) > (fixed[1], length[other]):
                    p, q = q, p
                found.append((point, p, q, 2 * np.arcsin(min(1, 0.5 * np.linalg.norm(u - v)))))
        return found

    def open_wedges(self, minimum):
        """Replaces wedges with angles below `minimum`, in rad. Returns their number."""
        found, touched, belongs = self.wedges(minimum), set(), self.belongs()
        for apex, short, long, angle in sorted(found, key=lambda wedge: wedge[3]):
            pair = {tuple(sorted((apex, short))), tuple(sorted((apex, long)))}
            if touched & pair or not pair <= set(self.edges):
                continue
            touched |= pair
            self.open_wedge(apex, short, long, angle, minimum, {p: belongs[p] & self.fixed for p in (apex, short, long)})
        return len(found)

    def open_wedge(self, apex, short, long, angle, minimum, sides):
        edge, base = (min(apex, short), max(apex, short)), (min(apex, long), max(apex, long))
        of, on_sides = self.edges[edge], self.edges[base] & self.fixed
        a, b, c = self.points[[apex, short, long]]
        length, whole = np.linalg.norm(b - a), np.linalg.norm(c - a)
        along = (c - a) / whole
        if length * np.sin(angle) < WEDGE * self.tolerance:
            if sides[short] < on_sides or (not self.surfaces and not sides[short] and self.degree(short) == 1):
                self.points[short] = a + min(length * np.cos(angle), whole) * along
            elif not sides[short] >= on_sides:
                self.remove(edge)
                return
            self.edges.pop(edge)
            both = self.edges.pop(base)
            self.put([apex, short], of | both)
            self.put([short, long], both)
            return
        reach = min(length, REACH * self.tolerance / np.sin(angle))
        leave = reach * (np.cos(angle) - np.sin(angle) / np.tan(OPENING * minimum))
        n = len(self.points)
        self.extend([a + leave * along, a + reach * (b - a) / length])
        both = self.edges.pop(base)
        self.edges.pop(edge)
        self.put([apex, n], of | both)
        self.put([n, long], both)
        self.put([n, n + 1, short], of)

    def degree(self, point):
        return sum(point in edge for edge in self.edges)

    def remove(self, edge):
        self.cut.append((np.linalg.norm(self.points[edge[0]] - self.points[edge[1]]), self.edges.pop(edge)))

    def repair(self, minimum):
        """Removes distances below the tolerance and angles below `minimum`, in rad."""
        for _ in range(ANGLE_ROUNDS):
            self.settle()
            if not self.open_wedges(minimum):
                return
        for _ in range(CLEAN_ROUNDS if not self.surfaces else 0):  # rare: edges that no move separates
            self.settle()
            found = self.wedges(minimum)
            if not found:
                return
            for apex, short, _, _ in found:
                edge = min(apex, short), max(apex, short)
                if edge in self.edges and not self.edges[edge] & self.fixed:
                    self.remove(edge)
