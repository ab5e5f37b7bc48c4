# Printed by `./sprekk python -m sprekk.entries`.
from typing import Any, Literal, Sequence

class Section:
    def to_entries(self) -> dict[str, Any]: ...
    @classmethod
    def from_entries(cls, entries: dict[str, Any]) -> Any: ...

class Table(Section):
    """piecewise linear functions that expressions call by name, e.g. ramp(t)

    arguments: points at which values are given, strictly increasing (required)
    values: values at the arguments, linear in between (required)
    """
    arguments: Sequence[float | str] | None
    values: Sequence[float | str] | None
    def __init__(self, *, arguments: Sequence[float | str] | None = ..., values: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkDomainFace(Section):
    """of a polyhedron: its plane faces, each a polygon

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkDomain(Section):
    """the rock; a CSV of polygons may tell its box instead, in its first line (may be absent)

    sides: of a polygon: names of its sides, the first from corner 0 to corner 1; sides of one name are one boundary;
        without them side 1, side 2, ... (default {})
    lower_corner: of a box: its lowest coordinates, 2 or 3 (m; default {})
    upper_corner: of a box: its highest coordinates (m; default {})
    corners: of a polygon, 2D: x0, y0, x1, y1, ... (m; default {})
    faces: of a polyhedron: its plane faces, each a polygon
    """
    sides: Sequence[str] | None
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    corners: Sequence[float | str] | None
    faces: dict[str, MeshFileNetworkDomainFace] | None
    def __init__(self, *, sides: Sequence[str] | None = ..., lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., corners: Sequence[float | str] | None = ..., faces: dict[str, MeshFileNetworkDomainFace] | None = ...) -> None: ...

class MeshFileNetworkFractureLine(Section):
    """2D: polylines

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkFracturePolygon(Section):
    """3D: plane polygons, convex or not

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkFractureEllipse(Section):
    """3D: ellipses and discs

    centre: of the ellipse (m; 3 elements; required)
    radii: half axes, the first along the rake; of a disc both are equal (m; positive; 2 elements; required)
    strike: clockwise from north, which is y; the plane dips to the right of it (degree; default 0)
    dip: from the horizontal (degree; between 0 and 90; default 0)
    rake: in the plane, from the strike upwards to the first axis (degree; default 0)
    """
    centre: Sequence[float | str] | None
    radii: Sequence[float | str] | None
    strike: float | str | None
    dip: float | str | None
    rake: float | str | None
    def __init__(self, *, centre: Sequence[float | str] | None = ..., radii: Sequence[float | str] | None = ..., strike: float | str | None = ..., dip: float | str | None = ..., rake: float | str | None = ...) -> None: ...

class MeshFileNetworkFractureRandom(Section):
    """fractures at random (may be absent)

    number: of fractures, before they are clipped; centres are uniform in the domain (between 1 and 1000000; required)
    seed: of the random numbers; the same seed gives the same fractures (at least 0; default 1)
    shortest: length (2D) or diameter (3D), at least (m; positive; required)
    longest: length or diameter, at most (m; positive; required)
    exponent: a of the power law: the density of lengths L is proportional to L^-a (default 2.5)
    strike: mean; in 2D the direction of fractures, clockwise from y (degree; default 0)
    dip: mean, 3D (degree; between 0 and 90; default 0)
    concentration: kappa of Fisher's distribution of the poles around the mean (2D: of von Mises' of the doubled angle);
        0: all directions alike (between 0 and 1000000; default 0)
    corners: of the regular polygons, 3D (between 3 and 100; default 12)
    """
    number: int | None
    seed: int | None
    shortest: float | str | None
    longest: float | str | None
    exponent: float | str | None
    strike: float | str | None
    dip: float | str | None
    concentration: float | str | None
    corners: int | None
    def __init__(self, *, number: int | None = ..., seed: int | None = ..., shortest: float | str | None = ..., longest: float | str | None = ..., exponent: float | str | None = ..., strike: float | str | None = ..., dip: float | str | None = ..., concentration: float | str | None = ..., corners: int | None = ...) -> None: ...

class MeshFileNetworkFracture(Section):
    """sets of fractures by their names, which Fractures lists

    file: CSV or .fab of FracMan; relative to the scene's file
    format: of the file, a line each: id,x,y (3D: id,x,y,z), a point of the fracture id; id,x0,y0,x1,y1;
        x0,y0,z0,x1,y1,z1,...; cx,cy,cz,r1,r2,rake,strike,dip in degree; without it fab by the ending .fab, points by
        their columns, else lines in 2D and polygons in 3D ("points" | "lines" | "polygons" | "ellipses" | "fab")
    layers: of a drawing or a GeoPackage: those with the fractures; absent: all (default {})
    unit: of coordinates in the file, such as 1 mm; absent: 1 m (m; positive)
    lines: 2D: polylines
    polygons: 3D: plane polygons, convex or not
    ellipses: 3D: ellipses and discs
    random: fractures at random (may be absent)
    """
    file: str | None
    format: Literal["points", "lines", "polygons", "ellipses", "fab"] | None
    layers: Sequence[str] | None
    unit: float | str | None
    lines: dict[str, MeshFileNetworkFractureLine] | None
    polygons: dict[str, MeshFileNetworkFracturePolygon] | None
    ellipses: dict[str, MeshFileNetworkFractureEllipse] | None
    random: MeshFileNetworkFractureRandom | None
    def __init__(self, *, file: str | None = ..., format: Literal["points", "lines", "polygons", "ellipses", "fab"] | None = ..., layers: Sequence[str] | None = ..., unit: float | str | None = ..., lines: dict[str, MeshFileNetworkFractureLine] | None = ..., polygons: dict[str, MeshFileNetworkFracturePolygon] | None = ..., ellipses: dict[str, MeshFileNetworkFractureEllipse] | None = ..., random: MeshFileNetworkFractureRandom | None = ...) -> None: ...

class MeshFileNetworkConstraintLine(Section):
    """2D: polylines

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkConstraintPolygon(Section):
    """3D: plane polygons, convex or not

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkConstraintEllipse(Section):
    """3D: ellipses and discs

    centre: of the ellipse (m; 3 elements; required)
    radii: half axes, the first along the rake; of a disc both are equal (m; positive; 2 elements; required)
    strike: clockwise from north, which is y; the plane dips to the right of it (degree; default 0)
    dip: from the horizontal (degree; between 0 and 90; default 0)
    rake: in the plane, from the strike upwards to the first axis (degree; default 0)
    """
    centre: Sequence[float | str] | None
    radii: Sequence[float | str] | None
    strike: float | str | None
    dip: float | str | None
    rake: float | str | None
    def __init__(self, *, centre: Sequence[float | str] | None = ..., radii: Sequence[float | str] | None = ..., strike: float | str | None = ..., dip: float | str | None = ..., rake: float | str | None = ...) -> None: ...

class MeshFileNetworkConstraintRandom(Section):
    """fractures at random (may be absent)

    number: of fractures, before they are clipped; centres are uniform in the domain (between 1 and 1000000; required)
    seed: of the random numbers; the same seed gives the same fractures (at least 0; default 1)
    shortest: length (2D) or diameter (3D), at least (m; positive; required)
    longest: length or diameter, at most (m; positive; required)
    exponent: a of the power law: the density of lengths L is proportional to L^-a (default 2.5)
    strike: mean; in 2D the direction of fractures, clockwise from y (degree; default 0)
    dip: mean, 3D (degree; between 0 and 90; default 0)
    concentration: kappa of Fisher's distribution of the poles around the mean (2D: of von Mises' of the doubled angle);
        0: all directions alike (between 0 and 1000000; default 0)
    corners: of the regular polygons, 3D (between 3 and 100; default 12)
    """
    number: int | None
    seed: int | None
    shortest: float | str | None
    longest: float | str | None
    exponent: float | str | None
    strike: float | str | None
    dip: float | str | None
    concentration: float | str | None
    corners: int | None
    def __init__(self, *, number: int | None = ..., seed: int | None = ..., shortest: float | str | None = ..., longest: float | str | None = ..., exponent: float | str | None = ..., strike: float | str | None = ..., dip: float | str | None = ..., concentration: float | str | None = ..., corners: int | None = ...) -> None: ...

class MeshFileNetworkConstraint(Section):
    """lines (2D) or surfaces (3D) that cells keep to and that are no fractures

    file: CSV or .fab of FracMan; relative to the scene's file
    format: of the file, a line each: id,x,y (3D: id,x,y,z), a point of the fracture id; id,x0,y0,x1,y1;
        x0,y0,z0,x1,y1,z1,...; cx,cy,cz,r1,r2,rake,strike,dip in degree; without it fab by the ending .fab, points by
        their columns, else lines in 2D and polygons in 3D ("points" | "lines" | "polygons" | "ellipses" | "fab")
    layers: of a drawing or a GeoPackage: those with the fractures; absent: all (default {})
    unit: of coordinates in the file, such as 1 mm; absent: 1 m (m; positive)
    lines: 2D: polylines
    polygons: 3D: plane polygons, convex or not
    ellipses: 3D: ellipses and discs
    random: fractures at random (may be absent)
    """
    file: str | None
    format: Literal["points", "lines", "polygons", "ellipses", "fab"] | None
    layers: Sequence[str] | None
    unit: float | str | None
    lines: dict[str, MeshFileNetworkConstraintLine] | None
    polygons: dict[str, MeshFileNetworkConstraintPolygon] | None
    ellipses: dict[str, MeshFileNetworkConstraintEllipse] | None
    random: MeshFileNetworkConstraintRandom | None
    def __init__(self, *, file: str | None = ..., format: Literal["points", "lines", "polygons", "ellipses", "fab"] | None = ..., layers: Sequence[str] | None = ..., unit: float | str | None = ..., lines: dict[str, MeshFileNetworkConstraintLine] | None = ..., polygons: dict[str, MeshFileNetworkConstraintPolygon] | None = ..., ellipses: dict[str, MeshFileNetworkConstraintEllipse] | None = ..., random: MeshFileNetworkConstraintRandom | None = ...) -> None: ...

class MeshFileNetworkRegionFace(Section):
    """of a polyhedron: its plane faces, each a polygon

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkRegion(Section):
    """parts of the domain with a material of their own; the rest is "bulk"

    lower_corner: of a box: its lowest coordinates, 2 or 3 (m; default {})
    upper_corner: of a box: its highest coordinates (m; default {})
    corners: of a polygon, 2D: x0, y0, x1, y1, ... (m; default {})
    faces: of a polyhedron: its plane faces, each a polygon
    """
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    corners: Sequence[float | str] | None
    faces: dict[str, MeshFileNetworkRegionFace] | None
    def __init__(self, *, lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., corners: Sequence[float | str] | None = ..., faces: dict[str, MeshFileNetworkRegionFace] | None = ...) -> None: ...

