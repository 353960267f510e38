"""How is the geometry of function reported: `statics` of `check --json`, and lines for people?"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

from watchsim.drawing.findings import Finding
from watchsim.escapement.by_hand import Parts
from watchsim.escapement.fork_and_pin import Fork, Quantity, Safety
from watchsim.escapement.impulses import Impulse, Pallet
from watchsim.escapement.measure import LETS_NONE_OFF, LOCKED, Function, wrong_way
from watchsim.scene.scene import Scene
from watchsim.units import signed

# Each rule names its source; what is broken is a finding with the value, the limit and what to do.

PLAYTNER = "H. R. Playtner, An Analysis of the Lever Escapement (1910)"
FINE_WORK = "Watch and Clock Escapements (1904): three quarters of a degree for fine work"
OWN = "a rule of ours: as little as the pin has in its slot"
LIMITS = "amplitude ranges of makers' data sheets: up to 310° to 315°"

LEAST_LOCK, LEAST_DROP = 0.75, 0.75  # degrees
LEAST_RUN = 0.1
LEAST_SHAKE = 0.25
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


def findings(scene: Scene, function: Function) -> list[dict[str, object]]:
    """All that is to be said of the geometry of function: a wheel driven the wrong way, and the rules that are not kept."""
    why = wrong_way(scene)
    backwards = [] if why is None else [Finding("wrong-way", "warning", why, "").as_dict()]
    # What keeps it from being measured keeps it from working.
    for _, why in function.missing if function.parts is not None and function.parts.detached else ():
        if why.endswith(LETS_NONE_OFF):
            backwards.append(Finding("banking", "warning", why, "Open the banking.").as_dict())
    return backwards + [judgement.as_dict() for judgement in judgements(scene, function)]


def judgements(scene: Scene, function: Function) -> tuple[Judgement, ...]:
    """All rules that are not kept, those of the stones first."""
    found: list[Judgement] = []
    if function.pallets is not None and function.parts is not None:
        friction, held = _friction(scene, function), held_by_pivot(scene, function)
        for name, one, pivot in zip(NAMES, function.pallets, held, strict=True):
            found += _pallet(f"{name} {function.parts.pallet}", one, (friction, pivot), function.parts.detached)
        found += _drops(function.pallets, function.parts.pallet)
        found += _jams(function.pallets, function.parts)
    if function.fork is not None:
        found += _fork(scene, function.fork)
    found += _freedoms(function)
    return tuple(found)


def _friction(scene: Scene, function: Function) -> float:
    """The largest coefficient between wheel and lever."""
    assert function.parts is not None
    both = {function.parts.wheel, function.parts.lever}
    return max((one.friction for one in scene.contacts if {side.body for side in one.sides} == both), default=0.0)


def held_by_pivot(scene: Scene, function: Function) -> tuple[float, float]:
    """Draw (rad) that friction in the lever's pivot takes on the entry and exit stone.

    The pressure turns the lever only where it passes outside the pivot's circle of friction, of radius μ r (r sin atan μ with
    play): at an arm d that takes asin(μ r / d) of the draw beside the face's angle of friction. The lever's weight is left out.
    """
    if function.arms is None or function.parts is None:
        return 0.0, 0.0
    bearings = [one for one in scene.bearings if one.body == function.parts.lever]
    # With play the pivot leans on its hole by Coulomb's law; else friction is that of the whole load.
    circle = sum(one.radius * (math.sin(math.atan(one.friction)) if one.play else one.friction) for one in bearings)
    first, second = (math.asin(min(circle / arm, 1.0)) for arm in function.arms)
    return first, second


def draw_left(scene: Scene, function: Function) -> Iterator[str]:
    """What friction leaves of the draw, in words, where the lever's pivot feels its load."""
    if function.arms is None or function.pallets is None or not any(held_by_pivot(scene, function)):
        return
    faces, pivots = math.atan(_friction(scene, function)), held_by_pivot(scene, function)
    left = [math.degrees(_draw(one) - faces - pivot) for one, pivot in zip(function.pallets, pivots, strict=True)]
    yield f"      {'draw left by friction':24}" + "".join(f"{value:>13.3f}°" for value in left)
    taken = ", ".join(f"{math.degrees(pivot):.3f}°" for pivot in pivots)
    yield f"      {'':24}friction on the faces takes {math.degrees(faces):.3f}°, that of the lever's pivot {taken}"


