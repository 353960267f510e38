"""How do fork and pin play together: lift angle of the balance, shake of the pin, and where would the pin knock?"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.escapement.hands import Array, Hands, Integers, Touch
from watchsim.escapement.pallets import Passage
from watchsim.escapement.parts import Parts
from watchsim.escapement.quantity import Quantity, over_teeth, single

STEP = math.radians(0.25)  # of the lever as the pin pushes it
BACK = math.radians(1.0)  # of the balance: so far behind the last touch it is let go again, or half its play in the slot


@dataclass(frozen=True, slots=True)
class Entry:
    """Where the pin meets the fork of a lever that rests on a bank (rad): coming in `way` (±1) it unlocks from `angle`; coming
    the other way it strikes the outside of the fork at `knock`, None where it passes."""

    angle: float
    way: float
    knock: float | None


@dataclass(frozen=True, slots=True)
class Fork:
    """The beat from the upper bank to the lower one first, then the one back. rad.

    lift_angle   of the balance, from the pin's meeting the fork on one bank to its leaving it on the other
    unlocking    of the balance, the part of it until the tooth leaves the locking face
    impulse_end  of the balance, the part of it until the tooth is let off, the pin driven by the fork
    pin_shake    of the lever, with the pin in the middle of the slot
    knocking     amplitude from rest at which the pin strikes the outside of the fork; nan where it never does
    from_rest    where the balance meets the fork, from its position of rest
    """

    lift_angle: tuple[Quantity, Quantity]
    unlocking: tuple[Quantity, Quantity]
    impulse_end: tuple[Quantity, Quantity]
    knocking: tuple[Quantity, Quantity]
    from_rest: tuple[Quantity, Quantity]
    pin_shake: Quantity
    entries: tuple[Entry, Entry]


class Balance:
    """Lever and balance turned by hand; the wheel stands where the scene puts it."""

    def __init__(self, hands: Hands, parts: Parts, rest: float) -> None:
        self.hands, self.parts, self.rest = hands, parts, rest
        self._q = np.array(hands.compiled.q)
        self._lever, self._balance = hands.coordinate(parts.lever), hands.coordinate(parts.balance)

    def at(self, lever: float, balance: float) -> Array:
        q = self._q.copy()
        q[self._lever], q[self._balance] = lever, balance
        return q

    def balance(self, lever: float, start: float, sense: float, reach: float = math.tau) -> Touch | None:
        """The first touch of the balance, turned from `start`."""
        return self.hands.touch(self.parts.balance, self.parts.to_balance, self.at(lever, start), sense, reach)

    def lever(self, start: float, balance: float, sense: float, ids: Integers | None = None, reach: float = 0.7) -> Touch | None:
        """The first touch of the lever with the balance, turned from `start`."""
        ids = self.parts.to_balance if ids is None else ids
        return self.hands.touch(self.parts.lever, ids, self.at(start, balance), sense, reach)

    def rates(self, touch: Touch, lever: float) -> tuple[float, float]:
        """How fast the gap opens as lever and balance turn, m/rad."""
        met = self.hands.meeting(touch.contact, self.at(lever, touch.angle))
        return met.rates[self.hands.body(self.parts.lever)], met.rates[self.hands.body(self.parts.balance)]

    def error(self, touch: Touch, lever: float) -> float:
        return self.hands.error(self.rates(touch, lever)[1])

    def entry(self, lever: float, side: float) -> Entry | None:
        """Where the pin comes into the fork of a lever on the bank of that side; None where it pushes it the same way from
        both sides, or not at all."""
        far = self.rest + math.pi
        unlocks: list[tuple[float, float]] = []
        knocks: list[float] = []
        for way in (1.0, -1.0):
            touch = self.balance(lever, far, way)
            if touch is None:
                continue
            # The lever gives way in the direction in which the gap opens.
            if side * self.rates(touch, lever)[0] < 0.0:
                unlocks.append((touch.angle, way))
            else:
                knocks.append(touch.angle)
        if len(unlocks) != 1:
            return None
        return Entry(*unlocks[0], knocks[0] if knocks else None)

    def pushed(self, entry: Entry, lever: float, end: float) -> Touch:
        """Where the balance stands when it has pushed the lever from `lever` to `end`."""
        steps = max(1, math.ceil(abs(end - lever) / STEP))
        angle, back = entry.angle, BACK
        for a in np.linspace(lever, end, steps + 1)[1:].tolist():
            touch = self.balance(a, angle - entry.way * back, entry.way, math.pi)
            if touch is None:
                raise ValueError(f"the pin passes the fork at {math.degrees(a):.2f}° of the lever without moving it")
            behind = self.balance(a, touch.angle, -entry.way)
            angle = touch.angle
            back = BACK if behind is None else min(BACK, 0.5 * abs(behind.angle - angle))
        return touch

    def play(self, lever: float, near: float) -> tuple[Touch, Touch] | None:
        """First touches of the balance on both sides of an angle at which it is free."""
        down, up = self.balance(lever, near, -1.0), self.balance(lever, near, 1.0)
        return None if down is None or up is None else (down, up)


def fork(balance: Balance, banks: tuple[float, float], beats: list[Passage], entries: tuple[Entry, Entry]) -> Fork:
    """All of it. ValueError in words where the pin cannot carry the lever over."""
    upper, lower = entries
    lifts, unlocks, ends, knocks, rests = [], [], [], [], []
    for side, own, other in ((1.0, upper, lower), (-1.0, lower, upper)):
        bank = banks[0] if side > 0.0 else banks[1]
        touch = balance.balance(bank, balance.rest + math.pi, own.way)
        assert touch is not None
        error = balance.error(touch, bank)
        # Within half a turn of each other: where the pin leaves is where it enters for the way back.
        lifts.append(single(_within(own.way * (other.angle - own.angle)), 2.0 * error))
        teeth = [one for one in beats if one.side == side][: len(beats) // 2]
        first = [balance.pushed(own, bank, one.unlocked.lever) for one in _different(teeth)]
        last = [_driven(balance, own, bank, one.let_off.lever) for one in _different(teeth)]
        numbers = [one.tooth for one in _different(teeth)]
        unlocks.append(over_teeth([own.way * (t.angle - own.angle) for t in first], [2.0 * error] * len(first), numbers))
        ends.append(over_teeth([own.way * (t.angle - own.angle) for t in last], [2.0 * error] * len(last), numbers))
        knock = math.nan if own.knock is None else _turns(-own.way * (own.knock - balance.rest))
        knocks.append(single(knock, error))
        rests.append(single(_within(own.angle - balance.rest), error))
    pairs = [(values[0], values[1]) for values in (lifts, unlocks, ends, knocks, rests)]
    return Fork(*pairs, pin_shake=pin_shake(balance, banks, upper), entries=entries)


def _different(beats: list[Passage]) -> list[Passage]:
    """Teeth that unlock or let go at other angles than the one before; of a sound drawing the first alone."""
    kept: list[Passage] = []
    for one in beats:
        alike = kept and math.isclose(one.unlocked.lever, kept[-1].unlocked.lever, abs_tol=1e-7)
        if not (alike and math.isclose(one.let_off.lever, kept[-1].let_off.lever, abs_tol=1e-7)):
            kept.append(one)
    return kept


def _driven(balance: Balance, entry: Entry, bank: float, lever: float) -> Touch:
    """Where the fork has driven the pin when the lever stands at `lever`: the wall behind the pin touches it."""
    front = balance.pushed(entry, bank, lever)
    behind = balance.balance(lever, front.angle, -entry.way)
    return front if behind is None else behind


def pin_shake(balance: Balance, banks: tuple[float, float], entry: Entry) -> Quantity:
    """Play of the lever with the pin in the middle of the slot, the lever in the middle."""
    middle = 0.5 * (banks[0] + banks[1])
    front = balance.pushed(entry, banks[0], middle)
    back = balance.balance(middle, front.angle, -entry.way)
    if back is None:
        return single(math.nan, math.nan)
    theta = 0.5 * (front.angle + back.angle)
    ends = [balance.lever(middle, theta, sense) for sense in (1.0, -1.0)]
    if ends[0] is None or ends[1] is None:
        return single(math.nan, math.nan)
    error = sum(balance.hands.error(_lever_rate(balance, end, theta)) for end in ends if end is not None)
    return single(ends[0].angle - ends[1].angle, error)


def _lever_rate(balance: Balance, touch: Touch, theta: float) -> float:
    met = balance.hands.meeting(touch.contact, balance.at(touch.angle, theta))
    return met.rates[balance.hands.body(balance.parts.lever)]


def _within(angle: float) -> float:
    """The same direction within half a turn."""
    return (angle + math.pi) % math.tau - math.pi


def _turns(angle: float) -> float:
    """The same direction from 0 to a whole turn."""
    return angle % math.tau
