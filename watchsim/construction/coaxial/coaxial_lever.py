"""What is the outline of a co-axial escapement's lever?

Two locking stones and an impulse stone in the slots of a body with hub, arms and tail (ARMS), a fork with horns (FORK) and a
guard pin (GUARD). In the lever's own frame, millimetres: pivot at the origin, wheel below, balance to the right.
"""

from __future__ import annotations

import math
from itertools import pairwise

from watchsim.construction.coaxial.coaxial_fork import Fork, fork_outline, guard_pin
from watchsim.construction.coaxial.coaxial_points import FIRST, SECOND, Points
from watchsim.construction.coaxial.coaxial_stones import EDGE, lever_stone, locking_stone
from watchsim.construction.outline import circle, fillet_chain, polar, turned
from watchsim.construction.pallet_stone import Stone
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

EXPOSED = 0.27  # length of a locking stone outside its slot; of the impulse stone:
EXPOSED_IMPULSE = 0.2
SHELLAC = 0.006  # gap between stone and slot
WALL = 0.11  # metal around the slots
HUB, BORE = 0.24, 0.085
TAIL_LENGTH, TAIL_HALF, TAIL_ROOT = 1.75, 0.085, 0.13
BANKING_WAY, BANKING_RADIUS = 1.55, 0.1  # of the banking pins along the tail, from the pivot

Part = tuple[Point, float]  # a corner and its fillet


def lever(points: Points) -> list[Loop]:
    """All outlines of the lever."""
    s = points.scale
    fork = Fork(points)
    turn = math.radians(points.fork_bearing - 90.0)
    return [
        *(locking_stone(points, side).loop("LOCKING_STONES", EDGE * s) for side in (FIRST, SECOND)),
        lever_stone(points).loop("IMPULSE_STONE", EDGE * s),
        body(points, fork),
        circle("ARMS", (0.0, 0.0), BORE * s, hole=True),
        fork_outline(fork).moved(turn, (0.0, 0.0)),
        guard_pin(fork).moved(turn, (0.0, 0.0)),
    ]


def body(points: Points, fork: Fork) -> Loop:
    """Arms, tail and hub, counter-clockwise from the fork's neck."""
    s = points.scale
    first, second, middle = locking_stone(points, FIRST), locking_stone(points, SECOND), lever_stone(points)

    def ahead(way: float, right: float) -> Point:
        """A place `way` towards the balance and `right` of that line (the wheel's side)."""
        return turned((right, way), points.fork_bearing - 90.0)

    def behind(way: float, right: float) -> Point:
        return ahead(-way, right)

    wall, stem = WALL * s, fork.stem_half
    top = second.length + wall
    corners: list[Part] = [
        (ahead(fork.neck, stem), 0.0),
        (ahead(fork.neck, -stem), 0.0),
        (second.at(0.55 * second.length, second.width + wall + 0.03 * s), 0.25 * s),
        (second.at(top, second.width + wall), 0.1 * s),
        (second.at(top, -wall), 0.1 * s),
        (second.at(0.75 * second.length, -wall), 0.3 * s),
        (polar(1.25 * HUB * s, points.fork_bearing + 70.0), 0.3 * s),
        (behind(HUB * s, -TAIL_ROOT * s), 0.2 * s),
        (behind(TAIL_LENGTH * s, -TAIL_HALF * s), 0.06 * s),
        (behind(TAIL_LENGTH * s, TAIL_HALF * s), 0.06 * s),
        (behind(1.4 * HUB * s, TAIL_ROOT * s), 0.15 * s),
        (first.at(first.length + wall, first.width + 0.5 * wall), 0.25 * s),
        (first.at(first.length + wall, -wall), 0.1 * s),
        *mouth(first, EXPOSED * s, s),
        (polar(1.05 * HUB * s, 215.0), 0.2 * s),
        (middle.at(middle.length + 0.1 * s, -wall), 0.15 * s),
        *mouth(middle, EXPOSED_IMPULSE * s, s),
        (middle.at(middle.length + 0.3 * s, middle.width + wall), 0.3 * s),
        (polar(1.35 * HUB * s, points.fork_bearing - 28.0), 0.3 * s),
        (second.at(0.5 * second.length, -wall - 0.04 * s), 0.12 * s),
        *mouth(second, EXPOSED * s, s),
    ]
    places = [place for place, _ in corners]
    edges: list[Edge] = [Line(*a, *b) for a, b in pairwise([*places, places[0]])]
    return Loop(tuple(fillet_chain(edges, [radius for _, radius in [*corners[1:], corners[0]]], closed=True)), "ARMS")


def mouth(stone: Stone, exposed: float, scale: float) -> list[Part]:
    """The slot that holds a stone, from the left end of the holder's lower edge to the right one."""
    wall, near, far, end = WALL * scale, -SHELLAC * scale, stone.width + SHELLAC * scale, stone.length + SHELLAC * scale
    return [
        (stone.at(exposed, -wall), 0.04 * scale),
        (stone.at(exposed, near), 0.02 * scale),
        (stone.at(end, near), EDGE * scale),
        (stone.at(end, far), EDGE * scale),
        (stone.at(exposed, far), 0.02 * scale),
        (stone.at(exposed, stone.width + wall), 0.04 * scale),
    ]


def banking(points: Points) -> list[Loop]:
    """Two pins that the lever's tail meets at the ends of its travel, in the movement."""
    s = points.scale
    # The tail narrows along its length: the perpendicular from the pin's centre to its side.
    slope = math.atan2((TAIL_ROOT - TAIL_HALF) * s, (TAIL_LENGTH - HUB) * s)
    slope_under = math.atan2((TAIL_ROOT - TAIL_HALF) * s, (TAIL_LENGTH - 1.4 * HUB) * s)
    loops = []
    for side in (FIRST, SECOND):
        lean, start = (slope, HUB) if side == SECOND else (slope_under, 1.4 * HUB)
        half = TAIL_ROOT * s - (BANKING_WAY - start) * s * math.tan(lean)
        across = half + BANKING_RADIUS * s / math.cos(lean)
        right = across if side == FIRST else -across
        place = turned((right, -BANKING_WAY * s), points.fork_bearing - 90.0)
        loops.append(circle("PINS", points.in_movement(place, side * points.bank), BANKING_RADIUS * s))
    return loops
