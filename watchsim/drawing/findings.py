"""What was wrong with the drawing or the scene?

Findings are collected, never thrown one at a time: a designer mends a drawing once, not once per fault.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.geometry.primitives import Point

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
