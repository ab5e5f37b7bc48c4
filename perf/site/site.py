"""A site from its file of fractures to the report: mesh, injection and shut-in, 1 and 2 ranks, restart, heat doublet.

The scenes are injection.xml and doublet.xml in this folder. Seconds are CPU seconds of the phases of a run on one rank.
Those of mesh and report are seconds of the clock."""
import sys
import time
from statistics import median

from perf.common import options as common
from perf.common import table
from perf.common.program import ROOT, checked, mesh, run

FOLDER = ROOT / "perf/site"
COLUMNS = {"part": "", "cells": "d", "unknowns": "d", "steps": "d", "Newton": "g", "max": "d", "cuts": "d", "Krylov": "d", "seconds": ".1f", "s/step": ".1f", "MB": ".0f"}
PARTS = ("mesh", "injection", "ranks", "restart", "doublet", "report")
BOUNDS = {"mesh_s": 120, "krylov_max": 40, "newton_max": 12, "seconds_injection": 13 * 8, "seconds_doublet": 300, "report_s": 60}
SAME = 1e-6  # largest difference of slip and moment between ranks, and after a restart, over the largest value
QUICK_STEPS = {"injection": ("0.25 d", "0.5 d"), "doublet": ("30 d", "90 d")}
PHASES = ("mesh", "set-up", "set-up_of_the_solver", "time_steps", "output")
BEFORE = 6  # number of steps before the restart
LISTS = ("mean_slip", "moment")


def until(times):
    """Entries for steps that end at these times."""
    return [f"Time.schedule={{{', '.join(times)}}}", f"Time.end={times[-1]}"]


def entries(options, part, *more):
    """Entries of a run on the mesh of this measurement."""
    file = options.output / "mesh/site.msh"
    return [f"Mesh file.path={file}", *(until(QUICK_STEPS[part]) if options.quick else []), *options.set, *more]


def seconds(found):
    return found.time(*PHASES, clock="cpu_seconds")


def row(name, found):
    newton = found.newton or [0]
    return [name, found.cells, found.system if found.results.get("blocks") else 0, len(found.steps), median(newton), max(newton), found.cuts,
            found.maximum, seconds(found), seconds(found) / max(1, len(found.steps)), found.bytes[0] / 1e6]


def difference(one, other):
    """Largest difference of the lists of single fractures in the last step, over the largest value of each list."""
    worst = 0
    for name in LISTS:
        a, b = (found.steps[-1]["single_fractures"][name] for found in (one, other))
        largest = max(map(abs, a + b))
        worst = max(worst, max(abs(x - y) for x, y in zip(a, b)) / largest if largest else 0)
    return worst


class Site:
    def __init__(self, options):
        self.options, self.failures, self.total, self.runs = options, [], {}, {}
        self.printed = table.Table(COLUMNS, 24)

    def solve(self, name, part, ranks=1, more=(), words=(), clear=True):
        """Runs a scene; records the run and its failure."""
        found = run(self.options.binary, FOLDER / f"{part}.xml", self.options.output / name.replace(" ", "_"), entries(self.options, part, *more), ranks,
                    words=words, clear=clear)
        failure = [] if found.status == 0 else [f"{name}: {found.reason}"]
        self.failures += failure
        self.printed.add(row(name, found), failure)
        self.runs[name] = found
        return found

    def compare(self, name, with_):
        one, other = self.runs.get("injection"), with_
        if one is None or not one.steps or not other.steps:
            return
        worst = difference(one, other)
        print(f"{name}: largest difference of slip and moment {worst:.0e}")
        if not worst <= SAME:
            self.failures.append(f"{name}: slip or moment differ by {worst:.0e}, at most {SAME:g} required")

    def mesh(self):
        begin = time.monotonic()
        mesh(self.options.binary, FOLDER / "injection.xml", self.options.output / "mesh/site.msh", self.options.set)
        self.total["mesh_s"] = time.monotonic() - begin

    def injection(self):
        self.total["seconds_injection"] = seconds(self.solve("injection", "injection"))

    def ranks(self):
        self.compare("2 ranks", self.solve("injection on 2 ranks", "injection", 2))

    def restart(self):
        """Runs half of the steps and continues from the last checkpoint."""
        whole = self.runs.get("injection")
        if whole is None or len(whole.steps) <= BEFORE:
            return
        name = "restarted injection"
        self.solve(name, "injection", more=until([f"{step['time']} s" for step in whole.steps[:BEFORE]]))
        self.compare("restart", self.solve(name, "injection", words=["--restart"], clear=False))

    def doublet(self):
        self.total["seconds_doublet"] = seconds(self.solve("doublet", "doublet"))

    def report(self):
        folder = self.options.output / "injection"
        begin = time.monotonic()
        checked([sys.executable, "-B", ROOT / "apps/report", folder, "--output", folder / "report.html"])
        self.total["report_s"] = time.monotonic() - begin
        size = (folder / "report.html").stat().st_size / 1e6
        print(f"report: {self.total['report_s']:.0f} s, {size:.1f} MB")


def main(words):
    options = common.parser("site", __doc__, only="parts").parse_args(words)
    parts = common.matching(options, PARTS)
    if "mesh" not in parts and not (options.output / "mesh/site.msh").is_file():
        parts = ["mesh", *parts]
    site = Site(options)
    for part in parts:
        getattr(site, part)()
    runs = [found for found in site.runs.values() if found.steps]
    site.total |= {"failures": len(site.failures), "krylov_max": max((found.max_used for found in runs), default=0),
                   "newton_max": max((max(found.newton) for found in runs), default=0)}
    order = ("failures", "mesh_s", "krylov_max", "newton_max", "seconds_injection", "seconds_doublet", "report_s")
    total = {name: site.total[name] for name in order if name in site.total}
    bounds = {name: bound for name, bound in BOUNDS.items() if name in total} if not options.quick else {}
    return table.finish(options, site.printed, total, {name: ".0f" for name in total}, bounds, site.failures)
