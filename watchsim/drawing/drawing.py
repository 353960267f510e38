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

    `units` is the name the file (or the caller) gave, None when nobody said: lengths are then what they would be in
    millimetres and a finding of severity "error" says so. `units_from` is "header", "option" or "page" (None when unknown).
    `layers` lists all visible layers with geometry. `points` are (layer, x, y). `fitted` counts curves turned into arcs and
    a bound of their deviation in metres. `drawn` is what the file holds before doubles are taken out and curves are fitted.
    `data` is the file itself, byte by byte.
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

    @property
    def profile(self) -> Profile:
        """All outlines, apart from the file; `drawing.profile.only("TEETH")` is that of one layer."""
        return Profile(self.loops, self.open_chains)
