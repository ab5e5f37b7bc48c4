"""User-defined time loops, modules, laws, and derivatives on any number of ranks: modules_test.py ROOT"""
import json
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import sprekk
from mpi4py import MPI

ROOT = Path(sys.argv[1])
COMM = MPI.COMM_WORLD
sys.path.append(str(ROOT / "apps/python/examples"))

import own_flow  # noqa: E402

E = 10e9  # Pa


def square(friction, **time):
    """Returns the scene of a square under inclined load, with a partly sliding fracture inside."""
    return sprekk.Scene({
        "Mesh": {"cell": "triangle", "lower corner": [0, 0], "upper corner": [1, 1], "cells": [8, 8],
                 "fractures": {"fracture": {"lower corner": [0.25, 0.5], "upper corner": [0.75, 0.5]}}},
        "Materials": {"rock": {"type": "elastic", "Young's modulus": E, "Poisson's ratio": 0.2},
                      "joint": {"type": "joint", "friction coefficient": friction, "tangential stiffness": 50e9}},
        "Bulk": {"material": "rock"}, "Fractures": {"fracture": {"material": "joint"}},
        "Boundary conditions": {"floor": {"boundary": "south", "displacement": [0, 0]},
                                "top": {"boundary": "north", "traction": [4e6, -1e7]}},
        "Time": {"end": 2, "steps": 2, **time}})


class Viscous(sprekk.FaceLaw):
    """Linear viscous shear traction, with the viscosity in Pa s/m."""
    name = "viscous joint"

    def __init__(self, viscosity):
        self.viscosity = viscosity

    def shear(self, w, traction, state):
        return self.viscosity * state.rate * (w - state.histories["jump"])[:, 1:]


class Failing(sprekk.Module):
    name = "failing"

    def blocks(self, mesh):
        return [sprekk.Block("cells", ["displacement"], ["displacement"], self.residual)]

    def residual(self, x, state):
        if state.t > 1 and COMM.rank == COMM.size - 1:
            raise ZeroDivisionError("here alone")
        return {}


class Flow(unittest.TestCase):
    def test_given_pressures(self):
        """Pressures of Sprekk's own flow cause the same displacements and jumps, and the injected fluid is stored."""
        own = sprekk.Model(own_flow.block(8, flow=True), COMM)
        given = sprekk.Model(own_flow.block(8, flow=False), COMM, given_pressure=0)
        own.step(own_flow.DT)
        p = own.output("pressure").ravel()
        given.set_fluid_pressure(p, own.output("fracture pressure").ravel())
        given.step(own_flow.DT)
        for name in ("displacement", "jump"):
            self.assertLess(own_flow.distance(given.output(name), own.output(name)), 1e-8)
        area = given.mesh.face_area
        stored = np.sum(own_flow.STORAGE / 8**2 * p + given.output("gained pore volume").ravel())
        stored += np.sum(area * given.output("widening").ravel())
        injected = own_flow.INJECTION * own_flow.DT**2 * COMM.allreduce(float(np.sum(area)))
        self.assertAlmostEqual(COMM.allreduce(float(stored)) / injected, 1, delta=1e-6)

    def test_flow_of_a_host_in_one_jacobian(self):
        self.assertTrue(own_flow.main(8, 2))  # within 1e-8 of Sprekk's own flow

    def test_jacobian_of_the_flow(self):
        model = own_flow.together(4)
        model.step(own_flow.DT)
        model.step(2 * own_flow.DT)
        errors = model.check_jacobian()
        own = errors[(errors["module"] == "own flow")]
        self.assertGreater(len(own), 3)
        self.assertLess(own["error"].max(), 1e-6)


