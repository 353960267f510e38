"""Are the phases of many beats, found together, those that are found by looking at one beat after the other?"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest

from watchsim.analysis.timing.beats import Beats
from watchsim.analysis.timing.marks.lever_phases import lever_phases
from watchsim.analysis.timing.marks.stretches import FACES, Stretch, in_columns
from watchsim.analysis.timing.marks.wheel_contacts import WheelContacts

BEATS = 60


def made(seed: int) -> tuple[Beats, WheelContacts]:
    """Beats with random events: some with few or none, several at one instant, wheels that turn back, ticks not heard."""
    rng = np.random.default_rng(seed)
    turns = np.arange(BEATS + 1.0)
    number = rng.integers(0, 25, BEATS)
    t = np.sort(np.repeat(turns[:-1], number) + rng.integers(0, 40, number.sum()) / 40.0)
    angle = np.round(np.floor(t) + rng.random(len(t)) ** 0.3, 2)
    tick = turns[:-1] + rng.integers(0, 10, BEATS) / 40.0
    tick[rng.random(BEATS) < 0.1] = math.nan
    unused = np.zeros(BEATS)
    found = Beats("balance", True, 2.0, turns[:-1] + 0.5, turns[:-1], turns[1:], unused, unused, tick, unused, before=7)
    banking = np.sort(rng.uniform(0.0, BEATS, BEATS // 2))
    held, on = rng.integers(0, 2, len(t)).astype(np.int32), rng.integers(0, 3, len(t)).astype(np.int8)
    return found, WheelContacts(t, angle, held, rng.random(len(t)) < 0.7, on, banking)


def one_by_one(
    found: Beats, contacts: WheelContacts, told: list[int], ways: tuple[list[float], list[float]]
) -> Iterator[Stretch]:
    """The definition, with loops."""
    for i, at_entry, at_end in zip(told, *ways, strict=True):
        entry, end = float(found.tick[i]), float(found.end[i])
        own = [k for k, t in enumerate(contacts.times.tolist()) if entry <= t < end]
        t, angle = ({k: float(column[k]) for k in own} for column in (contacts.times, contacts.angle))
        way = at_end - at_entry
        if len(own) < 3 or not way > 0.0:
            continue
        runs = {
            k: angle[k + 1] - angle[k]
            for k in own[:-1]
            if contacts.held[k] == 0 and t[k + 1] > t[k] and angle[k + 1] >= at_end - 0.1 * way
        }
        if not runs:
            continue
        drop = max(runs, key=lambda k: runs[k])
        until = [k for k in own if k <= drop]
        back = min(angle[k] for k in until) + 1e-6 * way
        released = max(k for k in until if angle[k] <= back)
        caught = next((k for k in until if k > released and contacts.touching[k]), None)
        if caught is None:
            continue
        beat = found.before + i + 1
        yield Stretch(beat, "unlock", entry, t[released])
        yield Stretch(beat, "catch-up", t[released], t[caught])
        presses = [(t[k], int(contacts.on[k])) for k in own if contacts.touching[k] and t[caught] <= t[k] < t[drop]]
        begins = [one for before, one in pairwise([(0.0, -1), *presses]) if one[1] != before[1]]
        for (start, on), (stop, _) in pairwise([*begins, (t[drop], -1)]):
            yield Stretch(beat, "impulse", start, stop, FACES[on])
        lock = t[drop + 1]
        yield Stretch(beat, "drop", t[drop], lock)
        rest = next((bank for bank in contacts.banking.tolist() if lock <= bank <= end), None)
        if rest is not None:
            yield Stretch(beat, "run to banking", lock, rest)
        if i + 1 < len(found) and math.isfinite(found.tick[i + 1]):
            yield Stretch(beat, "locked", lock if rest is None else rest, float(found.tick[i + 1]))


@pytest.mark.parametrize("size", [1, 7, 1000])
@pytest.mark.parametrize("seed", range(12))
def test_together_as_one_by_one(seed: int, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("watchsim.analysis.timing.marks.lever_phases.AT_ONCE", 2 * size + 1)
    found, contacts = made(seed)
    told = np.flatnonzero(np.isfinite(found.tick))
    ways = found.start[told], found.end[told] - 0.1 * (seed % 3)
    expected = list(one_by_one(found, contacts, told.tolist(), (ways[0].tolist(), ways[1].tolist())))
    parts = list(lever_phases(found, contacts, told, ways, size))
    columns = ((part.beat, part.names, part.start, part.end, part.faces) for part in parts)
    got = [
        Stretch(int(b), name, float(t0), float(t1), on) for some in columns for b, name, t0, t1, on in zip(*some, strict=True)
    ]
    assert got == expected
    assert len({row.beat for row in expected}) > 10
    assert all(len(part.first) <= size for part in parts)


def test_without_phases_every_column_is_empty() -> None:
    empty = in_columns([])
    assert len(empty) == 0 and empty.names == [] and empty.faces == [] and empty.first.tolist() == []


@pytest.mark.parametrize(("off", "released"), [(-0.9e-5, 0.3), (0.9e-5, 0.3), (1.1e-5, 0.2)])
def test_a_wheel_that_has_moved_by_a_millionth_of_its_way_is_let_go(off: float, released: float) -> None:
    """It goes on by ten: from where it stood furthest back to within a tenth of where it comes to rest."""
    t, angle = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]), np.array([5.1, 5.0, 5.0 + off, 7.0, 12.0, 14.9])
    nothing, kinds = np.zeros(1), np.array([False, False, False, True, False, True])
    found = Beats("balance", True, 2.0, np.array([0.35]), nothing, np.ones(1), nothing, nothing, np.array([0.05]), nothing)
    contacts = WheelContacts(t, angle, np.array([1, 1, 1, 1, 0, 1], np.int32), kinds, np.zeros(6, np.int8), np.zeros(0))
    (rows,) = lever_phases(found, contacts, np.zeros(1, np.int64), (np.array([5.0]), np.array([15.0])), 3)
    assert rows.names == ["unlock", "catch-up", "impulse", "drop"]
    assert rows.end.tolist() == [released, 0.4, 0.5, 0.6]
