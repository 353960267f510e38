"""How does every tooth pass both stones, the lever led from bank to bank and back as often as the wheel has teeth?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.analysis.verdicts.tooth_lean import Teeth
from watchsim.escapement.by_hand.lever_sweep import LEVEL, LetOff, Rest, Stretch, Sweep, Wheel
from watchsim.escapement.direct import Roller
from watchsim.escapement.tooth_passage import Direct, NotMeasured, Passage

MOST = 0.75  # of a pitch: the wheel goes on by less in one beat; two teeth of a lever make a whole one


def passages(
    wheel: Wheel, banks: tuple[float, float], start: Rest, teeth: Teeth, roller: Roller | None = None
) -> list[Passage]:
    """Every tooth past both stones, in the order of time; one more beat at the end, for the lock of the last."""
    ox, oy = wheel.hands.pivot(wheel.parts.wheel, wheel.at(0.0, 0.0))
    found: list[Passage] = []
    rest = start
    for beat in range(2 * teeth.count + 1):
        side = 1.0 if beat % 2 == 0 else -1.0
        sweep = wheel.lead(rest, banks[1] if side > 0.0 else banks[0])
        tooth = teeth.number(math.atan2(rest.y - oy, rest.x - ox) - rest.wheel)
        direct = _direct(roller, sweep, side)
        if direct is None:
            passage, last = _passage(wheel, sweep, side, tooth), sweep.last
        else:
            passage, last = _direct_passage(wheel, sweep, direct, tooth, side, banks)
        found.append(passage)
        assert last is not None  # _passage refuses a wheel that runs free
        rest = last
    return found


def _direct(roller: Roller | None, sweep: Sweep, side: float) -> Direct | None:
    if roller is None or not sweep.let_offs:
        return None
    try:
        return roller.impulse(sweep.let_offs[0].last, side)
    except ValueError as reason:
        raise NotMeasured(str(reason)) from reason


def _direct_passage(
    wheel: Wheel, sweep: Sweep, direct: Direct, tooth: int, side: float, banks: tuple[float, float]
) -> tuple[Passage, Rest]:
    """A beat in which the balance itself is pushed, and where the tooth rests that the lever locks after it."""
    locked = sweep.stretches[: 1 + next(i for i, one in enumerate(sweep.stretches) if one.last == sweep.let_offs[0].last)]
    end = banks[1] if side > 0.0 else banks[0]
    landed = wheel.rest(direct.last.lever, direct.last.wheel, -side)
    if landed is None:
        raise NotMeasured("a tooth that leaves the stone of the balance finds no stone to lock on: the wheel runs free")
    on = wheel.lead(landed, end) if landed.lever != end else None
    if on is not None and on.let_offs:
        raise NotMeasured("more than one tooth is let off in a beat: the wheel trips")
    last = landed if on is None else on.last
    assert last is not None
    room = sweep.room[len(locked)] if len(locked) < len(sweep.room) else sweep.room[-1]
    passage = Passage(
        tooth, side, sweep.stretches[0].first, locked[-1].last, direct.last, landed, end, (), room, direct.first, direct
    )
    return passage, last


def _passage(wheel: Wheel, sweep: Sweep, side: float, tooth: int) -> Passage:
    locked = _locking(sweep.stretches)
    let_off = _last_let_off(wheel, sweep)
    caught = sweep.let_offs[0].landed if len(sweep.let_offs) > 1 else None
    unlocked = sweep.let_offs[0].last if caught else locked[-1].last if locked else sweep.stretches[0].first
    last = next(i for i, stretch in enumerate(sweep.stretches) if stretch.last == let_off.last)
    assert let_off.landed is not None
    driven = sweep.stretches[len(locked) : last + 1]
    room = sweep.room[len(locked)] if locked else sweep.room[0]
    end = sweep.stretches[-1].last.lever
    return Passage(tooth, side, sweep.stretches[0].first, unlocked, let_off.last, let_off.landed, end, driven, room, caught)


def _last_let_off(wheel: Wheel, sweep: Sweep) -> LetOff:
    """The one by which the wheel drops to the lock; before it, it may have run after an impulse stone."""
    let_offs = sweep.let_offs
    if not let_offs:
        raise NotMeasured("the lever reaches its other bank before the tooth is let off")
    if any(one.landed is None for one in let_offs):
        raise NotMeasured("a tooth that is let off finds no stone to lock on: the wheel runs free")
    landed = let_offs[-1].landed
    assert landed is not None
    advance = wheel.parts.way * (landed.wheel - let_offs[0].last.wheel)
    if len(let_offs) > 2 or (len(let_offs) == 2 and advance > MOST * wheel.pitch):
        raise NotMeasured("more than one tooth is let off in a beat: the wheel trips")
    return let_offs[-1]


def _locking(stretches: Sequence[Stretch]) -> Sequence[Stretch]:
    """Those before the wheel first drives the lever on; where the locking face itself repels the lever, that face."""
    face = stretches[0].first
    count = 0
    for stretch in stretches:
        repels = stretch.first.slope > LEVEL or stretch.last.slope > LEVEL
        if repels and not (stretch.first.stone == face.stone and stretch.first.tooth == face.tooth):
            break
        count += 1
        if repels:
            break
    return stretches[:count]
