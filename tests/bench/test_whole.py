"""Are whole runs timed from the drawing on, and is what was learnt the first time known the second?"""

from __future__ import annotations

import dataclasses
import time

import pytest

from watchsim.bench.scenarios import scenarios
from watchsim.bench.wall_clock import whole
from watchsim.candidates import pair_cache
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU


@pytest.mark.parametrize(("method", "setting"), [(EVENT_DRIVEN, 1e-9), (MOREAU, 1e-4)])
def test_both_runs_are_timed(method: str, setting: float) -> None:
    settled = next(one for one in scenarios() if one.name == "bench_lever, settled")
    assert settled.window == (13.0, 15.0) and settled.duration == 15.0
    begun = time.perf_counter()
    found = whole(dataclasses.replace(settled, duration=0.3), method, setting)
    taken = time.perf_counter() - begun
    times = (found.first_ready, found.first_stepping, found.again_ready, found.again_stepping)
    assert all(seconds > 0.0 for seconds in times) and sum(times) <= taken
    assert (found.scene, found.method, found.simulated) == ("bench_lever, settled", method, 0.3)


def test_the_first_run_knows_no_cell() -> None:
    settled = next(one for one in scenarios() if one.name == "bench_lever, settled")
    short = dataclasses.replace(settled, duration=0.05)
    whole(short, EVENT_DRIVEN, 1e-9)
    after = {key: len(one) for key, one in pair_cache._store.items()}
    whole(dataclasses.replace(settled, duration=0.02), EVENT_DRIVEN, 1e-9)
    assert sum(len(one) for one in pair_cache._store.values()) <= sum(after.values())


def test_a_scene_without_a_file_cannot_be_read() -> None:
    settled = next(one for one in scenarios() if one.name == "bench_lever, settled")
    made = dataclasses.replace(settled, scene=dataclasses.replace(settled.scene, path=None))
    with pytest.raises(ValueError, match="has no scene file to be read"):
        whole(made, EVENT_DRIVEN, 1e-9)
