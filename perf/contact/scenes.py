"""Scenes of the benchmark: files of xml/ with replaced entries, as by --set, and known properties of the solution."""
from dataclasses import dataclass
from typing import Callable

from perf.contact import exact

JOINT = "Materials.joint."
STIFFNESS, FRICTION, DILATION = JOINT + "tangential stiffness", JOINT + "friction coefficient", JOINT + "dilation angle"
GAP, CLOSURE, NORMAL = JOINT + "initial gap", JOINT + "maximum closure", JOINT + "normal stiffness"


@dataclass
class Scene:
    name: str
    file: str                # under xml/
    sets: tuple = ()
    exact: Callable = None   # function of a run that returns its largest relative error
    tolerance: float = 1e-8  # of that error
    newton: int = 0          # largest allowed number of Newton iterations per step; 0: not checked
    refused: str = ""        # pattern of the expected error message; the run must fail
    group: str = ""          # scenes of one group must need the same Newton iterations
    quick: bool = False      # included in --quick
    several: bool = False    # several equilibria: the result may depend on the number of ranks


def joint(**entries):
    names = dict(stiffness=STIFFNESS, friction=FRICTION, dilation=DILATION, gap=GAP, closure=CLOSURE, normal=NORMAL)
    return tuple(f"{names[key]}={value}" for key, value in entries.items())


def pressure(names, text="p(t)"):
    """Entries for a fluid pressure in these fractures."""
    return tuple(f"Fractures.{name}.fluid pressure={text}" for name in names)


def table(name, *points):
    """Entries of a table with points (t, value)."""
    times, values = ("{" + ", ".join(map(str, row)) + "}" for row in zip(*points))
    return f"Tables.{name}.arguments={times}", f"Tables.{name}.values={values}"


def held(end, **loads):
    """Entries for `end` steps of length 1, with tables of loads that rise in the first step and then stay constant."""
    return sum((table(name, (0, 0), (1, load), (end, load)) for name, load in loads.items()), (f"Time.end={end}", f"Time.steps={end}"))


SOFT_CLOSURE = dict(closure="1e-2", normal="1")     # relative to E = 1 and a domain of size 1
STIFF_CLOSURE = dict(closure="1e-4", normal="1e3")
NO_EQUILIBRIUM = r"no equilibrium"
FREE = r"(free to move|can move|can rotate|nothing constrains|singular mode)"


def seed():
    for dim in (2, 3):
        for what in ("push", "pull"):
            yield Scene(f"seed {what} {dim}D", f"seed/{what}_{dim}d.xml", exact=exact.seed, quick=dim == 2 or what == "push")


