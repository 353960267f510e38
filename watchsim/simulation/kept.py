"""Which rows and events stay when the buffers are emptied?

Those within the windows asked for, and where a recording has a tail, those of the last seconds of the run, whenever it ends.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.recording import ALL, STATISTICS, WHOLE_RUN, Recording, Window

Array = NDArray[np.float64]
Bits = NDArray[np.bool_]

USUAL_WINDOW = 2.0  # s, over which headline numbers are averaged
USUAL_PERIODS = 8  # where that is longer
MORE_PERIODS = 4  # what the first of these half swings needs from before


class Kept:
    """Rows and events flushed so far, in parts; `tail` is in seconds."""

    def __init__(self, recording: Recording, tail: float) -> None:
        self.recording, self.tail = recording, tail
        self._rows: list[tuple[Array, Bits]] = []  # with those that stay for good
        self._events: list[tuple[NDArray[Any], Bits]] = []
        self._trimmed = 0  # parts that hold nothing of the tail any more
        self._met = 0  # rows met within the windows

    @property
    def windows(self) -> tuple[Window, ...]:
        """The times for which the loop must hand over rows."""
        return WHOLE_RUN if self.recording.has_tail else self.recording.row_windows

    @property
    def parts(self) -> int:
        """How often something was flushed."""
        return len(self._rows)

    def flush(self, rows: Array, events: NDArray[Any]) -> None:
        """Keep copies of what is wanted of the next rows and events, and forget earlier ones that were only of the tail."""
        row_stays, event_stays = self._stays(rows), np.ones(len(events), bool)
        if self.recording.keep == STATISTICS:
            event_stays = _within(events["t"], self.recording.windows)
        if self.recording.keep == ALL:
            rows, row_stays = rows[row_stays], row_stays[row_stays]
        self._rows.append((rows.copy(), row_stays))
        self._events.append((events.copy(), event_stays))
        if self.recording.has_tail and len(rows):
            self._forget(float(rows[-1, 0]) - self.tail)

    def _stays(self, rows: Array) -> Bits:
        """Rows within the windows, each so many-th."""
        inside = _within(rows[:, 0], self.recording.row_windows)
        if self.recording.stride > 1:
            number = self._met + np.cumsum(inside) - 1
            self._met += int(inside.sum())
            inside &= number % self.recording.stride == 0
        return inside

    def _forget(self, before: float) -> None:
        """Leave only what stays for good of the parts that lie before that time (s)."""
        while self._trimmed < len(self._rows):
            rows, events = self._rows[self._trimmed][0], self._events[self._trimmed][0]
            if max(np.max(rows[:, 0], initial=-np.inf), np.max(events["t"], initial=-np.inf)) >= before:
                return
            for kept in (self._rows, self._events):
                part, stays = kept[self._trimmed]
                kept[self._trimmed] = part[stays], stays[stays]
            self._trimmed += 1

    def closed(self, end: float, parts: int | None = None) -> tuple[Array | None, NDArray[Any] | None]:
        """All that is kept of a run that ends at `end` (s), from the first `parts` flushes (default all); None for nothing."""
        since = end - self.tail if self.recording.has_tail else np.inf
        rows = [part[stays | (part[:, 0] >= since)] for part, stays in self._rows[:parts]]
        events = [part[stays | (part["t"] >= since)] for part, stays in self._events[:parts]]
        return np.concatenate(rows) if rows else None, np.concatenate(events) if events else None

    def spans(self, end: float) -> tuple[Window, ...]:
        """The stretches of time whose rows are kept."""
        ends = [(max(start, 0.0), min(stop, end)) for start, stop in self.recording.row_windows]
        if self.recording.has_tail:
            ends.append((max(0.0, end - self.tail), end))
        return tuple((start, stop) for start, stop in _joined(ends) if start < stop)


def _within(times: Array, windows: tuple[Window, ...]) -> Bits:
    inside = np.zeros(len(times), bool)
    for start, end in windows:
        inside |= (times >= start) & (times <= end)
    return inside


def _joined(spans: list[Window]) -> list[Window]:
    """The same, in order, overlapping ones made one."""
    out: list[Window] = []
    for start, end in sorted(spans):
        if out and start <= out[-1][1]:
            out[-1] = out[-1][0], max(end, out[-1][1])
        else:
            out.append((start, end))
    return out


def tail_length(hertz: float | None) -> float:
    """How much of the end of a run is kept, s: all that its headline numbers need."""
    period = 1.0 / hertz if hertz else 0.0
    return max(USUAL_WINDOW, USUAL_PERIODS * period) + MORE_PERIODS * period
