"""Random joints with any of the laws.

`stress` is a typical compression N. Under this stress, rock of size L slips by about N L/E before it unloads.
Softening lengths are drawn longer than this slip times the lost strength, so that a solution exists."""
import math

ANGLES = (2.0, 12.0)


def any_joint(draw, stress, share=0.5):
    """Returns the entries of a joint. `share` is the probability of each law other than the default."""
    rng = draw.rng
    slip = stress * draw.size / draw.modulus
    law = {"type": "joint"}

    def other():
        return draw.chance(share)
    friction(draw, law, stress, slip, rng.choice(("Barton-Choubey", "mobilised Barton-Choubey", "composed", "slip weakening"))
             if other() else "Coulomb")
    kinds = ["decaying angle", "limited"] + ["mobilised"] * law.get("friction", "").endswith("Barton-Choubey")
    dilation(draw, law, stress, slip, rng.choice(kinds) if other() else "constant angle")
    closure(draw, law, stress, rng.choice(("Barton-Bandis with memory", "Bandis", "power", "linear")) if other() else "Barton-Bandis")
    if draw.chance(0.7):
        law["tangential stiffness"] = draw.modulus / draw.size * draw.power(-1, 3)
        if other():
            law |= {"tangential elasticity": "power", "shear stiffening stress": stress * draw.power(-1, 1),
                    "shear stiffening exponent": rng.uniform(0.1, 1)}
    if draw.chance(0.4 * share):
        bond(draw, law, stress, slip)
    if draw.chance(0.5 * share):
        damage(draw, law, stress, slip)
    return law


def roughness(draw, law, stress):
    if "joint roughness coefficient" not in law:
        law |= {"joint roughness coefficient": draw.rng.uniform(2, 18), "joint wall strength": stress * draw.power(0.5, 2)}


def friction(draw, law, stress, slip, kind):
    rng = draw.rng
    if kind == "Coulomb":
        law["friction coefficient"] = rng.uniform(0.2, 0.9)
        return
    law["friction"] = kind
    if kind == "slip weakening":
        peak = rng.uniform(0.4, 0.9)
        residual = peak * rng.uniform(0.4, 0.95)
        law |= {"friction coefficient": peak, "residual friction coefficient": residual,
                "weakening distance": slip * (peak - residual) * draw.power(0.7, 2)}
    elif kind == "composed":
        law |= {"basic friction coefficient": rng.uniform(0.3, 0.7), "asperity angle": rng.uniform(2, 15),
                "asperity friction coefficient": rng.uniform(0, 0.3), "transition stress": stress * draw.power(-0.3, 1)}
    else:
        roughness(draw, law, stress)
        law["residual friction angle"] = rng.uniform(18, 32)
        if kind == "mobilised Barton-Choubey":
            law["peak slip"] = slip * draw.power(0.3, 1.5)


def dilation(draw, law, stress, slip, kind):
    rng = draw.rng
    if kind == "constant angle":
        if draw.chance(0.6):
            law["dilation angle"] = rng.uniform(0, 8)
        return
    law["dilation"] = kind
    if kind == "mobilised":
        roughness(draw, law, stress)
        law.setdefault("peak slip", slip * draw.power(0.3, 1.5))
        law["asperity damage coefficient"] = rng.uniform(1.3, 2.5)
        return
    law["dilation angle"] = rng.uniform(1, 10)
    if kind == "decaying angle":
        law |= {"residual dilation angle": rng.uniform(0, 0.5) * law["dilation angle"], "dilation decay distance": slip * draw.power(-1, 1.5)}
    else:
        law["largest dilation"] = slip * math.tan(math.radians(law["dilation angle"])) * draw.power(-1, 1)


def closure(draw, law, stress, kind):
    rng = draw.rng
    maximum = draw.size * draw.power(-6, -4.5)
    stiffness = stress / maximum * draw.power(-0.5, 2)
    if kind == "Barton-Bandis":
        if draw.chance(0.6):
            law |= {"normal stiffness": stiffness, "maximum closure": maximum}
        return
    law["closure"] = kind
    if kind == "Barton-Bandis with memory":
        law |= {"normal stiffness": stiffness, "maximum closure": maximum, "irrecoverable part of closure": rng.uniform(0.1, 0.8)}
    elif kind == "Bandis":
        roughness(draw, law, stress)
        law |= {"joint wall strength": rng.uniform(40e6, 150e6), "joint roughness coefficient": rng.uniform(6, 18),
                "joint aperture": rng.uniform(1.5e-4, 5e-4), "loading cycle": rng.choice((1, 3))}
    elif kind == "power":
        law |= {"normal stiffness": stiffness, "stiffening stress": stress * draw.power(-1, 1), "stiffening exponent": rng.uniform(0.1, 1.5)}
    else:
        law["normal stiffness"] = stiffness


def bond(draw, law, stress, slip):
    """Adds a bond. Fracture energies are 3 to 100 times strength^2 L/E, which the rock releases as it unloads.

    Constant cohesion decreases over an opening of ten times strength L/E: with a sudden loss there may be no equilibrium."""
    cohesion = stress * draw.power(-1.5, 0)
    if draw.chance(0.5):
        law |= {"bond": "constant cohesion", "cohesion": cohesion, "opening without cohesion": 10 * slip * cohesion / stress}
        return
    strength = cohesion * draw.rng.uniform(0.2, 0.8)
    law |= {"bond": "linear softening", "cohesion": cohesion, "tensile strength": strength,
            "fracture energy": strength * slip * strength / stress * draw.power(0.5, 2),
            "shear fracture energy": cohesion * slip * cohesion / stress * draw.power(0.5, 2)}


def damage(draw, law, stress, slip):
    rng = draw.rng
    law |= {"damage": rng.choice(("isotropic", "anisotropic")), "damage length of friction": slip * draw.power(0.3, 2),
            "residual part of friction": rng.uniform(0.5, 0.95)}
    if draw.chance(0.7):
        law |= {"damage length of dilation": slip * draw.power(0, 2), "residual part of dilation": rng.uniform(0.1, 0.95)}
    if draw.chance(0.4):
        law |= {"damage driver": rng.choice(("compression", "frictional work")), "reference stress": stress * draw.power(-0.5, 0.5)}
