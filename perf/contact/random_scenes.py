"""Random scenes. Scene k of a seed depends only on these two numbers.

A scene is a tree of sections and entries, as in the XML. Lengths and stresses are relative to the domain size
and Young's modulus, which are random, too."""
import math
import random
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from perf.common.scene_file import save
from perf.contact.random_joints import any_joint

ROOT = Path(__file__).resolve().parents[2]
SIDES = ("west", "east", "south", "north", "bottom", "top")
WORK = "slip would produce energy"  # part of the message that refuses a joint whose dilation exceeds friction
ATTEMPTS = 10  # draws of a network that cannot be meshed


@dataclass
class Drawn:
    name: str
    loads: str      # displacement, stress or weight
    comment: str
    tree: dict      # sections and entries; for a network without the mesh file
    network: dict   # the section "Mesh file" of a network, or None


class Draw:
    """Random generator and scales of one scene."""

    def __init__(self, rng, dim):
        self.rng, self.dim = rng, dim
        wild = rng.random() < 0.15
        self.size = 10 ** rng.uniform(-4, 4) if wild else rng.choice((1, 10, 100))
        self.modulus = 10 ** rng.uniform(-2, 13) if wild else 10 ** rng.uniform(9, 11)
        self.strain = 10 ** rng.uniform(-6, -2.5)
        self.steps = rng.randint(2, 6)
        self.stiffer = 1.0  # ratio of the rock's modulus to the modulus of the loads
        self.other_laws = not wild and rng.random() < 0.35
        self.tables = {}

    def chance(self, p):
        return self.rng.random() < p

    def power(self, low, high):
        """Returns 10 to a uniformly distributed power."""
        return 10 ** self.rng.uniform(low, high)

    def table(self, name, values):
        """Adds a table with these values at the start and at the step ends; returns the expression of its call."""
        self.tables[name] = {"arguments": [float(t) for t in range(len(values))], "values": [float(v) for v in values]}
        return f"{name}(t)"


# Materials

def joint(draw):
    if draw.other_laws:
        return any_joint(draw, draw.modulus * draw.strain)
    friction = 0.0 if draw.chance(0.1) else draw.rng.uniform(0.05, 0.9)
    law = {"type": "joint", "friction coefficient": friction}
    if draw.chance(0.5):  # at most friction, otherwise sliding would produce work
        law["dilation angle"] = draw.rng.uniform(0, min(15, math.degrees(math.atan(friction))))
    if draw.chance(0.6):
        law["tangential stiffness"] = draw.modulus / draw.size * draw.power(-5, 5)
    if draw.chance(0.35):
        law["maximum closure"] = draw.size * draw.power(-6, -3)
        law["normal stiffness"] = draw.modulus / draw.size * draw.power(-2, 4)
    if draw.chance(0.07):
        law["initial gap"] = draw.size * draw.power(-7, -4.5)
    return law


def finish(draw, mesh, fractures, conditions, bulk=None, pressure=0.0, contrast=None):
    """Returns the complete scene.

    `pressure` is the scale of fluid pressures (0: none). `contrast` is the modulus ratio of the region "other"
    (None: no such region)."""
    rng = draw.rng
    ratio = 0.5 - draw.power(-5, -1) if draw.chance(0.1) else rng.uniform(0, 0.4)
    rock = {"type": "elastic", "Young's modulus": draw.modulus * draw.stiffer, "Poisson's ratio": ratio}
    materials = {"rock": rock, "joint": joint(draw)}
    if draw.chance(0.3):
        materials["other joint"] = joint(draw)
    joints = {name: {"material": rng.choice([m for m in materials if m != "rock"])} for name in fractures}
    if pressure:
        values = [pressure * rng.uniform(0, 1.3) for _ in range(draw.steps)]
        text = draw.table("p", [0] + values[:-1] + [values[-1] * rng.choice((0, 1))])
        for name in fractures:
            if draw.chance(0.7):
                joints[name]["fluid pressure"] = text
    used = {joints[name]["material"] for name in fractures} | {"rock"}
    tree = {**mesh, "Materials": {name: law for name, law in materials.items() if name in used}}
    if contrast:
        tree["Materials"]["other"] = {**rock, "Young's modulus": draw.modulus * draw.stiffer * contrast}
        tree["Regions"] = {"other": {"material": "other"}}
    if draw.chance(0.1):
        tree["Solver"] = {"Linear solver": {"type": "iterative"}}
    return tree | {"Bulk": {"material": "rock", **(bulk or {})}, "Fractures": joints, "Boundary conditions": conditions,
                   "Tables": draw.tables, "Time": {"end": float(draw.steps), "steps": draw.steps}}


