#!/usr/bin/env python3
"""Repairs of networks: repair_test.py PROGRAM ROOT MPIEXEC"""
import contextlib
import csv
import importlib.util
import io
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
from conformity import CUBE, DEFAULTS, SQUARE, Network, Plan, Sizes, as_xml, defects, numbers, sizes_of  # noqa: E402
from mesh_program import MeshTest, app  # noqa: E402
from program import main  # noqa: E402

import estimate  # noqa: E402
import mesher  # noqa: E402
import plan as plan_module  # noqa: E402
import surface_mesh  # noqa: E402
from arrange import closest, near_pairs, on_segment  # noqa: E402
from discs import corners_for  # noqa: E402
from improve import improve  # noqa: E402
from mesher import Mesh  # noqa: E402
from report import gamma  # noqa: E402
from shapes import NetworkError, ellipse  # noqa: E402
from size_grid import SizeGrid  # noqa: E402
from surface_mesh import SurfaceMesh, bisected, edges_of, edges_to_split, folded, shared  # noqa: E402


def repaired(fractures, policy="join", **entries):
    """Returns plan, mesh and journal of {name: points}, in one set."""
    plane = np.shape(next(iter(fractures.values())))[1] == 2
    one = {"lines" if plane else "polygons": {name: numbers(points) for name, points in fractures.items()}}
    described = {**DEFAULTS, "domain": SQUARE if plane else CUBE, "fractures": {"set": one}, "repair": policy,
                 **{key.replace("_", " "): value for key, value in entries.items()}}
    text = as_xml("network", described)
    plan, _, mesh = app.made_of(text, Network(text))
    plan.network.journal.compare(mesh, plan)
    return plan, mesh, plan.network.journal


def smallest_distance(plan):
    """Returns the smallest length of edges, and distance of edges without a common point."""
    x, ends = plan.graph.segments(), np.array(list(plan.edges))
    i, j = near_pairs(x.min(axis=1), x.max(axis=1), 2 * plan.network.tolerance)
    apart = (ends[i][:, :, None] != ends[j][:, None, :]).all(axis=(1, 2))
    return np.linalg.norm(x[:, 1] - x[:, 0], axis=1).min(), closest(x[i[apart]], x[j[apart]])[2].min(initial=np.inf)


def random_map(n, seed):
    """Returns traces of a square with gaps, near duplicates, short pieces and small angles."""
    random = np.random.default_rng(seed)
    found = {}
    for k in range(n):
        angle = np.radians(random.choice([20, 75, 140]) + random.normal(0, 10))
        half = 0.5 * min(0.05 * random.random() ** -0.8, 0.5) * np.array([np.sin(angle), np.cos(angle)])
        centre = random.uniform(-0.02, 1.02, 2)
        if k % 4 == 1:  # begins at a gap from the previous trace
            centre = found[f"f{k - 1}"][1] + half + random.normal(0, 1e-3, 2)
        found[f"f{k}"] = np.array([centre - half, centre + half])
        if k % 10 == 9:
            found[f"f{k}"] = found[f"f{k - 1}"] + random.normal(0, 2e-4, (2, 2))
    return found


class OneSize:
    """Sizes for a SizeGrid: a single small one at the middle of the domain."""

    def __init__(self, net):
        self.network = net
        self.points, self.sizes = np.array([[*(0.5 * (net.domain.low + net.domain.high)), 0.0]])[:, :3], np.array([0.1])

    def expected_cells(self):
        return {"size": 1e3}


