"""What is kept of one tooth on one stone: the places between which the angles of a beat are measured?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.escapement.by_hand.escapement_parts import Parts
from watchsim.escapement.by_hand.hands import Hands
from watchsim.escapement.by_hand.lever_sweep import WIDTH, Rest, Stretch


@dataclass(frozen=True, slots=True)
class Direct:
    """The wheel meets the stone at `first` and lets go at `last`, the balance at `begin` and `end`; rad.

    `error` is that of the balance's angles. In both rests, `slope` is the turn of the wheel by turn of the balance.
    """

    first: Rest
    last: Rest
    begin: float
    end: float
    error: float


@dataclass(frozen=True, slots=True)
class Passage:
    """One tooth on one stone: the places between which its angles are measured. `end`: the other bank (rad).

    `caught` is where the wheel, unlocked, has met the impulse stone, where it had to run after it; `direct` describes an
    impulse on the balance itself, during which nothing drives the lever but its pin.
    """

    tooth: int
    side: float
    start: Rest
    unlocked: Rest
    let_off: Rest
    landed: Rest
    end: float
    driven: tuple[Stretch, ...]
    room: float
    caught: Rest | None = None
    direct: Direct | None = None


class NotMeasured(Exception):
    """The action does not get from bank to bank; the message says why."""


def change_error(hands: Hands, parts: Parts, rest: Rest) -> float:
    """Of the lever's angle at which a corner comes to the end of a face, rad: a contact counts a little beyond it."""
    x, y = hands.pivot(parts.lever, hands.compiled.q)
    # The corner slides at a third of the arm at least, unless draw or lift are steeper than any escapement's.
    return WIDTH + 3.0 * (hands.room + hands.resolution) / math.hypot(rest.x - x, rest.y - y)
