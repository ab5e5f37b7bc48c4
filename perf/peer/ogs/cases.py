"""The cases: parameters of published benchmarks of OpenGeoSys (ufz/ogs, Tests/Data/LIE), for both programs."""
from dataclasses import dataclass
from pathlib import Path

from perf.peer.ogs import meshes, project

HERE = Path(__file__).resolve().parent
PLATE = {"E": 170e6, "nu": 0.22, "load": 7e3, "Kn": 1e12}  # cross
BAR = {"length": 25, "height": 1, "aperture": 1e-5, "before": 11e6, "inlet": 11.9e6, "E": 60e9, "Kn": 1e11, "Ks": 1e11,
       "viscosity": 1e-3, "dt": 10, "steps": 10}
CLOSING = -39e6                 # initial effective normal traction on the fracture of strip, Pa
ROCK = {"undrained": 0.125, "permeability": 1e-21, "storage": 1e-10 + 1 / 60e9}  # of strip; storage uniaxial, 1/Pa
TIGHT = {"undrained": 0, "permeability": 0, "storage": 0}
SQUARE, TOP = 10, 4.63235       # fault_ramp: half side of the square, x of the upper end of the fault, m
RAMP = (32, 10)                 # steps, s
JOINT = 20e9                    # normal and tangential stiffness of the fault, Pa/m
INITIAL = (-5100346.893, -648368.307)  # initial effective traction on the fault: normal, tangential, Pa
WIDER = 8                       # width of the outer columns of fault_ramp over that at the fault


@dataclass
class Case:
    """A mesh of a case, the project of OpenGeoSys and the scene of Sprekk with its entries."""
    mesh: meshes.Mesh
    order: int       # of displacements
    project: dict
    geometry: dict
    scene: Path
    further: int     # unknowns of OpenGeoSys other than displacements: jumps, pressures
    sets: tuple = ()

    @property
    def unknowns(self):
        """Number of unknowns of OpenGeoSys."""
        corners, cells = len(self.mesh.points), len(self.mesh.cells)
        return 2 * (corners + (corners + cells - 1 if self.order == 2 else 0)) + self.further


def corners(width, height):
    """Corners and sides of a rectangle from the origin."""
    points = {"SW": (0, 0), "SE": (width, 0), "NE": (width, height), "NW": (0, height)}
    return points, {"SOUTH": ("SW", "SE"), "NORTH": ("NW", "NE"), "WEST": ("SW", "NW"), "EAST": ("SE", "NE")}


def cross(k):
    """Mechanics/two_cracks_junction_pull: fractures of 20 mm cross in a plate of 50 mm x 100 mm; cells of 5/k mm."""
    fractures = {"f1": ((10 * k, 3 * k), (10 * k, 7 * k)), "f2": ((8 * k, 5 * k), (12 * k, 5 * k))}
    variables = [project.variable("displacement", 2, 1, "zeros", [
        ("SOUTH", "Dirichlet", 1, "zero"), ("SW", "Dirichlet", 0, "zero"), ("NORTH", "Neumann", 1, "load")])]
    variables += [project.variable(f"displacement_jump{j}", 2, 1, "zeros", []) for j in (1, 2, 3)]
    parameters = {**PLATE, "Ks": 1e9, "aperture": 1e-5, "zero": 0, "zeros": [0, 0]}
    criterion = {"type": "Residual", "norm_type": "NORM2", "abstol": 1e-6}
    law = project.process(project.joint("LinearElasticIsotropic"), 2, junctions=1)
    made = project.project("mesh.vtu", law, variables, parameters, (1, 1), criterion, project.CG)
    return Case(meshes.Mesh(meshes.rectangle(0.05, 0.1, 10 * k, 20 * k), fractures), 1, made,
                project.geometry(*corners(0.05, 0.1)), HERE / "cross.xml", 4 * (4 * k - 1) + 2)


