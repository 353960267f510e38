"""Which dimensions of a co-axial escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.coaxial.coaxial_dimensions import Coaxial
from watchsim.construction.coaxial.coaxial_fork import GUARD_TIP, SAFETY_RADIUS, Fork
from watchsim.construction.coaxial.coaxial_points import PITCH, Points
from watchsim.construction.coaxial.coaxial_sheets import sheets
from watchsim.construction.design import Conflict

INSIDE = 1.0  # degrees of the balance by which the roller stone must be inside the overlap when the wheel is let go
FREE = 0.75  # degrees of the wheel by which a waiting tooth must stand outside an overlap


def conflicts(values: Coaxial) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    points = Points(values)
    holds = math.degrees(math.atan(values.friction))
    if holds >= values.draw:
        words = f"{values.draw:.4g}° does not hold at a friction of {values.friction:.4g}: more than {holds:.2f}° is needed"
        yield Conflict("draw", words)
    least = values.draw + points.bank
    if values.undercut < least:
        words = f"must be at least {least:.4g}°, draw and half the lever's travel, so that tips lock and not fronts"
        yield Conflict("undercut", words)
    yield from _direct(values, points)
    yield from _indirect(values, points)
    freedom = guard_freedom(points)
    if freedom >= values.lock:
        words = f"gives the lever {freedom:.2f}° of freedom; for draw to bring it back, less than the lock, {values.lock:.4g}°"
        yield Conflict("guard_clearance", words)
    sheets(values)


def _direct(values: Coaxial, points: Points) -> Iterator[Conflict]:
    waits = min(values.direct_lead, PITCH / 2.0 - values.direct_lead)
    if waits < values.direct_reach + FREE:
        words = f"must be at most {waits - FREE:.4g}°: a waiting tooth stands {waits:.4g}° from the line of centres"
        yield Conflict("direct_reach", f"{words}, and the roller's stone has to pass it")
    latest = points.direct_balance - INSIDE - points.balance_at(points.unlocked)
    if values.stone_lag > latest:
        yield Conflict("stone_lag", f"must be at most {latest:.4g}°, or the tooth passes under the stone")


def _indirect(values: Coaxial, points: Points) -> Iterator[Conflict]:
    waits = min(values.indirect_lead, PITCH / 2.0 - values.indirect_lead)
    if waits < values.indirect_reach + FREE:
        words = f"must be at most {waits - FREE:.4g}°: a waiting small tooth stands {waits:.4g}° from the line of centres"
        yield Conflict("indirect_reach", f"{words}, and the lever's stone has to pass it")
    first, last = values.indirect_offset - values.indirect_lever, values.indirect_offset + values.indirect_lever
    if first > -points.unlocked:
        words = f"the lever's stone comes into the small wheel's way at {first:.4g}° of the lever"
        yield Conflict(
            "indirect_lever", f"{words}, after the release at {-points.unlocked:.4g}°: the tooth would pass under it"
        )
    if last > points.let_off + 0.5 * values.run:
        words = f"the indirect impulse would last until {last:.4g}° of the lever"
        yield Conflict("indirect_lever", f"{words}, beyond the lock at {points.let_off:.4g}°")


def guard_freedom(points: Points) -> float:
    """Lever angle from the bank until the guard pin meets the safety roller, degrees."""
    y, d = Fork(points).guard_centre(), points.lever_to_balance
    reach = (SAFETY_RADIUS + GUARD_TIP) * points.scale
    cosine = (y * y + d * d - reach * reach) / (2.0 * y * d)
    return points.bank - math.degrees(math.acos(min(1.0, cosine)))
