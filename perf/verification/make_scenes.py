"""Writes the scenes of this measurement and their coarse meshes into xml/verification. Requires SymPy and gmsh."""
import math
import sys
from pathlib import Path
from xml.sax.saxutils import quoteattr

from perf.verification import manufactured, meshes

FOLDER = Path(__file__).resolve().parents[2] / "xml/verification"


def entry(name, value):
    words = value if isinstance(value, list) else [value]
    kind = {str: "string", bool: "bool", int: "int"}.get(type(words[0]), "double")
    text = ", ".join(word if isinstance(word, str) else str(word).lower() if isinstance(word, bool) else f"{word:.17g}" for word in words)
    if isinstance(value, list):
        kind, text = f"Array({kind})", f"{{{text}}}"
    return f'<Parameter name={quoteattr(name)} type="{kind}" value={quoteattr(text)}/>'


def section(name, content, indent=""):
    inner = indent + "  "
    lines = [section(key, value, inner) if isinstance(value, dict) else inner + entry(key, value) for key, value in content.items()]
    if not lines:
        return f"{indent}<ParameterList name={quoteattr(name)}/>"
    return "\n".join([f"{indent}<ParameterList name={quoteattr(name)}>", *lines, f"{indent}</ParameterList>"])


def write(name, comment, content, writer="make_scenes.py", time=None):
    content["Time"] = time or {"end": 1.0, "steps": 1}
    comment = f"<!-- {comment} Written by perf/verification/{writer}. -->"
    (FOLDER / f"{name}.xml").write_text(f"{comment}\n{section('Sprekk', content)}\n")


def scene(mesh, rock, joint, fractures, conditions, bulk={}, fluid={}):
    """Content of a scene; `fluid` contains entries for all fractures."""
    return {**mesh, "Materials": {"rock": {"type": "elastic", **rock}, "joint": {"type": "joint", **joint}},
            "Bulk": {"material": "rock", **bulk}, "Fractures": {name: {"material": "joint", **fluid} for name in fractures},
            "Boundary conditions": conditions}


def mesh_file(name, *fractures, normal=None):
    given = {"reference normal": normal} if normal else {}
    return {"Mesh file": {"path": f"{name}.msh", "fractures": {fracture: dict(given) for fracture in fractures}}}


def around(displacement):
    """Boundary condition of a box with known displacement."""
    return {"exact": {"boundary": "boundary", "displacement": displacement}}


def crack_displacement(mode, factor, nu, x="x", y="y"):
    """Expressions for the displacement of exact.Crack along and across the crack, with drop/(2G) = factor.

    x and y are the coordinates along and across. The square root r of w = z^2 - 1 has the signs of x and y in
    its real and imaginary part: sqrt((|w| +- Re w)/2)."""
    w = f"({x}^2-{y}^2-1)"
    size = f"sqrt((({x}-1)^2+{y}^2)*(({x}+1)^2+{y}^2))"
    real = f"({x}<0 ? -1 : 1)*sqrt(max({size}+{w},0)/2)"
    imaginary = f"({y}<0 ? -1 : 1)*sqrt(max({size}-{w},0)/2)"
    Z_real, Z_imaginary = f"(({x}*{real}+{y}*{imaginary})/{size}-1)", f"(({y}*{real}-{x}*{imaginary})/{size})"
    low, high = 1 - 2 * nu, 2 - 2 * nu  # (kappa -+ 1)/2
    if mode == 1:
        return [f"{factor:.17g}*({low:.17g}*({real}-{x})-{y}*{Z_imaginary})", f"{factor:.17g}*({high:.17g}*({imaginary}-{y})-{y}*{Z_real})"]
    return [f"{factor:.17g}*({high:.17g}*({imaginary}-{y})+{y}*{Z_real})", f"{factor:.17g}*(-{low:.17g}*({real}-{x})-{y}*{Z_imaginary})"]


