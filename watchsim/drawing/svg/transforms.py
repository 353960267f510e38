"""Where do transformations and view boxes put the points of an SVG drawing?"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

from watchsim.drawing.curves.affine import IDENTITY, Affine, cosine_sine, shifted
from watchsim.drawing.svg.number_text import NUMBER, length, numbers
from watchsim.drawing.svg.xml_elements import SvgError

TURNS = {"": 360.0, "deg": 360.0, "grad": 400.0, "rad": 2.0 * math.pi, "turn": 1.0}
ALIGNED = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
KEYWORDS = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}
_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)")
_ANGLE = re.compile(rf"\s*({NUMBER})\s*(deg|grad|rad|turn|)\s*")
_ASPECT = re.compile(r"\s*(?:defer\s+)?(?:x(Min|Mid|Max)Y(Min|Mid|Max)|none)(?:\s+(meet|slice))?\s*")


class Box(NamedTuple):
    """A view box or a viewport."""

    x: float
    y: float
    width: float
    height: float


def plane(a: float, b: float, c: float, d: float, e: float, f: float) -> Affine:
    """The map with the six numbers of SVG's matrix(): x' = ax + cy + e, y' = bx + dy + f."""
    return Affine((a, b, 0.0), (c, d, 0.0), (0.0, 0.0, 1.0), (e, f, 0.0))


def transform(text: str) -> Affine:
    """The map of a `transform` attribute; SvgError where it cannot be read."""
    result = IDENTITY
    if text.strip() == "none":
        return result
    at = 0
    while (match := _FUNCTION.match(text, at)) is not None:
        result = result.after(_function(match[1], match[2]))
        at = match.end()
    if text[at:].strip():
        raise SvgError(f'its transform has "{text[at : at + 30].strip()}", which cannot be read')
    if max(abs(number) for column in result for number in column) > 1e12:
        raise SvgError("its transform goes beyond any drawing")
    return result


def _function(name: str, arguments: str) -> Affine:
    try:
        if name in ("rotate", "skewX", "skewY"):
            return _angular(name, arguments)
        values = numbers(re.sub(r"(?<=[0-9.])px\b", "", arguments))
    except SvgError as error:
        raise SvgError(f"its transform {name}({arguments[:40]}) cannot be read: {error}") from None
    match name, len(values):
        case "matrix", 6:
            return plane(*values)
        case ("translate", 1) | ("translateX", 1):
            return shifted((values[0], 0.0, 0.0))
        case "translateY", 1:
            return shifted((0.0, values[0], 0.0))
        case "translate", 2:
            return shifted((values[0], values[1], 0.0))
        case "scale", 1:
            return plane(values[0], 0.0, 0.0, values[0], 0.0, 0.0)
        case "scale", 2:
            return plane(values[0], 0.0, 0.0, values[1], 0.0, 0.0)
        case "scaleX", 1:
            return plane(values[0], 0.0, 0.0, 1.0, 0.0, 0.0)
        case "scaleY", 1:
            return plane(1.0, 0.0, 0.0, values[0], 0.0, 0.0)
    raise SvgError(f"its transform {name}({arguments[:40]}) is not one of SVG's")


def _angular(name: str, arguments: str) -> Affine:
    """rotate, skewX and skewY: the first number is an angle, with a unit where it comes from CSS."""
    match = _ANGLE.match(arguments)
    if match is None:
        raise SvgError("there is no angle")
    turn = float(match[1]) / TURNS[match[2]]
    if not abs(turn) < 1e9:
        raise SvgError("the angle is beyond any drawing")
    c, s = cosine_sine(2.0 * math.pi * math.remainder(turn, 1.0))
    rest = numbers(arguments[match.end() :].lstrip().removeprefix(","))
    if name == "rotate" and len(rest) in (0, 2):
        x, y = rest or (0.0, 0.0)
        return plane(c, s, -s, c, x - c * x + s * y, y - s * x - c * y)
    if rest or c == 0.0:
        raise SvgError("no such slant")
    return plane(1.0, 0.0, s / c, 1.0, 0.0, 0.0) if name == "skewX" else plane(1.0, s / c, 0.0, 1.0, 0.0, 0.0)


def placed(values: Mapping[str, str], width: float, height: float) -> Affine:
    """The transformation of an element about its `transform-origin`; `width` and `height` are those of its viewport."""
    if not values.get("transform"):
        return IDENTITY
    inner = transform(values["transform"])
    origin = values.get("transform-origin", "").split()
    if not origin:
        return inner
    if values.get("transform-box", "view-box") != "view-box":
        raise SvgError("its transform is about its own box (transform-box), which is not read")
    if len(origin) > 3:
        raise SvgError("its transform-origin cannot be read")
    sides = [KEYWORDS.get(word, word) for word in (*origin, "50%")]
    if origin[0] in ("top", "bottom") or {"left", "right"}.intersection(origin[1:2]):
        sides[:2] = sides[1::-1]
    x, y = length(sides[0], width), length(sides[1], height)
    return shifted((x, y, 0.0)).after(inner).after(shifted((-x, -y, 0.0)))


def view_box(text: str | None) -> Box | None:
    """The view box; None where there is none. A box without area raises SvgError."""
    if text is None or text.strip() in ("", "none"):
        return None
    values = numbers(text)
    if len(values) != 4 or not (values[2] > 0.0 and values[3] > 0.0):
        raise SvgError(f'its viewBox "{text[:40]}" is not four numbers with a width and a height above zero')
    return Box(*values)


def fitted(box: Box, width: float, height: float, aspect: str | None) -> tuple[float, float, float, float]:
    """(sx, sy, tx, ty) so that sx·x + tx, sy·y + ty shows `box` in a viewport of that size, after preserveAspectRatio."""
    match = _ASPECT.fullmatch(aspect or "xMidYMid")
    if match is None:
        raise SvgError(f'its preserveAspectRatio "{(aspect or "")[:40]}" cannot be read')
    sx, sy = width / box.width, height / box.height
    if match[1] is not None:
        sx = sy = max(sx, sy) if match[3] == "slice" else min(sx, sy)
    tx = ALIGNED[match[1] or "Min"] * (width - sx * box.width) - sx * box.x
    ty = ALIGNED[match[2] or "Min"] * (height - sy * box.height) - sy * box.y
    return sx, sy, tx, ty
