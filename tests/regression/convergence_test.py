#!/usr/bin/env python3
"""Simple steps need few iterations: convergence_test.py PROGRAM ROOT MPIEXEC [NUMBER OF RANDOM SCENES] [SEED]"""
import random
import sys

import program
from program import ProgramTest, main

from perf.common import scene_file

N_SCENES, SEED = (int(word) for word in (*sys.argv[4:6], *("12", "1")[len(sys.argv[4:6]):]))
BELOW_ROUND_OFF = [(3, 85)]  # (seed, scene): the flows of a step are below the round-off of the stored fluid
ROCK = {"type": "elastic", "Young's modulus": 25e9, "Poisson's ratio": 0.25}


def box(cell, n, size=1.0):
    dim = 2 if cell in ("triangle", "quadrilateral") else 3
    return dim, {"cell": cell, "lower corner": [0.0] * dim, "upper corner": [size] * dim, "cells": [n] * dim}


def joint_in(dim, size, begin=0.0, end=1.0):
    """Returns a fracture in the x direction (3D: x and y) at half the height."""
    return {"lower corner": [begin * size] * (dim - 1) + [size / 2], "upper corner": [end * size] * (dim - 1) + [size / 2]}


def held(dim):
    """Returns a section with rollers for each side except the top."""
    sides = (["west", "south"], ["east"]) if dim == 2 else (["west", "south", "bottom"], ["east", "north"])
    component = {"west": 0, "east": 0, "south": 1, "north": 1, "bottom": 2}
    return {side: {"boundary": side, "displacement": [0.0 if k == component[side] else "free" for k in range(dim)]}
            for side in (*sides[0], *sides[1])}


def small_change(draw):
    """Returns a random scene with small relative changes of temperature or pressure, and steps of unequal length."""
    kind = draw.choice(["heat", "flow", "poro", "thm"])
    heat, flow, deforms = kind in ("heat", "thm"), kind != "heat", kind in ("poro", "thm")
    size, n = 10**draw.uniform(-1, 3), 4
    dim, mesh = box(draw.choice(["triangle", "quadrilateral", "triangle", "quadrilateral", "tetrahedron", "hexahedron"]), n, size)
    fractured = kind != "heat" and draw.random() < 0.7
    if fractured:
        mesh["fractures"] = {"f": joint_in(dim, size, *draw.choice([(0, 1), (0.25, 0.75)]))}
    T, p = draw.choice([0, 300, 500]), draw.choice([0, 1e5, 1e7, 5e7])
    level, first = 10**draw.uniform(-10, 0), 10**draw.uniform(-2, 7)
    rock, joint = {"type": "elastic"}, {"type": "joint", "initial aperture": 1e-3}
    sides = {"west": {"boundary": "west"}, "east": {"boundary": "east"}}
    scene = {"Mesh": mesh, "Materials": {"rock": rock}, "Bulk": {"material": "rock"}}
    if deforms:
        rock.update(ROCK)
        sides = held(dim)
        top = "north" if dim == 2 else "top"
        sides["top"] = {"boundary": top, "traction": [0.0] * (dim - 1) + [-1.5 * p - 1e7]}
        joint.update({"friction coefficient": 0.6, "residual aperture": 1e-5})
    else:
        scene["Bulk"]["rigid"] = True
    if heat:
        rock.update({"thermal conductivity": [draw.uniform(1, 4)], "volumetric heat capacity": draw.uniform(1e6, 3e6)})
        if deforms:
            rock["thermal expansion"] = 1e-5
        scene["Heat"] = {"initial temperature": T}
        if flow:
            scene["Heat"]["fluid heat capacity"] = 4.2e6
        sides["west"]["temperature"] = f"{T} + {10 * level}*t/{first}"
    if flow:
        rock.update({"permeability": [10**draw.uniform(-20, -13)], "porosity": draw.uniform(0.01, 0.2)})
        if deforms:
            rock["Biot coefficient"] = draw.uniform(0.3, 1)
        scene["Flow"] = {"viscosity": 1e-3, "initial pressure": p, "compressibility": 4e-10}
        sides["west"]["pressure"], sides["east"]["pressure"] = f"{p} + {1e5 * level}*t/{first}", float(p)
        if fractured and dim == 2 and draw.random() < 0.5:
            scene["Flow"]["Wells"] = {"w": {"points": [size / 2] * 2, "radius": 1e-3 * size, "rate": 1e-7 * level}}
    if fractured:
        scene["Materials"]["joint"], scene["Fractures"] = joint, {"material": "joint"}
    scene["Boundary conditions"] = {side: section for side, section in sides.items() if len(section) > 1}
    times = [1e-3 * first, first, first * (1 + 10**-draw.uniform(3, 9))]
    scene["Time"] = {"schedule": times[draw.choice([0, 1]):], "scheme": draw.choice(["BDF2", "implicit Euler"])}
    return scene


