"""Writes the tables in the pages of results from CSV files in the same folder, and checks the numbers in their text.

    ./sprekk perf pages            writes the tables in docs/results/*.md, then checks
    ./sprekk perf pages --check    exit status 1 if a table is out of date or a number has no source

A table is the result of an SQL query (SQLite) in a comment:

    <!-- query
    SELECT [cells, state] AS state, unknowns, max FROM krylov
    -->
    (table and source, written by this program)
    <!-- end -->

Each file NAME.csv is a table NAME. The table NAME_results contains the results and targets in its header, with the
columns [case], quantity, value and target. Names with blanks and key words are written in brackets. The function
number(value, format) formats as Python does, for instance number(mean, '.1f'). The aggregate range(value, format) is the
smallest to the largest value.

Each number in the text of a page must be in a table of the page or in the header of a CSV file that a query of the page
reads, rounded to the digits of the text. In README.md, all numbers in a line of the section on accuracy and speed must
be in one row of a CSV file of the measurements that it names. Code, formulas and years of papers are not checked: write
inputs as `code`."""
import argparse
import csv
import re
import sqlite3
import textwrap
from pathlib import Path

BLOCK = re.compile(r"<!-- query\n(?P<sql>.*?)-->\n(?P<content>.*?)<!-- end -->", re.DOTALL)
NUMBER = re.compile(r"(?<![\w.,])[-+]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+]?\d+)?(?!\w|[.,]\d)(?: ?%)?")
NOT_CHECKED = (r"```.*?```", r"`[^`]*`", r"<!--.*?-->", r"\$\$.*?\$\$", r"\$[^$\n]*\$", r"\]\([^)]*\)",
               r"(?:19|20)\d\d\)", r"^#.*?$", r"https?:\S*")
RESULTS = ("case", "quantity", "value", "target")  # columns of the table NAME_results
README_SECTION = re.compile(r"^## Accuracy and speed\n.*?(?=^## )", re.DOTALL | re.MULTILINE)


def number(text):
    try:
        return int(text) if re.fullmatch(r"[-+]?\d+", text) else float(text)
    except ValueError:
        return text or None


class Source:
    """A CSV file with comments."""

    def __init__(self, file):
        self.name = file.stem
        lines = file.read_text().splitlines()
        self.header = [pair for line in lines for pair in re.findall(r"^# (\w+): (.*)", line)]
        for name in ("command", "commit", "date"):
            if not self[name]:
                raise SystemExit(f'{file}: the header has no line "# {name}: ..."; measure again with --save')
        self.columns, *self.rows = csv.reader(line for line in lines if not line.startswith("#"))
        targets = {key: value for name, line in self.header if name == "target" for key, value in pairs(line)}
        self.results = [(re.match(r"(?:([^\s=]+) )?", line)[1], key, number(value), number(targets.get(key, "")))
                        for name, line in self.header if name == "result" for key, value in pairs(line)]

    def __getitem__(self, name):
        return next((value for key, value in self.header if key == name), "")

    def load(self, connection):
        rows = [[number(cell) for cell in row] for row in self.rows]
        tables = ((self.name, self.columns, rows), (f"{self.name}_results", RESULTS, self.results))
        for name, columns, content in tables:
            names = ", ".join(f"[{column}]" for column in columns)
            connection.execute(f"CREATE TABLE {name} ({names})")
            connection.executemany(f"INSERT INTO {name} VALUES ({', '.join('?' * len(columns))})", content)

    def caption(self):
        named = re.sub(r" \([^)]*\)(?= \d)", "", self["machine"])  # compiler without its package
        machine = "; load: ".join(text for text in (named, self["load"]) if text)
        return (f"[{self.name}.csv]({self.name}.csv): `{self['command']}`, commit {self['commit']}, {self['date']}. "
                f"Machine: {machine or 'not recorded'}.")

    def records(self):
        """The numbers of each row, and of each line of the header."""
        return [*(values_in(",".join(row)) for row in self.rows), *self.header_values()]

    def header_values(self):
        return [values_in(value) for key, value in self.header if key not in ("commit", "date")]


def values_in(text):
    return {abs(float(found)) for found in re.findall(r"(?<![A-Za-z_.\d])\d+(?:\.\d+)?(?:e[-+]?\d+)?", text)}


def pairs(line):
    return re.findall(r"(\w+)=(\S+)", line)


def formatted(value, how):
    return format(value, how).replace("%", " %") if isinstance(value, (int, float)) else value


class Range:
    """The SQL aggregate range(value, format)."""

    def __init__(self):
        self.values, self.how = [], ""

    def step(self, value, how):
        self.how = how
        self.values += [value] if value is not None else []

    def finalize(self):
        ends = [formatted(end(self.values), self.how) for end in (min, max)] if self.values else []
        return " to ".join(dict.fromkeys(ends)) or None


