"""Are stored energy, work and losses those of a made-up model whose motion is known at every instant?

Coordinates move as polynomials of degree four, so that sums must be the integrals; scipy takes those of the powers.
"""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_models import model_of
from numpy.polynomial import Polynomial
from scipy.integrate import quad

from watchsim.analysis.timeline.flows import Flows, flows
from watchsim.model.records import OVER_ANGLE, OVER_TIME, REPEATED

T = np.array([0.0, 0.5, 1.0, 1.75, 2.25, 2.5])  # where tables over time bend, too
# All turn one way: 0, 1 on, 2 and 3 back, 4 is still, so that powers of speeds are smooth; 2 is prescribed.
MOTIONS = [
    Polynomial([0.3, 1.0, 0.2, 0.1, 0.05]),
    Polynomial([-1.0, 2.0, -0.1, 0.02, 0.03]),
    Polynomial([0.5, -0.7, -0.1, 0.0, -0.02]),
    Polynomial([2.0, -3.0, 0.3, -0.1, 0.01]),
    Polynomial([0.4]),
]
N = len(MOTIONS)


def q(k: int, t: float) -> float:
    return float(MOTIONS[k](t))


def u(k: int, t: float) -> float:
    return float(MOTIONS[k].deriv()(t))


def found(model: Any, motions: list[Polynomial], t: np.ndarray = T, rows: slice = slice(None)) -> Flows:
    columns = [np.column_stack([motion.deriv(k)(t) for motion in motions]) for k in (1, 2)]
    run: Any = SimpleNamespace(t=t, q=np.column_stack([motion(t) for motion in motions]), u=columns[0], a=columns[1])
    compiled: Any = SimpleNamespace(model=model, q=np.zeros(len(motions)), against=[])
    return flows(run, compiled, rows)


def integrals(power: Any) -> np.ndarray:
    steps = [quad(power, *span, epsabs=1e-13, epsrel=1e-12)[0] for span in pairwise(T)]
    return np.concatenate(([0.0], np.cumsum(steps)))


MASS = [2.0, 3.0, 1.0, 0.5, 4.0]
PLAIN = {"mass": MASS}


def test_energies_of_coordinates() -> None:
    stiffness, rest = np.array([1.5, 0.0, 2.0, 4.0, 7.0]), np.array([0.1, 0.2, 0.3, -0.4, 0.5])
    wx, wy, prescribed = np.array([0.7, 0.0, 0.3, 0.0, 0.5]), np.array([0.2, -0.9, 0.4, 0.0, 0.0]), np.array([0, 0, 1, 0, 0])
    fields = {"stiffness": stiffness, "rest": rest, "weight_x": wx, "weight_y": wy, "driven": prescribed}
    wound = {"coordinate": 3, "on": 0, "stiffness": 1.25, "rest": 0.6}
    got = found(model_of(coordinates=PLAIN | fields, joints=[wound]), MOTIONS)
    for i, t in enumerate(T):
        for k in range(N):
            kept = 0.5 * MASS[k] * u(k, t) ** 2 + 0.5 * stiffness[k] * (q(k, t) - rest[k]) ** 2
            hung = wy[k] * np.sin(q(k, t)) + wx[k] * np.cos(q(k, t))
            assert got.own[i, k] == pytest.approx(0.0 if k == 2 else kept - hung, rel=1e-12)
        between = 0.5 * 1.25 * (q(3, t) - q(0, t) - 0.6) ** 2
        assert got.stored[i] == pytest.approx(got.own[i].sum() + between, rel=1e-12)
    assert got.q == pytest.approx(np.column_stack([motion(T) for motion in MOTIONS]))


def test_what_is_swept() -> None:
    got = found(model_of(coordinates=PLAIN), MOTIONS)
    for k in range(N):
        assert got.swept[:, k] == pytest.approx(integrals(lambda t, k=k: q(k, t)), rel=1e-11, abs=0.0)
    assert not got.damped.any() and not got.driven.any() and not got.drive.any()


