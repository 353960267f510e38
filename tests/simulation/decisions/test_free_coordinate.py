"""Is the flight of one coordinate the exact solution of its equation, and when does it turn back?

m q'' = f - c q' - k (q - rest), against the exponential of its matrix, and against sampling and bisection.
"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python
from scipy.linalg import expm
from scipy.optimize import brentq

from watchsim.simulation.motion import free_motion

GRIPS = (0.0, 1.0, -1.0)
CASES = {  # mass, stiffness, viscous
    "free": (0.7, 0.0, 0.0),
    "damped without a spring": (0.7, 0.0, 0.4),
    "hardly damped without a spring": (0.7, 0.0, 1e-4),
    "spring": (0.7, 30.0, 0.0),
    "spring and damping": (0.7, 30.0, 1.9),
    "critical damping": (0.5, 8.0, 4.0),
    "strong damping": (0.7, 3.0, 9.0),
}


def coordinate(case: str) -> SimpleNamespace:
    mass, stiffness, viscous = CASES[case]
    return SimpleNamespace(mass=mass, stiffness=stiffness, viscous=viscous, rest=0.3, force=0.9, coulomb=0.25)


def ask(name: str, *arguments):
    return in_python(getattr(free_motion, name))(*arguments)


def matrix(one: SimpleNamespace, grip: float) -> np.ndarray:
    """Of the rates of (q, q', 1): friction acts against the direction of the grip."""
    constant = one.force - grip * one.coulomb + one.stiffness * one.rest
    return np.array(
        [[0.0, 1.0, 0.0], [-one.stiffness / one.mass, -one.viscous / one.mass, constant / one.mass], [0.0, 0.0, 0.0]]
    )


def state(one: SimpleNamespace, grip: float, q: float, u: float, t: float) -> np.ndarray:
    return np.asarray(expm(matrix(one, grip) * t) @ (q, u, 1.0))


def starts(seed: int) -> tuple[float, float]:
    q, u = np.random.default_rng(seed).normal(size=2)
    return float(q), float(u)


@pytest.mark.parametrize("grip", GRIPS)
@pytest.mark.parametrize("case", CASES)
def test_flights_are_exact(case: str, grip: float) -> None:
    one = coordinate(case)
    for seed, t in enumerate((0.0, 1e-5, 0.003, 0.08, 0.9, 4.0)):
        q, u = starts(seed)
        assert ask("flow", one, grip, q, u, t) == pytest.approx(state(one, grip, q, u, t)[:2], rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("grip", GRIPS)
@pytest.mark.parametrize("case", CASES)
def test_accelerations_stay_below_their_bound_which_is_met_without_damping(case: str, grip: float) -> None:
    """The bound is the norm that a spring's swing keeps, of second and third derivative at the start; it never grows."""
    one, A = coordinate(case), matrix(coordinate(case), grip)
    for seed in range(5):
        q, u = starts(seed)
        y = np.array([q, u, 1.0])
        a, jerk = (A @ y)[1], (A @ A @ y)[1]
        assert ask("acceleration", one, grip, q, u) == pytest.approx(a, rel=1e-12, abs=0.0)
        bound = ask("acceleration_bound", one, grip, q, u)
        met = [abs((A @ state(one, grip, q, u, t))[1]) for t in np.linspace(0.0, 1.2, 60)]
        assert max(met) <= bound * (1.0 + 1e-12)
        wanted = abs(a) if one.stiffness == 0.0 else math.hypot(a, jerk * math.sqrt(one.mass / one.stiffness))
        assert bound == pytest.approx(wanted, rel=1e-12, abs=0.0)
        if one.viscous == 0.0:
            assert max(met) > 0.99 * bound


@pytest.mark.parametrize("case", CASES)
def test_how_fast_accelerations_change(case: str) -> None:
    """No faster than this share of their bound: in a swing its frequency, without a spring the rate at which damping slows."""
    one = coordinate(case)
    A, rate = matrix(one, 0.0), ask("fastest_change", one)
    worst = 0.0
    for seed in range(6):
        y = np.array([*starts(seed), 1.0])
        bound = ask("acceleration_bound", one, 0.0, *y[:2])
        jerks = [abs((A @ A @ expm(A * t) @ y)[1]) for t in np.linspace(0.0, 1.2, 30)]
        if one.viscous == 0.0 or one.stiffness == 0.0:
            assert max(jerks) <= rate * bound * (1.0 + 1e-9) + 1e-15
            worst = max(worst, max(jerks) / (rate * bound) if rate * bound else 1.0)
    assert worst == pytest.approx(1.0, rel=0.1) or (one.viscous > 0.0 and one.stiffness > 0.0)
    assert rate == pytest.approx(math.sqrt(one.stiffness / one.mass) or one.viscous / one.mass, rel=1e-14)


@pytest.mark.parametrize("case", CASES)
def test_a_quarter_of_a_period_takes_a_spring_from_its_end_to_rest(case: str) -> None:
    one = coordinate(case)
    time = ask("quarter_period", one)
    if one.stiffness == 0.0:
        assert time == math.inf
        return
    alone = SimpleNamespace(**{**vars(one), "viscous": 0.0, "force": 0.0})
    assert state(alone, 0.0, one.rest + 2.0, 0.0, time)[0] == pytest.approx(one.rest, abs=1e-12)
    assert state(alone, 0.0, one.rest + 2.0, 0.0, 0.5 * time)[0] > one.rest


STRIDE, LONGEST = 0.01, 8.0  # s


def first_standstill(one: SimpleNamespace, grip: float, q: float, u: float) -> float:
    """By sampling: the first time after the start at which the velocity changes its sign; infinity for none before long."""
    move, y = expm(matrix(one, grip) * STRIDE), state(one, grip, q, u, 1e-6)
    for k in range(int(LONGEST / STRIDE)):
        after = move @ y
        if abs(after[1]) < 1e-7 * (abs(u) + 1e-3):
            return math.inf  # it creeps to its rest
        if after[1] * y[1] < 0.0:
            begin = 1e-6 + k * STRIDE
            return float(brentq(lambda t: state(one, grip, q, u, t)[1], begin, begin + STRIDE, xtol=1e-14))
        y = after
    return math.inf


@pytest.mark.parametrize("speed", [0.0, 0.8, -0.8, 3.0, -3.0])
@pytest.mark.parametrize("case", CASES)
def test_a_coordinate_turns_when_its_velocity_first_vanishes(case: str, speed: float) -> None:
    for grip in GRIPS:
        for q in (0.37, -0.9, 1.4):
            one = coordinate(case)
            wanted = first_standstill(one, grip, q, speed)
            if wanted == math.inf and speed != 0.0:
                assert ask("turning_time", one, grip, q, speed) > 3.0
            elif speed != 0.0 or (one.stiffness > 0.0 and one.viscous < 3.0):
                assert ask("turning_time", one, grip, q, speed) == pytest.approx(wanted, rel=1e-9)
            else:
                assert ask("turning_time", one, grip, q, speed) == math.inf


@pytest.mark.parametrize("case", ["free", "damped without a spring"])
def test_what_is_pushed_the_way_it_goes_never_turns(case: str) -> None:
    one = coordinate(case)
    assert ask("turning_time", one, 0.0, 0.0, 2.0) == math.inf
    assert ask("turning_time", one, 0.0, 0.0, 0.0) == math.inf
    one.force = 0.0
    assert ask("turning_time", one, 0.0, 0.0, 2.0) == math.inf  # damping alone never stops it


@pytest.mark.parametrize("q", [0.9, -0.4])
@pytest.mark.parametrize("case", ["spring", "spring and damping"])
def test_what_is_let_go_at_rest_turns_after_half_a_period(case: str, q: float) -> None:
    """Of the damped swing."""
    one = coordinate(case)
    rate = math.sqrt(one.stiffness / one.mass - (0.5 * one.viscous / one.mass) ** 2)
    assert ask("turning_time", one, 0.0, q, 0.0) == pytest.approx(math.pi / rate, rel=1e-14)
    assert ask("turning_time", one, 0.0, q, 1e-300) in (pytest.approx(0.0, abs=1e-200), pytest.approx(math.pi / rate))
