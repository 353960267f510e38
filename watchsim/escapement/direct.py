"""How does the wheel push a stone of the balance itself, the direct impulse of a co-axial escapement?

The balance is led on from where its pin has unlocked the wheel; pin and fork carry the lever along, the wheel follows the
stone. Exact as the sweep of the lever is: where the stone lets go is halved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.escapement.by_hand.hands import Array, Touch
from watchsim.escapement.by_hand.lever_sweep import JUMP, LITTLE, WIDTH, Rest, Wheel
from watchsim.escapement.fork_and_pin import Balance, Entry
from watchsim.escapement.tooth_passage import Direct

STEP = math.radians(0.25)  # of the balance
AHEAD = math.radians(0.5)  # of the lever: more than a step of the balance carries it
FARTHEST = math.radians(120.0)  # of the balance: no impulse lasts longer
SLIDES = 3.0  # times the way along the arm, as in pallets.change_error


@dataclass(frozen=True, slots=True)
class _Place:
    """Lever, balance and wheel at one step, the contact that holds the wheel, and dwheel/dbalance there."""

    lever: float
    balance: float
    touch: Touch
    slope: float


class Roller:
    """Wheel, lever and balance turned by hand together. `entries`: from the upper bank, and from the lower one."""

    def __init__(self, wheel: Wheel, balance: Balance, banks: tuple[float, float], entries: tuple[Entry, Entry]) -> None:
        self.wheel, self.balance, self.banks, self.entries = wheel, balance, banks, entries
        self.hands, self.parts = wheel.hands, wheel.parts
        self._both = np.unique(np.concatenate((self.parts.to_wheel, self.parts.to_roller)))
        self._own = frozenset(self.parts.to_roller.tolist())

    def impulse(self, unlocked: Rest, side: float) -> Direct | None:
        """From where the lever's stone on the bank of that side has just let go; None where the wheel meets no stone of the
        balance there. ValueError where the pin does not get that far, or the stone is never let go."""
        k = 0 if side > 0.0 else 1
        entry = self.entries[k]
        front = self.balance.carried(entry, self.banks[k], {unlocked.lever})[unlocked.lever].front
        if front is None:
            raise ValueError("the pin does not unlock the lever")
        first = self._at(unlocked.lever - side * WIDTH, front.angle, unlocked.wheel, 0.0)
        if first is None or first.touch.contact not in self._own:
            return None
        last = self._follow(first, -side, entry.way)
        error = WIDTH + self.balance.error(front, unlocked.lever) + self._end_error(last)
        return Direct(self._rest(first), self._rest(last), first.balance, last.balance, error)

    def _follow(self, first: _Place, led: float, way: float) -> _Place:
        here = first
        while abs(here.balance - first.balance) < FARTHEST:
            on = self._next(here, here.balance + way * STEP, led)
            if on is None:
                return self._halved(here, here.balance + way * STEP, led)
            here = on
        raise ValueError(f"the stone of {self.parts.balance} is never let go")

    def _halved(self, good: _Place, bad: float, led: float) -> _Place:
        while abs(bad - good.balance) > WIDTH:
            middle = 0.5 * (good.balance + bad)
            found = self._next(good, middle, led)
            if found is None:
                bad = middle
            else:
                good = found
        return good

    def _next(self, here: _Place, balance: float, led: float) -> _Place | None:
        """A little further on; None where the stone no longer holds the wheel."""
        found = self._at(self._carried(here.lever, balance, led), balance, here.touch.angle, STEP)
        if found is None or found.touch.contact not in self._own:
            return None
        explained = JUMP * max(abs(here.slope), abs(found.slope)) * abs(balance - here.balance) + LITTLE
        return found if abs(found.touch.angle - here.touch.angle) <= explained else None

    def _carried(self, lever: float, balance: float, led: float) -> float:
        """Where the pin has pushed the lever; what it has passed stays where it is."""
        q = self.balance.at(lever, balance)
        touch = self.hands.touch(self.parts.lever, self.parts.to_balance, q, -led, AHEAD, AHEAD)
        return lever if touch is None or led * (touch.angle - lever) < 0.0 else touch.angle

    def _at(self, lever: float, balance: float, wheel: float, behind: float) -> _Place | None:
        q = self._coordinates(lever, balance, wheel)
        touch = self.hands.touch(self.parts.wheel, self._both, q, self.parts.way, 1.2 * self.wheel.pitch, behind)
        if touch is None:
            return None
        met = self.hands.meeting(touch.contact, self._coordinates(lever, balance, touch.angle))
        of_wheel = met.rates[self.hands.body(self.parts.wheel)]
        of_balance = met.rates.get(self.hands.body(self.parts.balance), 0.0)
        return _Place(lever, balance, touch, -of_balance / of_wheel)

    def _coordinates(self, lever: float, balance: float, wheel: float) -> Array:
        q = self.balance.at(lever, balance)
        q[self.hands.coordinate(self.parts.wheel)] = wheel
        return q

    def _rest(self, place: _Place) -> Rest:
        met = self.hands.meeting(place.touch.contact, self._coordinates(place.lever, place.balance, place.touch.angle))
        of_wheel = met.rates[self.hands.body(self.parts.wheel)]
        on_stone = met.flat == self.hands.body(self.parts.balance)
        stone, tooth = met.primitives[::-1] if on_stone else met.primitives
        error = self.hands.error(of_wheel)
        return Rest(place.lever, place.touch.angle, place.touch.contact, place.slope, on_stone, stone, tooth, *met.point, error)

    def _end_error(self, last: _Place) -> float:
        """Of the balance's angle at which a corner comes to the end of the stone: a contact counts a little beyond it."""
        rest = self._rest(last)
        x, y = self.hands.pivot(self.parts.balance, self.hands.compiled.q)
        return SLIDES * (self.hands.room + self.hands.resolution) / math.hypot(rest.x - x, rest.y - y)
