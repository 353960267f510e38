"""How much of the drop is left once unlocking has drawn the wheel back?

A tooth has dropped on one stone, the tooth before it has just left the other. While the lever unlocks, the locking face pushes
the wheel back (the recoil that its draw asks for), and the other stone comes in behind the tooth that it let off. What the
wheel could still be turned back before the two meet is what is left of the drop; where nothing is left, the lever cannot
unlock.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from watchsim.construction.outline import along, angle_of
from watchsim.construction.swiss_lever.swiss_lever_lever import Slot
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.swiss_lever.swiss_lever_wheel import behind, toe_heel_back
from watchsim.geometry.primitives import Edge, Line, Point

PARTS = 40  # of an edge
STEPS = 8  # of the lever, from the bank to unlocked


def drop_after_recoil(design: Swiss, side: int) -> float:
    """Degrees of the wheel, while the entry (+1) or exit (-1) stone unlocks; negative where the other stone is in the way.

    The least over all places of the lever, between every point of that stone and the tooth at the same radius. Infinite where
    the stone stays outside the wheel.
    """
    tooth = _radii_and_angles(_back_of_tooth(design))
    stone = _points(_let_off_faces(design, -side))
    places = np.linspace(design.bank, design.unlocked, STEPS + 1)
    return min(_left(design, side, float(lever), tooth, stone) for lever in places)


def recoil(design: Swiss, side: int) -> float:
    """Degrees by which the wheel is turned back from the bank until it is unlocked, teeth sliding on that stone."""
    return _locked_toe(design, side, design.unlocked) - _locked_toe(design, side, design.bank)


def _left(
    design: Swiss, side: int, lever: float, tooth: tuple[NDArray[np.float64], NDArray[np.float64]], stone: Sequence[Point]
) -> float:
    pitch = 360.0 / design.teeth
    spaces = 2.0 * design.half_span / pitch
    let_off = _locked_toe(design, side, lever) + (-math.ceil(spaces) if side > 0 else math.floor(spaces)) * pitch
    placed = [design.in_movement(point, side * lever) for point in stone]
    radii, angles = tooth
    gaps = [
        angle_of(point) - let_off - float(np.interp(math.hypot(*point), radii, angles))
        for point in placed
        if radii[0] <= math.hypot(*point) <= radii[-1]
    ]
    return min(gaps, default=math.inf)


def _locked_toe(design: Swiss, side: int, lever: float) -> float:
    """Polar angle in the movement of a toe on the locking face, the lever that many degrees to the stone's own side."""
    corner = design.in_movement(design.locking_corner(side), side * lever)
    direction = design.face_direction(side) + side * lever
    middle = corner[0] * math.cos(math.radians(direction)) + corner[1] * math.sin(math.radians(direction))
    # At `unlocked` the corner is on the circle, but for rounding.
    reach = -middle + math.sqrt(max(0.0, middle**2 - math.hypot(*corner) ** 2 + design.tip_radius**2))
    return angle_of(along(corner, direction, reach))


def _back_of_tooth(design: Swiss) -> list[Edge]:
    _, heel, back = toe_heel_back(design)
    lean, hollow, _ = behind(design, back)
    return [Line(*heel, *back), *lean, hollow]


def _let_off_faces(design: Swiss, side: int) -> list[Edge]:
    """Impulse face, and the side of the stone beyond its discharge corner; in the lever's frame."""
    slot = Slot(design, side)
    return [Line(*slot.corner, *slot.end), Line(*slot.end, *slot.at(slot.exposed, slot.width))]


def _points(edges: Sequence[Edge]) -> list[Point]:
    return [edge.point(part / PARTS) for edge in edges for part in range(PARTS + 1)]


def _radii_and_angles(edges: Sequence[Edge]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """In the order of the radii; angles in degrees, from the toe."""
    points = _points(edges)
    radii, angles = np.array([math.hypot(*point) for point in points]), np.array([angle_of(point) for point in points])
    order = np.argsort(radii, kind="stable")
    return radii[order], angles[order]