class Cells(unittest.TestCase):
    def test_sizes_cover_the_domain(self):
        """The grid of sizes exceeds the domain by a cell, since gmsh reads invalid numbers outside of the grid."""
        for dim in (2, 3):
            with self.subTest(dim), tempfile.NamedTemporaryFile(mode="r") as file:
                net = Network(as_xml("network", {**DEFAULTS, "domain": SQUARE if dim == 2 else CUBE, "fractures": {}}))
                net.domain.low, net.domain.high = net.domain.low + 4e5, net.domain.high + 4e5
                origin = np.append(net.domain.low, 0.0)[:3]
                SizeGrid(OneSize(net)).write(file.name, origin)
                low, spacing = np.fromfile(file.name, count=6).reshape(2, 3)
                counts = np.fromfile(file.name, np.int32, count=3, offset=48)
                self.assertEqual(Path(file.name).stat().st_size, 60 + 8 * np.prod(counts))
                self.assertTrue((low <= -0.99 * spacing).all())
                self.assertTrue((low + spacing * (counts - 1) >= np.append(np.ones(dim), 0.0)[:3] + 0.99 * spacing).all())

    def test_nodes_of_bad_cells_move(self):
        """A node near a fracture in 2D moves away; the fracture stays straight with its tips, constraints stay."""
        x = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.2, 0.5], [0.5, 0.5], [0.8, 0.5], [0.5, 0.502]])
        points = np.column_stack([x, np.zeros(len(x))])
        cells = np.array([[0, 1, 5], [0, 5, 4], [1, 6, 5], [0, 4, 3], [1, 2, 6], [4, 5, 7], [5, 6, 7], [4, 7, 3], [7, 6, 2], [7, 2, 3]])
        faces = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6]])
        for fixed in ([], [5, 7]):
            mesh = Mesh(points.copy(), cells, faces, np.array([0, 1, 2, 3, 4, 4]), np.zeros((0, 1), int), np.array(fixed, int))
            before = gamma(mesh.points, cells)[0].min()
            self.assertEqual(improve(mesh) > 0, not fixed)
            after, area = gamma(mesh.points, cells)
            self.assertAlmostEqual(area.sum(), 1, 12)
            self.assertTrue(np.allclose(mesh.points[[4, 5, 6], 1], 0.5, atol=1e-15))
            self.assertTrue((mesh.points[[0, 1, 2, 3, 4, 6]] == points[[0, 1, 2, 3, 4, 6]]).all())
            self.assertLess(before, 0.02)
            (self.assertEqual if fixed else self.assertGreater)(after.min(), before if fixed else 0.08)

    def test_bisection(self):
        """Three triangulated squares with a common side: marked triangles lose their longest edge, all areas are covered, and
        no node lies inside an edge."""
        n, random = 6, np.random.default_rng(3)
        i, j = np.divmod(np.arange(n * (n - 1)), n - 1)
        i, j = i[i < n - 1], j[i < n - 1]
        one = np.concatenate([np.stack([i * n + j, (i + 1) * n + j, i * n + j + 1], axis=1),
                              np.stack([(i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1], axis=1)])
        flat = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), axis=-1).reshape(-1, 2) + 0.2 * random.random((n * n, 2))
        flat[:n, 0] = 0
        points, triangles, face = [], [], []
        for k, angle in enumerate((0.0, 1.0, 2.5)):
            points.append(np.stack([flat[:, 0] * np.cos(angle), flat[:, 0] * np.sin(angle), flat[:, 1]], axis=1))
            triangles.append(np.where(one < n, one, one + k * n * n))
            face += [k] * len(one)
        points, triangles, face = np.concatenate(points), np.concatenate(triangles), np.array(face)
        self.assertFalse(folded(points, triangles, face).any())
        for _ in range(3):
            marked = random.random(len(triangles)) < 0.1
            edges, of, longest, chosen = edges_to_split(points, triangles, marked)
            self.assertTrue(chosen[of[np.arange(len(of)), longest]][marked].all())
            middle = np.full(len(edges), -1)
            middle[chosen] = len(points) + np.arange(chosen.sum())
            points = np.concatenate([points, points[edges[chosen]].mean(axis=1)])
            parts, parents = bisected(triangles, of, longest, middle)
            before, after = sizes_of(points, triangles), sizes_of(points, parts)
            self.assertTrue(np.allclose(np.bincount(parents, after, len(triangles)), before, rtol=1e-12))
            triangles, face = parts, face[parents]
            ends, _ = edges_of(triangles, len(points))
            for node in np.unique(triangles):
                t, gap = on_segment(np.broadcast_to(points[node], (len(ends), 3)), points[ends[:, 0]], points[ends[:, 1]])
                self.assertGreater(gap[(t > 0) & (t < 1)].min(), 1e-6)
        self.assertEqual(shared(triangles), [])

    def test_folded_and_shared_triangles(self):
        """Triangles of two faces at a common edge: found below one degree; triangles with the same corners form a group."""
        for angle, found in ((0.9, True), (1.1, False)):
            a = np.radians(angle)
            points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.6, 0.8 * np.cos(a), 0.8 * np.sin(a)]])
            triangles, face = np.array([[0, 1, 2], [1, 0, 3]]), np.array([0, 1])
            self.assertEqual(folded(points, triangles, face).tolist(), [found] * 2)
            self.assertFalse(folded(points, triangles, np.zeros(2, int)).any())
        self.assertEqual(shared(np.array([[0, 1, 2], [3, 1, 2], [2, 0, 1], [1, 2, 3]])), [[0, 2], [1, 3]])

    def test_corners_of_discs(self):
        """Sides of discs have a whole number of edges of the required length, at most 16 sides."""
        for relative_size in (0.02, 0.05, 0.1, 0.2, 0.25, 0.5):
            n = corners_for(relative_size)
            edges = np.sin(np.pi / n) / relative_size
            self.assertLessEqual(n, 16)
            self.assertGreater(edges, 0.9 * np.ceil(edges))
        self.assertEqual([corners_for(size) for size in (0.1, 0.25, 0.9)], [16, 13, 6])
        disc = {"centre": [0.5] * 3, "radii": [0.2, 0.2], "strike": 0.0, "dip": 0.0, "rake": 0.0}
        for policy, entries, n in (("report", {}, 32), ("join", {}, corners_for(0.3)), ("join", {"corners": 9}, 9)):
            fractures = {"set": {"ellipses": {"one": disc}, **entries}}
            net = Network(as_xml("network", {**DEFAULTS, "domain": CUBE, "fractures": fractures, "repair": policy}))
            self.assertEqual(len(net.fractures[0].points), n)


