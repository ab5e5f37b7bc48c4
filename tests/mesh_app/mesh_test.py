#!/usr/bin/env python3
"""Meshes of fracture networks: mesh_test.py PROGRAM ROOT MPIEXEC"""
import unittest
from unittest import mock

import numpy as np
from conformity import CUBE, SQUARE, defects, measure_of, meshed, mesher, network, numbers, planned
from msh_file import groups_of
from orientations import poles, strikes
from report import gamma
from shapes import NetworkError, ellipse
from sizes import Sizes


def square_at(axis, place, low=0.2, high=0.8):
    """Returns a square normal to an axis."""
    flat = np.array([[low, low], [high, low], [high, high], [low, high]], float)
    return np.insert(flat, axis, place, axis=1)


class Conformity(unittest.TestCase):
    def expect(self, fractures, measures=None, domain=None, intersections=None, **entries):
        """Checks that the mesh conforms to the network, and that each set has the expected length or area."""
        plan, mesh = meshed(network(fractures, domain, **entries))
        self.assertEqual(defects(plan, mesh), [])
        for name, measure in (measures or {}).items():
            self.assertAlmostEqual(measure_of(plan, mesh, name), measure, 9, name)
        if intersections is not None:
            self.assertEqual(len(mesh.intersections), intersections)
        return plan, mesh


