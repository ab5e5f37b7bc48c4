"""Scenes of flow, see scenes.py."""
from perf.verification import meshes
from perf.verification.scenes import mesh_file


def scene(mesh, joints, fractures, conditions, rocks=None, regions=None, fluid=None):
    """Content of a scene. `joints`: materials by name; `fractures`: for each fracture its material name or its
    section."""
    content = {**mesh, "Materials": {**{name: {"type": "elastic", "permeability": [k]} for name, k in (rocks or {"rock": 1.0}).items()},
                                     **{name: {"type": "joint", **joint} for name, joint in joints.items()}},
               "Bulk": {"material": "rock"}, "Flow": {"rigid rock": True, "viscosity": 1.0, **(fluid or {})}}
    if regions:
        content["Regions"] = {name: {"material": rock} for name, rock in regions.items()}
    content["Fractures"] = {name: {"material": joint} if isinstance(joint, str) else joint for name, joint in fractures.items()}
    return {**content, "Boundary conditions": conditions}


def box(d, n, fractures, regions=None, **more):
    """Mesh section of the unit square or cube; fractures {name: (lower corner, upper corner)}."""
    def corners(of):
        return {name: {"lower corner": list(low), "upper corner": list(high)} for name, (low, high) in of.items()}
    mesh = {"cell": ("triangle", "tetrahedron")[d - 2], "lower corner": [0.0] * d, "upper corner": [1.0] * d, "cells": [n] * d, **more}
    if regions:
        mesh["regions"] = corners(regions)
    return {"Mesh": {**mesh, "fractures": corners(fractures)}}


def sides(d):
    return ["west", "east", "south", "north", "bottom", "top"][:2 * d]


def across(d, axis, at, low=0.0, high=1.0):
    """Corners of a line or square in the plane x_axis = at."""
    return [at if k == axis else low for k in range(d)], [at if k == axis else high for k in range(d)]


def manufactured_solutions():
    from perf.verification import manufactured
    for d in (2, 3):
        for name, resists in (("resistance", True), ("continuous", False)):
            known, last = manufactured.flow(d, int(resists)), "xyz"[d - 1]
            joint = {"initial aperture": 0.1, "tangential permeability": "10 + 5*x", **({"normal permeability": "0.1 + 0.05*x"} if resists else {})}
            halves = {"below": ([0.0] * d, [1.0] * (d - 1) + [0.5]), "above": ([0.0] * (d - 1) + [0.5], [1.0] * d)}
            ends = {"below": sides(d)[-2], "above": sides(d)[-1]}
            conditions = {f"{half} {side}": {"boundary": side, "region": half, "pressure": known[half]} for half in halves for side in [*sides(d - 1), ends[half]]}
            conditions.update({f"fracture {side}": {"boundary": side, "fracture": "fracture", "pressure": known["fracture"]} for side in sides(d - 1)})
            source = f"{last}>0.5 ? ({known['above source']}) : ({known['below source']})"
            yield (f"flow_{name}_{d}d", f"A manufactured solution of flow through rock and along a fracture{' with a resistance across it' if resists else ''}. "
                   "See perf/verification/flow_exact.py.",
                   scene(box(d, 4, {"fracture": across(d, d - 1, 0.5)}, halves), {"joint": joint},
                         {"fracture": {"material": "joint", "source": known["fracture source"]}}, conditions,
                         regions={half: "rock" for half in halves}, fluid={"viscosity": 0.5, "source": source}))


def potential(r, share, along, part):
    """Expression -share * along - (1 - share) * r[part], with the real or imaginary part of sqrt(z^2 - 1) along the
    coordinate."""
    return f"-({share})*{along} - (1 - ({share}))*{r[part]}"


def single_fracture():
    mesh = mesh_file("crack")
    size, w = "sqrt(((x-1)^2+y^2)*((x+1)^2+y^2))", "(x^2-y^2-1)"
    r = [f"(x<0 ? -1 : 1)*sqrt(max({size}+{w},0)/2)", f"(y<0 ? -1 : 1)*sqrt(max({size}-{w},0)/2)"]
    for name, what, joint, along, part in (
            ("conductor", "along", {"initial aperture": 1.0, "tangential permeability": "T0(0)*sqrt(max(1-x^2,0))"}, "x", 0),
            ("barrier", "across", {"initial aperture": 1.0, "tangential permeability": 1e-30, "normal permeability": "c0(0)/sqrt(max(1-x^2,1e-12))"}, "y", 1)):
        parameter, share = (("T0", "2/(T0(0)+2)"), ("c0", "2*c0(0)/(1+2*c0(0))"))[part]
        content = scene(mesh, {"joint": joint}, {"crack": "joint"}, {"far": {"boundary": "boundary", "pressure": potential(r, share, along, part)}})
        content["Tables"] = {parameter: {"arguments": [0.0, 1.0], "values": [1.0, 1.0]}}
        yield (f"flow_{name}", f"Flow {what} a fracture in an infinite plane. The exact pressure is prescribed on the boundary of the box.", content)


