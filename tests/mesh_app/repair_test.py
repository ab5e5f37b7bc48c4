#!/usr/bin/env python3
"""Repairs of networks: repair_test.py PROGRAM ROOT MPIEXEC"""
import csv
import importlib.util
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
from conformity import CUBE, DEFAULTS, SQUARE, Network, as_xml, defects, numbers, sizes_of  # noqa: E402
from mesh_program import MeshTest, app  # noqa: E402
from program import main  # noqa: E402

from arrange import closest, near_pairs  # noqa: E402
from report import gamma  # noqa: E402
from shapes import ellipse  # noqa: E402


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
        self.assertEqual(max(entry.moved for entry in journal.entries.values()), 0)
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
        rows = list(csv.DictReader(open(self.folder / "net.msh.csv")))
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