class Convergence(ProgramTest):
    def run_tree(self, tree, *overrides, **options):
        path = self.folder / "scene.xml"
        scene_file.save(tree, path, "Written by convergence_test.py.")
        return self.run_scene(str(path), *overrides, **options)

    def cheap(self, results, maximum, label):
        for step in results["steps"]:
            self.assertLessEqual(step["newton_iterations"], maximum, f"{label}, t = {step['time']}")
            self.assertEqual(step["cuts"], 0, f"{label}, t = {step['time']}")

    def test_short_steps_of_heat_take_one_iteration(self):
        """The heat conducted in a short step is below the round-off of the heat stored in a cell."""
        for name, end in (("heat/cooling_2d.xml", 2e3), ("heat/cooling_2d.xml", 2e-2), ("heat/cooling_3d.xml", 2)):
            for scheme in ("BDF2", "implicit Euler"):
                results = self.run_scene(name, f"Time.end={end}", "Time.steps=5", f"Time.scheme={scheme}", "Output.vtu=false")
                self.cheap(results, 1, f"{name}, {end}, {scheme}")

    def test_small_changes_take_few_iterations(self):
        for seed, number in [(SEED, k) for k in range(N_SCENES)] + BELOW_ROUND_OFF:
            tree = small_change(random.Random(f"{seed} {number}"))
            tree["Output"] = {"vtu": False}
            self.cheap(self.run_tree(tree), 6, f"scene {number} of seed {seed}: {tree}")

    def sliding(self, dim, dilation):
        """Returns a scene with slip and dilation of a fault by injection, with constant well pressure after t = 1."""
        size = 20.0
        _, mesh = box("quadrilateral" if dim == 2 else "hexahedron", 8 if dim == 2 else 4, size)
        mesh["fractures"] = {"fault": joint_in(dim, size)}
        stress = [-6e6, -5.3e6, -6e6, 1.2e6] if dim == 2 else [-6e6, -6e6, -5.3e6, 0.0, 0.0, 1.2e6]
        ends = {side: {"boundary": side, "fracture": "fault", "pressure": 0.5e6} for side in ("west", "east")}
        points = [size / 2, size / 2] if dim == 2 else [9.0, 9.0, 8.0, 9.0, 9.0, 12.0]
        return {
            "Mesh": mesh,
            "Materials": {
                "rock": {**ROCK, "Young's modulus": 6e9, "permeability": [1e-30], "Biot coefficient": 0.0, "Biot modulus": 1e10},
                "joint": {"type": "joint", "friction angle": 22.0, "dilation angle": dilation, "tangential stiffness": 20e9,
                          "normal stiffness": 20e9, "initial aperture": 2.65e-4}},
            "Bulk": {"material": "rock", "initial stress": stress}, "Fractures": {"material": "joint"},
            "Flow": {"viscosity": 1e-3, "compressibility": 4.4e-10, "initial pressure": 0.5e6,
                     "Wells": {"well": {"points": points, "radius": 1e-4, "pressure": "0.5e6 + 4e6*min(t, 30)/30"}}},
            "Boundary conditions": {**{f"{side} end": section for side, section in ends.items()},
                                    **{side: {"boundary": side, "displacement": [0.0] * dim}
                                       for side in (("south", "north") if dim == 2 else ("bottom", "top"))}},
            "Time": {"schedule": [10.0, 20.0, 30.0, 100.0, *(10.0**k for k in range(3, 9)), 1.1e8, 1.2e8]}, "Output": {"vtu": False}}

    def test_steps_at_rest_take_no_more_than_one_iteration(self):
        for dim in (2, 3):
            for dilation in (0.0, 10.0):
                for ranks in (1, 2):
                    results = self.run_tree(self.sliding(dim, dilation), ranks=ranks)
                    slip = results["steps"][-1]["fractures"]["fault"]["max_slip"]
                    self.assertGreater(slip, 1e-5)
                    for step in results["steps"][-2:]:
                        self.assertLessEqual(step["newton_iterations"], 1, f"{dim}D, {dilation}, {ranks}: {step['time']}")

    def test_cohesion_holds_without_compression(self):
        """Pure shear below the cohesion: the joint sticks with traction G gamma, independently of round-off."""
        for cell, n, turned in (("quadrilateral", 2, 0), ("triangle", 6, 17), ("triangle", 12, 17), ("hexahedron", 2, 0), ("tetrahedron", 2, 0)):
            dim, mesh = box(cell, n)
            mesh.update({"periodic": ["x"] if dim == 2 else ["x", "y"], "fractures": {"joint": joint_in(dim, 1.0)}})
            if turned:
                mesh["rotation"] = float(turned)
            top = [f"1e-4*cos({turned}*pi/180)*t", f"1e-4*sin({turned}*pi/180)*t"] + ([0.0] if dim == 3 else [])
            for more in ({"bond": "constant cohesion"}, {"bond": "constant cohesion", "tangential stiffness": 1e12},
                         {"bond": "linear softening", "shear fracture energy": 1e4}):
                joint = {"type": "joint", "friction coefficient": 0.6, "cohesion": 10e6, **more}
                tree = {"Mesh": mesh, "Bulk": {"material": "rock"}, "Fractures": {"material": "joint"},
                        "Materials": {"rock": {"type": "elastic", "shear modulus": 12.5e9, "Poisson's ratio": 0.2}, "joint": joint},
                        "Boundary conditions": {
                            "floor": {"boundary": "south" if dim == 2 else "bottom", "displacement": [0.0] * dim},
                            "lid": {"boundary": "north" if dim == 2 else "top", "displacement": top}},
                        "Time": {"end": 1.0, "steps": 2}, "Output": {"vtu": False}}
                results = self.run_tree(tree)
                self.cheap(results, 2, f"{cell}, {n}, {more}")
                face = results["steps"][-1]["fractures"]["joint"]
                traction = face["mean_traction"]["local"]
                expected = 1e-4 / (1 / 12.5e9 + 1 / joint.get("tangential stiffness", float("inf")))
                self.assertAlmostEqual(sum(t * t for t in traction) ** 0.5 / expected, 1, 9, f"{cell}, {n}, {more}")
                self.assertEqual(face["fraction_stick"], 1)

    def test_nearly_equal_joints_slide(self):
        """Of two joints in series the weaker one slides, also with a very small difference."""
        for dim in (2, 3):
            for exponent, ranks in ((4, 1), (8, 1), (9, 2), (9.8, 1), (10, 1), (10, 2), (10.2, 1), (10.4, 1), (10.6, 2), (11, 1), (13, 2), (16, 1)):
                n = [2] * (dim - 1) + [6]
                mesh = {"cell": "quadrilateral" if dim == 2 else "hexahedron", "lower corner": [0.0] * dim, "upper corner": [1.0] * dim,
                        "cells": n, "periodic": ["x"] if dim == 2 else ["x", "y"],
                        "fractures": {name: {"lower corner": [0.0] * (dim - 1) + [height], "upper corner": [1.0] * (dim - 1) + [height]}
                                      for name, height in (("a", 1 / 3), ("b", 2 / 3))}}
                joints = {name: {"type": "joint", "friction coefficient": mu, "tangential stiffness": 2.0}
                          for name, mu in (("a", 0.5), ("b", 0.5 + 10**-exponent))}
                top = ["0.5*t", "-0.1"] if dim == 2 else ["0.4*t", "0.3*t", "-0.1"]
                tree = {"Mesh": mesh, "Bulk": {"material": "rock"}, "Fractures": {name: {"material": name} for name in joints},
                        "Materials": {"rock": {"type": "elastic", "Young's modulus": 1.0, "Poisson's ratio": 0.25}, **joints},
                        "Boundary conditions": {
                            "floor": {"boundary": "south" if dim == 2 else "bottom", "displacement": [0.0] * dim},
                            "lid": {"boundary": "north" if dim == 2 else "top", "displacement": top}},
                        "Time": {"end": 1.0, "steps": 2}, "Output": {"vtu": False}}
                results = self.run_tree(tree, ranks=ranks)
                normal, shear = 0.1 * 1.2, 0.5 * 0.1 * 1.2  # uniaxial strain: E (1-nu)/((1+nu)(1-2nu)) = 1.2
                faces = results["steps"][-1]["fractures"]
                for name in joints:
                    traction = faces[name]["mean_traction"]["local"]
                    self.assertAlmostEqual(traction[0], -normal, 8)
                    self.assertAlmostEqual(sum(t * t for t in traction[1:]) ** 0.5, shear, 8)
                slip = sum(faces[name]["mean_slip"] for name in joints)
                self.assertAlmostEqual(slip, 0.5 - shear / 0.4 - 2 * shear / 2, 8, f"{dim}D, 1e-{exponent}, {ranks}")

    def test_chosen_steps_end_where_a_rate_has_knots(self):
        """A rejected step of the minimum length is not repeated with the same length."""
        dim, mesh = box("triangle", 4, 10.0)
        mesh["fractures"] = {"f": joint_in(dim, 10.0)}
        tree = {"Mesh": mesh, "Bulk": {"material": "rock", "rigid": True}, "Fractures": {"material": "joint"},
                "Materials": {"rock": {"type": "elastic", "permeability": [1e-15], "porosity": 0.1},
                              "joint": {"type": "joint", "initial aperture": 1e-4}},
                "Flow": {"viscosity": 1e-3, "compressibility": 4e-10,
                         "Wells": {"w": {"points": [5.0, 5.0], "radius": 0.01, "rate": "q(t)"}}},
                "Tables": {"q": {"arguments": [0.0, 2.0, 3.0, 10.0], "values": [1e-6, 1e-6, 2e-6, 1e-6]}},
                "Boundary conditions": {"west": {"boundary": "west", "pressure": 0.0}},
                "Time": {"end": 10.0, "tolerance": 3e-3}, "Output": {"vtu": False}}
        for values in ([1e-6] * 4, [1e-6, 1e-6, 2e-6, 1e-6]):
            tree["Tables"]["q"]["values"] = values
            for minimum in (1e-8, 1e-3):
                tree["Time"]["smallest step"] = minimum
                results = self.run_tree(tree)
                self.assertEqual(results["status"], "completed")
                self.assertLess(len(results["steps"]), 400)
                for step in results["steps"]:
                    self.assertLessEqual(step["rejected"], 5)

    def test_temperatures_beyond_the_given_ones_are_reported(self):
        """A warning reports that a long first step of BDF2 overshoots after a sudden change.

        Implicit Euler does not."""
        for cell in ("quadrilateral", "hexahedron"):
            dim, mesh = box(cell, 4, 10.0)
            mesh["fractures"] = {"f": joint_in(dim, 10.0)}
            tree = {"Mesh": mesh, "Bulk": {"material": "rock", "rigid": True}, "Fractures": {"material": "joint"},
                    "Materials": {"rock": {"type": "elastic", "thermal conductivity": [2.0], "volumetric heat capacity": 2e6,
                                           "permeability": [1e-16], "porosity": 0.1},
                                  "joint": {"type": "joint", "initial aperture": 1e-3}},
                    "Flow": {"viscosity": 1e-3, "initial pressure": 0.0},
                    "Heat": {"initial temperature": 350.0, "fluid heat capacity": 4.2e6},
                    "Boundary conditions": {"in": {"boundary": "west", "pressure": 1e4, "temperature": 300.0},
                                            "out": {"boundary": "east", "pressure": 0.0}},
                    "Time": {"end": 4e8, "steps": 4}, "Output": {"vtu": False}}
            path = self.folder / "scene.xml"
            for ranks in (1, 2):
                for scheme, inlet, source, warns in (("BDF2", 300.0, "0", True), ("implicit Euler", 300.0, "0", False),
                                                     ("BDF2", "300 + t/1e10 - max(t - 1e8, 0)/1e10", "0", True),
                                                     ("BDF2", 300.0, "1e-9", True), ("BDF2", 300.0, "-1e-9", False)):
                    tree["Boundary conditions"]["in"]["temperature"] = inlet
                    tree["Heat"]["source"] = source
                    scene_file.save({**tree, "Time": {**tree["Time"], "scheme": scheme}}, path, "Written by convergence_test.py.")
                    _, err = self.call("run", path, "--output", "out", ranks=ranks)
                    self.assertEqual("K beyond the given ones, 300 to 350 K" in err, warns, f"{cell}, {ranks}, {scheme}, {source}: {err}")

    def test_joints_give_out_no_more_fluid_than_they_hold(self):
        """Closure beyond the initial aperture: the aperture ends at its bound, and the other fluid left the joint."""
        initial, residual, length = 2e-4, 1e-5, 1.0
        for dim in (2, 3):
            _, mesh = box("quadrilateral" if dim == 2 else "hexahedron", 4)
            mesh["fractures"] = {"crack": joint_in(dim, 1.0)}
            sides = held(dim)
            tree = {"Mesh": mesh, "Bulk": {"material": "rock"}, "Fractures": {"material": "joint"},
                    "Materials": {"rock": {**ROCK, "permeability": [1e-30], "Biot coefficient": 0.0, "Biot modulus": 1e12},
                                  "joint": {"type": "joint", "friction coefficient": 0.6, "normal stiffness": 1e10,
                                            "initial aperture": initial, "residual aperture": residual}},
                    "Flow": {"viscosity": 1e-3},
                    "Boundary conditions": {
                        **sides, "lid": {"boundary": "north" if dim == 2 else "top", "traction": [0.0] * (dim - 1) + ["-1e7*min(t/1e9, 1)"]},
                        "end": {"boundary": "west", "fracture": "crack", "pressure": 0.0}},
                    "Time": {"schedule": [1e8 * k for k in (1, 2, 3, 4, 6, 8, 10, 11)]}}
            results = self.run_tree(tree)
            out, before = 0.0, 0.0
            for step in results["steps"]:
                out -= step["inflows"]["west"] * (step["time"] - before)
                before = step["time"]
            self.assertAlmostEqual(out / ((initial - residual) * length), 1, 6)
            self.assertIn("more than its \"initial aperture\"", self.call("check", self.folder / "scene.xml")[1])

    def test_joints_that_weaken_slip_alike_on_any_number_of_ranks(self):
        """Injection causes slip with wear of joints.

        The final state does not depend on round-off and the number of ranks."""
        names = ("max_slip", "max_opening", "mean_fracture_pressure", "mean_hydraulic_aperture")
        ends = []
        for ranks in (1, 2, 3):
            results = self.run_scene(program.ROOT / "tests/data/injection_weakening_2d.xml", ranks=ranks)
            self.cheap(results, 60, f"{ranks} ranks")
            ends.append([[face[name] for face in results["steps"][-1]["fractures"].values()] for name in names])
        for end in ends[1:]:
            for name, one, other in zip(names, ends[0], end):
                self.assertLessEqual(max(abs(a - b) for a, b in zip(one, other)), 1e-8 * max(map(abs, one)), name)


if __name__ == "__main__":
    main()
