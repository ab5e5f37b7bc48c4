"""Models from Python on any number of ranks: model_test.py ROOT

The scene is that of apps/hosts/time_loop.cpp: a block of 1 m with a joint, compressed until t = 1, then sheared."""
import gc
import json
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import sprekk
from mpi4py import MPI

ROOT = Path(sys.argv[1])
COMM = MPI.COMM_WORLD
E, K_T, MU, COMPRESSION = 10e9, 30e9, 0.6, 1e-3  # Pa, Pa/m, -, m
COMPLIANCE = 2 / E + 1 / K_T  # of block and joint in series, m/Pa

BLOCK = {
    "Mesh": {"cell": "quadrilateral", "lower corner": [0, 0], "upper corner": [1, 1], "cells": [4, 4], "periodic": ["x"],
             "fractures": {"joint": {"lower corner": [0, 0.5], "upper corner": [1, 0.5]}}},
    "Materials": {"rock": {"type": "elastic", "Young's modulus": "10 GPa", "Poisson's ratio": 0},
                  "smooth": {"type": "joint", "tangential stiffness": "30 GPa/m", "friction coefficient": MU}},
    "Bulk": {"material": "rock"},
    "Fractures": {"joint": {"material": "smooth"}},
    "Boundary conditions": {"floor": {"boundary": "south", "displacement": [0, 0]},
                            "top": {"boundary": "north", "displacement": ["1e-3*max(t - 1, 0)", "-1e-3*min(t, 1)"]}},
    "Time": {"end": 2, "steps": 4},
}


def largest(values):
    return COMM.allreduce(float(np.max(np.abs(values), initial=0)), MPI.MAX)


