"""Runs a scene again in other ways, which must not change its results: on several ranks, renumbered, renamed,
from a checkpoint, and without any change."""
import re
import shutil
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field

from perf.common import program
from perf.coupled import differences
from perf.coupled.written import Written

WAYS = ("2 ranks", "renamed", "restart", "3 ranks", "renumbered", "repeated")
ALLOWED = 1e-8  # relative difference; 0 for "restart" and "repeated"
CHECKPOINTS = ("Output.checkpoints.steps=1",)


@dataclass
class Compared:
    """Differences between the first run of a scene and its other runs."""
    ways: list = field(default_factory=list)  # of the other runs
    largest: float = None                     # relative difference; None if no results were compared
    of_ranks: list = field(default_factory=list)   # messages
    of_others: list = field(default_factory=list)

    def add(self, way, size, messages):
        self.ways.append(way)
        if size is not None:
            self.largest = max(size, self.largest or 0.0)
        (self.of_ranks if way.endswith("ranks") else self.of_others).extend(messages)


def add_option(parser):
    parser.add_argument("--all-ways", action="store_true",
                        help="also run each scene in all other ways: on several ranks, from a checkpoint, renamed, ...")


def entries(ways):
    """Entries of the first run, which writes what the others need."""
    return CHECKPOINTS if "restart" in ways else ()


def compare(ways, scene, first, binary, limits):
    """Runs the scene in the ways that are possible; `first` is the ended program.Run. Returns Compared.

    Of a run that did not complete, only the status on several ranks is compared."""
    written, compared = Written(first.directory, first.results) if first.status == 0 else None, Compared()
    sets = entries(ways)
    for way in ways:
        if way in ("renamed", "renumbered") and not boxes(scene) or way == "restart" and len(first.steps) < 2:
            continue
        if written is None and not way.endswith("ranks"):
            continue
        compared.add(way, *_again(way, scene, first, written, binary, limits, sets))
    return compared


def boxes(scene):
    """Names of the fractures that the scene gives by their corners."""
    return [node.get("name") for node in xml.parse(scene).getroot().findall(f"{_of('Mesh')}/{_of('fractures')}/ParameterList")]


def _of(name):
    return f"ParameterList[@name='{name}']"


def _again(way, scene, first, written, binary, limits, sets):
    """Returns (largest difference, messages). `sets`: entries of the first run; checkpoints change the round-off."""
    directory, ranks, words, rename = first.directory.with_name(re.sub(r"\W", "_", way)), 1, (), str
    if way.endswith("ranks"):
        ranks = int(way[0])
    elif way == "renumbered":
        sets = (*sets, "Mesh.renumbering seed=7")
    elif way == "renamed":
        scene, rename = _renamed(scene)
    elif way == "restart":
        checkpoints = _without_last_checkpoint(first.directory, directory)
        if checkpoints < 2:
            return None, [f"restart: {checkpoints} checkpoints after {len(first.steps)} steps"]
        words = ("--restart",)
    ended = program.run(binary, scene, directory, sets, ranks, **limits, words=words, clear=way != "restart")
    if ended.status != first.status or (way == "restart" and not ended.results.get("restarts")):
        return None, [f"{way}: status {ended.status} instead of {first.status}: {ended.reason}"]
    if written is None:
        return None, []
    size, place = differences.largest(written, Written(directory, ended.results), rename)
    allowed = 0.0 if way in ("restart", "repeated") else ALLOWED
    return size, [] if size <= allowed else [f"{way}: {place} differs by {size:.1e} of the largest"]


def _without_last_checkpoint(directory, copy):
    """Copies the output without its last checkpoint. Returns the number of checkpoints of the original."""
    shutil.copytree(directory, copy, dirs_exist_ok=True)
    numbered = sorted((folder for folder in (copy / "checkpoints").iterdir() if folder.is_dir() and folder.name.isdigit()),
                      key=lambda folder: int(folder.name))
    if numbered:
        shutil.rmtree(numbered[-1])
    return len(numbered)


def _renamed(scene):
    """Writes a copy of the scene with fractures renamed in the opposite order. Returns (file, map to the old names)."""
    tree, names = xml.parse(scene), boxes(scene)
    new = {name: f"g{len(names) - k:02}" for k, name in enumerate(names)}
    for section in ("Fractures", "fractures"):
        for node in tree.getroot().findall(f".//{_of(section)}/ParameterList"):
            node.set("name", new[node.get("name")])
    for node in tree.getroot().iter("Parameter"):
        if node.get("name") == "fracture":
            node.set("value", new[node.get("value")])
        elif node.get("name") == "cuts":
            node.set("value", "{" + ", ".join(new[name.strip()] for name in node.get("value").strip("{}").split(",")) + "}")
    copy = scene.with_suffix(".renamed.xml")
    tree.write(copy)
    back = {value: key for key, value in new.items()}
    return copy, lambda name: back.get(name, name)
