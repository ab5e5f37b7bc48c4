"""Classes for the sections of scenes, generated from the specification of the program: names, units, bounds, meanings.

    from sprekk.entries import Sprekk, Mesh, Material, Time
    scene = Sprekk(mesh=Mesh(cells=[8, 8]), materials={"rock": Material(type="elastic", youngs_modulus="30 GPa")}, ...)
    model = sprekk.Model(scene)

An entry is an attribute with the same name in lower case, with _ for blanks: "Young's modulus" is youngs_modulus.
None means that the entry is absent. Sections with user-defined names are dicts. The constructor of Scene checks the
values."""
import difflib
import json

from . import _sprekk
from .plan import OTHERS, plans

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


def classes():
    made = {}
    for plan in plans(json.loads(_sprekk.specification())):
        content = {"__doc__": plan.docstring(), "__module__": __name__,
                   "_open": plan.open, "_names": {attribute: name for attribute, (name, _, _) in plan.attributes.items()},
                   "_sections": {name: (made[cls], is_dict) for name, (cls, is_dict) in plan.sections.items()}}
        made[plan.name] = type(plan.name, (Section,), content)
    return made


globals().update(classes())