def networks():
    x, t, box = "contact/network_x.xml", "contact/network_t.xml", "contact/network_3d.xml"
    for stiffness in ("infinite", "1e-6", "1e-3", "1", "1e3", "1e6"):
        yield Scene(f"network X K_t={stiffness}", x, joint(stiffness=stiffness), quick=stiffness in ("infinite", "1e-6", "1e6"))
    for friction in ("0", "0.1", "1", "2"):
        yield Scene(f"network X mu={friction}", x, joint(friction=friction), quick=friction in ("0", "2"))
    yield Scene("network X dilation 5", x, joint(dilation=5))
    yield Scene("network X dilation 20", x, joint(dilation=20), quick=True)
    yield Scene("network X dilation 20 mu=1", x, joint(dilation=20, friction=1))
    yield Scene("network X soft closure", x, joint(**SOFT_CLOSURE), quick=True)
    yield Scene("network X stiff closure", x, joint(**STIFF_CLOSURE))
    all_of_it = joint(stiffness=10, dilation=5, closure="1e-3", normal=10)
    yield Scene("network X all of it", x, all_of_it, quick=True)
    yield Scene("network X gap 1e-12", x, joint(gap="1e-12"))
    yield Scene("network X gap -1", x, joint(gap=-1))  # gap without contact
    all_fractures = pressure(f"f{k:02}" for k in range(1, 16)) + ("Tables.p.arguments={0, 1, 2, 3, 4}",
        "Tables.p.values={0, 0, 0.005, 0.015, 0.045}", "Tables.ax.values={0, 0.01, 0.01, 0.01, 0.01}",
        "Tables.ay.values={0, 0.02, 0.02, 0.02, 0.02}", "Tables.sx.values={0, 0.01, 0.01, 0.01, 0.01}")
    yield Scene("network X pressure", x, all_fractures, quick=True)
    yield Scene("network X pressure all of it", x, all_fractures + all_of_it)
    injection = pressure(("f01", "f13")) + table("p", (0, 0), (1, 0), (8, 0.035), (12, 0)) + held(12, ax=0.01, ay=0.02, sx=0.01)
    yield Scene("network X injection", x, injection, quick=True)
    yield Scene("network X injection all of it", x, injection + all_of_it)
    yield Scene("network X nu=0.4999", x, ("Materials.rock.Poisson's ratio=0.4999",), quick=True)
    yield Scene("network T", t, quick=True)
    yield Scene("network T K_t=1 dilation 5", t, joint(stiffness=1, dilation=5))
    yield Scene("network T mu=2", t, joint(friction=2), several=True)
    yield Scene("network 3D", box, quick=True)
    yield Scene("network 3D tetrahedra", box, ("Mesh.cell=tetrahedron",))
    yield Scene("network 3D K_t=1e-6", box, joint(stiffness="1e-6"))
    yield Scene("network 3D K_t=1e6", box, joint(stiffness="1e6"))
    yield Scene("network 3D mu=0", box, joint(friction=0))
    yield Scene("network 3D mu=1", box, joint(friction=1), several=True)
    yield Scene("network 3D mu=2", box, joint(friction=2), several=True)
    yield Scene("network 3D dilation 20", box, joint(dilation=20))
    yield Scene("network 3D all of it", box, joint(stiffness=10, dilation=10, closure="1e-3", normal=10))
    injection = table("p", (0, 0), (1, 0), (7, 0.02), (10, 0)) + held(10, az=0.01, sx=0.008, sy=0.004)
    yield Scene("network 3D injection", box, pressure(("f05", "f07"), "p(t)*(1 + (4 - z)/20)") + injection)
    cells = "contact/one_cell_blocks_3d.xml"  # some blocks are single cells with six fixed points
    yield Scene("one-cell blocks 3D", cells, several=True)
    yield Scene("one-cell blocks 3D mu=0", cells, joint(friction=0))
    yield Scene("one-cell blocks 3D all of it", cells, joint(stiffness=10, dilation=10, closure="1e-3", normal=10), several=True)


