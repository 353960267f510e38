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

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise, zip_longest
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.anchor_marks import NEAR_REST, STANDING, Marks, anchor_marks
from watchsim.analysis.timing.beats import Beats, beats, beats_within
from watchsim.analysis.timing.body_contacts import between, contact_columns, held, involves
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.hinged_pallets import hinged_beats
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.scene.roles import Roles, hinged_pallets, keeps_time, with_anchor
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Pair, Trajectory

LeverMarks = tuple[float, float, float, float]

TOUCH = (EventKind.IMPACT, EventKind.CLOSE)
RECOIL = 1e-3  # of the wheel's advance in a beat: a wheel that turns back less is led by a dead-beat anchor
AT_ONCE = 4000  # phases whose angles are looked up together
FACES = ("stone", "tooth", "balance")


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of a beat, s; angles at its start and turns during it, rad, of wheel, lever and oscillator.

    `beat` counts the half swings from 1 as in beats.csv. `on` says of an impulse on what: stone, tooth or balance, or on which
    pallet, where each is a body of its own.
    """

    beat: int
    name: str
    start: float
    end: float
    angles: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turns: tuple[float, float, float] = (0.0, 0.0, 0.0)
    on: str = ""


@dataclass(frozen=True, slots=True)
class _Contacts:
    """Contact events of the wheel: times, its progress, how many contacts hold after each, which are touches, and on what; and
    when the lever touches its banking."""

    times: Array
    angle: Array
    held: NDArray[np.int32]
    touching: NDArray[np.bool_]
    on: NDArray[np.int8]  # numbers of `FACES`
    banking: Array


class _Own(NamedTuple):
    """Those of one beat: a dozen, for which lists are faster."""

    times: list[float]
    angle: list[float]
    held: list[int]
    touching: list[bool]
    on: list[int]


def phases(run: Trajectory, found: Beats | None = None) -> list[Phase]:
    """The phases of all beats that were recorded whole; empty where the scene is no escapement with a lever or an anchor.

    A beat in which the wheel does not advance, or in which a phase cannot be told, has no rows.
    """
    return list(each_phase(run, found))


def phases_within(run: Trajectory, window: Sequence[float]) -> list[Phase]:
    """The phases of the beats that lie in a window (s), and of one before and after it."""
    if not keeps_time(run.scene):
        return []
    near = beats_within(beats(run), window)
    return phases(run, near) if len(near) else []


def each_phase(run: Trajectory, found: Beats | None = None, window: Sequence[float] | None = None) -> Iterator[Phase]:
    """The same one after the other, since a long run has a great many; only of beats that pass within a window (s)."""
    parts = with_anchor(run.scene)
    if parts.wheel is None or parts.lever is None or parts.oscillator is None or len(run.t) == 0:
        return
    found = found or beats(run)
    if hinged := hinged_pallets(run.scene):
        yield from _with_angles(run, parts, [Phase(*row) for row in hinged_beats(run, parts.wheel, hinged, found, window)])
        return
    contacts = _contacts(run, parts, found)
    within = np.ones(len(found), bool)
    if window is not None:
        within = (found.end >= window[0]) & (found.start <= window[1])
    of_beats = _beats_of_anchor if parts.lever == parts.oscillator else _beats
    rows = of_beats(run, parts, found, contacts, within)
    while some := list(islice(rows, AT_ONCE)):
        yield from _with_angles(run, parts, some)


def _beats(run: Trajectory, parts: Roles, found: Beats, contacts: _Contacts, within: NDArray[np.bool_]) -> Iterator[Phase]:
    """Of a lever, in whatever order it unlocks, is pushed and locks."""
    assert parts.wheel
    told = within & _told(run, found)
    at_entry, at_end = (progress(run, parts.wheel, np.where(told, t, run.t[0])) for t in (found.tick, found.end))
    ways = zip(at_entry.tolist(), at_end.tolist(), strict=True)
    for i, way in enumerate(ways):
        if told[i]:
            yield from _beat(found, contacts, i, way)


def _beats_of_anchor(
    run: Trajectory, parts: Roles, found: Beats, contacts: _Contacts, within: NDArray[np.bool_]
) -> Iterator[Phase]:
    """Of an anchor that swings as one with the oscillator: impulse, drop, then locked, or recoil where the wheel turns back."""
    assert parts.wheel
    at_rows = progress(run, parts.wheel, run.t)
    needed = within | np.append(False, within[:-1])  # where a beat is locked ends with the impulse of the next,
    needed |= np.append(False, needed[:-1])  # or of the one after, where every other half swing has none
    told = needed & is_recorded(run, found.start) & is_recorded(run, found.end)
    marks = [
        anchor_marks(contacts.times, contacts.held, contacts.angle, run.t, at_rows, *span) if known else None
        for known, span in zip(told, zip(found.start.tolist(), found.end.tolist(), strict=True), strict=True)
    ]
    for i, (own, after) in enumerate(zip_longest(marks, _next_ones(marks, told))):
        if own is None or not within[i]:
            continue
        beat = found.before + i + 1
        if own.freed is not None and own.caught is not None:
            yield Phase(beat, "unlock", own.moved, own.freed)
            yield Phase(beat, "catch-up", own.freed, own.caught)
        yield Phase(beat, "impulse", own.moved if own.caught is None else own.caught, own.let_off)
        yield Phase(beat, "drop", own.let_off, own.lock)
        if after is not None:
            at_lock, back = progress(run, parts.wheel, np.array([own.lock, after.moved])).tolist()
            recoils = at_lock - back > RECOIL * (at_lock - float(np.interp(own.moved, run.t, at_rows)))
            yield Phase(beat, "recoil" if recoils else "locked", own.lock, after.moved)


def _next_ones(marks: list[Marks | None], told: NDArray[np.bool_]) -> Iterator[Marks | None]:
    """For each beat the marks of the next in which the wheel goes on: those after it, or of the second after it (duplex)."""
    for i in range(1, len(marks)):
        second = marks[i + 1] if told[i] and i + 1 < len(marks) else None
        yield marks[i] or second


def _told(run: Trajectory, found: Beats) -> NDArray[np.bool_]:
    """The beats that have a tick and were recorded from there to their end."""
    heard = np.isfinite(found.tick)
    return heard & is_recorded(run, np.where(heard, found.tick, 0.0)) & is_recorded(run, found.end)


def _contacts(run: Trajectory, parts: Roles, found: Beats) -> _Contacts:
    """Those of the beats `found`."""
    assert parts.wheel and parts.lever
    times, kinds, which = contact_columns(run, involves(parts.wheel), ["t", "kind", "contact"], *TOUCH, EventKind.OPEN)
    fixed = {body.name for body in run.scene.bodies if body.motion == "fixed"}
    (banking,) = contact_columns(run, between(parts.lever, fixed), ["t"], *TOUCH)
    first, end = np.searchsorted(times, (found.start[0], found.end[-1])) if len(found) else (0, 0)
    near = slice(first, end)
    used, back = np.unique(which[near], return_inverse=True)
    on = np.array([FACES.index(_face(run.pairs[contact], parts)) for contact in used.tolist()], np.int8)[back]
    holding, touching = held(times, kinds, run.spans)[near].copy(), kinds[near] != EventKind.OPEN
    times = times[near].copy()
    return _Contacts(times, progress(run, parts.wheel, times), holding, touching, on, banking)


def _face(pair: Pair, parts: Roles) -> str:
    """On what the wheel presses in a contact: a face of the lever, one of its own teeth, or the oscillator."""
    if parts.oscillator in (pair.body_a, pair.body_b):
        return "balance"
    return "tooth" if pair.body_b == parts.wheel else "stone"  # the second of a pair holds the line or the rounder arc


def _beat(found: Beats, contacts: _Contacts, i: int, way: tuple[float, float]) -> Iterator[Phase]:
    """The phases of beat `i`, without angles; `way`: the wheel's progress from its tick to its end."""
    entry, end = float(found.tick[i]), float(found.end[i])
    first, last = np.searchsorted(contacts.times, (entry, end), side="left")
    columns = (contacts.times, contacts.angle, contacts.held, contacts.touching, contacts.on)
    own = _Own(*(column[first:last].tolist() for column in columns))
    marks = _release_and_lock(own, *way)
    if marks is None:
        return
    unlocked, caught, let_off, lock = marks
    beat = found.before + i + 1
    yield Phase(beat, "unlock", entry, unlocked)
    yield Phase(beat, "catch-up", unlocked, caught)
    changes = [*_impulses(own, caught, let_off), (let_off, "")]
    for (t0, on), (t1, _) in pairwise(changes):
        yield Phase(beat, "impulse", t0, t1, on=on)
    yield Phase(beat, "drop", let_off, lock)
    resting = lock
    met = int(np.searchsorted(contacts.banking, lock, side="left"))
    if met < len(contacts.banking) and contacts.banking[met] <= end:
        resting = float(contacts.banking[met])
        yield Phase(beat, "run to banking", lock, resting)
    if i + 1 < len(found) and math.isfinite(found.tick[i + 1]):
        yield Phase(beat, "locked", resting, float(found.tick[i + 1]))


