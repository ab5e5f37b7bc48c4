"""Point driver as a model: outputs for given entries of a scene, and the specification of these entries."""
import csv
import os
import re
import subprocess
import xml.etree.ElementTree as xml

import numpy as np
import units
from measured import FitError

ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_create_session_dirs": "0"}  # one rank needs no daemon


class Point:
    """Scene of the point driver."""

    def __init__(self, program, scene, overrides=()):
        self.program, self.scene, self.overrides = program, scene, list(overrides)
        self.reason = ""  # error of the last incomplete path
        try:
            self.root = xml.parse(scene).getroot()
        except (OSError, xml.ParseError) as error:
            raise FitError(f"{scene}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
        if self.section("Point") is None:
            raise FitError(f'{scene}: is not a scene of the point driver: it has no section "Point"')

    def call(self, *words):
        return subprocess.run([self.program, *words], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              env={**os.environ, **ALONE})

    def curve(self, settings):
        """Returns {output: values} of the computed part of the path, and whether it is complete."""
        sets = [*self.overrides, *(f"{path}={value:.17g}" for path, value in settings.items())]
        done = self.call("point", self.scene, *(word for entry in sets for word in ("--set", entry)))
        self.reason = done.stderr.strip() if done.returncode else ""
        rows = list(csv.reader(done.stdout.splitlines()))
        if len(rows) < 2:
            return {}, False
        return dict(zip(rows[0], np.array(rows[1:], dtype=float).T)), done.returncode == 0

    def section(self, *names):
        place = self.root
        for name in names:
            place = place.find(f"ParameterList[@name='{name}']") if place is not None else None
        return place

    def text(self, path):
        """Returns an entry of the overrides or the scene, or None."""
        for entry in reversed(self.overrides):
            if entry.partition("=")[0] == path:
                return entry.partition("=")[2]
        *names, name = path.split(".")
        place = self.section(*names)
        found = place.find(f"Parameter[@name='{name}']") if place is not None else None
        return None if found is None else found.get("value")

    def path_of(self, name):
        """Returns the path of an entry. A name without dots is an entry of the point's joint."""
        if "." in name:
            return name
        return f"Materials.{self.text('Point.material')}.{name}"


class Specification:
    """Entries with units, defaults and bounds, from the output of `sprekk reference`."""

    def __init__(self, point):
        self.sections, place = {}, None
        for line in point.call("reference").stdout.splitlines():
            if line.startswith("## "):
                place = self.sections.setdefault(line[3:].removeprefix("Sprekk > "), {})
            cells = [cell.strip() for cell in line.split("|")[1:-1]]
            if place is not None and len(cells) >= 6:
                place[cells[0]] = cells[2:5]

    def entry(self, path):
        """Returns (unit, default, allowed values)."""
        *names, name = path.split(".")
        section = "Materials > NAME" if names[:1] == ["Materials"] else " > ".join(names)
        known = self.sections.get(section)
        if known is None:
            raise FitError(f'"{path}": there is no section "{" > ".join(names)}" with entries to fit')
        if name not in known:
            raise FitError(f'"{path}": there is no entry "{name}"{did_you_mean(name, known)}')
        return known[name]


def did_you_mean(name, known):
    import difflib
    near = difflib.get_close_matches(name, known, 1)
    return f'. Did you mean "{near[0]}"?' if near else ""


def bounds(allowed):
    """Returns (low, high) of a text of the reference, e.g. `at least 0 and less than 90`."""
    number = r"(-?[\d.]+(?:e[-+]?\d+)?)"
    low, high = -np.inf, np.inf
    if allowed.startswith("positive"):
        low = 0.0
    if found := re.search(rf"between {number} and {number}", allowed):
        low, high = float(found[1]), float(found[2])
    if found := re.search(rf"(?:at least|greater than) {number}", allowed):
        low = float(found[1])
    if found := re.search(rf"(?:at most|less than) {number}", allowed):
        high = float(found[1])
    if found := re.search(rf"less than {number}", allowed):  # exclusive bound
        high -= 1e-9 * abs(high)
    return low, high


def start_of(point, path, unit, default, low, high):
    """Returns the value in the scene, the default, or the middle of finite bounds; otherwise None."""
    text = point.text(path)
    found = units.number(text if text is not None else default, unit)
    if found is not None:
        return found
    if text is None and np.isfinite(low) and np.isfinite(high):
        return float(np.sqrt(low * high)) if low > 0 else (low + high) / 2
    return None
