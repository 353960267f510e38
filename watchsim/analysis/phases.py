"""What happens between two beats, when, and how far does each part turn meanwhile?

The timeline of a lever-like escapement, read from contact events and the wheel's progress, so that it holds for any shapes:

unlock          from the pin's first touch of the fork until the wheel stands furthest back (draw makes it recoil; a dead-beat
                wheel waits) and is let go
catch-up        the wheel runs freely until it touches the next face
impulse         from there until the last touch before the drop; one row for each kind of face that is pushed: with the tooth's
                corner on the stone, with the stone's corner on the tooth, or by the wheel on the balance itself
drop            the long free run that ends near where the wheel comes to rest
run to banking  from the lock, the end of the drop, until the lever first meets its banking
locked          until the next touch of pin and fork

An anchor that swings as one with the oscillator has an impulse, a drop, and then is locked (dead-beat) or has a recoil, until
the next impulse begins. Where its tooth comes off its rest before it meets the face that is pushed (cylinder, duplex), there is
an unlocking and a catch-up, too. Pallets hinged on the oscillator (grasshopper) have their own file, `hinged_pallets`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from itertools import islice, pairwise, zip_longest
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.escape_wheel import progress
from watchsim.analysis.timing import (
    Beats,
    beats,
    beats_within,
    between,
    contact_columns,
    held,
    involves,
    is_recorded,
    with_the_last,
)
from watchsim.scene.roles import Roles, drive_direction, hinged_pallets, keeps_time, pallet_word, with_anchor
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory

# How are the phases of many beats kept: in columns, of which a row is made into words only when it is looked at.

NAMES = ("unlock", "catch-up", "impulse", "drop", "run to banking", "locked", "recoil")
STONE = "stone"  # of the lever; a pin or pallet is read as such
FACES = (STONE, "tooth", "balance", "")  # on what the wheel pushes in an impulse; the last is for other phases
NOTHING = FACES.index("")
COLUMNS = ("beat", "name", "start", "end", "on")

Codes = NDArray[np.int8]


class Stretch(NamedTuple):
    """One phase of the half swing number `beat`, s; `name` of `NAMES`; `on` of `FACES`, or a hinged pallet."""

    beat: int
    name: str
    start: float
    end: float
    on: str = ""


@dataclass(frozen=True, slots=True)
class Stretches:
    """Phases in order, (n,): number of the half swing, place in `NAMES`, s, s, and place in `words`."""

    beat: NDArray[np.int64]
    name: Codes
    start: Array
    end: Array
    on: Codes
    words: tuple[str, ...] = FACES

    def __len__(self) -> int:
        return len(self.beat)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> Stretches:
        """Only some rows."""
        return replace(self, **{name: getattr(self, name)[chosen] for name in COLUMNS})

    @property
    def names(self) -> list[str]:
        return [NAMES[code] for code in self.name.tolist()]

    @property
    def faces(self) -> list[str]:
        return [self.words[code] for code in self.on.tolist()]

    @property
    def first(self) -> NDArray[np.int64]:
        """The first row of each beat."""
        return np.flatnonzero(np.append(True, self.beat[1:] != self.beat[:-1])[: len(self)])


def gathered(beats: Iterator[list[Stretch]], at_once: int) -> Iterator[Stretches]:
    """Those of so many beats at a time, from the phases of one beat after the other."""
    while some := list(islice(beats, at_once)):
        yield in_columns([row for rows in some for row in rows])


def in_columns(rows: Sequence[Stretch]) -> Stretches:
    """The same in columns."""
    beat, name, start, end, on = zip(*rows, strict=True) if rows else ((),) * 5
    words = (*FACES, *sorted(set(on).difference(FACES)))
    codes = (np.array([known.index(one) for one in column], np.int8) for known, column in ((NAMES, name), (words, on)))
    return Stretches(np.array(beat, np.int64), next(codes), np.array(start, float), np.array(end, float), next(codes), words)


TOUCH = (EventKind.IMPACT, EventKind.CLOSE)


@dataclass(frozen=True, slots=True)
class WheelContacts:
    """Contact events of the wheel: times, its progress, how many contacts hold after each, which are touches that may push the
    lever, and on what; and when the lever touches its banking."""

    times: Array
    angle: Array
    held: NDArray[np.int32]
    touching: NDArray[np.bool_]
    on: Codes  # numbers of `FACES`
    banking: Array


def wheel_contacts(run: Trajectory, parts: Roles, found: Beats, within: NDArray[np.bool_]) -> WheelContacts:
    """Those of the beats `within` of the ones found, of the two after them, and the last one before."""
    assert parts.wheel and parts.lever
    names = ["t", "kind", "contact", "impulse_normal"]
    times, kinds, which, blows = contact_columns(run, involves(parts.wheel), names, *TOUCH, EventKind.OPEN)
    fixed = {body.name for body in run.scene.bodies if body.motion == "fixed"}
    (banking,) = contact_columns(run, between(parts.lever, fixed), ["t"], *TOUCH)
    near = _near(times, found, np.flatnonzero(within))
    used, back = np.unique(which[near], return_inverse=True)
    on = np.array([FACES.index(_face(run.pairs[contact], parts)) for contact in used.tolist()], np.int8)[back]
    holding, touching = held(times, kinds, run.spans)[near].copy(), kinds[near] != EventKind.OPEN
    times = times[near].copy()
    touching &= ~((blows[near] > 0.0) & _struck_on(run, parts.wheel, times))
    return WheelContacts(times, progress(run, parts.wheel, times), holding, touching, on, banking)


def _struck_on(run: Trajectory, wheel: str, times: Array) -> NDArray[np.bool_]:
    """At which times a blow drove the wheel on: one on the back of a tooth, where a pallet may push but cannot be pushed."""
    before, after = np.searchsorted(run.t, times, side="left"), np.searchsorted(run.t, times, side="right") - 1
    speed = drive_direction(run.scene, wheel) * run.u[:, run.slices[wheel].start]
    known = after > before
    last = len(speed) - 1
    jump: NDArray[np.bool_] = known & (speed[np.minimum(after, last)] - speed[np.minimum(before, last)] > 0.0)
    return jump


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
    return "tooth" if pair.body_b == parts.wheel else STONE  # the second of a pair holds the line or the rounder arc


# Such a beat has no unlocking of its own: the tooth slides from the locking face onto the impulse face (dead-beat), or turns
# back with the wheel until the anchor returns (recoil). Only where the tooth comes off its rest before it meets the face that
# is pushed, as at the lips of a cylinder or in the notch of a duplex, is there an unlocking, and a catching up after it.

STANDING = 1e-6  # of the wheel's advance in a beat: it has not moved
NEAR_REST = 0.1  # of the wheel's advance in the beat: a free run that ends so near to rest may be the drop
CATCHES_UP = 0.05  # of it: a shorter free run is a loss of contact during the impulse


class Marks(NamedTuple):
    """Of one half swing, s: the wheel begins to move, comes off its rest, meets the face that is pushed (these two None where
    it slides from one to the other), the tooth is let off, another one is locked."""

    moved: float
    freed: float | None
    caught: float | None
    let_off: float
    lock: float


def anchor_marks(
    times: Array, held: NDArray[np.int32], at_events: Array, rows: Array, at_rows: Array, start: float, end: float
) -> Marks | None:
    """The marks of the half swing from `start` to `end` (s); None where the wheel does not go on in it.

    times, held, at_events  contact events of the wheel (n,): s, how many contacts hold after each, its progress (rad)
    rows, at_rows           times at which the motion was recorded (m,), s, and the wheel's progress then (rad)
    """
    first, last = np.searchsorted(times, (start, end))
    own = slice(max(int(first) - 1, 0), int(last))
    t, angle = times[own], at_events[own]
    runs = np.where((held[own][:-1] == 0) & (np.diff(t) > 0.0), np.diff(angle), 0.0)
    before, after = np.interp((start, end), rows, at_rows).tolist()
    if not len(runs) or not after - before > NEAR_REST * runs.max():
        return None
    ends_at_rest = angle[1:] >= after - NEAR_REST * (after - before)
    drop = int(np.argmax(np.where(ends_at_rest, runs, 0.0)))
    let_off, lock = t[drop : drop + 2].tolist()
    i, j = np.searchsorted(rows, (start, let_off))
    if j <= i or let_off < start or not runs[drop] > 0.0:
        return None
    when, earlier = np.append(start, rows[i : j + 1]), np.append(before, at_rows[i : j + 1])  # recoils end at it
    way = float(angle[drop + 1] - earlier.min())
    moved = float(when[np.flatnonzero(earlier <= earlier.min() + STANDING * way)[-1]])
    free = np.where(t[:drop] >= moved, runs[:drop], 0.0)
    if not free.max(initial=0.0) > CATCHES_UP * way:
        return Marks(moved, None, None, let_off, lock)
    freed, caught = t[(k := int(np.argmax(free))) : k + 2].tolist()
    return Marks(moved, freed, caught, let_off, lock)


# Impulse, drop, then it is locked, or recoils where the wheel turns back.

RECOIL = 1e-3  # of the wheel's advance in a beat: a wheel that turns back less is led by a dead-beat anchor


def _anchor_beats(
    run: Trajectory, parts: Roles, found: Beats, contacts: WheelContacts, within: NDArray[np.bool_]
) -> Iterator[list[Stretch]]:
    """The phases of one beat after the other."""
    assert parts.wheel
    at_rows = progress(run, parts.wheel, run.t)
    needed = within | np.append(False, within[:-1])  # where a beat is locked ends with the impulse of the next,
    needed |= np.append(False, needed[:-1])  # or of the one after, where every other half swing has none
    recorded = needed & is_recorded(run, found.start) & is_recorded(run, found.end)
    marks = [
        anchor_marks(contacts.times, contacts.held, contacts.angle, run.t, at_rows, *span) if known else None
        for known, span in zip(recorded, zip(found.start.tolist(), found.end.tolist(), strict=True), strict=True)
    ]
    for i, (own, after) in enumerate(zip_longest(marks, _next_ones(marks, recorded))):
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


def _next_ones(marks: list[Marks | None], recorded: NDArray[np.bool_]) -> Iterator[Marks | None]:
    """For each beat the marks of the next in which the wheel goes on: those after it, or of the second after it (duplex)."""
    for i in range(1, len(marks)):
        second = marks[i + 1] if recorded[i] and i + 1 < len(marks) else None
        yield marks[i] or second


# A grasshopper has no lock and no drop: a tooth stays with its pallet until the other pallet has caught another tooth. The
# wheel turns back until the oscillator turns (recoil) and then pushes by the same pallet, until the other one catches and
# lets the first go (impulse).


def _hinged_beats(
    run: Trajectory, wheel: str, pallets: Sequence[str], found: Beats, within: NDArray[np.bool_]
) -> Iterator[list[Stretch]]:
    """The impulse of each half swing and the recoil that follows.

    An impulse is on the pallet that caught its tooth last, the recoil on the one that catches then. A half swing has no rows
    where the wheel only recoils, or where the next one was not recorded.
    """
    times, which = _catches(run, wheel, pallets)
    needed = within | np.append(False, within[:-1])  # the recoil ends with the next half swing's impulse
    recorded = needed & is_recorded(run, found.start) & is_recorded(run, found.end)
    spans = zip(found.start.tolist(), found.end.tolist(), strict=True)
    marks = [_marks(run, wheel, span) if known else None for known, span in zip(recorded, spans, strict=True)]
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


# All beats are looked at together: a run of a day has half a million.

Ints = NDArray[np.int64]

AT_ONCE = 1000  # beats whose events are looked at together
NONE = np.iinfo(np.int64).max  # in the place of an event that there is not


@dataclass(frozen=True, slots=True)
class MarksLeverPhases:
    """Of some beats: their places among those found, the first of the wheel's events in each and the one after the last; the
    events with which the wheel is let go, first touches after that, and last touches before its drop."""

    beat: Ints
    first: Ints
    end: Ints
    released: Ints
    caught: Ints
    let_off: Ints

    def __getitem__(self, chosen: NDArray[np.bool_] | slice) -> MarksLeverPhases:
        """Those of some of the beats."""
        return MarksLeverPhases(*(column[chosen] for column in self.columns()))

    def columns(self) -> Iterator[Ints]:
        return (getattr(self, field.name) for field in fields(self))


def lever_phases(
    found: Beats, contacts: WheelContacts, whole: Ints, ways: tuple[Array, Array], size: int
) -> Iterator[Stretches]:
    """Those of `size` beats at a time: of beats `whole`; `ways` is the wheel's progress at their ticks and at their ends."""
    ends = np.searchsorted(contacts.times, (found.tick[whole], found.end[whole]), side="left")
    parts = [slice(k, k + AT_ONCE) for k in range(0, len(whole), AT_ONCE)]
    known = [
        _marks_lever_phases(contacts, whole[part], ends[:, part], (ways[0][part], ways[1][part])).columns() for part in parts
    ]
    marks = MarksLeverPhases(*(np.concatenate(columns) for columns in zip(*known, strict=True))) if known else _nothing()
    for k in range(0, len(marks.beat), size):
        yield _rows(found, contacts, marks[k : k + size])


