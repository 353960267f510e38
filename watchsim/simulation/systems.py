"""Which parts of a scene cannot influence each other, and how are they simulated side by side?

Bodies that a declared contact, a force, gears or a carrier join are one system, and so is what they are joined to in turn. What
rests in the movement joins nothing. Each system is a scene of its own, with steps and events of its own, to the last bit those
of a run of it alone; their rows and events are merged in time. A row of the whole is one of some system; where the others
stand then is read from the interpolation of their own rows (see `trajectory.between`), when they have come so far and the row
is kept. Overlaps are looked for in the rows of each system, in blocks of equal length, since when rows are merged follows the
clock on the wall.
"""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled, compiled_anew
from watchsim.mechanism.overlap import overlap_faults
from watchsim.mechanism.play import loose
from watchsim.model import frozen, words_of
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Recording, Scene
from watchsim.simulation.merged_rows import merge_rows
from watchsim.simulation.overlap_watch import NO_OVERLAP
from watchsim.simulation.recording import RowsToMake
from watchsim.simulation.runner import ROWS, SLICE_WALL, Run, widened
from watchsim.simulation.saved_state import AHEAD, SavedState
from watchsim.simulation.scratch import Until, new_until
from watchsim.simulation.state import EVENT_DTYPE, Stop, arrays_of
from watchsim.tolerances import ROW_NOISE

# Which bodies can influence each other?

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Events = NDArray[Any]


def _ties(scene: Scene) -> Iterator[tuple[str, ...]]:
    """Names of bodies that something joins, two at a time."""
    for body in scene.bodies:
        yield from ((body.name, other) for other in (body.on, body.geared and body.geared.to) if other)
    for forces in (scene.springs, scene.torques, scene.damping):
        yield from ((one.body, one.against) for one in forces if one.against)
    for gear in (*scene.gears, *scene.rigid_gears):
        yield gear.between
    yield from (tuple(filter(None, spring.between)) for spring in scene.line_springs)
    yield from (tuple(side.body for side in contact.sides) for contact in scene.contacts)


def systems_of(scene: Scene) -> tuple[Scene, ...]:
    """The independent systems of a scene, in the order of their first bodies, each as a scene; the scene itself where it is
    one. With each system go the resting bodies that it touches."""
    moves = {body.name for body in scene.bodies if body.motion != "fixed" or body.on is not None}
    label, ties = {name: name for name in moves}, list(_ties(scene))
    for tie in ties:
        joined = [label[name] for name in tie if name in moves]
        if len(set(joined)) > 1:
            label = {name: joined[0] if own in joined else own for name, own in label.items()}
    groups = dict.fromkeys(label[body.name] for body in scene.bodies if body.name in moves)
    if len(groups) < 2:
        return (scene,)
    return tuple(_part(scene, {name for name in moves if label[name] == group}, ties) for group in groups)


def _part(scene: Scene, own: set[str], ties: list[tuple[str, ...]]) -> Scene:
    """The system of these moving bodies."""
    everyone = own.union(*(tie for tie in ties if own & {*tie}))
    parts: dict[str, Any] = {name: tuple(one for one in getattr(scene, name) if own & {*_ends(one)}) for name in JOINING}
    return dataclasses.replace(
        scene,
        bodies=tuple(body for body in scene.bodies if body.name in everyone),
        expect=(),
        **parts,
    )


JOINING = ("springs", "torques", "damping", "bearings", "contacts", "gears", "rigid_gears", "line_springs")


def _ends(one: Any) -> tuple[str, ...]:
    """The bodies that a force, gears or a contact acts on."""
    if hasattr(one, "sides"):
        return tuple(side.body for side in one.sides)
    return tuple(one.between) if hasattr(one, "between") else (one.body,)


# Where do the coordinates, bodies and contacts of a system stand in the whole?


