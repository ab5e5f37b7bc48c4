"""Exact solutions of scenes, from formulas. Each function returns the largest relative error of a run.

Units and symbols are those of docs/model/model.md. N = -lambda_n; d = (d_t, d_n) is the displacement of the top
of a block of height H whose bottom is fixed. The formulas follow from equilibrium and the joint law."""
import math

import numpy as np


class Errors:
    """Largest error of several quantities, each relative to its reference value, or to a scale if that value is 0."""

    def __init__(self):
        self.error = 0.0

    def add(self, values, reference, scale):
        size = abs(reference) if reference else scale
        self.error = max(self.error, float(np.max(np.abs(np.asarray(values) - reference))) / size)
        if not np.isfinite(self.error):
            self.error = math.inf


def load_for(compliance, joint, opening):
    """Solves compliance N + closure(N) = opening for N >= 0: a quadratic, whose root is computed without
    cancellation."""
    if joint.closure == 0:
        return opening / compliance
    product = joint.closure * joint.normal_stiffness
    b = compliance * product + joint.closure - opening
    root = math.sqrt(b * b + 4 * compliance * opening * product)
    return 2 * opening * product / (b + root) if b >= 0 else (root - b) / (2 * compliance)


def column(joint, rock, height, d_t, d_n, slipped):
    """Returns (state, lambda_t, lambda_n, p, [[u]]_n) of a block with one fracture after one step from the plastic
    jump `slipped`.

    Rock and joint are springs in series; each contact state leads to a quadratic in N."""
    k_s, k_n = rock["G"] / height, (rock["lam"] + 2 * rock["G"]) / height
    stiffness = 1 / (1 / k_s + 1 / joint.stiffness)
    opening = joint.gap + joint.dilation * abs(slipped) - d_n
    if opening > 0:
        N, shear = load_for(1 / k_n, joint, opening), stiffness * (d_t - slipped)
        if abs(shear) <= joint.friction * N:
            return 1, shear, -N, slipped, float(joint.closed_gap(abs(slipped), -N))
    if joint.gap + joint.dilation * abs(d_t) <= d_n:
        return 0, 0.0, 0.0, d_t, d_n
    sense, side = math.copysign(1, d_t - slipped), math.copysign(1, d_t)
    compliance = 1 / k_n + side * sense * joint.dilation * joint.friction / stiffness
    N = load_for(compliance, joint, joint.gap + side * joint.dilation * d_t - d_n)
    p = d_t - sense * joint.friction * N / stiffness
    assert compliance > 0 and p * side >= 0 and sense * (p - slipped) >= 0, "a regime that column() does not cover"
    return 2, sense * joint.friction * N, -N, p, float(joint.closed_gap(abs(p), -N))


def table(run, name):
    """Returns the values of a table without the first; an empty list if the table does not exist."""
    return run.input.numbers("Tables", name, "values")[1:] if run.input.text("Tables", name, "values") else []


def block(run):
    """Checks every face in every step of a periodic block against column(); the loads are tables of the scene.

    A fluid pressure p has the same effect as an additional displacement p/k_n of the top."""
    rock, joint = run.input.rock("rock"), run.input.joints[0]
    height = run.input.numbers("Mesh", "upper corner")[-1] - run.input.numbers("Mesh", "lower corner")[-1]
    loads, pressures = list(zip(table(run, "tangential"), table(run, "normal"))), table(run, "p")
    k_n = (rock["lam"] + 2 * rock["G"]) / height
    size, slipped, errors = max(map(abs, sum(loads, ()))), 0.0, Errors()
    assert len(loads) == len(run.faces)
    for (d_t, d_n), pressure, faces in zip(loads, pressures or [0] * len(loads), run.faces):
        state, shear, normal, p, opening = column(joint, rock, height, d_t, d_n + pressure / k_n, slipped)
        tangent = 1 if run.dim == 2 else 2  # a horizontal face has t along x in 2D, t2 along x in 3D
        for values, reference, scale in ((faces.traction[:, 0], normal, rock["G"] * size / height),
                                         (faces.traction[:, tangent], shear, rock["G"] * size / height),
                                         (faces.plastic[:, tangent], p, size), (faces.jump[:, 0], opening, size)):
            errors.add(values, reference, scale)
        if np.any(faces.state != state):
            return math.inf
        slipped = p
    return errors.error


def seed(run):
    """Checks the seed scenes. Push: the jump is elastic, up to about K_t H/G = 1e-11. Pull: the jump is plastic,
    without traction.

    The normal of the fracture is along y."""
    d, joint, faces = run.input.numbers("Boundary conditions", "moved", "displacement"), run.input.joints[0], run.faces[-1]
    shift, pushed, errors = math.hypot(d[0], *d[2:]), d[1] < 0, Errors()
    for values, reference in ((faces.jump[:, 0], 0.0 if pushed else d[1]), (faces.jump[:, 1:], shift),
                              (faces.plastic[:, 1:], 0.0 if pushed else shift),
                              (faces.traction[:, 1:], joint.stiffness * shift if pushed else 0.0)):
        errors.add(values if values.ndim == 1 else np.linalg.norm(values, axis=1), reference, 1)
    return errors.error


