#!/usr/bin/env python3
"""All error messages of a bad scene together, see bad_input.py."""
from bad_input import BadInput, PUSH, replaced, setUpModule  # noqa: F401
from program import main


class AllAtOnce(BadInput):
    """Errors in entries, names, the mesh and conditions are reported together, without consequential errors."""

    def refuse_all(self, lines, *arguments):
        """Checks that each line begins with the name of the scene, and contains the words of one item of `lines`."""
        for command in ("check", "run"):
            err = self.refuse([], command, *arguments)
            reported = err.removeprefix("sprekk: ").splitlines()
            self.assertEqual(len(reported), len(lines), err)
            for words in lines:
                self.assertEqual(sum(all(word in line for word in words) for line in reported), 1, (words, err))
            for line in reported:
                self.assertTrue(line.startswith(f"{arguments[0]}: "), err)

    def sets(self, *overrides):
        return [word for override in overrides for word in ("--set", override)]

    TYPO = "Solver.tolerence=1"
    TYPO_REPORTED = ['"tolerence"', "unknown"]
    CLASH = ("Boundary conditions.third.boundary=south", "Boundary conditions.third.displacement={0.5, free}")
    CLASH_REPORTED = ['"fixed" and "third" prescribe', "component x"]

    def test_box(self):
        scene = self.scene(PUSH)
        conflict = self.sets(self.TYPO, *self.CLASH)
        self.refuse_all([self.TYPO_REPORTED, self.CLASH_REPORTED], scene, *conflict)
        self.refuse_all([self.TYPO_REPORTED, self.CLASH_REPORTED, ['moved > "boundary"', '"nort"'], ['Regions > "rok"', '"bulk"'],
                         ['Bulk > "material"', '"rok"'], ['fourth > "displacement"', "3 values"], ['"density": missing']],
                        scene, *conflict,
                        *self.sets("Boundary conditions.moved.boundary=nort", "Regions.rok.material=rock", "Bulk.material=rok",
                                   "Boundary conditions.fourth.boundary=east", "Boundary conditions.fourth.displacement={0, 0, 0}",
                                   "Bulk.gravity={0, -1}", "Regions.bulk.material=rock"))
        floating = ("Boundary conditions.fixed.displacement={free, 0}", "Boundary conditions.moved.displacement={free, -1}")
        self.refuse_all([self.TYPO_REPORTED, ["nothing constrains the rock"]], scene, *self.sets(self.TYPO, *floating))
        both = ("Boundary conditions.fourth.boundary=north", "Boundary conditions.fourth.displacement={free, 1}")
        self.refuse_all([['"fourth" and "moved" prescribe', "component y"], ["nothing constrains the rock"]], scene, *self.sets(*floating, *both))
        self.refuse_all([self.TYPO_REPORTED, ['"displacement"[1]: "0/(t-1)"', "is nan"]], scene,
                        *self.sets(self.TYPO, "Boundary conditions.moved.displacement={0, 0/(t-1)}"))

    def test_what_only_follows_is_not_reported(self):
        misspelt = self.scene_with(('"Fractures">\n    <ParameterList name="fracture"', '"Fractures">\n    <ParameterList name="fractrue"'))
        self.refuse_all([['Fractures > "fractrue"', 'Did you mean "fracture"?']], misspelt)
        scene = self.scene(PUSH)
        moved = "Boundary conditions.moved."
        unknown = ['moved > "displacment"', "unknown"]
        floating = ("Boundary conditions.fixed.displacement={free, 0}", moved + "displacement={free, -1}")
        self.refuse_all([unknown], scene, *self.sets(*floating, moved + "displacment=1"))  # may be a support
        self.refuse_all([['"endd"', "unknown"]], scene, *self.sets(
            "Time.endd=2", "Boundary conditions.third.boundary=west", "Boundary conditions.third.displacement={t-2, 0}"))
        self.refuse_all([['"cels"', "unknown"]], scene, *self.sets(*self.CLASH, "Mesh.cels={2, 2}"))
        text = self.scene(PUSH).read_text()
        for section in ("Boundary conditions", "Fractures", "Materials"):
            (self.folder / "a.xml").write_text(replaced(text, (f'<ParameterList name="{section}">', f'<ParameterList name="{section}s">')))
            self.refuse_all([[f'"{section}s"', "unknown"]], "a.xml")
        (self.folder / "a.xml").write_text(replaced(text, ('<ParameterList name="Mesh">', '<ParameterList name="Msh">')))
        self.refuse_all([['"Msh"', "unknown"], *[[f'Mesh > "{name}"', "missing"] for name in ("cell", "cells", "lower corner", "upper corner")]],
                        "a.xml")

    def test_mesh_file(self):
        scene = self.scene("gmsh/crossing.xml")
        absent = ("Mesh file.path=absent.msh", ["absent.msh: there is no such file"])
        rok = ("Bulk.material=rok", ['Bulk > "material"', '"rok"'])
        self.refuse_all([absent[1], rok[1], self.TYPO_REPORTED, ['Fractures > "f3"', '"f2"']], scene,
                        *self.sets(absent[0], rok[0], self.TYPO, "Fractures.f3.material=joint"))
        self.refuse_all([absent[1], ['"ordr"', "unknown"]], scene, *self.sets(absent[0], "Mesh file.ordr=1"))
        self.refuse_all([rok[1], self.TYPO_REPORTED, ['third > "boundary"', '"nort"', '"north"'], ['"a" and "held" prescribe', "component x"]], scene,
                        *self.sets(rok[0], self.TYPO, "Boundary conditions.third.boundary=nort", "Boundary conditions.third.traction={0, 0}",
                                   "Boundary conditions.a.boundary=south", "Boundary conditions.a.displacement={1, free}"))


if __name__ == "__main__":
    main()