def _nothing() -> MarksLeverPhases:
    return MarksLeverPhases(*(np.zeros(0, np.int64) for _ in fields(MarksLeverPhases)))


def _events(first: Ints, end: Ints) -> tuple[Ints, Ints, Ints]:
    """The events of all beats one after the other, the beat of each, and where each beat begins among them."""
    count = end - first
    begins = np.cumsum(count) - count
    of = np.repeat(np.arange(len(count)), count)
    return first[of] + np.arange(len(of)) - begins[of], of, begins


def _marks_lever_phases(contacts: WheelContacts, beat: Ints, ends: Ints, ways: tuple[Array, Array]) -> MarksLeverPhases:
    """Release, first touch after it and last touch before the drop, of those beats that have all of them."""
    (first, end), (at_entry, at_end) = ends, ways
    moves = (end - first >= 3) & (at_end > at_entry)
    beat, first, end, at_end, way = beat[moves], first[moves], end[moves], at_end[moves], (at_end - at_entry)[moves]
    if not len(beat):
        return _nothing()
    k, of, begins = _events(first, end)
    following = np.minimum(k + 1, end[of] - 1)
    t, angle = contacts.times, contacts.angle
    # Free runs: no contact holds from one event to the next, and time passes.
    near = (at_end - NEAR_REST * way)[of]
    free = (contacts.held[k] == 0) & (t[following] > t[k]) & (angle[following] >= near)
    run = np.where(free, angle[following] - angle[k], -np.inf)
    longest = np.maximum.reduceat(run, begins)
    drop = np.minimum.reduceat(np.where(free & (run == longest[of]), k, NONE), begins)
    until = k <= drop[of]
    back = np.minimum.reduceat(np.where(until, angle[k], np.inf), begins) + STANDING * way
    released = np.maximum.reduceat(np.where(until & (angle[k] <= back[of]), k, -1), begins)
    touches = contacts.touching[k] & until & (k > released[of])
    caught = np.minimum.reduceat(np.where(touches, k, NONE), begins)
    return MarksLeverPhases(beat, first, end, released, caught, drop)[(drop < NONE) & (caught < NONE)]


