#!/usr/bin/env python3
"""Scenes with stages: stages_test.py PROGRAM ROOT MPIEXEC"""
import csv
import json
import math
import shutil
import signal
import subprocess
import time
import xml.etree.ElementTree as ET

import program
from program import ProgramTest, main

CYCLIC = "verification/cyclic_2d.xml"  # alternating slip and stick
QUIET = "Output.vtu=false"
E, NU, P1, P2 = 10e9, 0.25, -10e6, -5e6  # Pa; stress far from the gallery, along x and y
G = E / (2 * (1 + NU))


def entries(parent, values):
    """Writes nested dicts as parameter lists."""
    for name, value in values.items():
        if isinstance(value, dict):
            entries(ET.SubElement(parent, "ParameterList", name=name), value)
            continue
        text = "{" + ", ".join(map(str, value)) + "}" if isinstance(value, (list, tuple)) else str(value)
        one = value[0] if isinstance(value, (list, tuple)) and value else value
        kind = {int: "int", float: "double", bool: "bool"}.get(type(one), "string")
        if isinstance(value, (list, tuple)):
            kind = f"Array({kind})"
        ET.SubElement(parent, "Parameter", name=name, type=kind, value=text.lower() if kind == "bool" else text)


def kirsch_displacement(x, y):
    """Returns the displacement, m, after excavation of a disc of radius 1 (Kirsch 1898), plane strain."""
    r2, s, d = x * x + y * y, P1 + P2, P1 - P2
    cos, sin = (x * x - y * y) / r2, 2 * x * y / r2  # of the double angle
    radial = (s + d * (4 * (1 - NU) - 1 / r2) * cos) / (4 * G)  # times r
    around = -d * (2 * (1 - 2 * NU) + 1 / r2) * sin / (4 * G)
    return [(radial * x - around * y) / r2, (radial * y + around * x) / r2]


def kirsch_stress(x, y):
    """Returns the total stress XX, YY, XY, Pa, after this excavation."""
    r2, s, d = x * x + y * y, (P1 + P2) / 2, (P1 - P2) / 2
    cos, sin = (x * x - y * y) / r2, 2 * x * y / r2
    rr = s * (1 - 1 / r2) + d * (1 - 4 / r2 + 3 / r2**2) * cos
    tt = s * (1 + 1 / r2) - d * (1 + 3 / r2**2) * cos
    rt = -d * (1 + 2 / r2 - 3 / r2**2) * sin
    return [(rr + tt) / 2 + (rr - tt) / 2 * cos - rt * sin, (rr + tt) / 2 - (rr - tt) / 2 * cos + rt * sin,
            (rr - tt) / 2 * sin + rt * cos]


def exact_far(share):
    """Returns the far displacement as expressions of a scene, multiplied by the expression `share`."""
    d, s = P1 - P2, P1 + P2
    radial = f"(({s}) + ({d})*({4 * (1 - NU)} - 1/r2)*(x^2 - y^2)/r2)/({4 * G})"
    around = f"(-({d})*({2 * (1 - 2 * NU)} + 1/r2)*2*x*y/r2)/({4 * G})"
    return {"r2": "x^2 + y^2", "ux": f"({share})*(({radial})*x - ({around})*y)/r2",
            "uy": f"({share})*(({radial})*y + ({around})*x)/r2"}


