#!/usr/bin/env python3
"""Bounds the lines that the compiler reads for the headers of each package, so that builds stay fast.

    header_lines.py ROOT COMPILER [FLAGS...]    prints the lines of all headers of each package after preprocessing,
                                                without empty ones; exit status 1 if a package exceeds its bound

Most lines are those of Trilinos and the standard library: Kokkos 95 thousand, Tpetra with Kokkos 127, Sacado with Kokkos
143, the JSON library 95. A header that needs only a name declares it. The bounds are some 3 % above the present lines;
raise one only for a header that most sources of a package need.
"""
import subprocess
import sys
from pathlib import Path

MAX_LINES = {  # thousands
    "base": 129, "laws": 118, "mesh": 135, "fields": 131, "contact": 132, "assembly": 141, "physics": 173,
    "multigrid": 176, "solve": 145, "io": 164, "model": 198,
}


def lines(headers, root, compiler, flags):
    text = "".join(f'#include "{header.relative_to(root / "packages")}"\n' for header in headers)
    done = subprocess.run([compiler, *flags, "-std=c++20", "-E", "-P", "-x", "c++", "-"], input=text.encode(),
                          stdout=subprocess.PIPE, check=True)
    return sum(1 for line in done.stdout.splitlines() if line.strip())


def main(root, compiler, *flags):
    root, failed = Path(root), False
    for package, bound in MAX_LINES.items():
        headers = [h for h in sorted((root / "packages" / package).rglob("*.hpp")) if h.name != "precompiled.hpp"]
        count = lines(headers, root, compiler, flags)
        failed |= count > 1000 * bound
        print(f"{package:12} {len(headers):4} headers {count:8} lines, at most {1000 * bound}"
              + (": too many" if count > 1000 * bound else ""))
    return failed


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