def blocks():
    yield Scene("floating 2D mu=0.5", "contact/floating_2d.xml", quick=True)
    yield Scene("floating 2D mu=0", "contact/floating_2d.xml", joint(friction=0), quick=True)
    yield Scene("floating 2D dilation 6", "contact/floating_2d.xml", joint(dilation=6))
    yield Scene("floating 3D mu=0.6", "contact/floating_3d.xml", quick=True)
    yield Scene("floating 3D K_t=1e-5", "contact/floating_3d.xml", joint(stiffness="1e-5"))
    yield Scene("floating 3D mu=1.5", "contact/floating_3d.xml", joint(friction=1.5))
    yield Scene("floating 3D all of it", "contact/floating_3d.xml", joint(stiffness=10, dilation=10, closure="1e-3", normal=10))
    lifting = table("p", (0, 0), (1, 0), (6, 0.02), (8, 0)) + held(8, ax=0, az=0.01, sx=0.005, sy=0)
    yield Scene("floating 3D injection", "contact/floating_3d.xml", pressure(("below", "west")) + lifting, quick=True)
    for dim in (2, 3):
        yield Scene(f"masonry X {dim}D", f"contact/masonry_cross_{dim}d.xml", quick=dim == 2)
        yield Scene(f"masonry T {dim}D", f"contact/masonry_wall_{dim}d.xml", quick=True)
        yield Scene(f"masonry T {dim}D mu=0.1", f"contact/masonry_wall_{dim}d.xml", joint(friction=0.1))
        for contrast in ("1e-6", "1e-3", "1e3", "1e6"):
            # The tolerance is relative to the stress of the stiff blocks, the violation to the stress of the soft ones.
            fine = ("Solver.tolerance=1e-12",) if contrast == "1e-6" else ()
            if dim == 2 or contrast in ("1e-6", "1e6"):
                yield Scene(f"contrast {dim}D {contrast}", f"contact/masonry_cross_{dim}d.xml",
                            (f"Materials.other.Young's modulus={contrast}",) + fine, quick=contrast == "1e6" and dim == 2)
        yield Scene(f"on one face {dim}D", f"contact/one_face_{dim}d.xml", exact=exact.hanging, quick=dim == 2)
    yield Scene("layers 2D", "contact/layers_2d.xml", quick=True)
    yield Scene("layers 2D 1e-3", "contact/layers_2d.xml", layers(0.001))
    yield Scene("layers 2D 1e-5", "contact/layers_2d.xml", layers(1e-5) + ("Mesh.cells={20, 5}",))
    yield Scene("masonry soft 2D", "contact/masonry_soft_2d.xml", newton=20)
    yield Scene("sliver 2D", "contact/sliver_2d.xml", quick=True)
    yield Scene("sliver 3D", "contact/sliver_3d.xml")


def layers(h):
    """Entries for layers of thickness h in layers_2d.xml."""
    corners = tuple(f"Mesh.fractures.joint {k}.{corner} corner={{{x}, {k * h}}}" for k in range(1, 5) for corner, x in (("lower", 0), ("upper", 1)))
    return corners + (f"Mesh.upper corner={{1, {5 * h}}}", f"Tables.shear.values={{0, 0, {0.05 * h}, {-0.05 * h}}}",
                      f"Tables.press.values={{0, {5e-4 * h}, {5e-4 * h}}}")


def extremes():
    """Variations of one parameter of a block. lambda_t and lambda_n must be exact to 1e-8 within 20 iterations."""
    tiny = ("Tables.tangential.values={0, 1}", "Tables.normal.values={0, -1}") + joint(friction=1, dilation=0, gap=0, closure=0)
    cases = {"K_t=1e-12": joint(stiffness="1e-12"), "K_t=1e12": joint(stiffness="1e12"), "K_n=1e-12": joint(normal="1e-12"),
             "K_n=1e12": joint(normal="1e12"), "Du=1e-12": joint(closure="1e-12"), "mu=0": joint(friction=0),
             "mu=1e6": joint(friction="1e6"), "theta=89": joint(dilation=89, friction=1),
             "nu=0.4999": ("Materials.rock.Lame's first parameter=4999",),
             "nu=0.499999": ("Materials.rock.Lame's first parameter=499999",),
             "g0=1e-12": joint(gap="1e-12") + ("Tables.normal.values={0, -1e-15}",),
             "g0=1": joint(gap=1), "g0=-1": joint(gap=-1) + ("Tables.normal.values={0, -1.2}",),
             "G=1e12": tiny + joint(stiffness="1e-12") + ("Materials.rock.shear modulus=1e12", "Materials.rock.Lame's first parameter=1e12"),
             "G=1e-12": tiny + joint(stiffness="1e12") + ("Materials.rock.shear modulus=1e-12", "Materials.rock.Lame's first parameter=1e-12")}
    for dim in (2, 3):
        loads = {"p": (0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.45, 0.5, 0.4, 0.2, 0.1, 0), "tangential": [0.15] * 13, "normal": [-0.1] * 13}
        sets = sum((table(name, *enumerate(values)) for name, values in loads.items()), pressure(("fracture",)) + held(12))
        yield Scene(f"block {dim}D injection", f"contact/block_{dim}d.xml", sets, exact.block, newton=20, quick=dim == 2)
    for dim, names in ((2, cases), (3, ("K_t=1e-12", "mu=1e6", "theta=89", "nu=0.4999", "g0=-1"))):
        if dim == 3:  # pressures on faces, for rock that is almost incompressible, require three periodic cells
            cases["nu=0.4999"] += ("Mesh.cells={3, 3, 2}",)
        for name in names:
            yield Scene(f"block {dim}D {name}", f"contact/block_{dim}d.xml", cases[name], exact.block, newton=20,
                        quick=dim == 2 and name in ("K_t=1e-12", "K_t=1e12", "mu=0", "theta=89", "g0=1e-12", "G=1e12"))


