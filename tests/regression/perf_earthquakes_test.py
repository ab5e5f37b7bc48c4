#!/usr/bin/env python3
"""Measurement perf/earthquakes: perf_earthquakes_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy or SciPy.

Tractions of slip on vertical faults: images in a box, long cells in 3D, and reciprocity. Start of a strike-slip fault."""
import sys

from program import ProgramTest, main

try:
    import numpy as np
    import read
    from perf.earthquakes import half_plane, half_space, strike_slip_scene
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

MODULUS, FAR = half_plane.SHEAR_MODULUS, 15e3
ENDS = np.linspace(0, 12e3, 13)
PLACES = (ENDS[1:] + ENDS[:-1]) / 2


class Kernels(ProgramTest):
    def assert_close(self, found, exact, tolerance):
        self.assertLess(np.max(np.abs(found - exact)), tolerance * np.max(np.abs(exact)))

    def test_box_has_the_tractions_of_its_images(self):
        n, shifts = 200, 2 * FAR * np.arange(-4, 5)
        aside, tail = 2 * FAR * np.arange(-n, n + 1), 2 / ((2 * FAR) ** 2 * (n + 0.5))  # tail: integral over the rest
        sums = []
        for sign in (1, -1):  # slip, and its mirror image above the surface
            distances = [PLACES[:, None] - sign * ENDS + shift for shift in shifts]
            sums.append(sum((d[..., None] / (d[..., None] ** 2 + aside**2)).sum(axis=-1) + d * tail for d in distances))
        exact = MODULUS / (2 * np.pi) * np.diff(sums[0] - sums[1])
        found = half_plane.antiplane(ENDS, PLACES, MODULUS, far=FAR)[0]
        self.assert_close(found, exact, 1e-6)
        whole = half_plane.antiplane(ENDS, PLACES, MODULUS)[0]
        self.assertGreater(np.max(np.abs(whole - exact)), 1e-3 * np.max(np.abs(exact)))  # images matter

    def test_cells_along_a_long_strike_are_antiplane(self):
        kernel = half_space.kernel(1000.0, 400, 12)
        along = kernel[0] + 2 * kernel[1:].sum(axis=0)
        self.assert_close(along, half_plane.antiplane(ENDS, PLACES, MODULUS)[0], 1e-5)

    def test_tractions_of_distant_cells_are_reciprocal(self):
        kernel = half_space.kernel(1000.0, 20, 12)[8:]
        self.assert_close(kernel, kernel.transpose(0, 2, 1), 1e-2)

    def test_strike_slip_scene_starts_at_the_slip_rates_of_the_problem(self):
        file = self.folder / "strike_slip.xml"
        strike_slip_scene.write_scene(file, 4000.0, 1e-3)
        self.run_scene(file, "Time.first step=1e-3", "Output.vtu=true")
        faces = read.surface(read.grid(read.written_steps(self.folder / "out", "fractures")[-1][1]))
        _, y, z = np.transpose([np.mean(corners, axis=0) for corners in faces.corners()])
        start = half_space.NUCLEUS / 2 - half_space.HALF, -(half_space.TOP + half_space.BOTTOM) / 2  # centre of the nucleus
        nucleus = (abs(y - start[0]) < half_space.NUCLEUS / 2) & (abs(z - start[1]) < half_space.NUCLEUS / 2)
        expected = np.where(nucleus, half_space.FIRST_RATE, half_space.PLATE_RATE)
        self.assertGreater(np.sum(nucleus), 0)
        self.assertLess(np.max(np.abs(faces.cell_data["slip rate"] / expected - 1)), 0.01)


if __name__ == "__main__":
    main()
