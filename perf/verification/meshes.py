"""Meshes by the gmsh program, from scripts that this module writes. The same script gives the same mesh."""
import math
import shutil
import subprocess

QUIET = """Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Background Field = 1;
Field[1] = MathEval;
"""
BOX = (-2, -2, 2, 2)


class NoGmsh(Exception):
    """Error of a missing mesh; the message contains the reason."""


def with_gmsh(script, file, dimension):
    """Writes the script next to the mesh and creates the mesh, unless a mesh of the same script exists. Raises
    NoGmsh."""
    if shutil.which("gmsh") is None:
        raise NoGmsh("gmsh is not installed")
    geo = file.with_suffix(".geo")
    if file.is_file() and geo.is_file() and geo.read_text() == script:
        return file
    file.parent.mkdir(parents=True, exist_ok=True)
    geo.write_text(script)
    file.unlink(missing_ok=True)
    done = subprocess.run(["gmsh", f"-{dimension}", "-nt", "1", "-format", "msh41", str(geo), "-o", str(file)],
                          capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0 or not file.is_file():
        raise NoGmsh(f"gmsh failed on {geo}: {(done.stdout + done.stderr).strip().splitlines()[-1:]}")
    return file


def turned(x, y, degrees):
    """Returns a point rotated counter-clockwise about the origin, in gmsh syntax."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return f"{{{c * x - s * y:.17g}, {s * x + c * y:.17g}, 0}}"


def plane(file, fractures, size, box=BOX, largest=None, angle=0, options=""):
    """Triangular mesh of a box with fractures {name: points of a polyline}, rotated by an angle in degrees.

    `size` is the edge length as a gmsh formula in x and y. Equal points of fractures become one point."""
    x0, y0, x1, y1 = box
    corners, lines, names, points = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)], [], {}, {}
    for k, corner in enumerate(corners):
        points[corner] = k + 1
        lines.append((k + 1, (k + 1) % 4 + 1))
    for name, places in fractures.items():
        tags = [points.setdefault(place, len(points) + 1) for place in places]
        names[name] = range(len(lines) + 1, len(lines) + len(tags))
        lines += zip(tags, tags[1:])
    text = ['SetFactory("OpenCASCADE");']
    text += [f"Point({tag}) = {turned(*place, angle)};" for place, tag in points.items()]
    text += [f"Line({k}) = {{{a}, {b}}};" for k, (a, b) in enumerate(lines, 1)]
    text += ["Curve Loop(1) = {1 : 4};", "Plane Surface(1) = {1};",
             f"BooleanFragments{{ Surface{{1}}; Delete; }}{{ Curve{{5 : {len(lines)}}}; Delete; }}", "Mesh.Algorithm = 6;" + options]
    text += [f'Physical Curve("{name}") = {{{", ".join(map(str, tags))}}};' for name, tags in names.items()]
    text += ['Physical Curve("boundary") = Abs(CombinedBoundary{Surface{:};});', 'Physical Surface("rock") = {Surface{:}};', QUIET + f'Field[1].F = "{size}";']
    if largest:
        text.append(f"Mesh.MeshSizeMax = {largest:g};")
    return with_gmsh("\n".join(text) + "\n", file, 2)


def uniform_size(h):
    """Edge length of mesh U: h (0.6 + max(0, r - 1.2)), with the distance r from the crack centre."""
    return f"{h:g}*(0.6+Max(0,Sqrt(x^2+y^2)-1.2))"


def graded_size(h, smallest, tips):
    """Edge length smallest + h r, with the distance r from the nearest tip."""
    formula = ""
    for x, y in tips:
        distance = f"Sqrt((x-({x:.17g}))^2+(y-({y:.17g}))^2)"
        formula = distance if not formula else f"Min({formula},{distance})"
    return f"{smallest:g}+{h:g}*{formula}"


CRACK = {"crack": ((-1, 0), (1, 0))}


def uniform_crack(folder, h, angle=0):
    return plane(folder / f"uniform_{h:g}_{angle:g}.msh", CRACK, uniform_size(h), largest=0.4, angle=angle)


def graded_crack(folder, h, ratio):
    """Mesh with edges of length `ratio` times h at the tips that grow by h per unit distance, at most h."""
    tips = CRACK["crack"]
    return plane(folder / f"graded_{h:g}_{ratio:g}.msh", CRACK, graded_size(h, h * ratio, tips), largest=h)


def t_junction(folder, h, ratio, half_width):
    """Mesh of a horizontal fracture with a vertical one that ends on it.

    Edges have the length 50 m times h times `ratio` at tips and junction, and grow by h per length."""
    fractures = {"horizontal": ((-25, 50), (0, 50), (25, 50)), "vertical": ((0, -50), (0, 50))}
    size = graded_size(h, 50 * h * ratio, [(-25, 50), (25, 50), (0, 50), (0, -50)])
    box = (-half_width, -half_width, half_width, half_width)
    return plane(folder / f"t_{h:g}_{ratio:g}_{half_width:g}.msh", fractures, size, box,
                 # relative to the box size: small compared with the smallest edge
                 options="Mesh.RandomFactor = 1e-11;")


def wavy(folder, h):
    """Mesh of half a period with a height of 2 periods on each side; edges of length h on the fracture."""
    script = plane_strip(h)
    return with_gmsh(script, folder / f"wavy_{h:g}.msh", 2)


def plane_strip(h, width=0.5, height=2):
    points = [(0, -height), (width, -height), (width, 0), (width, height), (0, height), (0, 0)]
    text = [f"Point({k}) = {{{x}, {y}, 0}};" for k, (x, y) in enumerate(points, 1)]
    text += [f"Line({k}) = {{{k}, {k % 6 + 1}}};" for k in range(1, 7)] + ["Line(7) = {6, 3};"]
    text += ["Curve Loop(1) = {1, 2, -7, 6};", "Plane Surface(1) = {1};", "Curve Loop(2) = {7, 3, 4, 5};",
             "Plane Surface(2) = {2};", "Mesh.Algorithm = 6;"]
    text += [f'Physical Curve("{name}") = {{{tags}}};' for name, tags in (
        ("fracture", "7"), ("south", "1"), ("north", "4"), ("east", "2, 3"), ("west", "5, 6"))]
    return "\n".join(text + ['Physical Surface("rock") = {1, 2};', QUIET + f'Field[1].F = "{h:g}*(1+4*Sqrt(y^2))";']) + "\n"


def penny(folder, h, smallest, growth):
    """Tetrahedral mesh of a box around a disc of radius 1. Edges grow from `smallest` at the front by `growth` per
    length to h."""
    return around_disc(folder / f"penny_{h:g}_{smallest:g}_{growth:g}.msh", h, smallest, growth, "Disk(7) = {0, 0, 0, 1};")


def around_disc(file, h, smallest, growth, disc):
    script = f"""SetFactory("OpenCASCADE");
Box(1) = {{-2, -2, -2, 4, 4, 4}};
{disc}
BooleanFragments{{ Volume{{1}}; Delete; }}{{ Surface{{7}}; Delete; }}
Physical Surface("crack") = {{7}};
Physical Surface("boundary") = Abs(CombinedBoundary{{Volume{{:}};}});
Physical Volume("rock") = {{Volume{{:}}}};
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
{QUIET}Field[1].F = "{smallest:g}+{growth:g}*Sqrt((Sqrt(x^2+y^2)-1)^2+z^2)";
Mesh.MeshSizeMax = {h:g};
"""
    return with_gmsh(script, file, 3)


def polygon(folder, h, smallest, growth, sides=12):
    """Mesh as penny(), around a regular polygon with corners at distance 1 from its centre."""
    corners = [(math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    points = "".join(f"Point({100 + k}) = {{{x:.17g}, {y:.17g}, 0}};\n" for k, (x, y) in enumerate(corners))
    lines = "".join(f"Line({100 + k}) = {{{100 + k}, {100 + (k + 1) % sides}}};\n" for k in range(sides))
    return around_disc(folder / f"polygon_{sides}_{h:g}_{smallest:g}_{growth:g}.msh", h, smallest, growth,
                       f"{points}{lines}Curve Loop(100) = {{100 : {99 + sides}}};\nPlane Surface(7) = {{100}};")


# Flow

NETWORK = {"west-east": ((0, 0.2), (1, 0.7)), "north-south": ((0.15, 1), (0.8, 0)), "falling": ((0, 0.9), (1, 0.35))}


def crossing(first, second):
    """Returns the intersection of two lines, or None."""
    (a, b), (c, d) = first, second
    u, v, w = ([q[i] - p[i] for i in (0, 1)] for p, q in ((a, b), (c, d), (a, c)))
    area = u[0] * v[1] - u[1] * v[0]
    s, t = (w[0] * v[1] - w[1] * v[0]) / area, (w[0] * u[1] - w[1] * u[0]) / area
    return (a[0] + s * u[0], a[1] + s * u[1]) if 0 < s < 1 and 0 < t < 1 else None


def crossed(lines):
    """Returns the lines with their intersection points in order."""
    places = {}
    for name, (a, b) in lines.items():
        meets = {other: crossing(*(lines[k] for k in sorted((name, other)))) for other in lines if other != name}
        places[name] = tuple(sorted((a, b, *(p for p in meets.values() if p)), key=lambda p: math.dist(p, a)))
    return places


def network(folder, h):
    """Mesh of straight fractures that cross and end on the sides of the unit square."""
    return plane(folder / f"network_{h:g}.msh", crossed(NETWORK), f"{h:g}", (0, 0, 1, 1))


def hydrocoin(folder, h):
    """Mesh with two crossing faults from the hilly top to the bottom; edges of h, and h/4 at fault ends and at the
    crossing."""
    faults = crossed({"falling": ((400, 100), (1500, -1000)), "steep": ((1200, 100), (1000, -1000))})
    top = [(0, 150), (400, 100), (800, 150), (1200, 100), (1600, 150)]
    around = [*top, (1600, -1000), (1500, -1000), (1000, -1000), (0, -1000)]
    points = list(dict.fromkeys([*around, *faults["falling"], *faults["steep"]]))
    tags, n = {place: k for k, place in enumerate(points, 1)}, len(around)
    lines = [(k + 1, (k + 1) % n + 1) for k in range(n)]
    names = {"top": range(1, 5), "closed": range(5, n + 1)}
    for name, places in faults.items():
        names[name] = range(len(lines) + 1, len(lines) + len(places))
        lines += [(tags[a], tags[b]) for a, b in zip(places, places[1:])]
    size = graded_size(0.25, h / 4, [place for line in faults.values() for place in line])
    text = [f"Point({tag}) = {{{x:.17g}, {y:.17g}, 0}};" for (x, y), tag in tags.items()]
    text += [f"Line({k}) = {{{a}, {b}}};" for k, (a, b) in enumerate(lines, 1)]
    text += [f"Curve Loop(1) = {{1 : {n}}};", "Plane Surface(1) = {1};", f"Curve{{{n + 1} : {len(lines)}}} In Surface{{1}};", "Mesh.Algorithm = 6;"]
    text += [f'Physical Curve("{name}") = {{{", ".join(map(str, tags))}}};' for name, tags in names.items()]
    text += ['Physical Surface("rock") = {1};', QUIET + f'Field[1].F = "{size}";', f"Mesh.MeshSizeMax = {h:g};"]
    return with_gmsh("\n".join(text) + "\n", folder / f"hydrocoin_{h:g}.msh", 2)


def single(folder, h):
    """Tetrahedral mesh of a 100 m cube with a tilted plane fracture and a 10 m thick layer at the bottom.

    The inlet is the upper 10 m of the face x = 0, the outlet the layer's face in y = 0. Edges have the length
    h, and h/5 at the edges of inlet and outlet."""
    ends = "Min(Sqrt(x^2+(z-90)^2),Sqrt(y^2+(z-10)^2))"
    script = f"""SetFactory("OpenCASCADE");
Box(1) = {{0, 0, 0, 100, 100, 100}};
Point(21) = {{0, 0, 80}}; Point(22) = {{100, 0, 20}}; Point(23) = {{100, 100, 20}}; Point(24) = {{0, 100, 80}};
Point(25) = {{0, 0, 10}}; Point(26) = {{100, 0, 10}}; Point(27) = {{100, 100, 10}}; Point(28) = {{0, 100, 10}};
Point(29) = {{0, 0, 90}}; Point(30) = {{0, 100, 90}}; Point(31) = {{0, 100, 100}}; Point(32) = {{0, 0, 100}};
Line(21) = {{21, 22}}; Line(22) = {{22, 23}}; Line(23) = {{23, 24}}; Line(24) = {{24, 21}};
Line(25) = {{25, 26}}; Line(26) = {{26, 27}}; Line(27) = {{27, 28}}; Line(28) = {{28, 25}};
Line(29) = {{29, 30}}; Line(30) = {{30, 31}}; Line(31) = {{31, 32}}; Line(32) = {{32, 29}};
For k In {{0 : 2}}
  Curve Loop(20 + k) = {{21 + 4 * k, 22 + 4 * k, 23 + 4 * k, 24 + 4 * k}};
  Plane Surface(20 + k) = {{20 + k}};
EndFor
BooleanFragments{{ Volume{{1}}; Delete; }}{{ Surface{{20, 21, 22}}; Delete; }}
e = 1e-3;
Physical Surface("fracture") = Surface In BoundingBox {{-e, -e, 20 - e, 100 + e, 100 + e, 80 + e}};
Physical Surface("inlet") = Surface In BoundingBox {{-e, -e, 90 - e, e, 100 + e, 100 + e}};
Physical Surface("outlet") = Surface In BoundingBox {{-e, -e, -e, 100 + e, e, 10 + e}};
Physical Volume("lower") = Volume In BoundingBox {{-e, -e, -e, 100 + e, 100 + e, 10 + e}};
Physical Volume("upper") = Volume In BoundingBox {{-e, -e, 10 - e, 100 + e, 100 + e, 100 + e}};
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
{QUIET}Field[1].F = "{h:g}*Min(1,0.2+0.05*{ends})";
"""
    return with_gmsh(script, folder / f"single_{h:g}.msh", 3)


# Without fractures

def square(folder, h):
    """Triangular mesh of the unit square with edges of length h."""
    script = f"""SetFactory("OpenCASCADE");
Rectangle(1) = {{0, 0, 0, 1, 1}};
Physical Curve("boundary") = {{1 : 4}};
Physical Surface("rock") = {{1}};
Mesh.Algorithm = 6;
Mesh.MeshSizeMin = {h:g};
Mesh.MeshSizeMax = {h:g};
"""
    return with_gmsh(script, folder / f"square_{h:g}.msh", 2)
