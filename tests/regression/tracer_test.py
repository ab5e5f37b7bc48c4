#!/usr/bin/env python3
"""Scenes with a tracer: tracer_test.py PROGRAM ROOT MPIEXEC"""
import csv

from program import ProgramTest, main

DOUBLET = "tracer/doublet_2d.xml"
QUIET, COARSE, SHORT = "Output.vtu=false", "Mesh.cells={20, 12}", "Time.schedule={14400, 28800, 43200, 86400, 172800, 259200}"


class Tracer(ProgramTest):
    def producer(self, *overrides, ranks=1):
        """Returns the rows of the probe at the producer, {title: value}, and the results."""
        results = self.run_scene(DOUBLET, QUIET, COARSE, "Solver.tolerance=1e-12", SHORT, *overrides, ranks=ranks)
        with open(self.folder / "out/probes/producer.csv") as file:
            return list(csv.DictReader(file)), results

    def test_probe_records_the_breakthrough(self):
        rows, results = self.producer()
        title = next(title for title in rows[0] if title.startswith("concentration"))
        values = [float(row[title]) for row in rows][-6:]
        self.assertGreater(max(values), 1.2 * values[-1])
        self.assertGreater(values[-1], 0)
        t = mass = 0
        for step in results["steps"]:
            wells = step["wells"]
            mass += (step["time"] - t) * (wells["injector"]["tracer"] + wells["producer"]["tracer"] - step["tracer"]["decay"])
            t = step["time"]
        left = results["steps"][-1]["tracer"]
        self.assertAlmostEqual((left["in rock"] + left["in fractures"]) / mass, 1, delta=1e-8)
        for ranks in (2, 3):
            for row, other in zip(rows, self.producer(ranks=ranks)[0]):
                self.assertAlmostEqual(float(row[title]), float(other[title]), delta=1e-8 * max(values))

    def test_injection_may_change_in_a_stage(self):
        rows, _ = self.producer()
        staged, _ = self.producer("Tracer.Wells.injector.concentration=1", "Stages.flush.time=43200",
                                  "Stages.flush.Tracer.Wells.injector.concentration=0")
        for row, other in zip(rows, staged):
            for title, value in row.items():
                if title.startswith("concentration"):
                    self.assertAlmostEqual(float(value), float(other[title]), delta=1e-9)

    def test_entries_that_do_not_fit(self):
        for overrides, message in (
                (("Materials.granite.porosity=0",), '"porosity": missing or 0'),
                (("Materials.granite.retardation factor=0.5",), "must be at least 1"),
                (("Flow.rigid rock=false",), '"Flow > rigid rock"'),
                (("Materials.joint.normal permeability=1e-15",), '"normal permeability" of "joint"'),
                (("Tracer.Wells.other.concentration=1",), "other")):
            sets = [word for override in overrides for word in ("--set", override)]
            self.assertIn(message, self.call("check", self.scene(DOUBLET), *sets, expect=1)[1])


if __name__ == "__main__":
    main()
