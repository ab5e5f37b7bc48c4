#!/usr/bin/env python3
"""Holds the documentation to what is true.

    check_docs.py quotes ROOT              code in a ```cpp or ```xml block is literally in the file that the comment
                                           before the block names (<!-- from PATH -->), and relative links lead somewhere
    check_docs.py commands ROOT BINARY MPIEXEC
                                           sprekk run, check and point in ```sh and ```console blocks end with
                                           status 0, or N if "# exit N" follows; the lines below a command in a
                                           ```console block are lines of what it prints
    check_docs.py reference ROOT BINARY    xml/reference.md is what the binary prints

Prints what is wrong; exit status 1 if anything is.
"""
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"^(?:<!-- from (?P<source>\S+) -->\n)?```(?P<kind>\w+)\n(?P<content>.*?)^```$",
                   re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\[[^\]]*\]\((?!https?:|#|mailto:)([^)#\s]+)[^)]*\)")


def pages(root):
    return [root / "README.md", *sorted((root / "docs").glob("*.md"))]


def check_quotes(root):
    for page in pages(root):
        text = page.read_text()
        for block in BLOCK.finditer(text):
            place = f"{page.relative_to(root)}:{text.count(chr(10), 0, block.start()) + 1}"
            if block["kind"] not in ("cpp", "xml"):
                continue
            if not block["source"]:
                yield f"{place}: the block does not say from which file it is"
            elif block["content"] not in (root / block["source"]).read_text():
                yield f"{place}: {block['source']} does not contain this block"
        for link in LINK.finditer(re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)):
            if not (page.parent / link[1]).exists():
                yield f"{page.relative_to(root)}: the link {link[1]} leads nowhere"


def commands(block):
    """(command, lines that it prints) of each run of the program."""
    found = []
    for line in block["content"].splitlines():
        command = line[2:] if block["kind"] == "console" and line.startswith("$ ") else line
        if block["kind"] == "console" and command == line:
            if found:
                found[-1][1].append(line)
        else:
            found.append((command, []))
    return [c for c in found if re.match(r"\S*/sprekk (run|check|point)\b", c[0])]


def run(command, binary, mpiexec, folder):
    words = shlex.split(command, comments=True)[1:]
    launcher = []
    if "--ranks" in words:
        i = words.index("--ranks")
        launcher = [mpiexec, "--oversubscribe", "--bind-to", "none", "-np", words[i + 1]]
        del words[i:i + 2]
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMP_NUM_THREADS": "1", "SPREKK_TERMINAL": "1"}
    return subprocess.run([*launcher, binary, *words], cwd=folder, env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=60)


def check_commands(root, binary, mpiexec):
    with tempfile.TemporaryDirectory() as folder:
        for name in ("xml", "docs"):
            (Path(folder) / name).symlink_to(root / name)
        for page in pages(root):
            for block in BLOCK.finditer(page.read_text()):
                if block["kind"] not in ("sh", "console"):
                    continue
                for command, expected in commands(block):
                    done = run(command, binary, mpiexec, folder)
                    status = re.search(r"# exit (\d)", command)
                    if done.returncode != (int(status[1]) if status else 0):
                        yield f"{page.name}: {command}: exit status {done.returncode}\n{done.stdout}"
                    for line in expected:
                        if line not in done.stdout.splitlines():
                            yield f"{page.name}: {command}: does not print\n  {line}\nbut\n{done.stdout}"


def check_reference(root, binary):
    printed = subprocess.run([binary, "reference"], stdout=subprocess.PIPE, text=True, check=True).stdout
    if printed != (root / "xml" / "reference.md").read_text():
        yield "xml/reference.md is out of date; write it anew with ./sprekk reference > xml/reference.md"


def main():
    what, root, *rest = sys.argv[1:]
    check = {"quotes": check_quotes, "commands": check_commands, "reference": check_reference}[what]
    wrong = list(check(Path(root).resolve(), *rest))
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
