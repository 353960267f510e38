"""What are the outlines of the driver?

A pin (PIN) on a plate (PLATE, touches nothing) and, in the plane of the wheel, a disc (DISC) that locks the wheel while the
pin is outside. The disc is hollowed so that its edges pass the line of centres just when the pin enters a slot and leaves it.
"""

from __future__ import annotations

from watchsim.construction.geneva.geneva_dimensions import Geneva
from watchsim.construction.geneva.geneva_proportions import centre_distance, disc_radius, half_pitch
from watchsim.construction.outline import arc_between, circle, polar
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge

PLATE = 1.3  # by which the plate reaches beyond the pin's middle, in radii of the pin
BORE = 0.15  # by the radius of the disc


def driver(values: Geneva) -> list[Loop]:
    """Pin, disc with its bore, plate; the pin on the x axis."""
    bore = circle("DISC", (0.0, 0.0), BORE * disc_radius(values), hole=True)
    plate = circle("PLATE", (0.0, 0.0), values.crank + PLATE * values.pin_radius)
    return [circle("PIN", (values.crank, 0.0), values.pin_radius), disc(values), bore, plate]


def disc(values: Geneva) -> Loop:
    """The locking disc; the hollow is round the wheel's axis as it stands when the pin is deepest."""
    edge = 90.0 - half_pitch(values)
    begin, end = polar(disc_radius(values), edge), polar(disc_radius(values), -edge)
    edges: list[Edge] = [
        arc_between(begin, end, (0.0, 0.0), True),
        arc_between(end, begin, (centre_distance(values), 0.0), False),
    ]
    return Loop(tuple(edges), "DISC")
