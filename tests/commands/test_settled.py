"""Is what one process passes at the end of a run, with what the other one holds, the whole run?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from watchsim.commands.second import settled as module
from watchsim.commands.second.settled import Passed, Settled
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate

COLUMNS = ("t", "q", "u", "a", "events")


@pytest.mark.parametrize("most", [64e6, 2e5, 0.0])
@pytest.mark.parametrize("record", ["all", "events", "statistics", "every 3", ["0.1 s", "0.2 s"]])
def test_both_parts_are_the_run(record: object, most: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST", most)
    monkeypatch.setattr("watchsim.simulation.runner.EVENTS", 20)
    monkeypatch.setattr("watchsim.simulation.runner.ROWS", 100)
    passed, settled = Passed(), Settled()

    def follow(_: object, events: NDArray[Any], rows: Sequence[NDArray[Any]]) -> None:
        passed.add(events, rows)
        settled.add(events, rows)

    run = simulate(load(profiles_dir() / "bench_lever").set("run.record", [record]), 4.5, follow=follow)
    rest = passed.rest(run)
    settles = record != "statistics" and settled.is_held  # statistics keep the last seconds only
    assert (len(rest.events) < len(run.events)) is settles
    whole = settled.whole(rest)
    for name in COLUMNS:
        assert np.array_equal(getattr(whole, name), getattr(run, name))
    assert whole.pairs is run.pairs and whole.energy == run.energy


def test_a_run_that_nobody_followed() -> None:
    run = simulate(load(profiles_dir() / "incline"), 0.1)
    assert Settled().whole(Passed().rest(run)).t.tolist() == run.t.tolist()
