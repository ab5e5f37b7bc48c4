#!/usr/bin/env python3
"""Published maps, of which a network uses a part: maps_test.py PROGRAM ROOT MPIEXEC

Requires Debian's python3-gdal. Without it the status is 77, for ctest's "skipped"."""
import importlib.util
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

if importlib.util.find_spec("osgeo") is None:
    print(f"skipped: {sys.executable} has no osgeo; it comes with apt-get install python3-gdal")
    sys.exit(77)

import numpy as np  # noqa: E402
from program import ROOT, ProgramTest, main  # noqa: E402

sys.path.insert(0, str(ROOT / "apps" / "mesh"))
from conformity import CUBE, DEFAULTS, SQUARE, as_xml, planned  # noqa: E402
from description import Network  # noqa: E402
from shapes import NetworkError, thinned  # noqa: E402

LEFT_OUT = {"unusable fractures": "left out"}


def network(dim, sets, **entries):
    described = {**DEFAULTS, "domain": SQUARE if dim == 2 else CUBE, "fractures": sets}
    return Network(as_xml("network", {**described, **{key.replace("_", " "): value for key, value in entries.items()}}))


def length(plan):
    return sum(np.linalg.norm(plan.points[a] - plan.points[b]) for (a, b), of in plan.edges.items() if plan.fractures_of(of))


