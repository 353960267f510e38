"""What makes the snail with its rack a design?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.snail.snail_dimensions import Snail
from watchsim.construction.snail.snail_outlines import rack, snail, stop
from watchsim.construction.snail.snail_proportions import FALLS, LIFTED, fall_time, gathered, leaf_stiffness, radius, room
from watchsim.construction.snail.snail_scene import scene_text
from watchsim.drawing.sheet import Sheet

WIDEST = 140.0  # degrees of the tail to the line of centres, gathered up
QUIET = 0.25  # of the time on a step that the rack may take to fall there


def draw(values: Snail) -> dict[str, Sheet]:
    """Snail, rack and stop."""
    return {part.__name__: Sheet(tuple(part(values))) for part in (snail, rack, stop)}


def conflicts(values: Snail) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    low = values.least + values.pin_radius
    if not abs(values.distance - values.tail) < low < values.distance + values.tail:
        yield Conflict("tail", f"does not bring the pin to the lowest step, {low:.4g} mm from the snail's axis")
        return
    if gathered(values) > WIDEST:
        yield Conflict("tooth", f"the rack would fall by {values.steps * values.tooth:.4g}°, more than its tail can follow")
        return
    if radius(values, 1) + 4.0 * values.pin_radius > values.distance:
        yield Conflict("distance", f"the first step, {radius(values, 1):.4g} mm high, would reach the rack's axis")
    if weak := list(_weak(values)):
        yield from weak
        return
    narrowest = min(range(1, values.steps + 1), key=lambda step: room(values, step))
    if room(values, narrowest) <= 0.0:
        what = (
            "a smaller pin, a tail as long as the distance, so that its pin passes through the snail's axis, "
            "or more torque to gather the rack up"
        )
        yield Conflict("pin_radius", f"the pin does not find room on step {narrowest} while the snail turns: {what}")


def _weak(values: Snail) -> Iterator[Conflict]:
    """What keeps the rack from falling in time, or from being gathered up."""
    preload, whole = values.leaf_force * values.leaf_arm, values.steps * values.tooth
    lost = 1e6 * leaf_stiffness(values) * math.radians(whole)
    if preload <= 1.1 * lost:
        needed = 1.1 * lost / values.leaf_arm
        yield Conflict("leaf_force", f"must be above {needed:.4g} mN, else the leaf slackens before the lowest step")
        return
    if 1e3 * values.lifting <= 1.2 * preload:
        yield Conflict("lifting", f"must be above {1.2e-3 * preload:.4g} mN·m to gather the rack up against its leaf")
        return
    slowest = fall_time(values, values.steps) / (QUIET * (LIFTED - FALLS))
    if values.hour < slowest:
        yield Conflict("hour", f"must be above {slowest:.4g} s, else the rack has no time to come to rest")


DESIGN = Design("snail", "Snail of a striking train with its rack", Snail, draw, scene_text, conflicts)