def _draw(one: Pallet) -> float:
    """The least of a stone, rad."""
    known = (each for quantity in (one.draw, one.draw_end) for each in (quantity.value, quantity.worst))
    return min((each for each in known if not math.isnan(each)), default=math.nan)


def _pallet(name: str, one: Pallet, held: tuple[float, float], detached: bool) -> Iterator[Judgement]:
    friction, pivot = held
    hold = math.degrees(math.atan(friction) + pivot)
    draw = math.degrees(_draw(one))
    if detached and draw <= hold:
        both = f"friction {friction:g}" + (f" with that of the pivot ({math.degrees(pivot):.2f}°)" if pivot else "")
        message = f"the draw of the {name} falls to {draw:.2f}°; {both} holds up to {hold:.2f}°"
        fix = "The lever is not drawn to its bank: turn its face to more draw."
        yield Judgement("draw", "warning", draw, hold, message, fix, "draw above the angle of friction", "Coulomb; " + PLAYTNER)
    lock = math.degrees(min(one.lock.value, one.lock.worst, key=lambda value: value))
    dead = not detached and abs(one.recoil.value) < LOCKED  # where the wheel recoils, one face may lock and drive
    if (detached and lock < LEAST_LOCK) or (dead and lock < math.degrees(LOCKED)):
        what = (
            "does not lock: the tooth drops on the impulse face"
            if lock <= math.degrees(LOCKED)
            else f"locks by {lock:.2f}° only"
        )
        fix = "Draw out what locks, or bring it and the wheel together."
        yield Judgement("lock", "warning", lock, LEAST_LOCK, f"the {name} {what}", fix, "lock of ¾° or more", FINE_WORK)
    if detached and (run := _least(one.run)) < LEAST_RUN:
        message = f"the run on the {name} is {run:.2f}°: the lever hardly moves on after the drop"
        yield Judgement("run", "warning", run, LEAST_RUN, message, "Open the banking.", "some run, ¼° as a rule", PLAYTNER)
    if math.degrees(one.lock.spread) > SPREAD:
        worst = math.degrees(one.lock.worst)
        message = f"tooth {one.lock.tooth} locks by {worst:.2f}° on the {name}, the mean is {math.degrees(one.lock.value):.2f}°"
        fix = "Look at the teeth, and at the pivot of the wheel."
        yield Judgement(
            "uneven-teeth", "warning", math.degrees(one.lock.spread), SPREAD, message, fix, "all teeth lock alike", PLAYTNER
        )


def _drops(pallets: tuple[Pallet, Pallet], word: str) -> Iterator[Judgement]:
    inside, outside = (_least(one.drop) for one in pallets)
    for where, drop in (("inside", inside), ("outside", outside)):
        if drop < LEAST_DROP:
            message = f"the {where} drop is {drop:.2f}° of the wheel: a tooth may catch"
            fix = f"Narrow the teeth or the {word}s."
            yield Judgement("drop", "warning", drop, LEAST_DROP, message, fix, "drop of ¾° or more", FINE_WORK)
    if abs(inside - outside) > UNEQUAL_DROP:
        message = f"the drops differ: {inside:.2f}° inside, {outside:.2f}° outside"
        fix = f"Move the {word}s together where the inside drop is the larger, apart where the outside drop is."
        yield Judgement("unequal-drops", "notice", abs(inside - outside), UNEQUAL_DROP, message, fix, "equal drops", PLAYTNER)