def _rows(found: Beats, contacts: WheelContacts, marks: MarksLeverPhases) -> Stretches:
    """The phases of these beats, in order."""
    t, beat = contacts.times, marks.beat
    tick, released, caught, let_off, lock = (
        found.tick[beat],
        *(t[k] for k in (marks.released, marks.caught, marks.let_off, marks.let_off + 1)),
    )
    pushed, push_starts, push_ends, on = _impulses(contacts, marks)
    met = np.append(contacts.banking, np.inf)[np.searchsorted(contacts.banking, lock, side="left")]
    banks = met <= found.end[beat]
    resting, coming = np.where(banks, met, lock), np.append(found.tick, np.nan)[beat + 1]
    rests = np.isfinite(coming)
    every = np.arange(len(beat))
    rows = {
        "unlock": (every, tick, released),
        "catch-up": (every, released, caught),
        "impulse": (pushed, push_starts, push_ends),
        "drop": (every, let_off, lock),
        "run to banking": (every[banks], lock[banks], resting[banks]),
        "locked": (every[rests], resting[rests], coming[rests]),
    }
    of, starts, ends = (np.concatenate(columns) for columns in zip(*rows.values(), strict=True))
    names = np.repeat([NAMES.index(name) for name in rows], [len(columns[0]) for columns in rows.values()]).astype(np.int8)
    faces = np.full(len(of), NOTHING, np.int8)
    faces[names == NAMES.index("impulse")] = on
    return Stretches(found.before + beat[of] + 1, names, starts, ends, faces)[np.lexsort((names, of))]