class Stages(ProgramTest):
    def write(self, values, name="scene.xml"):
        root = ET.Element("ParameterList", name="Sprekk")
        entries(root, values)
        path = self.folder / name
        path.write_bytes(ET.tostring(root))
        return str(path)

    def mesh(self, n, dim):
        """Returns the path of a mesh with a disc "gallery" of radius 1 in one of radius 4; in 3D a slab.

        A quarter of the wall has n cells."""
        path = self.folder / f"kirsch_{dim}_{n}.msh"
        if not path.exists():
            subprocess.run(["gmsh", f"-{dim}", "-order", "2", "-format", "msh22", "-setnumber", "n", str(n), "-setnumber", "dim",
                            str(dim), str(program.ROOT / "tests/data/meshes/gallery.geo"), "-o", str(path)], check=True,
                           capture_output=True)
        return str(path)

    def gallery(self, n=8, dim=2, steps=1, release=True):
        """Returns the scene of a round gallery in rock under stress.

        With `release` the release takes all later steps."""
        share = "max(min(t - 1, 1), 0)" if release else "t < 1.5 ? 0 : 1"
        free = ["0"] if dim == 3 else []
        times = [1] + [1 + (k + 1) / steps for k in range(steps)] + [3]
        held = {"far": {"boundary": "far", "displacement": ["ux", "uy"] + (["0"] if dim == 3 else [])}}
        if dim == 3:
            for side in ("front", "back"):
                held[side] = {"boundary": side, "displacement": ["free", "free", "0"]}
        stress = [P1, P2, NU * (P1 + P2), 0.0] + ([0.0, 0.0] if dim == 3 else [])
        h = 0.25 / 2
        angles = [0.5 * math.pi * k / 4 for k in range(5)]
        places = {f"wall {k}": [math.cos(a), math.sin(a)] for k, a in enumerate(angles)}
        return {
            "Mesh file": {"path": self.mesh(n, dim)},
            "Materials": {"rock": {"type": "elastic", "Young's modulus": E, "Poisson's ratio": NU}},
            "Expressions": exact_far(share),
            "Bulk": {"material": "rock", "initial stress": stress},
            "Boundary conditions": held,
            "Probes": {name: {"point": x + ([0.0] if dim == 3 else []), "outputs": ["displacement", "stress"]}
                       for name, x in places.items()},
            "Stages": {"excavation": {"time": 1.0, "excavate": ["gallery"], **({"release": 1.0} if release else {})}},
            "Time": {"schedule": [float(t) for t in times]},
            "Output": {"vtu": False}}

    def probe(self, name, output="out"):
        """Returns the rows of a probe's table."""
        with open(self.folder / output / f"probes/{name}.csv") as file:
            return list(csv.reader(file))[1:]

    def wall_cells(self, n, dim):
        """Returns the centres of some rock cells with a face on the wall."""
        with open(self.mesh(n, dim)) as file:
            lines = iter(file.read().splitlines())
        nodes, cells = {}, []
        for line in lines:
            if line.startswith("$Nodes"):
                for _ in range(int(next(lines))):
                    number, *x = next(lines).split()
                    nodes[number] = [float(v) for v in x]
            elif line.startswith("$Elements"):
                for _ in range(int(next(lines))):
                    words = next(lines).split()
                    if int(words[1]) == {2: 9, 3: 11}[dim]:
                        cells.append([nodes[k] for k in words[3 + int(words[2]):]])
        centres = []
        for cell in cells:
            corners = dim + 1
            on_wall = sum(abs(math.hypot(x[0], x[1]) - 1) < 1e-9 for x in cell[:corners])
            inside = max(math.hypot(x[0], x[1]) for x in cell[:corners]) < 1 + 1e-9
            if on_wall == dim and not inside:
                weights = [1 / 9 - 2 / 9 if dim == 2 else -1 / 8] * corners + [4 / 9 if dim == 2 else 1 / 4] * (len(cell) - corners)
                centres.append([sum(w * x[i] for w, x in zip(weights, cell)) for i in range(dim)])
        return centres[::max(1, len(centres) // 24)]

    def last(self, output="out"):
        """Returns the content of the last checkpoint and the bytes of its values."""
        folder = max((f for f in (self.folder / output / "checkpoints").glob("*") if f.name.isdigit()), key=lambda f: int(f.name))
        content = json.loads((folder / "manifest.json").read_text())["sealed"]["content"]
        return content, [piece.read_bytes() for piece in sorted(folder.glob("piece_*.h5"))]

    def test_nothing_changes_no_bit(self):
        """Stages without changes, or with equal values, leave the results bitwise identical."""
        options = [QUIET, "Output.checkpoints.steps=100"]
        plain = self.run_scene(CYCLIC, *options, output="plain")
        staged = self.run_scene(CYCLIC, *options, "Stages.none.time=3", "Stages.same.time=5",
                                "Stages.same.Materials.joint.friction coefficient=0.6", output="staged")
        self.assertEqual([step.pop("stage", "") for step in staged["steps"]], [""] * 3 + ["none"] * 2 + ["same"] * 3)
        self.assertEqual(plain["steps"], staged["steps"])
        self.assertEqual(self.last("plain")[1], self.last("staged")[1])
        other = self.run_scene(CYCLIC, *options, "Stages.same.time=5", "Stages.same.Materials.joint.friction coefficient=0.5")
        self.assertNotEqual(plain["steps"][5]["fractures"], other["steps"][5]["fractures"])

    def test_weaker_joint(self):
        """A sliding block loses friction.

        By hand, the new friction gives its shear stress, and the remaining displacement is slip."""
        weak = ["Stages.weak.time=2", "Stages.weak.Materials.joint.friction coefficient=0.3",
                "Stages.weak.Tables.shear.values={0, 0.066666666666666667, 0.09, 0.09, 0.09, 0.09, 0.09, 0.09, 0.09}"]
        for ranks in (1, 3):
            steps = self.run_scene(CYCLIC, *weak, QUIET, "Time.schedule={1, 2, 3}", "Mesh.cells={4, 4}", ranks=ranks)["steps"]
            before, after = (step["fractures"]["fracture"] for step in steps[1:])
            self.assertAlmostEqual(before["mean_traction"]["local"][1], 0.18, delta=1e-9)
            self.assertAlmostEqual(after["mean_traction"]["local"][0], -0.3, delta=1e-9)
            self.assertAlmostEqual(after["mean_traction"]["local"][1], 0.09, delta=1e-9)
            self.assertAlmostEqual(after["mean_slip"], 0.5 - 0.09 / 1 - 0.09 / 2, delta=1e-9)

    def test_conditions_end_and_begin(self):
        """A traction replaces a displacement condition."""
        scene = self.scene(CYCLIC)
        values = ["Stages.pull.time=1", "Stages.pull.without={Boundary conditions > moved}",
                  "Stages.pull.Boundary conditions.pulled.boundary=north",
                  "Stages.pull.Boundary conditions.pulled.traction={0.15, -0.3}",
                  "Stages.pull.Tables.shear.values={0, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15}"]
        steps = self.run_scene(scene, *values, QUIET, "Time.schedule={1, 2}")["steps"]
        self.assertIn("north", steps[0]["reactions"])
        self.assertNotIn("north", steps[1]["reactions"])
        self.assertAlmostEqual(steps[1]["fractures"]["fracture"]["mean_traction"]["local"][1], 0.15, delta=1e-9)

    def expect_same_bits(self, a, b):
        self.assertEqual(self.results(a)["status"], "completed")
        self.assertEqual(self.results(a)["steps"], self.results(b)["steps"])
        of_a, of_b = self.last(a), self.last(b)
        for content, _ in (of_a, of_b):
            content.pop("restarts")
        self.assertEqual(of_a, of_b)

    def test_restart_within_and_across_stages(self):
        scene = self.write(self.gallery(n=4, steps=4))
        options = ["Output.checkpoints.steps=1", "Stages.support.time=2",
                   "Stages.support.Boundary conditions.shotcrete.boundary=gallery",
                   "Stages.support.Boundary conditions.shotcrete.confining pressure=1e6"]
        whole = "1, 1.25, 1.5, 1.75, 2, 3"
        for ranks in (1, 3):
            self.run_scene(scene, *options, f"Time.schedule={{{whole}}}", ranks=ranks, output="whole")
            for until in ("1", "1, 1.25", "1, 1.25, 1.5, 1.75, 2"):
                with self.subTest(ranks=ranks, until=until):
                    self.run_scene(scene, *options, f"Time.schedule={{{until}}}", ranks=ranks, output="parts")
                    sets = [word for option in [*options, f"Time.schedule={{{whole}}}"] for word in ("--set", option)]
                    self.call("run", scene, "--output", "parts", "--restart", *sets, ranks=ranks)
                    self.expect_same_bits("whole", "parts")

    def test_stopped_in_the_first_step_of_a_stage(self):
        """A signal stops the run in a long first step of a stage, with too few allowed iterations.

        The restart allows more."""
        scene = ["Mesh.cells={150, 150}", "Time.maximum halvings=20", "Output.checkpoints.steps=10", "Stages.s.time=3",
                 "Stages.s.Materials.joint.friction coefficient=0.2", "Time.schedule={1, 2, 3, 4}"]
        def words(options, *more):
            sets = [word for option in (*scene, *options) for word in ("--set", option)]
            return ["run", self.scene(CYCLIC), *sets, *more]
        slow = ["Stages.s.Solver.maximum iterations=1"]
        run = subprocess.Popen([str(program.PROGRAM), *map(str, words(slow, "--output", "parts"))], cwd=self.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        while not (self.folder / "parts/bulk_0002.pvtu").exists():  # last step of the previous stage
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        time.sleep(0.3)
        run.send_signal(signal.SIGTERM)
        self.assertIn("interrupted after the step to t = 3;", run.stderr.read())
        self.assertEqual(run.wait(timeout=program.TIME_LIMIT), 4)
        self.call(*words([], "--output", "parts", "--restart"))
        self.call(*words([], "--output", "whole"))
        self.assertEqual(self.results("parts")["steps"], self.results("whole")["steps"])
        self.assertEqual(self.results("parts")["stages"], self.results("whole")["stages"])
        self.assertEqual((self.folder / "parts/effective_input.xml").read_text(), (self.folder / "whole/effective_input.xml").read_text())

    def test_restart_into_changed_stages(self):
        """A restart may change later stages but not earlier ones. The message explains how to change them."""
        first = ["Output.checkpoints.steps=1", QUIET, "Stages.a.time=2", "Stages.a.Materials.joint.friction coefficient=0.5"]
        self.run_scene(CYCLIC, *first, "Time.schedule={1, 2, 3, 4}")
        b = ["Stages.b.time=4", "Stages.b.Materials.joint.friction coefficient=0.4"]
        def go(*options, expect=0):
            sets = [word for option in options for word in ("--set", option)]
            return self.call("run", self.scene(CYCLIC), "--output", "out", "--restart", *sets, expect=expect)[1]
        whole = self.run_scene(CYCLIC, *first, *b, "Time.schedule={1, 2, 3, 4, 5}", output="whole")
        go(*first, *b, "Time.schedule={1, 2, 3, 4, 5}")
        self.assertEqual(self.results()["steps"], whole["steps"])
        self.assertEqual([step.get("stage") for step in whole["steps"]], [None, None, "a", "a", "b"])
        error = go(*first, "Materials.joint.tangential stiffness=3", expect=1)
        self.assertIn("they differ in: Materials", error)
        self.assertIn("use a stage for changes at its time or later", error)
        error = go(*first[:-1], "Stages.a.Materials.joint.friction coefficient=0.55", expect=1)
        self.assertIn("they differ in: Materials", error)

    def test_errors_come_first(self):
        """Errors name the stage, the place, the value and the allowed values, before any computation."""
        for options, message in (
                (["Stages.s.time=-1"], 'Sprekk > Stages > s > "time": is -1 s: must be after the "start" of "Time", 0 s'),
                (["Stages.s.without={}"], 'Sprekk > Stages > s > "time" (s): missing; it is required'),
                (["Stages.s.time=2", "Stages.r.time=2"], 'is 2 s: the stage "r" begins then'),
                (["Stages.s.time=2", "Stages.s.Materials.joint.friction coeficient=0.3"],
                 'stage "s": Sprekk > Materials > joint > "friction coeficient": unknown. Did you mean "friction coefficient"?'),
                (["Stages.s.time=2", "Stages.s.Materials.joint.friction coefficient=-1"],
                 'stage "s": Sprekk > Materials > joint > "friction coefficient": is -1'),
                (["Stages.s.time=2", "Stages.s.Mesh.cells={4, 4}"], "Sprekk > Stages > s > Mesh: a stage cannot change it"),
                (["Stages.s.time=2", "Stages.s.without={Boundary conditions > mooved}"],
                 'stage "s": "without": names "Boundary conditions > mooved", which the scene does not have at this time. Did you mean "moved"?'),
                (["Stages.s.time=2", "Stages.s.Fractures.material=other"],
                 'Sprekk > Stages > s > Fractures > "material": a stage changes the materials of fractures by their names'),
                (["Stages.s.time=2", "Stages.s.Materials.rock.shear modulus=2"],
                 'stage "s": the rock of "bulk" gets other elastic constants, and the fracture "fracture" meets it; that can only happen'),
                (["Stages.s.time=2", "Stages.s.backfill={bulk}"],
                 'stage "s": "backfill": names "bulk", which is not excavated at this time'),
                (["Stages.s.time=2", "Stages.s.Boundary conditions.other.boundary=north",
                  "Stages.s.Boundary conditions.other.displacement={1, 1}"],
                 'stage "s": boundary conditions "moved" and "other" prescribe'),
                (["Stages.s.time=2", "Stages.s.excavate={galery}"], 'stage "s": Sprekk > Regions > "galery": is "galery", must be one of'),
                (["Stages.s.time=2", "Stages.s.Flow.viscosity=1e-3"], 'stage "s": Sprekk > Materials > rock > "permeability": missing'),
                (["Stages.s.time=2", "Stages.s.excavate={bulk}"], "all cells of the mesh would be excavated"),
                (["Materials.joint.damage=isotropic", "Materials.joint.damage length of friction=0.02",
                  "Materials.joint.residual part of friction=0.5", "Stages.s.time=2", "Stages.s.Materials.plain.type=joint",
                  "Stages.s.Materials.plain.friction coefficient=0.6", "Stages.s.Fractures.fracture.material=plain"],
                 "its laws with history variables become")):
            with self.subTest(options=options):
                sets = [word for option in options for word in ("--set", option)]
                error = self.call("run", self.scene(CYCLIC), "--output", "out", *sets, expect=1)[1]
                self.assertIn(message, error)
                self.assertEqual(self.results()["steps"] if (self.folder / "out/results.json").exists() else [], [])
        warning = self.call("check", self.scene(CYCLIC), "--set", "Stages.s.time=9")[1]
        self.assertIn("is 9 s, and the last step ends at 8 s: the stage never begins", warning)

    def test_kirsch(self):
        """Round gallery, order 2: wall displacements within 0.1 %, stress at the wall within 1 % of the largest."""
        for n, dim, ranks in ((16, 2, 1), (16, 2, 3), (16, 3, 1)):
            with self.subTest(n=n, dim=dim, ranks=ranks):
                values = self.gallery(n, dim)
                centres = self.wall_cells(n, dim)
                for k, x in enumerate(centres):
                    values["Probes"][f"cell {k}"] = {"point": x, "outputs": ["stress"]}
                self.run_scene(self.write(values), ranks=ranks)
                largest = math.hypot(*kirsch_displacement(1, 0))
                for name, place in values["Probes"].items():
                    seen = [float(v) for v in self.probe(name)[-1][1:]]
                    x, y = place["point"][:2]
                    if name.startswith("wall"):
                        error = math.dist(seen[:2], kirsch_displacement(x, y)) / largest
                        self.assertLess(error, 1e-3, name)
                    else:
                        seen = [seen[0], seen[1], seen[3]]
                        error = math.dist(seen, kirsch_stress(x, y)) / abs(3 * P1 - P2)
                        self.assertLess(error, 1e-2, (name, x, y, seen))

    def square(self, steps, release=True, excavated=False, cell="triangle"):
        """Returns the scene of a square gallery with three fractures: cut, at a distance, and inside."""
        box = {"cell": cell, "lower corner": [-12.0, -12.0], "upper corner": [12.0, 12.0], "cells": [24, 24],
               "regions": {"gallery": {"lower corner": [-2.0, -2.0], "upper corner": [2.0, 2.0]}},
               "fractures": {"cut": {"lower corner": [-8.0, 0.0], "upper corner": [8.0, 0.0]},
                             "beside": {"lower corner": [4.0, -6.0], "upper corner": [4.0, 6.0]},
                             "inside": {"lower corner": [-1.0, -1.0], "upper corner": [1.0, -1.0]}}}
        joint = {"type": "joint", "friction coefficient": 0.2, "tangential stiffness": 10e9, "dilation angle": "3 deg"}
        scene = {"Mesh": box, "Materials": {"rock": {"type": "elastic", "Young's modulus": 20e9, "Poisson's ratio": 0.25},
                                            "joint": joint},
                 "Bulk": {"material": "rock", "initial stress": [-10e6, -6e6, -8e6, 1e6]}, "Fractures": {"material": "joint"},
                 "Boundary conditions": {side: {"boundary": side, "displacement": [0.0, 0.0]}
                                         for side in ("west", "east", "south", "north")},
                 "Time": {"schedule": [1.0] + [1 + (k + 1) / steps for k in range(steps)]}, "Output": {"vtu": False}}
        if excavated:
            return {**scene, "Regions": {"gallery": {"excavated": True}}}
        return {**scene, "Stages": {"excavation": {"time": 1.0, "excavate": ["gallery"], **({"release": 1.0} if release else {})}}}

    def test_fractures_that_a_gallery_meets(self):
        """A cut fracture ends at the wall, another is removed.

        With monotone slip the end state is that with an initial gallery, for any steps and ranks."""
        always = self.run_scene(self.write(self.square(1, excavated=True)), "Time.schedule={1}")["steps"][-1]["fractures"]
        self.assertAlmostEqual(always["cut"]["area"], 12, delta=1e-12)
        self.assertEqual(always["inside"]["area"], 0)
        self.assertGreater(always["beside"]["mean_slip"], 1e-5)
        self.assertGreater(always["cut"]["mean_slip"], 1e-7)
        for steps, release, ranks in ((1, False, 1), (1, True, 1), (6, True, 1), (3, True, 3)):
            with self.subTest(steps=steps, release=release, ranks=ranks):
                results = self.run_scene(self.write(self.square(steps, release)), ranks=ranks)
                self.assertAlmostEqual(results["steps"][0]["fractures"]["cut"]["area"], 16, delta=1e-12)
                end = results["steps"][-1]["fractures"]
                for name, tolerance in (("cut", 1e-13), ("beside", 1e-13), ("inside", 0)):
                    self.assertEqual(end[name]["area"], always[name]["area"])
                    for number in ("mean_slip", "max_slip", "mean_opening") if tolerance else ():
                        self.assertAlmostEqual(end[name][number], always[name][number], delta=tolerance, msg=(name, number))

    def test_order_in_the_step(self):
        """Slip depends on the path if the wall pressure varies during the release.

        A quarter of the step reduces the error by more than 4."""
        press = ["Stages.excavation.Boundary conditions.lining.boundary=gallery",
                 "Stages.excavation.Boundary conditions.lining.confining pressure=1.2e8*max(t-1,0)*(2-t)*(t-1)"]
        ends = [self.run_scene(self.write(self.square(n)), *press)["steps"][-1]["fractures"] for n in (4, 16, 64, 256)]
        for name in ("beside", "cut"):
            slips = [end[name]["mean_slip"] for end in ends]
            errors = [abs(slip - slips[-1]) for slip in slips[:-1]]
            self.assertGreater(errors[0], 0.1 * slips[-1])
            for before, after in zip(errors, errors[1:]):
                self.assertLess(after, before / 4, name)

    def test_wet_gallery(self):
        """Water flows to the wall. In the steady state the flow through the boundary is equal."""
        scene = self.scene("stages/gallery_2d.xml")
        coarse = [QUIET, "Mesh.cells={30, 30}", "Output.checkpoints.steps=1"]
        # geometry moved to nodes of this coarse mesh, which has none at odd coordinates
        for name, ends in (("roof", "{-20, 4}, {14, 4}"), ("crossing", "{-24, 0}, {22, 0}"), ("wall", "{4, -20}, {4, 18}"),
                           ("steep", "{-2, 2}, {-2, 24}"), ("gallery", "{-4, -4}, {4, 2}")):
            lower, upper = ends.split("}, ")
            section = "regions" if name == "gallery" else "fractures"
            coarse += [f"Mesh.{section}.{name}.lower corner={lower}}}", f"Mesh.{section}.{name}.upper corner={upper}"]
        coarse.append("Probes.crown.point={0, 2}")
        results = self.run_scene(scene, *coarse)
        steps = results["steps"]
        self.assertEqual([stage["name"] for stage in results["stages"]], ["excavation", "lining", "decay"])
        inflows = steps[-1]["inflows"]
        self.assertLess(inflows["gallery"], -1e-8)
        self.assertAlmostEqual(sum(inflows.values()), 0, delta=2e-3 * abs(inflows["gallery"]))
        face = self.probe("face")
        self.assertTrue(all(math.isfinite(float(v)) for v in face[1][1:]))
        self.assertTrue(all(not math.isfinite(float(v or "nan")) for row in face[2:] for v in row[1:]))
        crown = [float(row[2]) for row in self.probe("crown")]  # displacement y
        at = {step["time"] / 86400: value for step, value in zip(steps, crown[1:])}
        self.assertLess(at[5], at[2])
        self.assertGreater(at[20], at[10])  # the lining lifts it
        self.assertLess(at[60], at[30])
        other = self.run_scene(scene, *coarse, ranks=3, output="three")
        for a, b in zip(steps, other["steps"]):
            for name, value in a["inflows"].items():
                self.assertAlmostEqual(value, b["inflows"][name], delta=1e-8 * abs(inflows["gallery"]))
        until = "86400, 172800, 259200"
        for ranks in (1, 3):
            self.run_scene(scene, *coarse, f"Time.schedule={{{until}}}", ranks=ranks, output="parts")
            sets = [word for option in coarse for word in ("--set", option)]
            self.call("run", scene, "--output", "parts", "--restart", *sets, ranks=ranks)
            self.expect_same_bits({1: "out", 3: "three"}[ranks], "parts")
            self.assertEqual(self.results("parts")["stages"], results["stages"])

    def test_one_excavation_after_another(self):
        """Without slip the order of excavations does not matter, and half of a release gives half of the displacement.

        Slip is transferred to the mesh of the second excavation."""
        def scene(excavated, friction=10.0):
            values = self.square(2, excavated=True)
            values["Materials"]["joint"]["friction coefficient"] = friction
            values["Mesh"]["regions"]["niche"] = {"lower corner": [-10.0, 2.0], "upper corner": [-7.0, 5.0]}
            del values["Mesh"]["fractures"]["inside"]
            values["Regions"] = {name: {"excavated": True} for name in excavated}
            values["Probes"] = {f"at {k}": {"point": x, "outputs": ["displacement", "stress"]}
                                for k, x in enumerate([[3.0, 3.0], [-5.0, -5.0], [9.0, -7.0], [-11.0, 5.0]])}
            if not excavated:
                del values["Regions"]
                values["Stages"] = {"first": {"time": 1.0, "excavate": ["gallery"]},
                                    "second": {"time": 2.0, "excavate": ["niche"], "release": 0.5}}
            return self.write(values)
        both = self.run_scene(scene(["gallery", "niche"]), "Time.schedule={1}", output="both")["steps"][-1]["fractures"]
        self.assertGreater(abs(both["beside"]["mean_elastic_jump"]["local"][1]), 1e-6)
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                steps = self.run_scene(scene([]), "Time.schedule={1, 2, 2.25, 2.5}", ranks=ranks)["steps"]
                for name, numbers in steps[-1]["fractures"].items():
                    for of, scale in (("mean_traction", 1e7), ("mean_elastic_jump", 1e-3)):
                        for a, b in zip(numbers[of]["local"], both[name][of]["local"]):
                            self.assertAlmostEqual(a, b, delta=1e-10 * scale)
                for k in range(4):
                    begin, half, end = ([float(v) for v in row[1:]] for row in self.probe(f"at {k}")[-3:])
                    for a, b in zip(end, self.probe(f"at {k}", "both")[-1][1:]):
                        self.assertAlmostEqual(a, float(b), delta=1e-10 * max(1e-3, abs(float(b))))
                    for a, b, c in zip(begin, half, end):
                        self.assertAlmostEqual(b, (a + c) / 2, delta=1e-10 * max(1e-3, abs(c)))
                slides = self.run_scene(scene([], 0.2), "Time.schedule={1, 2, 2.0001}", ranks=ranks)["steps"]
                before, after = (step["fractures"]["beside"] for step in slides[-2:])
                self.assertGreater(before["max_slip"], 1e-5)
                for number in ("max_slip", "mean_slip"):
                    self.assertAlmostEqual(after[number], before[number], delta=1e-2 * before[number])

    def test_pressures_are_carried(self):
        """One second after a further excavation in wet rock, pressures elsewhere and flow to the first wall persist."""
        options = [QUIET, "Mesh.cells={60, 60}", "Mesh.regions.niche.lower corner={20, -20}", "Mesh.regions.niche.upper corner={22, -18}",
                   "Stages.niche.time=4 d", "Stages.niche.excavate={niche}", "Stages.niche.release=1 d",
                   "Time.schedule={86400, 172800, 345600, 345601}"]
        places = {"a": "{10.3, 10.2}", "b": "{-15.3, -8.1}", "c": "{6.7, -2.2}"}
        for name, x in places.items():
            options += [f"Probes.{name}.point={x}", f"Probes.{name}.outputs={{pressure}}"]
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                steps = self.run_scene(self.scene("stages/gallery_2d.xml"), *options, ranks=ranks)["steps"]
                self.assertEqual([step.get("stage") for step in steps], [None, "excavation", "excavation", "niche"])
                values = [[float(v) for v in (row[1] for row in self.probe(name)[-2:])] for name in places]
                for before, after in values:
                    self.assertAlmostEqual(after, before, delta=1e3)  # of 2 MPa
                self.assertGreater(max(v[0] for v in values) - min(v[0] for v in values), 1e5)
                before, after = (step["inflows"]["gallery"] for step in steps[-2:])
                self.assertAlmostEqual(after, before, delta=0.02 * abs(before))

    LOWER, UPPER, STIFFER = (10e9, 0.25), (4e9, 0.2), (30e9, 0.3)  # Young's moduli and Poisson's ratios

    def column(self, cell, order):
        """Returns a column of rock of height 1 below a region "upper" of height 2, on rollers, with a load on top."""
        dim = 2 if cell in ("triangle", "quadrilateral") else 3
        up, sides = dim - 1, ("west", "east", "south", "north")[:2 * (dim - 1)]
        bottom, top = (("south", "north"), ("bottom", "top"))[dim - 2]
        fixed = lambda axis: ["0" if k == axis else "free" for k in range(dim)]
        rollers = {side: {"boundary": side, "displacement": fixed(k // 2)} for k, side in enumerate(sides)}
        upper = {"lower corner": [0.0] * up + [1.0], "upper corner": [1.0] * up + [3.0]}
        return {
            "Mesh": {"cells": [2] * up + [6], "lower corner": [0.0] * dim, "upper corner": [1.0] * up + [3.0], "cell": cell,
                     "order": order, "regions": {"upper": upper}},
            "Materials": {name: {"type": "elastic", "Young's modulus": E, "Poisson's ratio": nu}
                          for name, (E, nu) in (("lower", self.LOWER), ("fill", self.UPPER), ("stiffer", self.STIFFER))},
            "Bulk": {"material": "lower"}, "Regions": {"upper": {"excavated": True}},
            "Boundary conditions": {**rollers, "ground": {"boundary": bottom, "displacement": fixed(up)},
                                    "load": {"boundary": "upper", "confining pressure": "2e6"}},
            "Probes": {name: {"point": [0.5] * up + [z], "outputs": ["displacement", "stress"]}
                       for name, z in (("low", 0.45), ("face", 1.0), ("high", 2.95), ("top", 3.0))},
            "Stages": {"fill": {"time": 1.0, "backfill": ["upper"], "without": ["Boundary conditions > load"],
                                "Regions": {"upper": {"material": "fill"}},
                                "Boundary conditions": {"more": {"boundary": top, "confining pressure": "t < 1.5 ? 0 : t < 3.5 ? 5e6 : 9e6"}}},
                       "grout": {"time": 3.0, "Regions": {"upper": {"material": "stiffer"}}, "Bulk": {"material": "fill"}}},
            "Time": {"schedule": [1.0, 1.25, 2.0, 3.0, 3.25, 4.0]}, "Output": {"vtu": False}}

    def test_fill_and_other_constants(self):
        """A column is loaded, unloaded and filled, loaded again, then its constants change.

        Fill is free of stress when placed. Changes of constants preserve the stress. The results are exact in 2D and
        3D, for both orders, on several ranks, and after a restart."""
        modulus = lambda rock: rock[0] * (1 - rock[1]) / ((1 + rock[1]) * (1 - 2 * rock[1]))
        lower, fill, stiffer = (modulus(rock) for rock in (self.LOWER, self.UPPER, self.STIFFER))
        # at the face and on top: 2 MPa on the rock; unloaded; 5 MPa on the fill, twice; other constants; 9 MPa
        face = [-2e6 / lower, 0, -5e6 / lower, -5e6 / lower, -5e6 / lower, -5e6 / lower - 4e6 / fill]
        top = [math.nan] + [u - face[0] - 2 * s for u, s in zip(face[1:], (0, 5e6 / fill, 5e6 / fill, 5e6 / fill, 5e6 / fill + 4e6 / stiffer))]
        pressed = [2e6, 0, 5e6, 5e6, 5e6, 9e6]
        for cell, order, ranks in (("triangle", 1, 1), ("triangle", 2, 3), ("quadrilateral", 1, 3), ("tetrahedron", 1, 3),
                                   ("tetrahedron", 2, 1), ("hexahedron", 1, 1), ("hexahedron", 2, 3)):
            with self.subTest(cell=cell, order=order, ranks=ranks):
                values = self.column(cell, order)
                up = len(values["Mesh"]["cells"]) - 1
                scene = self.write(values)
                self.run_scene(scene, "Output.checkpoints.steps=1", ranks=ranks)
                for name, exact in (("face", face), ("top", top)):
                    for row, u in zip(self.probe(name)[-6:], exact):
                        self.assertAlmostEqual(float(row[1 + up]), u, delta=1e-9 * abs(face[-1])) if u == u else self.assertEqual(row[1 + up], "nan")
                for name in ("low", "high"):
                    for row, p in list(zip(self.probe(name)[-6:], pressed))[name == "high":]:
                        stress = [float(v) for v in row[2 + up:]]
                        self.assertAlmostEqual(stress[(1, 2)[up - 1]], -p, delta=10)
                parts = self.folder / "parts"
                shutil.rmtree(parts, ignore_errors=True)
                shutil.copytree(self.folder / "out", parts)
                shutil.rmtree(max(parts.glob("checkpoints/[0-9]*"), key=lambda folder: int(folder.name)))
                self.call("run", scene, "--output", "parts", "--restart", "--set", "Output.checkpoints.steps=1", ranks=ranks)
                self.expect_same_bits("out", "parts")

    def test_springs_that_change(self):
        """A column on springs that become stiffer: u = -p/k, then -(p' - p)/k' more.

        After excavation of a part, the other springs have the same forces, independently of earlier changes."""
        k, stiffer, E = 2e9, 5e9, 1e15
        for cell, ranks in (("triangle", 1), ("quadrilateral", 3), ("tetrahedron", 2)):
            with self.subTest(cell=cell, ranks=ranks):
                values = self.column(cell, 1)
                up = len(values["Mesh"]["cells"]) - 1
                values["Materials"]["lower"]["Young's modulus"] = E
                values["Boundary conditions"]["ground"] = {"boundary": ("south", "bottom")[up - 1],
                                                           "foundation stiffness": [0.0] * up + [k]}
                values["Boundary conditions"]["load"]["confining pressure"] = "t < 2.5 ? 2e6 : 7e6"
                values["Stages"] = {"stiffer": {"time": 2.0, "Boundary conditions":
                                                {"ground": {"foundation stiffness": [0.0] * up + [stiffer]}}}}
                values["Time"] = {"schedule": [1.0, 2.0, 2.25, 3.0]}
                self.run_scene(self.write(values), ranks=ranks)
                exact = [-2e6 / k] * 3 + [-2e6 / k - 5e6 / stiffer]
                for row, u in zip(self.probe("face")[-4:], exact):
                    self.assertAlmostEqual(float(row[1 + up]), u, delta=1e-5 * 2e6 / k)
        ends = []
        for early in (False, True):  # changes of constants before any strain
            values = self.column("quadrilateral", 1)
            values["Mesh"]["cells"], values["Mesh"]["upper corner"] = [6, 6], [3.0, 3.0]
            values["Mesh"]["regions"] = {"upper": {"lower corner": [0.0, 2.0], "upper corner": [3.0, 3.0]},
                                         "corner": {"lower corner": [2.0, 0.0], "upper corner": [3.0, 1.0]}}
            del values["Regions"]
            values["Boundary conditions"] = {"west": values["Boundary conditions"]["west"],
                                             "ground": {"boundary": "south", "foundation stiffness": [0.0, 1e9]},
                                             "load": {"boundary": "north", "confining pressure": "t < 0.75 ? 0 : 2e6"}}
            values["Probes"] = {"at": {"point": [1.0, 0.0], "outputs": ["displacement"]}}
            stage = {"excavation": {"time": 2.0, "excavate": ["corner"]}}
            if early:
                stage["early"] = {"time": 0.5, "Materials": {"lower": {"Young's modulus": 12e9}}}
                values["Materials"]["lower"]["Young's modulus"] = 5e9
            else:
                values["Materials"]["lower"]["Young's modulus"] = 12e9
            values["Stages"] = stage
            values["Time"] = {"schedule": [0.5, 1.0, 2.0, 3.0]}
            self.run_scene(self.write(values))
            ends.append([float(v) for v in self.probe("at")[-1][1:]])
        for a, b in zip(*ends):
            self.assertAlmostEqual(a, b, delta=1e-9 * abs(ends[0][1]))

    def test_rock_that_no_entry_names(self):
        """Regions without a section have the material of the bulk, and its changes."""
        values = self.column("quadrilateral", 1)
        del values["Regions"], values["Stages"]["fill"], values["Stages"]["grout"]
        values["Materials"]["lower"]["Young's modulus"] = "modulus"
        values["Expressions"] = {"modulus": "1e10"}
        values["Boundary conditions"]["load"]["boundary"] = "north"
        values["Stages"]["softer"] = {"time": 2.0, "Expressions": {"modulus": "2e9"}}
        self.run_scene(self.write(values), "Time.schedule={1, 2, 3}")
        before, after = ([float(v) for v in row[1:]] for row in self.probe("top")[-2:])
        self.assertLess(before[1], 0)
        for a, b in zip(before, after):
            self.assertAlmostEqual(a, b, delta=1e-9 * max(1e-4, abs(b)))

    def test_wet_fill(self):
        """Fill in wet rock has the initial pressure and no stress when placed.

        Without further changes a short step causes no displacement, independently of earlier displacements of the
        walls."""
        options = [QUIET, "Stages.excavation.release=1 d", "Stages.fill.time=20 d", "Stages.fill.backfill={gallery}",
                   "Stages.fill.Regions.gallery.material=granite",
                   "Stages.fill.without={Boundary conditions > seepage}", "Time.schedule={86400, 172800, 1728000, 1728001}",
                   "Probes.inside.point={0, 0.6}", "Probes.inside.outputs={pressure, stress, displacement}",
                   "Probes.outside.point={8.3, 3.4}", "Probes.outside.outputs={pressure, displacement}"]
        root = ET.parse(self.scene("stages/gallery_2d.xml")).getroot()
        for parent in root.iter("ParameterList"):
            for child in list(parent):
                if child.get("name") in ("fractures", "lining", "decay") or (parent.get("name") == "Sprekk" and child.get("name") in ("Fractures", "Wells")):
                    parent.remove(child)
        path = self.folder / "wet.xml"
        path.write_bytes(ET.tostring(root))
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                self.run_scene(str(path), *options, ranks=ranks)
                pressure, *rest = [float(v) for v in self.probe("inside")[-1][1:]]
                initial = float(self.probe("outside")[-4][1])
                self.assertAlmostEqual(pressure, initial, delta=1e-2 * initial)
                for component in rest[:3]:
                    self.assertLess(abs(component), 2e4)  # of 10 MPa around it
                before, after = ([float(v) for v in row[1:]] for row in self.probe("outside")[-2:])
                self.assertGreater(abs(before[1]) + abs(before[2]), 1e-6)
                for a, b in zip(before[1:], after[1:]):
                    self.assertAlmostEqual(a, b, delta=1e-7)

    def test_springs_count_from_their_stage(self):
        """A gallery under isotropic stress gets a lining of springs after half of the release.

        The springs share the other half, p = k (u(end) - u(half)), with u = (P - p)/(2 G) at a wall of radius 1.
        Later changes of the springs have no effect."""
        P, k = 10e6, 8e9
        values = self.gallery(8)
        held = P * k / (2 * G) / 2 / (1 + k / (2 * G))  # spring traction at the end
        values["Bulk"]["initial stress"] = [-P, -P, 2 * NU * -P, 0.0]
        share = "max(min(t - 1, 1), 0)"
        values["Expressions"] = {"r2": "x^2 + y^2", **{f"u{a}": f"-(t <= 1 ? 0 : t <= 2 ? {P}*(t - 1)/2 : {P - held})/(2*{G})*{a}/r2" for a in "xy"}}
        del values["Stages"]["excavation"]["release"]
        values["Stages"]["excavation"]["release"] = 2.0
        values["Stages"]["lining"] = {"time": 2.0, "Boundary conditions": {"lining": {"boundary": "gallery", "foundation stiffness": [k, k]}}}
        values["Stages"]["softer"] = {"time": 4.0, "Boundary conditions": {"lining": {"foundation stiffness": [k / 3, k / 2]}}}
        values["Time"] = {"schedule": [1.0, 2.0, 3.0, 5.0]}
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                self.run_scene(self.write(values), ranks=ranks)
                for name in ("wall 0", "wall 2"):
                    half, end, _, softer = ([float(v) for v in row[1:]] for row in self.probe(name)[-4:])
                    x = [math.cos(math.pi / 8 * int(name[-1])), math.sin(math.pi / 8 * int(name[-1]))]
                    for i in range(2):
                        self.assertAlmostEqual(half[i], -P / 2 / (2 * G) * x[i], delta=1e-3 * P / (2 * G))
                        self.assertAlmostEqual(end[i], -(P - held) / (2 * G) * x[i], delta=1e-3 * P / (2 * G))
                        self.assertAlmostEqual(softer[i], end[i], delta=1e-9 * P / (2 * G))

    def test_end_does_not_depend_on_steps(self):
        """Without slip the end state does not depend on the steps: without release, in one step, in five."""
        ends = []
        for steps, release in ((1, False), (1, True), (5, True)):
            self.run_scene(self.write(self.gallery(4, steps=steps, release=release)))
            ends.append([float(v) for k in range(5) for v in self.probe(f"wall {k}")[-1][1:]])
        self.run_scene(self.write(self.gallery(4, steps=4)), "Time.schedule={1, 1.5}")
        half = [float(v) for k in range(5) for v in self.probe(f"wall {k}")[-1][1:3]]
        for end in ends[1:]:
            for a, b in zip(ends[0], end):
                self.assertAlmostEqual(a, b, delta=1e-10 * max(1, abs(a)))
        whole = [v for k in range(5) for v in ends[0][6 + 2 - 8 + k * (len(ends[0]) // 5):][:2]]
        for a, b in zip(half, whole):
            self.assertAlmostEqual(a, b / 2, delta=1e-12)


if __name__ == "__main__":
    main()
