"""Plans of the classes in sprekk.entries. As a program it reads the output of `sprekk reference --json` and prints
entries.pyi. The build runs it without the other modules of the package."""
import json
import keyword
import re
import sys
import textwrap

TYPES = {"double": "float | str", "int": "int", "long long": "int", "bool": "bool", "string": "str",
         "Array(double)": "Sequence[float | str]", "Array(int)": "Sequence[int]", "Array(string)": "Sequence[str]",
         "double or expression (string)": "float | str",
         "Array(double) or expressions (Array(string))": "Sequence[float | str]"}
OTHERS = "other sections"


def attribute_of(name):
    """Returns the attribute of an entry: youngs_modulus for "Young's modulus"."""
    attribute = re.sub(r"\W+", "_", name.replace("'", "")).strip("_").lower()
    return attribute + "_" if keyword.iskeyword(attribute) else attribute


def class_name(path):
    """Returns the name of the class of a path, e.g. BoundaryCondition for ("Boundary conditions", "")."""
    words = []
    for part in path:
        if part:
            words.append("".join(word[0].upper() + word[1:] for word in re.findall(r"[A-Za-z0-9]+", part)))
        elif words[-1].endswith("s"):
            words[-1] = words[-1][:-1]
    return "".join(words)


def described(entry):
    """Returns one line of a docstring: meaning, unit, bounds, default."""
    notes = [] if entry["unit"] == "-" else [entry["unit"]]
    if entry["choices"]:
        notes.append(" | ".join(f'"{word}"' for word in entry["choices"]))
    elif entry["bounds"] not in ("", "finite", "any"):
        notes.append(entry["bounds"])
    if entry["length"]:
        notes.append(entry["length"])
    notes.append("required" if entry["required"] else "" if entry["default"] == "absent" else f"default {entry['default']}")
    return f"{entry['meaning']} ({'; '.join(filter(None, notes))})" if any(notes) else entry["meaning"]


def annotation(entry):
    if entry["choices"]:
        return "Literal[" + ", ".join(f'"{word}"' for word in entry["choices"]) + "]"
    return TYPES[entry["type"]]


class Plan:
    """Content of a class: its attributes with names, annotations and lines of documentation."""

    def __init__(self, section, path, plans):
        self.name, self.meaning = class_name(path) or "Sprekk", section["meaning"]
        self.attributes, self.sections = {}, {}  # {attribute: (name, annotation, line)}, {name: (class, is dict)}
        for entry in section["entries"]:
            if entry["name"]:
                self.attributes.setdefault(attribute_of(entry["name"]), (entry["name"], annotation(entry), described(entry)))
        for inner in section["sections"]:
            if inner["name"]:
                self.add_section(inner, (*path, inner["name"]), plans)
        self.open = any(inner["open"] and not inner["name"] for inner in section["sections"])
        if self.open:
            self.attributes["sections"] = OTHERS, "dict[str, Any]", "sections as they stand in the scene"
        if any(plan.name == self.name for plan in plans):
            raise AssertionError(f"two sections define the class {self.name}")
        plans.append(self)

    def add_section(self, inner, path, plans):
        named = [one for one in inner["sections"] if not one["name"] and not one["open"]]
        kind, line = "dict[str, Any]", inner["meaning"]
        if named:
            plan = Plan(named[0], (*path, ""), plans)
            self.sections[inner["name"]] = plan.name, True
            beside = "".join(f" | {annotation(entry)}" for entry in inner["entries"])
            kind, line = f"dict[str, {plan.name}{beside}]", named[0]["meaning"]
        elif not named and not inner["open"] and not any(not entry["name"] for entry in inner["entries"]):
            plan = Plan(inner, path, plans)
            self.sections[inner["name"]] = plan.name, False
            kind = plan.name
        self.attributes[attribute_of(inner["name"])] = inner["name"], kind, line

    def docstring(self):
        lines = [self.meaning or "A scene.", ""]
        for attribute, (_, _, line) in self.attributes.items():
            lines.append(textwrap.fill(f"{attribute}: {line}", 116, subsequent_indent="    "))
        return "\n".join(lines)


def plans(specification):
    """Returns the plans of all classes; each follows the plans that it uses."""
    found = []
    Plan(specification, (), found)
    return found


def stub(specification):
    """Returns the text of entries.pyi, for editors."""
    lines = ["from typing import Any, Literal, Sequence", "",
             "class Section:", "    def to_entries(self) -> dict[str, Any]: ...",
             "    @classmethod", "    def from_entries(cls, entries: dict[str, Any]) -> Any: ..."]
    for plan in plans(specification):
        documentation = textwrap.indent(plan.docstring().replace("\\", "\\\\"), "    ").strip()
        lines += ["", f"class {plan.name}(Section):", f'    """{documentation}', '    """']
        lines += [f"    {attribute}: {kind} | None" for attribute, (_, kind, _) in plan.attributes.items()]
        if plan.attributes:
            lines.append("    def __init__(self, *, " + ", ".join(
                f"{attribute}: {kind} | None = ..." for attribute, (_, kind, _) in plan.attributes.items()) + ") -> None: ...")
    return "\n".join(line.rstrip() for line in lines) + "\n"


if __name__ == "__main__":
    print(stub(json.load(sys.stdin)), end="")
