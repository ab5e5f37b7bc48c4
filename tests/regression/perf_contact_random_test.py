#!/usr/bin/env python3
"""Random scenes of perf/contact: perf_contact_random_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy, SciPy, VTK or gmsh.

Tests limit analysis with known limit loads, equal scenes for equal seeds, and the criteria for failures."""
import io
import json
import math
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

import program
from program import ROOT, ProgramTest, main

try:
    import gmsh  # noqa: F401
    import numpy as np
    import violation
    from perf.common import scene_file
    from perf.contact import contact, limit_analysis, random_run, random_scenes, rigid_pieces
    from perf.contact.scenes import Scene
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

SOUTH, NORTH, WEST, EAST = ({"boundary": side, "displacement": [0.0, 0.0]} for side in ("south", "north", "west", "east"))


def read(tree):
    """Returns the scene as read from a file."""
    return violation.Input(io.StringIO(xml.tostring(scene_file.section("Sprekk", tree), encoding="unicode")))


def scene(mesh, friction, conditions, bulk=None, **fracture):
    joint = {"type": "joint", "friction coefficient": friction}
    rock = {"type": "elastic", "Young's modulus": 1.0, "Poisson's ratio": 0.25}
    return read({"Mesh": mesh, "Materials": {"rock": rock, "joint": joint}, "Bulk": {"body force": bulk or [0.0, -1.0]},
                 "Fractures": {name: {"material": "joint", **fracture} for name in mesh["fractures"]},
                 "Boundary conditions": {str(k): condition for k, condition in enumerate(conditions)}})


def box(high, cells, *fractures, cell="quadrilateral", **more):
    corners = {f"f{k}": {"lower corner": lower, "upper corner": upper} for k, (lower, upper) in enumerate(fractures)}
    return {"cell": cell, "lower corner": [0.0] * len(high), "upper corner": high, "cells": cells, "fractures": corners, **more}


def stands(input_, time=0):
    return limit_analysis.admissible(input_, rigid_pieces.box(input_), time)


