"""Which contacts are in force at a given time?"""

from __future__ import annotations

import numpy as np

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory

CHANGES = (EventKind.CLOSE, EventKind.OPEN, EventKind.HANDOVER)


def in_force(run: Trajectory, times: list[float]) -> list[list[int]]:
    """For each of the ascending times (s), the numbers of the contacts that hold just after it."""
    events = run.events[np.isin(run.events["kind"], CHANGES)]
    holding: dict[int, None] = {}
    found: list[list[int]] = []
    rows = zip(*(events[name].tolist() for name in ("t", "kind", "contact", "value")), strict=True)
    for t, kind, contact, value in rows:
        while len(found) < len(times) and t > times[len(found)]:
            found.append(list(holding))
        if kind == EventKind.OPEN:
            holding.pop(contact, None)
            continue
        if kind == EventKind.HANDOVER:
            holding.pop(int(value), None)
        holding[contact] = None
    return found + [list(holding)] * (len(times) - len(found))
