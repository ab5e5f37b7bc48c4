"""Flow of a host as rows of Sprekk's Jacobian, in numpy, for 2D meshes, compared with the flow of Sprekk.

    ./sprekk python apps/python/examples/own_flow.py [cells [steps]]

Injection into a fracture causes slip and opening."""
import sys

import numpy as np
import sprekk
from mpi4py import MPI
from sprekk import Block, Module, Unknown

COMM = MPI.COMM_WORLD
E, NU, ALPHA = 10e9, 0.25, 0.8  # Pa
MOBILITY, STORAGE, VISCOSITY = 1e-12, 2e-10, 1e-3  # m^2/(Pa s), 1/Pa, Pa s
APERTURE, MINIMUM, INJECTION, DT = 2e-4, 1e-5, 1e-6, 10  # m, m, m/s^2, s


class OwnFlow(Module):
    """Rows of the pressures.

    mobility    k/mu, m^2/(Pa s)
    storage     1/M at constant strain, 1/Pa
    viscosity   Pa s
    aperture    initial value, m
    minimum       lower bound of the aperture, m
    injection   into fractures, growth rate of the flux, m/s^2

    | row           | of                     |                                                        |
    | pressure      | cells                  | V (p - p_old)/(M dt) + sum of q, q = T (p - p_face)    |
    | face pressure | facets of cells        | -q                                                     |
    |               | fracture faces         | |f| ((b - b_old)/dt - injection t) + sum of q to ridges|
    |               | ridges of these        | -q, q = a^3/(12 viscosity) l/d (p - p_ridge)           |"""
    name = "own flow"
    unknowns = (Unknown("pressure", "cell", unit="Pa", scale="pressure", condensed_into="face pressure", balance=True),
                Unknown("face pressure", "facet", unit="Pa", scale="pressure", smooth=True, balance=True))
    scales = {"pressure": 1e-12}
    histories = {"old pressure": ("cell", 1), "old widening": ("fracture face", 1)}
    stores = True

    def __init__(self, mobility, storage, viscosity, aperture, minimum, injection):
        self.mobility, self.storage, self.viscosity = mobility, storage, viscosity
        self.aperture, self.minimum, self.injection = aperture, minimum, injection

    def blocks(self, mesh):
        corners = mesh.coordinates[mesh.corners]
        ends = np.roll(corners, -1, axis=1)  # face k connects corner k and the next
        size, centre = np.linalg.norm(ends - corners, axis=2), (corners + ends) / 2
        distance = np.linalg.norm(centre - centre.mean(axis=1, keepdims=True), axis=2)
        self.T, self.volume = self.mobility * size / distance, np.sum(size * distance, axis=1) / 2
        self.area = mesh.face_area
        both = ["pressure", "face pressure"]
        return [Block("cells", both, both, self.rock, self.rock_by),
                Block("fracture cells", ["face pressure"], ["face pressure", "widening"], self.fracture)]

    def rock(self, x, state):
        p, faces = x["pressure"], x["face pressure"]
        q = self.T * (p - faces)
        stored = np.zeros(len(p))
        old = state.histories["old pressure"][:, 0]
        n = len(old)  # owned cells come first
        stored[:n] = self.volume[:n] * self.storage * state.rate * (p[:n, 0] - old)
        return {"pressure": (stored + q.sum(axis=1))[:, None], "face pressure": -q}

    def rock_by(self, x, state):
        T, n = self.T, self.T.shape[1]
        own = self.volume * self.storage * state.rate + T.sum(axis=1)
        return {("pressure", "pressure"): own[:, None, None], ("pressure", "face pressure"): -T[:, None, :],
                ("face pressure", "pressure"): -T[:, :, None], ("face pressure", "face pressure"): T[:, :, None] * np.eye(n)}

    def fracture(self, x, state):
        p, b = x["face pressure"], x["widening"][:, 0]  # face, then its two ends
        a = np.maximum(self.aperture + b, self.minimum)
        q = (a**3 / (12 * self.viscosity) * 2 / self.area)[:, None] * (p[:, :1] - p[:, 1:])
        gains = np.zeros(len(b))
        old = state.histories["old widening"][:, 0]
        n = len(old)
        gains[:n] = self.area[:n] * (state.rate * (b[:n] - old) - self.injection * state.t)
        return {"face pressure": np.concatenate([(gains + q.sum(axis=1))[:, None], -q], axis=1)}

    def commit(self, state, x):
        for history, values in (("old pressure", x[0]["pressure"]), ("old widening", x[1]["widening"])):
            old = state.histories[history]
            old[:] = values[:len(old)]


