"""On which face of which pallet does which tooth rest?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.analysis.verdicts.equilibrium.lever_arms import Arms
from watchsim.analysis.verdicts.watch import Watch

DRIVING = 0.05  # of the distance from the lever's pivot: with a longer arm the wheel drives the pallet out


@dataclass(frozen=True, slots=True)
class Face:
    """`tooth` counts from 1 (None where the teeth are not known), `pallet` is "entry" or "exit"; on an impulse face the wheel
    drives the pallet out of its way, on a locking face it holds it or draws it in. `out`: the way of the lever, +1 or -1,
    that takes the pallet out."""

    tooth: int | None
    pallet: str
    impulse: bool
    out: float

    def __str__(self) -> str:
        which = "a tooth" if self.tooth is None else f"tooth {self.tooth}"
        return f"{which} rests on the {self.pallet} {'impulse' if self.impulse else 'locking'} face"


def face(watch: Watch, found: Arms, row: int) -> Face:
    """Of a contact between wheel and lever."""
    assert watch.lever is not None
    (wx, wy, turned), (lx, ly, _) = found.places[watch.wheel], found.places[watch.lever]
    x, y = found.point[row].tolist()
    # The entry pallet is the one that a tooth passes before it passes the line of centres.
    from_line = math.remainder(math.atan2(y - wy, x - wx) - math.atan2(ly - wy, lx - wx), math.tau)
    pallet = "entry" if watch.direction * from_line < 0.0 else "exit"
    out = math.copysign(1.0, (ly - y) * (x - wx) + (x - lx) * (y - wy))
    arm, _ = found.of(row, watch.lever)
    tooth = None if watch.teeth is None else watch.teeth.number(math.atan2(y - wy, x - wx) - turned)
    return Face(tooth, pallet, out * arm > DRIVING * math.hypot(x - lx, y - ly), out)
