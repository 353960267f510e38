"""Are the modes at any times those that the events of a run say?"""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.modes_in_force import change, modes_in_force
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.storage.columns import blocks


@pytest.mark.parametrize("at_once", [7, 1000])
def test_modes_from_the_last_events_are_those_of_all_events(at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever came before, handovers from one contact to the next included, however many events are looked at at once."""
    monkeypatch.setattr("watchsim.analysis.modes_in_force.blocks", partial(blocks, length=at_once))
    rng = np.random.default_rng(4)
    kinds = [EventKind.CLOSE, EventKind.OPEN, EventKind.STICK, EventKind.SLIDE, EventKind.HANDOVER]
    for _ in range(20):
        events = np.zeros(120, EVENT_DTYPE)
        events["t"] = np.sort(rng.integers(0, 40, 120))
        events["kind"] = rng.choice(kinds, 120)
        events["contact"] = rng.integers(0, 5, 120)
        other = (events["contact"] + rng.integers(1, 5, 120)) % 5
        events["value"] = np.where(events["kind"] == EventKind.HANDOVER, other, rng.choice([-1.0, 1.0], 120))
        run: Any = SimpleNamespace(events=events)
        times = rng.permutation(rng.choice(np.arange(-1.0, 42.0), 9))
        found = modes_in_force(run, times)
        told = {place: in_force for in_force, places in found.items() for place in places}
        assert sorted(place for places in found.values() for place in places) == list(range(9))
        assert all((np.diff(times[places]) >= 0.0).all() for places in found.values())
        for place, time in enumerate(times):
            modes: dict[int, int] = {}
            for event in events[events["t"] <= time]:
                change(modes, int(event["kind"]), int(event["contact"]), event["value"])
            assert told[place] == tuple(sorted(modes.items()))