def units():
    """One scene in several units of length (m) and stress (Pa). Solution and iterations must agree."""
    systems = {"m Pa": (1, 1), "km GPa": (1e3, 1e9), "mm MPa": (1e-3, 1e6), "um Pa": (1e-6, 1)}

    def sets(length, stress, high, corners, loads):
        def row(values):
            return "{" + ", ".join(repr(value / length) for value in values) + "}"
        entries = {"Materials.rock.shear modulus": 12e9 / stress, "Materials.rock.Lame's first parameter": 8e9 / stress,
                   STIFFNESS: 5e9 * length / stress, FRICTION: 0.6, DILATION: 5, GAP: 1e-4 / length,
                   CLOSURE: 2e-4 / length, NORMAL: 3e10 * length / stress, "Mesh.upper corner": row(high)}
        entries |= {f"Mesh.fractures.{name} corner": row(corner) for name, corner in corners.items()}
        entries |= {f"Tables.{name}.values": row(values) for name, values in loads.items()}
        return tuple(f"{key}={value}" for key, value in entries.items())

    for name, (length, stress) in systems.items():
        for dim in (2, 3):
            flat = [10] * (dim - 1)
            yield Scene(f"units {dim}D {name}", f"contact/block_{dim}d.xml", sets(
                length, stress, flat + [10], {"fracture.lower": [0] * (dim - 1) + [5], "fracture.upper": flat + [5]},
                {"tangential": [0, 0.02], "normal": [0, -0.001]}), exact.block, tolerance=1e-10, group=f"units {dim}D",
                quick=dim == 2 and name in ("m Pa", "um Pa"))
        yield Scene(f"units crack {name}", "contact/units_2d.xml", sets(
            length, stress, [10, 10], {"flat.lower": [2.5, 5], "flat.upper": [7.5, 5], "steep.lower": [5, 2.5], "steep.upper": [5, 7.5]},
            {"tangential": [0, 0.02, -0.02], "normal": [0, -0.01, -0.01]}), group="units crack")


def patches():
    """Uniform stress across inclined and crossing fractures, also with cells of aspect ratio 1e4 and 1e6."""
    stick = exact.uniform([[-0.5, 0.1], [0.1, -0.3]], [(0, 1)], [0])
    slip = exact.uniform([[-0.5, 0.18], [0.18, -0.3]], [(0, 1)], [0.25 / 0.18])
    crossing = [[-0.8, 0.15], [0.15, -0.5]]
    box = "verification/inclined_box_{}d.xml"

    def thin(*axes):
        """Entries that scale the box of the inclined patch along its axes."""
        def corner(values):
            return "{" + ", ".join(str(value * size) for value, size in zip(values, axes)) + "}"
        low, high = [-1] * len(axes), [1] * len(axes)
        middle_low, middle_high = low[:-1] + [0], high[:-1] + [0]
        boxes = {"": (low, high), "regions.-.": (low, middle_high), "regions.+.": (middle_low, high), "fractures.f1.": (middle_low, middle_high)}
        return tuple(f"Mesh.{name}{which} corner={corner(values)}" for name, pair in boxes.items() for which, values in zip(("lower", "upper"), pair))

    yield Scene("patch 2D slip", "verification/inclined_2d.xml", exact=slip)
    yield Scene("patch 2D three lines", "verification/crossing_patch_2d.xml",
                exact=exact.uniform(crossing, exact.at_angles(10, 75, 130), [0, 0.8, 0.3]), quick=True)
    yield Scene("sliver patch 2D flat 1e4", box.format(2), thin(1, 1e-4), stick, quick=True)
    yield Scene("sliver patch 2D steep 1e4", box.format(2), thin(1e-4, 1), stick)
    yield Scene("sliver patch 2D flat 1e6", box.format(2), thin(1, 1e-6), stick)
    yield Scene("sliver patch 3D flat 1e4", box.format(3), thin(1, 1, 1e-4), stick)
    yield Scene("sliver crossing 2D 1e4", "contact/sliver_crossing_2d.xml",
                exact=exact.uniform(crossing, exact.at_angles(0, 90), [0, 0.8]), quick=True)


