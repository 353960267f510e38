"""Does a recorded motion tell where everything is at any time, not only at its rows?"""

from __future__ import annotations

import numpy as np
import pytest
from every_time import few
from moving_scenes import profile

from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate

RATE = 25.0  # 1/s, of the balance, which swings through some radians: slower speeds are compared with it


def middles(run: Trajectory, many: int) -> np.ndarray:
    """Times between rows, in the longest gaps and all over; none where an event has cut a step to nothing."""
    gaps = np.diff(run.t)
    wide, everywhere = np.argsort(gaps)[-many:], np.linspace(0, len(gaps) - 1, 4 * many).astype(int)
    chosen = np.unique([k for k in (*wide, *everywhere) if gaps[k] > 1e-7])
    return run.t[chosen] + np.random.default_rng(3).uniform(0.2, 0.8, len(chosen)) * gaps[chosen]


@pytest.mark.parametrize("tolerance", few([1e-8, 1e-10, 1e-12], lambda tolerance: tolerance == 1e-10))
def test_between_rows_the_motion_is_that_of_a_run_which_ends_there(tolerance: float) -> None:
    """A run that ends at that time gets there by a step of its own: its end is the integrator's answer."""
    scene = profile("bench_lever")
    whole = simulate(scene, 0.2, tolerance)
    times = middles(whole, 8)
    assert len(times) > 20
    compared = 0
    for t in times:
        there = simulate(scene, float(t), tolerance)
        # Whether a rebound of 1e-15 m/s is ended by rule is a matter of rounding, and decides about what follows.
        if not np.array_equal(there.events["kind"], whole.events["kind"][whole.events["t"] <= t]):
            continue
        compared += 1
        q, u = whole.at(float(t))
        assert q == pytest.approx(there.end_q, rel=3.0 * tolerance, abs=3.0 * tolerance)
        # An event may lie a tolerance earlier in one of the runs: what accelerates there differs by that much.
        allowed = tolerance * (60.0 * np.maximum(np.abs(u), RATE) + 3.0 * np.abs(there.a[-1]) / RATE)
        assert np.all(np.abs(u - there.end_u) <= allowed)
    assert compared > 0.8 * len(times)
