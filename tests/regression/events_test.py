#!/usr/bin/env python3
"""Slip events of a block with known slip, and files of previous runs: events_test.py PROGRAM ROOT MPIEXEC"""

import csv
import math

from program import ROOT, ProgramTest, main

G, COMPRESSION = 3e10, 0.1  # shear modulus, Pa; shortening of the height 1 m, with Lame's first parameter G
TOP = (0, 0.2, 0.5, 0.8, 0.8, 0.6, 0.1, 0.1)  # displacement of the top at t = 0, 1, ..., m
SLIP = (0, 0, 0.23, 0.53, 0.53, 0.53, 0.37, 0.37)  # m
HOURS = [3600.0 * t for t in range(8)]
EVENTS = [(1, 3, 0.53), (5, 6, 0.16)]  # start and end, h; absolute change of slip


def elastic_limit():
    """Returns the top displacement at the first slip: friction bound times compliance of block and joint."""
    bound = 0.6 * 3 * G * COMPRESSION
    return bound * (1 / G + 1 / (2 * G))


class Events(ProgramTest):
    def block(self, dim):
        """Returns a block with a fracture of 1 m or 1 m^2, and the settings of the load."""
        kinds = ("dilation angle", "initial gap", "maximum closure", "normal stiffness")
        lines = (ROOT / f"xml/contact/block_{dim}d.xml").read_text().splitlines()
        path = self.folder / f"block_{dim}d.xml"
        path.write_text("\n".join(line for line in lines if not any(kind in line for kind in kinds)))
        tables = {"tangential": TOP, "normal": [-COMPRESSION] * len(TOP)}
        loads = [f"Tables.{name}.{key}={{{', '.join(map(str, values))}}}" for name, table in tables.items()
                 for key, values in (("arguments", HOURS), ("values", table))]
        rock = [f"Materials.rock.shear modulus={G}", f"Materials.rock.Lame's first parameter={G}",
                f"Materials.joint.tangential stiffness={2 * G}"]
        return str(path), *loads, *rock, "Output.time unit=h", "Output.checkpoints.steps=1"

    def to(self, hours):
        return f"Time.schedule={{{', '.join(map(str, HOURS[1 : hours + 1]))}}}"

    def rows(self, output="out"):
        return list(csv.DictReader((self.folder / output / "events.csv").read_text().splitlines()))

    def expect_events(self, rows, expected, dim):
        unit, total = "N*m" if dim == 3 else "N", 0
        self.assertEqual(len(rows), len(expected))
        for row, (start, end, slip) in zip(rows, expected):
            total += G * slip
            self.assertEqual((row["fracture"], row["start [h]"], row["end [h]"]), ("fracture", str(start), str(end)))
            self.assertAlmostEqual(float(row["slip [m]"]), slip, delta=1e-9)
            self.assertAlmostEqual(float(row[f"moment [{unit}]"]), G * slip, delta=1e-9 * G)
            self.assertAlmostEqual(float(row["magnitude [-]"]), 2 / 3 * (math.log10(G * slip) - 9.1), 8)
            self.assertAlmostEqual(float(row[f"cumulated_moment [{unit}]"]), total, delta=1e-9 * G)

    def test_known_slip(self):
        """Events, and past slip of each step, are those of the load, also after restarts during and after an event.

        The friction bound is constant. The block rests at the end of both events and sticks at 5 h."""
        self.assertAlmostEqual(elastic_limit(), 0.27, 12)
        for dim in (2, 3):
            scene = self.block(dim)
            for ranks in (1, 2):
                with self.subTest(dim=dim, ranks=ranks):
                    whole, parts = f"whole_{dim}_{ranks}", f"parts_{dim}_{ranks}"
                    steps = self.run_scene(*scene, self.to(7), ranks=ranks, output=whole)["steps"]
                    self.expect_events(self.rows(whole), EVENTS, dim)
                    lists = [step["single_fractures"] for step in steps]
                    for one, slip in zip(lists, SLIP[1:], strict=True):
                        self.assertAlmostEqual(one["mean_slip"][0], slip, delta=1e-9)
                    self.assertEqual([one["fraction_has_slipped"][0] for one in lists], [0, 1, 1, 1, 1, 1, 1])
                    self.assertEqual((lists[0]["fraction_stick"], lists[4]["fraction_stick"]), ([1], [1]))
                    self.run_scene(*scene, self.to(2), ranks=ranks, output=parts)
                    self.expect_events(self.rows(parts), [(1, 2, 0.23)], dim)
                    for last in (5, 7):
                        sets = [word for text in (*scene[1:], self.to(last)) for word in ("--set", text)]
                        self.call("run", scene[0], "--output", parts, "--restart", *sets, ranks=ranks)
                    same = [(self.folder / folder / "events.csv").read_text() for folder in (whole, parts)]
                    self.assertEqual(*same)
                    self.assertEqual(self.results(parts)["steps"][4:], steps[4:])

    def test_files_of_a_previous_run(self):
        """A run of another scene removes the tables and lists of fractures; a restart without fields keeps the lists."""
        lists = ["bulk.pvd", "events.csv", "fractures.csv", "fractures.pvd"]
        scene = self.block(2)

        def written():
            return sorted(path.name for path in (self.folder / "out").iterdir() if path.name in lists)

        self.run_scene(*scene, self.to(2))
        self.assertEqual(written(), lists)
        sets = [word for text in (*scene[1:], self.to(3), "Output.vtu=false") for word in ("--set", text)]
        self.call("run", scene[0], "--output", "out", "--restart", *sets)
        self.assertEqual(written(), lists)
        self.run_scene("flow/source_2d.xml", "Mesh.cells={4, 4}")
        self.assertEqual(written(), ["bulk.pvd"])
        self.run_scene(*scene, self.to(1), "Output.vtu=false")
        self.assertEqual(written(), ["events.csv", "fractures.csv"])


