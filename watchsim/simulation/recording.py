"""Which rows and events stay when the buffers are emptied?

Those within the windows requested, and where a recording has a tail, those of the last seconds of the run, whenever it ends.
Of rows also the one before and the one after each of these stretches, so that the motion is known up to its very ends, however
short it is.

Parts about which nothing is open any more are put behind each other, and may go to files (see storage/columns.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias, Union, overload

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.model import KIND_WORD
from watchsim.scene.scene import ALL, STATISTICS, WHOLE_RUN, Recording, Window
from watchsim.simulation.state import EVENT_DTYPE
from watchsim.storage.columns import Columns

# What are the contacts of a run called, for people?
#
# A pair is put into words when it is looked at: a run may declare millions, and has events at a few of them.


@dataclass(frozen=True)
class Pair:
    """The two primitives of a contact, for people: bodies, layers, a word for each primitive and its index in the body."""

    group: int  # index in scene.contacts
    body_a: str
    primitive_a: str  # "corner", "arc", "line"
    index_a: int
    layer_a: str
    body_b: str
    primitive_b: str
    index_b: int
    layer_b: str

    def __str__(self) -> str:
        return (
            f"{self.body_a}.{self.layer_a} {self.primitive_a} {self.index_a} / "
            f"{self.body_b}.{self.layer_b} {self.primitive_b} {self.index_b}"
        )


Named = tuple[str, str, int, str]  # one primitive: body, word, index and layer, as in `Pair`


class Pairs(Sequence[Pair]):
    """All contacts of a run; read like a tuple of `Pair`, and equal to one with the same pairs.

    `names` are the primitives; row k of `table` holds group, number of the one primitive and of the other of contact k.
    """

    def __init__(self, names: Sequence[Named], table: NDArray[np.int32]) -> None:
        self.names, self.table = tuple(names), table
        self.table.flags.writeable = False

    def __len__(self) -> int:
        return len(self.table)

    @overload
    def __getitem__(self, index: int) -> Pair: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Pair, ...]: ...
    def __getitem__(self, index: int | slice) -> Pair | tuple[Pair, ...]:
        if isinstance(index, slice):
            return tuple(self._made(self.table[index]))
        group, a, b = self.table[index].tolist()
        return Pair(group, *self.names[a], *self.names[b])

    def __iter__(self) -> Iterator[Pair]:
        return self._made(self.table)

    def _made(self, table: NDArray[np.int32]) -> Iterator[Pair]:
        # Plain numbers, some at a time: reading one of an array takes a tenth of a microsecond.
        for start in range(0, len(table), 4096):
            for group, a, b in table[start : start + 4096].tolist():
                yield Pair(group, *self.names[a], *self.names[b])

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Pairs) and self.names == other.names:
            return np.array_equal(self.table, other.table)
        if isinstance(other, (Pairs, tuple)):
            return len(self) == len(other) and all(one == two for one, two in zip(self, other, strict=True))
        return NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return f"<{len(self)} pairs of primitives>"

    def of_body(self, name: str) -> NDArray[np.bool_]:
        """For each pair: is that body on either side of it?"""
        own = np.array([body == name for body, *_ in self.names], bool)
        return np.asarray(own[self.table[:, 1]] | own[self.table[:, 2]])


def pairs_of(compiled: Compiled) -> Pairs:
    """The contacts of a model in words; row k belongs to contact number k."""
    model, owners = compiled.model, compiled.owners
    first = {name: owners.index(name) for name in dict.fromkeys(owners)}
    # A plain list: reading a field of a record array takes a microsecond each time.
    kinds = model.primitives.kind.tolist()
    sides = zip(owners, kinds, compiled.layers, strict=True)
    names = [(owner, KIND_WORD[kind], i - first[owner], layer) for i, (owner, kind, layer) in enumerate(sides)]
    contacts = model.contacts
    table = np.empty((len(contacts), 3), np.int32)
    table[:, 0], table[:, 1], table[:, 2] = contacts.group, contacts.a, contacts.b
    return Pairs(names, table)


def as_pairs(pairs: Sequence[Pair]) -> Pairs:
    """The same pairs, however they are kept."""
    if isinstance(pairs, Pairs):
        return pairs
    numbers: dict[Named, int] = {}
    rows: list[tuple[int, ...]] = []
    for pair in pairs:
        first = (pair.body_a, pair.primitive_a, pair.index_a, pair.layer_a)
        second = (pair.body_b, pair.primitive_b, pair.index_b, pair.layer_b)
        rows.append((pair.group, *(numbers.setdefault(side, len(numbers)) for side in (first, second))))
    return Pairs(list(numbers), np.array(rows, np.int32).reshape(-1, 3))


# Which events of an oscillator make a half swing, and which noises a beat?
#
# A half swing goes from one turning point through the rest position to the next.

Indices = NDArray[np.int64]
Array = NDArray[np.float64]
Events = NDArray[Any]

FEWEST_TURNS = 3
LONGEST_STEP = 0.26  # periods: within a window rows are never further apart than a quarter of a swing
STILL = 1e-13  # rad or m: half swings no larger are rounding, of a body at rest
QUIET = 0.1  # of half a period: so long the oscillator must have touched nothing before its first noise
AT_THE_TURN = 1e-6  # of half a period: a noise this soon after a turning point is one of the stop that made it turn


def half_swings(crossings: Events, turns: Events) -> tuple[Indices, Indices, Indices]:
    """Rows of the passages that have a turning point on both sides, and the rows of these turning points.

    An oscillator that knocks turns more than once between two passages: of these turning points the outermost counts.
    """
    nothing = np.zeros(0, np.int64)
    if len(turns) < FEWEST_TURNS or len(crossings) == 0:
        return nothing, nothing, nothing
    heading = np.sign(crossings["value"])
    side = np.concatenate([-heading[:1], heading])  # on which side of the rest position it is before the first passage, ...
    interval = np.searchsorted(crossings["t"], turns["t"], side="right")
    outermost = np.full(len(side), -1)
    reach = side[interval] * turns["value"]
    for i, k in enumerate(interval):
        if outermost[k] < 0 or reach[i] > reach[outermost[k]]:
            outermost[k] = i
    complete = np.flatnonzero((outermost[:-1] >= 0) & (outermost[1:] >= 0))
    return complete, outermost[complete], outermost[complete + 1]


def first_noises(noises: Array, starts: Array, ends: Array, half_period: float) -> Array:
    """For each half swing from `starts` to `ends` (s), the time of the first of the noises (s) after a silence; else nan.

    What rings on from the half swing before (a knock at the turning point) is not silence and is passed over. A stop that turns
    the oscillator back is heard at the turning point, by rounding a little before it or after: it belongs to what it ends.
    """
    turn = AT_THE_TURN * half_period
    first_of_burst = noises[np.diff(noises, prepend=-np.inf) >= QUIET * half_period]
    place = np.searchsorted(first_of_burst, starts + turn, side="right")
    found = np.append(first_of_burst, np.inf)[place]
    return np.where(found < ends + turn, found, np.nan)


def since_two_before(times: Array) -> Array:
    """From each time to the one two before it; nan for the first two."""
    earlier: Array = np.concatenate([np.full(2, np.nan), times])[: len(times)]
    return times - earlier


def unevenness(marks: Array) -> Array:
    """By how much the half period that ends with each mark differs from the one before it, s; nan for the first two."""
    return np.diff(np.diff(marks, prepend=np.nan), prepend=np.nan)


Bits = NDArray[np.bool_]


class RowsToMake:
    """Rows at these times that `make` makes, of their numbers, when they are read: few of those that were met are kept."""

    def __init__(self, times: Array, make: Callable[[Indices], Array], numbers: Indices | None = None) -> None:
        self.times, self.make = times, make
        self.numbers = np.arange(len(times)) if numbers is None else numbers

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, which: Any) -> RowsToMake:
        return RowsToMake(self.times[which], self.make, self.numbers[which])


Rows: TypeAlias = Union[Array, RowsToMake]  # noqa: UP007 - an alias is evaluated, in Python 3.10, too


def row_times(rows: Rows) -> Array:
    return rows.times if isinstance(rows, RowsToMake) else rows[:, 0]


def made_rows(rows: Rows) -> Array:
    return rows.make(rows.numbers) if isinstance(rows, RowsToMake) else rows


USUAL_WINDOW = 2.0  # s, over which headline numbers are averaged
USUAL_PERIODS = 8  # where that is longer
MORE_PERIODS = 4  # what the first of these half swings needs from before


class Recorder:
    """Rows and events flushed so far, in parts; `tail` is in seconds.

    `form` makes t, q, u, a of rows, and `event_form` makes events as they are to be kept.
    """

    def __init__(
        self,
        recording: Recording,
        tail: float,
        form: Callable[[Array], Sequence[Array]] | None = None,
        event_form: Callable[[Events], Events] | None = None,
    ) -> None:
        self.recording, self.tail = recording, tail
        self._form = form or columns_of
        self._event_form = event_form or (lambda events: events)
        self._done, self._done_events = Columns(), Columns()  # what stays of earlier parts
        self._ends: list[tuple[int, int]] = []  # how many rows and events that are, after each of them
        self._rows: list[tuple[Rows, Bits]] = []  # of later parts, with those that stay for good
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
            "row": made_rows(rows[-1:])[0].copy() if waits else np.zeros(0),
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

    def flush(self, rows: Rows, events: Events) -> None:
        """Keep copies of what is wanted of the next rows and events, and forget earlier ones that were only of the tail."""
        row_stays, event_stays = self._stays(row_times(rows)), np.ones(len(events), bool)
        if self.recording.keep == STATISTICS:
            event_stays = within(events["t"], self.recording.windows)
        if self.recording.keep == ALL:
            # What comes next decides about the last row.
            waits = row_stays | (np.arange(len(rows)) == len(rows) - 1)
            rows, row_stays = rows[waits], row_stays[waits]
        elif not isinstance(rows, RowsToMake):
            rows = rows.copy()
        self._rows.append((rows, row_stays))
        self._events.append((events.copy(), event_stays))
        while self._is_decided():
            self._finish()

    def _stays(self, times: Array) -> Bits:
        """Rows within the windows, every n-th, and those next to a window."""
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
            if not len(rows) or row_times(rows)[-1] >= before:
                return False
        return bool(np.max(self._events[0][0]["t"], initial=-np.inf) < before)

    def _finish(self) -> None:
        """Leave only what stays for good of the earliest open part."""
        rows, row_stays = self._rows.pop(0)
        events, event_stays = self._events.pop(0)
        formed = self._form(made_rows(rows if row_stays.all() else rows[row_stays]))
        settled = self._event_form(events[event_stays])
        if row_stays.any():
            self._done.append(formed)
        if event_stays.any():
            self._done_events.append([settled])
        if self.follow is not None and (row_stays.any() or event_stays.any()):
            self.follow(settled, formed)
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
        ends = np.cumsum([len(rows) for rows, _ in self._rows])[:-1]
        parts = zip(self._rows, np.split(self._chosen(end), ends), strict=True)
        rows = [self._form(made_rows(rows[bits])) for (rows, _), bits in parts]
        events = [part[bits] for (part, _), bits in zip(self._events, self._chosen_events(end), strict=True)]
        return self._done.all(rows), self._done_events.all([[self._event_form(np.concatenate(events))]])[0]

    def _chosen(self, end: float) -> Bits:
        """Which rows of the open parts are kept of a run that ends now."""
        since = self._since(end)
        times = np.concatenate([np.zeros(0), *(row_times(rows) for rows, _ in self._rows)])
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
