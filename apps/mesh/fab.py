"""Fractures in FracMan's text format .fab, with x to the east, y to the north and z upwards."""
import numpy as np
from shapes import NetworkError
from tables import Row, Table, complete, numbers
from text_file import read_lines

METRES = ("m", "meter", "meters", "metre", "metres")
ENTRIES = {"format": ("ascii",), "length_unit": METRES, "xaxis": ("east",)}  # allowed values in the header
COUNTS = {"FRACTURE": "No_Fractures", "TESSFRACTURE": "No_TessFractures"}
HEAD = {"FRACTURE": "the number of a fracture and the number of its corners",
        "TESSFRACTURE": "the numbers of a fracture, its nodes, its facets and its set"}


class Section:
    """Lines between BEGIN NAME and END NAME of a file, numbered from 0."""

    def __init__(self, path, lines, name, begin):
        self.path, self.lines, self.name, self.at = path, lines, name, begin + 1
        ends = (k for k in range(begin + 1, len(lines)) if lines[k].split()[:2] == ["END", name])
        self.end = next(ends, None)
        if self.end is None:
            raise NetworkError(f"{path}: has no line END {name}", [path])

    def place(self, k):
        return f"{self.path}: line {k + 1}"

    def refuse(self, k, why):
        raise NetworkError(f"{self.place(k)}: {why}", [self.path])

    def heads(self):
        """Yields (line number, words) of the first line of each fracture.

        Readers advance `at` to the end of the fracture."""
        while self.at < self.end:
            k, words = self.at, self.lines[self.at].split()
            self.at += 1
            if not words:
                continue
            needed = 2 if self.name == "FRACTURE" else 4
            if len(words) < needed or not all(word.isdigit() for word in words[:needed]):
                self.refuse(k, f"is \"{self.lines[k].strip()[:40]}\", expected {HEAD[self.name]}")
            yield k, words

    def take(self, n):
        """Returns the words of the next n lines."""
        found = [line.split() for line in self.lines[self.at:min(self.at + n, self.end)]]
        self.at += n
        return found


def points(section, k, number, n, kind, table):
    """Returns the n corners or nodes of a fracture, from lines `number x y z`, numbered from 0 or 1."""
    begin, found = section.at, section.take(n)
    first = 0 if found and found[0][:1] == ["0"] else 1
    counted = [words[:1] == [str(first + row)] and len(words) > 3 for row, words in enumerate(found)]
    if len(found) < n or n < 3 or not all(counted):
        section.refuse(k, f"fracture {number} has {n} {kind}, expected at least 3, and a line with number x y z for each")
    return [numbers(words[1:4], section.place(begin + row), table, range(2, 5)) for row, words in enumerate(found)]


def polygon(section, k, words, table):
    """Yields the corners of a plane fracture. The line `0 x y z` of its normal must follow."""
    corners = points(section, k, words[0], int(words[1]), "corners", table)
    normal = section.take(1)
    if not normal or normal[0][:1] != ["0"] or len(normal[0]) < 4:
        section.refuse(k, f"fracture {words[0]}: the line of its normal, 0 x y z, does not follow its corners")
    yield corners


def facets(section, k, words, table):
    """Yields the triangles of a tessellated fracture."""
    n_nodes, n_facets = int(words[1]), int(words[2])
    nodes, begin = points(section, k, words[0], n_nodes, "nodes", table), section.at
    known = {section.lines[begin - n_nodes + row].split()[0]: x for row, x in enumerate(nodes)}
    found = section.take(n_facets)
    if len(found) < n_facets or not n_facets:
        section.refuse(k, f"fracture {words[0]} has {n_facets} facets, expected at least one and a line for each")
    for row, corners in enumerate(found):
        if len(corners) != 3 or not set(corners) <= set(known):
            section.refuse(begin + row, f"a facet of a TESSFRACTURE is \"{' '.join(corners)[:40]}\", expected the "
                                        f"numbers of three nodes, {next(iter(known))} to {next(reversed(known))}")
        yield [known[corner] for corner in corners]


def read_section(section, table, first):
    """Adds the fractures of a section to the table and returns their number.

    `first` {number: line} contains all so far."""
    count = 0
    for k, words in section.heads():
        number = words[0]
        if number in first:
            section.refuse(k, f"fracture {number} is also in line {first[number] + 1}; each fracture needs its own number")
        first[number] = k
        for shape in (polygon if section.name == "FRACTURE" else facets)(section, k, words, table):
            if all(x is not None for x in shape):
                table.fractures.append(Row(f"{number} ({section.place(k)})", np.array(shape), number))
        count += 1
    return count


def header(path, lines):
    """Returns {entry: (line, text)} of lines `entry = text`. Error for other units than metres and other axes."""
    found = {}
    for k, line in enumerate(lines, 1):
        entry, equals, text = (word.strip().lower() for word in line.partition("="))
        if equals:
            found.setdefault(entry, (k, text))
    for entry, allowed in ENTRIES.items():
        k, text = found.get(entry, (0, allowed[0]))
        if text not in allowed:
            subject = {"length_unit": "lengths are in", "xaxis": "the x axis points"}.get(entry, "the format is")
            expected = "metres" if allowed is METRES else allowed[0]
            raise NetworkError(f"{path}: line {k}: {subject} {text}, expected {expected}", [path])
    return found


def check_counts(path, said, counts):
    """Compares the numbers of fractures with the header."""
    for name, entry in COUNTS.items():
        k, text = said.get(entry.lower(), (0, None))
        if text is not None and text != str(counts[name]):
            raise NetworkError(f"{path}: line {k}: {entry} is {text}, the section {name} has {counts[name]} fractures",
                               [path])


def read_fab(path):
    """Returns the plane fractures of the sections FRACTURE and the triangulated ones of the sections TESSFRACTURE."""
    table, lines = Table(), read_lines(path)
    words = [(k, line.split()[:2]) for k, line in enumerate(lines) if "BEGIN" in line and "FRACTURE" in line]
    begins = [(k, two[1]) for k, two in words if two[0] == "BEGIN"]
    if not begins:
        raise NetworkError(f"{path}: has no line BEGIN FRACTURE", [path])
    said, counts, first = header(path, lines[:begins[0][0]]), dict.fromkeys(COUNTS, 0), {}
    for k, name in begins:
        if name not in COUNTS:
            raise NetworkError(f"{path}: line {k + 1}: the section {name} is unknown, expected {' or '.join(COUNTS)}",
                               [path])
        counts[name] += read_section(Section(path, lines, name, k), table, first)
    if not table.errors:
        check_counts(path, said, counts)
    return complete(table, path)
