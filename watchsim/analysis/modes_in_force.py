"""Which contacts are in force at some times of a run, and in which mode?

Events say how modes change. At the first of the times a contact's mode follows from the last event of its own; from there on
each event is followed.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks

MODES = (EventKind.CLOSE, EventKind.OPEN, EventKind.STICK, EventKind.SLIDE, EventKind.HANDOVER)

InForce = tuple[tuple[int, int], ...]  # contacts with their modes, by number of the contact


def modes_in_force(run: Trajectory, times: Array) -> dict[InForce, list[int]]:
    """What is in force -> at which of the times it is: their places among `times`, the earliest first."""
    order = np.argsort(times, kind="stable")
    sorted_times, places = times[order], order.tolist()
    modes: dict[int, int] = {}
    found: dict[InForce, list[int]] = {}
    asked = 0  # how many of the times are done
    for (part,) in blocks(run.events):
        if asked == len(places):
            break
        told = np.compress(np.isin(part["kind"], MODES), part)  # a third of the time of indexing
        t = np.ascontiguousarray(told["t"])
        done = int(np.searchsorted(t, sorted_times[0], side="right"))
        modes = _Changes(told[:done], modes).modes()
        here = sorted_times[asked : _before(sorted_times, part["t"][-1])]
        for stop, times_there in zip(*np.unique(np.searchsorted(t, here, side="right"), return_counts=True), strict=True):
            _follow(modes, told[done:stop])
            found.setdefault(_in_order(modes), []).extend(places[asked : asked + times_there])
            done, asked = stop, asked + times_there
        if asked < len(places):
            _follow(modes, told[done:])
    if asked < len(places):
        found.setdefault(_in_order(modes), []).extend(places[asked:])
    return found


def _in_order(modes: dict[int, int]) -> InForce:
    return tuple(sorted(modes.items()))


def _before(times: Array, end: float) -> int:
    """How many of the times, in order, come before `end`."""
    return int(np.searchsorted(times, end, side="left"))


class _Changes:
    """Events that change modes, by contact: what a contact's mode is follows from the last of its own, not from all before."""

    def __init__(self, events: NDArray[Any], earlier: dict[int, int]) -> None:
        """`earlier`: the modes before the first of the events."""
        gained, lost = events["contact"].astype(np.int64), events["value"].astype(np.int64)
        handed = events["kind"] == EventKind.HANDOVER
        self._events, self._earlier = events, earlier
        of = np.concatenate((gained, lost[handed]))
        at = np.concatenate((np.arange(len(events)), np.flatnonzero(handed)))
        order = np.lexsort((at, of))
        contacts, first = np.unique(of[order], return_index=True)
        self._numbers = dict(zip(contacts.tolist(), np.split(at[order], first[1:]), strict=False))  # of each contact's events

    def modes(self) -> dict[int, int]:
        """Contact -> mode of what is in force after all of the events."""
        found = {contact: self._mode(contact) for contact in {*self._numbers, *self._earlier}}
        return {contact: mode for contact, mode in found.items() if mode is not None}

    def _mode(self, contact: int) -> int | None:
        """The mode of a contact after all of the events; None where it is open."""
        otherwise, before = None, len(self._events)
        while (number := self._last_of(contact, before)) is not None:
            event = self._events[number]
            if int(event["kind"]) != EventKind.HANDOVER:
                own: dict[int, int] = {}
                change(own, int(event["kind"]), contact, event["value"])
                return own.get(contact, otherwise)
            if int(event["contact"]) != contact:  # to that one, from this
                return otherwise
            otherwise, contact, before = STICK, int(event["value"]), number
        return self._earlier.get(contact, otherwise)

    def _last_of(self, contact: int, before: int) -> int | None:
        """The number of the last event before another that says something about a contact."""
        own = self._numbers.get(contact, ())
        k = int(np.searchsorted(own, before))
        return int(own[k - 1]) if k else None


def _follow(modes: dict[int, int], events: NDArray[Any]) -> None:
    for kind, contact, value in zip(*(events[name].tolist() for name in ("kind", "contact", "value")), strict=True):
        change(modes, kind, contact, value)


def change(modes: dict[int, int], kind: int, contact: int, value: float) -> None:
    if kind == EventKind.HANDOVER:
        modes[contact] = modes.pop(int(value), STICK)
    elif kind == EventKind.STICK:
        modes[contact] = STICK
    elif kind == EventKind.OPEN or (kind == EventKind.CLOSE and int(value) == OPEN):
        modes.pop(contact, None)
    else:
        modes[contact] = int(value)
