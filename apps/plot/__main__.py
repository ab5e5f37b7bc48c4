"""Draws results of Sprekk as PNG files.

PATH is the CSV file of `sprekk point`, or the output directory of `sprekk run`. A CSV file gives NAME.png in the same
folder. A directory gives these pictures, if the run contains the data:

  bulk.png         displacement and stress of the rock
  fractures.png    slip, opening, traction and contact state of fractures
  maps.png         slip tendency, slip and opening in space
  mohr.png         stress on faces, compared with the strength of the joints
  flow.png         pressure and velocity
  overview.png     slip and change of pressure of a network, in 2D
  growth.png       fractures that grow, by the time of their growth
  temperature.png  temperature and heat flux
  error.png        estimated error of one step
  loops.png        mean traction against mean jump of each fracture
  series.png       slip, opening, pressures and injected volume over time
  events.png       magnitudes of slip events over time, and the rate of injection of wells
  magnitudes.png   moment magnitudes of many slipping fractures, in 3D
  catalogue.png    number of events above a magnitude, of a catalogue by slip rates
  probe_NAME.png   each probe
  profiles_NAME.png  slip along the line of a probe with the slip rate
  phase_NAME.png   friction over the slip rate, of a probe with the slip rate at a point
  convergence.png  iterations and residuals of all steps

and, for fractures, the tables fractures_long.csv and fractures_wide.csv."""
import argparse
import io
import math
import re
import sys
from pathlib import Path

import read
from read import PlotError


