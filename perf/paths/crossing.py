"""Scenes of a crack that meets an oblique frictional fracture under far stresses, by a mesh that is written here.

The crack lies along x, the fracture passes through (MEETING, 0) at an angle; the far stress s1 is along x, s3 along y. A
pressure in the crack above -s3 drives its right tip, with a toughness that increases with x."""
import math

# Outcomes that two readings of the criterion of Renshaw and Pollard (1995) share, "the largest principal stress" or "the
# stress along the fracture is the strength": angle [degree]; s1, s3, strength [MPa]; friction; cohesion [MPa]; crosses.
CASES = {
    "a1": (90, -10, -5, 4, 0.6, 0, True), "a2": (90, -11, -5, 4, 0.3, 0, False), "a3": (90, -15, -5, 4, 0.3, 0, True),
    "a4": (90, -6, -2, 5, 0.9, 0, True), "a5": (90, -4, -2, 5, 0.9, 0, False), "a6": (90, -7.5, -5, 4, 0.6, 1, True),
    "b1": (75, -14, -5, 3, 0.7, 0, True), "b2": (75, -9, -5, 4, 0.6, 0, False), "b3": (60, -18, -5, 2, 0.6, 6, True),
    "b4": (60, -12, -5, 2, 1.2, 2, True), "b5": (60, -18, -5, 4, 0.6, 0, False), "b6": (45, -20, -5, 4, 0.6, 0, False),
    "b7": (45, -20, -5, 4, 1.0, 0, False)}

HALF, MEETING, SEGMENT, TOUGHNESS, PRESSURE = 2, 2.4, 0.1, 1e6, 5e5  # m, Pa m^0.5, Pa above the far stress
WIDTH, CELLS = 12, 6  # half of the domain, m; cells between x = 0 and HALF


def places(marks, ratio=1.35):
    """Coordinates from -WIDTH to WIDTH with given parts; outside, steps grow by a ratio."""
    all_ = list(marks)
    for sign, end, step in ((-1, 0, marks[1] - marks[0]), (1, -1, marks[-1] - marks[-2])):
        outside, x = [], all_[end]
        while abs(x) < WIDTH:
            step *= ratio
            x += sign * step
            outside.append(x)
        outside[-1] = sign * WIDTH
        all_ = outside[::-1] + all_ if sign < 0 else all_ + outside
    return all_


def write_mesh(path, angle):
    """Writes a grid of triangles in gmsh format 2.2, sheared so that its columns have the angle to the x-axis."""
    slope = 1 / math.tan(math.radians(angle))
    step = HALF / CELLS
    xs = places([k * step for k in range(-CELLS, CELLS + 1)] + [MEETING])
    ys = places([0.2 * k for k in range(-5, 6)])
    number = {(i, j): 1 + i + j * len(xs) for j in range(len(ys)) for i in range(len(xs))}
    nodes = [(xs[i] + slope * ys[j], ys[j]) for j in range(len(ys)) for i in range(len(xs))]
    last_x, last_y, middle, meeting = len(xs) - 1, len(ys) - 1, ys.index(0), xs.index(MEETING)
    elements = []  # (kind, group, nodes)

    def line(group, a, b):
        elements.append((1, group, (number[a], number[b])))
    for i in range(last_x):
        line(1, (i, 0), (i + 1, 0))
        line(1, (i, last_y), (i + 1, last_y))
        if abs(xs[i]) < HALF + 1e-9 and abs(xs[i + 1]) < HALF + 1e-9:
            line(2, (i, middle), (i + 1, middle))
    for j in range(last_y):
        line(1, (0, j), (0, j + 1))
        line(1, (last_x, j), (last_x, j + 1))
        if abs(ys[j]) < 1 + 1e-9 and abs(ys[j + 1]) < 1 + 1e-9:
            line(3, (meeting, j), (meeting, j + 1))
    for i in range(last_x):
        for j in range(last_y):
            a, b, c, d = (number[i + k, j + l] for k, l in ((0, 0), (1, 0), (1, 1), (0, 1)))
            short = (a, b, d), (b, c, d)  # the shorter diagonal: columns lean to the right
            elements += [(2, 4, one) for one in short]
    names = ((1, 1, "far"), (1, 2, "crack"), (1, 3, "fault"), (2, 4, "rock"))
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *(f'{d} {k} "{name}"' for d, k, name in names),
             "$EndPhysicalNames", "$Nodes", str(len(nodes)), *(f"{k} {x!r} {y!r} 0" for k, (x, y) in enumerate(nodes, 1)), "$EndNodes", "$Elements",
             str(len(elements)), *(f"{k} {kind} 2 {group} {group} {' '.join(map(str, of))}" for k, (kind, group, of) in enumerate(elements, 1)), "$EndElements"]
    path.write_text("\n".join(lines) + "\n")


