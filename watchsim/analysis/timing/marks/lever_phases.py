"""What are the phases of the beats of a lever, in whatever order it unlocks, is pushed and locks? (See `phases`.)

All beats are looked at together: a run of a day has half a million.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.marks.anchor_marks import NEAR_REST, STANDING
from watchsim.analysis.timing.marks.stretches import NAMES, NOTHING, Codes, Stretches
from watchsim.analysis.timing.marks.wheel_contacts import WheelContacts
from watchsim.simulation.record.trajectory import Array

Ints = NDArray[np.int64]

AT_ONCE = 1000  # beats whose events are looked at together
NONE = np.iinfo(np.int64).max  # in the place of an event that there is not


@dataclass(frozen=True, slots=True)
class Marks:
    """Of some beats: their places among those found, the first of the wheel's events in each and the one after the last; the
    events with which the wheel is let go, first touches after that, and last touches before its drop."""

    beat: Ints
    first: Ints
    end: Ints
    released: Ints
    caught: Ints
    let_off: Ints

    def __getitem__(self, chosen: NDArray[np.bool_] | slice) -> Marks:
        """Those of some of the beats."""
        return Marks(*(column[chosen] for column in self.columns()))

    def columns(self) -> Iterator[Ints]:
        return (getattr(self, field.name) for field in fields(self))


def lever_phases(
    found: Beats, contacts: WheelContacts, told: Ints, ways: tuple[Array, Array], size: int
) -> Iterator[Stretches]:
    """Those of `size` beats at a time: of beats `told`; `ways` is the wheel's progress at their ticks and at their ends."""
    ends = np.searchsorted(contacts.times, (found.tick[told], found.end[told]), side="left")
    parts = [slice(k, k + AT_ONCE) for k in range(0, len(told), AT_ONCE)]
    known = [_marks(contacts, told[part], ends[:, part], (ways[0][part], ways[1][part])).columns() for part in parts]
    marks = Marks(*(np.concatenate(columns) for columns in zip(*known, strict=True))) if known else _nothing()
    for k in range(0, len(marks.beat), size):
        yield _rows(found, contacts, marks[k : k + size])


def _nothing() -> Marks:
    return Marks(*(np.zeros(0, np.int64) for _ in fields(Marks)))


def _events(first: Ints, end: Ints) -> tuple[Ints, Ints, Ints]:
    """The events of all beats one after the other, the beat of each, and where each beat begins among them."""
    count = end - first
    begins = np.cumsum(count) - count
    of = np.repeat(np.arange(len(count)), count)
    return first[of] + np.arange(len(of)) - begins[of], of, begins


def _marks(contacts: WheelContacts, beat: Ints, ends: Ints, ways: tuple[Array, Array]) -> Marks:
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
    return Marks(beat, first, end, released, caught, drop)[(drop < NONE) & (caught < NONE)]


def _rows(found: Beats, contacts: WheelContacts, marks: Marks) -> Stretches:
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


def _impulses(contacts: WheelContacts, marks: Marks) -> tuple[Ints, Array, Array, Codes]:
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