# Loads

def path(draw, components):
    """Values [component][step] of size 1, beginning with 0: random, rotating or cyclic with changes of sign."""
    rng, kind = draw.rng, draw.rng.choice(("wander", "turn", "cycle"))
    first = [rng.gauss(0, 1) for _ in range(components)]
    second = [rng.gauss(0, 1) for _ in range(components)]
    rows = []
    turn, speed = 0.0, rng.uniform(0.3, 2)
    for step in range(draw.steps):
        if kind == "wander":
            rows.append([rng.gauss(0, 1) for _ in range(components)])
        elif kind == "turn":
            rows.append([math.cos(turn) * a + math.sin(turn) * b for a, b in zip(first, second)])
            turn += speed
        else:
            rows.append([(1, 0, -1, 1, 0.3, -1)[step] * a for a in first])
    return [[0.0, *column] for column in zip(*rows)]


def symmetric(draw):
    """Path of the components of a symmetric tensor, by index pairs."""
    pairs = [(i, j) for i in range(draw.dim) for j in range(i, draw.dim)]
    return dict(zip(pairs, path(draw, len(pairs))))


def given_displacement(draw, sides):
    """Boundary conditions u = G(t) x on all sides: a strain path, a constant compression and some rotation."""
    dim, axes = draw.dim, "xyz"[:draw.dim]
    shear = symmetric(draw)
    compression, spin = draw.rng.choice((0, 0, 1, 3)), draw.rng.uniform(-1, 1) if draw.chance(0.5) else 0
    for i in range(dim):
        row = shear[i, i]
        shear[i, i] = [row[0]] + [v - compression for v in row[1:]]
    texts = []
    for i in range(dim):
        terms = []
        for j in range(dim):
            row = shear[min(i, j), max(i, j)]
            turned = [v * (1 + spin * ((i > j) - (i < j))) if i != j else v for v in row]
            terms.append(draw.table(f"g{axes[i]}{axes[j]}", [draw.strain * v for v in turned]) + "*" + axes[j])
        texts.append(" + ".join(terms))
    return {side: {"boundary": side, "displacement": texts} for side in sides}


def given_stress(draw, sides, supports):
    """Tractions S(t) n on the sides; S is a compression with a deviator that follows a path.

    `supports`: rollers on west, south and bottom, or the lowest side fixed."""
    dim = draw.dim
    compression = draw.modulus * draw.strain
    deviator = draw.rng.choice((0.1, 0.3, 0.6))
    names = {}
    for (i, j), row in symmetric(draw).items():
        values = [compression * (deviator * v - (i == j)) for v in row]
        if i == j:
            values[0] = 0
        names[i, j] = names[j, i] = draw.table("s" + "xyz"[i] + "xyz"[j], values)
    conditions = {}
    for k, side in enumerate(sides):
        axis, sign = divmod(k, 2)
        traction = [("" if sign else "-") + names[i, axis] for i in range(dim)]
        low = sign == 0 and (supports == "rollers" or axis == dim - 1)
        if low and supports == "rollers":
            conditions[side] = {"boundary": side, "displacement": ["0" if i == axis else "free" for i in range(dim)]}
            traction[axis] = "0"
        elif low:
            conditions[side] = {"boundary": side, "displacement": ["0"] * dim}
            continue
        conditions[side + " load"] = {"boundary": side, "traction": traction}
    return conditions


