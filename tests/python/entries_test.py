"""Typed scenes: entries_test.py ROOT PROGRAM"""
import ast
import inspect
import re
import subprocess
import sys
import unittest
from pathlib import Path

import sprekk
from sprekk import entries
from sprekk.entries import Bulk, BoundaryCondition, Fracture, Material, Mesh, MeshFracture, Sprekk, Time

ROOT, PROGRAM = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()


def push():
    return Sprekk(
        mesh=Mesh(cell="quadrilateral", cells=[2, 2], lower_corner=[0, 0], upper_corner=[1, 1],
                  fractures={"fracture": MeshFracture(lower_corner=[0, 0.5], upper_corner=[1, 0.5])}),
        materials={"rock": Material(type="elastic", shear_modulus="1 MPa", lames_first_parameter=1e3),
                   "joint": Material(type="joint", tangential_stiffness=1e-5, friction_coefficient=1)},
        bulk=Bulk(material="rock"), fractures={"fracture": Fracture(material="joint")},
        boundary_conditions={"fixed": BoundaryCondition(boundary="south", displacement=[0, 0]),
                             "moved": BoundaryCondition(boundary="north", displacement=[1, -1])},
        time=Time(end=1, steps=1))


class Entries(unittest.TestCase):
    def test_typed_scene_is_the_file(self):
        file = sprekk.Scene(ROOT / "xml/seed/push_2d.xml")
        self.assertEqual(sprekk.Scene(push()).to_xml(defaults=True).replace("1000000", "1e6"),
                         file.to_xml(defaults=True).replace("1000000", "1e6"))

    def test_all_scenes_are_typed_ones(self):
        for path in sorted(ROOT.glob("xml/*/*.xml")):
            text = path.read_text()
            if 'name="Point"' in text or 'name="Specimens"' in text:
                continue
            with self.subTest(path.name):
                known = sprekk._sprekk.read_entries(str(path), sprekk.scene.MPI.COMM_SELF)
                self.assertEqual(Sprekk.from_entries(known).to_entries(), known)

    def test_every_entry_of_the_reference_is_an_attribute(self):
        reference = subprocess.run([PROGRAM, "reference"], capture_output=True, text=True, check=True).stdout
        names = {name for cls in vars(entries).values() if inspect.isclass(cls) and issubclass(cls, entries.Section)
                 for name in cls._names.values()}
        rows = re.findall(r"^\| ([^|]+) \| [^|]+ \| [^|]+ \|", reference.split("## Sprekk > Point")[0], re.MULTILINE)
        self.assertGreater(len(rows), 250)
        for name in set(rows) - {"name", "NAME"}:
            self.assertIn(name, names)

    def test_docstrings_tell_units_defaults_and_bounds(self):
        text = " ".join(Material.__doc__.split())
        self.assertIn("youngs_modulus: Young's modulus E; exactly two elastic constants are required;", text)
        self.assertIn("(between 0 and 1; default 1)", text)

    def test_misspelt(self):
        with self.assertRaisesRegex(AttributeError, 'Did you mean "friction_coefficient"'):
            Material(friction_coeficient=1)
        with self.assertRaisesRegex(AttributeError, 'Time has no entry "cells"'):
            push().time.cells = 3

    def test_what_is_wrong_is_reported_in_the_words_of_the_program(self):
        scene = push()
        scene.time.steps = 0
        with self.assertRaisesRegex(sprekk.Error, 'scene: Sprekk > Time > "steps": is 0, must be'):
            sprekk.Scene(scene)

    def test_stub_declares_all_classes(self):
        stub = ast.parse(Path(entries.__file__).with_suffix(".pyi").read_text())
        declared = {node.name: {line.target.id for line in node.body if isinstance(line, ast.AnnAssign)}
                    for node in stub.body if isinstance(node, ast.ClassDef)}
        self.assertGreater(len(declared), 30)
        for name, attributes in declared.items():
            self.assertEqual(attributes, set(getattr(entries, name)._names), name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
