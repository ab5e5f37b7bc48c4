#!/usr/bin/env python3
"""Bounds the mean number of lines that the compiler reads for a header of each package, to limit build times.

    header_lines.py ROOT COMPILER [FLAGS...]    prints the mean for each package; exit status 1 if one exceeds its bound

The count of a header includes the headers of Sprekk that it includes, and the preprocessed lines of all other
libraries, without empty lines. Headers with the same libraries are preprocessed once. Headers with only the standard
library are not preprocessed. Kokkos has 95 thousand lines, Tpetra with Kokkos 127, Sacado with Kokkos 143, the JSON
library 95. A header that needs only a name should declare it. The bounds are about 2 % above the present means.
Raise one only for a header that most sources of a package need."""
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

MAX_LINES = {  # mean lines of a header
    "base": 84500, "laws": 98000, "mesh": 102500, "fields": 124500, "contact": 116000, "assembly": 123000,
    "estimate": 126500, "transport": 125500, "physics": 132500, "multigrid": 128000, "solve": 126500,
    "laboratory": 160000, "io": 118500, "model": 142000,
}


class Headers:
    """Headers of all packages by path, with their includes."""

    def __init__(self, packages):
        self.own, self.libraries, self.lines = {}, {}, {}
        for path in packages.rglob("*.hpp"):
            text, name = path.read_text(), str(path.relative_to(packages))
            self.own[name] = re.findall(r'^#include "([^"]+)"', text, re.MULTILINE)
            self.libraries[name] = [one for one in re.findall(r"^#include <([^>]+)>", text, re.MULTILINE) if re.search(r"[./]", one)]
            self.lines[name] = sum(1 for line in text.splitlines() if line.strip())

    def closure(self, name, found=None):
        """Returns the header and all headers of Sprekk that it includes."""
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
