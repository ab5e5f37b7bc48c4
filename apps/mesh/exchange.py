"""Fractures in files of geographic information systems and drawings, by GDAL: GeoJSON, shapefiles, GeoPackages, DXF."""
import json
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from shapes import MAXIMUM, Errors, NetworkError, Unusable

DRIVERS = {".geojson": "GeoJSON", ".json": "GeoJSON", ".shp": "ESRI Shapefile", ".gpkg": "GPKG", ".dxf": "DXF"}
COMPANIONS = (".shx", ".dbf", ".prj", ".cpg")  # further files of a shapefile
METRES, NO_UNIT = "6", "0"  # codes of $INSUNITS in DXF
UNITS = {"1": "1 in", "2": "1 ft", "4": "1 mm", "5": "1 cm", "7": "1 km"}  # codes of other units
FACTORS = {"1": 0.0254, "2": 0.3048, "4": 1e-3, "5": 1e-2, "7": 1e3}  # in m
NAME, NUMBER = ("name",), ("id", "fid", "number")  # attributes, case-insensitive
OF_DRAWING = {"layer", "paperspace", "subclasses", "linetype", "entityhandle", "text"}  # no data of joints


@dataclass
class Outline:
    """Fracture of a file: corners of a line (n, 2) or a polygon (n, 3), with its attributes."""

    title: str  # for messages
    points: np.ndarray
    number: str
    name: str = ""
    properties: dict = field(default_factory=dict)  # text values of other attributes


def is_exchange(path):
    return Path(path).suffix.lower() in DRIVERS


def files_of(path):
    """Returns the path and the existing further files of a shapefile."""
    beside = [Path(path).with_suffix(ending) for ending in COMPANIONS] if Path(path).suffix.lower() == ".shp" else []
    return [path, *(str(file) for file in beside if file.is_file())]


def library():
    try:
        from osgeo import gdal, ogr, osr
    except ImportError:
        raise NetworkError("this format requires GDAL for Python: apt-get install python3-gdal") from None
    gdal.UseExceptions()
    ogr.UseExceptions()
    osr.UseExceptions()
    return gdal, ogr, osr


def reason(error, path):
    """Returns the message of an error of GDAL, without positions in its source code."""
    text = " ".join(str(error).split())
    at_line = re.search(r"error at line (\d+) of ", text)
    if at_line:
        return f"line {at_line[1]} is damaged, or the file ends there"
    if "not recognized as" in text:
        return f"is not in the format {DRIVERS[Path(path).suffix.lower()]}"
    return re.sub(r"\S+\.(?:c|cpp|h), ?\d+: ", "", text) or "is damaged, GDAL reports no reason"


