"""Displacement and body force of the manufactured solution as expressions of a scene, by symbolic differentiation.

The construction is described in exact.Manufactured; no code is shared with it."""
from functools import cache

import sympy as sp

COORDINATES = sp.symbols("x y z", real=True)
G = LAM = sp.Integer(1)
FRICTION, STIFFNESS, GAP, CLOSURE, NORMAL = sp.Rational(1, 2), 2, sp.Rational(1, 50), sp.Rational(1, 10), 5
DILATION = sp.tan(sp.Float("0.1", 30))


def stress(u, x):
    gradient = sp.Matrix(len(x), len(x), lambda i, j: sp.diff(u[i], x[j]))
    return G * (gradient + gradient.T) + LAM * gradient.trace() * sp.eye(len(x))


def displacements(dimension, N, shear, tangential, normal, more=0, size=1):
    """Displacements of side - and side + for a given jump and traction on the fracture: shear, and N on side -,
    N + more on side +."""
    x, half = COORDINATES[:dimension], sp.Rational(1, 2)
    s, last, y = x[:-1], x[-1], x[1] if dimension == 3 else 0
    h = last - half
    smooth = [size * w / 10 for w in (sp.sin(2 * x[0] + last + y), sp.cos(x[0] - 2 * last + y), sp.sin(x[0] + y - last))][:dimension]
    on = stress(smooth, x)[:, -1].subs(last, half)
    c = [(t - on[i]) / G for i, t in enumerate(shear)] + [(-N - on[dimension - 1]) / (LAM + 2 * G)]
    minus = [w + h * k for w, k in zip(smooth, c)]
    slope = [-sp.diff(normal, k) for k in s] + [-(LAM * sum(sp.diff(t, k) for t, k in zip(tangential, s)) + more) / (LAM + 2 * G)]
    return minus, [u + j + h * k for u, j, k in zip(minus, tangential + [normal], slope)]


def sides(dimension, ratio, slip, uniform=False):
    """Returns [(displacement, body force) of side -, of side +] for lambda_t = mu N ratio m, u^p = slip m; N and m
    may be uniform."""
    x, half, varies = COORDINATES[:dimension], sp.Rational(1, 2), 0 if uniform else 1
    y = x[1] if dimension == 3 else 0
    angle = half + (x[0] - y / sp.Integer(2)) * varies
    direction = [sp.cos(angle), sp.sin(angle)] if dimension == 3 else [1]
    N = (3 + sp.sin(2 * x[0] + y) * varies) / sp.Integer(5)
    shear = [FRICTION * N * ratio * m for m in direction]
    tangential = [slip * m + t / STIFFNESS for m, t in zip(direction, shear)]
    normal = GAP + DILATION * slip - CLOSURE * N / (CLOSURE * NORMAL + N)
    found = []
    for u in displacements(dimension, N, shear, tangential, normal):
        sigma = stress(u, x)
        found.append((u, [-sum(sp.diff(sigma[i, k], x[k]) for k in range(dimension)) for i in range(dimension)]))
    return found


def beside(dimension, on, leaves, conductivity, side):
    """Field in the rock with the value `on` at the side of the fracture and the outflow `leaves` from the rock
    there."""
    h = COORDINATES[dimension - 1] - sp.Rational(1, 2)
    return on * sp.cos(2 * h) + (1 if side == "above" else -1) * leaves / (2 * conductivity) * sp.sin(2 * h)


def pressures(dimension, resists, minimum=sp.Rational(1, 2), maximum=sp.Rational(-3, 10)):
    """Pressures of flow_exact.Manufactured: in the fracture, on both sides by name, and the inflow to the fracture
    from them."""
    first, y = COORDINATES[0], COORDINATES[1] if dimension == 3 else 0
    f, C = 1 + sp.sin(2 * first + y), 4 + 2 * first
    entering = {"below": minimum + sp.cos(first + 2 * y), "above": maximum + sp.sin(3 * first - y)}
    sides = {side: beside(dimension, f + g / C * resists, g, 2, side) for side, g in entering.items()}
    return f, sides, entering


def leaving(p, mobility, x):
    """-div(mobility grad p)"""
    return -sum(sp.diff(mobility * sp.diff(p, k), k) for k in x)