def test_constant_forces() -> None:
    """Nothing that is prescribed counts as driven by them."""
    force = np.array([1.0, -2.0, 5.0, 3.0, 1.0])
    joints = [{"coordinate": 1, "on": 3, "force": 0.75}, {"coordinate": 0, "on": 2, "force": -0.5}]
    got = found(model_of(coordinates=PLAIN | {"force": force, "driven": [0, 0, 1, 0, 0]}, joints=joints), MOTIONS)
    on = {0: 1.0 - 0.5, 1: -2.0 + 0.75, 2: 0.0, 3: 3.0 - 0.75, 4: 1.0}
    for k in range(N):
        wanted = on[k] * integrals(lambda t, k=k: u(k, t))
        wanted = wanted if k != 2 else integrals(lambda t: 0.0)
        assert got.driven[:, k] == pytest.approx(wanted, rel=1e-11, abs=1e-12)
    assert got.drive == pytest.approx(got.driven.sum(axis=1), rel=1e-12)


@pytest.mark.parametrize("field", ["viscous", "coulomb", "quadratic"])
@pytest.mark.parametrize("k", [0, 2, 3])
def test_each_damping_of_a_coordinate_alone(field: str, k: int) -> None:
    values = np.zeros(N)
    values[k] = 0.7
    power = {"viscous": 2, "coulomb": 1, "quadratic": 3}[field]
    got = found(model_of(coordinates=PLAIN | {field: values}), MOTIONS)
    assert got.damped[:, k] == pytest.approx(0.7 * integrals(lambda t: abs(u(k, t)) ** power), rel=1e-10)
    assert np.abs(np.delete(got.damped, k, axis=1)).max() == 0.0 and not got.driven.any()


@pytest.mark.parametrize("field", ["viscous", "quadratic"])
@pytest.mark.parametrize("on", [2, 3])
def test_each_damping_between_coordinates_alone(field: str, on: int) -> None:
    """It counts with the carried one."""
    got = found(model_of(coordinates=PLAIN, joints=[{"coordinate": 0, "on": on, field: 0.4}]), MOTIONS)
    power = {"viscous": 2, "quadratic": 3}[field]
    sum_of = integrals(lambda t: abs(u(0, t) - u(on, t)) ** power)
    assert got.damped[:, 0] == pytest.approx(0.4 * sum_of, rel=1e-9)
    assert not got.damped[:, 1:].any() and not got.driven.any()


def test_dampings_add_up() -> None:
    fields = {
        "viscous": [0.1, 0.2, 0.3, 0.4, 0.5],
        "coulomb": [0.5, 0.0, 0.1, 0.2, 0.3],
        "quadratic": [0.0, 0.3, 0.2, 0.1, 0.6],
    }
    joints = [{"coordinate": 3, "on": 0, "viscous": 0.4, "quadratic": 0.3}, {"coordinate": 1, "on": 4, "viscous": 0.2}]
    got = found(model_of(coordinates=PLAIN | fields, joints=joints), MOTIONS)

    def own(k: int, t: float) -> float:
        s = abs(u(k, t))
        return fields["coulomb"][k] * s + fields["viscous"][k] * s**2 + fields["quadratic"][k] * s**3

    more = {3: lambda t: 0.4 * (u(3, t) - u(0, t)) ** 2 + 0.3 * abs(u(3, t) - u(0, t)) ** 3, 1: lambda t: 0.2 * u(1, t) ** 2}
    for k in range(N):
        wanted = integrals(lambda t, k=k: own(k, t) + (more[k](t) if k in more else 0.0))
        assert got.damped[:, k] == pytest.approx(wanted, rel=1e-10)


def over_angle(k: int, on: int = -1) -> list[tuple[float, float]]:
    """A table that bends where a coordinate (or its difference to another) is at rows; it stays what it is beyond its ends."""
    places = sorted(q(k, t) - (q(on, t) if on >= 0 else 0.0) for t in T)[1:-1]
    return list(zip(places, [0.5, -1.0, 2.0, 0.25], strict=True))


