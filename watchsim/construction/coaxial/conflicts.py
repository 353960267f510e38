"""Which dimensions of a co-axial escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.coaxial.dimensions import Coaxial
from watchsim.construction.coaxial.fork import GUARD_TIP, SAFETY_RADIUS, Fork
from watchsim.construction.coaxial.points import PITCH, Points
from watchsim.construction.coaxial.sheets import sheets
from watchsim.construction.design import Conflict

INSIDE = 1.0  # degrees of the balance by which the roller stone must be inside the overlap when the wheel is let go
FREE = 0.75  # degrees of the wheel by which a waiting tooth must stand outside an overlap


def conflicts(values: Coaxial) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    points = Points(values)
    if math.degrees(math.atan(values.friction)) >= values.draw:
        yield Conflict("draw", f"{values.draw:.4g}° does not hold at a friction of {values.friction:.4g}: more than {math.degrees(math.atan(values.friction)):.2f}° is needed")  # fmt: skip
    if values.undercut < values.draw + points.bank:
        yield Conflict("undercut", f"must be at least {values.draw + points.bank:.4g}°, draw and half the lever's travel, so that tips lock and not fronts")  # fmt: skip
    yield from _direct(values, points)
    yield from _indirect(values, points)
    freedom = guard_freedom(points)
    if freedom >= values.lock:
        yield Conflict("guard_clearance", f"gives the lever {freedom:.2f}° of freedom, which must be less than the lock, {values.lock:.4g}°, for draw to bring it back")  # fmt: skip
    sheets(values)


def _direct(values: Coaxial, points: Points) -> Iterator[Conflict]:
    waits = min(values.direct_lead, PITCH / 2.0 - values.direct_lead)
    if waits < values.direct_reach + FREE:
        yield Conflict("direct_reach", f"must be at most {waits - FREE:.4g}°: a waiting tooth stands {waits:.4g}° from the line of centres, and the stone has to pass it")  # fmt: skip
    at_release = points.balance_at(points.unlocked) + values.stone_lag
    if at_release > points.direct_balance - INSIDE:
        yield Conflict("stone_lag", f"must be at most {points.direct_balance - INSIDE - points.balance_at(points.unlocked):.4g}°, or the tooth passes under the stone")  # fmt: skip


def _indirect(values: Coaxial, points: Points) -> Iterator[Conflict]:
    waits = min(values.indirect_lead, PITCH / 2.0 - values.indirect_lead)
    if waits < values.indirect_reach + FREE:
        yield Conflict("indirect_reach", f"must be at most {waits - FREE:.4g}°: a waiting small tooth stands {waits:.4g}° from the line of centres, and the lever's stone has to pass it")  # fmt: skip
    first, last = values.indirect_offset - values.indirect_lever, values.indirect_offset + values.indirect_lever
    if first > -points.unlocked:
        yield Conflict("indirect_lever", f"the lever's stone comes into the small wheel's way at {first:.4g}° of the lever, after the release at {-points.unlocked:.4g}°: the tooth would pass under it")  # fmt: skip
    if last > points.let_off + 0.5 * values.run:
        yield Conflict("indirect_lever", f"the indirect impulse would last until {last:.4g}° of the lever, beyond the lock at {points.let_off:.4g}°")  # fmt: skip


def guard_freedom(points: Points) -> float:
    """Lever angle from the bank until the guard pin meets the safety roller, degrees."""
    y, d = Fork(points).guard_centre(), points.lever_to_balance
    reach = (SAFETY_RADIUS + GUARD_TIP) * points.scale
    cosine = (y * y + d * d - reach * reach) / (2.0 * y * d)
    return points.bank - math.degrees(math.acos(min(1.0, cosine)))
