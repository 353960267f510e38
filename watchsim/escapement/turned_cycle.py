"""How does a mechanism go through its cycle when it is turned by hand?

The oscillator is led from one end of its swing to the other and back, in small steps. What it meets gives way along its one
coordinate. After every step each pressed body (the driven wheel) goes on in its direction until something holds it: a body that
can yield is driven along until it stands against another one, as draw drives a lever to its banking and an impulse face a fork
against the pin; what cannot yield holds. No force enters: friction, inertia and speed are left to a run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from watchsim.escapement.couples import HARMLESS, Couple, Near, couples, motion_at, opening, pose_of
from watchsim.geometry.primitives import Point
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import goes_with

# A state of coordinates is free of overlap from the start and stays so. Bodies go as far as the exact distance allows (a body
# whose points travel no faster than r per unit of its coordinate may move by distance / r), and what a moved body runs into
# is pushed away, along the one coordinate it has, by the least that frees the two. Bodies geared to each other go together.

TOUCHING = 2e-8  # m: what comes so close is in touch
CLOSE_UP = 1e-8  # m: how close a body is driven up to another
LARGEST_PUSH = (
    2e-5  # m: what is not free after so much is jammed; where the led body goes further in two fine steps, after those
)
LEVERAGE = 0.02  # of the arm: a contact whose normal passes closer to the pivot holds instead of turning
CREEP = 1e-6  # m: how far a body goes on along what it touches, before it looks again
NEARBY = 5e-6  # m: what is further away is not looked at in detail
ROUNDS = 20000
HALVINGS = 60
CLOSEST = 1e-13  # m: how exactly that distance is met


class Jam(Exception):
    """A body is in the way and cannot give way."""

    def __init__(self, couple: Couple, place: Point, why: str) -> None:
        super().__init__(why)
        self.couple, self.place, self.why = couple, place, why
        self.passed_on: list[Couple] = []  # through which couples the push came, the last first


@dataclass
class Assembly:
    """Bodies of one coordinate each at coordinates `q` (rad or m; nan for fixed ones), and what may touch what."""

    bodies: tuple[Body, ...]
    couples: tuple[Couple, ...]
    q: list[float]
    stay: set[int] = field(default_factory=set)  # bodies that nothing pushes away: fixed ones, and the one that is led
    trains: dict[int, dict[int, float]] = field(default_factory=dict)  # body -> how far each geared to it goes for one unit
    stops: dict[int, tuple[float, float]] = field(
        default_factory=dict
    )  # where a spring's stop holds a body, and against which sign
    largest_push: float = LARGEST_PUSH  # m
    _known: dict[int, tuple[float, float, Near]] = field(default_factory=dict)

    def of(self, number: int) -> Iterator[Couple]:
        """The couples of a body and of all that are geared to it."""
        train = self.train(number)
        return (couple for couple in self.couples if couple.a in train or couple.b in train)

    def train(self, number: int) -> dict[int, float]:
        """The bodies that move with one, itself included: how far each goes for one unit of it."""
        return self.trains.get(number) or {number: 1.0}

    def other(self, couple: Couple, number: int) -> int:
        """The body of a couple that does not move with `number`."""
        return couple.b if couple.a in self.train(number) else couple.a

    def place(self, number: int, value: float) -> None:
        """Set the coordinate of a body, and of all that are geared to it."""
        way = value - self.q[number]
        for one, ratio in self.train(number).items():
            self.q[one] = value if one == number else self.q[one] + ratio * way

    def opening(self, couple: Couple, near: Near, number: int) -> float:
        """How the distance of a couple grows with the coordinate of a body, m/rad or m/m."""
        train = self.train(number)
        return sum(train[side] * opening(self.bodies, couple, near, side) for side in (couple.a, couple.b) if side in train)

    def near(self, couple: Couple) -> Near:
        a, b = self.q[couple.a], self.q[couple.b]
        known = self._known.get(id(couple))
        # Not equal where nan: a fixed body has no coordinate, but stays where it is.
        if known is not None and (known[0] == a or math.isnan(a)) and (known[1] == b or math.isnan(b)):
            return known[2]
        near = couple.near(pose_of(self.bodies[couple.a], a), pose_of(self.bodies[couple.b], b))
        self._known[id(couple)] = a, b, near
        return near

    def speed(self, couple: Couple, number: int) -> float:
        """A bound of how fast points of body `number` travel per unit of its coordinate."""
        train = self.train(number)
        return sum(abs(train[side]) * self._own_speed(couple, side) for side in (couple.a, couple.b) if side in train)

    def _own_speed(self, couple: Couple, number: int) -> float:
        return couple.reach[0 if number == couple.a else 1] if self.bodies[number].motion == "pivot" else 1.0

    def touches(self) -> list[tuple[Couple, Near]]:
        """What is in touch now."""
        found = ((couple, self.near(couple)) for couple in self.couples if self.room(couple) <= NEARBY)
        return [(couple, near) for couple, near in found if near.crossing or near.distance <= TOUCHING]

    def room(self, couple: Couple) -> float:
        """A bound from below of the distance, without looking again while what was seen last leaves room enough."""
        known = self._known.get(id(couple))
        if known is not None:
            a, b, near = known
            ways = (
                abs(self.q[n] - q) * self._own_speed(couple, n) for n, q in ((couple.a, a), (couple.b, b)) if not math.isnan(q)
            )
            left = near.distance - sum(ways)
            if left > NEARBY:
                return left
        return self.near(couple).distance

    def is_free(self, couple: Couple) -> bool:
        """Do the two neither touch nor overlap?"""
        return self.room(couple) > NEARBY or self.near(couple).free

    def blocker(self, number: int) -> Couple | None:
        """The first couple of a body that is not free."""
        return next((couple for couple in self.of(number) if not self.is_free(couple)), None)

    def go(self, number: int, way: float) -> tuple[float, Couple | None]:
        """Move a body by at most `way`, up to what it meets: how far it went, and what stopped it (None: nothing did)."""
        gone, sign, start = 0.0, math.copysign(1.0, way), self.q[number]
        for _ in range(ROUNDS):
            safe, bold, nearest = abs(way) - gone, abs(way) - gone, None
            for couple in self.of(number):
                speed = self.speed(couple, number)
                room = self.room(couple)
                if room > NEARBY:
                    step = hope = (room - 0.5 * CLOSE_UP) / speed
                else:
                    step, hope = self._steps(couple, number, sign, speed)
                bold = min(bold, hope)
                if step < safe:
                    safe, nearest = step, couple
            if safe <= 0.0:
                return gone, nearest
            for step in (bold, safe) if bold > safe else (safe,):
                self.place(number, way + start if gone + step >= abs(way) else start + sign * (gone + step))
                stopped = self.blocker(number)
                if stopped is None:
                    gone += step
                    break
            else:  # what was to be along or away from a body has closed the last nanometres after all
                self.place(number, start + sign * gone)
                return gone, stopped
            if gone >= abs(way):
                return abs(way), None
        return gone, nearest

    def _steps(self, couple: Couple, number: int, sign: float, speed: float) -> tuple[float, float]:
        """A step of the body that is safe beside the other one, and one that would close the gap at its present rate."""
        near = self.near(couple)
        rate = sign * self.opening(couple, near, number)
        if near.distance <= CLOSE_UP:
            # As close as it was left: on along it, or away from it, in small steps; else it is what stops the body.
            return (CREEP / speed, CREEP / speed) if rate >= 0.0 else (0.0, 0.0)
        gap = near.distance - 0.5 * CLOSE_UP
        return gap / speed, min(gap / max(-rate, 0.02 * speed), 4.0 * NEARBY / speed)

    def push(self, number: int, couple: Couple, before: Near, depth: int = 0) -> None:
        """Move body `number` by the least that frees `couple` (nearest points `before`), and whatever it meets in turn."""
        place = before.on_a
        if number in self.stay or depth > 3:
            raise Jam(couple, place, "neither can give way")
        rate = self.opening(couple, before, number)
        reach = self.speed(couple, number)
        if abs(rate) <= LEVERAGE * reach:
            raise Jam(couple, place, f"the push goes through the pivot of {self.bodies[number].name}")
        sign, start = math.copysign(1.0, rate), self.q[number]
        others = [
            (one, self.near(one)) for one in self.of(number) if one is not couple and self.room(one) <= 10.0 * self.largest_push
        ]
        low, high = 0.0, 1e-10 / reach
        while True:
            self.place(number, start + sign * high)
            if self.near(couple).free:
                break
            low, high = high, 4.0 * high
            if high * reach > self.largest_push:
                self.place(number, start)
                raise Jam(couple, place, f"{self.bodies[number].name} cannot be pushed out of the way")
        for _ in range(HALVINGS):  # back to where the two are just free, along the distance while that leads there
            near = self.near(couple)
            left, rate = near.distance - HARMLESS, sign * self.opening(couple, near, number)
            if left * reach <= CLOSEST * abs(rate) or high - low <= CLOSEST / reach:
                break
            middle = high - 0.999 * left / rate if rate > 0.0 else low
            middle = middle if low < middle < high else 0.5 * (low + high)
            self.place(number, start + sign * middle)
            if self.near(couple).free:
                high = middle
            else:
                low = middle
                self.place(number, start + sign * high)
        self.place(number, start + sign * high)
        stop, against = self.stops.get(number, (0.0, 0.0))
        if against * (self.q[number] - stop) > high + TOUCHING / reach:
            self.place(number, start)
            raise Jam(couple, place, f"{self.bodies[number].name} stands on its stop")
        for one, was in others:
            if not self.is_free(one):
                if not was.distance > 0.0:
                    raise Jam(one, was.on_a, "they overlapped before")
                try:
                    self.push(self.other(one, number), one, was, depth + 1)
                except Jam as jam:
                    jam.passed_on.append(couple)
                    raise


def assembly(scene: Scene) -> Assembly:
    """The scene's bodies where it puts them."""
    q = []
    for body in scene.bodies:
        q.append(body.angle if body.motion == "pivot" else 0.0 if body.motion == "slide" else math.nan)
    fixed = {i for i, body in enumerate(scene.bodies) if body.motion == "fixed"}
    names = {body.name: i for i, body in enumerate(scene.bodies)}
    trains = {i: {names[other]: far for other, far in goes_with(scene, name).items()} for name, i in names.items()}
    stops = {
        names[one.body]: (one.stop, math.copysign(1.0, one.rest - one.stop)) for one in scene.springs if one.stop is not None
    }
    return Assembly(scene.bodies, couples(scene), q, fixed, trains, stops)


