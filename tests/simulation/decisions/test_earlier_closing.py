"""When does a contact close that ends a step, once drift is taken back? Gaps here are polynomials of time."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.accepted_step import NEWTON_STEPS, _follow_to_touch

END = 2.0
KINETIC = 7.0  # J, before drift is taken back, at the end of the step


def follow(*gap: float) -> tuple[tuple[float, float], list[float]]:
    """(time, energy) where a gap with these coefficients (m, m/s, ...) closes, and the other times looked at."""
    now = [END]
    looked: list[float] = []

    def follow_step(model, state, options, tau, scratch):
        now[0] = tau
        looked.append(tau)
        return 10.0 * tau

    def normal_gap(model, k, pose):
        series = np.polynomial.Polynomial(gap)
        return SimpleNamespace(gap=series(now[0]), rate=series.deriv()(now[0]))

    kernel = in_python(_follow_to_touch, _follow_step=follow_step, normal_gap=normal_gap, place=lambda *_: None)
    scratch = SimpleNamespace(smooth=SimpleNamespace(pose=None))
    state = SimpleNamespace(q=None, u=None)
    found = kernel(None, state, SimpleNamespace(gap_zero=1e-13), (END, KINETIC), 3, scratch)
    assert now[0] == found[0]  # the state is where it is said to be
    return found, looked


def test_a_gap_that_has_closed_at_the_end_is_followed_no_further() -> None:
    assert follow(1.0, -0.5) == ((END, KINETIC), [])


def test_a_gap_that_is_open_at_the_end_closes_there_without_another_look() -> None:
    assert follow(1.0 + 1e-9, -0.5) == ((END, KINETIC), [])


@pytest.mark.parametrize("rate", [0.0, 0.3])
def test_a_gap_that_opens_at_the_end_closes_there_without_another_look(rate: float) -> None:
    assert follow(-1e-6 - rate * END, rate) == ((END, KINETIC), [])


def test_an_earlier_closing_is_found_where_a_line_falls_through_zero() -> None:
    assert follow(1.0, -0.8) == ((pytest.approx(1.25, rel=1e-15), pytest.approx(12.5)), [pytest.approx(1.25, rel=1e-15)])


def test_a_curved_gap_is_followed_to_its_root() -> None:
    (time, kinetic), looked = follow(1.0, 0.0, -0.5)
    assert time == pytest.approx(np.sqrt(2.0), abs=1e-12)
    assert kinetic == 10.0 * time
    assert 1 < len(looked) <= NEWTON_STEPS


def test_where_the_way_back_leads_before_the_step_the_end_stays() -> None:
    """Falling all the time from below zero: it was closed before the step began."""
    assert follow(-1.0, -0.1) == ((END, KINETIC), [])


def test_where_the_search_turns_round_the_step_is_followed_to_its_end_again() -> None:
    """A first tangent leads to where the gap is negative and opens: no closing from there."""
    (time, kinetic), looked = follow(-1.855, 1.9, -0.5)
    assert (time, kinetic) == (END, KINETIC)
    assert looked == [pytest.approx(1.45), END]
