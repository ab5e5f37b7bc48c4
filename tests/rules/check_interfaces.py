#!/usr/bin/env python3
"""Compares the sizes of interfaces with their limits.

    check_interfaces.py ROOT    prints a table of sizes and limits; exit status 1 if a limit is exceeded"""
import re
import sys
from pathlib import Path

from check_rules import GENERIC, PHYSICS, blanked, end_of_braces, without_templates

CLASS = re.compile(r"(?<!<)(?<!, )\b(?:class|struct)\s+(\w+)[^;(){}=]*\{")
PHYSICS_HEADER = "packages/physics/physics.hpp"


def classes(code):
    """Yields (name, body) of every class; bodies of its functions and classes are removed."""
    for match in CLASS.finditer(code):
        body = code[match.end():end_of_braces(code, match.end() - 1) - 1]
        while "{" in body:
            body = re.sub(r"\{[^{}]*\}", ";", body)
        yield match[1], re.sub(r"\b(?:public|private|protected)\s*:", "", body)


def virtual_functions(body):
    """Returns the number of functions that a class declares as virtual, without the destructor."""
    return len(re.findall(r"\bvirtual\b(?!\s*~)", body))


def data_members(body):
    """Returns the number of data members with names such as scale_."""
    declarations = [re.sub(r"=[^,]*", "", part) for part in without_templates(body).split(";")]
    return sum(len(re.findall(r"\w_\s*(?:\[\w*\]\s*)*(?:,|$)", part)) for part in declarations if "(" not in part)


def is_outside(path):
    """Returns whether a source is in packages/physics, but not in the folder of a physics."""
    return path.startswith("packages/physics/") and path.count("/") == 2


def sizes(texts):
    """Yields (title, limit, {place: size}) of each limit. The limit applies to each size. texts: {path: content}."""
    codes = {path: blanked(text) for path, text in texts.items() if Path(path).suffix in (".hpp", ".cpp")}
    in_packages = {path: code for path, code in codes.items() if path.startswith("packages/")}
    bodies = [(path, *one) for path, code in in_packages.items() for one in classes(code)]
    of_modules = [one for one in bodies if one[0].startswith("packages/assembly/")]
    of_physics = [one for one in bodies if one[0] == PHYSICS_HEADER]
    yield "virtual functions of Module", 8, {
        name: virtual_functions(body) for _, name, body in of_modules if name == "Module"}
    yield "virtual functions of a capability of modules", 6, {
        name: virtual_functions(body) for path, name, body in of_modules if "capabilities" in path}
    yield "functions of Physics", 8, {
        name: len(re.findall(r"\bstatic\b", body)) for _, name, body in of_physics if name == "Physics"}
    yield "functions of a group of Physics", 6, {
        name: body.count("(*") for _, name, body in of_physics if name.endswith("Functions")}
    yield "data members of System", 20, {
        name: data_members(body) for _, name, body in of_modules if name == "System"}
    yield "data members of a class of packages", 24, {name: data_members(body) for _, name, body in bodies}

    sources = {path: text for path, text in texts.items() if path in in_packages and path.split("/")[1] == "physics"}
    outside = [path for path in sources if is_outside(path)]
    folders = {path.split("/")[2] for path in sources if path.count("/") > 2}
    lines = sum(text.count("\n") for text in sources.values())
    yield "lines of packages/physics / number of physics", 2835, {"": round(lines / max(1, len(folders)))}
    yield "sources of packages/physics outside of folders", 8, {"": len(outside)}
    yield "their includes of folders, except in list.hpp", 0, {
        path: len(re.findall(r'#\s*include\s*"physics/\w+/', sources[path]))
        for path in outside if not path.endswith("/list.hpp")}
    yield "generic sources that name a physics", 0, {"": sum(
        bool(PHYSICS.search(texts[path])) for path in in_packages if path.split("/")[1] in GENERIC)}
    yield "lines of a source of packages and apps", 500, {
        path: text.count("\n") for path, text in texts.items() if path.split("/")[0] in ("packages", "apps")}
    yield "calls of Ghosts::exchange", 1, {"": sum(
        len(re.findall(r"\bghosts_\.exchange\s*\(", code)) for code in in_packages.values())}


def table(texts):
    """Returns the rows (title, limit, size, place): the largest size of each limit."""
    rows = []
    for title, limit, found in sizes(texts):
        place = max(found, key=found.get, default="")
        rows.append((title, limit, found.get(place, 0), place))
    return rows


def main():
    root = Path(sys.argv[1])
    files = [file for folder in ("packages", "apps") for file in sorted((root / folder).rglob("*"))]
    rows = table({str(file.relative_to(root)): file.read_text(encoding="utf-8") for file in files
                  if file.suffix in (".hpp", ".cpp", ".py") and "node_modules" not in file.parts})
    if not rows[0][2]:
        sys.exit(f"{root}: has no class Module in packages/assembly")
    for title, limit, size, place in rows:
        print(f"{'ok' if size <= limit else 'EXCEEDED':9}{title:48}{size:6} <= {limit:<6} {place}".rstrip())
    sys.exit(any(size > limit for _, limit, size, _ in rows))


if __name__ == "__main__":
    main()
