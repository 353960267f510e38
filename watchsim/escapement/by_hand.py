"""How does the wheel rest while the lever is led from one side to the other?

The lever is turned slowly; the wheel, pressed by its drive, rests on a stone or is let off and drops on the next. Between the
places where something changes the rest is a smooth function of the lever's angle; the places are found by halving.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import poses
from watchsim.escapement.turning import WIDTH, describe, jumps, lead_on, turn_to_touch, turns_to_touch
from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import Compiled
from watchsim.scene.roles import drive_direction, pallet_word, partners, roles
from watchsim.scene.scene import Scene
from watchsim.scene.trains import is_still
from watchsim.tolerances import JOINT_RESOLUTION

# By what touches what, never by name: the oscillator swings on its spring, the train leads from the driving torque to the
# last wheel, the lever stands between the two, and the banking is what stands still beside the lever.

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Parts:
    """Names of the parts; `way` is the direction the drive turns the wheel in (±1, + is counter-clockwise).

    `lever` is the oscillator itself in an escapement whose anchor swings with it: `detached` is then False.
    `to_wheel`, `to_banking`, `to_balance` are the model's contacts of the lever; `to_roller` those of wheel and balance, where
    a lever stands between the two all the same (the direct impulse of a co-axial escapement). `guarded` says that the scene
    declares more than one of lever and balance: besides fork and pin, a safety action. `pallet` is what pallets are called.
    """

    wheel: str
    lever: str
    balance: str
    way: float
    to_wheel: Integers
    to_banking: Integers
    to_balance: Integers
    to_roller: Integers
    guarded: bool
    pallet: str

    @property
    def detached(self) -> bool:
        return self.lever != self.balance


def parts_of(scene: Scene, compiled: Compiled) -> Parts | str:
    """The parts, or a sentence saying why the scene is no escapement with a lever or an anchor."""
    found = roles(scene)
    if found.oscillator is None:
        return "nothing swings on a spring or by gravity"
    chain = _chain(scene, found.oscillator)
    if not chain:
        return f"no driven body leads to {found.oscillator}"
    if found.wheel is not None and found.lever is not None:
        chain = (found.oscillator, found.lever, found.wheel)
    if any(scene.body(name).motion != "pivot" for name in chain):
        return f"a part between {chain[-1]} and {chain[0]} does not turn about a pivot"
    lever, wheel = (chain[0], chain[1]) if len(chain) == 2 else (chain[1], chain[2])
    way = drive_direction(scene, chain[-1]) * (-1.0) ** (len(chain) - 1 - chain.index(wheel))
    still = {body.name for body in scene.bodies if body.name not in chain and _stands(scene, body.name, lever)}
    banking = _between(scene, compiled, lever, still) if lever != found.oscillator else np.zeros(0, np.int64)
    fork = _between(scene, compiled, lever, {found.oscillator}) if lever != found.oscillator else np.zeros(0, np.int64)
    declared = [one for one in scene.contacts if {side.body for side in one.sides} == {lever, found.oscillator}]
    to_wheel = _between(scene, compiled, lever, {wheel})
    roller = _between(scene, compiled, found.oscillator, {wheel}) if lever != found.oscillator else np.zeros(0, np.int64)
    return Parts(wheel, lever, found.oscillator, way, to_wheel, banking, fork, roller, len(declared) > 1, pallet_word(scene))


def _stands(scene: Scene, name: str, lever: str) -> bool:
    """Does the body stand still where the lever's pivot does?"""
    body = scene.body(name)
    return body.motion == "fixed" and (body.on == scene.body(lever).on or is_still(scene, body))


def _chain(scene: Scene, oscillator: str) -> tuple[str, ...]:
    """The shortest way by contacts of moving bodies from the oscillator to a driven one."""
    driven = {torque.body for torque in scene.torques} - {oscillator}
    before: dict[str, str] = {oscillator: ""}
    waiting = deque([oscillator])
    while waiting:
        name = waiting.popleft()
        if name in driven:
            way = [name]
            while before[way[-1]]:
                way.append(before[way[-1]])
            return tuple(reversed(way))
        for other in sorted(partners(scene, name)):
            if other not in before and scene.body(other).motion != "fixed":
                before[other] = name
                waiting.append(other)
    return ()