class Lines(Conformity):
    def test_crossings(self):
        a, b = [[0.2, 0.5], [0.8, 0.5]], [[0.5, 0.2], [0.5, 0.8]]
        for name, other, n in (("X", b, 1), ("T", [[0.5, 0.5], [0.5, 0.8]], 1), ("L", [[0.8, 0.5], [0.8, 0.9]], 1),
                               ("oblique", [[0.3, 0.3], [0.7, 0.6]], 1), ("apart", [[0.2, 0.6], [0.8, 0.6]], 0)):
            with self.subTest(name):
                length = np.linalg.norm(np.subtract(*other))
                self.expect({"a": a, "b": other}, {"a": 0.6, "b": length}, intersections=n)

    def test_several_through_one_point(self):
        def star(n, whole):
            for k in range(n):
                along = 0.3 * np.array([np.cos(np.pi * k / n * (1 if whole else 2)), np.sin(np.pi * k / n * (1 if whole else 2))])
                yield f"f{k}", [0.5 - along if whole else np.array([0.5, 0.5]), 0.5 + along]
        plan, mesh = self.expect(dict(star(5, True)), {f"f{k}": 0.6 for k in range(5)}, intersections=1)
        self.assertTrue(np.allclose(mesh.points[mesh.intersections[0, 0]], [0.5, 0.5, 0], atol=1e-12))
        _, none = self.expect({"a": [[0.2, 0.5], [0.8, 0.5]]}, intersections=0)
        self.assertEqual(none.intersections.shape, (0, 1))
        self.expect(dict(star(3, False)), {f"f{k}": 0.3 for k in range(3)}, intersections=1)  # Y-shaped

    def test_polyline(self):
        self.expect({"a": [[0.2, 0.2], [0.5, 0.3], [0.6, 0.8]], "b": [[0.1, 0.6], [0.9, 0.6]]},
                    {"a": np.hypot(0.3, 0.1) + np.hypot(0.1, 0.5), "b": 0.8}, intersections=1)

    def test_clipped_and_on_the_boundary(self):
        self.expect({"a": [[-0.5, 0.5], [0.5, 0.5]], "through": [[0.3, -1], [0.3, 2]], "touches": [[0.7, 0.2], [1, 0.2]],
                     "corner": [[0, 0], [0.2, 0.2]]}, {"a": 0.5, "through": 1, "touches": 0.3, "corner": np.hypot(0.2, 0.2)})

    def test_lines_that_turn_but_not_back(self):
        """Short segments of a curve, or a closed line, are not rejected as folds."""
        angle = np.linspace(0, np.pi, 60)
        curve = np.column_stack([0.5 + 3e-3 * np.cos(angle), 0.5 + 3e-3 * np.sin(angle)])
        planned(network({"a": curve, "b": [[0.2, 0.2], [0.4, 0.2], [0.3, 0.4], [0.2, 0.2]]}))

    def test_polygon_that_is_not_convex(self):
        corners = [0, 0, 2, 0, 2, 1, 1, 1, 1, 2, 0, 2]
        domain = {**SQUARE, "lower corner": [], "upper corner": [], "corners": list(map(float, corners)), "sides": list("abcdae")}
        plan, mesh = self.expect({"f": [[0.25, 2.25], [2.25, 0.25]]}, {"f": 2 * np.hypot(0.5, 0.5), "a": 3, "c": 1}, domain)
        self.assertEqual({owner.group for owner in plan.owners}, set("abcdef"))

    def test_near_touches_are_joined_within_the_tolerance(self):
        plan, mesh = meshed(network({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.499]]}, tolerance=2e-3))
        self.assertEqual(len(mesh.intersections), 1)
        self.assertIn('fracture "a" of "a" and fracture "b" of "b"', plan.repairs[0])
        plan, mesh = meshed(network({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.499]]}, tolerance=5e-4, minimum_distance=5e-4))
        self.assertEqual((len(mesh.intersections), plan.repairs), (0, []))
        self.assertEqual(defects(plan, mesh), [])

    def test_sides_stay_straight(self):
        """Ends and crossings that are joined to a side of the domain move onto it."""
        lines = {"a": [[0.3, 0.001], [0.3, 0.5]], "b": [[0.6, 0.5], [0.65, -0.001]], "c": [[0.799, 0.5], [0.801, -0.5]], "d": [[0.75, -0.03], [0.85, 0.033]]}
        plan, mesh = meshed(network(lines, tolerance=5e-3))
        self.assertEqual(defects(plan, mesh, 6e-3), [])
        self.assertEqual(sum(owner.group == "south" for owner in plan.owners), 1)

    def test_regions_and_constraints(self):
        seam = {**SQUARE, "lower corner": [0.0, 0.2], "upper corner": [1.0, 0.4]}
        plan, mesh = self.expect({"a": [[0.5, 0.1], [0.5, 0.9]], "on": [[0.6, 0.4], [0.9, 0.4]]}, {"a": 0.8, "on": 0.3}, regions={"seam": seam},
                                 constraints={"line": {"lines": {"1": numbers([[0.1, 0.6], [0.7, 0.9]])}}})
        groups = {name: elements for dim, name, elements, _ in groups_of(mesh, plan)}
        x = mesh.points[groups["seam"]][:, :, 1]
        self.assertTrue((x > 0.2 - 1e-12).all() and (x < 0.4 + 1e-12).all())
        self.assertNotIn("line", groups)

    def test_sizes(self):
        """Edges at tips, intersections and the boundary have the required length, and are longer away from them."""
        plan, mesh = meshed(network({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.8]]}, relative_size=0.1, size_at_tips=0.003,
                                    size_at_intersections=0.01, size_at_boundary=0.05, size=0.2))
        edges = np.unique(np.sort(np.concatenate([mesh.cells[:, [0, 1]], mesh.cells[:, [1, 2]], mesh.cells[:, [2, 0]]]), axis=1), axis=0)
        length = np.linalg.norm(mesh.points[edges[:, 0]] - mesh.points[edges[:, 1]], axis=1)

        def at(x, y):
            node = np.argmin(np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1] - y))
            return np.median(length[(edges == node).any(axis=1)])
        for place, size in (((0.2, 0.5), 0.003), ((0.5, 0.5), 0.01), ((0, 0), 0.05)):
            self.assertTrue(0.6 * size < at(*place) < 1.6 * size, f"{place}: {at(*place)}")
        self.assertLess(at(0.203, 0.5), at(0.25, 0.5))


    def test_default_sizes(self):
        """Default sizes are 0.1 of the length along a fracture, and 0.05 of that at its tips."""
        net = network({"a": [[0.2, 0.5], [0.8, 0.5]]}, relative_size=0.1)
        net.size_at["tips"] = None
        plan, mesh = meshed(net)
        edges = np.sort(np.linalg.norm(np.diff(mesh.points[mesh.faces[mesh.face_owner == 4]], axis=1), axis=(1, 2)))
        self.assertTrue(0.5 * 0.003 < edges[0] < 1.5 * 0.003, edges[0])
        self.assertTrue(0.4 * 0.06 < edges[-1] < 1.5 * 0.06, edges[-1])

    def test_precision_of_the_division_of_lines(self):
        """Edges differ from those of the default precision of gmsh, which costs more time, by less than 1e-4."""
        lengths = []
        for precision in (mesher.PRECISION_OF_FIELDS, 1e-9):
            with mock.patch.object(mesher, "PRECISION_OF_FIELDS", precision):
                plan, mesh = meshed(network({"a": [[0.03, 0.5], [0.95, 0.52]], "b": [[0.41, 0.2], [0.43, 0.9]]}, size_at_tips=1e-3))
            lengths.append(np.sort(np.linalg.norm(np.diff(mesh.points[mesh.faces], axis=1), axis=(1, 2))))
        difference = np.max(np.abs(lengths[0] / lengths[1] - 1))
        self.assertLess(difference, 1e-4)
        self.assertGreater(difference, 1e-9)  # the precision takes effect

    def test_gaps_are_resolved(self):
        """Cells between two parallel fractures are about as large as the gap."""
        plan, mesh = meshed(network({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.2, 0.52], [0.8, 0.52]]}))
        quality, _ = gamma(mesh.points, mesh.cells)
        self.assertGreater(quality.min(), 0.3)


