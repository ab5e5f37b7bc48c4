#!/usr/bin/env python3
"""Reports in a browser: browser_test.py PROGRAM ROOT MPIEXEC

Requires Chromium, npm, which downloads the library of the view once, and the modules for pictures. If one is missing,
the status is 77, for ctest's "skipped"."""

import io
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "regression"))
import browser  # noqa: E402
from program import ROOT, ProgramTest  # noqa: E402

BUNDLED = ROOT / "build/report"


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


class BrowserTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.browser = browser.Browser()
        self.addCleanup(self.browser.close)

    def report(self, scene, *overrides):
        self.run_scene(scene, *overrides)
        done = subprocess.run(
            ["timeout", "900", str(ROOT / "sprekk"), "report", str(self.folder / "out"), "--dpi", "40"],
            capture_output=True,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        log = (BUNDLED / "npm.log").read_text() if (BUNDLED / "npm.log").is_file() else ""
        if "no 3D view" in done.stderr and "npm err" in log.lower():
            self.skipTest(f"npm installed no library: {log.strip().splitlines()[-1]}")
        self.assertEqual(done.stderr.replace("sprekk: bundling the 3D view of reports\n", ""), "")
        return Path(done.stdout.strip())

    def image(self, png):
        from matplotlib.pyplot import imread

        return (imread(io.BytesIO(png), format="png")[:, :, :3] * 255).astype(int)

    def colours(self, png):
        """Returns the number of colours with at least ten pixels."""
        import numpy as np

        return int(np.sum(np.unique(self.image(png).reshape(-1, 3) @ (1, 256, 256**2), return_counts=True)[1] >= 10))

    def expect_quiet(self):
        self.browser.value("new Promise((done) => setTimeout(done, 500))")
        self.assertEqual(self.browser.complaints, [])
        self.assertEqual(
            [url[:80] for url in self.browser.requests if not url.startswith(("file:", "data:", "blob:"))], []
        )

    def expect_view(self, file):
        """Checks that the 3D view shows the run, turns with the mouse, and changes its colours with the field."""
        self.browser.open(file)
        self.expect_quiet()
        first = self.browser.picture("#view canvas")
        self.assertGreater(self.colours(first), 20)
        self.browser.drag("#view", 150, 60)
        turned = self.browser.picture("#view canvas")
        changed = (self.image(first) != self.image(turned)).any(axis=2).mean()
        self.assertGreater(changed, 0.02)
        self.browser.value(
            "(s => { s.selectedIndex = 1; s.dispatchEvent(new Event('change')); })(document.querySelector('#view-controls select'))"
        )
        self.assertGreater(
            (self.image(turned) != self.image(self.browser.picture("#view canvas"))).any(axis=2).mean(), 0.02
        )
        self.expect_quiet()

    def expect_steps(self, n):
        """Checks that the slider shows other steps, with their times."""
        last, reported = self.browser.picture("#view canvas"), "document.getElementById('view-time').textContent"
        self.assertEqual(self.browser.value("document.getElementById('view-step').max"), str(n - 1))
        before = self.browser.value(reported)
        self.browser.value(
            "(s => { s.value = 0; s.dispatchEvent(new Event('input')); })(document.getElementById('view-step'))"
        )
        self.assertNotEqual(self.browser.value(reported), before)
        self.assertGreater(
            (self.image(last) != self.image(self.browser.picture("#view canvas"))).any(axis=2).mean(), 0.02
        )
        self.expect_quiet()

    def expect_numbers(self, content):
        """Checks that a click on a fracture lists its numbers, and a selection those of another one."""
        names = [one["name"] for one in content["single_fractures"]]
        self.browser.value("[...document.querySelectorAll('#view-controls button')].at(-1).click()")  # reset the view
        self.browser.click("#view")
        name = self.browser.value("document.getElementById('view-fracture').value")
        self.assertIn(name, names)
        facts = "document.getElementById('view-facts').innerText"
        self.assertIn(name, self.browser.value(facts))
        self.assertIn("slip tendency", self.browser.value(facts))
        other = next(one for one in names if one != name)
        self.browser.value(
            f"(s => {{ s.value = {other!r}; s.dispatchEvent(new Event('change')); }})(document.getElementById('view-fracture'))"
        )
        self.assertIn(other, self.browser.value(facts))
        self.expect_quiet()

    def expect_fits(self, file):
        """Checks that a phone needs no horizontal scrolling, and that a printout has several pages."""
        self.browser.open(file, 390, 844, mobile=True)
        self.expect_quiet()
        self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), 390)
        self.assertGreater(self.colours(self.browser.picture("#view canvas")), 20)
        paper = self.browser.paper()
        self.assertTrue(paper.startswith(b"%PDF"))
        self.assertGreater(paper.count(b"/Type /Page\n") + paper.count(b"/Type /Page "), 1)
        self.assertTrue(self.browser.value("document.querySelector('details').open"))

    def test_body(self):
        file = self.report("verification/crossing_3d.xml")
        self.expect_view(file)
        self.expect_steps(len(self.results()["steps"]))
        self.expect_numbers(self.results())
        self.expect_fits(file)

    def test_plane(self):
        file = self.report("poro/injection_2d.xml", "Time.steps=2", "Time.end=7200")
        self.expect_view(file)
        self.expect_steps(2)
        self.assertIn("injector", self.browser.value("document.querySelector('#view .well').textContent"))
        self.expect_fits(file)


if __name__ == "__main__":
    for needed in ("npm", "node"):
        if not shutil.which(needed):
            skip(f"{needed} is missing; it comes with apt-get install nodejs npm")
    if not browser.program():
        skip("Chromium is missing; it comes with apt-get install chromium-headless-shell")
    result = unittest.main(argv=sys.argv[:1], exit=False).result
    for _, reason in result.skipped:
        skip(reason)
    sys.exit(not result.wasSuccessful())
