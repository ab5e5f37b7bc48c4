"""Draws the fractures of a network from statistics.

FILE contains the domain and, for each set, the intensity, the sizes, the directions, the pattern of centres and the
apertures. NAME.csv contains the fractures, and NAME.xml is a scene with them. The output compares the realised with the
requested statistics. Equal seeds give equal fractures. Fractures that are too close to others for a mesh are replaced.
See docs/use/network_statistics.md."""
import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(1, str(Path(__file__).resolve().parents[1] / "mesh"))

import files  # noqa: E402
import realised  # noqa: E402
from draw import Stream  # noqa: E402
from meshable import replace_conflicts  # noqa: E402
from shapes import NetworkError  # noqa: E402
from statistics_file import read_statistics  # noqa: E402


def arguments(words):
    parser = argparse.ArgumentParser(prog="sprekk network", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("statistics", metavar="FILE", help="statistics, in TOML")
    parser.add_argument("-o", "--output", type=Path, metavar="NAME", required=True,
                        help="write NAME.csv and NAME.xml, in an existing folder; existing files are an error")
    parser.add_argument("--seed", type=int, metavar="N", help="in place of the seed in FILE")
    parser.add_argument("--unchecked", action="store_true",
                        help="do not check distances of fractures, which takes long for thousands of fractures")
    parser.add_argument("--program", required=True, help=argparse.SUPPRESS)  # path of the program, set by the launcher
    return parser.parse_args(words)


def write(texts):
    """Writes {path: text}, all files or none. Existing files are errors."""
    for path in texts:
        if path.exists():
            raise NetworkError(f"{path}: the file exists; remove it, or choose another name", [str(path)])
    unfinished = {path: path.with_name(f"{path.name}.{os.getpid()}") for path in texts}
    try:
        for path, text in texts.items():
            unfinished[path].write_text(text)
        for path in texts:
            unfinished[path].replace(path)
    except OSError as error:
        raise NetworkError(f"{path}: cannot be written: {error.strerror}", [str(path)]) from None
    finally:
        for path in unfinished.values():
            path.unlink(missing_ok=True)


def make(options):
    """Writes the files and returns the output."""
    statistics = read_statistics(options.statistics)
    if options.seed is not None:
        if options.seed < 0:
            raise NetworkError(f"--seed: is {options.seed}, must be a whole number of at least 0", ["--seed"])
        statistics = replace(statistics, seed=options.seed)
    streams = [Stream(one, statistics, k) for k, one in enumerate(statistics.sets)]
    replaced = 0 if options.unchecked else replace_conflicts(options.program, statistics, streams)
    sets = [(stream.one, stream.fractures()) for stream in streams]
    table, scene = (Path(f"{options.output}{ending}") for ending in (".csv", ".xml"))
    write({table: files.table(sets, statistics.dim),
           scene: files.scene(statistics, table.name)})
    reported = [line for one, fractures in sets for line in realised.of_set(one, fractures, statistics)]
    reported += [f"replaced due to conflicts with other fractures: {replaced}"] if replaced else []
    return "\n".join([*reported, f"wrote {table} and {scene}"])


def main(words=None):
    options = arguments(words)
    try:
        print(make(options))
    except NetworkError as error:
        print(f"sprekk: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
