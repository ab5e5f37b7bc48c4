"""Meshes of gmsh, made by its program from scripts that this module writes. The same script gives the same mesh."""
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
    """Why there is no mesh."""


def with_gmsh(script, file, dimension):
    """Writes the script beside the mesh and makes the mesh, unless it is there already."""
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
    """A point turned counter-clockwise about the origin, as gmsh reads it."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return f"{{{c * x - s * y:.17g}, {s * x + c * y:.17g}, 0}}"


def plane(file, fractures, size, box=BOX, largest=None, angle=0, options=""):
    """Triangles of a box with fractures {name: (points of a line of segments)}, turned by an angle in degrees. `size` is
    the length of edges as a formula of gmsh in x and y. The points of all fractures that are equal are one point."""
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
    """Mesh U: h (0.6 + max(0, r - 1.2)), r from the centre of the crack."""
    return f"{h:g}*(0.6+Max(0,Sqrt(x^2+y^2)-1.2))"


def graded_size(h, smallest, tips):
    """smallest + h r, r from the nearest of the tips."""
    formula = ""
    for x, y in tips:
        distance = f"Sqrt((x-({x:.17g}))^2+(y-({y:.17g}))^2)"
        formula = distance if not formula else f"Min({formula},{distance})"
    return f"{smallest:g}+{h:g}*{formula}"


CRACK = {"crack": ((-1, 0), (1, 0))}


def uniform_crack(folder, h, angle=0):
    return plane(folder / f"uniform_{h:g}_{angle:g}.msh", CRACK, uniform_size(h), largest=0.4, angle=angle)


def graded_crack(folder, h, ratio):
    """Edges of h/1 at distance 1 from a tip, and `ratio` times h at it."""
    tips = CRACK["crack"]
    return plane(folder / f"graded_{h:g}_{ratio:g}.msh", CRACK, graded_size(h, h * ratio, tips), largest=h)


def t_junction(folder, h, ratio, half_width):
    """A horizontal fracture on which a vertical one ends; edges grow by h per length away from tips and junction, where
    they are 50 m times h times ratio."""
    fractures = {"horizontal": ((-25, 50), (0, 50), (25, 50)), "vertical": ((0, -50), (0, 50))}
    size = graded_size(h, 50 * h * ratio, [(-25, 50), (25, 50), (0, 50), (0, -50)])
    box = (-half_width, -half_width, half_width, half_width)
    return plane(folder / f"t_{h:g}_{ratio:g}_{half_width:g}.msh", fractures, size, box,
                 options="Mesh.RandomFactor = 1e-11;")  # of the size of the box: small against the smallest edge


def wavy(folder, h):
    """Half a period, 2 periods high on each side; edges of h on the fracture."""
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
    """Tetrahedra of a box around a disc of radius 1: edges of `smallest` at its front, growing by `growth` per length to h."""
    script = f"""SetFactory("OpenCASCADE");
Box(1) = {{-2, -2, -2, 4, 4, 4}};
Disk(7) = {{0, 0, 0, 1}};
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
    return with_gmsh(script, folder / f"penny_{h:g}_{smallest:g}_{growth:g}.msh", 3)
