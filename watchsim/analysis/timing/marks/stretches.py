"""How are the phases of many beats kept: in columns, of which a row is made into words only when it is looked at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.record.trajectory import Array

NAMES = ("unlock", "catch-up", "impulse", "drop", "run to banking", "locked", "recoil")
FACES = ("stone", "tooth", "balance", "")  # on what the wheel pushes in an impulse; the last is for other phases
NOTHING = FACES.index("")
COLUMNS = ("beat", "name", "start", "end", "on")

Codes = NDArray[np.int8]


class Stretch(NamedTuple):
    """One phase of the half swing number `beat`, s; `name` of `NAMES`; `on` of `FACES`, or a hinged pallet."""

    beat: int
    name: str
    start: float
    end: float
    on: str = ""


@dataclass(frozen=True, slots=True)
class Stretches:
    """Phases in order, (n,): number of the half swing, place in `NAMES`, s, s, and place in `words`."""

    beat: NDArray[np.int64]
    name: Codes
    start: Array
    end: Array
    on: Codes
    words: tuple[str, ...] = FACES

    def __len__(self) -> int:
        return len(self.beat)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> Stretches:
        """Only some rows."""
        return replace(self, **{name: getattr(self, name)[chosen] for name in COLUMNS})

    @property
    def names(self) -> list[str]:
        return [NAMES[code] for code in self.name.tolist()]

    @property
    def faces(self) -> list[str]:
        return [self.words[code] for code in self.on.tolist()]

    @property
    def first(self) -> NDArray[np.int64]:
        """The first row of each beat."""
        return np.flatnonzero(np.append(True, self.beat[1:] != self.beat[:-1])[: len(self)])


def gathered(beats: Iterator[list[Stretch]], at_once: int) -> Iterator[Stretches]:
    """Those of so many beats at a time, from the phases of one beat after the other."""
    while some := list(islice(beats, at_once)):
        yield in_columns([row for rows in some for row in rows])


def in_columns(rows: Sequence[Stretch]) -> Stretches:
    """The same in columns."""
    beat, name, start, end, on = zip(*rows, strict=True) if rows else ((),) * 5
    words = (*FACES, *sorted(set(on).difference(FACES)))
    codes = (np.array([known.index(one) for one in column], np.int8) for known, column in ((NAMES, name), (words, on)))
    return Stretches(np.array(beat, np.int64), next(codes), np.array(start, float), np.array(end, float), next(codes), words)