def _jams(pallets: tuple[Pallet, Pallet], parts: Parts) -> Iterator[Judgement]:
    for name, other, one in zip(NAMES, NAMES[::-1], pallets, strict=True):
        shake = _least(one.shake)
        if shake <= 0.0:
            where = f"where the {name} {parts.pallet} is unlocked"
            message = f"the wheel jams {where}: a tooth stands in the {other} one by {-shake:.3f}° of the wheel"
            fix = f"Narrow the teeth or the {parts.pallet}s."
            yield Judgement("shake", "warning", shake, 0.0, message, fix, "shake of the wheel above 0°", PLAYTNER)
        elif shake < LEAST_SHAKE:
            message = f"the wheel has a shake of {shake:.3f}° where the {name} {parts.pallet} is unlocked: it nearly jams"
            fix = f"Narrow the teeth or the {parts.pallet}s."
            yield Judgement("shake", "notice", shake, LEAST_SHAKE, message, fix, "shake of ¼° or more", OWN)


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
    declared = math.degrees(scene.lift_angle) if scene.lift_angle is not None else lift
    if abs(declared - lift) > LIFT_ANGLE:
        message = f"the scene says a lift angle of {declared:.2f}°, the drawing has {lift:.2f}°"
        fix = f'Set timegrapher.lift_angle = "{lift:.1f}°": the timegrapher\'s amplitude is in proportion to it.'
        yield Judgement("lift-angle", "warning", declared, lift, message, fix, "the lift angle as drawn", "this drawing")
    beat = math.degrees(0.5 * (made.from_rest[0].value + made.from_rest[1].value))
    if abs(beat) > OUT_OF_BEAT:
        message = f"at rest the balance stands {abs(beat):.2f}° off the middle of its lift: out of beat"
        fix = "Turn the rest position of its spring."
        yield Judgement(
            "out-of-beat", "notice", abs(beat), OUT_OF_BEAT, message, fix, "lift even on both sides of rest", PLAYTNER
        )


def _freedoms(function: Function) -> Iterator[Judgement]:
    if function.safety is None or function.pallets is None or function.parts is None:
        return
    for k, (name, one) in enumerate(zip(pallet_names(function.parts), function.pallets, strict=True)):
        freedom, lock = function.safety[0 if function.sides[k] > 0.0 else 1], _least(one.total_lock)
        worst, at = math.degrees(freedom.worst.value), math.degrees(freedom.worst_at)
        if worst < lock:
            continue
        where = f"with the balance at {at:.0f}°"
        if math.isinf(worst):
            message = f"{where} nothing keeps the lever on the bank of the {name}: it can overbank"
        else:
            message = f"{where} the lever is free by {worst:.2f}°; the {name}'s total lock is {lock:.2f}°"
        fix = "Lengthen dart or horns, or close the banking."
        rule = "all freedoms less than the total lock, so that draw brings the lever back"
        yield Judgement("freedom", "warning", worst, lock, message, fix, rule, PLAYTNER)


def _least(one: Quantity) -> float:
    return math.degrees(min(one.value, one.worst))


OF_BALANCE = ("lift_angle", "unlocking", "impulse_end", "knocking", "from_rest")
NOTICEABLE = math.radians(1e-3)  # teeth that differ by less are alike
WORDS = {
    "total_lock": "total lock",
    "lock": "lock",
    "run": "run",
    "draw": "draw on the bank",
    "draw_end": "draw at the corner",
    "recoil": "recoil of the wheel",
    "lift": "lift",
    "lift_stone": "  on the {pallet}",
    "lift_tooth": "  on the tooth",
    "drop": "drop of the wheel",
    "shake": "shake of the wheel",
}
ANCHOR_WORDS = WORDS | {"draw": "draw, swung out", "recoil": "recoil, swinging out"}
BALANCE_WORDS = {
    "lift_angle": "lift angle",
    "unlocking": "  unlocked after",
    "impulse_end": "  let off after",
    "from_rest": "  pin meets the fork at",
    "knocking": "knocks at",
}
IMPULSE_WORDS = {
    "catch_up": "  wheel catches up by",
    "wheel": "  wheel turns",
    "lever": "  lever turns",
    "balance": "  balance turns",
    "begins": "  from, balance at",
    "ends": "  to, balance at",
}


