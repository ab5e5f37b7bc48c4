#!/usr/bin/env python3
"""From files and scenes to meshes and runs: program_test.py PROGRAM ROOT MPIEXEC"""
import contextlib
import importlib.util
import io
import json
import os
import shutil
import subprocess
import sys
import time
import unittest
import warnings
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
import program  # noqa: E402
from conformity import DEFAULTS, as_xml  # noqa: E402
from program import ROOT, ProgramTest, main  # noqa: E402

spec = importlib.util.spec_from_file_location("sprekk_mesh", ROOT / "apps" / "mesh" / "__main__.py")
app = importlib.util.module_from_spec(spec)
spec.loader.exec_module(app)

SQUARE = {"lower corner": [0.0, 0.0], "upper corner": [1.0, 1.0]}
REST = """<ParameterList name="Materials"><ParameterList name="joint"><Parameter name="type" type="string" value="joint"/>
<Parameter name="friction coefficient" type="double" value="0.6"/></ParameterList></ParameterList>
<ParameterList name="Bulk"><Parameter name="material" type="string" value="granite"/></ParameterList>
<ParameterList name="Fractures"><ParameterList name="set"><Parameter name="material" type="string" value="joint"/></ParameterList></ParameterList>
<ParameterList name="Boundary conditions">
<ParameterList name="floor"><Parameter name="boundary" type="string" value="FLOOR"/><Parameter name="displacement" type="Array(double)" value="ZERO"/></ParameterList>
<ParameterList name="roof"><Parameter name="boundary" type="string" value="ROOF"/><Parameter name="displacement" type="Array(double)" value="DOWN"/></ParameterList>
</ParameterList>"""


class MeshTest(ProgramTest):
    def write(self, name, *lines):
        path = self.folder / name
        path.write_text("\n".join(lines) + "\n")
        return path

    def scene(self, name="scene.xml", dim=2, **network):
        """Writes a scene with a network under compression from the top."""
        floor, roof = ("south", "north") if dim == 2 else ("bottom", "top")
        zeros = ", ".join(["0"] * (dim - 1))
        rest = REST.replace("FLOOR", floor).replace("ROOF", roof).replace("ZERO", f"{{{zeros}, 0}}").replace("DOWN", f"{{{zeros}, -1e-3}}")
        if dim == 2:
            network.setdefault("domain", SQUARE)
        described = as_xml("network", {key.replace("_", " "): value for key, value in network.items()})
        return self.write(name, '<ParameterList name="Sprekk"><ParameterList name="Mesh file">', described, "</ParameterList>", rest, "</ParameterList>")

    def mesh(self, scene, *words, expect=0, output="net.msh"):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = app.main([str(scene), "-o", str(self.folder / output), "--program", str(program.PROGRAM), *words])
        self.assertEqual(status, expect, out.getvalue() + err.getvalue())
        return err.getvalue() if expect else out.getvalue()

    def report(self, output="net.msh"):
        return json.loads((self.folder / f"{output}.json").read_text())

    def refused(self, file, *expected, kind=None, **network):
        """Checks the error: the number of its lines, and a text in each line."""
        described = {"file": file.name, **({"format": kind} if kind else {})}
        reported = self.mesh(self.scene(fractures={"set": described}, **network), expect=1).removeprefix("sprekk: ").splitlines()
        self.assertEqual(len(reported), len(expected), reported)
        for line, words in zip(reported, expected):
            self.assertIn(words, line)


