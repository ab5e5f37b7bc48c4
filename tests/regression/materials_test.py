#!/usr/bin/env python3
"""Material library: materials_test.py PROGRAM ROOT MPIEXEC"""
import csv
import math
import re
import unittest
import xml.etree.ElementTree as ElementTree

from program import ProgramTest, main

PUSH = "seed/push_2d.xml"
ROCK, JOINT = "Bulk.material=", "Fractures.fracture.material="


def reported(results):
    """Returns the results that do not depend on the clock, the folder or the names of materials."""
    return {key: results[key] for key in ("status", "steps")}


class Materials(ProgramTest):
    def library(self, kind):
        """Returns {name: {entry: value}} of the printed tables, without names of laws."""
        sets = {}
        for line in self.call("materials")[0].splitlines():
            cells = [cell.strip() for cell in line.split("|")[1:-1]]
            if len(cells) == 4 and cells[1] == kind:
                self.assertGreater(len(cells[3]), 20, f"{cells[0]} has no source")
                numbers = (re.fullmatch(r"(.+) (-?\d[\d.e+-]*)", item) for item in cells[2].split(", "))
                sets[cells[0]] = {found[1]: float(found[2]) for found in numbers if found}
        return sets

    def entries_of(self, path):
        """Returns {material: {entry: text}} of a scene file."""
        materials = ElementTree.parse(path).getroot().find("ParameterList[@name='Materials']")
        return {m.get("name"): {p.get("name"): p.get("value") for p in m} for m in materials}

    def test_every_set_is_accepted(self):
        for kind, place in (("elastic", ROCK), ("joint", JOINT)):
            sets = self.library(kind)
            self.assertGreaterEqual(len(sets), 8)
            for name in sets:
                with self.subTest(name=name):
                    self.call("check", self.scene(PUSH), "--set", place + name)

    def test_dilation_by_an_angle_above_friction_is_refused(self):
        """Dilation by an angle is rejected: mobilised friction is 0 at slip onset, and slip would create energy."""
        scene, joint = self.scene("point/shear_tests.xml"), "Materials.joint."
        sets = [word for entry in ("dilation=constant angle", "dilation angle=5") for word in ("--set", joint + entry)]
        err = self.call("point", scene, *sets, expect=1)[1]
        for words in ("after a slip of 0 m under 1 Pa the friction bound is 0 Pa", "the dilation angle, here 5 degrees, must not exceed the friction angle, "
                      "here 0 degrees", 'friction "mobilised Barton-Choubey" is 0 at the start of slip and requires dilation "mobilised"'):
            self.assertIn(words, err)
        self.call("point", scene, *sets, "--set", joint + "friction=Barton-Choubey")
        self.call("point", scene)

    def test_rocks_are_rocks(self):
        """Densities and compressional wave speeds are realistic."""
        for name, rock in self.library("elastic").items():
            if name == "Wollmann rock":
                continue
            E, nu, G, K = (rock.get(n) for n in ("Young's modulus", "Poisson's ratio", "shear modulus", "bulk modulus"))
            if E:
                G, K = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))
            elif K is None:
                K = rock["Lame's first parameter"] + 2 * G / 3
            with self.subTest(name=name):
                self.assertTrue(2000 <= rock["density"] <= 3300, rock)
                self.assertTrue(1500 <= math.sqrt((K + 4 * G / 3) / rock["density"]) <= 7500, rock)

    def test_pores_of_grains_of_one_mineral(self):
        """Pore compressibility at constant strain is (alpha - phi)/K_s with K_s = K/(1 - alpha), for one mineral."""
        n = 0
        for name, rock in self.library("elastic").items():
            if "Biot coefficient" in rock:
                E, nu, G = (rock.get(entry) for entry in ("Young's modulus", "Poisson's ratio", "shear modulus"))
                K = E / (3 * (1 - 2 * nu)) if E else rock["Lame's first parameter"] + 2 * G / 3
                alpha, phi = rock["Biot coefficient"], rock["porosity"]
                self.assertAlmostEqual(rock["compressibility of pores"] * K / ((alpha - phi) * (1 - alpha)), 1, delta=1e-3, msg=name)
                n += 1
        self.assertGreaterEqual(n, 4)

    def test_values_against_other_forms_of_their_sources(self):
        rocks = self.library("elastic")
        for name, compression, shear in (("granite", 3700, 2353), ("shale", 3292, 1768), ("sandstone", 4206, 2664)):  # waves, m/s
            rock = rocks[name]
            self.assertAlmostEqual(math.sqrt((rock["Lame's first parameter"] + 2 * rock["shear modulus"]) / rock["density"]), compression, delta=0.1)
            self.assertAlmostEqual(math.sqrt(rock["shear modulus"] / rock["density"]), shear, delta=0.1)
        K, G = rocks["claystone"]["bulk modulus"], rocks["claystone"]["shear modulus"]  # with E and nu in the source
        self.assertAlmostEqual(9 * K * G / (3 * K + G), 6.1065e9, delta=1e5)
        self.assertAlmostEqual((3 * K - 2 * G) / (6 * K + 2 * G), 0.3275, delta=1e-6)
        self.assertAlmostEqual(rocks["tonalite"]["Young's modulus"], 3.0e6 * 6894.757, delta=0.05e9)  # psi
        self.assertAlmostEqual(rocks["limestone"]["density"], 144 * 0.45359237 / 0.3048**3, delta=0.5)  # pounds per cubic foot

    def test_closure_against_its_regressions(self):
        joint, JRC, JCS = self.library("joint")["Bandis joint"], 10, 100  # -, MPa
        aperture = JRC / 5 * (0.2 - 0.1)  # mm
        self.assertAlmostEqual(joint["initial aperture"], aperture * 1e-3, delta=1e-9)
        self.assertAlmostEqual(joint["normal stiffness"], (-7.15 + 1.75 * JRC + 0.02 * JCS / aperture) * 1e9, delta=1e6)
        closure = -0.1032 - 0.0074 * JRC + 1.135 * (JCS / aperture)**-0.251
        self.assertAlmostEqual(joint["maximum closure"], closure * 1e-3, delta=1e-10)

    def test_rough_joints(self):
        """Roughness is as measured. Apertures are those of the closure regressions for fresh joints."""
        rough = {name: joint for name, joint in self.library("joint").items() if "joint roughness coefficient" in joint}
        measured = {15.32, 14.63, 1.96, 1.19, 15.6, 12.1, 4.23}
        self.assertEqual({joint["joint roughness coefficient"] for joint in rough.values()}, measured)
        for name, joint in rough.items():
            with self.subTest(name=name):
                self.assertAlmostEqual(joint["joint aperture"], joint["joint roughness coefficient"] / 50e3, delta=1e-12)
                self.assertEqual(joint["initial aperture"], joint["joint aperture"])
                self.assertIn(joint["joint wall strength"], (150e6, 153e6))

    def test_a_name_equals_the_values_written_out(self):
        named = self.run_scene(PUSH, ROCK + "granite", JOINT + "granite joint", output="named")
        written = self.run_scene(PUSH, "Materials.rock.shear modulus=14854721950",
                                 "Materials.rock.Lame's first parameter=7020826106", "Materials.joint.friction coefficient=0.6",
                                 "Materials.joint.tangential stiffness=infinite", output="written")
        other = self.run_scene(PUSH, output="other")
        self.assertEqual(reported(named), reported(written))
        self.assertNotEqual(reported(named), reported(other))

    def test_effective_input_has_the_set_in_full(self):
        first = self.run_scene(PUSH, ROCK + "claystone", JOINT + "claystone fault", output="first")
        entries = self.entries_of(self.folder / "first" / "effective_input.xml")
        self.assertEqual(set(entries), {"rock", "joint", "claystone", "claystone fault"})  # used or defined
        self.assertEqual(float(entries["claystone"]["bulk modulus"]), 5.9e9)
        self.assertEqual(float(entries["claystone fault"]["initial aperture"]), 1e-5)
        self.assertIn("DECOVALEX", entries["claystone"]["source"])
        again = self.run_scene(str(self.folder / "first" / "effective_input.xml"), output="again")
        self.assertEqual(reported(first), reported(again))

    def test_the_scenes_own_material_wins(self):
        own = self.scene(PUSH).read_text().replace('"rock"', '"granite"')
        (self.folder / "own.xml").write_text(own)
        results = self.run_scene(str(self.folder / "own.xml"))
        self.assertEqual(reported(results), reported(self.run_scene(PUSH, output="plain")))
        self.assertEqual(float(self.entries_of(self.folder / "out" / "effective_input.xml")["granite"]["shear modulus"]), 1e6)

    def test_a_point_takes_a_joint_of_the_library(self):
        path = "{-10e6*t, 0}"  # Pa
        out, _ = self.call("point", self.scene("point/cyclic_shear.xml"), "--set", "Point.material=Bandis joint", "--set", "Time.end=1",
                           "--set", "Time.steps=4", "--set", "Point.control={traction, traction}", "--set", f"Point.path={path}")
        rows = list(csv.DictReader(out.splitlines()))
        self.assertEqual([float(row["traction_n"]) for row in rows][-4:], [-2.5e6, -5e6, -7.5e6, -10e6])
        stiffness, closure = 20.35e9, 6.133625e-5
        for row in rows:  # hyperbola of Bandis, Lumsden and Barton (1983)
            shut = -float(row["jump_n"])
            self.assertAlmostEqual(-float(row["traction_n"]), stiffness * shut / (1 - shut / closure), delta=1)

    def test_wrong_names(self):
        for override, words in (
                (ROCK + "granit", ['Bulk > "material"', '"granit"', "elastic", '"rock"', "library", '"gneiss"', 'Did you mean "granite"?']),
                (JOINT + "granit joint", ['Fractures > fracture > "material"', '"joint"', '"Byerlee joint"', 'Did you mean "granite joint"?']),
                (JOINT + "granite", ['"granite"', "must be the name of a joint material", '"joint"', '"granite joint"'])):
            with self.subTest(override=override):
                _, err = self.call("check", self.scene(PUSH), "--set", override, expect=1)
                for word in words:
                    self.assertIn(word, err)
                self.assertIsNone(re.search(r'library:.*"(rock|joint)"', err), err)


if __name__ == "__main__":
    main()
