"""How does a scene file say what to keep of a run?

`record` is one of these or a list of them: a window ["179 s", "180 s"], "all", "events", "statistics", "every 10".
"""

from __future__ import annotations

from typing import Any

from watchsim import units
from watchsim.scene.file.keys.key_values import Table, shown
from watchsim.scene.file.keys.schema import closest
from watchsim.scene.recording import ALL, EVERY, KEPT, Recording, Window

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
