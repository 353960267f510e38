"""When does the escape wheel touch what, and where does it stand then?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.body_contacts import between, contact_columns, held, involves
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.marks.stretches import FACES, Codes
from watchsim.scene.roles import Roles
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Pair, Trajectory

TOUCH = (EventKind.IMPACT, EventKind.CLOSE)


@dataclass(frozen=True, slots=True)
class WheelContacts:
    """Contact events of the wheel: times, its progress, how many contacts hold after each, which are touches, and on what; and
    when the lever touches its banking."""

    times: Array
    angle: Array
    held: NDArray[np.int32]
    touching: NDArray[np.bool_]
    on: Codes  # numbers of `FACES`
    banking: Array


def wheel_contacts(run: Trajectory, parts: Roles, found: Beats, within: NDArray[np.bool_]) -> WheelContacts:
    """Those of the beats `within` of the ones found, of the two after them, and the last one before."""
    assert parts.wheel and parts.lever
    times, kinds, which = contact_columns(run, involves(parts.wheel), ["t", "kind", "contact"], *TOUCH, EventKind.OPEN)
    fixed = {body.name for body in run.scene.bodies if body.motion == "fixed"}
    (banking,) = contact_columns(run, between(parts.lever, fixed), ["t"], *TOUCH)
    near = _near(times, found, np.flatnonzero(within))
    used, back = np.unique(which[near], return_inverse=True)
    on = np.array([FACES.index(_face(run.pairs[contact], parts)) for contact in used.tolist()], np.int8)[back]
    holding, touching = held(times, kinds, run.spans)[near].copy(), kinds[near] != EventKind.OPEN
    times = times[near].copy()
    return WheelContacts(times, progress(run, parts.wheel, times), holding, touching, on, banking)


def _near(times: Array, found: Beats, within: NDArray[np.int64]) -> slice:
    """The events that tell the phases of these beats; of the run's first beat those from its start on."""
    if not len(within):
        return slice(0)
    last = min(int(within[-1]) + 2, len(found) - 1)
    earliest, first, end = np.searchsorted(times, (found.start[0], found.start[within[0]], found.end[last])).tolist()
    return slice(max(first - 1, earliest), end)


def _face(pair: Pair, parts: Roles) -> str:
    """On what the wheel presses in a contact: a face of the lever, one of its own teeth, or the oscillator."""
    if parts.oscillator in (pair.body_a, pair.body_b):
        return "balance"
    return "tooth" if pair.body_b == parts.wheel else "stone"  # the second of a pair holds the line or the rounder arc
