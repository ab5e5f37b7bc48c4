"""Scenes of slip driven by fluid in 3D, with meshes of boxes whose cells grow with the distance from the slipping
region."""
import numpy as np

from perf.common import scene_file
from perf.earthquakes import exact
from perf.earthquakes.tensor_mesh import both_ways, growing, numbers, write

YOUNG, FRICTION, COMPRESSION = 30e9, 0.6, 50e6  # Pa, -, Pa; Poisson's ratio is 0
PRESSURE = 2e6     # Pa, Q mu/(4 pi k w)
DIFFUSIVITY = 1.0  # m^2/s
VISCOSITY, COMPRESSIBILITY, APERTURE = 1e-3, 1e-11, 1e-3
RADIUS = 1.0       # m, of the slipping region at the end
FAR, GROWTH = 4.0, 1.3  # extent of the box over the radius, ratio of the lengths of neighbouring cells


def write_quarter(file, cells):
    """Writes the mesh of the quarter x, y > 0 of a box with the fault z = 0. `cells` is the number of cells along the
    radius."""
    size, far = RADIUS / cells, FAR * RADIUS
    plane, up = growing(size, GROWTH, far, 1.1 * RADIUS), growing(size, GROWTH, far)
    axes = [plane, plane, both_ways(up)]
    number = numbers(axes)
    write(file, axes, {"fault": number[:, :, len(up) - 1], "west": number[0], "east": number[-1], "south": number[:, 0],
                       "north": number[:, -1], "bottom": number[:, :, 0], "top": number[:, :, -1]})


def end_time(T):
    return (RADIUS / exact.front_coefficient(3, T)) ** 2 / (4 * DIFFUSIVITY)


def write_disc(file, T, cells, steps):
    """Writes the scene and mesh of injection at a constant rate into a fault with the stress parameter T, Poisson's
    ratio 0. The circular slipping region has the radius RADIUS at the end.

    The quarter x, y > 0 is symmetric: u_y is 0 at y = 0, u_y and u_z are 0 at x = 0, where u_x is even. The fluid
    enters the face at the corner. The outer sides have the displacement of a dislocation at the origin with the
    exact integral of slip."""
    write_quarter(file.with_suffix(".msh"), cells)
    end, traction = end_time(T), FRICTION * PRESSURE
    potency = exact.potency(3, T, traction, YOUNG, RADIUS)
    permeability = DIFFUSIVITY * VISCOSITY * COMPRESSIBILITY
    rate = PRESSURE * 4 * np.pi * permeability * APERTURE / VISCOSITY
    edge = 1.1 * RADIUS / round(1.1 * cells)
    far = {"displacement": ["strength*z*(1 + 3*x^2/r2)", "strength*3*x*y*z/r2", "strength*x*(1 + 3*z^2/r2)"]}
    scene = {
        "Expressions": {"potency": f"{potency:.17g}*(t/{end:.17g})^1.5", "r2": "x^2 + y^2 + z^2",
                        "strength": "potency/(8*pi*r2^1.5)"},
        "Mesh file": {"path": file.with_suffix(".msh").name, "fractures": {"fault": {"reference normal": [0, 0, 1]}}},
        "Materials": {
            "rock": {"type": "elastic", "Young's modulus": YOUNG, "Poisson's ratio": 0.0, "permeability": [0.0]},
            "gouge": {"type": "joint", "friction coefficient": FRICTION, "initial aperture": APERTURE,
                      "tangential permeability": permeability}},
        "Bulk": {"material": "rock",
                 "initial stress": [-COMPRESSION] * 3 + [0.0, 0.0, FRICTION * COMPRESSION - T * traction]},
        "Flow": {"viscosity": VISCOSITY, "compressibility": COMPRESSIBILITY, "initial pressure": 0.0},
        "Fractures": {"fault": {"material": "gouge", "source": f"x < {edge:.17g} && y < {edge:.17g} ? "
                                f"{rate / 4 / edge**2:.17g} : 0"}},
        "Boundary conditions": {
            "west": {"boundary": "west", "displacement": ["free", "0", "0"]},
            "initial stress in the west": {"boundary": "west", "confining pressure": COMPRESSION},
            "initial stress in the south": {"boundary": "south", "confining pressure": COMPRESSION},
            "south": {"boundary": "south", "displacement": ["free", "0", "free"]},
            **{side: {"boundary": side, **far} for side in ("east", "north", "bottom", "top")}},
        "Time": {"scheme": "BDF2", "schedule": [end * (k / steps) ** 2 for k in range(1, steps + 1)]},
        "Output": {"every": 100000}}
    scene_file.save(scene, file, "Slip driven by injection at a constant rate: a circular front (perf/earthquakes).")