class MeshFileNetwork(Section):
    """fractures of which `./sprekk mesh` makes the mesh, and `./sprekk run` before it runs (may be absent)

    relative_size: edges of cells at a fracture / length (3D: diameter) of that fracture (positive; default 0.1)
    size: edges of cells at most; absent: a tenth of the domain's diagonal (m; positive)
    size_at_tips: edges of cells where fractures end in the rock; absent: a twentieth (3D: a half) of that at the
        fracture (m; positive)
    size_at_intersections: absent: as at the fractures (m; positive)
    size_at_boundary: on the boundary of the domain; absent: as elsewhere (m; positive)
    growth: of edges per distance from where a size is given (positive; default 0.5)
    tolerance: what is closer is joined, and told: points and lines in 2D; in 3D corners of polygons, which are moved
        onto surfaces in their own plane; absent: 1e-6 of the domain's diagonal (m; positive)
    minimum_distance: fractures that come closer without being joined are refused; absent: 1e-4 of the domain's diagonal
        (m; at least 0)
    minimum_angle: fractures that meet at a smaller angle are refused (degree; between 0 and 60; default 2)
    most_cells: sizes that ask for more cells than this, by estimate, are refused before the mesh is made (at least 1;
        default 10000000)
    unusable_fractures: those outside of the domain, shorter than "tolerance" or "minimum distance", or without geometry
        in their file: an error, or left out and listed by the report ("refused" | "left out"; default refused)
    domain: the rock; a CSV of polygons may tell its box instead, in its first line (may be absent)
    fractures: sets of fractures by their names, which Fractures lists
    constraints: lines (2D) or surfaces (3D) that cells keep to and that are no fractures
    regions: parts of the domain with a material of their own; the rest is "bulk"
    """
    relative_size: float | str | None
    size: float | str | None
    size_at_tips: float | str | None
    size_at_intersections: float | str | None
    size_at_boundary: float | str | None
    growth: float | str | None
    tolerance: float | str | None
    minimum_distance: float | str | None
    minimum_angle: float | str | None
    most_cells: int | None
    unusable_fractures: Literal["refused", "left out"] | None
    domain: MeshFileNetworkDomain | None
    fractures: dict[str, MeshFileNetworkFracture] | None
    constraints: dict[str, MeshFileNetworkConstraint] | None
    regions: dict[str, MeshFileNetworkRegion] | None
    def __init__(self, *, relative_size: float | str | None = ..., size: float | str | None = ..., size_at_tips: float | str | None = ..., size_at_intersections: float | str | None = ..., size_at_boundary: float | str | None = ..., growth: float | str | None = ..., tolerance: float | str | None = ..., minimum_distance: float | str | None = ..., minimum_angle: float | str | None = ..., most_cells: int | None = ..., unusable_fractures: Literal["refused", "left out"] | None = ..., domain: MeshFileNetworkDomain | None = ..., fractures: dict[str, MeshFileNetworkFracture] | None = ..., constraints: dict[str, MeshFileNetworkConstraint] | None = ..., regions: dict[str, MeshFileNetworkRegion] | None = ...) -> None: ...

class MeshFileFracture(Section):
    """the physical groups that are fractures, by their names; those of a network need not be listed

    reference_normal: the normal, from side - to side +, has a positive product with this vector
    swap_sides: exchange side - and side + (default false)
    """
    reference_normal: Sequence[float | str] | None
    swap_sides: bool | None
    def __init__(self, *, reference_normal: Sequence[float | str] | None = ..., swap_sides: bool | None = ...) -> None: ...

class MeshFile(Section):
    """a mesh of gmsh, instead of the section Mesh (may be absent)

    path: file of gmsh, version 2.2 or 4.1; relative to the scene's file; required but for a network under `./sprekk
        run` and `check`, which make one (default "")
    order: of the displacement in each cell: 2 adds nodes in the middle of edges to a file of order 1; absent: as in the
        file (between 1 and 2)
    tips: crack tips; enriched: displacements grow with the square root of the distance from them, at order 1 by further
        unknowns, at order 2 by nodes at quarter points; plain: like the rest of the mesh ("enriched" | "plain"; default
        enriched)
    periodic: boundaries in pairs, {a, b, c, d}: displacements on b equal those on a, of which b is the translate, and
        so on (default {})
    refinements: how often every cell is cut into 4 (2D) or 8 (3D) smaller ones, by all ranks at once after the mesh has
        been distributed: for meshes larger than the memory of one rank (between 0 and 20; default 0)
    network: fractures of which `./sprekk mesh` makes the mesh, and `./sprekk run` before it runs (may be absent)
    fractures: the physical groups that are fractures, by their names; those of a network need not be listed
    """
    path: str | None
    order: int | None
    tips: Literal["enriched", "plain"] | None
    periodic: Sequence[str] | None
    refinements: int | None
    network: MeshFileNetwork | None
    fractures: dict[str, MeshFileFracture] | None
    def __init__(self, *, path: str | None = ..., order: int | None = ..., tips: Literal["enriched", "plain"] | None = ..., periodic: Sequence[str] | None = ..., refinements: int | None = ..., network: MeshFileNetwork | None = ..., fractures: dict[str, MeshFileFracture] | None = ...) -> None: ...

class MeshRegion(Section):
    """boxes of cells with a material of their own

    lower_corner: lowest coordinates, before the rotation (m; required)
    upper_corner: highest coordinates, before the rotation (m; required)
    """
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    def __init__(self, *, lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ...) -> None: ...

class MeshFracture(Section):
    """plane fractures along mesh planes

    lower_corner: lowest coordinates, before the rotation; on mesh planes (m; required)
    upper_corner: highest coordinates; equal to the lower corner's in the direction of the normal, and only there (m;
        required)
    reference_normal: the normal, from side - to side +, has a positive product with this vector, which turns with the
        box; without it the last component (z, y, x) of the rotated normal that is not zero is positive
    swap_sides: exchange side - and side + (default false)
    """
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    reference_normal: Sequence[float | str] | None
    swap_sides: bool | None
    def __init__(self, *, lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., reference_normal: Sequence[float | str] | None = ..., swap_sides: bool | None = ...) -> None: ...

