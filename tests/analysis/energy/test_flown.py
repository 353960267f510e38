"""Does damping take what is lost in long flights in closed form, over which polynomials are not exact enough?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_models import model_of
from scipy.integrate import quad

from watchsim.analysis.timeline.flows import Flows, flows
from watchsim.model.records import OVER_TIME

STIFFNESS, VISCOUS, REST, DRY = 5.0, 0.3, 0.2, 0.05


def swing(t: np.ndarray, force: float) -> np.ndarray:
    """Place, speed and acceleration (rows, 3) of 2 q'' = F - c q' - k (q - rest) - dry sign(q'), while it does not turn."""
    w = np.sqrt(STIFFNESS / 2.0 - (VISCOUS / 4.0) ** 2)
    z = complex(-VISCOUS / 4.0, w)
    far = 1.5 * np.exp(z * t + 0.4j)  # turns first at 1.7 s; it moves back
    middle = REST + (force + DRY) / STIFFNESS
    return np.column_stack([middle + far.real, (z * far).real, (z * z * far).real])


def flown(off: float = 0.0, force: float = 0.0, row: int = 2, **changed: Any) -> Flows:
    """Two long steps, the acceleration at one row off by a share of the sum of all forces but dry ones."""
    t = np.array([0.0, 0.7, 1.5])
    rows = swing(t, force)
    pulls = abs(force) + STIFFNESS * np.abs(rows[:, 0] - REST) + VISCOUS * np.abs(rows[:, 1])
    rows[row, 2] += off * pulls[row] / 2.0
    one = {"viscous": VISCOUS, "force": force, "rest": REST, "coulomb": DRY, "linear": 1, "stiffness": STIFFNESS}
    fields = {name: [value, 0.0] for name, value in one.items()} | {"mass": [2.0, 1.0]}
    model = model_of(coordinates=fields | changed.pop("coordinates", {}), **changed)
    q, u, a = (np.column_stack([column, np.zeros(3)]) for column in rows.T)
    run: Any = SimpleNamespace(t=t, q=q, u=u, a=a)
    compiled: Any = SimpleNamespace(model=model, q=np.zeros(2), against=[])
    return flows(run, compiled)


def really_lost() -> np.ndarray:
    """Without a drive, by scipy."""

    def power(t: float) -> float:
        speed = abs(float(swing(np.array([t]), 0.0)[0, 1]))
        return speed * (DRY + VISCOUS * speed)

    return np.array([0.0, quad(power, 0.0, 0.7, epsabs=1e-14)[0], quad(power, 0.0, 1.5, epsabs=1e-14)[0]])


def flies(got: Flows) -> list[bool]:
    """Is what is lost over each step taken for the work of damping?"""
    lost = -np.diff(got.own[:, 0]) + np.diff(got.driven[:, 0])
    return [bool(abs(one / all_of - 1.0) < 1e-9) for one, all_of in zip(np.diff(got.damped[:, 0]), lost, strict=True)]


def test_long_flights_lose_what_their_closed_form_loses() -> None:
    """Where polynomials over such steps are off by far more; what disturbs a row spoils its steps."""
    lost = really_lost()
    assert (swing(np.linspace(0.0, 1.5, 99), 0.0)[:, 1] < 0.0).all()
    assert flown().damped[:, 0] == pytest.approx(lost, rel=1e-11, abs=1e-15)
    disturbed = np.abs(flown(off=1e-6).damped[:, 0] - lost)
    assert disturbed[1] < 1e-11 * lost[1] and disturbed[2] > 1e-4 * lost[2]


@pytest.mark.parametrize("force", [0.0, 0.7, -0.9])
@pytest.mark.parametrize(("off", "so"), [(0.0, True), (0.8e-12, True), (-0.8e-12, True), (1.2e-12, False), (-1.2e-12, False)])
def test_a_flight_is_what_the_forces_explain_to_a_billionth_of_a_thousandth(off: float, so: bool, force: float) -> None:
    """At both of its rows."""
    assert flies(flown(off, force)) == [True, so]
    assert flies(flown(off, force, row=1)) == [so, so]
    assert flies(flown(off, force, row=0)) == [so, True]


OTHERS = [
    ({"coordinates": {"linear": [0, 0]}}, False),
    ({"tables": [{"coordinate": 0, "over": OVER_TIME, "knots": [(0.0, 0.0), (1.0, 0.0)]}]}, False),
    ({"tables": [{"coordinate": 1, "over": OVER_TIME, "on": 0, "knots": [(0.0, 0.0), (1.0, 0.0)]}]}, False),
    ({"tables": [{"coordinate": 1, "over": OVER_TIME, "knots": [(0.0, 0.0), (1.0, 0.0)]}]}, True),
    ({"joints": [{"coordinate": 0, "on": 1}]}, False),
    ({"joints": [{"coordinate": 1, "on": 0}]}, False),
]


@pytest.mark.parametrize(("changed", "so"), OTHERS)
def test_what_is_tied_to_others_does_not_fly(changed: dict[str, Any], so: bool) -> None:
    assert flies(flown(**changed)) == [so, so]


def test_over_no_time_nothing_is_lost() -> None:
    """An impact: two rows at one time, with other speeds."""
    rows = swing(np.array([0.5, 0.5]), 0.0)
    rows[1, 1:] = swing(np.array([0.9]), 0.0)[0, 1:]
    rows[1, 2] = (-VISCOUS * rows[1, 1] - STIFFNESS * (rows[1, 0] - REST) + DRY) / 2.0
    fields = {"viscous": [VISCOUS], "rest": [REST], "coulomb": [DRY], "linear": [1], "stiffness": [STIFFNESS], "mass": [2.0]}
    run: Any = SimpleNamespace(t=np.array([0.5, 0.5]), q=rows[:, :1], u=rows[:, 1:2], a=rows[:, 2:])
    compiled: Any = SimpleNamespace(model=model_of(coordinates=fields), q=np.zeros(1), against=[])
    got = flows(run, compiled)
    assert not got.damped.any() and got.own[0, 0] != got.own[1, 0]


def test_a_flight_may_begin_at_rest() -> None:
    """Let go, without dry friction."""
    t = np.array([0.0, 0.9])
    z = complex(-VISCOUS / 4.0, np.sqrt(STIFFNESS / 2.0 - (VISCOUS / 4.0) ** 2))
    far = 2.5j / z * np.exp(z * t)
    q, u, a = REST + far.real, (z * far).real, (z * z * far).real
    u[0] = 0.0
    fields = {"viscous": [VISCOUS], "rest": [REST], "linear": [1], "stiffness": [STIFFNESS], "mass": [2.0]}
    run: Any = SimpleNamespace(t=t, q=q[:, None], u=u[:, None], a=a[:, None])
    compiled: Any = SimpleNamespace(model=model_of(coordinates=fields), q=np.zeros(1), against=[])
    lost = quad(lambda s: VISCOUS * (2.5j * np.exp(z * s)).real ** 2, 0.0, 0.9, epsabs=1e-14)[0]
    assert flows(run, compiled).damped[1, 0] == pytest.approx(lost, rel=1e-11)
