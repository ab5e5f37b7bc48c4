#!/usr/bin/env python3
"""Export of fractures to geographic information systems: export_test.py PROGRAM ROOT MPIEXEC

Requires Debian's python3-gdal, python3-numpy, python3-matplotlib and python3-vtk9. If one is missing, the status is 77,
for ctest's "skipped"."""
import contextlib
import importlib.util
import io
import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

MISSING = [name for name in ("osgeo", "matplotlib", "numpy", "vtkmodules") if importlib.util.find_spec(name) is None]
if MISSING:
    print(f"skipped: {sys.executable} has no {', '.join(MISSING)}")
    sys.exit(77)

import numpy as np  # noqa: E402
from program import ROOT, ProgramTest, main  # noqa: E402

sys.path[:0] = [str(ROOT / folder) for folder in ("apps/mesh", "apps/export")]
spec = importlib.util.spec_from_file_location("sprekk_export", ROOT / "apps" / "export" / "__main__.py")
app = importlib.util.module_from_spec(spec)
spec.loader.exec_module(app)

import exchange  # noqa: E402
import features  # noqa: E402


class ExportTest(ProgramTest):
    def export(self, file, *words, expect=0):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = app.main([str(self.folder / "out"), "-o", str(self.folder / file), *words])
        self.assertEqual(status, expect, err.getvalue())
        if expect:
            return err.getvalue()
        return json.loads((self.folder / file).read_text())["features"] if file.endswith("json") else None

    def test_traces(self):
        """Traces are lines between their ends, without mesh points, with the values of the results.

        Shapefiles are equal."""
        steps = self.run_scene("verification/crossing_2d.xml")["steps"]
        found = {feature["properties"]["name"]: feature for feature in self.export("net.geojson")}
        self.assertEqual(sorted(found), sorted(steps[-1]["fractures"]))
        for name, wanted in steps[-1]["fractures"].items():
            values, points = found[name]["properties"], np.array(found[name]["geometry"]["coordinates"])
            self.assertEqual(points.shape, (2, 2))
            self.assertAlmostEqual(np.linalg.norm(points[1] - points[0]), wanted["area"], 9)
            for ours, theirs in (
                ("length", "area"),
                ("slip_mean", "mean_slip"),
                ("slip_max", "max_slip"),
                ("open_max", "max_opening"),
                ("part_slip", "fraction_slip"),
                ("part_open", "fraction_open"),
            ):
                self.assertAlmostEqual(values[ours], wanted[theirs], 12, ours)
            self.assertTrue(np.isclose(values["normal_tr"], wanted["mean_traction"]["local"][0], rtol=1e-9))
        self.export("net.shp", "--crs", "EPSG:25832")
        again = exchange.read(str(self.folder / "net.shp"), 2)
        for row in again:
            self.assertTrue(np.allclose(row.points, found[row.name]["geometry"]["coordinates"]))
            self.assertAlmostEqual(float(row.properties["slip_max"]), found[row.name]["properties"]["slip_max"], 9)
        self.assertEqual(len(exchange.read(str(self.folder / "net.geojson"), 2)), len(found))

    def test_shapefiles_keep_large_numbers(self):
        """Shapefiles store numbers with a fixed width."""
        (wanted,) = self.run_scene(ROOT / "docs/shear_test.xml", "Time.steps=2")["steps"][-1]["fractures"].values()
        self.export("net.shp")
        (row,) = exchange.read(str(self.folder / "net.shp"), 2)
        self.assertLess(wanted["mean_traction"]["local"][0], -1e6)
        self.assertTrue(np.isclose(float(row.properties["normal_tr"]), wanted["mean_traction"]["local"][0], rtol=1e-12))
        self.assertTrue(np.isclose(float(row.properties["slip_mean"]), wanted["mean_slip"], rtol=1e-9))

    def test_planes(self):
        """A plane fracture is an outline of its corners, equal to the polygon of the scene."""
        steps = self.run_scene("seed/immersed_3d.xml", "Mesh.cells={6, 6, 6}", "Time.steps=1")["steps"]
        (one,) = self.export("net.geojson", "--time", "1")
        ((name, wanted),) = steps[-1]["fractures"].items()
        self.assertEqual(one["properties"]["name"], name)
        self.assertAlmostEqual(one["properties"]["area"], wanted["area"], 9)
        ring = np.array(one["geometry"]["coordinates"][0])
        self.assertEqual(ring.shape, (5, 3))
        from orientations import area_vector

        self.assertAlmostEqual(np.linalg.norm(area_vector(ring[:-1])), wanted["area"], 9)
        (again,) = exchange.read(str(self.folder / "net.geojson"), 3)
        self.assertTrue(np.allclose(again.points, ring[:-1]))
        self.export("net.shp")
        (again,) = exchange.read(str(self.folder / "net.shp"), 3)
        self.assertAlmostEqual(np.linalg.norm(area_vector(again.points)), wanted["area"], 9)

    def test_bends_stay(self):
        points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0]])
        self.assertEqual(features.corners_of(points, closed=False).tolist(), points[[0, 2, 3]].tolist())

    def test_errors(self):
        self.assertIn("contains no results.json", self.export("net.geojson", expect=1))
        self.run_scene("verification/crossing_2d.xml", "Output.vtu=false")
        self.assertIn("contains no fractures.pvd", self.export("net.geojson", expect=1))
        self.assertIn("ends in none of .geojson", self.export("net.txt", expect=1))
        self.assertIn("expected EPSG:NUMBER", self.export("net.geojson", "--crs", "utm", expect=1))
        for file in ("net.geojson", "net.shp"):
            for crs, why in (("EPSG:999999", "is unknown to GDAL"), ("EPSG:4326", "WGS 84 is in degrees")):
                self.assertIn(f"--crs {crs}: {why}", self.export(file, "--crs", crs, expect=1))
        said = self.export("absent/net.geojson", expect=1)
        self.assertIn("net.geojson: cannot be written: there is no folder", said)
        self.assertFalse((self.folder / "absent").exists())
        (self.folder / "out/results.json").write_text("[]")
        self.assertIn("results.json: the content is [], expected an object;", self.export("net.geojson", expect=1))

    def test_damaged_files(self):
        """An empty, truncated or missing file gives one error with its name and no messages of VTK.

        An earlier export stays."""
        self.run_scene("verification/crossing_2d.xml")
        piece = sorted((self.folder / "out/fractures").glob("fractures_*.vtu"))[-1]
        whole, made = piece.read_bytes(), self.folder / "net.geojson"
        made.write_text("earlier")
        command = [sys.executable, "-B", ROOT / "apps/export", self.folder / "out", "-o", made]
        for content in (b"", whole[:100], whole[: len(whole) // 2], whole[:-200], None):
            piece.unlink() if content is None else piece.write_bytes(content)
            done = subprocess.run(command, capture_output=True, text=True)
            why = "no such file" if content is None else "is damaged or not complete; run the scene again"
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertEqual(done.stderr, f"sprekk export: {piece}: {why}\n")
            self.assertEqual(made.read_text(), "earlier")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["net.geojson", "out"])

    def test_blocks_of_earlier_versions(self):
        """Earlier versions wrote pieces instead of nested blocks."""
        self.run_scene("verification/crossing_2d.xml")
        names = [feature["properties"]["name"] for feature in self.export("net.geojson")]
        for file in (self.folder / "out").glob("fractures_*.vtm"):
            file.write_text(file.read_text().replace("<Block ", "<Piece ").replace("</Block>", "</Piece>"))
        self.assertEqual([feature["properties"]["name"] for feature in self.export("net.geojson")], names)

    def test_shapefiles_are_replaced(self):
        """An export replaces all files of a shapefile."""
        self.run_scene("verification/crossing_2d.xml")
        for words, endings in ((("--crs", "EPSG:25832"), {".prj"}), ((), set())):
            self.export("net.shp", *words)
            found = {path.suffix for path in self.folder.glob("net.*")}
            self.assertEqual(found, {".shp", ".shx", ".dbf", ".cpg"} | endings)


if __name__ == "__main__":
    main()