class Catalogue(ProgramTest):
    """Events by slip rate. The shear traction falls by the shear modulus G times the slip, per height of 1 m."""

    SCENE, TIMES = "verification/events_2d.xml", (10, 10.5, 11, 20, 21, 22, 30)

    def rows(self, output="out"):
        return list(csv.DictReader((self.folder / output / "events.csv").read_text().splitlines()))

    def to(self, n):
        return f"Time.schedule={{{', '.join(map(str, self.TIMES[:n]))}}}"

    def expect(self, row, **wanted):
        titles = {title.partition(" [")[0]: title for title in row}
        for name, value in wanted.items():
            self.assertAlmostEqual(float(row[titles[name]]), value, delta=1e-9 * max(1, abs(value)), msg=name)

    def expect_two_events(self, rows):
        self.assertEqual([row["fracture"] for row in rows], ["fracture"] * 2)
        total = 0
        for k, (row, start, end, slip) in enumerate(zip(rows, (10, 20), (11, 22), (0.01, 0.03)), 1):
            total += G * slip
            self.expect(row, start=start, end=end, slip=slip, moment=G * slip, cumulated_moment=total, event=k, y=0.5,
                        magnitude=2 / 3 * (math.log10(G * slip) - 9.1), duration=end - start, max_slip=slip,
                        max_slip_rate=slip / (end - start), length=1, stress_drop=G * slip)

    def test_uniform_slip(self):
        """Two fast events with slow slip between them, also after restarts within events and on other ranks."""
        self.run_scene(self.SCENE, ranks=2)
        self.expect_two_events(self.rows())
        first = self.rows()
        self.run_scene(self.SCENE, self.to(2), "Output.checkpoints.steps=1", output="parts")
        self.expect(self.rows("parts")[0], end=10.5, slip=0.005, stress_drop=G * 0.005)
        for n, ranks in ((5, 2), (7, 1)):
            sets = [word for text in (self.to(n), "Output.checkpoints.steps=1") for word in ("--set", text)]
            self.call("run", self.scene(self.SCENE), "--output", "parts", "--restart", *sets, ranks=ranks)
        for row, same in zip(self.rows("parts"), first, strict=True):
            self.expect(row, **{title.partition(" [")[0]: float(value) for title, value in same.items() if title != "fracture"})

    def test_rupture_of_a_part(self):
        """Half of the faces slip. The hypocentre is their centre; means are over these faces."""
        self.run_scene(self.SCENE, "Fractures.fracture.prescribed slip.slip={x < 0.5 ? slip(t) : 0}")
        for row, slip in zip(self.rows(), (0.01, 0.03), strict=True):
            self.expect(row, length=0.5, x=0.25, y=0.5, slip=slip, max_slip=slip, moment=G * slip / 2)

    def test_several_fractures(self):
        """Fractures that slip in consecutive steps have a common event number. Below the threshold there is none."""
        other = ["Mesh.cells={2, 4}", "Mesh.fractures.other.lower corner={0, 0.25}",
                 "Mesh.fractures.other.upper corner={1, 0.25}", "Fractures.other.material=joint",
                 "Fractures.other.prescribed slip.slip={slip(max(t - 1, 0))}",
                 "Time.schedule={10, 10.5, 11, 12, 20, 21, 22, 23, 30}"]
        self.run_scene(self.SCENE, *other, ranks=3)
        rows = self.rows()
        self.assertEqual([row["fracture"] for row in rows], ["fracture", "other"] * 2)
        for row, number, start in zip(rows, (1, 1, 2, 2), (10, 11, 20, 21)):
            self.expect(row, event=number, start=start)
        self.run_scene(self.SCENE, "Output.events.rate=0.1")
        self.assertEqual(self.rows(), [])


if __name__ == "__main__":
    main()
