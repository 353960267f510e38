"""How does the follower of an eccentric cam rise, and when does it leave the cam?

The middle of the round end keeps the distance radius + roller_radius from the disc's middle, which goes round the axis:

    y = e sin φ + √((R + r)² − e² cos² φ)

At the top the spring must press at least with m e ω² (1 + e/(R + r)), or the follower flies on.
"""

from __future__ import annotations

import math

from watchsim.construction.cam.cam_dimensions import Cam


def lowest(values: Cam) -> float:
    """mm from the cam's axis to the middle of the follower's end."""
    return values.radius + values.roller_radius - values.eccentricity


def leaves_at(values: Cam) -> float:
    """°/s: the least speed at which the follower leaves the cam at the top."""
    e, reach = 1e-3 * values.eccentricity, values.radius + values.roller_radius
    if e == 0.0:
        return math.inf
    press = values.preload + values.rate * 2.0 * values.eccentricity
    return math.degrees(math.sqrt(press / (1e-3 * values.mass * e * (1.0 + values.eccentricity / reach))))
