"""Which contacts are in force at a given time?"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.columns import blocks

CHANGES = (EventKind.CLOSE, EventKind.OPEN, EventKind.HANDOVER)


def in_force(run: Trajectory, times: list[float]) -> list[list[int]]:
    """For each of the ascending times (s), the numbers of the contacts that hold just after it."""
    holding: dict[int, None] = {}
    found: list[list[int]] = []
    for t, kind, contact, value in _changes(run):
        while len(found) < len(times) and t > times[len(found)]:
            found.append(list(holding))
        if len(found) == len(times):
            break
        if kind == EventKind.OPEN:
            holding.pop(contact, None)
            continue
        if kind == EventKind.HANDOVER:
            holding.pop(int(value), None)
        holding[contact] = None
    return found + [list(holding)] * (len(times) - len(found))


def _changes(run: Trajectory) -> Iterator[tuple[float, int, int, float]]:
    """Time, kind, contact and value of what closes or opens contacts."""
    for (part,) in blocks(run.events):
        told = part[np.isin(part["kind"], CHANGES)]
        yield from zip(*(told[name].tolist() for name in ("t", "kind", "contact", "value")), strict=True)
