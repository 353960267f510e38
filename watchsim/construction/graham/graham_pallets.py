"""What are the outlines of the anchor and its pendulum?

PALLETS are what the teeth meet: from the let-off corner over the impulse face to the locking face. ANCHOR holds them, ROD and
BOB are the pendulum; these touch nothing. In the pendulum's frame, millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.graham.graham_points import Anchor
from watchsim.construction.outline import along, angle_of, arc_between, circle, polar
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line

REACH = 16.0  # degrees, at the pivot, from the corners to the foot of a pallet
HOLD = 5.0  # degrees of it that the anchor holds
HUB, BORE, ROD = 0.16, 0.05, 0.1  # radii, and half the width of the rod, by the radius of the wheel


def pendulum(anchor: Anchor) -> list[Loop]:
    """Pallets, anchor, rod and bob."""
    values = anchor.values
    size, half = values.tip_radius, ROD * values.tip_radius
    down = [(half, 0.0), (half, -values.pendulum), (-half, -values.pendulum), (-half, 0.0)]
    rod = tuple(Line(*down[i], *down[i - 1]) for i in range(4))
    return [
        pallet(anchor, 1),
        pallet(anchor, -1),
        arms(anchor),
        circle("ANCHOR", (0.0, 0.0), BORE * size, hole=True),
        Loop(tuple(edge for edge in reversed(rod)), "ROD"),
        circle("BOB", (0.0, -values.pendulum), values.bob_radius),
    ]


def pallet(anchor: Anchor, side: int) -> Loop:
    """The entry pallet (side 1) or the exit pallet (-1), counter-clockwise."""
    locking, let_off = anchor.corners(side)
    foot = angle_of((0.0, -1.0)) - side * (anchor.half_angle_seen + REACH)
    back = polar(math.hypot(*let_off), foot)
    face = _face(anchor, side, foot)
    arc = arc_between(back, let_off, (0.0, 0.0), side > 0)
    edges: list[Edge] = [arc, Line(*let_off, *locking), face, Line(*face.end, *back)]
    loop = Loop(tuple(edges), "PALLETS")
    return loop.reversed() if side > 0 else loop


def _face(anchor: Anchor, side: int, foot: float) -> Edge:
    """The locking face from its corner to the foot."""
    locking, _ = anchor.corners(side)
    if anchor.recoil == 0.0:
        return arc_between(locking, polar(math.hypot(*locking), foot), (0.0, 0.0), side < 0)
    way = anchor.face_direction(side)
    turn = math.radians(foot - angle_of(locking)) % (2.0 * math.pi)
    turn = turn if side < 0 else 2.0 * math.pi - turn
    lean = math.radians(90.0 + side * anchor.recoil)  # between the face and the radius outwards
    length = math.hypot(*locking) * math.sin(turn) / math.sin(lean - turn)
    return Line(*locking, *along(locking, way, length))


def arms(anchor: Anchor) -> Loop:
    """A bow over the pivot from foot to foot."""
    size = anchor.values.tip_radius
    half = anchor.half_angle_seen + REACH - HOLD
    radii = [math.hypot(*anchor.corners(side)[0]) for side in (1, -1)]
    outer, inner = max(radii), min(radii)
    left, right = 270.0 - half, 270.0 + half
    hub = HUB * size
    edges: list[Edge] = [
        Line(*polar(outer, right), *polar(1.6 * hub, 90.0 - half / 2.0)),
        arc_between(polar(1.6 * hub, 90.0 - half / 2.0), polar(1.6 * hub, 90.0 + half / 2.0), (0.0, 0.0), True),
        Line(*polar(1.6 * hub, 90.0 + half / 2.0), *polar(outer, left)),
        Line(*polar(outer, left), *polar(inner, left)),
        Line(*polar(inner, left), *polar(hub, 270.0)),
        Line(*polar(hub, 270.0), *polar(inner, right)),
        Line(*polar(inner, right), *polar(outer, right)),
    ]
    return Loop(tuple(edges), "ANCHOR")
