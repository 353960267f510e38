"""What is zero in a scene of a given size, at a given tolerance? The numbers of docs/theory/method.md, worked out."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from watchsim.simulation.options import natural_step, options_for

SIZE = 3.0  # m


def test_lengths_and_speeds_go_with_the_size_of_the_scene() -> None:
    found = options_for(SIZE, 1e-9, 0.25)
    expected = {
        "tolerance": 1e-9,
        "gap_zero": 3e-13,
        "gap_close": 6e-10,
        "behind": 6e-8,
        "sunk": 6e-5,
        "extent": 3.6e-10,
        "speed_zero": 6e-8,
        "force_zero": 1e-10,
        "accumulation_time": 1e-6,
        "accumulation_speed": 0.3,
        "sleep": 1e-9,
        "row_phase": 0.1,
        "max_step": 0.25,
        "size": SIZE,
    }
    assert found._asdict() == pytest.approx(expected, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("tolerance", "behind", "speed", "phase"),
    [
        (1e-13, 2e-8, 1e-8, 0.1 * 1e-4**0.2),
        (4e-10, 2e-8, 1e-8, 0.1 * 0.4**0.2),
        (6e-10, 2e-8, 1.2e-8, 0.1 * 0.6**0.2),
        (2e-9, 4e-8, 4e-8, 0.1),
        (1e-7, 2e-6, 2e-6, 0.1),
        (2e-6, 2e-5, 4e-5, 0.1),
    ],
)
def test_what_lies_behind_and_what_is_slow_goes_with_the_tolerance_within_limits(
    tolerance: float, behind: float, speed: float, phase: float
) -> None:
    found = options_for(SIZE, tolerance, 0.25)
    assert (found.behind / SIZE, found.speed_zero / SIZE, found.row_phase) == pytest.approx(
        (behind, speed, phase), rel=1e-12, abs=0.0
    )
    assert found.gap_close == pytest.approx(6e-10, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("fastest", "step"), [(0.0, 0.25), (4.0, 0.25), (8.0, math.pi / 16.0)])
def test_the_longest_step_is_a_quarter_of_the_fastest_period(fastest: float, step: float) -> None:
    assert natural_step(SimpleNamespace(fastest=fastest), 0.25) == pytest.approx(step)  # type: ignore[arg-type]
