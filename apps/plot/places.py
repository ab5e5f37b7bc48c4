"""Places of names in maps, and the part of a map that shows the change."""

import numpy as np

CHANGED = 0.02  # smallest change in the region / largest change
SMALL = 0.5  # largest region / whole, for a picture of the region only
ROOM = 0.5  # margin of the region / its size


def half_size(name, extent):
    """Returns half the width and height of a name: a letter is about 1/60 as wide as the map, and 1/28 high."""
    return 0.5 * np.asarray(extent) * (len(name) / 60, 1 / 28)


def beside(points, name, extent):
    """Returns places for the name of a line next to its box: above, right, left, below."""
    low, high, half = points.min(axis=0), points.max(axis=0), half_size(name, extent)
    middle, away = 0.5 * (low + high), 0.5 * (high - low) + 1.5 * half
    return middle + away * np.array([[0, 1], [1, 0], [-1, 0], [0, -1]])


def place_of_name(name, places, extent, taken):
    """Returns the first place where the name overlaps nothing, and the half size of the name; or None.

    `taken` are such pairs of other names and of marks."""
    half = half_size(name, extent)
    for place in places:
        if all(np.any(abs(place - other) > half + size) for other, size in taken):
            return place, half
    return None


def region(centres, change, whole):
    """Returns the box (low, high) of the places with change, or None if it is not much smaller than `whole`."""
    changed = change > CHANGED * np.max(change, initial=0)
    if not changed.any():
        return None
    low, high = centres[changed].min(axis=0), centres[changed].max(axis=0)
    size = np.max(high - low)
    if size > SMALL * np.max(np.ptp(whole, axis=0)) or size == 0:
        return None
    middle, half = 0.5 * (low + high), 0.5 * np.maximum(high - low, 0.5 * size) + ROOM * size
    return np.clip([middle - half, middle + half], *whole)
