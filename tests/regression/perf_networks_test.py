#!/usr/bin/env python3
"""Measurement perf/networks: perf_networks_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy or VTK.

Forces, moments and energy are in balance for correct runs. Wrong results have the corresponding defects."""
import sys

from program import ProgramTest, main

try:
    import numpy as np
    from perf.networks import balance
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

CASES = (("verification/cyclic_2d.xml", "triangle"), ("verification/cyclic_3d.xml", "tetrahedron"))


class Balance(ProgramTest):
    def budget(self, scene, cell, *overrides):
        self.results_of_run = self.run_scene(scene, f"Mesh.cell={cell}", *overrides)
        return balance.budget(self.folder / "out", self.results_of_run)

    def test_energy_is_in_balance_but_for_what_is_stated(self):
        """Without closure the late heat of faces that begin to slide in a step is the only defect of the energy."""
        for scene, cell in CASES:
            for steps in (8, 16):
                b = self.budget(scene, cell, f"Time.steps={steps}")
                self.assertLess(b.balance, 1e-12)
                rest = b.work - b.strain - b.stored - b.heat + b.late
                self.assertLess(abs(rest).max(), 1e-12 * b.work[-1])
                self.assertGreater(b.heat[-1], 0.05)  # friction 0.6, load 0.3, cyclic slip of some tenths
                self.assertGreater(b.min_heat, -1e-14)
            self.assertGreater(b.late[-1], 1e-3 * b.heat[-1])

    def test_heat_of_a_known_path(self):
        """Cyclic shear of a unit area at constant load: heat is 0.18 times the slip in sliding steps, else 0."""
        b = self.budget(*CASES[0])
        slips = [step["fractures"]["fracture"]["mean_plastic_jump"]["local"][1] for step in self.results_of_run["steps"]]
        slides = np.array([0, 1, 0, 0, 1, 0, 1, 0])
        self.assertTrue(np.allclose(np.diff(b.heat), 0.18 * slides * abs(np.diff([0, *slips])), rtol=0, atol=1e-12))
        self.assertGreater(np.diff(b.heat)[slides == 1].min(), 1e-3)

    def test_what_is_wrong_is_seen(self):
        for scene, cell in CASES:
            self.budget(scene, cell)
            top = "north" if cell == "triangle" else "top"
            step = self.results_of_run["steps"][4]
            for key, of in (("reactions", 0), ("reaction_moments", -1)):
                value = step[key][top][of]
                step[key][top][of] = value * (1 + 1e-6)
                self.assertGreater(balance.budget(self.folder / "out", self.results_of_run).balance, 1e-8)
                step[key][top][of] = value


if __name__ == "__main__":
    main()
