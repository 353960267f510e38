"""Which contacts are in force at a given time?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.columns import blocks

CHANGES = (EventKind.CLOSE, EventKind.OPEN, EventKind.HANDOVER)
AT_ONCE = 4096  # events

Holding = dict[int, None]  # contacts, in the order in which they came


def in_force(run: Trajectory, times: list[float]) -> list[list[int]]:
    """For each of the ascending times (s), the numbers of the contacts that hold just after it."""
    holding: Holding = {}
    found: list[list[int]] = []
    for (part,) in blocks(run.events, length=AT_ONCE):
        told = part[np.isin(part["kind"], CHANGES)]
        cuts = np.searchsorted(told["t"], times[len(found) :], side="right")
        begun = 0
        for cut in cuts[cuts < len(told)].tolist():
            holding, begun = _after(holding, told[begun:cut]), cut
            found.append(list(holding))
        if len(found) == len(times):
            break
        holding = _after(holding, told[begun:])
    return found + [list(holding)] * (len(times) - len(found))


def _after(holding: Holding, changes: NDArray[np.void]) -> Holding:
    """What holds after some changes, in order: a contact that opens, or hands over to another one, no longer does."""
    kind, contact, at = changes["kind"], changes["contact"].astype(np.int64), 2 * np.arange(len(changes))
    ends = kind != EventKind.CLOSE
    ended = np.where(kind == EventKind.HANDOVER, changes["value"], changes["contact"])[ends].astype(np.int64)
    begins = kind != EventKind.OPEN
    last = np.full(max(contact.max(initial=0), ended.max(initial=0)) + 1, -1)
    last[ended] = at[ends]
    lasting = contact[begins][at[begins] + 1 > last[contact[begins]]]
    over = set(ended.tolist())
    return {one: None for one in holding if one not in over} | dict.fromkeys(lasting.tolist())