class System:
    """A system of the run `whole`: a run of its own, and the rows and events of it that wait to be merged.

    columns  of its coordinates among those of the whole
    bodies   numbers of its bodies in the whole; `contacts` the same, with -1 for none at the end
    declared the numbers of its contacts among those of the scene
    rows     in its own columns, from the last one that was merged on; `events` with the numbers of the whole
    unseen   rows in which no overlap was looked for so far
    kept     an earlier state to go back to; so many of the rows and events that wait are from `before` it, less than none where
             later ones are handed on; `skipped`: how many come a second time, after it was gone back to
    """

    def __init__(self, part: Scene, whole: Run, place: Mapping[tuple[str, str, int], int], prefilter: bool) -> None:
        """`place`: the numbers of the primitives in the whole."""
        own, compiled = compiled_anew(part, prefilter), whole.compiled
        names = [body.name for body in whole.scene.bodies]
        self.bodies = np.array([names.index(body.name) for body in part.bodies])
        ends = {name: compiled.columns(name) for name in own.slices}
        count = len(own.q)
        self.columns = np.concatenate([np.arange(ends[name].start, ends[name].stop) for name in own.slices])[:count]
        self.contacts = np.append(_numbers(part, own, whole.scene, compiled, place), -1)
        own_contacts = {id(one) for one in part.contacts}
        self.declared = np.flatnonzero([id(one) in own_contacts for one in whole.scene.contacts])
        coordinates = own.model.coordinates.copy()
        # What swings is said of the whole scene.
        coordinates.watched &= compiled.model.coordinates.watched[self.columns]
        own = dataclasses.replace(own, model=own.model._replace(coordinates=frozen(coordinates)))
        self.run = Run(part, own, whole.tolerance, whole.kept.recording)
        self.noise = ROW_NOISE * whole.tolerance * own.model.coordinates.scale
        self.rows, self.events = np.zeros((0, 1 + 3 * count)), np.zeros(0, EVENT_DTYPE)
        self.unseen = self.rows
        self.arrays = self.run.arrays()
        self.kept: dict[str, NDArray[Any]] = {}
        self.before, self.skipped = np.zeros(2, np.int64), np.zeros(2, np.int64)

    @property
    def time(self) -> float:
        """How far it has come, s."""
        return float(self.arrays["clock"][0])

    @property
    def waiting(self) -> tuple[int, int]:
        """How many rows and events wait."""
        used = self.run.record.used
        return len(self.rows) + int(used.rows), len(self.events) + int(used.events)

    def advance(self, until: Until) -> Stop:
        """Go on; a look-up of cells or a full buffer does not end it."""
        while True:
            try:
                stop = self.run._advance(until, self.run.record)
            except OverflowError:  # so far away that no cell has a number
                return Stop.FAR_AWAY
            if stop == Stop.CELL_UNKNOWN:
                self.run._learn()
            elif stop == Stop.BUFFER_FULL:
                self.take()
            else:
                return stop

    def take(self) -> None:
        """Empty the buffers."""
        used, record = self.run.record.used, self.run.record
        again = np.minimum(self.skipped, [used.rows, used.events])
        self.skipped -= again
        rows, events = record.rows[again[0] : used.rows], record.events[again[1] : used.events].copy()
        events["contact"] = self.contacts[events["contact"]]
        turns = events["body"] >= 0
        events["body"][turns] = self.bodies[events["body"][turns]]
        self.rows = np.concatenate([self.rows, rows])
        self.unseen = np.concatenate([self.unseen, rows])
        self.events = np.concatenate([self.events, events])
        used.rows, used.events = 0, 0
        while len(self.unseen) >= SEEN:
            self.run.watch.see_rows(self.unseen[:SEEN])
            self.unseen = self.unseen[SEEN:]

    def see(self) -> None:
        """Look, soon, for overlaps in all rows so far."""
        self.take()
        self.run.watch.see_rows(self.unseen)
        self.unseen = self.unseen[:0]

    def keep(self) -> None:
        """Keep what `go_back` needs."""
        self.take()
        self.kept = {name: array.copy() for name, array in self.arrays.items()}
        self.before[:] = len(self.rows), len(self.events)

    def go_back(self) -> None:
        """Go back to what was kept last. What was recorded since and is handed on already is passed over on the way."""
        self.take()
        for name, array in self.arrays.items():
            array[...] = self.kept[name]
        rows, events = np.maximum(self.before, 0)
        self.unseen = self.unseen[: max(len(self.unseen) - (len(self.rows) - rows), 0)]
        self.rows, self.events = self.rows[:rows], self.events[:events]
        self.skipped = np.maximum(-self.before, 0)

    def places(self, width: int) -> Integers:
        """(1 + 3 n,): where the columns of its rows stand in rows of the whole, which have that width."""
        n = (width - 1) // 3
        return np.concatenate([[0], *(1 + k * n + self.columns for k in range(3))])

    def stamps(self) -> NDArray[np.complex128]:
        """Of each row its time and, as imaginary part, its number within the instant."""
        t = self.rows[:, 0]
        return t + 1j * (np.arange(len(t)) - np.searchsorted(t, t))

    def events_before(self, time: float) -> Events:
        """The waiting events before that time (s), which wait no longer."""
        count = int(np.searchsorted(self.events["t"], time))
        passed, self.events = self.events[:count], self.events[count:]
        self.before[1] -= count
        return passed

    def forget(self, until: float) -> None:
        """Drop the rows before the last one that is before `until` (s)."""
        count = max(int(np.searchsorted(self.rows[:, 0], until)) - 1, 0)
        self.rows = self.rows[count:]
        self.before[0] -= count


