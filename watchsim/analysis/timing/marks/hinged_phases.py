"""What are the phases of the beats of two pallets that are hinged on the oscillator? (See `phases`.)

A grasshopper has no lock and no drop: a tooth stays with its pallet until the other pallet has caught another tooth. The wheel
turns back until the oscillator turns (recoil) and then pushes by the same pallet, until the other one catches and lets the
first go (impulse).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.body_contacts import between, contact_columns
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.marks.stretches import Stretch, Stretches, gathered
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Trajectory

TOUCH = (EventKind.IMPACT, EventKind.CLOSE)


def hinged_phases(
    run: Trajectory, wheel: str, pallets: Sequence[str], found: Beats, within: NDArray[np.bool_], size: int
) -> Iterator[Stretches]:
    """Those of `size` beats at a time: of the beats `within`."""
    return gathered(_beats(run, wheel, pallets, found, within), size)


def _beats(
    run: Trajectory, wheel: str, pallets: Sequence[str], found: Beats, within: NDArray[np.bool_]
) -> Iterator[list[Stretch]]:
    """The impulse of each half swing and the recoil that follows.

    An impulse is on the pallet that caught its tooth last, the recoil on the one that catches then. A half swing has no rows
    where the wheel only recoils, or where the next one was not recorded.
    """
    times, which = _catches(run, wheel, pallets)
    needed = within | np.append(False, within[:-1])  # the recoil ends with the next half swing's impulse
    told = needed & is_recorded(run, found.start) & is_recorded(run, found.end)
    spans = zip(found.start.tolist(), found.end.tolist(), strict=True)
    marks = [_marks(run, wheel, span) if known else None for known, span in zip(told, spans, strict=True)]
    for i, (own, after) in enumerate(pairwise(marks)):
        if own is None or after is None or not within[i]:
            continue
        back, caught = own
        before, now = np.searchsorted(times, own, side="right").tolist()
        if before in (0, now) or which[now - 1] == which[before - 1]:
            continue  # no pallet has taken over from the other
        beat = found.before + i + 1
        yield [
            Stretch(beat, "impulse", back, caught, pallets[which[before - 1]]),
            Stretch(beat, "recoil", caught, after[0], pallets[which[now - 1]]),
        ]


def _catches(run: Trajectory, wheel: str, pallets: Sequence[str]) -> tuple[Array, NDArray[np.int64]]:
    """When a tooth met a pallet, and the number of the pallet."""
    own = [contact_columns(run, between(wheel, {name}), ["t"], *TOUCH)[0] for name in pallets]
    times = np.concatenate(own)
    which = np.repeat(np.arange(len(own)), [len(one) for one in own])
    order = np.argsort(times, kind="stable")
    return times[order], which[order]


def _marks(run: Trajectory, wheel: str, span: tuple[float, float]) -> tuple[float, float] | None:
    """When, within a half swing, the wheel stands furthest back and then furthest on, s; None where it does not go on."""
    i, j = np.searchsorted(run.t, span)
    t = np.array([span[0], *run.t[i:j], span[1]])
    angle = progress(run, wheel, t)
    furthest = int(np.argmax(angle))
    back = int(np.argmin(angle[: furthest + 1]))
    return (float(t[back]), float(t[furthest])) if furthest > back else None
