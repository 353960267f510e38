"""Are the events and contacts of a body those that loops over the whole table find?"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing import body_contacts as module
from watchsim.analysis.timing.body_contacts import (
    between,
    contact_columns,
    contact_events,
    contact_numbers,
    held,
    holding_at_end,
    involves,
)
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.storage.columns import blocks

BODIES = ("wheel", "lever", "balance", "banking")
PAIRS = [SimpleNamespace(body_a=a, body_b=b) for a, b in product(BODIES, BODIES) if a != b]
WANTED = [involves("wheel"), involves("lever", "banking"), involves(), between("lever", {"wheel", "banking"})]


def run_of(seed: int, count: int = 60) -> Any:
    """Events of contacts and of bodies; of the last contacts there are none."""
    rng = np.random.default_rng(seed)
    events = np.zeros(count, EVENT_DTYPE)
    events["t"], events["kind"] = np.sort(rng.integers(0, 20, count)), rng.integers(1, 11, count)
    events["contact"] = rng.integers(0, len(PAIRS) - 3, count)
    events["value"] = (events["contact"] + rng.integers(1, 5, count)) % (len(PAIRS) - 3)
    events["contact"][np.isin(events["kind"], (EventKind.TURN, EventKind.CROSS))] = -1
    return SimpleNamespace(events=events, pairs=PAIRS)


def wanted_rows(run: Any, wanted: Callable[[Any], bool], kinds: tuple[EventKind, ...]) -> list[int]:
    rows = enumerate(zip(run.events["contact"].tolist(), run.events["kind"].tolist(), strict=True))
    return [k for k, (contact, kind) in rows if contact >= 0 and wanted(PAIRS[contact]) and (not kinds or kind in kinds)]


@pytest.mark.parametrize("at_once", [7, 1000])
@pytest.mark.parametrize("kinds", [(), (EventKind.IMPACT,), (EventKind.JAM,), (EventKind.CLOSE, EventKind.OPEN)])
def test_events_of_wanted_pairs(kinds: tuple[EventKind, ...], at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "blocks", partial(blocks, length=at_once))
    for seed, wanted in product(range(5), WANTED):
        run = run_of(seed)
        rows = wanted_rows(run, wanted, kinds)
        assert contact_events(run, wanted, *kinds).tolist() == run.events[rows].tolist()
        t, value = contact_columns(run, wanted, ["t", "value"], *kinds)
        assert t.tolist() == run.events["t"][rows].tolist() and value.tolist() == run.events["value"][rows].tolist()
        assert contact_numbers(run, wanted) == {int(run.events["contact"][k]) for k in wanted_rows(run, wanted, ())}


def test_without_events_there_are_none() -> None:
    run = run_of(0, 0)
    assert len(contact_events(run, WANTED[0])) == 0 and contact_numbers(run, WANTED[0]) == set()
    assert [len(column) for column in contact_columns(run, WANTED[0], ["t", "kind"])] == [0, 0]


@pytest.mark.parametrize("pair", PAIRS)
def test_pairs_on_either_side(pair: Any) -> None:
    both = {pair.body_a, pair.body_b}
    assert involves("wheel")(pair) is ("wheel" in both) and involves("lever", "wheel")(pair) is bool({"lever", "wheel"} & both)
    for first, others in (("lever", {"wheel"}), ("lever", {"wheel", "balance"}), ("banking", {"banking", "lever"})):
        assert between(first, others)(pair) is any(both == {first, other} for other in others)


@pytest.mark.parametrize("seed", range(20))
def test_how_many_hold_after_each_event(seed: int) -> None:
    """In every stretch that was recorded the smallest count is none, also where its first events only let go."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(0, 30))
    times = np.sort(rng.integers(0, 12, count) / 2.0)
    kinds = rng.choice([EventKind.CLOSE, EventKind.OPEN, EventKind.IMPACT], count)
    spans = [(), ((0.0, 9.0),), ((0.0, 1.9), (2.0, 4.0)), ((0.0, 1.0), (1.5, 2.0), (4.5, 6.0))][seed % 4]
    wanted: list[int] = []
    begins = [start for start, _ in spans[1:]]
    for low, high in zip([-1.0, *begins], [*begins, 99.0], strict=True):
        now, counts = 0, []
        for t, kind in zip(times.tolist(), kinds.tolist(), strict=True):
            if low <= t < high:
                now += {EventKind.CLOSE: 1, EventKind.OPEN: -1}.get(EventKind(kind), 0)
                counts.append(now)
        wanted += [one - min(0, *counts) for one in counts]
    assert held(times, kinds, spans).tolist() == wanted


@pytest.mark.parametrize("at_once", [5, 1000])
@pytest.mark.parametrize("seed", range(8))
def test_what_holds_at_the_end(seed: int, at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of each contact its last closing or opening counts; handed over, the one before no longer holds."""
    monkeypatch.setattr(module, "blocks", partial(blocks, length=at_once))
    run = run_of(seed, 25)
    holding = dict.fromkeys(range(len(PAIRS)), False)
    for event in run.events:
        if event["kind"] == EventKind.HANDOVER:
            holding[int(event["value"])] = False
        if event["kind"] in (EventKind.CLOSE, EventKind.HANDOVER, EventKind.OPEN):
            holding[int(event["contact"])] = event["kind"] != EventKind.OPEN
    found = holding_at_end(run)
    assert len(found) == sum(holding.values())
    assert all(any(pair is PAIRS[k] for pair in found) for k, holds in holding.items() if holds)