def arguments(words):
    parser = argparse.ArgumentParser(prog="sprekk plot", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", metavar="PATH", help="CSV of a point, or directory of a run")
    parser.add_argument("--output", type=Path, metavar="DIR", help="write the pictures there")
    parser.add_argument("--time", metavar="T", help="draw the step written nearest to T, a number in the \"time unit\" of "
                        "the scene or with a unit, such as \"5 h\" (default: the last step)")
    parser.add_argument("--warp", type=float, metavar="FACTOR", help="factor on the displacement (default: a visible one)")
    parser.add_argument("--dpi", type=int, default=150, help="dots per inch (default: 150)")
    parser.add_argument("--whole", action="store_true", help="show the whole body: no cut, no zoom")
    parser.add_argument("--paraview", action="store_true",
                        help="write paraview.py instead, which ParaView opens with File > Load State")
    return parser.parse_args(words)


def of_csv(path):
    """Yields (name, figure)."""
    import laboratory
    import loops
    curves = laboratory.specimens(path)
    if curves:
        yield path.stem, laboratory.of_specimens(curves, path.stem)
        return
    columns, tangential = read.point_csv(path)
    yield path.stem, loops.of_point(columns, tangential, path.stem)


def seconds(text, clock):
    """Returns a time in s. A number without unit is in the unit of the clock, as in style.when."""
    from style import PREFIXES
    units = {name: factor for factor, name in PREFIXES["s"]} | {"year": 365.25 * 86400}
    words = re.fullmatch(r"\s*(\S*?)\s*([a-z]*)\s*", text)
    try:
        value = float(words[1])
        factor = units[words[2]] if words[2] else (clock or (1,))[0]
    except (TypeError, ValueError, KeyError):
        raise PlotError(f'--time: is "{text}", expected a number, or a number and one of {", ".join(units)}') from None
    if not math.isfinite(value):
        raise PlotError(f'--time: is "{text}", must be finite')
    return value * factor


def of_run(directory, options):
    """Yields (name, figure) of each picture with data in the run."""
    import bulk
    import convergence
    import error
    import events
    import flow
    import fractures
    import growth
    import loops
    import magnitudes
    import maps
    import mohr
    import overview
    import rates
    import series
    from style import when
    content, scene = read.results(directory), read.scene(directory)
    steps = content["steps"]
    clock = content.get("time_unit", {"name": "s"})
    clock = None if clock["name"] == "s" else (clock["seconds"], clock["name"])
    states = [step for step in steps if "fractures" in step]  # absent if the last step failed at once
    names = sorted(states[-1]["fractures"]) if states else []
    name = directory.resolve().name

    sizes = 0, 0  # reference values, m and Pa, for round-off
    bulk_steps, fracture_steps = (read.written_steps(directory, kind) for kind in ("bulk", "fractures"))
    wanted = None if options.time is None else seconds(options.time, clock)
    if bulk_steps:
        wanted = bulk_steps[-1][0] if wanted is None else wanted
        time, file = min(bulk_steps, key=lambda step: abs(step[0] - wanted))
        title = f"{name}, {when(time, clock)}"
        rock, joints = read.grid(file), None
        for file in [file for t, file in fracture_steps if t == time and names]:
            joints = read.grid(file)
        if joints is None and any(step["time"] == time and step["fractures"] for step in states):
            raise PlotError(f"{directory / 'fractures.pvd'}: has no step at t = {time:g} s, bulk.pvd has one; "
                            "run the scene again")
        cut = joints if joints and joints.GetNumberOfCells() else None
        wells = read.wells(scene, 2 if read.is_plane(rock) else 3)
        deforms = rock.GetPointData().HasArray("displacement")
        if deforms and cut and read.is_plane(rock) and (figure := overview.of_step(rock, joints, scene, title)):
            yield "overview", figure
        for picture, kind in ("flow", flow.FLUID), ("temperature", flow.HEAT):
            if rock.GetCellData().HasArray(kind.drive):
                initial = scene.get("Flow", {}).get("initial pressure") if kind is flow.FLUID else None
                yield picture, flow.of_step(rock, cut, title, options.whole, kind, initial, wells)
        if deforms:
            yield "bulk", bulk.of_step(rock, joints, title, options.warp, options.whole, growth.box_of(rock, joints, content, options.whole))
        if deforms and joints and joints.GetNumberOfCells() > 0:
            sizes = fractures.scales(rock, read.arrays(joints.GetCellData()))
            singles = content.get("single_fractures", [])
            yield "fractures", fractures.of_step(rock, joints, names, title, singles, options.whole, wells)
            yield "maps", maps.of_step(rock, joints, names, title, singles, options.whole, wells)
            yield "mohr", mohr.of_step(rock, joints, scene, title, content, time)
            figure = growth.of_run([step for step in fracture_steps if step[0] <= time], rock, joints, names, title, clock, content, options.whole, wells)
            if figure:
                yield "growth", figure
        for estimate in [step["error_estimate"] for step in states if step["time"] == time and "error_estimate" in step]:
            yield "error", error.of_step(rock, joints, estimate, title, options.whole)
    else:
        why = "no step of the run was completed" if not states else 'it contains no bulk.pvd; the scene\'s Output has "vtu" false, or it was removed'
        left_out("bulk.png or other picture of one step", directory, why)
    singles = [one["name"] for one in content.get("single_fractures", [])]
    if states and "mean_jump_local" in states[-1].get("single_fractures", {}):
        if len(states) > 1:
            yield "loops", loops.of_fractures(states, singles, name, *sizes, unloaded=loops.starts_unloaded(scene))
        else:
            left_out("loops.png", directory, "it contains one step, a loop requires two")
    start = float(scene.get("Time", {}).get("start", 0))
    dim = content.get("mesh", {}).get("dimension", 3)
    found = events.of_run(directory, content)
    made = [("series", series.of_run(states, singles, name, clock, start, dim, content.get("initial"))),
            ("events", magnitudes.over_time(found, steps, name, clock, start, dim)),
            ("catalogue", magnitudes.of_events(found, name)),
            ("magnitudes", magnitudes.of_step(states[-1], name) if states else None)]
    made += [(f"probe_{path.stem}", series.of_probe(path)) for path in sorted((directory / "probes").glob("*.csv"))]
    made += [found for path in sorted((directory / "probes").glob("*.csv")) for found in rates.of_probe(path)]
    yield from ((picture, figure) for picture, figure in made if figure)
    tolerance = scene.get("Solver", {}).get("tolerance")
    yield "convergence", convergence.of_run(steps, name, None if tolerance is None else float(tolerance))


def left_out(pictures, directory, why):
    print(f"sprekk plot: no {pictures} of {directory}: {why}", file=sys.stderr)


def plot(path, options):
    path = Path(path)
    if not path.exists():
        raise PlotError(f"{path}: no such file or directory")
    folder = options.output or (path if path.is_dir() else path.parent)
    if options.paraview:
        from paraview_state import state_of
        made = {"paraview.py": state_of(path).encode()}
    else:
        made = pictures(path, options)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in made.items():
        (folder / name).write_bytes(content)
        print(folder / name)


def pictures(path, options):
    """Returns {file name: bytes} of all pictures and tables, to be written together: an error leaves no files."""
    from style import save
    made = {}
    for name, figure in of_run(path, options) if path.is_dir() else of_csv(path):
        picture = io.BytesIO()
        save(figure, picture, options.dpi)
        made[f"{name}.png"] = picture.getvalue()
    if path.is_dir():
        import events
        made |= {name: table.encode() for name, table in events.tables(read.results(path)).items()}
    return made


def main(words=None):
    options = arguments(words)
    try:
        for path in options.paths:
            plot(path, options)
    except (PlotError, OSError) as error:
        print(f"sprekk plot: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
