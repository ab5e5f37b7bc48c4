"""Readable numbers with units."""
import math

PREFIXED = {
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1, "Pa")),
    "Pa/m": ((1e9, "GPa/m"), (1e6, "MPa/m"), (1e3, "kPa/m"), (1, "Pa/m")),
    "m": ((1e3, "km"), (1, "m"), (1e-3, "mm"), (1e-6, "µm")),
    "s": ((86400, "d"), (3600, "h"), (60, "min"), (1, "s"), (1e-3, "ms")),
    "J": ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ"), (1, "J")),
}
RATES = {"fluid": ("m³/s", "m²/s"), "heat": ("W", "W/m")}  # in 3D, and per depth in 2D
MINIMUM = 0.5, {"s": 2, "m": 0.8}  # smallest number in a unit
ROUND = {"m": ("km",)}  # not selected for other lengths


def unit_of(largest, base):
    """Returns (factor, unit) that makes the largest of several numbers readable."""
    for factor, name in PREFIXED.get(base, ((1, base),)):
        if largest >= MINIMUM[1].get(base, MINIMUM[0]) * factor and name not in ROUND.get(base, ()):
            return factor, name
    return PREFIXED[base][-1] if largest > 0 and base in PREFIXED else (1, base)


def number(value):
    """Returns the number with at most four significant digits."""
    if value is None or isinstance(value, float) and not math.isfinite(value):
        return "–"
    text = f"{value:.4g}"
    if "e" in text:
        digits, power = text.split("e")
        return f"{digits.replace('-', '−')} × 10{''.join('⁰¹²³⁴⁵⁶⁷⁸⁹'[int(d)] if d.isdigit() else '⁻' for d in str(int(power)))}"
    return text.replace("-", "−")


def quantity(value, base=""):
    """Returns a number with its unit."""
    if value is None:
        return "–"
    factor, unit = unit_of(abs(value), base) if base else (1, "")
    return f"{number(value / factor)} {unit}".strip()


def in_unit(text, unit):
    """Returns the text of an entry with its unit: numbers and lists of numbers in a readable unit."""
    unit = "" if unit == "-" else unit
    words = [word.strip() for word in text.strip("{} ").split(",")] if text.startswith("{") else [text]
    try:
        values = [float(word) for word in words]
    except ValueError:
        return f"{text} {unit}".strip() if unit and text not in ("infinite", "free") else text
    factor, name = unit_of(max(map(abs, values)), unit) if unit else (1, "")
    inner = ", ".join(number(value / factor) for value in values)
    return f"{f'({inner})' if text.startswith('{') else inner} {name}".strip()
