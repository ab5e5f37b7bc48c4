#!/usr/bin/env python3
"""Prescribed slip in stages, restarts and parts of a fracture, and its errors: prescribed_slip_test.py PROGRAM ROOT MPIEXEC"""

from program import ProgramTest, main

SCENE = "verification/events_2d.xml"
HERE = "Fractures.fracture.prescribed slip"
G, LAMBDA, SHORTENING, FRICTION = 30e9, 30e9, 1e-3, 0.6
BOUND = FRICTION * (LAMBDA + 2 * G) * SHORTENING
TIMES = (10, 10.5, 11, 20, 21, 22, 30)
SLIPS = (0, 0.005, 0.01, 0.011, 0.026, 0.041, 0.041)


class PrescribedSlip(ProgramTest):
    def series(self, content, key, component=None):
        lists = [step["single_fractures"][key][0] for step in content["steps"]]
        return lists if component is None else [one[component] for one in lists]

    def near(self, values, wanted, relative=1e-9):
        self.assertEqual(len(values), len(wanted))
        for value, exact in zip(values, wanted):
            self.assertAlmostEqual(value, exact, delta=relative * max(map(abs, wanted)))

    def test_history(self):
        """Slip, traction, state and moment follow the function, on one and several ranks and after a restart."""
        for ranks in (1, 3):
            whole = self.run_scene(SCENE, ranks=ranks)
            self.near(self.series(whole, "mean_slip"), SLIPS)
            self.near(self.series(whole, "mean_traction_local", 1), [G * slip for slip in SLIPS])
            self.near(self.series(whole, "moment"), [G * slip for slip in SLIPS])
            self.assertEqual(self.series(whole, "fraction_slip"), [0, 1, 1, 1, 1, 1, 0])
        sets = ["--set", "Output.checkpoints.steps=1"]
        self.call("run", self.scene(SCENE), "--output", "part", *sets, "--set", "Time.schedule={10, 10.5, 11}")
        self.call("run", self.scene(SCENE), "--output", "part", *sets, "--restart")
        self.near(self.series(self.results("part"), "mean_traction_local", 1), [G * slip for slip in SLIPS])

    def test_stages(self):
        """A stage removes the slip: friction continues, and the fracture slides back to its strength. Another adds it."""
        without = self.run_scene(SCENE, "Stages.free.time=11", "Stages.free.without={Fractures > fracture > prescribed slip}")
        self.near(self.series(without, "mean_traction_local", 1)[3:], [BOUND] * 4)
        self.near(self.series(without, "mean_slip")[3:], [BOUND / G] * 4)
        empty = self.run_scene(SCENE, "Stages.free.time=11", f"Stages.free.{HERE}.slip={{}}")
        self.near(self.series(empty, "mean_slip"), self.series(without, "mean_slip"))
        late = self.run_scene(SCENE, f"{HERE}.slip={{}}", "Stages.driven.time=20", f"Stages.driven.{HERE}.slip={{slip(t)}}")
        self.near(self.series(late, "mean_slip"), (0, 0, 0, 0, *SLIPS[4:]))

    def test_opening(self):
        """A prescribed opening is independent of the compression."""
        content = self.run_scene(SCENE, f"{HERE}.opening=1e-4*t")
        self.near(self.series(content, "mean_opening"), [1e-4 * t for t in TIMES])
        normal = [-(LAMBDA + 2 * G) * (SHORTENING + 1e-4 * t) for t in TIMES]
        self.near(self.series(content, "mean_traction_local", 0), normal)

    def test_part_of_a_fracture(self):
        """Faces outside of the box obey friction."""
        self.run_scene(SCENE, "Mesh.cells={8, 8}", f"{HERE}.slip={{1e-5*t}}", f"{HERE}.lower corner={{0, 0}}",
                       f"{HERE}.upper corner={{0.5, 1}}", "Probes.given.point={0.2, 0.5}", "Probes.free.point={0.7, 0.5}",
                       *(f"Probes.{name}.outputs={{slip, traction local}}" for name in ("given", "free")))
        last = {}
        for name in ("given", "free"):
            rows = (self.folder / "out/probes" / f"{name}.csv").read_text().splitlines()
            last[name] = dict(zip(rows[0].split(","), map(float, rows[-1].split(","))))
        self.assertAlmostEqual(last["given"]["slip [m]"], 3e-4, delta=1e-13)
        self.assertAlmostEqual(last["free"]["slip [m]"], 0, delta=1e-15)
        self.assertLess(abs(last["free"]["traction local t [Pa]"]), -FRICTION * last["free"]["traction local n [Pa]"])

    def test_errors(self):
        """Each mistake is one line with its place, on all ranks."""
        flat, solid = "contact/block_2d.xml", "contact/block_3d.xml"
        place = "Sprekk > Fractures > fracture > prescribed slip"
        for scene, entries, message in (
            (flat, ["slip={1, 2}"], f'{place} > "slip": has 2 values, must have 1'),
            (solid, ["slip={1}"], f'{place} > "slip": has 1 value, must have 2'),
            (flat, ["slip={1}", "direction={1, 0}"], f'{place} > "moving side": missing; it is required with "direction"'),
            (flat, ["slip={1}", "direction={1, 0, 0}", "moving side={0, 1}"], f'{place} > "direction": has 3 values'),
            (flat, ["opening=0"], f'{place} > "opening": requires "slip"'),
            (flat, ["slip={1}", "lower corner={0, 0}"], f'{place} > "upper corner": has 0 components'),
            (flat, ["slip={1}", "lower corner={0, 0}", "upper corner={1, 0.4}"], f'{place} > "lower corner": no face of'),
            (flat, ["slip={1}", "direction={0, 1}", "moving side={0, 1}"], '"direction": is normal to the face'),
            (solid, ["slip={1, 0}"], "the face is horizontal, without strike"),
        ):
            for ranks in (1, 2) if "horizontal" in message else (1,):
                sets = [word for entry in entries for word in ("--set", f"{HERE}.{entry}")]
                _, errors = self.call("check", self.scene(scene), *sets, ranks=ranks, expect=1)
                self.assertIn(message, errors)
                self.assertEqual(errors.count("sprekk: "), 1, errors)


if __name__ == "__main__":
    main()
