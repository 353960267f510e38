"""What was wrong with the drawing or the scene?

Findings are collected, never thrown one at a time: a designer mends a drawing once, not once per fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from watchsim.geometry.primitives import Edge, Point
from watchsim.geometry.sections import Slab
from watchsim.units import LENGTH, UnitError, known_unit

FOOT, SURVEY_FOOT = 0.3048, 1200.0 / 3937.0
# Name and metres of one unit of a drawing by its code in $INSUNITS, from 1 on; the caller may say it by the name.
UNITS = (
    *(("inch", 0.0254), ("ft", FOOT), ("mile", 5280.0 * FOOT), ("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("km", 1e3)),
    *(("microinch", 2.54e-8), ("mil", 2.54e-5), ("yard", 3.0 * FOOT), ("angstrom", 1e-10), ("nm", 1e-9), ("µm", 1e-6)),
    *(("dm", 1e-1), ("dam", 1e1), ("hm", 1e2), ("Gm", 1e9), ("au", 149597870700.0), ("light-year", 9460730472580800.0)),
    *(("parsec", 3.0856775814913673e16), ("US survey ft", SURVEY_FOOT), ("US survey inch", SURVEY_FOOT / 12.0)),
    *(("US survey yard", 3.0 * SURVEY_FOOT), ("US survey mile", 5280.0 * SURVEY_FOOT)),
)
INSUNITS: dict[int, tuple[str, float]] = dict(enumerate(UNITS, 1))


def named_length(name: str) -> tuple[str, float]:
    """The unit of that name as (usual spelling, metres); ValueError where it is not a unit of length."""
    if (metres := dict(UNITS).get(name.strip())) is not None:
        return name.strip(), metres
    try:
        unit = known_unit(name.strip())
    except UnitError:
        raise ValueError(f'"{name}" is not a unit known here. Write "mm" or "inch"') from None
    if unit.powers not in LENGTH.powers:
        raise ValueError(f'"{name}" is not a unit of length. Write "mm" or "inch"')
    usual = {metres: known for known, metres in UNITS}
    return usual.get(unit.factor, name.strip()), unit.factor


def words(text: str) -> frozenset[str]:
    """A set of words that is written as a text."""
    return frozenset(text.split())


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


def finding_at(p: Point, code: str, severity: str, message: str, fix: str = "", layer: str | None = None) -> Finding:
    """One that has a place (metres)."""
    return Finding(code, severity, message, fix, layer, 1e3 * p[0], 1e3 * p[1])


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
class Facts:
    """What is known of a drawing from its file alone. Lengths are metres, in the coordinates of the drawing.

    format          "dxf", "svg", or of a solid "stl", "obj", "glb", "3mf", "step"
    units           as the file (or the caller) gave it; None where neither did: lengths are then what they would be in
                    millimetres, and a finding of severity "error" says so
    units_from      "header", "option" or "page"; None when unknown
    points          (layer, x, y) of each
    fitted_curves, fitted_arcs, fitted_deviation  curves followed by arcs, how many arcs, and a bound of their deviation (m)
    ignored         what was not read, by kind
    drawn           what the file holds before doubles are taken out and curves are fitted
    section, slabs  of a solid: the height (m) at which it is cut, None of a drawing; and its stretches of heights
    data            the file itself, byte by byte
    """

    format: str = ""
    units: str | None = None
    units_from: str | None = None
    points: tuple[tuple[str, float, float], ...] = ()
    fitted_curves: int = 0
    fitted_arcs: int = 0
    fitted_deviation: float = 0.0
    ignored: dict[str, int] = field(default_factory=dict)
    drawn: Drawn = field(default_factory=Drawn)
    section: float | None = None
    slabs: tuple[Slab, ...] = ()
    findings: tuple[Finding, ...] = ()
    data: bytes = field(default=b"", repr=False, compare=False)


@dataclass(frozen=True)
class Content(Facts):
    """Everything a reader found in one file, before it is chained: the same for every format."""

    strokes: tuple[Stroke, ...] = ()
    inserted: tuple[Inserted, ...] = ()