class Traces(unittest.TestCase):
    TOLERANCE = 4e-3

    def joined(self, fractures, **entries):
        plan, mesh, journal = repaired(fractures, tolerance=self.TOLERANCE, **entries)
        return plan, mesh, {name.split('"')[1]: entry for name, entry in journal.entries.items()}

    def test_gap_closes_onto_the_line(self):
        plan, mesh, entries = self.joined({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.497]]})
        self.assertEqual(len(mesh.intersections), 1)
        self.assertTrue(np.allclose(mesh.points[mesh.intersections[0, 0]], [0.5, 0.5, 0], atol=1e-12))
        self.assertAlmostEqual(entries["b"].meshed, 0.3, 12)
        self.assertAlmostEqual(entries["b"].moved, 0.003, 12)
        self.assertEqual(entries["a"].moved, 0)

    def test_overshoot_is_cut(self):
        _, _, entries = self.joined({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.503]]})
        self.assertAlmostEqual(entries["b"].meshed, 0.3, 3)

    def test_small_angle_opens(self):
        """Lines at 1.5 degrees share a part. No point moves by more than 1.3 tolerances."""
        far = 0.6 * np.array([np.cos(np.radians(1.5)), np.sin(np.radians(1.5))])
        plan, mesh, entries = self.joined({"a": [[0.1, 0.5], [0.9, 0.5]], "b": [[0.1, 0.5], [0.1, 0.5] + far]})
        angle = smallest_angle(plan)
        self.assertGreater(angle, 2)
        self.assertLess(entries["b"].moved, 1.3 * self.TOLERANCE)
        self.assertIn("are joined with", entries["b"].notes[0])
        self.assertAlmostEqual(entries["a"].meshed, 0.8, 6)

    def test_useless_traces_are_left_out(self):
        given = {"a": [[0.2, 0.5], [0.8, 0.5]], "same": [[0.2, 0.5], [0.8, 0.5]], "short": [[0.5, 0.2], [0.502, 0.2]],
                 "outside": [[1.2, 0.2], [1.5, 0.2]], "side": [[0, 0.2], [0, 0.6]], "c": [[0.5, 0.9], [0.5, 1.3]]}
        plan, mesh, journal = repaired(given, tolerance=self.TOLERANCE)
        reasons = {name.split('"')[1]: entry.reason for name, entry in journal.entries.items()}
        self.assertEqual(reasons, {"a": "", "same": "duplicate", "short": "short", "outside": "outside", "side": "duplicate", "c": ""})
        line, = journal.lines(2)
        self.assertIn("lines: 6 fractures, length 2.302 m, in the mesh 0.7 m; 0 joined; 4 left out", line)

    def test_maps(self):
        """The graph of a map has no distance below the tolerance, no small angle, and nearly the length of the map."""
        for seed in range(3):
            with self.subTest(seed):
                plan, mesh, journal = repaired(random_map(60, seed), tolerance=self.TOLERANCE)
                shortest, gap = smallest_distance(plan)
                self.assertGreaterEqual(shortest, 0.999 * self.TOLERANCE)
                self.assertGreaterEqual(gap, 0.5 * self.TOLERANCE)
                self.assertGreaterEqual(smallest_angle(plan), 2)
                self.assertEqual([line for line in defects(plan, mesh) if "plane" not in line and "crosses" not in line], [])
                self.assertGreater(gamma(mesh.points, mesh.cells)[0].min(), 0.02)
                self.assertLess(max(entry.moved for entry in journal.entries.values()), 3 * self.TOLERANCE)

    def test_drop_moves_nothing(self):
        given = {"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.4999]], "c": [[0.2, 0.1], [0.8, 0.1]],
                 "d": [[0.3, 0.2], [0.3, 0.4]]}
        plan, mesh, journal = repaired(given, "drop", tolerance=1e-5, minimum_distance=1e-3)
        self.assertEqual([e.feature.single for e in journal.entries.values() if e.reason == "conflict"], ["set b"])
        self.assertLess(max(entry.moved for entry in journal.entries.values()), 1e-15)
        self.assertEqual(defects(plan, mesh), [])


