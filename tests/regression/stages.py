"""Base of the tests of scenes with stages: scenes of round galleries with exact solutions, and their results."""
import csv
import json
import math
import subprocess
import xml.etree.ElementTree as ET

import program
from program import ProgramTest

CYCLIC = "verification/cyclic_2d.xml"  # alternating slip and stick
QUIET = "Output.vtu=false"
E, NU, P1, P2 = 10e9, 0.25, -10e6, -5e6  # Pa; stress far from the gallery, along x and y
G = E / (2 * (1 + NU))


def entries(parent, values):
    """Writes nested dicts as parameter lists."""
    for name, value in values.items():
        if isinstance(value, dict):
            entries(ET.SubElement(parent, "ParameterList", name=name), value)
            continue
        text = "{" + ", ".join(map(str, value)) + "}" if isinstance(value, (list, tuple)) else str(value)
        one = value[0] if isinstance(value, (list, tuple)) and value else value
        kind = {int: "int", float: "double", bool: "bool"}.get(type(one), "string")
        if isinstance(value, (list, tuple)):
            kind = f"Array({kind})"
        ET.SubElement(parent, "Parameter", name=name, type=kind, value=text.lower() if kind == "bool" else text)


def kirsch_displacement(x, y):
    """Returns the displacement, m, after excavation of a disc of radius 1 (Kirsch 1898), plane strain."""
    r2, s, d = x * x + y * y, P1 + P2, P1 - P2
    cos, sin = (x * x - y * y) / r2, 2 * x * y / r2  # of the double angle
    radial = (s + d * (4 * (1 - NU) - 1 / r2) * cos) / (4 * G)  # times r
    around = -d * (2 * (1 - 2 * NU) + 1 / r2) * sin / (4 * G)
    return [(radial * x - around * y) / r2, (radial * y + around * x) / r2]


def kirsch_stress(x, y):
    """Returns the total stress XX, YY, XY, Pa, after this excavation."""
    r2, s, d = x * x + y * y, (P1 + P2) / 2, (P1 - P2) / 2
    cos, sin = (x * x - y * y) / r2, 2 * x * y / r2
    rr = s * (1 - 1 / r2) + d * (1 - 4 / r2 + 3 / r2**2) * cos
    tt = s * (1 + 1 / r2) - d * (1 + 3 / r2**2) * cos
    rt = -d * (1 + 2 / r2 - 3 / r2**2) * sin
    return [(rr + tt) / 2 + (rr - tt) / 2 * cos - rt * sin, (rr + tt) / 2 - (rr - tt) / 2 * cos + rt * sin,
            (rr - tt) / 2 * sin + rt * cos]


def exact_far(share):
    """Returns the far displacement as expressions of a scene, multiplied by the expression `share`."""
    d, s = P1 - P2, P1 + P2
    radial = f"(({s}) + ({d})*({4 * (1 - NU)} - 1/r2)*(x^2 - y^2)/r2)/({4 * G})"
    around = f"(-({d})*({2 * (1 - 2 * NU)} + 1/r2)*2*x*y/r2)/({4 * G})"
    return {"r2": "x^2 + y^2", "ux": f"({share})*(({radial})*x - ({around})*y)/r2",
            "uy": f"({share})*(({radial})*y + ({around})*x)/r2"}


