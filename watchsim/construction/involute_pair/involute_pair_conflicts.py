"""Which dimensions of a pair of involute gears do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.involute_pair.involute_pair_dimensions import InvolutePair
from watchsim.construction.involute_pair.involute_pair_gear import departure, floor_left, pair
from watchsim.construction.involute_pair.involute_pair_meshing import beyond_base, contact_ratio, distance, play

LEAST_TIP, LEAST_FLOOR = 0.1, 0.05  # modules; degrees


def conflicts(values: InvolutePair) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    gears = dict(zip(("pinion", "wheel"), pair(values), strict=True))
    for name, gear in gears.items():
        tip = 2.0 * gear.half_tooth(gear.tip_radius) * gear.tip_radius / values.module
        if tip < LEAST_TIP:
            yield Conflict("addendum", f"makes the teeth of the {name} pointed: {tip:.3g} modules are left at the tip")
        if floor_left(gear) < LEAST_FLOOR:
            yield Conflict("shift", f"leaves no gap between the feet of the {name}'s teeth")
    for (name, gear), other in zip(gears.items(), reversed(gears.values()), strict=True):
        start = math.sqrt(gear.flank_start**2 - gear.base_radius**2)
        if beyond_base(values, gear, other) < start:
            yield Conflict("shift", f"lets the other gear's tips reach below the involutes of the {name}: they would cut in")
        if gear.floor_radius + other.tip_radius >= distance(values):
            yield Conflict("dedendum", f"is too small: the other gear's tips meet the floor of the {name}")
    if play(values) <= 0.0:
        yield Conflict("spread", "leaves no play between the teeth")
    elif sum(map(departure, pair(values))) > play(values) * pair(values)[0].base_radius / 4.0:
        yield Conflict(
            "arcs", "follows the involute so coarsely that it takes up more than half of the play: more arcs or more spread"
        )
    if contact_ratio(values) < 1.0:
        yield Conflict(
            "spread", f"gives a contact ratio of {contact_ratio(values):.3g}: a tooth leaves before the next one meets"
        )
