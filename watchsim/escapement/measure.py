"""What is the geometry of function of a scene: everything that can be measured by turning its parts by hand?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from watchsim.escapement.by_hand import SLACK, Hands, LetOff, Parts, Rest, Stretch, Sweep, Wheel, parts_of
from watchsim.escapement.fork_and_pin import Balance, Direct, Entry, Fork, NotMeasured, Passage, Safety, fork, safety
from watchsim.escapement.impulses import Impulse, Pallet, Roller, impulse, least_arm, pallet
from watchsim.escapement.turning import LEVEL
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.lean import Teeth, teeth
from watchsim.scene.roles import drive_direction, hinged_pallets, oscillators, pallet_word, partners, pitch, roles
from watchsim.scene.scene import Scene
from watchsim.scene.teeth import train
from watchsim.scene.trains import ungeared
from watchsim.simulation.trajectory import Trajectory
from watchsim.units import signed

DRIVES = 0.01  # turn of the wheel by turn of the lever: dead faces drawn as splines have some 1e-3, impulse faces 0.5 and more
MOST = 0.75  # of a pitch: the wheel goes on by less in one beat; two teeth of a lever make a whole one


def passages(
    wheel: Wheel, banks: tuple[float, float], start: Rest, teeth: Teeth, roller: Roller | None = None, few: int | None = None
) -> list[Passage]:
    """Every tooth, or the first `few`, past both stones, in the order of time; one more beat at the end, for the lock of the
    last."""
    ox, oy = wheel.hands.pivot(wheel.parts.wheel, wheel.at(0.0, 0.0))
    found: list[Passage] = []
    rest = start
    for beat in range(2 * (few or teeth.count) + 1):
        side = 1.0 if beat % 2 == 0 else -1.0
        sweep = wheel.lead(rest, banks[1] if side > 0.0 else banks[0])
        tooth = teeth.number(math.atan2(rest.y - oy, rest.x - ox) - rest.wheel)
        direct = _direct(roller, sweep, side)
        if direct is None:
            # Where the pallet met the tooth; the first swing's lies as far inside its end as for `_beyond_let_off`.
            met = found[-1].landed.lever if found else sweep.stretches[0].first.lever - 0.25 * side * (banks[0] - banks[1])
            passage, last = _passage(wheel, sweep, side, tooth, met), sweep.last
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


LETS_NONE_OFF = "before a tooth is let off"


def _passage(wheel: Wheel, sweep: Sweep, side: float, tooth: int, met: float) -> Passage:
    """`met`: where the lever stood (rad) as the tooth dropped onto the stone."""
    locked = _locking(sweep.stretches)
    # The one by which the wheel drops to the lock; before it, it may have run after an impulse stone.
    let_offs = sweep.let_offs
    if not let_offs:
        ends = "the lever reaches its other bank" if wheel.parts.detached else f"the examined swing of {wheel.parts.lever} ends"
        raise NotMeasured(f"{ends} {LETS_NONE_OFF}")
    if any(one.landed is None for one in let_offs):
        raise NotMeasured("a tooth that is let off finds no stone to lock on: the wheel runs free")
    landed = let_offs[-1].landed
    assert landed is not None
    advance = wheel.parts.way * (landed.wheel - let_offs[0].last.wheel)
    if len(let_offs) > 2 or (len(let_offs) == 2 and advance > MOST * wheel.pitch):
        raise NotMeasured("more than one tooth is let off in a beat: the wheel trips")
    let_off = let_offs[-1]
    caught = sweep.let_offs[0].landed if len(sweep.let_offs) > 1 else None
    unlocked = sweep.let_offs[0].last if caught else locked[-1].last if locked else sweep.stretches[0].first
    last = next(i for i, stretch in enumerate(sweep.stretches) if stretch.last == let_off.last)
    end = sweep.stretches[-1].last.lever
    if len(locked) > last:
        face = sweep.stretches[last]
        if wheel.parts.detached or not _repels(face):
            raise NotMeasured(f"a tooth is let off without having driven {wheel.parts.lever}: there is no lift")
        # An anchor with one face for both: what was recoil on the way out is impulse, from where the tooth dropped onto it.
        rest = face.first if side * (face.first.lever - met) <= 0.0 else wheel.lead(face.first, met).last
        assert rest is not None
        first, lift = sweep.stretches[0].first, (Stretch(rest, face.last),)
        return Passage(tooth, side, first, rest, let_off.last, landed, end, lift, wheel.room(rest))
    driven = sweep.stretches[len(locked) : last + 1]
    room = sweep.room[len(locked)] if locked else sweep.room[0]
    return Passage(tooth, side, sweep.stretches[0].first, unlocked, let_off.last, landed, end, driven, room, caught)


def _repels(stretch: Stretch) -> bool:
    return max(stretch.first.slope, stretch.last.slope) > DRIVES


def _locking(stretches: Sequence[Stretch]) -> Sequence[Stretch]:
    """Those before the wheel first drives the lever on; where the locking face itself repels the lever, that face."""
    face = stretches[0].first
    count = 0
    for stretch in stretches:
        repels = _repels(stretch)
        if repels and not (stretch.first.stone == face.stone and stretch.first.tooth == face.tooth):
            break
        count += 1
        if repels:
            break
    return stretches[:count]


FARTHEST = math.radians(60.0)  # an anchor or a lever is not turned further


@dataclass(frozen=True)
class Function:
    """The geometry of function; None, with a reason in `missing`, for what does not apply.

    `pallets` are entry and exit: the stone a tooth meets first and second on its way. `sides` says on which bank (±1, + is
    counter-clockwise) each of them locks, `banks` are the lever's angles there; `lever_rest` is the angle half way between
    them. `passages` are the first tooth's, for pictures: entry, exit. `impulses` belong to the beats that begin on the upper
    and on the lower bank, as `fork` does; None where the wheel need not run after an impulse stone. `swung` is, for an anchor
    that has no bank, how far it was turned to either side. `arms` are those of the pressure that draws the lever, m.
    """

    parts: Parts | None
    teeth: int | None = None
    banks: tuple[float, float] | None = None
    pallets: tuple[Pallet, Pallet] | None = None
    sides: tuple[float, float] = (1.0, -1.0)
    passages: tuple[Passage, Passage] | None = None
    fork: Fork | None = None
    safety: tuple[Safety, Safety] | None = None
    impulses: tuple[Impulse, Impulse] | None = None
    missing: tuple[tuple[str, str], ...] = ()
    swung: tuple[float, float] | None = None
    arms: tuple[float, float] | None = None


def measure(scene: Scene, compiled: Compiled | None = None, few: int | None = None, fork_too: bool = True) -> Function:
    """Measure a scene; never raises for a mechanism that has no such geometry. Of teeth that are alike `few` are enough.

    Without `fork_too` neither fork, horns nor impulses are measured, only what locks and guards the lever.
    """
    free = ungeared(scene)
    compiled = compiled if compiled is not None and free is scene else compile_scene(free)
    parts = parts_of(scene, compiled)
    if isinstance(parts, str):
        return Function(None, missing=(("geometry of function", f"no escapement with a lever or an anchor: {parts}"),))
    if hinged := hinged_pallets(scene):
        return Function(parts, missing=(("lock, draw, drop", _no_lock(parts, hinged)),))
    missing: list[tuple[str, str]] = []
    hands = Hands(compiled)
    whole = pitch(scene, parts.wheel)
    numbered = None if few else teeth(scene, parts.wheel)  # of alike teeth it does not matter which one is which
    toothed = None if whole is None else numbered or Teeth(whole, 0.0, 0.0)
    if toothed is None or not len(parts.to_wheel):
        why = f"{parts.wheel} has no equal teeth" if toothed is None else f"{parts.wheel} and {parts.lever} never touch"
        return Function(parts, missing=(("geometry of function", why),))
    number, wheel = toothed.count, Wheel(hands, parts, toothed.pitch)
    try:
        start = _start(wheel, hands)
        banks = _banks(hands, parts, wheel, start)
        first = wheel.lead(start, banks[0]).last if start.lever != banks[0] else start
        if first is None:
            way = "to its bank" if parts.detached else "aside"
            raise NotMeasured(f"{parts.wheel} runs free as {parts.lever} is turned {way} by hand")
        roller = _roller(scene, wheel, banks) if len(parts.to_roller) else None
        beats = passages(wheel, banks, first, toothed, roller, few)
    except NotMeasured as reason:
        return Function(parts, number, missing=(("lock, draw, lift, drop", str(reason)),))
    entry_side = _entry_side(wheel, beats[0])
    sides = (entry_side, -entry_side)
    pallets = (pallet(wheel, beats, sides[0], parts.detached), pallet(wheel, beats, sides[1], parts.detached))
    shown = [next(one for one in beats if one.side == side) for side in sides]
    if not parts.detached:
        missing.append(("total lock, run, fork and safety action", f"{parts.lever} swings with the oscillator: no banking"))
        return Function(parts, number, None, pallets, sides, (shown[0], shown[1]), missing=tuple(missing), swung=banks)
    made, guards, pushes = None, None, None
    try:
        made, guards, pushes = _balance(scene, hands, parts, banks, beats if fork_too else [])
    except NotMeasured as reason:
        missing.append(("lift angle of the balance, shake of the pin, safety action", str(reason)))
    if (made is not None or not fork_too) and guards is None:
        missing.append(("freedoms of guard pin and horns", f"nothing but the pin stops {parts.lever} between its banks"))
    arms = least_arm(wheel, beats, sides[0]), least_arm(wheel, beats, sides[1])
    both = shown[0], shown[1]
    return Function(parts, number, banks, pallets, sides, both, made, guards, pushes, tuple(missing), arms=arms)


def _no_lock(parts: Parts, hinged: tuple[str, ...]) -> str:
    """Why there is nothing to measure of pallets that are hinged on the oscillator."""
    pair = " and ".join(hinged)
    return (
        f"there is none. A tooth stays with one of {pair}, which are hinged on {parts.balance}, until the other has caught "
        f"another tooth, and {parts.wheel} never stands. Impulse and recoil of each: watchsim plot RUN --phases"
    )


def _start(wheel: Wheel, hands: Hands) -> Rest:
    """A tooth resting on a stone with the lever where the scene puts it."""
    q = hands.compiled.q
    lever, angle = float(q[hands.coordinate(wheel.parts.lever)]), float(q[hands.coordinate(wheel.parts.wheel)])
    rest = wheel.rest(lever, angle - wheel.parts.way * SLACK, 1.0)
    if rest is None:
        raise NotMeasured(f"{wheel.parts.wheel} runs free: no tooth rests on {wheel.parts.lever} as the scene puts it")
    return rest


def _banks(hands: Hands, parts: Parts, wheel: Wheel, start: Rest) -> tuple[float, float]:
    """The lever's angles on its upper and its lower bank; for an anchor, a little beyond where teeth are let off."""
    if not parts.detached:
        return _beyond_let_off(wheel, start)
    if not len(parts.to_banking):
        raise NotMeasured(f"nothing that stands still may touch {parts.lever}: no banking")
    found = []
    q = wheel.at(start.lever, start.wheel)
    for sense in (1.0, -1.0):
        touch = hands.touch(parts.lever, parts.to_banking, q, sense, FARTHEST, SLACK)
        if touch is None:
            what = "measured are levers between two banks, and anchors that swing with the oscillator"
            raise NotMeasured(f"{parts.lever} is stopped on one side only; {what}")
        found.append(touch.angle)
    return found[0], found[1]


