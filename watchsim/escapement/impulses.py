"""Where does the wheel push, over which angles: a stone of the lever (indirect impulse) or of the balance (direct)?

Of an escapement in which the wheel, once unlocked, runs free until it meets an impulse stone. In a Swiss lever the tooth goes
on from the locking face to the impulse face of the same stone, and nothing of this is reported.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from watchsim.escapement.by_hand.hands import Touch
from watchsim.escapement.by_hand.lever_sweep import Rest
from watchsim.escapement.fork_and_pin import Balance, Entry
from watchsim.escapement.quantity import Quantity, over_teeth
from watchsim.escapement.tooth_passage import Passage, change_error

DIRECT, INDIRECT = "direct", "indirect"


@dataclass(frozen=True, slots=True)
class Impulse:
    """Mean over the teeth, rad.

    catch_up  of the wheel, free from unlocking until it meets the impulse stone
    wheel, lever, balance: turn of each while the wheel pushes; the lever's is nan in a direct impulse, where it gives nothing
    begins, ends: of the impulse, by the balance from its rest, positive past it; the lever's play in the slot is taken up first
    """

    kind: str
    catch_up: Quantity
    wheel: Quantity
    lever: Quantity
    balance: Quantity
    begins: Quantity
    ends: Quantity


def impulse(balance: Balance, bank: float, entry: Entry, beats: Sequence[Passage]) -> Impulse | None:
    """That of the beats which begin on one bank; None where the wheel does not run free before it."""
    if not beats or any(one.caught is None for one in beats):
        return None
    parts, hands = balance.parts, balance.hands
    teeth = [one.tooth for one in beats]
    ends = [_ends(balance, bank, entry, one) for one in beats]

    def mean(value: Callable[[Passage], float], error: Callable[[Passage], float]) -> Quantity:
        return over_teeth([value(one) for one in beats], [error(one) for one in beats], teeth)

    def of_lever(one: Passage) -> float:
        return sum(change_error(hands, parts, place) for place in _places(one))

    def of_wheel(one: Passage) -> float:
        error = one.direct.error if one.direct is not None else of_lever(one)
        return sum(place.error + error * abs(place.slope) for place in _places(one))

    errors = [end.error for end in ends]
    direct = beats[0].direct is not None
    nothing = over_teeth([], [], [])
    return Impulse(
        DIRECT if direct else INDIRECT,
        mean(lambda one: parts.way * (_caught(one) - one.unlocked.wheel), of_wheel),
        mean(lambda one: parts.way * (one.let_off.wheel - _caught(one)), of_wheel),
        nothing if direct else mean(lambda one: abs(one.let_off.lever - _places(one)[0].lever), of_lever),
        over_teeth([entry.way * (end.last - end.first) for end in ends], errors, teeth),
        over_teeth([_within(entry.way * (end.first - balance.rest)) for end in ends], errors, teeth),
        over_teeth([_within(entry.way * (end.last - balance.rest)) for end in ends], errors, teeth),
    )


@dataclass(frozen=True, slots=True)
class _Ends:
    """The balance's angles at which an impulse begins and ends, rad."""

    first: float
    last: float
    error: float


def _ends(balance: Balance, bank: float, entry: Entry, one: Passage) -> _Ends:
    """With the pin driven by the fork, where the lever gives the impulse."""
    if one.direct is not None:
        return _Ends(one.direct.begin, one.direct.end, one.direct.error)
    first, last = _places(one)
    slots = balance.carried(entry, bank, {first.lever, last.lever, one.unlocked.lever})
    # The pin stands at the wall ahead, having unlocked; the lever first takes up its play.
    unlocked, behind = _angle(slots[one.unlocked.lever].front), _angle(slots[first.lever].back)
    begin = max(unlocked, behind, key=lambda angle: entry.way * angle)
    error = sum(balance.carried_error(slots[place.lever], place) for place in (first, last))
    return _Ends(begin, _angle(slots[last.lever].back), error)


def _angle(wall: Touch | None) -> float:
    return math.nan if wall is None else wall.angle


def _within(angle: float) -> float:
    """The same direction within half a turn."""
    return (angle + math.pi) % math.tau - math.pi


def _places(one: Passage) -> tuple[Rest, Rest]:
    assert one.caught is not None
    return one.caught, one.let_off


def _caught(one: Passage) -> float:
    assert one.caught is not None
    return one.caught.wheel
