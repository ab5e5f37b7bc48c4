#!/usr/bin/env python3
"""Output and exit status of the program: command_line_test.py PROGRAM ROOT MPIEXEC

An error ends the program on all ranks with status 1. It is reported once, with the file, the place, the value and the
allowed values."""
import re

from program import ROOT, ProgramTest, main

PUSH = "seed/push_2d.xml"
MOVED = "Boundary conditions.moved.displacement"


class Errors(ProgramTest):
    def expect_error(self, scene, words, *overrides, command="run", on_two=False):
        """Checks for status 1 and one message with all words, on 1 rank; with `on_two` also on 2 ranks."""
        sets = [word for override in overrides for word in ("--set", override)]
        output = ["--output", "out"] if command == "run" else []
        for ranks in (1, 2) if on_two else (1,):
            with self.subTest(ranks=ranks, scene=str(scene), overrides=overrides):
                out, err = self.call(command, scene, *output, *sets, ranks=ranks, expect=1)
                self.assertRegex(out, r"\A(sprekk .* on \d ranks?\n)?\Z" if command == "run" else r"\A\Z")
                self.assertEqual(err.count("sprekk: "), 1, err)
                lines = err.splitlines()
                self.assertEqual(len(lines), len(set(lines)), err)
                for word in words:
                    self.assertIn(word, err)

    def changed(self, old, new, name=PUSH):
        """Writes a scene with replaced text; returns its path."""
        text = self.scene(name).read_text()
        self.assertIn(old, text)
        path = self.folder / "changed.xml"
        path.write_text(text.replace(old, new))
        return path

    def test_missing_file(self):
        self.expect_error("absent.xml", ["absent.xml", "no such file"], on_two=True)

    def test_folder_in_place_of_a_file(self):
        self.expect_error(".", ["is a folder"])

    def test_malformed_xml(self):
        self.expect_error(self.changed("</ParameterList>\n</ParameterList>", "</ParameterList>"), ["changed.xml", "not well-formed"])
        self.expect_error(self.changed('name="Mesh"', 'name="Mesh'), ["changed.xml", "not well-formed", "line"], on_two=True)

    def test_wrong_root(self):
        self.expect_error(self.changed('name="Sprekk"', 'name="Speck"'), ["changed.xml", '"Speck"', '"Sprekk"'])

    def test_unknown_name(self):
        self.expect_error(self.changed('"friction coefficient"', '"friction coeficient"'),
                          ["changed.xml", "Sprekk > Materials > joint", '"friction coeficient"', "unknown",
                           'Did you mean "friction coefficient"?'])

    def test_unknown_section(self):
        self.expect_error(self.changed('name="Bulk"', 'name="Bluk"'), ["changed.xml", '"Bluk"', 'Did you mean "Bulk"?'])

    def test_name_of_an_override(self):
        self.expect_error(self.scene(PUSH), [PUSH, '"tolerence"', 'Did you mean "tolerance"?'], "Solver.tolerence=1e-6")

    def test_wrong_type(self):
        self.expect_error(self.changed('type="double" value="1e-5"', 'type="string" value="soft"'),
                          ["changed.xml", "Sprekk > Materials > joint", '"tangential stiffness"', '"soft"', "unknown name"])
        self.expect_error(self.changed('type="double" value="1"/>\n    <Parameter name="steps"', 'type="string" value="soon"/>\n    <Parameter name="steps"'),
                          ["changed.xml", "Sprekk > Time", '"end"', '"soon"', "number"])
        self.expect_error(self.changed('type="double" value="1e-5"', 'type="double" value="soft"'),
                          ["changed.xml", '"tangential stiffness"', "soft"])

    def test_out_of_range(self):
        self.expect_error(self.scene(PUSH), [PUSH, "Sprekk > Materials > joint", '"friction coefficient"', "-1", "at least 0"],
                          "Materials.joint.friction coefficient=-1")
        self.expect_error(self.scene(PUSH), [PUSH, "Sprekk > Solver", '"maximum iterations"', "0", "at least 1"],
                          "Solver.maximum iterations=0")

    def test_missing_entry(self):
        line = '    <Parameter name="cells" type="Array(int)" value="{2, 2}"/>\n'
        self.expect_error(self.changed(line, ""), ["changed.xml", "Sprekk > Mesh", '"cells"', "missing"])

    def test_several_errors_are_reported_together(self):
        self.expect_error(self.scene(PUSH), ['"tolerence"', '"friction coefficient"'], "Solver.tolerence=1",
                          "Materials.joint.friction coefficient=-1", on_two=True)

    def test_all_that_is_wrong_is_reported_at_once(self):
        path = self.folder / "wrong.xml"
        text = (ROOT / "docs" / "shear_test.xml").read_text()
        for old, new in (('value="0.25"', 'value="O.25"'),
                         ('name="steps" type="int" value="20"', 'name="steps" type="integer" value="20"'),
                         ('name="dilation angle" type="double" value="5 deg"', 'name="dilation angle" type="double" value="5 m"'),
                         ('value="50 GPa"', 'value="50 GPaa"'),
                         ('name="tolerance"', 'name="tolerence"'),
                         ('<Parameter name="every" type="int" value="5"/>', '<Parameter name="vtu" type="bool" value="true"/><foo/>'),
                         ('{2e-3*ramp(t), free}', '{2e-3*rampp(t), sin(y) +}'),
                         ('{0, -5 MPa}', '{0, -5 MPa, 1}'),
                         ('name="boundary" type="string" value="south"', 'name="boundary" type="string" value="suth"'),
                         ('value="rough joint"/>', 'value="smooth joint"/>'),
                         ('value="{0, 0.5}"', 'value="{0, 0.55}"')):
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        path.write_text(text)
        _, err = self.call("check", path, "--set", "Time.end=1 m", "--set", "Time.end.x=1", expect=1)
        lines = err.splitlines()
        for words in (['"Time.end.x=1"', "is not a section"], ['"Poisson\'s ratio"', '"O.25"'], ['"steps"', 'type "integer"'],
                      ['"dilation angle"', '"5 m"', '"rad"'], ['"Young\'s modulus"', 'Did you mean "GPa"?'],
                      ['"tolerence"', 'Did you mean "tolerance"?'], ['"vtu"', "twice"], ["Output", "<foo>"],
                      ['"displacement"[0]', '"rampp"', 'Did you mean "ramp"?'], ['"displacement"[1]', '"sin(y) +"'],
                      ['confinement > "traction"', "3 values"], ['"suth"', 'Did you mean "south"?'], ['"smooth joint"'],
                      ['"shear plane"', "on no mesh plane"], ['"end"', '"1 m"', '"day"']):
            with self.subTest(words=words):
                self.assertEqual(sum(all(word in line for word in words) for line in lines), 1, err)
        self.assertEqual(len(lines), 15, err)

    def test_all_conflicts_of_conditions_are_reported(self):
        side = "Boundary conditions.side."
        _, err = self.call("check", ROOT / "docs" / "shear_test.xml", "--set", side + "boundary=west", "--set",
                           side + "displacement={1 mm, 2 mm}", expect=1)
        for component in "xy":
            self.assertEqual(err.count(f'"floor" and "side" prescribe 0 and 0.00{component == "y" and 2 or 1} for component {component}'), 1, err)

    def test_wrong_material(self):
        self.expect_error(self.scene(PUSH), [PUSH, "Bulk", '"material"', '"rok"', '"rock"'], "Bulk.material=rok")
        self.expect_error(self.scene(PUSH), [PUSH, "Bulk", '"material"', '"joint"', '"rock"'], "Bulk.material=joint")
        self.expect_error(self.scene(PUSH), [PUSH, "fracture", '"material"', '"rock"', '"joint"'],
                          "Fractures.fracture.material=rock")

    def test_gravity_without_density(self):
        self.expect_error(self.scene(PUSH), [PUSH, "Materials", "rock", '"density": missing', '"gravity"'],
                          "Bulk.gravity={0, -9.81}")

    def test_wrong_boundary(self):
        self.expect_error(self.scene(PUSH), [PUSH, "moved", '"boundary"', '"top"', '"north"'],
                          "Boundary conditions.moved.boundary=top")

    def test_fracture_off_the_mesh(self):
        self.expect_error(self.scene(PUSH), [PUSH, '"fracture"', "0.4", "0.5"],
                          "Mesh.fractures.fracture.lower corner={0, 0.4}", "Mesh.fractures.fracture.upper corner={1, 0.4}", on_two=True)

    def test_conflict_of_conditions(self):
        for command in ("run", "check"):
            self.expect_error(self.scene(PUSH), [PUSH, '"fixed"', '"third"', "0.5", "(0, 0"],
                              "Boundary conditions.third.boundary=west", "Boundary conditions.third.displacement={0.5, 0}",
                              command=command, on_two=command == "run")

    def test_rock_that_nothing_holds(self):
        for command in ("run", "check"):
            self.expect_error(self.scene(PUSH), [PUSH, "nothing constrains the rock", '"bulk"', "can move along (1, 0)", "periodic"],
                              "Boundary conditions.fixed.displacement={free, 0}", MOVED + "={free, -1}", command=command,
                              on_two=command == "run")

    def test_unknown_function(self):
        self.expect_error(self.scene(PUSH), [PUSH, "moved", '"displacement"', "ramp"], MOVED + "={ramp(t), 0}")

    def test_directory_that_cannot_be_made(self):
        (self.folder / "out").write_text("a file")
        self.expect_error(self.scene(PUSH), ["out", "directory"], on_two=True)

    def test_expression_that_fails_later(self):
        for ranks in (1, 2):
            _, err = self.call("run", self.scene(PUSH), "--output", "out", "--set", "Time.end=4", "--set", "Time.steps=4",
                               "--set", MOVED + "={t, -sqrt(2.5-t)}", ranks=ranks, expect=1)
            self.assertEqual(err.count("sprekk: "), 1, err)
            for word in (PUSH, "moved", '"displacement"[1]', "-sqrt(2.5-t)", "t = 3", "finite"):
                self.assertIn(word, err)
            results = self.results()
            self.assertEqual(results["status"], "failed")
            self.assertIn("sqrt", results["reason"])
            self.assertEqual([step["time"] for step in results["steps"]], [1, 2])
            pvd = (self.folder / "out" / "bulk.pvd").read_text()
            self.assertEqual(pvd.count("<DataSet"), 2)

    def test_table_that_ends_too_early(self):
        for ranks in (1, 2):
            _, err = self.call("run", self.scene(PUSH), "--output", "out", "--set", "Time.end=4", "--set", "Time.steps=4",
                               "--set", MOVED + "={short(t), -1}", "--set", "Tables.short.arguments={0, 1, 2.5}",
                               "--set", "Tables.short.values={0, 1, 2}", ranks=ranks, expect=1)
            self.assertEqual(err.count("sprekk: "), 1, err)
            for word in (PUSH, '"displacement"[0]', "short(t)", "argument 3", "[0, 2.5]"):
                self.assertIn(word, err)
            self.assertEqual([step["time"] for step in self.results()["steps"]], [1, 2])


