"""How far is the impulse jewel from the wall of the slot that it comes to push?"""

from __future__ import annotations

import math

from watchsim.construction.outline import polar, turned
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.geometry.primitives import Point

MOUTH = 0.02  # mm at the first design's size: rounding between horn and slot


def gap_to_slot(design: Swiss, balance: float) -> float:
    """mm from jewel to far wall, the lever on its entry bank, the balance at `balance` degrees; negative where they overlap.

    The jewel comes from the left; the far wall is the slot's right one, which ends in the rounding of the mouth. Wall and
    rounding are the outline of all that is within `rounding` of the half line x = centre below the rounding's centre, and
    the jewel is convex, so that its least distance is to the wall, or to that centre.
    """
    rounding = MOUTH * design.lever_scale
    centre = mouth_centre(design, rounding)
    back = design.bank

    def in_lever(point: Point) -> Point:
        x, y = turned(point, balance)
        return design.in_lever((x + design.balance_pivot[0], y + design.balance_pivot[1]), back)

    right = max((in_lever(point) for point in _rightmost(design, balance - back)), key=lambda point: point[0])
    if right[1] <= centre[1]:
        return design.slot_width / 2.0 - right[0]
    x, y = design.in_movement(centre, back)
    seen = turned((x - design.balance_pivot[0], y - design.balance_pivot[1]), -balance)
    return _outside_jewel(design, seen) - rounding


def mouth_centre(design: Swiss, rounding: float) -> Point:
    """In the lever's frame: of the rounding between the right wall of the slot and the right horn (drawn with the lever on
    the exit bank)."""
    x = design.slot_width / 2.0 + rounding
    bx, by = design.balance_from_bank(-1)
    return (x, by - math.sqrt((design.horn_radius + rounding) ** 2 - (x - bx) ** 2))


def _edges(design: Swiss) -> tuple[Point, Point]:
    """Centres of the roundings of the jewel's left and right edge, in the balance's frame."""
    height = design.pin_reach - design.pin_edge
    half = math.sqrt((design.pin_radius - design.pin_edge) ** 2 - (height - design.pin_centre) ** 2)
    return (-half, -height), (half, -height)


def _rightmost(design: Swiss, angle: float) -> list[Point]:
    """Points of the jewel (balance's frame) that may be farthest to the right once it is turned by `angle` degrees."""
    left, right = _edges(design)
    found = [polar(design.pin_edge, -angle, left), polar(design.pin_edge, -angle, right)]
    round_side = polar(design.pin_radius, -angle, (0.0, -design.pin_centre))
    return [*found, *([round_side] if _on_round(design, round_side) else [])]


def _on_round(design: Swiss, point: Point) -> bool:
    """Does the point, seen from the round side's centre, lie between the two roundings on the side of the balance?"""
    (_, ey), cy = _edges(design)[1], -design.pin_centre
    ex = _edges(design)[1][0]
    limit = math.atan2(ey - cy, ex)
    angle = math.atan2(point[1] - cy, abs(point[0]))
    return angle >= limit


def _outside_jewel(design: Swiss, point: Point) -> float:
    """Distance of a point outside from the jewel, both in the balance's frame; negative inside."""
    x, y = abs(point[0]), point[1]
    ex, ey = _edges(design)[1]
    if _on_round(design, (x, y)):
        return math.hypot(x, y + design.pin_centre) - design.pin_radius
    if x <= ex:
        return -design.pin_reach - y
    return math.hypot(x - ex, y - ey) - design.pin_edge