@pytest.mark.parametrize(("k", "on"), [(0, -1), (3, -1), (3, 0), (1, 4), (0, 3)])
def test_tables_over_an_angle(k: int, on: int) -> None:
    knots = over_angle(k, on)
    other = [(0.0, 9.0), (1.0, 9.0)]  # of another table before it, on what stands still
    tables = [{"coordinate": 4, "over": OVER_ANGLE, "knots": other}]
    tables.append({"coordinate": k, "over": OVER_ANGLE, "on": on, "knots": knots})
    got = found(model_of(coordinates=PLAIN, tables=tables), MOTIONS)

    def value(t: float) -> float:
        return float(np.interp(q(k, t) - (q(on, t) if on >= 0 else 0.0), *np.array(knots).T))

    assert got.driven[:, k] == pytest.approx(integrals(lambda t: value(t) * u(k, t)), rel=1e-10)
    for j in range(N):
        if j == on:
            assert got.driven[:, j] == pytest.approx(integrals(lambda t, j=j: -value(t) * u(j, t)), rel=1e-10, abs=1e-15)
        elif j != k:
            assert not got.driven[:, j].any()
    assert not got.damped.any()


@pytest.mark.parametrize("over", [OVER_TIME, REPEATED])
@pytest.mark.parametrize("on", [-1, 1])
def test_tables_over_time(over: int, on: int) -> None:
    """From 0.5 s to 1.75 s; what is repeated goes on so before and after, else the ends stay."""
    knots = np.array([(0.5, 1.0), (1.0, -2.0), (1.75, 0.5)])

    def value(t: float) -> float:
        while over == REPEATED and t < 0.5:
            t += 1.25
        while over == REPEATED and t >= 1.75:
            t -= 1.25
        return float(np.interp(t, *knots.T))

    got = found(model_of(coordinates=PLAIN, tables=[{"coordinate": 3, "over": over, "on": on, "knots": knots}]), MOTIONS)
    assert got.driven[:, 3] == pytest.approx(integrals(lambda t: value(t) * u(3, t)), rel=1e-10)
    if on >= 0:
        assert got.driven[:, 1] == pytest.approx(integrals(lambda t: -value(t) * u(1, t)), rel=1e-10)


@pytest.mark.parametrize("k", [1, 3])
def test_what_holds_a_prescribed_motion_up(k: int) -> None:
    """Against the spring and the damping that it carries: the work of both is what its drive has done."""
    joint = {"coordinate": k, "on": 2, "stiffness": 0.8, "rest": 0.3, "viscous": 0.2, "quadratic": 0.1}
    beside = {"coordinate": 4, "on": 0, "stiffness": 0.8, "viscous": 0.2}  # on what is not prescribed: nothing drives it
    model = model_of(coordinates=PLAIN | {"driven": [0, 0, 1, 0, 0]}, joints=[joint, beside])
    got = found(model, MOTIONS)

    def held(t: float) -> float:
        w = u(k, t) - u(2, t)
        return 0.8 * (q(k, t) - q(2, t) - 0.3) + 0.2 * w + 0.1 * w * abs(w)

    assert got.driven[:, 2] == pytest.approx(integrals(lambda t: -held(t) * u(2, t)), rel=1e-10)
    assert not np.delete(got.driven, 2, axis=1).any()


def test_some_rows_count_from_their_first_on() -> None:
    model = model_of(coordinates=PLAIN | {"force": [1.0, 2.0, 3.0, 4.0, 5.0], "viscous": [0.1] * N})
    whole, part = found(model, MOTIONS), found(model, MOTIONS, rows=slice(2, 5))
    for name in ("drive", "driven", "damped", "swept"):
        there = getattr(whole, name)
        assert getattr(part, name) == pytest.approx(there[2:5] - there[2], rel=1e-11, abs=1e-14)
    assert part.stored == pytest.approx(whole.stored[2:5]) and list(part.t) == list(T[2:5])