class Laws(unittest.TestCase):
    def test_viscous_joint_beside_rock_by_hand(self):
        """Solution for a block with top displacement d: tau (2(1 + nu)/E + dt/viscosity) = d - previous jump."""
        viscosity, nu, dt = 1e12, 0.2, 0.5
        entries = square(0, steps=4).entries
        scene = sprekk.Scene(entries | {"Mesh": entries["Mesh"] | {
            "periodic": ["x"], "fractures": {"fracture": {"lower corner": [0, 0.5], "upper corner": [1, 0.5]}}},
            "Boundary conditions": {"floor": {"boundary": "south", "displacement": [0, 0]},
                                    "top": {"boundary": "north", "displacement": ["1e-3*t", -1e-3]}}})
        model = sprekk.Model(scene, modules=[Viscous(viscosity)])
        jump = 0
        for t in scene.times:
            model.step(t)
            tau = (1e-3 * t - jump) / (2 * (1 + nu) / E + dt / viscosity)
            jump += tau * dt / viscosity
            np.testing.assert_allclose(np.asarray(model.field("own shear")), tau, rtol=1e-9)
            np.testing.assert_allclose(np.asarray(model.output("jump local"))[:, 1], jump, rtol=1e-9)

    def test_same_on_any_number_of_ranks(self):
        together = sprekk.Model(square(0), COMM, modules=[Viscous(1e11)])
        alone = sprekk.Model(square(0), MPI.COMM_SELF, modules=[Viscous(1e11)])
        for model in (together, alone):
            model.run()
        for name in ("displacement", "own shear"):
            whole, known = together.gather(name), alone.gather(name)
            if COMM.rank == 0:
                np.testing.assert_allclose(whole, known, atol=1e-9 * np.max(np.abs(known)), err_msg=name)

    def test_outputs_have_what_a_law_bears(self):
        """results.json, fracture files, tables and outputs contain the shear traction of a FaceLaw."""
        model = sprekk.Model(square(0), modules=[Viscous(1e11)])
        with tempfile.TemporaryDirectory() as scratch:
            folder = COMM.bcast(scratch)
            model.run(output=folder)
            results = json.loads((Path(folder) / "results.json").read_text())
            files = sorted(Path(folder).glob("fractures*/*.vtu")) or sorted(Path(folder).rglob("fractures*.vtu"))
            with_it = [b'Name="own shear"' in file.read_bytes() for file in files]
            COMM.barrier()
        shear, mesh = np.asarray(model.field("own shear"))[:, 0], model.mesh
        area = mesh.face_area[:len(shear)]
        mean = COMM.allreduce(float(shear @ area)) / COMM.allreduce(float(np.sum(area)))
        self.assertGreater(abs(mean), 1e5)
        np.testing.assert_array_equal(model.output("own shear"), shear)
        self.assertEqual(model.units()["own shear"], "Pa")
        self.assertTrue(with_it and all(with_it))
        reported = results["steps"][-1]["fractures"]["fracture"]["mean_own_shear"]
        self.assertAlmostEqual(np.ravel(reported)[0] / mean, 1, delta=1e-9)
        self.assertIn("mean_own_shear", " ".join(model.fractures().columns))

    def test_derivatives_of_a_law(self):
        model = sprekk.Model(square(0), modules=[Viscous(1e11)])
        model.step(1)
        errors = model.check_jacobian()
        self.assertLess(errors[errors["module"] == "viscous joint"]["error"].max(), 1e-6)

    def test_checkpoints_of_another_law_are_refused(self):
        one, other = Viscous(1e11), Viscous(1e11)
        other.fingerprint = "another"
        model = sprekk.Model(square(0), modules=[one])
        model.step(1)
        with self.assertRaisesRegex(sprekk.Error, "viscous joint"):
            sprekk.Model(square(0), modules=[other]).restore(model.save())

    def test_an_exception_on_one_rank_is_raised_on_all(self):
        model = sprekk.Model(square(0.3), modules=[Failing()])
        model.step(1)
        with self.assertRaisesRegex(sprekk.Error, 'module "failing": ZeroDivisionError: here alone'):
            model.step(2)
        self.assertEqual(model.time, 1)

    def test_wrong_shapes_and_names(self):
        class Wrong(Failing):
            def residual(self, x, state):
                return {"displacement": np.zeros((3, 1))}
        with self.assertRaisesRegex(sprekk.Error, r'residual of "displacement" has the shape \(3, 1\), must have'):
            sprekk.Model(square(0.3), modules=[Wrong()]).step(1)

        class Nowhere(Failing):
            def blocks(self, mesh):
                return [sprekk.Block("corners", ["displacement"], ["displacement"], self.residual)]
        with self.assertRaisesRegex(sprekk.Error, 'there is no loop "corners"'):
            sprekk.Model(square(0.3), modules=[Nowhere()])


