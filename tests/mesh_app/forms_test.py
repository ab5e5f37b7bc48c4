#!/usr/bin/env python3
"""Forms of tables and maps as published, read with repairs: forms_test.py PROGRAM ROOT MPIEXEC"""
import importlib.util
import json
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
from conformity import CUBE, DEFAULTS, SQUARE, as_xml  # noqa: E402
from program import ROOT, ProgramTest, main  # noqa: E402

sys.path.insert(0, str(ROOT / "apps" / "mesh"))
from description import Network  # noqa: E402
from plan import Plan  # noqa: E402
from shapes import NetworkError  # noqa: E402

GDAL = importlib.util.find_spec("osgeo") is not None
TRACES = [[0.2, 0.5, 0.8, 0.5], [0.5, 0.2, 0.5, 0.8]]  # x0, y0, x1, y1


class FormsTest(ProgramTest):
    def network(self, name, content, dim=2, unit=None, **entries):
        """Returns the network of a file, text or bytes, with repairs."""
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        described = {**DEFAULTS, "domain": SQUARE if dim == 2 else CUBE, "fractures": {"set": {"file": str(path), **({"unit": unit} if unit else {})}}, "repair": "join", **entries}
        return Network(as_xml("network", described))

    def are_traces(self, net):
        self.assertEqual(len(net.fractures), 2)
        for fracture, trace in zip(net.fractures, TRACES):
            self.assertTrue(np.allclose(fracture.points[[0, -1]].ravel(), trace), fracture.points)

    def rows(self, columns, separator=",", comma=False):
        """Returns the rows of a long table, a point each, from {title: "id", "x", "y", "z" or a text}."""
        found = [separator.join(columns)]
        for k, trace in enumerate(TRACES):
            for x, y in (trace[:2], trace[2:]):
                values = {"id": str(k + 1), "x": str(x), "y": str(y), "z": "7.5"}
                row = [values.get(what, what) for what in columns.values()]
                found.append(separator.join(word.replace(".", ",") if comma else word for word in row))
        return found


