"""Joint laws computed from the entries of a material and the formulas of docs/model/model.md, independent of the
program.

History variables of the faces are read from the output of the run. Their admissible change in a step is
computed here."""
import math

import numpy as np

NEAR_ZERO = 1e-3   # relative to the smaller damage length: below it, anisotropic damage blends both slip senses
ROUNDED = 0.003    # relative to an abscissa of Barton's table: half-width of the parabola at the corner
ROUGHNESS = (np.array([0.3, 0.6, 1, 2, 4, 10, 100]), np.array([0, 0.75, 1, 0.85, 0.7, 0.5, 0]))
RESIDUAL = (np.array([0, 0.3]), np.array([0.0, 1.0]))
ENDLESS = 1e300
JUST_TOUCH = 1e-9  # relative to jump and slip: distance below which faces touch


def rounded(table, x):
    """Returns the piecewise linear curve of a table, constant outside, with rounded corners."""
    points, values = table
    y = np.interp(x, points, values)
    slopes = np.r_[0, np.diff(values) / np.diff(points), 0]
    for k, at in enumerate(points):
        e = ROUNDED * at
        near = np.abs(x - at) < e
        y = np.where(near, y + (slopes[k + 1] - slopes[k]) * (e - np.abs(x - at)) ** 2 / (4 * max(e, 1e-300)), y)
    return y