def _between(scene: Scene, compiled: Compiled, name: str, others: set[str]) -> Integers:
    """The contacts of the model that can ever close between a body and some others."""
    groups = [i for i, one in enumerate(scene.contacts) if _joins({side.body for side in one.sides}, name, others)]
    near = compiled.model.near
    return np.ascontiguousarray(near[np.isin(compiled.model.contacts.group[near], groups)])


def _joins(sides: set[str], name: str, others: set[str]) -> bool:
    return name in sides and bool((sides - {name}) & others)


# Absolute angles in rad. Nothing here knows forces or time.

Array = NDArray[np.float64]

ROOM = 1e-10  # of the scene's size: a contact counts so far beyond the ends of its primitives, so that joints are tight
SLACK = 1e-5  # rad: a body that the drawing puts against another stands nearer to it than that


@dataclass(frozen=True, slots=True)
class Touch:
    """A body at `angle` rests against another with contact `contact`."""

    angle: float
    contact: int


@dataclass(frozen=True, slots=True)
class Meeting:
    """A contact at a given position: its point (m) in the movement, the unit normal there, on which primitives.

    `rates` gives for each of the two bodies (numbers in the model) how fast the gap opens as it turns, m/rad.
    `flat` is the body that holds the line or the rounder arc, along whose face the other one's corner slides.
    """

    point: Point
    normal: Point
    rates: Mapping[int, float]
    primitives: tuple[int, int]
    flat: int


class Hands:
    """Turns the bodies of a compiled scene."""

    def __init__(self, compiled: Compiled) -> None:
        self.compiled, self.model = compiled, compiled.model
        self.room = ROOM * compiled.size
        self.resolution = JOINT_RESOLUTION * compiled.size  # m: what outlines leave open
        self.pose, self._row = poses(len(self.model.bodies)), np.zeros(5)
        self._pairs = np.column_stack((self.model.contacts.a, self.model.contacts.b))
        self._pivots = self.pose["x"], self.pose["y"]
        self._owner: list[int] = self.model.primitives.body.tolist()
        self._bodies: list[int] = self.model.coordinates.body.tolist()

    def coordinate(self, name: str) -> int:
        return self.compiled.slices[name].start

    def touch(
        self, name: str, ids: Integers, q: Array, sense: float, reach: float = math.pi, behind: float = 0.0
    ) -> Touch | None:
        """Where body `name` first touches, turned from q in direction `sense` by -`behind` to `reach` rad; None: nowhere."""
        i = self.coordinate(name)
        turn, contact = turn_to_touch(self.model, ids, q, self._bodies[i], sense, (-behind, reach), self.room, self.pose)
        return Touch(float(q[i]) + sense * turn, int(contact)) if contact >= 0 else None

    def turns(self, name: str, ids: Integers, q: Array, sense: float, reach: float, moved: int, angles: list[float]) -> Array:
        """How far body `name` can be turned from q until it touches, rad, with coordinate `moved` at each of the angles."""
        found, body = np.empty(len(angles)), self._bodies[self.coordinate(name)]
        at = np.array(angles, dtype=float)
        turns_to_touch(self.model, ids, q.copy(), moved, at, body, sense * reach, self.room, (found, self.pose))
        return found

    def meeting(self, contact: int, q: Array) -> Meeting:
        describe(self.model, contact, q, self.pose, self._row)
        _, nx, ny, x, y = self._row.tolist()
        first, second = self._pairs[contact].tolist()
        rates = {}
        for sign, primitive in ((1.0, first), (-1.0, second)):
            body = self._owner[primitive]
            px, py = (float(value[body]) for value in self._pivots)
            rates[body] = sign * ((x - px) * ny - (y - py) * nx)
        return Meeting((x, y), (nx, ny), rates, (first, second), self._owner[second])

    def gap(self, contact: int, q: Array) -> float:
        """How far apart the two primitives of a contact are, m."""
        describe(self.model, contact, q, self.pose, self._row)
        return float(self._row[0])

    def flat_of(self, contact: int) -> int:
        """The body that holds the line or the rounder arc of a contact, out of whose material its normal points."""
        return self._owner[int(self._pairs[contact][1])]

    def body(self, name: str) -> int:
        """The number in the model of a pivoted body."""
        return self._bodies[self.coordinate(name)]

    def pivot(self, name: str, q: Array) -> Point:
        """Where a body's origin is (m)."""
        describe(self.model, 0, q, self.pose, self._row)
        x, y = (float(value[self.body(name)]) for value in self._pivots)
        return x, y

    def error(self, rate: float) -> float:
        """Of an angle at which a contact closes at this rate (m/rad), by what outlines leave open, rad."""
        return self.resolution / max(abs(rate), self.resolution)


