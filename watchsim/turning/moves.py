"""How are bodies moved against each other so that nothing ever overlaps?

A state of coordinates is free of overlap from the start and stays so. Bodies go as far as the exact distance allows (a body
whose points travel no faster than r per unit of its coordinate may move by distance / r), and what a moved body runs into is
pushed away, along the one coordinate it has, by the least that frees the two. Bodies geared to each other go together.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from watchsim.geometry.primitives import Point
from watchsim.scene.body import Body
from watchsim.scene.gear_trains import goes_with
from watchsim.scene.scene import Scene
from watchsim.turning.couples import Couple, Near, couples, opening, pose_of

TOUCHING = 2e-8  # m: what comes so close is in touch
CLOSE_UP = 1e-8  # m: how close a body is driven up to another
LARGEST_PUSH = 2e-5  # m: what is not free after so much is jammed
LEVERAGE = 0.02  # of the arm: a contact whose normal passes closer to the pivot holds instead of turning
CREEP = 1e-6  # m: how far a body goes on along what it touches, before it looks again
NEARBY = 5e-6  # m: what is further away is not looked at in detail
ROUNDS = 20000
HALVINGS = 30


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
            (one, self.near(one)) for one in self.of(number) if one is not couple and self.room(one) <= 10.0 * LARGEST_PUSH
        ]
        low, high = 0.0, 1e-10 / reach
        while True:
            self.place(number, start + sign * high)
            if self.near(couple).free:
                break
            low, high = high, 2.0 * high
            if high * reach > LARGEST_PUSH:
                self.place(number, start)
                raise Jam(couple, place, f"{self.bodies[number].name} cannot be pushed out of the way")
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            self.place(number, start + sign * middle)
            low, high = (low, middle) if self.near(couple).free else (middle, high)
        self.place(number, start + sign * high)
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
    return Assembly(scene.bodies, couples(scene), q, fixed, trains)