class Block(unittest.TestCase):
    def setUp(self):
        self.model = sprekk.Model(sprekk.Scene(BLOCK))

    def below(self, tau):
        """Returns the error of the displacement below the joint, with the solution u = (tau y/G, -compression y)."""
        n = self.model.mesh.n_owned_nodes
        x, u = self.model.mesh.coordinates[:n], np.asarray(self.model.field("displacement"))
        low = x[:, 1] < 0.5
        exact = np.stack([tau * x[:, 1] / (E / 2), -COMPRESSION * x[:, 1]], axis=1)
        return largest((u - exact)[low])

    def test_time_loop_of_its_own(self):
        """Compares with a solution by hand, as in the C++ host: slip onset, a prescribed slip, and a weaker joint."""
        model = self.model
        model.step(1)
        dt = 1.0
        while dt > 1e-3:
            before = model.save()
            model.step(model.time + dt)
            if largest(model.output("slip")) > 1e-12:
                model.restore(before)
            dt /= 2
        onset = 1 + 1e3 * MU * E * COMPRESSION * COMPLIANCE
        self.assertLessEqual(model.time, onset)
        self.assertLess(onset, model.time + 2e-3)
        given = 2e-4
        model.field("elastic-plastic jump: plastic jump")[:] = given
        model.step(model.time + 0.01)
        self.assertLess(self.below((1e-3 * (model.time - 1) - given) / COMPLIANCE), 1e-14)
        model.change({"Materials.smooth.friction coefficient": MU / 6})
        model.step(model.time + 0.01)
        self.assertLess(self.below(MU / 6 * E * COMPRESSION), 1e-14)

    def test_fields_are_the_memory_of_the_model(self):
        one, two = self.model.field("displacement"), self.model.field("displacement")
        if one.size:
            self.assertTrue(np.shares_memory(one, two))
        self.model.step(1)
        self.assertGreater(largest(one), 0)  # updated without a new call of field()
        np.testing.assert_array_equal(np.asarray(one), np.asarray(two))
        self.assertIs(type(one + 1), np.ndarray)
        self.assertAlmostEqual(COMM.allreduce(float(np.min(one, initial=0)), MPI.MIN), -COMPRESSION)

    def test_arrays_outlive_models(self):
        self.model.step(1)
        u, slip = self.model.field("displacement"), self.model.output("slip")
        known, known_slip = np.array(u), np.array(slip)
        del self.model
        gc.collect()
        trash = [np.full(1000, np.nan) for _ in range(100)]
        np.testing.assert_array_equal(np.asarray(u), known)
        np.testing.assert_array_equal(slip, known_slip)
        del trash

    def test_fields_of_equations_that_are_gone(self):
        self.model.step(1)
        u = self.model.field("displacement")
        part = u[:1]
        self.model.change({"Materials.smooth.friction coefficient": 0.1})
        for use in (lambda: u[0], lambda: u + 1, lambda: np.sum(u), lambda: u.__setitem__(0, 1), lambda: np.max(part),
                    lambda: list(u)):
            self.assertRaises(sprekk.StaleField, use)
        again = self.model.field("displacement")
        again[:]
        self.model.close()
        self.assertRaises(sprekk.StaleField, lambda: again[:])
        with self.assertRaisesRegex(sprekk.Error, "closed"):
            self.model.step(2)

    def test_krylov_methods(self):
        """The methods that Trilinos registers are available in the module."""
        model = sprekk.Model(sprekk.Scene(BLOCK, {"Solver.Linear solver.type": "iterative"}))
        self.model.step(1)
        model.step(1)
        self.assertLess(largest(model.field("displacement") - self.model.field("displacement")), 1e-12)

    def test_take_back_and_restore(self):
        self.model.step(1)
        self.model.step(1.5)
        u = self.model.field("displacement").copy()
        self.model.take_back()
        self.assertEqual(self.model.time, 1)
        self.model.step(1.5)
        self.assertLess(largest(self.model.field("displacement") - u), 1e-15)
        with self.assertRaisesRegex(sprekk.Error, "no step to take back"):
            self.model.take_back()
            self.model.take_back()

    def test_checkpoint_on_disk(self):
        self.model.step(1)
        u = self.model.gather("displacement")
        folder = COMM.bcast(tempfile.mkdtemp() if COMM.rank == 0 else None)
        self.model.save().write(folder)
        other = sprekk.Model(sprekk.Scene(BLOCK))
        other.restore(folder)
        self.assertEqual(other.time, 1)
        again = other.gather("displacement")
        if COMM.rank == 0:
            np.testing.assert_array_equal(u, again)
        other = sprekk.Model(sprekk.Scene(BLOCK, {"Mesh.cells": [2, 4]}))
        with self.assertRaisesRegex(sprekk.Error, "another scene"):
            other.restore(folder)

    def test_run_with_a_callback(self):
        seen = []
        table = self.model.run(lambda model, step: seen.append(model.time) or {"slip": largest(model.output("slip"))})
        self.assertEqual(seen, [0.5, 1, 1.5, 2])
        self.assertEqual(list(table["time"]), seen)
        elastic = MU * E * COMPRESSION / K_T  # elastic jump of the joint, which reduces the slip
        slid = 1e-3 - 2 / E * MU * E * COMPRESSION - elastic
        self.assertAlmostEqual(table["slip"].iloc[-1], max(slid, 0), delta=1e-12)

    def test_an_exception_on_one_rank_is_raised_on_all(self):
        def fail(model, step):
            if COMM.rank == COMM.size - 1:
                raise ZeroDivisionError("here alone")
        with self.assertRaises((ZeroDivisionError, sprekk.Error)) as raised:
            self.model.run(fail)
        self.assertIn("here alone", str(raised.exception))
        self.model.step(self.model.time + 0.1)  # all ranks still work together

    def test_what_is_wrong_is_reported(self):
        with self.assertRaisesRegex(sprekk.Error, 'there is no output "slipp"'):
            self.model.output("slipp")
        with self.assertRaisesRegex(sprekk.Error, 'there is no field "x"'):
            self.model.field("x")
        with self.assertRaisesRegex(sprekk.Error, "no step forward"):
            self.model.step(0)
        with self.assertRaisesRegex(sprekk.Error, r"scene: Sprekk > Time > \"stepz\""):
            sprekk.Scene({**BLOCK, "Time": {"stepz": 3}})
        with self.assertRaisesRegex(sprekk.Error, "a live model cannot follow this"):
            self.model.change({"Mesh.cells": [8, 8]})

    def test_not_converged(self):
        model = sprekk.Model(sprekk.Scene(ROOT / "xml/verification/cyclic_2d.xml",
                                          {"Solver.maximum iterations": 1, "Time.maximum halvings": 0}))
        with self.assertRaises(sprekk.NotConverged) as raised:
            model.run()
        self.assertFalse(raised.exception.report.converged)
        self.assertEqual(model.time, raised.exception.report.time)

    def test_gathered_is_the_same_on_any_number_of_ranks(self):
        self.model.step(1)
        alone = sprekk.Model(sprekk.Scene(BLOCK, comm=MPI.COMM_SELF), MPI.COMM_SELF)
        alone.step(1)
        mesh = self.model.gather_mesh()
        for name in ("displacement", "traction", "stress"):
            whole, here = self.model.gather(name), alone.gather(name)
            if COMM.rank == 0:
                np.testing.assert_allclose(whole, here, atol=1e-12 * np.max(np.abs(here)), err_msg=name)
        if COMM.rank == 0:
            known = alone.gather_mesh()
            for name in ("coordinates", "cells", "faces", "face_area", "face_centre", "face_frame"):
                np.testing.assert_array_equal(getattr(mesh, name), getattr(known, name), err_msg=name)
            self.assertEqual(mesh.to_meshio().points.shape, (len(mesh.coordinates), 3))
            self.assertAlmostEqual(float(np.sum(mesh.face_area)), 1)

    def test_fractures_and_reactions(self):
        self.model.step(1)
        self.model.step(1 + 1e3 * MU * E * COMPRESSION * COMPLIANCE / 2)  # the joint sticks
        table = self.model.fractures()
        self.assertEqual(list(table.index), ["joint"])
        self.assertAlmostEqual(table.loc["joint", "area"], 1)
        self.assertAlmostEqual(table.loc["joint", "fraction_stick"], 1)
        self.assertAlmostEqual(table.loc["joint", "mean_traction_local_0"], -E * COMPRESSION, delta=1e-3)
        forces = self.model.reactions()
        np.testing.assert_allclose(forces["floor"]["displacement"], [-MU * E * COMPRESSION / 2, E * COMPRESSION], rtol=1e-9)
        np.testing.assert_allclose(forces["top"]["displacement"], -forces["floor"]["displacement"], rtol=1e-9)

    def test_ranks_of_a_part(self):
        """A model on half of the ranks, while the others run a separate model."""
        half = COMM.Split(COMM.rank % 2)
        model = sprekk.Model(sprekk.Scene(BLOCK, comm=half), half)
        model.step(1)
        whole = model.gather("displacement")
        if half.rank == 0:
            self.assertAlmostEqual(np.min(whole), -COMPRESSION)

    def test_output_as_a_run(self):
        folder = COMM.bcast(tempfile.mkdtemp() if COMM.rank == 0 else None)
        self.model.run(output=folder)
        self.assertTrue((Path(folder) / "results.json").exists())
        self.assertTrue((Path(folder) / "bulk.pvd").exists())

    def test_output_after_a_change_by_the_callback(self):
        """The joint sticks, so that a change of its friction changes no result."""
        scene = BLOCK | {"Output": {"error estimate": True, "vtu": False},
                         "Probes": {"corner": {"point": [0.9, 0.9], "outputs": ["stress"]}}}
        found = []
        for friction in MU, 0.9 * MU:
            folder = Path(COMM.bcast(tempfile.mkdtemp() if COMM.rank == 0 else None))
            changes = {"Materials.smooth.friction coefficient": friction, "Boundary conditions.top.displacement": ["0", "-1e-3*t"]}
            model = sprekk.Model(sprekk.Scene(scene, changes))
            model.run(lambda model, step: model.change({"Materials.smooth.friction coefficient": MU}), output=str(folder))
            COMM.Barrier()
            steps = json.loads((folder / "results.json").read_text())["steps"]
            found.append(([step["error_estimate"]["stress"]["relative"] for step in steps],
                          [list(map(float, line.split(",")))[1:] for line in (folder / "probes" / "corner.csv").read_text().splitlines()[1:]]))
        for before, after in zip(*found):
            np.testing.assert_allclose(after, before, rtol=1e-9, atol=1e-6)


