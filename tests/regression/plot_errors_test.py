#!/usr/bin/env python3
"""Errors of plot: plot_errors_test.py PROGRAM ROOT MPIEXEC"""
import csv
import json
import subprocess
import sys

from plotting import PlotTest  # before other modules: it skips the test without them
from program import ROOT, main
import laboratory
import numpy as np
import read


class Errors(PlotTest):
    def expect_error(self, path, words, *options):
        out, err = self.draw(path, *options, expect=1)
        self.assertEqual(out, "")
        self.assertEqual(len(err.splitlines()), 1, err)
        for word in (str(path), *words):
            self.assertIn(word, err)

    def test_wrong_paths(self):
        self.expect_error(self.folder / "absent", ["no such file"])
        self.expect_error(self.folder, ["contains no results.json"])
        self.expect_error(self.folder, ["contains no results.json"], "--paraview")

    def test_wrong_content(self):
        self.expect_error(self.write("notes.csv", "a,b\n1,2\n"), ["is not a CSV file", "t,state"])
        self.expect_error(self.write("cut.csv", "t,state,jump_n\n1,2\n3,4,x\n"), ["not complete"])
        self.expect_error(self.write("picture.csv", "\x89PNG"), ["is not a CSV file"])
        self.expect_error(self.write("run/results.json", "{").parent, ["is not valid JSON"])
        self.expect_error(self.write("run/results.json", '{"steps": []}').parent, ["no step"])

    def test_lost_pieces(self):
        self.run_scene("seed/push_2d.xml")
        (self.folder / "out" / "bulk_0000.pvtu").unlink()
        self.expect_error(self.folder / "out", ["bulk_0000.pvtu", "no such file"])
        self.run_scene("seed/push_2d.xml")
        (self.folder / "out" / "fractures" / "fractures_0000_0_0.vtu").unlink()
        self.expect_error(self.folder / "out", ["fractures_0000_0_0.vtu", "no such file"])
        (self.folder / "out" / "fractures.pvd").unlink()
        self.expect_error(self.folder / "out", ["fractures.pvd: has no step at t = "])

    def test_damaged_pieces(self):
        """An empty or truncated file gives one error with its name, without messages of VTK and without pictures."""
        self.run_scene("seed/push_2d.xml")
        command = [sys.executable, "-B", ROOT / "apps/plot", self.folder / "out", "--output", self.folder / "pictures"]
        for name in ("fractures/fractures_0000_0_0.vtu", "bulk/bulk_0000_0.vtu"):
            piece = self.folder / "out" / name
            whole = piece.read_bytes()
            for length in (0, 100, len(whole) // 2, len(whole) - 200):
                piece.write_bytes(whole[:length])
                done = subprocess.run(command, capture_output=True, text=True)
                self.assertEqual(done.returncode, 1, length)
                said = f"sprekk plot: {piece}: is damaged or not complete; run the scene again\n"
                self.assertEqual((done.stdout, done.stderr), ("", said))
                self.assertFalse((self.folder / "pictures").exists())
            piece.write_bytes(whole)
        self.draw(self.folder / "out", "--dpi", 20)

    def test_results_of_another_kind(self):
        for content in ("[]", "null", '{"steps": 3}', '{"steps": [1]}', '{"mesh": 2, "steps": []}'):
            self.expect_error(self.write("run/results.json", content).parent, ["results.json: ", "expected "])
        self.expect_error(self.write("run/results.json", '{"steps": [{}]}').parent, ['step 1 has no "time"'])
        self.run_scene("seed/push_2d.xml")
        known = self.results()
        for name, value in (("fractures", []), ("fractures", {"fracture": 1}), ("time", "0"), ("cuts", None)):
            step = {**known["steps"][-1], name: value}
            self.write("run/results.json", json.dumps({**known, "steps": [step]}))
            self.expect_error(self.folder / "run", [f'"{name}" of step 1 is ', "expected "])
        (self.folder / "run/results.json").write_bytes(b'{"reason": "\xff"}')
        self.expect_error(self.folder / "run", ["results.json: is not valid JSON"])

    def test_columns_by_their_titles(self):
        """Columns may have any order. Repeated or additional columns are errors."""
        path = self.csv("point/cyclic_shear.xml", "Time.steps=4")
        rows = [line.split(",") for line in path.read_text().splitlines()]
        turned = self.write("turned.csv", "".join(",".join(row[::-1]) + "\n" for row in rows))
        for name, values in read.point_csv(path)[0].items():
            self.assertEqual(read.point_csv(turned)[0][name].tolist(), values.tolist())
        specimens = self.csv("point/shear_tests.xml", "Time.steps=4")
        with specimens.open(newline="") as file:
            rows = list(csv.reader(file))
        turned = self.folder / "turned.csv"
        with turned.open("w", newline="") as file:
            csv.writer(file).writerows(row[::-1] for row in rows)
        known, found = laboratory.specimens(specimens), laboratory.specimens(turned)
        self.assertEqual(list(found), list(known))
        for name, curve in known.items():
            self.assertTrue(all(np.array_equal(found[name][title], values) for title, values in curve.items()))
        for titles, why in (("t,state,jump_n,t", 'line 1: two columns have the title "t"'),
                            ("t,state,jump_n", "line 2: is not complete: has 4 columns")):
            self.expect_error(self.write("a.csv", titles + "\n1,1,1,1\n"), [why])


if __name__ == "__main__":
    main()
