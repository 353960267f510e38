"""What makes the recoil anchor a design?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.graham import graham_conflicts as checks
from watchsim.construction.graham import graham_scene as texts
from watchsim.construction.graham.graham_design import sheets
from watchsim.construction.graham.graham_points import Anchor
from watchsim.construction.recoil_anchor.recoil_anchor_dimensions import RecoilAnchor
from watchsim.drawing.sheet import Sheet


def _anchor(values: RecoilAnchor) -> Anchor:
    return Anchor(values, values.recoil)


def draw(values: RecoilAnchor) -> dict[str, Sheet]:
    """Its two sheets."""
    return sheets(_anchor(values))


def scene(values: RecoilAnchor) -> str:
    """Its scene."""
    return texts.scene_text(_anchor(values), "Recoil anchor escapement")


def conflicts(values: RecoilAnchor) -> Iterator[Conflict]:
    """What does not go together."""
    return checks.conflicts(_anchor(values))


DESIGN = Design("recoil_anchor", "Recoil anchor escapement with its pendulum", RecoilAnchor, draw, scene, conflicts)