def geojson(path):
    """Returns the members of a GeoJSON file. Checks geometries, which GDAL does not."""
    try:
        members = json.loads(Path(path).read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError:
        raise NetworkError(f"{path}: cannot be read: is not UTF-8 text", [path]) from None
    except ValueError as error:
        raise NetworkError(f"{path}: cannot be read: is not valid JSON: {error}", [path]) from None
    if not isinstance(members, dict) or not isinstance(members.get("features", []), list):
        raise NetworkError(
            f"{path}: cannot be read: is not GeoJSON, expected an object with a list of \"features\"", [path]
        )
    errors = []
    for k, feature in enumerate(members.get("features", [members]), 1):
        geometry = feature.get("geometry") if isinstance(feature, dict) else feature
        wrong = wrong_geometry(geometry)
        if wrong:
            errors.append(f"{path}: feature {k}: {wrong}")
    Errors(errors).throw([path])
    return members


GEOMETRIES = ("Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon")


def wrong_geometry(geometry):
    """Returns the error of a GeoJSON geometry, or None."""
    if geometry is None:
        return None
    if not isinstance(geometry, dict):
        return f"its geometry is {json.dumps(geometry)[:40]}, expected an object"
    if geometry.get("type") == "GeometryCollection":
        inner = geometry.get("geometries")
        return next(filter(None, map(wrong_geometry, inner)), None) if isinstance(inner, list) else "has no geometries"
    if geometry.get("type") not in GEOMETRIES:
        kind = json.dumps(geometry.get("type"))[:40]
        return f"has a geometry of the type {kind}, expected one of {', '.join(GEOMETRIES)}"
    return wrong_coordinates(geometry.get("coordinates"))


def wrong_coordinates(x):
    """Returns the error of a (nested) list of points, or None. A point is a list of numbers."""
    if not isinstance(x, list):
        return f"has the coordinates {json.dumps(x)[:40]}, expected a list"
    if x and not isinstance(x[0], list):
        wrong = [one for one in x if isinstance(one, bool) or not isinstance(one, (int, float))]
        if wrong:
            return f"has the coordinate {json.dumps(wrong[0])[:40]}, expected a number"
        return None if len(x) > 1 else f"has a point of {len(x)} coordinate, expected x and y"
    return next(filter(None, (wrong_coordinates(inner) for inner in x)), None)


def system_of(path, crs, osr):
    """Returns the coordinate system named in GeoJSON. Error for unknown names, for which GDAL would use WGS 84."""
    name = crs.get("properties", {}).get("name") if isinstance(crs, dict) and crs.get("type") == "name" else None
    if not isinstance(name, str):
        raise NetworkError(f"{path}: \"crs\" is {json.dumps(crs)[:60]}, expected null or "
                           "{\"type\": \"name\", \"properties\": {\"name\": \"EPSG:NUMBER\"}}", [path])
    system = osr.SpatialReference()
    try:
        if not re.match(r"(?i)epsg:|urn:|ogc:|esri:", name):
            raise RuntimeError
        system.SetFromUserInput(name)
    except RuntimeError:
        raise NetworkError(f"{path}: names the coordinate system \"{name}\", which GDAL does not know; expected one "
                           "with metres, such as \"EPSG:25832\"", [path]) from None
    return system


def are_degrees(layer):
    """Returns whether all coordinates of a layer could be longitudes and latitudes."""
    if layer.GetFeatureCount() == 0:
        return True
    west, east, south, north = layer.GetExtent()
    return -180 <= west and east <= 180 and -90 <= south and north <= 90


def refuse_degrees(path, layer, members, osr, has_unit=False):
    """Rejects coordinates in other units than metres. `members` are those of a GeoJSON file, else None.

    Without a coordinate system GeoJSON is in degrees, except for larger numbers or a given unit."""
    system = layer.GetSpatialRef()
    if members is not None:
        if "crs" not in members and (has_unit or not are_degrees(layer)):
            return
        if "crs" not in members:
            raise NetworkError(
                f"{path}: names no coordinate system (\"crs\"), which means longitude and latitude in degrees "
                "(RFC 7946), and Sprekk needs metres; export it in a projected system such as UTM, or write "
                "\"crs\": null, or give \"unit\" = \"1 m\" of its set, for local coordinates in metres",
                [path],
            )
        if members["crs"] is None:  # local system, valid before RFC 7946
            return
        system = system_of(path, members["crs"], osr)
    if system is None:
        return
    if system.IsGeographic():
        raise NetworkError(
            f"{path}: has longitudes and latitudes in degrees ({system.GetName()}), and Sprekk needs metres; "
            "export it in a projected system such as UTM",
            [path],
        )
    if system.IsGeocentric():
        raise NetworkError(
            f"{path}: has coordinates from the centre of the earth ({system.GetName()}); export it in a projected "
            "system such as UTM",
            [path],
        )
    if abs(system.GetLinearUnits() - 1) > 1e-12:
        raise NetworkError(
            f"{path}: has coordinates in {system.GetLinearUnitsName()} ({system.GetName()}), and Sprekk needs "
            "metres; export it in a system with metres",
            [path],
        )


def meets(extent, box):
    """Returns whether (west, east, south, north) meets a box (low, high)."""
    (west, east, south, north), (low, high) = extent, box
    return bool(west <= high[0] and east >= low[0] and south <= high[1] and north >= low[1])


def refuse_other_units(path, layer, box, left_out):
    """Rejects drawings with a unit other than metres.

    With a list `left_out` a drawing is in metres if it meets the box of the domain (low, high) only in metres; the list
    gets a line. Programs often write a unit without meaning."""
    lines = [line.strip() for line in Path(path).read_text(encoding="latin-1").splitlines()]
    at = lines.index("$INSUNITS") if "$INSUNITS" in lines else len(lines)
    unit = lines[at + 2] if at + 2 < len(lines) else NO_UNIT
    if unit not in (METRES, NO_UNIT):
        extent, factor = np.array(layer.GetExtent()), FACTORS.get(unit, 1.0)
        if left_out is not None and box is not None and meets(extent, box) and not meets(factor * extent, box):
            left_out.append(f"{path}: is in metres, not in the unit {unit} of DXF ($INSUNITS), since it meets the domain only in metres")
            return
        raise NetworkError(
            f"{path}: is a drawing in the unit {unit} of DXF ($INSUNITS), expected {METRES}, "
            f"metres; give \"unit\" of its set, as \"{UNITS.get(unit, '1 m')}\", or \"1 m\" if its lengths are in metres",
            [path],
        )


def parts(geometry, ogr):
    """Yields (geometry, True for a polygon) of all lines and polygons in a geometry. Arcs become polylines."""
    geometry = geometry.GetLinearGeometry()
    kind = ogr.GT_Flatten(geometry.GetGeometryType())
    if kind in (ogr.wkbLineString, ogr.wkbPolygon, ogr.wkbTriangle):
        yield geometry, kind != ogr.wkbLineString
    elif kind != ogr.wkbPoint:
        for k in range(geometry.GetGeometryCount()):
            yield from parts(geometry.GetGeometryRef(k), ogr)


def corners(part, is_polygon, dim, place, errors, unused):
    """Returns the corners of a fracture, or None. Appends to `errors`, or to `unused` for fractures without extent."""
    if is_polygon and dim == 2:
        unused.append(f"{place}: is a polygon; in 2D fractures are lines")
        return None
    if is_polygon and part.GetGeometryCount() > 1:
        errors.append(f"{place}: is a polygon with holes; divide it into polygons without holes")
        return None
    ring = part.GetGeometryRef(0) if is_polygon else part
    points = np.array([ring.GetPoint(k) for k in range(ring.GetPointCount())]).reshape(-1, 3)
    if not np.isfinite(points).all():
        errors.append(f"{place}: has coordinates that are not finite")
        return None
    if abs(points).max(initial=0) > MAXIMUM:
        largest = points.ravel()[abs(points).argmax()]
        errors.append(f"{place}: has the coordinate {largest:g} m; at most {MAXIMUM:g} m are allowed")
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
    keep = np.append(True, np.any(np.diff(points, axis=0) != 0, axis=1))  # drawings may repeat points
    if keep.sum() < dim:
        unused.append(f"{place}: has {keep.sum()} different points, needs at least {dim}")
        return None
    return points[keep]


def outlines(feature, k, dim, path, ogr, errors, unused):
    """Yields the fractures of the k-th feature, without points and texts. Parts with one number form one fracture."""
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
    place = f"{path}: feature {k}" + (f" of the layer \"{texts['Layer']}\"" if drawing and "Layer" in texts else "")
    geometry = feature.GetGeometryRef()
    if geometry is None or geometry.IsEmpty():
        unused.append(f"{place}: has no geometry")
        return
    for part, is_polygon in parts(geometry, ogr):
        points = corners(part, is_polygon, dim, place, errors, unused)
        if points is not None:
            yield Outline(f"{said['name'] or said['number']} ({place})", points, **said, properties=properties)


def layer_of(feature, layer, path):
    """Returns the name of the layer of a feature. In drawings it is an attribute."""
    return feature.GetField("Layer") if Path(path).suffix.lower() == ".dxf" else layer.GetName()


def check_layers(path, layers, known):
    missing = [name for name in layers if name not in known]
    if missing:
        raise NetworkError(
            f"{path}: has no layer \"{missing[0]}\"; its layers are " + ", ".join(f'"{name}"' for name in sorted(known)),
            [path],
        )


def throw(errors, unused, left_out, path):
    """Raises the errors of a file. Unusable fractures are appended to `left_out`, or are errors if it is None."""
    found = Errors(errors)
    for line in unused if left_out is None else ():
        with found.of_one():
            raise Unusable(line)
    if left_out is not None:
        left_out += [f"left out: {line}" for line in unused]
    found.throw([path])


def read(path, dim, layers=(), left_out=None, has_unit=False, box=None):
    """Returns the fractures in the given layers of a file; all layers by default.

    All errors of the file are raised together, see throw() for `left_out`. With `has_unit` the scene gives the unit
    of the coordinates. `box` (low, high) bounds the domain."""
    gdal, ogr, osr = library()
    if not Path(path).is_file():
        raise NetworkError(
            f"{path}: cannot be read: " + ("is no file" if Path(path).exists() else "No such file or directory"), [path]
        )
    found, errors, unused, known, k, ending = [], [], [], set(), 0, Path(path).suffix.lower()
    members = geojson(path) if DRIVERS[ending] == "GeoJSON" else None
    try:
        source = gdal.OpenEx(str(path), gdal.OF_VECTOR, allowed_drivers=[DRIVERS[ending]])
        if ending == ".dxf" and not has_unit:
            refuse_other_units(path, source.GetLayer(0), box, left_out)
        for layer in (source.GetLayer(i) for i in range(source.GetLayerCount())):
            refuse_degrees(path, layer, members, osr, has_unit)
            for feature in layer:
                k += 1
                known.add(layer_of(feature, layer, path))
                if not layers or layer_of(feature, layer, path) in layers:
                    found += outlines(feature, k, dim, path, ogr, errors, unused)
    except RuntimeError as error:  # raised by GDAL
        raise NetworkError(f"{path}: cannot be read: {reason(error, path)}", [path]) from None
    check_layers(path, layers, known)
    if not errors and not unused and not found:
        errors.append(f"{path}: has no fracture")
    throw(errors, unused, left_out, path)
    return found
