"""What makes a remontoir before a Swiss lever a design?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.remontoir.remontoir_dimensions import Remontoir
from watchsim.construction.remontoir.remontoir_outlines import PRONG, stop_lever, stop_wheel
from watchsim.construction.remontoir.remontoir_proportions import hardest, locking_radius, slack
from watchsim.construction.remontoir.remontoir_scene import scene_text
from watchsim.construction.swiss_lever import swiss_lever_conflicts as lever
from watchsim.construction.swiss_lever.swiss_lever_design import draw as draw_lever
from watchsim.drawing.sheet import Sheet

SURE, SPARE = 1.5, 1.1  # times what lets a tooth go, and times what winds the spring


def draw(values: Remontoir) -> dict[str, Sheet]:
    """The sheets of the lever, stop wheel and stop lever."""
    own = {"stop_wheel": Sheet(tuple(stop_wheel(values))), "stop_lever": Sheet(tuple(stop_lever(values)))}
    return {**draw_lever(values), **own}


def conflicts(values: Remontoir) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work, of the lever and of what winds it."""
    yield from lever.conflicts(values)
    least = values.arm * math.tan(math.radians(SURE * (values.stop_lock + slack(values))))
    if values.eccentricity < least:
        yield Conflict("eccentricity", f"must be at least {least:.3g} mm, to lead the stop lever clear of both pallets")
    if values.eccentricity + values.disc > PRONG * values.disc:
        yield Conflict("eccentricity", f"must be at most {(PRONG - 1.0) * values.disc:.3g} mm: the disc would leave its fork")
    if values.arm - 2.0 * PRONG * values.disc < 0.5 * locking_radius(values):
        yield Conflict("arm", "leaves no room between the stop lever's pivot and its fork")
    if values.train < SPARE * hardest(values):
        words = f"must be at least {SPARE * hardest(values):.3g} µN·m: the wound spring asks for {hardest(values):.3g} µN·m"
        yield Conflict("train", words)


DESIGN = Design("remontoir", "Remontoir before a Swiss lever", Remontoir, draw, scene_text, conflicts)
