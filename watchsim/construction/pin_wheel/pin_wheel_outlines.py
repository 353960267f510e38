"""What are the outlines of a pin-wheel escapement's wheel and pendulum?

PINS and PALLETS touch; the wheel's RIM, the ANCHOR with its two arms, ROD and BOB are drawn only. Millimetres.
"""

from __future__ import annotations

import math
from itertools import pairwise

from watchsim.construction.outline import angle_of, arc_between, circle, fillet_chain, polar
from watchsim.construction.pin_wheel.pin_wheel_points import PinAnchor
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

RIM, HUB, BORE = 0.1, 0.17, 0.04  # breadth of the rim and radii, by the pin circle
ARMS, ARM, FILLET = 6, 0.07, 0.05
BOSS, HOLE, LEG, ROD = 0.11, 0.04, 0.045, 0.05  # of the anchor: radii, half the width of its arms and of the rod


def wheel(anchor: PinAnchor) -> list[Loop]:
    """Pins on a rim with arms; pin 0 on the x axis."""
    size = anchor.values.pin_circle
    outer, inner = size + 2.0 * anchor.pin, size * (1.0 - RIM) - anchor.pin
    arms = Arms(ARMS, ARM * size, HUB * size, inner, FILLET * size)
    return [
        *(half_pin(anchor, i * 2.0 * anchor.half_pitch) for i in range(anchor.values.pins)),
        circle("RIM", (0.0, 0.0), outer),
        *(Loop(tuple(arms.window(i)), "RIM", hole=True) for i in range(ARMS)),
        circle("RIM", (0.0, 0.0), BORE * size, hole=True),
    ]


def half_pin(anchor: PinAnchor, bearing: float) -> Loop:
    """The half of a round pin that goes ahead."""
    size = anchor.values.pin_circle
    inner, outer = polar(size - anchor.pin, bearing), polar(size + anchor.pin, bearing)
    return Loop((arc_between(inner, outer, polar(size, bearing), True), Line(*outer, *inner)), "PINS")


def pendulum(anchor: PinAnchor) -> list[Loop]:
    """Pallets, anchor, rod and bob."""
    values, size = anchor.values, anchor.values.pin_circle
    half, low = ROD * size, -values.pendulum
    rod = [(-half, 0.0), (-half, low), (half, low), (half, 0.0)]
    return [
        pallet(anchor, 1),
        pallet(anchor, -1),
        arms(anchor),
        circle("ANCHOR", (0.0, 0.0), HOLE * size, hole=True),
        Loop(tuple(Line(*rod[i], *rod[(i + 1) % 4]) for i in range(4)), "ROD"),
        circle("BOB", (0.0, low), values.bob_radius),
    ]


def pallet(anchor: PinAnchor, side: int) -> Loop:
    """The lower pallet on the left (side 1) or the upper one on the right (-1): resting face, impulse face, back."""
    locking, let_off = anchor.corners(side)
    foot = angle_of(locking) - side * anchor.values.reach
    high, low = polar(math.hypot(*locking), foot), polar(math.hypot(*let_off), foot)
    edges: list[Edge] = [
        Line(*let_off, *locking),
        arc_between(locking, high, (0.0, 0.0), side < 0),
        Line(*high, *low),
        arc_between(low, let_off, (0.0, 0.0), side > 0),
    ]
    loop = Loop(tuple(edges), "PALLETS")
    return loop if side > 0 else loop.reversed()


def arms(anchor: PinAnchor) -> Loop:
    """A boss from which two arms reach down to the feet of the pallets, one on either side of the pins."""
    size = anchor.values.pin_circle
    boss, half = BOSS * size, LEG * size
    left, right = _leg(anchor, 1, half), _leg(anchor, -1, half)
    crotch = -boss - 3.0 * half
    corners: list[tuple[Point, float]] = [
        (polar(boss, 40.0), 0.6 * boss),
        (polar(boss, 140.0), 0.6 * boss),
        (left[0], 0.4 * half),
        (left[1], 0.4 * half),
        ((0.0, crotch), 0.5 * half),
        (right[1], 0.4 * half),
        (right[0], 0.4 * half),
    ]
    places = [place for place, _ in corners]
    edges: list[Edge] = [Line(*a, *b) for a, b in pairwise([*places, places[0]])]
    radii = [radius for _, radius in [*corners[1:], corners[0]]]
    return Loop(tuple(fillet_chain(edges, radii, closed=True, yielding=True)), "ANCHOR")


def _leg(anchor: PinAnchor, side: int, half: float) -> tuple[Point, Point]:
    """The outer and the inner end of an arm, at the foot of its pallet."""
    locking, let_off = anchor.corners(side)
    foot, end = angle_of(locking) - side * anchor.values.reach, math.hypot(*let_off)
    beside = math.degrees(half / end)
    return polar(end, foot - side * 1.5 * beside), polar(end, foot + side * 0.5 * beside)