FINE, FINEST = math.radians(0.1), math.radians(0.0005)  # steps of a turning body; lengths: times the reach of its outlines
COARSE = math.radians(2.0)  # where nothing is near
YIELD = 2e-6  # m: by how much at a time a pressed body drives another
LEAST_LEAP = math.radians(0.25)  # what a pressed body goes at once by less follows what it drives
RUNAWAY = 1.02  # pitches that a wheel may turn at one go; more, and nothing holds it
REGARDED = 2e-4  # m: what is further from the led body cannot be met in one step
ROUNDS_TURNED_CYCLE = 4000


@dataclass(frozen=True)
class Touch:
    """Two layers in touch at one step, where (m, in the movement), and on which of their edges (-1: a corner)."""

    couple: int
    place: Point
    faces: tuple[int, int]


@dataclass(frozen=True)
class Leap:
    """A pressed body that went `way` (rad or m) without being held, while the led body stood at row `row`."""

    row: int
    body: int
    way: float


@dataclass
class Cycle:
    """The rows of a cycle: coordinates (rad or m), touches and distances (m, 0 for touching) of each."""

    assembly: Assembly
    led: int
    pressed: dict[int, float]
    pitch: float
    rests: dict[int, float] = field(default_factory=dict)  # where a spring no longer presses a body on
    rows: list[tuple[float, ...]] = field(default_factory=list)
    touches: list[tuple[Touch, ...]] = field(default_factory=list)
    distances: list[tuple[float, ...]] = field(default_factory=list)
    slid: list[tuple[float, ...]] = field(default_factory=list)  # m, by each couple since the row before
    leaps: list[Leap] = field(default_factory=list)
    turned: list[int] = field(default_factory=list)  # rows at which the led body turns round
    jam: Jam | None = None
    runaway: int | None = None

    @property
    def q(self) -> NDArray[np.float64]:
        """(rows, bodies)."""
        return np.array(self.rows)

    def follow(self, ends: list[float]) -> None:
        """Lead the body to each of these coordinates in turn; ends early with `jam` or `runaway`."""
        parts = self.assembly
        if parts.bodies[self.led].motion == "pivot":
            steps = (2.0 * FINE * parts.speed(couple, self.led) for couple in parts.of(self.led))
            parts.largest_push = max([LARGEST_PUSH, *steps])
        try:
            self._press()
            self._note()
            for end in ends:
                self.turned.append(len(self.rows) - 1)
                while self.runaway is None and self.assembly.q[self.led] != end:
                    self._step(end)
            self.turned.append(len(self.rows) - 1)
        except Jam as jam:
            self.jam = jam
            self._note()

    def _step(self, end: float) -> None:
        """One step, as long as nothing is near, and so short that what meets or parts is known to the finest step."""
        now = list(self.assembly.q)
        sign = math.copysign(1.0, end - now[self.led])
        reach = max((self.assembly.speed(couple, self.led) for couple in self.assembly.of(self.led)), default=1.0)
        turns = self.assembly.bodies[self.led].motion == "pivot"
        fine, finest, coarse = (step if turns else step * 1e-3 for step in (FINE, FINEST, COARSE))
        nearest = min((self.assembly.room(couple) for couple in self.assembly.of(self.led)), default=math.inf)
        step = min(max(fine, 0.9 * nearest / reach), coarse, abs(end - now[self.led]))
        before = {touch.couple for touch in self.touches[-1]}
        leaps = len(self.leaps)
        while True:
            target = end if step >= abs(end - now[self.led]) else now[self.led] + sign * step
            failure: Jam | None = None
            try:
                self._lead(target)
                self._press()
            except Jam as jam:
                failure = jam
            changed = {self.assembly.couples.index(couple) for couple, _ in self.assembly.touches()} != before
            if (failure is None and not changed and len(self.leaps) == leaps) or step <= finest:
                if failure is not None:
                    raise failure
                self._note()
                return
            step = max(0.5 * step, finest)
            self.assembly.q[:] = now
            del self.leaps[leaps:]

    def _lead(self, target: float) -> None:
        """Move the led body, and push out of its way what it meets."""
        beside = [one for one in self.assembly.of(self.led) if self.assembly.room(one) <= REGARDED]
        before = [self.assembly.near(one) for one in beside]
        self.assembly.place(self.led, target)
        for one, near in zip(beside, before, strict=True):
            if not self.assembly.is_free(one):
                self.assembly.push(self.assembly.other(one, self.led), one, near)

    def _press(self) -> None:
        """Let every pressed body go on until it is held."""
        for number, sign in self.pressed.items():
            gone = 0.0
            for _ in range(ROUNDS_TURNED_CYCLE):
                way, couple = self.assembly.go(number, self._far(number, sign))
                gone += way
                if couple is None and number in self.rests:
                    break
                if couple is None or gone > self.pitch * RUNAWAY:
                    self.runaway = number
                    return
                if way > LEAST_LEAP:
                    self.leaps.append(Leap(len(self.rows), number, way))
                if not self._yields(number, couple):
                    break

    def _far(self, number: int, sign: float) -> float:
        """How far a pressed body may go at once: to where its spring rests; without one, beyond a pitch it has run away."""
        if number in self.rests:
            return sign * max(0.0, sign * (self.rests[number] - self.assembly.q[number]))
        return sign * RUNAWAY * self.pitch

    def _yields(self, number: int, couple: Couple) -> bool:
        """Drive what holds the pressed body a little out of the way; False where it stays."""
        other = self.assembly.other(couple, number)
        if other in self.assembly.stay or not self.pressed.keys().isdisjoint(self.assembly.train(other)):
            return False
        rate = self.assembly.opening(couple, self.assembly.near(couple), other)
        reach = self.assembly.speed(couple, other)
        if abs(rate) <= LEVERAGE * reach:
            return False
        way, _ = self.assembly.go(other, math.copysign(YIELD / reach, rate))
        return way * reach > 0.02 * YIELD

    def _note(self) -> None:
        """Keep a row."""
        found = [(k, couple, self.assembly.near(couple)) for k, couple in enumerate(self.assembly.couples)]
        touching = [(k, couple, near) for k, couple, near in found if near.crossing or near.distance <= 2e-8]
        slid = [0.0] * len(found)
        if self.rows:
            moved = [now - was for now, was in zip(self.assembly.q, self.rows[-1], strict=True)]
            last = {touch.couple for touch in self.touches[-1]}
            for k, couple, near in touching:
                if k in last:
                    slid[k] = self._slip(couple, near.on_a, near.on_b, moved)
        self.rows.append(tuple(self.assembly.q))
        self.touches.append(tuple(Touch(k, near.on_a, near.faces) for k, _, near in touching))
        self.distances.append(tuple(0.0 if near.crossing else near.distance for _, _, near in found))
        self.slid.append(tuple(slid))

    def _slip(self, couple: Couple, on_a: Point, on_b: Point, moved: list[float]) -> float:
        """How far the two materials slid along each other for those changes of the coordinates, m."""
        away = math.dist(on_a, on_b)
        if away == 0.0:
            return 0.0
        tx, ty = -(on_a[1] - on_b[1]) / away, (on_a[0] - on_b[0]) / away
        total = 0.0
        for number, sign in ((couple.a, 1.0), (couple.b, -1.0)):
            body = self.assembly.bodies[number]
            if body.motion != "fixed":
                vx, vy = motion_at(body, on_a)
                total += sign * moved[number] * (tx * vx + ty * vy)
        return abs(total)