class LimitAnalysis(unittest.TestCase):
    def incline(self, angle, friction, height=1.2, **more):
        """Returns whether a block of length 2 on an inclined base stands."""
        mesh = box([2.0, height], [8, 2], ([0.0, height / 2], [2.0, height / 2]), rotation=angle)
        return stands(scene(mesh, friction, [SOUTH], **more))

    def test_a_block_on_a_slope_slides_beyond_the_angle_of_friction(self):
        for angle in (10, -25, 40):
            limit = math.tan(math.radians(abs(angle)))
            self.assertTrue(self.incline(angle, 1.001 * limit))
            self.assertFalse(self.incline(angle, 0.999 * limit))

    def test_a_slender_block_falls_over(self):
        """A slender block topples about the centre of the outermost face, at 7/8 of half its length."""
        limit = 2 * math.degrees(math.atan(1))  # height of a block that topples at 45 degrees: 7/8 * 2
        self.assertTrue(self.incline(limit / 2, 2, height=2 * 0.999 * 7 / 4))
        self.assertFalse(self.incline(limit / 2, 2, height=2 * 1.001 * 7 / 4))

    def test_slopes_in_space(self):
        """The friction cone has 32 edges on it. Between them the friction is smaller by up to 1 - cos(pi/32)."""
        for cell, faces in (("hexahedron", 4), ("tetrahedron", 8)):
            for turn in (0, 33):
                axis = [math.cos(math.radians(turn)), math.sin(math.radians(turn)), 0.0]
                mesh = box([2.0, 2.0, 1.0], [2, 2, 2], ([0.0, 0.0, 0.5], [2.0, 2.0, 0.5]), cell=cell, rotation=20.0)
                mesh["rotation axis"] = axis
                floor = {"boundary": "bottom", "displacement": [0.0, 0.0, 0.0]}
                limit = math.tan(math.radians(20))
                for factor in (1.006, 0.999):
                    input_ = scene(mesh, factor * limit, [floor], [0.0, 0.0, -1.0])
                    self.assertEqual(stands(input_), factor > 1, (cell, turn))
                    parts = rigid_pieces.pieces(rigid_pieces.box(input_), ["f0"])
                    self.assertEqual((parts.count, len(parts.fractures)), (2, faces))

    def test_what_hangs_falls_and_what_is_clamped_stays(self):
        halves = box([1.0, 1.0], [2, 2], ([0.0, 0.5], [1.0, 0.5]))
        self.assertFalse(stands(scene(halves, 0.9, [NORTH])))
        self.assertTrue(stands(scene(halves, 0.0, [NORTH, SOUTH])))
        middle = box([3.0, 1.0], [3, 2], ([1.0, 0.0], [1.0, 1.0]), ([2.0, 0.0], [2.0, 1.0]))
        self.assertTrue(stands(scene(middle, 0.1, [WEST, EAST])))
        self.assertFalse(stands(scene(middle, 0.0, [WEST, EAST])))

    def test_rollers_bear_what_they_prescribe(self):
        halves = box([1.0, 1.0], [2, 2], ([0.0, 0.5], [1.0, 0.5]))
        roller = {"boundary": "east", "displacement": ["0", "free"]}
        self.assertTrue(stands(scene(halves, 0.0, [SOUTH, roller], [-1.0, -1.0])))
        self.assertFalse(stands(scene(halves, 0.0, [SOUTH], [-0.01, -1.0])))

    def test_loads_follow_their_tables(self):
        halves = box([1.0, 1.0], [2, 2], ([0.0, 0.5], [1.0, 0.5]))
        load = {"boundary": "north", "traction": ["-q(t)", "-(1 + 0*x)"]}
        tree = scene(halves, 0.5, [SOUTH, load])
        tree.root.append(scene_file.section("Tables", {"q": {"arguments": [0.0, 1.0], "values": [0.0, 1.0]}}))
        # the weight 0.5 causes sliding at 0.75; a resultant within the middle half does not rotate the block
        self.assertTrue(stands(tree, 0.2))
        self.assertFalse(stands(tree, 0.76))

    def test_fluid_pressure_lifts(self):
        """The weight of the upper half is 0.6 per length. On a slope friction depends on the effective traction."""
        for pressure, expected in (("0.59", True), ("0.61", False)):
            self.assertEqual(self.incline(0, 0.5, **{"fluid pressure": pressure}), expected)
        limit = 0.6 * (math.cos(math.radians(20)) - math.sin(math.radians(20)) / 0.6)
        for factor in (0.999, 1.001):
            self.assertEqual(self.incline(20, 0.6, **{"fluid pressure": factor * limit}), factor < 1)

    def arch(self, thickness, friction, stones=60, across=20):
        """Returns whether a semicircular arch with mean radius 1 stands on two fixed stones.

        Stones are cut across the thickness."""
        radii = np.linspace(1 - thickness / 2, 1 + thickness / 2, across + 1)
        angles, stones = math.pi * np.arange(-1, stones + 2) / stones, stones + 2
        points = np.stack([np.outer(np.cos(angles), radii), np.outer(np.sin(angles), radii)], -1).reshape(-1, 2)
        node = np.arange(len(points)).reshape(stones + 1, across + 1)
        a, b, c, d = node[:-1, :-1].ravel(), node[:-1, 1:].ravel(), node[1:, 1:].ravel(), node[1:, :-1].ravel()
        facets = np.stack([np.stack(pair, -1) for pair in ((a, b), (b, c), (c, d), (d, a))], 1)
        diagonals = points[c] - points[a], points[d] - points[b]
        volumes = (diagonals[0][:, 0] * diagonals[1][:, 1] - diagonals[0][:, 1] * diagonals[1][:, 0]) / 2
        groups = {f"j{k:02}": np.stack([node[k, :-1], node[k, 1:]], -1) for k in range(stones + 1)}
        springings = {"right": groups.pop("j00"), "left": groups.pop(f"j{stones:02}")}
        rock = rigid_pieces.Rock(points, facets, volumes, points[np.stack([a, b, c, d], -1)].mean(axis=1), groups | springings)
        conditions = [{"boundary": side, "displacement": [0.0, 0.0]} for side in springings]
        input_ = scene({"fractures": {name: {} for name in groups}}, friction, conditions)
        return limit_analysis.admissible(input_, rock, 0)

    def test_an_arch_needs_a_tenth_of_its_radius(self):
        """A semicircular arch needs a thickness of 0.1075 of its mean radius (Milankovitch 1907, Cocchetti 2011)."""
        for effective, expected in ((0.107, False), (0.108, True)):
            # the outermost centres of faces have a distance of 19/20 of the thickness
            self.assertEqual(self.arch(effective * 20 / 19, 2), expected)
        self.assertFalse(self.arch(0.2, 0.3))  # it slides for friction below 0.31 to 0.4

    def test_pieces_of_a_network(self):
        """Two triangles, separated by a fracture or not."""
        points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        cells = np.array([[0, 1, 2], [0, 2, 3]])
        facets = np.stack([np.delete(cells, i, axis=1) for i in range(3)], axis=1)
        rock = rigid_pieces.Rock(points, facets, np.array([0.5, 0.5]), points[cells].mean(axis=1), {"f": np.array([[2, 0]])})
        parts = rigid_pieces.pieces(rock, ["f"])
        self.assertEqual((parts.count, parts.fractures[0].pieces), (2, (0, 1)))
        self.assertAlmostEqual(parts.fractures[0].area, math.sqrt(2))
        self.assertTrue(np.allclose(parts.fractures[0].normal, np.array([-1, 1]) / math.sqrt(2)))
        self.assertEqual(rigid_pieces.pieces(rock, []).count, 1)


