"""Is the first step in a mode tried with the length it deserved the last time, and as exact as before?"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from moving_scenes import profile

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.simulation.simulate import simulate


def turns(run: Trajectory) -> Array:
    """Places of the turning points, rad."""
    return np.array(run.events["value"][run.events["kind"] == EventKind.TURN])


@pytest.mark.parametrize("name, share", [("swiss_lever", 0.1), ("bench_lever", 0.15)])
def test_few_steps_are_rejected_once_the_modes_are_known(name: str, share: float) -> None:
    """Tried with the length of the step before, three of ten are."""
    begun, run = simulate(profile(name), 2.0), simulate(profile(name), 4.0)
    steps, rejected = (run.counts[count] - begun.counts[count] for count in ("steps", "rejected_steps"))
    assert rejected < share * steps


@pytest.mark.parametrize("name", ["swiss_lever", "bench_lever"])
def test_turning_points_are_those_of_the_tightest_tolerance(name: str) -> None:
    exact, usual = turns(simulate(profile(name), 3.0, 1e-12)), turns(simulate(profile(name), 3.0))
    assert np.abs(np.degrees(usual - exact)).max() < 1e-6


def test_a_state_saved_before_lengths_were_remembered_can_be_gone_on_from() -> None:
    scene = profile("bench_lever")
    half, whole = simulate(scene, 0.5), simulate(scene, 1.0)
    assert half.end_state is not None
    known = half.end_state.arrays["first"]
    assert np.count_nonzero(known) > 2, "nothing was remembered"
    arrays = {name: array for name, array in half.end_state.arrays.items() if name != "first"}
    later = simulate(scene, 1.0, start=dataclasses.replace(half.end_state, arrays=arrays))
    assert np.abs(np.degrees(turns(later) - turns(whole)[-len(turns(later)) :])).max() < 1e-6
