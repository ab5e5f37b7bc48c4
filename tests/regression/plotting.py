"""Tests of pictures: loads the program `plot` and its modules.

Requires matplotlib, numpy, VTK's Python and Xvfb. If one is missing, the status is 77, for ctest's "skipped"."""

import contextlib
import importlib.util
import io
import shutil
import sys

from program import ROOT, ProgramTest

MISSING = [name for name in ("matplotlib", "numpy", "vtkmodules") if importlib.util.find_spec(name) is None]
MISSING += [] if shutil.which("Xvfb") else ["Xvfb"]
if MISSING:
    print(f"skipped: without {', '.join(MISSING)}")
    sys.exit(77)

spec = importlib.util.spec_from_file_location("sprekk_plot", ROOT / "apps" / "plot" / "__main__.py")
plot = importlib.util.module_from_spec(spec)
spec.loader.exec_module(plot)

import numpy as np  # noqa: E402
import style  # noqa: E402


class PlotTest(ProgramTest):
    def tearDown(self):
        style.plt.close("all")

    def draw(self, *words, expect=0):
        """Returns standard output and error of the command."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.assertEqual(plot.main(list(map(str, words))), expect, err.getvalue())
        return out.getvalue(), err.getvalue()

    def csv(self, scene, *overrides):
        path = self.folder / "point.csv"
        path.write_text(self.call("point", self.scene(scene), *(w for o in overrides for w in ("--set", o)))[0])
        return path

    def figures(self, directory, *words):
        """Returns {name: figure} of a run."""
        with contextlib.redirect_stderr(io.StringIO()):
            return dict(plot.of_run(self.folder / directory, plot.arguments(["-", *words])))

    def expect_pictures(self, names):
        for name in names:
            picture = self.folder / name
            self.assertTrue(picture.is_file(), name)
            image = style.plt.imread(picture)[:, :, :3]
            pixels = image.reshape(-1, 3)
            self.assertGreater(len(np.unique(np.round(pixels * 255).astype(int) @ (1, 256, 256**2))), 50, name)
            ink = np.mean(np.any(pixels < 0.99, axis=1))
            self.assertTrue(0.005 < ink < 0.95, f"{name}: {ink}")
            for edge in (image[:8], image[-8:], image[:, :8], image[:, -8:]):  # nothing is cut off
                self.assertGreater(np.min(edge), 0.99, name)

    def expect_labels(self, figure, *wanted):
        axes = figure.axes
        labels = [label for ax in axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label]
        for words in wanted:
            self.assertTrue(any(words in label for label in labels), f"{words} is not in {labels}")

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return path
