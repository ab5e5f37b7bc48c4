#!/usr/bin/env python3
"""Random scenes of perf/coupled: perf_coupled_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy or VTK.

Tests equal scenes for equal seeds, exact balances, and the detection of wrong files."""
import json
import os
import subprocess
import sys
from unittest import mock

import program
from program import ROOT, ProgramTest, main

try:
    import numpy as np
    from perf.common import program as runs
    from perf.common.scene_file import save
    from perf.coupled import balances, checks, coupled_scenes, differences
    from perf.coupled.written import Written
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

JOINT = {"type": "joint", "friction coefficient": 0.6, "initial aperture": 1e-3, "residual aperture": 1e-5, "normal stiffness": 1e10,
         "maximum closure": 5e-4, "dilation angle": 3.0}
ROCK = {"type": "elastic", "Young's modulus": 2e10, "Poisson's ratio": 0.2, "permeability": [1e-16], "porosity": 0.1,
        "compressibility of pores": 1e-11, "Biot coefficient": 0.0, "thermal conductivity": [2.0], "volumetric heat capacity": 2e6,
        "thermal expansion": 1e-5}


def doublet(cell, **entries):
    """Returns a scene with injection of cold water into a fracture, an open side, and deformable rock under stress."""
    sides = {name: {"boundary": name, "displacement": [0.0, 0.0]} for name in ("west", "east", "south", "north")}
    sides["east"] |= {"pressure": 5e6, "temperature": 350.0}
    lines = {"f": {"lower corner": [20.0, 50.0], "upper corner": [80.0, 50.0]}, "g": {"lower corner": [50.0, 30.0], "upper corner": [50.0, 70.0]}}
    tree = {"Mesh": {"cell": cell, "lower corner": [0.0, 0.0], "upper corner": [100.0, 100.0], "cells": [10, 10], "tips": "plain", "fractures": lines},
            "Materials": {"rock": dict(ROCK), "joint": dict(JOINT)}, "Bulk": {"material": "rock", "initial stress": [-2e7, -2.5e7, -2e7, 2e6]},
            "Fractures": {name: {"material": "joint"} for name in lines}, "Boundary conditions": sides,
            "Flow": {"initial pressure": 5e6, "compressibility": 4.5e-10, "Wells": {"w": {"points": [30.0, 50.0], "radius": 0.1, "rate": 1e-5}}},
            "Heat": {"initial temperature": 350.0, "fluid heat capacity": 4.2e6, "fluid thermal expansion": 5e-4,
                     "Wells": {"w": {"temperature": 320.0}}},
            "Time": {"schedule": [1e5, 2e5, 5e5]}}
    for path, value in entries.items():
        *sections, name = path.split(".")
        section = tree
        for key in sections:
            section = section.setdefault(key, {})
        section[name] = value
    return tree


