"""Grids of blocks: scenes of the parts of a box or of the domain of a network."""
import itertools

import numpy as np

from .. import _sprekk
from .block import scene_of


def blocks_of(scene, counts, comm):
    """Yields (index, lower corner, upper corner, Scene) for a grid of equal blocks, the first direction first."""
    entries = scene.entries
    place, box = _box_of(scene, entries)
    lower, upper = (np.array([float(x) for x in box[name]]) for name in ("lower corner", "upper corner"))
    if len(counts) != len(lower) or min(counts) < 1:
        raise _sprekk.Error(f"blocks: {[int(n) for n in counts]}, must be {len(lower)} numbers of at least 1")
    sizes = (upper - lower) / counts
    for index in itertools.product(*map(range, counts[::-1])):
        index = np.array(index[::-1])
        low = lower + index * sizes
        high = np.where(index + 1 == counts, upper, low + sizes)
        changed = _part_of_box(scene, low, high, counts) if place == "Mesh" else _part_of_network(entries, low, high)
        yield tuple(map(int, index)), low, high, scene_of(scene, changed, comm)


def _box_of(scene, entries):
    if "Mesh" in entries:
        if entries["Mesh"].get("rotation"):
            raise _sprekk.Error(f'{scene.name}: Sprekk > Mesh > "rotation": must be absent for a grid of blocks')
        return "Mesh", scene.all_entries["Mesh"]
    domain = entries["Mesh file"].get("network", {}).get("domain", {})
    if "lower corner" not in domain:
        raise _sprekk.Error(f"{scene.name}: Sprekk > Mesh file: a grid of blocks needs a network with a domain given by "
                            'its lower and upper corner, or the section "Mesh"')
    return "Mesh file", scene.all_entries["Mesh file"]["network"]["domain"]


def _part_of_network(entries, low, high):
    file = entries["Mesh file"]
    network = {**file["network"], "unusable fractures": "left out",
               "domain": {**file["network"]["domain"], "lower corner": low.tolist(), "upper corner": high.tolist()}}
    kept = {key: value for key, value in file.items() if key != "path"}
    return {**entries, "Mesh file": {**kept, "network": network}}


def _part_of_box(scene, low, high, counts):
    entries = scene.entries
    mesh = entries["Mesh"]
    cells = np.array([int(n) for n in mesh["cells"]])
    if np.any(cells % counts):
        raise _sprekk.Error(f'{scene.name}: Sprekk > Mesh > "cells": are {cells.tolist()}, must be multiples of the '
                            f"blocks {[int(n) for n in counts]}")
    changed = {**mesh, "lower corner": low.tolist(), "upper corner": high.tolist(), "cells": (cells // counts).tolist()}
    kept, near = {}, 1e-9 * (high - low)  # round-off of corners
    for name in ("fractures", "regions"):
        parts = {}
        for title, part in mesh.get(name, {}).items():
            begin, end = (np.array([float(x) for x in part[corner]]) for corner in ("lower corner", "upper corner"))
            clipped = np.maximum(begin, low), np.minimum(end, high)
            flat = end == begin
            if np.any(flat & ((abs(begin - low) < near) | (abs(begin - high) < near))) and np.all((clipped[0] < clipped[1]) | flat):
                raise _sprekk.Error(f'{scene.name}: Sprekk > Mesh > fractures > {title}: lies between two blocks; choose '
                                    "other blocks")
            inside = np.where(flat, (clipped[0] > low) & (clipped[0] < high), clipped[0] < clipped[1])
            if np.all(inside):
                parts[title] = {**part, "lower corner": clipped[0].tolist(), "upper corner": clipped[1].tolist()}
        changed[name] = kept[name] = parts
    found = {**entries, "Mesh": {key: value for key, value in changed.items() if value != {}}}
    for section, parts in (("Fractures", kept["fractures"]), ("Regions", kept["regions"])):
        if section in found:
            found[section] = {key: value for key, value in found[section].items()
                              if key in parts or not isinstance(value, dict)}
    return {key: value for key, value in found.items() if key not in ("Fractures", "Regions") or value}
