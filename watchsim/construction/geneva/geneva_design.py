"""What makes the Geneva drive a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.geneva.geneva_conflicts import conflicts
from watchsim.construction.geneva.geneva_dimensions import Geneva
from watchsim.construction.geneva.geneva_driver import driver
from watchsim.construction.geneva.geneva_scene import scene_text
from watchsim.construction.geneva.geneva_wheel import wheel
from watchsim.drawing.sheet import Sheet


def draw(values: Geneva) -> dict[str, Sheet]:
    """Driver and wheel."""
    return {"driver": Sheet(tuple(driver(values))), "wheel": Sheet(tuple(wheel(values)))}


DESIGN = Design("geneva", "Geneva drive with a locking disc", Geneva, draw, scene_text, conflicts)
