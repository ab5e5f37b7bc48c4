"""Writes the fracture networks of xml/contact as input of gmsh: networks.py FOLDER, then gmsh -2 on each file.

The networks consist of straight fractures at random places in the unit square, split at intersections. In
network_x.geo fractures cross. In network_t.geo every second fracture ends at its first intersection with an
older one."""
import sys
from pathlib import Path

import numpy as np

SIZE = 0.045  # mesh size


def segments(count, seed):
    """Ends [count, 2, 2] of fractures of length 0.2 to 0.6, away from the boundary of the square."""
    random = np.random.default_rng(seed)
    ends = []
    for _ in range(count):
        centre, angle, half = random.uniform(0.1, 0.9, 2), random.uniform(0, np.pi), random.uniform(0.2, 0.6) / 2
        along = half * np.array([np.cos(angle), np.sin(angle)])
        ends.append(np.clip([centre - along, centre + along], 0.03, 0.97))
    return np.array(ends)


def crossing(a, b):
    """Returns the positions, 0 to 1, of the intersection on segments a and b; None without an intersection."""
    da, db, shift = a[1] - a[0], b[1] - b[0], b[0] - a[0]
    determinant = da[0] * db[1] - da[1] * db[0]
    if abs(determinant) < 1e-12:
        return None
    s = (shift[0] * db[1] - shift[1] * db[0]) / determinant
    t = (shift[0] * da[1] - shift[1] * da[0]) / determinant
    slack = 1e-9  # accepts ends that lie on the other segment
    return (s, t) if -slack <= s <= 1 + slack and -slack <= t <= 1 + slack else None


def abutting(ends):
    """Cuts every second fracture at its first intersection with an older one, if at least a fifth of it remains."""
    for i in range(1, len(ends), 2):
        meets = [meet[0] for meet in (crossing(ends[i], older) for older in ends[:i]) if meet and meet[0] > 0.2]
        if meets:
            ends[i, 1] = ends[i, 0] + min(meets) * (ends[i, 1] - ends[i, 0])
    return ends


def geo(ends, what):
    """Returns the text of a gmsh .geo file."""
    points, lines, groups = [], [], []

    def point(x):
        for k, known in enumerate(points):
            if np.linalg.norm(known - x) < 1e-7:
                return k + 10
        points.append(x)
        return len(points) + 9

    for i, a in enumerate(ends):
        stops = [0.0, 1.0] + [meet[0] for j, b in enumerate(ends) if j != i for meet in [crossing(a, b)] if meet]
        path = []
        for stop in sorted(stops):
            number = point(a[0] + stop * (a[1] - a[0]))
            if number not in path:
                path.append(number)
        groups.append(range(len(lines) + 10, len(lines) + 9 + len(path)))
        lines += zip(path, path[1:])
    text = [f"// {what}", f"size = {SIZE};"]
    text += [f"Point({k + 1}) = {{{x}, {y}, 0, size}};" for k, (x, y) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1)))]
    text += [f"Line({k}) = {{{k}, {k % 4 + 1}}};" for k in range(1, 5)]
    text += ["Curve Loop(1) = {1 : 4};", "Plane Surface(1) = {1};"]
    text += [f"Point({k + 10}) = {{{x:.9f}, {y:.9f}, 0, size}};" for k, (x, y) in enumerate(points)]
    text += [f"Line({k + 10}) = {{{a}, {b}}};" for k, (a, b) in enumerate(lines)]
    text += [f"Curve{{10 : {len(lines) + 9}}} In Surface{{1}};"]
    for k, group in enumerate(groups):
        text.append(f'Physical Curve("f{k + 1:02}") = {{{", ".join(map(str, group))}}};')
    for k, side in enumerate(("south", "east", "north", "west")):
        text.append(f'Physical Curve("{side}") = {{{k + 1}}};')
    return "\n".join(text + ['Physical Surface("rock") = {1};', ""])


def main(folder):
    for name, ends, what in (
            ("network_x", segments(15, 1), "15 fractures that cross; written by perf/contact/networks.py"),
            ("network_t", abutting(segments(20, 4)), "20 fractures that cross and abut; written by perf/contact/networks.py")):
        (Path(folder) / f"{name}.geo").write_text(geo(ends, what))


if __name__ == "__main__":
    main(sys.argv[1])
