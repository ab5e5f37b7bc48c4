"""Further families of random scenes, with loads and features that random_scenes does not draw.

All scenes have a solution: sides are fixed, or the load is a uniform pressure. A refusal therefore is a
failure."""
import math

from perf.contact.random_scenes import SIDES, box, finish, given_displacement, path, random_fractures, rectangle, shape


def stress_of(draw, p):
    normal = [-p * draw.rng.uniform(0.5, 1.5) for _ in range(3)]
    return normal + [0.2 * p * draw.rng.uniform(-1, 1)] + [0.0] * (0 if draw.dim == 2 else 2)


def drawn_box(draw, through=None):
    """Returns (upper corner, cells, fractures)."""
    dim = draw.dim
    cells = [draw.rng.randint(5, 10) if dim == 2 else draw.rng.randint(3, 4) for _ in range(dim)]
    high = [draw.size * n / cells[0] for n in cells]
    return high, cells, random_fractures(draw, high, cells, 5 if dim == 2 else 3, through)


def springs(draw):
    """Box whose sides rest on springs (elastic foundations), except the last side, which a plate moves."""
    dim, rng = draw.dim, draw.rng
    high, cells, fractures = drawn_box(draw)
    sides = SIDES[:2 * dim]
    conditions = {side: {"boundary": side, "foundation stiffness": [draw.modulus / draw.size * draw.power(-2, 2) for _ in range(dim)]}
                  for side in sides[:-1]}
    rows = path(draw, dim)
    u = draw.strain * draw.size
    moved = [draw.table("d" + "xyz"[i], [u * v for v in row]) for i, row in enumerate(rows)]
    conditions["plate"] = {"boundary": sides[-1], "displacement": moved}
    if draw.chance(0.5):
        conditions["pressure"] = {"boundary": rng.choice(sides[:-1]), "confining pressure": draw.modulus * draw.strain * rng.uniform(0.1, 1)}
    return finish(draw, box(high, cells, shape(draw), fractures), fractures, conditions), "springs"


def confined(draw):
    """Varying pressure on all sides; point supports prevent rigid motions only."""
    dim = draw.dim
    high, cells, fractures = drawn_box(draw)
    sides = SIDES[:2 * dim]
    p = draw.modulus * draw.strain
    text = draw.table("pressure", [0.0] + [p * draw.rng.uniform(0.2, 2) for _ in range(draw.steps)])
    conditions = {side: {"boundary": side, "confining pressure": text} for side in sides}
    corner, low = [0.0] * dim, sides[-2]
    held = {"first": (corner, ["0"] * dim), "second": ([high[0]] + corner[1:], ["free"] + ["0"] * (dim - 1))}
    if dim == 3:
        held["third"] = ([0.0, high[1], 0.0], ["free", "free", "0"])
    for name, (place, texts) in held.items():
        conditions[name] = {"boundary": low, "displacement": texts, "lower corner": place}
    return finish(draw, box(high, cells, shape(draw), fractures), fractures, conditions), "confined"


def gravity(draw):
    """Rock under gravity with roller sides, with or without lithostatic stress; the floor moves slightly."""
    dim, rng = draw.dim, draw.rng
    high, cells, fractures = drawn_box(draw)
    sides, load = SIDES[:2 * dim], draw.modulus * draw.strain
    bulk = {"gravity": [0.0] * (dim - 1) + [-10.0]}
    if draw.chance(0.5):
        bulk["lithostatic stress"] = {"surface": high[-1] * rng.uniform(1.0, 3.0), "horizontal ratio": rng.uniform(0.4, 1.5)}
    texts = []
    for i, row in enumerate(path(draw, dim)):
        texts.append(draw.table("d" + "xyz"[i], [0.3 * draw.strain * draw.size * v for v in row]))
    conditions = {side: {"boundary": side, "displacement": list(texts)} for side in sides[:-1]}
    if "lithostatic stress" in bulk or draw.chance(0.5):
        conditions["top"] = {"boundary": sides[-1], "displacement": list(texts)}
    tree = finish(draw, box(high, cells, shape(draw), fractures), fractures, conditions, bulk)
    for rock in (tree["Materials"][name] for name in ("rock", "other") if name in tree["Materials"]):
        rock["density"] = load / draw.size / 10.0
    return tree, "gravity"


def periodic(draw):
    """Layers between two plates, periodic in the other directions."""
    dim, rng = draw.dim, draw.rng
    high, cells, _ = drawn_box(draw)
    fractures = {}
    for plane in rng.sample(range(1, cells[-1]), rng.randint(1, min(3, cells[-1] - 1))):
        fractures[f"f{plane}"] = rectangle(high, cells, dim - 1, plane, [(0, n) for n in cells])
    rows = path(draw, dim)
    rows[-1] = [0.0] + [0.5 * abs(v) - 1.5 for v in rows[-1][1:]]
    moved = [draw.table("d" + "xyz"[i], [draw.strain * high[-1] * v for v in row]) for i, row in enumerate(rows)]
    sides = SIDES[:2 * dim]
    conditions = {"floor": {"boundary": sides[-2], "displacement": [0.0] * dim}, "plate": {"boundary": sides[-1], "displacement": moved}}
    mesh = box(high, cells, shape(draw), fractures, periodic=list("xy"[:dim - 1]))
    return finish(draw, mesh, fractures, conditions), "periodic"


