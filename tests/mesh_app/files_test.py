#!/usr/bin/env python3
"""Files of fractures: files_test.py PROGRAM ROOT MPIEXEC"""
import os
import sys
import time
import warnings
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
from conformity import DEFAULTS, as_xml  # noqa: E402
from mesh_program import SQUARE, MeshTest, app  # noqa: E402
from program import main  # noqa: E402


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
                   "B,0.5,0.2,0.5,0.4,,", '"C, left",0.1,0.1,0.2,0.2,0.7,')
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
        self.refused(net, f"{net}: line 2: has 4 columns, the titles are 5; an empty cell needs its separator")
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
        self.refused(net, f"{net}: line 2: has 4 columns, the titles are 5; an empty cell needs its separator",
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
            self.mesh(self.scene(dim=3, fractures={"set": {"file": "net.csv"}}, **self.CUBE))
            self.assertAlmostEqual(self.report()["sets"]["set"]["area"], area, 9)
            self.assertEqual(self.singles(), [(name, {})])

    def test_bad_titles(self):
        for titles, why in (
            ("A_X,A_Y,x1,y1,id", 'the titles of lines lack "x0", "y0"; columns may have any order'),
            ("x0,y,x1,y1,id", 'the titles of lines lack "y0"; columns may have any order if titles name all of them; without titles they are id,x0,y0,x1,y1; further columns may be name, material and entries of a joint; read: x0,y,x1,y1,id'),
            ("x0,y0,x1,y1,X0", 'columns 1 and 5 have the same title, "x0"'),
            ("x0,y0,x1,y1,name,name", 'columns 5 and 6 have the same title, "name"'),
            ("x0 [km],y0,x1,y1,id", 'the column "x0" is in km, expected m'),
        ):
            net = self.write("net.csv", titles, "0.2,0.1,0.8,0.2,1")
            self.refused(net, f"{net}: line 1: {why}")
        net = self.write("net.csv", "x0,y0,x1,y1", "0.2,0.1,0.8,0.2,1")
        self.refused(net, f"{net}: line 2: has 5 columns, the titles are 4")
        net = self.write("net.csv", "name,x0,y0,x1,y1,friction coefficient", "a,0.2,0.1,0.8,0.2,", "b,0.2,0.4,0.8,0.5")
        self.refused(net, f"{net}: line 3: has 5 columns, the titles are 6; an empty cell needs its separator")
        net = self.write("net.csv", "x0,y0,z0,x1,y1,z1,x3,y3,z3", "0.2,0.2,0.5,0.8,0.2,0.5,0.8,0.8,0.5")
        self.refused(net, f'{net}: line 1: the titles of polygons lack "x2", "y2", "z2"', dim=3, **self.CUBE)

    def test_numbers_in_quotes(self):
        self.write("net.csv", 'id,x0,y0,x1,y1', '"a, first","0.2", 0.5,"0.8",0.5')
        self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}))
        self.assertAlmostEqual(self.report()["sets"]["set"]["length"], 0.6, 9)

    def test_other_numbers_and_separators(self):
        """The first row determines the separator. With semicolons and tabs numbers may have decimal commas."""
        net = self.write("net.csv", "1,0.2,0.5,0.8,1_0")
        self.refused(net, f'{net}: line 1: "1_0" in column 5 is not a number')
        for row in ("1;0.2;0.5;0.8;0.5", "1;0,2;0,5;0,8;0,5", "1\t0.2\t0.5\t0.8\t0.5", "north fault\t0,2\t0,5\t0,8\t0,5"):
            separator = ";" if ";" in row else "\t"
            for before in ([], [separator.join(("id", "x0", "y0", "x1", "y1"))]):
                self.assertAlmostEqual(self.length("# from a spreadsheet, in metres", *before, row), 0.6, 9)
            net = self.write("net.csv", row, "3,0.1,0.1,0.2,0.2")
            self.refused(net, f"{net}: line 2: has 1 columns, needs 5")
        rows = ("semicolons", "1;0.2;0.5;0.8;0.5"), ("tabs", "1\t0.2\t0.5\t0.8\t0.5"), ("blanks between numbers", "f1  0.2 0.5  1 1")
        for name, row in rows:
            net = self.write("net.csv", "# in metres", "1,0.2,0.5,0.8,0.5", row, "3,0.1,0.1,0.2,0.2")
            self.refused(net, f"{net}: line 3: has {name}; columns are separated by commas")
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
        (self.folder / "net.csv").write_bytes(b"1,0.2,0.5,\x00\xfe")
        self.refused(self.folder / "net.csv", "net.csv: cannot be read: is not text")
        self.refused(self.write("net.csv", "id,x0,y0,x1,y1"), "net.csv: has no fracture")
        (self.folder / "folder").mkdir()
        self.refused(self.folder / "folder", "folder: cannot be read: Is a directory")
        os.mkfifo(self.folder / "pipe")
        (self.folder / "zeros").symlink_to("/dev/zero")
        for name in ("pipe", "zeros"):
            self.refused(self.folder / name, f"{name}: cannot be read: is not a regular file, but a pipe, a socket or a device")
        with mock.patch("text_file.MAX_BYTES", 100):
            self.refused(self.write("net.csv", *["1,0.2,0.5,0.8,0.5"] * 6), "net.csv: cannot be read: has more than 100 bytes")

    def test_more_fractures_than_can_be_meshed(self):
        with mock.patch("description.MAX_FRACTURES", 3):
            self.refused(self.write("net.csv", *(f"{k},0.2,0.{k},0.8,0.{k}" for k in range(1, 6))), "fractures > set: increases the network to 5 fractures, at most 3 are allowed")


if __name__ == "__main__":
    main()
