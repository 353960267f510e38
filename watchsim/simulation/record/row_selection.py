"""Which rows and events stay when the buffers are emptied?

Those within the windows asked for, and where a recording has a tail, those of the last seconds of the run, whenever it ends.
Of rows also the one before and the one after each of these stretches, so that the motion is known up to its very ends, however
short it is.

Parts about which nothing is open any more are put behind each other, and may go to files (see storage/columns.py).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.recording import ALL, STATISTICS, WHOLE_RUN, Recording, Window
from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.storage.columns import Columns

Array = NDArray[np.float64]
Bits = NDArray[np.bool_]
Events = NDArray[Any]

USUAL_WINDOW = 2.0  # s, over which headline numbers are averaged
USUAL_PERIODS = 8  # where that is longer
MORE_PERIODS = 4  # what the first of these half swings needs from before


class Kept:
    """Rows and events flushed so far, in parts; `tail` is in seconds.

    `told` makes t, q, u, a of rows, and `events_told` events as they are to be kept.
    """

    def __init__(
        self,
        recording: Recording,
        tail: float,
        told: Callable[[Array], Sequence[Array]] | None = None,
        events_told: Callable[[Events], Events] | None = None,
    ) -> None:
        self.recording, self.tail = recording, tail
        self._told = told or columns_of
        self._events_told = events_told or (lambda events: events)
        self._done, self._done_events = Columns(), Columns()  # what stays of earlier parts
        self._ends: list[tuple[int, int]] = []  # how many rows and events that are, after each of them
        self._rows: list[tuple[Array, Bits]] = []  # of later parts, with those that stay for good
        self._events: list[tuple[Events, Bits]] = []
        self._met = 0  # rows met within the windows
        # Is given events and t, q, u, a of rows as soon as they are settled, in order.
        self.follow: Callable[[Events, Sequence[Array]], object] | None = None
        self._last = (0, np.nan, True)  # the last row met: part, time (s), whether within a window

    def stream(self, folder: Path) -> None:
        """From now on hold rows and events in files in `folder` where they are many."""
        self._done.folder = self._done_events.folder = folder

    @property
    def windows(self) -> tuple[Window, ...]:
        """The times for which the loop must hand over rows."""
        return WHOLE_RUN if self.recording.has_tail else self.recording.row_windows

    @property
    def parts(self) -> int:
        """How often something was flushed."""
        return len(self._ends) + len(self._rows)

    def unfinished(self) -> dict[str, NDArray[Any]]:
        """What decides about the rows that come next: how many were met, when the last one was, and itself where it waits."""
        part, time, inside = self._last
        waiting = part - len(self._ends)
        rows, stays = self._rows[waiting] if 0 <= waiting < len(self._rows) else (np.zeros((0, 0)), np.zeros(0, bool))
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

    def flush(self, rows: Array, events: Events) -> None:
        """Keep copies of what is wanted of the next rows and events, and forget earlier ones that were only of the tail."""
        row_stays, event_stays = self._stays(rows[:, 0]), np.ones(len(events), bool)
        if self.recording.keep == STATISTICS:
            event_stays = within(events["t"], self.recording.windows)
        if self.recording.keep == ALL:
            # What comes next decides about the last row.
            waits = row_stays | (np.arange(len(rows)) == len(rows) - 1)
            rows, row_stays = rows[waits], row_stays[waits]
        else:
            rows = rows.copy()
        self._rows.append((rows, row_stays))
        self._events.append((events.copy(), event_stays))
        while self._is_decided():
            self._finish()

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
                self._rows[part - len(self._ends)][1][-1] = True
            self._last = self.parts, float(times[-1]), bool(inside[-1])
        return stays

    def _is_decided(self) -> bool:
        """Whether nothing that comes can make another row or event of the earliest open part stay."""
        if len(self._rows) < 2:
            return False
        if not self.recording.has_tail:
            return len(self._ends) < self._last[0]
        before = self._last[1] - self.tail
        for rows, _ in self._rows[:2]:
            if not len(rows) or rows[-1, 0] >= before:
                return False
        return bool(np.max(self._events[0][0]["t"], initial=-np.inf) < before)

    def _finish(self) -> None:
        """Leave only what stays for good of the earliest open part."""
        rows, row_stays = self._rows.pop(0)
        events, event_stays = self._events.pop(0)
        told = self._told(rows if row_stays.all() else rows[row_stays])
        settled = self._events_told(events[event_stays])
        if row_stays.any():
            self._done.append(told)
        if event_stays.any():
            self._done_events.append([settled])
        if self.follow is not None and (row_stays.any() or event_stays.any()):
            self.follow(settled, told)
        self._ends.append((self._done.rows, self._done_events.rows))

    def for_good(self, end: float, parts: int) -> Bits:
        """Which of the rows of the first `parts` flushes that `closed` gives stay however long the run goes on."""
        done, waiting = self._parted(parts)
        stays = _joined_bits([bits for _, bits in self._rows[:waiting]])
        return np.append(np.ones(done[0], bool), stays[self._chosen(end)[: len(stays)]])

    def counts(self, end: float, parts: int) -> tuple[int, int]:
        """How many of the rows and events that `closed` gives are of the first `parts` flushes."""
        done, waiting = self._parted(parts)
        rows = self._chosen(end)[: sum(len(rows) for rows, _ in self._rows[:waiting])]
        events = sum(int(bits.sum()) for bits in self._chosen_events(end)[:waiting])
        return done[0] + int(rows.sum()), done[1] + events

    def _parted(self, parts: int) -> tuple[tuple[int, int], int]:
        """How many rows and events are done of the first `parts` flushes, and how many of these are open."""
        done = min(parts, len(self._ends))
        return (self._ends[done - 1] if done else (0, 0)), parts - done

    def closed(self, end: float) -> tuple[Sequence[Array], Events] | None:
        """All that is kept of a run that ends at `end` (s): t, q, u, a, and events; None for nothing."""
        if not self._rows:
            return None
        rows = np.concatenate([rows for rows, _ in self._rows])[self._chosen(end)]
        events = [part[bits] for (part, _), bits in zip(self._events, self._chosen_events(end), strict=True)]
        told = self._events_told(np.concatenate(events))
        return self._done.all([self._told(rows)]), self._done_events.all([[told]])[0]

    def _chosen(self, end: float) -> Bits:
        """Which rows of the open parts are kept of a run that ends now."""
        since = self._since(end)
        times = np.concatenate([np.zeros(0), *(rows[:, 0] for rows, _ in self._rows)])
        stays = _joined_bits([bits for _, bits in self._rows])
        first = int(np.searchsorted(times, since))
        stays[first:] = True
        if 0 < first < len(times) and times[first] > since:
            stays[first - 1] = True
        return stays

    def _chosen_events(self, end: float) -> list[Bits]:
        """The same of events, part by part."""
        since = self._since(end)
        return [stays | (part["t"] >= since) for part, stays in self._events]

    def _since(self, end: float) -> float:
        """The time (s) from which all is kept."""
        return end - self.tail if self.recording.has_tail else np.inf

    def spans(self, end: float) -> tuple[Window, ...]:
        """The stretches of time whose rows are kept."""
        ends = [(max(start, 0.0), min(stop, end)) for start, stop in self.recording.row_windows]
        if self.recording.has_tail:
            ends.append((max(0.0, end - self.tail), end))
        return tuple((start, stop) for start, stop in _joined(ends) if start < stop)


def columns_of(rows: Array) -> Sequence[Array]:
    """t, q, u, a of rows."""
    n = (rows.shape[1] - 1) // 3
    return rows[:, 0], rows[:, 1 : 1 + n], rows[:, 1 + n : 1 + 2 * n], rows[:, 1 + 2 * n :]


def _joined_bits(parts: list[Bits]) -> Bits:
    return np.concatenate([np.zeros(0, bool), *parts])


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
