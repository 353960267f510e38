"""What are the outlines of the Swiss lever's balance and banking pins?

The table roller (TABLE) carries the D-shaped impulse pin (PIN) and, in another plane, the safety roller with its
crescent (SAFETY); only the last two touch anything, and the balance's RIM is drawn only. In the balance's own frame, the
pin towards the lever (-y) at 0; the banking pins (PINS) in movement coordinates. Millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.balance_wheel import BalanceWheel, balance_wheel
from watchsim.construction.outline import arc_between, circle, fillet_chain, polar
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line

TABLE_RADIUS, STAFF_RADIUS = 0.95, 0.16
CRESCENT_EDGE = 0.02
ARMS = 3
INERTIA = 12.0  # mg·cm², of the balance as drawn by default


def roller(design: Swiss, inertia: float) -> list[Loop]:
    """Table with the staff's hole, pin, safety roller; the rim of a balance of that inertia (mg·cm²)."""
    return [
        circle("TABLE", (0.0, 0.0), _table_radius(design)),
        circle("TABLE", (0.0, 0.0), STAFF_RADIUS * design.lever_scale, hole=True),
        pin(design),
        safety(design),
        circle("SAFETY", (0.0, 0.0), STAFF_RADIUS * design.lever_scale, hole=True),
        *wheel_of(design, inertia).rim(),
    ]


def wheel_of(design: Swiss, inertia: float) -> BalanceWheel:
    """Rim and hairspring of a balance of that inertia (mg·cm²)."""
    return balance_wheel(inertia, _table_radius(design), STAFF_RADIUS * design.lever_scale, ARMS)


def _table_radius(design: Swiss) -> float:
    return TABLE_RADIUS * design.lever_scale + design.reach_beyond


def pin(design: Swiss) -> Loop:
    """A round pin with part of its diameter ground away: the flat looks outwards, its edges are rounded."""
    centre = (0.0, -design.pin_centre)
    height = design.pin_reach - design.pin_centre
    half = math.sqrt(design.pin_radius**2 - height**2)
    left, right = (-half, -design.pin_reach), (half, -design.pin_reach)
    edges: list[Edge] = [Line(*left, *right), arc_between(right, left, centre, True)]
    return Loop(tuple(fillet_chain(edges, [design.pin_edge, design.pin_edge], closed=True)), "PIN")


def safety(design: Swiss) -> Loop:
    """The safety roller: a disc with a hollow for the dart's point."""
    radius, bottom = design.safety_radius, design.safety_radius - design.crescent_depth
    right, left = (polar(radius, -90.0 + side * design.crescent_half) for side in (1.0, -1.0))
    half, height = right[0], -right[1]
    hollow = (half**2 + (height - bottom) ** 2) / (2.0 * (height - bottom))  # circle through both edges and the bottom
    edges: list[Edge] = [
        arc_between(right, left, (0.0, 0.0), True),
        arc_between(left, right, (0.0, -(bottom + hollow)), False),
    ]
    return Loop(tuple(fillet_chain(edges, [CRESCENT_EDGE * design.lever_scale] * 2, closed=True)), "SAFETY")


def banking(design: Swiss) -> list[Loop]:
    """Two pins that the lever's stem meets at the ends of its travel."""
    reach = design.stem_half + design.banking_radius
    centres = [design.in_movement((-side * reach, design.banking_height), side * design.bank) for side in (1, -1)]
    return [circle("PINS", centre, design.banking_radius) for centre in centres]
