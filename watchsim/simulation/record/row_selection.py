"""Which rows and events stay when the buffers are emptied?

Those within the windows asked for, and where a recording has a tail, those of the last seconds of the run, whenever it ends.
Of rows also the one before and the one after each of these stretches, so that the motion is known up to its very ends, however
short it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.recording import ALL, STATISTICS, WHOLE_RUN, Recording, Window
from watchsim.simulation.event_kinds import EVENT_DTYPE

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
        self._gone = 0  # earlier parts of which nothing stayed
        self._met = 0  # rows met within the windows
        self._last = (0, np.nan, True)  # the last row met: part, time (s), whether within a window

    @property
    def windows(self) -> tuple[Window, ...]:
        """The times for which the loop must hand over rows."""
        return WHOLE_RUN if self.recording.has_tail else self.recording.row_windows

    @property
    def parts(self) -> int:
        """How often something was flushed."""
        return self._gone + len(self._rows)

    def unfinished(self) -> dict[str, NDArray[Any]]:
        """What decides about the rows that come next: how many were met, when the last one was, and itself where it waits."""
        part, time, inside = self._last
        rows, stays = (
            self._rows[part - self._gone] if self.parts > part >= self._gone else (np.zeros((0, 0)), np.zeros(0, bool))
        )
        waits = len(rows) > 0 and not stays[-1]
        return {
            "met": np.array(self._met),
            "last": np.array([time, float(inside)]),
            "row": rows[-1].copy() if waits else np.zeros(0),
        }

    def go_on(self, unfinished: Mapping[str, NDArray[Any]]) -> None:
        """Decide about the next rows as if they followed on those before; nothing is known of them where it is empty."""
        if not unfinished:
            return
        self._met = int(unfinished["met"])
        time, inside = unfinished["last"].tolist()
        self._last = 0, time, bool(inside)
        row = unfinished["row"]
        if len(row):
            self._rows.append((row[None].copy(), np.zeros(1, bool)))
            self._events.append((np.zeros(0, EVENT_DTYPE), np.zeros(0, bool)))
        else:
            self._last = 0, time, True

    def flush(self, rows: Array, events: NDArray[Any]) -> None:
        """Keep copies of what is wanted of the next rows and events, and forget earlier ones that were only of the tail."""
        row_stays, event_stays = self._stays(rows[:, 0]), np.ones(len(events), bool)
        if self.recording.keep == STATISTICS:
            event_stays = within(events["t"], self.recording.windows)
        if self.recording.keep == ALL:
            # What comes next decides about the last row.
            waits = row_stays | (np.arange(len(rows)) == len(rows) - 1)
            rows, row_stays = rows[waits], row_stays[waits]
        self._rows.append((rows.copy(), row_stays))
        self._events.append((events.copy(), event_stays))
        if self.recording.has_tail and len(rows):
            self._forget(float(rows[-1, 0]) - self.tail)

    def _stays(self, times: Array) -> Bits:
        """Rows within the windows, each so many-th, and those next to a window."""
        windows = self.recording.row_windows
        inside = within(times, windows)
        stays = inside.copy()
        if self.recording.stride > 1:
            number = self._met + np.cumsum(inside) - 1
            self._met += int(inside.sum())
            stays &= number % self.recording.stride == 0
        if len(times):
            part, last, last_inside = self._last
            across = _across(np.append(last, times), windows)
            stays |= ~inside & (across | np.append(across[1:], False))
            if across[0] and not last_inside:
                self._rows[part - self._gone][1][-1] = True
            self._last = self.parts, float(times[-1]), bool(inside[-1])
        return stays

    def _forget(self, before: float) -> None:
        """Leave only what stays for good of the parts that lie before that time (s), but for the last of them."""
        while self._trimmed + 1 < len(self._rows):
            for rows, _ in self._rows[self._trimmed : self._trimmed + 2]:
                if not len(rows) or rows[-1, 0] >= before:
                    return
            if np.max(self._events[self._trimmed][0]["t"], initial=-np.inf) >= before:
                return
            stayed = 0
            for kept in (self._rows, self._events):
                part, stays = kept[self._trimmed]
                kept[self._trimmed] = part[stays], stays[stays]
                stayed += int(stays.sum())
            if stayed:
                self._trimmed += 1
            else:
                del self._rows[self._trimmed], self._events[self._trimmed]
                self._gone += 1

    def for_good(self, end: float, parts: int) -> Bits:
        """Which of the rows that `closed` gives stay however long the run goes on."""
        count = max(parts - self._gone, 0)
        if not self._rows[:count]:
            return np.zeros(0, bool)
        stays = np.concatenate([bits for _, bits in self._rows])
        return stays[self._chosen(end, count)]

    def closed(self, end: float, parts: int | None = None) -> tuple[Array | None, NDArray[Any] | None]:
        """All that is kept of a run that ends at `end` (s), from the first `parts` flushes (default all); None for nothing."""
        since = end - self.tail if self.recording.has_tail else np.inf
        parts = None if parts is None else max(parts - self._gone, 0)
        if not self._rows[:parts]:
            return None, None
        rows = np.concatenate([rows for rows, _ in self._rows])
        events = [part[stays | (part["t"] >= since)] for part, stays in self._events[:parts]]
        return rows[self._chosen(end, parts)], np.concatenate(events)

    def _chosen(self, end: float, parts: int | None) -> Bits:
        """Which of all rows `closed` gives."""
        since = end - self.tail if self.recording.has_tail else np.inf
        times = np.concatenate([rows[:, 0] for rows, _ in self._rows])
        stays = np.concatenate([bits for _, bits in self._rows])
        first = int(np.searchsorted(times, since))
        stays[first:] = True
        if 0 < first < len(times) and times[first] > since:
            stays[first - 1] = True
        stays[sum(len(part) for part, _ in self._rows[:parts]) :] = False
        return stays

    def spans(self, end: float) -> tuple[Window, ...]:
        """The stretches of time whose rows are kept."""
        ends = [(max(start, 0.0), min(stop, end)) for start, stop in self.recording.row_windows]
        if self.recording.has_tail:
            ends.append((max(0.0, end - self.tail), end))
        return tuple((start, stop) for start, stop in _joined(ends) if start < stop)


def stretch_rows(times: Array, spans: tuple[Window, ...]) -> Bits:
    """Which rows lie within one of the stretches or next to it."""
    if len(times) == 0:
        return np.zeros(0, bool)
    across = _across(times, spans)
    return within(times, spans) | np.append(across, False) | np.append(False, across)


def _across(times: Array, windows: tuple[Window, ...]) -> Bits:
    """(len(times) - 1,): whether some of a window lies between one row and the next."""
    across = np.zeros(len(times) - 1, bool)
    for start, end in windows:
        across |= (times[:-1] < end) & (times[1:] > start)
    return across


def within(times: Array, windows: tuple[Window, ...]) -> Bits:
    """Which times lie within one of the windows."""
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
