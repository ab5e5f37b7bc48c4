#!/usr/bin/env python3
"""Growth of fractures along free paths: wings of a flaw, a straight crack, ranks, restart, refused scenes: growth_test.py PROGRAM ROOT MPIEXEC"""

import math
import subprocess

from program import PROGRAM, ProgramTest, main

WINGS = "growth/wing_cracks_2d.xml"


def tips(step):
    """Returns (x, y, K_hoop) of the tips of a step, from left to right."""
    table = step["stress_intensity"]
    return sorted(zip(table["x"], table["y"], table["K_hoop"]))


class Growth(ProgramTest):
    def last_tip(self, output="out"):
        return tips(self.results(output)["steps"][-1])[-1][:2]

    def test_wings(self):
        """Path with K_II = 0 from a boundary integral method (steps of 0.1): tips at the lengths 0.1 to 0.6 of the wings, and the load t at which they grow further."""
        path = {1: (1.0290, 0.0957, 3.246), 2: (1.0662, 0.1885, 3.869), 4: (1.1578, 0.3662, 5.026), 6: (1.2647, 0.5352, 6.138)}
        found = {}
        for step in self.run_scene(WINGS, "Output.vtu=false")["steps"]:
            (x0, y0, _), (x1, y1, K) = tips(step)
            self.assertLess(math.hypot(x0 + x1, y0 + y1), 0.002)  # symmetric wings
            n = round(math.hypot(x1 - 1, y1) / 0.1)
            if n not in found and K > 0:  # K is proportional to the load
                found[n] = (x1, y1, step["time"] * 1e6 / K)
        for n, (x, y, load) in path.items():
            self.assertLess(math.hypot(found[n][0] - x, found[n][1] - y), 0.005)
            self.assertAlmostEqual(found[n][2], load, delta=0.01 * load)

    STRAIGHT = ["Output.vtu=false", "Mesh.lower corner={0, -4}", "Mesh.upper corner={2, 4}", "Mesh.cells={10, 40}", "Growth.segment=0.05",
                "Fractures.crack.toughness=1e6*(1 + 4*(x - 0.6))", "Time.schedule={1.4, 1.7, 2, 2.3, 2.6}",
                "Boundary conditions.west.boundary=west", "Boundary conditions.west.displacement={0, free}",
                "Boundary conditions.east.boundary=east", "Boundary conditions.east.displacement={0, free}"]

    @staticmethod
    def exact_length(load):
        """Length at which K = s sqrt(2 W tan(pi a/2W)) of a half crack between rollers at 0 and W = 2 is the toughness, for s = 0.5 MPa t."""
        a = 0.6
        while 0.5e6 * load * math.sqrt(4 * math.tan(math.pi * a / 4)) > 1e6 * (1 + 4 * (a - 0.6)):
            a += 1e-4
        return a

    @staticmethod
    def exact_energy(x):
        """Integral of K_c^2/E' over the new length up to x."""
        return 1e12 / 32e9 * ((1 + 4 * (x - 0.6)) ** 3 - 1) / 12

    def test_growth_after_closure(self):
        """A tip that has stopped grows again if the load rises, also after compression has closed the crack."""
        load = "0.5e6*(t - 3.1*(t > 2.05)*(t < 2.2))"
        sets = [*self.STRAIGHT[:5], "Fractures.crack.toughness=1e6*(1 + 4*(x - 0.6))", *self.STRAIGHT[7:], "Time.schedule={1.7, 2, 2.1, 2.3, 2.6}",
                f"Boundary conditions.top.traction={{0, {load}}}", f"Boundary conditions.bottom.traction={{0, -({load})}}"]
        steps = self.run_scene("growth/edge_crack_2d.xml", *sets)["steps"]
        for step, t in zip(steps, (1.7, 2, 2, 2.3, 2.6)):
            self.assertAlmostEqual(tips(step)[0][0], self.exact_length(t), delta=0.05)
        self.assertEqual([step["fractures"]["crack"]["area_open"] > 0 for step in steps], [True, True, False, True, True])

    def test_lost_energy(self):
        """At the load s, growth from a to b releases the integral of 2 W s^2 tan(pi x/2W)/E'. A constant toughness dissipates less: the rest is lost, in results, probes and tables."""
        sets = [*(one for one in self.STRAIGHT if "toughness" not in one and "schedule" not in one), "Growth.extensions per step=6", "Fractures.crack.toughness=1e6",
                "Time.schedule={1.5, 1.50001}", "Probes.crack.fracture=crack", "Probes.crack.outputs={area, fracture_energy, lost_energy}"]
        words = [word for one in sets for word in ("--set", one)]
        errors = self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "out", *words)[1]
        step = self.results()["steps"][0]
        (x, _, _), = tips(step)
        self.assertAlmostEqual(x, 0.9, delta=0.01)
        released = 0.75e6**2 * 16 / (math.pi * 32e9) * math.log(math.cos(0.6 * math.pi / 4) / math.cos(x * math.pi / 4))
        crack, growth = step["fractures"]["crack"], step["growth"]
        self.assertAlmostEqual(sum(growth["released"]) / released, 1, delta=0.02)
        self.assertAlmostEqual(crack["fracture_energy"], 1e12 / 32e9 * 0.3, delta=1e-6)
        self.assertAlmostEqual(crack["lost_energy"], released - 1e12 / 32e9 * 0.3, delta=0.02 * released)
        self.assertIn(f'unstable growth of "crack" by 0.3 m loses {crack["lost_energy"]:.4g} J/m', errors)
        rows = [row.split(",") for row in (self.folder / "out/probes/crack.csv").read_text().splitlines()]
        self.assertEqual(rows[0][1:], ["area [m]", "fracture_energy [J/m]", "lost_energy [J/m]"])
        for found, key in zip(rows[2][1:], ("area", "fracture_energy", "lost_energy")):  # after the initial state
            self.assertAlmostEqual(float(found), crack[key], delta=1e-9 * crack[key])
        table = (self.folder / "out/growth.csv").read_text().splitlines()
        self.assertEqual(table[0], "fracture,time [s],fracture_energy [J/m],length [m],lost_energy [J/m],released [J/m],x [m],y [m]")
        self.assertEqual(sum(row.startswith("crack,1.5,") for row in table), 6)

    def test_straight_growth(self):
        """A toughness that increases with the length makes the growth stable: the length follows the load, also after a restart."""
        for step in self.run_scene("growth/edge_crack_2d.xml", *self.STRAIGHT)["steps"]:
            (x, y, K), = tips(step)
            exact = self.exact_length(step["time"])
            self.assertLess(abs(y), 0.01)
            self.assertGreater(x, exact - 0.03)
            self.assertLess(x, exact + 0.05 + 0.03)
            self.assertLess(K, step["stress_intensity"]["toughness"][0])
            crack, (single,) = step["fractures"]["crack"], step["single_fractures"]["area"]
            self.assertAlmostEqual(crack["fracture_energy"], self.exact_energy(x), delta=1e-6 + 0.01 * self.exact_energy(x))
            self.assertAlmostEqual(single, crack["area"], delta=1e-12)
            self.assertEqual(crack["lost_energy"], 0)
        self.assertGreater(x, 0.9)
        table = (self.folder / "out/growth.csv").read_text()
        sets = [word for one in [*self.STRAIGHT, "Output.checkpoints.steps=1"] for word in ("--set", one)]
        self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "part", *sets, "--set", "Time.schedule={1.4, 1.7, 2}")
        self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "part", *sets, "--restart")
        self.assertLess(math.dist(self.last_tip("part"), (x, y)), 1e-6)
        part = self.results("part")
        self.assertAlmostEqual(part["steps"][-1]["fractures"]["crack"]["fracture_energy"], crack["fracture_energy"], delta=1e-9 * crack["fracture_energy"])
        self.assertAlmostEqual(part["single_fractures"][0]["area"], 0.6, delta=1e-12)
        self.assertEqual(len((self.folder / "part/growth.csv").read_text().splitlines()), len(table.splitlines()))

    def test_interrupted_growth(self):
        """A restart after an interruption in a step with extensions has the results of a complete run."""
        sets = [*self.STRAIGHT, "Time.schedule={1.4, 1.55, 1.7, 2}"]
        whole = self.run_scene("growth/edge_crack_2d.xml", *sets, output="whole")["steps"][-1]
        words = [str(PROGRAM), "run", str(self.scene("growth/edge_crack_2d.xml")), "--output", "part"]
        words += [word for one in [*sets, "Output.checkpoints.steps=2"] for word in ("--set", one)]
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, text=True) as run:
            for line in run.stdout:
                if "the step to 2 is repeated" in line:
                    run.terminate()
                    break
            run.stdout.read()
        self.assertEqual(run.returncode, 4)
        self.call(*words[1:], "--restart")
        part = self.results("part")["steps"][-1]
        for a, b in zip(part["growth"]["x"], whole["growth"]["x"], strict=True):
            self.assertAlmostEqual(a, b, delta=1e-6)
        energy = whole["fractures"]["crack"]["fracture_energy"]
        self.assertAlmostEqual(part["fractures"]["crack"]["fracture_energy"], energy, delta=1e-6 * energy)

    def test_failed_step(self):
        """A step that fails later leaves the table of the extensions before."""
        sets = [word for one in [*self.STRAIGHT, "Time.schedule={1.7, 2}", "Boundary conditions.top.traction={0, t > 1.8 ? 1e300 : 5e5*t}"] for word in ("--set", one)]
        self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "out", *sets, expect=3)
        table = (self.folder / "out/growth.csv").read_text().splitlines()
        self.assertIn("length [m]", table[0])
        self.assertEqual(len(table) - 1, len(self.results()["steps"][0]["growth"]["length"]))

    def test_ranks(self):
        """The same path on one and on three ranks."""
        tip, energy = {}, {}
        for ranks in (1, 3):
            self.run_scene("growth/edge_crack_2d.xml", *self.STRAIGHT, "Growth.segment=0.1", "Time.schedule={1.7}", ranks=ranks)
            tip[ranks] = self.last_tip()
            energy[ranks] = self.results()["steps"][-1]["fractures"]["crack"]["fracture_energy"]
        self.assertGreater(tip[1][0], 0.69)
        self.assertLess(math.dist(tip[1], tip[3]), 1e-6)
        self.assertAlmostEqual(energy[1], energy[3], delta=1e-6 * energy[1])

    INJECTION = [*(one for one in STRAIGHT if "toughness" not in one and "schedule" not in one),
                 "Boundary conditions.top.traction={0, 0}", "Boundary conditions.bottom.traction={0, 0}", "Materials.rock.permeability={0}",
                 "Materials.joint.residual aperture=1e-6", "Flow.viscosity=1e-6", "Flow.compressibility=4.5e-10", "Flow.initial pressure=0",
                 "Fractures.crack.source=x < 0.4 ? 1e-6/0.4 : 0"]

    def test_first_step_of_a_closed_notch(self):
        """Rounding of large flows in an iterate far from the solution does not hide its imbalance, 14 GPa in place of 0.08 MPa."""
        step, = self.run_scene("growth/edge_crack_2d.xml", *self.INJECTION, "Fractures.crack.toughness=1e15", "Time.schedule={2}")["steps"]
        crack = step["fractures"]["crack"]
        self.assertAlmostEqual(crack["fluid_volume"], 2e-6 + 1e-6 * 0.6, delta=1e-9)
        self.assertLess(crack["max_fracture_pressure"], 1e5)

    def test_injection(self):
        """Injection of 1e-6 m^2/s into impermeable rock: pressure of the fluid volume, and length at which this volume has the toughness."""
        rate, residual, E, W = 1e-6, 1e-6, 32e9, 2
        steps = self.run_scene("growth/edge_crack_2d.xml", *self.INJECTION, "Mesh.order=2", "Fractures.crack.toughness=1e6", "Time.schedule={2, 10, 20, 30, 40}")["steps"]

        def volume(a, pressure):  # opening of the half crack between rollers, from dv/da = 4 K^2/(E' p^2)
            return -8 * W**2 / (math.pi * E) * pressure * math.log(math.cos(math.pi * a / 2 / W))
        added = {"area": 0, "fluid_volume": 0}
        for step in steps:
            (x, y, _), = tips(step)
            crack, injected = step["fractures"]["crack"], rate * step["time"]
            self.assertAlmostEqual(crack["fluid_volume"], injected + residual * x, delta=1e-3 * injected)  # and nothing else
            self.assertAlmostEqual(volume(x, crack["mean_fracture_pressure"]), crack["fluid_volume"], delta=0.015 * crack["fluid_volume"])
            a = 0.6
            while volume(a, 1e6 / math.sqrt(2 * W * math.tan(math.pi * a / 2 / W))) < crack["fluid_volume"]:
                a += 1e-4
            added["area"] += step.get("added_by_growth", {}).get("area", 0)
            added["fluid_volume"] += step.get("added_by_growth", {}).get("fluid_volume", 0)
            self.assertAlmostEqual(added["area"], x - 0.6, delta=1e-9)
            self.assertAlmostEqual(added["fluid_volume"], residual * (x - 0.6), delta=1e-9 * residual)
            mass = crack["fluid_volume"] * (1 + 4.5e-10 * crack["mean_fracture_pressure"])  # of the reference density
            self.assertAlmostEqual(mass, injected + residual * 0.6 + added["fluid_volume"], delta=1e-6 * injected)
            self.assertGreater(x, a - 0.005)
            self.assertLess(x, a + 0.05 + 0.005)
        self.assertGreater(x, 0.79)

    def test_porous_rock(self):
        """The fluid of a well is in the pores and in the fracture, with new cells and faces, on one and on three ranks. Leak-off shortens the fracture."""
        entries = ["Output.vtu=false", "Mesh.cells={10, 20}", "Growth.segment=0.1", "Growth.faces=2"]
        tips_of = {}
        for ranks, times in ((1, "{10, 20, 30, 40, 50}"), (1, "{50}"), (3, "{50}")):
            entries[4:] = [f"Time.schedule={times}"]
            steps = self.run_scene("growth/porous_2d.xml", *entries, ranks=ranks)["steps"]
            for step in steps:
                parts = step["stored"]
                self.assertEqual(set(parts), {"fluid storage", "fracture storage", "poroelastic coupling"})
                self.assertAlmostEqual(sum(parts.values()), 1e-6 * step["time"], delta=1e-10 * 1e-6 * step["time"])
            self.assertGreater(parts["fluid storage"], 1e-2 * sum(parts.values()))
            self.assertAlmostEqual(sum(one.get("added_by_growth", {}).get("fluid_volume", 0) for one in steps),
                                   2e-6 * (steps[-1]["fractures"]["notch"]["area"] - 0.6), delta=1e-15)
            tips_of[ranks] = self.last_tip()
        self.assertGreater(tips_of[1][0], 0.69)
        self.assertLess(math.dist(tips_of[1], tips_of[3]), 1e-6)
        longer = self.run_scene("growth/porous_2d.xml", *entries, "Materials.rock.permeability={0}")["steps"][-1]
        self.assertGreater(tips(longer)[-1][0], tips_of[1][0])

    def test_stages(self):
        """A stage lowers the toughness: the fracture grows from then on, also after a restart. Stages that change regions are refused."""
        stage = ["Stages.weaker.time=1", "Stages.weaker.Fractures.crack.toughness=6e5*(1 + 4*(x - 0.6))"]
        sets = ["Fractures.crack.toughness=1e7" if "toughness" in one else one for one in self.STRAIGHT if "schedule" not in one]
        sets += ["Growth.segment=0.1", "Time.schedule={0.5, 1, 1.1, 1.2}", "Output.checkpoints.steps=1", *stage]
        steps = self.run_scene("growth/edge_crack_2d.xml", *sets)["steps"]
        lengths = [step["fractures"]["crack"]["area"] for step in steps]
        self.assertAlmostEqual(max(lengths[:2]), 0.6, delta=1e-12)
        self.assertGreater(lengths[2], 0.69)
        words = [word for one in sets for word in ("--set", one)]
        self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "part", *words, "--set", "Time.schedule={0.5, 1, 1.1}")
        self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "part", *words, "--restart")
        part = self.results("part")["steps"]
        self.assertAlmostEqual(part[-1]["fractures"]["crack"]["area"], lengths[-1], delta=1e-9)
        self.assertAlmostEqual(part[-1]["stress_intensity"]["K_I"][0], steps[-1]["stress_intensity"]["K_I"][0], delta=1e-3)
        for entry, text in (("excavate={bulk}", "Stages > weaker: changes the regions"), ("Growth.segment=0.2", "a stage cannot change it")):
            self.assertIn(text, self.call("check", self.scene("growth/edge_crack_2d.xml"), *words, "--set", f"Stages.weaker.{entry}", expect=1)[1])

    def test_segment_longer_than_the_notch(self):
        warnings = self.call("check", self.scene(WINGS), "--set", "Growth.segment=2.5")[1]
        self.assertIn('"segment": is 2.5 m, and the fracture "flaw" has a length of 2 m', warnings)
        self.assertNotIn('has a length of', self.call("check", self.scene(WINGS))[1])

    def test_unstable_growth(self):
        """A constant toughness at a constant load: growth ends with a warning after the given number of extensions, then at the boundary."""
        sets = [word for one in ["Output.vtu=false", "Growth.segment=0.2", "Growth.extensions per step=3", "Fractures.crack.toughness=5e5", "Time.steps=1"] for word in ("--set", one)]
        errors = self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "out", *sets)[1]
        self.assertIn("growth is unstable", errors)
        (x, _, K), = tips(self.results()["steps"][-1])
        self.assertAlmostEqual(x, 1.2, delta=0.01)
        self.assertGreater(K, 5e5)
        sets[-1] = "Time.steps=3"
        errors = self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "out", *sets)[1]
        self.assertIn("ends its growth: a boundary is nearer than half", errors)
        sets[-1:] = ["Output.checkpoints.steps=1", "--set", "Time.schedule={0.7, 1.4, 1.7, 2}"]
        self.assertIn("ends its growth", self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "part", *sets, "--set", "Time.schedule={0.7, 1.4, 1.7}")[1])
        errors = self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "part", *sets, "--restart")[1]
        for text in ("ends its growth", "cannot grow"):
            self.assertNotIn(text, errors)

    def test_tips_without_room(self):
        """A warning names the obstacle that is too near for stress intensity factors."""
        wall = ["Mesh.fractures.wall.lower corner={0.7, -1}", "Mesh.fractures.wall.upper corner={0.7, 1}", "Fractures.wall.material=joint"]
        stiff = ["Mesh.regions.stiff.lower corner={0.7, -2}", "Mesh.regions.stiff.upper corner={2, 2}", "Regions.stiff.material=steel",
                 "Materials.steel.type=elastic", "Materials.steel.Young's modulus=200 GPa", "Materials.steel.Poisson's ratio=0.25"]
        for entries, name in ((wall, "a fracture"), (stiff, "another rock"), (["Mesh.fractures.crack.upper corner={1.9, 0}"], "a boundary")):
            sets = ["Output.vtu=false", "Growth.segment=0.5", "Growth.faces=2", "Fractures.crack.toughness=1e7", "Time.steps=1", *entries]
            words = [word for one in sets for word in ("--set", one)]
            self.assertIn(f"cannot grow: it has no K, because {name} is too near", self.call("run", self.scene("growth/edge_crack_2d.xml"), "--output", "out", *words)[1])

    def test_junction(self):
        """A crack that meets another fracture ends there; the load then opens both."""
        wall = ["Mesh.fractures.wall.lower corner={1, -0.4}", "Mesh.fractures.wall.upper corner={1, 0.4}", "Fractures.wall.material=joint"]
        steps = self.run_scene("growth/edge_crack_2d.xml", "Output.vtu=false", "Growth.segment=0.1", "Fractures.crack.toughness=5e5", "Time.steps=2", *wall)["steps"]
        self.assertEqual(steps[-1]["stress_intensity"]["x"], [])
        crack, other = (steps[-1]["fractures"][name] for name in ("crack", "wall"))
        self.assertAlmostEqual(crack["area"], 1, delta=0.01)
        self.assertAlmostEqual(other["area"], 0.8, delta=1e-9)
        self.assertAlmostEqual(crack["area_open"], crack["area"], delta=1e-9)
        self.assertGreater(other["max_opening"], 0.1 * crack["max_opening"])

    def test_tips_that_meet(self):
        """Two tips that grow towards each other join to one fracture; both begin at the same load."""
        other = ["Mesh.fractures.other.lower corner={0.7, 0}", "Mesh.fractures.other.upper corner={1.8, 0}", "Fractures.other.material=joint"]
        toughness = [f"Fractures.{one}.toughness=5e5" for one in ("crack", "other")]
        step, = self.run_scene("growth/edge_crack_2d.xml", "Output.vtu=false", "Growth.segment=0.08", "Time.steps=1", *toughness, *other)["steps"]
        areas = [step["fractures"][one]["area"] for one in ("crack", "other")]
        self.assertAlmostEqual(sum(areas), max(1.8, *step["stress_intensity"]["x"], 0), delta=0.1)

    def test_refused_scenes(self):
        for entries, text in ((["Mesh.cell=quadrilateral"], "must be triangle"), (["Mesh.refinements=1"], "must be 0"),
                              (["Output.events.rate=1"], "must be absent"), (["Growth.faces=1"], "must be at least 2"),
                              (["Growth.segment=40"], '"segment": is 40 m, must be less than the smallest side of the mesh, 40 m'),
                              (["Fractures.flaw.toughness=1e6*(0.5 - x)"], 'is -500000 at (1, 0, 0), must be positive'), (["Fractures.flaw.toughness=-1e6"], 'must be positive (unit: Pa*m^0.5)')):
            sets = [word for one in entries for word in ("--set", one)]
            self.assertIn(text, self.call("check", self.scene(WINGS), *sets, expect=1)[1])
        for scene, entry, text in (("growth/edge_crack_2d.xml", "plastic jump={0.1}", "plastic jump\": not available with a \"toughness"),
                                   ("verification/penny.xml", "toughness=1e6", 'has other cells, must be triangle with "Growth"')):
            errors = self.call("check", self.scene(scene), "--set", "Growth.segment=0.1", "--set", "Fractures.crack.toughness=1e6", "--set", f"Fractures.crack.{entry}", expect=1)[1]
            self.assertIn(text, errors)
        errors = self.call("check", self.scene("growth/edge_crack_2d.xml"), "--set", "Growth.segment=0.1", expect=1)[1]
        self.assertIn("Fractures: none has a \"toughness\"", errors)

    def test_toughness_without_growth(self):
        for entry, warned in (("Growth.segment=0.1", False), ("Output.vtu=false", True)):
            out, warnings = self.call("check", self.scene("growth/edge_crack_2d.xml"), "--set", "Fractures.crack.toughness=1e6", "--set", entry)
            self.assertEqual("the fracture does not grow; add the section" in warnings, warned, warnings)


if __name__ == "__main__":
    main()
