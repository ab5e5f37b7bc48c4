"""Equivalent tensors of blocks against closed forms, on any number of ranks: upscale_test.py ROOT"""
import contextlib
import io
import itertools
import math
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import meshio
import numpy as np
import sprekk
from mpi4py import MPI
from sprekk.upscale import components
from sprekk.upscale.__main__ import main as command
from sprekk.upscale.blocks import blocks_of
from sprekk.upscale.run import ALL_CONDITIONS

sys.path.insert(0, sys.argv[1])
from perf.upscale.exact import (  # noqa: E402
    BIOT, COMPRESSED, E, JOINTS, NU, PERMEABILITY, SIZE, Exact, block, joint, rock_compliance, sets_of)

ALONE = unittest.skipIf(MPI.COMM_WORLD.size > 1, "on one rank only")


SHORT_APERTURE = 1e-3  # m


def short_fractures(cells=8):
    """Returns a block with two crossing fractures inside."""
    entries = block("xy", "triangle", cells)
    for axis, corners in (("x", ([0.5, 0.2], [0.5, 0.6])), ("y", ([0.25, 0.4], [0.75, 0.4]))):
        entries["Mesh"]["fractures"][axis] = dict(zip(("lower corner", "upper corner"), corners))
        entries["Materials"][f"joint {axis}"]["initial aperture"] = SHORT_APERTURE
    return entries


def square():
    """Returns a mesh file of a square of 2 m with all sides in one boundary."""
    corners = [0, 1, 2, 5, 8, 7, 6, 3, 0]
    lines = [f"1 2 1 1 {a + 1} {b + 1}" for a, b in zip(corners, corners[1:])]
    for k in (0, 1, 3, 4):
        lines += [f"2 2 2 2 {k + 1} {k + 2} {k + 5}", f"2 2 2 2 {k + 1} {k + 5} {k + 4}"]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 1 "sides"', '2 2 "rock"',
                      "$EndPhysicalNames", "$Nodes", "9", *(f"{k + 1} {k % 3} {k // 3} 0" for k in range(9)), "$EndNodes",
                      "$Elements", str(len(lines)), *(f"{k + 1} {line}" for k, line in enumerate(lines)), "$EndElements", ""])


