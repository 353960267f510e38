"""How does the wheel rest while the lever is led from one side to the other?

The lever is turned slowly; the wheel, pressed by its drive, rests on a stone or is let off and drops on the next. Between the
places where something changes the rest is a smooth function of the lever's angle; the places are found by halving.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from watchsim.escapement.by_hand.escapement_parts import Parts
from watchsim.escapement.by_hand.hands import Array, Hands, Integers, Touch

STEP = math.radians(0.25)  # of the lever, in the search for changes
WIDTH = 1e-11  # rad of the lever: a change is known to that
LEVEL = 1e-7  # a wheel that turns by less than that share of the lever's turn stands still
JUMP = 2.0  # times what its slope explains, and a little: the wheel has been let off
LITTLE = math.radians(0.02)
NEIGHBOURS = 0.75  # of a pitch to both sides: what is looked at while a tooth rests


@dataclass(frozen=True, slots=True)
class Rest:
    """The wheel at `wheel` (rad) rests with a tooth on a stone, the lever at `lever` (rad).

    `slope`: turn of the wheel with its drive, by turn of the lever the way it is led; negative where the wheel is driven back.
    `on_stone`: the stone's face is touched (by a corner of the tooth), not the tooth's. `error` is the wheel's, rad.
    """

    lever: float
    wheel: float
    contact: int
    slope: float
    on_stone: bool
    stone: int
    tooth: int
    x: float
    y: float
    error: float


@dataclass(frozen=True, slots=True)
class Stretch:
    """The lever goes from `first` to `last` while one corner slides along one face."""

    first: Rest
    last: Rest

    @property
    def turn(self) -> float:
        return abs(self.last.lever - self.first.lever)


@dataclass(frozen=True, slots=True)
class LetOff:
    """The tooth of `last` leaves its stone, and the wheel drops until `landed`; None where nothing stops it."""

    last: Rest
    landed: Rest | None


@dataclass(frozen=True, slots=True)
class Sweep:
    """Everything between two angles of the lever, in order. `room` (rad): how far the wheel could be turned back, at each
    end of a stretch."""

    stretches: tuple[Stretch, ...]
    let_offs: tuple[LetOff, ...]
    room: tuple[float, ...]

    @property
    def last(self) -> Rest | None:
        """Where the wheel rests in the end; None where it runs free."""
        if self.let_offs and self.let_offs[-1].landed is None:
            return None
        return self.stretches[-1].last


class Wheel:
    """Wheel and lever of a scene, turned by hand."""

    def __init__(self, hands: Hands, parts: Parts, pitch: float) -> None:
        self.hands, self.parts, self.pitch = hands, parts, pitch
        self._q = np.array(hands.compiled.q)
        self._wheel, self._lever = hands.coordinate(parts.wheel), hands.coordinate(parts.lever)
        self._wheel_body, self._lever_body = hands.body(parts.wheel), hands.body(parts.lever)
        self._polar = self._tooth_places()

    def at(self, lever: float, wheel: float) -> Array:
        """Coordinates with lever and wheel there."""
        q = self._q.copy()
        q[self._lever], q[self._wheel] = lever, wheel
        return q

    def rest(self, lever: float, wheel: float, led: float, ids: Integers | None = None) -> Rest | None:
        """Where the wheel, let go at `wheel`, rests; None where it is free for a pitch. `led`: ±1, the lever's way."""
        q = self.at(lever, wheel)
        ids = self.parts.to_wheel if ids is None else ids
        touch = self.hands.touch(self.parts.wheel, ids, q, self.parts.way, 1.2 * self.pitch)
        return None if touch is None else self._described(lever, touch, led)

    def room(self, rest: Rest) -> float:
        """How far the resting wheel can be turned back until another place touches, rad."""
        q = self.at(rest.lever, rest.wheel)
        touch = self.hands.touch(self.parts.wheel, self.parts.to_wheel, q, -self.parts.way, self.pitch)
        return self.pitch if touch is None else abs(touch.angle - rest.wheel)

    def lead(self, start: Rest, end: float) -> Sweep:
        """Lead the lever from a rest to `end` (rad)."""
        led = math.copysign(1.0, end - start.lever)
        stretches: list[Stretch] = []
        let_offs: list[LetOff] = []
        rooms: list[float] = []
        here = self._again(start, led)
        while True:
            room = self.room(here)
            rooms.append(room)
            ids = self._around(here.tooth)
            last, after = self._stretch(here, end, led, ids, 0.5 * room)
            stretches.append(Stretch(here, last))
            if last.lever == end:
                return Sweep(tuple(stretches), tuple(let_offs), tuple(rooms))
            if after is not None and not self._jumps(last, after):
                here = after
                continue
            # Beyond the last place at which the tooth is held: let go at the wheel's own angle there.
            lever = last.lever + led * WIDTH
            landed = self.rest(lever, last.wheel, led)
            let_offs.append(LetOff(last, landed))
            if landed is None:
                return Sweep(tuple(stretches), tuple(let_offs), tuple(rooms))
            here = landed

    def _stretch(self, here: Rest, end: float, led: float, ids: Integers, back: float) -> tuple[Rest, Rest | None]:
        """The last rest of the same kind as `here`, and what is found just beyond it."""

        def at(lever: float, near: Rest) -> Rest | None:
            return self.rest(lever, near.wheel - self.parts.way * back, led, ids)

        good = here
        while good.lever != end:
            lever = good.lever + led * min(STEP, abs(end - good.lever))
            lever = end if abs(end - lever) < WIDTH else lever
            found = at(lever, good)
            if found is None or self._differs(good, found):
                return self._change(good, lever, found, at)
            good = found
        return good, None

    def _change(
        self, good: Rest, bad: float, beyond: Rest | None, at: Callable[[float, Rest], Rest | None]
    ) -> tuple[Rest, Rest | None]:
        while abs(bad - good.lever) > WIDTH:
            lever = 0.5 * (good.lever + bad)
            found = at(lever, good)
            if found is None or self._differs(good, found):
                bad, beyond = lever, found
            else:
                good = found
        return good, beyond

    def _differs(self, one: Rest, other: Rest) -> bool:
        same = one.contact == other.contact and _sign(one.slope) == _sign(other.slope)
        return not same or self._jumps(one, other)

    def _jumps(self, one: Rest, other: Rest) -> bool:
        way = abs(other.lever - one.lever)
        return abs(other.wheel - one.wheel) > JUMP * max(abs(one.slope), abs(other.slope)) * way + LITTLE

    def _again(self, rest: Rest, led: float) -> Rest:
        """The same place, seen with the lever led the other way."""
        return self._described(rest.lever, Touch(rest.wheel, rest.contact), led)

    def _described(self, lever: float, touch: Touch, led: float) -> Rest:
        q = self.at(lever, touch.angle)
        met = self.hands.meeting(touch.contact, q)
        of_wheel, of_lever = met.rates[self._wheel_body], met.rates[self._lever_body]
        # The contact stays closed: its rate vanishes.
        slope = -self.parts.way * led * of_lever / of_wheel
        on_stone = met.flat == self._lever_body
        first, second = met.primitives
        stone, tooth = (second, first) if on_stone else (first, second)
        return Rest(lever, touch.angle, touch.contact, slope, on_stone, stone, tooth, *met.point, self.hands.error(of_wheel))

    def _tooth_places(self) -> dict[int, float]:
        """Polar angle of each of the wheel's primitives in its own frame."""
        primitives = self.hands.model.primitives
        own = np.flatnonzero(np.array(primitives.body) == self._wheel_body)
        return dict(zip(own.tolist(), np.arctan2(primitives.py[own], primitives.px[own]).tolist(), strict=True))

    def polar(self, tooth: int) -> float:
        """Where a primitive of the wheel stands in its own frame, rad."""
        return self._polar[tooth]

    def _around(self, tooth: int) -> Integers:
        """The contacts with the wheel's primitives around this one."""
        if not hasattr(self, "_places"):
            contacts = self.hands.model.contacts
            ids = self.parts.to_wheel
            polar = np.full(len(self.hands.model.primitives), np.nan)
            polar[list(self._polar)] = list(self._polar.values())
            a, b = polar[contacts.a[ids]], polar[contacts.b[ids]]
            self._places = np.where(np.isnan(a), b, a)
        off = (self._places - self._polar[tooth] + math.pi) % math.tau - math.pi
        return np.ascontiguousarray(self.parts.to_wheel[np.abs(off) <= NEIGHBOURS * self.pitch])


def _sign(slope: float) -> int:
    return 0 if abs(slope) <= LEVEL else (1 if slope > 0.0 else -1)
