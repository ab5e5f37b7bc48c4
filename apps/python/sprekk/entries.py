"""Classes for the sections of scenes, generated from the specification of the program: names, units, bounds, meanings.

    from sprekk.entries import Sprekk, Mesh, Material, Time
    scene = Sprekk(mesh=Mesh(cells=[8, 8]), materials={"rock": Material(type="elastic", youngs_modulus="30 GPa")}, ...)
    model = sprekk.Model(scene)

An entry is an attribute with the same name in lower case, with _ for blanks: "Young's modulus" is youngs_modulus.
None means that the entry is absent. Sections with user-defined names are dicts. The constructor of Scene checks the
values."""
import difflib
import keyword
import re
import textwrap

from . import _sprekk

TYPES = {"double": "float | str", "int": "int", "long long": "int", "bool": "bool", "string": "str",
         "Array(double)": "Sequence[float | str]", "Array(int)": "Sequence[int]", "Array(string)": "Sequence[str]",
         "double or expression (string)": "float | str",
         "Array(double) or expressions (Array(string))": "Sequence[float | str]"}
OTHERS = "other sections"


class Section:
    """Base class of the sections of a scene."""
    _names = {}  # {attribute: name of the entry or section}
    _sections = {}  # {name of the section: (class, True for a dict of sections)}
    _open = False  # True: the dict `sections` holds other sections, unchanged

    def __init__(self, **values):
        for attribute in self._names:
            object.__setattr__(self, attribute, None)
        for attribute, value in values.items():
            setattr(self, attribute, value)

    def __setattr__(self, attribute, value):
        if attribute not in self._names:
            near = difflib.get_close_matches(attribute, self._names, 1)
            raise AttributeError(f'{type(self).__name__} has no entry "{attribute}"'
                                 + (f'. Did you mean "{near[0]}"?' if near else f', but {", ".join(self._names)}'))
        object.__setattr__(self, attribute, value)

    def to_entries(self):
        """Returns a dict with the names of the program."""
        entries = {name: as_entries(value) for attribute, name in self._names.items()
                   if (value := getattr(self, attribute)) is not None}
        others = entries.pop(OTHERS, {})
        return {**entries, **others}

    @classmethod
    def from_entries(cls, entries):
        """Creates a section from a dict such as Scene.entries."""
        section = cls()
        attributes = {name: attribute for attribute, name in cls._names.items()}
        for name, value in entries.items():
            inner = cls._sections.get(name)
            if inner and inner[1]:
                value = {key: inner[0].from_entries(of_key) if isinstance(of_key, dict) else of_key
                         for key, of_key in value.items()}
            elif inner:
                value = inner[0].from_entries(value)
            if cls._open and name not in attributes:
                section.sections = {**(section.sections or {}), name: value}
            else:
                setattr(section, attributes.get(name, name), value)
        return section

    def __eq__(self, other):
        return type(other) is type(self) and self.to_entries() == other.to_entries()

    def __repr__(self):
        given = (f"{attribute}={value!r}" for attribute in self._names if (value := getattr(self, attribute)) is not None)
        return f"{type(self).__name__}({', '.join(given)})"


def as_entries(value):
    if isinstance(value, Section):
        return value.to_entries()
    return {name: as_entries(inner) for name, inner in value.items()} if isinstance(value, dict) else value


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


def plans():
    """Returns the plans of all classes; each follows the plans that it uses."""
    found = []
    Plan(_sprekk.specification(), (), found)
    return found


def classes():
    made = {}
    for plan in plans():
        content = {"__doc__": plan.docstring(), "__module__": __name__,
                   "_open": plan.open, "_names": {attribute: name for attribute, (name, _, _) in plan.attributes.items()},
                   "_sections": {name: (made[cls], is_dict) for name, (cls, is_dict) in plan.sections.items()}}
        made[plan.name] = type(plan.name, (Section,), content)
    return made


def stub():
    """Returns the text of entries.pyi, for editors."""
    lines = ['# Printed by `./sprekk python -m sprekk.entries`.', "from typing import Any, Literal, Sequence", "",
             "class Section:", "    def to_entries(self) -> dict[str, Any]: ...",
             "    @classmethod", "    def from_entries(cls, entries: dict[str, Any]) -> Any: ..."]
    for plan in plans():
        documentation = textwrap.indent(plan.docstring().replace("\\", "\\\\"), "    ").strip()
        lines += ["", f"class {plan.name}(Section):", f'    """{documentation}', '    """']
        lines += [f"    {attribute}: {kind} | None" for attribute, (_, kind, _) in plan.attributes.items()]
        if plan.attributes:
            lines.append("    def __init__(self, *, " + ", ".join(
                f"{attribute}: {kind} | None = ..." for attribute, (_, kind, _) in plan.attributes.items()) + ") -> None: ...")
    return "\n".join(line.rstrip() for line in lines) + "\n"


globals().update(classes())
if __name__ == "__main__":
    print(stub(), end="")
