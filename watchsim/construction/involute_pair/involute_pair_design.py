"""What makes a pair of involute gears a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.gear_pair_scene import gear_pair_scene
from watchsim.construction.involute_pair.involute_pair_conflicts import conflicts
from watchsim.construction.involute_pair.involute_pair_dimensions import InvolutePair
from watchsim.construction.involute_pair.involute_pair_gear import outline, pair
from watchsim.construction.involute_pair.involute_pair_meshing import distance
from watchsim.drawing.sheet import Sheet


def draw(values: InvolutePair) -> dict[str, Sheet]:
    """Pinion and wheel."""
    pinion, wheel = pair(values)
    return {"pinion": Sheet(tuple(outline(pinion))), "wheel": Sheet(tuple(outline(wheel)))}


def scene_text(values: InvolutePair) -> str:
    """The text of scene.toml."""
    return gear_pair_scene(values, "A pair of involute gears", "Involute gears", distance(values))


DESIGN = Design("involute_pair", "Pair of involute gears", InvolutePair, draw, scene_text, conflicts)
