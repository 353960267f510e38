"""What makes the ratchet wheel with its click a design?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.ratchet.ratchet_dimensions import Ratchet
from watchsim.construction.ratchet.ratchet_outlines import click, wheel
from watchsim.construction.ratchet.ratchet_proportions import back, nose, opening, root
from watchsim.construction.ratchet.ratchet_scene import scene_text
from watchsim.drawing.sheet import Sheet

NARROWEST = 20.0  # degrees


def draw(values: Ratchet) -> dict[str, Sheet]:
    """Wheel and click."""
    return {"wheel": Sheet(tuple(wheel(values))), "click": Sheet(tuple(click(values)))}


def conflicts(values: Ratchet) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    if values.depth >= 0.8 * values.tip_radius:
        yield Conflict("depth", f"must be below {0.8 * values.tip_radius:.4g} mm, else no wheel is left")
        return
    if opening(values) < NARROWEST:
        yield Conflict("undercut", f"leaves roots of {opening(values):.3g}° for the nose; {NARROWEST:g}° are needed")
        return
    if nose(values)[0] - root(values)[0] > 0.6 * values.depth:
        yield Conflict("nose_radius", "the nose does not reach deep enough between the teeth")
    if values.click_angle > -back(values) - 5.0:
        yield Conflict("click_angle", f"must be below {-back(values) - 5.0:.3g}°, else the click lies in the teeth")
    if values.winding <= 1.05 * values.mainspring:
        yield Conflict("winding", f"must be above {1.05 * values.mainspring:.4g} mN·m, else it does not wind the mainspring")


DESIGN = Design("ratchet", "Ratchet wheel with its click", Ratchet, draw, scene_text, conflicts)