class Mesh(Section):
    """a box with plane fractures

    cell: shape of the cells ("triangle" | "quadrilateral" | "tetrahedron" | "hexahedron"; required)
    lower_corner: lowest coordinates, before the rotation; 2 or 3 elements, which is the dimension (m; required)
    upper_corner: highest coordinates, before the rotation (m; required)
    cells: number of squares or cubes in each direction; a square makes 2 triangles, a cube 6 tetrahedra (at least 1;
        required)
    order: of the displacement in each cell: 1 (linear) or 2 (quadratic) (between 1 and 2; default 1)
    tips: crack tips; enriched: displacements grow with the square root of the distance from them, at order 1 by further
        unknowns, at order 2 by nodes at quarter points; plain: like the rest of the mesh ("enriched" | "plain"; default
        enriched)
    rotation: angle, counter-clockwise about the origin, by which the box turns (degree; between -360 and 360; default
        0)
    rotation_axis: axis of the rotation in 3D, through the origin (3 elements; default {0, 0, 1})
    periodic: directions (x, y, z, before the rotation) in which displacements on opposite sides are equal (default {})
    refinements: how often every cell is cut into 4 (2D) or 8 (3D) smaller ones, by all ranks at once after the mesh has
        been distributed: for meshes larger than the memory of one rank (between 0 and 20; default 0)
    renumbering_seed: seed of a random order of nodes and cells; without it the order is regular (at least 0)
    regions: boxes of cells with a material of their own
    fractures: plane fractures along mesh planes
    """
    cell: Literal["triangle", "quadrilateral", "tetrahedron", "hexahedron"] | None
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    cells: Sequence[int] | None
    order: int | None
    tips: Literal["enriched", "plain"] | None
    rotation: float | str | None
    rotation_axis: Sequence[float | str] | None
    periodic: Sequence[str] | None
    refinements: int | None
    renumbering_seed: int | None
    regions: dict[str, MeshRegion] | None
    fractures: dict[str, MeshFracture] | None
    def __init__(self, *, cell: Literal["triangle", "quadrilateral", "tetrahedron", "hexahedron"] | None = ..., lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., cells: Sequence[int] | None = ..., order: int | None = ..., tips: Literal["enriched", "plain"] | None = ..., rotation: float | str | None = ..., rotation_axis: Sequence[float | str] | None = ..., periodic: Sequence[str] | None = ..., refinements: int | None = ..., renumbering_seed: int | None = ..., regions: dict[str, MeshRegion] | None = ..., fractures: dict[str, MeshFracture] | None = ...) -> None: ...

