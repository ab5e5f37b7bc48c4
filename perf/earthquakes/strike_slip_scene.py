"""Scene of problem BP5-QD: a vertical strike-slip fault in 3D, in a box on both sides of the fault."""
import numpy as np

from perf.common import scene_file
from perf.earthquakes import half_space
from perf.earthquakes.half_plane import POISSON, SHEAR_MODULUS, SHEAR_SPEED
from perf.earthquakes.tensor_mesh import both_ways, fitted, growing, numbers, write

FINE_ALONG, FINE_DOWN = 32e3, 18e3  # m, part of the fault with the smallest cells: half-length, depth
CREEPING, BEYOND, AWAY = 1.2, 1.6, 1.6  # ratios of neighbouring cells around this part, beyond the fault, away from it
FIRST = 0.5  # size of the cells next to the fault, normal to it, over their size along it
REFERENCE, REFERENCE_RATE = 0.6, 1e-6  # of friction, m/s
DAMPING = SHEAR_MODULUS / (2 * SHEAR_SPEED)  # Pa s/m
WIDE, LONG, DEEP = 55e3, 80e3, 70e3  # m, half-width, half-length and depth of the box


def graded(size, fine, friction, end):
    """Coordinates from 0: equal cells up to `fine`, cells that grow up to `friction` and faster up to `end`."""
    inner = fine + fitted(growing(size * CREEPING, CREEPING, friction - fine - size), friction - fine)
    outer = friction + fitted(growing((inner[-1] - inner[-2]) * BEYOND, BEYOND, end - friction - size), end - friction)
    return np.concatenate([np.linspace(0, fine, round(fine / size) + 1), inner[1:], outer[1:]])


def shear_stress():
    """Uniform initial shear stress: that of steady slip at the plate rate where friction weakens."""
    log = np.log(half_space.PLATE_RATE / REFERENCE_RATE)
    return float(half_space.COMPRESSION * (REFERENCE + (half_space.WEAK - half_space.EVOLUTION) * log) + DAMPING * half_space.PLATE_RATE)


def write_scene(file, size, end):
    """Writes the scene and its mesh with cells of this size where friction weakens. Fault x = 0, strike y.

    The initial shear stress is uniform. In problem BP5-QD it varies along the fault; the reference friction coefficient
    contains the difference, divided by the compression. This is equivalent, since friction increases with the logarithm of
    the slip rate and the compression is constant."""
    along = both_ways(graded(size, FINE_ALONG, half_space.LENGTH / 2, LONG))
    down = -graded(size, FINE_DOWN, half_space.DEPTH, DEEP)[::-1]
    aside = both_ways(fitted(growing(FIRST * size, AWAY, WIDE), WIDE))
    axes = [aside, along, down]
    number = numbers(axes)
    plane = number[len(aside) // 2]
    south, north = (int(np.argmin(np.abs(along - y))) for y in (-half_space.LENGTH / 2, half_space.LENGTH / 2))
    deep = int(np.argmin(np.abs(down + half_space.DEPTH)))
    write(file.with_suffix(".msh"), axes, {
        "fault": plane[south : north + 1, deep:], "deep": plane[:, : deep + 1], "south": plane[: south + 1, deep:],
        "north": plane[north:, deep:], "west": number[0], "east": number[-1], "front": number[:, 0], "back": number[:, -1]})
    N, V, b, shear = half_space.COMPRESSION, half_space.PLATE_RATE, half_space.EVOLUTION, shear_stress()
    loaded = {"prescribed slip": {"slip": [f"{V:g}*t"], "direction": [0.0, 1.0, 0.0], "moving side": [1.0, 0.0, 0.0]}}
    scene = {
        "Expressions": {
            "outside": f"max(max(abs(z + {(half_space.TOP + half_space.BOTTOM) / 2:g}) - {(half_space.BOTTOM - half_space.TOP) / 2:g},"
                       f" abs(y) - {half_space.HALF:g}), 0)",
            "direct": f"{half_space.WEAK} + {half_space.STRONG - half_space.WEAK:.17g}*min(outside/{half_space.TURN:g}, 1)",
            "nucleus": f"y > -{half_space.HALF:g} && y < {half_space.NUCLEUS - half_space.HALF:g} && z < -{half_space.TOP:g}"
                       f" && z > -{half_space.BOTTOM:g}",
            "first": f"nucleus ? {half_space.FIRST_RATE:g} : {V:g}",
            "distance": f"nucleus ? {half_space.OF_NUCLEUS} : {half_space.DISTANCE}"},
        "Mesh file": {"path": file.with_suffix(".msh").name, "tips": "plain",
                      "fractures": {part: {"reference normal": [1.0, 0.0, 0.0]} for part in ("fault", "deep", "south", "north")}},
        "Materials": {
            "rock": {"type": "elastic", "shear modulus": SHEAR_MODULUS, "Poisson's ratio": POISSON},
            "gouge": {"type": "joint", "friction": "rate and state", "direct effect": "direct", "evolution effect": b,
                      "reference friction coefficient":
                          f"({shear:.17g} - {DAMPING:.17g}*first)/{N:g} - direct*log(first/{REFERENCE_RATE:g})"
                          f" + {b * np.log(V / REFERENCE_RATE):.17g}",
                      "state evolution distance": "distance", "initial slip rate": "first",
                      "initial state": f"distance/{V:g}", "radiation damping": DAMPING}},
        "Bulk": {"material": "rock", "initial stress": [-N, -N, 0.0, shear, 0.0, 0.0]},
        "Fractures": {"fault": {"material": "gouge"},
                      **{part: {"material": "gouge", **loaded} for part in ("deep", "south", "north")}},
        "Boundary conditions": {
            "west": {"boundary": "west", "displacement": ["0", f"-{V / 2:g}*t", "0"]},
            "east": {"boundary": "east", "displacement": ["0", f"{V / 2:g}*t", "0"]},
            "front": {"boundary": "front", "traction": [-shear, N, 0.0]},
            "back": {"boundary": "back", "traction": [shear, -N, 0.0]}},
        "Time": {"end": end, "tolerance": 1e-2, "first step": 0.1},
        "Solver": {"Linear solver": {"type": "direct"}},
        "Output": {"vtu": False, "every": 100000, "events": {"rate": 1e-3}}}
    scene_file.save(scene, file, "Earthquakes on a vertical strike-slip fault in 3D (perf/earthquakes).")
