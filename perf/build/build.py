"""CPU seconds of a build from an empty cache: of the program, of the tests, and of a new law from edit to result.

Copies the sources to OUTPUT/source and builds them there without a compiler cache. Each compilation is timed, and its
lines are counted: lines that the compiler reads after preprocessing, without empty ones, precompiled headers as well.
The law is that of docs/develop/add_a_law.md. Figures are CPU time of all processes of a build, which other work on the
machine raises a little. Wall time is printed as well."""
import csv
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from perf.common import options as common
from perf.common.program import ROOT, cpu_seconds

LAUNCHER = "--compile"  # perf build --compile LOG COMMAND... runs the command and appends its CPU seconds to LOG
PAGE, SCENE = "docs/develop/add_a_law.md", "xml/point/power_joint.xml"
MAX_MINUTES = {"program": 10, "tests": 12, "law": 2}


def compile_and_log(log, *command):
    begin = cpu_seconds()
    status = subprocess.run(command).returncode
    if "-o" in command:
        with open(log, "a") as file:
            file.write(f"{cpu_seconds() - begin:.2f} {command[command.index('-o') + 1]}\n")
    return status


class Build:
    """Build tree with its own copy of the sources."""

    def __init__(self, options):
        self.source, self.tree, self.log = (options.output / name for name in ("source", "tree", "compilations.txt"))
        self.jobs = options.jobs
        for folder in (self.source, self.tree):
            shutil.rmtree(folder, ignore_errors=True)
        self.log.unlink(missing_ok=True)
        files = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                               stdout=subprocess.PIPE, text=True).stdout.splitlines()
        for name in filter(lambda name: (ROOT / name).is_file(), files):
            (self.source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, self.source / name)
        launcher = [sys.executable, "-B", str(ROOT / "perf"), "build", LAUNCHER, str(self.log)]
        self.run("cmake", "-S", self.source, "-B", self.tree, "-G", "Ninja",
                 f"-DCMAKE_CXX_COMPILER_LAUNCHER={';'.join(launcher)}")
        self.log.unlink(missing_ok=True)  # compiler checks

    def run(self, *command):
        """Runs a command; returns its CPU and wall seconds. Exits if it fails."""
        cpu, wall = cpu_seconds(), time.monotonic()
        done = subprocess.run([str(word) for word in command], cwd=self.source, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit(f"build: {shlex.join(map(str, command))} ended with status {done.returncode}\n{done.stdout[-5000:]}")
        return cpu_seconds() - cpu, time.monotonic() - wall

    def ninja(self, target):
        return self.run("ninja", "-C", self.tree, "-j", self.jobs, target)

    def law(self):
        """Applies the patch of the page, builds the program and runs the scene of the new law; returns CPU and
        wall seconds."""
        text = (self.source / PAGE).read_text()
        change = self.source / "page.diff"
        change.write_text(re.search(r"^```diff\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)[1])
        self.run("patch", "-p1", "--fuzz=0", "-i", change)
        built = self.ninja("sprekk_app")
        ran = self.run(self.tree / "apps/sprekk/sprekk", "point", SCENE)
        return [a + b for a, b in zip(built, ran)]

    def compilations(self):
        """Compilations since the last call, {object file: CPU seconds}."""
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        self.log.unlink(missing_ok=True)
        return {name: float(seconds) for seconds, name in (line.split(maxsplit=1) for line in lines)}


def count_lines(build, objects):
    """Number of lines after preprocessing, {object file: lines}."""
    commands = json.loads(subprocess.run(["ninja", "-C", str(build.tree), "-t", "compdb"], check=True,
                                         stdout=subprocess.PIPE, text=True).stdout)
    of = {entry["output"]: entry["command"] for entry in commands}
    plain = {}  # copies of precompiled headers, without the compiled form next to them
    for k, header in enumerate(build.tree.rglob("cmake_pch.hxx")):
        plain[str(header)] = str(build.tree / f"plain_{k}.hpp")
        shutil.copy(header, plain[str(header)])

    def lines(name):
        words = shlex.split(of[name].split("&&")[0])
        words = words[words.index(LAUNCHER) + 2:]
        drop = {i + k for i, word in enumerate(words) for k in (0, 1) if word in ("-o", "-MF", "-MT")}
        words = [word for i, word in enumerate(words) if i not in drop and word not in ("-c", "-MD", "-fpch-preprocess")]
        if "-include" in words:
            at = words.index("-include") + 1
            words[at] = plain.get(words[at], words[at])
        done = subprocess.run([*words, "-E", "-P"], cwd=build.tree, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        return sum(1 for line in done.stdout.splitlines() if line.strip())

    with ThreadPoolExecutor(build.jobs) as pool:
        return dict(zip(objects, pool.map(lines, objects)))


def target_of(name):
    """Folder of the object file, up to the package, the program or the tests of a subject."""
    parts = Path(name.split("CMakeFiles")[0]).parts
    return "/".join(parts[:3]) or "."


def report(what, seconds, lines, cpu, wall, table):
    """Prints targets and the ten most expensive files of a build."""
    print(f"\n{what}: {cpu / 60:.2f} CPU minutes, {wall / 60:.2f} minutes, {len(seconds)} compilations, "
          f"{sum(lines.values()) / 1e6:.2f} million preprocessed lines")
    targets = {}
    for name, used in seconds.items():
        n, total, read = targets.get(target_of(name), (0, 0, 0))
        targets[target_of(name)] = n + 1, total + used, read + lines[name]
    print(f"{'target':32} {'files':>6} {'CPU s':>8} {'lines':>10}")
    for name, (n, total, read) in sorted(targets.items(), key=lambda item: -item[1][1]):
        print(f"{name:32} {n:6} {total:8.1f} {read:10}")
        table.writerow([what, name, "", n, f"{total:.2f}", read])
    print(f"{'maximum expensive file':64} {'CPU s':>8} {'lines':>10}")
    for name in sorted(seconds, key=seconds.get, reverse=True)[:10]:
        short = re.sub(r"CMakeFiles/[^/]+\.dir/", "", name).removesuffix(".o")
        print(f"{short:64} {seconds[name]:8.1f} {lines[name]:10}")
        table.writerow([what, target_of(name), short, 1, f"{seconds[name]:.2f}", lines[name]])


def main(words):
    if words[:1] == [LAUNCHER]:
        return compile_and_log(*words[1:])
    parser = common.parser("build", __doc__, None, None, sets=False)
    parser.add_argument("--only", choices=["program", "tests", "law"], help="one figure; the others are left out")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilations at a time")
    options = parser.parse_args(words)
    build = Build(options)
    figures = {}
    with open(options.output / "build.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["build", "target", "file", "files", "CPU s", "preprocessed lines"])
        for what, work in (("program", lambda: build.ninja("sprekk_app")), ("tests", lambda: build.ninja("all")),
                           ("law", build.law)):
            cpu, wall = work()  # each build continues the previous one
            seconds = build.compilations()
            if options.only not in (None, what):
                continue
            report(what, seconds, count_lines(build, seconds), cpu, wall, table)
            figures[what] = cpu / 60
            if options.only == what:
                break
    print(" ".join(f"{what}_cpu_min={minutes:.2f}" for what, minutes in figures.items()))
    return any(minutes > MAX_MINUTES[what] for what, minutes in figures.items())
