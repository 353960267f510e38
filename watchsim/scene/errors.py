"""What is wrong with a scene, where does it stand, and what mends it?

Faults are collected, never thrown one at a time: a designer mends a scene once, not once per fault.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

CHANGED = "changed value"  # the place of a value that is in no file
MOST_SHOWN = 500  # faults in the text of an error


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that must be mended; `shown` follows the key: the value seen (" = 28800") or a file (" -> a.dxf")."""

    key: str
    message: str
    shown: str = ""
    place: str = ""

    def __str__(self) -> str:
        heading = f"{self.place}  {self.key}{self.shown}".rstrip()
        message = self.message if self.message.endswith((".", "?")) else f"{self.message}."
        return "\n  ".join([heading, *message.splitlines()])


class SceneError(ValueError):
    """A scene that cannot be simulated. `faults` holds every fault found; the text lists them, of very many the first."""

    def __init__(self, faults: tuple[Fault, ...] | list[Fault]) -> None:
        self.faults = tuple(faults)
        lines = [str(fault) for fault in self.faults[:MOST_SHOWN]]
        if len(self.faults) > MOST_SHOWN:
            lines.append(f"... and {len(self.faults) - MOST_SHOWN} more faults. Mend these first")
        super().__init__("\n".join(lines))

    def sentence(self, varied: Iterable[str] = ()) -> str:
        """All faults in one line; of the only key `varied`, which is named beside it, the message alone."""
        only = set(varied)
        known = only if len(only) == 1 else set()
        said = (
            ("" if one.key in known else f"{one.key}{'' if one.place == CHANGED else one.shown}: ") + one.message
            for one in self.faults
        )
        return "; ".join(" ".join(text.split()).removesuffix(".") for text in said)


@dataclass
class Faults:
    """Collects faults.

    lines    line numbers of dotted keys
    changed  keys set from outside the file; `by` what
    spelt    dotted keys that are misspelt in the file -> how they stand there
    """

    file: str = ""
    lines: Mapping[str, int] = field(default_factory=dict)
    changed: frozenset[str] = frozenset()
    by: str = CHANGED
    spelt: dict[str, str] = field(default_factory=dict)
    found: list[Fault] = field(default_factory=list)
    _known: set[Fault] = field(default_factory=set, repr=False)

    def add(self, key: str, message: str, shown: str = "") -> None:
        """Notes one fault at a dotted key such as "bodies.lever.position.1"; the same fault twice counts once."""
        place, key = self._place(key), self._written(key)
        fault = Fault(key, message, shown, place)
        if fault not in self._known:
            self._known.add(fault)
            self.found.append(fault)

    def raise_any(self) -> None:
        """SceneError with everything found so far, if there is anything, in the order of the file."""
        if self.found:
            raise SceneError(sorted(self.found, key=lambda fault: self._line(fault.key) or 0))

    def _place(self, key: str) -> str:
        if self.changed and any(key == changed or key.startswith(changed + ".") for changed in self.changed):
            return self.by
        line = self._line(self._written(key))
        return f"{self.file}:{line}" if line else self.file

    def _written(self, key: str) -> str:
        """The key as it stands in the file."""
        meant = key if self.spelt else ""
        while meant:  # the longest first
            if meant in self.spelt:
                key = self.spelt[meant] + key.removeprefix(meant)
            meant = meant.rpartition(".")[0]
        return key

    def _line(self, key: str) -> int | None:
        """The line of the key itself, else of the nearest table or array that holds it."""
        while key:
            if key in self.lines:
                return self.lines[key]
            key = key.rpartition(".")[0]
        return None
