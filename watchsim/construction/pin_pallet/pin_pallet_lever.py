"""What is the outline of a pin-pallet lever?

Two round pins (layer PALLETS) stand on the arms of a body with hub and stem (ARMS); fork (FORK) and dart (DART) are those of a
Swiss lever. In the lever's frame, pivot at the origin, balance above; millimetres.
"""

from __future__ import annotations

from itertools import pairwise

from watchsim.construction.outline import circle, fillet_chain, polar
from watchsim.construction.pin_pallet.pin_pallet_points import PinLever
from watchsim.construction.swiss_lever.swiss_lever_lever import BORE_RADIUS, HUB_RADIUS, dart, fork, neck_height
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

BOSS = 2.0  # half the breadth of an arm round its pin, in radii of the pin
ROOT = 0.75  # half the breadth of an arm at the hub, of the hub's radius


def pin_pallet_lever(design: PinLever) -> list[Loop]:
    """All outlines of the lever."""
    return [
        *(circle("PALLETS", design.pallet(side), design.pin) for side in (1, -1)),
        body(design),
        circle("ARMS", (0.0, 0.0), BORE_RADIUS * design.lever_scale, hole=True),
        fork(design),
        dart(design),
    ]


def body(design: PinLever) -> Loop:
    """Stem and two arms, counter-clockwise from the right end of the stem's top; one half is the other mirrored."""
    hub, half, boss = HUB_RADIUS * design.lever_scale, design.stem_half, BOSS * design.pin
    x, y = design.pallet(-1)
    way = _direction((x, y))
    right: list[tuple[Point, float]] = [
        (polar(1.2 * hub, 250.0 + 20.0), hub),
        (_beside((x, y), way, boss, -boss), 0.95 * boss),
        (_beside((x, y), way, boss, boss), 0.95 * boss),
        (_beside((0.0, 0.0), way, 1.6 * hub, ROOT * hub), 0.8 * hub),
        ((half, 2.0 * hub), hub),
        ((half, neck_height(design)), 0.0),
    ]
    left = [((-x, y), radius) for (x, y), radius in reversed(right[1:])]
    corners = [*right, *left]
    places = [place for place, _ in corners]
    edges: list[Edge] = [Line(*a, *b) for a, b in pairwise([*places, places[0]])]
    radii = [radius for _, radius in [*corners[1:], corners[0]]]
    return Loop(tuple(fillet_chain(edges, radii, closed=True, yielding=True)), "ARMS")


def _direction(point: Point) -> Point:
    length = (point[0] ** 2 + point[1] ** 2) ** 0.5
    return (point[0] / length, point[1] / length)


def _beside(point: Point, way: Point, ahead: float, left: float) -> Point:
    return (point[0] + ahead * way[0] - left * way[1], point[1] + ahead * way[1] + left * way[0])