class Material(Section):
    """rock and joints, by names of your choice; those of the material library need no section

    type: elastic: rock; joint: the surface of a fracture ("elastic" | "joint"; required)
    source: where the values come from
    youngs_modulus: E; give exactly two elastic constants (Pa; positive)
    poissons_ratio: nu (greater than -1 and less than 0.5)
    shear_modulus: G (Pa; positive)
    lames_first_parameter: lambda (Pa)
    bulk_modulus: K (Pa; positive)
    density: of the rock; needed with gravity (kg/m^3; at least 0)
    permeability: k of the rock, needed with "Flow": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY, YZ,
        XZ in 3D (m^2; default {})
    porosity: share of the volume that is fluid (between 0 and 1; default 0)
    compressibility_of_pores: growth of the porosity with the fluid's pressure; of rock that deforms: at constant
        strain, (Biot coefficient - porosity)/bulk modulus of the grains (Pa^-1; at least 0)
    biot_modulus: M, instead of the compressibility of pores: 1/M is that plus the porosity times the compressibility of
        the fluid, the storage at constant strain (Pa; positive or infinite)
    biot_coefficient: alpha: with "Flow" total stress is that of the displacement less alpha (p - initial pressure), and
        pores grow by alpha div u (between 0 and 1; default 1)
    thermal_conductivity: of the rock, needed with "Heat": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY,
        YZ, XZ in 3D (W/(m*K); default {})
    volumetric_heat_capacity: rho c, density times specific heat capacity, of the rock with what is in its pores; 0: no
        heat is stored (J/(m^3*K); at least 0; default 0)
    thermal_expansion: alpha_T, linear: the stress gets the part -3 K alpha_T (T - initial temperature) (K^-1; default
        0)
    tangential_elasticity: law of the elastic part of the tangential jump; linear: in proportion to the shear traction
        (12); power: at a stiffness that grows with a power of the compression ("linear" | "power"; default linear)
    tangential_stiffness: K_t of the elastic part of the tangential jump (12); infinite: all tangential jump is plastic;
        required with tangential elasticity "power" (Pa/m; positive or infinite; default infinite)
    shear_stiffening_stress: tangential elasticity "power", required: N_r: K_t (1 + N/N_r)^m is the tangential stiffness
        (Pa; positive)
    shear_stiffening_exponent: tangential elasticity "power", required: m of the tangential stiffness (at least 0)
    friction: law of the bound on the shear traction; Coulomb: in proportion to the compression (13); Barton-Choubey:
        peak strength of a rough joint, by JRC and JCS; mobilised Barton-Choubey: of a rough joint, by JRC and JCS, that
        slip mobilises and wears; composed: of riding over asperities and of shearing through them; slip weakening:
        falls linearly with the slip, from peak to residual; no slip: faces under compression never slip: a joint that
        is elastic alone, without a number ("Coulomb" | "Barton-Choubey" | "mobilised Barton-Choubey" | "composed" |
        "slip weakening" | "no slip"; default Coulomb)
    friction_coefficient: friction "Coulomb", "slip weakening": mu of the bound (13); or give the angle (at least 0)
    friction_angle: friction "Coulomb", "slip weakening": atan(mu) (3) (degree; at least 0 and less than 90)
    joint_roughness_coefficient: friction "Barton-Choubey", "mobilised Barton-Choubey", required; dilation "mobilised",
        required; closure "Bandis", required; hydraulic aperture "Barton", required: JRC: by so many degrees the angle
        falls with every decade of the compression (at least 0)
    joint_wall_strength: friction "Barton-Choubey", "mobilised Barton-Choubey", required; dilation "mobilised",
        required; closure "Bandis", required: JCS, the compression at which the roughness has no part any more (Pa;
        positive)
    residual_friction_angle: friction "Barton-Choubey", "mobilised Barton-Choubey", "slip weakening": phi_r, of the
        smooth joint; required with friction "Barton-Choubey", "mobilised Barton-Choubey" (degree; at least 0 and less
        than 90)
    largest_friction_angle: friction "Barton-Choubey", "mobilised Barton-Choubey": that the roughness leads to under
        small compression (degree; positive and less than 90; default 70)
    joint_length: friction "Barton-Choubey", "mobilised Barton-Choubey"; dilation "mobilised": L_n: JRC and JCS are of
        samples, and scaled to joints of this length; absent: they are the joint's own (m; positive)
    sample_length: friction "Barton-Choubey", "mobilised Barton-Choubey"; dilation "mobilised": L_0 of the samples that
        JRC and JCS were measured on (m; positive; default 0.1)
    peak_slip: friction "mobilised Barton-Choubey"; dilation "mobilised": delta_p at which all roughness is mobilised;
        absent: from the joint length (m; positive)
    basic_friction_coefficient: friction "composed": mu_b of the smooth rock; or give the angle (at least 0)
    basic_friction_angle: friction "composed": atan(mu_b) (degree; at least 0 and less than 90)
    asperity_angle: friction "composed", required: psi_0 by which asperities are inclined (degree; at least 0 and less
        than 90)
    asperity_friction_coefficient: friction "composed", required: mu_a that asperities add where they are sheared (at
        least 0)
    transition_stress: friction "composed", required: N_T, the compression from which on all asperities are sheared (Pa;
        positive)
    transition_exponent: friction "composed": K (greater than 1; default 1.5)
    residual_friction_coefficient: friction "slip weakening": mu_r that slip leaves; or give the angle (at least 0)
    weakening_distance: friction "slip weakening", required: D: the length of the path over which friction falls (m;
        positive)
    dilation: law of the opening by slip; constant angle: in proportion to the slip (14); mobilised: of a rough joint,
        by JRC and JCS, as slip mobilises it; decaying angle: at an angle that falls exponentially with the slip;
        limited: in proportion to the slip, up to a largest opening ("constant angle" | "mobilised" | "decaying angle" |
        "limited"; default constant angle)
    dilation_angle: dilation "constant angle", "decaying angle", "limited": theta: the gap grows by tan(theta)|u_t^p|
        (14); required with dilation "decaying angle", "limited" (degree; at least 0 and less than 90; default 0)
    asperity_damage_coefficient: dilation "mobilised": M: the part 1/M of the roughness angle dilates; about 1 at low, 2
        at high stress (positive; default 2)
    residual_dilation_angle: dilation "decaying angle": that slip leaves (degree; at least 0 and less than 90; default
        0)
    dilation_decay_distance: dilation "decaying angle", required: D: the slip by which the angle falls to 1/e of the way
        (m; positive)
    largest_dilation: dilation "limited", required: h: by which slip opens the joint, at the most (m; positive)
    initial_gap: g0 of (14) (m; default 0)
    closure: law of the closing under compression; Barton-Bandis: hyperbolic (14); Barton-Bandis with memory:
        hyperbolic, a part of which unloading does not recover; Bandis: hyperbolic, by JRC, JCS and aperture; power: at
        a stiffness that grows with a power of the compression; linear: in proportion to the traction ("Barton-Bandis" |
        "Barton-Bandis with memory" | "Bandis" | "power" | "linear"; default Barton-Bandis)
    maximum_closure: closure "Barton-Bandis", "Barton-Bandis with memory": Du of the normal closure in (14); 0: none;
        infinite, or absent: closure is linear, the traction over K_n (m; at least 0 or infinite)
    normal_stiffness: closure "Barton-Bandis", "Barton-Bandis with memory", "power", "linear": K_n at zero traction;
        absent: the joint does not close; required with closure "power", "linear" (Pa/m; positive)
    irrecoverable_part_of_closure: closure "Barton-Bandis with memory", required: r: of the closure under the largest
        compression so far (at least 0 and less than 1)
    joint_aperture: closure "Bandis", required: a, mechanical, of the unloaded joint (m; positive)
    loading_cycle: closure "Bandis": 1: first loading; 3: after two cycles (between 1 and 3; default 1)
    stiffening_stress: closure "power", required: N_r: K_n (1 + N/N_r)^m is the normal stiffness (Pa; positive)
    stiffening_exponent: closure "power", required: m of the normal stiffness (at least 0)
    bond: law of the strength that faces have beside friction; none: faces bear no tension, and no shear without
        compression; constant cohesion: shear strength of faces that touch, whatever they have slipped; no tension;
        linear softening: tensile and shear strength that opening and slip use up ("none" | "constant cohesion" |
        "linear softening"; default none)
    cohesion: bond "constant cohesion", "linear softening", required: c: what the bond adds to the bound on the shear
        traction (Pa; at least 0)
    opening_without_cohesion: bond "constant cohesion": o_0: faces that part lose c in proportion to their opening up to
        this; 0: at once, after which there may be no equilibrium where some would just open (m; at least 0; default 0)
    tensile_strength: bond "linear softening": T, of the whole bond (Pa; at least 0; default 0)
    fracture_energy: bond "linear softening": G_I that opening dissipates per area until the bond is lost (J/m^2;
        positive)
    shear_fracture_energy: bond "linear softening": G_II that slip dissipates per area, beside friction, until the bond
        is lost (J/m^2; positive)
    damage: law of the wear of friction and dilation; none: friction and dilation do not wear; isotropic: by slip in any
        direction; anisotropic: by slip on the side of the present plastic jump ("none" | "isotropic" | "anisotropic";
        default none)
    residual_part_of_friction: damage "isotropic", "anisotropic": of the bound of friction that damage leaves at last
        (between 0 and 1; default 0)
    damage_length_of_friction: damage "isotropic", "anisotropic": L of its exponential decay; infinite: it is not
        damaged (m; positive or infinite; default infinite)
    residual_part_of_dilation: damage "isotropic", "anisotropic": of the opening by slip that damage leaves at last
        (between 0 and 1; default 0)
    damage_length_of_dilation: damage "isotropic", "anisotropic": L of its exponential decay; infinite: it is not
        damaged (m; positive or infinite; default infinite)
    damage_driver: what slip counts in damage; slip: slip counts as it is; compression: slip times compression over the
        reference stress; frictional work: slip times shear traction over the reference stress ("slip" | "compression" |
        "frictional work"; default slip)
    reference_stress: damage driver "compression", "frictional work", required: under which a slip counts in damage as
        it is (Pa; positive)
    hydraulic_aperture: the aperture that a fluid flows in, with "Flow"; mechanical: that by which the walls are apart,
        of smooth walls; Barton: smaller, by JRC, the narrower the joint is ("mechanical" | "Barton"; default
        mechanical)
    initial_aperture: a0 of (15) (m; at least 0; default 0)
    strength_reduction_factor: F: the joint bears 1/F of the shear and of the tension that it would by its friction and
        its bond (positive; default 1)
    residual_aperture: the hydraulic aperture, with "Flow", is not less than this (m; at least 0; default 0)
    tangential_permeability: k_t of the flow along the fracture, with "Flow"; without it the cubic law holds, (hydraulic
        aperture)^2/12 (m^2; positive)
    normal_permeability: k_n of the flow across, with "Flow"; infinite: the fluid in the fracture has the pressure of
        that beside it (m^2; positive or infinite; default infinite)
    """
    type: Literal["elastic", "joint"] | None
    source: str | None
    youngs_modulus: float | str | None
    poissons_ratio: float | str | None
    shear_modulus: float | str | None
    lames_first_parameter: float | str | None
    bulk_modulus: float | str | None
    density: float | str | None
    permeability: Sequence[float | str] | None
    porosity: float | str | None
    compressibility_of_pores: float | str | None
    biot_modulus: float | str | None
    biot_coefficient: float | str | None
    thermal_conductivity: Sequence[float | str] | None
    volumetric_heat_capacity: float | str | None
    thermal_expansion: float | str | None
    tangential_elasticity: Literal["linear", "power"] | None
    tangential_stiffness: float | str | None
    shear_stiffening_stress: float | str | None
    shear_stiffening_exponent: float | str | None
    friction: Literal["Coulomb", "Barton-Choubey", "mobilised Barton-Choubey", "composed", "slip weakening", "no slip"] | None
    friction_coefficient: float | str | None
    friction_angle: float | str | None
    joint_roughness_coefficient: float | str | None
    joint_wall_strength: float | str | None
    residual_friction_angle: float | str | None
    largest_friction_angle: float | str | None
    joint_length: float | str | None
    sample_length: float | str | None
    peak_slip: float | str | None
    basic_friction_coefficient: float | str | None
    basic_friction_angle: float | str | None
    asperity_angle: float | str | None
    asperity_friction_coefficient: float | str | None
    transition_stress: float | str | None
    transition_exponent: float | str | None
    residual_friction_coefficient: float | str | None
    weakening_distance: float | str | None
    dilation: Literal["constant angle", "mobilised", "decaying angle", "limited"] | None
    dilation_angle: float | str | None
    asperity_damage_coefficient: float | str | None
    residual_dilation_angle: float | str | None
    dilation_decay_distance: float | str | None
    largest_dilation: float | str | None
    initial_gap: float | str | None
    closure: Literal["Barton-Bandis", "Barton-Bandis with memory", "Bandis", "power", "linear"] | None
    maximum_closure: float | str | None
    normal_stiffness: float | str | None
    irrecoverable_part_of_closure: float | str | None
    joint_aperture: float | str | None
    loading_cycle: float | str | None
    stiffening_stress: float | str | None
    stiffening_exponent: float | str | None
    bond: Literal["none", "constant cohesion", "linear softening"] | None
    cohesion: float | str | None
    opening_without_cohesion: float | str | None
    tensile_strength: float | str | None
    fracture_energy: float | str | None
    shear_fracture_energy: float | str | None
    damage: Literal["none", "isotropic", "anisotropic"] | None
    residual_part_of_friction: float | str | None
    damage_length_of_friction: float | str | None
    residual_part_of_dilation: float | str | None
    damage_length_of_dilation: float | str | None
    damage_driver: Literal["slip", "compression", "frictional work"] | None
    reference_stress: float | str | None
    hydraulic_aperture: Literal["mechanical", "Barton"] | None
    initial_aperture: float | str | None
    strength_reduction_factor: float | str | None
    residual_aperture: float | str | None
    tangential_permeability: float | str | None
    normal_permeability: float | str | None
    def __init__(self, *, type: Literal["elastic", "joint"] | None = ..., source: str | None = ..., youngs_modulus: float | str | None = ..., poissons_ratio: float | str | None = ..., shear_modulus: float | str | None = ..., lames_first_parameter: float | str | None = ..., bulk_modulus: float | str | None = ..., density: float | str | None = ..., permeability: Sequence[float | str] | None = ..., porosity: float | str | None = ..., compressibility_of_pores: float | str | None = ..., biot_modulus: float | str | None = ..., biot_coefficient: float | str | None = ..., thermal_conductivity: Sequence[float | str] | None = ..., volumetric_heat_capacity: float | str | None = ..., thermal_expansion: float | str | None = ..., tangential_elasticity: Literal["linear", "power"] | None = ..., tangential_stiffness: float | str | None = ..., shear_stiffening_stress: float | str | None = ..., shear_stiffening_exponent: float | str | None = ..., friction: Literal["Coulomb", "Barton-Choubey", "mobilised Barton-Choubey", "composed", "slip weakening", "no slip"] | None = ..., friction_coefficient: float | str | None = ..., friction_angle: float | str | None = ..., joint_roughness_coefficient: float | str | None = ..., joint_wall_strength: float | str | None = ..., residual_friction_angle: float | str | None = ..., largest_friction_angle: float | str | None = ..., joint_length: float | str | None = ..., sample_length: float | str | None = ..., peak_slip: float | str | None = ..., basic_friction_coefficient: float | str | None = ..., basic_friction_angle: float | str | None = ..., asperity_angle: float | str | None = ..., asperity_friction_coefficient: float | str | None = ..., transition_stress: float | str | None = ..., transition_exponent: float | str | None = ..., residual_friction_coefficient: float | str | None = ..., weakening_distance: float | str | None = ..., dilation: Literal["constant angle", "mobilised", "decaying angle", "limited"] | None = ..., dilation_angle: float | str | None = ..., asperity_damage_coefficient: float | str | None = ..., residual_dilation_angle: float | str | None = ..., dilation_decay_distance: float | str | None = ..., largest_dilation: float | str | None = ..., initial_gap: float | str | None = ..., closure: Literal["Barton-Bandis", "Barton-Bandis with memory", "Bandis", "power", "linear"] | None = ..., maximum_closure: float | str | None = ..., normal_stiffness: float | str | None = ..., irrecoverable_part_of_closure: float | str | None = ..., joint_aperture: float | str | None = ..., loading_cycle: float | str | None = ..., stiffening_stress: float | str | None = ..., stiffening_exponent: float | str | None = ..., bond: Literal["none", "constant cohesion", "linear softening"] | None = ..., cohesion: float | str | None = ..., opening_without_cohesion: float | str | None = ..., tensile_strength: float | str | None = ..., fracture_energy: float | str | None = ..., shear_fracture_energy: float | str | None = ..., damage: Literal["none", "isotropic", "anisotropic"] | None = ..., residual_part_of_friction: float | str | None = ..., damage_length_of_friction: float | str | None = ..., residual_part_of_dilation: float | str | None = ..., damage_length_of_dilation: float | str | None = ..., damage_driver: Literal["slip", "compression", "frictional work"] | None = ..., reference_stress: float | str | None = ..., hydraulic_aperture: Literal["mechanical", "Barton"] | None = ..., initial_aperture: float | str | None = ..., strength_reduction_factor: float | str | None = ..., residual_aperture: float | str | None = ..., tangential_permeability: float | str | None = ..., normal_permeability: float | str | None = ...) -> None: ...

