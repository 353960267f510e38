"""What are the outlines of a detent escapement's parts? Millimetres, each in its own frame."""

from __future__ import annotations

import math

from watchsim.construction.detent.detent_points import Points
from watchsim.construction.outline import circle, polar, rounded
from watchsim.construction.pallet_stone import Stone
from watchsim.construction.undercut_teeth import ToothForm, contour
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point

ARMS, ARM_WIDTH, RIM, HUB, BORE, WINDOW_FILLET = 4, 0.34, 4.2, 1.1, 0.35, 0.25
TABLE, STAFF = 0.86, 0.45  # of the impulse stone's reach; mm
STONE_WIDTH, STONE_LENGTH, EDGE = 0.42, 1.1, 0.05  # of the impulse stone
RELIEF = 25.0  # degrees: the end of the impulse stone behind its tip, from the circle it runs on
LOCKING_WIDTH = 0.5
BLADE = 0.06  # thickness of the passing spring
BLADE_LENGTH = 3.2
BAR, BAR_GAP = 0.4, 0.1  # breadth of the detent's bar; between it and the passing spring
HORN_RADIUS, HORN_SHORT = 0.12, 0.5  # of its end, on which the passing spring rests; by how much that is shorter
DETENT_HUB, DETENT_BORE = 0.75, 0.25
BANK_AT, BANK_RADIUS = 3.4, 0.35  # of the banking screw, from the pivot


def wheel(points: Points) -> list[Loop]:
    """Teeth with undercut fronts, windows, bore; tooth 0 has its tip on the x axis."""
    s, values = points.scale, points.values
    form = ToothForm(values.tip_radius, 5.0 * s, 0.05 * s, 0.75 * s, 40.0, 1.3 * s, 0.2 * s)
    arms = Arms(ARMS, ARM_WIDTH * s, HUB * s, RIM * s, WINDOW_FILLET * s)
    windows = [Loop(tuple(arms.window(i)), "TEETH", hole=True) for i in range(ARMS)]
    return [contour(form, values.undercut, "TEETH", values.teeth), *windows, circle("TEETH", (0.0, 0.0), BORE * s, hole=True)]


def roller(points: Points) -> list[Loop]:
    """Table and impulse stone, discharging roller and stone; at angle 0 as it stands at rest."""
    s, values = points.scale, points.values
    turn = -values.letting_go
    width = STONE_WIDTH * s
    bearing = points.stone_bearing() + turn
    stone = Stone(
        polar(points.stone_reach, bearing), bearing + 180.0, width, STONE_LENGTH * s, width * math.tan(math.radians(RELIEF))
    )
    pin = polar(points.pin_centre, points.pin_bearing() + turn)
    return [
        circle("TABLE", (0.0, 0.0), TABLE * points.stone_reach),
        circle("TABLE", (0.0, 0.0), STAFF * s, hole=True),
        stone.loop("IMPULSE_STONE", EDGE * s),
        circle("ROLLER", (0.0, 0.0), discharging_roller(points)),
        circle("ROLLER", (0.0, 0.0), STAFF * s, hole=True),
        circle("DISCHARGE", pin, values.discharge_radius),
    ]


def discharging_roller(points: Points) -> float:
    """Radius of the roller that holds the discharging stone: part of the stone stands out of it."""
    return points.pin_centre - 0.2 * points.values.discharge_radius


def _along(points: Points, corners: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """Corners (along the passing spring's face from P, to its left, fillet) in the detent's frame."""
    c, s = math.cos(math.radians(points.blade)), math.sin(math.radians(points.blade))
    return [(c * x - s * y, s * x + c * y, radius) for x, y, radius in corners]


def bar_side(points: Points) -> float:
    """Where the bar's side towards the wheel lies, to the left of the passing spring's face."""
    return -(BLADE + BAR_GAP) * points.scale


def detent(points: Points) -> list[Loop]:
    """The locking stone, the bar with its hub, and the horn at its end, on which the passing spring rests."""
    s = points.scale
    end = points.blade_reach - HORN_SHORT * s
    left, right = bar_side(points), bar_side(points) - BAR * s
    bar = _along(points, [(0.0, right, 0.0), (end, right, 0.0), (end, left, 0.0), (0.0, left, 0.0)])
    x, y, _ = _along(points, [(end - HORN_RADIUS * s, -BLADE * s - HORN_RADIUS * s, 0.0)])[0]
    corner, face = points.locking_corner(), points.face_direction()
    # Out to the middle of the bar.
    out = (math.hypot(*corner) * math.sin(math.radians(math.degrees(math.atan2(corner[1], corner[0])) - points.blade))) - left
    stone = Stone(corner, face, LOCKING_WIDTH * s, out + 0.6 * BAR * s, LOCKING_WIDTH * s * math.tan(math.radians(8.0)))
    return [
        stone.loop("STONE", EDGE * s),
        Loop(tuple(rounded(bar)), "BAR"),
        circle("HORN", (x, y), HORN_RADIUS * s),
        circle("HUB", (0.0, 0.0), DETENT_HUB * s),
        circle("HUB", (0.0, 0.0), DETENT_BORE * s, hole=True),
    ]


def root(points: Points) -> Point:
    """Where the passing spring is fixed on the detent, in its frame."""
    x, y, _ = _along(points, [(points.blade_reach - BLADE_LENGTH * points.scale, -0.5 * BLADE * points.scale, 0.0)])[0]
    return (x, y)


def passing(points: Points) -> list[Loop]:
    """The leaf, drawn from its root as it lies on the detent's horn."""
    s = points.scale
    rx, ry = root(points)
    first, last = points.blade_reach - BLADE_LENGTH * s, points.blade_reach
    corners = [(first, -BLADE * s, 0.0), (last, -BLADE * s, 0.0), (last, 0.0, 0.0), (first, 0.0, 0.0)]
    leaf = [(x - rx, y - ry, radius) for x, y, radius in _along(points, corners)]
    return [Loop(tuple(rounded(leaf)), "LEAF")]


def banking(points: Points) -> list[Loop]:
    """The screw against which the bar rests."""
    s = points.scale
    x, y, _ = _along(points, [(BANK_AT * s, bar_side(points) + BANK_RADIUS * s, 0.0)])[0]
    return [circle("SCREW", (x + points.pivot[0], y + points.pivot[1]), BANK_RADIUS * s)]
