"""Does the geometry of function keep the watchmaker's rules?

Each rule names its source; what is broken is a finding with the value, the limit and what to do.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.drawing.findings import Finding
from watchsim.escapement.fork_and_pin import Fork
from watchsim.escapement.measure import Function
from watchsim.escapement.pallets import Pallet
from watchsim.escapement.quantity import Quantity
from watchsim.scene.scene import Scene

PLAYTNER = "H. R. Playtner, An Analysis of the Lever Escapement (1910)"
FINE_WORK = "Watch and Clock Escapements (1904): three quarters of a degree for fine work"
LIMITS = "amplitude ranges of makers' data sheets: up to 310° to 315°"

LEAST_LOCK, LEAST_DROP = 0.75, 0.75  # degrees
LEAST_RUN = 0.1
PIN_SHAKE = (0.25, 0.5)
SPREAD = 0.25
UNEQUAL_DROP = 0.5
HIGHEST_AMPLITUDE = 315.0
LIFT_ANGLE = 1.0
OUT_OF_BEAT = 1.0
NAMES = ("entry", "exit")


@dataclass(frozen=True, slots=True)
class Judgement:
    """A rule that is not kept: `value` and `limit` in degrees."""

    code: str
    severity: str
    value: float
    limit: float
    message: str
    fix: str
    rule: str
    source: str

    def as_dict(self) -> dict[str, object]:
        """As other findings, with value, limit, rule and source."""
        plain = Finding(self.code, self.severity, self.message, self.fix).as_dict()
        value = self.value if math.isfinite(self.value) else None
        return {**plain, "value_deg": value, "limit_deg": self.limit, "rule": self.rule, "source": self.source}


def judgements(scene: Scene, function: Function) -> tuple[Judgement, ...]:
    """All rules that are not kept, those of the stones first."""
    found: list[Judgement] = []
    if function.pallets is not None and function.parts is not None:
        friction = _friction(scene, function)
        for name, one in zip(NAMES, function.pallets, strict=True):
            found += _stone(name, one, friction, function.parts.detached)
        found += _drops(function.pallets)
    if function.fork is not None:
        found += _fork(scene, function.fork)
    found += _freedoms(function)
    return tuple(found)


def _friction(scene: Scene, function: Function) -> float:
    """The largest coefficient between wheel and lever."""
    assert function.parts is not None
    both = {function.parts.wheel, function.parts.lever}
    return max((one.friction for one in scene.contacts if {side.body for side in one.sides} == both), default=0.0)


def _stone(name: str, one: Pallet, friction: float, detached: bool) -> Iterator[Judgement]:
    hold = math.degrees(math.atan(friction))
    known = (each for quantity in (one.draw, one.draw_end) for each in (quantity.value, quantity.worst))
    draw = math.degrees(min((each for each in known if not math.isnan(each)), default=math.nan))
    if detached and draw <= hold:
        message = f"the draw of the {name} stone falls to {draw:.2f}°; friction {friction:g} holds up to {hold:.2f}°"
        fix = "The lever is not drawn to its bank: turn the stone to more draw."
        yield Judgement("draw", "warning", draw, hold, message, fix, "draw above the angle of friction", "Coulomb; " + PLAYTNER)
    lock = math.degrees(min(one.lock.value, one.lock.worst, key=lambda value: value))
    if detached and lock < LEAST_LOCK:
        what = "does not lock: the tooth drops on the impulse face" if lock <= 0.0 else f"locks by {lock:.2f}° only"
        fix = "Draw out the stone, or bring lever and wheel together."
        yield Judgement("lock", "warning", lock, LEAST_LOCK, f"the {name} stone {what}", fix, "lock of ¾° or more", FINE_WORK)
    if detached and (run := _least(one.run)) < LEAST_RUN:
        message = f"the run on the {name} stone is {run:.2f}°: the lever hardly moves on after the drop"
        yield Judgement("run", "warning", run, LEAST_RUN, message, "Open the banking.", "some run, ¼° as a rule", PLAYTNER)
    if math.degrees(one.lock.spread) > SPREAD:
        worst = math.degrees(one.lock.worst)
        message = (
            f"tooth {one.lock.tooth} locks by {worst:.2f}° on the {name} stone, the mean is {math.degrees(one.lock.value):.2f}°"
        )
        fix = "Look at the teeth, and at the pivot of the wheel."
        yield Judgement(
            "uneven-teeth", "warning", math.degrees(one.lock.spread), SPREAD, message, fix, "all teeth lock alike", PLAYTNER
        )


def _drops(pallets: tuple[Pallet, Pallet]) -> Iterator[Judgement]:
    inside, outside = (_least(one.drop) for one in pallets)
    for word, drop in (("inside", inside), ("outside", outside)):
        if drop < LEAST_DROP:
            message = f"the {word} drop is {drop:.2f}° of the wheel: a tooth may catch"
            fix = "Narrow the teeth or the stones."
            yield Judgement("drop", "warning", drop, LEAST_DROP, message, fix, "drop of ¾° or more", FINE_WORK)
    if abs(inside - outside) > UNEQUAL_DROP:
        message = f"the drops differ: {inside:.2f}° inside, {outside:.2f}° outside"
        fix = "Move the stones together where the inside drop is the larger, apart where the outside drop is."
        yield Judgement("unequal-drops", "notice", abs(inside - outside), UNEQUAL_DROP, message, fix, "equal drops", PLAYTNER)


def _fork(scene: Scene, made: Fork) -> Iterator[Judgement]:
    knock = min((math.degrees(one.value) for one in made.knocking if not math.isnan(one.value)), default=math.inf)
    if knock < HIGHEST_AMPLITUDE:
        message = f"the pin strikes the outside of the fork at an amplitude of {knock:.1f}°: no reserve against knocking"
        fix = "A smaller lift angle gives more, or a weaker mainspring keeps away from it."
        yield Judgement("knocking", "warning", knock, HIGHEST_AMPLITUDE, message, fix, "knocking above 315°", LIMITS)
    shake = math.degrees(made.pin_shake.value)
    if not PIN_SHAKE[0] <= shake <= PIN_SHAKE[1]:
        limit = PIN_SHAKE[0] if shake < PIN_SHAKE[0] else PIN_SHAKE[1]
        message = f"the pin has a shake of {shake:.2f}° in the slot"
        what = "too little jams" if shake < PIN_SHAKE[0] else "more is lost lift"
        yield Judgement(
            "pin-shake", "notice", shake, limit, message, f"Change slot or pin: {what}.", "shake of ¼° to ½°", PLAYTNER
        )
    lift = math.degrees(0.5 * (made.lift_angle[0].value + made.lift_angle[1].value))
    told = math.degrees(scene.lift_angle) if scene.lift_angle is not None else lift
    if abs(told - lift) > LIFT_ANGLE:
        message = f"the scene says a lift angle of {told:.2f}°, the drawing has {lift:.2f}°"
        fix = f'Set timegrapher.lift_angle = "{lift:.1f}°": the timegrapher\'s amplitude is in proportion to it.'
        yield Judgement("lift-angle", "warning", told, lift, message, fix, "the lift angle as drawn", "this drawing")
    beat = math.degrees(0.5 * (made.from_rest[0].value + made.from_rest[1].value))
    if abs(beat) > OUT_OF_BEAT:
        message = f"at rest the balance stands {abs(beat):.2f}° off the middle of its lift: out of beat"
        fix = "Turn the rest position of its spring."
        yield Judgement(
            "out-of-beat", "notice", abs(beat), OUT_OF_BEAT, message, fix, "lift even on both sides of rest", PLAYTNER
        )


def _freedoms(function: Function) -> Iterator[Judgement]:
    if function.safety is None or function.pallets is None:
        return
    for k, (name, one) in enumerate(zip(NAMES, function.pallets, strict=True)):
        freedom, lock = function.safety[0 if function.sides[k] > 0.0 else 1], _least(one.total_lock)
        worst, at = math.degrees(freedom.worst.value), math.degrees(freedom.worst_at)
        if worst < lock:
            continue
        where = f"with the balance at {at:.0f}°"
        if math.isinf(worst):
            message = f"{where} nothing keeps the lever on the bank of the {name} stone: it can overbank"
        else:
            message = f"{where} the lever is free by {worst:.2f}°; the {name} stone's total lock is {lock:.2f}°"
        fix = "Lengthen dart or horns, or close the banking."
        rule = "all freedoms less than the total lock, so that draw brings the lever back"
        yield Judgement("freedom", "warning", worst, lock, message, fix, rule, PLAYTNER)


def _least(one: Quantity) -> float:
    return math.degrees(min(one.value, one.worst))