class BulkLithostaticStress(Section):
    """initial stress of rock at rest under gravity along the last coordinate (may be absent)

    surface: coordinate where the vertical stress is zero (m; required)
    horizontal_ratio: horizontal over vertical stress (at least 0; default 1)
    """
    surface: float | str | None
    horizontal_ratio: float | str | None
    def __init__(self, *, surface: float | str | None = ..., horizontal_ratio: float | str | None = ...) -> None: ...

class BulkInSituStress(Section):
    """initial stress given by the vertical one and two horizontal ones, compression positive (may be absent)

    datum: vertical coordinate from which depth counts, z in 3D, y in 2D (m; required)
    sv: vertical stress at the datum, compression positive (Pa; default 0)
    sv_gradient: its growth with depth, per metre (Pa/m; default 0)
    shmax: largest horizontal stress at the datum, compression positive (Pa; default 0)
    shmax_gradient: its growth with depth, per metre (Pa/m; default 0)
    shmin: smallest horizontal stress at the datum, compression positive (Pa; default 0)
    shmin_gradient: its growth with depth, per metre (Pa/m; default 0)
    azimuth: direction of SHmax, clockwise from north: in 3D x is east and y north; in 2D, a section from west to east,
        90 (SHmax lies in it) or 0 (across it) (degree; default 90)
    """
    datum: float | str | None
    sv: float | str | None
    sv_gradient: float | str | None
    shmax: float | str | None
    shmax_gradient: float | str | None
    shmin: float | str | None
    shmin_gradient: float | str | None
    azimuth: float | str | None
    def __init__(self, *, datum: float | str | None = ..., sv: float | str | None = ..., sv_gradient: float | str | None = ..., shmax: float | str | None = ..., shmax_gradient: float | str | None = ..., shmin: float | str | None = ..., shmin_gradient: float | str | None = ..., azimuth: float | str | None = ...) -> None: ...

class Bulk(Section):
    """the rock

    material: name of an elastic material, of this scene or of the library (required)
    gravity: acceleration per direction, e.g. {0, 0, -9.81}; adds the density times it to the body force (m/s^2; default
        {})
    rigid: the rock does not deform: no mechanics, and no displacements (default false)
    body_force: force per volume, one value or expression of x, y, z, t per direction (N/m^3; default {})
    initial_stress: stress at zero displacement, tension positive: XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D;
        values or expressions of x, y, z (Pa; default {})
    release: two times, set by "release" of a stage: forces out of balance at the first are let go until the second (s;
        default {})
    lithostatic_stress: initial stress of rock at rest under gravity along the last coordinate (may be absent)
    in_situ_stress: initial stress given by the vertical one and two horizontal ones, compression positive (may be
        absent)
    """
    material: str | None
    gravity: Sequence[float | str] | None
    rigid: bool | None
    body_force: Sequence[float | str] | None
    initial_stress: Sequence[float | str] | None
    release: Sequence[float | str] | None
    lithostatic_stress: BulkLithostaticStress | None
    in_situ_stress: BulkInSituStress | None
    def __init__(self, *, material: str | None = ..., gravity: Sequence[float | str] | None = ..., rigid: bool | None = ..., body_force: Sequence[float | str] | None = ..., initial_stress: Sequence[float | str] | None = ..., release: Sequence[float | str] | None = ..., lithostatic_stress: BulkLithostaticStress | None = ..., in_situ_stress: BulkInSituStress | None = ...) -> None: ...

class FlowWell(Section):
    """by names of your choice

    points: 2D: x, y of a line of length 1 across the plane; 3D: of a polyline, x0, y0, z0, x1, y1, z1, ... (m;
        required)
    radius: r_w of the hole (m; positive; required)
    skin: S: the pressure falls by S like flow by a further factor exp(S) of distance (default 0)
    rate: volume of fluid per time that is put in (2D: m^2/s), negative: taken out; an expression of t (m^3/s)
    pressure: in the well at its first point, an expression of t (Pa)
    """
    points: Sequence[float | str] | None
    radius: float | str | None
    skin: float | str | None
    rate: float | str | None
    pressure: float | str | None
    def __init__(self, *, points: Sequence[float | str] | None = ..., radius: float | str | None = ..., skin: float | str | None = ..., rate: float | str | None = ..., pressure: float | str | None = ...) -> None: ...

