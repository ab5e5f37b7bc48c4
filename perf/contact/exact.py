"""Exact answers of scenes, from formulas; each function gives the largest relative error of a run.

Units and symbols as in docs/model/model.md: N = -lambda_n, d = (d_t, d_n) the displacement of the top of a block of height H
whose bottom is fixed. Derived from equilibrium and the law of the joint; checks of the formulas are in the functions'
comments."""
import math

import numpy as np


class Answers:
    """Largest error of several quantities, each relative to its own reference, or to a scale where that is zero."""

    def __init__(self):
        self.error = 0.0

    def add(self, values, reference, scale):
        size = abs(reference) if reference else scale
        self.error = max(self.error, float(np.max(np.abs(np.asarray(values) - reference))) / size)
        if not np.isfinite(self.error):
            self.error = math.inf


def load_for(compliance, joint, opening):
    """N >= 0 with compliance N + closure(N) = opening: the root of a quadratic, without cancellation."""
    if joint.closure == 0:
        return opening / compliance
    product = joint.closure * joint.normal_stiffness
    b = compliance * product + joint.closure - opening
    root = math.sqrt(b * b + 4 * compliance * opening * product)
    return 2 * opening * product / (b + root) if b >= 0 else (root - b) / (2 * compliance)


def column(joint, rock, height, d_t, d_n, slipped):
    """(state, lambda_t, lambda_n, p, [[u]]_n) of a block with one fracture after one step from the plastic jump
    `slipped`: rock and joint are springs in series, and each regime is a quadratic in N."""
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
    """Its values after the first; empty without such a table."""
    return run.input.numbers("Tables", name, "values")[1:] if run.input.text("Tables", name, "values") else []


def block(run):
    """Every face of every step of a periodic block, see column(); the loads stand in tables. A fluid pressure p acts on
    the column like a displacement p/k_n more of its top."""
    rock, joint = run.input.rock("rock"), run.input.joints[0]
    height = run.input.numbers("Mesh", "upper corner")[-1] - run.input.numbers("Mesh", "lower corner")[-1]
    loads, pressures = list(zip(table(run, "tangential"), table(run, "normal"))), table(run, "p")
    k_n = (rock["lam"] + 2 * rock["G"]) / height
    size, slipped, answers = max(map(abs, sum(loads, ()))), 0.0, Answers()
    assert len(loads) == len(run.faces)
    for (d_t, d_n), pressure, faces in zip(loads, pressures or [0] * len(loads), run.faces):
        state, shear, normal, p, opening = column(joint, rock, height, d_t, d_n + pressure / k_n, slipped)
        tangent = 1 if run.dim == 2 else 2  # in the frame of a horizontal face x is t in 2D, t2 in 3D
        for values, reference, scale in ((faces.traction[:, 0], normal, rock["G"] * size / height),
                                         (faces.traction[:, tangent], shear, rock["G"] * size / height),
                                         (faces.plastic[:, tangent], p, size), (faces.jump[:, 0], opening, size)):
            answers.add(values, reference, scale)
        if np.any(faces.state != state):
            return math.inf
        slipped = p
    return answers.error


def seed(run):
    """Push: the whole jump is elastic, to about K_t H/G = 1e-11. Pull: the whole jump is plastic, without traction.
    The normal of the fracture is along y."""
    d, joint, faces = run.input.numbers("Boundary conditions", "moved", "displacement"), run.input.joints[0], run.faces[-1]
    shift, pushed, answers = math.hypot(d[0], *d[2:]), d[1] < 0, Answers()
    for values, reference in ((faces.jump[:, 0], 0.0 if pushed else d[1]), (faces.jump[:, 1:], shift),
                              (faces.plastic[:, 1:], 0.0 if pushed else shift),
                              (faces.traction[:, 1:], joint.stiffness * shift if pushed else 0.0)):
        answers.add(values if values.ndim == 1 else np.linalg.norm(values, axis=1), reference, 1)
    return answers.error


def means(run, quantity):
    """Mean over the fracture in every step, global components."""
    return np.array([next(iter(step["fractures"].values()))[quantity]["global"] for step in run.results["steps"]])


def cycles(run):
    """Radial return at the turning points: the traction is +-mu N, the plastic jump +-(D - S), S = mu N/K_s = 0.27."""
    rock, joint = run.input.rock("rock"), run.input.joints[0]
    N = 0.1 * (rock["lam"] + 2 * rock["G"])
    far = 0.5 - joint.friction * N * (1 / rock["G"] + 1 / joint.stiffness)
    signs = np.where(np.arange(len(run.results["steps"])) % 2 == 0, 1, -1)
    shear, p = means(run, "mean_traction")[:, 0], means(run, "mean_plastic_jump")[:, 0]
    return max(np.abs(shear * signs / (joint.friction * N) - 1).max(), np.abs(p * signs / far - 1).max())


def turns(steps):
    """Radial return along a circle of radius 0.5, in so many steps a turn; it ends on the circle of the steady state of
    implicit Euler, |p| = -S sin(D/2) + sqrt(R^2 - S^2 cos^2(D/2)) for turns by D."""
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
    """A layer of height h and weight W per volume on a slope: lambda_n = -W h cos(beta), |lambda_t| = W h sin(beta)."""
    beta = math.radians(abs(run.input.number("Mesh", "rotation")))
    weight = -run.input.numbers("Bulk", "body force")[-1] * 0.5
    answers = Answers()
    answers.add(run.faces[-1].traction[:, 0], -weight * math.cos(beta), weight)
    answers.add(np.linalg.norm(run.faces[-1].traction[:, 1:], axis=1), weight * math.sin(beta), weight)
    return answers.error


def hanging(run):
    """The one face that carries a unit cube has its weight, and no shear."""
    weight = -run.input.numbers("Bulk", "body force")[-1]
    answers, traction = Answers(), run.faces[-1].traction
    answers.add(traction[:, 0].min(), -weight, weight)
    answers.add(traction[:, 1:], 0.0, weight)
    answers.add(np.sort(traction[:, 0])[1:], 0.0, weight)
    return answers.error


def uniform(stress, normals, slips):
    """A check of fractures through a block under uniform stress, by quantities that do not depend on the frame. Each
    normal is that of a fracture, in the order of names; it has slipped by slip times lambda_t."""
    def check(run):
        answers, faces = Answers(), run.faces[-1]
        for k, (normal, slip, joint) in enumerate(zip(normals, slips, run.input.joints)):
            traction = np.asarray(stress) @ normal
            N = -traction @ normal
            shear = np.linalg.norm(traction + N * np.asarray(normal))
            on, p = faces.fracture == k, slip * shear
            for values, reference in ((faces.traction[on, 0], -N), (np.linalg.norm(faces.traction[on, 1:], axis=1), shear),
                                      (faces.jump[on, 0], float(joint.closed_gap(p, -N))),
                                      (np.linalg.norm(faces.jump[on, 1:], axis=1), p + shear / joint.stiffness)):
                answers.add(values, reference, 0.1)
        return answers.error
    return check


def at_angles(*degrees):
    return [np.array([-math.sin(math.radians(a)), math.cos(math.radians(a))]) for a in degrees]
