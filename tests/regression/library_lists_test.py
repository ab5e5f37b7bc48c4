#!/usr/bin/env python3
"""Parameter lists for Trilinos and MUMPS: library_lists_test.py PROGRAM ROOT MPIEXEC

Unknown or invalid entries of a library end the run before the first step, with one message and the place in the scene.
Valid entries take effect."""
from program import ProgramTest, main

PUSH = "seed/push_2d.xml"
BELOS, NOX, BLOCK = "Solver.Linear solver.Belos.", "Solver.NOX.", "Solver.Blocks.displacement."
MUELU, IFPACK2 = BLOCK + "MueLu.", BLOCK + "Ifpack2."
IN_BLOCK = "Solver > Blocks > displacement > "


class Lists(ProgramTest):
    def call_with(self, *overrides, ranks, expect, kind="iterative"):
        sets = [word for override in (f"Solver.Linear solver.type={kind}", *overrides) for word in ("--set", override)]
        return self.call("run", self.scene(PUSH), "--output", "out", "--quiet", *sets, ranks=ranks, expect=expect)

    def refuse(self, words, *overrides, kind="iterative", ranks=(1, 2)):
        for n in ranks:
            with self.subTest(overrides=overrides, ranks=n):
                err = self.call_with(*overrides, ranks=n, expect=1, kind=kind)[1]
                self.assertEqual((err.count("sprekk: "), err.count("\n")), (1, 1), err)
                self.assertNotIn("friction", err)
                for word in words:
                    self.assertIn(word, err)
                self.assertFalse((self.folder / "out/results.json").exists() and self.results()["steps"], "a step was made")

    def test_muelu(self):
        muelu = (BLOCK + "type=MueLu",)
        self.refuse([IN_BLOCK + 'MueLu > smoother: params > "chebyshev: degre": CHEBYSHEV does not read this parameter'],
                    *muelu, MUELU + "smoother: params.chebyshev: degre=3")
        for entry, words in (("smoother: params.chebyshev: degree=many", ["MueLu > smoother: params: ", '"chebyshev: degree"', '"int"']),
                             ("level 1.smoother: tpe=RELAXATION", ['MueLu > level 1 > "smoother: tpe": no such parameter. Did you mean "smoother: type"?']),
                             ("level 1.smoother: params.chebyshev: foo=1", ['MueLu > level 1 > smoother: params > "chebyshev: foo": CHEBYSHEV does not']),
                             ("smother: type=RELAXATION", ['MueLu > "smother: type": no such parameter. Did you mean "smoother: type"?']),
                             ("smoother: type=RELAXATIO", ["MueLu: ", "does not provide the smoother 'RELAXATIO'"]),
                             ("multigrid algorithm=saa", ['MueLu: Unknown "multigrid algorithm" value: "saa"']),
                             ("aggregation: drop tol=small", ['MueLu: Error, the parameter {name="aggregation: drop tol",type="string"']),
                             ("coarse: type=Kluu", ['MueLu > "coarse: type": is "Kluu", which neither Amesos2 nor Ifpack2 has']),
                             ("coarse: params.foo=3", ['MueLu > coarse: params > "foo": no such parameter; there are "fix nullspace"'])):
            self.refuse([IN_BLOCK, *words], *muelu, MUELU + entry, ranks=(1,))

    def test_ifpack2(self):
        def refuse(words, method, *entries, ranks=(1,)):
            self.refuse([IN_BLOCK + "Ifpack2", *words], BLOCK + "type=Ifpack2", IFPACK2 + "type=" + method, *(IFPACK2 + e for e in entries), ranks=ranks)
        inner = "schwarz: inner preconditioner parameters"
        refuse(['{name="relaxation: typ"'], "RELAXATION", "relaxation: typ=Jacobi")
        refuse(['"relaxation: type"', '"Jacob" is not recognized'], "RELAXATION", "relaxation: type=Jacob")
        refuse(['"RELAXATIO"'], "RELAXATIO")
        refuse([f'> {inner} > "fact: ilut level": ILUT does not read this parameter'], "SCHWARZ", inner + ".fact: ilut level=2.0", ranks=(1, 2))
        refuse(['> "schwarz: overlap levl": no such parameter; there are ', '. Did you mean "schwarz: overlap level"?'], "SCHWARZ", "schwarz: overlap levl=1")
        refuse([": the library cannot be set up with these parameters: ", '"ILUTT"'], "SCHWARZ",
               "schwarz: inner preconditioner name=ILUTT", ranks=(1, 2))

    def test_belos(self):
        place = "Sprekk > Solver > Linear solver > Belos"
        for entry, words in (("foo.bar=3", [' > "foo": no such parameter; there are "Adaptive Block Size"']),
                             ("Num Block=9", ['. Did you mean "Num Blocks"?']),
                             ("Orthogonalization=foo", [': Invalid orthogonalization manager name', '"ICGS"']),
                             ("Implicit Residual Scaling=foo", [': ', 'Invalid residual scaling type "foo"']),
                             ("Verbosity=foo", [': ', '"Verbosity" of type "string"']),
                             ("Solver Type=foo", [' > "Solver Type": Belos has no solver "foo"; it has ', '"PSEUDO BLOCK CG"'])):
            for kind in ("iterative", "direct"):
                self.refuse([place + words[0], *words[1:]] if words[0][0] in " :" else [place, *words], BELOS + entry, kind=kind,
                            ranks=(1, 2) if entry.startswith("Orth") else (1,))

    def test_mumps(self):
        for kind in ("iterative", "direct"):
            self.refuse(['MUMPS > "ICNTL(99)": is the integer 3; there are ICNTL(1) to ICNTL(60)'], "Solver.Linear solver.MUMPS.ICNTL(99)=3",
                        kind=kind, ranks=(1,))

    def test_nox(self):
        for entry in ("Printing.foo=1", "foo=1"):
            self.refuse(['"foo": NOX does not read this parameter here'], NOX + entry)

    def test_what_is_right_is_taken(self):
        muelu = BLOCK + "type=MueLu"
        for overrides in ((muelu, MUELU + "smoother: type=RELAXATION", MUELU + "smoother: params.relaxation: type=Jacobi",
                           MUELU + "level 1.smoother: params.relaxation: sweeps=2", MUELU + "coarse: type=RELAXATION",
                           MUELU + "coarse: params.relaxation: sweeps=4", MUELU + "coarse: max size=100"),
                          (muelu, MUELU + "coarse: type=Klu", MUELU + "coarse: params.fix nullspace=false"),
                          (muelu, MUELU + "smoother: type=SCHWARZ", MUELU + "smoother: params.subdomain solver name=RILUK",
                           MUELU + "smoother: params.subdomain solver parameters.fact: iluk level-of-fill=1"),
                          (BLOCK + "type=Ifpack2", IFPACK2 + "type=SCHWARZ", IFPACK2 + "schwarz: overlap level=1",
                           IFPACK2 + "inner preconditioner name=ILUT", IFPACK2 + "inner preconditioner parameters.fact: ilut level-of-fill=4.0"),
                          (BELOS + "Orthogonalization=IMGS", BELOS + "Solver Type=Flexible GMRES", BELOS + "Verbosity=127"),
                          (NOX + "Printing.Output Precision=3",)):
            for ranks in (1, 2):
                with self.subTest(overrides=overrides, ranks=ranks):
                    self.call_with(*overrides, ranks=ranks, expect=0)


if __name__ == "__main__":
    main()