class Flow(Section):
    """a fluid that flows through the rock (may be absent)

    rigid_rock: the rock does not deform: flow alone, without displacements (default false)
    viscosity: mu of the fluid (Pa*s; positive; default 0.001)
    density: rho_0 of the fluid, at the reference pressure; its weight counts where "Bulk" has gravity (kg/m^3; at least
        0; default 1000)
    compressibility: c of the fluid: its density is rho_0 exp(c (p - reference pressure)) (Pa^-1; at least 0; default 0)
    reference_pressure: with a compressibility: where the density is as given; volumes of fluid are at this pressure
        (Pa; default 0)
    source: volume of fluid per volume of rock and time, an expression of x, y, z, t (s^-1; default 0)
    initial_pressure: at the start, where fluid is stored; of x, y, z (Pa; default 0)
    scheme: how flows follow from pressures; auto: rt0 on simplices; on others tpfa where permeability and cells are
        orthogonal, else mimetic ("auto" | "rt0" | "tpfa" | "mimetic"; default auto)
    wells: by names of your choice
    """
    rigid_rock: bool | None
    viscosity: float | str | None
    density: float | str | None
    compressibility: float | str | None
    reference_pressure: float | str | None
    source: float | str | None
    initial_pressure: float | str | None
    scheme: Literal["auto", "rt0", "tpfa", "mimetic"] | None
    wells: dict[str, FlowWell] | None
    def __init__(self, *, rigid_rock: bool | None = ..., viscosity: float | str | None = ..., density: float | str | None = ..., compressibility: float | str | None = ..., reference_pressure: float | str | None = ..., source: float | str | None = ..., initial_pressure: float | str | None = ..., scheme: Literal["auto", "rt0", "tpfa", "mimetic"] | None = ..., wells: dict[str, FlowWell] | None = ...) -> None: ...

class HeatWell(Section):
    """by names of wells of "Flow"; others put in fluid as warm as the place

    temperature: of the fluid that it puts in, an expression of t (K; at least 0; required)
    """
    temperature: float | str | None
    def __init__(self, *, temperature: float | str | None = ...) -> None: ...

class Heat(Section):
    """heat that rock and fractures conduct and store and a fluid carries (may be absent)

    source: power per volume of rock, an expression of x, y, z, t (W/m^3; default 0)
    initial_temperature: at the start, where heat is stored; of x, y, z; thermal stress is zero there (K)
    fluid_heat_capacity: rho_0 c of the fluid of "Flow", at its reference pressure; needed with it (J/(m^3*K); at least
        0)
    fluid_thermal_expansion: volumetric, of the fluid: what becomes warmer needs more room, in pores and fractures
        (K^-1; at least 0; default 0)
    fluid: how density and viscosity of the fluid of "Flow" change with the temperature T; exponential: rho = rho_0
        exp(c (p - p_0) - "fluid thermal expansion" (T - T_0)), mu = mu_0 exp(-"viscosity decay" (T - T_0)); water: as
        those of saturated liquid (IAPWS) to those at T_0, from 273.16 to 623.15 K ("constant" | "exponential" |
        "water"; default constant)
    viscosity_decay: of an exponential fluid, about 0.02 of water (K^-1; at least 0; default 0)
    reference_temperature: T_0, where density and viscosity of "Flow" are as given there, unless the fluid is constant
        (K; at least 0; default 293.15)
    scheme: how flows follow from temperatures; auto: rt0 on simplices; on others tpfa where conductivity and cells are
        orthogonal, else mimetic ("auto" | "rt0" | "tpfa" | "mimetic"; default auto)
    advection: how the fluid carries heat between cells, and along fractures; second order: with limited corrections
        once per step, of use for steps in which it does not cross more than about half a cell, with implicit Euler
        ("upwind" | "second order"; default upwind)
    heat_of_friction: what fractures dissipate as they slide warms them (default false)
    wells: by names of wells of "Flow"; others put in fluid as warm as the place
    """
    source: float | str | None
    initial_temperature: float | str | None
    fluid_heat_capacity: float | str | None
    fluid_thermal_expansion: float | str | None
    fluid: Literal["constant", "exponential", "water"] | None
    viscosity_decay: float | str | None
    reference_temperature: float | str | None
    scheme: Literal["auto", "rt0", "tpfa", "mimetic"] | None
    advection: Literal["upwind", "second order"] | None
    heat_of_friction: bool | None
    wells: dict[str, HeatWell] | None
    def __init__(self, *, source: float | str | None = ..., initial_temperature: float | str | None = ..., fluid_heat_capacity: float | str | None = ..., fluid_thermal_expansion: float | str | None = ..., fluid: Literal["constant", "exponential", "water"] | None = ..., viscosity_decay: float | str | None = ..., reference_temperature: float | str | None = ..., scheme: Literal["auto", "rt0", "tpfa", "mimetic"] | None = ..., advection: Literal["upwind", "second order"] | None = ..., heat_of_friction: bool | None = ..., wells: dict[str, HeatWell] | None = ...) -> None: ...

class Region(Section):
    """what regions of the mesh have of their own, by their names

    material: name of an elastic material, of this scene or of the library; absent: that of "Bulk"
    excavated: its cells are taken away; its walls are a boundary of the same name, and fractures end there (default
        false)
    initial_stress: stress at zero displacement, in place of that of "Bulk", tension positive: XX, YY, ZZ, XY in 2D; XX,
        YY, ZZ, XY, YZ, XZ in 3D; values or expressions of x, y, z (Pa; default {})
    pressure: of the fluid in its cells and in fractures inside of it, with "Flow": a value or an expression of x, y, z,
        t (Pa)
    temperature: of its cells, with "Heat": a value or an expression of x, y, z, t (K; at least 0)
    """
    material: str | None
    excavated: bool | None
    initial_stress: Sequence[float | str] | None
    pressure: float | str | None
    temperature: float | str | None
    def __init__(self, *, material: str | None = ..., excavated: bool | None = ..., initial_stress: Sequence[float | str] | None = ..., pressure: float | str | None = ..., temperature: float | str | None = ...) -> None: ...

class Fracture(Section):
    """a section for each fracture of the mesh that needs one

    material: name of a joint material, of this scene or of the library; that of "Fractures" where it is missing here
        (required)
    fluid_pressure: p, a value or an expression of x, y, z, t: it pushes the sides apart; the traction on the rock is
        lambda - p n (Pa; default 0)
    plastic_jump: tangential plastic jump at the start, in the frame of the face: t in 2D, t1, t2 in 3D; values or
        expressions of x, y, z (m; default {})
    source: volume of fluid per area and time that is put into the fracture, with "Flow", an expression of x, y, z, t
        (m/s; default 0)
    cuts: names of fractures that it divides where they meet: what flows from one part to the other crosses it, by its
        normal permeability, with "Flow" (default {})
    """
    material: str | None
    fluid_pressure: float | str | None
    plastic_jump: Sequence[float | str] | None
    source: float | str | None
    cuts: Sequence[str] | None
    def __init__(self, *, material: str | None = ..., fluid_pressure: float | str | None = ..., plastic_jump: Sequence[float | str] | None = ..., source: float | str | None = ..., cuts: Sequence[str] | None = ...) -> None: ...

class BoundaryCondition(Section):
    """by names of your choice; boundaries without one are free of traction

    boundary: name of a boundary of the mesh: west, east, south, north, bottom, top (required)
    region: name of a region: the condition holds only on faces of its cells
    fracture: name of a fracture: the condition holds only where it ends on the boundary, per aperture and length; not
        of displacements and tractions
    displacement: per direction a value, an expression of x, y, z, t, or free (m; finite or "free"; default {})
    lower_corner: of a box: the "displacement" holds only at nodes of the boundary in it, e.g. at a point or along an
        edge (m; default {})
    upper_corner: of the box; absent: the "lower corner", a point (m; default {})
    traction: force per area on the body, per direction a value or an expression of x, y, z, t (Pa; default {})
    confining_pressure: force per area into the body along the normal of its faces, a value or an expression of x, y, z,
        t; is added to a "traction" (Pa)
    foundation_stiffness: of springs between the boundary and rigid ground, per direction: the traction -k_i u_i is
        added (Pa/m; at least 0; default {})
    pressure: of the fluid, with "Flow": a value or an expression of x, y, z, t; without a "fracture" and without a
        conductance it holds for rock and fractures, all else for rock (Pa)
    flux: volume of fluid that leaves per area and time, with "Flow" (m/s)
    conductance: c: the flux is c (p - pressure), the pressure then being that beyond the boundary (m/(Pa*s); at least
        0)
    temperature: with "Heat": a value or an expression of x, y, z, t (K; at least 0)
    heat_flux: heat that leaves per area and time, with "Heat" (W/m^2)
    heat_transfer_coefficient: h: the flux is h (T - temperature), the temperature then being that beyond the boundary
        (W/(m^2*K); at least 0)
    """
    boundary: str | None
    region: str | None
    fracture: str | None
    displacement: Sequence[float | str] | None
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    traction: Sequence[float | str] | None
    confining_pressure: float | str | None
    foundation_stiffness: Sequence[float | str] | None
    pressure: float | str | None
    flux: float | str | None
    conductance: float | str | None
    temperature: float | str | None
    heat_flux: float | str | None
    heat_transfer_coefficient: float | str | None
    def __init__(self, *, boundary: str | None = ..., region: str | None = ..., fracture: str | None = ..., displacement: Sequence[float | str] | None = ..., lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., traction: Sequence[float | str] | None = ..., confining_pressure: float | str | None = ..., foundation_stiffness: Sequence[float | str] | None = ..., pressure: float | str | None = ..., flux: float | str | None = ..., conductance: float | str | None = ..., temperature: float | str | None = ..., heat_flux: float | str | None = ..., heat_transfer_coefficient: float | str | None = ...) -> None: ...

