#!/usr/bin/env python3
"""Measurement perf/verification: perf_verification_test.py PROGRAM ROOT MPIEXEC. Status 77 without NumPy, VTK or SymPy.

The exact solutions satisfy the equations. The scenes prescribe them. The computed errors are correct."""
import subprocess
import sys

import program
from program import ROOT, ProgramTest, main

try:
    import numpy as np
    from perf.verification import cases, exact, flow_exact, flow_measure, heat_exact, manufactured, measure, poro_exact, scenes
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

STEP = 1e-4
REGIMES = ("stick", "slip", "mixed", "uniform")


def stress(known, points, lam, G, h=STEP):
    """Returns the stress [point, i, j] of a displacement, by central differences."""
    d = points.shape[1]
    gradient = np.stack([(known.displacement(points + h * e)[:, :d] - known.displacement(points - h * e)[:, :d]) / (2 * h)
                         for e in np.eye(d)], axis=2)
    return G * (gradient + gradient.transpose(0, 2, 1)) + lam * np.trace(gradient, axis1=1, axis2=2)[:, None, None] * np.eye(d)


def force(known, points, lam, G, h=1e-3):
    """Returns -div of the stress."""
    return -sum((stress(known, points + h * e, lam, G) - stress(known, points - h * e, lam, G))[:, :, k] / (2 * h)
                for k, e in enumerate(np.eye(points.shape[1])))