def _numbers(
    part: Scene, own: Compiled, whole: Scene, compiled: Compiled, number: Mapping[tuple[str, str, int], int]
) -> Integers:
    """The numbers that the contacts of a system have in the whole."""
    names = {body.name for body in part.bodies if body.motion != "fixed" or body.on is not None}
    stopped = [spring for spring in whole.springs if spring.stop is not None]
    groups = np.flatnonzero(
        [bool(names & {*_ends(one)}) for one in (*whole.contacts, *loose(whole).values(), *stopped, *whole.gears)]
    )
    place = np.array([number[name] for name in _primitives(own)], np.int64)

    def keys(a: Integers, b: Integers, group: Integers) -> Integers:
        return (np.asarray(a * len(number) + b) * len(compiled.model.laws)) + group

    every, mine = compiled.model.contacts, own.model.contacts
    known = keys(every.a, every.b, every.group)
    order = np.argsort(known)
    sought = keys(place[mine.a], place[mine.b], groups[mine.group]) if len(mine) else np.zeros(0, np.int64)
    found = order[np.minimum(np.searchsorted(known, sought, sorter=order), max(len(known) - 1, 0))] if len(mine) else sought
    assert np.array_equal(known[found], sought)
    return found


def _primitives(compiled: Compiled) -> Iterator[tuple[str, str, int]]:
    """Body, layer and number within both of each primitive."""
    met: Counter[tuple[str, str]] = Counter()
    for place in zip(compiled.owners, compiled.layers, strict=True):
        yield *place, met[place]
        met[place] += 1


# How do they run side by side?

FEW = 10  # systems, with slices as long as those of one
SEEN = 2000  # rows of a system in which overlaps are looked for together


