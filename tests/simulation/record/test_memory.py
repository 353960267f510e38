"""Does memory stay flat where only statistics are kept?"""

from __future__ import annotations

import gc
import tracemalloc

import pytest
from moving_scenes import profile

from watchsim.simulation.simulate import simulate


def most_memory(duration: float) -> tuple[int, int]:
    """Bytes: the most that was in use during a run, and what its result holds on to."""
    gc.collect()
    tracemalloc.start()
    done = simulate(profile("swiss_lever"), duration, record="statistics")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert done.simulated == duration
    return most, done.t.nbytes + done.q.nbytes + done.events.nbytes


@pytest.mark.parametrize(("short", "long"), [(20.0, 60.0), pytest.param(600.0, 3600.0, marks=pytest.mark.slow)])
def test_statistics_of_a_long_run_need_no_more_memory(short: float, long: float) -> None:
    simulate(profile("swiss_lever"), short, record="statistics")  # loads, and asks about the cells
    before, after = most_memory(short), most_memory(long)
    assert after[0] < 1.5 * before[0]  # the peak moves by a fifth with where the buffers are emptied
    assert after[1] == pytest.approx(before[1], rel=0.1)
