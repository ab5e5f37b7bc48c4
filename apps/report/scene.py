"""A scene in words: what its effective_input.xml holds that is not a default, with units of the reference."""
import re

import read
from numbers_in_words import in_unit


class Reference:
    """(unit, default) of entries, as docs/use/reference.md lists them by section; NAME stands for any name. A meaning with
    `(2D: m^2/s)` has the unit of that dimension."""

    def __init__(self, path, dim=3):
        self.sections = {}
        section = {}
        for line in path.read_text().splitlines() if path.is_file() else []:
            if line.startswith("## "):
                section = self.sections.setdefault(tuple(line[3:].split(" > ")[1:]), {})
            elif line.startswith("| ") and not line.startswith("| name "):
                name, _, unit, default, *_, meaning = re.split(r"(?<!\\)\|", line.strip("| "))
                per_depth = re.findall(r"\(2D: (\S+)\)", meaning) if dim == 2 else []
                section[name.strip()] = per_depth[0] if len(per_depth) == 1 else unit.strip(), default.strip()

    def entry(self, path, name):
        """(unit, default) of an entry of a section; of an unknown one nothing."""
        for pattern, section in self.sections.items():
            if len(pattern) == len(path) and all(p in ("NAME", q) for p, q in zip(pattern, path)) and name in section:
                return section[name]
        return "", None


def same(value, default):
    try:
        return float(value) == float(default)
    except (TypeError, ValueError):
        return value == default or (value in ("", "{}") and default in ("{}", '""', "absent"))


class Scene:
    """The scene of a run: .entries is a dictionary of texts and of dictionaries."""

    def __init__(self, directory, reference, dim=3):
        self.entries = read.scene(directory)
        self.reference = Reference(reference, dim)

    def has(self, name):
        """Whether some section has an entry of this name that is not empty."""
        return any(True for _ in read.entries(self.entries, name))

    def said(self, path, section):
        """(entry, value in words) of what is no default."""
        for name, value in section.items():
            unit, default = self.reference.entry(path, name)
            if not isinstance(value, dict) and not same(value, default):
                yield name, in_unit(value, unit)

    def blocks(self, path=(), section=None):
        """(names of sections, entries) in the order of the file; sections beside each other that say the same are
        one."""
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
