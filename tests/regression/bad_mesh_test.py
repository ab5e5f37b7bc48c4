#!/usr/bin/env python3
"""Error messages for bad mesh files and meshes beyond the memory, see bad_input.py."""
import os
import random

from bad_input import BadInput, FRACTURE, PUSH, replaced, setUpModule  # noqa: F401
from program import main

SQUARES = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
1 1 "f1"
1 2 "south"
1 3 "north"
1 5 "outer"
2 4 "rock"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
6
10 3 2 4 1 1 2 5 4
11 3 2 4 1 2 3 6 5
20 1 2 1 1 2 5
21 1 2 2 2 1 2
22 1 2 3 3 4 5
23 1 2 5 5 1 4
$EndElements
"""
CUBES = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
$EndNodes
$Elements
1
1 5 2 1 1 1 2 3 4 5 6 7 8
$EndElements
"""

class Meshes(BadInput):
    def test_sound_one(self):
        """A valid mesh gives no error, as a check of the other tests."""
        with self.assertRaises(AssertionError) as caught:
            self.refuse_mesh([], SQUARES)
        self.assertIn("scene.xml: no errors", str(caught.exception))

    def test_files(self):
        self.refuse_mesh(["a.msh: there is no such file"], None)
        self.refuse_mesh(["a.msh: is empty"], "")
        self.refuse_mesh(["a.msh: line 1: found ", "expected $MeshFormat"], random.Random(1).randbytes(3000))
        (self.folder / "a.msh").unlink()
        (self.folder / "a.msh").mkdir()
        self.refuse_mesh(["a.msh: is a folder, expected a gmsh mesh"], None)
        self.refuse(["/dev/zero: is a device"], "mesh-info", "/dev/zero")
        (self.folder / "a.msh").rmdir()
        os.mkfifo(self.folder / "a.msh")
        self.refuse_mesh(["a.msh: is a device, pipe or socket"], None)

    def test_unreadable_file(self):
        if os.geteuid() == 0:
            self.skipTest("root reads everything")
        (self.folder / "a.msh").write_text(SQUARES)
        (self.folder / "a.msh").chmod(0)
        self.refuse_mesh(["a.msh: cannot be read"], None)

    def test_truncated(self):
        meshes = self.scene("../tests/data/meshes")
        for name in ("x_order1_v22", "x_order1_v22_binary", "x_order1_v41", "x_order1_v41_binary"):
            whole = (meshes / f"{name}.msh").read_bytes()
            for part in (0.4, 0.9):
                self.refuse_mesh(["a.msh: $"], whole[:int(part * len(whole))])

    def test_versions(self):
        for version in ("1.0", "4.0", "3", "99"):
            self.refuse_mesh(["a.msh: $MeshFormat, line 2", f"format {version}", "2.2 and 4.1"],
                             replaced(SQUARES, ("2.2 0 8", version + " 0 8")))
        self.refuse_mesh(["format 1;", "2.2 and 4.1"], "$NOD\n1\n1 0 0 0\n$ENDNOD\n")

    def test_huge(self):
        self.refuse_mesh(["$Nodes, line 13: the number of nodes is 1000000000, which the rest of the file"],
                         replaced(SQUARES, ("\n6\n1 0 0 0", "\n1000000000\n1 0 0 0")))
        (self.folder / "a.msh").write_bytes(b"x")
        os.truncate(self.folder / "a.msh", 1 << 40)  # sparse file
        self.refuse_mesh(["a.msh: line 1: found \"x??", "expected $MeshFormat"], None)
        (self.folder / "a.msh").write_text(SQUARES)
        os.truncate(self.folder / "a.msh", 1 << 43)
        self.refuse_mesh([f"a.msh: has {1 << 43} bytes", "the memory of this machine"], None)

    def test_elements(self):
        cell = "10 3 2 4 1 1 2 5 4"
        self.refuse_mesh(["element 10: is a 6-node prism", "Sprekk reads"], replaced(SQUARES, (cell, "10 6 2 4 1 1 2 5 4")))
        self.refuse_mesh(["element 10: is a 5-node pyramid"], replaced(SQUARES, (cell, "10 7 2 4 1 1 2 5 4")))
        self.refuse_mesh(["element 10 is a 4-node quadrilateral and element 11 a 3-node triangle", "one shape"],
                         replaced(SQUARES, ("11 3 2 4 1 2 3 6 5", "11 2 2 4 1 2 3 6")))
        self.refuse_mesh(["element 10 occurs twice"], replaced(SQUARES, ("11 3 2 4", "10 3 2 4")))
        self.refuse_mesh(["$Nodes: node 5 occurs twice"], replaced(SQUARES, ("\n4 0 1 0", "\n5 0 1 0")))
        self.refuse_mesh(["element 10 has node 9, which is not in $Nodes"], replaced(SQUARES, (cell, "10 3 2 4 1 1 2 9 4")))
        for x in ("nan", "inf", "1e+200"):
            self.refuse_mesh(["$Nodes, line 18: node 5: x is ", x, "must be a number"],
                             replaced(SQUARES, ("\n5 1 1 0", f"\n5 {x} 1 0")))
        self.refuse_mesh(["element 10 at (0, 0, 0) has no volume"],
                         replaced(SQUARES, ("\n4 0 1 0\n5 1 1 0", "\n4 3 0 0\n5 4 0 0")))
        self.refuse_mesh(["element 10 at (0, 0, 0) is twisted"], replaced(SQUARES, (cell, "10 3 2 4 1 1 5 2 4")))
        self.refuse_mesh(["physical group 4: its name \"r?ck\" is not UTF-8"],
                         SQUARES.replace("rock", "r\xf8ck").encode("latin-1"))

    def test_inside_out_cells_are_mirrored(self):
        (self.folder / "a.msh").write_text(replaced(CUBES, ("1 2 3 4 5 6 7 8", "5 6 7 8 1 2 3 4")))
        mirrored, _ = self.call("mesh-info", "a.msh")
        (self.folder / "a.msh").write_text(CUBES)
        self.assertEqual(self.call("mesh-info", "a.msh")[0], mirrored)

    def test_conformity(self):
        hanging = replaced(SQUARES, ("\n6\n1 0 0 0", "\n8\n7 1 .5 0\n8 2 .5 0\n1 0 0 0"), ("\n6\n10", "\n6\n12 3 2 4 1 7 8 6 5\n10"),
                           ("11 3 2 4 1 2 3 6 5", "11 3 2 4 1 2 3 8 7"), ("20 1 2 1 1 2 5\n", ""))
        self.refuse_mesh(["elements 12 and 10 touch at (1, 0.5, 0)", "without sharing nodes"], hanging, fractures="")
        apart = replaced(SQUARES, ("\n6\n1 0 0 0", "\n8\n7 1 0 0\n8 1 1 0\n1 0 0 0"), ("11 3 2 4 1 2 3 6 5", "11 3 2 4 1 7 3 6 8"))
        self.refuse_mesh(["elements 10 and 11 touch at (1, 0.5, 0) without sharing nodes"], apart)
        third = replaced(SQUARES, ("\n6\n1 0 0 0", "\n8\n7 3 0 0\n8 3 1 0\n1 0 0 0"), ("\n6\n10", "\n7\n12 3 2 4 1 2 7 8 5\n10"))
        self.refuse_mesh(["elements 12, 10 and 11 share the face at (1, 0.5, 0); at most two may"], third)
        twice = replaced(SQUARES, ("\n6\n10", "\n7\n12 3 2 4 1 1 2 5 4\n10"))
        self.refuse_mesh(["elements 12, 10 and 11 share the face"], twice)

    def test_other_diagonal(self):
        """Two tetrahedra meet two others at a square with a different diagonal.

        The mesh is rejected; equal diagonals are valid."""
        nodes = "\n7\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 .5 1\n6 .5 .5 -1\n7 9 9 9\n"
        below = {"same": ("1 3 2 6", "1 4 3 6"), "other": ("1 4 2 6", "2 4 3 6")}
        for name, (a, b) in below.items():
            (self.folder / "a.msh").write_text(
                f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes{nodes}$EndNodes\n$Elements\n4\n1 4 0 1 2 3 5\n2 4 0 1 3 4 5\n"
                f"3 4 0 {a}\n4 4 0 {b}\n$EndElements\n")
            if name == "same":
                self.call("mesh-info", "a.msh")
            else:
                self.refuse(["a.msh: elements ", "touch at", "without sharing nodes"], "mesh-info", "a.msh")

    def test_fractures(self):
        named = FRACTURE.replace("f1", "F-1")
        self.refuse_mesh(['fracture "F-1": unknown', '"f1", "south"', 'Did you mean "f1"?'], SQUARES, named)
        self.refuse_mesh(['element 23 at (0, 0.5, 0) of the fracture "outer" lies on the boundary'], SQUARES,
                         FRACTURE.replace("f1", "outer").replace("/></", '/><ParameterList name="f1"/></'))
        self.refuse_mesh(['element 20 at (1, 0, 0) of the physical group "f1" is no face of a cell'],
                         replaced(SQUARES, ("20 1 2 1 1 2 5", "20 1 2 1 1 2 4")))
        outside = replaced(SQUARES, ("\n6\n1 0 0 0", "\n7\n7 1 2 0\n1 0 0 0"), ("20 1 2 1 1 2 5", "20 1 2 1 1 5 7"))
        self.refuse_mesh(['element 20 at (1, 1, 0) of the physical group "f1" is no face of a cell'], outside)
        self.refuse_mesh(['element 20 at (1, 0.5, 0) of the physical group "f1" lies inside', 'if it is a fracture, list "f1" among the fractures',
                          'boundaries are "south", "north", "outer"'], SQUARES, fractures="")
        self.refuse(['of the physical group "f2" lies inside', 'as do faces of "f1"', 'list "f1", "f2" among', 'boundaries are "south", "east", "north", "west"'],
                    "mesh-info", self.scene("gmsh/crossing.msh"))

    def test_names_that_the_mesh_lacks(self):
        moved = "Boundary conditions.moved.boundary"
        self.refuse_mesh(['moved > "boundary"', '"nort"', '"north"', 'Did you mean "north"?'], SQUARES,
                         options=["--set", moved + "=nort"])
        self.refuse_mesh(['Regions > "rok"', 'Did you mean "rock"?'], SQUARES, options=["--set", "Regions.rok.material=rock"])
        self.refuse_mesh(['Fractures > "f2"', 'Did you mean "f1"?'], SQUARES, options=["--set", "Fractures.f2.material=joint"])



class Memory(BadInput):
    def test_mesh_beyond_memory(self):
        done = self.limited("check", self.scene(PUSH), "--set", "Mesh.cells={30000, 30000}", memory=16 << 30)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r'^sprekk: .*push_2d.xml: Sprekk > Mesh: .*cells: \{30000, 30000\} makes 9e\+08 cells, '
                                      'which alone take 43.2 GB; there are .* GB: take fewer, and "refinements"')

    def test_end_of_memory(self):
        """A large mesh under a memory limit gives an error.

        The limit is found with a small run, since it depends on the machine.

        OpenBLAS retries without end if there is no memory for its buffers."""
        scene = self.scene(PUSH)
        enough = next(limit for limit in range(256 << 20, 64 << 30, 256 << 20)
                      if self.limited("check", scene, memory=limit, seconds=60).returncode == 0)
        done = self.limited("run", scene, "--set", "Mesh.cells={1500, 1500}", "--set", "Output.vtu=false", memory=enough + (256 << 20))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, "out of memory: this process has taken .* GB; take fewer cells, or more machines")
        self.assertNotIn("bad_alloc", done.stderr)


if __name__ == "__main__":
    main()
