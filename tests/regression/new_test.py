#!/usr/bin/env python3
"""The example scenes of `./sprekk new`: new_test.py PROGRAM ROOT MPIEXEC"""
import csv
import io
import subprocess

from program import ROOT, ProgramTest, main

TOPICS = {"first_scene", "direct_shear", "network", "injection", "stimulation", "discs", "doublet", "gallery", "growth", "slope", "point_test"}


class New(ProgramTest):
    def launch(self, *words, expect=0):
        done = subprocess.run([ROOT / "sprekk", "new", *words], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, expect, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout, done.stderr

    def write(self, topic):
        path = self.folder / f"{topic}.xml"
        self.launch(topic, path.name)
        return path

    def run_topic(self, topic, ranks=1):
        """The last step of a run without warnings."""
        path, sets = self.write(topic), []
        if 'name="network"' in path.read_text():
            from networks import mesh_of
            sets = [mesh_of(self.folder, path)]
        _, warnings = self.call("check", path, *(word for entry in sets for word in ("--set", entry)))
        self.assertEqual(warnings, "")
        results = self.run_scene(str(path), *sets, ranks=ranks)
        self.assertEqual(results["status"], "completed")
        return results["steps"][-1]

    def test_list(self):
        lines = self.launch()[0].splitlines()
        self.assertEqual({line.split()[0] for line in lines}, TOPICS)
        for line in lines:
            self.assertGreater(len(line.split()), 5, line)

    def test_scenes_are_short_and_need_no_other_file(self):
        for topic in TOPICS:
            text = (ROOT / "xml" / "new" / f"{topic}.xml").read_text()
            self.assertTrue(25 <= text.count("\n") <= (95 if "bottom" in text else 70), topic)  # six sides in 3D
            self.assertGreaterEqual(text.count("<!--"), 2, topic)
            for entry in ("file", "path"):
                self.assertNotIn(f'<Parameter name="{entry}" type="string"', text)

    def test_words_that_are_refused(self):
        for words in (["slope"], ["slope", "a.xml", "b.xml"], ["../seed/push_2d", "a.xml"], ["", "a.xml"]):
            self.launch(*words, expect=2)
        self.assertIn('"slop"; topics: direct_shear discs doublet', self.launch("slop", "a.xml", expect=2)[1])
        self.assertFalse((self.folder / "a.xml").exists())
        self.assertIn("cannot be written", self.launch("slope", "absent/a.xml", expect=1)[1])
        (self.folder / "mine.xml").write_text("mine")
        self.assertIn("the file exists", self.launch("slope", "mine.xml", expect=1)[1])
        self.assertEqual((self.folder / "mine.xml").read_text(), "mine")

    def test_next_command(self):
        self.assertIn("./sprekk run slope.xml", self.launch("slope", "slope.xml")[0])
        self.assertIn("./sprekk point point.xml", self.launch("point_test", "point.xml")[0])

    def test_first_scene_slides(self):
        self.assertGreater(self.run_topic("first_scene")["fractures"]["fault"]["fraction_slip"], 0.5)

    def test_direct_shear_slides_back(self):
        self.assertEqual(self.run_topic("direct_shear")["fractures"]["joint"]["fraction_slip"], 1)

    def test_network_slides_in_its_steep_set(self):
        fractures = self.run_topic("network")["fractures"]
        self.assertEqual(set(fractures), {"steep set", "flat set"})
        self.assertGreater(fractures["steep set"]["fraction_slip"], 0.5)
        self.assertLess(fractures["flat set"]["fraction_slip"], 0.5)

    def test_injection_slides_and_opens(self):
        fault = self.run_topic("injection", ranks=2)["fractures"]["fault"]
        self.assertTrue(0 < fault["fraction_open"] < 1)
        self.assertGreater(fault["max_slip"], 1e-3)

    def test_stimulation_reaches_other_fractures(self):
        fractures = self.run_topic("stimulation")["fractures"]
        self.assertGreater(fractures["injected"]["max_slip"], 1e-4)
        self.assertGreater(fractures["north-west"]["max_fracture_pressure"], 24.5e6)

    def test_discs_slip_at_the_well(self):
        """The disc with the well slips, below the pressure that opens it; other discs stick, except one that it meets."""
        step = self.run_topic("discs")
        self.assertGreater(step["fractures"]["injected"]["max_slip"], 5e-3)
        self.assertEqual(step["fractures"]["injected"]["fraction_open"], 0)
        self.assertGreater(step["fractures"]["steep"]["fraction_stick"], 0.5)
        self.assertLess(step["wells"]["injector"]["pressure"], 38e6)  # smallest principal compression

    def test_doublet_cools(self):
        """From 150 degrees C, with water of 50."""
        fault = self.run_topic("doublet")["fractures"]["fault"]
        self.assertTrue(273.15 + 50 < fault["mean_fracture_temperature"] < 273.15 + 100)

    def test_growth_turns_to_the_compression(self):
        """Both ends grow; the tips are near the line through the notch along the largest compression."""
        step = self.run_topic("growth")
        crack, tips = step["fractures"]["notch"], step["stress_intensity"]
        self.assertGreater(crack["area"], 3)
        self.assertEqual(crack["fraction_open"], 1)
        for x, y, direction_x, direction_y in zip(tips["x"], tips["y"], tips["kink_x"], tips["kink_y"]):
            self.assertGreater(x * y, 0)
            self.assertTrue(0.4 < direction_y / direction_x < 1.6, (direction_x, direction_y))

    def test_gallery_is_excavated(self):
        roof = self.run_topic("gallery")["fractures"]["roof"]
        self.assertEqual(roof["fraction_open"], 0)
        self.assertGreater(roof["max_slip"], 0)

    def test_slope_has_the_factor_of_safety_of_its_wedge(self):
        """A rigid wedge of weight W on a joint of length L and dip d: F = c L/(W sin d) + tan(phi)/tan(d) = 1.544."""
        self.run_topic("slope")
        out, _ = self.call("safety", self.folder / "slope.xml", "--quiet", "--set",
                           f"Mesh file.path={self.folder / 'network.msh'}")
        self.assertAlmostEqual(float(out.split()[3]), 1.544, delta=0.005)

    def test_point_test_has_a_peak(self):
        out, _ = self.call("point", self.write("point_test"))
        shear = [float(row["traction_t"]) for row in csv.DictReader(io.StringIO(out))]
        self.assertGreater(max(shear), 1.05 * shear[-1])
        self.assertGreater(shear[-1], 0.5e6)


if __name__ == "__main__":
    main()
