#!/usr/bin/env python3
"""Energy balances of runs: energy_test.py PROGRAM ROOT MPIEXEC"""
import csv
import math

import growth_test
from program import ProgramTest, main

from perf.cohesive import cohesive
from perf.common import scene_file

ENERGY = ["Output.energy=true", "Output.vtu=false"]


class Energy(ProgramTest):
    def energies(self, scene, *sets, ranks=1):
        """Returns the steps of a run, and the energies of the last one."""
        steps = self.run_scene(scene, *ENERGY, *sets, ranks=ranks)["steps"]
        return steps, steps[-1]["energy"]

    def expect(self, found, exact, tolerance=1e-9):
        self.assertAlmostEqual(found / exact, 1, delta=tolerance)

    def test_block(self):
        """s^2 (1 - nu^2)/(2 E) per area, as work of a load, of prescribed displacements, and with an initial stress."""
        stress, area, compliance = 5e6, 6.0, (1 - 0.25**2) / 10e9
        exact = stress**2 * compliance / 2 * area
        cases = [("loads", []), ("loads", ["Time.steps=3", "Boundary conditions.load.traction={0, -5e6*t}"]),
                 ("supports", ["Boundary conditions.load.traction={}", f"Boundary conditions.load.displacement={{free, {-3 * stress * compliance}}}"]),
                 ("loads", ["Bulk.initial stress={0, -7e6, 0, 0}", "Boundary conditions.load.traction={0, -7e6 - 5e6*t}"])]
        for ranks in (1, 2):
            for cause, sets in cases:
                _, energy = self.energies("verification/uniaxial_2d.xml", *sets, ranks=ranks)
                self.expect(energy["elastic"], exact)
                self.expect(energy["work"][cause], exact)
                for other in {"loads", "supports"} - {cause}:
                    self.assertLess(abs(energy["work"][other]), 1e-12 * exact)
                self.assertLess(abs(energy["unassigned"]), 1e-9 * exact)

    def test_friction(self):
        """0.18 times the path of slip; the joint stores t^2/(2 K_t); both are the work on the fracture. The slip begins
        within a step, so the error of the work is of first order."""
        defects = []
        for ranks, n in ((1, 64), (2, 128)):
            steps, energy = self.energies("verification/cyclic_2d.xml", f"Time.steps={n}", ranks=ranks)
            slips = [0.0] + [step["fractures"]["fracture"]["mean_plastic_jump"]["local"][1] for step in steps]
            path = sum(abs(b - a) for a, b in zip(slips, slips[1:]))
            last = steps[-1]["fractures"]["fracture"]
            self.assertGreater(path, 1)
            self.expect(last["friction_energy"], 0.18 * path)
            stored = last["mean_traction"]["local"][1] ** 2 / (2 * 2)
            work = energy["work"]
            self.assertLess(abs(energy["unassigned"]), 1e-9 * work["supports"])
            defects.append(abs(-work["traction"] / (0.18 * path + stored) - 1))
        self.assertLess(defects[1], 0.01)
        self.assertLess(defects[1], 0.7 * defects[0])

    def test_restart(self):
        """The sums continue after a restart."""
        scene, sets = "verification/cyclic_2d.xml", [*ENERGY, "Output.checkpoints.steps=4"]
        words = [word for one in sets for word in ("--set", one)]
        complete = self.run_scene(scene, *sets)["steps"][-1]["energy"]
        self.call("run", self.scene(scene), "--output", "part", *words, "--set", "Time.end=4", "--set", "Time.steps=4")
        self.call("run", self.scene(scene), "--output", "part", *words, "--restart")
        continued = self.results("part")["steps"][-1]["energy"]
        self.expect(continued["elastic"], complete["elastic"])
        for name in ("supports", "traction"):
            self.expect(continued["work"][name], complete["work"][name])

    def test_beam(self):
        """While the front advances, the work of the ends is the increase of elastic and fracture energy. The latter agrees
        with the length of linear fracture mechanics."""
        scene_file.save(beam([64, 10], 4e6, 2), self.folder / "beam.xml", "Double cantilever beam.")
        steps, energy = self.energies(self.folder / "beam.xml")

        def change(of):
            return of(steps[-1]) - of(steps[len(steps) // 2 - 1])

        given = change(lambda step: step["energy"]["work"]["supports"])
        fracture = change(lambda step: step["fractures"]["growing"]["fracture_energy"])
        self.expect(change(lambda step: step["energy"]["elastic"]) + fracture, given, 0.002)
        self.assertLess(abs(energy["unassigned"]), 1e-9 * given)
        length = [(3 * 32e9 * 0.1**3 * delta**2 / (16 * 30)) ** 0.25 for delta in (1e-4, 2e-4)]  # a + 0.673 h
        self.expect(fracture, 30 * (length[1] - length[0]), 0.01)

    def test_steps_of_the_beam(self):
        """The work on the fracture is fracture energy and t . jump/2 of the bonds; the error of the work is of second order in
        the step. The zone has seven faces, so that they open without jumps."""
        scene_file.save(beam([40, 4], 3e6, 1), self.folder / "beam.xml", "Double cantilever beam.")
        bonds = ["Probes.bonds.line={0.005, 0, 0.395, 0}", "Probes.bonds.points=40", "Probes.bonds.outputs={plastic jump local, traction local}"]
        defects = []
        for n in (10, 20, 40):
            steps, energy = self.energies(self.folder / "beam.xml", f"Time.steps={n}", *bonds)
            rows = list(csv.reader((self.folder / "out/probes/bonds.csv").open()))[-40:]
            stored = sum(0.01 * float(row[4 + k]) * float(row[6 + k]) / 2 for row in rows for k in (0, 1))
            self.assertGreater(stored, 0.1)
            defects.append(abs((steps[-1]["fractures"]["growing"]["fracture_energy"] + stored) / -energy["work"]["traction"] - 1))
        self.assertLess(defects[0], 0.012)
        for coarse, fine in zip(defects, defects[1:]):
            self.assertLess(fine, 0.4 * coarse)

    def expect_same(self, found, expected, factor=1, tolerance=1e-10):
        """Energies of both steps, over the factor, agree within the tolerance times the largest one."""
        def flat(step):
            return [*step["energy"]["work"].values(), step["energy"]["elastic"], step["energy"]["unassigned"],
                    *(one[key] for one in step["fractures"].values() for key in ("fracture_energy", "friction_energy") if key in one)]
        largest = max(map(abs, flat(expected)))
        self.assertGreater(largest, 0)
        for one, other in zip(flat(found), flat(expected), strict=True):
            self.assertAlmostEqual(one / factor, other, delta=tolerance * largest)

    def test_beam_in_3d(self):
        """A beam in plane strain has the energies of 2D times its depth, except for its other bubbles of faces, on one and two ranks."""
        for name, depth in (("plane", ()), ("body", (0.1,))):
            scene_file.save(beam([20, 4], 3e6, 1, depth), self.folder / f"{name}.xml", "Double cantilever beam.")
        plane = self.energies(self.folder / "plane.xml", "Time.steps=10")[0][-1]
        one, two = (self.energies(self.folder / "body.xml", "Time.steps=10", ranks=ranks)[0][-1] for ranks in (1, 2))
        self.expect_same(one, plane, 0.1, 3e-3)
        self.expect_same(two, one)

    def test_friction_in_3d(self):
        """A cube, sheared along one axis: 0.18 times the path of slip, on one and two ranks; as the square 1 m deep, except for its bubbles of faces."""
        plane = self.energies("verification/cyclic_2d.xml", "Time.steps=8")[0][-1]
        steps = [self.energies("verification/cyclic_3d.xml", "Time.steps=8", ranks=ranks)[0] for ranks in (1, 2)]
        self.expect_same(steps[1][-1], steps[0][-1])
        slips = [(0.0, 0.0)] + [step["fractures"]["fracture"]["mean_plastic_jump"]["local"][1:] for step in steps[0]]
        last = steps[0][-1]
        self.expect(last["fractures"]["fracture"]["friction_energy"], 0.18 * sum(map(math.dist, slips, slips[1:])))
        self.expect(last["energy"]["work"]["traction"], plane["energy"]["work"]["traction"], 1e-3)
        self.assertLess(abs(last["energy"]["unassigned"]), 1e-9 * last["energy"]["work"]["supports"])

    def test_injection(self):
        """Pressure times injected volume is the work of the wells, and except for dissipation and compression that on the
        rock: elastic energy, work against the compression of the rock, and work on the fracture. Fracture energy and
        friction dissipate the latter, t . jump/2 is stored in the bonds. Short first steps resolve the opening of the notch,
        which is gradual with a small residual aperture."""
        schedule = [1e-3 * 3**k for k in range(7)] + [1.5 * k for k in range(1, 41)]
        bonds = ["Probes.bonds.line={1.1, 0, 11.9, 0}", "Probes.bonds.points=55", "Probes.bonds.outputs={plastic jump local, traction local}"]
        steps, energy = self.energies("growth/injection_2d.xml", f"Time.schedule={{{', '.join(map(str, schedule))}}}", "Materials.bonded joint.residual aperture=2e-6", *bonds)
        last, work, balance = steps[-1]["fractures"]["growing"], energy["work"], energy["balance"]
        self.assertEqual(max(step["fractures"]["growing"]["max_runaway_slip"] for step in steps), 0)  # of faces that part
        self.assertLess(abs(sum(balance.values())), 1e-6 * balance["wells"])
        self.assertLess(abs(energy["elastic"] - sum(work.values())), 1e-9 * work["face pressure"])
        rows = [row for row in csv.reader((self.folder / "out/probes/bonds.csv").open()) if row[0] == "60"]
        self.assertEqual(len(rows), 55)
        stored = sum(0.2 * float(row[4 + k]) * float(row[6 + k]) / 2 for row in rows for k in (0, 1))
        self.assertGreater(stored, 0)
        self.expect(-work["traction"], last["fracture_energy"] + last["friction_energy"] + stored, 0.01)
        wells = sum(step["wells"]["injector"]["pressure"] * step["wells"]["injector"]["rate"] * dt for step, dt in intervals(steps))
        self.expect(balance["wells"], wells, 1e-3)

    def test_growth(self):
        """Forces of loads s times displacements, 2 elastic/s, are the work of the loads. Between the loads s0 and s1, growth
        of the half crack between rollers at 0 and W = 2 from a to b releases s0 s1 (c(b) - c(a))/2, with the compliance
        c = -(4 W^2/(pi E')) ln cos(pi a/2W)."""
        for ranks, sets in ((1, []), (2, ["Time.schedule={1.4, 1.7}"])):
            steps, energy = self.energies("growth/edge_crack_2d.xml", *growth_test.Growth.STRAIGHT, *sets, ranks=ranks)
            loads = released = s0 = u0 = c0 = 0
            for step in steps:
                (x, _, _), = growth_test.tips(step)
                s1, c1 = 0.5e6 * step["time"], -32 / (math.pi * 32e9) * math.log(math.cos(math.pi * x / 4))
                u1 = 2 * step["energy"]["elastic"] / s1
                loads += (s0 + s1) / 2 * (u1 - u0)
                released += s0 * s1 * (c1 - c0) / 2
                s0, u0, c0 = s1, u1, c1
            self.expect(energy["work"]["loads"], loads, 1e-6)
            self.expect(energy["released"], released, 0.03)
            self.assertLess(abs(energy["unassigned"]), 1e-6 * loads)

    def test_refused_scheme(self):
        errors = self.call("check", self.scene("growth/injection_2d.xml"), "--set", "Output.energy=true", "--set", "Time.scheme=BDF2", expect=1)[1]
        self.assertIn('is "BDF2": Output > "energy" requires implicit Euler', errors)


def intervals(steps):
    """Yields each step with its length."""
    return zip(steps, (b - a for a, b in zip([0.0] + [step["time"] for step in steps], (step["time"] for step in steps))))


def beam(cells, strength, order, depth=()):
    """Scene of a double cantilever beam of bonded arms. `depth` (d,): hexahedra in plane strain."""
    none, is_3d = [0.0] * len(depth), bool(depth)
    sides = {name: {"boundary": name, "displacement": ["free", "free", 0.0]} for name in ("bottom", "top") if is_3d}
    return {"Mesh": {"cell": "hexahedron" if is_3d else "quadrilateral", "order": order, "lower corner": [0.0, -0.1, *none], "upper corner": [0.4, 0.1, *depth],
                     "cells": [*cells, *(1 for _ in depth)], "fractures": {"growing": {"lower corner": [0.0, 0.0, *none], "upper corner": [0.4, 0.0, *depth]}}},
            "Materials": cohesive.rock(strength, 30.0), "Bulk": {"material": "granite"},
            "Fractures": {"growing": {"material": "bonded joint", "unbroken": "x > 0.1"}},
            "Boundary conditions": {"ends": {"boundary": "west", "displacement": ["free", "(y > 0 ? 1 : -1)*1e-4*t", *("free" for _ in depth)]},
                                    "east": {"boundary": "east", "displacement": [0.0, 0.0, *none]}, **sides},
            "Time": {"end": 1.0, "steps": 20}}


if __name__ == "__main__":
    main()
