"""How does a mechanism go through its cycle when it is turned by hand?

The oscillator is led from one end of its swing to the other and back, in small steps. What it meets gives way along its one
coordinate. After every step each pressed body (the driven wheel) goes on in its direction until something holds it: a body that
can yield is driven along until it stands against another one, as draw drives a lever to its banking and an impulse face a fork
against the pin; what cannot yield holds. No force enters: friction, inertia and speed are left to a run.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Point
from watchsim.turning.couples import Couple, motion_at
from watchsim.turning.moves import LEVERAGE, Assembly, Jam

FINE, FINEST = math.radians(0.1), math.radians(0.0005)  # steps of a turning body; lengths: times the reach of its outlines
COARSE = math.radians(2.0)  # where nothing is near
YIELD = 2e-6  # m: by how much at a time a pressed body drives another
LEAST_LEAP = math.radians(0.25)  # what a pressed body goes at once by less follows what it drives
RUNAWAY = 1.02  # pitches that a wheel may turn at one go; more, and nothing holds it
REGARDED = 2e-4  # m: what is further from the led body cannot be met in one step
ROUNDS = 4000


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
            for _ in range(ROUNDS):
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
