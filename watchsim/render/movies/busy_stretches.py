"""In which stretches of a run do things happen, so that they are worth showing slowly?"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.render.frame.pose_history import Window
from watchsim.simulation.record.trajectory import Array, EventKind, Trajectory
from watchsim.storage.columns import rows_where

TOLD = (EventKind.IMPACT, EventKind.CLOSE, EventKind.OPEN, EventKind.JAM, EventKind.ACCUMULATION)  # slow where these happen
AROUND = 0.004  # of the window: what is slow around an event where no phases are known
MERGED = 2.0  # times that: quiet stretches so short are not worth a hurry
LASTING = ("locked",)  # phases in which nothing happens


def busy(run: Trajectory, found: list[Phase], window: Window) -> list[Window]:
    """Stretches in which things happen: from unlocking to the banking where phases are known, else around every event."""
    lively = [(phase.start, phase.end) for phase in _lively(found, window)]
    if lively:
        longest = max(end - start for start, end in lively)
        spans = np.array([(start - 0.1 * longest, end + 0.1 * longest) for start, end in lively])
        return list(_merged(spans, longest, window))
    told = rows_where(
        run.events, lambda part: np.isin(part["kind"], TOLD) & (part["t"] >= window[0]) & (part["t"] <= window[1])
    )
    times = np.unique(told["t"])
    around = AROUND * (window[1] - window[0])
    return list(_merged(np.column_stack((times - around, times + around)), MERGED * around, window))


def _lively(found: list[Phase], window: Window) -> list[Phase]:
    """The phases within the window in which something happens."""
    return [one for one in found if one.name not in LASTING and one.end > window[0] and one.start < window[1]]


def _merged(spans: Array, gap: float, window: Window) -> Iterator[Window]:
    """The spans in order, united where no more than `gap` (s) lies between them, cut to the window."""
    last: list[float] | None = None
    for start, end in sorted(map(tuple, spans.tolist())):
        if last is not None and start <= last[1] + gap:
            last[1] = max(last[1], end)
            continue
        if last is not None:
            yield max(last[0], window[0]), min(last[1], window[1])
        last = [start, end]
    if last is not None:
        yield max(last[0], window[0]), min(last[1], window[1])
