"""What are the outlines of a co-axial escapement's balance?

The table (TABLE) carries the stone of the direct impulse (IMPULSE_STONE) and the D-shaped unlocking pin (PIN); in another plane
the safety roller with its crescent (SAFETY); the balance's RIM is drawn only. In the balance's own frame, millimetres: at
angle 0 the pin points at the lever.
"""

from __future__ import annotations

import math

from watchsim.construction.balance_wheel import BalanceWheel, balance_wheel
from watchsim.construction.coaxial.coaxial_fork import CRESCENT_DEPTH, CRESCENT_HALF, PIN_GROUND, SAFETY_RADIUS, Fork
from watchsim.construction.coaxial.coaxial_points import Points
from watchsim.construction.coaxial.coaxial_stones import EDGE, roller_stone
from watchsim.construction.outline import arc_between, circle, fillet_chain, polar
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line

TABLE_RADIUS, STAFF_RADIUS = 0.93, 0.16
CRESCENT_EDGE = 0.02
ARMS = 4


def roller(points: Points) -> list[Loop]:
    """Table with the staff's hole, stone, pin, safety roller; the balance's rim."""
    s, fork = points.scale, Fork(points)
    turn = math.radians(points.fork_bearing - 90.0)
    return [
        circle("TABLE", (0.0, 0.0), _table_radius(points)),
        circle("TABLE", (0.0, 0.0), STAFF_RADIUS * s, hole=True),
        roller_stone(points).loop("IMPULSE_STONE", EDGE * s),
        pin(points, fork).moved(turn, (0.0, 0.0)),
        safety(s).moved(turn, (0.0, 0.0)),
        circle("SAFETY", (0.0, 0.0), STAFF_RADIUS * s, hole=True),
        *wheel_of(points).rim(),
    ]


def wheel_of(points: Points) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    reach = max(_table_radius(points), points.stone_reach, points.pin_reach)
    return balance_wheel(points.values.balance_inertia, reach, STAFF_RADIUS * points.scale, ARMS)


def _table_radius(points: Points) -> float:
    return TABLE_RADIUS * points.stone_reach / 1.0125


def pin(points: Points, fork: Fork) -> Loop:
    """A round pin with part of its diameter ground away: the flat looks outwards, its edges are rounded."""
    centre, radius = (0.0, -fork.pin_centre), points.values.pin_radius
    height = (1.0 - 2.0 * PIN_GROUND) * radius
    half = math.sqrt(radius**2 - height**2)
    left, right = (-half, -points.pin_reach), (half, -points.pin_reach)
    edges: list[Edge] = [Line(*left, *right), arc_between(right, left, centre, True)]
    return Loop(tuple(fillet_chain(edges, [fork.pin_edge, fork.pin_edge], closed=True)), "PIN")


def safety(scale: float) -> Loop:
    """The safety roller: a disc with a hollow for the guard pin's point."""
    radius = SAFETY_RADIUS * scale
    bottom = radius - CRESCENT_DEPTH * scale
    right, left = (polar(radius, -90.0 + side * CRESCENT_HALF) for side in (1.0, -1.0))
    half, height = right[0], -right[1]
    hollow = (half**2 + (height - bottom) ** 2) / (2.0 * (height - bottom))  # circle through both edges and the bottom
    edges: list[Edge] = [
        arc_between(right, left, (0.0, 0.0), True),
        arc_between(left, right, (0.0, -(bottom + hollow)), False),
    ]
    return Loop(tuple(fillet_chain(edges, [CRESCENT_EDGE * scale] * 2, closed=True)), "SAFETY")
