"""Which numbers of a scene can be changed on the page, and how are they saved back to its file and taken back?"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from watchsim.scene.designed import designed, number_of
from watchsim.scene.errors import SceneError
from watchsim.scene.keys import DESIGN
from watchsim.scene.load import load_set
from watchsim.scene.rewrite import rewritten
from watchsim.scene.scene import Scene
from watchsim.storage.write import write_file
from watchsim.units import UnitError, split

FORMAT = "scene.schema"  # says how the file is read


def knobs(scene: Scene) -> list[dict[str, Any]]:
    """The dimensions of the scene's design with their limits, in their own units; none where it has no design."""
    table = scene.source.get(DESIGN)
    if scene.written is None or not isinstance(table, dict):
        return []
    return [
        {
            "key": f"{DESIGN}.{one.name}",
            "name": one.name.replace("_", " "),
            "meaning": one.meaning,
            "unit": one.unit,
            "low": one.low,
            "high": one.high,
            "count": one.count,
            "value": number_of(one, table[one.name]),
        }
        for one in designed(table["of"]).dimensions
    ]


def values(scene: Scene) -> list[list[str]]:
    """[dotted key, value as written] of every other number that the file holds, in its order."""
    held = scene.source if scene.written is None else scene.written.mapping
    return [[key, str(value)] for key, value in _leaves(held) if _is_number(value) and key != FORMAT]


def _leaves(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, (dict, list)):
        for name, one in value.items() if isinstance(value, dict) else enumerate(value):
            if key or name not in (DESIGN, "lock"):
                yield from _leaves(one, f"{key}.{name}" if key else str(name))
    else:
        yield key, value


def _is_number(value: object) -> bool:
    if isinstance(value, str):
        try:
            number, _ = split(value)
            float(number.replace("−", "-"))
        except (UnitError, ValueError):
            return False
        return True
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class Refused(ValueError):
    """An edit that was not made; the text says why."""


class Edits:
    """Changes of one scene file, each of which can be taken back as long as nobody else has changed the file since."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._made: list[tuple[bytes, bytes]] = []  # what stood there afterwards, and before

    @property
    def count(self) -> int:
        return len(self._made)

    def set(self, key: str, value: str) -> None:
        """Write the value there; Refused, with the file as it is, where the scene has no such number or does not take it."""
        before = self.path.read_bytes()
        try:
            scene = load_set(self.path, {})
        except SceneError as error:
            raise Refused(f"{self.path.name} has faults now; mend them there first") from error
        known = {**dict(values(scene)), **{one["key"]: "" for one in knobs(scene)}}
        if key not in known:
            raise Refused(f"{key}: the scene has no such number")
        try:
            text = rewritten(scene, {key: _typed(value)})
        except SceneError as error:
            raise Refused("\n".join(fault.message for fault in error.faults)) from error
        self._write(text.encode())
        self._made.append((text.encode(), before))

    def undo(self) -> None:
        """Put back what stood there before the last change; Refused where there is none, or the file is another one now."""
        if not self._made:
            raise Refused("there is no change to take back")
        after, before = self._made[-1]
        if self.path.read_bytes() != after:
            self._made.clear()
            raise Refused(f"{self.path.name} was changed elsewhere since; take that back there")
        self._write(before)
        self._made.pop()

    def _write(self, content: bytes) -> None:
        write_file(self.path, lambda place: place.write_bytes(content), "the scene")


def _typed(value: str) -> str | float:
    """A number without a unit as such."""
    try:
        return int(value)
    except ValueError:
        pass
    try:
        return float(value)
    except ValueError:
        return value
