#!/usr/bin/env python3
"""Stages with excavation and fill: excavation_test.py PROGRAM ROOT MPIEXEC"""
import math
import shutil
import xml.etree.ElementTree as ET

from program import main
from stages import P1, P2, QUIET, Stages, kirsch_displacement, kirsch_stress


class Excavations(Stages):
    def test_kirsch(self):
        """Round gallery, order 2: wall displacements within 0.1 %, stress at the wall within 1 % of the largest."""
        for n, dim, ranks in ((16, 2, 1), (16, 2, 3), (16, 3, 1)):
            with self.subTest(n=n, dim=dim, ranks=ranks):
                values = self.gallery(n, dim)
                centres = self.wall_cells(n, dim)
                for k, x in enumerate(centres):
                    values["Probes"][f"cell {k}"] = {"point": x, "outputs": ["stress"]}
                self.run_scene(self.write(values), ranks=ranks)
                largest = math.hypot(*kirsch_displacement(1, 0))
                for name, place in values["Probes"].items():
                    seen = [float(v) for v in self.probe(name)[-1][1:]]
                    x, y = place["point"][:2]
                    if name.startswith("wall"):
                        error = math.dist(seen[:2], kirsch_displacement(x, y)) / largest
                        self.assertLess(error, 1e-3, name)
                    else:
                        seen = [seen[0], seen[1], seen[3]]
                        error = math.dist(seen, kirsch_stress(x, y)) / abs(3 * P1 - P2)
                        self.assertLess(error, 1e-2, (name, x, y, seen))

    def test_fractures_that_a_gallery_meets(self):
        """A cut fracture ends at the wall, another is removed.

        With monotone slip the end state is that with an initial gallery, for any steps and ranks."""
        always = self.run_scene(self.write(self.square(1, excavated=True)), "Time.schedule={1}")["steps"][-1]["fractures"]
        self.assertAlmostEqual(always["cut"]["area"], 12, delta=1e-12)
        self.assertEqual(always["inside"]["area"], 0)
        self.assertGreater(always["beside"]["mean_slip"], 1e-5)
        self.assertGreater(always["cut"]["mean_slip"], 1e-7)
        for steps, release, ranks in ((1, False, 1), (1, True, 1), (6, True, 1), (3, True, 3)):
            with self.subTest(steps=steps, release=release, ranks=ranks):
                results = self.run_scene(self.write(self.square(steps, release)), ranks=ranks)
                self.assertAlmostEqual(results["steps"][0]["fractures"]["cut"]["area"], 16, delta=1e-12)
                end = results["steps"][-1]["fractures"]
                for name, tolerance in (("cut", 1e-13), ("beside", 1e-13), ("inside", 0)):
                    self.assertEqual(end[name]["area"], always[name]["area"])
                    for number in ("mean_slip", "max_slip", "mean_opening") if tolerance else ():
                        self.assertAlmostEqual(end[name][number], always[name][number], delta=tolerance, msg=(name, number))

    def test_order_in_the_step(self):
        """Slip depends on the path if the wall pressure varies during the release.

        A quarter of the step reduces the error by more than 4."""
        press = ["Stages.excavation.Boundary conditions.lining.boundary=gallery",
                 "Stages.excavation.Boundary conditions.lining.confining pressure=1.2e8*max(t-1,0)*(2-t)*(t-1)"]
        ends = [self.run_scene(self.write(self.square(n)), *press)["steps"][-1]["fractures"] for n in (4, 16, 64, 256)]
        for name in ("beside", "cut"):
            slips = [end[name]["mean_slip"] for end in ends]
            errors = [abs(slip - slips[-1]) for slip in slips[:-1]]
            self.assertGreater(errors[0], 0.1 * slips[-1])
            for before, after in zip(errors, errors[1:]):
                self.assertLess(after, before / 4, name)

    def test_wet_gallery(self):
        """Water flows to the wall. In the steady state the flow through the boundary is equal."""
        scene = self.scene("stages/gallery_2d.xml")
        coarse = [QUIET, "Mesh.cells={30, 30}", "Output.checkpoints.steps=1"]
        # geometry moved to nodes of this coarse mesh, which has none at odd coordinates
        for name, ends in (("roof", "{-20, 4}, {14, 4}"), ("crossing", "{-24, 0}, {22, 0}"), ("wall", "{4, -20}, {4, 18}"),
                           ("steep", "{-2, 2}, {-2, 24}"), ("gallery", "{-4, -4}, {4, 2}")):
            lower, upper = ends.split("}, ")
            section = "regions" if name == "gallery" else "fractures"
            coarse += [f"Mesh.{section}.{name}.lower corner={lower}}}", f"Mesh.{section}.{name}.upper corner={upper}"]
        coarse.append("Probes.crown.point={0, 2}")
        results = self.run_scene(scene, *coarse)
        steps = results["steps"]
        self.assertEqual([stage["name"] for stage in results["stages"]], ["excavation", "lining", "decay"])
        inflows = steps[-1]["inflows"]
        self.assertLess(inflows["gallery"], -1e-8)
        self.assertAlmostEqual(sum(inflows.values()), 0, delta=2e-3 * abs(inflows["gallery"]))
        face = self.probe("face")
        self.assertTrue(all(math.isfinite(float(v)) for v in face[1][1:]))
        self.assertTrue(all(not math.isfinite(float(v or "nan")) for row in face[2:] for v in row[1:]))
        crown = [float(row[2]) for row in self.probe("crown")]  # displacement y
        at = {step["time"] / 86400: value for step, value in zip(steps, crown[1:])}
        self.assertLess(at[5], at[2])
        self.assertGreater(at[20], at[10])  # the lining lifts it
        self.assertLess(at[60], at[30])
        other = self.run_scene(scene, *coarse, ranks=3, output="three")
        for a, b in zip(steps, other["steps"]):
            for name, value in a["inflows"].items():
                self.assertAlmostEqual(value, b["inflows"][name], delta=1e-8 * abs(inflows["gallery"]))
        until = "86400, 172800, 259200"
        for ranks in (1, 3):
            self.run_scene(scene, *coarse, f"Time.schedule={{{until}}}", ranks=ranks, output="parts")
            sets = [word for option in coarse for word in ("--set", option)]
            self.call("run", scene, "--output", "parts", "--restart", *sets, ranks=ranks)
            self.expect_same_bits({1: "out", 3: "three"}[ranks], "parts")
            self.assertEqual(self.results("parts")["stages"], results["stages"])

    def test_one_excavation_after_another(self):
        """Without slip the order of excavations does not matter, and half of a release gives half of the displacement.

        Slip is transferred to the mesh of the second excavation."""
        def scene(excavated, friction=10.0):
            values = self.square(2, excavated=True)
            values["Materials"]["joint"]["friction coefficient"] = friction
            values["Mesh"]["regions"]["niche"] = {"lower corner": [-10.0, 2.0], "upper corner": [-7.0, 5.0]}
            del values["Mesh"]["fractures"]["inside"]
            values["Regions"] = {name: {"excavated": True} for name in excavated}
            values["Probes"] = {f"at {k}": {"point": x, "outputs": ["displacement", "stress"]}
                                for k, x in enumerate([[3.0, 3.0], [-5.0, -5.0], [9.0, -7.0], [-11.0, 5.0]])}
            if not excavated:
                del values["Regions"]
                values["Stages"] = {"first": {"time": 1.0, "excavate": ["gallery"]},
                                    "second": {"time": 2.0, "excavate": ["niche"], "release": 0.5}}
            return self.write(values)
        both = self.run_scene(scene(["gallery", "niche"]), "Time.schedule={1}", output="both")["steps"][-1]["fractures"]
        self.assertGreater(abs(both["beside"]["mean_elastic_jump"]["local"][1]), 1e-6)
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                steps = self.run_scene(scene([]), "Time.schedule={1, 2, 2.25, 2.5}", ranks=ranks)["steps"]
                for name, numbers in steps[-1]["fractures"].items():
                    for of, scale in (("mean_traction", 1e7), ("mean_elastic_jump", 1e-3)):
                        for a, b in zip(numbers[of]["local"], both[name][of]["local"]):
                            self.assertAlmostEqual(a, b, delta=1e-10 * scale)
                for k in range(4):
                    begin, half, end = ([float(v) for v in row[1:]] for row in self.probe(f"at {k}")[-3:])
                    for a, b in zip(end, self.probe(f"at {k}", "both")[-1][1:]):
                        self.assertAlmostEqual(a, float(b), delta=1e-10 * max(1e-3, abs(float(b))))
                    for a, b, c in zip(begin, half, end):
                        self.assertAlmostEqual(b, (a + c) / 2, delta=1e-10 * max(1e-3, abs(c)))
                slides = self.run_scene(scene([], 0.2), "Time.schedule={1, 2, 2.0001}", ranks=ranks)["steps"]
                before, after = (step["fractures"]["beside"] for step in slides[-2:])
                self.assertGreater(before["max_slip"], 1e-5)
                for number in ("max_slip", "mean_slip"):
                    self.assertAlmostEqual(after[number], before[number], delta=1e-2 * before[number])

    def test_pressures_are_carried(self):
        """One second after a further excavation in wet rock, pressures elsewhere and flow to the first wall persist."""
        options = [QUIET, "Mesh.cells={60, 60}", "Mesh.regions.niche.lower corner={20, -20}", "Mesh.regions.niche.upper corner={22, -18}",
                   "Stages.niche.time=4 d", "Stages.niche.excavate={niche}", "Stages.niche.release=1 d",
                   "Time.schedule={86400, 172800, 345600, 345601}"]
        places = {"a": "{10.3, 10.2}", "b": "{-15.3, -8.1}", "c": "{6.7, -2.2}"}
        for name, x in places.items():
            options += [f"Probes.{name}.point={x}", f"Probes.{name}.outputs={{pressure}}"]
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                steps = self.run_scene(self.scene("stages/gallery_2d.xml"), *options, ranks=ranks)["steps"]
                self.assertEqual([step.get("stage") for step in steps], [None, "excavation", "excavation", "niche"])
                values = [[float(v) for v in (row[1] for row in self.probe(name)[-2:])] for name in places]
                for before, after in values:
                    self.assertAlmostEqual(after, before, delta=1e3)  # of 2 MPa
                self.assertGreater(max(v[0] for v in values) - min(v[0] for v in values), 1e5)
                before, after = (step["inflows"]["gallery"] for step in steps[-2:])
                self.assertAlmostEqual(after, before, delta=0.02 * abs(before))

    def test_fill_and_other_constants(self):
        """A column is loaded, unloaded and filled, loaded again, then its constants change.

        Fill is free of stress when placed. Changes of constants preserve the stress. The results are exact in 2D and
        3D, for both orders, on several ranks, and after a restart."""
        modulus = lambda rock: rock[0] * (1 - rock[1]) / ((1 + rock[1]) * (1 - 2 * rock[1]))
        lower, fill, stiffer = (modulus(rock) for rock in (self.LOWER, self.UPPER, self.STIFFER))
        # at the face and on top: 2 MPa on the rock; unloaded; 5 MPa on the fill, twice; other constants; 9 MPa
        face = [-2e6 / lower, 0, -5e6 / lower, -5e6 / lower, -5e6 / lower, -5e6 / lower - 4e6 / fill]
        top = [math.nan] + [u - face[0] - 2 * s for u, s in zip(face[1:], (0, 5e6 / fill, 5e6 / fill, 5e6 / fill, 5e6 / fill + 4e6 / stiffer))]
        pressed = [2e6, 0, 5e6, 5e6, 5e6, 9e6]
        for cell, order, ranks in (("triangle", 1, 1), ("triangle", 2, 3), ("quadrilateral", 1, 3), ("tetrahedron", 1, 3),
                                   ("tetrahedron", 2, 1), ("hexahedron", 1, 1), ("hexahedron", 2, 3)):
            with self.subTest(cell=cell, order=order, ranks=ranks):
                values = self.column(cell, order)
                up = len(values["Mesh"]["cells"]) - 1
                scene = self.write(values)
                self.run_scene(scene, "Output.checkpoints.steps=1", ranks=ranks)
                for name, exact in (("face", face), ("top", top)):
                    for row, u in zip(self.probe(name)[-6:], exact):
                        self.assertAlmostEqual(float(row[1 + up]), u, delta=1e-9 * abs(face[-1])) if u == u else self.assertEqual(row[1 + up], "nan")
                for name in ("low", "high"):
                    for row, p in list(zip(self.probe(name)[-6:], pressed))[name == "high":]:
                        stress = [float(v) for v in row[2 + up:]]
                        self.assertAlmostEqual(stress[(1, 2)[up - 1]], -p, delta=10)
                parts = self.folder / "parts"
                shutil.rmtree(parts, ignore_errors=True)
                shutil.copytree(self.folder / "out", parts)
                shutil.rmtree(max(parts.glob("checkpoints/[0-9]*"), key=lambda folder: int(folder.name)))
                self.call("run", scene, "--output", "parts", "--restart", "--set", "Output.checkpoints.steps=1", ranks=ranks)
                self.expect_same_bits("out", "parts")

    def test_rock_that_no_entry_names(self):
        """Regions without a section have the material of the bulk, and its changes."""
        values = self.column("quadrilateral", 1)
        del values["Regions"], values["Stages"]["fill"], values["Stages"]["grout"]
        values["Materials"]["lower"]["Young's modulus"] = "modulus"
        values["Expressions"] = {"modulus": "1e10"}
        values["Boundary conditions"]["load"]["boundary"] = "north"
        values["Stages"]["softer"] = {"time": 2.0, "Expressions": {"modulus": "2e9"}}
        self.run_scene(self.write(values), "Time.schedule={1, 2, 3}")
        before, after = ([float(v) for v in row[1:]] for row in self.probe("top")[-2:])
        self.assertLess(before[1], 0)
        for a, b in zip(before, after):
            self.assertAlmostEqual(a, b, delta=1e-9 * max(1e-4, abs(b)))

    def test_wet_fill(self):
        """Fill in wet rock has the initial pressure and no stress when placed.

        Without further changes a short step causes no displacement, independently of earlier displacements of the
        walls."""
        options = [QUIET, "Stages.excavation.release=1 d", "Stages.fill.time=20 d", "Stages.fill.backfill={gallery}",
                   "Stages.fill.Regions.gallery.material=granite",
                   "Stages.fill.without={Boundary conditions > seepage}", "Time.schedule={86400, 172800, 1728000, 1728001}",
                   "Probes.inside.point={0, 0.6}", "Probes.inside.outputs={pressure, stress, displacement}",
                   "Probes.outside.point={8.3, 3.4}", "Probes.outside.outputs={pressure, displacement}"]
        root = ET.parse(self.scene("stages/gallery_2d.xml")).getroot()
        for parent in root.iter("ParameterList"):
            for child in list(parent):
                if child.get("name") in ("fractures", "lining", "decay") or (parent.get("name") == "Sprekk" and child.get("name") in ("Fractures", "Wells")):
                    parent.remove(child)
        path = self.folder / "wet.xml"
        path.write_bytes(ET.tostring(root))
        for ranks in (1, 3):
            with self.subTest(ranks=ranks):
                self.run_scene(str(path), *options, ranks=ranks)
                pressure, *rest = [float(v) for v in self.probe("inside")[-1][1:]]
                initial = float(self.probe("outside")[-4][1])
                self.assertAlmostEqual(pressure, initial, delta=1e-2 * initial)
                for component in rest[:3]:
                    self.assertLess(abs(component), 2e4)  # of 10 MPa around it
                before, after = ([float(v) for v in row[1:]] for row in self.probe("outside")[-2:])
                self.assertGreater(abs(before[1]) + abs(before[2]), 1e-6)
                for a, b in zip(before[1:], after[1:]):
                    self.assertAlmostEqual(a, b, delta=1e-7)


if __name__ == "__main__":
    main()
