#!/usr/bin/env python3
"""Schema of scenes, for valid and invalid files: schema_test.py PROGRAM ROOT MPIEXEC"""
import re
import shutil
import subprocess
import unittest
from xml.etree import ElementTree

from program import ROOT, ProgramTest, main

SCENES = [*sorted((ROOT / "xml").rglob("*.xml")), *sorted((ROOT / "docs").glob("*.xml"))] if ROOT else []


@unittest.skipUnless(shutil.which("xmllint"), "xmllint is not installed (package libxml2-utils)")
class Schema(ProgramTest):
    def setUp(self):
        super().setUp()
        self.schema = self.folder / "sprekk.rng"
        self.schema.write_text(self.call("reference", "--schema")[0])

    def is_valid(self, text):
        path = self.folder / "scene.xml"
        path.write_text(text)
        done = subprocess.run(["xmllint", "--noout", "--relaxng", self.schema, path],
                              capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 3), done.stderr)  # 3: invalid file; other statuses: failure of xmllint
        return done.returncode == 0

    def test_meanings_are_those_of_the_reference(self):
        schema = ElementTree.parse(self.schema)
        in_schema = {one.text for one in schema.iter("{http://relaxng.org/ns/compatibility/annotations/1.0}documentation")}
        rows = re.findall(r"^\|.*(?<!\\)\| (.*) \|$", (ROOT / "docs" / "use" / "reference.md").read_text(), re.MULTILINE)
        meanings = {row.replace("\\|", "|") for row in rows} - {"meaning"}
        self.assertGreater(len(meanings), 200)
        self.assertEqual(meanings - in_schema, set())

    def test_every_scene_is_valid(self):
        self.assertGreater(len(SCENES), 15)
        for path in SCENES:
            with self.subTest(path=path):
                self.assertTrue(self.is_valid(path.read_text()))

    def test_the_complete_input_of_a_run_is_valid(self):
        self.run_scene(ROOT / "docs" / "shear_test.xml", "Time.steps=1", "Time.end=0.1")
        self.assertTrue(self.is_valid((self.folder / "out" / "effective_input.xml").read_text()))

    def test_what_is_wrong_is_not_valid(self):
        shear, push, point = (ROOT / "docs" / "shear_test.xml", ROOT / "xml" / "seed" / "push_2d.xml",
                              ROOT / "xml" / "point" / "cyclic_shear.xml")
        for path, old, new in (
                (shear, 'name="Solver"', 'name="Solvr"'),
                (shear, 'name="Sprekk"', 'name="Speck"'),
                (shear, 'name="dilation angle"', 'name="dilatation angle"'),
                (shear, 'value="30 GPa/m"', 'value="stiff"'),
                (shear, 'name="steps" type="int" value="20"', 'name="steps" type="int" value="20.5"'),
                (shear, 'name="steps" type="int" value="20"', 'name="steps" type="double" value="20"'),
                (shear, 'name="steps" type="int"', 'name="steps"'),
                (shear, 'name="tolerance" type="double" value="1e-10"', 'name="tolerance" type="double" value="1e-10 m"'),
                (shear, 'value="{16, 8}"', 'value="{16, 8.5}"'),
                (shear, 'value="{16, 8}"', 'value="16, 8"'),
                (shear, 'value="{0, -26.5 kN/m^3}"', 'value="{0, much}"'),
                (shear, 'type="bool" value="true"', 'type="bool" value="yes"'),
                (shear, 'value="triangle"', 'value="triangel"'),
                (shear, 'value="joint"', 'value="joynt"'),
                (shear, '<Parameter name="boundary" type="string" value="south"/>', ""),
                (shear, '<Parameter name="cell" type="string" value="triangle"/>', ""),
                (shear, '<Parameter name="cells" type="Array(int)" value="{16, 8}"/>', ""),
                (shear, '<Parameter name="every" type="int" value="5"/>', '<Parameters name="every"/>'),
                (push, '<ParameterList name="Mesh">', '<ParameterList name="Mesh"><ParameterList name="Time"/>'),
                (point, '<Parameter name="material" type="string" value="joint"/>', ""),
                (point, 'name="Point"', 'name="Bulk"')):
            text = path.read_text()
            self.assertIn(old, text)
            with self.subTest(scene=path.name, old=old, new=new):
                self.assertFalse(self.is_valid(text.replace(old, new, 1)))

    def test_order_is_free(self):
        text = (ROOT / "docs" / "shear_test.xml").read_text()
        entries = re.search(r'(<Parameter name="cell".*?/>)(.*?)(<Parameter name="cells".*?/>)', text, re.DOTALL)
        self.assertTrue(self.is_valid(text.replace(entries[0], entries[3] + entries[2] + entries[1])))

    def test_one_material_of_all_fractures(self):
        """Sections of fractures may omit the material that the section of all fractures names."""
        text = (ROOT / "xml" / "networks" / "shapes_3d.xml").read_text()
        own = '<Parameter name="material" type="string" value="joint"/>'
        begin = text.rindex('<ParameterList name="Fractures">')
        shared = '<ParameterList name="Fractures">' + own + text[begin:].split(">", 1)[1].replace(own, "")
        self.assertGreater(text.count(own, begin), 1)
        self.assertTrue(self.is_valid(text[:begin] + shared))

    def test_other_ways_to_write_a_value(self):
        for old, new in (('type="double" value="50 GPa"', 'type="string" value="5e10*(1 + x)"'),
                         ('type="double" value="50 GPa"', 'type="int" value="5000000"'),
                         ('value="35 deg"', 'value="35°"'),
                         ('type="Array(double)" value="{0, -26.5 kN/m^3}"', 'type="Array(string)" value="{0, -1e3*x}"'),
                         ('type="Array(double)" value="{2, 1}"', 'type="Array(int)" value=" { 2 , 1 } "'),
                         ('type="double" value="20 GPa/m"', 'type="double" value="infinite"')):
            text = (ROOT / "docs" / "shear_test.xml").read_text()
            self.assertIn(old, text)
            with self.subTest(new=new):
                self.assertTrue(self.is_valid(text.replace(old, new, 1)))


if __name__ == "__main__":
    main()