class Probe(Section):
    """by names of your choice: what is written of each step as a table of its own

    outputs: names of arrays of bulk.pvd or fractures.pvd, of numbers that results.json has of fractures, or of sums
        over a boundary as "reactions" (default {})
    point: coordinates: values at a point (m; default {})
    line: coordinates of its first and its last point: values along it (m; default {})
    points: of the line, at equal distances, its ends among them (between 2 and 100000; default 11)
    boundary: name of a boundary: the "value" over its faces
    region: name of a region: the "value" over its cells
    fracture: name of a fracture, or of a set of them: the "value" over its faces
    value: over a boundary, a region or a fracture ("mean" | "maximum" | "minimum" | "integral"; default mean)
    well: name of a well: all that results.json has of it
    """
    outputs: Sequence[str] | None
    point: Sequence[float | str] | None
    line: Sequence[float | str] | None
    points: int | None
    boundary: str | None
    region: str | None
    fracture: str | None
    value: Literal["mean", "maximum", "minimum", "integral"] | None
    well: str | None
    def __init__(self, *, outputs: Sequence[str] | None = ..., point: Sequence[float | str] | None = ..., line: Sequence[float | str] | None = ..., points: int | None = ..., boundary: str | None = ..., region: str | None = ..., fracture: str | None = ..., value: Literal["mean", "maximum", "minimum", "integral"] | None = ..., well: str | None = ...) -> None: ...

class Time(Section):
    """steps

    start: time of the initial state (s; default 0)
    end: end of the last step (s; default 1)
    steps: number of equal steps from start to end; absent: 1 (between 1 and 10000000)
    schedule: ends of all steps, increasing; replaces end and steps; with tolerance, times that steps are to end at (s)
    tolerance: relative time error that adaptive steps meet, see docs/use/time_and_solver.md; instead of steps (between
        1e-08 and 0.5)
    target_newton_iterations: steps become shorter where Newton's method takes more, and longer where it takes less;
        with tolerance, no longer than that allows (between 1 and 1000)
    first_step: its length, of steps that are chosen; absent: a part of all (s; positive)
    smallest_step: which is taken whatever it errs in; absent: 1e-9 of all (s; positive)
    largest_step: absent: as long as all (s; positive)
    scheme: of rates of what is stored: of first or second order in time ("implicit Euler" | "BDF2"; default implicit
        Euler)
    maximum_halvings: how often a step that fails is halved before the run ends (between 0 and 20; default 6)
    tethers: where Newton fails, first tether the sides of fractures to each other, and let them go little by little;
        after three halvings where shorter steps are easier to solve (default true)
    """
    start: float | str | None
    end: float | str | None
    steps: int | None
    schedule: Sequence[float | str] | None
    tolerance: float | str | None
    target_newton_iterations: int | None
    first_step: float | str | None
    smallest_step: float | str | None
    largest_step: float | str | None
    scheme: Literal["implicit Euler", "BDF2"] | None
    maximum_halvings: int | None
    tethers: bool | None
    def __init__(self, *, start: float | str | None = ..., end: float | str | None = ..., steps: int | None = ..., schedule: Sequence[float | str] | None = ..., tolerance: float | str | None = ..., target_newton_iterations: int | None = ..., first_step: float | str | None = ..., smallest_step: float | str | None = ..., largest_step: float | str | None = ..., scheme: Literal["implicit Euler", "BDF2"] | None = ..., maximum_halvings: int | None = ..., tethers: bool | None = ...) -> None: ...

class SolverLinearSolver(Section):
    """solver of the linear systems

    type: direct: MUMPS; iterative: Belos with multigrid; auto: direct up to the limits below ("auto" | "direct" |
        "iterative"; default auto)
    tolerance: relative residual asked of every linear solve (positive; default 1e-12)
    forcing: iterative: end a solve early, while faces change state once two accuracies a hundred times apart lead to
        the same states, and after that where Newton's method gains nothing from more (default true)
    direct_limit_2d: auto: most unknowns that are solved directly in 2D (default 150000)
    direct_limit_3d: auto: most unknowns that are solved directly in 3D (default 3000)
    reproducible: factor on rank 0 alone; on several, MUMPS adds what comes first, and the last bits vary; absent: true
        if checkpoints are asked for
    mumps: ICNTL(i) and CNTL(i) of MUMPS, by these names
    belos: parameters of Belos; "Solver Type" names another Krylov method
    """
    type: Literal["auto", "direct", "iterative"] | None
    tolerance: float | str | None
    forcing: bool | None
    direct_limit_2d: int | None
    direct_limit_3d: int | None
    reproducible: bool | None
    mumps: dict[str, Any] | None
    belos: dict[str, Any] | None
    def __init__(self, *, type: Literal["auto", "direct", "iterative"] | None = ..., tolerance: float | str | None = ..., forcing: bool | None = ..., direct_limit_2d: int | None = ..., direct_limit_3d: int | None = ..., reproducible: bool | None = ..., mumps: dict[str, Any] | None = ..., belos: dict[str, Any] | None = ...) -> None: ...

class SolverBlockMultigrid(Section):
    """type multigrid, or auto: Sprekk's own (may be absent)

    degree: of Chebyshev's polynomial, the smoother; the finest level takes a higher one in flat cells (at least 1;
        default 4)
    coarsest_level: unknowns, at or below which a level is solved directly (at least 1; default 300)
    least_of_a_rank: numbers of its matrix: a level of which ranks have fewer on average moves to fewer ranks (at least
        1; default 100000)
    """
    degree: int | None
    coarsest_level: int | None
    least_of_a_rank: int | None
    def __init__(self, *, degree: int | None = ..., coarsest_level: int | None = ..., least_of_a_rank: int | None = ...) -> None: ...

class SolverBlock(Section):
    """how the block of this name is preconditioned, where the solver is iterative

    type: how the block, or the group that begins with it, is preconditioned; auto: multigrid where unknowns have
        places, MueLu where a flow carries them, else Gauss-Seidel, and groups without a method of their own directly
        ("auto" | "multigrid" | "MueLu" | "Ifpack2" | "Gauss-Seidel" | "direct"; default auto)
    with_: the block of whose group it is a part; absent: as the fields ask for (default "")
    multigrid: type multigrid, or auto: Sprekk's own (may be absent)
    muelu: type MueLu: its parameters, over the defaults
    ifpack2: type Ifpack2: its parameters; "type" names the method, e.g. ILUT
    """
    type: Literal["auto", "multigrid", "MueLu", "Ifpack2", "Gauss-Seidel", "direct"] | None
    with_: str | None
    multigrid: SolverBlockMultigrid | None
    muelu: dict[str, Any] | None
    ifpack2: dict[str, Any] | None
    def __init__(self, *, type: Literal["auto", "multigrid", "MueLu", "Ifpack2", "Gauss-Seidel", "direct"] | None = ..., with_: str | None = ..., multigrid: SolverBlockMultigrid | None = ..., muelu: dict[str, Any] | None = ..., ifpack2: dict[str, Any] | None = ...) -> None: ...

class SolverSweep(Section):
    """over the groups of blocks, where there are several

    type: forward: each group sees the corrections of those before; symmetric: and then, backward, of those after;
        diagonal: of none ("forward" | "symmetric" | "diagonal"; default forward)
    order: the first block of every group, in the order of the sweep; absent: as the fields come (default {})
    """
    type: Literal["forward", "symmetric", "diagonal"] | None
    order: Sequence[str] | None
    def __init__(self, *, type: Literal["forward", "symmetric", "diagonal"] | None = ..., order: Sequence[str] | None = ...) -> None: ...