def write_scene(folder, case):
    """Writes scene and mesh of a case. Returns the path of the scene."""
    angle, s1, s3, strength, friction, cohesion, _ = CASES[case]
    folder.mkdir(parents=True, exist_ok=True)
    write_mesh(folder / "crossing.msh", angle)

    def section(name, *content):
        return "\n".join([f'<ParameterList name="{name}">', *content, "</ParameterList>"])

    def entry(name, value, kind="string"):
        return f'<Parameter name="{name}" type="{kind}" value="{value}"/>'
    joint = [entry("type", "joint")]
    fault = [*joint, entry("friction coefficient", friction, "double")]
    if cohesion:
        fault += [entry("bond", "constant cohesion"), entry("cohesion", f"{cohesion} MPa")]
    text = section(
        "Sprekk",
        section("Mesh file", entry("path", "crossing.msh"), section("fractures", section("crack"), section("fault"))),
        section("Materials", section("rock", entry("type", "elastic"), entry("Young's modulus", "30 GPa"), entry("Poisson's ratio", 0.25, "double")),
                section("joint", *joint, entry("friction coefficient", 0.6, "double")), section("fault", *fault)),
        section("Bulk", entry("material", "rock"), entry("initial stress", f"{{{1e6 * s1}, {1e6 * s3}, {1e6 * s3}, 0}}", "Array(double)")),
        section("Fractures", section("crack", entry("material", "joint"), entry("fluid pressure", f"{-1e6 * s3} + {PRESSURE}*t"), entry("strength", f"{strength} MPa"),
                                     entry("toughness", f"abs(x - 1) &gt; {MEETING - 0.95} ? 1e9 : {TOUGHNESS}*(1 + 0.4*(x - {HALF}))")),
                section("fault", entry("material", "fault"))),
        section("Boundary conditions", section("far", entry("boundary", "far"), entry("displacement", "{0, 0}", "Array(double)"))),
        section("Growth", entry("segment", SEGMENT, "double")),
        section("Time", entry("end", 1, "double"), entry("steps", 1, "int")))
    path = folder.resolve() / "crossing.xml"
    path.write_text(text + "\n")
    return path


def meeting(steps):
    """Returns the event in which the crack has met the fracture; None if it has not reached it."""
    return next((one for step in steps for one in step.get("tips", []) if one["state"] in ("crosses", "ends at")), None)


def exact_margin(angle, s1, s3, strength, friction, cohesion):
    """Margin bound/shear - 1 on the weaker ray from a tip at the fracture, when the stress along the ray is the strength.

    Near a crack under pressure, the stress apart from the singular one is the far stress less the excess of pressure."""
    s1, s3 = s1 - PRESSURE / 1e6, s3 - PRESSURE / 1e6
    def stresses(ray, k):
        """Stress along the ray, normal and shear stress."""
        c, s, c3, s3_ = (f(ray * part) for part in (0.5, 1.5) for f in (math.cos, math.sin))
        xx, yy, xy = s1 + k * c * (1 - s * s3_), s3 + k * c * (1 + s * s3_), k * s * c * c3
        x, y = math.cos(ray), math.sin(ray)
        return xx * x * x + yy * y * y + 2 * xy * x * y, xx * y * y + yy * x * x - 2 * xy * x * y, (yy - xx) * x * y + xy * (x * x - y * y)
    margins = []
    for ray in (math.radians(angle), math.radians(angle - 180)):
        at_0, at_1 = stresses(ray, 0)[0], stresses(ray, 1)[0]
        _, normal, shear = stresses(ray, (strength - at_0) / (at_1 - at_0))
        margins.append((cohesion - friction * normal) / abs(shear) - 1)
    return min(margins)