def means(run, quantity):
    """Returns the mean over the first fracture in every step, in global components."""
    return np.array([next(iter(step["fractures"].values()))[quantity]["global"] for step in run.results["steps"]])


def cycles(run):
    """Checks the turning points by radial return: traction +-mu N, plastic jump +-(D - S) with S = mu N/K_s = 0.27."""
    rock, joint = run.input.rock("rock"), run.input.joints[0]
    N = 0.1 * (rock["lam"] + 2 * rock["G"])
    far = 0.5 - joint.friction * N * (1 / rock["G"] + 1 / joint.stiffness)
    signs = np.where(np.arange(len(run.results["steps"])) % 2 == 0, 1, -1)
    shear, p = means(run, "mean_traction")[:, 0], means(run, "mean_plastic_jump")[:, 0]
    return max(np.abs(shear * signs / (joint.friction * N) - 1).max(), np.abs(p * signs / far - 1).max())


def turns(steps):
    """Returns a check by radial return along a circle of radius R = 0.5, with `steps` steps per turn.

    The last plastic jump must lie on the steady circle of implicit Euler,
    |p| = -S sin(D/2) + sqrt(R^2 - S^2 cos^2(D/2)), for turns by D per step."""
    return lambda run: _turns(run, 2 * math.pi / steps)


def _turns(run, turn):
    rock, joint = run.input.rock("rock"), run.input.joints[0]
    bound = joint.friction * 0.1 * (rock["lam"] + 2 * rock["G"])
    stiffness = 1 / (1 / rock["G"] + 1 / joint.stiffness)
    p, S, half = np.zeros(2), bound / stiffness, turn / 2
    worst = 0.0
    for k, values in enumerate(means(run, "mean_plastic_jump")[:, :2]):
        angle = turn * (k + 1)
        trial = 0.5 * np.array([math.cos(angle), math.sin(angle)]) - p
        p = p + max(0, 1 - S / np.linalg.norm(trial)) * trial
        worst = max(worst, np.linalg.norm(values - p) / 0.5)
    steady = -S * math.sin(half) + math.sqrt(0.25 - (S * math.cos(half)) ** 2)
    return max(worst, abs(np.linalg.norm(values) / steady - 1))


def incline(run):
    """Checks a layer of height h and weight W per volume on a slope: lambda_n = -W h cos(beta), |lambda_t| = W h
    sin(beta)."""
    beta = math.radians(abs(run.input.number("Mesh", "rotation")))
    weight = -run.input.numbers("Bulk", "body force")[-1] * 0.5
    errors = Errors()
    errors.add(run.faces[-1].traction[:, 0], -weight * math.cos(beta), weight)
    errors.add(np.linalg.norm(run.faces[-1].traction[:, 1:], axis=1), weight * math.sin(beta), weight)
    return errors.error


def hanging(run):
    """Checks a unit cube held by one face: this face carries the weight, without shear; the others carry nothing."""
    weight = -run.input.numbers("Bulk", "body force")[-1]
    errors, traction = Errors(), run.faces[-1].traction
    errors.add(traction[:, 0].min(), -weight, weight)
    errors.add(traction[:, 1:], 0.0, weight)
    errors.add(np.sort(traction[:, 0])[1:], 0.0, weight)
    return errors.error


def uniform(stress, normals, slips):
    """Returns a check of fractures through a block under uniform stress, by quantities independent of the face
    frame.

    normals[k] belongs to fracture k, in the order of names; its slip is slips[k] times lambda_t."""
    def check(run):
        errors, faces = Errors(), run.faces[-1]
        for k, (normal, slip, joint) in enumerate(zip(normals, slips, run.input.joints)):
            traction = np.asarray(stress) @ normal
            N = -traction @ normal
            shear = np.linalg.norm(traction + N * np.asarray(normal))
            on, p = faces.fracture == k, slip * shear
            for values, reference in ((faces.traction[on, 0], -N), (np.linalg.norm(faces.traction[on, 1:], axis=1), shear),
                                      (faces.jump[on, 0], float(joint.closed_gap(p, -N))),
                                      (np.linalg.norm(faces.jump[on, 1:], axis=1), p + shear / joint.stiffness)):
                errors.add(values, reference, 0.1)
        return errors.error
    return check


def at_angles(*degrees):
    return [np.array([-math.sin(math.radians(a)), math.cos(math.radians(a))]) for a in degrees]