class Files(MeshTest):
    """Input files. A mock returns the description of the network, to avoid a start of the program."""

    def scene(self, **network):
        network.setdefault("domain", SQUARE)
        for content in network["fractures"].values():
            content["file"] = str(self.folder / content["file"])
        if network.pop("dim", 2) == 3 and network["domain"] is SQUARE:
            del network["domain"]
        else:
            network["domain"] = {"corners": [], "faces": {}, **network["domain"]}
        text = as_xml("network", {**DEFAULTS, **network})
        patch = mock.patch.object(app, "description", lambda options: text)
        patch.start()
        self.addCleanup(patch.stop)
        return "scene.xml"

    def test_lines(self):
        self.write("net.csv", "id,x0,y0,x1,y1", "# a comment", "7,0.2,0.5,0.8,0.5", "", "8,0.5,0.2,0.5,0.8")
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertAlmostEqual(self.report()["sets"]["set"]["length"], 1.2, 9)

    def singles(self, output="net.msh"):
        """Returns (name, entries) of the single fractures in the mesh file."""
        content = (self.folder / output).read_bytes()
        lines = content[content.index(b"$Fractures") : content.index(b"$EndFractures")].decode().splitlines()[2:]
        found = [line.split('"')[1::2] for line in lines]
        return [(name, dict(zip(entries[::2], entries[1::2]))) for name, *entries in found]

    def test_single_fractures(self):
        """Names of fractures are from a column or the number.

        Other columns may have units. One name means one fracture."""
        self.write("net.csv", "name,x0,y0,x1,y1,friction coefficient,initial aperture [mm]", "A,0.2,0.5,0.4,0.5,0.4,0.1", "A,0.4,0.5,0.8,0.6,0.4,0.1",
                   "B,0.5,0.2,0.5,0.4,,", '"C, left",0.1,0.1,0.2,0.2,0.7')
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertEqual(self.singles(), [("A", {"friction coefficient": "0.4", "initial aperture": "0.1 mm"}), ("B", {}),
                                          ("C, left", {"friction coefficient": "0.7"})])
        self.write("net.csv", "7,0.2,0.5,0.4,0.5", "8,0.5,0.2,0.5,0.4")
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertEqual(self.singles(), [("set 7", {}), ("set 8", {})])
        self.write("net.csv", "friction angle (deg),Y1,X1,y0 [m],x0,FID", "30,0.5,0.4,0.5,0.2,7")
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertEqual(self.singles(), [("set 7", {"friction angle": "30 deg"})])
        self.write("net.csv", "name,dilation angle,x0,y0,z0,x1,y1,z1,x2,y2,z2", "P,5,0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}, **self.CUBE))
        self.assertEqual(self.singles(), [("P", {"dilation angle": "5"})])

    def test_bad_names(self):
        net = self.write("net.csv", "name,x0,y0,x1,y1,friction angle", "A,0.2,0.5,0.4,0.5,30", "A,0.4,0.5,0.8,0.6,31")
        self.refused(net, f'fracture A ({net}: line 3): has the name "A", as fracture A ({net}: line 2), but different values')
        net = self.write("net.csv", "name,x0,y0,x1,y1", "A,0.2,0.5,0.4")
        self.refused(net, f'{net}: line 2: has no number in column 5, "y1"')
        other = self.write("other.csv", "name,x0,y0,x1,y1", "A,0.2,0.2,0.4,0.2")
        self.write("net.csv", "name,x0,y0,x1,y1", "A,0.2,0.5,0.4,0.5")
        reported = self.mesh(self.scene(fractures={"one": {"file": "net.csv"}, "two": {"file": "other.csv"}}), expect=1)
        self.assertIn(f'fracture A ({other}: line 2): has the name "A", as fracture A ({net}: line 2) of another set', reported)

    def test_parts_of_one_fracture(self):
        """Rows with one name or number form one fracture if they meet at ends or along sides, as reported.

        Otherwise the error names both places."""
        rows = "7,0.2,0.5,0.4,0.5", "8,0.5,0.2,0.5,0.4", "7,0.6,0.6,0.8,0.6", "7,0.4,0.5,0.6,0.6"
        self.write("net.csv", *rows)
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertEqual([name for name, _ in self.singles()], ["set 7", "set 8"])
        self.assertEqual(self.report()["sets"]["set"]["fractures"], 2)
        net = self.folder / "net.csv"
        one, other = (f"fracture 7 ({net}: line {k})" for k in (1, 3))
        self.assertIn(f'one fracture, "set 7", of 3 parts: {one}, {other} and 1 more', self.report()["repairs"])
        apart = f'{other}: has the name "set 7", as {one}, and does not meet it; parts of one fracture meet at'
        self.write("net.csv", *rows[:3])
        self.refused(net, apart)
        self.write("net.csv", *rows[:2], "7,0.3,0.2,0.3,0.8")  # crosses the first row
        self.refused(net, apart)
        self.write("net.csv", "name,x0,y0,x1,y1", "A,0.2,0.5,0.4,0.5", "A,0.6,0.6,0.8,0.6")
        one, other = (f"fracture A ({net}: line {k})" for k in (2, 3))
        self.refused(net, f'{other}: has the name "A", as {one}, and does not meet it')
        self.write("net.csv", "7,0.2,0.5,1.2,0.5", "7,1.2,0.5,0.2,0.2")  # outside of the domain
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        triangles = "A,0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5", "A,0.2,0.2,0.5,0.8,0.8,0.5,0.2,0.8,0.7"
        titles = "name,x0,y0,z0,x1,y1,z1,x2,y2,z2"
        self.write("net.csv", titles, *triangles)
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}, **self.CUBE))
        self.assertEqual(self.singles(), [("A", {})])
        self.write("net.csv", titles, *triangles, "A,0.5,0.2,0.2,0.5,0.8,0.2,0.5,0.5,0.8")
        self.refused(net, f'line 4): has the name "A", as {one}, and does not meet it; parts of one fracture meet',
                     dim=3, **self.CUBE)

    def test_numbers_of_several_sources(self):
        """Random fractures have numbers that the file does not use. Lines of a section need other names."""
        self.write("net.csv", "1,0.2,0.5,0.4,0.5", "3,0.5,0.2,0.5,0.4")
        random = {"number": 2, "seed": 1, "shortest": 0.1, "longest": 0.1, "exponent": 0.0, "strike": 0.0, "dip": 90.0,
                  "concentration": 0.0, "corners": 8}
        self.mesh(self.scene(fractures={"set": {"file": "net.csv", "random": random}}))
        self.assertEqual([name for name, _ in self.singles()], ["set 1", "set 3", "set 2", "set 4"])
        lines = {"1": {"points": [0.4, 0.5, 0.6, 0.6]}}
        reported = self.mesh(self.scene(fractures={"set": {"file": "net.csv", "lines": lines}}), expect=1)
        one = f"fracture 1 ({self.folder / 'net.csv'}: line 1)"
        self.assertIn(f'fracture "1" of "set": has the name "set 1", as {one} of another file or section', reported)

    def test_remarks_in_quotes(self):
        """Columns that are not entries of a joint may have any content. The program ignores them."""
        titles = 'name,x0,y0,x1,y1,Remark,"the ""note"""'
        self.write("net.csv", titles, 'A,0.2,0.5,0.4,0.5,"along the ""long"" joint",b')
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertEqual(self.singles(), [("A", {"Remark": "along the 'long' joint", "the 'note'": "b"})])
        net = self.write("net.csv", "name,x0,y0,x1,y1", '"the ""A""",0.2,0.5,0.4,0.5')
        self.refused(net, "the name 'the \"A\"' contains a quotation mark")

    def test_places_far_from_the_origin(self):
        """With UTM coordinates messages give places to 0.01 m, and more precisely in a small domain."""
        utm = {"lower corner": [466000.0, 6691580.0], "upper corner": [466060.0, 6691640.0]}
        net = self.write("net.csv", "1,466010,6691590,466050,6691600", "2,466020,6691630,466030.001,6691595.0043")
        self.refused(net, "apart at (466030.002, 6691595) without meeting", domain=utm)
        small = {"lower corner": [466000.0, 1e-3], "upper corner": [466000.01, 0.011]}
        rows = "1,466000.002,0.005,466000.008,0.005", "2,466000.005004,0.009,466000.005004,0.0050004"
        net = self.write("net.csv", *rows)
        self.refused(net, "apart at (466000.005004, 0.005) without meeting", domain=small)
        rows = "6691580.25,0,0,6691581.25,1,1", "6691580.5,0.2,0.5,6691580.8,0.2,0.5,6691580.8,0.8,0.5"
        net = self.write("net.csv", *rows)
        self.refused(net, "a domain from (6691580.25, 0, 0) to (6691581.25, 1, 1), the scene has", dim=3, **self.CUBE)

    def test_huge_coordinates(self):
        """Huge coordinates give one error with the place, and no warnings of numpy."""
        net = self.write("net.csv", "1,0.2,0.5,0.4,0.5", "2,0.5,0.2,1e300,0.4")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.refused(net, f'{net}: line 2: "1e300" in column 4 exceeds 1e+12, the largest allowed value')
            net = self.write("net.csv", "1,0.2,0.5,0.4,0.5", "2,0.5,0.2,1e9,0.4")
            self.refused(net, f"fracture 2 ({net}: line 2): has the coordinate 1e+09 m, more than 1e+06 diagonals")
            lines = {"line": {"points": [0.4, 0.5, 1e300, 0.6]}}
            self.write("net.csv", "1,0.2,0.5,0.4,0.5")
            self.assertIn('fracture "line" of "other": has the coordinate 1e+300 m', self.mesh(
                self.scene(fractures={"other": {"file": "net.csv", "lines": lines}}), expect=1))
            huge = {"lower corner": [0.0, 0.0], "upper corner": [1e300, 1.0]}
            self.refused(net, "has the coordinate 1e+300 m; at most 1e+12 m are allowed", domain=huge)

    def test_polygons_and_their_domain(self):
        self.write("net.csv", "0,0,0,2,1,1", "0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5,0.2,0.8,0.5", "1,0.2,0.2,1,0.8,0.2,1,0.5,0.8")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}))
        report = self.report()
        self.assertAlmostEqual(report["sets"]["set"]["area"], 0.36 + 0.18, 9)
        self.assertAlmostEqual(report["volume"], 2, 9)

    def test_ellipses(self):
        self.write("net.csv", "\ufeff0.5,0.5,0.5,0.3,0.2,30,120,60  # as spreadsheets write it")
        self.mesh(self.scene(dim=3, domain={"lower corner": [0.0] * 3, "upper corner": [1.0] * 3},
                             fractures={"set": {"file": "net.csv", "format": "ellipses"}}))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], np.pi * 0.06, 9)

    FAB = ("BEGIN FORMAT", "  Format = Ascii", "  No_Fractures = 2", "END FORMAT", "BEGIN FRACTURE", "  1 4 1 1.0e-5 2.0",
           "   1 0.2 0.2 0.5", "   2 0.8 0.2 0.5", "   3 0.8 0.8 0.5", "   4 0.2 0.8 0.5", "   0 0 0 1", "  2 3 1 1.0e-5 2.0",
           "   1 0.5 0.2 0.2", "   2 0.5 0.8 0.2", "   3 0.5 0.5 0.8", "   0 1 0 0", "END FRACTURE")
    CUBE = {"domain": {"lower corner": [0.0] * 3, "upper corner": [1.0] * 3}}

    def test_fab(self):
        self.write("net.fab", *self.FAB)
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.fab"}}, **self.CUBE))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], 0.36 + 0.18, 9)

    TESSELLATED = ("BEGIN FORMAT", "  No_Fractures = 0", "  No_TessFractures = 1", "END FORMAT", "BEGIN FRACTURE",
                   "END FRACTURE", "BEGIN TESSFRACTURE", "  2 4 2 1 1.0e-6", "   1 0.5 0.2 0.2", "   2 0.5 0.8 0.2",
                   "   3 0.5 0.8 0.8", "   4 0.4 0.2 0.8", "   1 2 3", "   1 3 4", "END TESSFRACTURE")

    def test_tessellated_fab(self):
        """The triangles of a tessellated fracture form one fracture."""
        self.write("net.fab", *self.TESSELLATED)
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.fab"}}, **self.CUBE))
        other = 0.5 * np.linalg.norm(np.cross([0, 0.6, 0.6], [-0.1, 0, 0.6]))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], 0.18 + other, 9)
        self.assertEqual(self.report()["sets"]["set"]["fractures"], 1)
        self.assertEqual(self.singles(), [("set 2", {})])
        corners = "0 0.2 0.2 0.5", "1 0.8 0.2 0.5", "2 0.8 0.8 0.5", "3 0.2 0.8 0.5"  # numbers as in files of PorePy
        self.write("net.fab", "BEGIN FRACTURE", "0 4 1", *corners, "0 -1 -1 -1", "END FRACTURE")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.fab"}}, **self.CUBE))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], 0.36, 9)

    def test_bad_tessellated_fab(self):
        for k, line, words in (
            (2, "  No_TessFractures = 2", "line 3: No_TessFractures is 2, the section TESSFRACTURE has 1"),
            (1, "  No_Fractures = 1", "line 2: No_Fractures is 1, the section FRACTURE has 0"),
            (13, "   1 3 5", 'line 14: a facet of a TESSFRACTURE is "1 3 5", expected the numbers of three'),
            (13, "   1 3 4 2 1", 'a facet of a TESSFRACTURE is "1 3 4 2 1", expected'),
            (13, "", 'a facet of a TESSFRACTURE is "", expected'),
            (7, "  2 4", 'line 8: is "2 4", expected the numbers'),
            (7, "  2 4 5 1", "line 8: fracture 2 has 5 facets"),
            (7, "  2 5 2 1", "line 8: fracture 2 has 5 nodes, expected at least 3"),
            (7, "  2 99999999999 2 1", "line 8: fracture 2 has 99999999999 nodes, expected at least 3"),
            (7, "  2 0 2 1", "line 8: fracture 2 has 0 nodes, expected at least 3"),
            (14, "", "has no line END TESSFRACTURE"),
            (6, "BEGIN CURVEDFRACTURE", "line 7: the section CURVEDFRACTURE is unknown, expected FRACTURE"),
            (0, "XAxis = North", "line 1: the x axis points north, expected east"),
        ):
            lines = [line if row == k else known for row, known in enumerate(self.TESSELLATED)]
            self.refused(self.write("net.fab", *lines), words, dim=3, **self.CUBE)
        for k, line, words in (
            (11, "  1 3 1 1.0e-5 2.0", "line 12: fracture 1 is also in line 6; each fracture needs its own number"),
            (2, "  No_Fractures = 3", "line 3: No_Fractures is 3, the section FRACTURE has 2 fractures"),
            (10, "  2 3 1", "line 6: fracture 1: the line of its normal, 0 x y z, does not follow"),
        ):
            lines = [line if row == k else known for row, known in enumerate(self.FAB)]
            self.refused(self.write("net.fab", *lines), words, dim=3, **self.CUBE)

    def test_bad_rows(self):
        net = self.write("net.csv", "id,x0,y0,x1,y1", "1,0.2,0.5,0.8", "2,0.2,nan,0.8,0.5", "3,0.2,0.5,O.8,0.5", "4,0.1,0.1,0.2,0.2")
        self.refused(net, f'{net}: line 2: has no number in column 5, "y1"',
                     f'{net}: line 3: "nan" in column 3 is not a finite number',
                     f'{net}: line 4: "O.8" in column 4 is not a number')
        net = self.write("net.csv", "1,0.2,0.5,0.8,0.5", "2,0.2,0.5,0.8,0.5", "3,1.5,0.5,1.8,0.5")
        self.refused(net, f"fracture 3 ({net}: line 3): lies outside")
        net = self.write("net.csv", "1,0.2,0.5,0.8,0.5", "2,0.2,0.5,0.8,0.5")
        self.refused(net, f"fracture 1 ({net}: line 1) and fracture 2 ({net}: line 2) are the same")
        net = self.write("net.csv", "0,0,0,1,1,1", "0.2,0.2,0.5,0.8,0.8,0.5,0.8,0.2,0.5,0.2,0.8,0.5", "0.1,0.1,0.1,0.2,0.2,0.2,0.3,0.3,0.3")
        self.refused(net, f"fracture 1 ({net}: line 2): crosses or touches itself", f"fracture 2 ({net}: line 3): has no area", dim=3)
        net = self.write("net.csv", "0,0,0,1,1,1", "0.2,0.2,0.5,0.8,0.8")
        self.refused(net, f"{net}: line 2: has 5 columns, needs 3 for each", dim=3, kind="polygons")
        net = self.write("net.csv", "0,0,0,1,0,1", "0.2,0.2,0.5,0.8,0.8,0.5,0.8,0.2,0.5")
        self.refused(net, f"{net}: line 1: the domain", dim=3)
        net = self.write("net.csv", "0.5,0.5,0.5,0.3,0,0,0,0")
        self.refused(net, f"{net}: line 1: has the radii 0.3 and 0", dim=3, kind="ellipses", **self.CUBE)

    def length(self, *rows):
        self.write("net.csv", *rows)
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        return self.report()["sets"]["set"]["length"]

    def test_titles_decide(self):
        """Titles determine the columns in any order. Without titles the order is that of the documentation."""
        wanted = np.hypot(0.6, 0.1) + np.hypot(0.3, 0.2)
        for rows in (("x0,x1,y0,y1", "0.2,0.8,0.1,0.2", "0.2,0.5,0.5,0.7"),
                     ("x0,y0,x1,y1,id", "0.2,0.1,0.8,0.2,1", "0.2,0.5,0.5,0.7,2"),
                     ("Y1 [m],id,X1,y0,x0", "0.2,1,0.8,0.1,0.2", "0.7,2,0.5,0.5,0.2"),
                     ("1,0.2,0.1,0.8,0.2", "2,0.2,0.5,0.5,0.7")):
            self.assertAlmostEqual(self.length(*rows), wanted, 9)
        self.assertEqual([name for name, _ in self.singles()], ["set 1", "set 2"])
        polygons = "z0,z1,z2,z3,number,x0,y0,x1,y1,x2,y2,x3,y3", "0.5,0.5,0.5,,4,0.2,0.2,0.8,0.2,0.8,0.8"
        more = "id,x0,y0,z0,...", "5,0.2,0.2,0.2,0.8,0.2,0.2,0.8,0.8,0.2"
        ellipse = "id,dip,cz,cy,cx,r2,r1,rake,strike [deg]", "6,60,0.5,0.5,0.5,0.2,0.3,30,120"
        for rows, area, name in ((polygons, 0.18, "set 4"), (more, 0.18, "set 5"), (ellipse, np.pi * 0.06, "set 6")):
            self.write("net.csv", *rows)
            kind = {"format": "ellipses"} if rows is ellipse else {}
            self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv", **kind}}, **self.CUBE))
            self.assertAlmostEqual(self.report()["sets"]["set"]["area"], area, 9)
            self.assertEqual(self.singles(), [(name, {})])

    def test_bad_titles(self):
        for titles, why in (
            ("START_X,START_Y,x1,y1,id", 'the titles of lines lack "x0", "y0"; columns may have any order'),
            ("x0,y,x1,y1,id", 'the titles of lines lack "y0"; columns may have any order if titles name all of them; without titles they are id,x0,y0,x1,y1; further columns may be name, material and entries of a joint; read: x0,y,x1,y1,id'),
            ("x0,y0,x1,y1,X0", 'columns 1 and 5 have the same title, "x0"'),
            ("x0,y0,x1,y1,name,name", 'columns 5 and 6 have the same title, "name"'),
            ("x0 [km],y0,x1,y1,id", 'the column "x0" is in km, expected m'),
        ):
            net = self.write("net.csv", titles, "0.2,0.1,0.8,0.2,1")
            self.refused(net, f"{net}: line 1: {why}")
        net = self.write("net.csv", "x0,y0,x1,y1", "0.2,0.1,0.8,0.2,1")
        self.refused(net, f"{net}: line 2: has 5 columns, the titles are 4")
        net = self.write("net.csv", "x0\ty0\tx1\ty1", "0.2\t0.1\t0.8\t0.2")
        self.refused(net, f"{net}: line 1: has tabs")
        titles = "x,y,z,dip,dip direction,radius,aperture [mm],number"
        net = self.write("net.csv", titles, "0.5,0.5,0.5,70,60,0.1,0.2,1")
        why = f'{net}: line 1: the titles of ellipses lack "cx", "cy"'
        self.refused(net, why, dim=3, kind="ellipses", **self.CUBE)
        net = self.write("net.csv", "cx,cy,cz,r1,r2,rake,strike,dip", "0.5,0.5,0.5,0.1,0.1,0,0,0")
        self.refused(net, '; these are titles of ellipses, which "format" must name; columns', dim=3, **self.CUBE)
        net = self.write("net.csv", "x0,y0,z0,x1,y1,z1,x3,y3,z3", "0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5")
        self.refused(net, f'{net}: line 1: the titles of polygons lack "x2", "y2", "z2"', dim=3, **self.CUBE)

    def test_numbers_in_quotes(self):
        self.write("net.csv", 'id,x0,y0,x1,y1', '"a, first","0.2", 0.5,"0.8",0.5')
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertAlmostEqual(self.report()["sets"]["set"]["length"], 0.6, 9)

    def test_other_numbers_and_separators(self):
        """Rows with other separators than commas are not taken for titles, and give one clear error."""
        net = self.write("net.csv", "1,0.2,0.5,0.8,1_0")
        self.refused(net, f'{net}: line 1: "1_0" in column 5 is not a number')
        rows = (("semicolons", "1;0.2;0.5;0.8;0.5"), ("semicolons", "1;0,2;0,5;0,8;0,5"), ("tabs", "1\t0.2\t0.5\t0.8\t0.5"),
                ("tabs", "north fault\t0,2\t0,5\t0,8\t0,5"), ("blanks between numbers", "1 0.2 0.5 0.8 0.5"), ("blanks between numbers", "f1  0.2 0.5  1 1"))
        for name, row in rows:
            for before in ([], ["id,x0,y0,x1,y1"], ["1,0.2,0.5,0.8,0.5"]):
                net = self.write("net.csv", "# from a spreadsheet; in metres", *before, row, "3,0.1,0.1,0.2,0.2")
                self.refused(net, f"{net}: line {2 + len(before)}: has {name}; columns are separated by commas")
            net = self.write("net.csv", row)
            self.refused(net, f"{net}: line 1: has {name}", dim=3, **self.CUBE)
        self.write("net.csv", "# trace 7, x in m, y in m, x1, y1", "1 2, 0.2,\t0.5, 0.8, 0.5", ",,,,")
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))

    def test_closed_rings(self):
        """The last corner may repeat the first."""
        ring = "0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5,0.2,0.8,0.5"
        self.write("net.csv", "0,0,0,1,1,1", f"{ring},0.2,0.2,0.5")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}))
        self.assertAlmostEqual(self.report()["sets"]["set"]["area"], 0.36, 9)

    def test_domain_in_the_file_and_in_the_scene(self):
        net = self.write("net.csv", "0,0,0,2,1,1", "0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}, domain={"lower corner": [0.0] * 3, "upper corner": [2.0, 1.0, 1.0]}))
        self.refused(net, f"{net}: has a domain from (0, 0, 0) to (2, 1, 1), the scene has (0, 0, 0) to (1, 1, 1); remove one", dim=3, **self.CUBE)

    def test_names(self):
        corners = {"corners": [0.0, 0.0, 1.0, 0.0, 1.0, 1.0], "lower corner": [], "upper corner": []}
        self.write("net.csv", "1,0.5,0.2,0.8,0.3")
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}, domain={**corners, "sides": ["&quot;left, below&quot;", "right", "above"]}))
        self.assertIn('boundary      "left, below"', self.call("mesh-info", "net.msh", "--fractures", "set")[0])
        reported = self.mesh(self.scene(fractures={'a &quot; b': {"file": "net.csv"}}), expect=1)
        self.assertIn("contains a quotation mark", reported)

    def test_one_bad_row_of_many(self):
        rows = [f"{k},0.2,{0.2 + 6e-6 * k},0.8,{0.2 + 6e-6 * k}" for k in range(100000)]
        rows[77776] = rows[77776].replace("0.8", "0.8.1")
        net, begin = self.write("net.csv", *rows), time.monotonic()
        self.refused(net, f'{net}: line 77777: "0.8.1" in column 4 is not a number')
        self.assertLess(time.monotonic() - begin, 20)  # 1 s on an idle machine

    def test_bad_fab(self):
        for change, words in (({5: "  1 5 1"}, "line 6: fracture 1 has 5 corners"), ({7: "   2 0.8 x 0.5"}, 'line 8: "x" in column 3 is not a number'),
                              ({16: ""}, "has no line END FRACTURE"), ({4: "BEGIN"}, "has no line BEGIN FRACTURE"),
                              ({1: "  Length_Unit = Feet"}, "line 2: lengths are in feet, expected metres"), ({11: "  two 3 1"}, "line 12: is \"two 3 1\", expected the number")):
            lines = list(self.FAB)
            for k, line in change.items():
                lines[k] = line
            net = self.write("net.fab", *lines)
            self.refused(net, words, dim=3, **self.CUBE)

    def test_files_that_cannot_be_read(self):
        self.refused(self.folder / "absent.csv", "absent.csv: cannot be read: No such file")
        (self.folder / "net.csv").write_bytes(b"1,0.2,0.5,\xff\xfe")
        self.refused(self.folder / "net.csv", "net.csv: cannot be read: is not UTF-8 text")
        self.refused(self.write("net.csv", "id,x0,y0,x1,y1"), "net.csv: has no fracture")
        (self.folder / "folder").mkdir()
        self.refused(self.folder / "folder", "folder: cannot be read: Is a directory")
        os.mkfifo(self.folder / "pipe")
        (self.folder / "zeros").symlink_to("/dev/zero")
        for name in ("pipe", "zeros"):
            self.refused(self.folder / name, f"{name}: cannot be read: is not a regular file, but a pipe, a socket or a device")
        with mock.patch("tables.MAX_CHARACTERS", 100):
            self.refused(self.write("net.csv", *["1,0.2,0.5,0.8,0.5"] * 6), "net.csv: cannot be read: has more than 100 characters")

    def test_more_fractures_than_can_be_meshed(self):
        with mock.patch("description.MAX_FRACTURES", 3):
            self.refused(self.write("net.csv", *(f"{k},0.2,0.{k},0.8,0.{k}" for k in range(1, 6))), "fractures > set: increases the network to 5 fractures, at most 3 are allowed")