def patches():
    joints = {"wide": {"initial aperture": 0.5, "residual aperture": 2.0}, "filled": {"initial aperture": 0.5, "tangential permeability": 6.0},
              "tight": {"initial aperture": 0.01, "tangential permeability": 1e-3}}
    linear = "1 + 0.7*x - 0.4*y"
    yield ("flow_patch_2d", "A constant pressure gradient in rock with straight, intersecting fractures.",
           scene(mesh_file(*meshes.NETWORK), joints, dict(zip(meshes.NETWORK, joints)), {"all": {"boundary": "boundary", "pressure": linear}}))
    fractures = {name: across(3, axis, at) for axis, (name, at) in enumerate((("x", 0.5), ("y", 0.25), ("z", 0.5)))}
    conditions = {side: {"boundary": side, "pressure": linear + " + 0.3*z"} for side in sides(3)}
    yield ("flow_patch_3d", "A constant pressure gradient in a rotated block of rock with plane, intersecting fractures.",
           scene(box(3, 4, fractures, rotation=30.0, **{"rotation axis": [1.0, 1.0, 0.0]}), joints, dict(zip(fractures, joints)), conditions))


CONDUCTIVE = {"initial aperture": 1e-4, "tangential permeability": 1e4, "normal permeability": 1e4}


def regular():
    lines = {"x1": ([0.5, 0.0], [0.5, 1.0]), "y1": ([0.0, 0.5], [1.0, 0.5]), "x2": ([0.75, 0.5], [0.75, 1.0]), "y2": ([0.5, 0.75], [1.0, 0.75]),
             "x3": ([0.625, 0.5], [0.625, 0.75]), "y3": ([0.5, 0.625], [0.75, 0.625])}
    yield ("flow_regular_2d", "Benchmark 1 of Flemisch et al. (2018): a regular network.",
           scene(box(2, 16, lines), {"joint": CONDUCTIVE}, dict.fromkeys(lines, "joint"),
                 {"inflow": {"boundary": "west", "flux": -1.0}, "outflow": {"boundary": "east", "pressure": 1.0}}))
    planes = {f"{name}{k}": across(3, axis, at, low, high) for axis, name in enumerate("xyz")
              for k, (at, low, high) in enumerate(((0.5, 0.0, 1.0), (0.75, 0.5, 1.0), (0.625, 0.5, 0.75)), 1)}
    regions = {"tight 1": ([0.5, 0.0, 0.0], [1.0, 0.5, 1.0]), "tight 2": ([0.75, 0.5, 0.5], [1.0, 0.75, 1.0]),
               "tight 3": ([0.625, 0.5, 0.5], [0.75, 0.625, 0.75]), "outlet": ([0.875] * 3, [1.0] * 3)}
    rest = {"west": "y<0.25 && z<0.25", "south": "x<0.25 && z<0.25", "bottom": "x<0.25 && y<0.25"}
    conditions = {f"inflow {side}": {"boundary": side, "flux": f"{where} ? -1 : 0"} for side, where in rest.items()}
    conditions.update({f"outflow {side}": {"boundary": side, "region": "outlet", "pressure": 1.0} for side in ("east", "north", "top")})
    yield ("flow_regular_3d", "Benchmark 2 of Berre et al. (2021): a regular network.",
           scene(box(3, 8, planes, regions), {"joint": CONDUCTIVE}, dict.fromkeys(planes, "joint"), conditions, {"rock": 1.0, "tight rock": 0.1},
                 {name: "rock" if name == "outlet" else "tight rock" for name in regions}))


def wells():
    """Radial flow to a well in the middle, exact on the sides.

    In the coordinates x/a and y a the flow is isotropic. The mean radius of the well is (a + 1/a)/2 times its
    radius there."""
    for d in (2, 3):
        middle = [[0.5, 0.5], [0.5, 0.5, 0.0, 0.5, 0.5, 1.0]][d - 2]
        pressure = "0.5*log(((x-0.5)/a(0))^2+((y-0.5)*a(0))^2)-log(0.001*(a(0)+1/a(0))/2)"
        well = {"points": middle, "radius": 0.001, "rate": "-2*pi*a(0)^2"}
        content = scene(box(d, 9, {}), {}, {}, {side: {"boundary": side, "pressure": pressure} for side in sides(2)}, fluid={"Wells": {"well": well}})
        content["Tables"] = {"a": {"arguments": [0.0, 1.0], "values": [1.0, 1.0]}}
        yield (f"flow_well_{d}d", "Flow to a well in an infinite plane. The exact pressure is prescribed on the sides (Thiem 1906).", content)


def others():
    joints = {name: {"initial aperture": width, "tangential permeability": 1e-6, "normal permeability": 1e-6}
              for name, width in (("falling", 5 * 2**0.5), ("steep", 33 / 5**0.5))}
    yield ("flow_hydrocoin", "Benchmark 2 of Flemisch et al. (2018): Hydrocoin. Conductivities for permeabilities, heads for pressures.",
           scene(mesh_file(*joints), joints, {name: name for name in joints}, {"top": {"boundary": "top", "pressure": "y"}}, {"rock": 1e-8}))
    yield ("flow_single", "Benchmark 1 of Berre et al. (2021): a single fracture. Conductivities for permeabilities, heads for pressures.",
           scene(mesh_file("fracture"), {"joint": {"initial aperture": 0.01, "tangential permeability": 0.1, "normal permeability": 0.1}},
                 {"fracture": "joint"}, {"inlet": {"boundary": "inlet", "pressure": 4.0}, "outlet": {"boundary": "outlet", "pressure": 1.0}},
                 {"rock": 1e-6, "layer": 1e-5}, {"lower": "layer", "upper": "rock"}))