def no_solution():
    """Floating blocks and forces without equilibrium, each with a similar load that has an equilibrium."""
    for dim in (2, 3):
        slope, resting = f"contact/incline_{dim}d.xml", f"contact/resting_{dim}d.xml"
        turn = "Mesh.rotation=" if dim == 2 else "Mesh.rotation=-"
        yield Scene(f"slope {dim}D 30 degrees", slope, exact=exact.incline, quick=dim == 2)
        yield Scene(f"slope {dim}D 31 degrees", slope, (turn + "31",), refused=NO_EQUILIBRIUM, quick=dim == 2)
        yield Scene(f"slope {dim}D 45 degrees", slope, (turn + "45",), refused=NO_EQUILIBRIUM)
        yield Scene(f"resting {dim}D", resting)
        yield Scene(f"pushed off {dim}D", resting, ("Tables.sideways.values={0, 0, 0.02}",), refused=NO_EQUILIBRIUM)
        yield Scene(f"lifted {dim}D", resting, ("Tables.upwards.values={0, -0.01, 0.01}",), refused=f"{FREE}|{NO_EQUILIBRIUM}", quick=True)


def all_change():
    """Change from stick to slip, open and stick on several meshes, with at most 10 iterations per step."""
    for dim, meshes in ((2, ("2, 2", "8, 8", "32, 32")), (3, ("2, 2, 2", "6, 6, 6", "4, 4, 16"))):
        for cell in ("quadrilateral", "triangle") if dim == 2 else ("hexahedron", "tetrahedron"):
            for cells in meshes:
                yield Scene(f"all change {cell[:4]} {cells.replace(', ', 'x')}", f"contact/all_change_{dim}d.xml",
                            (f"Mesh.cell={cell}", f"Mesh.cells={{{cells}}}"), exact.block, newton=10,
                            group="all change", quick=cells in ("8, 8", "2, 2, 2") and cell in ("triangle", "hexahedron"))


def drift():
    yield Scene("1000 cycles", "contact/cycles_2d.xml", exact=exact.cycles, tolerance=1e-9)
    turns = "contact/turns_3d.xml"
    yield Scene("50 turns of 64 steps", turns, exact=exact.turns(64), tolerance=1e-9)
    yield Scene("1000 turns of 8 steps", turns, ("Boundary conditions.moved.displacement={0.5*cos(pi*t/4), 0.5*sin(pi*t/4), -0.1}",
                                                 "Time.end=8000", "Time.steps=8000", "Output.every=100"),
                exact=exact.turns(8), tolerance=1e-9)


def histories():
    """Laws with history variables, which are checked, too."""
    for name in ("damage_cycles_2d", "damage_turns_3d"):
        yield Scene(name.replace("_", " "), f"contact/{name}.xml", quick=True)
        yield Scene(f"{name.replace('_', ' ')}, work", f"contact/{name}.xml",
                    (JOINT + "damage driver=frictional work", JOINT + "reference stress=0.3"))
    yield Scene("bond softens", "verification/cyclic_2d.xml",
                (JOINT + "bond=linear softening", JOINT + "cohesion=0.05", JOINT + "shear fracture energy=1"))


def scenes():
    for part in (seed, networks, blocks, extremes, units, patches, no_solution, all_change, drift, histories):
        yield from part()
