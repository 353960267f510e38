"""What do the numbers and lengths in SVG attributes say?

Lengths are in user units: pixels of 1/96 inch before any transformation (CSS Values and Units, absolute lengths).
"""

from __future__ import annotations

import math
import re
from fractions import Fraction

from watchsim.drawing.dxf_records import LARGEST
from watchsim.drawing.svg.xml_elements import SvgError

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
INCH = Fraction(254, 10_000)
METRES = {
    "px": INCH / 96,
    "mm": Fraction(1, 1000),
    "cm": Fraction(1, 100),
    "in": INCH,
    "pt": INCH / 72,
    "pc": INCH / 6,
    "q": Fraction(1, 4000),
}
ITEM = re.compile(rf"\s*(,?)\s*({NUMBER})")
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([A-Za-z]*|%)\s*")


def finite(text: str) -> float:
    value = float(text)
    if not abs(value) <= LARGEST:
        raise SvgError(f'"{text[:40]}" is beyond any drawing')
    return value


def numbers(text: str) -> list[float]:
    """All numbers of a list with blanks or single commas between them; SvgError where there is anything else."""
    result: list[float] = []
    at = 0
    while (item := ITEM.match(text, at)) is not None:
        if item[1] and not result:
            break
        result.append(finite(item[2]))
        at = item.end()
    if text[at:].strip():
        raise SvgError(f'"{text[at : at + 20].strip()}" is not a number')
    return result


def split_length(text: str) -> tuple[float, str]:
    """The number and the unit in lower case ("" where there is none)."""
    match = _LENGTH.fullmatch(text)
    if match is None:
        raise SvgError(f'"{text[:40]}" is not a length')
    unit = match[2].lower()
    if unit and unit != "%" and unit not in METRES:
        raise SvgError(f'"{text[:40]}" is a length in a unit that cannot be known here')
    return finite(match[1]), unit


def length(text: str, whole: float) -> float:
    """A length in user units; `whole` is what 100 % stands for."""
    value, unit = split_length(text)
    if unit == "%":
        if whole == 0.0 and value != 0.0:
            raise SvgError(f'"{text[:40]}" is a part of a page whose size is not given')
        return value * whole / 100.0
    if unit in ("", "px"):
        return value
    ratio = METRES[unit] / METRES["px"]
    return value * ratio.numerator / ratio.denominator


def diagonal(width: float, height: float) -> float:
    """What 100 % of a length in no particular direction stands for."""
    return math.sqrt(0.5 * (width * width + height * height))