def cracks():
    rock = {"shear modulus": 1.0, "Poisson's ratio": 0.25}
    meshes.uniform_crack(FOLDER, 0.4).rename(FOLDER / "sneddon.msh")
    write("sneddon", "An open crack under the pressure 1e-3 in a box. The displacement of the infinite plane is prescribed on the "
          "boundary (Sneddon 1946).",
          scene(mesh_file("sneddon", "crack", normal=[0.0, 1.0]), rock, {"friction coefficient": 0.5}, ["crack"],
                around(crack_displacement(1, 0.5e-3, 0.25)), fluid={"fluid pressure": 1e-3}))
    write("sneddon_shear", "A crack under the initial normal stress -1e-3 and shear stress 1.5e-3 that slides with "
          "friction 0.5: the stress drop is 1e-3. The exact displacement is prescribed on the box.",
          scene(mesh_file("sneddon", "crack", normal=[0.0, 1.0]), rock, {"friction coefficient": 0.5}, ["crack"],
                around(crack_displacement(2, 0.5e-3, 0.25)), {"initial stress": [0.0, -1e-3, 0.0, 1.5e-3]}))
    meshes.uniform_crack(FOLDER, 0.4, 20).rename(FOLDER / "inclined_crack.msh")
    a, G, K = math.radians(20), 10e9, 16.67e9
    c, s, lam = math.cos(a), math.sin(a), K - 2 * G / 3
    nu, load = lam / (2 * (lam + G)), 100e6
    drop = load * s * (c - math.tan(math.radians(30)) * s)
    u, v = crack_displacement(2, drop / (2 * G), nu, f"({c:.17g}*x+{s:.17g}*y)", f"({c:.17g}*y-{s:.17g}*x)")
    xx, yy = -load * (1 - nu) / (2 * G), load * nu / (2 * G)
    write("inclined_crack", "A crack at 20 degrees to uniaxial compression of 100 MPa that slides with friction of "
          "30 degrees (Phan et al. 2003). The exact displacement is prescribed on the box.",
          scene(mesh_file("inclined_crack", "crack", normal=[-s, c]), {"shear modulus": "10 GPa", "bulk modulus": "16.67 GPa"},
                {"friction angle": 30.0}, ["crack"],
                around([f"{c:.17g}*{u}-{s:.17g}*{v}+{xx:.17g}*x",
                        f"{s:.17g}*{u}+{c:.17g}*{v}+{yy:.17g}*y"])))


def penny_displacement(p, nu):
    """Expressions for the displacement of exact.Penny under the pressure p, with shear modulus 1."""
    far, near, r = "sqrt((r+1)^2+z^2)", "sqrt((r-1)^2+z^2)", "sqrt(x^2+y^2)"
    l1, l2 = f"(({far}-{near})/2)", f"(({far}+{near})/2)"
    root, out = f"sqrt(max(1-{l1}^2,0))", f"sqrt(max({l2}^2-1,0))"
    angle, product, factor = f"asin(min(1/{l2},1))", f"({far}*{near})", p / math.pi
    radial = f"{factor:.17g}*(-{(1 - 2 * nu) / 2:g}*({angle}-{out}/{l2}^2)+abs(z)*{root}/({l2}^2*{product}))"
    axial = f"{factor:.17g}*(z<0 ? -1 : 1)*({2 * (1 - nu):g}*({root}-abs(z)*{angle})+abs(z)*({angle}-{out}/{product}))"
    return [text.replace("(r", f"({r}") for text in (f"x*{radial}", f"y*{radial}", axial)]


def penny():
    meshes.penny(FOLDER, 1, 0.25, 0.5).rename(FOLDER / "penny.msh")
    write("penny", "An open penny-shaped crack under the pressure 1e-3 in a box. The displacement of the infinite body is "
          "prescribed on the boundary (Sneddon 1946).",
          scene(mesh_file("penny", "crack", normal=[0.0, 0.0, 1.0]), {"shear modulus": 1.0, "Poisson's ratio": 0.25},
                {"friction coefficient": 0.5}, ["crack"], around(penny_displacement(1e-3, 0.25)), fluid={"fluid pressure": 1e-3}))