def smallest_angle(plan):
    """Returns the smallest angle, in degrees, between edges at a point."""
    star, least = {}, 180.0
    for a, b in plan.edges:
        along = (plan.points[b] - plan.points[a])[:2]
        star.setdefault(a, []).append(along / np.linalg.norm(along))
        star.setdefault(b, []).append(-along / np.linalg.norm(along))
    for rays in star.values():
        cosine = np.array(rays) @ np.array(rays).T - 2 * np.eye(len(rays))
        least = min(least, np.degrees(np.arccos(np.clip(cosine.max(), -1, 1))))
    return least


class Surfaces(unittest.TestCase):
    def square(self, axis, place, low=0.2, high=0.8):
        return np.insert(np.array([[low, low], [high, low], [high, high], [low, high]], float), axis, place, axis=1)

    def test_near_miss_becomes_a_contact(self):
        """A square ends 0.003 before another one; its rim moves onto the other within its own plane."""
        other = np.array([[0.3, 0.503, 0.3], [0.7, 0.503, 0.3], [0.7, 0.503, 0.7], [0.3, 0.503, 0.7]])
        wall = np.array([[0.5, 0.2, 0.35], [0.5, 0.5, 0.35], [0.5, 0.5, 0.65], [0.5, 0.2, 0.65]])
        plan, mesh, journal = repaired({"a": other, "b": wall}, tolerance=0.01)
        length = sizes_of(mesh.points, mesh.intersections).sum()
        self.assertAlmostEqual(length, 0.3, 9)
        moved = {name.split('"')[1]: entry.moved for name, entry in journal.entries.items()}
        self.assertAlmostEqual(moved["b"], 0.003, 9)
        self.assertLess(moved["a"], 1e-12)
        self.assertEqual(defects(plan, mesh), [])

    def test_corner_near_a_surface_becomes_a_contact(self):
        """The corner of a triangle moves onto a square within the plane of the triangle."""
        corner = np.array([[0.5, 0.5, 0.506], [0.7, 0.5, 0.8], [0.3, 0.5, 0.8]])
        plan, mesh, journal = repaired({"a": self.square(2, 0.5), "b": corner}, tolerance=0.01)
        moved = {name.split('"')[1]: entry.moved for name, entry in journal.entries.items()}
        self.assertAlmostEqual(moved["b"], 0.006, 9)
        self.assertLess(moved["a"], 1e-12)
        self.assertTrue((np.linalg.norm(mesh.points - [0.5, 0.5, 0.5], axis=1) < 1e-9).any())
        self.assertEqual(defects(plan, mesh), [])

    def test_poking_corner_is_cut(self):
        wall = np.array([[0.5, 0.2, 0.35], [0.5, 0.506, 0.35], [0.5, 0.506, 0.65], [0.5, 0.2, 0.65]])
        plan, mesh, journal = repaired({"a": self.square(1, 0.5), "b": wall}, tolerance=0.01)
        area = {name.split('"')[1]: entry.meshed for name, entry in journal.entries.items()}
        self.assertAlmostEqual(area["b"], 0.09, 9)
        self.assertGreater(gamma(mesh.points, mesh.cells)[0].min(), 0.05)

    def test_parallel_surfaces_leave_out_the_smaller(self):
        plan, mesh, journal = repaired({"a": self.square(2, 0.5), "b": self.square(2, 0.504, 0.3, 0.6)}, tolerance=0.01)
        reasons = {name.split('"')[1]: entry.reason for name, entry in journal.entries.items()}
        self.assertEqual(reasons, {"a": "", "b": "conflict"})

    def test_random_discs(self):
        """Thirty discs: conforming mesh, the volume of the domain, good cells, and bounded movements."""
        random = np.random.default_rng(7)
        discs = {f"d{k}": ellipse(random.uniform(0.1, 0.9, 3), [r, r], random.normal(30, 15), random.uniform(50, 90), 0, 10)
                 for k, r in enumerate(random.uniform(0.1, 0.3, 30))}
        plan, mesh, journal = repaired(discs, tolerance=4e-3, size=0.12, size_at_tips=0.12)
        found = [line for line in defects(plan, mesh, 2 * 4e-3) if "crosses" not in line]
        self.assertEqual(found, [])
        self.assertGreater(gamma(mesh.points, mesh.cells)[0].min(), 0.02)
        self.assertLess(max(e.moved for e in journal.entries.values()), 3 * 4e-3)
        kept = [e for e in journal.entries.values() if not e.reason]
        self.assertGreaterEqual(len(kept), 27)

    def test_estimate_before_intersections(self):
        """The estimate without intersections is within 1.5 times the cells; limits of cells and memory are errors."""
        random = np.random.default_rng(8)
        discs = {f"d{k}": ellipse(random.uniform(0.1, 0.9, 3), [r, r], random.normal(30, 15), random.uniform(50, 90), 0, 10)
                 for k, r in enumerate(random.uniform(0.1, 0.2, 20))}
        plan, mesh, _ = repaired(discs, tolerance=4e-3, size=0.12)
        net = plan.network
        cells = SizeGrid(estimate.Points(net)).expected_cells()
        self.assertLess(abs(np.log(len(mesh.cells) / cells)), np.log(1.5))
        with mock.patch.object(estimate, "MANY", 1), contextlib.redirect_stderr(io.StringIO()) as printed:
            estimate.check(net)
            self.assertRegex(printed.getvalue(), r"20 fractures require about \S+ cells, \S+ GB of memory and \S+ s for each attempt")
            net.maximum_cells = 1000
            with self.assertRaisesRegex(NetworkError, "20 fractures require about .*; \"maximum cells\" is 1000; choose larger cells"):
                estimate.check(net)
            net.maximum_cells = 10**7
            with mock.patch.object(estimate, "CELL_BYTES", 1e12), self.assertRaisesRegex(NetworkError, r"this machine has \S+ GB; choose"):
                estimate.check(net)

    def test_shared_triangles_remain_in_one_fracture(self):
        """Two discs at 15 degrees, whose repaired faces share a triangle: it remains in the larger disc."""
        side = 1000 * 0.3 ** (1 / 3)
        discs = {name: ellipse(np.array(x) / side, [r / side] * 2, direction - 90, dip, 0, 13) for name, x, r, direction, dip in (
            ("small", (502.34, 384.57, 413.22), 140.90, 76.50, 2.94), ("large", (555.20, 333.42, 463.59), 157.20, 244.32, 17.72))}
        plan, mesh, journal = repaired(discs, tolerance=1.1594919682632563 / side, relative_size=0.25)
        ((lost, kept), area), = mesh.joined.items()
        self.assertEqual([plan.owners[k].single for k in (lost, kept)], ["set small", "set large"])
        self.assertEqual(defects(plan, mesh, 2 * plan.network.tolerance), [])
        small, large = sorted(journal.entries.values(), key=lambda entry: entry.given)
        self.assertGreater(small.given - small.meshed, 0)
        self.assertEqual(small.notes, [f'{area:.3g} m^2 are joined with fracture "large" of "set"'])
        self.assertEqual(large.notes, [])

    def test_changes_of_triangles_in_gmsh(self):
        """Bisected triangles, and triangles removed beside a cell: the cells of gmsh conform, areas add up."""
        far = np.array([np.cos(np.radians(30)), 0, np.sin(np.radians(30))])
        flap = np.array([[0.3, 0.35, 0.5], [0.3, 0.65, 0.5], [0.3, 0.65, 0.5] + 0.4 * far, [0.3, 0.35, 0.5] + 0.4 * far])
        sets = {"set": {"polygons": {"a": numbers(self.square(2, 0.5)), "b": numbers(flap)}}}
        plan = Plan(Network(as_xml("network", {**DEFAULTS, "domain": CUBE, "fractures": sets, "repair": "join"})))
        sizes, flat, small = Sizes(plan), len(plan.owners) - 2, len(plan.owners) - 1
        mesher.gmsh.initialize(readConfigFiles=False)
        try:
            mesher.gmsh.option.setNumber("General.Terminal", 0)
            model = mesher.Model(plan, np.zeros(3))
            with tempfile.TemporaryDirectory() as folder:
                mesher.set_sizes(sizes, model.origin, folder)
                model.generate(2)
                surfaces = SurfaceMesh(model)
                owner, before = surfaces.owners(), len(surfaces.triangles)
                common = np.intersect1d(surfaces.triangles[owner == flat], surfaces.triangles[owner == small])
                marked = np.isin(surfaces.triangles, common).any(axis=1)
                mesher.bisect(surfaces, marked, sizes, folder)
                self.assertGreater(len(surfaces.triangles), before + marked.sum())
                model.generate(3)
                self.assertEqual(defects(plan, model.mesh(sizes)), [])
                surfaces = SurfaceMesh(model)
                owner, area = surfaces.owners(), surfaces.areas()
                whole, common = area[owner == small].sum(), np.unique(surfaces.triangles[owner == flat])
                edge = next(x for x in surfaces.triangles[owner == small] if np.isin(x, common).sum() == 2)
                cell = surfaces.tag[[[*edge, edge[0]]]]
                with mock.patch.object(surface_mesh, "MAX_REMOVED", 0.5):
                    self.assertEqual(surfaces.without_narrow(cell, {(small, flat): 0.49 * whole}), {})
                    ((pair, lost),) = surfaces.without_narrow(cell, {}).items()
                model.generate(3)
                mesh = model.mesh(sizes)
        finally:
            mesher.gmsh.finalize()
        self.assertEqual(pair, (small, flat))
        self.assertEqual([line for line in defects(plan, mesh) if "crosses" not in line], [])
        self.assertAlmostEqual(sizes_of(mesh.points, mesh.faces[mesh.face_owner == small]).sum() + lost, whole, 9)
        self.assertAlmostEqual(whole, 0.12, 9)

    def test_movements_are_bounded(self):
        """A fracture that joining moves by more than two tolerances, one with `drop`, is left out."""
        wall = np.array([[0.5, 0.2, 0.35], [0.5, 0.497, 0.35], [0.5, 0.497, 0.65], [0.5, 0.2, 0.65]])
        for limit, left in ((0.2, {"set b"}), (2.0, set())):
            with mock.patch.dict(plan_module.MAX_MOVED, {"join": limit}):
                _, _, journal = repaired({"a": self.square(1, 0.5), "b": wall}, tolerance=0.01)
            self.assertEqual({entry.feature.single for entry in journal.entries.values() if entry.reason}, left)
        # Ends in a row, each within the tolerance of the next: all merge, which moves the last one by 2.4 tolerances.
        ends = np.array([[0.5, 0.5], [0.508, 0.5], [0.516, 0.5], [0.524, 0.5]])
        chain = {f"t{k}": [end, end + 0.3 * np.array(along)] for k, (end, along) in enumerate(zip(ends, ((-1, 0), (0, 1), (0, -1), (1, 0))))}
        for limit, moved in ((1.0, 0.008), (3.0, 0.024)):
            with mock.patch.dict(plan_module.MAX_MOVED, {"drop": limit}):
                _, _, journal = repaired(chain, "drop", tolerance=0.01, minimum_distance=1e-3)
            self.assertAlmostEqual(max(entry.moved for entry in journal.entries.values()), moved, 9)

    def test_graph_is_flat(self):
        """A point on two planes that are not parallel lies on both after the repair."""
        plan, _, _ = repaired({"a": self.square(0, 0.5), "b": self.square(1, 0.5), "c": self.square(2, 0.503, 0.2, 0.505)}, tolerance=0.01)
        for edge, of in plan.edges.items():
            for k in of:
                self.assertLess(abs(plan.surfaces[k].plane.height(plan.points[list(edge)])).max(), 1e-9)


