"""Which contact events concern a body, and which contacts hold at the end?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Pair, Trajectory
from watchsim.storage.columns import blocks

Events = NDArray[Any]
Column = NDArray[Any]
Bits = NDArray[np.bool_]


def contact_events(run: Trajectory, wanted: Callable[[Pair], bool], *kinds: EventKind) -> Events:
    """The rows of the event table that concern the wanted pairs of primitives, of those kinds (all if none are named)."""
    found = [part[_concerned(run, part, wanted, kinds)] for (part,) in blocks(run.events)]
    return np.concatenate(found) if found else run.events


def contact_numbers(run: Trajectory, wanted: Callable[[Pair], bool]) -> set[int]:
    """The wanted contacts that ever had an event."""
    numbers = (part["contact"][_concerned(run, part, wanted, ())] for (part,) in blocks(run.events))
    return {number for part in numbers for number in np.unique(part).tolist()}


def contact_columns(run: Trajectory, wanted: Callable[[Pair], bool], names: list[str], *kinds: EventKind) -> list[Column]:
    """Only these columns of the same rows: of a long run there are millions."""
    found: list[list[Column]] = [[] for _ in names]
    for (part,) in blocks(run.events):
        own = _concerned(run, part, wanted, kinds)
        for column, name in zip(found, names, strict=True):
            column.append(part[name][own])
    return [np.concatenate(column or [run.events[name]]) for column, name in zip(found, names, strict=True)]


def _concerned(run: Trajectory, events: Events, wanted: Callable[[Pair], bool], kinds: tuple[EventKind, ...]) -> Bits:
    # Events without a contact have the number -1, that of the last place.
    is_wanted = np.zeros(len(run.pairs) + 1, bool)
    for contact in np.flatnonzero(np.bincount(events["contact"] + 1)).tolist():
        is_wanted[contact - 1] = contact > 0 and wanted(run.pairs[contact - 1])
    mask: Bits = is_wanted[events["contact"]]
    if kinds:
        of_kind = np.zeros(max(EventKind) + 1, bool)
        of_kind[list(kinds)] = True
        mask &= of_kind[events["kind"]]
    return mask


def involves(*names: str) -> Callable[[Pair], bool]:
    """Pairs with any of those bodies on either side."""
    return lambda pair: pair.body_a in names or pair.body_b in names


def between(first: str, others: set[str]) -> Callable[[Pair], bool]:
    """Pairs of body `first` with one of the others."""
    return lambda pair: (pair.body_a == first and pair.body_b in others) or (pair.body_b == first and pair.body_a in others)


def held(times: Column, kinds: Column, spans: Sequence[tuple[float, float]] = ()) -> NDArray[np.int32]:
    """How many contacts hold after each of the events of these kinds, of one body that is free at some time.

    A stretch that was recorded (`spans`, s) may begin while contacts hold, whose closing is no event of it: the count is
    then below zero where none holds.
    """
    change = (kinds == EventKind.CLOSE).astype(np.int8) - (kinds == EventKind.OPEN)
    begins = np.searchsorted(times, [start for start, _ in spans[1:]])
    counts = [np.cumsum(own, dtype=np.int32) for own in np.split(change, begins)]
    return np.concatenate([own - own.min(initial=0) for own in counts], dtype=np.int32)


def holding_at_end(run: Trajectory) -> list[Pair]:
    """The pairs whose contact is in force when the run ends."""
    last: dict[int, bool] = {}
    for (part,) in blocks(run.events):
        for contact, kind, value in zip(*(part[name].tolist() for name in ("contact", "kind", "value")), strict=True):
            if kind in (EventKind.CLOSE, EventKind.OPEN):
                last[contact] = kind == EventKind.CLOSE
            elif kind == EventKind.HANDOVER:
                last[int(value)], last[contact] = False, True
    return [run.pairs[contact] for contact, closed in last.items() if closed]
