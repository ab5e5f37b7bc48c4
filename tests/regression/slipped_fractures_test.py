#!/usr/bin/env python3
"""Fractures inside the rock with initial slip and no further slip: slipped_fractures_test.py PROGRAM ROOT MPIEXEC

The slip is uniform and the jump is zero at tips, so cells at tips deform. Faces under compression retain their slip."""
import itertools
import math

from program import ProgramTest, main

KINDS = {2: ("triangle", "quadrilateral"), 3: ("tetrahedron", "hexahedron")}
SLIP = {2: "{1e-2}", 3: "{1e-2, 2e-2}"}
LOAD = {2: "{0, -0.05*t}", 3: "{0, 0, -0.05*t}"}


class Slipped(ProgramTest):
    def run_slipped(self, dim, cell, tips, ranks):
        """Runs a case with the initial slip and then compression as the only loads. In 3D the solver is iterative."""
        lines = self.scene(f"seed/immersed_{dim}d.xml").read_text().splitlines()
        left = [line for line in lines if "friction coefficient" not in line and "tangential stiffness" not in line]
        (self.folder / "a.xml").write_text("\n".join(left))
        sets = [f"Mesh.cells={{{', '.join(['9' if dim == 3 else '12'] * dim)}}}", "Mesh.cell=" + cell, "Mesh.tips=" + tips, "Time.end=1", "Time.steps=1",
                "Materials.joint.friction=no slip", "Fractures.fracture.plastic jump=" + SLIP[dim], "Boundary conditions.moved.displacement=" + LOAD[dim]]
        return self.run_scene(str(self.folder / "a.xml"), *sets, ranks=ranks)["steps"]

    def test_every_face_keeps_its_slip(self):
        for dim in (2, 3):
            slip = math.hypot(*eval(SLIP[dim].replace("{", "(").replace("}", ",)")))
            for cell, tips, ranks in itertools.product(KINDS[dim], ("plain", "enriched"), (1, 2)):
                with self.subTest(dim=dim, cell=cell, tips=tips, ranks=ranks):
                    (step,) = self.run_slipped(dim, cell, tips, ranks)
                    fracture = step["fractures"]["fracture"]
                    self.assertEqual(fracture["fraction_stick"], 1)
                    self.assertAlmostEqual(fracture["mean_slip"], slip, delta=1e-9)
                    self.assertLessEqual(step["newton_iterations"], 4)
                    self.assertEqual(step["cuts"], 0)


if __name__ == "__main__":
    main()