class Program(MeshTest):
    def test_files_and_table(self):
        """The program reads the entries, prints a line for the file and writes the table of fractures."""
        self.write("discs.csv", "id;Radius [cm];x [m];Y;depth;dip (deg);dip direction;aperture [mm]", "1;30;0,5;0,5;-0,5;90;90;0,2",
                   "2;20;0,5;0,502;-0,5;90;91;0,1", "3;20;5;5;-5;90;0;0,1", "4;20;0,3;0,3;-0,5;30;0;")
        scene = self.scene(dim=3, fractures={"set": {"file": "discs.csv", "corners": 8}}, repair="join", relative_size=0.3,
                           domain={"lower corner": [0.0] * 3, "upper corner": [1.0] * 3})
        printed = self.mesh(scene)
        self.assertIn("discs.csv: 4 fractures, area 0.659734 m^2, in the mesh", printed)
        rows = list(csv.DictReader((self.folder / "net.msh.csv").read_text().splitlines()))
        self.assertEqual([row["state"] for row in rows], ["kept", "left out", "left out", "kept"])
        self.assertAlmostEqual(float(rows[0]["area in the mesh [m^2]"]), np.pi * 0.09, 6)

    @unittest.skipUnless(importlib.util.find_spec("meshio"), "requires python3-meshio")
    def test_mesh_in_vtu(self):
        """Two triangles in two regions and a fracture between them, written by meshio, become groups of gmsh."""
        import meshio
        points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
        cells = [("triangle", np.array([[0, 1, 2], [0, 2, 3]])), ("line", np.array([[0, 2]]))]
        meshio.Mesh(points, cells, cell_data={"region": [np.array([1, 2]), np.array([5])]}).write(self.folder / "a.vtu")
        self.assertIn("region 1, region 2, faces 5, west, east, south, north", self.mesh(self.folder / "a.vtu", output="a.msh"))
        found = self.call("mesh-info", "a.msh", "--fractures", "faces 5")[0]
        for name in ("region 1", "region 2", "faces 5", "west", "north"):
            self.assertIn(name, found)

    def test_surface_files(self):
        """Polygons of dfnWorks and triangles of GOCAD become fractures; errors name line, column and value."""
        box = {"domain": {"lower corner": [0.0] * 3, "upper corner": [1.0] * 3}, "relative_size": 0.5}
        self.write("polygons.dat", "nPolygons: 2", "4 {0.2, 0.2, 0.5} {0.8, 0.2, 0.5} {0.8, 0.8, 0.5} {0.2, 0.8, 0.5}",
                   "3 {0.2, 0.5, 0.2} {0.8, 0.5, 0.2} {0.5, 0.5, 0.8}")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "polygons.dat"}}, **box))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], 0.36 + 0.18, 9)
        self.write("polygons.dat", "4 {0.2, 0.2, 0.5} {0.8, 0.2, x} {0.8, 0.8, 0.5} {0.2, 0.8, 0.5}")
        reported = self.mesh(self.scene(dim=3, fractures={"set": {"file": "polygons.dat"}}, **box), expect=1)
        self.assertIn('polygons.dat: line 1: "x" in column 7 is not a number', reported)
        surface = ["GOCAD TSurf 1", "HEADER {", "name:north fault", "}", "ZPOSITIVE Depth", "TFACE", "VRTX 1 0.2 0.2 -0.5",
                   "VRTX 2 0.8 0.2 -0.5", "VRTX 3 0.8 0.8 -0.5", "PVRTX 4 0.2 0.8 -0.5 7", "TRGL 1 2 3", "TRGL 1 3 4", "END"]
        self.write("fault.ts", *surface)
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "fault.ts"}}, **box))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], 0.36, 9)
        self.assertIn(b'"north fault"', (self.folder / "net.msh").read_bytes())
        self.write("fault.ts", *surface[:-2], "TRGL 1 3 9", "END")
        reported = self.mesh(self.scene(dim=3, fractures={"set": {"file": "fault.ts"}}, **box), expect=1)
        self.assertIn("fault.ts: line 12: refers to the vertex 9, which is not defined above", reported)

    def test_window(self):
        self.write("net.csv", "1,0.2,0.5,0.8,0.5", "2,0.1,0.9,0.2,0.9")
        scene = self.scene(fractures={"set": {"file": "net.csv", "window": [0.3, 0.3, 0.7, 0.7]}}, relative_size=0.5)
        self.mesh(scene)
        self.assertAlmostEqual(self.report()["sets"]["set"]["length"], 0.4, 9)

    def test_wrong_discs(self):
        for titles, row, why in (
                ("x,y,z,dip,dip direction,radius", "0,0,0,95,0,1", "line 2: column 4: the dip is 95; allowed are values from 0 to 90 degrees"),
                ("x,y,z,dip,dip direction,radius", "0,0,0,45,0,-1", "line 2: column 6: the radius is -1; allowed are values above 0"),
                ("x,y,z,dip,dip direction,radius", "0,0,0,45,north,1", 'line 2: "north" in column 5 is not a number'),
                ("x,y,z,dip,dip direction,radius [yd]", "0,0,0,45,0,1", 'line 1: column 6, "radius", has the unit "yd"; allowed are m, km'),
                ("x,y,z,dip,radius", "0,0,0,45,1", "line 1: the titles of discs lack dip and dip direction or dip and strike")):
            self.write("discs.csv", titles, row)
            reported = self.mesh(self.scene(dim=3, fractures={"set": {"file": "discs.csv"}},
                                            domain={"lower corner": [0.0] * 3, "upper corner": [1.0] * 3}), expect=1)
            self.assertIn(why, reported)


if __name__ == "__main__":
    main()
