"""Where do the stones of a co-axial escapement stand, and what are their outlines?

Three on the lever (two LOCKING_STONES, one IMPULSE_STONE) and one on the roller (IMPULSE_STONE): prisms with two rounded edges
in their slots. In the frame of the part that holds them, millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.coaxial.coaxial_points import FIRST, SECOND, Points, cosine, sine
from watchsim.construction.outline import polar
from watchsim.construction.pallet_stone import Stone

LOCKING_WIDTH, LOCKING_LENGTH = 0.30, 0.62
LEVER_WIDTH, LEVER_LENGTH = 0.17, 0.52
ROLLER_WIDTH, ROLLER_LENGTH = 0.22, 0.46
EDGE = 0.03
UNDER = 0.025  # by which the end of a locking stone stays off the tip circle behind its corner
RELIEF = 25.0  # of the ends of impulse stones behind their tips, from the circle they run on, degrees: the tooth that has given
# its impulse waits behind the lever's stone


def locking_stone(points: Points, side: int) -> Stone:
    """The first (+1) or second (-1): its end stays off the tips that pass when it has let one go."""
    s = points.scale
    tip, face = points.locking_corner(side), points.face_direction(side)
    straight = Stone(tip, face, LOCKING_WIDTH * s, LOCKING_LENGTH * s, 0.0)
    x, y = points.in_movement(straight.at(0.0, straight.width), side * points.unlocked)
    turn = face + side * points.unlocked
    ux, uy = cosine(turn), sine(turn)
    ahead = x * ux + y * uy
    clear = points.values.tip_radius + UNDER * s
    relief = -ahead + math.sqrt(ahead**2 + clear**2 - x**2 - y**2)
    return Stone(tip, face, straight.width, straight.length, relief)


def lever_stone(points: Points) -> Stone:
    """The lever's impulse stone: its face looks at the teeth that come from the left, and points at the lever's pivot."""
    s = points.scale
    bearing = -90.0 - points.values.indirect_offset
    width = LEVER_WIDTH * s
    return Stone(
        polar(points.impulse_reach, bearing), bearing + 180.0, width, LEVER_LENGTH * s, width * math.tan(math.radians(RELIEF))
    )


def roller_stone(points: Points) -> Stone:
    """The roller's impulse stone in the balance's frame, whose pin points at the lever at angle 0."""
    s = points.scale
    bearing = points.balance_bearing + 180.0 - points.values.stone_lag
    width = ROLLER_WIDTH * s
    tip = polar(points.stone_reach, bearing)
    return Stone(tip, bearing + 180.0, width, ROLLER_LENGTH * s, width * math.tan(math.radians(RELIEF)))


STONES_OF_LEVER = (FIRST, SECOND)
