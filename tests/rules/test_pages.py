#!/usr/bin/env python3
"""Tests of perf/pages.py: it fills tables, and it finds changed numbers in text, tables and CSV files."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PAGES = Path(__file__).resolve().parents[2] / "perf/pages.py"
TABLE = """# command: ./sprekk perf krylov --largest 3e4
# commit: 0123abc
# date: 2026-11-28
# result: max_krylov=23 growth=0.031
# target: max_krylov=25
"cells, state",unknowns,mean,share
"hexahedra, slip",10788,15.44444,0.125
"""
PAGE = """# Speed in 2D

The target is {target}, as in Ye (2018), with a residual of `1e-9`. Measured are 23 iterations for 10,788 unknowns, 15.4
in the mean, a growth of 3.1e-2 and a share of 12.5 %.

<!-- query
SELECT "cells, state" AS state, printf('%.1f', mean) AS mean FROM krylov
-->
<!-- end -->

<!-- query
SELECT quantity, value, target FROM krylov_results
-->
<!-- end -->
"""
README = """# Sprekk: 77 rocks

## Accuracy and speed

| iterations | {count} | `./sprekk perf krylov` |

## Documentation
"""


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.page, self.table = (self.root / "docs/results" / name for name in ("speed.md", "krylov.csv"))
        self.page.parent.mkdir(parents=True)
        self.table.write_text(TABLE)
        self.page.write_text(PAGE.format(target=25))
        (self.root / "README.md").write_text(README.format(count=23))
        self.assertEqual(self.pages(), (0, ""))

    def pages(self, *options):
        command = [sys.executable, "-B", PAGES, "--root", self.root, *options]
        done = subprocess.run(command, capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def replace(self, file, old, new):
        text = file.read_text()
        self.assertIn(old, text)
        file.write_text(text.replace(old, new, 1))

    def fails_with(self, *words):
        status, output = self.pages("--check")
        self.assertEqual(status, 1, output)
        for word in words:
            self.assertIn(word, output)

    def test_tables_are_filled(self):
        text = self.page.read_text()
        self.assertIn("| hexahedra, slip | 15.4 |\n", text)
        self.assertIn("| max_krylov | 23 | 25 |\n| growth | 0.031 | |\n", text)
        source = "[krylov.csv](krylov.csv): `./sprekk perf krylov --largest 3e4`, commit 0123abc, 2026-11-28. "
        self.assertIn(source, text)
        self.assertEqual(self.pages("--check"), (0, ""))

    def test_changed_digit_in_the_text(self):
        before = self.page.read_text()
        changes = {"25": "26", "15.4": "15.5", "10,788": "10,789", "3.1e-2": "3.2e-2", "12.5 %": "12.6 %"}
        for old, new in changes.items():
            with self.subTest(new):
                self.replace(self.page, old, new)
                self.fails_with("docs/results/speed.md:", f"{new} is not in the CSV files of this page (krylov.csv)")
                self.page.write_text(before)

    def test_changed_digit_in_a_table(self):
        self.replace(self.page, "| 15.4 |", "| 15.3 |")
        self.fails_with("the tables are out of date")

    def test_changed_measurement(self):
        self.replace(self.table, "15.44444", "16.44444")
        self.fails_with("the tables are out of date")

    def test_changed_digit_in_the_readme(self):
        self.replace(self.root / "README.md", "| 23 |", "| 24 |")
        self.fails_with("README.md:5: 24 is not in the CSV files")

    def test_wrong_query(self):
        self.replace(self.page, "FROM krylov\n", "FROM krilov\n")
        self.fails_with("speed.md", "no such table: krilov")

    def test_csv_without_header(self):
        self.replace(self.table, "# command", "# comand")
        self.fails_with("krylov.csv: the header has no line", "command")


if __name__ == "__main__":
    unittest.main()
