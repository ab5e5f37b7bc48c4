#!/usr/bin/env python3
"""Content of reports: report_test.py PROGRAM ROOT MPIEXEC

Requires matplotlib, numpy and VTK's Python. If one is missing, the status is 77, for ctest's "skipped"."""

import base64
import contextlib
import importlib.util
import io
import json
import re
import subprocess
import sys
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "regression"))
from program import PROGRAM, ROOT, ProgramTest, main  # noqa: E402

MISSING = [name for name in ("matplotlib", "numpy", "vtkmodules") if importlib.util.find_spec(name) is None]
if MISSING:
    print(f"skipped: {sys.executable} has no {', '.join(MISSING)}")
    sys.exit(77)

spec = importlib.util.spec_from_file_location("sprekk_report", ROOT / "apps" / "report" / "__main__.py")
report = importlib.util.module_from_spec(spec)
spec.loader.exec_module(report)

import checks  # noqa: E402
import events  # noqa: E402
import figures  # noqa: E402
import numbers_in_words  # noqa: E402
import numpy as np  # noqa: E402
import page as report_page  # noqa: E402
import read  # noqa: E402
import scene  # noqa: E402
import shapes  # noqa: E402
import view  # noqa: E402


class ReportTest(ProgramTest):
    def write(self, *words, expect=0):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.assertEqual(
                report.main([str(self.folder / "out"), "--dpi", "40", *map(str, words)]), expect, err.getvalue()
            )
        return out.getvalue().strip() or err.getvalue()

    def verdicts(self):
        """Returns {name: check} of the present files of the run."""
        content = self.results()
        entries = scene.Scene(self.folder / "out", ROOT / "docs/use/reference.md")
        return {check.name: check for check in checks.of_run(self.folder / "out", content, entries)}

    def change(self, change):
        content = self.results()
        change(content)
        (self.folder / "out/results.json").write_text(json.dumps(content))


