#!/usr/bin/env python3
"""From scenes to meshes and runs: program_test.py PROGRAM ROOT MPIEXEC"""
import contextlib
import importlib.util
import io
import os
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
import program  # noqa: E402
from mesh_program import MeshTest, app  # noqa: E402
from program import ROOT, main  # noqa: E402


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

    def test_number_in_place_of_a_word(self):
        net = self.write("net.csv", "id,x0,y0,x1,y1,Friction", "1,0.2,0.5,0.8,0.5,Coulomb", "2,0.2,0.6,0.8,0.6,0.5", "3,0.2,0.7,0.8,0.7,0.4")
        reported = self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}), expect=1)
        self.assertIn(f'fracture 2 ({net}: line 3): "friction" is "0.5", must be one of "Coulomb", "Barton-Choubey"', reported)
        self.assertTrue(reported.endswith('; 1 more with such an error; did you mean the title "friction coefficient"?\n'), reported)
        self.write("net.csv", "id,x0,y0,x1,y1,friction", "1,0.2,0.5,0.8,0.5,Coulomb", "2,0.2,0.6,0.8,0.6,", "3,0.2,0.7,0.8,0.7,no slip")
        self.assertIn("cells", self.mesh(self.scene(fractures={"set": {"file": "net.csv"}}, relative_size=0.2)))

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

    def test_fractures_outside_of_the_domain(self):
        """Less than half of a mapped trace in the domain gives a warning, and an error with --strict."""
        self.write("net.csv", "1,0.2,0.5,0.8,0.5", "2,0.5,0.7,0.5,1.2", "3,0.3,0.8,0.3,4")
        scene = self.scene(fractures={"set": {"file": "net.csv"}}, relative_size=0.2)
        for strict, status, opens in (((), 0, "warning"), (("--strict",), 1, "sprekk")):
            err = io.StringIO()
            with contextlib.redirect_stderr(err):
                words = [str(scene), "-o", str(self.folder / "net.msh"), "--program", str(program.PROGRAM), "--quiet", *strict]
                self.assertEqual(app.main(words), status)
            self.assertRegex(err.getvalue(), rf"^{opens}: .*scene.xml: 1 of 3 fractures have less than half of their length in the mesh, "
                                             r"the rest is outside of the domain or left out: fracture 3 \(.*net.csv: line 3\)\n$")

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
            self.assertEqual(reported, "sprekk: net.csv: line 1: has 4 columns, needs 5: id,x0,y0,x1,y1\n")
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
