"""Notebooks and the page on Python: notebooks_test.py ROOT PROGRAM

Runs each notebook, with its assertions, and the Python blocks of docs/use/python.md in their order."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
NOTEBOOKS = ROOT / "docs/notebooks"


class Documentation(unittest.TestCase):
    def test_notebooks(self):
        for path in sorted(NOTEBOOKS.glob("*.ipynb")):
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder,
                                       str(path)], capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd=NOTEBOOKS)
                self.assertEqual(done.returncode, 0, done.stderr[-3000:])

    def test_page(self):
        page = (ROOT / "docs/use/python.md").read_text()
        blocks = re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
        self.assertGreater(len(blocks), 3)
        done = subprocess.run([sys.executable, "-B", "-c", "".join(blocks)], capture_output=True, text=True, cwd=ROOT,
                              stdin=subprocess.DEVNULL, env={**os.environ, "MPLBACKEND": "Agg"})
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])

    def test_every_notebook_is_on_the_page(self):
        linked = re.findall(r"\(\.\./notebooks/(\w+\.ipynb)\)", (ROOT / "docs/use/python.md").read_text())
        self.assertEqual(sorted(set(linked)), sorted(path.name for path in NOTEBOOKS.glob("*.ipynb")))


if __name__ == "__main__":
    try:
        import ipykernel, nbconvert  # noqa: E401, F401
    except ImportError:
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
