"""Which dimensions of a detent escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.detent.detent_dimensions import Detent
from watchsim.construction.detent.detent_outlines import STAFF
from watchsim.construction.detent.detent_points import Points
from watchsim.construction.detent.detent_sheets import sheets

THIN = 1.3  # of the staff's radius: the least that holds the discharging stone
FREE = 0.5  # degrees of the wheel by which a waiting tooth must stand outside the overlap


def conflicts(values: Detent) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    points = Points(values)
    holds = math.degrees(math.atan(values.friction))
    if holds >= values.draw:
        words = f"{values.draw:.4g}° does not hold at a friction of {values.friction:.4g}: more than {holds:.2f}° is needed"
        yield Conflict("draw", words)
    if values.undercut < values.draw + values.lock:
        words = f"must be at least {values.draw + values.lock:.4g}°, draw and lock, so that tips lock and not fronts"
        yield Conflict("undercut", words)
    if 0.5 * points.pitch < values.reach + FREE:
        words = f"must be at most {0.5 * points.pitch - FREE:.4g}°: waiting teeth stand {0.5 * points.pitch:.4g}° from the line"
        yield Conflict("reach", f"{words} of centres, and the impulse stone has to pass between them")
    if values.travel < values.lock + values.clearance:
        yield Conflict("travel", f"must be more than lock and clearance, {values.lock + values.clearance:.4g}°")
    most = (points.discharge - THIN * STAFF * points.scale) / 1.2
    if values.discharge_radius > most:
        yield Conflict(
            "discharge_radius", f"must be at most {most:.4g} mm, or the roller that holds the stone is as thin as its staff"
        )
        return
    sheets(values)
