"""Python package on one rank: alone_test.py ROOT PROGRAM"""
import json
import os
import resource
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import sprekk

ROOT, PROGRAM = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
PUSH = ROOT / "xml/seed/push_2d.xml"
CYCLES = ROOT / "xml/point/cyclic_shear.xml"


def script(text, expect=0):
    """Returns standard output and error of Python code in a separate process."""
    done = subprocess.run([sys.executable, "-B", "-c", text], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == expect, f"status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout, done.stderr


def said_by_program(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return done.stderr.strip().removeprefix("sprekk: ")


class Scenes(unittest.TestCase):
    def test_file_text_and_entries_are_one_scene(self):
        file, text = sprekk.Scene(PUSH), sprekk.Scene(PUSH.read_text())
        entries = sprekk.Scene(file.entries)
        self.assertEqual(file.to_xml(defaults=True), text.to_xml(defaults=True))
        self.assertEqual(file.to_xml(defaults=True), entries.to_xml(defaults=True))

    def test_all_scenes_go_there_and_back(self):
        for path in sorted(ROOT.glob("xml/*/*.xml")):
            text = path.read_text()
            if 'name="Point"' in text or 'name="Specimens"' in text or 'name="network"' in text:
                continue
            with self.subTest(path.name):
                scene = sprekk.Scene(path)
                again = sprekk.Scene(scene.entries, folder=path.parent, name=str(path))
                self.assertEqual(scene.to_xml(defaults=True), again.to_xml(defaults=True))

    def test_traces_of_one_name(self):
        """Traces with equal names are an error."""
        table = {"geometry": [[[0, 0], [1, 1]], [[0, 1], [1, 0]], [[0, 2], [1, 2]]], "id": [7, 8, 7]}
        self.assertEqual(list(sprekk.traces(table)["lines"]), ["1", "2", "3"])
        with self.assertRaisesRegex(sprekk.Error, 'rows 0 and 2, counted from 0 on, have the same name, "7"'):
            sprekk.traces(table, name="id")

    def test_units(self):
        for value in ("30 GPa", 30e9, 30_000_000_000, "30e9", np.float64(3e10), "3e4 MPa"):
            scene = sprekk.Scene(PUSH).changed({"Materials": {"rock": {
                "shear modulus": value, "Lame's first parameter": "1 GPa"}}})
            self.assertEqual(float(scene.all_entries["Materials"]["rock"]["shear modulus"]), 3e10)
        corners = sprekk.Scene(PUSH).changed({"Mesh": {"upper corner": ["100 cm", 1]}}).all_entries["Mesh"]["upper corner"]
        self.assertEqual(corners, [1, 1])
        with self.assertRaisesRegex(sprekk.Error, "GPaa"):
            sprekk.Scene(PUSH, {"Materials.rock.shear modulus": "30 GPaa"})

    def test_errors_have_the_words_of_the_program(self):
        for override in ("Bulk.material=rok", "Time.steps=0", "Materials.joint.friction coefficient=-1", "Mesh.cells={0, 2}",
                         "Fractures.fractur.material=joint", "Time", "Materials.rock.shear modulus=1 m"):
            with self.assertRaises(sprekk.Error) as raised:
                sprekk.Model(sprekk.Scene(PUSH, [override]))
            self.assertEqual(str(raised.exception), said_by_program("check", PUSH, "--set", override))
        with self.assertRaises(sprekk.Error) as raised:
            sprekk.Scene("absent.xml")
        self.assertEqual(str(raised.exception), said_by_program("check", "absent.xml"))
        with self.assertRaisesRegex(TypeError, '"steps" is a complex'):
            sprekk.Scene({"Time": {"steps": 1j}})

    def test_changed_leaves_the_first_as_it_was(self):
        scene = sprekk.Scene(PUSH)
        other = scene.changed({"Time.steps": 7, "Bulk": {"gravity": [0, -9.81]}, "Materials.rock": {"density": 2700}})
        self.assertEqual((scene.all_entries["Time"]["steps"], other.all_entries["Time"]["steps"]), (1, 7))
        self.assertEqual(other.all_entries["Bulk"]["gravity"], [0, -9.81])
        self.assertNotIn("gravity", scene.entries["Bulk"])


class Folders(unittest.TestCase):
    def test_run_from_python_is_that_of_the_program(self):
        scene = ROOT / "xml/verification/cyclic_2d.xml"
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, "run", scene, "--output", f"{folder}/program"], check=True, stdin=subprocess.DEVNULL)
            model = sprekk.Model(sprekk.Scene(scene))
            table = model.run(output=f"{folder}/python")
            program, python = sprekk.Results(f"{folder}/program"), sprekk.Results(f"{folder}/python")
            self.assertEqual((python.status, python.content["steps"]), (program.status, program.content["steps"]))
            self.assertEqual(list(python.steps["newton_iterations"]), list(table["newton"]))
            last = python.fractures.loc[model.time]
            here = model.fractures()
            for name in set(last.columns) & set(here.columns):
                np.testing.assert_array_equal(last[name].astype(float), here[name], err_msg=name)
            self.assertGreater(len(set(last.columns) & set(here.columns)), 20)
            singles, known = python.single_fractures.loc[model.time], model.fractures(singles=True)
            np.testing.assert_array_equal(singles["moment"], known["moment"])
            self.assertEqual(list(singles.index), list(known.index))
            wide = python.single_fractures["max_slip"].unstack("fracture")
            self.assertEqual(wide.shape, (len(python.steps), len(known)))
            for file in ("effective_input.xml", "bulk.pvd", "fractures.pvd", "fractures.csv"):
                self.assertTrue((Path(folder) / "python" / file).exists(), file)
        with self.assertRaisesRegex(sprekk.Error, "has no results.json"):
            sprekk.Results("absent")

    def test_tables_of_points(self):
        """Extensions with times and names of fractures; names of tables that do not exist."""
        growth = {"fracture": [1, 0], "x": [0.5, -0.5], "length": [0.1, 0.2]}
        content = {"tables": {"growth": {"x": "m", "length": "m"}}, "single_fractures": [{"name": "a"}, {"name": "b"}],
                   "steps": [{"time": 1.0}, {"time": 2.0, "growth": growth}], "status": "completed"}
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "results.json"
            file.write_text(json.dumps(content))
            table = sprekk.Results(folder).points("growth")
            self.assertEqual(list(table["fracture"]), ["b", "a"])
            self.assertEqual((list(table["time"]), list(table["length"])), ([2.0, 2.0], [0.1, 0.2]))
            with self.assertRaisesRegex(sprekk.Error, 'no table "tips"; there are: growth'):
                sprekk.Results(folder).points("tips")
            file.write_text(json.dumps({**content, "steps": [{"time": 1.0}]}))
            with self.assertRaisesRegex(sprekk.Error, 'no step has rows of "growth"'):
                sprekk.Results(folder).points("growth")

    def test_probes(self):
        try:
            import h5netcdf, xarray  # noqa: E401, F401
        except ImportError:
            self.skipTest("needs python3-xarray and python3-h5netcdf")
        scene = sprekk.Scene(PUSH).changed({"Probes": {"middle": {"point": [0.5, 0.75], "outputs": ["displacement"]}},
                                            "Time.steps": 3})
        with tempfile.TemporaryDirectory() as folder:
            sprekk.Model(scene).run(output=folder)
            with sprekk.Results(folder).probe("middle") as probe:
                self.assertEqual(len(probe["time"]), 4)


