"""Flow of a host as rows of Sprekk's Jacobian, in numpy, for 2D meshes. The equations are those of reservoir.py.

The C++ version is apps/hosts/own_flow.hpp."""
import numpy as np
from sprekk import Block, Module, Unknown


class OwnFlow(Module):
    """Rows of the pressures.

    mobility    k/mu, m^2/(Pa s)
    storage     1/M at constant strain, 1/Pa
    viscosity   Pa s
    aperture    initial value, m
    least       lower bound of the aperture, m
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

    def __init__(self, mobility, storage, viscosity, aperture, least, injection):
        self.mobility, self.storage, self.viscosity = mobility, storage, viscosity
        self.aperture, self.least, self.injection = aperture, least, injection

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
        a = np.maximum(self.aperture + b, self.least)
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