class Tables(FormsTest):
    def test_titles_of_points(self):
        """Points of lines with other titles, in any order, with further columns."""
        for columns in ({"id": "id", "x": "x", "y": "y"}, {"Y": "y", "X": "x", "Fracture": "id"}, {"Northing": "y", "trace_id": "id", "Easting": "x"},
                        {"z": "z", "x [m]": "x", "y [m]": "y", "LineID": "id"}, {"name": "id", "EASTING": "x", "NORTHING": "y", "elevation": "z"},
                        {"POINT_X": "x", "POINT_Y": "y", "OBJECTID": "id"}, {"X_Coord": "x", "Y_Coord": "y", "Trace No": "id", "depth": "z"}):
            with self.subTest(tuple(columns)):
                self.are_traces(self.network("a.csv", "\n".join(self.rows(columns))))

    def test_titles_of_lines(self):
        """Lines with two end points, under other titles."""
        for titles in ("x0,y0,x1,y1", "x1,y1,x2,y2", "X_start,Y_start,X_end,Y_end", "StartX,StartY,EndX,EndY", "from_x,from_y,to_x,to_y",
                       "start easting,start northing,end easting,end northing"):
            for order in ((0, 1, 2, 3), (3, 0, 2, 1)):
                with self.subTest(titles, order=order):
                    rows = [[titles.split(",")[k] for k in order], *([str(trace[k]) for k in order] for trace in TRACES)]
                    self.are_traces(self.network("a.csv", "\n".join(map(",".join, rows))))

    def test_text(self):
        """Byte order marks, line ends of Windows, semicolons, tabs, decimal commas, comments, empty rows, upper-case suffix."""
        columns = {"id": "id", "x": "x", "y": "y"}
        for separator in (";", "\t"):
            for mark in ("", "\ufeff"):
                rows = ["# map of the outcrop", *self.rows(columns, separator, True), "", separator * 2]
                self.are_traces(self.network("A.CSV", mark + "\r\n".join(rows) + "\r\n"))

    def test_depth(self):
        """Polygons of points with a depth, positive downwards."""
        box = {**CUBE, "lower corner": [0.0, 0.0, -1.0], "upper corner": [1.0, 1.0, 0.0]}
        rows = ["depth;northing;easting;fracture", *(f"0,5;{y};{x};1" for x, y in (("0,2", "0,2"), ("0,8", "0,2"), ("0,5", "0,8")))]
        net = self.network("a.csv", "\n".join(rows), 3, domain=box)
        self.assertTrue(np.allclose(net.fractures[0].points, [[0.2, 0.2, -0.5], [0.8, 0.2, -0.5], [0.5, 0.8, -0.5]]))

    def test_degrees(self):
        for titles in ("id,longitude,latitude", "lon,lat,id"):
            with self.assertRaisesRegex(NetworkError, r"a.csv: line 1: column \d has the title \"lon\w*\", which means degrees"):
                self.network("a.csv", titles + "\n1,2,3\n1,4,5\n")

    def test_encodings(self):
        """Text as UTF-8 with a byte order mark, UTF-16 and Latin-1, with a name that is not ASCII."""
        rows = "".join(f"Störung {k};{x};{y}\n" for k, t in enumerate(TRACES) for x, y in (t[:2], t[2:])).replace(".", ",")
        for encoding in ("utf-8-sig", "utf-16", "latin-1"):
            with self.subTest(encoding):
                net = self.network("a.csv", f"name;x;y\n{rows}".encode(encoding))
                self.are_traces(net)
                self.assertEqual(net.fractures[1].single, "Störung 1")

    def test_rows_without_geometry(self):
        """Rows with missing numbers and single points are left out and listed; words that are no numbers are errors."""
        points = ["id,x,y", "7,nan,nan", *(f"{k},{x},{y}" for k, t in enumerate(TRACES) for x, y in (t[:2], t[2:])), "8,,", "9,0.5,0.5", "10,NA,NA"]
        net = self.network("a.csv", "\n".join(points))
        self.are_traces(net)
        self.assertEqual([line.split(": ", 1)[1] for _, line in net.empty], [
            'line 2: "nan" in column 2 is not a finite number', 'line 7: has no number in column 2, "x"', 'line 9: "NA" in column 2 is not a number',
            "line 8): has 1 points, needs at least 2"])
        lines = ["id,x0,y0,x1,y1", *(f"{k},{','.join(map(str, t))}" for k, t in enumerate(TRACES)), "3,NaN,0,1,1", "4,,,,"]
        net = self.network("a.csv", "\n".join(lines))
        self.are_traces(net)
        self.assertEqual(len(net.empty), 2)
        with self.assertRaisesRegex(NetworkError, 'line 4: "NaN" in column 2 is not a finite number\n.*line 5: has no number in column 2'):
            self.network("a.csv", "\n".join(lines), repair="report")
        with self.assertRaisesRegex(NetworkError, '"left" in column 2 is not a number'):
            self.network("a.csv", "\n".join([*lines, "5,left,0,1,1"]))

    def test_loops_and_repeated_points(self):
        """Closed lines, repeated points, lines without length and duplicates."""
        ring = [(0.2, 0.2), (0.8, 0.2), (0.8, 0.2), (0.5, 0.8), (0.2, 0.2)]
        rows = ["id,x,y", *(f"1,{x},{y}" for x, y in ring), "2,0.1,0.1", "2,0.1,0.1", *(f"3,{x},{y}" for x, y in ring)]
        plan = Plan(self.network("a.csv", "\n".join(rows)))
        self.assertEqual(len(plan.faces()), 2)
        self.assertEqual([entry.reason for entry in plan.network.journal.entries.values()], ["", "short", "duplicate"])