class Derivatives(unittest.TestCase):
    def test_adjoint_against_differences_of_solves(self):
        """Derivatives by materials, loads and friction, for a fracture with sliding and sticking parts."""
        parameters = {"Materials.rock.Young's modulus": E, "Materials.joint.tangential stiffness": 50e9,
                      "Materials.joint.friction coefficient": 0.38, ("Boundary conditions.top.traction", 0): 4e6,
                      ("Boundary conditions.top.traction", 1): -1e7}
        scene = square(0.38)
        model = sprekk.Model(scene)
        value, found = sprekk.sensitivities(model, 1, self.quantity, list(parameters))
        states = np.concatenate(COMM.allgather(model.output("state").ravel()))
        self.assertEqual(set(states), {1, 2})  # stick and slip
        for parameter, number in parameters.items():
            ends = [self.after(scene, parameter, number * (1 + sign * 1e-5)) for sign in (1, -1)]
            self.assertAlmostEqual(found[parameter] / ((ends[0] - ends[1]) / (2e-5 * number)), 1, delta=1e-6, msg=parameter)
        self.assertAlmostEqual(value / self.after(scene, "Materials.rock.Young's modulus", E), 1, delta=1e-9)

    def test_adjoint_with_a_law_of_ones_own(self):
        scene, law = square(0), [Viscous(1e12)]
        model = sprekk.Model(scene, modules=law)
        model.step(1)
        _, found = sprekk.sensitivities(model, 2, self.quantity, ["Materials.rock.Young's modulus"])
        ends = []
        for sign in (1, -1):  # with the same state at the beginning of the step
            other = sprekk.Model(scene.changed({"Materials.rock.Young's modulus": E * (1 + sign * 1e-4)}), modules=law)
            first = sprekk.Model(scene, modules=law)
            first.step(1)
            for name in first.fields:
                other.field(name)[:] = first.field(name)
            other.step(1)  # same length as the second step
            ends.append(self.reported(other))
        self.assertAlmostEqual(found["Materials.rock.Young's modulus"] / ((ends[0] - ends[1]) / (2e-4 * E)), 1, delta=1e-6)

    @staticmethod
    def quantity(x):
        u, traction = x["displacement"], x["traction"]
        by_u, by_traction = np.zeros_like(u), np.zeros_like(traction)
        by_u[:, 0] = 1
        by_traction[:, 1] = 2e-16 * traction[:, 1]
        return float(np.sum(u[:, 0]) + 1e-16 * np.sum(traction[:, 1]**2)), {"displacement": by_u, "traction": by_traction}

    def after(self, scene, parameter, number):
        path, index = parameter if isinstance(parameter, tuple) else (parameter, None)
        if index is not None:
            values = [4e6, -1e7]
            values[index] = number
            number = values
        model = sprekk.Model(scene.changed({path: number}))
        model.step(1)
        return self.reported(model)

    def reported(self, model):
        whole = {name: model.gather(name, field=True) for name in ("displacement", "traction")}
        return COMM.bcast(self.quantity(whole)[0] if COMM.rank == 0 else None)

    def test_what_has_no_derivative(self):
        model = sprekk.Model(square(0.38))
        with self.assertRaisesRegex(sprekk.Error, 'no entry "Materials.rock.E"'):
            sprekk.sensitivities(model, 1, self.quantity, ["Materials.rock.E"])
        with self.assertRaisesRegex(sprekk.Error, "the quantity: KeyError"):
            sprekk.sensitivities(model, 2, lambda x: (x["pressure"], {}), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1 if COMM.rank == 0 else 0)
