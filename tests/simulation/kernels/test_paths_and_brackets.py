"""How is a root closed in, evaluation by evaluation, and where is everything on the path of a step? By hand and by numpy."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_up import named
from numpy.polynomial import Polynomial
from plain_kernels import in_python

from watchsim.model.records import FIXED, FREE, PIVOT
from watchsim.simulation.loop_state.scratch import COUPLED, FLIGHT
from watchsim.simulation.motion import dense_output, root_bracket, step_path
from watchsim.simulation.motion.root_bracket import HIGH, LOW, MOST, NEITHER, Bracket


def bracket(**changed: float) -> Bracket:
    given = {"low": 2.0, "f_low": 3.0, "high": 6.0, "f_high": -1.0, "moved": NEITHER, "looks": 1, "before": 9.0, **changed}
    return Bracket(**given)  # type: ignore[arg-type]


def test_a_bracket_begins_with_its_ends() -> None:
    found = in_python(root_bracket.opened)(2.0, 3.0, 6.0, -1.0)
    assert found == (2.0, 3.0, 6.0, -1.0, NEITHER, 0, 8.0)


@pytest.mark.parametrize(("changed", "time"), [
    ({}, 5.0),  # where the chord is zero
    ({"f_low": -1.0, "f_high": 3.0}, 3.0),
    ({"looks": 3, "before": 8.1}, 5.0),  # halved since the last third look
    ({"looks": 3, "before": 8.0}, 5.0),
    ({"looks": 3, "before": 7.9}, 4.0),
    ({"looks": 2, "before": 1.0}, 5.0),
    ({"looks": 4, "before": 1.0}, 5.0),
    ({"looks": 6, "before": 1.0}, 4.0),
    ({"f_high": 0.0}, 4.0),  # the chord is zero at an end
    ({"f_low": 0.0}, 4.0),
])  # fmt: skip
def test_the_next_look_is_where_the_chord_is_zero_or_in_the_middle(changed: dict[str, float], time: float) -> None:
    assert in_python(root_bracket.next_time)(bracket(**changed)) == pytest.approx(time)


@pytest.mark.parametrize(("changed", "time", "resolution", "is_open"), [
    ({}, 3.0, 3.9, True), ({}, 3.0, 4.0, False), ({}, 2.0, 0.1, False), ({}, 6.0, 0.1, False), ({}, 2.1, 0.1, True),
    ({"looks": MOST - 1}, 3.0, 0.1, True), ({"looks": MOST}, 3.0, 0.1, False),
])  # fmt: skip
def test_a_bracket_is_open_while_it_is_wide_and_something_lies_within(changed, time, resolution, is_open) -> None:
    assert in_python(root_bracket.is_open)(bracket(**changed), time, resolution) == is_open


def test_as_many_looks_as_bisections_that_reach_the_rounding_of_time() -> None:
    """Every bisection may take three looks."""
    assert MOST >= 3 * 64


@pytest.mark.parametrize(("moved", "high_side", "expected"), [
    (NEITHER, True, (2.0, 3.0, 5.0, -0.5, HIGH, 2, 9.0)), (NEITHER, False, (5.0, -0.5, 6.0, -1.0, LOW, 2, 9.0)),
    (HIGH, True, (2.0, 1.5, 5.0, -0.5, HIGH, 2, 9.0)), (LOW, False, (5.0, -0.5, 6.0, -0.5, LOW, 2, 9.0)),
    (LOW, True, (2.0, 3.0, 5.0, -0.5, HIGH, 2, 9.0)), (HIGH, False, (5.0, -0.5, 6.0, -1.0, LOW, 2, 9.0)),
])  # fmt: skip
def test_a_look_replaces_one_end_and_the_value_kept_twice_is_halved(moved: int, high_side: bool, expected: tuple) -> None:
    narrowed = in_python(root_bracket.narrowed)
    assert narrowed(bracket(moved=moved), 5.0, -0.5, high_side) == expected
    for looks, before in ((0, 4.0), (2, 9.0), (3, 4.0), (4, 9.0), (6, 4.0)):  # its width at every third look
        assert narrowed(bracket(moved=moved, looks=looks), 5.0, -0.5, high_side)[5:] == (looks + 1, before)


def polynomial(d: np.ndarray) -> Polynomial:
    """Of the share of the step, from the start value and seven coefficients of the extension."""
    x = Polynomial([0.0, 1.0])
    w = 1.0 - x
    return d[0] + x * (d[1] + w * (d[2] + x * (d[3] + w * (d[4] + x * (d[5] + w * (d[6] + x * d[7]))))))


LENGTH = 0.3


def a_step(kind: int, n: int, seed: int = 1) -> tuple[SimpleNamespace, list[Polynomial]]:
    """A step of n coordinates, and its places and velocities as polynomials of the share."""
    d = np.random.default_rng(seed).normal(size=(8, 2 * n))
    step = named(
        span=named(kind=kind, start=5.0, length=LENGTH), y0=d[0], dense=d[1:], q=np.arange(1.0, n + 1.0),
        u=np.arange(11.0, n + 11.0), bound=np.zeros(n),
    )  # fmt: skip
    return step, [polynomial(column) for column in d.T]


@pytest.mark.parametrize("tau", [0.0, 0.07, 0.21, 0.3])
def test_values_slopes_and_bends_are_those_of_the_polynomial(tau: float) -> None:
    step, wanted = a_step(COUPLED, 2)
    for i in range(4):
        value, slope, bend = (wanted[i].deriv(k)(tau / LENGTH) / LENGTH**k for k in range(3))
        assert in_python(dense_output.dense)(step, i, tau) == pytest.approx((value, slope), rel=1e-12, abs=0.0)
        assert in_python(dense_output.dense_value)(step, i, tau) == pytest.approx(value, rel=1e-12, abs=0.0)
        assert in_python(dense_output.dense_bend)(step, i, tau) == pytest.approx(bend, rel=1e-11, abs=1e-10)


def moved(coordinate: Any, grip: int, q: float, u: float, t: float) -> tuple[float, float]:
    return 100.0 * coordinate.number + q + u * t, 1000.0 * grip + u


MODEL = named(coordinates=[named(number=i) for i in range(5)])


def test_a_coordinate_is_where_its_kind_of_step_says() -> None:
    state = named(awake=[1, 0, 1, 1, 1], grip=[2, 3, 4, 5, 6])
    step, wanted = a_step(FLIGHT, 5)
    within = in_python(dense_output.coordinate_within, flow=moved)
    assert within(MODEL, state, step, 2, 0.25) == pytest.approx((200.0 + 3.0 + 13.0 * 0.25, 4013.0))
    assert within(MODEL, state, step, 1, 0.25) == (2.0, 0.0)
    step.span.kind = COUPLED
    assert within(MODEL, state, step, 1, 0.12) == pytest.approx((wanted[1](0.4), wanted[6](0.4)))
    pushed = in_python(dense_output.flight_acceleration, acceleration=lambda c, grip, q, u: (c.number, grip, q, u))
    assert pushed(MODEL, state, 2, 0.5, 0.25) == (2, 4, 0.5, 0.25) and pushed(MODEL, state, 1, 0.5, 0.25) == 0.0


def test_accelerations_and_bounds_on_the_path_are_those_of_its_kind() -> None:
    state = named(awake=[1, 0, 1, 1, 1], grip=[2, 3, 4, 5, 6])
    step, wanted = a_step(FLIGHT, 5)
    step.bound[:] = np.arange(5.0)
    path = named(q=[0.1] * 5, u=[0.2] * 5)
    instead: dict[str, Any] = {
        "flight_acceleration": lambda model, state, i, q, u: (i, q, u),
        "fastest_change": lambda coordinate: 7.0 + coordinate.number,
    }  # fmt: skip
    on_path, jerk = (in_python(kernel, **instead) for kernel in (step_path.acceleration_on_path, step_path.jerk_bound))
    assert on_path(MODEL, state, step, 2, 0.12, path) == (2, 0.1, 0.2) and jerk(MODEL, state, step, 2) == 2.0 * 9.0
    for kind in (FLIGHT, COUPLED):
        step.span.kind = kind
        assert on_path(MODEL, state, step, 1, 0.12, path) == 0.0 == jerk(MODEL, state, step, 1)
    assert on_path(MODEL, state, step, 2, 0.12, path) == pytest.approx(wanted[2].deriv(2)(0.4) / LENGTH**2, rel=1e-11)
    true = np.abs(wanted[2].deriv(3)(np.linspace(0.0, 1.0, 200))).max() / LENGTH**3
    assert true <= jerk(MODEL, state, step, 2) * (1.0 + 1e-12) <= 4.0 * true


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_the_largest_bernstein_coefficients_of_a_derivative(order: int, seed: int) -> None:
    """Against the coefficients from those of powers: b_k = sum of C(k, i)/C(n, i) a_i."""
    step, wanted = a_step(COUPLED, 2, seed)
    for i in range(2):
        powers = wanted[i].deriv(order).coef
        degree = 7 - order
        powers = np.append(powers, np.zeros(degree + 1 - len(powers)))
        bernstein = [sum(math.comb(k, j) / math.comb(degree, j) * powers[j] for j in range(k + 1)) for k in range(degree + 1)]
        bound = max(abs(b) for b in bernstein) / LENGTH**order
        if order == 2:
            in_python(step_path.bound_accelerations)(step, 2)
            assert step.bound[i] == pytest.approx(bound, rel=1e-9)
        else:
            assert in_python(step_path.jerk_bound)(MODEL, named(awake=[1] * 5), step, i) == pytest.approx(bound, rel=1e-9)


def on_path(kind: int, b: int) -> tuple[list[float], list[float], list[object], list[Polynomial]]:
    """Coordinates and velocities of a body and its carrier on the path, and what was placed; the second coordinate sleeps."""
    bodies = [
        named(motion=PIVOT, first=0, carrier=-1), named(motion=FREE, first=1, carrier=-1),
        named(motion=PIVOT, first=4, carrier=0),
        named(motion=FIXED, first=-1, carrier=0), named(motion=FIXED, first=-1, carrier=-1),
    ]  # fmt: skip
    state = named(awake=[1, 1, 0, 1, 1], grip=[2, 3, 4, 5, 6], q=[0.5] * 5, u=[0.25] * 5)
    step, wanted = a_step(kind, 5)
    path, placed = named(q=[77.0] * 5, u=[77.0] * 5, pose="pose"), []
    kernel = in_python(step_path.body_on_path, flow=moved, place_body=lambda model, b, q, u, pose: placed.append((b, pose)))
    kernel(named(bodies=bodies, coordinates=MODEL.coordinates), state, step, b, 0.12, path)
    assert placed == [(b, "pose")]
    return path.q, path.u, placed, wanted


def test_bodies_on_the_path_take_their_carriers_along() -> None:
    def flown(i: int) -> tuple[float, float]:
        return 100.0 * i + (i + 1.0) + (i + 11.0) * 0.12, 1000.0 * (i + 2) + i + 11.0

    for b, touched in ((0, [0]), (1, [1, 2, 3]), (2, [0, 4]), (3, [0]), (4, [])):
        q, u, *_ = on_path(FLIGHT, b)
        for i in range(5):
            wanted = (77.0, 77.0) if i not in touched else (0.5, 0.0) if i == 2 else flown(i)
            assert (q[i], u[i]) == pytest.approx(wanted)
        q, u, _, path = on_path(COUPLED, b)
        for i in range(5):
            on_it = (path[i](0.4), path[i].deriv()(0.4) / LENGTH)
            wanted = (77.0, 77.0) if i not in touched else (0.5, 0.0) if i == 2 else on_it
            assert (q[i], u[i]) == pytest.approx(wanted)
