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


def joined_blocks():
    """Pressures by a well in the fracture; rock that lets nothing through, so little viscous the fluid is that pressures are uniform."""
    for name, known, comment in (("block", poro_exact.CONFINED, "A block with a fracture through it, sheared and pressed together, in whose fracture a fluid's pressure rises "
                                  "until it slides and opens."),
                                 ("onset", poro_exact.STRESSED, "A fracture under 60 MPa of compression and 20 MPa of shear, in which a fluid's pressure rises until it slides and opens.")):
        for d in (2, 3):
            along = [known.way[0]] if d == 2 else [0.8 * known.way[0], 0.6 * known.way[0]]
            joint = {"type": "joint", "friction coefficient": known.friction, "tangential stiffness": known.shear_stiffness, "initial aperture": 0.1, "tangential permeability": 1.0,
                     **({"dilation angle": 10.0, "initial gap": known.gap, "maximum closure": known.closure, "normal stiffness": known.normal_stiffness} if known.closure else {})}
            rock = {"type": "elastic", "Lame's first parameter": known.lam, "shear modulus": known.G, "permeability": [1e-45], "Biot coefficient": 0.0,
                    "compressibility of pores": 0.0}
            stress = {2: [0.0, -known.N0, 0.0, known.T0], 3: [0.0, 0.0, -known.N0, 0.0, 0.6 * known.T0, 0.8 * known.T0]}[d]
            down, up = flow_scenes.sides(d)[-2:]
            path = known.path()
            mesh = flow_scenes.box(d, 4, {"fracture": flow_scenes.across(d, d - 1, 0.5)}, periodic=["x", "y"][:d - 1])
            mesh["Mesh"]["fractures"]["fracture"]["reference normal"] = [0.0] * (d - 1) + [1.0]
            middle = [0.4, 0.5] if d == 2 else [0.4, 0.4, 0.4, 0.4, 0.4, 0.6]
            content = {"Tables": {"p": {"arguments": list(range(len(path))), "values": path}}, **mesh, "Materials": {"rock": rock, "joint": joint},
                       "Bulk": {"material": "rock", **({"initial stress": stress} if known.N0 else {})}, "Fractures": {"fracture": {"material": "joint"}},
                       "Flow": {"viscosity": 1e-12, "Wells": {"well": {"points": middle, "radius": 1e-3, "pressure": "p(t)"}}},
                       "Boundary conditions": {"fixed": {"boundary": down, "displacement": [0.0] * d}, "moved": {"boundary": up, "displacement": [*along, known.way[1]]}}}
            make_scenes.write(f"fluid_{name}_{d}d", comment, content, "poro_scenes.py", {"start": 0.0, "schedule": [float(k) for k in range(1, len(path))]})


def filled_cracks():
    """The displacement on the box is that of the crack with the volume that has been put in, in the first of two steps. The crack is open by 1e-4 from
    the start: what is closed and cannot give way would have no room for a fluid that cannot be compressed."""
    crack, disc, nu = make_scenes.crack_displacement(1, 0.5 * poro_exact.FILLED, 0.25), make_scenes.penny_displacement(poro_exact.FILLED, 0.25), 0.25
    for d, mesh, name, displacement in ((2, "sneddon", "A crack", crack), (3, "penny", "A crack in the form of a disc", disc)):
        where = [0.0, 0.0] if d == 2 else [0.0, 0.0, -0.1, 0.0, 0.0, 0.1]
        rock = {"type": "elastic", "shear modulus": 1.0, "Lame's first parameter": 1.0, "permeability": [1e-22], "Biot coefficient": 0.0, "compressibility of pores": 0.0}
        content = {**make_scenes.mesh_file(mesh, "crack", normal=[0.0] * (d - 1) + [1.0]),
                   "Materials": {"rock": rock, "joint": {"type": "joint", "friction coefficient": 0.5, "initial gap": -1e-4, "initial aperture": 1e-4}},
                   "Bulk": {"material": "rock"}, "Fractures": {"crack": {"material": "joint"}},
                   "Flow": {"viscosity": 1e-13, "Wells": {"well": {"points": where, "radius": 1e-6, "rate": f"t<0.75 ? {2 * poro_exact.filling(d, nu)!r} : 0"}}},
                   "Boundary conditions": make_scenes.around([f"min(2*t,1)*({text})" for text in displacement])}
        make_scenes.write(f"crack_volume_{d}d", f"{name}, into which a well puts a volume of fluid that nothing else takes up (Sneddon 1946).", content, "poro_scenes.py",
                          {"end": 1.0, "steps": 2})


if __name__ == "__main__":
    meshes.square(make_scenes.FOLDER, 0.25).rename(make_scenes.FOLDER / "square.msh")
    for make in (columns, plate, manufactured_solutions, joined_blocks, filled_cracks):
        make()
    for geo in make_scenes.FOLDER.glob("*.geo"):
        geo.unlink()
    sys.exit(0)
