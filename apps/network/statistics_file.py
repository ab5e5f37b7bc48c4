"""Statistics of a network from a TOML file. Errors name the section, the value and the allowed values."""
import re
import tomllib
from dataclasses import dataclass

import numpy as np
import size_law
from shapes import MAXIMUM, NetworkError, frame

POSITIVE = "a positive number, at most 1e12", lambda x: 0 < x <= MAXIMUM
NOT_NEGATIVE = "a number from 0 to 1e12", lambda x: 0 <= x <= MAXIMUM
EXPONENT = "a number from -10 to 10", lambda x: -10 <= x <= 10
LOG_MEAN = "a number from -20 to 20", lambda x: -20 <= x <= 20
LOG_DEVIATION = "a positive number, at most 5", lambda x: 0 < x <= 5
SCATTER = "a number from 0 to 5", lambda x: 0 <= x <= 5
DIP = "an angle from 0 to 90 degrees", lambda x: 0 <= x <= 90
AZIMUTH = "an angle from -360 to 360 degrees", lambda x: -360 <= x <= 360
KAPPA = "a number from 0 to 1e6", lambda x: 0 <= x <= 1e6
WHOLE = "a whole number from 1 to 100000", lambda x: isinstance(x, int) and 1 <= x <= 100000
SEED = "a whole number of at least 0", lambda x: isinstance(x, int) and x >= 0
REQUIRED = object()


class Section:
    """Table of the file. `end` reports entries that were not read."""

    def __init__(self, path, place, entries):
        self.path, self.place, self.entries, self.known = path, place, entries, []

    def refuse(self, name, why):
        place = " > ".join(word for word in (self.place, name) if word)
        raise NetworkError(f"{self.path}: {place}: {why}", [self.path])

    def has(self, name):
        self.known.append(name)
        return name in self.entries

    def read(self, name, allowed, is_allowed, default=REQUIRED):
        if not self.has(name):
            if default is REQUIRED:
                self.refuse(name, f"is missing, must be {allowed}")
            return default
        value = self.entries[name]
        if not is_allowed(value):
            self.refuse(name, f"is {value!r}, must be {allowed}")
        return value

    def number(self, name, rule, default=REQUIRED):
        return self.read(name, rule[0], lambda x: is_number(x) and rule[1](x), default)

    def choice(self, name, choices, default=REQUIRED):
        return self.read(name, " or ".join(f'"{one}"' for one in choices), lambda x: x in choices, default)

    def section(self, name, allowed="a section"):
        place = f"{self.place} > {name}" if self.place else name
        return Section(self.path, place, self.read(name, allowed, lambda x: isinstance(x, dict)))

    def end(self):
        for name in self.entries:
            if name not in self.known:
                self.refuse(name, f"is unknown; the entries here are {', '.join(dict.fromkeys(self.known))}")


def is_number(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool) and abs(x) < 1e300


@dataclass
class Set:
    """Statistics of a set."""
    name: str
    number: int  # of fractures in the domain, or None
    intensity: float  # area per volume (3D) or length per area (2D) in the domain, or None
    size: size_law.SizeLaw  # radius (3D) or length (2D)
    alpha: float  # exponent of a power law, or None
    mean: np.ndarray  # pole (3D) or direction (2D), unit vector
    kappa: float
    dimension: float  # correlation dimension of the centres, or None for a Poisson process
    aperture: tuple  # (alpha, beta, sigma): alpha size^beta exp(sigma N) in m, N standard normal; or None


@dataclass
class Statistics:
    path: str
    seed: int
    box: np.ndarray  # lower and upper corner of the domain
    sets: list

    @property
    def dim(self):
        return self.box.shape[1]

    @property
    def measure(self):
        """Area (2D) or volume (3D) of the domain."""
        return np.prod(self.box[1] - self.box[0])


