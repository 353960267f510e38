"""What do wheel and stones do in a beat: lock, draw, recoil, lift, drop?"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from watchsim.escapement.by_hand import Array, Hands, Rest, Touch, Wheel
from watchsim.escapement.fork_and_pin import Balance, Direct, Entry, Passage, Quantity, change_error, over_teeth
from watchsim.escapement.turning import JUMP, LITTLE, WIDTH
from watchsim.model import ARC, FULL

# The balance is led on from where its pin has unlocked the wheel; pin and fork carry the lever along, the wheel follows the
# stone. Exact as the sweep of the lever is: where the stone lets go is halved.

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


# Of an escapement in which the wheel, once unlocked, runs free until it meets an impulse stone. In a Swiss lever the tooth
# goes on from the locking face to the impulse face of the same stone, and nothing of this is reported.

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


@dataclass(frozen=True, slots=True)
class Pallet:
    """One stone, mean over the teeth and worst tooth. Angles of the lever at its pivot unless said otherwise, rad.

    total_lock   from the bank until the tooth leaves the locking face
    lock         the part of it that is left when the tooth has just dropped on this stone
    run          the rest of it: from the drop to the bank
    draw         of the locking face: angle between its normal and the line to the lever's pivot, lever on the bank; the
                 wheel's pressure pulls the lever to the bank where it is positive
    draw_end     the same just before unlocking; nan for a round pin, where a tooth's corner rounds it and none is left
    recoil       of the wheel, driven back while the stone is unlocked; by an anchor without banking, from the lock to where it
                 is turned back
    lift         from unlocked to let off; lift_stone with the tooth's corner on the stone's face, lift_tooth with the stone's
                 corner on the tooth's face; nan where another stone than this one takes the impulse
    drop         of the wheel: free way from leaving this stone to the lock on the other one
    shake        of the wheel: how far it can be turned back as the stone is about to be unlocked; negative where it jams
    """

    total_lock: Quantity
    lock: Quantity
    run: Quantity
    draw: Quantity
    draw_end: Quantity
    recoil: Quantity
    lift: Quantity
    lift_stone: Quantity
    lift_tooth: Quantity
    drop: Quantity
    shake: Quantity


def pallet(wheel: Wheel, beats: Sequence[Passage], side: float, detached: bool) -> Pallet:
    """The numbers of the stone that locks on the bank of that side."""
    hands, pivot = wheel.hands, wheel.hands.pivot(wheel.parts.lever, wheel.at(0.0, 0.0))
    pairs = [(one, before) for before, one in pairwise(beats) if one.side == side]
    own, before = [one for one, _ in pairs], [earlier for _, earlier in pairs]
    teeth = [one.tooth for one in own]
    way = wheel.parts.way

    def mean(value: Callable[[Passage, Passage], float], error: Callable[[Passage], float]) -> Quantity:
        values = [value(one, earlier) for one, earlier in zip(own, before, strict=True)]
        return over_teeth(values, [error(one) for one in own], teeth)

    def recoil(one: Passage, earlier: Passage) -> float:
        """An anchor drives the wheel back as it swings out, a lever as it comes back from its bank."""
        return way * (one.start.wheel - one.unlocked.wheel if detached else earlier.landed.wheel - one.start.wheel)

    def of_lever(one: Passage) -> float:
        return change_error(hands, wheel.parts, one.unlocked) + change_error(hands, wheel.parts, one.let_off)

    def of_wheel(one: Passage) -> float:
        places = one.start, one.unlocked, one.let_off, one.landed
        return sum(place.error + change_error(hands, wheel.parts, place) * abs(place.slope) for place in places)

    def of_draw(one: Passage) -> float:
        return _face_error(hands, one.start.stone if one.start.on_stone else one.start.tooth)

    none = over_teeth([], [], [])
    rounded = all(_on_round_pin(hands, one.unlocked) for one in own)
    pushed = any(one.caught is not None for one in own)
    return Pallet(
        total_lock=mean(lambda one, _: side * (one.start.lever - one.unlocked.lever), of_lever) if detached else none,
        lock=mean(lambda one, earlier: side * (earlier.let_off.lever - one.unlocked.lever), of_lever),
        run=mean(lambda _, earlier: side * (earlier.end - earlier.let_off.lever), of_lever) if detached else none,
        draw=mean(lambda one, _: draw_angle(wheel, one.start, pivot, side), of_draw),
        draw_end=none if rounded else mean(lambda one, _: draw_angle(wheel, one.unlocked, pivot, side), of_draw),
        recoil=mean(recoil, of_wheel),
        lift=mean(lambda one, _: side * (one.unlocked.lever - one.let_off.lever), of_lever),
        lift_stone=none if pushed else mean(lambda one, _: sum(s.turn for s in one.driven if s.first.on_stone), of_lever),
        lift_tooth=none if pushed else mean(lambda one, _: sum(s.turn for s in one.driven if not s.first.on_stone), of_lever),
        drop=mean(lambda one, _: way * (one.landed.wheel - one.let_off.wheel), of_wheel),
        shake=mean(lambda one, _: one.room, of_wheel),
    )


def draw_angle(wheel: Wheel, rest: Rest, pivot: tuple[float, float], side: float) -> float:
    """Angle (rad) between the normal of the touched face and the line to the lever's pivot, positive towards the bank."""
    met = wheel.hands.meeting(rest.contact, wheel.at(rest.lever, rest.wheel))
    arm = math.dist(met.point, pivot)
    opening = met.rates[wheel.hands.body(wheel.parts.lever)]
    return math.asin(max(-1.0, min(1.0, side * opening / arm)))


def least_arm(wheel: Wheel, beats: Sequence[Passage], side: float) -> float:
    """Of what locks on the bank of that side: the least distance of the touched points from the lever's pivot, m."""
    pivot = wheel.hands.pivot(wheel.parts.lever, wheel.at(0.0, 0.0))
    rests = [rest for one in beats if one.side == side for rest in (one.start, one.unlocked)]
    places = [wheel.hands.meeting(rest.contact, wheel.at(rest.lever, rest.wheel)).point for rest in rests]
    return min(math.dist(place, pivot) for place in places)


def _on_round_pin(hands: Hands, rest: Rest) -> bool:
    """Does a corner of a tooth lie on the round of a pin?"""
    stone = hands.model.primitives[rest.stone]
    return rest.on_stone and stone.kind == ARC and stone.extent == FULL


def _face_error(hands: Hands, primitive: int) -> float:
    p = hands.model.primitives[primitive]
    return 2.0 * hands.resolution / max(float(p.length), float(p.radius))
