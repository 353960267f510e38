"""Are the phases of anchors and of hinged pallets those that loops over beats, rows and touches find?"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing.marks import anchor_phases as anchored
from watchsim.analysis.timing.marks import hinged_phases as hinged
from watchsim.analysis.timing.marks.anchor_marks import Marks
from watchsim.analysis.timing.marks.anchor_phases import anchor_phases
from watchsim.analysis.timing.marks.hinged_phases import hinged_phases
from watchsim.analysis.timing.marks.stretches import Stretch, Stretches

BEATS = 12
PALLETS = ("entry", "exit")


def rows_of(parts: Iterator[Stretches], size: int) -> list[Stretch]:
    found = []
    for part in parts:
        assert 0 < len(part.first) <= size
        columns = (part.beat.tolist(), part.names, part.start.tolist(), part.end.tolist(), part.faces)
        found += [Stretch(*row) for row in zip(*columns, strict=True)]
    return found


def made(rng: np.random.Generator) -> tuple[Any, Any, np.ndarray, set[float]]:
    """A run with the wheel's progress at its rows, half swings from 3 s on, which are asked for, and times not recorded."""
    t = np.sort(rng.uniform(2.5, 15.5, 60))
    run = SimpleNamespace(t=t, way=np.round(np.cumsum(rng.choice([-0.9, -0.1, -1e-4, 0.0, 0.1, 0.7], len(t))), 4))
    turns = 3.0 + np.arange(BEATS + 1.0)
    found = SimpleNamespace(start=turns[:-1], end=turns[1:], before=5)
    unknown = set(rng.choice(turns, 2).tolist()) if rng.random() < 0.7 else set()
    return run, found, rng.random(BEATS) < 0.7, unknown


def patch(monkeypatch: pytest.MonkeyPatch, module: Any, unknown: set[float]) -> None:
    monkeypatch.setattr(module, "progress", lambda run, wheel, times: np.interp(times, run.t, run.way))
    monkeypatch.setattr(module, "is_recorded", lambda run, times: np.array([t not in unknown for t in times.tolist()], bool))


def marks_of(rng: np.random.Generator, start: float) -> Marks | None:
    if rng.random() < 0.3:
        return None
    moved, freed, caught, let_off, lock = (start + np.sort(rng.random(5))).tolist()
    slides = rng.random() < 0.5
    return Marks(moved, None if slides else freed, None if slides else caught, let_off, lock)


def anchor_rows(run: Any, found: Any, within: np.ndarray, unknown: set[float], marks: list[Marks | None]) -> list[Stretch]:
    """What is told of a beat that is asked for; the next one that goes on ends its rest, or the second after it."""
    rows = []
    known = [not {found.start[i], found.end[i]} & unknown for i in range(BEATS)]
    for i in np.flatnonzero(within).tolist():
        own, after = (marks[i] if known[i] else None), None
        if own is None:
            continue
        if i + 1 < BEATS and known[i + 1]:
            after = marks[i + 1] or (marks[i + 2] if i + 2 < BEATS and known[i + 2] else None)
        beat, pushed = i + 6, own.moved
        if own.caught is not None and own.freed is not None:
            rows += [Stretch(beat, "unlock", own.moved, own.freed), Stretch(beat, "catch-up", own.freed, own.caught)]
            pushed = own.caught
        rows += [Stretch(beat, "impulse", pushed, own.let_off), Stretch(beat, "drop", own.let_off, own.lock)]
        if after is not None:
            lock, back, begun = (float(np.interp(t, run.t, run.way)) for t in (own.lock, after.moved, own.moved))
            rows.append(Stretch(beat, "recoil" if lock - back > 0.001 * (lock - begun) else "locked", own.lock, after.moved))
    return rows


