"""Scenes from files, XML text or Python entries."""
import os
from collections.abc import Mapping

from mpi4py import MPI

from . import _sprekk


class Scene:
    """Validated scene. Invalid input raises an Error with the message of `./sprekk check`.

    source     path of an XML file, XML text, a dict of sections and entries such as {"Time": {"steps": 3}}, or an
               object of sprekk.entries. Values are numbers, strings ("30 GPa", "1e-3*t") or lists of these
    overrides  changed entries, {"Time.steps": 3} or a list of strings "Time.steps=3"
    comm       communicator; its ranks read the scene together
    folder     base of relative paths, for sources other than files
    name       name in messages, for sources other than files"""

    def __init__(self, source, overrides=(), *, comm=MPI.COMM_WORLD, folder="", name="scene"):
        texts = override_texts(overrides)
        if isinstance(source, _sprekk.Scene):
            self._handle = source
        elif isinstance(source, str) and source.lstrip().startswith("<"):
            self._handle = _sprekk.Scene.from_text(source, name, texts, comm)
        elif isinstance(source, (str, os.PathLike)):
            self._handle = _sprekk.Scene.from_file(os.fspath(source), texts, comm)
        elif not is_section(source):
            raise TypeError(f"source is a {type(source).__name__}, must be the path of a file, XML as text, or a dict of entries")
        else:
            self._handle = _sprekk.Scene.from_entries(plain(source), name, str(folder), texts, comm)

    @property
    def entries(self):
        """Given entries, as a nested dict."""
        return self._handle.entries()

    @property
    def all_entries(self):
        """All possible entries with defaults, as a nested dict."""
        return self._handle.effective()

    @property
    def times(self):
        """Ends of the steps, s. With adaptive steps: the times that must be met."""
        return self._handle.times()

    @property
    def name(self):
        return self._handle.origin

    def to_xml(self, defaults=False):
        """Returns the XML text of the scene; with defaults=True, of all entries."""
        return self._handle.effective_xml() if defaults else self._handle.xml()

    def changed(self, overrides, comm=MPI.COMM_WORLD):
        """Returns a changed Scene, e.g. {"Materials.joint.friction coefficient": 0.3}; a dict changes a section."""
        sections = {path: value for path, value in dict(overrides).items() if is_section(value)}
        entries = self.entries
        for path, value in sections.items():
            merge(entries, path.split("."), plain(value))
        values = {path: value for path, value in dict(overrides).items() if path not in sections}
        return Scene(entries, values, comm=comm, folder=self._handle.folder, name=self.name)

    def __repr__(self):
        return f"<sprekk.Scene {self.name!r}: {', '.join(self.entries)}>"


def is_section(value):
    return isinstance(value, Mapping) or hasattr(value, "to_entries")


def plain(value):
    """Converts values of numpy and sprekk.entries to plain Python values, without None."""
    if hasattr(value, "to_entries"):
        value = value.to_entries()
    if isinstance(value, Mapping):
        return {name: plain(inner) for name, inner in value.items() if inner is not None}
    if hasattr(value, "tolist"):  # numpy types
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(inner) for inner in value]
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def merge(entries, path, section):
    for name in path:
        entries = entries.setdefault(name, {})
    for name, value in section.items():
        if isinstance(value, dict):
            merge(entries, [name], value)
        else:
            entries[name] = value


def override_texts(overrides):
    """Returns the overrides as strings "Path.to.entry=value"."""
    if isinstance(overrides, Mapping):
        return [f"{path}={value_text(plain(value))}" for path, value in overrides.items()]
    return [overrides] if isinstance(overrides, str) else list(overrides)


def value_text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "{" + ", ".join(f'"{v}"' if isinstance(v, str) and "," in v else value_text(v) for v in value) + "}"
    return value if isinstance(value, str) else repr(value)