class Pages(ReportTest):
    def test_page_holds_all_there_is(self):
        """Without a viewer the page contains everything except the view, with a note, and no external references."""
        content = self.run_scene(ROOT / "docs/shear_test.xml", "Time.steps=8", "Output.error estimate=true")
        page = Path(self.write()).read_text()
        self.assertIn("has no 3D view", page)
        self.assertEqual(len(re.findall("<img ", page)), 9)
        tables = re.findall(r"<a download='(\w+.csv)' href='data:text/csv;base64,([^']*)'", page)
        self.assertEqual([name for name, _ in tables], ["events.csv", "fractures_long.csv", "fractures_wide.csv"])
        with mock.patch.object(report_page, "LARGEST_TABLE", 10):
            links = report_page.downloads([("a.csv", "short"), ("b.csv", "longer than ten")])
        self.assertIn("<a download='a.csv'", links)
        self.assertIn("too large for this page, written by <code>sprekk plot</code>: b.csv", links)
        self.assertTrue(base64.b64decode(tables[0][1]).startswith(b"fracture,start [s],end [s],slip [m],moment [N],"))
        self.assertEqual(re.findall(r"""(?:src|href)=['"](?!data:|#)[^'"]*""", page), [])
        slip = content["steps"][-1]["fractures"]["shear plane"]["max_slip"]
        self.assertIn(f"<td>{1e3 * slip:.4g}</td>", page)
        for words in (
            "8 steps up to",
            "estimated error of the stress",
            "Key figures",
            "no step was bisected",
            "largest memory",
        ):
            self.assertIn(words, page)

    def test_scene_in_words(self):
        """The scene lists entries that differ from defaults, with units. Sections with equal entries are merged."""
        self.run_scene("poro/injection_2d.xml", "Time.steps=1", "Time.end=100")
        entries = scene.Scene(self.folder / "out", ROOT / "docs/use/reference.md")
        blocks = {path[:-1] + (", ".join(names),): dict(said) for names, path, said in entries.blocks()}
        self.assertEqual(blocks["Materials", "granite"]["Young's modulus"], "40 GPa")
        self.assertEqual(blocks["Materials", "rough joint"]["tangential stiffness"], "10 GPa/m")
        self.assertEqual(blocks["Bulk",]["initial stress"], "(−25, −40, −30, 6) MPa")
        self.assertNotIn("skin", blocks["Flow", "Wells", "injector"])  # has the default value
        joined = [path for path in blocks if path[0] == "Fractures"]
        self.assertEqual([path[1].count(",") for path in joined], [10])

    def test_places_of_flow(self):
        """The summary distinguishes flow in rock and in fractures, with and without fractures."""
        for fields, faces, words in (
            (("pressure", "face pressure"), 3, "with flow in rock and fractures,"),
            (("face pressure",), 3, "with flow in fractures only,"),
            (("pressure", "face pressure"), 0, "with flow in rock,"),
        ):
            results = {
                "mesh": {"dimension": 2, "cells": 4, "fracture_faces": faces},
                "steps": [{"time": 1.0}],
                "blocks": {"fields": [{"name": name} for name in fields]},
            }
            said = report_page.summary(results, mock.Mock(entries={"Flow": {}}), "")
            self.assertIn(f"A plane section of rock {words} of 4 cells", said)

    def test_energy(self):
        """Work on fractures is the negative of that of their traction; parts of it are sums over the sets. In J/m in 2D."""
        work = {"loads": -200.0, "supports": 1500.0, "traction": -900.0, "face pressure": 100.0, "temperature": 300.0}
        energy = {"elastic": 500.0, "released": 40.0, "work": work, "balance": {"wells": 120.0, "fracture flow": -20.0}, "unassigned": 1e-12}
        sets = {"a": {"friction_energy": 250.0, "fracture_energy": 100.0}, "b": {"friction_energy": 50.0}}
        for dim, unit in ((2, "kJ/m"), (3, "kJ")):
            (table,) = figures.of_energy({"energy": energy, "fractures": sets}, dim)
            self.assertEqual(table.columns[1], f"energy ({unit})")
            rows = dict(table.rows)
            self.assertEqual(rows["work on fractures"], "0.9")
            self.assertEqual((rows["– dissipated by slip"], rows["– fracture energy"]), ("0.3", "0.1"))
            self.assertEqual((rows["work of the fluid on the rock"], rows["fluid: fracture flow"]), ("0.1", "−0.02"))
            self.assertEqual((rows["work of temperatures, from 0 K"], rows["released by extension or excavation"]), ("0.3", "0.04"))
            self.assertNotIn("unassigned", rows)
        self.assertEqual(list(figures.of_energy({}, 2)), [])

    def test_failed_run_is_reported(self):
        self.run_scene(
            ROOT / "docs/shear_test.xml", "Solver.maximum iterations=1", "Tables.ramp.values={0, 1000, 0}", expect=3
        )
        page = Path(self.write()).read_text()
        self.assertIn("did not converge", page)
        self.assertIn("class='failed'", page)
        self.assertIn("no bulk.png", page)

    def test_wrong_folders(self):
        self.assertIn("no such directory", self.write(expect=1))
        (self.folder / "out").mkdir()
        self.assertIn("contains no results.json", self.write(expect=1))
        self.run_scene("seed/push_2d.xml")
        said = self.write("--output", self.folder / "absent/report.html", expect=1)
        self.assertIn("report.html: cannot be written: there is no folder", said)
        self.assertFalse((self.folder / "absent").exists())

    def test_damaged_files(self):
        """A damaged file gives one error with its name, and no report."""
        self.run_scene("seed/push_2d.xml")
        piece = self.folder / "out/fractures/fractures_0000_0_0.vtu"
        piece.write_bytes(piece.read_bytes()[:1000])
        said = f"sprekk report: {piece}: is damaged or not complete; run the scene again\n"
        self.assertEqual(self.write(expect=1), said)
        (self.folder / "out/results.json").write_text("[]")
        self.assertIn("results.json: the content is [], expected an object;", self.write(expect=1))
        self.assertFalse((self.folder / "out/report.html").exists())


