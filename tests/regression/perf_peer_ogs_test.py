#!/usr/bin/env python3
"""Comparison perf/peer/ogs: perf_peer_ogs_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy, SciPy or VTK.

Runs of OpenGeoSys require the environment variable OGS."""
import math
import os
import subprocess
import sys
from types import SimpleNamespace

from program import PROGRAM, ROOT, ProgramTest, main

try:
    import scipy  # noqa: F401
    from perf.peer import runs
    from perf.peer.ogs import cases, exact, ogs
    import read
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


class References(ProgramTest):
    def test_crack_in_a_wide_plate(self):
        """Area 2 pi a^2 load / E' in an infinite plate; the plate is 50 times wider."""
        E, nu, a = 170e6, 0.22, 0.01
        area = exact.crack_area(E, nu, 7e3, a, 50 * a, 50 * a)
        self.assertAlmostEqual(area * E / (1 - nu**2) / (2 * math.pi * a**2 * 7e3), 1, delta=5e-4)

    def test_crack_converges_with_the_number_of_terms(self):
        coarse, fine = (exact.crack_area(170e6, 0.22, 7e3, 0.01, 0.025, 0.05, 1e12, terms) for terms in (32, 40))
        self.assertAlmostEqual(coarse / fine, 1, delta=2e-5)

    def test_opening_of_thin_and_of_thick_layers(self):
        """Long waves: 1/Kn. Short waves: rock of two half-spaces, whose stiffness is E k/(4 (1 - nu^2))."""
        mu, nu, Kn = 30e9, 0.125, 1e11
        self.assertAlmostEqual(exact.opening(1e-3, mu, nu, 0.5, Kn, 1e11) * Kn, 1, delta=1e-6)
        k = 23.9  # solved with layers
        rock = 2 * mu * (1 + nu) * k / (4 * (1 - nu**2))
        self.assertAlmostEqual(exact.opening(k, mu, nu, 0.5, Kn, 1e11) * (Kn + rock), 1, delta=1e-3)


class Runs(ProgramTest):
    def options(self, **more):
        return SimpleNamespace(output=self.folder, binary=PROGRAM, set=[], **more)

    def errors(self, case, meshes):
        """Errors of Sprekk relative to the independent reference."""
        known = ogs.reference(case, {})["volume"][0]
        return [abs(ogs.ours(self.options(), f"k{k}", *ogs.made(case, words)).values["volume"] / known - 1)
                for k, words in enumerate(meshes)]

    def test_area_of_the_crack(self):
        coarse, fine = self.errors("cross", [(2,), (4,)])
        self.assertLess(fine, 0.02)
        self.assertGreater(coarse / fine, 1.8)  # order 1

    def test_injected_volume(self):
        for case, rows in (("strip", (24, 2.5e-4)), ("strip, impermeable rock", (10,))):
            coarse, fine = self.errors(case, [(25, *rows), (50, *rows)])
            self.assertLess(coarse, 0.0065)
            self.assertLess(fine, 0.0025)
            self.assertGreater(coarse / fine, 2.5)  # the correction by the compliance decreases with the cells

    def test_unknowns_and_files_of_the_published_meshes(self):
        """Counts that OpenGeoSys reports for the published strip, and the finest mesh of the crossing cracks."""
        self.assertEqual(cases.strip(25, 46).unknowns, 8510)
        self.assertEqual(cases.cross(8).unknowns, 26208)
        file = cases.strip(25, 46).mesh.vtu(self.folder / "mesh.vtu", 2)
        grid = read.output(read.vtkXMLUnstructuredGridReader(), file)
        ids = read.vtk_to_numpy(grid.GetCellData().GetArray("MaterialIDs"))
        self.assertEqual((grid.GetNumberOfPoints(), list(ids).count(0), list(ids).count(1)), (3593, 1150, 25))

    def test_equal_error(self):
        """The level is the smallest error that both reach; a run counts if no finer mesh has a larger error."""
        def series(*of):
            return [runs.Run("", 0, 0, 0, seconds, 0, {"volume": 1 + error}) for seconds, error in of]
        found = {"OpenGeoSys": series((1, 0.01), (2, 0.1), (4, 0.02), (8, 0.001)),
                 "Sprekk": series((1, 0.2), (3, -0.03))}
        level, best = ogs.at_equal_error(found, {"volume": (1, 1e-4)}, "volume")
        self.assertAlmostEqual(level, 0.03)
        self.assertEqual([run.seconds for run in best], [4, 3])
        level, best = ogs.at_equal_error(found, {"volume": (1, 0.05)}, "volume")
        self.assertEqual((level, [run.seconds for run in best]), (0.05, [4, 3]))

    def test_run_of_opengeosys(self):
        if not os.environ.get("OGS"):
            self.skipTest("OGS is not set")
        made, mesh, _ = ogs.made("cross", (1,))
        run = ogs.theirs(self.options(ogs=os.environ["OGS"]), "cross", made, mesh)
        self.assertAlmostEqual(run.values["volume"], 2.0216e-8, delta=2e-12)


class Command(ProgramTest):
    def peer(self, **environment):
        words = [sys.executable, "-B", str(ROOT / "perf"), "peer", "--only", "ogs", "--output", str(self.folder)]
        inherited = {name: value for name, value in os.environ.items() if name not in ("OGS", "POREPY")}
        return subprocess.run(words, capture_output=True, text=True, env={**inherited, **environment})

    def test_without_opengeosys(self):
        done = self.peer()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("pip install ogs==6.5.9", done.stdout)

    def test_wrong_program(self):
        done = self.peer(OGS="/no/ogs")
        self.assertEqual((done.returncode, done.stderr), (1, "sprekk perf peer: OGS = /no/ogs is no program\n"))


if __name__ == "__main__":
    main()
