"""What is the outline of the Maltese cross?

That of a Geneva drive's wheel, but one of the arms has no hollow: its end is round about the cross's own axis, and the disc on
the arbor cannot pass.
"""

from __future__ import annotations

import math

from watchsim.construction.geneva.geneva_dimensions import Geneva
from watchsim.construction.geneva.geneva_proportions import half_pitch, mouth_half, slot_bottom, slot_half, wheel_radius
from watchsim.construction.geneva.geneva_wheel import BORE, sector
from watchsim.construction.outline import arc_between, circle, polar
from watchsim.geometry.loop import Loop


def cross(drive: Geneva) -> list[Loop]:
    """The cross and its bore; the arm without a hollow ends at its last slot but one."""
    pitch = math.radians(2.0 * half_pitch(drive))
    slot_and_hollow = sector(drive)
    rim, mouth, middle = wheel_radius(drive), mouth_half(drive), half_pitch(drive)
    blunt = arc_between(polar(rim, mouth), polar(rim, 2.0 * middle - mouth), (0.0, 0.0), True)
    parts = [
        Loop((*slot_and_hollow[:3], blunt) if i == drive.slots - 2 else tuple(slot_and_hollow), "CROSS")
        for i in range(drive.slots)
    ]
    edges = [edge for i, part in enumerate(parts) for edge in part.moved(i * pitch, (0.0, 0.0)).edges]
    bore = BORE * (slot_bottom(drive) - slot_half(drive))
    return [Loop(tuple(edges), "CROSS"), circle("CROSS", (0.0, 0.0), bore, hole=True)]
