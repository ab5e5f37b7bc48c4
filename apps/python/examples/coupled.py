"""Numpy flow code coupled to Sprekk's mechanics, by exchange and by rows of the Jacobian, compared with Sprekk's flow.

    ./sprekk python apps/python/examples/coupled.py [cells [steps]]

Injection into a fracture causes slip and opening. The C++ version is apps/hosts/coupled.cpp."""
import sys

import numpy as np
import sprekk
from mpi4py import MPI
from own_flow import OwnFlow
from reservoir import Grid, Reservoir

COMM = MPI.COMM_WORLD
E, NU, ALPHA = 10e9, 0.25, 0.8  # Pa
MOBILITY, STORAGE, VISCOSITY = 1e-12, 2e-10, 1e-3  # m^2/(Pa s), 1/Pa, Pa s
APERTURE, LEAST, INJECTION, DT = 2e-4, 1e-5, 1e-6, 10  # m, m, m/s^2, s


def block(n, flow):
    """Scene of a 1 m block on rollers under 2 MPa, with Sprekk's flow or without a fluid."""
    h, first = 1 / n, n // 4
    rock = {"type": "elastic", "Young's modulus": E, "Poisson's ratio": NU, "Biot coefficient": ALPHA}
    joint = {"type": "joint", "friction coefficient": 0.3, "tangential stiffness": "20 GPa/m",
             "initial aperture": APERTURE, "residual aperture": LEAST}
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


class Exchange:
    """Exchange of data between the reservoir code and a model of the block. Each rank solves the whole flow problem."""

    def __init__(self, n):
        self.grid = Grid(n)
        M = E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
        self.reservoir = Reservoir(self.grid, MOBILITY, STORAGE, ALPHA**2 / (4 * M), VISCOSITY, APERTURE, LEAST, INJECTION)
        self.model = sprekk.Model(block(n, flow=False), COMM, given_pressure=0)
        mesh = self.model.mesh
        centres = mesh.coordinates[mesh.cells[:mesh.n_owned_cells]].mean(axis=1)
        self.cells, self.faces = self.grid.cells_at(centres), self.grid.faces_at(mesh.face_centre)
        self.p = self.room = np.zeros(self.reservoir.n)

    def step(self, t, tolerance=1e-5, most=500):
        """Computes a step by the fixed-stress iteration, until the pressures change by less than the tolerance, Pa.

        Each round solves the flow with the compressibility of rock under constant stress. It then solves the mechanics
        with the new pressures. Returns the number of rounds."""
        yields = ALPHA**2 * 3 * (1 - 2 * NU) / E, 0.5 / E
        for k in range(1, most + 1):
            last, self.p = self.p, self.reservoir.pressures(t, t - self.model.time, self.room, self.p, yields)
            self.model.set_fluid_pressure(self.p[self.cells], self.p[self.faces])
            self.model.step(t)
            self.room = self.everywhere(self.model.output("gained pore volume"), self.model.output("widening"))
            if k > 1 and np.max(abs(self.p - last)) < tolerance:
                self.reservoir.accept(self.p, self.room)
                return k
            self.model.take_back()
        raise RuntimeError(f"exchange does not converge: pressures change by {np.max(abs(self.p - last))} Pa")

    def everywhere(self, of_cells, of_faces):
        here = np.zeros(self.reservoir.n)
        here[self.cells], here[self.faces] = of_cells, of_faces
        return COMM.allreduce(here)


def distance(a, b):
    """Returns max |a - b| / max |b| over all ranks."""
    apart, size = (COMM.allreduce(float(np.max(abs(values), initial=0)), MPI.MAX) for values in (np.subtract(a, b), b))
    return apart / size if apart else 0.0


def together(n):
    """Returns a model of the block with the flow of the host in the same Jacobian."""
    flow = OwnFlow(MOBILITY, STORAGE, VISCOSITY, APERTURE, LEAST, INJECTION)
    return sprekk.Model(block(n, flow=False), COMM, own_pressure=0, modules=[flow])


def main(n=8, steps=4):
    exchange, rows, own = Exchange(n), together(n), sprekk.Model(block(n, flow=True), COMM)
    errors, states = {}, set()
    for k in range(1, steps + 1):
        rounds = exchange.step(k * DT)
        newton = [model.step(k * DT).newton_iterations for model in (rows, own)]
        p = own.output("pressure").ravel()
        for way, model, pressure in (("exchange", exchange.model, exchange.p[exchange.cells]),
                                     ("one Jacobian", rows, rows.field("pressure")[:, 0])):
            found = [distance(pressure, p)] + [distance(model.output(name), own.output(name)) for name in ("displacement", "jump")]
            errors[way] = np.maximum(errors.get(way, 0), found)
        states.add(tuple(COMM.allreduce(np.bincount(own.output("state").astype(int).ravel(), minlength=3))))
        if COMM.rank == 0:
            print(f"t = {k * DT} s: {rounds} rounds; Newton iterations {newton[0]}, of Sprekk's flow {newton[1]}")
    if COMM.rank == 0:
        for way, found in errors.items():
            print(f"{way}: pressure, displacement and jump differ by", ", ".join(f"{error:.1e}" for error in found))
    return max(map(max, errors.values())) < 1e-8 and len(states) > 1  # the contact state changes during the run


if __name__ == "__main__":
    sys.exit(0 if main(*map(int, sys.argv[1:])) else 1)