def block(n, flow):
    """Scene of a 1 m block on rollers under 2 MPa, with Sprekk's flow or without a fluid."""
    h, first = 1 / n, n // 4
    rock = {"type": "elastic", "Young's modulus": E, "Poisson's ratio": NU, "Biot coefficient": ALPHA}
    joint = {"type": "joint", "friction coefficient": 0.3, "tangential stiffness": "20 GPa/m",
             "initial aperture": APERTURE, "residual aperture": MINIMUM}
    fracture = {"material": "joint"}
    scene = {
        "Mesh": {"cell": "quadrilateral", "lower corner": [0, 0], "upper corner": [1, 1], "cells": [n, n],
                 "fractures": {"fracture": {"lower corner": [first * h, n // 2 * h],
                                            "upper corner": [(n - first) * h, n // 2 * h]}}},
        "Materials": {"rock": rock, "joint": joint}, "Bulk": {"material": "rock"}, "Fractures": {"fracture": fracture},
        "Boundary conditions": {
            "west": {"boundary": "west", "displacement": [0, "free"]},
            "south": {"boundary": "south", "displacement": ["free", 0]},
            "east": {"boundary": "east", "traction": [-2e6, 0]},
            "north": {"boundary": "north", "traction": [4e5, -2e6]}}}
    if flow:
        scene["Flow"] = {"viscosity": VISCOSITY, "scheme": "tpfa"}
        rock.update({"permeability": [MOBILITY * VISCOSITY], "Biot modulus": 1 / STORAGE})
        fracture["source"] = f"{INJECTION}*t"
    return sprekk.Scene(scene)


def distance(a, b):
    """Returns max |a - b| / max |b| over all ranks."""
    apart, size = (COMM.allreduce(float(np.max(abs(values), initial=0)), MPI.MAX) for values in (np.subtract(a, b), b))
    return apart / size if apart else 0.0


def together(n):
    """Returns a model of the block with the flow of the host in the same Jacobian."""
    flow = OwnFlow(MOBILITY, STORAGE, VISCOSITY, APERTURE, MINIMUM, INJECTION)
    return sprekk.Model(block(n, flow=False), COMM, own_pressure=0, modules=[flow])


def main(n=8, steps=4):
    rows, own = together(n), sprekk.Model(block(n, flow=True), COMM)
    errors, states = np.zeros(3), set()
    for k in range(1, steps + 1):
        newton = [model.step(k * DT).newton_iterations for model in (rows, own)]
        found = [distance(rows.field("pressure")[:, 0], own.output("pressure").ravel())]
        found += [distance(rows.output(name), own.output(name)) for name in ("displacement", "jump")]
        errors = np.maximum(errors, found)
        states.add(tuple(COMM.allreduce(np.bincount(own.output("state").astype(int).ravel(), minlength=3))))
        if COMM.rank == 0:
            print(f"t = {k * DT} s: Newton iterations {newton[0]}, of Sprekk's flow {newton[1]}")
    if COMM.rank == 0:
        print("pressure, displacement and jump differ by", ", ".join(f"{error:.1e}" for error in errors))
    return max(errors) < 1e-8 and len(states) > 1  # the contact state changes during the run


if __name__ == "__main__":
    sys.exit(0 if main(*map(int, sys.argv[1:])) else 1)
