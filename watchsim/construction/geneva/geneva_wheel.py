"""What is the outline of the driven wheel?

Slots at multiples of the pitch from the x axis, and between two of them a hollow about the place where the driver's axis
then is.
"""

from __future__ import annotations

import math

from watchsim.construction.geneva.geneva_dimensions import Geneva
from watchsim.construction.geneva.geneva_proportions import (
    centre_distance,
    half_pitch,
    hollow_half,
    mouth_half,
    slot_bottom,
    slot_half,
    wheel_radius,
)
from watchsim.construction.outline import arc_between, circle, polar
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line

BORE = 0.2  # by the distance of the slots' bottoms from the axis


def wheel(values: Geneva) -> list[Loop]:
    """The slotted wheel and its bore."""
    pitch = math.radians(2.0 * half_pitch(values))
    sector = Loop(tuple(_sector(values)), "WHEEL")
    edges = [edge for i in range(values.slots) for edge in sector.moved(i * pitch, (0.0, 0.0)).edges]
    bore = BORE * (slot_bottom(values) - slot_half(values))
    return [Loop(tuple(edges), "WHEEL"), circle("WHEEL", (0.0, 0.0), bore, hole=True)]


def _sector(values: Geneva) -> list[Edge]:
    """From the lower corner of one slot's mouth to that of the next, counter-clockwise."""
    rim, half, bottom = wheel_radius(values), slot_half(values), slot_bottom(values)
    mouth, middle, hollow = mouth_half(values), half_pitch(values), hollow_half(values)
    inner = {side: (bottom, side * half) for side in (-1.0, 1.0)}
    first, last = polar(rim, middle - hollow), polar(rim, middle + hollow)
    return [
        Line(*polar(rim, -mouth), *inner[-1.0]),
        arc_between(inner[-1.0], inner[1.0], (bottom, 0.0), False),
        Line(*inner[1.0], *polar(rim, mouth)),
        arc_between(polar(rim, mouth), first, (0.0, 0.0), True),
        arc_between(first, last, polar(centre_distance(values), middle), False),
        arc_between(last, polar(rim, 2.0 * middle - mouth), (0.0, 0.0), True),
    ]