class Runs(MeshTest):
    LINES = "1,0.2,0.5,0.8,0.5", "2,0.5,0.2,0.5,0.8"

    def simple(self):
        self.write("net.csv", *self.LINES)
        return self.scene(fractures={"set": {"file": "net.csv"}}, relative_size=0.2)

    def test_mesh_is_made_once(self):
        scene = self.simple()
        self.assertIn("cells", self.mesh(scene))
        self.assertIn("up to date", self.mesh(scene))
        self.assertIn("cells", self.mesh(scene, "--set", "Mesh file.network.growth=0.6"))
        self.write("net.csv", *self.LINES, "3,0.1,0.1,0.2,0.2")
        self.assertIn("cells", self.mesh(scene, "--set", "Mesh file.network.growth=0.6"))
        with open(self.folder / "net.msh", "r+b") as file:
            file.truncate(1000)
        self.assertIn("cells", self.mesh(scene, "--set", "Mesh file.network.growth=0.6"))

    def test_misspelt_entry_of_a_joint(self):
        net = self.write("net.csv", "id,x0,y0,x1,y1,remark,friction coeficient", "1,0.2,0.5,0.8,0.5,a,0.5")
        reported = self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}), expect=1)
        self.assertEqual(reported, f'sprekk: {net}: line 1: column 7 has the title "friction coeficient", which is no entry of a joint; '
                               'did you mean "friction coefficient"?\n')

    def test_near_fractures(self):
        """Ends close to another fracture give a warning, also with an existing mesh. Traces that meet give none."""
        self.write("net.csv", "1,0.2,0.5,0.8,0.5", "2,0.5,0.501,0.5,0.8", "3,0.3,0.2,0.3,0.8", "4,0.6,0.5,0.6,0.8")
        scene = self.scene(fractures={"set": {"file": "net.csv"}}, relative_size=0.2)
        for _ in range(2):
            err = io.StringIO()
            with contextlib.redirect_stderr(err):
                self.assertEqual(app.main([str(scene), "-o", str(self.folder / "net.msh"), "--program", str(program.PROGRAM), "--quiet"]), 0)
            self.assertRegex(err.getvalue(), r"^warning: .*scene.xml: fracture 1 \(.*net.csv: line 1\) and fracture 2 \(.*net.csv: line 2\) "
                                             r'are 0.001 m apart at \(0.5, 0.5\d*\) without meeting; if they should meet, .* "tolerance"\n$')

    def test_long_operations_are_reported(self):
        from progress import doing
        err = io.StringIO()
        with mock.patch("progress.PATIENCE", 0.01), contextlib.redirect_stderr(err):
            with doing("waiting"):
                for _ in range(1000):
                    time.sleep(0.01)
                    if err.getvalue():
                        break
            with doing("hurrying"):
                pass
        self.assertEqual(err.getvalue(), "sprekk: waiting ...\n")

    def test_same_mesh_each_time(self):
        scene = self.simple()
        for output in ("a.msh", "b.msh"):
            self.mesh(scene, output=output)
        self.assertEqual((self.folder / "a.msh").read_bytes(), (self.folder / "b.msh").read_bytes())

    def test_mesh_is_made_again_by_another_gmsh(self):
        import gmsh
        scene = self.simple()
        self.mesh(scene)
        with mock.patch.object(gmsh, "__version__", "0.1"):
            self.assertIn("cells", self.mesh(scene))

    def test_output_that_cannot_be_written(self):
        """An unwritable output gives one line without a Python traceback, and leaves no files."""
        (self.folder / "net.msh").mkdir()
        reported = self.mesh(self.simple(), expect=1)
        self.assertRegex(reported, r"^sprekk: .*scene.xml: .*net.msh.*: Is a directory\n$")
        self.assertEqual([p.name for p in self.folder.glob("net.msh*")], ["net.msh"])
        self.write("file", "")
        reported = self.mesh(self.simple(), output="file/net.msh", expect=1)
        self.assertRegex(reported, r"^sprekk: .*scene.xml: .*/file[^\n]*: (Not a directory|File exists)\n$")
        if Path("/dev/full").exists():
            (self.folder / f"full.msh.{os.getpid()}").symlink_to("/dev/full")
            reported = self.mesh(self.simple(), output="full.msh", expect=1)
            self.assertRegex(reported, r"^sprekk: .*scene.xml: .*full.msh: No space left on device\n$")
            self.assertEqual(list(self.folder.glob("full.msh*")), [])

    def test_absurd_sizes_are_refused(self):
        """Sizes with too many cells are rejected before meshing. The error names the entry; the limit is adjustable."""
        self.write("net.csv", *self.LINES)
        for entry, value in (("relative size", 1e-9), ("size", 1e-6), ("size at boundary", 1e-6), ("growth", 1e-9), ("size at tips", 2e-7)):
            scene = self.scene(fractures={"set": {"file": "net.csv"}}, **{"relative_size": 0.2, "growth": 1e-4 if "tips" in entry else 0.5, entry.replace(" ", "_"): value})
            begin, reported = time.monotonic(), self.mesh(scene, expect=1)
            self.assertRegex(reported, r'network: sizes require about [0-9.e+]+ cells, [0-9]+% of them due to "[a-z ]+"; "maximum cells" is 1e\+07')
            if entry != "growth":
                self.assertIn(f'due to "{entry}"', reported)
            self.assertLess(time.monotonic() - begin, 20)
        reported = self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}, size_at_tips=1e-12), expect=1)
        self.assertIn("network > size at tips: is 1e-12 m, must be at least 1e-7 of the domain's diagonal, 1.41e-07 m", reported)
        reported = self.mesh(self.simple(), "--set", "Mesh file.network.maximum cells=100", expect=1)
        self.assertIn('"maximum cells" is 100', reported)

    def test_expected_cells_are_about_as_many_as_are_made(self):
        from conformity import network, planned
        from mesher import make_mesh
        square = [[0.2, 0.2, 0.5], [0.8, 0.2, 0.5], [0.8, 0.8, 0.5], [0.2, 0.8, 0.5]]
        for fractures, sizes in (({"a": [[0.2, 0.5], [0.8, 0.5]], "b": [[0.5, 0.2], [0.5, 0.8]]}, {"relative_size": 0.05, "size_at_tips": 0.002}),
                                 ({"a": square}, {"relative_size": 0.06, "size_at_tips": 0.02}), ({"a": square}, {"relative_size": 0.9, "size": 0.05})):
            plan, sizes = planned(network(fractures, **sizes))
            ratio = sum(sizes.expected_cells().values()) / len(make_mesh(plan, sizes).cells)
            self.assertTrue(0.4 < ratio < 2.5, ratio)

    def test_fractures_at_random_that_cannot_be_meshed_are_drawn_again(self):
        """Only random fractures that cannot be meshed are drawn again. Fractures of a file never are."""
        random = {"number": 30, "seed": 1, "shortest": 0.1, "longest": 0.5}
        dense = {"tolerance": 1e-6, "minimum_distance": 0.003}
        self.mesh(self.scene(fractures={"set": {"random": random}}, **dense))
        reported = [line for line in self.report()["repairs"] if "drawn again" in line]
        self.assertGreater(len(reported), 0)
        self.assertEqual(self.report()["sets"]["set"]["fractures"], 30)
        self.mesh(self.scene(fractures={"set": {"random": {**random, "number": 300}}}, **dense), expect=1)
        self.write("net.csv", "1,0.2,0.5,0.8,0.5", "2,0.2,0.501,0.8,0.501")
        self.assertIn("apart", self.mesh(self.scene(fractures={"set": {"file": "net.csv", "random": random}}, **dense), expect=1))

    def test_report(self):
        self.mesh(self.simple())
        report, info = self.report(), self.call("mesh-info", "net.msh", "--fractures", "set")[0]
        self.assertIn(f"{report['cells']} triangles", info)
        self.assertIn("length 1.2", info)
        self.assertTrue(0.3 < report["gamma"]["min"] <= report["gamma"]["median"] <= 1)
        for rows in (self.LINES, ("1,0.2,0.2,0.5,0.5", "2,0.5,0.5,0.8,0.2"), ("1,0.2,0.2,0.5,0.5", "2,0.5,0.5,0.8,0.2", "3,0.5,0.5,0.5,0.9")):
            self.write("net.csv", *rows)  # an X, two lines and three lines with common ends
            self.mesh(self.folder / "scene.xml")
            self.assertIn(f"intersections {self.report()['intersections']} points", self.call("mesh-info", "net.msh", "--fractures", "set")[0])
        self.assertTrue(0 < report["sets"]["set"]["median edge"] <= 1.5 * report["sets"]["set"]["median target size"])

    def launch(self, *words, expect=0):
        """Runs the launcher as in an installed tree, where it does not build."""
        shutil.copy(ROOT / "sprekk", self.folder)
        binary = self.folder / "apps/sprekk/sprekk"
        if not binary.exists():
            binary.parent.mkdir(parents=True)
            binary.symlink_to(program.PROGRAM)
            (self.folder / "apps/mesh").symlink_to(ROOT / "apps/mesh")
        done = subprocess.run(["timeout", str(program.TIME_LIMIT), "bash", "./sprekk", *map(str, words)], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_run_and_check_make_the_mesh(self):
        scene = self.simple()
        for ranks in (1, 2):
            self.launch("run", scene, "--ranks", ranks, "--output", f"out{ranks}")
            results = self.results(f"out{ranks}")
            self.assertEqual(results["status"], "completed")
            self.assertAlmostEqual(results["steps"][0]["fractures"]["set"]["area"], 1.2, 9)
        self.assertAlmostEqual(results["steps"][0]["reactions"]["south"][1], self.results("out1")["steps"][0]["reactions"]["south"][1], delta=1)
        self.assertIn("no errors", self.launch("check", scene))
        self.assertEqual(sorted(p.name for p in self.folder.iterdir() if p.is_dir()), ["apps", "out1", "out2"])
        self.launch("run", scene, "--output", "again", "--set", "Mesh file.order=2")
        self.assertIn("network", (self.folder / "again/effective_input.xml").read_text())
        self.launch("run", "again/effective_input.xml", "--output", "once more")

    def quarter_points(self, *words):
        """Returns the ends of edges with a node at a quarter, nearer end first, of a run at order 2."""
        import read  # from apps/plot
        self.call("run", "scene.xml", "--output", "out", "--set", "Mesh file.path=net.msh", "--set", "Mesh file.order=2", *words)
        rock = read.grid(self.folder / "out/bulk_0000.pvtu")
        x, cells = read.vtk_to_numpy(rock.GetPoints().GetData()), np.array(read.cells(rock.GetCells()))
        edges = {6: [(0, 1, 3), (1, 2, 4), (2, 0, 5)], 10: [(0, 1, 4), (1, 2, 5), (2, 0, 6), (0, 3, 7), (1, 3, 8), (2, 3, 9)]}[cells.shape[1]]
        ends = np.concatenate([x[cells[:, [a, b]]] for i, j, _ in edges for a, b in ((i, j), (j, i))])
        middle = np.concatenate([x[cells[:, [m, m]]][:, 0] for _, _, m in edges for _ in range(2)])
        return ends[np.linalg.norm(middle - (0.75 * ends[:, 0] + 0.25 * ends[:, 1]), axis=1) < 1e-9]

    @unittest.skipUnless(importlib.util.find_spec("vtkmodules"), "VTK's Python is missing")
    def test_order_2_has_quarter_points_at_tips(self):
        self.write("net.csv", *self.LINES)
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}, relative_size=0.3))
        tips = {tuple(x) for x in np.round(self.quarter_points()[:, 0, :2], 9)}
        self.assertEqual(tips, {(0.2, 0.5), (0.8, 0.5), (0.5, 0.2), (0.5, 0.8)})
        self.assertEqual(len(self.quarter_points("--set", "Mesh file.tips=plain")), 0)

        self.write("net.csv", "0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5,0.2,0.8,0.5")
        self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}, relative_size=0.3, size_at_tips=0.1,
                             domain={"lower corner": [0.0] * 3, "upper corner": [1.0] * 3}))
        ends = self.quarter_points()
        self.assertGreater(len(ends), 100)
        self.assertTrue(np.allclose(abs(ends[:, 0] - 0.5).max(axis=1), 0.3) and np.allclose(ends[:, 0, 2], 0.5))  # on the rim
        self.assertFalse((np.isclose(abs(ends[:, 1] - 0.5).max(axis=1), 0.3) & np.isclose(ends[:, 1, 2], 0.5)).any())

    def test_a_file_beside_the_network(self):
        scene = self.simple()
        self.mesh(scene, output="other.msh")
        reported = self.launch("run", scene, "--output", "out", "--set", "Mesh file.path=other.msh")
        self.assertIn('"path" is given by --set; the section "network" is ignored', reported)
        self.assertFalse((self.folder / "out/network.msh").exists())
        both = self.write("both.xml", scene.read_text().replace('<ParameterList name="network">', '<Parameter name="path" type="string" value="other.msh"/><ParameterList name="network">'))
        for command in ("run", "check"):
            self.assertIn('both.xml: Sprekk > Mesh file: has both "path" and "network"; leave one out', self.launch(command, both, expect=1))
        self.launch("run", both, "--output", "out", "--set", "Mesh file.path=other.msh")

    def test_errors_reach_the_user_on_any_number_of_ranks(self):
        scene = self.simple()
        self.launch("run", scene, "--output", "out")
        self.write("net.csv", "1,0.2,0.5,0.8")
        for ranks in (1, 2):
            reported = self.launch("run", scene, "--ranks", ranks, "--output", "out", expect=1)
            self.assertEqual(reported, f"sprekk: net.csv: line 1: has 4 columns, needs 5: id,x0,y0,x1,y1\n")
        self.assertEqual(self.results()["status"], "failed")
        self.assertIn("line 1: has 4 columns", self.results()["reason"])
        self.launch("check", scene, expect=1)

    def test_program_alone_says_who_makes_the_mesh(self):
        for command in ("run", "check"):
            _, err = self.call(command, self.simple(), expect=1)
            self.assertIn('Sprekk > Mesh file > "path": missing; the mesh of a network is made by `./sprekk mesh', err)
        self.mesh(self.folder / "scene.xml")
        self.call("run", self.folder / "scene.xml", "--set", "Mesh file.path=net.msh", "--output", "out", ranks=2)
        self.assertEqual(self.results()["status"], "completed")

    def test_descriptions(self):
        reported = self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}, tolerence=1.0), expect=1)
        self.assertRegex(reported, r'scene.xml: Sprekk > Mesh file > network > "tolerence": unknown. Did you mean "tolerance"\?')
        reported = self.mesh(self.scene(fractures={"set": {"random": {"number": 3, "shortest": 2.0, "longest": 1.0}}}), expect=1)
        self.assertIn('"longest": is 1, "shortest" 2', reported)
        self.write("net.csv", "1,0,0,1,1")
        reported = self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}, domain={"lower corner": [0.0, 0.0], "upper corner": [1.0]}), expect=1)
        self.assertIn('"upper corner": has 1 coordinates', reported)
        reported = self.mesh(self.write("empty.xml", '<ParameterList name="Sprekk"/>'), expect=1)
        self.assertIn("has no section Sprekk > Mesh file > network", reported)

    def test_picture(self):
        self.mesh(self.simple(), "--picture", str(self.folder / "net.png"))
        self.assertGreater((self.folder / "net.png").stat().st_size, 10000)

    @unittest.skipUnless(importlib.util.find_spec("vtkmodules") and shutil.which("Xvfb"), "VTK's Python or Xvfb is missing")
    def test_picture_in_3d(self):
        """The picture shows each fracture face and each of its sides once, in the box of the domain."""
        import picture
        import space
        from conformity import network, planned
        from mesher import make_mesh
        square = np.array([[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]])
        sets = {"flat": np.insert(square, 2, 0.3, axis=1), "steep": np.insert(0.5 * square, 0, 0.5, axis=1) + [0, 0, 0.4]}
        plan, sizes = planned(network(sets))
        with mock.patch.object(space, "draw", wraps=space.draw) as draw:
            picture.draw(make_mesh(plan, sizes), plan, self.folder / "net.png")
        self.assertGreater((self.folder / "net.png").stat().st_size, 10000)
        _, parts, bounds = draw.call_args.args
        self.assertEqual(bounds.tolist(), [[0, 0, 0], [1, 1, 1]])
        for faces, sides, area in zip(parts[::2], parts[1::2], (0.36, 0.09), strict=True):
            corners = faces.points[np.array(faces.polygons)]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            self.assertAlmostEqual(0.5 * np.linalg.norm(normals, axis=1).sum(), area, 12)
            self.assertEqual(len(np.unique(faces.polygons)) - len(sides.polygons) + len(faces.polygons), 1)  # Euler
        with mock.patch.object(space.shutil, "which", lambda name: None), self.assertRaisesRegex(picture.NetworkError, "require Xvfb"):
            space.window.cache_clear()
            picture.draw(make_mesh(plan, sizes), plan, self.folder / "net.png")


if __name__ == "__main__":
    main()
