"""Does a gear train's mean speed depend on the arcs its flanks are drawn with?"""

from __future__ import annotations

import itertools

import pytest
from gear_scenes import TEETH, contact_ratio, gear_scene, train
from mean_speed import mean_speed, tooth_times
from reference.gear_friction import FASTEST, SLOWEST
from reference.gear_friction import mean_speed as exact_speed

from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

SHORT = 0.215  # modules off the tips: one pair of teeth at a time


def speed(arcs: int, friction: float, cut: float = 0.0, tolerance: float = 1e-9, duration: float = 0.2) -> float:
    run = simulate(gear_scene(arcs, friction, cut=cut), duration, tolerance=tolerance)
    assert run.stop == Stop.DURATION
    assert abs(run.energy["residual_relative"]) < 1e-6
    return mean_speed(run, 1, TEETH[1], 0.12)


def test_without_friction_the_speed_is_that_of_exact_involutes() -> None:
    assert speed(6, 0.0) == pytest.approx(exact_speed(train(0.0), FASTEST), rel=1e-4)


def test_one_pair_of_teeth_with_friction_turns_as_exact_involutes_do() -> None:
    assert contact_ratio(SHORT) == pytest.approx(1.0, abs=1e-4)
    assert speed(10, 0.1, SHORT) == pytest.approx(exact_speed(train(0.1, SHORT), SLOWEST), rel=1e-3)


def test_two_pairs_of_teeth_share_within_what_the_laws_leave_open() -> None:
    low, high = (exact_speed(train(0.1), share) for share in (SLOWEST, FASTEST))
    assert low < speed(6, 0.1) < high


@pytest.mark.slow
@pytest.mark.parametrize("arcs", [6, 10, 20])
def test_the_speed_does_not_depend_on_the_tolerance(arcs: int) -> None:
    speeds = [speed(arcs, 0.1, tolerance=tolerance) for tolerance in (1e-7, 1e-9, 1e-11)]
    assert max(speeds) / min(speeds) < 1.0 + 1e-5


@pytest.mark.slow
def test_one_tooth_is_like_the_next() -> None:
    run = simulate(gear_scene(10, 0.1), 0.3)
    times = tooth_times(run, 1, TEETH[1], 0.2)
    lasted = [b - a for a, b in itertools.pairwise(times)]
    assert max(lasted) / min(lasted) < 1.0 + 1e-7