def _beyond_let_off(wheel: Wheel, start: Rest) -> tuple[float, float]:
    """Half as far again as from let-off to let-off: the tooth that rests on a pallet now, and then the next one."""
    sweeps = [wheel.lead(start, start.lever + sense * FARTHEST / 4.0) for sense in (1.0, -1.0)]
    found = (let_off for sweep in sweeps for let_off in _drops(sweep)[:1])
    first = min(found, key=lambda one: abs(one.last.lever - start.lever), default=None)
    if first is None:
        raise NotMeasured(f"turning {wheel.parts.lever} by {math.degrees(FARTHEST / 4.0):g}° either way lets off no tooth")
    sense = math.copysign(1.0, first.last.lever - start.lever)
    if first.landed is None:
        raise NotMeasured("a tooth that is let off finds no pallet to lock on: the wheel runs free")
    back = _drops(wheel.lead(first.landed, first.landed.lever - sense * FARTHEST / 4.0))
    if not back:
        raise NotMeasured(f"a tooth that is let off locks, but turning {wheel.parts.lever} back does not let it off again")
    upper, lower = sorted((first.last.lever, back[0].last.lever), reverse=True)
    more = 0.5 * (upper - lower)
    return upper + more, lower - more


def _drops(sweep: Sweep) -> list[LetOff]:
    """Its let-offs, without those of a pallet driven so deep between the teeth that the one it drove back slips past it."""
    return [one for one in sweep.let_offs if one.last.slope >= -LEVEL]