REACH = 1.2  # pitches: so far the wheel is let run
NEIGHBOURS = 0.75  # of a pitch to both sides: what is looked at while a tooth rests
AHEAD = 0.5  # of a pitch: further than a tooth that jams reaches into the other stone


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

    def rest(self, lever: float, wheel: float, led: float) -> Rest | None:
        """Where the wheel, let go at `wheel`, rests; None where it is free for a pitch. `led`: ±1, the lever's way."""
        q = self.at(lever, wheel)
        touch = self.hands.touch(self.parts.wheel, self.parts.to_wheel, q, self.parts.way, REACH * self.pitch)
        return None if touch is None else self._described(lever, touch, led)

    def room(self, rest: Rest) -> float:
        """How far the resting wheel can be turned back until another place touches, rad; negative where a tooth stands in
        another stone already, which it would have to go on to be free of: the wheel jams."""
        q, wheel, way = self.at(rest.lever, rest.wheel), self.parts.wheel, self.parts.way
        others = np.setdiff1d(self.parts.to_wheel, self._around(rest.tooth, 0.5))
        met = self.hands.touch(wheel, others, q, way, AHEAD * self.pitch)  # what comes out ahead of it is in there now
        ahead = AHEAD * self.pitch if met is None else way * (met.angle - rest.wheel)
        touch = self.hands.touch(wheel, others, q, -way, 0.0, ahead) or self.hands.touch(
            wheel, self.parts.to_wheel, q, -way, self.pitch
        )
        return self.pitch if touch is None else way * (rest.wheel - touch.angle)

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
            last, after = self._stretch(here, end, led, ids, 0.5 * (room if room > 0.0 else AHEAD * self.pitch))
            stretches.append(Stretch(here, last))
            if last.lever == end:
                return Sweep(tuple(stretches), tuple(let_offs), tuple(rooms))
            if after is not None and not jumps(last.lever, last.wheel, last.slope, after.lever, after.wheel, after.slope):
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
        *last, lever, wheel, contact = lead_on(
            self.hands.model,
            ids,
            self._q.copy(),
            (self._wheel, self._lever, self._wheel_body, self._lever_body),
            (here.lever, here.wheel, here.contact, here.slope),
            end,
            (self.parts.way, led, back, REACH * self.pitch, self.hands.room),
            self.hands.pose,
        )
        found = self._described(last[0], Touch(last[1], last[2]), led)
        return found, None if contact < 0 else self._described(lever, Touch(wheel, contact), led)

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

    def _around(self, tooth: int, pitches: float = NEIGHBOURS) -> Integers:
        """The contacts with the wheel's primitives around this one, to both sides."""
        if not hasattr(self, "_places"):
            contacts = self.hands.model.contacts
            ids = self.parts.to_wheel
            polar = np.full(len(self.hands.model.primitives), np.nan)
            polar[list(self._polar)] = list(self._polar.values())
            a, b = polar[contacts.a[ids]], polar[contacts.b[ids]]
            self._places = np.where(np.isnan(a), b, a)
        off = (self._places - self._polar[tooth] + math.pi) % math.tau - math.pi
        return np.ascontiguousarray(self.parts.to_wheel[np.abs(off) <= pitches * self.pitch])
