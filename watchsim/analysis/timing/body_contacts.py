"""Which contact events concern a body, and which contacts hold at the end?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Pair, Trajectory

Events = NDArray[Any]


def contact_events(run: Trajectory, wanted: Callable[[Pair], bool], *kinds: EventKind) -> Events:
    """The rows of the event table that concern the wanted pairs of primitives, of those kinds (all if none are named)."""
    events = run.events
    contacts, row = np.unique(events["contact"], return_inverse=True)
    # Events without a contact have the number -1.
    mask = np.array([contact >= 0 and wanted(run.pairs[contact]) for contact in contacts.tolist()], bool)[row]
    if kinds:
        mask &= np.isin(events["kind"], kinds)
    return events[mask]


def involves(*names: str) -> Callable[[Pair], bool]:
    """Pairs with any of those bodies on either side."""
    return lambda pair: pair.body_a in names or pair.body_b in names


def between(first: str, others: set[str]) -> Callable[[Pair], bool]:
    """Pairs of body `first` with one of the others."""
    return lambda pair: (pair.body_a == first and pair.body_b in others) or (pair.body_b == first and pair.body_a in others)


def held(events: Events) -> NDArray[np.int64]:
    """How many contacts hold after each of these events."""
    kinds = events["kind"]
    return np.cumsum((kinds == EventKind.CLOSE).astype(np.int64) - (kinds == EventKind.OPEN))


def holding_at_end(run: Trajectory) -> list[Pair]:
    """The pairs whose contact is in force when the run ends."""
    last: dict[int, bool] = {}
    columns = (run.events[name].tolist() for name in ("contact", "kind", "value"))
    for contact, kind, value in zip(*columns, strict=True):
        if kind in (EventKind.CLOSE, EventKind.OPEN):
            last[contact] = kind == EventKind.CLOSE
        elif kind == EventKind.HANDOVER:
            last[int(value)], last[contact] = False, True
    return [run.pairs[contact] for contact, closed in last.items() if closed]
