"""Are the contacts in force those that a row-by-row replay of the events leaves?"""

from types import SimpleNamespace

import numpy as np
import pytest

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


@pytest.mark.parametrize("at_once", [1, 7, 64, 4096])
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