class Exact(ProgramTest):
    def test_cracks_are_in_equilibrium_and_jump_as_stated(self):
        random = np.random.default_rng(1)
        for known, d in ((exact.Crack(1, 0.7, 1.3, 0.25), 2), (exact.Crack(2, 0.7, 1.3, 0.25, 20, (-1, 0, 0)), 2),
                         (exact.Penny(0.7, 1.3, 0.25), 3)):
            points = random.uniform(1.2, 2, (20, d)) * random.choice([-1, 1], (20, d))
            lam = exact.lame(1.3, 0.25)
            self.assertLess(np.abs(force(known, points, lam, 1.3)).max(), 2e-5)
        for mode in (1, 2):
            known = exact.Crack(mode, 0.7, 1.3, 0.25, 20)
            ends = np.array([[-0.4, 0.9], [0.3, 1.0], [-1.0, 1.0]])
            along = ends[:, 0, None] + (np.arange(4000) + 0.5) / 4000 * (ends[:, 1] - ends[:, 0])[:, None]
            on = along[:, :, None] * known.tangent
            jumps = [(known.displacement(x + 1e-12 * known.normal) - known.displacement(x - 1e-12 * known.normal)).mean(axis=0) for x in on]
            self.assertTrue(np.allclose(jumps, known.jump_mean(ends[:, :, None] * known.tangent), rtol=1e-4, atol=1e-6))
        known = exact.Penny(0.7, 1.3, 0.25)
        flat = np.array([[0.3, 0.2, 0.0], [0.1, -0.8, 0.0]])
        up = np.array([0, 0, 1e-12])
        self.assertTrue(np.allclose(known.displacement(flat + up) - known.displacement(flat - up), known.jump(flat), atol=1e-10))

    def test_manufactured_tractions_are_those_of_the_stress(self):
        for d in (2, 3):
            for regime in REGIMES:
                known = exact.Manufactured(d, regime)
                on = np.random.default_rng(2).uniform(0.1, 0.9, (20, d))
                on[:, -1] = 0.5
                for side in (-1, 1):
                    normal = stress(known, on + side * 2 * STEP * np.eye(d)[-1], 1, 1)[:, :, -1]
                    computed = known.traction(on)
                    self.assertLess(np.abs(normal[:, -1] - computed[:, 0]).max(), 2e-3)
                    self.assertLess(np.abs(normal[:, :-1] - computed[:, 1:]).max(), 2e-3)

    def test_wavy_pressure_carries_the_load(self):
        known = exact.Wavy(0.4, 1, 0.25)
        zero, half = np.array([0.0]), np.array([0.5])
        self.assertAlmostEqual(known.pressure_mean(zero, half)[0], 0.4 * known.full, places=12)
        inside = known.opening_mean(np.array([0.1]), np.array([0.1001]))[0]
        self.assertAlmostEqual(inside, -0.01 * (1 - np.cos(2 * np.pi * 0.10005)), places=7)


    def test_flow_is_in_balance_in_rock_and_fractures(self):
        random, h = np.random.default_rng(3), 1e-4
        for known in (flow_exact.Conductor(10), flow_exact.Barrier(0.7), *(flow_exact.Manufactured(d, resists) for d in (2, 3) for resists in (0, 1))):
            made = isinstance(known, flow_exact.Manufactured)
            d, kappa, height = (known.dimension, known.kappa, 0.5) if made else (2, 1, 0)
            rock, on = random.uniform(0.6, 0.9, (20, d)), random.uniform(0.1, 0.9, (20, d))
            on[:, -1] = height
            darcy = np.stack([-kappa * (known.pressure(rock + h * e) - known.pressure(rock - h * e)) / (2 * h) for e in np.eye(d)], axis=1)
            self.assertLess(np.abs(darcy - known.velocity(rock)).max(), 1e-6)
            up, along = np.eye(d)[-1], np.eye(d)[0]
            below, above = ((known.velocity(on + side * 1e-10 * up) @ up, known.pressure(on + side * 1e-10 * up)) for side in (-1, 1))
            if made:
                f, gm, gp, T, C = known.on(on.T[:-1])
                self.assertTrue(np.allclose([below[0], -above[0]], [gm, gp]))
                self.assertTrue(np.allclose([below[1] - f, above[1] - f], [known.resists * gm / C, known.resists * gp / C]))
                slope = (known.pressure_in(on + h * along) - known.pressure_in(on - h * along)) / (2 * h)
                self.assertTrue(np.allclose(known.flow_in(on)[:, 0], -T * slope, atol=1e-6))
            elif isinstance(known, flow_exact.Barrier):
                self.assertTrue(np.allclose([below[0], above[0], -0.7 / np.sqrt(1 - on[:, 0]**2) * (above[1] - below[1])], known.leakage))
            else:
                spread = (known.flow_in(on + h * along) - known.flow_in(on - h * along))[:, 0] / (2 * h)
                self.assertTrue(np.allclose(spread, below[0] - above[0], atol=1e-5))
                self.assertTrue(np.allclose(known.pressure_in(on), above[1], atol=1e-6))

    def test_consolidation_conserves_fluid_and_bears_its_load(self):
        column, plate = poro_exact.COLUMN, poro_exact.PLATE
        z, h = np.linspace(0.1, 0.9, 9), 1e-3
        for T in (0.05, 0.4):
            t, rock = T / column.rock.c, column.rock
            rate = (column.pressure(z, t * (1 + h)) - column.pressure(z, t * (1 - h))) / (2 * h * t)
            curved = (column.pressure(z + h, t) - 2 * column.pressure(z, t) + column.pressure(z - h, t)) / h**2
            self.assertTrue(np.allclose(rate, rock.c * curved, atol=1e-4 * np.abs(rate).max()))
            mean = np.mean(column.pressure((np.arange(1000) + 0.5) / 1000, t))
            self.assertAlmostEqual(column.settlement(t) * rock.M / column.H, column.sigma - rock.alpha * mean, delta=1e-3 * column.sigma)
        self.assertAlmostEqual(column.pressure(np.array([0.5]), 1e-6)[0], column.undrained, places=6)
        rock, x = plate.rock, (np.arange(2000) + 0.5) / 2000 * plate.a
        for t in (50.0, 2000.0):
            def strains(at, when):  # along x, without total stress, and along y
                along_y = plate.approach(when) / plate.b
                return (rock.alpha * plate.pressure(at, when) - rock.lam * along_y) / rock.M, along_y
            along_x, along_y = strains(x, t)
            force = np.mean(rock.lam * along_x + rock.M * along_y - rock.alpha * plate.pressure(x, t)) * plate.a
            self.assertAlmostEqual(force / -plate.F, 1, delta=1e-4)
            inside, d = np.linspace(10, 90, 9), 0.1

            def content(when):
                return rock.alpha * sum(strains(inside, when)) + rock.S * plate.pressure(inside, when)
            rate = (content(t * (1 + h)) - content(t * (1 - h))) / (2 * h * t)
            curved = (plate.pressure(inside + d, t) - 2 * plate.pressure(inside, t) + plate.pressure(inside - d, t)) / d**2
            self.assertTrue(np.allclose(rate, rock.mobility * curved, atol=2e-3 * np.abs(rate).max()))


    def test_manufactured_rock_is_in_balance_with_its_fluid(self):
        functions = {name: getattr(np, name) for name in ("sin", "cos", "exp", "pi")}
        for d in (2, 3):
            known, x, h = poro_exact.Manufactured(d), np.random.default_rng(5).uniform(0.1, 0.9, (20, d)), 1e-4
            rock = {name: float(value) for name, value in manufactured.ROCK.items()}

            def slopes(function):
                """Returns the gradient [point, ..., k] at t = 1."""
                return np.stack([(function(x + h * e) - function(x - h * e)) / (2 * h) for e in np.eye(d)], axis=-1)
            u, force, p, source = manufactured.poro(d)
            at = {**functions, "t": 1, **dict(zip("xyz", x.T))}

            def of(text):
                return eval(text.replace("^", "**"), at)
            self.assertTrue(np.allclose(of(p), known.pressure(x)) and np.allclose([of(k) for k in u], known.displacement(x).T))
            self.assertTrue(np.allclose(known.velocity(x), -slopes(known.pressure), atol=1e-6))
            strain = slopes(known.displacement)
            grows = np.trace(strain, axis1=1, axis2=2)
            total = strain + strain.transpose(0, 2, 1) + (grows - rock["alpha"] * known.pressure(x))[:, None, None] * np.eye(d)
            self.assertTrue(np.allclose(total, known.stress(x), atol=1e-5))
            self.assertTrue(np.allclose([of(b) for b in force], -np.trace(slopes(known.stress), axis1=2, axis2=3).T, atol=1e-4))

            def density(y, t=1):
                return np.exp(rock["compressibility"] * t * known.pressure(y))

            def mass(t):
                """Returns the fluid mass in the pores, without the contribution of strain."""
                return (rock["porosity"] + rock["growth"] * t * known.pressure(x)) * density(x, t)
            leaves = np.trace(slopes(lambda y: density(y)[:, None] * known.velocity(y)), axis1=1, axis2=2)
            stored = (mass(1 + h) - mass(1 - h)) / (2 * h) + rock["alpha"] * grows
            self.assertTrue(np.allclose(of(source), leaves + stored, atol=1e-4))

    def test_manufactured_heat_is_in_balance(self):
        """Heat in rock and fracture is in balance at t = 0.8, by differences.

        The expressions of the scenes are correct."""
        functions, h, t = {name: getattr(np, name) for name in ("sin", "cos")}, 1e-4, 0.8
        for d, carried in ((2, 1), (3, 1), (3, 0)):
            made, known, up = manufactured.warmed(d, carried), heat_exact.Sliding(d, carried), np.eye(d)[-1]
            heat = {name: float(value) for name, value in manufactured.HEAT.items()}
            code = {name: [compile(text.replace("^", "**"), name, "eval") for text in (of if isinstance(of, list) else [of])] for name, of in made.items()}

            def of(name, x, t=t):
                values = [eval(each, {**functions, "t": t, **dict(zip("xyz", x.T))}) for each in code[name]]
                return np.stack(values, axis=1) if len(values) > 1 else values[0] + 0 * x[:, 0]

            def slopes(name, x, along=range(d)):
                return np.stack([(of(name, x + h * np.eye(d)[k]) - of(name, x - h * np.eye(d)[k])) / (2 * h) for k in along], axis=-1)

            def curved(name, x, along=range(d)):
                return sum(of(name, x + 1e-3 * np.eye(d)[k]) - 2 * of(name, x) + of(name, x - 1e-3 * np.eye(d)[k]) for k in along) / 1e-6
            x = np.random.default_rng(5).uniform(0.1, 0.4, (10, d))
            on = x * (1 - up) + 0.5 * up
            jump = of("above displacement", on) - of("below displacement", on)
            aperture = 1 + jump[:, -1]
            warms = (of("fracture temperature", on, t + h) - of("fracture temperature", on, t - h)) / (2 * h)
            gains = 0
            for side, outward in (("below", 1), ("above", -1)):
                rock, T = x + (up / 2 if side == "above" else 0), f"{side} temperature"
                for name, exact_value in ((T, known.temperature), (side, known.pressure), (f"{side} displacement", known.displacement)):
                    self.assertTrue(np.allclose(of(name, rock, 1), exact_value(rock)), name)
                stored = heat["capacity"] * (of(T, rock, t + h) - of(T, rock, t - h)) / (2 * h)
                flow = -2 * slopes(side, rock)
                right = stored + carried * (flow * slopes(T, rock)).sum(axis=1) - heat["conductivity"] * curved(T, rock)
                self.assertTrue(np.allclose(of(f"{side} heat", rock), right, atol=1e-4), side)
                excess, enters = of(T, on) - of("fracture temperature", on), -2 * outward * slopes(side, on, [d - 1])[:, 0]
                conducts = 2 * heat["in fracture"] * excess
                gains = gains + conducts + carried * np.maximum(enters, 0) * excess
                leaves = -heat["conductivity"] * outward * slopes(T, on, [d - 1])[:, 0]
                self.assertTrue(np.allclose(leaves, conducts + carried * np.maximum(-enters, 0) * excess, atol=1e-5), side)
            along = -aperture[:, None]**3 / 6 * slopes("fracture", on, range(d - 1))
            needs = (heat["of filling"] * aperture * warms + carried * (along * slopes("fracture temperature", on, range(d - 1))).sum(axis=1)
                     - heat["in fracture"] * curved("fracture temperature", on, range(d - 1)))
            N, slips = t * known.contact(on.T[:-1])[0], known.slip(on.T[:-1])
            self.assertTrue(np.allclose(gains + (known.friction - heat["dilation"]) * N * slips, needs, atol=1e-4))
            self.assertTrue(np.allclose(aperture, 1 + heat["dilation"] * t * slips))