def weight(draw, top, bottom):
    """Body force with fixed bottom and free sides. The top is free, loaded, moved sideways under a load, or moved."""
    dim, rng = draw.dim, draw.rng
    load = draw.modulus * draw.strain
    bulk = {"body force": [0.0] * (dim - 1) + [-load / draw.size]}
    conditions = {"floor": {"boundary": bottom, "displacement": [0.0] * dim}}
    kind = rng.choice(("free", "pressed", "sheared", "moved"))
    pressed = ["0"] * (dim - 1) + [f"{-load * rng.uniform(0.2, 5)!r}"]
    rows, u = path(draw, dim), draw.strain * draw.size
    if kind == "pressed":
        share = rng.uniform(0, 0.5)
        pressed[:-1] = [draw.table("h" + "xy"[i], [share * load * v for v in rows[i]]) for i in range(dim - 1)]
    if kind == "moved":
        shares = [1] * (dim - 1) + [0.3]
        moved = [draw.table("d" + "xyz"[i], [u * v * share for v in rows[i]]) for i, share in enumerate(shares)]
        conditions["top"] = {"boundary": top, "displacement": moved}
    elif kind == "sheared":
        moved = [draw.table("d" + "xy"[i], [rng.choice((1, 3)) * u * v for v in rows[i]]) for i in range(dim - 1)]
        conditions["top"] = {"boundary": top, "displacement": moved + ["free"]}
    if kind in ("pressed", "sheared"):
        conditions["load"] = {"boundary": top, "traction": pressed}
    return {"conditions": conditions, "bulk": bulk}


def stiffen(draw):
    """Makes the rock stiff compared with the loads, as in masonry, with probability 0.4."""
    if draw.chance(0.4):
        draw.stiffer = draw.power(0, 4)


# Boxes

def box(high, cells, cell, fractures, **more):
    corners = {name: {"lower corner": lower, "upper corner": upper} for name, (lower, upper) in fractures.items()}
    return {"Mesh": {"cell": cell, "lower corner": [0.0] * len(high), "upper corner": [float(v) for v in high],
                     "cells": cells, **more, "fractures": corners}}


def shape(draw):
    return draw.rng.choice(("triangle", "quadrilateral") if draw.dim == 2 else ("tetrahedron", "hexahedron"))


def rectangle(high, cells, axis, plane, extents):
    """Returns the corners of a fracture given by indices of mesh planes."""
    lower = [high[i] * (plane if i == axis else extents[i][0]) / cells[i] for i in range(len(high))]
    upper = [high[i] * (plane if i == axis else extents[i][1]) / cells[i] for i in range(len(high))]
    return lower, upper


def turned(draw):
    """Returns the entries of a random rotation of the box, or none."""
    if not draw.chance(0.4):
        return {}
    angle = {"rotation": draw.rng.uniform(0, 360)}
    return angle if draw.dim == 2 else angle | {"rotation axis": [draw.rng.gauss(0, 1) for _ in range(3)]}


def random_fractures(draw, high, cells, maximum, through=None):
    """Corners of two or more fractures. `through` is the probability, per direction, that a fracture spans the box."""
    rng, dim = draw.rng, draw.dim
    through = rng.choice((0.1, 0.5, 1)) if through is None else through
    planes = [(axis, plane) for axis in range(dim) for plane in range(1, cells[axis])]
    fractures = {}
    for k, (axis, plane) in enumerate(rng.sample(planes, min(len(planes), rng.randint(2, maximum)))):
        extents = [(0, n) if draw.chance(through) else sorted(rng.sample(range(n + 1), 2)) for n in cells]
        fractures[f"f{k}"] = rectangle(high, cells, axis, plane, extents)
    return fractures