class Solver(Section):
    """Newton's method

    tolerance: largest measure of convergence, relative to the loads (positive; default 1e-11)
    maximum_iterations: Newton steps before a solve has failed (at least 1; default 30)
    print: print every Newton step (default false)
    linear_solver: solver of the linear systems
    blocks: how the block of this name is preconditioned, where the solver is iterative
    sweep: over the groups of blocks, where there are several
    nox: parameters of NOX
    """
    tolerance: float | str | None
    maximum_iterations: int | None
    print: bool | None
    linear_solver: SolverLinearSolver | None
    blocks: dict[str, SolverBlock] | None
    sweep: SolverSweep | None
    nox: dict[str, Any] | None
    def __init__(self, *, tolerance: float | str | None = ..., maximum_iterations: int | None = ..., print: bool | None = ..., linear_solver: SolverLinearSolver | None = ..., blocks: dict[str, SolverBlock] | None = ..., sweep: SolverSweep | None = ..., nox: dict[str, Any] | None = ...) -> None: ...

class OutputCheckpoints(Section):
    """what --restart goes on from; one is also written after the last step (may be absent)

    steps: after every so many steps (at least 1)
    minutes: when so much time has passed since the last one (min; positive)
    """
    steps: int | None
    minutes: float | str | None
    def __init__(self, *, steps: int | None = ..., minutes: float | str | None = ...) -> None: ...

class Output(Section):
    """what is written beside results.json

    vtu: write bulk.pvd and fractures.pvd for ParaView (default true)
    every: write them after every so many steps, and after the last (at least 1; default 1)
    error_estimate: estimate after every step how far stress, jumps and fluxes are off on this mesh: error_estimate in
        results.json, and fields; costs a pass over all cells and, for jumps, a linear solve per step (default false)
    time_unit: of times in tables of probes and in pictures ("s" | "min" | "h" | "d" | "year"; default s)
    checkpoints: what --restart goes on from; one is also written after the last step (may be absent)
    """
    vtu: bool | None
    every: int | None
    error_estimate: bool | None
    time_unit: Literal["s", "min", "h", "d", "year"] | None
    checkpoints: OutputCheckpoints | None
    def __init__(self, *, vtu: bool | None = ..., every: int | None = ..., error_estimate: bool | None = ..., time_unit: Literal["s", "min", "h", "d", "year"] | None = ..., checkpoints: OutputCheckpoints | None = ...) -> None: ...

class Stage(Section):
    """by names of your choice: what of the scene changes when, see docs/use/stages.md

    time: when it begins; a step ends there (s; required)
    without: paths of sections and entries that are no longer there: Boundary conditions > pull (default {})
    excavate: regions that are taken away: their walls are boundaries by the same names, and fractures end there
        (default {})
    backfill: regions that were taken away and are filled now, with the materials that "Regions" names: free of stress
        as they are placed (default {})
    release: time over which forces that are out of balance when the stage begins are let go, in proportion to the time;
        absent: they are in its first step (s; positive)
    sections: sections as they stand in the scene
    """
    time: float | str | None
    without: Sequence[str] | None
    excavate: Sequence[str] | None
    backfill: Sequence[str] | None
    release: float | str | None
    sections: dict[str, Any] | None
    def __init__(self, *, time: float | str | None = ..., without: Sequence[str] | None = ..., excavate: Sequence[str] | None = ..., backfill: Sequence[str] | None = ..., release: float | str | None = ..., sections: dict[str, Any] | None = ...) -> None: ...

class AccuracyQuantitie(Section):
    """by names of your choice: numbers and the errors they may have

    quantity: slip: the mean of the plastic slip over the area of fractures; opening: the mean of the normal jump;
        normal force: the integral of compression; shear force: the integral of the size of shear traction; reaction:
        the force that holds a boundary; stress: root of the integral of s : C^-1 s, twice the elastic energy; pressure:
        of a well, or the mean over fractures; flow: of fluid into the domain from a well or through a boundary; flux:
        root of the power that the flow of fluid dissipates; temperature: of what a well puts in or takes out, or the
        mean over fractures; heat flow: into the domain from a well or through a boundary ("slip" | "opening" | "normal
        force" | "shear force" | "reaction" | "stress" | "pressure" | "flow" | "flux" | "temperature" | "heat flow";
        required)
    fractures: over which it is taken together; absent: all (default {})
    boundary: of a reaction: where displacements are prescribed; of a flow: where its potential is (default "")
    well: of a pressure: with a rate; of a flow: with a pressure; of what that carries: any (default "")
    component: of a reaction ("x" | "y" | "z"; default x)
    relative: error by the value at the end of the run (between 1e-08 and 1)
    absolute: error; of slip in m, of opening in m, of normal force in N (2D: N/m), of shear force in N (2D: N/m), of
        reaction in N (2D: N/m), of stress in sqrt(J) (2D: sqrt(J/m)), of pressure in Pa, of flow in m^3/s (2D: m^2/s),
        of flux in sqrt(W) (2D: sqrt(W/m)), of temperature in K, of heat flow in W (2D: W/m) (m; positive)
    """
    quantity: Literal["slip", "opening", "normal force", "shear force", "reaction", "stress", "pressure", "flow", "flux", "temperature", "heat flow"] | None
    fractures: Sequence[str] | None
    boundary: str | None
    well: str | None
    component: Literal["x", "y", "z"] | None
    relative: float | str | None
    absolute: float | str | None
    def __init__(self, *, quantity: Literal["slip", "opening", "normal force", "shear force", "reaction", "stress", "pressure", "flow", "flux", "temperature", "heat flow"] | None = ..., fractures: Sequence[str] | None = ..., boundary: str | None = ..., well: str | None = ..., component: Literal["x", "y", "z"] | None = ..., relative: float | str | None = ..., absolute: float | str | None = ...) -> None: ...

class Accuracy(Section):
    """numbers that are to be reached with a given error, on meshes that the run refines (may be absent)

    cells: no mesh is to have more (at least 1; default 1000000)
    seconds: of the clock, after which no finer mesh is begun; absent: any (s; positive)
    memory: bytes of all ranks that no mesh is to need more of; absent: any (positive)
    quantities: by names of your choice: numbers and the errors they may have
    """
    cells: int | None
    seconds: float | str | None
    memory: float | str | None
    quantities: dict[str, AccuracyQuantitie] | None
    def __init__(self, *, cells: int | None = ..., seconds: float | str | None = ..., memory: float | str | None = ..., quantities: dict[str, AccuracyQuantitie] | None = ...) -> None: ...

class Sprekk(Section):
    """A scene.

    tables: piecewise linear functions that expressions call by name, e.g. ramp(t)
    expressions: what all other expressions may call by name, e.g. depth = 0.5 - y
    mesh_file: a mesh of gmsh, instead of the section Mesh (may be absent)
    mesh: a box with plane fractures
    materials: rock and joints, by names of your choice; those of the material library need no section
    bulk: the rock
    flow: a fluid that flows through the rock (may be absent)
    heat: heat that rock and fractures conduct and store and a fluid carries (may be absent)
    regions: what regions of the mesh have of their own, by their names
    fractures: a section for each fracture of the mesh that needs one
    boundary_conditions: by names of your choice; boundaries without one are free of traction
    probes: by names of your choice: what is written of each step as a table of its own
    time: steps
    solver: Newton's method
    output: what is written beside results.json
    stages: by names of your choice: what of the scene changes when, see docs/use/stages.md
    accuracy: numbers that are to be reached with a given error, on meshes that the run refines (may be absent)
    """
    tables: dict[str, Table] | None
    expressions: dict[str, Any] | None
    mesh_file: MeshFile | None
    mesh: Mesh | None
    materials: dict[str, Material] | None
    bulk: Bulk | None
    flow: Flow | None
    heat: Heat | None
    regions: dict[str, Region] | None
    fractures: dict[str, Fracture | str] | None
    boundary_conditions: dict[str, BoundaryCondition] | None
    probes: dict[str, Probe] | None
    time: Time | None
    solver: Solver | None
    output: Output | None
    stages: dict[str, Stage] | None
    accuracy: Accuracy | None
    def __init__(self, *, tables: dict[str, Table] | None = ..., expressions: dict[str, Any] | None = ..., mesh_file: MeshFile | None = ..., mesh: Mesh | None = ..., materials: dict[str, Material] | None = ..., bulk: Bulk | None = ..., flow: Flow | None = ..., heat: Heat | None = ..., regions: dict[str, Region] | None = ..., fractures: dict[str, Fracture | str] | None = ..., boundary_conditions: dict[str, BoundaryCondition] | None = ..., probes: dict[str, Probe] | None = ..., time: Time | None = ..., solver: Solver | None = ..., output: Output | None = ..., stages: dict[str, Stage] | None = ..., accuracy: Accuracy | None = ...) -> None: ...