@unittest.skipUnless(GDAL, "requires python3-gdal")
class Maps(FormsTest):
    def written(self, name, driver, geometries, epsg=25832):
        """Writes a file of GDAL with geometries as well-known text."""
        from osgeo import ogr, osr
        system = osr.SpatialReference()
        system.ImportFromEPSG(epsg)
        source = ogr.GetDriverByName(driver).CreateDataSource(str(self.folder / f"map{Path(name).suffix.lower()}"))
        layer = source.CreateLayer("traces", None if driver == "DXF" else system, ogr.wkbUnknown if driver != "ESRI Shapefile" else ogr.wkbMultiLineString25D)
        for text in geometries:
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(text and ogr.CreateGeometryFromWkt(text))
            layer.CreateFeature(feature)
        del layer, source
        for file in self.folder.glob("map.*"):
            file.rename(file.with_name(file.name.replace("map", "a").upper() if name.isupper() else file.name.replace("map", "a")))
        return (self.folder / name).read_bytes()

    def test_formats(self):
        """Lines with heights, in several parts, of arcs, and features without geometry, in all formats."""
        lines = ["LINESTRING Z (0.2 0.5 3, 0.8 0.5 4)", "MULTILINESTRING Z ((0.5 0.2 1, 0.5 0.6 1), (0.5 0.6 1, 0.5 0.8 1))"]
        for name, driver in (("a.gpkg", "GPKG"), ("A.SHP", "ESRI Shapefile"), ("a.geojson", "GeoJSON"), ("a.dxf", "DXF")):
            with self.subTest(name):
                given = lines + [None] * (driver != "DXF")
                unit = {"unit": 1.0} if driver == "DXF" else {}
                plan = Plan(self.network(name, self.written(name, driver, given), **unit))
                length = sum(np.linalg.norm(plan.points[a] - plan.points[b]) for (a, b), of in plan.edges.items() if plan.fractures_of(of))
                self.assertAlmostEqual(length, 1.2, 9)
                self.assertEqual(len(plan.network.empty), int(driver != "DXF"))

    def test_unit_without_meaning(self):
        """GDAL writes drawings in metres with the unit of inches. Metres count if the map meets the domain only in metres."""
        far = {**SQUARE, "lower corner": [100.0, 100.0], "upper corner": [101.0, 101.0]}
        drawing = self.written("a.dxf", "DXF", ["LINESTRING (100.2 100.5, 100.8 100.5)"])
        net = self.network("a.dxf", drawing, domain=far)
        self.assertAlmostEqual(net.fractures[0].points[0, 0], 100.2)
        self.assertIn("is in metres, not in the unit 1 of DXF", net.joined[0])
        for domain in (SQUARE, {**SQUARE, "upper corner": [200.0, 200.0]}):
            with self.assertRaisesRegex(NetworkError, "is a drawing in the unit 1 of DXF"):
                self.network("a.dxf", drawing, domain=domain)

    def test_polygons_of_a_map_are_left_out(self):
        """The outline of an outcrop in the layer of its traces is listed, not an error."""
        net = self.network("a.gpkg", self.written("a.gpkg", "GPKG", ["LINESTRING (0.2 0.5, 0.8 0.5)", "POLYGON ((0 0, 1 0, 1 1, 0 0))"]))
        self.assertEqual(len(net.fractures), 1)
        self.assertIn("is a polygon; in 2D fractures are lines", net.empty[0][1])

    def test_degrees(self):
        with self.assertRaisesRegex(NetworkError, "has longitudes and latitudes in degrees"):
            self.network("a.gpkg", self.written("a.gpkg", "GPKG", ["LINESTRING (0.2 0.5, 0.8 0.5)"], 4326))
        text = json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [[11.1, 47.2], [11.2, 47.3]]}}]})
        with self.assertRaisesRegex(NetworkError, "longitude and latitude in degrees"):
            self.network("a.json", text)


if __name__ == "__main__":
    main()
