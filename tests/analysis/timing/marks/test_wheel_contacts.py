"""Are the contact events of the wheel those of the table, near the beats that are asked for, on what the pairs say?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing.marks import wheel_contacts as module
from watchsim.analysis.timing.marks.stretches import FACES, NAMES, Stretch, gathered, in_columns
from watchsim.analysis.timing.marks.wheel_contacts import wheel_contacts
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind

BEATS = 8
ENDS = [("wheel", "lever"), ("lever", "wheel"), ("balance", "wheel"), ("wheel", "balance"), ("banking", "lever")]
ENDS += [("lever", "stop"), ("lever", "balance"), ("wheel", "banking")]
ON = {0: "stone", 1: "tooth", 2: "balance", 3: "balance", 7: "stone"}  # the second holds the line or the rounder arc
PARTS: Any = SimpleNamespace(oscillator="balance", wheel="wheel", lever="lever")


def made(seed: int) -> tuple[Any, Any, np.ndarray]:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 90))
    events = np.zeros(count, EVENT_DTYPE)
    events["t"], events["kind"] = np.sort(rng.integers(0, 44, count)) / 4.0, rng.integers(1, 9, count)
    events["contact"] = rng.integers(0, len(ENDS), count)
    bodies = [SimpleNamespace(name=name, motion="pivot") for name in ("wheel", "lever", "balance")]
    bodies += [SimpleNamespace(name=name, motion="fixed") for name in ("banking", "stop")]
    pairs = [SimpleNamespace(body_a=a, body_b=b) for a, b in ENDS]
    run = SimpleNamespace(events=events, pairs=pairs, scene=SimpleNamespace(bodies=bodies))
    run.spans = [(), ((0.0, 11.0),), ((0.0, 3.0), (3.75, 11.0))][seed % 3]
    turns = 1.5 + np.arange(BEATS + 1.0)

    class Found(SimpleNamespace):
        def __len__(self) -> int:
            return BEATS

    return run, Found(start=turns[:-1], end=turns[1:]), rng.random(BEATS) < 0.3


@pytest.mark.parametrize("seed", range(40))
def test_events_of_the_wheel_near_some_beats(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """From the last before the first of the beats on, but not before the run's first beat, until the second after them."""
    run, found, within = made(seed)
    monkeypatch.setattr(module, "progress", lambda run, wheel, times: {"wheel": 10.0 * times}[wheel])
    got = wheel_contacts(run, PARTS, found, within)
    touch = (EventKind.IMPACT, EventKind.CLOSE)
    table = list(zip(*(run.events[name].tolist() for name in ("t", "kind", "contact")), strict=True))
    own = [row for row in table if "wheel" in ENDS[row[2]] and row[1] in (*touch, EventKind.OPEN)]
    begins = [start for start, _ in run.spans[1:]]
    holding = []
    for low, high in zip([-1.0, *begins], [*begins, 99.0], strict=True):
        some = [{EventKind.CLOSE: 1, EventKind.OPEN: -1}.get(kind, 0) for t, kind, _ in own if low <= t < high]
        holding += (np.cumsum(some) - min([0, *np.cumsum(some).tolist()])).astype(int).tolist()
    asked = np.flatnonzero(within).tolist()
    near: list[int] = []
    if asked:
        begin, end = found.start[asked[0]], found.end[min(asked[-1] + 2, BEATS - 1)]
        before = [k for k, row in enumerate(own) if row[0] < begin and row[0] >= found.start[0]]
        near = before[-1:] + [k for k, row in enumerate(own) if begin <= row[0] < end]
    assert got.times.tolist() == [own[k][0] for k in near] and got.angle.tolist() == [10.0 * own[k][0] for k in near]
    assert got.held.tolist() == [holding[k] for k in near]
    assert got.touching.tolist() == [own[k][1] in touch for k in near]
    assert [FACES[code] for code in got.on] == [ON[own[k][2]] for k in near]
    banks = [row[0] for row in table if row[2] in (4, 5) and row[1] in touch]
    assert got.banking.tolist() == banks


def test_columns_of_phases_are_their_rows() -> None:
    """Words that are no face get numbers of their own; rows are chosen."""
    rows = [Stretch(3, "unlock", 1.0, 1.5), Stretch(3, "impulse", 1.5, 2.0, "exit"), Stretch(3, "recoil", 2.0, 2.5, "entry")]
    rows += [Stretch(5, "impulse", 3.0, 3.25, "tooth"), Stretch(6, "drop", 4.0, 4.5), Stretch(6, "locked", 4.5, 5.0)]
    made = in_columns(rows)
    assert (made.names, made.faces) == ([row.name for row in rows], [row.on for row in rows])
    assert made.beat.tolist() == [row.beat for row in rows] and made.first.tolist() == [0, 3, 4]
    assert made.start.tolist() == [row.start for row in rows] and made.end.tolist() == [row.end for row in rows]
    assert made.words == (*FACES, "entry", "exit") and [NAMES[code] for code in made.name] == made.names
    some = made[np.array([False, True, True, False, True, False])]
    assert (some.beat.tolist(), some.faces) == ([3, 3, 6], ["exit", "entry", ""])


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_so_many_beats_at_a_time(size: int) -> None:
    beats = [[Stretch(k, "drop", float(k), k + 0.5)] * (1 + k % 2) for k in range(3)]
    parts = list(gathered(iter(beats), size))
    assert [part.beat.tolist() for part in parts] == [
        [row.beat for some in beats[k : k + size] for row in some] for k in range(0, 3, size)
    ]
