"""What was simulated, as a list that a person can check against a drawing?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from watchsim.scene.scene import Scene

LONG = 6  # entries of a list that are written out
LEFT_OUT = ("lock", "expect")  # shown elsewhere
ROWS = 400


def parameters(scene: Scene) -> list[tuple[str, str]]:
    """(dotted path, value) of everything the scene file says, in its order; as in `--set`."""
    rows = [row for key, value in scene.source.items() if key not in LEFT_OUT for row in _rows(key, value)]
    if len(rows) > ROWS:
        return [*rows[:ROWS], ("…", f"{len(rows) - ROWS} more, in the scene file")]
    return rows


def _rows(path: str, value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _rows(f"{path}.{key}", item)
    elif _is_list(value) and any(isinstance(item, Mapping) for item in value):
        for number, item in enumerate(value):
            yield from _rows(f"{path}.{number}", item)
    else:
        yield path, _told(value)


def _told(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if not _is_list(value):
        return str(value)
    shown = ", ".join(_told(item) for item in value[:LONG])
    return shown if len(value) <= LONG else f"{shown}, … ({len(value)} in all)"


def _is_list(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))