class JointLaw:
    """Joint law of one material. entry(name, default) returns a number, kind(role) the name of a law.

    Arguments `faces` have the tractions `normal` and `shear`, `slip` = |u_t^p|, and in `history` the history
    fields by name."""

    def __init__(self, entry, kind):
        self.entry, self.kinds = entry, {role: kind(role) for role in (
            "friction", "dilation", "closure", "tangential elasticity", "bond", "damage", "damage driver")}
        self.gap = entry("initial gap", 0)

    def number(self, name, default=None):
        """Returns a coefficient; if only the corresponding angle is given, its tangent."""
        value = self.entry(name, None)
        if value is None and name.endswith("coefficient"):
            angle = self.entry(name.replace("coefficient", "angle"), None)
            value = None if angle is None else math.tan(math.radians(angle))
        return default if value is None else value

    # ---- friction ----------------------------------------------------------------------------------------------------

    def bound(self, faces):
        """Bound on |lambda_t|, Pa."""
        friction, dilation = self.left(faces)
        normal = faces.normal
        load = np.maximum(-normal, 0)
        if self.kinds["friction"] != "composed":
            bound = friction * self._friction(load, faces, dilation, friction)
        else:
            bound = self._friction(load, faces, dilation, friction)
        if self.kinds["bond"] == "none":
            return bound
        # Under tension, which only a bond can carry, the friction line continues with its slope at zero load.
        small = np.full_like(load, 1e-9 * max(load.max(initial=0), 1e-300))
        slope = self._friction(small, faces, dilation, friction) / small
        if self.kinds["friction"] != "composed":
            slope = slope * friction
        return np.maximum(np.where(normal > 0, -slope * normal, bound) + self.number("cohesion", 0) * self.whole(faces), 0)

    def _friction(self, load, faces, dilation, friction):
        kind = self.kinds["friction"]
        if kind == "Coulomb":
            return self.number("friction coefficient") * load
        if kind == "slip weakening":
            peak, residual = self.number("friction coefficient"), self.number("residual friction coefficient")
            left = np.maximum(1 - faces.history["accumulated slip"] / self.entry("weakening distance", None), 0)
            return (residual + (peak - residual) * left) * load
        if kind == "composed":
            basic, asperity = self.number("basic friction coefficient"), math.tan(math.radians(self.entry("asperity angle", None)))
            rides = np.maximum(1 - load / self.entry("transition stress", None), 0) ** self.entry("transition exponent", 1.5)
            slope = rides * asperity * dilation
            return load * ((basic + slope) / (1 - basic * slope) + (1 - rides) * self.number("asperity friction coefficient") * friction)
        if kind not in ("Barton-Choubey", "mobilised Barton-Choubey"):
            raise ValueError(f'friction "{kind}" is not known here')
        residual, maximum = self.entry("residual friction angle", None), self.entry("largest friction angle", 70)
        roughness, strength = self.roughness
        rough = roughness * np.log10(strength / np.clip(load, 1e-300, strength))
        rough = np.minimum(rough, maximum - residual)
        if kind == "mobilised Barton-Choubey":
            x = faces.history["accumulated slip"] / self.peak_slip
            return load * np.tan(np.radians(residual * rounded(RESIDUAL, x) + rough * rounded(ROUGHNESS, x)))
        return load * np.tan(np.radians(residual + rough))

    @property
    def min_friction(self):
        """Lower bound of the friction coefficient after any slip and under any load, without the bond."""
        kind = self.kinds["friction"]
        if "Barton-Choubey" in kind:
            minimum = math.tan(math.radians(self.entry("residual friction angle", None)))
        else:
            minimum = self.number({"Coulomb": "friction coefficient", "slip weakening": "residual friction coefficient"}.get(kind, "basic friction coefficient"))
        return minimum * (1 if self.kinds["damage"] == "none" else self.entry("residual part of friction", 0))

    @property
    def roughness(self):
        """(JRC, JCS) of the joint, scaled to its length."""
        roughness, strength = self.entry("joint roughness coefficient", None), self.entry("joint wall strength", None)
        length = self.entry("joint length", None)
        if not length:
            return roughness, strength
        ratio = length / self.entry("sample length", 0.1)
        return roughness * ratio ** (-0.02 * roughness), strength * ratio ** (-0.03 * roughness)

    @property
    def peak_slip(self):
        given, length = self.entry("peak slip", None), self.entry("joint length", None)
        return given if given else length / 500 * (self.roughness[0] / length) ** 0.33

    # ---- contact ---------------------------------------------------------------------------------------------------

    def closed_gap(self, faces):
        """Gap g of (14), m."""
        return self.gap + self.lifted(faces) - self._closure(faces)

    def lifted(self, faces):
        """Opening by slip (dilation), m."""
        return self.left(faces)[1] * self._dilation(faces)

    def _dilation(self, faces):
        kind, u = self.kinds["dilation"], faces.slip
        if kind == "mobilised":
            return faces.history["opening by slip"]
        tangent = math.tan(math.radians(self.entry("dilation angle", 0)))
        if kind == "constant angle":
            return tangent * u
        if kind == "decaying angle":
            residual, D = math.tan(math.radians(self.entry("residual dilation angle", 0))), self.entry("dilation decay distance", None)
            return residual * u - (tangent - residual) * D * np.expm1(-u / D)
        if kind == "limited":
            height, e = self.entry("largest dilation", None), 0.05
            x = tangent * u / height
            return height * np.where(np.abs(x - 1) < e, 1 - (1 + e - x) ** 2 / (4 * e), np.minimum(x, 1))
        raise ValueError(f'dilation "{kind}" is not known here')

    def _closure(self, faces):
        kind, load = self.kinds["closure"], np.maximum(-faces.normal, 0)
        if kind in ("Barton-Bandis", "Bandis", "Barton-Bandis with memory"):
            closed = self._hyperbola(load)
            if kind != "Barton-Bandis with memory":
                return closed
            irrecoverable = self.entry("irrecoverable part of closure", 0)
            return (1 - irrecoverable) * closed + irrecoverable * self._hyperbola(np.maximum(load, faces.history["largest compression"]))
        K = self.entry("normal stiffness", None)
        if kind == "linear":
            return load / K
        if kind == "power":
            reference, m = self.entry("stiffening stress", None), self.entry("stiffening exponent", None)
            x = np.log1p(load / reference)
            return reference / K * (x if m == 1 else np.expm1((1 - m) * x) / (1 - m))
        raise ValueError(f'closure "{kind}" is not known here')

    def _hyperbola(self, load):
        if self.kinds["closure"] == "Bandis":
            a = 1e3 * self.entry("joint aperture", None)
            JRC, ratio = self.entry("joint roughness coefficient", None), self.entry("joint wall strength", None) / 1e6 / a
            A, B, C, D = (-0.2960, -0.0056, 2.2410, -0.2450) if self.entry("loading cycle", 1) == 1 else (-0.1032, -0.0074, 1.1350, -0.2510)
            K, maximum = 1e9 * (-7.15 + 1.75 * JRC + 0.02 * ratio), 1e-3 * (A + B * JRC + C * ratio ** D)
        else:
            K, maximum = self.entry("normal stiffness", None), self.entry("maximum closure", math.inf)
        if K is None or K == math.inf or maximum == 0:
            return np.zeros_like(load)
        return load / (K + load / maximum)

    # ---- bond and damage ---------------------------------------------------------------------------------------------

    def whole(self, faces):
        """Remaining fraction of the bond."""
        if self.kinds["bond"] == "linear softening":
            return 1 - faces.history["damage of bond"]
        opening = self.entry("opening without cohesion", 0) if self.kinds["bond"] == "constant cohesion" else 0
        return 1 - np.clip((faces.jump[:, 0] - self.closed_gap(faces)) / opening, 0, 1) if opening > 0 else 1.0

    def tension(self, faces):
        """Tensile strength, Pa."""
        return self.whole(faces) * (self.entry("tensile strength", 0) if self.kinds["bond"] == "linear softening" else 0)

    def left(self, faces):
        """Fractions of friction and dilation that remain after damage."""
        if self.kinds["damage"] == "none":
            return 1.0, 1.0
        lengths = [self.entry(f"damage length of {what}", math.inf) for what in ("friction", "dilation")]
        parts = []
        for what, length in zip(("friction", "dilation"), lengths):
            residual = self.entry(f"residual part of {what}", 0)
            part = residual + (1 - residual) * np.exp(-faces.history["damage history"] / length)
            if self.kinds["damage"] == "anisotropic":
                part = np.where(faces.slip < NEAR_ZERO * min(lengths), 1 - faces.history[f"damage of {what}"], part)
            parts.append(part)
        return parts

    # ---- evolution of the history variables ------------------------------------------------------------------------

    def wrong_histories(self, faces, before, path):
        """[face] Error of the history variables relative to their value computed from the start of the step and
        the step, m.

        Loads are divided by the normal stiffness. `path` contains the segments (plastic jump from, to, weight
        k) of all steps up to this one; it is None if a step is unknown."""
        rubbed = self.rubbed_share(faces, before, path and path[:-1]) * _slip_of_step(faces, before)
        wrong, reported, was = np.zeros(len(rubbed)), faces.history, before.history

        def must_be(name, value, scale=1.0):
            nonlocal wrong
            wrong = np.maximum(wrong, np.abs(reported[name] - value) / scale)
        if self.kinds["friction"] in ("slip weakening", "mobilised Barton-Choubey") or self.kinds["dilation"] == "mobilised":
            must_be("accumulated slip", was["accumulated slip"] + rubbed)
        if self.kinds["dilation"] == "mobilised":
            must_be("opening by slip", was["opening by slip"] + (faces.slip - before.slip) * self._mean_tangent(faces, before, rubbed))
        if self.kinds["closure"] == "Barton-Bandis with memory":
            must_be("largest compression", np.maximum(was["largest compression"], -faces.normal), self.entry("normal stiffness", None))
        if self.kinds["damage"] == "isotropic":
            must_be("damage history", was["damage history"] + self.weight(faces) * rubbed)
        if self.kinds["damage"] == "anisotropic" and path:
            known, length = history_of(path, faces)
            off = np.abs(reported["damage history"] - known) - reported["error of damage history"] * length
            wrong = np.maximum(wrong, np.where(faces.slip > 0, off, 0))
        return wrong

    def rubbed_share(self, faces, before, path):
        """[face] Share of the slip of the step that counts in histories: 1 on closed faces, 0 on open ones.

        Open faces that just touch may have been closed during a part of the step. Their share follows from the
        histories of the run."""
        closed, apart = faces.state > 0, faces.jump[:, 0] - self.closed_gap(faces)
        touch = (~closed | (faces.normal >= 0)) & (np.abs(apart) <= JUST_TOUCH * (np.abs(faces.jump[:, 0]) + faces.slip))
        slip = _slip_of_step(faces, before)
        if self.kinds["dilation"] == "mobilised":
            maximum, reported = slip, faces.history["accumulated slip"] - before.history["accumulated slip"]
        elif self.kinds["damage"] == "isotropic":
            maximum, reported = self.weight(faces) * slip, faces.history["damage history"] - before.history["damage history"]
        elif self.kinds["damage"] == "anisotropic" and path is not None:
            previous = history_of(path, faces)[0]
            segment = before.plastic[:, 1:], faces.plastic[:, 1:], self.weight(faces)
            maximum, reported = history_of([segment], faces)[0], faces.history["damage history"] - previous
        else:
            return closed.astype(float)
        share = np.clip(reported / np.where(maximum > 0, maximum, 1), 0, 1)
        return np.where(touch, share, closed)

    def weight(self, faces):
        """Weight k of slip in the damage history."""
        kind = self.kinds["damage driver"]
        if kind == "slip":
            return np.ones(len(faces.normal))
        size = np.maximum(-faces.normal, 0) if kind == "compression" else np.linalg.norm(faces.traction[:, 1:], axis=1)
        return size / self.entry("reference stress", None)

    def _mean_tangent(self, faces, before, rubbed):
        """Mean tangent of the mobilised dilation angle over the slip of the step, by Gauss quadrature between the
        table points."""
        roughness, strength = self.roughness
        load = np.maximum(-faces.normal, 1e-6 * strength)
        angle = np.radians(roughness * np.log10(np.maximum(strength / load, 1)) / self.entry("asperity damage coefficient", 2))
        begin = before.history["accumulated slip"] / self.peak_slip
        end = begin + np.maximum(rubbed, 1e-12 * self.peak_slip) / self.peak_slip
        points, weights = np.polynomial.legendre.leggauss(12)
        total = 0
        for low, high in zip(np.r_[0, ROUGHNESS[0]], np.r_[ROUGHNESS[0], ENDLESS]):
            a, b = np.clip(begin, low, high), np.clip(end, low, high)
            for x, weight in zip(points, weights):
                total = total + weight * (b - a) / 2 * np.tan(angle * np.interp((a + b) / 2 + x * (b - a) / 2, *ROUGHNESS))
        return total / (end - begin)


def _slip_of_step(faces, before):
    return np.linalg.norm(faces.plastic[:, 1:] - before.plastic[:, 1:], axis=1)


def history_of(path, faces):
    """Returns Lambda(m) = sum of k |<m.u> - <m.u_before>| over a path, and the sum of k |du|, both [face].

    m is the present direction of the plastic jump of a face."""
    m = faces.plastic[:, 1:] / np.where(faces.slip > 0, faces.slip, 1)[:, None]
    total, length = 0, 0
    for start, end, k in path:
        along = [np.maximum((m * u).sum(axis=1), 0) for u in (start, end)]
        total, length = total + k * np.abs(along[1] - along[0]), length + k * np.linalg.norm(end - start, axis=1)
    return total, length