class Places(Conformity):
    def test_far_from_the_origin(self):
        """A domain of 1 m with UTM coordinates has almost the same mesh as at the origin."""
        lines = {"a": [[0.2, 0.5], [0.8, 0.55]], "b": [[0.5, 0.2], [0.45, 0.8]]}
        planes = {"a": square_at(2, 0.5), "b": square_at(1, 0.6, 0.1, 0.9)}
        for fractures, domain, tip in ((lines, SQUARE, 0.002), (planes, CUBE, 0.04)):
            found = []
            for far in (np.zeros(3), np.array([5e5, 6.7e6, -2e3])):
                moved = {name: np.array(points) + far[:len(points[0])] for name, points in fractures.items()}
                corners = {k: (np.array(domain[k]) + far[:len(domain[k])]).tolist() for k in ("lower corner", "upper corner")}
                plan, mesh = meshed(network(moved, {**domain, **corners}, size_at_tips=tip))
                self.assertEqual(defects(plan, mesh, 1e-7), [])
                found.append((len(mesh.cells), gamma(mesh.points, mesh.cells)[0].min(), len(mesh.intersections)))
            self.assertLess(abs(found[1][0] / found[0][0] - 1), 0.05, found)
            self.assertGreater(found[1][1], 0.7 * found[0][1], found)
            self.assertLess(abs(found[0][2] - found[1][2]), 3)


