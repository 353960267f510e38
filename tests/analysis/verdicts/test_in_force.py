"""Are the contacts in force those that a row-by-row replay of the events leaves?"""

from types import SimpleNamespace

import numpy as np
import pytest
from every_time import few

from watchsim.analysis.verdicts.equilibrium import in_force as module
from watchsim.analysis.verdicts.equilibrium.in_force import in_force
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind

KINDS = (EventKind.CLOSE, EventKind.OPEN, EventKind.HANDOVER, EventKind.IMPACT)


def replayed(events: np.ndarray, t: float) -> list[int]:
    holding: dict[int, None] = {}
    for event in events[events["t"] <= t]:
        if event["kind"] == EventKind.OPEN:
            holding.pop(int(event["contact"]), None)
        elif event["kind"] in (EventKind.CLOSE, EventKind.HANDOVER):
            if event["kind"] == EventKind.HANDOVER:
                holding.pop(int(event["value"]), None)
            holding[int(event["contact"])] = None
    return list(holding)


@pytest.mark.parametrize("at_once", few([7, 1, 64, 4096], 1))
def test_contacts_in_force_are_those_of_a_replay(monkeypatch: pytest.MonkeyPatch, at_once: int) -> None:
    monkeypatch.setattr(module, "AT_ONCE", at_once)
    rng = np.random.default_rng(at_once)
    for _ in range(20):
        events = np.zeros(rng.integers(0, 300), EVENT_DTYPE)
        events["t"] = np.sort(rng.integers(0, 60, len(events)))  # several at one instant
        events["kind"], events["contact"] = rng.choice(KINDS, len(events)), rng.integers(0, 9, len(events))
        events["value"] = np.where(events["kind"] == EventKind.HANDOVER, rng.integers(0, 9, len(events)), np.nan)
        times = sorted(rng.uniform(-5.0, 65.0, 12).tolist() + rng.integers(0, 60, 6).tolist())
        found = in_force(SimpleNamespace(events=events), times)
        assert found == [replayed(events, t) for t in times]


@pytest.mark.parametrize("at_once", [1, 2, 3, 100])
def test_of_a_few_events(monkeypatch: pytest.MonkeyPatch, at_once: int) -> None:
    """3 and 5 close, 3 hands over to 7, 5 opens and closes again, 7 opens; impacts change nothing. In the order they came."""
    monkeypatch.setattr(module, "AT_ONCE", at_once)
    events = np.zeros(8, EVENT_DTYPE)
    events["t"] = [1.0, 1.5, 1.5, 2.0, 2.5, 3.0, 3.0, 4.0]
    kinds = [EventKind.CLOSE, EventKind.IMPACT, EventKind.CLOSE, EventKind.HANDOVER, EventKind.IMPACT]
    events["kind"] = [*kinds, EventKind.OPEN, EventKind.CLOSE, EventKind.OPEN]
    events["contact"], events["value"] = [3, 5, 5, 7, 3, 5, 5, 7], [0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0]
    times = [0.5, 1.0, 1.5, 1.9, 2.0, 2.7, 3.5, 4.0, 9.0]
    found = in_force(SimpleNamespace(events=events), times)
    assert found == [[], [3], [3, 5], [3, 5], [5, 7], [5, 7], [7, 5], [5], [5]]
    assert in_force(SimpleNamespace(events=events[:0]), [1.0, 2.0]) == [[], []]