def strip(columns, rows, first=None, tight=False):
    """HydroMechanics/single_fracture: injection at one end of a fracture of 25 m, with steps of 10 s.

    `first`: height of the rows at the fracture, m; otherwise rows are equal. tight: impermeable rock."""
    length, height = BAR["length"], BAR["height"]
    points, sides = corners(length, height)
    points |= {"IN": (0, height / 2), "OUT": (length, height / 2)}
    rollers = [(side, "Dirichlet", 0, "zero") for side in ("WEST", "EAST")]
    variables = [
        project.variable("pressure", 1, 1, "before", [("IN", "Dirichlet", 0, "inlet"),
                                                      ("OUT", "Dirichlet", 0, "before")]),
        project.variable("displacement", 2, 2, "zeros", [("SOUTH", "Dirichlet", 1, "zero"), *rollers,
                                                         ("NORTH", "Neumann", 1, "load")]),
        project.variable("displacement_jump1", 2, 2, "zeros", rollers)]
    parameters = {**{name: BAR[name] for name in ("E", "Kn", "Ks", "aperture", "before", "inlet")}, "nu": 0,
                  "load": -50e6, "s0": [-13e6, CLOSING, 0, 0], "t0": [0, CLOSING], "zero": 0, "zeros": [0, 0]}
    media = [project.medium(0, 1e-21, 1e-10, 0 if tight else 1, 1e-3), project.medium(1, None, 1e-12, 1, 1)]
    criterion = {"type": "PerComponentResidual", "norm_type": "NORM2", "abstols": [1e-18, 1e-7, 1e-5, 1e-8, 1e-6, 1, 1]}
    law = project.process(project.joint("LinearElasticIsotropic"), 1, flow=True, tight=tight)
    made = project.project("mesh.vtu", law, variables, parameters, (BAR["steps"], BAR["dt"]), criterion,
                           project.SPARSE_LU, media)
    grid = meshes.layered(length, height, columns, rows, first)
    sets = ("Materials.rock.permeability={0}",) if tight else ()
    return Case(meshes.Mesh(grid, {"fracture": ((rows // 2, 0), (rows // 2, columns))}), 2, made,
                project.geometry(points, sides), HERE / "strip.xml",
                2 * (2 * columns + 1) + (columns + 1) * (1 if tight else rows + 1), sets)


def fault_ramp(n):
    """HydroMechanics/TaskB with the joint of Mechanics/coulomb_load_path and a pressure that increases with time; n
    edges on the fault."""
    names, ends = ("SW", "SE", "NE", "NW"), ((-SQUARE, -SQUARE), (SQUARE, -SQUARE), (SQUARE, SQUARE), (-SQUARE, SQUARE))
    points = {**dict(zip(names, ends)), "LOWER": (-TOP, -SQUARE), "UPPER": (TOP, SQUARE), "IN": (0, 0)}
    sides = {"SOUTH": ("SW", "SE"), "NORTH": ("NW", "NE"), "WEST": ("SW", "NW"), "EAST": ("SE", "NE")}
    fixed = [("IN", "Dirichlet", 0, "pressed"), *((end, "Dirichlet", 0, "before") for end in ("UPPER", "LOWER"))]
    variables = [
        project.variable("pressure", 1, 1, "before", fixed),
        project.variable("displacement", 2, 2, "zeros", [
            ("NORTH", "Dirichlet", 1, "zero"), ("SOUTH", "Dirichlet", 1, "zero"), ("WEST", "Dirichlet", 0, "zero"),
            ("EAST", "Dirichlet", 0, "zero")]),
        project.variable("displacement_jump1", 2, 2, "zeros", [("UPPER", "Dirichlet", 1, "zero"),
                                                               ("LOWER", "Dirichlet", 1, "zero")])]
    parameters = {"E": 6.1065e9, "nu": 0.3275, "Kn": JOINT, "Ks": JOINT, "aperture": 1e-5, "friction_angle": 22,
                  "dilation_angle": 10, "cohesion": 0, "s0": [-5.3e6, -7e6, 0, 0], "t0": [*INITIAL[::-1]],
                  "before": 0.5e6, "mega": 1e6, "pressed": ("ramp", "mega"), "zero": 0, "zeros": [0, 0]}
    media = [project.medium(0, 1e-17, 1e-10, 0, 0), project.medium(1, None, 4.4e-10, 1, 1)]
    criterion = {"type": "PerComponentDeltaX", "norm_type": "NORM2", "reltols": [1e-8] * 7}
    law = project.process(project.joint("Coulomb", 1e-4), 1, flow=True, tight=True)
    made = project.project("mesh.vtu", law, variables, parameters, RAMP, criterion, project.SPARSE_LU, media,
                           {"ramp": ((0, RAMP[0] * RAMP[1]), (0.5, 4.9))})
    grid = meshes.inclined(SQUARE, TOP, n, n // 4, WIDER)
    return Case(meshes.Mesh(grid, {"fault": ((0, n // 4), (n, n // 4))}), 2, made, project.geometry(points, sides),
                HERE / "fault_ramp.xml", 2 * (2 * n + 1) + n + 1)