class Drawing(ProgramTest):
    def test_a_scene_depends_on_seed_and_number_alone(self):
        drawn = [random_scenes.draw_scene(3, k) for k in range(300)]
        self.assertEqual(drawn[299], random_scenes.draw_scene(3, 299))
        self.assertNotEqual(drawn[5].tree, random_scenes.draw_scene(4, 5).tree)
        self.assertEqual({one.name.rsplit("-", 1)[0] for one in drawn}, set(random_scenes.families()))

    def test_files_are_the_same_and_can_be_read(self):
        """The first scene of each family is reproducible and valid.

        Limit analysis and the program read the same mesh."""
        first = {}
        for k in range(300):
            first.setdefault(random_scenes.draw_scene(3, k).name.rsplit("-", 1)[0], k)
        for family, k in first.items():
            drawn, refusal = random_scenes.write(3, k, self.folder, program.PROGRAM)
            self.assertEqual(refusal, "")
            path = self.folder / f"{drawn.name}.xml"
            self.call("check", path)
            limit_analysis.of_scene(path, 1.0)
            if family in ("network-2d", "box-3d"):
                before = {file.name: file.read_bytes() for file in self.folder.glob(f"{drawn.name}*.[xm][ms][lh]")}
                random_scenes.write(3, k, self.folder, program.PROGRAM)
                self.assertEqual(before, {name: (self.folder / name).read_bytes() for name in before})
        mesh = next(self.folder.glob("network-2d*.msh"))
        said = self.call("mesh-info", mesh, "--fractures", "a,b")[0]
        rock = rigid_pieces.simplices(mesh)
        self.assertIn(f"{len(rock.volumes)} triangles", said)
        self.assertAlmostEqual(rock.volumes.sum(), np.prod(np.ptp(rock.points, axis=0)))