def shown(value):
    return "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def table(connection, sql):
    if '"' in sql:  # SQLite takes an unknown "name" as text
        raise sqlite3.OperationalError("write names of columns as [name], not in double quotes,")
    cursor = connection.execute(sql)
    names = [column[0] for column in cursor.description]
    rows = [[shown(value) for value in row] for row in cursor]
    lines = [names, ["---"] * len(names), *rows]
    return "\n".join("| " + " | ".join(row) + " |" for row in lines).replace("|  |", "| |").replace("|  |", "| |")


def read_by(sql, sources):
    return [source for source in sources if re.search(rf"\b(FROM|JOIN)\s+{source.name}(_results)?\b", sql)]


def matches(text, values):
    """Whether one of the values, rounded to the digits of the text, is the number in it."""
    digits = text.rstrip(" %").replace(",", "").lstrip("+-")
    mantissa, _, power = digits.partition("e")
    decimals = len(mantissa.partition(".")[2])
    scale = 100 if text.endswith("%") else 1
    unit = 10.0**(int(power or 0) - decimals)
    return any(abs(value * factor - float(digits)) <= 0.5000001 * unit for value in values for factor in {1, scale})


def numbers(text):
    """(line, number) in the text of a page."""
    for pattern in (BLOCK.pattern, *NOT_CHECKED):
        text = re.sub(pattern, lambda found: re.sub(r"[^\n]", " ", found[0]), text, flags=re.DOTALL | re.MULTILINE)
    return [(text.count("\n", 0, found.start()) + 1, found[0].strip()) for found in NUMBER.finditer(text)]


def unfounded(place, text, sources, tables):
    """Numbers in the text that are neither in the tables of the page nor in the header of a source."""
    values = values_in(tables).union(*(values for source in sources for values in source.header_values()))
    return [f"{place}:{line}: {found} is neither in the tables of this page nor in a header ({named(sources)})"
            for line, found in numbers(text) if not matches(found, values)]


def unfounded_lines(place, text, sources):
    """Lines whose numbers are not together in one row or line of the header."""
    records = [record for source in sources for record in source.records()]
    for k, line in enumerate(text.splitlines(), 1):
        found = [number for _, number in numbers(line)]
        if not any(all(matches(number, record) for number in found) for record in records) and found:
            yield f"{place}:{k}: no row of the CSV files has {', '.join(found)} ({named(sources)})"


def named(sources):
    return ", ".join(f"{source.name}.csv" for source in sources) or "none"


def filled(page, sources, connection):
    """The text of a page with its tables, and the sources of these."""
    used = []

    def fill(block):
        new = [source for source in read_by(block["sql"], sources) if source not in used]
        used.extend(new)
        captions = [textwrap.fill(source.caption(), 120, break_on_hyphens=False) for source in new]
        try:
            content = table(connection, block["sql"])
        except sqlite3.Error as error:
            raise SystemExit(f"{page}: {error} in the query\n{block['sql']}")
        return "\n\n".join([f"<!-- query\n{block['sql']}-->", content, *captions, "<!-- end -->"])
    return BLOCK.sub(fill, page.read_text()), used


def main(words):
    parser = argparse.ArgumentParser(prog="sprekk perf pages", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing")
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parents[1], help="the sources")
    options = parser.parse_args(words)
    folder, wrong = options.root / "docs/results", []
    sources = [Source(file) for file in sorted(folder.glob("*.csv"))]
    connection = sqlite3.connect(":memory:")
    connection.create_function("number", 2, formatted)
    connection.create_aggregate("range", 2, Range)
    for source in sources:
        source.load(connection)
    for page in sorted(folder.glob("*.md")):
        text, used = filled(page, sources, connection)
        place = page.relative_to(options.root)
        if text != page.read_text():
            if options.check:
                wrong.append(f"{place}: the tables are out of date; update them with ./sprekk perf pages")
            else:
                page.write_text(text)
        wrong += unfounded(place, text, used, "\n".join(block["content"] for block in BLOCK.finditer(text)))
    readme = (options.root / "README.md").read_text()
    section = README_SECTION.search(readme)
    if not section:
        wrong.append("README.md: the section with measured values is missing")
    lines = "\n" * readme.count("\n", 0, section.start()) + section[0] if section else ""
    measured = set(re.findall(r"\bperf (\w+)", lines))
    wrong += unfounded_lines("README.md", lines, [one for one in sources if set(one["command"].split()) & measured])
    print(*wrong, sep="\n", end="\n" * bool(wrong))
    return 1 if wrong else 0
