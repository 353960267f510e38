"""What does "12 mg·cm²" mean in SI, and how is an SI number shown to people?

The only file that knows millimetres, degrees, mg·cm², µN·m, vph and s/d. Arithmetic is exact (fractions, with powers of pi
kept apart), so "28800 vph" is 4 Hz to the last bit.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from numbers import Real

Powers = tuple[int, ...]  # of metre, kilogram, second, radian, kelvin


class UnitError(ValueError):
    """A quantity that cannot be read; the message says what is wrong and what to write instead."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """A kind of quantity. `powers` lists what is accepted, `si` is the unit of the floats inside, `usual` two units to show."""

    name: str
    powers: tuple[Powers, ...]
    si: str
    usual: tuple[str, str]


@dataclass(frozen=True, slots=True)
class Unit:
    """A factor `ratio`·π^`turns` to SI, and the powers of the base units."""

    ratio: Fraction
    turns: int
    powers: Powers

    @property
    def factor(self) -> float:
        return float(self.ratio) * math.pi**self.turns

    def to_the(self, exponent: int) -> Unit:
        return Unit(self.ratio**exponent, self.turns * exponent, tuple(power * exponent for power in self.powers))

    def __mul__(self, other: Unit) -> Unit:
        powers = tuple(a + b for a, b in zip(self.powers, other.powers, strict=True))
        return Unit(self.ratio * other.ratio, self.turns + other.turns, powers)


NUMBER = Dimension("plain number", ((0, 0, 0, 0, 0),), "", ("", "%"))
RATE = Dimension("rate", ((0, 0, 0, 0, 0),), "s/s", ("ppm", "s/d"))
ANGLE = Dimension("angle", ((0, 0, 0, 1, 0),), "rad", ("rad", "°"))
SPIN = Dimension("angular velocity", ((0, 0, -1, 1, 0),), "rad/s", ("rad/s", "°/s"))
LENGTH = Dimension("length", ((1, 0, 0, 0, 0),), "m", ("inch", "mm"))
MASS = Dimension("mass", ((0, 1, 0, 0, 0),), "kg", ("g", "mg"))
TIME = Dimension("time", ((0, 0, 1, 0, 0),), "s", ("ms", "s"))
SPEED = Dimension("speed", ((1, 0, -1, 0, 0),), "m/s", ("m/s", "mm/s"))
ACCELERATION = Dimension("acceleration", ((1, 0, -2, 0, 0),), "m/s²", ("mm/s²", "m/s²"))
SPIN_UP = Dimension("angular acceleration", ((0, 0, -2, 1, 0),), "rad/s²", ("rad/s²", "°/s²"))
PRESSURE = Dimension("modulus of elasticity", ((-1, 1, -2, 0, 0),), "Pa", ("MPa", "GPa"))
DENSITY = Dimension("density", ((-3, 1, 0, 0, 0),), "kg/m³", ("kg/m³", "g/cm³"))
INERTIA = Dimension("inertia", ((2, 1, 0, 0, 0),), "kg·m²", ("g·cm²", "mg·cm²"))
TORQUE = Dimension("torque", ((2, 1, -2, 0, 0),), "N·m", ("mN·m", "µN·m"))
FORCE = Dimension("force", ((1, 1, -2, 0, 0),), "N", ("mN", "N"))
FREQUENCY = Dimension("frequency", ((0, 0, -1, 0, 0),), "Hz", ("Hz", "vph"))
ROTARY_STIFFNESS = Dimension("rotary stiffness", ((2, 1, -2, -1, 0),), "N·m/rad", ("mN·m/rad", "µN·m/rad"))
LINEAR_STIFFNESS = Dimension("stiffness", ((0, 1, -2, 0, 0),), "N/m", ("N/mm", "N/m"))
ROTARY_VISCOUS = Dimension("rotary damping", ((2, 1, -1, -1, 0), (2, 1, -1, 0, 0)), "N·m·s/rad", ("µN·m·s/rad", "nN·m·s/rad"))
LINEAR_VISCOUS = Dimension("damping", ((0, 1, -1, 0, 0),), "N·s/m", ("mN·s/m", "N·s/m"))
ROTARY_QUADRATIC = Dimension("rotary quadratic damping", ((2, 1, 0, -2, 0),), "N·m·s²/rad²", ("µN·m·s²/rad²", "nN·m·s²/rad²"))
LINEAR_QUADRATIC = Dimension("quadratic damping", ((-1, 1, 0, 0, 0),), "N·s²/m²", ("mN·s²/m²", "N·s²/m²"))
TRAVEL_PER_TURN = Dimension("travel per angle", ((1, 0, 0, -1, 0), (1, 0, 0, 0, 0)), "m/rad", ("mm/rev", "mm/rad"))
PER_LENGTH = Dimension("angle per travel", ((-1, 0, 0, 1, 0),), "rad/m", ("rev/mm", "rad/mm"))
ROTARY_CUBIC = Dimension("rotary cubic stiffness", ((2, 1, -2, -3, 0),), "N·m/rad³", ("mN·m/rad³", "µN·m/rad³"))
LINEAR_CUBIC = Dimension("cubic stiffness", ((-2, 1, -2, 0, 0),), "N/m³", ("N/mm³", "N/m³"))
TEMPERATURE = Dimension("temperature", ((0, 0, 0, 0, 1),), "°C", ("°C", "°C"))  # nothing here needs its absolute value
PER_KELVIN = Dimension("temperature coefficient", ((0, 0, 0, 0, -1),), "/K", ("ppm/K", "ppm/K"))
PER_SPEED = Dimension("rate per speed", ((-1, 0, 1, 0, 0),), "s/m", ("s/m", "s/mm"))
DIMENSIONS = (
    *(NUMBER, ANGLE, SPIN, LENGTH, MASS, TIME, SPEED, ACCELERATION, PRESSURE, DENSITY, INERTIA, TORQUE, FORCE),
    *(ROTARY_STIFFNESS, LINEAR_STIFFNESS, ROTARY_VISCOUS, LINEAR_VISCOUS, ROTARY_QUADRATIC, LINEAR_QUADRATIC, RATE),
    *(FREQUENCY, SPIN_UP),
    *(TRAVEL_PER_TURN, PER_LENGTH, ROTARY_CUBIC, LINEAR_CUBIC, TEMPERATURE, PER_KELVIN, PER_SPEED),
)

_PREFIXES = {"p": -12, "n": -9, "µ": -6, "u": -6, "m": -3, "c": -2, "d": -1, "k": 3, "M": 6, "G": 9}
_METRIC = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_PREFIXABLE: dict[str, Unit] = {
    "m": Unit(Fraction(1), 0, (1, 0, 0, 0, 0)),
    "g": Unit(Fraction(1, 1000), 0, (0, 1, 0, 0, 0)),
    "s": Unit(Fraction(1), 0, (0, 0, 1, 0, 0)),
    "N": Unit(Fraction(1), 0, (1, 1, -2, 0, 0)),
    "Nm": Unit(Fraction(1), 0, (2, 1, -2, 0, 0)),
    "Ncm": Unit(Fraction(1, 100), 0, (2, 1, -2, 0, 0)),
    "Nmm": Unit(Fraction(1, 1000), 0, (2, 1, -2, 0, 0)),
    "J": Unit(Fraction(1), 0, (2, 1, -2, 0, 0)),
    "Pa": Unit(Fraction(1), 0, (-1, 1, -2, 0, 0)),
    "Hz": Unit(Fraction(1), 0, (0, 0, -1, 0, 0)),
    "rad": Unit(Fraction(1), 0, (0, 0, 0, 1, 0)),
}
_PLAIN: dict[str, Unit] = {
    "": Unit(Fraction(1), 0, (0, 0, 0, 0, 0)),
    "%": Unit(Fraction(1, 100), 0, (0, 0, 0, 0, 0)),
    "ppm": Unit(Fraction(1, 10**6), 0, (0, 0, 0, 0, 0)),
    "°": Unit(Fraction(1, 180), 1, (0, 0, 0, 1, 0)),
    "rev": Unit(Fraction(2), 1, (0, 0, 0, 1, 0)),
    "rpm": Unit(Fraction(2, 60), 1, (0, 0, -1, 1, 0)),
    "inch": Unit(Fraction(254, 10**4), 0, (1, 0, 0, 0, 0)),
    "K": Unit(Fraction(1), 0, (0, 0, 0, 0, 1)),
    "°C": Unit(Fraction(1), 0, (0, 0, 0, 0, 1)),
    "min": Unit(Fraction(60), 0, (0, 0, 1, 0, 0)),
    "h": Unit(Fraction(3600), 0, (0, 0, 1, 0, 0)),
    "d": Unit(Fraction(86400), 0, (0, 0, 1, 0, 0)),
    "vph": Unit(Fraction(1, 7200), 0, (0, 0, -1, 0, 0)),  # a vibration is half an oscillation
    "gf": Unit(Fraction(980665, 10**8), 0, (1, 1, -2, 0, 0)),
}
PLAIN = "here a plain number is needed, without a unit"
DIGITS = 1000  # of a number as text
LONGEST = 200  # characters of a unit: "mg·cm²" has 6, and brackets cannot be nested without end
_ALIASES = {"deg": "°", "degree": "°", "degrees": "°", "in": "inch", "day": "d", "bph": "vph", "turn": "rev", "sec": "s"}
_SPELLINGS = {"μ": "µ", "−": "-", "**": "^", "⋅": "·", "*": "·", ".": "·", "\u00a0": " ", "\u202f": " ", "A/h": "vph"}
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_QUANTITY = re.compile(r"\s*([+\-−]?(?:\d+\.?\d*|\.\d+)(?:[eE][+\-−]?\d+)?)[\s\u00a0\u202f]*(.*?)\s*", re.DOTALL)
_TOKEN = re.compile(r"\s*(?:(?P<name>[A-Za-zµ°%]+)|(?P<open>\()|(?P<close>\))|(?P<divide>/)|(?P<times>·))\s*")
_EXPONENT = re.compile(r"\^?(-?\d)|([⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹])")


def parse(value: object, dimension: Dimension) -> float:
    """The SI value of a quantity such as "12 mg·cm²"; a plain number is enough only where `dimension` is NUMBER.

    Raises UnitError for a missing, unknown or unfitting unit and for what is not a finite number.
    """
    if dimension is NUMBER and (isinstance(value, bool) or not isinstance(value, (str, Real))):
        raise UnitError(f"a plain number is needed here, not {_kind(value)}")
    number, unit_text = split(value)
    unit = known_unit(unit_text, dimension)
    if dimension is not NUMBER and not unit_text:
        raise UnitError(_bare(number, dimension))
    if unit.powers not in dimension.powers:
        raise UnitError(_unfitting(value, unit, dimension))
    exact = Fraction(number) * unit.ratio
    result = float(exact) * math.pi**unit.turns if abs(exact) < Fraction(10) ** 300 else math.inf
    if not math.isfinite(result):
        raise UnitError(f"{value} is not a finite number in {dimension.si or 'floating point'}")
    return result


def split(value: object) -> tuple[str, str]:
    """The number (as text, finite) and the unit (as text, maybe empty) of a quantity; UnitError where there is no number."""
    if isinstance(value, Real) and not isinstance(value, bool):
        if isinstance(value, int) and value.bit_length() > 3 * DIGITS:  # Python refuses to write many digits
            raise UnitError(f"a whole number of {value.bit_length()} bits has more digits than any precision")
        value = repr(value) if isinstance(value, int) else repr(float(value))
        if value in ("inf", "-inf", "nan"):
            raise UnitError(f"{value} is not a finite number")
    if not isinstance(value, str):
        raise UnitError(f"a number with its unit is needed here, not {_kind(value)}")
    match = _QUANTITY.fullmatch(value)
    if match is None:
        raise UnitError(f'"{value}" does not begin with a number')
    number = match[1].replace("−", "-")
    if len(number) > DIGITS:
        raise UnitError(f"a number of {len(number)} characters has more digits than any precision")
    if not math.isfinite(float(number)):
        raise UnitError(f'"{value}" is not a finite number')
    if match[2][:1] in (",", "'", "’", "_"):
        raise UnitError(f'"{value}": write numbers with a decimal point and without separators')
    return ("0" if float(number) == 0.0 else number), match[2]


def known_unit(text: str, dimension: Dimension | None = None) -> Unit:
    """The unit of that spelling; UnitError (with an example of `dimension`) if it is not known."""
    if len(text) > LONGEST:
        raise UnitError(f'"{text[:20]}..." is not a unit known here: it has {len(text)} characters')
    try:
        return _unit(text)
    except KeyError:
        hint = f'. Write e.g. "{_example(dimension, "1")}"' if dimension else ""
        hint = f"; {PLAIN}" if dimension is NUMBER else hint
        raise UnitError(f'"{text}" is not a unit known here{hint}') from None


def pattern(dimension: Dimension, signed: bool = True, zero: bool = True) -> str:
    """A regular expression for quantities of that kind, as editors can check: every unit that is one name (of lengths, angles,
    masses, times and plain numbers only these), all that looks like a product of units; no sign, no 0 unless allowed."""
    prefixed = [mark + name for name in _PREFIXABLE for mark in ("", *_PREFIXES, "μ")]
    names = [one for one in (*_PLAIN, *_ALIASES, *prefixed, "A/h") if one and _unit(one).powers in dimension.powers]
    first, letters, marks = "A-DF-Za-df-zµμ°%", "A-Za-zµμ°%", "·⋅*./^() \u00a0\u202f⁰¹²³⁴-⁹⁻0-9−-"
    product = f"(?:[{first}][{letters}]*[{marks}]|[(/])[{letters}{marks}]*"  # e3 belongs to the number
    simple = dimension is NUMBER or all(sum(map(abs, powers)) == 1 and max(powers) == 1 for powers in dimension.powers)
    units = "|".join([*map(re.escape, sorted(names, key=len, reverse=True)), *([] if simple else [product])])
    digits = r"[0-9]+\.?[0-9]*|\.[0-9]+" if zero else r"[0-9]*[1-9][0-9]*\.?[0-9]*|[0-9]*\.[0-9]*[1-9][0-9]*"
    sign = "[+−-]?" if signed else r"\+?"
    space = "[\\s\u00a0\u202f]*"
    return f"^{space}{sign}(?:{digits})(?:[eE][+−-]?[0-9]+)?{space}(?:{units}){'?' if dimension is NUMBER else ''}{space}$"


def to(value: float, unit: str) -> float:
    """An SI value expressed in `unit`: to(0.00012, "mm") is 0.12."""
    return value / known_unit(unit).factor


def show(value: float, unit: str, digits: int = 6) -> str:
    """An SI value as text with its unit: "0.12 mm", "-270°"."""
    return _joined(f"{to(value, unit):.{digits}g}", unit)


def metric(value: float, unit: str, digits: int = 6) -> str:
    """An SI value as text in `unit` with the prefix that leaves one to three digits before the point: "3.71 µm"."""
    power = min(max(3 * math.floor(math.log10(abs(value)) / 3.0), -12), 9) if value else 0
    shown = float(f"{value / 10.0**power:.{digits}g}")
    if abs(shown) >= 1000.0 and power < 9:
        power, shown = power + 3, shown / 1000.0
    return f"{shown:.12g} {_METRIC[power]}{unit}"


def rounded(value: float, digits: int = 3) -> str:
    """To so many digits, without an exponent up to ten million."""
    return f"{float(f'{value:.{digits}g}'):.7g}"


def decimals_for(step: float) -> int:
    """Decimals that make a change of `step` visible."""
    return min(max(0, -math.floor(math.log10(step) + 1e-9)), 9) if step > 0.0 else 3


def signed(value: float, decimals: int) -> str:
    """Fixed decimals, a true minus sign, and no negative zero."""
    text = f"{value:.{decimals}f}"
    return f"−{text[1:]}" if text.startswith("-") and float(text) != 0.0 else text.lstrip("-")


def true_minus(text: str) -> str:
    """The text with true minus signs before its numbers; exponents, names and ranges stay."""
    return re.sub(r"(?<![\w.)-])-(?=\.?\d)", "−", text)


@lru_cache(maxsize=512)
def _unit(text: str) -> Unit:
    """Parses products, quotients, powers and brackets of unit names; KeyError where that fails."""
    for spelling, plain in _SPELLINGS.items():
        text = text.replace(spelling, plain)
    unit, end = _product(text, 0)
    if end != len(text):
        raise KeyError(text)
    return unit


def _product(text: str, at: int) -> tuple[Unit, int]:
    unit, sign = _PLAIN[""], 1
    while at < len(text):
        token = _TOKEN.match(text, at)
        if token is None:
            raise KeyError(text)
        if token["close"]:
            break
        if token["divide"] or token["times"]:
            sign, at = (-1 if token["divide"] else 1), token.end()
            if re.match(r"[A-Za-zµ°%(]", text[at:]) is None:
                raise KeyError(text)
            continue
        factor, at = _bracket(text, token.end()) if token["open"] else (_named(token["name"]), token.end("name"))
        exponent, at = _exponent(text, at)
        unit, sign = unit * factor.to_the(sign * exponent), 1
    return unit, at


def _bracket(text: str, at: int) -> tuple[Unit, int]:
    unit, at = _product(text, at)
    if text[at : at + 1] != ")":
        raise KeyError(text)
    return unit, at + 1


def _exponent(text: str, at: int) -> tuple[int, int]:
    match = _EXPONENT.match(text, at)
    if match is None:
        return 1, at
    return int((match[1] or match[2]).translate(_SUPERSCRIPTS)), match.end()


def _named(name: str) -> Unit:
    name = _ALIASES.get(name, name)
    if name in _PLAIN:
        return _PLAIN[name]
    if name in _PREFIXABLE:
        return _PREFIXABLE[name]
    unit = _PREFIXABLE[name[1:]]
    return Unit(unit.ratio * Fraction(10) ** _PREFIXES[name[0]], unit.turns, unit.powers)


def _bare(number: str, dimension: Dimension) -> str:
    (first, second), why = dimension.usual, ""
    if first != second:
        ratio = known_unit(first).factor / known_unit(second).factor
        pair = f"{_joined(number, first)} and {_joined(number, second)}"
        why = f": {pair} differ by a factor of {max(ratio, 1.0 / ratio):.4g}"
    return f'a bare number needs a unit here{why}. Write "{_example(dimension, number)}"'


def _unfitting(value: object, unit: Unit, dimension: Dimension) -> str:
    seen = next((d.name for d in DIMENSIONS if unit.powers in d.powers), None)
    what = f"is {_article(seen)}" if seen else "has a unit that does not fit"
    if dimension is NUMBER:
        return f'"{value}" {what}; {PLAIN}'
    return f'"{value}" {what}; here {_article(dimension.name)} is needed. Write e.g. "{_example(dimension, "1")}"'


def _example(dimension: Dimension, number: str) -> str:
    # Nobody builds a watch of 4 vph or of 28800 Hz.
    unit = "Hz" if dimension.powers == FREQUENCY.powers and abs(float(number)) < 1000.0 else dimension.usual[1]
    return _joined(number, unit)


def _joined(number: str, unit: str) -> str:
    return number + ("" if unit in ("°", "%", "") else " ") + unit


def _article(noun: str) -> str:
    return ("an " if noun[0] in "aeiou" else "a ") + noun


def _kind(value: object) -> str:
    names: dict[type, str] = {bool: "true or false", list: "a list", tuple: "a list", dict: "a table"}
    return names.get(type(value), "this")