class Checks(ReportTest):
    def test_good_run_passes(self):
        self.run_scene("poro/injection_2d.xml", "Time.steps=2", "Time.end=3600")
        found = self.verdicts()
        self.assertEqual({check.verdict for check in found.values()}, {"passed", "noted"})
        for name in ("run", "convergence", "time steps", "laws of contact and friction", "balance of forces"):
            self.assertEqual(found[name].verdict, "passed", found[name])
        wells = self.results()["steps"][-1]
        stored = sum(wells["inflows"].values()) + wells["wells"]["injector"]["rate"]
        self.assertIn(f"{numbers_in_words.number(stored)} m²/s, is stored", found["balance of fluid"].words)

    def test_negative_storage_is_a_release(self):
        (check,) = checks.fluid([{"inflows": {"west": 1.0, "east": -3.0}}], 3)
        self.assertTrue(check.words.endswith("the sum, −2 m³/s, is released from storage"), check.words)

    def test_rates_per_depth(self):
        """Rates of a 2D scene are in m^2/s and W/m in checks, tables and scene; in 3D in m^3/s and W."""
        self.run_scene("poro/injection_2d.xml", "Time.steps=2", "Time.end=3600")
        page = Path(self.write()).read_text()
        self.assertIn("rate at the end (m²/s)", page)
        self.assertRegex(page, r"<dt>rate</dt><dd>[^<]* m\^2/s</dd>")
        for wrong in ("m³/s", "m^3/s"):
            self.assertNotIn(wrong, page)
        step = {"inflows": {"west": 1.0}, "heat_inflows": {"west": 1.0}, "wells": {"w": {"rate": 2.0, "heat": 3.0}}}
        for dim, units in (
            (2, ("3 m²/s, is stored", "3 W/m through wells")),
            (3, ("3 m³/s, is stored", "3 W through wells")),
        ):
            for check, unit in zip(checks.fluid([step], dim), units):
                self.assertIn(unit, check.words)
            (table,) = figures.of_wells([step], dim)
            self.assertEqual(table.columns[1], f"rate at the end ({numbers_in_words.RATES['fluid'][dim == 2]})")

    def test_stages(self):
        """With excavated faces and weaker joints the report does not check the contact laws."""
        content = self.run_scene("stages/gallery_2d.xml")
        self.assertEqual(content["status"], "completed")
        self.assertIn("not judged: the scene has stages", Path(self.write()).read_text())
        found = self.verdicts()
        self.assertEqual(found["laws of contact and friction"].verdict, "noted")
        self.assertNotIn("failed", {check.verdict for check in found.values()})
        rock, joints = view.of_run(self.folder / "out", content, read.scene(self.folder / "out"))["surfaces"]
        for surface in (rock, joints):  # before and after the excavation
            self.assertEqual(len({frame["triangles"] for frame in surface["frames"]}), 2)

    def test_forces_of_a_pressure(self):
        """Reactions that are round-off of the force of a pressure in fractures are balanced, others are not."""
        for force, verdict in ((1e-7, "passed"), (1e3, "failed")):
            step = {"reactions": {"side": [force, 0.0]}, "fractures": {"crack": {"area": 4.0, "mean_fracture_pressure": 1e7}}}
            found, = checks.forces([step], mock.Mock(has=lambda entry: False))
            self.assertEqual(found.verdict, verdict)

    def test_what_is_wrong_fails(self):
        self.run_scene("poro/injection_2d.xml", "Time.steps=2", "Time.end=3600")

        def spoil(content):
            content["status"], content["reason"] = "failed", "by hand"
            content["steps"][0].update(converged=False, cuts=1)
            content["steps"][-1]["reactions"]["west"][0] *= 1.001

        self.change(spoil)
        found = self.verdicts()
        self.assertEqual(
            {name for name, check in found.items() if check.verdict == "failed"},
            {"run", "convergence", "balance of forces"},
        )
        self.assertIn("by hand", found["run"].words)
        self.assertEqual(found["time steps"].verdict, "noted")
        scene_file = self.folder / "out/effective_input.xml"
        scene_file.write_text(
            scene_file.read_text().replace(
                'name="friction coefficient" type="double" value="0.5"',
                'name="friction coefficient" type="double" value="0.1"',
            )
        )
        self.assertEqual(self.verdicts()["laws of contact and friction"].verdict, "failed")

    def test_joints_of_their_own_are_judged(self):
        """The check of contact laws uses the own entries of single fractures."""
        mapped, mesh = self.scene("networks/mapped_2d.xml"), self.folder / "n.msh"
        mesher = [sys.executable, "-B", ROOT / "apps/mesh", mapped, "-o", mesh, "--program", PROGRAM, "--quiet"]
        subprocess.run(mesher, check=True)  # separate process: equal names of modules
        self.run_scene(mapped, f"Mesh file.path={mesh}")
        name = "laws of contact and friction"
        self.assertEqual(self.verdicts()[name].verdict, "passed", self.verdicts()[name])
        a1 = self.results()["single_fractures"][0]["own_joint"]
        self.assertEqual(a1, {"material": "mapped joint", "friction coefficient": "0.55", "initial aperture": "0.0002"})

        html = Path(self.write()).read_text()
        self.assertIn("has 12 fractures in 1 set (", html)
        table = html.split("Joints of single fractures")[1].split("</table>")[0]
        self.assertIn("<td>A1</td><td>mapped joint</td><td>0.55</td><td>200 µm</td>", table)

        def spoil(content):
            for one in content["single_fractures"]:
                one.get("own_joint", {})["friction coefficient"] = "0.05"

        self.change(spoil)
        self.assertEqual(self.verdicts()[name].verdict, "failed")

    def test_reaction_of_one_boundary_is_judged_by_forces_on_fractures(self):
        """Round-off passes, a force does not."""
        fractures = {"fault": {"area": 100.0, "mean_traction": {"global": [2e6, -1e7]}}}
        for reaction, verdict in (1e-5, "passed"), (1e5, "failed"):
            step = {"reactions": {"far field": [0.0, reaction]}, "fractures": fractures}
            (check,) = checks.forces([step], mock.Mock(has=lambda entry: False))
            self.assertEqual(check.verdict, verdict, check)

    def test_other_loads_carry_reactions(self):
        self.run_scene(ROOT / "docs/shear_test.xml", "Time.steps=2")
        self.assertIn("(traction, body force)", self.verdicts()["balance of forces"].words)


