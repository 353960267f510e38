"""Does no path within a step bend more sharply than its bound, and is its velocity its derivative?"""

from __future__ import annotations

import types
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.simulation.loop_state.scratch import COUPLED
from watchsim.simulation.motion import step_path
from watchsim.simulation.motion.dense_output import dense, dense_bend

NUMBERS = st.lists(st.floats(-1.0, 1.0), min_size=8, max_size=8)


def _step(numbers: list[float], length: float) -> types.SimpleNamespace:
    """A coupled step of one coordinate with these start value and coefficients of its continuous extension."""
    coefficients = np.array(numbers[1:]).reshape(7, 1)
    span = types.SimpleNamespace(start=0.0, length=length, kind=COUPLED)
    return types.SimpleNamespace(span=span, y0=np.array(numbers[:1]), dense=coefficients, bound=np.zeros(1))


def _plain(kernel):
    """The kernel as plain Python: one polynomial needs no compiler."""
    return getattr(kernel, "py_func", kernel)


@pytest.fixture(scope="module", autouse=True)
def plain_parts() -> Iterator[None]:
    """Plain kernels call plain ones."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(step_path, "_largest_coefficient", _plain(step_path._largest_coefficient))
        yield


def _coefficients(numbers: list[float]) -> np.polynomial.Polynomial:
    """The same polynomial of the share of the step, multiplied out."""
    x = np.polynomial.Polynomial([0.0, 1.0])
    w = 1.0 - x
    d = numbers[1:]
    inner = d[4] + w * (d[5] + x * d[6])
    return numbers[0] + x * (d[0] + w * (d[1] + x * (d[2] + w * (d[3] + x * inner))))


@given(NUMBERS, st.floats(1e-6, 1e3))
def test_the_bound_holds_everywhere_in_the_step(numbers: list[float], length: float) -> None:
    step = _step(numbers, length)
    _plain(step_path.bound_accelerations)(step, 1)
    bend = np.abs(_coefficients(numbers).deriv(2)(np.linspace(0.0, 1.0, 2001))) / length**2
    assert bend.max() <= step.bound[0] * (1.0 + 1e-9) + 1e-12 / length**2
    jerk = np.abs(_coefficients(numbers).deriv(3)(np.linspace(0.0, 1.0, 2001))) / length**3
    bound = _plain(step_path.jerk_bound)(None, types.SimpleNamespace(awake=[1]), step, 0)
    assert jerk.max() <= bound * (1.0 + 1e-9) + 1e-12 / length**3


@given(NUMBERS, st.floats(0.0, 1.0))
def test_value_and_slope_are_the_polynomials(numbers: list[float], share: float) -> None:
    value, slope = _plain(dense)(_step(numbers, 2.0), 0, 2.0 * share)
    expected = _coefficients(numbers)
    assert value == pytest.approx(expected(share), abs=1e-13)
    assert slope == pytest.approx(0.5 * expected.deriv()(share), abs=1e-12)
    bend = _plain(dense_bend)(_step(numbers, 2.0), 0, 2.0 * share)
    assert bend == pytest.approx(0.25 * expected.deriv(2)(share), abs=1e-11)


def test_the_bound_is_not_crude_for_a_smooth_path() -> None:
    """For a parabola it is exact."""
    step = _step([0.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0], 0.1)
    _plain(step_path.bound_accelerations)(step, 1)
    assert step.bound[0] == pytest.approx(1.0 / 0.01, rel=1e-12)