class Stages(ProgramTest):
    LOWER, UPPER, STIFFER = (10e9, 0.25), (4e9, 0.2), (30e9, 0.3)  # Young's moduli and Poisson's ratios

    def write(self, values, name="scene.xml"):
        root = ET.Element("ParameterList", name="Sprekk")
        entries(root, values)
        path = self.folder / name
        path.write_bytes(ET.tostring(root))
        return str(path)

    def mesh(self, n, dim):
        """Returns the path of a mesh with a disc "gallery" of radius 1 in one of radius 4; in 3D a slab.

        A quarter of the wall has n cells."""
        path = self.folder / f"kirsch_{dim}_{n}.msh"
        if not path.exists():
            subprocess.run(["gmsh", f"-{dim}", "-order", "2", "-format", "msh22", "-setnumber", "n", str(n), "-setnumber", "dim",
                            str(dim), str(program.ROOT / "tests/data/meshes/gallery.geo"), "-o", str(path)], check=True,
                           capture_output=True)
        return str(path)

    def gallery(self, n=8, dim=2, steps=1, release=True):
        """Returns the scene of a round gallery in rock under stress.

        With `release` the release takes all later steps."""
        share = "max(min(t - 1, 1), 0)" if release else "t < 1.5 ? 0 : 1"
        times = [1] + [1 + (k + 1) / steps for k in range(steps)] + [3]
        held = {"far": {"boundary": "far", "displacement": ["ux", "uy"] + (["0"] if dim == 3 else [])}}
        if dim == 3:
            for side in ("front", "back"):
                held[side] = {"boundary": side, "displacement": ["free", "free", "0"]}
        stress = [P1, P2, NU * (P1 + P2), 0.0] + ([0.0, 0.0] if dim == 3 else [])
        angles = [0.5 * math.pi * k / 4 for k in range(5)]
        places = {f"wall {k}": [math.cos(a), math.sin(a)] for k, a in enumerate(angles)}
        return {
            "Mesh file": {"path": self.mesh(n, dim)},
            "Materials": {"rock": {"type": "elastic", "Young's modulus": E, "Poisson's ratio": NU}},
            "Expressions": exact_far(share),
            "Bulk": {"material": "rock", "initial stress": stress},
            "Boundary conditions": held,
            "Probes": {name: {"point": x + ([0.0] if dim == 3 else []), "outputs": ["displacement", "stress"]}
                       for name, x in places.items()},
            "Stages": {"excavation": {"time": 1.0, "excavate": ["gallery"], **({"release": 1.0} if release else {})}},
            "Time": {"schedule": [float(t) for t in times]},
            "Output": {"vtu": False}}

    def probe(self, name, output="out"):
        """Returns the rows of a probe's table."""
        with open(self.folder / output / f"probes/{name}.csv") as file:
            return list(csv.reader(file))[1:]

    def wall_cells(self, n, dim):
        """Returns the centres of some rock cells with a face on the wall."""
        with open(self.mesh(n, dim)) as file:
            lines = iter(file.read().splitlines())
        nodes, cells = {}, []
        for line in lines:
            if line.startswith("$Nodes"):
                for _ in range(int(next(lines))):
                    number, *x = next(lines).split()
                    nodes[number] = [float(v) for v in x]
            elif line.startswith("$Elements"):
                for _ in range(int(next(lines))):
                    words = next(lines).split()
                    if int(words[1]) == {2: 9, 3: 11}[dim]:
                        cells.append([nodes[k] for k in words[3 + int(words[2]):]])
        centres = []
        for cell in cells:
            corners = dim + 1
            on_wall = sum(abs(math.hypot(x[0], x[1]) - 1) < 1e-9 for x in cell[:corners])
            inside = max(math.hypot(x[0], x[1]) for x in cell[:corners]) < 1 + 1e-9
            if on_wall == dim and not inside:
                weights = [1 / 9 - 2 / 9 if dim == 2 else -1 / 8] * corners + [4 / 9 if dim == 2 else 1 / 4] * (len(cell) - corners)
                centres.append([sum(w * x[i] for w, x in zip(weights, cell)) for i in range(dim)])
        return centres[::max(1, len(centres) // 24)]

    def last(self, output="out"):
        """Returns the content of the last checkpoint and the bytes of its values."""
        folder = max((f for f in (self.folder / output / "checkpoints").glob("*") if f.name.isdigit()), key=lambda f: int(f.name))
        content = json.loads((folder / "manifest.json").read_text())["sealed"]["content"]
        return content, [piece.read_bytes() for piece in sorted(folder.glob("piece_*.h5"))]

    def expect_same_bits(self, a, b):
        self.assertEqual(self.results(a)["status"], "completed")
        self.assertEqual(self.results(a)["steps"], self.results(b)["steps"])
        of_a, of_b = self.last(a), self.last(b)
        for content, _ in (of_a, of_b):
            content.pop("restarts")
        self.assertEqual(of_a, of_b)

    def square(self, steps, release=True, excavated=False, cell="triangle"):
        """Returns the scene of a square gallery with three fractures: cut, at a distance, and inside."""
        box = {"cell": cell, "lower corner": [-12.0, -12.0], "upper corner": [12.0, 12.0], "cells": [24, 24],
               "regions": {"gallery": {"lower corner": [-2.0, -2.0], "upper corner": [2.0, 2.0]}},
               "fractures": {"cut": {"lower corner": [-8.0, 0.0], "upper corner": [8.0, 0.0]},
                             "beside": {"lower corner": [4.0, -6.0], "upper corner": [4.0, 6.0]},
                             "inside": {"lower corner": [-1.0, -1.0], "upper corner": [1.0, -1.0]}}}
        joint = {"type": "joint", "friction coefficient": 0.2, "tangential stiffness": 10e9, "dilation angle": "3 deg"}
        scene = {"Mesh": box, "Materials": {"rock": {"type": "elastic", "Young's modulus": 20e9, "Poisson's ratio": 0.25},
                                            "joint": joint},
                 "Bulk": {"material": "rock", "initial stress": [-10e6, -6e6, -8e6, 1e6]}, "Fractures": {"material": "joint"},
                 "Boundary conditions": {side: {"boundary": side, "displacement": [0.0, 0.0]}
                                         for side in ("west", "east", "south", "north")},
                 "Time": {"schedule": [1.0] + [1 + (k + 1) / steps for k in range(steps)]}, "Output": {"vtu": False}}
        if excavated:
            return {**scene, "Regions": {"gallery": {"excavated": True}}}
        return {**scene, "Stages": {"excavation": {"time": 1.0, "excavate": ["gallery"], **({"release": 1.0} if release else {})}}}

    def column(self, cell, order):
        """Returns a column of rock of height 1 below a region "upper" of height 2, on rollers, with a load on top."""
        dim = 2 if cell in ("triangle", "quadrilateral") else 3
        up, sides = dim - 1, ("west", "east", "south", "north")[:2 * (dim - 1)]
        bottom, top = (("south", "north"), ("bottom", "top"))[dim - 2]
        fixed = lambda axis: ["0" if k == axis else "free" for k in range(dim)]
        rollers = {side: {"boundary": side, "displacement": fixed(k // 2)} for k, side in enumerate(sides)}
        upper = {"lower corner": [0.0] * up + [1.0], "upper corner": [1.0] * up + [3.0]}
        return {
            "Mesh": {"cells": [2] * up + [6], "lower corner": [0.0] * dim, "upper corner": [1.0] * up + [3.0], "cell": cell,
                     "order": order, "regions": {"upper": upper}},
            "Materials": {name: {"type": "elastic", "Young's modulus": E, "Poisson's ratio": nu}
                          for name, (E, nu) in (("lower", self.LOWER), ("fill", self.UPPER), ("stiffer", self.STIFFER))},
            "Bulk": {"material": "lower"}, "Regions": {"upper": {"excavated": True}},
            "Boundary conditions": {**rollers, "ground": {"boundary": bottom, "displacement": fixed(up)},
                                    "load": {"boundary": "upper", "confining pressure": "2e6"}},
            "Probes": {name: {"point": [0.5] * up + [z], "outputs": ["displacement", "stress"]}
                       for name, z in (("low", 0.45), ("face", 1.0), ("high", 2.95), ("top", 3.0))},
            "Stages": {"fill": {"time": 1.0, "backfill": ["upper"], "without": ["Boundary conditions > load"],
                                "Regions": {"upper": {"material": "fill"}},
                                "Boundary conditions": {"more": {"boundary": top, "confining pressure": "t < 1.5 ? 0 : t < 3.5 ? 5e6 : 9e6"}}},
                       "grout": {"time": 3.0, "Regions": {"upper": {"material": "stiffer"}}, "Bulk": {"material": "fill"}}},
            "Time": {"schedule": [1.0, 1.25, 2.0, 3.0, 3.25, 4.0]}, "Output": {"vtu": False}}
