"""How do fork and pin play together: lift angle of the balance, shake of the pin, and where would the pin knock?"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.escapement.by_hand import Array, Hands, Integers, Parts, Rest, Stretch, Touch
from watchsim.escapement.turning import WIDTH
from watchsim.geometry.primitives import GOLDEN

# One measured number: its mean over the teeth, the tooth that is furthest from it, and how exact it is.


@dataclass(frozen=True, slots=True)
class Quantity:
    """`value` (rad, or m) with its `error`; `worst` is the value of the tooth `tooth` that differs most.

    Teeth are counted anticlockwise from 1, the one nearest to the wheel's own x axis, as in verdicts; None for what has nothing
    to do with a tooth. A drop is that of the tooth let off. The error covers what the outlines leave open at their joints and
    the width to which changes were halved; the drawing's own decimals come on top.
    """

    value: float
    error: float
    worst: float
    tooth: int | None = None

    @property
    def spread(self) -> float:
        """How far the worst tooth is from the mean."""
        return abs(self.worst - self.value)


def single(value: float, error: float) -> Quantity:
    return Quantity(value, error, value)


def over_teeth(values: Sequence[float], errors: Sequence[float], teeth: Sequence[int]) -> Quantity:
    """The mean over the teeth; nan where there is none."""
    if not values:
        return Quantity(math.nan, math.nan, math.nan)
    mean = float(np.mean(values))
    worst = int(np.argmax(np.abs(np.asarray(values) - mean)))
    return Quantity(mean, float(max(errors)), float(values[worst]), teeth[worst])


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


STEP = math.radians(0.25)  # of the lever as the pin carries it
BACK = math.radians(1.0)  # of the balance: a pin that has one wall only stands half as far from it
FARTHEST = math.radians(40.0)  # of the lever
SLOT = math.radians(6.0)  # of the balance: walls that are closer are those of the slot
FINER = 5.0  # times as small steps, where the pin was lost
WALLS = math.radians(40.0)  # of the balance: what is further away is no wall of the slot


@dataclass(frozen=True, slots=True)
class Entry:
    """Where the pin meets the fork of a lever that rests on a bank (rad): coming in `way` (±1) it unlocks from `angle`; coming
    the other way it strikes the outside of the fork at `knock`, None where it passes."""

    angle: float
    way: float
    contact: int
    knock: float | None


@dataclass(frozen=True, slots=True)
class Slot:
    """The balance angles at which the pin touches the wall ahead of it and the one behind it; None where there is none."""

    front: Touch | None
    back: Touch | None

    def nearest(self, near: float) -> Touch:
        """The wall nearest to a balance angle."""
        walls = [wall for wall in (self.front, self.back) if wall is not None]
        return min(walls, key=lambda wall: abs(wall.angle - near))

    def free(self, near: float) -> float:
        """A balance angle in the middle of the slot, or close to the wall nearest to `near` where the other is far away.

        What is far away may be no wall of the slot but a horn that comes up later.
        """
        if self.front is not None and self.back is not None and abs(self.front.angle - self.back.angle) < SLOT:
            return 0.5 * (self.front.angle + self.back.angle)
        walls = [wall.angle for wall in (self.front, self.back) if wall is not None]
        wall = min(walls, key=lambda angle: abs(angle - near))
        room = min([BACK, *(abs(other - wall) for other in walls if other != wall)])
        return wall + math.copysign(0.5 * room, near - wall)


@dataclass(frozen=True, slots=True)
class Fork:
    """The beat from the upper bank to the lower one first, then the one back. rad.

    lift_angle   of the balance, from the pin's meeting the fork on one bank to its leaving it on the other
    unlocking    of the balance, the part of it until the tooth leaves the locking face, driven by the pin
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

    def lever(self, start: float, balance: float, sense: float) -> Touch | None:
        """The first touch of the lever with the balance, turned from `start`."""
        return self.hands.touch(self.parts.lever, self.parts.to_balance, self.at(start, balance), sense, FARTHEST)

    def freedoms(self, start: float, balances: list[float], sense: float, ids: Integers) -> list[float]:
        """How far the lever can be turned from `start` with the balance at each angle, rad; infinite: nothing stops it."""
        q = self.at(start, 0.0)
        # As the difference of two angles, each of which is rounded, that a single `lever` gives.
        turns = self.hands.turns(self.parts.lever, ids, q, sense, FARTHEST, self._balance, balances)
        return np.abs((start + sense * turns) - start).tolist()

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
        unlocks: list[tuple[float, float, int]] = []
        knocks: list[float] = []
        for way in (1.0, -1.0):
            touch = self.balance(lever, far, way)
            if touch is None:
                continue
            # The lever gives way in the direction in which the gap opens.
            if side * self.rates(touch, lever)[0] < 0.0:
                unlocks.append((touch.angle, way, touch.contact))
            else:
                knocks.append(touch.angle)
        if len(unlocks) != 1:
            return None
        return Entry(*unlocks[0], knocks[0] if knocks else None)

    def carried(self, entry: Entry, start: float, ends: Iterable[float]) -> dict[float, Slot]:
        """Where the pin may stand in the slot as the lever goes from its bank at `start` through all angles `ends`.

        ValueError where the pin leaves the fork on the way.
        """
        wanted = list(ends)
        try:
            return self._carried(entry, start, wanted, STEP)
        except ValueError:
            return self._carried(entry, start, wanted, STEP / FINER)

    def _carried(self, entry: Entry, start: float, ends: list[float], step: float) -> dict[float, Slot]:
        found: dict[float, Slot] = {}
        lever, free, rate = start, entry.angle - entry.way * 0.5 * BACK, self._shift(Touch(entry.angle, entry.contact), start)
        for end in sorted(ends, key=lambda angle: abs(angle - start)):
            steps = max(1, math.ceil(abs(end - lever) / step))
            for a in np.linspace(lever, end, steps + 1).tolist():
                free += rate * (a - lever)
                lever = a
                slot = self._slot(entry, a, free)
                free, rate = slot.free(free), self._shift(slot.nearest(free), a)
            found[end] = slot
        return found

    def _slot(self, entry: Entry, lever: float, free: float) -> Slot:
        """The walls of the slot around a pin at balance angle `free`."""
        front, back = (self.balance(lever, free, sense * entry.way, WALLS) for sense in (1.0, -1.0))
        if front is None and back is None:
            raise ValueError(f"the pin is clear of the fork with the lever at {math.degrees(lever):.2f}°")
        return Slot(front, back)

    def carried_error(self, slot: Slot, rest: Rest) -> float:
        """Of a balance angle, by how well the lever's angle is known at which the wheel goes from face to face, rad."""
        wall = slot.front or slot.back
        assert wall is not None
        return change_error(self.hands, self.parts, rest) * abs(self._shift(wall, rest.lever))

    def _shift(self, wall: Touch, lever: float) -> float:
        """Turn of the balance by turn of the lever that keeps a wall touching."""
        of_lever, of_balance = self.rates(wall, lever)
        return -of_lever / of_balance


