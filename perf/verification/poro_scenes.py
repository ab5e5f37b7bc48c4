#!/usr/bin/env python3
"""Writes the scenes of poroelasticity of this measurement into xml/verification."""
import sys

import flow_scenes
import make_scenes
import manufactured
import meshes
import poro_exact


def rock(of):
    known = {"type": "elastic", "Lame's first parameter": of.lam, "shear modulus": of.G, "permeability": [of.mobility * 1e-3]}
    return {**known, **({"compressibility of pores": of.S} if of.S else {})}


def rollers(d, *sides):
    """No motion along the normal of these sides."""
    axis = {"west": 0, "east": 0, "south": 1, "north": 1, "bottom": 2, "top": 2}
    return {side: {"boundary": side, "displacement": ["0" if k == axis[side] else "free" for k in range(d)]} for side in sides}


def write(name, comment, box, materials, conditions, time, tables=None):
    mesh = {"Mesh": {"cell": ("triangle", "tetrahedron")[len(box) - 2], "lower corner": [0.0] * len(box), "upper corner": box, **materials.pop("mesh")}}
    content = {**({"Tables": tables} if tables else {}), **mesh, "Materials": materials, "Bulk": {"material": next(iter(materials))}, "Flow": {"viscosity": 1e-3}}
    if "soft" in materials:
        content["Regions"] = {"middle": {"material": "soft"}}
    make_scenes.write(name, comment, {**content, "Boundary conditions": conditions}, "poro_scenes.py", time)


def columns():
    known = poro_exact.COLUMN
    for d in (2, 3):
        up, sides = "yz"[d - 2], ["west", "east", "south", "north", "bottom", "top"][:2 * d]
        down, top = sides[-2:]
        load = {"boundary": top, "traction": [0.0] * (d - 1) + [-known.sigma], "pressure": 0.0}
        box, cells = [0.2] * (d - 1) + [known.H], [2] * (d - 1) + [10]
        write(f"terzaghi_{d}d", f"Consolidation of a column along {up} under a load on its drained top (Terzaghi 1923).", box,
              {"mesh": {"cells": cells}, "rock": rock(known.rock)}, {**rollers(d, *sides[:-1]), "top": load}, {"end": 0.1 / known.rock.c, "steps": 25})
        middle = {"middle": {"lower corner": [0.0] * (d - 1) + [0.4], "upper corner": [0.2] * (d - 1) + [0.6]}}
        soft = poro_exact.Rock(known.rock.lam / 10, known.rock.G / 10, 0.0, known.rock.mobility / 100)
        write(f"layers_{d}d", "A column with a soft, tight layer, loaded so quickly that nothing drains.", box,
              {"mesh": {"cells": cells, "regions": middle}, "rock": rock(known.rock), "soft": rock(soft)}, {**rollers(d, *sides[:-1]), "top": load},
              {"end": 1e-6, "steps": 1})


def plate():
    known = poro_exact.PLATE
    write("mandel", "A quarter of a plate that rigid plates press together (Mandel 1953): the way of the plate is prescribed, from a step of almost nothing on.",
          [known.a, known.b], {"mesh": {"cells": [20, 2]}, "rock": rock(known.rock)},
          {**rollers(2, "west", "south"), "drained": {"boundary": "east", "pressure": 0.0}, "plate": {"boundary": "north", "displacement": ["free", "plate(t)"]}},
          {"schedule": list(poro_exact.mandel_times(25.0))}, {"plate": dict(zip(("arguments", "values"), map(list, known.way(poro_exact.mandel_times(25.0)))))})


def manufactured_rock():
    return {"type": "elastic", "Lame's first parameter": 1.0, "shear modulus": 1.0, "permeability": [1.0], "porosity": float(manufactured.ROCK["porosity"]),
            "compressibility of pores": float(manufactured.ROCK["growth"]), "Biot coefficient": float(manufactured.ROCK["alpha"])}


def manufactured_solutions():
    for name, mesh, sides in (("2d", flow_scenes.box(2, 4, {}), flow_scenes.sides(2)), ("3d", flow_scenes.box(3, 4, {}), flow_scenes.sides(3)),
                              ("gmsh", make_scenes.mesh_file("square"), ["boundary"])):
        d = 3 if name == "3d" else 2
        _, force, _, source = manufactured.poro(d)
        still = {side: {"boundary": side, "displacement": [0.0] * d, "pressure": 0.0} for side in sides}
        content = {**mesh, "Materials": {"rock": manufactured_rock()}, "Bulk": {"material": "rock", "body force": force},
                   "Flow": {"viscosity": 1.0, "compressibility": float(manufactured.ROCK["compressibility"]), "source": source}, "Boundary conditions": still}
        make_scenes.write(f"manufactured_poro_{name}", "A manufactured solution of poroelasticity (Nordbotten 2016). See perf/verification/poro_exact.py.", content,
                          "poro_scenes.py", {"end": 1.0, "steps": 2})


if __name__ == "__main__":
    meshes.square(make_scenes.FOLDER, 0.25).rename(make_scenes.FOLDER / "square.msh")
    for make in (columns, plate, manufactured_solutions):
        make()
    for geo in make_scenes.FOLDER.glob("*.geo"):
        geo.unlink()
    sys.exit(0)
