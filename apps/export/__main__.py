"""Exports the fractures of a run, with results as attributes, for geographic information systems, or a probe as a
station of the SEAS benchmarks.

DIR is the output directory of `sprekk run`. FILE is NAME.geojson or NAME.shp. In 2D each trace is a line. In 3D each
fracture is a polygon, or several polygons (one for each face) if it is not plane. Units are m and Pa; compression is
negative.

FILE is NAME.dat for a station, a probe at a point of a fracture, given by --station. Its outputs must contain
"plastic jump local" and "traction local"."""
import argparse
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(1, str(Path(__file__).resolve().parents[1] / "plot"))

from read import PlotError  # noqa: E402


def arguments(words):
    parser = argparse.ArgumentParser(
        prog="sprekk export", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("directory", metavar="DIR", type=Path, help="output directory of a run")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", required=True, help="NAME.geojson, NAME.shp or NAME.dat")
    parser.add_argument(
        "--time", type=float, metavar="T", help="the step written nearest to T, in s (default: the last)"
    )
    parser.add_argument(
        "--crs", metavar="EPSG:N", help="the metric coordinate system of the scene (default: a local one)"
    )
    parser.add_argument("--station", metavar="PROBE", help="name of the probe, for NAME.dat")
    parser.add_argument(
        "--header", metavar="KEY=VALUE", action="append", default=[], help="line of the header of NAME.dat (repeatable)"
    )
    return parser.parse_args(words)


def write_geojson(path, found, plane, crs):
    from features import as_geojson

    path.write_text(as_geojson(found, plane, crs), encoding="utf-8")


def geographic_library(path):
    """Returns GDAL's modules ogr and osr."""
    try:
        from osgeo import ogr, osr
    except ImportError:
        raise PlotError(f"{path}: this format requires GDAL for Python: apt-get install python3-gdal") from None
    ogr.UseExceptions()
    osr.UseExceptions()
    return ogr, osr


def metric_system(path, crs):
    """Returns the coordinate system of EPSG:N. Error if it is unknown or not in metres."""
    if not re.fullmatch(r"EPSG:\d{4,6}", crs):
        raise PlotError(f"--crs {crs}: is not a coordinate system, expected EPSG:NUMBER, such as EPSG:25832")
    _, osr = geographic_library(path)
    system = osr.SpatialReference()
    try:
        system.ImportFromEPSG(int(crs[5:]))
    except RuntimeError:
        raise PlotError(f"--crs {crs}: is unknown to GDAL, expected a system with metres, such as EPSG:25832") from None
    if not system.IsProjected() or abs(system.GetLinearUnits() - 1) > 1e-12:
        unit = "degrees" if system.IsGeographic() else system.GetLinearUnitsName()
        raise PlotError(f"--crs {crs}: {system.GetName()} is in {unit}, expected one with metres, such as EPSG:25832")
    return system


def write_shapefile(path, found, plane, crs):
    ogr, _ = geographic_library(path)
    system = metric_system(path, crs) if crs else None
    driver = ogr.GetDriverByName("ESRI Shapefile")
    source = driver.CreateDataSource(str(path))
    layer = source.CreateLayer(
        path.stem, system, ogr.wkbMultiLineString if plane else ogr.wkbMultiPolygon25D, ["ENCODING=UTF-8"]
    )
    for name in found[0].attributes:
        layer.CreateField(column(ogr, name, [one.attributes[name] for one in found]))
    for one in found:
        feature = ogr.Feature(layer.GetLayerDefn())
        for name, value in one.attributes.items():
            if value is not None:
                feature.SetField(name, value)
        feature.SetGeometry(geometry(ogr, one.shapes, plane))
        layer.CreateFeature(feature)


def column(ogr, name, values):
    """Returns the field definition of an attribute. Numbers have the largest fixed number of decimals that fits."""
    texts = any(isinstance(value, str) for value in values)
    definition = ogr.FieldDefn(name, ogr.OFTString if texts else ogr.OFTReal)
    if not texts:
        largest = max((abs(value) for value in values if value is not None), default=0)
        definition.SetWidth(24)
        definition.SetPrecision(max(min(15, 21 - len(str(int(largest)))), 0))
    return definition


def geometry(ogr, shapes, plane):
    """Returns one geometry of all shapes of a fracture."""
    whole = ogr.Geometry(ogr.wkbMultiLineString if plane else ogr.wkbMultiPolygon25D)
    for shape in shapes:
        points = ogr.Geometry(ogr.wkbLineString if plane else ogr.wkbLinearRing)
        for x in shape if plane else [*shape, shape[0]]:
            points.AddPoint_2D(*x[:2]) if plane else points.AddPoint(*x)
        part = points
        if not plane:
            part = ogr.Geometry(ogr.wkbPolygon25D)
            part.AddGeometry(points)
        whole.AddGeometry(part)
    return whole


SIDECARS = (".shx", ".dbf", ".prj", ".cpg")  # further files of a shapefile
WRITERS = {".geojson": write_geojson, ".json": write_geojson, ".shp": write_shapefile}


def export_station(options):
    """Writes the station file of a probe."""
    import stations

    if options.output.suffix.lower() != ".dat" or not options.station:
        raise PlotError(f"{options.output}: a station requires both a file NAME.dat and --station PROBE")
    put(lambda path, text: path.write_text(text), options.output,
        stations.of_probe(options.directory, options.station, options.header))


def export(options):
    folder = options.output.parent
    if not folder.is_dir():
        raise PlotError(f"{options.output}: cannot be written: there is no folder {folder}")
    if options.station or options.header or options.output.suffix.lower() == ".dat":
        export_station(options)
        return options.output
    import features

    write = WRITERS.get(options.output.suffix.lower())
    if write is None:
        raise PlotError(f"{options.output}: ends in none of {', '.join([*WRITERS, '.dat'])}")
    if options.crs:
        metric_system(options.output, options.crs)
    found, plane = features.of_run(options.directory, options.time)
    try:
        put(write, options.output, found, plane, options.crs)
    except OSError as error:
        raise PlotError(f"{options.output}: cannot be written: {error.strerror or error}") from None
    return options.output


def put(write, path, *content):
    """Writes all files to a temporary folder and then moves them, so that an error leaves no incomplete files."""
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        write(Path(scratch) / path.name, *content)
        for ending in SIDECARS if write is write_shapefile else ():
            path.with_suffix(ending).unlink(missing_ok=True)
        for file in sorted(Path(scratch).iterdir()):
            file.replace(path.parent / file.name)


def main(words=None):
    options = arguments(words)
    try:
        print(export(options))
    except (PlotError, OSError, RuntimeError) as error:  # RuntimeError: from GDAL
        print(f"sprekk export: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