class Scenes(ProgramTest):
    def run_case(self, make, name):
        """Runs a case on the mesh of its scene; returns the first run, the case and its exact solution."""
        case = make()
        series = next(s for s in case.series if not s.scene or name in s.scene)
        mesh = series.meshes[0][1](self.folder) if name == "inclined_crack" else ()
        return measure.start(program.PROGRAM, scenes.path(f"verification/{name}.xml", self.folder), mesh, self.folder / name), case, series

    def test_boundary_values_are_exact(self):
        for make, name in ((cases.sneddon, "sneddon"), (cases.sneddon_shear, "sneddon_shear"), (cases.inclined, "inclined_crack"),
                           (cases.penny, "penny"), *((cases.mms2d, f"manufactured_{r}_2d") for r in REGIMES),
                           *((cases.mms3d, f"manufactured_{r}_3d") for r in REGIMES)):
            run, case, series = self.run_case(make, name)
            known, d = series.exact or case.exact, run.dimension
            points = measure.vtk_to_numpy(run.rock.GetPoints().GetData())[:, :d]
            values = measure.vtk_to_numpy(run.rock.GetPointData().GetArray("displacement"))[:, :d]
            at = np.array([case.prescribed(p[None, :]) > 0 for p in points])
            if name.startswith("manufactured"):
                at &= np.abs(points[:, -1] - 0.5) > 1e-9  # these places have a node on both sides
            away = np.abs(values[at] - known.displacement(points[at])[:, :d]).max()
            self.assertGreater(at.sum(), 4)
            self.assertLess(away, 2e-8 * np.abs(values).max(), name)

    def test_errors_are_those_of_known_mistakes(self):
        run, case, series = self.run_case(cases.mms2d, "manufactured_stick_2d")
        known = series.exact

        class Nodal:
            """Computed field multiplied by 1.1: the relative error is 1/11."""
            def displacement(self, points):
                return 1.1 * np.stack([points[:, 0] - 2 * points[:, 1], 3 * points[:, 1]], axis=1)
        points = measure.vtk_to_numpy(run.rock.GetPoints().GetData())
        values = measure.vtk_to_numpy(run.rock.GetPointData().GetArray("displacement"))
        values[:, :2] = Nodal().displacement(points) / 1.1
        self.assertAlmostEqual(measure.displacement_error(run, Nodal()), 1 / 11, places=12)
        corners = run.corners()
        means = measure.face_means(known.jump, corners)
        run.faces.cell_data["jump"][:, :2] = 0.9 * means
        self.assertAlmostEqual(measure.jump_error(run, means), 0.1, places=12)
        run.faces.cell_data["traction local"][:, 0] = 1.2 * known.traction(corners.mean(axis=1))[:, 0]
        run.faces.cell_data["traction"][:, 0] = 1.2 * known.traction(corners.mean(axis=1))[:, 1]
        self.assertAlmostEqual(measure.traction_errors(run, known, [[1, 0]])[1], 0.2, places=12)

    def test_pressures_along_lines_are_linear_in_cells(self):
        run = measure.start(program.PROGRAM, scenes.path("verification/flow_patch_3d.xml", self.folder), (), self.folder / "patch")
        places = np.random.default_rng(4).uniform(-0.1, 0.1, (20, 3)) + measure.vtk_to_numpy(run.rock.GetPoints().GetData()).mean(axis=0)
        found = flow_measure.pressure_along(run, places, lambda points: np.ones(len(points)))
        self.assertTrue(np.allclose(found, flow_exact.Linear((0.7, -0.4, 0.3)).pressure(places), atol=1e-7))
        self.assertTrue(np.isnan(flow_measure.pressure_along(run, places[:1] + 10, lambda points: np.ones(len(points)))).all())

    def test_stress_error_is_that_of_a_known_stretch(self):
        run, case, series = self.run_case(cases.mms2d, "manufactured_stick_2d")

        class Stretched:
            """u = (0.1 x, 0): stress 0.1 (lam + 2 G, lam, 0), energy (lam + 2 G) 0.01 in the unit square."""
            G, lam = series.exact.G, series.exact.lam

            def displacement(self, points):
                return np.stack([0.1 * points[:, 0], 0 * points[:, 1]], axis=1)
        values = measure.vtk_to_numpy(run.rock.GetPointData().GetArray("displacement"))
        values[:] = 0
        self.assertAlmostEqual(measure.stress_error(run, Stretched()).sum(), 0.03, places=8)

    def test_rules_integrate(self):
        for d in (1, 2, 3):
            x, w = measure.simplex_rule(d)
            self.assertAlmostEqual(w.sum(), 1 / np.prod(np.arange(1, d + 1)), places=14)
            exponents = np.arange(1, d + 1)  # integral of x^1 y^2 z^3: a! b! c!/(a + b + c + d)!
            factorial = lambda n: float(np.prod(np.arange(1, n + 1)))
            value = np.prod([factorial(k) for k in exponents]) / factorial(exponents.sum() + d)
            self.assertAlmostEqual((w * np.prod(x**exponents, axis=1)).sum(), value, places=15)
        for tips in (1, 2, 3):  # of (1 - x - y - z)^2 and of the root of the distance from the first corner
            x, w = measure.tip_rule(3, tips)
            self.assertAlmostEqual((w * (1 - x.sum(axis=1))**2).sum(), 2 / 120, places=12)
        x, w = measure.tip_rule(2, 1)
        self.assertAlmostEqual((w / np.sqrt(x.sum(axis=1))).sum(), 2 / 3, places=12)
        squares = np.array([[[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]]])
        self.assertAlmostEqual(measure.area(squares)[0], 6)
        self.assertTrue(np.allclose(measure.face_means(lambda p: p[:, :1] * p[:, 1:2], squares), 1.5))

    def test_scenes_of_other_tests_are_those_of_the_measurement(self):
        for name in ("manufactured_mixed_2d", "manufactured_mixed_3d", "manufactured_stick_2d", "manufactured_slip_2d",
                     "manufactured_slip_3d"):
            self.assertEqual(scenes.generated(name, self.folder).read_text(), self.scene(f"verification/{name}.xml").read_text())