@pytest.mark.parametrize("size", [1, 5, 100])
@pytest.mark.parametrize("seed", range(12))
def test_beats_of_an_anchor(seed: int, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(seed)
    run, found, within, unknown = made(rng)
    marks = [marks_of(rng, start) for start in found.start.tolist()]
    patch(monkeypatch, anchored, unknown)
    at = dict(zip(zip(found.start.tolist(), found.end.tolist(), strict=True), marks, strict=True))
    asked = []

    def told(times: Any, held: Any, angle: Any, rows: Any, way: Any, start: float, end: float) -> Marks | None:
        assert (times, held, angle) == ("times", "held", "angle") and rows is run.t and way.tolist() == run.way.tolist()
        asked.append(start)
        return at[start, end]

    monkeypatch.setattr(anchored, "anchor_marks", told)
    contacts: Any = SimpleNamespace(times="times", held="held", angle="angle")
    parts: Any = SimpleNamespace(wheel="wheel")
    got = rows_of(anchor_phases(run, parts, found, contacts, within, size), size)
    assert got == anchor_rows(run, found, within, unknown, marks)
    near = {i + k for i in np.flatnonzero(within).tolist() for k in range(3)}
    known = {i for i in range(BEATS) if not {found.start[i], found.end[i]} & unknown}
    assert asked == found.start[sorted(near & known)].tolist()


@pytest.mark.parametrize(("back", "name"), [(0.9e-3, "locked"), (1.1e-3, "recoil"), (-0.5, "locked")])
def test_a_thousandth_of_the_advance_is_a_recoil(back: float, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The wheel has come from 7 to 9, and goes back by so much of that."""
    t, way = np.array([0.0, 0.1, 0.8, 1.3, 2.0]), np.array([6.0, 7.0, 9.0, 9.0 - 2.0 * back, 12.0])
    run: Any = SimpleNamespace(t=t, way=way)
    found: Any = SimpleNamespace(start=np.array([0.0, 1.0]), end=np.array([1.0, 2.0]), before=0)
    patch(monkeypatch, anchored, set())
    marks = iter([Marks(0.1, None, None, 0.7, 0.8), Marks(1.3, None, None, 1.7, 1.8)])
    monkeypatch.setattr(anchored, "anchor_marks", lambda *_: next(marks))
    contacts: Any = SimpleNamespace(times=None, held=None, angle=None)
    parts: Any = SimpleNamespace(wheel="wheel")
    rows = rows_of(anchor_phases(run, parts, found, contacts, np.ones(2, bool), 9), 9)
    assert [row.name for row in rows] == ["impulse", "drop", name, "impulse", "drop"]


def hinged_rows(run: Any, found: Any, within: np.ndarray, unknown: set[float], touches: list[list[float]]) -> list[Stretch]:
    def marks(i: int) -> tuple[float, float] | None:
        start, end = found.start[i], found.end[i]
        if {start, end} & unknown:
            return None
        times = [start, *(t for t in run.t if start <= t < end), end]
        way = [float(np.interp(t, run.t, run.way)) for t in times]
        furthest = way.index(max(way))
        back = way.index(min(way[: furthest + 1]))
        return (times[back], times[furthest]) if back < furthest else None

    caught = sorted((t, k) for k, own in enumerate(touches) for t in own)
    rows = []
    for i in np.flatnonzero(within[:-1]).tolist():
        own, after = marks(i), marks(i + 1)
        if own is None or after is None:
            continue
        before, now = ([k for t, k in caught if t <= mark] for mark in own)
        if before and len(now) > len(before) and now[-1] != before[-1]:
            rows.append(Stretch(i + 6, "impulse", *own, PALLETS[before[-1]]))
            rows.append(Stretch(i + 6, "recoil", own[1], after[0], PALLETS[now[-1]]))
    return rows


@pytest.mark.parametrize("size", [1, 100])
@pytest.mark.parametrize("seed", range(25))
def test_beats_of_hinged_pallets(seed: int, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Touches happen at rows, too."""
    rng = np.random.default_rng(seed)
    run, found, within, unknown = made(rng)
    patch(monkeypatch, hinged, unknown)
    touches = [np.sort(rng.choice(run.t, 15)).tolist() for _ in PALLETS]
    columns = dict(zip(PALLETS, touches, strict=True))
    monkeypatch.setattr(hinged, "between", lambda wheel, names: (wheel, *names))
    monkeypatch.setattr(hinged, "contact_columns", lambda run, pair, names, *kinds: [np.array(columns[pair[1]])])
    wanted = hinged_rows(run, found, within, unknown, touches)
    assert rows_of(hinged_phases(run, "wheel", PALLETS, found, within, size), size) == wanted
    assert all(one.end == after.start for one, after in pairwise(wanted) if one.beat == after.beat)
