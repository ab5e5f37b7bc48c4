"""Scenes of poroelasticity, see scenes.py."""
from perf.verification import flow_scenes, poro_exact, scenes


def rock(of):
    known = {"type": "elastic", "Lame's first parameter": of.lam, "shear modulus": of.G, "permeability": [of.mobility * 1e-3]}
    return {**known, **({"compressibility of pores": of.S} if of.S else {})}


def rollers(d, *sides):
    """Boundary conditions without normal displacement on these sides."""
    axis = {"west": 0, "east": 0, "south": 1, "north": 1, "bottom": 2, "top": 2}
    return {side: {"boundary": side, "displacement": ["0" if k == axis[side] else "free" for k in range(d)]} for side in sides}


def plate():
    known = poro_exact.PLATE
    times = poro_exact.mandel_times(25.0)
    yield ("mandel", "A quarter of a plate between rigid plates (Mandel 1953). The displacement of the upper plate is prescribed; "
           "the first step is very short.",
           {"Tables": {"plate": dict(zip(("arguments", "values"), map(list, known.way(times))))},
            "Mesh": {"cell": "triangle", "lower corner": [0.0, 0.0], "upper corner": [known.a, known.b], "cells": [20, 2]},
            "Materials": {"rock": rock(known.rock)}, "Bulk": {"material": "rock"}, "Flow": {"viscosity": 1e-3},
            "Boundary conditions": {**rollers(2, "west", "south"), "drained": {"boundary": "east", "pressure": 0.0},
                                    "plate": {"boundary": "north", "displacement": ["free", "plate(t)"]}}},
           {"schedule": list(times)})


def unit_rock(permeability, **more):
    """Rock with both Lame's constants 1; names of further entries have underscores instead of spaces."""
    return {"type": "elastic", "Lame's first parameter": 1.0, "shear modulus": 1.0, "permeability": [permeability],
            **{name.replace("_", " "): value for name, value in more.items()}}


def manufactured_solutions():
    from perf.verification import manufactured
    made = {name: float(value) for name, value in manufactured.ROCK.items()}
    rock = unit_rock(1.0, porosity=made["porosity"], compressibility_of_pores=made["growth"], Biot_coefficient=made["alpha"])
    meshes_of = {"2d": (flow_scenes.box(2, 4, {}), flow_scenes.sides(2)), "3d": (flow_scenes.box(3, 4, {}), flow_scenes.sides(3)),
                 "gmsh": (scenes.mesh_file(), ["boundary"])}
    for name, (mesh, sides) in meshes_of.items():
        d = 3 if name == "3d" else 2
        _, force, _, source = manufactured.poro(d)
        still = {side: {"boundary": side, "displacement": [0.0] * d, "pressure": 0.0} for side in sides}
        comment = "A manufactured solution of poroelasticity (Nordbotten 2016). See perf/verification/poro_exact.py."
        yield (f"manufactured_poro_{name}", comment,
               {**mesh, "Materials": {"rock": rock}, "Bulk": {"material": "rock", "body force": force},
                "Flow": {"viscosity": 1.0, "compressibility": made["compressibility"], "source": source}, "Boundary conditions": still},
               {"end": 1.0, "steps": 2})


def halved_block(d, known, rock, joint, flow, heat=None):
    """Content of a scene: unit square or cube with a fracture between the halves `below` and `above`, and exact
    boundary values.

    `known` contains, for each half, displacement, body force, pressure and source; with heat also temperature
    and heat source; and the corresponding entries of the fracture."""
    sides, low, high, last = flow_scenes.sides(d), [0.0] * (d - 1), [1.0] * (d - 1), "xyz"[d - 1]
    halves = {"below": ([0.0] * d, [*high, 0.5]), "above": ([*low, 0.5], [1.0] * d)}
    mesh = flow_scenes.box(d, 4, {"fracture": flow_scenes.across(d, d - 1, 0.5)}, halves)
    mesh["Mesh"]["fractures"]["fracture"]["reference normal"] = [*low, 1.0]

    def given(place):
        return {"pressure": known[place], **({"temperature": known[f"{place} temperature"]} if heat else {})}

    def by_half(above, below):
        return f"{last}>0.5 ? ({above}) : ({below})"
    conditions = {f"{half} {side}": {"boundary": side, "region": half, "displacement": known[f"{half} displacement"], **given(half)}
                  for half, end in zip(halves, sides[-2:]) for side in [*sides[:-2], end]}
    conditions.update({f"fracture {side}": {"boundary": side, "fracture": "fracture", **given("fracture")} for side in sides[:-2]})
    force = [by_half(*both) for both in zip(known["above force"], known["below force"])]
    warm = {"Heat": {**heat, "source": by_half(known["above heat"], known["below heat"])}} if heat else {}
    return {**mesh, "Materials": {"rock": rock, "joint": {"type": "joint", **joint}}, "Bulk": {"material": "rock", "body force": force},
            "Regions": {half: {"material": "rock"} for half in halves},
            "Fractures": {"fracture": {"material": "joint", "source": known["fracture source"]}},
            "Flow": {**flow, "source": by_half(known["above source"], known["below source"])}, **warm, "Boundary conditions": conditions}


