"""At which amplitude does an oscillation end as it began?

Orbits of a smooth map of one number run monotonically to the next fixed point, or out of the region where the mechanism works
as it should. So the search goes where the map goes, by Newton's steps with slopes between the last two points, and keeps
brackets.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from watchsim.analysis.verdicts.verdict_kinds import UNSETTLED
from watchsim.studies.limit_cycle.return_map import Return

EXACT = 2e-14  # of the amplitude: less than rounding
ENOUGH = 1e-10  # of the amplitude: what must be reached
MOST = 60  # oscillations
FARTHEST = 0.5  # of the amplitude, in one step
EDGE = 2e-3  # of the amplitude: how closely the end of the region is looked for
LEAST = 1e-3  # of the first amplitude: smaller swings are none


class Fixed(NamedTuple):
    """The fixed point, what is left of its residual, and the slope of the map there as the search saw it."""

    amplitude: float
    residual: float
    slope: float


class Lost(NamedTuple):
    """No fixed point on the way: at `amplitude` there is `trouble`; `rising` where that lies above the start."""

    amplitude: float
    trouble: str
    rising: bool


def fixed_point(oscillate: Callable[[float], Return], start: float) -> Fixed | Lost:
    """The fixed point that the orbit from `start` runs to."""
    first = oscillate(start)
    if first.trouble:
        return Lost(start, first.trouble, False)
    old, g_old = start, first.amplitude - start
    here = first.amplitude
    below = above = bad = None  # ends of a bracket of the fixed point, and where the mechanism does not work as it should
    slope, best = 0.0, Fixed(start, g_old, 0.0)
    below, above = (start, None) if g_old > 0.0 else (None, start)
    for _ in range(MOST):
        got = oscillate(here)
        if got.trouble:
            bad, trouble = here, got.trouble
            if abs(bad - old) <= EDGE * start:
                return Lost(bad, trouble, g_old > 0.0)
            here = 0.5 * (old + bad)
            continue
        g = got.amplitude - here
        if abs(here - old) > EXACT * start:
            slope = 1.0 + (g - g_old) / (here - old)
        if abs(g) < abs(best.residual):
            best = Fixed(here, g, slope)
        if abs(g) <= EXACT * start or (abs(g) >= abs(g_old) and abs(best.residual) <= ENOUGH * start):
            return best
        below, above = (here, above) if g > 0.0 else (below, here)
        old, g_old = here, g
        here = _next(here, g, slope, below, above, bad)
        if here < LEAST * start:
            return Lost(here, UNSETTLED, False)
    return best if abs(best.residual) <= ENOUGH * start else Lost(here, UNSETTLED, g_old > 0.0)


def _next(here: float, g: float, slope: float, below: float | None, above: float | None, bad: float | None) -> float:
    """Newton's step; within the bracket, no further than half the amplitude, and on the good side of what went wrong."""
    step = g / (1.0 - slope) if slope < 1.0 else (FARTHEST * here if g > 0.0 else -FARTHEST * here)
    step = max(-FARTHEST * here, min(FARTHEST * here, step))
    new = here + step
    if below is not None and above is not None and not min(below, above) < new < max(below, above):
        new = 0.5 * (below + above)
    if bad is not None and (bad - here) * (bad - new) <= 0.0:
        new = 0.5 * (here + bad)
    return new
