"""How is the geometry of function reported: `statics` of `check --json`, and lines for people?"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

from watchsim.escapement.impulses import Impulse
from watchsim.escapement.measure import Function
from watchsim.escapement.pallets import Pallet
from watchsim.escapement.quantity import Quantity
from watchsim.escapement.safety import Safety

STONES = ("entry", "exit")
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
    "lift_stone": "  on the stone",
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
    for k, name in enumerate(STONES):
        found[name] = _of_stone(function, k)
    made = function.fork
    found["pin_shake_deg"] = None if made is None else _degrees(made.pin_shake.value)
    found["pin_shake_deg_error"] = None if made is None else _degrees(made.pin_shake.error)
    return found


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
    told: dict[str, Any] = {f"{name}_deg": _degrees(one.value), f"{name}_deg_error": _degrees(one.error)}
    if one.tooth is not None:
        told |= {f"{name}_deg_worst": _degrees(one.worst), f"{name}_deg_worst_tooth": one.tooth}
    return told


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
        yield f"      {'':24}{'entry stone':>14}{'exit stone':>14}"
    for table in tables(function):
        if table.title:
            yield f"    {table.title}"
        for row in table.rows:
            worst = f"   worst: {row.worst}" if row.worst else ""
            yield f"      {row.words:24}" + "".join(f"{value:>14}" for value in row.values) + worst
    if any(_stands_out(getattr(one, name)) for one in function.pallets or () for name in WORDS):
        yield f"      {'':24}teeth are counted anticlockwise in the drawing, 1 is nearest to the x axis"
    if function.swung is not None:
        ends = " and ".join(f"{math.degrees(end):.3f}°" for end in function.swung)
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
        named_so = WORDS if function.parts is None or function.parts.detached else ANCHOR_WORDS
        named = ((words, [getattr(one, name) for one in function.pallets]) for name, words in named_so.items())
        yield Table("", tuple(_row(words, pair) for words, pair in named if any(math.isfinite(one.value) for one in pair)))
    if function.impulses is not None:
        pushes = [one for one in (push(function, k) for k in (0, 1)) if one is not None]
        kinds = Row("impulse, once unlocked", tuple(one.kind for one in pushes))
        pairs = ((words, [getattr(one, name) for one in pushes]) for name, words in IMPULSE_WORDS.items())
        yield Table("", (kinds, *(_row(words, pair) for words, pair in pairs)))
    if function.fork is not None:
        yield from _fork_tables(function)


def _row(words: str, pair: list[Quantity]) -> Row:
    return Row(words, tuple(_told(one.value) for one in pair), _worst_tooth(pair))


def _fork_tables(function: Function) -> Iterator[Table]:
    assert function.fork is not None and function.parts is not None
    rows = []
    for name, words in BALANCE_WORDS.items():
        pair = [getattr(function.fork, name)[_beat(function, k)] for k in (0, 1)]
        rows.append(Row(words, tuple(_told(one.value) for one in pair)))
    rows.append(Row("shake of the pin", (_told(function.fork.pin_shake.value),)))
    yield Table(f"{function.parts.balance}, from the pin's meeting the fork", tuple(rows))
    if function.safety is not None:
        guards = [guard(function, k) for k in (0, 1)]
        freedoms = (("guard", "guard pin"), ("horn", "horns"), ("worst", "largest anywhere"))
        told = (Row(words, tuple(_told(getattr(one, name).value) for one in guards)) for name, words in freedoms)
        yield Table(f"freedom of {function.parts.lever} on its bank", tuple(told))


def _told(value: float) -> str:
    return "never" if math.isinf(value) else "-" if math.isnan(value) else f"{round(math.degrees(value), 3) + 0.0:.3f}°"


def _worst_tooth(pair: list[Quantity]) -> str:
    """Words where the teeth are not alike."""
    words = [
        f"{_told(one.worst)} at tooth {one.tooth} ({name})" for name, one in zip(STONES, pair, strict=True) if _stands_out(one)
    ]
    return ", ".join(words)


def _stands_out(one: Quantity) -> bool:
    return one.tooth is not None and one.spread > NOTICEABLE


def _worst_error(function: Function) -> float:
    assert function.pallets is not None
    errors = [getattr(one, field.name).error for one in function.pallets for field in fields(Pallet)]
    return math.degrees(max(error for error in errors if math.isfinite(error)))
