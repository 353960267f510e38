"""What are the outlines of a verge, and of the two sides of its crown wheel?"""

from __future__ import annotations

import math

from watchsim.construction.outline import circle, rounded
from watchsim.construction.verge.verge_dimensions import Verge
from watchsim.construction.verge.verge_proportions import depth, flag_length, height, pitch, start
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line, Point

AHEAD = 2  # teeth that have passed already
STAFF = 0.45  # radius of the verge's staff, in depths
THICK, THINNEST = 0.16, 0.08  # of a flag, in depths and in pitches, the smaller of the two
RIM = 1.5  # of the crown wheel below its teeth, in their heights
ARM = 200.0  # mm: reach of a foliot of 16 kg·cm²; one of another inertia is of the same shape
BAR, WEIGHT_WIDE, WEIGHT_HIGH = 0.012, 0.10, 0.20  # of its reach


def near_side(values: Verge) -> list[Loop]:
    """It runs to the right."""
    return [_rack(values, "NEAR", 0.0, 1.0)]


def far_side(values: Verge) -> list[Loop]:
    """It runs to the left, half a pitch ahead."""
    return [_rack(values, "FAR", 0.5 * pitch(values), -1.0)]


def _rack(values: Verge, layer: str, ahead: float, way: float) -> Loop:
    """Teeth whose tips lie at the depth of the wheel, in the order of their passing from right to left for `way` 1."""
    top, tall, step = -depth(values), height(values), pitch(values)
    front, back = (tall * math.tan(math.radians(angle)) for angle in (values.undercut, values.slope))
    tips = [start(values) + ahead + (AHEAD - k) * step for k in range(values.length + AHEAD)]
    points: list[Point] = []
    for tip in tips:
        # From the front's root to the tip and down the back: the front leans over by the undercut.
        points += [(tip - front, top - tall), (tip, top), (tip - back, top - tall)]
    base = top - (1.0 + RIM) * tall
    points += [
        (tips[-1] - step, top - tall),
        (tips[-1] - step, base),
        (tips[0] + 0.5 * step, base),
        (tips[0] + 0.5 * step, top - tall),
    ]
    return _closed([(way * x, y) for x, y in points], layer)


def _closed(points: list[Point], layer: str) -> Loop:
    """Counter-clockwise, whichever way the points run."""
    ends = list(zip(points, [*points[1:], points[0]], strict=True))
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in ends)
    loop = Loop(tuple(Line(*a, *b) for a, b in ends), layer)
    return loop if area > 0.0 else loop.reversed()


def verge(values: Verge) -> list[Loop]:
    """Two flags with their faces in planes through the axis, and the staff."""
    half = math.radians(0.5 * values.flag_angle)
    return [
        _flag(values, "NEAR_FLAG", half, 1.0),
        _flag(values, "FAR_FLAG", half, -1.0),
        circle("STAFF", (0.0, 0.0), STAFF * depth(values)),
    ]


def foliot(values: Verge) -> list[Loop]:
    """A bar across the verge with a weight near either end: drawn only, its inertia is a number."""
    reach = ARM * (values.foliot_inertia / 16.0) ** 0.2
    bar, wide, high = 0.5 * BAR * reach, 0.5 * WEIGHT_WIDE * reach, 0.5 * WEIGHT_HIGH * reach
    return [
        _box("FOLIOT", 0.0, reach, bar),
        *(_box("WEIGHTS", side * (reach - 2.0 * wide), wide, high) for side in (-1.0, 1.0)),
    ]


def _box(layer: str, x: float, half: float, tall: float) -> Loop:
    """A plate with rounded corners about (x, 0), so wide and so high to either side."""
    corner = 0.4 * min(half, tall)
    corners = ((-half, -tall), (half, -tall), (half, tall), (-half, tall))
    return Loop(tuple(rounded([(x + dx, dy, corner) for dx, dy in corners])), layer)


def _flag(values: Verge, layer: str, angle: float, side: float) -> Loop:
    """A plate from the staff downwards, its face towards the teeth that come; `side` 1: they come from the left."""
    long, thick = flag_length(values), min(THICK * depth(values), THINNEST * pitch(values))
    points = [(0.0, 0.0), (0.0, -long), (thick, -long + 0.5 * thick), (thick, 0.0)]
    c, s = math.cos(angle), math.sin(angle)
    return _closed([(side * (c * x - s * y), s * x + c * y) for x, y in points], layer)
