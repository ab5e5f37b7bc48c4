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


if __name__ == "__main__":
    main()