class Polygons(Conformity):
    def test_crossings(self):
        a = square_at(2, 0.5)
        for name, other, area in (("X", square_at(0, 0.5), 0.36), ("T", square_at(0, 0.5) * [1, 1, 0.5] + [0, 0, 0.4], 0.18),
                                  ("L", [[0.2, 0.2, 0.5], [0.2, 0.8, 0.5], [0.2, 0.8, 0.9], [0.2, 0.2, 0.9]], 0.24),
                                  ("shared corner", [[0.8, 0.8, 0.5], [0.9, 0.8, 0.5], [0.9, 0.9, 0.9]], None),
                                  ("level, shared edge", [[0.8, 0.2, 0.5], [0.9, 0.2, 0.5], [0.9, 0.6, 0.5], [0.8, 0.6, 0.5]], 0.04),
                                  ("edge through the middle", [[0.5, 0.1, 0.3], [0.5, 0.9, 0.3], [0.5, 0.5, 0.7]], 0.16),
                                  ("parallel", square_at(2, 0.6), 0.36)):
            with self.subTest(name):
                self.expect({"a": a, "b": other}, {"a": 0.36, **({"b": area} if area else {})})

    def test_level_polygons_that_share_sides(self):
        """Common sides of polygons in one plane, in any orientation, are not tips: a fault and a ring."""
        random = np.random.default_rng(23)
        for case in range(6):
            turn = np.linalg.qr(random.normal(size=(3, 3)))[0] if case else np.eye(3)
            x, y = np.meshgrid(*2 * [np.linspace(-0.3, 0.3, 4)])
            flat = np.stack([x, y, 0 * x], axis=-1)
            flat[1:-1, 1:-1, :2] += random.uniform(-0.04, 0.04, (2, 2, 2))
            x = np.round(0.5 + flat @ turn.T, 7 if case % 2 else 16)
            triangles = {f"f{i}{j}{k}": [x[i, j], *corners] for i in range(3) for j in range(3) for k, corners in
                         enumerate(([x[i, j + 1], x[i + 1, j + 1]], [x[i + 1, j + 1], x[i + 1, j]]))}
            self.expect_whole(triangles, 0.36, 2.4)
        angle = np.pi / 6 * np.arange(12)
        ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        quadrilaterals = {f"f{k}": 0.5 + np.array([0.4 * a, 0.4 * b, 0.2 * b, 0.2 * a]) for k, (a, b) in enumerate(zip(ring, np.roll(ring, -1, axis=0)))}
        self.expect_whole(quadrilaterals, 3 * (0.4**2 - 0.2**2), 24 * 0.6 * np.sin(np.pi / 12))

    def expect_whole(self, fractures, area, front):
        """Checks the total area of the fractures and the total length of their tips."""
        net = network(fractures)
        plan, mesh = meshed(net)
        self.assertEqual(defects(plan, mesh, 1e-6), [])
        self.assertAlmostEqual(sum(measure_of(plan, mesh, name) for name in fractures), area, 6)
        self.assertAlmostEqual(sum(np.linalg.norm(plan.points[a] - plan.points[b]) for a, b in Sizes(plan).tips), front, 5)

    def test_triple_point_and_three_through_a_line(self):
        plan, mesh = self.expect({f"f{axis}": square_at(axis, 0.5) for axis in range(3)}, {f"f{axis}": 0.36 for axis in range(3)})
        middle = np.argmin(np.linalg.norm(mesh.points - 0.5, axis=1))
        self.assertEqual(mesh.points[middle].tolist(), [0.5, 0.5, 0.5])
        self.assertEqual((mesh.intersections == middle).sum(), 6)
        turned = {}
        for k in range(3):
            along = 0.3 * np.array([np.cos(np.pi * k / 3), np.sin(np.pi * k / 3), 0])
            turned[f"f{k}"] = [0.5 + s * along + [0, 0, z] for s, z in ((-1, -0.3), (1, -0.3), (1, 0.3), (-1, 0.3))]
        plan, mesh = self.expect(turned, {name: 0.36 for name in turned})
        length = np.linalg.norm(np.diff(mesh.points[mesh.intersections], axis=1), axis=2).sum()
        self.assertAlmostEqual(length, 0.6, 9)

    def test_polygon_that_is_not_convex(self):
        a = [[0.2, 0.2, 0.5], [0.8, 0.2, 0.5], [0.8, 0.8, 0.5], [0.5, 0.4, 0.5], [0.2, 0.8, 0.5]]
        self.expect({"a": a, "b": square_at(1, 0.6, 0.1, 0.9)}, {"a": 0.36 - 0.12, "b": 0.64})

    def test_ellipses(self):
        """An ellipse is a polygon with its area. Strike north and dip 90 degrees give a plane x = constant."""
        disc, steep = ([0.5, 0.5, 0.5], [0.3, 0.3], 0, 0, 0), ([0.5, 0.5, 0.5], [0.35, 0.2], 0, 90, 0)
        plan, mesh = self.expect({"a": disc, "b": steep, "c": square_at(1, 0.6, 0.3, 0.9)}, {"a": np.pi * 0.09, "b": np.pi * 0.07})
        y, x = (np.ptp(mesh.points[mesh.faces[mesh.face_owner == k]].reshape(-1, 3), axis=0) for k in (6, 7))
        self.assertLess(abs(x[0]), 1e-12)
        self.assertTrue(0.69 < x[1] < 0.72 and 0.39 < x[2] < 0.42, x)  # along the strike, along the dip

    def test_clipped(self):
        self.expect({"through": square_at(2, 0.4, -1, 2), "part": square_at(0, 0.5, 0.5, 1.5), "to the side": square_at(1, 0.3, 0, 0.5)},
                    {"through": 1, "part": 0.25, "to the side": 0.25})

    def test_polyhedron(self):
        """The domain is a prism with an L-shaped base."""
        flat = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)
        low, high = (np.column_stack([flat, np.full(6, z)]) for z in (0, 1))
        faces = {"floor": numbers(low), "roof": numbers(high)}
        for k in range(6):
            faces[f"wall {k}"] = numbers([low[k], low[(k + 1) % 6], high[(k + 1) % 6], high[k]])
        domain = {**CUBE, "lower corner": [], "upper corner": [], "faces": faces}
        x = np.random.default_rng(1).random((500, 3)) * [2.4, 2.4, 1.4] - 0.2
        inside = (x > 0).all(axis=1) & (x < [2, 2, 1]).all(axis=1) & ((x[:, :2] < 1).any(axis=1))
        self.assertTrue((network({"a": square_at(2, 0.5)}, domain).domain.contains(x) == inside).all())
        fracture = [[0.2, 1.8, 0.2], [1.8, 0.2, 0.2], [1.8, 0.2, 0.8], [0.2, 1.8, 0.8]]  # through the inner edge (1, 1)
        level = [[0.5, 0.5, 0.3], [1.8, 0.5, 0.3], [1.8, 1.5, 0.3], [0.5, 1.5, 0.3]]
        self.expect({"a": fracture, "b": level}, {"a": 0.6 * np.hypot(1.6, 1.6), "b": 1.3 - 0.8 * 0.5, "roof": 3}, domain)

    def test_regions(self):
        seam = {**CUBE, "upper corner": [1.0, 1.0, 0.5]}
        plan, mesh = self.expect({"on": square_at(2, 0.5), "b": square_at(0, 0.3)}, {"on": 0.36, "b": 0.36}, regions={"seam": seam})
        from conformity import sizes_of
        groups = {name: elements for _, name, elements, _ in groups_of(mesh, plan)}
        self.assertAlmostEqual(sizes_of(mesh.points, groups["seam"]).sum(), 0.5, 9)

    def test_fractures_that_cross_within_one_on_a_side_of_a_region(self):
        seam = {**CUBE, "upper corner": [1.0, 1.0, 0.5]}
        small = (square_at(0, 0.5) - 0.5) * [1, 0.5, 0.5] + 0.5  # the intersection ends inside the other fracture
        self.expect({"on": square_at(2, 0.5), "small": small}, {"on": 0.36, "small": 0.09}, regions={"seam": seam})

    def test_near_touches_are_joined_within_the_tolerance(self):
        short = square_at(0, 0.5) * [1, 1, 0.5] + [0, 0, 0.4005]  # 0.5 mm above the other
        plan, mesh = meshed(network({"a": square_at(2, 0.5), "b": short}, tolerance=1e-3))
        self.assertGreater(len(mesh.intersections), 0)
        self.assertIn('fracture "b" of "b" and fracture "a" of "a"', plan.repairs[0])
        self.assertEqual([d for d in defects(plan, mesh, 2e-3)], [])


