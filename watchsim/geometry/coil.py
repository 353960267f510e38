"""What shape has a hairspring whose inner end has been turned?

For pictures. At rest it is an Archimedean spiral from collet to stud. Turned, it keeps both ends and its length to first
order: the radius stays linear in the share of the way but for a bulge k x (1 - x), so that its mean grows as the spring
unwinds and shrinks as it is wound up: it breathes. A real one bends off its centre a little, too, which is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST = 0.25  # turns that are left at any rate
STEEPEST = 0.95  # of the way from collet to stud: the bulge; with more, coils would cross
PER_TURN = (24, 180)  # chords, at least and at most


@dataclass(frozen=True, slots=True)
class Coil:
    """A flat spiral about a pivot, m and rad: it leaves the collet at radius `inner` and winds counter-clockwise through so
    many `turns` to the stud, at radius `outer` in the direction `stud` of the frame that holds it. `width` is its strip's."""

    inner: float
    outer: float
    turns: float
    stud: float
    width: float

    def chords(self, deviation: float) -> int:
        """How many it takes so that none strays more than `deviation` (m) from the coil."""
        least, most = PER_TURN
        fitting = math.tau / math.sqrt(8.0 * deviation / self.outer)
        return math.ceil(min(max(fitting, least), most) * self.turns)

    def line(self, turned: float, chords: int) -> Array:
        """(chords + 1, 2) points from collet to stud, the collet `turned` (rad, counter-clockwise) from where it rests."""
        swept = max(math.tau * self.turns - turned, math.tau * LEAST)
        share = np.linspace(0.0, 1.0, 1 + chords)
        angle = self.stud - swept * (1.0 - share)
        radius = self.inner + share * (self.outer - self.inner) + self.bulge(turned) * share * (1.0 - share)
        return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))

    def bulge(self, turned: float) -> float:
        """k, m: the mean radius (inner + outer) / 2 + k / 6 times the angle wound through stays what it is at rest."""
        rest, way = math.tau * self.turns, self.outer - self.inner
        swept = max(rest - turned, math.tau * LEAST)
        return min(max(3.0 * (self.inner + self.outer) * (rest / swept - 1.0), -STEEPEST * way), STEEPEST * way)
