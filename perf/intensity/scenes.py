"""Scenes of cracks with known stress intensity factors, as trees of sections and entries."""
import math

E, NU, STRESS = 30e9, 0.25, 1e6  # Pa, -, Pa
G = E / (2 * (1 + NU))
ROCK = {"type": "elastic", "Young's modulus": E, "Poisson's ratio": NU}
CHI = 0.673112  # correction of the length of a double cantilever beam, in heights of an arm


def plate(lower, upper, density, crack, conditions, order, regions=None, cell="triangle"):
    """Box with a crack along y = 0 from x = crack[0] to crack[1], with `density` cells per metre."""
    mesh = {"cell": cell, "order": order, "lower corner": lower, "upper corner": upper,
            "cells": [round(density * (b - a)) for a, b in zip(lower, upper)],
            "fractures": {"crack": {"lower corner": [crack[0], 0.0], "upper corner": [crack[1], 0.0], "reference normal": [0.0, 1.0]}}}
    if regions:
        mesh["regions"] = regions
    return {"Mesh": mesh, "Materials": {"rock": ROCK, "joint": {"type": "joint", "friction coefficient": 0.5}}, "Bulk": {"material": "rock"},
            "Fractures": {"crack": {"material": "joint", "stress intensity": True}}, "Boundary conditions": conditions, "Time": {"end": 1.0, "steps": 1}}


def between_rollers(density, order):
    """Crack |x| < 1/2 between rollers at |x| = 1, under tension."""
    width, half, height = 1.0, 0.5, 3.0
    conditions = {"west": {"boundary": "west", "displacement": ["0", "free"]}, "east": {"boundary": "east", "displacement": ["0", "free"]},
                  "south": {"boundary": "south", "displacement": ["free", "0"]}, "north": {"boundary": "north", "traction": [0.0, STRESS]}}
    exact = STRESS * math.sqrt(2 * width * math.tan(math.pi * half / (2 * width)))
    return plate([-width, -height], [width, height], density, (-half, half), conditions, order), (exact, 0)


def double_cantilever(density, order):
    """Arms of height 0.1 m and length 0.3 m, opened by forces at their ends."""
    height, length, force = 0.1, 0.3, 1e5
    right = 0.9
    regions = {"below": {"lower corner": [0.0, -height], "upper corner": [right, 0.0]},
               "above": {"lower corner": [0.0, 0.0], "upper corner": [right, height]}}
    conditions = {"held": {"boundary": "east", "displacement": [0.0, 0.0]},
                  **{name: {"boundary": "west", "region": name, "traction": [0.0, sign * force / height]} for name, sign in (("below", -1), ("above", 1))}}
    exact = 2 * math.sqrt(3) * force * (length + CHI * height) / height**1.5
    return plate([0.0, -height], [right, height], density, (0.0, length), conditions, order, regions), (exact, 0)


def edge_crack(density, order):
    """Crack to the middle of a strip of width 1 m under tension."""
    height, length = 2.0, 0.5
    conditions = {"south": {"boundary": "south", "traction": [0.0, -STRESS]}, "north": {"boundary": "north", "traction": [0.0, STRESS]},
                  "point": {"boundary": "east", "displacement": ["0", "0"], "lower corner": [1.0, 0.0]},
                  "turn": {"boundary": "east", "displacement": ["0", "free"], "lower corner": [1.0, height]}}
    return plate([0.0, -height], [1.0, height], density, (0.0, length), conditions, order), (2.8246 * STRESS * math.sqrt(math.pi * length), 0)


def williams(density, order):
    """Tip at the origin of a box, with the field of K_I, K_II and a stress T along the crack on its sides."""
    size, opening, sliding, along = 2.0, 1e6, 4e5, -5e5
    r, f, kappa = "sqrt(x^2+y^2)", 1 / (2 * G * math.sqrt(2 * math.pi)), 3 - 4 * NU
    regions, conditions = {}, {}
    for region, sign in (("below", -1), ("above", 1)):
        c, s, double = f"sqrt(max({r}+x,0)/2)", f"({sign})*sqrt(max({r}-x,0)/2)", f"(1-x/{r})"
        u = (f"{f * opening!r}*{c}*({kappa - 1}+{double})+{f * sliding!r}*{s}*({kappa + 3}-{double})+({along * (1 - NU**2) / E!r})*x")
        v = (f"{f * opening!r}*{s}*({kappa - 1}+{double})-{f * sliding!r}*{c}*({kappa - 1}-{double})-({along * NU * (1 + NU) / E!r})*y")
        regions[region] = {"lower corner": [-size, min(0, sign * size)], "upper corner": [size, max(0, sign * size)]}
        for side in ("west", "east", "south" if sign < 0 else "north"):
            conditions[f"{side} {region}"] = {"boundary": side, "region": region, "displacement": [u, v]}
    return plate([-size, -size], [size, size], density, (-size, 0.0), conditions, order, regions), (opening, sliding)