def opened_fractures():
    from perf.verification import manufactured
    growth, alpha = (float(manufactured.ROCK[name]) for name in ("growth", "alpha"))
    rock = unit_rock(1.0, compressibility_of_pores=growth, Biot_coefficient=alpha)
    joint = {"friction coefficient": 0.5, "initial gap": -0.1, "initial aperture": 1.0}
    for d in (2, 3):
        yield (f"manufactured_opening_{d}d", "A manufactured solution of rock with a fracture opened by fluid pressure. See perf/verification/poro_exact.py.",
               halved_block(d, manufactured.opened(d), rock, joint, {"viscosity": 0.5}), {"end": 1.0, "steps": 2})


def joint_of(known):
    """Joint of poro_exact.Joined, with such a permeability that pressures are uniform."""
    closing = {"dilation angle": 10.0, "initial gap": known.gap, "maximum closure": known.closure,
               "normal stiffness": known.normal_stiffness}
    return {"type": "joint", "friction coefficient": known.friction, "tangential stiffness": known.shear_stiffness,
            **(closing if known.closure else {}), "initial aperture": 0.1, "tangential permeability": 1.0}


def joined_block(name, known, d, comment):
    """Yields a block whose fracture has the pressure of a well; the rock is almost impermeable."""
    down, up = flow_scenes.sides(d)[-2:]
    path, (along, across) = known.path(), known.way
    stress = {2: [0.0, -known.N0, 0.0, known.T0], 3: [0.0, 0.0, -known.N0, 0.0, 0.6 * known.T0, 0.8 * known.T0]}[d]
    mesh = flow_scenes.box(d, 4, {"fracture": flow_scenes.across(d, d - 1, 0.5)}, periodic=["x", "y"][:d - 1])
    mesh["Mesh"]["fractures"]["fracture"]["reference normal"] = [0.0] * (d - 1) + [1.0]
    rock = {"type": "elastic", "Lame's first parameter": known.lam, "shear modulus": known.G, "permeability": [1e-45],
            "Biot coefficient": 0.0, "compressibility of pores": 0.0}
    well = {"points": [0.4, 0.5] if d == 2 else [0.4, 0.4, 0.4, 0.4, 0.4, 0.6], "radius": 1e-3, "pressure": "p(t)"}
    moved = [along, across] if d == 2 else [0.8 * along, 0.6 * along, across]
    yield (f"fluid_{name}_{d}d", comment,
           {"Tables": {"p": {"arguments": list(range(len(path))), "values": path}}, **mesh,
            "Materials": {"rock": rock, "joint": joint_of(known)},
            "Bulk": {"material": "rock", **({"initial stress": stress} if known.N0 else {})},
            "Fractures": {"fracture": {"material": "joint"}}, "Flow": {"viscosity": 1e-12, "Wells": {"well": well}},
            "Boundary conditions": {"fixed": {"boundary": down, "displacement": [0.0] * d},
                                    "moved": {"boundary": up, "displacement": moved}}},
           {"start": 0.0, "schedule": [float(k) for k in range(1, len(path))]})


def joined_blocks():
    for d in (2, 3):
        yield from joined_block("block", poro_exact.CONFINED, d,
                                "A block with a fracture under compression and shear. The fluid pressure rises until the fracture slides and opens.")
        yield from joined_block("onset", poro_exact.STRESSED, d,
                                "A fracture under a compression of 60 MPa and a shear stress of 20 MPa. The fluid pressure rises until the "
                                "fracture slides and opens.")