class Processes(unittest.TestCase):
    def test_ends_well_whatever_is_alive(self):
        """The interpreter ends without errors while models, arrays, checkpoints and exceptions exist."""
        _, err = script(f"""
import sprekk
model = sprekk.Model(sprekk.Scene({str(PUSH)!r}))
model.step(1)
field, output, kept = model.field("displacement"), model.output("stress"), model.save()
steps = sprekk._sprekk.Steps(model._handle)
cycle = [model, field]
cycle.append(cycle)
""")
        self.assertEqual(err, "")
        _, err = script(f"import sprekk\nmodel = sprekk.Model(sprekk.Scene({str(PUSH)!r}))\nmodel.step(-1)", expect=1)
        self.assertIn("no step forward", err)

    def test_mpi_is_that_of_mpi4py(self):
        out, _ = script(f"""
from mpi4py import MPI
before = MPI.Is_initialized()
import sprekk
model = sprekk.Model(sprekk.Scene({str(PUSH)!r}))
model.run()
model.close()
print(before, MPI.Is_finalized(), MPI.COMM_WORLD.allreduce(1))
""")
        self.assertEqual(out, "True False 1\n")

    def test_interrupted(self):
        out, _ = script(f"""
import signal, sprekk
model = sprekk.Model(sprekk.Scene({str(PUSH)!r}, {{"Time.steps": 100}}))
def callback(model, step):
    if model.time > 0.095:
        signal.raise_signal(signal.SIGINT)
try:
    model.run(callback)
except KeyboardInterrupt:
    print("at", round(model.time, 12))
model.step(0.5)
print(model.time)
""")
        self.assertEqual(out, "at 0.1\n0.5\n")

    def test_the_lock_is_released_in_solves(self):
        model = sprekk.Model(sprekk.Scene(PUSH, {"Mesh.cells": [150, 150]}))
        counts, done = [0], threading.Event()

        def count():
            while not done.wait(0.001):
                counts[0] += 1
        thread = threading.Thread(target=count)
        thread.start()
        model.step(1)
        done.set()
        thread.join()
        self.assertGreater(counts[0], 10)

    def test_ten_thousand_steps_leak_nothing(self):
        n = 10000
        model = sprekk.Model(sprekk.Scene(PUSH, {"Time.steps": n}))
        sizes = []

        def watch(model, step):
            model.field("displacement"), model.output("slip")
            if round(model.time * n) % (n // 4) == 0:
                sizes.append(resident())
        model.run(watch)
        self.assertEqual(len(sizes), 4)
        self.assertLess(sizes[-1] - sizes[1], 2 * 2**20)  # growth in bytes during the last 5000 steps

    def test_models_that_end_leave_nothing(self):
        scene, sizes = sprekk.Scene(PUSH), []
        for k in range(300):
            model = sprekk.Model(scene)
            model.step(1)
            model.change({"Materials.joint.friction coefficient": 0.5})
            if k % 100 == 99:
                sizes.append(resident())
        self.assertLess(sizes[-1] - sizes[0], 4 * 2**20)


def resident():
    """Returns the resident memory in bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize()


class Points(unittest.TestCase):
    def test_drive_is_sprekk_point(self):
        done = subprocess.run([PROGRAM, "point", CYCLES], capture_output=True, text=True, check=True).stdout.splitlines()
        curve = sprekk.drive(CYCLES)
        self.assertEqual(list(curve.columns), done[0].split(","))
        np.testing.assert_array_equal(curve.to_numpy(), np.array([line.split(",") for line in done[1:]], float))

    def test_aperture_in_situ(self):
        joint = {"type": "joint", "friction coefficient": 0.6, "normal stiffness": 2e10, "maximum closure": 2e-4,
                 "reference state": "in situ", "initial aperture": 1.2e-4}
        curve = sprekk.drive({"Materials": {"joint": joint}, "Time": {"steps": 1},
                              "Point": {"material": "joint", "control": ["traction", "jump"], "initial traction": [-8e6, 0],
                                        "path": ["-8e6*(1 - t)", "0"]}})
        closure = 8e6 / (2e10 + 8e6 / 2e-4)
        np.testing.assert_allclose(curve["aperture"], [1.2e-4, 1.2e-4 + closure], rtol=1e-14)

    def test_no_state(self):
        with self.assertRaises(sprekk.PointFailed) as raised:
            sprekk.drive(CYCLES, {"Point.control": ["traction", "traction"], "Point.path": ["-1e6*t", "1e7*t"]})
        self.assertIn("no state found", str(raised.exception))
        self.assertGreaterEqual(len(raised.exception.curve), 1)

    def test_fit_finds_what_made_the_curve(self):
        path = "Materials.joint.friction coefficient"
        entries = {"Materials": {"joint": {"type": "joint", "friction coefficient": 0.6, "tangential stiffness": "10 GPa/m"}},
                   "Time": {"steps": 20},
                   "Point": {"material": "joint", "control": ["traction", "jump"], "path": ["-5e6", "1e-3*t"]}}
        measured = sprekk.drive(entries, {path: 0.45, "Materials.joint.tangential stiffness": 7e9})
        found = sprekk.fit(entries, measured, "jump_t", "traction_t",
                           {path: (0.6, 0.1, 1), "Materials.joint.tangential stiffness": (1e10, 1e8, 1e11)})
        np.testing.assert_allclose(list(found.parameters.values()), [0.45, 7e9], rtol=1e-6)


    def test_fit_names_what_is_wrong(self):
        path, curve = "Materials.joint.friction coefficient", sprekk.drive(CYCLES)
        good = {path: (0.5, 0.1, 2)}
        lost = curve.copy()
        lost.loc[2, "traction_t"] = np.nan
        for measured, along, match, parameters, words in (
                (curve, "time", "traction_t", good, 'no column "time", but t, state, jump_n'),
                (curve, "t", ["traction_t", "slip"], good, 'no column "slip"'),
                (curve, "t", [], good, "match: names no column"),
                (lost, "t", "traction_t", good, '"traction_t" is nan in row 2, must be finite'),
                ({"t": [1, 2], "traction_t": [1]}, "t", "traction_t", good, "has 1 rows, others have 2"),
                ({"t": [1, 2], "own": [1, 2]}, "t", "own", good, 'the point has no column "own"'),
                ({"t": ["a"], "traction_t": [1]}, "t", "traction_t", good, "must have numbers"),
                (curve, "t", "traction_t", {}, "parameters: has none"),
                (curve, "t", "traction_t", {path: (0.5, 2, 0.1)}, "low < high"),
                (curve, "t", "traction_t", {path: (3, 0.1, 2)}, "start 3, low 0.1, high 2"),
                (curve, "t", "traction_t", {path: (np.nan, 0.1, 2)}, "start nan"),
                (curve, "t", "traction_t", {path: 0.5}, "must have numbers (start, low, high)")):
            with self.assertRaises(sprekk.Error) as raised:
                sprekk.fit(CYCLES, measured, along, match, parameters)
            self.assertIn(words, str(raised.exception))


class Threads(unittest.TestCase):
    def test_models_in_threads_take_turns(self):
        """Models in threads take turns, also in callbacks. The result is that of a single model."""
        def work(found):
            model = sprekk.Model(sprekk.Scene(PUSH, {"Time.steps": 4}))
            model.run(lambda model, step: {"slip": float(np.max(model.output("slip")))})
            found.append(np.array(model.output("displacement")))
        alone, found = [], []
        work(alone)
        for _ in range(3):
            threads = [threading.Thread(target=work, args=[found]) for _ in range(3)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        self.assertEqual(len(found), 9)
        for one in found:
            np.testing.assert_array_equal(one, alone[0])


class Wrong(unittest.TestCase):
    def test_entries_that_are_none(self):
        for entries, error, words in (({1: 2}, TypeError, "1 is the name of an entry and a int, must be a text"),
                                      ({"Time": {"end": 10**400}}, sprekk.Error, '"end" is an integer that no number holds'),
                                      ({"Time": {"schedule": [1, 10**400]}}, sprekk.Error, '"schedule" is an integer'),
                                      ({"Time": {"schedule": [[1]]}}, TypeError, '"schedule" has a list in its list'),
                                      ({"Time": {"end": object()}}, TypeError, '"end" is a object')):
            with self.assertRaisesRegex(error, words):
                sprekk.Scene(entries)

    def test_accuracy_is_refused(self):
        model = sprekk.Model(sprekk.Scene(ROOT / "xml/accuracy/fault_2d.xml"))
        with self.assertRaisesRegex(sprekk.Error, "Accuracy: a Model has one mesh.*use `./sprekk run`"):
            model.run()
        self.assertEqual(model.time, 0)

    def test_growth_with_own_modules_is_refused(self):
        class Nothing(sprekk.Module):
            name = "nothing"

            def blocks(self, mesh):
                return [sprekk.Block("cells", ["displacement"], ["displacement"], lambda x, state: {})]
        model = sprekk.Model(sprekk.Scene(ROOT / "xml/growth/wing_cracks_2d.xml"), modules=[Nothing()])
        with self.assertRaisesRegex(sprekk.Error, 'Growth: run.. cannot extend fractures of a Model with "modules"'):
            model.run()
        self.assertEqual(model.time, 0)


class Growth(unittest.TestCase):
    ENTRIES = ["Mesh.lower corner={0, -4}", "Mesh.upper corner={2, 4}", "Mesh.cells={10, 40}", "Growth.segment=0.1", "Output.vtu=false",
               "Fractures.crack.toughness=1e6*(1 + 4*(x - 0.6))", "Time.schedule={1.4, 1.7}",
               *(f"Boundary conditions.{side}.{entry}" for side in ("west", "east") for entry in (f"boundary={side}", "displacement={0, free}"))]

    def test_run_extends_fractures_as_the_program(self):
        """Tips, energies and directions of run() and of its files are those of the program; older fields are stale."""
        scene = sprekk.Scene(ROOT / "xml/growth/edge_crack_2d.xml", self.ENTRIES)
        with tempfile.TemporaryDirectory() as folder:
            model = sprekk.Model(scene)
            before, cells = model.field("displacement"), model.mesh.n_owned_cells
            seen, fields = [], [before]

            def look(model, step):
                seen.append(model.fractures()["area"]["crack"])
                fields.append(model.field("displacement"))
            model.run(look, output=f"{folder}/python")
            for field in fields[:-1]:
                with self.assertRaises(sprekk.StaleField):
                    field[0]
            self.assertGreater(model.mesh.n_owned_cells, cells)
            (Path(folder) / "scene.xml").write_text(scene.to_xml())
            done = subprocess.run([PROGRAM, "run", f"{folder}/scene.xml", "--output", f"{folder}/program"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            one, other = (sprekk.Results(f"{folder}/{name}").points("growth") for name in ("python", "program"))
            np.testing.assert_allclose(one.drop(columns="fracture"), other.drop(columns="fracture"), rtol=1e-9, atol=1e-12)
            self.assertEqual(set(one["fracture"]), {"crack"})
            self.assertEqual(set(one["time"]), {1.7})
            self.assertAlmostEqual(one["length"].sum(), seen[-1] - 0.6, delta=1e-12)
            self.assertAlmostEqual(one["x"].max(), 0.6 + one["length"].sum(), delta=0.01)
            for x, y in zip(one["x"], one["y"]):  # final positions, after turns
                self.assertIn(f'"crack" has grown by 0.1 m to ({x:.6g}, {y:.6g})', done.stdout)


def opening(model):
    """Returns the values measured in a sweep."""
    return {"slip": float(np.max(model.output("slip"))), "process": os.getpid()}


class Sweeps(unittest.TestCase):
    def test_a_study_that_goes_on(self):
        name = "Materials.joint.friction coefficient"
        measure = f"{__file__}:opening"
        with tempfile.TemporaryDirectory() as folder:
            table = sprekk.sweep(PUSH, {name: [0.1, 0.5], "Time.steps": [1, 2]}, measure, processes=2, folder=folder)
            self.assertEqual(list(table[name]), [0.1, 0.1, 0.5, 0.5])
            again = sprekk.sweep(PUSH, {name: [0.1, 0.5, -1]}, measure, processes=2, folder=folder)
        self.assertEqual(list(again["process"][:2]), list(table["process"][::2]))  # not run again
        self.assertIn("must be at least 0", again["error"][2])
        self.assertEqual(len(set(table["process"])), 4)
        alone = sprekk.Model(sprekk.Scene(PUSH, {name: 0.1}))
        alone.run()
        self.assertEqual(table["slip"][0], np.max(alone.output("slip")))

    def test_what_another_process_cannot_find(self):
        with self.assertRaisesRegex(sprekk.Error, "cannot find"):
            sprekk.sweep(PUSH, {}, lambda model: {})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