def statics(function: Function) -> dict[str, Any]:
    """Degrees; beside each value its error and, of what depends on a tooth, the worst tooth. Null where it does not apply.

    Under `entry` and `exit` stand the numbers of the stone and of the beat in which it is unlocked; `missing` says what was not
    measured and why.
    """
    parts = function.parts
    found: dict[str, Any] = {
        "roles": None if parts is None else {"wheel": parts.wheel, "lever": parts.lever, "balance": parts.balance},
        "direction": None if parts is None else direction(function),
        "teeth": function.teeth,
        "lever_travel_deg": None if function.banks is None else math.degrees(function.banks[0] - function.banks[1]),
        "missing": [{"what": what, "why": why} for what, why in function.missing],
    }
    for k, name in enumerate(NAMES):
        found[name] = _of_stone(function, k)
    made = function.fork
    found["pin_shake_deg"] = None if made is None else _degrees(made.pin_shake.value)
    found["pin_shake_deg_error"] = None if made is None else _degrees(made.pin_shake.error)
    return found


def pallet_names(parts: Parts) -> tuple[str, ...]:
    """ "entry stone", "exit stone", or pallets, or pins."""
    return tuple(f"{name} {parts.pallet}" for name in NAMES)


def direction(function: Function) -> str:
    return "clockwise" if function.parts is not None and function.parts.way < 0.0 else "counter-clockwise"


def _of_stone(function: Function, k: int) -> dict[str, Any] | None:
    if function.pallets is None:
        return None
    stone: dict[str, Any] = {}
    for field in fields(Pallet):
        stone |= _entries(field.name, getattr(function.pallets[k], field.name))
    if function.fork is not None:
        for name in OF_BALANCE:
            stone |= _entries(name, getattr(function.fork, name)[_beat(function, k)])
    pushed = push(function, k)
    if pushed is not None:
        stone["impulse"] = pushed.kind
        for name in IMPULSE_WORDS:
            stone |= _entries(f"impulse_{name}", getattr(pushed, name))
    guards = guard(function, k)
    if guards is not None:
        stone |= _entries("guard_freedom", guards.guard) | _entries("horn_freedom", guards.horn)
        stone |= _entries("worst_freedom", guards.worst)
        stone["worst_freedom_at_deg"] = _degrees(guards.worst_at)
        stone["guard_clearance_mm"] = 1e3 * guards.guard_clearance
    return stone


def _beat(function: Function, k: int) -> int:
    """Row of the pairs numbered by upper and lower bank that belongs to the entry (0) or exit (1) stone."""
    return 0 if function.sides[k] > 0.0 else 1


def push(function: Function, k: int) -> Impulse | None:
    """The impulse of the beat in which the entry (0) or exit (1) stone is unlocked, where it is given by another stone."""
    return None if function.impulses is None else function.impulses[_beat(function, k)]


def guard(function: Function, k: int) -> Safety | None:
    """The safety action while the entry (0) or exit (1) stone is locked."""
    return None if function.safety is None else function.safety[_beat(function, k)]


def _entries(name: str, one: Quantity) -> dict[str, Any]:
    values: dict[str, Any] = {f"{name}_deg": _degrees(one.value), f"{name}_deg_error": _degrees(one.error)}
    if one.tooth is not None:
        values |= {f"{name}_deg_worst": _degrees(one.worst), f"{name}_deg_worst_tooth": one.tooth}
    return values


def _degrees(value: float) -> float | None:
    return math.degrees(value) if math.isfinite(value) else None


@dataclass(frozen=True, slots=True)
class Row:
    """A quantity in words, its values for entry and exit stone (or one for both), and the worst tooth where teeth differ."""

    words: str
    values: tuple[str, ...]
    worst: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """Rows that belong together; `title` is empty where they go on with what is above."""

    title: str
    rows: tuple[Row, ...]


