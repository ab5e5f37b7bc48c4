#!/usr/bin/env python3
"""Results of single fractures of sets: fractures_test.py PROGRAM ROOT MPIEXEC"""
import csv
import math
import subprocess
import sys

from networks import mesh_of
from program import ROOT, ProgramTest, main

MAPPED = "networks/mapped_2d.xml"
GRANITE = 14854721950  # shear modulus of the library, Pa


class Fractures(ProgramTest):
    def run_mapped(self, *sets, ranks=1, expect=0):
        path = mesh_of(self.folder, self.scene(MAPPED))
        return self.run_scene(MAPPED, path, "Output.vtu=false", *sets, ranks=ranks, expect=expect)

    def test_names_areas_directions(self):
        r = self.run_mapped("Time.steps=1")
        with open(ROOT / "xml/networks/mapped.csv") as file:
            traces = list(csv.DictReader(line for line in file if not line.startswith("#")))
        singles = r["single_fractures"]
        self.assertEqual([one["name"] for one in singles], [trace["name"] for trace in traces])
        for one, trace in zip(singles, traces):
            x0, y0, x1, y1 = (float(trace[key]) for key in ("x0", "y0", "x1", "y1"))
            self.assertEqual(one["set"], "traces")
            self.assertAlmostEqual(one["area"], math.hypot(x1 - x0, y1 - y0), delta=1e-9 * 100)
            self.assertAlmostEqual(one["strike"], math.degrees(math.atan2(x1 - x0, y1 - y0)) % 180, delta=1e-6)
            for i, middle in enumerate(((x0 + x1) / 2, (y0 + y1) / 2)):
                self.assertAlmostEqual(one["centre"][i], middle, delta=1e-6)

    def test_slip_tendency_of_uniform_stress(self):
        """Stiff fractures without slip do not change a uniform stress.

        The slip tendency follows from its components."""
        r = self.run_mapped("Materials.mapped joint.tangential stiffness=1e9 GPa/m", "Time.schedule={1e-9}")
        for one, tendency in zip(r["single_fractures"], r["steps"][0]["single_fractures"]["slip_tendency"]):
            nx, ny, _ = one["normal"]
            compression, shear = 12 * nx * nx + 8 * ny * ny, abs((12 - 8) * nx * ny)
            self.assertAlmostEqual(tendency, shear / compression, delta=1e-6)

    def test_which_slip(self):
        """One run lists the slipping fractures in the log and in a table."""
        path = mesh_of(self.folder, self.scene(MAPPED))
        out, _ = self.call("run", self.scene(MAPPED), "--set", path, "--output", "out")
        r = self.results()
        last = r["steps"][-1]["single_fractures"]
        slipping = {one["name"] for one, part in zip(r["single_fractures"], last["fraction_slip"]) if part > 0}
        self.assertTrue(0 < len(slipping) < 12, slipping)
        line = next(line for line in out.splitlines() if line.startswith("slip on "))
        self.assertIn(f"slip on {len(slipping)} of 12 fractures", line)
        self.assertEqual({word for word in line.split('"')[1::2]}, slipping)
        with open(self.folder / "out" / "fractures.csv") as file:
            table = list(csv.DictReader(file))
        self.assertEqual({row["name"] for row in table if float(row["length_slip [m]"]) > 0}, slipping)
        rounding = 1e-14 * max(last["mean_slip"])
        self.assertEqual([float(row["mean_slip [m]"]) for row in table], [x if x >= rounding else 0 for x in last["mean_slip"]])
        script = [sys.executable, ROOT / "docs/read_results.py", self.folder / "out"]
        rows = subprocess.run([*script, "B2"], capture_output=True, text=True).stdout.splitlines()
        k = [row["name"] for row in table].index("B2")
        self.assertEqual(float(rows[len(r["steps"])].split()[4].strip("%")), round(100 * last["fraction_slip"][k]))
        self.assertIn("traces, A1, A2,", subprocess.run([*script, "B9"], capture_output=True, text=True).stderr)

    def test_moment_and_totals(self):
        """The moment is G times slip times area. Sets have the sums and means of their fractures."""
        r = self.run_mapped()
        areas = [one["area"] for one in r["single_fractures"]]
        for step in r["steps"]:
            each, of_set = step["single_fractures"], step["fractures"]["traces"]
            for slip, area, moment in zip(each["mean_slip"], areas, each["moment"]):
                self.assertAlmostEqual(moment, GRANITE * slip * area, delta=1e-12 * GRANITE)
            self.assertAlmostEqual(sum(each["moment"]), of_set["moment"], delta=1e-9 * of_set["moment"] + 1e-9)
            self.assertAlmostEqual(sum(a * s for a, s in zip(areas, each["mean_slip"])), sum(areas) * of_set["mean_slip"], delta=1e-12)
            self.assertEqual(max(each["max_slip"]), of_set["max_slip"])
            self.assertAlmostEqual(sum(each["area_slip"]), of_set["fraction_slip"] * of_set["area"], delta=1e-9)
            self.assertNotIn("moment_magnitude", each)  # moments are per metre of depth
        self.assertGreater(of_set["moment"], 0)
        self.assertEqual((r["units"]["moment"], r["units"]["mean_slip"], r["units"]["area_slip"]), ("N", "m", "m"))

    def test_columns_are_entries_of_joints(self):
        """A trace with low own friction slips. Empty cells use the value of the material."""
        tendency = self.run_mapped("Time.steps=1")["steps"][0]["single_fractures"]["slip_tendency"]
        names = [one["name"] for one in self.results()["single_fractures"]]
        table = ROOT / "xml/networks/mapped.csv"
        lines = table.read_text().splitlines()
        changed = [line if not line.startswith("C3") else line.replace(",0.35,", ",0.01,") for line in lines]
        (self.folder / "mapped.csv").write_text("\n".join(changed) + "\n")
        (self.folder / "mapped.xml").write_text((ROOT / "xml" / MAPPED).read_text())
        path = mesh_of(self.folder, self.folder / "mapped.xml")
        r = self.run_scene(str(self.folder / "mapped.xml"), path, "Output.vtu=false", "Time.steps=1")
        after = r["steps"][0]["single_fractures"]
        at = names.index("C3")
        self.assertGreater(tendency[at], 0.02)
        self.assertLess(after["slip_tendency"][at], 0.0101)
        self.assertEqual(after["fraction_slip"][at], 1)

    def test_wrong_columns(self):
        scene = self.folder / "mapped.xml"
        scene.write_text((ROOT / "xml" / MAPPED).read_text())
        lines = (ROOT / "xml/networks/mapped.csv").read_text().splitlines()
        for title, cell, words in (
                ("friction coefficient", "-1", 'single fractures > A1 > "friction coefficient": is -1, must be'),
                ("friction coefficient", "0.5 m", 'single fractures > A1 > "friction coefficient"'),
                ("material", "granit", 'fracture "A1": "material": is "granit"')):
            table = [line.replace("friction coefficient", title) for line in lines]
            table[2] = table[2].replace(",0.55,", f",{cell},")
            if title != "friction coefficient":
                table[3:] = [",".join(line.split(",")[:5]) + ",," for line in table[3:]]
            (self.folder / "mapped.csv").write_text("\n".join(table) + "\n")
            path = mesh_of(self.folder, scene)
            for ranks in (1, 2):
                _, err = self.call("check", scene, "--set", path, ranks=ranks, expect=1)
                self.assertIn(words, err)

    def test_columns_that_are_no_entries(self):
        scene = self.folder / "mapped.xml"
        scene.write_text((ROOT / "xml" / MAPPED).read_text())
        text = (ROOT / "xml/networks/mapped.csv").read_text().replace("initial aperture [mm]", "geologist's remark")
        (self.folder / "mapped.csv").write_text(text)
        _, err = self.call("check", scene, "--set", mesh_of(self.folder, scene))
        self.assertIn('ignored columns of fractures, which are no entries of a joint: "geologist\'s remark"', err)

    def test_biaxial_and_triaxial_test(self):
        """The joint slips at the load of Mohr and Coulomb, which then stays constant.

        The slip takes up further displacement."""
        young, poisson, stiffness, height, confinement = 20e9, 0.2, 50e9, 0.125, 5e6
        mu, dilation, beta = math.tan(math.radians(30)), math.tan(math.radians(5)), math.atan(0.0866 / 0.05)
        rise = 2 * mu * confinement / ((1 - mu / math.tan(beta)) * math.sin(2 * beta))
        for name, ranks, top, area, modulus in (("biaxial_2d", 2, "north", 0.05, young / (1 - poisson**2)), ("triaxial_3d", 1, "top", 0.05**2, young)):
            scene = f"networks/{name}.xml"
            r = self.run_scene(scene, mesh_of(self.folder, self.scene(scene)), "Output.vtu=false", ranks=ranks)
            compliance = height / modulus + math.sin(beta)**2 * math.cos(beta) / stiffness
            self.assertTrue(6 < 20 * rise * compliance / 0.4e-3 < 7)
            for k, step in enumerate(r["steps"], 1):
                shortening = 0.4e-3 * k / 20
                added = min(shortening / compliance, rise)
                joint = step["fractures"]["joint"]
                self.assertAlmostEqual(-step["reactions"][top][-1] / area, confinement + added, delta=1e-6 * rise)
                self.assertEqual(joint["fraction_slip"], float(k > 6))
                slip = max(shortening - rise * compliance, 0) / (math.sin(beta) - dilation * math.cos(beta))
                self.assertAlmostEqual(joint["mean_slip"], slip, delta=1e-6 * 0.4e-3)
        flat = (ROOT / "xml/networks/biaxial_2d.xml").read_text().replace("{0, 0.019, 0.05, 0.1056}", "{0, 0.05, 0.05, 0.0733}")
        (self.folder / "flat.xml").write_text(flat)  # 25 degrees: below the friction angle
        r = self.run_scene(str(self.folder / "flat.xml"), mesh_of(self.folder, self.folder / "flat.xml"), "Output.vtu=false")
        self.assertEqual({step["fractures"]["joint"]["fraction_slip"] for step in r["steps"]}, {0.0})

    def test_any_number_of_ranks(self):
        results = [self.run_mapped(ranks=ranks) for ranks in (1, 2, 3)]
        for r in results[1:]:
            self.assertEqual([one["name"] for one in r["single_fractures"]], [one["name"] for one in results[0]["single_fractures"]])
            for key, values in results[0]["steps"][-1]["single_fractures"].items():
                flat = [[x for value in of for x in (value if isinstance(value, list) else [value])]
                        for of in (values, r["steps"][-1]["single_fractures"][key])]
                size = max(abs(x) for x in flat[0])
                for one, other in zip(*flat):
                    self.assertAlmostEqual(one, other, delta=1e-8 * size, msg=key)

    def test_default_joint(self):
        """Fractures without a section, or without a material in it, use the default joint.

        Without one there is an error."""
        crossing = "verification/crossing_2d.xml"
        before = self.run_scene(crossing, "Output.vtu=false")["steps"][-1]["fractures"]
        names = sorted(before)
        text = self.scene(crossing).read_text()
        start, end = text.index('<ParameterList name="Fractures">'), text.index('<ParameterList name="Boundary conditions">')
        scene = self.folder / "default.xml"
        material = text[start:end].split('name="material" type="string" value="')[1].split('"')[0]
        inner = f'<Parameter name="material" type="string" value="{material}"/>'
        scene.write_text(text[:start] + f'<ParameterList name="Fractures">{inner}</ParameterList>' + text[end:])
        after = self.run_scene(str(scene), "Output.vtu=false")["steps"][-1]["fractures"]
        self.assertEqual(sorted(after), names)
        self.assertEqual(after, before)
        scene.write_text(text[:start] + f'<ParameterList name="Fractures"><ParameterList name="{names[0]}"/></ParameterList>' + text[end:])
        _, err = self.call("check", scene, expect=1)
        self.assertIn(f'Fractures > {names[0]} > "material": missing; it is required', err)

    def test_strike_and_dip(self):
        """Strike and dip are those of the scene. Names contain the set and the section."""
        scene = "networks/shapes_3d.xml"
        path = mesh_of(self.folder, self.scene(scene), "Mesh file.network.relative size=0.5")
        r = self.run_scene(scene, path, "Output.vtu=false", "Time.schedule={1e-3}")
        steep, = (one for one in r["single_fractures"] if one["name"].endswith(" steep"))
        self.assertEqual(steep["name"], steep["set"] + " steep")
        self.assertAlmostEqual(steep["strike"], 30, delta=1e-5)
        self.assertAlmostEqual(steep["dip"], 75, delta=1e-5)
        self.assertAlmostEqual(steep["area"], math.pi * 3 * 2, delta=1e-6)

    def test_magnitude_in_three_dimensions(self):
        """Magnitude is 2/3 (log10 M0 - 9.1), and absent without slip."""
        r = self.run_scene("verification/regimes_3d.xml", "Output.vtu=false")
        seen = 0
        for step in r["steps"]:
            each = step["single_fractures"]
            for moment, magnitude in zip(each["moment"], each["moment_magnitude"]):
                if moment > 0:
                    self.assertAlmostEqual(magnitude, 2 / 3 * (math.log10(moment) - 9.1), delta=1e-12)
                    seen += 1
                else:
                    self.assertIsNone(magnitude)
        self.assertGreater(seen, 0)


if __name__ == "__main__":
    main()
