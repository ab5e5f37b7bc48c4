"""Runs a measurement and saves its table as a source of the pages of results.

    ./sprekk perf NAME [options of the measurement] --save[=FILE]

writes docs/results/FILE.csv, by default NAME.csv. The file begins with comments: command, commit of the program,
machine, date, load of the machine, results (the last lines of the measurement) and targets. If a measurement writes
several tables, the column "table" contains the name of each."""
import argparse
import csv
import datetime
import importlib
import os
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ("packages", "apps/sprekk", "xml", "cmake", "CMakeLists.txt")  # what results depend on
RESULT = re.compile(r"(?:[^\s=]+ )?(?:\w+=\S+(?: |$))+")


def output_of(command):
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT).stdout.strip()


def commit():
    last = output_of(["git", "log", "-1", "--format=%h", "--", *PROGRAM])
    changed = output_of(["git", "status", "--porcelain", "--", *PROGRAM])
    return (last or "unknown") + " with changes" * bool(changed)


def machine():
    def field(file, name):
        found = re.search(rf"^{name}\s*:\s*(.+)$", Path(file).read_text(), re.MULTILINE)
        return found[1].strip() if found else "unknown"
    cache = ROOT / "build/CMakeCache.txt"
    compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.+)$", cache.read_text() if cache.is_file() else "", re.MULTILINE)
    version = output_of([compiler[1], "--version"]).split("\n")[0] if compiler else "unknown compiler"
    memory = round(int(field("/proc/meminfo", "MemTotal").split()[0]) / 2**20)
    return f"{field('/proc/cpuinfo', 'model name')}, {os.cpu_count()} cores, {memory} GiB, {version}"


def load():
    others = os.getloadavg()[0]
    return "shared machine, " * (others >= 0.5) + f"{others:.1f} other processes at the start"


def targets(name, file):
    """Targets that perf/NAME/FILE.py declares, by the name of the result."""
    module = importlib.import_module(f"perf.{name}.{file}")
    declared = getattr(module, "ASKED", None) or getattr(module, "BOUNDS", {})
    return {key: bound[1] if isinstance(bound, tuple) else bound for key, bound in declared.items()} \
        if isinstance(declared, dict) else {}


def run(name, words, folder):
    """Lines with results; prints all lines as they come."""
    command = [sys.executable, "-B", "-u", str(ROOT / "perf"), name, *words, "--output", str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        lines = []
        for line in process.stdout:
            print(line, end="", flush=True)
            lines.append(line.strip())
    return process.returncode, [line for line in lines if RESULT.fullmatch(line)]


def rounded(text):
    """A decimal number with six digits; other text unchanged."""
    return f"{float(text):.6g}" if re.fullmatch(r"-?\d+\.\d+(?:e[-+]\d+)?", text) else text


def tables(folder, since):
    """Columns and rows of all tables that the measurement wrote."""
    files = [file for file in sorted(folder.glob("*.csv")) if file.stat().st_mtime >= since]
    rows = []
    for file in files:
        with open(file, newline="") as opened:
            for row in csv.DictReader(opened):
                row = {column: rounded(value) for column, value in row.items()}
                rows.append({"table": file.stem, **row} if len(files) > 1 else row)
    return list(dict.fromkeys(column for row in rows for column in row)), rows


def main(name, words):
    parser = argparse.ArgumentParser(prog=f"sprekk perf {name}", allow_abbrev=False, add_help=False)
    parser.add_argument("--save", nargs="?", const=name)
    parser.add_argument("--output", type=Path, default=Path(f"output/perf/{name}"))
    options, rest = parser.parse_known_args(words)
    if not re.fullmatch(r"[a-z]\w*", options.save or ""):
        parser.error(f'argument --save: "{options.save}" is no name of a file: use lower-case letters, digits and "_"')
    header = [("command", shlex.join(["./sprekk", "perf", name, *rest])),
              ("commit", commit()),
              ("machine", machine()),
              ("date", datetime.date.today().isoformat()),
              ("load", load())]
    declared = targets(name, "scale" if "--scale" in rest else name)
    since = time.time() - 0.1
    status, results = run(name, rest, options.output)
    columns, rows = tables(options.output, since)
    if not rows or status < 0:
        sys.exit(f"sprekk perf {name}: status {status}, and no table to save in {options.output}")
    header += [("result", line) for line in results]
    header += [("target", " ".join(f"{key}={value:g}" for key, value in declared.items()))]
    file = ROOT / f"docs/results/{options.save}.csv"
    with open(file, "w", newline="") as opened:
        opened.writelines(f"# {key}: {value}\n" for key, value in header if value)
        writer = csv.DictWriter(opened, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"saved as {file.relative_to(ROOT)}; ./sprekk perf pages updates the pages")
    return status
