"""Blocks with sets of parallel fractures, and their tensors in closed form.

Sets k of parallel fractures through the block, with unit normal n, spacing s, normal and shear stiffness Kn and Ks,
aperture a, in rock with compliance S_r, permeability k_m, Biot coefficient b and Biot modulus M:

    K = k_m I + sum a^3/(12 s) (I - n n),   S = S_r + sum (1/s) (nnnn/Kn + (sym(I nn) - nnnn)/Ks),
    alpha = S^-1 : (b S_r : I + sum n n/(Kn s)),
    storage at constant stress = 1/M + b^2 I:S_r:I + sum (1/(Kn s) + a c_f/s)."""
import numpy as np
from sprekk.upscale import components

E, NU, PERMEABILITY, BIOT, BIOT_MODULUS, COMPRESSIBILITY = 60e9, 0.25, 1e-18, 0.6, 40e9, 4.5e-10
# normal stiffness, Pa/m; shear stiffness, Pa/m; aperture, m
JOINTS = {"x": (8e10, 3e10, 1e-4), "y": (6e10, 2e10, 1.5e-4), "z": (1e11, 4e10, 2e-4)}
SIZE = {"x": 1.0, "y": 0.8, "z": 0.5}
COMPRESSED = [-2e6, -1e6, -3e6, 0, 0, 0]


def joint(normal_stiffness, shear_stiffness, aperture, **more):
    return {"type": "joint", "normal stiffness": normal_stiffness, "tangential stiffness": shear_stiffness,
            "initial aperture": aperture, "friction": "no slip", **more}


def block(axes, cell="hexahedron", cells=4, rotation=None, **joints):
    """Returns the entries of a box with a fracture through its middle, normal to each of the axes."""
    dim = 2 if cell in ("triangle", "quadrilateral") else 3
    used = "xyz"[:dim]
    upper = [SIZE[axis] for axis in used]
    fractures = {}
    for axis in axes:
        low, high = [0.0] * dim, list(upper)
        low[used.index(axis)] = high[used.index(axis)] = SIZE[axis] / 2
        fractures[axis] = {"lower corner": low, "upper corner": high}
    mesh = {"cell": cell, "lower corner": [0] * dim, "upper corner": upper, "cells": [cells] * dim,
            "fractures": fractures}
    if rotation:
        mesh["rotation"] = rotation
        if dim == 3:
            mesh["rotation axis"] = [0, 1, 0]
    materials = {f"joint {axis}": joints.get(axis) or joint(*JOINTS[axis]) for axis in axes}
    rock = {"type": "elastic", "Young's modulus": E, "Poisson's ratio": NU, "permeability": [PERMEABILITY],
            "Biot coefficient": BIOT, "Biot modulus": BIOT_MODULUS}
    return {"Mesh": mesh, "Materials": {"rock": rock, **materials}, "Bulk": {"material": "rock"},
            "Fractures": {axis: {"material": f"joint {axis}"} for axis in axes},
            "Flow": {"viscosity": 1e-3, "compressibility": COMPRESSIBILITY}, "Time": {"end": 1}}


def traction_rows(n):
    """Returns the matrix that maps a stress vector to the traction on a plane with the normal n."""
    return np.stack([unit @ n for unit in components.unit_stresses(len(n))], axis=1)


def rock_compliance(dim):
    """Returns the compliance of the rock; in 2D in plane strain."""
    young, poisson = (E, NU) if dim == 3 else (E / (1 - NU**2), NU / (1 - NU))
    n = components.n_components(dim)
    S = np.zeros((n, n))
    S[:dim, :dim] = -poisson / young
    S[range(dim), range(dim)] = 1 / young
    S[range(dim, n), range(dim, n)] = 2 * (1 + NU) / E
    return S


class Exact:
    """Closed forms of sets [(normal, spacing, normal stiffness, shear stiffness, aperture)]."""

    def __init__(self, dim, sets):
        unit = np.array([1.0] * dim + [0.0] * (components.n_components(dim) - dim))
        rock = rock_compliance(dim)
        pushed = BIOT * rock @ unit
        self.K, self.S = PERMEABILITY * np.eye(dim), rock.copy()
        self.storage = 1 / BIOT_MODULUS + BIOT**2 * unit @ rock @ unit
        for n, spacing, normal_stiffness, shear_stiffness, aperture in sets:
            n, rows = np.array(n), traction_rows(np.array(n))
            across = np.outer(n, n)
            own = rows.T @ (across / normal_stiffness + (np.eye(dim) - across) / shear_stiffness) @ rows / spacing
            self.S += own
            pushed += own @ unit
            self.K += aperture**3 / 12 / spacing * (np.eye(dim) - across)
            self.storage += 1 / (normal_stiffness * spacing) + aperture * COMPRESSIBILITY / spacing
        self.alpha = np.linalg.solve(self.S, pushed)
        self.storage_at_strain = self.storage - self.alpha @ self.S @ self.alpha


def sets_of(axes, dim, stress, R=None):
    """Returns the sets of linear joints at a stress. Apertures are those after closure."""
    found = []
    for axis in axes:
        normal_stiffness, shear_stiffness, aperture = JOINTS[axis]
        n = np.eye(dim)["xyz".index(axis)]
        n = n if R is None else R @ n
        closure = -n @ components.matrix_of(np.array(stress)) @ n / normal_stiffness
        found.append((n, SIZE[axis], normal_stiffness, shear_stiffness, aperture - closure))
    return found
