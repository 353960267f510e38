"""How far does a winding click let its wheel run back?

The wheel is wound counter-clockwise, the click hangs from its pivot above the wheel and swings with the teeth. A point T lets
the nose fall behind it where nose, point and wheel's axis lie on a line, at the distance R + r from the axis:

    cos β = (d² + l² - (R + r)²) / (2 d l)

with the distance d of the axes and the length l of the click. The spring then swings the click to its bank. Let go, the wheel
runs back until a locking face meets the nose there. From one place to the other it turns by the least recoil; where the hand
stops elsewhere, by up to a pitch more. Millimetres, angles in degrees, the wheel's first root at 0°.
"""

from __future__ import annotations

import math

from watchsim.construction.outline import along, angle_of, polar
from watchsim.construction.ratchet import ratchet_proportions as saw
from watchsim.construction.ratchet.ratchet_dimensions import Ratchet
from watchsim.construction.winding_click.winding_click_dimensions import WindingClick
from watchsim.geometry.primitives import Point


def teeth(values: WindingClick) -> Ratchet:
    """The ratchet wheel that has these teeth."""
    return Ratchet(teeth=values.teeth, tip_radius=values.tip_radius, depth=values.depth, undercut=values.undercut)


def distance(values: WindingClick) -> float:
    """Of the axes."""
    return values.tip_radius + values.click_length + values.nose_radius - values.reach


def nose(values: WindingClick, angle: float) -> Point:
    """The middle of the nose with the click at `angle`."""
    return along((0.0, distance(values)), angle - 90.0, values.click_length)


def lets_off(values: WindingClick) -> float:
    """The angle of the click at which a point passes beneath its nose."""
    d, length, out = distance(values), values.click_length, values.tip_radius + values.nose_radius
    return -math.degrees(math.acos((d**2 + length**2 - out**2) / (2.0 * d * length)))


def letting_off(values: WindingClick) -> float:
    """Angle of the wheel, of which the first tooth then stands under the nose."""
    return angle_of(nose(values, lets_off(values))) - angle_of(saw.tip(teeth(values)))


def held(values: WindingClick) -> float:
    """Angle of the wheel that presses the locking face of its first tooth on the nose, with the click on its bank.

    ValueError where no face can.
    """
    middle = nose(values, values.bank)
    foot = saw.root(teeth(values))[0] * math.sin(math.radians(values.undercut)) - values.nose_radius
    return angle_of(middle) - math.degrees(math.asin(foot / math.hypot(*middle))) + values.undercut


def least_recoil(values: WindingClick) -> float:
    return letting_off(values) - held(values)


def nose_in_teeth(values: WindingClick) -> tuple[float, float]:
    """With the click on its bank: how far up the locking face the nose touches it, and how far it is from the back before."""
    turn, middle = held(values), nose(values, values.bank)
    seen = polar(math.hypot(*middle), angle_of(middle) - turn)
    root, back = saw.root(teeth(values)), math.radians(saw.back(teeth(values)))
    lean = math.radians(-values.undercut)
    dx, dy = seen[0] - root[0], seen[1] - root[1]
    return dx * math.cos(lean) + dy * math.sin(lean), dy * math.cos(back) - dx * math.sin(back) - values.nose_radius
