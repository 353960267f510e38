"""Does a verge tick, and does its period depend on the drive as Hoyng and Nieuwenhuizen (arXiv 1604.06681) found?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import watchsim as ws
from watchsim import designs
from watchsim.construction.verge import Verge, depth, pitch
from watchsim.simulation.trajectory import Trajectory

# Flags close together, long, and let go after a small turn: the torque on the verge is then nearly constant.
NARROW = {"flag_angle": "20°", "lift": "2°", "drop": "0.02 mm", "friction": 0.0, "wheel_inertia": "1 g·cm²"}


def period(run: Trajectory) -> float:
    """The last time between two passages of the middle in the same sense, s."""
    column = run.slices["verge"].start
    q = run.q[:, column]
    rows = np.flatnonzero((q[:-1] < 0.0) & (q[1:] >= 0.0))[-2:]
    first, last = (brentq(lambda t: run.sample(np.array([t]))[0][0, column], run.t[i], run.t[i + 1], xtol=1e-13) for i in rows)
    return float(last - first)


def narrow(torque: float, viscous: float, duration: float) -> Trajectory:
    scene = designs.verge(**NARROW, torque=f"{torque} mN·m", viscous=f"{viscous} mN·m·s/rad", length=200).scene()
    return ws.simulate(scene, duration=duration)


def test_it_ticks_for_five_minutes_a_tooth_for_each_oscillation() -> None:
    run = ws.simulate(designs.verge().scene(), duration=300.0)
    q = run.q[:, run.slices["verge"].start]
    oscillations = np.flatnonzero((q[:-1] < 0.0) & (q[1:] >= 0.0))
    teeth = run.q[oscillations, run.slices["crown_wheel"].start] / math.tau * 27
    assert len(oscillations) == 68
    assert np.diff(teeth) == pytest.approx(1.0, abs=0.05)
    assert np.diff(teeth)[20:] == pytest.approx(1.0, abs=1e-3)
    assert run.energy["residual_relative"] < 1e-9
    assert run.worst_overlap == 0.0


@pytest.mark.slow
def test_the_other_method_agrees_at_its_order() -> None:
    """Its error comes from events found within a step: of first order, and scattered."""
    scene = designs.verge().scene()
    exact = ws.simulate(scene, duration=6.0).end_q[0]
    errors = [abs(ws.simulate(scene, duration=6.0, method="moreau", step=h).end_q[0] - exact) for h in (2e-3, 5e-4)]
    assert errors[1] < 0.5 * errors[0] and errors[1] < 5e-3


def test_a_strong_drive_shortens_the_period_with_its_cube_root() -> None:
    periods = [period(narrow(torque, 1.0, 40.0)) for torque in (1.0, 2.0, 4.0)]
    exponents = np.diff(np.log(periods)) / math.log(2.0)
    assert exponents == pytest.approx(-1.0 / 3.0, rel=0.05)


def test_a_weak_drive_shortens_it_in_proportion() -> None:
    periods = [period(narrow(torque, 100.0, 60.0 / torque)) for torque in (0.5, 1.0, 2.0)]
    exponents = np.diff(np.log(periods)) / math.log(2.0)
    assert exponents == pytest.approx(-1.0, rel=0.05)


@pytest.mark.parametrize(("torque", "viscous"), [(1.0, 100.0), (1.0, 10.0), (2.0, 1.0)])
def test_the_period_is_that_of_a_torque_that_changes_its_sign(torque: float, viscous: float) -> None:
    """I x'' = ±M - c x', the sign changing where a flag lets go: weak, between, and strong.

    M = F h as if flags stood upright; leaning by up to 12° they have an arm up to 4.5 % longer.
    """
    inertia, a, c = 16e-4, math.radians(2.0), 1e-3 * viscous
    values = Verge(flag_angle=20.0, lift=2.0, drop=0.02)
    M = 1e-3 * torque * depth(values) / values.wheel_radius

    def let_go(speed: float) -> tuple[float, float]:
        """From letting go at -a, moving outwards, to letting go at +a: speed there and time."""

        def at_a(_t: float, y: np.ndarray) -> float:
            return float(y[0] - a)

        at_a.terminal, at_a.direction = True, 1.0  # type: ignore[attr-defined]
        rates = lambda _t, y: [y[1], (M - c * y[1]) / inertia]  # noqa: E731
        found = solve_ivp(rates, (0.0, 1e4), [-a, -speed], events=at_a, rtol=1e-10, atol=1e-12)
        return float(found.y[1, -1]), float(found.t[-1])

    before, (speed, half) = 0.1, let_go(0.1)
    while abs(speed - before) > 1e-9 * speed:
        before, (speed, half) = speed, let_go(speed)
    assert period(narrow(torque, viscous, 60.0)) == pytest.approx(2.0 * half, rel=0.045)


def test_half_a_pitch_is_what_the_wheel_goes_from_one_side_to_the_other() -> None:
    values = Verge()
    run = ws.simulate(designs.verge().scene(), duration=40.0)
    q = run.q[:, run.slices["verge"].start]
    turns = np.flatnonzero(np.diff(np.sign(q)) != 0)
    way = np.diff(run.q[turns, run.slices["near_side"].start])[8:]
    assert 1e3 * way == pytest.approx(0.5 * pitch(values), rel=0.05)
    assert 1e3 * (way[:-1] + way[1:]) == pytest.approx(pitch(values), rel=1e-2)


@pytest.mark.parametrize(
    ("changed", "key"),
    [
        ({"teeth": 26}, "teeth"),
        ({"lift": "39°"}, "lift"),
        ({"drop": "4.5 mm"}, "drop"),
        ({"slope": "26°"}, "slope"),
    ],
)
def test_what_cannot_be_drawn_is_refused_with_the_dimension_to_change(changed: dict[str, str | int], key: str) -> None:
    with pytest.raises(Exception, match=key):
        designs.verge(**changed).scene()