def _entry_side(wheel: Wheel, beat: Passage) -> float:
    """On which bank the entry stone locks: the one that a tooth passes before the line from wheel to lever."""
    ox, oy = wheel.hands.pivot(wheel.parts.wheel, wheel.at(0.0, 0.0))
    px, py = wheel.hands.pivot(wheel.parts.lever, wheel.at(0.0, 0.0))
    x, y = beat.start.x - ox, beat.start.y - oy
    turn = (px - ox) * y - (py - oy) * x
    return beat.side if wheel.parts.way * turn < 0.0 else -beat.side


def _roller(scene: Scene, wheel: Wheel, banks: tuple[float, float]) -> Roller:
    balance, entries = _entries(scene, wheel.hands, wheel.parts, banks)
    return Roller(wheel, balance, banks, entries)


def _entries(scene: Scene, hands: Hands, parts: Parts, banks: tuple[float, float]) -> tuple[Balance, tuple[Entry, Entry]]:
    """Where the pin comes into the fork, from the upper and from the lower bank."""
    if not len(parts.to_balance):
        raise NotMeasured(f"{parts.lever} and {parts.balance} never touch")
    rest = next((one.rest for one in oscillators(scene) if one.body == parts.balance), 0.0)
    balance = Balance(hands, parts, rest)
    upper, lower = balance.entry(banks[0], 1.0), balance.entry(banks[1], -1.0)
    if upper is None or lower is None:
        raise NotMeasured(f"{parts.balance} does not meet {parts.lever} on its bank from one side only")
    return balance, (upper, lower)


