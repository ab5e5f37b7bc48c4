#!/usr/bin/env python3
"""Warnings about implausible input: plausibility_test.py PROGRAM ROOT MPIEXEC COMMANDS

COMMANDS executes all checks of scenes in one process, see many_commands.py."""
import math
import re
import sys
import unittest

from many_commands import ManyCommands
from networks import mesh_of
from program import ROOT, ProgramTest, main

SHEAR = str(ROOT / "docs" / "shear_test.xml")
STRESS = ["Bulk.body force={0, 0}"]
PROCESSES = {}  # by number of ranks


def setUpModule():
    for ranks in (1, 2):
        PROCESSES[ranks] = ManyCommands(sys.argv[4], ranks)
        unittest.addModuleCleanup(PROCESSES[ranks].close)


class Plausibility(ProgramTest):
    def warnings(self, scene, *sets, ranks=1, expect=0, command="check", strict=False):
        words = [word for one in sets for word in ("--set", one)]
        if strict:
            words.append("--strict")
        if command == "check":
            status, _, err = PROCESSES[ranks].call(self.folder, command, scene, *words)
            self.assertEqual(status, expect, f"{words}\n{err}")
            return err
        words += ["--output", "out", "--set", "Output.vtu=false"]
        return self.call(command, scene, *words, ranks=ranks, expect=expect)[1]

    def test_plausible_scenes_have_none(self):
        for scene in (SHEAR, self.scene("poro/injection_days_2d.xml"), self.scene("tutorial/network.xml")):
            self.assertEqual(self.warnings(scene), "", scene)
            self.assertEqual(self.warnings(scene, strict=True), "", scene)

    def test_first_scene_of_the_readme(self):
        scene = re.search(r"^\./sprekk run (\S+)", (ROOT / "README.md").read_text(), re.MULTILINE)[1]
        mesh = mesh_of(self.folder, ROOT / scene) if 'name="network"' in (ROOT / scene).read_text() else "Output.every=1"
        self.assertEqual(self.warnings(ROOT / scene, mesh, command="run", strict=True), "")

    def test_what_where_why_what_to_do(self):
        """Each warning has the expected texts, on one and two ranks. With --strict it is an error."""
        cases = [
            (["Boundary conditions.shear.displacement={0.2*x*ramp(t), free}"], "Sprekk > Boundary conditions: displacements at t = 1 s differ by 0.375 m over 1.88 m of rock, 20 %",
             "small strains are assumed", "check the unit"),
            (["Materials.granite.Young's modulus=50"], "Young's modulus is 50 Pa, and there is a stress of 5e+06 Pa", "above 100 %", '"50 GPa"'),
            (["Materials.rough joint.tangential stiffness=20"], 'rough joint > "tangential stiffness": is 20 Pa/m next to rock with a modulus of 5e+10 Pa',
             "almost no resistance", '"10 GPa/m"'),
            (["Materials.rough joint.friction angle=0.61"], 'rough joint > "friction angle": is 0.61 degrees', "in radians", '"30 deg"'),
            (["Materials.rough joint.dilation angle=40"], 'rough joint > "dilation angle": is 40 degrees', "above the friction angle, 35 degrees", "give a smaller angle"),
            (["Mesh.fractures.shear plane.lower corner={0.5, 0.5}", "Boundary conditions.shear.displacement={0.2*ramp(t), free}"],
             "displacements at t = 1 s differ by 0.2 m over 1 m of rock, 20 %", "small strains are assumed", "check the unit"),
            (["Materials.rough joint.damage=isotropic"], 'rough joint > "damage": is "isotropic"', "has no effect", '"damage length of friction"'),
            (["Time.steps=1"], 'Sprekk > Time: 1 step goes over knots of the table "ramp", the first at t = 1 s', "loads are evaluated only at the ends of steps", '"schedule"'),
            ([*STRESS, "Bulk.initial stress={0, 5e6, 0, 0}"], "the initial stress is tension in 100 % of the cells, 5e+06 Pa", "which is negative", "check the signs"),
            ([f"Bulk.in-situ stress.{entry}" for entry in ("datum=0", "Sv=5e6", "Shmin=3e6")], "SHmax is 0 Pa in a depth of", "there Sv is 5e+06 Pa", 'give "SHmax" or "SHmax gradient"'),
            (["Bulk.body force={}", *(f"Bulk.in-situ stress.{entry}" for entry in ("datum=0", "Sv gradient=26e3", "SHmax gradient=3e4", "Shmin gradient=2e4"))],
             '"Sv gradient" is 2.6e+04 Pa/m', "the rock has no weight", "displaces the rock", '"gravity" in "Bulk"'),
            (["Boundary conditions.confinement.confining pressure=-5e6"], '> confinement > "confining pressure": is -5e+06 Pa', "pulls at the rock", "compression is positive"),
            ([*STRESS, "Bulk.initial stress={0, -5e6, 0, 4e6}"], 'a fracture is beyond the strength of the joint (100 % of the area): "shear plane"',
             "in the first step without any load", "check the initial stress"),
        ]
        for sets, *words in cases:
            for ranks in (1, 2):
                err = self.warnings(SHEAR, *sets, ranks=ranks)
                for text in words:
                    self.assertIn(text, err)
                self.assertTrue(all(line.startswith("warning: ") for line in err.splitlines()), err)
            err = self.warnings(SHEAR, *sets, strict=True, expect=1)
            self.assertIn(words[0], err)
            self.assertNotIn("warning", err)
        err = self.warnings(SHEAR, "Time.steps=1", command="run", strict=True, expect=1)
        self.assertIn("over knots", err)
        self.assertEqual(self.results()["status"], "failed")

    def test_degrees_celsius(self):
        scene = self.scene("heat/cooling_2d.xml")
        self.assertEqual(self.warnings(scene), "")
        err = self.warnings(scene, "Heat.initial temperature=180", "Boundary conditions.surface.temperature=20")
        for text in ('Heat > "initial temperature": is 180 K', 'surface > "temperature": is 20 K', "add 273.15"):
            self.assertIn(text, err)

    def test_injection_without_outlet(self):
        """The rock has 4e4 m^2. 3e-4 m^2/s exceed 1 % after 16 days, 1.5e-4 m^2/s not in 30 days."""
        scene, closed = self.scene("poro/injection_days_2d.xml"), self.folder / "closed.xml"
        closed.write_text(re.sub(r'\n *<Parameter name="pressure" type="string" value="10 MPa"/>', "", scene.read_text()))
        much, less = (f"Flow.Wells.injector.rate={rate}" for rate in (3e-4, 1.5e-4))
        for ranks in (1, 2):
            err = self.warnings(closed, much, ranks=ranks)
            for text in ("Sprekk > Flow > Wells: 415 m^2 of fluid enter until t = 1.382e+06 s, 1.04 % of the volume", "none leave",
                         "an equilibrium need not exist", "pressure at a boundary"):
                self.assertIn(text, err)
        self.assertEqual(self.warnings(closed, less) + self.warnings(scene, much), "")

    def test_channels(self):
        channels = self.scene("flow/channels_3d.xml")
        self.assertEqual(self.warnings(channels), "")
        for ranks in (1, 2):
            err = self.warnings(channels, "Mesh.fractures.east joint.upper corner={70, 40, 0}", ranks=ranks)
            self.assertIn('Flow > Intersections > shaft: its "fractures" do not meet: the channel has no effect', err)

    def test_leak_off(self):
        """A coefficient above that of any rock, the largest of an expression."""
        scene = self.scene("growth/leak_off_2d.xml")
        for value, expected in (("1", 1), ("1e-2*x/13", None), ("1e-5", None), ("1e-2*(1 + (x > 3))", 0.02)):
            for ranks in (1, 2):
                err = self.warnings(scene, f"Fractures.growing.leak-off coefficient={value}", ranks=ranks)
                self.assertEqual("rock has 1e-6 to 1e-3 m/s^0.5; check the unit" in err, expected is not None, err)
                if expected:
                    self.assertIn(f'Fractures > growing > "leak-off coefficient": reaches {expected:g} m/s^0.5', err)

    def test_opening_by_a_rate(self):
        """The pressure rises above the smallest principal compression in the plane; a hundredth of the rate is below."""
        scene, end = self.scene("poro/injection_days_2d.xml"), ["Time.end=86400", "Time.steps=1"]
        for rate, ranks, expected in (("4e-5", 1, 1), ("4e-5", 2, 1), ("4e-7", 1, 0)):
            err = self.warnings(scene, f"Flow.Wells.injector.rate={rate}", *end, command="run", ranks=ranks)
            self.assertEqual(err.count("Flow > Wells: the pressure in fractures exceeds the smallest principal compression"), expected, err)

    def test_cohesive_zone(self):
        scene = self.scene("earthquakes/spring_slider_2d.xml")
        self.assertEqual(self.warnings(scene), "")
        for ranks in (1, 2):
            err = self.warnings(scene, "Mesh.cells={2, 2}", ranks=ranks)
            for text in ('fracture "fault": a cell has an edge of 0.6 m, and the cohesive zone of a rupture is 0.471 m long', "use edges of at most 0.157 m"):
                self.assertIn(text, err)

    def test_process_zone(self):
        """The zone has 3.3 faces of 0.2 m at 2.2 MPa, 2.8 at 2.4 MPa. Longer faces far from the front do not count."""
        text, mesh = (ROOT / "xml/growth/injection_2d.msh").read_text(), self.folder / "stretched.msh"
        begin, nodes, end = re.split(r"(?<=\$Nodes\n)|(?=\$EndNodes)", text)
        mesh.write_text(begin + re.sub(r"(?m)^(\d+) (\S+) ", lambda at: f"{at[1]} {max(float(at[2]), 3 * float(at[2]) - 12)} ", nodes) + end)
        for strength, shown in (("2.2e6", ""), ("2.4e6", "the process zone has about 2.8 faces")):
            for ranks in (1, 2):
                err = self.warnings(self.scene("growth/injection_2d.xml"), f"Materials.bonded joint.tensile strength={strength}", f"Mesh file.path={mesh}", ranks=ranks)
                self.assertEqual("process zone" in err, shown != "", err)
                self.assertIn(shown, err)

    def test_sudden_loss_of_a_bond(self):
        """Fractures with an unbroken part have no such warning; others with the same joint do."""
        second = [f"Mesh.fractures.second.{corner}" for corner in ("lower corner={1, 1}", "upper corner={1.4, 1}")] + ["Fractures.second.material=joint"]
        bond = [f"Materials.joint.{entry}" for entry in ("bond=linear softening", "cohesion=5e6", "tensile strength=2e6", "fracture energy=0.1", "shear fracture energy=1")]
        for unbroken, expected in ((["crack"], True), (["crack", "second"], False)):
            err = self.warnings(self.scene("growth/edge_crack_2d.xml"), *second, *bond, *(f"Fractures.{name}.unbroken=1" for name in unbroken))
            self.assertEqual("the bond may break suddenly" in err, expected, err)

    def test_coefficient(self):
        err = self.warnings(self.scene("verification/cyclic_2d.xml"), "Materials.joint.friction coefficient=30")
        for text in ('Materials > joint > "friction coefficient": is 30', "rock has 0.2 to 1.2", '"friction angle"'):
            self.assertIn(text, err)

    def test_entries_of_single_fractures(self):
        """Own entries of single fractures are checked, each once; values of the material are not repeated."""
        text = (ROOT / "xml/networks/mapped.csv").read_text().replace(",0.55,", ",3,").replace(",0.35,", ",2,")
        (self.folder / "mapped.csv").write_text(text)
        scene = self.folder / "mapped.xml"
        scene.write_text(self.scene("networks/mapped_2d.xml").read_text())
        mesh = mesh_of(self.folder, scene)
        for ranks in (1, 2):
            err = self.warnings(scene, mesh, ranks=ranks)
            self.assertEqual(err.count("rock has 0.2 to 1.2"), 1)
            for words in ('fracture "A1" > "friction coefficient": is 3, with 3 others like it: rock has', 'friction coefficient of the fracture "A1" is 3: above about 1'):
                self.assertIn(words, err)
        err = self.warnings(scene, mesh, "Materials.mapped joint.friction coefficient=3")
        self.assertIn('mapped joint > "friction coefficient": is 3:', err)
        self.assertIn('fracture "A4" > "friction coefficient": is 2, with 1 other like it:', err)

    def test_hydraulic_opening(self):
        """Prescribed pressures above the smallest principal compression, in 2D of the directions in the plane."""
        text = self.scene("poro/injection_days_2d.xml").read_text()
        well = self.folder / "well.xml"
        well.write_text(text.replace('name="rate" type="string" value="4e-7*min(t/86400, 1)"', 'name="pressure" type="string" value="10e6 + t"'))
        plane = 27.5e6 - math.hypot(2.5e6, 7e6)  # of -30, -25 and 7 MPa
        space = 32.5e6 - math.hypot(7.5e6, 6e6)  # of -25, -40 and 6 MPa in the plane of x and z
        fluid = [*STRESS, "Bulk.initial stress={-8e6, -7e6, -1e6, 0}"]
        for scene, entry, section, bound, sets in (
                (well, "Flow.Wells.injector.pressure", "Flow > Wells > injector", plane, []),
                (well, "Boundary conditions.west.pressure", "Boundary conditions > west", plane, []),
                (self.scene("poro/injection_3d.xml"), "Boundary conditions.top.pressure", "Boundary conditions > top", space, ["Mesh.cells={10, 10, 10}"]),
                (SHEAR, "Fractures.shear plane.fluid pressure", "Fractures > shear plane", 7e6, fluid)):
            for factor, ranks in ((0.999, 1), (1.001, 1), (1.001, 2)):
                err = self.warnings(scene, *sets, f"{entry}={factor * bound}", ranks=ranks)
                self.assertEqual(err.count("(hydraulic opening)"), factor > 1, err)
                if factor > 1:
                    self.assertIn(f'Sprekk > {section} > "', err)
                    self.assertIn(f"reaches {factor * bound:.4g} Pa, and the smallest principal compression there is {bound:.4g} Pa", err)
        duration = 30 * 86400
        err = self.warnings(well, f"Flow.Wells.injector.pressure={plane} + 1e3*t/{duration}")  # above at the end only
        self.assertIn(f"reaches {plane + 1e3:.4g} Pa", err)

    def test_just_below(self):
        """Values at the bounds give no warning."""
        for sets in (["Boundary conditions.shear.displacement={0.2*ramp(t), free}"], ["Materials.rough joint.dilation angle=35"],
                     ["Time.schedule={1, 2}"], [*STRESS, "Bulk.initial stress={0, -5e6, 0, 3.5e6}"],
                     ["Materials.rough joint.damage=isotropic", "Materials.rough joint.damage length of friction=0.1",
                      "Materials.rough joint.residual part of friction=0.5"]):
            err = self.warnings(SHEAR, *sets)
            for text in ("differ by", "dilation angle\": is", "over knots", "beyond the strength", "has no effect"):
                self.assertNotIn(text, err)

    def test_synonyms(self):
        """Names of entries in other programs give an error with the name in Sprekk."""
        for name, meant in (("kn", "normal stiffness"), ("ks", "tangential stiffness"), ("shear stiffness", "tangential stiffness"),
                            ("cohesion", "bond"), ("JRC", "joint roughness coefficient"), ("JCS", "joint wall strength"), ("mu", "friction coefficient"),
                            ("phi", "friction angle"), ("psi", "dilation angle")):
            err = self.warnings(SHEAR, f"Materials.rough joint.{name}=1", expect=1)
            line = next(line for line in err.splitlines() if f'"{name}": unknown' in line)
            self.assertIn(meant, line)


if __name__ == "__main__":
    main()
