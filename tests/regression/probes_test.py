#!/usr/bin/env python3
"""Tables of probes: probes_test.py PROGRAM ROOT MPIEXEC"""
import csv
import math
import os
import re
import shutil
import signal
import subprocess
import time

import program
from program import ProgramTest, main

PATCH, INJECTION = "verification/uniaxial_2d.xml", "poro/injection_days_2d.xml"
CYCLIC = "verification/cyclic_2d.xml"
QUIET = "Output.vtu=false"
NU, E, LOAD = 0.25, 10e9, 5e6  # of PATCH: plane strain, rollers in the west and in the south
EXX, EYY = LOAD * NU * (1 + NU) / E, -LOAD * (1 - NU * NU) / E


def probe(name, **entries):
    return [f"Probes.{name}.{entry.replace('_', ' ')}={value}" for entry, value in entries.items()]


class Probes(ProgramTest):
    def table(self, name, output="out"):
        """Returns {title: values} of a probe."""
        with open(self.folder / output / "probes" / f"{name}.csv") as file:
            rows = list(csv.reader(file))
        return {title: [float(row[k]) for row in rows[1:]] for k, title in enumerate(rows[0])}

    def near(self, table, title, *exact, start=0, tolerance=1e-8):
        """Compares the values after those of the initial state, which are `start`, or equal to the later ones."""
        n = len(exact)
        self.assertIn(len(table[title]) - n, (1, n), table)
        self.assertEqual(set(table[title][:-n]), {start} if start is not None else set(table[title][-n:]), title)
        for value, wanted in zip(table[title][-n:], exact):
            self.assertAlmostEqual(value, wanted, delta=tolerance * max(abs(wanted), 1e-4), msg=title)

    def test_uniform_strain(self):
        """Points, lines, means, extremes and integrals of linear displacement and uniform stress, in all cell types."""
        probes = [*probe("here", point="{0.7, 1.9}", outputs="{displacement, stress}"),
                  *probe("along", line="{0, 0, 2, 3}", points=5, outputs="{displacement}"),
                  *probe("top", boundary="north", outputs="{displacement}"),
                  *probe("most", boundary="north", outputs="{displacement}", value="maximum"),
                  *probe("least", region="bulk", outputs="{displacement}", value="minimum"),
                  *probe("all", region="bulk", outputs="{displacement, stress}", value="integral"),
                  *probe("side", boundary="south", outputs="{reactions}")]
        for cell, order in (("triangle", 1), ("quadrilateral", 1), ("triangle", 2), ("quadrilateral", 2)):
            self.run_scene(PATCH, QUIET, f"Mesh.cell={cell}", f"Mesh.order={order}", *probes)
            here = self.table("here")
            self.near(here, "time [s]", 1)
            self.near(here, "displacement x [m]", 0.7 * EXX)
            self.near(here, "displacement y [m]", 1.9 * EYY)
            self.near(here, "stress YY [Pa]", -LOAD)
            self.near(here, "stress ZZ [Pa]", -LOAD * NU)
            along = self.table("along")
            self.near(along, "time [s]", *[1] * 5)
            self.near(along, "distance [m]", *(math.hypot(2, 3) * k / 4 for k in range(5)), start=None)
            self.near(along, "x [m]", 0, 0.5, 1, 1.5, 2, start=None)
            self.near(along, "displacement x [m]", *(EXX * x for x in (0, 0.5, 1, 1.5, 2)))
            self.near(self.table("top"), "mean displacement x [m]", EXX)
            self.near(self.table("most"), "maximum displacement x [m]", 2 * EXX)
            self.near(self.table("least"), "minimum displacement y [m]", 3 * EYY)
            everything = self.table("all")
            self.near(everything, "integral displacement y [m*m^2]", EYY * 3 * 3)
            self.near(everything, "integral stress YY [Pa*m^2]", -LOAD * 6)
            self.near(self.table("side"), "reactions y [N/m]", 2 * LOAD)

    def test_space(self):
        """Vertical load in 3D, for each cell type."""
        base = "verification/uniaxial_3d.xml"
        for cell, order in (("tetrahedron", 1), ("hexahedron", 1), ("hexahedron", 2)):
            self.run_scene(base, QUIET, f"Mesh.cell={cell}", f"Mesh.order={order}",
                           *probe("low", point="{0.31, 0.4, 0.2}", outputs="{displacement}"),
                           *probe("high", point="{0.31, 0.4, 0.6}", outputs="{displacement, stress}"))
            low, high = self.table("low"), self.table("high")
            self.assertAlmostEqual(high["displacement z [m]"][-1], 3 * low["displacement z [m]"][-1],
                                   delta=1e-8 * abs(low["displacement z [m]"][-1]))
            self.assertLess(high["stress ZZ [Pa]"][-1], 0)

    def test_injection_in_days(self):
        """Thirty days of injection: probes agree with results.json, and begin with the initial state."""
        r = self.run_scene(INJECTION)
        well = self.table("well")
        self.near(well, "time [d]", *range(1, 31))
        self.assertEqual(r["time_unit"], {"name": "d", "seconds": 86400})
        for key, unit, start in (("rate", "m^2/s", 0), ("pressure", "Pa", 10e6)):
            self.near(well, f"{key} [{unit}]", *[step["wells"]["injector"][key] for step in r["steps"]], start=start, tolerance=0)
        self.assertIn("in fault [m^2/s]", well)
        fault = self.table("fault")
        for title, key, start in (("max_slip [m]", "max_slip", 0), ("moment [N]", "moment", 0), ("slip_tendency [-]", "slip_tendency", 7 / 15)):
            self.assertEqual(fault[title][1:], [step["fractures"]["fault"][key] for step in r["steps"]])
            self.assertAlmostEqual(fault[title][0], start, delta=1e-12)
        self.assertGreater(fault["max_slip [m]"][-1], 1e-5)
        along = self.table("along the fault")
        self.assertEqual(len(along["slip [m]"]), 31 * 23)
        self.assertLessEqual(max(along["slip [m]"]), max(fault["max_slip [m]"]))
        self.assertGreater(max(along["slip [m]"]), 0.5 * max(fault["max_slip [m]"]))
        west = self.table("west side")
        self.near(west, "inflows [m^2/s]", *[step["inflows"]["west"] for step in r["steps"]], tolerance=0)
        self.assertEqual(west["reactions x [N/m]"][1:], [step["reactions"]["west"][0] for step in r["steps"]])
        above = self.table("ten metres above")["pressure [Pa]"]
        self.assertEqual(above[0], 10e6)
        self.assertGreater(above[-1], 10e6)

    def test_initial_state(self):
        """Tables begin with the initial state, which does not change the steps. Steady flow has no initial state."""
        start, stress = 3.0, -4e6
        sets = [QUIET, f"Time.start={start}", f"Bulk.initial stress={{{stress}, {stress}, {stress}, 0}}", "Time.end=4"]
        plain = self.run_scene(PATCH, *sets)["steps"]
        seen = self.run_scene(PATCH, *sets, *probe("here", point="{0.7, 1.9}", outputs="{displacement, stress}"),
                              *probe("side", boundary="south", outputs="{reactions}"))["steps"]
        self.assertEqual(seen, plain)
        here = self.table("here")
        self.assertEqual(here["time [s]"], [start, 4])
        self.assertEqual([here["stress YY [Pa]"][0], here["displacement y [m]"][0]], [stress, 0])
        self.assertAlmostEqual(self.table("side")["reactions y [N/m]"][0], -2 * stress, delta=1e-3)  # initial stress
        place = probe("here", point="{205, 105, -1010}", outputs="{pressure, Darcy velocity}")
        self.run_scene("flow/wells_3d.xml", QUIET, "Time.steps=1", "Mesh.cells={20, 20, 2}", *place)
        self.assertAlmostEqual(self.table("here")["pressure [Pa]"][0], 1e7 - 9810 * 10, delta=1)  # of the cell
        self.run_scene("flow/source_2d.xml", QUIET, *probe("here", point="{0.31, 0.4}", outputs="{pressure}"))
        self.assertEqual(len(self.table("here")["time [s]"]), 1)

    def at_utm(self, name, size):
        """Returns a scene with UTM coordinates and geometry enlarged by `size`, and a function for places."""
        text, origin = self.scene(name).read_text(), (5e5, 6.7e6, -2e3)

        def moved(entry):
            dim = text[text.index('name="upper corner"'):].split("}")[0].count(",") + 1
            values = [float(word) for word in entry[2].split(",")]
            return entry[1] + ", ".join(repr(origin[k % dim] + size * value) for k, value in enumerate(values)) + entry[3]
        text = re.sub(r'(name="(?:lower corner|upper corner|points)" type="Array\(double\)" value="\{)([^}]*)(\})', moved, text)
        path = self.folder / "utm.xml"
        path.write_text(text)
        return str(path), lambda *x: "{" + ", ".join(repr(origin[k % 2 if len(x) in (2, 4) else k % 3] + size * v) for k, v in enumerate(x)) + "}"

    def test_large_coordinates(self):
        """Places far from the origin: inside, on sides, nodes and fractures, and wells, in cells of 1 m and 0.1 m."""
        for size in (1.5, 0.15):  # cells of 1 and 0.1 m
            scene, at = self.at_utm(PATCH, size)
            points = [(0.7, 1.9), (2, 3), (0, 0), (1, 0.1), (2 / 3, 0.75), (2, 1.234)]
            self.run_scene(scene, QUIET, *(word for k, x in enumerate(points) for word in probe(f"p{k}", point=at(*x), outputs="{displacement}")),
                           *probe("along", line=at(0, 0, 2, 3), points=50, outputs="{stress}"),
                           *probe("rounded", point=f"{{{5e5 + size!r}, {math.nextafter(6.7e6 + 3 * size, 1e9)!r}}}", outputs="{stress}"))
            for k, (x, y) in enumerate(points):
                self.near(self.table(f"p{k}"), "displacement x [m]", size * x * EXX, tolerance=1e-6)
                self.near(self.table(f"p{k}"), "displacement y [m]", size * y * EYY, tolerance=1e-6)
            self.near(self.table("along"), "stress YY [Pa]", *[-LOAD] * 50, tolerance=1e-5)
        for dim, flat, size, all_ranks in ((2, (0.25, 0.5, 1, 0.5), 0.8, (1, 2, 3)), (3, (0.25, 0.25, 0.5, 0.75, 0.75, 0.5), 0.4, (2,))):
            scene, at = self.at_utm(f"verification/crossing_{dim}d.xml", size)
            for ranks in all_ranks:
                self.run_scene(scene, QUIET, "Time.schedule={2}", *probe("flat", line=at(*flat), points=40, outputs="{slip}"), ranks=ranks)
                self.assertGreater(max(self.table("flat")["slip [m]"]), 0)
        scene, at = self.at_utm(INJECTION, 0.1)
        self.run_scene(scene, QUIET, "Time.steps=1", *probe("ten metres above", point=at(-5, -990)), *probe("along the fault", line=at(-55, -1000, 55, -1000)))
        self.assertGreater(self.table("well")["pressure [Pa]"][-1], 10e6)

    def test_any_number_of_ranks(self):
        tables = []
        for ranks in (1, 2, 3):
            self.run_scene(INJECTION, QUIET, "Time.steps=5", ranks=ranks)
            tables.append({name: self.table(name) for name in ("well", "fault", "along the fault", "ten metres above", "west side")})
        for other in tables[1:]:
            for name, columns in tables[0].items():
                self.assertEqual(list(columns), list(other[name]))
                for title, values in columns.items():
                    size = max(map(abs, values))
                    for a, b in zip(values, other[name][title]):
                        self.assertAlmostEqual(a, b, delta=1e-6 * size + 1e-18, msg=f"{name}: {title}")

    def text(self, output, name="joint"):
        return (self.folder / output / "probes" / f"{name}.csv").read_bytes()

    def cyclic(self, *words, steps=8, output="out", expect=0):
        sets = ["Output.checkpoints.steps=2", QUIET, *probe("joint", fracture="fracture", outputs="{slip, traction local}")]
        if steps != 8:
            sets += [f"Time.end={steps}", f"Time.steps={steps}"]
        return self.call("run", self.scene(CYCLIC), "--output", output, *(word for one in sets for word in ("--set", one)), *words,
                         expect=expect)

    def test_restart(self):
        """After a restart the table is that of an uninterrupted run, without gaps or repeated lines."""
        fracture = list(self.run_scene(CYCLIC, QUIET)["steps"][0]["fractures"])[0]
        sets = ["Output.checkpoints.steps=2", QUIET, *probe("joint", fracture=fracture, outputs="{slip, traction local}")]
        whole = self.run_scene(CYCLIC, *sets, output="whole")
        times = [step["time"] for step in whole["steps"]]
        middle = times[len(times) // 2 + 1]
        words = [word for one in sets for word in ("--set", one)]
        schedule = "{" + ", ".join(map(str, times[:len(times) // 2 + 2])) + "}"
        self.call("run", self.scene(CYCLIC), "--output", "parts", *words, "--set", f"Time.schedule={schedule}")
        self.assertEqual(self.table("joint", "parts")["time [s]"][-1], middle)
        csv_file = self.folder / "parts" / "probes" / "joint.csv"
        csv_file.write_bytes(csv_file.read_bytes() + b"99,1,2")  # as after a kill in a later step
        shutil.copytree(self.folder / "parts", self.folder / "others")
        self.call("run", self.scene(CYCLIC), "--output", "parts", *words, "--restart")
        self.assertEqual(self.text("parts"), self.text("whole"))
        self.assertEqual((self.folder / "parts" / "probes.h5").read_bytes(), (self.folder / "whole" / "probes.h5").read_bytes())
        more = [*sets, *probe("new", fracture=fracture, outputs="{slip}"), "Output.time unit=min"]
        words = [word for one in more for word in ("--set", one)]
        self.call("run", self.scene(CYCLIC), "--output", "others", *words, "--restart", ranks=2)
        after = [t for t in times if t >= middle]
        self.assertEqual(self.table("new", "others")["time [min]"], [t / 60 for t in after])
        joint = self.table("joint", "others")
        self.assertEqual(joint["time [min]"], [t / 60 for t in (0, *times)])
        self.assertEqual([f"{slip:.6g}" for slip in joint["mean slip [m]"]], [f"{slip:.6g}" for slip in self.table("joint", "whole")["mean slip [m]"]])
        self.assertEqual(self.table("new", "others")["mean slip [m]"], joint["mean slip [m]"][-len(after):])
        changed = [word for one in sets for word in ("--set", one.replace("{slip, ", "{"))]
        self.call("run", self.scene(CYCLIC), "--output", "others", *changed, "--restart")
        self.assertEqual(self.table("joint", "others")["time [s]"], times[-1:])
        self.assertFalse((self.folder / "others" / "probes" / "new.csv").exists())

    def test_killed(self):
        """After a kill the table contains complete lines of all complete steps."""
        steps = 200
        words = ["--set", f"Time.steps={steps}", "--set", QUIET]
        for one in probe("here", point="{0.7, 1.9}", outputs="{displacement}"):
            words += ["--set", one]
        run = subprocess.Popen([str(program.PROGRAM), "run", str(self.scene(PATCH)), "--output", "out", *words], cwd=self.folder,
                               env={**os.environ, **program.ALONE})
        path = self.folder / "out" / "probes" / "here.csv"
        while run.poll() is None and not (path.exists() and path.read_bytes().count(b"\n") > 5):
            time.sleep(0.01)
        run.send_signal(signal.SIGKILL)
        run.wait()
        table = self.table("here")
        self.assertGreaterEqual(len(table["time [s]"]), 5)
        self.assertEqual(table["time [s]"], [k / steps for k in range(len(table["time [s]"]))])
        self.assertTrue(path.read_bytes().endswith(b"\n"))

    def test_one_file_for_others(self):
        """xarray reads all tables, with units and dimensions."""
        try:
            import h5netcdf  # noqa: F401
            import xarray
        except ImportError:
            self.skipTest("needs python3-xarray and python3-h5netcdf")
        self.run_scene(INJECTION, QUIET, "Time.steps=3")
        path = self.folder / "out" / "probes.h5"
        with xarray.open_dataset(path, group="along the fault", engine="h5netcdf") as line:
            self.assertEqual(line["slip"].dims, ("time", "distance"))
            self.assertEqual(line["slip"].shape, (4, 23))
            self.assertEqual(line["slip"].attrs["units"], "m")
            self.assertEqual(line["time"].attrs["units"], "d")
            self.assertEqual([float(t) for t in line["time"]], [0, 10, 20, 30])
            along = self.table("along the fault")
            self.assertEqual([float(x) for x in line["slip"].values.ravel()], along["slip [m]"])
            self.assertEqual([float(x) for x in line["x"]], along["x [m]"][:23])
        with xarray.open_dataset(path, group="well", engine="h5netcdf") as well:
            self.assertEqual([float(p) for p in well["pressure"]], self.table("well")["pressure [Pa]"])

    def test_errors(self):
        """Each error is one line with probe, value and alternatives, before the first step, for any ranks."""
        wrong = [(probe("p", point="{5, 5}", outputs="{stress}"), 'Probes > p: (5, 5, 0) is outside of the mesh'),
                 (probe("p", point="{1, 1, 1}", outputs="{stress}"), 'Probes > p > "point": has 3 values, must have 2'),
                 (probe("p", point="{1, 1}", outputs="{stres}"), '"outputs": is "stres", must be one of "displacement", "stress". Did you mean "stress"?'),
                 (probe("p", point="{1, 1}"), 'Probes > p > "outputs": missing'),
                 (probe("p", outputs="{stress}"), 'Probes > p: give one of "point", "line", "boundary", "region", "fracture", "well"'),
                 (probe("p", boundary="up", outputs="{stress}"), '"boundary": is "up", must be one of'),
                 (probe("p", fracture="fault", outputs="{slip}"), '"fracture": is "fault", must be one of'),
                 (probe("p", well="deep"), 'Probes > p > "well": is "deep"'),
                 (probe("a/b", point="{1, 1}", outputs="{stress}"), "Probes > a/b: its name becomes a file name")]
        for sets, words in wrong:
            for ranks in (1, 2):
                _, err = self.call("run", self.scene(PATCH), "--output", "out", *(word for one in sets for word in ("--set", one)),
                                   ranks=ranks, expect=1)
                self.assertIn(words, err)
        _, err = self.call("check", self.scene(CYCLIC), "--set", "Probes.p.point={0.013, 0.017}", "--set", "Probes.p.outputs={slip}", expect=1)
        self.assertIn("is on no fracture", err)


if __name__ == "__main__":
    main()