class SystemsRun(Run):
    """A run of several systems. `state` holds what they come to together."""

    def __init__(
        self,
        scene: Scene,
        parts: tuple[Scene, ...],
        compiled: Compiled,
        tolerance: float,
        recording: Recording,
        prefilter: bool = True,
    ) -> None:
        super().__init__(scene, compiled, tolerance, recording)
        place = {name: i for i, name in enumerate(_primitives(compiled))}
        self.systems = tuple(System(part, self, place, prefilter) for part in parts)
        # So wide that each has rows on both sides of every row next to a window.
        wide = np.array([widened(self.kept.windows, one.run.options, 2.0) for one in self.systems])
        windows = np.stack([wide[:, :, 0].min(axis=0), wide[:, :, 1].max(axis=0)], axis=1)
        for one in self.systems:
            one.run.record = one.run.record._replace(windows=windows)
        # What a slice costs each of them beside its steps grows with their number, and so must what it does.
        self._many = max(1.0, len(parts) / FEW)
        self.slice_wall = SLICE_WALL * self._many
        self._merged = -math.inf  # s: rows and events before that are handed on
        self._is_over = False
        self._stored = np.zeros(len(parts))  # J, at the start, of each

    @property
    def failing(self) -> Run:
        """The run that could not go on, if one could not."""
        return self._failing or self

    _failing: Run | None = None

    def begin(self) -> None:
        """Begin at the scene's start; SceneError where bodies overlap there."""
        if faults := overlap_faults(self.scene):
            raise SceneError(faults)
        for one in self.systems:
            one.run.begin()
        self._stored[:] = [one.run.stored_at_start for one in self.systems]
        self.stored_at_start = float(self._stored.sum())
        self._gather()

    def begin_from(self, saved: SavedState) -> None:
        super().begin_from(saved)
        rows, events, counts = (saved.recorded[name] for name in AHEAD)
        first = np.cumsum(counts, axis=0) - counts
        for k, one in enumerate(self.systems):
            (row, event), (more_rows, more_events) = first[k], counts[k]
            one.rows = rows[row : row + more_rows, one.places(rows.shape[1])]
            one.events = events[event : event + more_events].copy()
            one.run.stored_at_start = float(self._stored[k])
        self._gather()
        self._merged = self._recorded()

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything the future depends on: of each system, with its number before the name."""
        own = {f"{k}.{name}": array for k, one in enumerate(self.systems) for name, array in one.arrays.items()}
        both = {"q": self.state.q, "clock": words_of(self.state.clock, float), "overlap": self.watch.numbers}
        return {**own, **both, "stored": self._stored}

    def worst_residual(self) -> Array:
        return np.max([one.run.worst_residual() for one in self.systems], axis=0)

    def save(self) -> SavedState:
        """The state now: each system at a time of its own, with what it has recorded beyond the earliest of these."""
        for one in self.systems:
            one.see()
        state = super().save()
        for k, one in enumerate(self.systems):
            one.run.watch.fill_in_later(state.arrays[f"{k}.overlap"])
        counts = np.array([(len(one.rows), len(one.events)) for one in self.systems])
        rows = np.zeros((counts[:, 0].sum(), 1 + 3 * len(self.state.q)))
        for end, one in zip(np.cumsum(counts[:, 0]), self.systems, strict=True):
            rows[end - len(one.rows) : end, one.places(rows.shape[1])] = one.rows
        ahead = rows, np.concatenate([one.events for one in self.systems]), counts
        return dataclasses.replace(state, recorded=state.recorded | dict(zip(AHEAD, ahead, strict=True)))

    def warm_up(self) -> None:
        for one in self.systems:
            one.run.warm_up()
        self._rows_at([one.rows for one in self.systems], np.zeros(0, complex))

    def _advance(self, until: Until, record: Any) -> Stop:
        """All to the end of the slice. Who is behind goes first, and nobody begins a step beyond one that is still on its way.

        Where one cannot go on, those that are beyond it go back to what was kept when nobody was behind them.
        """
        end, failed, stops, steps = until.slice_end, Stop.RUNNING, {}, until.steps
        for k, one in sorted(enumerate(self.systems), key=lambda pair: pair[1].time):
            if not one.kept or one.time <= min(other.time for other in self.systems):
                one.keep()
            own = new_until(end, until.end, bool(until.may_cut), steps)
            stops[k] = one.advance(own)
            until.steps = min(until.steps, own.steps)
            if stops[k] == Stop.SLICE:
                end = min(end, one.time)
            elif stops[k] not in ORDER:
                end, failed, self._failing = one.time, stops[k], one.run
                break
        for one in self.systems:
            if failed != Stop.RUNNING and one.time > end:
                one.go_back()
        self._gather()
        # Those that wait for the last step do not slow down the others.
        going = [self.systems[k].time for k, stop in stops.items() if stop == Stop.SLICE]
        self.state.clock.time = min(going, default=self.state.clock.time)
        if sum(one.waiting[0] for one in self.systems) > self._many * ROWS // 4:
            self.flush()
        return failed if failed != Stop.RUNNING else min(stops.values(), key=ORDER.index)

    def _come_together(self) -> None:
        """All to the time of the one that is furthest: the run ends there."""
        end = max(one.time for one in self.systems)
        for one in self.systems:
            while one.time < end and one.advance(new_until(end, end, True, 1e9)) == Stop.SLICE:
                pass
        self._gather()
        self._is_over = True

    def _gather(self) -> None:
        """What the systems come to together."""
        whole = arrays_of(self.state)
        for one in self.systems:
            for name in ("q", "u", "a"):
                getattr(whole, name)[one.columns] = one.arrays[name]
        whole.clock[0] = min(one.time for one in self.systems)
        for name in ("sums", "counts"):
            getattr(whole, name)[:] = np.sum([one.arrays[name] for one in self.systems], axis=0)
        penetration, energy = np.array([one.arrays["worst"] for one in self.systems]).T
        whole.worst[:] = penetration.max(), energy.sum()

    def _recorded(self) -> float:
        """Until when all have recorded rows, s; at that instant more may follow."""
        return min(float(one.rows[-1, 0]) if len(one.rows) else -math.inf for one in self.systems)

    def _rows_at(self, own: list[Array], stamps: NDArray[np.complex128]) -> Array:
        """Rows of the whole, from those of each system."""
        lengths = np.array([(rows.size, len(rows), len(one.columns)) for rows, one in zip(own, self.systems, strict=True)])
        rows, _, columns = (np.cumsum(lengths, axis=0) - lengths).T
        rows_of_whole = np.empty((len(stamps), 1 + 3 * len(self.state.q)))
        merge_rows(
            stamps.real.copy(),
            stamps.imag.astype(np.int64),
            np.stack([rows, lengths[:, 1], columns, lengths[:, 2]], axis=1),
            np.concatenate([one.columns for one in self.systems]),
            np.concatenate([one.noise for one in self.systems]),
            np.concatenate([rows.ravel() for rows in own]),
            rows_of_whole,
        )
        return rows_of_whole

    def flush(self) -> None:
        """Hand on the rows and events of the times that all have passed."""
        for one in self.systems:
            one.take()
        until = math.inf if self._is_over else self._recorded()
        # Complex numbers are sorted by time, then by the number within the instant.
        stamps = np.unique(np.concatenate([one.stamps() for one in self.systems]))
        stamps = stamps[(stamps.real >= self._merged) & (stamps.real < until)]
        own = [one.rows for one in self.systems]
        rows = RowsToMake(stamps.real, lambda numbers: self._rows_at(own, stamps[numbers]))
        passed = math.inf if self._is_over else min(one.time for one in self.systems)
        events = np.concatenate([one.events_before(passed) for one in self.systems])
        events = events[np.argsort(events["t"], kind="stable")]
        for one in self.systems:
            one.forget(until)
        self._merged = max(until, self._merged)
        self.tally.fold(events, rows)
        self.kept.flush(rows, events)

    def _look(self) -> None:
        for one in self.systems:
            one.run._look()
            if self._is_over:
                one.see()
                one.run.watch.see()
        self._overlaps()

    def _overlaps(self) -> bool:
        """Whether bodies of a system have overlapped too much; the watch over the whole holds what those over systems found."""
        whole, found = self.watch.found, [one.run.watch.found for one in self.systems]
        worst = max(range(len(found)), key=lambda k: float(found[k].depth))
        for name in ("rows", "looks"):
            whole[name] = sum(one[name] for one in found)
        for name in ("depth", "time", "x", "y"):
            whole[name] = found[worst][name]
        if found[worst].contact != NO_OVERLAP:
            whole.contact = self.systems[worst].declared[int(found[worst].contact)]
        return super()._overlaps()

    def _crowding(self) -> str:
        return next(filter(None, [one.run._crowding() for one in self.systems]), "")

    def _ledger_fails(self) -> bool:
        return any(one.run._ledger_fails() for one in self.systems) if self._is_over else super()._ledger_fails()

    def counts(self) -> dict[str, int]:
        cells = [one.run.counts() for one in self.systems]
        return super().counts() | {name: sum(one[name] for one in cells) for name in ("cells", "cells_asked")}


ORDER = (Stop.SLICE, Stop.LAST_STEP, Stop.DURATION)


def run_of(scene: Scene, compiled: Compiled, tolerance: float, recording: Recording, prefilter: bool = True) -> Run:
    """A run of the scene by events, of its systems side by side where it is several."""
    parts = systems_of(scene)
    if len(parts) == 1:
        return Run(scene, compiled, tolerance, recording)
    return SystemsRun(scene, parts, compiled, tolerance, recording, prefilter)