class Tensors(unittest.TestCase):
    def compare(self, found, exact, tolerance):
        """Compares one result: permeability under linear conditions, all other tensors under uniform conditions."""
        def close(value, expected):
            self.assertLess(np.max(np.abs(value - expected)), tolerance * np.max(np.abs(expected)))

        tangent = found.solid["uniform"]
        close(found.permeability["linear"], exact.K)
        close(tangent.compliance, exact.S)
        close(tangent.biot, exact.alpha)
        close(tangent.storage_at_stress + found.fluid, exact.storage)
        close(tangent.storage_at_strain + found.fluid, exact.storage_at_strain)
        self.check_pressure(found)
        for of in found.solid.values():
            self.assertLess(components.asymmetry(of.compliance), 1e-8)
        for K in found.permeability.values():
            self.assertLess(components.asymmetry(K), 1e-8)
        self.assertLess(components.excess(found.permeability["uniform"], found.permeability["linear"]), 1e-9)
        self.assertLess(components.excess(found.solid["linear"].compliance, tangent.compliance), 1e-9)

    def check_pressure(self, found):
        """Checks Biot tensor and storage of any network in uniform rock under any conditions.

        The pressure p and the stress -p I load no fracture, and strain the rock by -(1 - b) p S_r:I. Therefore
        alpha = I - (1 - b) S^-1:S_r:I and storage at constant strain = (1 - b) (alpha - b I):S_r:I."""
        dim = 2 if len(found.stress) == 3 else 3
        unit = np.array([1.0] * dim + [0.0] * (components.n_components(dim) - dim))
        compressed = (1 - BIOT) * rock_compliance(dim) @ unit
        for tangent in found.solid.values():
            alpha = unit - np.linalg.solve(tangent.compliance, compressed)
            np.testing.assert_allclose(tangent.biot, alpha, atol=1e-8)
            storage = (alpha - BIOT * unit) @ compressed
            self.assertAlmostEqual(tangent.storage_at_strain, storage, delta=1e-8 * compressed[0])

    def test_orthogonal_sets(self):
        cases = [("xyz", "hexahedron"), ("xy", "triangle"), ("z", "tetrahedron"), ("y", "quadrilateral")]
        for axes, cell in cases if MPI.COMM_WORLD.size == 1 else cases[:2]:
            with self.subTest(axes=axes, cell=cell):
                dim = 3 if "z" in axes else 2
                stress = COMPRESSED if dim == 3 else [-2e6, -1e6, 0]
                found = sprekk.upscale.run(block(axes, cell), [stress])
                self.compare(found.results[0], Exact(dim, sets_of(axes, dim, stress)), 1e-9)

    @ALONE
    def test_published_numbers(self):
        """Three sets at zero stress: moduli and permeabilities by hand."""
        found = sprekk.upscale.run(block("xyz"), [[0] * 6]).results[0]
        moduli = 1e-9 / np.diag(found.solid["uniform"].compliance)
        np.testing.assert_allclose(moduli, [34.285714, 26.666667, 27.272727, 6.486486, 8, 7.272727], rtol=1e-6)
        np.testing.assert_allclose(np.diag(found.permeability["linear"]),
                                   [1.684896833e-12, 1.416666667e-12, 4.348968333e-13], rtol=1e-6)

    def test_periodic_conditions(self):
        """Periodic conditions are exact for sets through the block, for flow and deformation."""
        cases = [("xy", "triangle"), ("xyz", "hexahedron")]
        for axes, cell in cases if MPI.COMM_WORLD.size == 1 else cases[:1]:
            with self.subTest(cell=cell):
                dim = len(axes)
                stress = COMPRESSED if dim == 3 else [-2e6, -1e6, 0]
                exact = Exact(dim, sets_of(axes, dim, stress))
                result = sprekk.upscale.run(block(axes, cell), [stress], conditions=["periodic"]).results[0]
                tangent = result.solid["periodic"]
                for value, expected in ((result.permeability["periodic"], exact.K), (tangent.compliance, exact.S),
                                        (tangent.biot, exact.alpha)):
                    self.assertLess(np.max(np.abs(value - expected)), 1e-9 * np.max(np.abs(expected)))
                self.check_pressure(result)

    @ALONE
    def test_periodic_between_the_bounds(self):
        found = sprekk.upscale.run(short_fractures(), [[-1e6, -1e6, 0]], conditions=ALL_CONDITIONS, errors=False)
        result = found.results[0]
        self.assertFalse(found.table()["error"].notna().any())
        K = result.permeability
        S = {name: tangent.compliance for name, tangent in result.solid.items()}
        for lower, upper in ((K["uniform"], K["periodic"]), (K["periodic"], K["linear"]),
                             (S["linear"], S["periodic"]), (S["periodic"], S["uniform"])):
            self.assertLess(components.excess(lower, upper), 1e-9)
            self.assertGreater(components.largest_ratio(lower, upper), 1 + 1e-6)
        self.check_pressure(result)

    @ALONE
    def test_blocks_of_layers(self):
        """Means over the blocks of two layers equal the whole: along, across, and compliance across."""
        rock = {"type": "elastic", "Poisson's ratio": 0}
        scene = sprekk.Scene({
            "Mesh": {"cell": "quadrilateral", "lower corner": [0, 0], "upper corner": [1, 1], "cells": [2, 4],
                     "regions": {"upper": {"lower corner": [0, 0.5], "upper corner": [1, 1]}}},
            "Materials": {"tight": {**rock, "Young's modulus": 60e9, "permeability": [1e-18]},
                          "open": {**rock, "Young's modulus": 20e9, "permeability": [3e-16]}},
            "Bulk": {"material": "tight"}, "Regions": {"upper": {"material": "open"}}, "Flow": {}, "Time": {"end": 1}})
        whole = sprekk.upscale.run(scene).results[0]
        parts = list(blocks_of(scene, (1, 2), MPI.COMM_WORLD))
        self.assertEqual([(index, list(low)) for index, low, *_ in parts], [((0, 0), [0, 0]), ((0, 1), [0, 0.5])])
        parts = [sprekk.upscale.run(part).results[0] for *_, part in parts]
        for of, expected in ((lambda result: result.permeability["linear"][0, 0], 150.5e-18),
                             (lambda result: 1 / result.permeability["uniform"][1, 1], (1 / 1e-18 + 1 / 3e-16) / 2),
                             (lambda result: result.solid["uniform"].compliance[1, 1], (1 / 60e9 + 1 / 20e9) / 2)):
            for value in (of(whole), np.mean([of(part) for part in parts])):
                self.assertLess(abs(value / expected - 1), 1e-9)

    def test_inner_region(self):
        """Four fractures through the block, two in the inner half: exact permeability, nearly exact compliance."""
        stiff = (2e12, 1e12, 1.5e-4)  # the influence of the boundary decays over the length E / stiffness
        entries = block("y", "quadrilateral", 16, y=joint(*stiff))
        fracture = entries["Mesh"]["fractures"].pop("y")
        entries["Fractures"] = {"material": "joint y"}
        for k in range(4):
            heights = [(2 * k + 1) / 8 * SIZE["y"]] * 2
            entries["Mesh"]["fractures"][f"y{k}"] = {corner: [fracture[corner][0], height] for corner, height in zip(
                ("lower corner", "upper corner"), heights)}
        result = sprekk.upscale.run(entries, [[0, -1e6, 0]], inner=0.5).results[0]
        exact = Exact(2, [(np.array([0, 1.0]), SIZE["y"] / 4, *stiff[:2], stiff[2] - 1e6 / stiff[0])])
        self.assertLess(np.max(np.abs(result.permeability["inner"] - exact.K)), 1e-9 * np.max(exact.K))
        errors = [np.max(np.abs(S - exact.S)) / np.max(exact.S)
                  for S in (result.inner, result.solid["linear"].compliance)]
        self.assertLess(errors[0], 1e-4)
        self.assertGreater(errors[1], 100 * errors[0])

    @ALONE
    def test_inner_region_of_rock(self):
        """Without fractures, the inner region has the tensors of the rock, for all pairs of elastic constants."""
        K, G = E / 3 / (1 - 2 * NU), E / 2 / (1 + NU)
        constants = {"Young's modulus": E, "Poisson's ratio": NU, "shear modulus": G, "bulk modulus": K,
                     "Lame's first parameter": K - 2 * G / 3}
        for pair in itertools.combinations(constants, 2):
            entries = block("", "quadrilateral")
            del entries["Mesh"]["fractures"], entries["Fractures"]
            rock = entries["Materials"]["rock"]
            del rock["Young's modulus"], rock["Poisson's ratio"]
            rock.update({name: constants[name] for name in pair}, permeability=[2e-18, 1e-18, 5e-19])
            result = sprekk.upscale.run(entries, inner=0.6).results[0]
            np.testing.assert_allclose(result.inner, rock_compliance(2), atol=1e-9 / E)
            np.testing.assert_allclose(result.permeability["inner"], [[2e-18, 5e-19], [5e-19, 1e-18]], atol=1e-27)

    @ALONE
    def test_fracture_between_blocks(self):
        with self.assertRaisesRegex(sprekk.Error, "fractures > y: lies between two blocks"):
            list(blocks_of(sprekk.Scene(block("y", "quadrilateral")), (1, 2), MPI.COMM_WORLD))

    @ALONE
    def test_sides_in_one_boundary(self):
        """One name for all sides gives the same tensors."""
        entries = block("", "triangle")
        del entries["Mesh"], entries["Fractures"]
        with tempfile.TemporaryDirectory() as folder:
            entries["Mesh file"] = {"path": f"{folder}/square.msh"}
            Path(folder, "square.msh").write_text(square())
            self.compare(sprekk.upscale.run(entries, [[-2e6, -1e6, 1e5]]).results[0], Exact(2, []), 1e-9)

    @ALONE
    def test_command(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "path.csv"
            path.write_text("xx [MPa], yy [MPa], pressure [kPa]\n-1, -1, 0\n-2, -1, 500\n")
            scene = Path(folder) / "block.xml"
            scene.write_text(sprekk.Scene(block("x", "quadrilateral", 8)).to_xml())
            with contextlib.redirect_stdout(io.StringIO()) as shown, contextlib.redirect_stderr(io.StringIO()):
                self.assertEqual(command([str(scene), "--path", str(path), "--blocks", "1,2", "--output", folder]), 0)
            for name in ("states", "tensors", "principal", "scatter"):
                self.assertGreater(len((Path(folder) / f"{name}.csv").read_text().splitlines()), 1)
            states = (Path(folder) / "states.csv").read_text().splitlines()
            self.assertTrue(states[2].startswith('"0,0",1,-2000000,-1000000,0,500000,'), states[2])
            for name in ("blocks_0000.vtu", "blocks_0001.vtu", "path.png", "permeability.png"):
                self.assertGreater((Path(folder) / name).stat().st_size, 1000)
            steps = ElementTree.parse(Path(folder) / "blocks.pvd").iter("DataSet")
            self.assertEqual([(step.get("timestep"), step.get("file")) for step in steps],
                             [("0", "blocks_0000.vtu"), ("1", "blocks_0001.vtu")])
            fields = meshio.read(Path(folder) / "blocks_0001.vtu").cell_data
            np.testing.assert_allclose(fields["stress"][0], [[-2e6, 0, 0, 0, -1e6, 0, 0, 0, 0]] * 2)
            np.testing.assert_allclose(fields["pressure"][0], [5e5, 5e5])
            self.assertIn("0,1: permeability, linear: ", shown.getvalue())

    @ALONE
    def test_wrong_paths(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, path = Path(folder) / "block.xml", Path(folder) / "path.csv"
            scene.write_text(sprekk.Scene(block("x", "quadrilateral")).to_xml())
            for text, message in (("xx, zz\n0, 0\n", 'column "zz" is unknown'), ("xx [bar]\n0\n", "the unit is bar"),
                                  ("xx\nno\n", "path.csv:2: xx is missing or not a number"),
                                  ("xx\n", "must have a line of titles and a line for each stress")):
                path.write_text(text)
                with contextlib.redirect_stderr(io.StringIO()) as shown:
                    self.assertEqual(command([str(scene), "--path", str(path)]), 1)
                self.assertIn(message, shown.getvalue())

    @ALONE
    def test_inclined_set(self):
        angle = math.radians(30)
        R = np.array([[math.cos(angle), 0, math.sin(angle)], [0, 1, 0], [-math.sin(angle), 0, math.cos(angle)]])
        found = sprekk.upscale.run(block("z", rotation=30), [COMPRESSED]).results[0]
        self.compare(found, Exact(3, sets_of("z", 3, COMPRESSED, R)), 1e-9)
        aperture = sets_of("z", 3, COMPRESSED, R)[0][-1]
        straight = Exact(3, [(np.array([0, 0, 1.0]), SIZE["z"], *JOINTS["z"][:2], aperture)])
        turned = components.rotated(straight.S, R)
        self.assertLess(np.max(np.abs(found.solid["uniform"].compliance - turned)), 1e-9 * np.max(turned))

    @ALONE
    def test_closure_along_a_path(self):
        """Barton-Bandis closure V = N/(K + N/Vm): tangent stiffness (K + N/Vm)^2/K, aperture a - V."""
        stiffness, maximum, aperture, shear = 20e9, 2e-4, 3e-4, 40e9
        rough = joint(stiffness, shear, aperture, **{"maximum closure": maximum})
        compressions = [0, 1e6, 5e6, 10e6, 20e6]
        found = sprekk.upscale.run(block("z", z=rough), [[0, 0, -N, 0, 0, 0] for N in compressions])
        for N, result, by_hand in zip(compressions, found.results, [8.57142857, 12.39669421, 27.45762712, 40.27397260,
                                                                    51.42857143]):
            with self.subTest(N=N):
                tangent, closure = (stiffness + N / maximum) ** 2 / stiffness, N / (stiffness + N / maximum)
                exact = Exact(3, [(np.array([0, 0, 1.0]), SIZE["z"], tangent, shear, aperture - closure)])
                self.compare(result, exact, 1e-8)
                self.assertAlmostEqual(1e-9 / result.solid["uniform"].compliance[2, 2], by_hand, delta=1e-6 * by_hand)
                self.assertAlmostEqual(result.state.strain[2], -N / E - closure / SIZE["z"], delta=1e-12)
                self.assertAlmostEqual(result.state.of_fractures[2], -closure / SIZE["z"], delta=1e-12)

    def test_pressure_in_the_path(self):
        """Equal increments of compression and pressure change the effective traction of the joint by nothing."""
        more = [s - 1e6 * (k < 3) for k, s in enumerate(COMPRESSED)]
        found = sprekk.upscale.run(block("z"), [COMPRESSED, more], [0, 1e6])
        first, second = (result.state for result in found.results)
        self.assertAlmostEqual(first.aperture, second.aperture, delta=1e-13)
        exact = Exact(3, sets_of("z", 3, COMPRESSED))
        change = exact.S @ np.array([-1e6] * 3 + [0] * 3) + exact.S @ exact.alpha * 1e6
        np.testing.assert_allclose(second.strain - first.strain, change, atol=1e-9 * np.max(np.abs(first.strain)))

    @ALONE
    def test_short_fractures_between_bounds(self):
        """K - k_m I under linear conditions is at most the crack tensor of Oda with the factor 1/12."""
        result = sprekk.upscale.run(short_fractures(), [[-1e6, -1e6, 0]]).results[0]
        lengths = {"x": 0.4, "y": 0.5}
        oda = sum(SHORT_APERTURE**3 / 12 * length / (SIZE["x"] * SIZE["y"]) * np.diag([axis != "x", axis != "y"])
                  for axis, length in lengths.items())
        added = result.permeability["linear"] - PERMEABILITY * np.eye(2)
        self.assertLess(np.linalg.eigvalsh(added - oda)[-1], 1e-10 * np.max(oda))
        self.assertLess(components.excess(result.permeability["uniform"], result.permeability["linear"]), 0)
        self.assertGreater(np.linalg.eigvalsh(added)[0], 0)
        self.check_pressure(result)

    @ALONE
    def test_tangents_of_sliding_faces(self):
        """The strain of a small further step is that of slipping faces, that of a small step back of sticking ones."""
        entries = short_fractures()
        for axis in "xy":
            rough = {**joint(*JOINTS[axis]), "friction coefficient": 0.2}
            del rough["friction"]
            entries["Materials"][f"joint {axis}"] = rough
        start, loaded = np.array([-2e6, -2e6, 0]), np.array([-2e6, -2e6, 1e6])
        for mode, factor in (("slip", 1e-3), ("stick", -1e-3)):
            change = factor * (loaded - start)
            found = sprekk.upscale.run(entries, [start, loaded, loaded + change], sliding=mode)
            before, after = (result.state for result in found.results[1:])
            self.assertGreater(before.sliding, 0.1)
            self.assertFalse([warning for warning in found.warnings if "ordered" in warning])
            other = sprekk.upscale.run(entries, [start, loaded], sliding="stick" if factor > 0 else "slip").results[1]
            strain, scale = after.strain - before.strain, np.max(np.abs(after.strain - before.strain))
            with self.subTest(mode=mode):
                S = found.results[1].solid["uniform"].compliance
                np.testing.assert_allclose(strain, S @ change, atol=1e-6 * scale)
                wrong = np.max(np.abs(strain - other.solid["uniform"].compliance @ change))
                self.assertGreater(wrong, 1e-2 * scale)
                self.assertEqual(components.asymmetry(S) > 1e-3, mode == "slip")
                pressures = [0, 0, factor * 1e6]
                pressed = sprekk.upscale.run(entries, [start, loaded, loaded], pressures, sliding=mode).results
                strain = pressed[2].state.strain - pressed[1].state.strain
                tangent = pressed[1].solid["uniform"]
                np.testing.assert_allclose(strain, tangent.compliance @ tangent.biot * pressures[2],
                                           atol=1e-6 * np.max(np.abs(strain)))

    @ALONE
    def test_initial_state(self):
        """An initial stress and pressure as a path from zero to them; the default path is the initial state."""
        rough = joint(20e9, 40e9, 3e-4, **{"maximum closure": 2e-4})
        entries = block("z", z=rough)
        loaded = sprekk.upscale.run(entries, [COMPRESSED], [5e5]).results[0]
        entries["Bulk"] = {"material": "rock", "initial stress": [*COMPRESSED[:3], 0, 0, 0], "gravity": [0, 0, -9.81]}
        entries["Flow"]["initial pressure"] = 5e5
        entries["Materials"]["rock"]["density"] = 2700
        initial = sprekk.upscale.run(entries).results[0]
        np.testing.assert_array_equal([*initial.stress, initial.pressure], [*COMPRESSED, 5e5])
        np.testing.assert_allclose(initial.state.strain, 0, atol=1e-12)
        for one, other in ((initial.permeability["linear"], loaded.permeability["linear"]),
                           (initial.solid["uniform"].compliance, loaded.solid["uniform"].compliance),
                           (initial.solid["linear"].biot, loaded.solid["linear"].biot)):
            np.testing.assert_allclose(one, other, atol=1e-9 * np.max(np.abs(other)))
        for change, message in (({"Bulk.initial stress": [0, 0, "1e3*z", 0, 0, 0]}, "must be uniform"),
                                ({"Flow.initial pressure": "1e3*z"}, "must be uniform for a block")):
            with self.assertRaisesRegex(sprekk.Error, message):
                sprekk.upscale.run(sprekk.Scene(entries).changed(change))

    def test_entries_of_other_scenes(self):
        """Held pressures are ignored, slip that depends on time is refused."""
        entries = block("z", z=joint(20e9, 40e9, 3e-4))
        alone = sprekk.upscale.run(entries, [COMPRESSED]).results[0].permeability["linear"]
        entries["Fractures"]["z"]["Held pressures"] = {"well": {"pressure": 1e6, "lower corner": [0.5, 0.5, 0.5]}}
        held = sprekk.upscale.run(entries, [COMPRESSED]).results[0].permeability["linear"]
        np.testing.assert_allclose(held, alone, atol=1e-12 * np.max(np.abs(alone)))
        friction = {"friction": "rate and state", "direct effect": 0.01, "evolution effect": 0.01,
                    "state evolution distance": 1e-3, "initial slip rate": 1e-9}
        rated = joint(20e9, 40e9, 3e-4, **friction)
        rated.pop("friction coefficient", None)
        for entries, message in ((block("z", z=rated), "depends on the slip rate"),
                                 (block("z", z=joint(20e9, 40e9, 3e-4)), "prescribed slip: must be absent")):
            if "must" in message:
                entries["Fractures"]["z"]["prescribed slip"] = {"slip": [0, 0]}
            with self.assertRaisesRegex(sprekk.Error, message):
                sprekk.upscale.run(entries, [COMPRESSED])

    def test_joints_in_situ(self):
        """The aperture of a joint in situ is that under the initial stress: a + V(N_0) - V(N) at the compression N."""
        stiffness, maximum, aperture = 20e9, 2e-4, 1.2e-4
        entries = block("z", z=joint(stiffness, 40e9, aperture, **{"maximum closure": maximum, "reference state": "in situ"}))
        entries["Bulk"]["initial stress"] = [*COMPRESSED[:3], 0, 0, 0]
        found = sprekk.upscale.run(entries, [COMPRESSED, [*COMPRESSED[:2], 3 * COMPRESSED[2], 0, 0, 0]])
        closure = [N / (stiffness + N / maximum) for N in (-COMPRESSED[2], -3 * COMPRESSED[2])]
        for result, a in zip(found.results, (aperture, aperture + closure[0] - closure[1])):
            expected = PERMEABILITY + a**3 / 12 / SIZE["z"]
            self.assertAlmostEqual(result.permeability["linear"][0, 0], expected, delta=1e-8 * expected)

    @ALONE
    def test_warning_of_different_bounds(self):
        through = sprekk.upscale.run(block("z"), [COMPRESSED])
        self.assertTrue(any("permeability" in warning and "factor" in warning for warning in through.warnings))
        self.assertFalse(sprekk.upscale.run(block("z"), [COMPRESSED], largest=1e9).warnings)

    @ALONE
    def test_warning_of_free_pieces(self):
        """A single face between two pieces does not resist rotation about its normal."""
        found = sprekk.upscale.run(block("xyz", cells=2), [COMPRESSED], largest=1e9)
        self.assertRegex(found.warnings[0], "^state 0: a piece of rock .* can rotate .* not reliable$")

    @ALONE
    def test_estimated_error(self):
        """The estimate is near the difference to a fine mesh, for all components on the diagonal."""
        coarse, fine = (sprekk.upscale.run(short_fractures(cells), [[-1e6, -1e6, 0]], conditions=["linear", "uniform"])
                        .results[0] for cells in (8, 64))
        for conditions in ("linear", "uniform"):
            for value, exact, error in (
                    (coarse.permeability[conditions], fine.permeability[conditions], coarse.flow_errors[conditions]),
                    (coarse.solid[conditions].compliance, fine.solid[conditions].compliance,
                     coarse.solid[conditions].error)):
                ratio = np.diag(error) / abs(np.diag(value - exact))
                with self.subTest(conditions=conditions, dim=len(value), ratio=ratio):
                    self.assertGreater(np.min(ratio), 0.5)
                    self.assertLess(np.max(ratio), 5)

    @ALONE
    def test_rock_without_fractures(self):
        entries = block("")
        del entries["Mesh"]["fractures"], entries["Fractures"]
        result, exact = sprekk.upscale.run(entries, [COMPRESSED]).results[0], Exact(3, [])
        self.compare(result, exact, 1e-9)
        np.testing.assert_allclose(result.solid["linear"].compliance, exact.S, atol=1e-9 * np.max(exact.S))
        np.testing.assert_allclose(result.permeability["uniform"], exact.K, atol=1e-9 * PERMEABILITY)

    def test_tables(self):
        found = sprekk.upscale.run(block("y", "quadrilateral"), [[0, -1e6, 0], [0, -2e6, 0]])
        table = found.table().set_index(["state", "tensor", "conditions", "component"])
        K = found.results[1].permeability["linear"]
        self.assertEqual(table.loc[1, "permeability", "linear", "xx"]["value"], K[0, 0])
        self.assertAlmostEqual(table.loc[1, "permeability", "linear", "xx"]["change"],
                               K[0, 0] / found.results[0].permeability["linear"][0, 0] - 1)
        self.assertEqual(list(found.states()["stress_yy"]), [-1e6, -2e6])

    @ALONE
    def test_wrong_arguments(self):
        for arguments, message in (
                (([[0, 0, 0]],), "stresses: have 3 components, must have 6: xx, yy, zz, yz, xz, xy"),
                (([COMPRESSED], [0, 1]), "pressures: are 2, must be as many as the stresses, 1"),
                (([COMPRESSED], None, ("mixed",)), 'conditions: "mixed" is unknown, must be one of: linear, uniform')):
            with self.assertRaisesRegex(sprekk.Error, message):
                sprekk.upscale.run(block("z"), *arguments)
        for option, message in (({"sliding": "no"}, 'sliding: is "no", must be one of: stick, slip'),
                                ({"largest": 0}, "largest ratio: is 0, must be at least 1"),
                                ({"inner": 0}, "inner: is 0, must be above 0"),
                                ({"pressures": [math.nan]}, "pressures: state 0 has a value that is not finite")):
            with self.assertRaisesRegex(sprekk.Error, message):
                sprekk.upscale.run(block("z"), **option)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=0)
