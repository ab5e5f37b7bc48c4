"""Conversion of numbers with units to SI, for CSV titles, scenes and the reference."""
import re

PREFIXES = {"": 1.0, "G": 1e9, "M": 1e6, "k": 1e3, "c": 1e-2, "m": 1e-3, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "n": 1e-9}
DEGREE = 3.14159265358979323846 / 180
# factor, powers of m, kg, s, rad
SYMBOLS = {"m": (1.0, (1, 0, 0, 0)), "g": (1e-3, (0, 1, 0, 0)), "s": (1.0, (0, 0, 1, 0)), "N": (1.0, (1, 1, -2, 0)),
           "Pa": (1.0, (-1, 1, -2, 0)), "bar": (1e5, (-1, 1, -2, 0)), "J": (1.0, (2, 1, -2, 0)),
           "L": (1e-3, (3, 0, 0, 0)), "rad": (1.0, (0, 0, 0, 1))}
WHOLE = {"-": (1.0, (0, 0, 0, 0)), "": (1.0, (0, 0, 0, 0)), "1": (1.0, (0, 0, 0, 0)), "%": (1e-2, (0, 0, 0, 0)),
         "min": (60.0, (0, 0, 1, 0)), "h": (3600.0, (0, 0, 1, 0)), "d": (86400.0, (0, 0, 1, 0)),
         "day": (86400.0, (0, 0, 1, 0)), "days": (86400.0, (0, 0, 1, 0)),
         **{name: (DEGREE, (0, 0, 0, 1)) for name in ("deg", "degree", "degrees", "°")}}


class UnitError(Exception):
    """Unknown unit."""


def of_symbol(text):
    if text in WHOLE:
        return WHOLE[text]
    for prefix, factor in PREFIXES.items():
        if text.startswith(prefix) and text[len(prefix):] in SYMBOLS:
            own, powers = SYMBOLS[text[len(prefix):]]
            return factor * own, powers
    raise UnitError(f'unknown unit "{text}"; known are m, g, s, N, Pa, bar, J, L and rad with a prefix, min, h, d, deg, %')


def of_unit(text):
    """Returns (factor to SI, powers of m, kg, s, rad) of a unit such as MPa, GPa/m, J/m^2, Pa*s, Pa^-1."""
    factor, powers = 1.0, (0, 0, 0, 0)
    for operator, symbol, power in re.findall(r"(^|[*/ ])([^*/^ ()]*)(?:\^(-?\d+))?", text.replace("²", "^2").strip()):
        if operator == "" and not symbol and text.strip():
            raise UnitError(f'"{text}" is not a unit')
        own, own_powers = of_symbol(symbol)
        k = int(power or 1) * (-1 if operator == "/" else 1)
        factor *= own**k
        powers = tuple(p + k * q for p, q in zip(powers, own_powers))
    return factor, powers


def number(text, unit):
    """Returns the number of a text such as `30 deg` or `2e9` in `unit`, or None, e.g. for an expression."""
    found = re.fullmatch(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*", text)
    if not found:
        return None
    if not found[2]:
        return float(found[1])
    try:
        (factor, powers), (own, own_powers) = of_unit(found[2]), of_unit(unit)
    except UnitError:
        return None
    return float(found[1]) * factor / own if powers == own_powers else None