def _balance(
    scene: Scene, hands: Hands, parts: Parts, banks: tuple[float, float], beats: list[Passage]
) -> tuple[Fork | None, tuple[Safety, Safety] | None, tuple[Impulse, Impulse] | None]:
    """Of no beats the safety action alone, without the horns."""
    balance, entries = _entries(scene, hands, parts, banks)
    sides = list(zip(banks, (1.0, -1.0), entries, strict=True))
    try:
        made = fork(balance, banks, beats, entries) if beats else None
        pushes = [
            impulse(balance, bank, entry, [one for one in beats if one.side == side]) for bank, side, entry in sides if beats
        ]
    except ValueError as reason:
        raise NotMeasured(str(reason)) from reason
    guards = [safety(balance, bank, side, entry, bool(beats)) for bank, side, entry in sides]
    return (
        made,
        None if guards[0] is None or guards[1] is None else (guards[0], guards[1]),
        None if not pushes or pushes[0] is None or pushes[1] is None else (pushes[0], pushes[1]),
    )


def banks_of(scene: Scene) -> tuple[float, float] | None:
    """The lever's angles (rad) on its upper and its lower bank, whatever the wheel does; None where it has not both."""
    free = ungeared(scene)
    compiled = compile_scene(free)
    parts = parts_of(free, compiled)
    if isinstance(parts, str) or not len(parts.to_banking):
        return None
    upper, lower = (
        Hands(compiled).touch(parts.lever, parts.to_banking, compiled.q, way, FARTHEST, SLACK) for way in (1.0, -1.0)
    )
    return None if upper is None or lower is None else (upper.angle, lower.angle)


def finite(value: float) -> bool:
    return bool(np.isfinite(value))


# Which lift angle has an anchor whose scene names none?
#
# Whether a body that touches the wheel itself is an anchor or a click on its spring, no contact says; the geometry of function
# does: two pallets that lock or drive, and let go. What it measures serves as lift angle for the phases of a run.


