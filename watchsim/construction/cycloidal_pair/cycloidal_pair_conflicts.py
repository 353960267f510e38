"""Which dimensions of a wheel with cycloidal teeth and its pinion do not go together?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.cycloidal_pair.cycloidal_pair_dimensions import CycloidalPair
from watchsim.construction.cycloidal_pair.cycloidal_pair_gear import Pinion, Wheel, tip_left
from watchsim.construction.cycloidal_pair.cycloidal_pair_meshing import distance, play
from watchsim.construction.design import Conflict

LEAST_TIP, LEAST_PLAY, LEAST_ROOM = 0.02, 0.02, 0.05  # modules


def conflicts(values: CycloidalPair) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    wheel, pinion, module = Wheel(values), Pinion(values), values.module
    if tip_left(wheel) < LEAST_TIP * module:
        yield Conflict(
            "addendum", f"makes the teeth of the wheel pointed: {tip_left(wheel) / module:.3g} modules are left at the tip"
        )
    if play(values) < LEAST_PLAY:
        yield Conflict(
            "leaf", f"leaves no play: with a tooth of {values.tooth:g} modules it must be less than 3.12 - {values.tooth:g}"
        )
    if pinion.floor_radius < LEAST_ROOM * module or wheel.floor_radius < LEAST_ROOM * module:
        yield Conflict("pinion_dedendum", "leaves no core: it must be less than half the number of leaves")
    elif distance(values) - wheel.tip_radius - pinion.floor_radius < LEAST_ROOM * module:
        least = values.addendum - values.spread + LEAST_ROOM
        yield Conflict(
            "pinion_dedendum", f"lets the wheel's tips meet the floor of the pinion: it must be at least {least:.3g}"
        )
    if distance(values) - pinion.tip_radius - wheel.floor_radius < LEAST_ROOM * module:
        least = (pinion.tip_radius - pinion.pitch_radius) / module - values.spread + LEAST_ROOM
        yield Conflict("wheel_dedendum", f"lets the leaves meet the floor of the wheel: it must be at least {least:.3g}")
