"""Recoil anchor escapement with its pendulum: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import graham
from watchsim.construction.design import CHOSEN, Conflict, Design, dim
from watchsim.construction.graham import Anchor, Graham
from watchsim.drawing.write import Sheet


@dataclass(frozen=True)
class RecoilAnchor(Graham):
    """Those of the dead-beat escapement, and the lean of the locking faces."""

    recoil: float = dim(
        20.0, "°", 1.0, 45.0, "of a locking face, from the arc about the pivot, so that it drives the wheel back", CHOSEN
    )


def _anchor(values: RecoilAnchor) -> Anchor:
    return Anchor(values, values.recoil)


def draw(values: RecoilAnchor) -> dict[str, Sheet]:
    """Its two sheets."""
    return graham.sheets(_anchor(values))


def scene(values: RecoilAnchor) -> str:
    """Its scene."""
    return graham.scene_text(_anchor(values), "Recoil anchor escapement")


def conflicts(values: RecoilAnchor) -> Iterator[Conflict]:
    """What does not go together."""
    return graham.conflicts(_anchor(values))


DESIGN = Design("recoil_anchor", "Recoil anchor escapement with its pendulum", RecoilAnchor, draw, scene, conflicts)
