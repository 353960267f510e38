"""What is the opening between two arms of a wheel?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.outline import arc_between, fillet_chain, turned
from watchsim.geometry.primitives import Edge, Line, Point


@dataclass(frozen=True)
class Arms:
    """Straight arms between hub and rim, evenly spaced, the first along the x axis; lengths in millimetres."""

    number: int
    width: float
    hub: float  # radius
    rim: float  # inner radius
    fillet: float  # in the corners of the openings

    def window(self, i: int) -> list[Edge]:
        """The opening between arms i and i + 1, clockwise."""
        first, last = self._side(i, 1.0), self._side(i + 1, -1.0)
        chain: list[Edge] = [
            arc_between(last[1], first[1], (0.0, 0.0), False),
            Line(*first[1], *first[0]),
            arc_between(first[0], last[0], (0.0, 0.0), True),
            Line(*last[0], *last[1]),
        ]
        return fillet_chain(chain, [self.fillet] * 4, closed=True)

    def _side(self, arm: int, side: float) -> tuple[Point, Point]:
        """Where one edge of an arm leaves the hub and reaches the rim."""
        half, angle = self.width / 2.0, arm * (360.0 / self.number)
        hub, rim = (turned((math.sqrt(r * r - half * half), side * half), angle) for r in (self.hub, self.rim))
        return hub, rim