def filled_cracks():
    """Yields the scenes of cracks that are filled in the first of two steps.

    The displacement on the box is that of the crack with the injected volume. The crack has an initial opening
    of 1e-4: a closed crack would have no volume for an incompressible fluid."""
    displacements = {2: scenes.crack_displacement(1, 0.5 * poro_exact.FILLED, 0.25),
                     3: scenes.penny_displacement(poro_exact.FILLED, 0.25)}
    joint = {"type": "joint", "friction coefficient": 0.5, "initial gap": -1e-4, "initial aperture": 1e-4}
    for d, name in ((2, "A crack"), (3, "A penny-shaped crack")):
        well = {"points": [0.0, 0.0] if d == 2 else [0.0, 0.0, -0.1, 0.0, 0.0, 0.1], "radius": 1e-6,
                "rate": f"t<0.75 ? {2 * poro_exact.filling(d, 0.25)!r} : 0"}
        yield (f"crack_volume_{d}d", f"{name} that stores all of the fluid injected by a well (Sneddon 1946).",
               {**scenes.mesh_file("crack", normal=[0.0] * (d - 1) + [1.0]),
                "Materials": {"rock": unit_rock(1e-22, Biot_coefficient=0.0, compressibility_of_pores=0.0), "joint": joint},
                "Bulk": {"material": "rock"}, "Fractures": {"crack": {"material": "joint"}},
                "Flow": {"viscosity": 1e-13, "Wells": {"well": well}},
                "Boundary conditions": scenes.around([f"min(2*t,1)*({text})" for text in displacements[d]])}, {"end": 1.0, "steps": 2})


ALPHA, STORED = 0.8, 0.5


def rock_in_time():
    """Yields the scene of poro_exact.InTime, with errors of the time steps only."""
    exact = {"displacement": ["sin(2*t)*x", "sin(2*t)*y/2"], "pressure": "sin(3*t)*(1+x-y/2)"}
    yield ("poro_time_rock", "Pressure and strain of rock that vary in time and are linear in space. See perf/verification/poro_exact.py.",
           {**flow_scenes.box(2, 4, {}, cell="quadrilateral"),
            "Materials": {"rock": unit_rock(0.01, Biot_coefficient=ALPHA, compressibility_of_pores=STORED)},
            "Bulk": {"material": "rock", "body force": [f"{ALPHA}*sin(3*t)", f"-{ALPHA / 2}*sin(3*t)"]},
            "Flow": {"viscosity": 1.0, "source": f"{3 * ALPHA}*cos(2*t)+{3 * STORED}*cos(3*t)*(1+x-y/2)"},
            "Boundary conditions": {side: {"boundary": side, **exact} for side in flow_scenes.sides(2)}}, {"end": 0.5, "steps": 10})


def fracture_in_time():
    """Yields the scene of poro_exact.OpenInTime.

    The strain along z is (alpha - 1)/3 times the pressure; sources are the rates stored by pores and fracture."""
    c, shrinks = 0.3, (1 - ALPHA) / 3
    source = f"exp({c}*sin(3*t))*3*cos(3*t)*({STORED}+{c}*(0.1+{STORED}*sin(3*t)))-{3 * ALPHA * shrinks!r}*cos(3*t)"
    inside = f"exp({c}*sin(3*t))*(sin(2*t)/5+{3 * c!r}*cos(3*t)*(0.05+(1-cos(2*t))/10))"
    top = {"boundary": "top", "displacement": ["free", "free", f"(1-cos(2*t))/10-{shrinks!r}*sin(3*t)"]}
    mesh = flow_scenes.box(3, 4, {"fracture": flow_scenes.across(3, 2, 0.5)})
    mesh["Mesh"]["cells"] = [2, 2, 4]
    rock = unit_rock(0.01, Biot_coefficient=ALPHA, compressibility_of_pores=STORED, porosity=0.1)
    joint = {"type": "joint", "friction coefficient": 0.5, "initial gap": -0.01, "initial aperture": 0.05}
    yield ("poro_time_fracture", "A fracture that opens over time, in a closed block with fluid sources. See perf/verification/poro_exact.py.",
           {**mesh, "Materials": {"rock": rock, "joint": joint}, "Bulk": {"material": "rock"},
            "Fractures": {"fracture": {"material": "joint", "source": inside}},
            "Flow": {"viscosity": 1.0, "compressibility": c, "source": source},
            "Boundary conditions": {**rollers(3, *flow_scenes.sides(3)[:5]), "top": top}}, {"end": 0.5, "steps": 10})
