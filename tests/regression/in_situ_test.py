#!/usr/bin/env python3
"""Joints in situ, with the aperture under the initial stress and pressure: in_situ_test.py PROGRAM ROOT MPIEXEC"""
import csv
import math
import shutil

from program import main
from stages import Stages

A, SLIP, TANGENT = 0.3e-3, 1e-3, math.tan(math.radians(3))  # aperture in situ, slip, dilation
K, MOST = 20e9, 0.2e-3                                       # of the hyperbola
P = 5e6
STRESS = {2: ["-25e6 + 1e5*y", "-20e6", "-22e6", "3e6"], 3: ["-25e6 + 1e5*y", "-20e6", "-22e6", "2e6", "-1e6", "1e6"]}
JUMP = {2: [SLIP], 3: [0.6 * SLIP, -0.8 * SLIP]}
BARTON = ["joint roughness coefficient=8", "joint wall strength=150e6"]
WORN = ["damage length of friction=5e-3", "residual part of friction=0.8", "damage length of dilation=3e-3"]
COULOMB = ["friction coefficient=0.6"]
HYPERBOLA = ["maximum closure=0.2 mm", f"normal stiffness={K}"]
LAWS = {
    "hyperbola": COULOMB + HYPERBOLA + ["dilation angle=3"],
    "linear": COULOMB + ["closure=linear", "normal stiffness=4e11", "dilation=decaying angle", "dilation angle=3", "dilation decay distance=1e-3"],
    "power": COULOMB + ["closure=power", "normal stiffness=50e9", "stiffening stress=1e6", "stiffening exponent=1", "dilation=limited",
                        "dilation angle=3", "largest dilation=4e-5"],
    "memory": COULOMB + HYPERBOLA + ["closure=Barton-Bandis with memory", "irrecoverable part of closure=0.4", "largest past compression=40e6"],
    "Bandis": BARTON + ["closure=Bandis", "friction=Barton-Choubey", "residual friction angle=30"],
    "mobilised": BARTON + HYPERBOLA + ["friction=mobilised Barton-Choubey", "dilation=mobilised", "residual friction angle=30", "peak slip=2e-3"],
    "damage": COULOMB + HYPERBOLA + WORN + ["damage=isotropic", "dilation angle=3", "damage driver=frictional work", "reference stress=5e6"],
    "directions": COULOMB + HYPERBOLA + WORN + ["damage=anisotropic", "dilation angle=3"],
    "bond": COULOMB + HYPERBOLA + ["bond=linear softening", "cohesion=2e6", "shear fracture energy=9e3", "tensile strength=1e6", "fracture energy=300"],
}


def joint_of(law):
    """Returns the entries of a joint."""
    return dict(entry.split("=") for entry in LAWS[law])


def block(dim, law):
    """Returns a block with a fracture under varying compression and one that ends inside, with flow and heat."""
    def box(*values):
        return list(values[:dim])
    fixed = {side: {"boundary": side, "displacement": box(0.0, 0.0, 0.0), "pressure": P, "temperature": 400}
             for side in ("west", "east", "south", "north", "bottom", "top")[:2 * dim]}
    joint = {"type": "joint", "tangential stiffness": "10e9", "initial aperture": A, "reference state": "in situ",
             "residual aperture": 1e-5, **joint_of(law)}
    return {
        "Mesh": {"cell": "triangle" if dim == 2 else "tetrahedron", "lower corner": box(0.0, 0.0, 0.0), "upper corner": box(40.0, 40.0, 40.0),
                 "cells": box(4, 4, 4), "fractures": {
                     "through": {"lower corner": box(20.0, 0.0, 0.0), "upper corner": box(20.0, 40.0, 40.0)},
                     "ends": {"lower corner": box(0.0, 10.0, 0.0), "upper corner": box(20.0, 10.0, 40.0)}}},
        "Materials": {"rock": {"type": "elastic", "Young's modulus": "40e9", "Poisson's ratio": 0.2, "permeability": [1e-17], "porosity": 0.01,
                               "Biot coefficient": 0.7, "compressibility of pores": 1e-11, "thermal conductivity": [2.8],
                               "volumetric heat capacity": "2.2e6", "thermal expansion": 8e-6}, "joint": joint},
        "Bulk": {"material": "rock", "initial stress": STRESS[dim]},
        "Flow": {"compressibility": 4.5e-10, "initial pressure": P},
        "Heat": {"initial temperature": 400, "fluid heat capacity": 4.2e6},
        "Fractures": {name: {"material": "joint", "plastic jump": JUMP[dim]} for name in ("through", "ends")},
        "Boundary conditions": fixed,
        "Probes": {**{f"{value} {name}": {"fracture": name, "outputs": ["aperture"], "value": value} for value in ("minimum", "maximum")
                      for name in ("through", "ends")},
                   **{f"{value} u": {"region": "bulk", "outputs": ["displacement"], "value": value} for value in ("minimum", "maximum")}},
        "Output": {"vtu": False},
        "Time": {"end": 1e5, "steps": 2}}