def wavy():
    meshes.wavy(FOLDER, 0.05).rename(FOLDER / "wavy.msh")
    full = math.pi / 0.75 * 0.01
    sides = {side: {"boundary": side, "displacement": ["0", "free"]} for side in ("west", "east")}
    ends = {"below": {"boundary": "south", "displacement": ["free", "0"]}, "above": {"boundary": "north", "traction": [0.0, -0.4 * full]}}
    write("wavy", "Half a wavelength of a wavy fracture under compression. The size of the contact zone is known (Westergaard 1939).",
          scene(mesh_file("wavy", "fracture", normal=[0.0, 1.0]), {"shear modulus": 1.0, "Poisson's ratio": 0.25},
                {"friction coefficient": 0.5, "initial gap": "-0.01*(1-cos(2*pi*x))"}, ["fracture"], {**sides, **ends}))


def t_junction():
    meshes.t_junction(FOLDER, 0.6, 0.1, 8000).rename(FOLDER / "t_junction.msh")
    content = scene(mesh_file("t_junction", "horizontal", "vertical"), {"shear modulus": "29.17 GPa", "bulk modulus": "38.89 GPa"},
                    {"friction angle": 30.0}, ["horizontal", "vertical"],
                    {"far": {"boundary": "boundary", "displacement": [0.0, 0.0]}}, {"initial stress": [0.0, -100e6, 0.0, 0.0]})
    content["Mesh file"]["fractures"]["horizontal"]["reference normal"] = [0.0, 1.0]
    content["Fractures"]["vertical"]["fluid pressure"] = 100e6
    write("t_junction", "A fracture under a fluid pressure of 100 MPa ends at a sliding fracture, in rock under a compression of "
          "100 MPa (Phan et al. 2003). The box is large enough for its boundary to have a negligible effect.", content)


def manufactured_solutions():
    joint = {"tangential stiffness": 2.0, "friction coefficient": 0.5, "dilation angle": "0.1 rad", "initial gap": 0.02,
             "maximum closure": 0.1, "normal stiffness": 5.0}
    for d in (2, 3):
        last, low, high = "xyz"[d - 1], [0.0] * d, [1.0] * d
        sides, faces = {"below": ("south", "bottom")[d - 2], "above": ("north", "top")[d - 2]}, ["west", "east", "south", "north"][:2 * d - 2]
        mesh = {"Mesh": {"cell": ("triangle", "tetrahedron")[d - 2], "lower corner": low, "upper corner": high, "cells": [4] * d,
                         "regions": {"below": {"lower corner": low, "upper corner": [1.0] * (d - 1) + [0.5]},
                                     "above": {"lower corner": [0.0] * (d - 1) + [0.5], "upper corner": high}},
                         "fractures": {"fracture": {"lower corner": [0.0] * (d - 1) + [0.5], "upper corner": [1.0] * (d - 1) + [0.5],
                                                    "reference normal": [0.0] * (d - 1) + [1.0]}}}}
        for regime in ("stick", "slip", "mixed", "uniform"):
            below, above, force_below, force_above = manufactured.expressions(d, regime)
            force = [f"{last}>0.5 ? ({a}) : ({b})" for a, b in zip(force_above, force_below)]
            conditions = {f"{side} {face}": {"boundary": face, "region": side, "displacement": value}
                          for side, value in (("below", below), ("above", above)) for face in faces + [sides[side]]}
            content = scene(mesh, {"shear modulus": 1.0, "Lame's first parameter": 1.0}, joint, ["fracture"], conditions, {"body force": force})
            content["Regions"] = {side: {"material": "rock"} for side in sides}
            write(f"manufactured_{regime}_{d}d", f"A manufactured solution of a block with a fracture: {regime}. See perf/verification/exact.py.", content)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for make in (cracks, penny, wavy, t_junction, manufactured_solutions):
        make()
    for geo in FOLDER.glob("*.geo"):
        geo.unlink()
    sys.exit(0)
