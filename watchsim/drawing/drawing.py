"""What does a drawing hold once it is read?"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from watchsim.drawing.content import Drawn
from watchsim.drawing.findings import Finding
from watchsim.drawing.profile import Profile
from watchsim.geometry.loop import Loop


@dataclass(frozen=True)
class Drawing:
    """Everything read from one file. Lengths are metres, in the coordinates of the drawing.

    format          "dxf" or "svg"
    units           as the file (or the caller) gave it; None where neither did: lengths are then what they would be in
                    millimetres, and a finding of severity "error" says so
    units_from      "header", "option" or "page"; None when unknown
    loops           closed outlines, material on the left
    open_chains     outlines that do not close
    points          (layer, x, y) of each
    layers          all visible layers with geometry
    fitted_curves, fitted_arcs, fitted_deviation  curves followed by arcs, how many arcs, and a bound of their deviation (m)
    ignored         what was not read, by kind
    drawn           what the file holds before doubles are taken out and curves are fitted
    data            the file itself, byte by byte
    """

    path: Path
    format: str
    units: str | None
    units_from: str | None
    loops: tuple[Loop, ...]
    open_chains: tuple[Loop, ...] = ()
    points: tuple[tuple[str, float, float], ...] = ()
    layers: tuple[str, ...] = ()
    fitted_curves: int = 0
    fitted_arcs: int = 0
    fitted_deviation: float = 0.0
    ignored: dict[str, int] = field(default_factory=dict)
    drawn: Drawn = field(default_factory=Drawn)
    findings: tuple[Finding, ...] = ()
    data: bytes = field(default=b"", repr=False, compare=False)

    def __repr__(self) -> str:
        return f"<Drawing {self.path.name!r}, {len(self.findings)} findings: {self.profile!r}>"

    @property
    def profile(self) -> Profile:
        """All outlines, apart from the file; `drawing.profile.only("TEETH")` is that of one layer."""
        return Profile(self.loops, self.open_chains)
