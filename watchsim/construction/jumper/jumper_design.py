"""What makes the calendar star with its jumper a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.jumper.jumper_conflicts import conflicts
from watchsim.construction.jumper.jumper_dimensions import Jumper
from watchsim.construction.jumper.jumper_outlines import finger, jumper, star
from watchsim.construction.jumper.jumper_scene import scene_text
from watchsim.drawing.sheet import Sheet


def draw(values: Jumper) -> dict[str, Sheet]:
    """Star, jumper and finger."""
    return {part.__name__: Sheet(tuple(part(values))) for part in (star, jumper, finger)}


DESIGN = Design("jumper", "Calendar star with jumper and finger", Jumper, draw, scene_text, conflicts)