def stages(draw):
    """Rock under initial stress with an excavation, at once or released gradually; optionally, a later support
    pressure."""
    dim, rng = draw.dim, draw.rng
    draw.steps = max(draw.steps, 4)
    cells = [rng.randint(7, 10) if dim == 2 else 4 for _ in range(dim)]
    high = [draw.size * n / cells[0] for n in cells]
    fractures = random_fractures(draw, high, cells, 4 if dim == 2 else 2, 0.2)
    first = [rng.randint(2, 3) if dim == 2 else 1 for _ in range(dim)]
    last = [a + rng.randint(1, 3 if dim == 2 else 2) for a in first]
    region = {"lower corner": [h * a / n for h, a, n in zip(high, first, cells)], "upper corner": [h * b / n for h, b, n in zip(high, last, cells)]}
    sides = SIDES[:2 * dim]
    conditions = {side: {"boundary": side, "displacement": [0.0] * dim} for side in sides}
    p = draw.modulus * draw.strain
    mesh = box(high, cells, shape(draw), fractures, regions={"gallery": region})
    tree = finish(draw, mesh, fractures, conditions, {"initial stress": stress_of(draw, p)})
    tree["Stages"] = {"excavation": {"time": 1.0, "excavate": ["gallery"]}}
    if draw.chance(0.5):
        tree["Stages"]["excavation"]["release"] = 2.0
    if draw.chance(0.5):
        tree["Stages"]["support"] = {"time": 3.0, "Boundary conditions": {"support": {"boundary": "gallery", "confining pressure": 0.2 * p}}}
    return tree, "stages"


def lines(draw):
    """Polylines with bends, T and L junctions and crossings; optionally, a region of other rock."""
    rng, size = draw.rng, draw.size
    sets = {}
    for k in range(rng.randint(2, 4)):
        start = [size * rng.uniform(0.15, 0.85) for _ in range(2)]
        angle, points = rng.uniform(0, 2 * math.pi), list(start)
        for _ in range(rng.randint(1, 3)):
            length = size * rng.uniform(0.15, 0.3)
            nxt = [points[-2] + length * math.cos(angle), points[-1] + length * math.sin(angle)]
            if not all(0.06 * size < v < 0.94 * size for v in nxt):
                break
            points += nxt
            angle += rng.uniform(-1.2, 1.2)
        if len(points) >= 4:
            sets[f"l{k}"] = {"lines": {"line": {"points": points}}}
    if not sets:
        sets["l0"] = {"lines": {"line": {"points": [0.2 * size, 0.3 * size, 0.7 * size, 0.6 * size]}}}
    stem = next(iter(sets.values()))["lines"]["line"]["points"]  # T junction at the middle of its first segment
    middle = [(stem[0] + stem[2]) / 2, (stem[1] + stem[3]) / 2]
    across = [-(stem[3] - stem[1]), stem[2] - stem[0]]
    sets["tee"] = {"lines": {"line": {"points": [*middle, middle[0] + 0.7 * across[0], middle[1] + 0.7 * across[1]]}}}
    sizes = {"relative size": 0.3, "size at tips": 0.03 * size, "size": 0.15 * size, "minimum distance": 0.0, "tolerance": 2e-3 * size,
             "minimum angle": 1.0}
    network = {"domain": {"lower corner": [0.0, 0.0], "upper corner": [float(size)] * 2}, "fractures": sets, **sizes}
    contrast = None
    if draw.chance(0.4):
        network["regions"] = {"other": {"lower corner": [0.0, 0.0], "upper corner": [size * rng.uniform(0.3, 0.7), float(size)]}}
        contrast = draw.power(-2, 2)
    conditions = given_displacement(draw, SIDES[:4])
    return finish(draw, {"Mesh file": {"order": rng.choice((1, 1, 2)), "network": network}}, sets, conditions, None, 0.0, contrast), "displacement"


FAMILIES = {  # (function, dimension, share)
    "springs-2d": (springs, 2, 5), "springs-3d": (springs, 3, 2), "confined-2d": (confined, 2, 4), "confined-3d": (confined, 3, 2),
    "gravity-2d": (gravity, 2, 4), "gravity-3d": (gravity, 3, 2), "periodic-2d": (periodic, 2, 4), "periodic-3d": (periodic, 3, 2),
    "stages-2d": (stages, 2, 5), "stages-3d": (stages, 3, 2), "lines": (lines, 2, 5)}
