"""What makes the winding click with recoil a design?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.outline import circle, rounded
from watchsim.construction.ratchet import ratchet_outlines, ratchet_proportions
from watchsim.construction.winding_click.winding_click_dimensions import WindingClick
from watchsim.construction.winding_click.winding_click_proportions import (
    distance,
    nose,
    nose_in_teeth,
    teeth,
)
from watchsim.construction.winding_click.winding_click_scene import scene_text
from watchsim.drawing.sheet import Sheet
from watchsim.geometry.loop import Loop

FOOT = 2.5  # radius of the click about its pivot, in radii of its nose
SHALLOWEST, STEEPEST = 0.1, 60.0  # of the depth; degrees of the click at the bank


def draw(values: WindingClick) -> dict[str, Sheet]:
    """The wheel; the click with its nose below the pivot, arm and foot touch nothing."""
    r, low, wide = values.nose_radius, -values.click_length, FOOT * values.nose_radius
    arm = rounded([(-r, low, 0.0), (r, low, 0.0), (wide, 0.0, 0.0), (-wide, 0.0, 0.0)])
    click = [circle("NOSE", (0.0, low), r), Loop(tuple(arm), "ARM"), circle("FOOT", (0.0, 0.0), wide)]
    return {"wheel": Sheet(tuple(ratchet_outlines.wheel(teeth(values)))), "click": Sheet(tuple(click))}


def conflicts(values: WindingClick) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    if values.depth >= 0.8 * values.tip_radius:
        yield Conflict("depth", f"must be below {0.8 * values.tip_radius:.4g} mm, else no wheel is left")
        return
    if values.reach >= values.depth:
        yield Conflict("reach", f"must be below the depth of the teeth, {values.depth:g} mm, else the nose meets the roots")
        return
    inside = values.tip_radius + values.nose_radius - SHALLOWEST * values.depth
    if math.hypot(*nose(values, values.bank)) > inside:
        yield Conflict("bank", "there the nose is out of the teeth: nearer to 0°, or more reach")
        return
    if abs(values.bank) > STEEPEST or distance(values) < values.tip_radius:
        yield Conflict("reach", "brings the pivot of the click into the wheel: a longer click")
        return
    yield from _crowded(values)
    if values.winding <= 1.05 * values.mainspring:
        yield Conflict("winding", f"must be above {1.05 * values.mainspring:.4g} mN·m, else it does not wind the mainspring")


def _crowded(values: WindingClick) -> Iterator[Conflict]:
    """What keeps the nose from resting between two teeth."""
    try:
        along_face, free = nose_in_teeth(values)
    except ValueError:
        yield Conflict("nose_radius", "no locking face can meet the nose on its bank")
        return
    tip, root = (find(teeth(values)) for find in (ratchet_proportions.tip, ratchet_proportions.root))
    if not 0.0 < along_face < math.dist(tip, root):
        yield Conflict("reach", "the nose on its bank does not meet a locking face between root and point")
    elif free < 0.0:
        yield Conflict("nose_radius", f"the nose meets the back of a tooth before its bank, by {-free:.3g} mm")


DESIGN = Design("winding_click", "Winding click with recoil", WindingClick, draw, scene_text, conflicts)