@cache
def flow(dimension, resists):
    """Expressions of flow_exact.Manufactured by name: pressures and sources below, above and in the fracture."""
    x = COORDINATES[:dimension]
    f, sides, entering = pressures(dimension, resists)
    found = {"fracture": f, "fracture source": leaving(f, 2 + x[0], x[:-1]) - sum(entering.values())}
    for side, p in sides.items():
        found[side], found[f"{side} source"] = p, -2 * sum(sp.diff(p, k, 2) for k in x)
    return {name: text(expression) for name, expression in found.items()}


def opening(dimension):
    """Jump of poro_exact.Opened at t = 1, tangential and normal."""
    first, y = COORDINATES[0], COORDINATES[1] if dimension == 3 else 0
    return [sp.cos(first + y) / 5, sp.sin(first - y) / 5][:dimension - 1], sp.Rational(1, 2) + sp.sin(2 * first + y) / 5


@cache
def opened(dimension):
    """Expressions of poro_exact.Opened by name: displacement, body force, pressure and source of both sides;
    pressure and source of the fracture."""
    x, alpha = COORDINATES[:dimension], ROCK["alpha"]
    f, sides, entering = pressures(dimension, 0)
    tangential, normal = opening(dimension)
    source = normal + TIME * leaving(f, (1 + TIME * normal)**3 / 6, x[:-1]) - TIME * sum(entering.values())
    found = {"fracture": text(TIME * f), "fracture source": text(source)}
    for (side, p), u in zip(sides.items(), displacements(dimension, (1 - alpha) * f, [0] * (dimension - 1), tangential, normal)):
        stored = alpha * sum(sp.diff(a, k) for a, k in zip(u, x)) + ROCK["growth"] * p
        found[side], found[f"{side} source"] = text(TIME * p), text(stored + TIME * leaving(p, 2, x))
        found[f"{side} displacement"], found[f"{side} force"] = ([text(TIME * a) for a in of] for of in (u, body_force(u, x, p)))
    return found


HEAT = {"conductivity": 3, "capacity": 2, "of filling": 1, "in fracture": 2, "expansion": sp.Rational(1, 20), "of fluid expansion": sp.Rational(1, 10),
        "start": 3, "dilation": sp.Rational(1, 5)}


@cache
def warmed(dimension, carried):
    """Expressions of heat_exact.Sliding by name: as in opened(), with temperatures of rock and fracture, and heat
    sources."""
    x, half, y, t = COORDINATES[:dimension], sp.Rational(1, 2), COORDINATES[1] if dimension == 3 else 0, TIME
    s, c, conducts = x[:-1], carried, 2 * HEAT["in fracture"]  # conductance of half of the fracture, per area
    alpha, beta, stiffness = ROCK["alpha"], HEAT["expansion"], 3 * LAM + 2 * G
    N, slip = t * (3 + sp.sin(2 * x[0] + y)) / 5, t * (4 + sp.cos(2 * x[0] + y)) / 5
    angle = half + x[0] - y / sp.Integer(2)
    along = [sp.cos(angle), sp.sin(angle)] if dimension == 3 else [1]
    shear = [FRICTION * N * m for m in along]
    jump = [slip * m + T / STIFFNESS for m, T in zip(along, shear)]
    aperture = 1 + HEAT["dilation"] * slip
    f, sides, entering = pressures(dimension, 0, sp.Rational(3, 2), sp.Integer(-2))
    warm, excess = t * (2 + sp.sin(2 * x[0] - y)), {"below": t * (1 + x[0]) / 2}
    # heat flux into the fracture per excess
    carries = {"below": conducts + c * t * entering["below"], "above": conducts}
    leaves = leaving(t * f, aperture**3 / 6, s)
    flow = [-aperture**3 / 6 * t * sp.diff(f, k) for k in s]
    power = (FRICTION - HEAT["dilation"]) * N * sp.diff(slip, t)
    needs = (HEAT["of filling"] * aperture * sp.diff(warm, t) + c * sum(q * sp.diff(warm, k) for q, k in zip(flow, s))
             + leaving(warm, HEAT["in fracture"], s))
    excess["above"] = sp.expand((needs - power - carries["below"] * excess["below"]) / carries["above"])
    by_rock = {"below": conducts, "above": conducts - c * t * entering["above"]}
    T = {side: beside(dimension, warm + e, by_rock[side] * e, HEAT["conductivity"], side) for side, e in excess.items()}
    found = {"fracture": t * f, "fracture temperature": HEAT["start"] + warm,
             "fracture source": sp.diff(aperture, t) - HEAT["of fluid expansion"] * aperture * sp.diff(warm, t) + leaves - t * sum(entering.values())}
    push = N + (1 - alpha) * t * f - stiffness * beta * (warm + excess["below"])
    us = displacements(dimension, push, shear, jump, aperture - 1, stiffness * beta * (excess["below"] - excess["above"]), t)
    pores = ROCK["porosity"] * HEAT["of fluid expansion"] + (alpha - ROCK["porosity"]) * 3 * beta
    for side, u in zip(sides, us):
        p, theta = t * sides[side], T[side]
        grows = alpha * sum(sp.diff(a, k, t) for a, k in zip(u, x)) + ROCK["growth"] * sp.diff(p, t) - pores * sp.diff(theta, t)
        taken = -2 * c * sum(sp.diff(p, k) * sp.diff(theta, k) for k in x)
        found.update({side: p, f"{side} source": grows + leaving(p, 2, x), f"{side} temperature": HEAT["start"] + theta,
                      f"{side} heat": HEAT["capacity"] * sp.diff(theta, t) + taken + leaving(theta, HEAT["conductivity"], x)})
        found[f"{side} displacement"], found[f"{side} force"] = u, body_force(u, x, p + stiffness * beta / alpha * theta)
    return {name: [text(a) for a in of] if isinstance(of, list) else text(of) for name, of in found.items()}


