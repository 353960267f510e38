"""What makes the Geneva stop-work a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.geneva.geneva_driver import driver
from watchsim.construction.geneva_stop.geneva_stop_conflicts import conflicts
from watchsim.construction.geneva_stop.geneva_stop_dimensions import GenevaStop
from watchsim.construction.geneva_stop.geneva_stop_outlines import cross
from watchsim.construction.geneva_stop.geneva_stop_scene import scene_text
from watchsim.drawing.sheet import Sheet


def draw(values: GenevaStop) -> dict[str, Sheet]:
    """Arbor with finger and disc, and the cross."""
    return {"arbor": Sheet(tuple(driver(values.drive))), "cross": Sheet(tuple(cross(values.drive)))}


DESIGN = Design(
    "geneva_stop", "Geneva stop-work on the barrel of a watch, wound by hand", GenevaStop, draw, scene_text, conflicts
)
