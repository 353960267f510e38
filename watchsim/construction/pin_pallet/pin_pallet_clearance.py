"""How much drop does a round pin need to come in behind the tooth that it let off?

A heel lets off as it passes beneath the pin's centre, so that half of the pin is still above the tooth. While the other pin
unlocks, draw turns the wheel back, and the corner of its tooth rounds it before the wheel goes on, this one comes in.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from watchsim.construction.outline import angle_of, turned
from watchsim.construction.pin_pallet.pin_pallet_points import PinLever
from watchsim.construction.swiss_lever.swiss_lever_wheel import toe_heel_back
from watchsim.geometry.primitives import Point

STEPS = 120  # of the lever, from its bank to the let-off
MOST = 12.0  # degrees more than drawn


def drop_needed(design: PinLever) -> float:
    """Degrees of the wheel, the larger of both pins'; infinite where even a thin tooth would be in the way."""

    def least(more: float) -> float:
        return min(_clear(design, side, more) for side in (1, -1)) - design.pin

    if least(MOST) < 0.0:
        return math.inf
    if least(-MOST) > 0.0:
        return 0.0
    return design.drop_inside + float(brentq(least, -MOST, MOST, xtol=1e-9))


def _clear(design: PinLever, locks: int, more: float) -> float:
    """Least distance of the other pin's centre from the back of the tooth before it, its heel so much nearer its front corner
    than drawn; negative where the centre is still above the tooth."""
    spaces = (design.teeth * 2.0 * design.half_span / 360.0) // 1.0
    steps = (math.floor(spaces) + (0 if locks < 0 else 1)) * -locks
    found = math.inf
    for lever in np.linspace(-design.let_off, design.bank, STEPS + 1):
        heel = pushed_corner(design, locks, float(lever)) + steps * 360.0 / design.teeth - more
        centre = design.placed(-locks, locks * float(lever))
        found = min(found, _from_back(design, turned(centre, -heel)))
    return found


def pushed_corner(design: PinLever, side: int, lever: float) -> float:
    """Polar angle of the front corner of the tooth that a pin touches, by its front, its corner or its impulse face."""
    if design.front_used(side, lever) >= 0.0:
        return design.locked_corner(side, lever)
    centre, corner = design.placed(side, side * lever), (design.tip_radius, 0.0)
    away, reach = math.hypot(*centre), design.tip_radius
    cosine = (away**2 + reach**2 - design.pin**2) / (2.0 * away * reach)
    before = math.acos(cosine) if cosine < 1.0 else 0.0
    _, heel, _ = toe_heel_back(design)
    slope = angle_of(heel, corner) - 90.0  # of the impulse face's normal
    if angle_of((away * math.cos(before), -away * math.sin(before)), corner) > slope or cosine >= 1.0:
        normal = math.radians(slope)
        before = -math.acos(min(1.0, (design.pin + reach * math.cos(normal)) / away)) - normal
    return angle_of(centre) + math.degrees(before)


def _from_back(design: PinLever, centre: Point) -> float:
    """Distance from the straight part of a tooth's back, the front corner of that tooth on the x axis."""
    _, heel, back = toe_heel_back(design)
    along = np.subtract(back, heel)
    share = float(np.clip(np.dot(np.subtract(centre, heel), along) / np.dot(along, along), 0.0, 1.0))
    nearest = (heel[0] + share * along[0], heel[1] + share * along[1])
    beyond = math.atan2(centre[1], centre[0]) - math.atan2(nearest[1], nearest[0])
    return math.copysign(math.dist(centre, nearest), beyond)
