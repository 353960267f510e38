"""What are the outlines of the wheel, the pallets and the pendulum of a grasshopper escapement?

The nibs' faces are at right angles to their pallets: what a tooth presses there runs through the pivot, and friction keeps its
point from sliding. Lengths on a pallet are shares of a pitch, so that it clears the teeth before and behind.
"""

from __future__ import annotations

import math

from watchsim.construction.grasshopper.grasshopper_points import ENTRY, EXIT, Points
from watchsim.construction.outline import circle, polar, rounded, turned
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop

LAND, BACK, FRONT = 0.05, 0.53, 0.2  # of a pitch: the flat of a point, its back, and by how much the front is undercut
NIB, FOOT = 0.22, 0.57  # length of a nib inside the circle of the points, and to where it joins its arm
NEAR, FAR = 0.19, 0.45  # of the arm from the line through the nib, its near and far edge
PIN = 0.16  # radius of a stop; all by the pitch on the circle of the points
HELD = 0.55  # of a pallet's length: where its stop stands
ARMS, RIM, HUB = 5, 0.86, 0.16  # of the wheel: number of arms; radii by that of the points


def wheel(at: Points) -> list[Loop]:
    """Pointed teeth, undercut in front, the first point on the x axis; arms."""
    r, low, corners = at.values.tip_radius, at.values.tip_radius - at.values.height, []
    for i in range(at.values.teeth):
        first = i * at.pitch
        corners += [polar(r, first), polar(r, first + LAND * at.pitch), polar(low, first + BACK * at.pitch)]
        corners += [polar(low, first + (1.0 + FRONT) * at.pitch)]
    arms = Arms(ARMS, 0.07 * r, HUB * r, RIM * low, 0.03 * r)
    windows = [Loop(tuple(arms.window(i)), "TEETH", hole=True) for i in range(ARMS)]
    return [_polygon(corners, "TEETH"), *windows, circle("TEETH", (0.0, 0.0), 0.05 * r, hole=True)]


def pallet(at: Points, side: int) -> list[Loop]:
    """From its pivot at the origin along +x to its nib: the entry pallet is pushed there, the exit pallet pulled."""
    unit, end, deep = _unit(at), at.length, at.values.nib
    if side == ENTRY:
        nib = [(end, deep), (end - NIB * unit, deep), (end - FOOT * unit, -NEAR * unit)]
        corners = [*nib, (0.0, -NEAR * unit), (0.0, -FAR * unit), (end, -FAR * unit)]
    else:
        out = end + FOOT * unit
        nib = [(end, -deep), (end + NIB * unit, -deep), (out, NEAR * unit), (out, FAR * unit)]
        corners = [*nib, (0.0, FAR * unit), (0.0, NEAR * unit), (end, NEAR * unit)]
    hub = circle("HUB", (0.0, 0.0), 2.0 * PIN * unit)
    return [_polygon(corners if side == EXIT else corners[::-1], "PALLET"), hub]


def pendulum(at: Points) -> list[Loop]:
    """About its axis, at rest: the stops that count, the frame that carries them and the pallets, rod and bob."""
    unit, r, values = _unit(at), PIN * _unit(at), at.values
    stops = [_stop(at, side) for side in (ENTRY, EXIT)]
    pivot = (-at.arm, 0.0)
    arms = [_bar(pivot, stop, 0.6 * r, layer) for stop, layer in zip(stops, ("ENTRY_ARM", "EXIT_ARM"), strict=True)]
    bob = (0.0, -values.pendulum)
    drawn = [_bar((0.0, 0.0), pivot, 0.3 * unit, "FRAME"), *arms, _bar((0.0, 0.0), bob, 0.2 * unit, "ROD")]
    return [
        *(circle("STOPS", stop, r) for stop in stops),
        *drawn,
        circle("BOB", bob, values.bob_radius),
        circle("HUB", (0.0, 0.0), 0.6 * unit),
    ]


def arm_clearance(at: Points) -> float:
    """mm from the line through a pallet's nib to the near edge of its arm."""
    return NEAR * _unit(at)


def _stop(at: Points, side: int) -> tuple[float, float]:
    """On the far side of the pallet that lies on it."""
    beside = turned((HELD * at.length, -side * (FAR + PIN) * _unit(at)), at.stopped(side))
    return (beside[0] - at.arm, beside[1])


def _unit(at: Points) -> float:
    return math.radians(at.pitch) * at.values.tip_radius


def _bar(start: tuple[float, float], end: tuple[float, float], half: float, layer: str) -> Loop:
    """A straight bar from one point to the other."""
    long = math.dist(start, end)
    nx, ny = half * (start[1] - end[1]) / long, half * (end[0] - start[0]) / long
    (x0, y0), (x1, y1) = start, end
    return _polygon([(x0 - nx, y0 - ny), (x1 - nx, y1 - ny), (x1 + nx, y1 + ny), (x0 + nx, y0 + ny)], layer)


def _polygon(corners: list[tuple[float, float]], layer: str) -> Loop:
    return Loop(tuple(rounded([(*corner, 0.0) for corner in corners])), layer)
