"""Which numbers does the designer of a recoil anchor with its pendulum choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim
from watchsim.construction.graham.graham_dimensions import CHOSEN, Graham


@dataclass(frozen=True)
class RecoilAnchor(Graham):
    """Those of the dead-beat escapement, and the lean of the locking faces."""

    recoil: float = dim(
        20.0, "°", 1.0, 45.0, "of a locking face, from the arc about the pivot, so that it drives the wheel back", CHOSEN
    )
