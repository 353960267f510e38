"""What makes a wheel with cycloidal teeth and its pinion a design?"""

from __future__ import annotations

from watchsim.construction.cycloidal_pair.cycloidal_pair_conflicts import conflicts
from watchsim.construction.cycloidal_pair.cycloidal_pair_dimensions import CycloidalPair
from watchsim.construction.cycloidal_pair.cycloidal_pair_gear import Pinion, Wheel, pinion_outline, wheel_outline
from watchsim.construction.cycloidal_pair.cycloidal_pair_meshing import distance
from watchsim.construction.design import Design
from watchsim.construction.gear_pair_scene import gear_pair_scene
from watchsim.drawing.sheet import Sheet


def draw(values: CycloidalPair) -> dict[str, Sheet]:
    """Pinion and wheel."""
    return {"pinion": Sheet(tuple(pinion_outline(Pinion(values)))), "wheel": Sheet(tuple(wheel_outline(Wheel(values))))}


def scene_text(values: CycloidalPair) -> str:
    """The text of scene.toml."""
    return gear_pair_scene(values, "A wheel with cycloidal teeth and its pinion", "Cycloidal gears", distance(values))


DESIGN = Design("cycloidal_pair", "Cycloidal wheel and pinion", CycloidalPair, draw, scene_text, conflicts)
