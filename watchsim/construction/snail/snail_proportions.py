"""How high are the steps of a snail, and where do they stand?

The snail's axis is the origin, the rack's lies to the right at the distance d. With the tail, of length l, at the angle ψ from
the line of centres its pin is s = √(d² + l² - 2 d l cos ψ) from the snail's axis. At step n the rack has fallen by n teeth, so

    r_n = s(ψ₀ - n tooth) - pin_radius

and the middle of the step stands where the pin then is, a turn / steps further for each hour. Millimetres, degrees.
"""

from __future__ import annotations

import math

from watchsim.construction.leaf_text import STEEL
from watchsim.construction.outline import angle_of, polar
from watchsim.construction.snail.snail_dimensions import Snail
from watchsim.geometry.primitives import Point

FALLS, LIFTED = 0.25, 0.6  # of an hour: the rack is let go, and gathered up again
UNDER = 0.5  # of an hour: the middle of a step is under the pin
EASE = 0.02  # of an hour, over which the rack is taken hold of


def gathered(values: Snail) -> float:
    """ψ₀ of the tail, gathered up. ValueError where the pin cannot come to the lowest step."""
    d, tail, low = values.distance, values.tail, values.least + values.pin_radius
    return math.degrees(math.acos((d**2 + tail**2 - low**2) / (2.0 * d * tail))) + values.steps * values.tooth


def pin(values: Snail, fallen: float) -> Point:
    """Its middle, with the rack fallen by so many teeth."""
    return polar(values.tail, 180.0 - gathered(values) + fallen * values.tooth, (values.distance, 0.0))


def radius(values: Snail, step: int) -> float:
    return math.hypot(*pin(values, step)) - values.pin_radius


def middle(values: Snail, step: int) -> float:
    """Direction of the middle of a step on the snail as it is drawn, with the first step under the pin."""
    return angle_of(pin(values, step)) - (step - 1) * 360.0 / values.steps


def boundary(values: Snail, step: int) -> float:
    """Between a step and the one before, which stands counter-clockwise of it; before the first is the last."""
    before = middle(values, step - 1) if step > 1 else middle(values, values.steps) + 360.0
    return 0.5 * (middle(values, step) + before)


def fall_time(values: Snail, fallen: float) -> float:
    """s for so many teeth, on the leaf alone: (P / k) (1 - cos ω t) rad, P its preload and ω² = k / J."""
    preload, stiffness = 1e-6 * values.leaf_force * values.leaf_arm, leaf_stiffness(values)
    cosine = 1.0 - stiffness / preload * math.radians(fallen * values.tooth)
    return math.acos(cosine) / math.sqrt(stiffness / (1e-10 * values.rack_inertia))


def leaf_stiffness(values: Snail) -> float:
    """N·m/rad, on the rack."""
    length, width, thick, arm = values.leaf_length, values.leaf_width, values.leaf_thickness, values.leaf_arm
    return STEEL * width * thick**3 / (4.0 * length**3) * arm**2 * 1e-9


def rise_time(values: Snail) -> float:
    """s until the rack, fallen to the lowest step, is gathered up; longer than it takes, since the leaf yields."""
    left = 1e-3 * values.lifting - 1e-6 * values.leaf_force * values.leaf_arm
    inertia = 1e-10 * values.rack_inertia
    return EASE * values.hour + math.sqrt(2.0 * math.radians(values.steps * values.tooth) * inertia / left)


def room(values: Snail, step: int) -> float:
    """Degrees that are left on a step beside the pin, on the nearer side, while the snail turns under it.

    The wall behind the last step rises to the first: it must not come before the pin, on its way up, has passed it.
    """
    pitch, here = 360.0 / values.steps, middle(values, step)
    after = boundary(values, step + 1) if step < values.steps else boundary(values, 1) - 360.0
    ahead, behind = (UNDER - FALLS) * pitch, (LIFTED - UNDER) * pitch
    rooms = [boundary(values, step) - here - _beside(values, step) - ahead, here - after - _beside(values, step) - behind]
    if step == values.steps:
        behind += pitch * rise_time(values) / values.hour
        way = [angle_of(pin(values, m)) - angle_of(pin(values, step)) - _beside(values, m) for m in range(1, step)]
        rooms += [here - after + one - behind for one in way]
    return min(rooms)


def _beside(values: Snail, step: int) -> float:
    """Half the pin, seen from the snail's axis."""
    return math.degrees(math.asin(values.pin_radius / math.hypot(*pin(values, step))))