class Table(ProgramTest):
    def test_lines_and_files(self):
        done = subprocess.run([sys.executable, "-B", ROOT / "perf", "verification", "--binary", program.PROGRAM,
                               "--output", self.folder / "out", "--quick", "--only", "mms2d"], capture_output=True, text=True,
                              timeout=program.TIME_LIMIT)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        number = r"-?\d\.\d+"
        self.assertRegex(done.stdout.splitlines()[-3], rf"^mms2d jump_estimate={number}\.\.{number} stress_estimate={number}\.\.{number}$")
        self.assertRegex(done.stdout.splitlines()[-2], rf"^mms2d order_u={number} order_traction={number} error=\S+e-\d+ unknowns=\d+$")
        rows = (self.folder / "out/mms2d.csv").read_text().splitlines()
        self.assertGreater(len(rows), 6)
        self.assertTrue((self.folder / "out/mms2d.png").is_file())

    def test_a_missed_bound_is_reported(self):
        from perf.verification import verification
        case = cases.mms2d()
        row = verification.Row("mixed triangle 2", "n=32", 1, 8064, {"u": 2e-4}, {"jump": 0.4, "stress": 1.9}, 1, 1, 0.0, {"u": 1.2})
        wrong, judged = verification.missed(case, [row], False)
        self.assertEqual((len(wrong), judged), (3, 4), wrong)
        self.assertIn("the estimate of the jump is 0.40 of its error", wrong[-1])


if __name__ == "__main__":
    main()