class Refusals(unittest.TestCase):
    def refused(self, fractures, *words, domain=None, lines=1, **entries):
        with self.assertRaises(NetworkError) as caught:
            plan, mesh = meshed(network(fractures, domain, **entries))
            groups_of(mesh, plan)
        reported = str(caught.exception)
        for word in words:
            self.assertIn(word, reported)
        self.assertEqual(len(reported.splitlines()), lines, reported)

    def test_lines(self):
        a, both = [[0.2, 0.5], [0.8, 0.5]], ('fracture "a" of "a"', 'fracture "b" of "b"')
        self.refused({"a": a, "b": [[0.3, 0.5], [0.9, 0.5]]}, *both, "overlap; remove one")
        self.refused({"a": a, "b": a[::-1]}, *both, "are the same")
        self.refused({"a": a, "b": [[0.2, 0.5], [0.8, 0.51]]}, *both, "meet at 0.955 degrees")
        self.refused({"a": a, "b": [[0.2, 0.505], [0.5, 0.495], [0.8, 0.504]]}, *both, "meet at 1.91 degrees")  # and 1.72
        self.refused({"a": a, "b": [[0.5, 0.50005], [0.5, 0.9]]}, *both, "are 5e-05 m apart at (0.5, 0.5)", "minimum distance")
        self.refused({"a": a, "b": [[0.5, 0.49995], [0.5, 0.9]]}, *both, "are 5e-05 m apart")  # beyond it
        self.refused({"a": [[0, 0.2], [0, 0.8]]}, 'fracture "a" of "a": lies on side "west" of domain')
        self.refused({"a": [[1.2, 0.2], [1.5, 0.8]]}, 'fracture "a" of "a": lies outside')
        self.refused({"a": [[0.2, 0.2], [0.2, 0.2]], "b": [[0.1, 0.1], [0.5, 0.1], [0.5, 0.5], [0.2, 0.0]]}, "has no length", "crosses itself", lines=2)
        self.refused({"west": a}, "has the name of a side", domain=SQUARE)
        self.refused({"a": a}, "tolerance: is 0.5 m, must be at most a hundredth of the domain's diagonal, 0.0141421 m", tolerance=0.5)

    def test_lines_that_fold_back(self):
        parts, minimum = 'parts of fracture "a" of "a"', '"minimum distance" is 0.000141 m'
        self.refused({"a": [[0.1, 0.1], [0.9, 0.9], [0.1, 0.10001]]}, parts, "meet at 0.000358 degrees; the \"minimum angle\" is 2")
        self.refused({"a": [[0.1, 0.1], [0.9, 0.1], [0.9, 0.11], [0.1, 0.1]]}, parts, "meet at 0.716 degrees")  # closed end
        for end in ([0.1, 0.1001], [0.2, 0.1001], [0.3, 0.107]):  # close to the first segment
            self.refused({"a": [[0.1, 0.1], [0.9, 0.1], [0.9, 0.1001], end]}, parts, "are 0.0001", " m apart at (0.", "without meeting", minimum)
        self.refused({"a": [[0.1, 0.1], [0.9, 0.1], [0.9, 0.5], [0.5, 0.5], [0.5, 0.1001]]}, parts, "are 0.0001 m apart at (0.5, 0.1001)")

    def test_polygons_that_fold_back(self):
        parts, minimum = 'parts of fracture "a" of "a"', '"minimum distance" is 0.000173 m'
        corner = [[0.2, 0.2, 0.5], [0.8, 0.2, 0.5], [0.8, 0.21, 0.5]]
        self.refused({"a": corner}, parts, "meet at 0.955 degrees; the \"minimum angle\" is 2")
        neck = [[0.2, 0.2], [0.5, 0.4999], [0.8, 0.2], [0.8, 0.8], [0.5, 0.5], [0.2, 0.8]]
        self.refused({"a": [[x, y, 0.5] for x, y in neck]}, parts, "are 0.0001 m apart at (0.5, ", minimum)
        slit = [[0.2, 0.2], [0.8, 0.2], [0.8, 0.5], [0.4, 0.5], [0.4, 0.5001], [0.8, 0.5001], [0.8, 0.8], [0.2, 0.8]]
        self.refused({"a": [[x, y, 0.5] for x, y in slit]}, parts, "are 0.0001 m apart at (0.", minimum)

    def test_networks_that_are_too_dense(self):
        """Networks that are too dense are rejected before they need minutes or all memory."""
        import arrange
        fan = {f"f{k}": [[0.1, 0.1 + 0.01 * k], [0.9, 0.9 - 0.01 * k]] for k in range(60)}
        with mock.patch.object(arrange, "MAX_CROSSINGS", 1000):
            self.refused(fan, "too dense: fractures cross in 1770 points, at most 1000 are allowed", tolerance=1e-9)
        with mock.patch.object(arrange, "MAX_PAIRS", 2000):
            self.refused(fan, "too dense: more than 2000 pairs of its ", " edges may be closer than ", tolerance=1e-9, minimum_angle=0.0, minimum_distance=0.0)

    def test_what_is_no_fracture(self):
        far, square = {"lower corner": [2.0, 2.0], "upper corner": [3.0, 3.0], "corners": [], "faces": {}}, square_at(2, 0.5)
        self.refused({"a": [[0.2, 0.5], [0.8, 0.5]]}, "regions > seam: has no cell; it lies outside", regions={"seam": far})
        lines = {"c": {"lines": {"1": numbers([[2, 2], [3, 3]]), "2": numbers([[2, 3], [3, 4]])}}}
        self.refused({"a": [[0.2, 0.5], [0.8, 0.5]]}, 'constraint "1" of "c": lies outside', 'constraint "2" of "c": lies outside', constraints=lines, lines=2)
        polygons = {"c": {"polygons": {"1": numbers(square + 2), "2": numbers([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])}}}
        self.refused({"a": square}, 'constraint "1" of "c": lies outside', 'constraint "2" of "c": is not plane', constraints=polygons, lines=2)
        self.refused({"a": square}, "regions > seam: has no cell", regions={"seam": {**CUBE, "lower corner": [2.0] * 3, "upper corner": [3.0] * 3}})

    def test_advice_is_not_to_join_what_is_closer_than_the_tolerance(self):
        from checks import too_close
        plan = planned(network({"a": [[0.2, 0.5], [0.8, 0.5]]}, tolerance=1e-3))[0]
        self.assertIn("larger", too_close(plan, ("a", "b"), 2e-3, [0, 0]))
        self.assertNotIn("larger", too_close(plan, ("a", "b"), 1e-4, [0, 0]))

    def test_polygons(self):
        a, both = square_at(2, 0.5), ('fracture "a" of "a"', 'fracture "b" of "b"')
        self.refused({"a": a, "b": a + [0.1, 0.1, 0]}, *both, "overlap; remove one")
        self.refused({"a": a, "b": a[[1, 2, 3, 0]]}, *both, "are the same")
        self.refused({"a": a, "b": a + [[0, 0, -0.005], [0, 0, 0.005], [0, 0, 0.005], [0, 0, -0.005]]}, *both, "meet at 0.955 degrees")
        self.refused({"a": a, "b": square_at(0, 0.5, 0.3, 0.7) * [1, 1, 0.5] + [0, 0, 0.35005]}, *both, "are 5e-05 m apart")
        self.refused({"a": a, "b": [[0.80005, 0.5, 0.2], [0.80005, 0.6, 0.9], [0.9, 0.5, 0.9]]}, *both, "are 5e-05 m apart")  # edges
        self.refused({"a": square_at(2, 1.0)}, 'fracture "a" of "a": lies on side "top" of domain')
        self.refused({"a": a + [2, 0, 0]}, 'fracture "a" of "a": lies outside')
        bow = [[0.2, 0.2, 0.5], [0.8, 0.8, 0.5], [0.8, 0.2, 0.5], [0.2, 0.8, 0.5]]
        flat = [[0.2, 0.2, 0.5], [0.5, 0.2, 0.5], [0.8, 0.2, 0.5]]
        bent = [[0.2, 0.2, 0.5], [0.8, 0.2, 0.5], [0.8, 0.8, 0.6], [0.2, 0.8, 0.5]]
        self.refused({"a": bow, "b": flat, "c": bent}, 'fracture "a" of "a": crosses or touches itself', 'fracture "b" of "b": has no area',
                     'fracture "c" of "c": is not plane', lines=3)

    def test_bodies(self):
        faces = {name: numbers(x) for name, x in zip("abc", (square_at(0, 0.2), square_at(0, 0.8), square_at(1, 0.2)))}
        self.refused({"a": square_at(2, 0.5)}, "the faces are not closed", domain={**CUBE, "lower corner": [], "upper corner": [], "faces": faces})
        self.refused({"a": [[0.2, 0.2], [0.3, 0.3]]}, '"upper corner" must be above', domain={**SQUARE, "upper corner": [1.0, 0.0]})
        self.refused({"a": square_at(2, 0.5)}, "the domain has dimension 2; give lines", domain=SQUARE)


