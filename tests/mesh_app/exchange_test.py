#!/usr/bin/env python3
"""Fracture networks in files of geographic information systems and drawings: exchange_test.py PROGRAM ROOT MPIEXEC

Requires Debian's python3-gdal. Without it the status is 77, for ctest's "skipped"."""
import importlib.util
import json
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

if importlib.util.find_spec("osgeo") is None:
    print(f"skipped: {sys.executable} has no osgeo; it comes with apt-get install python3-gdal")
    sys.exit(77)

import numpy as np  # noqa: E402
from program import ROOT, ProgramTest, main  # noqa: E402

sys.path.insert(0, str(ROOT / "apps" / "mesh"))
import exchange  # noqa: E402
from description import Network  # noqa: E402
from osgeo import ogr, osr  # noqa: E402
from shapes import NetworkError  # noqa: E402

from conformity import DEFAULTS, SQUARE, as_xml  # noqa: E402

TRACES = {"F1": [[0.2, 0.5], [0.8, 0.5]], "F2": [[0.5, 0.2], [0.5, 0.6], [0.6, 0.8]]}


class ExchangeTest(ProgramTest):
    def geojson(self, features, name="net.geojson", **members):
        """Writes a GeoJSON file; `features` are (type of geometry, coordinates, attributes)."""
        content = {
            "type": "FeatureCollection",
            **members,
            "features": [
                {"type": "Feature", "properties": attributes, "geometry": kind and {"type": kind, "coordinates": x}}
                for kind, x, attributes in features
            ],
        }
        path = self.folder / name
        path.write_text(json.dumps(content))
        return path

    def write_by_ogr(self, driver, name, epsg=None, kind=ogr.wkbLineString, rows=TRACES):
        path = self.folder / name
        system = osr.SpatialReference()
        if epsg:
            system.ImportFromEPSG(epsg)
        source = ogr.GetDriverByName(driver).CreateDataSource(str(path))
        layer = source.CreateLayer("traces" if driver != "DXF" else "entities", system if epsg else None, kind)
        if driver != "DXF":
            layer.CreateField(ogr.FieldDefn("NAME", ogr.OFTString))
            layer.CreateField(ogr.FieldDefn("friction", ogr.OFTReal))
        for k, (title, points) in enumerate(rows.items()):
            feature, line = ogr.Feature(layer.GetLayerDefn()), ogr.Geometry(kind)
            for point in points:
                line.AddPoint(*map(float, point)) if kind == ogr.wkbLineString25D else line.AddPoint_2D(
                    *map(float, point)
                )
            feature.SetGeometry(line)
            if driver != "DXF":
                feature.SetField("NAME", title)
                feature.SetField("friction", 0.5 + k)
            layer.CreateFeature(feature)
        return path

    def in_unit(self, drawing, unit):
        """Returns the drawing after setting its unit to a code of DXF."""
        text, count = re.subn(r"(\$INSUNITS\s+70\s+)\d+", rf"\g<1>{unit}", drawing.read_text())
        self.assertEqual(count, 1)
        drawing.write_text(text)
        return drawing

    def expect_traces(self, found, names=True):
        self.assertEqual(len(found), len(TRACES))
        for outline, (name, points) in zip(found, TRACES.items()):
            self.assertTrue(np.allclose(outline.points, points), outline)
            if names:
                self.assertEqual(outline.name, name)

    def refused(self, path, *words, dim=2):
        with self.assertRaises(NetworkError) as caught:
            exchange.read(path, dim)
        for word in (str(path), *words):
            self.assertIn(word, str(caught.exception))

    def test_geojson(self):
        lines = [
            ("LineString", x, {"name": name, "id": 10 + k, "friction coefficient": 0.4 + k})
            for k, (name, x) in enumerate(TRACES.items())
        ]
        found = exchange.read(self.geojson([*lines, ("Point", [0.1, 0.1], {})], crs=None), 2)
        self.expect_traces(found)
        self.assertEqual([row.number for row in found], ["10", "11"])
        self.assertEqual(
            [row.properties for row in found], [{"friction coefficient": "0.4"}, {"friction coefficient": "1.4"}]
        )
        self.assertIn("feature 2", found[1].title)
        several = exchange.read(
            self.geojson([("MultiLineString", list(TRACES.values()), {"name": "both"})], crs=None), 2
        )
        self.assertEqual([row.name for row in several], ["both", "both"])

    def test_files_of_other_programs(self):
        """Reads files written by GDAL: shapefiles with and without a system, a GeoPackage, polylines of a drawing."""
        self.expect_traces(exchange.read(self.write_by_ogr("ESRI Shapefile", "utm.shp", 25832), 2))
        self.expect_traces(exchange.read(self.write_by_ogr("ESRI Shapefile", "local.shp"), 2))
        self.expect_traces(exchange.read(self.write_by_ogr("GPKG", "net.gpkg", 25832), 2))
        drawing = self.in_unit(self.write_by_ogr("DXF", "net.dxf"), 6)
        found = exchange.read(drawing, 2)
        self.expect_traces(found, names=False)
        self.assertEqual([row.properties for row in found], [{}, {}])
        self.assertEqual(
            sorted(Path(file).suffix for file in exchange.files_of(str(self.folder / "utm.shp"))),
            [".dbf", ".prj", ".shp", ".shx"],
        )
        self.assertEqual(exchange.read(self.folder / "utm.shp", 2)[1].properties, {"friction": "1.5"})

    def test_polygons(self):
        ring = [[0.2, 0.2, 0.5], [0.8, 0.2, 0.5], [0.8, 0.8, 0.6], [0.2, 0.8, 0.6], [0.2, 0.2, 0.5]]
        (found,) = exchange.read(self.geojson([("Polygon", [ring], {})], crs=None), 3)
        self.assertTrue(np.allclose(found.points, ring[:-1]))
        (found,) = exchange.read(self.geojson([("LineString", ring, {})], crs=None), 3)
        self.assertTrue(np.allclose(found.points, ring[:-1]))
        for kind, x, why in (
            ("Polygon", [[p[:2] for p in ring]], "has no z"),
            ("LineString", ring[:-1], "not closed"),
            ("Polygon", [ring, [[0.4, 0.4, 0.5], [0.5, 0.4, 0.5], [0.5, 0.5, 0.5], [0.4, 0.4, 0.5]]], "with holes"),
        ):
            self.refused(self.geojson([(kind, x, {})], crs=None), "feature 1", why, dim=3)
        self.refused(self.geojson([("Polygon", [ring], {})], crs=None), "is a polygon; in 2D fractures are lines")

    def test_coordinates_must_be_metric(self):
        lines = [("LineString", x, {}) for x in TRACES.values()]
        self.refused(self.geojson(lines), "longitude and latitude in degrees", "\"crs\": null")
        self.refused(
            self.geojson(lines, crs={"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}),
            "in degrees",
            "UTM",
        )
        self.expect_traces(
            exchange.read(self.geojson(lines, crs={"type": "name", "properties": {"name": "EPSG:25832"}}), 2),
            names=False,
        )
        for crs, why in (
            ("EPSG:999999", "names the coordinate system \"EPSG:999999\", which GDAL does not know"),
            ("nonsense", "names the coordinate system \"nonsense\", which GDAL does not know"),
            ("EPSG:4978", "has coordinates from the centre of the earth"),
        ):
            path = self.geojson(lines, crs={"type": "name", "properties": {"name": crs}})
            self.refused(path, why)
        self.refused(self.geojson(lines, crs="EPSG:25832"), "\"crs\" is \"EPSG:25832\", expected null or ")
        self.refused(self.write_by_ogr("ESRI Shapefile", "degrees.shp", 4326), "WGS 84", "in degrees")
        self.refused(self.write_by_ogr("ESRI Shapefile", "feet.shp", 2263), "US survey foot")
        drawing = self.write_by_ogr("DXF", "net.dxf")
        self.refused(self.in_unit(drawing, 4), "in the unit 4 of DXF", "give \"unit\" of its set, as \"1 mm\"")
        for unit in (6, 0):
            self.expect_traces(exchange.read(self.in_unit(drawing, unit), 2), names=False)

    def test_damaged_files(self):
        self.refused(self.folder / "absent.shp", "No such file")
        broken = self.folder / "net.geojson"
        broken.write_text("{\"type\": \"FeatureCollection\", ")
        self.refused(broken, "cannot be read")
        self.refused(self.geojson([], crs=None), "has no fracture")
        for x, why in (
            ([["a", "b"], [1, 2]], "feature 2: has the coordinate \"a\", expected a number"),
            ([[1, None], [1, 2]], "feature 2: has the coordinate null, expected a number"),
            ("text", "feature 2: has the coordinates \"text\", expected a list"),
            ([[1], [2]], "feature 2: has a point of 1 coordinate"),
            ([[1, 2], [1e300, 2]], "feature 2: has the coordinate 1e+300 m; at most 1e+12 m"),
        ):
            self.refused(self.geojson([("Point", [0, 0], {}), ("LineString", x, {})], crs=None), why)
        self.refused(self.geojson([("Blob", [[1, 2], [3, 4]], {})], crs=None), "has a geometry of the type \"Blob\"")
        for content, why in (
            ("[]", "is not GeoJSON"),
            ("{", "is not valid JSON"),
            ('{"crs": null, "features": [3]}', "feature 1: "),
        ):
            broken.write_text(content)
            self.refused(broken, why)
        for name, content, why in (
            ("net.dxf", "nonsense\n", "is not in the format DXF"),
            ("net.dxf", "  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n 10\nabc\n", "line "),
            ("net.shp", "text", "is not in the format ESRI Shapefile"),
        ):
            broken = self.folder / name
            broken.write_text(content)
            self.refused(broken, f"cannot be read: {why}")
            with self.assertRaises(NetworkError) as caught:
                exchange.read(broken, 2)
            self.assertNotIn("cpp", str(caught.exception))
        self.refused(
            self.geojson([(None, None, {}), ("LineString", [[0.5, 0.5], [0.5, 0.5]], {})], crs=None),
            "feature 1: has no geometry",
            "feature 2: has 1 different points",
        )

    def network(self, path):
        domain = {"corners": [], "faces": {}, **SQUARE}
        return Network(as_xml("network", {**DEFAULTS, "domain": domain, "fractures": {"set": {"file": str(path)}}}))

    def test_equal_names(self):
        """Features with one name form one fracture if their ends meet, or if they are parts of one feature."""
        lines = [[[0.1, 0.1], [0.2, 0.1]], [[0.2, 0.1], [0.3, 0.2]], [[0.5, 0.5], [0.6, 0.5]]]
        features = [("LineString", x, {"id": 0, "Remark": "a \"b\""}) for x in lines]
        bent = self.network(self.geojson(features[:2], crs=None)).fractures
        self.assertEqual([one.single for one in bent], ["set 0"] * 2)
        path = self.geojson(features, crs=None)
        with self.assertRaises(NetworkError) as caught:
            self.network(path)
        for word in (f"fracture 0 ({path}: feature 3)", f"fracture 0 ({path}: feature 1)", "does not meet it"):
            self.assertIn(word, str(caught.exception))
        several = self.network(self.geojson([("MultiLineString", lines, {"name": "both"})], crs=None)).fractures
        self.assertEqual([one.single for one in several], ["both"] * 3)

    def test_network(self):
        """In a scene the ending determines the file type. All files of a shapefile are input files."""
        path = self.write_by_ogr("ESRI Shapefile", "net.shp")
        domain = {"corners": [], "faces": {}, **SQUARE}
        network = Network(as_xml("network", {**DEFAULTS, "domain": domain, "fractures": {"set": {"file": str(path)}}}))
        self.assertEqual([feature.group for feature in network.fractures], ["set", "set"])
        self.assertTrue(np.allclose(network.fractures[1].points, TRACES["F2"]))
        self.assertEqual(len(network.files), 3)


if __name__ == "__main__":
    main()