def read_domain(section):
    def corner(name):
        return section.read(name, "2 or 3 numbers of at most 1e12", lambda x: isinstance(x, list) and len(x) in (2, 3)
                            and all(is_number(y) and abs(y) <= MAXIMUM for y in x))
    low, high = corner("lower_corner"), corner("upper_corner")
    section.end()
    if len(low) != len(high) or not all(a < b for a, b in zip(low, high)):
        section.refuse("upper_corner", f"is {high}, must be above lower_corner, {low}, in each direction")
    return np.array([low, high], float)


def limits(section, default=REQUIRED):
    """Returns the limits of a size; None for a default."""
    minimum, maximum = (section.number(name, POSITIVE, default) for name in ("minimum", "maximum"))
    if minimum and maximum and minimum >= maximum:
        section.refuse("maximum", f"is {maximum!r}, must be above the minimum, {minimum!r}")
    return minimum, maximum


def read_size(parent, name):
    """Returns a size law and alpha, or None for other laws."""
    if is_number(parent.entries.get(name)):
        return size_law.constant(parent.number(name, POSITIVE)), None
    section, alpha = parent.section(name, "a positive number, or a section with a distribution"), None
    kind = section.choice("distribution", ("power law", "log-normal", "exponential"))
    if kind == "power law":
        alpha = section.number("alpha", EXPONENT)
        law = size_law.power_law(alpha, *limits(section))
    elif kind == "log-normal":
        mu, sigma = section.number("log_mean", LOG_MEAN), section.number("log_std", LOG_DEVIATION)
        law = size_law.log_normal(mu, sigma, *limits(section, None))
    else:
        law = size_law.exponential(section.number("mean", POSITIVE), *limits(section, None))
    section.end()
    if law.logs[-1] <= law.logs[0]:
        section.refuse("", "has no sizes between minimum and maximum")
    return law, alpha


def read_direction(section, dim):
    if dim == 2:
        return frame(section.number("strike", AZIMUTH, 0), 0)[0][:2]
    given = [name for name in ("trend", "dip_direction", "strike") if section.has(name)]
    if len(given) != 1:
        section.refuse("", "needs either trend and plunge of the pole, or dip and dip_direction, or strike and dip")
    azimuth = section.number(given[0], AZIMUTH)
    if given == ["trend"]:
        strike, dip = azimuth + 90, 90 - section.number("plunge", DIP)
    else:
        strike, dip = azimuth - (90 if given == ["dip_direction"] else 0), section.number("dip", DIP)
    return frame(strike, dip)[2]


def read_aperture(section):
    if is_number(section.entries.get("aperture")):
        return section.number("aperture", NOT_NEGATIVE), 0.0, 0.0
    if not section.has("aperture"):
        return None
    section = section.section("aperture", "a number, or a section with alpha, beta and sigma")
    found = (section.number("alpha", POSITIVE), section.number("beta", EXPONENT, 0.0),
             section.number("sigma", SCATTER, 0.0))
    section.end()
    return found


def read_set(section, name, dim):
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_ -]*", name):
        section.refuse("", "has a name with other characters than letters, digits, blanks, - and _")
    intensity = f"P{dim}{dim - 1}"
    if section.has("number") == section.has(intensity):
        section.refuse("", f"needs either \"number\" or \"{intensity}\"")
    size, alpha = read_size(section, "radius" if dim == 3 else "length")
    one = Set(name, section.number("number", WHOLE, None), section.number(intensity, POSITIVE, None), size, alpha,
              read_direction(section, dim), section.number("kappa", KAPPA),
              section.number("fractal_dimension", (f"a number above 0, at most {dim}", lambda x: 0 < x <= dim), None),
              read_aperture(section))
    section.end()
    return one


def read_statistics(path):
    try:
        with open(path, "rb") as file:
            root = Section(path, "", tomllib.load(file))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise NetworkError(f"{path}: is not a file in TOML: {error}", [path]) from None
    except OSError as error:
        raise NetworkError(f"{path}: cannot be read: {error.strerror}", [path]) from None
    seed, box, sets = root.number("seed", SEED, 1), read_domain(root.section("domain")), root.section("sets")
    root.end()
    if not sets.entries:
        sets.refuse("", "has no set")
    return Statistics(path, seed, box, [read_set(sets.section(name), name, box.shape[1]) for name in sets.entries])
