"""Fractures in files of geographic information systems and drawings, by GDAL: GeoJSON, shapefiles, GeoPackages, DXF."""
import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from shapes import Errors, NetworkError

DRIVERS = {".geojson": "GeoJSON", ".json": "GeoJSON", ".shp": "ESRI Shapefile", ".gpkg": "GPKG", ".dxf": "DXF"}
COMPANIONS = (".shx", ".dbf", ".prj", ".cpg")  # of a shapefile
METRES, NO_UNIT = "6", "0"  # $INSUNITS of a drawing
NAME, NUMBER = ("name",), ("id", "fid", "number")  # attributes, in any case of letters
OF_DRAWING = {"layer", "paperspace", "subclasses", "linetype", "entityhandle", "text"}  # that say nothing of a joint


@dataclass
class Outline:
    """A fracture of a file: corners of a line (n, 2) or a polygon (n, 3) in metres, and what the file says of it."""

    title: str  # in messages
    points: np.ndarray
    number: str
    name: str = ""
    properties: dict = field(default_factory=dict)  # texts of the other attributes


def is_exchange(path):
    return Path(path).suffix.lower() in DRIVERS


def files_of(path):
    """The file, and those beside it that belong to it."""
    beside = [Path(path).with_suffix(ending) for ending in COMPANIONS] if Path(path).suffix.lower() == ".shp" else []
    return [path, *(str(file) for file in beside if file.is_file())]


def library():
    try:
        from osgeo import gdal, ogr
    except ImportError:
        raise NetworkError("reading this needs GDAL for Python: apt-get install python3-gdal") from None
    gdal.UseExceptions()
    ogr.UseExceptions()
    return gdal, ogr


def refuse_degrees(path, layer):
    """Coordinates must be lengths in metres."""
    system = layer.GetSpatialRef()
    if Path(path).suffix.lower() in (".geojson", ".json"):
        members = json.loads(Path(path).read_text(encoding="utf-8-sig"))
        if members.get("crs", False) is None:  # a local system, as before RFC 7946
            return
        if "crs" not in members:
            raise NetworkError(
                f"{path}: names no coordinate system (\"crs\"), which means longitude and latitude in degrees "
                "(RFC 7946), and Sprekk needs metres; export it in a projected system such as UTM, or write "
                "\"crs\": null for local coordinates in metres",
                [path],
            )
    if system is None:
        return
    if system.IsGeographic():
        raise NetworkError(
            f"{path}: has longitudes and latitudes in degrees ({system.GetName()}), and Sprekk needs metres; "
            "export it in a projected system such as UTM",
            [path],
        )
    if abs(system.GetLinearUnits() - 1) > 1e-12:
        raise NetworkError(
            f"{path}: has coordinates in {system.GetLinearUnitsName()} ({system.GetName()}), and Sprekk needs "
            "metres; export it in a system with metres",
            [path],
        )


def refuse_other_units(path):
    """Of a drawing that says in which unit it is."""
    lines = [line.strip() for line in Path(path).read_text(encoding="latin-1").splitlines()]
    at = lines.index("$INSUNITS") if "$INSUNITS" in lines else len(lines)
    unit = lines[at + 2] if at + 2 < len(lines) else NO_UNIT
    if unit not in (METRES, NO_UNIT):
        raise NetworkError(
            f"{path}: is a drawing in the unit {unit} of DXF ($INSUNITS), expected {METRES}, "
            "metres; scale it, or set $INSUNITS to 6 if its lengths are in metres",
            [path],
        )


def parts(geometry, ogr):
    """The lines and polygons in a geometry; arcs as polylines."""
    geometry = geometry.GetLinearGeometry()
    kind = ogr.GT_Flatten(geometry.GetGeometryType())
    if kind in (ogr.wkbLineString, ogr.wkbPolygon, ogr.wkbTriangle):
        yield geometry, kind != ogr.wkbLineString
    elif kind != ogr.wkbPoint:
        for k in range(geometry.GetGeometryCount()):
            yield from parts(geometry.GetGeometryRef(k), ogr)


def corners(part, is_polygon, dim, place, errors):
    """Of one fracture, or None and an error."""
    if is_polygon and dim == 2:
        errors.append(f"{place}: is a polygon; in 2D fractures are lines")
        return None
    if is_polygon and part.GetGeometryCount() > 1:
        errors.append(f"{place}: is a polygon with holes; divide it into polygons without")
        return None
    ring = part.GetGeometryRef(0) if is_polygon else part
    points = np.array([ring.GetPoint(k) for k in range(ring.GetPointCount())]).reshape(-1, 3)
    if not np.isfinite(points).all():
        errors.append(f"{place}: has coordinates that are not finite")
        return None
    if dim == 2:
        points = points[:, :2]
    elif not part.Is3D():
        errors.append(f"{place}: has no z; in 3D fractures are polygons with x, y and z")
        return None
    elif (points[0] == points[-1]).all():
        points = points[:-1]
    elif not is_polygon:
        errors.append(f"{place}: is a line that is not closed; in 3D fractures are polygons, or closed lines")
        return None
    keep = np.append(True, np.any(np.diff(points, axis=0) != 0, axis=1))  # drawings repeat points
    if keep.sum() < dim:
        errors.append(f"{place}: has {keep.sum()} different points, needs {dim} at least")
        return None
    return points[keep]


def outlines(feature, k, dim, path, ogr, errors):
    """The fractures of the k-th feature; points and texts are none. Several parts are one fracture by their number."""
    texts = {
        feature.GetFieldDefnRef(i).GetName(): str(feature.GetField(i))
        for i in range(feature.GetFieldCount())
        if feature.IsFieldSetAndNotNull(i)
    }
    lower = {title.lower(): text for title, text in texts.items()}
    said = {
        "name": next((lower[title] for title in NAME if lower.get(title)), ""),
        "number": next((lower[title] for title in NUMBER if lower.get(title)), str(k)),
    }
    drawing = OF_DRAWING if Path(path).suffix.lower() == ".dxf" else ()
    properties = {title: text for title, text in texts.items() if title.lower() not in (*NAME, *NUMBER, *drawing)}
    place = f"{path}: feature {k}"
    geometry = feature.GetGeometryRef()
    if geometry is None or geometry.IsEmpty():
        errors.append(f"{place}: has no geometry")
        return
    for part, is_polygon in parts(geometry, ogr):
        points = corners(part, is_polygon, dim, place, errors)
        if points is not None:
            yield Outline(f"{said['name'] or said['number']} ({place})", points, **said, properties=properties)


def read(path, dim):
    """The fractures in a file; refuses it with a line for each thing that is wrong."""
    gdal, ogr = library()
    if not Path(path).is_file():
        raise NetworkError(
            f"{path}: cannot be read: " + ("is no file" if Path(path).exists() else "No such file or directory"), [path]
        )
    found, errors = [], []
    try:
        source = gdal.OpenEx(str(path), gdal.OF_VECTOR, allowed_drivers=[DRIVERS[Path(path).suffix.lower()]])
        if Path(path).suffix.lower() == ".dxf":
            refuse_other_units(path)
        k = 0
        for layer in (source.GetLayer(i) for i in range(source.GetLayerCount())):
            refuse_degrees(path, layer)
            for feature in layer:
                k += 1
                found += outlines(feature, k, dim, path, ogr, errors)
    except (RuntimeError, ValueError) as error:  # by GDAL and json
        raise NetworkError(f"{path}: cannot be read: {' '.join(str(error).split())}", [path]) from None
    if not errors and not found:
        errors.append(f"{path}: has no fracture")
    Errors(errors).throw([path])
    return found
