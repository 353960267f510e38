"""Is the fixed point found that the orbit runs to, on maps whose fixed points are known in closed form?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.studies.return_map import Fixed, Lost, Return, fixed_point


def returning(function, good=lambda a: True):
    """A return map of that function, with trouble where `good` is false."""

    def oscillate(amplitude):
        trouble = "" if good(amplitude) else "knocks"
        return Return(function(amplitude), 0.25, trouble, None, np.zeros(0))

    return oscillate


@given(st.floats(0.5, 9.0), st.floats(20.0, 1e4), st.floats(0.3, 9.0))
def test_constant_work_per_beat(rest, quality, start):
    """E' = E e^(-4π/Q) + w in one oscillation: A* = √(w / (1 - e^(-4π/Q)))."""
    kept = math.exp(-2.0 * math.pi / quality)
    found = fixed_point(returning(lambda a: math.sqrt(a * a * kept + rest * rest * (1.0 - kept))), start)
    assert isinstance(found, Fixed)
    # What the search leaves of one return, a share of where it began, over as many returns as a disturbance lives.
    assert found.amplitude == pytest.approx(rest, rel=1e-14 * quality * max(1.0, start / rest) + 1e-12, abs=0.0)
    if abs(start - rest) > 1e-3:
        assert found.slope == pytest.approx(kept, abs=0.05)


def test_the_nearest_stable_one_on_the_way_is_found():
    """a' = a - 0.1 (a-1)(a-2)(a-3): 1 and 3 attract, 2 repels."""

    def cubic(a):
        return a - 0.1 * (a - 1.0) * (a - 2.0) * (a - 3.0)

    assert fixed_point(returning(cubic), 1.9).amplitude == pytest.approx(1.0, abs=1e-12)
    assert fixed_point(returning(cubic), 2.1).amplitude == pytest.approx(3.0, abs=1e-12)


def test_an_oscillating_approach():
    """A multiplier below 0, and one below -1: the fixed point is found all the same, to be called unstable afterwards."""
    for slope in (-0.7, -1.6):
        found = fixed_point(returning(lambda a, m=slope: 3.0 + m * (a - 3.0) - 0.02 * (a - 3.0) ** 3), 3.3)
        assert isinstance(found, Fixed)
        assert found.amplitude == pytest.approx(3.0, abs=1e-12)
        assert found.slope == pytest.approx(slope, abs=0.05)


@pytest.mark.parametrize("edge, start, rising", [(5.0, 4.0, True), (2.0, 2.9, False)])
def test_the_edge_of_regular_work_is_told(edge, start, rising):
    """The orbit leaves the region before it comes to a fixed point: at 6 above the edge 5, at 1 below the edge 2."""
    target = 6.0 if rising else 1.0
    inside = (lambda a: a < edge) if rising else (lambda a: a > edge)
    found = fixed_point(returning(lambda a: target + 0.97 * (a - target), inside), start)
    assert isinstance(found, Lost)
    assert found.rising is rising
    assert found.trouble == "knocks"
    assert found.amplitude == pytest.approx(edge, rel=0.01)


def test_a_newton_step_past_the_edge_comes_back():
    """Newton's first step overshoots into trouble; the fixed point lies short of it."""
    found = fixed_point(returning(lambda a: a + 0.05 * math.tanh(40.0 * (3.0 - a)), lambda a: a < 3.1), 2.0)
    assert isinstance(found, Fixed)
    assert found.amplitude == pytest.approx(3.0, abs=1e-11)


def test_a_swing_that_dies_away():
    found = fixed_point(returning(lambda a: 0.9 * a), 1.0)
    assert isinstance(found, Lost)
    assert not found.rising


def test_trouble_from_the_first_oscillation():
    found = fixed_point(returning(lambda a: a, lambda a: False), 1.0)
    assert isinstance(found, Lost)
    assert found.amplitude == 1.0
