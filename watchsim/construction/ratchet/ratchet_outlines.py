"""What are the outlines of a ratchet wheel and its click?"""

from __future__ import annotations

from watchsim.construction.outline import angle_of, circle, polar, rounded
from watchsim.construction.ratchet.ratchet_dimensions import Ratchet
from watchsim.construction.ratchet.ratchet_proportions import pitch, root, tip
from watchsim.geometry.loop import Loop

BORE = 0.15  # of the tip radius
FOOT = 3.0  # radius of the click about its pivot, in radii of its nose


def wheel(values: Ratchet) -> list[Loop]:
    """Saw teeth, the first root at 0°; bore."""
    corners = []
    for i in range(values.teeth):
        turn = i * pitch(values)
        corners.append((*polar(root(values)[0], turn), 0.0))
        corners.append((*polar(values.tip_radius, turn + angle_of(tip(values))), 0.0))
    return [Loop(tuple(rounded(corners)), "TEETH"), circle("TEETH", (0.0, 0.0), BORE * values.tip_radius, hole=True)]


def click(values: Ratchet) -> list[Loop]:
    """The nose to the left of the pivot; arm and foot touch nothing."""
    r, far, wide = values.nose_radius, -values.click_length, FOOT * values.nose_radius
    arm = rounded([(far, -r, 0.0), (0.0, -wide, 0.0), (0.0, wide, 0.0), (far, r, 0.0)])
    return [circle("NOSE", (far, 0.0), r), Loop(tuple(arm), "ARM"), circle("FOOT", (0.0, 0.0), wide)]