def measured_lift(scene: Scene) -> float | None:
    """The way (rad) from where one pallet lets go of a tooth to where the other does; None where no anchor does so.

    Nor where the scene names a lift angle.
    """
    found = roles(scene)
    if scene.lift_angle is not None or found.wheel is None or found.oscillator is None or found.lever is not None:
        return None
    if found.oscillator not in partners(scene, found.wheel):
        return None
    function = measure(scene, few=1, fork_too=False)
    if function.pallets is None or function.swung is None:
        return None
    return 0.5 * (function.swung[0] - function.swung[1])  # it was led half as far again as from let-off to let-off


def with_lift(scene: Scene) -> Scene:
    """The scene with the measured lift angle, so that it is known to keep time; the same where there is none."""
    lift = measured_lift(scene)
    return scene if lift is None else replace(scene, lift_angle=lift)


def with_measured_lift(run: Trajectory) -> Trajectory:
    """The run as of a scene that names the measured lift angle, so that its beats have phases; the same where there is none."""
    scene = with_lift(run.scene)
    return run if scene is run.scene else replace(run, scene=scene)


# Is the wheel driven the way in which its teeth lock? Driven the other way some anchors and pin levers tick all the same, with
# a swing far too small. The lean of the teeth does not tell: those for pins lean either way, and those of a cylinder back.

LOCKED = math.radians(1e-3)  # what locks by less, or is drawn in by less, does not
WASTE = 2.0  # times the drop of the other way: so much no escapement is made to lose


def wrong_way(scene: Scene) -> str | None:
    """A sentence where the teeth do not lock, or drop far, as the wheel is driven, and would lock on both sides the other way.

    Nothing is said of teeth for stones and pallets that lean the way they are driven.
    """
    wheel = roles(scene).wheel
    leans = None if wheel is None else teeth(scene, wheel)
    if wheel is None or leans is None:
        return None
    if leans.direction * drive_direction(scene, wheel) > 0.0 and pallet_word(scene) != "pin":
        return None
    here, driving = measure(scene, few=1, fork_too=False), train(scene, wheel)
    turned = tuple(
        replace(one, value=-one.value, table=tuple((at, -value) for at, value in one.table)) if one.body in driving else one
        for one in scene.torques
    )
    there = measure(replace(scene, torques=turned), few=1, fork_too=False)
    if not _locks(there) or there.parts is None or (_locks(here) and dropped(here) <= WASTE * dropped(there)):
        return None
    pallets, lock = f"{there.parts.pallet}s", _both(there, "lock")
    if _locks(here):
        seen = f"drop far between the {pallets} ({_both(here, 'drop')}; driven the other way {_both(there, 'drop')})"
    elif here.pallets is None:
        seen = f"do not lock on the {pallets}; driven the other way they lock by {lock}"
    else:
        what = "draw" if all(one.lock.value > LOCKED for one in here.pallets) else "lock"
        seen = f"do not lock on the {pallets} ({what} {_both(here, what)}); driven the other way they lock by {lock}"
    way = "clockwise" if drive_direction(scene, wheel) < 0.0 else "counter-clockwise"
    return f"{wheel} is driven {way}, and so its teeth {seen}. Change the sign of the torque"


def _both(function: Function, what: str) -> str:
    return " and ".join(f"{signed(math.degrees(getattr(one, what).value), 3)}°" for one in function.pallets or ())


def _locks(function: Function) -> bool:
    """Do both pallets lock, and, on banks, draw the lever in?"""
    if function.pallets is None or function.parts is None:
        return False
    held = (one.lock.value > LOCKED and (not function.parts.detached or one.draw.value > LOCKED) for one in function.pallets)
    return all(held)


def dropped(function: Function) -> float:
    """The drop (rad) on both pallets together; infinite where there is none to measure, or nothing draws a lever in."""
    if function.pallets is None or function.parts is None:
        return math.inf
    drawn = not function.parts.detached or all(one.draw.value > LOCKED for one in function.pallets)
    return sum(one.drop.value for one in function.pallets) if drawn else math.inf
