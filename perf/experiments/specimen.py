"""Injection-shear test as a scene: a specimen of poroelastic rock with an inclined fracture between platens, in
plane strain.

Friction of the joint and stiffness of specimen and machine are the values fitted at a point. The hydraulic
opening of the joint has three coefficients, fitted to the flow of the rising stages."""
import math
from dataclasses import dataclass

import numpy as np

from perf.common import program

SCENE = "poro/injection_shear_2d.xml"
ANGLE = math.radians(30)       # between fracture and axis
ROCK, POISSON = 67e9, 0.32     # Young's modulus, Pa; Poisson's ratio, -
CONFINED = 30e6                # Pa
MACHINE, WIDTH = 0.01, 0.0505  # m: height of the layer, width of the specimen
STAGE = 600.0                  # s
STIFF = 1e17                   # Pa/m; for joints without closure by effective stress


@dataclass
class Specimen:
    length: float             # m
    hydraulic_aperture: float  # m, in the first stage: measured flow with the cubic law
    joint: dict               # entries of the joint
    stiffness: float          # Pa/m, of specimen and machine along the fracture


def aperture(columns, slip, hydraulic, rising, outlet):
    """Returns (aperture at zero stress, m; its increase with slip, -; its decrease with effective stress, m/Pa).

    The values are fitted to the flow of the rising stages."""
    stress = columns["effective normal stress"][0]
    root = np.cbrt(columns["flow rate"][0] / (columns["injection pressure"][0] - outlet))
    A = np.array([np.ones_like(slip), slip / np.max(slip), -stress / stress[0]]).T[rising]
    wide, grows, closes = np.linalg.lstsq(A, root[rising], rcond=None)[0] * hydraulic / root[0]
    return wide, grows / np.max(slip), closes / stress[0]


def entries(specimen, shear, wide, dilation, closes):
    """Entries of the scene. `shear` is the shear stress of the first stage, `dilation` a tangent."""
    axial = specimen.stiffness / (math.sin(ANGLE) * math.cos(ANGLE)**2)  # axial stiffness of specimen and machine
    machine = 1 / (1 / axial - specimen.length * (1 - POISSON**2) / ROCK)
    rise = WIDTH / math.tan(ANGLE)
    low, top = (specimen.length - rise) / 2, specimen.length + MACHINE
    network = "Mesh file.network"
    differential = shear / (math.sin(ANGLE) * math.cos(ANGLE))
    values = {f"{network}.domain.upper corner": f"{{{WIDTH}, {top}}}",
              f"{network}.fractures.cut.lines.line.points": f"{{0, {low}, {WIDTH}, {low + rise}}}",
              f"{network}.regions.machine.lower corner": f"{{0, {specimen.length}}}",
              f"{network}.regions.machine.upper corner": f"{{{WIDTH}, {top}}}",
              "Materials.machine.Young's modulus": machine * MACHINE,
              "Bulk.initial stress": f"{{{-CONFINED}, {-CONFINED - differential}, {-CONFINED}, 0}}",
              "Materials.saw cut.initial aperture": wide,
              "Materials.saw cut.dilation angle": math.degrees(math.atan(dilation)),
              "Materials.saw cut.normal stiffness": 1 / closes if closes > 1 / STIFF else STIFF}
    values.update({f"Materials.saw cut.{name}": value for name, value in specimen.joint.items()})
    return [f"{path}={value}" for path, value in values.items()]


def run(binary, directory, entries):
    """Runs the scene; returns {quantity: values at the stage ends} with the signs of the tables."""
    mesh = program.mesh(binary, SCENE, directory / "specimen.msh", entries)
    steps = program.succeeded(binary, SCENE, directory, (f"Mesh file.path={mesh}", *entries), clear=False).steps
    ends = [step for step in steps if abs(step["time"] / STAGE - round(step["time"] / STAGE)) < 1e-9]
    cut = [step["fractures"]["cut"] for step in ends]
    traction = np.array([face["mean_traction"]["local"] for face in cut])
    slip, opening = (np.array([face[name] for face in cut]) for name in ("mean_slip", "mean_opening"))
    return {"effective normal stress": -traction[:, 0], "shear stress": abs(traction[:, 1]), "slip": slip - slip[0],
            "normal displacement": opening[0] - opening, "flow rate": np.array([-step["inflows"]["east"] for step in ends])}
