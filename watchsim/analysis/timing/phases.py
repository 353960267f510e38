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
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats, beats, beats_within
from watchsim.analysis.timing.escape_wheel import progress
from watchsim.analysis.timing.marks.anchor_phases import anchor_phases
from watchsim.analysis.timing.marks.hinged_phases import hinged_phases
from watchsim.analysis.timing.marks.lever_phases import lever_phases
from watchsim.analysis.timing.marks.stretches import Stretches
from watchsim.analysis.timing.marks.wheel_contacts import wheel_contacts
from watchsim.analysis.timing.rows_at_hand import is_recorded
from watchsim.scene.roles import Roles, hinged_pallets, keeps_time, with_anchor
from watchsim.simulation.record.trajectory import Array, Trajectory

AT_ONCE = 300  # beats; their rows are some megabytes, which a processor has at hand


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

    A beat in which the wheel does not advance, or in which a phase cannot be told, has no rows.
    """
    return list(each_phase(run, found))


def phases_within(run: Trajectory, window: Sequence[float]) -> list[Phase]:
    """The phases of the beats that lie in a window (s), and of one before and after it."""
    if not keeps_time(run.scene):
        return []
    near = beats_within(beats(run), window)
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
        return hinged_phases(run, parts.wheel, pallets, found, within, AT_ONCE)
    contacts = wheel_contacts(run, parts, found, within)
    if parts.lever == parts.oscillator:
        return anchor_phases(run, parts, found, contacts, within, AT_ONCE)
    told = np.flatnonzero(within & _told(run, found))
    ways = (progress(run, parts.wheel, found.tick[told]), progress(run, parts.wheel, found.end[told]))
    return lever_phases(found, contacts, told, ways, AT_ONCE)


def _told(run: Trajectory, found: Beats) -> NDArray[np.bool_]:
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
