"""What are the outlines of star, jumper and finger?"""

from __future__ import annotations

from watchsim.construction.jumper.jumper_dimensions import Jumper
from watchsim.construction.jumper.jumper_proportions import pitch, root_radius
from watchsim.construction.outline import circle, polar, rounded
from watchsim.geometry.loop import Loop

HUB, BORE = 0.45, 0.15  # of the star's root radius
BAR = 0.5  # half the width of jumper and finger, in radii of beak and pin
FOOT = 1.6  # radius of the jumper's foot in radii of the beak


def star(values: Jumper) -> list[Loop]:
    """Teeth with straight flanks and rounded points, a root on the x axis; a bore and a scribed hub, which touch nothing."""
    corners = []
    for i in range(values.teeth):
        corners.append((*polar(root_radius(values), i * pitch(values)), 0.0))
        corners.append((*polar(values.tip_radius, (i + 0.5) * pitch(values)), values.tip_rounding))
    bore = circle("STAR", (0.0, 0.0), BORE * root_radius(values), hole=True)
    return [Loop(tuple(rounded(corners)), "STAR"), bore, circle("HUB", (0.0, 0.0), HUB * root_radius(values))]


def jumper(values: Jumper) -> list[Loop]:
    """The beak hangs below the pivot; arm and foot touch nothing."""
    half = BAR * values.beak_radius
    low = -values.jumper_length
    arm = rounded([(-half, 0.0, 0.0), (-half, low, 0.0), (half, low, 0.0), (half, 0.0, 0.0)])
    beak = circle("BEAK", (0.0, low), values.beak_radius)
    return [beak, Loop(tuple(arm), "ARM"), circle("FOOT", (0.0, 0.0), FOOT * values.beak_radius)]


def finger(values: Jumper) -> list[Loop]:
    """A pin on an arm that touches nothing; the pin on the x axis."""
    half = BAR * values.pin_radius
    arm = rounded([(0.0, -half, 0.0), (values.crank, -half, 0.0), (values.crank, half, 0.0), (0.0, half, 0.0)])
    pin = circle("PIN", (values.crank, 0.0), values.pin_radius)
    return [pin, Loop(tuple(arm), "ARM"), circle("HUB", (0.0, 0.0), 2.0 * values.pin_radius)]
