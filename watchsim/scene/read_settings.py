"""How are the title, the run, the timegrapher and the expectations of the scene file read?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from watchsim import units
from watchsim.geometry.primitives import Point
from watchsim.scene.errors import Faults
from watchsim.scene.keys import EXPECTATION, RUN, SCENE, SCHEMA, TIMEGRAPHER, closest
from watchsim.scene.scene import ALL, EVERY, KEPT, Expectation, Recording, Window
from watchsim.scene.values import Table, shown
from watchsim.units import Dimension, UnitError, known_unit, parse, split

# How does a scene file say what to keep of a run?
#
# `record` is one of these or a list of them: a window ["179 s", "180 s"], "all", "events", "statistics", "every 10".

CHOICES = f'write {", ".join(KEPT)}, "{EVERY} 10" for every tenth row, or a window: two times, such as ["179 s", "180 s"]'
DIGITS = 9  # of the number after "every"


def read_record(table: Table, key: str = "record") -> Recording:
    """What the key says; everything where it is absent, and where it cannot be read (the fault is noted)."""
    value = table.mapping.get(key, [])
    items = _items(value)
    windows: list[Window] = []
    keep, stride, words = ALL, 1, [item for item in items if _is_word(item)]
    for i, item in enumerate(items):
        path = key if items == [value] else f"{key}.{i}"
        if not _is_word(item):
            windows += _window(table, path, item)
        elif item in KEPT:
            keep = item
        else:
            stride = _stride(table, path, item)
    kinds = [word for word in words if word in KEPT]
    if len(set(kinds)) > 1:
        table.fault(key, f"{' and '.join(kinds)} exclude each other: choose one", with_value=True)
    elif len(words) - len(kinds) > 1:
        table.fault(key, f"only one of {', '.join(word for word in words if word not in KEPT)} can hold", with_value=True)
    return Recording(tuple(windows), keep, stride)


def _items(value: Any) -> list[Any]:
    """The parts of the value; two times in a list are one window."""
    if not isinstance(value, (list, tuple)):
        return [value]
    is_window = len(value) > 0 and not any(isinstance(item, (list, tuple)) or _is_word(item) for item in value)
    return [value] if is_window else list(value)


def _is_word(item: object) -> bool:
    return isinstance(item, str) and item[:1].isalpha()


def _window(table: Table, path: str, item: object) -> list[Window]:
    if not isinstance(item, (list, tuple)) or len(item) != 2:
        table.faults.add(f"{table.path}.{path}", CHOICES, shown(item))
        return []
    start, end = table.point(path, item, units.TIME)
    if start >= end or start < 0.0:
        table.faults.add(f"{table.path}.{path}", "a window runs from an earlier to a later time, both from 0 s on", shown(item))
        return []
    return [(start, end)] if start < end else []  # what could not be read is no window


def is_stride(text: str) -> bool:
    """Whether the text is a number of rows that a run may have."""
    return text.strip().isdecimal() and len(text.strip()) <= DIGITS and int(text) > 0


def _stride(table: Table, path: str, item: str) -> int:
    word, _, number = item.partition(" ")
    if word == EVERY and is_stride(number):
        return int(number)
    meant = closest(item, (*KEPT, f"{EVERY} 10"))
    hint = f'. Did you mean "{meant}"?' if meant and word != EVERY else ""
    table.faults.add(f"{table.path}.{path}", f"{CHOICES}{hint}", shown(item))
    return 1


# How are the title, the run, the timegrapher and the expectations of the scene file read?

FUNCTION = ("lock", "total_lock", "run", "draw", "drop", "freedom")  # the geometry of function, its worst stone and tooth
WATCH_QUANTITIES = {
    "amplitude": units.ANGLE,
    "rate": units.RATE,
    "period": units.TIME,
    "beat_error": units.TIME,
    "frequency": units.FREQUENCY,
    **dict.fromkeys(FUNCTION, units.ANGLE),
}
EXAMPLES = {  # of what is expected, with its tolerance
    "amplitude": ('"275°"', '"1°"'),
    "rate": ('"4 s/d"', '"1 s/d"'),
    "period": ('"0.25 s"', '"1 µs"'),
    "beat_error": ('"0 ms"', '"0.1 ms"'),
    "frequency": ('"4 Hz"', '"0.01 Hz"'),
}


@dataclass(frozen=True, slots=True)
class Heading:
    """Title, gravity (m/s²) and the tangential law of impacts with its nu."""

    title: str
    gravity: Point
    tangential_law: str
    nu: float


def read_heading(mapping: Mapping[str, Any], faults: Faults) -> Heading:
    table = Table(mapping.get("scene", {}), "scene", SCENE, faults)
    schema = table.mapping.get("schema", SCHEMA)
    if isinstance(schema, bool) or not isinstance(schema, (int, float)):
        table.fault("schema", f"a plain number is needed here, without quotes: schema = {SCHEMA}", with_value=True)
    elif schema != SCHEMA:
        cure = "Install the watchsim that this scene was written for" if schema > SCHEMA else f"Write schema = {SCHEMA}"
        table.fault("schema", f"this version of watchsim reads schema {SCHEMA}. {cure}", with_value=True)
    law, nu = table.one_of("tangential_law", "coulomb"), table.quantity("nu")
    if nu > 0.0 and law not in ("pg1996", ""):
        table.fault("nu", f'belongs to tangential_law = "pg1996"; the law here is {law}. Leave it out', with_value=True)
    return Heading(table.text("title"), table.pair("gravity"), law if table.is_table else "", nu)


def read_run(mapping: Mapping[str, Any], faults: Faults) -> tuple[float, Recording, float]:
    """Duration (s), what to keep, tolerance."""
    table = Table(mapping.get("run", {}), "run", RUN, faults)
    return table.quantity("duration"), read_record(table), table.quantity("tolerance")


def read_timegrapher(mapping: Mapping[str, Any], faults: Faults) -> tuple[float | None, float | None]:
    """Lift angle (rad) and frequency (Hz), None where the scene does not say."""
    table = Table(mapping.get("timegrapher", {}), "timegrapher", TIMEGRAPHER, faults)
    lift_angle, frequency = (table.quantity(key) if key in table else None for key in ("lift_angle", "frequency"))
    return lift_angle, frequency


def read_expectations(mapping: Mapping[str, Any], faults: Faults) -> tuple[Expectation, ...]:
    entries = mapping.get("expect", {})
    if not isinstance(entries, dict):
        faults.add("expect", 'write e.g. "amplitude" = { value = "275°", tolerance = "1°" } below [expect]', shown(entries))
        return ()
    found = (_expectation(key, Table(entry, f"expect.{key}", EXPECTATION, faults)) for key, entry in entries.items())
    return tuple(one for one in found if one)


def _expectation(key: str, table: Table) -> Expectation | None:
    """In the unit of its value, or of its first limit; the others may have another unit of the same kind."""
    value, tolerance = EXAMPLES.get(key, ("500", "3"))
    given = [name for name in ("value", "min", "max") if name in table]
    if given[:1] == ["value"] and len(given) > 1:
        table.fault(given[1], "stands instead of value and tolerance: leave out one or the other", with_value=True)
    elif not given or ("tolerance" in table) != ("value" in table):
        missing = ", ".join(name for name in ("value", "tolerance") if name not in table)
        if table.is_table:
            table.fault("", f"missing: {missing}. Write e.g. {{ value = {value}, tolerance = {tolerance} }}")
        return None
    try:
        unit = split(table.mapping[given[0]])[1]
        dimension = WATCH_QUANTITIES.get(key) or _kind(unit)
        numbers = [_in_unit(parse(table.mapping[name], dimension), table.mapping[name], unit) for name in given]
    except UnitError as error:
        table.fault(given[0], str(error), with_value=True)
        return None
    if given[0] == "value":
        return Expectation(key, numbers[0], _tolerance(table, unit, dimension), unit)
    low, high = (numbers[given.index(name)] if name in given else None for name in ("min", "max"))
    if low is None or high is None:
        return Expectation(key, numbers[0], math.inf, unit, low, high)
    if low > high:
        table.fault("min", "is above max", with_value=True)
    return Expectation(key, 0.5 * (low + high), 0.5 * (high - low), unit, low, high)


def _in_unit(si: float, value: object, unit: str) -> float:
    """In that unit; without conversion where it has it already."""
    number, own = split(value)
    return float(number) if own == unit else si / known_unit(unit).factor


def _kind(unit: str) -> Dimension:
    """What a quantity nobody knows beforehand must be: whatever its own unit says."""
    return Dimension(f"value in {unit}", (known_unit(unit).powers,), unit, (unit, unit)) if unit else units.NUMBER


def _tolerance(table: Table, unit: str, dimension: Dimension) -> float:
    value = table.within("tolerance", table.parsed("tolerance", table.mapping["tolerance"], dimension))
    return value / known_unit(unit).factor
