"""Writes a report on a run as one self-contained HTML file. It contains the scene, checks, key figures, pictures, a 3D
view, convergence and timing.

DIR is the output directory of `sprekk run`. The report is DIR/report.html."""

import argparse
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(1, str(ROOT / "apps" / "plot"))

from read import PlotError  # noqa: E402


def arguments(words):
    parser = argparse.ArgumentParser(
        prog="sprekk report", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("directory", metavar="DIR", type=Path, help="output directory of a run")
    parser.add_argument("--output", type=Path, metavar="FILE", help="write the report there")
    parser.add_argument("--dpi", type=int, default=110, help="dots per inch of pictures (default: 110)")
    parser.add_argument("--viewer", type=Path, help=argparse.SUPPRESS)  # bundle of the 3D view, set by the launcher
    return parser.parse_args(words)


def progress(words):
    """Shows the present work on a terminal."""
    if sys.stderr.isatty():
        print(f"\r\033[K{words}", end="", file=sys.stderr, flush=True)


def pictures(directory, dpi, time):
    """Returns (name, PNG) of each picture of `sprekk plot`, (file name, text) of each table, and its messages."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, "-B", ROOT / "apps" / "plot", directory, "--output", folder, "--dpi", str(dpi), f"--time={time} s"],
            capture_output=True,
            text=True,
            stdin=subprocess.DEVNULL,
        )
        said = done.stderr.strip().replace("sprekk plot: ", "")
        if done.returncode:
            raise PlotError(said)
        files = [Path(line) for line in done.stdout.splitlines()]
        drawn = [(file.stem, file.read_bytes()) for file in files if file.suffix == ".png"]
        tables = [*(directory / name for name in ("events.csv", "growth.csv")), *(file for file in files if file.suffix == ".csv")]
        return drawn, [(file.name, file.read_text()) for file in tables if file.is_file()], said


def report(options):
    import checks
    import events
    import figures
    import page
    import read
    import scene
    import view

    directory = options.directory
    if not directory.is_dir():
        raise PlotError(f"{directory}: no such directory")
    file = options.output or directory / "report.html"
    if not file.parent.is_dir():
        raise PlotError(f"{file}: cannot be written: there is no folder {file.parent}")
    content = read.results(directory)
    dim = content.get("mesh", {}).get("dimension", 3)
    entries = scene.Scene(directory, ROOT / "docs/use/reference.md", dim)
    viewer = options.viewer.read_text() if options.viewer and options.viewer.is_file() else None
    written = [time for time, _ in read.written_steps(directory, "bulk")]
    time = figures.time_of_pictures(content, written)
    with ThreadPoolExecutor() as pool:  # the pictures are drawn by another process
        drawing = pool.submit(pictures, directory, options.dpi, time)
        found = events.of_run(directory, content)
        shown = view.of_run(directory, content, entries.entries, found, progress) if viewer else None
        progress("pictures")
        drawn, tables, said = drawing.result()
        if written and time != written[-1]:
            said = f"Pictures show the step with the largest slipping area; no face slips in the last one. {said}"
    html = page.of_run(
        directory.resolve().name,
        content,
        entries,
        figures.headline(content),
        checks.of_run(directory, content, entries),
        figures.of_run(content, entries.reference, found),
        tables,
        drawn,
        said,
        shown,
        viewer,
    )
    progress("")
    file.write_text(html, encoding="utf-8")
    return file


def main(words=None):
    options = arguments(words)
    try:
        print(report(options))
    except (PlotError, OSError) as error:
        print(f"sprekk report: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
