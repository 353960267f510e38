"""What makes the dead-beat escapement a design?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.graham import graham_conflicts as checks
from watchsim.construction.graham import graham_scene as texts
from watchsim.construction.graham.graham_dimensions import Graham
from watchsim.construction.graham.graham_pallets import pendulum
from watchsim.construction.graham.graham_points import Anchor
from watchsim.construction.graham.graham_wheel import wheel
from watchsim.drawing.sheet import Sheet


def sheets(anchor: Anchor) -> dict[str, Sheet]:
    """Wheel, and pendulum with its anchor."""
    return {"escape_wheel": Sheet(tuple(wheel(anchor.values))), "pendulum": Sheet(tuple(pendulum(anchor)))}


def draw(values: Graham) -> dict[str, Sheet]:
    """Its two sheets."""
    return sheets(Anchor(values))


def scene(values: Graham) -> str:
    """Its scene."""
    return texts.scene_text(Anchor(values), "Dead-beat escapement")


def conflicts(values: Graham) -> Iterator[Conflict]:
    """What does not go together."""
    return checks.conflicts(Anchor(values))


DESIGN = Design("graham", "Graham's dead-beat escapement with its pendulum", Graham, draw, scene, conflicts)