def fork(balance: Balance, banks: tuple[float, float], beats: list[Passage], entries: tuple[Entry, Entry]) -> Fork:
    """All of it. ValueError in words where the pin cannot carry the lever over."""
    upper, lower = entries
    lifts: list[Quantity] = []
    unlocks: list[Quantity] = []
    ends: list[Quantity] = []
    knocks: list[Quantity] = []
    rests: list[Quantity] = []
    for side, own, other in ((1.0, upper, lower), (-1.0, lower, upper)):
        bank = banks[0] if side > 0.0 else banks[1]
        touch = balance.balance(bank, balance.rest + math.pi, own.way)
        assert touch is not None
        error = balance.error(touch, bank)
        # Within half a turn of each other: where the pin leaves is where it enters for the way back.
        lifts.append(single(_within(own.way * (other.angle - own.angle)), 2.0 * error))
        teeth = _different([one for one in beats if one.side == side][: len(beats) // 2])
        numbers = [one.tooth for one in teeth]
        # A stone of the balance itself is pushed on after the pin may have left the fork.
        by_fork = {one.let_off.lever for one in teeth if one.direct is None}
        slots = balance.carried(own, bank, {one.unlocked.lever for one in teeth} | by_fork)
        first = [_angle(slots[one.unlocked.lever].front) for one in teeth]
        last = [_angle(slots[one.let_off.lever].back) if one.direct is None else one.direct.end for one in teeth]
        for out, angles, places in (
            (unlocks, first, [one.unlocked for one in teeth]),
            (ends, last, [one.let_off for one in teeth]),
        ):
            carried = [balance.carried_error(slots[place.lever], place) if place.lever in slots else 0.0 for place in places]
            errors = [
                2.0 * error + one + (tooth.direct.error if tooth.direct else 0.0)
                for one, tooth in zip(carried, teeth, strict=True)
            ]
            out.append(over_teeth([own.way * (angle - own.angle) for angle in angles], errors, numbers))
        knock = math.nan if own.knock is None else _turns(-own.way * (own.knock - balance.rest))
        knocks.append(single(knock, error))
        rests.append(single(_within(own.angle - balance.rest), error))
    made = [(values[0], values[1]) for values in (lifts, unlocks, ends, knocks, rests)]
    return Fork(made[0], made[1], made[2], made[3], made[4], pin_shake(balance, banks, upper), entries)


def _different(beats: list[Passage]) -> list[Passage]:
    """Teeth that unlock or let go at other angles than the one before; of a sound drawing the first alone."""
    kept: list[Passage] = []
    for one in beats:
        alike = kept and math.isclose(one.unlocked.lever, kept[-1].unlocked.lever, abs_tol=1e-7)
        if not (alike and math.isclose(one.let_off.lever, kept[-1].let_off.lever, abs_tol=1e-7)):
            kept.append(one)
    return kept


def _angle(touch: Touch | None) -> float:
    return math.nan if touch is None else touch.angle


def pin_shake(balance: Balance, banks: tuple[float, float], entry: Entry) -> Quantity:
    """Play of the lever with the pin in the middle of the slot, the lever in the middle."""
    middle = 0.5 * (banks[0] + banks[1])
    slot = balance.carried(entry, banks[0], [middle])[middle]
    if slot.front is None or slot.back is None:
        return single(math.nan, math.nan)
    theta = 0.5 * (slot.front.angle + slot.back.angle)
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
    """The same direction, a quarter of a turn or more away: a pin that knocks has gone most of the way round."""
    return (angle - 0.5 * math.pi) % math.tau + 0.5 * math.pi


# The freedom of the lever is how far it can be turned off its bank before something stops it. As long as that is less than
# the total lock, the tooth stays on the locking face and draw brings the lever back.

SCAN = math.radians(1.0)  # of the balance
FINE = 1e-9  # rad of the balance: the worst place is known to that
FACES_CRESCENT = 1.5  # times the guard's freedom: the dart faces the crescent and the horns have to guard


@dataclass(frozen=True, slots=True)
class Safety:
    """Freedoms of the lever, from one bank, rad; nan where nothing stops it or the scene has no such part.

    guard   dart against safety roller, the pin opposite the fork
    horn    horns against pin where the dart faces the crescent: the largest
    worst   the largest over all places of the balance, at balance angle `worst_at` from rest; inf where the lever can cross
    guard_clearance: from dart to roller on the bank, m
    """

    guard: Quantity
    horn: Quantity
    worst: Quantity
    worst_at: float
    guard_clearance: float


def safety(balance: Balance, bank: float, side: float, entry: Entry, horns_too: bool = True) -> Safety | None:
    """Of the lever on the bank of that side; None where the scene declares nothing besides the fork that could stop it.

    Without `horns_too` their freedom is not measured (nan), only that of the guard and the largest of all.
    """
    hands = balance.hands
    far = balance.rest + math.pi
    groups = np.array(hands.model.contacts.group)[balance.parts.to_balance]
    stop = balance.lever(bank, far, -side)
    if stop is None and not balance.parts.guarded:
        return None
    if stop is None:
        never = single(math.inf, 0.0)
        return Safety(never, single(math.nan, math.nan), never, math.pi, math.nan)
    own = int(hands.model.contacts.group[stop.contact])
    guarding, horns = balance.parts.to_balance[groups == own], balance.parts.to_balance[groups != own]

    def freedoms(angles: list[float], ids: Integers) -> list[float]:
        return balance.freedoms(bank, angles, -side, ids)

    everything = balance.parts.to_balance
    guard = abs(stop.angle - bank)
    places = _outside(entry, far)
    at, worst = _peak(lambda angles: freedoms(angles, everything), places)
    dart = freedoms(places, guarding) if horns_too else []
    facing = [i for i, value in enumerate(dart) if value > FACES_CRESCENT * guard]
    horn = math.nan
    if facing and len(horns):
        chosen = [places[i] for i in facing]
        _, horn = _peak(lambda angles: freedoms(angles, horns), chosen)
    met = hands.meeting(stop.contact, balance.at(stop.angle, far))
    rate = met.rates[hands.body(balance.parts.lever)]
    error = hands.error(rate)
    return Safety(
        single(guard, error),
        single(horn, error),
        single(worst, error),
        (at - balance.rest + math.pi) % math.tau - math.pi,
        hands.gap(stop.contact, balance.at(bank, far)),
    )


def _outside(entry: Entry, far: float) -> list[float]:
    """Balance angles from opposite the fork up to where the pin comes in, and from there back to where it would knock."""
    width = abs((entry.angle - far + math.pi) % math.tau - math.pi)
    back = math.pi if entry.knock is None else abs(entry.knock - far)
    count = int((width + back) / SCAN)
    return [entry.angle - entry.way * (i * SCAN + FINE) for i in range(count)]


def _peak(function: Callable[[list[float]], list[float]], places: list[float]) -> tuple[float, float]:
    """Place and height of the largest value, by golden section between the neighbours of the highest place."""
    values = function(places)
    i = max(range(len(values)), key=values.__getitem__)
    if not math.isfinite(values[i]):
        return places[i], values[i]
    low, high = places[max(i - 1, 0)], places[min(i + 1, len(places) - 1)]
    best = (places[i], values[i])
    one, two = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    first, second = function([one, two])
    while abs(high - low) > FINE:
        best = max(best, (one, first), (two, second), key=lambda pair: pair[1])
        if first > second:
            high, two, second = two, one, first
            one = high - GOLDEN * (high - low)
            (first,) = function([one])
        else:
            low, one, first = one, two, second
            two = low + GOLDEN * (high - low)
            (second,) = function([two])
    return best
