"""Texts of the files: the table of fractures, and a scene with these fractures under load."""
import csv
import io
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
import realised


def table(sets, dim):
    """Returns the CSV file of [(set, fractures)]."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    has_apertures = any(one.aperture for one, _ in sets)
    shape = "x0 y0 x1 y1" if dim == 2 else "cx cy cz r1 r2 rake strike dip"
    rows.writerow(["name", *shape.split(), "material", *(["initial aperture [mm]"] if has_apertures else [])])
    for one, fractures in sets:
        for k, numbers in enumerate(lines(fractures) if dim == 2 else discs(fractures)):
            aperture = [""] if fractures.apertures is None else [f"{1e3 * fractures.apertures[k]:.9g}"]
            rows.writerow([f"{one.name} {k + 1}", *(f"{x:.12g}" for x in numbers), f"{one.name} joint",
                           *(aperture if has_apertures else [])])
    return text.getvalue()


def lines(fractures):
    half = 0.5 * fractures.sizes[:, None] * fractures.normals
    return np.hstack([fractures.centres - half, fractures.centres + half])


def discs(fractures):
    dip, dip_direction = realised.angles(fractures.normals)
    radii, strike = fractures.sizes, (dip_direction - 90) % 360
    return np.column_stack([fractures.centres, radii, radii, 0 * dip, strike, dip])


def parameter(name, value, kind="string"):
    return f'<Parameter name="{name}" type="{kind}" value="{escape(str(value), {chr(34): "&quot;"})}"/>'


def section(name, *content):
    """Returns the lines of a section. `content` are lines, or lists of lines of sections."""
    inner = [line for part in content for line in ([part] if isinstance(part, str) else part)]
    return [f'<ParameterList name="{name}">', *(f"  {line}" for line in inner), "</ParameterList>"]


def boundary(name, entry, value, kind="string"):
    return section(name, parameter("boundary", name), parameter(entry, value, kind))


def scene(statistics, table_name):
    """Returns the scene: rock under confinement and an increasing load along the last axis."""
    def corner(x):
        return f"{{{', '.join(f'{value:.15g}' for value in x)}}}"
    dim, diagonal = statistics.dim, np.linalg.norm(statistics.box[1] - statistics.box[0])
    network = section(
        "network",
        section("domain", parameter("lower corner", corner(statistics.box[0]), "Array(double)"),
                parameter("upper corner", corner(statistics.box[1]), "Array(double)")),
        section("fractures", section("network", parameter("file", table_name),
                                     *([] if dim == 2 else [parameter("format", "ellipses")]))),
        "<!-- Cells at a fracture, relative to its size; fractures closer than the tolerance are joined. -->",
        parameter("relative size", 0.25, "double"),
        parameter("tolerance", f"{1e-3 * diagonal:.3g}", "double"))
    joints = [section(f"{one.name} joint", parameter("type", "joint"), parameter("friction coefficient", 0.6, "double"),
                      parameter("tangential stiffness", "50 GPa/m"), parameter("dilation angle", "3 deg"))
              for one in statistics.sets]
    sides = []
    for axis, (fixed, loaded) in enumerate((("west", "east"), ("south", "north"), ("bottom", "top"))[:dim]):
        zero = ", ".join("0" if k == axis else "free" for k in range(dim))
        pressure = "10e6 + 30e6*t" if axis == dim - 1 else "10 MPa"
        sides += [boundary(fixed, "displacement", f"{{{zero}}}", "Array(string)"),
                  boundary(loaded, "confining pressure", pressure)]
    content = section(
        "Sprekk", section("Mesh file", network),
        "<!-- The table assigns one joint to each set. -->", section("Materials", *joints),
        section("Bulk", parameter("material", "granite")),
        section("Fractures", parameter("material", f"{statistics.sets[0].name} joint")),
        f"<!-- {'Three' if dim == 3 else 'Two'} sides have no normal displacement. -->",
        section("Boundary conditions", *sides), section("Time", parameter("steps", 5, "int")))
    source = Path(statistics.path).name.replace("--", "- -")  # in a comment
    about = ["<!-- Random fractures in granite, under 10 MPa and an increasing load on one side.",
             f"     `./sprekk network` drew them from {source}, seed {statistics.seed}. -->"]
    return "\n".join([*about, *content, ""])
