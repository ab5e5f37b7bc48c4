"""Scenes of heat, see scenes.py."""
import math

from perf.verification import flow_scenes, heat_exact, poro_scenes


def sliding_fractures():
    from perf.verification import manufactured
    made, heat = ({name: float(value) for name, value in of.items()} for of in (manufactured.ROCK, manufactured.HEAT))
    rock = poro_scenes.unit_rock(1.0, porosity=made["porosity"], compressibility_of_pores=made["growth"], Biot_coefficient=made["alpha"],
                                 thermal_conductivity=[heat["conductivity"]], volumetric_heat_capacity=heat["capacity"],
                                 thermal_expansion=heat["expansion"])
    joint = {"volumetric heat capacity": heat["of filling"], "friction coefficient": float(manufactured.FRICTION), "tangential stiffness": float(manufactured.STIFFNESS),
             "dilation angle": math.degrees(math.atan(heat["dilation"])), "initial aperture": 1.0, "thermal conductivity": heat["in fracture"]}
    for d in (2, 3):
        for name, carried, heat_transport in (("carried", 1, "with"), ("conducted", 0, "without")):
            warm = {"initial temperature": heat["start"], "fluid heat capacity": float(carried),
                    "fluid thermal expansion": heat["of fluid expansion"], "heat of friction": True}
            yield (f"manufactured_heat_{name}_{d}d", f"A manufactured solution of rock with a fracture that slides and opens, {heat_transport} heat transport by the fluid. "
                   "See perf/verification/heat_exact.py.",
                   poro_scenes.halved_block(d, manufactured.warmed(d, carried), rock, joint, {"viscosity": 0.5}, warm),
                   {"end": 1.0, "steps": 2})


def sliding_in_time():
    """Yields the scenes of heat_exact.SlidingInTime, with errors of the time steps only. Lame's constants are 1,
    the oedometric modulus is M = 3."""
    known = heat_exact.SlidingInTime()
    slip, slides, p, flows = "(1-cos(2*t))/4", "sin(2*t)/2", "sin(3*t)", "3*cos(3*t)"
    opens = f"{known.tangent!r}*{slides}"
    warmth, warms = f"{known.rise!r}*ln(1+{known.tangent / known.a_0!r}*{slip})", f"{known.rise!r}*{opens}/({known.a_0!r}+{known.tangent!r}*{slip})"
    by_heat = 5 * known.expansion / 3
    across = f"{(known.alpha - 1) / 3!r}*{p}+{by_heat!r}*{warmth}+{known.tangent!r}*{slip}"
    pores = known.porosity * known.fluid_expansion + (known.alpha - known.porosity) * 3 * known.expansion
    fluid = f"{known.alpha * (known.alpha - 1) / 3 + known.stored!r}*{flows}+{known.alpha * by_heat - pores!r}*{warms}"
    rock = poro_scenes.unit_rock(0.01, porosity=known.porosity, compressibility_of_pores=known.stored, Biot_coefficient=known.alpha,
                                 thermal_conductivity=[0.1], volumetric_heat_capacity=2.0, thermal_expansion=known.expansion)
    joint = {"type": "joint", "friction coefficient": known.friction, "tangential stiffness": 2.0,
             "dilation angle": math.degrees(math.atan(known.tangent)), "initial aperture": known.a_0, "volumetric heat capacity": known.c}
    for d in (2, 3):
        mesh = flow_scenes.box(d, 4, {"fracture": flow_scenes.across(d, d - 1, 0.5)}, periodic=["x", "y"][:d - 1])
        mesh["Mesh"]["fractures"]["fracture"]["reference normal"] = [0.0] * (d - 1) + [1.0]
        mesh["Mesh"]["cells"] = [3] * (d - 1) + [4]
        down, up = flow_scenes.sides(d)[-2:]
        along = [1.0] if d == 2 else [0.8, 0.6]
        shear = known.friction * known.N
        stress = [0.0, -known.N, 0.0, shear] if d == 2 else [0.0, 0.0, -known.N, 0.0, 0.6 * shear, 0.8 * shear]
        yield (f"heat_time_{d}d", "A fracture that slides, opens and is heated by friction. See perf/verification/heat_exact.py.",
               {**mesh, "Materials": {"rock": rock, "joint": joint}, "Bulk": {"material": "rock", "initial stress": stress},
                "Fractures": {"fracture": {"material": "joint", "source": f"{1 - known.fluid_expansion * known.rise / known.c!r}*{opens}"}},
                "Flow": {"viscosity": 1.0, "source": fluid},
                "Heat": {"initial temperature": known.start, "fluid heat capacity": known.c, "heat of friction": True,
                         "fluid thermal expansion": known.fluid_expansion, "source": f"2*{warms}"},
                "Boundary conditions": {"fixed": {"boundary": down, "displacement": [0.0] * d},
                                        "moved": {"boundary": up, "displacement": [*(f"{part!r}*{slip}" for part in along), across]}}},
               {"end": 0.5, "steps": 10})
