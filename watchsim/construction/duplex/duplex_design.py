"""What makes the duplex escapement a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.duplex.duplex_conflicts import conflicts
from watchsim.construction.duplex.duplex_dimensions import Duplex
from watchsim.construction.duplex.duplex_outlines import balance, wheel
from watchsim.construction.duplex.duplex_points import DuplexPoints
from watchsim.construction.duplex.duplex_scene import scene_text
from watchsim.drawing.sheet import Sheet


def draw(values: Duplex) -> dict[str, Sheet]:
    """Wheel, and balance with roller and pallet."""
    points = DuplexPoints(values)
    return {"escape_wheel": Sheet(tuple(wheel(points))), "balance": Sheet(tuple(balance(points)))}


DESIGN = Design("duplex", "Duplex escapement of a watch with its balance", Duplex, draw, scene_text, conflicts)
