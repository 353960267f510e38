"""Which places and moments follow from the dimensions of a remontoir?

The stop wheel's pointed teeth lock by turns on two pallets, one and a half pitches apart. Both locking faces are arcs about
the stop lever's pivot, so that a tooth at rest does not turn the lever; the centres are as far apart as makes a tooth's
motion point at that pivot, or away from it. The eccentric disc turns clockwise with the escape wheel; at the beginning it
stands at START to the line from the lever's pivot through the axis. Millimetres, degrees.
"""

from __future__ import annotations

import math

from watchsim.construction.remontoir.remontoir_dimensions import Remontoir
from watchsim.geometry.primitives import Point

START = 84.0


def half_span(values: Remontoir) -> float:
    """From the line of centres to a locked tooth, at the stop wheel."""
    return 1.5 * 180.0 / values.stop_teeth


def centre_distance(values: Remontoir) -> float:
    """Of stop wheel and stop lever."""
    return values.stop_radius / math.cos(math.radians(half_span(values)))


def locking_radius(values: Remontoir) -> float:
    """Of the locking faces, about the lever's pivot."""
    return values.stop_radius * math.tan(math.radians(half_span(values)))


def disc_at(values: Remontoir, turn: float) -> Point:
    """The disc's middle from the stop lever's pivot, when it stands at `turn` about the escape wheel's axis."""
    x, y = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    return values.arm + values.eccentricity * x, values.eccentricity * y


def lever_at(values: Remontoir, turn: float) -> float:
    """Angle of the stop lever with the disc in the middle of its slot."""
    x, y = disc_at(values, turn)
    return math.degrees(math.atan2(y, x))


def slack(values: Remontoir) -> float:
    """By which the lever stays behind the disc that leads it."""
    return math.degrees(values.slot_play / 2.0 / values.arm)


def letting_go(values: Remontoir) -> float:
    """Where the disc stands when it has led the lever down so far that the first tooth is let go.

    Law of sines in the triangle of the lever's pivot, the axis and the disc's middle.
    """
    led = values.stop_lock + slack(values)
    return -led - math.degrees(math.asin(values.arm * math.sin(math.radians(led)) / values.eccentricity))


def middle(values: Remontoir) -> float:
    """How far the escape wheel turns, counter-clockwise, from the start to the middle between the first two windings."""
    return letting_go(values) - START + 90.0


def hardest(values: Remontoir) -> float:
    """Torque that the wound spring asks of the stop wheel, µN·m: half a turn beyond its weakest."""
    return values.stop_teeth * (values.torque + values.spring_rate * math.pi / 2.0)
