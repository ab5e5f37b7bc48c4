#!/usr/bin/env python3
"""What fractures did, and what holds the rock, from a run's results.json.

    read_results.py DIRECTORY            all fractures in the last step
    read_results.py DIRECTORY FRACTURE   one fracture, or a single fracture of a set, in all steps

Jumps (m) and tractions (Pa) are means over the fracture, in its frame: normal first, opening and tension positive.
Reactions (N, in 2D per metre of thickness) are the forces of constrained boundaries in the last step, by coordinates.
"""
import json
import sys


def words(vector):
    return "  ".join(f"{round(value, 9) + 0:.5g}" for value in vector)  # + 0: no "-0"


def row(time, name, fracture):
    shares = [100 * fracture["fraction_" + state] for state in ("open", "stick", "slip")]
    vectors = [fracture[f"mean_{quantity}"]["local"] for quantity in ("elastic_jump", "plastic_jump", "traction")]
    return f"{time:<5g} {name:<10}" + "".join(f"{share:5.0f}%" for share in shares) + "   " + " | ".join(map(words, vectors))


def of(step, singles, name):
    """The data of a fracture or of the single fracture with this name, or None."""
    columns = step.get("single_fractures", {})
    if name in step["fractures"] or name not in singles or not columns:
        return step["fractures"].get(name)
    found = {key: values[singles.index(name)] for key, values in columns.items() if "_local" not in key}
    return found | {key.removesuffix("_local"): {"local": values[singles.index(name)]}
                    for key, values in columns.items() if key.endswith("_local")}


if len(sys.argv) < 2:
    sys.exit(__doc__.strip())
directory, *names = sys.argv[1:]
try:
    with open(directory + "/results.json") as file:
        content = json.load(file)
except OSError as error:
    sys.exit(f"{error.filename}: {error.strerror}; it takes the directory of a run")
singles = [one["name"] for one in content.get("single_fractures", [])]
steps = [step for step in content["steps"] if "fractures" in step]  # a last one that failed at once has none
for name in names:
    if not all(of(step, singles, name) for step in steps):
        known = list(dict.fromkeys([*steps[-1]["fractures"], *singles]))
        sys.exit(f"{directory}: there is no fracture \"{name}\", but {', '.join(known) or 'none'}")
print("t     fracture   open stick  slip   elastic jump | plastic jump | traction")
for step in steps if names else steps[-1:]:
    for name in names or step["fractures"]:
        print(row(step["time"], name, of(step, singles, name)))
for boundary, force in steps[-1]["reactions"].items() if steps else ():
    print(f"reaction at {boundary}: {words(force)}")