def random_box(draw):
    """Plane fractures in a box that cross, abut and end."""
    rng, dim = draw.rng, draw.dim
    order = 2 if draw.chance(0.25) else 1
    cells = [rng.randint(6, 16 // order) if dim == 2 else rng.randint(3, 6 if order == 1 else 4) for _ in range(dim)]
    high = [draw.size * rng.choice((1, 1, rng.uniform(0.5, 2))) for _ in range(dim)]
    fractures = random_fractures(draw, high, cells, 8 if dim == 2 else 5, rng.choice((0.1, 0.5, 1)))
    sides, more, contrast = SIDES[:2 * dim], {"order": order}, None
    if draw.chance(0.15):
        middle = high[0] * (cells[0] // 2) / cells[0]
        more["regions"] = {"other": {"lower corner": [0.0] * dim, "upper corner": [middle, *high[1:]]}}
        contrast = draw.power(-4, 4)
    kind = rng.choice(("displacement", "displacement", "stress", "weight"))
    bulk = {}
    if kind == "displacement":
        more |= turned(draw)
        conditions = given_displacement(draw, sides)
        if draw.chance(0.25):
            p = draw.modulus * draw.strain * rng.uniform(0.3, 3)
            normal = [-p * rng.uniform(0.5, 1.5) for _ in range(3)]
            bulk = {"initial stress": normal + [0.2 * p * rng.uniform(-1, 1)] + [0.0] * (0 if dim == 2 else 2)}
    elif kind == "stress":
        conditions = given_stress(draw, sides, rng.choice(("rollers", "held")))
    else:
        loads = weight(draw, sides[-1], sides[-2])
        conditions, bulk = loads["conditions"], loads["bulk"]
    pressure = draw.modulus * draw.strain if draw.chance(0.25) else 0.0
    mesh = box(high, cells, shape(draw), fractures, **more)
    return finish(draw, mesh, fractures, conditions, bulk, pressure, contrast), kind


def blocks(draw):
    """Box cut into blocks by through-going planes, under weight or given stress; some blocks are one cell wide."""
    stiffen(draw)
    rng, dim = draw.rng, draw.dim
    cells = [rng.randint(3, 10 if dim == 2 else 5) for _ in range(dim)]
    high = [draw.size * n / cells[0] for n in cells]
    fractures = {}
    for axis in range(dim):
        for plane in rng.sample(range(1, cells[axis]), rng.randint(axis == dim - 1, min(3, cells[axis] - 1))):
            fractures[f"{'xyz'[axis]}{plane}"] = rectangle(high, cells, axis, plane, [(0, n) for n in cells])
    sides = SIDES[:2 * dim]
    if draw.chance(0.3):
        conditions, bulk, kind = given_stress(draw, sides, rng.choice(("rollers", "held"))), {}, "stress"
    else:
        loads = weight(draw, sides[-1], sides[-2])
        conditions, bulk, kind = loads["conditions"], loads["bulk"], "weight"
    tilt = {}
    if kind == "weight" and draw.chance(0.3):  # inclined floor
        tilt = {"rotation": rng.uniform(-35, 35)} | ({} if dim == 2 else {"rotation axis": [1.0, 0.0, 0.0]})
    return finish(draw, box(high, cells, shape(draw), fractures, **tilt), fractures, conditions, bulk), kind


def masonry(draw):
    """Courses of bricks in running bond with free sides."""
    stiffen(draw)
    rng, dim = draw.rng, draw.dim
    courses, bricks = rng.randint(3, 6), rng.randint(2, 4)
    fine = rng.choice((1, 2)) if dim == 2 else 1
    cells = [2 * bricks * fine] + [1] * (dim - 2) + [courses * fine]
    high = [draw.size * n / cells[0] for n in cells]
    up, fractures = dim - 1, {}
    for course in range(1, courses):
        fractures[f"bed{course}"] = rectangle(high, cells, up, course * fine, [(0, n) for n in cells])
    for course in range(courses):
        for k in range(1 + course % 2, 2 * bricks, 2):
            extents = [(0, n) for n in cells]
            extents[up] = course * fine, (course + 1) * fine
            fractures[f"head{course}_{k}"] = rectangle(high, cells, 0, k * fine, extents)
    sides = SIDES[:2 * dim]
    loads = weight(draw, sides[-1], sides[-2])
    return finish(draw, box(high, cells, shape(draw), fractures), fractures, loads["conditions"], loads["bulk"]), "weight"


def layers(draw):
    """Layers with a thickness of 1e-1 to 1e-5 of their length between two plates that approach and shear."""
    rng, dim = draw.rng, draw.dim
    count, across = rng.randint(3, 10 if dim == 2 else 5), rng.randint(4, 12 if dim == 2 else 4)
    thickness = draw.size * draw.power(-5, -1)
    cells = [across] * (dim - 1) + [count]
    high = [draw.size] * (dim - 1) + [count * thickness]
    fractures = {f"j{k}": rectangle(high, cells, dim - 1, k, [(0, n) for n in cells]) for k in range(1, count)}
    rows = path(draw, dim)
    rows[-1][1:] = [0.5 * abs(v) - 1.5 for v in rows[-1][1:]]
    moved = [draw.table("d" + "xyz"[i], [draw.strain * high[-1] * v for v in row]) for i, row in enumerate(rows)]
    sides = SIDES[:2 * dim]
    conditions = {"floor": {"boundary": sides[-2], "displacement": [0.0] * dim},
                  "plate": {"boundary": sides[-1], "displacement": moved}}
    return finish(draw, box(high, cells, shape(draw), fractures), fractures, conditions), "displacement"


# Meshes of gmsh

def network(draw):
    """Two sets of random fractures in a gmsh mesh."""
    rng, dim, size = draw.rng, draw.dim, draw.size
    order = 2 if draw.chance(0.2) else 1

    def fractures(maximum):
        entries = {"number": rng.randint(2, maximum), "seed": rng.randrange(10**6), "shortest": size * rng.uniform(0.1, 0.35),
                   "longest": size * rng.uniform(0.4, 1.2), "exponent": rng.choice((1.0, 2.5))}
        if draw.chance(0.5):
            entries |= {"strike": rng.uniform(0, 180), "concentration": rng.choice((0.0, 5.0, 30.0))}
            if dim == 3:
                entries["dip"] = rng.uniform(20, 90)
        return {"random": entries | ({"corners": rng.choice((4, 5, 6, 8))} if dim == 3 else {})}

    sets = {name: fractures(9 if dim == 2 else 4) for name in "ab"}
    relative, tips, largest, tolerance = (0.3, 0.02, 0.15, 2e-3) if dim == 2 else (0.5, 0.15, 0.35, 5e-3)
    sizes = {"relative size": relative, "size at tips": size * tips, "size": size * largest, "minimum distance": 0.0,
             "tolerance": size * tolerance, "minimum angle": 1.0}
    domain = {"lower corner": [0.0] * dim, "upper corner": [float(size)] * dim}
    section = {"order": order, "network": {"domain": domain, "fractures": sets, **sizes}}
    kind = rng.choice(("displacement", "displacement", "stress"))
    sides = SIDES[:2 * dim]
    if kind == "displacement":
        conditions = given_displacement(draw, sides)
    else:
        conditions = given_stress(draw, sides, rng.choice(("rollers", "held")))
    pressure = draw.modulus * draw.strain if draw.chance(0.25) else 0.0
    return finish(draw, {"Mesh file": section}, sets, conditions, None, pressure), kind


def arch(draw):
    """Arch of voussoirs between two springings, under its weight and a load on one stone."""
    stiffen(draw)
    rng, size = draw.rng, draw.size
    stones, span = rng.randint(3, 11), math.radians(rng.uniform(60, 180))
    inner, outer = size * rng.uniform(0.6, 0.92), size
    angles = [math.pi / 2 + span * (0.5 - k / stones) for k in range(stones + 1)]
    ring = [[r * f(a) for f in (math.cos, math.sin)] for r, row in ((outer, angles), (inner, angles[::-1])) for a in row]
    loaded = rng.randrange(stones)
    sides = ["load" if k == loaded else "back" for k in range(stones)] + ["right"] + ["inside"] * stones + ["left"]
    ends = [[r * f(a) for r in (inner, outer) for f in (math.cos, math.sin)] for a in angles]
    lines = {f"joint{k}": {"lines": {"line": {"points": ends[k]}}} for k in range(1, stones)}
    width = outer - inner
    section = {"network": {"domain": {"corners": [v for point in ring for v in point], "sides": sides}, "fractures": lines,
                           "relative size": 0.5, "size at tips": width / 2, "size": width / 2}}
    load = draw.modulus * draw.strain
    values = [load * width / size * rng.uniform(0, 3) for _ in range(draw.steps)]
    conditions = {"left": {"boundary": "left", "displacement": [0.0, 0.0]},
                  "load": {"boundary": "load", "traction": ["0", "-" + draw.table("q", [0, *values])]}}
    spread = path(draw, 2)
    if draw.chance(0.4):  # moving right springing
        moved = [draw.table("d" + "xy"[i], [draw.strain * size * 0.3 * v for v in spread[i]]) for i in range(2)]
        conditions["right"] = {"boundary": "right", "displacement": moved}
    else:
        conditions["right"] = {"boundary": "right", "displacement": [0.0, 0.0]}
    return finish(draw, {"Mesh file": section}, lines, conditions, {"body force": [0.0, -load / size]}), "weight"


FAMILIES = {  # (function, dimension, share)
    "network-2d": (network, 2, 20), "network-3d": (network, 3, 8), "box-2d": (random_box, 2, 20), "box-3d": (random_box, 3, 17),
    "masonry-2d": (masonry, 2, 9), "masonry-3d": (masonry, 3, 4), "blocks-2d": (blocks, 2, 6), "blocks-3d": (blocks, 3, 5),
    "arch": (arch, 2, 6), "layers-2d": (layers, 2, 3), "layers-3d": (layers, 3, 2)}


def families():
    from perf.contact import random_families
    return FAMILIES | random_families.FAMILIES


def draw_scene(seed, k, attempt=0):
    """Draws scene k of a seed. Further attempts replace networks without a mesh and refused joints."""
    rng, all_ = random.Random(f"{seed}/{k}"), families()
    family, = rng.choices(list(all_), [share for *_, share in all_.values()])
    if attempt:
        rng = random.Random(f"{seed}/{k}/{attempt}")
    function, dim, _ = all_[family]
    tree, kind = function(Draw(rng, dim))
    return Drawn(f"{family}-{k:04}", kind, f"Scene {k} of seed {seed}, written by perf/contact", tree, tree.get("Mesh file"))


def write(seed, k, folder, binary):
    """Writes scene k into the folder, for a network with its mesh. Returns (scene, message); without an error the
    message is empty."""
    for attempt in range(ATTEMPTS):
        drawn = draw_scene(seed, k, attempt)
        refusal = write_one(drawn, folder, binary)
        if not refusal:
            return drawn, ""
    return drawn, f"no scene in {ATTEMPTS} attempts: {refusal}"


def write_one(drawn, folder, binary):
    """Writes one scene. Returns the error message of the mesh generator or of the joint check, or an empty string."""
    scene = folder / f"{drawn.name}.xml"
    if drawn.network:
        mesh, network_scene = scene.with_suffix(".msh"), scene.with_suffix(".network.xml")
        save(drawn.tree, network_scene, drawn.comment)
        command = [sys.executable, "-B", ROOT / "apps/mesh", network_scene, "-o", mesh, "--program", binary, "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            return done.stderr.strip()
        names = drawn.network["network"]["fractures"]
        file = {"path": mesh.name, "order": drawn.network.get("order", 1), "fractures": {name: {} for name in names}}
        save(drawn.tree | {"Mesh file": file}, scene, drawn.comment)
    else:
        save(drawn.tree, scene, drawn.comment)
    if any(key in law for law in drawn.tree["Materials"].values() for key in ("friction", "dilation", "damage")):
        checked = subprocess.run([binary, "check", scene], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if checked.returncode == 1 and WORK in checked.stderr:
            return checked.stderr.strip()
    return ""
