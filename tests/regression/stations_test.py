#!/usr/bin/env python3
"""Stations of the SEAS benchmarks and pictures of a catalogue by slip rate: stations_test.py PROGRAM ROOT MPIEXEC"""
from plotting import PlotTest  # before other modules: it skips the test without them
from program import ROOT, main
import contextlib
import importlib.util
import io
import math
import sys

import events
import magnitudes

sys.path.insert(1, str(ROOT / "apps/export"))
spec = importlib.util.spec_from_file_location("sprekk_export", ROOT / "apps/export/__main__.py")
app = importlib.util.module_from_spec(spec)
spec.loader.exec_module(app)

SCENE, G = "verification/events_2d.xml", 30e9
TIMES = (0, 10, 10.5, 11, 20, 21, 22, 30)
SLIPS = (0, 0, 0.005, 0.01, 0.011, 0.026, 0.041, 0.041)


class Stations(PlotTest):
    def export(self, *words, expect=0):
        err = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(err):
            self.assertEqual(app.main([str(self.folder / "out"), *words]), expect, err.getvalue())
        return err.getvalue()

    def test_known_history(self):
        """Slip is left-lateral, opposite to the axis t. The rate is that of the last step."""
        self.run_scene(SCENE, "Output.time unit=min", "Probes.here.point={0.25, 0.5}", "Probes.line.points=2",
                       "Probes.here.outputs={plastic jump local, traction local}", "Probes.line.line={0, 0.5, 1, 0.5}",
                       "Probes.line.outputs={slip}")
        file = self.folder / "here.dat"
        self.export("-o", str(file), "--station", "here", "--header", "problem=block", "--header", "author=nobody")
        lines = file.read_text().splitlines()
        head = [line for line in lines if line.startswith("# ")]
        self.assertTrue({"# problem=block", "# author=nobody", "# num_time_steps=7", "# minimum_time_step=0.5",
                         "# Column #3 = Slip rate (log10 m/s)"} <= set(head), head)
        self.assertEqual(lines[len(head)], "t slip slip_rate shear_stress")
        rows = [[float(value) for value in line.split()] for line in lines[len(head) + 1:]]
        for k, row in enumerate(rows, 1):
            rate = (SLIPS[k] - SLIPS[k - 1]) / (TIMES[k] - TIMES[k - 1])
            wanted = (TIMES[k], -SLIPS[k], math.log10(rate) if rate > 0 else -30, G * SLIPS[k] / 1e6)
            for value, exact in zip(row, wanted, strict=True):
                self.assertAlmostEqual(value, exact, delta=1e-8 * max(1, abs(exact)))
        self.assertEqual(len(rows), 7)
        for words, message in ((("x.dat",), "requires both"), (("x.txt", "--station", "here"), "requires both"),
                               (("x.dat", "--station", "there"), "has no probe of this name"),
                               (("x.dat", "--station", "line"), "is a line; a station is a point"),
                               (("x.dat", "--station", "here", "--header", "a"), "is not KEY=VALUE")):
            self.assertIn(message, self.export("-o", str(self.folder / words[0]), *words[1:], expect=1))

    def test_catalogue(self):
        """The events of a catalogue have numbers and stress drops. Twenty of them have a picture of their magnitudes."""
        content = self.run_scene(SCENE)
        found = events.of_run(self.folder / "out", content)
        self.assertEqual([event.number for event in found], [1, 2])
        for event, slip in zip(found, (0.01, 0.03)):
            self.assertAlmostEqual(event.drop, G * slip, delta=1e-8 * G * slip)
        self.assertIsNone(magnitudes.of_events(found, "run"))
        (ax,) = magnitudes.of_events(found * 10, "run").axes
        self.assertEqual(ax.lines[0].get_ydata().tolist(), list(range(20, 0, -1)))
        self.assertIsNone(magnitudes.of_events([event._replace(number=None) for event in found * 10], "run"))


if __name__ == "__main__":
    main()