@unittest.skipIf(COMM.size == 1, "on one rank nothing differs")
class Ranks(unittest.TestCase):
    """Differences between ranks raise an Error on all ranks, without a deadlock."""

    def refuse(self, words, act):
        with self.assertRaisesRegex(sprekk.Error, words):
            act()
        self.assertEqual(COMM.allreduce(1), COMM.size)

    def test_scenes_that_differ(self):
        differs = "differs between ranks, must be the same on all: rank 0 has .*rank 1 has "
        steps = {"Time.steps": 2 + COMM.rank}
        self.refuse(differs, lambda: sprekk.Scene(BLOCK, steps))
        self.refuse(differs, lambda: sprekk.Scene(BLOCK | {"Time": {"end": 2, "steps": 2 + COMM.rank}}))
        alone = sprekk.Scene(BLOCK, steps, comm=MPI.COMM_SELF)
        self.refuse(differs + ".*steps", lambda: sprekk.Model(alone))
        self.refuse(differs, lambda: sprekk.Scene(alone.to_xml()))
        self.refuse(differs, lambda: sprekk.Model(sprekk.Scene(BLOCK), given_pressure=COMM.rank))

    def test_entries_that_are_wrong_on_one_rank(self):
        wrong = BLOCK | {"Time": {"end": 10**400 if COMM.rank == 1 else 2}}
        self.refuse("no number holds", lambda: sprekk.Scene(wrong))

    def test_changes_that_differ(self):
        model = sprekk.Model(sprekk.Scene(BLOCK))
        path = "Materials.smooth.friction coefficient"
        self.refuse("differs between ranks", lambda: model.change({path: 0.5 + 0.1 * COMM.rank}))
        self.refuse("differs between ranks", lambda: model.change(sprekk.Scene(BLOCK, {path: 0.5 + 0.1 * COMM.rank},
                                                                               comm=MPI.COMM_SELF)))
        model.change({path: 0.4})
        model.step(1)

    def test_times_that_differ(self):
        model = sprekk.Model(sprekk.Scene(BLOCK))
        self.refuse("the time of a step: differs between ranks", lambda: model.step(1 + 0.1 * COMM.rank))
        model.step(1)

    def test_a_second_thread_is_refused(self):
        sprekk.Model(sprekk.Scene(BLOCK))
        found = []

        def work():
            try:
                sprekk.Model(sprekk.Scene(BLOCK))
            except sprekk.Error as error:
                found.append(str(error))
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        self.assertIn("is used by a second thread", found[0])


class Views(unittest.TestCase):
    def test_ordinary_arrays_of_a_field_are_read_only(self):
        model = sprekk.Model(sprekk.Scene(BLOCK))
        field = model.field("displacement")
        view = np.asarray(field)
        field[0] = 1e-3
        field.T[1, :2] = 2e-3
        field[1:3][:, 0] += 1e-3
        field += 1e-4
        np.testing.assert_allclose(view[0], [1.1e-3, 2.1e-3])
        np.testing.assert_allclose(model.field("displacement")[:3, 0], [1.1e-3, 1.1e-3, 1.1e-3])
        with self.assertRaisesRegex(ValueError, "read-only"):
            view[0] = 0
        last = view.copy()
        model.change({"Materials.smooth.friction coefficient": 0.4})
        model.field("displacement")[:] = 0
        np.testing.assert_array_equal(view.shape, last.shape)
        for use in (lambda: field.T.__setitem__(0, 0), lambda: field.fill(0), lambda: field + 1):
            with self.assertRaises(sprekk.StaleField):
                use()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1 if COMM.rank == 0 else 0)
