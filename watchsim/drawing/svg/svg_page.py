"""How long is one unit of this SVG drawing, and where does its page put it?

Only a size of the page in a unit of length says it: width="4.3mm" viewBox="0 0 4.3 4.3" is a drawing in millimetres. Numbers
without a unit are none: they size a picture on a screen.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeVar

from watchsim.drawing.curves.affine import Affine
from watchsim.drawing.findings import Finding
from watchsim.drawing.length_units import named_length
from watchsim.drawing.svg.number_text import METRES, split_length
from watchsim.drawing.svg.transforms import Box, fitted, plane, view_box
from watchsim.drawing.svg.xml_elements import SvgError

SPELLED = {"in": "inch", "q": "Q"}
Answer = TypeVar("Answer")
SAME = 1e-9  # relative difference of two units that differ only by rounding


class Page(NamedTuple):
    """`units` (None: unknown), where they come from, the metres of one, the map from the root's user units to these (y up).

    `width` and `height` are those of the root's viewport in its user units. An `empty` page shows nothing.
    """

    units: str | None
    units_from: str | None
    scale: float
    root: Affine
    width: float
    height: float
    empty: bool
    findings: tuple[Finding, ...]


class _Size(NamedTuple):
    """A side of the page: its length in `unit` ("" for a bare number); None where the page leaves it open."""

    value: float
    unit: str


def page_unit(name: str) -> tuple[str, float]:
    """The unit that a caller names, with those of pages besides the usual ones; ValueError where it is none."""
    plain = name.strip().lower()
    if plain in ("px", "pt", "pc", "q"):
        return SPELLED.get(plain, plain), float(METRES[plain])
    return named_length(name)


def read_page(values: Mapping[str, str], stated: tuple[str, float] | None) -> Page:
    """The page of a drawing with these attributes of its root; `stated` is what the caller says about the unit."""
    findings: list[Finding] = []
    box = _asked(lambda: view_box(values.get("viewBox")), findings)
    width = _asked(lambda: _side(values.get("width")), findings)
    height = _asked(lambda: _side(values.get("height")), findings)
    empty = any(side is not None and side.value <= 0.0 for side in (width, height))
    unit = next((side.unit for side in (width, height) if side is not None and side.unit not in ("", "%")), "")
    if empty:
        width = height = None
    w, h = _in_unit(width, unit), _in_unit(height, unit)
    if width and height and bool(width.unit) != bool(height.unit):
        message = "the page gives only one of its sides a unit; the other is taken in pixels"
        findings.append(Finding("page", "warning", message, "Give width and height in the same unit."))
    return _page(box, (w, h), unit, stated, values.get("preserveAspectRatio"), empty, findings)


def _page(
    box: Box | None,
    sides: tuple[float | None, float | None],
    unit: str,
    stated: tuple[str, float] | None,
    aspect: str | None,
    empty: bool,
    findings: list[Finding],
) -> Page:
    pixel = float(METRES["px"] / METRES[unit]) if unit else 1.0  # in page units
    w, h = sides
    if box is None:
        sx, sy, tx, ty = pixel, pixel, 0.0, 0.0
        width, height = (side / pixel if side is not None else 0.0 for side in sides)
    else:
        if w is None and h is None:
            w, h = box.width, box.height
        w = h * box.width / box.height if w is None and h is not None else w
        h = w * box.height / box.width if h is None and w is not None else h
        assert w is not None and h is not None
        try:
            sx, sy, tx, ty = fitted(box, w, h, aspect)
        except SvgError as error:
            findings.append(Finding("damaged", "error", f"the page cannot be read: {error}"))
            sx, sy, tx, ty = fitted(box, w, h, None)
        width, height = box.width, box.height
    name, metres = (SPELLED.get(unit, unit), float(METRES[unit])) if unit else (None, 1e-3)
    if stated is not None and not (name is not None and abs(stated[1] - metres) <= SAME * metres):
        if name is not None:
            factor = stated[1] / (sx * metres)
            message = f"the page says {name}, you say {stated[0]}: everything is {factor:.6g} times as large"
            findings.append(Finding("units-overruled", "warning", message))
        name, metres, origin = stated[0], stated[1], "option"
    else:
        origin = "page"
    if name is None or origin == "option":  # a unit is then one of the drawing's own numbers
        sy, tx, ty, sx = sy / sx, tx / sx, ty / sx, 1.0
    root = plane(sx, 0.0, 0.0, -sy, tx, -ty)
    return Page(name, origin if name else None, metres, root, width, height, empty, tuple(findings))


def _asked(question: Callable[[], Answer], findings: list[Finding]) -> Answer | None:
    try:
        return question()
    except SvgError as error:
        findings.append(Finding("damaged", "error", f"the page cannot be read: {error}", "Mend the first <svg> tag."))
        return None


def _side(text: str | None) -> _Size | None:
    if text is None or text.strip() in ("", "auto"):
        return None
    value, unit = split_length(text)
    return None if unit == "%" and value > 0.0 else _Size(value, unit)


def _in_unit(side: _Size | None, unit: str) -> float | None:
    """A side of the page in the page's unit; a bare number counts pixels (or is the unit, where there is no other)."""
    if side is None:
        return None
    if side.unit == unit:
        return side.value
    ratio = METRES[side.unit or "px"] / METRES[unit]
    return side.value * ratio.numerator / ratio.denominator
