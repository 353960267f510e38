"""Which places follow from the dimensions of a verge escapement?

The verge stands in the origin, seen along its axis; the crown wheel's axis points down, so that its near side runs to the right
below the verge and its far side to the left, each as a straight rack. A tooth tip at depth h pushes a flag, whose face lies in
a plane through the axis, from one side to the other until the flag's edge lets it go. Millimetres, angles in radians.
"""

from __future__ import annotations

import math

from watchsim.construction.verge.verge_dimensions import Verge


def pitch(values: Verge) -> float:
    """Between the teeth, along the rim."""
    return math.tau * values.wheel_radius / values.teeth


def leaving(values: Verge) -> float:
    """The angle of a flag against the wheel's axis at which it lets a tooth go."""
    return math.radians(0.5 * values.flag_angle + values.lift)


def meeting(values: Verge) -> float:
    """That of the other flag at the same instant, the other way round."""
    return math.radians(0.5 * values.flag_angle - values.lift)


def depth(values: Verge) -> float:
    """h: the wheel goes half a pitch from one letting go to the next, all of it but the drop along flags."""
    return (0.5 * pitch(values) - values.drop) / (math.tan(leaving(values)) - math.tan(meeting(values)))


def flag_length(values: Verge) -> float:
    return depth(values) / math.cos(leaving(values))


def height(values: Verge) -> float:
    """Of the teeth: the flags swing clear of their roots."""
    return 1.15 * (flag_length(values) - depth(values)) + 0.02 * pitch(values)


def start(values: Verge) -> float:
    """Where a tooth tip of the near side stands at the start, just off the first flag, the verge in the middle."""
    return depth(values) * math.tan(math.radians(0.5 * values.flag_angle)) - 1e-3 * pitch(values)
