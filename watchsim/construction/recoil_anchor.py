"""Recoil anchor escapement with its pendulum: a dead-beat escapement whose locking faces lean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from watchsim.construction.design import CHOSEN, Design, dim
from watchsim.construction.graham import Graham, conflicts, draw, scene_text


@dataclass(frozen=True)
class RecoilAnchor(Graham):
    """Those of the dead-beat escapement, and the lean of the locking faces."""

    title: ClassVar[str] = "Recoil anchor escapement"
    recoil: float = dim(
        20.0, "°", 1.0, 45.0, "of a locking face, from the arc about the pivot, so that it drives the wheel back", CHOSEN
    )


DESIGN = Design("recoil_anchor", "Recoil anchor escapement with its pendulum", RecoilAnchor, draw, scene_text, conflicts)
