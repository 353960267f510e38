"""What was wrong with the drawing or the scene?

Findings are collected, never thrown one at a time: a designer mends a drawing once, not once per fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from watchsim.geometry.primitives import Edge, Point
from watchsim.units import LENGTH, UnitError, known_unit

# How long is one unit of this drawing?
#
# $INSUNITS says it by a code; the caller may say it by a name.

FOOT, SURVEY_FOOT = 0.3048, 1200.0 / 3937.0
INSUNITS: dict[int, tuple[str, float]] = {
    1: ("inch", 0.0254),
    2: ("ft", FOOT),
    3: ("mile", 5280.0 * FOOT),
    4: ("mm", 1e-3),
    5: ("cm", 1e-2),
    6: ("m", 1.0),
    7: ("km", 1e3),
    8: ("microinch", 2.54e-8),
    9: ("mil", 2.54e-5),
    10: ("yard", 3.0 * FOOT),
    11: ("angstrom", 1e-10),
    12: ("nm", 1e-9),
    13: ("µm", 1e-6),
    14: ("dm", 1e-1),
    15: ("dam", 1e1),
    16: ("hm", 1e2),
    17: ("Gm", 1e9),
    18: ("au", 149597870700.0),
    19: ("light-year", 9460730472580800.0),
    20: ("parsec", 3.0856775814913673e16),
    21: ("US survey ft", SURVEY_FOOT),
    22: ("US survey inch", SURVEY_FOOT / 12.0),
    23: ("US survey yard", 3.0 * SURVEY_FOOT),
    24: ("US survey mile", 5280.0 * SURVEY_FOOT),
}


def named_length(name: str) -> tuple[str, float]:
    """The unit of that name as (usual spelling, metres); ValueError where it is not a unit of length."""
    for known, metres in INSUNITS.values():
        if name.strip() == known:
            return known, metres
    try:
        unit = known_unit(name.strip())
    except UnitError:
        raise ValueError(f'"{name}" is not a unit known here. Write "mm" or "inch"') from None
    if unit.powers not in LENGTH.powers:
        raise ValueError(f'"{name}" is not a unit of length. Write "mm" or "inch"')
    usual = {metres: known for known, metres in INSUNITS.values()}
    return usual.get(unit.factor, name.strip()), unit.factor


# What was wrong with the drawing or the scene?

ORDER = ("error", "warning", "notice")  # the gravest first


@dataclass(frozen=True, slots=True)
class Finding:
    """One observation about a drawing. `severity` is "error", "warning" or "notice"; coordinates are its own, in millimetres.

    `other_mm` is the second place of a fault between two, such as the other end of a gap.
    """

    code: str
    severity: str
    message: str
    fix: str = ""
    layer: str | None = None
    x_mm: float | None = None
    y_mm: float | None = None
    other_mm: Point | None = None

    def as_dict(self) -> dict[str, object]:
        """What `inspect --json` prints of it."""
        names = ("code", "severity", "layer", "x_mm", "y_mm", "message", "fix")
        return {name: getattr(self, name) for name in names}


# What comes out of a file before it is chained?
#
# The same for every format: single lines and arcs in metres, each with its layer and the name of the entity that drew it.


@dataclass(frozen=True, slots=True)
class Stroke:
    """One edge (metres) with its layer; `source` names the entity as CAD shows it ("ARC #4F"), for messages.

    Strokes that one entity draws in one go follow each other and share the number `run`.
    """

    edge: Edge
    layer: str
    source: str
    run: int


@dataclass(frozen=True, slots=True)
class Drawn:
    """What the file draws before anything is tidied or fitted: how many of each kind (blocks and polylines unfolded), metres.

    Kinds are line, arc, circle, ellipse, ellipse_arc and spline (also each Bézier); what has no length is not counted.
    """

    kinds: Mapping[str, int] = field(default_factory=dict)
    length: float = 0.0


@dataclass(frozen=True, slots=True)
class Inserted:
    """A block put into the drawing itself (not into another block): its name, and the strokes' first and last `run`."""

    block: str
    first: int
    last: int


@dataclass(frozen=True)
class Content:
    """Everything a reader found in one file; the fields are those of Drawing."""

    format: str = ""
    strokes: tuple[Stroke, ...] = ()
    points: tuple[tuple[str, float, float], ...] = ()
    units: str | None = None
    units_from: str | None = None
    fitted_curves: int = 0
    fitted_arcs: int = 0
    fitted_deviation: float = 0.0
    ignored: dict[str, int] = field(default_factory=dict)
    drawn: Drawn = field(default_factory=Drawn)
    inserted: tuple[Inserted, ...] = ()
    findings: tuple[Finding, ...] = ()
    data: bytes = field(default=b"", repr=False, compare=False)