class Directions(unittest.TestCase):
    def test_strikes(self):
        strike, length = strikes([np.array([[0.0, 0], [0, 2], [1, 1]]), np.array([[3.0, 0], [0, 0]])])
        self.assertTrue(np.allclose(strike, [0, 135, 90]))
        self.assertTrue(np.allclose(length, [2, np.sqrt(2), 3]))

    def test_poles(self):
        """A plane with strike north dips to the east. Its downward pole points to the west."""
        trend, radius = poles([ellipse([0, 0, 0], [2, 1], strike, dip, 20) for strike, dip in ((0, 30), (90, 60), (200, 90 - 1e-7), (50, 0))])
        self.assertTrue(np.allclose((trend[:3] - [270, 0, 110] + 180) % 360, 180), trend)
        self.assertTrue(np.allclose(radius, np.sqrt(2) * np.sin(np.radians([15, 30, 45, 0])), atol=1e-6), radius)


class Random(unittest.TestCase):
    def random(self, domain, again=None, **entries):
        from domain import Body
        from generator import at_random
        given = {"number": 4000, "seed": 3, "shortest": 1.0, "longest": 10.0, "exponent": 2.5, "strike": 30.0, "dip": 60.0, "concentration": 20.0, "corners": 8}
        return np.array(at_random({**given, **entries}, Body("domain", domain, "boundary"), again))

    def test_lengths_follow_the_power_law(self):
        x = self.random(SQUARE)
        length = np.linalg.norm(x[:, 1] - x[:, 0], axis=1)
        self.assertTrue(1 <= length.min() and length.max() <= 10)
        for limit in (1.5, 3, 6):  # cumulative distribution
            exact = (1 - limit**-1.5) / (1 - 10**-1.5)
            self.assertAlmostEqual(np.mean(length < limit), exact, delta=4 * np.sqrt(exact * (1 - exact) / len(x)))

    def test_centres_and_directions(self):
        x = self.random(SQUARE)
        centre = x.mean(axis=1)
        self.assertTrue((abs(centre.mean(axis=0) - 0.5) < 4 * np.sqrt(1 / 12 / len(x))).all())
        angle = np.degrees(np.arctan2(*(x[:, 1] - x[:, 0]).T))
        self.assertAlmostEqual(angle.mean(), 30, delta=0.5)

    def test_directions_follow_von_mises_distribution(self):
        """The mean of cos(2 angle to the mean direction) is I1(kappa) / I0(kappa)."""
        t = np.linspace(0, np.pi, 20001)
        for kappa in (0.0, 2.0, 20.0):
            x = self.random(SQUARE, concentration=kappa)
            cosine = np.cos(2 * (np.arctan2(*(x[:, 1] - x[:, 0]).T) - np.radians(30)))
            density = np.exp(kappa * (np.cos(t) - 1))
            mean, square = (np.average(np.cos(t)**k, weights=density) for k in (1, 2))
            self.assertAlmostEqual(cosine.mean(), mean, delta=4 * np.sqrt((square - mean**2) / len(x)))

    def test_poles_follow_fishers_distribution(self):
        """The mean cosine of the angle to the mean pole is coth(kappa) - 1/kappa."""
        def spread(kappa):  # standard deviation of the cosine, with the variance 1/kappa^2 - 1/sinh(kappa)^2
            return np.sqrt(1 / kappa**2 - 1 / np.sinh(kappa)**2) if kappa else np.sqrt(1 / 3)
        for kappa in (0.0, 2.0, 20.0):
            x = self.random(CUBE, concentration=kappa)
            normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 1])
            normal /= np.linalg.norm(normal, axis=1)[:, None]
            pole = np.array([np.sin(np.pi / 3) * np.cos(np.pi / 6), -np.sin(np.pi / 3) * np.sin(np.pi / 6), np.cos(np.pi / 3)])
            exact = 1 / np.tanh(kappa) - 1 / kappa if kappa else 0
            self.assertAlmostEqual((normal @ pole).mean(), exact, delta=4 * spread(kappa) / np.sqrt(len(x)))
        self.assertAlmostEqual(np.linalg.norm(x[0, 0] - x[0, 4]), np.linalg.norm(x[0, 1] - x[0, 5]), 12)

    def test_the_seed_fixes_them(self):
        self.assertTrue((self.random(CUBE, number=5) == self.random(CUBE, number=5)).all())
        self.assertFalse((self.random(CUBE, number=5) == self.random(CUBE, number=5, seed=4)).any())

    def test_one_that_is_drawn_again_leaves_the_others(self):
        first, again, twice = (self.random(CUBE, number=5, again=again) for again in ({}, {2: 1}, {2: 2}))
        same = [(other == first).all(axis=(1, 2)).tolist() for other in (again, twice)]
        self.assertEqual(same, [[True, True, False, True, True]] * 2)
        self.assertFalse((again[2] == twice[2]).any())


if __name__ == "__main__":
    unittest.main(argv=["mesh_test.py"])
