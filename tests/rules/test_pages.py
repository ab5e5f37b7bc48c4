#!/usr/bin/env python3
"""Tests of perf/save.py, which saves tables of measurements, and of perf/pages.py, which fills the tables of pages and
finds changed numbers in text, tables and CSV files."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PERF = Path(__file__).resolve().parents[2] / "perf"
MEASUREMENT = """
from pathlib import Path
BOUNDS = {"largest": 5}
def main(words):
    folder = Path(words[words.index("--output") + 1])
    folder.mkdir(parents=True)
    (folder / "demo.csv").write_text("size,value\\r\\n3,0.25\\r\\n")
    print("size value")
    print("largest=4 failures=0")
    return 1 if "--fail" in words else 0
"""
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
SELECT [cells, state] AS state, unknowns, number(mean, '.1f') AS mean, share FROM krylov
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
        command = [sys.executable, "-B", PERF, "pages", "--root", self.root, *options]
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
        self.assertIn("| hexahedra, slip | 10788 | 15.4 | 0.125 |\n", text)
        self.assertIn("| max_krylov | 23 | 25 |\n| growth | 0.031 | |\n", text)
        source = "[krylov.csv](krylov.csv): `./sprekk perf krylov --largest 3e4`, commit 0123abc, 2026-11-28. "
        self.assertIn(source, text)
        self.assertEqual(self.pages("--check"), (0, ""))

    def test_range_of_a_column(self):
        self.table.write_text(TABLE + '"hexahedra, stick",10788,13.2,\n')
        query = "SELECT range(unknowns, 'd') AS n, range(mean, '.1f') AS mean, range(share + NULL, 'g') AS none FROM krylov"
        self.page.write_text(PAGE.format(target=25) + f"\n<!-- query\n{query}\n-->\n<!-- end -->\n")
        self.assertEqual(self.pages(), (0, ""))
        self.assertIn("| n | mean | none |\n| --- | --- | --- |\n| 10788 | 13.2 to 15.4 | |\n", self.page.read_text())

    def test_changed_digit_in_the_text(self):
        before = self.page.read_text()
        changes = {"25": "26", "15.4": "15.5", "10,788": "10,789", "3.1e-2": "3.2e-2", "12.5 %": "12.6 %"}
        for old, new in changes.items():
            with self.subTest(new):
                self.replace(self.page, old, new)
                self.fails_with("speed.md:", f"{new} is neither in the tables of this page nor in a header")
                self.page.write_text(before)

    def test_changed_digit_in_a_table(self):
        self.replace(self.page, "| 15.4 |", "| 15.3 |")
        self.fails_with("the tables are out of date")

    def test_changed_measurement(self):
        self.replace(self.table, "15.44444", "16.44444")
        self.fails_with("the tables are out of date")

    def test_changed_digit_in_the_readme(self):
        self.replace(self.root / "README.md", "| 23 |", "| 24 |")
        self.fails_with("README.md:5: no row of the CSV files has 24 (krylov.csv)")

    def test_wrong_query(self):
        self.replace(self.page, "FROM krylov\n", "FROM krilov\n")
        self.fails_with("speed.md", "no such table: krilov")

    def test_wrong_column(self):
        self.replace(self.page, "[cells, state]", "[cells, sate]")
        self.fails_with("no such column: cells, sate")
        self.replace(self.page, "[cells, sate]", '"cells, sate"')
        self.fails_with("not in double quotes")

    def test_csv_without_header(self):
        self.replace(self.table, "# command", "# comand")
        self.fails_with("krylov.csv: the header has no line", "command")


class Save(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in ("perf/demo", "docs/results"):
            (self.root / name).mkdir(parents=True)
        for name in ("__init__.py", "__main__.py", "save.py", "common"):
            (shutil.copytree if name == "common" else shutil.copy)(PERF / name, self.root / "perf" / name)
        self.measurement = self.root / "perf/demo/demo.py"
        self.measurement.write_text(MEASUREMENT)

    def save(self, *words):
        command = [sys.executable, "-B", "perf", "demo", *words]
        return subprocess.run(command, capture_output=True, text=True, cwd=self.root)

    def test_table_with_header(self):
        self.assertEqual(self.save("--size", "3 m", "--save").returncode, 0)
        lines = (self.root / "docs/results/demo.csv").read_text().splitlines()
        self.assertEqual(lines[-2:], ["size,value", "3,0.25"])
        self.assertIn("# command: ./sprekk perf demo --size '3 m'", lines)
        self.assertIn("# result: largest=4 failures=0", lines)
        self.assertIn("# target: largest=5", lines)
        for name in ("commit", "machine", "date", "load"):
            self.assertTrue(any(line.startswith(f"# {name}: ") for line in lines), name)

    def test_name_of_the_file_and_exit_status(self):
        self.assertEqual(self.save("--fail", "--save=other").returncode, 1)
        self.assertTrue((self.root / "docs/results/other.csv").is_file())

    def test_refuses_bad_names_and_old_tables(self):
        done = self.save("--save=../other")
        self.assertEqual(done.returncode, 2)
        self.assertIn('argument --save: "../other"', done.stderr)
        self.assertEqual(self.save("--save").returncode, 0)
        self.measurement.write_text("def main(words):\n    return 3\n")
        old = self.root / "output/perf/demo/demo.csv"
        os.utime(old, (0, 0))
        done = self.save("--save=third")
        self.assertIn("status 3, and no table to save", done.stderr)
        self.assertFalse((self.root / "docs/results/third.csv").exists())


if __name__ == "__main__":
    unittest.main()