class MapsTest(ProgramTest):
    def file(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return str(path)

    def drawing(self, unit=6):
        """Writes a drawing: frame on the sides, scale bar outside, two joints of length 0.6 and 0.5, a cleavage."""
        lines = {"FRAME": [[0, 0, 1, 0], [0, -0.1, 1, -0.1]], "JOINTS": [[0.2, 0.4, 0.8, 0.4], [0.4, 0.2, 0.4, 0.7]],
                 "CLEAVAGE": [[0.1, 0.9, 0.3, 0.9]]}
        scale = 1 if unit == 6 else 1000
        text = f"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{unit}\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
        for layer, rows in lines.items():
            for x in rows:
                corners = "".join(f"{code}\n{scale * one}\n" for code, one in zip((10, 20, 11, 21), x))
                text += f"0\nLINE\n8\n{layer}\n{corners}"
        return self.file("map.dxf", text + "0\nENDSEC\n0\nEOF\n")

    def geojson(self, *lines):
        features = [{"type": "Feature", "properties": {}, "geometry": x and {"type": "LineString", "coordinates": x}} for x in lines]
        return self.file("map.geojson", json.dumps({"type": "FeatureCollection", "crs": None, "features": features}))

    def refusal(self, sets, **entries):
        with self.assertRaises(NetworkError) as caught:
            planned(network(2, sets, **entries))
        return str(caught.exception)

    def plan(self, sets, **entries):
        return planned(network(2, sets, **entries))[0]

    def test_points_closer_than_the_tolerance_are_left_out(self):
        line = np.array([[0, 0], [0.5, 0], [0.51, 0.01], [1, 0.2], [1.001, 0.2]])
        self.assertEqual(thinned(line, 0.03).tolist(), [[0, 0], [0.5, 0], [1.001, 0.2]])
        self.assertEqual(thinned(line, 2).tolist(), [[0, 0], [1.001, 0.2]])
        self.assertEqual(thinned(line, 1e-6).tolist(), line.tolist())
        file = self.geojson([[0.1, 0.2], [0.4, 0.25], [0.401, 0.2511], [0.9, 0.3]], [[0.2, 0.8], [0.3, 0.2355]])
        sets = {"traces": {"file": file}}
        self.assertIn("larger \"tolerance\"", self.refusal(sets, minimum_distance=5e-3))
        plan = self.plan(sets, tolerance=3e-3, minimum_distance=5e-3)
        self.assertTrue(any(line.startswith("left out 1 point closer") for line in plan.repairs), plan.repairs)
        self.assertTrue(any(line.startswith("closed a gap of 0.00") for line in plan.repairs), plan.repairs)

    def test_window_in_a_map(self):
        rows = ["id,x0,y0,x1,y1", "1,0.2,0.2,0.6,0.2", "2,2,0.7,3,0.7", "3,0.5,0.5,1.4,0.5", "4,0.3,0.8,0.30001,0.8"]
        sets = {"traces": {"file": self.file("map.csv", "\n".join(rows))}}
        reported = self.refusal(sets, minimum_distance=1e-3)
        for part in ("line 3): lies outside of the domain", "line 5): is 1e-05 m long, shorter than the \"minimum distance\", 0.001 m",
                     "\"unusable fractures\" = \"left out\""):
            self.assertIn(part, reported)
        self.assertNotIn("line 4", reported)
        plan = self.plan(sets, minimum_distance=1e-3, **LEFT_OUT)
        self.assertAlmostEqual(length(plan), 0.4 + 0.5, places=12)
        self.assertEqual(sum(line.startswith("left out: fracture") for line in plan.repairs), 2)
        lone = {"traces": sets["traces"], "others": {"file": self.file("far.csv", "1,5,5,6,6")}}
        self.assertIn("others: has no usable fracture in the domain", self.refusal(lone, minimum_distance=1e-3, **LEFT_OUT))

    def test_window_in_a_map_in_3d(self):
        def square(x, z=0.2):
            return {"points": [x, 0.3, z, x + 0.3, 0.3, z, x + 0.3, 0.6, z, x, 0.6, z]}
        sets = {"joints": {"polygons": {"inside": square(0.3), "outside": square(5.0)}}}
        with self.assertRaises(NetworkError) as caught:
            planned(network(3, sets))
        self.assertIn("\"outside\" of \"joints\": lies outside of the domain", str(caught.exception))
        self.assertIn("\"left out\"", str(caught.exception))
        plan = planned(network(3, sets, **LEFT_OUT))[0]
        self.assertEqual([one.name for one in plan.network.fractures], ['fracture "inside" of "joints"'])

    def test_features_without_geometry(self):
        sets = {"traces": {"file": self.geojson([[0.2, 0.5], [0.8, 0.5]], None, [[0.3, 0.3], [0.3, 0.3]])}}
        reported = self.refusal(sets)
        for part in ("feature 2: has no geometry", "feature 3: has 1 different points", "\"unusable fractures\""):
            self.assertIn(part, reported)
        self.assertAlmostEqual(length(self.plan(sets, **LEFT_OUT)), 0.6, places=12)

    def test_layers_of_a_drawing(self):
        sets = {"traces": {"file": self.drawing()}}
        self.assertIn("feature 2 of the layer \"FRAME\"): lies outside of the domain", self.refusal(sets))
        self.assertIn("\"layers\" of its set selects", self.refusal(sets, **LEFT_OUT))
        sets["traces"]["layers"] = ["JOINTS"]
        self.assertAlmostEqual(length(self.plan(sets)), 1.1, places=12)
        sets["traces"]["layers"] = ["JOINTS", "CLEAVAGE"]
        self.assertAlmostEqual(length(self.plan(sets)), 1.3, places=12)
        sets["traces"]["layers"] = ["JOINT"]
        self.assertIn("has no layer \"JOINT\"; its layers are \"CLEAVAGE\", \"FRAME\", \"JOINTS\"", self.refusal(sets))
        lines = {"traces": {"file": self.file("a.csv", "1,0,0,1,1"), "layers": ["JOINTS"]}}
        self.assertIn("has no layers", self.refusal(lines))

    def test_unit_of_a_file(self):
        sets = {"traces": {"file": self.drawing(4), "layers": ["JOINTS"]}}
        self.assertIn("give \"unit\" of its set, as \"1 mm\"", self.refusal(sets))
        sets["traces"]["unit"] = 1e-3
        self.assertAlmostEqual(length(self.plan(sets)), 1.1, places=12)
        sets = {"traces": {"file": self.file("a.csv", "1,20,40,80,40"), "unit": 0.01}}
        self.assertAlmostEqual(length(self.plan(sets)), 0.6, places=12)

    def test_a_point_a_line(self):
        rows = "11,0.1,0.1\n11,0.4,0.1\n12,0.2,0.8\n12,0.8,0.8\n11,0.4,0.5\n"
        for head in ("#FID, PT_X, PT_Y\n", "FID,PT_X,PT_Y\n", "id,x,y\n", ""):
            plan = self.plan({"traces": {"file": self.file("a.csv", head + rows)}})
            self.assertAlmostEqual(length(plan), 0.7 + 0.6, places=12)
            self.assertEqual([one.single for one in plan.network.fractures], ["traces 11", "traces 12"])
        file = self.file("a.csv", "y,x,id,z,name,friction coefficient\n0.1,0.2,A,7,one,0.5\n0.1,0.6,A,7,one,0.5\n")
        plan = self.plan({"traces": {"file": file}})
        self.assertEqual(plan.network.fractures[0].properties, {"friction coefficient": "0.5"})
        self.assertAlmostEqual(length(plan), 0.4, places=12)
        for text, part in (("id,x,y\n1,0,0\n2,0.5,0.5\n2,0.6,0.6\n", "fracture 1 ("), ("id,x,y\n1,0,z\n", "\"z\" in column 3 is not a number"),
                           ("x,y\n1,0\n", "lack one of id, fid, number"), ("id,x,y\n,0,0\n", "lacks the number of the line")):
            self.assertIn(part, self.refusal({"traces": {"file": self.file("a.csv", text)}}))

    def test_discs_are_no_points(self):
        """Titles of a table of discs are not read as titles of points."""
        file = self.file("a.csv", "x,y,z,dip,dip direction,radius,number\n0.5,0.5,0.5,70,60,0.2,1\n")
        (disc,) = network(3, {"joints": {"file": file}}).fractures
        self.assertEqual(disc.points.shape, (11, 3))

    def test_a_corner_a_line_in_3d(self):
        corners = [(0.2, 0.2), (0.7, 0.2), (0.7, 0.6), (0.2, 0.6)]
        rows = "".join(f"3,{x},{y},0.4\n" for x, y in corners)
        for head in ("FID,PT_X,PT_Y,PT_Z\n", ""):
            plan = planned(network(3, {"joints": {"file": self.file("a.csv", head + rows)}}))[0]
            self.assertAlmostEqual(plan.surfaces[-1].shape.area, 0.2, places=12)

    def test_the_program_reads_the_entries(self):
        scene = (ROOT / "xml" / "networks" / "outcrop_2d.xml").read_text().replace("outcrop.csv", self.drawing(4))
        path = self.file("scene.xml", scene.replace("{10, 10}", "{1, 1}"))
        words = ["Mesh file.network.unusable fractures=left out", "Mesh file.network.fractures.traces.layers={JOINTS}",
                 "Mesh file.network.fractures.traces.unit=1 mm"]
        reported, _ = self.call("network", path, *(word for one in words for word in ("--set", one)))
        for part in ('"unusable fractures" type="string" value="left out"', 'value="{JOINTS}"', 'name="unit" type="double" value="0.001"'):
            self.assertIn(part, reported)



if __name__ == "__main__":
    main()
