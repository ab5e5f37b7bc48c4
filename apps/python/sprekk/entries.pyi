# Printed by `./sprekk python -m sprekk.entries`.
from typing import Any, Literal, Sequence

class Section:
    def to_entries(self) -> dict[str, Any]: ...
    @classmethod
    def from_entries(cls, entries: dict[str, Any]) -> Any: ...

class Table(Section):
    """piecewise linear functions for use in expressions by name, e.g. ramp(t)

    arguments: arguments of the table, strictly increasing (required)
    values: values of the function at the arguments, with linear interpolation (required)
    """
    arguments: Sequence[float | str] | None
    values: Sequence[float | str] | None
    def __init__(self, *, arguments: Sequence[float | str] | None = ..., values: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkDomainFace(Section):
    """plane faces of a polyhedron, each a polygon

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkDomain(Section):
    """domain of the rock; a CSV of polygons may contain a box as domain in its first line (may be absent)

    sides: names of the sides of a polygon, the first from corner 0 to corner 1; sides with one name form one boundary;
        empty: side 1, side 2, ... (default {})
    lower_corner: lowest coordinates of a box, 2 or 3 (m; default {})
    upper_corner: highest coordinates of a box (m; default {})
    corners: corners of a polygon in 2D: x0, y0, x1, y1, ... (m; default {})
    faces: plane faces of a polyhedron, each a polygon
    """
    sides: Sequence[str] | None
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    corners: Sequence[float | str] | None
    faces: dict[str, MeshFileNetworkDomainFace] | None
    def __init__(self, *, sides: Sequence[str] | None = ..., lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., corners: Sequence[float | str] | None = ..., faces: dict[str, MeshFileNetworkDomainFace] | None = ...) -> None: ...

class MeshFileNetworkFractureLine(Section):
    """polylines in 2D

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkFracturePolygon(Section):
    """plane polygons in 3D, convex or not

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkFractureEllipse(Section):
    """ellipses and discs in 3D

    centre: centre of the ellipse (m; 3 elements; required)
    radii: half axes, the first along the rake; equal for a disc (m; positive; 2 elements; required)
    strike: strike angle, clockwise from north (y); the plane dips to the right of the strike (degree; default 0)
    dip: dip angle from the horizontal (degree; between 0 and 90; default 0)
    rake: rake angle of the first half axis in the plane, from the strike upwards (degree; default 0)
    """
    centre: Sequence[float | str] | None
    radii: Sequence[float | str] | None
    strike: float | str | None
    dip: float | str | None
    rake: float | str | None
    def __init__(self, *, centre: Sequence[float | str] | None = ..., radii: Sequence[float | str] | None = ..., strike: float | str | None = ..., dip: float | str | None = ..., rake: float | str | None = ...) -> None: ...

class MeshFileNetworkFractureRandom(Section):
    """random fractures by statistics (may be absent)

    number: number of fractures before clipping at the domain; the centres are uniformly distributed (between 1 and
        1000000; required)
    seed: seed of the random numbers; equal seeds give equal fractures (at least 0; default 1)
    shortest: minimum length (3D: diameter) of the fractures (m; positive; required)
    longest: maximum length (3D: diameter) of the fractures (m; positive; required)
    exponent: exponent a of the power law: the density of lengths L is proportional to L^-a; typical: 2 to 3 (default
        2.5)
    strike: mean strike; in 2D the mean direction of the fractures, clockwise from y (degree; default 0)
    dip: mean dip in 3D (degree; between 0 and 90; default 0)
    concentration: concentration kappa of the Fisher distribution of poles about the mean (in 2D the von Mises
        distribution of the doubled angle); 0: uniform directions; typical: 5 to 50 (between 0 and 1000000; default 0)
    corners: number of corners of the regular polygons in 3D (between 3 and 100; default 12)
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
    """sets of fractures by their names; the section Fractures assigns their joints

    file: file of the fractures, relative to the folder of the scene: CSV, .fab of FracMan, .geojson, .json, .shp, .gpkg
        or .dxf
    format: format of the file; points: id,x,y (3D: id,x,y,z), one point of the fracture id per line; lines:
        id,x0,y0,x1,y1; polygons: x0,y0,z0,x1,y1,z1,...; ellipses: cx,cy,cz,r1,r2,rake,strike,dip in degrees; fab:
        FracMan; absent: fab by the ending .fab, points by their columns, else lines in 2D and polygons in 3D ("points"
        | "lines" | "polygons" | "ellipses" | "fab")
    layers: layers with the fractures, in a drawing or a GeoPackage; empty: all layers (default {})
    unit: unit of the coordinates in the file, such as 1 mm; absent: 1 m (m; positive)
    lines: polylines in 2D
    polygons: plane polygons in 3D, convex or not
    ellipses: ellipses and discs in 3D
    random: random fractures by statistics (may be absent)
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
    """polylines in 2D

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkConstraintPolygon(Section):
    """plane polygons in 3D, convex or not

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkConstraintEllipse(Section):
    """ellipses and discs in 3D

    centre: centre of the ellipse (m; 3 elements; required)
    radii: half axes, the first along the rake; equal for a disc (m; positive; 2 elements; required)
    strike: strike angle, clockwise from north (y); the plane dips to the right of the strike (degree; default 0)
    dip: dip angle from the horizontal (degree; between 0 and 90; default 0)
    rake: rake angle of the first half axis in the plane, from the strike upwards (degree; default 0)
    """
    centre: Sequence[float | str] | None
    radii: Sequence[float | str] | None
    strike: float | str | None
    dip: float | str | None
    rake: float | str | None
    def __init__(self, *, centre: Sequence[float | str] | None = ..., radii: Sequence[float | str] | None = ..., strike: float | str | None = ..., dip: float | str | None = ..., rake: float | str | None = ...) -> None: ...

class MeshFileNetworkConstraintRandom(Section):
    """random fractures by statistics (may be absent)

    number: number of fractures before clipping at the domain; the centres are uniformly distributed (between 1 and
        1000000; required)
    seed: seed of the random numbers; equal seeds give equal fractures (at least 0; default 1)
    shortest: minimum length (3D: diameter) of the fractures (m; positive; required)
    longest: maximum length (3D: diameter) of the fractures (m; positive; required)
    exponent: exponent a of the power law: the density of lengths L is proportional to L^-a; typical: 2 to 3 (default
        2.5)
    strike: mean strike; in 2D the mean direction of the fractures, clockwise from y (degree; default 0)
    dip: mean dip in 3D (degree; between 0 and 90; default 0)
    concentration: concentration kappa of the Fisher distribution of poles about the mean (in 2D the von Mises
        distribution of the doubled angle); 0: uniform directions; typical: 5 to 50 (between 0 and 1000000; default 0)
    corners: number of corners of the regular polygons in 3D (between 3 and 100; default 12)
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
    """lines (2D) or surfaces (3D) that the mesh follows and that are no fractures

    file: file of the fractures, relative to the folder of the scene: CSV, .fab of FracMan, .geojson, .json, .shp, .gpkg
        or .dxf
    format: format of the file; points: id,x,y (3D: id,x,y,z), one point of the fracture id per line; lines:
        id,x0,y0,x1,y1; polygons: x0,y0,z0,x1,y1,z1,...; ellipses: cx,cy,cz,r1,r2,rake,strike,dip in degrees; fab:
        FracMan; absent: fab by the ending .fab, points by their columns, else lines in 2D and polygons in 3D ("points"
        | "lines" | "polygons" | "ellipses" | "fab")
    layers: layers with the fractures, in a drawing or a GeoPackage; empty: all layers (default {})
    unit: unit of the coordinates in the file, such as 1 mm; absent: 1 m (m; positive)
    lines: polylines in 2D
    polygons: plane polygons in 3D, convex or not
    ellipses: ellipses and discs in 3D
    random: random fractures by statistics (may be absent)
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
    """plane faces of a polyhedron, each a polygon

    points: coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D (m; required)
    """
    points: Sequence[float | str] | None
    def __init__(self, *, points: Sequence[float | str] | None = ...) -> None: ...

class MeshFileNetworkRegion(Section):
    """parts of the domain with their own material; the rest is "bulk"

    lower_corner: lowest coordinates of a box, 2 or 3 (m; default {})
    upper_corner: highest coordinates of a box (m; default {})
    corners: corners of a polygon in 2D: x0, y0, x1, y1, ... (m; default {})
    faces: plane faces of a polyhedron, each a polygon
    """
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    corners: Sequence[float | str] | None
    faces: dict[str, MeshFileNetworkRegionFace] | None
    def __init__(self, *, lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., corners: Sequence[float | str] | None = ..., faces: dict[str, MeshFileNetworkRegionFace] | None = ...) -> None: ...

class MeshFileNetwork(Section):
    """fracture network in place of a mesh file; `./sprekk mesh` and `./sprekk run` generate its mesh (may be absent)

    relative_size: ratio of the edge length of cells at a fracture to the length (3D: diameter) of the fracture
        (positive; default 0.1)
    size: maximum edge length of cells; absent: 1/10 of the diagonal of the domain (m; positive)
    size_at_tips: edge length of cells at fracture tips in the rock; absent: 1/20 (in 3D 1/2) of the edge length at the
        fracture (m; positive)
    size_at_intersections: edge length of cells at intersections of fractures; absent: the edge length at the fractures
        (m; positive)
    size_at_boundary: edge length of cells at the boundary of the domain; absent: no refinement at the boundary (m;
        positive)
    growth: growth of the edge length per distance from a place with a given size (positive; default 0.5)
    tolerance: distance below which parts of fractures are joined and reported: points and lines in 2D; in 3D corners of
        polygons, moved onto surfaces within their own plane; absent: 1e-6 of the diagonal of the domain (m; positive)
    minimum_distance: minimum distance between separate fractures, an error below; absent: 1e-4 of the diagonal of the
        domain (m; at least 0)
    minimum_angle: minimum angle between fractures at an intersection, an error below (degree; between 0 and 60; default
        2)
    most_cells: maximum number of cells, by an estimate before the generation of the mesh, an error above (at least 1;
        default 10000000)
    unusable_fractures: treatment of fractures outside of the domain, shorter than "tolerance" or "minimum distance", or
        without geometry in their file; refused: an error; left out: omitted and listed in the report ("refused" | "left
        out"; default refused)
    domain: domain of the rock; a CSV of polygons may contain a box as domain in its first line (may be absent)
    fractures: sets of fractures by their names; the section Fractures assigns their joints
    constraints: lines (2D) or surfaces (3D) that the mesh follows and that are no fractures
    regions: parts of the domain with their own material; the rest is "bulk"
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
    """physical groups of the fractures, by their names; the sets of a network need no section

    reference_normal: reference vector of the orientation: its product with the normal, from side - to side +, is
        positive
    swap_sides: exchange of side - and side + (default false)
    """
    reference_normal: Sequence[float | str] | None
    swap_sides: bool | None
    def __init__(self, *, reference_normal: Sequence[float | str] | None = ..., swap_sides: bool | None = ...) -> None: ...

class MeshFile(Section):
    """mesh file of gmsh or fracture network, in place of the section Mesh (may be absent)

    path: mesh file of gmsh, format 2.2 or 4.1, relative to the folder of the scene; required, except with a network
        under `./sprekk run` and `check` (default "")
    order: polynomial order of the node fields in each cell: 1 (linear) or 2 (quadratic); 2 adds mid-edge nodes to a
        file of order 1; absent: as in the file (between 1 and 2)
    tips: treatment of crack tips; enriched: node fields grow with the square root of the distance from the tip, by
        further unknowns at order 1, by quarter-point nodes at order 2 (Barsoum 1976); plain: no enrichment ("enriched"
        | "plain"; default enriched)
    periodic: pairs of periodic boundaries {a, b, c, d}: equal node fields on a and on its translate b, and on c and d
        (default {})
    refinements: number of uniform refinements, each into 4 (2D) or 8 (3D) cells per cell, by all ranks in parallel
        after the distribution of the mesh; for meshes larger than the memory of one rank (between 0 and 20; default 0)
    network: fracture network in place of a mesh file; `./sprekk mesh` and `./sprekk run` generate its mesh (may be
        absent)
    fractures: physical groups of the fractures, by their names; the sets of a network need no section
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
    """boxes of cells with their own material

    lower_corner: lowest coordinates before the rotation (m; required)
    upper_corner: highest coordinates before the rotation (m; required)
    """
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    def __init__(self, *, lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ...) -> None: ...

class MeshFracture(Section):
    """plane fractures along mesh planes

    lower_corner: lowest coordinates before the rotation, on mesh planes (m; required)
    upper_corner: highest coordinates before the rotation; equal to the lower corner in the direction of the normal and
        only there (m; required)
    reference_normal: reference vector of the orientation, which turns with the box: its product with the normal, from
        side - to side +, is positive; absent: the last nonzero component (z, y, x) of the rotated normal is positive
    swap_sides: exchange of side - and side + (default false)
    """
    lower_corner: Sequence[float | str] | None
    upper_corner: Sequence[float | str] | None
    reference_normal: Sequence[float | str] | None
    swap_sides: bool | None
    def __init__(self, *, lower_corner: Sequence[float | str] | None = ..., upper_corner: Sequence[float | str] | None = ..., reference_normal: Sequence[float | str] | None = ..., swap_sides: bool | None = ...) -> None: ...

class Mesh(Section):
    """a box with plane fractures

    cell: shape of the cells ("triangle" | "quadrilateral" | "tetrahedron" | "hexahedron"; required)
    lower_corner: lowest coordinates before the rotation; 2 or 3 elements, the dimension of the box (m; required)
    upper_corner: highest coordinates before the rotation (m; required)
    cells: number of squares or cubes per direction; a square contains 2 triangles, a cube 6 tetrahedra (at least 1;
        required)
    order: polynomial order of the node fields in each cell: 1 (linear) or 2 (quadratic) (between 1 and 2; default 1)
    tips: treatment of crack tips; enriched: node fields grow with the square root of the distance from the tip, by
        further unknowns at order 1, by quarter-point nodes at order 2 (Barsoum 1976); plain: no enrichment ("enriched"
        | "plain"; default enriched)
    rotation: rotation angle of the box, counter-clockwise about the origin (degree; between -360 and 360; default 0)
    rotation_axis: axis of the rotation in 3D, through the origin (3 elements; default {0, 0, 1})
    periodic: directions of periodicity (x, y, z before the rotation), with equal node fields on opposite sides (default
        {})
    refinements: number of uniform refinements, each into 4 (2D) or 8 (3D) cells per cell, by all ranks in parallel
        after the distribution of the mesh; for meshes larger than the memory of one rank (between 0 and 20; default 0)
    renumbering_seed: seed of a random order of nodes and cells; absent: regular order (at least 0)
    regions: boxes of cells with their own material
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
    """materials of rock and joints, by names of your choice; materials of the library need no section

    type: type of the material; elastic: rock; joint: the surface of a fracture ("elastic" | "joint"; required)
    source: origin of the values, such as a publication
    youngs_modulus: Young's modulus E; exactly two elastic constants are required; typical: 20e9 to 80e9 (material
        library) (Pa; positive)
    poissons_ratio: Poisson's ratio nu, an elastic constant; typical: 0.2 to 0.3 (material library) (greater than -1 and
        less than 0.5)
    shear_modulus: shear modulus G, an elastic constant; typical: 2e9 to 15e9 (material library) (Pa; positive)
    lames_first_parameter: Lame's first parameter lambda, an elastic constant (Pa)
    bulk_modulus: bulk modulus K, an elastic constant (Pa; positive)
    density: density of the rock, required with gravity; typical: 2100 to 2950 (material library) (kg/m^3; at least 0)
    permeability: permeability k of the rock, required with "Flow": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX,
        YY, ZZ, XY, YZ, XZ in 3D; typical: 1e-19 to 1e-16 (material library) (m^2; default {})
    porosity: fraction of the volume filled with fluid; typical: 0.001 to 0.1 (material library) (between 0 and 1;
        default 0)
    compressibility_of_pores: increase of the porosity per fluid pressure; in deformable rock at constant strain, (Biot
        coefficient - porosity)/bulk modulus of the grains; typical: 3e-12 to 1.5e-11 (material library) (Pa^-1; at
        least 0)
    biot_modulus: Biot modulus M, in place of the compressibility of pores: 1/M is the storage at constant strain, the
        compressibility of pores plus the porosity times the compressibility of the fluid (Coussy 2004) (Pa; positive or
        infinite)
    biot_coefficient: Biot coefficient alpha: with "Flow" total stress is the stress of the displacement minus alpha (p
        - initial pressure), and the pore volume grows by alpha div u (Biot 1941); typical: 0.35 to 0.8 (material
        library) (between 0 and 1; default 1)
    thermal_conductivity: thermal conductivity of the rock, required with "Heat": one value; XX, YY[, ZZ]; or XX, YY, XY
        in 2D, XX, YY, ZZ, XY, YZ, XZ in 3D; typical: 1.7 to 3.1 (material library) (W/(m*K); default {})
    volumetric_heat_capacity: volumetric heat capacity rho c of the rock with its pore fluid, density times specific
        heat capacity; 0: no heat storage; typical: 1.8e6 to 1.9e6 (material library) (J/(m^3*K); at least 0; default 0)
    thermal_expansion: linear thermal expansion coefficient alpha_T: the thermal stress is -3 K alpha_T (T - initial
        temperature); typical: 5e-6 to 1e-5 (K^-1; default 0)
    tangential_elasticity: law of the elastic part of the tangential jump; linear: proportional to the shear traction
        (12); power: with a stiffness that grows with a power of the compression ("linear" | "power"; default linear)
    tangential_stiffness: stiffness K_t of the elastic part of the tangential jump (12); infinite: purely plastic
        tangential jump; typical: 2e10 to 1e11 (material library); required with tangential elasticity "power" (Pa/m;
        positive or infinite; default infinite)
    shear_stiffening_stress: stress N_r in the tangential stiffness K_t (1 + N/N_r)^m under the compression N; entry of
        tangential elasticity "power", required (Pa; positive)
    shear_stiffening_exponent: exponent m of the tangential stiffness; entry of tangential elasticity "power", required
        (at least 0)
    friction: friction law, the bound on the shear traction; Coulomb: proportional to the compression (13); Barton-
        Choubey: peak strength of a rough joint, by JRC and JCS (Barton and Choubey 1977); mobilised Barton-Choubey:
        strength of a rough joint, by JRC and JCS, mobilised and worn by slip (Barton 1982); composed: sliding over
        asperities and shearing through them (Ladanyi and Archambault 1970); slip weakening: linear decrease with slip,
        from peak to residual; no slip: no slip of faces under compression, a purely elastic joint without further
        entries ("Coulomb" | "Barton-Choubey" | "mobilised Barton-Choubey" | "composed" | "slip weakening" | "no slip";
        default Coulomb)
    friction_coefficient: friction coefficient mu of the bound (13), in place of the angle; typical: 0.6 to 0.85
        (Byerlee 1978, material library); entry of friction "Coulomb", "slip weakening" (at least 0)
    friction_angle: friction angle atan(mu) (3), in place of the coefficient; typical: 30 to 40; entry of friction
        "Coulomb", "slip weakening" (degree; at least 0 and less than 90)
    joint_roughness_coefficient: joint roughness coefficient JRC, the decrease of the friction angle in degrees per
        decade of compression; from 0 (smooth) to 20 (rough) (Barton and Choubey 1977); entry of friction "Barton-
        Choubey", "mobilised Barton-Choubey", required; dilation "mobilised", required; closure "Bandis", required;
        hydraulic aperture "Barton", required (at least 0)
    joint_wall_strength: joint wall compressive strength JCS, the compression at which roughness has no effect; for
        fresh walls the uniaxial compressive strength of the rock (Barton and Choubey 1977); entry of friction "Barton-
        Choubey", "mobilised Barton-Choubey", required; dilation "mobilised", required; closure "Bandis", required (Pa;
        positive)
    residual_friction_angle: residual friction angle phi_r of the smooth joint; typical: 25 to 35; entry of friction
        "Barton-Choubey", "mobilised Barton-Choubey", "slip weakening"; required with friction "Barton-Choubey",
        "mobilised Barton-Choubey" (degree; at least 0 and less than 90)
    largest_friction_angle: largest friction angle of the rough joint, at small compression; entry of friction "Barton-
        Choubey", "mobilised Barton-Choubey" (degree; positive and less than 90; default 70)
    joint_length: length L_n of the joint, to which JRC and JCS of samples are scaled (Barton and Bandis 1982); absent:
        no scaling; entry of friction "Barton-Choubey", "mobilised Barton-Choubey"; dilation "mobilised" (m; positive)
    sample_length: length L_0 of the samples with the measured JRC and JCS; entry of friction "Barton-Choubey",
        "mobilised Barton-Choubey"; dilation "mobilised" (m; positive; default 0.1)
    peak_slip: slip delta_p at full mobilisation of the roughness; absent: from the joint length; typical: 1 % of the
        joint length (Barton and Choubey 1977); entry of friction "mobilised Barton-Choubey"; dilation "mobilised" (m;
        positive)
    basic_friction_coefficient: basic friction coefficient mu_b of the smooth rock, in place of the angle; entry of
        friction "composed" (at least 0)
    basic_friction_angle: basic friction angle atan(mu_b) of the smooth rock, in place of the coefficient; typical: 25
        to 35; entry of friction "composed" (degree; at least 0 and less than 90)
    asperity_angle: inclination psi_0 of the asperities; entry of friction "composed", required (degree; at least 0 and
        less than 90)
    asperity_friction_coefficient: additional friction coefficient mu_a of sheared asperities; entry of friction
        "composed", required (at least 0)
    transition_stress: transition stress N_T, the compression above which all asperities are sheared; entry of friction
        "composed", required (Pa; positive)
    transition_exponent: exponent K of the fraction of sheared asperities; 1.5 after Ladanyi and Archambault (1970);
        entry of friction "composed" (greater than 1; default 1.5)
    residual_friction_coefficient: residual friction coefficient mu_r at large slip, in place of the angle; entry of
        friction "slip weakening" (at least 0)
    weakening_distance: slip distance D over which friction falls to its residual value; entry of friction "slip
        weakening", required (m; positive)
    dilation: dilation law, the opening by slip; constant angle: proportional to the slip (14); mobilised: rough joint,
        by JRC and JCS, mobilised by slip; decaying angle: at an angle that decreases exponentially with the slip;
        limited: proportional to the slip, up to a largest opening ("constant angle" | "mobilised" | "decaying angle" |
        "limited"; default constant angle)
    dilation_angle: dilation angle theta: the gap grows by tan(theta)|u_t^p| (14); entry of dilation "constant angle",
        "decaying angle", "limited"; required with dilation "decaying angle", "limited" (degree; at least 0 and less
        than 90; default 0)
    asperity_damage_coefficient: damage coefficient M: the fraction 1/M of the roughness angle causes dilation; typical:
        1 at low, 2 at high stress; entry of dilation "mobilised" (positive; default 2)
    residual_dilation_angle: residual dilation angle at large slip; entry of dilation "decaying angle" (degree; at least
        0 and less than 90; default 0)
    dilation_decay_distance: slip distance D of the exponential decay of the dilation angle; entry of dilation "decaying
        angle", required (m; positive)
    largest_dilation: largest opening h by slip; entry of dilation "limited", required (m; positive)
    initial_gap: gap g0 of (14), without load and slip (m; default 0)
    closure: closure law, the normal closure under compression; Barton-Bandis: hyperbolic (14) (Bandis et al. 1983);
        Barton-Bandis with memory: hyperbolic, with a part that unloading does not recover; Bandis: hyperbolic, by JRC,
        JCS and aperture (Bandis et al. 1983); power: with a stiffness that grows with a power of the compression;
        linear: proportional to the traction ("Barton-Bandis" | "Barton-Bandis with memory" | "Bandis" | "power" |
        "linear"; default Barton-Bandis)
    maximum_closure: maximum closure Du in (14); 0: no closure; infinite or absent: linear closure, traction divided by
        K_n; 6e-5 for a fresh joint with JRC 10 and JCS 100 MPa (Bandis et al. 1983); entry of closure "Barton-Bandis",
        "Barton-Bandis with memory" (m; at least 0 or infinite)
    normal_stiffness: normal stiffness K_n at zero traction; absent: no closure; 2e10 for a fresh joint with JRC 10 and
        JCS 100 MPa (Bandis et al. 1983); entry of closure "Barton-Bandis", "Barton-Bandis with memory", "power",
        "linear"; required with closure "power", "linear" (Pa/m; positive)
    irrecoverable_part_of_closure: fraction r of the closure under the largest compression so far; entry of closure
        "Barton-Bandis with memory", required (at least 0 and less than 1)
    joint_aperture: mechanical aperture a of the unloaded joint; JRC/50 mm for fresh walls (Bandis et al. 1983); entry
        of closure "Bandis", required (m; positive)
    loading_cycle: loading cycle, from 1 (first loading) to 3 (after two cycles) (Bandis et al. 1983); entry of closure
        "Bandis" (between 1 and 3; default 1)
    stiffening_stress: stress N_r in the normal stiffness K_n (1 + N/N_r)^m under the compression N; entry of closure
        "power", required (Pa; positive)
    stiffening_exponent: exponent m of the normal stiffness; entry of closure "power", required (at least 0)
    bond: bond law, the cohesion and tensile strength in addition to friction; none: no tension, and no shear without
        compression; constant cohesion: shear strength of faces in contact, independent of slip, without tensile
        strength; linear softening: tensile and shear strength that decrease with opening and slip ("none" | "constant
        cohesion" | "linear softening"; default none)
    cohesion: cohesion c, the shear strength of the bond in addition to friction; entry of bond "constant cohesion",
        "linear softening", required (Pa; at least 0)
    opening_without_cohesion: opening o_0 at which the cohesion reaches zero, after a linear decrease; 0: sudden loss,
        possibly without equilibrium at incipient opening; entry of bond "constant cohesion" (m; at least 0; default 0)
    tensile_strength: tensile strength T of the intact bond; entry of bond "linear softening" (Pa; at least 0; default
        0)
    fracture_energy: fracture energy G_I, dissipated by opening until the bond is lost; entry of bond "linear softening"
        (J/m^2; positive)
    shear_fracture_energy: fracture energy G_II, dissipated by slip in addition to friction until the bond is lost;
        entry of bond "linear softening" (J/m^2; positive)
    damage: damage law, the wear of friction and dilation; none: no wear of friction and dilation; isotropic: wear by
        slip in any direction; anisotropic: wear by slip on the side of the present plastic jump (White 2014) ("none" |
        "isotropic" | "anisotropic"; default none)
    residual_part_of_friction: fraction of the friction bound that remains after complete damage; entry of damage
        "isotropic", "anisotropic" (between 0 and 1; default 0)
    damage_length_of_friction: length L of the exponential decay by damage; infinite: no damage; entry of damage
        "isotropic", "anisotropic" (m; positive or infinite; default infinite)
    residual_part_of_dilation: fraction of the opening by slip that remains after complete damage; entry of damage
        "isotropic", "anisotropic" (between 0 and 1; default 0)
    damage_length_of_dilation: length L of the exponential decay by damage; infinite: no damage; entry of damage
        "isotropic", "anisotropic" (m; positive or infinite; default infinite)
    damage_driver: driver of damage, per unit of slip; slip: slip itself; compression: slip times compression divided by
        the reference stress; frictional work: slip times shear traction divided by the reference stress ("slip" |
        "compression" | "frictional work"; default slip)
    reference_stress: reference stress, under which damage counts the slip itself; entry of damage driver "compression",
        "frictional work", required (Pa; positive)
    hydraulic_aperture: hydraulic aperture law, the aperture for flow in the fracture, with "Flow"; mechanical: equal to
        the mechanical aperture (smooth walls); Barton: smaller than the mechanical aperture, by JRC (rough walls)
        ("mechanical" | "Barton"; default mechanical)
    initial_aperture: aperture a0 of (15), without load and slip; typical: 1e-6 to 3e-4 (material library) (m; at least
        0; default 0)
    strength_reduction_factor: reduction factor F: friction and bond of the joint have 1/F of their strength (positive;
        default 1)
    residual_aperture: minimum hydraulic aperture, with "Flow" (m; at least 0; default 0)
    tangential_permeability: permeability k_t along the fracture, with "Flow"; absent: cubic law, (hydraulic
        aperture)^2/12 (m^2; positive)
    normal_permeability: permeability k_n across the fracture, with "Flow"; infinite: equal pressures in the fracture
        and in the adjacent rock (m^2; positive or infinite; default infinite)
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
    """initial stress of rock at rest under gravity, along the last coordinate (may be absent)

    surface: coordinate of the surface with zero vertical stress (m; required)
    horizontal_ratio: ratio of horizontal to vertical stress (at least 0; default 1)
    """
    surface: float | str | None
    horizontal_ratio: float | str | None
    def __init__(self, *, surface: float | str | None = ..., horizontal_ratio: float | str | None = ...) -> None: ...

class BulkInSituStress(Section):
    """initial stress by the vertical and two horizontal stresses, compression positive (may be absent)

    datum: vertical coordinate at zero depth, z in 3D and y in 2D (m; required)
    sv: vertical stress at the datum, compression positive (Pa; default 0)
    sv_gradient: increase of the vertical stress per metre of depth (Pa/m; default 0)
    shmax: largest horizontal stress at the datum, compression positive (Pa; default 0)
    shmax_gradient: increase of the largest horizontal stress per metre of depth (Pa/m; default 0)
    shmin: smallest horizontal stress at the datum, compression positive (Pa; default 0)
    shmin_gradient: increase of the smallest horizontal stress per metre of depth (Pa/m; default 0)
    azimuth: azimuth of SHmax, clockwise from north: in 3D x is east and y north; in a 2D section from west to east, 90
        (SHmax in the section) or 0 (across the section) (degree; default 90)
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
    """properties of the rock

    material: name of an elastic material of this scene or of the library (required)
    gravity: acceleration of gravity per direction, e.g. {0, 0, -9.81}; density times gravity adds to the body force
        (m/s^2; default {})
    rigid: switch for rigid rock, without mechanics and displacements (default false)
    body_force: force per volume and direction, a value or an expression of x, y, z, t each (N/m^3; default {})
    initial_stress: initial stress at zero displacement, tension positive: XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ
        in 3D; values or expressions of x, y, z (Pa; default {})
    release: begin and end of the release of unbalanced forces, set by "release" of a stage (s; default {})
    lithostatic_stress: initial stress of rock at rest under gravity, along the last coordinate (may be absent)
    in_situ_stress: initial stress by the vertical and two horizontal stresses, compression positive (may be absent)
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
    """wells by names of your choice

    points: points of the well: in 2D x, y of a line of length 1 across the plane; in 3D a polyline x0, y0, z0, x1, y1,
        z1, ... (m; required)
    radius: radius r_w of the borehole; typical: 0.05 to 0.15 (m; positive; required)
    skin: skin factor S: an additional pressure drop, as by a further factor exp(S) of distance (default 0)
    rate: injection rate, volume of fluid per time (2D: m^2/s), negative for extraction; a value or an expression of t
        (m^3/s)
    pressure: pressure in the well at its first point, a value or an expression of t (Pa)
    """
    points: Sequence[float | str] | None
    radius: float | str | None
    skin: float | str | None
    rate: float | str | None
    pressure: float | str | None
    def __init__(self, *, points: Sequence[float | str] | None = ..., radius: float | str | None = ..., skin: float | str | None = ..., rate: float | str | None = ..., pressure: float | str | None = ...) -> None: ...

class Flow(Section):
    """single-phase flow in rock and fractures (may be absent)

    rigid_rock: switch for flow in rigid rock, without displacements (default false)
    viscosity: dynamic viscosity mu of the fluid; the default is the value of water at 20 degrees C (Pa*s; positive;
        default 0.001)
    density: density rho_0 of the fluid at the reference pressure; with gravity in "Bulk" the fluid has weight (kg/m^3;
        at least 0; default 1000)
    compressibility: compressibility c of the fluid: its density is rho_0 exp(c (p - reference pressure)); about 4.5e-10
        for water (Pa^-1; at least 0; default 0)
    reference_pressure: pressure of the given density, with a compressibility; volumes of fluid refer to this pressure
        (Pa; default 0)
    source: volume of injected fluid per volume of rock and time, a value or an expression of x, y, z, t (s^-1; default
        0)
    initial_pressure: initial pressure of stored fluid, a value or an expression of x, y, z (Pa; default 0)
    scheme: flux scheme; rt0: mixed elements (Raviart and Thomas 1977); tpfa: two-point flux approximation; mimetic:
        mimetic differences; auto: rt0 on simplices, on other cells tpfa if permeability and cells are orthogonal, else
        mimetic ("auto" | "rt0" | "tpfa" | "mimetic"; default auto)
    wells: wells by names of your choice
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
    """injection temperatures by the names of wells of "Flow"; other wells inject fluid at the local temperature

    temperature: temperature of the injected fluid, a value or an expression of t (K; at least 0; required)
    """
    temperature: float | str | None
    def __init__(self, *, temperature: float | str | None = ...) -> None: ...

class Heat(Section):
    """heat conduction and storage in rock and fractures, and advection by the fluid (may be absent)

    source: power per volume of rock, a value or an expression of x, y, z, t (W/m^3; default 0)
    initial_temperature: initial temperature, required for heat storage, with zero thermal stress; a value or an
        expression of x, y, z (K)
    fluid_heat_capacity: volumetric heat capacity rho_0 c of the fluid at its reference pressure, required with "Flow";
        about 4.2e6 for water (J/(m^3*K); at least 0)
    fluid_thermal_expansion: volumetric thermal expansion coefficient of the fluid in pores and fractures; about 2e-4
        for water at 20 degrees C (K^-1; at least 0; default 0)
    fluid: dependence of density and viscosity of the fluid of "Flow" on the temperature T; constant: none; exponential:
        rho = rho_0 exp(c (p - p_0) - "fluid thermal expansion" (T - T_0)), mu = mu_0 exp(-"viscosity decay" (T - T_0));
        water: in the ratio of saturated liquid water (IAPWS) to the values at T_0, from 273.16 to 623.15 K ("constant"
        | "exponential" | "water"; default constant)
    viscosity_decay: decay coefficient of the viscosity of an exponential fluid; about 0.02 for water (K^-1; at least 0;
        default 0)
    reference_temperature: temperature T_0 of the density and viscosity in "Flow", unless the fluid is constant (K; at
        least 0; default 293.15)
    scheme: flux scheme of conduction; rt0: mixed elements (Raviart and Thomas 1977); tpfa: two-point flux
        approximation; mimetic: mimetic differences; auto: rt0 on simplices, on other cells tpfa if conductivity and
        cells are orthogonal, else mimetic ("auto" | "rt0" | "tpfa" | "mimetic"; default auto)
    advection: advection scheme between cells and along fractures; upwind: first order; second order: limited
        corrections once per step, with implicit Euler, for steps in which the fluid crosses at most about half a cell
        ("upwind" | "second order"; default upwind)
    heat_of_friction: heating of fractures by the power that their friction dissipates (default false)
    wells: injection temperatures by the names of wells of "Flow"; other wells inject fluid at the local temperature
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
    """properties of regions of the mesh, by their names

    material: name of an elastic material of this scene or of the library; absent: the material of "Bulk"
    excavated: excavation of the region: its walls form a boundary of the same name, and fractures end there (default
        false)
    initial_stress: initial stress at zero displacement, in place of the stress of "Bulk", tension positive: XX, YY, ZZ,
        XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; values or expressions of x, y, z (Pa; default {})
    pressure: prescribed fluid pressure in the cells of the region and in fractures inside, with "Flow": a value or an
        expression of x, y, z, t (Pa)
    temperature: prescribed temperature of the cells of the region, with "Heat": a value or an expression of x, y, z, t
        (K; at least 0)
    """
    material: str | None
    excavated: bool | None
    initial_stress: Sequence[float | str] | None
    pressure: float | str | None
    temperature: float | str | None
    def __init__(self, *, material: str | None = ..., excavated: bool | None = ..., initial_stress: Sequence[float | str] | None = ..., pressure: float | str | None = ..., temperature: float | str | None = ...) -> None: ...

class Fracture(Section):
    """properties of fractures of the mesh, by their names

    material: name of a joint material of this scene or of the library; the "material" of "Fractures" replaces a missing
        one (required)
    fluid_pressure: prescribed fluid pressure p in the fracture, a value or an expression of x, y, z, t; the traction on
        the rock is lambda - p n (Pa; default 0)
    plastic_jump: initial tangential plastic jump in the frame of the face: t in 2D, t1, t2 in 3D; values or expressions
        of x, y, z (m; default {})
    source: volume of injected fluid per area of the fracture and time, with "Flow"; a value or an expression of x, y,
        z, t (m/s; default 0)
    cuts: names of fractures that this fracture divides at their intersection, with "Flow": flow between the two parts
        crosses this fracture with its normal permeability (default {})
    """
    material: str | None
    fluid_pressure: float | str | None
    plastic_jump: Sequence[float | str] | None
    source: float | str | None
    cuts: Sequence[str] | None
    def __init__(self, *, material: str | None = ..., fluid_pressure: float | str | None = ..., plastic_jump: Sequence[float | str] | None = ..., source: float | str | None = ..., cuts: Sequence[str] | None = ...) -> None: ...

class BoundaryCondition(Section):
    """boundary conditions by names of your choice; boundaries without a condition are traction-free

    boundary: name of a boundary of the mesh; of a box: west, east, south, north, bottom, top (required)
    region: name of a region, which restricts the condition to faces of its cells
    fracture: name of a fracture, which restricts the condition to its end on the boundary, per aperture and length; not
        for displacements and tractions
    displacement: prescribed displacement per direction: a value, an expression of x, y, z, t, or free (m; finite or
        "free"; default {})
    lower_corner: lowest coordinates of a box, which restricts the "displacement" to nodes of the boundary inside, e.g.
        a point or an edge (m; default {})
    upper_corner: highest coordinates of the box; empty: the "lower corner", a point (m; default {})
    traction: force per area on the body, per direction a value or an expression of x, y, z, t (Pa; default {})
    confining_pressure: pressure on the body along the normal of its faces, a value or an expression of x, y, z, t; adds
        to a "traction" (Pa)
    foundation_stiffness: stiffness k_i per direction of springs between the boundary and rigid ground, with the
        traction -k_i u_i (Pa/m; at least 0; default {})
    pressure: prescribed fluid pressure, with "Flow": a value or an expression of x, y, z, t; without "fracture" and
        "conductance" it applies to rock and fractures; other conditions without "fracture" apply to rock only (Pa)
    flux: outflow of fluid, volume per area and time, with "Flow" (m/s)
    conductance: conductance c of the boundary: the flux is c (p - pressure), with the pressure beyond the boundary
        (m/(Pa*s); at least 0)
    temperature: prescribed temperature, with "Heat": a value or an expression of x, y, z, t (K; at least 0)
    heat_flux: outflow of heat per area and time, with "Heat" (W/m^2)
    heat_transfer_coefficient: heat transfer coefficient h: the flux is h (T - temperature), with the temperature beyond
        the boundary (W/(m^2*K); at least 0)
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
    """time series by names of your choice, each in its own table

    outputs: names of arrays of bulk.pvd or fractures.pvd, of results of fractures in results.json, or of sums over a
        boundary such as "reactions" (default {})
    point: coordinates of a point, for values at this point (m; default {})
    line: coordinates of the first and the last point of a line, for values along this line (m; default {})
    points: number of points of the line, at equal distances, including its ends (between 2 and 100000; default 11)
    boundary: name of a boundary, for the "value" over its faces
    region: name of a region, for the "value" over its cells
    fracture: name of a fracture or of a set of fractures, for the "value" over its faces
    value: kind of value over a boundary, a region or a fracture ("mean" | "maximum" | "minimum" | "integral"; default
        mean)
    well: name of a well, for all its results in results.json
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
    """time steps of the run

    start: time of the initial state (s; default 0)
    end: end time of the last step (s; default 1)
    steps: number of equal steps from start to end; absent: 1 (between 1 and 10000000)
    schedule: end times of all steps, increasing, in place of end and steps; with tolerance: required end times of steps
        (s)
    tolerance: relative time error of adaptive steps, in place of steps; see docs/use/time_and_solver.md (between 1e-08
        and 0.5)
    target_newton_iterations: target number of Newton iterations per adaptive step: more iterations shorten the steps,
        fewer lengthen them; the tolerance also limits the length (between 1 and 1000)
    first_step: length of the first adaptive step; absent: a fraction of the total time (s; positive)
    smallest_step: minimum length of adaptive steps, accepted with any error; absent: 1e-9 of the total time (s;
        positive)
    largest_step: maximum length of adaptive steps; absent: the total time (s; positive)
    scheme: scheme of time derivatives; implicit Euler: first order; BDF2: second order ("implicit Euler" | "BDF2";
        default implicit Euler)
    maximum_halvings: maximum number of bisections of a failed step before the run ends (between 0 and 20; default 6)
    tethers: proximal continuation after a failed Newton solve: springs between the sides of fractures, gradually
        relaxed to zero; only after three bisections if shorter steps are easier to solve (default true)
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

    type: method of linear solves; direct: MUMPS; iterative: Belos with multigrid; auto: direct up to the limits below
        ("auto" | "direct" | "iterative"; default auto)
    tolerance: relative residual of every linear solve (positive; default 1e-12)
    forcing: early end of iterative solves: while contact states change, if two accuracies a factor of 100 apart give
        the same states; afterwards, if more accuracy does not improve Newton's method (default true)
    direct_limit_2d: maximum number of unknowns for direct solves in 2D, with type auto (default 150000)
    direct_limit_3d: maximum number of unknowns for direct solves in 3D, with type auto (default 3000)
    reproducible: bitwise reproducibility of direct solves on several ranks, by factorisation on rank 0 alone; absent:
        true with checkpoints
    mumps: control parameters of MUMPS by the names ICNTL(i) and CNTL(i)
    belos: parameters of the library Belos; "Solver Type" selects another Krylov method
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
    """multigrid method of Sprekk, for type multigrid or auto (may be absent)

    degree: degree of the Chebyshev smoother (Adams et al. 2003); higher on the finest level in flat cells (at least 1;
        default 4)
    coarsest_level: number of unknowns up to which a level is solved directly (at least 1; default 300)
    least_of_a_rank: minimum mean number of matrix entries per rank; a smaller level moves to fewer ranks (at least 1;
        default 100000)
    """
    degree: int | None
    coarsest_level: int | None
    least_of_a_rank: int | None
    def __init__(self, *, degree: int | None = ..., coarsest_level: int | None = ..., least_of_a_rank: int | None = ...) -> None: ...

class SolverBlock(Section):
    """preconditioner of the block of this name, for the iterative solver

    type: preconditioner of the block or of the group that begins with it; auto: multigrid for unknowns with
        coordinates, MueLu for advected unknowns, else Gauss-Seidel, and direct for groups without their own method
        ("auto" | "multigrid" | "MueLu" | "Ifpack2" | "Gauss-Seidel" | "direct"; default auto)
    with_: name of the block whose group contains this block; empty: as the fields require (default "")
    multigrid: multigrid method of Sprekk, for type multigrid or auto (may be absent)
    muelu: parameters of MueLu in place of the defaults, for type MueLu
    ifpack2: parameters of Ifpack2, for type Ifpack2; "type" selects the method, e.g. ILUT
    """
    type: Literal["auto", "multigrid", "MueLu", "Ifpack2", "Gauss-Seidel", "direct"] | None
    with_: str | None
    multigrid: SolverBlockMultigrid | None
    muelu: dict[str, Any] | None
    ifpack2: dict[str, Any] | None
    def __init__(self, *, type: Literal["auto", "multigrid", "MueLu", "Ifpack2", "Gauss-Seidel", "direct"] | None = ..., with_: str | None = ..., multigrid: SolverBlockMultigrid | None = ..., muelu: dict[str, Any] | None = ..., ifpack2: dict[str, Any] | None = ...) -> None: ...

class SolverSweep(Section):
    """sweep over several groups of blocks

    type: type of sweep; forward: each group uses the corrections of earlier groups; symmetric: forward, then backward;
        diagonal: no corrections of other groups ("forward" | "symmetric" | "diagonal"; default forward)
    order: first blocks of all groups, in the order of the sweep; empty: the order of the fields (default {})
    """
    type: Literal["forward", "symmetric", "diagonal"] | None
    order: Sequence[str] | None
    def __init__(self, *, type: Literal["forward", "symmetric", "diagonal"] | None = ..., order: Sequence[str] | None = ...) -> None: ...

class Solver(Section):
    """parameters of Newton's method

    tolerance: tolerance of the convergence measures, relative to the loads (positive; default 1e-11)
    maximum_iterations: maximum number of Newton iterations per solve (at least 1; default 30)
    print: switch for output of every Newton iteration (default false)
    linear_solver: solver of the linear systems
    blocks: preconditioner of the block of this name, for the iterative solver
    sweep: sweep over several groups of blocks
    nox: parameters of the library NOX
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
    """checkpoints for --restart; another checkpoint follows the last step (may be absent)

    steps: interval of checkpoints in steps (at least 1)
    minutes: interval of checkpoints in wall-clock time (min; positive)
    """
    steps: int | None
    minutes: float | str | None
    def __init__(self, *, steps: int | None = ..., minutes: float | str | None = ...) -> None: ...

class Output(Section):
    """output in addition to results.json

    vtu: switch for bulk.pvd and fractures.pvd, for ParaView (default true)
    every: interval of bulk.pvd and fractures.pvd, in steps; the last step is always written (at least 1; default 1)
    error_estimate: estimate of the error due to the mesh after every step: error_estimate in results.json, and fields;
        costs a pass over all cells and, with fractures, a linear solve per step (default false)
    time_unit: unit of times in tables of probes and in pictures ("s" | "min" | "h" | "d" | "year"; default s)
    checkpoints: checkpoints for --restart; another checkpoint follows the last step (may be absent)
    """
    vtu: bool | None
    every: int | None
    error_estimate: bool | None
    time_unit: Literal["s", "min", "h", "d", "year"] | None
    checkpoints: OutputCheckpoints | None
    def __init__(self, *, vtu: bool | None = ..., every: int | None = ..., error_estimate: bool | None = ..., time_unit: Literal["s", "min", "h", "d", "year"] | None = ..., checkpoints: OutputCheckpoints | None = ...) -> None: ...

class Stage(Section):
    """changes of the scene during the run, by names of your choice; see docs/use/stages.md

    time: begin of the stage, at the end of a step (s; required)
    without: paths of sections and entries that the stage removes, e.g. Boundary conditions > pull (default {})
    excavate: names of regions that the stage excavates; their walls become boundaries of the same names, and fractures
        end there (default {})
    backfill: names of excavated regions that the stage fills with the materials of "Regions", unloaded when placed
        (default {})
    release: duration of the linear release of unbalanced forces at the begin of the stage; absent: release in its first
        step (s; positive)
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
    """quantities of interest with tolerances, by names of your choice

    quantity: quantity of interest; slip: mean plastic slip over the area of fractures; opening: mean normal jump over
        the area of fractures; normal force: integral of compression over fractures; shear force: integral of the
        magnitude of shear traction over fractures; reaction: force on a boundary with prescribed displacements; stress:
        square root of the integral of s : C^-1 s, twice the elastic energy; pressure: pressure of a well with a given
        rate, or mean over fractures; flow: flow of fluid into the domain from a well with a given pressure, or through
        a boundary with a prescribed pressure; flux: square root of the power dissipated by the flow of fluid;
        temperature: temperature of the fluid of a well, or mean over fractures; heat flow: heat flow into the domain
        from a well or through a boundary ("slip" | "opening" | "normal force" | "shear force" | "reaction" | "stress" |
        "pressure" | "flow" | "flux" | "temperature" | "heat flow"; required)
    fractures: names of the fractures of the quantity; empty: all fractures (default {})
    boundary: boundary of the quantity; its field must be prescribed there (default "")
    well: well of the quantity (default "")
    component: direction of a force ("x" | "y" | "z"; default x)
    relative: tolerance of the error relative to the value at the end of the run (between 1e-08 and 1)
    absolute: tolerance of the absolute error; slip in m, opening in m, normal force in N (2D: N/m), shear force in N
        (2D: N/m), reaction in N (2D: N/m), stress in sqrt(J) (2D: sqrt(J/m)), pressure in Pa, flow in m^3/s (2D:
        m^2/s), flux in sqrt(W) (2D: sqrt(W/m)), temperature in K, heat flow in W (2D: W/m) (m; positive)
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
    """quantities of interest with tolerances, on meshes that the run refines (may be absent)

    cells: maximum number of cells of a mesh (at least 1; default 1000000)
    seconds: wall-clock time after which no finer mesh begins; absent: no limit (s; positive)
    memory: maximum memory of all ranks for a mesh, in bytes; absent: no limit (positive)
    quantities: quantities of interest with tolerances, by names of your choice
    """
    cells: int | None
    seconds: float | str | None
    memory: float | str | None
    quantities: dict[str, AccuracyQuantitie] | None
    def __init__(self, *, cells: int | None = ..., seconds: float | str | None = ..., memory: float | str | None = ..., quantities: dict[str, AccuracyQuantitie] | None = ...) -> None: ...

class Sprekk(Section):
    """A scene.

    tables: piecewise linear functions for use in expressions by name, e.g. ramp(t)
    expressions: named expressions for use in all other expressions, e.g. depth = 0.5 - y
    mesh_file: mesh file of gmsh or fracture network, in place of the section Mesh (may be absent)
    mesh: a box with plane fractures
    materials: materials of rock and joints, by names of your choice; materials of the library need no section
    bulk: properties of the rock
    flow: single-phase flow in rock and fractures (may be absent)
    heat: heat conduction and storage in rock and fractures, and advection by the fluid (may be absent)
    regions: properties of regions of the mesh, by their names
    fractures: properties of fractures of the mesh, by their names
    boundary_conditions: boundary conditions by names of your choice; boundaries without a condition are traction-free
    probes: time series by names of your choice, each in its own table
    time: time steps of the run
    solver: parameters of Newton's method
    output: output in addition to results.json
    stages: changes of the scene during the run, by names of your choice; see docs/use/stages.md
    accuracy: quantities of interest with tolerances, on meshes that the run refines (may be absent)
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
