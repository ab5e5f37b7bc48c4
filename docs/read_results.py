#!/usr/bin/env python3
"""What fractures did, from a run's results.json.

    read_results.py DIRECTORY            all fractures in the last step
    read_results.py DIRECTORY FRACTURE   one fracture in all steps

Jumps (m) and tractions (Pa) are means over the fracture, in its frame: normal first, opening and tension positive.
"""
import json
import sys


def row(time, name, fracture):
    shares = [100 * fracture["fraction_" + state] for state in ("open", "stick", "slip")]
    vectors = [fracture[f"mean_{quantity}"]["local"] for quantity in ("elastic_jump", "plastic_jump", "traction")]
    text = ["  ".join(f"{round(value, 9) + 0:.5g}" for value in vector) for vector in vectors]  # + 0: no "-0"
    return f"{time:<5g} {name:<10}" + "".join(f"{share:5.0f}%" for share in shares) + "   " + " | ".join(text)


directory, *names = sys.argv[1:]
with open(directory + "/results.json") as file:
    steps = json.load(file)["steps"]
print("t     fracture   open stick  slip   elastic jump | plastic jump | traction")
steps = [step for step in steps if "fractures" in step]  # a last one that failed at once has none
for step in steps if names else steps[-1:]:
    for name in names or step["fractures"]:
        print(row(step["time"], name, step["fractures"][name]))