def text(function: Function) -> Iterator[str]:
    """The same for people; nothing of a scene without such parts."""
    if function.parts is None:
        return
    if function.pallets is not None:
        yield f"  geometry of function: {measured(function)}"
        yield f"      {'':24}" + "".join(f"{name:>14}" for name in pallet_names(function.parts))
    for table in tables(function):
        if table.title:
            yield f"    {table.title}"
        for row in table.rows:
            worst = f"   worst: {row.worst}" if row.worst else ""
            yield f"      {row.words:24}" + "".join(f"{value:>14}" for value in row.values) + worst
    if any(_stands_out(getattr(one, name)) for one in function.pallets or () for name in WORDS):
        yield f"      {'':24}teeth are counted anticlockwise in the drawing, 1 is nearest to the x axis"
    if function.swung is not None:
        ends = " and ".join(f"{signed(math.degrees(end), 3)}°" for end in function.swung)
        yield f"      swung out to {ends}: half as far again as from let-off to let-off"
    for what, why in function.missing:
        yield f"  {what}: not measured, {why}"


def measured(function: Function) -> str:
    """Of which wheel, where its angles are, and how exact, in words."""
    assert function.parts is not None
    return (
        f"{function.parts.wheel} turns {direction(function)}, {function.teeth} teeth; "
        f"angles at each part's own pivot, exact to {_worst_error(function):.0e}°"
    )


def tables(function: Function) -> Iterator[Table]:
    """What was measured, in words: of the stones, of an impulse between other stones, of the balance, of the safety action."""
    if function.pallets is not None:
        parts = function.parts
        named_so = WORDS if parts is None or parts.detached else ANCHOR_WORDS
        known = ((words, [getattr(one, name) for one in function.pallets]) for name, words in named_so.items())
        pairs = ((words, pair) for words, pair in known if any(math.isfinite(one.value) for one in pair))
        yield Table("", tuple(_row(words.format(pallet=parts.pallet if parts else ""), pair) for words, pair in pairs))
    if function.impulses is not None:
        pushes = [one for one in (push(function, k) for k in (0, 1)) if one is not None]
        kinds = Row("impulse, once unlocked", tuple(one.kind for one in pushes))
        given = ((words, [getattr(one, name) for one in pushes]) for name, words in IMPULSE_WORDS.items())
        yield Table("", (kinds, *(_row(words, pair) for words, pair in given)))
    if function.fork is not None:
        yield from _fork_tables(function)


def _row(words: str, pair: list[Quantity]) -> Row:
    return Row(words, tuple(_degrees_words(one.value) for one in pair), _worst_tooth(pair))


def _fork_tables(function: Function) -> Iterator[Table]:
    assert function.fork is not None and function.parts is not None
    rows = []
    for name, words in BALANCE_WORDS.items():
        pair = [getattr(function.fork, name)[_beat(function, k)] for k in (0, 1)]
        rows.append(Row(words, tuple(_degrees_words(one.value) for one in pair)))
    rows.append(Row("shake of the pin", (_degrees_words(function.fork.pin_shake.value),)))
    yield Table(f"{function.parts.balance}, from the pin's meeting the fork", tuple(rows))
    if function.safety is not None:
        guards = [guard(function, k) for k in (0, 1)]
        freedoms = (("guard", "guard pin"), ("horn", "horns"), ("worst", "largest anywhere"))
        found = (Row(words, tuple(_degrees_words(getattr(one, name).value) for one in guards)) for name, words in freedoms)
        yield Table(f"freedom of {function.parts.lever} on its bank", tuple(found))


def _degrees_words(value: float) -> str:
    return "never" if math.isinf(value) else "–" if math.isnan(value) else f"{signed(math.degrees(value), 3)}°"


def _worst_tooth(pair: list[Quantity]) -> str:
    """Words where the teeth are not alike."""
    words = [
        f"{_degrees_words(one.worst)} at tooth {one.tooth} ({name})"
        for name, one in zip(NAMES, pair, strict=True)
        if _stands_out(one)
    ]
    return ", ".join(words)


def _stands_out(one: Quantity) -> bool:
    return one.tooth is not None and one.spread > NOTICEABLE


def _worst_error(function: Function) -> float:
    assert function.pallets is not None
    errors = [getattr(one, field.name).error for one in function.pallets for field in fields(Pallet)]
    return math.degrees(max(error for error in errors if math.isfinite(error)))