class Verdicts(ProgramTest):
    def verdict(self, status, friction, time=0.0, end=1.0):
        """Returns the verdict on a run of the clamped block that ended with `status` after the step to `time`."""
        mesh = box([3.0, 1.0], [3, 2], ([1.0, 0.0], [1.0, 1.0]), ([2.0, 0.0], [2.0, 1.0]))
        input_ = scene(mesh, friction, [WEST, EAST])
        input_.root.append(scene_file.section("Time", {"end": end, "steps": 2}))
        path = self.folder / "scene.xml"
        path.write_text(xml.tostring(input_.root, encoding="unicode"))
        run = contact.Run(self.folder / "none", status, "said", results={"steps": [], "reason": "why"}, scene=Scene("scene", str(path)))
        return random_run.judge(run, path)

    def test_a_refusal_is_right_only_where_no_tractions_exist(self):
        self.assertEqual(self.verdict(3, 0.0), ("refused", []))
        verdict, (what,) = self.verdict(3, 0.1)
        self.assertEqual(verdict, "failed")
        self.assertIn("t = 0.5 exist: why", what)

    def test_other_ends(self):
        self.assertEqual(self.verdict(0, 0.1), ("ok", []))
        self.assertEqual(self.verdict(None, 0.0)[0], "hang")
        for status in (1, 134):
            self.assertEqual(self.verdict(status, 0.0), ("failed", [f"status {status}: said"]))

    def test_pressures_of_nearly_incompressible_rock_converge(self):
        """Compression of nearly incompressible rock: round-off of rows with a negative diagonal was added to their residual."""
        drawn, refusal = random_scenes.write(770077, 4, self.folder, program.PROGRAM)
        self.assertEqual(refusal, "")
        self.call("run", self.folder / f"{drawn.name}.xml", "--output", self.folder / "out")
        steps = json.loads((self.folder / "out/results.json").read_text())["steps"]
        self.assertLessEqual(max(step["newton_iterations"] for step in steps), 6)
        self.assertEqual(sum(step["cuts"] for step in steps), 0)

    def test_unstable_slip_converges(self):
        """The scenes obey the laws, without bisection. 6: cohesion decreases with the opening. 23: reversed slip of a soft joint
        with dilation, by proximal continuation, whose projections lacked the springs."""
        for number in (6, 23):
            drawn, refusal = random_scenes.write(4711, number, self.folder, program.PROGRAM)
            self.assertEqual(refusal, "")
            path = self.folder / f"{drawn.name}.xml"
            self.call("run", path, "--output", self.folder / drawn.name)
            results = json.loads((self.folder / drawn.name / "results.json").read_text())
            self.assertEqual(sum(step["cuts"] for step in results["steps"]), 0, drawn.name)
            run = contact.Run(self.folder / drawn.name, 0, "", results=results, scene=Scene(drawn.name, str(path)))
            self.assertEqual(random_run.judge(run, path), ("ok", []))

    def test_springs_leave_the_elastic_jump_of_stiffening_joints_alone(self):
        """The tangential stiffness grows with the compression. Newton's method fails, and proximal continuation follows. Its springs
        acted on a part of the elastic jump; then no stiffness of the springs converged."""
        drawn, refusal = random_scenes.write(71003, 7, self.folder, program.PROGRAM)
        self.assertEqual(refusal, "")
        path = self.folder / f"{drawn.name}.xml"
        self.call("run", path, "--output", self.folder / "out", "--set", "Time.end=0.015625", "--set", "Time.steps=1",
                  "--set", "Time.maximum halvings=0")
        results = json.loads((self.folder / "out/results.json").read_text())
        run = contact.Run(self.folder / "out", 0, "", results=results, scene=Scene(drawn.name, str(path)))
        self.assertEqual(random_run.judge(run, path), ("ok", []))

    def test_all_ways_lead_to_the_same_fields(self):
        """Runs one scene in seven ways, and again with a program that changes the rock of renumbered meshes."""
        inexact = self.folder / "inexact"
        inexact.write_text(f'#!/bin/sh\ncase "$*" in *renumbering*) set -- "$@" --set "Materials.rock.Young\'s modulus=1e10";; esac\n'
                           f'exec {program.PROGRAM} "$@"\n')
        inexact.chmod(0o755)
        drawn = random_scenes.draw_scene(7, 9)
        for binary, status in ((program.PROGRAM, 0), (inexact, 1)):
            command = [sys.executable, "-B", ROOT / "perf", "contact", "--random", "12", "--seed", "7", "--only", drawn.name,
                       "--all-ways", "--jobs", "1", "--binary", binary, "--output", self.folder / "out"]
            done = subprocess.run(command, capture_output=True, text=True, timeout=program.TIME_LIMIT)
            self.assertEqual(done.returncode, status, done.stdout + done.stderr)
            largest = float(done.stdout.split("largest_difference=")[1])
            (self.assertGreater if status else self.assertLess)(largest, 1e-8)
            self.assertEqual("renumbered: " in done.stdout, status == 1)
            self.assertIn("2 ranks, renamed, restart, 3 ranks, renumbered, repeated", (self.folder / "out/random.csv").read_text())

    def test_scenes_that_fail_are_saved(self):
        broken = self.folder / "broken"
        broken.write_text("#!/bin/sh\necho no good; exit 5\n")
        broken.chmod(0o755)
        command = [sys.executable, "-B", ROOT / "perf", "contact", "--random", "12", "--seed", "7", "--only", "box-2d-0009",
                   "--binary", broken, "--output", self.folder / "out"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=program.TIME_LIMIT)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        saved = list((self.folder / "out/failures").iterdir())
        self.assertRegex(done.stdout.splitlines()[-1], "^failures=1 hangs=0 violations=0 rank_differences=0 newton_median=nan newton_p90=nan$")
        self.call("check", saved[0])
        self.assertIn("status 5: no good", saved[0].read_text().splitlines()[0])
        self.assertEqual(len((self.folder / "out/random.csv").read_text().splitlines()), 2)


if __name__ == "__main__":
    main()
