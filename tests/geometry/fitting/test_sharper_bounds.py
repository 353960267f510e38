"""Which intervals are halved so that a bound becomes sharp? Lines beside straight arcs, of weights that grow evenly."""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.geometry.biarcs import ArcChain, Bundle, Curve, deviations


def bounds(heaviest: float, *beside: float, group: list[int]) -> list[float]:
    """Of lines so far beside their arcs; their weights grow from 1, the bound is too large by their ratio squared."""
    w, n = np.array([1.0, 0.5 + 0.5 * heaviest, heaviest]), len(beside)
    x = np.array([1.0, 2.0, 4.0])
    curves = [Curve(np.column_stack((x * w, off * w, w))[None], np.array([0.0, 1.0])) for off in beside]
    way, places = np.array([(1.0, 0.0)] * n), np.arange(0.0, 2.0 * n, 2.0)
    arcs = ArcChain(np.array([(1.0, 0.0)] * n), way, np.array([(4.0, 0.0)] * n), way, np.zeros(n))
    found: list[float] = deviations(Bundle(curves), places, places + 1.0, arcs, np.array(group)).tolist()
    return found


def test_an_interval_is_halved_six_times_at_most() -> None:
    """Of the 64 parts the first has the most unequal weights."""
    assert bounds(2.0, 1e-6, group=[0]) == pytest.approx([1e-6 * (65.0 / 64.0) ** 2], rel=1e-6, abs=0.0)


@pytest.mark.parametrize(("slack", "halved"), [(0.0098, False), (0.0102, True)])
def test_an_interval_is_halved_where_its_bound_may_be_a_hundredth_too_large(slack: float, halved: bool) -> None:
    heaviest = (1.0 - slack) ** -0.5
    expected = (0.5 + 0.5 * heaviest) ** 2 if halved else heaviest**2
    assert bounds(heaviest, 1e-6, group=[0]) == pytest.approx([1e-6 * expected], rel=1e-6, abs=0.0)


def test_what_is_surely_not_the_largest_of_its_group_is_not_looked_at_closely() -> None:
    sharp = (65.0 / 64.0) ** 2
    assert bounds(2.0, 1e-6, 1e-4, group=[0, 0]) == pytest.approx([4e-6, 1e-4 * sharp], rel=1e-6, abs=0.0)
    assert bounds(2.0, 1e-6, 1e-4, group=[0, 1]) == pytest.approx([1e-6 * sharp, 1e-4 * sharp], rel=1e-6, abs=0.0)
    assert bounds(2.0, 1e-6, 3e-6, group=[1, 1])[1] == pytest.approx(3e-6 * sharp, rel=1e-6, abs=0.0)