class Coupled(ProgramTest):
    def ran(self, tree, name="scene", status=0):
        path = self.folder / f"{name}.xml"
        save(tree, path, "test")
        ended = runs.run(program.PROGRAM, path, self.folder / name)
        self.assertEqual(ended.status, status, ended.words)
        return Written(self.folder / name, ended.results)

    def test_a_scene_depends_on_seed_and_number_alone(self):
        drawn = [coupled_scenes.draw_scene(3, k) for k in range(60)]
        self.assertEqual(drawn[59], coupled_scenes.draw_scene(3, 59))
        self.assertNotEqual(drawn[5].tree, coupled_scenes.draw_scene(4, 5).tree)
        self.assertEqual({one.loads for one in drawn}, set(coupled_scenes.PHYSICS))

    def test_a_thousandth_of_the_loads_leads_to_no_other_state(self):
        """Joints with dilation, opened by fluid and closed in one step. In whole steps, faces at the well may be open, or
        stick with the plastic jump of the open face before the step."""
        scene, states = coupled_scenes.draw_scene(3, 3).tree, []
        for factor in (0.999, 1.0, 1.001):
            tables = {name: table | {"values": [factor * value for value in table["values"]]} for name, table in scene["Tables"].items()}
            states.append(self.ran(scene | {"Tables": tables}, f"{factor}"))
        for other in states[::2]:
            size, place = differences.largest(states[1], other, str)
            self.assertLess(size, 4e-3, place)
            self.assertGreater(size, 1e-4, place)

    def test_balances_are_exact(self):
        """Balances of fluid and energy are exact for both schemes; with a Biot coefficient only that of fluid."""
        for cell, scheme, biot, kind in (("triangle", "implicit Euler", 0.0, "constant"), ("quadrilateral", "BDF2", 0.0, "water"),
                                         ("quadrilateral", "implicit Euler", 0.8, "constant")):
            more = {"Heat.fluid": kind} | ({"Heat.fluid thermal expansion": 0.0, "Heat.reference temperature": 350.0} if kind == "water" else {})
            run = self.ran(doublet(cell, **{"Time.scheme": scheme, "Materials.rock.Biot coefficient": biot}, **more))
            lines, (fluid, energy) = checks.balances(run)
            self.assertEqual((lines, balances.Balances(run).notes), ([], []))
            self.assertLess(fluid, 1e-9, (cell, scheme))
            self.assertLess(energy, 1e-7)
            self.assertEqual([step.unknown > 0 for step in balances.Balances(run).of_energy()], [biot > 0] * 3)

    def test_heat_of_friction_is_in_balance_after_a_step_with_slip(self):
        """The joint slips in the first step only. BDF2 differentiates the work of friction as the heat; with the power of
        the present step alone, half of the first power was missing in the second step."""
        run = self.ran(coupled_scenes.draw_scene(71002, 18, attempt=1).tree)
        self.assertEqual(run.text("Time", "scheme"), "BDF2")
        steps = balances.Balances(run).of_energy()
        self.assertGreater(steps[0].scale, 1)
        for step in steps:
            self.assertLess(abs(step.surplus), 1e-8 * step.scale, step.time)

    def test_fluid_is_in_balance_at_small_differences_of_pressure(self):
        """Convergence is relative to the differences of pressure: relative to its level, flows were wrong by 1.5 %."""
        run = self.ran(coupled_scenes.draw_scene(31337, 12).tree)
        lines, (fluid, _) = checks.balances(run)
        self.assertEqual(lines, [])
        self.assertLess(fluid, 1e-6)

    def test_fluid_is_in_balance_if_round_off_hides_single_rows(self):
        """Residuals of single rows were within round-off, but their sum was 3e-6 of the largest flow."""
        lines, (fluid, _) = checks.balances(self.ran(coupled_scenes.draw_scene(90210, 133).tree))
        self.assertEqual(lines, [])
        self.assertLess(fluid, 1e-8)

    def test_fluid_is_in_balance_at_the_round_off_of_a_pressure(self):
        """Round-off of the pressure at a well in a wide fracture is 7e-7 of the largest flow. Steps for the sum of the
        balance are full: a search for smaller rows, which were round-off, left 1e-4."""
        for kernels in ({}, {"OPENBLAS_CORETYPE": "Nehalem"}):  # of OpenBLAS; other libraries ignore it
            with mock.patch.dict(os.environ, kernels):
                lines, (fluid, _) = checks.balances(self.ran(coupled_scenes.draw_scene(31337, 66).tree))
            self.assertEqual(lines, [])
            self.assertLess(fluid, 1e-6, kernels)

    def test_results_do_not_depend_on_the_number_of_ranks(self):
        """27: a wide fracture that opens at a side carries the flow. Sums of balances up to 1e-7 of the flows differed. 21: no load
        deforms the rock under its initial stress. Displacements are round-off of this stress."""
        for seed, number in ((4712, 27), (73102, 21)):
            path = self.folder / "scene.xml"
            save(coupled_scenes.draw_scene(seed, number).tree, path, "test")
            ended = [runs.run(program.PROGRAM, path, self.folder / str(ranks), ranks=ranks) for ranks in (1, 2)]
            self.assertEqual([run.status for run in ended], [0, 0])
            one, two = (Written(self.folder / str(ranks), run.results) for ranks, run in zip((1, 2), ended))
            self.assertLess(differences.largest(one, two)[0], 1e-8)

    def test_fluid_holds_blocks_between_open_fractures(self):
        """Blocks between fractures opened by fluid: these motions are not free, since the fluid must flow past the blocks.
        With rigid motions in equilibrium with given pressures, a step took more than 2000 iterations."""
        run = self.ran(coupled_scenes.draw_scene(31337, 90).tree)
        steps = run.results["steps"]
        self.assertEqual(sum(step["cuts"] for step in steps), 0)
        self.assertLessEqual(max(step["newton_iterations"] for step in steps), 12)
        self.assertEqual(checks.balances(run)[0] + checks.contact(run)[0], [])

    def test_energy_is_in_balance_in_undrained_steps(self):
        """Pressure and temperature change at a side in short steps, with negligible Darcy flow."""
        for cell, scheme in (("triangle", "implicit Euler"), ("quadrilateral", "BDF2")):
            tree = doublet(cell, **{"Materials.rock.Biot coefficient": 0.8, "Time.schedule": [100.0, 200.0, 300.0], "Time.scheme": scheme})
            tree["Boundary conditions"]["east"] |= {"pressure": 6e6, "temperature": 320.0}
            steps = balances.Balances(self.ran(tree)).of_energy()
            self.assertEqual(len(steps), 3)
            for step in steps:
                self.assertLess(abs(step.surplus), 1e-7 * step.scale, f"{cell}, t = {step.time}")

    def test_what_is_wrong_is_seen(self):
        run = self.ran(doublet("quadrilateral"))
        log = (self.folder / "scene/log.txt").read_text()
        self.assertEqual(checks.temperatures(run, log)[0] + checks.apertures(run) + checks.finite(run) + checks.contact(run)[0], [])
        last = run.states[-1]
        for change, check, words in (
                (lambda: run.results["steps"][2]["wells"]["w"].update(rate=1.00001e-5), checks.balances, "balance of fluid: .* at t = 500000"),
                (lambda: run.results["steps"][2]["wells"]["w"].update(heat=run.results["steps"][2]["wells"]["w"]["heat"] * 1.00001),
                 checks.balances, "balance of energy: .* at t = 500000"),
                (lambda: add(last.fractures, "fracture temperature", 20.0), lambda r: checks.temperatures(r, log), "beyond the given temperatures"),
                (lambda: add(last.fractures, "aperture", -1.0), lambda r: (checks.apertures(r),), '"aperture" is -'),
                (lambda: add(last.bulk, "stress", np.nan), lambda r: (checks.finite(r),), '"stress" at t = 500000')):
            run = self.again(run)
            last = run.states[-1]
            change()
            self.assertRegex("\n".join(check(run)[0]), words)
        run = self.again(run)
        add(run.states[-1].fractures, "fracture temperature", 20.0)
        self.assertEqual(checks.temperatures(run, "warning: scene.xml: temperatures are more than 10 K beyond the given ones, 300 to 310 K")[0], [])

    def again(self, run):
        """Returns the run as read from its files."""
        return Written(run.directory, json.loads((run.directory / "results.json").read_text()))

    def test_differences(self):
        """Renamed fractures and other numbers of ranks agree. A relative change of 1e-7 is detected."""
        one = self.ran(doublet("triangle"))
        tree = doublet("triangle")
        for path in ("Mesh.fractures", "Fractures"):
            section = tree["Mesh"]["fractures"] if path == "Mesh.fractures" else tree["Fractures"]
            section["a"], section["b"] = section.pop("g"), section.pop("f")
        other = self.ran(tree, "renamed")
        back = {"a": "g", "b": "f"}
        size, what = differences.largest(one, other, lambda name: back.get(name, name))
        self.assertLess(size, 1e-8, what)
        same = self.again(one)
        self.assertEqual(differences.largest(one, same)[0], 0)
        add(same.states[1].bulk, "pressure", 1e-7 * np.abs(same.states[1].bulk.cell_data["pressure"] - 5e6).max())
        size, what = differences.largest(one, same)
        self.assertGreater(size, 1e-8)
        self.assertIn('"pressure" at t = 200000', what)
        same = self.again(one)
        displacement = same.states[1].bulk.point_data["displacement"]
        displacement[3, 0] += 1e-7 * differences.Scales(one).of("displacement")
        size, what = differences.largest(one, same)
        self.assertGreater(size, 1e-8)
        self.assertIn('"displacement" at t = 200000', what)

    def test_sizes_and_boundaries_of_cells(self):
        """For each cell type: volume of the box, and the volume swept by an extension."""
        for cell, dim in (("triangle", 2), ("quadrilateral", 2), ("tetrahedron", 3), ("hexahedron", 3)):
            for order in (1, 2):
                mesh = {"cell": cell, "lower corner": [0.0] * dim, "upper corner": [2.0, 1.0, 3.0][:dim], "cells": [2, 3, 2][:dim], "order": order}
                sides = {side: {"boundary": side, "displacement": [f"1e-3*{'xyz'[i]}" for i in range(dim)]}
                         for side in ("west", "east", "south", "north", "bottom", "top")[:2 * dim]}
                run = self.ran({"Mesh": mesh, "Materials": {"rock": {"type": "elastic", "Young's modulus": 1.0, "Poisson's ratio": 0.2}},
                                "Bulk": {"material": "rock"}, "Boundary conditions": sides}, "box")
                volume = 2.0 if dim == 2 else 6.0
                self.assertAlmostEqual(run.states[0].bulk.sizes.sum(), volume)
                swept = run.faces.swept(run.states[0].bulk.point_data["displacement"])
                self.assertAlmostEqual(swept[run.faces.outer].sum() / volume, 1e-3 * dim)
                self.assertAlmostEqual(swept.sum() / volume, 1e-3 * dim)

    def test_scenes_that_fail_are_saved(self):
        broken = self.folder / "broken"
        broken.write_text("#!/bin/sh\necho no good; exit 5\n")
        broken.chmod(0o755)
        name = coupled_scenes.draw_scene(7, 3).name
        command = [sys.executable, "-B", ROOT / "perf", "coupled", "--random", "12", "--seed", "7", "--only", name,
                   "--binary", broken, "--output", self.folder / "out"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=program.TIME_LIMIT)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertEqual(done.stdout.splitlines()[-1], "failures=1 hangs=0 violations=0 rank_differences=0 newton_median=nan newton_p90=nan")
        self.assertIn(f'again: ./sprekk perf coupled --random 12 --seed 7 --only "{name}"', done.stdout)
        saved, = (self.folder / "out/failures").iterdir()
        self.assertIn("status 5: no good", saved.read_text().splitlines()[0])


def add(grid, name, value):
    grid.cell_data[name] = grid.cell_data[name] + value


if __name__ == "__main__":
    main()
