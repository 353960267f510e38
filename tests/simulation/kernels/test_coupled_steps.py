"""Is a coupled step that of DOP853, with its extension and error, and how long is the next one? Against scipy, and by rule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python
from scipy.integrate import DOP853

from watchsim.simulation.loop_state.scratch import COUPLED, SUMS
from watchsim.simulation.motion import integrator

N = 2
WIDTH = 2 * N + SUMS
START = np.array([0.3, -0.7, 1.1, 0.4])  # q and u
SCALES, RATES = (0.5, 2.0), (3.0, 0.05)
TIME = 1.5  # s


def rates(t: float, y: np.ndarray) -> np.ndarray:
    q, u = y[:N], y[N : 2 * N]
    push = [math.cos(3.0 * t) - 4.0 * q[0] ** 3 + u[1], 0.3 * q[0] * u[1] - 2.0 * math.sin(q[1])]
    return np.array([*u, *push, u[0] * u[1], u[0] ** 2, q[1] - t])


def room(step: float, **changed: object) -> tuple[SimpleNamespace, ...]:
    """Model, state, options and scratch; `step`: the length proposed (s)."""
    model = named(coordinates=[named(scale=s, rate=r) for s, r in zip(SCALES, RATES, strict=True)])
    counts = named(steps=5, rejected_steps=7)
    state = named(clock=named(time=TIME, step=step), q=START[:N].copy(), u=START[N:].copy(), counts=counts)
    options = named(**{"tolerance": 1e-3, "max_step": 4.0, **changed})
    blank = {name: np.full(N, 77.0) for name in ("q", "u", "bound")} | {name: np.full(WIDTH, 77.0) for name in ("y0", "y1")}
    taken = named(
        span=named(kind=-1, start=0.0, length=0.0), stages=np.full((16, WIDTH), 77.0), dense=np.full((7, WIDTH), 77.0), **blank
    )
    smooth = named(y=np.full(WIDTH, 77.0), dy=np.full(WIDTH, 77.0), monitors=np.zeros(3), before=np.zeros(3))
    return model, state, options, named(step=taken, smooth=smooth, work="work")


def stepped(
    h: float, monitors: Sequence[float] = (1.0,), **changed: object
) -> tuple[tuple[bool, float], SimpleNamespace, SimpleNamespace]:
    """((made?, smallest monitor), state, scratch) of one step of at most h seconds along `rates`; monitors in turn."""
    model, state, options, scratch = room(h)
    calls: list[int] = []

    def motion(model, state, options, t, work, smooth) -> float:
        assert work == "work"
        smooth.dy[:] = rates(t, smooth.y)
        smooth.monitors[:] = len(calls)
        calls.append(1)
        return monitors[min(len(calls), len(monitors)) - 1]

    instead = {"motion": motion, "engage": lambda *_: None, **changed}
    found = in_python(integrator.coupled_step, **instead)(model, state, options, 9.0, scratch)
    assert len(calls) % 12 == 4  # the start, twelve stages each time, three of the extension
    assert scratch.smooth.before.tolist() == [0.0] * 3  # those at the start
    return found, state, scratch


def reference(h: float) -> DOP853:
    """The same step, by scipy."""
    solver = DOP853(rates, TIME, np.append(START, np.zeros(SUMS)), 99.0, rtol=1e9, atol=1e9, first_step=h)
    solver.step()
    assert solver.t == pytest.approx(TIME + h)
    return solver


@pytest.mark.parametrize("h", [0.2, 0.45])
def test_a_step_and_its_extension_are_those_of_dop853(h: float) -> None:
    (made, _), state, scratch = stepped(h, _error=lambda *_: 0.5, _defect=lambda *_: 0.5)
    solver = reference(h)
    step, dense = scratch.step, solver.dense_output()
    assert made and vars(step.span) == {"kind": COUPLED, "start": TIME, "length": h}
    assert (step.q.tolist(), step.u.tolist()) == (START[:N].tolist(), START[N:].tolist())
    assert step.y0.tolist() == [*START, 0.0, 0.0, 0.0]
    assert step.y1 == pytest.approx(solver.y, rel=1e-13, abs=0.0)
    value = in_python(integrator.dense_value)
    for share in (0.0, 0.2, 0.55, 0.9):
        found = [value(step, i, share * h) for i in range(WIDTH)]
        assert found == pytest.approx(dense(TIME + share * h), rel=1e-12, abs=1e-13)
    bends = np.abs([[rates(TIME + s * h, dense(TIME + s * h))[N + i] for s in np.linspace(0.0, 1.0, 50)] for i in range(N)])
    assert np.all(step.bound >= bends.max(axis=1) * (1.0 - 1e-3)) and np.all(step.bound < 3.0 * bends.max(axis=1))
    assert (state.counts.steps, state.counts.rejected_steps) == (6, 7)


def test_the_error_is_that_of_the_authors_over_the_tolerance() -> None:
    """Of places and velocities, not of sums; velocities count by their size or by what is small among them."""
    h = 0.45
    _, _, scratch = stepped(h, _error=lambda *_: 0.5, _defect=lambda *_: 0.5)
    model, _, options, _ = room(h)
    K = np.array(scratch.step.stages[:13])
    small = [max(SCALES[i] * RATES[i], abs(START[N + i]), abs(scratch.step.y1[N + i])) for i in range(N)]
    scale = 1e-3 * np.array([*SCALES, *small])
    five, three = (float(np.sum((K.T @ E)[: 2 * N] ** 2 / scale**2)) for E in (DOP853.E5, DOP853.E3))
    expected = h * five / math.sqrt((five + 0.01 * three) * 2 * N)
    assert in_python(integrator._error)(model, options, h, scratch.step) == pytest.approx(expected, rel=1e-9)
    assert in_python(integrator._error)(model, options, -h, scratch.step) == pytest.approx(expected, rel=1e-9)
    scratch.step.stages[:] = 0.0
    assert in_python(integrator._error)(model, options, h, scratch.step) == 0.0


@pytest.mark.parametrize(("y0", "y1", "scale"), [(5.0, -7.0, 7.0), (-8.0, 7.0, 8.0), (0.1, -0.1, 0.5 * 3.0)])
def test_an_error_of_velocity_counts_by_the_fastest(y0: float, y1: float, scale: float) -> None:
    model, _, options, scratch = room(0.1)
    step = scratch.step
    step.y0[N], step.y1[N], step.stages[:] = y0, y1, 0.0
    step.stages[5, N] = 0.7
    five, three = 0.7 * DOP853.E5[5] / scale, 0.7 * DOP853.E3[5] / scale
    expected = 0.1 * five**2 / math.sqrt((five**2 + 0.01 * three**2) * 4) / 1e-3
    assert in_python(integrator._error)(model, options, 0.1, step) == pytest.approx(expected, rel=1e-12)


def test_the_defect_is_how_far_velocities_are_from_the_slope_of_places() -> None:
    """At three quarters of the step, of the coordinate with the largest one in its scale; thirty tolerances are one."""
    h = 0.9
    _, _, scratch = stepped(h, _error=lambda *_: 0.5, _defect=lambda *_: 0.5)
    dense = reference(h).dense_output()
    nodes = 0.5 + 0.5 * np.cos(np.pi * (np.arange(8) + 0.5) / 8)
    off = []
    for i in range(N):
        q = np.polynomial.Polynomial.fit(nodes, [dense(TIME + s * h)[i] for s in nodes], 7)
        off.append(abs(q.deriv()(0.75) / h - dense(TIME + 0.75 * h)[N + i]) / SCALES[i])
    model, _, options, _ = room(h)
    for sign in (1.0, -1.0):
        scratch.step.dense *= sign
        scratch.step.y0 *= sign
        found = in_python(integrator._defect)(model, options, h, scratch.step)
        assert found == pytest.approx(h * max(off) / (30.0 * 1e-3), rel=1e-6)


def lengths(errors: list[float], defects: list[float], step: float = 0.5, longest: float = 9.0, max_step: float = 4.0):
    """(made?, lengths tried, step proposed next, steps, rejected) where these errors and defects are met in turn."""
    model, state, options, scratch = room(step, max_step=max_step)
    tried: list[float] = []
    given, found = iter(errors), iter(defects)

    def error(model, options, h, step) -> float:
        tried.append(h)
        return next(given)

    instead = {
        "_stage": lambda *_: 1.0, "_extend": lambda *_: 1.0, "_error": error, "_defect": lambda *_: next(found),
        "engage": lambda *_: None, "bound_accelerations": lambda *_: None,
    }  # fmt: skip
    made, _ = in_python(integrator.coupled_step, **instead)(model, state, options, longest, scratch)
    return made, tried, state.clock.step, state.counts.steps - 5, state.counts.rejected_steps - 7


def wish(error: float) -> float:
    return 0.78 * error**-0.125


def test_a_step_that_is_good_enough_says_how_long_the_next_may_be() -> None:
    """As long as its error allows, up to six times, and no shorter than this one; a defect below one does not count."""
    assert lengths([1e-3], [0.9]) == (True, [0.5], pytest.approx(0.5 * wish(1e-3)), 1, 0)
    assert lengths([1.0], [1.0]) == (True, [0.5], 0.5, 1, 0)
    assert lengths([1e-7], [0.0], max_step=9.0)[2] == pytest.approx(0.5 * wish(1e-7))
    assert lengths([1e-9], [0.0], max_step=9.0)[2] == pytest.approx(0.5 * 6.0)
    assert lengths([0.0], [0.0], max_step=9.0)[2] == pytest.approx(0.5 * 6.0)
    assert lengths([0.0], [0.0], max_step=2.5)[2] == 2.5


def test_a_step_that_is_too_coarse_is_repeated_shorter() -> None:
    """And no longer one is proposed after it."""
    found = lengths([8.0, 0.5], [0.5])
    assert found == (True, [0.5, pytest.approx(0.5 * wish(8.0))], pytest.approx(0.5 * wish(8.0) * wish(0.5)), 1, 1)
    assert lengths([8.0, 1e-6], [0.5])[2] == pytest.approx(0.5 * wish(8.0))
    assert lengths([1e9, 0.5], [0.5])[1][1] == pytest.approx(0.5 * 0.2)
    for error in (math.inf, math.nan):
        assert lengths([error, 0.5], [0.5])[1][1] == pytest.approx(0.5 * 0.2)
    assert lengths([0.1, 0.5], [4.0, 0.5])[1:2] == ([0.5, pytest.approx(0.5 * wish(4.0))],)  # its extension is too coarse
    assert lengths([1.01, 0.5], [0.5])[1][1] == pytest.approx(0.5 * wish(1.01))


def test_a_step_cut_short_says_nothing_against_a_longer_one() -> None:
    assert lengths([0.9], [0.5], step=0.5, longest=0.2)[1:3] == ([0.2], 0.5)
    assert lengths([0.9], [0.5], step=3.0, longest=0.2, max_step=9.0)[2] == pytest.approx(0.2 * 6.0)
    assert lengths([1e-6], [0.5], step=0.5, longest=0.2)[2] == pytest.approx(0.2 * wish(1e-6))


def test_a_step_that_gets_too_small_is_given_up() -> None:
    """Of a hundred trillionth of the longest step."""
    least = 1e-14 * 4.0
    assert lengths([2.0], [], step=0.99 * least)[:2] == (False, [0.99 * least])
    assert lengths([2.0, 0.5], [0.5], step=1.01 * least)[0] and lengths([0.5], [0.5], step=0.99 * least)[0]


def test_the_smallest_monitor_of_a_step_is_that_of_its_own_stages() -> None:
    """Of the start, twelve stages and three of the extension; those of a step that is repeated are forgotten."""
    for place in (0, 1, 7, 12, 13, 15):
        values = [9.0] * 16
        values[place] = -2.0
        assert stepped(0.2, values, _error=lambda *_: 0.5, _defect=lambda *_: 0.5)[0][1] == -2.0
    errors = iter([2.0, 0.5])
    values = [9.0, 8.0, -5.0, *[7.0] * 40]
    assert stepped(0.2, values, _error=lambda *_: next(errors), _defect=lambda *_: 0.5)[0][1] == 7.0
