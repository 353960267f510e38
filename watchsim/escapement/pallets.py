"""What do wheel and stones do in a beat: lock, draw, recoil, lift, drop?"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from watchsim.escapement.by_hand.hands import Hands
from watchsim.escapement.by_hand.lever_sweep import Rest, Wheel
from watchsim.escapement.quantity import Quantity, over_teeth
from watchsim.escapement.tooth_passage import Passage, change_error
from watchsim.model.records import ARC, FULL


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
    shake        of the wheel: how far it can be turned back as the stone is about to be unlocked
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


def _on_round_pin(hands: Hands, rest: Rest) -> bool:
    """Does a corner of a tooth lie on the round of a pin?"""
    stone = hands.model.primitives[rest.stone]
    return rest.on_stone and stone.kind == ARC and stone.extent == FULL


def _face_error(hands: Hands, primitive: int) -> float:
    p = hands.model.primitives[primitive]
    return 2.0 * hands.resolution / max(float(p.length), float(p.radius))
