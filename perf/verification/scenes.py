"""Scenes of this measurement that are generated when they are run; those of contact and friction.

A function of WRITERS yields (name, comment, content[, section Time]) of its scenes. Gmsh meshes are those of each run."""
import importlib
import math
import re
from functools import cache
from pathlib import Path

from perf.common.program import ROOT
from perf.common.scene_file import save

WRITERS = {"inclined_crack": "scenes.inclined_crack", "t_junction": "scenes.t_junction", "flow_(conductor|barrier)": "flow_scenes.single_fracture",
           "flow_(resistance|continuous)_.d": "flow_scenes.manufactured_solutions", "flow_patch_.d": "flow_scenes.patches",
           "flow_well_.d": "flow_scenes.wells", "flow_regular_.d": "flow_scenes.regular", "flow_(hydrocoin|single)": "flow_scenes.others",
           "mandel": "poro_scenes.plate", "manufactured_poro_.*": "poro_scenes.manufactured_solutions",
           "manufactured_opening_.d": "poro_scenes.opened_fractures", "fluid_.*": "poro_scenes.joined_blocks",
           "crack_volume_.d": "poro_scenes.filled_cracks", "poro_time_rock": "poro_scenes.rock_in_time",
           "poro_time_fracture": "poro_scenes.fracture_in_time", "manufactured_heat_.*": "heat_scenes.sliding_fractures",
           "heat_time_.d": "heat_scenes.sliding_in_time", "manufactured_.*": "scenes.manufactured_solutions"}


@cache
def path(scene, folder):
    """Path of a scene, given relative to xml/. A scene that is not there is generated in the folder."""
    checked_in = ROOT / "xml" / scene
    return checked_in if checked_in.is_file() else generated(Path(scene).stem, folder)


def generated(name, folder):
    module, function = next(writer for pattern, writer in WRITERS.items() if re.fullmatch(pattern, name)).split(".")
    made = getattr(importlib.import_module(f"perf.verification.{module}"), function)()
    comment, content, *time = next(rest for each, *rest in made if each == name)
    folder.mkdir(parents=True, exist_ok=True)
    save({**content, "Time": time[0] if time else {"end": 1.0, "steps": 1}}, folder / f"{name}.xml", comment)
    return folder / f"{name}.xml"


def scene(mesh, rock, joint, fractures, conditions, bulk={}, fluid={}):
    """Content of a scene; `fluid` contains entries for all fractures."""
    return {**mesh, "Materials": {"rock": {"type": "elastic", **rock}, "joint": {"type": "joint", **joint}},
            "Bulk": {"material": "rock", **bulk}, "Fractures": {name: {"material": "joint", **fluid} for name in fractures},
            "Boundary conditions": conditions}


def mesh_file(*fractures, normal=None):
    """Section of a mesh whose path is an entry of the run."""
    given = {"reference normal": normal} if normal else {}
    return {"Mesh file": {"path": "mesh.msh", "fractures": {fracture: dict(given) for fracture in fractures}}}


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


def inclined_crack():
    a, G, K = math.radians(20), 10e9, 16.67e9
    c, s, lam = math.cos(a), math.sin(a), K - 2 * G / 3
    nu, load = lam / (2 * (lam + G)), 100e6
    drop = load * s * (c - math.tan(math.radians(30)) * s)
    u, v = crack_displacement(2, drop / (2 * G), nu, f"({c:.17g}*x+{s:.17g}*y)", f"({c:.17g}*y-{s:.17g}*x)")
    xx, yy = -load * (1 - nu) / (2 * G), load * nu / (2 * G)
    yield ("inclined_crack", "A crack at 20 degrees to uniaxial compression of 100 MPa that slides with friction of "
           "30 degrees (Phan et al. 2003). The exact displacement is prescribed on the box.",
           scene(mesh_file("crack", normal=[-s, c]), {"shear modulus": "10 GPa", "bulk modulus": "16.67 GPa"},
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


def t_junction():
    content = scene(mesh_file("horizontal", "vertical"), {"shear modulus": "29.17 GPa", "bulk modulus": "38.89 GPa"},
                    {"friction angle": 30.0}, ["horizontal", "vertical"],
                    {"far": {"boundary": "boundary", "displacement": [0.0, 0.0]}}, {"initial stress": [0.0, -100e6, 0.0, 0.0]})
    content["Mesh file"]["fractures"]["horizontal"]["reference normal"] = [0.0, 1.0]
    content["Fractures"]["vertical"]["fluid pressure"] = 100e6
    yield ("t_junction", "A fracture under a fluid pressure of 100 MPa ends at a sliding fracture, in rock under a compression of "
           "100 MPa (Phan et al. 2003). The box is large enough for its boundary to have a negligible effect.", content)


def manufactured_solutions():
    from perf.verification import manufactured
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
            comment = f"A manufactured solution of a block with a fracture: {regime}. See perf/verification/exact.py."
            yield f"manufactured_{regime}_{d}d", comment, content
