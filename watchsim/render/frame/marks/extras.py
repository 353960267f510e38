"""What does a picture show besides the mechanism, if asked?"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass

from watchsim.analysis.timing.phases import Phase


@dataclass(frozen=True)
class Extras:
    """insets  places to enlarge (see `insets`)
    strip   the body whose angle and velocity run below the mechanism; None: no strip
    phases  of the beats, in order: named, and shaded in the strip
    force   N: the force that the longest arrow stands for; 0: no arrows
    scale   N: a round force, for the key of the arrows
    """

    insets: tuple[str, ...] = ()
    strip: str | None = None
    phases: tuple[Phase, ...] = ()
    force: float = 0.0
    scale: float = 0.0

    def phase_at(self, t: float) -> str:
        """The name of the phase at `t` (s); empty where none is known."""
        k = bisect_right(self.phases, t, key=lambda phase: phase.start) - 1
        return self.phases[k].name if k >= 0 and t < self.phases[k].end else ""


NOTHING = Extras()
STRIP_WIDE, STRIP_TALL = 0.27, 0.2  # share of a wide and of a tall picture's height that the strip takes
ARROW = 0.15  # of the smaller side of the room: the longest arrow