class InSitu(Stages):
    def run_block(self, tree, **options):
        """Runs a scene from a dict and returns its steps."""
        return self.run_scene(self.write(tree), **options)["steps"]

    def probe(self, name, output="out"):
        """Returns the rows of a probe without the time."""
        with open(self.folder / output / "probes" / f"{name}.csv") as file:
            return [[float(value) for value in row[1:]] for row in list(csv.reader(file))[1:]]

    def expect_rest(self, dim, aperture=A):
        for name in ("through", "ends"):
            for value in ("minimum", "maximum"):
                for (found,) in self.probe(f"{value} {name}"):
                    self.assertAlmostEqual(found, aperture, delta=1e-12 * aperture)
        for value in ("minimum", "maximum"):
            for row in self.probe(f"{value} u"):
                self.assertLess(max(map(abs, row)), 1e-12)

    def test_unchanged_loads_change_nothing(self):
        """Every law starts at rest with the given aperture, on any number of ranks, with flow and heat."""
        for k, law in enumerate(LAWS):
            for dim in (2, 3):
                with self.subTest(law=law, dim=dim):
                    (step, last) = self.run_block(block(dim, law), ranks=1 + (k + dim) % 3)
                    self.assertEqual(step["fractures"]["through"]["fraction_stick"], 1)
                    self.assertAlmostEqual(last["fractures"]["through"]["mean_slip"], SLIP, delta=1e-12)
                    self.expect_rest(dim)

    def test_hydraulic_aperture(self):
        """The given hydraulic aperture e belongs to the mechanical aperture sqrt(e JRC^2.5 micrometres)."""
        tree = block(2, "Bandis")
        tree["Materials"]["joint"].update({"reference state": "in situ hydraulic", "hydraulic aperture": "Barton", "initial aperture": 5e-5})
        self.run_block(tree)
        self.expect_rest(2, aperture=math.sqrt(5e-5 * 1e-6 * 8**2.5))

    def test_follows_the_path_of_the_unloaded_joint(self):
        """With the unloaded aperture by hand, an injection has the same results."""
        def injected(tree, output):
            tree["Flow"]["Wells"] = {"well": {"points": [20.0, 21.0], "radius": 0.1, "rate": "1e-9*t"}}
            tree["Time"]["steps"] = 4
            return self.run_block(tree, output=output)
        N = f"(25e6 - 1e5*y - {P})"
        for name in ("through", "ends"):
            measured, fresh = block(2, "hyperbola"), block(2, "hyperbola")
            del fresh["Materials"]["joint"]["reference state"]
            for tree in (measured, fresh):
                tree["Mesh"]["fractures"] = {name: tree["Mesh"]["fractures"]["through"]}
                tree["Fractures"] = {name: tree["Fractures"][name]}
                del tree["Probes"]
            fresh["Materials"]["joint"]["initial aperture"] = f"{A} + {N}/({K} + {N}/{MOST}) - {TANGENT!r}*{SLIP}"
            for a, b in zip(injected(measured, "measured"), injected(fresh, "fresh")):
                for quantity in ("mean_opening", "mean_slip", "max_slip"):
                    self.assertAlmostEqual(a["fractures"][name][quantity], b["fractures"][name][quantity], delta=1e-10 * SLIP)
                self.assertGreater(a["fractures"][name]["mean_slip"], 0)
            self.assertNotAlmostEqual(a["fractures"][name]["mean_opening"], self.results("fresh")["steps"][0]["fractures"][name]["mean_opening"], delta=1e-7)

    def test_restart(self):
        """History variables and unloaded apertures are the same after a restart."""
        for law in ("damage", "Bandis"):
            tree = block(2, law)
            for side in tree["Boundary conditions"].values():
                side["displacement"] = ["1e-8*y*t", "0"]
            tree["Output"]["checkpoints"] = {"steps": 1}
            whole = self.run_block(tree, output="whole", ranks=2)
            self.assertGreater(whole[1]["fractures"]["ends"]["max_slip"], SLIP)
            self.run_block({**tree, "Time": {"schedule": [5e4]}}, output="part", ranks=2)
            self.call("run", self.write(tree), "--output", "part", "--restart", ranks=2)
            self.assertEqual(whole[1]["fractures"], self.results("part")["steps"][1]["fractures"])
            shutil.rmtree(self.folder / "part")

    def test_stages(self):
        """A stage may weaken the joint below its initial shear traction; it cannot change the reference state."""
        tree = block(2, "hyperbola")
        tree["Stages"] = {"weak": {"time": 5e4, "Materials": {"joint": {"friction coefficient": 0.1}}}}
        first, second = self.run_block(tree)
        self.assertEqual(first["fractures"]["through"]["fraction_stick"], 1)
        self.assertGreater(second["fractures"]["ends"]["max_slip"], 1.01 * SLIP)
        tree["Stages"]["weak"]["Materials"]["joint"] = {"reference state": "unloaded"}
        self.refused(tree, 'Fractures > ends: "reference state": is unloaded, was in situ')

    def refused(self, tree, *texts, ranks=1):
        """Expects an error with these texts once."""
        _, errors = self.call("run", self.write(tree), ranks=ranks, expect=1)
        for text in texts:
            self.assertEqual(errors.count(text), 1, errors)

    def test_impossible_states(self):
        def changed(law="hyperbola", section="joint", **entries):
            tree = block(2, law)
            place = {"joint": tree["Materials"]["joint"], "Bulk": tree["Bulk"]}.get(section) or tree["Fractures"][section]
            place.update({name.replace("_", " "): value for name, value in entries.items()})
            return tree
        self.refused(changed(friction_coefficient=0.1), 'scene.xml: Sprekk > Materials > joint: fracture "', "the initial shear traction is 3e+06 Pa under",
                     "it must be at most the strength of the joint, ")
        self.refused(changed(section="Bulk", initial_stress=[-4e6, -2e7, -2e7, 0.0]), 'fracture "through" at (20, ',
                     "the initial normal traction is a tension of 1e+06 Pa; it must be compressive or 0")
        self.refused(changed("bond", "Bulk", initial_stress=[-3e6, -2e7, -2e7, 0.0]), "tension of 2e+06 Pa; it must be at most the tensile strength",
                     ranks=2)
        self.refused(changed(residual_aperture="0.4 mm"), "the hydraulic aperture in situ is 0.0003 m; it must be at least the \"residual aperture\", 0.0004 m")
        self.refused(changed(section="ends", plastic_jump=[10 * SLIP]), 'fracture "ends" at', "the aperture must be at least 0.000366", ranks=3)
        self.refused(changed("memory", largest_past_compression="10e6"), '"largest past compression": is 1e+07 Pa, must be at least')
        self.refused(changed("Bandis", initial_aperture="0.01 mm"), 'closure "Bandis" has no unloaded joint with the aperture 1e-05 m')
        self.refused(changed(initial_gap="1e-5"), '"initial gap": must be absent or 0 with "reference state" in situ')
        self.refused(changed(reference_state="unloaded", section="joint") | {"Fractures": {name: {"material": "joint", "slip path": 1} for name in ("through", "ends")}},
                     'Fractures > ends > "slip path": requires the "reference state" in situ')
        stressless = block(2, "hyperbola")
        del stressless["Bulk"]["initial stress"]
        self.refused(stressless, '"reference state": is in situ; it requires an "initial stress"')

    def test_warnings(self):
        def warnings(tree):
            return self.call("check", self.write(tree))[1]
        linear = block(2, "linear")
        linear["Bulk"]["initial stress"] = [-2e7, -2e7, -2e7, 0.0]
        del linear["Materials"]["joint"]["dilation"], linear["Materials"]["joint"]["dilation decay distance"], linear["Materials"]["joint"]["dilation angle"]
        # closure by 15 MPa and 0.3 mm times 4e11 Pa/m
        self.assertIn('fracture "through" in situ: a compression above 1.35e+08 Pa closes it by more than its aperture', warnings(linear))
        self.assertNotIn("in situ: ", warnings(block(2, "hyperbola")))
        two = block(2, "Bandis")
        two["Materials"]["joint"].update({"joint wall strength": 100e6, "initial aperture": 0.042e-3})
        two["Bulk"]["initial stress"] = [-1.3e7, -1.3e7, -1.3e7, 0.0]
        self.assertIn('fracture "ends" in situ: two unloaded apertures fit, 9.9', warnings(two))


if __name__ == "__main__":
    main()