def _impulses(own: _Own, caught: float, let_off: float) -> Iterator[tuple[float, str]]:
    """When the wheel begins to press on what, from `caught` to `let_off` (s)."""
    before = -1
    for time, touches, on in zip(own.times, own.touching, own.on, strict=True):
        if touches and caught <= time < let_off and on != before:
            before = on
            yield time, FACES[on]


def _release_and_lock(own: _Own, at_entry: float, at_end: float) -> LeverMarks | None:
    """Release, first touch after it, last touch before the drop, and lock (s), among the wheel's events of one beat."""
    times, angle = own.times, own.angle
    way = at_end - at_entry
    if len(times) < 3 or not way > 0.0:
        return None
    # Free runs: no contact holds from one event to the next, and time passes.
    near = at_end - NEAR_REST * way
    steps = range(len(times) - 1)
    free = (k for k in steps if own.held[k] == 0 and times[k + 1] - times[k] > 0.0 and angle[k + 1] >= near)
    drop = max(free, key=lambda k: angle[k + 1] - angle[k], default=None)
    if drop is None:
        return None
    back = min(angle[: drop + 1]) + STANDING * way
    released = max(k for k in range(drop + 1) if angle[k] <= back)
    caught = next((k for k in range(released + 1, drop + 1) if own.touching[k]), None)
    return None if caught is None else (times[released], times[caught], times[drop], times[drop + 1])


def _with_angles(run: Trajectory, parts: Roles, rows: list[Phase]) -> list[Phase]:
    """The rows with the angles of wheel, lever and oscillator, without those that end outside what was recorded."""
    starts, ends = np.array([row.start for row in rows]), np.array([row.end for row in rows])
    kept = is_recorded(run, starts) & is_recorded(run, ends)
    columns = [run.slices[name].start for name in (parts.wheel, parts.lever, parts.oscillator) if name]
    first, last = run.sample(starts)[0][:, columns], run.sample(ends)[0][:, columns]
    turns = last - first
    told = zip(rows, first.tolist(), turns.tolist(), kept.tolist(), strict=True)
    return [
        Phase(row.beat, row.name, row.start, row.end, _triple(place), _triple(turn), row.on)
        for row, place, turn, is_kept in told
        if is_kept
    ]


def _triple(values: list[float]) -> tuple[float, float, float]:
    first, second, third = values
    return first, second, third
