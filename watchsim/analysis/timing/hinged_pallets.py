"""When does which of two pallets that are hinged on the oscillator hold the wheel, and which way does the wheel turn?

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
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Trajectory

Row = tuple[int, str, float, float, tuple[float, float, float], tuple[float, float, float], str]

NOTHING = (0.0, 0.0, 0.0)
TOUCH = (EventKind.IMPACT, EventKind.CLOSE)


def hinged_beats(
    run: Trajectory, wheel: str, pallets: Sequence[str], found: Beats, window: Sequence[float] | None
) -> Iterator[Row]:
    """The impulse of each half swing and the recoil that follows, as rows of `Phase` without angles.

    An impulse is on the pallet that caught its tooth last, the recoil on the one that catches then. A half swing has no rows
    where the wheel only recoils, or where the next one was not recorded.
    """
    times, which = _catches(run, wheel, pallets)
    whole = is_recorded(run, found.start) & is_recorded(run, found.end)
    spans = zip(found.start.tolist(), found.end.tolist(), strict=True)
    marks = [_marks(run, wheel, span) if known else None for known, span in zip(whole, spans, strict=True)]
    for i, (own, after) in enumerate(pairwise(marks)):
        if own is None or after is None or not _near(found, i, window):
            continue
        back, caught = own
        k = int(np.searchsorted(times, caught, side="right"))
        before = int(np.searchsorted(times, back, side="right"))
        if before in (0, k) or which[k - 1] == which[before - 1]:
            continue  # no pallet has taken over from the other
        beat = found.before + i + 1
        yield beat, "impulse", back, caught, NOTHING, NOTHING, pallets[which[before - 1]]
        yield beat, "recoil", caught, after[0], NOTHING, NOTHING, pallets[which[k - 1]]


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


def _near(found: Beats, i: int, window: Sequence[float] | None) -> bool:
    return window is None or bool(found.end[i] >= window[0] and found.start[i] <= window[1])