ROCK = {"alpha": sp.Rational(1, 2), "porosity": sp.Rational(1, 10), "growth": sp.Rational(3, 25), "compressibility": sp.Rational(1, 50)}
TIME = sp.symbols("t", real=True)


def body_force(u, x, p):
    """-div of the total stress."""
    total = stress(u, x) - ROCK["alpha"] * p * sp.eye(len(x))
    return [-sum(sp.diff(total[i, k], x[k]) for k in range(len(x))) for i in range(len(x))]


def fluid_source(u, x, p):
    """Expression of the fluid source for mobility 1.

    Pores grow by alpha div u + growth p; the first term counts at the reference density."""
    c, growth, slopes = ROCK["compressibility"], ROCK["growth"], [sp.diff(p, k) for k in x]
    strained = ROCK["alpha"] * sum(sp.diff(a, k, TIME) for a, k in zip(u, x))
    stored = (growth + c * (ROCK["porosity"] + growth * p)) * sp.diff(p, TIME)
    leaves = -sum(sp.diff(q, k) for q, k in zip(slopes, x)) - c * sum(q**2 for q in slopes)
    return f"{text(strained)}+exp({text(c * p)})*({text(stored + leaves)})"


@cache
def poro(dimension):
    """Expressions for displacement, body force, pressure and source of poro_exact.Manufactured times t."""
    x = COORDINATES[:dimension]
    waves, humps = [sp.sin(2 * sp.pi * k) for k in x], [k * (1 - k) for k in x]
    p = TIME * humps[0] * sp.prod(waves[1:])
    u = [p, *([TIME * waves[0] * humps[1] * waves[2]] if dimension == 3 else []), TIME * sp.prod(waves)]
    return [text(a) for a in u], [text(sp.expand(b)) for b in body_force(u, x, p)], text(p), fluid_source(u, x, p)


def text(expression):
    return str(sp.N(expression, 17)).replace("**", "^").replace(" ", "")


@cache
def expressions(dimension, regime):
    """Returns (displacement of side -, of side +, body force of side -, of side +), each a list of expressions.

    In the mixed regime, expressions have one form for x < 1/2, which sticks, and one for x > 1/2, which slips."""
    x = COORDINATES[0]
    y = COORDINATES[1] if dimension == 3 else 0
    if regime == "stick":
        forms = [sides(dimension, sp.Rational(1, 2) + sp.cos(3 * x) / 4, sp.Integer(0))]
    elif regime in ("slip", "uniform"):
        forms = [sides(dimension, sp.Integer(1), (3 + sp.cos(2 * x + y)) / 10, regime == "uniform")]
    else:
        e = x - sp.Rational(1, 2)
        forms = [sides(dimension, 1 - 8 * e**4, sp.Integer(0)), sides(dimension, sp.Integer(1), 6 * e**4)]
    def joined(side, what, i):
        texts = [text(form[side][what][i]) for form in forms]
        return texts[0] if len(texts) == 1 else f"x<0.5 ? {texts[0]} : {texts[1]}"
    return [[joined(side, what, i) for i in range(dimension)] for what in (0, 1) for side in (0, 1)]
