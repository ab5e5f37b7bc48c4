#!/usr/bin/env python3
"""Bounds the lines that the compiler reads for a header of each package, in the mean, so that builds stay fast.

    header_lines.py ROOT COMPILER [FLAGS...]    prints the mean for each package; exit status 1 if one exceeds its bound

Lines of a header: its own and those of the headers of Sprekk that it includes, and the preprocessed lines of all other
libraries that these include, each without empty lines. Headers with the same libraries are preprocessed once. Kokkos
has 95 thousand lines, Tpetra with Kokkos 127, Sacado with Kokkos 143, the JSON library 95; headers of the standard
library alone are not counted. A header that needs only a name declares it. The bounds are some 2 % above the present
means; raise one only for a header that most sources of a package need.
"""
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

MAX_LINES = {  # of a header, in the mean
    "base": 84500, "laws": 95000, "mesh": 102500, "fields": 124500, "contact": 116000, "assembly": 120000,
    "physics": 127000, "multigrid": 128000, "solve": 126500, "io": 118500, "model": 142000,
}


class Headers:
    """The headers of all packages by their paths, with what they include."""

    def __init__(self, packages):
        self.own, self.libraries, self.lines = {}, {}, {}
        for path in packages.rglob("*.hpp"):
            text, name = path.read_text(), str(path.relative_to(packages))
            self.own[name] = re.findall(r'^#include "([^"]+)"', text, re.MULTILINE)
            self.libraries[name] = [one for one in re.findall(r"^#include <([^>]+)>", text, re.MULTILINE) if re.search(r"[./]", one)]
            self.lines[name] = sum(1 for line in text.splitlines() if line.strip())

    def closure(self, name, found=None):
        """The header and those of Sprekk that it includes."""
        found = {name} if found is None else found
        for other in self.own[name]:
            if other in self.own and other not in found:
                found.add(other)
                self.closure(other, found)
        return found


def preprocessed(libraries, compiler, flags):
    text = "".join(f"#include <{one}>\n" for one in sorted(libraries))
    done = subprocess.run([compiler, *flags, "-std=c++20", "-E", "-P", "-x", "c++", "-"], input=text.encode(),
                          stdout=subprocess.PIPE, check=True)
    return sum(1 for line in done.stdout.splitlines() if line.strip())


def main(root, compiler, *flags):
    headers, failed = Headers(Path(root) / "packages"), False
    includes = {name: headers.closure(name) for name in headers.own if not name.endswith("/precompiled.hpp")}
    libraries = {name: frozenset(one for other in all for one in headers.libraries[other]) for name, all in includes.items()}
    with ThreadPoolExecutor(2) as pool:
        sets = list(set(libraries.values()))
        lines = dict(zip(sets, pool.map(lambda one: preprocessed(one, compiler, flags), sets)))
    for package, bound in MAX_LINES.items():
        names = [name for name in includes if name.startswith(package + "/")]
        mean = sum(lines[libraries[name]] + sum(headers.lines[one] for one in includes[name]) for name in names) / len(names)
        failed |= mean > bound
        print(f"{package:12} {len(names):4} headers, {mean:9.0f} lines in the mean, at most {bound}"
              + (": too many" if mean > bound else ""))
    return failed


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