class Commands(ProgramTest):
    def test_version(self):
        """The version of CMakeLists.txt, which the citation and the changelog repeat, and the commit."""
        read = lambda path: (ROOT / path).read_text()
        version = re.search(r"^project\(Sprekk VERSION (\S+)", read("CMakeLists.txt"), re.M)[1]
        out, _ = self.call("--version")
        self.assertRegex(out, rf"^sprekk {re.escape(version)} \(commit ([0-9a-f]{{7,}}(-dirty)?|unknown)\)\n$")
        self.assertIn(f"\nversion: {version}\n", read("CITATION.cff"))
        self.assertEqual(version, re.search(r"^## (\S+)", read("CHANGELOG.md"), re.M)[1])

    def test_help(self):
        out, err = self.call("--help")
        for word in ("run", "check", "reference"):
            self.assertIn(word, out)
        self.assertNotIn("kokkos", (out + err).lower())
        out, err = self.call("run", "--help")
        for word in ("--set", "--output"):
            self.assertIn(word, out)
        self.assertNotIn("kokkos", (out + err).lower())

    def test_misuse_has_status_2(self):
        for arguments in ([], ["walk"], ["run"], ["check"], ["run", self.scene(PUSH), "--sett", "a=1"], ["--verbos"],
                          ["reference", "more"]):
            with self.subTest(arguments=arguments):
                self.call(*arguments, expect=2)
        self.call("walk", ranks=2, expect=2)

    def test_numbers_of_safety(self):
        slope = self.scene("slopes/plane_2d.xml")
        for option, allowed in (("--tolerance", "1e-12 to 1"), ("--first", "1e-06 to 1e+06"), ("--max", "1 to 1e+06")):
            for value in ("nan", "-1", "inf", "x", "1e9"):
                _, err = self.call("safety", slope, option, value, expect=2)
                self.assertEqual(err.count("\n"), 1, err)
                for word in (option, value, allowed):
                    self.assertIn(word, err)

    def test_reference_lists_all_parameters(self):
        out, _ = self.call("reference")
        for word in ("Sprekk > Mesh", "Sprekk > Solver > Linear solver", "friction coefficient", "tangential stiffness",
                     "Pa/m", "boundary", "maximum halvings"):
            self.assertIn(word, out)
        self.assertGreater(sum(line.startswith("|") for line in out.splitlines()), 40)

    def test_mesh_info(self):
        meshes = ROOT / "tests" / "data" / "meshes"
        flat, _ = self.call("mesh-info", meshes / "x_order1_v41.msh", "--fractures", "f1,f2")
        self.assertEqual(self.call("mesh-info", meshes / "x_order1_v41.msh", "--fractures", " f1, f2")[0], flat)
        for line in ("cells         82 triangles of order 1", "nodes         65, 7 of them copies along fractures",
                     'region        "rock": 82 cells, area 16', 'boundary      "south": 8 faces, length 4',
                     'fracture      "f1": 4 faces, length 3.2', "tips          4 points", "intersections 1 points",
                     "vectors       130 components at nodes, 32 at bubbles, 16 on fracture faces"):
            self.assertIn(line, flat.splitlines())
        solid, _ = self.call("mesh-info", meshes / "triple_order2.msh", "--fractures", "f1,f2,f3", ranks=2)
        for line in ("cells         120 tetrahedra of order 2", 'boundary      "top": 4 faces, area 4',
                     'fracture      "f3": 8 faces, area 2.25', "tips          24 edges with 18 corners",
                     "intersections 6 edges, which meet in 1 points",
                     "vectors       702 components at nodes, 144 at bubbles, 72 on fracture faces"):
            self.assertEqual(solid.splitlines().count(line), 1, line)
        hexahedra, _ = self.call("mesh-info", meshes / "hexahedra.msh", "--fractures", "f1,f2")
        self.assertIn("32 hexahedra of order 1", hexahedra)
        self.assertRegex(hexahedra, "quality       largest ratio of edges 1 in cell 0, smallest scaled Jacobian 1 in cell")

    def test_check(self):
        for name in (PUSH, "seed/immersed_3d.xml", "verification/crossing_3d.xml", "verification/uniaxial_2d.xml"):
            out, err = self.call("check", self.scene(name))
            n = len(err.splitlines())
            self.assertTrue(out.endswith(f"{name}: no errors{f', {n} warning{chr(115) * (n > 1)}' if n else ''}\n"), out)
            if name in (PUSH, "verification/uniaxial_2d.xml"):
                self.assertEqual(err, "")
            else:  # unrealistic loads and friction
                self.assertTrue(err and all(line.startswith("warning: ") for line in err.splitlines()), err)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_hint_on_order_1_at_fronts(self):
        """The hint appears in 3D for fractures that end inside the rock."""
        hint, coarse = "fractures end inside of the rock", "Mesh.cells={6, 6, 6}"
        for scene, overrides, times in (("seed/immersed_3d.xml", [coarse], 1), ("seed/immersed_3d.xml", [coarse, "Mesh.tips=plain"], 1),
                                        ("seed/immersed_3d.xml", [coarse, "Mesh.order=2"], 0), ("seed/push_3d.xml", [], 0),
                                        ("seed/immersed_2d.xml", [], 0)):
            sets = [word for override in overrides for word in ("--set", override)]
            _, err = self.call("run", self.scene(scene), "--output", "out", "--set", "Output.vtu=false", *sets, ranks=1 + times)
            self.assertEqual(err.count(hint), times, err)
            self.assertEqual(err.count('cells of "order" 1; 2 is more accurate'), times, err)

    def test_default_output(self):
        self.call("run", self.scene(PUSH))
        self.assertTrue((self.folder / "output" / "push_2d" / "results.json").exists())

    def test_default_output_of_variants(self):
        """Each variant has its own output directory, as printed by `directory`."""
        variants = [["Materials.joint.friction coefficient=0.5"], ["Materials.joint.friction coefficient=0.25"],
                    [MOVED + "={1, -1}"], [MOVED + "={1, -2}"], ["Time.steps=2", "Time.end=3"], [MOVED + "={" + "0+" * 100 + "1, -1}"]]
        names = set()
        for variant in variants:
            sets = [word for override in variant for word in ("--set", override)]
            name = self.call("directory", self.scene(PUSH), *sets)[0].strip()
            self.assertRegex(name, r"^output/push_2d-[\w.=+-]+$")
            self.assertLess(len(name), 130)
            names.add(name)
            self.call("run", self.scene(PUSH), *sets)
            self.assertEqual({"output/" + path.name for path in (self.folder / "output").iterdir()}, names)
        self.assertIn("output/push_2d-Materials.joint.friction_coefficient=0.5", names)
        self.assertEqual(len(names), len(variants))
        self.assertEqual(self.call("directory", self.scene(PUSH))[0], "output/push_2d\n")


if __name__ == "__main__":
    main()