def _impulses(contacts: WheelContacts, marks: MarksLeverPhases) -> tuple[Ints, Array, Array, Codes]:
    """In which of the beats, from when and until when the wheel presses on what: until it begins on something else."""
    t = contacts.times
    k, of, _ = _events(marks.first, marks.end)
    presses = contacts.touching[k] & (t[k] >= t[marks.caught][of]) & (t[k] < t[marks.let_off][of])
    k, of = k[presses], of[presses]
    on = contacts.on[k]
    changes = np.append(True, (of[1:] != of[:-1]) | (on[1:] != on[:-1]))[: len(of)]
    k, of = k[changes], of[changes]
    goes_on = np.append(of[1:] == of[:-1], False)[: len(of)]
    return of, t[k], np.where(goes_on, np.append(t[k][1:], np.nan)[: len(of)], t[marks.let_off][of]), contacts.on[k]


AT_ONCE_PHASES = 300  # beats; their rows are some megabytes, which a processor has at hand


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of a beat, s; angles at its start and turns during it, rad, of wheel, lever and oscillator.

    `beat` counts the half swings from 1 as in beats.csv. `on` says of an impulse on what: stone (pallet, pin), tooth or
    balance, or on which pallet, where each is a body of its own.
    """

    beat: int
    name: str
    start: float
    end: float
    angles: tuple[float, float, float]
    turns: tuple[float, float, float]
    on: str = ""


@dataclass(frozen=True, slots=True)
class Phases:
    """The phases of some beats in a row, column by column, with angles and turns as in `Phase`, (n, 3)."""

    rows: Stretches
    angles: Array
    turns: Array

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, chosen: NDArray[np.bool_]) -> Phases:
        """Only some of them."""
        return Phases(self.rows[chosen], self.angles[chosen], self.turns[chosen])

    def each(self) -> Iterator[Phase]:
        """One after the other."""
        rows = self.rows
        numbers = (values.tolist() for values in (rows.beat, rows.start, rows.end, self.angles, self.turns))
        beat, start, end, angles, turns = numbers
        for one, name, first, last, (a0, a1, a2), (t0, t1, t2), on in zip(
            beat, rows.names, start, end, angles, turns, rows.faces, strict=True
        ):
            yield Phase(one, name, first, last, (a0, a1, a2), (t0, t1, t2), on)


def phases(run: Trajectory, found: Beats | None = None) -> list[Phase]:
    """The phases of all beats that were recorded whole; empty where the scene is no escapement with a lever or an anchor.

    A beat in which the wheel does not advance, or in which a phase is not known, has no rows.
    """
    return list(each_phase(run, found))


def phases_within(run: Trajectory, window: Sequence[float]) -> list[Phase]:
    """The phases of the beats that lie in a window (s), and of one before and after it."""
    if not keeps_time(run.scene):
        return []
    near = beats_within(with_the_last(run, beats(run)), window)
    return phases(run, near) if len(near) else []


def each_phase(run: Trajectory, found: Beats | None = None) -> Iterator[Phase]:
    """The same as `phases` one after the other, since a long run has a great many."""
    for some in phase_columns(run, found):
        yield from some.each()


def phase_columns(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> Iterator[Phases]:
    """The same in columns, of a few hundred beats at a time; only of beats that begin within a window (s)."""
    for rows in stretches(run, found, window):
        some = with_angles(run, rows)
        yield some if window is None else _beginning(some, window)


def stretches(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> Iterator[Stretches]:
    """The same without angles; of beats that lie at least in part within the window."""
    parts = with_anchor(run.scene)
    if parts.wheel is None or parts.lever is None or parts.oscillator is None or len(run.t) == 0:
        return
    found = found or beats(run)
    within = np.ones(len(found), bool)
    if window is not None:
        within = (found.end >= window[0]) & (found.start <= window[1])
    yield from _stretches(run, parts, found, within)


def _stretches(run: Trajectory, parts: Roles, found: Beats, within: NDArray[np.bool_]) -> Iterator[Stretches]:
    """Of the beats within."""
    assert parts.wheel
    if pallets := hinged_pallets(run.scene):
        return gathered(_hinged_beats(run, parts.wheel, pallets, found, within), AT_ONCE_PHASES)
    contacts = wheel_contacts(run, parts, found, within)
    if parts.lever == parts.oscillator:
        return gathered(_anchor_beats(run, parts, found, contacts, within), AT_ONCE_PHASES)
    whole = np.flatnonzero(within & _is_whole(run, found))
    ways = (progress(run, parts.wheel, found.tick[whole]), progress(run, parts.wheel, found.end[whole]))
    faces = tuple(pallet_word(run.scene) if face == STONE else face for face in FACES)
    return (replace(some, words=faces) for some in lever_phases(found, contacts, whole, ways, AT_ONCE_PHASES))


def _is_whole(run: Trajectory, found: Beats) -> NDArray[np.bool_]:
    """The beats that have a tick and were recorded from there to their end."""
    return is_recorded(run, found.tick) & is_recorded(run, found.end)


def with_angles(run: Trajectory, rows: Stretches) -> Phases:
    """The rows with the angles of wheel, lever and oscillator, without those that end outside what was recorded."""
    parts = with_anchor(run.scene)
    rows = rows[is_recorded(run, rows.start) & is_recorded(run, rows.end)]
    columns = [run.slices[name].start for name in (parts.wheel, parts.lever, parts.oscillator) if name]
    first, last = run.positions(rows.start, columns), run.positions(rows.end, columns)
    return Phases(rows, first, last - first)


def _beginning(some: Phases, window: Sequence[float]) -> Phases:
    """Those of the beats whose first phase begins within the window."""
    first = some.rows.first
    starts = np.repeat(some.rows.start[first], np.diff(np.append(first, len(some))))
    return some[(window[0] <= starts) & (starts <= window[1])]
