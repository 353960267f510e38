"""What comes out of a file before it is chained?

The same for every format: single lines and arcs in metres, each with its layer and the name of the entity that drew it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from watchsim.drawing.findings import Finding
from watchsim.geometry.primitives import Edge


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
