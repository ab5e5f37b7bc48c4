"""Project and geometry files of OpenGeoSys 6.5.9 for its processes with lower-dimensional interface elements (LIE)."""

CG = {"solver_type": "CG", "precon_type": "DIAGONAL", "max_iteration_step": 10000, "error_tolerance": 1e-16}
SPARSE_LU = {"solver_type": "SparseLU", "scaling": 1}


def text(value):
    return " ".join(map(repr, map(float, value))) if isinstance(value, (list, tuple)) else str(value)


def written(name, content):
    """Element of a name. Entries of a dict are nested elements; with "@" attributes, with "#" the text. A list of dicts
    gives one element each."""
    if isinstance(content, list) and content and isinstance(content[0], dict):
        return "".join(written(name, one) for one in content)
    if not isinstance(content, dict):
        content = {"#": content}
    attributes = "".join(f' {key[1:]}="{value}"' for key, value in content.items() if key[0] == "@")
    inner = "".join(text(value) if key == "#" else written(key, value)
                    for key, value in content.items() if key[0] != "@")
    return f"<{name}{attributes}>{inner}</{name}>\n"


def save(file, root, content):
    file.write_text('<?xml version="1.0"?>\n' + written(root, content))
    return file


def geometry(points, lines):
    """Points {name: (x, y)} and polylines {name: (point, ...)}, as a set named "sides"."""
    number = {name: k for k, name in enumerate(points)}
    return {"name": "sides",
            "points": {"point": [
                {"@id": number[name], "@name": name, "@x": repr(float(x)), "@y": repr(float(y)), "@z": 0}
                for name, (x, y) in points.items()]},
            "polylines": {"polyline": [{"@id": k, "@name": name, "pnt": [{"#": number[point]} for point in ends]}
                                       for k, (name, ends) in enumerate(lines.items())]}}


def parameter(name, value):
    """Constant, or (curve, factor)."""
    if isinstance(value, tuple):
        return {"name": name, "type": "CurveScaled", "curve": value[0], "parameter": value[1]}
    return {"name": name, "type": "Constant", "values": value if isinstance(value, list) else repr(float(value))}


def variable(name, components, order, initial, conditions):
    """Process variable; conditions (geometry, type, component, parameter)."""
    found = {"name": name, "components": components, "order": order, "initial_condition": initial}
    made = [{"geometrical_set": "sides", "geometry": place, "type": kind, "component": component, "parameter": value}
            for place, kind, component, value in conditions]
    return {**found, "boundary_conditions": {"boundary_condition": made} if made else {}}


def constants(values):
    return [{"name": name, "type": "Constant", "value": repr(float(value))} for name, value in values.items()]


def medium(number, permeability, storage, biot, porosity):
    """Rock, or a fracture if the permeability is None: cubic law. Water of viscosity 1e-3 Pa s, no gravity."""
    cubic = [{"name": "permeability", "type": "CubicLawPermeability"}]
    phases = [{"type": "AqueousLiquid", "properties": {"property": constants({"viscosity": 1e-3, "density": 1e3})}},
              {"type": "Solid", "properties": {"property": constants({"density": 1e3})}}]
    more = constants({"storage": storage, "biot_coefficient": biot, "porosity": porosity,
                      "reference_temperature": 293.15})
    of_rock = cubic if permeability is None else constants({"permeability": permeability})
    return {"@id": number, "phases": {"phase": phases}, "properties": {"property": of_rock + more}}


def joint(kind, local=1e-10):
    """Law of fractures; parameters Kn, Ks, and of Coulomb's law. `local`: tolerance of its iteration, Pa."""
    coulomb = {"friction_angle": "friction_angle", "dilatancy_angle": "dilation_angle", "cohesion": "cohesion",
               "nonlinear_solver": {"maximum_iterations": 100, "error_tolerance": local}} if kind == "Coulomb" else {}
    return {"type": kind, "normal_stiffness": "Kn", "shear_stiffness": "Ks", **coulomb, "penalty_aperture_cutoff": 1e-5,
            "tension_cutoff": 1}


def process(law, fractures, junctions=0, flow=False, tight=False):
    """Mechanics, or flow and mechanics, with fractures of MaterialIDs 1 to `fractures`; tight: no flow in rock."""
    names = ["pressure"] * flow + ["displacement"] + [f"displacement_jump{k + 1}" for k in range(fractures + junctions)]
    more = {"specific_body_force": [0, 0], "initial_effective_stress": "s0", "initial_fracture_effective_stress": "t0"}
    return {"name": "P", "type": "HYDRO_MECHANICS_WITH_LIE" if flow else "SMALL_DEFORMATION_WITH_LIE",
            "integration_order": 3 if flow else 2,
            "process_variables": {"process_variable": [{"#": name} for name in names]},
            "constitutive_relation": {"type": "LinearElasticIsotropic", "youngs_modulus": "E", "poissons_ratio": "nu"},
            **(more if flow else {}), **({"deactivate_matrix_in_flow": "true"} if tight else {}), "fracture_model": law,
            "fracture_properties": [{"material_id": k + 1, "initial_aperture": "aperture"} for k in range(fractures)]}


def project(mesh, law, variables, parameters, steps, criterion, linear, media=(), curves=None, iterations=50):
    """Content of a project file; steps (number, length in s). Only the last step is written."""
    number, length = steps
    times = {"type": "FixedTimeStepping", "t_initial": 0, "t_end": repr(number * float(length)),
             "timesteps": {"pair": {"repeat": number, "delta_t": repr(float(length))}}}
    output = {"type": "VTK", "prefix": "result", "timesteps": {"pair": {"repeat": 1, "each_steps": number}},
              "variables": {"variable": [{"#": one["name"]} for one in variables]}, "suffix": "_{:timestep}"}
    loop = {"processes": {"process": {"@ref": "P", "nonlinear_solver": "newton", "convergence_criterion": criterion,
                                      "time_discretization": {"type": "BackwardEuler"}, "time_stepping": times}},
            "output": output}
    tables = {"curve": [{"name": name, "coords": list(at), "values": list(values)}
                        for name, (at, values) in (curves or {}).items()]}
    return {"mesh": mesh, "geometry": "sides.gml", "processes": {"process": law},
            **({"media": {"medium": list(media)}} if media else {}), "time_loop": loop,
            "parameters": {"parameter": [parameter(*one) for one in parameters.items()]},
            **({"curves": tables} if curves else {}), "process_variables": {"process_variable": variables},
            "nonlinear_solvers": {"nonlinear_solver": {"name": "newton", "type": "Newton", "max_iter": iterations,
                                                       "linear_solver": "linear"}},
            "linear_solvers": {"linear_solver": {"name": "linear", "eigen": linear}}}
