#!/usr/bin/env python3
"""Table of stress intensity factors on ranks and after a restart, and refused scenes: stress_intensity_test.py PROGRAM ROOT MPIEXEC"""

import csv
import math
import xml.etree.ElementTree as xml

from program import ROOT, ProgramTest, main

SCENE = "growth/edge_crack_2d.xml"


class StressIntensity(ProgramTest):
    def rows(self, output="out"):
        with open(self.folder / output / "stress_intensity.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_table(self):
        """The factor is proportional to the load. Results and table agree, on one and several ranks and after a restart."""
        last = {}
        for ranks in (1, 3):
            content = self.run_scene(SCENE, ranks=ranks)
            steps, rows = content["steps"], self.rows()
            self.assertEqual(len(rows), len(steps))
            for step, row in zip(steps, rows):
                found = step["stress_intensity"]
                self.assertEqual(row["fracture"], "crack")
                for key in ("K_I", "K_II", "G", "error", "x", "radius"):
                    self.assertAlmostEqual(float(row[f"{key} [{content['tables']['stress_intensity'][key]}]"]), found[key][0])
                self.assertAlmostEqual(found["K_I"][0] / step["time"], steps[-1]["stress_intensity"]["K_I"][0] / steps[-1]["time"], delta=1e-6 * found["K_I"][0])
                self.assertLess(abs(found["K_I"][0] - found["K_I_of_jump"][0]), 0.2 * found["K_I"][0])
            last[ranks] = steps[-1]["stress_intensity"]["K_I"][0]
        self.assertAlmostEqual(last[1], last[3], delta=1e-8 * last[1])
        whole = self.rows()
        sets = ["--set", "Output.checkpoints.steps=1"]
        self.call("run", self.scene(SCENE), "--output", "part", *sets, "--set", "Time.schedule={1}")
        self.call("run", self.scene(SCENE), "--output", "part", *sets, "--restart")
        again = self.rows("part")
        self.assertEqual(len(again), len(whole))
        for a, b in zip(again, whole):
            self.assertTrue(math.isclose(float(a["K_I [Pa*m^0.5]"]), float(b["K_I [Pa*m^0.5]"]), rel_tol=1e-8))
        self.call("run", self.scene(SCENE), "--output", "part", *sets, "--restart")  # no step is left
        self.assertEqual(self.rows("part"), again)
        for name in ("units", "tables"):
            self.assertEqual(self.results("part")[name], content[name])

    def test_pore_pressure(self):
        """A linear pore pressure, with the displacement that frees the plane of its stress, leaves K of a crack unchanged."""
        scene = ROOT / "tests/verification/tips/opening.xml"
        text = xml.parse(scene).find(".//Parameter[@name='displacement']").get("value").strip("{} ")
        ends = [k for k, sign in enumerate(text) if sign == "," and text[:k].count("(") == text[:k].count(")")]
        u, v = text[:ends[0]], text[ends[0] + 1:]
        biot, gradient = 0.8, 1e-3  # lambda + G = 2
        a = biot * gradient / 4
        requested = ["Fractures.crack.stress intensity=true", "Output.vtu=false"]
        before = self.run_scene(str(scene), *requested)["steps"][-1]["stress_intensity"]
        after = self.run_scene(
            str(scene), *requested, "Materials.rock.permeability={1e-12}", f"Materials.rock.Biot coefficient={biot}", "Materials.rock.porosity=0.1",
            "Materials.joint.Biot coefficient=0", "Materials.joint.initial aperture=1e-3", "Materials.joint.residual aperture=1e-4",
            "Flow.viscosity=1e-3", "Flow.initial pressure=0", f"Regions.rock.pressure={gradient}*x",
            f"Boundary conditions.exact.displacement={{{u}+{a / 2}*(x^2-y^2), {v}+{a}*x*y}}")["steps"][-1]["stress_intensity"]
        K = 1e-3 * math.sqrt(math.pi)
        for tip in range(2):
            self.assertAlmostEqual(before["K_I"][tip], K, delta=0.01 * K)
            self.assertAlmostEqual(after["K_I"][tip], before["K_I"][tip], delta=0.01 * K)
            self.assertAlmostEqual(after["K_II"][tip], 0, delta=0.01 * K)

    def test_filling_without_flow(self):
        """A given fluid pressure acts with Biot's coefficient of the filling: K is linear in it, and with 0 that without pressure."""
        def K(*entries):
            return self.run_scene(SCENE, *entries)["steps"][-1]["stress_intensity"]["K_I"][0]
        dry, pressure = K(), "Fractures.crack.fluid pressure=1e6"
        none, half, full = (K(pressure, f"Materials.joint.Biot coefficient={biot}") for biot in (0, 0.5, 1))
        self.assertAlmostEqual(none, dry, delta=1e-6 * dry)
        self.assertAlmostEqual(half - dry, (full - dry) / 2, delta=1e-6 * full)
        self.assertGreater(full, 1.5 * dry)

    def test_only_if_requested(self):
        content = self.run_scene(SCENE, "Fractures.crack.stress intensity=false")
        self.assertNotIn("stress_intensity", content["steps"][0])
        self.assertFalse((self.folder / "out/stress_intensity.csv").exists())

    def test_refused(self):
        for entry, words in (("Materials.rock.Poisson's ratio=0.499", "nearly incompressible"), ("Bulk.rigid=true", "does not deform")):
            error = self.call("run", self.scene(SCENE), "--output", "out", "--set", entry, expect=1)[1]
            self.assertIn('Fractures > crack > "stress intensity"', error)
            self.assertIn(words, error)


main()