class Views(ReportTest):
    def view(self):
        """Returns the data of the view, with a function that returns its arrays."""
        content, entries = self.results(), read.scene(self.folder / "out")
        shown = view.of_run(self.folder / "out", content, entries, events.of_run(self.folder / "out", content))
        return shown, lambda k, kind: np.frombuffer(base64.b64decode(shown["arrays"][k]), dtype=kind)

    def values(self, array, surface, name, step):
        """Returns the values of a field at a step, in the unit of its name."""
        k = next(k for k, one in enumerate(surface["fields"]) if one["name"].startswith(name))
        low, high = surface["fields"][k]["range"]
        return low + (high - low) * array(surface["frames"][step]["values"][k], np.uint16) / 65535

    def test_body(self):
        """Values, positions and numbers of all steps are those of the files; equal arrays are stored once."""
        content = self.run_scene("verification/crossing_3d.xml")
        shown, array = self.view()
        rock, joints = shown["surfaces"]
        self.assertEqual([rock["name"], joints["name"]], ["rock", "fractures"])
        self.assertLess(rock["opacity"], joints["opacity"])
        steps = read.written_steps(self.folder / "out", "fractures")
        self.assertEqual(len(shown["times"]), len(steps))
        for k, (_, file) in enumerate(steps):
            data = read.arrays(read.grid(file).GetCellData())
            shear = np.linalg.norm(data["jump local"][:, 1:], axis=1)
            found = self.values(array, joints, "tangential jump", k)
            self.assertEqual(len(found), len(shear))
            self.assertTrue(
                np.allclose(found / np.max(found), shear / np.max(shear), atol=1e-3) or np.max(shear) < 1e-9
            )
        frame = joints["frames"][-1]
        triangles, points = array(frame["triangles"], np.uint32), array(frame["points"], np.float32)
        self.assertEqual(len(array(frame["owner"], np.uint32)), len(triangles) // 3)
        self.assertLess(triangles.max(), len(points) // 3)
        self.assertEqual(set(array(frame["numbers"], np.uint16)), set(range(len(content["single_fractures"]))))
        self.assertEqual(len({one["points"] for one in joints["frames"]}), 1)
        self.assertEqual(len(set(shown["arrays"])), len(shown["arrays"]))
        moved = array(rock["frames"][-1]["displacement"], np.int16) * rock["scale"]
        grid = read.grid(read.written_steps(self.folder / "out", "bulk")[-1][1])
        displacement = read.arrays(grid.GetPointData())["displacement"]
        self.assertAlmostEqual(np.max(abs(moved)) / np.max(abs(displacement)), 1, 3)
        self.assertEqual(
            [one["name"] for one in shown["fractures"]], [one["name"] for one in content["single_fractures"]]
        )
        moments = next(one["values"] for one in shown["tables"] if one["name"].startswith("moment (N m)"))
        wanted = content["steps"][-1]["single_fractures"]["moment"]
        self.assertEqual(moments[-1], figures.column("", wanted, "")[1])

    def test_plane(self):
        """In 2D traces are bands of the same length, in front of the rock; wells have their places."""
        self.run_scene("poro/injection_2d.xml", "Time.steps=2", "Time.end=7200")
        shown, array = self.view()
        rock, joints = shown["surfaces"]
        self.assertEqual(rock["opacity"], 1)
        points = [array(one["frames"][-1]["points"], np.float32).reshape(-1, 3) for one in (rock, joints)]
        self.assertGreater(points[1][:, 2].min(), points[0][:, 2].max())
        lines = read.segments(read.grid(read.written_steps(self.folder / "out", "fractures")[-1][1]))
        lengths = [np.linalg.norm(np.diff(ends[:2], axis=0)) for ends in lines.corners()]
        bands = points[1].reshape(-1, 4, 3)
        self.assertTrue(np.allclose(np.linalg.norm(bands[:, 1] - bands[:, 0], axis=1), lengths, rtol=1e-5))
        (well,) = shown["wells"]
        self.assertEqual((well["name"], well["points"]), ("injector", [[-2.5, 0, 0]]))
        self.assertEqual([label["text"] for label in shown["labels"]], ["x = 200 m", "y = 200 m", "(0, 0) m"])
        self.assertEqual(shown["times"], ["t = 60 min", "t = 2 h"])

    def test_pieces_of_ranks_share_points(self):
        """Two squares with a common side have six points, and the values of their polygons."""
        square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
        pieces = read.Surface(
            np.concatenate([square, square + [1, 1e-14, 0]]), [np.arange(4), np.arange(4, 8)], {"slip": np.ones(2)}, {}
        )
        whole = shapes.merged(pieces)
        self.assertEqual(len(whole.points), 6)
        self.assertEqual(list(whole.cell_data), ["slip"])
        for corners, known in zip(whole.corners(), pieces.corners()):
            self.assertTrue(np.allclose(corners, known))

    def test_steps_of_a_small_view(self):
        """Of more steps than the view has room for, it contains the first and the last one."""
        self.run_scene(ROOT / "docs/shear_test.xml", "Time.steps=12", "Output.every=1")
        with mock.patch.object(view, "MAX_FRAMES", 2):
            shown, array = self.view()
        self.assertEqual(len(shown["times"]), 2)
        self.assertEqual(shown["times"][-1], "t = 2 s")
        self.assertTrue(all(len(surface["frames"]) == 2 for surface in shown["surfaces"]))

    def test_large_surfaces_are_thinned(self):
        """A wavy surface has fewer triangles at almost the same place, with the values of its points."""
        n = 300
        x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
        points = np.column_stack([x.ravel(), y.ravel(), 0.1 * np.sin(6 * x.ravel())])
        k = np.arange(n * n).reshape(n, n)
        square = np.stack([k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]], -1).reshape(-1, 4)
        shape = shapes.of_surface(read.Surface(points, list(square), {}, {}))
        self.assertLessEqual(len(shape.triangles), 1.05 * shapes.MAX_TRIANGLES)
        self.assertTrue(np.allclose(shape.points[:, 2], 0.1 * np.sin(6 * shape.points[:, 0]), atol=1e-5))
        self.assertTrue(
            np.allclose(shape.of_polygons(points[square].mean(axis=1)[:, 0]), shape.points[:, 0], atol=1 / n)
        )
        self.assertTrue(np.allclose(shape.at_points(points), shape.points))
        self.assertTrue(np.allclose(np.ptp(shape.points, axis=0), np.ptp(points, axis=0), atol=1e-3))


class Words(ReportTest):
    def test_numbers(self):
        self.assertEqual(numbers_in_words.quantity(2.5e6, "Pa"), "2.5 MPa")
        self.assertEqual(numbers_in_words.quantity(30 * 86400.0, "s"), "30 d")
        self.assertEqual(numbers_in_words.quantity(0.0, "m"), "0 m")
        self.assertEqual(numbers_in_words.number(-1.5e-12), "−1.5 × 10⁻¹²")
        self.assertEqual(numbers_in_words.in_unit("{0, ramp(t)}", "m"), "{0, ramp(t)} m")

    def test_single_fractures_take_the_place_of_sets(self):
        """Fractures are sorted by slip. The times of first slip are those of the events."""
        step = {
            "time": 4.0,
            "fractures": {"set": {"area": 3.0, "max_slip": 2e-3}},
            "single_fractures": {"max_slip": [1e-3, 2e-3], "mean_slip": [1e-3, 2e-3], "moment": [0.0, 5e9]},
        }
        content = {
            "mesh": {"dimension": 2},
            "single_fractures": [{"name": "a", "set": "set", "area": 1.0}, {"name": "b", "set": "set", "area": 2.0}],
            "steps": [step],
        }
        found = [events.Event("b", 3.0, 4.0, 2e-3, 5e9, 0.39931, 5e9)]
        (table, listed), _ = figures.of_run(content, None, found)
        titles = [
            "fracture",
            "length (m)",
            "first slip after (s)",
            "mean slip (mm)",
            "largest slip (mm)",
            "moment per depth (N)",
        ]
        self.assertEqual(table.columns, titles)
        self.assertEqual(table.rows, [("b", "2", "3", "2", "2", "5 × 10⁹"), ("a", "1", "–", "1", "1", "0")])
        self.assertEqual(listed.rows, [("b", "0.3993", "3", "4", "2", "5 × 10⁹")])
        del content["single_fractures"]
        (table,), _ = figures.of_run(content, None, [])
        self.assertEqual([row[0] for row in table.rows], ["set"])

    def test_growth(self):
        """Lengths at start and end, extensions by step and fracture, and slip of fractures that only open."""
        growth = {"fracture": [0, 0, 1], "x": [1.1, -1.1, 5.2], "y": [0.2, -0.2, 0.0], "length": [0.1, 0.1, 0.2],
                  "released": [9.0, 9.0, 30.0], "fracture_energy": [8.0, 8.0, 16.0], "lost_energy": [0.0, 0.0, 14.0]}
        singles = {"max_slip": [3e-4, 0.0], "mean_slip": [2e-4, 0.0], "max_opening": [1e-3, 0.0], "fraction_has_slipped": [0, 0],
                   "fraction_open": [1.0, 0.0], "fracture_energy": [16.0, 16.0], "lost_energy": [0.0, 14.0], "area": [2.2, 1.2]}
        content = {
            "mesh": {"dimension": 2, "cells": 200, "fracture_faces": 40},
            "initial": {"mesh": {"cells": 100}},
            "status": "completed",
            "tables": {"growth": {key: "m" for key in growth}},
            "single_fractures": [{"name": "a", "set": "s", "area": 2.0}, {"name": "b", "set": "s", "area": 1.0}],
            "steps": [{"time": 4.0, "converged": True, "growth": growth, "single_fractures": singles, "fractures": {"s": {}},
                       "tips": [{"fracture": "a", "state": "grows"}, {"fracture": "b", "state": "ends at", "met": "a"}]}],
        }
        (fractures, table), _ = figures.of_run(content, None, [])
        rows = {row[0]: dict(zip(fractures.columns, row)) for row in fractures.rows}
        self.assertEqual([(rows[name]["length (m)"], rows[name]["length at the start (m)"]) for name in ("a", "b")], [("2.2", "2"), ("1.2", "1")])
        self.assertEqual((rows["a"]["largest slip (µm)"], rows["b"]["energy lost in growth, per depth (J/m)"]), ("300", "14"))
        self.assertEqual(table.title, "Growth")
        self.assertEqual(table.rows, [("4", "a", "200", "2.2", "16", "18", "(1.1, 0.2) (−1.1, −0.2)", ""), ("4", "b", "200", "1.2", "16", "30", "(5.2, 0)", "ends at a")])
        said = figures.headline(content)
        self.assertIn("The largest slip is 300 µm, on a.", said)
        self.assertIn("grows most, by 200 mm.", said)
        self.assertIn("of 200 cells (100 at the start)", report_page.summary(content, mock.Mock(entries={}), said))
        singles |= {"max_slip": [0.0, 0.0]}
        self.assertIn("No fracture slips. The largest opening is 1 mm, on a.", figures.headline(content))

    def test_time_of_pictures(self):
        """The last step, or the one with the largest slipping area if no face slips at the end."""
        def content(*shares):
            steps = [{"time": float(k), "single_fractures": {"fraction_slip": share}} for k, share in enumerate(shares)]
            return {"single_fractures": [{"area": 1.0}, {"area": 3.0}], "steps": steps}

        def time(*shares, written=(0.0, 1.0, 2.0)):
            return figures.time_of_pictures(content(*shares), written)

        self.assertEqual(time([0, 0], [0, 0]), 1)
        self.assertEqual(time([0, 1], [0.1, 0]), 1)
        self.assertEqual(time([1, 0], [0, 0.5], [0, None]), 1)
        self.assertEqual(time([1, 0], [0, 0.5], [0, 0], written=(0.0, 2.0)), 0)
        self.assertEqual(figures.time_of_pictures({"steps": [{"time": 2.0}]}, []), 2)
        growing = content([0, 1], [0.1, 0], [0, 0])
        growing["steps"][0]["growth"] = {"fracture": [0]}
        self.assertEqual(figures.time_of_pictures(growing, (0.0, 1.0, 2.0)), 2)

    def test_rounding_is_zero_in_tables(self):
        self.assertEqual(figures.column("slip", [2e-3, 3e-19, None], "m"), ("slip (mm)", ["2", "0", "–"]))


if __name__ == "__main__":
    main()
