"""Description of a scene: entries of effective_input.xml that differ from defaults, with units of the reference."""
import re

import read
from numbers_in_words import in_unit


class Reference:
    """(unit, defaults) of entries in docs/use/reference.md, by section. NAME matches any name. An entry of several kinds of
    a section, such as the types of materials, may have several defaults.

    A meaning with `(2D: m^2/s)` gives the unit in 2D."""

    def __init__(self, path, dim=3):
        self.sections = {}
        section = {}
        for line in path.read_text().splitlines() if path.is_file() else []:
            if line.startswith("## "):
                section = self.sections.setdefault(tuple(line[3:].split(" > ")[1:]), {})
            elif line.startswith("| ") and not line.startswith("| name "):
                name, _, unit, default, *_, meaning = re.split(r"(?<!\\)\|", line.strip("| "))
                per_depth = re.findall(r"\(2D: (\S+)\)", meaning) if dim == 2 else []
                unit = per_depth[0] if len(per_depth) == 1 else unit.strip()
                section.setdefault(name.strip(), (unit, []))[1].append(default.strip())

    def entry(self, path, name):
        """Returns (unit, defaults) of an entry of a section, or ("", []) if it is unknown."""
        for pattern, section in self.sections.items():
            if len(pattern) == len(path) and all(p in ("NAME", q) for p, q in zip(pattern, path)) and name in section:
                return section[name]
        return "", []


def same(value, default):
    try:
        return float(value) == float(default)
    except (TypeError, ValueError):
        return value == default


class Scene:
    """Scene of a run. `entries` is a nested dict of texts."""

    def __init__(self, directory, reference, dim=3):
        self.entries = read.scene(directory)
        self.reference = Reference(reference, dim)

    def has(self, name):
        """Returns whether any section has a nonempty entry of this name."""
        return any(True for _ in read.entries(self.entries, name))

    def said(self, path, section):
        """Yields (entry, readable value) of entries that differ from defaults."""
        for name, value in section.items():
            unit, defaults = self.reference.entry(path, name)
            if not isinstance(value, dict) and value not in ("", "{}") and not any(same(value, one) for one in defaults):
                yield name, in_unit(value, unit)

    def blocks(self, path=(), section=None):
        """Returns (names of sections, path, entries) in the order of the file.

        Adjacent sections with equal entries are merged."""
        section = self.entries if section is None else section
        own = tuple(self.said(path, section))
        found = [[(path[-1],), path, own]] if own else []
        for name, inner in section.items():
            for block in self.blocks((*path, name), inner) if isinstance(inner, dict) else ():
                last = found[-1] if found else None
                if last and last[2] == block[2] and last[1][:-1] == block[1][:-1] and len(block[1]) > 1:
                    last[0] += block[0]
                else:
                    found.append(block)
        return found
