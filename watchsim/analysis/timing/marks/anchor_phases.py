"""What are the phases of the beats of an anchor that swings as one with the oscillator? (See `phases`.)

Impulse, drop, then it is locked, or recoils where the wheel turns back.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.marks.anchor_marks import Marks, anchor_marks
from watchsim.analysis.timing.marks.stretches import Stretch, Stretches, gathered
from watchsim.analysis.timing.marks.wheel_contacts import WheelContacts
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.scene.roles import Roles
from watchsim.simulation.record.trajectory import Trajectory

RECOIL = 1e-3  # of the wheel's advance in a beat: a wheel that turns back less is led by a dead-beat anchor


def anchor_phases(
    run: Trajectory, parts: Roles, found: Beats, contacts: WheelContacts, within: NDArray[np.bool_], size: int
) -> Iterator[Stretches]:
    """Those of `size` beats at a time: of the beats `within`."""
    return gathered(_beats(run, parts, found, contacts, within), size)


def _beats(
    run: Trajectory, parts: Roles, found: Beats, contacts: WheelContacts, within: NDArray[np.bool_]
) -> Iterator[list[Stretch]]:
    """The phases of one beat after the other."""
    assert parts.wheel
    at_rows = progress(run, parts.wheel, run.t)
    needed = within | np.append(False, within[:-1])  # where a beat is locked ends with the impulse of the next,
    needed |= np.append(False, needed[:-1])  # or of the one after, where every other half swing has none
    told = needed & is_recorded(run, found.start) & is_recorded(run, found.end)
    marks = [
        anchor_marks(contacts.times, contacts.held, contacts.angle, run.t, at_rows, *span) if known else None
        for known, span in zip(told, zip(found.start.tolist(), found.end.tolist(), strict=True), strict=True)
    ]
    for i, (own, after) in enumerate(zip_longest(marks, _next_ones(marks, told))):
        if own is None or not within[i]:
            continue
        beat, rows = found.before + i + 1, []
        if own.freed is not None and own.caught is not None:
            rows.append(Stretch(beat, "unlock", own.moved, own.freed))
            rows.append(Stretch(beat, "catch-up", own.freed, own.caught))
        rows.append(Stretch(beat, "impulse", own.moved if own.caught is None else own.caught, own.let_off))
        rows.append(Stretch(beat, "drop", own.let_off, own.lock))
        if after is not None:
            at_lock, back = progress(run, parts.wheel, np.array([own.lock, after.moved])).tolist()
            recoils = at_lock - back > RECOIL * (at_lock - float(np.interp(own.moved, run.t, at_rows)))
            rows.append(Stretch(beat, "recoil" if recoils else "locked", own.lock, after.moved))
        yield rows


def _next_ones(marks: list[Marks | None], told: NDArray[np.bool_]) -> Iterator[Marks | None]:
    """For each beat the marks of the next in which the wheel goes on: those after it, or of the second after it (duplex)."""
    for i in range(1, len(marks)):
        second = marks[i + 1] if told[i] and i + 1 < len(marks) else None
        yield marks[i] or second
